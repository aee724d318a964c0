#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "commands.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

// A robot that cannot be read does not hide the others.
void list_robots(Context& context) {
  nlohmann::ordered_json robots = nlohmann::ordered_json::array(), failures = robots;
  for (const RobotEntry& entry : find_robots(robot_search(context))) {
    try {
      const RobotModel model = load_robot(entry.sidecar.string());
      context.print(padded(entry.name + " ", 16) + std::to_string(model.dof_count()) + " DOF  " +
                    text::fixed(model.mass(), 3) + " kg  profiles " +
                    text::join(model.profile_names(), ", ") + "\n");
      robots.push_back({{"robot", entry.name},
                        {"dof", model.dof_count()},
                        {"mass_kg", model.mass()},
                        {"profiles", model.profile_names()},
                        {"file", entry.sidecar.string()}});
    } catch (const Error& error) {
      complain("robot '" + entry.name + "' is left out: " + error.what());
      failures.push_back({{"robot", entry.name},
                          {"error", shortened(error.what(), kLongestMessage)},
                          {"file", entry.sidecar.string()}});
    }
  }
  // Names of files and folders need not be UTF-8.
  context.print_json(nlohmann::ordered_json{{"robots", robots}, {"failures", failures}}.dump(
      2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  context.exit_code = failures.empty() ? 0 : 3;
}

}  // namespace

void add_robots(Command& app, Context& context) {
  Command* command =
      app.add_subcommand("robots", "list the bundled robots and those of --robot-path");
  command->footer("Examples:\n  ayumi robots\n  ayumi robots --robot-path ~/my_robots --json");
  command->callback([&context] { list_robots(context); });
}

}  // namespace ayumi::app
