#include "ayumi/io/robot/robot_guess.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/io/robot/facing.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/body_poses.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/outline.hpp"

namespace ayumi {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Points = std::vector<Vector3d>;

constexpr double kOneDegree = std::numbers::pi / 180;

// A point that is at most this far above the lowest point of a foot touches the ground [m]. Chosen:
// above the rounding of meshes, below the rounded edges of feet. With half or twice this height,
// the sole of a foot with edges of 5 mm radius changes by 1 mm.
constexpr double kTouching = 0.001;
// Height above the lowest point of a foot up to which a soft sole can give way [m], and the factor
// by which a rounded foot is longer or wider at this height than at kTouching. Chosen: soles of
// rubber yield by a few millimetres, and the edges of flat feet have smaller radii. With twice the
// height, shafts of ankles count as soles.
constexpr double kYielding = 0.005;
constexpr double kRounded = 1.4;
// Cosine of the largest angle by which an underside is turned to be level. Chosen: 45 deg, so that
// the back of a heel is no sole.
constexpr double kMostTilt = 0.7071;
// Smallest distance of the feet [m]. Chosen: half of the distance of HOAP-1's feet (78 mm).
constexpr double kApart = 0.02;
// Largest difference between the heights of both feet, as a share of the robot's height. Chosen:
// below the distance of an ankle from its sole.
constexpr double kSameHeight = 0.02;
// Longest side of a sole [m]. Chosen: ten times HOAP-1's; a longer one is a mistake of the unit.
constexpr double kLargestSole = 1.0;
// Smallest area of a sole [m^2]. Chosen: 1 mm by 1 mm.
constexpr double kSmallestSole = 1e-6;
// Longest side of a box that stands for a foot without shapes, as a share of the distance between
// the highest and the lowest joint. Chosen: a foot of half the robot's height is a mistake of the
// inertia; HOAP-1's foot measures a quarter.
constexpr double kLargestFootBox = 0.5;
// Factor by which such a box is longer than wide if its longer side is the direction of the foot.
// Chosen: at this factor, a product of inertia of a tenth of the smaller second moment turns the
// principal axes by 12 deg, and below it by more. HOAP-1's soles have a factor of 1.6.
constexpr double kClearlyLonger = 1.2;
// Fewest joints of a leg whose foot has no shape. Chosen: a hip, a knee and an ankle; fingers of a
// hand have fewer joints of their own.
constexpr int kFewestLegJoints = 3;
// Largest number of corners of a sole. Chosen: each corner is a contact of the simulation; the
// removed corners lie outside of what is left, by less than 2 % of the length of a round sole.
constexpr size_t kMostCorners = 8;
// If one end of a foot is longer than the other one by this factor, measured from the ankle, it is
// the front. Chosen.
constexpr double kLongerEnd = 1.1;

// Reach of the legs at home, in lengths of the straight leg, in the order in which they are tried.
// Chosen: thigh and shank of equal length are at 40 deg to each other for 0.94, similar to the home
// posture of HOAP-1.
constexpr std::array kReaches = {0.94, 0.92, 0.955, 0.90, 0.97, 0.87, 0.84};
// Distance of the home posture from the position limits [rad]. Chosen: 2 deg, so that the
// controller has room on both sides.
constexpr double kLimitRoom = 2 * kOneDegree;

// Error at which a servo gives its full effort [rad]. Chosen: makers of torque-controlled humanoids
// use up to 1 rad with torques that a learned policy commands, and hobby servos reach their torque
// at 0.02 to 0.1 rad.
constexpr double kFullEffortError = 0.2;
// Smallest kp of a joint of a leg, in m g z per rad. Derived: a robot that leans by e falls with
// the moment m g z e, and both ankles together have to hold it many times over. Measured: the walk
// of a robot of 128 kg has a ZMP error of 2.1 mm in open loop and 8.3 mm under DTAD with 4 m g z,
// 3.6 and 3.2 mm with 10, 3.9 and 3.0 mm with 20. Robots whose servos are known have 21
// (humanoid30) and 256 (HOAP-1).
constexpr double kLegStiffness = 20;
// Damping ratio of a servo that moves its limb while the robot is in the air. Derived: 1 is the
// quickest response without overshoot. kd/kp is then 2 to 10 ms for a robot of HOAP-1's size; the
// servos of HOAP-1 have 4 ms.
constexpr double kDampingRatio = 1;
// Rotor inertia of a servo per effort [kg m^2 per N m]. Source: armature 0.01 to 0.025 kg m^2 for
// 88 to 139 N m in published models of humanoids.
constexpr double kInertiaPerEffort = 2e-4;
// Effort of a joint of a leg and of any other joint, in m g z, if none is stated. Source: HOAP-1
// has 0.21 to 0.31, DARwIn-OP 0.4, and Unitree G1 0.37 to 0.59 in the legs.
constexpr double kLegEffort = 0.4, kOtherEffort = 0.1;
// Effort in m g z above which a limit is a placeholder. Chosen: ten times that of a strong leg.
constexpr double kGreatestEffort = 5;
// Speed above which a limit is a placeholder [rad/s]. Chosen: ten times that of a usual servo.
constexpr double kGreatestSpeed = 60;
// If at least this share of the joints, or of the joints of the legs, have the same position
// limits, these limits are placeholders. Chosen: knees bend to one side, unlike the other joints of
// a leg.
constexpr double kSameLimits = 0.8;
// Smallest number of joints for a rule about all joints. Chosen.
constexpr size_t kManyJoints = 6;

VectorXd zero_posture(const RobotModel& model) {
  VectorXd theta(model.dof_count());
  for (int i = 0; i < model.dof_count(); ++i)
    theta[i] = std::clamp(0.0, model.dofs()[i].lower, model.dofs()[i].upper);
  return theta;
}

Points loaded_outline(const PlacedShape& placed) {
  const auto* reference = std::get_if<MeshShape>(&placed.shape);
  if (!reference || !reference->mesh.parts.empty()) return outline(placed.shape);
  try {
    return outline(MeshShape{{}, {}, load_mesh(reference->file, reference->scale)});
  } catch (const Error&) {
    return {};  // a mesh that cannot be read is reported where it is needed
  }
}

// Points of a shape, among them its lowest points. Round shapes touch the ground in one point or in
// a line.
Points points_above_ground(const PlacedShape& placed, const Isometry3d& link) {
  const Isometry3d pose = link * placed.pose;
  if (const auto* sphere = std::get_if<Sphere>(&placed.shape))
    return {pose.translation() - sphere->radius * Vector3d::UnitZ()};
  if (const auto* capsule = std::get_if<Capsule>(&placed.shape)) {
    const Vector3d half = pose.linear().col(2) * capsule->length / 2;
    const Vector3d down = capsule->radius * Vector3d::UnitZ();
    return {pose.translation() + half - down, pose.translation() - half - down};
  }
  Points points = loaded_outline(placed);
  for (Vector3d& point : points) point = pose * point;
  return points;
}

// The points of the collision shapes of a body or, if it has none, of its visual shapes, in the
// root frame.
Points body_points(const RobotModel& model, const std::vector<Isometry3d>& poses, int body) {
  Points points;
  for (const bool collisions : {true, false}) {
    for (const Link& link : model.links()) {
      if (link.body != body) continue;
      for (const PlacedShape& placed : collisions ? link.collisions : link.visuals)
        for (const Vector3d& point : points_above_ground(placed, poses[body] * link.pose))
          points.push_back(point);
    }
    if (!points.empty()) break;
  }
  return points;
}

double lowest_of(const Points& points) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vector3d& point : points) lowest = std::min(lowest, point.z());
  return lowest;
}

// ---- feet

struct Foot {
  int body = -1;
  Points points;  // points in the root frame, with every joint at 0
  double lowest = std::numeric_limits<double>::infinity();
  bool of_inertia = false;  // the points are the corners of the box of the body's inertia
};

double touching_area(const Points& points, double lowest) {
  std::vector<Vector2d> touching;
  for (const Vector3d& point : points)
    if (point.z() <= lowest + kTouching) touching.push_back(point.head<2>());
  const ConvexPolygon hull(touching);
  const auto& v = hull.vertices();
  double area = 0;
  for (size_t i = 0; i < v.size(); ++i) {
    const Vector2d& next = v[(i + 1) % v.size()];
    area += 0.5 * (v[i].x() * next.y() - v[i].y() * next.x());
  }
  return area;
}

bool is_above(const RobotModel& model, int body, int other) {
  for (int i = other; i > 0; i = model.bodies()[i].parent)
    if (i == body) return true;
  return false;
}

int joints_above(const RobotModel& model, int body) {
  int count = 0;
  for (int i = body; i > 0; i = model.bodies()[i].parent) ++count;
  return count;
}

// Number of joints between a body and the nearest body that carries the other one, too.
int own_joints(const RobotModel& model, int body, int other) {
  int count = 0;
  for (int i = body; i > 0 && !is_above(model, i, other); i = model.bodies()[i].parent) ++count;
  return count;
}

// Half of the sides of a box with these axes that has the mass and the second moments of a body.
// Empty if there is no such box.
std::optional<Vector3d> half_sides(double mass, const Eigen::Matrix3d& moments,
                                   const Eigen::Matrix3d& axes) {
  // A side a of a box of even density has the second moment m a^2 / 12.
  const Vector3d squares = 12 / mass * (axes.transpose() * moments * axes).diagonal();
  if (!(squares.minCoeff() > 0)) return std::nullopt;
  return 0.5 * squares.cwiseSqrt();
}

// The corners, in the root frame, of the upright box that has the mass, the centre of mass and the
// second moments of the body. Its sides are parallel to the body's principal axes along the ground.
// If these moments are nearly equal, small errors turn the principal axes by any angle, so the
// sides are along and across `sideways`, the unit vector from foot to foot. Empty if there is no
// such box.
Points inertia_box(const Body& body, const Isometry3d& pose, const Vector2d& sideways) {
  const Inertia& inertia = body.inertia;
  if (!(inertia.mass > 0)) return {};
  const Eigen::Matrix3d tensor = pose.linear() * inertia.about_com * pose.linear().transpose();
  const Eigen::Matrix3d moments =
      0.5 * tensor.trace() * Eigen::Matrix3d::Identity() - tensor;  // integrals of r_i r_j dm
  const double difference = moments(0, 0) - moments(1, 1);
  const double turn =
      0.5 * elementary::atan2(std::copysign(2, difference) * moments(0, 1), std::abs(difference));
  Eigen::Matrix3d axes = rpy_to_matrix({0, 0, turn});
  std::optional<Vector3d> half = half_sides(inertia.mass, moments, axes);
  if (half && half->head<2>().maxCoeff() < kClearlyLonger * half->head<2>().minCoeff()) {
    axes << sideways.y(), sideways.x(), 0, -sideways.x(), sideways.y(), 0, 0, 0, 1;
    half = half_sides(inertia.mass, moments, axes);
  }
  if (!half) return {};
  const Vector3d center = pose * inertia.com;
  Points corners;
  for (const double x : {-1, 1})
    for (const double y : {-1, 1})
      for (const double z : {-1, 1})
        corners.push_back(center + axes * half->cwiseProduct(Vector3d(x, y, z)));
  return corners;
}

Vector3d sizes_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) box.extend(point);
  return box.sizes();
}

double highest_joint(const std::vector<Isometry3d>& poses) {
  double highest = -std::numeric_limits<double>::infinity();
  for (size_t body = 1; body < poses.size(); ++body)
    highest = std::max(highest, poses[body].translation().z());
  return highest;
}

// The two end bodies without any shape whose joints are the lowest of the robot, beside each other
// at the same height. The points of the feet are the corners of the boxes of their inertias. Empty
// if there are no such bodies, if further ones are as low (the robot has more than two legs), if
// their own joints are too few for legs, or if these boxes are too large for feet.
std::vector<Foot> feet_without_shapes(const RobotModel& model, const std::vector<Isometry3d>& poses,
                                      const std::vector<int>& bare) {
  std::vector<int> bodies = bare;
  const auto height = [&](int body) { return poses[body].translation().z(); };
  std::stable_sort(bodies.begin(), bodies.end(),
                   [&](int a, int b) { return height(a) < height(b); });
  if (bodies.size() < 2) return {};
  double lowest = std::numeric_limits<double>::infinity();
  for (size_t body = 1; body < poses.size(); ++body)
    lowest = std::min(lowest, height(static_cast<int>(body)));
  const double tall = highest_joint(poses) - lowest;
  const Vector3d between = poses[bodies[0]].translation() - poses[bodies[1]].translation();
  const double level = lowest + kSameHeight * tall;
  if (height(bodies[1]) > level || between.head<2>().norm() < kApart) return {};
  if (bodies.size() > 2 && height(bodies[2]) <= level) return {};
  if (std::min(own_joints(model, bodies[0], bodies[1]), own_joints(model, bodies[1], bodies[0])) <
      kFewestLegJoints)
    return {};
  std::vector<Foot> feet;
  for (const int body : {bodies[0], bodies[1]}) {
    Foot foot{body, inertia_box(model.bodies()[body], poses[body], between.head<2>().normalized())};
    if (foot.points.empty() || sizes_of(foot.points).maxCoeff() > kLargestFootBox * tall) return {};
    foot.lowest = lowest_of(foot.points);
    foot.of_inertia = true;
    feet.push_back(foot);
  }
  return feet;
}

// The two lowest end bodies that are beside each other. If a foot stands on more ground than the
// toe that it carries, the foot is taken and not the toe. An end body without any shape may be
// lower and have as many joints above it as these bodies. Then the shapes of the feet are missing,
// and the function finds no feet.
std::vector<Foot> find_feet(const RobotModel& model, const std::vector<Isometry3d>& poses) {
  std::vector<bool> leaf(model.bodies().size(), true);
  for (const Body& body : model.bodies())
    if (body.parent >= 0) leaf[body.parent] = false;
  std::vector<Foot> ends;
  const double highest = highest_joint(poses);
  std::vector<int> bare;  // end bodies that have no shape
  for (int body = 1; body < static_cast<int>(leaf.size()); ++body) {
    if (!leaf[body]) continue;
    Foot foot{body, body_points(model, poses, body), 0};
    foot.lowest = lowest_of(foot.points);
    for (int up = model.bodies()[body].parent; up > 0; up = model.bodies()[up].parent) {
      const Points points = body_points(model, poses, up);
      const double lowest = lowest_of(points);
      if (lowest > foot.lowest + kTouching ||
          touching_area(points, lowest) <= touching_area(foot.points, foot.lowest))
        break;
      foot = {up, points, lowest};
    }
    if (!foot.points.empty())
      ends.push_back(foot);
    else
      bare.push_back(body);
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const Foot& a, const Foot& b) { return a.lowest < b.lowest; });
  for (size_t i = 0; i < ends.size(); ++i)
    for (size_t j = i + 1; j < ends.size(); ++j) {
      const Foot &a = ends[i], &b = ends[j];
      const Vector3d between = poses[a.body].translation() - poses[b.body].translation();
      if (b.lowest > a.lowest + kSameHeight * (highest - a.lowest)) break;
      if (between.head<2>().norm() < kApart || is_above(model, a.body, b.body) ||
          is_above(model, b.body, a.body))
        continue;
      const int joints = std::min(joints_above(model, a.body), joints_above(model, b.body));
      for (const int body : bare)
        if (poses[body].translation().z() < a.lowest && joints_above(model, body) >= joints)
          return feet_without_shapes(model, poses, bare);
      return {a, b};
    }
  return feet_without_shapes(model, poses, bare);
}

// End bodies that stand on the ground beside the feet, such as the other feet of a robot with four
// legs. Toes, which a foot carries, are not among them.
std::vector<std::string> other_links_on_the_ground(const RobotModel& model,
                                                   const std::vector<Isometry3d>& poses,
                                                   const std::vector<Foot>& feet) {
  std::vector<std::string> found;
  std::vector<bool> leaf(model.bodies().size(), true);
  for (const Body& body : model.bodies())
    if (body.parent >= 0) leaf[body.parent] = false;
  const double ground = std::max(feet[0].lowest, feet[1].lowest) + kTouching;
  for (int body = 1; body < static_cast<int>(leaf.size()); ++body) {
    if (!leaf[body] || is_above(model, feet[0].body, body) || is_above(model, feet[1].body, body))
      continue;
    if (lowest_of(body_points(model, poses, body)) <= ground)
      found.push_back(model.bodies()[body].name);
  }
  return found;
}

// ---- facing

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Returns +1 if the first of the two names is the left one, -1 if it is the right one, and 0 if the
// names do not say it.
int first_is_left(const std::string& first, const std::string& second) {
  const std::string a = lower_case(first), b = lower_case(second);
  const auto has = [](const std::string& name, const char* word) {
    return name.find(word) != std::string::npos;
  };
  if (has(a, "left") && has(b, "right")) return 1;
  if (has(a, "right") && has(b, "left")) return -1;
  if (a.size() != b.size()) return 0;
  int side = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    const int here = a[i] == 'l' && b[i] == 'r' ? 1 : a[i] == 'r' && b[i] == 'l' ? -1 : 0;
    if (here == 0 || (side != 0 && side != here)) return 0;
    side = here;
  }
  return side;
}

// Names of the links and joints from two feet upwards.
int first_foot_is_left(const RobotModel& model, int first, int second) {
  while (first > 0 && second > 0) {
    const Body &a = model.bodies()[first], &b = model.bodies()[second];
    for (const int side : {first_is_left(a.name, b.name),
                           first_is_left(model.dofs()[a.dof].name, model.dofs()[b.dof].name)})
      if (side != 0) return side;
    first = a.parent;
    second = b.parent;
  }
  return 0;
}

std::string nearest_facing(const Vector3d& direction) {
  std::string best;
  double most = -2;
  for (const std::string& name : facing_names()) {
    const double along = facing_direction(name).dot(direction);
    if (along > most) {
      most = along;
      best = name;
    }
  }
  return best;
}

void find_facing(const RobotModel& model, RobotGuess& guess) {
  const std::vector<Isometry3d> poses = body_poses(model, zero_posture(model));
  const std::vector<Foot> feet = find_feet(model, poses);
  if (feet.empty()) {
    guess.facing_reason = {"no feet were recognized, so Ayumi assumes that the robot looks along x",
                           "in the picture that the robot looks along x"};
    return;
  }
  Vector3d across = poses[feet[0].body].translation() - poses[feet[1].body].translation();
  across.z() = 0;
  const Vector3d ahead =
      across.normalized().cross(Vector3d::UnitZ());  // if the first foot is the left one
  double front = 0, back = 0;
  for (const Foot& foot : feet)
    for (const Vector3d& point : foot.points) {
      const double along = (point - poses[foot.body].translation()).dot(ahead);
      front = std::max(front, along);
      back = std::max(back, -along);
    }
  const int toes = front > kLongerEnd * back ? 1 : back > kLongerEnd * front ? -1 : 0;
  const int named = first_foot_is_left(model, feet[0].body, feet[1].body);
  const std::string ends = text::fixed(1e3 * std::max(front, back), 0) + " mm and " +
                           text::fixed(1e3 * std::min(front, back), 0) + " mm";
  if (named != 0) {
    guess.facing = nearest_facing(named * ahead);
    guess.facing_reason.why =
        "the names of the legs say which leg is the left leg. If the robot looks along this axis, "
        "the "
        "left leg is on its left side";
    if (toes == -named)
      guess.facing_reason.why +=
          ". But then the feet reach farther to the back than to the front (" + ends +
          " from the ankles)";
  } else if (toes != 0) {
    guess.facing = nearest_facing(toes * ahead);
    guess.facing_reason.why =
        "along this axis, the feet reach farther from the ankles than in the opposite direction (" +
        ends + ")";
  } else {
    guess.facing =
        nearest_facing(ahead.x() < 0 || (ahead.x() == 0 && ahead.y() < 0) ? -ahead : ahead);
    guess.facing_reason.why =
        "the line between the feet is perpendicular to this axis. Names and shapes of the feet do "
        "not show which end of the feet is the front";
  }
  guess.facing_reason.check = "that the robot looks along the red arrow in the picture";
}

// ---- soles

// The attitude in which the foot comes to rest on the ground under a load at this place. It makes
// the facet of the hull below this place level. To find the facet, a triangle around the place is
// changed step by step: the lowest point below its plane replaces one of its corners, until no
// point is below the plane. Each step lowers the plane at the place.
Eigen::Matrix3d settled(const Points& points, const Vector2d& load) {
  // Corners of the first triangle [m] and rounding of the height over a plane [m]. Definition: far
  // outside of any foot, and far below the accuracy with which a sole is measured.
  constexpr double kFar = 1e3, kRounding = 1e-9;
  constexpr int kMostTurns = 1000;
  std::array<Vector3d, 3> facet;
  for (int i = 0; i < 3; ++i) {
    const double at = 2 * std::numbers::pi * i / 3;
    facet[i] = Vector3d(load.x() + kFar * elementary::cos(at),
                        load.y() + kFar * elementary::sin(at), kFar);
  }
  const auto normal = [&] {
    const Vector3d n = (facet[1] - facet[0]).cross(facet[2] - facet[0]);
    return Vector3d(n.z() < 0 ? -n : n);
  };
  const auto is_left = [&](const Vector3d& from, const Vector3d& to) {
    const Vector2d along = (to - from).head<2>(), there = load - from.head<2>();
    return along.x() * there.y() - along.y() * there.x() >= 0;
  };
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const Vector3d up = normal();
    if (!(up.z() > 0)) return Eigen::Matrix3d::Identity();
    double deepest = -kRounding;
    const Vector3d* lowest = nullptr;
    for (const Vector3d& point : points)
      if (const double above = up.dot(point - facet[0]) / up.z(); above < deepest) {
        deepest = above;
        lowest = &point;
      }
    if (!lowest) return rotation_between(up.normalized(), Vector3d::UnitZ()).toRotationMatrix();
    const std::array<Vector3d, 3> before = facet;
    for (int i = 0; i < 3; ++i) {  // counter-clockwise triangles; one of them holds the place
      facet = before;
      facet[i] = *lowest;
      if (is_left(facet[0], facet[1]) && is_left(facet[1], facet[2]) && is_left(facet[2], facet[0]))
        break;
    }
  }
  return Eigen::Matrix3d::Identity();
}

// Removes the corners one by one, first the corner whose removal takes away the least area; what is
// left lies inside.
std::vector<Vector2d> thinned(std::vector<Vector2d> corners) {
  const auto cut = [&](size_t i) {
    const size_t n = corners.size();
    const Vector2d a = corners[(i + n - 1) % n] - corners[i], b = corners[(i + 1) % n] - corners[i];
    return std::abs(a.x() * b.y() - a.y() * b.x());
  };
  while (corners.size() > kMostCorners) {
    size_t least = 0;
    for (size_t i = 1; i < corners.size(); ++i)
      if (cut(i) < cut(least)) least = i;
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return corners;
}

// `higher` becomes the size of the foot at the height kYielding.
SoleDescription sole_of(const RobotModel& model, const std::vector<Isometry3d>& poses,
                        const Foot& foot, Vector2d& higher) {
  const auto link = std::find_if(model.links().begin(), model.links().end(),
                                 [&](const Link& each) { return each.body == foot.body; });
  const Points& points = foot.points;
  const Vector3d ankle = poses[foot.body].translation();
  Points level = points;
  for (Vector3d& point : level) point -= ankle;
  // A foot can rest on the side under its ankle or on the side under its middle; the larger side is
  // its sole. A foot that stands level is not turned by the unevenness of its mesh.
  Vector2d low = level[0].head<2>(), high = low;
  for (const Vector3d& point : level) {
    low = low.cwiseMin(point.head<2>());
    high = high.cwiseMax(point.head<2>());
  }
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Points turned = level;
  double most = 2 * touching_area(level, lowest_of(level));
  for (const Vector2d& load : {Vector2d(Vector2d::Zero()), Vector2d(0.5 * (low + high))}) {
    const Eigen::Matrix3d other = settled(level, load);
    Points there = level;
    for (Vector3d& point : there) point = other * point;
    const double area = touching_area(there, lowest_of(there));
    if (area <= most || other(2, 2) < kMostTilt) continue;
    most = area;
    turn = other;
    turned = std::move(there);
  }
  const double lowest = lowest_of(turned);
  std::vector<Vector2d> touching;
  Eigen::AlignedBox2d yielding;
  for (const Vector3d& point : turned) {
    if (point.z() <= lowest + kTouching) touching.push_back(point.head<2>());
    if (point.z() <= lowest + kYielding) yielding.extend(point.head<2>().eval());
  }
  higher = yielding.sizes();
  SoleDescription sole;
  sole.link = link->name;
  Isometry3d frame = Isometry3d::Identity();  // frame of the sole in the root frame
  frame.linear() = turn.transpose();
  frame.translation() = ankle + turn.transpose() * Vector3d(0, 0, lowest);
  sole.frame = (poses[foot.body] * link->pose).inverse() * frame;
  sole.polygon = thinned(ConvexPolygon(touching).vertices());
  const auto first = std::min_element(
      sole.polygon.begin(), sole.polygon.end(),
      [](const Vector2d& a, const Vector2d& b) { return a.sum() < b.sum() - kTouching; });
  std::rotate(sole.polygon.begin(), first, sole.polygon.end());
  return sole;
}

Vector2d extent(const SoleDescription& sole) {
  Vector2d low = sole.polygon[0], high = low;
  for (const Vector2d& corner : sole.polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  return high - low;
}

std::string size_text(const Vector2d& size) {
  return text::fixed(1000 * size.x(), 0) + " x " + text::fixed(1000 * size.y(), 0) + " mm";
}

void find_soles(RobotGuess& guess) {
  RobotDescription& robot = guess.robot;
  const RobotModel model(robot);
  const std::vector<Isometry3d> poses = body_poses(model, zero_posture(model));
  std::vector<Foot> feet = find_feet(model, poses);
  if (feet.empty()) {
    robot.assumptions.push_back("no feet were recognized, so the robot has no soles");
    return;
  }
  if (poses[feet[0].body].translation().y() < poses[feet[1].body].translation().y())
    std::swap(feet[0], feet[1]);
  std::map<std::string, SoleDescription> soles;
  for (const int side : {0, 1}) {
    const std::string name = side == 0 ? "left" : "right";
    Vector2d higher;
    const SoleDescription sole = sole_of(model, poses, feet[side], higher);
    if (sole.polygon.size() < 3 || extent(sole).prod() < kSmallestSole ||
        extent(sole).maxCoeff() > kLargestSole) {
      robot.assumptions.push_back("with every joint at 0, the " + name + " foot " + sole.link +
                                  " has no flat underside, so the robot has no soles");
      return;
    }
    soles[name] = sole;
    if (guess.rounded_soles.empty() && (higher.array() > kRounded * extent(sole).array()).any())
      guess.rounded_soles =
          "The undersides of the feet are rounded: the sole of the " + name + " foot measures " +
          size_text(extent(sole)) + ", but " + text::fixed(1000 * kYielding, 0) +
          " mm above the ground the foot measures " + size_text(higher) +
          ". If the soles are soft, find out which part of each sole carries the robot, and state "
          "the outline of this part. If the stated sole is too narrow, walks can be impossible.";
  }
  const std::vector<std::string> more = other_links_on_the_ground(model, poses, feet);
  if (!more.empty()) {
    guess.more_feet =
        "Ayumi moves robots that walk on two feet, but other links of this robot stand on the "
        "ground as well: " +
        text::join(more, ", ") +
        ". If these links are the feet, state their soles under \"soles\".";
    robot.assumptions.push_back("the feet are " + soles["left"].link + " and " +
                                soles["right"].link +
                                ", although these links stand on the ground "
                                "as well: " +
                                text::join(more, ", "));
  }
  for (auto& [side, sole] : soles)
    sole.source = feet[0].of_inertia ? SoleSource::inertias : SoleSource::shapes;
  robot.soles = soles;
  if (feet[0].of_inertia) {
    guess.sole_reason = {
        "the feet have no shapes, so Ayumi takes each foot as a box of even density with the mass, "
        "the centre of mass and the inertia of this foot. These values are from \"links\" if this "
        "sidecar states them, and otherwise from the robot's file. The undersides of the boxes are "
        "the soles",
        "the height, the length and the width of both soles on the robot"};
    return;
  }
  const bool collisions = std::any_of(
      model.links().begin(), model.links().end(),
      [&](const Link& link) { return link.body == feet[0].body && !link.collisions.empty(); });
  guess.sole_reason = {"the outline is the hull of all points of the foot's " +
                           std::string(collisions ? "collision shapes" : "visual shapes") +
                           " that are at most 1 mm above the ground. If this hull has more than " +
                           std::to_string(kMostCorners) + " corners, only " +
                           std::to_string(kMostCorners) + " of them are kept",
                       "that this is the outline of the part of the foot that touches the ground. "
                       "When in doubt, make the outline smaller"};
}

// ---- home posture

double leg_reach(const RobotModel& model, const RobotData& data, double* straight) {
  const auto& leg = model.leg(Side::left);
  // The hip is the point where the last axis above the knee passes.
  const InverseKinematics ik(model, zero_posture(model));
  const int knee = ik.knee(Side::left);
  Vector3d hip = data.pose(model.dofs()[leg.front()].body).translation();
  for (const int dof : leg) {
    if (dof == knee) break;
    hip = data.pose(model.dofs()[dof].body).translation();
  }
  const Vector3d sole = sole_pose(model, data, Side::left).translation();
  *straight = 0;
  Vector3d from = hip;
  bool below = false;
  for (const int dof : leg) {
    below |= dof == knee;
    if (!below) continue;
    const Vector3d to = data.pose(model.dofs()[dof].body).translation();
    *straight += (to - from).norm();
    from = to;
  }
  *straight += (sole - from).norm();
  return (sole - hip).norm();
}

bool within_limits(const RobotModel& model, const InverseKinematics& ik, const VectorXd& theta) {
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    const double room = std::min(kLimitRoom, 0.25 * (dof.upper - dof.lower));
    if (ik.solves(i) && (theta[i] < dof.lower + room || theta[i] > dof.upper - room)) return false;
  }
  return true;
}

// Bends the knees and puts the COG over the middle of the soles, with the other joints as in
// `zero`. Returns false if the legs cannot reach such a posture.
bool balance(RobotGuess& guess, const VectorXd& zero) {
  RobotDescription& robot = guess.robot;
  const RobotModel model(robot);
  try {
    const InverseKinematics ik(model, zero);
    RobotData data(model);
    RobotState state = model.rest_state();
    state.theta = zero;
    update_positions(model, state, data);
    double straight = 0;
    const double reach = leg_reach(model, data, &straight);
    PostureTarget target;
    target.trunk = data.rotation[model.trunk_body()];
    Vector3d middle = Vector3d::Zero();
    for (const Side side : {Side::left, Side::right}) {
      const Isometry3d sole = sole_pose(model, data, side);
      Isometry3d& foot = target.feet[static_cast<int>(side)];
      foot.translation() = Vector3d(0, sole.translation().y(), 0);
      const Vector2d center = model.sole(side).center;
      middle += 0.5 * (foot * Vector3d(center.x(), center.y(), 0));
    }
    const double height =
        data.cog.z() - 0.5 * (sole_pose(model, data, Side::left).translation().z() +
                              sole_pose(model, data, Side::right).translation().z());
    for (const double share : kReaches) {
      target.cog = middle + Vector3d(0, 0, height - (reach - share * straight));
      RobotState home = model.rest_state();
      home.theta = ik.start();
      home.base.position = target.cog - data.cog;
      const PostureSolution solution = ik.solve(target, home, data);
      if (!solution.reached || solution.knee_flipped || !within_limits(model, ik, home.theta))
        continue;
      auto& posture = robot.postures["home"];
      for (int i = 0; i < model.dof_count(); ++i)
        posture[model.dofs()[i].name] =
            std::round(home.theta[i] / kOneDegree * 1e3) / 1e3 * kOneDegree;
      const int knee = ik.knee(Side::left);
      const std::string bend =
          knee < 0
              ? ""
              : ", and the knees are at " + text::fixed(home.theta[knee] / kOneDegree, 0) + " deg";
      robot.assumptions.push_back("in the home posture, the COG is " +
                                  text::fixed(1e3 * target.cog.z(), 0) +
                                  " mm high over the middle of the soles" + bend);
      const bool human = knee < 0 ||
                         ik.positive_bends_forward(Side::left) == (home.theta[knee] > zero[knee]) ||
                         reach < 0.99 * straight;
      guess.home_reason = {
          "Ayumi computed a balanced posture. The soles are level, and the legs have " +
              text::fixed(100 * share, 1) + " % of their straight length. The COG is " +
              text::fixed(1e3 * target.cog.z(), 0) +
              " mm high over the middle of the soles, and every joint is inside its limits" +
              (knee < 0 ? ""
               : human
                   ? ". The knees bend forward like the knees of a human"
                   : ". The position limits do not let the knees bend forward far enough, so the "
                     "knees bend back"),
          "that the robot can stand in this posture, and that the arms do not touch the body"};
      return true;
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_model) throw;
  }
  return false;
}

// The arms and the legs of a robot at home, for the distances between them.
class ArmsBesideLegs {
 public:
  explicit ArmsBesideLegs(const RobotModel& model)
      : model_(model), collisions_(model), data_(model), ik_(model, model.posture()) {
    update_positions(model, model.rest_state(), data_);
    RobotData& data = data_;
    const double middle = 0.5 * (sole_pose(model, data, Side::left).translation().y() +
                                 sole_pose(model, data, Side::right).translation().y());
    const double apart = std::abs(sole_pose(model, data, Side::left).translation().y() - middle);
    const auto bodies = static_cast<int>(model.bodies().size());
    std::vector<char> carries_leg(model.bodies().size(), 0);
    for (const Side side : {Side::left, Side::right})
      for (int body = model.sole(side).body; body > 0; body = model.bodies()[body].parent)
        ++carries_leg[static_cast<size_t>(body)];
    std::vector<char> in_leg(model.bodies().size(), 0);
    for (int body = 1; body < bodies; ++body) {  // parents first
      const auto at = static_cast<size_t>(body);
      in_leg[at] = carries_leg[at] == 1 || in_leg[static_cast<size_t>(model.bodies()[body].parent)];
      const double beside = data.position[body].y() - middle;
      if (in_leg[at])
        legs_.push_back(body);
      else if (carries_leg[at] == 0 && std::abs(beside) > kBesideTrunk * apart)
        arms_[beside > 0 ? 0 : 1].push_back(body);
    }
    const double height = data.cog.z() - sole_pose(model, data, Side::left).translation().z();
    wanted_ = kArmClearance * height;
    postures_.push_back(model.posture());
    PostureTarget lower;
    lower.trunk = data.rotation[model.trunk_body()];
    for (const Side side : {Side::left, Side::right})
      lower.feet[static_cast<size_t>(side)] = sole_pose(model, data, side);
    lower.cog = data.cog - Vector3d(0, 0, kLowered * height);
    RobotState state = model.rest_state();
    if (ik_.solve(lower, state, data).reached) postures_.push_back(state.theta);
  }

  double wanted() const { return wanted_; }
  const std::vector<int>& bodies(int side) const { return arms_[side]; }

  /// Smallest distance of the arm on this side from the legs, if joints of the arms are moved [m].
  double clearance(int side, const std::map<int, double>& moved) {
    double least = std::numeric_limits<double>::infinity();
    for (const VectorXd& posture : postures_) {
      RobotState state = model_.rest_state();
      state.theta = posture;
      for (const auto& [dof, angle] : moved) state.theta[dof] += angle;
      update_positions(model_, state, data_);
      for (const int arm : arms_[side])
        for (const int leg : legs_)
          if (!collisions_.shapes(arm).empty() && !collisions_.shapes(leg).empty())
            least = std::min(least, collisions_.clearance({std::min(arm, leg), std::max(arm, leg)},
                                                          data_, wanted_));
    }
    return least;
  }

  /// Whether the arm on this side overlaps the trunk, the head or the other arm.
  bool meets_trunk(int side, const std::map<int, double>& moved) {
    RobotState state = model_.rest_state();
    for (const auto& [dof, angle] : moved) state.theta[dof] += angle;
    update_positions(model_, state, data_);
    const auto is_of = [](const std::vector<int>& bodies, int body) {
      return std::find(bodies.begin(), bodies.end(), body) != bodies.end();
    };
    return std::any_of(collisions_.pairs().begin(), collisions_.pairs().end(), [&](const auto& p) {
      return (is_of(arms_[side], p.a) || is_of(arms_[side], p.b)) && !is_of(legs_, p.a) &&
             !is_of(legs_, p.b) && collisions_.clearance(p, data_, kClearOfTrunk) < kClearOfTrunk;
    });
  }

 private:
  // Smallest distance of a moved arm from the trunk [m]. Source: the clearance below which the
  // check warns (limits/clearance).
  static constexpr double kClearOfTrunk = 0.002;
  // Distance of an arm from the middle, in half distances of the soles, above which it is not part
  // of the trunk. Chosen: neck and waist are at 0, shoulders beside the hips or farther.
  static constexpr double kBesideTrunk = 0.25;
  // Distance of the arms from the legs, in COG heights. Chosen: 17 mm on a robot of HOAP-1's size;
  // in a walk, its legs move aside and its knees come forward by less. With it, humanoid30's arms
  // go out by 10 deg, and GR001's by 5 deg.
  static constexpr double kArmClearance = 0.07;
  // The lower posture in which the arms must also be clear of the legs, in COG heights below home.
  // Chosen: the depth of a squat, and of the heights that a search for a walk tries.
  static constexpr double kLowered = 0.12;

  const RobotModel& model_;
  CollisionModel collisions_;
  RobotData data_;
  InverseKinematics ik_;
  std::vector<VectorXd> postures_;
  std::vector<int> legs_;
  std::array<std::vector<int>, 2> arms_;  // left and right
  double wanted_ = 0;
};

// Angles by which joints of the arms are moved, so that the arms do not come near the legs. If one
// joint is sufficient, only this joint is moved, by the smallest angle.
std::map<int, double> arms_aside(const RobotModel& model) {
  // Angles that are tried, and joints that are moved. Chosen: arms beside the legs are clear of
  // them with 10 to 25 deg of one shoulder joint.
  constexpr double kStep = 5 * kOneDegree, kMost = 60 * kOneDegree;
  constexpr int kJoints = 2;
  // If two joints have the same effect, the first one is moved [m]. Definition: above rounding.
  constexpr double kLeastGain = 1e-6;
  ArmsBesideLegs robot(model);
  std::map<int, double> moved;
  for (const int side : {0, 1}) {
    double best = robot.clearance(side, moved);
    for (int joint = 0; joint < kJoints && best < robot.wanted(); ++joint) {
      std::map<int, double> found = moved;
      for (int step = 1; step * kStep <= kMost && best < robot.wanted(); ++step)
        for (const int body : robot.bodies(side)) {
          const int dof = model.bodies()[body].dof;
          if (dof < 0 || model.dofs()[dof].prismatic || moved.contains(dof)) continue;
          for (const double angle : {step * kStep, -step * kStep}) {
            const double at = model.posture()[dof] + angle;
            if (at < model.dofs()[dof].lower + kLimitRoom ||
                at > model.dofs()[dof].upper - kLimitRoom)
              continue;
            std::map<int, double> trial = moved;
            trial[dof] = angle;
            const double there = robot.clearance(side, trial);
            if (there <= best + kLeastGain || robot.meets_trunk(side, trial)) continue;
            best = there;
            found = trial;
          }
        }
      if (found == moved) break;
      moved = found;
    }
  }
  return moved;
}

// A balanced posture whose arms are clear of the legs.
bool find_home(RobotGuess& guess) {
  const RobotModel model(guess.robot);
  if (!model.has_soles()) return false;
  VectorXd start = zero_posture(model);
  if (!balance(guess, start)) return false;
  const std::map<int, double> moved = arms_aside(RobotModel(guess.robot));
  if (moved.empty()) return true;
  RobotGuess with_arms = guess;
  with_arms.robot.postures.erase("home");
  with_arms.robot.assumptions.pop_back();  // the assumption about the posture that was found before
  std::vector<std::string> names;
  for (const auto& [dof, angle] : moved) {
    start[dof] += angle;
    names.push_back(model.dofs()[dof].name + " by " + text::fixed(angle / kOneDegree, 0) + " deg");
  }
  if (!balance(with_arms, start)) return true;
  guess = std::move(with_arms);
  guess.home_reason.why +=
      ". The arms would come too near to the legs, so these joints move the arms aside: " +
      text::join(names, ", ");
  return true;
}

// ---- servos

double cog_height(const RobotModel& model) {
  const std::vector<Isometry3d> poses = body_poses(model, zero_posture(model));
  double moment = 0, lowest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < poses.size(); ++i)
    moment += model.bodies()[i].inertia.mass * (poses[i] * model.bodies()[i].inertia.com).z();
  for (const Isometry3d& pose : poses) lowest = std::min(lowest, pose.translation().z());
  if (model.has_soles()) {
    const Sole& sole = model.sole(Side::left);
    lowest = std::min(lowest, (poses[sole.body] * sole.frame).translation().z());
  }
  return std::max(moment / model.mass() - lowest, 0.01);
}

const JointDescription& joint_of(const RobotModel& model, int dof) {
  const auto& joints = model.description().joints;
  return *std::find_if(joints.begin(), joints.end(), [&](const JointDescription& each) {
    return each.name == model.dofs()[dof].name;
  });
}

bool is_of_leg(const RobotModel& model, int dof) {
  if (!model.has_soles()) return false;
  for (const Side side : {Side::left, Side::right})
    for (const int each : model.leg(side))
      if (each == dof) return true;
  return false;
}

bool is_placeholder(const std::vector<PlaceholderLimits>& placeholders, const std::string& what,
                    const std::string& joint) {
  return std::any_of(placeholders.begin(), placeholders.end(), [&](const PlaceholderLimits& each) {
    return each.what == what &&
           std::find(each.joints.begin(), each.joints.end(), joint) != each.joints.end();
  });
}

double to_digits(double value, int digits) { return std::stod(text::brief(value, digits)); }

// The inertia that each joint moves while the robot is in the air in its home posture and all other
// joints are held [kg m^2, kg]. It does not depend on which link is the root.
VectorXd inertias_in_the_air(const RobotModel& model) {
  RobotData data(model);
  update_positions(model, model.rest_state("home"), data);
  Eigen::MatrixXd mass;
  mass_matrix(model, data, mass);
  const Eigen::Matrix<double, 6, Eigen::Dynamic> coupling = mass.topRows<6>();
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>> base(mass.topLeftCorner<6, 6>());
  VectorXd inertias(model.dof_count());
  for (int i = 0; i < model.dof_count(); ++i) {
    const Eigen::Matrix<double, 6, 1> column = coupling.col(6 + i);
    // Rounding may leave less than 0 for a link without mass.
    inertias[i] = std::max(0.0, mass(6 + i, 6 + i) - column.dot(base.solve(column)));
  }
  return inertias;
}

void find_servos(RobotGuess& guess) {
  RobotDescription& robot = guess.robot;
  const RobotModel model(robot);
  const double z = cog_height(model), weight = model.mass() * kGravity;
  const VectorXd inertias = inertias_in_the_air(model);
  // The smallest and the largest kd/kp [s].
  double quickest = std::numeric_limits<double>::infinity(), slowest = 0;
  size_t estimated = 0, inferred = 0;
  for (int i = 0; i < model.dof_count(); ++i) {
    const Dof& dof = model.dofs()[i];
    const JointDescription& joint = joint_of(model, i);
    const bool leg = is_of_leg(model, i);
    // MJCF states servos and passive joints; for a motor, it states everything except the gains.
    const auto stated = robot.servos.find(dof.name);
    if (stated != robot.servos.end() && (stated->second.kp > 0 || joint.effort <= 0)) continue;
    ++inferred;
    double effort = joint.effort;
    if (effort <= 0 || is_placeholder(guess.placeholders, "effort limits", joint.name)) {
      // A sliding joint gets the force of a turning joint with the COG height as its lever.
      effort = (leg ? kLegEffort : kOtherEffort) * weight * (dof.prismatic ? 1 : z);
      ++estimated;
    }
    // Unit of the constants, which is metres instead of radians for a sliding joint.
    const double unit = dof.prismatic ? z : 1;
    ServoDescription servo;
    servo.kp = effort / (kFullEffortError * unit);
    if (leg) servo.kp = std::max(servo.kp, kLegStiffness * weight * z / (unit * unit));
    servo.kp = to_digits(servo.kp, 3);
    servo.rotor_inertia = to_digits(kInertiaPerEffort * effort / unit, 2);
    servo.viscous = joint.damping;
    servo.coulomb = joint.friction;
    if (stated != robot.servos.end() && stated->second.rotor_inertia > 0)
      servo.rotor_inertia = stated->second.rotor_inertia;
    servo.kd =
        to_digits(2 * kDampingRatio * std::sqrt(servo.kp * (inertias[i] + servo.rotor_inertia)), 2);
    quickest = std::min(quickest, servo.kd / servo.kp);
    slowest = std::max(slowest, servo.kd / servo.kp);
    robot.servos[dof.name] = servo;
  }
  robot.servos_inferred = inferred > 0;
  if (inferred == 0) {
    guess.servo_reason = {"the actuators in the robot's file state these constants",
                          "that the robot's own servos have these gains"};
    return;
  }
  guess.servo_reason = {
      "kp is the effort limit of the joint divided by " + text::brief(kFullEffortError) +
          " rad. For legs, kp is at least " + text::brief(kLegStiffness) +
          " times the weight times the COG height (" + text::brief(kLegStiffness * weight * z, 3) +
          " N m/rad), so that the legs hold the robot. kd = 2 sqrt(kp I) damps the joint "
          "critically. "
          "Here I is the inertia that the joint and its rotor move while the robot is in the air. "
          "So the lag of the servos, kd/kp, is from " +
          text::brief(1e3 * quickest, 2) + " to " + text::brief(1e3 * slowest, 2) +
          " ms, and the servo targets compensate this lag" +
          (estimated == 0
               ? ""
               : ". The effort limits of " + std::to_string(estimated) +
                     " joints are missing or placeholders. For these joints, Ayumi takes " +
                     text::brief(kLegEffort) + " times the weight times the COG height (" +
                     text::brief(kLegEffort * weight * z, 3) + " N m) in the legs, and " +
                     text::brief(kOtherEffort) + " times weight times COG height elsewhere"),
      "the gains and the rotor inertia of your servos. `ayumi identify` finds the gains in a "
      "recording"};
  robot.assumptions.push_back("servos: " + guess.servo_reason.why);
}

}  // namespace

void hold_joint(RobotDescription& robot, JointDescription& joint) {
  joint.type = JointType::fixed;
  joint.mimic.clear();
  std::erase(robot.joint_order, joint.name);
}

std::vector<std::string> hold_joints_without_mass(RobotDescription& robot) {
  std::map<std::string, double> mass;  // mass of a link and of all that it carries
  std::map<std::string, const JointDescription*> above;
  for (const JointDescription& joint : robot.joints) above[joint.child] = &joint;
  for (const LinkDescription& link : robot.links) {
    const std::string* name = &link.name;
    // A loop of joints is reported later.
    for (size_t steps = 0; steps <= robot.joints.size(); ++steps) {
      mass[*name] += link.inertia.mass;
      const auto joint = above.find(*name);
      if (joint == above.end()) break;
      name = &joint->second->parent;
    }
  }
  const auto moves = [](const JointDescription& joint) {
    return joint.type != JointType::fixed && joint.type != JointType::floating;
  };
  if (std::none_of(robot.joints.begin(), robot.joints.end(), [&](const JointDescription& joint) {
        return moves(joint) && mass[joint.child] > 0;
      }))
    return {};  // a robot that could not move at all is an error of its file
  std::vector<std::string> held;
  for (JointDescription& joint : robot.joints) {
    if (!moves(joint) || mass[joint.child] > 0) continue;
    hold_joint(robot, joint);
    held.push_back(joint.name);
  }
  if (!held.empty())
    robot.assumptions.push_back(
        "these joints carry no mass, so Ayumi holds them at 0: " + text::join(held, ", ") +
        ". To move a joint, give its link a mass and an inertia");
  return held;
}

namespace {

/// Whether a motor moves a joint whose actuator the files state.
bool is_driven(const RobotDescription& robot, const JointDescription& joint) {
  const auto servo = robot.servos.find(joint.name);
  return servo != robot.servos.end() && (servo->second.kp > 0 || joint.effort > 0);
}

}  // namespace

std::vector<std::string> passive_joints(const RobotDescription& robot) {
  std::vector<std::string> passive;
  for (const JointDescription& joint : robot.joints)
    if (joint.type != JointType::fixed && joint.mimic.empty() &&
        robot.servos.contains(joint.name) && !is_driven(robot, joint))
      passive.push_back(joint.name);
  return passive;
}

std::vector<std::string> gaps_of_the_files(const RobotDescription& robot, size_t most) {
  std::vector<std::string> gaps;
  const std::vector<std::string> passive = passive_joints(robot);
  if (!passive.empty())
    gaps.push_back("joints without an actuator are passive: " + text::join(passive, ", "));
  const std::vector<std::string>& missing = robot.missing_meshes;
  if (!missing.empty())
    gaps.push_back(
        text::counted(missing.size(), "mesh", "meshes") +
        (missing.size() == 1 ? " is missing and left out: " : " are missing and left out: ") +
        text::join_first(missing, most) +
        (missing.size() > most ? " (`ayumi inspect` lists all of them)" : "") +
        ". Add the files, correct the names, or name the folder with the packages with "
        "--package-path");
  return gaps;
}

std::vector<std::string> hold_play_of_gears(RobotDescription& robot) {
  // Largest range of a passive joint that is the play of a gear [rad]. Chosen: worn hobby servos
  // have 2 deg; toes and springs move by 10 deg and more.
  constexpr double kMostPlay = 4 * kOneDegree;
  // Smallest cosine of the angle between two axes that count as parallel. Definition: rounding the
  // axes to six digits causes a smaller deviation.
  constexpr double kParallel = 1 - 1e-9;
  std::vector<std::string> held, driven;
  for (JointDescription& play : robot.joints) {
    if (play.type != JointType::revolute || !play.has_limits || !play.mimic.empty() ||
        play.upper - play.lower > kMostPlay || !robot.servos.contains(play.name) ||
        is_driven(robot, play))
      continue;
    for (const JointDescription& motor : robot.joints) {
      if (!is_driven(robot, motor)) continue;
      const bool above = motor.child == play.parent, below = motor.parent == play.child;
      const JointDescription &first = above ? motor : play, &second = above ? play : motor;
      if ((!above && !below) || std::abs(first.axis.normalized().dot(
                                    second.origin.linear() * second.axis.normalized())) < kParallel)
        continue;
      robot.servos[motor.name].backlash = play.upper - play.lower;
      robot.servos.erase(play.name);
      hold_joint(robot, play);
      held.push_back(play.name);
      driven.push_back(motor.name);
      break;
    }
  }
  if (!held.empty())
    robot.assumptions.push_back(
        "some passive joints have a small range and the axis of a motor beside them. Ayumi takes "
        "the range of such a joint as the play of the motor's gear, and holds the joint at 0. So "
        "the servos of these joints have a backlash: " +
        text::join(driven, ", "));
  return held;
}

std::vector<PlaceholderLimits> placeholder_limits(const RobotModel& model) {
  std::vector<PlaceholderLimits> found;
  const double moment = model.mass() * kGravity * cog_height(model);
  std::map<std::pair<double, double>, std::vector<std::string>> ranges;
  std::map<double, std::vector<std::string>> speeds, efforts;
  for (int i = 0; i < model.dof_count(); ++i) {
    const JointDescription& joint = joint_of(model, i);
    if (model.dofs()[i].prismatic) continue;
    if (model.dofs()[i].limited) ranges[{joint.lower, joint.upper}].push_back(joint.name);
    speeds[joint.velocity].push_back(joint.name);
    efforts[joint.effort].push_back(joint.name);
  }
  const auto count = static_cast<double>(model.dof_count());
  const bool many = static_cast<size_t>(model.dof_count()) >= kManyJoints;
  std::set<std::string> legs;
  for (int i = 0; i < model.dof_count(); ++i)
    if (is_of_leg(model, i)) legs.insert(model.dofs()[i].name);
  const auto share_of_legs = [&](const std::vector<std::string>& joints) {
    const auto among = std::count_if(joints.begin(), joints.end(), [&](const std::string& joint) {
      return legs.contains(joint);
    });
    return legs.size() < kManyJoints
               ? 0.0
               : static_cast<double>(among) / static_cast<double>(legs.size());
  };
  for (const auto& [range, joints] : ranges)
    if (many && (static_cast<double>(joints.size()) >= kSameLimits * count ||
                 share_of_legs(joints) >= kSameLimits))
      found.push_back({"position limits",
                       text::fixed(range.first / kOneDegree, 0) + " to " +
                           text::fixed(range.second / kOneDegree, 0) + " deg",
                       joints});
  for (const auto& [speed, joints] : speeds)
    if (speed > kGreatestSpeed)
      found.push_back({"speed limits", text::brief(speed) + " rad/s", joints});
  for (const auto& [effort, joints] : efforts)
    if (effort > kGreatestEffort * moment ||
        (many && effort > moment &&
         (joints.size() == static_cast<size_t>(count) || share_of_legs(joints) == 1)))
      found.push_back({"effort limits", text::brief(effort) + " N m", joints});
  return found;
}

std::string direction_in_words(const RobotModel& model, int dof) {
  const VectorXd home = model.posture();
  const std::vector<Isometry3d> poses = body_poses(model, home);
  const int body = model.dofs()[dof].body;
  if (model.has_soles()) {
    const InverseKinematics ik(model, home);
    for (const Side side : {Side::left, Side::right}) {
      if (ik.knee(side) != dof) continue;
      const bool bends = ik.positive_bends_forward(side);
      return bends ? "a positive angle bends the knee" : "a positive angle straightens the knee";
    }
  }
  // The motion of the centre of mass of the part that the joint carries, in the trunk's axes. If
  // the axis passes through the centre of mass, it is the rotation itself.
  VectorXd moved = home;
  moved[dof] += 0.01;
  const std::vector<Isometry3d> after = body_poses(model, moved);
  double mass = 0;
  Vector3d shift = Vector3d::Zero(), center = Vector3d::Zero();
  for (size_t i = 1; i < poses.size(); ++i) {
    if (!is_above(model, body, static_cast<int>(i))) continue;
    const Inertia& inertia = model.bodies()[i].inertia;
    mass += inertia.mass;
    center += inertia.mass * (poses[i] * inertia.com);
    shift += inertia.mass * (after[i] * inertia.com - poses[i] * inertia.com);
  }
  const Eigen::Matrix3d trunk = poses[model.trunk_body()].linear();
  const Vector3d axis = trunk.transpose() * (poses[body].linear() * model.bodies()[body].axis) *
                        model.bodies()[body].ratio;
  const std::string carried = model.bodies()[body].name;
  int major = 0;
  axis.cwiseAbs().maxCoeff(&major);
  if (!model.dofs()[dof].prismatic) {
    const bool positive = axis[major] > 0;
    if (major == 2)
      return "a positive angle turns " + carried + " to the " + (positive ? "left" : "right");
    if (major == 0 && model.has_soles() &&
        (model.sole(Side::left).body == body || model.sole(Side::right).body == body))
      return std::string("a positive angle raises the ") + (positive ? "left" : "right") +
             " edge of the foot";
    if (major == 1 && model.has_soles())
      for (const Side side : {Side::left, Side::right})
        if (is_above(model, body, model.sole(side).body)) {
          const InverseKinematics ik(model, home);
          const int knee = ik.knee(side);
          if (knee >= 0 && is_above(model, model.dofs()[knee].body, body))
            return std::string("a positive angle turns the toes ") + (positive ? "down" : "up");
          return std::string("a positive angle swings the leg ") + (positive ? "back" : "forward");
        }
  }
  shift = trunk.transpose() * shift / std::max(mass, 1e-12);
  shift.cwiseAbs().maxCoeff(&major);
  const bool positive = shift[major] > 0;
  const char* words[3][2] = {{"back", "forward"}, {"to the right", "to the left"}, {"down", "up"}};
  return std::string("a positive ") + (model.dofs()[dof].prismatic ? "displacement" : "angle") +
         " moves " + carried + " " + words[major][positive ? 1 : 0];
}

std::string inferred_soles(const RobotDescription& robot) {
  std::vector<std::string> sizes;
  bool of_inertia = false;
  for (const auto& [side, sole] : robot.soles) {
    if (sole.source == SoleSource::stated || sole.polygon.empty()) continue;
    of_inertia = sole.source == SoleSource::inertias;
    sizes.push_back(side + " " + sole.link + ", " + size_text(extent(sole)) + ", " +
                    std::to_string(sole.polygon.size()) + " corners");
  }
  if (sizes.empty()) return "";
  return std::string("soles inferred from ") +
         (of_inertia ? "the masses and inertias of the feet, because the feet have no shapes: "
                     : "the points of the feet that are at most 1 mm above the ground: ") +
         text::join(sizes, "; ");
}

RobotGuess guess_robot(RobotDescription robot) {
  RobotGuess guess;
  guess.robot = std::move(robot);
  RobotDescription& files = guess.robot;
  if (files.soles.empty()) {
    if (files.sidecar_file.empty()) {
      find_facing(RobotModel(files), guess);
      turn_to_face_x(files, guess.facing);
      if (guess.facing != "x")
        files.assumptions.push_back("the robot looks along the axis " + guess.facing +
                                    " of its root link, because " + guess.facing_reason.why);
    }
    find_soles(guess);
  }
  if (const std::string soles = inferred_soles(files); !soles.empty())
    files.assumptions.push_back(soles);
  guess.placeholders = placeholder_limits(RobotModel(files));
  if (!files.postures.contains("home") && !find_home(guess)) {
    const RobotModel model(files);
    files.postures["home"] = model.description().postures.at("home");
    guess.home_reason = {
        "no balanced posture with bent knees was found inside the position limits, so every joint "
        "is "
        "at 0, or at its limit nearest to 0",
        "this posture, and bend the knees by 30 to 45 deg, because a straight leg can hardly move"};
    files.assumptions.push_back(
        "in the home posture, every joint is at 0, or at its limit nearest to 0");
  }
  if (files.servos.empty() || files.sidecar_file.empty()) find_servos(guess);
  for (const PlaceholderLimits& each : guess.placeholders)
    files.assumptions.push_back(each.what + " of " + each.value + " on " +
                                std::to_string(each.joints.size()) +
                                " joints are probably placeholders");
  if (files.profiles.empty())
    files.assumptions.push_back(
        "the actuator limits are the velocity and the effort in the URDF; a value of 0 means that "
        "there is no limit");
  return guess;
}

}  // namespace ayumi
