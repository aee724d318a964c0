#pragma once
// Small convex quadratic programs, solved in every tick of a controller.

#include <Eigen/Core>

namespace ayumi {

/// Largest numbers of unknowns and inequalities of a program.
inline constexpr int kMostUnknowns = 8;       ///< Definition
inline constexpr int kMostInequalities = 40;  ///< Definition

/// Minimises 1/2 x'H x + f'x with A x <= b. H is symmetric and definite.
struct QuadraticProgram {
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns, 1>;
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns, kMostUnknowns>;
  using Rows =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostInequalities, kMostUnknowns>;
  using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostInequalities, 1>;
  Matrix H;
  Vector f;
  Rows A;
  Bounds b;
};

struct ProgramSolution {
  QuadraticProgram::Vector x;
  QuadraticProgram::Bounds multipliers;  ///< multipliers of the inequalities, all >= 0
  bool optimal = false;                  ///< false if x is only feasible
};

/// Solves the program by an active set that begins at `start`, which has to satisfy A x <= b.
/// Allocates nothing.
ProgramSolution solve_program(const QuadraticProgram& program,
                              const QuadraticProgram::Vector& start);

}  // namespace ayumi
