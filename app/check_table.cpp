#include "check_table.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"

namespace ayumi::app {

namespace {

std::string padded(std::string text, size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string mm(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }

std::string quantity(double value, const std::string& unit) {
  if (unit == "m") return mm(value);
  if (unit == "1") return text::fixed(value, 2);
  return text::brief(value) + " " + unit;
}

std::string seconds(const Finding& f) {
  if (f.begin == f.end) return "at " + text::fixed(f.at, 3) + " s";
  return text::fixed(f.begin, 3) + "-" + text::fixed(f.end, 3) + " s, worst at " +
         text::fixed(f.at, 3) + " s";
}

std::string percent(double ratio) { return text::fixed(100 * ratio, 0) + " %"; }

}  // namespace

std::string check_table(const ConsistencyReport& report) {
  std::string out;
  for (const Finding& f : report.findings)
    out += "  " + padded(name_of(f.severity), 8) + padded(name_of(f.kind), 19) + f.where + ", " +
           seconds(f) + ": " + quantity(f.worst, f.unit) + ", limit " + quantity(f.limit, f.unit) +
           "\n" + std::string(10, ' ') + f.hint + "\n";
  const CheckSummary& s = report.summary;
  out += "  ZMP " + mm(std::abs(s.min_zmp_margin)) +
         (s.min_zmp_margin < 0 ? " outside" : " inside") + " the support; residuals COG " +
         mm(s.max_cog_residual) + ", ZMP " + mm(s.max_zmp_residual) + ", f_z " +
         text::fixed(s.max_fz_residual, 2) + " N; point mass off by " + mm(s.max_point_mass_gap) +
         "\n";
  out += "  of the limits: position " + percent(s.max_joint_position_ratio) + ", speed " +
         percent(s.max_joint_speed_ratio) + ", torque " + percent(s.max_torque_ratio) +
         ", continuous " + percent(s.max_continuous_torque_ratio) + ", friction " +
         percent(s.max_friction_ratio) + ", yaw " + percent(s.max_yaw_ratio) + "\n";
  out += "  feet: slip " + mm(s.max_foot_slip) + ", into the ground " + mm(s.max_foot_penetration) +
         ", above it in contact " + mm(s.max_foot_float) + "; bodies " + mm(s.min_self_clearance) +
         " apart\n";
  return out;
}

std::string tolerance_table() {
  std::string out;
  for (const FindingSpec& spec : finding_specs())
    out += padded(name_of(spec.kind), 20) +
           padded(text::brief(spec.tolerance) + " " + spec.unit, 14) + spec.meaning + "\n";
  return out;
}

}  // namespace ayumi::app
