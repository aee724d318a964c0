#include "ayumi/check/consistency.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/attribution.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/model/diagnose.hpp"

namespace ayumi {

namespace {

// Number of samples that one thread evaluates in a row. Chosen: they take a fraction of a
// millisecond, and a walk of some seconds occupies all cores.
constexpr int kBlockSamples = 256;
// Number of blocks that are evaluated before their samples are judged, and largest number of
// threads that evaluate them. Chosen: 4 s at 1 kHz, whose demands take about 2 MB. The next blocks
// use the same memory.
constexpr int kBlocksAtOnce = 16;

// The demands of a block of samples.
struct EvaluatedBlock {
  int first = 0;
  std::vector<SampleDynamics> demands;
  std::vector<const SupportPlane*> plane_of;  // by sample
  std::vector<char> known;                    // whether accelerations have a meaning, by sample
  std::deque<SupportPlane> planes;
};

JudgedSample judged_sample(const JudgedMotion& motion, const EvaluatedBlock& block, size_t i) {
  const int k = block.first + static_cast<int>(i);
  return {k, motion.series.samples[k], block.demands[i], *block.plane_of[i], block.known[i] != 0};
}

// Inverse dynamics of a block. Other blocks may be evaluated at the same time.
void evaluate(JudgedMotion& motion, int first, const SampleObserver& observe,
              EvaluatedBlock& block) {
  const int end = std::min(first + kBlockSamples, motion.count());
  block.first = first;
  block.demands.resize(static_cast<size_t>(end - first));
  block.plane_of.clear();
  block.known.clear();
  block.planes.clear();
  MotionDynamics dynamics = motion.dynamics;
  const auto contacts = [&](int k) {
    return std::pair(motion.plan.index[0][k], motion.plan.index[1][k]);
  };
  for (int k = first; k < end; ++k) {
    const auto i = static_cast<size_t>(k - first);
    block.demands[i] = dynamics.at(k);
    motion.cog[k] = dynamics.data().cog;
    if (k == first || contacts(k) != contacts(k - 1)) block.planes.push_back(dynamics.plane());
    block.plane_of.push_back(&block.planes.back());
    block.known.push_back(!motion.at_flight_edge(k));
    const JudgedSample sample = judged_sample(motion, block, i);
    for (const Limit* limit : limits())
      if (limit->note_sample) limit->note_sample(motion, sample, dynamics.data());
    if (observe) observe(sample, dynamics.data());
  }
}

// Samples are evaluated on several threads, and then judged in order of time.
void judge_samples(JudgedMotion& motion, int threads, const SampleObserver& observe) {
  std::vector<EvaluatedBlock> blocks;
  for (int begin = 0; begin < motion.count(); begin += kBlocksAtOnce * kBlockSamples) {
    const int count =
        std::min(kBlocksAtOnce, (motion.count() - begin + kBlockSamples - 1) / kBlockSamples);
    blocks.resize(static_cast<size_t>(count));
    std::atomic<bool> stop = false;
    in_parallel(blocks.size(), threads, stop, [&](size_t i) {
      evaluate(motion, begin + static_cast<int>(i) * kBlockSamples, observe, blocks[i]);
    });
    for (const EvaluatedBlock& block : blocks)
      for (size_t i = 0; i < block.demands.size(); ++i) {
        const JudgedSample sample = judged_sample(motion, block, i);
        for (const Limit* limit : limits())
          if (limit->judge_sample) limit->judge_sample(motion, sample);
      }
  }
}

// Judges the samples. At the same time, the limits that depend on the commands alone are computed;
// the limits that need the whole motion are computed afterwards.
void judge(JudgedMotion& motion, int threads, const SampleObserver& observe) {
  std::vector<const Limit*> ahead;
  for (const Limit* limit : limits())
    if (limit->look_ahead) ahead.push_back(limit);
  std::atomic<bool> stop = false;
  in_parallel(1 + ahead.size(), threads, stop, [&](size_t i) {
    if (i == 0)
      judge_samples(motion, threads, observe);
    else
      ahead[i - 1]->look_ahead(motion);
  });
  for (const Limit* limit : limits())
    if (limit->judge_motion) limit->judge_motion(motion);
}

// Where the acceleration has a kink, as beside a flight, single samples of the ZMP are outliers. A
// moment of up to kSpikeSize times the limit that lasts less than kSpikeTime is too short to turn
// the robot, so it becomes a warning. Source of both constants: docs/attribution.md.
constexpr double kSpikeTime = 0.005;  // longest time of a spike [s]
constexpr double kSpikeSize = 3;      // largest size of a spike, as a multiple of the limit

void excuse_spikes(const JudgedMotion& motion, std::vector<FindingWindow>& windows) {
  for (FindingWindow& w : windows) {
    const double lasts = (w.last - w.first + 1) * motion.series.dt;
    if (w.worst.kind == FindingKind::zmp_residual && lasts < kSpikeTime - 1e-9 &&
        w.worst.value <= kSpikeSize * w.worst.limit)
      w.worst.severity = Severity::warning;
  }
}

std::string place_text(const JudgedMotion& motion, const Violation& v) {
  return where_text(motion.model, spec_of(v.kind).place(motion, v));
}

Finding finding_of(const JudgedMotion& motion, const std::vector<FindingWindow>& windows,
                   const FindingWindow& window) {
  const Violation& v = window.worst;
  const FindingSpec& spec = spec_of(v.kind);
  const double dt = motion.series.dt;
  Finding f;
  f.kind = v.kind;
  f.severity = v.severity;
  f.begin = window.first * dt;
  f.end = window.last * dt;
  f.at = v.sample * dt;
  f.worst = v.value;
  f.limit = v.limit;
  f.unit = spec.finding_unit ? spec.finding_unit(motion, v) : spec.unit;
  f.place = spec.place(motion, v);
  f.where = place_text(motion, v);
  f.in_degrees = motion.degrees;
  const Advice advice = spec.advice(motion, window);
  f.action = advice.action;
  f.remedy = advice.remedy();
  f.hint = f.remedy + advice.or_repair;
  if (window.cause >= 0) {
    const Violation& cause = windows[window.cause].worst;
    f.cause = window.cause;
    f.follows_from = kind_and_place(cause.kind, place_text(motion, cause)) + " at " +
                     text::fixed(cause.sample * dt, 3) + " s";
    f.hint = f.remedy = "follows from " + f.follows_from + ": correct that finding first";
    f.action.clear();
  }
  return f;
}

// Sorts errors first, then by time, and updates the indices of the causes.
void sort_findings(std::vector<Finding>& findings) {
  std::vector<int> order(findings.size()), place(findings.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::tie(findings[a].severity, findings[a].begin) <
           std::tie(findings[b].severity, findings[b].begin);
  });
  std::vector<Finding> sorted;
  for (const int i : order) {
    place[i] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(findings[i]));
  }
  for (Finding& f : sorted)
    if (f.cause >= 0) f.cause = place[f.cause];
  findings = std::move(sorted);
}

ConsistencyReport report_of(JudgedMotion& motion) {
  std::vector<FindingWindow> windows = motion.windows.finish();
  excuse_spikes(motion, windows);
  mark_consequences(motion, windows);
  add_table_findings(motion, windows);
  ConsistencyReport report;
  report.profile = motion.limits.name;
  report.summary = motion.summary;
  // A smallest value that is not finite was computed at no sample, because nothing was near its
  // limit.
  for (const FindingSpec* spec : summary_figures())
    if (spec->figure.least && !std::isfinite(report.summary[spec->kind]))
      report.summary[spec->kind] = 0;
  // Without collision shapes on both legs, no clearance is known, and nothing was checked.
  double& clearance = report.summary[FindingKind::self_collision];
  if (motion.collisions.pairs().empty() ||
      (clearance >= 0 && !legs_have_collision_shapes(motion.model)))
    clearance = std::numeric_limits<double>::quiet_NaN();
  for (const FindingSpec* spec : summary_figures()) {
    const Violation& extreme = motion.extreme(spec->kind);
    if (extreme.sample >= 0 && !std::isnan(report.summary[spec->kind]))
      report.summary_at[spec->kind] = {place_text(motion, extreme),
                                       extreme.sample * motion.series.dt};
  }
  for (const FindingWindow& window : windows)
    report.findings.push_back(finding_of(motion, windows, window));
  sort_findings(report.findings);
  report.consistent = std::none_of(report.findings.begin(), report.findings.end(),
                                   [](const Finding& f) { return f.severity == Severity::error; });
  return report;
}

}  // namespace

const char* verdict_of(bool consistent) { return consistent ? "consistent" : "inconsistent"; }

ConsistencyReport check_consistency(const RobotModel& model, const CommandSeries& series,
                                    const CheckOptions& options, const SampleObserver& observe) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": the robot has no soles, so its "
                                   "contacts cannot be checked. Give /soles in the sidecar");
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern,
         "the motion has no samples, so there is nothing to check. Sample a pattern first");
  if (!(series.dt > 0)) fail(ErrorCode::usage, "the time step of the motion must be above 0 s");
  JudgedMotion motion(model, series, options);
  judge(motion, options.threads, observe);
  return report_of(motion);
}

bool has_limit(const RobotModel& model, FindingKind kind) {
  const auto is_stated = [](const Eigen::VectorXd& limits) {
    return limits.size() == 0 || limits.array().isFinite().any();
  };
  const ActuatorLimits& limits = model.limits();
  if (kind == FindingKind::joint_speed) return is_stated(limits.speed);
  if (kind == FindingKind::joint_torque) return is_stated(limits.peak_torque);
  return kind != FindingKind::continuous_torque || is_stated(limits.continuous_torque);
}

}  // namespace ayumi
