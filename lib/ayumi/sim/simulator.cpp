// Per control tick k: measure (forces of the step that ended at k dt) -> estimate -> controller ->
// log -> integrator sub-steps with the targets held and the disturbances of exactly those steps.
#include "ayumi/sim/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/plant.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kBeforeStart = 0.4;  // servos hold the first posture this long before t = 0 [s]
constexpr double kAfterFall = 0.8;    // of simulation kept after a fall [s]
constexpr double kZmpShare = 0.02;    // of the weight below which the ZMP is held

int find_pushed_body(const RobotModel& model, const std::string& name) {
  if (name == "cog") return -1;
  const int link = model.find_link(name);
  if (link >= 0) return link;
  std::vector<std::string> names;
  for (const Link& l : model.links()) names.push_back(l.name);
  fail(ErrorCode::bad_pattern, "scenario: " + model.name() + " has no link '" + name + "'" +
                                   text::suggestion(name, names) +
                                   " ('cog' pushes through the centre of gravity)");
}

/// Share of the rectangle's value in step i of n; the mean over the steps is 1 for impulses.
double shape_factor(const Disturbance& d, long i, long n) {
  if (d.shape == DisturbanceShape::rectangle) return 1.0;
  const double phase = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  if (d.type != DisturbanceType::impulse) return std::sin(phase);
  // The sum of sin over midpoints is 1 / sin(pi / 2n).
  return static_cast<double>(n) * std::sin(M_PI / (2.0 * static_cast<double>(n))) * std::sin(phase);
}

const CommandSeries& checked(const CommandSeries& series, const SimulateOptions& options) {
  if (series.samples.empty()) fail(ErrorCode::bad_pattern, "the command series is empty");
  if (options.substeps < 1) fail(ErrorCode::usage, "substeps must be at least 1");
  return series;
}

AnyPlant make_plant(const RobotModel& model, const ActuatorLimits& limits,
                    const SimulateOptions& options) {
  if (options.plant.make) return options.plant.make(model, limits, options.world);
  return AnyPlant(Plant(model, limits, options.world));
}

}  // namespace

Simulator::Simulator(const RobotModel& model, const CommandSeries& series,
                     const SimulateOptions& options)
    : model_(&model),
      series_(&checked(series, options)),
      options_(options),
      limits_(model.limits(options.profile)),
      h_(series.dt / options.substeps),
      plant_(make_plant(model, limits_, options)),
      sensors_(model, series.dt, options.sensor_noise, options.seed),
      estimator_(model, series.dt),
      judge_(model, limits_, options.world),
      controller_(model, limits_, series, options.controller) {
  model.sole(Side::left);  // says so when the robot has none
  const CommandSample& first = series.samples.front();
  set_scenario(options.scenario);
  planned_ = end_ =
      static_cast<long>(series.samples.size()) + std::lround(options.settle / series.dt);
  plant_.set_state(first.state);
  for (long i = 0; i < std::lround(kBeforeStart / h_); ++i)
    report_ = plant_.step(first.state.theta, {}, h_);
}

void Simulator::set_scenario(const std::vector<Disturbance>& scenario) {
  pushes_.clear();
  for (const Disturbance& d : scenario) {
    Push push{.source = d};
    push.first = std::lround(d.at / h_);
    push.count = std::max(1l, std::lround(d.duration / h_));
    push.per_step = d.type == DisturbanceType::impulse
                        ? d.magnitude / (static_cast<double>(push.count) * h_)
                        : d.magnitude;
    push.body = find_pushed_body(*model_, d.on);
    pushes_.push_back(push);
  }
  options_.scenario = scenario;
}

const CommandSample& Simulator::command(long k) const {
  const std::vector<CommandSample>& samples = series_->samples;
  return samples[std::min<size_t>(static_cast<size_t>(k), samples.size() - 1)];
}

double Simulator::time() const { return static_cast<double>(tick_) * series_->dt; }

std::vector<ExternalWrench> Simulator::wrenches(long step) {
  std::vector<ExternalWrench> result;
  for (const Push& push : pushes_) {
    if (step < push.first || step >= push.first + push.count) continue;
    const Disturbance& d = push.source;
    ExternalWrench w;
    const RobotData& data = plant_.data();
    Vector3d direction = d.direction;
    if (push.body >= 0) {
      const Eigen::Isometry3d pose = link_pose(*model_, data, push.body);
      w.body = model_->links()[push.body].body;
      w.point = pose * d.point;
      if (d.frame == DisturbanceFrame::link) direction = pose.linear() * direction;
    } else if (d.frame == DisturbanceFrame::link) {
      direction = data.rotation[model_->trunk_body()] * direction;
    }
    const Vector3d value =
        push.per_step * shape_factor(d, step - push.first, push.count) * direction;
    (d.type == DisturbanceType::torque ? w.torque : w.force) = value;
    result.push_back(w);
  }
  return result;
}

SimulationSample Simulator::sample(const CommandSample& cmd, const Estimate& estimate,
                                   const ControlOutput& out) {
  SimulationSample s;
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
  s.measured_cog = estimate.cog;
  s.measured_zmp = estimate.zmp;
  s.measured_fz = estimate.fz;
  Vector3d moment = Vector3d::Zero();
  for (int side = 0; side < 2; ++side) {
    Vector3d weighted = Vector3d::Zero();
    double vertical = 0;
    for (const SoleForce& cell : report_.soles[side]) {
      s.foot_force[side] += cell.force;
      weighted += cell.force.z() * cell.position;
      vertical += cell.force.z();
    }
    s.foot_cop[side] = vertical > 0
                           ? Vector3d(weighted / vertical)
                           : sole_pose(*model_, data, static_cast<Side>(side)).translation();
    s.planned_contact[side] = supports(cmd.support, static_cast<Side>(side));
    s.fz += vertical;
    moment += weighted;
  }
  if (s.fz > kZmpShare * model_->mass() * kGravity) zmp_ = moment / s.fz;
  s.zmp = zmp_;
  s.contact_residual = report_.contact_residual;
  s.contact_iterations = report_.contact_iterations;
  return s;
}

void Simulator::note(double t, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (noted_.insert(text).second) events_.push_back({t, "saturation", text});
}

void Simulator::step_once() {
  const double t = time();
  plan_ = controller_.plan();
  const CommandSample& cmd = plan_;
  const Measurement& measurement = sensors_.read(plant_.state(), plant_.data(), report_);
  estimate_ = estimator_.update(measurement, cmd.feet);
  const ControlOutput out = controller_.update(estimate_);
  last_ = sample(cmd, estimate_, out);
  if (!last_.state.theta.allFinite() || !last_.state.base.position.allFinite())
    fail(ErrorCode::internal,
         "the simulation left the finite numbers at t = " + text::fixed(t, 3) + " s");
  if (judge_.observe(t, cmd, last_, report_, series_->dt)) {
    fell_ = true;
    end_ = std::min(planned_, tick_ + std::lround(kAfterFall / series_->dt));
  }
  note(t, out.notes);
  for (int j : report_.saturated)
    note(t, {"torque limit of " + model_->dofs()[j].name + " reached"});

  for (int i = 0; i < options_.substeps; ++i) {
    const std::vector<ExternalWrench> w = wrenches(tick_ * options_.substeps + i);
    if (i == 0)
      for (const ExternalWrench& x : w) {
        last_.push_force += x.force;
        last_.push_point = x.body < 0 ? last_.cog : x.point;
      }
    report_ = plant_.step(out.target, w, h_);
  }
  if (keep_samples_) samples_.push_back(last_);
  ++tick_;
}

bool Simulator::advance(long ticks, const Progress& progress) {
  for (; ticks > 0 && tick_ < end_; --ticks) {
    if (tick_ % 100 == 0)
      ayumi::report(progress,
                    {"simulate", static_cast<double>(tick_) / static_cast<double>(planned_),
                     options_.controller.type});
    step_once();
  }
  return tick_ < end_;
}

SimulationResult Simulator::result() const {
  return Judge(judge_).conclude(controller_.plan(), plant_.state());
}

SimulationLog Simulator::take_log() {
  SimulationLog log;
  log.dt = series_->dt;
  log.controller = options_.controller.type;
  log.plant = options_.plant.name;
  log.world = options_.world;
  log.scenario = options_.scenario;
  log.joints = model_->dof_names();
  log.samples = std::move(samples_);
  samples_.clear();
  log.result = result();
  log.events = judge_.events();
  log.events.insert(log.events.end(), events_.begin(), events_.end());
  for (const Push& push : pushes_) {
    const Disturbance& d = push.source;
    const char* unit = d.type == DisturbanceType::impulse ? " N s"
                       : d.type == DisturbanceType::force ? " N"
                                                          : " N m";
    log.events.push_back({static_cast<double>(push.first) * h_, "push",
                          text::brief(d.magnitude) + unit + " on " + d.on});
  }
  std::stable_sort(log.events.begin(), log.events.end(),
                   [](const SimulationEvent& a, const SimulationEvent& b) { return a.t < b.t; });
  return log;
}

}  // namespace ayumi
