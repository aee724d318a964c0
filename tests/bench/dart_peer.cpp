#include "tests/bench/bench.hpp"

#ifdef BENCH_HAS_DART

#include <dart/dynamics/dynamics.hpp>
#include <memory>

#include "ayumi/model/gravity.hpp"

namespace ayumi::bench {

using Eigen::VectorXd;
namespace dd = dart::dynamics;

namespace {

/// DART's copy of the robot with the problem in its own coordinates.
struct Dart {
  explicit Dart(const Problem& problem) : skeleton(dd::Skeleton::create("robot")) {
    const RobotModel& model = *problem.model;
    std::vector<dd::BodyNode*> nodes;
    for (const Body& body : model.bodies()) {
      dd::BodyNode* node = nullptr;
      if (body.parent < 0) {
        auto [joint, root] = skeleton->createJointAndBodyNodePair<dd::FreeJoint>();
        base = joint;
        node = root;
      } else {
        dd::BodyNode* parent = nodes[static_cast<size_t>(body.parent)];
        dd::Joint* joint = nullptr;
        if (body.prismatic) {
          dd::PrismaticJoint::Properties properties;
          properties.mName = "joint " + body.name;
          auto [made, child] =
              skeleton->createJointAndBodyNodePair<dd::PrismaticJoint>(parent, properties);
          made->setAxis(body.axis);
          joint = made;
          node = child;
        } else {
          dd::RevoluteJoint::Properties properties;
          properties.mName = "joint " + body.name;
          auto [made, child] =
              skeleton->createJointAndBodyNodePair<dd::RevoluteJoint>(parent, properties);
          made->setAxis(body.axis);
          joint = made;
          node = child;
        }
        joint->setTransformFromParentBodyNode(body.placement);
        columns.push_back({joint, body.dof});
      }
      const Eigen::Matrix3d& I = body.inertia.about_com;
      node->setInertia(dd::Inertia(body.inertia.mass, body.inertia.com, I));
      node->setName(body.name + std::to_string(nodes.size()));
      nodes.push_back(node);
    }
    skeleton->setGravity({0, 0, -kGravity});
    for (size_t i = 0; i < problem.states.size(); ++i) take_over(problem, i);
  }

  void take_over(const Problem& problem, size_t i) {
    const RobotState& s = problem.states[i];
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = s.base.attitude.toRotationMatrix();
    pose.translation() = s.base.position;
    base->setPositions(dd::FreeJoint::convertToPositions(pose));
    base->setLinearVelocity(s.base_velocity);
    base->setAngularVelocity(s.base_angular_velocity);
    const VectorXd& a = problem.accelerations[i];
    base->setLinearAcceleration(a.head<3>());
    base->setAngularAcceleration(a.segment<3>(3));
    // DART's base force is the wrench on the body in the body's axes, with the moment first.
    const Eigen::Matrix3d turn = pose.linear().transpose();
    VectorXd force(skeleton->getNumDofs());
    force.segment<3>(0) = turn * problem.forces[i].segment<3>(3);
    force.segment<3>(3) = turn * problem.forces[i].head<3>();
    q.push_back(skeleton->getPositions());
    v.push_back(skeleton->getVelocities());
    dv.push_back(skeleton->getAccelerations());
    for (const auto& [joint, dof] : columns) {
      const auto k = static_cast<Eigen::Index>(joint->getIndexInSkeleton(0));
      q[i][k] = s.theta[dof];
      v[i][k] = s.dtheta[dof];
      dv[i][k] = a[6 + dof];
      force[k] = problem.forces[i][6 + dof];
    }
    f.push_back(force);
  }
  VectorXd joints(const VectorXd& theirs) const {
    VectorXd ours(static_cast<Eigen::Index>(columns.size()));
    for (const auto& [joint, dof] : columns)
      ours[dof] = theirs[static_cast<Eigen::Index>(joint->getIndexInSkeleton(0))];
    return ours;
  }
  /// The columns of a matrix by joint, in Ayumi's order.
  Eigen::MatrixXd joint_columns(const Eigen::MatrixXd& theirs) const {
    Eigen::MatrixXd ours(theirs.rows(), static_cast<Eigen::Index>(columns.size()));
    for (const auto& [joint, dof] : columns)
      ours.col(dof) = theirs.col(static_cast<Eigen::Index>(joint->getIndexInSkeleton(0)));
    return ours;
  }
  dd::SkeletonPtr skeleton;
  dd::FreeJoint* base = nullptr;
  std::vector<std::pair<dd::Joint*, int>> columns;
  std::vector<VectorXd> q, v, dv, f;
};

}  // namespace

Kernels dart_kernels(const Problem& problem) {
  const auto w = std::make_shared<Dart>(problem);
  const std::string who = "DART " DART_VERSION;
  const auto rnea = [w](size_t i) {
    w->skeleton->setPositions(w->q[i]);
    w->skeleton->setVelocities(w->v[i]);
    w->skeleton->setAccelerations(w->dv[i]);
    w->skeleton->computeInverseDynamics();
  };
  const auto aba = [w](size_t i) {
    w->skeleton->setPositions(w->q[i]);
    w->skeleton->setVelocities(w->v[i]);
    w->skeleton->setForces(w->f[i]);
    w->skeleton->computeForwardDynamics();
  };
  const auto crba = [w](size_t i) {
    w->skeleton->setPositions(w->q[i]);
    return w->skeleton->getMassMatrix();
  };
  const auto cog = [w](size_t i) {
    w->skeleton->setPositions(w->q[i]);
    return Eigen::MatrixXd(w->skeleton->getCOMLinearJacobian());
  };
  return {{"RNEA", who, "", rnea,
           [w, rnea](size_t i) {
             rnea(i);
             return w->joints(w->skeleton->getForces());
           }},
          {"ABA", who, "", aba,
           [w, aba](size_t i) {
             aba(i);
             return w->joints(w->skeleton->getAccelerations());
           }},
          {"CRBA", who, "", [crba](size_t i) { crba(i); },
           [w, crba](size_t i) {
             return flat(w->joint_columns(
                 w->joint_columns(Eigen::MatrixXd(crba(i).transpose())).transpose()));
           }},
          {"COG Jacobian", who, "", [cog](size_t i) { cog(i); },
           [w, cog](size_t i) { return flat(w->joint_columns(cog(i))); }}};
}

}  // namespace ayumi::bench

#else

namespace ayumi::bench {
Kernels dart_kernels(const Problem&) { return {}; }
}  // namespace ayumi::bench

#endif
