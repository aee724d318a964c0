// The joints q of a limb minimize
//   F = w_p/L^2 sum |p(q) - p*|^2 / 2 + w_d sum |d(q) - d*|^2 / 2 + |q - q_keys|^2 / 2
// between their limits by Newton's method. With a_i the axis of a joint and r_i the vector from it
// to the end p: dp/dq_i = a_i x r_i, and for a joint i above a joint j, d2p/dq_i dq_j = a_i x
// dp/dq_j; the same holds for a direction d, with dd/dq_i = a_i x d.
#include "ayumi/plan/link_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Weights of a place (in lengths of the limb), of a direction and of a gaze, relative to the weight
// of 1 rad from the joints' keys. Chosen: a posture one radian away misses a place by a few
// nanometres; an arm of four joints needs a direction that yields to the place; where the direction
// is possible, it is met within a hundredth of a degree. With half and twice the weights, only
// these figures change.
constexpr double kPlaceWeight = 1e8, kDirectionWeight = 1e4, kGazeWeight = 1e8;

// A link has reached its place if its end is within this distance [m]. Chosen: no hand needs a
// tenth of a millimetre.
constexpr double kThere = 1e-4;
// A direction is met within this angle [rad]. Chosen: two degrees, because an arm of four joints
// can point a hand only approximately. With half, fewer directions are accepted; with twice, a
// person sees the difference.
constexpr double kAligned = 2 * M_PI / 180;

// Distance ahead of the head at which it looks without a target [m]. Chosen: the distance at which
// a person looks at a thing in the hand. It affects only the movement to the first target.
constexpr double kAhead = 1;

// Largest number of steps of Newton's method. Chosen: a few suffice near a solution; a start far
// away takes tens.
constexpr int kMostSteps = 200;
// Largest change of a joint in a step [rad, m]. Chosen: the quadratic model holds for such a
// change.
constexpr double kLongestStep = 0.3;
// After a step that is smaller than this, the next one would only be rounding [rad, m]. Derived:
// Newton's method squares the error, to less than the 1e-13 to which legs are solved.
constexpr double kLastStep = 1e-8;
// Largest multiplier of a term, divided by the root of the term's weight, while the steps are cut
// short. Chosen: far above that of a posture a few radians from its keys, and below what would
// outweigh the linear part of a limb that cannot reach.
constexpr double kLargestPull = 1;
// Step away from a point without a gradient, such as a straight arm [rad, m]. Chosen: about a
// degree.
constexpr double kNudge = 0.02;

// If the sum of the directions of keys is shorter than this, it has no direction. Chosen: such keys
// are more than about 170 degrees apart.
constexpr double kNoDirection = 0.08;

// Number of random postures from which a limb tries again before its target is called out of reach.
// Chosen: with 4, one of the messages about 24 random places beside HOAP-1 still states 10 mm where
// 8 mm are true; with 8, 16 and 32, all of them are true.
constexpr int kOtherStarts = 16;

// Updates the poses of these bodies in `data`. The root comes first, and the parent of each body is
// in the list too, or has not moved. The centres of mass are not updated.
void move_limb(const RobotModel& model, const RobotState& state, const std::vector<int>& path,
               RobotData& data) {
  for (const int b : path) {
    const Body& body = model.bodies()[static_cast<size_t>(b)];
    const double q = body.ratio * state.theta[body.dof] + body.offset;
    const Matrix3d before = data.rotation[body.parent] * body.placement.linear();
    data.axis[b] = before * body.axis;
    data.position[b] =
        data.position[body.parent] + data.rotation[body.parent] * body.placement.translation();
    if (body.prismatic) {
      data.rotation[b] = before;
      data.position[b] += q * data.axis[b];
    } else {
      data.rotation[b] = before * exp_rotation(q * body.axis).toRotationMatrix();
    }
  }
}

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// A weight below this counts as zero, and times [s] and angles [rad] closer than kSameMoment are
// equal. Chosen: above rounding.
constexpr double kNoWeight = 1e-12, kSameMoment = 1e-9;

Vector3d value_of(const std::array<Track, 3>& tracks, double t) {
  return {tracks[0].at(t).value, tracks[1].at(t).value, tracks[2].at(t).value};
}

std::string numbers(const Vector3d& v, int digits) {
  return "[" + text::fixed(v.x(), digits) + ", " + text::fixed(v.y(), digits) + ", " +
         text::fixed(v.z(), digits) + "]";
}

// The numbers of a place are probably in another unit if the place is farther than the first
// multiple of the COG height and if, read in the other unit, it is nearer than the second multiple.
// Chosen: arms and walks of a few metres reach less than the first distance and more than the
// second.
constexpr double kOtherUnit = 20, kSameUnit = 5;
// Each number of such a place is 0 or at least this large. Chosen: nobody writes a tenth of a
// millimetre. So a smaller number beside a large one is in metres, and the large one is a typing
// error.
constexpr double kWholeUnits = 0.5;

// The unit, mm or cm, in which a place that is far away would be near. Empty if there is none.
std::string other_unit(const Vector3d& place, double height) {
  if (place.norm() < kOtherUnit * height) return "";
  for (const double number : place)
    if (number != 0 && std::abs(number) < kWholeUnits) return "";
  for (const auto& [unit, factor] : {std::pair("cm", 1e-2), std::pair("mm", 1e-3)}) {
    const Vector3d meant = factor * place;
    if (meant.norm() < kSameUnit * height)
      return std::string("Lengths are in metres, and these numbers in ") + unit + " are " +
             numbers(meant, 4) + " m. ";
  }
  return "";
}

}  // namespace

LinkPlan::LinkPlan(const RobotModel& model, const Pattern& pattern, const std::vector<bool>& solved)
    : model_(&model), pattern_(&pattern) {
  std::vector<std::string> names;
  bool gaze = false;
  for (const Keyframe& key : pattern.keyframes) {
    for (const auto& [name, target] : key.hands)
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    gaze = gaze || key.gaze;
  }
  for (const std::string& name : names) add_target(name, false, solved);
  if (gaze) add_target("gaze", true, solved);
}

void LinkPlan::add_target(const std::string& name, bool gaze, const std::vector<bool>& solved) {
  const RobotModel& model = *model_;
  Target target;
  target.gaze = gaze;
  target.key = gaze ? "gaze" : "hands/" + name;
  const auto asks = [&](const Keyframe& key) -> const LinkTarget* {
    if (gaze) return key.gaze ? &*key.gaze : nullptr;
    const auto found = key.hands.find(name);
    return found == key.hands.end() ? nullptr : &found->second;
  };
  size_t first = 0;
  while (!asks(pattern_->keyframes[first])) ++first;
  const auto complain = [&](const std::string& message, bool unknown_name = false) {
    SourcePlace place = place_of_keyframe(*pattern_, first) + ("/" + target.key);
    place.unknown_name = unknown_name;
    fail(ErrorCode::bad_pattern, place, message);
  };
  if (gaze) {
    target.name = "gaze";
    target.body = head_body(model);
    if (target.body < 0)
      complain("the robot '" + model.name() +
               "' has no neck that could turn its head. Remove the key");
    target.axis = gaze_axis(model, target.body);
    target.point = model.bodies()[static_cast<size_t>(target.body)].inertia.com;
  } else if (name == "left" || name == "right") {
    target.name = name + " hand";
    target.body = hand_body(model, name == "left" ? Side::left : Side::right);
    if (target.body < 0)
      complain("the robot '" + model.name() + "' has no " + name +
               " arm of three joints or more. Give the name of the link that should move");
    target.point = limb_point(model, target.body);
  } else {
    const int link = model.find_link(name);
    if (link < 0) {
      std::vector<std::string> known = {"left", "right"};
      for (const Link& each : model.links()) known.push_back(each.name);
      complain("the robot '" + model.name() + "' has no link '" + name +
                   "'. Give left, right or the name of a link" + text::suggestion(name, known),
               true);
    }
    target.name = "link " + name;
    target.body = model.links()[static_cast<size_t>(link)].body;
    const bool moved = model.bodies()[static_cast<size_t>(target.body)].name == name;
    target.point = moved ? limb_point(model, target.body)
                         : Vector3d(model.links()[static_cast<size_t>(link)].pose.translation());
  }
  target.dofs = limb_dofs(model, target.body);
  for (const int dof : target.dofs)
    if (solved[static_cast<size_t>(dof)])
      complain(
          "the legs move this link, and Ayumi computes the legs from the feet, the trunk and the "
          "COG. Remove this key, and give keys of the feet, the trunk or the COG");
  if (target.dofs.empty())
    complain(
        "no joint moves this link alone. Remove this key, and give keys of \"torso\" or of joints");
  const auto& bodies = model.bodies();
  for (int b = target.body; b > 0; b = bodies[static_cast<size_t>(b)].parent)
    if (contains(target.dofs, bodies[static_cast<size_t>(b)].dof) && b != target.body)
      target.length += bodies[static_cast<size_t>(b)].placement.translation().norm();
  target.length = std::max(0.01, target.length + target.point.norm());
  if (!gaze && target.point.norm() > 1e-6) target.axis = target.point.normalized();

  // The keys of this target, and the keys of its joints after which the joints lead the limb again.
  double keyed = 0;  // last time at which the joints have keys before the first target
  for (size_t i = 0; i < pattern_->keyframes.size(); ++i) {
    const Keyframe& key = pattern_->keyframes[i];
    const LinkTarget* const asked = asks(key);
    if (asked && asked->direction && target.axis.isZero())
      complain("the link is a point and has no direction. Give its position without a direction");
    bool joints = false;
    const auto names_joint = [&](const auto& angles) {
      for (const auto& [joint, angle] : angles)
        joints = joints || contains(target.dofs, model.find_dof(joint));
    };
    if (key.posture) names_joint(posture_joints(model, *pattern_, *key.posture, key.place));
    names_joint(key.joints);
    if (!asked && !joints) continue;
    const bool free = !asked || !asked->position;
    if (free && target.anchors.empty()) {
      keyed = key.t;
      continue;
    }
    if (target.anchors.empty() && key.t > keyed) target.anchors.push_back({keyed, nullptr});
    target.anchors.push_back(
        {key.t, free ? nullptr : asked, key.interpolation.value_or(pattern_->interpolation), i});
  }
  if (target.anchors.empty()) return;  // no key gives the link a place
  fill_tracks(target);
  put_in_group(std::move(target));
}

void LinkPlan::fill_tracks(Target& target) const {
  const auto fill = [&](bool directions, Blend& blend) {
    // Keys by frame: x, y, z and their weight.
    std::array<std::array<std::vector<TrackKey>, 4>, 2> keys;
    for (const Anchor& anchor : target.anchors) {
      const LinkTarget* const asked = anchor.target;
      const bool given = asked && (directions ? asked->direction.has_value() : true);
      for (const auto frame : {LinkTarget::Frame::world, LinkTarget::Frame::trunk}) {
        const bool here = given && asked->frame == frame;
        auto& of_frame = keys[static_cast<size_t>(frame)];
        for (size_t i = 0; i < 4; ++i) {
          const auto axis = static_cast<Eigen::Index>(i);
          const double value = !here    ? 0
                               : i == 3 ? 1
                                        : (directions ? *asked->direction : *asked->position)[axis];
          of_frame[i].push_back({anchor.t, value, anchor.interpolation});
        }
      }
    }
    for (size_t i = 0; i < 3; ++i) {
      blend.world[i] = Track(keys[0][i]);
      blend.trunk[i] = Track(keys[1][i]);
    }
    blend.in_world = Track(keys[0][3]);
    blend.in_trunk = Track(keys[1][3]);
  };
  fill(false, target.place);
  fill(true, target.direction);
}

void LinkPlan::put_in_group(Target target) {
  Group group;
  group.targets.push_back(std::move(target));
  group.dofs = group.targets[0].dofs;
  for (auto it = groups_.begin(); it != groups_.end();) {
    const bool common = std::any_of(it->dofs.begin(), it->dofs.end(),
                                    [&](int dof) { return contains(group.dofs, dof); });
    if (!common) {
      ++it;
      continue;
    }
    for (Target& each : it->targets) group.targets.push_back(std::move(each));
    for (const int dof : it->dofs)
      if (!contains(group.dofs, dof)) group.dofs.push_back(dof);
    it = groups_.erase(it);
  }
  std::sort(group.dofs.begin(), group.dofs.end());
  for (Target& each : group.targets) {
    each.chain.clear();
    for (int b = each.body; b > 0; b = model_->bodies()[static_cast<size_t>(b)].parent) {
      const int dof = model_->bodies()[static_cast<size_t>(b)].dof;
      const auto at = std::find(group.dofs.begin(), group.dofs.end(), dof);
      if (at != group.dofs.end()) each.chain.emplace_back(b, at - group.dofs.begin());
    }
    std::reverse(each.chain.begin(), each.chain.end());
    for (int b = each.body; b >= each.chain.front().first;
         b = model_->bodies()[static_cast<size_t>(b)].parent)
      if (!contains(group.path, b)) group.path.push_back(b);
  }
  std::sort(group.path.begin(), group.path.end());
  for (const Target& each : group.targets) {
    const auto& anchors = each.anchors;
    for (size_t i = 0; i < anchors.size(); ++i) {
      const bool last = i + 1 == anchors.size();
      if (!anchors[i].target && (last || !anchors[i + 1].target)) continue;
      group.windows.emplace_back(anchors[i].t,
                                 last ? std::numeric_limits<double>::infinity() : anchors[i + 1].t);
    }
  }
  groups_.push_back(std::move(group));
}

bool LinkPlan::Group::at(double t) const {
  return std::any_of(windows.begin(), windows.end(),
                     [t](const auto& w) { return t >= w.first && t <= w.second; });
}

bool LinkPlan::leads(int dof, double t) const {
  return std::any_of(groups_.begin(), groups_.end(),
                     [&](const Group& group) { return contains(group.dofs, dof) && group.at(t); });
}

bool LinkPlan::leads(double t) const {
  return std::any_of(groups_.begin(), groups_.end(),
                     [&](const Group& group) { return group.at(t); });
}

bool LinkPlan::leads_in_world(double begin, double end) const {
  for (const Group& group : groups_)
    for (const Target& target : group.targets)
      for (size_t i = 0; i < target.anchors.size(); ++i) {
        const Anchor& anchor = target.anchors[i];
        if (!anchor.target || anchor.target->frame != LinkTarget::Frame::world) continue;
        const double from = i > 0 ? target.anchors[i - 1].t : anchor.t;
        const double until = i + 1 < target.anchors.size()
                                 ? target.anchors[i + 1].t
                                 : std::numeric_limits<double>::infinity();
        if (from < end && until > begin) return true;
      }
  return false;
}

std::string LinkPlan::origin() const {
  bool hands = false, gaze = false;
  for (const Group& group : groups_)
    for (const Target& target : group.targets) (target.gaze ? gaze : hands) = true;
  return hands && gaze ? "hands and gaze" : hands ? "hands" : gaze ? "gaze" : "";
}

double LinkPlan::bound(int dof, double keyed, bool upper) const {
  const Dof& joint = model_->dofs()[static_cast<size_t>(dof)];
  if (!joint.limited)
    return upper ? std::numeric_limits<double>::infinity()
                 : -std::numeric_limits<double>::infinity();
  const double margin = joint.prismatic ? 0
                                        : std::min(model_->description().soft_limit_margin,
                                                   0.5 * (joint.upper - joint.lower));
  return upper ? std::max(joint.upper - margin, keyed) : std::min(joint.lower + margin, keyed);
}

std::vector<LinkPlan::Aim> LinkPlan::aims_at(const Group& group, double t, const VectorXd& keyed,
                                             const RobotState& state, RobotData& data,
                                             bool directions) const {
  const int trunk = model_->trunk_body();
  std::vector<Aim> aims;
  std::vector<Vector3d> by_keys(group.targets.size()), ahead(group.targets.size());
  RobotState led_by_keys = state;
  for (const int dof : group.dofs) led_by_keys.theta[dof] = keyed[dof];
  update_positions(*model_, led_by_keys, data);
  for (size_t i = 0; i < group.targets.size(); ++i) {
    const Target& target = group.targets[i];
    by_keys[i] = data.pose(target.body) * target.point;
    ahead[i] = data.rotation[target.body] * target.axis;
  }
  update_positions(*model_, state, data);
  const Eigen::Isometry3d frame = data.pose(trunk);
  for (size_t i = 0; i < group.targets.size(); ++i) {
    const Target& target = group.targets[i];
    if (t < target.anchors.front().t) continue;
    const auto weight = [&](const Blend& blend) {
      return 1 - blend.in_world.at(t).value - blend.in_trunk.at(t).value;
    };
    const double rest = weight(target.place);
    Aim aim;
    aim.target = &target;
    aim.place = value_of(target.place.world, t) + frame.linear() * value_of(target.place.trunk, t) +
                target.place.in_trunk.at(t).value * frame.translation();
    const auto meet = [&](const Vector3d& sum) {
      if (sum.norm() < kNoDirection)
        fail(ErrorCode::bad_pattern, in_file(*pattern_, "/keyframes"),
             "t = " + text::fixed(t, 3) + " s: the " + target.name +
                 " would have to turn by 180 deg, because two successive keys have opposite "
                 "directions. Add a key between these two keys");
      return sum.normalized();
    };
    if (target.gaze) {
      const Vector3d eye = data.pose(target.body) * target.point;
      aim.place += rest * (by_keys[i] + kAhead * ahead[i]);
      aim.direction = meet(aim.place - eye);
      aim.direction_weight = kGazeWeight;
    } else {
      aim.place += rest * by_keys[i];
      aim.place_weight = kPlaceWeight / (target.length * target.length);
      const double without = weight(target.direction);
      if (directions && without < 1 - kNoWeight) {
        const Vector3d free = data.rotation[target.body] * target.axis;
        aim.direction = meet(value_of(target.direction.world, t) +
                             frame.linear() * value_of(target.direction.trunk, t) + without * free);
        aim.direction_weight = kDirectionWeight;
      }
    }
    aims.push_back(aim);
  }
  return aims;
}

double LinkPlan::minimize(const Group& group, const std::vector<Aim>& aims, const VectorXd& keyed,
                          RobotState& state, RobotData& data) const {
  const auto n = static_cast<Eigen::Index>(group.dofs.size());
  VectorXd q(n), ref(n), low(n), high(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int dof = group.dofs[static_cast<size_t>(i)];
    ref[i] = keyed[dof];
    low[i] = bound(dof, ref[i], false);
    high[i] = bound(dof, ref[i], true);
    q[i] = std::clamp(state.theta[dof], low[i], high[i]);
  }
  const VectorXd start = q;
  const auto put = [&](const VectorXd& x) {
    for (Eigen::Index i = 0; i < n; ++i) state.theta[group.dofs[static_cast<size_t>(i)]] = x[i];
  };
  // The terms of the sum. Each has its residual, the derivatives of the residual, and a multiplier,
  // which is the residual that is expected after the step. The curvature that is computed with the
  // multiplier is also right far away from the solution.
  struct Term {
    double weight = 0;
    Vector3d off = Vector3d::Zero();
    Eigen::Matrix3Xd columns;
    Vector3d multiplier = Vector3d::Zero();
  };
  std::vector<Term> terms(2 * aims.size());
  VectorXd gradient(n);
  MatrixXd linear(n, n), curved(n, n);
  std::vector<Vector3d> axes, columns;
  const auto derive = [&](const VectorXd& x) {
    put(x);
    move_limb(*model_, state, group.path, data);
    gradient = x - ref;
    linear.setIdentity();
    curved.setZero();
    for (size_t number = 0; number < aims.size(); ++number) {
      const Aim& aim = aims[number];
      const Target& target = *aim.target;
      const Vector3d end = data.rotation[target.body] * target.point + data.position[target.body];
      const auto add = [&](Term& term, double weight, const Vector3d& off, const auto& derivative) {
        term.weight = weight;
        term.off = off;
        term.columns.setZero(3, n);
        axes.clear();
        columns.clear();
        for (const auto& [moved, column] : target.chain) {
          const Body& body = model_->bodies()[static_cast<size_t>(moved)];
          const Vector3d a = body.ratio * data.axis[moved];
          columns.push_back(derivative(body.prismatic, a, moved));
          axes.push_back(body.prismatic ? Vector3d::Zero() : a);
          term.columns.col(column) += columns.back();
        }
        gradient += weight * term.columns.transpose() * off;
        linear += weight * term.columns.transpose() * term.columns;
        for (size_t i = 0; i < columns.size(); ++i)
          for (size_t j = 0; j < columns.size(); ++j)
            curved(target.chain[i].second, target.chain[j].second) +=
                axes[std::min(i, j)].cross(columns[std::max(i, j)]).dot(term.multiplier);
      };
      if (aim.place_weight > 0)
        add(terms[2 * number], aim.place_weight, data.base_position + end - aim.place,
            [&](bool prismatic, const Vector3d& a, int body) -> Vector3d {
              return prismatic ? a : Vector3d(a.cross(end - data.position[body]));
            });
      if (aim.direction_weight > 0) {
        const Vector3d along = data.rotation[target.body] * target.axis;
        add(terms[2 * number + 1], aim.direction_weight, along - aim.direction,
            [&](bool prismatic, const Vector3d& a, int) -> Vector3d {
              return prismatic ? Vector3d::Zero() : Vector3d(a.cross(along));
            });
      }
    }
  };
  for (int step = 0; step < kMostSteps; ++step) {
    derive(q);
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!((q[i] <= low[i] && gradient[i] > 0) || (q[i] >= high[i] && gradient[i] < 0)))
        free.push_back(i);
    VectorXd way;
    bool convex = true;
    // A joint at its limit that this step would move beyond it stays there, and the step is solved
    // again for the other joints. Otherwise such a joint could be free in every other step, without
    // end.
    for (size_t tried = free.size() + 1; tried != free.size();) {
      tried = free.size();
      way = VectorXd::Zero(n);
      if (free.empty()) break;
      const MatrixXd hessian = linear(free, free) + curved(free, free);
      Eigen::LLT<MatrixXd> factor(hessian);
      convex = factor.info() == Eigen::Success;
      if (!convex) factor.compute(MatrixXd(linear(free, free)));
      const VectorXd slope = gradient(free);
      const VectorXd solved = factor.solve(slope);
      for (size_t i = 0; i < free.size(); ++i) way[free[i]] = -solved[static_cast<Eigen::Index>(i)];
      std::erase_if(free, [&](Eigen::Index i) {
        return (q[i] <= low[i] && way[i] < 0) || (q[i] >= high[i] && way[i] > 0);
      });
    }
    const double longest = way.cwiseAbs().maxCoeff();
    if (!convex && !free.empty() && longest < kLastStep) {
      // The gradient is zero, but this is not a minimum of the sum: the sum decreases towards the
      // middle of the joints' ranges.
      for (const Eigen::Index i : free) {
        const double middle =
            std::isfinite(low[i]) && std::isfinite(high[i]) ? 0.5 * (low[i] + high[i]) : q[i] + 1;
        q[i] += std::copysign(kNudge, middle - q[i]);
      }
      q = q.cwiseMax(low).cwiseMin(high);
      continue;
    }
    if (longest > kLongestStep) way *= kLongestStep / longest;
    const VectorXd before = q;
    q = (q + way).cwiseMax(low).cwiseMin(high);
    // As long as the steps are cut short, the posture is far from the solution, and the residual of
    // a target out of reach would outweigh everything else as a multiplier. Near the solution only
    // the full residual gives the true curvature.
    for (Term& term : terms)
      if (term.weight > 0) {
        term.multiplier = term.weight * (term.off + term.columns * (q - before));
        const double most = kLargestPull * std::sqrt(term.weight);
        if (longest > kLongestStep && term.multiplier.norm() > most)
          term.multiplier *= most / term.multiplier.norm();
      }
    if (longest < kLastStep) break;
  }
  put(q);
  move_limb(*model_, state, group.path, data);
  return (q - start).cwiseAbs().maxCoeff();
}

double LinkPlan::solve(double t, const VectorXd& keyed, RobotState& state, RobotData& data) const {
  double change = 0;
  if (!leads(t)) return change;
  update_positions(*model_, state, data);
  for (const Group& group : groups_) {
    if (!group.at(t)) continue;
    const VectorXd before = state.theta;
    std::vector<Aim> aims = aims_at(group, t, keyed, state, data, false);
    const bool directed =
        std::any_of(group.targets.begin(), group.targets.end(), [t](const Target& target) {
          return !target.gaze && (target.direction.in_world.at(t).value > kNoWeight ||
                                  target.direction.in_trunk.at(t).value > kNoWeight);
        });
    // A direction fades in, starting from the direction that the link has without it.
    if (directed) {
      RobotState without = state;
      minimize(group, aims, keyed, without, data);
      const std::vector<Aim> with = aims_at(group, t, keyed, without, data, true);
      aims = with;
    }
    minimize(group, aims, keyed, state, data);
    update_positions(*model_, state, data);
    if (!reached(aims, data)) complain(group, t, aims, keyed, state, data);
    change = std::max(change, (state.theta - before).cwiseAbs().maxCoeff());
  }
  return change;
}

namespace {

// The distance of a point from the place of its target [m], and the angle between a direction and
// that of its target [rad]. Each is 0 if the target is reached, or if its weight is 0.
double off_place(const Vector3d& end, const Vector3d& place, double weight) {
  const double missing = weight > 0 ? (end - place).norm() : 0;
  return missing > kThere ? missing : 0;
}

double off_direction(const Vector3d& along, const Vector3d& direction, double weight) {
  const double angle =
      weight > 0 ? elementary::atan2(along.cross(direction).norm(), along.dot(direction)) : 0;
  return angle > kAligned ? angle : 0;
}

// Whether keys of the trunk or of the COG height, or steps, move the trunk between these times.
bool trunk_moves(const Pattern& pattern, double begin, double end) {
  const auto changes = [&](const auto& value_of_key) {
    std::optional<Vector3d> before;
    for (const Keyframe& key : pattern.keyframes) {
      const std::optional<Vector3d> value = value_of_key(key);
      if (!value) continue;
      const bool moves = before && (*value - *before).norm() > kSameMoment;
      if (moves && key.t > begin) return true;
      before = value;
      if (key.t >= end) break;
    }
    return false;
  };
  const bool steps = std::any_of(pattern.phases.begin(), pattern.phases.end(),
                                 [&, from = 0.0](const Phase& phase) mutable {
                                   const double first = from;
                                   from = phase.until;
                                   return phase.swing && first < end && phase.until > begin;
                                 });
  return steps || changes([](const Keyframe& key) { return key.torso; }) ||
         changes([](const Keyframe& key) -> std::optional<Vector3d> {
           if (!key.cog_height) return std::nullopt;
           return Vector3d(0, 0, *key.cog_height);
         });
}

}  // namespace

bool LinkPlan::reached(const std::vector<Aim>& aims, const RobotData& data) const {
  return std::all_of(aims.begin(), aims.end(), [&](const Aim& aim) {
    const Eigen::Isometry3d pose = data.pose(aim.target->body);
    return off_place(pose * aim.target->point, aim.place, aim.place_weight) == 0 &&
           off_direction(pose.linear() * aim.target->axis, aim.direction, aim.direction_weight) ==
               0;
  });
}

void LinkPlan::complain(const Group& group, double t, const std::vector<Aim>& aims,
                        const VectorXd& keyed, RobotState& state, RobotData& data) const {
  const auto missed =
      std::find_if(aims.begin(), aims.end(), [&](const Aim& aim) { return !reached({aim}, data); });
  const Target& target = *missed->target;
  const auto next = std::find_if(target.anchors.begin(), target.anchors.end(),
                                 [t](const Anchor& anchor) { return anchor.t >= t - kSameMoment; });
  const Anchor& key = next == target.anchors.end() ? target.anchors.back() : *next;
  const bool under_way = next != target.anchors.end() && key.t > t + kSameMoment;
  const bool in_trunk = key.target && key.target->frame == LinkTarget::Frame::trunk;
  // If the trunk moves until the time of the key, it is not known here what the limb reaches then.
  const bool trunk_waits = in_trunk || !trunk_moves(*pattern_, t, key.t);
  const bool only_way = under_way && !trunk_waits;
  if (only_way && t < forgiven_before_ - kSameMoment) return;
  // If the target is out of reach on the way to a key, and also at the key, the message states the
  // distance at the key.
  if (under_way && key.target && trunk_waits) {
    RobotState there = state;
    std::vector<Aim> goal = aims_at(group, key.t, keyed, there, data, true);
    minimize(group, goal, keyed, there, data);
    if (!reached(goal, data)) complain(group, key.t, goal, keyed, there, data);
    update_positions(*model_, state, data);
  }
  // The limb may be in a posture from which every small change leads away from the target. Other
  // postures show how near it comes. While the trunk still moves to its place at the key, they say
  // nothing about the time of the key, so they are not tried.
  const auto off = [&] {
    const Eigen::Isometry3d pose = data.pose(target.body);
    return std::pair(
        off_place(pose * target.point, missed->place, missed->place_weight),
        off_direction(pose.linear() * target.axis, missed->direction, missed->direction_weight));
  };
  std::pair<double, double> least = off();
  VectorXd nearest = state.theta;
  Random random(1);
  const int starts = only_way ? 0 : kOtherStarts;
  for (int start = 0; start < starts && least > std::pair(0.0, 0.0); ++start) {
    for (const int dof : group.dofs) {
      const double low = bound(dof, keyed[dof], false), high = bound(dof, keyed[dof], true);
      const double middle = keyed[dof], width = 2 * M_PI;  // of a joint without limits
      state.theta[dof] = std::isfinite(low) && std::isfinite(high)
                             ? low + random.uniform() * (high - low)
                             : middle + (random.uniform() - 0.5) * width;
    }
    minimize(group, aims, keyed, state, data);
    const bool others_reached = std::all_of(aims.begin(), aims.end(), [&](const Aim& aim) {
      return aim.target == &target || reached({aim}, data);
    });
    if (others_reached && off() < least) {
      least = off();
      nearest = state.theta;
    }
  }
  state.theta = nearest;
  update_positions(*model_, state, data);
  const Eigen::Isometry3d pose = data.pose(target.body), trunk = data.pose(model_->trunk_body());
  const Vector3d end = pose * target.point, along = pose.linear() * target.axis;
  const auto [missing, angle] = least;
  const auto degrees = [](double radians) { return text::fixed(radians * 180 / M_PI, 1) + " deg"; };
  std::vector<std::string> at_limit;
  for (const int dof : group.dofs) {
    const Dof& joint = model_->dofs()[static_cast<size_t>(dof)];
    const double theta = state.theta[dof];
    if (joint.limited && (theta <= bound(dof, theta, false) + kSameMoment ||
                          theta >= bound(dof, theta, true) - kSameMoment))
      at_limit.push_back(joint.name);
  }
  const std::string limits =
      at_limit.empty() || least == std::pair(0.0, 0.0)
          ? ""
          : ", with " + text::join(at_limit, ", ") + " at " +
                (at_limit.size() > 1 ? "their position limits" : "its position limit");
  const std::string in_frame = in_trunk ? " in the frame of the trunk" : "";
  std::string what, remedy;
  if (least == std::pair(0.0, 0.0)) {
    std::vector<std::string> angles;
    for (const int dof : target.dofs) {
      const Dof& joint = model_->dofs()[static_cast<size_t>(dof)];
      angles.push_back(
          joint.name + " " +
          (joint.prismatic ? text::fixed(state.theta[dof], 4) + " m" : degrees(state.theta[dof])));
    }
    what = "the " + target.name + " cannot reach this place from the posture before this time";
    remedy = "These angles reach the place: " + text::join(angles, ", ") +
             ". Give the joints keys with these angles at this time";
  } else if (target.gaze) {
    what = "the gaze misses its point by " + degrees(angle);
    remedy = "Give a point that is nearer to the forward direction, or turn the torso";
  } else if (missing > 0) {
    what = "the " + target.name + " is out of reach by " + millimetres(missing);
    remedy =
        other_unit(in_trunk ? Vector3d(trunk.inverse() * missed->place) : missed->place,
                   data.cog.z()) +
        "The " + target.name + " reaches only " +
        numbers(in_trunk ? Vector3d(trunk.inverse() * end) : end, 4) + " m" + in_frame +
        (only_way ? ". The trunk also moves at this time. Let the hand begin to move after the "
                    "trunk has stopped (with a key \"free\" of the hand at that time), or "
                    "move the target"
                  : ". Move the target, or move or tilt the trunk");
  } else {
    what = "the " + target.name + " is at its place, but its direction differs by " +
           degrees(angle) + " from the direction of the key (allowed " + degrees(kAligned) + ")";
    remedy = "At this place, its " + std::to_string(target.dofs.size()) +
             " joints allow the direction " +
             numbers(in_trunk ? Vector3d(trunk.linear().transpose() * along) : along, 3) +
             in_frame + ". Give this direction, or leave the direction out";
  }
  const SourcePlace place = place_of_keyframe(*pattern_, key.keyframe) + ("/" + target.key);
  const std::string message = "t = " + text::fixed(t, 3) + " s" +
                              (under_way ? ", on the way to this key" : "") + ": " + what + limits +
                              ". " + remedy;
  if (only_way) throw MissedOnTheWay(message, place, key.t);
  fail(ErrorCode::bad_pattern, place, message);
}

}  // namespace ayumi
