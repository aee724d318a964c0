#include "ayumi/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <utility>

#include "ayumi/base/utf8.hpp"

namespace ayumi::text {

namespace {

// The number of letters that are added, left out, changed, or exchanged with their neighbour.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1), above, higher;
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    higher = std::exchange(above, row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t change = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], higher[j - 2] + 1);
    }
  }
  return row.back();
}

bool controls_a_terminal(char32_t code) {
  if (code == '\n' || code == '\t') return false;
  return code < 0x20 || (code >= 0x7f && code <= 0x9f) || code == 0x200e || code == 0x200f ||
         (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

std::string escaped(const char* mark, unsigned code, int digits) {
  static const char* const kHex = "0123456789abcdef";
  std::string text = mark;
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) text += kHex[code >> shift & 0xf];
  return text;
}

}  // namespace

size_t utf8_character(std::string_view text, char32_t& code) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const size_t length = first < 0x80   ? 1
                        : first < 0xc2 ? 0
                        : first < 0xe0 ? 2
                        : first < 0xf0 ? 3
                        : first < 0xf5 ? 4
                                       : 0;
  if (length == 0 || length > text.size()) return 0;
  code = length == 1 ? first : first & (0x7fu >> length);
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3f);
  }
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (overlong || (code >= 0xd800 && code <= 0xdfff) || code > 0x10ffff) return 0;
  return length;
}

std::string with_line_feeds(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::string result;
  result.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') continue;
    result += text[i] == '\r' ? '\n' : text[i];
  }
  return result;
}

size_t not_utf8_at(std::string_view text) {
  char32_t code = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t length = utf8_character(text.substr(at), code);
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

std::string wide_encoding(std::string_view text) {
  using namespace std::string_view_literals;
  // The mark of UTF-16 is the beginning of one of the marks of UTF-32.
  if (text.starts_with("\xFF\xFE\0\0"sv) || text.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32";
  if (text.starts_with("\xFF\xFE"sv) || text.starts_with("\xFE\xFF"sv)) return "UTF-16";
  const auto is_plain = [](char c) {
    return (c >= ' ' && c < 127) || c == '\n' || c == '\r' || c == '\t';
  };
  // Number of bytes that are examined. Chosen: at least 50 characters.
  const std::string_view head = text.substr(0, 200);
  for (const size_t width : {2, 4}) {
    const size_t whole = head.size() / width * width;
    for (const size_t place : {size_t{0}, width - 1}) {  // place of the byte that is not 0
      bool wide = whole > width;
      for (size_t i = 0; i < whole && wide; ++i)
        wide = i % width == place ? is_plain(head[i]) : head[i] == '\0';
      if (wide) return width == 2 ? "UTF-16" : "UTF-32";
    }
  }
  return "";
}

std::string wide_encoding_refusal(std::string_view text) {
  const std::string wide = wide_encoding(text);
  return wide.empty() ? "" : "the file is " + wide + " text; save the file as UTF-8";
}

std::string exact(double value) {
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string fixed(double value, int digits) {
  char buffer[400];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, digits).ptr;
  return {buffer, end};
}

std::string brief(double value, int digits) {
  char buffer[40];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
  return {buffer, end};
}

std::string nearest(std::string_view word, const std::vector<std::string>& candidates) {
  // An abbreviation is nearer than every other word. Fewer characters than these, without the
  // dashes of an option, begin too many words. Chosen.
  constexpr size_t kShortestAbbreviation = 3;
  const size_t dashes = std::min(word.find_first_not_of('-'), word.size());
  std::string best;
  if (word.size() - dashes >= kShortestAbbreviation)
    for (const std::string& candidate : candidates)
      if (candidate.starts_with(word) && (best.empty() || candidate.size() < best.size()))
        best = candidate;
  if (!best.empty()) return best;
  // Among words with equal distances, one that the word begins is nearer.
  bool begins_best = false;
  size_t best_distance = std::max<size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    // The distance is at least the difference of the lengths; a word may have megabytes.
    const auto [shorter, longer] = std::minmax({word.size(), candidate.size()});
    if (longer - shorter > best_distance) continue;
    const size_t distance = edit_distance(word, candidate);
    const bool begins = candidate.starts_with(word);
    if (distance < best_distance ||
        (distance == best_distance && !best.empty() && begins && !begins_best)) {
      best_distance = distance;
      best = candidate;
      begins_best = begins;
    }
  }
  return best;
}

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string best = nearest(word, candidates);
  return best.empty() ? "" : "; did you mean '" + best + "'?";
}

std::string join(const std::vector<std::string>& items, std::string_view separator) {
  std::string result;
  for (size_t i = 0; i < items.size(); ++i) {
    if (i > 0) result += separator;
    result += items[i];
  }
  return result;
}

std::string join_first(const std::vector<std::string>& items, size_t most) {
  if (items.size() <= most) return join(items, ", ");
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(most);
  return join({items.begin(), end}, ", ") + " and " + std::to_string(items.size() - most) + " more";
}

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    char32_t code = 0;
    const size_t length = utf8_character(text, code);
    if (length == 0)
      shown += escaped("\\x", static_cast<unsigned char>(text.front()), 2);
    else if (!controls_a_terminal(code))
      shown += text.substr(0, length);
    else
      shown += code < 0x100 ? escaped("\\x", code, 2) : escaped("\\u", code, 4);
    text.remove_prefix(std::max<size_t>(1, length));
  }
  return shown;
}

}  // namespace ayumi::text
