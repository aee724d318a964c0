// In flight no ground force acts, so the COG of the motion falls freely, ddcog = (0, 0, -g), and so
// does the commanded COG, whose acceleration is the fourth-order second difference
//   (16 (c_-1 + c_1) - (c_-2 + c_2) - 30 c_0) / (12 dt^2)   (central differences, Taylor).
// At the beginning and end of a flight, the speed may change, but the position may not: the step of
// the COG between the two samples there is the mean of the steps before and after it.
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

// Largest deviation of the COG's acceleration from free fall [m/s^2]. Chosen: 5 % of g, the same as
// the tolerance of f_z. No measured case changes between half and twice the value (constants.md).
constexpr double kFallTolerance = 0.5;

// Smallest leap of the COG at the beginning or end of a flight [m]. Source: docs/attribution.md
// ("Leaps"): a force of ten times the weight bends the path by 0.04 mm at 1 kHz, so 1 mm cannot
// come from a force.
constexpr double kLeap = 1e-3;

// The acceleration of the commanded COG, from five samples that must be in the same flight.
Vector3d commanded_acceleration(const CommandSeries& series, int k) {
  const auto cog = [&](int i) { return series.samples[i].cog; };
  return (16 * (cog(k - 1) + cog(k + 1)) - (cog(k - 2) + cog(k + 2)) - 30 * cog(k)) /
         (12 * series.dt * series.dt);
}

void judge_free_fall(JudgedMotion& motion, const JudgedSample& s) {
  if (!s.known || !s.flies()) return;
  const Vector3d gravity(0, 0, -kGravity);
  judge_difference(motion, FindingKind::ballistic, s.k, s.demand.ddcog - gravity);
  if (s.k >= 2 && s.k + 2 < motion.count())
    judge_difference(motion, FindingKind::ballistic, s.k,
                     commanded_acceleration(motion.series, s.k) - gravity, Severity::error,
                     kCommandFalls);
}

void judge_leaps(JudgedMotion& motion) {
  const double dt = motion.series.dt, limit = kLeap / (dt * dt);
  for (int k = 2; k + 1 < motion.count(); ++k) {
    if (motion.flies(k) == motion.flies(k - 1)) continue;
    const std::vector<Vector3d>& c = motion.cog;
    const Vector3d beside = 0.5 * (c[k + 1] - c[k] + c[k - 1] - c[k - 2]);
    const Vector3d leap = c[k] - c[k - 1] - beside;
    const double size = leap.norm() / (dt * dt);
    if (size > limit)
      motion.add(FindingKind::ballistic, kMotionLeaps, motion.flies(k) ? k : k - 1, size, limit,
                 size, largest_axis(leap));
  }
}

// The force and the moment that the given motion needs in flight, about its planned COG, divided by
// the weight.
Vector6d own_flight_wrench(const RowSite& site, int sample) {
  const CommandSample& s = site.series.samples[sample];
  SupportPlane plane;
  plane.frame.translation() = s.cog;
  RobotData data(site.model);
  const Vector6d wrench = inverse_dynamics(site.model, s.state, s.acceleration, data).head<6>();
  return plane_wrench(plane, s.state.base.position, wrench) / site.weight();
}

// The ground wrench in flight, divided by m g, is 0: the force because of free fall, the moment
// because of the angular momentum. Both are in one block, so they share the slack of a relaxed
// program.
const RowKind kFlightRows = {
    .name = "flight", .unit = &RowPrices::length, .relaxed = &RowPrices::foot, .order = {4, 0}};

// The band is a share of the deviation that the check allows, divided among three axes. If the
// motion's own value is small enough (own_share), the band reaches to this value. The deviation of
// one sample from the mean moment is rounding and is not changed.
void place_flight_rows(RowSite& site) {
  const auto& settings = site.settings.flight;
  const double weight = site.weight();
  const double most[] = {site.tolerance(FindingKind::ballistic) / kGravity,
                         site.tolerance(FindingKind::angular_momentum) / weight};
  const auto moment = [&](int k) { return Vector3d(own_flight_wrench(site, k).tail<3>()); };
  for (int i = 0; i < site.count(); ++i) {
    if (!site.points[i].flies() || !site.points[i].only.empty()) continue;
    const int k = site.points[i].sample;
    const Vector6d own = own_flight_wrench(site, k);
    Vector6d kept, offset = Vector6d::Zero(), band;
    kept << own.head<3>(), mean_flight_moment(site.series, k, moment);
    offset.tail<3>() = own.tail<3>() - kept.tail<3>();
    for (int part : {0, 1}) {
      const double used = kept.segment<3>(3 * part).norm() / most[part];
      kept.segment<3>(3 * part) *= used > settings.own_share ? 0.0 : 1.0;
      band.segment<3>(3 * part).setConstant(settings.band / std::sqrt(3.0) * most[part]);
    }
    site.add(kFlightRows, i, 0, linear_rows(Eigen::Matrix<double, 6, 6>::Identity() / weight),
             offset + (-band).cwiseMin(kept), offset + band.cwiseMax(kept));
  }
}

bool free_fall_holds(JudgedMotion& motion, const Violation& v, double pace) {
  return flight_is_free(motion, v.sample, pace, std::abs(v.limit));
}

Advice free_fall_advice(const JudgedMotion& motion, const FindingWindow& window) {
  const double dt = motion.series.dt;
  if (window.worst.item == kMotionLeaps)
    return {"the position of the COG jumps by " + in_mm(window.worst.value * dt * dt) +
                " where the flight begins or ends, and no force can move the COG so fast",
            "make the COG keys continuous there", ""};
  return {"the COG must fall freely during the whole flight",
          "remove the COG keys inside the flight", ""};
}

std::string free_fall_infeasibility(const Finding&, double) {
  return "the COG does not fall freely in flight";
}

}  // namespace

const Limit& free_fall_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::ballistic,
                    .limit_class = LimitClass::force,
                    .unit = "m/s^2",
                    .tolerance = kFallTolerance,
                    .meaning = "difference between the COG acceleration in flight and free fall",
                    .figure = {.key = "max_ballistic_residual_m_s2",
                               .label = "largest deviation from free fall",
                               .unit = "m/s^2",
                               .line = 18},
                    .repair = {.in_flight = true},
                    .place = axis_place,
                    .advice = free_fall_advice,
                    .infeasibility = free_fall_infeasibility,
                    .holds_at = free_fall_holds}},
      .judge_sample = judge_free_fall,
      .judge_motion = judge_leaps,
      .place_rows = place_flight_rows};
  return limit;
}

}  // namespace ayumi
