#pragma once
// Code that the fuzz targets share. A target is one source <name>_fuzz.cpp with
// LLVMFuzzerTestOneInput, as libFuzzer and AFL++ call it. An input is one file or several: further
// files begin after a separator with their names.

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"

namespace ayumi::fuzz {

/// Separator before the name of a further file, which ends with the line. Definition: the record
/// separator of ASCII, which is no part of any text format here.
constexpr char kSeparator = '\x1e';

struct Part {
  std::string name;  ///< name of the file without a folder; "" for the first file
  std::string bytes;
};

std::vector<Part> parts_of(std::string_view input);
std::string joined(const std::vector<Part>& parts);

/// The input with `bytes` as the first file and with further files.
class InputFolder {
 public:
  /// Writes the parts into a folder of this process, in memory if the system has such a place. The
  /// first part gets the name `first`. Names with a slash are left out.
  InputFolder(const std::vector<Part>& parts, const std::string& first);
  ~InputFolder();
  InputFolder(const InputFolder&) = delete;
  InputFolder& operator=(const InputFolder&) = delete;
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
};

/// Largest size of an input [bytes]. Chosen: larger inputs show nothing new, but take longer.
constexpr size_t kLargestInput = 65536;

[[noreturn]] inline void report(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

/// Calls `read`. A reader may throw an Error about the input, with one line of text. An Error about
/// Ayumi itself, and any other exception, is a defect. Returns whether the input was accepted.
template <typename Read>
bool accepts(const Read& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    const std::string text = error.what();
    if (error.code() == ErrorCode::internal) report("an invariant of Ayumi is broken: " + text);
    if (text.empty()) report("an error without a message");
    // The message may contain a word of the input once or twice, and lists of names in it are
    // bounded.
    if (text.size() > kLargestInput * 4)
      report("a message of " + std::to_string(text.size()) + " bytes");
    return false;
  }
}

/// Checks a property of input that was accepted.
inline void expect(bool condition, const char* what) {
  if (!condition) report(std::string("a property does not hold: ") + what);
}

/// The robots that belong to Ayumi.
inline RobotSearch bundled() { return {{AYUMI_SOURCE_DIR "/robots"}}; }
/// HOAP-1, read once and without the shapes of its meshes.
const RobotModel& hoap1();

}  // namespace ayumi::fuzz
