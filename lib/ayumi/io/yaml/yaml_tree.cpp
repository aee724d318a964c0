#include "ayumi/io/yaml/yaml_tree.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <charconv>
#include <cmath>
#include <istream>
#include <set>
#include <streambuf>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

// Reads the text in its place, without a copy.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(const std::string& text) {
    char* begin = const_cast<char*>(text.data());
    setg(begin, begin, begin + text.size());
  }
};

// Character before the number of a list in a text with marks. Texts that contain this character get
// no marks.
constexpr char kMark = '\x7f';

/// A text in which each flow list of finite numbers on one line is replaced by its index in
/// `lists`, such as `[\x7f3]`. Most of a motion consists of such lists, and the YAML parser takes
/// ten times as long for them as reads_numbers().
struct MarkedText {
  std::string text;
  std::vector<std::vector<double>> lists;
};

// Whether the flow list in `inside` contains only finite numbers, which are then in `numbers`.
bool reads_numbers(std::string_view inside, std::vector<double>& numbers) {
  numbers.clear();
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  while (true) {
    while (!inside.empty() && is_blank(inside.front())) inside.remove_prefix(1);
    double number = 0;
    const auto [last, error] =
        std::from_chars(inside.data(), inside.data() + inside.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    numbers.push_back(number);
    inside.remove_prefix(static_cast<size_t>(last - inside.data()));
    while (!inside.empty() && is_blank(inside.front())) inside.remove_prefix(1);
    if (inside.empty()) return true;
    if (inside.front() != ',') return false;
    inside.remove_prefix(1);
  }
}

MarkedText with_marks(std::string_view text) {
  MarkedText marked;
  std::vector<double> numbers;
  while (!text.empty()) {
    const size_t end = std::min(text.find_first_of("\r\n"), text.size() - 1) + 1;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    // Characters in quotes or in a comment are not a list.
    const bool plain = line.find_first_of("\"'#") == std::string_view::npos;
    for (size_t open; plain && (open = line.find('[')) != std::string_view::npos;) {
      const size_t next = line.find_first_of("[]", open + 1);
      if (next == std::string_view::npos) break;
      marked.text += line.substr(0, open + 1);
      const std::string_view inside = line.substr(open + 1, next - open - 1);
      if (line[next] == ']' && reads_numbers(inside, numbers)) {
        marked.text += kMark + std::to_string(marked.lists.size());
        marked.lists.push_back(numbers);
      } else {
        marked.text += inside;
      }
      line.remove_prefix(next);
    }
    marked.text += line;
  }
  return marked;
}

class TreeBuilder : public YAML::EventHandler {
 public:
  explicit TreeBuilder(std::vector<std::vector<double>>& lists) : lists_(lists) {}

  YamlNode root;
  bool mark_in_text = false;  ///< the supposed list is a part of a text
  std::string refused;
  int refused_line = 0;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { scalar(mark, ""); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    if (refused.empty()) refused_line = mark.line + 1;
    if (refused.empty()) refused = "aliases (*name) are not read";
    scalar(mark, "");
  }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& value) override {
    scalar(mark, value);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::list, mark);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    begin(YamlNode::Kind::map, mark);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    YamlNode node;
    std::string key = {};
    bool has_key = false;
    std::set<std::string> known = {};
  };

  void scalar(const YAML::Mark& mark, const std::string& value) {
    // A text without lists has no marks, so the character belongs to the text itself.
    if (!lists_.empty() && value.find(kMark) != std::string::npos) {
      size_t place = lists_.size();
      std::from_chars(value.data() + 1, value.data() + value.size(), place);
      if (value.front() == kMark && place < lists_.size() && !open_.empty() &&
          open_.back().node.is_list() && open_.back().node.numbers.empty() &&
          open_.back().node.items.empty())
        open_.back().node.numbers = std::move(lists_[place]);
      else
        mark_in_text = true;
      return;
    }
    if (!open_.empty() && open_.back().node.is_list()) {
      YamlNode& list = open_.back().node;
      double number = 0;
      const char* first = value.data() + (value.starts_with('+') ? 1 : 0);
      const auto [last, error] = std::from_chars(first, value.data() + value.size(), number);
      const bool finite = !value.empty() && error == std::errc() &&
                          last == value.data() + value.size() && std::isfinite(number);
      if (finite && list.items.empty()) {
        list.numbers.push_back(number);
        return;
      }
    }
    YamlNode node;
    node.line = mark.line + 1;
    node.text = value;
    add(std::move(node));
  }

  void begin(YamlNode::Kind kind, const YAML::Mark& mark) {
    Open opened;
    opened.node.kind = kind;
    opened.node.line = mark.line + 1;
    open_.push_back(std::move(opened));
  }

  void end() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  void add(YamlNode&& node) {
    if (open_.empty()) {
      root = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.is_map() && !parent.has_key) {
      parent.key = node.text;
      parent.has_key = true;
      if (!parent.known.insert(parent.key).second && refused.empty()) {
        refused = "the key '" + parent.key + "' appears twice in one map; keep one";
        refused_line = node.line;
      }
      return;
    }
    if (parent.node.is_map()) {
      parent.node.keys.push_back(std::move(parent.key));
      parent.has_key = false;
    }
    for (const double number : parent.node.numbers) {  // the list does not contain only numbers
      YamlNode item;
      item.line = parent.node.line;
      item.text = text::exact(number);
      parent.node.items.push_back(std::move(item));
    }
    parent.node.numbers.clear();
    parent.node.items.push_back(std::move(node));
  }

  std::vector<std::vector<double>>& lists_;
  std::vector<Open> open_;
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key, std::string_view other) const {
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key || (!other.empty() && keys[i] == other)) return &items[i];
  return nullptr;
}

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  const auto refuse = [&](int line, const std::string& reason, bool names_remedy = false) {
    SourcePlace place{file, "", line};
    place.names_remedy = names_remedy;
    fail(ErrorCode::bad_file, place, reason);
  };
  const auto parse = [&](const std::string& seen, std::vector<std::vector<double>> lists) {
    TextBuffer buffer(seen);
    std::istream stream(&buffer);
    TreeBuilder builder(lists);
    try {
      YAML::Parser parser(stream);
      if (!parser.HandleNextDocument(builder)) refuse(1, "there is no YAML document");
    } catch (const YAML::Exception& error) {
      refuse(error.mark.line + 1,
             "this is not valid YAML: " + error.msg + "; the file may be truncated", true);
    }
    if (!builder.mark_in_text && !builder.refused.empty())
      refuse(builder.refused_line, builder.refused);
    return std::pair{std::move(builder.root), builder.mark_in_text};
  };
  // The character itself, or an escape for it.
  if (text.find(kMark) == std::string::npos && text.find('\\') == std::string::npos) {
    MarkedText marked = with_marks(text);
    auto [root, mark_in_text] = parse(marked.text, std::move(marked.lists));
    if (!mark_in_text) return std::move(root);
  }
  return parse(text, {}).first;
}

}  // namespace ayumi
