#include "ayumi/io/run/log_fields.hpp"

#include <map>
#include <type_traits>

#include "ayumi/base/error.hpp"

namespace ayumi {

namespace {

// Overloads by the type of a field; `joints` names the entries of joint vectors.
class ListQuantities {
 public:
  ListQuantities(const std::vector<std::string>& joints, std::vector<LogQuantity>& list)
      : joints_(joints), list_(list) {}
  void operator()(const std::string& name, const char* unit, const Eigen::Vector3d&) const {
    add(name, unit, {"x", "y", "z"});
  }
  void operator()(const std::string& name, const char* unit, const Eigen::VectorXd&) const {
    add(name, unit, joints_);
  }
  void operator()(const std::string& name, const char* unit, const BasePose&) const {
    list_.push_back(
        {name, {"x", "y", "z", "qw", "qx", "qy", "qz"}, {unit, unit, unit, "1", "1", "1", "1"}});
  }
  template <typename Scalar>
  std::enable_if_t<std::is_arithmetic_v<Scalar> || std::is_enum_v<Scalar>> operator()(
      const std::string& name, const char* unit, const Scalar&) const {
    list_.push_back({name, {}, {unit}});
  }

 private:
  void add(const std::string& name, const char* unit, const std::vector<std::string>& parts) const {
    list_.push_back({name, parts, std::vector<std::string>(parts.size(), unit)});
  }
  const std::vector<std::string>& joints_;
  std::vector<LogQuantity>& list_;
};

class AppendValues {
 public:
  AppendValues(size_t joints, std::string& bytes)
      : joints_(static_cast<Eigen::Index>(joints)), bytes_(bytes) {}
  void operator()(const std::string&, const char*, const Eigen::Vector3d& v) const {
    for (const double value : v) add(value);
  }
  void operator()(const std::string&, const char*, const Eigen::VectorXd& v) const {
    require(v.size() == joints_, "a joint vector of the log has the wrong size");
    for (const double value : v) add(value);
  }
  void operator()(const std::string&, const char*, const BasePose& base) const {
    for (const double value : base.position) add(value);
    const Eigen::Quaterniond& q = base.attitude;
    for (const double value : {q.w(), q.x(), q.y(), q.z()}) add(value);
  }
  template <typename Scalar>
  std::enable_if_t<std::is_arithmetic_v<Scalar> || std::is_enum_v<Scalar>> operator()(
      const std::string&, const char*, const Scalar& value) const {
    add(static_cast<double>(value));
  }

 private:
  void add(double value) const {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  Eigen::Index joints_;
  std::string& bytes_;
};

// The quantities from which one quantity nearly follows. A column has only those sources that have
// its part, and a source may be named with its part.
struct QuantitySources {
  const char* name;
  std::vector<const char*> sources;
};
const std::vector<QuantitySources>& quantity_sources() {
  static const std::vector<QuantitySources> list = {
      {"base", {"base.v"}},
      {"theta", {"dtheta"}},
      {"torque", {"target", "theta", "dtheta"}},
      {"ref.theta", {"ref.dtheta"}},
      {"cog", {"dcog"}},
      {"fz", {"left.force.z", "right.force.z"}},
      {"measured.zmp", {"zmp"}},
      {"measured.fz", {"fz"}},
      {"cmd.cog", {"cmd.dcog"}},
      {"ref.cog", {"ref.dcog"}},
      {"ref.dcog", {"ref.ddcog"}},
      {"ref.ddcog", {"law.motion", "law.short_term", "law.pull", "law.rocking"}},
      {"law.planned_zmp", {"cmd.zmp"}},
      {"law.wanted_zmp", {"ref.zmp"}},
  };
  return list;
}

}  // namespace

std::string LogQuantity::column(size_t index) const {
  const std::string& unit = units.at(index);
  return name + (parts.empty() ? "" : "." + parts.at(index)) +
         (unit == "1" ? "" : "[" + unit + "]");
}

std::vector<LogQuantity> log_quantities(const std::vector<std::string>& joints) {
  std::vector<LogQuantity> list;
  const SimulationSample sample;
  for_each_field(sample, ListQuantities(joints, list));
  return list;
}

std::vector<std::vector<size_t>> log_sources(const std::vector<std::string>& joints) {
  std::map<std::string, size_t> columns;  // columns by name and part
  std::vector<std::pair<std::string, std::string>> places;
  for (const LogQuantity& quantity : log_quantities(joints))
    for (size_t i = 0; i < quantity.columns(); ++i) {
      const std::string part = quantity.parts.empty() ? "" : "." + quantity.parts[i];
      columns.emplace(quantity.name + part, places.size());
      places.emplace_back(quantity.name, part);
    }
  std::vector<std::vector<size_t>> sources(places.size());
  for (const QuantitySources& of : quantity_sources())
    for (size_t c = 0; c < places.size(); ++c) {
      if (places[c].first != of.name) continue;
      for (const char* const source : of.sources) {
        auto found = columns.find(source + places[c].second);
        if (found == columns.end()) found = columns.find(source);
        if (found != columns.end()) sources[c].push_back(found->second);
      }
    }
  return sources;
}

void append_values(const SimulationSample& sample, size_t joints, std::string& bytes) {
  for_each_field(sample, AppendValues(joints, bytes));
}

}  // namespace ayumi
