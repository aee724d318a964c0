#pragma once
// A robot with its motions as binary glTF 2.0 (.glb), for Blender, viewers and the report. One node
// per body below a node that turns the world's z upwards into glTF's y; one material per colour;
// one animation per motion.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Where a robot is at increasing times.
struct Motion {
  std::string name;            ///< of the animation
  std::vector<double> times;   ///< [s]
  std::vector<BasePose> base;  ///< one per time, world
  Eigen::MatrixXd theta;       ///< dof x times [rad] or [m]
};

enum class MotionSource { run, command, reference };
const char* name_of(MotionSource source);

/// Postures of a log at begin, begin + 1/rate, ..., and at its end. Throws Error(usage) when the
/// log has no samples or a rate not above 0, Error(bad_file) when it lacks that posture.
Motion motion_of(const SimulationLog& log, MotionSource source, double rate, double begin = 0,
                 double end = -1);

/// Rows of a table 1/rate apart, and the last; named "reference". Throws Error(usage) for no rows
/// or a rate not above 0.
Motion motion_of(const ReferenceTrajectory& table, double rate);

struct GltfOptions {
  const RobotLook* look = nullptr;  ///< drawn in place of the robot's own meshes
  size_t max_triangles = 0;         ///< beyond it the surface is simplified; 0: never
};

/// The bytes of a .glb file. The same input gives the same bytes. Throws Error(usage) for a motion
/// of another robot.
std::string glb_bytes(const RobotModel& model, const std::vector<Motion>& motions,
                      const GltfOptions& options = {});

}  // namespace ayumi
