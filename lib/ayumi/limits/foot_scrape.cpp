// A swinging sole that moves along the ground must be above it, because the friction of a sole that
// scrapes the ground trips the robot. Each corner x of the sole is judged by its own path, because
// a sole that rolls over its heel or its toe moves, but the corner on the ground does not. The foot
// stood in one place and will stand in another place. With the position v of the corner in such a
// place, and the normal n of the place,
//   height = n . (x - v),   way = |x - v| along the ground.
// The height over the lower one of the two places is judged, because the edge of a step between
// them is not known. A stretch is a series of samples in which the corner is lower than the
// tolerance, so that it is on the ground like a corner of a standing sole. In a stretch, the
// distance of the corner from its place of rest may be at most the slip that a standing sole may
// have. The corner is at rest
//   - in the place of lift-off, if the stretch begins with the swing,
//   - in the place of landing, if the stretch ends with the swing,
//   - where it came down, if the stretch does neither.
// So this limit requires nothing of a foot that lifts off, that lands, that rolls, or that rests on
// or just over the ground without a load. In flight, no foot carries the robot, and the limit
// requires nothing, either.
#include "ayumi/limits/foot_scrape.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/limits/judged_motion.hpp"
#include "ayumi/limits/row_site.hpp"
#include "ayumi/limits/sole_rows.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

// Smallest height of a corner of a swinging sole that moves along the ground [m]. Chosen: up to
// this height, the check takes a standing sole to be on the ground (kFloatTolerance of stance.cpp),
// for every robot. So a corner that is lower and moves slips. How high a foot has to pass so that
// no real robot trips depends on its servos, and a simulation shows it. Measured: a walk of SR1
// with a lift of 0.4 mm falls in a simulation, and stands with 0.6 mm; the check finds its scraping
// feet up to 1.5 mm. Four smaller robots stand with 0.4 mm, too, so the limit is not too low
// (docs/measurements/repair.md). A planned swing of 60 mm (plan/foot_plan) meets the limit with a
// lift of 1 mm, and a swing of 400 mm with 2.3 mm: at the distance of the slip that is allowed, a
// longer swing has risen by a smaller share of its lift. No bundled pattern and no default of
// `ayumi new` has a finding with half of the value, with twice, or with 1 mm. With half of the
// value, a walk of HOAP-1 with a lift of 0.6 mm has no finding; with twice, a walk with a lift of
// 1.5 mm has findings.
constexpr double kScrapeTolerance = 0.0003;

// Whether the other foot carries the robot while this foot swings.
bool swings(const ContactPlan& plan, Side side, int k) {
  return plan.support(k) == (side == Side::left ? Support::right : Support::left);
}

// One corner during one swing.
class CornerOfSwing {
 public:
  CornerOfSwing(const ContactPlan& plan, Side side, int interval, const Sole& sole, int corner,
                const std::function<Isometry3d(int)>& pose_at)
      : intervals_(plan.intervals[static_cast<int>(side)]),
        interval_(interval),
        corner_(corner),
        in_sole_(sole.polygon[corner].x(), sole.polygon[corner].y(), 0),
        pose_at_(pose_at) {}

  bool stood() const { return interval_ > 0; }
  bool will_stand() const { return interval_ + 1 < static_cast<int>(intervals_.size()); }

  Scrape at(int k) const {
    Scrape highest = {corner_, -1, 0};
    for (const int place : {interval_ - 1, interval_ + 1}) {
      if (place < 0 || place >= static_cast<int>(intervals_.size())) continue;
      const double height = normal(place).dot(position(k) - rest(place));
      if (highest.place < 0 || height > highest.height) highest = {corner_, place, height};
    }
    return highest;
  }

  /// Whether the corner moves in sample k of the stretch first..last.
  bool moves(int k, int first, int last, double slip) const {
    const bool lifts = stood() && first == intervals_[interval_].first;
    const bool lands = will_stand() && last == intervals_[interval_].last;
    if (lifts && way(k, rest(interval_ - 1), interval_ - 1) <= slip) return false;
    if (lands && way(k, rest(interval_ + 1), interval_ + 1) <= slip) return false;
    return lifts || lands || way(k, position(first), at(k).place) > slip;
  }

 private:
  Vector3d position(int k) const { return pose_at_(k) * in_sole_; }
  Vector3d rest(int place) const { return intervals_[place].sole * in_sole_; }
  Vector3d normal(int place) const { return intervals_[place].sole.linear().col(2); }
  double way(int k, const Vector3d& from, int place) const {
    return normal(place).cross(position(k) - from).norm();
  }

  const std::vector<ContactInterval>& intervals_;
  int interval_, corner_;
  Vector3d in_sole_;
  const std::function<Isometry3d(int)>& pose_at_;
};

}  // namespace

std::vector<std::vector<Scrape>> scrapes(const Sole& sole, const ContactPlan& plan, Side side,
                                         const std::function<Isometry3d(int)>& pose_at, double low,
                                         double slip) {
  std::vector<std::vector<Scrape>> found(plan.index[static_cast<int>(side)].size());
  const std::vector<ContactInterval>& intervals = plan.intervals[static_cast<int>(side)];
  for (int i = 0; i < static_cast<int>(intervals.size()); ++i) {
    if (intervals[i].contact || intervals.size() == 1) continue;
    for (int c = 0; c < static_cast<int>(sole.polygon.size()); ++c) {
      const CornerOfSwing corner(plan, side, i, sole, c, pose_at);
      const auto is_low = [&](int k) { return swings(plan, side, k) && corner.at(k).height < low; };
      for (int first = intervals[i].first; first <= intervals[i].last; ++first) {
        if (!is_low(first)) continue;
        int last = first;
        while (last < intervals[i].last && is_low(last + 1)) ++last;
        for (int k = first; k <= last; ++k)
          if (corner.moves(k, first, last, slip)) found[k].push_back(corner.at(k));
        first = last;
      }
    }
  }
  return found;
}

namespace {

void note_poses(JudgedMotion& motion, const JudgedSample& s, const RobotData& data) {
  for (const Side side : {Side::left, Side::right})
    if (Isometry3d* const pose = motion.pose_in_swing(side, s.k))
      *pose = sole_pose(motion.model, data, side);
}

// Rounding must not make an error of a corner that a repair leaves at the limit. A sole that is too
// deep in the ground is a finding of its own (stance.cpp).
void judge_scrapes(JudgedMotion& motion) {
  const double least = motion.tolerance(FindingKind::foot_scrape);
  const double slip = motion.tolerance(FindingKind::foot_slip);
  const double deep = motion.tolerance(FindingKind::foot_penetration);
  for (const Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    const auto found = scrapes(
        motion.model.sole(side), motion.plan, side,
        [&](int k) { return *motion.pose_in_swing(side, k); }, least, slip);
    for (int k = 0; k < motion.count(); ++k) {
      double height = least;
      for (const Scrape& scrape : found[k]) height = std::min(height, scrape.height);
      if (height < least - kRounding && height >= -deep)
        motion.add(FindingKind::foot_scrape, foot, k, height, least, least - height);
    }
  }
}

const RowKind kScrapeRows = {.name = "scrape",
                             .unit = &RowPrices::length,
                             .relaxed = &RowPrices::foot,
                             .beyond_check = true,
                             .order = {2, 5}};

// The corners that scrape in the given motion or in an earlier result have rows, over the plane
// over which the check measures their heights.
void place_scrape_rows(RowSite& site) {
  const double least = site.tolerance(FindingKind::foot_scrape);
  const double slip = site.tolerance(FindingKind::foot_slip);
  std::vector<const CommandSeries*> watched = {&site.series};
  watched.insert(watched.end(), site.seen.begin(), site.seen.end());
  for (const Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    if (site.settings.locked_feet[foot]) continue;
    const Sole& sole = site.model.sole(side);
    // The scraping corners by sample and place.
    std::map<std::pair<int, int>, std::set<int>> corners;
    for (const CommandSeries* series : watched) {
      std::map<int, Isometry3d> poses;  // poses of the samples that were evaluated
      const auto pose_at = [&](int k) {
        const auto [pose, is_new] = poses.try_emplace(k, Isometry3d::Identity());
        if (is_new) {
          update_positions(site.model, series->samples[k].state, site.data);
          pose->second = sole_pose(site.model, site.data, side);
        }
        return pose->second;
      };
      const auto found = scrapes(sole, site.plan, side, pose_at, least, slip);
      for (int k = 0; k < static_cast<int>(found.size()); ++k)
        for (const Scrape& scrape : found[k]) corners[{k, scrape.place}].insert(scrape.corner);
    }
    for (int i = 0; i < site.count(); ++i) {
      const int k = site.points[i].sample;
      for (auto at = corners.lower_bound({k, 0}); at != corners.end() && at->first.first == k;
           ++at) {
        std::vector<Eigen::Vector2d> low;
        for (const int corner : at->second) low.push_back(sole.polygon[corner]);
        const int count = static_cast<int>(low.size());
        const Isometry3d& ground = site.plan.intervals[foot][at->first.second].sole;
        site.add(kScrapeRows, i, foot, height_rows(side, std::move(low), ground), count,
                 least + site.settings.swing.scrape_backoff, kUnbounded);
      }
    }
  }
}

std::string height_text(double height) {
  return height < 0 ? text::fixed(-1000 * height, 2) + " mm below the ground"
                    : "only " + text::fixed(1000 * height, 2) + " mm above the ground";
}

Advice scrape_advice(const JudgedMotion&, const FindingWindow& window) {
  const Violation& v = window.worst;
  const std::string foot = name_of(foot_of(v));
  const double wanted = 0.01 * std::ceil(1e5 * (v.limit - v.value));  // in mm
  return {"the swinging " + foot + " sole scrapes the ground. One of its corners is " +
              height_text(v.value) + " while it moves along the ground, but it must be at least " +
              text::fixed(1000 * v.limit, 2) + " mm above the ground",
          "lift the foot " + text::fixed(wanted, 2) +
              " mm higher there, for example with a higher \"lift\" of this swing",
          kOrRepair};
}

std::string scrape_infeasibility(const Finding& f, double) {
  return "a corner of the swinging " + f.where + " sole moves along the ground and is " +
         height_text(f.worst);
}

}  // namespace

const Limit& foot_scrape_limit() {
  static const Limit limit = {
      .findings = {{.kind = FindingKind::foot_scrape,
                    .unit = "m",
                    .tolerance = kScrapeTolerance,
                    .meaning = "smallest height of a corner of a swinging sole while this corner "
                               "moves along the ground",
                    .place = foot_place,
                    .advice = scrape_advice,
                    .infeasibility = scrape_infeasibility}},
      .note_sample = note_poses,
      .judge_motion = judge_scrapes,
      .place_rows = place_scrape_rows};
  return limit;
}

}  // namespace ayumi
