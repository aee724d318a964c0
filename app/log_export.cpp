#include "log_export.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/log_csv.hpp"
#include "ayumi/io/formats/log_npz.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string extension_of(const std::string& format) {
  return format == "csv-log" ? ".csv" : "." + format;
}

void require_options(const LogExport& options, const CLI::App& command) {
  static const std::vector<std::string> known = {"input", "--format", "--out", "--log", "--robot"};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_single_name();
    const std::string shown = option->get_positional() ? name : "--" + name;
    if (option->count() > 0 && std::find(known.begin(), known.end(), shown) == known.end())
      fail(ErrorCode::usage, shown + ": this option is about joint tables; --format " +
                                 options.format + " writes a log");
  }
  if (fs::path(options.output).extension() != extension_of(options.format))
    fail(ErrorCode::usage, options.output + ": --format " + options.format + " writes a " +
                               extension_of(options.format));
}

SimulationLog log_of(const LogExport& options) {
  if (fs::is_regular_file(options.input)) {
    if (!is_log_file(options.input))
      fail(ErrorCode::bad_file, options.input + ": --format " + options.format +
                                    " needs a RUN, the folder that `ayumi run` or `ayumi simulate` "
                                    "wrote, or a log file of it; this file is neither");
    if (!options.log.empty())
      fail(ErrorCode::usage, "--log " + options.log + ": " + options.input +
                                 " is one log; --log chooses a log of a RUN folder");
  }
  return read_run_log(options.input, options.log);
}

Json arrays_json(const LogTable& table) {
  Json arrays = Json::array();
  for (const NpzArray& array : npz_arrays(table))
    arrays.push_back({{"name", array.name}, {"shape", array.shape}, {"unit", array.unit}});
  return arrays;
}

}  // namespace

const std::vector<std::string>& log_formats() {
  static const std::vector<std::string> formats = {"csv-log", "npz"};
  return formats;
}

bool is_log_format(const std::string& format) {
  const std::vector<std::string>& all = log_formats();
  return std::find(all.begin(), all.end(), format) != all.end();
}

void export_log(const LogExport& options, const CLI::App& command, Context& context) {
  require_options(options, command);
  refuse_overwriting(context, options.output);
  const SimulationLog log = log_of(options);
  const RobotModel model = robot_of_run(context, options.robot, log.provenance.robot);
  const LogTable table = log_table(model, log, options.input);
  Json json = {{"format", options.format},
               {"output", options.output},
               {"rows", table.rows},
               {"rate_hz", 1 / log.dt},
               {"columns", table.column_names()}};
  std::string bytes;
  if (options.format == "csv-log") {
    bytes = log_csv(table);
  } else {
    bytes = log_npz(table, log);
    json["arrays"] = arrays_json(table);
  }
  write_file(options.output, bytes);
  json["bytes"] = bytes.size();
  context.print(options.output + ": " + std::to_string(table.rows) + " rows at " +
                text::brief(1 / log.dt) + " Hz, " + std::to_string(table.columns) + " columns (" +
                options.format + ", " + std::to_string(bytes.size() / 1000) + " kB)\n");
  context.print_json(json.dump(2));
}

void refuse_log_file(const std::string& input) {
  if (is_log_file(input))
    fail(ErrorCode::bad_file, input +
                                  ": this is a log of a run, and a joint table needs the whole "
                                  "RUN: name its folder; of one log, --format " +
                                  text::join(log_formats(), " or ") + " can be written");
}

}  // namespace ayumi::app
