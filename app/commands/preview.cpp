// Clips, pictures and frames of a run, off-screen and without simulating again.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run_folder.hpp"
#include "ayumi/preview/clip.hpp"
#include "commands.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct PreviewOptions {
  std::string input, output, log, robot, size = "1280x720", camera = "follow";
  std::vector<std::string> hide;
  ClipOptions clip;
  bool draft = false;
};

// The switches of OverlayOptions by the names that --hide takes.
constexpr std::pair<const char*, bool OverlayOptions::*> kMarks[] = {
    {"cog", &OverlayOptions::cog},
    {"zmp", &OverlayOptions::zmp},
    {"ref-zmp", &OverlayOptions::reference_zmp},
    {"support", &OverlayOptions::support},
    {"forces", &OverlayOptions::forces},
    {"push", &OverlayOptions::push},
    {"trails", &OverlayOptions::trails},
    {"caption", &OverlayOptions::caption}};

void hide_marks(const std::vector<std::string>& names, OverlayOptions& overlay) {
  std::vector<std::string> known = {"all"};
  for (const auto& [name, flag] : kMarks) known.emplace_back(name);
  for (const std::string& word : names) {
    bool found = word == "all";
    for (const auto& [name, flag] : kMarks)
      if (word == "all" || word == name) {
        overlay.*flag = false;
        found = true;
      }
    if (!found)
      fail(ErrorCode::usage, "--hide " + word + ": not one of " + text::join(known, ", ") +
                                 text::suggestion(word, known));
  }
}

void parse_size(const std::string& words, RenderOptions& picture) {
  int used = 0;
  if (std::sscanf(words.c_str(), "%dx%d%n", &picture.width, &picture.height, &used) != 2 ||
      size_t(used) != words.size())
    fail(ErrorCode::usage, "--size " + words + ": WIDTHxHEIGHT is needed, e.g. 1280x720");
}

CameraMode camera_mode(const std::string& name) {
  if (name == "fixed") return CameraMode::fixed;
  return name == "orbit" ? CameraMode::orbit : CameraMode::follow;
}

int thread_count(const Context& context) {
  if (context.threads > 0) return context.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void preview(PreviewOptions options, Context& context) {
  if (fs::exists(options.output) && !fs::is_directory(options.output) && !context.force)
    fail(ErrorCode::usage, options.output + ": exists already; --force overwrites it");
  ClipOptions& clip = options.clip;
  parse_size(options.size, clip.picture);
  hide_marks(options.hide, clip.overlay);
  clip.camera.mode = camera_mode(options.camera);
  clip.picture.antialias = !options.draft;
  clip.threads = thread_count(context);
  const SimulationLog log = read_run_log(options.input, options.log);
  const RobotModel model = load_robot(options.robot.empty() ? log.provenance.robot : options.robot,
                                      robot_search(context), {.meshes = true});
  const auto start = std::chrono::steady_clock::now();
  const ClipSummary summary = write_clip(model, log, options.output, clip, context.progress());
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string size = std::to_string(summary.width) + "x" + std::to_string(summary.height);
  context.print(options.output + ": " + std::to_string(summary.frames) +
                (summary.frames == 1 ? " picture, " : " frames, ") + size + ", " +
                text::brief(wall, 3) + " s\n");
  const nlohmann::ordered_json json = {{"output", options.output},
                                       {"frames", summary.frames},
                                       {"fps", summary.fps},
                                       {"size", {summary.width, summary.height}},
                                       {"wall_s", wall}};
  context.print_json(json.dump(2));
}

}  // namespace

void add_preview(CLI::App& app, Context& context) {
  auto options = std::make_shared<PreviewOptions>();
  ClipOptions& clip = options->clip;
  CLI::App* command = app.add_subcommand("preview", "clip or picture of a run, off-screen");
  command->add_option("run", options->input, "a RUN folder or a log file")
      ->required()
      ->type_name("RUN");
  command
      ->add_option("-o,--out", options->output,
                   ".mp4, .webm, .gif, .png, or a folder for PNG frames")
      ->required()
      ->type_name("FILE");
  command->add_option("--log", options->log, "which log of the RUN, e.g. open_loop");
  command->add_option("--robot", options->robot, "robot, where it is not the recorded one");
  command->add_option("--size", options->size, "pixels")->capture_default_str()->type_name("WxH");
  command->add_option("--fps", clip.fps, "frames per second")->capture_default_str();
  command->add_option("--speed", clip.speed, "0.25 plays four times slower")->capture_default_str();
  command->add_option("--from", clip.begin, "first instant [s]")->capture_default_str();
  command->add_option("--to", clip.end, "last instant [s]");
  command->add_option("--at", clip.at, "instant of a single picture [s]")->capture_default_str();
  command->add_option("--view", clip.camera.view, text::join(view_names(), ", "))
      ->capture_default_str();
  command->add_option("--camera", options->camera, "follow, fixed or orbit")
      ->check(CLI::IsMember({"follow", "fixed", "orbit"}).description(""))
      ->capture_default_str();
  command->add_option("--zoom", clip.camera.zoom, "2: twice as large")->capture_default_str();
  command
      ->add_option("--hide", options->hide,
                   "cog, zmp, ref-zmp, support, forces, push, trails, caption or all")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--title", clip.title, "first words of the caption");
  command->add_flag("--draft", options->draft, "faster, without antialiasing");
  command->footer(
      "Examples:\n"
      "  ayumi preview out/ -o walk.mp4\n"
      "  ayumi preview out/ --log open_loop --view side -o fall.mp4\n"
      "  ayumi preview out/ --at 2.35 --hide trails,forces -o push.png\n"
      "  ayumi preview out/ --from 2 --to 3 --speed 0.2 -o slow.webm");
  command->callback([options, &context] { preview(*options, context); });
}

}  // namespace ayumi::app
