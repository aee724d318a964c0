#pragma once
// A run folder in which HOAP-1 stands, for tests of the commands that show runs.

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "tests/cli/program.hpp"

namespace ayumi::test {

inline RobotModel hoap1(bool meshes) {
  return load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/hoap1", {}, {.meshes = meshes});
}

/// A log in which the robot stands still for a fifth of a second with its soles on the ground.
inline SimulationLog standing(const RobotModel& model) {
  SimulationSample sample;
  sample.state = model.rest_state();
  RobotData data(model);
  Eigen::Isometry3d sole = Eigen::Isometry3d::Identity();
  sole.translation() = Eigen::Vector3d(0, 0.039, 0);
  anchor_base(model, Side::left, sole, sample.state, data);
  sample.cog = sample.command_cog = data.cog;
  sample.zmp = sample.reference_zmp = {data.cog.x(), 0, 0};
  sample.fz = sample.command_fz = 9.80665 * model.mass();
  sample.target = sample.torque = sample.reference_theta = sample.command_theta =
      sample.state.theta;
  sample.reference_base = sample.command_base = sample.state.base;
  sample.state.dtheta = sample.reference_dtheta = sample.weight =
      Eigen::VectorXd::Zero(model.dof_count());
  SimulationLog log;
  log.controller = ControllerKind::dtad;
  log.provenance.robot = "hoap1";
  log.provenance.pattern = "stand";
  log.joints = model.dof_names();
  log.samples.assign(201, sample);
  log.result.outcome = Outcome::stands;
  return log;
}

class OnARun : public testing::Test {
 protected:
  static void SetUpTestSuite() { log = standing(hoap1(false)); }
  void SetUp() override {
    RunFolder run;
    run.provenance = log.provenance;
    run.logs["closed_loop"] = log;
    run.logs["open_loop"] = log;
    run.logs["open_loop"].controller = ControllerKind::none;
    write_run(folder / "run", run);
  }
  Output ayumi(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "-q");
    return run_program(arguments, folder.path());
  }
  Folder folder;
  static inline SimulationLog log;
};

}  // namespace ayumi::test
