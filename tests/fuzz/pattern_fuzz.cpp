// Patterns with their includes. A pattern that was read is written, and read again as the same
// pattern.

#include "ayumi/io/pattern/pattern_file.hpp"
#include "fuzz_target.hpp"

namespace {

// Comments name the parameters, whose values stand in the text instead.
std::string without_comments(const std::string& text) {
  size_t begin = 0;
  while (text.compare(begin, 2, "//") == 0) begin = text.find('\n', begin) + 1;
  return text.substr(begin);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace ayumi;
  const auto parts = fuzz::parts_of({reinterpret_cast<const char*>(data), size});
  const fuzz::InputFolder folder(parts, "pattern.json");
  Pattern pattern;
  if (!fuzz::accepts([&] { pattern = read_pattern(folder.path("pattern.json")); })) {
    fuzz::accepts([&] { read_posture_library(folder.path("pattern.json")); });
    return 0;
  }
  const std::string text = pattern_text(pattern);
  std::string again;
  fuzz::expect(fuzz::accepts(
                   [&] { again = pattern_text(pattern_of_text(text, folder.path("again.json"))); }),
               "what write_pattern writes is read");
  fuzz::expect(without_comments(again) == without_comments(text),
               "a pattern that was written and read is the same");
  return 0;
}
