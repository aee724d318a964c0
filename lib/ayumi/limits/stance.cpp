// A supporting sole rests in its place: the pose P of its contact interval
// (demand/contact_plan.hpp). With the corners x_i of the sole in the frame of P and v_i where they
// belong,
//   slip = max |x_i - v_i| along the ground,
//   penetration = max(0, -min z_i),  float = max(0, max z_i).
// A swinging sole must not sink below the lower of the places that it leaves and comes to. A foot
// in the air floats and does not slip. But a foot that leaves its place and comes back to it within
// one contact counts as displaced, whatever its height is in between.
#include <algorithm>
#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/limits/sole_rows.hpp"

namespace ayumi {

namespace {

// Tolerance of slip [m]. Chosen: angles that are rounded to 0.1 degrees move the foot of a leg of
// 0.3 m by 0.5 mm for each joint, and this is not a slip. With half of the value, the missing
// safety after the repair of the case "slip" changes from 0 to 0.15; with twice, to 0.00881.
constexpr double kSlipTolerance = 0.002;
// Tolerance of penetration [m]. Chosen: half of the slip that is allowed, because the stiffness of
// the ground resists penetration. No measured case changes between half and twice the value
// (constants.md).
constexpr double kDepthTolerance = 0.001;
// Tolerance of floating [m]. Chosen: far above the rounding of planned contacts (1e-12 m in
// generated walks), and far below the height of a sole 60 ms before the end of a usual swing. With
// half of the value, the weighted change by the repair of the case "early" is 0.0652 instead of
// 0.0359; with twice, it is 0.00515.
constexpr double kFloatTolerance = 0.0003;

// The depth of a sole below the ground of a swing. This ground is the lower one of the two places
// where the foot stood and where it will stand.
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

void note_soles(JudgedMotion& motion, const JudgedSample& s, const RobotData& data) {
  for (Side side : {Side::left, Side::right}) {
    const ContactInterval& interval = motion.plan.at(side, s.k);
    const Eigen::Isometry3d sole = sole_pose(motion.model, data, side);
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

// Judges a foot whose contact has begun but which still comes down to its place, or which rises
// before its contact ends: then the swing lasts longer than the phases say. In a slow swing, the
// height of the sole is below the tolerance of foot_float, so the motion of the sole is tested and
// not its height.
void judge_contact_edge(JudgedMotion& motion, Side side, const ContactInterval& contact,
                        bool lands) {
  const int k = lands ? contact.first : contact.last;
  const double limit = kRunOnShare * motion.tolerance(FindingKind::foot_float);
  const RunOn run = swing_run_on(motion.model, motion.series, side, contact, lands);
  motion.raise(FindingKind::foot_float, run.height, k, static_cast<int>(side));
  if (run.height <= limit) return;
  motion.windows.add({FindingKind::foot_float, static_cast<int>(side), k, Severity::error,
                      run.height, limit, run.height, lands ? run.samples : -run.samples},
                     lands ? k : k - run.samples, lands ? k + run.samples : k);
}

// The samples before the first sample and after the last sample in which the sole is in its place
// belong to the swing.
void judge_supporting_foot(JudgedMotion& motion, Side side, const ContactInterval& contact) {
  const int foot = static_cast<int>(side);
  const double high = motion.tolerance(FindingKind::foot_float),
               far = motion.tolerance(FindingKind::foot_slip);
  int first = contact.first, last = contact.last;
  while (first <= last && !in_place(motion, foot, first)) ++first;
  while (last > first && !in_place(motion, foot, last)) --last;
  for (int k = contact.first; k <= contact.last; ++k) {
    const SoleError& e = motion.soles[foot][k];
    motion.raise(FindingKind::foot_float, e.gap, k, foot);
    if (k == contact.first && k > 0) judge_contact_edge(motion, side, contact, true);
    if (e.gap > high) motion.add(FindingKind::foot_float, foot, k, e.gap, high, e.gap);
    if (e.lowest > high && (k < first || k > last)) continue;
    motion.raise(FindingKind::foot_slip, e.slip, k, foot);
    if (e.slip > far) motion.add(FindingKind::foot_slip, foot, k, e.slip, far, e.slip);
  }
}

void judge_depth(JudgedMotion& motion, int foot) {
  const double deep = motion.tolerance(FindingKind::foot_penetration);
  for (int k = 0; k < motion.count(); ++k) {
    const double depth = motion.soles[foot][k].penetration;
    motion.raise(FindingKind::foot_penetration, depth, k, foot);
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

// The angle by which a sole may turn in its place. A long sole may turn less, because its corners
// rise and sink more.
double angle_band(const RowSite& site, Side side) {
  double reach = 0;
  for (const Eigen::Vector2d& v : site.model.sole(side).polygon)
    reach = std::max(reach, v.lpNorm<1>());
  const double off = std::min(site.tolerance(FindingKind::foot_float),
                              site.tolerance(FindingKind::foot_penetration));
  const auto& settings = site.settings.stance;
  return std::min(settings.angle, settings.corner_share * off / reach);
}

double position_band(const RowSite& site) {
  const double share = site.settings.stance.tolerance_share;
  return std::min({site.settings.sole_position, share * site.tolerance(FindingKind::foot_slip),
                   share * site.tolerance(FindingKind::foot_penetration),
                   share * site.tolerance(FindingKind::foot_float)});
}

// The time from a landing to a sample, or from a sample to a lift-off [s].
double time_to_edge(const RowSite& site, int sample, const ContactInterval& contact) {
  const int last = static_cast<int>(site.series.samples.size()) - 1;
  const double landed = contact.first == 0 ? kUnbounded : (sample - contact.first) * site.series.dt;
  const double left = contact.last == last ? kUnbounded : (contact.last - sample) * site.series.dt;
  return std::min(landed, left);
}

// A foot that lands or lifts off softly is not exactly in its place for a moment. The check allows
// this. The repair keeps the deviation of the motion, up to a share of what is allowed.
void soften_landing(const RowSite& site, int point, Side side, Vector6d& lower, Vector6d& upper) {
  const auto& settings = site.settings.stance;
  const CollocationPoint& at = site.points[point];
  const ContactInterval& contact = site.plan.at(side, at.sample);
  if (time_to_edge(site, at.sample, contact) >= settings.soft_time) return;
  const Eigen::Isometry3d& sole = at.path[static_cast<int>(side)];
  const SoleError error = sole_error(site.model.sole(side), sole, contact.sole);
  const double used = std::max({error.gap / site.tolerance(FindingKind::foot_float),
                                error.penetration / site.tolerance(FindingKind::foot_penetration),
                                error.slip / site.tolerance(FindingKind::foot_slip)});
  Vector6d own = std::min(1.0, settings.soft_share / std::max(used, 1e-9)) *
                 sole_deviation(sole, contact.sole);
  // A sole above its place has not landed yet, and this has to be corrected.
  const Eigen::Vector3d normal = contact.sole.linear().col(2);
  own.head<3>() -= std::max(0.0, normal.dot(own.head<3>())) * normal;
  upper[2] *= settings.soft_upwards;
  lower += own.cwiseMin(0);
  upper += own.cwiseMax(0);
}

const RowKind kStanceRows = {.name = "stance",
                             .unit = &RowPrices::length,
                             .relaxed = &RowPrices::foot,
                             .beyond_check = true,
                             .order = {2, 0}};

const RowKind kEdgeRows = {.name = "contact_edge",
                           .unit = &RowPrices::length,
                           .relaxed = &RowPrices::foot,
                           .order = {2, 6}};

// Where a contact begins or ends beside a swing, the middle of the sole is not higher than a swing
// may continue. The pose of the sole alone does not ensure this, because a sole may also turn.
void place_edge_row(RowSite& site, int point, Side side) {
  const CollocationPoint& at = site.points[point];
  const ContactInterval& contact = site.plan.at(side, at.sample);
  const int last = static_cast<int>(site.series.samples.size()) - 1;
  const bool lands = at.sample == contact.first && contact.first > 0;
  const bool lifts = at.sample == contact.last && contact.last < last;
  if (!lands && !lifts) return;
  const double most = kRunOnShare * site.tolerance(FindingKind::foot_float);
  site.add(kEdgeRows, point, static_cast<int>(side),
           height_rows(side, {site.model.sole(side).center}, at.ground[static_cast<int>(side)]), 1,
           -kUnbounded, site.settings.stance.edge_share * most);
}

// The pose of a supporting sole stays in a band about its place that is much narrower than the
// check's tolerances. Rows of slip, depth and height would have kinks at the corners.
void place_stance_rows(RowSite& site) {
  const double position = position_band(site);
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    const double turn = angle_band(site, side);
    for (int i = 0; i < site.count(); ++i) {
      const CollocationPoint& at = site.points[i];
      if (!at.contact[foot]) continue;
      const double share = at.at_knot ? site.settings.stance.share_at_knots : 1;
      const double band = share * position, angle = share * turn;
      Vector6d upper;
      upper << band, band, band, angle, angle, angle;
      Vector6d lower = -upper;
      soften_landing(site, i, side, lower, upper);
      site.add(kStanceRows, i, foot, deviation_rows(side, at.ground[foot]), lower, upper);
      place_edge_row(site, i, side);
    }
  }
}

Advice slip_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"the " + std::string(name_of(foot_of(window.worst))) + " sole moves " +
              in_mm(window.worst.value) + " while it supports the robot",
          "keep the foot still", kOrRepair};
}

Advice penetration_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"raise the " + std::string(name_of(foot_of(window.worst))) + " sole by " +
              in_mm(window.worst.value),
          kOrRepair};
}

// The detail of a contact edge is the number of samples by which the swing continues.
Advice float_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string foot = name_of(foot_of(v));
  const std::string time = text::fixed(std::abs(v.detail) * motion.series.dt, 3) + " s";
  const std::string height = text::fixed(1000 * v.value, 2) + " mm";
  if (v.detail > 0)
    return {
        "the " + foot + " sole is still " + height + " above the ground when its contact begins",
        "begin the contact " + time + " later", ""};
  if (v.detail < 0)
    return {
        "the " + foot + " sole is already " + height + " above the ground when its contact ends",
        "end the contact " + time + " earlier", ""};
  return {"the " + foot + " sole is " + in_mm(v.value) +
              " above the ground while it should support the robot",
          "begin the contact later, end the "
          "contact earlier, or lower the foot",
          ""};
}

std::string slip_infeasibility(const Finding& f, double) {
  return "the " + f.where + " foot slips " + in_mm(f.worst);
}

std::string penetration_infeasibility(const Finding& f, double) {
  return "the " + f.where + " foot is " + in_mm(f.worst) + " below the ground";
}

std::string float_infeasibility(const Finding& f, double) {
  return "the " + f.where + " foot should stand, but is " + in_mm(f.worst) + " above the ground";
}

}  // namespace

const Limit& stance_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::foot_slip,
                    .unit = "m",
                    .tolerance = kSlipTolerance,
                    .meaning = "horizontal distance of a supporting sole from its planned place",
                    .figure = {.key = "max_foot_slip_m",
                               .label = "largest slip of a supporting sole",
                               .unit = "mm",
                               .scale = 1e3,
                               .line = 13},
                    .repair = {.is_brief = true},
                    .place = foot_place,
                    .advice = slip_advice,
                    .infeasibility = slip_infeasibility},
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
                    .infeasibility = penetration_infeasibility},
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
                    .infeasibility = float_infeasibility}},
      .note_sample = note_soles,
      .judge_motion = judge_stance,
      .place_rows = place_stance_rows};
  return limit;
}

}  // namespace ayumi
