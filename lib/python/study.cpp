// Studies of many runs: pushes, gains, tuning and the fastest pace.

#include "ayumi/base/error.hpp"
#include "ayumi/plot/push_map.hpp"
#include "ayumi/study/gain_study.hpp"
#include "ayumi/study/local_retime.hpp"
#include "ayumi/study/push.hpp"
#include "ayumi/study/retime.hpp"
#include "ayumi/study/tune.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

using Gains = std::map<std::string, double>;

std::vector<PushPhase> phases_at(const std::vector<double>& times) {
  std::vector<PushPhase> phases;
  for (const double t : times) phases.push_back({"t = " + std::to_string(t) + " s", t, false});
  return phases;
}

ControllerSpec controller_named(const Task& task, const std::string& name) {
  const ControllerType type = controller_type(name);
  return type == task.pattern.controller.type ? task.pattern.controller : ControllerSpec{type, {}};
}

SimulateOptions study_simulation(const Task& task, std::uint64_t seed) {
  SimulateOptions options;
  options.profile = task.profile;
  options.world = task.pattern.world;
  options.seed = seed;
  return options;
}

/// A push study with the options that were asked for.
struct PyPushStudy {
  std::shared_ptr<PyTask> task;
  PushOptions options;
  std::vector<PushCase> cases;
};

void bind_push(py::module_& m) {
  py::class_<PushCase>(m, "PushCase", "The limits of one phase and direction.")
      .def_property_readonly(
          "phase", [](const PushCase& c) { return c.phase.name; }, "Name of the phase.")
      .def_property_readonly(
          "at", [](const PushCase& c) { return c.phase.at; }, "Time of the push [s].")
      .def_property_readonly(
          "standing", [](const PushCase& c) { return c.phase.standing; },
          "Whether the robot stands in the first posture.")
      .def_readonly("direction", &PushCase::direction,
                    "Direction of the push, counted anticlockwise from forward [rad].")
      .def_readonly("bound", &PushCase::bound,
                    "Capture bound: the largest push that a point mass could absorb [N s].")
      .def_property_readonly(
          "open_loop", [](const PushCase& c) { return c.open_loop.impulse; },
          "Largest push that the robot survives in open loop [N s].")
      .def_property_readonly(
          "limits",
          [](const PushCase& c) {
            std::vector<double> limits;
            for (const PushLimit& limit : c.limits) limits.push_back(limit.impulse);
            return limits;
          },
          "Largest push that the robot survives with each controller [N s].")
      .def_property_readonly(
          "capped",
          [](const PushCase& c) {
            std::vector<bool> capped;
            for (const PushLimit& limit : c.limits) capped.push_back(limit.capped);
            return capped;
          },
          "Whether the robot survives the largest push that was tried, by controller.");
  py::class_<PyPushStudy, std::shared_ptr<PyPushStudy>>(m, "PushStudy", "The result of push().")
      .def_readonly(
          "cases", &PyPushStudy::cases,
          "Cases in the order of the phases, and in each phase in the order of the directions.")
      .def_property_readonly(
          "controllers",
          [](const PyPushStudy& s) {
            std::vector<std::string> names;
            for (const ControllerSpec& c : s.options.controllers) names.push_back(name_of(c.type));
            return names;
          },
          "The laws, in the order of PushCase.limits.")
      .def_property_readonly(
          "summary",
          [](const PyPushStudy& s) {
            return push_summary_lines(s.cases, s.options, s.task->task->series);
          },
          "For each law, one line for pushes while walking, and one for pushes while standing.")
      .def(
          "picture",
          [](const PyPushStudy& s, double scale) {
            const Task& task = *s.task->task;
            const PushMap map = push_map(
                push_map_title(task.pattern.name, task.robot.name(), task.profile, s.options),
                s.cases, s.options, task.series);
            return py::bytes(encode_png(to_image(draw_push_map(map), scale)));
          },
          py::arg("scale") = 1.5,
          "A map of the push limits, seen from above, as the bytes of a PNG file.");

  m.def(
      "push",
      [](const std::shared_ptr<PyTask>& given, const std::vector<std::string>& controllers,
         const Gains& gains, const std::vector<double>& times, int directions, double step,
         double cap, int replicas, double duration, std::uint64_t seed, int threads,
         py::object progress) {
        const Task& task = *given->task;
        auto study = std::make_shared<PyPushStudy>();
        study->task = given;
        PushOptions& options = study->options;
        options.directions = directions;
        options.step = step;
        options.cap = cap;
        options.replicas = replicas;
        options.duration = duration;
        options.threads = threads;
        options.simulate = study_simulation(task, seed);
        for (const std::string& name : controllers)
          options.controllers.push_back(controller_named(task, name));
        if (controllers.empty()) {
          const ControllerSpec& own = task.pattern.controller;
          const bool open = own.type == ControllerKind::none;
          options.controllers = {open ? ControllerSpec{ControllerKind::dtad, {}} : own};
        }
        for (ControllerSpec& spec : options.controllers)
          spec.gains.insert(spec.gains.end(), gains.begin(), gains.end());
        options.phases = phases_at(times);
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          if (options.phases.empty()) {
            SimulateOptions gait = options.simulate;
            for (const ControllerSpec& c : options.controllers)
              if (c.type == ControllerKind::viip && gait.controller.type != ControllerKind::viip)
                gait.controller = c;
            options.phases = default_push_phases(task.robot, task.series, gait);
          }
          study->cases = push_limits(task.robot, task.series, options, {}, {}, watched);
          return study;
        });
      },
      py::arg("task"), py::kw_only(), py::arg("controllers") = std::vector<std::string>(),
      py::arg("gains") = Gains(), py::arg("times") = std::vector<double>(),
      py::arg("directions") = PushOptions().directions, py::arg("step") = PushOptions().step,
      py::arg("cap") = PushOptions().cap, py::arg("replicas") = PushOptions().replicas,
      py::arg("duration") = PushOptions().duration, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "The largest push that the robot survives, by phase of the gait and direction, in open loop "
      "and with each controller (the controller of the pattern when none is named). `times` [s] "
      "replace the default phases. `step` is the resolution of the search, and `cap` is the "
      "largest "
      "push tried, both as multiples of the capture bound. `replicas` is the number of small "
      "variations of every push; the robot must survive all of them. `duration` is the duration of "
      "a "
      "push [s]. `threads` is the number of threads, and 0 means all; the results do not depend on "
      "this number.");
}

void bind_gains(py::module_& m) {
  py::class_<GainStudy>(m, "GainStudy", "Gains of DTAD and what follows from them.")
      .def_readonly("omega", &GainStudy::omega, "Natural frequency of the pendulum [1/s].")
      .def_property_readonly(
          "gains",
          [](const GainStudy& s) {
            const auto list = gain_list(s.params);
            return Gains(list.begin(), list.end());
          },
          "The gains by their names in patterns and sidecars.")
      .def_property_readonly(
          "stable", [](const GainStudy& s) { return s.weakest.analysis.stable; },
          "Whether the linear loop on one foot is stable.")
      .def_property_readonly(
          "poles", [](const GainStudy& s) { return s.weakest.analysis.poles; },
          "Poles of this loop [1/s], the slowest decay first.")
      .def_property_readonly(
          "decay", [](const GainStudy& s) { return s.weakest.analysis.decay; },
          "Decay rate of the slowest mode [1/s]; negative when the mode grows.")
      .def_readonly("largest_ka", &GainStudy::largest_ka,
                    "Largest short-term gain with which the loop is stable.")
      .def_property_readonly(
          "reaches",
          [](const GainStudy& s) {
            py::list list;
            for (const Reach& r : s.reaches)
              list.append(py::make_tuple(r.support, r.direction, r.dcm, r.impulse));
            return list;
          },
          "(support, direction, largest error of the DCM that needs no step [m], impulse of this "
          "error [N s]).");
  m.def(
      "gains",
      [](const RobotModel& robot, const std::optional<std::array<std::complex<double>, 2>>& poles,
         std::optional<double> absorb, std::optional<double> return_time,
         std::optional<double> zmp_filter, std::optional<double> forget, const Gains& set,
         std::optional<double> latency) {
        const py::gil_scoped_release release;
        return study_gains(robot, {poles, absorb, return_time, zmp_filter, forget},
                           {set.begin(), set.end()}, latency);
      },
      py::arg("robot"), py::kw_only(), py::arg("poles") = py::none(),
      py::arg("absorb") = py::none(), py::arg("return_time") = py::none(),
      py::arg("zmp_filter") = py::none(), py::arg("forget") = py::none(), py::arg("set") = Gains(),
      py::arg("latency") = py::none(),
      "Gains of DTAD. They follow from two `poles` of the COG [1/s], the share of a ZMP error that "
      "is absorbed at once, the times [s] of the return to the command and of the filter of the "
      "ZMP, and the time [s] until a lasting offset of the ZMP is accepted. `set` gives gains by "
      "name. `latency` [s] is the latency of the sensors.");

  py::class_<TuneFigures>(m, "TuneFigures", "The objective of tune() and its parts.")
      .def_readonly("objective", &TuneFigures::objective, "Dimensionless, smaller is better.")
      .def_readonly("recovery", &TuneFigures::recovery,
                    "Part of the objective from the pushes that the robot survives.")
      .def_readonly("unpushed", &TuneFigures::unpushed,
                    "Part of the objective from the run without a push.")
      .def_readonly("falls", &TuneFigures::falls, "Number of falls.")
      .def_readonly("pushes", &TuneFigures::pushes, "Number of pushes.");
  py::class_<TuneResult>(m, "Tuning", "The result of tune().")
      .def_readonly("start", &TuneResult::start, "Gains at the start, by name.")
      .def_readonly("gains", &TuneResult::gains, "The best gains, by name.")
      .def_readonly("before", &TuneResult::before, "Figures at the start.")
      .def_readonly("after", &TuneResult::after, "Figures of the best gains.")
      .def_readonly("choices", &TuneResult::choices, "Number of choices of gains tried.")
      .def_readonly("refused", &TuneResult::refused,
                    "Choices that were skipped because their loop is unstable.");
  m.def(
      "tune",
      [](const PyTask& given, const Gains& start, const std::vector<double>& times, int directions,
         double level, const std::optional<std::vector<std::string>>& gains, int rounds,
         std::uint64_t seed, int threads, py::object progress) {
        const Task& task = *given.task;
        TuneOptions options;
        options.phases = phases_at(times);
        options.directions = directions;
        options.level = level;
        if (gains) options.gains = *gains;
        options.rounds = rounds;
        options.threads = threads;
        options.simulate = study_simulation(task, seed);
        options.simulate.controller = controller_named(task, "dtad");
        for (const auto& gain : start) options.simulate.controller.gains.push_back(gain);
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          return tune_gains(task.robot, task.series, options, watched);
        });
      },
      py::arg("task"), py::kw_only(), py::arg("start") = Gains(),
      py::arg("times") = std::vector<double>(), py::arg("directions") = TuneOptions().directions,
      py::arg("level") = TuneOptions().level, py::arg("gains") = py::none(),
      py::arg("rounds") = TuneOptions().rounds, py::arg("seed") = 1, py::arg("threads") = 0,
      py::arg("progress") = py::none(),
      "Searches for better gains of DTAD. `start` are the gains to begin with, and `times` are the "
      "times of the pushes [s]. "
      "`level` is the size of a push as a multiple of the capture bound. `gains` are the names of "
      "the gains that are changed.");
}

void bind_local_pace(py::module_& m) {
  py::class_<LocalPace>(m, "LocalPace", "The result of fastest_local_pace().")
      .def_readonly("found", &LocalPace::found, "Whether a timing passes the check.")
      .def_readonly("pattern", &LocalPace::pattern, "The motion with this timing, as a table.")
      .def_readonly("scale", &LocalPace::scale,
                    "Duration divided by the duration of the given pattern.")
      .def_readonly(
          "path_scale", &LocalPace::path_scale,
          "The scale of the fastest uniform pace. The motion has the postures of this pace.")
      .def_property_readonly(
          "binding",
          [](const LocalPace& pace) {
            py::list list;
            for (const BindingLimit& limit : pace.binding)
              list.append(py::make_tuple(limit.limit, limit.share));
            return list;
          },
          "(limit, share of the duration for which it binds), the longest first; '' where no limit "
          "binds, 'pace' for the largest pace, 'pause' for pauses that are kept.")
      .def_readonly("rounds", &LocalPace::rounds, "Number of timings that were checked.")
      .def_readonly("limited_by", &LocalPace::limited_by,
                    "In words: why no timing passes the check.")
      .def_readonly("by_posture", &LocalPace::by_posture,
                    "Whether no timing passes because a posture itself violates a limit.");
  m.def(
      "fastest_local_pace",
      [](const PyTask& given, const std::string& table, std::optional<double> margin,
         bool keep_pauses, py::object progress) {
        const Task& task = *given.task;
        LocalRetimeOptions options;
        options.path.check = check_options(task);
        if (margin) options.path.most_margin = *margin;
        options.keep_pauses = keep_pauses;
        options.dt = task.series.dt;
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          return fastest_local_pace(task.robot, task.pattern, table, options, watched);
        });
      },
      py::arg("task"), py::kw_only(), py::arg("table") = "retimed.csv",
      py::arg("margin") = py::none(), py::arg("keep_pauses") = false,
      py::arg("progress") = py::none(),
      "The fastest timing along the motion: the motion slows down only where a limit "
      "binds. `table` is the name of the table in the result. `margin` [m] is a distance from the "
      "edge of "
      "the support that is enough for the ZMP. With `keep_pauses`, time spans in which nothing "
      "moves keep their duration.");
}

void bind_pace(py::module_& m) {
  py::class_<FastestPace>(m, "Pace", "The result of fastest_pace().")
      .def_readonly("found", &FastestPace::found, "Whether a scale passes the check.")
      .def_readonly("scale", &FastestPace::scale, "Smallest factor on all times that passes.")
      .def_readonly("bounded", &FastestPace::bounded,
                    "False if even the fastest scale that was tried passes.")
      .def_readonly("limited_by", &FastestPace::limited_by,
                    "First error at a slightly smaller scale, in words.")
      .def_readonly("evaluations", &FastestPace::evaluations, "Number of scales tried.");
  m.def(
      "fastest_pace",
      [](const PyTask& given, double resolution, py::object progress) {
        const Task& task = *given.task;
        RetimeOptions options;
        options.check = check_options(task);
        options.dt = task.series.dt;
        options.resolution = resolution;
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          return fastest_pace(task.robot, task.pattern, options, watched);
        });
      },
      py::arg("task"), py::kw_only(), py::arg("resolution") = RetimeOptions().resolution,
      py::arg("progress") = py::none(),
      "The fastest uniform time scaling of the pattern that passes the check.");
  bind_local_pace(m);
}

}  // namespace

void bind_study(py::module_& m) {
  bind_push(m);
  bind_gains(m);
  bind_pace(m);
}

}  // namespace ayumi::python
