#include "ayumi/render/camera.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {
namespace {

using Eigen::Matrix4d;
using Eigen::Vector3d;

struct NamedView {
  const char* name;
  double azimuth, elevation;  ///< of the camera seen from the robot; x forward, y left [rad]
};
constexpr NamedView kViews[] = {{"front", 0.0, 0.14},
                                {"side", -1.5707963267948966, 0.14},
                                {"iso", -0.87, 0.30},
                                {"back", 3.141592653589793, 0.14},
                                {"top", -1.5707963267948966, 1.5}};

constexpr double kFieldOfView = 0.5;  // [rad] so narrow that lengths can be compared

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
  const double scale = 1 / std::tan(camera.field_of_view / 2);
  Matrix4d projection = Matrix4d::Zero();
  projection(0, 0) = scale / aspect;
  projection(1, 1) = scale;
  projection(2, 2) = -(camera.far + camera.near) / (camera.far - camera.near);
  projection(2, 3) = -2 * camera.far * camera.near / (camera.far - camera.near);
  projection(3, 2) = -1;
  return projection;
}

Vector3d project(const Camera& camera, int width, int height, const Vector3d& point) {
  const Eigen::Vector4d clip =
      projection_matrix(camera, double(width) / height) * view_matrix(camera) * point.homogeneous();
  return {(clip.x() / clip.w() + 1) / 2 * width, (1 - clip.y() / clip.w()) / 2 * height, clip.w()};
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
  if (!(options.zoom > 0))
    fail(ErrorCode::usage,
         "zoom: " + text::exact(options.zoom) + " is not possible; give a number above 0");
  require(!cog.empty() && dt > 0 && height > 0 && aspect > 0, "a camera path needs a motion");
  azimuth_ = view->azimuth;
  elevation_ = view->elevation;
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
  // The height of the picture's middle stays, so that a fall or a jump is seen as one.
  camera.target.z() = center_.z() * 0.92;
  // The robot takes two thirds of the height; a path that is wide moves the fixed camera away.
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
  return camera;
}

}  // namespace ayumi
