#include "ayumi/model/validate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/eigenvalues.hpp"

namespace ayumi {

namespace {

std::vector<std::string> link_names(const RobotDescription& robot) {
  std::vector<std::string> names;
  for (const LinkDescription& link : robot.links) names.push_back(link.name);
  return names;
}

std::vector<std::string> joint_names(const RobotDescription& robot) {
  std::vector<std::string> names;
  for (const JointDescription& joint : robot.joints) names.push_back(joint.name);
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string twice(const std::vector<std::string>& names) {
  std::set<std::string> seen;
  for (const std::string& name : names)
    if (!seen.insert(name).second) return name;
  return "";
}

// Longest chain of joints of which each mimics the next. Chosen: fingers have two or three; each
// step is a search among all joints.
constexpr size_t kLongestMimicChain = 20;

void validate_inertia(const RobotDescription& robot, const LinkDescription& link) {
  const std::string where = "link " + link.name;
  const Inertia& inertia = link.inertia;
  if (!std::isfinite(inertia.mass) || !inertia.com.allFinite() || !inertia.about_com.allFinite())
    complain_urdf(robot, where, "the inertia has a number that is not finite; correct this number");
  if (inertia.mass < 0)
    complain_urdf(robot, where,
                  "mass " + text::exact(inertia.mass) + " kg is negative; give the link its mass");
  if (inertia.mass > kLargestMass)
    complain_urdf(robot, where,
                  "mass " + text::exact(inertia.mass) + " kg is above " +
                      text::exact(kLargestMass) + " kg; URDF masses are in kilograms");
  if (inertia.com.cwiseAbs().maxCoeff() > kLargestLength)
    complain_urdf(robot, where,
                  "its centre of mass lies farther than " + text::exact(kLargestLength) +
                      " m away; URDF lengths are in metres");
  const Eigen::Vector3d principal = symmetric_eigenvalues(inertia.about_com);
  if (principal.minCoeff() < -1e-9 * std::max(1e-6, principal.cwiseAbs().maxCoeff()))
    complain_urdf(robot, where,
                  "its inertia tensor has the negative principal moment " +
                      text::brief(principal.minCoeff()) +
                      " kg m^2, which no body can have; check the products of inertia");
}

// A shape may be flat.
void validate_shapes(const RobotDescription& robot, const LinkDescription& link) {
  for (const auto* shapes : {&link.visuals, &link.collisions})
    for (const PlacedShape& placed : *shapes) {
      double least = 0;
      if (const auto* const box = std::get_if<Box>(&placed.shape)) least = box->size.minCoeff();
      if (const auto* const sphere = std::get_if<Sphere>(&placed.shape)) least = sphere->radius;
      if (const auto* const rod = std::get_if<Cylinder>(&placed.shape))
        least = std::min(rod->radius, rod->length);
      if (const auto* const rod = std::get_if<Capsule>(&placed.shape))
        least = std::min(rod->radius, rod->length);
      if (least < 0)
        complain_urdf(robot, "link " + link.name,
                      "a shape has the negative size " + text::exact(least) +
                          " m; give its size as a positive number");
    }
}

void validate_joint_numbers(const RobotDescription& robot, const JointDescription& joint) {
  const std::string where = "joint " + joint.name;
  if (!joint.origin.matrix().allFinite() || !joint.axis.allFinite() ||
      !std::isfinite(joint.lower + joint.upper + joint.velocity + joint.effort + joint.damping +
                     joint.friction + joint.mimic_multiplier + joint.mimic_offset))
    complain_urdf(robot, where, "a number of this joint is not finite; correct this number");
  if (joint.origin.translation().cwiseAbs().maxCoeff() > kLargestLength)
    complain_urdf(robot, where,
                  "its origin lies farther than " + text::exact(kLargestLength) +
                      " m from its parent; URDF lengths are in metres");
  if (joint.type == JointType::fixed || joint.type == JointType::floating) return;
  if (joint.axis.norm() < 1e-9)
    complain_urdf(robot, where, "its axis has length zero; give it a direction");
  if (joint.has_limits && joint.lower > joint.upper)
    complain_urdf(robot, where,
                  "lower limit " + text::brief(joint.lower) + " exceeds the upper limit " +
                      text::brief(joint.upper) + "; swap them");
  for (const auto& [what, value] :
       {std::pair("velocity", joint.velocity), std::pair("effort", joint.effort),
        std::pair("damping", joint.damping), std::pair("friction", joint.friction)})
    if (value < 0)
      complain_urdf(
          robot, where,
          std::string("its ") + what + " is " + text::exact(value) + "; it cannot be negative");
}

void validate_mimic(const RobotDescription& robot, const JointDescription& joint) {
  const auto find = [&](const std::string& name) {
    return std::find_if(robot.joints.begin(), robot.joints.end(),
                        [&](const JointDescription& other) { return other.name == name; });
  };
  const std::string where = "joint " + joint.name;
  const JointDescription* driver = &joint;
  for (size_t steps = 0; !driver->mimic.empty(); ++steps) {
    const auto next = find(driver->mimic);
    if (next == robot.joints.end())
      complain_urdf(robot, where,
                    "this joint mimics the joint '" + driver->mimic + "', which does not exist" +
                        text::suggestion(driver->mimic, joint_names(robot)));
    driver = &*next;
    if (driver == &joint)
      complain_urdf(
          robot, where,
          "this joint mimics itself through other joints; change <mimic> of one of these joints");
    if (steps > kLongestMimicChain)
      complain_urdf(robot, where,
                    "this joint mimics another joint through more than " +
                        std::to_string(kLongestMimicChain) +
                        " joints, or the joints mimic each other in a circle; in <mimic>, name the "
                        "joint that moves by itself");
  }
  if (driver->type == JointType::fixed || driver->type == JointType::floating)
    complain_urdf(robot, where,
                  "this joint mimics the joint '" + driver->name + "', which does not move");
}

}  // namespace

namespace {

[[noreturn]] void complain(const RobotDescription& robot, const std::string& file,
                           const std::string& inside, const std::string& message) {
  if (!file.empty()) fail(ErrorCode::bad_model, {file, inside}, message);
  fail(ErrorCode::bad_model,
       "robot " + robot.name + ": " + (inside.empty() ? "" : inside + ": ") + message);
}

}  // namespace

void complain_urdf(const RobotDescription& robot, const std::string& inside,
                   const std::string& message) {
  complain(robot, robot.urdf_file, inside, message);
}

void complain_sidecar(const RobotDescription& robot, const std::string& inside,
                      const std::string& message) {
  complain(robot, robot.sidecar_file, inside, message);
}

void complain_posture(const RobotDescription& robot, const std::string& posture,
                      const std::string& joint, const std::string& message) {
  if (const auto places = robot.angle_places.find(posture); places != robot.angle_places.end())
    if (const auto place = places->second.find(joint); place != places->second.end())
      fail(ErrorCode::bad_model, place->second, message);
  complain_sidecar(
      robot, "/postures/" + json_pointer_token(posture) + "/" + json_pointer_token(joint), message);
}

std::string too_many(const std::string& what) {
  return "the robot has more than " + std::to_string(kMostLinks) + " " + what +
         "; simplify the robot";
}

void validate_links(const RobotDescription& robot) {
  if (robot.links.empty()) complain_urdf(robot, "", "the robot has no link; add one");
  if (robot.links.size() > kMostLinks) complain_urdf(robot, "", too_many("links"));
  const std::string name = twice(link_names(robot));
  if (!name.empty()) complain_urdf(robot, "link " + name, "two links have this name; rename one");
  for (const LinkDescription& link : robot.links) {
    validate_inertia(robot, link);
    validate_shapes(robot, link);
  }
}

void validate_joints(const RobotDescription& robot) {
  if (robot.joints.size() > kMostLinks) complain_urdf(robot, "", too_many("joints"));
  const std::vector<std::string> links = link_names(robot);
  const std::string name = twice(joint_names(robot));
  if (!name.empty()) complain_urdf(robot, "joint " + name, "two joints have this name; rename one");
  for (const JointDescription& joint : robot.joints) {
    for (const std::string& end : {joint.parent, joint.child})
      if (!contains(links, end))
        complain_urdf(robot, "joint " + joint.name,
                      "the link '" + end + "' does not exist" + text::suggestion(end, links));
    validate_joint_numbers(robot, joint);
    if (!joint.mimic.empty()) validate_mimic(robot, joint);
  }
}

int find_root_link(const RobotDescription& robot) {
  std::map<std::string, std::string> parent_joint;  // parent joint of each child link
  std::multimap<std::string, std::string> children;
  for (const JointDescription& joint : robot.joints) {
    const auto [other, fresh] = parent_joint.emplace(joint.child, joint.name);
    if (!fresh)
      complain_urdf(robot, "link " + joint.child,
                    "the joints " + other->second + " and " + joint.name +
                        " both lead to this link, but closed chains are not supported; "
                        "remove one of these joints");
    children.emplace(joint.parent, joint.child);
  }
  std::vector<std::string> roots;
  for (const LinkDescription& link : robot.links)
    if (!parent_joint.contains(link.name)) roots.push_back(link.name);
  if (roots.empty())
    complain_urdf(robot, "link " + robot.links.front().name,
                  "the joints form a loop, so no link is the root; remove one joint");
  if (roots.size() > 1)
    complain_urdf(robot, "",
                  "there are several root links: " + text::join(roots, ", ") +
                      "; add joints so that only one root link remains");
  std::set<std::string> reached = {roots[0]};
  std::vector<std::string> open = roots;
  while (!open.empty()) {
    const auto [begin, end] = children.equal_range(open.back());
    open.pop_back();
    for (auto child = begin; child != end; ++child)
      if (reached.insert(child->second).second) open.push_back(child->second);
  }
  for (const LinkDescription& link : robot.links)
    if (!reached.contains(link.name))
      complain_urdf(
          robot, "link " + link.name,
          "this link belongs to a loop of joints that is not connected to the root link " +
              roots[0] + "; remove one joint of the loop");
  const auto root =
      std::find_if(robot.links.begin(), robot.links.end(),
                   [&](const LinkDescription& link) { return link.name == roots[0]; });
  return static_cast<int>(root - robot.links.begin());
}

std::vector<int> ordered_dof_joints(const RobotDescription& robot) {
  std::vector<int> moving;
  std::vector<std::string> names;
  for (size_t i = 0; i < robot.joints.size(); ++i) {
    const JointDescription& joint = robot.joints[i];
    const bool moves = joint.type != JointType::fixed && joint.type != JointType::floating;
    if (!moves || !joint.mimic.empty()) continue;
    moving.push_back(static_cast<int>(i));
    names.push_back(joint.name);
  }
  if (robot.joint_order.empty()) return moving;
  const std::string name = twice(robot.joint_order);
  if (!name.empty())
    complain_sidecar(robot, "/joint_order", "'" + name + "' appears twice; keep one");
  std::vector<int> ordered;
  for (size_t i = 0; i < robot.joint_order.size(); ++i) {
    const std::string& wanted = robot.joint_order[i];
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found == names.end())
      complain_sidecar(
          robot, "/joint_order/" + std::to_string(i),
          "'" + wanted + "' is not a moving joint of the URDF" + text::suggestion(wanted, names));
    ordered.push_back(moving[found - names.begin()]);
  }
  for (const std::string& missing : names)
    if (!contains(robot.joint_order, missing))
      complain_sidecar(robot, "/joint_order", "the joint '" + missing + "' is missing; add it");
  return ordered;
}

namespace {

std::string not_moving(const std::string& joint, const std::vector<std::string>& names) {
  return "'" + joint + "' is not a moving joint of the robot" + text::suggestion(joint, names);
}

// Checks the names of a map from joints to anything.
template <typename Value>
void known_joints(const RobotDescription& robot, const std::string& pointer,
                  const std::map<std::string, Value>& map, const std::vector<std::string>& names,
                  const std::string& owner = "") {
  for (const auto& [name, value] : map)
    if (!contains(names, name)) complain_sidecar(robot, pointer, owner + not_moving(name, names));
}

void known_link(const RobotDescription& robot, const std::string& pointer,
                const std::string& name) {
  const std::vector<std::string> names = link_names(robot);
  if (!contains(names, name))
    complain_sidecar(robot, pointer,
                     "the link '" + name + "' does not exist" + text::suggestion(name, names));
}

void positive(const RobotDescription& robot, const std::string& pointer, const std::string& what,
              const std::map<std::string, double>& values) {
  for (const auto& [name, value] : values)
    if (!(value > 0))
      complain_sidecar(
          robot, pointer,
          what + " of '" + name + "' is " + text::exact(value) + "; it must be above 0");
}

// Largest number of corners of a sole. Each corner is a contact of the simulation, whose time grows
// with the third power of their number. Chosen: on a round sole of 0.1 m, 32 corners leave out 0.5
// mm. With half of them, it is 2 mm; with twice, a step of the simulation takes eight times as
// long.
constexpr size_t kMostSoleCorners = 32;

void validate_sole(const RobotDescription& robot, const std::string& side,
                   const SoleDescription& sole) {
  const std::string pointer = "/soles/" + side;
  if (side != "left" && side != "right")
    complain_sidecar(robot, pointer, "unknown foot; the two feet are 'left' and 'right'");
  known_link(robot, pointer + "/link", sole.link);
  const auto& corners = sole.polygon;
  const std::string remedy =
      "; give at least three corners of a convex polygon, counter-clockwise "
      "seen from above";
  if (corners.size() < 3) complain_sidecar(robot, pointer + "/polygon", "too few corners" + remedy);
  if (corners.size() > kMostSoleCorners)
    complain_sidecar(robot, pointer + "/polygon",
                     "the sole has " + std::to_string(corners.size()) + " corners, but at most " +
                         std::to_string(kMostSoleCorners) +
                         " are possible; leave out corners between which the "
                         "outline is almost straight");
  for (size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = corners[(i + 1) % corners.size()] - corners[i];
    const Eigen::Vector2d next = corners[(i + 2) % corners.size()] - corners[i];
    if (!(along.x() * next.y() - along.y() * next.x() > 0))
      complain_sidecar(
          robot, pointer + "/polygon/" + std::to_string((i + 1) % corners.size()),
          "at this corner, the polygon is not convex or not counter-clockwise" + remedy);
  }
  for (const auto& [what, value] :
       {std::pair("stiffness", sole.stiffness), std::pair("damping_time", sole.damping_time)})
    if (!(value >= 0))
      complain_sidecar(robot, pointer,
                       std::string(what) + " is " + text::exact(value) + "; it cannot be negative");
}

void validate_force_cells(const RobotDescription& robot) {
  for (const auto& [side, cells] : robot.sensors.force_cells) {
    const auto sole = robot.soles.find(side);
    const std::string where = "/sensors/force_cells/" + side;
    if (sole == robot.soles.end())
      complain_sidecar(robot, where, "the robot has no sole of this name");
    const size_t corners = sole->second.polygon.size();
    if (cells.size() != 1 && cells.size() != corners)
      complain_sidecar(robot, where,
                       "there are " + std::to_string(cells.size()) +
                           " load cells, but the sole has " + std::to_string(corners) +
                           " corners; give one load cell for each corner, or one for all");
  }
}

void validate_servos(const RobotDescription& robot) {
  for (const auto& [name, servo] : robot.servos)
    for (const auto& [what, value] :
         {std::pair("kp", servo.kp), std::pair("kd", servo.kd),
          std::pair("rotor_inertia", servo.rotor_inertia), std::pair("viscous", servo.viscous),
          std::pair("coulomb", servo.coulomb)})
      if (!(value >= 0))
        complain_sidecar(
            robot, "/servos/" + json_pointer_token(name),
            std::string(what) + " is " + text::exact(value) + "; it cannot be negative");
}

}  // namespace

void validate_sidecar(const RobotDescription& robot, const std::vector<std::string>& names) {
  for (const auto& [side, sole] : robot.soles) validate_sole(robot, side, sole);
  if (robot.soles.size() == 1)
    complain_sidecar(robot, "/soles", "only one foot is given; name 'left' and 'right'");
  validate_force_cells(robot);
  for (const auto& [posture, values] : robot.postures)
    for (const auto& [joint, angle] : values)
      if (!contains(names, joint))
        complain_posture(robot, posture, joint, not_moving(joint, names));
  known_joints(robot, "/servos", robot.servos, names);
  validate_servos(robot);
  known_joints(robot, "/encoders", robot.encoders, names);
  known_joints(robot, "/control/joint_weight", robot.control.joint_weight, names);
  positive(robot, "/control/joint_weight", "the weight", robot.control.joint_weight);
  for (const ActuatorProfile& profile : robot.profiles) {
    const std::string pointer = "/profiles", owner = "profile '" + profile.name + "': ";
    for (const auto& [what, values] :
         {std::pair("the speed", &profile.speed),
          std::pair("the peak torque", &profile.peak_torque),
          std::pair("the continuous torque", &profile.continuous_torque)}) {
      known_joints(robot, pointer, *values, names, owner);
      positive(robot, pointer, owner + what, *values);
    }
    if (!(profile.thermal_window > 0))
      complain_sidecar(robot, pointer,
                       owner + "thermal_window is " + text::exact(profile.thermal_window) +
                           " s; it must be above 0 s");
  }
  if (!robot.trunk_link.empty()) known_link(robot, "/trunk_link", robot.trunk_link);
  if (!robot.sensors.imu_link.empty())
    known_link(robot, "/sensors/imu_link", robot.sensors.imu_link);
  for (size_t i = 0; i < robot.collision_ignore.size(); ++i) {
    const auto& [a, b] = robot.collision_ignore[i];
    known_link(robot, "/collision_ignore/" + std::to_string(i) + "/0", a);
    known_link(robot, "/collision_ignore/" + std::to_string(i) + "/1", b);
  }
  if (!(robot.servo_period >= kShortestServoPeriod && robot.servo_period <= kLongestServoPeriod))
    complain_sidecar(robot, "/servo_period",
                     text::brief(robot.servo_period) + " s is given; give 1e-7 to 10 s");
  if (!(robot.soft_limit_margin >= 0))
    complain_sidecar(
        robot, "/soft_limit_margin",
        "the value is " + text::exact(robot.soft_limit_margin) + "; it cannot be negative");
}

}  // namespace ayumi
