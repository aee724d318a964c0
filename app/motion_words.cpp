#include "motion_words.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/pattern/differentiate.hpp"
#include "ayumi/preview/loci.hpp"

namespace ayumi::app {

namespace {

constexpr size_t kJointsTold = 8;

std::string mm(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }
std::string seconds(double t) { return text::fixed(t, 3) + " s"; }

std::string joint_words(const RobotModel& model, const JointChange& j) {
  const bool slides = model.dofs()[model.find_dof(j.joint)].prismatic;
  const std::string sign = j.most > 0 ? "+" : "";
  return j.joint + " by " + sign +
         (slides ? mm(j.most) : text::fixed(j.most * 180 / EIGEN_PI, 2) + " deg") + " at " +
         seconds(j.at) + " (" + text::fixed(j.begin, 2) + "-" + text::fixed(j.end, 2) + " s)";
}

std::string largest(const std::string& what, const LargestChange& change,
                    const std::string& amount) {
  return what + " by up to " + amount + " at " + seconds(change.at);
}

// A plan as a log: what the full model says of the motion, and what is commanded beside it.
SimulationLog plan_log(const RobotModel& model, const CommandSeries& motion,
                       const CommandSeries& command, const std::string& title) {
  SimulationLog log;
  log.dt = motion.dt;
  log.provenance.pattern = title;
  RobotData data(model);
  for (size_t k = 0; k < motion.samples.size(); ++k) {
    const CommandSample& s = motion.samples[k];
    const CommandSample& c = command.samples[std::min(k, command.samples.size() - 1)];
    SimulationSample sample;
    const GroundReaction full = full_model_reaction(model, s, data);
    sample.state = s.state;
    sample.cog = data.cog;
    sample.zmp = full.zmp;
    sample.fz = full.force.z();
    sample.command_cog = c.cog;
    sample.command_zmp = sample.reference_zmp = c.zmp;
    sample.command_fz = c.fz;
    sample.planned_contact = {supports(s.support, Side::left), supports(s.support, Side::right)};
    log.samples.push_back(std::move(sample));
  }
  return log;
}

}  // namespace

std::string motion_words(const RobotModel& model, const MotionChange& change,
                         const ConsistencyReport& before, const ConsistencyReport& after) {
  std::string out;
  if (change.joints.empty()) out += "  no joint moved\n";
  for (size_t i = 0; i < std::min(kJointsTold, change.joints.size()); ++i)
    out += (i == 0 ? "  moved " : "        ") + joint_words(model, change.joints[i]) + "\n";
  if (change.joints.size() > kJointsTold)
    out += "        and " + std::to_string(change.joints.size() - kJointsTold) + " joints less\n";
  if (change.cog.size > 1e-6)
    out += "  " + largest("COG", change.cog, mm(change.cog.size)) + "; " +
           largest("a foot", change.foot, mm(change.foot.size)) + "\n";
  if (change.zmp.size > 1e-6 || change.fz.size > 1e-3)
    out += "  " + largest("commanded ZMP", change.zmp, mm(change.zmp.size)) + "; " +
           largest("f_z", change.fz, text::fixed(change.fz.size, 1) + " N") + "\n";
  return out + "  ZMP " + mm(before.summary.min_zmp_margin) + " inside the support before, " +
         mm(after.summary.min_zmp_margin) + " after; COG off its command by " +
         mm(before.summary.max_cog_residual) + " before, " + mm(after.summary.max_cog_residual) +
         " after\n";
}

std::string cost_words(const WeightedChange& cost) {
  constexpr double kTold = 1e-3;  // of the change; less is rounding
  const std::string missing =
      cost.safety > kTold * cost.change
          ? " and " + text::brief(cost.safety) + " for the safety that is missing"
          : "";
  return "  weighted change " + text::brief(cost.change) + missing;
}

void plot_motions(const RobotModel& model, const CommandSeries& before, const CommandSeries& after,
                  const std::string& title, const std::filesystem::path& path) {
  const SimulationLog a = plan_log(model, before, before, title);
  const SimulationLog b = plan_log(model, after, before, title);
  LociOptions options;
  options.title = title;
  options.model = &model;
  write_loci({{"before", &a}, {"after", &b}}, path, options);
}

}  // namespace ayumi::app
