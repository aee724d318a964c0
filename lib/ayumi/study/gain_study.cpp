#include "ayumi/study/gain_study.hpp"

#include <cmath>
#include <tuple>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/capture_bound.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

namespace {

/// Pushes are studied while the robot stands on both feet, and on the left foot with the COG over
/// its middle.
std::vector<Reach> reaches(const RobotModel& model) {
  CommandSeries both = sample(model, stand_pattern(model, 0.01));
  CommandSeries left = both;
  for (CommandSample& s : left.samples) {
    s.support = Support::left;
    const Eigen::Vector2d c = model.sole(Side::left).center;
    s.zmp = s.feet[0] * Eigen::Vector3d(c.x(), c.y(), 0);
    s.cog.head<2>() = s.zmp.head<2>();
  }
  std::vector<Reach> result;
  for (const bool one : {false, true}) {
    const CaptureRegion region = capture_region(model, one ? left : both, 0);
    for (const auto& [name, x, y] :
         {std::tuple{"forward", 1.0, 0.0}, std::tuple{"back", -1.0, 0.0},
          std::tuple{"left", 0.0, 1.0}, std::tuple{"right", 0.0, -1.0}}) {
      const double impulse = capture_bound(region, {x, y});
      result.push_back(
          {one ? "left foot" : "both feet", name, impulse / region.impulse_per_length, impulse});
    }
  }
  return result;
}

}  // namespace

std::vector<std::pair<std::string, double>> gain_list(const DtadParams& p) {
  std::vector<std::pair<std::string, double>> list;
  if (p.k)
    list = {{"k", *p.k}, {"d", *p.d}};
  else
    list = {{"q", p.pole_ratio}};
  for (const auto& entry : std::vector<std::pair<std::string, double>>{{"ka", p.zmp_gain},
                                                                       {"ks", p.pull_rate},
                                                                       {"kd", p.pull_damping},
                                                                       {"damp", p.rocking_damping},
                                                                       {"tau_z", p.zmp_filter},
                                                                       {"margin", p.margin},
                                                                       {"washout", p.offset_time},
                                                                       {"kz", p.height_stiffness},
                                                                       {"dz", p.height_damping},
                                                                       {"kaz", p.fz_gain},
                                                                       {"ankle", p.ankle_share},
                                                                       {"conform", p.compliance}})
    list.push_back(entry);
  return list;
}

GainStudy study_gains(const RobotModel& model, const GainWishes& wishes,
                      const std::vector<std::pair<std::string, double>>& gains,
                      std::optional<double> latency) {
  if (latency && !(*latency >= 0 && *latency <= GainStudy::kMostLatency))
    fail(ErrorCode::usage, "the latency of the sensors is " + text::brief(*latency) +
                               " s; it must be from 0 to " + text::brief(GainStudy::kMostLatency) +
                               " s");
  GainStudy d;
  const CommandSample first = sample(model, stand_pattern(model, 0.01)).samples.front();
  const double z = first.cog.z() - first.zmp.z();
  d.omega = std::sqrt(kGravity / z);
  ControllerSpec spec;
  spec.gains = gains;
  d.params = design_gains(d.omega, wishes, dtad_params(model, spec));
  d.loops = stance_loops(model, model.limits(), z, model.description().servo_period);
  if (latency)
    for (LoopModel& loop : d.loops)
      loop.delay += *latency - model.description().sensors.oldest(loop.tick);
  d.weakest = weakest_loop(d.loops, d.params);
  d.largest_ka = largest_stable_ka(d.loops, d.params, GainStudy::kMostKa);
  d.reaches = reaches(model);
  return d;
}

}  // namespace ayumi
