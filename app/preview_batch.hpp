#pragma once
// Draws many runs into a folder of clips: on all cores, with one line of progress. It continues
// where it was stopped, and lists failures at the end.

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
  std::filesystem::path folder;  ///< the folder, which is made if necessary
  std::string extension;         ///< ending of the files, such as ".mp4"
  int threads = 1;               ///< number of threads for all runs together
  bool again = false;            ///< also draws clips that exist and are newer than their run
  /// Writes one run with the given number of threads; throws Error. The result is its entry in the
  /// JSON.
  std::function<nlohmann::ordered_json(const std::string& input, const std::filesystem::path& path,
                                       int threads)>
      draw;
  std::string sheet;  ///< file of the contact sheet; empty: none
  std::function<Image(const std::string& input)> tile;
  int columns = 4;
};

/// Sets exit code 3 if a run failed. Throws Error(usage) if two runs would be written to one file,
/// and Interrupted after Ctrl-C.
void run_batch(const PreviewBatch& batch, Context& context);

}  // namespace ayumi::app
