#pragma once
// Where the next foot lands and how long until then, by a quadratic program in every tick: the
// step of DCM tracking that chooses step place and durations, one of the baselines of DTAD. After
// Khadiv and others, "Step timing adjustment: a step toward generating robust gaits" (2016), with
// the ZMP inside the sole as a further unknown. docs/theory_baselines.md.

#include <Eigen/Core>

#include "ayumi/math/polygon.hpp"

namespace ayumi {

/// Costs of the squares of what the program chooses; lengths are times the COG height.
struct StepWeights {
  double place = 1;      ///< of a move of the foothold
  double time = 0.1;     ///< of the relative change of exp(omega T)
  double offset = 10;    ///< of what is left of the DCM's error at the landing
  double zmp = 0.05;     ///< of what a ZMP off its plan takes away until then
  double slowest = 0.8;  ///< least rate of the clock, at most 1
};

/// What is known in a tick. Axes of the stance foot; lengths in units of the COG height. T is the
/// planned time until the landing.
struct StepProblem {
  Eigen::Vector2d error;      ///< of the DCM from its plan
  Eigen::Vector2d dcm;        ///< planned at the landing, from the ZMP of the single support
  double growth = 1;          ///< exp(omega T)
  double share = 1;           ///< of a foothold's shift that the DCM makes by the landing
  Eigen::Vector2d low, high;  ///< move of the foothold
  double least_growth = 1, most_growth = 1;  ///< exp(omega time until the landing); around growth
  std::array<Eigen::Vector2d, 16> normal;    ///< outward ones of the support's edges
  std::array<double, 16> distance;  ///< of the edges from the ZMP planned in the single support
  int edges = 0;
};

/// Puts the edges of a polygon about the planned ZMP [m] into the problem.
void set_support(StepProblem& problem, const ConvexPolygon& about_zmp, double yaw, double height,
                 double share);

struct StepChoice {
  Eigen::Vector2d move = Eigen::Vector2d::Zero();    ///< of the foothold
  double growth = 1;                                 ///< exp(omega time until the landing)
  Eigen::Vector2d taken = Eigen::Vector2d::Zero();   ///< by the ZMP, of the DCM at the landing
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< left of the DCM's error at the landing
};

/// Least cost with
///   (error + dcm / G) g - dcm = share move + taken + offset,  G: planned growth,
/// low <= move <= high, least_growth <= g <= most_growth, taken within (g - 1) times the support.
StepChoice choose_step(const StepProblem& problem, const StepWeights& weights);

}  // namespace ayumi
