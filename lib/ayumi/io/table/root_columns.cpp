#include "ayumi/io/table/root_columns.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/table/table_columns.hpp"

namespace ayumi {

namespace {

const std::set<std::string> kRoots = {"root",  "base", "pelvis", "trunk", "torso",   "body",
                                      "waist", "pose", "free",   "float", "floating"};
const std::set<std::string> kPlaces = {"p", "t", "pos", "position", "trans", "translation", "xyz"};
const std::set<std::string> kTurns = {"q",        "quat", "quaternion",  "rot",
                                      "rotation", "ori",  "orientation", "orn"};

/// A column that may hold one number of the root.
struct RootColumn {
  std::string root;   // the words that name the root; empty if there are none
  size_t member = 0;  // index in kBaseColumns
  double scale = 1;   // unit of a place [m]
};

/// The words of a name in small letters.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (!words.back().empty())
      words.emplace_back();
  if (words.back().empty()) words.pop_back();
  return words;
}

/// The unit of a place in metres; nothing for another unit.
std::optional<double> metres_of(const std::string& unit) {
  if (unit.empty() || unit == "m") return 1.0;
  if (unit == "cm") return 1e-2;
  if (unit == "mm") return 1e-3;
  return {};
}

std::optional<RootColumn> root_column(const std::string& column) {
  const ColumnName named = column_name(column);
  std::vector<std::string> words = words_of(named.name);
  if (words.empty()) return {};
  std::string last = words.back();
  words.pop_back();
  bool turn = false, place = false;
  if (last.size() > 1) {  // qw, px, posx
    const std::string before = last.substr(0, last.size() - 1);
    turn = kTurns.contains(before), place = kPlaces.contains(before);
    if (!turn && !place) return {};
    last = last.substr(last.size() - 1);
  }
  RootColumn result;
  for (const std::string& word : words) {
    if (kTurns.contains(word))
      turn = true;
    else if (kPlaces.contains(word))
      place = true;
    else if (word == "link" && !result.root.empty())
      continue;  // base_link_x
    else if (kRoots.contains(word))
      result.root += (result.root.empty() ? "" : "_") + word;
    else
      return {};
  }
  if (turn && place) return {};
  const size_t axis = std::string("xyzw").find(last);
  if (axis == std::string::npos || (axis == 3 && !turn)) return {};
  if (turn) {
    if (!named.unit.empty() && named.unit != "-" && named.unit != "1") return {};
    result.member = axis == 3 ? 3 : 4 + axis;
    return result;
  }
  const std::optional<double> metres = metres_of(named.unit);
  if (!metres) return {};
  result.member = axis;
  result.scale = *metres;
  return result;
}

}  // namespace

void name_root_columns(NumberTable& table, const std::string& file,
                       const std::function<bool(const std::string&)>& is_joint,
                       std::vector<std::string>& notes) {
  if (std::any_of(kBaseColumns.begin(), kBaseColumns.end(),
                  [&](const std::string& name) { return table.find(name) >= 0; }))
    return;
  struct Found {
    std::array<int, 7> at = {-1, -1, -1, -1, -1, -1, -1};
    std::array<double, 7> scale = {};
    bool twice = false;
  };
  std::map<std::string, Found> roots;
  for (size_t i = 0; i < table.columns.size(); ++i) {
    const std::optional<RootColumn> column = root_column(table.columns[i]);
    if (!column || is_joint(table.columns[i])) continue;
    Found& found = roots[column->root];
    found.twice |= found.at[column->member] >= 0;
    found.at[column->member] = static_cast<int>(i);
    found.scale[column->member] = column->scale;
  }
  // A quaternion whose columns do not repeat the root's name belongs to the only place, as in
  // root_x, root_y, root_z, qw, qx, qy, qz.
  std::vector<std::string> places, turns;
  for (const auto& [name, found] : roots) {
    if (std::count(found.at.begin(), found.at.begin() + 3, -1) == 0) places.push_back(name);
    if (std::count(found.at.begin() + 3, found.at.end(), -1) == 0) turns.push_back(name);
  }
  if (places.empty() || turns.empty()) return;
  const bool of_one_body = places.size() > 1 || turns.size() > 1 || places[0] == turns[0] ||
                           places[0].empty() || turns[0].empty();
  if (!of_one_body) return;
  const auto columns_of = [&](const std::vector<std::string>& names, size_t member) {
    std::vector<std::string> columns;
    for (const std::string& name : names)
      columns.push_back("'" + table.columns[size_t(roots[name].at[member])] + "'");
    return text::join(columns, " and ");
  };
  if (places.size() > 1 || turns.size() > 1)
    fail(ErrorCode::bad_file, {file},
         "several groups of columns can be the motion of the root. These groups begin with the "
         "columns " +
             (places.size() > 1 ? columns_of(places, 0) : columns_of(turns, 3)) +
             "; keep one of these groups");
  if (roots[places[0]].twice || roots[turns[0]].twice)
    fail(ErrorCode::bad_file, {file},
         "in the group of columns of the root with '" +
             table.columns[size_t(roots[places[0]].at[0])] +
             "', two columns have the same meaning; keep one of these two columns");
  std::vector<std::string> names;
  for (size_t member = 0; member < kBaseColumns.size(); ++member) {
    const Found& found = roots[member < 3 ? places[0] : turns[0]];
    const auto at = static_cast<size_t>(found.at[member]);
    if (member < 3) table.values.col(found.at[member]) *= found.scale[member];
    names.push_back(table.columns[at]);
    table.columns[at] = kBaseColumns[member];
  }
  notes.push_back("the motion of the root is in the columns " + text::join(names, ", "));
}

}  // namespace ayumi
