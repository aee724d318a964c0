// A pattern commands COG, ZMP and f_z in addition to the posture; they have to be those of the
// motion:
//   |COG of the posture - commanded COG|,  |ZMP of the full model - commanded ZMP|,
//   |f_z - commanded|.
// The point mass gap is the distance between the ZMP of the mass-concentrated model, equations (14)
// and (15) of the paper, and the commanded ZMP. It shows how good that model is here, and is never
// an error. In flight no ground force acts, whatever the motion is, so the commanded force must be
// zero.
#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/limits/command_rows.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

// Tolerance of the COG [m]. Chosen: a hundredth of the COG's height of small humanoids (0.2 to 0.3
// m). No measured case changes between half and twice the value (constants.md).
constexpr double kCogTolerance = 0.002;
// Tolerance of the ZMP [m]. Chosen: a tenth of the width of small soles (5 cm), so that a ZMP
// planned with a safe margin stays inside the support. No measured case changes between half and
// twice the value (constants.md).
constexpr double kZmpTolerance = 0.005;
// Tolerance of f_z as a share of the weight. Chosen: the vertical acceleration of the COG is met to
// 5 % of g. No measured case changes between half and twice the value (constants.md).
constexpr double kForceTolerance = 0.05;
// Gap above which there is a note [m]. Chosen: it is only for information, and no verdict depends
// on it. With half of the value, the check of the case "knee" finds 3 notes of point_mass_gap
// instead of 2; with twice, it finds none.
constexpr double kPointMassTolerance = 0.02;

// Share of the weight below which a ZMP error may be larger, in inverse proportion to the force,
// because its moment counts. Source: docs/attribution.md: legs that swing at 1000 rad/s^2 leave 0.1
// N m of rounding in single samples.
constexpr double kLightShare = 0.25;
constexpr double kLeastForceShare = 1e-3;  // share of the weight that prevents a division by zero

// A ZMP error that lasts less than 5 ms and is at most three times its limit is a warning. Source:
// docs/attribution.md: where the acceleration has a kink, as near flights, single samples of the
// ZMP are outliers, and a moment of this size turns nothing in this time. The judge applies this to
// whole windows.

void judge_vertical_force(JudgedMotion& motion, const JudgedSample& s) {
  const double residual = (s.flies() ? 0 : s.demand.wrench[2]) - s.command.fz;
  motion.raise(FindingKind::fz_residual, std::abs(residual), s.k);
  const double limit = motion.tolerance(FindingKind::fz_residual) * motion.weight;
  if (std::abs(residual) > limit)
    motion.add(FindingKind::fz_residual, 0, s.k, residual, limit, std::abs(residual));
}

void judge_zmp(JudgedMotion& motion, const JudgedSample& s) {
  const CommandSample& command = s.command;
  const double light =
      kLightShare * motion.weight / std::max(command.fz, kLeastForceShare * motion.weight);
  judge_difference(motion, FindingKind::zmp_residual, s.k, s.demand.use.zmp_world - command.zmp,
                   Severity::error, 0, std::max(1.0, light));
  const Vector3d point_mass = pendulum_zmp(motion.cog[s.k], s.demand.ddcog, command.zmp.z());
  judge_difference(motion, FindingKind::point_mass_gap, s.k, point_mass - command.zmp,
                   Severity::info);
}

void judge_command(JudgedMotion& motion, const JudgedSample& s) {
  const Vector3d deviation = motion.cog[s.k] - s.command.cog;
  motion.cog_deviation[s.k] = deviation.norm();
  judge_difference(motion, FindingKind::cog_residual, s.k, deviation);
  if (s.known) judge_vertical_force(motion, s);
  if (s.has_zmp()) judge_zmp(motion, s);
}

}  // namespace

WrenchRows commanded_zmp_rows(const RowSite& site, int point) {
  const Vector3d zmp = site.points[point].plane.frame.inverse() * site.given(point).zmp;
  Eigen::Matrix<double, 2, 6> rows;
  rows.row(0) << 0, 0, -zmp.x(), 0, -1, 0;
  rows.row(1) << 0, 0, -zmp.y(), 1, 0, 0;
  return linear_rows(rows / site.weight());
}

namespace {

const RowKind kCogRows = {.name = "cog", .unit = &RowPrices::length, .order = {7, 0}};
const RowKind kZmpRows = {.name = "zmp", .unit = &RowPrices::length, .order = {7, 1}};

// If the COG or the ZMP is trusted, the repair moves the motion to the commanded value.
void place_command_rows(RowSite& site) {
  const RowSettings& settings = site.settings;
  const double cog = settings.trusted_share * site.tolerance(FindingKind::cog_residual);
  const double zmp = settings.trusted_share * site.tolerance(FindingKind::zmp_residual);
  for (int i = 0; i < site.count(); ++i) {
    if (settings.trust == Trust::cog)
      site.add(kCogRows, i, 0, CogRows{site.given(i).cog}, 3, -cog, cog);
    if (settings.trust == Trust::zmp && site.points[i].stands())
      site.add(kZmpRows, i, 0, commanded_zmp_rows(site, i), 2, -zmp, zmp);
  }
}

bool zmp_holds(JudgedMotion& motion, const Violation& v, double pace) {
  const SampleDynamics& now = motion.dynamics.at(v.sample, pace);
  return now.use.has_zmp &&
         (now.use.zmp_world - motion.series.samples[v.sample].zmp).norm() <= std::abs(v.limit);
}

bool vertical_force_holds(JudgedMotion& motion, const Violation& v, double pace) {
  return std::abs(motion.dynamics.at(v.sample, pace).wrench[2] -
                  motion.series.samples[v.sample].fz) <= std::abs(v.limit);
}

const char* force_unit(const JudgedMotion&, const Violation&) { return "N"; }

Place vertical_place(const JudgedMotion&, const Violation&) { return AxisPlace{2}; }

Advice cog_advice(const JudgedMotion&, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {"the COG of the posture is " + in_mm(v.value) +
              " away from the commanded COG, mostly along " + axis_name(v.detail),
          "change the COG key or the posture",
          std::string(kOrRepair) + ", which keeps the posture"};
}

Advice zmp_advice(const JudgedMotion&, const FindingWindow& window) {
  const Violation& v = window.worst;
  return {"the ZMP of the motion is " + in_mm(v.value) +
              " away from the commanded ZMP, mostly along " + axis_name(v.detail),
          "change the ZMP key or the motion", std::string(kOrRepair) + ", which keeps the motion"};
}

Advice vertical_force_advice(const JudgedMotion&, const FindingWindow& window) {
  const double value = window.worst.value;
  return {"the motion needs " + text::fixed(std::abs(value), 1) + " N " +
              (value > 0 ? "more" : "less") + " than the commanded f_z",
          "remove the keys \"fz\"", kOrRepair};
}

Advice point_mass_advice(const JudgedMotion&, const FindingWindow& window) {
  return "the point-mass model would have a ZMP error of " + in_mm(window.worst.value) +
         " here. Nothing has to change, because Ayumi computes the motion with the full model";
}

std::string cog_infeasibility(const Finding& f, double) {
  return "the COG of the posture is " + in_mm(f.worst) + " away from the commanded COG";
}

std::string zmp_infeasibility(const Finding& f, double) {
  return "the ZMP of the motion is " + in_mm(f.worst) + " away from the commanded ZMP";
}

}  // namespace

const Limit& command_agreement_limit() {
  static const Limit limit = {
      .findings =
          {{.kind = FindingKind::cog_residual,
            .limit_class = LimitClass::command,
            .unit = "m",
            .tolerance = kCogTolerance,
            .meaning = "distance between the COG of the posture and the commanded COG",
            .figure = {.key = "max_cog_residual_m",
                       .label = "largest COG residual",
                       .unit = "mm",
                       .scale = 1e3,
                       .line = 2},
            .repair = {.is_of_plan = true},
            .place = axis_place,
            .advice = cog_advice,
            .infeasibility = cog_infeasibility},
           {.kind = FindingKind::zmp_residual,
            .limit_class = LimitClass::command,
            .unit = "m",
            .tolerance = kZmpTolerance,
            .meaning = "distance between the ZMP of the full model and the commanded ZMP",
            .figure = {.key = "max_zmp_residual_m",
                       .label = "largest ZMP residual",
                       .unit = "mm",
                       .scale = 1e3,
                       .line = 3},
            .repair = {.is_of_plan = true},
            .place = axis_place,
            .advice = zmp_advice,
            .infeasibility = zmp_infeasibility,
            .holds_at = zmp_holds},
           {.kind = FindingKind::fz_residual,
            .limit_class = LimitClass::command,
            .unit = "m g",
            .tolerance = kForceTolerance,
            .meaning = "difference between the vertical force that the motion needs and the "
                       "commanded vertical force. The tolerance is a share of the weight",
            .figure = {.key = "max_fz_residual_N",
                       .label = "largest vertical force residual",
                       .unit = "N",
                       .line = 4},
            .finding_unit = force_unit,
            .place = vertical_place,
            .advice = vertical_force_advice,
            .holds_at = vertical_force_holds},
           {.kind = FindingKind::point_mass_gap,
            .limit_class = LimitClass::command,
            .unit = "m",
            .tolerance = kPointMassTolerance,
            .meaning =
                "distance between the ZMP of the point-mass model (14)(15) and the commanded ZMP. "
                "This distance shows how well the point-mass model describes the motion. The "
                "finding is never an error",
            .figure = {.key = "max_point_mass_gap_m",
                       .label = "largest ZMP error of the point-mass model",
                       .unit = "mm",
                       .scale = 1e3,
                       .line = 5},
            .place = axis_place,
            .advice = point_mass_advice}},
      .judge_sample = judge_command,
      .place_rows = place_command_rows};
  return limit;
}

}  // namespace ayumi
