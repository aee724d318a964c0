// Plants faults with a known cause at random into the tables of sound motions of several robots. It
// counts how often the check calls the planted fault its first error and its only error, and tests
// whether two faults that are far apart both remain errors.
//   ayumi_planted_causes [FAULTS=500] [SEED=1] [FOLDER OF ANOTHER ROBOT ...]
// The exit code is 1 if fewer than 97 % are the first error, fewer than 90 % the only one, or one
// of two faults is hidden.

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/faults.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

using Kinds = std::set<FindingKind>;

struct Motion {
  std::string name;
  const RobotModel* robot;
  Pattern pattern;  // the pattern as a table
  double friction;  // friction that the motion needs
  double pace;      // largest share of a speed limit
};

struct Fault {
  std::string name;
  Kinds kinds;                // kinds of errors that this fault may cause
  double begin = 0, end = 0;  // beginning and end of the fault [s]
};

ConsistencyReport judged(const RobotModel& robot, const Pattern& pattern) {
  CheckOptions options;
  options.friction = pattern.world.friction;
  options.profile = pattern.profile;
  options.threads = 1;
  return check_consistency(robot, sample(robot, pattern, {.threads = 1}), options);
}

void add_motion(std::vector<Motion>& motions, const RobotModel& robot, const std::string& name,
                const std::function<Pattern()>& make) {
  try {
    Pattern pattern = make();
    pattern.robot = robot.name();
    const ConsistencyReport sound = judged(robot, pattern);
    Pattern table = baked(robot, pattern);
    if (!sound.consistent || !judged(robot, table).consistent) {
      std::printf("%s: %s is not consistent and left out\n", robot.name().c_str(), name.c_str());
      return;
    }
    motions.push_back({name, &robot, std::move(table),
                       sound.summary[FindingKind::friction] * pattern.world.friction,
                       sound.summary[FindingKind::joint_speed]});
  } catch (const Error& error) {
    std::printf("%s: %s is left out: %s\n", robot.name().c_str(), name.c_str(), error.what());
  }
}

std::vector<Motion> motions_of(const RobotModel& robot) {
  std::vector<Motion> motions;
  WalkParameters steps = walk_defaults(robot);
  steps.steps = 3;
  const auto walk = [&](const std::string& name, const std::function<void(WalkParameters&)>& how) {
    WalkParameters changed = steps;
    how(changed);
    add_motion(motions, robot, name, [&] { return walk_pattern(robot, changed); });
  };
  walk("walk", [](WalkParameters&) {});
  walk("walk backwards", [](WalkParameters& w) { w.stride *= -0.6; });
  walk("turn", [](WalkParameters& w) { w.stride *= 0.5, w.turn = 0.06; });
  walk("steps in place", [](WalkParameters& w) { w.stride = 0; });
  add_motion(motions, robot, "squat", [&] { return squat_pattern(robot, squat_defaults(robot)); });
  add_motion(motions, robot, "sway", [&] { return sway_pattern(robot, sway_defaults(robot)); });
  add_motion(motions, robot, "bow", [&] { return bow_pattern(robot, bow_defaults(robot)); });
  add_motion(motions, robot, "kick", [&] { return kick_pattern(robot, kick_defaults(robot)); });
  return motions;
}

double duration_of(const Pattern& pattern) { return pattern.phases.back().until; }

/// A time in the middle part of a phase in which this foot stands, and the length of that phase.
std::pair<double, double> stance(const Pattern& pattern, Side side, Dice& dice) {
  std::vector<std::pair<double, double>> found;
  double begin = 0;
  for (const Phase& phase : pattern.phases) {
    if (phase.support == Support::both || phase.support == on(side))
      if (phase.until - begin > 0.2) found.emplace_back(begin, phase.until);
    begin = phase.until;
  }
  if (found.empty()) return {0, 0};
  const auto [from, to] = found[dice.below(found.size())];
  return {0.5 * (from + to), to - from};
}

std::vector<int> joints_of(const RobotModel& robot, bool legs) {
  std::vector<int> joints;
  for (int dof = 0; dof < robot.dof_count(); ++dof) {
    bool in_leg = false;
    for (const Side side : {Side::left, Side::right})
      for (const int joint : robot.leg(side)) in_leg = in_leg || joint == dof;
    if (in_leg == legs && robot.dofs()[dof].limited && !robot.dofs()[dof].prismatic)
      joints.push_back(dof);
  }
  return joints;
}

/// Plants the fault. Returns nothing if the motion has no place for it.
std::optional<Fault> plant(const Motion& motion, Pattern& p, size_t which, Dice& dice) {
  using enum FindingKind;
  const RobotModel& robot = *motion.robot;
  DenseTable& table = *p.table;
  const double all = duration_of(p);
  const double center = all * dice.between(0.3, 0.7), width = dice.between(0.3, 0.6);
  const Side side = dice.below(2) == 0 ? Side::left : Side::right;
  const double sign = dice.sign();
  const double height = starting_height(robot);
  const auto within = [&](const std::string& name, const Kinds& kinds, double at, double lasts) {
    return Fault{name, kinds, at - 0.5 * lasts, at + 0.5 * lasts};
  };
  switch (which) {
    case 0:
    case 1: {
      const std::vector<int> joints = joints_of(robot, which == 1);
      if (joints.empty()) return {};
      const int dof = joints[dice.below(joints.size())];
      const Dof& joint = robot.dofs()[dof];
      const double now = table.theta(std::lround(center / table.dt), dof);
      const double goal =
          sign > 0 ? joint.upper + dice.between(0.03, 0.2) : joint.lower - dice.between(0.03, 0.2);
      const double lasts = std::min(0.6 * all, std::max(0.5, std::abs(goal - now)));
      move_joint(robot, table, joint.name, goal - now, center, lasts);
      return within(which == 0 ? "arm joint beyond its range" : "leg joint beyond its range",
                    {joint_position}, center, lasts);
    }
    case 2: {
      const std::vector<int> joints = joints_of(robot, false);
      if (joints.empty()) return {};
      const int dof = joints[dice.below(joints.size())];
      const Dof& joint = robot.dofs()[dof];
      const double now = table.theta(std::lround(center / table.dt), dof);
      const double room = sign > 0 ? joint.upper - now : now - joint.lower;
      const double speed = dice.between(1.3, 2) * robot.limits(p.profile).speed[dof];
      const double size = 0.8 * std::min(room, 1.0), lasts = size * 4.08 / speed;
      if (lasts < 0.03) return {};
      move_joint(robot, table, joint.name, sign * size, center, lasts);
      return within("arm joint too fast", {joint_speed, servo_step, table_step, joint_torque},
                    center, lasts);
    }
    case 3:
    case 4:
    case 5: {
      if (robot.leg(side).size() != 6) return {};
      const auto [at, lasts] = stance(p, side, dice);
      if (lasts == 0) return {};
      const double size = height * dice.between(0.01, 0.03),
                   bump_lasts = std::min(0.9 * lasts, 0.6);
      const double turn = dice.between(0, 2 * M_PI);
      const Eigen::Vector3d way = which == 3   ? Eigen::Vector3d(std::cos(turn), std::sin(turn), 0)
                                  : which == 4 ? Eigen::Vector3d(0, 0, -1)
                                               : Eigen::Vector3d(0, 0, 1);
      slip_foot(robot, table, side, size * way, at, bump_lasts);
      return within(which == 3   ? "standing foot slides"
                    : which == 4 ? "standing foot in the ground"
                                 : "standing foot above the ground",
                    which == 3   ? Kinds{foot_slip}
                    : which == 4 ? Kinds{foot_penetration}
                                 : Kinds{foot_float},
                    at, bump_lasts);
    }
    case 6: {
      std::vector<size_t> swings;
      for (size_t i = 0; i + 1 < p.phases.size(); ++i)
        if (p.phases[i].swing) swings.push_back(i);
      if (swings.empty()) return {};
      Phase& phase = p.phases[swings[dice.below(swings.size())]];
      const double landing = phase.until - dice.between(0.05, 0.09);
      phase.until = landing;
      return Fault{"contact too early", {foot_float}, landing, landing};
    }
    case 7: {
      const int axis = static_cast<int>(dice.below(3));
      const double size = sign * height * dice.between(0.03, 0.08);
      for_rows(table,
               [&](double t, size_t k) { table.cog[k][axis] += size * bump(t, center, width); });
      return within("COG command moved", {cog_residual}, center, width);
    }
    case 8: {
      const double factor = 1 + sign * dice.between(0.06, 0.2);
      for_rows(table, [&](double t, size_t k) {
        if (std::abs(t - center) < 0.5 * width) table.fz[k] *= factor;
      });
      return within("f_z command scaled", {fz_residual}, center, width);
    }
    case 9: {
      const double way = sign * height * dice.between(0.4, 0.6);
      for_rows(table,
               [&](double t, size_t k) { table.zmp[k].y() += way * bump(t, center, width); });
      return within("ZMP command outside", {support_margin}, center, width);
    }
    case 10:
      if (motion.friction < 0.02) return {};
      p.world.friction = motion.friction * dice.between(0.5, 0.9);
      return Fault{"slippery ground", {friction}, 0, all};
    default: {
      const double share = motion.pace / dice.between(1.2, 2);
      if (!(share > 0.1 && share < 1)) return {};
      squeeze(p, share);
      return Fault{"played too fast", {joint_speed, joint_torque, servo_step}, 0, all};
    }
  }
}

constexpr size_t kFaults = 12;

bool is_of(const Finding& f, const Fault& fault) {
  return fault.kinds.contains(f.kind) && f.end >= fault.begin - 0.01 && f.begin <= fault.end + 0.01;
}

struct Count {
  int planted = 0, first = 0, alone = 0, silent = 0;
};

void print(const std::string& name, const Count& c) {
  std::printf("%-32s %4d planted, %4d first error, %4d only error, %3d without an error\n",
              name.c_str(), c.planted, c.first, c.alone, c.silent);
}

std::string words(const ConsistencyReport& report) {
  std::string text;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error)
      text += std::string(" ") + name_of(f.kind) + " " + f.where + " " + std::to_string(f.begin) +
              ".." + std::to_string(f.end);
  return text;
}

}  // namespace

int main(int count, char** arguments) {
  const int wanted = count > 1 ? std::max(1, std::atoi(arguments[1])) : 500;
  const auto seed = static_cast<std::uint64_t>(count > 2 ? std::atoi(arguments[2]) : 1);
  std::vector<RobotModel> robots;
  for (const char* name : {"hoap1", "humanoid30"})
    robots.push_back(load_robot(std::string(AYUMI_SOURCE_DIR "/robots/") + name));
  for (int i = 3; i < count; ++i) robots.push_back(load_robot(arguments[i]));
  std::vector<Motion> motions;
  for (const RobotModel& robot : robots)
    for (Motion& motion : motions_of(robot)) motions.push_back(std::move(motion));
  Dice dice(seed);
  std::map<std::string, Count> by_fault;
  Count sum;
  int pairs = 0, hidden = 0;
  for (int tries = 0; sum.planted < wanted && tries < 5 * wanted; ++tries) {
    const Motion& motion = motions[dice.below(motions.size())];
    Pattern pattern = motion.pattern;
    const std::optional<Fault> fault = plant(motion, pattern, dice.below(kFaults), dice);
    if (!fault) continue;
    const ConsistencyReport report = judged(*motion.robot, pattern);
    // Errors are in order of time; of those that begin together, any may be the first.
    std::vector<const Finding*> errors;
    for (const Finding& f : report.findings)
      if (f.severity == Severity::error) errors.push_back(&f);
    Count& c = by_fault[fault->name];
    if (errors.empty()) {  // the motion keeps every limit, so that there is nothing to name
      ++c.silent;
      ++sum.silent;
      continue;
    }
    const auto of_fault = [&](const Finding* f) { return is_of(*f, *fault); };
    const bool first = of_fault(errors.front());
    const bool alone = std::all_of(errors.begin(), errors.end(), of_fault);
    for (Count* each : {&c, &sum}) {
      ++each->planted;
      each->first += first;
      each->alone += alone;
    }
    if (!first || !alone)
      std::printf("%s, %s, %s at %.3f..%.3f:%s\n", motion.robot->name().c_str(),
                  motion.name.c_str(), fault->name.c_str(), fault->begin, fault->end,
                  words(report).c_str());
    // A second fault far from the first one: the command of f_z is wrong in the first or last
    // tenth.
    const double all = duration_of(pattern);
    if (fault->name == "played too fast" || fault->name == "f_z command scaled" || all < 2)
      continue;
    const bool late = 0.5 * (fault->begin + fault->end) < 0.5 * all;
    const double from = late ? 0.95 * all : 0.02 * all, to = late ? 0.98 * all : 0.05 * all;
    if (fault->begin < to + 0.3 && fault->end > from - 0.3 && fault->name != "slippery ground")
      continue;
    for_rows(*pattern.table, [&](double t, size_t k) {
      if (t > from && t < to) pattern.table->fz[k] *= 1.2;
    });
    const Fault other = {"", {FindingKind::fz_residual}, from, to};
    bool one = false, two = false;
    const ConsistencyReport both = judged(*motion.robot, pattern);
    for (const Finding& f : both.findings) {
      if (f.severity != Severity::error) continue;
      one = one || is_of(f, *fault) || !first;
      two = two || is_of(f, other);
    }
    ++pairs;
    if (one && two) continue;
    ++hidden;
    std::printf("hidden: %s, %s, %s and f_z at %.3f..%.3f:%s\n", motion.robot->name().c_str(),
                motion.name.c_str(), fault->name.c_str(), from, to, words(both).c_str());
  }
  for (const auto& [name, c] : by_fault) print(name, c);
  print("all", sum);
  std::printf("%.1f %% first, %.1f %% alone; of %d pairs of faults, one is hidden in %d\n",
              100.0 * sum.first / sum.planted, 100.0 * sum.alone / sum.planted, pairs, hidden);
  return 100 * sum.first >= 97 * sum.planted && 100 * sum.alone >= 90 * sum.planted && hidden == 0
             ? 0
             : 1;
}
