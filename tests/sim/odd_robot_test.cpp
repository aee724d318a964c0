// Random robots (tests/support/odd_urdf.hpp) in the plant: links without mass, mimic chains,
// slides, meshes.

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "tests/support/block.hpp"
#include "tests/support/mechanical_energy.hpp"
#include "tests/support/odd_urdf.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

class OddFlight : public testing::TestWithParam<unsigned> {
 protected:
  OddFlight() : random(GetParam() + 30) {
    const test::OddRobot robot = test::odd_robot(GetParam(), 8 + static_cast<int>(GetParam() % 10));
    d = parse_urdf(test::urdf_text(robot, GetParam()), "odd.urdf");
  }
  RobotModel with_servos(const ServoDescription& servo) {
    for (const JointDescription& joint : d.joints)
      if (joint.type != JointType::fixed && joint.mimic.empty()) d.servos[joint.name] = servo;
    return RobotModel(d);
  }
  RobotDescription d;
  test::Random random;
};

TEST_P(OddFlight, KeepsMomentumWhileServosSwingTheLimbs) {
  const RobotModel model = with_servos({60.0, 1.0, 0.003, 0.01, 0.02});
  Plant plant(model, model.limits(), World{});
  RobotState s = test::random_state(model, random);
  s.base.position = Vector3d(500, -200, 100);
  plant.set_state(s);
  RobotData data(model);
  update_velocities(model, s, data);
  const Momentum before = centroidal_momentum(model, data);
  const VectorXd phase = random.vector(model.dof_count(), 3.0);
  for (int i = 0; i < 1000; ++i)
    plant.step(s.theta + 0.5 * (phase.array() + 0.02 * i).sin().matrix(), {}, 1e-3);
  ASSERT_LT((plant.state().theta - s.theta).cwiseAbs().maxCoeff(), 100);
  update_velocities(model, plant.state(), data);
  const Momentum after = centroidal_momentum(model, data);
  const Vector3d expected = before.linear - Vector3d(0, 0, model.mass() * kGravity);
  EXPECT_LT((after.linear - expected).norm(), 1e-12 * expected.norm());
  EXPECT_LT((after.angular - before.angular).norm(), 1e-9 * before.angular.norm());
}

TEST_P(OddFlight, LosesEnergyOfTheFirstOrderWithoutMotors) {
  for (JointDescription& joint : d.joints) joint.has_limits = false;
  const RobotModel model = with_servos({});
  RobotState start = test::random_state(model, random);
  start.base.position.z() = 100;
  const double before = test::mechanical_energy(model, start);
  std::vector<double> error;
  for (const double h : {4e-5, 2e-5, 1e-5}) {
    Plant plant(model, model.limits(), World{});
    plant.set_state(start);
    for (int i = 0; i < std::lround(0.04 / h); ++i)
      plant.step(VectorXd::Zero(model.dof_count()), {}, h);
    error.push_back(std::abs(test::mechanical_energy(model, plant.state()) - before));
  }
  for (size_t i = 1; i < error.size(); ++i) {
    EXPECT_LT(error[i], 0.62 * error[i - 1]);
    EXPECT_GT(error[i], 0.38 * error[i - 1]);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, OddFlight, testing::Range(1u, 13u));

/// A box from -size/2 to size/2, as ASCII STL or as OBJ.
std::string box_mesh(const Vector3d& size, bool stl) {
  const auto corner = [&](int k) {
    return Vector3d((k & 1 ? 0.5 : -0.5) * size.x(), (k & 2 ? 0.5 : -0.5) * size.y(),
                    (k & 4 ? 0.5 : -0.5) * size.z());
  };
  const int faces[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                            {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::string text = stl ? "solid box\n" : "";
  for (int k = 0; k < 8 && !stl; ++k) text += "v " + test::numbers(corner(k)) + "\n";
  for (const auto& face : faces) {
    text += stl ? "facet normal 0 0 0\nouter loop\n" : "f";
    for (const int k : face)
      text += stl ? "vertex " + test::numbers(corner(k)) + "\n" : " " + std::to_string(k + 1);
    text += stl ? "endloop\nendfacet\n" : "\n";
  }
  return text + (stl ? "endsolid box\n" : "");
}

// A mesh in millimetres, made smaller by its scale and turned against its link, lands on a slope
// and stays there. Its weight is on the ground, and it lies as the box that it represents.
TEST(MeshOnTheGround, LiesWhereItsShapeIs) {
  for (const std::string name : {"box.stl", "box.obj"}) {
    const test::TemporaryFolder folder;
    folder.write(name, box_mesh({200, 100, 40}, name == "box.stl"));
    const auto urdf = folder.write(
        "robot.urdf",
        "<robot name='meshed'><link name='stone'><inertial><mass value='2'/><origin xyz='0 0 "
        "0.01'/><inertia ixx='0.01' iyy='0.01' izz='0.01' ixy='0' ixz='0' iyz='0'/></inertial>"
        "<collision><origin xyz='0 0 0.01' rpy='1.5707963267948966 0 0'/><geometry><mesh "
        "filename='" +
            name + "' scale='0.001 0.001 0.001'/></geometry></collision></link></robot>");
    const RobotModel model = load_robot(urdf);
    // Turned by a right angle about x, it stands on its long narrow side, 100 mm high.
    Plant plant(model, model.limits(), World{.friction = 0.6, .slope = {0.1, 0}});
    RobotState s = model.rest_state();
    s.base.attitude = exp_rotation({0.1, 0, 0});
    s.base.position = s.base.attitude * Vector3d(0.3, 0, 0.045);
    plant.set_state(s);
    EnergyBalance work;
    for (int i = 0; i < 1000; ++i) work += plant.step(VectorXd(0), {}, 1e-3).work;
    const Vector3d place = s.base.attitude.conjugate() * plant.state().base.position;
    EXPECT_NEAR(place.z(), 0.04, 1e-5) << name;
    EXPECT_LT(place.head<2>().cwiseAbs().maxCoeff(), 0.301) << name;
    EXPECT_LT(plant.state().base_velocity.norm(), 1e-9) << name;
    EXPECT_LT(plant.state().base_angular_velocity.norm(), 1e-9) << name;
  }
}

// A mesh touches the ground with its corners, not with those of a box around it.
TEST(MeshOnTheGround, AnOctahedronLiesOnItsFace) {
  RobotDescription d = test::block_description({0.1, 0.1, 0.1}, 1.0);
  MeshShape octahedron;
  octahedron.mesh.parts.resize(1);
  const float reach = 0.1f;
  for (int k = 0; k < 3; ++k)
    for (const float side : {-reach, reach})
      octahedron.mesh.parts[0].vertices.push_back(side * Eigen::Vector3f::Unit(k));
  d.links[0].collisions[0].shape = octahedron;
  const RobotModel model(d);
  Plant plant(model, model.limits(), World{.friction = 0.5});
  RobotState s = model.rest_state();
  s.base.attitude = rotation_between(Vector3d(1, 1, 1), Vector3d(0, 0, -1));
  s.base.position.z() = 0.06;
  plant.set_state(s);
  for (int i = 0; i < 1000; ++i) plant.step(VectorXd(0), {}, 1e-3);
  EXPECT_NEAR(plant.state().base.position.z(), 0.1 / std::sqrt(3.0), 1e-6);
  EXPECT_LT(plant.state().base.position.head<2>().norm(), 1e-6);
  EXPECT_LT(plant.state().base_angular_velocity.norm(), 1e-9);
}

// Balls, capsules and cylinders roll down with g sin / (1 + k), where k = I / (m r^2), without
// slipping.
TEST(RollingDown, FollowsTheInertia) {
  const double r = 0.05, slope = 0.1, mass = 2;
  const std::pair<Shape, double> cases[] = {
      {Sphere{r}, 0.4}, {Capsule{r, 0.2}, 0.5}, {Cylinder{r, 0.2}, 0.5}, {Cylinder{r, 0.01}, 0.5}};
  for (const auto& [shape, k] : cases) {
    RobotDescription d = test::block_description({r, r, r}, mass);
    d.links[0].inertia.about_com = k * mass * r * r * Eigen::Matrix3d::Identity();
    d.links[0].collisions[0].shape = shape;
    d.links[0].collisions[0].pose.linear() = exp_rotation({M_PI / 2, 0, 0}).toRotationMatrix();
    const RobotModel model(d);
    Plant plant(model, model.limits(), World{.friction = 0.8, .slope = {0, slope}});
    RobotState s = model.rest_state();
    s.base.attitude = exp_rotation({0, slope, 0});
    s.base.position = s.base.attitude * Vector3d(0, 0, r);
    plant.set_state(s);
    for (int i = 0; i < 1000; ++i) plant.step(VectorXd(0), {}, 1e-3);
    const double way = (plant.state().base.position - s.base.position).norm();
    const double expected = 0.5 * kGravity * std::sin(slope) / (1 + k);
    EXPECT_NEAR(way, expected, 0.005 * expected) << shape.index();
    EXPECT_NEAR(plant.state().base_velocity.norm(), r * plant.state().base_angular_velocity.y(),
                1e-6);
  }
}

// The cylinder stands on its end, and tips over a corner of its rim.
TEST(RollingDown, ACylinderStandsOnItsEnd) {
  RobotDescription d = test::block_description({0.1, 0.1, 0.2}, 1.0);
  d.links[0].collisions[0].shape = Cylinder{0.05, 0.2};
  const RobotModel model(d);
  for (const double share : {0.9, 1.1}) {
    const double slope = share * std::atan(0.05 / 0.1);
    Plant plant(model, model.limits(), World{.friction = 5.0, .slope = {0, slope}});
    RobotState s = model.rest_state();
    s.base.attitude = exp_rotation({0, slope, 0});
    s.base.position = s.base.attitude * Vector3d(0, 0, 0.1);
    plant.set_state(s);
    for (int i = 0; i < 1000; ++i) plant.step(VectorXd(0), {}, 1e-3);
    const double turned = plant.state().base.attitude.angularDistance(s.base.attitude);
    if (share < 1)
      EXPECT_LT(turned, 1e-4);  // its corner gives way by a micrometre
    else
      EXPECT_GT(turned, 0.5);
  }
}

}  // namespace
}  // namespace ayumi
