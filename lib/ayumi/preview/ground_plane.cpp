#include "ayumi/preview/ground_plane.hpp"

#include <algorithm>

namespace ayumi {

using Eigen::Matrix4f;
using Eigen::Vector3d;

Ground make_ground(const Vector3d& origin, const Vector3d& normal, const Eigen::AlignedBox3d& box,
                   const Vector3d& sun) {
  Ground ground;
  ground.origin = origin;
  ground.normal = normal.normalized();
  ground.u = (Vector3d::UnitX() - ground.normal.x() * ground.normal).normalized();
  ground.v = ground.normal.cross(ground.u);
  Eigen::AlignedBox2d square;
  for (int i = 0; i < 8; ++i) {
    Vector3d p = box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)) - origin;
    p -= sun * (ground.normal.dot(p) / ground.normal.dot(sun));
    square.extend(Eigen::Vector2d(ground.u.dot(p), ground.v.dot(p)));
  }
  ground.center = square.center();
  ground.reach = 0.5 * square.sizes().maxCoeff() * 1.1;
  return ground;
}

double horizon_height(const Camera& camera, const Vector3d& normal, const Matrix4f& to_clip) {
  const Vector3d ahead = camera.target - camera.eye;
  const Vector3d level = ahead - normal * normal.dot(ahead);
  if (level.norm() < 1e-3 * ahead.norm()) return 1;
  const Eigen::Vector4f clip =
      to_clip *
      level.normalized().cast<float>().homogeneous().cwiseProduct(Eigen::Vector4f(1, 1, 1, 0));
  return std::clamp(double(clip.y() / clip.w()), -1.0, 2.0);
}

void blur(std::vector<std::uint8_t>& image, int size, int radius) {
  std::vector<std::uint8_t> line(static_cast<size_t>(size));
  const auto smooth = [&](std::uint8_t* data, int stride) {
    int sum = 0;
    for (int i = 0; i < size; ++i) line[size_t(i)] = data[i * stride];
    for (int i = 0; i < radius; ++i) sum += line[size_t(i)];
    for (int i = 0; i < size; ++i) {
      if (i + radius < size) sum += line[size_t(i + radius)];
      if (i - radius - 1 >= 0) sum -= line[size_t(i - radius - 1)];
      data[i * stride] = static_cast<std::uint8_t>(sum / (2 * radius + 1));
    }
  };
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < size; ++i) smooth(&image[size_t(i) * size_t(size)], 1);
    for (int i = 0; i < size; ++i) smooth(&image[size_t(i)], size);
  }
}

Vector3d sun_behind(const Camera& camera, const Vector3d& up) {
  const Vector3d toward = (camera.eye - camera.target).normalized();
  Vector3d flat_toward = toward - up * up.dot(toward);
  if (flat_toward.norm() < 1e-6) flat_toward = up.unitOrthogonal();
  flat_toward.normalize();
  return (0.35 * flat_toward - 0.5 * up.cross(flat_toward) + 1.2 * up).normalized();
}

}  // namespace ayumi
