#pragma once
// The same robot in the same states for Ayumi and for every other library that was found: the jobs
// that each can do, and a measurement in interleaved rounds, so that a busy machine slows all of
// them equally.

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"

namespace ayumi::bench {

/// A robot and random states of it, with accelerations and forces (6+dof, in Ayumi's conventions).
struct Problem {
  Problem(const RobotModel& robot, int count);
  const RobotModel* model;
  std::vector<RobotState> states;
  std::vector<Eigen::VectorXd> accelerations, forces;
};

/// One job of one library.
struct Kernel {
  std::string job;                  ///< name of the job, such as "RNEA" or "ABA"
  std::string who;                  ///< name of the library, such as "Ayumi" or "MuJoCo"
  std::string note;                 ///< what is done differently, if it is not quite the same job
  std::function<void(size_t)> run;  ///< does the job on state i of the problem
  /// The result of `run` on state i in Ayumi's conventions, as the same list of numbers for every
  /// library. If it is empty, results are not compared.
  std::function<Eigen::VectorXd(size_t)> result;
  int states_per_call = 1;
};

using Kernels = std::vector<Kernel>;
Kernels ayumi_kernels(const Problem& problem);
Kernels mujoco_kernels(const Problem& problem);
Kernels dart_kernels(const Problem& problem);
Kernels bullet_kernels(const Problem& problem);
Kernels pinocchio_kernels(const Problem& problem);
Kernels rbdl_kernels(const Problem& problem);
/// A tick of the closed loop on the walking pattern, from the beginning of the run, for each plant.
Kernels tick_kernels();

/// The parts of the base differ between libraries (axes, order), while the joint parts do not.
inline Eigen::VectorXd joint_part(const Eigen::VectorXd& v) { return v.tail(v.size() - 6); }
inline Eigen::VectorXd flat(const Eigen::MatrixXd& m) {
  return Eigen::Map<const Eigen::VectorXd>(m.data(), m.size());
}

/// The largest difference from the first kernel of the same job over some states, relative to its
/// norm; -1 if there is nothing to compare.
double disagreement(const Kernels& kernels, const Kernel& kernel, const Problem& problem);

/// The median over rounds of the median time per state [ns], by kernel.
std::vector<double> measure(const Kernels& kernels, const Problem& problem, int rounds,
                            double seconds_per_round);

/// The real walking pattern in the closed loop, on Ayumi's plant and on MuJoCo's. Prints speed and
/// physics.
int run_closed_loop(int rounds);

}  // namespace ayumi::bench
