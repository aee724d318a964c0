// The ground pushes and cannot pull: f_n >= 0 wherever a foot is planned to stand, where f_n is the
// demanded ground force along the normal of the support plane. To make the COG fall faster than
// gravity (ddz < -g), f_n < 0 would be necessary: the feet would leave the ground, which is only
// allowed in a planned flight.
#include <algorithm>

#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Normal force below which contact is a warning, as a share of the weight. Chosen: if less than a
// twentieth of the weight rests on the ground, friction and ZMP have little meaning. It is only a
// warning. No measured case changes between half and twice the value (constants.md).
constexpr double kLeastNormalShare = 0.05;

void judge_normal_force(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.stands()) return;
  const double least = motion.tolerance(FindingKind::unilateral) * motion.weight;
  const double force = s.demand.use.normal_force;
  if (force >= least) return;
  const bool pulls = force < 0;
  motion.add(FindingKind::unilateral, 0, s.k, force, pulls ? 0 : least, -force,
             static_cast<int>(s.command.support), pulls ? Severity::error : Severity::warning);
}

// f_n / (m g) is at least a share of the weight that is larger than that of the check, so that the
// ZMP keeps its meaning between two samples.
const RowKind kNormalForceRows = {.name = "normal_force", .beyond_check = true, .order = {4, 3}};

void place_normal_force_rows(RowSite& site) {
  Eigen::Matrix<double, 1, 6> row = Eigen::Matrix<double, 1, 6>::Zero();
  row[2] = 1;
  for (int i = 0; i < site.count(); ++i) {
    if (!site.points[i].stands()) continue;
    double least = site.weight();
    for (const GroundDemand& demand : site.watched_demand(i))
      least = std::min(least, demand.normal_force);
    if (least >= site.settings.normal_force.light * site.weight()) continue;
    site.add(kNormalForceRows, i, 0, linear_rows(row / site.weight()), 1,
             site.settings.normal_force.least, kUnbounded);
  }
}

bool normal_force_holds(JudgedMotion& motion, const Violation& v, double pace) {
  return motion.dynamics.at(v.sample, pace).use.normal_force >= 0;
}

const char* normal_force_unit(const JudgedMotion&, const Violation&) { return "N"; }

Advice normal_force_advice(const JudgedMotion&, const FindingWindow&) {
  return {"the ground would have to pull the robot down, but the ground can only push",
          "let the COG accelerate downwards by less than g, or plan a flight phase", ""};
}

std::string normal_force_infeasibility(const Finding& f, double) {
  return "the ground would have to pull the robot down (" + place_words(f.where) + ")";
}

}  // namespace

const Limit& normal_force_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::unilateral,
                    .limit_class = LimitClass::force,
                    .unit = "m g",
                    .tolerance = kLeastNormalShare,
                    .meaning = "normal ground force in contact. A pull of the ground is an error; "
                               "a force below the tolerance is a warning. The tolerance is a share "
                               "of the weight",
                    .finding_unit = normal_force_unit,
                    .place = support_place,
                    .advice = normal_force_advice,
                    .infeasibility = normal_force_infeasibility,
                    .holds_at = normal_force_holds}},
      .judge_sample = judge_normal_force,
      .place_rows = place_normal_force_rows};
  return limit;
}

}  // namespace ayumi
