// Parts of a sidecar that the bundled robots do not have: names of joints in motions, limits,
// layouts of tables and calibrations of sensors, what is refused in them, and recordings that need
// them.

#include <gtest/gtest.h>

#include <filesystem>

#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/recording.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/json.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi::test {
namespace {

const std::string kHoap1 = AYUMI_SOURCE_DIR "/robots/hoap1";

// HOAP-1 with a sidecar in which these members (a JSON object) replace others.
class Changed {
 public:
  explicit Changed(const std::string& members) {
    folder_.write("robot.urdf", read_file(kHoap1 + "/robot.urdf"));
    std::filesystem::create_directory_symlink(kHoap1 + "/meshes", folder_.path() / "meshes");
    auto json = json_of(read_file(kHoap1 + "/robot.json"), true);
    json.merge_patch(json_of(members));
    folder_.write("robot.json", json.dump());
  }
  RobotModel load() const { return load_robot(folder_.path().string()); }
  std::string message() const {
    return error_message([&] { load(); });
  }

 private:
  TemporaryFolder folder_;
};

void expect_part(const std::string& message, const std::string& part) {
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(SidecarParts, AreRefusedWithTheirPlace) {
  const auto layout = [](const std::string& columns, const std::string& more = "") {
    return R"({"layouts": [{"name": "a", "motors": 20, "columns": [)" + columns + "]" + more +
           "}]}";
  };
  const std::pair<std::string, std::string> cases[] = {
      {R"({"aliases": {"Knee": "l_kne"}})",
       "/aliases/Knee: 'l_kne' is not a moving joint of the robot; did you mean 'l_knee'?"},
      {R"({"aliases": {"r_knee": "l_knee"}})", "/aliases/r_knee: 'r_knee' is itself a joint"},
      {R"({"position_limits_deg": {"l_kne": [0, 1]}})", "'l_kne' is not a moving joint"},
      {R"({"position_limits_deg": {"l_knee": [9, 1]}})",
       "the lower limit 9 deg exceeds the upper limit 1 deg; swap them"},
      {R"({"locked_joints": ["l_kne"]})", "'l_kne' is not a moving joint of the URDF"},
      {R"({"collision_ignore": [["trunk"]]})", "expected the names of two links"},
      {R"({"links": {"tail": {"mass": 1}}})", "the URDF has no link 'tail'"},
      {R"({"encoders": {"l_knee": {"device": 0, "counts_per_degree": 1}}})",
       "device numbers start at 1"},
      {R"({"encoders": {"l_knee": {"device": 3, "counts_per_degree": 0}}})",
       "counts per degree cannot be 0"},
      {layout(R"("motors", "motors")"), "the column 'motors' is given twice"},
      {layout(R"("a", "interval", "motors")"), "the column 'interval' must be the first one"},
      {layout(R"("a b", "motors")"), "'a b' cannot be the text of a column"},
      {layout(R"("a")"), "the column 'motors' is missing"},
      {layout(R"("interval", "motors")"), "after 'interval', a layout needs \"2\""},
      {layout(R"("interval", "2", "motors", "*")"), "'*' (any text) is possible only in layouts"},
      {layout(R"("motors")", R"(, "intervals_ms": [0])"), "an interval of 0 ms is not possible"},
      {layout(R"("interval", "2", "motors")", R"(, "unit": "rad")"),
       "a layout with 'interval' contains servo targets"},
      {R"({"layouts": [{"name": "a", "motors": 0, "columns": ["motors"]}]})",
       "0 motors are not possible; expected 1 to 127"},
      {R"({"sensors": {"load_cells": {"left": {"columns": [0], "cells": [[1, 0]], "force": [1]}}}})",
       "columns are counted from 1"},
      {R"({"sensors": {"load_cells": {"left": {"columns": [1], "cells": [], "force": [1]}}}})",
       "there are 0 polynomials for 1 columns; give one polynomial for each"},
      {R"({"sensors": {"gyro": {"columns": [1, 2]}}})", "expected the columns of x, y and z"}};
  for (const auto& [members, part] : cases) expect_part(Changed(members).message(), part);
}

TEST(SidecarParts, NamesAndLimitsAreThoseOfTheModel) {
  const RobotModel model =
      Changed(R"({"aliases": {"LeftKnee": "l_knee"}, "position_limits_deg": {"l_elbow": [-30, 0]},
                  "links": {"l_foot": {"mass": 0.5, "com": [0, 0, 0.01],
                                       "inertia": [1e-4, 0, 0, 1e-4, 0, 1e-4]}}})")
          .load();
  EXPECT_EQ(model.description().aliases.at("LeftKnee"), "l_knee");
  const Dof& elbow = model.dofs().at(static_cast<size_t>(model.find_dof("l_elbow")));
  EXPECT_NEAR(elbow.lower, -EIGEN_PI / 6, 1e-12);
  EXPECT_NEAR(elbow.upper, 0, 1e-12);
}

// Bare rows of readings become forces and rates by the sidecar's polynomials, zeros and scales.
TEST(SidecarParts, CalibratedReadingsAreForcesAndRates) {
  const std::string cells =
      R"({"sensors": {"accelerometer": {"columns": [23, 24, 25], "zero": [1, 1, 1], "scale": [2, 2, 2]},
          "gyro": {"columns": [24, 25, 26]},
          "load_cells": {"left": {"columns": [21, 22], "cells": [[2, 1], [3, 0]], "force": [1, 5]},
                         "right": {"columns": [22], "cells": [[1, 0, 0]], "force": [1, 0]}}}})";
  const Changed changed(cells);
  const RobotModel model = changed.load();
  std::string row;
  for (int device = 0; device < 20; ++device) row += "0,";
  const std::string rows = row + "10,4,1,2,3,4\n" + row + "10,4,1,2,3,4\n";
  EXPECT_TRUE(holds_sensors(rows, "s.csv", model));
  EXPECT_FALSE(holds_sensors("t[s],l_knee\n0,0\n", "s.csv", model));
  EXPECT_TRUE(holds_sensors("t[s],fz.left[N]\n0,0\n", "s.csv", model));
  const SensorTable table = read_sensors_table(rows, "s.csv", model);
  EXPECT_EQ(table.dt, 0.001);
  EXPECT_EQ(table.foot_load(1, 0), (2 * 10 + 1) + 3 * 4 + 5);
  EXPECT_EQ(table.foot_load(1, 1), 16);
  EXPECT_EQ(table.acceleration.row(0), Eigen::RowVector3d(0, 2, 4));
  EXPECT_EQ(table.gyro.row(0), Eigen::RowVector3d(2, 3, 4));
  const std::string none = row + "0,0,1,2,3,4\n";
  expect_part(error_message([&] { read_sensors_table(none + none, "s.csv", model); }),
              "all readings of the load cells are 0");
}

TEST(SidecarParts, RecordingsOfWrongRowsAreRefused) {
  const RobotModel model = Changed("{}").load();
  const auto message = [&](const std::string& text) {
    return error_message([&] { read_angles(text, "r.csv", model); });
  };
  std::string targets;
  for (int device = 0; device < 20; ++device) targets += ",7";
  const std::string row = "5,2" + targets;
  expect_part(message(row + ",R\n0,2" + targets + ",R\n"),
              "r.csv:2: a row must begin with an interval [ms] and a code");
  expect_part(message(row + ",R\n" + row + ",1,R\n"),
              "r.csv:2: the row has 24 columns, but each row before it has");
  expect_part(message("5,2,1,R\n"),
              "the row has 4 columns, but the 20 devices of the robot need at least 22");
  expect_part(message(row + ",R\n"), "the sequence has fewer than two rows with targets");
  expect_part(message("t[s],l_knee[counts],l_knee\n0,1,1\n0.001,1,2\n"),
              "column 'l_knee': the joint already has another column");
  expect_part(message("t[s],l_knee[turns]\n0,1\n0.001,1\n"),
              "column 'l_knee[turns]': the unit 'turns' is not rad, deg or counts");
  const RobotModel bare = Changed(R"({"encoders": null, "layouts": null})").load();
  expect_part(error_message([&] { read_angles("1,2\n1,2\n", "r.csv", bare); }),
              "the rows are counts, but the robot 'hoap1' has no encoders");
  expect_part(
      error_message([&] { read_angles("t[s],l_knee[counts]\n0,1\n0.001,2\n", "r.csv", bare); }),
      "column 'l_knee[counts]': the joint has no encoder in the sidecar");
}

}  // namespace
}  // namespace ayumi::test
