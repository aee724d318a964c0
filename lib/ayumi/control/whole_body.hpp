#pragma once
// COG velocity -> whole-body joint rates, (22)(23) and (28)(29), and the reference body that every
// law moves with them: a posture anchored on a planned sole, whose COG has the reference velocity,
// and the servo targets that make the robot follow.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/angular_momentum.hpp"
#include "ayumi/control/law.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

/// J_U, u of (22) and (28): the COG and the task constraints stacked, twelve rows by joint rates.
/// Rows 0-2: COG velocity, J_G and ref dp_G; 3-5 and 6-8: linear and angular velocity of the other
/// foot; 9-11: angular velocity of the trunk. Together 3-11 are J_C and c.
struct StackedTask {
  static constexpr int kRows = 12;  ///< Definition
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Rows = Eigen::Matrix<double, kRows, Eigen::Dynamic>;
  Rows J;    ///< J_U
  Vector u;  ///< u
};

/// (23), and (29) with bias 0: the rates nearest to `bias` in the norm W = diag(w) that do the
/// task,
///   x = bias + W^-1 J_U' (J_U W^-1 J_U' + lambda I)^-1 (u - J_U bias),
/// lambda = damping * trace / 12. In (23) the bias are the commanded rates; v = u - J_U bias has
/// the corrected sign (docs/notation.md). `weighted` is room to work in; allocates nothing when it
/// and x have their size.
void solve_stacked_task(const StackedTask& task, const Eigen::VectorXd& w,
                        const Eigen::VectorXd& bias, double damping, StackedTask::Rows& weighted,
                        Eigen::VectorXd& x);

struct ResolverOptions {
  double posture_rate = 2.0;    ///< pull of the joints towards the commanded posture [1/s]
  double foot_rate = 20.0;      ///< correction of the free foot [1/s]
  double trunk_rate = 10.0;     ///< correction of the trunk attitude [1/s]
  double damping = 1e-5;        ///< of J_U W^-1 J_U', times trace / rows
  double angular_length = 0.2;  ///< makes angular rows comparable with linear ones [m]
  double speed_share = 0.98;    ///< of a joint's speed limit that may be used
  UpperBodyTurn turn = {};      ///< of the trunk and the arms against their command
  bool in_order = true;         ///< tasks give way one after the other; false: all of them together
};

/// Tasks that may be reduced because of the limit of a joint, in this order.
struct YieldingTasks {
  bool height = false;  ///< of the COG
  bool trunk = false;   ///< attitude
};

struct Resolution {
  Eigen::VectorXd dtheta;  ///< ref joint rates [rad/s]
  double scale = 1;        ///< below 1 where a speed limit made the whole motion slower
  int limiting_dof = -1;   ///< the joint whose speed limit made tasks give way, or the motion slow
  std::vector<int> held;   ///< joints held at a position limit
  YieldingTasks yielding;  ///< the tasks that were reduced
  TaskResiduals residuals;
};

/// One line for each joint at a limit, with the tasks that are reduced because of it.
std::vector<std::string> limit_notes(const RobotModel& model, const Resolution& resolution);

/// Memory that resolve() uses again in each call.
struct ResolverWork {
  StackedTask task, softened, moving;  ///< as it is; some rows yielding; without the joints held
  StackedTask::Rows weighted;
  StackedTask::Vector left;  // of the task by the rates
  Eigen::MatrixXd cog;
  Eigen::VectorXd bias, start;
  std::optional<RobotData> planned;  ///< where the trunk is not the root
  Resolution attempt;
};

/// (22), and (28) for a plan without joint rates. `reference`: the reference posture anchored on
/// the planned sole of `anchor`; `data` holds its positions. `next` is the plan one tick later: the
/// motion of its feet is followed.
Resolution resolve(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, RobotData& data, Side anchor,
                   const Eigen::Vector3d& cog_velocity, const CommandSample& command,
                   const CommandSample& next, double dt, const Eigen::VectorXd& weight,
                   const ResolverOptions& options = {});

/// The same into `result`; allocates nothing when it is called again and no joint is at a limit.
void resolve(const RobotModel& model, const ActuatorLimits& limits, const RobotState& reference,
             RobotData& data, Side anchor, const Eigen::Vector3d& cog_velocity,
             const CommandSample& command, const CommandSample& next, double dt,
             const Eigen::VectorXd& weight, const ResolverOptions& options, ResolverWork& work,
             Resolution& result);

/// How the ankles answer a tilt of the soles.
struct AnkleLaw {
  double share = 0;       ///< of the stance foot's tilt against its ground that is turned back
  double compliance = 0;  ///< share of one foot's ground slope against the ground at large that its
                          ///< ankle gives in to
  double slope_time = 0;  ///< after which a lasting tilt counts as the ground's [s]; 0: never
  double contact_tilt_time = 0;  ///< the same for a foot whose centre of pressure is inside its
                                 ///< sole [s]; 0: as slope_time
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

  /// Turns of the two joints nearest to each foot [rad], by dof. Holds until the next call.
  const Eigen::VectorXd& ankle_offsets(const Estimate& estimate, const AnkleLaw& law);

  /// Off the ground: puts the base where the plan has it and works out positions and COG.
  void release(const CommandSample& command);

  /// One tick off the ground, in the place of advance(): the joints return to their command, and
  /// the legs turn at the hips against `tilt`, by which the trunk is turned from its plan [rad].
  /// Nothing is integrated: the COG moves as planned.
  void fly(const Eigen::Vector3d& tilt, const CommandSample& command, const CommandSample& next,
           const Eigen::VectorXd& offsets, ControlOutput& out);

  /// The trunk and the arms turn against their command from now on.
  void turn(const UpperBodyTurn& turn) { options_.turn = turn; }

  /// W = diag(weight) from now on [dof].
  void weigh(const Eigen::VectorXd& weight) { weight_ = weight; }

  /// Integrates ref.ddcog (both bounded; the bounds scale with the COG height z [m]), moves the
  /// posture by (22)(23) and fills everything of `out` but the COG. `offsets` are added to the
  /// servo targets [rad].
  void advance(const CogReference& ref, double z, const CommandSample& command,
               const CommandSample& next, const Eigen::VectorXd& offsets, ControlOutput& out);

 private:
  void send(const Eigen::VectorXd& dtheta, const CommandSample& command, const CommandSample& next,
            const Eigen::VectorXd& offsets, ControlOutput& out);
  void bound_target(const CommandSample& command, const CommandSample& next, ControlOutput& out);

  const RobotModel* model_;
  ActuatorLimits limits_;
  ResolverOptions options_;
  double dt_;
  RobotData data_;
  Eigen::VectorXd weight_, lead_, previous_target_, offsets_;
  std::vector<char> noted_;  // by dof: limits that its servo target was held to
  ResolverWork work_;
  Resolution resolution_;
  RobotState reference_;
  Side anchor_ = Side::left;
  Eigen::Vector3d dcog_ = Eigen::Vector3d::Zero();  // ref COG velocity [m/s]
  // Tilt of the ground under each foot, and at large [rad].
  std::array<Eigen::Vector3d, 2> slope_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d ground_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d tipped_ = Eigen::Vector3d::Zero();  // of the stance foot, filtered [rad]
};

}  // namespace ayumi
