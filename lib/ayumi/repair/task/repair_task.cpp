#include "ayumi/repair/task/repair_task.hpp"

#include "ayumi/check/actuator_need.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/control/viip_goals.hpp"
#include "ayumi/repair/motion_change.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/task/payload_findings.hpp"

namespace ayumi {

namespace {

std::vector<CarriedMass> payloads_of(const Task& task) {
  std::vector<CarriedMass> masses;
  for (const Disturbance& d : task.pattern.scenario)
    if (const auto* payload = std::get_if<Payload>(&d.what))
      if (const int link = task.robot.find_link(payload->on); link >= 0)
        masses.push_back({link, payload->point, payload->mass});
  return masses;
}

// The result of a repair of the robot alone. If its motion is not consistent with the payloads,
// this is not a repair, and the errors become the reasons.
RepairResult with_payload_errors(const Task& task, const CheckOptions& options,
                                 RepairResult result) {
  Task moved = task;
  moved.series = result.series;
  judge_payloads(task, options, result.before);
  const std::vector<Mistake> heavy = judge_payloads(moved, options, result.check);
  if (heavy.empty()) return result;
  if (result.status != RepairStatus::infeasible) result.status = RepairStatus::not_converged;
  for (const Mistake& payload : heavy) result.reasons.push_back(payload.words);
  return result;
}

// The correction for a robot with its payloads, judged with the robot of the task.
RepairResult of_robot_alone(const Task& task, const CheckOptions& options, RepairResult loaded,
                            const ConsistencyReport& before) {
  Pattern corrected = task.pattern;
  corrected.correction = loaded.correction;
  loaded.series = sample_at_servo_period(task.robot, corrected, {}, task.threads);
  loaded.check = check_consistency(task.robot, loaded.series, options);
  loaded.moved = motion_change(task.robot, task.series, loaded.series);
  if (!loaded.check.consistent) loaded.status = RepairStatus::not_converged;
  loaded = with_payload_errors(task, options, std::move(loaded));
  loaded.before = before;
  return loaded;
}

RepairResult of_motion(const Task& task, const RepairOptions& options, const Progress& progress) {
  RepairResult alone = repair(task.robot, task.pattern, task.series, options, progress);
  const std::vector<CarriedMass> masses = payloads_of(task);
  if (masses.empty() || alone.partial) return alone;
  const bool stands_alone = alone.check.consistent;
  RepairResult judged = with_payload_errors(task, options.check, std::move(alone));
  if (!stands_alone || judged.check.consistent) return judged;
  Pattern plain = task.pattern;
  plain.correction.reset();
  const CommandSeries start = task.pattern.correction
                                  ? sample_at_servo_period(task.robot, plain, {}, task.threads)
                                  : task.series;
  RepairResult loaded = repair(with_payloads(task.robot, masses), start, options, progress);
  if (loaded.status != RepairStatus::repaired || loaded.partial) return judged;
  loaded = of_robot_alone(task, options.check, std::move(loaded), judged.before);
  return loaded.check.consistent ? loaded : judged;
}

}  // namespace

RepairResult repair_task(const Task& task, const RepairOptions& options, const Progress& progress) {
  RepairResult result = of_motion(task, options, progress);
  if (task.series.viip.empty()) return result;
  const bool unchanged = result.status == RepairStatus::already_consistent;
  const ActuatorNeed need = actuator_need(
      task.robot,
      keyed_goals(task.robot, unchanged ? task.series : result.series, task.pattern.controller),
      options.check);
  if (need.text.empty()) return result;
  // A correction moves the posture and not the goals.
  result.check.consistent = result.before.consistent = false;
  if (result.status != RepairStatus::not_converged) result.status = RepairStatus::infeasible;
  result.reasons.insert(result.reasons.begin(), need.text + ". A repair does not change the goals");
  return result;
}

}  // namespace ayumi
