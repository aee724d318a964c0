#include "ayumi/io/run/run_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/log_fields.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/json.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;

SimulationSample random_sample(test::Random& random, int joints) {
  SimulationSample s;
  s.state.base = {random.vector(1), Eigen::Quaterniond(1, random.uniform(), 0.2, 0.1).normalized()};
  s.state.base_velocity = random.vector(1);
  s.state.base_angular_velocity = random.vector(1);
  for (Eigen::VectorXd* v : {&s.state.theta, &s.state.dtheta, &s.target, &s.torque,
                             &s.reference_theta, &s.command_theta, &s.reference_dtheta, &s.weight})
    *v = random.vector(joints, 1);
  s.reference_base.position = s.command_base.position = random.vector(1);
  for (Eigen::Vector3d* v : {&s.cog,
                             &s.dcog,
                             &s.zmp,
                             &s.measured_cog,
                             &s.measured_zmp,
                             &s.command_cog,
                             &s.command_zmp,
                             &s.reference_cog,
                             &s.reference_zmp,
                             &s.foot_force[0],
                             &s.foot_force[1],
                             &s.foot_cop[0],
                             &s.foot_cop[1],
                             &s.push_force,
                             &s.push_point,
                             &s.measured_dcog,
                             &s.command_dcog,
                             &s.reference_dcog,
                             &s.reference_ddcog,
                             &s.law.planned_zmp,
                             &s.law.wanted_zmp,
                             &s.law.filtered_zmp,
                             &s.law.offset,
                             &s.law.motion,
                             &s.law.short_term,
                             &s.law.pull,
                             &s.law.rocking})
    *v = random.vector(1);
  for (double* x :
       {&s.law.K, &s.law.D, &s.law.height, &s.law.omega2, &s.law.K_z, &s.law.D_z, &s.law.K_Pz,
        &s.law.K_Dz, &s.law.spring_goal, &s.law.spring_height, &s.law.spring_rate, &s.residuals.cog,
        &s.residuals.foot, &s.residuals.foot_turn, &s.residuals.trunk})
    *x = random.uniform();
  s.law.stage = static_cast<LawStage>(static_cast<int>(random.uniform(0, 11.9)));
  for (double* x : {&s.fz, &s.measured_fz, &s.command_fz, &s.reference_fz, &s.contact_residual,
                    &s.work.servos, &s.work.contacts, &s.work.outside, &s.work.joints})
    *x = random.uniform();
  s.planned_contact = {random.uniform() > 0, random.uniform() > 0};
  s.contact_iterations = static_cast<int>(random.uniform(0, 50));
  return s;
}

SimulationLog random_log(unsigned seed) {
  test::Random random(seed);
  SimulationLog log;
  log.controller = ControllerKind::dtad;
  log.gains = {{"ka", 1.0 / 3}, {"tau_z", 0.01}};
  log.provenance = {"hoap1", "ab", "walk", "cd", "hoap1", "dtad", "ayumi run walk.json"};
  log.world.slope = {0.01, 1.0 / 3};
  const Push push{.magnitude = 1.1,
                  .direction = Eigen::Vector3d(1, 2, 3).normalized(),
                  .shape = PushShape::half_sine};
  log.scenario = {{.at = 0.1, .what = push}};
  log.joints = {"a", "b", "c"};
  log.events = {{0.1, EventKind::push, "1.1 N s on the \"COG\""}};
  log.result = {.outcome = Outcome::stands, .max_tilt = 0.1 + 0.2, .steps = 9};
  for (int k = 0; k < 20; ++k) log.samples.push_back(random_sample(random, 3));
  return log;
}

fs::path fresh_folder() {
  const fs::path folder =
      fs::path(::testing::TempDir()) /
      ("ayumi_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
  fs::remove_all(folder);
  return folder;
}

template <typename Do>
std::string file_error(const Do& work) {
  return test::error_message(work, ErrorCode::bad_file);
}
std::string parse_message(const std::string& bytes) {
  return file_error([&] { parse_log(bytes, "x.bin"); });
}

TEST(SimulationLogFile, EveryFieldSurvives) {
  const SimulationLog log = random_log(1);
  const SimulationLog back = parse_log(log_bytes(log), "x.bin");
  // A few fields are compared one by one, and the whole by its bytes.
  ASSERT_EQ(back.samples.size(), log.samples.size());
  EXPECT_EQ(back.samples[7].state.base.attitude.coeffs(),
            log.samples[7].state.base.attitude.coeffs());
  EXPECT_EQ(back.samples[7].state.dtheta, log.samples[7].state.dtheta);
  EXPECT_EQ(back.samples[7].reference_theta, log.samples[7].reference_theta);
  EXPECT_EQ(back.samples[7].command_theta, log.samples[7].command_theta);
  EXPECT_EQ(back.samples[7].foot_cop[1], log.samples[7].foot_cop[1]);
  EXPECT_EQ(back.samples[7].planned_contact, log.samples[7].planned_contact);
  EXPECT_EQ(back.samples[7].law.stage, log.samples[7].law.stage);
  EXPECT_EQ(back.samples[7].law.rocking, log.samples[7].law.rocking);
  EXPECT_EQ(back.samples[7].residuals.trunk, log.samples[7].residuals.trunk);
  EXPECT_EQ(back.gains, log.gains);
  EXPECT_EQ(back.samples[7].contact_iterations, log.samples[7].contact_iterations);
  EXPECT_EQ(back.samples[19].push_point, log.samples[19].push_point);
  const Push &a = std::get<Push>(back.scenario.at(0).what),
             &b = std::get<Push>(log.scenario[0].what);
  EXPECT_EQ(a.direction, b.direction);
  EXPECT_EQ(a.shape, PushShape::half_sine);
  EXPECT_EQ(back.events.at(0).text, log.events[0].text);
  EXPECT_EQ(back.world.slope, log.world.slope);
  EXPECT_EQ(back.result.outcome, Outcome::stands);
  EXPECT_EQ(back.result.max_tilt, 0.1 + 0.2);
  EXPECT_EQ(back.provenance.command_line, log.provenance.command_line);
  EXPECT_EQ(log_bytes(back), log_bytes(log));
}

// A field that for_each_field() forgets would be lost silently: the size shows it.
TEST(SimulationLogFile, NoFieldOfASampleIsForgotten) {
  const SimulationLog log = random_log(2);
  const std::string bytes = plain_log_bytes(log);
  std::uint32_t header = 0;
  std::memcpy(&header, bytes.data() + 12, 4);
  // Poses 3 x 7, joint vectors 8 x 3, 3-vectors 2 + 15 + 4, scalars 6, works 4, flags 2, count 1;
  // of the law 8 3-vectors, 11 scalars and the stage; residuals 4.
  const size_t columns = 21 + 24 + 3 * 21 + 6 + 4 + 2 + 1 + (3 * 8 + 11 + 1) + 4;
  EXPECT_EQ(bytes.size(), 16 + header + 20 * columns * 8);
  const auto json = test::json_of(bytes.substr(16, header));
  EXPECT_EQ(json.at("columns").size(), columns);
  EXPECT_EQ(json.at("columns").at(0), "base.x[m]");
  const size_t fields_of_plain_sample =
      3 * sizeof(BasePose) + 2 * 24 + 8 * sizeof(Eigen::VectorXd) + 19 * 24 + 6 * 8 +
      sizeof(EnergyBalance) + 8 + sizeof(LawTerms) + sizeof(TaskResiduals);
  EXPECT_EQ(sizeof(LawTerms), 8 * 24 + 11 * 8 + 8u) << "a field was added?";
  EXPECT_LE(sizeof(SimulationSample) - fields_of_plain_sample, 64u) << "a field was added?";
}

TEST(SimulationLogFile, ReadsFilesOfOlderVersions) {
  const SimulationLog log = random_log(8);
  const std::string old = plain_log_bytes(log), present = log_bytes(log);
  EXPECT_EQ(old[8], 1);
  EXPECT_EQ(present[8], 3);
  EXPECT_NE(old.find("ayumi.log/1"), std::string::npos);
  EXPECT_NE(present.find("ayumi.log/3"), std::string::npos);
  // With so few rows, no relation between columns is found; version 2 did not know such relations.
  std::string second = present;
  second[8] = 2;
  EXPECT_EQ(log_bytes(parse_log(second, "x.bin")), present);
  EXPECT_EQ(log_bytes(parse_log(old, "x.bin")), present);
  EXPECT_EQ(plain_log_bytes(parse_log(present, "x.bin")), old);
}

// A column can only be restored if it does not follow from itself through others.
TEST(SimulationLogFile, NoColumnFollowsFromItself) {
  const std::vector<std::vector<size_t>> sources = log_sources({"a", "b", "c"});
  std::vector<char> known(sources.size(), 0);
  size_t count = 0, related = 0;
  for (size_t round = 0; round < sources.size(); ++round)
    for (size_t c = 0; c < sources.size(); ++c) {
      const bool ready = std::all_of(sources[c].begin(), sources[c].end(),
                                     [&](size_t source) { return known[source] != 0; });
      if (known[c] != 0 || !ready) continue;
      known[c] = 1;
      ++count;
      related += sources[c].empty() ? 0 : 1;
    }
  EXPECT_EQ(count, sources.size());
  // Related are base, cog, ref.cog and other vectors of three, three joint vectors, and two forces.
  EXPECT_EQ(related, 3u * 9 + 3u * 3 + 2u);
}

// In an earlier version, the log of a walk of 8 s had 13 MB. Most columns of a log are smooth or
// constant.
TEST(SimulationLogFile, IsHalfAsLargeAsPlain) {
  SimulationLog log = random_log(9);
  log.samples.resize(4000, log.samples.front());
  double t = 0;
  for (SimulationSample& sample : log.samples) {
    t += log.dt;
    sample.state.theta.setConstant(std::sin(3 * t));
    sample.state.dtheta.setConstant(3 * std::cos(3 * t));
    sample.cog = {0.1 * std::sin(t), 0.1 * std::cos(2 * t), 0.3 + 0.01 * std::sin(5 * t)};
  }
  EXPECT_LT(2 * log_bytes(log).size(), plain_log_bytes(log).size());
}

TEST(SimulationLogFile, OnlyFiniteNumbersAreRead) {
  SimulationLog log = random_log(3);
  log.samples[1].zmp.x() = -0.0;
  EXPECT_TRUE(std::signbit(parse_log(log_bytes(log), "x.bin").samples[1].zmp.x()));
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    log.samples[7].zmp.x() = value;
    for (const std::string& bytes : {log_bytes(log), plain_log_bytes(log)})
      EXPECT_EQ(parse_message(bytes),
                "x.bin: the file is damaged: row 7, column 'zmp.x[m]' is not a finite number");
  }
}

// In an earlier version, with a tick of 1e-300 s, the export to MCAP divided by 0.
TEST(SimulationLogFile, TicksAreServoPeriods) {
  for (const double dt : {0.0, 1e-300, 1e-8, 11.0, 1e300}) {
    SimulationLog log = random_log(3);
    log.dt = dt;
    EXPECT_EQ(parse_message(log_bytes(log)),
              "x.bin (header): /dt: the time between two samples is " + text::brief(dt) +
                  " s, but it must be from 1e-7 to 10 s");
  }
}

// A report of a log with 200,000 events took longer than half a minute.
TEST(SimulationLogFile, HasABoundedNumberOfEvents) {
  SimulationLog log = random_log(3);
  log.events.resize(10'100, {0.1, EventKind::push, "x"});
  EXPECT_EQ(parse_message(log_bytes(log)), "no error");
  log.events.resize(10'101, {0.1, EventKind::push, "x"});
  EXPECT_EQ(parse_message(log_bytes(log)),
            "x.bin (header): /events: the log has 10101 events, but at most 10100 are read; "
            "simulate again");
}

TEST(SimulationLogFile, HashIsOfTheMotionNotOfTheCommandLine) {
  SimulationLog log = random_log(4);
  const std::string hash = log_hash(log);
  EXPECT_EQ(hash.size(), 64u);
  log.provenance.command_line = "another";
  EXPECT_EQ(log_hash(log), hash);
  log.provenance.command_line.clear();
  EXPECT_EQ(log_hash(log), sha256(plain_log_bytes(log)));
  log.samples[5].state.theta[1] = std::nextafter(log.samples[5].state.theta[1], 9);
  EXPECT_NE(log_hash(log), hash);
}

TEST(SimulationLogFile, BrokenFilesGetOneClearMessage) {
  const std::string good = log_bytes(random_log(5));
  EXPECT_EQ(parse_message(good), "no error");
  EXPECT_EQ(parse_message(""), "x.bin: the file is empty, but a simulation log is needed");
  EXPECT_NE(parse_message("{}").find("is not a simulation log"), std::string::npos);
  EXPECT_NE(parse_message(std::string(100, '\xff')).find("is not a simulation log"),
            std::string::npos);
  std::string other = good;
  other[8] = 9;
  EXPECT_NE(parse_message(other).find("log version 9 cannot be read"), std::string::npos);
  EXPECT_NE(parse_message(good.substr(0, 40)).find("truncated: the header is incomplete"),
            std::string::npos);
  EXPECT_NE(parse_message(good.substr(0, good.size() - 1)).find("truncated"), std::string::npos);
  EXPECT_NE(parse_message(good + "x").find("damaged: there are 1 bytes after"), std::string::npos);
  // Any flipped byte of the header, its checksum or the samples is noticed, or changes nothing that
  // is read, because zstd has different codes with the same meaning. (In front of these parts are
  // the magic word, the version and a length.)
  int without_effect = 0;
  for (size_t at = 8; at < good.size(); ++at) {
    std::string flipped = good;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x15);
    if (parse_message(flipped) != "no error") continue;
    ++without_effect;
    EXPECT_EQ(log_bytes(parse_log(flipped, "x.bin")), good) << "byte " << at;
  }
  EXPECT_LE(without_effect, 3);
}

// A file of version 1 has no checksums: only its structure can be examined.
TEST(SimulationLogFile, BrokenFilesOfVersionOneGetOneClearMessage) {
  const std::string good = plain_log_bytes(random_log(5));
  EXPECT_EQ(parse_message(good), "no error");
  EXPECT_NE(parse_message(good.substr(0, 40)).find("truncated: the header is incomplete"),
            std::string::npos);
  EXPECT_NE(parse_message(good.substr(0, good.size() - 1)).find("truncated: "), std::string::npos);
  EXPECT_NE(parse_message(good + "x").find("damaged: "), std::string::npos);
  std::string damaged = good;
  damaged[16] = '?';
  EXPECT_NE(parse_message(damaged).find("x.bin (header):1:1"), std::string::npos);
  std::string rows = good;
  rows.replace(rows.find("\"rows\":20"), 9, "\"rows\":99");
  EXPECT_NE(parse_message(rows).find("truncated: "), std::string::npos);
  rows.replace(rows.find("\"rows\":99"), 12, "\"rows\":9e15}");
  EXPECT_NE(parse_message(rows), "no error");
  std::string column = good;
  column.replace(column.find("measured.fz"), 11, "measured.fx");
  EXPECT_NE(parse_message(column).find("/columns: another version of Ayumi wrote this log"),
            std::string::npos);
  // No prefix of a log and no flipped byte of its header may have a worse effect than an Error.
  for (size_t length = 0; length < good.size(); length += 97) parse_message(good.substr(0, length));
  for (size_t at = 0; at < 2000 && at < good.size(); ++at) {
    std::string flipped = good;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x15);
    parse_message(flipped);
  }
}

// Files of which the system keeps no more than the beginning: to read one would take gigabytes.
TEST(SimulationLogFile, IsNotReadBeyondWhatItsHeaderAnnounces) {
  const fs::path folder = fresh_folder();
  fs::create_directories(folder);
  const size_t size = size_t{7} << 29;
  const auto error = [&](const std::string& beginning) {
    write_file(folder / "x.bin", beginning);
    fs::resize_file(folder / "x.bin", size);
    return file_error([&] { read_log(folder / "x.bin"); });
  };
  EXPECT_NE(error("").find("is not a simulation log"), std::string::npos);
  EXPECT_NE(error(log_bytes(random_log(5))).find("bytes of samples, but 20 rows have at most "),
            std::string::npos);
  EXPECT_NE(
      error(plain_log_bytes(random_log(5))).find("bytes of samples, but 20 rows have at most "),
      std::string::npos);
  const std::string long_header = std::string("AYUMILOG\3\0\0\0\0\0\0\x70", 16);
  EXPECT_NE(error(long_header).find("the header has 1879048192 bytes; it may have at most"),
            std::string::npos);
}

RunFolder example() {
  RunFolder run;
  run.provenance = {"hoap1", "ab", "walk", "cd", "hoap1", "dtad", "ayumi run walk.json"};
  run.sections = {{"check", R"({"verdict": "consistent"})"}, {"options", R"({"seed": 1})"}};
  run.logs = {{"open_loop", random_log(6)}, {"closed_loop", random_log(7)}};
  run.reference.emplace();
  run.reference->joints = {"a"};
  run.reference->rows.resize(3);
  for (ReferenceRow& row : run.reference->rows) row.theta = Eigen::VectorXd::Constant(1, 0.1);
  return run;
}

TEST(RunFolderFile, ReadsBackWhatWasWritten) {
  const fs::path folder = fresh_folder() / "a" / "b";
  write_run(folder, example());
  EXPECT_TRUE(is_run_folder(folder));
  const RunFolder back = read_run(folder);
  EXPECT_EQ(back.provenance.pattern, "walk");
  ASSERT_EQ(back.logs.size(), 2u);
  EXPECT_EQ(log_bytes(back.logs.at("open_loop")), log_bytes(random_log(6)));
  EXPECT_EQ(back.reference->rows.size(), 3u);
  ASSERT_EQ(back.sections.size(), 2u);
  EXPECT_EQ(test::json_of(back.sections[0].second).at("verdict"), "consistent");
  EXPECT_EQ(log_hash(read_run_log(folder)), log_hash(random_log(7)));
  EXPECT_EQ(log_hash(read_run_log(folder, "open_loop")), log_hash(random_log(6)));
  EXPECT_EQ(log_hash(read_run_log(folder / "log_open_loop.bin")), log_hash(random_log(6)));
}

TEST(RunFolderFile, SameRunSameBytesWhereverItIsWritten) {
  const fs::path folder = fresh_folder();
  write_run(folder / "one", example());
  write_run(folder / "two", example());
  for (const char* const name :
       {"run.json", "log_open_loop.bin", "log_closed_loop.bin", "reference.csv"})
    EXPECT_EQ(read_file(folder / "one" / name), read_file(folder / "two" / name)) << name;
  EXPECT_EQ(read_file(folder / "one" / "run.json").find(folder.string()), std::string::npos);
}

/// Exchanges a file again and again for another one and back while it exists.
class Exchange {
 public:
  Exchange(fs::path file, const fs::path& other) : file_(std::move(file)) {
    fs::copy_file(file_, own());
    thread_ = std::thread([this, other] {
      const fs::path next = file_.string() + ".next";
      for (bool back = false; !stop_; back = !back) {
        fs::create_hard_link(back ? own() : other, next);
        fs::rename(next, file_);
      }
    });
  }
  ~Exchange() {
    stop_ = true;
    thread_.join();
    fs::rename(own(), file_);
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

 private:
  fs::path own() const { return file_.string() + ".own"; }
  fs::path file_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

// What is taken has the recorded hash, even if the file is exchanged while it is read.
TEST(RunFolderFile, WhatIsReadIsWhatWasCompared) {
  const fs::path folder = fresh_folder(), other = folder / "other", run = folder / "run";
  write_run(run, example());
  RunFolder changed = example();
  changed.logs["closed_loop"] = random_log(9);
  for (ReferenceRow& row : changed.reference->rows) row.theta[0] = 0.3;
  write_run(other, changed);
  int refused = 0;
  const auto repeat = [&](const char* name, const auto& use) {
    const Exchange exchange(run / name, other / name);
    int taken = 0;
    for (int trial = 0; trial < 2000 && taken < 50; ++trial) {
      try {
        use();
        ++taken;
      } catch (const Error& error) {
        ++refused;
        EXPECT_NE(std::string(error.what()).find("has changed since the run was written"),
                  std::string::npos)
            << error.what();
      }
    }
    EXPECT_GT(taken, 0) << name;
  };
  const std::string hash = log_hash(random_log(7));
  repeat("log_closed_loop.bin", [&] { EXPECT_EQ(log_hash(read_run_log(run)), hash); });
  repeat("reference.csv", [&] { EXPECT_EQ(read_run(run).reference->rows[0].theta[0], 0.1); });
  EXPECT_GT(refused, 0);
}

// Every file that a reader takes for a part of a run is bound to it by a hash in run.json, also if
// run.json was written anew with its own hash.
TEST(RunFolderFile, OnlyListedFilesInTheFolderAreRead) {
  const fs::path folder = fresh_folder();
  using Document = nlohmann::ordered_json;
  const auto message = [&](const auto& change, const auto& use) {
    fs::remove_all(folder);
    write_run(folder / "run", example());
    write_file(folder / "victim.txt", "precious");
    Document document = Document::parse(read_file(folder / "run/run.json"));
    document.erase("contents_sha256");
    change(document);
    std::string text = document.dump(2);
    text.erase(text.rfind("\n}"));
    write_file(folder / "run/run.json",
               text + ",\n  \"contents_sha256\": \"" + sha256(text) + "\"\n}\n");
    const std::string error = file_error([&] { use(folder / "run"); });
    const size_t name = error.rfind(folder.string() + "/run/");
    return name == std::string::npos ? error : error.substr(name + folder.string().size() + 5);
  };
  const auto read = [](const fs::path& run) { read_run(run); };
  const auto read_all = [](const fs::path& run) { read_run(run, ComparedFiles::all); };
  const auto read_one = [](const fs::path& run) { read_run_log(run); };
  const auto verify = [](const fs::path& run) { verify_run(run); };
  const auto expect_refused = [&](const auto& change, const std::string& expected) {
    EXPECT_EQ(message(change, read), expected);
    EXPECT_EQ(message(change, read_all), expected);
    EXPECT_EQ(message(change, read_one), expected);
    EXPECT_EQ(message(change, verify), expected);
  };
  const auto nothing = [](Document&) {};
  expect_refused(nothing, "no error");
  const std::string unlisted =
      ": run.json does not list this file in \"files\", so the file belongs to another run or was "
      "changed; remove the file, or make the run again";
  for (const std::string name : {"reference.csv", "log_open_loop.bin", "log_closed_loop.bin"})
    expect_refused(
        [&](Document& d) {
          d["files"].erase(name);
          d["file_bytes"].erase(name);
        },
        name + unlisted);
  expect_refused([](Document& d) { d["files"] = d["file_bytes"] = Document::object(); },
                 "log_closed_loop.bin" + unlisted);
  expect_refused(
      [](Document& d) { d["logs"]["closed_loop"]["file"] = "../run/log_closed_loop.bin"; },
      "run.json: /logs/closed_loop/file: '../run/log_closed_loop.bin' is not the file of this log; "
      "the file must be log_closed_loop.bin. Make the run again");
  expect_refused([](Document& d) { d["logs"]["closed_loop"]["file"] = "log_open_loop.bin"; },
                 "run.json: /logs/closed_loop/file: 'log_open_loop.bin' is not the file of this "
                 "log; the file must be log_closed_loop.bin. Make the run again");
  for (const std::string& name : {std::string("../victim.txt"), (folder / "victim.txt").string()})
    EXPECT_NE(message([&](Document& d) { d["files"][name] = sha256("precious"); }, verify)
                  .find("victim.txt' is not the name of a file in this folder"),
              std::string::npos);
  expect_refused([](Document& d) { d["file_bytes"]["other"] = 8; },
                 "run.json: /file_bytes/other: \"files\" has no file of this name; make the run "
                 "again");
  // A log that the run does not have, such as one that a person has copied into the folder.
  EXPECT_EQ(
      message([&](Document&) { write_log(folder / "run/log_undisturbed.bin", random_log(1)); },
              read),
      "log_undisturbed.bin" + unlisted);
  // An older version wrote no sizes. Its runs are read, but no table for a robot is made of them.
  const auto without_sizes = [](Document& d) { d.erase("file_bytes"); };
  EXPECT_EQ(message(without_sizes, read), "no error");
  for (const std::string& error :
       {message(without_sizes, read_all), message(without_sizes, verify)})
    EXPECT_NE(error.find("the member 'file_bytes' is missing"), std::string::npos) << error;
  EXPECT_NE(message([](Document& d) { d["file_bytes"].erase("reference.csv"); }, read_all)
                .find("the member 'file_bytes/reference.csv' is missing"),
            std::string::npos);
}

TEST(RunFolderFile, SaysWhatIsWrong) {
  const fs::path folder = fresh_folder();
  EXPECT_NE(file_error([&] { read_run(folder); }).find("no such folder; a RUN is needed"),
            std::string::npos);
  write_run(folder, example());
  EXPECT_NE(file_error([&] {
              read_run_log(folder, "closedloop");
            }).find("the run has no log 'closedloop'; did you mean 'closed_loop'?"),
            std::string::npos);
  // Another size is noticed before the file is read: this one is not on the disk.
  for (const char* const name : {"log_open_loop.bin", "reference.csv"}) {
    const size_t size = fs::file_size(folder / name);
    fs::resize_file(folder / name, size_t{7} << 29);
    const std::string changed = "because it has 3758096384 bytes, but run.json states " +
                                std::to_string(size) + " bytes; make the run again";
    EXPECT_NE(file_error([&] { verify_run(folder); }).find(changed), std::string::npos) << name;
    EXPECT_FALSE(is_file_of_run(folder, folder / name)) << name;
    fs::resize_file(folder / name, size);
    EXPECT_TRUE(is_file_of_run(folder, folder / name)) << name;
  }
  std::string log = read_file(folder / "log_open_loop.bin");
  log.back() = static_cast<char>(log.back() ^ 1);
  write_file(folder / "log_open_loop.bin", log);
  EXPECT_NE(
      file_error([&] { read_run(folder); }).find("the file has changed since the run was written"),
      std::string::npos);
  fs::remove(folder / "log_open_loop.bin");
  EXPECT_NE(file_error([&] { read_run(folder); }).find("log_open_loop.bin: no such file"),
            std::string::npos);
  std::string text = read_file(folder / "run.json");
  text.replace(text.find("ayumi.run/1"), 11, "ayumi.run/7");
  write_file(folder / "run.json", text);
  EXPECT_NE(file_error([&] { read_run(folder); }).find("/format: 'ayumi.run/7' cannot be read"),
            std::string::npos);
  fs::remove(folder / "run.json");
  EXPECT_NE(file_error([&] { read_run(folder); }).find("the folder has no run.json"),
            std::string::npos);
  RunFolder run = example();
  run.files = {"absent.svg"};
  EXPECT_NE(file_error([&] { write_run(folder, run); }).find("absent.svg: no such file"),
            std::string::npos);
  run.files.clear();
  run.written["lost"] = {};
  EXPECT_NE(file_error([&] { write_run(folder, run); }).find("log_lost.bin: no such file"),
            std::string::npos);
  EXPECT_NE(file_error([&] {
              write_run(folder / "reference.csv", run);
            }).find("this is a file, but a folder is needed"),
            std::string::npos);
}

}  // namespace
}  // namespace ayumi
