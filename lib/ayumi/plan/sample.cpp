#include "ayumi/plan/sample.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/repair_preferences.hpp"
#include "ayumi/plan/sample_job.hpp"
#include "ayumi/plan/sample_plan.hpp"
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
    fail(ErrorCode::bad_pattern, in_file(pattern, "/phases"),
         text::exact(duration) + " s at a step of " + text::exact(dt) + " s give " +
             text::brief(steps) + " steps, but only 5 to 4e6 are possible; choose another step");
  return static_cast<int>(steps) + 1;
}

// The plan, with the default posture moved along with the COG.
CommandSeries sample_carried(const SampleJob& job) {
  require_body_tracks(job);
  CommandSeries series;
  series.dt = job.dt;
  series.samples.resize(static_cast<size_t>(job.count));
  series.origin = job.tracks.origin;
  const CogPlan plan = plan_cog(job);
  const Eigen::VectorXd posture = default_posture(job.model, job.pattern);
  RobotData data = job.data;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    CommandSample& sample = series.samples[static_cast<size_t>(k)];
    sample.state = job.model.rest_state();
    sample.state.theta = posture;
    put_plan(job, t, sample);
    sample.state.base.attitude =
        Eigen::Quaterniond(plan.turned(t, trunk_attitude(job, t, sample.feet)));
    if (k > 0 && sample.state.base.attitude.dot(
                     series.samples[static_cast<size_t>(k - 1)].state.base.attitude) < 0)
      sample.state.base.attitude.coeffs() *= -1;
    sample.cog = plan.cog_at(t);
    update_positions(job.model, sample.state, data);
    sample.state.base.position = sample.cog - data.cog_offset;
  }
  fill_rates(series.samples, job.dt, true);
  for (int k = 0; k < job.count; ++k)
    put_ground_commands(job, plan, k * job.dt, series.samples[static_cast<size_t>(k)]);
  series.origin["joints"] = "the default posture at all times; the base moves with the COG";
  return series;
}

enum class Posture { solved, carried };

/// Before the time `forgiven` [s], targets of hands and gaze may be out of reach between keys.
CommandSeries sample_posture(const RobotModel& model, const Pattern& pattern,
                             const SampleOptions& options, const Progress& progress,
                             Posture posture, double forgiven) {
  const FootPlan feet(model, pattern);
  const InverseKinematics ik(model, default_posture(model, pattern));
  std::vector<bool> solved(model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) solved[dof] = ik.solves(dof);
  const PatternTracks tracks = read_tracks(model, pattern, feet, solved);
  LinkPlan links(model, pattern, solved);
  links.forgive_before(forgiven);
  const SampleJob job{
      model,           pattern, feet,       ik,
      tracks,          links,   options.dt, sample_count(pattern, feet.duration(), options.dt),
      options.threads, progress};
  CommandSeries series = posture == Posture::carried ? sample_carried(job)
                         : tracks.joint_driven       ? sample_joint_driven(job)
                                                     : sample_body_driven(job);
  if (!links.empty() && posture == Posture::solved)
    series.origin[links.origin()] = "solved from keys by the joints of the limb";
  for (const auto& [t, weight] : tracks.weight)
    series.joint_weight.push_back({std::lround(t / options.dt), weight});
  return series;
}

CommandSeries sample_keys(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options, const Progress& progress,
                          Posture posture = Posture::solved) {
  try {
    return sample_posture(model, pattern, options, progress, posture, 0);
  } catch (const MissedOnTheWay& on_the_way) {
    // The place of the trunk at the time of the key is known only when the motion until then has
    // been solved.
    try {
      sample_posture(model, pattern, options, progress, posture, on_the_way.key_time());
    } catch (const MissedOnTheWay&) {  // a later key is out of reach: the first message is kept
    } catch (const Error& at_key) {
      const bool same = at_key.place().inside == on_the_way.place().inside;
      if (same || at_key.code() != ErrorCode::bad_pattern) throw;
    }
    throw;
  }
}

void require_soles(const RobotModel& model) {
  if (!model.has_soles())
    fail(ErrorCode::bad_model, model.name() +
                                   ": the robot has no soles; add the left and the right sole to "
                                   "\"soles\" in its sidecar");
}

}  // namespace

CommandSeries sample_plan(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options, const Progress& progress) {
  require_soles(model);
  if (has_viip_phases(pattern))
    fail(ErrorCode::bad_pattern, in_file(pattern, "/phases"),
         "the feet have no plan in a phase with a VIIP goal, because "
         "VIIP chooses the footholds; leave these phases out");
  Pattern plan = pattern;
  plan.full_model = false;
  return sample_keys(model, plan, options, progress, Posture::carried);
}

CommandSeries sample(const RobotModel& model, const Pattern& pattern, const SampleOptions& options,
                     const Progress& progress) {
  require_soles(model);
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
