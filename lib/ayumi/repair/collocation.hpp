#pragma once
// The unknowns of the program are the free control points of the correction's spline. The
// collocation points are the samples at which the rows of the program are evaluated.

#include <vector>

#include "ayumi/limits/row_site.hpp"
#include "ayumi/repair/correction_spec.hpp"

namespace ayumi {

/// The free control points of a uniform cubic B-spline over base position, base rotation vector and
/// joints. Its first and last three control points stay zero, so that the motion starts and ends as
/// before. If the posture at one end is at fault, the three points at this end move together.
struct CorrectionVariables {
  CorrectionTrack zero;   ///< the track with zero coefficients
  Eigen::MatrixXi index;  ///< variable of control point (row) and column, or -1
  int count = 0;

  Eigen::MatrixXd coefficients(
      const Eigen::VectorXd& x) const;  ///< control points for the variables x
  Eigen::VectorXd values(
      const Eigen::MatrixXd& coefficients) const;   ///< variables x for the control points
  bool act_at(const SplineWeights& weights) const;  ///< whether a free control point acts there
};
CorrectionVariables correction_variables(const RobotModel& model, const CommandSeries& series,
                                         const CorrectionSpec& spec);

/// The collocation points in order of time. They are at the knots and between them, at both ends of
/// every contact interval, beside the ends of flights, and at the times and limits that `spec`
/// names. Points that no variable moves are left out.
std::vector<CollocationPoint> collocation_points(const RobotModel& model,
                                                 const CommandSeries& series,
                                                 const ContactPlan& plan,
                                                 const CorrectionSpec& spec,
                                                 const CorrectionVariables& variables);

}  // namespace ayumi
