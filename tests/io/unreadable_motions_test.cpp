// Damage that people and programs do to motion files: they are cut off, saved in another encoding,
// with other line ends or decimal commas, with values that are no numbers, or far too long. A file
// of every format that can be read is made and damaged, so that a new format is tested
// automatically.

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <functional>

#include "ayumi/base/error.hpp"
#include "tests/io/moving_motion.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {
namespace {

double rate_for(const MotionFormat& format) {
  return format.name == "op3-action" ? 62.5 : 100;  // all other formats can state this rate
}

ImportOptions options_for(const MotionFormat& format) {
  ImportOptions options;
  options.by_order = !(format.holds & kJointNames);
  if (!(format.holds & kRate)) options.rate = rate_for(format);
  return options;
}

struct Outcome {
  std::string message;  ///< message of the Error; "" if the file was read
  ImportedMotion motion = {};
};

// The joints of the keys as the rows of a motion.
ImportedMotion rows_of(const ImportedKeys& keys) {
  ImportedMotion motion;
  const auto& frames = keys.pattern.keyframes;
  motion.motion.theta.setZero(static_cast<Eigen::Index>(frames.size()), hoap1().dof_count());
  for (size_t k = 0; k < frames.size(); ++k)
    for (const auto& [joint, angle] : frames[k].joints)
      motion.motion.theta(static_cast<Eigen::Index>(k), hoap1().find_dof(joint)) = angle;
  motion.filled = keys.filled;
  return motion;
}

Outcome outcome_of(const MotionFormat& format, const std::string& bytes) {
  try {
    if (const auto keys = read_key_poses(bytes, "folder/m.dat", hoap1(), options_for(format)))
      return {"", rows_of(*keys)};
    return {"", read_motion_rows(bytes, "folder/m.dat", hoap1(), options_for(format))};
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_file) << error.what();
    return {error.what()};
  }
}

// The message is one line with the file and its assumed format or the formats that are read, and
// contains no control characters for a terminal.
void expect_one_line(const std::string& message, const std::string& what) {
  EXPECT_TRUE(message.starts_with("folder/m.dat:")) << what << ": " << message;
  EXPECT_LT(message.size(), 1500u) << what << ": " << message;
  EXPECT_TRUE(std::all_of(message.begin(), message.end(),
                          [](unsigned char c) { return c >= ' ' && c < 127; }))
      << what << ": " << message;
  EXPECT_TRUE(message.find(". Ayumi read the file in the format '") != std::string::npos ||
              message.find("import reads ") != std::string::npos ||
              message.find("; save ") != std::string::npos ||
              message.find("; cut the file") != std::string::npos ||
              message.find("the file is empty") != std::string::npos)
      << what << ": " << message;
}

// The result is the first rows of the motion, or a message of one line.
void expect_part_or_one_line(const Outcome& outcome, const MotionFile& whole,
                             const std::string& what) {
  if (!outcome.message.empty()) {
    expect_one_line(outcome.message, what);
    return;
  }
  const Eigen::MatrixXd& theta = outcome.motion.motion.theta;
  ASSERT_LE(theta.rows(), whole.rows()) << what;
  // A number that was cut off is another number: this may only be in the last row, and is reported.
  const auto& said = outcome.motion.filled;
  const bool warned = std::any_of(said.begin(), said.end(), [](const std::string& line) {
    return line.starts_with("the last line of the file has no line end");
  });
  const Eigen::Index sure = theta.rows() - (warned ? 1 : 0);
  EXPECT_LE((theta.topRows(sure) - whole.values.topRows(sure)).cwiseAbs().maxCoeff(), 1e-3) << what;
}

void expect_same(const Outcome& outcome, const ImportedMotion& whole, const std::string& what) {
  ASSERT_EQ(outcome.message, "") << what;
  EXPECT_EQ(outcome.motion.motion.theta, whole.motion.theta) << what;
  EXPECT_EQ(outcome.motion.motion.dt, whole.motion.dt) << what;
}

std::string text_with(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string utf16(const std::string& text, bool little) {
  std::string wide;
  for (const char c : text) wide += little ? std::string{c, '\0'} : std::string{'\0', c};
  return wide;
}

// The number in the middle of the file, as bytes [begin, end).
std::pair<size_t, size_t> middle_number(const std::string& text) {
  const auto digit = [&](size_t i) {
    return std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.' || text[i] == '-';
  };
  size_t begin = text.find_first_of(",[ \"", text.size() / 2);
  if (begin == std::string::npos) begin = 0;
  while (begin + 1 < text.size() && !digit(begin)) ++begin;
  size_t end = begin;
  while (end < text.size() && (digit(end) || text[end] == 'e')) ++end;
  return {begin, end};
}

class UnreadableMotions : public testing::TestWithParam<std::string> {
 protected:
  const MotionFormat& format() const { return *find_motion_format(GetParam()); }
  MotionFile motion() const { return moving(hoap1(), 40, rate_for(format())); }
  std::string file() const { return file_of(format(), hoap1(), motion()); }
};

TEST_P(UnreadableMotions, AreRefusedInOneLineOrReadAsTheyWere) {
  const std::string good = file();
  ASSERT_FALSE(good.empty()) << "tests/io/moving_motion.hpp has no file of this format";
  const Outcome whole = outcome_of(format(), good);
  ASSERT_EQ(whole.message, "");
  MotionFile read = motion();
  read.values = whole.motion.motion.theta;
  for (const double part : {0.03, 0.1, 0.33, 0.5, 0.66, 0.9, 0.97, 0.999})
    expect_part_or_one_line(
        outcome_of(format(),
                   good.substr(0, static_cast<size_t>(part * static_cast<double>(good.size())))),
        read, "cut at " + std::to_string(part));
  expect_one_line(outcome_of(format(), "").message, "empty");
  std::string noise;
  for (int i = 0; i < 4000; ++i) noise += static_cast<char>((i * 7919 + i / 256) % 256);
  expect_one_line(outcome_of(format(), noise).message, "noise");
  std::string mixed = good;
  mixed.insert(good.size() / 2, noise);
  expect_one_line(outcome_of(format(), mixed).message, "binary inside");
  if (format().binary) return;

  expect_same(outcome_of(format(), text_with(good, "\n", "\r\n")), whole.motion, "CR LF");
  expect_same(outcome_of(format(), text_with(good, "\n", "\r")), whole.motion, "CR");
  expect_same(outcome_of(format(), "\xEF\xBB\xBF" + good), whole.motion, "byte order mark");
  for (const bool little : {true, false}) {
    const std::string wide = utf16(good, little), mark = little ? "\xFF\xFE" : "\xFE\xFF";
    for (const std::string& bytes : {wide, mark + wide})
      EXPECT_EQ(outcome_of(format(), bytes).message,
                "folder/m.dat:1: the file is UTF-16 text; save the file as UTF-8");
  }
  // A file that contains its content twice is not read as if it had only the first part.
  const Outcome twice = outcome_of(format(), good + good);
  if (twice.message.empty())
    EXPECT_GT(twice.motion.motion.theta.rows(), whole.motion.motion.theta.rows());
  else
    expect_one_line(twice.message, "twice");
  const auto [begin, end] = middle_number(good);
  const auto with = [&](const std::string& word) {
    return good.substr(0, begin) + word + good.substr(end);
  };
  const std::string latin = outcome_of(format(), with("0.1\xE9")).message;
  EXPECT_NE(
      latin.find(
          "the byte 0xe9 is not UTF-8 text. The file may have another encoding, such as Latin-1 or "
          "Shift-JIS; save the file as UTF-8"),
      std::string::npos)
      << latin;
  for (const char* word : {"nan", "1e999", "abc", ""})
    expect_one_line(outcome_of(format(), with(word)).message, word);
  std::string commas = good;
  for (size_t i = 1; i + 1 < commas.size(); ++i)
    if (commas[i] == '.' && std::isdigit(static_cast<unsigned char>(commas[i - 1])) &&
        std::isdigit(static_cast<unsigned char>(commas[i + 1])))
      commas[i] = ',';
  if (commas == good) return;  // the file has only whole numbers
  const std::string refused = outcome_of(format(), commas).message;
  expect_one_line(refused, "decimal commas");
  EXPECT_NE(refused.find("decimal point"), std::string::npos) << refused;
}

// Joints that are mapped by order must be as many as those of the robot.
TEST_P(UnreadableMotions, AnotherNumberOfJointsIsRefused) {
  if ((format().holds & kJointNames) || !format().write) return;
  MotionFile fewer = motion();
  fewer.joints.pop_back();
  fewer.values.conservativeResize(Eigen::NoChange, fewer.values.cols() - 1);
  const std::string message = outcome_of(format(), file_of(format(), hoap1(), fewer)).message;
  expect_one_line(message, "19 joints");
  EXPECT_NE(message.find("'hoap1' has 20 joints"), std::string::npos) << message;
}

// There are only two joints, so that a file of a million rows may be opened.
TEST_P(UnreadableMotions, AMillionRowsAreRefusedBeforeTheyTakeTime) {
  if (format().binary || format().name == "hoap") return;  // here a row has all motors
  MotionFile two = motion();
  two.joints = {"l_knee", "r_knee"};
  two.values = Eigen::MatrixXd::Constant(40, 2, 0.5);
  for (BasePose& base : two.base) base = {};
  for (Eigen::Vector3d& zmp : two.zmp) zmp.setZero();
  const std::string good = file_of(format(), hoap1(), two);
  const size_t begin = good.find('\n', good.size() / 2) + 1, end = good.find('\n', begin) + 1;
  if (begin >= good.size() || end == 0) return;  // here the rows are not lines
  const std::string row = good.substr(begin, end - begin);
  std::string lines = good.substr(0, begin);
  for (int i = 0; i < 1'000'000; ++i) lines += row;
  lines += good.substr(begin);
  for (const bool one_line : {false, true}) {
    if (one_line) std::replace(lines.begin(), lines.end(), '\n', ' ');
    const std::clock_t started = std::clock();
    const std::string message = outcome_of(format(), lines).message;
    const double seconds = static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    expect_one_line(message, "a million rows");
    EXPECT_LT(seconds, 1) << message;
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, UnreadableMotions, testing::ValuesIn(read_format_names()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return c == '-' || c == '.'; }, '_');
                           return name;
                         });

TEST(UnreadableMotion, OtherVersionsAreRefused) {
  const auto refused = [](const std::string& name, const std::string& from, const std::string& to) {
    const MotionFormat& format = *find_motion_format(name);
    const std::string good = file_of(format, hoap1(), moving(hoap1(), 40, 100));
    EXPECT_NE(good.find(from), std::string::npos) << name;
    return outcome_of(format, text_with(good, from, to)).message;
  };
  EXPECT_NE(refused("csv", "ayumi.reference/1", "ayumi.reference/9")
                .find("reads ayumi.reference/1 and ayumi.motion/1"),
            std::string::npos);
  EXPECT_NE(refused("json", "ayumi.reference/1", "ayumi.reference/9").find("ayumi.reference/9"),
            std::string::npos);
  EXPECT_NE(refused("webots", ",V1.0,", ",V2.0,").find("Ayumi reads V1.0 and V1.1"),
            std::string::npos);
  EXPECT_NE(refused("choreonoid", "format_version: 4", "format_version: 9")
                .find("Ayumi reads versions 1 to 4"),
            std::string::npos);
}

TEST(UnreadableMotion, WhatNestsOrGoesOnForeverIsRefused) {
  const auto many = [](const std::string& text, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += text;
    return all;
  };
  const MotionFormat& any = *find_motion_format("csv");
  for (const std::string& bytes :
       {many("<ActuatorCurve>", 300'000), "<a><ActuatorCurve/>" + many("<b>", 1000),
        "{\"columns\":" + many("[", 300'000),
        "joint_names: x\ntime_from_start: " + many("[", 90'000),
        "t,l_knee\n0," + many("1", 5'000'000), "t," + many("a,", 3'000'000) + "\n"})
    expect_one_line(outcome_of(any, bytes).message, bytes.substr(0, 20));
}

}  // namespace
}  // namespace ayumi::test
