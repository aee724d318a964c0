// Repairs ten faulty motions, each starting from no correction and from many random ones, and tells
// how many repairs end at the same motion, and how long they take.
//   ayumi_bad_starts [STARTS=100] [FIRST FAULT=0] [LAST FAULT=9]
// The exit code is 1 if fewer than 99 of 100 starts end at the same motion, or the longest repair
// takes more than five times the median.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "tests/support/ten_faults.hpp"

using namespace ayumi;
using namespace ayumi::test;

namespace {

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Outcome {
  double seconds = 0, away = 0;
  bool repaired = false;
};

bool measure(const FaultyMotion& motion, int starts) {
  // Distance below which motions count as the same [rad], [m]. Chosen: ten times the differences
  // that the tolerance of the solver leaves.
  constexpr double kSame = 1e-3;
  double begin = processor_seconds();
  const RepairResult usual = repair(hoap1(), motion.series, motion.options);
  const double usual_seconds = processor_seconds() - begin;
  std::vector<Outcome> all;
  for (int i = 0; i < starts; ++i) {
    RepairOptions options = motion.options;
    options.random_start = {0.1, static_cast<std::uint64_t>(1000 + i)};
    begin = processor_seconds();
    const RepairResult r = repair(hoap1(), motion.series, options);
    all.push_back({processor_seconds() - begin, motion_distance(r.series, usual.series),
                   r.status == RepairStatus::repaired});
  }
  const auto same = std::count_if(all.begin(), all.end(),
                                  [](const Outcome& o) { return o.repaired && o.away <= kSame; });
  const auto repaired =
      std::count_if(all.begin(), all.end(), [](const Outcome& o) { return o.repaired; });
  double away = 0;
  std::vector<double> seconds;
  for (const Outcome& o : all) {
    away = std::max(away, o.away);
    seconds.push_back(o.seconds);
  }
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds[seconds.size() / 2], worst = seconds.back();
  std::printf(
      "%-32s usual %-14s %5.2f s, %3d iterations; %ld of %d repaired, %ld at the same motion, "
      "largest difference %.1e; median %5.2f s, worst %5.2f s, ratio %.2f\n",
      motion.name.c_str(), name_of(usual.status), usual_seconds, usual.iterations, repaired, starts,
      same, away, median, worst, worst / median);
  std::fflush(stdout);
  return 100 * same >= 99 * starts && worst <= 5 * median;
}

}  // namespace

int main(int count, char** arguments) {
  const int starts = count > 1 ? std::max(1, std::atoi(arguments[1])) : 100;
  const std::vector<FaultyMotion> motions = ten_faulty_motions();
  const size_t first = count > 2 ? static_cast<size_t>(std::atoi(arguments[2])) : 0;
  const size_t last = count > 3 ? static_cast<size_t>(std::atoi(arguments[3])) : 9;
  bool good = true;
  for (size_t i = first; i <= std::min(last, motions.size() - 1); ++i)
    good = measure(motions[i], starts) && good;
  return good ? 0 : 1;
}
