#pragma once
// Changes single values in the text of a pattern file, as an author does it by hand; every other
// byte stays the same. A number that the author wrote as an expression stays an expression: a
// change is appended to it, as in "${lift_off} + 0.02".

#include <map>
#include <string>
#include <vector>

namespace ayumi {

struct PatternEdit {
  enum class Kind {
    set,  ///< replaces the value, or adds it if it is missing, together with the objects around it
    insert,  ///< adds a new item to an array, at the index that ends the pointer; "-": at the end
    remove,  ///< removes a member or an item
    repeat   ///< puts items of an array, from the pointer on, into a block that repeats
  };
  Kind kind = Kind::set;
  std::string pointer;  ///< place as a JSON pointer
  /// JSON text of the new value; empty for `remove`. For `repeat`: { "items": the number of items,
  /// and the members of the block, such as "repeat" and "count" }.
  std::string value;
};

/// The text after the edits. The pointers of all edits refer to the text before the first one;
/// items that are inserted at the same index stand in the order of the edits. An expression gets
/// its new value with the parameters that are `set` from outside, and with the values in the text
/// for all others. Throws Error(usage) for a place that does not exist, and Error(bad_pattern) if
/// the text or a value is not JSON.
std::string edited_text(const std::string& text, const std::vector<PatternEdit>& edits,
                        const std::map<std::string, double>& set = {});

/// Value of the number or expression at a place of the text; the counts of blocks that repeat are
/// those of their first round. Throws Error(usage) for a place without a number.
double value_in_text(const std::string& text, const std::string& pointer,
                     const std::map<std::string, double>& set = {});

/// The expression with a value that is higher by `change`, a multiple of 1e-6. If the expression
/// ends with a number that is added to or subtracted from the rest, this number is changed.
/// Otherwise a number is appended.
std::string shifted_expression(const std::string& expression, double change);

}  // namespace ayumi
