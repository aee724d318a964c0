#include "ayumi/render/ground_plane.hpp"

#include <algorithm>

#include "ayumi/base/error.hpp"

namespace ayumi {

using Eigen::Matrix4f;
using Eigen::Vector3d;

GroundRectangle ground_rectangle(const Eigen::Isometry3d& frame, const Eigen::AlignedBox3d& box,
                                 const Vector3d& sun) {
  GroundRectangle ground;
  ground.origin = frame.translation();
  ground.u = frame.linear().col(0);
  ground.v = frame.linear().col(1);
  ground.normal = frame.linear().col(2);
  Eigen::AlignedBox2d square;
  for (int i = 0; i < 8; ++i) {
    Vector3d p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)) - ground.origin;
    p -= sun * (ground.normal.dot(p) / ground.normal.dot(sun));
    square.extend(Eigen::Vector2d(ground.u.dot(p), ground.v.dot(p)));
  }
  ground.center = square.center();
  ground.reach = 0.5 * square.sizes().maxCoeff() * 1.1;
  return ground;
}

// With p measured from the plane's origin, the map is
//   p -> ((p - s (n.p)/(n.s)) . u - center) / reach,
// and the same for v.
Eigen::Matrix4d flattening(const GroundRectangle& plane, const Vector3d& sun) {
  const Eigen::Matrix3d fall =
      Eigen::Matrix3d::Identity() - sun * plane.normal.transpose() / plane.normal.dot(sun);
  Eigen::Matrix4d flatten = Eigen::Matrix4d::Zero();
  flatten.block<1, 3>(0, 0) = plane.u.transpose() * fall / plane.reach;
  flatten.block<1, 3>(1, 0) = plane.v.transpose() * fall / plane.reach;
  flatten.topRightCorner<2, 1>() =
      -plane.center / plane.reach - flatten.topLeftCorner<2, 3>() * plane.origin;
  flatten(3, 3) = 1;
  return flatten;
}

double horizon_height(const Camera& camera, const Vector3d& normal, const Matrix4f& to_clip) {
  if (camera.parallel_height > 0) {  // the ground is seen from the side
    const Eigen::Vector4f clip = to_clip * camera.target.cast<float>().homogeneous();
    return clip.y() - 2 * normal.dot(camera.target) / camera.parallel_height;
  }
  const Vector3d ahead = camera.target - camera.eye;
  const Vector3d level = ahead - normal * normal.dot(ahead);
  if (level.norm() < 1e-3 * ahead.norm()) return 1;
  const Eigen::Vector4f clip =
      to_clip *
      level.normalized().cast<float>().homogeneous().cwiseProduct(Eigen::Vector4f(1, 1, 1, 0));
  return std::clamp(double(clip.y() / clip.w()), -1.0, 2.0);
}

void blur(std::vector<std::uint8_t>& image, int size, int radius) {
  const auto n = static_cast<size_t>(size), r = static_cast<size_t>(radius), width = 2 * r + 1;
  std::vector<std::uint8_t> smooth(image.size());  // mean over a box along rows
  std::vector<std::uint16_t> sums(n);  // sums of a box along columns, for a whole row at a time
  // Multiplying by this number and shifting divides every sum of `width` bytes by `width` exactly.
  const std::uint32_t part = (1u << 24) / static_cast<std::uint32_t>(width) + 1;
  require(width <= 255, "a shadow is blurred too widely");
  const auto mean = [&](std::uint32_t sum) { return static_cast<std::uint8_t>(sum * part >> 24); };
  const auto add_row = [&](size_t y, int sign) {
    for (size_t x = 0; x < n; ++x)
      sums[x] = static_cast<std::uint16_t>(sums[x] + sign * smooth[y * n + x]);
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (size_t y = 0; y < n; ++y) {
      const std::uint8_t* from = &image[y * n];
      std::uint32_t sum = 0;
      for (size_t x = 0; x < std::min(r, n); ++x) sum += from[x];
      for (size_t x = 0; x < n; ++x) {
        if (x + r < n) sum += from[x + r];
        if (x > r) sum -= from[x - r - 1];
        smooth[y * n + x] = mean(sum);
      }
    }
    std::fill(sums.begin(), sums.end(), std::uint16_t(0));
    for (size_t y = 0; y < std::min(r, n); ++y) add_row(y, 1);
    for (size_t y = 0; y < n; ++y) {
      if (y + r < n) add_row(y + r, 1);
      if (y > r) add_row(y - r - 1, -1);
      for (size_t x = 0; x < n; ++x) image[y * n + x] = mean(sums[x]);
    }
  }
}

Eigen::Vector4f covered(const std::vector<std::uint8_t>& image, int size) {
  int low_x = size, high_x = -1, low_y = size, high_y = -1;
  for (int y = 0; y < size; ++y) {
    const std::uint8_t* row = &image[size_t(y) * size_t(size)];
    const auto dark = [](std::uint8_t value) { return value != 0; };
    const std::uint8_t* first = std::find_if(row, row + size, dark);
    if (first == row + size) continue;
    low_x = std::min(low_x, static_cast<int>(first - row));
    int last = size - 1;
    while (!row[last]) --last;
    high_x = std::max(high_x, last);
    low_y = std::min(low_y, y);
    high_y = y;
  }
  if (high_x < 0) return Eigen::Vector4f::Zero();
  const auto place = [&](int pixel) { return std::clamp(2.0f * pixel / size - 1, -1.0f, 1.0f); };
  const float left = place(low_x - 1), right = place(high_x + 2);
  const float bottom = place(low_y - 1), top = place(high_y + 2);
  return {0.5f * (left + right), 0.5f * (bottom + top), 0.5f * (right - left),
          0.5f * (top - bottom)};
}

Vector3d sun_behind(const Camera& camera, const Vector3d& up) {
  const Vector3d toward = (camera.eye - camera.target).normalized();
  Vector3d flat_toward = toward - up * up.dot(toward);
  if (flat_toward.norm() < 1e-6) flat_toward = up.unitOrthogonal();
  flat_toward.normalize();
  return (0.35 * flat_toward - 0.5 * up.cross(flat_toward) + 1.2 * up).normalized();
}

}  // namespace ayumi
