// This limit is torsional friction. About the normal through the ZMP, soles with an even pressure
// resist a moment of
//   |n_z| <= mu f_n r,
// where r is torsional_friction_arm(): the mean distance from the ZMP over the largest part of the
// support that is symmetric about it, a lower bound of what is possible (demand/ground_demand.hpp).
#include <algorithm>

#include "ayumi/limits/friction.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Largest share of the moment that friction resists. Definition: at 1 the foot turns.
constexpr double kWholeMoment = 1;

/// The share of the torsional friction that a motion uses, for the arm r [m].
double torsion_ratio(const GroundDemand& demand, double coefficient, double arm) {
  return std::abs(demand.yaw_moment) / (coefficient * demand.normal_force * arm);
}

// A lower bound of the arm [m]. The part of the support over which the arm is a mean contains the
// disc around the ZMP whose radius is the margin. The mean distance of a disc is 2/3 of its radius,
// and the points outside the disc are farther away.
double least_arm(const GroundDemand& demand) { return 2.0 / 3 * demand.margin; }

// If the foot slides, nothing resists a turn, and a ZMP outside the support has no arm. Both have
// findings of their own. The computation of the arm took a sixth of the time of a check. It is left
// out if a lower bound of the arm already shows that the sample is neither an error nor the worst
// so far.
void judge_torsion(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.has_zmp()) return;
  const GroundDemand& use = s.demand.use;
  if (friction_ratio(use, motion.friction) >= 1 ||
      use.margin <= motion.tolerance(FindingKind::support_margin))
    return;
  const double most = motion.tolerance(FindingKind::yaw_moment);
  if (use.margin > 0 && torsion_ratio(use, motion.friction, least_arm(use)) <
                            std::min(most, motion.summary[FindingKind::yaw_moment]))
    return;
  const double yaw =
      torsion_ratio(use, motion.friction, torsional_friction_arm(s.plane.polygon, use.zmp));
  motion.raise(FindingKind::yaw_moment, yaw, s.k, 0, static_cast<int>(s.command.support));
  if (yaw > most)
    motion.add(FindingKind::yaw_moment, 0, s.k, yaw, most, yaw,
               static_cast<int>(s.command.support));
}

// (arm f_n -+ n_z) / (m g) >= 0, where n_z = w_5 + (w_3 f_x + w_4 f_y) / f_n is the yaw moment
// about the ZMP and the arm is mu r, kept as it is in the latest iterate.
struct TurnRows {
  double arm = 0;    // mu r [m]
  double scale = 0;  // 1 / (m g)

  VectorXd value(const Vector6d& w) const {
    const double most = arm * w[2], moment = w[5] + (w[3] * w[0] + w[4] * w[1]) / w[2];
    return scale * Eigen::Vector2d(most - moment, most + moment);
  }

  MatrixXd gradient(const Vector6d& w) const {
    Eigen::Matrix<double, 1, 6> yaw;
    yaw << w[3], w[4], -(w[3] * w[0] + w[4] * w[1]) / w[2], w[0], w[1], w[2];
    yaw /= w[2];
    MatrixXd rows(2, 6);
    rows << -yaw, yaw;
    rows.col(2).array() += arm;
    return scale * rows;
  }
};

WrenchRows rows_of(const TurnRows& turn) {
  return {.value = [turn](const Vector6d& w) { return turn.value(w); },
          .gradient = [turn](const Vector6d& w) { return turn.gradient(w); }};
}

const RowKind kTurnRows = {
    .name = "torsional_friction", .unit = &RowPrices::length, .order = {4, 5}};

void place_torsion_rows(RowSite& site) {
  const double most = site.tolerance(FindingKind::yaw_moment);
  for (int i = 0; i < site.count(); ++i) {
    if (!site.points[i].stands()) continue;
    double used = 0, arm = 0;
    for (const GroundDemand& demand : site.watched_demand(i)) {
      if (!demand.has_zmp) continue;
      const double here = torsional_friction_arm(site.points[i].plane.polygon, demand.zmp);
      if (here <= 0) continue;
      used = std::max(used, torsion_ratio(demand, site.friction, here));
      arm = site.friction * here;
    }
    if (arm <= 0 || used <= site.settings.watched_share * most) continue;
    const TurnRows turn = {site.settings.limit_share * most * arm, 1 / site.weight()};
    site.add(kTurnRows, i, 0, rows_of(turn), 2, 0, kUnbounded);
  }
}

bool torsion_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const GroundDemand& use = motion.dynamics.at(v.sample, pace).use;
  return std::abs(use.yaw_moment) <=
         std::abs(v.limit) * motion.friction * use.normal_force *
             torsional_friction_arm(motion.dynamics.plane().polygon, use.zmp);
}

Advice torsion_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"the foot would turn on the ground",
          slow_down_text(std::sqrt(window.worst.value / window.worst.limit)) +
              ", or swing the arms against the legs",
          ""};
}

std::string torsion_infeasibility(const Finding& f, double violation) {
  return "the foot would turn: the motion needs " + ratio_text(violation) +
         " times the yaw moment that friction can resist (" + place_words(f.where) + ")";
}

}  // namespace

const Limit& torsion_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::yaw_moment,
                    .limit_class = LimitClass::force,
                    .unit = "1",
                    .tolerance = kWholeMoment,
                    .meaning = "moment about the normal of the ground at the ZMP, divided "
                               "by the largest moment that friction can resist. This largest "
                               "moment is computed for an even pressure under the soles",
                    .figure = {.key = "max_yaw_ratio",
                               .label = "largest yaw moment",
                               .unit = "% of the moment that friction resists",
                               .scale = 100,
                               .share_name = "yaw moment",
                               .line = 12},
                    .place = support_place,
                    .advice = torsion_advice,
                    .infeasibility = torsion_infeasibility,
                    .holds_at = torsion_holds}},
      .judge_sample = judge_torsion,
      .place_rows = place_torsion_rows};
  return limit;
}

}  // namespace ayumi
