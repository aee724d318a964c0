#pragma once
// Short HOAP-1 patterns with one fault each, made by a seeded generator. The faults have different
// kinds, are planted in different motions, and range from far beyond a limit to just beside one.

#include <cstdint>

#include "ayumi/author/generate/generate.hpp"
#include "tests/support/dice.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {

struct FaultyPattern {
  std::string motion, fault;
  Pattern pattern;
};

namespace faulty {

inline const std::vector<std::string>& arm_joints() {
  static const std::vector<std::string> names = {"l_shoulder_pitch", "r_shoulder_pitch",
                                                 "l_shoulder_roll",  "r_shoulder_roll",
                                                 "l_elbow",          "r_elbow"};
  return names;
}

inline const std::vector<std::string>& leg_joints() {
  static const std::vector<std::string> names = {"l_hip_pitch",   "r_hip_pitch",  "l_knee",
                                                 "r_knee",        "l_hip_roll",   "r_ankle_roll",
                                                 "l_ankle_pitch", "r_ankle_pitch"};
  return names;
}

inline FaultyPattern motion(Dice& dice) {
  FaultyPattern made;
  const size_t kind = dice.below(5);
  if (kind == 0) {
    made.motion = "walk";
    made.pattern = walk_pattern(hoap1(), {.steps = 1 + static_cast<int>(dice.below(2)),
                                          .stride = dice.between(0.01, 0.035),
                                          .period = dice.between(0.45, 0.65),
                                          .lift = dice.between(0.01, 0.018)});
  } else if (kind == 1) {
    made.motion = "turn";
    made.pattern = walk_pattern(hoap1(), {.steps = 1,
                                          .stride = 0,
                                          .period = dice.between(0.45, 0.65),
                                          .turn = dice.between(-0.1, 0.1)});
  } else if (kind == 2) {
    made.motion = "sway";
    made.pattern = sway_pattern(
        hoap1(),
        {.side = dice.between(0.005, 0.02), .period = dice.between(1.5, 2.5), .cycles = 1});
  } else if (kind == 3) {
    made.motion = "squat";
    made.pattern = squat_pattern(
        hoap1(), {.depth = dice.between(0.01, 0.03), .period = dice.between(1.2, 2), .cycles = 1});
  } else {
    made.motion = "stand";
    made.pattern = stand_pattern(hoap1(), dice.between(0.8, 1.5));
  }
  made.pattern.robot = "hoap1";
  made.pattern.name = made.motion;
  return made;
}

/// The size of a bump of the given width whose largest speed is `speed`. Derived: the largest speed
/// of
/// cos^4(pi s) is
///   3 sqrt(3) / 4 pi.
inline double size_of(double speed, double width) {
  return speed * width / (3 * std::sqrt(3.0) / 4 * M_PI);
}

inline double soft_distance(const std::string& joint, double theta, double sign) {
  const Dof& dof = hoap1().dofs()[static_cast<size_t>(hoap1().find_dof(joint))];
  const double margin = hoap1().description().soft_limit_margin;
  return sign > 0 ? dof.upper - margin - theta : theta - dof.lower - margin;
}

}  // namespace faulty

/// The pattern of a seed. A fault near a limit may still keep it; the check decides.
inline FaultyPattern faulty_pattern(std::uint64_t seed) {
  using namespace faulty;
  Dice dice(seed);
  FaultyPattern made = motion(dice);
  made.pattern = baked(hoap1(), made.pattern);
  Pattern& p = made.pattern;
  DenseTable& table = *p.table;
  const double end = table.dt * static_cast<double>(table.theta.rows() - 1);
  const double center = end * dice.between(0.35, 0.65), width = dice.between(0.15, 0.5);
  const std::vector<std::string>& joints = dice.below(3) == 0 ? leg_joints() : arm_joints();
  const std::string joint = dice.one_of(joints);
  const auto column = hoap1().find_dof(joint);
  const double limit = hoap1().limits().speed[column];
  const Side side = dice.below(2) == 0 ? Side::left : Side::right;
  const double sign = dice.sign();
  const auto stands = [&](double t) {
    size_t k = 0;
    while (k + 1 < p.phases.size() && p.phases[k].until < t) ++k;
    return k;
  };
  switch (dice.below(12)) {
    case 0:
      made.fault = "a joint too fast";
      move_joint(hoap1(), table, joint, sign * size_of(dice.between(1, 1.6) * limit, width), center,
                 width);
      break;
    case 1:
      made.fault = "a joint near its speed limit";
      move_joint(hoap1(), table, joint, sign * size_of(dice.between(0.75, 1.02) * limit, width),
                 center, width);
      break;
    case 2:
      made.fault = "a joint beyond its range";
      move_joint(
          hoap1(), table, joint,
          sign * (soft_distance(joint, table.theta(0, column), sign) + dice.between(0.01, 0.2)),
          center, dice.between(0.5, 0.8));
      break;
    case 3:
      made.fault = "a joint at the limit of its range";
      move_joint(
          hoap1(), table, joint,
          sign * (soft_distance(joint, table.theta(0, column), sign) + dice.between(-0.004, 0.001)),
          center, dice.between(0.4, 0.8));
      break;
    case 4:
      made.fault = "the ZMP outside the support";
      sway_base(hoap1(), table, {0, sign * dice.between(0.01, 0.03), 0}, center,
                dice.between(0.4, 0.7));
      motion_alone(table);
      break;
    case 5:
      made.fault = "a foot in the ground or above it";
      slip_foot(hoap1(), table, side, {0, 0, sign * dice.between(0.002, 0.01)}, center, width);
      break;
    case 6:
      made.fault = "a foot slides";
      slip_foot(hoap1(), table, side,
                {sign * dice.between(0.001, 0.008), dice.between(-0.004, 0.004), 0}, center, width);
      break;
    case 7:
      made.fault = "too little time";
      squeeze(p, made.motion == "stand" ? 0.5 : dice.between(0.55, 0.9));
      break;
    case 8: {
      made.fault = "phases too short";
      if (p.phases.size() > 1)
        p.phases[dice.below(p.phases.size() - 1)].until += dice.between(-0.08, -0.02);
      const double beside = dice.between(0.8, 1.1) * limit;
      if (p.phases.size() == 1)
        move_joint(hoap1(), table, joint, sign * size_of(beside, 0.12), center, 0.12);
      break;
    }
    case 9: {
      made.fault = "a jump of a joint";
      const double size = sign * dice.between(0.003, 0.15), back = dice.between(0.1, 0.4);
      for_rows(table, [&](double t, size_t k) {
        if (t >= center && t < center + back)
          table.theta(static_cast<Eigen::Index>(k), column) +=
              size * std::pow(std::cos(0.5 * M_PI * (t - center) / back), 4);
      });
      break;
    }
    case 10: {
      made.fault = "the ends not at rest";
      const std::string arm = dice.one_of(arm_joints());
      const int dof = hoap1().find_dof(arm);
      const double rate = sign * dice.between(0.05, 0.5), lasts = dice.between(0.2, 0.5);
      const bool at_end = dice.below(2) == 0;
      for_rows(table, [&](double t, size_t k) {
        const double from = at_end ? end - t : t;
        if (from < lasts)
          table.theta(static_cast<Eigen::Index>(k), dof) +=
              rate * from * std::pow(std::cos(0.5 * M_PI * from / lasts), 4);
      });
      break;
    }
    default:
      made.fault = "wrong COG, ZMP or f_z";
      for_rows(table, [&](double t, size_t k) {
        table.cog[k].y() += sign * 0.01 * bump(t, center, 2 * width);
        table.zmp[k].x() += 0.02 * bump(t, center, 2 * width);
        table.fz[k] *= 1.05;
      });
      if (stands(center) == 0) table.zmp.front().x() += 0.001;
  }
  return made;
}

}  // namespace ayumi::test
