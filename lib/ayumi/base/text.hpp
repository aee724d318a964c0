#pragma once
// Numbers and names as text, independent of the locale.

#include <string>
#include <string_view>
#include <vector>

namespace ayumi::text {

/// The shortest text that reads back to the same double, such as "0.1", "1e-09", "nan" or "inf".
std::string exact(double value);

/// The value with `digits` digits after the point, such as "12.30".
std::string fixed(double value, int digits);

/// The value with at most `digits` significant digits, for people, such as "0.0123".
std::string brief(double value, int digits = 4);

/// The candidate that `word` abbreviates: the shortest one that begins with `word`. If there is
/// none, the candidate nearest to `word` by edit distance; empty if none is near enough to be
/// suggested.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The text "; did you mean 'x'?" if a candidate is near, otherwise "".
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

/// The items, joined by `separator`.
std::string join(const std::vector<std::string>& items, std::string_view separator);

/// A text such as "a, b and 3 more": at most `most` items, and the number of the others.
std::string join_first(const std::vector<std::string>& items, size_t most);

/// Makes text safe for a terminal. Line feeds and tabs stay. All other control characters of ASCII
/// and Latin-1, the marks that change the direction of writing, and bytes that are not UTF-8 are
/// written out, such as "\\x1b" or "\\u202e". A name in a file can thus not move the cursor or hide
/// the text that follows.
std::string printable(std::string_view text);

}  // namespace ayumi::text
