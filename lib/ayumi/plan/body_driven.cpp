#include <algorithm>
#include <cmath>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

std::string millimetres(double metres) {
  const double mm = 1e3 * metres;
  return text::fixed(mm, mm < 0.1 ? 3 : mm < 10 ? 2 : 1) + " mm";
}

VectorXd keyed_joints(const SampleJob& job, double t) {
  VectorXd theta(job.model.dof_count());
  for (int dof = 0; dof < job.model.dof_count(); ++dof)
    theta[dof] = job.tracks.joints[dof].at(t).value;
  return theta;
}

Eigen::Matrix3d trunk_attitude(const SampleJob& job, double t) {
  if (job.tracks.torso) {
    const auto& torso = *job.tracks.torso;
    return rpy_to_matrix({torso[0].at(t).value, torso[1].at(t).value, torso[2].at(t).value});
  }
  const Vector3d heading =
      job.feet.pose(Side::left, t).linear().col(0) + job.feet.pose(Side::right, t).linear().col(0);
  return rpy_to_matrix({0, 0, std::atan2(heading.y(), heading.x())});
}

namespace {

[[noreturn]] void complain_reach(const SampleJob& job, double t, const CommandSample& sample,
                                 const PostureSolution& solution) {
  const double ground = job.feet.ground(t);
  const std::string where = in_file(job.pattern, "phases/" + std::to_string(job.feet.phase(t))) +
                            ": t = " + text::fixed(t, 3) + " s: the " + name_of(solution.foot);
  if (job.ik.lacks_joints() && !solution.knee_flipped)
    fail(ErrorCode::bad_pattern,
         where + " foot is out of reach by " + millimetres(solution.missing) + ", of which " +
             millimetres(kLackingTolerance) +
             " are allowed because a leg has fewer than six joints; such legs cannot carry the COG "
             "farther aside over level soles: let the COG sway less, by shorter steps in time or a "
             "ZMP nearer to the other foot (new walk --zmp-inwards), or lower the COG height");
  const std::string remedy = "; lower the COG height (here " +
                             text::fixed(sample.cog.z() - ground, 4) + " m above the soles)" +
                             (job.tracks.torso ? ", tilt the torso less," : "") +
                             " or shorten the stride";
  if (solution.knee_flipped)
    fail(ErrorCode::bad_pattern, where + " knee would have to bend the wrong way" + remedy);
  const std::string limit =
      solution.at_limit < 0
          ? ""
          : ", with " + job.model.dofs()[solution.at_limit].name + " at its position limit";
  fail(ErrorCode::bad_pattern,
       where + " foot is out of reach by " + millimetres(solution.missing) + limit + remedy);
}

}  // namespace

PostureSolution solve_posture(const SampleJob& job, double t, const Eigen::Matrix3d& trunk,
                              CommandSample& sample, RobotData& data) {
  PostureTarget target;
  target.trunk = trunk;
  target.cog = sample.cog;
  for (const Side side : {Side::left, Side::right})
    target.feet[static_cast<int>(side)] = job.feet.pose(side, t);
  sample.feet = target.feet;
  sample.support = job.feet.support(t);
  for (int dof = 0; dof < job.model.dof_count(); ++dof)
    if (!job.ik.solves(dof)) sample.state.theta[dof] = job.tracks.joints[dof].at(t).value;
  const PostureSolution solution = job.ik.solve(target, sample.state, data);
  if (!solution.reached || solution.knee_flipped) complain_reach(job, t, sample, solution);
  return solution;
}

namespace {

// True when a track has keys inside the interval, as the parabola of a flight has.
bool is_ballistic(const Track& track, double begin, double end) {
  return std::any_of(track.keys().begin(), track.keys().end(), [&](const TrackKey& key) {
    return key.t > begin + 1e-9 && key.t < end - 1e-9;
  });
}

void require_body_tracks(const SampleJob& job) {
  for (size_t i = 0; i < job.feet.phases().size(); ++i) {
    const Phase& phase = job.feet.phases()[i];
    if (phase.support != Support::none) continue;
    const double begin = job.feet.begin(static_cast<int>(i));
    const std::string place = in_file(job.pattern, "phases/" + std::to_string(i));
    if (begin <= 0 || i + 1 == job.feet.phases().size())
      fail(ErrorCode::bad_pattern,
           place + ": a flight (support none) needs a phase on the ground before and after it");
    for (int axis = 0; axis < 3; ++axis) {
      const auto& track = job.tracks.cog[axis];
      if (axis < 2 && !track) continue;
      if (track && is_ballistic(*track, begin, phase.until)) continue;
      const std::string quantity = axis == 2 ? "the COG height" : axis == 0 ? "COG x" : "COG y";
      fail(ErrorCode::bad_pattern,
           place + ": in the flight from " + text::exact(begin) + " s to " +
               text::exact(phase.until) + " s the COG follows a parabola; give a key of " +
               quantity + " at lift-off and one at touchdown" +
               (track ? "" : ", and one on the ground before and one after the flight"));
    }
  }
}

// Lean [rad] and miss [m] of a motion that are worth a sentence. Chosen: what a person sees.
constexpr double kNotedLean = 1e-3, kNotedMiss = 1e-5;

// Largest figures of a motion by legs that lack joints.
struct Compromise {
  double miss = 0;  // of a sole [m]
  double lean = 0;  // of the trunk [rad]
};

Compromise solve_samples(const SampleJob& job, const CogPlan& plan, CommandSeries& series) {
  RobotData data(job.model);
  Compromise most;
  for (int k = 0; k < job.count; ++k) {
    if (k % 256 == 0) report(job.progress, {"sample", static_cast<double>(k) / job.count, ""});
    const double t = k * job.dt;
    CommandSample& sample = series.samples[k];
    sample.state = k > 0 ? series.samples[k - 1].state : job.model.rest_state();
    if (k == 0) sample.state.theta = job.ik.start();
    sample.cog = {plan.cog[0].at(t).value, plan.cog[1].at(t).value, plan.cog[2].at(t).value};
    if (k > 0) sample.state.base.position += sample.cog - series.samples[k - 1].cog;
    const PostureSolution solution = solve_posture(job, t, plan.trunk_at(job, t), sample, data);
    most.miss = std::max(most.miss, solution.missing);
    most.lean = std::max(most.lean, solution.lean);
  }
  fill_rates(series.samples, job.dt, job.tracks.rest_ends);
  return most;
}

// Fills commanded ZMP and f_z; returns the largest ZMP error of the full model in the solved axes.
double fill_ground(const SampleJob& job, const CogPlan& plan, CommandSeries& series) {
  RobotData data(job.model);
  double worst = 0;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    CommandSample& sample = series.samples[k];
    sample.zmp = plan.zmp_at(t);
    sample.fz = job.tracks.fz ? job.tracks.fz->at(t).value
                              : job.model.mass() * (sample.ddcog.z() + kGravity);
    if (sample.support == Support::none && !job.tracks.fz) sample.fz = 0;
    if (sample.support == Support::none) continue;
    const GroundReaction reaction = full_model_reaction(job.model, sample, data);
    const Vector3d full = reaction.zmp;
    const bool weak = reaction.force.z() < kZmpShare * job.model.mass() * kGravity;
    for (int axis = 0; axis < 2; ++axis) {
      if (plan.solved[axis] && weak) continue;
      if (plan.solved[axis])
        worst = std::max(worst, std::abs(full[axis] - sample.zmp[axis]));
      else if (!job.tracks.zmp)
        sample.zmp[axis] = full[axis];
    }
  }
  return worst;
}

void describe(const SampleJob& job, const CogPlan& plan, double worst, const Compromise& most,
              CommandSeries& series) {
  auto& origin = series.origin;
  const bool any = plan.solved[0] || plan.solved[1];
  const bool both = plan.solved[0] && plan.solved[1];
  const std::string axes = both ? "" : plan.solved[0] ? " in x" : " in y";
  const std::string source = job.tracks.zmp ? "the ZMP keys" : "the ZMP of the phases";
  if (any) {
    const std::string solved =
        "solved" + axes + " from " + source +
        (job.pattern.full_model ? " for the full model" : " by the point-mass law (14)(15)") +
        " (worst ZMP error " + millimetres(worst) + ")";
    origin["cog"] = both ? solved : "keys; " + solved;
  }
  if (!job.tracks.zmp)
    origin["zmp"] = any ? "centres of the supporting soles, from the phases" : "of the full model";
  if (!job.tracks.zmp && any && !both) origin["zmp"] += "; of the full model where COG is keyed";
  const double moved =
      std::max(plan.bump[0].cwiseAbs().maxCoeff(), plan.bump[1].cwiseAbs().maxCoeff()) * 4 *
      std::exp(-2.0);
  if (moved > 5e-5)
    origin["zmp"] += ", moved by up to " + millimetres(moved) +
                     " near the ends so that the motion starts and stops at rest";
  origin["cog_height"] = job.tracks.cog[2] ? "keys" : "level, from the defaults";
  if (!job.tracks.fz) origin["fz"] = "computed from the COG height, equation (16)";
  origin["torso"] = job.tracks.torso ? "keys" : "level, along the mean heading of the feet";
  if (flies(job)) {
    origin["cog_height"] += "; parabolas in flight";
    if (!job.tracks.torso)
      origin["torso"] += ", turned around flights so that they have no angular momentum";
  }
  origin["feet"] = "phases and swings";
  origin["base"] = "solved from feet, torso and COG";
  if (job.ik.lacks_joints() && (most.lean > kNotedLean || most.miss > kNotedMiss)) {
    const size_t joints = std::min(job.ik.leg(Side::left).size(), job.ik.leg(Side::right).size());
    origin["legs"] =
        "a leg has " + std::to_string(joints) +
        (job.ik.coupled().empty() ? " joints, not six,"
                                  : " joints of its own and one that moves both legs, not six,") +
        " and cannot place a level sole anywhere: the trunk leans by up to " +
        text::fixed(most.lean * 180 / std::numbers::pi, 1) +
        " deg, and soles miss their places by up to " + millimetres(most.miss) + " (allowed " +
        millimetres(kLackingTolerance) + ")";
  }
  origin["joints"] = "legs by inverse kinematics, others from keys and default posture";
}

}  // namespace

bool flies(const SampleJob& job) {
  return std::any_of(job.feet.phases().begin(), job.feet.phases().end(),
                     [](const Phase& phase) { return phase.support == Support::none; });
}

CommandSeries sample_body_driven(const SampleJob& job) {
  require_body_tracks(job);
  CommandSeries series;
  series.dt = job.dt;
  series.samples.resize(job.count);
  series.origin = job.tracks.origin;
  const CogPlan plan = plan_cog(job);
  const Compromise most = solve_samples(job, plan, series);
  const double worst = fill_ground(job, plan, series);
  describe(job, plan, worst, most, series);
  return series;
}

}  // namespace ayumi
