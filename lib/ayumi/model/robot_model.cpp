// Links joined by fixed joints become one body. With T_BK the pose of link K in its body B, a
// moving joint at T_KJ in link K starts a new body whose placement is T_BK T_KJ. Inertias are moved
// to the body frame and added about the common centre of mass:
//   c = sum m_k c_k / m,   I = sum R_k I_k R_k' + m_k (|d_k|^2 1 - d_k d_k'),   d_k = c_k - c.

#include "ayumi/model/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/servo_bounds.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

bool ActuatorLimits::lacks_motor(int dof) const {
  const auto at = static_cast<size_t>(dof);
  return has_servo[at] && servo[at].kp <= 0 &&
         std::any_of(servo.begin(), servo.end(),
                     [](const ServoDescription& other) { return other.kp > 0; });
}

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Largest number of names of links or postures in one message. Chosen: a person still reads a
/// message of this length.
constexpr size_t kMostNamed = 20;

/// Depth by which a sole without a stated stiffness sinks under the whole weight [m]. Chosen: stiff
/// rubber; the sidecar states the measured stiffness.
constexpr double kSoleSink = 0.0001;
/// Ratio of damping to stiffness of a sole without a stated one [s]. Chosen: four steps of 1 ms, so
/// that a foot does not bounce.
constexpr double kSoleDampingTime = 0.004;

Inertia moved(const Inertia& inertia, const Eigen::Isometry3d& pose) {
  const Eigen::Matrix3d turn = pose.linear();
  return {inertia.mass, pose * inertia.com, turn * inertia.about_com * turn.transpose()};
}

Eigen::Matrix3d point_inertia(double mass, const Eigen::Vector3d& offset) {
  return mass * (offset.squaredNorm() * Eigen::Matrix3d::Identity() - offset * offset.transpose());
}

Inertia sum(const Inertia& a, const Inertia& b) {
  if (a.mass == 0 && b.mass == 0) return {0, a.com, a.about_com + b.about_com};
  Inertia total;
  total.mass = a.mass + b.mass;
  total.com = (a.mass * a.com + b.mass * b.com) / total.mass;
  total.about_com = a.about_com + b.about_com + point_inertia(a.mass, a.com - total.com) +
                    point_inertia(b.mass, b.com - total.com);
  return total;
}

Eigen::Vector2d centroid(const std::vector<Eigen::Vector2d>& polygon) {
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  double area = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d a = polygon[i] - polygon[0];
    const Eigen::Vector2d b = polygon[(i + 1) % polygon.size()] - polygon[0];
    const double cross = a.x() * b.y() - a.y() * b.x();
    area += cross;
    moment += cross * (a + b) / 3;
  }
  return polygon[0] + moment / area;
}

// Builds bodies and links from the root outwards.
class TreeBuilder {
 public:
  TreeBuilder(const RobotDescription& robot, const std::vector<int>& dof_joints)
      : robot_(robot), dof_joints_(dof_joints) {}

  void build(int root_link, std::vector<Body>& bodies, std::vector<Link>& links) {
    bodies_ = &bodies;
    links_ = &links;
    if (const JointDescription* joint = floating_root(root_link)) {
      // The frame in which the robot floats becomes a link in its place according to the URDF.
      const LinkDescription& frame = robot_.links[root_link];
      links.push_back({frame.name, 0, joint->origin.inverse(), {}, {}, {}});
      root_link = link_index(joint->child);
    }
    Body root;
    root.name = robot_.links[root_link].name;
    bodies.push_back(root);
    add_link(root_link, 0, Eigen::Isometry3d::Identity());
  }

 private:
  int link_index(const std::string& name) const {
    for (size_t i = 0; i < robot_.links.size(); ++i)
      if (robot_.links[i].name == name) return static_cast<int>(i);
    return -1;
  }

  const JointDescription& joint(const std::string& name) const {
    return *std::find_if(robot_.joints.begin(), robot_.joints.end(),
                         [&](const JointDescription& other) { return other.name == name; });
  }

  /// The joint that makes the robot float: the only joint of a root link without mass and shape.
  const JointDescription* floating_root(int root_link) const {
    const LinkDescription& link = robot_.links[root_link];
    const JointDescription* only = nullptr;
    for (const JointDescription& each : robot_.joints) {
      if (each.parent != link.name) continue;
      if (only || each.type != JointType::floating) return nullptr;
      only = &each;
    }
    return link.inertia.mass > 0 || !link.visuals.empty() || !link.collisions.empty() ? nullptr
                                                                                      : only;
  }

  void add_link(int index, int body, const Eigen::Isometry3d& pose) {
    const LinkDescription& link = robot_.links[index];
    links_->push_back({link.name, body, pose, link.inertia, link.visuals, link.collisions});
    Body& carrier = (*bodies_)[body];
    carrier.inertia = sum(carrier.inertia, moved(link.inertia, pose));
    for (const JointDescription& each : robot_.joints) {
      if (each.parent != link.name) continue;
      const int child = link_index(each.child);
      if (each.type == JointType::floating)
        complain_urdf(
            robot_, "joint " + each.name,
            "a floating joint may only carry the whole robot; its parent "
            "must be the root link, and the root link must have no mass, no shape and no other "
            "joint");
      if (each.type == JointType::fixed)
        add_link(child, body, pose * each.origin);
      else
        add_link(child, add_body(each, body, pose), Eigen::Isometry3d::Identity());
    }
  }

  int add_body(const JointDescription& moving, int parent, const Eigen::Isometry3d& pose) {
    Body body;
    body.name = moving.child;
    body.parent = parent;
    body.prismatic = moving.type == JointType::prismatic;
    body.axis = moving.axis.normalized();
    body.placement = pose * moving.origin;
    const JointDescription* driver = &moving;
    while (!driver->mimic.empty()) {
      body.offset += body.ratio * driver->mimic_offset;
      body.ratio *= driver->mimic_multiplier;
      driver = &joint(driver->mimic);
    }
    for (size_t dof = 0; dof < dof_joints_.size(); ++dof)
      if (&robot_.joints[dof_joints_[dof]] == driver) body.dof = static_cast<int>(dof);
    bodies_->push_back(body);
    return static_cast<int>(bodies_->size()) - 1;
  }

  const RobotDescription& robot_;
  const std::vector<int>& dof_joints_;
  std::vector<Body>* bodies_ = nullptr;
  std::vector<Link>* links_ = nullptr;
};

// A body that moves needs mass. The exception is a frame between two axes of one joint: it has no
// shape and carries a body with mass.
void require_masses(const RobotDescription& robot, const std::vector<Body>& bodies,
                    const std::vector<Link>& links) {
  std::vector<double> beyond(bodies.size(), 0);
  for (size_t i = bodies.size() - 1; i > 0; --i)
    beyond[bodies[i].parent] += beyond[i] + bodies[i].inertia.mass;
  std::vector<std::string> massless;
  for (size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].inertia.mass > 0) continue;
    const bool shaped = std::any_of(links.begin(), links.end(), [&](const Link& link) {
      return link.body == static_cast<int>(i) &&
             (!link.visuals.empty() || !link.collisions.empty());
    });
    if (i == 0 || shaped || beyond[i] == 0) massless.push_back(bodies[i].name);
  }
  if (massless.empty()) return;
  const std::string first = massless[0];
  const auto description =
      std::find_if(robot.links.begin(), robot.links.end(),
                   [&](const LinkDescription& link) { return link.name == first; });
  massless.erase(massless.begin());
  complain_urdf(
      robot, "link " + first,
      std::string(description->has_inertial ? "the mass of this link is 0"
                                            : "this link has no <inertial>") +
          (first == bodies[0].name ? " although it is the root of a robot that moves"
                                   : " although a joint moves this link") +
          "; give the link a mass and an inertia" +
          (massless.empty() ? ""
                            : ", and also the links " + text::join_first(massless, kMostNamed)));
}

double value_or(const std::map<std::string, double>& map, const std::string& key, double other) {
  const auto found = map.find(key);
  return found == map.end() ? other : found->second;
}

const ServoDescription* find_servo(const RobotDescription& robot, const ActuatorProfile& profile,
                                   const std::string& joint) {
  if (const auto own = profile.servos.find(joint); own != profile.servos.end()) return &own->second;
  const auto servo = robot.servos.find(joint);
  return servo != robot.servos.end() ? &servo->second : nullptr;
}

ActuatorLimits limits_of(const ActuatorProfile& profile, const std::vector<Dof>& dofs,
                         const RobotDescription& robot, const std::vector<int>& dof_joints) {
  ActuatorLimits limits;
  limits.name = profile.name;
  limits.thermal_window = profile.thermal_window;
  const int n = static_cast<int>(dofs.size());
  limits.speed = limits.peak_torque = limits.continuous_torque =
      Eigen::VectorXd::Constant(n, kInfinity);
  for (int i = 0; i < n; ++i) {
    const JointDescription& joint = robot.joints[dof_joints[i]];
    const double speed = joint.velocity > 0 ? joint.velocity : kInfinity;
    const double effort = joint.effort > 0 ? joint.effort : kInfinity;
    limits.speed[i] = value_or(profile.speed, dofs[i].name, speed);
    limits.peak_torque[i] = value_or(profile.peak_torque, dofs[i].name, effort);
    limits.continuous_torque[i] = value_or(profile.continuous_torque, dofs[i].name, kInfinity);
    const ServoDescription* servo = find_servo(robot, profile, dofs[i].name);
    limits.servo.push_back(servo ? *servo : ServoDescription{});
    limits.has_servo.push_back(servo != nullptr);
  }
  return limits;
}

Dof dof_of(const JointDescription& joint, const RobotDescription& robot) {
  Dof dof;
  dof.name = joint.name;
  dof.prismatic = joint.type == JointType::prismatic;
  dof.limited = joint.has_limits && joint.type != JointType::continuous;
  dof.lower = dof.limited ? joint.lower : -kInfinity;
  dof.upper = dof.limited ? joint.upper : kInfinity;
  const auto encoder = robot.encoders.find(joint.name);
  if (encoder != robot.encoders.end()) dof.encoder = encoder->second;
  return dof;
}

void validate_postures(const RobotDescription& robot, const std::vector<Dof>& dofs) {
  for (const auto& [name, values] : robot.postures)
    for (const Dof& dof : dofs) {
      const auto given = values.find(dof.name);
      if (given == values.end()) continue;
      const double value = given->second;
      if (value >= dof.lower - 1e-9 && value <= dof.upper + 1e-9) continue;
      const bool low = value < dof.lower;
      const double unit = dof.prismatic ? 1 : EIGEN_PI / 180;
      const std::string unit_name = dof.prismatic ? " m" : " deg";
      complain_posture(robot, name, dof.name,
                       "the joint '" + dof.name + "' is at " + text::brief(value / unit) +
                           unit_name + (low ? ", below its limit of " : ", above its limit of ") +
                           text::brief((low ? dof.lower : dof.upper) / unit) + unit_name);
    }
}

// The posture that is nearest to zero within the limits.
std::map<std::string, double> neutral_posture(const std::vector<Dof>& dofs) {
  std::map<std::string, double> posture;
  for (const Dof& dof : dofs) posture[dof.name] = std::clamp(0.0, dof.lower, dof.upper);
  return posture;
}

std::vector<int> dofs_to_root(const std::vector<Body>& bodies, int body) {
  std::vector<int> dofs, once;
  for (; bodies[body].parent >= 0; body = bodies[body].parent) dofs.push_back(bodies[body].dof);
  std::reverse(dofs.begin(), dofs.end());
  for (const int dof : dofs)  // a mimic joint has the dof of the joint that it follows
    if (std::find(once.begin(), once.end(), dof) == once.end()) once.push_back(dof);
  return once;
}

}  // namespace

RobotModel::RobotModel(RobotDescription description) : description_(std::move(description)) {
  validate_links(description_);
  validate_joints(description_);
  const int root = find_root_link(description_);
  const std::vector<int> dof_joints = ordered_dof_joints(description_);
  for (const int joint : dof_joints)
    dofs_.push_back(dof_of(description_.joints[joint], description_));
  validate_sidecar(description_, dof_names());
  validate_postures(description_, dofs_);

  TreeBuilder(description_, dof_joints).build(root, bodies_, links_);
  require_masses(description_, bodies_, links_);
  for (const Body& body : bodies_) mass_ += body.inertia.mass;
  for (int i = 1; i < static_cast<int>(bodies_.size()); ++i) {
    Dof& dof = dofs_[bodies_[i].dof];
    const bool drives = description_.joints[dof_joints[bodies_[i].dof]].child == bodies_[i].name;
    if (drives) dof.body = i;
  }

  if (!description_.postures.contains("home"))
    description_.postures["home"] = neutral_posture(dofs_);
  if (description_.profiles.empty()) {
    description_.profiles.emplace_back();
    description_.profiles.back().name = "urdf";
  }
  for (const ActuatorProfile& profile : description_.profiles)
    limits_.push_back(limits_of(profile, dofs_, description_, dof_joints));
  if (!description_.trunk_link.empty())
    trunk_body_ = links_[find_link(description_.trunk_link)].body;
  for (const char* side : {"left", "right"}) {
    const auto found = description_.soles.find(side);
    if (found == description_.soles.end()) continue;
    const SoleDescription& given = found->second;
    const Link& link = links_[find_link(given.link)];
    Sole sole{link.body,       link.pose * given.frame, given.polygon, centroid(given.polygon),
              given.stiffness, given.damping_time};
    if (sole.stiffness == 0) sole.stiffness = mass_ * kGravity / kSoleSink;
    if (sole.damping_time == 0) sole.damping_time = kSoleDampingTime;
    soles_.push_back(sole);
    legs_.push_back(dofs_to_root(bodies_, link.body));
  }
  if (has_soles() && soles_[0].body == soles_[1].body)
    complain_sidecar(description_, "/soles", "both feet are on one body; name two foot links");
  require_servos_that_fit(*this);
}

const std::vector<std::vector<MeshHull>>& RobotModel::collision_hulls() const {
  std::call_once(hulls_->computed, [this] {
    for (const Link& link : links_) {
      std::vector<MeshHull>& hulls = hulls_->of_links.emplace_back();
      for (const PlacedShape& placed : link.collisions) {
        const auto* mesh = std::get_if<MeshShape>(&placed.shape);
        hulls.push_back(mesh ? MeshHull(mesh->mesh) : MeshHull());
      }
    }
  });
  return hulls_->of_links;
}

std::vector<std::string> RobotModel::dof_names() const {
  std::vector<std::string> names;
  for (const Dof& dof : dofs_) names.push_back(dof.name);
  return names;
}

int RobotModel::find_dof(const std::string& joint_name) const {
  for (int i = 0; i < dof_count(); ++i)
    if (dofs_[i].name == joint_name) return i;
  return -1;
}

int RobotModel::find_link(const std::string& link_name) const {
  for (size_t i = 0; i < links_.size(); ++i)
    if (links_[i].name == link_name) return static_cast<int>(i);
  return -1;
}

const Sole& RobotModel::sole(Side side) const {
  if (!has_soles())
    complain_sidecar(description_, "/soles",
                     "the robot has no soles; give /soles/left and /soles/right" +
                         std::string(description_.missing_meshes.empty()
                                         ? ""
                                         : ". Or find the missing meshes, because they may show "
                                           "the feet: `ayumi inspect` lists these meshes, and "
                                           "--package-path names the folder with the packages"));
  return soles_[static_cast<int>(side)];
}

const std::vector<int>& RobotModel::leg(Side side) const {
  sole(side);
  return legs_[static_cast<int>(side)];
}

bool RobotModel::in_leg(Side side, int dof) const {
  const std::vector<int>& dofs = leg(side);
  return std::find(dofs.begin(), dofs.end(), dof) != dofs.end();
}

bool RobotModel::is_leg_joint(int dof) const {
  return has_soles() && (in_leg(Side::left, dof) || in_leg(Side::right, dof));
}

const ActuatorLimits& RobotModel::limits(const std::string& profile) const {
  if (profile.empty()) return limits_.front();
  for (const ActuatorLimits& limits : limits_)
    if (limits.name == profile) return limits;
  fail(ErrorCode::bad_model, "the robot '" + name() + "' has no actuator profile '" +
                                 text::quotable(profile) +
                                 "'; known: " + text::join(profile_names(), ", ") +
                                 text::suggestion(profile, profile_names()));
}

std::vector<std::string> RobotModel::profile_names() const {
  std::vector<std::string> names;
  for (const ActuatorLimits& limits : limits_) names.push_back(limits.name);
  return names;
}

Eigen::VectorXd RobotModel::posture(const std::string& posture_name) const {
  const auto found = description_.postures.find(posture_name);
  if (found == description_.postures.end()) {
    std::vector<std::string> known;
    for (const auto& [name, values] : description_.postures) known.push_back(name);
    complain_sidecar(
        description_, "",
        "no posture '" + posture_name + "'; known: " + text::join_first(known, kMostNamed));
  }
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(dof_count());
  for (int i = 0; i < dof_count(); ++i) theta[i] = value_or(found->second, dofs_[i].name, 0.0);
  return theta;
}

bool RobotModel::has_posture(const std::string& posture_name) const {
  return description_.postures.contains(posture_name);
}

Eigen::VectorXd RobotModel::joint_weight() const {
  Eigen::VectorXd weight(dof_count());
  for (int i = 0; i < dof_count(); ++i)
    weight[i] = value_or(description_.control.joint_weight, dofs_[i].name, 1.0);
  return weight;
}

RobotState RobotModel::rest_state(const std::string& posture_name) const {
  RobotState state;
  state.theta = posture(posture_name);
  state.dtheta = Eigen::VectorXd::Zero(dof_count());
  return state;
}

}  // namespace ayumi
