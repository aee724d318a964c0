// A log that is written while it grows is the same as a log that is written at once.
#include "ayumi/io/run/log_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <iterator>

#include "ayumi/base/file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/json.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

SimulationSample sample_at_row(size_t k) {
  const double t = 0.001 * static_cast<double>(k);
  SimulationSample s;
  for (Eigen::VectorXd* v : {&s.state.theta, &s.state.dtheta, &s.target, &s.torque,
                             &s.reference_theta, &s.command_theta, &s.reference_dtheta, &s.weight})
    *v = Eigen::VectorXd::Constant(1, std::sin(3 * t));
  s.state.dtheta *= 3;
  s.cog = {0.1 * std::sin(t), 0.1 * std::cos(2 * t), 0.3};
  s.planned_contact[0] = k % 700 < 500;
  s.contact_iterations = static_cast<int>(k % 7);
  return s;
}

SimulationLog log_of_rows(size_t rows) {
  SimulationLog log;
  log.controller = ControllerKind::dtad;
  log.gains = {{"ka", 1.0 / 3}};
  log.provenance = {"hoap1", "ab", "walk", "cd", "hoap1", "dtad", "ayumi run walk.json"};
  log.joints = {"a"};
  log.events = {{0.1, EventKind::push, "1.1 N s"}};
  for (size_t k = 0; k < rows; ++k) log.samples.push_back(sample_at_row(k));
  return log;
}

/// A log of more than one block. It is made once, because most tests only read it.
const SimulationLog& long_log() {
  static const SimulationLog log = log_of_rows(kLogBlockRows + 3);
  return log;
}
const std::string& long_bytes() {
  static const std::string bytes = log_bytes(long_log());
  return bytes;
}

SimulationLog without_samples(const SimulationLog& log) {
  SimulationLog about = log;
  about.samples.clear();
  return about;
}

fs::path folder_of_logs() {
  const fs::path folder =
      fs::path(::testing::TempDir()) /
      ("ayumi_log_writer_" +
       std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

WrittenLog write_in_steps(const SimulationLog& log, const fs::path& file) {
  LogWriter writer(file.parent_path(), log.joints);
  for (const SimulationSample& sample : log.samples) writer.add(sample);
  return writer.finish(without_samples(log), file);
}

std::string log_error(const std::string& bytes) {
  return test::error_message([&] { parse_log(bytes, "x.bin"); }, ErrorCode::bad_file);
}

TEST(LogWriter, WritesTheBytesOfTheWholeLog) {
  const fs::path folder = folder_of_logs();
  for (const SimulationLog& log : {log_of_rows(0), log_of_rows(1), log_of_rows(20)}) {
    const WrittenLog written = write_in_steps(log, folder / "log.bin");
    EXPECT_EQ(read_file(folder / "log.bin"), log_bytes(log));
    EXPECT_EQ(written.rows, log.samples.size());
    EXPECT_EQ(written.log_hash, log_hash(log));
    EXPECT_EQ(written.file_hash, sha256(log_bytes(log)));
    EXPECT_EQ(simulation_json(written), simulation_json(log));
  }
  const WrittenLog written = write_in_steps(long_log(), folder / "log.bin");
  EXPECT_EQ(read_file(folder / "log.bin"), long_bytes());
  EXPECT_EQ(written.log_hash, log_hash(long_log()));
  EXPECT_EQ(written.file_hash, sha256(long_bytes()));
  // No scratch file is left.
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);
}

TEST(LogWriter, NothingIsThereBeforeTheEndAndAfterAnInterruption) {
  const fs::path folder = folder_of_logs();
  {
    LogWriter writer(folder, long_log().joints);
    for (const SimulationSample& sample : long_log().samples) writer.add(sample);
    EXPECT_TRUE(fs::is_empty(folder));
    EXPECT_THROW(writer.finish(without_samples(long_log()), folder / "log.bin",
                               [](const ProgressEvent&) { return false; }),
                 Interrupted);
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST(LogWriter, AFolderThatIsNotThereIsRefused) {
  const std::string message =
      test::error_message([] { LogWriter("/nowhere/at/all", {"a"}); }, ErrorCode::bad_file);
  EXPECT_EQ(message,
            "/nowhere/at/all: no file can be made in this folder (No such file or directory)");
}

TEST(LogWriter, ARunKnowsItsWrittenLogs) {
  const fs::path folder = folder_of_logs();
  RunFolder whole, streamed;
  whole.provenance = streamed.provenance = long_log().provenance;
  whole.logs = {{"closed_loop", log_of_rows(3)}, {"open_loop", log_of_rows(5)}};
  streamed.logs = {{"open_loop", log_of_rows(5)}};
  for (const char* name : {"whole", "streamed"}) fs::create_directory(folder / name);
  streamed.written["closed_loop"] =
      write_in_steps(log_of_rows(3), folder / "streamed" / log_file_name("closed_loop"));
  write_run(folder / "whole", whole);
  write_run(folder / "streamed", streamed);
  for (const char* name : {"run.json", "log_closed_loop.bin", "log_open_loop.bin"})
    EXPECT_EQ(read_file(folder / "whole" / name), read_file(folder / "streamed" / name)) << name;
}

TEST(LogHash, IsThatOfTheLogHoweverManyRowsWait) {
  LogHash hash(folder_of_logs(), long_log().joints.size());
  for (const SimulationSample& sample : long_log().samples) hash.add(sample);
  const WrittenLog written = hash.finish(without_samples(long_log()));
  EXPECT_EQ(written.log_hash, log_hash(long_log()));
  EXPECT_EQ(written.rows, long_log().samples.size());
  EXPECT_EQ(written.file_hash, "");
  const SimulationLog none = log_of_rows(0);
  EXPECT_EQ(LogHash("/nowhere", 1).finish(none).log_hash, log_hash(none));
}

TEST(LogInBlocks, IsReadBackWhole) {
  const auto header = [](const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return test::json_of(bytes.substr(20, length));
  };
  EXPECT_EQ(long_bytes()[8], 4);
  EXPECT_EQ(header(long_bytes()).at("format"), "ayumi.log/4");
  EXPECT_EQ(header(long_bytes()).at("block_rows"), kLogBlockRows);
  const SimulationLog back = parse_log(long_bytes(), "x.bin");
  ASSERT_EQ(back.samples.size(), long_log().samples.size());
  EXPECT_TRUE(log_hash(back) == log_hash(long_log()));
  EXPECT_TRUE(log_bytes(back) == long_bytes());
  // A log of one block is a log of version 3.
  const std::string short_bytes = log_bytes(log_of_rows(20));
  EXPECT_EQ(short_bytes[8], 3);
  EXPECT_FALSE(header(short_bytes).contains("block_rows"));
}

// A file without the places of the largest shares was written before these were stored.
TEST(LogInBlocks, KeepsTheJointAndTheTimeOfTheLargestShares) {
  SimulationLog log = log_of_rows(20);
  const SimulationLog old = parse_log(log_bytes(log), "x.bin");
  EXPECT_EQ(old.result.torque.joint, -1);
  log.result.torque = {.ratio = 0.7, .joint = 0, .at = 0.01};
  const SimulationLog back = parse_log(log_bytes(log), "x.bin");
  EXPECT_EQ(back.result.torque.ratio, 0.7);
  EXPECT_EQ(back.result.torque.joint, 0);
  EXPECT_EQ(back.result.torque.at, 0.01);
  EXPECT_EQ(back.result.speed.joint, -1);
  EXPECT_TRUE(log_hash(back) == log_hash(log));
}

TEST(LogInBlocks, BrokenFilesGetOneClearMessage) {
  const std::string& good = long_bytes();
  EXPECT_NE(log_error(good.substr(0, good.size() - 1)).find("truncated or damaged"),
            std::string::npos);
  EXPECT_NE(log_error(good + "xy").find("damaged: there are 2 bytes after the samples"),
            std::string::npos);
  std::string third = good;  // this one says that all blocks are one
  third[8] = 3;
  EXPECT_NE(log_error(third).find("damaged: there are "), std::string::npos);
  std::string flipped = good;
  flipped[good.size() - 100] = static_cast<char>(flipped[good.size() - 100] ^ 0x15);
  EXPECT_NE(log_error(flipped).find("damaged"), std::string::npos);
  SimulationLog infinite = long_log();
  infinite.samples.back().zmp.x() = INFINITY;
  EXPECT_EQ(log_error(log_bytes(infinite)),
            "x.bin: the file is damaged: row 32770, column 'zmp.x[m]' is not a finite number");
}

}  // namespace
}  // namespace ayumi
