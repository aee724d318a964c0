#include "tests/bench/bench.hpp"

#ifdef BENCH_HAS_MUJOCO

#include <memory>

#include "tests/support/mujoco_model.hpp"

namespace ayumi::bench {

using Eigen::VectorXd;

namespace {

/// MuJoCo's copy of the robot with the problem in its own coordinates.
struct Mujoco {
  explicit Mujoco(const Problem& problem) : robot(test::MujocoRobot::from_model(*problem.model)) {
    const_cast<mjModel*>(m())->opt.disableflags |= mjDSBL_CONSTRAINT | mjDSBL_SENSOR;
    const auto n = static_cast<Eigen::Index>(m()->nv);
    for (size_t i = 0; i < problem.states.size(); ++i) {
      robot.set_state(problem.states[i]);
      q.push_back(Eigen::Map<VectorXd>(d()->qpos, m()->nq));
      v.push_back(Eigen::Map<VectorXd>(d()->qvel, n));
      a.push_back(robot.to_theirs() * problem.accelerations[i]);
      f.push_back(robot.to_theirs() * problem.forces[i]);
    }
    result = VectorXd::Zero(n);
    jacobian = VectorXd::Zero(3 * n);
    to_ours = robot.to_theirs().transpose();  // of joint parts; it is the same in every state
  }
  const mjModel* m() const { return robot.model(); }
  mjData* d() const { return robot.data(); }
  static void put(const VectorXd& from, mjtNum* to) {
    Eigen::Map<VectorXd>(to, from.size()) = from;
  }
  /// Computes the kinematics with which every kernel of MuJoCo starts.
  void place(size_t i) {
    put(q[i], d()->qpos);
    mj_kinematics(m(), d());
    mj_comPos(m(), d());
  }
  test::MujocoRobot robot;
  std::vector<VectorXd> q, v, a, f;
  VectorXd result, jacobian;
  Eigen::MatrixXd to_ours;
};

}  // namespace

Kernels mujoco_kernels(const Problem& problem) {
  const auto w = std::make_shared<Mujoco>(problem);
  const std::string who = std::string("MuJoCo ") + mj_versionString();
  const auto rnea = [w](size_t i) {
    w->place(i);
    Mujoco::put(w->v[i], w->d()->qvel);
    Mujoco::put(w->a[i], w->d()->qacc);
    mj_comVel(w->m(), w->d());
    mj_rne(w->m(), w->d(), 1, w->result.data());
  };
  const auto aba = [w](size_t i) {
    Mujoco::put(w->q[i], w->d()->qpos);
    Mujoco::put(w->v[i], w->d()->qvel);
    Mujoco::put(w->f[i], w->d()->qfrc_applied);
    mj_forward(w->m(), w->d());
  };
  const auto crba = [w](size_t i) {
    w->place(i);
    mj_crb(w->m(), w->d());
  };
  const auto factored = [w, crba](size_t i) {
    crba(i);
    mj_factorM(w->m(), w->d());
  };
  const auto cog = [w](size_t i) {
    w->place(i);
    mj_jacSubtreeCom(w->m(), w->d(), w->jacobian.data(), 1);
  };
  const int n = problem.model->dof_count();
  return {{"RNEA", who, "kinematics, comPos, comVel, rne", rnea,
           [w, rnea](size_t i) -> VectorXd {
             rnea(i);
             return joint_part(w->to_ours * w->result);
           }},
          {"ABA", who, "mj_forward without constraints", aba,
           [w, aba](size_t i) -> VectorXd {
             aba(i);
             return joint_part(w->to_ours * Eigen::Map<VectorXd>(w->d()->qacc, w->m()->nv));
           }},
          {"CRBA", who, "kinematics, comPos, crb", crba,
           [w, crba, n](size_t i) -> VectorXd {
             crba(i);
             return flat(w->robot.mass_matrix().bottomRightCorner(n, n));
           }},
          {"CRBA and factor", who, "and factorM", factored, {}},
          {"COG Jacobian", who, "kinematics, comPos, jacSubtreeCom", cog,
           [w, cog, n](size_t i) -> VectorXd {
             cog(i);
             return flat(w->robot.cog_jacobian().rightCols(n));
           }}};
}

}  // namespace ayumi::bench

#else

namespace ayumi::bench {
Kernels mujoco_kernels(const Problem&) { return {}; }
}  // namespace ayumi::bench

#endif
