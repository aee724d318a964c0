// A shift u(t) of the whole robot along the ground moves the ZMP by u - (h m/f_z) u'', with the
// height h of the COG. Let u be a cubic spline with control points c, and J_k c this displacement
// in row k. Where the ZMP p_k lies outside the region in which it is wanted, q_k is the nearest
// point of the region and n_k the direction from q_k to p_k. The sum of
//   (n_k.(p_k + J_k c - q_k))^2  over these rows,  kElsewhere |J_k c|^2  over all rows
// and a price of the shift itself is minimised by Newton's method: each step takes the rows that
// are outside after the step before.
#include "ayumi/author/import/base_of_soles.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/correction.hpp"
#include "ayumi/motion/differentiate.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

namespace {

// Largest shift of the base [m]. Chosen: half of what the check allows a sole that stands
// (limits/stance.cpp).
constexpr double kMost = 0.001;
// Time between the knots of the shift [s]. Chosen: a fifth of a short support by one foot, in which
// the errors of the base rise and fall once.
constexpr double kSpacing = 0.02;
// Distance inside the support at which the ZMP is wanted [m]. Derived: below this, the check
// warns (limits/support_margin.cpp).
constexpr double kInside = 0.002;
// Price of a displacement of the ZMP where it needs none, compared with one outside. Chosen: small,
// so that a hundredth of the distance outside is left.
constexpr double kElsewhere = 0.01;
// A shift of its whole range costs as much as a ZMP this far outside [m]. Chosen: small against the
// errors of H1's walk (25 mm), so that the shift is used where it is needed.
constexpr double kWholeRange = 0.001;
// Largest number of steps of Newton's method. Chosen: only rows at the edge of the support still
// change then.
constexpr int kSteps = 30;
// Largest number of prices, each four times the one before, until the shift is within its range.
// Chosen: the last price is a million times the first.
constexpr int kPrices = 10;

// The ZMP of the motion and how far a shift's acceleration moves it, row by row.
struct ZmpRows {
  std::vector<Vector2d> zmp;   // [m]
  std::vector<double> height;  // h m/f_z [s^2]
};

ZmpRows zmp_rows(const RobotModel& model, const MatrixXd& theta, double dt,
                 const std::vector<BasePose>& base) {
  std::vector<CommandSample> samples(base.size());
  RobotData data(model);
  for (size_t k = 0; k < base.size(); ++k) {
    samples[k].state = model.rest_state();
    samples[k].state.theta = theta.row(static_cast<Index>(k)).transpose();
    samples[k].state.base = base[k];
    update_positions(model, samples[k].state, data);
    samples[k].cog = data.cog;
  }
  fill_rates(samples, dt, false);
  TreeDynamics dynamics(model);
  std::vector<GroundReaction> reactions;
  full_model_reactions(model, samples, dynamics, reactions);
  // Force below which a row counts as flight, as a share of the weight, as in
  // full_model_reaction().
  constexpr double kLeastForce = 0.05;
  const double weight = model.mass() * kGravity;
  ZmpRows rows;
  for (size_t k = 0; k < base.size(); ++k) {
    rows.zmp.push_back(reactions[k].zmp.head<2>());
    const double force = std::max(reactions[k].force.z(), kLeastForce * weight);
    rows.height.push_back(samples[k].cog.z() * model.mass() / force);
  }
  return rows;
}

// The normal equations of the control points, as blocks on and beside the diagonal.
class NormalEquations {
 public:
  explicit NormalEquations(Index points) : blocks_(static_cast<size_t>(points)) {
    for (auto& row : blocks_) row.fill(Matrix2d::Zero());
    right_.setZero(2 * points);
  }

  void add(const SplineWeights& w, const Eigen::Vector4d& j, const Matrix2d& weight,
           const Vector2d& target) {
    for (int a = 0; a < 4; ++a) {
      for (int b = a; b < 4; ++b)
        blocks_[static_cast<size_t>(w.first + a)][static_cast<size_t>(b - a)] +=
            j[a] * j[b] * weight;
      right_.segment<2>(2 * (w.first + a)) += j[a] * (weight * target);
    }
  }

  void add_price(const Vector2d& price) {
    for (auto& row : blocks_) row[0] += Matrix2d(price.asDiagonal());
  }

  VectorXd solved() const {
    const auto points = static_cast<Index>(blocks_.size());
    std::vector<Eigen::Triplet<double>> entries;
    for (Index i = 0; i < points; ++i)
      for (Index b = 0; b < 4 && i + b < points; ++b)
        for (int r = 0; r < 2; ++r)
          for (int c = 0; c < 2; ++c)
            entries.emplace_back(2 * (i + b) + c, 2 * i + r,
                                 blocks_[static_cast<size_t>(i)][static_cast<size_t>(b)](r, c));
    Eigen::SparseMatrix<double> matrix(2 * points, 2 * points);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right_);
  }

 private:
  std::vector<std::array<Matrix2d, 4>> blocks_;
  VectorXd right_;
};

class ShiftSearch {
 public:
  ShiftSearch(const ZmpRows& rows, const SupportRegions& support, double dt)
      : rows_(rows), of_row_(support.of_row) {
    for (const ConvexPolygon& region : support.regions) wanted_.push_back(region.shrunk(kInside));
    const double length = static_cast<double>(rows.zmp.size() - 1) * dt;
    const Index count = std::max<Index>(1, static_cast<Index>(std::ceil(length / kSpacing))) + 3;
    track_.spacing = length / static_cast<double>(count - 3);
    track_.coefficients.setZero(count, 2);
    for (size_t k = 0; k < rows.zmp.size(); ++k)
      weights_.push_back(correction_weights(track_, static_cast<double>(k) * dt));
  }

  // The shift of each row [m], within `range`.
  std::vector<Vector2d> within(const Vector2d& range) {
    // No shift is cheaper than the rounding of the bases allows [m].
    constexpr double kLeastRange = 1e-9;
    Vector2d price =
        rows_per_point() * (kWholeRange / range.cwiseMax(kLeastRange).array()).square().matrix();
    for (int i = 0; i < kPrices; ++i) {
      search(price);
      std::vector<Vector2d> shifts;
      Vector2d most = Vector2d::Zero();
      for (const SplineWeights& w : weights_) {
        shifts.push_back(at(w, w.value));
        most = most.cwiseMax(shifts.back().cwiseAbs());
      }
      if ((most.array() <= range.array()).all()) return shifts;
      for (int axis = 0; axis < 2; ++axis)
        if (most[axis] > range[axis]) price[axis] *= 4;
    }
    return std::vector<Vector2d>(rows_.zmp.size(), Vector2d::Zero());
  }

 private:
  double rows_per_point() const {
    return static_cast<double>(rows_.zmp.size()) / static_cast<double>(track_.coefficients.rows());
  }

  Vector2d at(const SplineWeights& w, const Eigen::Vector4d& values) const {
    return track_.coefficients.middleRows<4>(w.first).transpose() * values;
  }

  Eigen::Vector4d displacement(size_t k) const {
    return weights_[k].value - rows_.height[k] * weights_[k].acceleration;
  }

  void search(const Vector2d& price) {
    track_.coefficients.setZero();
    std::vector<bool> before;
    for (int step = 0; step < kSteps; ++step) {
      std::vector<bool> outside(rows_.zmp.size());
      NormalEquations equations(track_.coefficients.rows());
      for (size_t k = 0; k < rows_.zmp.size(); ++k) {
        const Eigen::Vector4d j = displacement(k);
        const Vector2d zmp = rows_.zmp[k] + at(weights_[k], j);
        equations.add(weights_[k], j, kElsewhere * Matrix2d::Identity(), Vector2d::Zero());
        const ConvexPolygon& wanted = wanted_[of_row_[k]];
        if (wanted.empty()) continue;  // in flight
        const Vector2d nearest = wanted.project(zmp);
        const double distance = (zmp - nearest).norm();
        outside[k] = distance > 0;
        if (!outside[k]) continue;
        const Vector2d normal = (zmp - nearest) / distance;
        equations.add(weights_[k], j, normal * normal.transpose(), nearest - rows_.zmp[k]);
      }
      if (outside == before) return;
      equations.add_price(price);
      const VectorXd points = equations.solved();
      track_.coefficients =
          Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>(
              points.data(), track_.coefficients.rows(), 2);
      before = std::move(outside);
    }
  }

  const ZmpRows& rows_;
  const std::vector<size_t>& of_row_;
  std::vector<ConvexPolygon> wanted_;
  CorrectionTrack track_;
  std::vector<SplineWeights> weights_;
};

}  // namespace

void SoleDisagreement::add(const Eigen::Isometry3d& by_left, const Eigen::Isometry3d& by_right) {
  position = position.max((by_left.translation() - by_right.translation()).array().abs());
}

std::vector<BasePose> base_with_zmp_inside(const RobotModel& model, const MatrixXd& theta,
                                           double dt, std::vector<BasePose> base,
                                           const SupportRegions& support,
                                           const SoleDisagreement& soles) {
  const ZmpRows rows = zmp_rows(model, theta, dt, base);
  const Vector2d range = soles.position.head<2>().min(kMost).matrix();
  const std::vector<Vector2d> shifts = ShiftSearch(rows, support, dt).within(range);
  for (size_t k = 0; k < base.size(); ++k) base[k].position.head<2>() += shifts[k];
  return base;
}

}  // namespace ayumi
