// The base follows from the anchor foot, the one that carries: in double support the last one
// stays. When the anchor changes it continues from where that foot is, so the base never jumps.
#include <algorithm>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/pattern/differentiate.hpp"
#include "ayumi/pattern/postures.hpp"
#include "ayumi/pattern/sample_job.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

// In the first double support: the foot that carries alone first.
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
      fail(ErrorCode::bad_pattern,
           in_file(job.pattern, "phases/" + std::to_string(i)) +
               ": in a flight phase (support none) no foot holds the base; joint keys alone do "
               "not say where it is: give a table with base columns");
}

void anchor_samples(const SampleJob& job, CommandSeries& series) {
  refuse_flight(job);
  RobotData data(job.model);
  Side anchor = first_anchor(job.feet);
  Isometry3d held = job.feet.pose(anchor, 0);
  for (int k = 0; k < job.count; ++k) {
    CommandSample& sample = series.samples[k];
    const double t = k * job.dt;
    if (!supports(job.feet.support(t), anchor)) {
      anchor = other(anchor);
      // Where the new anchor was one sample ago: it stands still from there on.
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
  series.origin["base"] = "from the foot that carries";
}

void table_base(const SampleJob& job, CommandSeries& series) {
  RobotData data(job.model);
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

// Planned soles: those of the phases when swings say where the feet go; else where the feet are,
// and while they carry where they were when they began to.
void fill_feet(const SampleJob& job, CommandSeries& series) {
  const bool planned = std::any_of(job.feet.phases().begin(), job.feet.phases().end(),
                                   [](const Phase& phase) { return phase.swing.has_value(); });
  series.origin["feet"] = planned ? "phases and swings" : "where the joints put them";
  RobotData data(job.model);
  for (int k = 0; k < job.count; ++k) {
    CommandSample& sample = series.samples[k];
    const double t = k * job.dt;
    sample.support = job.feet.support(t);
    update_positions(job.model, sample.state, data);
    for (const Side side : kSides) {
      const int s = static_cast<int>(side);
      const bool carried = k > 0 && supports(series.samples[k - 1].support, side);
      sample.feet[s] = planned ? job.feet.pose(side, t)
                       : carried && supports(sample.support, side)
                           ? series.samples[k - 1].feet[s]
                           : sole_pose(job.model, data, side);
    }
  }
}

void fill_commands(const SampleJob& job, CommandSeries& series) {
  RobotData data(job.model);
  const PatternTracks& tracks = job.tracks;
  for (int k = 0; k < job.count; ++k) {
    const double t = k * job.dt;
    CommandSample& sample = series.samples[k];
    sample.zmp.setZero();
    for (const Side side : kSides)
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
  fill_rates(series.samples, job.dt, job.tracks.rest_ends);
  fill_feet(job, series);
  fill_commands(job, series);
  series.origin["joints"] = job.tracks.driver + ", others from keys and default posture";
  series.origin.try_emplace("cog", "of the posture");
  series.origin.try_emplace("zmp", "of the full model");
  series.origin.try_emplace("fz", "of the full model");
  return series;
}

}  // namespace ayumi
