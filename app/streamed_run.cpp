#include "streamed_run.hpp"

#include <chrono>
#include <optional>
#include <utility>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/log_writer.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/task/servo_table.hpp"
#include "ayumi/task/streamed_simulation.hpp"

namespace ayumi::app {

namespace {

using Clock = std::chrono::steady_clock;

// A folder for files that have no name yet.
std::filesystem::path scratch_folder() {
  std::error_code none;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(none);
  return none ? std::filesystem::path(".") : folder;
}

// Refuses a log that is too long, because no reader accepts it and a long run would be lost at its
// end.
void require_readable_log(const Task& input, const std::vector<std::string>& joints) {
  const size_t most = most_log_rows(joints);
  // Additional time [s]. Chosen: longer than a run continues after its motion.
  const double margin = 10;
  const size_t rows = input.series.samples.size() + static_cast<size_t>(margin / input.tick);
  if (rows <= most) return;
  const double longest = static_cast<double>(most) * input.tick - margin;
  fail(ErrorCode::bad_pattern,
       input.pattern.name + ": the motion lasts " + text::fixed(input.series.duration(), 1) +
           " s, and the log of this robot can hold " + text::fixed(longest, 1) +
           " s. Divide the motion, or use ayumi simulate without -o, which keeps no log");
}

Eigen::MatrixXd matrix_of(const std::vector<double>& rows, size_t columns) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto width = static_cast<Eigen::Index>(columns);
  const auto height = width == 0 ? 0 : static_cast<Eigen::Index>(rows.size()) / width;
  return Eigen::Map<const Rows>(rows.data(), height, width);
}

}  // namespace

StreamedRun simulate_streamed(const Context& context, const Task& input,
                              const SimulateOptions& options, const std::filesystem::path& file,
                              const StreamedParts& parts) {
  const std::vector<std::string> joints = input.robot.dof_names();
  std::optional<LogWriter> writer;
  std::optional<LogHash> hash;
  if (file.empty()) {
    hash.emplace(scratch_folder(), joints.size());
  } else {
    require_readable_log(input, joints);
    writer.emplace(file.parent_path(), joints);
  }
  StreamedRun run;
  std::vector<double> torque;
  Clock::duration writing = Clock::duration::zero();
  const auto take = [&](const SimulationSample& sample) {
    if (parts.postures) append_posture(sample, run.postures);
    if (parts.torque) torque.insert(torque.end(), sample.torque.begin(), sample.torque.end());
    const Clock::time_point begin = Clock::now();
    if (writer)
      writer->add(sample);
    else
      hash->add(sample);
    writing += Clock::now() - begin;
  };
  const Clock::time_point begin = Clock::now();
  SimulationLog about =
      ayumi::simulate_streamed(input, options, take, context.progress(), context.command_line);
  run.wall = std::chrono::duration<double>(Clock::now() - begin - writing).count();
  about.events.insert(about.events.begin(), parts.first_events.begin(), parts.first_events.end());
  if (parts.torque) run.torque = matrix_of(torque, joints.size());
  torque = {};
  run.log = writer ? writer->finish(std::move(about), file, context.progress())
                   : hash->finish(std::move(about));
  return run;
}

SimulationLog with_samples(const WrittenLog& log, const std::filesystem::path& file) {
  SimulationLog whole = log.about;
  whole.samples = read_log(file).samples;
  return whole;
}

std::string outcome_text(const WrittenLog& log) { return outcome_text(log.about, log.rows); }

}  // namespace ayumi::app
