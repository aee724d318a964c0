// Per control tick k: measure (forces of the step that ended at k dt) -> estimate -> controller ->
// log -> integrator sub-steps with the targets held and the disturbances of exactly those steps.
#include "ayumi/sim/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/control/dtad.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/sim/plant.hpp"
#include "ayumi/sim/sensors.hpp"
#include "ayumi/sim/verdict.hpp"

namespace ayumi {

using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kBeforeStart = 0.4;  // servos hold the first posture this long before t = 0 [s]
constexpr double kAfterFall = 0.8;    // of simulation kept after a fall [s]
constexpr double kZmpShare = 0.02;    // of the weight below which the ZMP is held

/// A disturbance laid out on integrator steps.
struct Push {
  const Disturbance* source;
  long first = 0, count = 1;
  int body = -1;
  double per_step = 0;  // force or torque of a rectangle [N] or [N m]
};

std::vector<Push> schedule(const RobotModel& model, const std::vector<Disturbance>& scenario,
                           double h) {
  std::vector<Push> pushes;
  for (const Disturbance& d : scenario) {
    Push push{&d};
    push.first = std::lround(d.at / h);
    push.count = std::max(1l, std::lround(d.duration / h));
    push.per_step = d.type == DisturbanceType::impulse
                        ? d.magnitude / (static_cast<double>(push.count) * h)
                        : d.magnitude;
    if (d.on != "cog") {
      const int link = model.find_link(d.on);
      if (link < 0) {
        std::vector<std::string> names;
        for (const Link& l : model.links()) names.push_back(l.name);
        fail(ErrorCode::bad_pattern, "scenario: " + model.name() + " has no link '" + d.on + "'" +
                                         text::suggestion(d.on, names) +
                                         " ('cog' pushes through the centre of gravity)");
      }
      push.body = link;
    }
    pushes.push_back(push);
  }
  return pushes;
}

/// Share of the rectangle's value in step i of n; the mean over the steps is 1 for impulses.
double shape_factor(const Disturbance& d, long i, long n) {
  if (d.shape == DisturbanceShape::rectangle) return 1.0;
  const double phase = M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  if (d.type != DisturbanceType::impulse) return std::sin(phase);
  // The sum of sin over midpoints is 1 / sin(pi / 2n).
  return static_cast<double>(n) * std::sin(M_PI / (2.0 * static_cast<double>(n))) *
         std::sin(phase);
}

class Loop {
 public:
  Loop(const RobotModel& model, const CommandSeries& series, const SimulateOptions& options)
      : model_(model),
        series_(series),
        options_(options),
        limits_(model.limits(options.profile)),
        h_(series.dt / options.substeps),
        plant_(model, limits_, options.world),
        sensors_(model, series.dt, options.sensor_noise, options.seed),
        estimator_(model, series.dt),
        judge_(model, limits_, options.world),
        data_(model),
        lead_(servo_lead(model)),
        pushes_(schedule(model, options.scenario, h_)) {
    const std::string& type = options.controller.type;
    if (type == "dtad" || type == "dtad-literal")
      dtad_.emplace(model, limits_, dtad_params(model, options.controller), series.dt,
                    series.samples.front());
    else if (type != "none")
      fail(ErrorCode::usage, "unknown controller '" + type + "'" +
                                 text::suggestion(type, {"none", "dtad", "dtad-literal"}) +
                                 " (known: none, dtad, dtad-literal)");
  }

  SimulationLog run(const Progress& progress);

 private:
  const CommandSample& command(long k) const {
    return series_.samples[std::min<size_t>(static_cast<size_t>(k), series_.samples.size() - 1)];
  }
  ControlOutput control(long k, const Estimate& estimate);
  SimulationSample sample(const CommandSample& cmd, const Estimate& estimate,
                          const ControlOutput& out);
  std::vector<ExternalWrench> wrenches(long step);
  void note(double t, const std::vector<std::string>& texts);

  const RobotModel& model_;
  const CommandSeries& series_;
  const SimulateOptions& options_;
  ActuatorLimits limits_;
  double h_;
  Plant plant_;
  Sensors sensors_;
  Estimator estimator_;
  Judge judge_;
  RobotData data_;
  VectorXd lead_;
  std::vector<Push> pushes_;
  std::optional<Dtad> dtad_;
  StepReport report_;
  Vector3d zmp_ = Vector3d::Zero();
  std::set<std::string> noted_;
  std::vector<SimulationEvent> events_;
};

std::vector<ExternalWrench> Loop::wrenches(long step) {
  std::vector<ExternalWrench> result;
  for (const Push& push : pushes_) {
    if (step < push.first || step >= push.first + push.count) continue;
    const Disturbance& d = *push.source;
    ExternalWrench w;
    update_positions(model_, plant_.state(), data_);
    Vector3d direction = d.direction;
    if (push.body >= 0) {
      const Eigen::Isometry3d pose = link_pose(model_, data_, push.body);
      w.body = model_.links()[push.body].body;
      w.point = pose * d.point;
      if (d.frame == DisturbanceFrame::link) direction = pose.linear() * direction;
    } else if (d.frame == DisturbanceFrame::link) {
      direction = data_.rotation[model_.trunk_body()] * direction;
    }
    const Vector3d value =
        push.per_step * shape_factor(d, step - push.first, push.count) * direction;
    (d.type == DisturbanceType::torque ? w.torque : w.force) = value;
    result.push_back(w);
  }
  return result;
}

ControlOutput Loop::control(long k, const Estimate& estimate) {
  const CommandSample& cmd = command(k);
  if (dtad_) return dtad_->update(cmd, command(k + 1), estimate);
  ControlOutput out;
  out.reference = cmd.state;
  out.target = cmd.state.theta + lead_.cwiseProduct(cmd.state.dtheta);
  out.cog = cmd.cog;
  out.cog_reference.zmp = cmd.zmp;
  out.cog_reference.fz = cmd.fz;
  out.cog_reference.dcog = cmd.dcog;
  return out;
}

SimulationSample Loop::sample(const CommandSample& cmd, const Estimate& estimate,
                              const ControlOutput& out) {
  SimulationSample s;
  s.state = plant_.state();
  update_velocities(model_, s.state, data_);
  s.cog = data_.cog;
  s.dcog = data_.dcog;
  s.target = out.target;
  s.torque = report_.torque;
  s.reference_base = out.reference.base;
  s.reference_theta = out.reference.theta;
  s.reference_cog = out.cog;
  s.reference_zmp = out.cog_reference.zmp;
  s.reference_fz = out.cog_reference.fz;
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
                           : sole_pose(model_, data_, static_cast<Side>(side)).translation();
    s.planned_contact[side] = supports(cmd.support, static_cast<Side>(side));
    s.fz += vertical;
    moment += weighted;
  }
  if (s.fz > kZmpShare * model_.mass() * kGravity) zmp_ = moment / s.fz;
  s.zmp = zmp_;
  s.contact_residual = report_.contact_residual;
  s.contact_iterations = report_.contact_iterations;
  return s;
}

void Loop::note(double t, const std::vector<std::string>& texts) {
  for (const std::string& text : texts)
    if (noted_.insert(text).second) events_.push_back({t, "saturation", text});
}

SimulationLog Loop::run(const Progress& progress) {
  const double dt = series_.dt;
  const std::vector<ExternalWrench> none;
  plant_.set_state(series_.samples.front().state);
  const VectorXd first = series_.samples.front().state.theta;
  for (long i = 0; i < std::lround(kBeforeStart / h_); ++i)
    report_ = plant_.step(first, none, h_);

  SimulationLog log;
  log.dt = dt;
  log.controller = options_.controller.type;
  log.world = options_.world;
  log.scenario = options_.scenario;
  log.joints = model_.dof_names();
  const long planned = static_cast<long>(series_.samples.size()) + std::lround(options_.settle / dt);
  long ticks = planned;
  log.samples.reserve(static_cast<size_t>(planned));
  for (long k = 0; k < ticks; ++k) {
    const double t = static_cast<double>(k) * dt;
    if (k % 100 == 0)
      ayumi::report(progress, {"simulate", static_cast<double>(k) / static_cast<double>(planned),
                               options_.controller.type});
    const CommandSample& cmd = command(k);
    const Measurement measurement = sensors_.read(plant_.state(), report_);
    Estimate estimate = estimator_.update(measurement, cmd.feet);
    const ControlOutput out = control(k, estimate);
    log.samples.push_back(sample(cmd, estimate, out));
    SimulationSample& s = log.samples.back();
    if (!s.state.theta.allFinite() || !s.state.base.position.allFinite())
      fail(ErrorCode::internal, "the simulation left the finite numbers at t = " +
                                    text::fixed(t, 3) + " s");
    if (judge_.observe(t, cmd, s, report_, dt))
      ticks = std::min(planned, k + std::lround(kAfterFall / dt));
    note(t, out.notes);
    for (int j : report_.saturated)
      note(t, {"torque limit of " + model_.dofs()[j].name + " reached"});

    for (int i = 0; i < options_.substeps; ++i) {
      const long step = k * options_.substeps + i;
      const std::vector<ExternalWrench> w = wrenches(step);
      if (i == 0)
        for (const ExternalWrench& x : w) {
          s.push_force += x.force;
          s.push_point = x.body < 0 ? s.cog : x.point;
        }
      report_ = plant_.step(out.target, w, h_);
    }
  }
  log.result = judge_.conclude(command(planned), plant_.state());
  for (const Push& push : pushes_) {
    const Disturbance& d = *push.source;
    events_.push_back({static_cast<double>(push.first) * h_, "push",
                       text::brief(d.magnitude) +
                           (d.type == DisturbanceType::impulse ? " N s"
                            : d.type == DisturbanceType::force ? " N"
                                                               : " N m") +
                           " on " + d.on});
  }
  log.events = judge_.events();
  log.events.insert(log.events.end(), events_.begin(), events_.end());
  std::stable_sort(log.events.begin(), log.events.end(),
                   [](const SimulationEvent& a, const SimulationEvent& b) { return a.t < b.t; });
  return log;
}

}  // namespace

SimulationLog simulate(const RobotModel& model, const CommandSeries& series,
                       const SimulateOptions& options, const Progress& progress) {
  if (series.samples.empty()) fail(ErrorCode::bad_pattern, "the command series is empty");
  if (options.substeps < 1) fail(ErrorCode::usage, "substeps must be at least 1");
  model.sole(Side::left);  // says so when the robot has none
  return Loop(model, series, options).run(progress);
}

ReferenceTrajectory extract_reference(const RobotModel& model, const SimulationLog& log) {
  ReferenceTrajectory table;
  table.dt = log.dt;
  table.joints = model.dof_names();
  table.provenance = log.provenance;
  for (const SimulationSample& s : log.samples) {
    ReferenceRow row;
    row.theta = s.target;
    row.base = s.reference_base;
    row.cog = s.reference_cog;
    row.zmp = s.reference_zmp;
    row.fz = s.reference_fz;
    row.contact = s.planned_contact;
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace ayumi
