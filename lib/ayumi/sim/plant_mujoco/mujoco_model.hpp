#pragma once
// The robot and its ground as MuJoCo's compiler takes them. Seen within plant_mujoco only.

#include <mujoco/mujoco.h>

#include <memory>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/ground_world.hpp"
#include "ayumi/sim/plant/contact_points.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

constexpr double kMujocoBall = 0.0005;  ///< radius of balls at corners, of rods along edges [m]
constexpr int kMujocoBumps = 4;         ///< discs that may stand out of the ground at once

using MujocoModel = std::unique_ptr<mjModel, void (*)(mjModel*)>;

/// A body "floor" that the plant places, with plane, blocks (their top edges as thin rods), field
/// and room for bumps; the robot with a ball at each contact point and, where the ground is more
/// than a plane, a plate per sole that meets edges and fields between the corners. Masses and
/// places of the robot are left to set_inertia() and whoever sets body_pos. Throws
/// Error(bad_model) with MuJoCo's complaint.
MujocoModel mujoco_model(const RobotModel& model, const std::vector<ContactPoint>& points,
                         const ActuatorLimits& limits, const World& world, bool bumps);

/// Index by name; -1 when there is none.
int mujoco_id(const mjModel* m, mjtObj type, const std::string& name);

void set_inertia(const Inertia& inertia, int body, mjModel* m);
/// Geom of a part of bump `i`: rods of its edges 0..7, its cylinder 8.
int bump_geom(const mjModel* m, int i, int part);
/// Bump `i` as it is now; nothing there when `bump` is null.
void set_bump(const Bump* bump, int i, mjModel* m);

}  // namespace ayumi
