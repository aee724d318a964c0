#include "ayumi/task/task.hpp"

#include <algorithm>
#include <optional>

#include "ayumi/base/error.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/likely_mistakes.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/motion/shown_name.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/task/payload_findings.hpp"

namespace ayumi {

namespace {

void refuse_unknown_places(const Pattern& pattern, const RobotModel& robot) {
  std::vector<std::string> links = {"cog"};
  for (const Link& link : robot.links()) links.push_back(link.name);
  const std::vector<std::string> joints = robot.dof_names();
  for (size_t i = 0; i < pattern.scenario.size(); ++i) {
    const Disturbance& d = pattern.scenario[i];
    const SourcePlace place = {pattern.file, "/scenario/" + std::to_string(i)};
    const bool push = std::holds_alternative<Push>(d.what);
    const auto refuse_link = [&](const std::string& name) {
      if (std::find(links.begin(), links.end(), name) == links.end())
        fail_unknown_name(place + "/on",
                          robot.name() + " has no link '" + name + "'" +
                              (push ? " (with 'cog', a push acts at the centre of gravity)"
                                    : " (`ayumi inspect ROBOT --json` lists the links)") +
                              text::suggestion(name, links));
    };
    const auto refuse_joint = [&](const std::string& name) {
      if (!name.empty() && std::find(joints.begin(), joints.end(), name) == joints.end())
        fail_unknown_name(place + "/joint", robot.name() + " has no joint '" + name + "'" +
                                                text::suggestion(name, joints));
    };
    std::visit(
        [&](const auto& what) {
          if constexpr (requires { what.on; }) refuse_link(what.on);
          if constexpr (requires { what.joint; }) refuse_joint(what.joint);
        },
        d.what);
  }
}

// The pattern names the profile, so the place of the error is in the pattern.
void refuse_unknown_profile(const Pattern& pattern, const RobotModel& robot) {
  const std::vector<std::string> names = robot.profile_names();
  if (pattern.profile.empty() ||
      std::find(names.begin(), names.end(), pattern.profile) != names.end())
    return;
  fail_unknown_name({pattern.file, "/profile"},
                    "the robot '" + robot.name() + "' has no actuator profile '" +
                        text::quotable(pattern.profile) + "'; known: " + text::join(names, ", ") +
                        text::suggestion(pattern.profile, names));
}

// A wrong name in a call is wrong use of the library; in a file, it is bad input.
template <class Check>
void with_place(const SourcePlace& place, const Check& check) {
  try {
    check();
  } catch (const Error& error) {
    fail_unknown_name(place, error.what());
  }
}

void refuse_unknown_gains(const Pattern& pattern, const RobotModel& robot) {
  with_place({robot.description().sidecar_file, "/control"},
             [&] { check_controller(robot, {.type = pattern.controller.type, .gains = {}}); });
  with_place({pattern.file, "/controller"}, [&] { check_controller(robot, pattern.controller); });
  with_place({pattern.file, "/tolerances"}, [&] {
    CheckOptions options;
    options.tolerances = pattern.tolerances;
    tolerances(options);
  });
}

CheckOptions options_of(const Pattern& pattern, const std::string& profile, int threads) {
  CheckOptions options;
  options.profile = profile;
  options.friction = pattern.world.friction;
  options.tolerances = pattern.tolerances;
  options.threads = threads;
  options.degrees = pattern.degrees;
  return options;
}

// A motion whose times are in ms would be sampled for a minute before anything is said about it. No
// robot swings a foot for so long, so such a pattern is refused if it is consistent with times in
// ms. A motion without swings may be meant to last long; then this only reports the doubt.
void refuse_times_in_ms(const Pattern& pattern, const RobotModel& robot, const std::string& profile,
                        const Progress& progress, int threads) {
  const std::optional<Mistake> mistake =
      times_in_ms(robot, pattern, options_of(pattern, profile, threads));
  if (!mistake) return;
  const bool swings = !mistake->place.empty();
  if (swings && !mistake->explains_all) return;  // a slow swing, or another mistake beside this one
  if (swings) {
    SourcePlace place = in_file(pattern, mistake->place);
    place.names_value = place.names_remedy = true;
    fail(ErrorCode::bad_pattern, place, mistake->words);
  }
  report(progress, {"caution", 1, mistake->text()});
}

}  // namespace

CommandSeries sample_at_servo_period(const RobotModel& robot, const Pattern& pattern,
                                     const Progress& progress, int threads) {
  return sample(robot, pattern, {.dt = robot.description().servo_period, .threads = threads},
                progress);
}

Task make_task(Pattern pattern, RobotModel robot, const std::string& profile,
               const Progress& progress, int threads) {
  refuse_unknown_places(pattern, robot);
  refuse_unknown_gains(pattern, robot);
  if (profile.empty()) refuse_unknown_profile(pattern, robot);
  const std::string name = robot.limits(profile.empty() ? pattern.profile : profile).name;
  const double tick = robot.description().servo_period;
  refuse_times_in_ms(pattern, robot, name, progress, threads);
  CommandSeries series = [&] {
    try {
      return sample_at_servo_period(robot, pattern, progress, threads);
    } catch (const Error& error) {
      const bool says_all = error.place().unknown_name || error.place().names_value;
      if (error.code() != ErrorCode::bad_pattern || says_all) throw;
      throw with_mistakes(error, pattern, impossible_values(robot, pattern));
    }
  }();
  std::string robot_name = robot.name();
  return {.pattern = std::move(pattern),
          .robot = std::move(robot),
          .robot_name = std::move(robot_name),
          .profile = name,
          .tick = tick,
          .series = std::move(series),
          .threads = threads};
}

CheckOptions check_options(const Task& task) {
  return options_of(task.pattern, task.profile, task.threads);
}

SimulateOptions simulate_options(const Task& task) {
  SimulateOptions options;
  options.controller = task.pattern.controller;
  options.profile = task.profile;
  options.world = task.pattern.world;
  options.scenario = task.pattern.scenario;
  return options;
}

SafetyOptions safety_options(const Task& task) {
  SafetyOptions options;
  options.profile = task.profile;
  return options;
}

Provenance provenance(const Task& task, const std::string& controller,
                      const std::string& command_line) {
  return {.robot = task.robot_name,
          .robot_sha256 = task.robot.description().sha256,
          .pattern = shown_name(task.pattern),
          .pattern_sha256 = task.pattern.sha256,
          .profile = task.profile,
          .controller = controller,
          .command_line = command_line};
}

namespace {

Judgement judge(const Task& task, const CheckOptions& options, std::vector<Mistake>* payloads,
                const SampleObserver& observe) {
  Judgement judgement =
      judge(task.robot, task.series, keyed_goals(task.robot, task.series, task.pattern.controller),
            options, observe);
  std::vector<Mistake> heavy = judge_payloads(task, options, judgement.report);
  if (!heavy.empty()) judgement.motion_consistent = false;
  if (payloads) *payloads = std::move(heavy);
  return judgement;
}

}  // namespace

Judgement judge(const Task& task, const CheckOptions& options, std::vector<Mistake>* payloads) {
  return judge(task, options, payloads, {});
}

Judgement judge(const Task& task, const CheckOptions& options, const SampleObserver& observe) {
  return judge(task, options, nullptr, observe);
}

Judgement judge(const Task& task) { return judge(task, check_options(task)); }

SimulationLog simulate(const Task& task, const SimulateOptions& options, const Progress& progress,
                       const std::string& command_line) {
  SimulationLog log = simulate(task.robot, task.series, options, progress);
  log.provenance = provenance(task, name_of(options.controller.type), command_line);
  return log;
}

std::vector<std::string> unfit_reasons(const std::string& inconsistent, const SimulationLog& log,
                                       const SimulationLog* undisturbed) {
  std::vector<std::string> reasons;
  const auto add = [&](const std::string& run, const std::string& reason) {
    if (!reason.empty()) reasons.push_back(run + reason);
  };
  add("", inconsistent);
  add(undisturbed ? "under its disturbances " : "", unfit_words(log));
  if (undisturbed) add("without disturbances ", unfit_words(*undisturbed));
  return reasons;
}

std::vector<std::string> unfit_reasons(const Judgement& judgement, const SimulationLog& log) {
  return unfit_reasons(judgement.reason(), log);
}

std::string refusal_of_goals() {
  return "the pattern has VIIP goals, so its joint angles are known only after a simulation. Run "
         "the pattern with `ayumi run`, and then export the folder of this run";
}

std::string refusal_of_disturbances(const std::string& disturbances) {
  return "the table is from a run with disturbances (" + disturbances +
         "), so it contains the reactions of the robot to them. --pushed exports this table "
         "nevertheless";
}

std::vector<std::string> export_refusals(const Task& task, const Judgement& judgement) {
  std::vector<std::string> reasons;
  if (!task.caution.unfit.empty()) reasons.push_back(task.caution.unfit);
  if (!judgement.good()) reasons.push_back(judgement.reason());
  if (!task.series.viip.empty()) reasons.push_back(refusal_of_goals());
  if (!task.caution.disturbances.empty())
    reasons.push_back(refusal_of_disturbances(task.caution.disturbances));
  return reasons;
}

}  // namespace ayumi
