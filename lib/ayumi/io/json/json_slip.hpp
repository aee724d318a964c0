#pragma once
// What an author has mistyped in a text that is no JSON, in words about the text: a comma, a
// quotation mark, a colon or a bracket that is missing or too many, a word or a number that JSON
// writes otherwise. The library that reads JSON names the token at which it gave up, which is often
// a line after the slip.

#include <cstddef>
#include <optional>
#include <string>

namespace ayumi {

struct JsonSlip {
  size_t at = 0;      ///< where to put the text right; its size where the end is missing
  std::string words;  ///< "a comma is missing after \"home\""
};

/// The first slip of a text that the reader of JSON refuses; nothing where none is recognized.
std::optional<JsonSlip> find_json_slip(const std::string& text);

}  // namespace ayumi
