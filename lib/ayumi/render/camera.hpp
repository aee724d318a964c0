#pragma once
// The camera of a picture. In the image, x is to the right and y is down. The centre of a pixel is
// half a pixel to the right of and below its corner.

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace ayumi {

/// A pinhole camera that looks from `eye` at `target`, or a parallel projection. All is in the
/// world frame [m].
struct Camera {
  Eigen::Vector3d eye = {2, -2, 1};
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double field_of_view = 0.5;     ///< full vertical angle of the view [rad]
  double near = 0.05, far = 100;  ///< clipping distances [m]
  /// Height that a parallel projection shows [m]; 0 for a pinhole camera.
  double parallel_height = 0;
};

/// The map from the world to the camera's axes: x right, y up, looking along -z. It is also finite
/// if the camera looks along `up`.
Eigen::Matrix4d view_matrix(const Camera& camera);
/// The map from the camera's axes to clip space, as in OpenGL.
Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect);
/// The pixel of a world point, as (x, y, distance along the view axis [m], which is negative behind
/// the camera).
Eigen::Vector3d project(const Camera& camera, int width, int height, const Eigen::Vector3d& point);

enum class CameraMode {
  follow,  ///< the target moves with the robot, smoothed
  fixed,   ///< the camera stands still and is aimed at the middle of the whole path
  orbit    ///< the camera follows the robot and turns around it
};

struct CameraOptions {
  CameraMode mode = CameraMode::follow;
  std::string view = "iso";  ///< one of view_names()
  double zoom = 1;           ///< with 2, the robot is shown twice as large
  double orbit_rate = 0.5;   ///< angular velocity of the orbit [rad/s]
  double smoothing = 0.6;    ///< half width of the window that smooths the target [s]
};

/// The names that CameraOptions::view takes; "ortho-side" and "ortho-front" are parallel
/// projections.
const std::vector<std::string>& view_names();

/// How a camera has to move, across its view and nearer or farther, so that given points just fill
/// a share of the picture. `offsets` are the points relative to the camera's target, in axes of the
/// view (right, up, back) [m]. With the points of several instants, the pictures of these instants
/// have the same scale.
struct Framing {
  double right = 0, up = 0;  ///< distances by which the target moves across the view [m]
  /// Distance of a pinhole camera from the target, or the height of a parallel view [m].
  double distance = 0;
};
Framing framing(const Camera& camera, double aspect, const std::vector<Eigen::Vector3d>& offsets,
                double share);
Camera framed(const Camera& camera, const Framing& framing);

/// The cameras of a clip: the path of the target from the COG at a fixed rate, and a distance at
/// which a robot of this height fits into the picture. The camera depends only on the time, not on
/// the order in which frames are requested.
class CameraPath {
 public:
  /// `cog` is the COG at times k dt in the world [m], `height` is that of the robot [m], and
  /// `aspect` is width / height of the picture. Throws Error(usage) that lists the known views for
  /// an unknown one.
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
