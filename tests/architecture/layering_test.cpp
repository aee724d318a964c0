#include <gtest/gtest.h>
#include <unistd.h>

#include <ostream>

#include "tests/architecture/layers.hpp"

namespace ayumi::test {
namespace {

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

/// A source tree with one file of the given content, which is removed at the end.
class Planted {
 public:
  Planted(const std::string& file, const std::string& content)
      : root_(fs::path(testing::TempDir()) / ("ayumi_planted_" + std::to_string(::getpid()))) {
    fs::remove_all(root_);
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << content;
  }
  ~Planted() { fs::remove_all(root_); }
  std::string violations() const { return joined(layering_violations(root_)); }

 private:
  fs::path root_;
};

TEST(Layering, TheSourcesKeepTheRules) {
  const fs::path root = AYUMI_SOURCE_DIR;
  ASSERT_TRUE(fs::exists(root / "lib/ayumi/base"));
  EXPECT_EQ(joined(layering_violations(root)), "");
}

struct Case {
  std::string file, content, expected;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.file; }

class Plants : public testing::TestWithParam<Case> {};

TEST_P(Plants, AreJudged) {
  const Planted planted(GetParam().file, GetParam().content);
  EXPECT_EQ(planted.violations(), GetParam().expected);
}

INSTANTIATE_TEST_SUITE_P(
    Broken, Plants,
    testing::Values(
        Case{"lib/ayumi/math/a.hpp", "#pragma once\n#include \"ayumi/model/robot_model.hpp\"\n",
             "lib/ayumi/math/a.hpp:2: room 'math' (floor 1) may not include room 'model' (floor "
             "2)\n"},
        Case{"lib/ayumi/check/a.cpp", "#include \"ayumi/control/laws/dtad.hpp\"\n",
             "lib/ayumi/check/a.cpp:1: room 'check' (floor 7) may not include room 'control' "
             "(floor 7)\n"},
        Case{"lib/ayumi/sim/a.cpp", "#include \"ayumi/check/consistency.hpp\"\n",
             "lib/ayumi/sim/a.cpp:1: room 'sim' (floor 8) may not include room 'check' (floor "
             "7)\n"},
        Case{"lib/ayumi/sim/plant_mujoco/a.cpp", "#include \"ayumi/control/laws/dtad.hpp\"\n",
             "lib/ayumi/sim/plant_mujoco/a.cpp:1: room 'sim/plant_mujoco' (floor 9) may not "
             "include room 'control' (floor 7)\n"},
        Case{"lib/ayumi/io/a.cpp", "#include \"ayumi/control/laws/dtad.hpp\"\n",
             "lib/ayumi/io/a.cpp:1: room 'io' may include only data types of room 'control'\n"},
        Case{"lib/ayumi/sim/a.cpp", "#include <nlohmann/json.hpp>\n",
             "lib/ayumi/sim/a.cpp:1: nlohmann-json may not be used in room 'sim'\n"},
        Case{"lib/ayumi/io/robot/a.cpp", "#include <assimp/scene.h>\n",
             "lib/ayumi/io/robot/a.cpp:1: assimp may not be used in room 'io'\n"},
        Case{"lib/ayumi/io/table/table.hpp", "#include <zstd.h>\n",
             "lib/ayumi/io/table/table.hpp:1: only Eigen shows in public headers\n"},
        Case{"lib/ayumi/sim/a.cpp", "#include <boost/any.hpp>\n",
             "lib/ayumi/sim/a.cpp:1: <boost/any.hpp> is no known third party\n"},
        Case{"lib/ayumi/sim/a.cpp", "#include \"contact.hpp\"\n",
             "lib/ayumi/sim/a.cpp:1: \"contact.hpp\": write the path from ayumi/\n"},
        Case{"lib/ayumi/misc/a.cpp", "\n", "lib/ayumi/misc/a.cpp:1: there is no room 'misc'\n"},
        Case{"app/util/a.cpp", "\n", "app/util: no such folder name\n"}));

INSTANTIATE_TEST_SUITE_P(
    Sound, Plants,
    testing::Values(Case{"lib/ayumi/model/a.hpp",
                         "#include <Eigen/Core>\n#include <vector>\n"
                         "#include \"ayumi/geometry/shape.hpp\"\n",
                         ""},
                    Case{"lib/ayumi/render/a.cpp",
                         "#include <GL/osmesa.h>\n#include \"ayumi/sim/simulation_log.hpp\"\n", ""},
                    Case{"app/commands/a.cpp",
                         "#include \"commands.hpp\"\n#include <CLI/CLI.hpp>\n"
                         "#include \"ayumi/io/pattern/pattern_file.hpp\"\n",
                         ""}));

}  // namespace
}  // namespace ayumi::test
