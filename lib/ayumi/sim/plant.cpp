// One step of length h from (q, v), all rates at its end (implicit in servo and contact springs):
//   (M + rotor + h(kd + b) + h^2 kp) v+ = (M + rotor) v + h (kp (target - theta) - bias + ext) + J'
//   l q+ = q moved by h v+
// Contact point i with stiffness k, damping time T, gap g and tangential deflection d:
//   u_n = J_n v+ + g/(h + T) + R l_n,   u_t = J_t v+ + d/(h + T) + R l_t,   R = 1/(h k (h + T)),
// which is the implicit spring l/h = -k (g + h v) - k T v solved for the velocity (for g > 0 the
// damping is left out, so that the point just arrives). u and l obey solve_contacts(). A joint
// whose servo would pass its torque limit is given exactly the limit and the step is solved again.
#include "ayumi/sim/plant.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kStaticSink = 1e-7;      // of a body on four of its points [m]
constexpr double kDampingTime = 0.004;    // contact damping / stiffness of bodies [s]
constexpr double kStickRate = 1e-3;       // joint rate below which dry friction holds [rad/s]
constexpr double kLargest = 1e6;          // number that is taken for one [SI]
constexpr double kLimitStiffness = 20.0;  // of a joint's end stop, in servo stiffnesses

/// Points of a body that may touch the ground besides the soles.
std::vector<std::pair<Vector3d, double>> touch_points(const PlacedShape& placed) {
  std::vector<std::pair<Vector3d, double>> points;
  auto add = [&](const Vector3d& p, double radius) { points.push_back({placed.pose * p, radius}); };
  auto add_box = [&](const Vector3d& low, const Vector3d& high) {
    for (int k = 0; k < 8; ++k)
      add({k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()}, 0);
  };
  if (const auto* box = std::get_if<Box>(&placed.shape)) {
    add_box(-0.5 * box->size, 0.5 * box->size);
  } else if (const auto* sphere = std::get_if<Sphere>(&placed.shape)) {
    add(Vector3d::Zero(), sphere->radius);
  } else if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
    for (double s : {-0.5, 0.5}) add({0, 0, s * capsule->length}, capsule->radius);
  } else if (const auto* cylinder = std::get_if<Cylinder>(&placed.shape)) {
    for (int k = 0; k < 16; ++k) {
      const double a = 0.25 * M_PI * (k / 2);
      const double z = (k % 2 - 0.5) * cylinder->length;
      add({cylinder->radius * std::cos(a), cylinder->radius * std::sin(a), z}, 0);
    }
  } else if (const auto* mesh = std::get_if<MeshShape>(&placed.shape)) {
    Vector3d low = Vector3d::Constant(1e30), high = -low;
    for (const MeshPart& part : mesh->mesh.parts)
      for (const Eigen::Vector3f& v : part.vertices) {
        low = low.cwiseMin(v.cast<double>());
        high = high.cwiseMax(v.cast<double>());
      }
    if (low.x() <= high.x()) add_box(low, high);
  }
  return points;
}

/// Largest magnitude; NaN when any entry is.
template <typename Vector>
double largest(const Vector& v) {
  double result = 0;
  for (Eigen::Index i = 0; i < v.size() && !std::isnan(result); ++i)
    if (!(std::abs(v[i]) <= result)) result = std::abs(v[i]);
  return result;
}

}  // namespace

Plant::Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world)
    : model_(&model), limits_(limits), world_(world), data_(model) {
  const int n = model.dof_count();
  kp_.resize(n);
  kd_.resize(n);
  rotor_.resize(n);
  viscous_.resize(n);
  coulomb_.resize(n);
  for (int j = 0; j < n; ++j) {
    const ServoDescription& servo = model.dofs()[j].servo;
    if (servo.kp <= 0)
      fail(ErrorCode::bad_model, model.name() + ": joint " + model.dofs()[j].name +
                                     " has no servo (kp); give it one in the sidecar");
    kp_[j] = servo.kp;
    kd_[j] = servo.kd;
    rotor_[j] = servo.rotor_inertia;
    viscous_[j] = servo.viscous;
    coulomb_[j] = servo.coulomb;
  }
  const Vector3d normal =
      exp_rotation({world.slope.x(), world.slope.y(), 0}).toRotationMatrix().col(2);
  const Vector3d tangent = (Vector3d::UnitX() - normal.x() * normal).normalized();
  ground_ << normal, tangent, normal.cross(tangent);

  const double body_stiffness = model.mass() * kGravity / kStaticSink;
  for (Side side : {Side::left, Side::right}) {
    if (!model.has_soles()) break;
    const Sole& sole = model.sole(side);
    const double count = static_cast<double>(sole.polygon.size());
    for (size_t i = 0; i < sole.polygon.size(); ++i) {
      const Vector2d& p = sole.polygon[i];
      ContactPoint point;
      point.body = sole.body;
      point.position = sole.frame * Vector3d(p.x(), p.y(), 0);
      point.stiffness = sole.stiffness / count;
      point.damping_time = sole.damping_time;
      point.side = static_cast<int>(side);
      point.vertex = static_cast<int>(i);
      points_.push_back(point);
    }
  }
  for (const Link& link : model.links()) {
    const bool foot = model.has_soles() && (link.body == model.sole(Side::left).body ||
                                            link.body == model.sole(Side::right).body);
    for (const PlacedShape& shape : link.collisions) {
      if (foot) continue;
      for (const auto& [position, radius] : touch_points(shape)) {
        ContactPoint point;
        point.body = link.body;
        point.position = link.pose * position;
        point.radius = radius;
        point.stiffness = 0.25 * body_stiffness;
        point.damping_time = kDampingTime;
        points_.push_back(point);
      }
    }
  }
  set_state(model.rest_state());
}

void Plant::set_state(const RobotState& state) {
  const std::string& name = model_->name();
  auto check = [&](const char* what, double largest) {
    if (!(largest < kLargest))
      fail(ErrorCode::usage, name + ": " + what + " of the plant's state is " +
                                 text::brief(largest) + "; numbers below 1e6 are expected");
  };
  if (state.theta.size() != model_->dof_count() || state.dtheta.size() != model_->dof_count())
    fail(ErrorCode::usage,
         name + ": the plant's state needs " + std::to_string(model_->dof_count()) + " joints");
  check("base position", largest(state.base.position));
  check("base attitude", largest(state.base.attitude.coeffs()));
  check("base velocity", largest(state.base_velocity));
  check("base angular velocity", largest(state.base_angular_velocity));
  check("a joint position", largest(state.theta));
  check("a joint rate", largest(state.dtheta));
  time_ = 0;
  state_ = state;
  for (ContactPoint& point : points_) {
    point.impulse.setZero();
    point.deflection.setZero();
    point.touching = false;
  }
}

void Plant::check_input(const VectorXd& targets, const std::vector<ExternalWrench>& wrenches,
                        double dt) const {
  auto complain = [&](const std::string& what) {
    fail(ErrorCode::usage, model_->name() + ": " + what + ", " + text::fixed(time_, 3) +
                               " s after the plant's start");
  };
  if (!(dt > 0 && dt < 1)) complain("step length " + text::brief(dt) + " s is not within 0..1 s");
  if (targets.size() != model_->dof_count())
    complain(std::to_string(targets.size()) + " servo targets for " +
             std::to_string(model_->dof_count()) + " joints");
  for (int j = 0; j < model_->dof_count(); ++j)
    if (!(std::abs(targets[j]) < kLargest))
      complain("servo target of " + model_->dofs()[j].name + " is " + text::brief(targets[j]));
  for (const ExternalWrench& w : wrenches)
    if (!(largest(w.force) < kLargest && largest(w.torque) < kLargest &&
          largest(w.point) < kLargest))
      complain("an external force is not a finite number below 1e6");
}

// A motor cannot push a joint beyond its speed limit: driving torque fades over the last tenth.
double Plant::torque_limit(int dof, double rate, double direction) const {
  const double peak = limits_.peak_torque[dof];
  const double speed = limits_.speed[dof];
  if (rate * direction <= speed || !std::isfinite(speed)) return peak;
  return peak * std::clamp(11.0 - 10.0 * rate * direction / speed, 0.0, 1.0);
}

void Plant::collect_contacts(double dt) {
  active_.clear();
  const Vector3d normal = ground_.col(0);
  for (size_t i = 0; i < points_.size(); ++i) {
    ContactPoint& point = points_[i];
    const Vector3d offset =
        data_.position[point.body] + data_.rotation[point.body] * point.position;
    const Vector3d position = data_.base_position + offset - point.radius * normal;
    const double gap = normal.dot(position);
    const double speed = normal.dot(point_velocity(data_, point.body, position));
    // Gravity and servos can change the approach within the step: keep what may arrive in three.
    if (gap + 3 * dt * std::min(speed, 0.0) > 1e-3) {
      point.impulse.setZero();
      point.deflection.setZero();
      point.touching = false;
      continue;
    }
    active_.push_back({static_cast<int>(i), gap, position});
  }
}

// Fills M_ (with rotors), the momentum and bias terms, contact Jacobians and the fixed part of b.
void Plant::assemble(const std::vector<ExternalWrench>& wrenches, double dt) {
  bias_ = bias_force(*model_, state_, data_);
  mass_matrix(*model_, data_, M_);
  M_.diagonal().tail(model_->dof_count()) += rotor_;
  momentum_ = M_ * state_.velocity() - dt * bias_;
  external_.linear = {0, 0, -dt * model_->mass() * kGravity};
  external_.angular.setZero();
  for (const ExternalWrench& w : wrenches) {
    const int body = w.body < 0 ? model_->trunk_body() : w.body;
    const Vector3d point = w.body < 0 ? data_.cog : w.point;
    const Eigen::MatrixXd J = body_jacobian(*model_, data_, body, point);
    momentum_ +=
        dt * (J.topRows<3>().transpose() * w.force + J.bottomRows<3>().transpose() * w.torque);
    external_.linear += dt * w.force;
    external_.angular += dt * (w.torque + (point - data_.cog).cross(w.force));
  }
  collect_contacts(dt);
  const int n = static_cast<int>(active_.size());
  J_.resize(3 * n, model_->velocity_count());
  problem_.friction.assign(static_cast<size_t>(n), world_.friction);
  int last_body = -1;
  Eigen::MatrixXd body_rows;
  for (int i = 0; i < n; ++i) {
    const ContactPoint& point = points_[active_[i].point];
    const Vector3d origin = data_.base_position + data_.position[point.body];
    if (point.body != last_body) body_rows = body_jacobian(*model_, data_, point.body, origin);
    last_body = point.body;
    const Vector3d r = active_[i].position - origin;
    J_.middleRows<3>(3 * i) =
        ground_.transpose() * (body_rows.topRows<3>() - skew(r) * body_rows.bottomRows<3>());
  }
}

StepReport Plant::step(const VectorXd& targets, const std::vector<ExternalWrench>& wrenches,
                       double dt) {
  check_input(targets, wrenches, dt);
  assemble(wrenches, dt);
  Momentum momentum = centroidal_momentum(*model_, data_);
  const int n = model_->dof_count();
  const int contacts = static_cast<int>(active_.size());
  VectorXd compliance(3 * contacts), shift(3 * contacts), impulse(3 * contacts);
  for (int i = 0; i < contacts; ++i) {
    const ContactPoint& point = points_[active_[i].point];
    const double gap = active_[i].gap;
    const double time = dt + point.damping_time;
    compliance.segment<3>(3 * i).setConstant(1.0 / (dt * point.stiffness * time));
    shift.segment<3>(3 * i) << (gap > 0 ? gap / dt : gap / time), point.deflection / time;
    impulse.segment<3>(3 * i) = point.impulse;
  }

  // fixed[j]: the torque of a joint that no longer follows its servo law in this step.
  std::vector<bool> saturated(n, false), sliding(n, false);
  VectorXd fixed = VectorXd::Zero(n), dry = VectorXd::Zero(n), torque(n), velocity;
  StepReport report;
  for (int pass = 0; pass <= 2 * n; ++pass) {
    Eigen::MatrixXd system = M_;
    VectorXd right = momentum_;
    for (int j = 0; j < n; ++j) {
      const double theta = state_.theta[j];
      double& diagonal = system(6 + j, 6 + j);
      double& force = right[6 + j];
      diagonal += dt * viscous_[j];
      if (saturated[j]) {
        force += dt * fixed[j];
      } else {
        diagonal += dt * kd_[j] + dt * dt * kp_[j];
        force += dt * kp_[j] * (targets[j] - theta);
      }
      if (coulomb_[j] > 0) {
        if (sliding[j])
          force += dt * dry[j];
        else
          diagonal += dt * coulomb_[j] / kStickRate;
      }
      const Dof& dof = model_->dofs()[j];
      if (dof.limited && (theta < dof.lower || theta > dof.upper)) {
        const double stop = kLimitStiffness * kp_[j];
        diagonal += dt * dt * stop + dt * kLimitStiffness * kd_[j];
        force += dt * stop * (std::clamp(theta, dof.lower, dof.upper) - theta);
      }
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(system);
    velocity = factor.solve(right);
    if (contacts > 0) {
      MinvJt_ = factor.solve(J_.transpose());
      problem_.A.noalias() = J_ * MinvJt_;
      problem_.A.diagonal() += compliance;
      problem_.b = J_ * velocity + shift;
      const ContactSolution solution = solve_contacts(problem_, impulse);
      report.contact_iterations = solution.iterations;
      report.contact_residual = solution.residual;
      velocity += MinvJt_ * impulse;
    }
    bool changed = false;
    for (int j = 0; j < n; ++j) {
      const double rate = velocity[6 + j];
      if (!saturated[j]) {
        torque[j] = kp_[j] * (targets[j] - state_.theta[j] - dt * rate) - kd_[j] * rate;
        const double limit = torque_limit(j, rate, torque[j] > 0 ? 1.0 : -1.0);
        if (std::abs(torque[j]) > limit) {
          saturated[j] = changed = true;
          fixed[j] = torque[j] = std::copysign(limit, torque[j]);
        }
      }
      if (coulomb_[j] > 0 && !sliding[j] && std::abs(rate) > kStickRate) {
        sliding[j] = changed = true;
        dry[j] = -std::copysign(coulomb_[j], rate);
      }
    }
    if (!changed) break;
  }

  report.torque = torque;
  for (int j = 0; j < n; ++j)
    if (saturated[j]) report.saturated.push_back(j);
  for (int side = 0; side < 2 && model_->has_soles(); ++side)
    report.soles[side].resize(model_->sole(static_cast<Side>(side)).polygon.size());
  for (ContactPoint& point : points_) point.touching = false;
  for (int i = 0; i < contacts; ++i) {
    ContactPoint& point = points_[active_[i].point];
    const Vector3d l = impulse.segment<3>(3 * i);
    const Vector3d force = ground_ * l;
    external_.linear += force;
    external_.angular += (active_[i].position - data_.cog).cross(force);
    const Vector2d slip = J_.middleRows<2>(3 * i + 1) * velocity;
    point.impulse = l;
    point.touching = l[0] > 0;
    point.deflection =
        point.touching ? Vector2d(-l.tail<2>() / (dt * point.stiffness) - point.damping_time * slip)
                       : Vector2d(Vector2d::Zero());
    if (point.side >= 0) {
      SoleForce& sole = report.soles[point.side][point.vertex];
      sole.position = active_[i].position;
      sole.force = force / dt;
      sole.gap = active_[i].gap;
      report.max_penetration = std::max(report.max_penetration, -active_[i].gap);
    } else if (point.touching) {
      report.body_contact = true;
    }
  }
  momentum.linear += external_.linear;
  momentum.angular += external_.angular;
  if (!velocity.allFinite())
    fail(ErrorCode::internal, model_->name() + ": the plant left the finite numbers " +
                                  text::fixed(time_, 3) + " s after its start");
  advance(velocity, momentum, dt);
  time_ += dt;
  return report;
}

// Joints move with their solved rates. The base then takes the velocity that gives the robot, in
// its new posture, exactly the momentum the outside has left it: M(q) v changes along the step, and
// this is what keeps momentum to rounding in flight and ground forces equal to its rate in contact.
void Plant::advance(const VectorXd& velocity, const Momentum& momentum, double dt) {
  const Vector3d cog = data_.cog;
  state_.dtheta = velocity.tail(model_->dof_count());
  state_.theta += dt * state_.dtheta;
  state_.base.attitude =
      (exp_rotation(dt * velocity.segment<3>(3)) * state_.base.attitude).normalized();
  state_.base_velocity.setZero();
  state_.base_angular_velocity.setZero();
  update_velocities(*model_, state_, data_);
  const Momentum joints = centroidal_momentum(*model_, data_);
  const Vector3d cog_velocity = momentum.linear / model_->mass();
  const Vector3d w = locked_inertia(*model_, data_).llt().solve(momentum.angular - joints.angular);
  state_.base_angular_velocity = w;
  state_.base_velocity = cog_velocity - joints.linear / model_->mass() - w.cross(data_.cog_offset);
  state_.base.position = cog + dt * cog_velocity - data_.cog_offset;
}

}  // namespace ayumi
