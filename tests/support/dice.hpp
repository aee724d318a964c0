#pragma once
// Draws of a seeded generator of test cases.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ayumi/math/random.hpp"

namespace ayumi::test {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 4; ++i) random_.bits();  // neighbouring seeds begin with similar numbers
  }
  double between(double low, double high) { return low + (high - low) * random_.uniform(); }
  size_t below(size_t count) { return static_cast<size_t>(random_.bits() % count); }
  double sign() { return below(2) == 0 ? 1 : -1; }
  template <class Value>
  const Value& one_of(const std::vector<Value>& values) {
    return values[below(values.size())];
  }

 private:
  Random random_;
};

}  // namespace ayumi::test
