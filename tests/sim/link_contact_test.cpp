// Contact between bodies of one robot, and shapes that lie over the edges of blocks.

#include <gtest/gtest.h>

#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/plant/contact_points.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "tests/support/block.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/urdf_biped.hpp"
#include "tests/support/walk.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::kStep;

/// Adds a box that is free to move anywhere: it has three slides and three turns without motors, on
/// links of almost no weight.
void add_free_box(const std::string& name, const Vector3d& size, double mass, const Vector3d& place,
                  RobotDescription& d) {
  std::string parent = "block";
  for (int k = 0; k < 6; ++k) {
    LinkDescription link;
    link.name = k == 5 ? name : name + std::to_string(k);
    link.has_inertial = true;
    link.inertia.mass = 1e-4;
    link.inertia.about_com = 1e-8 * Eigen::Matrix3d::Identity();
    if (k == 5) link = test::block_description(size, mass).links[0], link.name = name;
    JointDescription joint;
    joint.name = link.name + "_joint";
    joint.type = k < 3 ? JointType::prismatic : JointType::continuous;
    joint.parent = parent;
    joint.child = parent = link.name;
    joint.axis = Vector3d::Unit(k % 3);
    if (k == 0) joint.origin.translation() = place;
    // The servo is stated, but without a gain, so that there is no motor.
    d.servos[joint.name] = ServoDescription{};
    d.links.push_back(link);
    d.joints.push_back(joint);
  }
}

/// Three boxes on top of each other, of which the second and third are turned out of line.
RobotDescription stack_description() {
  RobotDescription d = test::block_description({0.2, 0.16, 0.05}, 3.0);
  add_free_box("middle", {0.12, 0.12, 0.06}, 1.0, {0.01, -0.01, 0.055}, d);
  add_free_box("top", {0.16, 0.06, 0.04}, 2.0, {-0.01, 0.01, 0.105}, d);
  return d;
}

struct Stack {
  explicit Stack(const RobotDescription& description = stack_description())
      : model(description), plant(model, model.limits(), World{.friction = 0.5}) {
    RobotState s = model.rest_state();
    s.base.position.z() = 0.025;
    plant.set_state(s);
  }
  Vector3d place(const std::string& link) const {
    return link_pose(model, plant.data(), model.find_link(link)).translation();
  }
  int body(const std::string& link) const { return model.links()[model.find_link(link)].body; }
  void run(double time, const std::vector<ExternalWrench>& wrenches = {}) {
    for (long i = 0; i < std::lround(time / kStep); ++i) {
      StepInput input(wrenches);
      for (ExternalWrench& w : input.wrenches)
        w.point = link_pose(model, plant.data(), model.find_link("top")).translation();
      plant.step(VectorXd::Zero(model.dof_count()), input, kStep);
    }
  }
  RobotModel model;
  Plant plant;
};

// The ankle of a robot is a cylinder 2 mm above the ground and inside the outline of the foot. When
// the leg leans, the foot is between it and the ground; the shank above is not shielded.
TEST(ContactPoints, TheSoleShieldsTheAnkle) {
  const auto bodies = [](double ankle_shape) {
    const test::TemporaryFolder folder;
    const test::UrdfBiped kind{.ankle_shape = ankle_shape};
    const RobotModel model = load_robot(folder.write("robot.urdf", kind.text()).string());
    std::set<std::string> names;
    for (const ContactPoint& point : contact_points(model))
      if (point.side < 0) names.insert(model.bodies()[static_cast<size_t>(point.body)].name);
    return names;
  };
  const std::set<std::string> plain = bodies(0);
  EXPECT_EQ(plain.count("l_shank"), 1u);
  EXPECT_EQ(bodies(0.002), plain);
}

TEST(Stack, IsAtRestWithoutCreep) {
  Stack stack;
  stack.run(1.0);
  const std::vector<std::string> names = {"block", "middle", "top"};
  const std::vector<double> heights = {0.025, 0.08, 0.13};
  std::vector<Vector3d> before;
  for (size_t i = 0; i < names.size(); ++i) {
    before.push_back(stack.place(names[i]));
    EXPECT_NEAR(before[i].z(), heights[i], 1e-6) << names[i];
  }
  stack.run(1.0);
  for (size_t i = 0; i < names.size(); ++i)
    EXPECT_LT((stack.place(names[i]) - before[i]).norm(), 1e-6) << names[i];
  EXPECT_LT(stack.plant.state().dtheta.cwiseAbs().maxCoeff(), 1e-6);
}

// A pull on the top box: friction holds the box below mu m g, and beyond that the box slides by
// Coulomb's law.
TEST(Stack, TheTopSlidesOnTheMiddleByCoulombsLaw) {
  for (const double share : {0.9, 1.1}) {
    Stack stack;
    stack.run(0.3);
    const double mu = 0.5, mass = 2.0;
    ExternalWrench pull;
    pull.body = stack.body("top");
    pull.force = Vector3d(share * mu * mass * kGravity, 0, 0);
    const Vector3d top = stack.place("top"), middle = stack.place("middle");
    const double time = 0.15;
    stack.run(time, {pull});
    const double a = std::max(0.0, share - 1) * mu * kGravity;
    EXPECT_NEAR((stack.place("top") - top).x(), 0.5 * a * time * time,
                0.01 * a * time * time + 1e-6)
        << share;
    EXPECT_LT((stack.place("middle") - middle).norm(), 1e-6);
  }
}

TEST(Stack, AJointThatStatesNoServoIsRefused) {
  RobotDescription d = stack_description();
  d.servos.erase("top_joint");
  const RobotModel model(d);
  try {
    Plant plant(model, model.limits(), World{});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("joint top_joint has no servo"), std::string::npos);
  }
}

// HOAP-1 in the air presses its upper arms against its trunk, where they stop.
TEST(SelfContact, AnArmStopsAtTheTrunk) {
  // The limits of its own joints would keep the arm away.
  RobotDescription d = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1").description();
  for (JointDescription& joint : d.joints) {
    if (!joint.name.starts_with("l_shoulder") && joint.name != "l_elbow") continue;
    joint.type = JointType::continuous;
    joint.has_limits = false;
  }
  const RobotModel model(d);
  RobotState s = model.rest_state();
  s.base.position.z() = 100;
  const CollisionModel shapes(model);
  const auto nearest = [&](const RobotData& data) {
    double least = 1;
    for (const CollisionModel::Pair& pair : shapes.pairs())
      least = std::min(least, shapes.clearance(pair, data, 1));
    return least;
  };
  // The forearm is bent across the belly.
  VectorXd target = s.theta;
  double overlap = 1;
  for (const double twist : {-1.5, 1.5}) {
    RobotState through = s;
    for (int j = 0; j < model.dof_count(); ++j) {
      if (model.dofs()[j].name == "l_elbow") through.theta[j] = -1.9;
      if (model.dofs()[j].name == "l_shoulder_roll") through.theta[j] = 0;
      if (model.dofs()[j].name == "l_shoulder_twist") through.theta[j] = twist;
    }
    RobotData data(model);
    update_positions(model, through, data);
    if (nearest(data) >= overlap) continue;
    overlap = nearest(data);
    target = through.theta;
  }
  ASSERT_LT(overlap, -0.01) << "the posture asked for is not through the trunk";
  Plant plant(model, model.limits(), World{});
  plant.set_state(s);
  double deepest = 1;
  for (int i = 0; i < 800; ++i) {
    plant.step(s.theta + std::min(1.0, i / 500.0) * (target - s.theta), {}, kStep);
    deepest = std::min(deepest, nearest(plant.data()));
  }
  EXPECT_LT(deepest, 1e-5);
  EXPECT_GT(deepest, -1e-4);
  EXPECT_GE(plant.step(target, {}, kStep).self_contact[0], 0);
  // Forces between links do not change the momentum of the whole robot: it falls freely.
  EXPECT_NEAR(plant.data().dcog.z(), -kGravity * 0.801, 1e-9);
}

GroundBlock rectangle(double x0, double x1, double height) {
  GroundBlock block;
  block.low = {x0, -1};
  block.high = {x1, 1};
  block.height = height;
  return block;
}

/// A plank is let down onto two supports of 0.05 m at x = -0.1 and 0.05, and lies still on them.
struct Plank {
  explicit Plank(const World& world,
                 const RobotDescription& description = test::block_description({0.5, 0.06, 0.02},
                                                                               1.0))
      : model(description), plant(model, model.limits(), world) {
    RobotState s = model.rest_state();
    s.base.position.z() = 0.061;
    plant.set_state(s);
    run();
    const Vector3d before = plant.state().base.position;
    EXPECT_NEAR(before.z(), 0.06, 1e-6);
    run();
    EXPECT_LT((plant.state().base.position - before).norm(), 1e-6);
  }
  void run() {
    for (int i = 0; i < 1000; ++i) plant.step(VectorXd(0), {}, kStep);
  }
  RobotModel model;
  Plant plant;
};

// A plank lies over two rails whose distance is smaller than its length: no corner of it touches
// anything.
TEST(Edges, APlankLiesOnTwoRails) {
  World world{.friction = 0.6};
  world.blocks = {rectangle(-0.12, -0.10, 0.05), rectangle(0.05, 0.07, 0.05)};
  const Plank plank(world);
}

/// A box as a mesh whose own axes are turned by half a right angle about y, so that the bounding
/// box in these axes is many times as high.
PlacedShape askew_mesh(const Vector3d& size) {
  PlacedShape placed;
  MeshShape mesh;
  mesh.mesh.parts.resize(1);
  const Eigen::Quaterniond turn = exp_rotation({0, M_PI / 4, 0});
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    mesh.mesh.parts[0].vertices.push_back((turn * (0.5 * size.cwiseProduct(corner))).cast<float>());
  }
  placed.shape = mesh;
  placed.pose.linear() = turn.conjugate().toRotationMatrix();
  return placed;
}

// A mesh rests on edges with its own faces.
TEST(Edges, AMeshLiesOnTwoRails) {
  World world{.friction = 0.6};
  world.blocks = {rectangle(-0.12, -0.10, 0.05), rectangle(0.05, 0.07, 0.05)};
  RobotDescription d = test::block_description({0.5, 0.06, 0.02}, 1.0);
  d.links[0].collisions[0] = askew_mesh({0.5, 0.06, 0.02});
  const Plank plank(world, d);
}

// Boxes that are given as meshes on top of each other come to rest where boxes do.
TEST(Stack, OfMeshesRestsLikeOneOfBoxes) {
  RobotDescription d = stack_description();
  for (LinkDescription& link : d.links)
    for (PlacedShape& shape : link.collisions) {
      const Vector3d place = shape.pose.translation();
      shape = askew_mesh(std::get<Box>(shape.shape).size);
      shape.pose.translation() = place;
    }
  Stack stack(d);
  stack.run(2);
  const std::pair<const char*, double> heights[] = {
      {"block", 0.025}, {"middle", 0.08}, {"top", 0.13}};
  for (const auto& [name, height] : heights)
    EXPECT_NEAR(stack.place(name).z(), height, 1e-6) << name;
  EXPECT_LT(stack.plant.state().dtheta.cwiseAbs().maxCoeff(), 1e-6);
}

// The same plank lies over two ridges of a height field: no node is at a corner of the plank.
TEST(Edges, APlankLiesOnTwoRidgesOfAField) {
  World world{.friction = 0.6};
  HeightField field;
  field.origin = {-0.3, -0.1};
  field.spacing = 0.01;
  field.heights = Eigen::MatrixXd::Zero(61, 21);
  field.heights.row(20).setConstant(0.05);  // this ridge is at x = -0.1
  field.heights.row(35).setConstant(0.05);  // this ridge is at x = 0.05
  world.fields = {field};
  Plank plank(world);
  Plant& plant = plank.plant;
  // A push down on its end turns the plank about the nearer ridge.
  StepInput input;
  ExternalWrench push;
  push.body = 0;
  push.force = {0, 0, -30};
  for (int i = 0; i < 25; ++i) {
    push.point = plant.state().base.position + Vector3d(0.25, 0, 0);
    input.wrenches = {push};
    plant.step(VectorXd(0), input, kStep);
  }
  const Eigen::Matrix3d R = plant.state().base.attitude.toRotationMatrix();
  EXPECT_LT(R(2, 0), -0.02) << "the end pushed is down";
  const Vector3d on_ridge = R.transpose() * (Vector3d(0.05, 0, 0.05) - plant.state().base.position);
  EXPECT_NEAR(on_ridge.z(), -0.01, 1e-4) << "it turns about the ridge";
}

// One end is on the ground and the middle over an edge: geometry gives the height over the edge.
TEST(Edges, APlankLeansOverAStep) {
  World world{.friction = 0.9};
  world.blocks = {rectangle(0.1, 1, 0.05)};
  const Vector3d size(0.5, 0.06, 0.02);
  const RobotModel model(test::block_description(size, 1.0));
  Plant plant(model, model.limits(), world);
  const double tilt = -0.35;  // about y: the end at +x is up
  RobotState s = model.rest_state();
  s.base.attitude = exp_rotation({0, tilt, 0});
  // The lower end of the plank is on the ground at x = -0.2.
  s.base.position =
      Vector3d(-0.2, 0, 0.0) - s.base.attitude * Vector3d(-0.5 * size.x(), 0, -0.5 * size.z());
  plant.set_state(s);
  for (int i = 0; i < 1500; ++i) plant.step(VectorXd(0), {}, kStep);
  const RobotState rest = plant.state();
  const Eigen::Matrix3d R = rest.base.attitude.toRotationMatrix();
  EXPECT_LT(rest.base_velocity.norm(), 1e-6);
  // The edge lies on the underside.
  const Vector3d on_edge = R.transpose() * (Vector3d(0.1, 0, 0.05) - rest.base.position);
  EXPECT_NEAR(on_edge.z(), -0.5 * size.z(), 1e-6);
  const Vector3d end = rest.base.position + R * Vector3d(-0.5 * size.x(), 0, -0.5 * size.z());
  EXPECT_NEAR(end.z(), 0, 1e-6);
}

}  // namespace
}  // namespace ayumi
