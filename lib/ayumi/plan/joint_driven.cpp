// The base follows from the anchor, the foot that supports the robot; in double support the last
// anchor remains. A new anchor stays at its present place, so the base moves continuously.
#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr std::array<Side, 2> kBothSides = {Side::left, Side::right};

// Largest number of rounds for a head whose eye moves when the head turns, and the change of a
// joint at which they end [rad]. Chosen: the same values as in plan/body_driven.
constexpr int kMostGazeRounds = 30;
constexpr double kSameGaze = 1e-11;

// The anchor of the first double support is the foot of the first single support.
Side first_anchor(const FootPlan& feet) {
  for (const Phase& phase : feet.phases()) {
    if (phase.support == Support::left) return Side::left;
    if (phase.support == Support::right) return Side::right;
  }
  return Side::left;
}

void refuse_flight(const SampleJob& job) {
  for (size_t i = 0; i < job.feet.phases().size(); ++i)
    if (job.feet.phases()[i].support == Support::none)
      fail(ErrorCode::bad_pattern, place_of_phase(job.pattern, i),
           "in a flight phase (support none), no foot is on the ground, and joint keys alone do "
           "not determine the place of the base. Give a table with base columns");
}

void anchor_samples(const SampleJob& job, CommandSeries& series) {
  refuse_flight(job);
  RobotData data = job.data;
  Side anchor = first_anchor(job.feet);
  Isometry3d held = job.feet.pose(anchor, 0);
  for (int k = 0; k < job.count; ++k) {
    CommandSample& sample = series.samples[k];
    const double t = k * job.dt;
    if (!supports(job.feet.support(t), anchor)) {
      anchor = other(anchor);
      // The new anchor stays where it was in the previous sample.
      if (k > 0) {
        update_positions(job.model, series.samples[k - 1].state, data);
        held = sole_pose(job.model, data, anchor);
      } else {
        held = job.feet.pose(anchor, 0);
      }
    }
    anchor_base(job.model, anchor, held, sample.state, data);
    if (k > 0 && sample.state.base.attitude.dot(series.samples[k - 1].state.base.attitude) < 0)
      sample.state.base.attitude.coeffs() *= -1;
    sample.cog = data.cog;
  }
  series.origin["base"] = "computed from the foot that carries the robot";
}

void table_base(const SampleJob& job, CommandSeries& series) {
  RobotData data = job.data;
  const auto& p = *job.tracks.base;
  const auto& q = *job.tracks.attitude;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    RobotState& state = series.samples[k].state;
    state.base.position = {p[0].at(t).value, p[1].at(t).value, p[2].at(t).value};
    state.base.attitude =
        Eigen::Quaterniond(q[0].at(t).value, q[1].at(t).value, q[2].at(t).value, q[3].at(t).value)
            .normalized();
    update_positions(job.model, state, data);
    series.samples[k].cog = data.cog;
  }
}

// Place of a foot from sample `first` to `last`: the median of its places according to the joints.
// A late landing or a slip during less than half of the time does not change the median.
Isometry3d median_sole(const std::vector<Isometry3d>& soles, int first, int last) {
  const int n = last - first + 1;
  std::array<std::vector<double>, 6> values;
  const Eigen::Quaterniond turn(soles[first].linear());
  for (int k = first; k <= last; ++k) {
    const Vector3d away = log_rotation(Eigen::Quaterniond(soles[k].linear()) * turn.conjugate());
    for (int i = 0; i < 3; ++i) {
      values[i].push_back(soles[k].translation()[i]);
      values[3 + i].push_back(away[i]);
    }
  }
  std::array<double, 6> median;
  for (int i = 0; i < 6; ++i) {
    std::nth_element(values[i].begin(), values[i].begin() + n / 2, values[i].end());
    median[i] = values[i][n / 2];
  }
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(median[0], median[1], median[2]);
  pose.linear() =
      (exp_rotation(Vector3d(median[3], median[4], median[5])) * turn).toRotationMatrix();
  return pose;
}

// If a sole is at the same place at the beginning and at the end of its contact, it stands there.
// Otherwise the median counts.
Isometry3d place_of(const std::vector<Isometry3d>& soles, int first, int last) {
  // Largest difference of two places [m], and of entries of their rotations. Chosen: the rounding
  // of tables. No measured case changes between half and twice the value (constants.md).
  constexpr double kSame = 1e-5;
  const Eigen::Matrix4d change = soles[last].matrix() - soles[first].matrix();
  if (change.cwiseAbs().maxCoeff() < kSame) return soles[first];
  return median_sole(soles, first, last);
}

void fill_feet_from_joints(CommandSeries& series, const RobotModel& model) {
  const int count = static_cast<int>(series.samples.size());
  RobotData data(model);
  std::array<std::vector<Isometry3d>, 2> soles;
  for (const CommandSample& sample : series.samples) {
    update_positions(model, sample.state, data);
    for (const Side side : kBothSides)
      soles[static_cast<int>(side)].push_back(sole_pose(model, data, side));
  }
  for (const Side side : kBothSides) {
    const auto carries = [&](int k) { return supports(series.samples[k].support, side); };
    const std::vector<Isometry3d>& own = soles[static_cast<int>(side)];
    for (int k = 0; k < count;) {
      int last = k;
      while (carries(k) && last + 1 < count && carries(last + 1)) ++last;
      const Isometry3d pose = carries(k) ? place_of(own, k, last) : own[k];
      for (; k <= last; ++k) series.samples[k].feet[static_cast<int>(side)] = pose;
    }
  }
}

// Planned soles: according to the phases if there are swings or foot keys, otherwise according to
// the joints.
void fill_feet(const SampleJob& job, CommandSeries& series) {
  const Pattern& pattern = job.pattern;
  const bool planned = std::any_of(pattern.phases.begin(), pattern.phases.end(),
                                   [](const Phase& phase) { return phase.swing.has_value(); }) ||
                       std::any_of(pattern.keyframes.begin(), pattern.keyframes.end(),
                                   [](const Keyframe& key) { return key.feet[0] || key.feet[1]; });
  series.origin["feet"] = planned ? "phases and swings" : "computed from the joint angles";
  for (int k = 0; k < job.count; ++k) {
    CommandSample& sample = series.samples[k];
    sample.support = job.feet.support(k * job.dt);
    if (!planned) continue;
    for (const Side side : kBothSides)
      sample.feet[static_cast<int>(side)] = job.feet.pose(side, k * job.dt);
  }
  if (!planned) fill_feet_from_joints(series, job.model);
}

void fill_commands(const SampleJob& job, CommandSeries& series) {
  RobotData data = job.data;
  const PatternTracks& tracks = job.tracks;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    CommandSample& sample = series.samples[k];
    sample.zmp.setZero();
    for (const Side side : kBothSides)
      if (supports(sample.support, side) || sample.support == Support::none)
        sample.zmp.z() +=
            (sample.support == Support::left || sample.support == Support::right ? 1.0 : 0.5) *
            sample.feet[static_cast<int>(side)].translation().z();
    if (tracks.zmp) sample.zmp.z() = (*tracks.zmp)[2].at(t).value;
    const GroundReaction full = full_model_reaction(job.model, sample, data);
    sample.zmp = full.zmp;
    sample.fz = full.force.z();
    if (tracks.zmp)
      for (int i = 0; i < 3; ++i) sample.zmp[i] = (*tracks.zmp)[i].at(t).value;
    if (tracks.fz) sample.fz = tracks.fz->at(t).value;
    for (int i = 0; i < 3; ++i) {
      if (!tracks.cog[i]) continue;
      const TrackPoint point = tracks.cog[i]->at(t);
      sample.cog[i] = point.value;
      sample.dcog[i] = point.rate;
      sample.ddcog[i] = point.acceleration;
    }
  }
}

// The base does not depend on arms and head, but the COG does.
void follow_targets(const SampleJob& job, CommandSeries& series) {
  RobotData data = job.data;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    if (!job.links.leads(t)) continue;
    CommandSample& sample = series.samples[k];
    const Eigen::VectorXd keyed = sample.state.theta;
    if (k > 0)
      for (int dof = 0; dof < job.model.dof_count(); ++dof)
        if (job.links.leads(dof, t))
          sample.state.theta[dof] = series.samples[k - 1].state.theta[dof];
    for (int round = 0; round < kMostGazeRounds; ++round)
      if (job.links.solve(t, keyed, sample.state, data) < kSameGaze) break;
    update_positions(job.model, sample.state, data);
    sample.cog = data.cog;
  }
}

}  // namespace

CommandSeries sample_joint_driven(const SampleJob& job) {
  CommandSeries series;
  series.dt = job.dt;
  series.samples.resize(job.count);
  series.origin = job.tracks.origin;
  for (int k = 0; k < job.count; ++k) {
    series.samples[k].state = job.model.rest_state();
    series.samples[k].state.theta = keyed_joints(job, k * job.dt);
  }
  if (job.tracks.base)
    table_base(job, series);
  else
    anchor_samples(job, series);
  follow_targets(job, series);
  fill_rates(series.samples, job.dt, job.tracks.rest_ends);
  fill_feet(job, series);
  fill_commands(job, series);
  series.servo_commands = job.pattern.table && job.pattern.table->commands;
  series.origin["joints"] =
      job.tracks.driver + ", other joints from their keys or from the default posture";
  series.origin.try_emplace("cog", "computed from the posture");
  series.origin.try_emplace("zmp", "computed from the full model");
  series.origin.try_emplace("fz", "computed from the full model");
  return series;
}

}  // namespace ayumi
