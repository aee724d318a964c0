#include "ayumi/io/run/log_table.hpp"

#include <cmath>
#include <cstring>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/zmp.hpp"
#include "ayumi/io/run/log_robot.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

namespace {

using Eigen::Vector3d;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The unit of a joint vector, which is listed for revolute joints; a prismatic joint has another
// unit.
std::string unit_of(const std::string& revolute) {
  if (revolute == "rad") return "m";
  if (revolute == "rad/s") return "m/s";
  return revolute == "N m" ? "N" : revolute;
}

std::vector<LogQuantity> quantities_of(const RobotModel& model, const SimulationLog& log) {
  std::vector<LogQuantity> list = {{"t", {}, {"s"}}};
  for (LogQuantity& quantity : log_quantities(log.joints)) {
    if (quantity.parts == log.joints)
      for (size_t j = 0; j < log.joints.size(); ++j)
        if (model.dofs()[j].prismatic) quantity.units[j] = unit_of(quantity.units[j]);
    list.push_back(std::move(quantity));
  }
  for (const char* name : {"dcm", "cmd.dcm", "ref.dcm"})
    list.push_back({name, {"x", "y"}, {"m", "m"}});
  list.push_back({"zmp.margin", {}, {"m"}});
  for (const char* name : {"left.contact", "right.contact", "support", "planned_support", "phase"})
    list.push_back({name, {}, {"1"}});
  LogQuantity disturbance = {"disturbance"};
  for (size_t i = 0; i < log.scenario.size(); ++i) {
    disturbance.parts.push_back(std::to_string(i + 1) + "_" + name_of(log.scenario[i]));
    disturbance.units.emplace_back("1");
  }
  if (!log.scenario.empty()) list.push_back(std::move(disturbance));
  return list;
}

// The rate is the central difference, and at both ends of the log the difference on the one side.
Vector3d rate_at(const SimulationLog& log, Vector3d SimulationSample::*quantity, size_t k) {
  const size_t last = log.samples.size() - 1;
  const size_t before = k == 0 ? 0 : k - 1, after = std::min(k + 1, last);
  if (before == after) return Vector3d::Zero();
  return (log.samples[after].*quantity - log.samples[before].*quantity) /
         (static_cast<double>(after - before) * log.dt);
}

class DerivedValues {
 public:
  DerivedValues(const RobotModel& model, const SimulationLog& log)
      : model_(model), log_(log), data_(model) {}

  void append(size_t k, std::vector<double>& values) {
    const SimulationSample& s = log_.samples[k];
    append_dcm(s.cog, s.dcog, s.zmp, values);
    append_dcm(s.command_cog, rate_at(log_, &SimulationSample::command_cog, k), s.command_zmp,
               values);
    append_dcm(s.reference_cog, rate_at(log_, &SimulationSample::reference_cog, k), s.reference_zmp,
               values);
    values.push_back(zmp_margin(s));
    const std::array<bool, 2> pressed = {s.foot_force[0].z() > 0, s.foot_force[1].z() > 0};
    values.push_back(pressed[0] ? 1 : 0);
    values.push_back(pressed[1] ? 1 : 0);
    values.push_back(support_of(pressed));
    values.push_back(support_of(s.planned_contact));
    if (k > 0 && s.planned_contact != log_.samples[k - 1].planned_contact) ++phase_;
    values.push_back(phase_);
    for (const Disturbance& disturbance : log_.scenario)
      values.push_back(acts(disturbance, static_cast<long>(k)) ? 1 : 0);
  }

 private:
  static void append_dcm(const Vector3d& cog, const Vector3d& rate, const Vector3d& zmp,
                         std::vector<double>& values) {
    const double height = cog.z() - zmp.z();
    const Vector3d dcm = height > 0 ? divergent_component(cog, rate, std::sqrt(kGravity / height))
                                    : Vector3d::Constant(kNone);
    values.insert(values.end(), {dcm.x(), dcm.y()});
  }
  double zmp_margin(const SimulationSample& s) {
    if (!model_.has_soles()) return kNone;
    update_positions(model_, s.state, data_);
    std::vector<Eigen::Vector2d> corners;
    for (const Side side : {Side::left, Side::right}) {
      if (!s.planned_contact[static_cast<size_t>(side)]) continue;
      const Eigen::Isometry3d pose = sole_pose(model_, data_, side);
      for (const Eigen::Vector2d& corner : model_.sole(side).polygon)
        corners.push_back((pose * Vector3d(corner.x(), corner.y(), 0)).head<2>());
    }
    const ConvexPolygon support(std::move(corners));
    return support.empty() ? kNone : support.margin(s.zmp.head<2>());
  }
  static double support_of(const std::array<bool, 2>& feet) {
    return (feet[0] ? 1 : 0) + (feet[1] ? 2 : 0);
  }
  // Samples are counted as sim/schedule counts them, with a tick as the step of the integrator.
  bool acts(const Disturbance& disturbance, long k) const {
    const long first = std::lround(disturbance.at / log_.dt);
    return k >= first && k < first + std::max(1l, std::lround(disturbance.duration / log_.dt));
  }

  const RobotModel& model_;
  const SimulationLog& log_;
  RobotData data_;
  int phase_ = 0;
};

}  // namespace

std::vector<std::string> LogTable::column_names() const {
  std::vector<std::string> names;
  for (const LogQuantity& quantity : quantities)
    for (size_t i = 0; i < quantity.columns(); ++i) names.push_back(quantity.column(i));
  return names;
}

LogTable log_table(const RobotModel& model, const SimulationLog& log, const std::string& file) {
  if (log.samples.empty()) fail(ErrorCode::bad_file, {file}, "the log has no samples");
  require_robot_of(model, log, file);
  LogTable table;
  table.quantities = quantities_of(model, log);
  for (const LogQuantity& quantity : table.quantities) table.columns += quantity.columns();
  table.rows = log.samples.size();
  table.values.reserve(table.rows * table.columns);
  DerivedValues derived(model, log);
  std::string bytes;
  for (size_t k = 0; k < table.rows; ++k) {
    table.values.push_back(static_cast<double>(k) * log.dt);
    bytes.clear();
    append_values(log.samples[k], log.joints.size(), bytes);
    const size_t begin = table.values.size();
    table.values.resize(begin + bytes.size() / sizeof(double));
    std::memcpy(&table.values[begin], bytes.data(), bytes.size());
    derived.append(k, table.values);
  }
  require(table.values.size() == table.rows * table.columns,
          "a column of the log table is missing");
  return table;
}

}  // namespace ayumi
