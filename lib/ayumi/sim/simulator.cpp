// Control tick k has these parts in order: the measurement (with the forces of the step that ended
// at k dt), the estimate, the controller, the log, and the integrator steps. During the integrator
// steps, the targets are constant, and each step has its own disturbances.
#include "ayumi/sim/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/model/encoder_angles.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/sim/log_events.hpp"
#include "ayumi/sim/plant/plant.hpp"
#include "ayumi/sim/standing_calibration.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Time for which the servos hold the first posture before t = 0 [s]. Chosen: four periods of an
/// oscillation of 10 Hz, so that soles and servos come to rest. Between half and twice the value,
/// figures change by less than 5 %.
constexpr double kBeforeStart = 0.4;
/// Longest time for which ankles turn before t = 0 until their soles lie flat [s]. Chosen: as long
/// as an offset of 3 degrees takes (sim/standing_calibration).
constexpr double kLongestCalibration = 3;
/// Step of Ayumi's own plant and of the sensors during this time [s]; another plant keeps its tick.
/// Chosen: the robot hardly moves, and the examination then takes a quarter of the time. In 7 of
/// 200 draws of HOAP-1's uncertainty, the decision whether an offset is found differs from that
/// with 1 ms; another seed of the noise changes 11 or 17 of the 200 decisions. With half of this
/// step, 1 decision differs; with twice, 8 (docs/theory_plant.md).
constexpr double kCalibrationStep = 0.004;
/// Simulated time after a fall [s]. Chosen: the robot has reached the ground, which a replay shows.
/// Between half and twice the value, figures change by less than 5 %.
constexpr double kAfterFall = 0.8;
/// Samples for which the log reserves memory at the start; longer runs allocate more.
constexpr long kReservedSamples = 1 << 15;
/// Fraction of the weight that the vertical ground force needs for the true ZMP to be updated;
/// below it, the ZMP keeps its last value. Chosen: the ZMP is a quotient of moment and force, and
/// rounding and chatter of contacts disturb it at small forces. Between half and twice the value,
/// figures change by less than 5 %.
constexpr double kZmpMinLoad = 0.02;

const CommandSeries& checked(const CommandSeries& series, const SimulateOptions& options) {
  if (series.samples.empty())
    fail(ErrorCode::bad_pattern, "the motion has no samples. Sample a pattern first");
  require_within("the number of integrator steps per servo period", options.substeps,
                 SimulateOptions::kSubsteps);
  return series;
}

PlantInterface make_plant(const RobotModel& model, const ActuatorLimits& limits,
                          const SimulateOptions& options) {
  if (options.plant.make) return options.plant.make(model, limits, options.world);
  return PlantInterface(Plant(model, limits, options.world));
}

}  // namespace

Simulator::Simulator(const RobotModel& model, const CommandSeries& series,
                     const SimulateOptions& options)
    : model_(options.unit ? &options.unit->model : &model),
      law_model_(&model),
      series_(&checked(series, options)),
      options_(options),
      limits_(options.unit ? options.unit->actuators : model.limits(options.profile)),
      h_(series.dt / options.substeps),
      plant_(make_plant(*model_, limits_, options)),
      sensors_(*model_, limits_, series.dt, options.sensor_noise && !options.true_state,
               options.seed),
      estimator_(model, series.dt),
      monitor_(*model_, limits_, options.world),
      schedule_(*model_, options.world, h_),
      controller_(options.prepared ? *options.prepared
                                   : Controller(model, model.limits(options.profile), series,
                                                options.controller)),
      counts_targets_(options.sensor_noise && !options.true_state &&
                      model_->description().sensors.encoder_quantisation),
      counts_(counts_targets_ ? model.dof_count() : 0),
      saturated_(static_cast<size_t>(model.dof_count())) {
  for (Eigen::Index j = 0; j < counts_.size(); ++j)
    counts_[j] =
        std::abs(model_->dofs()[static_cast<size_t>(j)].encoder.counts_per_degree) * 180 / M_PI;
  // The law knows the zeros of the robot's file. An uncertain robot may have others.
  if (const VectorXd known = encoder_zeros(model); !known.isZero(0)) zeros_ = known;
  model.sole(Side::left);  // throws if the robot has no soles
  set_scenario(options.scenario);
  if (options.targets)
    events_.push_back(
        {0, EventKind::controller, "the servo targets are those of the caller's function"});
  planned_ = end_ =
      static_cast<long>(series.samples.size()) + std::lround(options.settle / series.dt);
  plant_.set_state(controller_.start());
  for (long i = -std::lround(kBeforeStart / h_); i < 0; ++i) {
    schedule_.fill(i, plant_.data(), input_);
    report_ = plant_.step(sent(controller_.target()), input_, h_);
  }
  if (!options.true_state && options.controller.type != ControllerKind::none) calibrate_ankles();
}

// This is done before the first tick with separate sensors, so that a robot that stands on its
// soles gets the same readings as without this.
void Simulator::calibrate_ankles() {
  const bool own_plant = !options_.plant.make;
  const double dt = own_plant ? std::max(kCalibrationStep, series_->dt) : series_->dt;
  Sensors sensors(*model_, limits_, dt, options_.sensor_noise, options_.seed);
  sensors.reach_back(schedule_.largest_latency());
  Estimator estimator(*law_model_, dt);
  StandingCalibration calibration(*law_model_, dt);
  const CommandSample& plan = controller_.plan();
  const auto measure = [&]() -> const Measurement& {
    schedule_.fill(-1, plant_.data(), input_);
    return sensors.read(plant_.state(), plant_.data(), report_, schedule_.sensor_fault(-1),
                        input_.joints);
  };
  if (!calibration.needed(measure(), plan)) return;
  const PlantInterface before = plant_;
  const StepReport report_before = report_;
  const long most = std::lround(kLongestCalibration / dt);
  for (long k = 0; k < most && !calibration.done(); ++k) {
    encoder_offset_ = calibration.offsets();
    const Measurement& measurement = corrected(measure());
    calibration.update(measurement, estimator.update(measurement, plan.feet), plan.feet);
    encoder_offset_ = calibration.offsets();
    const int steps = own_plant ? 1 : options_.substeps;
    for (int i = 0; i < steps; ++i)
      report_ = plant_.step(sent(controller_.target() + encoder_offset_), input_, dt / steps);
  }
  if (!calibration.done() || !calibration.found()) {
    plant_ = before;
    report_ = report_before;
    encoder_offset_.resize(0);
  }
  if (!calibration.done()) {
    events_.push_back({0, EventKind::calibration,
                       "the robot stands on an edge of a sole, and no offsets of the ankles' "
                       "encoders explain this"});
    return;
  }
  for (const std::string& line : calibration.lines())
    events_.push_back({0, EventKind::calibration, line});
}

const Measurement& Simulator::corrected(const Measurement& measurement) {
  if (encoder_offset_.size() == 0 && zeros_.size() == 0) return measurement;
  corrected_ = measurement;
  if (zeros_.size() > 0) corrected_.theta += zeros_;
  if (encoder_offset_.size() > 0) corrected_.theta -= encoder_offset_;
  return corrected_;
}

/// The targets as the servos receive them: encoder angles.
const VectorXd& Simulator::sent(const VectorXd& target) {
  if (zeros_.size() == 0) return target;
  sent_ = target - zeros_;
  return sent_;
}

void Simulator::set_scenario(const std::vector<Disturbance>& scenario) {
  schedule_.set(scenario);
  sensors_.reach_back(schedule_.largest_latency());
  options_.scenario = scenario;
}

const CommandSample& Simulator::command(long k) const {
  const std::vector<CommandSample>& samples = series_->samples;
  return samples[std::min<size_t>(static_cast<size_t>(k), samples.size() - 1)];
}

double Simulator::time() const { return static_cast<double>(tick_) * series_->dt; }

/// The energy of the robot without its loads, but with its rotors [J].
double Simulator::energy() const {
  const RobotData& data = plant_.data();
  double twice = 0;
  for (size_t b = 0; b < model_->bodies().size(); ++b) {
    const Inertia& inertia = model_->bodies()[b].inertia;
    const Eigen::Matrix3d& R = data.rotation[b];
    const Vector3d& w = data.angular_velocity[b];
    const Vector3d c = R * inertia.com, own = R.transpose() * w;
    twice += inertia.mass * (data.velocity[b] + w.cross(c)).squaredNorm() +
             own.dot(inertia.about_com * own) +
             2 * inertia.mass * kGravity * (data.base_position.z() + data.position[b].z() + c.z());
  }
  for (int j = 0; j < model_->dof_count(); ++j) {
    const double rate =
        report_.motor_rate.size() > 0 ? report_.motor_rate[j] : plant_.state().dtheta[j];
    twice += limits_.servo[static_cast<size_t>(j)].rotor_inertia * rate * rate;
  }
  return 0.5 * twice;
}

/// Replaces the estimate in the plan frame by the true state in the world. The ZMP keeps its value
/// in flight.
void Simulator::replace_estimate_by_truth() {
  const RobotData& data = plant_.data();
  Estimate& e = true_estimate_;
  const Vector3d zmp_before = e.zmp;
  e = estimator_.last();
  e.zmp = zmp_before;
  e.state = plant_.state();
  e.cog = data.cog;
  e.dcog = data.dcog;
  double fz = 0;
  Vector3d moment = Vector3d::Zero();
  for (const std::vector<SoleForce>& sole : report_.soles)
    for (const SoleForce& cell : sole) {
      fz += cell.force.z();
      moment += cell.force.z() * cell.position;
    }
  e.fz = fz;
  if (fz > kZmpMinLoad * model_->mass() * kGravity) e.zmp = moment / fz;
}

const ControlOutput& Simulator::with_targets_of_caller(double t, const ControlOutput& law) {
  changed_ = law;
  changed_.target = options_.targets(t, estimate(), plan_, law.target);
  if (changed_.target.size() != law.target.size())
    fail(ErrorCode::usage, "the targets at t = " + text::fixed(t, 3) +
                               " s: " + std::to_string(changed_.target.size()) +
                               " values, but the robot has " + std::to_string(law.target.size()) +
                               " joints");
  return changed_;
}

/// The output with the targets that the servos receive. The offsets that were estimated at rest are
/// added. If the sensors are as the sidecar describes them, targets are rounded to whole counts.
const ControlOutput& Simulator::in_counts(const ControlOutput& out) {
  if (encoder_offset_.size() == 0 && !counts_targets_) return out;
  changed_ = out;
  if (encoder_offset_.size() > 0) changed_.target += encoder_offset_;
  if (!counts_targets_) return changed_;
  for (Eigen::Index j = 0; j < counts_.size(); ++j)
    if (counts_[j] > 0) {
      const double zero = zeros_.size() > 0 ? zeros_[j] : 0;
      changed_.target[j] = std::round((changed_.target[j] - zero) * counts_[j]) / counts_[j];
      if (zero != 0) changed_.target[j] += zero;  // adding 0 would change the sign of -0
    }
  return changed_;
}

/// Fills last_ from the plant, the plan and the controller's output; its lists keep their memory.
void Simulator::take_sample(const CommandSample& cmd, const Estimate& estimate,
                            const ControlOutput& out) {
  SimulationSample& s = last_;
  s.state = plant_.state();
  const RobotData& data = plant_.data();
  s.cog = data.cog;
  s.dcog = data.dcog;
  s.target = out.target;
  s.torque = report_.torque;
  s.reference_base = out.reference.base;
  s.reference_theta = out.reference.theta;
  s.reference_cog = out.cog;
  s.reference_zmp = out.cog_reference.zmp;
  s.reference_fz = out.cog_reference.fz;
  s.command_base = cmd.state.base;
  s.command_theta = cmd.state.theta;
  s.command_cog = cmd.cog;
  s.command_zmp = cmd.zmp;
  s.command_fz = cmd.fz;
  s.measured_dcog = estimate.dcog;
  s.command_dcog = cmd.dcog;
  s.reference_dcog = out.cog_reference.dcog;
  s.reference_ddcog = out.cog_reference.ddcog;
  s.reference_dtheta = out.reference.dtheta;
  s.law = out.terms;
  s.residuals = out.residuals;
  s.weight = out.weight;
  s.measured_cog = estimate.cog;
  s.measured_zmp = estimate.zmp;
  s.measured_fz = estimate.fz;
  take_forces();
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<size_t>(side);
    if (!(s.foot_force[i].z() > 0))
      s.foot_cop[i] = sole_pose(*model_, plant_.data(), side).translation();
    s.planned_contact[i] = supports(cmd.support, side);
  }
  s.push_force.setZero();
  s.push_point.setZero();
  for (const ExternalWrench& x : input_.wrenches) {
    s.push_force += x.force;
    s.push_point = x.body < 0 ? s.cog : x.point;
  }
  s.contact_residual = report_.contact_residual;
  s.contact_iterations = report_.contact_iterations;
  if (keep_samples_) s.energy = energy();
  s.work = work_;
}

/// Fills the forces and the true ZMP of last_; the centre of pressure of a foot without load does
/// not change.
void Simulator::take_forces() {
  SimulationSample& s = last_;
  s.fz = 0;
  Vector3d moment = Vector3d::Zero();
  for (int side = 0; side < 2; ++side) {
    Vector3d weighted = Vector3d::Zero();
    Vector3d& force = s.foot_force[side];
    force.setZero();
    for (const SoleForce& cell : report_.soles[side]) {
      force += cell.force;
      weighted += cell.force.z() * cell.position;
    }
    if (force.z() > 0) s.foot_cop[side] = weighted / force.z();
    s.fz += force.z();
    moment += weighted;
  }
  if (s.fz > kZmpMinLoad * model_->mass() * kGravity) zmp_ = moment / s.fz;
  s.zmp = zmp_;
}

void Simulator::note(double t, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (noted_.insert(text).second) events_.push_back({t, EventKind::saturation, text});
}

const Measurement& Simulator::measure(long step) {
  return corrected(options_.true_state
                       ? sensors_.read(plant_.state(), plant_.data(), report_)
                       : sensors_.read(plant_.state(), plant_.data(), report_,
                                       schedule_.sensor_fault(step), input_.joints));
}

void Simulator::check_finite(double t) const {
  if (!plant_.state().theta.allFinite() || !plant_.state().base.position.allFinite())
    fail(ErrorCode::internal,
         "the state of the simulation is not finite at t = " + text::fixed(t, 3) + " s");
}

void Simulator::end_soon_after_fall() {
  fell_ = true;
  end_ = std::min(planned_, tick_ + std::lround(kAfterFall / series_->dt));
}

void Simulator::move(long step, const VectorXd& target) {
  const VectorXd& encoders = sent(target);
  for (int i = 0; i < options_.substeps; ++i) {
    if (i > 0) schedule_.fill(step + i, plant_.data(), input_);
    report_ = plant_.step(encoders, input_, h_);
    work_ += report_.work;
  }
}

void Simulator::step_once() {
  const double t = time();
  const long step = tick_ * options_.substeps;
  schedule_.fill(step, plant_.data(), input_);
  plan_ = controller_.plan();
  const CommandSample& cmd = plan_;
  estimator_.update(measure(step), cmd.feet);
  if (options_.true_state) replace_estimate_by_truth();
  const ControlOutput& law = controller_.update(estimate());
  const ControlOutput& out = in_counts(options_.targets ? with_targets_of_caller(t, law) : law);
  take_sample(cmd, estimate(), out);
  check_finite(t);
  if (input_.floor) monitor_.set_ground(input_.floor->pose);
  if (monitor_.observe(t, cmd, last_, plant_.data(), report_, series_->dt)) end_soon_after_fall();
  note(t, out.notes);
  for (int j : report_.saturated) {
    if (saturated_[static_cast<size_t>(j)]) continue;
    saturated_[static_cast<size_t>(j)] = true;
    note(t, {"torque limit of " + model_->dofs()[j].name + " reached"});
  }

  move(step, out.target);
  if (report_.self_contact[0] >= 0 && !touched_) {
    touched_ = true;
    events_.push_back({t, EventKind::contact,
                       model_->bodies()[report_.self_contact[0]].name + " touches " +
                           model_->bodies()[report_.self_contact[1]].name});
  }
  if (keep_samples_ && sink_) {
    sink_(last_);
  } else if (keep_samples_) {
    if (samples_.empty())
      samples_.reserve(static_cast<size_t>(std::min(planned_, kReservedSamples)));
    samples_.push_back(last_);
  }
  ++tick_;
}

/// The same as step_once() if only the verdict counts. The plan is judged before the law continues
/// with the next one, so it need not be copied, and a law that measures nothing needs no estimate.
/// `last` marks the last of these ticks, after which plan and estimate are read.
void Simulator::step_for_verdict(bool last) {
  const double t = time();
  const long step = tick_ * options_.substeps;
  schedule_.fill(step, plant_.data(), input_);
  const CommandSample& cmd = controller_.plan();
  if (last) plan_ = cmd;
  const Measurement& measurement = measure(step);
  if (last || controller_.measures())
    estimator_.update(measurement, cmd.feet);
  else
    estimator_.follow_loads(measurement, cmd.feet);
  last_.cog = plant_.data().cog;
  take_forces();
  check_finite(t);
  if (input_.floor) monitor_.set_ground(input_.floor->pose);
  if (monitor_.observe_verdict(t, cmd, last_, plant_.data(), report_, series_->dt))
    end_soon_after_fall();
  const ControlOutput& out = in_counts(controller_.update(estimate()));
  if (last) {
    last_.reference_base = out.reference.base;
    last_.reference_theta = out.reference.theta;
  }
  move(step, out.target);
  ++tick_;
}

bool Simulator::advance(long ticks, const Progress& progress) {
  const bool for_verdict = verdict_only_ && !options_.true_state && !options_.targets;
  for (; ticks > 0 && tick_ < end_; --ticks) {
    if (progress && tick_ % 100 == 0)
      ayumi::report(progress,
                    {options_.controller.type == ControllerKind::none
                         ? std::string("simulating in open loop")
                         : "simulating with " + std::string(name_of(options_.controller.type)),
                     static_cast<double>(tick_) / static_cast<double>(planned_), ""});
    if (for_verdict)
      step_for_verdict(ticks == 1 || tick_ + 1 == end_);
    else
      step_once();
  }
  return tick_ < end_;
}

SimulationResult Simulator::result() const {
  return FallMonitor(monitor_).conclude(controller_.plan(), plant_.state());
}

SimulationLog Simulator::take_log() {
  SimulationLog log;
  log.dt = series_->dt;
  log.controller = options_.controller.type;
  log.gains = gains_in_use(*law_model_, options_.controller);
  log.plant = options_.plant.name;
  log.world = options_.world;
  log.scenario = options_.scenario;
  log.joints = model_->dof_names();
  log.samples = std::move(samples_);
  samples_.clear();
  log.result = result();
  log.events = monitor_.events();
  log.events.insert(log.events.end(), events_.begin(), events_.end());
  for (const SimulationEvent& event : schedule_.events()) log.events.push_back(event);
  std::stable_sort(log.events.begin(), log.events.end(),
                   [](const SimulationEvent& a, const SimulationEvent& b) { return a.t < b.t; });
  limit_events(log.events);
  return log;
}

}  // namespace ayumi
