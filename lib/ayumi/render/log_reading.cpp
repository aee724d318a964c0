#include "ayumi/render/log_reading.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "ayumi/base/error.hpp"
#include "ayumi/base/in_brackets.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

/// The vector between a and b at the fraction `share` of the distance from a; if their sizes differ
/// (one is empty), the result is a.
template <typename Vector>
Vector mix(const Vector& a, const Vector& b, double share) {
  if (a.size() != b.size()) return a;
  return a + share * (b - a);
}

BasePose mix(const BasePose& a, const BasePose& b, double share) {
  return {mix(a.position, b.position, share), a.attitude.slerp(share, b.attitude)};
}

/// The intervals of ticks in which exactly these feet (left, right) are planned on the ground.
std::vector<FlightRecord> stretches(const SimulationLog& log, const std::array<bool, 2>& feet) {
  std::vector<FlightRecord> result;
  bool before = false;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const bool now = log.samples[k].planned_contact == feet;
    const double t = static_cast<double>(k) * log.dt;
    if (now && !before) result.push_back({t, t});
    if (now) result.back().end = t + log.dt;
    before = now;
  }
  return result;
}

/// An instant that a picture should show. Instants with a higher weight come first.
struct Candidate {
  double t = 0;       ///< time [s]
  double weight = 0;  ///< for postures, the size of the move [rad]; events have a higher weight
  /// Whether its posture is similar to another one, but is worth a picture nevertheless.
  bool looks_like_another = false;
};

// Weights of events. They are above that of every posture, because a joint moves by less than 10
// rad.
constexpr double kPushWeight = 400, kFallWeight = 300, kApexWeight = 200, kStepWeight = 0.05;

// The smallest move of a joint that is worth a picture [rad], and the same as a share of the
// largest move of the run. Chosen: 3 degrees can just be seen in a picture of 400 pixels. With half
// of the value, servo errors count; with twice, a nod is missed.
constexpr double kSeenMove = 0.05, kSeenShare = 0.15;

// Share of the move within which an extreme that is held counts as reached. Chosen: in a quintic
// between rests, 2 % of the distance are left after 86 % of the time.
constexpr double kReached = 0.02;
// A curve that stays near an extreme for less than this time only passes it and does not rest there
// [s]. Chosen: a kick or a nod stays near its end for a quarter of a second.
constexpr double kPassed = 0.5;

/// Adds the instants at which a curve turns back or comes to rest after a move of at least `least`,
/// with the sizes of these moves.
void add_turns(const std::vector<double>& values, double dt, size_t first, double least,
               std::vector<Candidate>& out) {
  if (values.empty()) return;
  size_t low = 0, high = 0, from = 0;  // the extremes since the last turn, and that turn
  int direction = 0;
  const auto turn = [&](size_t at) {
    // Limited to a value below the weight of every event.
    const double move = std::min(10.0, std::abs(values[at] - values[from]));
    size_t reached = from;
    const auto near = [&](size_t k) { return std::abs(values[k] - values[at]) <= kReached * move; };
    while (reached < at && !near(reached)) ++reached;
    size_t left = at;
    while (left + 1 < values.size() && near(left + 1)) ++left;
    if (static_cast<double>(left - reached) * dt < kPassed) reached = at;
    // The place where the move began was already shown.
    const bool back = std::abs(values[at] - values[0]) < 0.3 * move;
    out.push_back({static_cast<double>(first + reached) * dt, back ? 0.5 * move : move});
    from = at;
  };
  for (size_t k = 1; k < values.size(); ++k) {
    if (values[k] > values[high]) high = k;
    if (values[k] < values[low]) low = k;
    if (direction >= 0 && values[high] - values[k] > least) {
      if (direction > 0)
        turn(high);
      else
        from = high;
      direction = -1;
      low = k;
    } else if (direction <= 0 && values[k] - values[low] > least) {
      if (direction < 0)
        turn(low);
      else
        from = low;
      direction = 1;
      high = k;
    }
  }
  // The last extreme is the value that the curve reaches and keeps.
  if (direction != 0) turn(direction > 0 ? high : low);
}

/// Postures of the ticks first, ..., last - 1 in which joints, the trunk or the COG turn back.
std::vector<Candidate> turning_postures(const SimulationLog& log, size_t first, size_t last) {
  std::vector<std::vector<double>> curves;
  const auto add = [&](const auto& value) {
    std::vector<double> curve;
    for (size_t k = first; k < last; ++k) curve.push_back(value(log.samples[k]));
    curves.push_back(std::move(curve));
  };
  for (Eigen::Index i = 0; i < log.samples.front().state.theta.size(); ++i)
    add([i](const SimulationSample& s) { return s.state.theta[i]; });
  // The movement of the COG is divided by half its height above the ground, as if that were the arm
  // of a joint.
  const double height = std::max(1e-3, log.samples.front().cog.z() - log.world.height);
  add([&](const SimulationSample& s) { return 2 * s.cog.z() / height; });
  for (const int axis : {0, 1})  // the lean of the trunk
    add([axis](const SimulationSample& s) {
      return (s.state.base.attitude * Eigen::Vector3d::UnitZ())[axis];
    });
  double most = 0;
  for (const auto& curve : curves) {
    if (curve.empty()) continue;
    const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
    most = std::max(most, *high - *low);
  }
  std::vector<Candidate> out;
  for (const auto& curve : curves)
    add_turns(curve, log.dt, first, std::max(kSeenMove, kSeenShare * most), out);
  return out;
}

/// The tick that is nearest to a time.
size_t tick_at(const SimulationLog& log, double t) {
  const double last = static_cast<double>(log.samples.size() - 1);
  return static_cast<size_t>(std::clamp(std::round(t / log.dt), 0.0, last));
}

/// The time at which the COG is highest in a flight [s]. If several samples have the same height,
/// it is the middle of their times.
double apex_of(const SimulationLog& log, const FlightRecord& flight) {
  const size_t first = tick_at(log, flight.begin), last = tick_at(log, flight.end - log.dt);
  size_t low = first, high = first;
  for (size_t k = first; k <= last; ++k) {
    if (log.samples[k].cog.z() > log.samples[high].cog.z() + 1e-9) low = high = k;
    if (log.samples[k].cog.z() > log.samples[low].cog.z() - 1e-9) high = k;
  }
  return 0.5 * static_cast<double>(low + high + (high == last ? 1 : 0)) * log.dt;
}

/// The time at which the robot has yielded most after each flight. The posture is similar to that
/// of the stoop before it.
std::vector<Candidate> landings(const SimulationLog& log, const std::vector<FlightRecord>& flown) {
  // Time within which a robot yields [s]. Chosen: twice the time of a landing from 0.1 m.
  constexpr double kYield = 0.5;
  std::vector<Candidate> out;
  for (size_t i = 0; i < flown.size(); ++i) {
    const double next = i + 1 < flown.size() ? flown[i + 1].begin : duration(log);
    const size_t first = tick_at(log, flown[i].end),
                 last = tick_at(log, std::min(next, flown[i].end + kYield));
    size_t low = first;
    for (size_t k = first; k <= last; ++k)
      if (log.samples[k].cog.z() < log.samples[low].cog.z() - 1e-9) low = k;
    const SimulationSample& highest = log.samples[tick_at(log, apex_of(log, flown[i]))];
    const double drop = highest.cog.z() - log.samples[low].cog.z();
    const double height = std::max(1e-3, highest.cog.z() - log.world.height);
    // The drop of the COG is divided by half its height, as in turning_postures().
    if (2 * drop / height >= kSeenMove)
      out.push_back({static_cast<double>(low) * log.dt, 2 * drop / height, true});
  }
  return out;
}

/// The difference of two postures: the largest change of a joint [rad], or the change of the COG
/// divided by half its height, as if that were the arm of a joint.
double difference(const SimulationLog& log, double a, double b) {
  const SimulationSample &one = log.samples[tick_at(log, a)], &two = log.samples[tick_at(log, b)];
  const double height = std::max(1e-3, std::abs(one.cog.z() - log.world.height));
  double most = std::max(one.planned_contact != two.planned_contact ? kSeenMove : 0,
                         2 * (one.cog - two.cog).norm() / height);
  if (one.state.theta.size() > 0)
    most = std::max(most, (one.state.theta - two.state.theta).cwiseAbs().maxCoeff());
  return most;
}

/// The first time at which a joint has moved farthest since the start [s]; the middle of the run if
/// no joint moves. The place of the robot does not count, because a walk is farthest from its start
/// at its end, where the robot has the posture of the start again.
double most_changed_at(const SimulationLog& log) {
  // Postures that differ by less count as one posture that is held [rad]. Chosen: larger than
  // rounding errors.
  constexpr double kSame = 1e-6;
  const Eigen::VectorXd& start = log.samples.front().state.theta;
  double most = kSeenMove, at = 0.5 * duration(log);
  if (start.size() == 0) return at;
  for (size_t k = 1; k < log.samples.size(); ++k) {
    const double moved = (log.samples[k].state.theta - start).cwiseAbs().maxCoeff();
    if (moved <= most + kSame) continue;
    most = moved;
    at = static_cast<double>(k) * log.dt;
  }
  return at;
}

/// The smallest difference between the posture at t and the postures at these times.
double news_at(const SimulationLog& log, double t, const std::vector<double>& times) {
  double least = INFINITY;
  for (const double other : times) least = std::min(least, difference(log, t, other));
  return least;
}

/// Takes candidates by weight until there are `count` times. No candidate is nearer to another than
/// `apart`, except events, which may have any distance, and landings, which may be nearer. No
/// posture is taken twice. Of candidates with about the same weight, those come first in which the
/// robot stands on other feet than at the nearest time that was taken, and among these the one that
/// is farthest from this time.
void take(const SimulationLog& log, std::vector<Candidate> candidates, size_t count, double apart,
          std::vector<double>& times) {
  // Ratio of weights that are alike. Chosen: the steps of a walk differ by less.
  constexpr double kAlike = 1.25;
  // Smallest distance of the largest moves from each other and from the ends [s]. Chosen: half of
  // the time of a quick step.
  constexpr double kShortest = 0.2;
  // Smallest distance of a landing from other times [s]. Chosen: within this time, two pictures of
  // one landing look the same. With half of the value, the most bent knee and the lowest COG of one
  // landing can be two pictures. With twice the value, the landing of a low hop can be left out: a
  // fall of 10 mm takes 45 ms, so that the COG can be lowest less than 0.1 s after the apex.
  constexpr double kLanding = 0.05;
  double heaviest = 0;
  for (const Candidate& c : candidates)
    if (c.weight < kApexWeight) heaviest = std::max(heaviest, c.weight);
  while (times.size() < count) {
    const Candidate* best = nullptr;
    std::tuple<double, bool, double> most;
    for (const Candidate& c : candidates) {
      double away = INFINITY, nearest = c.t;
      for (const double t : times)
        if (std::abs(t - c.t) < away) away = std::abs((nearest = t) - c.t);
      const double gap = c.weight >= kApexWeight         ? 1e-6
                         : c.looks_like_another          ? std::min(apart, kLanding)
                         : kAlike * c.weight >= heaviest ? std::min(apart, kShortest)
                                                         : apart;
      if (away < gap) continue;
      if (c.weight < kApexWeight && !c.looks_like_another && news_at(log, c.t, times) < kSeenMove)
        continue;
      const bool other = log.samples[tick_at(log, c.t)].planned_contact !=
                         log.samples[tick_at(log, nearest)].planned_contact;
      const std::tuple value(std::floor(std::log(c.weight) / std::log(kAlike)), other, away);
      if (best && value <= most) continue;
      best = &c;
      most = value;
    }
    if (!best) return;
    times.push_back(best->t);
  }
}

/// Adds the postures that differ most from those at the times already chosen. If none differs, adds
/// the middle of the longest gap.
void fill(const SimulationLog& log, size_t count, std::vector<double>& times) {
  // Number of instants that are compared. Chosen: as many pictures of a run as a person can
  // distinguish.
  constexpr int kLooked = 100;
  // The smallest spacing as a share of an even one, and its largest value [s]; joints of a robot
  // that falls turn quickly. Chosen: a quarter, and half of the time of a quick step.
  constexpr double kApart = 0.25, kLongest = 0.1;
  std::sort(times.begin(), times.end());
  const double begin = times.front(), length = times.back() - begin;
  const double apart = std::min(kApart * length / static_cast<double>(count), kLongest);
  while (times.size() < count) {
    double best = 0, most = kSeenMove;
    for (int i = 1; i < kLooked; ++i) {
      const double t = begin + length * i / kLooked;
      const bool near = std::any_of(times.begin(), times.end(), [&](double other) {
        return std::abs(other - t) < apart - 1e-9;
      });
      const double news = near ? 0 : news_at(log, t, times);
      if (news <= most) continue;
      best = t;
      most = news;
    }
    size_t widest = 0;
    for (size_t i = 1; i + 1 < times.size(); ++i)
      if (times[i + 1] - times[i] > times[widest + 1] - times[widest] + 1e-9) widest = i;
    if (most <= kSeenMove) best = 0.5 * (times[widest] + times[widest + 1]);
    times.insert(std::upper_bound(times.begin(), times.end(), best), best);
  }
}

/// The time after which a robot that has fallen is no longer shown [s], because links without
/// collision shapes sink into the ground.
double sunk_at(const SimulationLog& log) {
  // Height of the COG below which a robot has sunk, as a share of its first height. Chosen: half of
  // that of a robot that lies on the floor.
  constexpr double kSunk = 0.1;
  const double height = log.samples.front().cog.z() - log.world.height;
  for (size_t k = tick_at(log, log.result.fell_at); k < log.samples.size(); ++k)
    if (log.samples[k].cog.z() - log.world.height < kSunk * height)
      return static_cast<double>(k) * log.dt;
  return duration(log);
}

/// The time at which the step or kick began if the robot stands on one foot at `t` [s]; otherwise
/// `t`.
double step_began(const SimulationLog& log, double t) {
  // Largest time before t [s]. Chosen: longer than the kicks of the examples, and short for a robot
  // that only stands on one foot.
  constexpr double kSlow = 2;
  size_t k = tick_at(log, t);
  const std::array<bool, 2> feet = log.samples[k].planned_contact;
  if (feet[0] == feet[1]) return t;
  while (k > 0 && log.samples[k - 1].planned_contact == feet) --k;
  return std::max(t - kSlow, static_cast<double>(k) * log.dt);
}

/// The part of a run around its pushes or flights [s]; the whole run if it has none, or if the
/// robot moves more elsewhere.
FlightRecord shown_part(const SimulationLog& log) {
  // The time shown before the flights, for a push-off, and after them, for the landing [s].
  constexpr double kBefore = 0.25, kAfter = 0.35;
  // The time from a push to the end of its effects, and the time shown after a fall [s].
  constexpr double kRecovery = 1.25;
  // Factor by which a move elsewhere must be larger to be shown as well. Chosen: steps of one walk
  // differ by less; a kick moves the knee by twice as much as the steps around it.
  constexpr double kLarger = 1.5;
  const std::vector<FlightRecord> flown = flights(log);
  const std::vector<PushRecord> pushed = pushes(log);
  FlightRecord part = {0, duration(log)};
  if (!flown.empty()) {
    part.begin = std::max(part.begin, flown.front().begin - kBefore);
    part.end = std::min(part.end, flown.back().end + kAfter);
  } else if (!pushed.empty()) {
    const double first = pushed.front().begin;
    part.begin = std::max(part.begin, std::min(step_began(log, first), first - kBefore));
    const double last = std::max(pushed.back().end, log.result.fell_at);
    part.end = std::min(part.end, last + kRecovery);
  }
  const auto largest = [&](size_t first, size_t last) {
    double most = kSeenMove;
    for (const Candidate& c : turning_postures(log, first, last)) most = std::max(most, c.weight);
    return most;
  };
  const size_t begin = tick_at(log, part.begin), end = tick_at(log, part.end);
  const double inside = kLarger * largest(begin, end);
  if (largest(0, begin) > inside) part.begin = 0;
  if (log.result.outcome != Outcome::fell && largest(end, log.samples.size()) > inside)
    part.end = duration(log);
  if (log.result.outcome == Outcome::fell) part.end = std::min(part.end, sunk_at(log));
  return part;
}

}  // namespace

std::string place_in_brackets(const SimulationLog& log, const JointShare& share) {
  return share.joint < 0 ? "" : in_brackets(log.joints[static_cast<size_t>(share.joint)], share.at);
}

double duration(const SimulationLog& log) {
  if (log.samples.empty())
    fail(ErrorCode::usage, "the run's log has no samples: there is nothing to show");
  return log.dt * static_cast<double>(log.samples.size() - 1);
}

SimulationSample sample_at(const SimulationLog& log, double t) {
  const double position = std::clamp(t, 0.0, duration(log)) / log.dt;
  // A time within a millionth of a tick counts as the time of this tick.
  const double nearest = std::round(position);
  const double before = std::abs(position - nearest) < 1e-6 ? nearest : std::floor(position);
  const auto index = static_cast<size_t>(before);
  const double share = std::max(0.0, position - before);
  if (share < 1e-6 || index + 1 >= log.samples.size()) return log.samples[index];
  SimulationSample sample = log.samples[index];
  const SimulationSample& next = log.samples[index + 1];
  sample.state.base = mix(sample.state.base, next.state.base, share);
  sample.command_base = mix(sample.command_base, next.command_base, share);
  sample.reference_base = mix(sample.reference_base, next.reference_base, share);
  const auto blend = [&](auto& value, const auto& after) { value = mix(value, after, share); };
  blend(sample.state.theta, next.state.theta);
  blend(sample.reference_theta, next.reference_theta);
  blend(sample.command_theta, next.command_theta);
  blend(sample.cog, next.cog);
  blend(sample.zmp, next.zmp);
  blend(sample.command_cog, next.command_cog);
  blend(sample.command_zmp, next.command_zmp);
  blend(sample.reference_cog, next.reference_cog);
  blend(sample.reference_zmp, next.reference_zmp);
  sample.fz += share * (next.fz - sample.fz);
  for (size_t side = 0; side < 2; ++side) {
    blend(sample.foot_force[side], next.foot_force[side]);
    blend(sample.foot_cop[side], next.foot_cop[side]);
  }
  return sample;
}

Eigen::Isometry3d floor_at(const SimulationLog& log, double t) {
  return floor_pose(log.world, floor_motions(log.scenario), t);
}

Eigen::Isometry3d ground_at(const SimulationLog& log, double t) {
  return floor_at(log, t) * Eigen::Translation3d(0, 0, log.world.height);
}

bool floor_moves(const SimulationLog& log) {
  return !log.world.motions.empty() || !floor_motions(log.scenario).empty();
}

Eigen::Isometry3d marked_ground(const SimulationLog& log, double t,
                                const SimulationSample& sample) {
  constexpr double kLevel = 5e-4;  // soles under load sink in by less, and steps are higher [m]
  Eigen::Isometry3d ground = ground_at(log, t);
  double height = 0;
  for (size_t side = 0; side < 2; ++side)
    if (sample.foot_force[side].norm() > 0.02 * sample.fz && sample.fz > 0)
      height = std::max(height, (ground.inverse() * sample.foot_cop[side]).z());
  if (height > kLevel) ground.translate(Eigen::Vector3d(0, 0, height));
  return ground;
}

std::vector<PushRecord> pushes(const SimulationLog& log) {
  std::vector<PushRecord> records;
  bool active = false;
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const SimulationSample& sample = log.samples[k];
    if (sample.push_force.squaredNorm() == 0) {
      active = false;
      continue;
    }
    const double t = static_cast<double>(k) * log.dt;
    if (!active)
      records.push_back({.begin = t,
                         .end = t,
                         .point = sample.push_point,
                         .from_cog = sample.push_point - sample.cog});
    active = true;
    PushRecord& record = records.back();
    record.end = t + log.dt;
    record.impulse += sample.push_force * log.dt;
    if (sample.push_force.norm() > record.peak.norm()) record.peak = sample.push_force;
  }
  return records;
}

std::string push_text(const PushRecord& push) {
  return push.end - push.begin <= 0.2 + 1e-9 ? text::brief(push.impulse.norm(), 3) + " N s"
                                             : text::brief(push.peak.norm(), 3) + " N";
}

std::vector<FlightRecord> flights(const SimulationLog& log) {
  return stretches(log, {false, false});
}

double telling_instant(const SimulationLog& log) {
  const std::vector<PushRecord> pushed = pushes(log);
  const std::vector<FlightRecord> flown = flights(log);
  const double last = duration(log);
  if (!pushed.empty()) return std::min(last, pushed.front().begin + 0.25);
  if (log.result.outcome == Outcome::fell) return std::min(last, log.result.fell_at);
  return flown.empty() ? most_changed_at(log) : 0.5 * (flown.front().begin + flown.front().end);
}

std::vector<double> telling_instants(const SimulationLog& log, int count) {
  if (count < 1) return {};
  if (count == 1) return {telling_instant(log)};
  const auto wanted = static_cast<size_t>(count);
  const FlightRecord part = shown_part(log);
  const std::vector<FlightRecord> flown = flights(log);
  std::vector<Candidate> candidates;
  const auto within = [&](double t) { return t >= part.begin && t <= part.end; };
  const auto add = [&](double t, double weight) {
    if (within(t)) candidates.push_back({t, weight});
  };
  for (const PushRecord& push : pushes(log))
    add(0.5 * (push.begin + std::min(push.end, part.end)), kPushWeight);
  if (log.result.outcome == Outcome::fell) add(log.result.fell_at, kFallWeight);
  for (const FlightRecord& flight : flown) add(apex_of(log, flight), kApexWeight);
  const size_t events = candidates.size();
  const bool fell = log.result.outcome == Outcome::fell;
  const size_t first = tick_at(log, part.begin);
  const size_t last = tick_at(log, fell ? log.result.fell_at : part.end) + 1;
  for (const Candidate& c : turning_postures(log, first, std::max(first, last)))
    candidates.push_back(c);
  for (const Candidate& c : landings(log, flown))
    if (within(c.t)) candidates.push_back(c);
  // In a walk, the middle of every step is a candidate.
  for (const std::array<bool, 2> feet : {std::array{true, false}, std::array{false, true}})
    for (const FlightRecord& step : stretches(log, feet)) {
      const double middle = 0.5 * (step.begin + step.end);
      const bool alone =
          std::none_of(candidates.begin() + static_cast<std::ptrdiff_t>(events), candidates.end(),
                       [&](const Candidate& c) { return c.t >= step.begin && c.t <= step.end; });
      if (alone) add(middle, kStepWeight);
    }
  std::vector<double> times;
  if (wanted <= events) {
    take(log, candidates, wanted, 0, times);
  } else {
    times = {part.begin};
    if (wanted > std::max<size_t>(2, 1 + events) && part.end > part.begin)
      times.push_back(part.end);
    // Pictures that are nearer to each other hardly differ.
    take(log, candidates, wanted, 0.4 * (part.end - part.begin) / std::max(1, count - 1), times);
    if (times.size() < wanted && times.size() == 1) times.push_back(part.end);
    if (times.size() > 1) fill(log, wanted, times);
  }
  std::sort(times.begin(), times.end());
  while (times.size() < wanted) times.push_back(part.end);
  return times;
}

std::string instant_text(const SimulationLog& log, double t) {
  const double half = 0.5 * log.dt + 1e-9;
  if (log.result.outcome == Outcome::fell && std::abs(t - log.result.fell_at) <= half)
    return "falls";
  for (const PushRecord& push : pushes(log))
    if (t >= push.begin - 1e-9 && t < push.end) return "push " + push_text(push);
  for (const FlightRecord& flight : flights(log))
    if (std::abs(t - apex_of(log, flight)) <= half) return "apex";
  return "";
}

double verdict_instant(const SimulationLog& log) {
  // Difference from the end below which the robot counts as standing as it will stand. Chosen: 2 mm
  // of 0.25 m and 1 degree are less than a picture shows.
  constexpr double kPlace = 0.008, kAngle = M_PI / 180;
  const double last = duration(log);
  if (log.result.outcome == Outcome::fell) return log.result.fell_at;
  if (log.result.outcome != Outcome::stands) return last;
  const SimulationSample& end = log.samples.back();
  size_t k = log.samples.size() - 1;
  for (; k > 0; --k) {
    const SimulationSample& s = log.samples[k - 1];
    const bool same = s.planned_contact == end.planned_contact && s.push_force.isZero(0) &&
                      (s.cog - end.cog).norm() <= kPlace * std::abs(end.cog.z()) &&
                      (s.state.theta - end.state.theta).cwiseAbs().maxCoeff() <= kAngle;
    if (!same) break;
  }
  return static_cast<double>(k) * log.dt;
}

}  // namespace ayumi
