// Only the member "correction" of the top object is touched: comments, expressions and layout of
// everything else stay as the author wrote them. The text has been read as a pattern before, so it
// is well-formed. Strings and comments are skipped.
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"

namespace ayumi {

namespace {

/// Places in the text of the top object.
struct TopObject {
  size_t open = 0, close = 0;  ///< places of the braces of the object
  size_t last = 0;  ///< place of the object's last character that is neither space nor comment
  size_t begin = 0,
         end = 0;  ///< beginning and end of the value of "correction"; both are 0 if there is none
};

size_t skip_comment(const std::string& text, size_t i) {
  if (text[i] != '/' || i + 1 >= text.size()) return i;
  if (text[i + 1] == '/') return std::min(text.find('\n', i), text.size() - 1);
  if (text[i + 1] == '*') return std::min(text.find("*/", i + 2), text.size() - 2) + 1;
  return i;
}

size_t end_of_string(const std::string& text, size_t i) {
  for (++i; i < text.size() && text[i] != '"'; ++i)
    if (text[i] == '\\') ++i;
  return i;
}

TopObject find_top(const std::string& text) {
  TopObject top;
  int depth = 0;
  bool ours = false;  // whether the present value belongs to "correction"
  std::string key;
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t comment = skip_comment(text, i);
    if (comment != i) {
      i = comment;
      continue;
    }
    const char c = text[i];
    if (std::isspace(static_cast<unsigned char>(c))) continue;
    if (ours && top.begin == 0 && c != ':') top.begin = i;
    if (depth == 1 && (c == ',' || c == '}')) {
      if (ours) top.end = top.last + 1;
      ours = false;
    }
    if (c == '"') {
      const size_t end = end_of_string(text, i);
      key = text.substr(i + 1, end - i - 1);
      i = end;
    } else if (c == ':' && depth == 1) {
      ours = key == "correction";
    } else if (c == '{' || c == '[') {
      if (depth++ == 0) top.open = i;
    } else if (c == '}' || c == ']') {
      if (--depth == 0) {
        top.close = i;
        break;
      }
    }
    top.last = i;
  }
  require(top.close > top.open, "a pattern's text must hold an object");
  return top;
}

}  // namespace

std::string with_correction(const std::string& text, const CorrectionTrack& track) {
  const TopObject top = find_top(text);
  const std::string value = correction_text(track);
  if (top.begin > 0) return text.substr(0, top.begin) + value + text.substr(top.end);
  const std::string comma = text[top.last] == ',' || top.last == top.open ? "" : ",";
  const std::string between = text.substr(top.last + 1, top.close - top.last - 1);
  const bool line_ends = !between.empty() && between.back() == '\n';
  return text.substr(0, top.last + 1) + comma + between + (line_ends ? "" : "\n") +
         "  \"correction\": " + value + "\n" + text.substr(top.close);
}

}  // namespace ayumi
