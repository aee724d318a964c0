// A body's axes are turned by a constant C so that its joint axis is x, y or z: with R = E P(q) the
// body's attitude in its parent, C_p' R C = (C_p' E C) P'(q). For axes along -x, -y or -z, q is
// counted backwards instead.
#include "ayumi/dynamics/tree_links.hpp"

#include <cmath>

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

void put(const Matrix3d& m, double* rows) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) rows[3 * i + j] = m(i, j);
}

void put_six(const Matrix3d& m, double* six) {
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) *six++ = m(i, j);
}

// Fills the axis and the direction, and returns C.
Matrix3d align(const Body& body, kernels::Link& link) {
  link.ratio = body.ratio;
  link.offset = body.offset;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(body.axis[k]) != 1) continue;
    link.axis = k;
    if (body.axis[k] < 0) {
      link.ratio = -link.ratio;
      link.offset = -link.offset;
      link.along = -1;
    }
    return Matrix3d::Identity();
  }
  link.axis = 2;
  link.skewed = true;
  Matrix3d C;
  C.col(2) = body.axis;
  C.col(0) = body.axis.unitOrthogonal();
  C.col(1) = C.col(2).cross(C.col(0));
  return C;
}

}  // namespace

std::vector<kernels::Link> tree_links(const RobotModel& model) {
  const std::vector<Body>& bodies = model.bodies();
  std::vector<kernels::Link> links(bodies.size());
  std::vector<Matrix3d> turn(bodies.size(), Matrix3d::Identity());
  for (size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    kernels::Link& link = links[i];
    if (i > 0) {
      turn[i] = align(body, link);
      link.parent = body.parent;
      link.dof = body.dof;
      link.prismatic = body.prismatic;
      link.drive = body.ratio;
      put(turn[i], link.C);
      const Matrix3d& up = turn[static_cast<size_t>(body.parent)];
      const Matrix3d E = up.transpose() * body.placement.linear() * turn[i];
      link.turned = E != Matrix3d::Identity();
      put(E, link.E);
      Eigen::Map<Vector3d>(link.r) = up.transpose() * body.placement.translation();
    }
    const Vector3d com = turn[i].transpose() * body.inertia.com;
    Matrix3d I = turn[i].transpose() * body.inertia.about_com * turn[i];
    const double m = body.inertia.mass;
    I += m * (com.squaredNorm() * Matrix3d::Identity() - com * com.transpose());
    link.mass = m;
    Eigen::Map<Vector3d>(link.moment) = m * com;
    put_six(I, link.I);
    Eigen::Map<Vector3d>(link.com) = body.inertia.com;
    put_six(body.inertia.about_com, link.about_com);
  }
  for (size_t i = links.size(); i-- > 0;) {
    links[i].subtree_mass += links[i].mass;
    if (i > 0) links[static_cast<size_t>(links[i].parent)].subtree_mass += links[i].subtree_mass;
  }
  return links;
}

}  // namespace ayumi
