#pragma once
// Rows that a recording lost or repeated. If a file does not say when each row was measured, all
// rows after such a place seem to come too early or too late. Every moving joint shows this step at
// the same time. Let p be the command, delayed as the recording is. The differences e = theta - p
// of all joints j then step by n dt p'_j, where n is the number of lost rows. Least squares over
// the surrounding rows give n and its standard deviation. If nothing moves there, the delays before
// and after show the step, for each joint that moves on both sides: joints with different servos
// have different delays.

#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"

namespace ayumi {

/// The value of a table between its rows; before the first and after the last row, that row's value
/// is used [rad, m].
double angle_at(const AngleTable& table, Eigen::Index dof, double t);

struct LostRows {
  bool found = false;
  bool exact = false;    ///< the row is known, not only its neighbourhood
  Eigen::Index row = 0;  ///< the first row after the lost rows, counted from 0
  double rows = 0;       ///< number of lost rows; negative if rows are repeated
};

/// The place at which `measured`, which is `delay` [s] behind, lost or repeated rows most
/// evidently. `dofs` are joints that move in both tables.
LostRows lost_rows(const AngleTable& command, const AngleTable& measured,
                   const std::vector<Eigen::Index>& dofs, double delay);

/// A text such as "at data row 8001 (8.000 s, one row every 1 ms), 3 rows are missing: from here
/// on, ..."; empty if no row is lost.
std::string lost_rows_words(const LostRows& lost, const AngleTable& measured);

/// A complaint about the number of rows of `loads`, which were recorded with `measured`. It is
/// empty if the number is right or the rows have times of their own.
std::string loads_rows_complaint(const SensorTable& loads, const AngleTable& measured);

}  // namespace ayumi
