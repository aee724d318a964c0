#pragma once
// Long work as seen from Python: the interpreter's lock is free while the library works, Ctrl-C
// stops the work, and a callback receives the progress. Exceptions of a callback, and
// KeyboardInterrupt, are kept until the library has stopped in its own way, and are raised then.

#include <pybind11/pybind11.h>

#include <exception>
#include <memory>

#include "ayumi/base/progress.hpp"

namespace ayumi::python {

namespace py = pybind11;

class Watch {
 public:
  /// `callback` is None or a function callback(stage, fraction, detail). The work stops if it
  /// returns False.
  explicit Watch(py::object callback) : callback_(std::move(callback)) {}

  /// Calls work(progress) without holding the interpreter's lock.
  template <typename Work>
  auto run(const Work& work) {
    try {
      auto result = [&] {
        const py::gil_scoped_release release;
        return work(Progress([this](const ProgressEvent& event) { return goes_on(event); }));
      }();
      if (raised_) std::rethrow_exception(raised_);
      return result;
    } catch (const Interrupted&) {
      if (raised_) std::rethrow_exception(raised_);
      throw;
    }
  }

 private:
  /// May be called by any thread of the library. Signals are seen by Python's main thread.
  bool goes_on(const ProgressEvent& event) {
    const py::gil_scoped_acquire acquire;
    if (raised_) return false;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (callback_.is_none()) return true;
      const py::object answer = callback_(event.stage, event.fraction, event.detail);
      return !answer.is(py::bool_(false));
    } catch (const py::error_already_set&) {
      raised_ = std::current_exception();
      return false;
    }
  }

  py::object callback_;
  std::exception_ptr raised_;
};

}  // namespace ayumi::python
