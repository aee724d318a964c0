#include "tests/support/json.hpp"

#include <ostream>

namespace ayumi::test {

nlohmann::json json_of(const std::string& text, bool comments) {
  return nlohmann::json::parse(text, nullptr, true, comments);
}

nlohmann::json json_or_nothing(const std::string& text) {
  return nlohmann::json::parse(text, nullptr, false, true);
}

}  // namespace ayumi::test

namespace nlohmann {

void PrintTo(const json& value, std::ostream* out) { *out << value.dump(); }

}  // namespace nlohmann
