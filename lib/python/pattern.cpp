// Patterns: reading, writing, generating and editing them.

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

using Maybe = std::optional<double>;

/// A generated pattern for the robot that the user named.
Pattern for_robot(const RobotModel& robot, Pattern pattern) {
  if (pattern.robot.empty()) pattern.robot = robot.name();
  return pattern;
}

void set(double& parameter, const Maybe& given) { parameter = given.value_or(parameter); }
void set(int& parameter, const std::optional<int>& given) { parameter = given.value_or(parameter); }

void bind_generators(py::module_& m) {
  m.def(
      "walk_pattern",
      [](const RobotModel& robot, std::optional<int> steps, const Maybe& stride,
         const Maybe& period, const Maybe& double_support, const Maybe& lift,
         const Maybe& cog_height, const Maybe& turn, const Maybe& side, const Maybe& rise) {
        WalkParameters walk = rise ? stair_defaults(robot, *rise) : walk_defaults(robot);
        set(walk.steps, steps);
        set(walk.stride, stride);
        set(walk.period, period);
        set(walk.double_support, double_support);
        set(walk.lift, lift);
        set(walk.cog_height, cog_height);
        set(walk.turn, turn);
        set(walk.side, side);
        return for_robot(robot, walk_pattern(robot, walk));
      },
      py::arg("robot"), py::kw_only(), py::arg("steps") = py::none(),
      py::arg("stride") = py::none(), py::arg("period") = py::none(),
      py::arg("double_support") = py::none(), py::arg("lift") = py::none(),
      py::arg("cog_height") = py::none(), py::arg("turn") = py::none(),
      py::arg("side") = py::none(), py::arg("rise") = py::none(),
      "A walk from rest to rest. stride, lift, cog_height, side and rise (of a stair) are in m, "
      "and period is in s. double_support is a share of the period. turn is in rad per step; left "
      "is positive. Arguments that are not given follow from the size of the robot.");
  m.def(
      "stand_pattern",
      [](const RobotModel& robot, double duration) {
        return for_robot(robot, stand_pattern(robot, duration));
      },
      py::arg("robot"), py::arg("duration"), "Standing in the home posture for `duration` s.");
  m.def(
      "sway_pattern",
      [](const RobotModel& robot, const Maybe& side, const Maybe& forward, const Maybe& period,
         std::optional<int> cycles) {
        SwayParameters sway = sway_defaults(robot);
        set(sway.side, side);
        set(sway.forward, forward);
        set(sway.period, period);
        set(sway.cycles, cycles);
        return for_robot(robot, sway_pattern(robot, sway));
      },
      py::arg("robot"), py::kw_only(), py::arg("side") = py::none(),
      py::arg("forward") = py::none(), py::arg("period") = py::none(),
      py::arg("cycles") = py::none(),
      "The COG moves to and fro over both feet by `side` and `forward` m, one cycle in `period` "
      "s.");
  m.def(
      "squat_pattern",
      [](const RobotModel& robot, const Maybe& depth, const Maybe& period, const Maybe& hold,
         std::optional<int> cycles) {
        SquatParameters squat = squat_defaults(robot);
        set(squat.depth, depth);
        set(squat.period, period);
        set(squat.hold, hold);
        set(squat.cycles, cycles);
        return for_robot(robot, squat_pattern(robot, squat));
      },
      py::arg("robot"), py::kw_only(), py::arg("depth") = py::none(),
      py::arg("period") = py::none(), py::arg("hold") = py::none(), py::arg("cycles") = py::none(),
      "The COG moves down by `depth` m and up again; `hold` s at the lowest point.");
  m.def(
      "jump_pattern",
      [](const RobotModel& robot, const Maybe& height, const Maybe& stoop, const Maybe& cog_height,
         const Maybe& forward, std::optional<int> times) {
        JumpParameters jump = jump_defaults(robot);
        set(jump.height, height);
        set(jump.stoop, stoop);
        set(jump.cog_height, cog_height);
        set(jump.forward, forward);
        set(jump.times, times);
        return for_robot(robot, jump_pattern(robot, jump));
      },
      py::arg("robot"), py::kw_only(), py::arg("height") = py::none(),
      py::arg("stoop") = py::none(), py::arg("cog_height") = py::none(),
      py::arg("forward") = py::none(), py::arg("times") = py::none(),
      "Stoop, lift-off, flight, touchdown and settling; all lengths in m.");
  m.def("mirrored", &mirrored, py::arg("robot"), py::arg("pattern"),
        "The pattern with left and right exchanged.");
  m.def("retimed", &retimed, py::arg("robot"), py::arg("pattern"), py::arg("scale"),
        "The pattern with all times multiplied by `scale`.");
}

}  // namespace

void bind_pattern(py::module_& m) {
  py::class_<Pattern>(m, "Pattern",
                      "A motion pattern as its author writes it: keyframes, phases, controller and "
                      "scenario. docs/formats.md describes its file.")
      .def_readwrite("name", &Pattern::name, "Name of the motion.")
      .def_readwrite("robot", &Pattern::robot, "Name or path of the robot.")
      .def_readwrite("profile", &Pattern::profile,
                     "Actuator profile; '' is the default of the robot.")
      .def_readonly("file", &Pattern::file,
                    "File from which the pattern was read; '' if there is none.")
      .def_readonly("parameters", &Pattern::parameters, "Declared parameters with their values.")
      .def_property_readonly("duration", &Pattern::duration, "End of the last phase or key [s].")
      .def_property_readonly(
          "repaired", [](const Pattern& p) { return p.correction.has_value(); },
          "Whether the pattern has the correction of a repair.")
      .def(
          "text", [](const Pattern& p) { return pattern_text(p); },
          "The text of a pattern file, which is JSON.")
      .def(
          "to_dict", [](const Pattern& p) { return from_json(pattern_text(p)); },
          "The keys of the pattern file; parse_pattern(json.dumps(...)) reads them back.")
      .def(
          "write", [](const Pattern& p, const Path& path) { write_pattern(path, p); },
          py::arg("path"), "Writes the pattern file, whole or not at all.");
  m.def("read_pattern", &read_pattern, py::arg("path"),
        py::arg("set") = std::map<std::string, double>(),
        "Reads a pattern file. `set` gives values to parameters that the pattern declares.");
  m.def(
      "parse_pattern",
      [](const std::string& text, const Path& path, const std::map<std::string, double>& set) {
        return pattern_of_text(text, path, set);
      },
      py::arg("text"), py::arg("path") = "pattern.json",
      py::arg("set") = std::map<std::string, double>(),
      "Reads a pattern from the text of a file. Messages call this file `path`, and files that "
      "the text names are looked for beside `path`.");
  bind_generators(m);
}

}  // namespace ayumi::python
