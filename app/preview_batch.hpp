#pragma once
// Many runs to a folder of clips: on all cores, with one line of progress, going on where it was
// stopped, failures listed at the end.

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ayumi/render/image.hpp"
#include "commands.hpp"

namespace ayumi::app {

struct PreviewBatch {
  std::vector<std::string> inputs;
  std::filesystem::path folder;  ///< made where needed
  std::string extension;         ///< ".mp4"
  int threads = 1;               ///< over all runs
  bool again = false;            ///< draw also what is there and newer than its run
  /// Writes one run, with so many threads; throws Error. The result is its entry in the JSON.
  std::function<nlohmann::ordered_json(const std::string& input, const std::filesystem::path& path,
                                       int threads)>
      draw;
  std::string sheet;  ///< empty: none
  std::function<Image(const std::string& input)> tile;
  int columns = 4;
};

/// Exit code 3 when a run failed. Throws Error(usage) when two runs would be one file, Interrupted
/// after Ctrl-C.
void run_batch(const PreviewBatch& batch, Context& context);

}  // namespace ayumi::app
