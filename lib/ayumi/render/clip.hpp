#pragma once
// A run as a clip, a single picture or a folder of frames. Nothing is simulated again.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/progress.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/render/camera.hpp"
#include "ayumi/render/overlay.hpp"
#include "ayumi/render/renderer.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/render/scenery.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// A second, translucent robot.
struct GhostOptions {
  bool command = false;                ///< the commanded posture of the same log
  const SimulationLog* log = nullptr;  ///< or another run of the same robot; must outlive the clip
  std::string name = "other run";      ///< of that one, in the legend
};

struct ClipOptions {
  RenderOptions picture;
  CameraOptions camera;
  OverlayOptions overlay;
  GhostOptions ghost;
  std::shared_ptr<const RobotLook> look = {};  ///< of the robot; null: robot_look() of it
  size_t max_triangles = 400'000;  ///< of the robot; beyond it the surface is simplified
  double fps = 30;                 ///< frames per second of the clip
  double speed = 1;                ///< seconds of the run per second of the clip
  double begin = 0;                ///< first instant shown [s]
  double end = -1;                 ///< last; negative: of the run [s]
  std::optional<double> at;        ///< instant of a single picture [s]; none: telling_instant()
  std::string title;               ///< first words of the caption; empty: the pattern's name
  int threads = 1;                 ///< renderers at work; the bytes do not depend on it
  std::string encoder = "ffmpeg";  ///< program
  bool overwrite = false;          ///< a folder of frames takes the place of an earlier one
};

struct ClipSummary {
  int frames = 0;
  int width = 0, height = 0;  ///< [pixel]
  double fps = 0;
  std::vector<std::string> notes;  ///< what is drawn otherwise than the robot's files say, and why
};

/// What all renderers of one clip share.
struct ClipShape {
  double height = 1;                                  ///< of the robot [m]
  std::vector<std::vector<Eigen::Vector3d>> outline;  ///< farthest points of each body, its frame
  std::shared_ptr<const DrawnRobot> robot;
  Eigen::Vector3f ghost = Eigen::Vector3f::Zero();  ///< sRGB
  std::vector<std::string> notes;
};
/// `thin`: triangles that are too small to be visible in a picture of this size are left out, which
/// saves time if many pictures are drawn. `progress` is called during the work on heavy meshes.
std::shared_ptr<const ClipShape> clip_shape(const RobotModel& model, const SimulationLog& log,
                                            const ClipOptions& options, bool thin,
                                            const Progress& progress = {});

/// One picture of the run at `t`, overlays and caption included.
class ClipRenderer {
 public:
  /// `model` and `log` must outlive it. Throws Error(usage) for an empty log, options out of range,
  /// or a log of another robot.
  ClipRenderer(const RobotModel& model, const SimulationLog& log, const ClipOptions& options);
  /// `shape` as clip_shape() gives it for the same robot, run and options.
  ClipRenderer(const RobotModel& model, const SimulationLog& log, const ClipOptions& options,
               std::shared_ptr<const ClipShape> shape);
  Image frame(double t);
  /// The same as a part of the clip, the legend of which is that of all its pictures.
  Image clip_frame(double t);
  /// The next frame takes the memory of this one, which nobody needs any more.
  void reuse(Image frame) { renderer_.reuse(std::move(frame)); }
  /// One of several on a sheet: time and event are written in a corner, and nothing else.
  Image tile(double t);
  /// All later pictures have the same frame, which the robot fills at these instants.
  void frame_robot(const std::vector<double>& times);
  /// A sheet's lines: title, controller and verdict; the marks with their meanings, over as many
  /// lines as they need. `size` of the letters [pixel]; (left, top) to the right edge. They return
  /// the height they take [pixel]; nothing is drawn without an image. A push is among the marks
  /// where the picture, the framed ones or the whole clip show one.
  /// `instants` stand in place of t where a picture shows several.
  double write_title(Image& image, double top, double size, double t,
                     const std::string& instants = "") const;
  double write_legend(Image* image, int width, double top, double size) const;
  /// Several instants in one picture: the last in full, the others lighter the earlier they are.
  Image exposures(const std::vector<double>& times);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  const RobotModel& model_;
  const SimulationLog& log_;
  ClipOptions options_;
  std::vector<PushRecord> pushes_;
  std::vector<std::string> notes_;
  double height_;                                      ///< of the robot [m]
  std::vector<std::vector<Eigen::Vector3d>> outline_;  ///< farthest points of each body, its frame
  std::optional<Framing> framing_;
  std::vector<std::pair<double, double>> shown_;  ///< times that the legend is about [s]
  double verdict_at_;                             ///< [s]
  Eigen::Vector3f ghost_;                         ///< sRGB
  std::vector<RisingBump> bumps_;
  Renderer renderer_;
  CameraPath path_;

  Scene scene_at(double t, Overlay& overlay) const;
  void add_ghost(double t, Scene& scene) const;
  Image finished(const Scene& scene, const Overlay& overlay, double t);
  Image drawn(double t);
  void write_caption(Image& image, double t, const std::string& instants = "") const;
  void write_scale(Image& image, const Camera& camera, double t) const;
};

/// Writes by the name of `path`: .mp4, .webm, .gif: a clip whose frame k shows begin + k speed/fps;
/// .png: one picture at options.at; no extension: a folder of frame_00000.png, ... Whole or not at
/// all. Throws Error(usage) for options out of range, Error(bad_file) naming the path where writing
/// or ffmpeg fails, Interrupted when `progress` says stop.
ClipSummary write_clip(const RobotModel& model, const SimulationLog& log,
                       const std::filesystem::path& path, const ClipOptions& options,
                       const Progress& progress = {});

}  // namespace ayumi
