// Deviations q of base and joints, K = -dQ/dq of gravity, soles and servos by differences:
//   M q'' + D q' + K q = S' (kp P xr + kp diag(lead) P dxr)
// P gives the joints for a reference COG while the feet and the trunk are held, as (22)(23) solve
// them. The soles are springs at their corners. The forces that carry the weight stay at their
// corners while the body turns, which is what makes a pendulum fall.
#include "ayumi/control/stance_loop.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/servo_feedforward.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixX2d;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Step of the differences [m, rad]. Chosen: ten times the root of the rounding error of a double.
constexpr double kStep = 1e-6;

// Inverse weight of the base in the solution for P, relative to that of a joint. Definition: it is
// large, so that the base follows the joints freely.
constexpr double kFreeBase = 1e3;

// Time for which a walking robot stands on one foot, as a multiple of 1/omega. Chosen: the time of
// a step of VIIP. An error that grows by less than a factor e during this time is corrected on both
// feet: on soft soles, a robot can walk although it could not stand on one foot for long.
constexpr double kStepTime = 2.1;

// Regularisation of the solution for P, as a share of the trace. Chosen: rows that repeat each
// other (both feet on the ground) do not disturb it.
constexpr double kRidge = 1e-12;

struct Spring {
  int body = 0;
  Vector3d place, rest;  // place in the body frame, and in the world when the robot is at rest [m]
  double stiffness = 0;  // stiffness [N/m]
  double damping = 0;    // damping [N s/m]
  double load = 0;       // load that the point carries [N]
};

struct Stance {
  const RobotModel& model;
  const ActuatorLimits& actuators;
  RobotState state;
  RobotData data;
  std::vector<Spring> springs;

  Stance(const RobotModel& robot, const ActuatorLimits& limits)
      : model(robot), actuators(limits), state(robot.rest_state()), data(robot) {}

  void stand_on(const std::vector<Side>& feet) {
    update_positions(model, state, data);
    springs.clear();
    for (const Side side : feet) {
      const Sole& sole = model.sole(side);
      const auto count = static_cast<double>(sole.polygon.size());
      for (const Eigen::Vector2d& corner : sole.polygon) {
        Spring s;
        s.body = sole.body;
        s.place = sole.frame * Vector3d(corner.x(), corner.y(), 0);
        s.rest = data.pose(sole.body) * s.place;
        s.stiffness = sole.stiffness / count;
        s.damping = s.stiffness * sole.damping_time;
        s.load = model.mass() * kGravity / (count * static_cast<double>(feet.size()));
        springs.push_back(s);
      }
    }
  }

  MatrixXd jacobian(const Spring& s) const {
    return body_jacobian(model, data, s.body, data.pose(s.body) * s.place).topRows(3);
  }

  // Generalised force of gravity, soles and servos in a configuration at rest.
  VectorXd force(const RobotState& at) {
    VectorXd q = -bias_force(model, at, data);
    for (const Spring& s : springs) {
      const Vector3d place = data.pose(s.body) * s.place;
      const Vector3d push = s.stiffness * (s.rest - place) + Vector3d(0, 0, s.load);
      q += body_jacobian(model, data, s.body, place).topRows(3).transpose() * push;
    }
    for (int j = 0; j < model.dof_count(); ++j)
      q[6 + j] -= actuators.servo[static_cast<size_t>(j)].kp * (at.theta[j] - state.theta[j]);
    return q;
  }

  RobotState moved(Index coordinate, double step) const {
    RobotState at = state;
    if (coordinate < 3)
      at.base.position[coordinate] += step;
    else if (coordinate < 6)
      at.base.attitude =
          (elementary::turn_quaternion(step, Vector3d::Unit(coordinate - 3)) * at.base.attitude)
              .normalized();
    else
      at.theta[coordinate - 6] += step;
    return at;
  }

  MatrixXd stiffness() {
    const Index n = model.velocity_count();
    MatrixXd K(n, n);
    for (Index c = 0; c < n; ++c)
      K.col(c) = (force(moved(c, -kStep)) - force(moved(c, kStep))) / (2 * kStep);
    update_positions(model, state, data);
    return K;
  }

  MatrixXd damping() const {
    const Index n = model.velocity_count();
    MatrixXd D = MatrixXd::Zero(n, n);
    for (const Spring& s : springs) {
      const MatrixXd J = jacobian(s);
      D += s.damping * J.transpose() * J;
    }
    for (int j = 0; j < model.dof_count(); ++j) {
      const ServoDescription& servo = actuators.servo[static_cast<size_t>(j)];
      D(6 + j, 6 + j) += servo.kd + servo.viscous;
    }
    return D;
  }

  MatrixXd mass() {
    MatrixXd M;
    mass_matrix(model, data, M);
    for (int j = 0; j < model.dof_count(); ++j)
      M(6 + j, 6 + j) += actuators.servo[static_cast<size_t>(j)].rotor_inertia;
    return M;
  }

  // Joint rates for a unit velocity of the COG along an axis, with both feet and the trunk's
  // attitude held.
  VectorXd joints_per_cog(int axis) {
    const Index n = model.velocity_count();
    MatrixXd J(18, n);
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = model.sole(side);
      J.middleRows(side == Side::left ? 0 : 6, 6) =
          body_jacobian(model, data, sole.body, data.pose(sole.body) * sole.frame.translation());
    }
    const int trunk = model.trunk_body();
    J.middleRows(12, 3) =
        body_jacobian(model, data, trunk, data.pose(trunk).translation()).bottomRows(3);
    J.bottomRows(3) = cog_jacobian_floating(model, data);
    VectorXd u = VectorXd::Zero(18), weight(n);
    u[15 + axis] = 1;
    weight.head(6).setConstant(kFreeBase);
    weight.tail(model.dof_count()) = model.joint_weight().cwiseInverse();
    const MatrixXd JW = J * weight.asDiagonal();
    MatrixXd A = JW * J.transpose();
    A.diagonal().array() += kRidge * A.trace();
    return (JW.transpose() * solve_symmetric(A, u)).tail(model.dof_count());
  }
};

// Converts the continuous system to ticks with constant inputs. Rates are taken at the end of the
// tick, as in the integration of the plant: this damps an oscillation of w [rad/s] by w^2 tick / 2
// [1/s], 3 /s at 12 Hz and 1 ms.
void discretize(const MatrixXd& motion, const MatrixX2d& input, LoopModel& loop) {
  const Index n = motion.rows();
  const MatrixXd one = MatrixXd::Identity(n, n);
  loop.body = solve_general(MatrixXd(one - loop.tick * motion), one);
  loop.reference = loop.body * (loop.tick * input);
}

LoopModel stance_loop(Stance& stance, int axis, const LoopModel& like) {
  const RobotModel& model = stance.model;
  const Index n = model.velocity_count();
  LoopModel loop = like;
  const MatrixXd K = stance.stiffness(), D = stance.damping();
  const MatrixXd M = stance.mass();
  MatrixXd motion = MatrixXd::Zero(2 * n, 2 * n);
  motion.topRightCorner(n, n).setIdentity();
  motion.bottomLeftCorner(n, n) = -solve_symmetric(M, K);
  motion.bottomRightCorner(n, n) = -solve_symmetric(M, D);
  const VectorXd P = stance.joints_per_cog(axis), lead = velocity_lead(stance.actuators);
  MatrixX2d torque = MatrixX2d::Zero(n, 2), input = MatrixX2d::Zero(2 * n, 2);
  for (int j = 0; j < model.dof_count(); ++j) {
    const double asked = stance.actuators.servo[static_cast<size_t>(j)].kp * P[j];
    torque.row(6 + j) << asked, asked * lead[j];
  }
  input.bottomRows(n) = solve_symmetric(M, MatrixXd(torque));
  discretize(motion, input, loop);

  // The estimator places the middle of the loaded sole where the plan has it.
  const Sole& sole = model.sole(Side::left);
  const Vector3d middle =
      stance.data.pose(sole.body) * (sole.frame * Vector3d(sole.center.x(), sole.center.y(), 0));
  const RowVectorXd seen = cog_jacobian_floating(model, stance.data).row(axis) -
                           body_jacobian(model, stance.data, sole.body, middle).row(axis);
  loop.cog = loop.dcog = loop.zmp = RowVectorXd::Zero(2 * n);
  loop.cog.head(n) = seen;
  loop.dcog.tail(n) = seen;
  double total = 0, centre = 0;
  for (const Spring& s : stance.springs) {
    total += s.load;
    centre += s.load * s.rest[axis];
  }
  centre /= total;
  for (const Spring& s : stance.springs) {
    const RowVectorXd down = -stance.jacobian(s).row(2) * (s.rest[axis] - centre) / total;
    loop.zmp.head(n) += s.stiffness * down;
    loop.zmp.tail(n) += s.damping * down;
  }
  return loop;
}

}  // namespace

std::string name_of(const LoopModel& loop) {
  return std::string(loop.both_feet ? "both feet" : "one foot") +
         (loop.sideways ? ", sideways" : ", forward");
}

std::vector<LoopModel> stance_loops(const RobotModel& model, const ActuatorLimits& actuators,
                                    double height, double tick) {
  LoopModel like{.height = height, .tick = tick};
  double servo_delay = 0;
  for (Side side : {Side::left, Side::right})
    for (const int j : model.leg(side)) {
      const ServoDescription& servo = actuators.servo[static_cast<size_t>(j)];
      servo_delay = std::max(servo_delay, servo.delay);
      if (servo.kp <= 0)
        fail(ErrorCode::bad_model,
             model.name() + ": joint " + model.dofs()[static_cast<size_t>(j)].name +
                 " needs a servo with kp above 0. State kp of this joint in the sidecar");
    }
  like.delay = model.description().sensors.oldest(tick) + servo_delay;
  std::vector<LoopModel> loops;
  Stance stance(model, actuators);
  for (const bool both : {true, false}) {
    stance.stand_on(both ? std::vector<Side>{Side::left, Side::right}
                         : std::vector<Side>{Side::left});
    for (const int axis : {0, 1}) {
      like.both_feet = both;
      like.sideways = axis == 1;
      like.tolerated_growth = both ? 0 : std::sqrt(kGravity / height) / kStepTime;
      loops.push_back(stance_loop(stance, axis, like));
    }
  }
  return loops;
}

}  // namespace ayumi
