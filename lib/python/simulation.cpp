// Simulations and their logs; a plant or a controller that is written in Python.

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/estimator.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/results_json.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/io/run/simulation_log_file.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/plant_interface.hpp"
#include "ayumi/sim/simulation_log.hpp"
#include "ayumi/sim/step_check.hpp"
#include "bindings.hpp"
#ifdef AYUMI_HAS_MUJOCO
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#endif

namespace ayumi::python {

namespace {

/// The value that a function of the user has returned. Throws Error(usage) if it has another type.
template <typename T>
T returned(const py::object& object, const char* what) {
  // A cast of None would give no object at all.
  try {
    if (!object.is_none()) return object.cast<T>();
  } catch (const py::cast_error&) {
  }
  fail(ErrorCode::usage,
       std::string(what) + ", but it is " + py::repr(py::type::of(object)).cast<std::string>());
}

/// An object that a copy of a simulator must not share. It is copied by Python's deepcopy.
class OwnObject {
 public:
  explicit OwnObject(py::object object) : object_(new py::object(std::move(object)), release) {}
  OwnObject(const OwnObject& other) : OwnObject(copy_of(other)) {}
  OwnObject& operator=(const OwnObject&) = delete;
  const py::object& get() const { return *object_; }

 private:
  static void release(py::object* object) {
    const py::gil_scoped_acquire acquire;
    delete object;
  }
  static py::object copy_of(const OwnObject& other) {
    const py::gil_scoped_acquire acquire;
    return py::module_::import("copy").attr("deepcopy")(other.get());
  }

  std::shared_ptr<py::object> object_;
};

/// A plant written in Python, behind the interface of all plants.
class PythonPlant {
 public:
  PythonPlant(const RobotModel& model, OwnObject object)
      : model_(&model), object_(std::move(object)), data_(model) {
    take_state();
  }
  const RobotState& state() const { return state_; }
  const RobotData& data() const { return data_; }
  void set_state(const RobotState& state) {
    const py::gil_scoped_acquire acquire;
    object_.get().attr("set_state")(py::cast(state));
    take_state();
  }
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt) {
    const py::gil_scoped_acquire acquire;
    report_ =
        returned<StepReport>(object_.get().attr("step")(py::cast(targets), py::cast(input), dt),
                             "plant: step(targets, input, dt) must return an ayumi.StepReport");
    try {
      check_report(*model_, report_);
      take_state();
    } catch (const Error& error) {
      throw_with_more(error,
                      "; the step began " + text::fixed(time_, 3) + " s after the plant's start");
    }
    time_ += dt;
    return report_;
  }

 private:
  void take_state() {
    const py::gil_scoped_acquire acquire;
    state_ = returned<RobotState>(object_.get().attr("state"),
                                  "plant: state must be an ayumi.RobotState");
    check_state(*model_, state_);
    update_velocities(*model_, state_, data_);
  }

  const RobotModel* model_;
  OwnObject object_;
  RobotState state_;
  RobotData data_;
  StepReport report_;
  double time_ = 0;  ///< time of all steps so far [s]
};

void warn_slow(const char* what) {
  const std::string text =
      std::string("the ") + what +
      " is a Python function, which is called in every tick: the run takes several times as long";
  if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

/// `plant` is a name, or a function (robot, profile, friction) -> object with state, set_state and
/// step.
PlantKind plant_of(const py::object& plant) {
  if (!py::isinstance<py::str>(plant)) {
    warn_slow("plant");
    const auto make = std::make_shared<OwnObject>(plant);
    return {"python",
            [make](const RobotModel& model, const ActuatorLimits& limits, const World& world) {
              const py::gil_scoped_acquire acquire;
              // The function gets a copy: the object in Python may live longer than the run and its
              // robot.
              py::object made = make->get()(py::cast(model, py::return_value_policy::copy),
                                            limits.name, py::cast(world));
              return PlantInterface(PythonPlant(model, OwnObject(std::move(made))));
            }};
  }
  const auto name = plant.cast<std::string>();
  if (name == "ayumi") return {};
#ifdef AYUMI_HAS_MUJOCO
  if (name == "mujoco") return mujoco_plant_kind();
  fail(ErrorCode::usage,
       "plant '" + name + "' is not one of ayumi and mujoco; give one of these, or a function");
#else
  fail(ErrorCode::usage,
       "plant '" + name +
           "' is not possible; give ayumi or a function (this program was built without MuJoCo)");
#endif
}

TargetFunction targets_of(const py::object& function) {
  if (function.is_none()) return {};
  warn_slow("controller");
  const auto call = std::make_shared<OwnObject>(function);
  return [call](double t, const Estimate& estimate, const CommandSample& plan,
                const Eigen::VectorXd& targets) {
    const py::gil_scoped_acquire acquire;
    return returned<Eigen::VectorXd>(
        call->get()(t, py::cast(estimate, py::return_value_policy::copy),
                    py::cast(plan, py::return_value_policy::copy), py::cast(targets)),
        "targets: the function must return an array of numbers, shape (dof,)");
  };
}

void bind_step(py::module_& m) {
  py::class_<World>(m, "World", "The ground under the robot.")
      .def(py::init<>())
      .def_readwrite("friction", &World::friction, "Coefficient of Coulomb friction.");
  py::class_<ExternalWrench>(m, "Wrench", "A force or a couple from outside during one step.")
      .def_readonly("body", &ExternalWrench::body,
                    "Index of the body; -1 if the force acts at the COG.")
      .def_readonly("point", &ExternalWrench::point,
                    "Point of application in the world [m], shape (3,).")
      .def_readonly("force", &ExternalWrench::force, "Force in world axes [N], shape (3,).")
      .def_readonly("torque", &ExternalWrench::torque, "Moment in world axes [N m], shape (3,).");
  py::class_<StepInput>(m, "StepInput", "What acts on the robot from outside during one step.")
      .def(py::init<>())
      .def_readonly("wrenches", &StepInput::wrenches, "Forces and couples.")
      .def_readonly("friction", &StepInput::friction,
                    "Friction coefficient of the whole ground in place of that of the world; None: "
                    "that of the world.");
  py::class_<SoleForce>(m, "SoleForce", "Ground force at one vertex of a sole.")
      .def(py::init([](const Eigen::Vector3d& position, const Eigen::Vector3d& force, double gap) {
             return SoleForce{position, force, gap};
           }),
           py::arg("position"), py::arg("force"), py::arg("gap") = 0.0)
      .def_readonly("position", &SoleForce::position,
                    "Place of the vertex in the world [m], shape (3,).")
      .def_readonly("force", &SoleForce::force,
                    "Force of the ground on the robot, in world axes [N], shape (3,).")
      .def_readonly("gap", &SoleForce::gap, "Distance to the ground, negative inside [m].");
  py::class_<StepReport>(m, "StepReport",
                         "Forces of a step, as means over the duration of the step.")
      .def(py::init([](const Eigen::VectorXd& torque, std::vector<SoleForce> left,
                       std::vector<SoleForce> right, bool body_contact) {
             StepReport report;
             report.torque = torque;
             report.soles = {std::move(left), std::move(right)};
             report.body_contact = body_contact;
             return report;
           }),
           py::arg("torque"), py::arg("left"), py::arg("right"), py::arg("body_contact") = false)
      .def_readonly("torque", &StepReport::torque, "Torques of the servos [N m, N], shape (dof,).")
      .def_property_readonly(
          "left", [](const StepReport& r) { return r.soles[0]; }, "Forces on the left sole.")
      .def_property_readonly(
          "right", [](const StepReport& r) { return r.soles[1]; }, "Forces on the right sole.")
      .def_readonly("body_contact", &StepReport::body_contact,
                    "Whether a body that is no sole touches the ground.");
  py::class_<Plant>(m, "Plant",
                    "Ayumi's own plant. A plant that is written in Python may contain it.")
      .def(py::init([](const RobotModel& robot, const std::string& profile, const World& world) {
             return Plant(robot, robot.limits(profile), world);
           }),
           py::arg("robot"), py::arg("profile") = "", py::arg("world") = World(),
           py::keep_alive<1, 2>())
      .def_property_readonly("state", &Plant::state, py::return_value_policy::copy,
                             "The state of the robot.")
      .def("set_state", &Plant::set_state, py::arg("state"),
           "Puts the robot in this state and forgets the contacts.")
      .def("step", &Plant::step, py::arg("targets"), py::arg("input"), py::arg("dt"),
           py::return_value_policy::copy,
           "Advances by `dt` [s]. The servo targets [rad, m], shape (dof,), are held during this "
           "time. They are angles of the encoders: those of the joints, minus the offsets of the "
           "servos.")
      .def("__deepcopy__", [](const py::object& self, const py::dict&) {
        // The original keeps its robot alive, and the copy keeps the original alive.
        py::object copy = py::cast(Plant(self.cast<const Plant&>()));
        py::detail::keep_alive_impl(copy, self);
        return copy;
      });
}

void bind_controller(py::module_& m) {
  py::class_<Estimate>(m, "Estimate",
                       "What a controller receives from the sensors, in the frame of the plan.")
      .def_readonly("state", &Estimate::state, "Estimated state of the robot.")
      .def_readonly("cog", &Estimate::cog, "COG [m], shape (3,).")
      .def_readonly("dcog", &Estimate::dcog, "Velocity of the COG [m/s], shape (3,).")
      .def_readonly("zmp", &Estimate::zmp,
                    "ZMP [m], shape (3,); in flight, the last value on the ground.")
      .def_readonly("fz", &Estimate::fz, "Vertical ground force [N].")
      .def_property_readonly(
          "foot_fz", [](const Estimate& e) { return py::make_tuple(e.foot_fz[0], e.foot_fz[1]); },
          "Vertical force on the left and the right foot [N].")
      .def_readonly("contact", &Estimate::contact, "Whether the ground carries the robot.");
  py::class_<CommandSample>(m, "Command", "The plan of one tick.")
      .def_readonly("state", &CommandSample::state, "Planned base and joints.")
      .def_readonly("cog", &CommandSample::cog, "COG [m], shape (3,).")
      .def_readonly("dcog", &CommandSample::dcog, "Velocity of the COG [m/s], shape (3,).")
      .def_readonly("zmp", &CommandSample::zmp, "ZMP [m], shape (3,).")
      .def_readonly("fz", &CommandSample::fz, "Vertical ground force [N].")
      .def_property_readonly(
          "support", [](const CommandSample& c) { return std::string(name_of(c.support)); },
          "'both', 'left', 'right' or 'none'.");
}

void bind_log(py::module_& m) {
  py::class_<SimulationEvent>(m, "Event", "Something that happened in a run.")
      .def_readonly("t", &SimulationEvent::t, "Time [s].")
      .def_property_readonly(
          "kind", [](const SimulationEvent& e) { return name_of(e.kind); },
          "'push', 'touchdown', 'fell', ...")
      .def_readonly("text", &SimulationEvent::text, "Description in words.")
      .def("__repr__", [](const SimulationEvent& e) {
        return "<" + std::string(name_of(e.kind)) + " at " + std::to_string(e.t) + " s: " + e.text +
               ">";
      });

  py::class_<Log, std::shared_ptr<Log>> log(
      m, "Log",
      "A run with one sample per tick. log['cog'] is an array, log.units('cog') has its units. "
      "docs/formats.md describes the quantities.");
  bind_samples<SimulationLog>(log);
  const auto result = [](auto member) {
    return [member](const Log& l) { return l.data().result.*member; };
  };
  log.def_property_readonly(
         "outcome", [](const Log& l) { return std::string(name_of(l.data().result.outcome)); },
         "'stands', 'unsettled' or 'fell'.")
      .def_property_readonly("fell_at", result(&SimulationResult::fell_at),
                             "Time of the fall [s]; negative when there was none.")
      .def_property_readonly("max_tilt", result(&SimulationResult::max_tilt),
                             "Largest tilt of the trunk [rad].")
      .def_property_readonly("final_cog_error", result(&SimulationResult::final_cog_error),
                             "Horizontal error of the COG relative to the feet at the end [m].")
      .def_property_readonly(
          "zmp_tracking_rms", result(&SimulationResult::zmp_tracking_rms),
          "Root mean square of the distance from the measured ZMP to the reference ZMP [m].")
      .def_property_readonly(
          "max_torque_ratio", [](const Log& l) { return l.data().result.torque.ratio; },
          "Largest torque as a share of its limit.")
      .def_property_readonly(
          "max_speed_ratio", [](const Log& l) { return l.data().result.speed.ratio; },
          "Largest joint speed as a share of its limit.")
      .def_property_readonly(
          "events", [](const Log& l) { return l.data().events; },
          "Events of the run, in the order of time.")
      .def_property_readonly(
          "controller",
          [](const Log& l) -> std::optional<std::string> {
            if (!l.data().controller) return {};
            return name_of(*l.data().controller);
          },
          "Name of the control law.")
      .def_property_readonly(
          "plant", [](const Log& l) { return l.data().plant; }, "'ayumi', 'mujoco' or 'python'.")
      .def_property_readonly("hash",
                             py::cpp_function([](const Log& l) { return log_hash(l.data()); },
                                              py::call_guard<py::gil_scoped_release>()),
                             "SHA-256 of the motion; the same for the same run.")
      .def(
          "to_dict", [](const Log& l) { return from_json(simulation_json(l.data())); },
          "The content of `ayumi simulate --json` as a dict.")
      .def(
          "write", [](const Log& l, const Path& path) { write_log(path, l.data()); },
          py::call_guard<py::gil_scoped_release>(), py::arg("path"),
          "Writes the log as one binary file, whole or not at all.");
  m.def(
      "read_log",
      [](const Path& path, const std::string& name) {
        auto data = std::make_shared<const SimulationLog>(read_run_log(path, name));
        return std::make_shared<Log>(data, data->joints, std::vector<bool>());
      },
      py::call_guard<py::gil_scoped_release>(), py::arg("path"), py::arg("name") = "",
      "The log of a file or of the folder that `ayumi run` wrote: 'open_loop', 'closed_loop' (the "
      "default) or 'undisturbed'.");
}

ControllerSpec controller_of(const Task& task, const std::optional<std::string>& name,
                             const std::map<std::string, double>& gains) {
  ControllerSpec spec = task.pattern.controller;
  if (name && controller_type(*name) != spec.type) spec = {controller_type(*name), {}};
  spec.gains.insert(spec.gains.end(), gains.begin(), gains.end());
  return spec;
}

void refuse_unstable_gains(const Task& task, const ControllerSpec& spec) {
  const CommandSample& first = task.series.samples.front();
  const std::string reason = instability(task.robot, task.robot.limits(task.profile), spec,
                                         first.cog.z() - first.zmp.z(), task.series.dt);
  if (!reason.empty())
    fail(ErrorCode::bad_pattern,
         reason + "; allow_unstable=True simulates with these gains nevertheless");
}

}  // namespace

void bind_simulation(py::module_& m) {
  bind_step(m);
  bind_controller(m);
  bind_log(m);
  m.def("controllers", &controller_names, "Names of the control laws.");
  m.def(
      "simulate",
      [](const PyTask& given, const std::optional<std::string>& controller,
         const std::map<std::string, double>& gains,
         const std::optional<std::variant<bool, Path>>& scenario, bool noise, bool true_state,
         int substeps, std::uint64_t seed, const py::object& plant, const py::object& targets,
         bool allow_unstable, py::object progress) {
        const Task& task = *given.task;
        SimulateOptions options = simulate_options(task);
        options.controller = controller_of(task, controller, gains);
        if (!allow_unstable) refuse_unstable_gains(task, options.controller);
        if (scenario && std::holds_alternative<Path>(*scenario))
          options.scenario = read_pattern(std::get<Path>(*scenario)).scenario;
        else if (scenario && !std::get<bool>(*scenario))
          options.scenario.clear();
        options.sensor_noise = noise;
        options.true_state = true_state;
        options.substeps = substeps;
        options.seed = seed;
        options.plant = plant_of(plant);
        options.targets = targets_of(targets);
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          auto data = std::make_shared<const SimulationLog>(simulate(task, options, watched));
          return std::make_shared<Log>(data, data->joints, prismatic_of(task.robot));
        });
      },
      py::arg("task"), py::kw_only(), py::arg("controller") = py::none(),
      py::arg("gains") = std::map<std::string, double>(), py::arg("scenario") = py::none(),
      py::arg("noise") = false, py::arg("true_state") = false, py::arg("substeps") = 1,
      py::arg("seed") = 1, py::arg("plant") = "ayumi", py::arg("targets") = py::none(),
      py::arg("allow_unstable") = false, py::arg("progress") = py::none(),
      "Simulates the closed loop of plant, sensors and controller. `controller` is a name of "
      "controllers(), or None for the controller of the pattern. `gains` are values of gains by "
      "name. `scenario` is False for no disturbances, or a pattern file whose scenario replaces "
      "the "
      "scenario of the pattern. With `noise`, the sensors have noise, bias and latency. With "
      "`true_state`, the controller gets the true state. `substeps` is the number of steps of the "
      "integrator in a tick. `plant` is 'ayumi', 'mujoco', or a function (robot, profile, world) "
      "that returns an object with `state`, `set_state(state)` and `step(targets, input, dt)`, as "
      "Plant has them. `targets` is a function (t, estimate, plan, targets). It returns the servo "
      "targets as angles of the joints [rad, m], shape (dof,), which replace the targets of the "
      "controller; with controller='none', the function is the whole controller. A plant or a "
      "controller in Python is called in every tick and makes the run several times slower. "
      "`progress` is a function (stage, fraction, detail); the run stops if this function returns "
      "False.");
}

}  // namespace ayumi::python
