// A swinging sole that moves along the ground must be above it. Servos sag under the weight of the
// robot, so a sole that is planned to pass just over the ground scrapes it, and the friction trips
// the robot. With the corners x_i of the sole, where they were or will be at rest v_i, and the
// normal n of that place,
//   height = min n . (x_i - v_i),   way = max |x_i - v_i| along the ground.
// The height over the lower of both places must not be below the tolerance while the ways to both
// places are longer than the slip that a standing sole may have. So nothing is asked of a foot that
// lifts off, that comes down, or that rests in its place without a load. In flight, no foot carries
// the robot, and nothing is asked either.
#include <algorithm>
#include <limits>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/limits/sole_rows.hpp"

namespace ayumi {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// Smallest height of a swinging sole that moves along the ground [m]. Chosen: the servos of HOAP-1
// sag by a millimetre (repair/policy.hpp, swing), so a sole that is planned lower is on the ground.
// In a planned swing of 60 mm (plan/foot_plan), a foot that is 2 mm away from its place is at a
// third of its lift, so this limit asks for a lift of about 3 mm.
constexpr double kScrapeTolerance = 0.001;

// The height of a swinging sole while it is away from its places, otherwise infinity [m].
double height_on_the_way(const RobotModel& model, const ContactPlan& plan, Side side, int k,
                         const Eigen::Isometry3d& sole, double slip) {
  const int s = static_cast<int>(side);
  const int i = plan.index[s][k], count = static_cast<int>(plan.intervals[s].size());
  double height = -kNone;
  for (const int j : {i - 1, i + 1}) {
    if (j < 0 || j >= count) continue;
    const SoleError e = sole_error(model.sole(side), sole, plan.intervals[s][j].sole);
    if (e.slip <= slip) return kNone;
    height = std::max(height, e.lowest);
  }
  return height == -kNone ? kNone : height;
}

// Whether the other foot carries the robot while this foot swings.
bool swings(const ContactPlan& plan, Side side, int k) {
  return plan.support(k) == (side == Side::left ? Support::right : Support::left);
}

void note_swings(JudgedMotion& motion, const JudgedSample& s, const RobotData& data) {
  const double slip = motion.tolerance(FindingKind::foot_slip);
  for (const Side side : {Side::left, Side::right})
    if (swings(motion.plan, side, s.k))
      motion.height_on_the_way[static_cast<int>(side)][s.k] = height_on_the_way(
          motion.model, motion.plan, side, s.k, sole_pose(motion.model, data, side), slip);
}

// A sole that is too deep in the ground is a finding of its own (stance.cpp).
void judge_scrapes(JudgedMotion& motion) {
  const double least = motion.tolerance(FindingKind::foot_scrape);
  const double deep = motion.tolerance(FindingKind::foot_penetration);
  for (int foot = 0; foot < 2; ++foot)
    for (int k = 0; k < motion.count(); ++k) {
      const double height = motion.height_on_the_way[foot][k];
      if (height < least && height >= -deep)
        motion.add(FindingKind::foot_scrape, foot, k, height, least, least - height);
    }
}

const RowKind kScrapeRows = {
    .name = "scrape", .unit = &RowPrices::length, .relaxed = &RowPrices::foot, .order = {2, 5}};

void place_scrape_rows(RowSite& site) {
  const double least = site.tolerance(FindingKind::foot_scrape);
  const double slip = site.tolerance(FindingKind::foot_slip);
  for (const Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    const int corners = static_cast<int>(site.model.sole(side).polygon.size());
    for (int i = 0; i < site.count(); ++i) {
      const CollocationPoint& at = site.points[i];
      if (!swings(site.plan, side, at.sample) || site.settings.locked_feet[foot]) continue;
      double height = kNone;
      for (const CommandSample* sample : site.watched(i)) {
        update_positions(site.model, sample->state, site.data);
        height = std::min(height, height_on_the_way(site.model, site.plan, side, at.sample,
                                                    sole_pose(site.model, site.data, side), slip));
      }
      if (height < least + site.settings.swing.watched_height)
        site.add(kScrapeRows, i, foot, height_rows(site.model, side, at.ground[foot]), corners,
                 least + site.settings.sole_position, kUnbounded);
    }
  }
}

Advice scrape_advice(const JudgedMotion&, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string foot = name_of(foot_of(v));
  return {"the " + foot + " sole moves along the ground only " + text::fixed(1000 * v.value, 1) +
              " mm above it, so it scrapes the ground when the servos give way: lift the foot " +
              in_mm(v.limit - v.value) + " higher",
          kOrRepair};
}

std::string scrape_infeasibility(const Finding& f, double) {
  return "the " + f.where + " foot scrapes the ground, only " + text::fixed(1000 * f.worst, 1) +
         " mm above it";
}

}  // namespace

const Limit& foot_scrape_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::foot_scrape,
                    .unit = "m",
                    .tolerance = kScrapeTolerance,
                    .meaning = "smallest height of a swinging sole while it moves along the ground",
                    .place = foot_place,
                    .advice = scrape_advice,
                    .infeasibility = scrape_infeasibility}},
      .note_sample = note_swings,
      .judge_motion = judge_scrapes,
      .place_rows = place_scrape_rows};
  return limit;
}

}  // namespace ayumi
