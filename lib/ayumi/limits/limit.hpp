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
struct RobotData;
struct RowSite;
struct FindingWindow;
struct Violation;

/// The class of a limit. If a motion is played more slowly, rates and forces change, but postures
/// do not.
enum class LimitClass {
  posture,  ///< places of bodies: joint positions, feet, clearances
  rate,     ///< speeds of joints and servo targets
  force,    ///< demands of the motion on the ground and the motors
  command   ///< agreement of the commanded COG, ZMP and f_z with the motion
};

/// A figure of the summary: the largest (or smallest) value of a limit over the motion.
struct SummaryFigure {
  const char* key = nullptr;    ///< key in JSON; null if the kind has no figure
  const char* label = nullptr;  ///< label on the report's page
  const char* unit = "";        ///< unit that is shown after the value times `scale`
  double scale = 1;
  const char* share_name = nullptr;  ///< name in "of the limits: speed 93 %, ..."; may be null
  bool least = false;                ///< whether the smallest value counts and not the largest
  int line = 0;  ///< position in JSON and on the page; scripts and readers know this order
};

/// What a motion needs of the actuators if it violates a limit that another actuator profile may
/// keep, such as "needs 8.1 N m at r_knee at 1.39 s (has 4.5)".
struct ActuatorNeedWords {
  int line = 0;            ///< position in the list of needs; 0 if no actuator helps
  const char* after = "";  ///< text after the unit
};

/// Advice about a finding: what is wrong (may be empty), what to do by hand, and the advice to use
/// `repair` (may be empty).
struct Advice {
  Advice(std::string action, std::string or_repair = "")
      : action(std::move(action)), or_repair(std::move(or_repair)) {}
  Advice(const char* action) : action(action) {}
  Advice(std::string fact, std::string action, std::string or_repair)
      : fact(std::move(fact)), action(std::move(action)), or_repair(std::move(or_repair)) {}
  std::string remedy() const { return fact.empty() ? action : fact + ": " + action; }
  std::string fact, action, or_repair;
};

/// Properties of an error of one kind that matter for a repair.
struct RepairTraits {
  /// The error concerns the motion in flight: there, the knots of a correction have to be close to
  /// each other.
  bool in_flight = false;
  /// The error lasts only as long as a sole is out of its place: the correction needs knots within
  /// this window.
  bool is_brief = false;
  /// The commanded COG or ZMP may itself be wrong near the error. Then it is not a goal of the
  /// repair.
  bool is_of_plan = false;
  /// The error only concerns the motion of one joint: if this joint is locked, the error cannot be
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
  /// The unit of the tolerance: "1" for a share of the limit, "m g" for a share of the weight.
  const char* unit = "";
  double tolerance = 0;      ///< default tolerance; patterns and `--tolerance` may set another one
  const char* meaning = "";  ///< meaning in the text of `check --tolerances`
  /// The smallest default for a motion of one robot; null if the default is the same for all
  /// motions.
  double (*least_tolerance)(const RobotModel&, const CommandSeries&) = nullptr;
  SummaryFigure figure = {};
  ActuatorNeedWords actuator = {};
  RepairTraits repair = {};

  /// The unit of the values of a violation; null for `unit`.
  const char* (*finding_unit)(const JudgedMotion&, const Violation&) = nullptr;
  Place (*place)(const JudgedMotion&, const Violation&) = nullptr;
  Advice (*advice)(const JudgedMotion&, const FindingWindow&) = nullptr;
  /// The reason in words why no repair was found. `violation` is the ratio of value and limit if
  /// is_ratio(), and their difference otherwise. If the pointer is null, there is a general text.
  std::string (*infeasibility)(const Finding&, double violation) = nullptr;
  /// Whether the violated sample keeps the limit if the path is played at this pace: rates are
  /// multiplied by the pace, accelerations by its square. If the pointer is null, another pace
  /// changes nothing.
  bool (*holds_at)(JudgedMotion&, const Violation&, double pace) = nullptr;

  /// Whether the tolerance is a share of the limit.
  bool is_ratio() const { return unit[0] == '1'; }
};

struct Limit {
  std::vector<FindingSpec> findings;
  /// Stores values of one sample in members of JudgedMotion that have a place for each sample.
  /// Called before judge_sample of that sample, for several samples at the same time.
  void (*note_sample)(JudgedMotion&, const JudgedSample&, const RobotData&) = nullptr;
  /// Records the violations of one sample. Called for all samples in order of time.
  void (*judge_sample)(JudgedMotion&, const JudgedSample&) = nullptr;
  /// Computes values that only depend on the commands and need a long computation, and stores them
  /// in a member of JudgedMotion that only this limit uses. Runs on another thread at the same time
  /// as judge_sample.
  void (*look_ahead)(JudgedMotion&) = nullptr;
  /// Records violations that only the whole motion shows. Called after all samples.
  void (*judge_motion)(JudgedMotion&) = nullptr;
  /// Places the rows of a repair at those points of a site (row_site.hpp) at which the motion is
  /// near the limit. If the pointer is null, no repair keeps this limit by itself; the check of its
  /// result tests it.
  void (*place_rows)(RowSite&) = nullptr;
};

/// Every limit once, in the order of limit_table.hpp.
const std::vector<const Limit*>& limits();

/// The specification of one kind.
const FindingSpec& spec_of(FindingKind kind);

/// The specifications of all kinds, in the order of limit_table.hpp.
const std::vector<const FindingSpec*>& finding_specs();

/// The specifications of all kinds that have a figure, in the order of SummaryFigure::line.
const std::vector<const FindingSpec*>& summary_figures();

/// The specifications of all kinds for which other actuators can help, in the order of
/// ActuatorNeedWords::line.
const std::vector<const FindingSpec*>& actuator_findings();

/// Whether the finding is about the posture itself, which is the same at every pace. A speed, a
/// torque or a ZMP at some time can be corrected although the posture there stays the same.
bool is_of_posture(const Finding& finding);

/// The figures of a motion by kind, in the unit of FindingSpec::figure before its scale.
using CheckSummary = ByFindingKind<double>;

/// The place where the motion has a figure of its summary.
struct FigurePlace {
  std::string where;  ///< joint, foot, axis, support or bodies in words; "" if it is unknown
  double at = std::numeric_limits<double>::quiet_NaN();  ///< time [s]; NaN if it is unknown
};
using FigurePlaces = ByFindingKind<FigurePlace>;

/// Tolerances by kind, in the unit of the kind's FindingSpec.
using Tolerances = ByFindingKind<double>;

/// Options of the check. Patterns and the command line may set single tolerances.
struct CheckOptions {
  std::string profile;  ///< actuator profile; "" for the default of the robot
  /// Friction coefficient of the ground.
  double friction = 0.8;
  std::map<std::string, double> tolerances;  ///< tolerances by the name of the kind
  int threads = 0;      ///< number of threads; 0 for all cores; results do not depend on it
  bool degrees = true;  ///< whether texts for people have angles in degrees and not in rad
};

/// The default tolerances, overridden by those that were set. Throws Error(usage) for an unknown
/// name or a tolerance beyond kLargestNumber. A negative tolerance requires a margin.
Tolerances tolerances(const CheckOptions& options);

/// The tolerances for a motion of one robot: the default of angular_momentum grows with weight and
/// height (limits/angular_momentum.cpp). A tolerance that was set is not changed.
Tolerances tolerances(const CheckOptions& options, const RobotModel& model,
                      const CommandSeries& series);

}  // namespace ayumi
