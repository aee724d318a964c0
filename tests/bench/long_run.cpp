// Hours of walking and standing in one plant that is never reset, which must show no drift, no leak
// and no NaN.
//   ayumi_long_run [simulated hours, half walking, half standing; 0.5] [controller; dtad]
// HOAP-1 walks the pattern and its mirror image in turn, each round from where the last one ended,
// then stands in one run. A line is printed after every tenth of the time; the last line is the
// verdict, and the program fails if the robot fell, turned away, or if a quantity grew. No sensor
// knows the heading, and a pattern that begins with the same foot turns the robot a little each
// time: in turn with its mirror image these turns cancel, and a remaining turn would be caused by
// the integrator.

#include <unistd.h>

#include <Eigen/Dense>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "ayumi/author/edit/edit.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/simulator.hpp"
#include "tests/support/walk.hpp"

namespace {

using namespace ayumi;
using Eigen::Vector3d;

/// A plant that continues over several runs: only the first run places the robot.
struct Lasting {
  Plant* plant;
  bool* placed;
  const RobotState& state() const { return plant->state(); }
  const RobotData& data() const { return plant->data(); }
  void set_state(const RobotState& state) {
    if (!*placed) plant->set_state(state);
    *placed = true;
  }
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt) {
    return plant->step(targets, input, dt);
  }
};

/// The memory that this program holds [MiB].
double resident() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// The COG relative to the middle of the feet, along their heading, and the height of the feet.
Eigen::Vector4d stance(const RobotModel& model, const RobotData& data) {
  const Eigen::Isometry3d left = sole_pose(model, data, Side::left);
  const Eigen::Isometry3d right = sole_pose(model, data, Side::right);
  const Vector3d middle = 0.5 * (left.translation() + right.translation());
  Eigen::Vector4d result;
  result << left.linear().transpose() * (data.cog - middle), middle.z();
  return result;
}

struct Spread {
  Eigen::Vector4d low = Eigen::Vector4d::Constant(1e30), high = -low;
  void add(const Eigen::Vector4d& v) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  double widest() const { return (high - low).maxCoeff(); }
};

bool walk(const RobotModel& model, const std::string& controller, double hours) {
  const Pattern pattern = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const CommandSeries series[2] = {sample(model, pattern), sample(model, mirrored(model, pattern))};
  SimulateOptions options;
  options.controller.type = controller_type(controller);
  Plant plant(model, model.limits(), options.world);
  bool placed = false;
  options.plant.make = [&](const RobotModel&, const ActuatorLimits&, const World&) {
    return PlantInterface(Lasting{&plant, &placed});
  };
  Spread ends[2];
  double time = 0, path = 0, start = 0, error = 0, heading = 0;
  const auto widest = [&] { return std::max(ends[0].widest(), ends[1].widest()); };
  for (int round = 0, shown = 0; time < 3600 * hours; ++round) {
    const Vector3d before = plant.data().cog;
    Simulator run(model, series[round % 2], options);
    run.keep_samples(false);
    while (run.advance(1000)) {
    }
    time += 0.4 + run.time();
    if (run.fell()) {
      std::printf("fell in round %d, after %.1f s\n", round, time);
      return false;
    }
    if (round > 0) path += (plant.data().cog - before).norm();
    ends[round % 2].add(stance(model, plant.data()));
    error = std::max(error, run.result().final_cog_error);
    if (round % 2 == 1) heading = matrix_to_rpy(plant.state().base.attitude.toRotationMatrix()).z();
    if (round == 1) start = resident();
    if (time >= 360 * hours * shown) {
      std::printf(
          "walked %8.1f s, %6d rounds, %8.1f m, heading %+.5f rad, memory %.2f MiB, "
          "ends differ by %.3g m, COG error %.3g m\n",
          time, round + 1, path, heading, resident(), widest(), error);
      std::fflush(stdout);
      ++shown;
    }
  }
  const double grown = resident() - start;
  std::printf("walking: memory grew by %.2f MiB, ends differ by %.3g m, heading %+.5f rad\n", grown,
              widest(), heading);
  return grown < 4 && widest() < 1e-3 && std::abs(heading) < 0.01;
}

bool stand(const RobotModel& model, const std::string& controller, double hours) {
  const CommandSeries series = test::standing(model, 0.01);
  SimulateOptions options;
  options.controller.type = controller_type(controller);
  options.settle = 3600 * hours;
  Simulator run(model, series, options);
  run.keep_samples(false);
  Vector3d zmp_low = Vector3d::Constant(1e30), zmp_high = -zmp_low, cog = zmp_low;
  double fz_low = 1e30, fz_high = 0, drift = 0, start = 0;
  int shown = 0;
  while (run.advance(100)) {
    if (run.fell()) {
      std::printf("fell after %.1f s\n", run.time());
      return false;
    }
    if (run.time() < 5) continue;
    const SimulationSample& s = run.last_sample();
    if (start == 0) start = resident(), cog = s.cog;
    drift = std::max(drift, (s.cog - cog).norm());
    zmp_low = zmp_low.cwiseMin(s.zmp);
    zmp_high = zmp_high.cwiseMax(s.zmp);
    fz_low = std::min(fz_low, s.fz);
    fz_high = std::max(fz_high, s.fz);
    if (run.time() >= 360 * hours * (shown + 1)) {
      std::printf(
          "stood %9.1f s, memory %.2f MiB, COG has moved %.3g m, ZMP within %.3g m, "
          "f_z within %.3g N\n",
          run.time(), resident(), drift, (zmp_high - zmp_low).norm(), fz_high - fz_low);
      std::fflush(stdout);
      ++shown;
    }
  }
  const double grown = resident() - start;
  std::printf("standing: memory grew by %.2f MiB, COG moved %.3g m\n", grown, drift);
  return grown < 4 && drift < 1e-3;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const double hours = argc > 1 ? std::atof(argv[1]) : 0.5;
    const std::string controller = argc > 2 ? argv[2] : "dtad";
    const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
    const bool walked = walk(model, controller, 0.5 * hours);
    return stand(model, controller, 0.5 * hours) && walked ? 0 : 1;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
