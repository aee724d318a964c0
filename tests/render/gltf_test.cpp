#include "ayumi/render/gltf.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/render/simplify.hpp"
#include "tests/cli/program.hpp"
#include "tests/render/box_robot.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Json = nlohmann::json;

struct Glb {
  Json json;
  std::string binary;

  explicit Glb(const std::string& bytes) {
    const auto word = [&](size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, 4);
      return value;
    };
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(8), bytes.size());
    json = json_of(bytes.substr(20, word(12)));
    binary = bytes.substr(28 + word(12));
  }

  std::vector<float> floats(const Json& accessor) const {
    const Json& view = json.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    std::vector<float> values(view.at("byteLength").get<size_t>() / 4);
    std::memcpy(values.data(), binary.data() + view.at("byteOffset").get<size_t>(),
                4 * values.size());
    return values;
  }

  /// Value k of an animated property of a node, or the node's own value.
  std::vector<float> value(const Json& animation, int node, const std::string& path,
                           size_t k) const {
    for (const Json& channel : animation.at("channels")) {
      if (channel.at("target").at("node") != node || channel.at("target").at("path") != path)
        continue;
      const Json& sampler = animation.at("samplers").at(channel.at("sampler").get<size_t>());
      const std::vector<float> all =
          floats(json.at("accessors").at(sampler.at("output").get<size_t>()));
      const size_t width = path == "rotation" ? 4 : 3;
      return {all.begin() + long(width * k), all.begin() + long(width * (k + 1))};
    }
    return json.at("nodes").at(size_t(node)).at(path).get<std::vector<float>>();
  }

  /// The pose of a node in the scene at key k, by multiplication down from the scene's root.
  Eigen::Isometry3d pose(const Json& animation, int node, size_t k) const {
    Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
    if (node > 0) {
      const std::vector<float> shift = value(animation, node, "translation", k);
      local.translation() = Eigen::Vector3d(shift[0], shift[1], shift[2]);
    }
    const std::vector<float> q = value(animation, node, "rotation", k);
    local.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().matrix();
    for (size_t parent = 0; parent < json.at("nodes").size(); ++parent)
      for (const Json& child : json.at("nodes").at(parent).value("children", Json::array()))
        if (child == node) return pose(animation, static_cast<int>(parent), k) * local;
    return local;
  }
};

TEST(Gltf, NodesFollowTheRun) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  const Motion motion = motion_of(log, MotionSource::run, 25);
  ASSERT_EQ(motion.times.size(), 26u);
  const Glb glb(glb_bytes(model, {motion}));
  const Json& animation = glb.json.at("animations").at(0);
  EXPECT_EQ(animation.at("name"), "run");
  Eigen::Matrix3d up;  // z of the world is y of the scene
  up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  for (const size_t k : {size_t{0}, size_t{7}, size_t{25}}) {
    const auto index = static_cast<size_t>(std::llround(motion.times[k] / log.dt));
    const auto poses = body_poses(model, log.samples[index].state);
    for (size_t body = 0; body < poses.size(); ++body) {
      const Eigen::Isometry3d seen = glb.pose(animation, static_cast<int>(1 + body), k);
      EXPECT_LT((seen.translation() - up * poses[body].translation()).norm(), 1e-6);
      EXPECT_LT((seen.linear() - up * poses[body].linear()).norm(), 1e-6);
    }
  }
}

TEST(Gltf, CommandAndRunAreTwoAnimations) {
  const RobotModel model = box_robot();
  const SimulationLog log = box_run(model);
  const std::string bytes = glb_bytes(
      model, {motion_of(log, MotionSource::run, 10), motion_of(log, MotionSource::command, 10)});
  EXPECT_EQ(bytes, glb_bytes(model, {motion_of(log, MotionSource::run, 10),
                                     motion_of(log, MotionSource::command, 10)}));
  const Glb glb(bytes);
  ASSERT_EQ(glb.json.at("animations").size(), 2u);
  const Eigen::Isometry3d command = glb.pose(glb.json.at("animations").at(1), 1, 5);
  EXPECT_NEAR(command.translation().x(), 0.05, 1e-6);
  EXPECT_NEAR(command.translation().z(), 0, 1e-6) << "the command does not sway";
}

TEST(Gltf, AMotionOfAnotherRobotIsRefused) {
  const RobotModel model = box_robot();
  Motion motion = motion_of(box_run(model), MotionSource::run, 10);
  motion.theta.conservativeResize(3, Eigen::NoChange);
  try {
    glb_bytes(model, {motion});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("has 3 joints, but the robot box_robot has 5"),
              std::string::npos)
        << error.what();
  }
}

TEST(Gltf, ATableBecomesAMotionWithItsFirstAndLastRow) {
  ReferenceTrajectory table;
  table.dt = 0.002;
  for (int k = 0; k <= 107; ++k) {
    ReferenceRow row;
    row.theta = Eigen::VectorXd::Constant(2, k);
    row.base.position.x() = k;
    table.rows.push_back(row);
  }
  const Motion motion = motion_of(table, 50);
  ASSERT_EQ(motion.times.size(), 12u) << "every tenth row, and the last";
  EXPECT_EQ(motion.name, "reference");
  EXPECT_DOUBLE_EQ(motion.times[3], 0.06);
  EXPECT_EQ(motion.theta(1, 3), 30);
  EXPECT_DOUBLE_EQ(motion.times.back(), 0.214);
  EXPECT_EQ(motion.base.back().position.x(), 107);
  EXPECT_EQ(motion_of(table, 1e6).times.size(), 108u) << "no row twice";
  EXPECT_THROW(motion_of(table, 0), Error);
  EXPECT_THROW(motion_of(ReferenceTrajectory{}, 50), Error);
}

TEST(Gltf, TheKhronosValidatorHasNoComplaint) {
  if (std::string(AYUMI_NODE).empty())
    GTEST_SKIP() << "built without npm: the Khronos glTF validator is not there";
  const Folder folder;
  const RobotModel boxes = box_robot();
  const RobotModel hoap =
      load_robot(std::string(AYUMI_SOURCE_DIR) + "/robots/hoap1", {}, {.meshes = true});
  SimulationLog standing;
  standing.samples.resize(2);
  for (SimulationSample& sample : standing.samples) sample.state = hoap.rest_state();
  const SimulationLog run = box_run(boxes);
  write(folder / "boxes.glb", glb_bytes(boxes, {motion_of(run, MotionSource::run, 30),
                                                motion_of(run, MotionSource::command, 30)}));
  write(folder / "hoap.glb", glb_bytes(hoap, {motion_of(standing, MotionSource::run, 30)}));
  write(folder / "coarse.glb", glb_bytes(hoap, {}, {.max_triangles = 3000}));
  for (const char* name : {"boxes.glb", "hoap.glb", "coarse.glb"}) {
    const Output said =
        run_program({"NODE_PATH=" AYUMI_NODE_MODULES, AYUMI_NODE,
                     AYUMI_SOURCE_DIR "/tests/render/validate_gltf.cjs", folder / name},
                    folder.path(), "/usr/bin/env");
    EXPECT_EQ(said.exit_code, 0) << name << "\n" << said.out << said.err;
    EXPECT_NE(said.out.find("triangles"), std::string::npos) << said.out;
  }
}

TEST(Simplify, KeepsTheShapeWithinACell) {
  BodySurface body;
  body.closed = tessellate(Sphere{0.1}, Eigen::Vector4f(1, 0, 0, 1));
  std::vector<BodySurface> surface = {body};
  const size_t before = triangle_count(surface);
  EXPECT_EQ(simplify(surface, before), 0) << "nothing to do";
  const double cell = simplify(surface, before / 4);
  EXPECT_GT(cell, 0);
  EXPECT_LE(triangle_count(surface), before / 4);
  EXPECT_GT(triangle_count(surface), before / 20);
  double area = 0;
  for (size_t i = 0; i < surface[0].closed.indices.size(); i += 3) {
    std::array<Eigen::Vector3f, 3> corner;
    for (size_t k = 0; k < 3; ++k) {
      const RenderVertex& vertex = surface[0].closed.vertices[surface[0].closed.indices[i + k]];
      corner[k] = vertex.position;
      EXPECT_NEAR(vertex.position.norm(), 0.1, cell);
      EXPECT_GT(vertex.normal.dot(vertex.position.normalized()), 0.7f) << "normals look outwards";
    }
    const Eigen::Vector3f face = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    EXPECT_GT(face.dot(corner[0] + corner[1] + corner[2]), 0) << "faces look outwards";
    area += 0.5 * face.norm();
  }
  // In an earlier version, the surface was drawn from both sides, which takes twice as long.
  EXPECT_TRUE(surface[0].open.indices.empty()) << "still closed";
  EXPECT_NEAR(area, 4 * M_PI * 0.01, 0.12 * 4 * M_PI * 0.01) << "no holes";
}

}  // namespace
}  // namespace ayumi::test
