#pragma once
// Chooses where the next foot lands and how long it takes until then, by a quadratic program in
// every tick. This is one of the baselines of DTAD. After Khadiv and others, "Step timing
// adjustment: a step toward generating robust gaits" (2016), with the ZMP inside the sole as a
// further unknown. docs/theory_baselines.md, "Steps chosen by a program".

#include <Eigen/Core>

#include "ayumi/math/polygon.hpp"

namespace ayumi {

/// Costs of the squares of the unknowns; lengths are multiples of the COG height.
struct StepWeights {
  double place = 1;      ///< cost of moving the foothold
  double time = 0.1;     ///< cost of the relative change of exp(omega T)
  double offset = 10;    ///< cost of the DCM's remaining error at the landing
  double zmp = 0.05;     ///< cost of the error that a ZMP off its plan removes until the landing
  double slowest = 0.8;  ///< smallest rate of the clock, at most 1
};

/// The known quantities of a tick in the axes of the stance foot; lengths are in units of the COG
/// height. T is the planned time until the landing.
struct StepProblem {
  Eigen::Vector2d error;      ///< deviation of the DCM from its plan
  Eigen::Vector2d dcm;        ///< planned DCM at the landing, from the ZMP of the single support
  double growth = 1;          ///< exp(omega T)
  double share = 1;           ///< share of a foothold's shift that the DCM makes by the landing
  Eigen::Vector2d low, high;  ///< bounds of the movement of the foothold
  /// Bounds of exp(omega time until the landing); they enclose growth.
  double least_growth = 1, most_growth = 1;
  std::array<Eigen::Vector2d, 16> normal;  ///< outward normals of the support's edges
  /// Distances of the edges from the ZMP planned in the single support.
  std::array<double, 16> distance;
  int edges = 0;
};

/// Writes the edges of a polygon relative to the planned ZMP [m] into the problem. `yaw` is the
/// heading of the stance foot [rad], `height` the height of the COG [m], and `share` the share of
/// the polygon that may be used.
void set_support(StepProblem& problem, const ConvexPolygon& about_zmp, double yaw, double height,
                 double share);

struct StepChoice {
  Eigen::Vector2d move = Eigen::Vector2d::Zero();  ///< movement of the foothold
  double growth = 1;                               ///< exp(omega time until the landing)
  /// Part of the DCM's error at the landing that the ZMP removes.
  Eigen::Vector2d taken = Eigen::Vector2d::Zero();
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< remaining error of the DCM at the landing
};

/// Least cost with
///   (error + dcm / G) g - dcm = share move + taken + offset,  G: planned growth,
/// low <= move <= high, least_growth <= g <= most_growth, taken within (g - 1) times the support.
StepChoice choose_step(const StepProblem& problem, const StepWeights& weights);

}  // namespace ayumi
