// Both patterns are written in the canonical form of pattern_text(). Where the two forms agree, the
// text of the author stays. Where they differ, the value at the same place of the author's text is
// replaced, added or removed. Finally the new text is read, and it counts only if its canonical
// form is that of the edited pattern.
#include "ayumi/io/pattern/pattern_rewrite.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/io/json/json_reader.hpp"
#include "ayumi/io/json/json_text.hpp"
#include "ayumi/io/pattern/expression.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/pattern/scenario_text.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Ordered = nlohmann::ordered_json;

// Tolerance between a number of the edited pattern and the number that the new text gives: absolute
// up to 1, relative above. Derived: sums in expressions are rounded to 1e-6 (pattern_edit.cpp), and
// a relative time is the difference of two of them.
constexpr double kSameNumber = 2.5e-6;
// Largest difference of numbers that are equal except for rounding, in the same sense. Chosen: a
// few thousand times the rounding of one operation.
constexpr double kRounding = 1e-12;
// Number of parts of a second to which relative times are rounded [1/s]. Definition: the same as in
// the reader.
constexpr double kStepsOfTime = 1e9;
// Largest number of phases or keyframes, and of added or removed parts. Chosen: matching takes time
// proportional to the square of the number of items; with 2000 it takes less than a second. Twice
// as many parts are all phases and keyframes of a pattern of that size.
constexpr size_t kMostMatched = 2000, kMostParts = 4000;

bool same_number(double a, double b, double share) {
  return std::abs(a - b) <= share * std::max({1.0, std::abs(a), std::abs(b)});
}

// Equality of two values, with numbers that may differ by `share`.
bool agrees(const Ordered& a, const Ordered& b, double share) {
  if (a.is_number() && b.is_number()) return same_number(a.get<double>(), b.get<double>(), share);
  if (a.type() != b.type() || a.size() != b.size()) return false;
  if (a.is_object())
    return std::all_of(a.items().begin(), a.items().end(), [&](const auto& member) {
      return b.contains(member.key()) && agrees(member.value(), b[member.key()], share);
    });
  if (a.is_array()) {
    for (size_t i = 0; i < a.size(); ++i)
      if (!agrees(a[i], b[i], share)) return false;
    return true;
  }
  return a == b;
}

// Equality of two values except for the signs of their numbers.
bool mirrors(const Ordered& a, const Ordered& b) {
  if (a.is_number() && b.is_number())
    return same_number(std::abs(a.get<double>()), std::abs(b.get<double>()), kRounding);
  if (a.type() != b.type() || a.size() != b.size()) return false;
  if (!a.is_array()) return a == b;
  for (size_t i = 0; i < a.size(); ++i)
    if (!mirrors(a[i], b[i])) return false;
  return true;
}

// A value in the form that pattern_text() gives to one line.
std::string words_of(const Ordered& value) {
  if (value.is_number()) return number(value.get<double>());
  Members members;
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) members.add(key, words_of(member));
    return members.object();
  }
  if (value.is_array()) {
    for (const Ordered& item : value) members.item(words_of(item));
    return members.array();
  }
  return quoted(value.get<std::string>());
}

// Lists with an item on each line, as in pattern_text().
std::string lines_of(const Ordered& list) {
  Members members;
  for (const Ordered& item : list) members.item(words_of(item));
  return members.lines('[', ']', "  ");
}

size_t letters_changed(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t before = row[0]++;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t replaced = before + (a[i - 1] == b[j - 1] ? 0 : 1);
      before = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

const JsonTree* part_of(const JsonTree& tree, const std::string& name) {
  for (const JsonTree& part : tree.parts)
    if (part.name == name) return &part;
  return nullptr;
}

// Longest common subsequence of two lists of pointers: for each item of `after`, its index in
// `before`, or -1.
std::vector<int> belonging(const std::vector<std::string>& before,
                           const std::vector<std::string>& after) {
  const size_t n = before.size(), m = after.size();
  std::vector<std::vector<int>> most(n + 1, std::vector<int>(m + 1, 0));
  const auto same = [&](size_t i, size_t j) { return !after[j].empty() && before[i] == after[j]; };
  for (size_t i = n; i-- > 0;)
    for (size_t j = m; j-- > 0;)
      most[i][j] = same(i, j) ? most[i + 1][j + 1] + 1 : std::max(most[i + 1][j], most[i][j + 1]);
  std::vector<int> pairs(m, -1);
  for (size_t i = 0, j = 0; i < n && j < m;) {
    if (same(i, j))
      pairs[j++] = static_cast<int>(i++);
    else if (most[i + 1][j] >= most[i][j + 1])
      ++i;
    else
      ++j;
  }
  return pairs;
}

// The items of a list of phases or keyframes, with their pointers and times.
struct Items {
  Ordered list = Ordered::array();
  std::vector<std::string> pointers;
  std::vector<double> times;

  double before(size_t i) const { return i == 0 ? 0 : times[i - 1]; }
};

// The two ways in which an item states its time.
struct TimeKeys {
  const char *absolute, *relative;
};

class Rewrite {
 public:
  Rewrite(const std::string& text, double time_scale)
      : text_(text), tree_(json_tree(text)), time_scale_(time_scale) {}

  // The text with the changes, or nothing if it cannot express them.
  std::optional<std::string> between(const Pattern& before, const Pattern& after) {
    Ordered a = canonical(without_included(before, before));
    Ordered b = canonical(without_included(after, before));
    const Items phases_a = items(a, "phases", "until", before.phases);
    const Items phases_b = items(b, "phases", "until", after.phases);
    const Items keys_a = items(a, "keyframes", "t", before.keyframes);
    const Items keys_b = items(b, "keyframes", "t", after.keyframes);
    merge(tree_, "", a, b);
    merge_list("phases", {"until", "duration"}, phases_a, phases_b);
    merge_list("keyframes", {"t", "after"}, keys_a, keys_b);
    if (!possible_ || added_.size() + removed_.size() + moved_.size() > kMostParts)
      return std::nullopt;
    return applied();
  }

  void replace(const std::string& pointer, const std::string& words) {
    if (const auto at = find_value(text_, pointer)) replace(at->begin, at->end, words);
  }

  // The pattern without the postures that `before` includes from other files.
  static Pattern without_included(Pattern pattern, const Pattern& before) {
    for (const auto& [name, file] : before.posture_files) {
      const auto own = pattern.postures.find(name);
      if (own != pattern.postures.end() && own->second == before.postures.at(name))
        pattern.postures.erase(own);
    }
    return pattern;
  }

  static Ordered canonical(const Pattern& pattern) {
    return Ordered::parse(pattern_text(pattern), nullptr, true, true);
  }

 private:
  struct Added {
    std::string pointer, key, words;
    auto operator<=>(const Added&) const = default;
  };
  // An item that is removed from a list (without words) or inserted before this index.
  struct Moved {
    std::string list;
    size_t index = 0;
    std::optional<std::string> words;
  };

  // Takes a list out of a canonical form.
  template <class Part>
  static Items items(Ordered& form, const char* name, const char* time,
                     const std::vector<Part>& parts) {
    Items result;
    if (form.contains(name)) result.list = form[name];
    form.erase(name);
    for (const Ordered& item : result.list) result.times.push_back(item[time].get<double>());
    for (const Part& part : parts) result.pointers.push_back(part.pointer);
    return result;
  }

  std::string words(const JsonTree& at) const {
    return text_.substr(at.at.begin, at.at.end - at.at.begin);
  }

  // The words of a value. If rounding decides about its digits, `number` is the number for which
  // they stand, or the number that they add to an expression.
  struct Words {
    std::string text;
    std::optional<double> number = {};
  };
  struct Replaced {
    size_t end = 0;
    Words words;
  };

  void replace(size_t begin, size_t end, const Words& words) {
    const auto [found, is_new] = replaced_.emplace(begin, Replaced{end, words});
    if (is_new) return;
    const Words& other = found->second.words;
    // Times of rounds are rounded in different places.
    const bool same =
        other.text == words.text ||
        (other.number && words.number && same_number(*other.number, *words.number, kSameNumber));
    if (!same) possible_ = false;  // two rounds of a block need different texts
  }

  void replace(size_t begin, size_t end, const std::string& words) {
    replace(begin, end, Words{words});
  }

  // The text of a number that changes from a to b, in the form of the author.
  Words changed(const JsonTree& at, double a, double b, bool time) const {
    const std::string raw = words(at);
    if (a == b) return {raw};
    if (raw.empty() || raw.front() != '"') {
      double value = a;
      std::from_chars(raw.data(), raw.data() + raw.size(), value);
      // A vector that the reader normalizes keeps the length that its author gave it.
      if (!same_number(value, a, kRounding) && b == -a) return {number(-value)};
      return {number(b), b};
    }
    const std::string expression = Json::parse(raw).get<std::string>();
    if (a != 0 && same_number(a, -b, kRounding)) return {quoted(negated(expression))};
    if (time && time_scale_ != 1 && same_number(b, time_scale_ * a, kSameNumber))
      return {quoted("(" + expression + ")*" + text::exact(time_scale_))};
    return {quoted(shifted_expression(expression, b - a)), b - a};
  }

  static std::string negated(const std::string& expression) {
    const std::string open = "-(";
    if (expression.compare(0, 2, open) == 0 && expression.back() == ')' &&
        expression.find('(', 2) == std::string::npos)
      return expression.substr(2, expression.size() - 3);
    return open + expression + ")";
  }

  void merge(const JsonTree& at, const std::string& pointer, const Ordered& a, const Ordered& b,
             bool time = false) {
    if (a == b) return;
    if (a.is_object() && b.is_object() && at.kind == '{') return merge_objects(at, pointer, a, b);
    if (a.is_number() && b.is_number() && at.kind == 'v')
      return replace(at.at.begin, at.at.end, changed(at, a, b, time));
    if (a.is_array() && b.is_array() && at.kind == '[') return merge_arrays(at, pointer, a, b);
    if (a.is_array() && b.is_array() && at.kind == '{') return merge_pose(at, pointer, a, b);
    replace(at.at.begin, at.at.end, words_of(b));
  }

  void merge_arrays(const JsonTree& at, const std::string& pointer, const Ordered& a,
                    const Ordered& b) {
    const size_t common = std::min(a.size(), b.size());
    const bool objects =
        std::any_of(b.begin(), b.end(), [](const Ordered& item) { return item.is_object(); });
    if (a.size() == b.size() && at.parts.size() >= a.size()) {
      for (size_t i = 0; i < common; ++i)
        merge(at.parts[i], pointer + "/" + std::to_string(i), a[i], b[i]);
      return;
    }
    if (objects) {  // a list that grows at its end
      if (a.size() > b.size() || at.parts.size() != a.size()) {
        possible_ = false;
        return;
      }
      for (size_t i = 0; i < common; ++i)
        merge(at.parts[i], pointer + "/" + std::to_string(i), a[i], b[i]);
      for (size_t i = common; i < b.size(); ++i)
        moved_.push_back({pointer, common, words_of(b[i])});
      return;
    }
    Members members;
    for (size_t i = 0; i < b.size(); ++i) {
      const bool given = i < at.parts.size() && i < a.size() && a[i].is_number();
      members.item(given && b[i].is_number() ? changed(at.parts[i], a[i], b[i], false).text
                                             : words_of(b[i]));
    }
    replace(at.at.begin, at.at.end, members.array());
  }

  // A foothold that the author wrote as { "position": [...], "rpy": [...] }, and the canonical form
  // as [x, y], [x, y, z] or [x, y, z, yaw].
  void merge_pose(const JsonTree& at, const std::string& pointer, const Ordered& a,
                  const Ordered& b) {
    const auto value = [](const Ordered& list, size_t i) {
      return i < list.size() ? list[i].get<double>() : 0.0;
    };
    const JsonTree* const position = part_of(at, "position");
    const JsonTree* const turn = part_of(at, "rpy");
    if (!position || position->parts.size() != 3 || (turn && turn->parts.size() != 3)) {
      possible_ = false;
      return;
    }
    for (size_t i = 0; i < 3; ++i)
      merge(position->parts[i], "", Ordered(value(a, i)), Ordered(value(b, i)));
    if (turn)
      merge(turn->parts[2], "", Ordered(value(a, 3)), Ordered(value(b, 3)));
    else if (value(a, 3) != value(b, 3))
      added_.insert({pointer, "rpy", words_of(Ordered::array({0, 0, value(b, 3)}))});
  }

  void merge_objects(const JsonTree& at, const std::string& pointer, const Ordered& a,
                     const Ordered& b) {
    std::vector<std::string> gone, fresh;
    for (const auto& [key, value] : a.items())
      if (!b.contains(key)) gone.push_back(key);
    std::set<std::string> exchanged;
    for (const auto& [key, value] : a.items())
      if (const std::string twin = exchanged_with(key, a, b);
          !twin.empty() && exchanged_with(twin, a, b) == key && part_of(at, key) &&
          part_of(at, twin)) {
        rename(*part_of(at, key), twin);
        merge(*part_of(at, key), pointer + "/" + json_pointer_token(twin), value, b[twin]);
        exchanged.insert(key);
      }
    for (const auto& [key, value] : b.items()) {
      if (exchanged.contains(key)) continue;
      const std::string inside = pointer + "/" + json_pointer_token(key);
      if (!a.contains(key)) {
        fresh.push_back(key);
      } else if (const JsonTree* const part = part_of(at, key)) {
        merge(*part, inside, a[key], value, key == "at");
      } else if (a[key] != value) {  // it had the value that applies if nothing is written
        added_.insert({pointer, key, words_of(value)});
      }
    }
    // If as many members come as go, they are the same ones under other names, such as those of the
    // other side.
    if (gone.size() == fresh.size())
      for (const std::string& name : gone) {
        const auto now = std::min_element(
            fresh.begin(), fresh.end(), [&](const std::string& p, const std::string& q) {
              return letters_changed(name, p) < letters_changed(name, q);
            });
        const JsonTree* const part = part_of(at, name);
        if (part) {
          rename(*part, *now);
          merge(*part, pointer + "/" + json_pointer_token(*now), a[name], b[*now]);
        } else {
          added_.insert({pointer, *now, words_of(b[*now])});
        }
        fresh.erase(now);
      }
    else
      for (const std::string& name : gone)
        if (part_of(at, name)) removed_.insert(pointer + "/" + json_pointer_token(name));
    for (const std::string& name : fresh) added_.insert({pointer, name, words_of(b[name])});
  }

  // The key with which this key exchanges its value, as "left" does with "right"; empty if there is
  // none.
  static std::string exchanged_with(const std::string& key, const Ordered& a, const Ordered& b) {
    if (!b.contains(key) || mirrors(a[key], b[key])) return "";
    for (const auto& [other, value] : a.items())
      if (other != key && b.contains(other) && mirrors(a[key], b[other]) && mirrors(value, b[key]))
        return other;
    return "";
  }

  void rename(const JsonTree& part, const std::string& name) {
    const std::string before = Json(part.name).dump();
    const size_t key = part.at.key;
    if (text_.compare(key, before.size(), before) != 0) possible_ = false;
    replace(key, key + before.size(), ayumi::quoted(name));
  }

  // One phase or keyframe. `before` are the times of the items before it.
  void merge_item(const JsonTree& at, const std::string& pointer, const TimeKeys& time, Ordered a,
                  Ordered b, const std::array<double, 2>& before) {
    const double t = a[time.absolute], then = b[time.absolute];
    if (const JsonTree* const absolute = part_of(at, time.absolute)) {
      merge(*absolute, "", Ordered(t), Ordered(then), true);
    } else if (const JsonTree* const relative = part_of(at, time.relative)) {
      const auto later = [](double end, double begin) {
        return std::round(kStepsOfTime * (end - begin)) / kStepsOfTime;
      };
      merge(*relative, "", Ordered(later(t, before[0])), Ordered(later(then, before[1])), true);
    }
    a.erase(time.absolute);
    b.erase(time.absolute);
    // The joints of a key stand in "posture", in "joints", or in both.
    const Ordered joints_a = take_joints(a), joints_b = take_joints(b);
    merge_objects(at, pointer, a, b);
    if (joints_a == joints_b) return;
    const JsonTree* angles = part_of(at, "joints");
    const JsonTree* const posture = part_of(at, "posture");
    if (posture && posture->kind == '{') {
      if (angles) possible_ = false;
      angles = posture;
    }
    if (!angles)
      added_.insert({pointer, b.contains("posture") ? "joints" : "posture", words_of(joints_b)});
    else if (joints_b.empty())
      removed_.insert(pointer + "/" + angles->name);
    else
      merge_objects(*angles, pointer + "/" + angles->name, joints_a, joints_b);
  }

  static Ordered take_joints(Ordered& key) {
    for (const char* const name : {"joints", "posture"}) {
      if (!key.contains(name) || !key[name].is_object()) continue;
      Ordered joints = key[name];
      key.erase(name);
      return joints;
    }
    return Ordered::object();
  }

  void merge_list(const std::string& name, const TimeKeys& time, const Items& a, const Items& b) {
    const JsonTree* const list = part_of(tree_, name);
    const std::string pointer = "/" + name;
    if (a.list.size() != a.pointers.size() || b.list.size() != b.pointers.size() ||
        std::max(a.list.size(), b.list.size()) > kMostMatched) {
      possible_ = false;
      return;
    }
    if (b.list.empty()) {
      if (list) removed_.insert(pointer);
      return;
    }
    if (!list) {
      added_.insert({"", name, lines_of(b.list)});
      return;
    }
    const std::vector<int> from = belonging(a.pointers, b.pointers);
    std::vector<char> stays(a.list.size(), 0);
    for (const int i : from)
      if (i >= 0) stays[static_cast<size_t>(i)] = 1;
    const auto in_block = [&](size_t i) { return split(a.pointers[i]).second; };
    const auto top = [&](size_t i) { return split(a.pointers[i]).first; };
    for (size_t i = 0; i < a.list.size(); ++i)
      if (!stays[i]) {
        if (in_block(i)) possible_ = false;
        moved_.push_back({pointer, top(i), std::nullopt});
      }
    int last = -1;  // index in the text of the previous item that stays
    for (size_t j = 0; j < b.list.size(); ++j) {
      const std::array<double, 2> before = {
          from[j] < 0 ? 0 : a.before(static_cast<size_t>(from[j])), b.before(j)};
      if (from[j] >= 0) {
        last = from[j];
        const auto i = static_cast<size_t>(last);
        if (const JsonTree* const at = follow(a.pointers[i]))
          merge_item(*at, a.pointers[i], time, a.list[i], b.list[j], before);
        continue;
      }
      const size_t index = last < 0 ? 0 : top(static_cast<size_t>(last)) + 1;
      const auto next = std::find_if(from.begin() + static_cast<long>(j), from.end(),
                                     [](int i) { return i >= 0; });
      if (last >= 0 && next != from.end() && top(static_cast<size_t>(*next)) + 1 == index)
        possible_ = false;  // it would stand between the rounds of a block
      moved_.push_back({pointer, index, words_of_new(time, a, b, j)});
    }
  }

  // The text of an item that stands elsewhere in the text, or the canonical text of a new one.
  std::string words_of_new(const TimeKeys& time, const Items& a, const Items& b, size_t j) const {
    const std::string& pointer = b.pointers[j];
    const auto origin = std::find(a.pointers.begin(), a.pointers.end(), pointer);
    if (pointer.empty() || origin == a.pointers.end() || split(pointer).second)
      return words_of(b.list[j]);
    const auto i = static_cast<size_t>(origin - a.pointers.begin());
    const JsonTree* const at = follow(pointer);
    if (!at) return words_of(b.list[j]);
    Rewrite alone(text_, time_scale_);
    alone.merge_item(*at, pointer, time, a.list[i], b.list[j], {a.before(i), b.before(j)});
    if (!alone.possible_ || !alone.added_.empty() || !alone.removed_.empty())
      return words_of(b.list[j]);
    std::string result = words(*at);
    for (auto each = alone.replaced_.rbegin(); each != alone.replaced_.rend(); ++each)
      result.replace(each->first - at->at.begin, each->second.end - each->first,
                     each->second.words.text);
    return result;
  }

  // The index of an item in its list, and whether it is inside a block that repeats.
  static std::pair<size_t, bool> split(const std::string& pointer) {
    const size_t first = pointer.find('/', 1);
    const std::string rest = first == std::string::npos ? "" : pointer.substr(first + 1);
    return {static_cast<size_t>(std::atol(rest.c_str())), rest.find('/') != std::string::npos};
  }

  const JsonTree* follow(const std::string& pointer) const {
    const JsonTree* at = &tree_;
    for (size_t i = pointer.find('/'); at && i != std::string::npos;) {
      const size_t next = pointer.find('/', i + 1);
      at = part_of(*at, pointer.substr(i + 1, next == std::string::npos ? next : next - i - 1));
      i = next;
    }
    return at;
  }

  std::string applied() const {
    std::string result = text_;
    for (auto each = replaced_.rbegin(); each != replaced_.rend(); ++each)
      result.replace(each->first, each->second.end - each->first, each->second.words.text);
    for (const std::string& pointer : removed_) result = without_value(result, pointer);
    for (const Added& each : added_)
      result = with_member(result, each.pointer, each.key, each.words);
    // From the end of a list to its beginning, so that indices stay those of the given text. Items
    // that are inserted at one index stand in their order.
    std::vector<Moved> moved(moved_.rbegin(), moved_.rend());
    std::stable_sort(moved.begin(), moved.end(), [](const Moved& a, const Moved& b) {
      return std::tuple(a.list, a.index, !a.words) > std::tuple(b.list, b.index, !b.words);
    });
    for (auto each = moved.begin(); each != moved.end();) {
      if (!each->words) {
        result = without_value(result, each->list + "/" + std::to_string(each->index));
        ++each;
        continue;
      }
      // All items that come to one place, because each change reads the whole text.
      const auto end = std::find_if(each, moved.end(), [&](const Moved& other) {
        return other.list != each->list || other.index != each->index || !other.words;
      });
      std::vector<std::string> items;
      for (auto item = std::make_reverse_iterator(end); item.base() != each; ++item)
        items.push_back(*item->words);
      result = with_items(result, each->list, each->index, items);
      each = end;
    }
    return result;
  }

  const std::string& text_;
  const JsonTree tree_;
  const double time_scale_;
  bool possible_ = true;
  std::map<size_t, Replaced> replaced_;  // by begin
  std::set<Added> added_;
  std::set<std::string> removed_;
  std::vector<Moved> moved_;
};

constexpr std::array<const char*, 5> kMarks = {"comment", "expression", "parameter",
                                               "repeated block", "included file"};
enum Mark : size_t { comments, expressions, parameters, blocks, includes };
// The words of each mark of a text.
using Marks = std::array<std::vector<std::string>, kMarks.size()>;

void add_values(const std::string& text, const JsonTree& tree, Marks& marks) {
  const auto words = [&](const JsonTree& of) {
    return text.substr(of.at.begin, of.at.end - of.at.begin);
  };
  if (tree.kind == 'v' && text[tree.at.begin] == '"') {
    const std::string value = Json::parse(words(tree)).get<std::string>();
    if (is_expression(value)) marks[expressions].push_back(value);
  }
  if (const JsonTree* const repeat = tree.kind == '{' ? part_of(tree, "repeat") : nullptr)
    marks[blocks].push_back(words(*repeat));
  for (const JsonTree& part : tree.parts) add_values(text, part, marks);
}

// Calls `found` with the place of each comment of a JSON text, without white space at its end.
void for_each_comment(const std::string& text, const std::function<void(size_t, size_t)>& found) {
  const auto add_comment = [&](size_t begin, size_t end) {
    while (end > begin && std::isspace(static_cast<unsigned char>(text[end - 1]))) --end;
    found(begin, end);
  };
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t begin = i;
    if (text[i] == '"') {
      for (++i; i < text.size() && text[i] != '"'; ++i)
        if (text[i] == '\\') ++i;
    } else if (text.compare(i, 2, "//") == 0) {
      i = std::min(text.find('\n', i), text.size());
      add_comment(begin, i);
    } else if (text.compare(i, 2, "/*") == 0) {
      i = std::min(text.find("*/", i + 2), text.size() - 1) + 1;
      add_comment(begin, std::min(i + 1, text.size()));
    }
  }
}

Marks marks_of(const std::string& text) {
  Marks marks;
  for_each_comment(text, [&](size_t begin, size_t end) {
    marks[comments].push_back(text.substr(begin, end - begin));
  });
  const JsonTree tree = json_tree(text);
  for (const JsonTree& part : tree.parts)
    if (part.kind != 'v') add_values(text, part, marks);
  if (const JsonTree* const given = part_of(tree, "parameters"))
    for (const JsonTree& part : given->parts) marks[parameters].push_back(part.name);
  if (const JsonTree* const include = part_of(tree, "include")) {
    const auto add_file = [&](const JsonTree& name) {
      // Its folder changes with that of the pattern.
      const std::string file = text.substr(name.at.begin, name.at.end - name.at.begin);
      marks[includes].push_back(fs::path(Json::parse(file).get<std::string>()).filename());
    };
    if (include->kind == '[')
      std::for_each(include->parts.begin(), include->parts.end(), add_file);
    else
      add_file(*include);
  }
  return marks;
}

// The parameters in an expression, in their order. They stay if the sign or the scale of the
// expression changes, or if a number is added.
std::string names_in(const std::string& expression) {
  std::string names;
  for (size_t i = expression.find("${"); i != std::string::npos; i = expression.find("${", i)) {
    const size_t end = std::min(expression.find('}', i), expression.size());
    names += expression.substr(i, end - i);
    i = end;
  }
  return names;
}

// Removes the words that both lists have, each as often as both have it.
void remove_common(std::vector<std::string>& a, std::vector<std::string>& b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::vector<std::string> only_a, only_b;
  std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only_a));
  std::set_difference(b.begin(), b.end(), a.begin(), a.end(), std::back_inserter(only_b));
  a = std::move(only_a);
  b = std::move(only_b);
}

}  // namespace

std::vector<std::string> lost_marks(const std::string& text, const std::string& kept) {
  Marks before = marks_of(text), after = marks_of(kept);
  const std::set<std::string> given(before[expressions].begin(), before[expressions].end());
  for (size_t i = 0; i < kMarks.size(); ++i) remove_common(before[i], after[i]);
  // What is left of the expressions has changed; those that are in both texts are copies.
  std::erase_if(after[expressions], [&](const std::string& e) { return given.contains(e); });
  for (Marks* const marks : {&before, &after})
    for (std::string& expression : (*marks)[expressions]) expression = names_in(expression);
  remove_common(before[expressions], after[expressions]);
  std::vector<std::string> lost;
  for (size_t i = 0; i < kMarks.size(); ++i)
    if (const size_t count = before[i].size(); count > 0)
      lost.push_back(std::to_string(count) + " " + kMarks[i] + (count == 1 ? "" : "s"));
  return lost;
}

std::vector<int> lines_with_sides(const std::string& text,
                                  const std::set<std::string>& sided_names) {
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  // Whether a part of the text names a side. "_" belongs to the names of joints, and separates the
  // words "left" and "right" from others.
  const auto names_side = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end;) {
      size_t last = i;
      while (last < end && (is_word(text[last]) || text[last] == '_')) ++last;
      if (sided_names.contains(text.substr(i, last - i))) return true;
      std::string word;
      for (size_t k = i; k <= last; ++k) {
        if (k < last && text[k] != '_') {
          word += static_cast<char>(std::tolower(static_cast<unsigned char>(text[k])));
          continue;
        }
        if (word == "left" || word == "right") return true;
        word.clear();
      }
      i = last + 1;
    }
    return false;
  };
  std::set<int> lines;
  const auto look = [&](size_t begin, size_t end) {
    for (size_t at = begin; at < end;) {
      const size_t next = std::min(text.find('\n', at), end);
      if (names_side(at, next)) lines.insert(line_at(text, at));
      at = next + 1;
    }
  };
  for_each_comment(text, look);
  const JsonTree tree = json_tree(text);
  if (const JsonTree* const name = part_of(tree, "name")) look(name->at.begin, name->at.end);
  for (const char* const list : {"parameters", "postures"})
    if (const JsonTree* const named = part_of(tree, list))
      for (const JsonTree& part : named->parts) look(part.at.key, part.at.begin);
  return {lines.begin(), lines.end()};
}

std::optional<RewrittenPattern> rewritten(const std::string& text, const Pattern& before,
                                          const Pattern& after, const RewriteOptions& options) {
  Pattern moved = moved_to_folder(after, options.out.parent_path());
  if (moved.table) moved.table->file = table_beside(options.out).filename().string();
  const Ordered wanted = Rewrite::canonical(moved);
  const auto attempt = [&](const std::string& given) -> std::optional<RewrittenPattern> {
    try {
      Rewrite rewrite(given, options.time_scale);
      for (const auto& [name, value] : options.set)
        rewrite.replace("/parameters/" + json_pointer_token(name), number(value));
      const fs::path from = fs::path(before.file).parent_path();
      const Ordered document = Ordered::parse(given, nullptr, true, true);
      if (document.contains("include")) {
        const Ordered& include = document["include"];
        const auto rebase = [&](const std::string& pointer, const Ordered& name) {
          const std::string now = rebased(name.get<std::string>(), from, options.out.parent_path());
          if (now != name) rewrite.replace(pointer, quoted(now));
        };
        if (include.is_string()) rebase("/include", include);
        for (size_t i = 0; include.is_array() && i < include.size(); ++i)
          rebase("/include/" + std::to_string(i), include[i]);
      }
      const auto result = rewrite.between(before, moved);
      if (!result) return std::nullopt;
      Pattern read =
          pattern_of_text(*result, options.out, {}, moved.table ? &*moved.table : nullptr);
      if (!agrees(Rewrite::canonical(read), wanted, kSameNumber)) return std::nullopt;
      return RewrittenPattern{*result, std::move(read)};
    } catch (const Error&) {
      return std::nullopt;
    }
  };
  if (auto result = attempt(text)) return result;
  // A pattern without angles needs no unit; one of the changes may be an angle.
  const JsonTree tree = json_tree(text);
  if (part_of(tree, "units")) return std::nullopt;
  const std::string unit = before.degrees ? "deg" : "rad";
  return attempt(with_member(text, "", "units", Members().add("angle", quoted(unit)).object()));
}

}  // namespace ayumi
