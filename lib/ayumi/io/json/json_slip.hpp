#pragma once
// Finds what an author has mistyped in a text that is not JSON. It may be a comma, a quotation
// mark, a colon or a bracket that is missing or superfluous, or a word or number that JSON writes
// in another way. The library that reads JSON names the token at which it gave up, which is often a
// line after the mistake.

#include <cstddef>
#include <optional>
#include <string>

namespace ayumi {

struct JsonSlip {
  size_t at = 0;           ///< place at which to correct the text; its size if the end is missing
  std::string words;       ///< "a comma is missing after \"home\""
  bool in_number = false;  ///< whether the decimal point of a number is missing or wrong
};

/// The first mistake in a text that the reader of JSON refuses; nothing if none is recognized.
std::optional<JsonSlip> find_json_slip(const std::string& text);

}  // namespace ayumi
