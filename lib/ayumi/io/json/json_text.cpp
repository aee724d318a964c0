#include "ayumi/io/json/json_text.hpp"

#include <algorithm>
#include <cctype>

#include "ayumi/base/error.hpp"
#include "ayumi/io/json/json_reader.hpp"

namespace ayumi {

namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)); }

/// The end of the comment that begins at `i`, or `i` if none begins there.
size_t after_comment(const std::string& text, size_t i) {
  if (text.compare(i, 2, "//") == 0) return std::min(text.find('\n', i), text.size());
  if (text.compare(i, 2, "/*") == 0) {
    const size_t end = text.find("*/", i + 2);
    return end == std::string::npos ? text.size() : end + 2;
  }
  return i;
}

/// The next place that is neither a space nor in a comment.
size_t skip(const std::string& text, size_t i) {
  while (i < text.size()) {
    if (is_space(text[i])) {
      ++i;
      continue;
    }
    const size_t after = after_comment(text, i);
    if (after == i) break;
    i = after;
  }
  return i;
}

size_t after_string(const std::string& text, size_t i) {
  for (++i; i < text.size() && text[i] != '"'; ++i)
    if (text[i] == '\\') ++i;
  return std::min(i + 1, text.size());
}

class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}

  JsonTree value(size_t& i, const std::string& name, size_t key) {
    i = skip(text_, i);
    JsonTree tree;
    tree.name = name;
    tree.at.key = key;
    tree.at.begin = i;
    const char c = i < text_.size() ? text_[i] : '\0';
    if (c == '{' || c == '[') {
      tree.kind = c;
      parts(i, tree);
    } else if (c == '"') {
      i = after_string(text_, i);
    } else {
      while (i < text_.size() && !is_space(text_[i]) &&
             std::string(",]}/").find(text_[i]) == std::string::npos)
        ++i;
    }
    tree.at.end = i;
    return tree;
  }

 private:
  void parts(size_t& i, JsonTree& tree) {
    const char close = tree.kind == '{' ? '}' : ']';
    i = skip(text_, i + 1);
    while (i < text_.size() && text_[i] != close) {
      if (tree.kind == '{') {
        const size_t key = i;
        i = after_string(text_, i);
        const std::string name = Json::parse(text_.substr(key, i - key)).get<std::string>();
        i = skip(text_, i) + 1;  // the colon
        tree.parts.push_back(value(i, name, key));
      } else {
        const std::string name = std::to_string(tree.parts.size());
        tree.parts.push_back(value(i, name, skip(text_, i)));
      }
      i = skip(text_, i);
      if (i < text_.size() && text_[i] == ',') i = skip(text_, i + 1);
    }
    if (i < text_.size()) ++i;
  }

  const std::string& text_;
};

std::vector<std::string> tokens_of(const std::string& pointer) {
  std::vector<std::string> tokens;
  for (size_t i = pointer.find('/'); i != std::string::npos;) {
    const size_t next = pointer.find('/', i + 1);
    const std::string raw = pointer.substr(i + 1, next == std::string::npos ? next : next - i - 1);
    std::string token;
    for (size_t k = 0; k < raw.size(); ++k) {
      const bool escape = raw[k] == '~' && k + 1 < raw.size();
      token += escape ? (raw[++k] == '0' ? '~' : '/') : raw[k];
    }
    tokens.push_back(token);
    i = next;
  }
  return tokens;
}

struct Found {
  const JsonTree* value = nullptr;   ///< the innermost part that exists
  const JsonTree* around = nullptr;  ///< the part to which it belongs
  bool exact = false;
};

Found follow(const JsonTree& root, const std::string& pointer) {
  Found found{&root, nullptr, true};
  for (const std::string& token : tokens_of(pointer)) {
    const auto& parts = found.value->parts;
    const auto next = std::find_if(parts.begin(), parts.end(),
                                   [&](const JsonTree& part) { return part.name == token; });
    if (next == parts.end()) {
      found.exact = false;
      return found;
    }
    found = {&*next, found.value, true};
  }
  return found;
}

Found require_value(const JsonTree& root, const std::string& pointer) {
  const Found found = follow(root, pointer);
  if (!found.exact)
    fail(ErrorCode::usage,
         "the pattern has no value at " + pointer + "; the pattern may have changed");
  return found;
}

size_t line_begin(const std::string& text, size_t place) {
  const size_t before = place == 0 ? std::string::npos : text.rfind('\n', place - 1);
  return before == std::string::npos ? 0 : before + 1;
}

std::string indent_at(const std::string& text, size_t place) {
  const size_t begin = line_begin(text, place);
  size_t end = begin;
  while (end < place && (text[end] == ' ' || text[end] == '\t')) ++end;
  return text.substr(begin, end - begin);
}

/// Whether a part comes first on its line.
bool begins_line(const std::string& text, size_t place) {
  return line_begin(text, place) + indent_at(text, place).size() == place;
}

/// Whether a line ends here.
bool at_line_end(const std::string& text, size_t i) {
  return i >= text.size() || text[i] == '\n' || text.compare(i, 2, "\r\n") == 0;
}

/// The end of the line if the rest of the line is only space and one comment; otherwise the same
/// place.
size_t after_remark(const std::string& text, size_t place) {
  const auto after_space = [&](size_t i) {
    while (i < text.size() && (text[i] == ' ' || text[i] == '\t')) ++i;
    return i;
  };
  size_t i = after_space(place);
  if (i < text.size()) i = after_comment(text, i);
  if (i > place && i < text.size() && text[i] == '\n' && text[i - 1] == '\r') --i;
  i = after_space(i);
  return at_line_end(text, i) ? i : place;
}

/// The line end that the text uses.
std::string line_break_of(const std::string& text) {
  return text.find("\r\n") == std::string::npos ? "\n" : "\r\n";
}

/// The place after the comma that follows a part.
size_t after_comma(const std::string& text, size_t end) { return skip(text, end) + 1; }

std::string inserted(const std::string& text, const JsonTree& list, size_t index,
                     const std::vector<std::string>& values) {
  const auto& parts = list.parts;
  const auto joined = [&](const std::string& between) {
    std::string words;
    for (const std::string& value : values) words += (words.empty() ? "" : between) + value;
    return words;
  };
  if (parts.empty()) {
    const std::string words = joined(", ");
    const bool spaced = list.kind == '{';
    const std::string pad = spaced ? " " : "";
    return text.substr(0, list.at.begin + 1) + pad + words + pad + text.substr(list.at.end - 1);
  }
  const bool last = index == parts.size();
  const JsonTree& neighbour = last ? parts.back() : parts[index];
  if (!begins_line(text, neighbour.at.key)) {
    const std::string words = joined(", ");
    if (last)
      return text.substr(0, neighbour.at.end) + ", " + words + text.substr(neighbour.at.end);
    return text.substr(0, neighbour.at.key) + words + ", " + text.substr(neighbour.at.key);
  }
  const std::string begin = line_break_of(text) + indent_at(text, neighbour.at.key);
  const std::string line = begin + joined("," + begin);
  if (last) {
    const size_t end = neighbour.at.end, place = after_remark(text, end);
    return text.substr(0, end) + "," + text.substr(end, place - end) + line + text.substr(place);
  }
  const size_t before = index == 0 ? list.at.begin + 1 : after_comma(text, parts[index - 1].at.end);
  const size_t place = after_remark(text, before);
  return text.substr(0, place) + line + "," + text.substr(place);
}

}  // namespace

JsonTree json_tree(const std::string& text) {
  const std::string_view mark = "\xEF\xBB\xBF";  // byte order mark of UTF-8
  size_t i = text.starts_with(mark) ? mark.size() : 0;
  return Scanner(text).value(i, "", 0);
}

std::optional<JsonSpan> find_value(const std::string& text, const std::string& pointer) {
  const JsonTree root = json_tree(text);
  const Found found = follow(root, pointer);
  if (!found.exact) return std::nullopt;
  return found.value->at;
}

JsonSpan nearest_value(const std::string& text, const std::string& pointer) {
  const JsonTree root = json_tree(text);
  return follow(root, pointer).value->at;
}

int line_at(const std::string& text, size_t place) {
  const auto end = text.begin() + static_cast<long>(std::min(place, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

std::string with_value(const std::string& text, const std::string& pointer,
                       const std::string& value) {
  const JsonTree root = json_tree(text);
  const JsonSpan at = require_value(root, pointer).value->at;
  return text.substr(0, at.begin) + value + text.substr(at.end);
}

std::string with_member(const std::string& text, const std::string& pointer, const std::string& key,
                        const std::string& value) {
  const JsonTree root = json_tree(text);
  const JsonTree& object = *require_value(root, pointer).value;
  if (object.kind != '{') fail(ErrorCode::usage, pointer + " is not an object");
  return inserted(text, object, object.parts.size(), {Json(key).dump() + ": " + value});
}

std::string with_item(const std::string& text, const std::string& pointer, size_t index,
                      const std::string& value) {
  return with_items(text, pointer, index, {value});
}

std::string with_items(const std::string& text, const std::string& pointer, size_t index,
                       const std::vector<std::string>& values) {
  const JsonTree root = json_tree(text);
  const JsonTree& array = *require_value(root, pointer).value;
  if (array.kind != '[' || index > array.parts.size())
    fail(ErrorCode::usage,
         pointer + " is not an array in which an item can have the index " + std::to_string(index));
  return inserted(text, array, index, values);
}

std::string without_value(const std::string& text, const std::string& pointer) {
  const JsonTree root = json_tree(text);
  const Found found = require_value(root, pointer);
  if (!found.around) fail(ErrorCode::usage, "the whole pattern cannot be removed");
  const auto& parts = found.around->parts;
  const auto index = static_cast<size_t>(found.value - parts.data());
  size_t begin = found.value->at.key, end = found.value->at.end;
  std::string before = text.substr(0, begin);
  if (index + 1 < parts.size()) {
    end = after_comma(text, end);
  } else if (index > 0) {
    const size_t comma = after_comma(text, parts[index - 1].at.end) - 1;
    before.erase(comma, 1);
    begin -= 1;
  }
  const size_t after = after_remark(text, end);
  if (at_line_end(text, after) && begins_line(before, begin)) {
    const size_t next = text.find('\n', after);
    return before.substr(0, line_begin(before, begin)) +
           (next == std::string::npos ? "" : text.substr(next + 1));
  }
  // One space stays between the neighbours if they are in one line.
  size_t next = end;
  while (next < text.size() && text[next] == ' ') ++next;
  if (index + 1 < parts.size()) return before + text.substr(next);
  while (!before.empty() && before.back() == ' ') before.pop_back();
  return before + text.substr(end);
}

}  // namespace ayumi
