// Clips, pictures, frames and glTF of runs. They are drawn off-screen from the logs, without a new
// simulation.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/log_robot.hpp"
#include "ayumi/render/frames.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/snapshots.hpp"
#include "option_checks.hpp"
#include "plan_log.hpp"
#include "preview_batch.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct PreviewOptions {
  std::vector<std::string> inputs;
  std::string output, log, robot, ghost, sheet, size, camera = "follow";
  std::string frame = "world";
  std::string format = "mp4";
  std::vector<std::string> hide, show;
  ClipOptions clip;
  int strip = 0, exposures = 0, columns = 4;
  bool draft = false;
};

// The switches of OverlayOptions with the names that --hide and --show accept.
constexpr std::pair<const char*, bool OverlayOptions::*> kMarks[] = {
    {"cog", &OverlayOptions::cog},
    {"zmp", &OverlayOptions::zmp},
    {"ref-zmp", &OverlayOptions::reference_zmp},
    {"support", &OverlayOptions::support},
    {"forces", &OverlayOptions::forces},
    {"push", &OverlayOptions::push},
    {"trails", &OverlayOptions::trails},
    {"heat", &OverlayOptions::heat},
    {"scale", &OverlayOptions::scale},
    {"caption", &OverlayOptions::caption}};

void switch_marks(const std::string& option, const std::vector<std::string>& names, bool on,
                  OverlayOptions& overlay) {
  std::vector<std::string> known = {"all"};
  for (const auto& [name, flag] : kMarks) known.emplace_back(name);
  for (const std::string& word : names) {
    bool found = word == "all";
    for (const auto& [name, flag] : kMarks)
      if (word == "all" || word == name) {
        overlay.*flag = on;
        found = true;
      }
    if (!found)
      fail(ErrorCode::usage, option + " " + word + ": unknown mark. The marks are " +
                                 text::join(known, ", ") + text::suggestion(word, known));
  }
}

void parse_size(const std::string& words, RenderOptions& picture) {
  int used = 0;
  if (std::sscanf(words.c_str(), "%dx%d%n", &picture.width, &picture.height, &used) != 2 ||
      size_t(used) != words.size())
    fail(ErrorCode::usage,
         "--size " + words + ": the size must have the form WIDTHxHEIGHT, for example 1280x720");
}

CameraMode camera_mode(const std::string& name) {
  if (name == "fixed") return CameraMode::fixed;
  return name == "orbit" ? CameraMode::orbit : CameraMode::follow;
}

int thread_count(const Context& context) {
  if (context.threads > 0) return context.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void settle(PreviewOptions& options, const Context& context) {
  ClipOptions& clip = options.clip;
  // A snapshot is higher than it is wide, like a robot.
  parse_size(!options.size.empty() ? options.size
             : options.strip > 0   ? "320x480"
                                   : "1280x720",
             clip.picture);
  switch_marks("--hide", options.hide, false, clip.overlay);
  switch_marks("--show", options.show, true, clip.overlay);
  clip.camera.mode = camera_mode(options.camera);
  clip.picture.antialias = !options.draft;
  clip.threads = thread_count(context);
  if (options.strip > 0 && options.exposures > 0)
    fail(ErrorCode::usage, "give either --strip or --exposures, not both");
}

/// Snapshots between --from and --to; if neither is given, at the most informative times.
StripOptions strip_options(const PreviewOptions& options, const SimulationLog& log) {
  StripOptions strip;
  strip.clip = options.clip;
  strip.columns = options.columns;
  strip.one_picture = options.exposures > 0;
  const int count = std::max(options.strip, options.exposures);
  strip.count = count;
  const double last = duration(log), begin = std::min(options.clip.begin, last);
  const double end = options.clip.end < 0 ? last : std::min(options.clip.end, last);
  if (begin > 0 || end < last)
    for (int i = 0; i < count; ++i)
      strip.times.push_back(begin + (end - begin) * i / std::max(1, count - 1));
  return strip;
}

ClipSummary write_glb(const RobotModel& model, const SimulationLog& log, const fs::path& path,
                      const PreviewOptions& options, const SimulationLog* ghost) {
  const ClipOptions& clip = options.clip;
  std::vector<Motion> motions = {motion_of(log, MotionSource::run, clip.fps, clip.begin, clip.end)};
  if (clip.ghost.command)
    motions.push_back(motion_of(log, MotionSource::command, clip.fps, clip.begin, clip.end));
  if (ghost) {
    motions.push_back(motion_of(*ghost, MotionSource::run, clip.fps, clip.begin, clip.end));
    motions.back().name = clip.ghost.name;
  }
  write_file(path, glb_bytes(model, motions, {.max_triangles = clip.max_triangles}));
  return {.frames = static_cast<int>(motions.front().times.size()), .fps = clip.fps};
}

/// Draws one run into one file. `clip` has all settings except the number of threads.
ClipSummary draw_run(const PreviewOptions& options, const std::string& input, const fs::path& path,
                     int threads, const Context& context, const Progress& progress) {
  const Frame frame = frame_of(options.frame);
  SimulationLog log = log_of(context, input, options.log);
  const RobotModel model = robot_of_log(context, options.robot, log, input, {.meshes = true});
  require_level_ground(log, frame);
  log = in_frame(model, std::move(log), frame);
  PreviewOptions own = options;
  own.clip.threads = threads;
  own.clip.overwrite = context.force;
  std::optional<SimulationLog> ghost;
  if (options.ghost == "command")
    own.clip.ghost.command = true;
  else if (!options.ghost.empty()) {
    const bool elsewhere =
        fs::exists(options.ghost) || options.ghost.find('/') != std::string::npos;
    if (!elsewhere && names_pattern(input))
      fail(ErrorCode::usage, "--ghost " + options.ghost +
                                 ": the input is a pattern, which has no logs; " +
                                 "give another pattern, a RUN, or 'command'");
    ghost = elsewhere ? log_of(context, options.ghost, options.log)
                      : log_of(context, input, options.ghost);
    if (!elsewhere)  // an output of another log is not replaced
      require_log_of(model, options.robot, *ghost, input + ", " + options.ghost);
    else if (ghost->joints == log.joints)
      require_postures_of(model, *ghost, options.ghost);
    own.clip.ghost.name =
        elsewhere ? fs::path(options.ghost).lexically_normal().stem().string() : options.ghost;
  }
  if (ghost && ghost->joints == log.joints) ghost = in_frame(model, std::move(*ghost), frame);
  if (ghost) own.clip.ghost.log = &*ghost;
  if (path.extension() == ".glb")
    return write_glb(model, log, path, own, ghost ? &*ghost : nullptr);
  if (options.strip > 0 || options.exposures > 0) {
    if (path.extension() != ".png")
      fail(ErrorCode::usage, {path.string()},
           "--strip and --exposures need a file name that ends in .png");
    const StripOptions strip = strip_options(own, log);
    ClipSummary summary{.frames = strip.count};
    const Image image = draw_strip(model, log, strip, progress, &summary.notes);
    write_png(path, image);
    summary.width = image.width;
    summary.height = image.height;
    return summary;
  }
  return write_clip(model, log, path, own.clip, progress);
}

nlohmann::ordered_json json_of(const std::string& output, const ClipSummary& summary) {
  nlohmann::ordered_json json = {{"output", output},
                                 {"frames", summary.frames},
                                 {"fps", summary.fps},
                                 {"size", {summary.width, summary.height}},
                                 {"notes", summary.notes}};
  if (summary.at) json["at_s"] = *summary.at;
  return json;
}

void preview_one(const PreviewOptions& options, Context& context) {
  const bool frames = fs::path(options.output).extension().empty();
  if (!frames) refuse_overwriting(context, options.output);
  const auto start = std::chrono::steady_clock::now();
  const ClipSummary summary = draw_run(options, options.inputs.front(), options.output,
                                       options.clip.threads, context, context.progress());
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string size = std::to_string(summary.width) + "x" + std::to_string(summary.height);
  context.print(options.output + ": " + std::to_string(summary.frames) +
                (summary.width == 0    ? " postures"
                 : summary.frames == 1 ? " picture, " + size
                                       : " frames, " + size) +
                ", " + text::brief(wall, 3) + " s\n");
  for (const std::string& note : summary.notes) context.print("  " + note + "\n");
  nlohmann::ordered_json json = json_of(options.output, summary);
  json["wall_s"] = wall;
  context.print_json(json.dump(2));
}

/// The tile of a run in the contact sheet: the most informative instant, with the name of the run.
Image sheet_tile(const PreviewOptions& options, const std::string& input, const Context& context) {
  SimulationLog log = log_of(context, input, options.log);
  const RobotModel model = robot_of_log(context, options.robot, log, input, {.meshes = true});
  log = in_frame(model, std::move(log), frame_of(options.frame));
  ClipOptions clip = options.clip;
  clip.picture.width = 480;
  clip.picture.height = 270;
  clip.title = fs::path(input).lexically_normal().stem().string();
  return ClipRenderer(model, log, clip).frame(telling_instant(log));
}

void preview_many(const PreviewOptions& options, Context& context) {
  PreviewBatch batch;
  batch.inputs = options.inputs;
  batch.folder = options.output;
  batch.extension = "." + options.format;
  batch.threads = options.clip.threads;
  batch.again = context.force;
  batch.draw = [&](const std::string& input, const fs::path& path, int threads) {
    return json_of(path.string(), draw_run(options, input, path, threads, context, {}));
  };
  if (!options.sheet.empty()) {
    batch.sheet = options.sheet;
    batch.tile = [&](const std::string& input) { return sheet_tile(options, input, context); };
    batch.columns = options.columns;
  }
  run_batch(batch, context);
}

void preview(PreviewOptions options, Context& context) {
  settle(options, context);
  if (options.inputs.size() > 1 || !options.sheet.empty())
    preview_many(options, context);
  else
    preview_one(options, context);
}

void add_picture_options(Command& command, PreviewOptions& options) {
  ClipOptions& clip = options.clip;
  command
      .add_option(
          "--size", options.size,
          "Size in pixels; with --strip, the size of one snapshot (default: 1280x720; with --strip "
          "320x480).")
      ->type_name("WxH");
  command.add_option("--fps", clip.fps, "Frames per second.")->capture_default_str();
  command
      .add_option("--speed", clip.speed,
                  "Playing speed: 1 is the real speed, 0.25 is four times slower.")
      ->capture_default_str();
  command.add_option("--from", clip.begin, "Time of the motion at which the clip begins [s].")
      ->capture_default_str();
  command.add_option("--to", clip.end,
                     "Time of the motion at which the clip ends [s] (default: the end).");
  command.add_option("--at", clip.at,
                     "Time of the picture, if the file is a single picture [s]. The default is "
                     "just after the first push. Without a push, it is the time of the fall. "
                     "Without a fall, it is the middle of the first flight. Without a flight, it "
                     "is the time at which the posture differs most from the first posture.");
  command
      .add_option("--strip", options.strip,
                  "Draw this number of snapshots into one .png, in rows of --columns.")
      ->check(whole_number_within(StripOptions::kCount));
  command
      .add_option(
          "--exposures", options.exposures,
          "Draw this number of postures over each other into one .png, evenly spaced in time.")
      ->check(whole_number_within(StripOptions::kExposures));
  command
      .add_option("--columns", options.columns,
                  "Number of pictures in one row of --strip and --sheet.")
      ->check(whole_number_within(StripOptions::kColumns))
      ->capture_default_str();
  command.add_option("--view", clip.camera.view, "View: " + text::join(view_names(), ", ") + ".")
      ->check(one_of(view_names()).description(""))
      ->capture_default_str();
  command.add_option("--camera", options.camera, "Camera: follow, fixed or orbit.")
      ->check(one_of({"follow", "fixed", "orbit"}).description(""))
      ->capture_default_str();
  command
      .add_option(
          "--frame", options.frame,
          "Reference frame: world, or foot (the supporting foot stands still in the picture).")
      ->check(one_of(frame_names()).description(""))
      ->capture_default_str();
  command
      .add_option("--zoom", clip.camera.zoom, "Magnification: 2 draws the robot twice as large.")
      ->capture_default_str();
  command
      .add_option("--ghost", options.ghost,
                  "Also draw a second, translucent robot. RUN says which motion this robot shows: "
                  "the word command (the commanded posture), the name of a log of the run such as "
                  "open_loop, another run, or a pattern of the same robot.")
      ->type_name("RUN");
  for (const auto& [name, list, what] :
       {std::tuple{"--hide", &options.hide,
                   "Marks to leave out: cog, zmp, ref-zmp, support, forces, push, trails, heat, "
                   "scale, caption or all."},
        {"--show", &options.show,
         "Marks to draw in addition to the usual marks, with the names of --hide. The mark 'heat' "
         "colours a joint amber near a limit and red at the limit."}})
    command.add_option(name, *list, what)->delimiter(',')->allow_extra_args(false);
  command.add_option("--title", clip.title, "Text at the beginning of the caption.");
  command.add_flag("--draft", options.draft, "Draw faster, without antialiasing.");
}

}  // namespace

void add_preview(Command& app, Context& context) {
  auto options = std::make_shared<PreviewOptions>();
  Command* command =
      app.add_subcommand("preview", "draw a clip, picture or glTF file of a run or pattern");
  command
      ->add_option("run", options->inputs,
                   "Run folders, log files, or patterns (drawn as planned).")
      ->required()
      ->type_name("RUN");
  command
      ->add_option("-o,--out", options->output,
                   "File to write: .mp4, .webm, .gif, .apng, .png or .glb; without an extension, a "
                   "folder of PNG frames. For several runs, a folder of clips.")
      ->required()
      ->type_name("FILE");
  command->add_option("--log", options->log, "Log of the run, for example open_loop.");
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the robot that the run names.");
  command->add_option("--format", options->format, "Format of the clips of several runs.")
      ->check(one_of({"mp4", "webm", "gif", "apng", "png", "glb"}).description(""))
      ->capture_default_str();
  command
      ->add_option("--sheet", options->sheet, "Also draw one picture of each run into this .png.")
      ->type_name("FILE");
  add_picture_options(*command, *options);
  command->footer(
      "Examples:\n"
      "  ayumi preview out/ -o walk.mp4\n"
      "  ayumi preview bow.json -o bow.png\n"
      "  ayumi preview out/ --log open_loop --view side -o fall.mp4\n"
      "  ayumi preview out/ --at 2.35 --hide trails,forces -o push.png\n"
      "  ayumi preview out/ --from 2 --to 3 --speed 0.2 --ghost command -o slow.webm\n"
      "  ayumi preview out/ --ghost open_loop -o both.mp4\n"
      "  ayumi preview out/ --exposures 6 --view side -o walk.png\n"
      "  ayumi preview out/ -o walk.glb\n"
      "  ayumi preview repaired.json --ghost walk.json -o moved.mp4\n"
      "  ayumi preview runs/* -o clips/ --sheet clips/all.png");
  command->callback([options, &context] { preview(*options, context); });
}

}  // namespace ayumi::app
