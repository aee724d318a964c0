// Random robots as URDF text are compared with a MuJoCo model that is written from the same numbers
// without the library: both the robot that is read and its dynamics.

#include <gtest/gtest.h>

#ifdef AYUMI_HAS_MUJOCO

#include <mujoco/mujoco.h>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/odd_urdf.hpp"
#include "tests/support/relative_error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using Eigen::Isometry3d;
using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using test::relative_error;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The robot with every joint free, in MuJoCo, and the equations that tie its joints.
class Judge {
 public:
  explicit Judge(const test::OddRobot& robot) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("odd.xml", test::mujoco_text(robot));
    char error[1000] = "";
    model.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
    if (!model) throw std::runtime_error(error);
    data.reset(mj_makeData(model.get()));
    for (const test::OddLink& link : robot.links) {
      if (link.mass > 0) continue;
      const int body = mj_name2id(model.get(), mjOBJ_BODY, link.name.c_str());
      model->body_mass[body] = 0;
      Map<Vector3d>(model->body_inertia + 3 * body).setZero();
    }
    for (int i = 0; i < model->nbody; ++i) model->body_simple[i] = model->body_sameframe[i] = 0;
    for (int i = 0; i < model->nv; ++i) model->dof_simplenum[i] = 0;
    mj_setConst(model.get(), data.get());
    Map<Vector3d>(model->opt.gravity) = Vector3d(0, 0, -kGravity);
  }

  /// Sets the state and fills `T`, which gives MuJoCo's velocities from Ayumi's.
  void set_state(const test::OddRobot& robot, const RobotModel& ours, const RobotState& s) {
    mjData* d = data.get();
    const Eigen::Quaterniond& q = s.base.attitude;
    Map<Vector3d>(d->qpos) = s.base.position;
    d->qpos[3] = q.w(), d->qpos[4] = q.x(), d->qpos[5] = q.y(), d->qpos[6] = q.z();
    T = MatrixXd::Zero(model->nv, ours.velocity_count());
    T.topLeftCorner<3, 3>().setIdentity();
    T.block<3, 3>(3, 3) = q.toRotationMatrix().transpose();
    for (const test::OddJoint& joint : robot.joints) {
      if (!joint.moves()) continue;
      const int id = mj_name2id(model.get(), mjOBJ_JOINT, joint.name.c_str());
      const auto tie = robot.tie(joint.name);
      const int dof = ours.find_dof(tie.driver);
      ASSERT_GE(dof, 0) << joint.name;
      d->qpos[model->jnt_qposadr[id]] = tie.factor * s.theta[dof] + tie.offset;
      T(model->jnt_dofadr[id], 6 + dof) = tie.factor;
    }
    VectorXd v(ours.velocity_count());
    v << s.base_velocity, s.base_angular_velocity, s.dtheta;
    Map<VectorXd>(d->qvel, model->nv) = T * v;
    mj_forward(model.get(), d);
  }

  MatrixXd mass_matrix() const {
    RowMajor full(model->nv, model->nv);
    mj_fullM(model.get(), full.data(), data->qM);
    return T.transpose() * full * T;
  }
  VectorXd bias() const { return T.transpose() * Map<VectorXd>(data->qfrc_bias, model->nv); }
  MatrixXd cog_jacobian() const {
    RowMajor J(3, model->nv);
    mj_jacSubtreeCom(model.get(), data.get(), J.data(), 1);
    return J * T;
  }
  /// The Jacobian of a point of a body: linear over angular.
  MatrixXd jacobian(int body, const Vector3d& point) const {
    RowMajor linear(3, model->nv), angular(3, model->nv);
    mj_jac(model.get(), data.get(), linear.data(), angular.data(), point.data(), body);
    MatrixXd J(6, T.cols());
    J << linear * T, angular * T;
    return J;
  }
  Isometry3d pose(int body) const {
    Isometry3d result = Isometry3d::Identity();
    result.translation() = Map<Vector3d>(data->xpos + 3 * body);
    result.linear() = Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * body);
    return result;
  }
  int body(const std::string& name) const {
    return mj_name2id(model.get(), mjOBJ_BODY, name.c_str());
  }

  struct Free {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
    void operator()(mjData* d) const { mj_deleteData(d); }
  };
  std::unique_ptr<mjModel, Free> model;
  std::unique_ptr<mjData, Free> data;
  MatrixXd T;
};

class OddUrdf : public testing::TestWithParam<unsigned> {
 protected:
  OddUrdf()
      : robot(test::odd_robot(GetParam(), 6 + static_cast<int>(GetParam() % 20))),
        model(parse_urdf(test::urdf_text(robot, GetParam()), "odd.urdf")),
        judge(robot),
        random(GetParam() + 60) {}

  test::OddRobot robot;
  RobotModel model;
  Judge judge;
  test::Random random;
};

TEST_P(OddUrdf, AgreesWithMujoco) {
  RobotData data(model);
  TreeDynamics fast(model);
  MatrixXd M;
  VectorXd found;
  for (int trial = 0; trial < 25; ++trial) {
    const RobotState state = test::random_state(model, random);
    judge.set_state(robot, model, state);
    update_velocities(model, state, data);
    for (const Link& link : model.links()) {
      const int body = judge.body(link.name);
      const Isometry3d pose = data.pose(link.body) * link.pose;
      ASSERT_LT((pose.matrix() - judge.pose(body).matrix()).norm(), 1e-11) << link.name;
      const Vector3d point = pose * random.vector(0.1);
      ASSERT_LT(
          relative_error(body_jacobian(model, data, link.body, point), judge.jacobian(body, point)),
          1e-11)
          << link.name;
    }
    mass_matrix(model, data, M);
    const VectorXd bias = bias_force(model, state, data);
    const VectorXd force = random.vector(model.velocity_count(), 3.0);
    EXPECT_LT(relative_error(M, judge.mass_matrix()), 1e-9);
    EXPECT_LT(relative_error(bias, judge.bias()), 1e-9);
    fast.forward(state, force, found);
    // The forces for the accelerations are compared, because an ill-conditioned mass matrix
    // amplifies the rounding of accelerations.
    EXPECT_LT(relative_error(judge.mass_matrix() * found + judge.bias(), force), 1e-9);
    EXPECT_LT((data.cog - Map<Vector3d>(judge.data->subtree_com)).norm(), 1e-12);
    EXPECT_LT(relative_error(cog_jacobian_floating(model, data), judge.cog_jacobian()), 1e-9);
    const Momentum momentum = centroidal_momentum(model, data);
    mj_subtreeVel(judge.model.get(), judge.data.get());
    EXPECT_LT(relative_error(momentum.angular, Map<Vector3d>(judge.data->subtree_angmom)), 1e-9);
    EXPECT_LT(
        relative_error(momentum.linear, model.mass() * Map<Vector3d>(judge.data->subtree_linvel)),
        1e-9);
  }
}

/// The state a little further along one direction of the generalised velocity.
RobotState stepped(const RobotState& state, const VectorXd& direction, double h) {
  RobotState s = state;
  s.base.position += h * direction.head<3>();
  s.base.attitude = exp_rotation(h * direction.segment<3>(3)) * state.base.attitude;
  s.theta += h * direction.tail(state.theta.size());
  return s;
}

// Derivatives of RNEA and ABA along random directions, against differences of four points; and
// M a + b = RNEA(a), RNEA(ABA(f)) = f.
TEST_P(OddUrdf, DerivativesMatchDifferencesAndRoutesMeet) {
  TreeDynamics dynamics(model);
  RobotData data(model);
  MatrixXd M;
  InverseDynamicsDerivatives d;
  ForwardDynamicsDerivatives forward;
  const int n = model.velocity_count();
  for (int trial = 0; trial < 4; ++trial) {
    const RobotState state = test::random_state(model, random);
    const VectorXd a = random.vector(n, 3.0), u = random.vector(n, 1.0);
    VectorXd force, back;
    dynamics.inverse(state, a, force);
    update_velocities(model, state, data);
    mass_matrix(model, data, M);
    EXPECT_LT((M * a + bias_force(model, state, data) - force).norm(),
              1e-12 * (M.norm() * a.norm() + force.norm()));
    dynamics.forward(state, force, back);
    VectorXd again;
    dynamics.inverse(state, back, again);
    EXPECT_LT((again - force).norm(), 1e-12 * (M.norm() * back.norm() + force.norm()));

    const auto difference = [&](auto at) {
      const double h = 1e-3;
      return VectorXd((8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h));
    };
    const auto faster = [&](double h) {
      RobotState s = state;
      s.base_velocity += h * u.head<3>();
      s.base_angular_velocity += h * u.segment<3>(3);
      s.dtheta += h * u.tail(n - 6);
      return s;
    };
    dynamics.inverse_derivatives(state, a, d);
    const auto rnea = [&](const RobotState& s) {
      VectorXd f;
      dynamics.inverse(s, a, f);
      return f;
    };
    const VectorXd by_q = difference([&](double h) { return rnea(stepped(state, u, h)); });
    const VectorXd by_v = difference([&](double h) { return rnea(faster(h)); });
    EXPECT_LT((d.configuration * u - by_q).norm(), 1e-6 * by_q.norm());
    EXPECT_LT((d.velocity * u - by_v).norm(), 1e-6 * by_v.norm());
    EXPECT_LT((d.acceleration - M).norm(), 1e-12 * M.norm());

    dynamics.forward_derivatives(state, force, forward);
    const auto aba = [&](const RobotState& s) {
      VectorXd x;
      dynamics.forward(s, force, x);
      return x;
    };
    const VectorXd a_by_v = difference([&](double h) { return aba(faster(h)); });
    EXPECT_LT((forward.velocity * u - a_by_v).norm(), 1e-6 * a_by_v.norm());
    EXPECT_LT((M * forward.force - MatrixXd::Identity(n, n)).norm(),
              1e-12 * M.norm() * forward.force.norm());
    EXPECT_LT((M * forward.configuration + d.configuration).norm(),
              1e-6 * (M.norm() * forward.configuration.norm()));
  }
}

// The same robot on a floating joint below a link that is only a frame.
TEST_P(OddUrdf, IsTheSameWhereTheFileSaysThatItFloats) {
  std::string text = test::urdf_text(robot, GetParam());
  text.insert(
      text.find('\n') + 1,
      "  <link name=\"world\"/><joint name=\"afloat\" type=\"floating\"><parent "
      "link=\"world\"/><child link=\"part0\"/><origin xyz=\"1 2 3\" rpy=\"0 0 1\"/></joint>\n");
  const RobotModel floating(parse_urdf(text, "odd.urdf"));
  ASSERT_EQ(floating.dof_names(), model.dof_names());
  EXPECT_EQ(floating.mass(), model.mass());
  const RobotState state = test::random_state(model, random);
  RobotData data(model), other(floating);
  EXPECT_EQ(bias_force(model, state, data), bias_force(floating, state, other));
  const Link& world = floating.links()[static_cast<size_t>(floating.find_link("world"))];
  EXPECT_EQ(world.body, 0);
  EXPECT_LT((world.pose * Vector3d(1, 2, 3)).norm(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OddUrdf, testing::Range(1u, 41u));

}  // namespace
}  // namespace ayumi

#else

TEST(OddUrdf, AgreesWithMujoco) { GTEST_SKIP() << "MuJoCo was not found when this was configured"; }

#endif
