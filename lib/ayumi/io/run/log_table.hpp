#pragma once
// Everything that is known about a run as one table with a row for each tick: the columns of its
// log, and the quantities that follow from them.

#include <string>
#include <vector>

#include "ayumi/io/run/log_fields.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

struct LogTable {
  std::vector<LogQuantity> quantities;  ///< quantities in the order of the columns
  size_t columns = 0, rows = 0;
  std::vector<double> values;  ///< values, row after row; nan where a quantity has no value

  double at(size_t row, size_t column) const { return values[row * columns + column]; }
  std::vector<std::string> column_names() const;
};

/// The time, the columns of the log (those of prismatic joints in m, m/s and N), and:
///   dcm, cmd.dcm, ref.dcm  COG + COG rate / omega with omega^2 = g / (z_G - z_Z); the rates of
///                          command and reference are central differences; no value for
///                          z_G <= z_Z
///   zmp.margin             distance of the ZMP inside the hull of the soles that are planned on
///                          the ground, at their true places; no value without such a sole
///   left.contact, ...      whether the ground presses on the foot
///   support, planned_support
///                        feet on the ground, in the run and in the plan: 0 none, 1 left,
///                        2 right, 3 both
///   phase                  number of the planned support since the start, from 0
///   disturbance.<n>_<name> whether disturbance n of the scenario, from 1, acts
/// Throws Error(bad_file), beginning with `file`, for a log without samples or of another robot.
LogTable log_table(const RobotModel& model, const SimulationLog& log, const std::string& file);

}  // namespace ayumi
