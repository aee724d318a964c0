#include "ayumi/geometry/penetration.hpp"

#include <gtest/gtest.h>

#include "ayumi/geometry/distance.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Solid solid_of(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return {Solid::Kind::box, 0.5 * box->size, 0, 0};
  if (const auto* c = std::get_if<Cylinder>(&shape))
    return {Solid::Kind::cylinder, Vector3d::Zero(), c->radius, 0.5 * c->length};
  const auto& capsule = std::get<Capsule>(shape);
  return {Solid::Kind::capsule, Vector3d::Zero(), capsule.radius, 0.5 * capsule.length};
}

TEST(Penetration, KnownDepths) {
  const Solid box = solid_of(Box{{0.1, 0.2, 0.3}});
  const Solid rod = solid_of(Cylinder{0.02, 0.1}), ball = solid_of(Capsule{0.03, 0});
  const Isometry3d here = Isometry3d::Identity();
  Isometry3d there = here;
  there.translation() << 0.06, 0.01, 0.02;
  EXPECT_NEAR(overlap(box, here, box, there), 0.04, 1e-9);
  EXPECT_NEAR(overlap(box, here, rod, there), 0.01, 1e-9);
  EXPECT_NEAR(overlap(box, here, ball, there), 0.02, 1e-9);
  there.translation() << 0.01, 0.02, 0.02;
  EXPECT_NEAR(overlap(ball, here, ball, there), 0.06 - 0.03, 1e-6);
  // Two rods side by side touch along a line, in any direction.
  for (double angle = 0; angle < 6; angle += 0.37) {
    there.translation() << 0.03 * std::cos(angle), 0.03 * std::sin(angle), 0.01;
    EXPECT_NEAR(overlap(rod, here, rod, there), 0.01, 1e-6);
  }
}

// By the distance of parted bodies, which is found another way: no shift shorter than the depth
// parts them, some shift a little longer does.
TEST(Penetration, IsTheShortestShiftThatParts) {
  const std::vector<Shape> shapes = {Box{{0.08, 0.12, 0.07}}, Box{{0.03, 0.03, 0.1}},
                                     Cylinder{0.016, 0.05}, Capsule{0.015, 0.06}};
  Random random(3);
  const auto unit = [&] {
    return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  for (int n = 0; n < 32; ++n) {
    const Shape &a = shapes[n % 4], &b = shapes[(n / 4) % 4];
    const Collider first(a), second(b);
    Isometry3d A = Isometry3d::Identity(), B = A;
    A.linear() = exp_rotation(3 * unit()).toRotationMatrix();
    B.linear() = exp_rotation(3 * unit()).toRotationMatrix();
    B.translation() = 0.02 * unit();
    const double depth = overlap(solid_of(a), A, solid_of(b), B);
    if (depth <= 0) continue;
    const auto parted = [&](double way, const Vector3d& d) {
      Isometry3d moved = B;
      moved.translation() += way * d;
      return clearance(first, A, second, moved) > 1e-6;
    };
    bool some = false;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d d = unit();
      EXPECT_FALSE(parted(0.99 * depth, d)) << n;
      some = some || parted(1.1 * depth + 2e-4, d);
    }
    EXPECT_TRUE(some) << n << " " << depth;
    EXPECT_NEAR(clearance(first, A, second, B), -depth, 1e-4);
  }
}

}  // namespace
}  // namespace ayumi::test
