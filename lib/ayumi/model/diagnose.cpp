// Mirror images: the reflection S = diag(1, -1, 1) takes a point p to S p and an axis of rotation a
// to -S a. Where the axis of the right joint is sigma (-S a_left), the mirrored angle is sigma
// times the left one, and motors that are mounted as mirror images turn in opposite directions:
// their counts have the signs c_right = -sigma c_left.

#include "ayumi/model/diagnose.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/model/body_poses.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/outline.hpp"

namespace ayumi {

namespace {

constexpr double kDegree = std::numbers::pi / 180;  // [rad]
// Thresholds of warnings; none changes a result.

/// Density above which a mass is suspicious [kg/m^3]. Chosen: twice that of lead.
constexpr double kDensest = 20000;
/// Joint speed above which a limit is suspicious [rad/s]. Chosen: ten times that of a usual servo.
constexpr double kFastest = 60;
/// Fraction of the robot's mass above which a body needs a collision shape. Chosen: a body of this
/// size is a limb, a head or a trunk.
constexpr double kLargeShare = 0.05;
/// Difference of left and right that is suspicious, as a fraction of a mass or of the robot's size.
/// Chosen: above the differences that wiring and screws make.
constexpr double kAsymmetry = 0.02;

std::string millimetres(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }

class Doctor {
 public:
  explicit Doctor(const RobotModel& model)
      : model_(model), zero_(body_poses(model, Eigen::VectorXd::Zero(model.dof_count()))) {
    Eigen::AlignedBox3d box;
    for (size_t i = 0; i < zero_.size(); ++i) {
      box.extend(zero_[i].translation());
      box.extend(zero_[i] * model.bodies()[i].inertia.com);
    }
    size_ = std::max(box.diagonal().norm(), 1e-3);
  }

  std::vector<ModelWarning> examine() {
    examine_root();
    for (const Link& link : model_.links()) examine_link(link);
    examine_equal_tensors();
    examine_collisions();
    for (const Dof& dof : model_.dofs()) examine_dof(dof);
    examine_placeholder_torques();
    examine_symmetry();
    if (model_.has_soles()) examine_stance();
    return std::move(warnings_);
  }

 private:
  void warn(const std::string& where, const std::string& message) {
    warnings_.push_back({where, message});
  }

  void examine_root() {
    const Link& root = model_.links().front();
    if (root.inertia.mass > 0 && model_.description().sidecar_file.empty())
      warn("link " + root.name, "the root link carries " + text::brief(root.inertia.mass) +
                                    " kg; Ayumi counts this mass, but some URDF readers "
                                    "ignore it and compute a smaller total mass");
  }

  void examine_link(const Link& link) {
    const std::string where = "link " + link.name;
    if (link.inertia.mass == 0) {
      const Body& body = model_.bodies()[link.body];
      if (body.inertia.mass == 0 && body.name == link.name)
        warn(where,
             "has no mass although a joint moves it; Ayumi takes this link for a frame between two "
             "axes");
      else if (!link.visuals.empty() || !link.collisions.empty())
        warn(where, "has a shape but no mass; its mass must be contained in " + body.name);
      return;
    }
    examine_tensor(link, where);
    examine_size(link, where);
  }

  void examine_tensor(const Link& link, const std::string& where) {
    const Eigen::Vector3d principal =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(link.inertia.about_com).eigenvalues();
    if (principal.maxCoeff() <= 0)
      warn(where, "its inertia tensor is zero; give the one of its shape");
    else if (principal[2] > 1.01 * (principal[0] + principal[1]))
      warn(where, "its largest principal moment " + text::brief(principal[2]) +
                      " kg m^2 exceeds the sum of the other two, " +
                      text::brief(principal[0] + principal[1]) +
                      ", which no body can have; check the tensor and its frame");
  }

  void examine_size(const Link& link, const std::string& where) {
    Eigen::AlignedBox3d box;
    double reach = 0;  // largest distance of the shapes from the centre of mass
    for (const auto* shapes : {&link.visuals, &link.collisions})
      for (const PlacedShape& placed : *shapes)
        for (const Eigen::Vector3d& point : outline(placed.shape)) {
          box.extend(placed.pose * point);
          reach = std::max(reach, (placed.pose * point - link.inertia.com).norm());
        }
    const double gyration = std::sqrt(link.inertia.about_com.trace() / 2 / link.inertia.mass);
    if (box.isEmpty()) {
      if (gyration > size_)
        warn(where, "its inertia is that of a body of " + millimetres(gyration) +
                        " radius, more than the robot's size; is this a placeholder?");
      return;
    }
    if (gyration > reach)
      warn(where, "its inertia is that of a body of " + millimetres(gyration) +
                      " radius, but its shape reaches only " + millimetres(reach) +
                      " from its centre of mass; is this a placeholder?");
    if (box.diagonal().norm() > 5 * size_)
      warn(where, "its shape measures " + millimetres(box.diagonal().norm()) +
                      ", far more than the robot; is the mesh in millimetres? set its scale");
    const double outside = box.exteriorDistance(link.inertia.com);
    if (outside > 0.25 * box.diagonal().norm())
      warn(where, "its centre of mass lies " + millimetres(outside) +
                      " outside its shape; check the frame of the inertia");
    const double density = link.inertia.mass / std::max(box.volume(), 1e-12);
    if (density > kDensest)
      warn(where, text::brief(link.inertia.mass) + " kg in a box of " +
                      millimetres(box.diagonal().norm()) +
                      " diagonal is heavier than lead; check the mass or the shape");
  }

  void examine_equal_tensors() {
    std::vector<const Link*> heavy;
    for (const Link& link : model_.links())
      if (link.inertia.mass > 0 && !link.inertia.about_com.isZero()) heavy.push_back(&link);
    std::vector<bool> named(heavy.size(), false);
    for (size_t i = 0; i < heavy.size(); ++i) {
      std::vector<std::string> same = {heavy[i]->name};
      bool other_mass = false;
      for (size_t j = i + 1; j < heavy.size() && !named[i]; ++j) {
        if (heavy[j]->inertia.about_com != heavy[i]->inertia.about_com) continue;
        named[j] = true;
        same.push_back(heavy[j]->name);
        other_mass |= heavy[j]->inertia.mass != heavy[i]->inertia.mass;
      }
      if (same.size() > 2 && other_mass)
        warn("links " + text::join(same, ", "),
             "have the same inertia tensor but different masses; are these placeholders?");
    }
  }

  void examine_collisions() {
    std::vector<bool> covered(model_.bodies().size(), false);
    for (const Link& link : model_.links())
      if (!link.collisions.empty()) covered[link.body] = true;
    std::vector<std::string> missing;
    for (size_t i = 0; i < covered.size(); ++i) {
      const bool foot =
          model_.has_soles() && (static_cast<int>(i) == model_.sole(Side::left).body ||
                                 static_cast<int>(i) == model_.sole(Side::right).body);
      const bool heavy = model_.bodies()[i].inertia.mass > kLargeShare * model_.mass();
      if (!covered[i] && (foot || heavy)) missing.push_back(model_.bodies()[i].name);
    }
    if (!missing.empty())
      warn("links " + text::join(missing, ", "),
           "have no collision shape; their contacts and self-collisions are not detected");
  }

  void examine_dof(const Dof& dof) {
    const std::string where = "joint " + dof.name;
    const int index = model_.find_dof(dof.name);
    const ActuatorLimits& limits = model_.limits();
    if (!dof.limited)
      warn(where, "has no position limits; state them");
    else if (dof.upper - dof.lower < 1e-6)
      warn(where, "its lower and upper limit are equal; make it a fixed joint");
    else if (!dof.prismatic && dof.upper - dof.lower > 4 * std::numbers::pi)
      warn(where, "its range is more than two turns; is this a placeholder?");
    if (std::isinf(limits.speed[index]))
      warn(where, "no speed limit is stated");
    else if (!dof.prismatic && limits.speed[index] > kFastest)
      warn(where, "speed limit " + text::brief(limits.speed[index]) +
                      " rad/s is faster than servos are; is this a placeholder?");
    if (std::isinf(limits.peak_torque[index])) warn(where, "no torque limit is stated");
    if (!limits.has_servo[static_cast<size_t>(index)])
      warn(where, "has no servo constants; give it a kp and kd");
    else if (limits.servo[static_cast<size_t>(index)].kp <= 0)
      warn(where, "is passive: its servo's kp is 0");
    if (dof.encoder.device == 0 && !model_.description().encoders.empty())
      warn(where, "has no encoder entry although other joints have one");
  }

  void examine_placeholder_torques() {
    const Eigen::VectorXd& torque = model_.limits().peak_torque;
    if (torque.size() < 3 || !torque.allFinite()) return;
    const double largest = 10 * model_.mass() * kGravity * size_;
    if (torque.maxCoeff() > largest)
      warn("limits", "a torque limit of " + text::brief(torque.maxCoeff()) +
                         " N m could throw the robot; is this a placeholder?");
    const double decade = elementary::log10(torque[0]);
    if (torque.minCoeff() == torque.maxCoeff() && std::abs(decade - std::round(decade)) < 1e-9)
      warn("limits", "every joint has the torque limit " + text::brief(torque[0]) +
                         " N m; is this a placeholder?");
  }

  // The right-hand name that belongs to a left-hand name; empty when the name has no side.
  static std::string mirrored_name(const std::string& name) {
    static const std::pair<const char*, const char*> kSides[] = {
        {"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}, {"l_", "r_"}, {"L_", "R_"}};
    for (const auto& [left, right] : kSides)
      for (size_t at = name.find(left); at != std::string::npos; at = name.find(left, at + 1)) {
        const bool word = std::string(left).size() > 2 || at == 0 || name[at - 1] == '_';
        if (word) return name.substr(0, at) + right + name.substr(at + std::string(left).size());
      }
    return name[0] == 'L' ? "R" + name.substr(1) : "";
  }

  void examine_symmetry() {
    for (const Link& left : model_.links()) {
      const int right = model_.find_link(mirrored_name(left.name));
      if (right >= 0) compare_links(left, model_.links()[right]);
    }
    int conform = 0, against = 0;
    std::vector<std::string> same, opposite;
    for (const Dof& left : model_.dofs()) {
      const int right = model_.find_dof(mirrored_name(left.name));
      if (right >= 0) compare_dofs(left, model_.dofs()[right], same, opposite);
    }
    conform = static_cast<int>(opposite.size());
    against = static_cast<int>(same.size());
    if (conform == 0 || against == 0) return;
    warn("joints " + text::join(conform >= against ? same : opposite, ", "),
         "one of the two encoder signs may be wrong: on the " +
             std::to_string(std::max(conform, against)) +
             " other pairs of joints, the left and the right sign are related in the opposite "
             "manner; test these joints alone before you replay a table");
  }

  void compare_links(const Link& left, const Link& right) {
    const std::string where = "links " + left.name + ", " + right.name;
    const double a = left.inertia.mass, b = right.inertia.mass;
    if (std::abs(a - b) > kAsymmetry * std::max(a, b))
      warn(where,
           "left and right masses differ: " + text::brief(a) + " and " + text::brief(b) + " kg");
    Eigen::Vector3d mirrored = zero_[left.body] * left.pose * left.inertia.com;
    mirrored.y() = -mirrored.y();
    const double apart = (mirrored - zero_[right.body] * right.pose * right.inertia.com).norm();
    if (a > 0 && b > 0 && apart > kAsymmetry * size_)
      warn(where, "their centres of mass are not mirror images of each other; the difference is " +
                      millimetres(apart) + " with every joint at 0");
  }

  void compare_dofs(const Dof& left, const Dof& right, std::vector<std::string>& same,
                    std::vector<std::string>& opposite) {
    const std::string where = "joints " + left.name + ", " + right.name;
    Eigen::Vector3d origin = zero_[left.body].translation();
    Eigen::Vector3d axis = zero_[left.body].linear() * model_.bodies()[left.body].axis;
    origin.y() = -origin.y();
    axis = left.prismatic ? Eigen::Vector3d(axis.x(), -axis.y(), axis.z())
                          : Eigen::Vector3d(-axis.x(), axis.y(), -axis.z());
    const double apart = (origin - zero_[right.body].translation()).norm();
    if (apart > kAsymmetry * size_)
      warn(where, "their places are not mirror images of each other; the difference is " +
                      millimetres(apart));
    const double along = axis.dot(zero_[right.body].linear() * model_.bodies()[right.body].axis);
    if (std::abs(along) < 0.99) {
      warn(where, "their axes are not mirror images of each other");
      return;
    }
    const double lower = along > 0 ? left.lower : -left.upper;
    const double upper = along > 0 ? left.upper : -left.lower;
    const auto differ = [](double a, double b) { return a != b && !(std::abs(a - b) <= kDegree); };
    if (differ(lower, right.lower) || differ(upper, right.upper))
      warn(where, "left and right limits differ: mirrored, the left has " + text::brief(lower) +
                      " to " + text::brief(upper) + ", the right has " + text::brief(right.lower) +
                      " to " + text::brief(right.upper));
    const double counts = left.encoder.counts_per_degree * right.encoder.counts_per_degree * along;
    if (counts != 0) (counts > 0 ? same : opposite).push_back(left.name + "/" + right.name);
  }

  void examine_stance() {
    const std::vector<Eigen::Isometry3d> poses = body_poses(model_, model_.posture());
    std::vector<Eigen::Isometry3d> soles;
    for (const Side side : {Side::left, Side::right})
      soles.push_back(poses[model_.sole(side).body] * model_.sole(side).frame);
    const Eigen::Vector3d up = soles[0].linear().col(2);
    const double tilt = elementary::acos(std::clamp(up.dot(soles[1].linear().col(2)), -1.0, 1.0));
    const double step = up.dot(soles[1].translation() - soles[0].translation());
    if (tilt > kDegree || std::abs(step) > 0.001)
      warn("posture home", "the soles are not on one plane: tilted by " +
                               text::fixed(tilt / kDegree, 1) + " deg, apart in height by " +
                               millimetres(std::abs(step)) + "; correct the ankle angles");
    const double lean = elementary::acos(std::clamp(up.z(), -1.0, 1.0));
    if (lean > 5 * kDegree)
      warn("posture home", "the root link leans by " + text::fixed(lean / kDegree, 1) +
                               " deg against the soles; is this intended?");
    Eigen::Vector3d cog = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < poses.size(); ++i)
      cog += model_.bodies()[i].inertia.mass / model_.mass() *
             (poses[i] * model_.bodies()[i].inertia.com);
    examine_support(soles, cog);
  }

  // Tests whether the COG is above the hull of both soles, along the left sole's normal.
  void examine_support(const std::vector<Eigen::Isometry3d>& soles, const Eigen::Vector3d& cog) {
    const Eigen::Isometry3d to_left = soles[0].inverse();
    std::vector<Eigen::Vector2d> corners;
    for (const Side side : {Side::left, Side::right})
      for (const Eigen::Vector2d& corner : model_.sole(side).polygon)
        corners.push_back(
            (to_left * soles[static_cast<int>(side)] * Eigen::Vector3d(corner.x(), corner.y(), 0))
                .head<2>());
    const double margin = ConvexPolygon(corners).margin((to_left * cog).head<2>());
    if (margin < 0)
      warn("posture home", "the COG lies " + millimetres(-margin) +
                               " outside the soles: the robot falls; shift it over the feet");
  }

  const RobotModel& model_;
  std::vector<Eigen::Isometry3d> zero_;
  double size_ = 1;
  std::vector<ModelWarning> warnings_;
};

}  // namespace

std::vector<ModelWarning> diagnose(const RobotModel& model) { return Doctor(model).examine(); }

}  // namespace ayumi
