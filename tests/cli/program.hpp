#pragma once
// Runs the real program and collects the output that a person or a script would see.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace ayumi::test {

namespace fs = std::filesystem;

inline const std::string kWalk = AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json";

struct Output {
  int exit_code = -1;  ///< 128 + signal if the program was killed
  std::string out, err;
};

inline std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write(const fs::path& file, const std::string& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

/// The program under test: that of the build, or an installed one that the environment names.
inline std::string program_under_test() {
  const char* installed = std::getenv("AYUMI_INSTALLED_PROGRAM");
  return installed ? installed : AYUMI_PROGRAM;
}

/// The words of `program arguments…` in the form that exec() takes.
class ArgumentVector {
 public:
  ArgumentVector(const std::string& program, const std::vector<std::string>& arguments)
      : words_{program} {
    words_.insert(words_.end(), arguments.begin(), arguments.end());
    for (std::string& word : words_) pointers_.push_back(word.data());
    pointers_.push_back(nullptr);
  }
  ArgumentVector(const ArgumentVector&) = delete;
  ArgumentVector& operator=(const ArgumentVector&) = delete;
  /// Replaces this process by the program; returns only if that fails.
  void execute() const { ::execv(pointers_.front(), pointers_.data()); }

 private:
  std::vector<std::string> words_;
  std::vector<char*> pointers_;
};

/// Runs `program arguments…` in `folder`. Its streams go to files that are read back.
inline Output run_program(const std::vector<std::string>& arguments, const fs::path& folder,
                          const std::string& program = program_under_test()) {
  const fs::path streams =
      fs::path(testing::TempDir()) / ("ayumi_streams_" + std::to_string(::getpid()));
  fs::create_directories(streams);
  const std::string out = streams / "out", err = streams / "err";
  ArgumentVector argv(program, arguments);
  const pid_t child = ::fork();
  if (child == 0) {
    const int out_file = ::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int err_file = ::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const int no_input = ::open("/dev/null", O_RDONLY);
    if (::chdir(folder.c_str()) != 0 || ::dup2(no_input, 0) < 0 || ::dup2(out_file, 1) < 0 ||
        ::dup2(err_file, 2) < 0)
      ::_exit(126);
    argv.execute();
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  Output result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  result.out = contents(out);
  result.err = contents(err);
  fs::remove_all(streams);
  return result;
}

/// A scratch folder of one test, which is removed with its content.
class Folder {
 public:
  Folder() : Folder(name_of_test()) {}
  /// For all tests of a suite together, after none of which it could be named.
  explicit Folder(const std::string& name)
      : path_(fs::path(testing::TempDir()) / ("ayumi_" + std::to_string(::getpid()) + "_" + name)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }

  /// Every file below the folder, as relative paths in order: the files that a command left behind.
  std::vector<std::string> files() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path_))
      found.push_back(fs::relative(entry.path(), path_).string());
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  static std::string name_of_test() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + "_" + test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
  }
  fs::path path_;
};

inline int line_count(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace ayumi::test
