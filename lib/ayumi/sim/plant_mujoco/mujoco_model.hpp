#pragma once
// The robot and its ground as a model of MuJoCo. This file is private to plant_mujoco.

#include <mujoco/mujoco.h>

#include <memory>
#include <string>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/ground_world.hpp"
#include "ayumi/sim/plant/contact_points.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// Radius of the balls at corners and of the rods along edges [m]. Chosen: small against the edges
/// of a sole and large against the penetration of a loaded contact.
constexpr double kMujocoBall = 0.0005;
/// Number of bumps that may exist at once. Chosen: one for each corner of a sole.
constexpr int kMujocoBumps = 4;

using MujocoModel = std::unique_ptr<mjModel, void (*)(mjModel*)>;

/// The model has a body "floor", which the plant moves, with the plane, the blocks (their top edges
/// as thin rods), the height field and, with `bumps`, the bumps. The robot has a ball at each
/// contact point and, where the ground is more than a plane, a plate per sole that touches edges
/// and fields between the corners. The caller sets the masses with set_inertia() and the placement
/// of the bodies. Throws Error(bad_model) with MuJoCo's message.
MujocoModel mujoco_model(const RobotModel& model, const std::vector<ContactPoint>& points,
                         const ActuatorLimits& limits, const World& world, bool bumps);

/// Whether the model has a joint for the gear of this servo, behind that of its motor.
inline bool mujoco_has_gear(const ServoDescription& servo) {
  return servo.kp > 0 && servo.has_gear();
}

/// The index of a named object; -1 if there is none.
int mujoco_id(const mjModel* m, mjtObj type, const std::string& name);

/// For a body with many points (as meshes have), only keeps the points that are farthest out in 26
/// directions, because MuJoCo moves and compares each point in each step.
std::vector<ContactPoint> outermost_points(const std::vector<ContactPoint>& points);

void set_inertia(const Inertia& inertia, int body, mjModel* m);
/// The geom of a part of bump `i`: 0..7 are the rods of its edges, 8 is its cylinder.
int bump_geom(const mjModel* m, int i, int part);
/// Places bump `i`, or removes it if `bump` is null.
void set_bump(const RisingDisc* bump, int i, mjModel* m);

}  // namespace ayumi
