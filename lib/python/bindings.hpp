#pragma once
// The parts of the Python module, each in one file, and the types that they share.

#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/task/task.hpp"
#include "watch.hpp"

namespace ayumi::python {

using Path = std::filesystem::path;

/// A task with its series as arrays.
struct PyTask {
  std::shared_ptr<const Task> task;
  std::shared_ptr<Series> series;

  explicit PyTask(Task made);
};

/// The folders in which robots are looked for: first those of the caller, then the bundled ones.
RobotSearch robot_search(const std::vector<Path>& path);
/// The folder of bundled data.
Path data_folder(const std::string& name);

/// The Python object of a JSON text.
py::object from_json(const std::string& text);

/// The side of that name. Throws Error(usage) that lists the known words.
Side side_of(const std::string& name);

void bind_errors(py::module_& m);
void bind_robot(py::module_& m);
void bind_pattern(py::module_& m);
void bind_task(py::module_& m);
void bind_simulation(py::module_& m);
void bind_table(py::module_& m);
void bind_study(py::module_& m);
void bind_picture(py::module_& m);
void bind_recording(py::module_& m);

}  // namespace ayumi::python
