// The pendulum law (14)(15) gives a first COG; legs and arms then move the ZMP of the full model
// away from it. The error e = cmd z - full z is itself put through the bounded solution and added
// to the COG, again and again: each pass leaves what the limbs' angular momentum changed.
#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/pattern/bounded_cog.hpp"
#include "ayumi/pattern/differentiate.hpp"
#include "ayumi/pattern/postures.hpp"
#include "ayumi/pattern/sample_job.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kGridStep = 0.005;   // of the correction [s]
constexpr double kGoodEnough = 1e-4;  // largest full-model ZMP error to stop at [m]
constexpr int kMostIterations = 8;

// The plan on a uniform grid over the whole pattern.
struct Grid {
  int n = 0;     // intervals
  double h = 0;  // [s]
  double t(Eigen::Index k) const { return h * static_cast<double>(k); }
};

Track spline_through(const Grid& grid, const VectorXd& values) {
  std::vector<TrackKey> keys;
  for (int k = 0; k <= grid.n; ++k) keys.push_back({grid.t(k), values[k], Interpolation::spline});
  return Track(keys);
}

Track default_height(const SampleJob& job, const Grid& grid) {
  const double level = default_cog_height(job.model, job.pattern);
  VectorXd z(grid.n + 1);
  for (int k = 0; k <= grid.n; ++k) z[k] = level + job.feet.ground(grid.t(k));
  if ((z.array() - z[0]).abs().maxCoeff() < 1e-9) return Track(z[0]);
  return spline_through(grid, z);
}

// (17) with the planned height.
VectorXd omega_squared_of(const SampleJob& job, const CogPlan& plan, const Grid& grid) {
  VectorXd w2(grid.n + 1);
  for (int k = 0; k <= grid.n; ++k) {
    const TrackPoint z = plan.cog[2].at(grid.t(k));
    const double above = z.value - plan.zmp[2].at(grid.t(k)).value;
    w2[k] = (z.acceleration + kGravity) / above;
    if (!(above > 0) || !(w2[k] > 0))
      fail(ErrorCode::bad_pattern,
           in_file(job.pattern, "COG height") + ": at t = " + text::fixed(grid.t(k), 3) +
               " s the COG is not above the ZMP or falls faster than gravity; raise the COG or "
               "slow the height keys down");
  }
  return w2;
}

std::vector<CommandSample> start_samples(const SampleJob& job, const Grid& grid) {
  std::vector<CommandSample> samples(grid.n + 1);
  for (CommandSample& sample : samples) sample.state = job.model.rest_state();
  return samples;
}

void solve_grid(const SampleJob& job, const Grid& grid, const std::array<VectorXd, 3>& cog,
                bool first, std::vector<CommandSample>& samples) {
  RobotData data(job.model);
  for (int k = 0; k <= grid.n; ++k) {
    CommandSample& sample = samples[k];
    if (first && k > 0) sample.state = samples[k - 1].state;
    if (first && k == 0) sample.state.theta = job.ik.start();
    const Vector3d moved = Vector3d(cog[0][k], cog[1][k], cog[2][k]) - sample.cog;
    if (!first) sample.state.base.position += moved;
    sample.cog += moved;
    solve_posture(job, grid.t(k), sample, data);
  }
  fill_rates(samples, grid.h, true);
}

}  // namespace

Vector3d CogPlan::zmp_at(double t) const {
  Vector3d z(zmp[0].at(t).value, zmp[1].at(t).value, zmp[2].at(t).value);
  z.head<2>() += rest_bump(omega[0], t, duration) * bump[0] +
                 rest_bump(omega[1], duration - t, duration) * bump[1];
  return z;
}

CogPlan plan_cog(const SampleJob& job) {
  CogPlan plan;
  plan.duration = job.dt * (job.count - 1);
  Grid grid;
  grid.n = std::max(8, static_cast<int>(std::ceil(plan.duration / kGridStep - 1e-9)));
  grid.h = plan.duration / grid.n;
  plan.zmp = job.tracks.zmp ? *job.tracks.zmp : default_zmp(job.feet);
  plan.cog[2] = job.tracks.cog[2] ? *job.tracks.cog[2] : default_height(job, grid);
  for (int axis = 0; axis < 2; ++axis) {
    plan.solved[axis] = !job.tracks.cog[axis];
    if (!plan.solved[axis]) plan.cog[axis] = *job.tracks.cog[axis];
  }
  if (!plan.solved[0] && !plan.solved[1]) return plan;

  const VectorXd w2 = omega_squared_of(job, plan, grid);
  plan.omega = {std::sqrt(w2[0]), std::sqrt(w2[grid.n])};
  std::array<VectorXd, 3> cog;
  for (int axis = 0; axis < 3; ++axis) {
    cog[axis].resize(grid.n + 1);
    for (int k = 0; k <= grid.n; ++k) cog[axis][k] = plan.cog[axis].at(grid.t(k)).value;
  }
  const auto add_solution = [&](int axis, const VectorXd& z, bool first) {
    const RestToRest motion = rest_to_rest_cog(z, w2, grid.h);
    cog[axis] = first ? motion.x : VectorXd(cog[axis] + motion.x);
    plan.bump[0][axis] += motion.begin;
    plan.bump[1][axis] += motion.end;
  };
  for (int axis = 0; axis < 2; ++axis) {
    if (!plan.solved[axis]) continue;
    VectorXd z(grid.n + 1);
    for (int k = 0; k <= grid.n; ++k) z[k] = plan.zmp[axis].at(grid.t(k)).value;
    add_solution(axis, z, true);
  }
  if (job.pattern.full_model) {
    std::vector<CommandSample> samples = start_samples(job, grid);
    RobotData data(job.model);
    for (int pass = 0; pass < kMostIterations; ++pass) {
      report(job.progress, {"solve the COG", static_cast<double>(pass) / kMostIterations, ""});
      solve_grid(job, grid, cog, pass == 0, samples);
      std::array<VectorXd, 2> error = {VectorXd::Zero(grid.n + 1), VectorXd::Zero(grid.n + 1)};
      double worst = 0;
      for (int k = 0; k <= grid.n; ++k) {
        samples[k].zmp = plan.zmp_at(grid.t(k));
        const Vector3d full = full_model_reaction(job.model, samples[k], data).zmp;
        for (int axis = 0; axis < 2; ++axis) {
          if (!plan.solved[axis]) continue;
          error[axis][k] = samples[k].zmp[axis] - full[axis];
          worst = std::max(worst, std::abs(error[axis][k]));
        }
      }
      plan.iterations = pass;
      if (worst <= kGoodEnough) break;
      for (int axis = 0; axis < 2; ++axis)
        if (plan.solved[axis]) add_solution(axis, error[axis], false);
    }
  }
  for (int axis = 0; axis < 2; ++axis)
    if (plan.solved[axis]) plan.cog[axis] = spline_through(grid, cog[axis]);
  return plan;
}

}  // namespace ayumi
