// If a law follows the plan by the clock, and the ground is the same everywhere, the next state
// only depends on the present one in the plan frame. So the deviation of a run from the recorded
// one is the deviation of two trajectories of one system that only varies with time.
#include "ayumi/study/recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

// Bounds of the set. Measured by ayumi_early_verdicts (docs/measurements/pushes.md, "Early
// verdicts").

/// Bound of the deviation of the DCM, in units of z: 4.9 mm on HOAP-1. Chosen: with 0.045, the
/// robot fell or did not come to rest in 5 of 305 pushes in open loop after an early verdict, with
/// 0.03 in none.
constexpr double kDcm = 0.02;
/// Bound of the deviation of the ZMP, in units of z: 11 mm on HOAP-1. Chosen: with 0.09 and a bound
/// of 0.03 for the DCM, 2 of 305 early verdicts in open loop are wrong.
constexpr double kZmp = 0.045;
/// Bound of the tilt of the base and of the stance foot [rad]. Chosen: at twice the value, the mean
/// time to a verdict changes by less than 1 %.
constexpr double kTilt = 0.003;
/// Bound of the deflection of a joint from the reference [rad, m]. Chosen: at a third and at twice
/// the value, the mean time to a verdict changes by less than 1 %.
constexpr double kDeflection = 0.01;
/// Bound of the deviation of the reference's posture [rad, m], which the law itself removes.
/// Chosen: about twice the largest turn by which DTAD absorbs a push (control/angular_momentum). At
/// twice the value, verdicts come 3 % sooner.
constexpr double kReference = 0.8;
/// Time before the end after which no verdict is early [s]. Chosen: the ZMP is judged over the last
/// half second, and a deviation decays in the half second before that.
constexpr double kTimeLeft = 1;

bool is_same_everywhere(const World& world) {
  return world.slope.isZero(0) && world.blocks.empty() && world.patches.empty() &&
         world.fields.empty() && world.motions.empty();
}

double angle_between(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return log_rotation(a * b.conjugate()).norm();
}

double largest(const Eigen::VectorXd& values) { return values.lpNorm<Eigen::Infinity>(); }

}  // namespace

RecordedRun::RecordedRun(const World& world) : same_everywhere_(is_same_everywhere(world)) {}

void RecordedRun::take_dcm(const Simulator& run, State& s) {
  const CommandSample& plan = run.plan();
  const Estimate& e = run.last_estimate();
  s.height = plan.cog.z() - plan.zmp.z();
  s.dcm = (e.cog + e.dcog / std::sqrt(kGravity / s.height)).head<2>();
}

RecordedRun::State RecordedRun::state_of(const Simulator& run) {
  const Estimate& e = run.last_estimate();
  const SimulationSample& sample = run.last_sample();
  State s;
  take_dcm(run, s);
  s.time = run.time();
  s.zmp = e.zmp.head<2>();
  s.tilt =
      log_rotation(e.state.base.attitude * sample.reference_base.attitude.conjugate()).head<2>();
  s.foot_tilt = e.foot_tilt;
  s.deflection = e.state.theta - sample.reference_theta;
  s.reference_attitude = sample.reference_base.attitude;
  s.reference_theta = sample.reference_theta;
  s.position = run.state().base.position;
  s.attitude = run.state().base.attitude;
  return s;
}

void RecordedRun::record(const Simulator& run) {
  ticks_.push_back(run.tick());
  states_.push_back(state_of(run));
}

const RecordedRun::State* RecordedRun::state_at(long tick) const {
  const auto found = std::lower_bound(ticks_.begin(), ticks_.end(), tick);
  if (found == ticks_.end() || *found != tick) return nullptr;
  return &states_[static_cast<size_t>(found - ticks_.begin())];
}

double RecordedRun::dcm_drift(const State& here, const State& there) {
  return (here.dcm - there.dcm).norm() / (kDcm * there.height);
}

double RecordedRun::drift(const State& here, const State& there) {
  return std::max({dcm_drift(here, there), (here.tilt - there.tilt).norm() / kTilt,
                   (here.foot_tilt - there.foot_tilt).norm() / kTilt});
}

double RecordedRun::drift(const Simulator& run) const {
  const State* const there = state_at(run.tick());
  return there ? drift(state_of(run), *there) : std::numeric_limits<double>::infinity();
}

double RecordedRun::deviation(const Simulator& run) const {
  const State* const there = state_at(run.tick());
  if (!there) return std::numeric_limits<double>::infinity();
  const State here = state_of(run);
  const double z = there->height;
  double d =
      std::max({drift(here, *there), (here.zmp - there->zmp).norm() / (kZmp * z),
                largest(here.deflection - there->deflection) / kDeflection,
                largest(here.reference_theta - there->reference_theta) / kReference,
                angle_between(here.reference_attitude, there->reference_attitude) / kReference});
  if (!same_everywhere_)  // at another place, the ground is different
    d = std::max({d, (here.position - there->position).norm() / (kDcm * z),
                  angle_between(here.attitude, there->attitude) / kTilt});
  return d;
}

bool RecordedRun::contains(const Simulator& run, double share) const {
  if (states_.empty() || states_.back().time - run.time() < kTimeLeft) return false;
  // In most runs, the DCM returns last, and it is the cheapest to compare.
  const State* const there = state_at(run.tick());
  if (!there) return false;
  State here;
  take_dcm(run, here);
  return dcm_drift(here, *there) <= share && deviation(run) <= share;
}

double RecordedRun::reference_turn(const Simulator& run) const {
  const State* const there = state_at(run.tick());
  return there ? angle_between(run.last_sample().reference_base.attitude, there->reference_attitude)
               : std::numeric_limits<double>::infinity();
}

double RecordedRun::dcm_bound() { return kDcm; }
double RecordedRun::tilt_bound() { return kTilt; }

}  // namespace ayumi
