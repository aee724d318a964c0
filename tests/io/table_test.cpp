#include "ayumi/io/table/table.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "ayumi/base/error.hpp"
#include "ayumi/io/table/number_table.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

fs::path put(const std::string& text) {
  const fs::path path =
      fs::path(::testing::TempDir()) /
      ("ayumi_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
       ".table");
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

std::string dense_message(const std::string& text) {
  return test::error_message([&] { read_dense_table(put(text)); }, ErrorCode::bad_file);
}
std::string reference_message(const std::string& text) {
  return test::error_message([&] { read_reference(put(text)); }, ErrorCode::bad_file);
}

// Any finite double, including the awkward ones.
class Random {
 public:
  double number() {
    static const double awkward[] = {-0.0, 5e-324, 0.1, 1.0 / 3, 1e-9, -1.7976931348623157e308};
    if (engine_() % 8 == 0) return awkward[engine_() % 6];
    return static_cast<double>(engine_()) / 1e9 - 2;
  }
  Eigen::Vector3d vector() { return {number(), number(), number()}; }
  bool coin() { return engine_() % 2 == 0; }

 private:
  std::mt19937 engine_{7};
};

ReferenceTrajectory random_reference() {
  Random random;
  ReferenceTrajectory reference;
  reference.dt = 0.001;
  reference.joints = {"l_knee", "r knee, odd"};
  reference.joints[1] = "r_knee";
  reference.provenance = {"hoap1", "ab12", "walk: \"two\"\n lines",  "cd",
                          "real",  "dtad", " ayumi run --x=\"a b\" "};
  for (int k = 0; k < 200; ++k) {
    ReferenceRow row;
    row.theta = Eigen::Vector2d(random.number(), random.number());
    row.base.position = random.vector();
    row.base.attitude =
        Eigen::Quaterniond(0.1 + std::abs(std::sin(k)), 0.3, -0.2, 0.7).normalized();
    row.cog = random.vector();
    row.zmp = random.vector();
    row.fz = random.number();
    row.contact = {random.coin(), random.coin()};
    reference.rows.push_back(row);
  }
  return reference;
}

void expect_same_bits(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b)) << a << " " << b;
}

void expect_same_bits(const ReferenceTrajectory& a, const ReferenceTrajectory& b) {
  expect_same_bits(a.dt, b.dt);
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.provenance.robot, b.provenance.robot);
  EXPECT_EQ(a.provenance.robot_sha256, b.provenance.robot_sha256);
  EXPECT_EQ(a.provenance.pattern, b.provenance.pattern);
  EXPECT_EQ(a.provenance.pattern_sha256, b.provenance.pattern_sha256);
  EXPECT_EQ(a.provenance.profile, b.provenance.profile);
  EXPECT_EQ(a.provenance.controller, b.provenance.controller);
  EXPECT_EQ(a.provenance.command_line, b.provenance.command_line);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (size_t k = 0; k < a.rows.size(); ++k) {
    for (int j = 0; j < 2; ++j) expect_same_bits(a.rows[k].theta[j], b.rows[k].theta[j]);
    for (int i = 0; i < 3; ++i) {
      expect_same_bits(a.rows[k].cog[i], b.rows[k].cog[i]);
      expect_same_bits(a.rows[k].zmp[i], b.rows[k].zmp[i]);
      expect_same_bits(a.rows[k].base.position[i], b.rows[k].base.position[i]);
    }
    for (int i = 0; i < 4; ++i)
      expect_same_bits(a.rows[k].base.attitude.coeffs()[i], b.rows[k].base.attitude.coeffs()[i]);
    expect_same_bits(a.rows[k].fz, b.rows[k].fz);
    EXPECT_EQ(a.rows[k].contact, b.rows[k].contact);
  }
}

TEST(Table, CsvReadsBackToTheSameBits) {
  const ReferenceTrajectory reference = random_reference();
  const std::string text = reference_csv(reference);
  const ReferenceTrajectory back = read_reference(put(text));
  expect_same_bits(reference, back);
  EXPECT_EQ(reference_csv(back), text);
}

TEST(Table, JsonReadsBackToTheSameBits) {
  const ReferenceTrajectory reference = random_reference();
  const std::string text = reference_json(reference);
  const ReferenceTrajectory back = read_reference(put(text));
  expect_same_bits(reference, back);
  EXPECT_EQ(reference_json(back), text);
}

// Files hold the angles that the encoders of the unit read, and the rows of a table hold those of
// its joints.
TEST(Table, AFileHoldsTheAnglesOfEncoders) {
  ReferenceTrajectory reference = random_reference();
  const ReferenceTrajectory plain = reference;
  reference.servo.zeros = Eigen::Vector2d(0.007, -0.02);
  const std::string text = reference_csv(reference);
  EXPECT_NE(text.find("# servo_offset: 0.007 -0.02\n"), std::string::npos);
  for (const std::string& file : {text, reference_json(reference)}) {
    const ReferenceTrajectory back = read_reference(put(file));
    EXPECT_EQ(back.servo.zeros, reference.servo.zeros);
    for (size_t k = 0; k < back.rows.size(); ++k)
      EXPECT_LT((back.rows[k].theta - plain.rows[k].theta).norm(), 4e-15);
  }
  EXPECT_LT((read_dense_table(put(text)).theta.row(3).transpose() - plain.rows[3].theta).norm(),
            4e-15);
  std::string bad = text;
  bad.replace(bad.find("0.007 -0.02"), 11, "0.007");
  EXPECT_NE(reference_message(bad).find("servo_offset"), std::string::npos);
}

TEST(Table, SaysWhatItHolds) {
  const std::string text = reference_csv(random_reference());
  for (const char* const line :
       {"# format: ayumi.reference/1\n", "# dt: 0.001\n", "# rate_hz: 1000\n",
        "# gravity: 9.80665\n", "# quaternion_order: w x y z, base to world\n",
        "\nt[s],theta.l_knee[rad],theta.r_knee[rad],cog.x[m],cog.y[m],cog.z[m],zmp.x[m],zmp.y[m],"
        "zmp.z[m],fz[N],base.x[m],base.y[m],base.z[m],base.qw,base.qx,base.qy,base.qz,"
        "contact.left,contact.right\n0,"})
    EXPECT_NE(text.find(line), std::string::npos) << line;
}

TEST(Table, RefusesOtherJoints) {
  const ReferenceTrajectory reference = random_reference();
  EXPECT_NO_THROW(require_joints(reference, {"l_knee", "r_knee"}, "f"));
  EXPECT_THROW(require_joints(reference, {"l_knee"}, "f"), Error);
  try {
    require_joints(reference, {"r_knee", "l_knee"}, "f");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "f: joint 1 of the table is 'l_knee', but joint 1 of the robot is 'r_knee'");
  }
}

TEST(Table, NeverWritesWhatIsNotANumber) {
  ReferenceTrajectory reference = random_reference();
  reference.rows[3].fz = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(reference_csv(reference), Error);
  EXPECT_THROW(reference_json(reference), Error);
}

TEST(Table, BrokenTablesGetOneClearMessage) {
  struct Case {
    std::string text, message;
  };
  const std::string head = "t[s],theta.a[rad]\n";
  std::string long_rows;
  for (int k = 0; k < 400; ++k) long_rows += std::to_string(10 * k) + ",1\n";
  for (const Case& each : std::vector<Case>{
           {"", "the file is empty"},
           {"# only a comment\n", "the head row is missing"},
           {head, "no data row below the head row"},
           {"0,1\n1,2\n", ":1: the head row is missing: the first line has the number '0'"},
           {"t[s],theta.a[rad],\n0,1,2\n", ":1: column 3 has no name"},
           {"t[s],theta.a[rad],t[s]\n0,1,2\n", ":1: the column 't[s]' appears twice"},
           {head + "0,1\n0.001\n", ":3: the row has 1 value, but the head row names 2 columns"},
           {head + "0,1,2\n", ":2: the row has 3 values, but the head row names 2 columns"},
           {head + "0,one\n", ":2: column 'theta.a[rad]': 'one' is not a number"},
           {head + "0,\n", ":2: column 'theta.a[rad]': '' is not a number"},
           {head + "0,1 rad\n", "'1 rad' is not a number"},
           {head + "0,nan\n", "'nan' is not a finite number"},
           {head + "0,1e999\n", "'1e999' is not a number"},
           {head + "0,1\n0,1\n", "row 2: time 0 s does not come after 0 s"},
           {head + "0,1\n0.001,1\n0.003,1\n", "the rows start at 0 s and are evenly spaced"},
           {head + "1,1\n1.001,1\n", "row 1: time 1 s, but 0 s is expected"},
           {"# dt: 1e-3 s\n" + head + "0,1\n", "dt '1e-3 s' is not a time step"},
           {head + "0,1\n1e-300,1\n",
            "the time between two rows is 1e-300 s, but it must be from 1e-07 to 10 s"},
           {"# dt: 1e-300\n" + head + "0,1\n1e-300,1\n", "the time between two rows is 1e-300 s"},
           {head + "0,1\n60,1\n", "the time between two rows is 60 s"},
           {"time,theta.a[rad]\n0,1\n", "unknown column 'time'"},
           {"t[s],theta.a[deg]\n0,1\n", "unknown column 'theta.a[deg]'"},
           {"t[s],cog.x[m]\n0,1\n",
            "the table has the column 'cog.x[m]', but the column 'cog.z[m]' is missing"},
           {"theta.a[rad]\n1\n", "the column 't[s]' is missing"},
           {"t[s],base.x[m],base.y[m],base.z[m],base.qw,base.qx,base.qy,base.qz\n0,0,0,0,1,1,0,0\n",
            "row 1: base.qw...qz has length 1.414"},
           {std::string("\x89PNG\r\n\x1a\n\0\0\0", 11), "is a binary file"},
           {head + "0,1\n1e9,1\n",
            "the time between two rows is 1e+09 s, but it must be from 1e-07 to 10 s"},
           {head + long_rows, "the table lasts 4000 s, but Ayumi reads at most 3600 s"},
           {"{\"columns\": [\"t[s]\"]}", "the key 'data' is missing"},
           {"{\"columns\": [\"t[s]\"], \"data\": []}", "/data: the table has no data row"},
           {"{\"columns\": [\"t[s]\"], \"data\": [[0], [1, 2]]}", "/data/1: the row has 2 values"},
           {"{\"columns\": [\"t[s]\"], \"data\": [[\"0\"]]}",
            "/data/0/0: expected a number, found a string"}}) {
    const std::string text = dense_message(each.text);
    EXPECT_NE(text.find(each.message), std::string::npos) << each.text << "\n  gave: " << text;
  }
}

TEST(Table, ReferencesNeedTheirFormatAndAllColumns) {
  std::string text = reference_csv(random_reference());
  EXPECT_NE(reference_message("t[s],theta.a[rad]\n0,1\n").find("the format line is missing"),
            std::string::npos);
  EXPECT_NE(reference_message("# format: ayumi.reference/1\nt[s],theta.a[rad]\n0,1\n")
                .find("some of these columns are missing"),
            std::string::npos);
  text.replace(text.find("reference/1"), 11, "reference/9");
  EXPECT_NE(reference_message(text).find("format 'ayumi.reference/9' cannot be read"),
            std::string::npos);
}

TEST(Table, MotionOfAPatternKeepsItsBits) {
  DenseTable table;
  table.dt = 0.005;
  table.joints = {"a", "b"};
  table.theta = Eigen::MatrixXd::Random(50, 2);
  for (int k = 0; k < 50; ++k) table.zmp.push_back(Eigen::Vector3d::Random());
  for (int k = 0; k < 50; ++k) table.fz.push_back(k / 3.0);
  const std::string text = dense_table_csv(table);
  const DenseTable back = read_dense_table(put(text));
  EXPECT_EQ(back.dt, 0.005);
  EXPECT_EQ(back.joints, table.joints);
  EXPECT_EQ(back.theta, table.theta);
  EXPECT_EQ(back.zmp, table.zmp);
  EXPECT_EQ(back.fz, table.fz);
  EXPECT_TRUE(back.cog.empty() && back.base.empty());
  // A stabilised reference may also serve as the motion of a pattern.
  EXPECT_EQ(read_dense_table(put(reference_csv(random_reference()))).theta.rows(), 200);
}

}  // namespace
}  // namespace ayumi
