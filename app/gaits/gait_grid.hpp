#pragma once
// The grid of a library of walks: values of four axes, a cell for each combination, and the
// neighbours of a cell.

#include <string>
#include <utility>
#include <vector>

namespace ayumi::app {

/// The command of a walk as a velocity: distances and angles of one step divided by its period.
struct GaitCell {
  std::string name;     ///< name, such as "f50_s-20_t10_p550": in mm/s, mm/s, deg/s, ms
  double forward = 0;   ///< forward speed [m/s]
  double sideways = 0;  ///< sideways speed, left positive [m/s]
  double turn = 0;      ///< turning rate, left positive [rad/s]
  double period = 0;    ///< duration of one step [s]
};

struct GaitGrid {
  std::vector<double> forward, sideways;  ///< [m/s]
  std::vector<double> turn;               ///< [deg/s]
  std::vector<double> period;             ///< [s]

  size_t size() const { return forward.size() * sideways.size() * turn.size() * period.size(); }
  /// The cells are sorted by period, then by turning rate, then by forward speed, then by sideways
  /// speed.
  GaitCell cell(size_t index) const;
  std::vector<GaitCell> cells() const;
  /// The cells with the smallest or the largest value of every axis.
  std::vector<GaitCell> corners() const;
  /// Pairs of cells that differ by one place on one axis. Each pair occurs in both orders.
  std::vector<std::pair<size_t, size_t>> neighbours() const;
};

/// Reads "0.1,0.2" or "FROM:TO:COUNT" with rising values. Throws Error(usage) that names the
/// option.
std::vector<double> axis_values(const std::string& words, const std::string& option);

}  // namespace ayumi::app
