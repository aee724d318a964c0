// Tasks (one pattern for one robot), their check and their repair.

#include "ayumi/base/error.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/task_file.hpp"
#include "ayumi/repair/task/repair_task.hpp"
#include "bindings.hpp"

namespace ayumi::python {

PyTask::PyTask(Task made) : task(std::make_shared<const Task>(std::move(made))) {
  series = std::make_shared<Series>(std::shared_ptr<const CommandSeries>(task, &task->series),
                                    task->robot.dof_names(), prismatic_of(task->robot));
}

namespace {

using PatternOrPath = std::variant<Pattern, Path>;

std::shared_ptr<PyTask> load(const PatternOrPath& pattern, const TaskOptions& options,
                             py::object callback) {
  return Watch(std::move(callback)).run([&](const Progress& progress) {
    Pattern read = std::holds_alternative<Path>(pattern)
                       ? read_pattern(std::get<Path>(pattern), options.set)
                       : std::get<Pattern>(pattern);
    return std::make_shared<PyTask>(load_task(std::move(read), options, progress));
  });
}

void bind_check(py::module_& m) {
  py::class_<Finding>(m, "Finding", "One thing that the check says about a motion.")
      .def_property_readonly(
          "kind", [](const Finding& f) { return std::string(name_of(f.kind)); },
          "Kind: 'support_margin', 'joint_torque', ...")
      .def_property_readonly(
          "severity", [](const Finding& f) { return std::string(name_of(f.severity)); },
          "'error', 'warning' or 'info'.")
      .def_readonly("begin", &Finding::begin, "Beginning of the window [s].")
      .def_readonly("end", &Finding::end, "End of the window [s].")
      .def_readonly("at", &Finding::at, "Time of the worst sample [s].")
      .def_readonly("worst", &Finding::worst, "Value at this time, in `unit`.")
      .def_readonly("limit", &Finding::limit, "The limit, in `unit`.")
      .def_readonly("unit", &Finding::unit, "Unit of `worst` and `limit`.")
      .def_readonly("where", &Finding::where, "Joint, foot, axis, support or bodies.")
      .def_readonly("hint", &Finding::hint, "What to do about the finding.")
      .def("__repr__", [](const Finding& f) {
        return std::string("<") + name_of(f.severity) + " " + name_of(f.kind) + " at " +
               std::to_string(f.at) + " s, " + f.where + ">";
      });

  py::class_<Judgement>(m, "Verdict", "Whether a pattern is physically consistent, and why not.")
      .def_property_readonly("consistent", &Judgement::good,
                             "Whether the motion and the goals satisfy every limit.")
      .def("__bool__", &Judgement::good)
      .def_property_readonly(
          "reason", &Judgement::reason,
          "Why the pattern is inconsistent, in one line; '' when it is consistent.")
      .def_property_readonly(
          "findings", [](const Judgement& j) { return j.report.findings; },
          "The findings, errors first.")
      .def_property_readonly(
          "summary",
          [](const Judgement& j) {
            std::map<std::string, double> summary;
            for (size_t i = 0; i < finding_kind_names().size(); ++i)
              summary[finding_kind_names()[i]] = j.report.summary[static_cast<FindingKind>(i)];
            return summary;
          },
          "The worst value of every kind of finding, in the unit of the kind.")
      .def_property_readonly(
          "profile", [](const Judgement& j) { return j.report.profile; },
          "Actuator profile that the motion was judged by.")
      .def_property_readonly(
          "need", [](const Judgement& j) { return j.need().text; },
          "What the actuators lack, in words; '' where they suffice.")
      .def(
          "to_dict", [](const Judgement& j) { return from_json(check_json(j.report)); },
          "The content of `ayumi check --json` as a dict.");

  m.def(
      "check",
      [](const PyTask& task, const std::map<std::string, double>& tolerances) {
        CheckOptions options = check_options(*task.task);
        for (const auto& [kind, value] : tolerances) options.tolerances[kind] = value;
        const py::gil_scoped_release release;
        return judge(*task.task, options);
      },
      py::arg("task"), py::kw_only(), py::arg("tolerances") = std::map<std::string, double>(),
      "The verdict on a pattern. `tolerances`: values by kind of finding, in place of those of the "
      "pattern.");
}

Trust trust_of(const std::string& name) {
  for (const Trust trust : {Trust::posture, Trust::cog, Trust::zmp})
    if (name == name_of(trust)) return trust;
  fail(ErrorCode::usage, "trust '" + name + "' is not one of posture, cog and zmp");
}

/// A repair, and the task that results from applying it to the pattern.
struct PyRepair {
  RepairResult result;
  std::shared_ptr<PyTask> task;
};

void bind_repair(py::module_& m) {
  py::class_<PyRepair, std::shared_ptr<PyRepair>>(m, "Repair", "What a repair found.")
      .def_property_readonly(
          "status", [](const PyRepair& r) { return std::string(name_of(r.result.status)); },
          "'already_consistent', 'repaired', 'infeasible' or 'not_converged'.")
      .def_property_readonly(
          "ok",
          [](const PyRepair& r) {
            return r.result.status == RepairStatus::repaired ||
                   r.result.status == RepairStatus::already_consistent;
          },
          "Whether the motion of `task` is consistent.")
      .def_readonly("task", &PyRepair::task,
                    "The task with the correction in its pattern; without a correction if the "
                    "repair found none.")
      .def_property_readonly(
          "max_joint_change", [](const PyRepair& r) { return r.result.max_joint_change; },
          "Largest change of a joint [rad].")
      .def_property_readonly(
          "max_cog_change", [](const PyRepair& r) { return r.result.max_cog_change; },
          "Largest change of the COG [m].")
      .def_property_readonly(
          "where", [](const PyRepair& r) { return r.result.where; },
          "The joint whose angle the repair changes most.")
      .def_property_readonly(
          "at", [](const PyRepair& r) { return r.result.at; },
          "The time at which the repair changes this joint most [s].")
      .def_property_readonly(
          "iterations", [](const PyRepair& r) { return r.result.iterations; },
          "Iterations of the solver.")
      .def_property_readonly(
          "reasons", [](const PyRepair& r) { return r.result.reasons; },
          "Why there is no repair, in words.")
      .def(
          "to_dict", [](const PyRepair& r) { return from_json(repair_json(r.result)); },
          "The content of `ayumi repair --json` as a dict.");

  m.def(
      "repair",
      [](const PyTask& given, const std::vector<std::string>& lock_joints,
         const std::vector<std::string>& lock_feet,
         const std::vector<std::pair<double, double>>& lock_windows,
         const std::map<std::string, double>& weights, const std::optional<std::string>& trust,
         std::optional<double> safety, std::optional<double> zmp_margin,
         std::optional<int> max_iterations, py::object progress) {
        const Task& task = *given.task;
        RepairOptions options = preferred_options(task.pattern);
        options.check = check_options(task);
        options.locked_joints.insert(options.locked_joints.end(), lock_joints.begin(),
                                     lock_joints.end());
        for (const std::string& foot : lock_feet)
          options.locked_feet[static_cast<size_t>(side_of(foot))] = true;
        options.locked_windows.insert(options.locked_windows.end(), lock_windows.begin(),
                                      lock_windows.end());
        for (const auto& [joint, factor] : weights) options.joint_weights[joint] = factor;
        if (trust) options.trust = trust_of(*trust);
        options.safety = safety.value_or(options.safety);
        if (zmp_margin) options.zmp_margin = zmp_margin;
        options.max_iterations = max_iterations.value_or(options.max_iterations);
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          auto made = std::make_shared<PyRepair>();
          made->result = repair_task(task, options, watched);
          Task repaired = task;
          if (made->result.status == RepairStatus::repaired) {
            repaired.pattern.correction = made->result.correction;
            repaired.series = made->result.series;
          }
          made->task = std::make_shared<PyTask>(std::move(repaired));
          return made;
        });
      },
      py::arg("task"), py::kw_only(), py::arg("lock_joints") = std::vector<std::string>(),
      py::arg("lock_feet") = std::vector<std::string>(),
      py::arg("lock_windows") = std::vector<std::pair<double, double>>(),
      py::arg("weights") = std::map<std::string, double>(), py::arg("trust") = py::none(),
      py::arg("safety") = py::none(), py::arg("zmp_margin") = py::none(),
      py::arg("max_iterations") = py::none(), py::arg("progress") = py::none(),
      "The nearest consistent motion, which bears the payloads of the scenario. Locked joints, "
      "feet ('left', 'right') and windows (begin, "
      "end) [s] do not move. `weights` are factors on the cost of a change of a joint. `trust` is "
      "'posture', "
      "'cog' or 'zmp'. `zmp_margin` [m] is the wanted distance of the ZMP from the edge of the "
      "support. An argument that is not given has the value in the pattern.");
}

}  // namespace

void bind_task(py::module_& m) {
  py::class_<Series, std::shared_ptr<Series>> series(
      m, "Series",
      "The command at the servo period of the robot: posture, COG, ZMP, vertical force and sole "
      "poses of every sample. series['theta'] is an array, series.units('theta') has its units.");
  bind_samples<CommandSeries>(series);
  series.def_property_readonly(
      "origin", [](const Series& s) { return s.data().origin; }, "Source of each track, in words.");
  series.def_property_readonly(
      "support",
      [](const Series& s) {
        std::vector<std::string> names;
        for (const CommandSample& sample : s.data().samples)
          names.emplace_back(name_of(sample.support));
        return names;
      },
      "Planned support of every sample: 'both', 'left', 'right' or 'none'.");

  py::class_<PyTask, std::shared_ptr<PyTask>>(
      m, "Task", "One pattern for one robot, sampled at the servo period of the robot.")
      .def_property_readonly(
          "pattern", [](const PyTask& t) { return t.task->pattern; }, "The pattern.")
      .def_property_readonly(
          "robot", [](const PyTask& t) -> const RobotModel& { return t.task->robot; },
          py::return_value_policy::reference_internal, "The robot.")
      .def_property_readonly(
          "profile", [](const PyTask& t) { return t.task->profile; },
          "Name of the actuator profile.")
      .def_readonly("series", &PyTask::series, "The command, sample by sample.");

  m.def(
      "load_task",
      [](const PatternOrPath& pattern, const std::map<std::string, double>& set,
         const std::string& profile, const std::string& robot, const std::vector<Path>& path,
         bool meshes, py::object progress) {
        return load(pattern,
                    {.set = set,
                     .profile = profile,
                     .robot = robot,
                     .robots = robot_search(path),
                     .meshes = meshes},
                    std::move(progress));
      },
      py::arg("pattern"), py::kw_only(), py::arg("set") = std::map<std::string, double>(),
      py::arg("profile") = "", py::arg("robot") = "", py::arg("path") = std::vector<Path>(),
      py::arg("meshes") = true, py::arg("progress") = py::none(),
      "Reads a pattern (a file, or a Pattern) and its robot, and samples the motion. `set` gives "
      "values to parameters that a file declares. `robot` is the name or path of a robot that "
      "replaces the robot of the pattern. `path` lists folders with robots. With `meshes`, the "
      "meshes are read too; only pictures need them.");
  m.def(
      "sample",
      [](const Pattern& pattern, const RobotModel& robot, const std::string& profile,
         py::object progress) {
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          Task task = make_task(pattern, robot, profile, watched);
          task.robot_name = pattern.robot;
          return std::make_shared<PyTask>(std::move(task));
        });
      },
      py::arg("pattern"), py::arg("robot"), py::kw_only(), py::arg("profile") = "",
      py::arg("progress") = py::none(), "Samples a pattern for a robot that was loaded.");
  bind_check(m);
  bind_repair(m);
}

}  // namespace ayumi::python
