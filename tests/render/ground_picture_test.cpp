#include "ayumi/render/ground_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace ayumi::test {
namespace {

using Eigen::Vector3d;

constexpr int kWide = 160, kTall = 100;

struct View {
  Camera camera;
  GroundRectangle plane;
  Eigen::Matrix4d to_clip;

  View(const Vector3d& eye, double tilt) {
    camera.eye = eye;
    plane.origin = {0.2, -0.3, -0.2};
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(tilt, Vector3d(1, 0.5, 0).normalized()).matrix();
    plane.u = turn.col(0);
    plane.v = turn.col(1);
    plane.normal = turn.col(2);
    plane.center = {0.1, 0.2};
    to_clip = projection_matrix(camera, double(kWide) / kTall) * view_matrix(camera);
  }
  /// The coordinates at which the ray of a pixel meets the plane, and the distance along the view,
  /// which is negative behind the camera.
  Vector3d met(double x, double y) const {
    const Eigen::Matrix4d back = to_clip.inverse();
    const Vector3d p =
        (back * Eigen::Vector4d(2 * x / kWide - 1, 1 - 2 * y / kTall, 0, 1)).hnormalized();
    const Vector3d ray = p - camera.eye;
    const double along = plane.normal.dot(plane.origin - camera.eye) / plane.normal.dot(ray);
    const Vector3d at = camera.eye + along * ray;
    const Vector3d ahead = (camera.target - camera.eye).normalized();
    return {plane.u.dot(at - plane.origin), plane.v.dot(at - plane.origin),
            ahead.dot(at - camera.eye)};
  }
};

// The picture is compared with rays of single pixels.
TEST(GroundPicture, ShowsThePlaneWhereRaysMeetIt) {
  int shown = 0, hidden = 0;
  for (const Vector3d& eye : {Vector3d(2, -2, 1), Vector3d(1.5, 0.2, 0.35), Vector3d(0.1, 0, 3)})
    for (const double tilt : {0.0, 0.2, -0.3})
      for (const bool with_hole : {false, true}) {
        const View view(eye, tilt);
        Eigen::AlignedBox2d hole;
        if (with_hole) hole = {Eigen::Vector2d(-0.4, -0.2), Eigen::Vector2d(0.3, 0.5)};
        const GroundPicture ground(view.camera, view.to_clip, kWide, kTall, view.plane, hole, true);
        const double reach = 30 * (view.camera.eye - view.camera.target).norm();
        const Vector3d target = view.camera.target - view.plane.origin;
        const Eigen::Vector2d middle(view.plane.u.dot(target), view.plane.v.dot(target));
        for (int y = 0; y < kTall; ++y) {
          const auto spans = ground.plane_in_row(y);
          for (int x = 0; x < kWide; ++x) {
            bool is = false;
            for (const PixelSpan& span : spans) is |= x >= span.begin && x < span.end;
            const Vector3d at = view.met(x + 0.5, y + 0.5);
            const Eigen::Vector2d off = at.head<2>() - middle;
            // Pixels whose ray passes within a thousandth of an edge may have either result.
            const double far = std::max(off.cwiseAbs().maxCoeff() / reach, at.z() / 100);
            const double near = 0.05 / at.z();
            if (std::abs(far - 1) < 1e-3 || std::abs(near - 1) < 1e-3) continue;
            bool expected = at.z() > 0 && far < 1 && near < 1;
            if (with_hole && expected) {
              const double outside = hole.exteriorDistance(Eigen::Vector2d(at.head<2>()));
              expected = outside > 0;
            }
            ASSERT_EQ(is, expected) << eye.transpose() << " tilt " << tilt << ": " << x << " " << y;
            (is ? shown : hidden) += 1;
          }
        }
      }
  EXPECT_GT(shown, 50000);
  EXPECT_GT(hidden, 10000);
}

TEST(GroundPicture, HasLinesAtWholeMetresAndTenthsOnly) {
  const View view({0.3, 0.1, 2}, 0);
  const GroundPicture ground(view.camera, view.to_clip, kWide, kTall, view.plane, {}, true);
  Image image;
  ground.draw({}, image);
  int on_line = 0, between = 0;
  for (int y = 0; y < kTall; ++y)
    for (int x = 0; x < kWide; ++x) {
      const Vector3d at = view.met(x + 0.5, y + 0.5);
      const auto off = [](double p, double spacing) {
        return std::abs(p / spacing - std::round(p / spacing)) * spacing;
      };
      const double line = std::min(off(at.x(), 1), off(at.y(), 1));
      const double fine = std::min(off(at.x(), 0.1), off(at.y(), 0.1));
      const int green = image.pixel(x, y)[1];
      if (line < 1e-3) {
        ++on_line;
        EXPECT_LT(green, 185) << x << " " << y;
      } else if (fine > 0.02) {
        ++between;
        EXPECT_NEAR(green, 204, 4) << x << " " << y;
      }
    }
  EXPECT_GT(on_line, 20);
  EXPECT_GT(between, 2000);
}

TEST(GroundPicture, IsAllSkySeenFromBelowOnEdgeOrWithoutGround) {
  for (const Vector3d& eye : {Vector3d(2, 0, -1), Vector3d(2, 1, 0.8)}) {
    const View view(eye, 0);
    const GroundPicture ground(view.camera, view.to_clip, kWide, kTall, view.plane, {},
                               eye.z() < 0);
    for (int y = 0; y < kTall; ++y)
      for (const PixelSpan& span : ground.plane_in_row(y)) EXPECT_GE(span.begin, span.end);
    Image image;
    ground.draw({}, image);
    for (int y = 0; y < kTall; ++y)
      for (int x = 0; x < kWide; ++x) EXPECT_GE(image.pixel(x, y)[2], image.pixel(x, y)[0]);
  }
}

// Every pixel is computed again separately, with the formulas written once more.
TEST(GroundPicture, IsWhatEachPixelShows) {
  const auto lines = [](double p, double footprint, double spacing, double width) {
    const double away = std::abs(p / spacing - std::round(p / spacing)) * spacing;
    const double most = std::max(width, footprint);
    double cover = std::clamp(0.5 + (0.5 * most - away) / footprint, 0.0, 1.0);
    cover *= std::min(width / footprint, 1.0);
    const double far = std::clamp(2 * footprint / spacing - 0.6, 0.0, 1.0);
    return cover + (width / spacing - cover) * far;
  };
  for (const auto& [eye, tilt] : {std::pair{Vector3d(2, -2, 1), 0.05},
                                  {Vector3d(0.6, 0.2, 0.35), 0.05},
                                  {Vector3d(9, 3, 4), 0.05},
                                  {Vector3d(2, -2, 0.3), 0.5},
                                  {Vector3d(-2, 1, 0.4), 0.4}}) {
    const View view(eye, tilt);
    const GroundPicture ground(view.camera, view.to_clip, kWide, kTall, view.plane, {}, true);
    Image image;
    ground.draw({}, image);
    const Eigen::Vector2d middle = middle_of_plane(view.camera, view.plane);
    const double fade = 4.5 * (view.camera.eye - view.camera.target).norm();
    for (int y = 0; y < kTall; ++y) {
      const auto spans = ground.plane_in_row(y);
      for (int x = spans[0].begin; x < spans[0].end; ++x) {
        const double h = 1e-4;
        const Vector3d at = view.met(x + 0.5, y + 0.5);
        const Vector3d right = (view.met(x + 0.5 + h, y + 0.5) - at) / h;
        const Vector3d down = (view.met(x + 0.5, y + 0.5 + h) - at) / h;
        const double wide_u = std::abs(right.x()) + std::abs(down.x());
        const double wide_v = std::abs(right.y()) + std::abs(down.y());
        const double fine =
            0.55 * std::max(lines(at.x(), wide_u, 0.1, 0.0022), lines(at.y(), wide_v, 0.1, 0.0022));
        const double bold =
            0.80 * std::max(lines(at.x(), wide_u, 1, 0.006), lines(at.y(), wide_v, 1, 0.006));
        const double d = (at.head<2>() - middle).squaredNorm() / (fade * fade);
        double green = 0.801 + (0.653 - 0.801) * fine;
        green += (0.518 - green) * bold;
        green = 0.893 + (green - 0.893) / (1 + d * d);
        ASSERT_NEAR(image.pixel(x, y)[1], 255 * green, 1.1) << x << " " << y;
      }
    }
  }
}

TEST(Blur, IsTwiceTheMeanOverASquare) {
  constexpr int kSize = 40;
  for (const int radius : {1, 2, 5}) {
    std::vector<std::uint8_t> image(size_t(kSize) * kSize);
    for (size_t i = 0; i < image.size(); ++i)
      image[i] = static_cast<std::uint8_t>((i * 7919) % 256 * (i % 3 != 0));
    image[0] = image[17] = 255;
    std::vector<int> expected(image.begin(), image.end());
    const auto along = [&](int step, int across) {
      const std::vector<int> from = expected;
      for (int a = 0; a < kSize; ++a)
        for (int b = 0; b < kSize; ++b) {
          int sum = 0;
          for (int c = b - radius; c <= b + radius; ++c)
            if (c >= 0 && c < kSize) sum += from[size_t(a * across + c * step)];
          expected[size_t(a * across + b * step)] = sum / (2 * radius + 1);
        }
    };
    for (int pass = 0; pass < 2; ++pass) {
      along(1, kSize);
      along(kSize, 1);
    }
    blur(image, kSize, radius);
    EXPECT_EQ(std::vector<int>(image.begin(), image.end()), expected) << radius;
  }
}

TEST(LayPixelsOver, MixesByCoverFromTheBottomUpwards) {
  Image image{4, 3, std::vector<std::uint8_t>(36, 100)};
  const std::vector<std::uint8_t> part = {10, 20, 30, 255, 0, 0, 0, 0,  //
                                          50, 60, 70, 127, 1, 2, 3, 1};
  lay_pixels_over(part.data(), 2, {1, 0, 2, 2}, image);
  const auto is = [&](int x, int y, int r, int g, int b) {
    const std::uint8_t* p = image.pixel(x, y);
    EXPECT_EQ((std::array<int, 3>{p[0], p[1], p[2]}), (std::array<int, 3>{r, g, b})) << x << y;
  };
  is(1, 2, 10, 20, 30);     // the pixel is covered
  is(2, 2, 100, 100, 100);  // the pixel is not covered
  is(1, 1, 100, 110, 120);  // the pixel is half covered
  is(2, 1, 101, 102, 103);
  is(0, 2, 100, 100, 100);  // the pixel is beside the part
  is(3, 1, 100, 100, 100);
  is(1, 0, 100, 100, 100);
}

}  // namespace
}  // namespace ayumi::test
