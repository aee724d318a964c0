#include "gaits/gait_maker.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "ayumi/author/edit/gait_cycle.hpp"
#include "ayumi/author/generate/walk_in_parts.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/controller.hpp"
#include "ayumi/io/formats/npz_motion.hpp"
#include "ayumi/io/formats/table_motion.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/simulator.hpp"
#include "ayumi/task/servo_table.hpp"
#include "certify_results.hpp"
#include "loop_words.hpp"
#include "repairing.hpp"
#include "simulation.hpp"
#include "uncertain_input.hpp"

namespace ayumi::app {

using Json = nlohmann::ordered_json;

namespace {

/// Share of a disturbance of the pendulum that is left when it counts as decayed. Chosen: if a COG
/// is displaced by 15 mm, 1.5 um are left, far below the gap that a loop may have. With half or
/// twice this share, walks have the same number of steps, or one more.
constexpr double kForgotten = 1e-4;
/// Number of decimals of footholds [m, rad]. Chosen: with 4, as in new patterns, the steps of a
/// walk that turns differ by 0.05 mm and the posture by 0.02 degrees, more than a loop may have;
/// with 7, they differ by less than the accuracy of the solver.
constexpr int kDecimals = 7;
/// COG heights that are tried, as multiples of the height in new walks. Chosen: the same as for a
/// single walk that does not pass; above them the knees bend too little, and below them too much.
constexpr double kHeights[] = {1, 0.97, 1.02, 0.94, 0.91};

bool is_of_the_walk(const Error& error) {
  return error.code() == ErrorCode::bad_pattern || error.code() == ErrorCode::usage;
}

std::string share_words(double share) { return text::brief(100 * share, 3) + " %"; }

/// The reason why a walk of the library is missing; it is thrown where it is found.
struct Missing {
  std::string stage;  ///< stage: "generate", "repair", "loop", "simulate", "certify"
  std::string reason;
};

/// The entry `head` with the members that `work` adds to it; `work` may throw Missing.
template <typename Work>
GaitResult gait_result(Json head, const Work& work) {
  GaitResult result;
  result.json = std::move(head);
  result.json.update(Json{{"status", "missing"}, {"stage", nullptr}, {"reason", nullptr}});
  try {
    work(result);
  } catch (const Missing& missing) {
    result.json["stage"] = missing.stage;
    result.json["reason"] = missing.reason;
  }
  return result;
}

/// The result of `generate`. An error about the walk itself becomes the reason why the walk is
/// missing.
template <typename Generate>
auto generated(const Generate& generate) {
  try {
    return generate();
  } catch (const Error& error) {
    if (!is_of_the_walk(error)) throw;
    throw Missing{"generate", error.what()};
  }
}

}  // namespace

/// A walk that passes the check.
struct GaitMaker::Made {
  Task task;
  ConsistencyReport report = {};
  double moved = 0;  ///< largest change of a joint by a repair [rad]
  bool repaired = false;
};

void GaitMaker::add_figures(const Made& walk, Json& json) {
  const auto& summary = walk.report.summary;
  json.update(Json{{"zmp_margin_m", summary[FindingKind::support_margin]},
                   {"joint_speed_ratio", summary[FindingKind::joint_speed]},
                   {"joint_torque_ratio", summary[FindingKind::joint_torque]}});
  json["repaired"] = walk.repaired;
  if (walk.repaired) json["repair_max_joint_rad"] = walk.moved;
}

GaitMaker::GaitMaker(RobotModel model, const GaitOptions& options)
    : model_(std::move(model)), options_(options) {
  if (!model_.has_soles())
    fail(ErrorCode::bad_model, model_.name() +
                                   ": the robot has no soles, so it cannot walk. Describe "
                                   "the soles under \"soles\" in the sidecar");
  profile_ = model_.limits(options_.profile).name;
  controller_ = Pattern().controller;
  if (!options_.controller.empty()) controller_ = {controller_type(options_.controller), {}};
  check_controller(model_, controller_);
  if (!options_.certify) return;
  Task still = make_task(stand_pattern(model_, 0.1, options_.cog_height), model_, profile_, {}, 1);
  study_ = load_study(still, options_.study_file);
  // If the study names parts that this robot does not have, it is refused before the first walk.
  still.pattern.controller = controller_;
  const UncertainTask refuses(still.robot, still.series, study_.uncertainty,
                              simulate_options(still));
}

double GaitMaker::height() const {
  return options_.cog_height > 0 ? options_.cog_height : starting_height(model_);
}

double GaitMaker::best_height(const std::vector<GaitCell>& cells, int threads,
                              const Progress& progress) const {
  double best = 0;
  size_t most = 0;
  for (const double share : kHeights) {
    const double height = share == 1 ? 0 : 1e-3 * std::round(1e3 * share * starting_height(model_));
    std::vector<char> passes(cells.size(), 0);
    std::atomic<bool> stop = false;
    std::mutex mutex;
    in_parallel(cells.size(), threads, stop, [&](size_t i) {
      const int begin = lead(cells[i].period);
      WalkParameters w = walk(cells[i], begin + 1 + memory(cells[i].period));
      w.cog_height = height;
      try {
        Pattern pattern = walk_in_parts(model_, {w}, kDecimals);
        pattern.file.clear();
        passes[i] = judge(make_task(std::move(pattern), model_, profile_, {}, 1)).good();
      } catch (const Error& error) {
        if (!is_of_the_walk(error)) throw;
      }
      const std::lock_guard lock(mutex);
      report(progress, {"choosing the COG height", -1, ""});
    });
    const auto count = static_cast<size_t>(std::count(passes.begin(), passes.end(), 1));
    if (count > most) {
      most = count;
      best = height;
    }
    if (count == cells.size()) break;
  }
  return best;
}

int GaitMaker::memory(double period) const {
  const double omega = std::sqrt(kGravity / height());
  return std::max(2, static_cast<int>(std::ceil(-elementary::log(kForgotten) / (omega * period))));
}

int GaitMaker::lead(double period) const { return (memory(period) + 1) / 2 * 2; }

WalkParameters GaitMaker::walk(const GaitCell& cell, int steps) const {
  WalkParameters w = walk_defaults(model_);
  w.steps = steps;
  w.period = cell.period;
  w.stride = cell.forward * cell.period;
  w.side = 2 * cell.sideways * cell.period;  // only every second step moves sideways
  w.turn = cell.turn * cell.period;
  w.cog_height = options_.cog_height;
  return w;
}

GaitMaker::Made GaitMaker::made(Pattern pattern, const Progress& progress) const {
  pattern.robot = options_.robot;
  pattern.profile = options_.profile;
  pattern.controller = controller_;
  pattern.file.clear();
  Made result{.task = generated(
                  [&] { return make_task(std::move(pattern), model_, profile_, progress, 1); })};
  Task& task = result.task;
  const Judgement judged = judge(task);
  result.report = judged.report;
  if (judged.good()) return result;
  RepairOptions wishes = preferred_options(task.pattern);
  wishes.check = check_options(task);
  const RepairResult repaired = repair_task(task, wishes, progress);
  if (repaired.status != RepairStatus::repaired) {
    std::string reason = judged.reason() + ". No repair was found";
    if (!repaired.reasons.empty()) reason += ", because " + repaired.reasons.front();
    throw Missing{"repair", reason};
  }
  task.pattern.correction = repaired.correction;
  task.series = repaired.series;
  result.report = repaired.check;
  result.repaired = true;
  result.moved = repaired.max_joint_change;
  return result;
}

void GaitMaker::simulate(const Task& task, Json& json, const Progress& progress) const {
  const SimulateOptions options = simulate_options(task);
  Simulator run(task.robot, task.series, options);
  run.keep_samples(false);
  while (run.advance(1000, progress) && !run.fell()) {
  }
  const SimulationResult r = run.result();
  json["simulation"] = {{"outcome", name_of(r.outcome)},
                        {"max_cog_error_m", run.largest_errors().cog},
                        {"max_torque_ratio", r.torque.ratio}};
  if (r.outcome != Outcome::stands)
    throw Missing{"simulate",
                  std::string("the simulated robot ") +
                      (r.outcome == Outcome::fell ? "falls at " + text::fixed(r.fell_at, 2) + " s"
                                                  : "does not come to rest")};
}

namespace {

/// The rows of the table from `first` on, `count` of them.
ReferenceTrajectory rows_of(const ReferenceTrajectory& table, size_t first, size_t count) {
  ReferenceTrajectory part = table;
  part.rows.assign(table.rows.begin() + static_cast<long>(first),
                   table.rows.begin() + static_cast<long>(first + count));
  return part;
}

}  // namespace

void GaitMaker::make(const GaitCell& cell, GaitResult& result, const Progress& progress) const {
  Json& json = result.json;
  const int begin = lead(cell.period);
  Made walked = made(generated([&] {
                       Pattern pattern = walk_in_parts(
                           model_, {walk(cell, begin + 1 + memory(cell.period))}, kDecimals);
                       pattern.name = cell.name;
                       return pattern;
                     }),
                     progress);
  Task& task = walked.task;
  add_figures(walked, json);

  const MotionPart motion{task.pattern, task.series};
  const LoopGap whole = loop_gap(model_, motion);
  const GaitCycle cycle = gait_cycle(model_, motion, begin);
  const LoopGap& open = whole.closed ? cycle.gap : whole;
  if (!open.closed)
    throw Missing{"loop",
                  std::string("the end of the ") + (whole.closed ? "cycle" : "walk") +
                      " does not meet its beginning. The differences are: " + gap_and_limits(open)};

  simulate(task, json, progress);
  json["certificate"] = nullptr;
  if (options_.certify) {
    CertifyOptions study = options_.study;
    study.threads = 1;
    const UncertainTask uncertain(task.robot, task.series, study_.uncertainty,
                                  simulate_options(task));
    const KnownResults cases = run_cases(uncertain, study, {}, {}, progress);
    const Certificate found = certificate(study, cases);
    json["certificate"] = certificate_json(found, study);
    if (!found.outcome.certified)
      throw Missing{"certify", std::to_string(found.outcome.failures) + " of " +
                                   std::to_string(found.outcome.runs) +
                                   " runs failed. The robot fails with a probability of at least " +
                                   share_words(found.lower) + " and at most " +
                                   share_words(found.upper)};
  }
  json["status"] = options_.certify ? "certified" : "stands";

  const std::string text = pattern_text(task.pattern, {"A walk of a library: " + cell.name +
                                                       " (mm/s forward, mm/s to the left, deg/s, "
                                                       "ms for each step)."});
  task.pattern.sha256 = sha256(text);
  const std::string pattern = "patterns/" + cell.name + ".json";
  result.files.emplace_back(pattern, text);

  // Rows of the walk, and rows of the cycle. The rate of the cycle is the nearest one with a whole
  // number of rows.
  const double length = static_cast<double>(cycle.end - cycle.begin) * task.series.dt;
  ReferenceTrajectory table = table_of_series(model_, profile_, task.series, ServoContent::ideal);
  table.provenance = provenance(task, "none");
  const ReferenceTrajectory rows = resampled(table, 1 / options_.rate);
  const double count = std::max(2.0, std::round(length * options_.rate)), step = length / count;
  const ReferenceTrajectory fine = resampled(table, step);
  const auto first =
      static_cast<size_t>(std::ceil(static_cast<double>(cycle.begin) * task.series.dt / step));
  const auto number = static_cast<size_t>(count);
  const auto add = [&](const std::string& folder, const ReferenceTrajectory& part,
                       const std::string& npz) {
    const std::string path = folder + "/" + cell.name;
    result.files.emplace_back(path + ".csv", reference_csv(part));
    result.files.emplace_back(path + ".npz", npz);
    return Json{{"table", path + ".csv"},
                {"npz", path + ".npz"},
                {"rows", part.rows.size()},
                {"fps", 1 / part.dt}};
  };
  const MotionFile around = motion_of_table(rows_of(fine, first - 1, number + 2));
  json["pattern"] = pattern;
  json["pattern_sha256"] = task.pattern.sha256;
  json["walk"] =
      add("walks", rows, write_tracking_npz(model_, motion_of_table(rows)).front().bytes);
  json["cycle"] = add("cycles", rows_of(fine, first, number), tracking_npz_within(model_, around));
  json["cycle"].update(Json{{"begin_s", static_cast<double>(first) * step},
                            {"duration_s", length},
                            {"first_swing", cycle.first == Side::left ? "left" : "right"},
                            {"displacement_m", {cycle.displacement.x(), cycle.displacement.y()}},
                            {"turn_rad", cycle.turn},
                            {"gap", gap_json(cycle.gap)}});
}

GaitResult GaitMaker::make(const GaitCell& cell, const Progress& progress) const {
  return gait_result({{"name", cell.name},
                      {"forward_m_s", cell.forward},
                      {"sideways_m_s", cell.sideways},
                      {"turn_rad_s", cell.turn},
                      {"period_s", cell.period}},
                     [&](GaitResult& result) { make(cell, result, progress); });
}

void GaitMaker::change(const GaitCell& from, const GaitCell& to, GaitResult& result,
                       const Progress& progress) const {
  Json& json = result.json;
  const int steps = lead(from.period);
  Made walked =
      made(generated([&] {
             Pattern pattern = walk_in_parts(
                 model_, {walk(from, steps), walk(to, lead(to.period) + 1 + memory(to.period))},
                 kDecimals);
             pattern.name = from.name + " to " + to.name;
             return pattern;
           }),
           progress);
  const Task& task = walked.task;
  simulate(task, json, progress);
  json["status"] = "stands";
  add_figures(walked, json);
  const std::string path = "transitions/" + from.name + "_to_" + to.name + ".json";
  const std::string text = pattern_text(
      task.pattern,
      {"From a library of walks: a walk that changes from " + from.name + " to " + to.name + "."});
  result.files.emplace_back(path, text);
  json["pattern"] = path;
  json["pattern_sha256"] = sha256(text);
  const GaitCycle before = gait_cycle(model_, {task.pattern, task.series}, steps);
  json["changes_at_s"] = static_cast<double>(before.begin) * task.series.dt;
}

GaitResult GaitMaker::change(const GaitCell& from, const GaitCell& to,
                             const Progress& progress) const {
  return gait_result({{"from", from.name}, {"to", to.name}},
                     [&](GaitResult& result) { change(from, to, result, progress); });
}

}  // namespace ayumi::app
