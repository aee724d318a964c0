#pragma once
// A finding is one result of the check of a motion: its kind, its place and time, its size, and a
// remedy. Programs use the types of kind and place; the texts are for people only.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "ayumi/limits/limit_table.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

enum class Severity { error, warning, info };
const char* name_of(Severity severity);

/// The kinds are in the order of limit_table.hpp.
enum class FindingKind {
#define AYUMI_ENUMERATOR(kind, limit) kind,
  AYUMI_FINDING_KINDS(AYUMI_ENUMERATOR)
#undef AYUMI_ENUMERATOR
};
#define AYUMI_COUNT(kind, limit) +1
inline constexpr int kFindingKindCount = AYUMI_FINDING_KINDS(AYUMI_COUNT);
#undef AYUMI_COUNT

/// The name in JSON files, option values and texts.
const char* name_of(FindingKind kind);
/// The kind with this name, or nothing.
std::optional<FindingKind> finding_kind(std::string_view name);
/// All names, in the order of the enum.
const std::vector<std::string>& finding_kind_names();

/// A table with one value for every kind of finding.
template <typename Value>
class ByFindingKind {
 public:
  Value& operator[](FindingKind kind) { return values_[static_cast<size_t>(kind)]; }
  const Value& operator[](FindingKind kind) const { return values_[static_cast<size_t>(kind)]; }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }
  auto begin() const { return values_.begin(); }
  auto end() const { return values_.end(); }

 private:
  std::array<Value, kFindingKindCount> values_ = {};
};

/// The place in the robot where a finding occurs.
struct JointPlace {
  int dof = 0;
};
struct FootPlace {
  Side side = Side::left;
};
struct AxisPlace {
  int axis = 0;  ///< 0, 1, 2 for x, y, z of the world
};
struct SupportPlace {
  Support support = Support::both;
};
struct BodyPairPlace {
  int a = 0, b = 0;  ///< indices into RobotModel::bodies()
};
/// std::monostate means that the place is unknown, as in a finding that was read from a file.
using Place =
    std::variant<std::monostate, JointPlace, FootPlace, AxisPlace, SupportPlace, BodyPairPlace>;

struct Finding {
  FindingKind kind = FindingKind::cog_residual;
  Severity severity = Severity::error;
  double begin = 0, end = 0, at = 0;  ///< window of the finding, and time of its worst sample [s]
  double worst = 0, limit = 0;        ///< worst value and limit, in `unit`
  std::string unit;                   ///< "m", "N", "rad", "rad/s", "N m", "s", "1", ...
  std::string where;                  ///< `place` in words: a joint, foot, axis, support or bodies
  std::string hint;                   ///< advice about what to do
  std::string follows_from = {};      ///< the error that causes this one; "" if it has no cause
  /// Index of this error in the report; -1 if there is none, or if the finding was read from a
  /// file.
  int cause = -1;
  std::string remedy = {};  ///< the hint without the advice to use `repair`
  std::string action = {};  ///< the remedy without the fact that it begins with
  Place place = {};
  bool in_degrees = true;  ///< whether texts for people have angles in degrees and not in rad
};

/// The dof of a finding at a joint; -1 for any other finding.
int dof_of(const Finding& finding);

/// Finding::where in words for people: "left" becomes "left foot", and "x" becomes "x axis"; text
/// after the name of the place is not changed. Joints and bodies keep their names. With
/// `with_article`, it is "the left foot".
std::string place_words(const std::string& where, bool with_article = false);

}  // namespace ayumi
