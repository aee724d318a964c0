// A sole that comes down fast hits the ground. Its speed along the normal n of its place is that of
// the step from the last sample of the swing to the first sample k in contact, -(n . (p_k - p_k-1))
// / dt. The rate at sample k itself is not used, because the plan already stands still there.
//
// A repair keeps a swinging sole over the ground, as the check does (stance.cpp), and has two soft
// goals for it. In open loop, the servos sag, and a sole that arrives low or tilted touches down
// while it still moves. So a sole at height h over its place should be near this place,
//   |offset| <= slack + k h^2,   with k from the motion's own swings,
// and in the middle half of a swing it should be at least as high as a share of the height that the
// motion's own swings have.
#include "ayumi/limits/swing_foot.hpp"

#include <algorithm>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/limits/sole_rows.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Largest landing speed without a warning [m/s]. Chosen: a fall from 1 mm reaches 0.14 m/s. It is
// only a warning. No measured case changes between half and twice the value (constants.md).
constexpr double kLandingTolerance = 0.15;

double landing_speed(const JudgedMotion& motion, Side side, const ContactInterval& contact) {
  const int k = contact.first;
  RobotData data(motion.model);
  const auto place = [&](int sample) {
    update_positions(motion.model, motion.series.samples[sample].state, data);
    return Vector3d(sole_pose(motion.model, data, side).translation());
  };
  const double rise = contact.sole.linear().col(2).dot(place(k) - place(k - 1));
  return -rise / motion.series.dt;
}

void judge_landings(JudgedMotion& motion) {
  const double limit = motion.tolerance(FindingKind::landing_speed);
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    for (const ContactInterval& contact : motion.plan.intervals[foot]) {
      if (!contact.contact || contact.first == 0) continue;
      const double speed = landing_speed(motion, side, contact);
      motion.raise(FindingKind::landing_speed, speed, contact.first, foot);
      if (speed > limit)
        motion.add(FindingKind::landing_speed, foot, contact.first, speed, limit, speed, 0,
                   Severity::warning);
    }
  }
}

// ---- landing at the right place

// Maps sole_deviation() to the offset of a sole from its place without the height: two lengths
// along the ground, and the rotations about three axes times half the sole's size [m].
Eigen::Matrix<double, 5, 6> offset_rows(const RobotModel& model, Side side,
                                        const Isometry3d& place) {
  double reach = 0;
  for (const Eigen::Vector2d& v : model.sole(side).polygon) reach = std::max(reach, v.norm());
  Eigen::Matrix<double, 5, 6> rows = Eigen::Matrix<double, 5, 6>::Zero();
  rows.topLeftCorner<2, 3>() = place.linear().leftCols<2>().transpose();
  rows.bottomRightCorner<3, 3>() = reach * place.linear().transpose();
  return rows;
}

// Ten rows: factor * height^2 -+ offset.
struct Landing {
  Isometry3d place;
  Eigen::Matrix<double, 5, 6> offset;  // rows of offset_rows()
  double factor = 0;                   // factor on the squared height [1/m]

  Vector3d normal() const { return place.linear().col(2); }

  VectorXd value(const Isometry3d& sole) const {
    const Eigen::Matrix<double, 5, 1> off = offset * sole_deviation(sole, place);
    const double height = height_over(place, sole);
    VectorXd values(10);
    values << off, -off;
    return (factor * height * height - values.array()).matrix();
  }

  MatrixXd rate(const Isometry3d& sole, const MatrixXd& motion) const {
    const MatrixXd off = offset * deviation_rates(sole, place, motion);
    MatrixXd rates(10, motion.cols());
    rates << -off, off;
    rates.rowwise() +=
        2 * factor * height_over(place, sole) * normal().transpose() * motion.topRows<3>();
    return rates;
  }

  void add_curvature(const Isometry3d& sole, const VectorXd& l, PoseCurvature& sum) const {
    const Vector6d off = offset.transpose() * (l.tail<5>() - l.head<5>());
    sum.c += off.head<3>() + 2 * factor * l.sum() * height_over(place, sole) * normal();
    sum.K += turn_curvature(off.tail<3>(), sole, place);
    sum.height = normal();
    sum.square += 2 * factor * l.sum();
  }
};

SoleRows rows_of(Side side, const Landing& landing) {
  return {.side = side,
          .value = [landing](const Isometry3d& sole) { return landing.value(sole); },
          .rate = [landing](const Isometry3d& sole,
                            const MatrixXd& motion) { return landing.rate(sole, motion); },
          .add_curvature = [landing](const Isometry3d& sole, const VectorXd& l,
                                     PoseCurvature& sum) { landing.add_curvature(sole, l, sum); }};
}

// ---- the motion's own swings

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

int samples_of(double period, double dt) { return std::max(1, static_cast<int>(period / dt)); }

// The largest offset / height^2 of a swing near one of its places.
double landing_factor(const RowSite& site, Side side, const ContactInterval& swing,
                      const Isometry3d& place, bool lands) {
  const auto& settings = site.settings.swing;
  const int every = samples_of(settings.landing_period, site.series.dt);
  const int count = std::min((swing.last - swing.first) / 2,
                             static_cast<int>(settings.near_place / site.series.dt));
  RobotData data(site.model);
  double most = 0;
  for (int k = 0; k < count; k += every) {
    const int sample = lands ? swing.last - k : swing.first + k;
    update_positions(site.model, site.series.samples[sample].state, data);
    const Isometry3d sole = sole_pose(site.model, data, side);
    const double height = height_over(place, sole);
    if (height < settings.lowest_measured) continue;
    const double offset = landing_offset(site.model, side, sole, place).cwiseAbs().maxCoeff();
    most = std::max(most, (offset - settings.place_slack) / (height * height));
  }
  return most;
}

// A factor times the median over swings of offset / height^2; the median ignores a faulty swing.
double own_landing_factor(const RowSite& site) {
  std::vector<double> factors;
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = site.plan.intervals[static_cast<int>(side)];
    for (size_t i = 0; i < intervals.size(); ++i) {
      if (intervals[i].contact) continue;
      if (i > 0)
        factors.push_back(landing_factor(site, side, intervals[i], intervals[i - 1].sole, false));
      if (i + 1 < intervals.size())
        factors.push_back(landing_factor(site, side, intervals[i], intervals[i + 1].sole, true));
    }
  }
  const auto& settings = site.settings.swing;
  const double least = 1 / (settings.least_landing_height * site.series.samples.front().cog.z());
  if (factors.empty()) return least;
  return std::max(least, settings.own_landing_factor * median_of(factors));
}

// The height of the lowest corner in the middle half of a swing, over both of its places.
double lowest_height(const RowSite& site, Side side, const std::vector<ContactInterval>& intervals,
                     size_t i) {
  const int every = samples_of(site.settings.swing.height_period, site.series.dt);
  const int quarter = (intervals[i].last - intervals[i].first) / 4;
  RobotData data(site.model);
  double lowest = kUnbounded;
  for (int k = intervals[i].first + quarter; k <= intervals[i].last - quarter; k += every) {
    update_positions(site.model, site.series.samples[k].state, data);
    const Isometry3d sole = sole_pose(site.model, data, side);
    for (size_t j : {i - 1, i + 1})
      lowest = std::min(lowest, sole_error(site.model.sole(side), sole, intervals[j].sole).lowest);
  }
  return lowest;
}

// The median of this height over the swings of the motion.
double own_foot_clearance(const RowSite& site) {
  std::vector<double> heights;
  for (Side side : {Side::left, Side::right}) {
    const auto& intervals = site.plan.intervals[static_cast<int>(side)];
    for (size_t i = 1; i + 1 < intervals.size(); ++i)
      if (!intervals[i].contact) heights.push_back(lowest_height(site, side, intervals, i));
  }
  return heights.empty() ? 0 : median_of(heights);
}

// ---- placement of the rows

const RowKind kLandingRows = {.name = "landing",
                              .unit = &RowPrices::length,
                              .soft_goal = &RowPrices::landing,
                              .relaxed = &RowPrices::landing,
                              .beyond_check = true,
                              .order = {2, 2}};
const RowKind kSwingRows = {.name = "swing",
                            .unit = &RowPrices::length,
                            .relaxed = &RowPrices::foot,
                            .beyond_check = true,
                            .order = {2, 3}};
const RowKind kFootClearanceRows = {.name = "foot_clearance",
                                    .unit = &RowPrices::length,
                                    .soft_goal = &RowPrices::landing,
                                    .relaxed = &RowPrices::landing,
                                    .beyond_check = true,
                                    .order = {2, 4}};

// The height of the lowest corner over the ground in the watched samples.
double watched_height(const RowSite& site, int point, Side side) {
  const Isometry3d& ground = site.points[point].ground[static_cast<int>(side)];
  double lowest = kUnbounded;
  RobotData data(site.model);
  for (const CommandSample* sample : site.watched(point)) {
    update_positions(site.model, sample->state, data);
    const Isometry3d sole = sole_pose(site.model, data, side);
    lowest = std::min(lowest, sole_error(site.model.sole(side), sole, ground).lowest);
  }
  return lowest;
}

bool is_near_place(const RowSite& site, int sample, const ContactInterval& swing) {
  const int last = static_cast<int>(site.series.samples.size()) - 1;
  const int after = swing.first == 0 ? last : sample - swing.first;
  const int before = swing.last == last ? last : swing.last - sample;
  return std::min(after, before) * site.series.dt <= site.settings.swing.near_place;
}

bool is_in_the_middle(int sample, const ContactInterval& swing) {
  const int quarter = (swing.last - swing.first) / 4;
  return sample >= swing.first + quarter && sample <= swing.last - quarter;
}

void place_swing_rows(RowSite& site) {
  const auto& settings = site.settings.swing;
  const bool goals = site.settings.swing_goals;
  const double factor = own_landing_factor(site);
  const double clearance = std::max(0.0, settings.height_share * own_foot_clearance(site));
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    const int corners = static_cast<int>(site.model.sole(side).polygon.size());
    for (int i = 0; i < site.count(); ++i) {
      const CollocationPoint& at = site.points[i];
      if (at.contact[foot] || site.settings.locked_feet[foot] || !at.only.empty()) continue;
      const ContactInterval& swing = site.plan.at(side, at.sample);
      if (goals && is_near_place(site, at.sample, swing)) {
        const Landing landing = {at.place[foot], offset_rows(site.model, side, at.place[foot]),
                                 factor};
        site.add(kLandingRows, i, foot, rows_of(side, landing), 10, -settings.place_slack,
                 kUnbounded);
      }
      const double lowest = watched_height(site, i, side);
      const SoleRows heights = height_rows(site.model, side, at.ground[foot]);
      if (lowest < settings.watched_height)
        site.add(kSwingRows, i, foot, heights, corners, -site.settings.sole_position, kUnbounded);
      if (goals && is_in_the_middle(at.sample, swing) &&
          site.settings.watched_share * lowest < clearance)
        site.add(kFootClearanceRows, i, foot, heights, corners, clearance, kUnbounded);
    }
  }
}

Advice landing_advice(const JudgedMotion&, const FindingWindow& window) {
  return "let the " + std::string(name_of(foot_of(window.worst))) +
         " foot come down more slowly than " + text::fixed(window.worst.limit, 2) +
         " m/s: use a lower lift, or give the swing more time";
}

}  // namespace

Eigen::Matrix<double, 5, 1> landing_offset(const RobotModel& model, Side side,
                                           const Isometry3d& actual, const Isometry3d& place) {
  return offset_rows(model, side, place) * sole_deviation(actual, place);
}

const Limit& swing_foot_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::landing_speed,
                    .limit_class = LimitClass::rate,
                    .unit = "m/s",
                    .tolerance = kLandingTolerance,
                    .meaning = "speed of a sole towards the ground when the sole lands. The "
                               "finding is only a warning",
                    .figure = {.key = "max_landing_speed_m_s",
                               .label = "largest speed of a landing sole",
                               .unit = "m/s",
                               .line = 16},
                    .place = foot_place,
                    .advice = landing_advice}},
      .judge_motion = judge_landings,
      .place_rows = place_swing_rows};
  return limit;
}

}  // namespace ayumi
