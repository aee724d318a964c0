// DTAD on motions that were not made for it: sequences of a real robot, plans that end or begin in
// motion, and plans with a ZMP that no ground can give.
#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/simulate.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using test::hoap1;

SimulationLog play(const RobotModel& model, const CommandSeries& series, ControllerKind law) {
  SimulateOptions options;
  options.controller.type = law;
  options.settle = 2;
  return simulate(model, series, options);
}

CommandSeries sway() {
  Pattern pattern = sway_pattern(hoap1(), sway_defaults(hoap1()));
  pattern.robot = "hoap1";
  return sample(hoap1(), pattern);
}

// The robot stops where the plan ends and stands there: it neither continues with the last velocity
// nor moves to the ZMP of the last acceleration.
TEST(ImportedMotions, APlanThatEndsInMotion) {
  CommandSeries series = sway();
  size_t fastest = 0;
  const std::vector<CommandSample>& samples = series.samples;
  for (size_t k = 0; k < samples.size() / 2; ++k)
    if (samples[k].ddcog.head<2>().norm() > samples[fastest].ddcog.head<2>().norm()) fastest = k;
  ASSERT_GT((samples[fastest].zmp - samples[fastest].cog).head<2>().norm(), 0.002);
  series.samples.resize(fastest + 1);
  for (const ControllerKind law : {ControllerKind::none, ControllerKind::dtad}) {
    const SimulationLog log = play(hoap1(), series, law);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_LT(log.result.final_cog_error, 2e-4);
    const SimulationSample& last = log.samples.back();
    EXPECT_LT((last.command_zmp - last.command_cog).head<2>().norm(), 1e-9);
    EXPECT_NEAR(last.command_fz, hoap1().mass() * 9.80665, 1e-6);
  }
}

// For 10 ms, the plan has its ZMP 0.8 m in front of the feet, as differences of a coarse table give
// it. Trunk and arms do not respond, because this is no disturbance.
TEST(ImportedMotions, AZmpThatNoGroundGives) {
  CommandSeries series = sway();
  const size_t at = series.samples.size() / 2;
  for (size_t k = at; k < at + 10; ++k) series.samples[k].zmp.x() = 0.8;
  const SimulationLog log = play(hoap1(), series, ControllerKind::dtad);
  EXPECT_EQ(log.result.outcome, Outcome::stands);
  EXPECT_LT(log.result.max_tilt, 0.02);
  for (const SimulationSample& s : log.samples)
    EXPECT_LT((s.reference_theta - s.command_theta).cwiseAbs().maxCoeff(), 0.03);
}

// The ZMP of a file differs by 15 mm from that of its own motion: the file was made for another
// robot, or its ZMP has another origin. The robot moves and ends as the posture says.
TEST(ImportedMotions, AZmpThatIsNotThatOfTheMotion) {
  for (const Eigen::Vector2d& off : {Eigen::Vector2d(0.015, 0), {-0.01, 0.01}, {0, -0.015}}) {
    SCOPED_TRACE(off.transpose());
    CommandSeries series = sway();
    // The accelerations of a coarse table are noisy.
    for (size_t k = 0; k < series.samples.size(); ++k) {
      series.samples[k].zmp.head<2>() += off;
      series.samples[k].ddcog.x() += k % 2 ? 0.1 : -0.1;
    }
    const SimulationLog log = play(hoap1(), series, ControllerKind::dtad);
    EXPECT_EQ(log.result.outcome, Outcome::stands);
    EXPECT_LT(log.result.final_cog_error, 1e-3);
    for (const SimulationSample& s : log.samples)
      EXPECT_LT((s.cog - s.command_cog).head<2>().norm(), 0.002);
  }
}

template <typename Values>
std::string yaml_list(const Values& values) {
  std::string words = "[ ";
  bool first = true;
  for (const double value : values) {
    words += (first ? "" : ", ") + text::exact(value);
    first = false;
  }
  return words + " ]";
}

// A link of a key pose of Choreonoid.
std::string ik_link(const std::string& name, const Eigen::Isometry3d& pose,
                    const std::string& more) {
  const Eigen::Matrix3d rows = pose.linear().transpose();
  return "        -\n          name: " + name +
         "\n          translation: " + yaml_list(pose.translation()) +
         "\n          rotation: " + yaml_list(rows.reshaped()) + "\n" + more;
}

// The key poses of a step: the right foot moves 30 mm forward, while an arm is lifted. The robot of
// the file is this one.
std::string step_of_key_poses(const RobotModel& model) {
  RobotState state = model.rest_state();
  RobotData data(model);
  update_positions(model, state, data);
  state.base.position.z() -= sole_pose(model, data, Side::left).translation().z();
  update_positions(model, state, data);
  const Eigen::Isometry3d base(Eigen::Translation3d(state.base.position));
  const auto foot = [&](Side side, double forward, double up, bool touching) {
    const Sole& sole = model.sole(side);
    const Eigen::Isometry3d moved(Eigen::Translation3d(forward, 0, up));
    const std::string& body = model.bodies()[static_cast<size_t>(sole.body)].name;
    return ik_link(body, moved * sole_pose(model, data, side) * sole.frame.inverse(),
                   touching ? "          isTouching: true\n" : "");
  };
  const auto key = [](double time, const std::string& more, const std::string& inside) {
    return "  -\n    time: " + text::exact(time) + "\n" + more +
           "    refer:\n      type: Pose\n      name: \"\"\n" + inside;
  };
  const auto zmp = [&](double y) {
    return "      zmp: " + yaml_list(Eigen::Vector3d(0.01, y, 0)) + "\n";
  };
  std::vector<double> ids;
  for (int i = 0; i < model.dof_count(); ++i) ids.push_back(i);
  const std::string links = "      ikLinks:\n";
  const double side = sole_pose(model, data, Side::left).translation().y();
  return "type: PoseSeq\nname: step\ntargetBody: r\nrefs:\n" +
         key(0, "",
             "      joints: " + yaml_list(ids) + "\n      q: " + yaml_list(state.theta) + "\n" +
                 links + ik_link("WAIST", base, "          isBaseLink: true\n") +
                 foot(Side::left, 0, 0, true) + foot(Side::right, 0, 0, true) + zmp(0)) +
         key(1, "", zmp(0)) + key(1.6, "", zmp(side)) +
         key(2, "    maxTransitionTime: 0.3\n",
             "      joints: [ " + std::to_string(model.find_dof("l_shoulder_pitch")) +
                 " ]\n      q: [ 0.5 ]\n" + links + foot(Side::right, 0.015, 0.015, false)) +
         key(2.3, "", links + foot(Side::right, 0.03, 0, true) + zmp(side)) + key(3, "", zmp(0)) +
         key(4, "", zmp(0));
}

TEST(ImportedMotions, KeyPosesAreKeysOfAPattern) {
  const RobotModel& model = hoap1();
  const std::string text = step_of_key_poses(model);
  ImportOptions options;
  const auto refusal = [&] {
    try {
      read_key_poses(text, "step.pseq", model, options);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_NE(refusal().find("give --order"), std::string::npos) << refusal();
  options.by_order = true;
  std::optional<ImportedKeys> keys = read_key_poses(text, "step.pseq", model, options);
  ASSERT_TRUE(keys.has_value());
  EXPECT_EQ(keys->format, "choreonoid-poses");
  Pattern& pattern = keys->pattern;
  pattern.robot = "hoap1";
  EXPECT_FALSE(pattern.table.has_value());
  ASSERT_EQ(pattern.phases.size(), 3u);
  EXPECT_EQ(pattern.phases[0].support, Support::both);
  EXPECT_EQ(pattern.phases[1].support, Support::left);
  EXPECT_EQ(pattern.phases[2].support, Support::both);
  EXPECT_NEAR(pattern.phases[0].until, 1.7, 1e-12);
  EXPECT_NEAR(pattern.phases[1].until, 2.3, 1e-12);
  EXPECT_EQ(pattern.phases[2].until, 4);
  const CommandSeries series = sample(model, pattern_of_text(pattern_text(pattern), "step.json"));
  const auto at = [&](double t) -> const CommandSample& {
    return series.samples[static_cast<size_t>(std::lround(t / series.dt))];
  };
  const auto right = static_cast<size_t>(Side::right);
  const Eigen::Vector3d start = at(0).feet[right].translation();
  EXPECT_LT((at(1.7).feet[right].translation() - start).norm(), 1e-9);
  EXPECT_NEAR(at(2).feet[right].translation().z(), 0.015, 1e-6);
  EXPECT_NEAR(at(2.3).feet[right].translation().x() - start.x(), 0.03, 1e-9);
  EXPECT_NEAR(at(1.6).zmp.y(), at(0).feet[0].translation().y(), 1e-3);
  const int arm = model.find_dof("l_shoulder_pitch");
  EXPECT_NEAR(at(1.7).state.theta[arm], at(0).state.theta[arm], 1e-9);
  EXPECT_NEAR(at(2).state.theta[arm], 0.5, 1e-9);
  // A motion in another format is not read as key poses.
  EXPECT_FALSE(read_key_poses("time,0,1\nl_knee,0,1\n", "k.csv", model).has_value());
}

// A file with steps and one ZMP key: the ZMP stays in the soles, as it does when the editor
// generates it.
TEST(ImportedMotions, KeyPosesWithoutZmpStepWithTheZmpUnderTheStandingFoot) {
  const RobotModel& model = hoap1();
  std::string text = step_of_key_poses(model);
  for (size_t at = text.find("      zmp: ") + 1;
       (at = text.find("      zmp: ", at)) != std::string::npos;)
    text.erase(at, text.find('\n', at) + 1 - at);  // all keys except the first one
  ImportOptions options;
  options.by_order = true;
  std::optional<ImportedKeys> keys = read_key_poses(text, "step.pseq", model, options);
  ASSERT_TRUE(keys.has_value());
  keys->pattern.robot = "hoap1";
  const CommandSeries series =
      sample(model, pattern_of_text(pattern_text(keys->pattern), "step.json"));
  const Eigen::Vector2d center = model.sole(Side::left).center;
  for (const CommandSample& sample : series.samples)
    if (sample.support == Support::left) {
      const Eigen::Vector3d at = sample.feet[0] * Eigen::Vector3d(center.x(), center.y(), 0);
      EXPECT_LT((sample.zmp - at).head<2>().norm(), 2e-3);
    }
  std::string said;
  for (const std::string& line : keys->filled) said += line + "\n";
  EXPECT_NE(said.find("under the middle of the standing foot"), std::string::npos) << said;
}

// Files of every format and robot, whole and cut off at either end: what was read makes a pattern
// that can be written, read and sampled.
TEST(ImportedMotions, EveryFormatCanBeSampled) {
  int tried = 0;
  for (const char* name : {"hoap1", "humanoid30"}) {
    const RobotModel model = load_robot(name, {{AYUMI_SOURCE_DIR "/robots"}});
    WalkParameters walk = walk_defaults(model);
    walk.steps = 2;
    Pattern pattern = walk_pattern(model, walk);
    pattern.robot = name;
    const CommandSeries series = sample(model, pattern);
    for (const MotionFormat& format : motion_formats()) {
      if (!format.read || !format.write) continue;
      MotionFile whole;
      whole.rate = format.name == "op3-action" ? 62.5 : 50;
      whole.joints = model.dof_names();
      const auto rows = static_cast<int>(series.duration() * whole.rate);
      for (const auto& [from, to] : {std::pair{0.0, 1.0}, {0.35, 1.0}, {0.0, 0.62}}) {
        SCOPED_TRACE(std::string(name) + " " + format.name + " from " + std::to_string(from) +
                     " to " + std::to_string(to));
        MotionFile motion = whole;
        const int first = static_cast<int>(from * rows), last = static_cast<int>(to * rows);
        motion.values.resize(last - first, model.dof_count());
        for (int k = first; k < last; ++k) {
          const auto& at =
              series.samples[static_cast<size_t>(std::lround(k / whole.rate / series.dt))];
          motion.times.push_back((k - first) / whole.rate);
          motion.values.row(k - first) = at.state.theta.transpose();
          motion.base.push_back(at.state.base);
          motion.cog.push_back(at.cog);
          motion.zmp.push_back(at.zmp);
          motion.fz.push_back(at.fz);
        }
        std::vector<WrittenFile> files;
        try {
          files = format.write(model, motion);
        } catch (const Error&) {
          continue;  // this robot has no numbers of servos
        }
        test::TemporaryFolder folder;
        for (const WrittenFile& file : files)
          write_file((folder.path() / "m.dat")
                         .replace_extension(file.extension.empty() ? ".dat" : file.extension),
                     file.bytes);
        const std::string main =
            (folder.path() / "m.dat")
                .replace_extension(files[0].extension.empty() ? ".dat" : files[0].extension)
                .string();
        ImportOptions options;
        options.by_order = !(format.holds & kJointNames);
        if (!(format.holds & kRate)) options.rate = whole.rate;
        const ImportedMotion read = read_motion(read_file(main), main, model, options);
        for (const double ramp : {0.0, 0.3}) {
          const RawMotion raw = ramp > 0 ? with_ramps(model, read.motion, ramp) : read.motion;
          GroundedMotion found = grounded(model, raw, "out.csv");
          found.pattern.robot = name;
          found.pattern.file = "imported";
          const auto out = folder.path() / "out.json";
          write_pattern_and_table(out, found.pattern);
          const CommandSeries again = sample(model, read_pattern(out));
          EXPECT_NEAR(again.duration(), (raw.theta.rows() - 1) * raw.dt, 0.002);
          ++tried;
        }
      }
    }
  }
  EXPECT_GE(tried, 2 * 3 * 2 * 14);
}

// Every available sequence of HOAP-3. The data are not part of this program: without them the test
// is skipped.
TEST(ImportedMotions, SequencesOfARealRobot) {
  const std::filesystem::path data = AYUMI_SOURCE_DIR "/../shared/data/hoap3";
  if (!std::filesystem::exists(data / "motions"))
    GTEST_SKIP() << "no recorded sequences in " << data;
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/examples/hoap3/robot.json",
                                      {.folders = {data / "hoap3_description"}});
  for (const auto& entry : std::filesystem::directory_iterator(data / "motions")) {
    SCOPED_TRACE(entry.path().filename());
    const std::string file = entry.path().string();
    GroundedMotion motion =
        grounded(model, read_motion(read_file(file), file, model).motion, "motion.csv");
    motion.pattern.robot = "hoap3";
    const CommandSeries series = sample(model, motion.pattern);
    const SimulationLog law = play(model, series, ControllerKind::dtad);
    EXPECT_EQ(law.result.outcome, Outcome::stands) << "fell at " << law.result.fell_at;
    EXPECT_LT(law.result.final_cog_error, 1e-3);
  }
}

}  // namespace
}  // namespace ayumi
