#include "tests/bench/bench.hpp"

#ifdef BENCH_HAS_RBDL

#include <rbdl/rbdl.h>

#include <memory>

#include "ayumi/model/gravity.hpp"

namespace ayumi::bench {

using Eigen::Vector3d;
using Eigen::VectorXd;
namespace rb = RigidBodyDynamics;

namespace {

/// RBDL's copy of the robot. Its floating base consists of three translations in the world and a
/// spherical joint, whose rates are in the axes of the base.
struct Rbdl {
  explicit Rbdl(const Problem& problem) {
    const RobotModel& robot = *problem.model;
    model.gravity = Vector3d(0, 0, -kGravity);
    std::vector<unsigned> ids;
    for (const Body& body : robot.bodies()) {
      // RBDL's vectors and matrices can be made from any of Eigen's, so that the type must be
      // named.
      const rb::Body solid(body.inertia.mass, rb::Math::Vector3d(body.inertia.com),
                           rb::Math::Matrix3d(body.inertia.about_com));
      if (body.parent < 0) {
        ids.push_back(model.AddBody(0, rb::Math::SpatialTransform(),
                                    rb::Joint(rb::JointTypeFloatingBase), solid));
        continue;
      }
      const rb::Math::SpatialTransform at(rb::Math::Matrix3d(body.placement.linear().transpose()),
                                          rb::Math::Vector3d(body.placement.translation()));
      const rb::Joint joint(body.prismatic ? rb::JointTypePrismatic : rb::JointTypeRevolute,
                            rb::Math::Vector3d(body.axis));
      ids.push_back(model.AddBody(ids[static_cast<size_t>(body.parent)], at, joint, solid));
      columns.push_back({static_cast<int>(model.mJoints[ids.back()].q_index), body.dof});
    }
    for (size_t i = 0; i < problem.states.size(); ++i) take_over(problem, i, ids[0]);
    result = VectorXd::Zero(model.qdot_size);
    M = rb::Math::MatrixNd::Zero(model.qdot_size, model.qdot_size);
  }
  void take_over(const Problem& problem, size_t i, unsigned base) {
    const RobotState& s = problem.states[i];
    const Eigen::Matrix3d turn = s.base.attitude.toRotationMatrix().transpose();
    const VectorXd &acceleration = problem.accelerations[i], &force = problem.forces[i];
    VectorXd qi = VectorXd::Zero(model.q_size), vi = VectorXd::Zero(model.qdot_size), ai = vi,
             fi = vi;
    qi.head<3>() = s.base.position;
    const Eigen::Quaterniond& at_base = s.base.attitude;
    model.SetQuaternion(
        base, rb::Math::Quaternion(at_base.x(), at_base.y(), at_base.z(), at_base.w()), qi);
    vi.head<3>() = s.base_velocity;
    vi.segment<3>(3) = turn * s.base_angular_velocity;
    ai.head<3>() = acceleration.head<3>();
    ai.segment<3>(3) = turn * acceleration.segment<3>(3);
    fi.head<3>() = force.head<3>();
    fi.segment<3>(3) = turn * force.segment<3>(3);
    for (const auto& [at, dof] : columns) {
      qi[at] = s.theta[dof];
      vi[at] = s.dtheta[dof];
      ai[at] = acceleration[6 + dof];
      fi[at] = force[6 + dof];
    }
    q.push_back(qi);
    v.push_back(vi);
    a.push_back(ai);
    f.push_back(fi);
  }
  VectorXd joints(const VectorXd& theirs) const {
    VectorXd ours(static_cast<Eigen::Index>(columns.size()));
    for (const auto& [at, dof] : columns) ours[dof] = theirs[at];
    return ours;
  }
  rb::Model model;
  std::vector<std::pair<int, int>> columns;
  std::vector<VectorXd> q, v, a, f;
  VectorXd result;
  rb::Math::MatrixNd M;
};

}  // namespace

Kernels rbdl_kernels(const Problem& problem) {
  const auto w = std::make_shared<Rbdl>(problem);
  const auto rnea = [w](size_t i) {
    rb::InverseDynamics(w->model, w->q[i], w->v[i], w->a[i], w->result);
  };
  const auto aba = [w](size_t i) {
    rb::ForwardDynamics(w->model, w->q[i], w->v[i], w->f[i], w->result);
  };
  const auto crba = [w](size_t i) {
    w->M.setZero();
    rb::CompositeRigidBodyAlgorithm(w->model, w->q[i], w->M);
  };
  return {{"RNEA", "RBDL", "", rnea,
           [w, rnea](size_t i) {
             rnea(i);
             return w->joints(w->result);
           }},
          {"ABA", "RBDL", "", aba,
           [w, aba](size_t i) {
             aba(i);
             return w->joints(w->result);
           }},
          {"CRBA", "RBDL", "", crba, {}}};
}

}  // namespace ayumi::bench

#else

namespace ayumi::bench {
Kernels rbdl_kernels(const Problem&) { return {}; }
}  // namespace ayumi::bench

#endif
