// A contact ends when its foot leaves the ground. A foot that stands longer violates no law of
// mechanics if the ZMP is over the other foot, but then the planned phases are not those of the
// motion. The time at which the foot began to leave is 2 t1 - t2, where t1 and t2 are the times at
// which its sole is 0.01 and 0.08 mm off its place. This holds if the height grows with the cube of
// time (demand/contact_plan.hpp, samples_after_contact()).
#include "ayumi/base/text.hpp"
#include "ayumi/limits/judged_motion.hpp"

namespace ayumi {

namespace {

// Time for which a foot may still stand after its contact [s]. Source: docs/attribution.md
// ("Contacts that end too early"): generated walks have -8 to 1 ms, a jump 3 ms. Chosen: ten times
// the largest of these. With half of the value, nothing changes; with twice, the check of the case
// "leaving" finds 1 error of support_margin instead of 1 error of contact_ends_early and 1 warning
// of support_margin.
constexpr double kLateTolerance = 0.030;

void judge_contact_ends(JudgedMotion& motion) {
  const double limit = motion.tolerance(FindingKind::contact_ends_early);
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    const std::vector<ContactInterval>& intervals = motion.plan.intervals[foot];
    for (size_t i = 0; i + 1 < intervals.size(); ++i) {
      if (!intervals[i].contact) continue;
      const double late =
          motion.series.dt *
          samples_after_contact(motion.model, motion.series, side, intervals[i], intervals[i + 1]);
      if (late > limit)
        motion.add(FindingKind::contact_ends_early, foot, intervals[i].last, late, limit, late);
    }
  }
}

Advice contact_end_advice(const JudgedMotion&, const FindingWindow& window) {
  return {"the " + std::string(name_of(foot_of(window.worst))) + " sole stands still for " +
              text::fixed(window.worst.value, 3) + " s after its contact ends",
          "let the contact end " + text::fixed(window.worst.value, 3) + " s later", ""};
}

std::string contact_end_infeasibility(const Finding& f, double) {
  return "the " + f.where + " foot stands still for " + text::fixed(1000 * f.worst, 0) +
         " ms after its contact has ended";
}

}  // namespace

const Limit& contact_timing_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::contact_ends_early,
                    .unit = "s",
                    .tolerance = kLateTolerance,
                    .meaning =
                        "time for which a foot stands still after the end of its planned contact",
                    .place = foot_place,
                    .advice = contact_end_advice,
                    .infeasibility = contact_end_infeasibility}},
      .judge_motion = judge_contact_ends};
  return limit;
}

}  // namespace ayumi
