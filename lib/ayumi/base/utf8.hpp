#pragma once
// Reads text of other programs, which is not always UTF-8. The functions are defined in text.cpp.

#include <string>
#include <string_view>

namespace ayumi::text {

/// Returns the number of bytes of the UTF-8 character that `text` begins with, and puts the number
/// of the character into `code`. Returns 0 if the bytes are not UTF-8 (RFC 3629: no overlong forms,
/// no surrogates, at most U+10FFFF).
size_t utf8_character(std::string_view text, char32_t& code);

/// The index of the first byte that is no part of UTF-8 text; npos if there is none.
size_t not_utf8_at(std::string_view text);

/// "UTF-16" or "UTF-32" if a text has two or four bytes for each character: it begins with the mark
/// of such a text, or only one byte of each character at its beginning is not 0. Otherwise "".
std::string wide_encoding(std::string_view text);

/// Why a text with two or four bytes for each character cannot be read, and what to do; "" for
/// other texts. Every reader of text files refuses such a text with these words.
std::string wide_encoding_refusal(std::string_view text);

/// The text without the mark of UTF-8 at its beginning, and with line feeds at the ends of lines
/// that have carriage returns (macOS before 10, Windows).
std::string with_line_feeds(std::string_view text);

}  // namespace ayumi::text
