// A supporting sole rests in its place: the pose P of its contact interval
// (demand/contact_plan.hpp). With the corners x_i of the sole in the frame of P and v_i where they
// belong,
//   slip = max |x_i - v_i| along the ground,  penetration = max(0, -min z_i),  float = max(0, max
//   z_i).
// A swinging sole must not sink below the lower of the places that it leaves and comes to. A foot
// in the air does not slip, it floats; but one that leaves its place and comes back to it within
// one contact is displaced, whatever its height meanwhile.
#include <algorithm>
#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// [m] Chosen: angles that are rounded to 0.1 degrees move the foot of a leg of 0.3 m by 0.5 mm for
// each joint, and that is no slip. Half: slip, missing safety 0 to 0.15; twice: 0.00881.
constexpr double kSlipTolerance = 0.002;
// [m] Chosen: half of the slip that is allowed, since the ground resists depth with its stiffness.
// No measured case changes from half to twice (constants.md).
constexpr double kDepthTolerance = 0.001;
// [m] Chosen: far above the rounding of planned contacts (1e-12 m in generated walks), far below
// what a sole hangs 60 ms before the end of a swing of usual height. Half: early, change 0.0359 to
// 0.0652; twice: 0.00515.
constexpr double kFloatTolerance = 0.0003;

// The ground below a swinging foot: the lower of where it stood and where it will stand.
double swing_depth(const JudgedMotion& motion, Side side, int k, const Eigen::Isometry3d& sole) {
  const int s = static_cast<int>(side);
  const int i = motion.plan.index[s][k];
  double depth = std::numeric_limits<double>::infinity();
  for (int j : {i - 1, i + 1}) {
    if (j < 0 || j >= static_cast<int>(motion.plan.intervals[s].size())) continue;
    const SoleError e = sole_error(motion.model.sole(side), sole, motion.plan.intervals[s][j].sole);
    depth = std::min(depth, e.penetration);
  }
  return std::isfinite(depth) ? depth : 0;
}

void note_soles(JudgedMotion& motion, const JudgedSample& s) {
  for (Side side : {Side::left, Side::right}) {
    const ContactInterval& interval = motion.plan.at(side, s.k);
    const Eigen::Isometry3d sole = sole_pose(motion.model, motion.dynamics.data(), side);
    SoleError& error = motion.soles[static_cast<int>(side)][s.k];
    if (interval.contact)
      error = sole_error(motion.model.sole(side), sole, interval.sole);
    else
      error.penetration = swing_depth(motion, side, s.k, sole);
  }
}

bool in_place(const JudgedMotion& motion, int foot, int k) {
  const SoleError& e = motion.soles[foot][k];
  return e.gap <= motion.tolerance(FindingKind::foot_float) &&
         e.slip <= motion.tolerance(FindingKind::foot_slip);
}

// A foot whose contact has begun but which still comes down to its place, or rises from it before
// its contact ends: the swing is longer than the phases say. A slow swing hangs less than a sole
// may float by, so that its motion shows it, not its height.
void judge_contact_edge(JudgedMotion& motion, Side side, const ContactInterval& contact,
                        bool lands) {
  const int k = lands ? contact.first : contact.last;
  const double limit = kRunOnShare * motion.tolerance(FindingKind::foot_float);
  const RunOn run = swing_run_on(motion.model, motion.series, side, contact, lands);
  motion.raise(FindingKind::foot_float, run.height);
  if (run.height <= limit) return;
  motion.windows.add({FindingKind::foot_float, static_cast<int>(side), k, Severity::error,
                      run.height, limit, run.height, lands ? run.samples : -run.samples},
                     lands ? k : k - run.samples, lands ? k + run.samples : k);
}

// Samples before the first and after the last one in place belong to a swing that runs on.
void judge_supporting_foot(JudgedMotion& motion, Side side, const ContactInterval& contact) {
  const int foot = static_cast<int>(side);
  const double high = motion.tolerance(FindingKind::foot_float),
               far = motion.tolerance(FindingKind::foot_slip);
  int first = contact.first, last = contact.last;
  while (first <= last && !in_place(motion, foot, first)) ++first;
  while (last > first && !in_place(motion, foot, last)) --last;
  for (int k = contact.first; k <= contact.last; ++k) {
    const SoleError& e = motion.soles[foot][k];
    motion.raise(FindingKind::foot_float, e.gap);
    if (k == contact.first && k > 0) judge_contact_edge(motion, side, contact, true);
    if (e.gap > high) motion.add(FindingKind::foot_float, foot, k, e.gap, high, e.gap);
    if (e.lowest > high && (k < first || k > last)) continue;
    motion.raise(FindingKind::foot_slip, e.slip);
    if (e.slip > far) motion.add(FindingKind::foot_slip, foot, k, e.slip, far, e.slip);
  }
}

void judge_depth(JudgedMotion& motion, int foot) {
  const double deep = motion.tolerance(FindingKind::foot_penetration);
  for (int k = 0; k < motion.count(); ++k) {
    const double depth = motion.soles[foot][k].penetration;
    motion.raise(FindingKind::foot_penetration, depth);
    if (depth > deep) motion.add(FindingKind::foot_penetration, foot, k, depth, deep, depth);
  }
}

void judge_stance(JudgedMotion& motion) {
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    judge_depth(motion, foot);
    const std::vector<ContactInterval>& intervals = motion.plan.intervals[foot];
    for (const ContactInterval& contact : intervals) {
      if (!contact.contact) continue;
      judge_supporting_foot(motion, side, contact);
      if (&contact != &intervals.back()) judge_contact_edge(motion, side, contact, false);
    }
  }
}

Advice slip_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"the " + std::string(name_of(foot_of(window.worst))) + " sole moves " +
              in_mm(window.worst.value) + " while it supports: keep the foot still",
          kOrRepair};
}

Advice penetration_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"raise the " + std::string(name_of(foot_of(window.worst))) + " sole by " +
              in_mm(window.worst.value),
          kOrRepair};
}

// The detail of a contact edge is the number of samples by which the swing runs on.
Advice float_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string foot = name_of(foot_of(v));
  const std::string time = text::fixed(std::abs(v.detail) * motion.series.dt, 3) + " s";
  const std::string height = text::fixed(1000 * v.value, 2) + " mm";
  if (v.detail > 0)
    return "the " + foot + " sole is still coming down, " + height +
           " to go, when its contact begins: begin it " + time + " later";
  if (v.detail < 0)
    return "the " + foot + " sole has risen by " + height + " when its contact ends: end it " +
           time + " earlier";
  return "the " + foot + " sole is " + in_mm(v.value) +
         " above the ground while it should support: begin its contact later or end it earlier, or "
         "lower the foot";
}

std::string slip_obstacle(const Finding& f, double) {
  return "the " + f.where + " foot slips " + in_mm(f.worst);
}

std::string penetration_obstacle(const Finding& f, double) {
  return "the " + f.where + " foot is " + in_mm(f.worst) + " in the ground";
}

std::string float_obstacle(const Finding& f, double) {
  return "the " + f.where + " foot stands " + in_mm(f.worst) + " in the air";
}

}  // namespace

const Limit& stance_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::foot_slip,
                    .unit = "m",
                    .tolerance = kSlipTolerance,
                    .meaning = "horizontal distance of a supporting sole from its place",
                    .figure = {.key = "max_foot_slip_m",
                               .label = "largest slip of a supporting sole",
                               .unit = "mm",
                               .scale = 1e3,
                               .line = 13},
                    .place = foot_place,
                    .advice = slip_advice,
                    .obstacle = slip_obstacle},
                   {.kind = FindingKind::foot_penetration,
                    .unit = "m",
                    .tolerance = kDepthTolerance,
                    .meaning = "depth of a sole below the ground",
                    .figure = {.key = "max_foot_penetration_m",
                               .label = "largest depth of a sole in the ground",
                               .unit = "mm",
                               .scale = 1e3,
                               .line = 14},
                    .place = foot_place,
                    .advice = penetration_advice,
                    .obstacle = penetration_obstacle},
                   {.kind = FindingKind::foot_float,
                    .unit = "m",
                    .tolerance = kFloatTolerance,
                    .meaning = "height of a supporting sole's highest corner above the ground",
                    .figure = {.key = "max_foot_float_m",
                               .label = "largest height of a supporting sole",
                               .unit = "mm",
                               .scale = 1e3,
                               .line = 15},
                    .place = foot_place,
                    .advice = float_advice,
                    .obstacle = float_obstacle}},
      .judge_sample = note_soles,
      .judge_motion = judge_stance};
  return limit;
}

}  // namespace ayumi
