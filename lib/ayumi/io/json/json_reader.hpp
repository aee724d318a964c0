#pragma once
// Strict reading of JSON documents. Every complaint names the file, the JSON pointer and what was
// expected, e.g. "step.json: /keyframes/3/time: expected a number, found a string". Comments are
// allowed; duplicate keys, trailing text and numbers that are not finite are refused. In the
// library, only files below io include it.

#include <Eigen/Core>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/base/error.hpp"

namespace ayumi {

using Json = nlohmann::json;

/// The place of a value: a file and a JSON pointer in this file.
struct JsonPlace {
  std::string file, pointer;
};

/// Places of the values of a document that was merged from several files, by pointer. For a value
/// that is not listed, the innermost listed value around it counts: the value is below its place.
using JsonPlaces = std::map<std::string, JsonPlace>;

/// One value of a JSON document together with its place. It is cheap to copy, and the document must
/// outlive it.
class JsonNode {
 public:
  JsonNode(const Json& value, std::string file, std::string pointer, ErrorCode code,
           const JsonPlaces* places = nullptr)
      : value_(&value),
        file_(std::move(file)),
        pointer_(std::move(pointer)),
        code_(code),
        places_(places) {}

  const Json& value() const { return *value_; }
  JsonPlace place() const;
  std::string file() const { return place().file; }
  std::string pointer() const { return place().pointer; }

  /// Throws Error "file: pointer: message".
  /// `names_remedy` as in SourcePlace.
  [[noreturn]] void complain(const std::string& message, bool names_remedy = false) const;

  bool has(const std::string& key) const;
  JsonNode at(const std::string& key) const;                   ///< complains if the key is missing
  std::optional<JsonNode> find(const std::string& key) const;  ///< no value if the key is missing
  std::vector<JsonNode> items() const;  ///< items of an array; complains otherwise
  std::vector<std::pair<std::string, JsonNode>> members()
      const;  ///< members of an object, sorted by key
  size_t size() const { return value_->size(); }

  void expect_object() const;
  void expect_array() const;
  /// Complains about the first key outside `known`, with the nearest known one.
  void only_keys(const std::vector<std::string>& known) const;

  double number() const;  ///< the number must be finite
  /// Complains with the limit if the number is outside [lower, upper].
  double number_within(double lower, double upper) const;
  int integer() const;
  std::uint64_t unsigned_integer() const;
  bool boolean() const;
  std::string string() const;
  /// A string that must be one of `allowed`; an error suggests the nearest of them.
  std::string one_of(const std::vector<std::string>& allowed) const;
  Eigen::Vector2d vector2() const;
  Eigen::Vector3d vector3() const;
  std::vector<double> numbers() const;
  std::vector<std::string> strings() const;

 private:
  JsonNode child(const std::string& token, const Json& value) const;
  Eigen::VectorXd vector(int size) const;

  const Json* value_;
  std::string file_, pointer_;
  ErrorCode code_;
  const JsonPlaces* places_;
};

/// Parses `bytes`. Throws Error(code) "file:line:column: what" if they are not JSON.
Json parse_json(const std::string& bytes, const std::string& file, ErrorCode code);

/// The root of a parsed document.
inline JsonNode root_of(const Json& document, const std::string& file, ErrorCode code) {
  return {document, file, "", code};
}

}  // namespace ayumi
