#include "equations.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi::app {

using Eigen::Vector3d;

namespace {

using S = SimulationSample;

constexpr char kAxis[] = "xyz";

std::string mm(double metres) { return text::fixed(1e3 * metres, 1) + " mm"; }
std::string fixed(double value, int digits) { return text::fixed(value, digits); }
std::string rate_text(double radians) { return text::brief(radians * 180 / M_PI, 3) + " deg/s"; }
std::string acceleration(double value) { return fixed(value, 3) + " m/s2"; }

/// Collects lines and values; a number that is put into a line is also kept as a value.
class Writer {
 public:
  explicit Writer(const RunInstant& instant) : s_(instant.now()) {}

  const S& now() const { return s_; }
  void line(const std::string& words) { out_.lines.push_back(words); }

  double scalar(const std::string& name, const char* unit, double value,
                std::optional<double> computed = {}) {
    out_.values.push_back(
        {name + (std::string(unit) == "1" ? "" : "[" + std::string(unit) + "]"), value, computed});
    return value;
  }
  double part(const std::string& name, const char* unit, const Vector3d& value, int axis,
              std::optional<double> computed = {}) {
    return scalar(name + "." + kAxis[axis], unit, value[axis], computed);
  }
  EquationNumbers take() { return std::move(out_); }

 private:
  const S& s_;
  EquationNumbers out_;
};

/// Whether DTAD computed this tick, or a baseline that uses DTAD's control of the body. A run under
/// one controller may have phases of the other one.
bool dtad(const RunInstant& i) {
  const LawStage stage = i.now().law.stage;
  return stage == LawStage::follow || stage == LawStage::follow_flight;
}
bool literal(const RunInstant& i) {
  return dtad(i) && i.log.controller->demonstration == Demonstration::literal;
}
/// Whether a baseline chose the ZMP of this tick, if dtad() is true for it.
bool baseline(const RunInstant& i) {
  return dtad(i) && i.log.controller && is_baseline(i.log.controller->kind);
}
bool previewed(const RunInstant& i) {
  return baseline(i) && i.log.controller->kind == ControllerKind::preview;
}
/// Whether the gains of the log are those of the law that computed this tick.
bool own_gains(const RunInstant& i) {
  if (!i.log.controller) return false;
  const ControllerKind kind = i.log.controller->kind;
  return dtad(i) ? has_dtad_gains(kind) : kind == ControllerKind::viip;
}

const char* stage_words(LawStage stage) {
  switch (stage) {
    case LawStage::replay:
      return "open loop: the servos receive the command, and nothing is measured";
    case LawStage::follow:
      return "DTAD follows the command on the ground";
    case LawStage::follow_flight:
      return "DTAD in flight: the posture returns to the command, and nothing about the COG is "
             "measured";
    case LawStage::stand:
      return "VIIP stands on both feet";
    case LawStage::weight_shift:
      return "VIIP shifts the weight before its first step";
    case LawStage::single_support:
      return "VIIP makes steps, and the robot stands on one foot";
    case LawStage::double_support:
      return "VIIP makes steps, and the robot stands on both feet";
    case LawStage::stoop:
      return "VIIP stoops for a jump, by (24)(25)";
    case LawStage::push:
      return "VIIP pushes off, by (26)";
    case LawStage::flight:
      return "VIIP is in flight, and the commanded ground force is 0";
    case LawStage::landing:
      return "VIIP lands, by (27)";
    case LawStage::settle:
      return "VIIP comes back to its height, by (24)(25)";
  }
  return "";
}

bool on_ground(LawStage stage) {
  return stage != LawStage::replay && stage != LawStage::follow_flight && stage != LawStage::flight;
}

Writer begin(const RunInstant& i) {
  Writer w(i);
  if (baseline(i))
    w.line("the controller " + name_of(*i.log.controller) +
           " chooses the ZMP in place of (18)(19). Everything else is as in DTAD");
  w.line(stage_words(i.now().law.stage));
  w.scalar("law.stage", "1", static_cast<double>(i.now().law.stage));
  return w;
}

EquationNumbers cog_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  for (int a = 0; a < 3; ++a)
    w.line(std::string("COG ") + kAxis[a] + ": true " + mm(w.part("cog", "m", s.cog, a)) +
           ", estimated " + mm(w.part("measured.cog", "m", s.measured_cog, a)) + ", reference " +
           mm(w.part("ref.cog", "m", s.reference_cog, a)) + ", commanded " +
           mm(w.part("cmd.cog", "m", s.command_cog, a)));
  return w.take();
}

/// The summands of the reference's acceleration along an axis, and their sum.
void acceleration_lines(Writer& w, const RunInstant& i, int a) {
  const S& s = w.now();
  const LawTerms& law = s.law;
  const bool plan = dtad(i) && !literal(i);
  const double sum = law.motion[a] + law.pull[a] + law.short_term[a] + law.rocking[a];
  w.line(std::string(1, kAxis[a]) + ": " +
         (previewed(i) && a < 2 ? "acceleration of the previewed COG "
          : plan                ? "commanded acceleration "
                                : "acceleration of the pendulum itself ") +
         fixed(w.part("law.motion", "m/s^2", law.motion, a), 3) + ", short term " +
         fixed(w.part("law.short_term", "m/s^2", law.short_term, a), 3) + ", pull to the " +
         (previewed(i) && a < 2 ? "previewed COG "
          : plan                ? "command "
                                : "measured state ") +
         fixed(w.part("law.pull", "m/s^2", law.pull, a), 3) + ", damping of the rocking " +
         fixed(w.part("law.rocking", "m/s^2", law.rocking, a), 3) + ", sum of these terms " +
         acceleration(sum));
  const double asked = w.part("ref.ddcog", "m/s^2", s.reference_ddcog, a);
  if (std::abs(asked - sum) > 1e-9)
    w.line("   this acceleration is bounded to " + acceleration(asked));
}

EquationNumbers pendulum_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  const LawTerms& law = s.law;
  if (!on_ground(law.stage)) return w.take();
  const double w2 = w.scalar("law.omega2", "1/s^2", law.omega2);
  for (int a = 0; a < 2; ++a) {
    const double x = w.part("measured.cog", "m", s.measured_cog, a);
    const double wanted = w.part("ref.zmp", "m", s.reference_zmp, a);
    const double real = w.part("law.filtered_zmp", "m", law.filtered_zmp, a);
    w.line(std::string(1, kAxis[a]) + ": required acceleration " + fixed(w2, 1) + " /s2 x (" +
           mm(x) + " - " + mm(wanted) + ") = " + acceleration(w2 * (x - wanted)) +
           ". The ground gives " + fixed(w2, 1) + " x (" + mm(x) + " - " + mm(real) +
           ") = " + acceleration(w2 * (x - real)));
    if (literal(i)) {
      w.part("law.motion", "m/s^2", law.motion, a, w2 * (x - wanted));
      w.line("   the required acceleration is integrated without a correction");
      continue;
    }
    const double offset = w.part("law.offset", "m", law.offset, a);
    const double ka = own_gains(i) ? i.gain("ka") : 0;
    if (law.short_term.head<2>().isZero(0)) {
      w.line("   short term: none, because no foot carries the robot or the gain ka is 0");
    } else if (ka > 0) {
      // DTAD changes its offset after it has used it, so the gap is computed from the term itself.
      const double gap = law.short_term[a] / (ka * w2);
      w.line("   short term: ka = " + text::brief(ka) + " times w2 x (ZMP - ref ZMP" +
             (offset != 0 ? " - offset " + mm(offset) : std::string()) +
             "). The value in parentheses is " + mm(gap));
    }
    acceleration_lines(w, i, a);
  }
  return w.take();
}

EquationNumbers vertical_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  const double wanted = w.scalar("ref.fz", "N", s.reference_fz),
               measured = w.scalar("measured.fz", "N", s.measured_fz);
  w.line("z: ref f_z / m - g = " + fixed(wanted, 1) + " N / " + fixed(i.mass, 2) +
         " kg - g = " + acceleration(wanted / i.mass - kGravity) + ". The measured f_z " +
         fixed(measured, 1) + " N gives " + acceleration(measured / i.mass - kGravity));
  if (on_ground(s.law.stage)) acceleration_lines(w, i, 2);
  return w.take();
}

EquationNumbers omega_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  if (!on_ground(s.law.stage)) {
    w.line("there is no pendulum in flight or in open loop, so w is not used");
    return w.take();
  }
  const double f = w.scalar("ref.fz", "N", s.reference_fz);
  const double z = w.scalar("law.height", "m", s.law.height);
  const double w2 = w.scalar("law.omega2", "1/s^2", s.law.omega2, f / (i.mass * z));
  w.line("w2 = " + fixed(f, 1) + " N / (" + fixed(i.mass, 2) + " kg x " + mm(z) +
         ") = " + fixed(w2, 2) + " /s2, omega = " + fixed(std::sqrt(w2), 2) +
         " /s: an error grows by the factor e in " + fixed(1e3 / std::sqrt(w2), 0) + " ms");
  return w.take();
}

EquationNumbers zmp_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  const LawTerms& law = s.law;
  if (!on_ground(law.stage)) {
    w.line("(18)(19) are not used in flight or in open loop. The reference ZMP is the planned ZMP");
    return w.take();
  }
  const double K = w.scalar("law.K", "1", law.K), D = w.scalar("law.D", "s", law.D);
  w.line(previewed(i) ? "the wanted ZMP is the ZMP of the previewed COG plus " + fixed(K, 3) +
                            " times the error of the COG. This error is the measured COG minus the "
                            "previewed COG, plus " +
                            fixed(1e3 * D / K, 0) + " ms times the difference of their speeds"
         : baseline(i) ? "the wanted ZMP is the planned ZMP plus " + fixed(K, 3) +
                             " times the error of the DCM. The DCM is the COG plus " +
                             fixed(1e3 * D / K, 0) + " ms times its speed"
         : dtad(i) ? "K = " + text::brief(K) + ", D = " + fixed(1e3 * D, 0) + " ms"
                   : "the wanted ZMP moves by K = " + fixed(K, 3) +
                         " times the displacement of the COG, and by D = " + fixed(1e3 * D, 0) +
                         " ms times its speed");
  const Vector3d e = s.command_cog - s.measured_cog, de = s.command_dcog - s.measured_dcog;
  for (int a = 0; a < 2; ++a) {
    const double planned = w.part("law.planned_zmp", "m", law.planned_zmp, a);
    if (previewed(i)) {
      const double wanted = w.part("law.wanted_zmp", "m", law.wanted_zmp, a);
      w.line(std::string(1, kAxis[a]) + ": planned " + mm(planned) + ", wanted " + mm(wanted));
    } else if (dtad(i)) {
      const double wanted =
          w.part("law.wanted_zmp", "m", law.wanted_zmp, a, planned - K * e[a] - D * de[a]);
      w.line(std::string(1, kAxis[a]) + ": " + mm(planned) + " - K x " + mm(e[a]) + " - D x " +
             fixed(1e3 * de[a], 1) + " mm/s = " + mm(wanted));
    } else {
      w.line(std::string(1, kAxis[a]) + ": ZMP wanted by the measured state " +
             mm(w.part("law.wanted_zmp", "m", law.wanted_zmp, a)) +
             ", ZMP of the reference pendulum " + mm(planned));
    }
  }
  const Vector3d cut = s.reference_zmp - law.wanted_zmp;
  w.part("ref.zmp", "m", s.reference_zmp, 0);
  w.part("ref.zmp", "m", s.reference_zmp, 1);
  const std::string feet = s.planned_contact[0] && s.planned_contact[1] ? "both feet"
                           : s.planned_contact[0]                       ? "the left foot"
                                                                        : "the right foot";
  if (cut.head<2>().norm() > 1e-12)
    w.line("the wanted ZMP is moved by " + mm(cut.head<2>().norm()) +
           " to the nearest point of the support of " + feet +
           ": ref ZMP = " + mm(s.reference_zmp.x()) + ", " + mm(s.reference_zmp.y()));
  else
    w.line("the wanted ZMP is inside the support of " + feet +
           ", so the ref ZMP is the same point");
  return w.take();
}

EquationNumbers force_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  if (!dtad(i)) {
    w.line(s.law.stage == LawStage::replay ? "ref f_z is the commanded f_z"
                                           : "the height follows (24) to (27), not (20)");
    w.scalar("ref.fz", "N", s.reference_fz);
    return w.take();
  }
  const double command = w.scalar("cmd.fz", "N", s.command_fz);
  if (!on_ground(s.law.stage)) {
    w.scalar("ref.fz", "N", s.reference_fz, 0.0);
    w.line("ref f_z = 0 in flight");
    return w.take();
  }
  const double kz = w.scalar("law.K_z", "1/s^2", s.law.K_z),
               dz = w.scalar("law.D_z", "1/s", s.law.D_z);
  const double e = s.command_cog.z() - s.measured_cog.z(),
               de = s.command_dcog.z() - s.measured_dcog.z();
  const double wanted = command + i.mass * (kz * e + dz * de);
  const double force = w.scalar("ref.fz", "N", s.reference_fz, admissible_force(wanted, i.mass));
  w.line("ref f_z = " + fixed(command, 1) + " + " + fixed(i.mass, 2) + " x (" + fixed(kz, 1) +
         " x " + mm(e) + " + " + fixed(dz, 1) + " x " + fixed(1e3 * de, 1) +
         " mm/s) = " + fixed(wanted, 1) + " N" +
         (force != wanted ? ", raised to the least admissible " + fixed(force, 1) + " N" : ""));
  return w.take();
}

EquationNumbers delta_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  for (int a = 0; a < 3; ++a) {
    const double e =
        w.part("cmd.cog", "m", s.command_cog, a) - w.part("measured.cog", "m", s.measured_cog, a);
    const double de = w.part("cmd.dcog", "m/s", s.command_dcog, a) -
                      w.part("measured.dcog", "m/s", s.measured_dcog, a);
    w.line(std::string("Delta ") + kAxis[a] + " = " + mm(e) + ", its rate " + fixed(1e3 * de, 1) +
           " mm/s");
  }
  if (s.law.stage != LawStage::follow) w.line("Delta is not fed back here");
  return w.take();
}

/// (24) to (27): the spring that held the height at this instant.
EquationNumbers spring_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  const LawTerms& law = s.law;
  if (law.K_Pz == 0) {
    w.line(dtad(i) ? "under DTAD the height follows (20)" : "no spring acts here");
    w.scalar("ref.fz", "N", s.reference_fz);
    return w.take();
  }
  const double kp = w.scalar("law.K_Pz", "N/m", law.K_Pz),
               kd = w.scalar("law.K_Dz", "N s/m", law.K_Dz);
  const double goal = w.scalar("law.spring_goal", "m", law.spring_goal),
               z = w.scalar("law.spring_height", "m", law.spring_height),
               dz = w.scalar("law.spring_rate", "m/s", law.spring_rate);
  const double wanted = kp * (goal - z) - kd * dz + i.mass * kGravity;
  const bool lands = law.stage == LawStage::landing, pushes = law.stage == LawStage::push;
  const double bounded = lands    ? wanted
                         : pushes ? std::max(0.0, wanted)
                                  : admissible_force(wanted, i.mass);
  const double force = w.scalar("ref.fz", "N", s.reference_fz, bounded);
  w.line("ref f_z = " + fixed(kp, 0) + " N/m x (" + mm(goal) + " - " + mm(z) + ") - " +
         fixed(kd, 1) + " N s/m x " + fixed(1e3 * dz, 1) + " mm/s + m g = " + fixed(wanted, 1) +
         " N" + (bounded != wanted ? ", bounded to " + fixed(force, 1) + " N" : std::string()));
  if (!lands && !pushes)
    w.line("(25): K_Dz^2 = " + fixed(kd * kd, 0) +
           (kd * kd >= 4 * i.mass * kp * (1 - 1e-12) ? " is at least" : " is below") +
           " 4 m K_Pz = " + fixed(4 * i.mass * kp, 0) + " N2s2/m2");
  return w.take();
}

/// Lists the joints that have reached a limit by now, and the tasks that were changed because of
/// them.
void limit_lines(Writer& w, const RunInstant& i) {
  const double t = i.log.dt * (static_cast<double>(i.k) + 0.5);
  bool any = false;
  for (const SimulationEvent& event : i.log.events)
    if (event.kind == EventKind::saturation && event.t < t) {
      any = true;
      w.line("from " + fixed(event.t, 3) + " s on: " + event.text);
    }
  if (!any) w.line("so far no joint has reached a limit");
}

EquationNumbers resolution_numbers(const RunInstant& i) {
  Writer w = begin(i);
  const S& s = w.now();
  if (s.law.stage == LawStage::replay || s.law.stage == LawStage::follow_flight) {
    w.line("no equation is solved here: the joints follow their command");
    return w.take();
  }
  const Eigen::VectorXd& rates = s.reference_dtheta;
  std::vector<int> order(static_cast<size_t>(rates.size()));
  for (size_t j = 0; j < order.size(); ++j) order[j] = static_cast<int>(j);
  std::stable_sort(order.begin(), order.end(),
                   [&](int x, int y) { return std::abs(rates[x]) > std::abs(rates[y]); });
  std::string joints;
  for (size_t j = 0; j < std::min<size_t>(5, order.size()); ++j) {
    const std::string& name = i.log.joints[static_cast<size_t>(order[j])];
    joints += (j ? ", " : "") + name + " " +
              rate_text(w.scalar("ref.dtheta." + name, "rad/s", rates[order[j]])) + " (W " +
              text::brief(w.scalar("weight." + name, "1", s.weight[order[j]])) + ")";
  }
  w.line("ref COG rate " + fixed(1e3 * w.part("ref.dcog", "m/s", s.reference_dcog, 0), 1) + ", " +
         fixed(1e3 * w.part("ref.dcog", "m/s", s.reference_dcog, 1), 1) + ", " +
         fixed(1e3 * w.part("ref.dcog", "m/s", s.reference_dcog, 2), 1) + " mm/s is produced by " +
         std::to_string(rates.size()) + " joints together. The fastest joints:");
  w.line("  " + joints);
  const TaskResiduals& left = s.residuals;
  w.line("part of u that J_U ref dtheta does not produce: COG " +
         text::brief(1e3 * w.scalar("residual.cog", "m/s", left.cog)) + " mm/s, foot " +
         text::brief(1e3 * w.scalar("residual.foot", "m/s", left.foot)) + " mm/s and " +
         rate_text(w.scalar("residual.foot_turn", "rad/s", left.foot_turn)) + ", trunk " +
         rate_text(w.scalar("residual.trunk", "rad/s", left.trunk)));
  limit_lines(w, i);
  return w.take();
}

const char* kTree =
    "Velocities add up along the tree of links: every point's velocity is linear in the joint "
    "rates.";
const char* kFloating =
    "The velocity of the COG is the mass-weighted mean of the velocities of all links, the root "
    "included. Relative to the base, this velocity is linear in the joint rates.";
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
    "by more than the error of the COG, because K > 1. While this error grows, the ZMP moves "
    "further, because D > 0. The paper prints the term with D with a wrong sign. A ZMP outside the "
    "support is replaced by the nearest point of the support, because the ground cannot push "
    "outside the feet.";
const char* kResolve =
    "There are many sets of joint rates that give the COG its reference velocity while the "
    "free foot and the trunk follow the plan. This equation selects the set nearest to the "
    "commanded rates, weighted with W. v is u - J_U cmd dtheta. The paper prints v with a wrong "
    "sign.";
const char* kTask =
    "There are many sets of joint rates that give the COG its reference velocity while the "
    "free foot and the trunk follow the plan. This equation describes the set that is nearest to "
    "the commanded rates, weighted with W. J_U and u contain both conditions. Equation (23) is the "
    "solution.";
const char* kJump =
    "Height law of the variable impedant pendulum: a spring and a damper act between the COG and "
    "its reference height. The gains of (25) hold the height without overshoot. The gains of (26) "
    "throw the robot z_H high from a stoop of depth z_d. The gains of (27) stop the robot within "
    "z_d after touchdown. The corrected (25) contains the mass: K_Dz^2 >= 4 m K_Pz.";
const char* kSynergy =
    "This is (22)(23) without commanded rates: the whole body follows only the COG.";

}  // namespace

double RunInstant::gain(const std::string& name) const {
  for (const auto& [key, value] : log.gains)
    if (key == name) return value;
  return 0;
}

const std::vector<Equation>& equations() {
  static const std::vector<Equation> all = [] {
    std::vector<Equation> list;
    const auto add = [&](int number, const char* formula, const char* words,
                         EquationNumbers (*numbers)(const RunInstant&)) {
      list.push_back({number, formula, words, numbers});
    };
    add(1, "dp = dp_0 - (R_0 0p) x w_0 + R_0 0dp", kTree, nullptr);
    add(2, "w_k = w_0 + R_0 0w_k", kTree, nullptr);
    add(3, "0w_k = 0J_wk dtheta", kTree, nullptr);
    add(4, "0dp = 0J dtheta", kTree, nullptr);
    add(5, "dp_G = dp_0 - (R_0 0p_G) x w_0 + R_0 0dp_G", kFloating, cog_numbers);
    add(6, "0dp_G = sum_{k>=1} m_k 0dp_Gk / sum_{k>=0} m_k", kFloating, cog_numbers);
    add(7, "0J_G = sum_{k>=1} m_k 0J_Gk / sum_{k>=0} m_k", kFloating, cog_numbers);
    add(8, "w_F = 0  <=>  w_0 = -R_0 0w_F", kAnchored, nullptr);
    add(9, "dp_F = 0  <=>  dp_0 = (R_0 0p_F) x w_0 - R_0 0dp_F", kAnchored, nullptr);
    add(10, "w_0 = -R_0 0J_wF dtheta", kAnchored, nullptr);
    add(11, "dp_0 = -R_0 (0p_F x (0J_wF dtheta) + 0J_F dtheta)", kAnchored, nullptr);
    add(12, "dp_G = R_0 (0J_G - 0J_F + [(0p_G - 0p_F) x] 0J_wF) dtheta", kCogJacobian, cog_numbers);
    add(13, "J_G = R_0 (0J_G - 0J_F + [(0p_G - 0p_F) x] 0J_wF)", kCogJacobian, cog_numbers);
    add(14, "ddx_G = w2 (x_G - x_Z)", kPendulum, pendulum_numbers);
    add(15, "ddy_G = w2 (y_G - y_Z)", kPendulum, pendulum_numbers);
    add(16, "ddz_G = f_z / m - g",
        "The vertical ground force carries the weight. The difference between the two accelerates "
        "the COG.",
        vertical_numbers);
    add(17, "w2 = f_z / (m (z_G - z_Z))",
        "w is the rate of the pendulum: a lower robot falls faster. Without a ground force, w has "
        "no meaning.",
        omega_numbers);
    add(18,
        "ref x_Z = cmd x_Z - K_x Delta x_G - D_x Delta dx_G, then the nearest point of the support",
        kLong, zmp_numbers);
    add(19,
        "ref y_Z = cmd y_Z - K_y Delta y_G - D_y Delta dy_G, then the nearest point of the support",
        kLong, zmp_numbers);
    add(20, "ref f_z = cmd f_z + m (K_z Delta z_G + D_z Delta dz_G), not below f_min",
        "This is the law for the height: the feet push harder when the COG is too low or sinks.",
        force_numbers);
    add(21, "Delta p_G = cmd p_G - p_G",
        "Delta is the command minus the measurement, in the frame of the foot on which the robot "
        "stands.",
        delta_numbers);
    add(22,
        "minimise 1/2 (cmd dtheta - ref dtheta)' W (cmd dtheta - ref dtheta)  subject to  "
        "J_G ref dtheta = ref dp_G,  J_C ref dtheta = c  <=>  J_U ref dtheta = u",
        kTask, resolution_numbers);
    add(23, "ref dtheta = cmd dtheta + W^-1 J_U' (J_U W^-1 J_U')^-1 v,  v = u - J_U cmd dtheta",
        kResolve, resolution_numbers);
    add(24, "ref f_z = K_Pz (ref z_G - z_G) + K_Dz (ref dz_G - dz_G) + m g", kJump, spring_numbers);
    add(25, "K_Pz > 0,  K_Dz > 0,  K_Dz^2 >= 4 m K_Pz", kJump, spring_numbers);
    add(26, "K_Dz = 0,  K_Pz = 2 m g z_H / z_d^2", kJump, spring_numbers);
    add(27, "K_Dz = 0,  K_Pz = m dz_G-^2 / z_d^2", kJump, spring_numbers);
    add(28, "minimise 1/2 ref dtheta' W ref dtheta  subject to  J_U ref dtheta = u", kSynergy,
        resolution_numbers);
    add(29, "ref dtheta = W^-1 J_U' (J_U W^-1 J_U')^-1 u", kSynergy, resolution_numbers);
    return list;
  }();
  return all;
}

}  // namespace ayumi::app
