#include "ayumi/repair/row_placement.hpp"

#include <algorithm>
#include <tuple>

#include "ayumi/repair/constraint_rows.hpp"
#include "ayumi/repair/dcm_rows.hpp"
#include "ayumi/repair/locked_rows.hpp"
#include "ayumi/repair/nlp/nlp.hpp"

namespace ayumi {

namespace policy = repair_policy;

namespace {

RowSettings row_settings(const CorrectionSpec& spec) {
  RowSettings s;
  s.trust = spec.trust;
  s.collisions = spec.collisions;
  s.near_pairs = spec.near_pairs;
  s.locked = spec.locked;
  s.locked_feet = spec.locked_feet;
  s.swing_goals = spec.swing_goals;
  s.watched_share = spec.watched_share;
  s.limit_share = spec.limit_share;
  s.active = policy::collocation::kActive;
  s.trusted_share = policy::kTrustedShare;
  s.joint_margin = spec.joint_margin;
  s.sole_position = spec.sole_position;
  s.support = {.least = spec.zmp_margin,
               .safe = spec.safe_margin,
               .mended = spec.safe_margin,
               .safe_around = policy::zmp::kSafeAround,
               .own_share = policy::zmp::kOwnShare};
  s.normal_force = {.least = spec.least_normal_force, .light = policy::collocation::kLightShare};
  s.friction = {.cone_share = spec.at_check_limits ? 1 : policy::kFirstBackoff.friction_cone,
                .rounding = policy::kFrictionRounding,
                .active = policy::collocation::kActiveFriction};
  s.exported_table = {.most_beyond = policy::kMostBeyond};
  s.flight = {.own_share = policy::flight::kOwnShare, .band = policy::flight::kBand};
  s.stance = {.angle = spec.sole_angle,
              .share_at_knots = spec.sole_at_knots,
              .tolerance_share = policy::stance::kToleranceShare,
              .corner_share = policy::stance::kCornerShare,
              .soft_time = policy::stance::kSoftTime,
              .soft_share = policy::stance::kSoftShare,
              .soft_upwards = policy::stance::kSoftUpwards,
              .edge_share = policy::stance::kEdgeShare};
  s.swing = {.near_place = policy::swing::kNearPlace,
             .place_slack = policy::swing::kPlaceSlack,
             .least_landing_height = policy::swing::kLeastLandingHeight,
             .own_landing_factor = policy::swing::kOwnLandingFactor,
             .lowest_measured = policy::swing::kLowestMeasured,
             .landing_period = policy::swing::kLandingPeriod,
             .height_period = policy::swing::kHeightPeriod,
             .height_share = policy::swing::kHeightShare,
             .watched_height = policy::swing::kWatchedHeight,
             .scrape_backoff = spec.at_check_limits ? 0 : spec.sole_position};
  s.clearance = {.touch = policy::clearance::kTouch,
                 .kept = spec.clearance,
                 .watched_bodies = policy::clearance::kWatchedBodies,
                 .watched_shapes = policy::clearance::kWatchedShapes,
                 .edge_allowance = policy::clearance::kEdgeAllowance,
                 .same_distance = policy::clearance::kSameDistance};
  return s;
}

// The rows in the order of the program. Points with a list `only` keep only the rows of this list.
std::vector<RowBlock> ordered(std::vector<RowBlock> all,
                              const std::vector<CollocationPoint>& points) {
  std::erase_if(all, [&](const RowBlock& block) {
    const auto& only = points[static_cast<size_t>(block.point)].only;
    return !only.empty() &&
           std::find(only.begin(), only.end(), std::pair(block.kind, block.item)) == only.end();
  });
  const auto key = [](const RowBlock& block) {
    const RowOrder& order = block.kind->order;
    return std::tuple(block.point, order.group, block.item, order.line);
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const RowBlock& a, const RowBlock& b) { return key(a) < key(b); });
  return all;
}

bool needs_torques(const RowBlock& block) {
  const JointRow* row = std::get_if<JointRow>(&block.rule);
  return row && row->of == JointQuantity::motor_torque;
}

}  // namespace

PlacedRows place_rows(const RobotModel& model, const CommandSeries& series,
                      const CorrectionSpec& spec, const ContactPlan& plan,
                      std::vector<CollocationPoint>& points) {
  RowSite site = {.model = model,
                  .series = series,
                  .plan = plan,
                  .points = points,
                  .seen = spec.seen,
                  .tolerances = spec.tolerance,
                  .actuators = model.limits(spec.profile),
                  .friction = spec.friction,
                  .settings = row_settings(spec)};
  for (const Limit* limit : limits())
    if (limit->place_rows) limit->place_rows(site);
  place_locked_rows(site, spec);
  place_dcm_rows(site, spec);

  PlacedRows placed;
  placed.blocks = ordered(std::move(site.rows), points);
  int count = 0;
  for (RowBlock& block : placed.blocks) {
    block.row = count;
    count += block.rows();
    placed.columns.push_back(block_columns(model, block));
    if (needs_torques(block)) points[static_cast<size_t>(block.point)].torques = true;
  }
  placed.lower.resize(count);
  placed.upper.resize(count);
  for (const RowBlock& block : placed.blocks) {
    placed.lower.segment(block.row, block.rows()) = block.lower.cwiseMax(-kNoBound);
    placed.upper.segment(block.row, block.rows()) = block.upper.cwiseMin(kNoBound);
  }
  return placed;
}

RowPrices row_prices() {
  return {.length = policy::prices::kLength,
          .angle = policy::prices::kAngle,
          .share = policy::prices::kShare,
          .zmp_margin = policy::prices::kZmpMargin,
          .landing = policy::prices::kLanding,
          .dcm = policy::prices::kDcm,
          .limit = policy::prices::kLimit,
          .foot = policy::prices::kFoot};
}

}  // namespace ayumi
