#include "tests/support/walk.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/dense.hpp"

namespace ayumi::test {
namespace {

/// The x with x - h/g x'' = z that is at rest at both ends.
Eigen::VectorXd solve_pendulum(const Eigen::VectorXd& z, double height, double dt) {
  const int n = static_cast<int>(z.size());
  const double a = height / kGravity / (dt * dt);
  Eigen::VectorXd c(n), x(n);
  x[0] = z[0];
  c[0] = 0;
  for (int k = 1; k < n; ++k) {
    const bool end = k == n - 1;
    const double low = end ? 0 : -a, diagonal = end ? 1 : 1 + 2 * a, high = end ? 0 : -a;
    const double m = diagonal - low * c[k - 1];
    c[k] = high / m;
    x[k] = (z[k] - low * x[k - 1]) / m;
  }
  for (int k = n - 2; k >= 0; --k) x[k] -= c[k] * x[k + 1];
  return x;
}

struct FootPlan {
  std::vector<Support> support;
  std::vector<std::array<Eigen::Isometry3d, 2>> feet;
  Eigen::MatrixXd zmp;  // ZMP, samples x 2
};

FootPlan plan_feet(const RobotModel& model, const WalkShape& w,
                   const std::array<Eigen::Isometry3d, 2>& start) {
  const double swing = w.period - w.double_support;
  const double duration = 2 * w.lead + w.steps * w.period - w.double_support;
  const int n = static_cast<int>(std::lround(duration / w.dt)) + 1;
  FootPlan plan;
  plan.support.resize(n);
  plan.feet.resize(n);
  plan.zmp.resize(n, 2);
  auto center = [&](const Eigen::Isometry3d& sole, Side side) {
    const Eigen::Vector2d c = model.sole(side).center;
    return Eigen::Vector2d((sole * Eigen::Vector3d(c.x(), c.y(), 0)).head<2>());
  };
  auto feet = start;
  Eigen::Vector2d from = 0.5 * (center(feet[0], Side::left) + center(feet[1], Side::right));
  int step = 0;
  auto swing_begin = [&](int i) { return w.lead + i * w.period; };
  for (int k = 0; k < n; ++k) {
    const double t = k * w.dt;
    if (step < w.steps && t >= swing_begin(step) + swing - 1e-9) {
      const int foot = step % 2 == 0 ? 1 : 0;
      const bool last = step == w.steps - 1;
      feet[foot].translation().x() = feet[1 - foot].translation().x() + (last ? 0 : w.stride);
      from = center(feet[1 - foot], foot == 0 ? Side::right : Side::left);
      ++step;
    }
    const bool swinging = step < w.steps && t >= swing_begin(step) - 1e-9;
    plan.feet[k] = feet;
    const int foot = step % 2 == 0 ? 1 : 0;
    const Side stance = foot == 0 ? Side::right : Side::left;
    if (swinging) {
      const double s = (t - swing_begin(step)) / swing;
      const bool last = step == w.steps - 1;
      const double goal = feet[1 - foot].translation().x() + (last ? 0 : w.stride);
      const double here = feet[foot].translation().x();
      plan.feet[k][foot].translation().x() = here + (goal - here) * minimum_jerk(s);
      plan.feet[k][foot].translation().z() += w.lift * 64 * std::pow(s * (1 - s), 3);
      plan.support[k] = stance == Side::left ? Support::left : Support::right;
      plan.zmp.row(k) = center(feet[1 - foot], stance).transpose();
    } else {
      plan.support[k] = Support::both;
      Eigen::Vector2d to = 0.5 * (center(feet[0], Side::left) + center(feet[1], Side::right));
      double begin = swing_begin(step) - w.double_support, length = w.double_support;
      if (step == 0) begin = 0.3, length = w.lead - 0.3;
      if (step == w.steps) length = w.lead - 0.3;
      if (step < w.steps) to = center(feet[1 - foot], stance);
      plan.zmp.row(k) = (from + (to - from) * minimum_jerk((t - begin) / length)).transpose();
    }
  }
  return plan;
}

}  // namespace

double minimum_jerk(double s) {
  s = std::clamp(s, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

void place_legs(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& feet,
                RobotState& state, RobotData& data) {
  for (Side side : {Side::left, Side::right}) {
    const std::vector<int>& leg = model.leg(side);
    const Eigen::Isometry3d& goal = feet[static_cast<int>(side)];
    for (int i = 0; i < 30; ++i) {
      update_positions(model, state, data);
      const Eigen::Isometry3d sole = sole_pose(model, data, side);
      Eigen::Matrix<double, 6, 1> error;
      error << goal.translation() - sole.translation(),
          log_rotation(Eigen::Quaterniond(goal.linear() * sole.linear().transpose()));
      if (error.norm() < 1e-13) break;
      const Eigen::MatrixXd J =
          body_jacobian(model, data, model.sole(side).body, sole.translation());
      Eigen::MatrixXd Jleg(6, leg.size());
      for (size_t j = 0; j < leg.size(); ++j) Jleg.col(j) = J.col(6 + leg[j]);
      const Eigen::VectorXd step = solve_dense(Jleg, error);
      for (size_t j = 0; j < leg.size(); ++j) state.theta[leg[j]] += step[j];
    }
  }
}

void complete_series(const RobotModel& model, CommandSeries& series, double ground) {
  const int n = static_cast<int>(series.samples.size());
  const double dt = series.dt;
  const int dof = model.dof_count();
  auto at = [&](int k) -> const RobotState& {
    return series.samples[std::clamp(k, 0, n - 1)].state;
  };
  for (int k = 0; k < n; ++k) {
    const RobotState &p = at(k - 1), &q = at(k + 1), &c = at(k);
    CommandSample& s = series.samples[k];
    s.acceleration = Eigen::VectorXd::Zero(6 + dof);
    if (k == 0 || k == n - 1) {  // the robot is at rest
      s.state.base_velocity.setZero();
      s.state.base_angular_velocity.setZero();
      s.state.dtheta = Eigen::VectorXd::Zero(dof);
      continue;
    }
    s.state.base_velocity = (q.base.position - p.base.position) / (2 * dt);
    s.state.dtheta = (q.theta - p.theta) / (2 * dt);
    s.acceleration.head<3>() =
        (q.base.position - 2 * c.base.position + p.base.position) / (dt * dt);
    s.acceleration.tail(dof) = (q.theta - 2 * c.theta + p.theta) / (dt * dt);
    const Eigen::Vector3d back = log_rotation(c.base.attitude * p.base.attitude.conjugate());
    const Eigen::Vector3d front = log_rotation(q.base.attitude * c.base.attitude.conjugate());
    s.state.base_angular_velocity = (front + back) / (2 * dt);
    s.acceleration.segment<3>(3) = (front - back) / (dt * dt);
  }
  RobotData data(model);
  for (CommandSample& s : series.samples) {
    const Eigen::VectorXd force = inverse_dynamics(model, s.state, s.acceleration, data);
    s.cog = data.cog;
    s.dcog = data.dcog;
    s.ddcog = force.head<3>() / model.mass() - Eigen::Vector3d(0, 0, kGravity);
    s.fz = force[2];
    s.zmp = ground_reaction(s.state.base.position, force.head<6>(), ground).zmp;
  }
  series.joint_weight = {{0, model.joint_weight()}};
}

CommandSeries standing(const RobotModel& model, double duration, double dt) {
  CommandSeries series;
  series.dt = dt;
  CommandSample s;
  s.state = model.rest_state();
  RobotData data(model);
  update_positions(model, s.state, data);
  s.state.base.position.z() -= sole_pose(model, data, Side::left).translation().z();
  update_positions(model, s.state, data);
  for (Side side : {Side::left, Side::right})
    s.feet[static_cast<int>(side)] = sole_pose(model, data, side);
  series.samples.assign(static_cast<size_t>(std::lround(duration / dt)) + 1, s);
  complete_series(model, series);
  return series;
}

CommandSeries walk(const RobotModel& model, const WalkShape& w) {
  const CommandSample start = standing(model, 0, w.dt).samples[0];
  const FootPlan plan = plan_feet(model, w, start.feet);
  const int n = static_cast<int>(plan.support.size());
  CommandSeries series;
  series.dt = w.dt;
  series.samples.assign(n, start);
  const double height = start.cog.z();
  Eigen::MatrixXd target = plan.zmp;
  RobotData data(model);
  for (int round = 0; round < 4; ++round) {
    const Eigen::VectorXd x = solve_pendulum(target.col(0), height, w.dt);
    const Eigen::VectorXd y = solve_pendulum(target.col(1), height, w.dt);
    RobotState state = start.state;
    for (int k = 0; k < n; ++k) {
      CommandSample& s = series.samples[k];
      s.support = plan.support[k];
      s.feet = plan.feet[k];
      const Eigen::Vector3d goal(x[k], y[k], height);
      for (int i = 0; i < 30; ++i) {
        place_legs(model, plan.feet[k], state, data);
        const Eigen::Vector3d error = goal - data.cog;
        state.base.position += error;
        if (error.norm() < 1e-13) break;
      }
      s.state = state;
    }
    complete_series(model, series);
    for (int k = 0; k < n; ++k)
      target.row(k) += plan.zmp.row(k) - series.samples[k].zmp.head<2>().transpose();
  }
  return series;
}

}  // namespace ayumi::test
