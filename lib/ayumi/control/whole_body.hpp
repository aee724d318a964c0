#pragma once
// Joint rates of the whole body for a velocity of the COG, (22)(23) and (28)(29), and the reference
// body that every law moves with these rates. The reference body is a posture anchored on a planned
// sole, whose COG has the reference velocity, with the servo targets that make the robot follow.

#include <limits>
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
  static constexpr int kRows = 12;  ///< Definition: number of rows
  using Vector = Eigen::Matrix<double, kRows, 1>;
  using Rows = Eigen::Matrix<double, kRows, Eigen::Dynamic>;
  Rows J;    ///< matrix J_U
  Vector u;  ///< right side u
};

/// (23), and (29) with bias 0: the rates nearest to `bias` in the norm W = diag(w) that do the
/// task,
///   x = bias + W^-1 J_U' (J_U W^-1 J_U' + lambda I)^-1 (u - J_U bias),
/// lambda = damping * trace / 12. In (23), the bias consists of the commanded rates; v = u - J_U
/// bias has the corrected sign (docs/notation.md). `weighted` is a workspace; the function
/// allocates nothing if it and x have their size.
void solve_stacked_task(const StackedTask& task, const Eigen::VectorXd& w,
                        const Eigen::VectorXd& bias, double damping, StackedTask::Rows& weighted,
                        Eigen::VectorXd& x);

struct ResolverOptions {
  /// Rate of the pull of the joints towards the commanded posture [1/s].
  double posture_rate = 2.0;
  double foot_rate = 20.0;      ///< rate of the correction of the free foot [1/s]
  double trunk_rate = 10.0;     ///< rate of the correction of the trunk's attitude [1/s]
  double damping = 1e-5;        ///< damping of J_U W^-1 J_U', as a multiple of trace / rows
  double angular_length = 0.2;  ///< length that makes angular rows comparable with linear ones [m]
  double speed_share = 0.98;    ///< share of a joint's speed limit that may be used
  /// Deceleration with which a joint that turns brakes before its position limit [rad/s^2], and the
  /// deceleration of a joint that slides [m/s^2]. If infinite, a joint stops in one tick when it is
  /// at the limit. ReferenceBody sets both in each tick.
  double braking = std::numeric_limits<double>::infinity();
  double sliding_braking = std::numeric_limits<double>::infinity();
  UpperBodyTurn turn = {};  ///< turn of the trunk and the arms relative to their command
  /// Whether tasks are reduced one after the other. Otherwise all of them are reduced together.
  bool in_order = true;
};

/// Tasks that may be reduced because of the limit of a joint, in this order.
struct YieldingTasks {
  bool height = false;  ///< COG height
  bool trunk = false;   ///< attitude of the trunk
};

struct Resolution {
  Eigen::VectorXd dtheta;  ///< reference rates of the joints [rad/s]
  double scale = 1;        ///< below 1 if a speed limit made the whole motion slower
  /// Joint whose speed limit made the law reduce tasks or slow the motion down.
  int limiting_dof = -1;
  std::vector<int> held;     ///< joints whose rates a position limit bounds
  std::vector<int> braking;  ///< those of them that brake before the limit, and are not at it
  YieldingTasks yielding;    ///< the tasks that were reduced
  TaskResiduals residuals;
};

/// One line for each joint at a limit, with the tasks that are reduced because of it.
std::vector<std::string> limit_notes(const RobotModel& model, const Resolution& resolution);

/// Memory that resolve() uses again in each call.
struct ResolverWork {
  /// The task as it is; with reduced rows; without the joints that are held at a limit.
  StackedTask task, softened, moving;
  StackedTask::Rows weighted;
  StackedTask::Vector left;  // residual of the task
  Eigen::MatrixXd cog;
  Eigen::VectorXd bias, start;
  std::optional<RobotData> planned;  ///< positions of the plan, if the trunk is not the root
  Resolution attempt;
};

/// (22), and (28) for a plan without joint rates. `reference` is the reference posture anchored on
/// the planned sole of `anchor`, and `data` has its positions. `next` is the plan one tick later;
/// the motion of its feet is followed.
Resolution resolve(const RobotModel& model, const ActuatorLimits& limits,
                   const RobotState& reference, RobotData& data, Side anchor,
                   const Eigen::Vector3d& cog_velocity, const CommandSample& command,
                   const CommandSample& next, double dt, const Eigen::VectorXd& weight,
                   const ResolverOptions& options = {});

/// Writes the same into `result`. Allocates nothing when it is called again and no joint is at a
/// limit.
void resolve(const RobotModel& model, const ActuatorLimits& limits, const RobotState& reference,
             RobotData& data, Side anchor, const Eigen::Vector3d& cog_velocity,
             const CommandSample& command, const CommandSample& next, double dt,
             const Eigen::VectorXd& weight, const ResolverOptions& options, ResolverWork& work,
             Resolution& result);

/// The reaction of the ankles to a tilt of the soles.
struct AnkleLaw {
  double share = 0;  ///< share of the stance foot's tilt relative to its ground that is compensated
  /// Share of the difference between one foot's ground slope and the general slope to which its
  /// ankle yields.
  double compliance = 0;
  /// Time after which a lasting tilt counts as that of the ground [s]; 0 if this never happens.
  double slope_time = 0;
  /// Value of `slope_time` for a foot whose centre of pressure is inside its sole [s]. With 0, this
  /// foot has `slope_time`, too.
  double contact_tilt_time = 0;
};

class ReferenceBody {
 public:
  /// Starts at rest in the posture `start`, which the servos hold with `target` [rad].
  ReferenceBody(const RobotModel& model, const ActuatorLimits& limits, double dt,
                const RobotState& start, const Eigen::VectorXd& target,
                const ResolverOptions& options = {});

  /// Continues from the state that another law has left.
  void take_over(const Handover& handover);

  /// Puts the sole of `side` where the plan has it, and computes positions and COG.
  void anchor(Side side, const Eigen::Isometry3d& sole);

  const RobotState& state() const { return reference_; }
  const RobotData& data() const { return data_; }  ///< positions of the anchored posture
  const Eigen::Vector3d& cog() const { return data_.cog; }
  const Eigen::Vector3d& dcog() const { return dcog_; }
  const Eigen::VectorXd& target() const { return previous_target_; }

  /// The turns of the two joints nearest to each foot [rad], by dof. The result is valid until the
  /// next call.
  const Eigen::VectorXd& ankle_offsets(const Estimate& estimate, const AnkleLaw& law);

  /// For a robot off the ground: puts the base where the plan has it, and computes positions and
  /// COG.
  void release(const CommandSample& command);

  /// One tick off the ground, instead of advance(). The joints return to their command, and the
  /// legs turn at the hips against `tilt`, the turn of the trunk relative to its plan [rad].
  /// Nothing is integrated: the COG moves as planned.
  void fly(const Eigen::Vector3d& tilt, const CommandSample& command, const CommandSample& next,
           const Eigen::VectorXd& offsets, ControlOutput& out);

  /// The turn of the trunk that the position limits of the joints still allow, if COG and soles
  /// stay as in the last tick. It is unlimited before the first tick.
  TurnRoom turn_room();

  /// Sets the turn of the trunk and the arms relative to their command from now on.
  void turn(const UpperBodyTurn& turn) { options_.turn = turn; }

  /// Sets W = diag(weight) from now on [dof].
  void weigh(const Eigen::VectorXd& weight) { weight_ = weight; }

  /// Integrates ref.ddcog, with bounds on acceleration and speed that scale with the COG height z
  /// [m]. Moves the posture by (22)(23) and fills all of `out` except the COG. `offsets` are added
  /// to the servo targets [rad].
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
  Eigen::VectorXd turning_;  // rates of the joints for a trunk that turns at unit rate [1]
  std::vector<char> noted_;  // by dof: the limits by which its servo target was bounded
  ResolverWork work_;
  Resolution resolution_;
  RobotState reference_;
  Side anchor_ = Side::left;
  Eigen::Vector3d dcog_ = Eigen::Vector3d::Zero();  // ref COG velocity [m/s]
  // Tilt of the ground under each foot, and of the ground in general [rad].
  std::array<Eigen::Vector3d, 2> slope_ = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  Eigen::Vector3d ground_ = Eigen::Vector3d::Zero();
  // Tilt of the stance foot after a filter [rad].
  Eigen::Vector3d tipped_ = Eigen::Vector3d::Zero();
};

}  // namespace ayumi
