#pragma once
// A task under uncertainty. The number of a case, together with the seed of the study, determines
// the values of all uncertain quantities, the robot that has them, and its run. Every value is
// drawn from its own random numbers, which depend on the seed of the study, the number of the case
// and the name of the value. So a case has the same values under every law and in every pattern,
// and adding a quantity does not change the values of the others.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/capture_bound.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/motion/uncertainty.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/study/push.hpp"

namespace ayumi {

/// A value that is drawn.
struct DrawnValue {
  std::string name;  ///< name such as "mass", "mass of l_foot" or "push: direction"
  const UncertainQuantity* quantity = nullptr;
  std::vector<int> targets;           ///< links or dofs that have this value
  int push = -1;                      ///< index of the push to which it belongs
  size_t own = 0;                     ///< index of its own random number in CaseNumbers::normal
  std::optional<size_t> factor = {};  ///< index of the random number of its factor
};

/// All random numbers of one case: independent standard normal ones, and the seed of the noise of
/// its sensors and of the heights of its ground.
struct CaseNumbers {
  std::vector<double> normal;
  std::uint64_t noise = 1;
};

/// The results of one run that are kept.
struct CaseResult {
  Outcome outcome = Outcome::unsettled;
  double fell_at = -1;   ///< time of the fall [s]; negative if the robot did not fall
  double cog_error = 0;  ///< largest COG error [m]
  double torque = 0;     ///< largest torque, in units of the limit
  double foot_tilt = 0;  ///< largest tilt of a supporting foot [rad]
  bool failed() const { return outcome != Outcome::stands; }
  bool operator==(const CaseResult&) const = default;
};

/// Severity from which a run has failed. Definition: larger than any COG error in m.
inline constexpr double kFailedSeverity = 1e3;
/// How bad a run is. For a run in which the robot stands it is the largest COG error [m]. Runs that
/// do not settle are worse than all of these. Falls are worse still, and an earlier fall is worse
/// than a later one.
double severity(const CaseResult& result);

class UncertainTask {
 public:
  /// Model, series and uncertainty must outlive this object. `options` contains law, profile, world
  /// and scenario. The pushes of the uncertainty replace the scenario. Throws Error(bad_pattern)
  /// "file: place: what" for a quantity or factor that nothing in this robot or study uses.
  UncertainTask(const RobotModel& model, const CommandSeries& series,
                const Uncertainty& uncertainty, const SimulateOptions& options);

  const std::vector<DrawnValue>& values() const { return values_; }
  /// The number of independent normal numbers of a case.
  size_t dimension() const { return dimension_; }

  CaseNumbers numbers(std::uint64_t seed, long number) const;
  /// The values of a case, in the order of values().
  std::vector<double> draw(const CaseNumbers& numbers) const;
  /// For each value, the share of all its draws that is below the value of this case.
  std::vector<double> shares(const CaseNumbers& numbers) const;

  /// Throws Error(bad_pattern) for a value that no robot can have, such as a negative mass. `which`
  /// names the case.
  void check(const std::vector<double>& drawn, const std::string& which) const;

  /// The robot of a case, and the options of its run. The caller sets SimulateOptions::unit to the
  /// robot. Throws the same errors as check().
  RobotUnit unit(const std::vector<double>& drawn) const;
  SimulateOptions options(const CaseNumbers& numbers, const std::vector<double>& drawn) const;

  /// Runs a case until its end, or until the robot has fallen.
  CaseResult run(const CaseNumbers& numbers) const;

  /// All values of a case in words with their units, one text for each kind of values, such as
  /// "mass of torso x 1.032, mass of head x 0.9871" and "friction 0.74".
  std::vector<std::string> values_by_kind(const std::vector<double>& drawn) const;

 private:
  /// A value in words, with the name of a phase or link if it has one.
  std::string value_text(size_t value, double drawn) const;
  void add_quantity(const UncertainQuantity& quantity);
  void add_value(const std::string& name, const UncertainQuantity& quantity,
                 std::vector<int> targets, int push);
  Disturbance push(size_t index, const std::vector<double>& drawn) const;
  HeightField hollows(double depth, std::uint64_t seed) const;

  const RobotModel* model_;
  const CommandSeries* series_;
  Controller controller_;  // the controller before its first tick
  const Uncertainty* uncertainty_;
  SimulateOptions options_;
  std::vector<DrawnValue> values_;
  std::vector<std::string> normal_names_;  // names of the independent numbers
  size_t dimension_ = 0;
  std::vector<PushPhase> phases_;       // phases, if a push names phases
  std::vector<CaptureRegion> regions_;  // capture regions of these phases
};

}  // namespace ayumi
