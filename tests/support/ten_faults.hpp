#pragma once
// A short walk of HOAP-1 with one of ten faults, and a measure of the distance of two motions.

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/repair/repair.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {

struct FaultyMotion {
  std::string name;
  CommandSeries series;
  RepairOptions options;
};

inline FaultyMotion faulty_motion(const std::string& name,
                                  const std::function<void(Pattern&, RepairOptions&)>& plant) {
  static const Pattern sound = [] {
    Pattern walk = walk_pattern(hoap1(), {.steps = 3, .stride = 0.033, .lift = 0.017});
    walk.robot = "hoap1";
    return baked(hoap1(), walk);
  }();
  FaultyMotion motion;
  motion.name = name;
  Pattern pattern = sound;
  plant(pattern, motion.options);
  motion.series = sample(hoap1(), pattern);
  return motion;
}

inline std::vector<FaultyMotion> ten_faulty_motions() {
  constexpr double kDegree = M_PI / 180;
  // The second step has this middle and this length [s].
  const double middle = 2.4, length = 0.45;
  const auto joint = [&](const char* which, double degrees, double at, double width) {
    return [=](Pattern& p, RepairOptions&) {
      move_joint(hoap1(), *p.table, which, degrees * kDegree, at, width);
    };
  };
  const auto feet = [&](double x, double y, double z) {
    return [=](Pattern& p, RepairOptions&) {
      slip_foot(hoap1(), *p.table, Side::left, Eigen::Vector3d(x, y, z), 1.3, length);
    };
  };
  return {
      faulty_motion("knee thrown by 40 deg", joint("r_knee", 40, middle, 0.4)),
      faulty_motion("elbow beyond its limit", joint("l_elbow", 40, 2, 0.8)),
      faulty_motion("arm through the trunk", joint("l_shoulder_roll", -35, 1.8, 0.8)),
      faulty_motion("arm too fast", joint("r_shoulder_pitch", 60, 2, 0.3)),
      faulty_motion("stance foot displaced by 5 mm", feet(0.003, 0.004, 0)),
      faulty_motion("stance foot 3 mm in the ground", feet(0, 0, -0.003)),
      faulty_motion("contact 60 ms too early",
                    [](Pattern& p, RepairOptions&) { p.phases[5].until -= 0.06; }),
      faulty_motion("friction 0.10", [](Pattern&, RepairOptions& o) { o.check.friction = 0.10; }),
      faulty_motion("0.75 of its time", [](Pattern& p, RepairOptions&) { squeeze(p, 0.75); }),
      faulty_motion("trunk sways by 20 mm",
                    [&](Pattern& p, RepairOptions&) {
                      sway_base(hoap1(), *p.table, Eigen::Vector3d(0, 0.02, 0), middle, 0.5);
                      motion_alone(*p.table);
                    }),
  };
}

/// The largest difference of a joint [rad], and of the base [m].
inline double motion_distance(const CommandSeries& a, const CommandSeries& b) {
  double most = 0;
  for (size_t k = 0; k < a.samples.size(); ++k) {
    const RobotState &x = a.samples[k].state, &y = b.samples[k].state;
    most = std::max({most, (x.theta - y.theta).cwiseAbs().maxCoeff(),
                     (x.base.position - y.base.position).cwiseAbs().maxCoeff()});
  }
  return most;
}

}  // namespace ayumi::test
