// `ayumi sweep` writes one row per case and the same bytes for any number of threads, shards and
// stops, and one clear line for bad input.

#include <signal.h>
#include <sqlite3.h>

#include <sstream>

#include "ayumi/io/run/sha256.hpp"
#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

struct Sweep {
  Folder folder;
  Sweep() {
    const Output made = run({"new", "stand", "--duration", "1.2", "-o", "stand.json"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    write_study(R"({"product": [{"controller": ["dtad", "none"]},
      {"latin_hypercube": {"samples": 12, "ranges": {"value.impulse": [0.1, 12]}}}]})");
  }
  void write_study(const std::string& cases, const std::string& more = "") const {
    write(folder / "study.json",
          R"({"format": "ayumi.study/1", "units": {"angle": "deg"}, "sweep": {
      "settings": {"pattern": "stand.json", "disturbances": "push"}, "cases": )" +
              cases + R"(,
      "disturbances": {"push": [{"type": "impulse", "at": 0.5, "duration": 0.02, "impulse":
        "${impulse}", "direction": [0, 1, 0]}]})" +
              more + "}}");
  }
  Output run(const std::vector<std::string>& words) const {
    return run_program(words, folder.path());
  }
  Output sweep(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"sweep", "study.json", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  std::string csv(const std::string& database) const {
    const Output out = sweep({"-o", database, "--csv", database + ".csv", "--force"});
    EXPECT_EQ(out.exit_code, 0) << out.err;
    return contents(folder / (database + ".csv"));
  }
};

void execute(const fs::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sql << ": " << sqlite3_errmsg(database);
  sqlite3_close(database);
}

/// The rows of a query; the cells of a row as docs/formats.md says that the seal counts them.
std::vector<std::string> rows_of(const fs::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  sqlite3_stmt* statement = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr), SQLITE_OK);
  std::vector<std::string> rows;
  while (sqlite3_step(statement) == SQLITE_ROW) {
    std::string row;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      const int type = sqlite3_column_type(statement, i);
      const double number = sqlite3_column_double(statement, i);
      const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
      if (type == SQLITE_NULL) row += "n";
      if (type == SQLITE_INTEGER) row += "i" + std::string(text) + ";";
      if (type == SQLITE_FLOAT)
        row += "d" + std::string(reinterpret_cast<const char*>(&number), sizeof number);
      if (type == SQLITE_TEXT)
        row += "t" + std::to_string(std::string(text).size()) + ";" + std::string(text);
    }
    rows.push_back(row);
  }
  sqlite3_finalize(statement);
  sqlite3_close(database);
  return rows;
}

/// The seal of the rows of a database, computed without Ayumi's class.
std::string seal_of(const fs::path& file) {
  const std::string fingerprint =
      rows_of(file, "SELECT value FROM about WHERE key = 'fingerprint'").at(0).substr(4);
  std::vector<std::string> hashes = {sha256(fingerprint)};
  for (const std::string& row : rows_of(file, "SELECT * FROM cases")) hashes.push_back(sha256(row));
  const std::string digits = "0123456789abcdef";
  std::string sum(64, '0');
  size_t carry = 0;
  for (size_t i = sum.size(); i-- > 0; carry /= 16) {
    for (const std::string& hash : hashes) carry += digits.find(hash[i]);
    sum[i] = digits[carry % 16];
  }
  return sum;
}

void seal_anew(const fs::path& file) {
  execute(file, "UPDATE about SET value = '" + seal_of(file) + "' WHERE key = 'rows_sha256'");
}

std::string read_csv(const Sweep& s, const std::string& database) {
  fs::remove(s.folder / "read.csv");
  const Output out = s.sweep({"-o", database, "--csv", "read.csv", "--json"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  if (out.exit_code == 0) {
    EXPECT_EQ(json_of(out.out).at("run_now"), 0);
  }
  return contents(s.folder / "read.csv");
}

/// The cells of a CSV file without quotes.
class Table {
 public:
  explicit Table(const std::string& csv) {
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream stream(line);
      cells_.emplace_back();
      for (std::string cell; std::getline(stream, cell, ',');) cells_.back().push_back(cell);
    }
  }
  int rows() const { return static_cast<int>(cells_.size()) - 1; }
  std::string cell(size_t row, const std::string& name) const {
    const std::vector<std::string>& names = cells_.at(0);
    const auto at = std::find(names.begin(), names.end(), name);
    EXPECT_NE(at, names.end()) << name;
    return cells_.at(row + 1).at(static_cast<size_t>(at - names.begin()));
  }
  double number(size_t row, const std::string& name) const { return std::stod(cell(row, name)); }

 private:
  std::vector<std::vector<std::string>> cells_;
};

TEST(SweepCommand, SameBytesForThreadsAndShards) {
  const Sweep s;
  const Output one = s.sweep({"-o", "one.db", "--threads", "1", "--csv", "one.csv", "--page",
                              "one.html", "--replays", "1", "--junit", "one.xml"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_NE(one.out.find("24 of 24 cases: "), std::string::npos) << one.out;
  const Output two = s.sweep({"-o", "two.db", "--threads", "3", "--csv", "two.csv", "--page",
                              "two.html", "--replays", "1", "--junit", "two.xml"});
  ASSERT_EQ(two.exit_code, 0) << two.err;
  for (const char* type : {".csv", ".html", ".xml"})
    EXPECT_EQ(contents(s.folder / (std::string("one") + type)),
              contents(s.folder / (std::string("two") + type)));
  const std::string whole = contents(s.folder / "one.csv");
  EXPECT_EQ(line_count(whole), 25);
  EXPECT_NE(whole.find(",fell,"), std::string::npos);
  EXPECT_NE(whole.find(",stands,"), std::string::npos);

  ASSERT_EQ(s.sweep({"-o", "a.db", "--shard", "1/3"}).exit_code, 0);
  ASSERT_EQ(s.sweep({"-o", "b.db", "--shard", "2/3"}).exit_code, 0);
  const Output missing = s.run({"sweep", "merge", "b.db", "a.db", "-o", "all.db"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("case 2 is in none of the files; shard 3/3 is missing"),
            std::string::npos)
      << missing.err;
  EXPECT_FALSE(fs::exists(s.folder / "all.db"));
  ASSERT_EQ(s.sweep({"-o", "c.db", "--shard", "3/3"}).exit_code, 0);
  const Output merged = s.run({"sweep", "merge", "b.db", "a.db", "c.db", "a.db", "-o", "all.db"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(read_csv(s, "all.db"), whole);
  const Output into = s.run({"sweep", "merge", "a.db", "b.db", "c.db"});
  ASSERT_EQ(into.exit_code, 0) << into.err;
  EXPECT_EQ(read_csv(s, "a.db"), whole);
}

// After kill -9 in the middle and the same command again, nothing is there twice and nothing is
// lost.
TEST(SweepCommand, GoesOnAfterKill) {
  const Sweep s;
  s.write_study(R"({"seed": {"from": 1, "to": 60, "count": 60}, "value.impulse": [0.2, 0.6]})");
  const pid_t child = ::fork();
  if (child == 0) {
    const int nothing = ::open("/dev/null", O_WRONLY);
    ::dup2(nothing, 1);
    ::dup2(nothing, 2);
    if (::chdir(s.folder.path().c_str()) != 0) ::_exit(126);
    const std::string program = program_under_test();
    ::execl(program.c_str(), program.c_str(), "sweep", "study.json", "-o", "k.db", "--threads", "1",
            nullptr);
    ::_exit(127);
  }
  long seen = 0;
  for (int i = 0; i < 600 && seen == 0; ++i) {
    ::usleep(50000);
    const Output status = s.run({"sweep", "status", "k.db", "--json"});
    if (status.exit_code == 0) seen = json_of(status.out).at("done");
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  ASSERT_GT(seen, 0);
  ASSERT_LT(seen, 120);
  const Output again = s.sweep({"-o", "k.db", "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const Json found = json_of(again.out);
  EXPECT_EQ(found.at("done"), 120);
  EXPECT_LE(found.at("run_now").get<long>() + seen, 120);
  EXPECT_EQ(read_csv(s, "k.db"), s.csv("fresh.db"));
}

TEST(SweepCommand, RecordsFailuresAndRunsThemAgain) {
  const Sweep s;
  write(s.folder / "study.json", R"({"format": "ayumi.study/1", "sweep": {
    "settings": {"pattern": "stand.json", "world": "w"},
    "cases": {"value.mu": [0.8, -1]}, "worlds": {"w": {"friction": "${mu}"}}}})");
  const Output first = s.sweep({"-o", "r.db", "--junit", "r.xml"});
  EXPECT_EQ(first.exit_code, 1) << first.err;
  EXPECT_NE(first.out.find("case 1 could not be run: study.json: /sweep/worlds/w/friction"),
            std::string::npos)
      << first.out;
  EXPECT_NE(contents(s.folder / "r.xml").find("<failure message=\"errors = 1\">"),
            std::string::npos);
  EXPECT_EQ(json_of(s.sweep({"-o", "r.db", "--json"}).out).at("run_now"), 0);
  EXPECT_EQ(json_of(s.sweep({"-o", "r.db", "--json", "--retry"}).out).at("run_now"), 1);
  EXPECT_EQ(s.sweep({"-o", "r.db", "--expect", "errors == 1"}).exit_code, 0);
}

// A case that is not selected keeps the record of its failure.
TEST(SweepCommand, RetryForgetsOnlyCasesThatItRuns) {
  const Sweep s;
  write(s.folder / "study.json", R"({"format": "ayumi.study/1", "sweep": {
    "settings": {"pattern": "stand.json", "world": "w"},
    "cases": {"value.mu": [-1, 0.8, -2]}, "worlds": {"w": {"friction": "${mu}"}}}})");
  ASSERT_EQ(s.sweep({"-o", "r.db"}).exit_code, 1);
  const Output again = s.sweep({"-o", "r.db", "--json", "--retry", "--cases", "0"});
  EXPECT_EQ(json_of(again.out).at("run_now"), 1) << again.err;
  EXPECT_EQ(json_of(again.out).at("done"), 3);
  EXPECT_EQ(json_of(again.out).at("errors"), 2);
}

TEST(SweepCommand, MergeNamesTheFilesThatDiffer) {
  const Sweep s;
  ASSERT_EQ(s.sweep({"-o", "a.db"}).exit_code, 0);
  fs::copy(s.folder / "a.db", s.folder / "b.db");
  execute(s.folder / "b.db", "UPDATE cases SET outcome = 'standS' WHERE outcome = 'stands'");
  seal_anew(s.folder / "b.db");
  const Output merged = s.run({"sweep", "merge", "a.db", "b.db", "-o", "m.db"});
  EXPECT_EQ(merged.exit_code, 3);
  EXPECT_NE(merged.err.find(" differs from the result in m.db. Nothing of b.db was merged"),
            std::string::npos)
      << merged.err;
  EXPECT_FALSE(fs::exists(s.folder / "m.db"));
}

// An edited outcome would be believed when the study is continued.
TEST(SweepCommand, RowsThatWereEditedAreRefused) {
  const Sweep s;
  ASSERT_EQ(s.sweep({"-o", "a.db", "--shard", "1/2"}).exit_code, 0);
  ASSERT_EQ(s.sweep({"-o", "b.db", "--shard", "2/2"}).exit_code, 0);
  ASSERT_EQ(s.run({"sweep", "merge", "a.db", "b.db", "-o", "good.db"}).exit_code, 0);
  for (const char* const file : {"a.db", "b.db", "good.db"})
    EXPECT_EQ(rows_of(s.folder / file, "SELECT value FROM about WHERE key = 'rows_sha256'").at(0),
              "t64;" + seal_of(s.folder / file));
  const std::string good = contents(s.folder / "good.db");
  for (const std::string sql :
       {"UPDATE cases SET outcome = 'unsettled' WHERE \"case\" = 0",
        "UPDATE cases SET severity = severity * (1 + 1e-15) WHERE \"case\" = 1",
        "DELETE FROM cases WHERE \"case\" = 1",
        "UPDATE about SET value = 'x' WHERE key = 'rows_sha256'",
        "DELETE FROM about WHERE key = 'rows_sha256'"}) {
    write(s.folder / "odd.db", good);
    execute(s.folder / "odd.db", sql);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"sweep", "study.json", "-o", "odd.db"},
          {"sweep", "status", "odd.db"},
          {"sweep", "merge", "odd.db", "a.db"},
          {"sweep", "merge", "a.db", "odd.db"}}) {
      const Output refused = s.run(words);
      EXPECT_EQ(refused.exit_code, 3) << sql << refused.out;
      EXPECT_NE(refused.err.find("odd.db: "), std::string::npos) << refused.err;
      EXPECT_NE(refused.err.find(sql.find("about") == std::string::npos
                                     ? "have changed since ayumi sweep wrote them"
                                     : "odd.db: this file does not contain results of ayumi sweep"),
                std::string::npos)
          << sql << refused.err;
    }
  }
}

TEST(SweepCommand, FilesOfOneCommandDiffer) {
  const Sweep s;
  const Output same = s.sweep({"-o", "x.db", "--csv", "./x.db"});
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_NE(same.err.find("--out and --csv name the same file"), std::string::npos) << same.err;
  EXPECT_EQ(s.sweep({"-o", "x.db", "--junit", "a", "--page", "a"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(s.folder / "x.db"));
}

// A check is no simulation, so that nothing is known of falls.
TEST(SweepCommand, WhatIsNotMeasuredMeetsNoExpectation) {
  const Sweep s;
  write(s.folder / "study.json", R"({"format": "ayumi.study/1", "sweep": {
    "settings": {"pattern": "stand.json"}, "cases": {"seed": [1, 2]}, "measure": ["check"]}})");
  const Output out = s.sweep({"-o", "n.db", "--expect", "falls == 0"});
  EXPECT_EQ(out.exit_code, 1) << out.out << out.err;
  EXPECT_NE(out.out.find("not met: falls == 0 (falls = unknown)"), std::string::npos) << out.out;
  EXPECT_EQ(s.sweep({"-o", "n.db", "--expect", "inconsistent == 0"}).exit_code, 0);
}

TEST(SweepCommand, ChecksUseTheFrictionOfTheCase) {
  const Sweep s;
  write(s.folder / "study.json", R"({"format": "ayumi.study/1", "sweep": {
    "settings": {"pattern": "patterns/hoap1_walk.json", "world": "w"}, "measure": ["check"],
    "cases": {"value.mu": [0.4, 0.8, 0.02]}, "worlds": {"w": {"friction": "${mu}"}}}})");
  ASSERT_EQ(s.sweep({"-o", "f.db", "--csv", "f.csv"}).exit_code, 0);
  const Table table(contents(s.folder / "f.csv"));
  EXPECT_NEAR(table.number(0, "check_max_friction_ratio"),
              2 * table.number(1, "check_max_friction_ratio"), 1e-9);
  EXPECT_EQ(table.cell(1, "consistent"), "1");
  EXPECT_EQ(table.cell(2, "consistent"), "0");
}

TEST(SweepCommand, JudgesExpectations) {
  const Sweep s;
  const Output met = s.sweep(
      {"-o", "e.db", "--expect", "falls > 0", "--expect", "max_max_cog_error_m < 10", "--json"});
  EXPECT_EQ(met.exit_code, 0) << met.err;
  const Json json = json_of(met.out);
  EXPECT_EQ(json.at("expectations").size(), 3u);
  EXPECT_GT(json.at("falls"), 0);
  EXPECT_EQ(json.at("worst_cases").at(0).at("outcome"), "fell");
  const Output not_met = s.sweep({"-o", "e.db", "--expect", "falls == 0", "--junit", "e.xml"});
  EXPECT_EQ(not_met.exit_code, 1);
  EXPECT_NE(not_met.out.find("not met: falls == 0 (falls = "), std::string::npos) << not_met.out;
  const std::string junit = contents(s.folder / "e.xml");
  EXPECT_NE(junit.find("<testsuites tests=\"2\" failures=\"1\""), std::string::npos) << junit;
  const Output wrong = s.sweep({"-o", "e.db", "--expect", "fals == 0"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("did you mean 'falls'?"), std::string::npos) << wrong.err;
}

// A case of a sweep is the run that `simulate` makes with the same settings.
TEST(SweepCommand, ACaseIsTheRunOfSimulate) {
  const Sweep s;
  s.write_study(R"({"value.impulse": [0.3], "gain.ka": [0.8], "noise": true, "seed": 5})",
                R"(, "measure": ["verdict", "margins", "energy", "check"])");
  ASSERT_EQ(s.sweep({"-o", "c.db", "--csv", "c.csv"}).exit_code, 0);
  std::string text = contents(s.folder / "stand.json");
  text = text.substr(0, text.rfind('}')) +
         R"(, "scenario": [{"type": "impulse", "at": 0.5, "duration": 0.02, "impulse": 0.3,
            "direction": [0, 1, 0]}]})";
  write(s.folder / "pushed.json", text);
  const Output alone = s.run({"simulate", "pushed.json", "--quiet", "--json", "--noise", "--seed",
                              "5", "--gain", "ka=0.8"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  const Json figures = json_of(alone.out);
  const Table table(contents(s.folder / "c.csv"));
  const auto cell = [&](const std::string& name) { return table.cell(0, name); };
  EXPECT_EQ(cell("outcome"), "stands");
  EXPECT_EQ(std::stod(cell("final_cog_error_m")), figures.at("final_cog_error_m"));
  EXPECT_EQ(std::stod(cell("max_torque_ratio")), figures.at("max_torque_ratio"));
  EXPECT_EQ(std::stod(cell("max_tilt_rad")), figures.at("max_tilt_rad"));
  EXPECT_EQ(cell("consistent"), "1");
  EXPECT_GT(std::stod(cell("positive_work_J")), 0);
}

TEST(SweepCommand, OneClearLineForBadInput) {
  const Sweep s;
  ASSERT_EQ(s.sweep({"-o", "good.db"}).exit_code, 0);
  const std::string good = contents(s.folder / "good.db");
  const auto expect = [&](const Output& out, int code, const std::string& part) {
    EXPECT_EQ(out.exit_code, code) << out.err;
    EXPECT_NE(out.err.find(part), std::string::npos) << out.err;
    EXPECT_EQ(out.err.find("ayumi: "), 0u) << out.err;
  };
  expect(s.sweep({"-o", "good.db", "--seed", "9"}), 3,
         "another study (the results were made with --seed 1)");
  expect(s.run({"sweep", "study.json"}), 2, "the option --out is missing");
  expect(s.run({"sweep", "nothing.json", "-o", "x.db"}), 3, "nothing.json");
  write(s.folder / "text.db", "no database");
  expect(s.sweep({"-o", "text.db"}), 3, "text.db");
  EXPECT_EQ(contents(s.folder / "text.db"), "no database");
  expect(s.run({"sweep", "status", "none.db"}), 3, "this file does not exist");
  expect(s.sweep({"-o", "x.db", "--shard", "3/2"}), 2, "1/4");
  expect(s.sweep({"-o", "no/such/folder/x.db"}), 3, "no/such/folder");
  EXPECT_FALSE(fs::exists(s.folder / "x.db"));
  s.write_study(R"({"value.impulse": 0.1, "set.speed": [1, 2]})");
  expect(s.sweep({"-o", "x.db"}), 3, "no pattern of the study declares the parameter 'speed'");
  s.write_study(R"({"value.impulse": 0.1, "gain.kx": [1, 2]})");
  expect(s.sweep({"-o", "x.db"}), 3, "kx");
  s.write_study(R"({"value.impulse": 0.1, "gain.ka": [0.5, 1], "controller": "none"})");
  expect(s.sweep({"-o", "x.db"}), 3, "open loop has no gains, so nothing uses 'gain.ka'");
  s.write_study(R"({"value.impulse": 0.1, "draw": [0, 1]})");
  const std::string study = contents(s.folder / "study.json");
  const auto with_uncertainty = [&](const std::string& text) {
    write(s.folder / "study.json",
          study.substr(0, study.rfind('}')) + R"(, "uncertainty": )" + text + "}");
  };
  with_uncertainty(R"({"quantities": [{"what": "mass", "uniform": [0.9, 1.1]}]})");
  expect(s.sweep({"-o", "x.db"}), 3, "the source of these numbers is missing");
  with_uncertainty(R"({"quantities": [{"what": "mass", "on": "tail", "uniform": [0.9, 1.1],
                       "source": "assumed: a test"}]})");
  expect(s.sweep({"-o", "x.db"}), 3, "this quantity has no effect");
  with_uncertainty(R"({"factors": [{"name": "battery", "source": "assumed: a test"}],
    "quantities": [{"what": "mass", "uniform": [0.9, 1.1], "source": "assumed: a test"}]})");
  expect(s.sweep({"-o", "x.db"}), 3, "no quantity uses the factor 'battery'");
  s.write_study(R"({"value.impulse": 0.1, "profile": "hoap9"})");
  expect(s.sweep({"-o", "x.db"}), 3, "no robot of the study has the profile 'hoap9'");
  EXPECT_FALSE(fs::exists(s.folder / "x.db"));
  s.write_study(R"({"value.impulse": 0.1})");
  expect(s.sweep({"-o", "good.db"}), 3, "another study (the study is different)");
  ASSERT_EQ(s.sweep({"-o", "other.db"}).exit_code, 0);
  expect(s.run({"sweep", "merge", "good.db", "other.db"}), 3, "other.db: this file contains");
  // A wrong expectation makes no file and replaces none, and commands that only read leave no file
  // behind.
  expect(s.sweep({"-o", "y.db", "--expect", "fals == 0"}), 2, "did you mean 'falls'?");
  EXPECT_FALSE(fs::exists(s.folder / "y.db"));
  // The library's words about a long name are shortened.
  const std::string word(1000, 'x');
  const Output quoted = s.sweep({"-o", "y.db", "--expect", word + " == 0"});
  EXPECT_EQ(quoted.exit_code, 2);
  EXPECT_LT(quoted.err.size(), word.size() + 600) << quoted.err;
  expect(s.sweep({"-o", "good.db", "--force", "--expect", "fals == 0"}), 2, "did you mean");
  EXPECT_TRUE(contents(s.folder / "good.db") == good);
  // The same holds for a refused file of another version, which differs in the head of the
  // database.
  for (const auto& [version, file] : {std::pair('\1', "older.db"), std::pair('\3', "later.db")}) {
    std::string other = good;
    other.replace(60, 4, std::string("\0\0\0", 3) + version);  // this is PRAGMA user_version
    write(s.folder / file, other);
    expect(s.run({"sweep", "status", file}), 3,
           std::string("the results have version ") + char('0' + version) + " of the format");
  }
  for (const char* const file : {"good.db", "older.db", "later.db"})
    for (const char* const part : {"-wal", "-shm"})
      EXPECT_FALSE(fs::exists(s.folder / (std::string(file) + part))) << file;
}

// The tables and views of a file from a stranger are Ayumi's own, or the file is refused: a view
// may have no end, and a trigger may change the results that are written.
TEST(SweepCommand, OnlyItsOwnTablesAreRead) {
  const Sweep s;
  s.write_study(R"({"value.impulse": [0.1, 0.2]})");
  ASSERT_EQ(s.sweep({"-o", "good.db"}).exit_code, 0);
  const std::string good = contents(s.folder / "good.db");
  const auto changed = [&](const std::string& sql) {
    write(s.folder / "odd.db", good);
    execute(s.folder / "odd.db", sql);
  };
  const std::string endless =
      " AS WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT x";
  const std::pair<std::string, std::string> refused[] = {
      {"DROP TABLE about; CREATE VIEW about" + endless + " AS key, '' AS value FROM c",
       "the table 'about' is not as ayumi sweep makes it"},
      {"DROP TABLE axes; CREATE VIEW axes" + endless + " AS place, '' AS name, '' AS type FROM c",
       "the table 'axes' is not as"},
      {"ALTER TABLE cases RENAME TO old; CREATE VIEW Cases AS SELECT * FROM old",
       "the table 'cases' is not as"},
      {"DROP VIEW summary; CREATE VIEW summary AS SELECT 2 AS cases, 2 AS done, 2 AS stands",
       "the view 'summary' is not as"},
      {"ALTER TABLE cases ADD COLUMN more AS (hex(zeroblob(100000000)))",
       "the table 'cases' is not as"},
      {"CREATE TRIGGER t AFTER INSERT ON cases BEGIN UPDATE cases SET outcome = 'stands'; END",
       "ayumi sweep did not make the trigger 't' of the table 'cases'. Remove it"},
      {"UPDATE axes SET type = 'REAL); CREATE TABLE more (x'", "does not contain results"},
      {"UPDATE about SET value = '-5' WHERE key = 'cases'", "does not contain results"},
      {"UPDATE about SET value = '9223372036854775807' WHERE key = 'cases'",
       "does not contain results"},
      {"UPDATE about SET value = zeroblob(70000000) WHERE key = 'name'", "too big"}};
  for (const auto& [sql, message] : refused) {
    changed(sql);
    const std::string before = contents(s.folder / "odd.db");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"sweep", "status", "odd.db"},
          {"sweep", "study.json", "-o", "odd.db"},
          {"sweep", "merge", "good.db", "odd.db"}}) {
      const Output out = s.run(words);
      EXPECT_EQ(out.exit_code, 3) << sql << out.out;
      EXPECT_NE(out.err.find("odd.db: "), std::string::npos) << out.err;
      EXPECT_NE(out.err.find(message), std::string::npos) << out.err;
    }
    EXPECT_TRUE(contents(s.folder / "odd.db") == before) << sql;
  }
  EXPECT_TRUE(contents(s.folder / "good.db") == good);
  // Further tables and views that a user has added to the file do not matter to the program.
  changed("CREATE TABLE notes (text); CREATE VIEW slow AS SELECT severity FROM cases");
  const Output out = s.run({"sweep", "status", "odd.db"});
  EXPECT_EQ(out.exit_code, 0) << out.err;
  EXPECT_NE(out.out.find("2 of 2 cases"), std::string::npos) << out.out;
}

// The file may not grow beyond a limit, as on a full disk: everything that was committed stays.
TEST(SweepCommand, AFullDiskLosesNothing) {
  const Sweep s;
  s.write_study(R"({"seed": {"from": 1, "to": 3000, "count": 3000}, "value.impulse": 0.2})",
                R"(, "measure": ["check"])");
  const Output full = run_program({"-c", "ulimit -f 250; exec '" + program_under_test() +
                                             "' sweep study.json -o f.db --quiet --threads 1"},
                                  s.folder.path(), "/bin/sh");
  EXPECT_EQ(full.exit_code, 3) << full.out << full.err;
  EXPECT_NE(full.err.find("f.db: the results cannot be written: the disk is full"),
            std::string::npos)
      << full.err;
  const Output again = s.sweep({"-o", "f.db"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_csv(s, "f.db"), s.csv("g.db"));
}

TEST(SweepCommand, TwoWritersAreRefused) {
  const Sweep s;
  s.write_study(R"({"seed": {"from": 1, "to": 400, "count": 400}, "value.impulse": 0.2})");
  const std::string script = "'" + program_under_test() +
                             "' sweep study.json -o t.db --quiet >/dev/null & "
                             "while [ ! -s t.db ]; do sleep 0.02; done; "
                             "'" +
                             program_under_test() +
                             "' sweep study.json -o t.db --quiet; code=$?; "
                             "kill %1; wait; exit $code";
  const Output second = run_program({"-c", script}, s.folder.path(), "/bin/bash");
  EXPECT_EQ(second.exit_code, 3) << second.err;
  EXPECT_NE(second.err.find("t.db: another command is writing to this file"), std::string::npos)
      << second.err;
}

TEST(SweepCommand, ThePageWorksInABrowser) {
  if (std::string(AYUMI_CHROMEDRIVER).empty())
    GTEST_SKIP() << "chromium-driver is not installed: the page is not tried in a browser";
  const Sweep s;
  const Output out = s.sweep({"-o", "p.db", "--page", "p.html", "--replays", "1"});
  ASSERT_EQ(out.exit_code, 0) << out.err;
  const Output said = run_program(
      {AYUMI_SOURCE_DIR "/tests/cli/sweep_browser.mjs", AYUMI_CHROMEDRIVER, s.folder / "p.html"},
      s.folder.path(), AYUMI_NODE);
  EXPECT_EQ(said.exit_code, 0) << said.out << said.err;
  EXPECT_EQ(said.out, "ok\n");
}

// A draw is the same case as in `certify` and `simulate --case`, and each measure belongs to the
// robot of its case.
TEST(SweepCommand, DrawsProfilesRobotsAndParameters) {
  const Sweep s;
  std::string text = contents(s.folder / "stand.json");
  const size_t begin = text.find('{') + 1;
  text.insert(begin, R"("parameters": {"seconds": 0.4},)");
  const size_t duration = text.find("1.2", begin);
  ASSERT_NE(duration, std::string::npos) << text;
  text.replace(duration, 3, "\"${seconds}\"");
  write(s.folder / "quick.json", text);
  write(s.folder / "study.json", R"({"format": "ayumi.study/1", "sweep": {
    "settings": {"pattern": "quick.json"},
    "cases": {"list": [{"draw": [0, 7]}, {"profile": "hoap1"},
                       {"robot": ["humanoid30", "hoap1"]}, {"set.seconds": [0.3, -1]}]},
    "thresholds": {"times": [0.1], "directions": 2, "cap": 1.2, "step": 0.4},
    "measure": ["verdict", "repair", "thresholds", "energy"]}})");
  const Output out = s.sweep({"-o", "d.db", "--csv", "d.csv", "--json"});
  EXPECT_EQ(out.exit_code, 1) << out.err;
  const Table table(contents(s.folder / "d.csv"));
  ASSERT_EQ(table.rows(), 7);
  const Output alone = s.run({"simulate", "quick.json", "--case", "7", "--json", "--quiet"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(table.number(1, "final_cog_error_m"), json_of(alone.out).at("final_cog_error_m"));
  EXPECT_NE(table.number(0, "final_cog_error_m"), table.number(1, "final_cog_error_m"));
  EXPECT_EQ(table.number(2, "push_worst_Ns"), table.number(4, "push_worst_Ns"));
  // The other robot has about eight times the mass and twice the height of its COG.
  EXPECT_GT(table.number(3, "push_worst_Ns"), 4 * table.number(4, "push_worst_Ns"));
  EXPECT_EQ(table.cell(3, "repair"), "already_consistent");
  EXPECT_LT(table.number(5, "duration_s"), table.number(4, "duration_s"));
  EXPECT_NE(table.cell(6, "error"), "");
}

// A case that takes too long is recorded, and the others are run.
TEST(SweepCommand, ALimitOfTimeOfOneCase) {
  const Sweep s;
  ASSERT_EQ(s.run({"new", "stand", "--duration", "90", "-o", "long.json"}).exit_code, 0);
  s.write_study(R"({"value.impulse": 0.1, "pattern": ["stand.json", "long.json"]})");
  const Output limited = s.sweep({"-o", "l.db", "--case-limit", "0.4", "--threads", "1"});
  EXPECT_EQ(limited.exit_code, 1) << limited.err;
  EXPECT_NE(limited.out.find("1 stand"), std::string::npos) << limited.out;
  EXPECT_NE(
      limited.out.find("case 1 could not be run: the stage 'simulating' did not end within 0.4 s "
                       "of processor time. A larger --case-limit allows more time"),
      std::string::npos)
      << limited.out;
}

// A stand-in for Slurm: sbatch runs every task at once, and drops the tasks that `drop` names, as
// if a node had died. tests/cluster tries the real one.
struct StandIn {
  Sweep s;
  StandIn() {
    write(s.folder / "bin/sbatch", R"sh(#!/bin/sh
[ "$1" = --version ] && exit 0
echo "$*" >> sbatch.log
[ -e refuse ] && { echo 'sbatch: error: invalid partition specified: nowhere' >&2; exit 1; }
for script in "$@"; do :; done
for option in "$@"; do case $option in --output=*) out=${option#--output=};; esac; done
job=$(grep -c . sbatch.log)
last=$(sed -n 's/#SBATCH --array=1-//p' "$script")
for task in $(seq "$last"); do
  grep -qx "$job $task" drop 2> /dev/null && continue
  SLURM_ARRAY_TASK_ID=$task sh "$script" > "$(echo "$out" | sed "s/%a/$task/")" 2>&1
done
echo "$job"
)sh");
    write(s.folder / "bin/squeue", "#!/bin/sh\nexit 0\n");
    for (const char* name : {"scontrol", "scancel"})
      write(s.folder / "bin" / name, "#!/bin/sh\nexit 0\n");
    for (const auto& entry : fs::directory_iterator(s.folder / "bin"))
      fs::permissions(entry.path(), fs::perms::owner_all);
  }
  Output slurm(const std::string& more) const {
    return run_program({"-c", "PATH=\"$PWD/bin:$PATH\" exec '" + program_under_test() +
                                  "' sweep study.json --quiet --engine slurm " + more},
                       s.folder.path(), "/bin/sh");
  }
};

TEST(SweepOnSlurm, LostTasksAreSubmittedAgainUpToALimit) {
  const StandIn slurm;
  const std::string whole = slurm.s.csv("local.db");
  write(slurm.s.folder / "drop", "1 2\n1 4\n2 1\n");
  const Output out = slurm.slurm(
      "-o a.db --chunk 5 --csv a.csv --partition p --time 30 "
      "--memory 2G --sbatch=--account=lab");
  ASSERT_EQ(out.exit_code, 0) << out.out << out.err;
  EXPECT_EQ(contents(slurm.s.folder / "a.csv"), whole);
  // Of the five tasks of the first job, two are lost (10 cases). Of the two tasks that repeat these
  // cases, one is lost again (5 cases).
  EXPECT_NE(out.out.find("10 cases of lost tasks"), std::string::npos) << out.out;
  EXPECT_NE(out.out.find("5 cases of lost tasks"), std::string::npos) << out.out;
  const std::string log = contents(slurm.s.folder / "sbatch.log");
  EXPECT_EQ(line_count(log), 3) << log;
  EXPECT_NE(log.find("--partition=p --time=30 --mem=2G --account=lab "), std::string::npos) << log;
  EXPECT_FALSE(fs::exists(slurm.s.folder / "a.db.slurm"));

  fs::remove(slurm.s.folder / "sbatch.log");
  write(slurm.s.folder / "drop", "1 2\n2 1\n");
  const Output lost = slurm.slurm("-o b.db --chunk 5 --attempts 2");
  EXPECT_EQ(lost.exit_code, 3) << lost.out;
  EXPECT_NE(lost.err.find("the tasks of 5 cases (the first is case 5) were lost 2 times"),
            std::string::npos)
      << lost.err;
  EXPECT_EQ(lost.err.find('\n'), lost.err.size() - 1) << lost.err;
  const Output status = slurm.s.run({"sweep", "status", "b.db", "--json"});
  EXPECT_EQ(json_of(status.out).at("missing"), 5);
  EXPECT_EQ(slurm.slurm("-o b.db --csv b.csv").exit_code, 0);
  EXPECT_EQ(contents(slurm.s.folder / "b.csv"), whole);
}

TEST(SweepOnSlurm, AbsentOrRefusing) {
  const StandIn slurm;
  const auto expect = [&](const Output& out, int code, const std::string& part) {
    EXPECT_EQ(out.exit_code, code) << out.err;
    EXPECT_NE(out.err.find(part), std::string::npos) << out.err;
    EXPECT_EQ(out.err.find('\n'), std::min(out.err.find("\nSee "), out.err.size() - 1)) << out.err;
  };
  expect(run_program({"-c", "PATH=/nowhere exec '" + program_under_test() +
                                "' sweep study.json --quiet --engine slurm -o n.db"},
                     slurm.s.folder.path(), "/bin/sh"),
         3, "--engine slurm: the program sbatch cannot be started (No such file or directory)");
  EXPECT_FALSE(fs::exists(slurm.s.folder / "n.db"));
  write(slurm.s.folder / "refuse", "");
  expect(slurm.slurm("-o r.db --pilot 3"), 3,
         "sbatch refused the job: sbatch: error: invalid partition specified: nowhere. The results "
         "so far are kept in r.db");
  const Output status = slurm.s.run({"sweep", "status", "r.db", "--json"});
  EXPECT_EQ(json_of(status.out).at("done"), 3);
  expect(slurm.s.sweep({"-o", "r.db", "--partition", "p"}), 2,
         "--partition works only together with --engine slurm");
  expect(slurm.s.sweep({"-o", "r.db", "--engine", "pbs"}), 2, "pbs");
  expect(slurm.s.sweep({"-o", "r.db", "--cases", "5-2"}), 2, "'5-2' is not a list of cases");
  expect(slurm.s.sweep({"-o", "r.db", "--cases", "24"}), 2, "numbers from 0 to 23");
  ASSERT_EQ(slurm.s.sweep({"-o", "c.db", "--cases", "2,5-7"}).exit_code, 0);
  EXPECT_EQ(json_of(slurm.s.run({"sweep", "status", "c.db", "--json"}).out).at("done"), 4);
}

}  // namespace
}  // namespace ayumi::test
