#pragma once
// Rows that a recording lost or repeated. In a file that does not say when each row was measured,
// all that follows such a row comes earlier or later than before. Every moving joint shows this at
// once: with p the command that is delayed as the recording is, the differences e = theta - p of
// all joints j step by n dt p'_j, where n is the number of lost rows. Least squares over the rows
// around give n and its standard deviation. Where nothing moves, the delays before and after show
// it, for each joint that moves on both sides: joints with different servos have different delays.

#include <string>
#include <vector>

#include "ayumi/identify/recorded_motion.hpp"

namespace ayumi {

/// Value of a table between its rows; the first and last row continue [rad, m].
double angle_at(const AngleTable& table, Eigen::Index dof, double t);

struct LostRows {
  bool found = false;
  bool exact = false;    ///< the row is known, not only its neighbourhood
  Eigen::Index row = 0;  ///< the first row after them, from 0
  double rows = 0;       ///< how many; negative where rows are repeated
};

/// The place at which `measured`, which is `delay` [s] behind, lost or repeated rows most
/// evidently. `dofs` move in both tables.
LostRows lost_rows(const AngleTable& command, const AngleTable& measured,
                   const std::vector<Eigen::Index>& dofs, double delay);

/// "at data row 8001 (8.000 s, one row every 1 ms), 3 rows are missing: from here on, ..."; empty
/// where no row is lost.
std::string lost_rows_words(const LostRows& lost, const AngleTable& measured);

/// What is wrong with the number of rows of `loads`, which were recorded with `measured`; empty:
/// nothing, or rows with times of their own.
std::string loads_rows_complaint(const SensorTable& loads, const AngleTable& measured);

}  // namespace ayumi
