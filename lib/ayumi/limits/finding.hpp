#pragma once
// A finding is one result of the check of a motion: its kind, its place and time, its size, and a
// remedy. Kind and place are typed; their texts are for people only.

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

/// In the order of limit_table.hpp.
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
/// The kind of that name, or nothing.
std::optional<FindingKind> finding_kind(std::string_view name);
/// All names, in the order of the enum.
const std::vector<std::string>& finding_kind_names();

/// One value for every kind of finding.
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

/// Where in the robot a finding occurs.
struct JointPlace {
  int dof = 0;
};
struct FootPlace {
  Side side = Side::left;
};
struct AxisPlace {
  int axis = 0;  ///< 0, 1, 2: x, y, z of the world
};
struct SupportPlace {
  Support support = Support::both;
};
struct BodyPairPlace {
  int a = 0, b = 0;  ///< indices into RobotModel::bodies()
};
/// std::monostate: not known, as in a finding that was read from a file.
using Place =
    std::variant<std::monostate, JointPlace, FootPlace, AxisPlace, SupportPlace, BodyPairPlace>;

struct Finding {
  FindingKind kind = FindingKind::cog_residual;
  Severity severity = Severity::error;
  double begin = 0, end = 0, at = 0;  ///< window and worst sample [s]
  double worst = 0, limit = 0;        ///< in `unit`
  std::string unit;                   ///< "m", "N", "rad", "rad/s", "N m", "s", "1", ...
  std::string where;                  ///< `place` in words: joint, foot, axis, support, bodies
  std::string hint;                   ///< what to do about it
  std::string follows_from = {};      ///< the error that causes this one; "" when it stands alone
  int cause = -1;           ///< index of that error in the report; -1: none, or read from a file
  std::string remedy = {};  ///< the hint without the advice to use `repair`
  Place place = {};
  bool in_degrees = true;  ///< texts for people have angles in degrees, not in rad
};

/// The dof of a finding at a joint, -1 of any other.
int dof_of(const Finding& finding);

/// Finding::where for people: "left" as "left foot", "x" as "x axis", and what follows the name of
/// the place as it is. Joints and bodies keep their names. `with_article`: "the left foot".
std::string place_words(const std::string& where, bool with_article = false);

}  // namespace ayumi
