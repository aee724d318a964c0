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
         "a motion of " + text::exact(duration) + " s with a sampling step of " + text::exact(dt) +
             " s has " + text::brief(steps) +
             " steps, but 5 to 4e6 steps are possible. Choose another step");
  return static_cast<int>(steps) + 1;
}

/// How legs and base are computed.
struct Solving {
  bool plan_alone = false;  ///< from feet and COG, in place of the keys and columns of the legs
  PlanLead lead = {};
};

/// Before the time `forgiven` [s], targets of hands and gaze may be out of reach between keys.
CommandSeries sample_posture(const RobotModel& model, const Pattern& pattern,
                             const SampleOptions& options, const Progress& progress,
                             const Solving& solving, double forgiven) {
  const FootPlan feet(model, pattern, solving.lead.flight_ramp);
  const InverseKinematics ik(model, default_posture(model, pattern));
  std::vector<bool> solved(model.dof_count());
  for (int dof = 0; dof < model.dof_count(); ++dof) solved[dof] = ik.solves(dof);
  PatternTracks tracks = read_tracks(model, pattern, feet, solved);
  if (solving.plan_alone) tracks.joint_driven = false;
  if (solving.lead.zmp) tracks.zmp = solving.lead.zmp;
  if (solving.lead.cog == PlannedCog::zmp) lead_by_zmp(feet, tracks);
  LinkPlan links(model, pattern, solved);
  links.forgive_before(forgiven);
  const SampleJob job{model,
                      pattern,
                      feet,
                      ik,
                      tracks,
                      links,
                      options.dt,
                      sample_count(pattern, feet.duration(), options.dt),
                      options.threads,
                      progress,
                      solving.plan_alone};
  CommandSeries series = tracks.joint_driven ? sample_joint_driven(job) : sample_body_driven(job);
  if (!links.empty())
    series.origin[links.origin()] = "computed from keys, by moving the joints of the limb";
  for (const auto& [t, weight] : tracks.weight)
    series.joint_weight.push_back({std::lround(t / options.dt), weight});
  return series;
}

CommandSeries sample_keys(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options, const Progress& progress,
                          const Solving& solving = {}) {
  try {
    return sample_posture(model, pattern, options, progress, solving, 0);
  } catch (const MissedOnTheWay& on_the_way) {
    // The place of the trunk at the time of the key is known only when the motion until then has
    // been solved.
    try {
      sample_posture(model, pattern, options, progress, solving, on_the_way.key_time());
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
                                   ": the robot has no soles. Add the left and the right sole to "
                                   "\"soles\" in its sidecar");
}

}  // namespace

CommandSeries sample_plan(const RobotModel& model, const Pattern& pattern,
                          const SampleOptions& options, const Progress& progress,
                          const PlanLead& lead) {
  require_soles(model);
  if (has_viip_phases(pattern))
    fail(ErrorCode::bad_pattern, in_file(pattern, "/phases"),
         "the feet have no plan in a phase with a VIIP goal, because "
         "VIIP chooses the footholds. Leave these phases out");
  Pattern plan = pattern;
  for (Keyframe& key : plan.keyframes) {
    key.hands.clear();
    key.gaze.reset();
  }
  return sample_keys(model, plan, options, progress, {.plan_alone = true, .lead = lead});
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
  report(progress, {"sampling", 1.0, ""});
  return series;
}

}  // namespace ayumi
