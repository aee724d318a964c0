#include "new_pattern.hpp"

#include <nlohmann/json.hpp>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern_file.hpp"
#include "ayumi/pattern/sample.hpp"

namespace ayumi::app {

void write_new_pattern(const Context& context, const RobotModel& model, Pattern pattern,
                       const std::string& robot, const std::string& out,
                       const std::vector<std::string>& comments) {
  refuse_overwriting(context, out);
  pattern.robot = robot_as_written(robot);
  pattern.name = std::filesystem::path(out).stem().string();
  pattern.file = out;
  const CommandSeries series = sample(model, pattern, {}, context.progress());
  pattern.file = "new";  // relative names hold from the working folder
  write_pattern(out, pattern, comments);
  context.print(out + ": " + text::fixed(series.duration(), 2) + " s, " +
                std::to_string(pattern.phases.size()) + " phases, " +
                std::to_string(pattern.keyframes.size()) + " keyframes\n  COG " +
                series.origin.at("cog") + "\n");
  context.print_json(nlohmann::ordered_json{{"pattern", out},
                                            {"duration_s", series.duration()},
                                            {"phases", pattern.phases.size()},
                                            {"keyframes", pattern.keyframes.size()}}
                         .dump(2));
}

}  // namespace ayumi::app
