#pragma once
// The samples of a log, of a command series or of a joint table as numpy arrays with names and
// units. Numbers and vectors of three are read in the samples themselves: the array is a view whose
// stride is the size of a sample. A joint vector has memory of its own in every sample, so that the
// first access copies all of them into one matrix, and every array is a view of this matrix. The
// Python object is the base of all its arrays and keeps their memory.

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Dense>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ayumi/motion/command_series.hpp"
#include "ayumi/motion/table_caution.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::python {

namespace py = pybind11;

/// An array of one quantity of the samples.
struct NamedArray {
  /// Names of the columns, such as "x" or a joint; empty for a number.
  std::vector<std::string> parts;
  /// One unit for a number, otherwise one per column; "1" for a quantity without a unit.
  std::vector<std::string> units;
  std::function<py::array(const py::handle& owner)> view;
};

/// The arrays in the order of the samples' fields.
using NamedArrays = std::vector<std::pair<std::string, NamedArray>>;

/// A view of numbers that C++ owns, which cannot be written to. `owner` keeps them alive.
template <typename Scalar>
py::array view_of(const Scalar* first, std::vector<py::ssize_t> shape,
                  std::vector<py::ssize_t> strides, const py::handle& owner) {
  py::array array(py::dtype::of<Scalar>(), std::move(shape), std::move(strides), first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// The arrays of `samples`, which must outlive the arrays. `joints` are the columns of joint
/// vectors, and `prismatic` says which of them are lengths; if it is empty, none are.
NamedArrays arrays_of(const std::vector<SimulationSample>& samples,
                      const std::vector<std::string>& joints, const std::vector<bool>& prismatic);
NamedArrays arrays_of(const std::vector<CommandSample>& samples,
                      const std::vector<std::string>& joints, const std::vector<bool>& prismatic);
NamedArrays arrays_of(const std::vector<ReferenceRow>& rows, const std::vector<std::string>& joints,
                      const std::vector<bool>& prismatic);

/// A joint table, and what its head says about the run from which it comes.
struct CautiousTable : ReferenceTrajectory {
  TableCaution caution;
};

inline const std::vector<SimulationSample>& samples_of(const SimulationLog& log) {
  return log.samples;
}
inline const std::vector<CommandSample>& samples_of(const CommandSeries& series) {
  return series.samples;
}
inline const std::vector<ReferenceRow>& samples_of(const ReferenceTrajectory& table) {
  return table.rows;
}

/// A log, a series or a table with its arrays.
template <typename Data>
class Sampled {
 public:
  Sampled(std::shared_ptr<const Data> data, std::vector<std::string> joints,
          const std::vector<bool>& prismatic)
      : data_(std::move(data)),
        joints_(std::move(joints)),
        arrays_(arrays_of(samples_of(*data_), joints_, prismatic)) {}

  const Data& data() const { return *data_; }
  std::shared_ptr<const Data> shared() const { return data_; }
  const std::vector<std::string>& joints() const { return joints_; }
  size_t size() const { return samples_of(*data_).size(); }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, array] : arrays_) names.push_back(name);
    return names;
  }
  const NamedArray& array(const std::string& name) const {
    for (const auto& [known, array] : arrays_)
      if (known == name) return array;
    throw py::key_error(name);
  }

 private:
  std::shared_ptr<const Data> data_;
  std::vector<std::string> joints_;
  NamedArrays arrays_;
};

using Log = Sampled<SimulationLog>;
using Series = Sampled<CommandSeries>;
using Table = Sampled<CautiousTable>;

/// By dof, whether its positions are lengths.
inline std::vector<bool> prismatic_of(const RobotModel& model) {
  std::vector<bool> prismatic;
  for (const Dof& dof : model.dofs()) prismatic.push_back(dof.prismatic);
  return prismatic;
}

/// The members that all classes of samples have.
template <typename Data>
void bind_samples(py::class_<Sampled<Data>, std::shared_ptr<Sampled<Data>>>& type) {
  using S = Sampled<Data>;
  type.def("__len__", &S::size, "Number of samples.")
      .def(
          "__getitem__",
          [](const py::object& self, const std::string& name) {
            return self.cast<const S&>().array(name).view(self);
          },
          py::arg("name"),
          "The quantity of this name as a view that cannot be written: one row per sample, shape "
          "(n,) for a number, (n, 3) for a vector, (n, 4) for a unit quaternion x y z w, (n, dof) "
          "for joints, (n, 4, 4) for a pose.")
      .def_property_readonly("names", &S::names, "Names of the quantities, the keys of [].")
      .def(
          "parts", [](const S& s, const std::string& name) { return s.array(name).parts; },
          py::arg("name"), "Names of the columns of a quantity: 'x', or a joint.")
      .def(
          "units", [](const S& s, const std::string& name) { return s.array(name).units; },
          py::arg("name"), "Units of the columns of a quantity; '1' where there is none.")
      .def_property_readonly("joints", &S::joints, "Names of the joints, the columns of theta.")
      .def_property_readonly(
          "dt", [](const S& s) { return s.data().dt; }, "Time between two samples [s].")
      .def_property_readonly(
          "t",
          [](const S& s) {
            py::array_t<double> t(static_cast<py::ssize_t>(s.size()));
            for (size_t k = 0; k < s.size(); ++k)
              t.mutable_at(static_cast<py::ssize_t>(k)) = static_cast<double>(k) * s.data().dt;
            return t;
          },
          "Times of the samples [s], shape (n,), computed as k dt.");
}

}  // namespace ayumi::python
