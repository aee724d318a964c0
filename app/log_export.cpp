#include "log_export.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/log_csv.hpp"
#include "ayumi/io/formats/log_mcap.hpp"
#include "ayumi/io/formats/log_npz.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/render/simplify.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string extension_of(const std::string& format) {
  return format == "csv-log" ? ".csv" : "." + format;
}

void require_options(const LogExport& options, const Command& command) {
  static const std::vector<std::string> known = {"input", "--format", "--out", "--log", "--robot"};
  for (const Option& option : command.own_options()) {
    const std::string shown = option.shown_name();
    if (option.count() > 0 && std::find(known.begin(), known.end(), shown) == known.end())
      fail(ErrorCode::usage,
           shown + ": this option is for joint tables only, but --format " + options.format +
               " writes the log of a run. Leave this option out, or choose the format "
               "of a table (csv, json, hoap)");
  }
  if (fs::path(options.output).extension() != extension_of(options.format))
    fail(ErrorCode::usage, {options.output},
         "--format " + options.format + " needs a file name that ends in " +
             extension_of(options.format));
}

SimulationLog log_of(const LogExport& options) {
  if (fs::is_regular_file(options.input)) {
    if (!is_log_file(options.input))
      fail(ErrorCode::bad_file, {options.input},
           "--format " + options.format +
               " needs a RUN, the folder that `ayumi run` or `ayumi simulate` "
               "wrote, or a log file from this folder. Give one of these");
    if (!options.log.empty())
      fail(ErrorCode::usage, "--log " + options.log + ": " + options.input +
                                 " is a single log, and --log chooses one of the logs of a RUN "
                                 "folder. Leave --log out");
  }
  return read_run_log(options.input, options.log);
}

// Largest number of triangles of the robot in an MCAP file, which viewers receive as JSON. Chosen:
// the bundled HOAP-1 has fewer and is not simplified. With half of this number, a file of its walk
// is 0.2 % smaller; with twice this number, nothing changes.
constexpr size_t kMostTriangles = 20'000;

std::vector<ColoredMesh> surface_of(const RobotModel& model) {
  std::vector<BodySurface> bodies = robot_surface(model);
  simplify(bodies, kMostTriangles);
  std::vector<ColoredMesh> meshes;
  for (const BodySurface& body : bodies) {
    ColoredMesh mesh;
    for (const Triangles* part : parts_of(body)) {
      const Triangles shared = welded(*part);
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      for (const RenderVertex& vertex : shared.vertices) {
        mesh.points.push_back(vertex.position);
        Eigen::Vector4f color;
        for (int i = 0; i < 4; ++i)
          color[i] = static_cast<float>(vertex.color[static_cast<size_t>(i)]) / 255;
        mesh.colors.push_back(color);
      }
      for (const std::uint32_t index : shared.indices) mesh.indices.push_back(first + index);
    }
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

Json topics_json(const std::vector<McapTopic>& topics) {
  Json all = Json::array();
  for (const McapTopic& topic : topics)
    all.push_back({{"topic", topic.topic}, {"schema", topic.schema}, {"messages", topic.messages}});
  return all;
}

Json arrays_json(const LogTable& table) {
  Json arrays = Json::array();
  for (const NpzArray& array : npz_arrays(table))
    arrays.push_back({{"name", array.name}, {"shape", array.shape}, {"unit", array.unit}});
  return arrays;
}

}  // namespace

const std::vector<std::string>& log_formats() {
  static const std::vector<std::string> formats = {"csv-log", "npz", "mcap"};
  return formats;
}

bool is_log_format(const std::string& format) {
  const std::vector<std::string>& all = log_formats();
  return std::find(all.begin(), all.end(), format) != all.end();
}

void export_log(const LogExport& options, const Command& command, Context& context) {
  require_options(options, command);
  refuse_overwriting(context, options.output);
  const SimulationLog log = log_of(options);
  const bool drawn = options.format == "mcap";
  const RobotModel model =
      robot_of_log(context, options.robot, log, options.input, {.meshes = drawn});
  const LogTable table = log_table(model, log, options.input);
  Json json = {{"format", options.format},
               {"output", options.output},
               {"rows", table.rows},
               {"rate_hz", 1 / log.dt},
               {"columns", table.column_names()}};
  std::string bytes;
  if (options.format == "csv-log") {
    bytes = log_csv(table);
  } else if (options.format == "mcap") {
    McapLog mcap = log_mcap(model, surface_of(model), log, table);
    bytes = std::move(mcap.bytes);
    json["topics"] = topics_json(mcap.topics);
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
    fail(ErrorCode::bad_file,
         input +
             ": this is a single log, but a joint table is made from the "
             "whole run. Name the RUN folder, or write the log with --format " +
             text::join(log_formats(), " or "));
}

}  // namespace ayumi::app
