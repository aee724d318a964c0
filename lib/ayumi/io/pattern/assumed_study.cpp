#include "ayumi/io/pattern/assumed_study.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

namespace {

using StudyJson = nlohmann::ordered_json;

// Chosen: the ranges of robots/hoap1/uncertainty.json that are not measured there. Half or twice a
// range changes what a certificate says about the robot, so every range is printed as assumed.

/// Displacement of the centre of mass of the heaviest link, in COG heights. Chosen: 5 mm for
/// HOAP-1.
constexpr double kCogShare = 0.02;
/// Additional latency of the sensors, beyond that of the sidecar [s]. Chosen: two ticks of 1 ms.
constexpr double kMoreLatency = 0.002;

double tidy(double value) { return 1e-4 * std::round(1e4 * value); }

}  // namespace

std::string assumed_study_text(const RobotModel& robot) {
  StudyJson quantities = StudyJson::array();
  const auto add = [&](StudyJson quantity, const char* distribution, StudyJson values,
                       const char* why) {
    quantity[distribution] = std::move(values);
    quantity["source"] = std::string("assumed: ") + why;
    quantities.push_back(std::move(quantity));
  };
  const auto& links = robot.links();
  const auto heaviest = std::max_element(
      links.begin(), links.end(),
      [](const Link& a, const Link& b) { return a.inertia.mass < b.inertia.mass; });
  add({{"what", "mass"}, {"each", true}, {"factor", "mass of the robot"}, {"correlation", 0.7}},
      "truncated", {1, 0.025, 0.95, 1.05}, "5 % for each link");
  const double cog = std::max(1e-4, tidy(kCogShare * default_cog_height(robot, {})));
  for (const char* axis : {"x", "y", "z"})
    add({{"what", "cog"}, {"on", heaviest->name}, {"axis", axis}}, "uniform", {-cog, cog},
        "2 % of the COG height, for cables and batteries");
  add({{"what", "inertia"}, {"each", true}}, "uniform", {0.8, 1.2}, "20 % for each link");
  add({{"what", "friction"}}, "uniform", {0.4, 1.0},
      "rubber on polished wood to rubber on dry linoleum");
  add({{"what", "sole_stiffness"}}, "uniform", {0.5, 2},
      "half to twice the value of the robot model");
  for (const char* axis : {"x", "y"})
    add({{"what", "slope"}, {"axis", axis}}, "truncated", {0, 0.1, -0.3, 0.3},
        "a floor that is level within 5 mm on 1 m");
  const ActuatorLimits& actuators = robot.limits();
  const bool servos = std::any_of(actuators.has_servo.begin(), actuators.has_servo.end(),
                                  [](const auto has) { return static_cast<bool>(has); });
  if (servos) {
    add({{"what", "servo_kp"}}, "uniform", {0.8, 1.2}, "20 % for all servos alike");
    add({{"what", "servo_kd"}}, "uniform", {0.9, 1.1}, "10 % for all servos alike");
    add({{"what", "encoder_offset"}, {"each", true}}, "truncated", {0, 0.1, -0.25, 0.25},
        "zero set by eye against marks");
  }
  const SensorDescription& sensors = robot.description().sensors;
  if (sensors.attitude_noise > 0 || sensors.gyro_noise > 0 || sensors.accelerometer_noise > 0 ||
      sensors.force_noise > 0)
    add({{"what", "sensor_noise"}}, "uniform", {0.5, 2},
        "half to twice the value of the robot model");
  for (const char* axis : {"x", "y"})
    add({{"what", "attitude_bias"}, {"axis", axis}}, "uniform", {-0.2, 0.2},
        "in addition to the bias of the robot model");
  add({{"what", "sensor_latency"}}, "uniform", {0, tidy(sensors.oldest(0) + kMoreLatency)},
      "from 0 to 2 ms more than the latency of the robot model");
  const StudyJson factor = {{"name", "mass of the robot"},
                            {"source", "assumed: all parts are weighed on the same scales"}};
  const StudyJson study = {
      {"format", "ayumi.study/1"},
      {"name", robot.name() + ", assumed"},
      {"units", {{"angle", "deg"}}},
      {"uncertainty", {{"factors", StudyJson::array({factor})}, {"quantities", quantities}}}};
  return study.dump(1) + "\n";
}

Study assumed_study(const RobotModel& robot) {
  return study_of_text(assumed_study_text(robot), "assumed uncertainty of " + robot.name());
}

}  // namespace ayumi
