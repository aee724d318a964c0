#pragma once
// COG velocity -> whole-body joint rates, (22)(23) and (28)(29): the rates nearest to the commanded
// ones that give the COG its reference velocity while the other foot and the trunk follow the plan.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/body_tasks.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/motion/command_series.hpp"

namespace ayumi {

struct ResolverOptions {
  double posture_rate = 2.0;    ///< pull of the joints towards the commanded posture [1/s]
  double foot_rate = 20.0;      ///< correction of the free foot [1/s]
  double trunk_rate = 10.0;     ///< correction of the trunk attitude [1/s]
  double damping = 1e-5;        ///< of J_U W^-1 J_U', times trace / rows
  double angular_length = 0.2;  ///< that makes angular rows comparable with linear ones [m]
  double speed_share = 0.98;    ///< of a joint's speed limit that may be used
  Eigen::Vector3d lean = Eigen::Vector3d::Zero();       ///< of the trunk against the command, as a
                                                        ///< rotation vector in world axes [rad]
  Eigen::Vector3d lean_rate = Eigen::Vector3d::Zero();  ///< [rad/s]
  bool in_order = true;  ///< tasks give way one after the other; false: all of them together
};

/// Tasks that may give way to a joint's limit, in this order.
struct Tasks {
  bool height = false;  ///< of the COG
  bool trunk = false;   ///< attitude
};

struct Resolution {
  Eigen::VectorXd dtheta;  ///< ref joint rates [rad/s]
  double scale = 1;        ///< below 1 where a speed limit made the whole motion slower
  int limiting_dof = -1;   ///< the joint whose speed limit made tasks give way, or the motion slow
  std::vector<int> held;   ///< joints held at a position limit
  Tasks yielding;          ///< what gave way
};

/// One line per joint at a limit, with what gives way to it.
std::vector<std::string> limit_notes(const RobotModel& model, const Resolution& resolution);

/// What resolve() keeps its room in.
struct ResolverWork {
  BodyTasks tasks, softened, moving;  ///< as they are; some yielding; without the joints held
  BodyTasks::Rows weighted;
  Eigen::MatrixXd cog;
  Eigen::VectorXd bias, start;
  std::optional<RobotData> planned;  ///< where the trunk is not the root
  Resolution attempt;
};

/// `reference`: the reference posture anchored on the planned sole of `anchor`; `data` holds its
/// positions. `next_feet` are the planned sole frames one tick later (their motion is followed).
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

}  // namespace ayumi
