// Compares early verdicts of random pushes with full runs: whether a run that has entered the set
// around the unpushed run (study/recorded_run) stands at its end, how much sooner the verdict is
// known, and how far such runs go from the unpushed one afterwards.
//   ayumi_early_verdicts [CASES=1000] [SEED=1]
// The exit code is 1 if a verdict is wrong.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/study/recorded_run.hpp"
#include "ayumi/study/runs.hpp"

using namespace ayumi;

namespace {

constexpr double kPushTime = 0.02;  // duration of a push [s]
constexpr long kTicksPerTest = 10;
/// Time at the end during which a robot has to be at rest [s].
constexpr double kRest = 0.5;
/// Share of the set in which figures are decided (study/push).
constexpr double kWellInside = 1.0 / 3;
/// Time without pushes at the beginning and at the end of a motion [s].
constexpr double kEdge = 0.3;

struct Motion {
  std::string name;
  const RobotModel* model;
  CommandSeries series;
  World world;
  std::string profile;
  bool noise = false;
};

struct Law {
  std::string name;
  ControllerSpec spec;
  double largest;  // largest push, in capture bounds
};

struct Tried {
  double at, direction, level;
};

struct Count {
  int cases = 0, stand = 0, early = 0, wrong = 0;
  double early_time = 0, full_time = 0;  // times of the runs in which the robot stands [s]
  // The largest drift after the run has been in the set, and after it has been in a third of the
  // set.
  double farthest = 0, inside = 0;
  double last = 0;  // largest drift in the last half second
};

void add(const Count& one, Count& all) {
  all.cases += one.cases, all.stand += one.stand, all.early += one.early, all.wrong += one.wrong;
  all.early_time += one.early_time, all.full_time += one.full_time;
  all.farthest = std::max(all.farthest, one.farthest);
  all.inside = std::max(all.inside, one.inside);
  all.last = std::max(all.last, one.last);
}

void print(const std::string& name, const Count& c) {
  const double stand = std::max(1, c.stand);
  std::printf("%-44s %5d %6d %6d %6d   %6.3f %6.3f   %6.2f %6.2f %6.2f\n", name.c_str(), c.cases,
              c.stand, c.early, c.wrong, c.early_time / stand, c.full_time / stand, c.farthest,
              c.inside, c.last);
  std::fflush(stdout);
}

void try_push(const Motion& motion, const Tried& tried, const Simulator& before,
              const RecordedRun& unpushed, Count& count) {
  const Eigen::Vector2d u(std::cos(tried.direction), std::sin(tried.direction));
  const long k = std::lround(tried.at / motion.series.dt);
  const double bound = capture_bound(capture_region(*motion.model, motion.series, k), u);
  Simulator run = before;
  run.set_scenario(
      {{.at = tried.at,
        .duration = kPushTime,
        .what = Push{.magnitude = tried.level * bound, .direction = {u.x(), u.y(), 0}}}});
  const double end = motion.series.duration() + SimulateOptions().settle;
  double verdict = -1, farthest = 0, inside = -1;
  bool more = true;
  while (more && !run.fell()) {
    more = run.advance(kTicksPerTest);
    if (run.fell() || run.time() <= tried.at + kPushTime) continue;
    if (verdict < 0 && unpushed.contains(run)) verdict = run.time();
    const double drift = unpushed.drift(run);
    if (!std::isfinite(drift)) continue;  // the tick is after the last one that was recorded
    if (verdict >= 0) farthest = std::max(farthest, drift);
    if (verdict >= 0 && run.time() > end - kRest) count.last = std::max(count.last, drift);
    if (inside >= 0 || unpushed.contains(run, kWellInside)) inside = std::max(inside, drift);
  }
  const bool stands = !run.fell() && run.result().outcome == Outcome::stands;
  ++count.cases;
  count.stand += stands;
  count.early += verdict >= 0;
  count.wrong += verdict >= 0 && !stands;
  count.farthest = std::max(count.farthest, farthest);
  count.inside = std::max(count.inside, inside);
  if (verdict >= 0 && !stands)
    std::printf("  wrong: %s, push of %.2f B at %.3f s, %.0f deg: in the set at %.3f s, then %s\n",
                motion.name.c_str(), tried.level, tried.at, tried.direction * 180 / M_PI, verdict,
                name_of(run.result().outcome));
  if (!stands) return;
  count.early_time += (verdict < 0 ? run.time() : verdict) - tried.at;
  count.full_time += run.time() - tried.at;
}

Count measure(const Motion& motion, const Law& law, int cases, Random& random) {
  SimulateOptions options;
  options.controller = law.spec;
  options.world = motion.world;
  options.profile = motion.profile;
  options.sensor_noise = motion.noise;
  std::vector<Tried> all;
  const double span = motion.series.duration() - 2 * kEdge;
  for (int i = 0; i < cases; ++i) {
    const double at = kEdge + span * random.uniform(), direction = 2 * M_PI * random.uniform();
    all.push_back({motion.series.dt * std::round(at / motion.series.dt), direction,
                   law.largest * random.uniform()});
  }
  std::sort(all.begin(), all.end(), [](const Tried& a, const Tried& b) { return a.at < b.at; });

  Simulator run(*motion.model, motion.series, options);
  run.keep_samples(false);
  RecordedRun unpushed(motion.world);
  std::vector<Simulator> before;  // the simulator of each case before its push
  while (run.advance(1) && !run.fell()) {
    unpushed.record(run);
    while (before.size() < all.size() &&
           run.time() >= all[before.size()].at - 1.5 * motion.series.dt)
      before.push_back(run);
  }
  Count count;
  // If the unpushed run does not stand at its end, no push is studied.
  if (run.fell() || run.result().outcome != Outcome::stands) return count;
  for (size_t i = 0; i < before.size(); ++i) try_push(motion, all[i], before[i], unpushed, count);
  return count;
}

}  // namespace

int main(int argument_count, char** arguments) {
  const int cases = argument_count > 1 ? std::max(1, std::atoi(arguments[1])) : 1000;
  Random random(argument_count > 2 ? static_cast<std::uint64_t>(std::atoll(arguments[2])) : 1);
  const RobotModel hoap1 = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const RobotModel humanoid30 = load_robot(AYUMI_SOURCE_DIR "/robots/humanoid30");
  const Pattern bundled = read_pattern(AYUMI_SOURCE_DIR "/patterns/hoap1_walk.json");
  const Pattern large = read_pattern(AYUMI_SOURCE_DIR "/patterns/humanoid30_walk.json");
  const CommandSeries walk = sample(hoap1, bundled);
  std::vector<Motion> motions = {
      {"hoap1_walk", &hoap1, walk, bundled.world, ""},
      {"hoap1_walk, noise", &hoap1, walk, bundled.world, "", true},
      {"hoap1, standing", &hoap1, standing_series(walk), bundled.world, ""},
      {"humanoid30_walk", &humanoid30, sample(humanoid30, large), large.world, ""}};
  const auto generated = [&](const std::string& name, const WalkParameters& parameters) {
    const Pattern pattern = walk_pattern(hoap1, parameters);
    motions.push_back({name, &hoap1, sample(hoap1, pattern), pattern.world, "hoap1-strong"});
  };
  generated("walk turning 8 deg a step", {.turn = 8 * M_PI / 180});
  generated("walk sideways", {.stride = 0, .side = 0.03});
  generated("walk backwards", {.stride = -0.02});
  const std::vector<Law> laws = {{"open loop", {ControllerKind::none, {}}, 1.0},
                                 {"dtad", {ControllerKind::dtad, {}}, 2.2}};
  std::printf("%-44s %5s %6s %6s %6s   %6s %6s   %6s %6s %6s\n", "motion, law", "cases", "stand",
              "early", "wrong", "early", "full", "drift", "third", "end");
  Count all;
  const int pairs = static_cast<int>(motions.size() * laws.size());
  for (size_t m = 0; m < motions.size(); ++m)
    for (size_t l = 0; l < laws.size(); ++l) {
      const int pair = static_cast<int>(m * laws.size() + l);
      const int share = cases * (pair + 1) / pairs - cases * pair / pairs;
      const Count one = measure(motions[m], laws[l], share, random);
      print(motions[m].name + ", " + laws[l].name, one);
      add(one, all);
    }
  print("all", all);
  std::printf(
      "early, full: mean time from a push that is survived to its verdict and to the end of the "
      "run [s]\ndrift, third: largest drift from the unpushed run after the run was in the set, "
      "and "
      "in the third of it; 1: the edge of the set\nend: the same as drift, in the last half "
      "second\n");
  return all.wrong == 0 ? 0 : 1;
}
