#include "ayumi/render/overlay.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/math/polygon.hpp"
#include "ayumi/sim/has_zmp.hpp"

// Marks on the ground lie in layers a fraction of a millimetre apart, so that the depth test keeps
// their order: support polygon, trails, cross, ring, disc.

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4f;

/// The ground plane, and the size of the marks on it.
struct Plane {
  Vector3d normal, u, v, origin;
  double size;  ///< height of the robot [m]

  /// The point below p, along gravity, on the plane, and then `layer` steps above it.
  Vector3d drop(const Vector3d& p, int layer) const {
    const Vector3d on = p - Vector3d::UnitZ() * (normal.dot(p - origin) / normal.z());
    return on + normal * (0.0008 * size * layer);
  }
};

Plane make_plane(const Eigen::Isometry3d& ground, double size) {
  const Eigen::Matrix3d axes = ground.linear();
  return {axes.col(2), axes.col(0), axes.col(1), ground.translation(), size};
}

Vector4f faded(Vector4f color, double opacity) {
  color[3] *= static_cast<float>(opacity);
  return color;
}

void add_support(Triangles& target, std::vector<Vector3d> corners, const Plane& plane) {
  if (corners.size() < 3) return;
  for (Vector3d& corner : corners) corner += plane.normal * (0.0008 * plane.size);
  add_polygon(target, corners, faded(overlay_color::kSupport, 0.22));
  for (Vector3d& corner : corners) corner += plane.normal * (0.0008 * plane.size);
  add_band(target, corners,
           std::vector<Vector4f>(corners.size(), faded(overlay_color::kSupport, 0.9)), plane.normal,
           0.006 * plane.size, true);
}

void add_trail(Triangles& target, const SimulationLog& log, double t, const OverlayOptions& options,
               const Plane& plane, Vector3d SimulationSample::*quantity, const Vector4f& color,
               int layer) {
  std::vector<Vector3d> points;
  std::vector<Vector4f> colors;
  const int steps = std::max(2, static_cast<int>(std::ceil(options.trail / 0.01)));
  for (int k = steps; k >= 0; --k) {
    const double age = options.trail * k / steps;
    if (t - age < 0) continue;
    const auto index =
        std::min(log.samples.size() - 1, static_cast<size_t>(std::llround((t - age) / log.dt)));
    const SimulationSample& sample = log.samples[index];
    if (quantity == &SimulationSample::zmp && !has_zmp(sample)) {
      add_band(target, points, colors, plane.normal, 0.006 * plane.size);
      points.clear();
      colors.clear();
      continue;
    }
    const Vector3d point = plane.drop(sample.*quantity, layer);
    if (!points.empty() && (point - points.back()).norm() < 1e-5) {
      colors.back() = faded(color, 1 - age / options.trail);
      continue;
    }
    points.push_back(point);
    colors.push_back(faded(color, 1 - age / options.trail));
  }
  add_band(target, points, colors, plane.normal, 0.006 * plane.size);
}

void add_cog(Triangles& target, const Vector3d& cog, const Plane& plane) {
  const double size = plane.size;
  const Vector3d foot = plane.drop(cog, 5);
  const Vector4f color = overlay_color::kCog;
  add_sphere(target, cog, 0.026 * size, color);
  add_rod(target, foot, cog, 0.0035 * size, faded(color, 0.85));
  for (const double turn : {-1.0, 1.0}) {
    const Vector3d arm = (0.025 * size) * (plane.u + turn * plane.v);
    add_band(target, {foot - arm, foot + arm}, {color, color}, plane.normal, 0.010 * size);
  }
}

void add_forces(Triangles& target, const SimulationSample& sample, double weight,
                const Plane& plane) {
  for (size_t side = 0; side < 2; ++side) {
    const double share = sample.foot_force[side].norm() / weight;
    if (share < 0.01) continue;
    // Forces of impacts exceed the weight many times, so that their arrow is cut at twice the
    // weight.
    const Vector3d arrow =
        sample.foot_force[side].normalized() * (0.5 * plane.size * std::min(share, 2.0));
    add_arrow(target, sample.foot_cop[side], sample.foot_cop[side] + arrow, 0.008 * plane.size,
              overlay_color::kForce);
  }
}

double shown_until(const PushRecord& push, const OverlayOptions& options) {
  return std::max(push.end, push.begin + options.push_hold);
}

void add_pushes(Overlay& overlay, const std::vector<PushRecord>& pushed, double t,
                const SimulationSample& sample, const OverlayOptions& options, double size) {
  for (const PushRecord& push : pushed) {
    if (!shows_push({push}, t, t, options)) continue;
    const double last = shown_until(push, options);
    const double fade_from = std::max(push.end, push.begin + 0.6 * options.push_hold);
    const double opacity = t <= fade_from ? 1.0 : (last - t) / (last - fade_from);
    const Vector3d direction = (push.impulse.norm() > 0 ? push.impulse : push.peak).normalized();
    // The tip of the arrow touches the robot at this point and moves on with the COG while the
    // arrow fades.
    const Vector3d tip = sample.cog + push.from_cog;
    const Vector3d tail = tip - options.push_length * size * direction;
    add_arrow(overlay.triangles, tail, tip, 0.014 * size, faded(overlay_color::kPush, opacity));
    overlay.labels.push_back({tail + Vector3d::UnitZ() * (0.08 * size), push_text(push), opacity});
  }
}

/// Returns 2/3 if a joint begins to be near a limit of its range, 1 at the limit, and less
/// elsewhere. The value never begins to rise before the home. If the home is at the limit or close
/// to it, the value is 1 only where the servo has yielded by more than a limb's weight bends it.
double position_use(const Dof& dof, double theta, double home) {
  // The part of the range that is near a limit. Chosen: a tenth is 10 to 20 degrees of most joints.
  // With half of the value, a warning comes late; with twice, strongly bent knees are always
  // marked.
  constexpr double kNear = 0.1;
  // The part of the range by which a servo yields at most under a limb at rest. Chosen: HOAP-3's
  // elbow yields by 0.6 % of its range under the weight of the forearm.
  constexpr double kYield = 0.01;
  double use = 0;
  for (const double side : {-1.0, 1.0}) {
    const double limit = side < 0 ? dof.lower : dof.upper;
    const double range = dof.upper - dof.lower, at_home = std::max(0.0, side * (limit - home));
    // The distances from the limit at which the value is 0 and 1. At least kYield is between them.
    const double cold = std::min(3 * kNear * range, at_home);
    const double hot = std::min(0.0, cold - kYield * range);
    const double left = side * (limit - theta);
    use = std::max(use, hot < cold ? (cold - left) / (cold - hot) : left < hot ? 1.0 : 0.0);
  }
  return use;
}

// Marks for what the robot's files say: the places of the soles, the axes about which joints turn
// by positive angles (right-handed about the arrow), and the direction ahead.
void add_model(Triangles& target, const RobotModel& model,
               const std::vector<Eigen::Isometry3d>& poses, const Plane& plane) {
  const double size = plane.size;
  for (size_t i = 1; i < poses.size(); ++i) {
    const Body& body = model.bodies()[i];
    const Vector3d at = poses[i].translation();
    const Vector3d along = body.ratio * (poses[i].linear() * body.axis);
    add_arrow(target, at - 0.02 * size * along, at + 0.05 * size * along, 0.004 * size,
              overlay_color::kAxis);
  }
  if (!model.has_soles()) return;
  Vector3d middle = Vector3d::Zero(), ahead = Vector3d::Zero();
  for (const Side side : {Side::left, Side::right}) {
    const Sole& sole = model.sole(side);
    const Eigen::Isometry3d pose = poses[sole.body] * sole.frame;
    std::vector<Vector3d> corners;
    for (const Eigen::Vector2d& p : sole.polygon)
      corners.push_back(pose * Vector3d(p.x(), p.y(), 0.002 * size));
    add_band(target, corners, std::vector<Vector4f>(corners.size(), overlay_color::kSupport),
             plane.normal, 0.006 * size, true);
    middle += 0.5 * (pose * Vector3d(sole.center.x(), sole.center.y(), 0.01 * size));
    ahead += 0.5 * pose.linear().col(0);
  }
  add_arrow(target, middle, middle + 0.35 * size * ahead, 0.008 * size, overlay_color::kAhead);
}

}  // namespace

std::vector<Vector3d> support_corners(const RobotModel& model,
                                      const std::vector<Eigen::Isometry3d>& poses,
                                      const std::array<bool, 2>& contact,
                                      const Eigen::Isometry3d& ground) {
  if (!model.has_soles()) return {};
  const Plane plane = make_plane(ground, 1);
  std::vector<Eigen::Vector2d> points;
  for (const Side side : {Side::left, Side::right}) {
    if (!contact[static_cast<size_t>(side)]) continue;
    const Sole& sole = model.sole(side);
    const Eigen::Isometry3d frame = poses[size_t(sole.body)] * sole.frame;
    for (const Eigen::Vector2d& corner : sole.polygon) {
      const Vector3d p = plane.drop(frame * Vector3d(corner.x(), corner.y(), 0), 0) - plane.origin;
      points.emplace_back(plane.u.dot(p), plane.v.dot(p));
    }
  }
  if (points.empty()) return {};
  std::vector<Vector3d> corners;
  const ConvexPolygon hull(std::move(points));
  for (const Eigen::Vector2d& corner : hull.vertices())
    corners.push_back(plane.origin + corner.x() * plane.u + corner.y() * plane.v);
  return corners;
}

std::vector<float> joint_heat(const RobotModel& model, const std::string& profile,
                              const SimulationSample& sample) {
  const std::vector<std::string> known = model.profile_names();
  const bool has = std::find(known.begin(), known.end(), profile) != known.end();
  const ActuatorLimits& limits = model.limits(has ? profile : "");
  const Eigen::VectorXd home = model.rest_state().theta;
  std::vector<float> heat;
  for (const Body& body : model.bodies()) {
    double use = 0;
    const auto i = body.dof;
    if (i >= 0) {
      const Dof& dof = model.dofs()[size_t(i)];
      if (dof.limited && dof.upper > dof.lower)
        use = position_use(dof, sample.state.theta[i], home[i]);
      if (sample.state.dtheta.size() > i)
        use = std::max(use, std::abs(sample.state.dtheta[i]) / limits.speed[i]);
      if (sample.torque.size() > i)
        use = std::max(use, std::abs(sample.torque[i]) / limits.peak_torque[i]);
    }
    heat.push_back(static_cast<float>(std::clamp(3 * use - 2, 0.0, 1.0)));
  }
  return heat;
}

bool shows_push(const std::vector<PushRecord>& pushed, double begin, double end,
                const OverlayOptions& options) {
  return std::any_of(pushed.begin(), pushed.end(), [&](const PushRecord& push) {
    return end >= push.begin - 1e-9 && begin < shown_until(push, options);
  });
}

Overlay make_overlay(const RobotModel& model, const SimulationLog& log,
                     const std::vector<PushRecord>& pushed, double t,
                     const SimulationSample& sample, const std::vector<Eigen::Isometry3d>& poses,
                     double height, const OverlayOptions& options) {
  Overlay overlay;
  Triangles& target = overlay.triangles;
  const Eigen::Isometry3d ground = marked_ground(log, t, sample);
  const Plane plane = make_plane(ground, height);
  if (options.support)
    add_support(target, support_corners(model, poses, sample.planned_contact, ground), plane);
  if (options.trails && options.cog)
    add_trail(target, log, t, options, plane, &SimulationSample::cog, overlay_color::kCog, 3);
  if (options.trails && options.zmp)
    add_trail(target, log, t, options, plane, &SimulationSample::zmp, overlay_color::kZmp, 4);
  if (options.model) add_model(target, model, poses, plane);
  if (options.cog) add_cog(target, sample.cog, plane);
  if (options.reference_zmp && (sample.planned_contact[0] || sample.planned_contact[1]))
    add_ring(target, plane.drop(sample.reference_zmp, 6), plane.normal, 0.026 * height,
             0.036 * height, overlay_color::kReferenceZmp);
  if (options.zmp && has_zmp(sample))
    add_ring(target, plane.drop(sample.zmp, 7), plane.normal, 0, 0.020 * height,
             overlay_color::kZmp);
  if (options.forces) add_forces(target, sample, 9.81 * model.mass(), plane);
  if (options.push) add_pushes(overlay, pushed, t, sample, options, height);
  return overlay;
}

}  // namespace ayumi
