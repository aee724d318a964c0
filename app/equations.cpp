#include "equations.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi::app {

using Eigen::Vector3d;
using Lines = std::vector<std::string>;

namespace {

std::string mm(double metres) { return text::fixed(1e3 * metres, 1) + " mm"; }
std::string fixed(double value, int digits) { return text::fixed(value, digits); }

double height(const SimulationSample& s) { return s.command_cog.z() - s.command_zmp.z(); }

struct Delta {
  Vector3d e, de;
};

/// (21): command - measured.
Delta delta(const RunInstant& i) {
  return {i.now().command_cog - i.now().measured_cog,
          i.rate(&SimulationSample::command_cog) - i.rate(&SimulationSample::measured_cog)};
}

double K(const RunInstant& i) { return long_term_k(i.gains); }
double D(const RunInstant& i) {
  const double w = std::sqrt(kGravity / height(i.now()));
  return long_term_d(i.gains) / w;
}

Lines cog_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  Lines lines;
  for (int a = 0; a < 3; ++a)
    lines.push_back(std::string("COG ") + "xyz"[a] + ": true " + mm(s.cog[a]) + ", estimated " +
                    mm(s.measured_cog[a]) + ", reference " + mm(s.reference_cog[a]) +
                    ", commanded " + mm(s.command_cog[a]));
  return lines;
}

Lines pendulum_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  const double w2 = i.omega_squared();
  Lines lines;
  for (int a = 0; a < 2; ++a) {
    const double x = s.measured_cog[a], wanted = s.reference_zmp[a], real = s.measured_zmp[a];
    lines.push_back(std::string(1, "xy"[a]) + ": required " + fixed(w2, 1) + " /s2 x (" + mm(x) +
                    " - " + mm(wanted) + ") = " + fixed(w2 * (x - wanted), 3) +
                    " m/s2; the ground gives " + fixed(w2, 1) + " x (" + mm(x) + " - " + mm(real) +
                    ") = " + fixed(w2 * (x - real), 3) + " m/s2");
    lines.push_back("   the difference is w2 (ZMP - ref ZMP) = " + fixed(w2 * (real - wanted), 3) +
                    " m/s2; ka = " + text::brief(i.gains.zmp_gain) +
                    " times this difference is added to the reference");
  }
  return lines;
}

Lines vertical_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  const double m = i.model.mass();
  return {"z: ref f_z / m - g = " + fixed(s.reference_fz, 1) + " N / " + fixed(m, 2) +
          " kg - g = " + fixed(s.reference_fz / m - kGravity, 3) + " m/s2; measured f_z " +
          fixed(s.measured_fz, 1) + " N gives " + fixed(s.measured_fz / m - kGravity, 3) + " m/s2"};
}

Lines omega_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  const double w2 = i.omega_squared();
  return {"w2 = " + fixed(s.reference_fz, 1) + " N / (" + fixed(i.model.mass(), 2) + " kg x " +
          mm(height(s)) + ") = " + fixed(w2, 2) + " /s2, omega = " + fixed(std::sqrt(w2), 2) +
          " /s: an error grows by the factor e in " + fixed(1e3 / std::sqrt(w2), 0) + " ms"};
}

Lines zmp_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  const Delta d = delta(i);
  Lines lines = {"K = " + text::brief(K(i)) + ", D = " + fixed(1e3 * D(i), 0) + " ms"};
  Vector3d cut_off = Vector3d::Zero();
  for (int a = 0; a < 2; ++a) {
    const double wanted = s.command_zmp[a] - K(i) * d.e[a] - D(i) * d.de[a];
    const double cut = cut_off[a] = s.reference_zmp[a] - wanted;
    lines.push_back(
        std::string(1, "xy"[a]) + ": " + mm(s.command_zmp[a]) + " - K x " + mm(d.e[a]) + " - D x " +
        fixed(1e3 * d.de[a], 1) + " mm/s = " + mm(wanted) +
        (std::abs(cut) > 1e-3
             ? "; moved to " + mm(s.reference_zmp[a]) + ", the nearest point of the support"
             : "; inside the support, so ref ZMP = " + mm(s.reference_zmp[a])));
  }
  if (cut_off.norm() > 1e-3)
    lines.push_back("the wanted ZMP is " + mm(cut_off.norm()) + " outside the support of the " +
                    (s.planned_contact[0] && s.planned_contact[1] ? "feet"
                     : s.planned_contact[0]                       ? "left foot"
                                                                  : "right foot"));
  return lines;
}

Lines force_numbers(const RunInstant& i) {
  const SimulationSample& s = i.now();
  const Delta d = delta(i);
  const double m = i.model.mass(), w = std::sqrt(kGravity / height(s));
  const double kz = i.gains.height_stiffness * w * w, dz = i.gains.height_damping * w;
  return {"ref f_z = " + fixed(s.command_fz, 1) + " + " + fixed(m, 2) + " x (" + fixed(kz, 1) +
          " x " + mm(d.e.z()) + " + " + fixed(dz, 1) + " x " + fixed(1e3 * d.de.z(), 1) +
          " mm/s) = " + fixed(s.command_fz + m * (kz * d.e.z() + dz * d.de.z()), 1) +
          " N; the log has " + fixed(s.reference_fz, 1) + " N"};
}

Lines delta_numbers(const RunInstant& i) {
  const Delta d = delta(i);
  Lines lines;
  for (int a = 0; a < 3; ++a)
    lines.push_back(std::string("Delta ") + "xyz"[a] + " = " + mm(d.e[a]) + ", its rate " +
                    fixed(1e3 * d.de[a], 1) + " mm/s");
  return lines;
}

/// Joints that have met a limit by now, and the tasks that gave way to them.
Lines limit_numbers(const RunInstant& i) {
  const double t = i.log.dt * (static_cast<double>(i.k) + 0.5);
  Lines lines;
  for (const SimulationEvent& event : i.log.events)
    if (event.kind == "saturation" && event.t < t)
      lines.push_back("from " + fixed(event.t, 3) + " s on: " + event.text);
  if (lines.empty())
    lines.push_back(
        "so far no joint has reached a limit, and the controller has followed all its targets");
  return lines;
}

Lines resolution_numbers(const RunInstant& i) {
  const size_t n = i.log.samples.size();
  const size_t a = i.k > 0 ? i.k - 1 : 0, b = std::min(i.k + 1, n - 1);
  const double dt = i.log.dt * static_cast<double>(std::max<size_t>(1, b - a));
  const Eigen::VectorXd rates =
      (i.log.samples[b].reference_theta - i.log.samples[a].reference_theta) / dt;
  const Vector3d cog = (i.log.samples[b].reference_cog - i.log.samples[a].reference_cog) / dt;
  std::vector<int> order(static_cast<size_t>(rates.size()));
  for (size_t j = 0; j < order.size(); ++j) order[j] = static_cast<int>(j);
  std::stable_sort(order.begin(), order.end(),
                   [&](int x, int y) { return std::abs(rates[x]) > std::abs(rates[y]); });
  std::string joints;
  for (size_t j = 0; j < std::min<size_t>(5, order.size()); ++j)
    joints += (j ? ", " : "") + i.log.joints[static_cast<size_t>(order[j])] + " " +
              fixed(rates[order[j]], 2);
  Lines lines = {"ref COG rate " + fixed(1e3 * cog.x(), 1) + ", " + fixed(1e3 * cog.y(), 1) + ", " +
                     fixed(1e3 * cog.z(), 1) + " mm/s is produced by " +
                     std::to_string(rates.size()) + " joints together; the fastest joints [rad/s]:",
                 "  " + joints};
  for (const std::string& line : limit_numbers(i)) lines.push_back(line);
  return lines;
}

const char* kTree =
    "Velocities add up along the tree of links: every point's velocity is linear in the joint "
    "rates.";
const char* kFloating =
    "The velocity of the COG is the mass-weighted mean of the velocities of all links, the root "
    "included. Relative to the base it is linear in the joint rates.";
const char* kAnchored =
    "The robot is not bolted to the ground. The foot on which it stands is at rest, so the motion "
    "of the joints determines the motion of the base.";
const char* kCogJacobian =
    "With this motion of the base, one matrix J_G maps the joint rates to the velocity of the COG "
    "in the world. All joints together move the COG.";
const char* kPendulum =
    "The robot is an inverted pendulum above its ZMP: the ground force points from the ZMP through "
    "the COG. The farther the COG is from the ZMP, the faster it accelerates away from the ZMP. "
    "The short term of DTAD uses this: when the measured ZMP differs from the reference ZMP, the "
    "reference COG moves to absorb the difference.";
const char* kLong =
    "The long term of DTAD computes the ZMP that brings the COG back to the command. The ZMP moves "
    "by more than the error of the COG (K > 1), and by still more while this error grows (D > 0; "
    "the printed + is a misprint). A ZMP outside the support is replaced by the nearest point of "
    "the "
    "support, because the ground cannot push outside the feet.";
const char* kResolve =
    "Many joint rates give the COG its reference velocity while the free foot and the trunk follow "
    "the plan. This equation selects the rates nearest to the commanded ones, weighted with W. (v "
    "is u - J_U cmd dtheta; the paper prints the other sign.)";
const char* kJump =
    "Height law of the variable impedant pendulum: a spring and a damper act between the COG and "
    "its reference height. The gains of (25) hold the height without overshoot. The gains of (26) "
    "throw the robot z_H high from a stoop of depth z_d. The gains of (27) stop it within z_d "
    "after "
    "touchdown. The corrected (25) contains the mass: K_Dz^2 >= 4 m K_Pz.";
const char* kSynergy =
    "This is (22)(23) without commanded rates: the whole body follows only the COG.";

}  // namespace

Vector3d RunInstant::rate(Vector3d SimulationSample::*point) const {
  const size_t a = k >= 2 ? k - 2 : 0, b = std::min(k + 2, log.samples.size() - 1);
  if (a == b) return Vector3d::Zero();
  return (log.samples[b].*point - log.samples[a].*point) / (log.dt * static_cast<double>(b - a));
}

double RunInstant::omega_squared() const {
  return now().reference_fz / (model.mass() * height(now()));
}

const std::vector<Equation>& equations() {
  static const std::vector<Equation> all = [] {
    std::vector<Equation> list;
    const auto add = [&](int first, int last, const char* formula, const char* words,
                         Lines (*numbers)(const RunInstant&)) {
      for (int n = first; n <= last; ++n) list.push_back({n, formula, words, numbers});
    };
    add(1, 4, "0v_k = 0J_k dtheta,  0w_k = 0J_wk dtheta", kTree, nullptr);
    add(5, 7, "0dp_G = sum m_k 0dp_Gk / sum m_k = 0J_G dtheta", kFloating, cog_numbers);
    add(8, 11, "w_0 = w_F - R_0 0J_wF dtheta,  dp_0 analogously, with the foot F at rest",
        kAnchored, nullptr);
    add(12, 13, "dp_G = J_G dtheta", kCogJacobian, cog_numbers);
    add(14, 15, "ddx = w2 (x - x_Z),  ddy = w2 (y - y_Z)", kPendulum, pendulum_numbers);
    add(16, 16, "ddz = f_z / m - g",
        "The vertical ground force carries the weight; the difference between the two accelerates "
        "the COG.",
        vertical_numbers);
    add(17, 17, "w2 = f_z / (m (z_G - z_Z))",
        "w is the rate of the pendulum: a lower robot falls faster. Without a ground force, w has "
        "no "
        "meaning.",
        omega_numbers);
    add(18, 19, "ref x_Z = cmd x_Z - K Delta x - D Delta dx, then the nearest point of the support",
        kLong, zmp_numbers);
    add(20, 20, "ref f_z = cmd f_z + m (K_z Delta z + D_z Delta dz), not below f_min",
        "This is the law for the height: the feet push harder when the COG is too low or sinks.",
        force_numbers);
    add(21, 21, "Delta = cmd - measured",
        "Delta is the command minus the measurement, in the frame of the foot on which the robot "
        "stands.",
        delta_numbers);
    add(22, 23, "ref dtheta = cmd dtheta + W^-1 J_U' (J_U W^-1 J_U')^-1 v,  v = u - J_U cmd dtheta",
        kResolve, resolution_numbers);
    add(24, 27, "ref f_z = K_Pz (ref z - z) + K_Dz (ref dz - dz) + m g", kJump, vertical_numbers);
    add(28, 29, "ref dtheta = W^-1 J_U' (J_U W^-1 J_U')^-1 u", kSynergy, resolution_numbers);
    return list;
  }();
  return all;
}

}  // namespace ayumi::app
