// A library of walks over a grid of speeds, turning rates and periods, and the walks between
// neighbouring cells.

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/plot/gait_map.hpp"
#include "certify_results.hpp"
#include "gaits/gait_maker.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Number of missing cells that are printed with their reasons; the index has all of them. Chosen:
/// half a screen.
constexpr size_t kShownMissing = 10;
/// Largest number of columns of the maps that stand in a row, one map for each turning rate;
/// further maps go into another row. Chosen: five maps of five cells are as wide as a screen.
constexpr size_t kMostColumns = 5;
/// Largest number of runs of a cell, as a multiple of the number that is needed without a failure.
/// Chosen: a robot that fails with a fifth of the permitted probability of 15 % is then certified
/// with a probability of about 90 %, and a failing cell costs at most this number of runs.
constexpr long kMostRuns = 4;

struct GaitsCommand {
  std::string robot, out;
  std::string forward, sideways, turn, period;  // ranges as the user writes them
  GaitOptions options;
  bool uncertified = false, without_transitions = false;
};

/// A stage at which a cell can fail, with its mark in the map and its meaning.
struct Stage {
  const char* name;
  char mark;
  const char* words;
};
constexpr Stage kStages[] = {{"generate", 'g', "the walk cannot be generated"},
                             {"repair", 'r', "the walk is inconsistent, and no repair was found"},
                             {"loop", 'l', "the walk does not close to a cycle"},
                             {"simulate", 's', "the simulated robot does not stand"},
                             {"certify", 'c', "the walk is not certified"},
                             {"neighbour", 'n', "the transition begins or ends at a missing cell"}};

const Stage& stage_of(const Json& entry) {
  const std::string name = entry.at("stage");
  for (const Stage& stage : kStages)
    if (name == stage.name) return stage;
  fail(ErrorCode::internal, "unknown stage " + name);
}

bool is_missing(const Json& entry) { return entry.at("status") == "missing"; }

/// The values of an axis for which no option is given: the values of the usual walk of the robot.
void fill_axes(const GaitsCommand& command, const RobotModel& model, GaitGrid& grid) {
  const WalkParameters usual = walk_defaults(model);
  const auto axis = [](const std::string& words, const std::string& option,
                       const std::vector<double>& usual_values) {
    return words.empty() ? usual_values : axis_values(words, option);
  };
  const auto rounded = [](double value) { return axis_values(text::brief(value, 2), "").front(); };
  grid.period = axis(command.period, "--period", {usual.period});
  for (const double period : grid.period)
    if (!(period > 0)) fail(ErrorCode::usage, "--period: a period must be above 0 s");
  const double speed = usual.stride / usual.period;
  const double half = rounded(0.5 * speed), quarter = rounded(0.25 * speed);
  grid.forward = axis(command.forward, "--forward", {-half, 0, half, 2 * half});
  grid.sideways = axis(command.sideways, "--sideways", {-quarter, 0, quarter});
  grid.turn = axis(command.turn, "--turn", {-8, 0, 8});
}

/// The robot in the form in which a pattern in the folder of patterns names it.
std::string robot_from(const std::string& robot, const fs::path& folder) {
  const std::string written = robot_as_written(robot);
  if (written.find('/') == std::string::npos || fs::path(written).is_absolute()) return written;
  return fs::proximate(fs::absolute(written).lexically_normal(),
                       fs::absolute(folder / "patterns").lexically_normal())
      .string();
}

Json grid_json(const GaitGrid& grid) {
  return {{"forward_m_s", grid.forward},
          {"sideways_m_s", grid.sideways},
          {"turn_deg_s", grid.turn},
          {"period_s", grid.period}};
}

Json asked_json(const GaitMaker& maker, const GaitOptions& options, const GaitGrid& grid) {
  Json study = nullptr;
  if (options.certify)
    study = {{"name", maker.study().name},       {"sha256", maker.study().sha256},
             {"failure", options.study.failure}, {"confidence", options.study.confidence},
             {"runs", options.study.most},       {"seed", options.study.seed}};
  return {{"format", "ayumi.gaits/1"},
          {"version", version()},
          {"robot", options.robot},
          {"robot_sha256", maker.model().description().sha256},
          {"profile", maker.profile()},
          {"controller", name_of(maker.controller().type)},
          {"grid", grid_json(grid)},
          {"cog_height_m", maker.height()},
          {"rate_hz", options.rate},
          {"study", study},
          {"with_transitions", options.transitions}};
}

/// Runs jobs on all threads in the order of their numbers, and keeps finished results. A job is
/// job(number, progress), which returns a GaitResult; `names` are the names of the results in the
/// folder.
template <typename Job>
std::vector<Json> run_jobs(const Context& context, const LibraryFolder& folder, const char* stage,
                           const std::vector<std::string>& names, const Job& job) {
  std::vector<Json> results(names.size());
  std::vector<size_t> wanted;
  for (size_t i = 0; i < names.size(); ++i)
    if (auto known = folder.known(names[i]))
      results[i] = std::move(*known);
    else
      wanted.push_back(i);
  const Progress progress = context.progress();
  std::atomic<bool> stop = false;
  std::mutex mutex;
  size_t done = names.size() - wanted.size();
  const auto tell = [&] {
    return !progress || progress({stage, double(done) / double(names.size()),
                                  std::to_string(done) + " of " + std::to_string(names.size())});
  };
  in_parallel(wanted.size(), context.threads, stop, [&](size_t k) {
    const size_t i = wanted[k];
    // The progress of the work inside a job is only used to ask whether to stop.
    GaitResult made = job(i, [&](const ProgressEvent&) {
      const std::lock_guard lock(mutex);
      return tell();
    });
    folder.add(names[i], made.json, made.files);
    const std::lock_guard lock(mutex);
    results[i] = std::move(made.json);
    ++done;
    if (!tell()) throw Interrupted();
  });
  return results;
}

GaitMap map_of(const GaitGrid& grid, const std::string& title, const std::vector<Json>& cells,
               const std::vector<Json>& transitions,
               const std::vector<std::pair<size_t, size_t>>& neighbours) {
  GaitMap map;
  map.title = title;
  map.forward = grid.forward;
  map.sideways = grid.sideways;
  map.columns = std::min(grid.turn.size(), kMostColumns);
  const size_t each = grid.forward.size() * grid.sideways.size();
  std::vector<bool> used(std::size(kStages));
  for (size_t p = 0; p * each < cells.size(); ++p) {
    GaitMapPanel panel;
    const double turn = grid.turn[p % grid.turn.size()];
    panel.title = text::brief(turn) + " deg/s, step of " +
                  text::brief(grid.period[p / grid.turn.size()]) + " s";
    for (size_t i = p * each; i < (p + 1) * each; ++i) {
      GaitMapCell cell;
      if (is_missing(cells[i])) {
        const Stage& stage = stage_of(cells[i]);
        cell.mark = stage.mark;
        used[static_cast<size_t>(&stage - kStages)] = true;
      } else {
        cell.margin = cells[i].at("zmp_margin_m").get<double>();
      }
      panel.cells.push_back(cell);
    }
    // Each pair is present in both orders, one after the other.
    for (size_t k = 0; k + 1 < transitions.size(); k += 2) {
      const auto [a, b] = neighbours[k];
      if (a / each != p || b / each != p) continue;
      panel.links.push_back(
          {a % each, b % each, !is_missing(transitions[k]) + !is_missing(transitions[k + 1])});
    }
    map.panels.push_back(std::move(panel));
  }
  for (size_t i = 0; i < std::size(kStages); ++i)
    if (used[i]) map.marks.emplace_back(kStages[i].mark, kStages[i].words);
  return map;
}

/// The missing cells in words, such as "60 cells: 15 made, 45 missing (40: the walk cannot be
/// generated; 5: ...)", and the first of them with their reasons.
std::string missing_words(const std::vector<Json>& entries, const char* noun,
                          const std::function<std::string(const Json&)>& name) {
  std::string kinds;
  size_t all = 0;
  for (const Stage& stage : kStages) {
    const auto count = std::count_if(entries.begin(), entries.end(), [&](const Json& entry) {
      return is_missing(entry) && &stage_of(entry) == &stage;
    });
    all += static_cast<size_t>(count);
    if (count > 0)
      kinds += "    " + text::counted(count, noun) + " missing, because " + stage.words + "\n";
  }
  std::string text = "  " + text::counted(entries.size(), noun) + ": ";
  text +=
      std::to_string(entries.size() - all) + " made, " + std::to_string(all) + " missing\n" + kinds;
  size_t shown = 0;
  for (const Json& entry : entries) {
    if (!is_missing(entry) || entry.at("stage") == "neighbour") continue;
    if (++shown > kShownMissing) break;
    text += "    " + name(entry) + ": " + entry.at("reason").get<std::string>() + "\n";
  }
  if (shown > kShownMissing) text += "    index.json contains all the reasons\n";
  return text;
}

void make_gaits(Context& context, GaitsCommand command) {
  GaitOptions& options = command.options;
  options.certify = !command.uncertified;
  options.transitions = !command.without_transitions;
  options.study.seed = context.seed;
  if (options.certify) {
    if (options.study.most == 0)
      options.study.most =
          kMostRuns * failure_free_runs(options.study.failure, options.study.confidence);
    const SequentialTest refuses(options.study.failure, options.study.confidence,
                                 options.study.most);
  }
  RobotModel model = load_robot(command.robot, robot_search(context));
  GaitGrid grid;
  fill_axes(command, model, grid);
  options.robot = robot_from(command.robot, command.out);
  GaitMaker maker(std::move(model), options);
  const std::vector<GaitCell> grid_cells = grid.cells();
  if (options.cog_height == 0)
    maker.use_height(maker.best_height(grid.corners(), context.threads, context.progress()));
  const auto neighbours =
      options.transitions ? grid.neighbours() : std::vector<std::pair<size_t, size_t>>();
  const Json asked = asked_json(maker, options, grid);
  const LibraryFolder folder(command.out, asked, context.force);

  std::vector<std::string> names;
  for (const GaitCell& cell : grid_cells) names.push_back(cell.name);
  const std::vector<Json> cells = run_jobs(
      context, folder, "walks", names,
      [&](size_t i, const Progress& progress) { return maker.make(grid_cells[i], progress); });
  names.clear();
  for (const auto& [a, b] : neighbours)
    names.push_back(grid_cells[a].name + "_to_" + grid_cells[b].name);
  const std::vector<Json> transitions =
      run_jobs(context, folder, "transitions", names, [&](size_t i, const Progress& progress) {
        const auto [a, b] = neighbours[i];
        for (const size_t end : {a, b})
          if (is_missing(cells[end]))
            return GaitResult{{{"from", grid_cells[a].name},
                               {"to", grid_cells[b].name},
                               {"status", "missing"},
                               {"stage", "neighbour"},
                               {"reason", grid_cells[end].name + " is missing"}},
                              {}};
        return maker.change(grid_cells[a], grid_cells[b], progress);
      });

  const std::string title = "walks of " + maker.model().name() + ", " +
                            name_of(maker.controller().type) + ", " + maker.profile();
  const Drawing map = draw_gait_map(map_of(grid, title, cells, transitions, neighbours));
  std::vector<std::string> files = {"map.svg", "map.png"};
  for (const std::string& file : files) write_drawing(folder.file(file), map, 2);
  for (const std::vector<Json>* entries : {&cells, &transitions})
    for (const Json& entry : *entries) {
      if (is_missing(entry)) continue;
      files.push_back(entry.at("pattern"));
      for (const char* rows : {"walk", "cycle"})
        if (entry.contains(rows))
          for (const char* file : {"table", "npz"}) files.push_back(entry.at(rows).at(file));
    }
  Json index = asked;
  index["command_line"] = context.command_line;
  Json joints = Json::array(), bodies = Json::array();
  for (const std::string& joint : maker.model().dof_names()) joints.push_back(joint);
  for (const Body& body : maker.model().bodies()) bodies.push_back(body.name);
  index["joints"] = joints;
  index["bodies"] = bodies;
  index["cells"] = cells;
  index["transitions"] = transitions;
  index["files"] = files;
  folder.deliver(index, files);

  context.print(command.out + ": walks of " + maker.model().name() + " with the controller " +
                name_of(maker.controller().type) + " and the profile " + maker.profile() + "\n" +
                missing_words(cells, "cell", [](const Json& e) { return e.at("name"); }));
  if (!transitions.empty())
    context.print(missing_words(transitions, "transition", [](const Json& e) {
      return e.at("from").get<std::string>() + " to " + e.at("to").get<std::string>();
    }));
  if (options.certify)
    context.print("  each walk that was made fails with a probability of at most " +
                  text::brief(100 * options.study.failure, 3) + " %, with " +
                  text::brief(100 * options.study.confidence, 3) +
                  " % confidence, for the uncertainty in " + maker.study().file + "\n");
  context.print("  written to " + command.out +
                ": index.json, map.svg, map.png, patterns, walks, " + "cycles" +
                (options.transitions ? ", transitions" : "") + "\n");
  const auto there =
      std::count_if(cells.begin(), cells.end(), [](const Json& cell) { return !is_missing(cell); });
  const auto changes = std::count_if(transitions.begin(), transitions.end(),
                                     [](const Json& change) { return !is_missing(change); });
  context.print_json(Json({{"output", command.out},
                           {"cells", cells.size()},
                           {"cells_there", there},
                           {"transitions", transitions.size()},
                           {"transitions_there", changes}})
                         .dump(2));
  context.exit_code = there == static_cast<long>(cells.size()) ? 0 : 1;
}

}  // namespace

void add_gaits(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "gaits", "make a library of certified walks over a grid of speeds and turning rates");
  command->footer(
      "Examples:\n  ayumi gaits hoap1 -o out/gaits\n"
      "  ayumi gaits hoap1 -o out/gaits --forward -0.06:0.1:9 --sideways -0.024:0.024:5 --turn "
      "-16:16:5\n"
      "  ayumi gaits hoap1 -o out/gaits --forward 0,0.05 --sideways 0 --turn 0 --failure 0.01\n"
      "Each LIST is a list of values (0,0.05) or a range FROM:TO:COUNT. A cell of the library is "
      "one combination of the values of --forward, --sideways, --turn and --period. Run the "
      "command again with the same options to continue. Exit code 1: a cell has no walk.");
  auto options = std::make_shared<GaitsCommand>();
  GaitOptions& gaits = options->options;
  command
      ->add_option("ROBOT", options->robot,
                   "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                   "Choreonoid body, mi-lib ztk).")
      ->required();
  command->add_option("-o,--out", options->out, "Folder for the library.")
      ->type_name("DIR")
      ->required();
  const auto add_axis = [&](const char* name, std::string& words, const char* what) {
    command->add_option(name, words, what)->type_name("LIST");
  };
  add_axis("--forward", options->forward,
           "Speeds forward [m/s] (default: speeds around the speed of `new walk`).");
  add_axis("--sideways", options->sideways,
           "Speeds to the left [m/s] (default: 0, and one speed on each side of 0).");
  add_axis("--turn", options->turn, "Turning rates to the left [deg/s] (default: -8, 0 and 8).");
  add_axis("--period", options->period,
           "Durations of one step [s] (default: the duration of a step in `new walk`).");
  command
      ->add_option("--cog-height", gaits.cog_height,
                   "COG height above the soles [m] (default: the height at which most walks pass "
                   "the check).")
      ->check(number_within(0.01, 5.0).description(""))
      ->type_name("M");
  command
      ->add_option("--rate", gaits.rate,
                   "Rows per second of the joint tables and of the NumPy archives (.npz).")
      ->check(number_within(1.0, 10000.0).description(""))
      ->type_name("HZ")
      ->capture_default_str();
  command->add_option("--profile", gaits.profile, "Actuator profile of the robot.")
      ->type_name("NAME");
  command->add_option("--controller", gaits.controller, "Controller (default: dtad).")
      ->type_name("NAME");
  gaits.study.failure = 0.15;
  command
      ->add_option("--failure", gaits.study.failure,
                   "Largest failure probability with which a walk is certified.")
      ->check(number_within(1e-6, 0.5).description(""))
      ->type_name("P")
      ->capture_default_str();
  command->add_option("--confidence", gaits.study.confidence, "Confidence of each certificate.")
      ->check(number_within(0.5, 0.999999).description(""))
      ->type_name("P")
      ->capture_default_str();
  command
      ->add_option(
          "--runs", gaits.study.most,
          "Largest number of runs for each walk (default: 4 times as many as a certificate "
          "needs when no run fails).")
      ->check(whole_number_within(1, 100000000).description(""))
      ->type_name("N");
  command
      ->add_option("--study", gaits.study_file,
                   "Study file with the uncertainty (default: the uncertainty of the robot).")
      ->type_name("F");
  command->add_flag("--uncertified", options->uncertified,
                    "Simulate each walk once, without uncertainty.");
  command->add_flag("--no-transitions", options->without_transitions,
                    "Do not make the walks that change from one cell to a neighbouring cell.");
  command->callback([options, &context] { make_gaits(context, *options); });
}

}  // namespace ayumi::app
