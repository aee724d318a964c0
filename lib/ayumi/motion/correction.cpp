// For the attitude exp(r) R, with the left Jacobian J(r) = 1 + a [r] + b [r]^2,
//   a = (1 - cos f)/f^2, b = (f - sin f)/f^3, f = |r|,
// w' = J r' + exp(r) w and dw' = d(J r')/dt + (J r') x exp(r) w + exp(r) dw.
#include "ayumi/motion/correction.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/motion/smooth_motion.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Changes below this are the rounding of control points that cancel each other; they are set to
// zero, so that samples without a change stay bit-identical [m, rad]. Chosen: above the rounding of
// control points of metres and radians (2e-16).
constexpr double kRounded = 1e-13;

struct JacobianFactors {
  double a, b, da, db;  // the two factors and their derivatives by f^2
};

JacobianFactors jacobian_factors(double f2) {
  if (f2 < 0.01) {  // the series to f^6, with an error below 1e-14
    return {0.5 - f2 * (1.0 / 24 - f2 * (1.0 / 720 - f2 / 40320)),
            1.0 / 6 - f2 * (1.0 / 120 - f2 * (1.0 / 5040 - f2 / 362880)),
            -1.0 / 24 + f2 * (1.0 / 360 - f2 / 13440),
            -1.0 / 120 + f2 * (1.0 / 2520 - f2 / 120960)};
  }
  const double f = std::sqrt(f2), s = elementary::sin(f), c = elementary::cos(f);
  const double a = (1 - c) / f2, b = (f - s) / (f2 * f);
  return {a, b, (s / f - 2 * a) / (2 * f2), (a - 3 * b) / (2 * f2)};
}

void rotate_base(const Vector3d& r, const Vector3d& dr, const Vector3d& ddr,
                 CommandSample& sample) {
  if (r.isZero(0) && dr.isZero(0) && ddr.isZero(0)) return;  // every bit of the sample is kept
  const JacobianFactors k = jacobian_factors(r.squaredNorm());
  const double df2 = 2 * r.dot(dr);
  const Vector3d rdr = r.cross(dr), rddr = r.cross(ddr);
  const Vector3d w = dr + k.a * rdr + k.b * r.cross(rdr);
  const Vector3d dw = ddr + k.a * rddr + k.b * (dr.cross(rdr) + r.cross(rddr)) +
                      df2 * (k.da * rdr + k.db * r.cross(rdr));
  const Eigen::Quaterniond turn = exp_rotation(r);
  RobotState& state = sample.state;
  const Vector3d carried = turn * state.base_angular_velocity;
  const Vector3d dcarried = turn * Vector3d(sample.acceleration.segment<3>(3));
  if (!r.isZero(0)) state.base.attitude = (turn * state.base.attitude).normalized();
  state.base_angular_velocity = w + carried;
  sample.acceleration.segment<3>(3) = dw + w.cross(carried) + dcarried;
}

void require_track(const CorrectionTrack& track) {
  const auto columns = static_cast<Eigen::Index>(6 + track.joints.size());
  if (track.coefficients.cols() != columns)
    fail(ErrorCode::bad_pattern,
         "correction: there are " + std::to_string(track.coefficients.cols()) +
             " columns, but the base and the joints need " + std::to_string(columns));
  if (!(track.spacing > 0) || !track.coefficients.allFinite() || !std::isfinite(track.begin))
    fail(ErrorCode::bad_pattern,
         "correction: the spacing must be above 0 and every coefficient a finite number");
}

}  // namespace

SplineWeights correction_weights(const CorrectionTrack& track, double t) {
  SplineWeights weights;
  const auto last = static_cast<int>(track.coefficients.rows()) - 4;
  const double knots = (t - track.begin) / track.spacing;
  // Tolerance by which t may lie outside the track [knots]. Chosen: above rounding, so that the end
  // of the track belongs to it.
  constexpr double kRounding = 1e-6;
  if (last < 0 || !(knots >= -kRounding) || knots > last + 1 + kRounding) return weights;
  weights.first = std::clamp(static_cast<int>(knots), 0, last);
  const double u = knots - weights.first, v = 1 - u, h = track.spacing;
  weights.value << v * v * v, 3 * u * u * u - 6 * u * u + 4, 3 * v * v * v - 6 * v * v + 4,
      u * u * u;
  weights.value /= 6;
  weights.rate << -v * v, 3 * u * u - 4 * u, 4 * v - 3 * v * v, u * u;
  weights.rate /= 2 * h;
  weights.acceleration << v, 3 * u - 2, 3 * v - 2, u;
  weights.acceleration /= h * h;
  return weights;
}

CommandSeries apply_correction(const RobotModel& model, const CommandSeries& series,
                               const CorrectionTrack& track) {
  require_track(track);
  std::vector<int> dofs;
  for (const std::string& joint : track.joints) {
    dofs.push_back(model.find_dof(joint));
    if (dofs.back() < 0)
      fail_unknown_name({"", "/correction"}, "the robot '" + model.name() + "' has no joint '" +
                                                 joint + "'" +
                                                 text::suggestion(joint, model.dof_names()));
  }
  CommandSeries result = smoothed(series, track.smooth);
  result.kept.reset();
  RobotData data(model);
  for (size_t k = 0; k < result.samples.size(); ++k) {
    CommandSample& sample = result.samples[k];
    const SplineWeights weights = correction_weights(track, series.dt * static_cast<double>(k));
    if (track.coefficients.rows() >= 4) {
      const auto rows = track.coefficients.middleRows<4>(weights.first);
      VectorXd value = rows.transpose() * weights.value;
      value = (value.array().abs() < kRounded).select(0, value);
      const VectorXd rate = rows.transpose() * weights.rate;
      const VectorXd acceleration = rows.transpose() * weights.acceleration;
      sample.state.base.position += value.head<3>();
      sample.state.base_velocity += rate.head<3>();
      sample.acceleration.head<3>() += acceleration.head<3>();
      rotate_base(value.segment<3>(3), rate.segment<3>(3), acceleration.segment<3>(3), sample);
      for (size_t j = 0; j < dofs.size(); ++j) {
        const auto column = static_cast<Eigen::Index>(6 + j);
        sample.state.theta[dofs[j]] += value[column];
        sample.state.dtheta[dofs[j]] += rate[column];
        sample.acceleration[6 + dofs[j]] += acceleration[column];
      }
    }
    const GroundReaction full = full_model_reaction(model, sample, data);
    sample.zmp = full.zmp;
    sample.fz = full.force.z();
    sample.cog = data.cog;
    sample.dcog = data.dcog;
    sample.ddcog = full.force / model.mass() - Vector3d(0, 0, kGravity);
  }
  for (const char* name : {"cog", "zmp", "fz"})
    result.origin[name] = "computed from the full model of the corrected motion";
  result.origin["joints"] += ", then corrected";
  result.origin["base"] += ", then corrected";
  return result;
}

CommandSeries apply_smoothing(const RobotModel& model, const CommandSeries& series,
                              const std::vector<SmoothWindow>& windows) {
  CorrectionTrack track;
  track.spacing = series.duration();
  track.coefficients.setZero(0, 6);
  track.smooth = windows;
  return apply_correction(model, series, track);
}

}  // namespace ayumi
