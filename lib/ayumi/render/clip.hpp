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
  bool command = false;  ///< the ghost is the commanded posture of the same log
  /// Another run of the same robot that is drawn as a ghost; null for none. It must outlive the
  /// clip.
  const SimulationLog* log = nullptr;
  std::string name = "other run";  ///< name of the other run in the legend
};

struct ClipOptions {
  RenderOptions picture;
  CameraOptions camera;
  OverlayOptions overlay;
  GhostOptions ghost;
  std::shared_ptr<const RobotLook> look = {};  ///< look of the robot; if null, its robot_look()
  /// Largest number of triangles of the robot; if it has more, the surface is simplified.
  size_t max_triangles = 400'000;
  double fps = 30;                 ///< frames per second of the clip
  double speed = 1;                ///< seconds of the run per second of the clip
  double begin = 0;                ///< first instant shown [s]
  double end = -1;                 ///< last instant shown [s]; if negative, the end of the run
  std::optional<double> at;        ///< instant of a single picture [s]; if empty, telling_instant()
  std::string title;               ///< first words of the caption; if empty, the pattern's name
  int threads = 1;                 ///< number of renderers at work; the bytes do not depend on it
  std::string encoder = "ffmpeg";  ///< name of the program
  bool overwrite = false;          ///< a folder of frames replaces an earlier one
};

struct ClipSummary {
  int frames = 0;                 ///< number of frames; 1 for a single picture
  int width = 0, height = 0;      ///< size [pixel]
  double fps = 0;                 ///< frames per second of a clip
  std::optional<double> at = {};  ///< time of a single picture [s]
  std::vector<std::string> notes =
      {};  ///< what is drawn differently from the robot's files, and why
};

/// The data that all renderers of one clip share.
struct ClipShape {
  double height = 1;  ///< height of the robot [m]
  /// Farthest points of each body, in its frame.
  std::vector<std::vector<Eigen::Vector3d>> outline;
  std::shared_ptr<const DrawnRobot> robot;
  Eigen::Vector3f ghost = Eigen::Vector3f::Zero();  ///< colour of the ghost, sRGB
  std::vector<std::string> notes;
};
/// With `thin`, triangles that are too small to be visible in a picture of this size are left out,
/// which saves time if many pictures are drawn. `progress` is called during the work on heavy
/// meshes.
std::shared_ptr<const ClipShape> clip_shape(const RobotModel& model, const SimulationLog& log,
                                            const ClipOptions& options, bool thin,
                                            const Progress& progress = {});

/// Draws one picture of the run at time `t`, overlays and caption included.
class ClipRenderer {
 public:
  /// `model` and `log` must outlive the renderer. Throws Error(usage) for an empty log, options out
  /// of range, or a log of another robot.
  ClipRenderer(const RobotModel& model, const SimulationLog& log, const ClipOptions& options);
  /// `shape` is the result of clip_shape() for the same robot, run and options.
  ClipRenderer(const RobotModel& model, const SimulationLog& log, const ClipOptions& options,
               std::shared_ptr<const ClipShape> shape);
  Image frame(double t);
  /// The picture of frame() as a part of the clip; all pictures of the clip have one legend.
  Image clip_frame(double t);
  /// Gives the memory of `frame` to the next frame. `frame` must no longer be needed.
  void reuse(Image frame) { renderer_.reuse(std::move(frame)); }
  /// A picture for a sheet of several: time and event are written in a corner, and nothing else is
  /// written.
  Image tile(double t);
  /// Gives all later pictures the same frame, which the robot fills at these instants.
  void frame_robot(const std::vector<double>& times);
  /// The lines of a sheet. write_title() writes one line with title, controller and verdict, and
  /// `instants` instead of `t` if a picture shows several. write_legend() writes the marks with
  /// their meanings over as many lines as they need; a push is among them if the picture, the
  /// framed pictures or the whole clip show one. `size` is that of the letters, and the lines begin
  /// at `top` and extend to the right edge [pixel]. Both functions return the height of the lines
  /// [pixel]; without an image, nothing is drawn.
  double write_title(Image& image, double top, double size, double t,
                     const std::string& instants = "") const;
  double write_legend(Image* image, int width, double top, double size) const;
  /// Several instants in one picture. The last is drawn fully; the others are lighter the earlier
  /// they are.
  Image exposures(const std::vector<double>& times);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  const RobotModel& model_;
  const SimulationLog& log_;
  ClipOptions options_;
  std::vector<PushRecord> pushes_;
  std::vector<std::string> notes_;
  double height_;  ///< height of the robot [m]
  /// Farthest points of each body, in its frame.
  std::vector<std::vector<Eigen::Vector3d>> outline_;
  std::optional<Framing> framing_;
  /// Intervals of time that the legend is about [s].
  std::vector<std::pair<double, double>> shown_;
  double verdict_at_;      ///< time from which the verdict holds [s]
  Eigen::Vector3f ghost_;  ///< colour of the ghost, sRGB
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

/// Writes a file of the kind that the name of `path` says. With .mp4, .webm or .gif it is a clip
/// whose frame k shows begin + k speed/fps; with .png, one picture at options.at; without
/// extension, a folder of frame_00000.png and so on. It is written whole or not at all. Throws
/// Error(usage) for options out of range, Error(bad_file) with the path if writing or ffmpeg fails,
/// and Interrupted if `progress` says stop.
ClipSummary write_clip(const RobotModel& model, const SimulationLog& log,
                       const std::filesystem::path& path, const ClipOptions& options,
                       const Progress& progress = {});

}  // namespace ayumi
