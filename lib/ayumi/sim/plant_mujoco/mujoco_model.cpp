// Groups of geoms that may touch (contype): balls of the robot (1) touch the ground (2), and plates
// of soles (4) touch rods and fields under them (8).
#include "ayumi/sim/plant_mujoco/mujoco_model.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstring>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kBall = kMujocoBall;
/// Thickness of a sole's plate [m]. Chosen: thicker than an edge penetrates within a step, so that
/// the edge does not pass through.
constexpr double kPlate = 0.004;
/// Depth of blocks and fields below the ground [m]. Chosen: a body cannot pass through within a
/// step.
constexpr double kDepth = 0.2;
/// Width of the ground around a height field that dips below the plane [m]. Chosen: longer than any
/// run of a humanoid.
constexpr double kWide = 50;
/// If a body has at most this number of points, all of them are kept. Chosen: the corners of four
/// boxes; bodies with more points are meshes.
constexpr size_t kFewPoints = 32;
/// Largest numbers of contacts and of rows of constraints at once. Chosen: every point of a robot
/// of 20 bodies that lies on the ground.
constexpr int kMostContacts = 600, kMostRows = 4000;
constexpr const char* kUnderBall = "' contype='2' conaffinity='1'/>";
constexpr const char* kUnderPlate = "' contype='8' conaffinity='4'/>";
constexpr const char* kUnderBoth = "' contype='10' conaffinity='5'/>";

std::string triple(const Vector3d& v) {
  return text::exact(v.x()) + " " + text::exact(v.y()) + " " + text::exact(v.z());
}

std::string quadruple(const Quaterniond& q) {
  return text::exact(q.w()) + " " + text::exact(q.x()) + " " + text::exact(q.y()) + " " +
         text::exact(q.z());
}

std::string box_text(const Vector3d& low, const Vector3d& high) {
  return "<geom type='box' size='" + triple(0.5 * (high - low)) + "' pos='" +
         triple(0.5 * (high + low)) + kUnderBall;
}

/// A rod inside the block whose upper side is the edge a-b of the block's top.
std::string rod_text(const Vector2d& a, const Vector2d& b, double height) {
  const Vector2d along = (b - a).normalized(), inward(-along.y(), along.x());
  Vector3d from, to;
  from << a + kBall * (along + inward), height - kBall;
  to << b + kBall * (inward - along), height - kBall;
  return "<geom type='capsule' size='" + text::exact(kBall) + "' fromto='" + triple(from) + " " +
         triple(to) + kUnderPlate;
}

std::string block_text(const GroundBlock& block, double ground) {
  std::array<Vector2d, 8> corner;
  const int n = block_corners(block, corner);
  const double bottom = std::min(ground, block.height) - kDepth;
  std::string out;
  if (block.kind == GroundBlock::Kind::disc) {
    const double half = 0.5 * (block.height - bottom);
    out = "<geom type='cylinder' size='" + text::exact(block.radius) + " " + text::exact(half) +
          "' pos='" + triple({block.center.x(), block.center.y(), bottom + half}) + kUnderBall;
  } else {
    out = box_text({block.low.x(), block.low.y(), bottom},
                   {block.high.x(), block.high.y(), block.height});
  }
  for (int k = 0; k < n; ++k)
    out += rod_text(corner[static_cast<size_t>(k)], corner[static_cast<size_t>((k + 1) % n)],
                    block.height);
  return out;
}

Vector2d field_size(const HeightField& field) {
  return field.spacing * Vector2d(static_cast<double>(field.heights.rows() - 1),
                                  static_cast<double>(field.heights.cols() - 1));
}

double field_range(const HeightField& field) {
  return std::max(1e-6, field.heights.maxCoeff() - field.heights.minCoeff());
}

std::string field_asset(const HeightField& field) {
  const Vector2d half = 0.5 * field_size(field);
  return "<asset><hfield name='field' nrow='" + std::to_string(field.heights.cols()) + "' ncol='" +
         std::to_string(field.heights.rows()) + "' size='" + text::exact(half.x()) + " " +
         text::exact(half.y()) + " " + text::exact(field_range(field)) + " " + text::exact(kDepth) +
         "'/></asset>";
}

/// Adds the plane, or four boxes around a field that dips below the plane.
std::string plane_text(const World& world) {
  const bool dips = !world.fields.empty() && world.fields[0].heights.minCoeff() < world.height;
  if (!dips)
    return "<geom type='plane' size='0 0 1' pos='0 0 " + text::exact(world.height) + kUnderBall;
  const Vector2d low = world.fields[0].origin, high = low + field_size(world.fields[0]);
  const double top = world.height, bottom = top - 1;
  return box_text({low.x() - kWide, low.y() - kWide, bottom}, {low.x(), high.y() + kWide, top}) +
         box_text({high.x(), low.y() - kWide, bottom}, {high.x() + kWide, high.y() + kWide, top}) +
         box_text({low.x(), low.y() - kWide, bottom}, {high.x(), low.y(), top}) +
         box_text({low.x(), high.y(), bottom}, {high.x(), high.y() + kWide, top});
}

std::string bump_name(int i, int part) {
  return "bump" + std::to_string(i) + "-" + std::to_string(part);
}

/// Adds the geoms of a bump: a cylinder and the rods of its eight edges, which set_bump() places.
std::string bump_text(int i) {
  std::string out =
      "<geom name='" + bump_name(i, 8) + "' type='cylinder' size='1 1' pos='0 0 -9" + kUnderBall;
  for (int k = 0; k < 8; ++k)
    out += "<geom name='" + bump_name(i, k) + "' type='capsule' size='1 1' pos='0 0 -9' euler='1 " +
           "0 0" + kUnderPlate;
  return out;
}

std::string floor_text(const World& world, bool bumps) {
  std::string out = "<body name='floor' mocap='true'>" + plane_text(world);
  for (const GroundBlock& block : world.blocks) out += block_text(block, world.height);
  if (!world.fields.empty()) {
    const HeightField& field = world.fields[0];
    const Vector2d center = field.origin + 0.5 * field_size(field);
    out += "<geom name='field' type='hfield' hfield='field' pos='" +
           triple({center.x(), center.y(), field.heights.minCoeff()}) + kUnderBoth;
  }
  for (int i = 0; bumps && i < kMujocoBumps; ++i) out += bump_text(i);
  return out + "</body>";
}

// While the sole is flat, the bottom of the ball at its corner is at the corner's height.
std::string point_text(const RobotModel& model, const ContactPoint& point, size_t i) {
  const double radius = std::max(point.radius, kBall);
  Vector3d center = point.position;
  if (point.side >= 0)
    center += kBall * model.sole(static_cast<Side>(point.side)).frame.linear().col(2);
  return "<geom name='point" + std::to_string(i) + "' type='sphere' size='" + text::exact(radius) +
         "' pos='" + triple(center) + "' contype='1' conaffinity='2'/>";
}

/// Adds the plate over a rectangular sole. Another polygon gets a box around its middle half, so
/// that the plate never reaches beyond the sole.
std::string plate_text(const Sole& sole, int side) {
  Vector2d low = sole.polygon[0], high = low;
  for (const Vector2d& p : sole.polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
  bool rectangle = sole.polygon.size() == 4;
  for (const Vector2d& p : sole.polygon)
    for (int k = 0; k < 2; ++k) rectangle &= p[k] == low[k] || p[k] == high[k];
  const Vector2d half = (rectangle ? 0.5 : 0.25) * (high - low), center = 0.5 * (low + high);
  const Vector3d place = sole.frame * Vector3d(center.x(), center.y(), 0.5 * kPlate);
  return "<geom name='plate" + std::to_string(side) + "' type='box' size='" +
         triple({half.x(), half.y(), 0.5 * kPlate}) + "' pos='" + triple(place) + "' quat='" +
         quadruple(Quaterniond(sole.frame.linear())) + "' contype='4' conaffinity='8'/>";
}

/// Models a gear with backlash or stiffness as a second joint behind the motor's. The flanks are
/// the limits of its range. MuJoCo takes their stiffness and damping per unit of inertia; of the
/// two inertias that meet there, the rotor's is by far the smaller.
std::string gear_text(const Body& body, const ServoDescription& servo) {
  if (!mujoco_has_gear(servo)) return {};
  std::string out = "<joint name='gear" + std::to_string(body.dof) + "' type='" +
                    (body.prismatic ? "slide" : "hinge") + "' axis='" + triple(body.axis) + "'";
  if (servo.backlash > 0) {
    const std::string half = text::exact(0.5 * servo.backlash);
    return out + " limited='true' range='-" + half + " " + half + "' solreflimit='-" +
           text::exact(gear_stiffness(servo) / servo.rotor_inertia) + " -" +
           text::exact(gear_damping(servo) / servo.rotor_inertia) +
           "' solimplimit='0.9999 0.9999 0.001'/>";
  }
  return out + " stiffness='" + text::exact(gear_stiffness(servo)) + "' damping='" +
         text::exact(gear_damping(servo)) + "'/>";
}

std::string joint_text(const RobotModel& model, const ActuatorLimits& limits, const Body& body) {
  if (body.parent < 0) return "<freejoint/>";
  const Dof& dof = model.dofs()[static_cast<size_t>(body.dof)];
  const ServoDescription& servo = limits.servo[static_cast<size_t>(body.dof)];
  std::string out = "<joint name='joint" + std::to_string(body.dof) + "' type='" +
                    (body.prismatic ? "slide" : "hinge") + "' axis='" + triple(body.axis) +
                    "' damping='" + text::exact(servo.viscous) + "' armature='" +
                    text::exact(servo.rotor_inertia) + "' frictionloss='" +
                    text::exact(servo.coulomb) + "'";
  if (dof.limited)
    out += " limited='true' range='" + text::exact(dof.lower) + " " + text::exact(dof.upper) + "'";
  return out + "/>" + gear_text(body, servo);
}

std::string body_text(const RobotModel& model, const ActuatorLimits& limits,
                      const std::vector<ContactPoint>& points, int index, bool plates) {
  std::string out = "<body name='body" + std::to_string(index) + "'>" +
                    joint_text(model, limits, model.bodies()[static_cast<size_t>(index)]) +
                    "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
  for (size_t i = 0; i < points.size(); ++i)
    if (points[i].body == index) out += point_text(model, points[i], i);
  for (const Side side : {Side::left, Side::right})
    if (plates && model.has_soles() && model.sole(side).body == index)
      out += plate_text(model.sole(side), static_cast<int>(side));
  for (size_t i = 0; i < model.bodies().size(); ++i)
    if (model.bodies()[i].parent == index)
      out += body_text(model, limits, points, static_cast<int>(i), plates);
  return out + "</body>";
}

std::string servo_text(const ActuatorLimits& limits, int j) {
  const ServoDescription& servo = limits.servo[static_cast<size_t>(j)];
  const std::string kp = text::exact(servo.kp);
  std::string out = "<general joint='joint" + std::to_string(j) + "' gainprm='" + kp +
                    "' biastype='affine' biasprm='0 -" + kp + " -" + text::exact(servo.kd) + "'";
  const double peak = std::min(limits.peak_torque[j], voltage_torque(servo, 0, 1));
  if (std::isfinite(peak))
    out += " forcelimited='true' forcerange='" + text::exact(-peak) + " " + text::exact(peak) + "'";
  return out + "/>";
}

// MuJoCo prints warnings and appends them to a file in the working folder. The only one that can
// occur is about a full buffer of contacts, and the simulation then continues with the contacts in
// the buffer.
void ignore_warning(const char*) {}

MujocoModel compile(const std::string& robot, const std::string& xml) {
  mju_user_warning = ignore_warning;
  const auto vfs = std::make_unique<mjVFS>();
  mj_defaultVFS(vfs.get());
  char error[1000] = "could not read the model";
  MujocoModel model(nullptr, mj_deleteModel);
  if (mj_makeEmptyFileVFS(vfs.get(), "robot.xml", static_cast<int>(xml.size())) == 0) {
    const int file = mj_findFileVFS(vfs.get(), "robot.xml");
    std::memcpy(vfs->filedata[file], xml.data(), xml.size());
    model.reset(mj_loadXML("robot.xml", vfs.get(), error, sizeof error));
  }
  mj_deleteVFS(vfs.get());
  if (!model) fail(ErrorCode::bad_model, robot + ": MuJoCo: " + error);
  return model;
}

void fill_field(const HeightField& field, mjModel* m) {
  const double low = field.heights.minCoeff(), range = field_range(field);
  for (Eigen::Index j = 0; j < field.heights.cols(); ++j)
    for (Eigen::Index i = 0; i < field.heights.rows(); ++i)
      m->hfield_data[j * field.heights.rows() + i] =
          static_cast<float>((field.heights(i, j) - low) / range);
}

void place_geom(int id, const Vector3d& place, const Vector3d& size, double bound, mjModel* m) {
  Eigen::Map<Vector3d>(m->geom_pos + 3 * id) = place;
  Eigen::Map<Vector3d>(m->geom_size + 3 * id) = size;
  m->geom_rbound[id] = bound;
}

}  // namespace

int mujoco_id(const mjModel* m, mjtObj type, const std::string& name) {
  return mj_name2id(m, type, name.c_str());
}

MujocoModel mujoco_model(const RobotModel& model, const std::vector<ContactPoint>& points,
                         const ActuatorLimits& limits, const World& world, bool bumps) {
  const bool plates = bumps || !world.blocks.empty() || !world.fields.empty();
  std::string out =
      "<mujoco><compiler angle='radian' boundmass='0'/><option gravity='0 0 " +
      text::exact(-kGravity) +
      "' integrator='Euler' cone='elliptic' solver='Newton' impratio='10' tolerance='1e-10' "
      "iterations='100'/><size nconmax='" +
      std::to_string(kMostContacts) + "' njmax='" + std::to_string(kMostRows) +
      "'/>"
      "<default><geom condim='3' solref='0.004 1' solimp='0.95 0.99 0.001' friction='0 0 0'/>"
      "</default>" +
      (world.fields.empty() ? std::string() : field_asset(world.fields[0])) + "<worldbody>" +
      floor_text(world, bumps) + body_text(model, limits, points, 0, plates) +
      "</worldbody><actuator>";
  for (int j = 0; j < model.dof_count(); ++j) out += servo_text(limits, j);
  MujocoModel m = compile(model.name(), out + "</actuator></mujoco>");
  if (!world.fields.empty()) fill_field(world.fields[0], m.get());
  for (int i = 0; bumps && i < kMujocoBumps; ++i) set_bump(nullptr, i, m.get());
  return m;
}

std::vector<ContactPoint> outermost_points(const std::vector<ContactPoint>& points) {
  std::vector<bool> kept(points.size(), false);
  for (const PointGroup& group : group_points(points)) {
    const auto first = static_cast<size_t>(group.first), count = static_cast<size_t>(group.count);
    for (int k = 0; k < 27; ++k) {
      const Vector3d way(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const auto reach = [&](size_t i) {
        return way.dot(points[i].position) + way.norm() * points[i].radius;
      };
      size_t farthest = first;
      for (size_t i = first; i < first + count; ++i)
        if (reach(i) > reach(farthest)) farthest = i;
      kept[farthest] = true;
    }
    for (size_t i = first; i < first + count; ++i)
      if (points[i].side >= 0 || count <= kFewPoints) kept[i] = true;
  }
  std::vector<ContactPoint> result;
  for (size_t i = 0; i < points.size(); ++i)
    if (kept[i]) result.push_back(points[i]);
  return result;
}

void set_inertia(const Inertia& inertia, int body, mjModel* m) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> principal(inertia.about_com);
  Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) *= -1;
  const Quaterniond turn(axes);
  m->body_mass[body] = inertia.mass;
  Eigen::Map<Vector3d>(m->body_ipos + 3 * body) = inertia.com;
  Eigen::Map<Vector3d>(m->body_inertia + 3 * body) = principal.eigenvalues();
  mjtNum* q = m->body_iquat + 4 * body;
  q[0] = turn.w(), q[1] = turn.x(), q[2] = turn.y(), q[3] = turn.z();
}

int bump_geom(const mjModel* m, int i, int part) {
  return mujoco_id(m, mjOBJ_GEOM, bump_name(i, part));
}

void set_bump(const RisingDisc* bump, int i, mjModel* m) {
  std::array<Vector2d, 8> corner;
  if (bump) block_corners(bump->block, corner);
  for (int k = 0; k < 9; ++k) {
    const int id = bump_geom(m, i, k);
    m->geom_contype[id] = bump ? (k == 8 ? 2 : 8) : 0;
    m->geom_conaffinity[id] = bump ? (k == 8 ? 1 : 4) : 0;
    if (!bump) continue;
    const GroundBlock& block = bump->block;
    if (k == 8) {
      const double half = 0.5 * kDepth;
      place_geom(id, {block.center.x(), block.center.y(), block.height - half},
                 {block.radius, half, 0}, std::hypot(block.radius, half), m);
      continue;
    }
    const Vector2d a = corner[static_cast<size_t>(k)], b = corner[static_cast<size_t>((k + 1) % 8)];
    const Vector2d along = (b - a).normalized(), inward(-along.y(), along.x());
    const Vector2d middle = 0.5 * (a + b) + kBall * inward;
    const double half = 0.5 * (b - a).norm() - kBall;
    place_geom(id, {middle.x(), middle.y(), block.height - kBall}, {kBall, half, 0}, half + kBall,
               m);
    const Quaterniond q = rotation_between(Vector3d::UnitZ(), Vector3d(along.x(), along.y(), 0));
    mjtNum* to = m->geom_quat + 4 * id;
    to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
  }
}

}  // namespace ayumi
