// The ground under the robot in MuJoCo: its pose, friction and motion, and the contact forces.
#include <algorithm>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_impl.hpp"

namespace ayumi {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Axes = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

namespace {

Vector3d velocity_at(const FloorPose& floor, const Vector3d& p) {
  return floor.velocity + floor.angular_velocity.cross(p - floor.pose.translation());
}

}  // namespace

void MujocoPlant::Impl::place_floor() {
  const int mocap = m->body_mocapid[floor_id];
  Eigen::Map<Vector3d>(d->mocap_pos + 3 * mocap) = ground.pose().translation();
  set_quaternion(d->mocap_quat + 4 * mocap, Quaterniond(ground.pose().linear()));
}

// MuJoCo uses the larger friction of two geoms. The geoms of the ground have none, so each ball or
// plate gets the friction of the ground at its place.
void MujocoPlant::Impl::set_friction() {
  const Eigen::Isometry3d to_ground = ground.pose().inverse();
  for (int g = 0; g < m->ngeom; ++g) {
    if (point_of[static_cast<size_t>(g)] == -1) continue;
    const ContactPoint* point = nullptr;
    if (point_of[static_cast<size_t>(g)] >= 0) point = &points[static_cast<size_t>(point_of[g])];
    const Vector3d place =
        point ? data.base_position +
                    (data.position[point->body] + data.rotation[point->body] * point->position)
              : Vector3d(Eigen::Map<const Vector3d>(d->geom_xpos + 3 * g));
    m->geom_friction[3 * g] = ground.friction(to_ground * place);
  }
}

const ContactPoint* MujocoPlant::Impl::point_of_contact(const mjContact& contact) const {
  const int first = point_of[static_cast<size_t>(contact.geom1)],
            second = point_of[static_cast<size_t>(contact.geom2)],
            number = second != -1 ? second : first;
  if (number >= 0) return &points[static_cast<size_t>(number)];
  // A plate is the whole sole of a foot, whose points are equally stiff.
  const auto found = std::find_if(points.begin(), points.end(), [&](const ContactPoint& point) {
    return point.side == -2 - number;
  });
  return found != points.end() ? &*found : nullptr;
}

// Soles whose stiffness the robot's file states are as soft in MuJoCo; other contacts have MuJoCo's
// own stiffness. The normal force of a contact with the stiffness k and the damping time T at the
// end of a step of h is -k (gap + h v) - k T v, with v = v0 + h a. So it is
//   -(a + v0/h + gap/(h (h + T))) / R  with R = 1/(h k (h + T)), as in the plant of Ayumi.
// MuJoCo computes -(a - aref) / R for each row of a contact. Along the ground, the contacts keep
// MuJoCo's own small R, because soles that yield along the ground creep. The cone of friction in
// MuJoCo's scaled forces has the slope mu = friction sqrt(R along the ground / R of the normal).
void MujocoPlant::Impl::soften_contacts(double h) {
  if (!soft_side[0] && !soft_side[1]) return;
  for (int i = 0; i < d->ncon; ++i) {
    mjContact& contact = d->contact[i];
    const int row = contact.efc_address;
    if (row < 0) continue;
    const ContactPoint* const point = point_of_contact(contact);
    if (!point || point->side < 0 || !soft_side[static_cast<size_t>(point->side)]) continue;
    const double time = h + point->damping_time;
    d->efc_R[row] = 1 / (h * point->stiffness * time);
    d->efc_D[row] = 1 / d->efc_R[row];
    d->efc_KBIP[4 * row + 1] = 1 / h;
    d->efc_aref[row] = -(d->efc_vel[row] + (d->efc_pos[row] - d->efc_margin[row]) / time) / h;
    if (contact.dim > 1)
      contact.mu = std::max<mjtNum>(
          mjMINMU, contact.friction[0] * std::sqrt(d->efc_R[row + 1] / d->efc_R[row]));
  }
}

// MuJoCo gives no velocity to a body that its user moves. The motion of the ground is therefore
// added to the reference acceleration of each contact row: a = -b (v - v_ground) + a_ground.
void MujocoPlant::Impl::move_ground(double dt) {
  FloorPose now = floor;
  now.pose = ground.pose();
  now.velocity = ground.velocity(now.pose.translation());
  now.angular_velocity = ground.angular_velocity();
  const bool rising = std::any_of(rates.begin(), rates.end(), [](double r) { return r != 0; });
  const bool moves = now.velocity.norm() + now.angular_velocity.norm() + floor.velocity.norm() +
                         floor.angular_velocity.norm() >
                     0;
  for (int i = 0; (moves || rising) && i < d->ncon; ++i) {
    const mjContact& contact = d->contact[i];
    if (contact.efc_address < 0) continue;
    const bool second = point_of[static_cast<size_t>(contact.geom2)] != -1;
    const Vector3d at = Eigen::Map<const Vector3d>(contact.pos);
    Vector3d v = velocity_at(now, at);
    const Vector3d a = (v - velocity_at(floor, at)) / dt;
    if (rising)
      v += rates[static_cast<size_t>(second ? contact.geom1 : contact.geom2)] * ground.normal();
    const Vector3d aim = Axes(contact.frame) * ((second ? 1.0 : -1.0) * v);
    const Vector3d rate = Axes(contact.frame) * ((second ? 1.0 : -1.0) * a);
    for (int k = 0; k < contact.dim; ++k) {
      const int row = contact.efc_address + k;
      d->efc_aref[row] += d->efc_KBIP[4 * row + 1] * aim[k] + rate[k];
    }
  }
  floor = now;
}

void MujocoPlant::Impl::report_contacts() {
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& contact = d->contact[i];
    const bool second = point_of[static_cast<size_t>(contact.geom2)] != -1;
    report_contact(i, contact, second ? contact.geom2 : contact.geom1, second ? 1 : -1);
  }
}

// A contact's force acts on its second geom.
void MujocoPlant::Impl::report_contact(int i, const mjContact& contact, int geom, double sign) {
  mjtNum numbers[6];
  mj_contactForce(m.get(), d.get(), i, numbers);
  const Vector3d force =
      sign * (Axes(contact.frame).transpose() * Eigen::Map<const Vector3d>(numbers));
  const Vector3d at = Eigen::Map<const Vector3d>(contact.pos);
  const int index = point_of[static_cast<size_t>(geom)];
  if (index < -1) {
    share_among_cells(-2 - index, at, force);
    return;
  }
  if (index < 0) return;
  const ContactPoint& point = points[static_cast<size_t>(index)];
  if (point.side < 0) {
    if (numbers[0] > 0 && !report.body_contact) {
      report.body_contact = true;
      report.touching_body = point.body;
    }
    return;
  }
  SoleForce& cell = report.soles[point.side][static_cast<size_t>(point.vertex)];
  cell.position = at;
  cell.force += force;
  cell.gap = contact.dist;
  report.max_penetration = std::max(report.max_penetration, -contact.dist);
}

void MujocoPlant::Impl::share_among_cells(int side, const Vector3d& at, const Vector3d& force) {
  const Sole& sole = model->sole(static_cast<Side>(side));
  const Eigen::Isometry3d pose = sole_pose(*model, data, static_cast<Side>(side));
  corner_weights(sole.polygon, (pose.inverse() * at).head<2>(), weights);
  for (size_t i = 0; i < weights.size(); ++i) {
    SoleForce& cell = report.soles[side][i];
    cell.position = pose * Vector3d(sole.polygon[i].x(), sole.polygon[i].y(), 0);
    cell.force += weights[i] * force;
  }
}

}  // namespace ayumi
