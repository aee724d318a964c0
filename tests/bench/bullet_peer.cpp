#include "tests/bench/bench.hpp"

#ifdef BENCH_HAS_BULLET

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <Eigen/Eigenvalues>
#include <memory>

#include "ayumi/model/gravity.hpp"

namespace ayumi::bench {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

btVector3 bt(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion bt(const Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }

/// Bullet's copy of the robot. Its link frames are in the centres of mass, along the principal
/// axes.
struct Bullet {
  explicit Bullet(const Problem& problem) : problem(&problem), model(*problem.model) {
    const std::vector<Body>& bodies = model.bodies();
    for (const Body& body : bodies) {
      Eigen::SelfAdjointEigenSolver<Matrix3d> solver(body.inertia.about_com);
      Matrix3d axes = solver.eigenvectors();
      if (axes.determinant() < 0) axes.col(2) *= -1;
      principal.push_back(axes);
      moments.push_back(solver.eigenvalues());
    }
    robot = std::make_unique<btMultiBody>(static_cast<int>(bodies.size()) - 1,
                                          bodies[0].inertia.mass, bt(moments[0]), false, false);
    for (size_t i = 1; i < bodies.size(); ++i) {
      const Body& body = bodies[i];
      const auto p = static_cast<size_t>(body.parent);
      // The turn from the parent's principal axes to those of this link, with the joint at zero.
      const Matrix3d turn =
          principal[i].transpose() * body.placement.linear().transpose() * principal[p];
      const Vector3d to_pivot =
          principal[p].transpose() * (body.placement.translation() - bodies[p].inertia.com);
      const Vector3d to_com = principal[i].transpose() * body.inertia.com;
      const Vector3d axis = principal[i].transpose() * body.axis;
      const int link = static_cast<int>(i) - 1;
      if (body.prismatic)
        robot->setupPrismatic(link, body.inertia.mass, bt(moments[i]), body.parent - 1,
                              bt(Quaterniond(turn)), bt(axis), bt(to_pivot), bt(to_com), true);
      else
        robot->setupRevolute(link, body.inertia.mass, bt(moments[i]), body.parent - 1,
                             bt(Quaterniond(turn)), bt(axis), bt(to_pivot), bt(to_com), true);
    }
    robot->finalizeMultiDof();
    robot->setLinearDamping(0);
    robot->setAngularDamping(0);
    robot->setUseGyroTerm(true);
    robot->setMaxCoordinateVelocity(1e9);
    robot->setMaxAppliedImpulse(1e9);
  }

  void place(size_t i) {
    const RobotState& s = problem->states[i];
    const Matrix3d R = s.base.attitude.toRotationMatrix();
    const Vector3d offset = R * model.bodies()[0].inertia.com;
    robot->setBasePos(bt(Vector3d(s.base.position + offset)));
    robot->setWorldToBaseRot(bt(Quaterniond(Matrix3d(R * principal[0]))).inverse());
    robot->setBaseVel(bt(Vector3d(s.base_velocity + s.base_angular_velocity.cross(offset))));
    robot->setBaseOmega(bt(s.base_angular_velocity));
    for (int link = 0; link < robot->getNumLinks(); ++link) {
      const int dof = model.bodies()[static_cast<size_t>(link) + 1].dof;
      robot->setJointPos(link, s.theta[dof]);
      robot->setJointVel(link, s.dtheta[dof]);
    }
  }
  void accelerate(size_t i) {
    place(i);
    const VectorXd& f = problem->forces[i];
    robot->clearForcesAndTorques();
    const Vector3d arm = problem->states[i].base.attitude * model.bodies()[0].inertia.com;
    const Vector3d gravity(0, 0, -kGravity);
    robot->addBaseForce(bt(Vector3d(f.head<3>() + model.bodies()[0].inertia.mass * gravity)));
    robot->addBaseTorque(bt(Vector3d(f.segment<3>(3) - arm.cross(f.head<3>()))));
    for (int link = 0; link < robot->getNumLinks(); ++link) {
      const Body& body = model.bodies()[static_cast<size_t>(link) + 1];
      robot->addLinkForce(link, bt(Vector3d(body.inertia.mass * gravity)));
      robot->addJointTorque(link, f[6 + body.dof]);
    }
    robot->computeAccelerationsArticulatedBodyAlgorithmMultiDof(kStep, scratch, vectors, matrices,
                                                                false, false, false);
  }
  VectorXd accelerations(size_t i) {
    VectorXd result(model.dof_count());
    for (int link = 0; link < robot->getNumLinks(); ++link) {
      const int dof = model.bodies()[static_cast<size_t>(link) + 1].dof;
      result[dof] = (robot->getJointVel(link) - problem->states[i].dtheta[dof]) / kStep;
    }
    return result;
  }
  // Bullet adds the acceleration times this step to the velocity.
  static constexpr double kStep = 1.0;
  const Problem* problem;
  const RobotModel& model;
  std::vector<Matrix3d> principal;
  std::vector<Vector3d> moments;
  std::unique_ptr<btMultiBody> robot;
  btAlignedObjectArray<btScalar> scratch;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
};

}  // namespace

Kernels bullet_kernels(const Problem& problem) {
  const auto w = std::make_shared<Bullet>(problem);
  return {{"ABA", "Bullet " BENCH_BULLET_VERSION, "double precision",
           [w](size_t i) { w->accelerate(i); },
           [w](size_t i) {
             w->accelerate(i);
             return w->accelerations(i);
           }}};
}

}  // namespace ayumi::bench

#else

namespace ayumi::bench {
Kernels bullet_kernels(const Problem&) { return {}; }
}  // namespace ayumi::bench

#endif
