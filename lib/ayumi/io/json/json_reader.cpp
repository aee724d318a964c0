#include "ayumi/io/json/json_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/utf8.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/json/json_slip.hpp"

namespace ayumi {

namespace {

std::string kind_of(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array of length " + std::to_string(value.size());
    case Json::value_t::string:
      return "a string";
    case Json::value_t::boolean:
      return value.get<bool>() ? "true" : "false";
    default:
      return "the number " + value.dump();
  }
}

// Throws "file:line:column: message" for a place in the text.
[[noreturn]] void fail_in_text(ErrorCode code, const std::string& file, const std::string& bytes,
                               size_t offset, const std::string& message,
                               bool names_remedy = false) {
  int line = 1, column = 1;
  for (size_t i = 0; i < std::min(offset, bytes.size()); ++i) {
    column = bytes[i] == '\n' ? 1 : column + 1;
    line += bytes[i] == '\n';
  }
  SourcePlace place{file, "", line, column};
  place.names_remedy = names_remedy;
  fail(code, place, message);
}

// The reason in a message of the library: "[json.exception...] parse error at line 1, column 2:
// what" becomes "what", and "[...] what" becomes "what".
std::string reason_of(const std::string& message) {
  const size_t at = message.find("column ");
  if (at == std::string::npos) return message.substr(message.find("] ") + 2);
  const size_t colon = message.find(": ", at);
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

// Builds a document in a time that is linear in the length of its text. The library's own parser
// with a callback would visit all members of an object again after each of them. Stops at a value
// that is nested too deeply and at a text with the character U+0000, and remembers the first key
// that is given twice.
class DocumentBuilder : public nlohmann::json_sax<Json> {
 public:
  explicit DocumentBuilder(Json& root) : root_(root) {}
  bool too_deep() const { return too_deep_; }
  bool has_zero() const { return has_zero_; }
  const std::string& duplicate() const { return duplicate_; }

  bool null() override { return place(nullptr); }
  bool boolean(bool value) override { return place(value); }
  bool number_integer(number_integer_t value) override { return place(value); }
  bool number_unsigned(number_unsigned_t value) override { return place(value); }
  bool number_float(number_float_t value, const string_t&) override { return place(value); }
  bool string(string_t& value) override { return has_no_zero(value) && place(std::move(value)); }
  bool binary(binary_t& value) override { return place(std::move(value)); }
  bool start_object(std::size_t) override { return open(Json::object()); }
  bool start_array(std::size_t) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    if (!has_no_zero(name)) return false;
    const auto [member, fresh] = open_.back()->get_ref<Json::object_t&>().emplace(name, nullptr);
    if (!fresh && duplicate_.empty()) duplicate_ = name;
    member_ = &member->second;
    return true;
  }
  bool parse_error(std::size_t, const std::string&, const Json::exception& error) override {
    if (const auto* syntax = dynamic_cast<const Json::parse_error*>(&error)) throw *syntax;
    if (const auto* range = dynamic_cast<const Json::out_of_range*>(&error)) throw *range;
    fail(ErrorCode::internal, std::string("JSON: ") + error.what());
  }

 private:
  template <typename Value>
  bool place(Value&& value) {
    put(std::forward<Value>(value));
    return true;
  }
  bool has_no_zero(const std::string& text) {
    has_zero_ = text.find('\0') != std::string::npos;
    return !has_zero_;
  }
  bool open(Json&& empty) {
    too_deep_ = open_.size() >= static_cast<size_t>(kDeepestNesting);
    if (!too_deep_) open_.push_back(put(std::move(empty)));
    return !too_deep_;
  }
  bool close() {
    open_.pop_back();
    return true;
  }
  template <typename Value>
  Json* put(Value&& value) {
    Json* at = &root_;
    if (!open_.empty() && open_.back()->is_array())
      at = &open_.back()->emplace_back();
    else if (!open_.empty())
      at = member_;
    *at = std::forward<Value>(value);
    return at;
  }

  Json& root_;
  std::vector<Json*> open_;  // arrays and objects that are not yet complete
  Json* member_ = nullptr;   // the value that belongs to the last key of the innermost object
  bool too_deep_ = false;
  bool has_zero_ = false;
  std::string duplicate_;
};

// Where an escaped U+0000 stands. After an odd number of backslashes, "u0000" is such an escape.
size_t place_of_zero(const std::string& bytes) {
  for (size_t at = bytes.find("u0000"); at != std::string::npos; at = bytes.find("u0000", at + 1)) {
    size_t backslashes = 0;
    while (backslashes < at && bytes[at - 1 - backslashes] == '\\') ++backslashes;
    if (backslashes % 2 == 1) return at - 1;
  }
  return 0;
}

}  // namespace

Json parse_json(const std::string& bytes, const std::string& file, ErrorCode code) {
  const bool blank =
      std::all_of(bytes.begin(), bytes.end(), [](unsigned char c) { return std::isspace(c); });
  if (blank) fail(code, {file}, "the file is empty, but JSON is needed");
  if (const std::string refusal = text::wide_encoding_refusal(bytes); !refusal.empty())
    fail(code, {file}, refusal);
  Json document;
  DocumentBuilder builder(document);
  try {
    Json::sax_parse(bytes, &builder, Json::input_format_t::json, true, true);
  } catch (const Json::parse_error& error) {
    const size_t offset = error.byte > 0 ? error.byte - 1 : 0;
    const std::string reason = reason_of(error.what());
    if (reason.find("UTF-8") != std::string::npos)
      fail_in_text(
          code, file, bytes, offset,
          "the text is not UTF-8 here. The file may have another encoding, such as Latin-1 "
          "or Shift-JIS; save the file as UTF-8");
    if (const auto slip = find_json_slip(bytes))
      fail_in_text(code, file, bytes, slip->at, slip->words, slip->in_number);
    fail_in_text(code, file, bytes, offset, reason);
  } catch (const Json::exception& error) {
    // The text has a number that no double can hold; it stands between quotes at the end of the
    // message.
    const std::string reason = reason_of(error.what());
    const size_t quote = reason.find('\'');
    const size_t at = quote == std::string::npos
                          ? std::string::npos
                          : bytes.find(reason.substr(quote + 1, reason.size() - quote - 2));
    fail_in_text(code, file, bytes, at == std::string::npos ? 0 : at,
                 "the JSON cannot be used: " + reason);
  }
  if (builder.too_deep())
    fail_in_text(code, file, bytes, nested_too_deep(bytes).value_or(bytes.size()),
                 "arrays and objects are nested more than " + std::to_string(kDeepestNesting) +
                     " levels deep; correct the brackets");
  if (builder.has_zero())
    fail_in_text(
        code, file, bytes, place_of_zero(bytes),
        "this text has the character U+0000, which a file name or a message cannot contain; "
        "remove this character");
  if (!builder.duplicate().empty())
    fail(code, {file},
         "the key '" + builder.duplicate() + "' appears twice in one object; keep one");
  return document;
}

JsonPlace JsonNode::place() const {
  if (!places_) return {file_, pointer_};
  std::string around = pointer_;
  while (!places_->contains(around) && !around.empty()) around.erase(around.rfind('/'));
  const auto found = places_->find(around);
  if (found == places_->end()) return {file_, pointer_};
  return {found->second.file, found->second.pointer + pointer_.substr(around.size())};
}

void JsonNode::complain(const std::string& message, bool names_remedy) const {
  const JsonPlace at = place();
  const std::string words = (at.pointer.empty() ? "/" : at.pointer) + ": " + message;
  SourcePlace here{at.file, at.pointer};
  here.names_remedy = names_remedy;
  throw Error(code_, at.file + ": " + words, here, words);
}

JsonNode JsonNode::child(const std::string& token, const Json& value) const {
  return {value, file_, pointer_ + "/" + json_pointer_token(token), code_, places_};
}

void JsonNode::expect_object() const {
  if (!value_->is_object()) complain("expected an object, found " + kind_of(*value_));
}

void JsonNode::expect_array() const {
  if (!value_->is_array()) complain("expected an array, found " + kind_of(*value_));
}

bool JsonNode::has(const std::string& key) const {
  expect_object();
  return value_->contains(key);
}

JsonNode JsonNode::at(const std::string& key) const {
  if (!has(key)) complain("the key '" + key + "' is missing");
  return child(key, (*value_)[key]);
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return child(key, (*value_)[key]);
}

std::vector<JsonNode> JsonNode::items() const {
  expect_array();
  std::vector<JsonNode> nodes;
  for (size_t i = 0; i < value_->size(); ++i)
    nodes.push_back(child(std::to_string(i), (*value_)[i]));
  return nodes;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  expect_object();
  std::vector<std::pair<std::string, JsonNode>> nodes;
  for (const auto& [key, value] : value_->items()) nodes.emplace_back(key, child(key, value));
  return nodes;
}

void JsonNode::only_keys(const std::vector<std::string>& known) const {
  const auto allowed = [&] { return "; the keys allowed here are " + text::join(known, ", "); };
  if (!value_->is_object()) complain("expected an object, found " + kind_of(*value_) + allowed());
  for (const auto& [key, value] : value_->items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string hint = text::suggestion(key, known);
    child(key, value).complain("unknown key" + (hint.empty() ? allowed() : hint));
  }
}

double JsonNode::number() const {
  if (!value_->is_number()) complain("expected a number, found " + kind_of(*value_));
  const double number = value_->get<double>();
  if (!std::isfinite(number)) complain("expected a finite number");
  return number;
}

double JsonNode::number_within(double lower, double upper) const {
  const double value = number();
  if (value < lower)
    complain(text::exact(value) + " is too small; the smallest allowed value is " +
             text::exact(lower));
  if (value > upper)
    complain(text::exact(value) + " is too large; the largest allowed value is " +
             text::exact(upper));
  return value;
}

int JsonNode::integer() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
    complain("expected a whole number, found " + text::exact(value));
  return static_cast<int>(value);
}

std::uint64_t JsonNode::unsigned_integer() const {
  if (!value_->is_number_unsigned())
    complain("expected a whole number of at least 0, found " + kind_of(*value_));
  return value_->get<std::uint64_t>();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) complain("expected true or false, found " + kind_of(*value_));
  return value_->get<bool>();
}

std::string JsonNode::string() const {
  if (!value_->is_string()) complain("expected a string, found " + kind_of(*value_));
  return value_->get<std::string>();
}

std::string JsonNode::one_of(const std::vector<std::string>& allowed) const {
  const std::string value = string();
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    complain("'" + value + "'" +
             (allowed.size() == 1
                  ? " is not allowed; the only allowed value is '" + allowed.front() + "'"
                  : " is not allowed; the allowed values are " + text::join(allowed, ", ")) +
             (allowed.size() == 1 ? "" : text::suggestion(value, allowed)));
  return value;
}

Eigen::VectorXd JsonNode::vector(int size) const {
  const std::string wanted = "expected " + std::to_string(size) + " numbers, found ";
  if (!value_->is_array() || static_cast<int>(value_->size()) != size)
    complain(wanted + kind_of(*value_));
  const std::vector<double> values = numbers();
  return Eigen::Map<const Eigen::VectorXd>(values.data(), size);
}

Eigen::Vector2d JsonNode::vector2() const { return vector(2); }
Eigen::Vector3d JsonNode::vector3() const { return vector(3); }

std::vector<double> JsonNode::numbers() const {
  std::vector<double> values;
  for (const JsonNode& item : items()) values.push_back(item.number());
  return values;
}

std::vector<std::string> JsonNode::strings() const {
  std::vector<std::string> values;
  for (const JsonNode& item : items()) values.push_back(item.string());
  return values;
}

}  // namespace ayumi
