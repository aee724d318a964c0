// Robots: reading them, their joints, links and limits, and the state of a robot.

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "bindings.hpp"
#include "watch.hpp"

namespace ayumi::python {

namespace {

RobotData data_of(const RobotModel& model, const RobotState& state) {
  if (state.theta.size() != model.dof_count())
    fail(ErrorCode::usage, "the state has " + std::to_string(state.theta.size()) +
                               " joint angles, but robot '" + model.name() + "' has " +
                               std::to_string(model.dof_count()) + " joints");
  RobotData data(model);
  update_positions(model, state, data);
  return data;
}

/// One member of all dofs, as a view whose stride is the size of a Dof.
py::array dof_view(const py::object& self, double Dof::*member) {
  const auto& dofs = self.cast<const RobotModel&>().dofs();
  return view_of(&(dofs.front().*member), {static_cast<py::ssize_t>(dofs.size())},
                 {static_cast<py::ssize_t>(sizeof(Dof))}, self);
}

/// Length below which a quaternion is no attitude. Chosen: rounding turns a shorter one noticeably.
constexpr double kShortestQuaternion = 1e-6;

void require_finite(const char* what, const Eigen::Ref<const Eigen::VectorXd>& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      fail(ErrorCode::usage, std::string(what) + " of the state has the value " +
                                 text::exact(values[i]) + " at index " + std::to_string(i) +
                                 "; finite numbers are expected");
}

void bind_state(py::module_& m) {
  py::class_<RobotState>(
      m, "RobotState",
      "State of a robot: base pose and velocity in the world, joint angles and rates.")
      .def(py::init([](const Eigen::VectorXd& theta, const std::optional<Eigen::VectorXd>& dtheta,
                       const Eigen::Vector3d& position, const Eigen::Vector4d& attitude,
                       const Eigen::Vector3d& velocity, const Eigen::Vector3d& angular_velocity) {
             RobotState state;
             state.theta = theta;
             state.dtheta = dtheta.value_or(Eigen::VectorXd::Zero(theta.size()));
             if (state.dtheta.size() != theta.size())
               fail(ErrorCode::usage, "dtheta has " + std::to_string(state.dtheta.size()) +
                                          " values, theta has " + std::to_string(theta.size()));
             require_finite("theta", theta);
             require_finite("dtheta", state.dtheta);
             require_finite("position", position);
             require_finite("attitude", attitude);
             require_finite("velocity", velocity);
             require_finite("angular_velocity", angular_velocity);
             const double length = attitude.norm();
             if (!(length > kShortestQuaternion && std::isfinite(length)))
               fail(ErrorCode::usage, "attitude of the state has the length " +
                                          text::brief(length) + "; a quaternion needs a length " +
                                          "above " + text::brief(kShortestQuaternion));
             state.base = {position, Eigen::Quaterniond(attitude / length)};
             state.base_velocity = velocity;
             state.base_angular_velocity = angular_velocity;
             return state;
           }),
           py::arg("theta"), py::arg("dtheta") = py::none(),
           py::arg("position") = Eigen::Vector3d(0, 0, 0),
           py::arg("attitude") = Eigen::Vector4d(0, 0, 0, 1),
           py::arg("velocity") = Eigen::Vector3d(0, 0, 0),
           py::arg("angular_velocity") = Eigen::Vector3d(0, 0, 0))
      .def_readonly(
          "theta", &RobotState::theta,
          "Joint positions, shape (dof,): angles [rad], or displacements of sliding joints [m].")
      .def_readonly("dtheta", &RobotState::dtheta, "Joint rates [rad/s, m/s], shape (dof,).")
      .def_property_readonly(
          "position", [](const RobotState& s) -> const Eigen::Vector3d& { return s.base.position; },
          "Position of the base in the world [m], shape (3,).")
      .def_property_readonly(
          "attitude",
          [](const RobotState& s) -> const Eigen::Vector4d& { return s.base.attitude.coeffs(); },
          "Attitude of the base in the world, unit quaternion x y z w, shape (4,).")
      .def_readonly("velocity", &RobotState::base_velocity,
                    "Velocity of the base, world axes [m/s], shape (3,).")
      .def_readonly("angular_velocity", &RobotState::base_angular_velocity,
                    "Angular velocity of the base, world axes [rad/s], shape (3,).");
}

}  // namespace

void bind_robot(py::module_& m) {
  bind_state(m);
  py::class_<ActuatorLimits>(m, "Actuators", "Limits of the motors of one profile, by joint.")
      .def_readonly("name", &ActuatorLimits::name, "Name of the profile.")
      .def_readonly("speed", &ActuatorLimits::speed,
                    "Largest speeds [rad/s, m/s], shape (dof,); inf where there is no limit.")
      .def_readonly("peak_torque", &ActuatorLimits::peak_torque,
                    "Largest torques [N m, N], shape (dof,).")
      .def_readonly(
          "continuous_torque", &ActuatorLimits::continuous_torque,
          "Largest torques that the motors bear without a time limit [N m, N], shape (dof,).");

  py::class_<RobotModel, std::shared_ptr<RobotModel>>(
      m, "Robot", "A robot: a tree of links with soles, motors and named postures.")
      .def_property_readonly("name", &RobotModel::name, "Name of the robot.")
      .def_property_readonly("mass", &RobotModel::mass, "Mass [kg].")
      .def_property_readonly("joints", &RobotModel::dof_names,
                             "Names of the joints, the order of all joint vectors.")
      .def_property_readonly(
          "links",
          [](const RobotModel& robot) {
            std::vector<std::string> names;
            for (const Link& link : robot.links()) names.push_back(link.name);
            return names;
          },
          "Names of the links.")
      .def_property_readonly(
          "lower", [](const py::object& self) { return dof_view(self, &Dof::lower); },
          "Lower position limits [rad, m], shape (dof,); -inf without a limit.")
      .def_property_readonly(
          "upper", [](const py::object& self) { return dof_view(self, &Dof::upper); },
          "Upper position limits [rad, m], shape (dof,); inf without a limit.")
      .def_property_readonly("profiles", &RobotModel::profile_names,
                             "Names of the actuator profiles.")
      .def("actuators", &RobotModel::limits, py::arg("profile") = "",
           py::return_value_policy::reference_internal,
           "Limits of the motors of a profile; '' means the default profile.")
      .def("posture", &RobotModel::posture, py::arg("name") = "home",
           "Joint angles of a named posture [rad, m], shape (dof,).")
      .def("rest_state", &RobotModel::rest_state, py::arg("posture") = "home",
           "The robot at rest in a named posture, its base at the origin.")
      .def_property_readonly(
          "servo_period", [](const RobotModel& robot) { return robot.description().servo_period; },
          "Time between two targets of the servos [s].")
      .def_property_readonly(
          "assumptions", [](const RobotModel& robot) { return robot.description().assumptions; },
          "Values that the files of the robot do not state and that were inferred.")
      .def(
          "cog",
          [](const RobotModel& robot, const RobotState& state) -> Eigen::Vector3d {
            return data_of(robot, state).cog;
          },
          py::arg("state"), "Centre of gravity in the world [m], shape (3,).")
      .def(
          "link_pose",
          [](const RobotModel& robot, const RobotState& state,
             const std::string& link) -> Eigen::Matrix4d {
            const int index = robot.find_link(link);
            if (index < 0)
              fail(ErrorCode::usage,
                   "link '" + link + "': robot '" + robot.name() + "' has no link of this name");
            return link_pose(robot, data_of(robot, state), index).matrix();
          },
          py::arg("state"), py::arg("link"), "Pose of a link in the world [m], shape (4, 4).")
      .def(
          "sole_pose",
          [](const RobotModel& robot, const RobotState& state,
             const std::string& foot) -> Eigen::Matrix4d {
            return sole_pose(robot, data_of(robot, state), side_of(foot)).matrix();
          },
          py::arg("state"), py::arg("foot"),
          "Pose of a sole, 'left' or 'right', in the world [m], shape (4, 4).");

  m.def(
      "robots",
      [](const std::vector<Path>& path) {
        std::vector<std::string> names;
        for (const RobotEntry& entry : find_robots(robot_search(path))) names.push_back(entry.name);
        return names;
      },
      py::arg("path") = std::vector<Path>(),
      "Names of the robots in the folders of `path` and of the bundled ones.");
  m.def(
      "load_robot",
      [](const std::string& name, const std::vector<Path>& path, bool meshes) {
        return Watch(py::none()).run([&](const Progress& progress) {
          return std::make_shared<RobotModel>(
              load_robot(name, robot_search(path), {.meshes = meshes, .progress = progress}));
        });
      },
      py::arg("name"), py::arg("path") = std::vector<Path>(), py::arg("meshes") = true,
      "The robot of this name, folder, sidecar or URDF. With `meshes`, the meshes are read too; "
      "only pictures need them.");
}

}  // namespace ayumi::python
