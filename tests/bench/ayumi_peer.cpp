#include <memory>

#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "tests/bench/bench.hpp"

namespace ayumi::bench {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

struct Workspace {
  explicit Workspace(const Problem& problem)
      : model(*problem.model), data(model), fast(model), factor(model) {
    for (size_t first = 0; first + kBatch <= problem.states.size(); first += kBatch) {
      MatrixXd a(model.velocity_count(), kBatch), f = a;
      for (size_t k = 0; k < kBatch; ++k) {
        a.col(static_cast<Eigen::Index>(k)) = problem.accelerations[first + k];
        f.col(static_cast<Eigen::Index>(k)) = problem.forces[first + k];
      }
      accelerations.push_back(a);
      forces.push_back(f);
    }
  }
  static constexpr size_t kBatch = 16;
  const RobotModel& model;
  RobotData data;
  TreeDynamics fast;
  TreeCholesky factor;
  VectorXd vector;
  MatrixXd M, J, batch;
  InverseDynamicsDerivatives inverse;
  ForwardDynamicsDerivatives forward;
  std::vector<MatrixXd> accelerations, forces;
};

}  // namespace

Kernels ayumi_kernels(const Problem& problem) {
  const auto w = std::make_shared<Workspace>(problem);
  const Problem* p = &problem;
  const std::span<const RobotState> states(problem.states);
  auto joints = [w](const auto& run) {
    return [w, run](size_t i) -> VectorXd {
      run(i);
      return joint_part(w->vector);
    };
  };
  auto batch_of = [](size_t i) { return i * Workspace::kBatch; };
  const auto rnea = [w, p](size_t i) {
    w->fast.inverse(p->states[i], p->accelerations[i], w->vector);
  };
  const auto aba = [w, p](size_t i) { w->fast.forward(p->states[i], p->forces[i], w->vector); };
  const auto crba = [w, p](size_t i) { w->fast.mass_matrix(p->states[i], w->M); };
  const auto crba_rows = [w, p](size_t i) {
    update_positions(w->model, p->states[i], w->data);
    std::vector<double>& rows = w->factor.rows();
    std::fill(rows.begin(), rows.end(), 0.0);
    w->data.kernels->mass_entries(w->data.tree(), w->data.bodies(), w->factor.layout(),
                                  rows.data());
  };
  const auto factored = [w, crba_rows](size_t i) {
    crba_rows(i);
    w->factor.factor_rows();
  };
  const auto cog = [w, p](size_t i) {
    update_positions(w->model, p->states[i], w->data);
    held_base_cog_jacobian(w->model, w->data, w->J);
  };
  const auto cog_anchored = [w, p](size_t i) {
    update_positions(w->model, p->states[i], w->data);
    cog_jacobian(w->model, w->data, Side::left, w->J);
  };
  const auto rnea_derivatives = [w, p](size_t i) {
    w->fast.inverse_derivatives(p->states[i], p->accelerations[i], w->inverse);
  };
  const auto aba_derivatives = [w, p](size_t i) {
    w->fast.forward_derivatives(p->states[i], p->forces[i], w->forward);
  };
  const auto rnea_batch = [w, states, batch_of](size_t i) {
    w->fast.inverse(states.subspan(batch_of(i), Workspace::kBatch), w->accelerations[i], w->batch);
  };
  const auto aba_batch = [w, states, batch_of](size_t i) {
    w->fast.forward(states.subspan(batch_of(i), Workspace::kBatch), w->forces[i], w->batch);
  };
  const std::string lanes = std::string(w->fast.instruction_set()) + ", batches of 16 states";
  const int n = w->model.dof_count();
  auto joint_block = [w, n](const MatrixXd& m) { return flat(m.bottomRightCorner(n, n)); };
  Kernels kernels;
  kernels.push_back({"RNEA", "Ayumi", "", rnea, joints(rnea)});
  kernels.push_back({"RNEA", "Ayumi, batch", lanes, rnea_batch,
                     [w, rnea_batch](size_t i) -> VectorXd {
                       rnea_batch(i / Workspace::kBatch);
                       return joint_part(
                           w->batch.col(static_cast<Eigen::Index>(i % Workspace::kBatch)));
                     },
                     Workspace::kBatch});
  kernels.push_back({"ABA", "Ayumi", "", aba, joints(aba)});
  kernels.push_back({"ABA", "Ayumi, batch", lanes, aba_batch,
                     [w, aba_batch](size_t i) -> VectorXd {
                       aba_batch(i / Workspace::kBatch);
                       return joint_part(
                           w->batch.col(static_cast<Eigen::Index>(i % Workspace::kBatch)));
                     },
                     Workspace::kBatch});
  kernels.push_back({"CRBA", "Ayumi", "with kinematics", crba, [w, crba, joint_block](size_t i) {
                       crba(i);
                       return joint_block(w->M);
                     }});
  kernels.push_back({"CRBA", "Ayumi, sparse", "rows of the factor, as the plant needs it",
                     crba_rows, [w, crba_rows, joint_block](size_t i) {
                       crba_rows(i);
                       const TreeCholesky& t = w->factor;
                       w->M.setZero(w->model.velocity_count(), w->model.velocity_count());
                       for (int k = 0; k < w->M.rows(); ++k)
                         for (int j = k; j >= 0; j = t.parent(j))
                           w->M(t.column_at(k), t.column_at(j)) =
                               w->M(t.column_at(j), t.column_at(k)) = t.below(k, j);
                       return joint_block(w->M);
                     }});
  kernels.push_back({"CRBA and factor", "Ayumi", "with kinematics", factored, {}});
  kernels.push_back({"COG Jacobian", "Ayumi", "with kinematics", cog, [w, cog](size_t i) {
                       cog(i);
                       return flat(w->J);
                     }});
  kernels.push_back({"COG Jacobian, sole held", "Ayumi", "with kinematics", cog_anchored, {}});
  kernels.push_back({"RNEA derivatives", "Ayumi", "by q, v and a", rnea_derivatives,
                     [w, rnea_derivatives, joint_block](size_t i) -> VectorXd {
                       rnea_derivatives(i);
                       VectorXd all(3 * w->model.dof_count() * w->model.dof_count());
                       all << joint_block(w->inverse.configuration),
                           joint_block(w->inverse.velocity), joint_block(w->inverse.acceleration);
                       return all;
                     }});
  kernels.push_back({"ABA derivatives", "Ayumi", "by q, v and tau", aba_derivatives,
                     [w, aba_derivatives, joint_block](size_t i) -> VectorXd {
                       aba_derivatives(i);
                       VectorXd all(3 * w->model.dof_count() * w->model.dof_count());
                       all << joint_block(w->forward.configuration),
                           joint_block(w->forward.velocity), joint_block(w->forward.force);
                       return all;
                     }});
  return kernels;
}

}  // namespace ayumi::bench
