#include "ayumi/io/pattern/pattern_edit.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/json/json_text.hpp"
#include "ayumi/io/pattern/expression.hpp"

namespace ayumi {

namespace {

/// Edits are rounded to a millionth of the unit. Chosen: far below a tick, a tenth of a millimetre
/// and a thousandth of a degree, so that sums do not show digits of rounding.
constexpr double kFinest = 1e-6;

double rounded(double value) { return std::round(value / kFinest) * kFinest; }

// Zero is written without a sign.
std::string number_text(double value) {
  return text::exact(std::stod(text::fixed(value, 6)) + 0.0);
}

using Parameters = std::map<std::string, double>;

// The parameters that an expression at this place may name, with the values that are set from
// outside. The count of a block around the place is 0, as in its first round.
Parameters parameters_at(const Json& document, const std::string& pointer, const Parameters& set) {
  Parameters parameters = set;
  if (document.is_object() && document.contains("parameters"))
    for (const auto& [name, value] : document["parameters"].items())
      if (value.is_number()) parameters.try_emplace(name, value.get<double>());
  for (Json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer())
    if (document.contains(at) && document[at].is_object() && document[at].contains("count") &&
        document[at]["count"].is_string())
      parameters[document[at]["count"]] = 0;
  return parameters;
}

struct Place {
  std::string around, name;
};

Place split(const std::string& pointer) {
  const size_t slash = pointer.rfind('/');
  if (slash == std::string::npos)
    fail(ErrorCode::usage, "'" + pointer + "' is not the place of a value");
  return {pointer.substr(0, slash), pointer.substr(slash + 1)};
}

std::string unescaped(const std::string& token) { return Json::json_pointer("/" + token).back(); }

// The text of a number that replaces the value `before`.
std::string replacing(const Json& document, const std::string& pointer, const Json& before,
                      const Json& wanted, const Parameters& parameters) {
  if (!wanted.is_number()) return wanted.dump();
  const double value = wanted.get<double>();
  if (!before.is_string() || !is_expression(before.get<std::string>())) return number_text(value);
  const std::string expression = before;
  try {
    const double now = evaluate_expression(expression, parameters_at(document, pointer, parameters),
                                           {"the pattern"});
    return Json(shifted_expression(expression, value - now)).dump();
  } catch (const Error&) {  // an expression without a value: the number replaces it
    return number_text(value);
  }
}

// A value as text with the spaces that patterns of this program have: { "a": 1, "b": [1, 2] }.
std::string spaced(const Json& value) {
  if (value.is_number_float()) return number_text(value.get<double>());
  if (value.is_object()) {
    std::vector<std::string> members;
    for (const auto& [key, member] : value.items())
      members.push_back(Json(key).dump() + ": " + spaced(member));
    return members.empty() ? "{}" : "{ " + text::join(members, ", ") + " }";
  }
  if (value.is_array()) {
    std::vector<std::string> items;
    for (const Json& item : value) items.push_back(spaced(item));
    return "[" + text::join(items, ", ") + "]";
  }
  return value.dump();
}

// The members of an object in the order of the text.
std::string spaced_in_order(const std::string& value) {
  const auto ordered = nlohmann::ordered_json::parse(value);
  if (!ordered.is_object()) return spaced(Json::parse(value));
  std::vector<std::string> members;
  for (const auto& [key, member] : ordered.items())
    members.push_back(Json(key).dump() + ": " + spaced_in_order(member.dump()));
  return members.empty() ? "{}" : "{ " + text::join(members, ", ") + " }";
}

std::string set(const std::string& text, const Json& document, const PatternEdit& edit,
                const Parameters& parameters) {
  if (const auto at = find_value(text, edit.pointer)) {
    const Json before =
        Json::parse(text.substr(at->begin, at->end - at->begin), nullptr, true, true);
    const Json wanted = Json::parse(edit.value);
    if (before == wanted) return text;
    const bool plain = wanted.is_primitive();
    return with_value(text, edit.pointer,
                      plain ? replacing(document, edit.pointer, before, wanted, parameters)
                            : spaced_in_order(edit.value));
  }
  // Missing members are added to the innermost object that exists, together as one member.
  Place place = split(edit.pointer);
  std::string value = spaced_in_order(edit.value);
  while (!find_value(text, place.around)) {
    value = "{ " + Json(unescaped(place.name)).dump() + ": " + value + " }";
    place = split(place.around);
  }
  return with_member(text, place.around, unescaped(place.name), value);
}

// The index at which an edit changes the items of a list; "-" means after the last item.
size_t item_index(const PatternEdit& edit, size_t size) {
  const Place place = split(edit.pointer);
  if (place.name == "-") return size;
  size_t index = 0;
  const char* end = place.name.data() + place.name.size();
  if (std::from_chars(place.name.data(), end, index).ptr != end || place.name.empty())
    fail(ErrorCode::usage, "'" + edit.pointer + "' does not end with an index");
  return index;
}

std::string insert(const std::string& text, const Json& document, const PatternEdit& edit) {
  const Place place = split(edit.pointer);
  if (!find_value(text, place.around)) {
    if (place.name != "-")
      fail(ErrorCode::usage,
           "the pattern has no list " + place.around + "; the pattern may have changed");
    return set(text, document,
               {PatternEdit::Kind::set, place.around, "[" + spaced_in_order(edit.value) + "]"}, {});
  }
  const Json list = document.at(Json::json_pointer(place.around));
  return with_item(text, place.around, item_index(edit, list.size()), spaced_in_order(edit.value));
}

// The items stand in the block as they stood in the list, with their comments.
std::string repeated(const std::string& text, const PatternEdit& edit) {
  const Place place = split(edit.pointer);
  auto block = nlohmann::ordered_json::parse(edit.value);
  const size_t first = item_index(edit, 0), items = block.value("items", size_t(0));
  block.erase("items");
  const auto begin = find_value(text, edit.pointer);
  const auto end = items > 0
                       ? find_value(text, place.around + "/" + std::to_string(first + items - 1))
                       : std::nullopt;
  if (!begin || !end)
    fail(ErrorCode::usage, "the list does not have " + std::to_string(items) + " items from '" +
                               edit.pointer + "' on");
  const size_t line = text.rfind('\n', begin->begin) + 1;  // 0 if there is no line before
  const size_t word = text.find_first_not_of(" \t", line);
  const bool own_line = word == begin->begin;
  const std::string indent = own_line ? text.substr(line, word - line) : "";
  const std::string line_end = text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
  const std::string gap = own_line ? line_end + indent : " ";
  const std::string name = split(place.around).name;
  std::string head = spaced_in_order(block.dump());
  head.replace(head.size() - 2, 2, ", " + Json(name).dump() + ": [" + gap);
  return text.substr(0, begin->begin) + head + text.substr(begin->begin, end->end - begin->begin) +
         gap + "] }" + text.substr(end->end);
}

std::string applied(const std::string& text, const PatternEdit& edit,
                    const Parameters& parameters) {
  const Json document = parse_json(text, "the pattern", ErrorCode::bad_pattern);
  if (edit.kind == PatternEdit::Kind::remove) return without_value(text, edit.pointer);
  if (!Json::accept(edit.value))
    fail(ErrorCode::bad_pattern, edit.pointer + ": '" + edit.value + "' is not a value");
  if (edit.kind == PatternEdit::Kind::insert) return insert(text, document, edit);
  if (edit.kind == PatternEdit::Kind::repeat) return repeated(text, edit);
  return set(text, document, edit, parameters);
}

// Whether an edit moves the items after it.
bool moves_items(const Json& document, const PatternEdit& edit) {
  if (edit.kind == PatternEdit::Kind::insert || edit.kind == PatternEdit::Kind::repeat) return true;
  if (edit.kind == PatternEdit::Kind::set) return false;
  const Json::json_pointer around(split(edit.pointer).around);
  return document.contains(around) && document.at(around).is_array();
}

// Pointers refer to the text before the first edit. So edits that move items come last, and they go
// from the end of a list to its beginning.
std::vector<PatternEdit> in_working_order(const Json& document,
                                          const std::vector<PatternEdit>& edits) {
  std::vector<PatternEdit> first, last;
  for (const PatternEdit& edit : edits)
    (moves_items(document, edit) ? last : first).push_back(edit);
  std::reverse(last.begin(), last.end());
  const auto size_around = [&](const PatternEdit& edit) -> size_t {
    const Json::json_pointer around(split(edit.pointer).around);
    return document.contains(around) ? document.at(around).size() : 0;
  };
  const auto place = [&](const PatternEdit& edit) { return item_index(edit, size_around(edit)); };
  std::stable_sort(last.begin(), last.end(),
                   [&](const PatternEdit& a, const PatternEdit& b) { return place(a) > place(b); });
  // If several items are added at the end, the last one is added first, and each other item is put
  // before it.
  std::set<std::string> extended;
  for (PatternEdit& edit : last) {
    const Place at = split(edit.pointer);
    if (at.name == "-" && !extended.insert(at.around).second)
      edit.pointer = at.around + "/" + std::to_string(size_around(edit));
  }
  first.insert(first.end(), last.begin(), last.end());
  return first;
}

}  // namespace

std::string shifted_expression(const std::string& expression, double change) {
  const double step = rounded(change);
  if (step == 0) return expression;
  // Changes a number after the last + or - that is outside brackets and names, if nothing follows
  // it.
  int depth = 0;
  size_t sign = std::string::npos;
  for (size_t i = 0; i < expression.size(); ++i) {
    const char c = expression[i];
    if (c == '(' || c == '{') ++depth;
    if (c == ')' || c == '}') --depth;
    const bool exponent = i > 0 && (expression[i - 1] == 'e' || expression[i - 1] == 'E');
    if (depth == 0 && i > 0 && !exponent && (c == '+' || c == '-')) sign = i;
  }
  double number = 0;
  std::string head = expression, spaces = " ", spaces_after = " ";
  if (sign != std::string::npos) {
    size_t begin = sign + 1;
    while (begin < expression.size() && expression[begin] == ' ') ++begin;
    const char* end = expression.data() + expression.size();
    const auto read = std::from_chars(expression.data() + begin, end, number);
    const size_t before = expression.find_last_not_of(' ', sign - 1);
    const bool binary = before != std::string::npos &&
                        std::string("+-*/(").find(expression[before]) == std::string::npos;
    if (read.ec == std::errc() && read.ptr == end && binary && expression[begin] != '-') {
      if (expression[sign] == '-') number = -number;
      head = expression.substr(0, before + 1);
      // The blanks around the sign stay as the author writes them.
      spaces = expression.substr(before + 1, sign - before - 1);
      spaces_after = expression.substr(sign + 1, begin - sign - 1);
    } else {
      number = 0;
    }
  }
  const double sum = rounded(number + step);
  if (sum == 0) return head;
  return head + spaces + (sum < 0 ? "-" : "+") + spaces_after + number_text(std::abs(sum));
}

double value_in_text(const std::string& text, const std::string& pointer,
                     const std::map<std::string, double>& set) {
  const Json document = parse_json(text, "the pattern", ErrorCode::bad_pattern);
  const Json::json_pointer at(pointer);
  const Json value = document.contains(at) ? document[at] : Json();
  if (value.is_number()) return value.get<double>();
  if (!value.is_string()) fail(ErrorCode::usage, "'" + pointer + "' is not the place of a number");
  return evaluate_expression(value.get<std::string>(), parameters_at(document, pointer, set),
                             {"the pattern", pointer});
}

std::string edited_text(const std::string& text, const std::vector<PatternEdit>& edits,
                        const std::map<std::string, double>& set) {
  const Json document = parse_json(text, "the pattern", ErrorCode::bad_pattern);
  std::string now = text;
  for (const PatternEdit& edit : in_working_order(document, edits)) now = applied(now, edit, set);
  return now;
}

}  // namespace ayumi
