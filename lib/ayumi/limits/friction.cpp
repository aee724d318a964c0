// Coulomb: a sole does not slide while the force along the ground stays inside the round cone,
//   f_t = |(f_x, f_y)| <= mu f_n,
// with (f_x, f_y, f_n) the demanded ground force in the axes of the support plane. The share of the
// cone that the motion uses is f_t / (mu f_n); mu times this share is the friction coefficient that
// it needs.
#include "ayumi/limits/friction.hpp"

#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// Largest share of the cone. Definition: at 1 the sole slides.
constexpr double kWholeCone = 1;

void judge_friction(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.has_zmp()) return;
  const double ratio = friction_ratio(s.demand.use, motion.friction);
  motion.raise(FindingKind::friction, ratio, s.k, 0, static_cast<int>(s.command.support));
  const double most = motion.tolerance(FindingKind::friction);
  if (ratio > most)
    motion.add(FindingKind::friction, 0, s.k, ratio, most, ratio,
               static_cast<int>(s.command.support));
}

// (mu f_n - f_t) / (m g) >= 0. The tangential force is rounded at 0, where its slope has no value:
//   f_t = sqrt(f_x^2 + f_y^2 + rounding^2).
struct ConeRow {
  double mu = 0;
  double scale = 0;     // 1 / (m g)
  double rounding = 0;  // tangential force as a share of the weight at which the tip is rounded

  double tangential(const Vector6d& w) const {
    return std::sqrt(w.head<2>().squaredNorm() + elementary::power<2>(rounding / scale));
  }

  VectorXd value(const Vector6d& w) const {
    return VectorXd::Constant(1, scale * (mu * w[2] - tangential(w)));
  }

  MatrixXd gradient(const Vector6d& w) const {
    MatrixXd row = MatrixXd::Zero(1, 6);
    row.leftCols<2>() = -w.head<2>().transpose() / tangential(w);
    row(0, 2) = mu;
    return scale * row;
  }

  Eigen::Matrix2d curvature(const Vector6d& w, double multiplier) const {
    const Eigen::Vector2d pull = w.head<2>();
    const double size = tangential(w);
    return -multiplier * scale / size *
           (Eigen::Matrix2d::Identity() - pull * pull.transpose() / (size * size));
  }
};

WrenchRows rows_of(const ConeRow& cone) {
  return {.value = [cone](const Vector6d& w) { return cone.value(w); },
          .gradient = [cone](const Vector6d& w) { return cone.gradient(w); },
          .curvature = [cone](const Vector6d& w,
                              double multiplier) { return cone.curvature(w, multiplier); }};
}

const RowKind kConeRows = {.name = "friction", .order = {4, 4}};

void place_friction_rows(RowSite& site) {
  const RowSettings& settings = site.settings;
  const double most = site.tolerance(FindingKind::friction);
  const double mu = settings.limit_share * most * site.friction * settings.friction.cone_share;
  for (int i = 0; i < site.count(); ++i) {
    if (!site.points[i].stands()) continue;
    double used = 0;
    for (const GroundDemand& demand : site.watched_demand(i))
      if (demand.has_zmp) used = std::max(used, friction_ratio(demand, site.friction));
    if (used <= settings.watched_share * most) continue;
    const ConeRow cone = {mu, 1 / site.weight(), settings.friction.rounding};
    site.add(kConeRows, i, 0, rows_of(cone), 1, 0, kUnbounded).active =
        settings.friction.active * mu;
  }
}

bool friction_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const GroundDemand& use = motion.dynamics.at(v.sample, pace).use;
  return use.tangential_force <= std::abs(v.limit) * motion.friction * use.normal_force;
}

Advice friction_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {"the motion needs a friction coefficient of " +
              text::fixed(v.value * motion.friction, 2) + ", but " +
              (v.value > 1 ? "the ground has " + text::fixed(motion.friction, 2)
                           : "the tolerance allows " + text::fixed(v.limit * motion.friction, 2)),
          slow_down_text(std::sqrt(v.value / v.limit)) + ", or take shorter steps", ""};
}

std::string friction_infeasibility(const Finding& f, double violation) {
  return "the motion needs " + ratio_text(violation) + " times the available friction (" +
         place_words(f.where) + ")";
}

}  // namespace

const Limit& friction_limit() {
  static const Limit limit = {
      .findings =
          {{.kind = FindingKind::friction,
            .limit_class = LimitClass::force,
            .unit = "1",
            .tolerance = kWholeCone,
            .meaning =
                "tangential ground force divided by (friction coefficient times normal force)",
            .figure = {.key = "max_friction_ratio",
                       .label = "largest friction use",
                       .unit = "% of the cone",
                       .scale = 100,
                       .share_name = "friction",
                       .line = 11},
            .place = support_place,
            .advice = friction_advice,
            .infeasibility = friction_infeasibility,
            .holds_at = friction_holds}},
      .judge_sample = judge_friction,
      .place_rows = place_friction_rows};
  return limit;
}

}  // namespace ayumi
