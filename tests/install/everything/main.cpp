// A separate program that is built with the installed libraries, with one call to each of them.

#include <cstdio>
#include <filesystem>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/ayumi.hpp"
#include "ayumi/render/renderer.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/repair/repair.hpp"
#ifdef HAS_MUJOCO
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#endif

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path data = argv[1];
  ayumi::LoadOptions with_meshes;
  with_meshes.meshes = true;
  const ayumi::RobotModel robot =
      ayumi::load_robot("hoap1", {{data / "robots"}}, with_meshes);  // ayumi::io
  const ayumi::CommandSeries series =
      ayumi::sample(robot, ayumi::stand_pattern(robot, 0.5));         // ayumi::core
  const ayumi::RepairResult repaired = ayumi::repair(robot, series);  // ayumi::repair

  ayumi::Scene scene;
  scene.poses = ayumi::body_poses(robot, series.samples.front().state);
  ayumi::RenderOptions small;
  small.width = 160;
  small.height = 90;
  ayumi::Renderer renderer(ayumi::robot_surface(robot), small);  // ayumi::render
  const ayumi::Image image = renderer.render(scene);

  std::printf("%s: %.3f kg, %s, %zu bytes of picture\n", robot.name().c_str(), robot.mass(),
              ayumi::name_of(repaired.status), image.rgb.size());
#ifdef HAS_MUJOCO
  ayumi::SimulateOptions other;
  other.plant = ayumi::mujoco_plant_kind();  // ayumi::plant_mujoco
  const ayumi::SimulationLog log = ayumi::simulate(robot, series, other);
  std::printf("MuJoCo: %s\n", ayumi::name_of(log.result.outcome));
  if (log.result.outcome != ayumi::Outcome::stands) return 1;
#endif
  const bool good = repaired.status == ayumi::RepairStatus::already_consistent &&
                    image.rgb.size() == 3u * 160u * 90u;
  return good ? 0 : 1;
}
