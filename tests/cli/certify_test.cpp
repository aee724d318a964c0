// `ayumi certify` gives the same bytes for any number of threads and shards, continues where it was
// stopped, and its cases can be simulated one by one.

#include <sys/resource.h>

#include "tests/cli/program.hpp"
#include "tests/support/json.hpp"
#include "tests/support/resealed.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

struct CertifyStudy {
  Folder folder;
  CertifyStudy() { write_files(); }
  explicit CertifyStudy(const std::string& name) : folder(name) { write_files(); }
  void write_files() const {
    const Output made = run({"new", "stand", "--duration", "1.5", "-o", "stand.json"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    write(folder / "study.json", R"({
      "format": "ayumi.study/1", "units": {"angle": "deg"},
      "uncertainty": {
        "quantities": [{"what": "mass", "uniform": [0.95, 1.05], "source": "assumed: test"}],
        "pushes": [{"unit": "B", "size": {"uniform": [0.3, 2.0], "source": "assumed: test"},
                    "direction": {"uniform": [0, 360], "source": "assumed: test"}, "time": 0.5}]}})");
  }
  Output run(const std::vector<std::string>& words) const {
    return run_program(words, folder.path());
  }
  Output certify(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"certify",   "stand.json", "--quiet", "--study", "study.json",
                                      "--failure", "0.1",        "--runs",  "40",      "--all"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  /// The results of the study with all cases. They are the same bytes each time, so that they are
  /// computed once.
  static const std::string& whole() {
    static const std::string text = [] {
      const CertifyStudy study("CertifyStudy");
      EXPECT_EQ(study.certify({"-o", "cases.json"}).exit_code, 1);
      return contents(study.folder / "cases.json");
    }();
    return text;
  }
};

TEST(CertifyCommand, SameBytesForThreadsAndShards) {
  const CertifyStudy study;
  const Output one =
      study.certify({"-o", "one.json", "--threads", "1", "--table", "t.csv", "--map", "m.svg"});
  ASSERT_EQ(one.exit_code, 1) << one.err;
  EXPECT_NE(one.out.find("not certified: "), std::string::npos) << one.out;
  EXPECT_NE(one.out.find("push: size"), std::string::npos);
  EXPECT_NE(one.out.find("3 distributions. The numbers of 3 distributions are assumed"),
            std::string::npos)
      << one.out;
  const std::string picture = contents(study.folder / "m.svg");
  EXPECT_NE(picture.find("<svg"), std::string::npos);
  EXPECT_NE(picture.find(": 40 runs, "), std::string::npos) << "of all runs, as its figures";
  EXPECT_NE(one.out.find("  mass: "), std::string::npos) << one.out;
  EXPECT_EQ(one.out.find("  push: time: "), std::string::npos) << "the time is always the same";
  EXPECT_EQ(study.certify({"-o", "two.json", "--threads", "2"}).exit_code, 1);
  const std::string whole = contents(study.folder / "one.json");
  EXPECT_EQ(whole, contents(study.folder / "two.json"));
  ASSERT_EQ(study.certify({"-o", "a.json", "--shard", "1/2"}).exit_code, 0);
  const Output missing = study.certify({"--merge", "a.json", "-o", "merged.json"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("--merge: case 1 is in none of the files; shard 2/2 is missing"),
            std::string::npos)
      << missing.err;
  ASSERT_EQ(study.certify({"-o", "b.json", "--shard", "2/2"}).exit_code, 0);
  const Output merged =
      study.certify({"--merge", "b.json", "--merge", "a.json", "-o", "merged.json"});
  EXPECT_EQ(merged.exit_code, 1) << merged.err;
  EXPECT_EQ(whole, contents(study.folder / "merged.json"));
}

TEST(CertifyCommand, GoesOnAndRefusesOtherStudies) {
  const CertifyStudy study;
  const std::string& whole = CertifyStudy::whole();
  write(study.folder / "cases.json", whole);
  Json partly = json_of(whole);
  for (int i = 0; i < 20; ++i) partly["cases"].erase(3);
  partly["cases"][0][4] = 0.125;  // this result is kept and not simulated again
  write(study.folder / "cases.json", resealed(partly));
  ASSERT_EQ(study.certify({"-o", "cases.json"}).exit_code, 1);
  Json again = json_of(contents(study.folder / "cases.json"));
  EXPECT_EQ(again["cases"][0][4], 0.125);
  again["cases"][0][4] = json_of(whole)["cases"][0][4];
  EXPECT_EQ(resealed(again), resealed(json_of(whole)));
  const Output other = study.certify({"-o", "cases.json", "--seed", "2"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("the results of another study ('seed' differs)"), std::string::npos)
      << other.err;
}

TEST(CertifyCommand, RefusesFiguresThatNoSimulationGives) {
  const CertifyStudy study;
  for (const auto& [place, value, why] :
       {std::tuple(3, Json(1e308), "case 0 has the value 1e+308, which no simulation gives"),
        std::tuple(0, Json(-1), "a case has no number"),
        std::tuple(0, Json(1e308), "a case has no number")}) {
    Json edited = json_of(CertifyStudy::whole());
    edited["cases"][0][place] = value;
    write(study.folder / "cases.json", resealed(edited));
    const Output refused = study.certify({"-o", "cases.json"});
    EXPECT_EQ(refused.exit_code, 3) << why;
    EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
  }
}

// An edited outcome would be believed when the study is continued or merged.
TEST(CertifyCommand, RefusesResultsThatWereEdited) {
  const CertifyStudy study;
  const std::string& whole = CertifyStudy::whole();
  EXPECT_TRUE(is_sealed(whole));
  Json older = json_of(whole);
  older.erase(kSealKey);
  std::string edited = whole;
  ASSERT_NE(edited.find("\"fell\""), std::string::npos);
  edited.replace(edited.find("\"fell\""), 6, "\"stands\"");
  for (const auto& [text, why] :
       {std::pair(edited, "the file has changed since Ayumi wrote it"),
        std::pair(older.dump(1), "older version of Ayumi wrote the file, or the file was changed")})
    for (const auto& [option, remedy] :
         {std::pair("-o", "replace the file with --force"),
          std::pair("--merge", "run the shard of this file again")}) {
      write(study.folder / "cases.json", text);
      const Output refused = study.certify({option, "cases.json"});
      EXPECT_EQ(refused.exit_code, 3) << refused.out;
      EXPECT_NE(refused.err.find(why), std::string::npos) << refused.err;
      EXPECT_NE(refused.err.find(remedy), std::string::npos) << refused.err;
      EXPECT_EQ(contents(study.folder / "cases.json"), text);
    }
}

// In an earlier version, one case with the largest number took 4.7 GB.
TEST(CertifyCommand, ACaseWithALargeNumberTakesNoMemory) {
  const CertifyStudy study;
  Json edited = json_of(CertifyStudy::whole());
  Json last = edited["cases"][0];
  last[0] = 99'999'999;
  edited["cases"].push_back(last);
  write(study.folder / "cases.json", resealed(edited));
  struct rusage before {
  }, after{};
  ::getrusage(RUSAGE_CHILDREN, &before);
  ASSERT_EQ(study.certify({"-o", "cases.json"}).exit_code, 1);
  ::getrusage(RUSAGE_CHILDREN, &after);
  EXPECT_LE(after.ru_maxrss, std::max(before.ru_maxrss, 1'000'000L)) << "kB";
  EXPECT_EQ(resealed(json_of(contents(study.folder / "cases.json"))), resealed(edited))
      << "the case stays";
}

// In an earlier version, the comparison with the program's own study descended into these results
// by recursion, and the program crashed.
TEST(CertifyCommand, RefusesResultsThatAreNestedDeeply) {
  const CertifyStudy study;
  const std::string deep = std::string(300'000, '[') + std::string(300'000, ']');
  write(study.folder / "cases.json",
        R"({"format": "ayumi.certify/1", "study": {"a": )" + deep + R"(}, "cases": []})");
  const Output refused = study.certify({"-o", "cases.json"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("cases.json: this file does not contain results of ayumi certify"),
            std::string::npos)
      << refused.err;
}

// A command that needs fewer cases leaves the others in the file, and reads the cases that it
// needs.
TEST(CertifyCommand, KeepsTheCasesThatItDoesNotNeed) {
  const CertifyStudy study;
  const std::string& whole = CertifyStudy::whole();
  write(study.folder / "cases.json", whole);
  const Output fewer = study.run({"certify", "stand.json", "--quiet", "--study", "study.json",
                                  "--failure", "0.1", "--runs", "29", "-o", "cases.json"});
  EXPECT_EQ(fewer.exit_code, 1) << fewer.err;
  EXPECT_NE(fewer.out.find("within 29 runs"), std::string::npos) << fewer.out;
  EXPECT_EQ(contents(study.folder / "cases.json"), whole);
}

TEST(CertifyCommand, ReplacesNoFileWithoutForce) {
  const CertifyStudy study;
  write(study.folder / "cases.json", CertifyStudy::whole());
  write(study.folder / "mine.txt", "mine");
  const Output merged = study.certify({"--merge", "cases.json", "-o", "mine.txt"});
  EXPECT_EQ(merged.exit_code, 3);
  EXPECT_NE(merged.err.find("mine.txt: this already exists"), std::string::npos) << merged.err;
  EXPECT_EQ(contents(study.folder / "mine.txt"), "mine");
  const Output same = study.certify({"-o", "x.json", "--table", "x.json"});
  EXPECT_EQ(same.exit_code, 2);
  EXPECT_NE(same.err.find("--out and --table name the same file"), std::string::npos) << same.err;
  EXPECT_FALSE(fs::exists(study.folder / "x.json"));
}

TEST(CertifyCommand, RefusesWhatThePlantDoesNotUse) {
  const CertifyStudy study;
  write(study.folder / "soles.json", R"({"format": "ayumi.study/1", "uncertainty": {"quantities": [
    {"what": "sole_stiffness", "uniform": [0.5, 1], "source": "assumed: test"}]}})");
  const std::vector<std::string> words = {"certify", "stand.json", "--quiet", "--plant",
                                          "mujoco",  "--failure",  "0.5",     "--confidence",
                                          "0.5",     "--runs",     "1"};
  std::vector<std::string> with_study = words;
  with_study.insert(with_study.end(), {"--study", "soles.json"});
  const Output stated = study.run(with_study);
  if (stated.exit_code == 2) GTEST_SKIP() << "Ayumi was built without MuJoCo";
  EXPECT_EQ(stated.exit_code, 3);
  EXPECT_NE(stated.err.find("soles.json: /uncertainty/quantities/0: this quantity has no effect"),
            std::string::npos)
      << stated.err;
  const Output usual = study.run(words);
  EXPECT_LE(usual.exit_code, 1) << usual.err;
  EXPECT_NE(usual.out.find("--plant mujoco does not use them: sole_stiffness"), std::string::npos)
      << usual.out;
}

TEST(CertifyCommand, ACaseCanBeSimulatedAlone) {
  const CertifyStudy study;
  write(study.folder / "cases.json", CertifyStudy::whole());
  const Output all = study.certify({"--json", "-o", "cases.json"});
  const Json worst = json_of(all.out).at("worst_cases").at(0);
  const std::string number = std::to_string(worst.at("case").get<long>());
  const Output alone = study.run({"simulate", "stand.json", "--quiet", "--study", "study.json",
                                  "--case", number, "--json", "-o", "run"});
  ASSERT_EQ(alone.exit_code, 1) << alone.err;
  const Json json = json_of(alone.out);
  EXPECT_EQ(json.at("outcome"), worst.at("outcome"));
  EXPECT_EQ(worst.at("outcome"), "fell");
  EXPECT_EQ(json.at("fell_at_s"), worst.at("fell_at_s"));
  EXPECT_EQ(json.at("max_torque_ratio"), worst.at("torque_ratio"));
  EXPECT_TRUE(fs::exists(study.folder / "run/log_closed_loop.bin"));
}

TEST(CertifyCommand, ComparesLawsAndRefusesBadInput) {
  const CertifyStudy study;
  write(study.folder / "cases.json", CertifyStudy::whole());
  const Output compared = study.certify({"--against-controller", "none", "-o", "cases.json"});
  EXPECT_NE(compared.out.find("compared with 'none' in the same 40 cases"), std::string::npos)
      << compared.out << compared.err;
  EXPECT_NE(compared.out.find("McNemar's exact test"), std::string::npos);
  const Output both =
      study.certify({"--against", "stand.json", "--against-controller", "none", "--json"});
  EXPECT_NE(both.out.find("\"with\": \"stand.json, none\""), std::string::npos) << both.out;
  EXPECT_NE(both.out.find("\"assumed\": true"), std::string::npos) << both.out;
  ASSERT_EQ(study.run({"new", "stand", "--robot", "humanoid30", "-o", "other.json"}).exit_code, 0);
  const Output other = study.certify({"--against", "other.json"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("--against: other.json is for the robot humanoid30, but stand.json is "
                           "for the robot hoap1"),
            std::string::npos)
      << other.err;
  EXPECT_EQ(study.certify({"--shard", "3/2", "-o", "x.json"}).exit_code, 2);
  EXPECT_EQ(study.certify({"--noise"}).exit_code, 2) << "sensors always have noise";
  EXPECT_EQ(study.run({"simulate", "stand.json", "--study", "study.json"}).exit_code, 2);
  write(study.folder / "bad.json", R"({"format": "ayumi.study/1", "uncertainty": {"quantities": [
    {"what": "mass", "normal": [0.1, 1], "source": "assumed: test"}]}})");
  const Output negative = study.run({"certify", "stand.json", "--quiet", "--study", "bad.json"});
  EXPECT_EQ(negative.exit_code, 3);
  EXPECT_NE(negative.err.find("bad.json: /uncertainty/quantities/0: case "), std::string::npos)
      << negative.err;
  EXPECT_NE(negative.err.find("must be above 0"), std::string::npos);
}

}  // namespace
}  // namespace ayumi::test
