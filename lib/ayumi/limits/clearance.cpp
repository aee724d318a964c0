// Bodies of the robot do not overlap: the distance of every pair of their collision shapes,
// negative where they overlap (geometry/distance.hpp), stays above a margin. Every 20 ms all pairs
// are looked at, then every sample around the places where a pair is near
// (demand/collision_scan.hpp).
#include "ayumi/demand/collision_scan.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Clearance below which bodies that do not overlap are a warning [m]. Chosen: what servos sag under
// load moves links by about this much. Half or twice of it changes no verdict. Half: fast,
// clearance 12.1 to 11.1 mm; twice: grip, clearance 12.2 to 14.6 mm.
constexpr double kClearanceTolerance = 0.002;

// Clearance above the tolerance from which every sample is looked at [m]. Chosen: in 20 ms bodies
// approach each other by this much at 0.5 m/s. Half: slip, clearance 15 to 7.11 mm; twice: walk,
// clearance 12.1 to 15 mm.
constexpr double kRefineBelow = 0.010;

void note_clearance(JudgedMotion& motion, int pair, int k, double clearance) {
  motion.lower(FindingKind::self_collision, clearance);
  const double wanted = motion.tolerance(FindingKind::self_collision);
  if (clearance < wanted)
    motion.add(FindingKind::self_collision, pair, k, clearance, clearance < 0 ? 0 : wanted,
               -clearance, 0, clearance < 0 ? Severity::error : Severity::warning);
}

void judge_clearances(JudgedMotion& motion) {
  const double near = motion.tolerance(FindingKind::self_collision) + kRefineBelow;
  scan_clearance(
      motion.model, motion.series, motion.collisions, near,
      [&motion](int pair, int k, double clearance) { note_clearance(motion, pair, k, clearance); });
}

Place body_pair_place(const JudgedMotion& motion, const Violation& v) {
  const CollisionModel::Pair& pair = motion.collisions.pairs()[v.item];
  return BodyPairPlace{pair.a, pair.b};
}

Advice clearance_advice(const JudgedMotion&, const FindingWindow& window) {
  const double clearance = window.worst.value;
  return clearance < 0 ? "these bodies overlap by " + in_mm(clearance) + ": keep them apart"
                       : "only " + in_mm(clearance) + " between these bodies";
}

std::string clearance_obstacle(const Finding& f, double) {
  return f.where + " overlap by " + in_mm(f.worst);
}

}  // namespace

const Limit& clearance_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::self_collision,
                    .unit = "m",
                    .tolerance = kClearanceTolerance,
                    .meaning = "clearance between bodies: an error when they meet, a warning below "
                               "the tolerance",
                    .figure = {.key = "min_self_clearance_m",
                               .label = "least clearance of the links",
                               .unit = "mm",
                               .scale = 1e3,
                               .least = true,
                               .line = 20},
                    .place = body_pair_place,
                    .advice = clearance_advice,
                    .obstacle = clearance_obstacle}},
      .judge_motion = judge_clearances};
  return limit;
}

}  // namespace ayumi
