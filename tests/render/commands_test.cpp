// `ayumi preview` and `ayumi plot` on a run in which HOAP-1 stands.

#include "ayumi/render/clip.hpp"
#include "tests/render/standing_run.hpp"
#include "tests/support/json.hpp"

namespace ayumi::test {
namespace {

using Commands = OnARun;

TEST_F(Commands, PreviewWritesAClipAndSaysSo) {
  const Output made = ayumi({"preview", "run", "-o", "a.mp4", "--size", "160x90", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = json_of(made.out);
  EXPECT_EQ(json.at("frames"), 7);
  EXPECT_EQ(json.at("fps"), 30);
  EXPECT_EQ(json.at("size"), nlohmann::json({160, 90}));
  EXPECT_TRUE(json.at("wall_s").is_number());
  const std::string first = contents(folder / "a.mp4");
  EXPECT_EQ(ayumi({"preview", "run", "-o", "a.mp4", "--size", "160x90"}).exit_code, 3);
  EXPECT_EQ(
      ayumi({"preview", "run", "-o", "a.mp4", "--size", "160x90", "--force", "--threads", "1"})
          .exit_code,
      0);
  EXPECT_EQ(contents(folder / "a.mp4"), first) << "same bytes for any number of threads";
}

TEST_F(Commands, PreviewTakesOnePicture) {
  const Output made = ayumi({"preview", "run", "-o", "a.png", "--size", "64x48", "--at", "0.1",
                             "--view", "side", "--hide", "trails,cog"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(contents(folder / "a.png").substr(1, 3), "PNG");
}

TEST_F(Commands, PlotDrawsAllLogsOfARun) {
  const Output made = ayumi({"plot", "run", "-o", "a.svg", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = json_of(made.out);
  EXPECT_EQ(json.at("series").size(), 8u);
  EXPECT_EQ(json.at("series").at(6), "margin [mm]");
  EXPECT_EQ(json.at("runs"), nlohmann::json({"open loop", "closed loop, dtad"}));
  EXPECT_NE(contents(folder / "a.svg").find("closed loop, dtad (stands)"), std::string::npos);
  EXPECT_EQ(ayumi({"plot", "run", "-o", "b.png", "--top"}).exit_code, 0);
  EXPECT_EQ(ayumi({"plot", "run", "--log", "closed_loop", "-o", "c.svg"}).exit_code, 0);
  EXPECT_EQ(contents(folder / "c.svg").find("open loop"), std::string::npos);
}

TEST_F(Commands, ExportWritesTheReferenceAsGltf) {
  const Output made = ayumi({"export", "run", "--format", "gltf", "-o", "a.glb", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto json = json_of(made.out);
  EXPECT_EQ(json.at("rows"), 13);
  const std::string bytes = contents(folder / "a.glb");
  EXPECT_EQ(json.at("bytes"), bytes.size());
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_NE(bytes.find("\"name\":\"reference\""), std::string::npos);
  EXPECT_GT(bytes.size(), 100'000u) << "with its meshes";
}

TEST_F(Commands, MistakesAreNamed) {
  const struct {
    std::vector<std::string> arguments;
    int exit_code;
    std::string message;
  } cases[] = {{{"preview", "run", "-o", "a.mp4", "--size", "0x0"}, 2, "0x0"},
               {{"preview", "run", "-o", "a.mp4", "--size", "big"}, 2, "WIDTHxHEIGHT"},
               {{"preview", "run", "-o", "a.mp4", "--size", "101x50"}, 2, "even width"},
               {{"preview", "run", "-o", "a.avi"}, 2, "'.avi' is not possible"},
               {{"preview", "run", "-o", "a.png", "--view", "font"}, 2, "did you mean 'front'?"},
               {{"preview", "run", "-o", "a.png", "--hide", "zpm"}, 2, "did you mean 'zmp'?"},
               {{"preview", "run", "-o", "a.png", "--at", "9"}, 2, "outside the run (0 to 0.2 s)"},
               {{"preview", "run", "-o", "no/where/a.png"}, 3, "does not exist"},
               {{"preview", "nothing", "-o", "a.png"}, 3, "nothing"},
               {{"preview", "run", "--log", "third", "-o", "a.png"}, 3, "third"},
               {{"export", "run", "--format", "gltf", "-o", "a.gltf"},
                2,
                "needs a file name that ends in .glb"},
               {{"plot", "run", "-o", "a.pdf"}, 2, "'.pdf' is not one of"},
               {{"plot", "nothing", "-o", "a.svg"}, 3, "nothing"},
               {{"plot", "run", "-o", "a.svg", "--from", "5"}, 2, "the times from 5 s"}};
  const std::vector<std::string> before = folder.files();
  for (const auto& c : cases) {
    const Output output = ayumi(c.arguments);
    EXPECT_EQ(output.exit_code, c.exit_code) << output.err;
    EXPECT_NE(output.err.find(c.message), std::string::npos) << output.err;
    EXPECT_EQ(folder.files(), before) << c.message;
  }
}

TEST_F(Commands, Hoap1StandsOnTheGroundWithNothingInsideOut) {
  const RobotModel model = hoap1(true);
  size_t triangles = 0;
  for (const BodySurface& body : robot_surface(model)) {
    EXPECT_TRUE(body.open.indices.empty()) << "its meshes are closed";
    triangles += body.closed.indices.size() / 3;
  }
  EXPECT_GT(triangles, 2000u);
  const Eigen::AlignedBox3d box =
      robot_bounds(robot_surface(model), body_poses(model, log.samples[0].state));
  EXPECT_NEAR(box.min().z(), 0, 1e-3);
  EXPECT_NEAR(box.max().z(), 0.48, 0.03);
  ClipOptions options;
  options.picture = {.width = 160, .height = 120};
  options.overlay.caption = options.overlay.cog = options.overlay.forces = false;
  ClipRenderer renderer(model, log, options);
  const Image image = renderer.frame(0);
  int light = 0, blue = 0;
  for (int y = 20; y < 100; ++y)
    for (int x = 50; x < 110; ++x) {
      const std::uint8_t* p = image.pixel(x, y);
      light += p[0] > 140 && std::abs(p[0] - p[2]) < 40;
      blue += p[2] > p[0] + 30;
    }
  EXPECT_GT(light, 500) << "white shells";
  EXPECT_GT(blue, 40) << "blue trim";
}

}  // namespace
}  // namespace ayumi::test
