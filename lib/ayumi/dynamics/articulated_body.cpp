// Articulated bodies in world axes about the base origin, the base's velocity taken as zero
// (Galilean invariance). With S the joint screw, V twists and V x, V x* the spatial cross products:
//   outwards:  V = V_p + S dq,  c = V_p x S dq,  bias = V x* I V
//   inwards:   U = I S,  d = S.U,  u = tau - S.bias
//              I_p += I - U U'/d,  bias_p += bias + (I - U U'/d) c + U u/d
//   base:      I a = force - bias
//   outwards:  a' = a_p + c,  ddq = (u - U.a') / d,  a = a' + S ddq
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using Vector6d = ArticulatedBody::Vector;

// I of a rigid body about the base origin, and V x* (I V) from its linear and angular momentum.
void start_body(const Body& body, const Matrix3d& R, const Vector3d& com, ArticulatedBody& a) {
  const double m = body.inertia.mass;
  const Vector3d h = m * com;
  Matrix3d about_origin = R * body.inertia.about_com * R.transpose();
  about_origin.diagonal().array() += h.dot(com);
  about_origin -= h * com.transpose();
  Matrix3d cross;
  cross << 0, -h.z(), h.y(), h.z(), 0, -h.x(), -h.y(), h.x(), 0;
  a.inertia.topLeftCorner<3, 3>() = m * Matrix3d::Identity();
  a.inertia.bottomLeftCorner<3, 3>() = cross;
  a.inertia.topRightCorner<3, 3>() = -cross;
  a.inertia.bottomRightCorner<3, 3>() = about_origin;
  const Vector3d v = a.twist.head<3>(), w = a.twist.tail<3>();
  const Vector3d linear = m * v + w.cross(h);
  const Vector3d angular = about_origin * w + h.cross(v);
  a.bias << w.cross(linear), w.cross(angular) + v.cross(linear);
}

bool tied_by_mimics(const RobotModel& model) {
  return static_cast<int>(model.bodies().size()) != model.dof_count() + 1;
}

}  // namespace

void articulated_body_acceleration(const RobotModel& model, const RobotState& state,
                                   const VectorXd& force, RobotData& data, VectorXd& acceleration) {
  if (tied_by_mimics(model)) {
    acceleration = forward_dynamics(model, state, force, data);
    return;
  }
  update_velocities(model, state, data);
  const std::vector<Body>& bodies = model.bodies();
  data.articulated.resize(bodies.size());
  acceleration.resize(model.velocity_count());
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    ArticulatedBody& a = data.articulated[i];
    if (i == 0) {
      a.twist << Vector3d::Zero(), state.base_angular_velocity;
    } else {
      const ArticulatedBody& p = data.articulated[body.parent];
      const Vector3d s = body.ratio * data.axis[i];
      if (body.prismatic)
        a.screw << s, Vector3d::Zero();
      else
        a.screw << data.position[i].cross(s), s;
      const Vector6d rate = state.dtheta[body.dof] * a.screw;
      const Vector3d w = p.twist.tail<3>();
      a.drift << w.cross(rate.head<3>()) + p.twist.head<3>().cross(rate.tail<3>()),
          w.cross(rate.tail<3>());
      a.twist = p.twist + rate;
    }
    start_body(body, data.rotation[i], data.com[i], a);
  }
  for (size_t i = bodies.size() - 1; i > 0; --i) {
    ArticulatedBody& a = data.articulated[i];
    ArticulatedBody& p = data.articulated[bodies[i].parent];
    a.force.noalias() = a.inertia * a.screw;
    a.inverse = 1.0 / a.screw.dot(a.force);
    a.drive = force[6 + bodies[i].dof] - a.screw.dot(a.bias);
    p.inertia += a.inertia;
    p.inertia.noalias() -= a.force * (a.inverse * a.force).transpose();
    p.bias += a.bias + a.force * (a.inverse * (a.drive - a.force.dot(a.drift)));
    p.bias.noalias() += a.inertia * a.drift;
  }
  ArticulatedBody& root = data.articulated[0];
  root.acceleration = root.inertia.llt().solve(force.head<6>() - root.bias);
  for (size_t i = 1; i < bodies.size(); ++i) {
    ArticulatedBody& a = data.articulated[i];
    a.acceleration = data.articulated[bodies[i].parent].acceleration + a.drift;
    const double ddq = a.inverse * (a.drive - a.force.dot(a.acceleration));
    a.acceleration += ddq * a.screw;
    acceleration[6 + bodies[i].dof] = ddq;
  }
  acceleration.head<6>() = root.acceleration;
  acceleration[2] -= kGravity;
}

}  // namespace ayumi
