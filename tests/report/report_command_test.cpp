// `ayumi report` on a run in which HOAP-1 stands.

#include <gtest/gtest.h>

#include "ayumi/io/run/seal.hpp"
#include "tests/render/standing_run.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using ReportCommand = OnARun;

TEST_F(ReportCommand, WritesOnePage) {
  const Output made = ayumi({"report", "run", "-o", "r.html", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = json_of(made.out);
  const std::string html = contents(folder / "r.html");
  EXPECT_EQ(json.at("bytes"), html.size());
  EXPECT_NE(html.find("The closed loop (dtad) <span class=\"good\">stands</span>"),
            std::string::npos);
  EXPECT_EQ(ayumi({"report", "run", "-o", "r.html"}).exit_code, 3) << "not overwritten";
}

TEST_F(ReportCommand, TakesPushThresholds) {
  const std::string push =
      R"({"format": "ayumi.push/1", "study": {"controllers": [{"type": "dtad", "gains": {}}]},
            "cases": [{"phase": "both feet", "at_s": 0.1, "direction_rad": 1.5707963267948966,
                       "standing": true, "bound_Ns": 1.25, "edge_bound_Ns": 1.3,
                       "open_loop": {"impulse_Ns": 0.2, "capped": false},
                       "limits": [{"impulse_Ns": 1.0, "capped": false}]}]
})";
  write(folder / "run" / "push.json", push);
  const Output older = ayumi({"report", "run", "-o", "r.html", "--no-replay"});
  EXPECT_EQ(older.exit_code, 3);
  EXPECT_NE(older.err.find("push.json: the file has no \"contents_sha256\", so an older version of "
                           "Ayumi wrote the file, or the file was changed; run `ayumi push` again"),
            std::string::npos)
      << older.err;
  write(folder / "run" / "push.json", sealed(push));
  ASSERT_EQ(ayumi({"report", "run", "-o", "r.html", "--no-replay"}).exit_code, 0);
  const std::string html = contents(folder / "r.html");
  EXPECT_NE(html.find("Push thresholds"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"number\">0.80</td>"), std::string::npos);
  EXPECT_EQ(html.find("replay-config"), std::string::npos);
  EXPECT_NE(html.find("there is no replay, because the report was made with --no-replay"),
            std::string::npos);
  write(folder / "run" / "push.json", R"({"format": "ayumi.run/1"})");
  const Output other = ayumi({"report", "run", "-o", "s.html"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("push.json: /format: this is not the results file of a push study"),
            std::string::npos)
      << other.err;
}

TEST_F(ReportCommand, SaysWhatIsWrong) {
  const Output none = ayumi({"report", "nowhere", "-o", "r.html"});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("nowhere: this is not a RUN"), std::string::npos) << none.err;
  EXPECT_EQ(ayumi({"report", "run", "-o", "nowhere/r.html"}).exit_code, 3);
  EXPECT_EQ(ayumi({"report", "run", "-o", "r.html", "--max-size", "0"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(folder / "r.html"));
}

}  // namespace
}  // namespace ayumi::test
