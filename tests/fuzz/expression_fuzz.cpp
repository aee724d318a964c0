// Expressions of patterns.

#include <cmath>

#include "ayumi/io/pattern/expression.hpp"
#include "fuzz_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const std::string text(reinterpret_cast<const char*>(data), size);
  is_expression(text);
  double value = 0;
  if (fuzz::accepts([&] {
        value = evaluate_expression(text, {{"a", 2.0}, {"stride", 0.05}, {"zero", 0.0}}, {"here"});
      }))
    fuzz::expect(std::isfinite(value), "the value of an expression is finite");
  return 0;
}
