#pragma once
// The members of the MuJoCo plant. This file is private to plant_mujoco.

#include <array>
#include <optional>

#include "ayumi/sim/ground.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_model.hpp"
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#include "ayumi/sim/servo.hpp"

namespace ayumi {

using MujocoData = std::unique_ptr<mjData, void (*)(mjData*)>;

inline void set_quaternion(mjtNum* to, const Eigen::Quaterniond& q) {
  to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
}

struct MujocoPlant::Impl {
  Impl(const RobotModel& robot, const ActuatorLimits& actuators, const World& ground_world,
       int steps_per_step)
      : steps(steps_per_step),
        model(&robot),
        limits(actuators),
        world(ground_world),
        ground(ground_world),
        points(outermost_points(contact_points(robot))),
        delay(actuators.servo),
        motor_torque(Eigen::VectorXd::Zero(robot.dof_count())),
        external(motor_torque) {
    // The points are small balls that are fixed to their bodies, so a cylinder rolls on its eight
    // corners.
    std::erase_if(points, [](const ContactPoint& point) { return point.rim > 0; });
    for (const auto& [side, sole] : robot.description().soles)
      soft_side[side == "right"] = sole.states_softness();
    build(false);
  }
  Impl(const Impl& o)
      : steps(o.steps),
        model(o.model),
        limits(o.limits),
        world(o.world),
        ground(o.ground),
        points(o.points),
        m(mj_copyModel(nullptr, o.m.get()), mj_deleteModel),
        d(mj_copyData(nullptr, o.m.get(), o.d.get()), mj_deleteData),
        bumps(o.bumps),
        velocity(o.velocity),
        body(o.body),
        gear(o.gear),
        point_of(o.point_of),
        soft_side(o.soft_side),
        plate(o.plate),
        floor_id(o.floor_id),
        loaded(o.loaded),
        carried(o.carried),
        floor(o.floor),
        rates(o.rates),
        delay(o.delay),
        motor_torque(o.motor_torque),
        external(o.external),
        state(o.state),
        data(o.data),
        report(o.report) {}

  void build(bool with_bumps);
  void set_inertias();
  void find_indices();
  void read_state();
  void take_input(const Eigen::VectorXd& targets, const StepInput& input);
  void load(const std::vector<CarriedMass>& payloads);
  void take_joints(const Eigen::VectorXd& targets, const StepInput& input);
  void take_servo(int j, double target, const JointFault& fault);
  void find_loads(double h);
  void report_motors();
  void take_bumps(const std::vector<RisingDisc>& now);
  void place_floor();
  void set_friction();
  const ContactPoint* point_of_contact(const mjContact& contact) const;
  void soften_contacts(double h);
  void move_ground(double dt);
  void apply(const ExternalWrench& w);
  void check_input(const Eigen::VectorXd& targets, const StepInput& input, double dt) const;
  void limit_torques();
  void account(double dt);
  void step(const Eigen::VectorXd& targets, const StepInput& input, double h);
  void integrate();
  bool has_diverged() const;
  void begin_report();
  void finish_report();
  void report_servos();
  void report_contacts();
  void report_contact(int index, const mjContact& contact, int geom, double sign);
  void share_among_cells(int side, const Eigen::Vector3d& at, const Eigen::Vector3d& force);
  const RobotModel& moving() const { return loaded ? *loaded : *model; }

  int steps;  // number of MuJoCo's steps in a step of the plant
  const RobotModel* model;
  ActuatorLimits limits;
  World world;
  Ground ground;
  std::vector<ContactPoint> points;
  MujocoModel m{nullptr, mj_deleteModel};
  MujocoData d{nullptr, mj_deleteData};
  bool bumps = false;               // whether the model has geoms for bumps
  std::vector<int> velocity, body;  // MuJoCo's index of each dof and body
  std::vector<int> gear;            // index of the joint of each dof's gear; -1 if there is none
  // Number of the point of each geom; -1 for the ground, and -2 - side for a plate.
  std::vector<int> point_of;
  // Whether the robot's file states the stiffness of the sole, by Side.
  std::array<bool, 2> soft_side = {false, false};
  std::array<int, 2> plate = {-1, -1};
  int floor_id = 0;
  std::optional<RobotModel> loaded;
  std::vector<CarriedMass> carried;
  FloorPose floor;            // pose of the floor in the last step
  std::vector<double> rates;  // rate at which a bump rises [m/s], by geom
  TargetDelay delay;
  Eigen::VectorXd motor_torque, external;  // torque on each dof in MuJoCo's last step [N m]
  RobotState state;
  RobotData data{*model};
  StepReport report;
  // Workspace.
  std::vector<double> weights;
  Eigen::VectorXd before, mean;  // rates of a step
};

}  // namespace ayumi
