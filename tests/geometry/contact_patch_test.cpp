#include "ayumi/geometry/contact_patch.hpp"

#include <gtest/gtest.h>

#include <set>

#include "ayumi/math/rotation.hpp"

namespace ayumi {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d at(const Vector3d& place, const Vector3d& turn = Vector3d::Zero()) {
  return Eigen::Translation3d(place) * exp_rotation(turn);
}

/// The largest distance of a point of `expected` from the patch.
double misses(const ContactPatch& patch, const std::vector<Vector3d>& expected) {
  double worst = 0;
  for (const Vector3d& p : expected) {
    double nearest = 1e9;
    for (int i = 0; i < patch.count; ++i)
      nearest = std::min(nearest, (patch.points[static_cast<size_t>(i)].position - p).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(ContactPatch, EqualBoxesShareFourCorners) {
  const Collider box(Box{{0.2, 0.1, 0.04}});
  for (const double gap : {-1e-7, 0.0, 1e-4}) {
    // Everything is turned and moved together: nothing depends on the axes.
    const Isometry3d all = at({3, -2, 1}, {0.4, -0.3, 1.1});
    const ContactPatch patch = contact_patch(box, all, box, all * at({0, 0, 0.04 + gap}), 1e-3);
    ASSERT_EQ(patch.count, 4);
    EXPECT_LT((patch.normal - all.linear().col(2)).norm(), 1e-9);
    std::vector<Vector3d> corners;
    for (const double x : {-0.1, 0.1})
      for (const double y : {-0.05, 0.05})
        corners.push_back(all * Vector3d(x, y, 0.02 + 0.5 * gap));
    EXPECT_LT(misses(patch, corners), 1e-9);
    for (int i = 0; i < 4; ++i) EXPECT_NEAR(patch.points[static_cast<size_t>(i)].gap, gap, 1e-12);
  }
}

// The planks lie across each other: no corner of one lies on the other.
TEST(ContactPatch, CrossedPlanksMeetWhereTheirEdgesCross) {
  const Collider plank(Box{{0.4, 0.06, 0.02}});
  const ContactPatch patch =
      contact_patch(plank, at({0, 0, 0}), plank, at({0.05, 0.1, 0.02}, {0, 0, M_PI / 2}), 1e-3);
  ASSERT_EQ(patch.count, 4);
  EXPECT_LT(
      misses(patch,
             {{0.02, -0.03, 0.01}, {0.08, -0.03, 0.01}, {0.02, 0.03, 0.01}, {0.08, 0.03, 0.01}}),
      1e-9);
  std::set<int> ids;
  for (int i = 0; i < 4; ++i) ids.insert(patch.points[static_cast<size_t>(i)].id);
  EXPECT_EQ(ids.size(), 4u);
}

TEST(ContactPatch, TiltedBoxTouchesWithItsLowerEdge) {
  const Collider box(Box{{0.1, 0.1, 0.1}});
  const double tilt = 0.02;
  const double height = 0.05 + 0.05 * (std::cos(tilt) + std::sin(tilt));
  const ContactPatch patch =
      contact_patch(box, at({0, 0, 0}), box, at({-0.03, 0, height}, {0, tilt, 0}), 5e-4);
  ASSERT_EQ(patch.count, 2);  // the other edge is 2 mm up
  const double x = -0.03 + 0.05 * (std::cos(tilt) - std::sin(tilt));
  EXPECT_LT(misses(patch, {{x, -0.05, 0.05}, {x, 0.05, 0.05}}), 1e-9);
  EXPECT_NEAR(patch.normal.z(), 1, 1e-9);
}

TEST(ContactPatch, RoundShapesOnABox) {
  const Collider box(Box{{1, 1, 0.1}}), ball(Sphere{0.05}), rod(Capsule{0.02, 0.2}),
      can(Cylinder{0.03, 0.1});
  const Isometry3d ground = at({0, 0, 0});
  ContactPatch patch = contact_patch(box, ground, ball, at({0.1, 0, 0.0999}), 1e-3);
  ASSERT_EQ(patch.count, 1);
  EXPECT_NEAR(patch.points[0].gap, -1e-4, 1e-9);
  EXPECT_LT((patch.points[0].position - Vector3d(0.1, 0, 0.05)).norm(), 1e-4);
  // A rod and a can are lying: the patch has the ends of the line of contact.
  patch = contact_patch(box, ground, rod, at({0, 0, 0.07}, {M_PI / 2, 0, 0}), 1e-3);
  ASSERT_EQ(patch.count, 2);
  EXPECT_LT(misses(patch, {{0, -0.1, 0.05}, {0, 0.1, 0.05}}), 1e-9);
  patch = contact_patch(can, at({0, 0, 0.08}, {M_PI / 2, 0, 0}), box, ground, 1e-3);
  ASSERT_EQ(patch.count, 2);
  EXPECT_LT(misses(patch, {{0, -0.05, 0.05}, {0, 0.05, 0.05}}), 1e-9);
  EXPECT_NEAR(patch.normal.z(), -1, 1e-9);
  // The can is standing: the patch is a ring.
  patch = contact_patch(box, ground, can, at({0.2, 0, 0.1}), 1e-3);
  ASSERT_EQ(patch.count, 8);
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR((patch.points[static_cast<size_t>(i)].position - Vector3d(0.2, 0, 0.05)).norm(),
                0.03, 1e-9);
}

TEST(ContactPatch, EdgeAcrossEdgeIsOnePointAndFarIsNone) {
  const Collider bar(Box{{0.4, 0.02, 0.02}});
  const double diagonal = 0.01 * std::sqrt(2.0);
  const Isometry3d low = at({0, 0, 0}, {M_PI / 4, 0, 0});
  const Isometry3d high = at({0, 0, 2 * diagonal - 1e-4}) * exp_rotation({0, 0, M_PI / 2}) *
                          exp_rotation({M_PI / 4, 0, 0});
  const ContactPatch patch = contact_patch(bar, low, bar, high, 1e-3);
  ASSERT_EQ(patch.count, 1);
  EXPECT_NEAR(patch.points[0].gap, -1e-4, 1e-8);
  EXPECT_LT((patch.points[0].position - Vector3d(0, 0, diagonal)).norm(), 1e-4);
  EXPECT_EQ(contact_patch(bar, low, bar, at({0, 0, 0.1}), 1e-3).count, 0);
}

}  // namespace
}  // namespace ayumi
