// Rotation error of a sole: e = vee(E - E')/2 with E = R R_planned'; a turn w of the sole changes
// it by de = (tr(E) 1 - E) w / 2.
#include "ayumi/limits/sole_rows.hpp"

#include <utility>

#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

Matrix3d rotation_error(const Isometry3d& actual, const Isometry3d& planned) {
  return actual.linear() * planned.linear().transpose();
}

}  // namespace

Vector6d sole_deviation(const Isometry3d& actual, const Isometry3d& planned) {
  const Matrix3d E = rotation_error(actual, planned);
  Vector6d deviation;
  deviation << actual.translation() - planned.translation(),
      0.5 * Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  return deviation;
}

MatrixXd deviation_rates(const Isometry3d& sole, const Isometry3d& planned,
                         const MatrixXd& motion) {
  const Matrix3d E = rotation_error(sole, planned);
  MatrixXd rates(6, motion.cols());
  rates << motion.topRows<3>(),
      0.5 * (E.trace() * Matrix3d::Identity() - E) * motion.bottomRows<3>();
  return rates;
}

Matrix3d turn_curvature(const Vector3d& d, const Isometry3d& sole, const Isometry3d& planned) {
  return 0.5 * skew(d) * planned.linear() * sole.linear().transpose();
}

SoleRows deviation_rows(Side side, const Isometry3d& planned) {
  return {
      .side = side,
      .value = [planned](const Isometry3d& sole) -> VectorXd {
        return sole_deviation(sole, planned);
      },
      .rate = [planned](const Isometry3d& sole,
                        const MatrixXd& motion) { return deviation_rates(sole, planned, motion); },
      .add_curvature =
          [planned](const Isometry3d& sole, const VectorXd& l, PoseCurvature& sum) {
            sum.c += l.head<3>();
            sum.K += turn_curvature(l.tail<3>(), sole, planned);
          }};
}

namespace {

struct Heights {
  std::vector<Eigen::Vector2d> points;  // points of the sole, in its frame
  Isometry3d ground;

  int rows() const { return static_cast<int>(points.size()); }
  Vector3d normal() const { return ground.linear().col(2); }
  Vector3d point(int i) const { return Vector3d(points[i].x(), points[i].y(), 0); }

  VectorXd value(const Isometry3d& sole) const {
    VectorXd values(rows());
    for (int i = 0; i < rows(); ++i)
      values[i] = normal().dot(sole * point(i) - ground.translation());
    return values;
  }

  MatrixXd rate(const Isometry3d& sole, const MatrixXd& motion) const {
    MatrixXd rates(rows(), motion.cols());
    for (int i = 0; i < rows(); ++i) {
      const Vector3d arm = sole * point(i) - sole.translation();
      rates.row(i) = normal().transpose() * motion.topRows<3>() +
                     arm.cross(normal()).transpose() * motion.bottomRows<3>();
    }
    return rates;
  }

  void add_curvature(const Isometry3d& sole, const VectorXd& l, PoseCurvature& sum) const {
    Vector3d arms = Vector3d::Zero();
    for (int i = 0; i < rows(); ++i) arms += l[i] * (sole.linear() * point(i));
    sum.c += l.sum() * normal();
    sum.K += normal() * arms.transpose();
  }
};

}  // namespace

SoleRows height_rows(const RobotModel& model, Side side, const Isometry3d& ground) {
  return height_rows(side, model.sole(side).polygon, ground);
}

SoleRows height_rows(Side side, std::vector<Eigen::Vector2d> points, const Isometry3d& ground) {
  const Heights heights = {std::move(points), ground};
  return {.side = side,
          .value = [heights](const Isometry3d& sole) { return heights.value(sole); },
          .rate = [heights](const Isometry3d& sole,
                            const MatrixXd& motion) { return heights.rate(sole, motion); },
          .add_curvature = [heights](const Isometry3d& sole, const VectorXd& l,
                                     PoseCurvature& sum) { heights.add_curvature(sole, l, sum); }};
}

double height_over(const Isometry3d& place, const Isometry3d& sole) {
  return place.linear().col(2).dot(sole.translation() - place.translation());
}

}  // namespace ayumi
