// Writes the first sidecar of a robot that has links and joints only.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/robot/first_sidecar.hpp"
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

// The files of a new robot: all of them or none.
class NewFolder {
 public:
  NewFolder(const Context& context, const fs::path& folder) : folder_(folder) {
    std::error_code ignored;
    made_ = fs::create_directories(folder_, ignored);
    for (const char* name : {"robot.json", "robot.png", "TODO.md"}) {
      if (!fs::is_directory(folder_, ignored))
        fail(ErrorCode::bad_file, folder_.string() + ": this folder cannot be made");
      refuse_overwriting(context, folder_ / name);
    }
  }
  ~NewFolder() {
    std::error_code ignored;
    if (!complete_)
      for (const fs::path& file : written_) fs::remove(file, ignored);
    if (!complete_ && made_) fs::remove(folder_, ignored);  // where it is empty
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

void init(const Context& context, const InitOptions& options) {
  fs::path folder = fs::path(options.out).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  const FirstSidecar sidecar = first_sidecar(options.robot, folder, robot_search(context));
  NewFolder files(context, folder);
  RobotPicture picture;
  size_t joints = 0;
  // The sidecar is read back before it gets its name.
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
  Command* command = app.add_subcommand("init",
                                        "write the first sidecar of a robot from its URDF, MJCF, "
                                        "SDF, body or ztk file, with a picture and a to-do list");
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
