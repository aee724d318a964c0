// Mirror images: the reflection S = diag(1, -1, 1) takes a point p to S p and an axis of rotation a
// to -S a. If the axis of the right joint is sigma (-S a_left), the mirrored angle is sigma times
// the left angle. Motors that are mounted as mirror images turn in opposite directions, so their
// counts have the signs c_right = -sigma c_left.

#include "ayumi/model/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "ayumi/base/text.hpp"
#include "ayumi/math/eigenvalues.hpp"
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
/// Distance up to which a joint is the mirror image of another, as a fraction of the robot's size.
/// Chosen: below the distance of neighbouring joints, above any asymmetry that a robot has.
constexpr double kPartner = 0.1;
/// A centre of mass is suspicious if it lies outside its shape by more than this share of the
/// shape's size. Chosen: a motor behind a plate is less far away, and a distance of half the size
/// must be detected.
constexpr double kOutside = 0.25;
/// Largest number of names that a warning lists in full, and the number that it lists if there are
/// more. Chosen: they fit on a line of a terminal.
constexpr size_t kMostNames = 6, kFewNames = 3;

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
    for (const Link& link : model_.links()) examine_link(link);
    examine_equal_tensors();
    examine_collisions();
    for (const Dof& dof : model_.dofs()) examine_dof(dof);
    examine_placeholder_torques();
    examine_symmetry();
    if (model_.has_soles()) examine_stance();
    return warnings();
  }

 private:
  using Subject = ModelWarning::Subject;

  /// Something suspicious about a link, a joint or a pair of them. `message` is the cause, which is
  /// the same for all that have it; `detail` has the figures, and `size` shows which of them is the
  /// worst.
  struct Suspicion {
    Subject subject = Subject::link;
    std::string message;
    std::vector<std::vector<std::string>> names;
    std::string detail, worst;
    double size = 0;
  };

  // `names` are those of one link or joint, or of several that are suspicious together.
  void warn(Subject subject, const std::vector<std::string>& names, const std::string& message,
            const std::string& detail = "", double size = 0) {
    const auto same = std::find_if(suspicions_.begin(), suspicions_.end(), [&](const auto& each) {
      return each.subject == subject && each.message == message;
    });
    Suspicion& suspicion = same != suspicions_.end() ? *same : suspicions_.emplace_back();
    suspicion.subject = subject;
    suspicion.message = message;
    if (suspicion.names.empty() || size > suspicion.size) {
      suspicion.detail = detail;
      suspicion.worst = text::join(names, ", ");
      suspicion.size = size;
    }
    suspicion.names.push_back(names);
  }
  void warn(Subject subject, const std::string& name, const std::string& message,
            const std::string& detail = "", double size = 0) {
    warn(subject, std::vector<std::string>{name}, message, detail, size);
  }

  static std::string words_of(Subject subject, bool plural) {
    switch (subject) {
      case Subject::link:
        return plural ? "links" : "link";
      case Subject::joint:
        return plural ? "joints" : "joint";
      case Subject::joint_pairs:
        return "joints";
      case Subject::limits:
        return "limits";
      case Subject::posture:
        return "posture";
    }
    return "";
  }

  /// One warning for each cause, whatever the number of links or joints that have it.
  std::vector<ModelWarning> warnings() const {
    std::vector<ModelWarning> warnings;
    for (const Suspicion& each : suspicions_) {
      const size_t count = each.names.size();
      const bool several = each.names[0].size() > 1;
      const std::string subjects = words_of(each.subject, count > 1 || several);
      std::vector<std::string> shown;
      for (size_t i = 0; i < (count > kMostNames ? kFewNames : count); ++i)
        shown.push_back(text::join(each.names[i], ", "));
      const std::string where =
          (count > kMostNames ? std::to_string(count) + (several ? " pairs of " : " ") : "") +
          subjects + (count > kMostNames ? " (" : " ") + text::join(shown, several ? "; " : ", ") +
          (count > kMostNames ? ", ...)" : "");
      const std::string detail = each.detail.empty() ? ""
                                 : count == 1
                                     ? " (" + each.detail + ")"
                                     : " (the worst is " + each.worst + ": " + each.detail + ")";
      const bool named = count > 1 || !each.names[0].empty();
      warnings.push_back({each.subject, named ? where : subjects, each.message + detail});
    }
    return warnings;
  }

  void examine_link(const Link& link) {
    if (link.inertia.mass == 0) {
      const Body& body = model_.bodies()[link.body];
      if (body.inertia.mass == 0 && body.name == link.name)
        warn(Subject::link, link.name,
             "no mass is stated, although a joint moves the link; Ayumi takes such a link as a "
             "frame "
             "between two axes");
      else if (!link.visuals.empty() || !link.collisions.empty())
        warn(Subject::link, link.name,
             "a shape is stated, but no mass; the mass of this part must be in the link that "
             "carries it");
      return;
    }
    examine_tensor(link);
    examine_size(link);
  }

  void examine_tensor(const Link& link) {
    const Eigen::Vector3d principal = symmetric_eigenvalues(link.inertia.about_com);
    if (principal.maxCoeff() <= 0)
      warn(Subject::link, link.name,
           "the inertia tensor is zero; give the tensor that follows from shape and mass");
    else if (principal[2] > 1.01 * (principal[0] + principal[1]))
      warn(Subject::link, link.name,
           "the largest principal moment exceeds the sum of the other two, which no body can have; "
           "check the tensor and the frame",
           text::brief(principal[2]) + " and " + text::brief(principal[0] + principal[1]) +
               " kg m^2",
           principal[2] / (principal[0] + principal[1]));
  }

  void examine_size(const Link& link) {
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
        warn(Subject::link, link.name,
             "the inertia is that of a body larger than the robot; is this a placeholder?",
             millimetres(gyration) + " radius of gyration", gyration);
      return;
    }
    if (gyration > reach)
      warn(Subject::link, link.name,
           "the inertia is that of a body larger than the shape; is this a placeholder?",
           millimetres(gyration) + " radius of gyration, but the shape reaches only " +
               millimetres(reach) + " from the centre of mass",
           gyration / std::max(reach, 1e-9));
    if (box.diagonal().norm() > 5 * size_)
      warn(Subject::link, link.name,
           "the shape is far larger than the robot; if the mesh is in millimetres, set the scale "
           "of the mesh",
           millimetres(box.diagonal().norm()), box.diagonal().norm());
    const double outside = box.exteriorDistance(link.inertia.com);
    if (outside > kOutside * box.diagonal().norm())
      warn(Subject::link, link.name,
           "the centre of mass lies outside the shape; check the frame of the inertia",
           "by " + millimetres(outside) + ", and the shape measures " +
               millimetres(box.diagonal().norm()),
           outside / box.diagonal().norm());
    const double density = link.inertia.mass / std::max(box.volume(), 1e-12);
    if (density > kDensest)
      warn(Subject::link, link.name,
           "the density is above that of lead; check the mass or the shape",
           text::brief(link.inertia.mass) + " kg in a box of " +
               millimetres(box.diagonal().norm()) + " diagonal",
           density);
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
        warn(Subject::link, same,
             "these links have the same inertia tensor but different masses; are the tensors "
             "placeholders?");
    }
  }

  void examine_collisions() {
    const std::vector<std::string> missing = bodies_without_collision_shapes(model_);
    if (missing.size() == 1)
      warn(Subject::link, missing[0],
           "no collision shape is stated, so contacts and self-collisions of this link are not "
           "detected");
    else if (!missing.empty())
      warn(Subject::link, missing,
           "no collision shapes are stated, so contacts and self-collisions of these links are not "
           "detected");
  }

  void examine_dof(const Dof& dof) {
    const int index = model_.find_dof(dof.name);
    const ActuatorLimits& limits = model_.limits();
    const auto suspect = [&](const std::string& message) {
      warn(Subject::joint, dof.name, message);
    };
    if (!dof.limited)
      suspect("no position limits are stated; add them");
    else if (dof.upper - dof.lower < 1e-6)
      suspect("the lower and the upper limit are equal; make the joint fixed");
    else if (!dof.prismatic && dof.upper - dof.lower > 4 * std::numbers::pi)
      suspect("the range is more than two turns; is this a placeholder?");
    if (std::isinf(limits.speed[index]))
      suspect("no speed limit is stated");
    else if (!dof.prismatic && limits.speed[index] > kFastest)
      suspect("the speed limit of " + text::brief(limits.speed[index]) +
              " rad/s is higher than the speed of any servo; is this a placeholder?");
    if (std::isinf(limits.peak_torque[index])) suspect("no torque limit is stated");
    if (!limits.has_servo[static_cast<size_t>(index)])
      suspect("no servo constants are stated; give kp and kd");
    else if (limits.servo[static_cast<size_t>(index)].kp <= 0)
      suspect("kp of the servo is 0, so the joint is passive");
    if (dof.encoder.device == 0 && !model_.description().encoders.empty())
      suspect("no encoder is stated, although other joints have an encoder");
  }

  void examine_placeholder_torques() {
    const Eigen::VectorXd& torque = model_.limits().peak_torque;
    if (torque.size() < 3 || !torque.allFinite()) return;
    const double largest = 10 * model_.mass() * kGravity * size_;
    if (torque.maxCoeff() > largest)
      warn(Subject::limits, std::vector<std::string>(),
           "a torque limit of " + text::brief(torque.maxCoeff()) +
               " N m could throw the robot; is this a placeholder?");
    const double decade = elementary::log10(torque[0]);
    if (torque.minCoeff() == torque.maxCoeff() && std::abs(decade - std::round(decade)) < 1e-9)
      warn(Subject::limits, std::vector<std::string>(),
           "every joint has the torque limit " + text::brief(torque[0]) +
               " N m; is this a placeholder?");
  }

  int joints_to_root(int body) const {
    int joints = 0;
    for (; model_.bodies()[body].parent >= 0; body = model_.bodies()[body].parent) ++joints;
    return joints;
  }

  // The joints on the right that are mirror images of those on the left, found by their places with
  // every joint at 0. The two joints of a pair are of the same kind and equally many joints away
  // from the root, and each of them is the nearest one to the mirrored place of the other.
  std::vector<std::pair<const Dof*, const Dof*>> partners() const {
    const auto place = [&](const Dof& dof) { return zero_[dof.body].translation(); };
    const auto mirrored_distance = [&](const Dof& a, const Dof& b) {
      Eigen::Vector3d mirrored = place(a);
      mirrored.y() = -mirrored.y();
      // Joints that share a centre are distinguished by their axes.
      const Eigen::Vector3d axis = zero_[a.body].linear() * model_.bodies()[a.body].axis;
      const Eigen::Vector3d other = zero_[b.body].linear() * model_.bodies()[b.body].axis;
      const Eigen::Vector3d turned(axis.x(), -axis.y(), axis.z());
      return (mirrored - place(b)).norm() + 0.01 * size_ * (1 - std::abs(turned.dot(other)));
    };
    const auto nearest = [&](const Dof& dof) {
      const Dof* best = nullptr;
      for (const Dof& each : model_.dofs())
        if (&each != &dof && each.prismatic == dof.prismatic &&
            joints_to_root(each.body) == joints_to_root(dof.body) &&
            (!best || mirrored_distance(dof, each) < mirrored_distance(dof, *best)))
          best = &each;
      return best;
    };
    std::vector<std::pair<const Dof*, const Dof*>> found;
    for (const Dof& left : model_.dofs()) {
      const Dof* right = nearest(left);
      if (!right || nearest(*right) != &left) continue;
      if (mirrored_distance(left, *right) > kPartner * size_) continue;
      if (place(left).y() - place(*right).y() > kAsymmetry * size_)
        found.emplace_back(&left, right);
    }
    return found;
  }

  void examine_symmetry() {
    std::vector<std::string> same, opposite;
    const auto pairs = partners();
    for (const auto& [left, right] : pairs) {
      for (const Link& link : model_.links())
        if (link.body == left->body && link.name == model_.bodies()[left->body].name)
          compare_links(link, model_.links()[model_.find_link(model_.bodies()[right->body].name)]);
      // The displacement of the joint before this one is subtracted, because another message
      // already names it.
      Eigen::Vector3d before = Eigen::Vector3d::Zero();
      for (const auto& [above, other] : pairs)
        if (above->body == model_.bodies()[left->body].parent &&
            other->body == model_.bodies()[right->body].parent)
          before = displacement(*above, *other);
      compare_dofs(*left, *right, before, same, opposite);
    }
    const size_t conform = opposite.size(), against = same.size();
    if (conform == 0 || against == 0) return;
    const bool are_same_here = conform >= against;
    warn(Subject::joint_pairs, are_same_here ? same : opposite,
         std::string(
             "one of the two encoder signs may be wrong. In a symmetric movement, the counts "
             "of the left and the right joint change in ") +
             (are_same_here ? "the same direction, but in opposite directions"
                            : "opposite directions, but in the same direction") +
             " on " + std::to_string(std::max(conform, against)) +
             " other pairs of joints. Test each of these joints alone before you replay a table");
  }

  void compare_links(const Link& left, const Link& right) {
    const std::vector<std::string> names = {left.name, right.name};
    const double a = left.inertia.mass, b = right.inertia.mass;
    if (std::abs(a - b) > kAsymmetry * std::max(a, b))
      warn(Subject::link, names, "left and right masses differ",
           text::brief(a) + " and " + text::brief(b) + " kg", std::abs(a - b));
    Eigen::Vector3d mirrored = zero_[left.body] * left.pose * left.inertia.com;
    mirrored.y() = -mirrored.y();
    const double apart = (mirrored - zero_[right.body] * right.pose * right.inertia.com).norm();
    if (a > 0 && b > 0 && apart > kAsymmetry * size_)
      warn(Subject::link, names, "their centres of mass are not mirror images of each other",
           millimetres(apart) + " apart with every joint at 0", apart);
  }

  // The vector from the right joint to the mirror image of the left one.
  Eigen::Vector3d displacement(const Dof& left, const Dof& right) const {
    Eigen::Vector3d mirrored = zero_[left.body].translation();
    mirrored.y() = -mirrored.y();
    return mirrored - zero_[right.body].translation();
  }

  void compare_dofs(const Dof& left, const Dof& right, const Eigen::Vector3d& before,
                    std::vector<std::string>& same, std::vector<std::string>& opposite) {
    const std::vector<std::string> names = {left.name, right.name};
    Eigen::Vector3d axis = zero_[left.body].linear() * model_.bodies()[left.body].axis;
    axis = left.prismatic ? Eigen::Vector3d(axis.x(), -axis.y(), axis.z())
                          : Eigen::Vector3d(-axis.x(), axis.y(), -axis.z());
    const double apart = (displacement(left, right) - before).norm();
    if (apart > kAsymmetry * size_)
      warn(Subject::joint, names, "their places are not mirror images of each other",
           millimetres(apart) + " apart", apart);
    const double along = axis.dot(zero_[right.body].linear() * model_.bodies()[right.body].axis);
    if (std::abs(along) < 0.99) {
      warn(Subject::joint, names, "their axes are not mirror images of each other");
      return;
    }
    const double lower = along > 0 ? left.lower : -left.upper;
    const double upper = along > 0 ? left.upper : -left.lower;
    const auto differ = [](double a, double b) { return a != b && !(std::abs(a - b) <= kDegree); };
    if (differ(lower, right.lower) || differ(upper, right.upper))
      warn(Subject::joint, names, "left and right limits differ",
           "the mirror image of the left range is " + text::brief(lower) + " to " +
               text::brief(upper) + ", the right range is " + text::brief(right.lower) + " to " +
               text::brief(right.upper),
           std::max(std::abs(lower - right.lower), std::abs(upper - right.upper)));
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
      warn(Subject::posture, "home",
           "the soles are not on one plane: the angle between them is " +
               text::fixed(tilt / kDegree, 1) + " deg, and their heights differ by " +
               millimetres(std::abs(step)) + "; correct the ankle angles");
    const double lean = elementary::acos(std::clamp(up.z(), -1.0, 1.0));
    if (lean > 5 * kDegree)
      warn(Subject::posture, "home",
           "the root link leans by " + text::fixed(lean / kDegree, 1) +
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
      warn(Subject::posture, "home",
           "the COG lies " + millimetres(-margin) +
               " outside the soles, so the robot falls; shift the COG over the feet");
  }

  const RobotModel& model_;
  std::vector<Eigen::Isometry3d> zero_;
  double size_ = 1;
  std::vector<Suspicion> suspicions_;
};

}  // namespace

std::vector<std::string> bodies_without_collision_shapes(const RobotModel& model) {
  std::vector<bool> covered(model.bodies().size(), false);
  for (const Link& link : model.links())
    if (!link.collisions.empty()) covered[link.body] = true;
  std::vector<std::string> missing;
  for (size_t i = 0; i < covered.size(); ++i) {
    const bool foot = model.has_soles() && (static_cast<int>(i) == model.sole(Side::left).body ||
                                            static_cast<int>(i) == model.sole(Side::right).body);
    const bool heavy = model.bodies()[i].inertia.mass > kLargeShare * model.mass();
    if (!covered[i] && (foot || heavy)) missing.push_back(model.bodies()[i].name);
  }
  return missing;
}

bool legs_have_collision_shapes(const RobotModel& model) {
  if (!model.has_soles()) return false;
  for (const Side side : {Side::left, Side::right}) {
    bool covered = false;
    for (const Link& link : model.links()) {
      if (link.collisions.empty()) continue;
      for (const int dof : model.leg(side)) covered |= model.dofs()[dof].body == link.body;
    }
    if (!covered) return false;
  }
  return true;
}

std::vector<ModelWarning> diagnose(const RobotModel& model) { return Doctor(model).examine(); }

}  // namespace ayumi
