#pragma once
// JSON in the tests. What is compiled once here takes seconds in every test program that names it.

#include <iosfwd>
#include <nlohmann/json.hpp>
#include <string>

namespace ayumi::test {

/// The value of a JSON text, which may have comments only if `comments` says so. Throws
/// nlohmann::json::parse_error.
nlohmann::json json_of(const std::string& text, bool comments = false);

/// The value of a JSON text with comments, or a discarded value if the text is no such text.
nlohmann::json json_or_nothing(const std::string& text);

}  // namespace ayumi::test

namespace nlohmann {

/// GoogleTest prints a value that is not the expected one by this function.
void PrintTo(const json& value, std::ostream* out);

}  // namespace nlohmann
