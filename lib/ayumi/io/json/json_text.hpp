#pragma once
// Where the values of a JSON text with comments stand, and changes of single values that leave
// every other byte of the text as it is: comments, order, spacing and the form of numbers stay.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ayumi {

/// A value, from `begin` to before `end`; `key` is where its key begins in an object.
struct JsonSpan {
  size_t key = 0, begin = 0, end = 0;
};

/// A value with the values in it, in the order of the text.
struct JsonTree {
  JsonSpan at;
  std::string name;             ///< key or index in the value around it
  char kind = 'v';              ///< '{', '[' or 'v' for a value without parts
  std::vector<JsonTree> parts;  ///< of an object or array
};

/// The text must be JSON that parse_json() reads.
JsonTree json_tree(const std::string& text);

/// Where the value of a JSON pointer stands; nothing where there is none.
std::optional<JsonSpan> find_value(const std::string& text, const std::string& pointer);

/// The value that is nearest to the pointer: itself, or the innermost one around it.
JsonSpan nearest_value(const std::string& text, const std::string& pointer);

/// The line of a place in a text, counted from 1.
int line_at(const std::string& text, size_t place);

/// With another text in the place of an existing value.
std::string with_value(const std::string& text, const std::string& pointer,
                       const std::string& value);

/// With a member more in the object at `pointer`, behind its last one, on a line of its own where
/// the members have lines of their own.
std::string with_member(const std::string& text, const std::string& pointer, const std::string& key,
                        const std::string& value);

/// With an item more in the array at `pointer`, which then has this index. What stands behind the
/// item before it on its line, as a comment, stays there.
std::string with_item(const std::string& text, const std::string& pointer, size_t index,
                      const std::string& value);

/// Without the member or item at `pointer`, its comma, and its line where nothing else is on it.
std::string without_value(const std::string& text, const std::string& pointer);

}  // namespace ayumi
