#include "ayumi/render/texture.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/render/ghost_color.hpp"
#include "ayumi/render/gltf.hpp"
#include "ayumi/render/image.hpp"
#include "ayumi/render/renderer.hpp"
#include "ayumi/render/simplify.hpp"
#include "tests/cli/program.hpp"
#include "tests/render/box_robot.hpp"

namespace ayumi::test {
namespace {

/// A picture that is red at the top, green at the bottom left and blue at the bottom right.
Image flag() {
  Image image{8, 8, std::vector<std::uint8_t>(3 * 64, 0)};
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) image.pixel(x, y)[y < 4 ? 0 : x < 4 ? 1 : 2] = 255;
  return image;
}

/// A square of one metre that faces +x; its left edge is at y = 0.5 as seen from there.
constexpr const char* kSquare =
    "mtllib square.mtl\nv 0 -0.5 -0.5\nv 0 0.5 -0.5\nv 0 0.5 0.5\nv 0 -0.5 0.5\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl flag\nf 1/1 2/2 3/3 4/4\n";

class Textured : public testing::Test {
 protected:
  std::vector<BodySurface> surface(const std::string& map, std::string square = kSquare) {
    write(folder / "square.mtl", "newmtl flag\nKd 0.2 0.2 0.2\nmap_Kd " + map + "\n");
    write(folder / "square.obj", square);
    RobotDescription d;
    d.name = "sign";
    MeshShape shape;
    shape.mesh = load_mesh(folder / "square.obj");
    PlacedShape visual;
    visual.shape = shape;
    d.links.push_back(box_link("sign", 1, visual));
    model.emplace(d);
    return robot_surface(*model);
  }
  /// The colour at a share of the picture's width and height, seen from +x.
  Eigen::Vector3i seen(const std::vector<BodySurface>& surface, double right, double down) {
    Renderer renderer(surface, {.width = 90, .height = 90, .shadow = false, .ground = false});
    Scene scene;
    scene.poses = {Eigen::Isometry3d::Identity()};
    scene.camera.eye = {4, 0, 0};
    scene.camera.field_of_view = 0.3;
    const Image image = renderer.render(scene);
    notes = renderer.notes();
    const std::uint8_t* p = image.pixel(int(90 * right), int(90 * down));
    return {p[0], p[1], p[2]};
  }
  Folder folder;
  std::optional<RobotModel> model;
  std::vector<std::string> notes;
};

TEST_F(Textured, ThePictureLiesTheRightWayRound) {
  write_png(folder / "flag.png", flag());
  const auto sign = surface("flag.png");
  const Eigen::Vector3i above = seen(sign, 0.5, 0.25);
  EXPECT_GT(above[0], 150);
  EXPECT_LT(above[1], 60);
  const Eigen::Vector3i left = seen(sign, 0.3, 0.7), right = seen(sign, 0.7, 0.7);
  EXPECT_GT(left[1], 150) << left.transpose();
  EXPECT_GT(right[2], 150) << right.transpose();
  EXPECT_TRUE(notes.empty());
}

TEST_F(Textured, AGhostTurnsFromTheColoursOfThePicture) {
  Image image{8, 8, std::vector<std::uint8_t>(3 * 64, 0)};
  for (size_t pixel = 0; pixel < 64; ++pixel) image.rgb[3 * pixel] = 220;
  write_png(folder / "flag.png", image);
  EXPECT_EQ(hex_text(ghost_colors(surface("flag.png")).beside_robot), "#0d9e9e");
}

TEST_F(Textured, AJpegIsRead) {
  write_png(folder / "flag.png", flag());
  const Output made = run_program(
      {"-loglevel", "error", "-i", "flag.png", "-vf", "scale=64:64:flags=neighbor", "flag.jpg"},
      folder.path(), "/usr/bin/ffmpeg");
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const Eigen::Vector3i above = seen(surface("flag.jpg"), 0.5, 0.25);
  EXPECT_GT(above[0], 150);
  EXPECT_LT(above[1], 70);
  EXPECT_TRUE(notes.empty());
}

TEST_F(Textured, AMissingPictureIsWhiteAndSaidSo) {
  const Eigen::Vector3i white = seen(surface("nowhere.png"), 0.5, 0.5);
  EXPECT_GT(white.minCoeff(), 150);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("nowhere.png: there is no such file; the surface is drawn white"),
            std::string::npos);
}

TEST_F(Textured, AnotherCaseIsFoundAndSaidSo) {
  write_png(folder / "Flag.PNG", flag());
  EXPECT_GT(seen(surface("flag.png"), 0.5, 0.25)[0], 150);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("uses Flag.PNG, whose name differs only in upper and lower case"),
            std::string::npos);
}

TEST_F(Textured, ABrokenPictureIsWhiteAndSaidSo) {
  write(folder / "flag.png", "\x89PNG\r\n\x1a\nbroken");
  seen(surface("flag.png"), 0.5, 0.5);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("cannot be read as PNG or JPEG; the surface is drawn white"),
            std::string::npos);
  write(folder / "flag.jpg", "\xff\xd8\xff broken");
  seen(surface("flag.jpg"), 0.5, 0.5);
  ASSERT_EQ(notes.size(), 1u);
}

TEST_F(Textured, GltfKeepsThePictureAndReadsBack) {
  write_png(folder / "flag.png", flag());
  const auto sign = surface("flag.png");
  write(folder / "sign.glb", glb_bytes(*model, {}));
  if (std::string(AYUMI_NODE).size()) {
    const Output said =
        run_program({"NODE_PATH=" AYUMI_NODE_MODULES, AYUMI_NODE,
                     AYUMI_SOURCE_DIR "/tests/render/validate_gltf.cjs", folder / "sign.glb"},
                    folder.path(), "/usr/bin/env");
    EXPECT_EQ(said.exit_code, 0) << said.out;
  }
  const TriangleMesh back = load_mesh(folder / "sign.glb");
  ASSERT_EQ(back.parts.size(), 1u);
  ASSERT_EQ(back.parts[0].uvs.size(), back.parts[0].vertices.size());
  for (size_t i = 0; i < back.parts[0].vertices.size(); ++i) {
    // In glTF's axes, the former y is -z and the former z is y; u grows with y, and v with z.
    EXPECT_NEAR(back.parts[0].uvs[i].x(), 0.5f - back.parts[0].vertices[i].z(), 1e-5);
    EXPECT_NEAR(back.parts[0].uvs[i].y(), 0.5f + back.parts[0].vertices[i].y(), 1e-5);
  }
  const Texture picture = read_texture(back.parts[0].texture_file, notes);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(picture.width, 8);
}

TEST_F(Textured, SimplifyingKeepsThePicture) {
  write_png(folder / "flag.png", flag());
  std::string fine = "mtllib square.mtl\nusemtl flag\n";
  const int n = 40;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double y = double(i) / n, z = double(j) / n;
      fine += "v 0 " + std::to_string(y - 0.5) + " " + std::to_string(z - 0.5) + "\nvt " +
              std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  const auto corner = [&](int i, int j) {
    const std::string k = std::to_string(i * (n + 1) + j + 1);
    return " " + k + "/" + k;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      fine +=
          "f" + corner(i, j) + corner(i + 1, j) + corner(i + 1, j + 1) + corner(i, j + 1) + "\n";
  auto sign = surface("flag.png", fine);
  ASSERT_EQ(triangle_count(sign), size_t(2 * n * n));
  EXPECT_GT(simplify(sign, 400), 0);
  EXPECT_LE(triangle_count(sign), 400u);
  EXPECT_GT(seen(sign, 0.5, 0.25)[0], 150);
  EXPECT_GT(seen(sign, 0.35, 0.65)[1], 120);
}

}  // namespace
}  // namespace ayumi::test
