#pragma once
// The part of JSON Schema (draft 2020-12) that the project's own schemas use, to test them with.

#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>

namespace ayumi::test {

/// Whether `value` fits `schema`; `root` contains the definitions. Throws std::logic_error for a
/// keyword that is not handled here, so that no rule of a schema remains untested.
class JsonSchema {
 public:
  using Json = nlohmann::json;
  explicit JsonSchema(Json root) : root_(std::move(root)) {}

  bool accepts(const Json& value) const { return fits(root_, value); }

 private:
  bool fits(const Json& schema, const Json& value) const {
    for (const auto& [keyword, rule] : schema.items())
      if (!keeps(keyword, rule, schema, value)) return false;
    return true;
  }

  bool keeps(const std::string& keyword, const Json& rule, const Json& schema,
             const Json& value) const {
    for (const char* const note : {"$schema", "$id", "$defs", "title", "description"})
      if (keyword == note) return true;
    if (keyword == "$ref")
      return fits(root_.at(Json::json_pointer(rule.get<std::string>().substr(1))), value);
    if (keyword == "type") return is(rule, value);
    if (keyword == "const") return value == rule;
    if (keyword == "enum") return std::find(rule.begin(), rule.end(), value) != rule.end();
    if (keyword == "allOf") return matches(rule, value) == static_cast<int>(rule.size());
    if (keyword == "oneOf") return matches(rule, value) == 1;
    if (keyword == "anyOf") return matches(rule, value) > 0;
    if (keyword == "not") return !fits(rule, value);
    if (value.is_number()) return number_keeps(keyword, rule, value.get<double>());
    if (value.is_string()) return string_keeps(keyword, rule, value.get<std::string>());
    if (value.is_array()) return array_keeps(keyword, rule, value);
    if (value.is_object()) return object_keeps(keyword, rule, schema, value);
    return true;
  }

  static bool is(const std::string& type, const Json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "number") return value.is_number();
    if (type == "boolean") return value.is_boolean();
    if (type == "integer") return value.is_number_integer();
    throw std::logic_error("type " + type);
  }

  int matches(const Json& schemas, const Json& value) const {
    int count = 0;
    for (const Json& schema : schemas) count += fits(schema, value);
    return count;
  }

  static bool number_keeps(const std::string& keyword, const Json& rule, double value) {
    if (keyword == "minimum") return value >= rule.get<double>();
    if (keyword == "maximum") return value <= rule.get<double>();
    if (keyword == "exclusiveMinimum") return value > rule.get<double>();
    return others(keyword);
  }

  static bool string_keeps(const std::string& keyword, const Json& rule, const std::string& value) {
    if (keyword == "minLength") return value.size() >= rule.get<size_t>();
    if (keyword == "pattern") return std::regex_search(value, std::regex(rule.get<std::string>()));
    return others(keyword);
  }

  bool array_keeps(const std::string& keyword, const Json& rule, const Json& value) const {
    if (keyword == "minItems") return value.size() >= rule.get<size_t>();
    if (keyword == "maxItems") return value.size() <= rule.get<size_t>();
    if (keyword == "contains")
      return std::any_of(value.begin(), value.end(),
                         [&](const Json& item) { return fits(rule, item); });
    if (keyword == "items")
      return std::all_of(value.begin(), value.end(),
                         [&](const Json& item) { return fits(rule, item); });
    return others(keyword);
  }

  bool object_keeps(const std::string& keyword, const Json& rule, const Json& schema,
                    const Json& value) const {
    const auto has = [&](const Json& key) { return value.contains(key.get<std::string>()); };
    if (keyword == "required") return std::all_of(rule.begin(), rule.end(), has);
    if (keyword == "minProperties") return value.size() >= rule.get<size_t>();
    if (keyword == "maxProperties") return value.size() <= rule.get<size_t>();
    const Json properties = schema.value("properties", Json::object());
    for (const auto& [key, item] : value.items()) {
      if (keyword == "properties" && rule.contains(key) && !fits(rule.at(key), item)) return false;
      if (keyword == "propertyNames" && !fits(rule, key)) return false;
      if (keyword == "dependentRequired" && rule.contains(key) &&
          !std::all_of(rule.at(key).begin(), rule.at(key).end(), has))
        return false;
      if (keyword == "additionalProperties" && !properties.contains(key) &&
          (rule.is_boolean() ? !rule.get<bool>() : !fits(rule, item)))
        return false;
    }
    return others(keyword);
  }

  // Rules for other types of value do not concern this value; unknown rules do.
  static bool others(const std::string& keyword) {
    for (const char* const known :
         {"minimum", "maximum", "exclusiveMinimum", "minLength", "pattern", "minItems", "maxItems",
          "items", "contains", "required", "minProperties", "maxProperties", "properties",
          "propertyNames", "dependentRequired", "additionalProperties"})
      if (keyword == known) return true;
    throw std::logic_error("the keyword " + keyword + " is not handled");
  }

  Json root_;
};

}  // namespace ayumi::test
