// Recorded and commanded motions of real robots are imported and judged. The data are not part of
// this program: without them, the tests that need them are skipped. Small files of the same form
// are also made here.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

const std::string kData = AYUMI_SOURCE_DIR "/../shared/data/hoap3";

bool has_data() { return std::filesystem::exists(kData + "/hoap3_description/urdf/hoap3.urdf"); }

RobotModel hoap3() {
  return load_robot(AYUMI_SOURCE_DIR "/examples/hoap3/robot.json",
                    {.folders = {kData + "/hoap3_description"}});
}

GroundedMotion import_file(const RobotModel& model, const std::string& name) {
  const std::string file = kData + "/motions/" + name;
  GroundedMotion motion =
      grounded(model, read_motion(read_file(file), file, model).motion, "motion.csv");
  motion.pattern.robot = "hoap3";
  return motion;
}

std::vector<std::vector<double>> numbers(const std::string& file) {
  std::ifstream stream(file);
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(stream, line);) {
    std::vector<double> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::atof(cell.c_str()));
    if (row.size() > 2) rows.push_back(row);
  }
  return rows;
}

// The load of a foot from its four cells (with the calibration of the robot that was recorded).
double foot_load(const std::vector<double>& row, bool left) {
  const double cells[2][4][3] = {{{-5.11442e-4, 14.2344585, -3303.68632},
                                  {-4.31681e-3, 20.0368094, -4647.39660},
                                  {-1.908608e-3, 16.1762142, -4048.92221},
                                  {-2.731305e-3, 17.9329046, -4073.06324}},
                                 {{8.900151e-5, 13.2084705, -3100.32925},
                                  {-2.881771e-3, 19.0722583, -4386.87610},
                                  {-1.290640e-3, 24.8923387, -5962.94605},
                                  {-8.447711e-3, 27.7942590, -5557.83858}}};
  const double l[2][3] = {{-3.575867e-10, 7.709541e-6, 0.898027268},
                          {-6.297247e-10, 1.1559476e-5, 0.874587850}};
  double r = 0;
  for (int i = 0; i < 4; ++i) {
    const double a = row[(left ? 6 : 0) + i];
    const double* c = cells[left][i];
    r += c[0] * a * a + c[1] * a + c[2];
  }
  return 0.00981 * (l[left][0] * r * r * r + l[left][1] * r * r + l[left][2] * r);
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (size_t i = 0; i < a.size(); ++i) ma += a[i] / a.size(), mb += b[i] / a.size();
  for (size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
    ab += (a[i] - ma) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(RealMotion, FujitsuWalkShiftsItsWeightAsMeasured) {
  if (!has_data()) GTEST_SKIP() << "no HOAP-3 data at " << kData;
  const RobotModel model = hoap3();
  EXPECT_NEAR(model.mass(), 8.802, 0.002);
  const GroundedMotion motion = import_file(model, "walk_m03_fujitsu_sample_pulses_1ms.csv");
  const CommandSeries series = sample(model, motion.pattern);
  const auto sensors = numbers(kData + "/recordings/walk_m03_measured_sensors_adc_1ms.csv");
  ASSERT_EQ(sensors.size(), series.samples.size());
  std::vector<double> lateral, share;
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double left = foot_load(sensors[k], true), right = foot_load(sensors[k], false);
    if (left + right < 10) continue;
    const CommandSample& s = series.samples[k];
    const Eigen::Vector3d middle = 0.5 * (s.feet[0].translation() + s.feet[1].translation());
    lateral.push_back((s.cog - middle).y());
    share.push_back(left / (left + right));
  }
  EXPECT_GT(lateral.size(), 0.9 * sensors.size());
  std::printf("lateral COG and left-foot load: correlation %.3f over %zu samples\n",
              correlation(lateral, share), lateral.size());
  EXPECT_GE(correlation(lateral, share), 0.85);

  int single = 0, inside = 0;
  for (const CommandSample& s : series.samples) {
    if (s.support != Support::left && s.support != Support::right) continue;
    const Side side = s.support == Support::left ? Side::left : Side::right;
    const Eigen::Vector3d zmp = s.feet[static_cast<int>(side)].inverse() * s.zmp;
    ++single;
    inside += ConvexPolygon(model.sole(side).polygon).margin(zmp.head<2>()) >= 0;
  }
  std::printf("single support %.2f s, ZMP inside the sole for %.0f %%\n", 0.001 * single,
              100.0 * inside / single);
  EXPECT_GT(single, 4000);
  EXPECT_GT(inside, 0.95 * single);
  // Rounded counts give no useful accelerations: the motors were able to do what they did.
  const ConsistencyReport r = check_consistency(model, series);
  EXPECT_LT(r.summary[FindingKind::joint_acceleration], 100);
  for (const Finding& f : r.findings)
    EXPECT_FALSE(f.severity == Severity::error && f.kind == FindingKind::joint_torque)
        << f.where << f.at;
  // Steps alternate, and no foot stays in its place.
  EXPECT_GE(motion.contacts.size(), 12u);
  for (size_t i = 3; i < motion.contacts.size(); ++i)
    EXPECT_NE(motion.contacts[i].foot, motion.contacts[i - 1].foot) << i;
}

TEST(RealMotion, SideStepIsFlaggedAtItsJump) {
  if (!has_data()) GTEST_SKIP() << "no HOAP-3 data at " << kData;
  const RobotModel model = hoap3();
  const GroundedMotion motion = import_file(model, "side_step_right_pulses_2ms.csv");
  const ConsistencyReport r = check_consistency(model, sample(model, motion.pattern));
  EXPECT_FALSE(r.consistent);
  bool found = false;
  for (const Finding& f : r.findings) {
    if (f.severity != Severity::error ||
        (f.kind != FindingKind::joint_speed && f.kind != FindingKind::servo_step))
      continue;
    if (f.where != "L_LFE_L_KN_joint" || std::abs(f.at - 2 * 1252.5e-3) > 0.006) continue;
    found = true;
    EXPECT_GT(std::abs(f.worst), 212 / 209.0 * M_PI / 180 * 1000 * 0.8);
  }
  EXPECT_TRUE(found);
}

TEST(RealMotion, EveryFileOfTheRobotIsRead) {
  if (!has_data()) GTEST_SKIP() << "no HOAP-3 data at " << kData;
  const RobotModel model = hoap3();
  for (const auto& [name, rows, dt] :
       {std::tuple{"walk_forward_7cm_steps_pulses_1ms.csv", 15400, 0.001},
        std::tuple{"swagger_perdonavidas_right_pulses_2ms.csv", 4000, 0.002}}) {
    const std::string file = kData + "/motions/" + name;
    const ImportedMotion read = read_motion(read_file(file), file, model);
    EXPECT_EQ(read.format, "hoap");
    EXPECT_EQ(read.rows, rows);
    EXPECT_EQ(read.motion.dt, dt);
    EXPECT_FALSE(grounded(model, read.motion, "t.csv").contacts.empty());
  }
}

// A sidecar in another folder than its URDF, with values of its own.
TEST(Sidecar, CompletesAUrdfOfAnotherFolder) {
  const TemporaryFolder folder;
  const auto write = [&](const std::string& more) {
    return folder
        .write("robot.json", R"({ "format": "ayumi.robot/1", "urdf": "robot.urdf", )" + more + "}")
        .string();
  };
  const RobotSearch search = {.folders = {AYUMI_SOURCE_DIR "/robots/hoap1"}};
  const std::string file = write(
      R"("links": { "torso": { "mass": 4, "com": [0, 0, 0.1],
                                  "inertia": [0.01, 0, 0, 0.01, 0, 0.01] } },
               "position_limits_deg": { "l_knee": [1, 99] })");
  const RobotModel model = load_robot(file, search);
  const Inertia& torso = model.links()[model.find_link("torso")].inertia;
  EXPECT_EQ(torso.mass, 4);
  EXPECT_EQ(torso.com.z(), 0.1);
  EXPECT_EQ(torso.about_com(1, 1), 0.01);
  EXPECT_NEAR(model.dofs()[model.find_dof("l_knee")].upper, 99 * M_PI / 180, 1e-12);
  const auto message = [&](const std::string& text) -> std::string {
    try {
      load_robot(write(text), search);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message(R"("links": { "trso": {} })").find("/links/trso: the URDF has no link 'trso'"),
            std::string::npos);
  EXPECT_NE(message(R"("links": { "torso": { "inertia": [1, 2] } })").find("expected six numbers"),
            std::string::npos);
  EXPECT_NE(message(R"("position_limits_deg": { "l_kne": [0, 1] })").find("not a moving joint"),
            std::string::npos);
  EXPECT_THROW(load_robot(file), Error);  // without the folder there is no URDF
}

// A row of counts for `motors`, in which only the elbows are not 0.
std::string row(int interval, int motors, int elbows, const std::string& tail,
                const std::string& separator = ",") {
  std::string text = std::to_string(interval) + separator + "2";
  for (int m = 1; m <= motors; ++m)
    text += separator + std::to_string(m == 10 ? elbows : m == 20 ? -elbows : 0);
  return text + tail;
}

ImportedMotion read(const std::string& text) { return read_motion(text, "seq.csv", hoap1()); }

std::string message(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "no error";
}

TEST(HoapImport, LayoutsOfAllThreeRobots) {
  const int elbow = hoap1().find_dof("r_elbow");
  for (const auto& [motors, tail] :
       {std::pair{20, ",R,R,R"}, std::pair{21, ",60,R,R,R"}, std::pair{21, ",60,60,R,R,R,R"}}) {
    std::string text;
    for (int k = 0; k < 10; ++k) text += row(1, motors, 2090, tail) + "\r\n";
    const ImportedMotion motion = read(text);
    EXPECT_EQ(motion.rows, 10);
    EXPECT_NEAR(motion.motion.theta(5, elbow), -10 * M_PI / 180, 1e-12);
    EXPECT_EQ(motion.motion.dt, 0.001);
  }
}

TEST(HoapImport, QuirksOfRealFiles) {
  std::string text;
  text += "2,3,5,G,12,350\n";  // a command to one device, of which only the time counts
  // There are blanks, and R stands for the hobby servo.
  text += row(1, 21, 0, ", R ,R ,R, R", " , ") + "\n";
  text += row(1, 21, 209, ",R,R,R,R") + "\r\n\r\n";  // an empty line
  std::string negative = row(2, 21, 418, ",60,R,R,R");
  negative.replace(negative.find(",0,"), 3, ",-0,");
  text += negative + "\n";
  for (int k = 0; k < 8; ++k) text += row(2, 21, 418, ",60,R,R,R") + "\n";
  const ImportedMotion motion = read(text);
  EXPECT_EQ(motion.rows, 11);
  EXPECT_EQ(motion.motion.dt, 0.001);         // the intervals are 1 and 2 ms
  EXPECT_EQ(motion.motion.theta.rows(), 19);  // the last row is at 18 ms after the first
  const int elbow = hoap1().find_dof("r_elbow");
  // Each angle is within a tenth of a degree of the angle in the file.
  const double count = 0.1 * M_PI / 180;
  EXPECT_NEAR(motion.motion.theta(1, elbow), -1 * M_PI / 180, count + 1e-12);
  EXPECT_NEAR(motion.motion.theta(2, elbow), -2 * M_PI / 180, count + 1e-12);
  std::string said;
  for (const std::string& line : motion.filled) said += line + "\n";
  EXPECT_NE(said.find("1 commands to single devices"), std::string::npos) << said;
  EXPECT_NE(said.find("device 21 is ignored, because no joint"), std::string::npos) << said;
  EXPECT_NE(said.find("intervals between the rows differ"), std::string::npos) << said;
}

// A sound walk is still sound after it was rounded to counts, with its contacts at the same times.
TEST(HoapImport, AWalkRoundedToCountsPassesTheCheck) {
  const Pattern walk = walk_pattern(hoap1(), {.steps = 3, .turn = 0.05});
  const CommandSeries series = sample(hoap1(), walk);
  std::string text;
  for (const CommandSample& s : series.samples) {
    std::array<long, 20> counts{};
    for (int i = 0; i < hoap1().dof_count(); ++i) {
      const EncoderDescription& encoder = hoap1().dofs()[i].encoder;
      counts.at(encoder.device - 1) =
          std::lround(s.state.theta[i] * 180 / M_PI * encoder.counts_per_degree);
    }
    text += "1,2";
    for (const long count : counts) text += "," + std::to_string(count);
    text += ",R,R,R\n";
  }
  const GroundedMotion motion = grounded(hoap1(), read(text).motion, "t.csv");
  const ConsistencyReport r = check_consistency(hoap1(), sample(hoap1(), motion.pattern));
  for (const Finding& f : r.findings)
    EXPECT_NE(f.severity, Severity::error) << name_of(f.kind) << " " << f.where << " at " << f.at;
  EXPECT_LT(r.summary[FindingKind::foot_float], 5e-5);
  // Swings end with (1 - s)^3, so that their last hundredth of a millimetre counts as rest.
  ASSERT_EQ(motion.pattern.phases.size(), walk.phases.size());
  for (size_t i = 0; i < walk.phases.size(); ++i) {
    EXPECT_EQ(motion.pattern.phases[i].support, walk.phases[i].support);
    EXPECT_NEAR(motion.pattern.phases[i].until, walk.phases[i].until, 0.030);
  }
}

// Files that a robot answers with, and files of other programs in radians, have no intervals.
// Radians have the signs of the encoders, which are negative here.
TEST(HoapImport, BareRowsOfCountsOrRadians) {
  const int elbow = hoap1().find_dof("r_elbow"), knee = hoap1().find_dof("l_knee");
  std::string counts, radians;
  for (int k = 0; k < 12; ++k) {
    for (int m = 1; m <= 23; ++m) {
      counts += (m == 10 ? "2090" : m == 14 ? "-836" : m == 21 ? std::to_string(k % 3) : "0");
      radians += (m == 10 ? "0.17453292519943295" : m == 14 ? "-0.069813170079773182" : "0");
      counts += m < 23 ? "," : "\r\n";
      radians += m < 23 ? ", " : "\n";
    }
  }
  for (const auto& [text, dt] : {std::pair{counts, 0.001}, {radians, 0.002}}) {
    const ImportedMotion motion = read(text);
    EXPECT_EQ(motion.format, "hoap");
    EXPECT_EQ(motion.motion.dt, dt);
    EXPECT_EQ(motion.rows, 12);
    EXPECT_NEAR(motion.motion.theta(5, elbow), -10 * M_PI / 180, 1e-9);
    EXPECT_NEAR(motion.motion.theta(5, knee), 4 * M_PI / 180, 1e-9);
  }
  EXPECT_EQ(read_motion(counts, "a.csv", hoap1(), {.rate = 250}).motion.dt, 0.004);
  EXPECT_NE(message(counts + "1,2,3\n").find("seq.csv:13: the row has 3 columns"),
            std::string::npos);
}

TEST(HoapImport, AnglesAreSmoothedAsFarAsIsSaid) {
  std::string text;
  for (int k = 0; k < 60; ++k) text += row(1, 20, k < 30 ? 0 : 11 * (k - 30), ",R,R,R") + "\n";
  const int elbow = hoap1().find_dof("r_elbow");
  const double count = M_PI / 180 / 209;
  const auto largest = [&](const ImportOptions& options) {
    const Eigen::VectorXd x = read_motion(text, "a.csv", hoap1(), options).motion.theta.col(elbow);
    double most = 0;
    for (int k = 1; k < 59; ++k) most = std::max(most, std::abs(x[k + 1] - 2 * x[k] + x[k - 1]));
    return most / count;
  };
  EXPECT_NEAR(largest({.smooth = 0.0}), 11, 1e-6);
  EXPECT_LT(largest({}), 2);
  EXPECT_LT(largest({.smooth = 0.3}), 1);
}

TEST(HoapImport, MistakesNameTheLine) {
  const std::string good = row(1, 20, 0, ",R,R,R") + "\n";
  EXPECT_NE(message(good + row(1, 20, 0, ",R,R") + "\n").find("seq.csv:2: the row has 24 columns"),
            std::string::npos);
  EXPECT_NE(
      message(good + row(1, 20, 40000, ",R,R,R") + "\n").find("'40000' is not a whole number"),
      std::string::npos);
  EXPECT_NE(message(good + good + "0,2,1\n").find("seq.csv:3: '0' is not an interval"),
            std::string::npos);
  std::string waist;
  for (int k = 0; k < 4; ++k) {
    std::string line = row(1, 21, 0, ",60,R,R,R");
    line.replace(line.rfind(",0,60"), 5, "," + std::to_string(4 * k) + ",60");
    waist += line + "\n";
  }
  EXPECT_NE(message(waist).find("device 21 moves from 0 to 12"), std::string::npos);
}

TEST(TableImport, BareNamesDegreesAndUnevenTimes) {
  std::string text = "time,l_elbow,r_knee\n";
  for (int k = 0; k < 20; ++k) {
    const double t = 0.5 + 0.01 * k + (k == 7 ? 0.002 : 0);
    text += std::to_string(t) + "," + std::to_string(-100 * (t - 0.5)) + ",40\n";
  }
  const ImportedMotion motion = read_motion(text, "a.csv", hoap1(), {.degrees = true});
  EXPECT_EQ(motion.format, "csv");
  EXPECT_NEAR(motion.motion.dt, 0.01, 1e-12);
  ASSERT_EQ(motion.motion.theta.rows(), 20);
  for (int k = 0; k < 20; ++k)
    EXPECT_NEAR(motion.motion.theta(k, hoap1().find_dof("l_elbow")), -k * M_PI / 180, 1e-6) << k;
  EXPECT_NEAR(motion.motion.theta(0, hoap1().find_dof("r_knee")), 40 * M_PI / 180, 1e-12);
  EXPECT_THROW(read_motion("l_elbow\n0\n1\n", "a.csv", hoap1()), Error);
  EXPECT_THROW(read_motion("t,l_elbo\n0,0\n1,1\n", "a.csv", hoap1()), Error);
}

}  // namespace
}  // namespace ayumi::test
