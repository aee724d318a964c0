#pragma once
// A limit is a rule that a motion must keep: the ground cannot pull, a motor has a largest torque,
// the posture's COG is the commanded one. Each limit has one file, which contains in this order:
//   1. its derivation;
//   2. its value, computed from the demand (demand/) of a sample or of the whole motion;
//   3. its tolerance with unit and source;
//   4. the rows that a repair keeps, with their derivative (row.hpp) and their places;
//   5. its class;
//   6. the price of a violation in a repair, and its soft goal where it has one;
//   7. its texts for people.
// The judge (check/), attribution, the repair, the writers of JSON and pages and the program visit
// the table limits(); limit_table.hpp has one line for each kind of finding.

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "ayumi/limits/finding.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct JudgedMotion;
struct JudgedSample;
struct RowSite;
struct FindingWindow;
struct Violation;

/// The class of a limit. Playing a motion more slowly changes rates and forces, but not postures.
enum class LimitClass {
  posture,  ///< where bodies are: joint positions, feet, clearances
  rate,     ///< how fast joints and servo targets move
  force,    ///< what the motion demands of the ground and the motors
  command   ///< whether the commanded COG, ZMP and f_z are those of the motion
};

/// A figure of the summary: the largest (or least) value of a limit over the motion.
struct SummaryFigure {
  const char* key = nullptr;    ///< in JSON; null: the kind has no figure
  const char* label = nullptr;  ///< on the report's page
  const char* unit = "";        ///< shown after the value times `scale`
  double scale = 1;
  const char* share_name =
      nullptr;         ///< its name in "of the limits: position 93 %, ..."; may be null
  bool least = false;  ///< the least value matters, not the largest
  int line = 0;        ///< place in JSON and on the page, an order that scripts and readers know
};

/// What a motion needs of the actuators where it breaks a limit that another actuator profile may
/// keep: "needs 8.1 N m at r_knee at 1.39 s (has 4.5)".
struct ActuatorNeedWords {
  int line = 0;            ///< place in the list of needs; 0: no actuator helps
  const char* after = "";  ///< after the unit
};

/// What to do about a finding, in two parts: by hand, and the advice to use `repair` (may be
/// empty).
struct Advice {
  Advice(std::string remedy, std::string or_repair = "")
      : remedy(std::move(remedy)), or_repair(std::move(or_repair)) {}
  Advice(const char* remedy) : remedy(remedy) {}
  std::string remedy, or_repair;
};

/// What an error of one kind means for a repair.
struct RepairTraits {
  /// The error concerns the motion in flight: there, the knots of a correction have to be close to
  /// each other.
  bool in_flight = false;
  /// The error lasts only as long as a sole is out of its place: the correction needs knots within
  /// this window.
  bool is_brief = false;
  /// The commanded COG or ZMP may itself be wrong near the error, and is then not a goal of the
  /// repair.
  bool is_of_plan = false;
  /// The error concerns the motion of one joint alone: if this joint is locked, the error cannot be
  /// removed.
  bool is_of_one_joint = false;
  /// The error concerns a mean over a fixed time: it is not caused by the posture of one sample,
  /// and a slower motion does not remove it.
  bool is_mean = false;
  /// If a motion is repaired, findings of this kind that are only warnings are repaired, too.
  bool warnings_too = false;
};

/// Everything about one kind of finding.
struct FindingSpec {
  FindingKind kind = FindingKind::cog_residual;
  LimitClass limit_class = LimitClass::posture;
  const char* unit = "";     ///< of the tolerance: "1" a share of the limit, "m g" of the weight
  double tolerance = 0;      ///< default; patterns and `--tolerance` may set another one
  const char* meaning = "";  ///< for `check --tolerances`
  /// The default for a motion of one robot is at least this; null: the default holds for all.
  double (*least_tolerance)(const RobotModel&, const CommandSeries&) = nullptr;
  SummaryFigure figure = {};
  ActuatorNeedWords actuator = {};
  RepairTraits repair = {};

  /// Unit of the values of a violation; null: `unit`.
  const char* (*finding_unit)(const JudgedMotion&, const Violation&) = nullptr;
  Place (*place)(const JudgedMotion&, const Violation&) = nullptr;
  Advice (*advice)(const JudgedMotion&, const FindingWindow&) = nullptr;
  /// Why no repair was found, in words. `violation`: value over limit where is_ratio(), else their
  /// distance. Null: a general text.
  std::string (*infeasibility)(const Finding&, double violation) = nullptr;
  /// Whether the violated sample keeps the limit when the path is played at this pace: rates times
  /// the pace, accelerations times its square. Null: another pace changes nothing.
  bool (*holds_at)(JudgedMotion&, const Violation&, double pace) = nullptr;

  /// The tolerance is a share of the limit.
  bool is_ratio() const { return unit[0] == '1'; }
};

struct Limit {
  std::vector<FindingSpec> findings;
  /// Notes what one sample violates; called for all samples in order of time.
  void (*judge_sample)(JudgedMotion&, const JudgedSample&) = nullptr;
  /// Computes what takes long and depends on the commands alone into a member of JudgedMotion that
  /// only this limit uses. Runs on another thread beside judge_sample.
  void (*look_ahead)(JudgedMotion&) = nullptr;
  /// Notes what takes the whole motion to see; called after all samples.
  void (*judge_motion)(JudgedMotion&) = nullptr;
  /// Places the rows of a repair at the points of a site (row_site.hpp) where the motion is near
  /// the limit. Null: no repair keeps this limit by itself; the check of its result looks at it.
  void (*place_rows)(RowSite&) = nullptr;
};

/// Every limit once, in the order of limit_table.hpp.
const std::vector<const Limit*>& limits();

/// Of one kind.
const FindingSpec& spec_of(FindingKind kind);

/// Of all kinds, in the order of limit_table.hpp.
const std::vector<const FindingSpec*>& finding_specs();

/// Of all kinds that have a figure, by SummaryFigure::line.
const std::vector<const FindingSpec*>& summary_figures();

/// Of all kinds that actuators can keep, by ActuatorNeedWords::line.
const std::vector<const FindingSpec*>& actuator_findings();

/// Whether the finding is about the posture itself, the same at every pace; a speed, a torque or a
/// ZMP at some time can be corrected although the posture there stays the same.
bool is_of_posture(const Finding& finding);

/// The figures of a motion, by kind; in the unit of FindingSpec::figure before its scale.
using CheckSummary = ByFindingKind<double>;

/// Where the motion has a figure of its summary.
struct FigurePlace {
  std::string where;  ///< joint, foot, axis, support or bodies in words; "" when it is not known
  double at = std::numeric_limits<double>::quiet_NaN();  ///< [s]; NaN when it is not known
};
using FigurePlaces = ByFindingKind<FigurePlace>;

/// In the unit of each kind's FindingSpec.
using Tolerances = ByFindingKind<double>;

/// How a motion is judged. Patterns and the command line may set single tolerances.
struct CheckOptions {
  std::string profile;  ///< actuator profile; "" = default of the robot
  double friction = 0.8;
  std::map<std::string, double> tolerances;  ///< by the name of the kind
  int threads = 0;                           ///< 0: all cores; results do not depend on it
  bool degrees = true;  ///< texts for people give angles in degrees, not in rad
};

/// The defaults with those that were set. Throws Error(usage) for an unknown name or a tolerance
/// that is not a finite number.
Tolerances tolerances(const CheckOptions& options);

/// Those for a motion of one robot: the default of angular_momentum grows with weight and height
/// (limits/angular_momentum.cpp). A tolerance that was set stays as it is.
Tolerances tolerances(const CheckOptions& options, const RobotModel& model,
                      const CommandSeries& series);

}  // namespace ayumi
