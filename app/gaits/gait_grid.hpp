#pragma once
// The grid of a library of walks: values of four axes, a cell for each combination, and the
// neighbours of a cell.

#include <string>
#include <utility>
#include <vector>

namespace ayumi::app {

/// The command of a walk as a velocity: distances and angles of one step divided by its period.
struct GaitCell {
  std::string name;     ///< "f50_s-20_t10_p550": mm/s, mm/s, deg/s, ms
  double forward = 0;   ///< [m/s]
  double sideways = 0;  ///< left positive [m/s]
  double turn = 0;      ///< left positive [rad/s]
  double period = 0;    ///< of one step [s]
};

struct GaitGrid {
  std::vector<double> forward, sideways;  ///< [m/s]
  std::vector<double> turn;               ///< [deg/s]
  std::vector<double> period;             ///< [s]

  size_t size() const { return forward.size() * sideways.size() * turn.size() * period.size(); }
  /// Cells by period, then turning rate, then forward speed, then sideways speed.
  GaitCell cell(size_t index) const;
  std::vector<GaitCell> cells() const;
  /// Those with the least or the largest value of every axis.
  std::vector<GaitCell> corners() const;
  /// Pairs of cells that differ by one place on one axis, each pair in both orders.
  std::vector<std::pair<size_t, size_t>> neighbours() const;
};

/// "0.1,0.2" or "FROM:TO:COUNT", ascending. Throws Error(usage) that names the option.
std::vector<double> axis_values(const std::string& words, const std::string& option);

}  // namespace ayumi::app
