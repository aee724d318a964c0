// With M = diag(1, -1, 1): positions p -> M p; rotations R(a, angle) -> M R M = R(-M a, angle), so
// a joint about a has its image about -M a; moments and other axial vectors n -> -M n.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Largest distance of a joint's axis from the mirror image of its counterpart's axis [m]. Chosen:
/// above the asymmetry of real robots, below the distance of two joints of one limb.
constexpr double kAlike = 0.005;
/// Smallest cosine of the angle between an axis and the mirror image of its counterpart; the value
/// is the cosine of 8 deg.
constexpr double kParallel = 0.99;
/// Ending of the name that the mirror image of an included posture gets in the pattern.
constexpr std::string_view kImageEnding = "_mirrored";

Vector3d image(const Vector3d& p) { return {p.x(), -p.y(), p.z()}; }
Vector3d axial_image(const Vector3d& v) { return {-v.x(), v.y(), -v.z()}; }

Eigen::Quaterniond image(const Eigen::Quaterniond& q) { return {q.w(), -q.x(), q.y(), -q.z()}; }

struct Counterpart {
  int body = -1, sign = 0;
  double distance = 0;
};

// The nearest body whose joint lies on the image of this body's axis.
Counterpart counterpart(const RobotModel& model, const RobotData& data, int i) {
  const Body& body = model.bodies()[i];
  const Vector3d p = image(data.position[i]);
  const Vector3d axis = body.prismatic ? image(data.axis[i]) : axial_image(data.axis[i]);
  Counterpart best;
  for (int j = 1; j < static_cast<int>(model.bodies().size()); ++j) {
    const double along = axis.dot(data.axis[j]);
    const Vector3d offset = data.position[j] - p;
    const double aside = body.prismatic ? 0 : offset.cross(axis).norm();
    if (model.bodies()[j].prismatic != body.prismatic || std::abs(along) < kParallel ||
        aside > kAlike || (best.body >= 0 && offset.norm() >= best.distance))
      continue;
    best = {j, along > 0 ? 1 : -1, offset.norm()};
  }
  return best;
}

int nearest_link(const RobotModel& model, const RobotData& data, const Link& link, int body) {
  const auto place = [&](const Link& l) -> Vector3d {
    return data.position[l.body] + data.rotation[l.body] * l.pose.translation();
  };
  const Vector3d goal = image(place(link));
  int best = -1;
  for (int i = 0; i < static_cast<int>(model.links().size()); ++i) {
    if (model.links()[i].body != body) continue;
    if (best < 0 ||
        (place(model.links()[i]) - goal).norm() < (place(model.links()[best]) - goal).norm())
      best = i;
  }
  return best;
}

}  // namespace

MirrorMap mirror_map(const RobotModel& model) {
  RobotState state = model.rest_state();
  state.theta.setZero();
  RobotData data(model);
  update_positions(model, state, data);
  MirrorMap map;
  map.dof.resize(model.dof_count());
  map.sign.resize(model.dof_count());
  const int bodies = static_cast<int>(model.bodies().size());
  std::vector<int> body(bodies, 0);
  for (int i = 1; i < bodies; ++i) {
    const Counterpart found = counterpart(model, data, i);
    const Body& here = model.bodies()[i];
    if (found.body < 0 || counterpart(model, data, found.body).body != i)
      fail(ErrorCode::bad_model, model.name() + ": joint '" + model.dofs()[here.dof].name +
                                     "' has no counterpart on the other side, so the robot has "
                                     "no mirror image");
    body[i] = found.body;
    if (model.dofs()[here.dof].body != i) continue;  // a mimic joint is mirrored with its driver
    map.dof[here.dof] = model.bodies()[found.body].dof;
    map.sign[here.dof] = found.sign;
  }
  for (const Link& link : model.links())
    map.link.push_back(nearest_link(model, data, link, body[link.body]));
  return map;
}

namespace {

class Mirror {
 public:
  Mirror(const RobotModel& model, const Pattern& pattern)
      : model_(model), pattern_(pattern), map_(mirror_map(model)) {}

  Pattern whole() {
    Pattern result = pattern_;
    mirror_postures(result);
    result.start_feet = of(pattern_.start_feet);
    for (Phase& phase : result.phases) mirror(phase);
    for (Keyframe& key : result.keyframes) mirror(key);
    if (result.table) mirror(*result.table);
    if (result.correction) mirror(*result.correction);
    result.repair = of(pattern_.repair);
    mirror(result.world);
    for (Disturbance& disturbance : result.scenario)
      std::visit([&](auto& what) { mirror(what); }, disturbance.what);
    return result;
  }

 private:
  using Joints = std::map<std::string, double>;

  int dof_of(const std::string& joint, const std::string& inside) const {
    return find_joint(model_, joint, in_file(pattern_, inside));
  }

  Joints of(const Joints& joints, const std::string& inside, bool with_sign = true) const {
    Joints result;
    for (const auto& [joint, value] : joints) {
      const int dof = dof_of(joint, inside);
      const double sign = with_sign ? map_.sign[dof] : 1;
      result[model_.dofs()[map_.dof[dof]].name] = value == 0 ? 0 : sign * value;
    }
    return result;
  }

  RepairPreferences of(const RepairPreferences& preferences) const {
    RepairPreferences result = preferences;
    std::swap(result.feet[0], result.feet[1]);
    for (std::string& joint : result.joints)
      joint = model_.dofs()[map_.dof[dof_of(joint, "/repair/lock/joints")]].name;
    result.weights = of(preferences.weights, "/repair/weights", false);
    return result;
  }

  bool is_included(const std::string& posture) const {
    return pattern_.posture_files.contains(posture);
  }

  // The postures of the pattern itself get the angles of their images. The postures of a posture
  // library stay as they are, because other patterns include the library, too. Where the pattern
  // uses such a posture, the name of its mirror image is written instead.
  void mirror_postures(Pattern& result) const {
    for (auto& [name, joints] : result.postures)
      if (!is_included(name)) joints = of(joints, "/postures/" + json_pointer_token(name));
    std::vector<std::string*> uses = {&result.default_posture};
    for (Keyframe& key : result.keyframes)
      if (key.posture) uses.push_back(&*key.posture);
    // A posture of the pattern itself may be the mirror image of an included posture. It is handled
    // first, because its name is then free for the image of the included posture.
    std::map<std::string, std::string> images;
    for (const bool included : {false, true})
      for (const std::string* const name : uses)
        if (is_included(*name) == included && !images.contains(*name))
          images[*name] = image_of_used(result, *name);
    for (std::string* const name : uses) *name = images.at(*name);
  }

  // The name of the image of a posture that the pattern uses.
  std::string image_of_used(Pattern& result, const std::string& name) const {
    if (is_included(name)) return image_of_included(result, name);
    mirror_robot_posture(result, name);
    // If an earlier mirroring has made this posture from an included posture, its image is that
    // included posture.
    const auto own = result.postures.find(name);
    if (own == result.postures.end() || !name.ends_with(kImageEnding)) return name;
    const std::string origin = name.substr(0, name.size() - kImageEnding.size());
    if (!is_included(origin) || pattern_.postures.at(origin) != own->second) return name;
    result.postures.erase(own);
    return origin;
  }

  // The included posture with the angles of the image, or else a new posture of the pattern.
  std::string image_of_included(Pattern& result, const std::string& name) const {
    const Joints& given = pattern_.postures.at(name);
    const Joints twin = of(given, "/postures/" + json_pointer_token(name));
    if (twin == given) return name;
    for (const auto& [other, joints] : pattern_.postures)
      if (is_included(other) && joints == twin) return other;
    std::string fresh = name + std::string(kImageEnding);
    while (result.postures.contains(fresh)) fresh += kImageEnding;
    result.postures[fresh] = twin;
    return fresh;
  }

  // If a posture of the robot is not symmetric, the pattern gets its mirror image under the same
  // name. If this image equals the robot's posture again, it is removed from the pattern.
  void mirror_robot_posture(Pattern& result, const std::string& name) const {
    if (!model_.has_posture(name)) return;
    const VectorXd theta = model_.posture(name);
    Joints robots;
    for (int dof = 0; dof < model_.dof_count(); ++dof) robots[model_.dofs()[dof].name] = theta[dof];
    if (const auto own = result.postures.find(name); own != result.postures.end()) {
      if (own->second == robots) result.postures.erase(own);
    } else if (Joints twin = of(robots, name); twin != robots) {
      result.postures[name] = std::move(twin);
    }
  }

  static Foothold of(const Foothold& foot) {
    return {image(foot.position), {-foot.rpy.x(), foot.rpy.y(), -foot.rpy.z()}};
  }

  static LinkTarget of(LinkTarget target) {
    if (target.position) target.position = image(*target.position);
    if (target.direction) target.direction = image(*target.direction);
    return target;
  }

  static std::array<std::optional<Foothold>, 2> of(
      const std::array<std::optional<Foothold>, 2>& feet) {
    std::array<std::optional<Foothold>, 2> result;
    for (size_t side : {0, 1})
      if (feet[side]) result[1 - side] = of(*feet[side]);
    return result;
  }

  void mirror(Phase& phase) const {
    phase.support = opposite(phase.support);
    if (phase.viip) mirror(*phase.viip);
    if (!phase.swing) return;
    phase.swing->foot = other(phase.swing->foot);
    phase.swing->to = of(phase.swing->to);
    if (phase.swing->step) {
      phase.swing->step->side *= -1;
      phase.swing->step->turn *= -1;
    }
  }

  static void mirror(ViipGoal& goal) {
    if (auto* cog = std::get_if<CogGoal>(&goal)) cog->displacement.y() *= -1;
    if (auto* moving = std::get_if<CogVelocityGoal>(&goal)) moving->velocity.y() *= -1;
    if (auto* step = std::get_if<StepGoal>(&goal)) {
      step->velocity.y() *= -1;
      step->turn *= -1;
    }
  }

  void mirror(Keyframe& key) const {
    key.joints = of(key.joints, key.place.inside);
    key.weights = of(key.weights, key.place.inside, false);
    if (key.zmp) {
      key.zmp->place = opposite(key.zmp->place);
      key.zmp->point.y() *= -1;
    }
    if (key.cog_y) *key.cog_y *= -1;
    if (key.torso) *key.torso = {-key.torso->x(), key.torso->y(), -key.torso->z()};
    key.feet = of(key.feet);
    std::map<std::string, LinkTarget> hands;
    for (const auto& [link, target] : key.hands) {
      std::string name = link == "left" ? "right" : link == "right" ? "left" : link;
      if (name == link) mirror_link(name);
      hands[name] = of(target);
    }
    key.hands = std::move(hands);
    if (key.gaze) key.gaze = of(*key.gaze);
  }

  // If the table has the joints of both sides, its columns keep their order. Otherwise, the columns
  // get the names of the joints on the other side.
  void mirror(DenseTable& table) const {
    const std::string inside = "table " + table.file;
    const Eigen::MatrixXd theta = table.theta;
    std::vector<std::string> images;
    for (const std::string& joint : table.joints)
      images.push_back(model_.dofs()[map_.dof[dof_of(joint, inside)]].name);
    const bool whole = std::all_of(images.begin(), images.end(), [&](const std::string& joint) {
      return std::find(table.joints.begin(), table.joints.end(), joint) != table.joints.end();
    });
    for (size_t j = 0; j < images.size(); ++j) {
      const auto to = whole ? std::find(table.joints.begin(), table.joints.end(), images[j]) -
                                  table.joints.begin()
                            : static_cast<std::ptrdiff_t>(j);
      table.theta.col(to) =
          map_.sign[dof_of(table.joints[j], inside)] * theta.col(static_cast<Eigen::Index>(j));
    }
    if (!whole) table.joints = images;
    for (BasePose& base : table.base) base = {image(base.position), image(base.attitude)};
    for (Vector3d& p : table.cog) p = image(p);
    for (Vector3d& p : table.zmp) p = image(p);
  }

  void mirror(CorrectionTrack& track) const {
    for (const int column : {1, 3, 5})  // mirrored: y, and the rotations about x and z
      track.coefficients.col(column) *= -1;
    for (size_t j = 0; j < track.joints.size(); ++j) {
      const int dof = dof_of(track.joints[j], "/correction");
      track.coefficients.col(static_cast<Eigen::Index>(6 + j)) *= map_.sign[dof];
      track.joints[j] = model_.dofs()[map_.dof[dof]].name;
    }
  }

  static void mirror_rectangle(Eigen::Vector2d& low, Eigen::Vector2d& high) {
    low.y() *= -1;
    high.y() *= -1;
    std::swap(low.y(), high.y());
  }

  static void mirror(World& world) {
    world.slope.x() *= -1;
    for (GroundBlock& block : world.blocks) {
      mirror_rectangle(block.low, block.high);
      block.center.y() *= -1;
    }
    for (FrictionPatch& patch : world.patches) mirror_rectangle(patch.low, patch.high);
    for (HeightField& field : world.fields) {
      field.origin.y() =
          -field.origin.y() - field.spacing * static_cast<double>(field.heights.cols() - 1);
      field.heights = field.heights.rowwise().reverse().eval();
    }
    for (FloorMotion& motion : world.motions) mirror(motion.path);
  }

  void mirror_link(std::string& name) const {
    const int link = model_.find_link(name);
    if (link >= 0) name = model_.links()[map_.link[link]].name;
  }

  void mirror_joint(std::string& name) const {
    const int dof = model_.find_dof(name);
    if (dof >= 0) name = model_.dofs()[map_.dof[dof]].name;
  }

  void mirror(Push& push) const {
    push.direction =
        push.kind == PushKind::torque ? axial_image(push.direction) : image(push.direction);
    push.point = image(push.point);
    mirror_link(push.on);
  }
  void mirror(Payload& payload) const {
    payload.point = image(payload.point);
    mirror_link(payload.on);
  }
  static void mirror(FloorPath& path) {
    path.tilt.x() *= -1;
    path.shift = image(path.shift);
  }
  static void mirror(FrictionChange&) {}
  static void mirror(Bump& bump) {
    if (bump.foot) bump.foot = *bump.foot == Side::left ? Side::right : Side::left;
    bump.place.y() *= -1;
  }
  static void mirror(Latency&) {}
  static void mirror(SensorBias& bias) {
    bias.tilt.x() *= -1;
    bias.gyro = axial_image(bias.gyro);
  }
  /// An offset of all joints keeps its sign, because one number cannot change its sign for some
  /// joints only.
  void mirror(EncoderOffset& fault) const {
    const int dof = model_.find_dof(fault.joint);
    if (dof >= 0) fault.offset *= map_.sign[dof];
    mirror_joint(fault.joint);
  }
  void mirror(JointFriction& fault) const { mirror_joint(fault.joint); }
  void mirror(GainLoss& fault) const { mirror_joint(fault.joint); }

  const RobotModel& model_;
  const Pattern& pattern_;
  const MirrorMap map_;
};

}  // namespace

Pattern mirrored(const RobotModel& model, const Pattern& pattern) {
  return Mirror(model, pattern).whole();
}

}  // namespace ayumi
