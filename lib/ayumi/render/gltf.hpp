#pragma once
// A robot with its motions as binary glTF 2.0 (.glb), for Blender, viewers and the report. There is
// one node per body below a node that turns the world's z upwards into glTF's y, one material per
// colour, and one animation per motion.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The places of a robot at increasing times.
struct Motion {
  std::string name;            ///< name of the animation
  std::vector<double> times;   ///< increasing times [s]
  std::vector<BasePose> base;  ///< base in the world, one per time
  Eigen::MatrixXd theta;       ///< joint positions, dof x times [rad] or [m]
};

enum class MotionSource { run, command, reference };
const char* name_of(MotionSource source);

/// The postures of a log at begin, begin + 1/rate, ..., and at its end. Throws Error(usage) if the
/// log has no samples or the rate is not above 0, and Error(bad_file) if the log does not have the
/// requested postures.
Motion motion_of(const SimulationLog& log, MotionSource source, double rate, double begin = 0,
                 double end = -1);

/// The rows of a table at times 1/rate apart, and the last row; the motion is named "reference".
/// Throws Error(usage) if there are no rows or the rate is not above 0.
Motion motion_of(const ReferenceTrajectory& table, double rate);

struct GltfOptions {
  const RobotLook* look = nullptr;  ///< look that is drawn instead of the robot's own meshes
  /// Number of triangles beyond which the surface is simplified; 0 for no limit.
  size_t max_triangles = 0;
};

/// The bytes of a .glb file. The same input gives the same bytes. Throws Error(usage) for a motion
/// of another robot.
std::string glb_bytes(const RobotModel& model, const std::vector<Motion>& motions,
                      const GltfOptions& options = {});

}  // namespace ayumi
