#pragma once
// The camera of a picture. Image x to the right, y down; the centres of the pixels are at half
// numbers.

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace ayumi {

/// A pinhole looking from `eye` at `target`, or a parallel projection. World frame [m].
struct Camera {
  Eigen::Vector3d eye = {2, -2, 1};
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double field_of_view = 0.5;     ///< vertical, full angle [rad]
  double near = 0.05, far = 100;  ///< clipping distances [m]
  /// Height that a parallel projection shows [m]; 0: a pinhole.
  double parallel_height = 0;
};

/// World to camera: x right, y up, looking along -z. Finite also when looking along `up`.
Eigen::Matrix4d view_matrix(const Camera& camera);
/// Camera to clip space, as OpenGL has it.
Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect);
/// Pixel of a world point; (x, y, distance along the view axis [m], negative behind the camera).
Eigen::Vector3d project(const Camera& camera, int width, int height, const Eigen::Vector3d& point);

enum class CameraMode {
  follow,  ///< the target moves with the robot, smoothed
  fixed,   ///< stands still, aimed at the middle of the whole path
  orbit    ///< follows and turns around the robot
};

struct CameraOptions {
  CameraMode mode = CameraMode::follow;
  std::string view = "iso";  ///< one of view_names()
  double zoom = 1;           ///< 2 shows the robot twice as large
  double orbit_rate = 0.5;   ///< [rad/s]
  double smoothing = 0.6;    ///< half width of the window that smooths the target [s]
};

/// Names that CameraOptions::view takes; "ortho-side" and "ortho-front" are parallel projections.
const std::vector<std::string>& view_names();

/// How `camera` moves across its view, and nearer or farther, so that points are just within a
/// share of the picture. `offsets` count from the camera's target in axes of the view (right, up,
/// back) [m], so that several instants get pictures of one scale.
struct Framing {
  double right = 0, up = 0;  ///< by which the target moves across the view [m]
  double distance = 0;       ///< of a pinhole from the target, or the height of a parallel view [m]
};
Framing framing(const Camera& camera, double aspect, const std::vector<Eigen::Vector3d>& offsets,
                double share);
Camera framed(const Camera& camera, const Framing& framing);

/// The cameras of a clip: a target path from the COG at a fixed rate, and a distance at which a
/// robot of this height fits. The camera depends on the time alone, not on the order in which
/// frames are requested.
class CameraPath {
 public:
  /// `cog` at k dt, world [m]; `height` of the robot [m]; `aspect` width / height of the picture.
  /// Throws Error(usage) for an unknown view, naming the known ones.
  CameraPath(const CameraOptions& options, std::vector<Eigen::Vector3d> cog, double dt,
             double height, double aspect);
  Camera at(double t) const;

 private:
  CameraOptions options_;
  std::vector<Eigen::Vector3d> sums_;  ///< running sums of the COG
  double dt_, height_, aspect_, reach_ = 0;
  Eigen::Vector3d center_;
  double azimuth_ = 0, elevation_ = 0;
  bool parallel_ = false;

  Eigen::Vector3d mean(double from, double to) const;
};

}  // namespace ayumi
