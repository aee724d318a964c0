// The Python module ayumi._native: the errors, the place of the bundled data, and the order of the
// parts.

#include "ayumi/base/error.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/bundled_data.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

const char* name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::usage:
      return "usage";
    case ErrorCode::bad_file:
      return "bad_file";
    case ErrorCode::bad_model:
      return "bad_model";
    case ErrorCode::bad_pattern:
      return "bad_pattern";
    case ErrorCode::solver:
      return "solver";
    case ErrorCode::internal:
      break;
  }
  return "internal";
}

Path folder_of_module;

}  // namespace

Path data_folder(const std::string& name) { return bundled_data(folder_of_module, name); }

RobotSearch robot_search(const std::vector<Path>& path) {
  RobotSearch search{path};
  search.folders.push_back(data_folder("robots"));
  return search;
}

py::object from_json(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

Side side_of(const std::string& name) {
  if (name == "left") return Side::left;
  if (name == "right") return Side::right;
  fail(ErrorCode::usage, "foot '" + name + "': the feet are left and right");
}

void bind_errors(py::module_& m) {
  // The types live as long as the process, which is longer than the interpreter's own clean-up.
  static const py::handle error = py::exception<Error>(m, "Error").release();
  static const py::handle interrupted = py::exception<Interrupted>(m, "Interrupted").release();
  error.attr("__doc__") =
      "What is wrong with a call, a file, a robot or a pattern. `code` is one of 'usage', "
      "'bad_file', 'bad_model', 'bad_pattern', 'solver' and 'internal'; `place` is the file and "
      "the place in this file, '' where there is none. An inconsistent pattern, a fall and a "
      "solver that did "
      "not converge are results, not errors.";
  error.attr("code") = "";
  error.attr("place") = "";
  interrupted.attr("__doc__") =
      "Long work was stopped because its progress callback returned False.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& e) {
      const py::object raised = error(e.what());
      raised.attr("code") = name_of(e.code());
      raised.attr("place") = text_of(e.place());
      PyErr_SetObject(error.ptr(), raised.ptr());
    } catch (const Interrupted&) {
      PyErr_SetString(interrupted.ptr(), "the progress callback stopped the work");
    }
  });
}

PYBIND11_MODULE(_native, m) {
  m.doc() = "Offline motion-pattern authoring and stabilization for humanoid robots.";
  m.attr("__name__") = "ayumi";  // the package shows everything under its own name
  py::options options;
  options.disable_enum_members_docstring();
  m.attr("__version__") = version();
  m.def(
      "_set_module_file", [](const Path& file) { folder_of_module = file; },
      "Where the module is installed, from which the bundled data are found.");
  m.def("data_folder", &data_folder, py::arg("name"),
        "Folder of the bundled data: 'robots', 'patterns' or 'examples'.");
  bind_errors(m);
  bind_robot(m);
  bind_pattern(m);
  bind_task(m);
  bind_simulation(m);
  bind_table(m);
  bind_study(m);
  bind_picture(m);
  bind_recording(m);
}

}  // namespace ayumi::python
