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

// Reads the text where it is, without a copy.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(const std::string& text) {
    char* begin = const_cast<char*>(text.data());
    setg(begin, begin, begin + text.size());
  }
};

class TreeBuilder : public YAML::EventHandler {
 public:
  YamlNode root;
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
    for (const double number : parent.node.numbers) {  // the list does not hold numbers alone
      YamlNode item;
      item.line = parent.node.line;
      item.text = text::exact(number);
      parent.node.items.push_back(std::move(item));
    }
    parent.node.numbers.clear();
    parent.node.items.push_back(std::move(node));
  }

  std::vector<Open> open_;
};

}  // namespace

const YamlNode* YamlNode::find(std::string_view key, std::string_view other) const {
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key || (!other.empty() && keys[i] == other)) return &items[i];
  return nullptr;
}

YamlNode parse_yaml(const std::string& text, const std::string& file) {
  TextBuffer buffer(text);
  std::istream stream(&buffer);
  TreeBuilder builder;
  const auto refuse = [&](int line, const std::string& reason) {
    fail(ErrorCode::bad_file, file + ":" + std::to_string(line) + ": " + reason);
  };
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) refuse(1, "there is no YAML document");
  } catch (const YAML::Exception& error) {
    refuse(error.mark.line + 1,
           "this is not valid YAML: " + error.msg + "; the file may be truncated");
  }
  if (!builder.refused.empty()) refuse(builder.refused_line, builder.refused);
  return std::move(builder.root);
}

}  // namespace ayumi
