#include "preview_batch.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/render/snapshots.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Drawn {
  std::string error;  ///< message of the error; empty if it is done
  bool skipped = false;
  Json entry;
  std::optional<Image> tile;
};

std::vector<fs::path> targets_of(const PreviewBatch& batch) {
  std::vector<fs::path> targets;
  for (const std::string& input : batch.inputs) {
    fs::path clean = fs::path(input).lexically_normal();
    if (!clean.has_filename()) clean = clean.parent_path();
    const fs::path target =
        batch.folder /
        ((is_run_folder(input) ? clean.filename() : clean.stem()).string() + batch.extension);
    if (std::find(targets.begin(), targets.end(), target) != targets.end())
      fail(ErrorCode::usage, {input},
           "another run has the same name, so both clips would be written to " + target.string() +
               ". Run the command once for each of these runs");
    targets.push_back(target);
  }
  return targets;
}

/// Files are written as a whole or not at all, so a file that exists and is newer than its run is
/// finished.
bool is_done(const fs::path& target, const fs::path& input) {
  std::error_code error;
  const fs::path source = is_run_folder(input) ? input / "run.json" : input;
  const auto made = fs::last_write_time(target, error);
  if (error) return false;
  const auto changed = fs::last_write_time(source, error);
  return !error && made >= changed;
}

Drawn draw_one(const PreviewBatch& batch, const std::string& input, const fs::path& target,
               int threads) {
  Drawn outcome;
  try {
    outcome.skipped = !batch.again && is_done(target, input);
    outcome.entry =
        outcome.skipped ? Json{{"output", target.string()}} : batch.draw(input, target, threads);
    if (batch.tile) outcome.tile = batch.tile(input);
  } catch (const Error& error) {
    outcome.error = error.what();
  }
  return outcome;
}

std::vector<Drawn> draw_all(const PreviewBatch& batch, const std::vector<fs::path>& targets,
                            const Progress& progress) {
  const int count = static_cast<int>(targets.size());
  const int workers = std::clamp(batch.threads, 1, count);
  std::vector<Drawn> outcomes(targets.size());
  std::atomic<int> next = 0, done = 0, failed = 0;
  std::exception_ptr stopped;
  std::mutex mutex;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        outcomes[size_t(i)] = draw_one(batch, batch.inputs[size_t(i)], targets[size_t(i)],
                                       std::max(1, batch.threads / workers));
        failed += outcomes[size_t(i)].error.empty() ? 0 : 1;
        const int finished = ++done;
        report(progress, {"drawing the preview", double(finished) / count,
                          std::to_string(finished) + " of " + std::to_string(count) + " runs" +
                              (failed > 0 ? ", " + std::to_string(failed) + " failed" : "")});
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!stopped) stopped = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> threads;
  try {
    for (int w = 1; w < workers; ++w) threads.emplace_back(work);
  } catch (const std::exception&) {  // the threads that could be started do the work
  }
  work();
  for (std::thread& thread : threads) thread.join();
  if (stopped) std::rethrow_exception(stopped);
  return outcomes;
}

}  // namespace

void run_batch(const PreviewBatch& batch, Context& context) {
  const std::vector<fs::path> targets = targets_of(batch);
  if (!batch.sheet.empty() && fs::path(batch.sheet).extension() != ".png")
    fail(ErrorCode::usage, {batch.sheet}, "--sheet needs a file name that ends in .png");
  std::error_code error;
  fs::create_directories(batch.folder, error);
  if (!fs::is_directory(batch.folder))
    fail(ErrorCode::bad_file, {batch.folder.string()},
         "this folder cannot be made (" + (error ? error.message() : "a file has this name") + ")");
  std::vector<Drawn> outcomes = draw_all(batch, targets, context.progress());
  Json runs = Json::array(), failures = Json::array();
  std::vector<Image> tiles;
  int skipped = 0;
  for (size_t i = 0; i < outcomes.size(); ++i) {
    if (outcomes[i].tile) tiles.push_back(std::move(*outcomes[i].tile));
    skipped += outcomes[i].skipped ? 1 : 0;
    if (outcomes[i].error.empty())
      runs.push_back(outcomes[i].entry);
    else
      failures.push_back({{"run", batch.inputs[i]}, {"error", outcomes[i].error}});
  }
  if (!batch.sheet.empty() && !tiles.empty())
    write_png(batch.sheet, draw_sheet(tiles, batch.columns));
  context.print(batch.folder.string() + ": " + std::to_string(runs.size()) + " of " +
                text::counted(targets.size(), "run") + " drawn" +
                (skipped > 0 ? "; " + text::counted(skipped, "clip") + " existed already" : "") +
                "\n");
  for (const Json& failure : failures)
    context.print("  failed: " + failure.at("run").get<std::string>() + ": " +
                  failure.at("error").get<std::string>() + "\n");
  context.print_json(Json({{"output", batch.folder.string()},
                           {"runs", runs},
                           {"failures", failures},
                           {"sheet", tiles.empty() ? Json(nullptr) : Json(batch.sheet)}})
                         .dump(2));
  context.exit_code = failures.empty() ? 0 : 3;
}

}  // namespace ayumi::app
