#include "ayumi/io/run/log_robot.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

using Eigen::Vector3d;

// Largest difference of the COG [m]. Chosen: rounding is below 1e-12, and another mass or length of
// a robot moves its COG by more. Half or twice this bound changes nothing.
constexpr double kSameRobot = 1e-6;

// Largest difference of the length of a quaternion from 1. Chosen: rounding is below 1e-12. Half or
// twice this bound changes nothing.
constexpr double kUnitQuaternion = 1e-6;

void require_attitudes(const SimulationSample& sample, double t, const std::string& source) {
  for (const BasePose* base : {&sample.state.base, &sample.reference_base, &sample.command_base})
    if (!(std::abs(base->attitude.norm() - 1) < kUnitQuaternion))
      fail(ErrorCode::bad_file, {source},
           "at t = " + text::fixed(t, 3) + " s the quaternion of an attitude has the length " +
               text::brief(base->attitude.norm()) +
               ", but 1 is needed. The log has changed since the run; run the pattern again");
}

struct Carried {
  double begin = 0, end = 0;  // beginning and end of the interval [s]
  int body = 0;
  Vector3d point;  // point in the frame of the body
  double mass = 0;
};

// Whether the log is of a robot that a case of a study has drawn. The log does not contain the
// masses and lengths of such a robot.
bool is_of_drawn_robot(const SimulationLog& log) {
  return std::any_of(log.events.begin(), log.events.end(), [](const SimulationEvent& event) {
    return event.kind == EventKind::study_case;
  });
}

std::vector<Carried> carried_of(const RobotModel& model, const SimulationLog& log,
                                const std::string& source) {
  std::vector<Carried> list;
  for (const Disturbance& d : log.scenario) {
    const auto* payload = std::get_if<Payload>(&d.what);
    if (!payload) continue;
    const int link = model.find_link(payload->on);
    if (link < 0)
      fail(ErrorCode::bad_file, {source},
           "the scenario of the log has a payload on link '" + payload->on +
               "', which the robot '" + model.name() +
               "' does not have; name the robot of the run with --robot");
    const Link& on = model.links()[static_cast<size_t>(link)];
    // A disturbance that acts from the beginning also acts while the robot comes to rest before it.
    list.push_back({d.at > 0 ? d.at : -1, d.at + d.duration, on.body, on.pose * payload->point,
                    payload->mass});
  }
  return list;
}

}  // namespace

void require_postures_of(const RobotModel& model, const SimulationLog& log,
                         const std::string& source) {
  if (log.joints != model.dof_names())
    fail(ErrorCode::bad_file, {source},
         "the run has the joints " + text::join(log.joints, ", ") + ", but the robot '" +
             model.name() + "' has the joints " + text::join(model.dof_names(), ", ") +
             "; name the robot of the run with --robot");
  for (size_t k = 0; k < log.samples.size(); ++k)
    require_attitudes(log.samples[k], static_cast<double>(k) * log.dt, source);
}

void require_robot_of(const RobotModel& model, const SimulationLog& log,
                      const std::string& source) {
  require_postures_of(model, log, source);
  if (is_of_drawn_robot(log)) return;
  const std::vector<Carried> carried = carried_of(model, log, source);
  RobotData data(model);
  for (size_t k = 0; k < log.samples.size(); ++k) {
    const SimulationSample& sample = log.samples[k];
    const double t = static_cast<double>(k) * log.dt;
    update_positions(model, sample.state, data);
    double mass = model.mass();
    Vector3d moment = mass * data.cog;
    bool known = true;
    for (const Carried& load : carried) {
      // In the tick in which a load comes or goes, it may act or not.
      known &= std::abs(t - load.begin) > 1.5 * log.dt && std::abs(t - load.end) > 1.5 * log.dt;
      if (t < load.begin || t > load.end) continue;
      mass += load.mass;
      moment += load.mass * (data.pose(load.body) * load.point);
    }
    const double off = (moment / mass - sample.cog).norm();
    if (known && !(off < kSameRobot))
      fail(ErrorCode::bad_file, {source},
           "with the posture at " + text::fixed(t, 3) + " s, the COG of the robot '" +
               model.name() + "' differs from the COG in the log by " + text::brief(1e3 * off) +
               " mm, but at most " + text::brief(1e3 * kSameRobot) +
               " mm are allowed. The log belongs to another robot, or the robot or the log has "
               "changed since the run; run the pattern again");
  }
}

}  // namespace ayumi
