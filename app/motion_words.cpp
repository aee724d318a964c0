#include "motion_words.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/task/plan_log.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

constexpr size_t kJointsListed = 8, kJointsDrawn = 4, kSpeedsDrawn = 2;  // numbers that fit a page
// Smallest move that is named [rad]. A smaller move would be written as 0.00 deg.
constexpr double kLeastMove = 0.005 * EIGEN_PI / 180;

std::string millimetres(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }
std::string seconds(double t) { return text::fixed(t, 3) + " s"; }

// The change of a joint, such as "r_knee by up to -3.20 deg (at 1.700 s; moved within 1.30-5.09
// s)".
std::string joint_words(const RobotModel& model, const JointChange& j, const std::string& changed) {
  const bool slides = model.dofs()[model.find_dof(j.joint)].prismatic;
  const std::string sign = j.most > 0 ? "+" : "";
  return j.joint + " by up to " + sign +
         (slides ? millimetres(j.most) : text::fixed(j.most * 180 / EIGEN_PI, 2) + " deg") +
         " (at " + seconds(j.at) + "; " + changed + " within " + text::fixed(j.begin, 2) + "-" +
         text::fixed(j.end, 2) + " s)";
}

std::string largest(const std::string& what, const LargestChange& change,
                    const std::string& amount) {
  return what + " by up to " + amount + " at " + seconds(change.at);
}

}  // namespace

std::string margin_words(double margin) {
  return millimetres(std::abs(margin)) + (margin < 0 ? " outside" : " inside") + " the support";
}

std::string motion_words(const RobotModel& model, const MotionChange& change,
                         const ConsistencyReport& before, const ConsistencyReport& after,
                         const MotionNames& names) {
  const bool files = !names.first.empty();
  const std::string was = files ? " in " + names.first : " before",
                    is = files ? " in " + names.second : " after",
                    moved = files ? " differs" : " moved",
                    changed = files ? " differs" : " changed", lead = files ? "    " : "  moved ",
                    feet = files ? "feet differ" : "feet moved";
  std::string out;
  size_t listed = 0;
  while (listed < std::min(kJointsListed, change.joints.size()) &&
         std::abs(change.joints[listed].most) >= kLeastMove)
    ++listed;
  if (listed == 0) out += files ? "  no joint differs\n" : "  no joint moved\n";
  if (files && listed > 0)
    out += "  the angles in " + names.second + " differ from the angles in " + names.first + ":\n";
  for (size_t i = 0; i < listed; ++i)
    out += (i == 0 ? lead : std::string(lead.size(), ' ')) +
           joint_words(model, change.joints[i], files ? "different" : "moved") + "\n";
  const size_t rest = change.joints.size() - listed;
  if (listed == kJointsListed && rest > 0)
    out += std::string(lead.size(), ' ') + "and " +
           text::counted(rest, "more joint", "more joints") + " by smaller amounts\n";
  // Smaller changes would be written as 0.0.
  constexpr double kLeastLength = 5e-5, kLeastForce = 0.05;
  if (change.cog.size > kLeastLength)
    out += largest("  COG" + moved, change.cog, millimetres(change.cog.size)) + "\n";
  if (change.foot.size > kLeastLength)
    out += largest("  " + feet, change.foot, millimetres(change.foot.size)) + "\n";
  if (change.zmp.size > kLeastLength)
    out += largest("  commanded ZMP" + changed, change.zmp, millimetres(change.zmp.size)) + "\n";
  if (change.fz.size > kLeastForce)
    out += largest("  f_z" + changed, change.fz, text::fixed(change.fz.size, 1) + " N") + "\n";
  return out + "  ZMP " + margin_words(before.summary[FindingKind::support_margin]) + was + ", " +
         margin_words(after.summary[FindingKind::support_margin]) + is +
         "\n  distance of the COG from its command: " +
         millimetres(before.summary[FindingKind::cog_residual]) + was + ", " +
         millimetres(after.summary[FindingKind::cog_residual]) + is + "\n";
}

std::string cost_words(const WeightedChange& cost) {
  // Share of the change; a smaller one does not show in three digits.
  constexpr double kLeastShare = 1e-3;
  const std::string missing = cost.safety > kLeastShare * cost.change
                                  ? ", cost of missing safety " + text::brief(cost.safety)
                                  : "";
  return "  weighted change of base and joints " + text::brief(cost.change) + missing;
}

std::string origin_words(const std::map<std::string, std::string>& origin) {
  constexpr std::pair<const char*, const char*> kTracks[] = {
      {"joints", "joints"}, {"base", "base"}, {"feet", "feet"},
      {"torso", "torso"},   {"cog", "COG"},   {"cog_height", "COG height"},
      {"zmp", "ZMP"},       {"fz", "f_z"},    {"viip", "VIIP"}};
  std::string out = "  where each track comes from\n";
  for (const auto& [key, name] : kTracks) {
    const auto found = origin.find(key);
    if (found == origin.end()) continue;
    out += padded(std::string("    ") + name, kOriginHang) + found->second + "\n";
  }
  return out;
}

namespace {

// Whether the command differs from the motion itself.
bool disagrees(const SimulationLog& log) {
  return std::any_of(log.samples.begin(), log.samples.end(), [](const SimulationSample& s) {
    return (s.cog - s.command_cog).norm() > 5e-4 || (s.zmp - s.command_zmp).norm() > 3e-3 ||
           std::abs(s.fz - s.command_fz) > 1;
  });
}

}  // namespace

void plot_motions(const RobotModel& model, const CommandSeries& before, const CommandSeries& after,
                  const MotionPlot& plot, const std::filesystem::path& path) {
  constexpr double kAround = 0.4;  // [s] time that is drawn before and after the change
  // Share of the largest move; with a smaller one, two curves look like one.
  constexpr double kSeen = 0.03;
  const ActuatorLimits& actuators = model.limits(plot.profile);
  const SimulationLog a = plan_log(model, actuators, before, before);
  const SimulationLog b = plan_log(model, actuators, after, before);
  const MotionChange change = motion_change(model, before, after);
  LociOptions options;
  options.title = plot.title;
  options.model = &model;
  options.profile = plot.profile;
  options.command = disagrees(a);
  options.reference = false;
  options.only_differences = true;
  const Eigen::VectorXd& speed = model.limits(plot.profile).speed;
  double begin = change.compared, end = 0;
  for (const JointChange& joint : change.joints) {
    if (std::abs(joint.most) < kLeastMove) continue;
    begin = std::min(begin, joint.begin);
    end = std::max(end, joint.end);
    const int dof = model.find_dof(joint.joint);
    if (options.joints.size() < kJointsDrawn &&
        std::abs(joint.most) > kSeen * std::abs(change.joints.front().most))
      options.joints.push_back(dof);
    const bool fast = std::any_of(a.samples.begin(), a.samples.end(), [&](const auto& s) {
      return std::abs(s.state.dtheta[dof]) > speed[dof];
    });
    if (fast && options.speeds.size() < kSpeedsDrawn) options.speeds.push_back(dof);
  }
  if (end > begin) {
    options.begin = std::max(0.0, begin - kAround);
    options.end = end + kAround;
  }
  write_loci({{plot.before, &a}, {plot.after, &b}}, path, options);
}

}  // namespace ayumi::app
