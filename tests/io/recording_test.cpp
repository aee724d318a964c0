// Recordings of robots: those that are read, and one line for those that cannot be read.

#include "ayumi/io/table/recording.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

std::string recording_error(const std::string& text, const RecordingOptions& options = {}) {
  try {
    read_angles(text, "m.csv", hoap1(), options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file);
    return error.what();
  }
  return "";
}

std::string counts_row(int knee, int columns = 22) {
  std::string row;
  for (int c = 0; c < columns; ++c)
    row += (c ? "," : "") + std::to_string(c == 3 ? knee : c == 0 ? 5 : 0);
  return row;
}

TEST(Recording, ReadsCountsSequencesAndNamedColumns) {
  const int knee = hoap1().find_dof("r_knee");
  const double degree = M_PI / 180;
  const AngleTable counts =
      read_angles(counts_row(2090) + "\n" + counts_row(2100) + "\n", "m.csv", hoap1());
  EXPECT_EQ(counts.dt, 0.001);
  EXPECT_NEAR(counts.theta(0, knee), 10 * degree, 1e-12);
  EXPECT_TRUE(counts.has[static_cast<size_t>(knee)]);
  const std::string sequence =
      "2,2," + counts_row(2090, 20) + ", R,R,R\r\n" + "2,2," + counts_row(2100, 20) + ",R,R,R\r\n";
  const AngleTable sent = read_angles(sequence, "c.csv", hoap1());
  EXPECT_EQ(sent.dt, 0.002);
  EXPECT_NEAR(sent.theta(1, knee), 2100 / 209.0 * degree, 1e-12);
  const AngleTable named = read_angles(
      "time_ms;r_knee[deg];theta.l_knee[rad];note\n0;10,5;0,1;0\n5;10,6;0,1;0\n", "t.csv", hoap1());
  EXPECT_NEAR(named.dt, 0.005, 1e-12);
  EXPECT_NEAR(named.theta(0, knee), 10.5 * degree, 1e-12);
  EXPECT_NEAR(named.theta(1, hoap1().find_dof("l_knee")), 0.1, 1e-12);
  EXPECT_FALSE(named.has[static_cast<size_t>(hoap1().find_dof("l_elbow"))]);
}

// The same recording as pandas, spreadsheets and other programs write it.
TEST(Recording, NamesAndUnitsMayBeWrittenInOtherWays) {
  const int knee = hoap1().find_dof("r_knee");
  for (const char* text :
       {"t,r_knee\n0,0.1\n0.005,0.2\n", ",t,r_knee\n0,0,0.1\n1,0.005,0.2\n",
        "Time (ms);R_KNEE (rad)\n0;0,1\n5;0,2\n", "time [ms],r_knee_rad\n0,0.1\n5,0.2\n",
        "timestamp,r_knee_deg\n1000,5.729577951308232\n"
        "1000.005,11.459155902616465\n",
        "TIME_MS,R_KNEE[RAD]\n0,0.1\n5,0.2\n", "Time[MS],r_knee_RAD\n0,0.1\n5,0.2\n",
        "timestamp_us,r_knee\n0,0.1\n5000,0.2\n", "time_ns,r_knee\n0,0.1\n5000000,0.2\n",
        "TIME\tr_knee [deg]\n0\t5.729577951308232\n"
        "0.005\t11.459155902616465\n"}) {
    const AngleTable read = read_angles(text, "m.csv", hoap1());
    EXPECT_NEAR(read.dt, 0.005, 1e-9) << text;
    EXPECT_NEAR(read.theta(0, knee), 0.1, 1e-12) << text;
    EXPECT_NEAR(read.theta(1, knee), 0.2, 1e-12) << text;
    EXPECT_TRUE(read.timed) << text;
    ASSERT_TRUE(read.clock_start.has_value());
  }
}

TEST(Recording, WhatIsNoRecordingGetsOneLine) {
  const std::string a = counts_row(2090), b = counts_row(2091);
  EXPECT_EQ(recording_error(""), "m.csv: the file is empty");
  EXPECT_EQ(recording_error(a + "\n" + b + "\r\n" + a + "\n"),
            "m.csv:2: this line ends with CR LF, but the lines before it end with LF; the file may "
            "consist of parts of two files. Use one kind of line end");
  EXPECT_EQ(recording_error(a + "\n" + b.substr(0, 20) + "\n"),
            "m.csv:2: the row has 9 columns, but each row before it has 22");
  EXPECT_EQ(recording_error(a + "\nnan" + b.substr(1) + "\n"),
            "m.csv:2: column 1: 'nan' is not a finite number");
  EXPECT_EQ(recording_error(a + "\n" + counts_row(2090 - 65536) + "\n"),
            "m.csv:2: r_knee jumps by 314 deg from the row before, but a motor moves at most 1.36 "
            "deg in this time. Samples are missing, or the 16-bit counter of the encoder has "
            "overflowed. Record again; "
            "after an overflow, you can also add or subtract 65536 counts from this row on");
  EXPECT_EQ(recording_error("0,0,0,0,0,0\n0,0,0,0,0,0\n"),
            "m.csv:1: the row has 6 columns, but the robot 'hoap1' needs 20; is this a recording "
            "of another "
            "robot?");
  EXPECT_EQ(recording_error(a + ",7\n" + b + ",7\n"),
            "m.csv:1: column 23 is 7, but the robot 'hoap1' has 20 devices; is this a recording of "
            "another robot?");
  EXPECT_EQ(
      recording_error("0.5" + a.substr(1) + "\n" + b + "\n"),
      "m.csv:1: the columns have no names, so their values must be encoder counts, but 0.5 is "
      "not a whole number. If the values are angles, add a first row with the names of the "
      "columns, such as t[s] and "
      "r_hip_yaw[rad]");
  EXPECT_NE(recording_error(a + "\n" + "0.5" + b.substr(1) + "\n")
                .find("m.csv:2: the columns have no names"),
            std::string::npos);
  EXPECT_EQ(
      recording_error("time[min],r_knee\n0,0.1\n1,0.2\n"),
      "m.csv: the unit of the times in the column 'time[min]' is not known; units are s, ms, us "
      "and ns");
  std::string zeros;
  for (int c = 0; c < 23; ++c) zeros += c ? ",0" : "0";
  EXPECT_EQ(recording_error(zeros + "\n" + zeros + "\n"),
            "m.csv: all angles are 0, so the robot or its recorder was not running; record again");
}

TEST(Recording, ATableWithGapsOrOtherUnitsGetsOneLine) {
  EXPECT_EQ(recording_error("t,r_knee\n0,0.1\n0.001,0.1\n0.002,0.1\n0.010,0.1\n0.011,0.1\n"),
            "m.csv: after t = 0.002 s (data row 3) 7 samples are missing, because the next row "
            "comes 8 ms later, but usually a row comes 1 ms "
            "after the row before; record again");
  EXPECT_EQ(recording_error("t,r_knee\n0,0.1\n0.001,0.1\n0.002,0.1\n0.004,0.1\n0.005,0.1\n"),
            "m.csv: after t = 0.002 s (data row 3) 1 sample is missing, because the next row comes "
            "2 ms later, but usually a row comes 1 ms "
            "after the row before; record again");
  EXPECT_EQ(
      recording_error("t,r_knee\n0,0.1\n0,0.2\n0.002,0.1\n0.003,0.1\n0.004,0.1\n"),
      "m.csv: after t = 0 s (data row 1) the time does not increase; correct the time column");
  EXPECT_EQ(recording_error("t,r_knee\n0,45\n0.001,45\n0.002,45\n"),
            "m.csv: r_knee reaches 45 rad, which is more than a turn; if the angles are in "
            "degrees, give --unit deg");
  // If angles are degrees and move by more than a motor can, the unit is reported first.
  EXPECT_EQ(recording_error("t,r_knee\n0,40\n0.001,45\n0.002,45\n"),
            "m.csv: r_knee reaches 45 rad, which is more than a turn; if the angles are in "
            "degrees, give --unit deg");
  EXPECT_EQ(recording_error("t,r_knee[mm]\n0,45\n0.001,45\n"),
            "m.csv: column 'r_knee[mm]': the unit 'mm' is not rad, deg or counts");
  EXPECT_EQ(recording_error("t,r_knee\n0,0.1\n5,0.1\n10,0.1\n"),
            "m.csv: the times of 't' have no unit, and they increase by 5 per row; name the column "
            "t[ms] or t[s]");
  for (const auto& [end, rate] : {std::pair("1e-300", "1e+300"), std::pair("60", "0.01667")})
    EXPECT_EQ(recording_error("t[s],r_knee\n0,0.1\n" + std::string(end) + ",0.1\n"),
              "m.csv: the file has " + std::string(rate) +
                  " rows per second, but a recording must have from 1 to 1e+05 rows per second; "
                  "correct the times");
  EXPECT_TRUE(recording_error("t,knee\n0,0.1\n0.001,0.1\n")
                  .starts_with("m.csv: no column is a joint of 'hoap1'; its joints are r_hip_yaw"));
}

TEST(Recording, LoadCellsNeedACalibrationOrNames) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read_sensors_table(text, "s.csv", hoap1());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      message("1,2,3\n1,2,3\n"),
      "s.csv: the rows are readings without names, but the sidecar of 'hoap1' does not say "
      "which sensors the columns belong to; add \"load_cells\" to \"sensors\" in the sidecar");
  const SensorTable table =
      read_sensors_table("t,fz.left[N],fz.right[N]\n0,30,34\n0.001,31,33\n", "s.csv", hoap1());
  EXPECT_EQ(table.foot_load(1, 0), 31);
  EXPECT_EQ(table.foot_load(1, 1), 33);
  EXPECT_EQ(message("t,left,right\n0,0,0\n0.001,0,0\n"),
            "s.csv: all loads of the feet are 0, so the sensors were not running; record again");
}

}  // namespace
}  // namespace ayumi::test
