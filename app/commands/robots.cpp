#include <nlohmann/json.hpp>

#include "ayumi/base/text.hpp"
#include "commands.hpp"

namespace ayumi::app {

namespace {

void list_robots(const Context& context) {
  nlohmann::ordered_json robots = nlohmann::ordered_json::array();
  for (const RobotEntry& entry : find_robots(robot_search(context))) {
    const RobotModel model = load_robot(entry.sidecar.string());
    std::string line = entry.name;
    line.resize(std::max<size_t>(line.size() + 1, 16), ' ');
    context.print(line + std::to_string(model.dof_count()) + " DOF  " +
                  text::fixed(model.mass(), 3) + " kg  profiles " +
                  text::join(model.profile_names(), ", ") + "\n");
    robots.push_back({{"robot", entry.name},
                      {"dof", model.dof_count()},
                      {"mass_kg", model.mass()},
                      {"profiles", model.profile_names()},
                      {"file", entry.sidecar.string()}});
  }
  context.print_json(nlohmann::ordered_json{{"robots", robots}}.dump(2));
}

}  // namespace

void add_robots(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("robots", "list the bundled robots and those of --robot-path");
  command->footer("Examples:\n  ayumi robots\n  ayumi robots --robot-path ~/my_robots --json");
  command->callback([&context] { list_robots(context); });
}

}  // namespace ayumi::app
