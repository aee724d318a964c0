// There is one set of hashes, whatever the settings of the machine are.

#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

namespace ayumi::test {
namespace {

/// Runs the program in an environment of its own.
Output selftest(const std::vector<std::string>& settings, const std::vector<std::string>& options,
                const fs::path& folder) {
  std::vector<std::string> words = settings;
  words.push_back(program_under_test());
  words.push_back("selftest");
  words.insert(words.end(), options.begin(), options.end());
  return run_program(words, folder, "/usr/bin/env");
}

TEST(Selftest, GivesTheCommittedHashesEverywhere) {
  const Folder folder;
  // The settings are those of the machine, and other settings: without fused multiply-add and AVX2
  // in the C library, with another BLAS kernel, and with other words for numbers and times.
  const std::vector<std::vector<std::string>> machines = {
      {},
      {"GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX2_Usable,-FMA_Usable",
       "OPENBLAS_CORETYPE=Nehalem", "LC_ALL=de_DE.UTF-8", "TZ=Pacific/Chatham"}};
  int threads = 1;
  for (const auto& machine : machines) {
    const Output output =
        selftest(machine, {"--json", "--threads", std::to_string(threads)}, folder.path());
    EXPECT_EQ(output.exit_code, 0) << output.out << output.err;
    threads += 3;
  }
}

// A robot with 1 % more mass in one link is another robot.
TEST(Selftest, SaysWhatDiffers) {
  const Folder folder;
  fs::create_directories(folder / "robots");
  fs::copy(fs::path(AYUMI_SOURCE_DIR) / "robots/hoap1", folder / "robots/hoap1",
           fs::copy_options::recursive);
  const fs::path urdf = folder / "robots/hoap1/robot.urdf";
  std::string text = contents(urdf);
  const size_t at = text.find("<mass value=\"") + 13;
  const double mass = std::stod(text.substr(at));
  text.replace(at, text.find('"', at) - at, std::to_string(mass * 1.01));
  write(urdf, text);
  const Output output =
      selftest({}, {"walk", "jump", "--robot-path", folder / "robots"}, folder.path());
  EXPECT_EQ(output.exit_code, 1) << output.out << output.err;
  EXPECT_NE(output.out.find("different  walk: a walk with a push"), std::string::npos)
      << output.out;
  EXPECT_EQ(output.out.find("a walk by VIIP"), std::string::npos) << "only the named jobs run";
}

}  // namespace
}  // namespace ayumi::test
