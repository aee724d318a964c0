#pragma once
// A YAML document as a tree in which each number of a list takes only eight bytes, because motions
// have millions of them.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ayumi {

struct YamlNode {
  enum class Kind { scalar, list, map };
  Kind kind = Kind::scalar;
  int line = 0;                      ///< line, counted from 1
  std::string text = {};             ///< text of a scalar
  std::vector<double> numbers = {};  ///< numbers of a list that contains only finite numbers
  std::vector<YamlNode> items =
      {};  ///< items of any other list, or of a map in the order of `keys`
  std::vector<std::string> keys = {};

  bool is_map() const { return kind == Kind::map; }
  bool is_list() const { return kind == Kind::list; }
  /// The member of a map that has one of these names; null if there is none.
  const YamlNode* find(std::string_view key, std::string_view other = "") const;
};

/// Throws Error(bad_file) "file:line: ..." for a text that is not YAML, for aliases, for a key that
/// a map has twice, and for more than one document.
YamlNode parse_yaml(const std::string& text, const std::string& file);

}  // namespace ayumi
