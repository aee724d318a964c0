#include "sweep/case_runner.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/processor_time.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/io/pattern/assumed_study.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/task_file.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/sim/simulator.hpp"
#include "ayumi/study/push.hpp"
#include "pattern_input.hpp"
#include "repairing.hpp"
#include "simulation.hpp"
#include "uncertain_input.hpp"

namespace ayumi::app {

namespace fs = std::filesystem;

namespace {

/// Number of motions that are kept for the next cases. Chosen: more than the patterns that the
/// cases of many threads use at one time; a motion of 10 s takes about 30 MB.
constexpr size_t kKeptMotions = 6;

/// Number of laws that are kept for one motion. Chosen: more than the laws that the cases of many
/// threads use at one time.
constexpr size_t kKeptLaws = 16;

/// Largest number of cases that are tried before the first run to find one that can use the
/// uncertainty of the study. Chosen: each may sample a motion, which takes about 10 ms; with half,
/// fewer such cases are found.
constexpr long kMostTried = 20;

/// Adds to a counter the processor time that this thread uses while the object exists [ns].
struct TimeSpent {
  std::atomic<long>& counter;
  double begin = thread_seconds();
  ~TimeSpent() { counter += std::lround(1e9 * (thread_seconds() - begin)); }
};

/// Number of ticks between two questions whether a simulation may continue. Chosen: some
/// milliseconds of work.
constexpr long kTicksBetweenReports = 100;

Cell cell(double value) {
  if (!std::isfinite(value)) return {};
  return value == 0 ? 0.0 : value;  // there is no negative zero in the results
}

/// The settings that determine the motion and the robot.
std::string motion_key(const Settings& settings) {
  std::string key;
  for (const auto& [name, value] : settings)
    if (name == "pattern" || name == "robot" || name == "profile" || name.starts_with("set."))
      key += name + "\n" + setting_text(value) + "\n";
  return key;
}

/// The settings that determine the law and the sensors.
std::string law_key(const Settings& settings) {
  std::string key;
  for (const auto& [name, value] : settings)
    if (name == "controller" || name == "noise" || name == "true_state" || name == "substeps" ||
        name.starts_with("gain."))
      key += name + "\n" + setting_text(value) + "\n";
  return key;
}

/// The settings that determine law, ground and disturbances, but not the seed or the draw.
std::string loop_key(const Settings& settings) {
  std::string key;
  for (const auto& [name, value] : settings)
    if (name != "seed" && name != "draw") key += name + "\n" + setting_text(value) + "\n";
  return key;
}

}  // namespace

std::vector<ResultColumn> result_columns(const SweepMeasures& m) {
  std::vector<ResultColumn> columns = {{"outcome", "TEXT"},           {"fell_at_s", "REAL"},
                                       {"final_cog_error_m", "REAL"}, {"max_cog_error_m", "REAL"},
                                       {"max_foot_tilt_rad", "REAL"}, {"max_tilt_rad", "REAL"},
                                       {"severity", "REAL"}};
  const auto add = [&](std::initializer_list<ResultColumn> more) {
    columns.insert(columns.end(), more);
  };
  if (m.margins)
    add({{"max_torque_ratio", "REAL"},
         {"max_speed_ratio", "REAL"},
         {"zmp_tracking_rms_m", "REAL"},
         {"max_foot_slip_m", "REAL"},
         {"flight_s", "REAL"}});
  if (m.energy)
    add({{"servo_work_J", "REAL"},
         {"positive_work_J", "REAL"},
         {"push_work_J", "REAL"},
         {"distance_m", "REAL"},
         {"duration_s", "REAL"}});
  if (m.check) {
    add({{"consistent", "INTEGER"}, {"check_errors", "INTEGER"}, {"first_error", "TEXT"}});
    for (const FindingSpec* spec : summary_figures())
      columns.push_back({std::string("check_") + spec->figure.key, "REAL"});
  }
  if (m.repair)
    add({{"repair", "TEXT"},
         {"repair_joint_rad", "REAL"},
         {"repair_cog_m", "REAL"},
         {"repair_zmp_margin_m", "REAL"}});
  if (m.thresholds)
    add({{"push_worst_Ns", "REAL"}, {"push_worst_B", "REAL"}, {"push_mean_B", "REAL"}});
  return columns;
}

/// Stops a case if the user stops the work, or if the case has used its processor time.
struct CaseRunner::Watch {
  const Progress& progress;
  double limit;  ///< limit of the processor time [s]; 0 if there is none
  double begin = thread_seconds();
  std::string exceeded = {};  ///< the work at the moment when the time was used up

  bool go_on(const ProgressEvent& event) {
    if (limit > 0 && thread_seconds() - begin > limit) {
      exceeded = event.stage;
      return false;
    }
    return !progress || progress(event);
  }
  std::string reason() const {
    return "the stage '" + exceeded + "' did not end within " + text::brief(limit) +
           " s of processor time. A larger --case-limit allows more time";
  }
};

/// Data that the cases of one law share.
struct CaseRunner::Law {
  SimulateOptions options;  ///< options with ground and disturbances of the pattern
  Controller controller;    ///< the controller before its first tick
};

/// Data that the draws of one law, ground and scenario share.
struct CaseRunner::Draws {
  Draws(Study uncertain, const Task& motion, const SimulateOptions& options)
      : study(std::move(uncertain)),
        task(motion.robot, motion.series, study.uncertainty, options) {}
  Study study;
  UncertainTask task;
};

/// Results of check and repair for a motion on a ground with one friction coefficient.
struct CaseRunner::Judged {
  std::once_flag judged, repaired;
  std::vector<Cell> check, repair;
  std::optional<Error> repair_error;
};

/// A motion, its results, and its laws.
struct CaseRunner::Prepared {
  std::string key;
  std::once_flag once;
  std::shared_ptr<const Task> task;
  std::string error;
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const Law>> laws;
  std::map<std::string, std::shared_ptr<const Draws>> draws;

  /// The entry with this key, or a new one. Entries for values that differ in every case are not
  /// kept.
  template <typename Kept, typename Make>
  std::shared_ptr<const Kept> kept(std::map<std::string, std::shared_ptr<const Kept>>& all,
                                   const std::string& kept_key, const Make& make) {
    {
      const std::lock_guard lock(mutex);
      if (const auto known = all.find(kept_key); known != all.end()) return known->second;
    }
    const std::shared_ptr<const Kept> made = make();
    const std::lock_guard lock(mutex);
    if (all.size() >= kKeptLaws) all.clear();
    all[kept_key] = made;
    return made;
  }
  std::map<double, std::shared_ptr<Judged>> judged;  ///< results by the friction of the ground

  /// All cases with this friction share the result; only one of them judges.
  std::shared_ptr<Judged> judged_with(double friction) {
    const std::lock_guard lock(mutex);
    if (!judged.contains(friction) && judged.size() >= kKeptLaws) judged.clear();
    std::shared_ptr<Judged>& found = judged[friction];
    if (!found) found = std::make_shared<Judged>();
    return found;
  }
};

CaseRunner::~CaseRunner() = default;

fs::path CaseRunner::pattern_file(const std::string& word) const {
  const fs::path beside = study_->file().parent_path() / word;
  std::error_code ignored;
  return fs::path(word).is_absolute() || fs::exists(beside, ignored) ? beside : fs::path(word);
}

std::string CaseRunner::robot_name(const std::string& word) const {
  const fs::path beside = study_->file().parent_path() / word;
  std::error_code ignored;
  const bool path = word.find('/') != std::string::npos || fs::path(word).has_extension();
  return path && !fs::path(word).is_absolute() && fs::exists(beside, ignored) ? beside.string()
                                                                              : word;
}

std::string CaseRunner::robot_of_case(const Settings& settings, const Pattern& pattern) const {
  const std::string word = word_of(settings, "robot");
  return word.empty() ? robot_of(pattern) : robot_name(word);
}

CaseRunner::CaseRunner(const Context& context, const SweepStudy& study)
    : context_(&context), study_(&study), columns_(result_columns(study.measures())) {
  const double begin = thread_seconds();
  inputs_.push_back({"study", study.file().filename().string(), study.uncertainty().sha256});
  for (const std::string& word : study.words("pattern")) {
    Pattern pattern = read_given_pattern(pattern_file(word));
    inputs_.push_back({"pattern", word, pattern.sha256});
    patterns_.emplace(word, std::move(pattern));
  }
  const RobotSearch search = robot_search(context);
  const auto add_robot = [&](const std::string& shown, const std::string& name) {
    if (robots_.contains(name)) return;
    RobotModel robot = load_robot(name, search);
    inputs_.push_back({"robot", shown, robot.description().sha256});
    if (study.named().contains("draw") && study.uncertainty().uncertainty.empty()) {
      const fs::path standard = default_study(robot);
      const Study study_of_robot = standard.empty() ? assumed_study(robot) : read_study(standard);
      inputs_.push_back({"uncertainty", shown, study_of_robot.sha256});
    }
    robots_.emplace(name, std::move(robot));
  };
  for (const std::string& word : study.words("robot")) add_robot(word, robot_name(word));
  // For cases that do not set a robot, the pattern names it.
  const auto set = study.named().find("robot");
  if (set == study.named().end() || !set->second.pointer.starts_with("/sweep/settings"))
    for (const auto& [word, pattern] : patterns_) add_robot(pattern.robot, robot_of(pattern));
  refuse_unused();
  refuse_unusable_uncertainty();
  setup_seconds_ = thread_seconds() - begin;
}

void CaseRunner::refuse_unused() const {
  const auto refuse = [&](const std::string& pointer, const std::string& why) {
    fail(ErrorCode::bad_pattern, study_->file().string() + ": " + pointer + ": " + why);
  };
  for (const auto& [name, where] : study_->named()) {
    if (name.starts_with("set.")) {
      const std::string parameter = name.substr(4);
      std::set<std::string> declared;
      for (const auto& [word, pattern] : patterns_)
        for (const auto& [each, value] : pattern.parameters) declared.insert(each);
      if (!declared.contains(parameter))
        refuse(where.pointer, "no pattern of the study declares the parameter '" + parameter + "'" +
                                  text::suggestion(parameter, {declared.begin(), declared.end()}));
    } else if (name.starts_with("gain.")) {
      refuse_unused_gain(name, where.pointer);
    }
  }
  for (const std::string& profile : study_->words("profile")) {
    std::vector<std::string> known;
    for (const auto& [name, model] : robots_)
      for (const ActuatorProfile& limits : model.description().profiles)
        known.push_back(limits.name);
    if (std::find(known.begin(), known.end(), profile) == known.end())
      refuse(study_->named().at("profile").pointer, "no robot of the study has the profile '" +
                                                        profile + "'" +
                                                        text::suggestion(profile, known));
  }
}

/// A gain is used if it belongs to the law of some case.
void CaseRunner::refuse_unused_gain(const std::string& gain, const std::string& pointer) const {
  std::string why = "open loop has no gains, so nothing uses '" + gain + "'";
  std::set<std::pair<std::string, std::string>> tried;  // pairs of a law and a robot
  for (long i = 0; i < study_->size(); ++i) {
    const Settings settings = study_->settings(i);
    if (!settings.contains(gain) || !settings.contains("pattern")) continue;
    const Pattern& pattern = patterns_.at(word_of(settings, "pattern"));
    std::string law = word_of(settings, "controller");
    if (law.empty()) law = name_of(pattern.controller.type);
    const std::string robot = robot_of_case(settings, pattern);
    const auto model = robots_.find(robot);
    if (model == robots_.end() || !tried.emplace(law, robot).second) continue;
    try {
      ControllerSpec spec{controller_type(law), {}};
      if (spec.type == ControllerKind::none) continue;
      spec.gains.emplace_back(gain.substr(5), number_of(settings, gain, 0));
      check_controller(model->second, spec);
      return;
    } catch (const Error& error) {
      why = error.what();
    }
  }
  fail(ErrorCode::bad_pattern, study_->file().string() + ": " + pointer + ": " + why);
}

/// The uncertainty of the study is used if some case can draw from it.
void CaseRunner::refuse_unusable_uncertainty() const {
  if (!study_->named().contains("draw") || study_->uncertainty().uncertainty.empty()) return;
  std::optional<Error> why;
  std::set<std::pair<std::string, std::string>> tried;  // pairs of a pattern and a robot
  for (long i = 0, motions = 0; i < study_->size() && motions < kMostTried; ++i) {
    const Settings settings = study_->settings(i);
    const std::pair key(word_of(settings, "pattern"), word_of(settings, "robot"));
    if (!settings.contains("draw") || tried.contains(key)) continue;
    ++motions;
    try {
      const std::shared_ptr<Prepared> motion = prepared(settings);
      const std::shared_ptr<const Law> made = law(*motion, settings);
      tried.insert(key);
      draws(*motion, settings, made->options);
      return;
    } catch (const Error& error) {
      // If a motion cannot be made, its case is at fault.
      if (tried.contains(key) && !why) why = error;
    }
  }
  if (why) throw Error(*why);
}

std::shared_ptr<CaseRunner::Prepared> CaseRunner::prepared(const Settings& settings) const {
  const std::string key = motion_key(settings);
  std::shared_ptr<Prepared> found;
  {
    const std::lock_guard lock(mutex_);
    const auto known =
        std::find_if(recent_.begin(), recent_.end(), [&](const auto& p) { return p->key == key; });
    if (known != recent_.end()) {
      recent_.splice(recent_.begin(), recent_, known);
    } else {
      recent_.push_front(std::make_shared<Prepared>());
      recent_.front()->key = key;
      if (recent_.size() > kKeptMotions) recent_.pop_back();
    }
    found = recent_.front();
  }
  std::call_once(found->once, [&] {
    try {
      std::map<std::string, double> set;
      for (const auto& [name, value] : settings)
        if (name.starts_with("set.")) set[name.substr(4)] = std::get<double>(value);
      const std::string word = word_of(settings, "pattern");
      if (word.empty())
        fail(ErrorCode::bad_pattern, study_->file().string() +
                                         ": /sweep: this case has no setting 'pattern'. Name a "
                                         "pattern in the case or in /sweep/settings");
      Pattern pattern =
          set.empty() ? patterns_.at(word) : read_given_pattern(pattern_file(word), set);
      const std::string name = robot_of_case(settings, pattern);
      const auto model = robots_.find(name);
      Task task = load_task(
          std::move(pattern),
          {model != robots_.end() ? model->second : load_robot(name, robot_search(*context_)),
           name},
          word_of(settings, "profile"), {}, 1);
      found->task = std::make_shared<const Task>(std::move(task));
    } catch (const Error& error) {
      if (error.code() == ErrorCode::internal) throw;
      found->error = error.what();
    }
  });
  if (!found->task) fail(ErrorCode::bad_pattern, found->error);
  return found;
}

namespace {

/// The options for the law and the sensors of a case, with ground and disturbances of the pattern.
SimulateOptions law_options(const Context& context, const Task& task, const Settings& settings) {
  SimulationChoice choice;
  choice.controller = word_of(settings, "controller");
  choice.noise = number_of(settings, "noise", 0) != 0;
  choice.true_state = number_of(settings, "true_state", 0) != 0;
  choice.substeps = static_cast<int>(number_of(settings, "substeps", 1));
  // Open loop has no gains; in a product with other laws, the gains are for the other laws.
  if (chosen_controller(task, choice).type != ControllerKind::none)
    for (const auto& [name, value] : settings)
      if (name.starts_with("gain."))
        choice.gains.push_back(name.substr(5) + "=" + setting_text(value));
  return simulation_options(context, task, choice);
}

std::uint64_t seed_of(const Context& context, const Settings& settings) {
  return settings.contains("seed") ? static_cast<std::uint64_t>(number_of(settings, "seed", 1))
                                   : context.seed;
}

/// The figures of one simulation, in the order of result_columns().
std::vector<Cell> run_figures(const Task& task, const SimulateOptions& options,
                              const SweepMeasures& measures, const Progress& progress) {
  Simulator run(task.robot, task.series, options);
  run.keep_samples(false);
  double positive = 0, first = 0;
  Eigen::Vector2d start = Eigen::Vector2d::Zero();
  while (run.advance(1) && !run.fell()) {
    if (run.tick() % kTicksBetweenReports == 0) report(progress, {"simulating", -1, ""});
    if (!measures.energy) continue;
    const SimulationSample& s = run.last_sample();
    if (run.tick() == 1) start = s.cog.head<2>();
    positive += s.torque.cwiseProduct(s.state.dtheta).cwiseMax(0.0).sum() * task.series.dt;
    first = 1;
  }
  const SimulationResult r = run.result();
  const LargestErrors& largest = run.largest_errors();
  const CaseResult kept = {.outcome = r.outcome,
                           .fell_at = r.fell_at,
                           .cog_error = largest.cog,
                           .torque = r.torque.ratio,
                           .foot_tilt = largest.foot_tilt};
  std::vector<Cell> cells = {std::string(name_of(r.outcome)),
                             r.fell_at >= 0 ? cell(r.fell_at) : Cell(),
                             cell(r.final_cog_error),
                             cell(largest.cog),
                             cell(largest.foot_tilt),
                             cell(r.max_tilt),
                             cell(severity(kept))};
  const auto add = [&](std::initializer_list<double> more) {
    for (const double value : more) cells.push_back(cell(value));
  };
  if (measures.margins)
    add({r.torque.ratio, r.speed.ratio, r.zmp_tracking_rms, r.max_slip, r.flight});
  if (measures.energy) {
    const SimulationSample& last = run.last_sample();
    const double distance = first > 0 ? (last.cog.head<2>() - start).norm() : 0;
    add({last.work.servos, positive, last.work.outside, distance,
         double(run.tick()) * task.series.dt});
  }
  return cells;
}

std::vector<Cell> check_figures(const Task& task, const CheckOptions& options) {
  const Judgement judged = judge(task, options);
  double errors = 0;
  std::string first;
  for (const Finding& finding : judged.report.findings) {
    if (finding.severity != Severity::error) continue;
    if (errors++ == 0) first = name_of(finding.kind);
  }
  std::vector<Cell> cells = {judged.good() ? 1.0 : 0.0, errors,
                             first.empty() ? Cell() : Cell(first)};
  for (const FindingSpec* spec : summary_figures())
    cells.push_back(cell(judged.report.summary[spec->kind]));
  return cells;
}

std::vector<Cell> repair_figures(const Task& task, const CheckOptions& check,
                                 const Progress& progress) {
  RepairOptions options = preferred_options(task.pattern);
  options.check = check;
  const RepairResult r = repair_task(task, options, progress);
  return {std::string(name_of(r.status)), cell(r.max_joint_change), cell(r.max_cog_change),
          cell(r.check.summary[FindingKind::support_margin])};
}

std::vector<Cell> threshold_figures(const Task& task, const SimulateOptions& simulate,
                                    const SweepThresholds& asked, const Progress& progress) {
  PushOptions push;
  push.directions = asked.directions;
  push.replicas = asked.replicas;
  push.step = asked.step;
  push.cap = asked.cap;
  push.duration = asked.duration;
  push.threads = 1;
  push.simulate = simulate;
  push.simulate.scenario.clear();
  if (simulate.controller.type != ControllerKind::none) push.controllers = {simulate.controller};
  for (const double t : asked.times)
    push.phases.push_back({"t = " + text::fixed(t, 3) + " s", t, false});
  double worst_impulse = 0, worst = 0, sum = 0;
  size_t count = 0;
  for (const PushCase& each : push_limits(task.robot, task.series, push, {}, {}, progress)) {
    const double impulse =
        each.limits.empty() ? each.open_loop.impulse : each.limits.front().impulse;
    const double share = each.bound > 0 ? impulse / each.bound : 0;
    worst_impulse = count ? std::min(worst_impulse, impulse) : impulse;
    worst = count ? std::min(worst, share) : share;
    sum += share;
    ++count;
  }
  return {cell(worst_impulse), cell(worst), cell(count ? sum / double(count) : 0)};
}

}  // namespace

std::shared_ptr<const CaseRunner::Law> CaseRunner::law(Prepared& motion,
                                                       const Settings& settings) const {
  return motion.kept(motion.laws, law_key(settings), [&] {
    const Task& task = *motion.task;
    SimulateOptions options = law_options(*context_, task, settings);
    Controller controller(task.robot, task.robot.limits(options.profile), task.series,
                          options.controller);
    return std::make_shared<const Law>(Law{std::move(options), std::move(controller)});
  });
}

/// The law, ground, scenario, seed and drawn robot of a case.
struct CaseRunner::OneCase {
  std::shared_ptr<Prepared> motion;
  std::shared_ptr<const Law> law;
  std::shared_ptr<const Draws> draws;
  std::optional<RobotUnit> unit;
  SimulateOptions options;
};

std::shared_ptr<const CaseRunner::Draws> CaseRunner::draws(Prepared& motion,
                                                           const Settings& settings,
                                                           const SimulateOptions& options) const {
  return motion.kept(motion.draws, loop_key(settings), [&] {
    const Task& task = *motion.task;
    return std::make_shared<const Draws>(
        study_->uncertainty().uncertainty.empty() ? load_study(task, "") : study_->uncertainty(),
        task, options);
  });
}

void CaseRunner::make_case(long number, const Settings& settings, OneCase& made) const {
  made.motion = prepared(settings);
  made.law = law(*made.motion, settings);
  made.options = made.law->options;
  if (auto world = study_->world(settings)) made.options.world = std::move(*world);
  if (auto scenario = study_->disturbances(settings)) made.options.scenario = std::move(*scenario);
  made.options.seed = seed_of(*context_, settings);
  if (settings.contains("draw")) {
    made.draws = draws(*made.motion, settings, made.options);
    const UncertainTask& uncertain = made.draws->task;
    const CaseNumbers numbers =
        uncertain.numbers(made.options.seed, static_cast<long>(number_of(settings, "draw", 0)));
    const std::vector<double> values = uncertain.draw(numbers);
    uncertain.check(values, "case " + std::to_string(number));
    made.unit = uncertain.unit(values);
    made.options = uncertain.options(numbers, values);
    made.options.unit = &*made.unit;
  }
  made.options.prepared = &made.law->controller;
}

std::vector<Cell> CaseRunner::figures(long number, const Settings& settings, Watch& watch) const {
  const Progress progress = [&](const ProgressEvent& event) { return watch.go_on(event); };
  const SweepMeasures& measures = study_->measures();
  std::vector<Cell> cells(columns_.size());
  const auto place = [&](const std::string& first, const std::vector<Cell>& more) {
    const auto at = std::find_if(columns_.begin(), columns_.end(),
                                 [&](const ResultColumn& c) { return c.name == first; });
    std::copy(more.begin(), more.end(), cells.begin() + (at - columns_.begin()));
  };
  const bool runs = measures.verdict || measures.margins || measures.energy;
  std::shared_ptr<Prepared> motion;
  if (runs || measures.thresholds) {
    OneCase made;
    make_case(number, settings, made);
    motion = made.motion;
    const TimeSpent useful{useful_};
    if (runs) place("outcome", run_figures(*motion->task, made.options, measures, progress));
    if (measures.thresholds) {
      made.options.prepared = nullptr;  // open loop is another law
      place("push_worst_Ns",
            threshold_figures(*motion->task, made.options, study_->thresholds(), progress));
    }
  } else {
    motion = prepared(settings);
  }
  const TimeSpent useful{useful_};
  if (!measures.check && !measures.repair) return cells;
  CheckOptions check = check_options(*motion->task);
  if (const auto world = study_->world(settings)) check.friction = world->friction;
  const std::shared_ptr<Judged> judged = motion->judged_with(check.friction);
  if (measures.check) {
    std::call_once(judged->judged, [&] { judged->check = check_figures(*motion->task, check); });
    place("consistent", judged->check);
  }
  if (measures.repair) {
    std::call_once(judged->repaired, [&] {
      try {
        judged->repair = repair_figures(*motion->task, check, progress);
      } catch (const Error& error) {  // the error also holds for the other cases of this motion
        judged->repair_error = error;
      } catch (const Interrupted&) {
        if (watch.exceeded.empty()) throw;
        judged->repair_error = Error(ErrorCode::bad_pattern, watch.reason());
      }
    });
    if (judged->repair_error) throw Error(*judged->repair_error);
    place("repair", judged->repair);
  }
  return cells;
}

CaseRow CaseRunner::run(long number, const Progress& progress) const {
  const TimeSpent all{nanoseconds_};
  Watch watch{progress, case_seconds_};
  const Settings settings = study_->settings(number);
  CaseRow row;
  row.number = number;
  for (const std::string& name : study_->axes()) {
    const auto found = settings.find(name);
    if (found == settings.end())
      row.axes.emplace_back();
    else if (const auto* const word = std::get_if<std::string>(&found->second))
      row.axes.emplace_back(*word);
    else
      row.axes.push_back(cell(std::get<double>(found->second)));
  }
  try {
    row.figures = figures(number, settings, watch);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) throw;
    row.error = error.what();
  } catch (const Interrupted&) {
    if (watch.exceeded.empty()) throw;
    row.error = watch.reason();
  } catch (const std::bad_alloc&) {
    row.error = "there was not enough memory. Use fewer threads or a machine with more memory";
  }
  row.figures.resize(columns_.size());
  return row;
}

RobotModel CaseRunner::robot_to_draw(long number) const {
  const Settings settings = study_->settings(number);
  const Pattern& pattern = patterns_.at(word_of(settings, "pattern"));
  return load_robot(robot_of_case(settings, pattern), robot_search(*context_), {.meshes = true});
}

SimulationLog CaseRunner::simulate(long number, std::shared_ptr<const Task>& task) const {
  OneCase made;
  make_case(number, study_->settings(number), made);
  task = made.motion->task;
  return ayumi::simulate(*task, made.options, {}, "");
}

}  // namespace ayumi::app
