// Joint tables, which a robot replays.

#include "ayumi/io/table/table.hpp"

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/task/servo_table.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

std::shared_ptr<Table> as_table(ReferenceTrajectory table, TableCaution caution,
                                const std::vector<bool>& prismatic) {
  auto data =
      std::make_shared<const CautiousTable>(CautiousTable{std::move(table), std::move(caution)});
  return std::make_shared<Table>(data, data->joints, prismatic);
}

Eigen::MatrixXd torques_of(const SimulationLog& log) {
  Eigen::MatrixXd torque(static_cast<Eigen::Index>(log.samples.size()),
                         static_cast<Eigen::Index>(log.joints.size()));
  for (Eigen::Index k = 0; k < torque.rows(); ++k)
    torque.row(k) = log.samples[static_cast<size_t>(k)].torque.transpose();
  return torque;
}

/// A table with ramp and hold, and the verdict on whether it is safe.
struct PySafeTable {
  std::shared_ptr<Table> table;
  SafetyReport report;
};

}  // namespace

void bind_table(py::module_& m) {
  py::class_<Table, std::shared_ptr<Table>> table(
      m, "Table", "Servo targets row by row, with the quantities that they were computed from.");
  bind_samples<CautiousTable>(table);
  table
      .def(
          "csv", [](const Table& t) { return reference_csv(t.data(), t.data().caution); },
          "The text of a CSV file, with a head that states the origin of the table.")
      .def(
          "json", [](const Table& t) { return reference_json(t.data(), t.data().caution); },
          "The table as JSON text.")
      .def(
          "hoap", [](const Table& t, const RobotModel& robot) { return hoap_csv(robot, t.data()); },
          py::arg("robot"), "The text of a HOAP sequence: encoder counts of every motor.")
      .def(
          "write",
          [](const Table& t, const Path& path) {
            write_file(path, path.extension() == ".json"
                                 ? reference_json(t.data(), t.data().caution)
                                 : reference_csv(t.data(), t.data().caution));
          },
          py::call_guard<py::gil_scoped_release>(), py::arg("path"),
          "Writes the table as CSV, or as JSON if the name ends in .json. The file is written "
          "whole or not at all.")
      .def(
          "resampled",
          [](const Table& t, double dt) {
            return as_table(resampled(t.data(), dt), t.data().caution, {});
          },
          py::call_guard<py::gil_scoped_release>(), py::arg("dt"),
          "The table at another rate, interpolated linearly between its rows; `dt` in s.")
      .def_property_readonly(
          "unfit", [](const Table& t) { return t.data().caution.unfit; },
          "Why no robot should receive the table; '' if there is no known reason.")
      .def_property_readonly(
          "disturbances", [](const Table& t) { return t.data().caution.disturbances; },
          "The disturbances of the run that the table is from; '' where there were none.");

  py::class_<PySafeTable>(m, "SafeTable", "A table with ramp and hold, judged for a robot.")
      .def_readonly("table", &PySafeTable::table, "The table with ramp, motion and hold.")
      .def_property_readonly(
          "safe", [](const PySafeTable& s) { return s.report.safe; },
          "Whether the robot may receive the table.")
      .def_property_readonly(
          "violations",
          [](const PySafeTable& s) {
            std::vector<std::string> texts;
            for (const SafetyViolation& v : s.report.violations) texts.push_back(text_of(v));
            return texts;
          },
          "Why the robot may not receive the table, in words.")
      .def(
          "to_dict", [](const PySafeTable& s) { return from_json(safety_json(s.report)); },
          "All figures of the verdict.");

  m.def(
      "read_table",
      [](const Path& path) { return as_table(read_reference(path), read_table_caution(path), {}); },
      py::call_guard<py::gil_scoped_release>(), py::arg("path"),
      "Reads a table that Ayumi wrote, CSV or JSON.");
  m.def(
      "table",
      [](const PyTask& task, const std::shared_ptr<Log>& log, const std::string& content) {
        const Task& t = *task.task;
        const py::gil_scoped_release release;
        const ServoContent servo = servo_content(content);
        const std::vector<bool> prismatic = prismatic_of(t.robot);
        TableCaution caution;
        if (log) {
          caution = {words_of(log->data().scenario),
                     text::join(unfit_reasons(judge(t), log->data()), "; ")};
          add_caution(caution, t.caution);
          return as_table(table_of_log(t.robot, t.profile, log->data(), servo), caution, prismatic);
        }
        caution.unfit = text::join(export_refusals(t, judge(t)), "; ");
        ReferenceTrajectory made = table_of_series(t.robot, t.profile, t.series, servo);
        made.provenance = provenance(t, "none");
        return as_table(std::move(made), caution, prismatic);
      },
      py::arg("task"), py::arg("log") = py::none(), py::kw_only(), py::arg("content") = "lead",
      "The table of a run, or of the pattern itself if no log is given. `content`: 'ideal' (the "
      "posture), 'lead' (ahead of the posture by the lag of the servos) or 'lead+sag'.");
  m.def(
      "make_safe",
      [](const PyTask& task, const Table& given, const std::shared_ptr<Log>& log, double ramp,
         double hold, const std::string& start) {
        const Task& t = *task.task;
        const py::gil_scoped_release release;
        SafetyOptions options = safety_options(t);
        options.ramp = ramp;
        options.hold = hold;
        options.from = start;
        SafeTable safe =
            log ? make_safe_run(t.robot, given.data(), torques_of(log->data()), options)
                : make_safe(t.robot, given.data(), options);
        return PySafeTable{
            as_table(std::move(safe.table), given.data().caution, prismatic_of(t.robot)),
            safe.report};
      },
      py::arg("task"), py::arg("table"), py::arg("log") = py::none(), py::kw_only(),
      py::arg("ramp") = SafetyOptions().ramp, py::arg("hold") = SafetyOptions().hold,
      py::arg("start") = SafetyOptions().from,
      "Adds an approach of `ramp` s from the posture `start` before a table and a hold of `hold` s "
      "after it, and judges what the servos would receive. With a log, it also judges the torques "
      "of that "
      "run.");
}

}  // namespace ayumi::python
