#pragma once
// Pieces of pattern files as text, and the world and the disturbances of a scenario in the form of
// pattern files. Logs contain the same form, in radians.

#include <charconv>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

inline std::string quoted(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

inline std::string number(double value) { return value == 0 ? "0" : text::exact(value); }

// The shortest number of degrees that gives the same radians again, or the nearest number if no
// double does.
inline std::string degrees(double radians) {
  const double value = radians / kRadiansPerDegree;
  for (int digits = 1; digits <= 17; ++digits) {
    const std::string attempt = text::brief(value, digits);
    double read = 0;
    std::from_chars(attempt.data(), attempt.data() + attempt.size(), read);
    if (read * kRadiansPerDegree == radians) return number(read);
  }
  return number(value);
}

// The members of one object or array, in order.
class Members {
 public:
  Members& add(const std::string& key, const std::string& value) {
    items_.push_back(quoted(key) + ": " + value);
    return *this;
  }
  Members& item(const std::string& value) {
    items_.push_back(value);
    return *this;
  }
  bool empty() const { return items_.empty(); }
  std::string object() const {
    return items_.empty() ? "{}" : "{ " + text::join(items_, ", ") + " }";
  }
  std::string array() const { return "[" + text::join(items_, ", ") + "]"; }
  /// The text with one member on each line.
  std::string lines(char open, char close, const std::string& indent) const {
    return open + ("\n" + indent + "  ") + text::join(items_, ",\n" + indent + "  ") + "\n" +
           indent + close;
  }

 private:
  std::vector<std::string> items_;
};

inline std::string angle_text(double radians, bool in_degrees) {
  return in_degrees ? degrees(radians) : number(radians);
}

inline std::string vector_text(const Eigen::Ref<const Eigen::VectorXd>& v) {
  Members list;
  for (const double value : v) list.item(number(value));
  return list.array();
}

std::string world_text(const World& world, bool in_degrees);
/// The object "uncertainty" of a pattern file.
std::string uncertainty_text(const Uncertainty& uncertainty, bool in_degrees);
std::string disturbance_text(const Disturbance& disturbance, bool in_degrees);

}  // namespace ayumi
