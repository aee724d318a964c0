// The clearance of the check is computed again by other means: points all over the bodies of one
// robot part, and the distance of each from the shapes of the other part in closed form, all placed
// by homogeneous matrices.

#include <gtest/gtest.h>

#include <algorithm>

#include "ayumi/check/consistency.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "tests/support/plain_motion.hpp"
#include "tests/support/random_robot.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kGrid = 0.003;  // distance of points on a shape [m]
constexpr double kNear = 0.012;  // larger distances are only bounded by the check [m]

// Points on the surface of a shape, in its own frame.
std::vector<Vector3d> surface(const Shape& shape) {
  std::vector<Vector3d> points;
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vector3d half = box->size / 2;
    Eigen::Vector3i n = (box->size / kGrid).array().ceil().cast<int>().matrix();
    for (int x = 0; x <= n.x(); ++x)
      for (int y = 0; y <= n.y(); ++y)
        for (int z = 0; z <= n.z(); ++z) {
          if (x % n.x() != 0 && y % n.y() != 0 && z % n.z() != 0) continue;
          const Vector3d share(double(x) / n.x(), double(y) / n.y(), double(z) / n.z());
          points.push_back((2 * share - Vector3d::Ones()).cwiseProduct(half));
        }
    return points;
  }
  const auto* cylinder = std::get_if<Cylinder>(&shape);
  const auto* sphere = std::get_if<Sphere>(&shape);
  const double radius = cylinder ? cylinder->radius : sphere->radius;
  const int around = static_cast<int>(std::ceil(2 * M_PI * radius / kGrid));
  for (int i = 0; i < around; ++i) {
    const Vector3d side(std::cos(2 * M_PI * i / around), std::sin(2 * M_PI * i / around), 0);
    if (!cylinder) {
      for (int j = 0; j <= around; ++j)
        points.push_back(radius * (std::sin(M_PI * j / around) * side +
                                   std::cos(M_PI * j / around) * Vector3d::UnitZ()));
      continue;
    }
    const int up = static_cast<int>(std::ceil(cylinder->length / kGrid));
    for (int j = 0; j <= up; ++j)
      points.push_back(radius * side +
                       cylinder->length * (double(j) / up - 0.5) * Vector3d::UnitZ());
    const int in = static_cast<int>(std::ceil(radius / kGrid));
    for (int j = 0; j < in; ++j)
      for (const double end : {-0.5, 0.5})
        points.push_back(radius * j / in * side + end * cylinder->length * Vector3d::UnitZ());
  }
  return points;
}

// The distance of a point from a shape; negative inside.
double distance(const Vector3d& p, const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) {
    const Vector3d beyond = p.cwiseAbs() - box->size / 2;
    return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
  }
  if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
    const Vector2d beyond(p.head<2>().norm() - cylinder->radius,
                          std::abs(p.z()) - cylinder->length / 2);
    return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
  }
  return p.norm() - std::get<Sphere>(shape).radius;
}

struct PlacedForTest {
  int body;
  const Shape* shape;
  Eigen::Matrix4d pose;
  std::vector<Vector3d> points;  // points in the world
};

std::vector<PlacedForTest> placed_shapes(const RobotModel& model, const RobotState& state) {
  const auto poses = plain_poses(model, state);
  std::vector<PlacedForTest> shapes;
  for (const Link& link : model.links())
    for (const PlacedShape& s : link.collisions) {
      const Eigen::Matrix4d pose =
          poses[static_cast<size_t>(link.body)] * link.pose.matrix() * s.pose.matrix();
      std::vector<Vector3d> points = surface(s.shape);
      for (Vector3d& p : points) p = at_pose(pose, p);
      shapes.push_back({link.body, &s.shape, pose, std::move(points)});
    }
  return shapes;
}

double by_points(const PlacedForTest& a, const PlacedForTest& b) {
  double least = 1e9;
  for (const auto& [from, to] : {std::pair{&a, &b}, std::pair{&b, &a}}) {
    const Eigen::Matrix4d inverse = to->pose.inverse();
    for (const Vector3d& p : from->points)
      least = std::min(least, distance(at_pose(inverse, p), *to->shape));
  }
  return least;
}

}  // namespace

// The clearance that the check reports for a posture agrees with that of points all over the
// bodies.
TEST(SecondRouteOfClearance, ByPointsOnTheBodies) {
  int apart = 0, meet = 0;
  for (const char* name : {"hoap1", "humanoid30"}) {
    const RobotModel model = load_robot(std::string(AYUMI_SOURCE_DIR "/robots/") + name);
    const CollisionModel collisions(model);
    Random random(5);
    for (int trial = 0; trial < 25; ++trial) {
      CommandSeries series;
      series.samples.resize(1);
      CommandSample& s = series.samples[0];
      s.state = model.rest_state();
      for (int i = 0; i < model.dof_count(); ++i) s.state.theta[i] += random.uniform(-0.3, 0.3);
      s.acceleration.setZero(model.velocity_count());
      const double told = check_consistency(model, series).summary[FindingKind::self_collision];
      const auto shapes = placed_shapes(model, s.state);
      double least = 1e9;
      for (const CollisionModel::Pair& pair : collisions.pairs())
        for (const PlacedForTest& a : shapes)
          for (const PlacedForTest& b : shapes)
            if (a.body == pair.a && b.body == pair.b) least = std::min(least, by_points(a, b));
      if (told > 0) {
        if (told > kNear) continue;
        ++apart;
        EXPECT_GE(least, told - 1e-7) << name << " " << trial;
        EXPECT_LE(least, told + 0.5 * kGrid) << name << " " << trial;
      } else {
        ++meet;
        EXPECT_LT(least, 0.5 * kGrid) << name << " " << trial;
      }
    }
  }
  EXPECT_GT(apart, 4);
  EXPECT_GT(meet, 2);
}
