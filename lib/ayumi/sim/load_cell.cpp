#include "ayumi/sim/load_cell.hpp"

#include <algorithm>
#include <numeric>

namespace ayumi {

LoadCell::LoadCell(const CellResponse& response, int readings)
    : response_(response), readings_(static_cast<size_t>(std::max(readings, 1))) {}

double LoadCell::felt(double force) {
  const double x = std::max(force - response_.dead_zone, 0.0);
  const double play = 0.5 * response_.hysteresis;
  played_ = std::clamp(played_, x - play, x + play);
  return response_.gain * played_;
}

double LoadCell::reported(double value) {
  if (response_.saturation > 0) value = std::min(value, response_.saturation);
  newest_ = filled_ ? (newest_ + 1) % readings_.size() : 0;
  readings_[newest_] = value;
  filled_ = std::min(filled_ + 1, readings_.size());
  // The sum is computed anew, so that rounding errors do not add up over a run.
  const auto end = readings_.begin() + static_cast<std::ptrdiff_t>(filled_);
  return std::accumulate(readings_.begin(), end, 0.0) / static_cast<double>(filled_);
}

std::vector<LoadCell> load_cells(const RobotModel& model, Side side) {
  const SensorDescription& sensors = model.description().sensors;
  if (sensors.force_cells.empty() && sensors.force_readings == 1) return {};
  std::vector<LoadCell> cells;
  const auto stated = sensors.force_cells.find(name_of(side));
  const size_t corners = model.sole(side).polygon.size();
  for (size_t i = 0; i < corners; ++i) {
    CellResponse response;
    if (stated != sensors.force_cells.end())
      response = stated->second.size() == 1 ? stated->second[0] : stated->second[i];
    cells.emplace_back(response, sensors.force_readings);
  }
  return cells;
}

}  // namespace ayumi
