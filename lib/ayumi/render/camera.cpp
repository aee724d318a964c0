#include "ayumi/render/camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

struct NamedView {
  const char* name;
  double azimuth,
      elevation;  ///< direction of the camera as seen from the robot; x forward, y left [rad]
  bool parallel = false;
};
constexpr NamedView kViews[] = {{"front", 0.0, 0.14},
                                {"side", -1.5707963267948966, 0.14},
                                {"iso", -0.87, 0.30},
                                {"back", 3.141592653589793, 0.14},
                                {"top", -1.5707963267948966, 1.5},
                                {"ortho-side", -1.5707963267948966, 0.0, true},
                                {"ortho-front", 0.0, 0.0, true}};

// Smallest and largest zoom. Chosen: no picture needs a larger value, and coordinates stay finite
// numbers.
constexpr double kLeastZoom = 1e-6, kMostZoom = 1e6;
constexpr double kFieldOfView =
    0.5;  // angle so small that lengths in the picture can be compared [rad]

// Shares of the COG's first height between which the height of the picture's middle stays, so that
// a squat or a jump can be seen as such. Beyond them, the camera goes down with a fall and up with
// stairs. Chosen: the deepest squat of the patterns lowers the COG to 0.78 of its height, the
// highest jump raises it to 1.2, and a fallen robot's COG is below 0.4.
constexpr double kLowestStance = 0.75, kHighestJump = 1.3;

}  // namespace

Matrix4d view_matrix(const Camera& camera) {
  const Vector3d back = (camera.eye - camera.target).normalized();
  Vector3d right = camera.up.cross(back);
  if (right.norm() < 1e-9) right = back.unitOrthogonal();
  right.normalize();
  const Vector3d up = back.cross(right);
  Matrix4d view = Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = up.transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.topRightCorner<3, 1>() = -view.topLeftCorner<3, 3>() * camera.eye;
  return view;
}

Matrix4d projection_matrix(const Camera& camera, double aspect) {
  const bool parallel = camera.parallel_height > 0;
  const double scale =
      parallel ? 2 / camera.parallel_height : 1 / std::tan(camera.field_of_view / 2);
  Matrix4d projection = Matrix4d::Zero();
  projection(0, 0) = scale / aspect;
  projection(1, 1) = scale;
  if (parallel) {
    projection(2, 2) = -2 / (camera.far - camera.near);
    projection(2, 3) = -(camera.far + camera.near) / (camera.far - camera.near);
    projection(3, 3) = 1;
    return projection;
  }
  projection(2, 2) = -(camera.far + camera.near) / (camera.far - camera.near);
  projection(2, 3) = -2 * camera.far * camera.near / (camera.far - camera.near);
  projection(3, 2) = -1;
  return projection;
}

Vector3d project(const Camera& camera, int width, int height, const Vector3d& point) {
  const Eigen::Vector4d seen = view_matrix(camera) * point.homogeneous();
  const Eigen::Vector4d clip = projection_matrix(camera, double(width) / height) * seen;
  return {(clip.x() / clip.w() + 1) / 2 * width, (1 - clip.y() / clip.w()) / 2 * height, -seen.z()};
}

// Let D be the distance, b how much nearer a point is, and k the tangent of half the view. A point
// is within the picture if
//   |r - shift| <= k (D - b).
// Points lie on both edges if D is (max(r + k b) - min(r - k b)) / (2 k).
Framing framing(const Camera& camera, double aspect, const std::vector<Vector3d>& offsets,
                double share) {
  const bool parallel = camera.parallel_height > 0;
  const double tangent = share * std::tan(camera.field_of_view / 2);
  const std::array<double, 2> k = {tangent * aspect, tangent};
  Framing result;
  if (offsets.empty()) {
    result.distance = parallel ? camera.parallel_height : (camera.eye - camera.target).norm();
    return result;
  }
  const auto edges = [&](int axis, double distance) {  // range of the shift
    Eigen::Vector2d between(-INFINITY, INFINITY);
    for (const Vector3d& p : offsets) {
      const double reach = parallel ? 0.5 * share * distance * (axis == 0 ? aspect : 1.0)
                                    : k[static_cast<size_t>(axis)] * (distance - p.z());
      between[0] = std::max(between[0], p[axis] - reach);
      between[1] = std::min(between[1], p[axis] + reach);
    }
    return between;
  };
  for (const int axis : {0, 1}) {
    const Eigen::Vector2d at_zero = edges(axis, 0);
    // Growth of the visible part for each metre of distance, or of height in a parallel view.
    const double gained =
        parallel ? share * (axis == 0 ? aspect : 1.0) : 2 * k[static_cast<size_t>(axis)];
    result.distance = std::max(result.distance, (at_zero[0] - at_zero[1]) / gained);
  }
  result.right = edges(0, result.distance).mean();
  result.up = edges(1, result.distance).mean();
  return result;
}

Camera framed(const Camera& camera, const Framing& framing) {
  Camera moved = camera;
  const Eigen::Matrix3d axes = view_matrix(camera).topLeftCorner<3, 3>().transpose();
  moved.target += framing.right * axes.col(0) + framing.up * axes.col(1);
  if (camera.parallel_height > 0) {
    moved.eye += moved.target - camera.target;
    moved.parallel_height = framing.distance;
    return moved;
  }
  moved.eye = moved.target + framing.distance * axes.col(2);
  moved.near = 0.05 * framing.distance;
  moved.far = 60 * framing.distance;
  return moved;
}

const std::vector<std::string>& view_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedView& view : kViews) list.emplace_back(view.name);
    return list;
  }();
  return names;
}

CameraPath::CameraPath(const CameraOptions& options, std::vector<Vector3d> cog, double dt,
                       double height, double aspect)
    : options_(options), dt_(dt), height_(height), aspect_(aspect) {
  const auto view = std::find_if(std::begin(kViews), std::end(kViews),
                                 [&](const NamedView& v) { return options.view == v.name; });
  if (view == std::end(kViews))
    fail(ErrorCode::usage, "view: '" + options.view + "' is not one of " +
                               text::join(view_names(), ", ") +
                               text::suggestion(options.view, view_names()));
  if (!(options.zoom >= kLeastZoom && options.zoom <= kMostZoom))
    fail(ErrorCode::usage, "zoom: " + text::exact(options.zoom) +
                               " is not possible; give a number from " + text::brief(kLeastZoom) +
                               " to " + text::brief(kMostZoom));
  require(!cog.empty() && dt > 0 && height > 0 && aspect > 0, "a camera path needs a motion");
  azimuth_ = view->azimuth;
  elevation_ = view->elevation;
  parallel_ = view->parallel;
  sums_.push_back(Vector3d::Zero());
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : cog) {
    sums_.push_back(sums_.back() + point);
    box.extend(point);
  }
  center_ = box.center();
  center_.z() = cog.front().z();
  if (options.mode == CameraMode::fixed) reach_ = box.sizes().head<2>().norm();
}

Vector3d CameraPath::mean(double from, double to) const {
  const double last = static_cast<double>(sums_.size()) - 2;
  const auto begin = static_cast<size_t>(std::clamp(std::round(from / dt_), 0.0, last));
  const auto end = static_cast<size_t>(std::clamp(std::round(to / dt_), 0.0, last)) + 1;
  return (sums_[end] - sums_[begin]) / static_cast<double>(end - begin);
}

Camera CameraPath::at(double t) const {
  Camera camera;
  camera.field_of_view = kFieldOfView;
  camera.target = options_.mode == CameraMode::fixed
                      ? center_
                      : mean(t - options_.smoothing, t + options_.smoothing);
  const double first = center_.z();
  const double beyond =
      options_.mode == CameraMode::fixed
          ? 0.0
          : camera.target.z() -
                std::clamp(camera.target.z(), kLowestStance * first, kHighestJump * first);
  camera.target.z() = 0.92 * first + beyond;
  // The robot takes two thirds of the picture's height. If the path is wide, the fixed camera is
  // farther away.
  const double tall = 1.5 * height_;
  const double wide = (1.2 * height_ + reach_) / std::max(aspect_, 0.1);
  const double distance = std::max(tall, wide) / (2 * std::tan(kFieldOfView / 2)) / options_.zoom;
  const double azimuth =
      azimuth_ + (options_.mode == CameraMode::orbit ? options_.orbit_rate * t : 0.0);
  camera.eye = camera.target + distance * Vector3d(std::cos(azimuth) * std::cos(elevation_),
                                                   std::sin(azimuth) * std::cos(elevation_),
                                                   std::sin(elevation_));
  camera.near = 0.05 * distance;
  camera.far = 60 * distance;
  if (parallel_) camera.parallel_height = std::max(tall, wide) / options_.zoom;
  return camera;
}

}  // namespace ayumi
