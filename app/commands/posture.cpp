// Named postures: the command lists, draws, mirrors, changes and captures them, and keeps them in a
// library that patterns include.

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/json_depth.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/render/camera.hpp"
#include "option_checks.hpp"
#include "pattern_input.hpp"
#include "robot_picture.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Angles = std::map<std::string, double>;  // positions by joint [rad], for sliding joints [m]

// Names in a message. Chosen: a person still reads a message of this length.
constexpr size_t kMostNamed = 20;

struct PostureCommand {
  std::string source, name, robot, as, out, log, view = "iso";
  std::vector<std::string> joints;
  double at = 0;
  bool radians = false;
};

// ---- sources of postures

/// The postures of a robot, a pattern or a library.
struct PostureSource {
  std::map<std::string, Angles> postures;
  std::string robot;  ///< the robot that the source names; "" if it names none
};

// The value of "format" in a JSON text with comments; "" if it is not such a text.
std::string format_of(const std::string& text) {
  const auto json = shallow_json<nlohmann::json>(text, true);
  return json.is_object() ? json.value("format", "") : "";
}

RobotModel robot_of_source(const Context& context, const PostureCommand& options,
                           const std::string& named) {
  const std::string& robot = options.robot.empty() ? named : options.robot;
  if (robot.empty())
    fail(ErrorCode::usage, {options.source}, "the library names no robot. Give --robot ROBOT");
  return load_robot(robot, robot_search(context), {.meshes = true});
}

// Joints that a posture of a robot does not name are at 0.
std::map<std::string, Angles> whole_postures(const RobotModel& model) {
  std::map<std::string, Angles> postures = model.description().postures;
  for (auto& [name, angles] : postures)
    for (const Dof& dof : model.dofs()) angles.emplace(dof.name, 0.0);
  return postures;
}

PostureSource source_of(const Context& context, const PostureCommand& options) {
  const fs::path file = options.source;
  std::error_code ignored;
  const bool is_json = file.extension() == ".json" && fs::is_regular_file(file, ignored);
  const std::string format = is_json ? format_of(read_file(file)) : "";
  PostureSource source;
  if (format == "ayumi.postures/1") {
    const PostureLibrary library = read_posture_library(file);
    return {library.postures, library.robot};
  }
  if (format == "ayumi.pattern/1") {
    const Pattern pattern = read_pattern(file);
    source = {pattern.postures, robot_of(pattern)};
    const RobotModel model = robot_of_source(context, options, source.robot);
    source.postures.merge(whole_postures(model));
    return source;
  }
  return {whole_postures(load_robot(options.source, robot_search(context))), options.source};
}

const Angles& posture_of(const PostureSource& source, const PostureCommand& options) {
  const auto found = source.postures.find(options.name);
  if (found != source.postures.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, angles] : source.postures) names.push_back(name);
  fail(ErrorCode::usage, {options.source},
       "there is no posture '" + options.name + "'" + text::suggestion(options.name, names) +
           " (known: " + text::join_first(names, kMostNamed) + ")");
}

int dof_of(const RobotModel& model, const std::string& joint, const SourcePlace& place) {
  const int dof = model.find_dof(joint);
  if (dof < 0)
    fail(ErrorCode::usage, place,
         model.name() + " has no joint '" + joint + "'" +
             text::suggestion(joint, model.dof_names()));
  return dof;
}

// Joints that a posture of a pattern or a library does not name are as in the robot's home posture.
Eigen::VectorXd theta_of(const RobotModel& model, const Angles& angles, const SourcePlace& place) {
  Eigen::VectorXd theta = model.posture();
  for (const auto& [joint, angle] : angles) theta[dof_of(model, joint, place)] = angle;
  return theta;
}

// ---- angles for people and files

double in_unit(const RobotModel& model, const std::string& joint, double value, bool degrees) {
  const int dof = model.find_dof(joint);
  const bool turns = dof < 0 || !model.dofs()[dof].prismatic;
  return turns && degrees ? value * 180 / std::numbers::pi : value;
}

// Rounded more finely than any encoder: to 1e-6 of a degree, of a radian or of a metre.
double rounded(double value) { return std::round(value * 1e6) / 1e6 + 0.0; }

Json angles_json(const RobotModel& model, const Angles& angles, bool degrees) {
  Json json = Json::object();
  for (const Dof& dof : model.dofs())
    if (const auto found = angles.find(dof.name); found != angles.end())
      json[dof.name] = rounded(in_unit(model, dof.name, found->second, degrees));
  return json;
}

// Angles in words, such as "l_knee 43.58, ..."; joints at 0 are left out. For a sliding joint, the
// unit follows the number; other angles are in deg.
std::string angles_text(const RobotModel* model, const Angles& angles) {
  std::vector<std::string> words;
  for (const auto& [joint, value] : angles) {
    const int dof = model ? model->find_dof(joint) : -1;
    const bool slides = dof >= 0 && model->dofs()[dof].prismatic;
    if (std::abs(value) > 1e-9)
      words.push_back(joint + " " +
                      (slides ? text::brief(1000 * value, 4) + " mm"
                              : text::brief(value * 180 / std::numbers::pi, 4)));
  }
  return words.empty() ? "every joint at 0" : text::join(words, ", ");
}

// ---- the library

std::string pointer_of(const std::string& name) { return "/postures/" + json_pointer_token(name); }

// The text of a new library, or the author's own text with one more posture; every other byte
// stays.
std::string library_text(const Context& context, const PostureCommand& options,
                         const RobotModel& model, const std::string& robot, const Angles& angles) {
  std::error_code ignored;
  if (!fs::exists(options.out, ignored)) {
    const bool degrees = !options.radians;
    const std::string empty =
        "{\n  \"format\": \"ayumi.postures/1\",\n  \"robot\": " + Json(robot).dump() +
        ",\n  \"units\": { \"angle\": \"" + (degrees ? "deg" : "rad") +
        "\" },\n  \"postures\": {\n  }\n}\n";
    return edited_text(empty, {{PatternEdit::Kind::set, pointer_of(options.as),
                                angles_json(model, angles, degrees).dump()}});
  }
  const PostureLibrary library = read_posture_library(options.out);
  if (library.postures.contains(options.as) && !context.force)
    fail(ErrorCode::bad_file, {options.out},
         "the library already has a posture '" + options.as +
             "'. Choose another name with --as, or replace the posture with --force");
  return edited_text(read_file(options.out),
                     {{PatternEdit::Kind::set, pointer_of(options.as),
                       angles_json(model, angles, library.degrees).dump()}});
}

void save(const Context& context, const PostureCommand& options, const RobotModel& model,
          const std::string& robot, const Angles& angles) {
  if (options.as.empty()) fail(ErrorCode::usage, "--as: the posture needs a name");
  require_file_target(options.out);
  const std::string text = library_text(context, options, model, robot, angles);
  write_file(options.out, text);
  std::vector<std::string> beyond, words;
  for (const auto& [joint, angle] : angles) {
    const Dof& dof = model.dofs()[model.find_dof(joint)];
    if (dof.limited && (angle < dof.lower - 1e-9 || angle > dof.upper + 1e-9)) {
      const double unit = dof.prismatic ? 1e-3 : std::numbers::pi / 180;
      beyond.push_back(joint);
      words.push_back(joint + " (" + text::brief(angle / unit) + (dof.prismatic ? " mm" : " deg") +
                      ", limits " + text::brief(dof.lower / unit) + " to " +
                      text::brief(dof.upper / unit) + ")");
    }
  }
  context.print(options.out + ": posture '" + options.as + "': " + angles_text(&model, angles) +
                "\n" +
                (beyond.empty() ? ""
                                : "  the angles of these joints are beyond their limits: " +
                                      text::join(words, ", ") + "\n"));
  context.print_json(Json{
      {"output", options.out},
      {"posture", options.as},
      {"joints_rad", angles_json(model, angles, false)},
      {"beyond_range",
       beyond}}.dump(2));
}

// ---- the kinds of the command

void list(const Context& context, const PostureCommand& options) {
  const PostureSource source = source_of(context, options);
  std::optional<RobotModel> model;
  try {  // a library may name no robot, or one that is not here
    model = robot_of_source(context, options, source.robot);
  } catch (const Error&) {
    if (!options.robot.empty()) throw;
  }
  // The names are known to be different. To search for each of them among the others would take
  // quadratic time.
  Json::object_t json;
  std::string out;
  for (const auto& [name, angles] : source.postures) {
    out += name + "\n  " + angles_text(model ? &*model : nullptr, angles) + "\n";
    json.emplace_back(name, angles);
  }
  context.print(out.empty() ? options.source + ": no postures\n" : "Angles in deg\n" + out);
  context.print_json(Json{{"postures_rad", std::move(json)}}.dump(2));
}

void draw(const Context& context, const PostureCommand& options) {
  if (fs::path(options.out).extension() != ".png")
    fail(ErrorCode::usage,
         "-o " + options.out + ": the picture needs a file name that ends in .png");
  refuse_overwriting(context, options.out);
  const PostureSource source = source_of(context, options);
  const Angles& angles = posture_of(source, options);
  const RobotModel model = robot_of_source(context, options, source.robot);
  const Eigen::VectorXd theta = theta_of(model, angles, {options.source, options.name});
  const RobotPicture picture = draw_robot(model, options.view, false, &theta);
  write_png(options.out, picture.image);
  context.print(options.out + "\n");
  for (const std::string& note : picture.notes) context.print("  - " + note + "\n");
  context.print_json(Json{{"output", options.out}}.dump(2));
}

void mirror(const Context& context, const PostureCommand& options) {
  const PostureSource source = source_of(context, options);
  const Angles& angles = posture_of(source, options);
  const RobotModel model = robot_of_source(context, options, source.robot);
  const MirrorMap map = mirror_map(model);
  Angles image;
  for (const auto& [joint, angle] : angles) {
    const auto dof = static_cast<size_t>(dof_of(model, joint, {options.source}));
    image[model.dofs()[static_cast<size_t>(map.dof[dof])].name] = map.sign[dof] * angle;
  }
  save(context, options, model, source.robot, image);
}

void adjust(const Context& context, const PostureCommand& options) {
  const PostureSource source = source_of(context, options);
  Angles angles = posture_of(source, options);
  const RobotModel model = robot_of_source(context, options, source.robot);
  for (const auto& [joint, value] : read_pairs(options.joints, "--joint")) {
    const Dof& dof = model.dofs()[dof_of(model, joint, {"", "--joint"})];
    angles[joint] = dof.prismatic || options.radians ? value : value * std::numbers::pi / 180;
  }
  save(context, options, model, options.robot.empty() ? source.robot : options.robot, angles);
}

/// The joints of a motion at one instant.
struct Instant {
  std::string robot;
  std::vector<std::string> joints;
  Eigen::VectorXd theta;
};

size_t row_at(const PostureCommand& options, double dt, size_t rows) {
  const double end = dt * static_cast<double>(rows - 1);
  if (!(options.at >= 0 && options.at <= end + dt / 2))
    fail(ErrorCode::usage, "--at " + text::brief(options.at) + ": " + options.source +
                               " lasts from 0 to " + text::fixed(end, 3) +
                               " s. Give a time within this range");
  return std::min(rows - 1, static_cast<size_t>(std::lround(options.at / dt)));
}

Instant instant_of(const Context& context, const PostureCommand& options) {
  if (is_run_folder(options.source) || fs::path(options.source).extension() == ".bin") {
    const SimulationLog log = read_run_log(options.source, options.log);
    const size_t row = row_at(options, log.dt, log.samples.size());
    return {log.provenance.robot, log.joints, log.samples[row].state.theta};
  }
  if (!options.log.empty())
    fail(ErrorCode::usage,
         "--log: " + options.source + " is not a run, so it has no logs. Leave --log out");
  std::error_code ignored;
  const bool is_table = fs::path(options.source).extension() == ".csv" ||
                        (fs::is_regular_file(options.source, ignored) &&
                         format_of(read_file(options.source)) == "ayumi.reference/1");
  if (is_table) {
    const ReferenceTrajectory table = read_reference(options.source);
    const size_t row = row_at(options, table.dt, table.rows.size());
    return {table.provenance.robot, table.joints, table.rows[row].theta};
  }
  PatternOptions input;
  input.robot = options.robot;
  const Task task = load_pattern(context, options.source, input);
  const size_t row = row_at(options, task.series.dt, task.series.samples.size());
  return {task.robot_name, task.robot.dof_names(), task.series.samples[row].state.theta};
}

// A joint that a run keeps nearer to 0 than this is captured as 0 [rad, m]. Chosen: a joint that is
// driven to 0 ends within 3e-6, and one count of HOAP-1's encoders is 8e-5.
constexpr double kAtRest = 1e-5;

void capture(const Context& context, const PostureCommand& options) {
  const Instant instant = instant_of(context, options);
  const RobotModel model = robot_of_run(context, options.robot, instant.robot);
  Angles angles;
  for (size_t i = 0; i < instant.joints.size(); ++i) {
    dof_of(model, instant.joints[i], {options.source});
    const double angle = instant.theta[static_cast<Eigen::Index>(i)];
    angles[instant.joints[i]] = std::abs(angle) < kAtRest ? 0 : angle;
  }
  save(context, options, model, options.robot.empty() ? instant.robot : options.robot, angles);
}

// ---- options

using Options = std::shared_ptr<PostureCommand>;

Command& add_kind(Command& parent, const std::string& name, const std::string& what,
                  const Options& options, const char* source = "ROBOT|PATTERN|LIBRARY",
                  const char* source_words = "Robot, pattern or library that has the posture.") {
  Command* command = parent.add_subcommand(name, what);
  command->add_option("SOURCE", options->source, source_words)->required()->type_name(source);
  command
      ->add_option("--robot", options->robot,
                   "Robot to use in place of the robot that SOURCE names.")
      ->type_name("ROBOT");
  return *command;
}

void add_name(Command& command, const Options& options) {
  command.add_option("POSTURE", options->name, "Name of the posture.")->required();
}

void add_library(Command& command, const Options& options,
                 const char* radians = "Use radians in place of degrees in a new library.") {
  command.add_option("--as", options->as, "Name of the new posture.")
      ->required()
      ->type_name("NAME");
  command
      .add_option("-o,--out", options->out,
                  "Posture library to write. If the file exists, the posture is added to the file.")
      ->required()
      ->type_name("F");
  command.add_flag("--rad", options->radians, radians);
}

}  // namespace

void add_posture(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "posture",
      "list, draw, mirror, adjust and capture named postures, and keep them in a library");
  command->require_subcommand(1);
  command->footer(
      "Examples:\n  ayumi posture list hoap1\n"
      "  ayumi posture capture out/walk --at 2.5 --as mid_step -o mine.json\n"
      "  ayumi posture mirror mine.json mid_step --as other_step -o mine.json\n"
      "  ayumi posture adjust hoap1 home --joint l_elbow=-60 --as ready -o mine.json\n"
      "  ayumi posture draw mine.json ready -o ready.png\n"
      "A pattern uses the library with \"include\": \"mine.json\".");
  const auto options = std::make_shared<PostureCommand>();
  add_kind(*command, "list", "print the postures with their angles", options,
           "ROBOT|PATTERN|LIBRARY", "Robot, pattern or library whose postures are printed.")
      .callback([options, &context] { list(context, *options); });
  Command& drawn = add_kind(*command, "draw", "draw the robot in a posture", options);
  add_name(drawn, options);
  drawn.add_option("-o,--out", options->out, "Picture to write (.png).")
      ->required()
      ->type_name("F");
  drawn.add_option("--view", options->view, "View: " + text::join(view_names(), ", ") + ".")
      ->check(one_of(view_names()).description(""))
      ->capture_default_str();
  drawn.callback([options, &context] { draw(context, *options); });
  Command& mirrored = add_kind(*command, "mirror", "exchange left and right", options);
  add_name(mirrored, options);
  add_library(mirrored, options);
  mirrored.callback([options, &context] { mirror(context, *options); });
  Command& adjusted = add_kind(*command, "adjust", "change single joints", options);
  add_name(adjusted, options);
  adjusted
      .add_option("--joint", options->joints,
                  "Angle of a joint [deg], or place of a sliding joint [m]. May be repeated.")
      ->required()
      ->type_name("JOINT=ANGLE")
      ->allow_extra_args(false);
  add_library(adjusted, options,
              "Use radians in place of degrees for --joint and in a new library.");
  adjusted.callback([options, &context] { adjust(context, *options); });
  Command& captured =
      add_kind(*command, "capture", "take the posture of a motion at one time", options,
               "RUN|TABLE|PATTERN", "Run, table or pattern with the motion.");
  captured.add_option("--at", options->at, "Time [s].")->required()->type_name("S");
  captured.add_option("--log", options->log, "Log of the run (default: closed_loop).")
      ->type_name("NAME");
  add_library(captured, options);
  captured.callback([options, &context] { capture(context, *options); });
}

}  // namespace ayumi::app
