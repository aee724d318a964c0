#include "ayumi/render/thin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/clip.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

size_t count(const Triangles& surface) { return surface.indices.size() / 3; }

Vector3d corner(const Triangles& surface, size_t i) {
  return surface.vertices[surface.indices[i]].position.cast<double>();
}

double volume(const Triangles& surface) {
  double sum = 0;
  for (size_t i = 0; i < surface.indices.size(); i += 3)
    sum += corner(surface, i).dot(corner(surface, i + 1).cross(corner(surface, i + 2))) / 6;
  return sum;
}

double area(const Triangles& surface) {
  double sum = 0;
  for (size_t i = 0; i < surface.indices.size(); i += 3)
    sum += 0.5 * (corner(surface, i + 1) - corner(surface, i))
                     .cross(corner(surface, i + 2) - corner(surface, i))
                     .norm();
  return sum;
}

/// The distance of a point from the nearest triangle.
double distance(const Vector3d& p, const Triangles& surface) {
  double least = INFINITY;
  for (size_t i = 0; i < surface.indices.size(); i += 3) {
    const Vector3d a = corner(surface, i), u = corner(surface, i + 1) - a;
    const Vector3d v = corner(surface, i + 2) - a, n = u.cross(v);
    const double size = n.squaredNorm();
    if (size > 0) {
      const double s = (p - a).cross(v).dot(n) / size, t = u.cross(p - a).dot(n) / size;
      if (s >= 0 && t >= 0 && s + t <= 1) {
        least = std::min(least, std::abs((p - a).dot(n)) / std::sqrt(size));
        continue;
      }
    }
    for (const auto& [from, to] : {std::pair{a, Vector3d(a + u)}, std::pair{a, Vector3d(a + v)},
                                   std::pair{Vector3d(a + u), Vector3d(a + v)}}) {
      const Vector3d along = to - from;
      const double share =
          std::clamp((p - from).dot(along) / std::max(1e-300, along.squaredNorm()), 0.0, 1.0);
      least = std::min(least, (p - from - share * along).norm());
    }
  }
  return least;
}

TEST(Thin, AFlatSquareBecomesTwoTriangles) {
  Triangles sheet;
  constexpr int kCells = 12;
  for (int y = 0; y <= kCells; ++y)
    for (int x = 0; x <= kCells; ++x)
      sheet.vertices.push_back({{0.1f * float(x), 0.1f * float(y), 0}, {0, 0, 1}, {9, 9, 9, 255}});
  for (std::uint32_t y = 0; y < kCells; ++y)
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t i = y * (kCells + 1) + x, above = i + kCells + 1;
      for (const std::uint32_t index : {i, i + 1, above + 1, i, above + 1, above})
        sheet.indices.push_back(index);
    }
  const Triangles thin = thinned(sheet, 1e-4);
  EXPECT_LE(count(thin), 4u);
  EXPECT_NEAR(area(thin), 1.44, 1e-5) << "the outline stays where it was";
}

TEST(Thin, ABallStaysWithinTheToleranceAndClosed) {
  Triangles ball = tessellate(Shape(Sphere{0.1}), {0.2f, 0.3f, 0.4f, 1});
  ASSERT_EQ(orient(ball), SurfaceKind::closed);
  size_t before = count(ball) + 1;
  for (const double tolerance : {1e-4, 1e-3, 4e-3}) {
    Triangles thin = thinned(ball, tolerance);
    EXPECT_LT(count(thin), before) << tolerance;
    before = count(thin);
    EXPECT_GT(count(thin), 20u);
    double farthest = 0;
    for (const RenderVertex& vertex : ball.vertices)
      farthest = std::max(farthest, distance(vertex.position.cast<double>(), thin));
    EXPECT_LT(farthest, 3 * tolerance) << "the tolerance is that of a mean";
    EXPECT_NEAR(volume(thin) / volume(ball), 1, 60 * tolerance);
    for (const RenderVertex& vertex : thin.vertices)
      EXPECT_GT(vertex.normal.dot(vertex.position.normalized()), 0.8);
    EXPECT_EQ(orient(thin), SurfaceKind::closed);
  }
}

TEST(Thin, EdgesAndCornersStay) {
  const Triangles box = tessellate(Shape(Box{{0.2, 0.1, 0.3}}), {0.2f, 0.3f, 0.4f, 1});
  const Triangles thin = thinned(box, 1e-2);
  EXPECT_EQ(count(thin), 12u);
  EXPECT_NEAR(volume(thin), 0.006, 1e-8);
  // Parts that are smaller than the tolerance vanish, which does no harm.
  EXPECT_LE(count(thinned(box, 10)), 12u);
  EXPECT_EQ(count(thinned({}, 1)), 0u);
}

TEST(Thin, BordersOfColoursStay) {
  // A flat strip whose left half is red: only the border between the colours has to keep its
  // course.
  Triangles strip;
  for (int half = 0; half < 2; ++half)
    for (int y = 0; y < 10; ++y) {
      const auto first = static_cast<std::uint32_t>(strip.vertices.size());
      const std::array<std::uint8_t, 4> color = {static_cast<std::uint8_t>(half ? 0 : 200), 0, 0,
                                                 255};
      for (const auto& [x, up] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        strip.vertices.push_back(
            {{0.1f * float(half + x), 0.1f * float(y + up), 0}, {0, 0, 1}, color});
      for (const std::uint32_t k : {0, 1, 2, 0, 2, 3}) strip.indices.push_back(first + k);
    }
  const Triangles thin = thinned(strip, 1e-3);
  EXPECT_LE(count(thin), 8u);
  double red = 0;
  for (size_t i = 0; i < thin.indices.size(); i += 3) {
    const RenderVertex& vertex = thin.vertices[thin.indices[i]];
    if (vertex.color[0] != 200) continue;
    red +=
        0.5 *
        (corner(thin, i + 1) - corner(thin, i)).cross(corner(thin, i + 2) - corner(thin, i)).norm();
  }
  EXPECT_NEAR(red, 0.1, 1e-6);
}

// The triangles that a clip leaves out cannot be seen: its frames are those of the whole robot.
TEST(Thin, AClipShowsWhatASinglePictureShows) {
  const RobotModel model =
      load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/hoap1", {}, {.meshes = true});
  SimulationLog log;
  log.joints = model.dof_names();
  SimulationSample s;
  s.state = model.rest_state();
  s.state.base.position.z() = 0.28;
  s.cog = s.state.base.position;
  s.command_theta = s.torque = s.state.theta;
  log.samples.assign(2, s);
  ClipOptions options;
  options.overlay = no_marks();
  const auto whole = clip_shape(model, log, options, false);
  const auto thin = clip_shape(model, log, options, true);
  EXPECT_LT(thin->robot->triangles.indices.size(), whole->robot->triangles.indices.size());
  EXPECT_EQ(thin->height, whole->height);
  const Image a = ClipRenderer(model, log, options, whole).frame(0);
  const Image b = ClipRenderer(model, log, options, thin).frame(0);
  ASSERT_EQ(a.rgb.size(), b.rgb.size());
  double sum = 0;
  size_t far = 0;
  for (size_t i = 0; i < a.rgb.size(); ++i) {
    const int difference = std::abs(a.rgb[i] - b.rgb[i]);
    sum += difference;
    far += difference > 24;
  }
  EXPECT_LT(sum / double(a.rgb.size()), 0.1);
  EXPECT_LT(double(far) / double(a.rgb.size()), 5e-4);
}

}  // namespace
}  // namespace ayumi::test
