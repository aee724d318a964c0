// The ground only pushes, so its resultant passes through the convex hull of the supporting soles:
// with f_n > 0 and the inward unit normal a of each edge (a . x >= b inside),
//   margin = min over the edges of (a . ZMP - b) >= 0.
// The margin is positive inside. Outside, no contact forces can produce the motion, and the robot
// tips over.
#include <algorithm>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

namespace {

// Margin below which a ZMP inside the support gets a warning, and smallest margin of a repaired
// motion [m]. Chosen: a few hundredths of the width of small soles (5 cm). Half or twice the value
// changes no verdict of a check. With half of the value, the largest yaw ratio of the case "fast"
// changes from 0.375 to 0.423; with twice, the check of this case finds 3 warnings of
// support_margin instead of 4.
constexpr double kLeastMargin = 0.002;

void judge_margin(JudgedMotion& motion, const JudgedSample& s, ZmpOf whose, double margin) {
  const double wanted = motion.tolerance(FindingKind::support_margin);
  if (margin >= wanted - kRounding) return;
  const bool outside = margin < -kRounding;
  motion.add(FindingKind::support_margin, whose, s.k, margin, outside ? 0 : wanted, -margin,
             static_cast<int>(s.command.support), outside ? Severity::error : Severity::warning);
}

void judge_support(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.has_zmp()) return;
  const GroundDemand& use = s.demand.use;
  motion.lower(FindingKind::support_margin, use.margin, s.k, kMotionZmp,
               static_cast<int>(s.command.support));
  judge_margin(motion, s, kMotionZmp, use.margin);
  const Eigen::Vector3d command = s.plane.frame.inverse() * s.command.zmp;
  const double command_margin = s.plane.polygon.margin(command.head<2>());
  // The commanded ZMP is only judged if it differs from the ZMP of the motion.
  if ((use.zmp_world - s.command.zmp).norm() > motion.tolerance(FindingKind::zmp_residual) &&
      command_margin < -kRounding)
    judge_margin(motion, s, kCommandZmp, command_margin);
}

// The margin of the given motion. It is unbounded where the ZMP has no meaning, and 0 where the
// ground would have to pull.
std::vector<double> own_margins(const RowSite& site) {
  RobotData data(site.model);
  std::vector<double> own;
  for (int i = 0; i < site.count(); ++i) {
    const CollocationPoint& at = site.points[i];
    if (!at.stands()) {
      own.push_back(kUnbounded);
      continue;
    }
    const CommandSample& sample = site.given(i);
    const Vector6d wrench =
        inverse_dynamics(site.model, sample.state, sample.acceleration, data).head<6>();
    const GroundDemand demand =
        ground_demand(at.plane, plane_wrench(at.plane, sample.state.base.position, wrench),
                      contact_threshold(site.model));
    own.push_back(demand.has_zmp ? demand.margin : 0);
  }
  return own;
}

// The margin that is wanted at every point. Where the ZMP of the motion is outside or too near an
// edge, and for a while around this time, a repair aims at the safe margin. Elsewhere it aims at a
// share of the margin that the motion itself has, but at most at the safe margin. A step that
// begins with a small margin does not become safe by a large margin at its end.
std::vector<double> wanted_margins(const RowSite& site) {
  const auto& settings = site.settings.support;
  const double safe = std::max(settings.safe, settings.least);
  const std::vector<double> own = own_margins(site);
  std::vector<double> wanted;
  for (size_t i = 0; i < own.size(); ++i) {
    double least = own[i];
    for (size_t j = 0; j < own.size(); ++j)
      if (std::abs(site.points[i].sample - site.points[j].sample) * site.series.dt <=
          settings.safe_around)
        least = std::min(least, own[j]);
    wanted.push_back(least < settings.least
                         ? std::max(settings.mended, settings.least)
                         : std::clamp(settings.own_share * own[i], settings.least, safe));
  }
  return wanted;
}

// f_n (distance of the ZMP inside each edge - wanted margin) / (m g) >= 0, linear in the wrench.
// The wanted margin is a soft goal, which may only be violated down to the smallest margin.
const RowKind kMarginRows = {.name = "support",
                             .unit = &RowPrices::length,
                             .soft_goal = &RowPrices::zmp_margin,
                             .beyond_check = true,
                             .order = {4, 2}};

void place_support_rows(RowSite& site) {
  const std::vector<double> wanted = wanted_margins(site);
  for (int i = 0; i < site.count(); ++i) {
    if (!site.points[i].stands()) continue;
    Eigen::MatrixXd rows = support_rows(site.points[i].plane);
    rows.col(2).array() -= wanted[i];
    site.add(kMarginRows, i, 0, linear_rows(rows / site.weight()), static_cast<int>(rows.rows()), 0,
             kUnbounded)
        .most_violation = wanted[i] - site.settings.support.least;
  }
}

bool support_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const SampleDynamics& now = motion.dynamics.at(v.sample, pace);
  return now.use.has_zmp && now.use.margin >= -kRounding;
}

Advice support_advice(const JudgedMotion&, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string whose = v.item == kMotionZmp ? "the ZMP of the motion" : "the commanded ZMP";
  if (v.value < 0)
    return {whose + " is " + in_mm(v.value) + " outside the support",
            // If a slower motion does not help, the remedy must not name more time.
            "reduce the displacement of the COG by " + in_mm(v.value),
            std::string(", or give the step more time") + kOrRepair};
  return {whose + " is only " + in_mm(v.value) + " inside the support, but the wanted margin is " +
              in_mm(v.limit),
          "reduce the displacement of the COG by " + in_mm(v.limit - v.value), kOrRepair};
}

std::string support_infeasibility(const Finding& f, double violation) {
  return "the ZMP is " + in_mm(violation) + " outside the support (" + place_words(f.where) + ")";
}

}  // namespace

const Limit& support_limit() {
  static const Limit limit = {
      .findings =
          {{.kind = FindingKind::support_margin,
            .limit_class = LimitClass::force,
            .unit = "m",
            .tolerance = kLeastMargin,
            .meaning =
                "distance from the ZMP to the edge of the support polygon. A ZMP outside the "
                "polygon is an error; a distance inside that is below the tolerance is a warning",
            .figure = {.key = "min_zmp_margin_m",
                       .label = "least ZMP margin",
                       .unit = "mm",
                       .scale = 1e3,
                       .least = true,
                       .line = 1},
            .repair = {.is_of_plan = true, .warnings_too = true},
            .place = support_place,
            .advice = support_advice,
            .infeasibility = support_infeasibility,
            .holds_at = support_holds}},
      .judge_sample = judge_support,
      .place_rows = place_support_rows};
  return limit;
}

}  // namespace ayumi
