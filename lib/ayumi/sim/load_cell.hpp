#pragma once
// A load cell between a sole and the ground, with the errors that the sidecar states for it: dead
// zone, hysteresis, gain, saturation, and the mean of its last readings. docs/theory_plant.md,
// "Load cells".

#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi {

class LoadCell {
 public:
  /// `readings` is the number of readings whose mean is reported, at least 1.
  LoadCell(const CellResponse& response, int readings);

  /// The part of the force that the cell senses in this reading, times the gain [N]:
  ///   x = max(f - dead zone, 0),
  ///   y = the value between x - hysteresis/2 and x + hysteresis/2 that is nearest to y',
  /// where y' is the y of the previous reading, or 0 at first. So y is x - hysteresis/2 while the
  /// force rises by more than the hysteresis, and x + hysteresis/2 while it falls.
  double felt(double force);

  /// Takes the value [N] of this reading, after noise and rounding. Returns the mean of the last
  /// readings, or of all readings if there are fewer. Each reading is at most the saturation.
  double reported(double value);

 private:
  CellResponse response_;
  double played_ = 0;             // the value y of the last reading
  std::vector<double> readings_;  // the last readings; the newest is at newest_
  size_t newest_ = 0, filled_ = 0;
};

/// The cells at the corners of a sole; empty if the sidecar states no errors of load cells.
std::vector<LoadCell> load_cells(const RobotModel& model, Side side);

}  // namespace ayumi
