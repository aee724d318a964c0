// The pendulum law (14)(15) gives a first COG. The ZMP of the full model differs from its command,
// because legs and arms, and a trunk that leans, have angular momentum. In each pass, the bounded
// solution of (14)(15) for the ZMP error e = cmd z - full z is added to the COG; the error that
// remains comes from the change of the limbs' motion.
#include <algorithm>
#include <cmath>
#include <mutex>
#include <span>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/bounded_curve.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/flight.hpp"
#include "ayumi/plan/sample_job.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Step of the grid on which the COG is corrected [s]. Chosen: five ticks; 1/omega is 150 ms for a
/// COG at 0.22 m. Between half and twice the value, figures change by less than 5 %.
constexpr double kGridStep = 0.005;
/// ZMP error of the full model at which the correction ends [m]. Chosen: far below the margins of a
/// sole, and 1/10 of what the check reports in its figures. Between half and twice the value,
/// figures change by less than 5 %.
constexpr double kZmpGoal = 1e-4;
/// Largest number of passes. Chosen: each pass reduces the error to a fraction, and the passes end
/// earlier if two in a row do not reduce it. No measured case changes between half and twice the
/// value (constants.md).
constexpr int kMostIterations = 12;

constexpr const char* kStage = "computing the COG";

// The plan on a uniform grid over the whole pattern.
struct Grid {
  int n = 0;     // number of intervals
  double h = 0;  // length of an interval [s]
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

// Smallest height of the pendulum of lean_height(), as a share of the height of the COG. Chosen: it
// keeps the height above 0 if the trunk leans against the movement of the COG, which has not been
// observed.
constexpr double kLeastHeight = 0.3;

// Displacement of the COG to either side between the two postures that lean_height() compares [m].
// Chosen: 1/20 of the displacement with legs of five joints, and far above the tolerance of the
// inverse kinematics.
constexpr double kLook = 5e-4;

// Where legs lack joints, the trunk leans to move the COG aside. Its angular momentum L about the
// COG is then proportional to the COG's speed v. So the robot falls like a pendulum that is higher
// by L / (m v): the ZMP is c - (z + L / (m v)) c'' / g. Returns this additional height for both
// axes [m], at the start of the motion. It is 0 for other legs, whose trunk keeps its attitude.
Eigen::Vector2d lean_height(const SampleJob& job, const CogPlan& plan) {
  Eigen::Vector2d height = Eigen::Vector2d::Zero();
  if (!job.ik.lacks_joints()) return height;
  RobotData data = job.data;
  const auto posture_at = [&](const Vector3d& cog) {
    CommandSample sample;
    sample.state = job.model.rest_state();
    sample.state.theta = job.ik.start();
    sample.cog = cog;
    put_plan(job, 0, sample);
    solve_posture(job, 0, trunk_attitude(job, 0, sample.feet), sample, data);
    return sample.state;
  };
  for (int axis = 0; axis < 2; ++axis) {
    if (!plan.solved[axis]) continue;
    Vector3d cog(plan.zmp[0].at(0).value, plan.zmp[1].at(0).value, plan.cog[2].at(0).value);
    for (int i = 0; i < 2; ++i)
      if (!plan.solved[i]) cog[i] = plan.cog[i].at(0).value;
    cog[axis] -= kLook;
    RobotState state = posture_at(cog);
    cog[axis] += 2 * kLook;
    const RobotState after = posture_at(cog);
    // The rates with which the robot would move from the first posture to the second one in 1 s.
    state.base_velocity = after.base.position - state.base.position;
    state.base_angular_velocity =
        log_rotation(after.base.attitude * state.base.attitude.conjugate());
    state.dtheta = after.theta - state.theta;
    update_positions(job.model, state, data);
    update_velocities(job.model, state, data);
    const Momentum momentum = centroidal_momentum(job.model, data);
    height[axis] =
        (axis == 0 ? momentum.angular.y() : -momentum.angular.x()) / (job.model.mass() * 2 * kLook);
  }
  return height;
}

// omega^2 by (17) with the planned height plus `more`.
VectorXd omega_squared_of(const SampleJob& job, const CogPlan& plan, const Grid& grid,
                          double more) {
  VectorXd w2(grid.n + 1);
  for (int k = 0; k <= grid.n; ++k) {
    const TrackPoint z = plan.cog[2].at(grid.t(k));
    const double above = z.value - plan.zmp[2].at(grid.t(k)).value;
    w2[k] = (z.acceleration + kGravity) / std::max(above + more, kLeastHeight * above);
    if (job.feet.support(grid.t(k)) == Support::none || std::abs(w2[k]) < 1e-6) w2[k] = 0;
    if (!(above > 0) || w2[k] < 0)
      fail(
          ErrorCode::bad_pattern, in_file(job.pattern, "COG height"),
          "at t = " + text::fixed(grid.t(k), 3) +
              " s, the COG is not above the ZMP, or it falls faster than gravity allows. Raise the "
              "COG, or give the keys of the COG height more time");
  }
  return w2;
}

TrunkTurn turn_around_flights(const SampleJob& job, const CogPlan& plan) {
  return plan_trunk_turn(job, [&](double t) -> std::array<TrackPoint, 3> {
    return {plan.cog[0].at(t), plan.cog[1].at(t), plan.cog[2].at(t)};
  });
}

// COG and bumps during the correction, on the grid.
struct CogSolver {
  const SampleJob& job;
  CogPlan& plan;
  Grid grid;
  std::array<VectorXd, 2> w2;  // omega^2 by axis; 0 in flight
  std::array<RestToRestSolver, 2> pendulum;
  std::array<VectorXd, 3> cog;
  std::vector<CommandSample> samples = {};  // values of the last pass
  std::vector<Eigen::Matrix3d> trunk = {};  // attitude of the trunk as the pattern states it
  std::array<VectorXd, 2> error = {};       // cmd ZMP - full-model ZMP in the solved axes

  void read_tracks();
  void put_tracks();
  void turn_trunk();
  void add_solution(int axis, const VectorXd& z);
  void solve_first();
  void solve_again(int first, int end);
  double measure(int first, int end);
  double measure();
  void correct();
};

void CogSolver::read_tracks() {
  for (int axis = 0; axis < 3; ++axis) {
    cog[axis] = VectorXd::Zero(grid.n + 1);
    if (axis < 2 && plan.solved[axis]) continue;
    for (int k = 0; k <= grid.n; ++k) cog[axis][k] = plan.cog[axis].at(grid.t(k)).value;
  }
}

void CogSolver::add_solution(int axis, const VectorXd& z) {
  const RestToRest motion = pendulum[axis].solve(z);
  cog[axis] += motion.x;
  plan.bump[0][axis] += motion.begin;
  plan.bump[1][axis] += motion.end;
}

// Writes the present solution into the tracks of the plan.
void CogSolver::put_tracks() {
  for (int axis = 0; axis < 2; ++axis)
    if (plan.solved[axis]) plan.cog[axis] = spline_through(grid, cog[axis]);
}

// Computes the turn of the trunk around flights for the present COG.
void CogSolver::turn_trunk() {
  if (!flies(job)) return;
  put_tracks();
  plan.turn = turn_around_flights(job, plan);
}

// The postures of the first pass, each computed from the previous ones.
void CogSolver::solve_first() {
  samples.resize(grid.n + 1);
  trunk.resize(grid.n + 1);
  RobotData data = job.data;
  Extrapolation postures;
  for (int k = 0; k <= grid.n; ++k) {
    const double t = grid.t(k);
    CommandSample& sample = samples[k];
    sample.state = k > 0 ? samples[k - 1].state : job.model.rest_state();
    sample.cog = Vector3d(cog[0][k], cog[1][k], cog[2][k]);
    if (k > 0)
      continue_posture(postures, sample);
    else
      sample.state.theta = job.ik.start();
    put_plan(job, t, sample);
    trunk[k] = trunk_attitude(job, t, sample.feet);
    solve_posture(job, t, plan.turned(t, trunk[k]), sample, data);
    postures.add(posture_of(sample));
  }
}

// The postures of the samples first, ..., end - 1 in a later pass. They are computed from the
// postures of the last pass and from the changes of the previous samples.
void CogSolver::solve_again(int first, int end) {
  RobotData data = job.data;
  Extrapolation changes;
  VectorXd guess;
  for (int k = first; k < end; ++k) {
    CommandSample& sample = samples[k];
    const VectorXd before = posture_of(sample);
    sample.cog = Vector3d(cog[0][k], cog[1][k], cog[2][k]);
    sample.state.base.position = sample.cog + before.head<3>();
    if (k > first) {
      changes.next(guess);
      sample.state.base.position += guess.head<3>();
      sample.state.theta += guess.tail(guess.size() - 3);
      // The changes of a hand that a target led until now do not go on in joints that keys move.
      for (int dof = 0; !job.links.empty() && dof < job.model.dof_count(); ++dof)
        if (!job.ik.solves(dof) && !job.links.leads(dof, grid.t(k)))
          sample.state.theta[dof] = before[3 + dof];
    }
    solve_posture(job, grid.t(k), plan.turned(grid.t(k), trunk[k]), sample, data);
    changes.add(posture_of(sample) - before);
  }
}

// Computes the errors of the samples first, ..., end - 1. Returns the largest one; where the ground
// force is below the weight, errors count as their moment divided by the weight.
double CogSolver::measure(int first, int end) {
  fill_rates(samples, first, end, grid.h, true);
  for (int k = first; k < end; ++k) samples[k].zmp = plan.zmp_at(grid.t(k));
  TreeDynamics dynamics = job.dynamics;
  std::vector<GroundReaction> reactions;
  full_model_reactions(job.model, std::span(samples).subspan(first, end - first), dynamics,
                       reactions);
  const double weight = job.model.mass() * kGravity;
  double worst = 0;
  for (int k = first; k < end; ++k) {
    if (w2[0][k] == 0) continue;
    const GroundReaction& full = reactions[k - first];
    const double share = std::min(1.0, full.force.z() / weight);
    if (share < kZmpShare) continue;
    for (int axis = 0; axis < 2; ++axis) {
      if (!plan.solved[axis]) continue;
      error[axis][k] = samples[k].zmp[axis] - full.zmp[axis];
      worst = std::max(worst, share * std::abs(error[axis][k]));
    }
  }
  return worst;
}

// Computes the errors of all samples.
double CogSolver::measure() {
  std::mutex mutex;
  double worst = 0;
  error = {VectorXd::Zero(grid.n + 1), VectorXd::Zero(grid.n + 1)};
  in_blocks(job, kStage, grid.n + 1, kBlock, [&](int first, int end) {
    const double here = measure(first, end);
    const std::lock_guard lock(mutex);
    worst = std::max(worst, here);
  });
  return worst;
}

// Keeps the best pass. Where the keys are discontinuous, the error cannot vanish, and a later pass
// may be worse than an earlier one.
void CogSolver::correct() {
  double best = INFINITY;
  auto best_cog = cog;
  auto best_bump = plan.bump;
  int worse = 0;
  for (int pass = 0; pass <= kMostIterations && worse < 2; ++pass) {
    if (pass == 0)
      solve_first();
    else
      in_blocks(job, kStage, grid.n + 1, kBlock,
                [&](int first, int end) { solve_again(first, end); });
    const double worst = measure();
    report(job.progress, {kStage, static_cast<double>(pass) / kMostIterations,
                          "the ZMP still differs from the plan by " + millimetres(worst) +
                              " after pass " + std::to_string(pass + 1)});
    worse = worst < best ? 0 : worse + 1;
    if (worse == 0) {
      best = worst;
      best_cog = cog;
      best_bump = plan.bump;
    }
    if (worst <= kZmpGoal) break;
    for (int axis = 0; axis < 2; ++axis)
      if (plan.solved[axis]) add_solution(axis, error[axis]);
    turn_trunk();
  }
  cog = best_cog;
  plan.bump = best_bump;
  for (CommandSample& sample : samples) plan.postures.push_back(std::move(sample.state));
}

}  // namespace

Vector3d CogPlan::cog_at(double t) const {
  return {cog[0].at(t).value, cog[1].at(t).value, cog[2].at(t).value};
}

Vector3d CogPlan::zmp_at(double t) const {
  Vector3d z(zmp[0].at(t).value, zmp[1].at(t).value, zmp[2].at(t).value);
  double begin = 0, end = 0;
  for (int axis = 0; axis < 2; ++axis) {
    if (axis == 0 || omega[0][axis] != omega[0][0]) begin = rest_bump(omega[0][axis], t, duration);
    if (axis == 0 || omega[1][axis] != omega[1][0])
      end = rest_bump(omega[1][axis], duration - t, duration);
    z[axis] += begin * bump[0][axis] + end * bump[1][axis];
  }
  return z;
}

Eigen::Matrix3d CogPlan::turned(double t, const Eigen::Matrix3d& asked) const {
  const Vector3d r(turn[0].at(t).value, turn[1].at(t).value, turn[2].at(t).value);
  return r.isZero(0) ? asked : Eigen::Matrix3d(exp_rotation(r) * asked);
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
  if (!plan.solved[0] && !plan.solved[1]) {
    if (flies(job)) plan.turn = turn_around_flights(job, plan);
    return plan;
  }

  const Eigen::Vector2d more =
      job.pattern.full_model ? lean_height(job, plan) : Eigen::Vector2d::Zero();
  const VectorXd first = omega_squared_of(job, plan, grid, more[0]);
  const VectorXd second = more[1] == more[0] ? first : omega_squared_of(job, plan, grid, more[1]);
  CogSolver solver{job,
                   plan,
                   grid,
                   {first, second},
                   {RestToRestSolver(first, grid.h), RestToRestSolver(second, grid.h)},
                   {}};
  for (int axis = 0; axis < 2; ++axis) {
    plan.omega[0][axis] = std::sqrt(solver.w2[axis][0]);
    plan.omega[1][axis] = std::sqrt(solver.w2[axis][grid.n]);
  }
  solver.read_tracks();
  for (int axis = 0; axis < 2; ++axis) {
    if (!plan.solved[axis]) continue;
    VectorXd z(grid.n + 1);
    for (int k = 0; k <= grid.n; ++k) z[k] = plan.zmp[axis].at(grid.t(k)).value;
    solver.add_solution(axis, z);
  }
  solver.turn_trunk();
  if (job.pattern.full_model) solver.correct();
  solver.put_tracks();
  if (flies(job)) plan.turn = turn_around_flights(job, plan);
  return plan;
}

}  // namespace ayumi
