#pragma once
// Finds the places of values in a JSON text with comments, and changes single values. Every other
// byte of the text stays the same: comments, order, spacing and the form of numbers.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ayumi {

/// The place of a value, from `begin` to before `end`. `key` is the place of its key in an object.
struct JsonSpan {
  size_t key = 0, begin = 0, end = 0;
};

/// A value and the values inside it, in the order of the text.
struct JsonTree {
  JsonSpan at;
  std::string name;             ///< key or index of the value in its object or array
  char kind = 'v';              ///< '{', '[' or 'v' for a value without parts
  std::vector<JsonTree> parts;  ///< parts of an object or array
};

/// The text must be JSON that parse_json() reads. A byte order mark (UTF-8) before it belongs to no
/// value.
JsonTree json_tree(const std::string& text);

/// The place of the value of a JSON pointer; nothing if there is none.
std::optional<JsonSpan> find_value(const std::string& text, const std::string& pointer);

/// The value that is nearest to the pointer: the value of the pointer, or the innermost existing
/// one around it.
JsonSpan nearest_value(const std::string& text, const std::string& pointer);

/// The line of a place in a text, counted from 1.
int line_at(const std::string& text, size_t place);

/// The text with another text instead of an existing value.
std::string with_value(const std::string& text, const std::string& pointer,
                       const std::string& value);

/// The text with one more member at the end of the object at `pointer`. The member has its own line
/// if the other members have.
std::string with_member(const std::string& text, const std::string& pointer, const std::string& key,
                        const std::string& value);

/// The text with one more item in the array at `pointer`, at this index. A comment after the
/// previous item on its line stays there.
std::string with_item(const std::string& text, const std::string& pointer, size_t index,
                      const std::string& value);

/// The same for several items, in their order.
std::string with_items(const std::string& text, const std::string& pointer, size_t index,
                       const std::vector<std::string>& values);

/// The text without the member or item at `pointer`, without its comma, and without its line if
/// nothing else is on it.
std::string without_value(const std::string& text, const std::string& pointer);

}  // namespace ayumi
