#include "ayumi/identify/joint_loads.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/demand/ground_demand.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/motion/differentiate.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Cut-off frequency of the low pass of angles before they are differentiated twice [Hz]. Chosen: a
// small humanoid moves its joints at less than 10 Hz, and counts of 0.005 degrees then disturb the
// torque of a leg by less than 0.05 N m.
constexpr double kLoadCutoff = 50;

// Cut-off frequency of the low pass of the difference between a joint and its delayed command [Hz].
// Chosen: weight and friction change this difference more slowly, and the noise of an encoder
// beyond this frequency does not become a torque.
constexpr double kSagCutoff = 15;

// The load of a standing leg is not known well if its quick part exceeds this share of the largest
// load of the joint. Chosen: at a tenth, the delays of a simulated robot are wrong by 0.5 ms.
constexpr double kQuickShare = 0.05;

// Cut-off frequency of the low pass of load cells [Hz]. Chosen: the weight goes from foot to foot
// in 0.1 s or more.
constexpr double kShareCutoff = 15;

// Sum of the loads of both feet, as a part of its mean in the recording, below which no share is
// computed. Chosen: a tenth, which is far above noise.
constexpr double kLeastLoad = 0.1;

std::vector<CommandSample> samples_of(const MatrixXd& theta) {
  std::vector<CommandSample> samples(static_cast<size_t>(theta.rows()));
  for (Index k = 0; k < theta.rows(); ++k)
    samples[static_cast<size_t>(k)].state.theta = theta.row(k).transpose();
  return samples;
}

// The motion with this sole at the origin and level.
std::vector<CommandSample> anchored(const RobotModel& model, const MatrixXd& theta, double dt,
                                    Side side) {
  std::vector<CommandSample> samples = samples_of(theta);
  RobotData data(model);
  for (CommandSample& sample : samples)
    anchor_base(model, side, Eigen::Isometry3d::Identity(), sample.state, data);
  fill_rates(samples, dt, false);
  return samples;
}

// The part of the whole ground wrench that acts on the left foot: its share of the force, at its
// centre of pressure. The centres of pressure of both feet have the same offset from the centres of
// their soles.
Vector6d left_wrench(const RobotModel& model, const std::array<Eigen::Isometry3d, 2>& soles,
                     const SupportPlane& plane, const GroundDemand& use, double share,
                     const Vector3d& base, const Vector6d& whole) {
  std::array<Vector2d, 2> center;
  for (const Side side : {Side::left, Side::right}) {
    const Vector2d c = model.sole(side).center;
    const Vector3d point =
        plane.frame.inverse() * (soles[static_cast<size_t>(side)] * Vector3d(c.x(), c.y(), 0));
    center[static_cast<size_t>(side)] = point.head<2>();
  }
  const Vector2d pressure = use.zmp + (1 - share) * (center[0] - center[1]);
  const Vector3d at = plane.frame * Vector3d(pressure.x(), pressure.y(), 0);
  const Vector3d force = share * whole.head<3>();
  const Vector3d normal = plane.frame.linear().col(2);
  Vector6d wrench;
  wrench << force, (at - base).cross(force) + share * use.yaw_moment * normal;
  return wrench;
}

/// The left share at the rows of the angles, which begin `after` [s] before the loads.
VectorXd recorded_share(const SensorTable& sensors, double after, Index rows, double dt) {
  const Index count = sensors.foot_load.rows();
  if (count == 0) return {};
  const VectorXd left = low_pass(sensors.foot_load.col(0), sensors.dt, kShareCutoff),
                 right = low_pass(sensors.foot_load.col(1), sensors.dt, kShareCutoff);
  const double mean = (left + right).mean();
  if (!(mean > 0)) return {};
  VectorXd share(rows);
  for (Index k = 0; k < rows; ++k) {
    const Index at = std::clamp<Index>(std::lround((k * dt - after) / sensors.dt), 0, count - 1);
    const double sum = left[at] + right[at];
    share[k] = sum > kLeastLoad * mean ? std::clamp(left[at] / sum, 0.0, 1.0) : 0.5;
  }
  return share;
}

class LoadsOnFeet {
 public:
  LoadsOnFeet(const RobotModel& model, const MatrixXd& theta, double dt)
      : model_(model), data_(model) {
    anchored_ = {anchored(model, theta, dt, Side::left), anchored(model, theta, dt, Side::right)};
    RawMotion motion;
    motion.dt = dt;
    motion.theta = theta;
    supports_ = detect_supports(model, motion);
  }

  // The torques of row k. `share` is the load share of the left foot. If it is below 0, it is not
  // known; then the share that is used instead is written into it.
  VectorXd torque(size_t k, double& share) {
    const Support support = supports_[k];
    const bool right_carries =
        support == Support::right || (support == Support::both && share >= 0 && share < 0.5);
    const CommandSample& sample = anchored_[right_carries ? 1 : 0][k];
    const VectorXd force = inverse_dynamics(model_, sample.state, sample.acceleration, data_);
    VectorXd torque = force.tail(model_.dof_count());
    const Vector6d whole = force.head<6>();
    const std::array<Eigen::Isometry3d, 2> soles = {sole_pose(model_, data_, Side::left),
                                                    sole_pose(model_, data_, Side::right)};
    const Vector3d base = sample.state.base.position;
    const SupportPlane plane = support_plane(model_, support, soles);
    std::array<Vector6d, 2> feet = {Vector6d::Zero(), Vector6d::Zero()};
    if (!plane.empty()) {
      const GroundDemand use =
          ground_demand(plane, plane_wrench(plane, base, whole), contact_threshold(model_));
      if (support == Support::both && share >= 0 && use.has_zmp) {
        feet[0] = left_wrench(model_, soles, plane, use, share, base, whole);
        feet[1] = whole - feet[0];
      } else {
        feet = foot_wrenches(model_, support, soles, plane, use, base, whole);
      }
    }
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<size_t>(side);
      const Eigen::MatrixXd jacobian = body_jacobian(model_, data_, model_.sole(side).body, base);
      torque -= jacobian.rightCols(model_.dof_count()).transpose() * feet[s];
    }
    const double sum = feet[0][2] + feet[1][2];
    share = sum > 0 ? std::clamp(feet[0][2] / sum, 0.0, 1.0) : 0.5;
    return torque;
  }

  const CommandSample& sample(size_t k) const { return anchored_[0][k]; }
  Support support(size_t k) const { return supports_[k]; }

 private:
  const RobotModel& model_;
  RobotData data_;
  std::array<std::vector<CommandSample>, 2> anchored_;
  std::vector<Support> supports_;
};

// The motion of a joint that has a command: the command with the mean delay of the response, plus
// the smoothed difference of the response from it. In this way, two differentiations do not amplify
// the noise of an encoder much.
VectorXd smooth_motion(const RecordedMotion& motion, Index dof) {
  const AngleTable &measured = motion.measured, &command = motion.command;
  const VectorXd answer = measured.theta.col(dof);
  if (dof >= command.theta.cols() || !command.has[static_cast<size_t>(dof)])
    return low_pass(answer, measured.dt, kLoadCutoff);
  const Index last = command.theta.rows() - 1;
  const auto sent = [&](double late) {
    VectorXd angle(answer.size());
    for (Index k = 0; k < angle.size(); ++k) {
      const double at = std::clamp((measured.dt * static_cast<double>(k) - late) / command.dt, 0.0,
                                   static_cast<double>(last));
      const Index row = std::min(static_cast<Index>(at), std::max<Index>(0, last - 1));
      const double u = at - static_cast<double>(row);
      angle[k] =
          (1 - u) * command.theta(row, dof) + u * command.theta(std::min(row + 1, last), dof);
    }
    return angle;
  };
  const VectorXd now = sent(0);
  const VectorXd step = sent(-measured.dt) - sent(measured.dt);
  const double square = step.squaredNorm();
  VectorXd behind = now - answer;
  behind.array() -= behind.mean();
  const double lag = square > 0 ? 2 * measured.dt * behind.dot(step) / square : 0.0;
  const VectorXd late = sent(std::max(0.0, lag));
  return low_pass(late, measured.dt, kLoadCutoff) +
         low_pass(answer - late, measured.dt, kSagCutoff);
}

}  // namespace

VectorXd low_pass(const VectorXd& x, double dt, double cutoff) {
  const Index n = x.size();
  if (n < 3 || cutoff * dt >= 0.4) return x;
  const double w = elementary::tan(M_PI * cutoff * dt), root = std::sqrt(2.0) * w;
  const double scale = 1 / (1 + root + w * w);
  const double b = w * w * scale, a1 = 2 * (w * w - 1) * scale, a2 = (1 - root + w * w) * scale;
  // The signal is mirrored beyond its ends, so that the ends keep their value and their rate.
  const Index pad = std::min<Index>(n - 1, static_cast<Index>(std::ceil(1 / (cutoff * dt))));
  VectorXd y(n + 2 * pad);
  for (Index k = 0; k < pad; ++k) {
    y[k] = 2 * x[0] - x[pad - k];
    y[pad + n + k] = 2 * x[n - 1] - x[n - 2 - k];
  }
  y.segment(pad, n) = x;
  for (int pass = 0; pass < 2; ++pass) {
    double x1 = y[0], x2 = y[0], y1 = y[0], y2 = y[0];
    for (Index k = 0; k < y.size(); ++k) {
      const double in = y[k], out = b * (in + 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = in, y2 = y1, y1 = out;
      y[k] = out;
    }
    y.reverseInPlace();
  }
  return y.segment(pad, n);
}

JointLoads joint_loads(const RobotModel& model, const RecordedMotion& motion, RobotStand stand) {
  const AngleTable& measured = motion.measured;
  const Index rows = measured.theta.rows(), dofs = model.dof_count();
  const VectorXd home = model.posture();
  MatrixXd theta(rows, dofs);
  for (Index j = 0; j < dofs; ++j)
    theta.col(j) = measured.has[static_cast<size_t>(j)] ? smooth_motion(motion, j)
                                                        : VectorXd::Constant(rows, home[j]);
  JointLoads loads{MatrixXd(rows, dofs),
                   MatrixXd(rows, dofs),
                   MatrixXd(rows, dofs),
                   MatrixXd(rows, dofs),
                   {},
                   {}};
  RobotData data(model);
  MatrixXd mass;
  const auto add_row = [&](size_t k, const CommandSample& sample, const VectorXd& torque) {
    const auto row = static_cast<Index>(k);
    update_positions(model, sample.state, data);
    mass_matrix(model, data, mass);
    loads.torque.row(row) = torque.transpose();
    loads.inertia.row(row) = mass.diagonal().tail(dofs).transpose();
    loads.rate.row(row) = sample.state.dtheta.transpose();
    loads.acceleration.row(row) = sample.acceleration.tail(dofs).transpose();
  };
  if (stand == RobotStand::fixed) {
    std::vector<CommandSample> samples = samples_of(theta);
    fill_rates(samples, measured.dt, false);
    RobotData dynamics(model);
    for (size_t k = 0; k < samples.size(); ++k)
      add_row(
          k, samples[k],
          inverse_dynamics(model, samples[k].state, samples[k].acceleration, dynamics).tail(dofs));
    return loads;
  }
  LoadsOnFeet feet(model, theta, measured.dt);
  const VectorXd share =
      recorded_share(motion.sensors, first_row_after(measured, motion.sensors), rows, measured.dt);
  loads.left_share.resize(rows);
  double agreed = 0, single = 0;
  for (size_t k = 0; k < static_cast<size_t>(rows); ++k) {
    double& used = loads.left_share[static_cast<Index>(k)];
    used = share.size() > 0 ? share[static_cast<Index>(k)] : -1;
    const Support support = feet.support(k);
    if (used >= 0 && (support == Support::left || support == Support::right)) {
      agreed += support == Support::left ? used : 1 - used;
      ++single;
    }
    add_row(k, feet.sample(k), feet.torque(k, used));
    loads.support.push_back(support);
  }
  if (single > 0) loads.agreement = agreed / single;
  return loads;
}

std::vector<char> load_known(const RobotModel& model, const JointLoads& loads, int dof, double dt) {
  const VectorXd torque = loads.torque.col(dof);
  std::vector<char> known(static_cast<size_t>(torque.size()), 1);
  for (const Side side : {Side::left, Side::right}) {
    if (loads.support.empty()) break;
    const std::vector<int>& leg = model.leg(side);
    if (std::find(leg.begin(), leg.end(), dof) == leg.end()) continue;
    const VectorXd quick = torque - low_pass(torque, dt, kQuickLoad);
    const double bound = kQuickShare * torque.cwiseAbs().maxCoeff();
    const Support own = side == Side::left ? Support::left : Support::right;
    for (size_t k = 0; k < known.size(); ++k)
      known[k] = loads.support[k] != Support::both &&
                 (loads.support[k] != own || std::abs(quick[static_cast<Index>(k)]) < bound);
  }
  return known;
}

}  // namespace ayumi
