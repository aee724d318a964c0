// How a swinging foot leaves its place, passes over the ground and comes to its next place.
#include <algorithm>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/repair/correction_problem.hpp"

namespace ayumi {

namespace {

constexpr double kNearPlace = 0.15;   // of a swing to its landing or lift-off [s]
constexpr double kPlaceSpare = 2e-4;  // that a low sole may be off its place [m]

double middle_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// How far off its place the swings of the motion are while they are low: way over height squared,
// of the middle one of all, for a faulty one says nothing, and half as much again.
double CorrectionProblem::own_landing_factor() const {
  constexpr double kLeast = 0.12;  // of the COG's height, one over it [1/m]
  constexpr double kSpare = 1.5;
  std::vector<double> factors;
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = plan_.intervals[static_cast<int>(side)];
    for (size_t i = 0; i < intervals.size(); ++i) {
      if (intervals[i].contact) continue;
      if (i > 0)
        factors.push_back(landing_factor(side, intervals[i], intervals[i - 1].sole, false));
      if (i + 1 < intervals.size())
        factors.push_back(landing_factor(side, intervals[i], intervals[i + 1].sole, true));
    }
  }
  const double least = 1 / (kLeast * series_.samples.front().cog.z());
  if (factors.empty()) return least;
  return std::max(least, kSpare * middle_of(factors));
}

double CorrectionProblem::landing_factor(Side side, const ContactInterval& swing,
                                         const Eigen::Isometry3d& place, bool lands) const {
  constexpr double kLow = 0.001;    // what is lower says little [m]
  constexpr double kEvery = 0.005;  // [s]
  const int every = std::max(1, static_cast<int>(kEvery / series_.dt));
  const int count =
      std::min((swing.last - swing.first) / 2, static_cast<int>(kNearPlace / series_.dt));
  RobotData data(model_);
  double most = 0;
  for (int k = 0; k < count; k += every) {
    update_positions(model_, series_.samples[lands ? swing.last - k : swing.first + k].state, data);
    const Eigen::Isometry3d sole = sole_pose(model_, data, side);
    const double height = place.linear().col(2).dot(sole.translation() - place.translation());
    if (height < kLow) continue;
    const double way = landing_way(model_, side, sole, place).cwiseAbs().maxCoeff();
    most = std::max(most, (way - kPlaceSpare) / (height * height));
  }
  return most;
}

// Near its landing and its lift-off a swinging sole is over its place: played open loop the servos
// sag, and a sole that comes in low or tilted touches down while it still moves.
void CorrectionProblem::place_landing(int instant, Side side) {
  const CollocationPoint& at = instants_[instant];
  const ContactInterval& swing = plan_.at(side, at.sample);
  const int last = static_cast<int>(series_.samples.size()) - 1;
  const int after = swing.first == 0 ? last : at.sample - swing.first;
  const int before = swing.last == last ? last : swing.last - at.sample;
  if (std::min(after, before) * series_.dt > kNearPlace) return;
  ConstraintBlock block = block_of(ConstraintGroup::landing, instant, static_cast<int>(side), 10);
  block.factor = landing_factor_;
  add_block(std::move(block), -kPlaceSpare, kNoBound);
}

// How high the swings of the motion keep their soles in the middle half of their time, the lowest
// corner of the middle one of all.
double CorrectionProblem::own_foot_clearance() const {
  constexpr double kEvery = 0.01;  // [s]
  const int every = std::max(1, static_cast<int>(kEvery / series_.dt));
  std::vector<double> heights;
  RobotData data(model_);
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = plan_.intervals[static_cast<int>(side)];
    for (size_t i = 1; i + 1 < intervals.size(); ++i) {
      if (intervals[i].contact) continue;
      const int quarter = (intervals[i].last - intervals[i].first) / 4;
      double lowest = kNoBound;
      for (int k = intervals[i].first + quarter; k <= intervals[i].last - quarter; k += every) {
        update_positions(model_, series_.samples[k].state, data);
        const Eigen::Isometry3d sole = sole_pose(model_, data, side);
        for (size_t j : {i - 1, i + 1})
          lowest = std::min(lowest, sole_error(model_.sole(side), sole, intervals[j].sole).lowest);
      }
      heights.push_back(lowest);
    }
  }
  return heights.empty() ? 0 : middle_of(heights);
}

void CorrectionProblem::measure_swings() {
  constexpr double kShare = 0.5;  // of the height of the motion's own swings
  landing_factor_ = own_landing_factor();
  foot_clearance_ = std::max(0.0, kShare * own_foot_clearance());
}

// Over the ground all the way; half as high as the motion's other swings in the middle half.
void CorrectionProblem::place_swing(int instant, Side side) {
  constexpr double kNearGround = 0.004;  // a sole this much higher is not watched [m]
  const int s = static_cast<int>(side);
  const CollocationPoint& at = instants_[instant];
  double lowest = kNoBound;
  RobotData data(model_);
  for (const CommandSample* sample : watched(instant)) {
    update_positions(model_, sample->state, data);
    const Eigen::Isometry3d sole = sole_pose(model_, data, side);
    lowest = std::min(lowest, sole_error(model_.sole(side), sole, at.ground[s]).lowest);
  }
  const int corners = static_cast<int>(model_.sole(side).polygon.size());
  if (lowest < kNearGround)
    add_block(block_of(ConstraintGroup::swing, instant, s, corners), -spec_.sole_position,
              kNoBound);
  const ContactInterval& swing = plan_.at(side, at.sample);
  const int quarter = (swing.last - swing.first) / 4;
  const bool middle = at.sample >= swing.first + quarter && at.sample <= swing.last - quarter;
  if (spec_.gentle_swings && middle && spec_.watched_share * lowest < foot_clearance_)
    add_block(block_of(ConstraintGroup::foot_clearance, instant, s, corners), foot_clearance_,
              kNoBound);
}

}  // namespace ayumi
