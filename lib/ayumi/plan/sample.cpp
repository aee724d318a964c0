#include "ayumi/plan/sample.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/plan/sample_job.hpp"
#include "ayumi/plan/viip_phases.hpp"

namespace ayumi {

namespace {

/// Largest number of samples. Chosen: more than an hour at 1 kHz; more would exhaust the memory.
constexpr double kMostSamples = 4e6;

int sample_count(const Pattern& pattern, double duration, double dt) {
  if (!(dt > 0) || !std::isfinite(dt))
    fail(ErrorCode::usage, "sampling step " + text::exact(dt) + " s must be above 0");
  const double steps = std::ceil(duration / dt - 1e-6);
  if (steps < 5 || steps > kMostSamples)
    fail(ErrorCode::bad_pattern, in_file(pattern, "phases") + ": " + text::exact(duration) +
                                     " s at a step of " + text::exact(dt) +
                                     " s is less than 5 or more than 4e6 samples");
  return static_cast<int>(steps) + 1;
}

CommandSeries sample_keys(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options, const Progress& progress) {
  const FootPlan feet(model, pattern);
  const InverseKinematics ik(model, default_posture(model, pattern));
  std::vector<bool> solved(model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) solved[dof] = ik.solves(dof);
  const PatternTracks tracks = read_tracks(model, pattern, feet, solved);
  const LinkPlan links(model, pattern, solved);
  const SampleJob job{
      model,           pattern, feet,       ik,
      tracks,          links,   options.dt, sample_count(pattern, feet.duration(), options.dt),
      options.threads, progress};
  CommandSeries series = tracks.joint_driven ? sample_joint_driven(job) : sample_body_driven(job);
  if (!links.empty()) series.origin[links.origin()] = "keys, by the joints of the limb";
  for (const auto& [t, weight] : tracks.weight)
    series.joint_weight.push_back({std::lround(t / options.dt), weight});
  return series;
}

}  // namespace

CommandSeries sample(const RobotModel& model, const Pattern& pattern, const SampleOptions& options,
                     const Progress& progress) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": the robot has no soles; add the left and the right sole to "
                                   "\"soles\" in its sidecar");
  require_repair_preferences(model, pattern);
  CommandSeries series;
  if (has_viip_phases(pattern)) {
    series = sample_keys(model, without_viip_phases(pattern), options, progress);
    series = with_viip_phases(model, pattern, series);
  } else {
    series = sample_keys(model, pattern, options, progress);
  }
  if (pattern.correction) series = apply_correction(model, series, *pattern.correction);
  report(progress, {"sample", 1.0, ""});
  return series;
}

}  // namespace ayumi
