// Writes the first sidecar of a robot that has links and joints only.

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/first_sidecar.hpp"
#include "ayumi/study/gain_study.hpp"
#include "pattern_input.hpp"
#include "robot_picture.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

struct InitOptions {
  std::string robot, out, view = "iso";
};

std::string to_do_text(const std::string& robot, const std::vector<std::string>& items) {
  std::string text =
      "# " + robot + ": what to check\n\nrobot.json gives the reason for each guess.\n\n";
  for (size_t i = 0; i < items.size(); ++i)
    text += std::to_string(i + 1) + ". [ ] " + items[i] + "\n";
  return text;
}

// The files of a new robot. Either all of them are made or none.
class NewFolder {
 public:
  NewFolder(const Context& context, const fs::path& folder) : folder_(folder) {
    std::error_code ignored;
    made_ = fs::create_directories(folder_, ignored);
    for (const char* name : {"robot.json", "robot.png", "TODO.md"}) {
      if (!fs::is_directory(folder_, ignored))
        fail(ErrorCode::bad_file, {folder_.string()}, "this folder cannot be made");
      refuse_overwriting(context, folder_ / name);
    }
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!complete_)
      for (const fs::path& file : written_) fs::remove(file, ignored);
    if (!complete_ && made_) fs::remove(folder_, ignored);  // removes the folder if it is empty
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;

  void write(const char* name, const std::string& bytes) {
    const fs::path file = folder_ / name;
    std::error_code ignored;
    const bool fresh = !fs::exists(file, ignored);
    write_file(file, bytes);
    if (fresh) written_.push_back(file);
  }
  void complete() { complete_ = true; }

 private:
  fs::path folder_;
  std::vector<fs::path> written_;
  bool made_ = false, complete_ = false;
};

// Largest factor by which stiffer servos are tried. Chosen: servos that are sixteen times too soft
// are a mistake in the file.
constexpr double kMostStiffer = 16;

// The factor by which the servos of the legs must be stiffer for gains that keep the robot
// standing.
double stiffness_needed(const RobotModel& model) {
  for (double factor = 1.25; factor <= kMostStiffer; factor *= 1.25) {
    RobotDescription stiffer = model.description();
    std::set<int> joints;  // a joint may move both legs
    for (const Side side : {Side::left, Side::right})
      for (const int dof : model.leg(side)) joints.insert(dof);
    for (const int dof : joints) {
      ServoDescription& servo = stiffer.servos[model.dofs()[static_cast<size_t>(dof)].name];
      servo.kp *= factor;
      servo.kd *= factor;
    }
    const GainStudy study = study_gains(RobotModel(stiffer));
    if (study.weakest.analysis.stable || nearest_stable_gains(study.loops, study.params))
      return factor;
  }
  return 0;
}

// The gains nearest to the defaults with which the robot can stand, if it cannot stand with the
// defaults. A robot that cannot stand at all, such as one with four legs, gets no gains.
SidecarGains gains_for(const RobotModel& model) {
  const std::vector<ServoDescription>& servos = model.limits().servo;
  for (const Side side : {Side::left, Side::right})
    for (const int dof : model.leg(side))
      if (servos[static_cast<size_t>(dof)].kp <= 0) return {};
  std::optional<GainStudy> standing;
  try {
    standing = study_gains(model);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) throw;
    SidecarGains none;
    none.to_do =
        "Correct the soles and the home posture before you make a motion: the robot cannot stand "
        "in this posture (" +
        std::string(error.what()) + ").";
    return none;
  }
  const GainStudy& study = *standing;
  if (study.weakest.analysis.stable) return {};
  SidecarGains result;
  if (const auto stable = nearest_stable_gains(study.loops, study.params)) {
    result.dtad = changed_loop_gains(*stable, study.params);
    const double decay = weakest_loop(study.loops, *stable).analysis.decay;
    result.why =
        "with the default gains, an error of the standing robot grows by the factor e in " +
        text::brief(-1 / study.weakest.analysis.decay, 2) + " s (" +
        name_of(study.loops[study.weakest.index]) +
        "), because the servos are soft. Among the gains that were tried, these are the nearest to "
        "the default gains that let the error " +
        (decay > 0
             ? "decay (time constant of the slowest mode: " + text::brief(1 / decay, 2) + " s)"
             : std::string("grow by less than the factor e during a step"));
    result.check = "with `ayumi gains`, after the constants of the servos are known";
    result.to_do =
        "Check the stiffness of the servos: they are so soft that the default gains of the control "
        "law do not keep the robot standing. This sidecar has other gains (\"control\").";
    return result;
  }
  const double needed = stiffness_needed(model);
  result.to_do =
      "Check the stiffness of the servos of the legs: they are so soft that no gains of the "
      "control law were found that keep the robot standing" +
      (needed > 0 ? ". Such gains exist if kp and kd of these servos are " +
                        text::brief(needed, 2) + " times as large."
                  : std::string("."));
  return result;
}

void init(const Context& context, const InitOptions& options) {
  fs::path folder = fs::path(options.out).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  const FirstSidecar sidecar =
      first_sidecar(options.robot, folder, robot_search(context), gains_for);
  NewFolder files(context, folder);
  RobotPicture picture;
  size_t joints = 0;
  // The sidecar is written to a temporary file and read back from it. Only then is the file renamed
  // to robot.json.
  write_file_with(folder / "robot.json", [&](const fs::path& temporary) {
    write_file(temporary, sidecar.text);
    const RobotModel model =
        load_robot(temporary.string(), robot_search(context), {.meshes = true});
    joints = static_cast<size_t>(model.dof_count());
    picture = draw_robot(model, options.view, true);
    files.write("robot.png", encode_png(picture.image));
    files.write("TODO.md", to_do_text(model.name(), sidecar.to_do));
  });
  files.complete();
  const std::string at = folder.string();
  context.print(at + "/robot.json: sidecar of " + sidecar.robot.name + ", " +
                std::to_string(joints) + " joints, with the reason for each guess\n" + at +
                "/robot.png: picture of the home posture with soles and joint axes\n" + at +
                "/TODO.md: list of what you have to check\n");
  for (const std::string& item : sidecar.to_do) context.print("  - " + item + "\n");
  for (const std::string& note : picture.notes)
    context.print("  - note on the picture: " + note + "\n");
  if (!sidecar.robot.soles.empty())
    context.print("Next: ayumi new walk --robot " + at +
                  " -o walk.json, then ayumi run walk.json -o walk_run\n");
  context.print_json(nlohmann::ordered_json{{"robot", sidecar.robot.name},
                                            {"sidecar", at + "/robot.json"},
                                            {"picture", at + "/robot.png"},
                                            {"to_do_file", at + "/TODO.md"},
                                            {"to_do", sidecar.to_do},
                                            {"assumptions", sidecar.robot.assumptions}}
                         .dump(2));
}

}  // namespace

void add_init(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "init",
      "write a first version of the sidecar of a robot, with a picture and a to-do list, from a "
      "file of the robot (URDF, MJCF, SDF, Choreonoid body or mi-lib ztk)");
  command->footer(
      "Examples:\n  ayumi init somebody.urdf -o my_robots/somebody\n"
      "Then follow the to-do list, and make a motion:\n"
      "  ayumi new walk --robot my_robots/somebody -o walk.json\n  ayumi run walk.json -o "
      "walk_run");
  auto options = std::make_shared<InitOptions>();
  command
      ->add_option(
          "robot", options->robot,
          "URDF, MJCF, SDF, Choreonoid body or mi-lib ztk, or a folder with one such file.")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("-o,--out", options->out,
                   "Folder of the robot. Ayumi creates the folder if needed.")
      ->required()
      ->type_name("DIR");
  command->callback([&context, options] { init(context, *options); });
}

}  // namespace ayumi::app
