#include "ayumi/io/robot/robot_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/model/body_poses.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/outline.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

namespace {

// What is this near to the lowest point of a foot is sole [m]. Chosen: an eighth of the height of
// HOAP-1's ankle (37 mm), so that rounded edges count and the ankle does not.
constexpr double kSoleThickness = 0.005;
// A foot lies at least this far from the middle [m]. Chosen: a quarter of where HOAP-1's feet are
// (39 mm).
constexpr double kSideways = 0.01;
// Longest side of a sole [m]. Chosen: ten times HOAP-1's; a longer one is a mistake of the unit.
constexpr double kLargestSole = 1.0;

std::vector<Eigen::Vector3d> loaded_outline(const PlacedShape& placed) {
  const auto* reference = std::get_if<MeshShape>(&placed.shape);
  if (!reference || !reference->mesh.parts.empty()) return outline(placed.shape);
  return outline(MeshShape{{}, {}, load_mesh(reference->file, reference->scale)});
}

std::vector<Eigen::Isometry3d> zero_poses(const RobotModel& model) {
  return body_poses(model, Eigen::VectorXd::Zero(model.dof_count()));
}

struct FootCandidate {
  int link = -1;
  double lowest = std::numeric_limits<double>::infinity();
  std::vector<Eigen::Vector3d> points;  // of its body, in the root frame
};

// Lowest leaf body on one side (+1 left, -1 right).
FootCandidate lowest_foot(const RobotModel& model, const std::vector<Eigen::Isometry3d>& poses,
                          int side) {
  std::vector<bool> leaf(model.bodies().size(), true);
  for (const Body& body : model.bodies())
    if (body.parent >= 0) leaf[body.parent] = false;
  FootCandidate best;
  for (int body = 1; body < static_cast<int>(leaf.size()); ++body) {
    if (!leaf[body] || side * poses[body].translation().y() < kSideways) continue;
    FootCandidate foot;
    for (size_t i = 0; i < model.links().size(); ++i) {
      const Link& link = model.links()[i];
      if (link.body != body) continue;
      if (foot.link < 0) foot.link = static_cast<int>(i);
      for (const PlacedShape& placed : link.collisions.empty() ? link.visuals : link.collisions)
        for (const Eigen::Vector3d& point : loaded_outline(placed))
          foot.points.push_back(poses[body] * link.pose * placed.pose * point);
    }
    for (const Eigen::Vector3d& point : foot.points) foot.lowest = std::min(foot.lowest, point.z());
    if (foot.lowest < best.lowest) best = foot;
  }
  return best;
}

SoleDescription sole_of(const RobotModel& model, const std::vector<Eigen::Isometry3d>& poses,
                        const FootCandidate& foot) {
  const Link& link = model.links()[foot.link];
  const Eigen::Vector3d ankle = poses[link.body].translation();
  const Eigen::Vector3d origin(ankle.x(), ankle.y(), foot.lowest);
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const Eigen::Vector3d& point : foot.points) {
    if (point.z() > foot.lowest + kSoleThickness) continue;
    low = low.cwiseMin((point - origin).head<2>());
    high = high.cwiseMax((point - origin).head<2>());
  }
  SoleDescription sole;
  sole.link = link.name;
  sole.frame = (poses[link.body] * link.pose).inverse() * Eigen::Translation3d(origin);
  sole.polygon = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return sole;
}

double area(const SoleDescription& sole) {
  return sole.polygon.empty() ? 0 : (sole.polygon[2] - sole.polygon[0]).prod();
}

void infer_soles(const RobotModel& model, RobotDescription& robot) {
  const std::vector<Eigen::Isometry3d> poses = zero_poses(model);
  const FootCandidate left = lowest_foot(model, poses, 1), right = lowest_foot(model, poses, -1);
  if (left.link < 0 || right.link < 0 || left.points.empty() || right.points.empty()) {
    robot.assumptions.push_back("no feet were recognised: the robot has no soles");
    return;
  }
  std::map<std::string, SoleDescription> soles = {{"left", sole_of(model, poses, left)},
                                                  {"right", sole_of(model, poses, right)}};
  for (const auto& [side, sole] : soles)
    if (!(area(sole) > 1e-6) || (sole.polygon[2] - sole.polygon[0]).maxCoeff() > kLargestSole) {
      robot.assumptions.push_back(
          "the " + side + " foot " + sole.link +
          " has no flat underside with every joint at 0: the robot has no soles");
      return;
    }
  for (const auto& [side, sole] : soles)
    robot.assumptions.push_back(
        side + " sole: link " + sole.link + ", underside with every joint at 0, " +
        text::fixed(1000 * (sole.polygon[2] - sole.polygon[0]).x(), 0) + " x " +
        text::fixed(1000 * (sole.polygon[2] - sole.polygon[0]).y(), 0) + " mm");
  robot.soles = soles;
}

// COG height above the lowest point of the robot, every joint at 0.
double cog_height(const RobotModel& model) {
  const std::vector<Eigen::Isometry3d> poses = zero_poses(model);
  double moment = 0, lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < poses.size(); ++i)
    moment += model.bodies()[i].inertia.mass * (poses[i] * model.bodies()[i].inertia.com).z();
  for (const Eigen::Isometry3d& pose : poses) lowest = std::min(lowest, pose.translation().z());
  if (model.has_soles()) {
    const Sole& sole = model.sole(Side::left);
    lowest = std::min(lowest, (poses[sole.body] * sole.frame).translation().z());
  }
  return std::max(moment / model.mass() - lowest, 0.01);
}

void infer_servos(const RobotModel& model, RobotDescription& robot) {
  const double z = cog_height(model), mass = model.mass();
  ServoDescription servo;
  servo.kp = 40 * mass * kGravity * z;
  servo.kd = 0.13 * std::sqrt(z / kGravity) * servo.kp;
  servo.rotor_inertia = 0.009 * mass * z * z;
  bool sliders = false;
  robot.servos_inferred = true;
  for (const Dof& dof : model.dofs()) {
    sliders |= dof.prismatic;
    const auto joint =
        std::find_if(robot.joints.begin(), robot.joints.end(),
                     [&](const JointDescription& each) { return each.name == dof.name; });
    // A slider with the force of a turning joint at the lever of the COG's height.
    const double scale = dof.prismatic ? 1 / (z * z) : 1;
    robot.servos[dof.name] = {scale * servo.kp, scale * servo.kd, scale * servo.rotor_inertia,
                              joint->damping, joint->friction};
  }
  robot.assumptions.push_back(
      "servos: kp " + text::brief(servo.kp) + " N m/rad, kd " + text::brief(servo.kd) +
      " N m s/rad, rotor inertia " + text::brief(servo.rotor_inertia) +
      " kg m^2, scaled from mass and COG height" +
      std::string(sliders
                      ? "; the values of sliding joints are divided by the square of the COG height"
                      : ""));
}

}  // namespace

void infer_missing(RobotDescription& robot) {
  if (robot.soles.empty()) infer_soles(RobotModel(robot), robot);
  if (!robot.postures.contains("home")) {
    const RobotModel model(robot);
    robot.postures["home"] = model.description().postures.at("home");
    robot.assumptions.push_back("home posture: every joint at 0, or at the limit nearest to 0");
  }
  if (robot.servos.empty()) infer_servos(RobotModel(robot), robot);
  if (robot.profiles.empty())
    robot.assumptions.push_back(
        "actuator limits: velocity and effort of the URDF; a value of 0 means that there is no "
        "limit");
}

}  // namespace ayumi
