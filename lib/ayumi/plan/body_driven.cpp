#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <span>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/folded_legs.hpp"
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

void put_plan(const SampleJob& job, double t, CommandSample& sample) {
  sample.feet = job.feet.poses(t);
  sample.support = job.feet.support(t);
  for (int dof = 0; dof < job.model.dof_count(); ++dof)
    if (!job.ik.solves(dof) && !job.links.leads(dof, t))
      sample.state.theta[dof] = job.tracks.joints[dof].at(t).value;
}

Eigen::Matrix3d trunk_attitude(const SampleJob& job, double t,
                               const std::array<Eigen::Isometry3d, 2>& feet) {
  if (job.tracks.torso) {
    const auto& torso = *job.tracks.torso;
    return rpy_to_matrix({torso[0].at(t).value, torso[1].at(t).value, torso[2].at(t).value});
  }
  const Vector3d heading = feet[0].linear().col(0) + feet[1].linear().col(0);
  return rpy_to_matrix({0, 0, elementary::atan2(heading.y(), heading.x())});
}

namespace {

/// The largest distance of a point of a sole from the origin of its frame [m].
double longest_reach_of_soles(const RobotModel& model) {
  double longest = 0;
  for (const Side side : {Side::left, Side::right})
    for (const Eigen::Vector2d& corner : model.sole(side).polygon)
      longest = std::max(longest, corner.norm());
  return longest;
}

[[noreturn]] void complain_reach(const SampleJob& job, double t, const CommandSample& sample,
                                 const PostureSolution& solution) {
  const SourcePlace place = place_of_phase(job.pattern, job.feet.phase(t));
  const double ground = job.feet.ground(t);
  const std::string where = "t = " + text::fixed(t, 3) + " s: the " + name_of(solution.foot);
  // Coupled hips let a sole reach its place, but not its heading.
  const double allowed = lacking_tolerance(job.feet.hold(solution.foot, t));
  if (job.ik.lacks_joints() && !solution.knee_flipped && solution.missing <= allowed &&
      solution.turned > allowed) {
    const auto degrees = [](double radians) {
      return text::brief(radians * 180 / std::numbers::pi, 2) + " deg";
    };
    std::vector<std::string> shared;
    for (const int dof : job.ik.coupled()) shared.push_back(job.model.dofs()[dof].name);
    fail(ErrorCode::bad_pattern, place,
         where + " foot is turned " + degrees(solution.turned) +
             " away from its planned direction, but at most " + degrees(allowed) +
             " are allowed. " +
             (shared.empty() ? "At this place, the legs cannot turn the sole as it is planned"
                             : "Both legs move with " + text::join(shared, ", ") +
                                   ", so the feet cannot turn relative to each other") +
             ". Turn less in each step, or let the feet stay and turn the trunk (with "
             "\"torso\" of a key)");
  }
  if (job.ik.lacks_joints() && !solution.knee_flipped)
    fail(ErrorCode::bad_pattern, place,
         where + " foot is out of reach by " + millimetres(solution.missing) + ", but at most " +
             millimetres(allowed) +
             " are allowed. Each leg has fewer than six joints, so the COG cannot move far to the "
             "side while the soles are level. Lower the COG height, or make the COG sway less: "
             "shorten the step period, or move the ZMP towards the other foot (new walk "
             "--zmp-inwards)");
  const double height = sample.cog.z() - ground;
  const double apart =
                   (sample.feet[0].translation() - sample.feet[1].translation()).head<2>().norm(),
               off = (sample.cog -
                      0.5 * (sample.feet[0].translation() + sample.feet[1].translation()))
                         .head<2>()
                         .norm();
  const bool beside = off > 0.5 * apart + longest_reach_of_soles(job.model);
  const std::string remedy =
      beside ? ". Move the COG over the feet. Its distance from the middle between them is " +
                   millimetres(off) + ", which follows from the keys of the COG or ZMP"
             : std::string(". ") +
                   (legs_are_folded(job.model, job.pattern, height) ? "Raise" : "Lower") +
                   " the COG height (now " + text::fixed(height, 4) + " m above the soles)" +
                   (job.tracks.torso ? ", tilt the torso less," : "") + " or shorten the stride";
  if (solution.knee_flipped)
    fail(ErrorCode::bad_pattern, place, where + " knee would have to bend the wrong way" + remedy);
  const std::string limit =
      solution.at_limit < 0
          ? ""
          : ", with " + job.model.dofs()[solution.at_limit].name + " at its position limit";
  fail(ErrorCode::bad_pattern, place,
       where + " foot is out of reach by " + millimetres(solution.missing) + limit + remedy);
}

}  // namespace

namespace {

// Largest number of rounds of legs and hands, and the change of a joint at which they end [rad, m].
// Chosen: an arm has a twentieth of the robot's mass, so each round leaves about a twentieth of the
// change. What is left after the rounds changes accelerations at 1 kHz by less than 1e-5 rad/s^2.
constexpr int kMostRounds = 30;
constexpr double kSameJoint = 1e-11;

}  // namespace

PostureSolution solve_posture(const SampleJob& job, double t, const Eigen::Matrix3d& trunk,
                              CommandSample& sample, RobotData& data) {
  PostureTarget target;
  target.trunk = trunk;
  target.cog = sample.cog;
  target.feet = sample.feet;
  target.hold = {job.feet.hold(Side::left, t), job.feet.hold(Side::right, t)};
  target.nearest = job.nearest;
  const auto legs = [&] {
    const PostureSolution solution = job.ik.solve(target, sample.state, data);
    if (!job.nearest && (!solution.reached || solution.knee_flipped))
      complain_reach(job, t, sample, solution);
    return solution;
  };
  PostureSolution solution = legs();
  if (!job.links.leads(t)) return solution;
  // The hand moves the COG, so the base moves, and the hand moves with the base.
  const VectorXd keyed = keyed_joints(job, t);
  for (int round = 0; round < kMostRounds; ++round) {
    if (job.links.solve(t, keyed, sample.state, data) < kSameJoint) break;
    solution = legs();
  }
  return solution;
}

namespace {

/// Largest change of an angle [rad] or place [m] from one step to the next that is extrapolated.
/// The trunk moves suddenly at keys with the interpolation hold. Chosen: 20 rad/s at 1 kHz, above
/// the speed of servos. Figures change by rounding only.
constexpr double kLargestChange = 0.02;

}  // namespace

VectorXd posture_of(const CommandSample& sample) {
  VectorXd x(3 + sample.state.theta.size());
  x << sample.state.base.position - sample.cog, sample.state.theta;
  return x;
}

void continue_posture(const Extrapolation& postures, CommandSample& sample) {
  VectorXd guess;
  postures.next(guess);
  sample.state.base.position = sample.cog + guess.head<3>();
  sample.state.theta = guess.tail(guess.size() - 3);
}

void Extrapolation::add(const VectorXd& x) { last_[count_++ % 4] = x; }

void Extrapolation::next(VectorXd& guess) const {
  guess = before(1);
  if (count_ == 2)
    guess += before(1) - before(2);
  else if (count_ == 3)
    guess += 2 * before(1) - 3 * before(2) + before(3);
  else if (count_ > 3)
    guess += 3 * before(1) - 6 * before(2) + 4 * before(3) - before(4);
  if (!((guess - before(1)).cwiseAbs().maxCoeff() <= kLargestChange)) guess = before(1);
}

namespace {

// Whether a track has keys inside the interval, as the parabola of a flight has.
bool is_ballistic(const Track& track, double begin, double end) {
  return std::any_of(track.keys().begin(), track.keys().end(), [&](const TrackKey& key) {
    return key.t > begin + 1e-9 && key.t < end - 1e-9;
  });
}

}  // namespace

void require_body_tracks(const SampleJob& job) {
  for (size_t i = 0; i < job.feet.phases().size(); ++i) {
    const Phase& phase = job.feet.phases()[i];
    if (phase.support != Support::none) continue;
    const double begin = job.feet.begin(static_cast<int>(i));
    const SourcePlace place = place_of_phase(job.pattern, i);
    if (begin <= 0 || i + 1 == job.feet.phases().size())
      fail(ErrorCode::bad_pattern, place,
           "a flight (support none) needs a phase on the ground before and after it");
    for (int axis = 0; axis < 3; ++axis) {
      const auto& track = job.tracks.cog[axis];
      if (axis < 2 && !track) continue;
      if (track && is_ballistic(*track, begin, phase.until)) continue;
      const std::string quantity = axis == 2 ? "the COG height" : axis == 0 ? "COG x" : "COG y";
      fail(ErrorCode::bad_pattern, place,
           "in the flight from " + text::exact(begin) + " s to " + text::exact(phase.until) +
               " s, the COG follows a parabola, and keys have to state its two ends. Give a key "
               "of " +
               quantity + " at the lift-off and another key at the landing" +
               (track ? "" : ". Also give a key before the flight and a key after the flight"));
    }
  }
}

namespace {

// Smallest lean [rad] and displacement [m] that the origin of a motion names. Chosen: a person sees
// larger ones.
constexpr double kNotedLean = 1e-3, kNotedMiss = 1e-5;

// The largest values in a motion.
struct Worst {
  double miss = 0;   // displacement of a sole that carries the robot, for legs that lack joints [m]
  double swing = 0;  // displacement of a sole that swings [m]
  double lean = 0;   // lean of the trunk, for legs that lack joints [rad]
  double zmp = 0;    // ZMP error of the full model in the solved axes [m]
  bool out_of_reach = false;  // whether a posture does not reach its targets

  void include(const Worst& other) {
    out_of_reach = out_of_reach || other.out_of_reach;
    miss = std::max(miss, other.miss);
    swing = std::max(swing, other.swing);
    lean = std::max(lean, other.lean);
    zmp = std::max(zmp, other.zmp);
  }
};

// The posture at the start of a block: it comes from the grid, or is the posture at rest.
RobotState start_of_block(const SampleJob& job, const CogPlan& plan, int first) {
  if (!plan.postures.empty()) {
    const double share = static_cast<double>(first) / (job.count - 1);
    return plan.postures[std::lround(share * static_cast<double>(plan.postures.size() - 1))];
  }
  RobotState state = job.model.rest_state();
  state.theta = job.ik.start();
  return state;
}

// Solves the postures of the samples first, first + 1, ..., end - 1.
Worst solve_block(const SampleJob& job, const CogPlan& plan, int first, int end,
                  CommandSeries& series) {
  RobotData data = job.data;
  Extrapolation postures;
  Worst worst;
  for (int k = first; k < end; ++k) {
    const double t = k * job.dt;
    CommandSample& sample = series.samples[k];
    sample.state = k > first ? series.samples[k - 1].state : start_of_block(job, plan, first);
    sample.cog = plan.cog_at(t);
    if (k > first) continue_posture(postures, sample);
    put_plan(job, t, sample);
    const PostureSolution solution =
        solve_posture(job, t, plan.turned(t, trunk_attitude(job, t, sample.feet)), sample, data);
    worst.include(
        {.lean = solution.lean, .out_of_reach = !solution.reached || solution.knee_flipped});
    for (const Side side : {Side::left, Side::right}) {
      double& miss = job.feet.hold(side, t) < 1 ? worst.swing : worst.miss;
      miss = std::max(miss, solution.miss[index(side)]);
    }
    postures.add(posture_of(sample));
  }
  return worst;
}

// Where postures begin or cease to reach their targets, the motion has kinks, which no smooth
// correction can remove. Cubic splines through some of the postures replace such a motion.
void smooth_postures(const SampleJob& job, CommandSeries& series) {
  // Time between these postures [s]. Chosen: half the distance of the knots of a repair, so that a
  // repair can correct what lies between them.
  constexpr double kStep = 0.025;
  const long every = std::max(1L, std::lround(kStep / job.dt)), last = job.count - 1;
  const Eigen::Index size = 7 + job.model.dof_count();
  std::vector<std::vector<TrackKey>> keys(static_cast<size_t>(size));
  VectorXd x(size);
  const long steps = std::max(1L, last / every);
  for (long i = 0; i <= steps; ++i) {
    const long k = i == steps ? last : i * every;
    const RobotState& state = series.samples[static_cast<size_t>(k)].state;
    Eigen::Vector4d q = state.base.attitude.coeffs();
    if (i > 0 && q.dot(x.segment<4>(3)) < 0) q = -q;
    x << state.base.position, q, state.theta;
    for (Eigen::Index j = 0; j < size; ++j)
      keys[static_cast<size_t>(j)].push_back(
          {static_cast<double>(k) * job.dt, x[j], Interpolation::spline});
  }
  const std::vector<Track> tracks(keys.begin(), keys.end());
  for (int k = 0; k < job.count; ++k) {
    for (Eigen::Index j = 0; j < size; ++j)
      x[j] = tracks[static_cast<size_t>(j)].at(k * job.dt).value;
    RobotState& state = series.samples[static_cast<size_t>(k)].state;
    state.base.position = x.head<3>();
    state.base.attitude = Eigen::Quaterniond(Eigen::Vector4d(x.segment<4>(3))).normalized();
    state.theta = x.tail(job.model.dof_count());
  }
}

// Computes rates, commanded ZMP and f_z of the samples first, ..., end - 1.
Worst fill_block(const SampleJob& job, const CogPlan& plan, int first, int end,
                 CommandSeries& series) {
  fill_rates(series.samples, first, end, job.dt, job.tracks.rest_ends);
  for (int k = first; k < end; ++k) put_ground_commands(job, plan, k * job.dt, series.samples[k]);
  TreeDynamics dynamics = job.dynamics;
  std::vector<GroundReaction> reactions;
  full_model_reactions(job.model, std::span(series.samples).subspan(first, end - first), dynamics,
                       reactions);
  Worst worst;
  for (int k = first; k < end; ++k) {
    CommandSample& sample = series.samples[k];
    if (sample.support == Support::none) continue;
    const GroundReaction& full = reactions[k - first];
    const bool weak = full.force.z() < kZmpShare * job.model.mass() * kGravity;
    for (int axis = 0; axis < 2; ++axis) {
      if (plan.solved[axis] && weak) continue;
      if (plan.solved[axis])
        worst.zmp = std::max(worst.zmp, std::abs(full.zmp[axis] - sample.zmp[axis]));
      else if (!job.tracks.zmp)
        sample.zmp[axis] = full.zmp[axis];
    }
  }
  return worst;
}

// Calls work(first, end) for all blocks. Each call returns the worst values of its samples.
template <class Work>
Worst worst_of_blocks(const SampleJob& job, int block, const Work& work) {
  std::mutex mutex;
  Worst worst;
  in_blocks(job, "sampling", job.count, block, [&](int first, int end) {
    const Worst here = work(first, end);
    const std::lock_guard lock(mutex);
    worst.include(here);
  });
  return worst;
}

void describe(const SampleJob& job, const CogPlan& plan, const Worst& worst,
              CommandSeries& series) {
  auto& origin = series.origin;
  const bool any = plan.solved[0] || plan.solved[1];
  const bool both = plan.solved[0] && plan.solved[1];
  const std::string axes = both ? "" : plan.solved[0] ? " in x" : " in y";
  const std::string source = job.tracks.zmp ? "the ZMP keys" : "the ZMP of the phases";
  if (any) {
    const std::string solved =
        "computed" + axes + " from " + source +
        (job.pattern.full_model ? " for the full model"
                                : " for the point-mass model, equations (14)(15)") +
        " (largest ZMP error " + millimetres(worst.zmp) + ")";
    origin["cog"] =
        both ? solved
             : "from keys in " + std::string(plan.solved[0] ? "y" : "x") + ", and " + solved;
  }
  if (!job.tracks.zmp)
    origin["zmp"] =
        any ? "centres of the supporting soles, from the phases" : "computed from the full model";
  if (!job.tracks.zmp && any && !both)
    origin["zmp"] += ". In the direction in which the COG has keys, computed from the full model";
  const double moved =
      std::max(plan.bump[0].cwiseAbs().maxCoeff(), plan.bump[1].cwiseAbs().maxCoeff()) * 4 *
      elementary::exp(-2.0);
  if (moved > 5e-5)
    origin["zmp"] += ", moved by up to " + millimetres(moved) +
                     " near the ends so that the motion starts and stops at rest";
  origin["cog_height"] =
      job.tracks.cog[2] ? "keys" : "constant above the ground, from the defaults";
  if (!job.tracks.fz) origin["fz"] = "computed from the COG height, equation (16) of the paper";
  origin["torso"] = job.tracks.torso ? "keys" : "level, in the mean heading of both feet";
  if (flies(job)) {
    origin["cog_height"] += ", and parabolas in flight";
    if (!job.tracks.torso)
      origin["torso"] +=
          ". Before, during and after each flight, Ayumi turns the torso so that the angular "
          "momentum in flight is 0";
  }
  origin["feet"] = "phases and swings";
  origin["base"] = "computed from feet, torso and COG";
  if (job.ik.lacks_joints() &&
      (worst.lean > kNotedLean || std::max(worst.miss, worst.swing) > kNotedMiss)) {
    const size_t joints = std::min(job.ik.leg(Side::left).size(), job.ik.leg(Side::right).size());
    origin["legs"] =
        "a leg has only " + std::to_string(joints) +
        (job.ik.coupled().empty() ? " joints"
                                  : " joints of its own, and one more joint moves both legs") +
        ", so it cannot keep the sole level at all places. Therefore the trunk leans by up to " +
        text::fixed(worst.lean * 180 / std::numbers::pi, 1) +
        " deg, and a supporting sole is up to " + millimetres(worst.miss) +
        " away from its place (allowed " + millimetres(kLackingTolerance) + ")";
    if (worst.swing > kNotedMiss)
      origin["legs"] += ". A swinging sole is up to " + millimetres(worst.swing) +
                        " away from its place (allowed " + millimetres(kSwingingTolerance) +
                        " in the middle of a swing)";
  }
  origin["joints"] =
      "legs by inverse kinematics, other joints from their keys or from the default posture";
}

}  // namespace

void put_ground_commands(const SampleJob& job, const CogPlan& plan, double t,
                         CommandSample& sample) {
  sample.zmp = plan.zmp_at(t);
  sample.fz =
      job.tracks.fz ? job.tracks.fz->at(t).value : job.model.mass() * (sample.ddcog.z() + kGravity);
  if (sample.support == Support::none && !job.tracks.fz) sample.fz = 0;
}

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
  report(job.progress, {"sampling", 0, ""});
  // Without postures of a grid, each sample is solved from the previous one.
  Worst worst = worst_of_blocks(job, plan.postures.empty() ? 0 : kBlock, [&](int first, int end) {
    return solve_block(job, plan, first, end, series);
  });
  if (worst.out_of_reach) smooth_postures(job, series);
  worst.include(worst_of_blocks(
      job, kBlock, [&](int first, int end) { return fill_block(job, plan, first, end, series); }));
  describe(job, plan, worst, series);
  return series;
}

}  // namespace ayumi
