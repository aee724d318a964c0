// Pictures of runs: PNG bytes, and clips as files.

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/render/clip.hpp"
#include "ayumi/render/robot_picture.hpp"
#include "ayumi/render/snapshots.hpp"
#include "ayumi/task/plan_log.hpp"
#include "bindings.hpp"

namespace ayumi::python {

namespace {

using Logs = std::map<std::string, std::shared_ptr<Log>>;

std::vector<LociRun> runs_of(const Logs& logs) {
  std::vector<LociRun> runs;
  for (const auto& [label, log] : logs) runs.push_back({label, &log->data()});
  return runs;
}

ClipOptions clip_options(int width, int height, const std::string& view, double zoom,
                         const std::string& title) {
  ClipOptions options;
  options.picture.width = width;
  options.picture.height = height;
  options.camera.view = view;
  options.camera.zoom = zoom;
  options.title = title;
  return options;
}

/// Throws Error(usage) for a time that is not in the run: otherwise a picture of its end would be
/// mistaken for one of that time.
void require_time_of_run(const Log& log, double at) {
  const double end = log.data().dt * static_cast<double>(log.data().samples.size() - 1);
  if (!(at >= 0 && at <= end))
    fail(ErrorCode::usage, "a picture at t = " + text::brief(at) + " s: the run is from 0 to " +
                               text::brief(end) + " s");
}

/// The PNG bytes of the picture that `draw` makes without holding the interpreter's lock.
template <typename Draw>
py::bytes png(const Draw& draw) {
  const std::string bytes = [&] {
    const py::gil_scoped_release release;
    return encode_png(draw());
  }();
  return py::bytes(bytes);
}

}  // namespace

void bind_picture(py::module_& m) {
  m.def(
      "plan",
      [](const PyTask& task) {
        const Task& t = *task.task;
        const py::gil_scoped_release release;
        SimulationLog log = plan_log(t.robot, t.robot.limits(t.profile), t.series, t.series);
        log.provenance = provenance(t, "");
        log.world = t.pattern.world;
        auto data = std::make_shared<const SimulationLog>(std::move(log));
        return std::make_shared<Log>(data, data->joints, prismatic_of(t.robot));
      },
      py::arg("task"),
      "The planned motion in the form of a log, without a simulation: posture, COG, "
      "ZMP, forces on the feet, and the motor torques that the full model needs. Pictures and "
      "plots show it like a run; `outcome`, `hash` and `events` have no meaning for such a "
      "motion.");
  m.def(
      "robot_picture",
      [](const RobotModel& robot, const std::string& posture,
         const std::optional<Eigen::VectorXd>& theta, const std::string& view, bool marks) {
        const Eigen::VectorXd angles = theta ? *theta : robot.posture(posture);
        if (angles.size() != robot.dof_count())
          fail(ErrorCode::usage, "theta has " + std::to_string(angles.size()) +
                                     " values, but robot '" + robot.name() + "' has " +
                                     std::to_string(robot.dof_count()) + " joints");
        return png([&] { return draw_robot(robot, view, marks, &angles).image; });
      },
      py::arg("robot"), py::kw_only(), py::arg("posture") = "home", py::arg("theta") = py::none(),
      py::arg("view") = "iso", py::arg("marks") = true,
      "The robot on the ground, in a named posture or at the joint angles `theta` [rad, m], shape "
      "(dof,), as the bytes of a PNG file. With `marks`, the picture shows the outlines of the "
      "soles, the axes of the joints and an arrow in the direction that the robot faces.");
  m.def(
      "picture",
      [](const RobotModel& robot, const Log& log, double at, int width, int height,
         const std::string& view, double zoom, const std::string& title) {
        require_time_of_run(log, at);
        const ClipOptions options = clip_options(width, height, view, zoom, title);
        return png([&] { return ClipRenderer(robot, log.data(), options).frame(at); });
      },
      py::arg("robot"), py::arg("log"), py::kw_only(), py::arg("at") = 0.0, py::arg("width") = 1280,
      py::arg("height") = 720, py::arg("view") = "iso", py::arg("zoom") = 1.0,
      py::arg("title") = "",
      "The run at the time `at` [s] as the bytes of a PNG file. `view`: 'front', 'side', 'iso', "
      "'back', 'top', 'ortho-side' or 'ortho-front'; `width` and `height` in pixels.");
  m.def(
      "strip",
      [](const RobotModel& robot, const Log& log, const std::vector<double>& times, int count,
         int columns, int width, int height, const std::string& view, double zoom,
         const std::string& title) {
        for (const double at : times) require_time_of_run(log, at);
        StripOptions options;
        options.clip = clip_options(width, height, view, zoom, title);
        options.times = times;
        options.count = count;
        options.columns = columns;
        return py::bytes(Watch(py::none()).run([&](const Progress& watched) {
          return encode_png(draw_strip(robot, log.data(), options, watched));
        }));
      },
      py::arg("robot"), py::arg("log"), py::kw_only(), py::arg("times") = std::vector<double>(),
      py::arg("count") = 8, py::arg("columns") = 4, py::arg("width") = 400, py::arg("height") = 600,
      py::arg("view") = "iso", py::arg("zoom") = 1.0, py::arg("title") = "",
      "Snapshots side by side as the bytes of a PNG file, at `times` [s] or at `count` instants "
      "that Ayumi chooses.");
  m.def(
      "loci",
      [](const RobotModel& robot, const Logs& logs, const std::string& title, double scale) {
        LociOptions options;
        options.title = title;
        options.model = &robot;
        return png([&] { return to_image(draw_loci(runs_of(logs), options), scale); });
      },
      py::arg("robot"), py::arg("logs"), py::kw_only(), py::arg("title") = "",
      py::arg("scale") = 1.5,
      "COG, ZMP and vertical force of runs against time as the bytes of a PNG file. `logs`: runs "
      "by the label that the legend has.");
  m.def(
      "loci_svg",
      [](const RobotModel& robot, const Logs& logs, const std::string& title) {
        LociOptions options;
        options.title = title;
        options.model = &robot;
        const py::gil_scoped_release release;
        return to_svg(draw_loci(runs_of(logs), options));
      },
      py::arg("robot"), py::arg("logs"), py::kw_only(), py::arg("title") = "",
      "The same plot as loci(), as the text of an SVG file.");
  m.def(
      "support_plot",
      [](const RobotModel& robot, const Logs& logs, const std::string& title, double scale) {
        LociOptions options;
        options.title = title;
        return png([&] { return to_image(draw_support(robot, runs_of(logs), options), scale); });
      },
      py::arg("robot"), py::arg("logs"), py::kw_only(), py::arg("title") = "",
      py::arg("scale") = 1.5,
      "The ground from above, with soles, COG and ZMP, as the bytes of a PNG file.");
  m.def(
      "write_clip",
      [](const RobotModel& robot, const Log& log, const Path& path, int width, int height,
         const std::string& view, double fps, double speed, const std::string& title, int threads,
         py::object progress) {
        ClipOptions options = clip_options(width, height, view, 1, title);
        options.fps = fps;
        options.speed = speed;
        options.threads = threads;
        return Watch(std::move(progress)).run([&](const Progress& watched) {
          return write_clip(robot, log.data(), path, options, watched).frames;
        });
      },
      py::arg("robot"), py::arg("log"), py::arg("path"), py::kw_only(), py::arg("width") = 1280,
      py::arg("height") = 720, py::arg("view") = "iso", py::arg("fps") = 30.0,
      py::arg("speed") = 1.0, py::arg("title") = "", py::arg("threads") = 1,
      py::arg("progress") = py::none(),
      "Writes the run as a film (.mp4, .webm, .gif); needs the program ffmpeg. Returns the number "
      "of frames.");
}

}  // namespace ayumi::python
