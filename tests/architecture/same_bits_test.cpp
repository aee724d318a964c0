// The rooms that compute take sines, exponential functions and functions that are made from them
// from math/elementary: those of the C library have other last bits on other machines.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <set>

#include "tests/architecture/layers.hpp"

namespace ayumi::test {
namespace {

const std::set<std::string> kPictures = {"render", "plot", "report"};
// Eigen makes a rotation from an angle by a sine of the C library.
const std::regex kForeign(
    "std::(sin|cos|tan|exp|exp2|expm1|log|log2|log10|log1p|atan|atan2|asin|acos|pow|cbrt|hypot|"
    "sinh|"
    "cosh|tanh|erf|erfc|tgamma|lgamma|polar)[lf]?\\(|__builtin_(sin|cos|exp|log|pow)[lf]?\\(|"
    "AngleAxis|Rotation2D|"
    "\\.slerp\\(|\\.angularDistance\\(|\\.eulerAngles\\(");

/// Lists "file:line: text" for each use in the rooms that compute.
std::string foreign_functions(const fs::path& root) {
  std::vector<std::string> files;
  for (const auto& room : fs::directory_iterator(root / "lib/ayumi")) {
    if (!room.is_directory() || kPictures.contains(room.path().filename().string())) continue;
    for (const auto& entry : fs::recursive_directory_iterator(room.path()))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
        files.push_back(fs::relative(entry.path(), root).string());
  }
  std::sort(files.begin(), files.end());
  std::string found;
  for (const std::string& file : files) {
    if (file.find("plant_mujoco") != std::string::npos) continue;
    std::ifstream stream(root / file);
    int number = 0;
    for (std::string line; std::getline(stream, line);) {
      ++number;
      const std::string code = line.substr(0, line.find("//"));
      // The poles of a loop are complex numbers that are only shown to people.
      if (file.ends_with("gain_design.cpp") && code.find("poles.push_back") != std::string::npos)
        continue;
      if (std::regex_search(code, kForeign))
        found += file + ":" + std::to_string(number) + ": " + line + "\n";
    }
  }
  return found;
}

TEST(SameBits, TheRoomsThatComputeUseElementary) {
  const fs::path root = AYUMI_SOURCE_DIR;
  ASSERT_TRUE(fs::exists(root / "lib/ayumi/math/elementary.hpp"));
  EXPECT_EQ(foreign_functions(root), "");
}

TEST(SameBits, OthersAreFound) {
  const fs::path root =
      fs::path(testing::TempDir()) / ("ayumi_same_bits_" + std::to_string(::getpid()));
  for (const char* room : {"sim", "render"}) {
    fs::create_directories(root / "lib/ayumi" / room);
    std::ofstream(root / "lib/ayumi" / room / "a.cpp")
        << "// std::sin(x)\nx = std::atan2(y, z);\nu = std::sqrt(y) + a.slerp(t, b);\n";
  }
  EXPECT_EQ(foreign_functions(root),
            "lib/ayumi/sim/a.cpp:2: x = std::atan2(y, z);\n"
            "lib/ayumi/sim/a.cpp:3: u = std::sqrt(y) + a.slerp(t, b);\n");
  fs::remove_all(root);
}

}  // namespace
}  // namespace ayumi::test
