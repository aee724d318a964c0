#include "simulation.hpp"

#include <cstdio>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/gain_design.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "option_checks.hpp"
#ifdef AYUMI_HAS_MUJOCO
#include "ayumi/sim/plant_mujoco/mujoco_plant.hpp"
#endif

namespace ayumi::app {

void add_simulation_options(Command& command, SimulationChoice& choice) {
  command
      .add_option(
          "--controller", choice.controller,
          "Controller (default: the controller of the pattern). The controllers of Ayumi are dtad "
          "and viip. The name 'none' selects the open loop. The controllers preview, foot-guided "
          "and dcm-step are laws from other publications, for comparison. The controllers "
          "dtad-literal, viip-landings and viip-nofeedback are variants of dtad and viip. Each "
          "variant demonstrates what one part of these laws contributes.")
      ->type_name("NAME");
  command
      .add_option("--scenario", choice.scenario,
                  "Disturbances: a pattern file with the scenario to use, or the word none "
                  "(default: the scenario of the pattern).")
      ->type_name("F");
  command.add_option("--gain", choice.gains, "Set a gain of the controller.")
      ->type_name("GAIN=VALUE")
      ->allow_extra_args(false);
  command.add_flag("--true-state", choice.true_state,
                   "Give the controller the true state in place of the estimate.");
  command.add_option("--substeps", choice.substeps, "Number of integrator steps per servo period.")
      ->check(whole_number_within(SimulateOptions::kSubsteps).description(""))
      ->type_name("N");
  add_unstable_flag(command, choice.unstable);
  add_plant_option(command, choice.plant);
}

void add_noise_flag(Command& command, bool& noise) {
  command.add_flag(
      "--noise", noise,
      "Simulate noise, bias and latency of the sensors as the sidecar describes them.");
}

void add_unstable_flag(Command& command, bool& allowed) {
  command.add_flag("--allow-unstable", allowed,
                   "Simulate even if the gains make the loop unstable, as a demonstration.");
}

void refuse_unstable_gains(const Task& input, const ControllerSpec& spec, bool allowed) {
  if (allowed) return;
  const CommandSample& first = input.series.samples.front();
  const std::string reason = instability(input.robot, input.robot.limits(input.profile), spec,
                                         first.cog.z() - first.zmp.z(), input.series.dt);
  if (!reason.empty())
    fail(ErrorCode::bad_pattern,
         reason + ". --allow-unstable simulates with these gains nevertheless");
}

void note_missing_noise(const RobotModel& robot, bool noise) {
  const SensorDescription& sensors = robot.description().sensors;
  if (!noise || sensors.oldest(robot.description().servo_period) > 0 ||
      !sensors.force_cells.empty() || sensors.attitude_noise > 0 || sensors.attitude_bias != 0 ||
      sensors.gyro_noise > 0 || sensors.accelerometer_noise > 0 || sensors.force_noise > 0 ||
      sensors.force_resolution > 0 || sensors.encoder_quantisation)
    return;
  std::fprintf(
      stderr,
      "ayumi: --noise changes nothing, because the files of %s state no noise, bias or latency of "
      "sensors. State these under \"sensors\" in the sidecar of the robot (`ayumi init` "
      "writes a first guess)\n",
      text::printable(robot.name()).c_str());
}

ControllerSpec chosen_controller(const Task& input, const SimulationChoice& choice) {
  ControllerSpec spec = input.pattern.controller;
  if (!choice.controller.empty()) {
    const ControllerType type = controller_type(choice.controller);
    if (type != spec.type) spec = {type, {}};
  }
  if (spec.type == ControllerKind::none && !choice.gains.empty())
    fail(ErrorCode::usage,
         "--gain: the controller is 'none' (open loop), which has no gains. Leave --gain out, or "
         "choose dtad or viip with --controller");
  for (const auto& [name, value] : read_pairs(choice.gains, "--gain"))
    spec.gains.emplace_back(name, value);
  return spec;
}

namespace {

#ifdef AYUMI_HAS_MUJOCO
constexpr const char* kPlantHelp = "Simulator: ayumi or mujoco (default: ayumi).";
#else
#define AYUMI_HOW_TO_GET_MUJOCO                                                            \
  "this program was built without MuJoCo. To get it: sudo apt-get install libmujoco-dev, " \
  "then configure and build again (cmake -S . -B build/release && cmake --build build/release)"
constexpr const char* kHowToGetMujoco = AYUMI_HOW_TO_GET_MUJOCO;
constexpr const char* kPlantHelp =
    "Simulator: ayumi or mujoco (default: ayumi). Only ayumi is available, "
    "because " AYUMI_HOW_TO_GET_MUJOCO;
#undef AYUMI_HOW_TO_GET_MUJOCO
#endif

}  // namespace

void add_plant_option(Command& command, std::string& plant) {
  command.add_option("--plant", plant, kPlantHelp)->type_name("NAME");
}

PlantKind plant_of(const std::string& name) {
  if (name == "ayumi") return {};
#ifdef AYUMI_HAS_MUJOCO
  if (name == "mujoco") return mujoco_plant_kind();
#else
  if (name == "mujoco") fail(ErrorCode::usage, std::string("--plant mujoco: ") + kHowToGetMujoco);
#endif
  fail(ErrorCode::usage, "--plant: unknown simulator '" + name + "'" +
                             text::suggestion(name, {"ayumi", "mujoco"}) +
                             " (known: ayumi, mujoco)");
}

std::vector<std::string> built_plants() {
#ifdef AYUMI_HAS_MUJOCO
  return {"ayumi", "mujoco"};
#else
  return {"ayumi"};
#endif
}

SimulateOptions simulation_options(const Context& context, const Task& input,
                                   const SimulationChoice& choice) {
  SimulateOptions options = simulate_options(input);
  options.controller = chosen_controller(input, choice);
  refuse_unstable_gains(input, options.controller, choice.unstable);
  if (choice.scenario == "none")
    options.scenario.clear();
  else if (!choice.scenario.empty())
    options.scenario = read_pattern(choice.scenario).scenario;
  options.sensor_noise = choice.noise;
  note_missing_noise(input.robot, choice.noise);
  options.true_state = choice.true_state;
  options.substeps = choice.substeps;
  options.plant = plant_of(choice.plant);
  options.seed = context.seed;
  return options;
}

TableCaution table_caution(const Task& input, const SimulationLog& log,
                           const std::vector<std::string>& unfit) {
  TableCaution caution = {words_of(log.scenario), text::join(unfit, "; ")};
  add_caution(caution, input.caution);
  return caution;
}

Eigen::MatrixXd torques_of(const SimulationLog& log) {
  Eigen::MatrixXd torque(static_cast<Eigen::Index>(log.samples.size()),
                         static_cast<Eigen::Index>(log.joints.size()));
  for (Eigen::Index k = 0; k < torque.rows(); ++k)
    torque.row(k) = log.samples[static_cast<size_t>(k)].torque.transpose();
  return torque;
}

namespace {

// Shares in words, such as "joint speed 72 % (l_knee at 2.90 s)". A simulated robot moves and
// carries its weight, so a share of exactly 0 means that there is no limit.
std::string shares_text(const SimulationLog& log) {
  const SimulationResult& r = log.result;
  const std::string speed = "joint speed " + share_text(log, r.speed);
  const std::string torque = "torque " + share_text(log, r.torque);
  const bool has_speed = r.speed.ratio > 0, has_torque = r.torque.ratio > 0;
  if (has_speed && has_torque) return speed + " and " + torque + " of the limits";
  if (has_speed) return speed + " of the limits, torque without limits";
  if (has_torque) return torque + " of the limits, joint speed without limits";
  return "joint speed and torque without limits";
}

// Smallest differences that are reported. Chosen: nobody sees a tilt of less than a degree in a
// clip; a tenth of the torque limit is more than rounding and less than a motor notices.
constexpr double kMoreTilt = std::numbers::pi / 180;  // difference of the tilt [rad]
constexpr double kMoreTorque = 0.1;                   // share of the limit

}  // namespace

std::string share_text(const SimulationLog& log, const JointShare& share) {
  return text::fixed(100 * share.ratio, 0) + " %" + place_in_brackets(log, share);
}

std::vector<std::string> worse_than_open_loop(const SimulationLog& open_run,
                                              const SimulationLog& closed_run) {
  const SimulationResult &open = open_run.result, &closed = closed_run.result;
  std::vector<std::string> worse;
  if (closed.outcome != Outcome::stands && open.outcome == Outcome::stands)
    worse.push_back(std::string("the robot ") +
                    (closed.outcome == Outcome::fell ? "falls" : "does not come to rest") +
                    ", while it stands in open loop");
  if (open.outcome == Outcome::fell) return worse;
  const auto degrees = [](double angle) {
    return text::fixed(angle * 180 / std::numbers::pi, 1) + " deg";
  };
  if (closed.max_tilt > open.max_tilt + kMoreTilt)
    worse.push_back("the largest trunk tilt is " + degrees(closed.max_tilt) + " with control and " +
                    degrees(open.max_tilt) + " in open loop");
  if (closed.torque.ratio > open.torque.ratio + kMoreTorque)
    worse.push_back("the largest torque is " + share_text(closed_run, closed.torque) +
                    " of the limit with control and " + share_text(open_run, open.torque) +
                    " in open loop");
  return worse;
}

std::string outcome_text(const SimulationLog& log) { return outcome_text(log, log.samples.size()); }

std::string outcome_text(const SimulationLog& log, size_t rows) {
  const SimulationResult& r = log.result;
  std::string text = log.controller == ControllerKind::none
                         ? std::string("in open loop")
                         : "with " + name_of(log.controller.value());
  text += r.outcome == Outcome::stands ? ", the robot stands"
          : r.outcome == Outcome::fell ? ", the robot fell"
                                       : ", the robot does not come to rest";
  if (r.outcome == Outcome::fell) {
    text += " at " + text::fixed(r.fell_at, 2) + " s";
    for (const SimulationEvent& event : log.events)
      if (event.kind == EventKind::fell) text += " (" + event.text + ")";
  } else {
    text += ", final COG error " + text::fixed(1e3 * r.final_cog_error, 2) + " mm";
    if (r.outcome == Outcome::unsettled && r.zmp_amplitude > 0)
      text += ", the ZMP oscillates by " + text::fixed(1e3 * r.zmp_amplitude, 1) + " mm at " +
              text::fixed(r.zmp_frequency, 1) + " Hz";
  }
  text += ", largest trunk tilt " + text::fixed(r.max_tilt * 180 / std::numbers::pi, 1) + " deg, " +
          shares_text(log);
  const double end = log.dt * static_cast<double>(rows - 1);
  std::vector<Disturbance> late;
  for (const Disturbance& disturbance : log.scenario)
    if (disturbance.at > end) late.push_back(disturbance);
  if (!late.empty())
    text += ". The simulation ends at " + text::fixed(end, 2) +
            " s, so this part of the scenario has no effect: " + words_of(late);
  return text;
}

}  // namespace ayumi::app
