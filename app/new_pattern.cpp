#include "new_pattern.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi::app {

namespace {

/// If the pattern names no profile and the robot's first one is too weak, the first profile that is
/// strong enough becomes that of the pattern. Returns whether the check finds the pattern
/// consistent. What is found is printed; a choice of a profile only if the pattern will be written.
bool choose_profile(const Context& context, Task& task, bool written_anyway) {
  Judgement judged = judge(task);
  const ActuatorNeed need = judged.need();
  const bool chooses = task.pattern.profile.empty() && !need.sufficient.empty();
  if (chooses) {
    task.profile = task.pattern.profile = need.sufficient.front();
    judged = judge(task);
    if (judged.good() || written_anyway)
      context.print("the pattern names the profile " + task.profile + ", because " + need.text +
                    "\n");
  }
  if (judged.good()) {
    if (!chooses && !need.text.empty()) context.print(need.text + "\n");
    return true;
  }
  const std::vector<Finding>& findings = judged.report.findings;
  const auto error = std::find_if(findings.begin(), findings.end(),
                                  [](const Finding& f) { return f.severity == Severity::error; });
  // A goal of VIIP that is too strong for the actuators is not a finding of the motion.
  const std::string lacks = judged.need().text;
  context.print("the check finds the new pattern inconsistent: " +
                (error != findings.end() ? finding_with_hint(*error) : lacks) + "\n");
  if (error != findings.end() && !lacks.empty()) context.print(lacks + "\n");
  return false;
}

}  // namespace

void add_new_file(Command& command, NewFile& file) {
  command
      .add_option("--robot", file.robot,
                  "Name of a bundled robot, or a folder, sidecar or robot file (URDF, MJCF, SDF, "
                  "Choreonoid body, mi-lib ztk).")
      ->type_name("ROBOT")
      ->capture_default_str();
  command.add_option("-o,--out", file.out, "Pattern file to write.")->type_name("F")->required();
  command.add_flag("--allow-inconsistent", file.allow_inconsistent,
                   "Write the pattern even if the check finds errors, for example to repair it.");
}

bool write_new_pattern(Context& context, const RobotModel& model, Pattern pattern,
                       const NewFile& file, const std::vector<std::string>& comments) {
  const std::string& out = file.out;
  refuse_overwriting(context, out);
  pattern.robot = robot_as_written(file.robot);
  pattern.name = std::filesystem::path(out).stem().string();
  pattern.file.clear();  // places in messages are not yet those of a file
  Task task = [&] {
    try {
      return make_task(std::move(pattern), model, "", context.progress());
    } catch (const Error& error) {
      fail(error.code(),
           std::string("nothing is written, because the robot cannot do this motion. Other "
                       "values of options, such as --cog-height, may help. First error: ") +
               error.what());
    }
  }();
  const CommandSeries& series = task.series;
  const bool consistent =
      !model.has_soles() || choose_profile(context, task, file.allow_inconsistent);
  if (!consistent && !file.allow_inconsistent) {
    context.print(
        "nothing is written. With --allow-inconsistent, the pattern is written nevertheless, for "
        "example for `ayumi repair`\n");
    context.print_json("{\"pattern\": null}");
    context.exit_code = 1;
    return false;
  }
  Pattern& written = task.pattern;
  written.file = "new";  // names are relative to the working folder
  write_pattern(out, written, comments);
  context.print(out + ": " + text::fixed(series.duration(), 2) + " s, " +
                text::counted(written.phases.size(), "phase") + ", " +
                text::counted(written.keyframes.size(), "keyframe") + "\n  COG " +
                series.origin.at("cog") + "\n");
  // Legs that lack joints can only partly follow the motion; this line says what they cannot do.
  if (series.origin.contains("legs")) context.print("  " + series.origin.at("legs") + "\n");
  context.print_json(nlohmann::ordered_json{{"pattern", out},
                                            {"duration_s", series.duration()},
                                            {"phases", written.phases.size()},
                                            {"keyframes", written.keyframes.size()}}
                         .dump(2));
  return consistent;
}

}  // namespace ayumi::app
