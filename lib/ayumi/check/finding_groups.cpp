#include "ayumi/check/finding_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

// A place and its mirror image have the same key: the kind of place and two numbers.
using PlaceKey = std::tuple<size_t, int, int, std::string>;

class PlaceKeys {
 public:
  explicit PlaceKeys(const RobotModel& model) : model_(model) {
    try {
      map_ = mirror_map(model);
    } catch (const Error&) {  // the robot has no mirror image
    }
  }

  PlaceKey of(const Finding& finding) const {
    const Place place = place_of(finding);
    if (std::holds_alternative<std::monostate>(place)) return {0, 0, 0, finding.where};
    const auto [first, second] = std::visit(*this, place);
    return {place.index(), first, second, ""};
  }

  std::pair<int, int> operator()(std::monostate) const { return {0, 0}; }
  std::pair<int, int> operator()(const JointPlace& p) const {
    return {map_ && p.dof >= 0 ? std::min(p.dof, map_->dof[p.dof]) : p.dof, 0};
  }
  std::pair<int, int> operator()(const FootPlace&) const { return {0, 0}; }
  std::pair<int, int> operator()(const AxisPlace& p) const { return {p.axis, 0}; }
  std::pair<int, int> operator()(const SupportPlace& p) const {
    return {
        p.support == Support::right ? static_cast<int>(Support::left) : static_cast<int>(p.support),
        0};
  }
  std::pair<int, int> operator()(const BodyPairPlace& p) const {
    const std::pair<int, int> here = std::minmax(p.a, p.b);
    if (!map_) return here;
    const std::pair<int, int> there = std::minmax(image(p.a), image(p.b));
    return std::min(here, there);
  }

 private:
  // A finding that was read from a file has only the name of its place, as where_text() gives it.
  Place place_of(const Finding& finding) const {
    if (!std::holds_alternative<std::monostate>(finding.place)) return finding.place;
    if (const int dof = model_.find_dof(finding.where); dof >= 0) return JointPlace{dof};
    for (const Side side : {Side::left, Side::right})
      if (finding.where == name_of(side)) return FootPlace{side};
    const size_t count = model_.bodies().size();
    for (size_t a = 0; a < count; ++a) {
      const std::string first = model_.bodies()[a].name + " - ";
      if (!finding.where.starts_with(first)) continue;
      for (size_t b = 0; b < count; ++b)
        if (finding.where.substr(first.size()) == model_.bodies()[b].name)
          return BodyPairPlace{static_cast<int>(a), static_cast<int>(b)};
    }
    return {};
  }

  int image(int body) const {
    const int dof = body > 0 ? model_.bodies()[body].dof : -1;
    if (dof < 0 || model_.dofs()[dof].body != body) return body;
    return model_.dofs()[map_->dof[dof]].body;
  }

  const RobotModel& model_;
  std::optional<MirrorMap> map_;
};

// Amount by which a value exceeds its limit. Only absolute values are compared: a limit for values
// of one sign has this sign, and a limit for values of both signs is positive.
double excess(const Finding& f) { return std::abs(std::abs(f.worst) - std::abs(f.limit)); }

int root_of(const ConsistencyReport& report, int i) {
  while (report.findings[i].cause >= 0) i = report.findings[i].cause;
  return i;
}

void note_consequence(FindingGroup& group, const ConsistencyReport& report, int i) {
  const Finding& f = report.findings[i];
  for (GroupConsequence& known : group.consequences) {
    if (known.kind != f.kind) continue;
    ++known.count;
    if (is_further_beyond(f, report.findings[known.worst])) known.worst = i;
    return;
  }
  group.consequences.push_back({f.kind, 1, i});
}

}  // namespace

bool is_further_beyond(const Finding& a, const Finding& b) { return excess(a) > excess(b); }

std::vector<FindingGroup> finding_groups(const ConsistencyReport& report, const RobotModel& model) {
  if (report.findings.empty()) return {};
  const PlaceKeys keys(model);
  const int count = static_cast<int>(report.findings.size());
  std::vector<FindingGroup> groups;
  std::map<std::tuple<FindingKind, Severity, PlaceKey>, size_t> known;
  std::vector<size_t> group_of(count);
  for (int i = 0; i < count; ++i) {
    const Finding& f = report.findings[i];
    if (f.cause >= 0) continue;
    const auto [entry, is_new] = known.try_emplace({f.kind, f.severity, keys.of(f)}, groups.size());
    if (is_new) groups.push_back({.worst = i});
    group_of[i] = entry->second;
    FindingGroup& group = groups[entry->second];
    group.members.push_back(i);
    if (is_further_beyond(f, report.findings[group.worst])) group.worst = i;
    const std::string place = place_words(f.where);
    if (std::find(group.places.begin(), group.places.end(), place) == group.places.end())
      group.places.push_back(place);
  }
  for (int i = 0; i < count; ++i)
    if (report.findings[i].cause >= 0)
      note_consequence(groups[group_of[root_of(report, i)]], report, i);
  return groups;
}

}  // namespace ayumi
