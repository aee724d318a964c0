#pragma once
// The reference body that every law moves: a posture anchored on a planned sole, moved by (22)(23)
// so that its COG has the reference velocity, and the servo targets that make the robot follow.

#include <string>
#include <vector>

#include "ayumi/control/estimator.hpp"
#include "ayumi/control/resolver.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

/// What a controller asks of the body: the reference of (14)-(21) and (24).
struct CogReference {
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< ref p_Z, plan frame [m]
  double fz = 0;                                    ///< ref f_z [N]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< ref acceleration [m/s^2]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< its integral [m/s]
};

struct ControlOutput {
  Eigen::VectorXd target;  ///< what the servos receive [rad]
  RobotState reference;    ///< reference posture, plan frame
  CogReference cog_reference;
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< of the reference posture [m]
  std::vector<std::string> notes;                 ///< what gave way: saturated joints, held limits
};

/// What one law leaves to the next.
struct Handover {
  RobotState reference;                            ///< plan frame
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();  ///< of the reference [m/s]
  Eigen::VectorXd target;                          ///< last servo targets [rad]
  CommandSample plan;                              ///< last plan: feet and support
};

class ReferenceBody {
 public:
  /// At rest in the posture `start`, which the servos hold with `target` [rad].
  ReferenceBody(const RobotModel& model, const ActuatorLimits& limits, double dt,
                const RobotState& start, const Eigen::VectorXd& target,
                const ResolverOptions& options = {});

  /// Goes on from what another law left.
  void take_over(const Handover& handover);

  /// Puts the sole of `side` where the plan has it and works out positions and COG.
  void anchor(Side side, const Eigen::Isometry3d& sole);

  const RobotState& state() const { return reference_; }
  const RobotData& data() const { return data_; }  ///< positions of the anchored posture
  const Eigen::Vector3d& cog() const { return data_.cog; }
  const Eigen::Vector3d& dcog() const { return dcog_; }
  const Eigen::VectorXd& target() const { return previous_target_; }

  /// Turns of the two joints nearest to the feet. A stance foot that tips is turned back by `share`
  /// of its tilt against the ground under it; where that ground slopes otherwise than the ground
  /// at large, the ankle gives in by `conform` of the difference.
  struct AnkleLaw {
    double share = 0, conform = 0;
    double forget = 0;  ///< after which a lasting tilt counts as the ground's [s]; 0: never
    double lie = 0;     ///< the same for a foot whose centre of pressure is inside its sole [s];
                        ///< 0: as `forget`
  };
  /// Holds until the next call.
  const Eigen::VectorXd& ankle_offsets(const Estimate& estimate, const AnkleLaw& law);

  /// The trunk leans by this rotation vector against its command, at this rate [rad, rad/s].
  void lean(const Eigen::Vector3d& angle, const Eigen::Vector3d& rate) {
    options_.lean = angle;
    options_.lean_rate = rate;
  }

  /// Integrates ref.ddcog (both bounded; the bounds scale with the COG height z [m]) and moves the
  /// posture; fills everything of `out` but the COG. `ref` receives the velocity.
  void advance(const CogReference& ref, double z, const CommandSample& command,
               const CommandSample& next, const Eigen::VectorXd& offsets, ControlOutput& out);

 private:
  void bound_target(ControlOutput& out);

  const RobotModel* model_;
  ActuatorLimits limits_;
  ResolverOptions options_;
  double dt_;
  RobotData data_;
  Eigen::VectorXd weight_, lead_, previous_target_, offsets_;
  std::vector<char> told_;  // by dof: limits its servo target was held to
  ResolverWork work_;
  Resolution resolution_;
  RobotState reference_;
  Side anchor_ = Side::left;
  Eigen::Vector3d dcog_ = Eigen::Vector3d::Zero();  // ref COG velocity [m/s]
  // Tilt of the ground under each foot, and at large [rad].
  std::array<Eigen::Vector3d, 2> slope_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d ground_ = Eigen::Vector3d::Zero();
};

}  // namespace ayumi
