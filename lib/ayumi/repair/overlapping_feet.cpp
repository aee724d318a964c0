// Two convex polygons overlap if none of their edges has the whole other polygon beyond it. The
// smallest overlap along the normal of an edge is the displacement that separates them.
#include "ayumi/repair/overlapping_feet.hpp"

#include <algorithm>
#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/repair/policy.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

double overlap_along_normals(const ConvexPolygon& a, const ConvexPolygon& b) {
  const std::vector<Vector2d>& corners = a.vertices();
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vector2d edge = corners[(i + 1) % corners.size()] - corners[i];
    const Vector2d normal = Vector2d(edge.y(), -edge.x()).normalized();
    least = std::min(least, a.support(normal) + b.support(-normal));
  }
  return least;
}

// The overlap of both soles along the ground of the first sole [m]; below 0 if they are apart.
double overlap(const RobotModel& model, const Isometry3d& left, const Isometry3d& right) {
  std::vector<Vector2d> moved;
  for (const Vector2d& corner : model.sole(Side::right).polygon)
    moved.push_back((left.inverse() * (right * Vector3d(corner.x(), corner.y(), 0))).head<2>());
  const ConvexPolygon a(model.sole(Side::left).polygon), b(moved);
  return std::min(overlap_along_normals(a, b), overlap_along_normals(b, a));
}

bool feet_collide(const RobotModel& model, const ConsistencyReport& report, double begin,
                  double end) {
  const int left = model.sole(Side::left).body, right = model.sole(Side::right).body;
  return std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& f) {
    const auto* pair = std::get_if<BodyPairPlace>(&f.place);
    return f.severity == Severity::error && pair && f.begin <= end && f.end >= begin &&
           std::minmax(pair->a, pair->b) == std::minmax(left, right);
  });
}

}  // namespace

std::optional<OverlappingFeet> overlapping_feet(const RobotModel& model,
                                                const CommandSeries& series,
                                                const ConsistencyReport& report) {
  // Overlap that the bands of two standing soles can remove [m]. Derived.
  constexpr double kMendable = 2 * policy::stance::kPosition;
  const ContactPlan plan = contact_plan(series);
  for (const ContactInterval& left : plan.intervals[0])
    for (const ContactInterval& right : plan.intervals[1]) {
      const int first = std::max(left.first, right.first), last = std::min(left.last, right.last);
      if (!left.contact || !right.contact || first > last) continue;
      const double depth = overlap(model, left.sole, right.sole);
      const double begin = first * series.dt, end = last * series.dt;
      if (depth <= kMendable || !feet_collide(model, report, begin, end)) continue;
      const bool left_came = left.first >= right.first;
      return OverlappingFeet{left_came ? Side::left : Side::right, begin, end, depth,
                             (left_came ? left : right).sole.translation()};
    }
  return {};
}

std::string words_of(const OverlappingFeet& feet) {
  const std::string came = name_of(feet.landed), stood = name_of(other(feet.landed));
  return "the " + came + " foot is planned to stand on the " + stood + " foot from " +
         text::fixed(feet.begin, 2) + " to " + text::fixed(feet.end, 2) +
         " s. The soles overlap by " + text::fixed(1000 * feet.depth, 0) +
         " mm. A repair does not move footholds. Move the foothold of the " + came +
         " foot away from the " + stood + " foot. This foothold is now at (" +
         text::fixed(feet.place.x(), 3) + ", " + text::fixed(feet.place.y(), 3) + ") m";
}

}  // namespace ayumi
