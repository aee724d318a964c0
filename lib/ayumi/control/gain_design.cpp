// All quantities are deviations from the plan; body and reference are those of control/stance_loop:
//   per tick, from measurements n ticks old:
//   zf += f (zZ - zf),  gap = zf - K x - D dx - zd,  zd += dt w / Tw gap
//   dxr += dt (ka w2 gap + damp w (dx - dxr) - ks^2 w2 xr - 2 kd w dxr),  xr += dt dxr
// Poles are log(eigenvalue) / tick. The measured zZ belongs to the target of the previous tick, as
// in the simulator.
#include "ayumi/control/gain_design.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/eigenvalues.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;

namespace {

MatrixXd tick_matrix(const LoopModel& loop, const DtadParams& p) {
  const double w = std::sqrt(kGravity / loop.height), w2 = w * w, dt = loop.tick;
  const double K = long_term_k(p), D = long_term_d(p) / w;
  const int delay = static_cast<int>(std::lround(loop.delay / dt));
  const auto body = static_cast<int>(loop.body.rows());
  const int xr = body, dxr = body + 1, filtered = body + 2, offset = body + 3;
  // Delayed (x, dx, zZ) follow, the newest first.
  const int fixed = body + 4, n = fixed + 3 * delay;
  const auto unit = [&](int i) { return RowVectorXd(RowVectorXd::Unit(n, i)); };
  const auto of_body = [&](const RowVectorXd& row) {
    RowVectorXd all = RowVectorXd::Zero(n);
    all.head(body) = row;
    return all;
  };

  RowVectorXd x = of_body(loop.cog), dx = of_body(loop.dcog), zmp = of_body(loop.zmp);
  zmp[xr] += loop.zmp_reference[0];
  zmp[dxr] += loop.zmp_reference[1];
  MatrixXd A = MatrixXd::Zero(n, n);
  if (delay > 0) {
    A.row(fixed) = x;
    A.row(fixed + 1) = dx;
    A.row(fixed + 2) = zmp;
    for (int i = fixed + 3; i < n; ++i) A.row(i) = unit(i - 3);
    x = unit(n - 3);
    dx = unit(n - 2);
    zmp = unit(n - 1);
  }
  const double filter = 1 - elementary::exp(-dt * w / p.zmp_filter);
  A.row(filtered) = unit(filtered) + filter * (zmp - unit(filtered));
  const RowVectorXd gap = A.row(filtered) - K * x - D * dx - unit(offset);
  A.row(offset) = unit(offset);
  if (p.offset_time > 0) A.row(offset) += dt * w / p.offset_time * gap;
  // The law uses the difference before the offset is updated in this tick.
  A.row(dxr) = unit(dxr) + dt * (p.zmp_gain * w2 * gap + p.rocking_damping * w * (dx - unit(dxr)) -
                                 p.pull_rate * p.pull_rate * w2 * unit(xr) -
                                 2 * p.pull_damping * w * unit(dxr));
  A.row(xr) = unit(xr) + dt * A.row(dxr);
  A.topLeftCorner(body, body) = loop.body;
  A.topRows(body) += loop.reference * A.middleRows(xr, 2);
  return A;
}

}  // namespace

LoopAnalysis analyze_loop(const LoopModel& loop, const DtadParams& params) {
  const std::optional<Eigen::VectorXcd> values = eigenvalues(tick_matrix(loop, params));
  LoopAnalysis analysis;
  if (!values) {  // the numbers of the loop are too large: it has no pole that could be computed
    analysis.decay = -INFINITY;
    return analysis;
  }
  for (const std::complex<double>& value : *values)
    if (std::abs(value) > 1e-9) analysis.poles.push_back(std::log(value) / loop.tick);
  // Without a time constant of the offset, its state is constant and gives no mode.
  if (params.offset_time <= 0)
    std::erase_if(analysis.poles, [](const auto& pole) { return std::abs(pole) < 1e-6; });
  std::sort(analysis.poles.begin(), analysis.poles.end(), [](const auto& a, const auto& b) {
    return a.real() != b.real() ? a.real() > b.real() : a.imag() > b.imag();
  });
  if (analysis.poles.empty()) {  // every error is gone after one tick
    analysis.decay = INFINITY;
    analysis.stable = true;
    return analysis;
  }
  analysis.decay = -analysis.poles.front().real();
  analysis.frequency = std::abs(analysis.poles.front().imag()) / (2 * M_PI);
  analysis.stable = analysis.decay > -loop.tolerated_growth;
  return analysis;
}

DtadParams gains_from_poles(std::complex<double> p1, std::complex<double> p2, DtadParams params) {
  const std::complex<double> sum = p1 + p2, product = p1 * p2;
  if (std::abs(sum.imag()) > 1e-9 || std::abs(product.imag()) > 1e-9)
    fail(ErrorCode::usage, "poles: give two real poles or a conjugate pair");
  if (p1.real() >= 0 || p2.real() >= 0)
    fail(ErrorCode::usage, "poles: the real part " + text::brief(std::max(p1.real(), p2.real())) +
                               " is not below 0, so the COG would never come back");
  params.k = 1 + product.real();  // ddx = w2 (x - K x - D dx)
  params.d = -sum.real();
  return params;
}

DtadParams design_gains(double omega, const GainWishes& wishes, DtadParams params) {
  const auto refuse = [](const std::string& what, double value, const std::string& why) {
    fail(ErrorCode::usage, what + " " + text::brief(value) + " is not possible: " + why);
  };
  if (wishes.poles) {
    const auto& [p1, p2] = *wishes.poles;
    const double right = p1.real() < 0 ? p2.real() : p1.real();
    if (!(p1.real() < 0 && p2.real() < 0))
      refuse("a pole with the real part", right,
             "the real part must be below 0, because otherwise the COG never comes back");
    params = gains_from_poles(p1 / omega, p2 / omega, params);
  }
  if (wishes.absorb) {
    if (!(*wishes.absorb >= 0 && *wishes.absorb < 1))
      refuse("a short-term absorption of", *wishes.absorb,
             "the absorption must be at least 0 and below 1");
    params.zmp_gain = *wishes.absorb / (1 - *wishes.absorb);
  }
  if (wishes.return_time) {
    if (!(*wishes.return_time > 0))
      refuse("a return time of", *wishes.return_time, "the time must be above 0 s");
    params.pull_rate = params.pull_damping = 1 / (omega * *wishes.return_time);
  }
  if (wishes.zmp_filter) {
    if (!(*wishes.zmp_filter > 0))
      refuse("a ZMP filter time of", *wishes.zmp_filter, "the time must be above 0 s");
    params.zmp_filter = omega * *wishes.zmp_filter;
  }
  if (wishes.forget) {
    if (!(*wishes.forget >= 0))
      refuse("a forgetting time of", *wishes.forget, "the time must be at least 0 s");
    params.offset_time = omega * *wishes.forget;
  }
  for (const auto& [name, value] : {std::pair("k", params.k.value_or(0)),
                                    {"d", params.d.value_or(0)},
                                    {"ka", params.zmp_gain},
                                    {"ks", params.pull_rate},
                                    {"kd", params.pull_damping},
                                    {"tau_z", params.zmp_filter},
                                    {"washout", params.offset_time}})
    if (const std::string reason = gain_out_of_range(name, value); !reason.empty())
      fail(ErrorCode::usage, "the wishes need a gain that is not possible: " + reason);
  return params;
}

WeakestLoop weakest_loop(const std::vector<LoopModel>& loops, const DtadParams& params) {
  WeakestLoop weakest;
  double least = 0;
  for (size_t i = 0; i < loops.size(); ++i) {
    LoopAnalysis analysis = analyze_loop(loops[i], params);
    const double margin = analysis.decay + loops[i].tolerated_growth;
    if (i == 0 || margin < least) weakest = {i, std::move(analysis)}, least = margin;
  }
  return weakest;
}

// Largest stable ka below the first unstable one. Assumed: as ka grows, the loop becomes unstable
// only once.
double largest_stable_ka(const std::vector<LoopModel>& loops, DtadParams params, double most) {
  const auto stable = [&](double ka) {
    params.zmp_gain = ka;
    return weakest_loop(loops, params).analysis.stable;
  };
  if (stable(most)) return most;
  double low = 0, high = most;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

namespace {

// Largest time constant of the slowest mode with which a loop is accepted, as a multiple of
// 1/omega. Chosen: three times the time constant of the default gains' slowest mode on stiff
// servos, in which offsets decay (washout, 6.6). With half of it, the gains of soft servos change
// more; with twice, slower modes are accepted.
constexpr double kSlowestDecay = 20;
// Largest number of changes of the gains together. Chosen: it allows the three largest changes of
// one gain, or one step of three gains; there are 33 choices, and each unstable one costs the
// analysis of one loop.
constexpr size_t kMostSteps = 3;

struct LoopGain {
  std::vector<std::pair<const char*, double DtadParams::*>> fields;
  std::vector<double> factors;  ///< factors on the gain, the one nearest to 1 first
};

// The gains that are changed, with their factors. Chosen: each step multiplies the pull, which
// helps most on soft servos, by 4/3; the other gains change by factors of 2, and the filter by
// about 3.
const std::vector<LoopGain>& loop_gains() {
  static const std::vector<LoopGain> gains = {
      {{{"ks", &DtadParams::pull_rate}, {"kd", &DtadParams::pull_damping}},
       {1, 4.0 / 3, 16.0 / 9, 64.0 / 27}},
      {{{"damp", &DtadParams::rocking_damping}}, {1, 0.5, 0.25, 2}},
      {{{"ka", &DtadParams::zmp_gain}}, {1, 0.5, 2, 0.25}},
      {{{"tau_z", &DtadParams::zmp_filter}}, {1, 3, 10}}};
  return gains;
}

// Combinations of indices into the lists of factors with at most kMostSteps steps in total, ordered
// by the number of steps.
std::vector<std::vector<size_t>> nearest_choices() {
  std::vector<std::vector<size_t>> all = {{}};
  for (const LoopGain& gain : loop_gains()) {
    std::vector<std::vector<size_t>> longer;
    for (const auto& places : all)
      for (size_t i = 0; i < gain.factors.size(); ++i) {
        longer.push_back(places);
        longer.back().push_back(i);
      }
    all = std::move(longer);
  }
  const auto steps = [](const auto& v) { return std::accumulate(v.begin(), v.end(), size_t{0}); };
  std::erase_if(all, [&](const auto& v) { return steps(v) > kMostSteps; });
  std::stable_sort(all.begin(), all.end(),
                   [&](const auto& a, const auto& b) { return steps(a) < steps(b); });
  return all;
}

}  // namespace

std::optional<DtadParams> nearest_stable_gains(const std::vector<LoopModel>& loops,
                                               const DtadParams& params) {
  std::optional<DtadParams> best;
  double quickest = 0;
  size_t worst = 0;  // the loop in which the previous choice was unstable; it is examined first
  for (const std::vector<size_t>& places : nearest_choices()) {
    DtadParams choice = params;
    for (size_t i = 0; i < places.size(); ++i)
      for (const auto& [name, field] : loop_gains()[i].fields)
        if (places[i] > 0)  // gains are rounded to whole hundredths
          choice.*field =
              std::round(100 * choice.*field * loop_gains()[i].factors[places[i]]) / 100;
    double margin = INFINITY;
    for (size_t i = 0; i < loops.size() && margin > quickest; ++i) {
      const size_t at = i == 0 ? worst : i <= worst ? i - 1 : i;
      const double decay = analyze_loop(loops[at], choice).decay + loops[at].tolerated_growth;
      if (decay < margin) margin = decay;
      if (margin <= 0) worst = at;
    }
    if (margin <= quickest) continue;
    best = choice;
    quickest = margin;
    if (margin * kSlowestDecay >= std::sqrt(kGravity / loops.front().height)) break;
  }
  return best;
}

std::vector<std::pair<std::string, double>> changed_loop_gains(const DtadParams& params,
                                                               const DtadParams& other) {
  std::vector<std::pair<std::string, double>> changed;
  for (const LoopGain& gain : loop_gains())
    for (const auto& [name, field] : gain.fields)
      if (params.*field != other.*field) changed.emplace_back(name, params.*field);
  return changed;
}

namespace {

std::string gains_in_words(const std::vector<std::pair<std::string, double>>& gains) {
  std::vector<std::string> words;
  for (const auto& [name, value] : gains) words.push_back(name + " = " + text::brief(value));
  return text::join(words, ", ");
}

// Finds a change of gains with which an unstable loop becomes stable.
std::string remedy(const std::vector<LoopModel>& loops, const DtadParams& params) {
  const double low = largest_stable_ka(loops, params, params.zmp_gain);
  if (low > 1e-6)
    return "Choose ka below " + text::fixed(low, 2) + ", for which the loop is stable";
  if (const auto stable = nearest_stable_gains(loops, params))
    return "Choose " + gains_in_words(changed_loop_gains(*stable, params)) +
           ", for which the loop is stable";
  return "The loop is unstable for every ka and for all ks, kd, damp and tau_z that were tried. "
         "The servos are too soft for this robot. Use stiffer servos";
}

// Support and direction of a loop in words.
std::string oscillation(const LoopModel& loop) {
  return std::string("With ") + (loop.both_feet ? "both feet" : "one foot") +
         " on the ground, the robot oscillates " +
         (loop.sideways ? "sideways" : "forwards and backwards");
}

/// The growth of the loop's errors in words; empty if the loop is stable.
std::string growth(const std::vector<LoopModel>& loops, const DtadParams& params) {
  const WeakestLoop weakest = weakest_loop(loops, params);
  if (weakest.analysis.stable) return {};
  const LoopModel& loop = loops[weakest.index];
  return "controller gains: the loop is unstable with ka = " + text::brief(params.zmp_gain) +
         ", tau_z = " + text::brief(params.zmp_filter) + " and sensors and servos that are " +
         text::brief(1e3 * loop.delay) + " ms late. " + oscillation(loop) + " at " +
         text::fixed(weakest.analysis.frequency, 1) +
         " Hz, and an error grows by the factor e in " +
         text::brief(-1 / weakest.analysis.decay, 2) + " s. " + remedy(loops, params);
}

}  // namespace

void refuse_unstable(const std::vector<LoopModel>& loops, const DtadParams& params) {
  const std::string reason = growth(loops, params);
  if (!reason.empty()) fail(ErrorCode::usage, reason);
}

std::string instability(const RobotModel& model, const ActuatorLimits& actuators,
                        const ControllerSpec& spec, double height, double tick) {
  if (spec.type != ControllerKind::dtad) return {};
  const DtadParams params = dtad_params(model, spec);
  if (params.as_printed != 0) return {};
  for (Side side : {Side::left, Side::right})
    for (const int joint : model.leg(side))
      if (actuators.servo[static_cast<size_t>(joint)].kp <= 0) return {};
  return growth(stance_loops(model, actuators, height, tick), params);
}

}  // namespace ayumi
