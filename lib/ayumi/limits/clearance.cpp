// Bodies of the robot do not overlap: the distance of every pair of their collision shapes, which
// is negative if they overlap (geometry/distance.hpp), stays above a margin. All pairs are examined
// every 20 ms, and then every sample around the times at which a pair is near
// (demand/collision_scan.hpp).
#include <algorithm>

#include "ayumi/demand/collision_scan.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Clearance below which bodies that do not overlap are a warning [m]. Chosen: the sag of servos
// under load moves links by about this distance. Half or twice the value changes no verdict. With
// half of the value, the clearance of the case "fast" changes from 12.1 to 11.1 mm; with twice, the
// clearance of the case "grip" changes from 12.2 to 14.6 mm.
constexpr double kClearanceTolerance = 0.002;

// If the clearance exceeds the tolerance by less than this, every sample is examined [m]. Chosen:
// in 20 ms, bodies approach each other by this distance at 0.5 m/s. With half of the value, the
// clearance of the case "slip" changes from 15 to 7.11 mm; with twice, the clearance of the case
// "walk" changes from 12.1 to 15 mm.
constexpr double kRefineBelow = 0.010;

void note_clearance(JudgedMotion& motion, int pair, int k, double clearance) {
  motion.lower(FindingKind::self_collision, clearance, k, pair);
  const double wanted = motion.tolerance(FindingKind::self_collision);
  if (clearance < wanted)
    motion.add(FindingKind::self_collision, pair, k, clearance, clearance < 0 ? 0 : wanted,
               -clearance, 0, clearance < 0 ? Severity::error : Severity::warning);
}

void scan_clearances(JudgedMotion& motion) {
  const double tolerance = motion.tolerance(FindingKind::self_collision);
  scan_clearance(motion.model, motion.series, motion.collisions, tolerance + kRefineBelow,
                 tolerance, [&motion](int pair, int k, double clearance) {
                   motion.clearances.push_back({pair, k, clearance});
                 });
}

void judge_clearances(JudgedMotion& motion) {
  for (const JudgedMotion::Clearance& c : motion.clearances)
    note_clearance(motion, c.pair, c.sample, c.value);
}

const RowKind kClearanceRows = {
    .name = "clearance", .unit = &RowPrices::length, .beyond_check = true, .order = {6, 0}};

// The distance that the repair keeps: the wanted one, or the distance in the given motion if it is
// smaller and the bodies do not touch. `own` is the distance in the given motion [m].
void add_clearance(RowSite& site, int point, const ShapePair& shapes, double own) {
  const RowSettings& settings = site.settings;
  const double kept = settings.clearance.kept;
  const double least = own > settings.clearance.touch ? std::min(kept, own) : kept;
  const int rows = clearance_point_count(*settings.collisions, shapes);
  Eigen::VectorXd lower = Eigen::VectorXd::Constant(rows, least);
  if (shapes.edges) lower[0] -= std::min(settings.clearance.edge_allowance, 0.5 * least);
  site.add(kClearanceRows, point, shapes.pair, ClearanceRows{settings.collisions, shapes}, lower,
           Eigen::VectorXd::Constant(rows, kUnbounded));
}

// Shapes are watched at a larger distance than bodies, because the next nearest shapes may be at a
// similar distance.
void place_pair_rows(RowSite& site, int point, int pair, RobotData& data) {
  const CollisionModel& collisions = *site.settings.collisions;
  const auto& settings = site.settings.clearance;
  std::vector<ShapePair> shapes = shape_pairs(collisions, pair);
  std::vector<double> least(shapes.size(), kUnbounded);
  double own = kUnbounded;
  const std::vector<const CommandSample*> samples = site.watched(point);
  for (const CommandSample* sample : samples) {
    update_positions(site.model, sample->state, data);
    for (size_t i = 0; i < shapes.size(); ++i) {
      const double here = shape_clearance(collisions, shapes[i], data, settings.watched_shapes);
      least[i] = std::min(least[i], here);
      if (sample == samples.front()) own = std::min(own, here);
      shapes[i].edges =
          shapes[i].edges || (here < settings.watched_shapes &&
                              edges_meet(collisions, shapes[i], data, settings.same_distance));
    }
  }
  if (*std::min_element(least.begin(), least.end()) >= settings.watched_bodies) return;
  for (size_t i = 0; i < shapes.size(); ++i)
    if (least[i] < settings.watched_shapes) add_clearance(site, point, shapes[i], own);
}

void place_clearance_rows(RowSite& site) {
  RobotData data(site.model);
  for (int point = 0; point < site.count(); ++point)
    if (site.points[point].only.empty())
      for (const int pair : site.settings.near_pairs) place_pair_rows(site, point, pair, data);
}

Place body_pair_place(const JudgedMotion& motion, const Violation& v) {
  const CollisionModel::Pair& pair = motion.collisions.pairs()[v.item];
  return BodyPairPlace{pair.a, pair.b};
}

Advice clearance_advice(const JudgedMotion&, const FindingWindow& window) {
  const double clearance = window.worst.value;
  if (clearance < 0) return {"these bodies overlap by " + in_mm(clearance), "move them apart", ""};
  return {"these bodies are only " + in_mm(clearance) + " apart", "move them further apart", ""};
}

std::string clearance_infeasibility(const Finding& f, double) {
  return "the bodies " + f.where + " overlap by " + in_mm(f.worst);
}

}  // namespace

const Limit& clearance_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::self_collision,
                    .unit = "m",
                    .tolerance = kClearanceTolerance,
                    .meaning = "clearance between two bodies. An overlap is an error; a clearance "
                               "below the tolerance is a warning",
                    .figure = {.key = "min_self_clearance_m",
                               .label = "least clearance of the links",
                               .unit = "mm",
                               .scale = 1e3,
                               .least = true,
                               .line = 20},
                    .place = body_pair_place,
                    .advice = clearance_advice,
                    .infeasibility = clearance_infeasibility}},
      .look_ahead = scan_clearances,
      .judge_motion = judge_clearances,
      .place_rows = place_clearance_rows};
  return limit;
}

}  // namespace ayumi
