#include "tests/bench/bench.hpp"

#ifdef BENCH_HAS_PINOCCHIO

#include <memory>
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/center-of-mass.hpp>
#include <pinocchio/algorithm/cholesky.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/config.hpp>
#include <pinocchio/multibody/model.hpp>

#include "ayumi/model/gravity.hpp"

namespace ayumi::bench {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
namespace pin = pinocchio;

namespace {

/// Pinocchio's copy of the robot with the problem in its own coordinates: base twists and forces in
/// the axes of the base, and spatial accelerations.
struct Pinocchio {
  explicit Pinocchio(const Problem& problem) {
    const RobotModel& robot = *problem.model;
    std::vector<pin::JointIndex> joints;
    for (const Body& body : robot.bodies()) {
      pin::JointIndex id = 0;
      if (body.parent < 0) {
        id = model.addJoint(0, pin::JointModelFreeFlyer(), pin::SE3::Identity(), "root");
      } else {
        const pin::SE3 at(body.placement.linear(), body.placement.translation());
        const auto parent = joints[static_cast<size_t>(body.parent)];
        const std::string name = robot.dofs()[static_cast<size_t>(body.dof)].name;
        if (body.prismatic)
          id = model.addJoint(parent, pin::JointModelPrismaticUnaligned(body.axis), at, name);
        else if (body.axis == Vector3d::UnitX())
          id = model.addJoint(parent, pin::JointModelRX(), at, name);
        else if (body.axis == Vector3d::UnitY())
          id = model.addJoint(parent, pin::JointModelRY(), at, name);
        else if (body.axis == Vector3d::UnitZ())
          id = model.addJoint(parent, pin::JointModelRZ(), at, name);
        else
          id = model.addJoint(parent, pin::JointModelRevoluteUnaligned(body.axis), at, name);
        columns.push_back({model.idx_vs[id], body.dof});
      }
      model.appendBodyToJoint(
          id, pin::Inertia(body.inertia.mass, body.inertia.com, body.inertia.about_com),
          pin::SE3::Identity());
      joints.push_back(id);
    }
    model.gravity.linear() = Vector3d(0, 0, -kGravity);
    data = std::make_unique<pin::Data>(model);
    for (size_t i = 0; i < problem.states.size(); ++i) take_over(problem, i);
    for (MatrixXd* each : {&by_q, &by_v, &by_a}) each->setZero(model.nv, model.nv);
  }
  void take_over(const Problem& problem, size_t i) {
    const RobotState& s = problem.states[i];
    const Eigen::Matrix3d turn = s.base.attitude.toRotationMatrix().transpose();
    const VectorXd &acceleration = problem.accelerations[i], &force = problem.forces[i];
    VectorXd qi(model.nq), vi(model.nv), ai(model.nv), fi(model.nv);
    qi.head<3>() = s.base.position;
    qi.segment<4>(3) = s.base.attitude.coeffs();
    vi.head<3>() = turn * s.base_velocity;
    vi.segment<3>(3) = turn * s.base_angular_velocity;
    ai.head<3>() = turn * (acceleration.head<3>() - s.base_angular_velocity.cross(s.base_velocity));
    ai.segment<3>(3) = turn * acceleration.segment<3>(3);
    fi.head<3>() = turn * force.head<3>();
    fi.segment<3>(3) = turn * force.segment<3>(3);
    for (const auto& [at, dof] : columns) {
      qi[at + 1] = s.theta[dof];
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
  MatrixXd joint_columns(const MatrixXd& theirs) const {
    MatrixXd ours(theirs.rows(), static_cast<Eigen::Index>(columns.size()));
    for (const auto& [at, dof] : columns) ours.col(dof) = theirs.col(at);
    return ours;
  }
  MatrixXd block(const MatrixXd& theirs) const {
    return joint_columns(MatrixXd(joint_columns(theirs).transpose())).transpose();
  }
  VectorXd blocks(const MatrixXd& x, const MatrixXd& y, const MatrixXd& z) const {
    const auto n = static_cast<Eigen::Index>(columns.size());
    VectorXd all(3 * n * n);
    all << flat(block(x)), flat(block(y)), flat(block(z));
    return all;
  }
  static MatrixXd symmetric(const MatrixXd& upper) { return upper.selfadjointView<Eigen::Upper>(); }
  pin::Model model;
  std::unique_ptr<pin::Data> data;
  std::vector<std::pair<int, int>> columns;  ///< columns of its velocity, and the dof
  std::vector<VectorXd> q, v, a, f;
  MatrixXd by_q, by_v, by_a;
};

}  // namespace

Kernels pinocchio_kernels(const Problem& problem) {
  const auto w = std::make_shared<Pinocchio>(problem);
  const std::string who = "Pinocchio " PINOCCHIO_VERSION;
  const auto rnea = [w](size_t i) { pin::rnea(w->model, *w->data, w->q[i], w->v[i], w->a[i]); };
  const auto aba = [w](size_t i) { pin::aba(w->model, *w->data, w->q[i], w->v[i], w->f[i]); };
  const auto crba = [w](size_t i) { pin::crba(w->model, *w->data, w->q[i]); };
  const auto factored = [w, crba](size_t i) {
    crba(i);
    pin::cholesky::decompose(w->model, *w->data);
  };
  const auto cog = [w](size_t i) { pin::jacobianCenterOfMass(w->model, *w->data, w->q[i]); };
  const auto rnea_derivatives = [w](size_t i) {
    pin::computeRNEADerivatives(w->model, *w->data, w->q[i], w->v[i], w->a[i], w->by_q, w->by_v,
                                w->by_a);
  };
  const auto aba_derivatives = [w](size_t i) {
    pin::computeABADerivatives(w->model, *w->data, w->q[i], w->v[i], w->f[i], w->by_q, w->by_v,
                               w->by_a);
  };
  return {{"RNEA", who, "", rnea,
           [w, rnea](size_t i) {
             rnea(i);
             return w->joints(w->data->tau);
           }},
          {"ABA", who, "", aba,
           [w, aba](size_t i) {
             aba(i);
             return w->joints(w->data->ddq);
           }},
          {"CRBA", who, "", crba,
           [w, crba](size_t i) {
             crba(i);
             return flat(w->block(Pinocchio::symmetric(w->data->M)));
           }},
          {"CRBA and factor", who, "", factored, {}},
          {"COG Jacobian", who, "", cog,
           [w, cog](size_t i) {
             cog(i);
             return flat(w->joint_columns(w->data->Jcom));
           }},
          {"RNEA derivatives", who, "", rnea_derivatives,
           [w, rnea_derivatives](size_t i) {
             w->by_a.setZero();
             rnea_derivatives(i);
             return w->blocks(w->by_q, w->by_v, Pinocchio::symmetric(w->by_a));
           }},
          {"ABA derivatives", who, "", aba_derivatives, [w, aba_derivatives](size_t i) {
             w->by_a.setZero();
             aba_derivatives(i);
             return w->blocks(w->by_q, w->by_v, Pinocchio::symmetric(w->by_a));
           }}};
}

}  // namespace ayumi::bench

#else

namespace ayumi::bench {
Kernels pinocchio_kernels(const Problem&) { return {}; }
}  // namespace ayumi::bench

#endif
