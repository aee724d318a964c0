#include "arrays.hpp"

#include <type_traits>

#include "ayumi/io/run/log_fields.hpp"

namespace ayumi::python {

namespace {

using Eigen::VectorXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

const std::vector<std::string> kAxes = {"x", "y", "z"};
constexpr auto kDouble = static_cast<py::ssize_t>(sizeof(double));

std::string unit_of_length(const std::string& revolute) {
  if (revolute == "rad") return "m";
  if (revolute == "rad/s") return "m/s";
  if (revolute == "rad/s^2") return "m/s^2";
  return revolute == "N m" ? "N" : revolute;
}

/// Collects the arrays of samples from the fields of the first sample.
template <typename Sample>
class Collector {
 public:
  Collector(const std::vector<Sample>& samples, const std::vector<std::string>& joints,
            const std::vector<bool>& prismatic)
      : samples_(samples), joints_(joints), prismatic_(prismatic) {}

  void operator()(const std::string& name, const char* unit, const double& x) {
    add(name, {}, {unit}, numbers(&x));
  }
  void operator()(const std::string& name, const char* unit, const int& x) {
    add(name, {}, {unit}, numbers(&x));
  }
  void operator()(const std::string& name, const char* unit, const LawStage& stage) {
    static_assert(std::is_same_v<std::underlying_type_t<LawStage>, int>);
    (*this)(name, unit, reinterpret_cast<const int&>(stage));
  }
  void operator()(const std::string& name, const char* unit, const bool& x) {
    add(name, {}, {unit}, numbers(&x));
  }
  void operator()(const std::string& name, const char* unit, const Eigen::Vector3d& v) {
    add(name, kAxes, std::vector<std::string>(3, unit), rows(v.data(), {3}, {kDouble}));
  }
  void operator()(const std::string& name, const char* unit, const BasePose& pose) {
    (*this)(name + ".position", unit, pose.position);
    add(name + ".attitude", {"x", "y", "z", "w"}, std::vector<std::string>(4, "1"),
        rows(pose.attitude.coeffs().data(), {4}, {kDouble}));
  }
  void operator()(const std::string& name, const char* /*unit*/, const Eigen::Isometry3d& pose) {
    add(name, {}, {"m"}, rows(pose.matrix().data(), {4, 4}, {kDouble, 4 * kDouble}));
  }
  void operator()(const std::string& name, const char* unit, const VectorXd& v) {
    std::vector<std::string> parts, units;
    if (v.size() == static_cast<Eigen::Index>(joints_.size()) + 6) {
      parts = {"base.x", "base.y", "base.z", "base.rx", "base.ry", "base.rz"};
      units = {"m/s^2", "m/s^2", "m/s^2", "rad/s^2", "rad/s^2", "rad/s^2"};
    }
    for (size_t j = 0; j < joints_.size(); ++j) {
      parts.push_back(joints_[j]);
      units.push_back(!prismatic_.empty() && prismatic_[j] ? unit_of_length(unit) : unit);
    }
    add(name, parts, units, gathered(v));
  }

  NamedArrays take() { return std::move(arrays_); }

 private:
  void add(const std::string& name, std::vector<std::string> parts, std::vector<std::string> units,
           std::function<py::array(const py::handle&)> view) {
    arrays_.emplace_back(name, NamedArray{std::move(parts), std::move(units), std::move(view)});
  }
  py::ssize_t count() const { return static_cast<py::ssize_t>(samples_.size()); }

  template <typename Scalar>
  std::function<py::array(const py::handle&)> numbers(const Scalar* first) const {
    return rows(first, {}, {});
  }

  template <typename Scalar>
  std::function<py::array(const py::handle&)> rows(const Scalar* first,
                                                   std::vector<py::ssize_t> shape,
                                                   std::vector<py::ssize_t> strides) const {
    shape.insert(shape.begin(), count());
    strides.insert(strides.begin(), sizeof(Sample));
    return [=](const py::handle& owner) { return view_of(first, shape, strides, owner); };
  }

  /// The vectors of a joint lie apart from each other, each in its sample.
  std::function<py::array(const py::handle&)> gathered(const VectorXd& first) const {
    const auto offset =
        reinterpret_cast<const char*>(&first) - reinterpret_cast<const char*>(samples_.data());
    const std::vector<Sample>* samples = &samples_;
    const auto matrix = std::make_shared<RowMatrix>();
    return [=](const py::handle& owner) {
      if (matrix->size() == 0 && !samples->empty()) {
        const auto field = [&](size_t k) -> const VectorXd& {
          return *reinterpret_cast<const VectorXd*>(
              reinterpret_cast<const char*>(samples->data() + k) + offset);
        };
        matrix->resize(static_cast<Eigen::Index>(samples->size()), field(0).size());
        for (size_t k = 0; k < samples->size(); ++k)
          matrix->row(static_cast<Eigen::Index>(k)) = field(k).transpose();
      }
      return view_of(matrix->data(), {matrix->rows(), matrix->cols()},
                     {matrix->cols() * kDouble, kDouble}, owner);
    };
  }

  const std::vector<Sample>& samples_;
  const std::vector<std::string>& joints_;
  const std::vector<bool>& prismatic_;
  NamedArrays arrays_;
};

/// Visits the fields of a command, with the names that they have in a log.
template <typename Visit>
void for_each_field(const CommandSample& s, const Visit& visit) {
  visit("base", "m", s.state.base);
  visit("base.v", "m/s", s.state.base_velocity);
  visit("base.w", "rad/s", s.state.base_angular_velocity);
  visit("theta", "rad", s.state.theta);
  visit("dtheta", "rad/s", s.state.dtheta);
  visit("acceleration", "rad/s^2", s.acceleration);
  visit("cog", "m", s.cog);
  visit("dcog", "m/s", s.dcog);
  visit("ddcog", "m/s^2", s.ddcog);
  visit("zmp", "m", s.zmp);
  visit("fz", "N", s.fz);
  visit("left.sole", "m", s.feet[0]);
  visit("right.sole", "m", s.feet[1]);
}

template <typename Visit>
void for_each_field(const ReferenceRow& row, const Visit& visit) {
  visit("theta", "rad", row.theta);
  visit("base", "m", row.base);
  visit("cog", "m", row.cog);
  visit("zmp", "m", row.zmp);
  visit("fz", "N", row.fz);
  visit("left.contact", "1", row.contact[0]);
  visit("right.contact", "1", row.contact[1]);
}

template <typename Sample>
NamedArrays collected(const std::vector<Sample>& samples, const std::vector<std::string>& joints,
                      const std::vector<bool>& prismatic) {
  if (samples.empty()) return {};
  Collector<Sample> collector(samples, joints, prismatic);
  const auto visit = [&](const std::string& name, const char* unit, const auto& field) {
    collector(name, unit, field);
  };
  using ayumi::for_each_field;
  using python::for_each_field;
  for_each_field(samples.front(), visit);
  return collector.take();
}

}  // namespace

NamedArrays arrays_of(const std::vector<SimulationSample>& samples,
                      const std::vector<std::string>& joints, const std::vector<bool>& prismatic) {
  return collected(samples, joints, prismatic);
}

NamedArrays arrays_of(const std::vector<CommandSample>& samples,
                      const std::vector<std::string>& joints, const std::vector<bool>& prismatic) {
  return collected(samples, joints, prismatic);
}

NamedArrays arrays_of(const std::vector<ReferenceRow>& rows, const std::vector<std::string>& joints,
                      const std::vector<bool>& prismatic) {
  return collected(rows, joints, prismatic);
}

}  // namespace ayumi::python
