#include "ayumi/study/path_limits.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "ayumi/base/in_parallel.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::VectorXd;

namespace {

// Smallest s'. Definition: at a hundredth of the path's pace the robot is practically at rest.
constexpr double kLeastPace = 0.01;

// Time before and after a flight in which s' stays 1, in addition to the samples whose rates mix
// flight with support [s]. Derived: above half the reach of the smoothing of a timing
// (local_retime.cpp).
constexpr double kBesideFlight = 0.025;

// Steps of x (as a share of it) and of u [1/s] for the slopes of torques, whose shares between the
// feet are not linear. Chosen: small against the changes that matter and large against rounding.
constexpr double kStepX = 1e-3, kStepU = 1e-2;

// Tangential force, divided by the weight, at which the tip of the friction cone is rounded.
// Chosen: the same as in a repair, and small against mu.
constexpr double kConeRounding = 1e-4;

// A row counts as active if its distance from its bound is below this share of the sum of the sizes
// of its terms. Chosen: the step from point to point moves a row by about as much.
constexpr double kBinds = 0.01;

// Definition: the name that the rows have in limits/support.cpp.
const char* const kSupportRows = "support";

// Limits of the posture and of the commands do not depend on time, and the rows of a landing are
// only soft goals.
bool bounds_time(const Limit& limit) {
  return limit.place_rows &&
         std::any_of(limit.findings.begin(), limit.findings.end(), [](const FindingSpec& spec) {
           return (spec.limit_class == LimitClass::rate || spec.limit_class == LimitClass::force) &&
                  spec.kind != FindingKind::landing_speed;
         });
}

bool is_linear_in_time(const RowBlock& block) {
  return std::holds_alternative<WrenchRows>(block.rule) ||
         std::holds_alternative<JointRow>(block.rule);
}

// Values and slopes of a block's rows at (u, x) for one point.
struct Slopes {
  VectorXd value, of_u, of_x;
};

// The motion of a sample at another pace.
CommandSample played(const CommandSample& sample, double u, double x) {
  CommandSample result = sample;
  const double pace = std::sqrt(x);
  VectorXd rate(sample.acceleration.size());
  rate << sample.state.base_velocity, sample.state.base_angular_velocity, sample.state.dtheta;
  result.acceleration = x * sample.acceleration + u * rate;
  result.state.base_velocity *= pace;
  result.state.base_angular_velocity *= pace;
  result.state.dtheta *= pace;
  return result;
}

}  // namespace

PathLimits::PathLimits(const RobotModel& model, const CommandSeries& series,
                       const PathLimitOptions& options)
    : model_(model),
      series_(series),
      options_(options),
      actuators_(model.limits(options.check.profile)),
      plan_(contact_plan(series)) {
  place_points(options);
  place_rows();
  compute_forces();
  timing_.resize(sites_.size());
  origins_.resize(sites_.size());
  cap_.resize(sites_.size());
  for (size_t i = 0; i < sites_.size(); ++i) timing_[i].at = sites_[i].sample * series.dt;
}

template <class Work>
void PathLimits::for_each_point(const Work& work) const {
  constexpr size_t kBlock =
      64;  // points per job. Chosen: enough work for a thread, and few threads wait at the end
  std::atomic<bool> stop = false;
  in_parallel(
      (sites_.size() + kBlock - 1) / kBlock, options_.check.threads, stop, [&](size_t block) {
        RobotData data(model_);
        for (size_t i = block * kBlock; i < std::min(sites_.size(), (block + 1) * kBlock); ++i)
          work(i, data);
      });
}

void PathLimits::place_points(const PathLimitOptions& options) {
  const int count = static_cast<int>(series_.samples.size());
  const int every = std::max(1, static_cast<int>(std::lround(options.spacing / series_.dt)));
  const int beside = static_cast<int>(std::ceil(kBesideFlight / series_.dt));
  std::vector<char> fixed(static_cast<size_t>(count), 0);
  for (int k = 0; k < count; ++k) {
    if (series_.samples[static_cast<size_t>(k)].support != Support::none &&
        !at_flight_edge(series_, k))
      continue;
    flies_ = true;
    std::fill(fixed.begin() + std::max(0, k - beside),
              fixed.begin() + std::min(count, k + beside + 1), 1);
  }
  std::vector<int> samples;
  for (int k = 0; k < count - 1; k += every) samples.push_back(k);
  samples.push_back(count - 1);
  for (const int k : samples) {
    CollocationPoint point;
    point.sample = k;
    point.forces_known = !at_flight_edge(series_, k);
    for (const Side side : {Side::left, Side::right}) {
      const ContactInterval& here = plan_.at(side, k);
      point.contact[static_cast<size_t>(side)] = here.contact;
      point.ground[static_cast<size_t>(side)] = here.sole;
    }
    point.plane = support_plane(model_, plan_.support(k), point.ground);
    sites_.push_back(std::move(point));
    fixed_.push_back(fixed[static_cast<size_t>(k)]);
    const double t = k * series_.dt;
    paused_.push_back(
        std::any_of(options.pauses.begin(), options.pauses.end(),
                    [t](const TimeSpan& pause) { return t >= pause.first && t <= pause.second; }));
  }
}

void PathLimits::place_rows() {
  const Tolerances tolerances = ayumi::tolerances(options_.check, model_, series_);
  const std::vector<const CommandSeries*> seen;
  RowSettings settings;  // with shares of 0 and 1, every limit has its rows just at the limit
  settings.support.least = std::min(options_.least_margin, options_.most_margin);
  settings.support.safe = options_.most_margin;
  settings.support.own_share = options_.own_margin;
  settings.own_roughness = false;
  settings.normal_force.light = kUnbounded;
  settings.friction.rounding = kConeRounding;
  RowSite site = {.model = model_,
                  .series = series_,
                  .plan = plan_,
                  .points = sites_,
                  .seen = seen,
                  .tolerances = tolerances,
                  .actuators = actuators_,
                  .friction = options_.check.friction,
                  .settings = settings};
  for (const Limit* limit : limits())
    if (bounds_time(*limit)) limit->place_rows(site);
  rows_ = std::move(site.rows);
  rows_of_.assign(sites_.size(), {});
  for (const RowBlock& row : rows_) {
    const auto point = static_cast<size_t>(row.point);
    if (!fixed_[point] && is_linear_in_time(row)) rows_of_[point].push_back(&row);
  }
}

void PathLimits::compute_forces() {
  forces_.resize(sites_.size());
  for_each_point([&](size_t i, RobotData& data) {
    const CommandSample& sample = series_.samples[static_cast<size_t>(sites_[i].sample)];
    const CommandSample still = played(sample, 0, 0);
    const CommandSample pulled = played(sample, 1, 0);
    Forces& f = forces_[i];
    f.rest = inverse_dynamics(model_, still.state, still.acceleration, data);
    f.of_u = inverse_dynamics(model_, pulled.state, pulled.acceleration, data) - f.rest;
    f.of_x = inverse_dynamics(model_, sample.state, sample.acceleration, data) - f.rest;
  });
}

void PathLimits::linearize_point(size_t i, double u, double x, double share, RobotData& data) {
  TimingPoint& point = timing_[i];
  point.rows.clear();
  origins_[i].clear();
  cap_[i] = nullptr;
  point.least = fixed_[i] ? 1 : kLeastPace * kLeastPace;
  point.most = fixed_[i] || paused_[i] ? 1 : options_.most_pace * options_.most_pace;
  const CollocationPoint& site = sites_[i];
  const CommandSample& sample = series_.samples[static_cast<size_t>(site.sample)];
  const Forces& f = forces_[i];
  const VectorXd &rate = sample.state.dtheta, bend = sample.acceleration.tail(rate.size());
  const double pace = std::sqrt(x);

  const auto add = [&](const RowBlock& block, double a, double b, double most) {
    if (most > 0) most *= share;
    if (flies_) most = std::max(most, b);
    point.rows.push_back({a, b, most});
    origins_[i].push_back(&block);
  };
  const auto add_both = [&](const RowBlock& block, int row, double value, double a, double b) {
    // The part that does not depend on u and x, by the tangent.
    const double still = value - a * u - b * x;
    if (block.upper[row] < kUnbounded) add(block, a, b, block.upper[row] - still);
    if (block.lower[row] > -kUnbounded) add(block, -a, -b, still - block.lower[row]);
  };
  const auto cap = [&](const RowBlock& block, double most_pace) {
    const double most = std::max(most_pace * most_pace, flies_ ? 1.0 : 0.0);
    if (!(most_pace > 0) || most >= point.most) return;
    point.most = most;
    cap_[i] = block.kind;
  };

  const auto wrench = [&](const VectorXd& force) {
    return plane_wrench(site.plane, sample.state.base.position, force.head<6>());
  };
  const Vector6d of_u = wrench(f.of_u), of_x = wrench(f.of_x);
  const Vector6d w = wrench(f.rest) + u * of_u + x * of_x;

  Slopes torque;
  const auto find_torques = [&] {
    const RobotState& state = sample.state;
    update_positions(model_, state, data);
    const auto at = [&](double du, double dx) {
      const VectorXd force = f.rest + (u + du) * f.of_u + (x + dx) * f.of_x;
      const CommandSample now = played(sample, u + du, x + dx);
      const auto feet = shared_load(model_, site, state.base.position, force.head<6>());
      return motor_torques(model_, actuators_, now.state, now.acceleration, force, feet, data);
    };
    const double h = kStepX * x;
    torque.value = at(0, 0);
    torque.of_u = (at(kStepU, 0) - at(-kStepU, 0)) / (2 * kStepU);
    torque.of_x = (at(0, h) - at(0, -h)) / (2 * h);
  };

  for (const RowBlock* each : rows_of_[i]) {
    const RowBlock& block = *each;
    if (const auto* rows = std::get_if<WrenchRows>(&block.rule)) {
      const VectorXd value = rows->value(w);
      const Eigen::MatrixXd gradient = rows->gradient(w);
      const VectorXd a = gradient * of_u, b = gradient * of_x;
      for (int k = 0; k < block.rows(); ++k) add_both(block, k, value[k], a[k], b[k]);
      continue;
    }
    const JointRow& row = std::get<JointRow>(block.rule);
    const double v = row.scale * rate[row.dof], a = row.scale * bend[row.dof];
    const double lower = block.lower[0], upper = block.upper[0];
    switch (row.of) {
      case JointQuantity::acceleration:
        add_both(block, 0, v * u + a * x, v, a);
        break;
      case JointQuantity::speed:  // v s' + lead (v u + a x)
        if (row.lead == 0)
          cap(block, std::sqrt(share) * (v > 0 ? upper / v : lower / v));
        else
          add_both(block, 0, v * pace + row.lead * (v * u + a * x), row.lead * v,
                   v / (2 * pace) + row.lead * a);
        break;
      case JointQuantity::angle: {  // theta + lead v s'
        const double at = row.scale * sample.state.theta[row.dof], lead = row.lead * v;
        if (lead != 0) cap(block, ((lead > 0 ? upper : lower) - at) / lead);
        break;
      }
      case JointQuantity::motor_torque:
        if (torque.value.size() == 0) find_torques();
        add_both(block, 0, row.scale * torque.value[row.dof], row.scale * torque.of_u[row.dof],
                 row.scale * torque.of_x[row.dof]);
        break;
    }
  }
}

void PathLimits::linearize(const std::vector<double>& u, const std::vector<double>& x,
                           const std::vector<double>& share) {
  for_each_point(
      [&](size_t i, RobotData& data) { linearize_point(i, u[i], x[i], share[i], data); });
}

std::vector<PathRow> PathLimits::rows_at(int point) const {
  const auto i = static_cast<size_t>(point);
  std::vector<PathRow> result;
  for (size_t r = 0; r < timing_[i].rows.size(); ++r)
    result.push_back({origins_[i][r]->kind, origins_[i][r]->item, timing_[i].rows[r]});
  return result;
}

PathLimits::UniformPace PathLimits::uniform_pace() {
  const std::vector<double> zero(sites_.size(), 0), one(sites_.size(), 1);
  linearize(zero, one, one);
  UniformPace result{true, options_.most_pace};
  double most = options_.most_pace * options_.most_pace;
  for (size_t i = 0; i < timing_.size(); ++i) {
    most = std::min(most, timing_[i].most);
    for (const PathRow& at : rows_at(static_cast<int>(i))) {
      result.keeps = result.keeps && at.row.x <= at.row.most + 1e-9;
      if (at.kind->name != kSupportRows && at.row.x > 0)
        most = std::min(most, at.row.most / at.row.x);
    }
  }
  result.pace = std::sqrt(std::max(0.0, most));
  result.keeps = result.keeps && most >= 1;
  return result;
}

std::vector<BindingLimit> PathLimits::binding(const std::vector<double>& u,
                                              const std::vector<double>& x,
                                              const std::vector<double>& times) const {
  std::map<std::string, double> time;
  double all = 0;
  for (size_t i = 0; i + 1 < timing_.size(); ++i) {
    const TimingPoint& point = timing_[i];
    std::string limit;
    double least = kBinds;
    for (size_t end : {i, i + 1}) {  // the rows of both ends also hold for u
      for (const auto& [kind, item, row] : rows_at(static_cast<int>(end))) {
        const double room = row.most - row.u * u[i] - row.x * x[end];
        const double size = std::abs(row.u * u[i]) + std::abs(row.x * x[end]) + std::abs(row.most);
        if (room >= least * size) continue;
        least = room / size;
        limit = kind->name;
      }
    }
    if (x[i] >= point.most * (1 - kBinds)) limit = cap_[i] ? cap_[i]->name : "pace";
    if (paused_[i]) limit = "pause";
    const double lasts = times[i + 1] - times[i];
    time[limit] += lasts;
    all += lasts;
  }
  std::vector<BindingLimit> result;
  for (const auto& [limit, lasts] : time) result.push_back({limit, lasts / all});
  std::stable_sort(result.begin(), result.end(),
                   [](const BindingLimit& a, const BindingLimit& b) { return a.share > b.share; });
  return result;
}

std::string PathLimits::broken_at(int point) const {
  std::string names;
  const auto add = [&](const char* name) {
    if (names.find(name) == std::string::npos)
      names += (names.empty() ? "" : ", ") + std::string(name);
  };
  for (const PathRow& at : rows_at(point))
    if (at.row.most < 0) add(at.kind->name);
  return names;
}

}  // namespace ayumi
