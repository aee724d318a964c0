#include "ayumi/study/uncertain_task.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/math/statistics.hpp"
#include "ayumi/model/device_limits.hpp"
#include "ayumi/sim/payload.hpp"
#include "ayumi/sim/simulator.hpp"

namespace ayumi {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Distance of the nodes of uneven ground [m]. Chosen: two to five nodes under a sole of 63 mm x 98
/// mm, so that a sole rests on several of them.
constexpr double kHollowSpacing = 0.02;
/// Width of the uneven ground around the planned soles [m]. Chosen: wider than a sole and a slip of
/// a few centimetres; beyond it the ground is a plane.
constexpr double kHollowMargin = 0.2;
/// Severity of a fall at the start of a run. Definition: the severity decreases by 1 per second
/// until the fall, and even after an hour it is far above that of a run that has not settled.
constexpr double kFallSeverity = 1e6;

/// Random numbers that depend on a seed, a number and a name (FNV-1a over the name).
Random named_random(std::uint64_t seed, long number, const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  const std::uint64_t mixed = Random(seed).bits() ^ hash;
  return Random(Random(mixed).bits() + static_cast<std::uint64_t>(number));
}

/// A standard normal number that is never infinite.
double normal_number(Random random) {
  return normal_quantile((static_cast<double>(random.bits() >> 11) + 0.5) * 0x1.0p-53);
}

/// Whether `name` has the form of `pattern`, in which * stands for any text.
bool has_form(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*')
    return !name.empty() && pattern[0] == name[0] && has_form(pattern.substr(1), name.substr(1));
  for (size_t skip = 0; skip <= name.size(); ++skip)
    if (has_form(pattern.substr(1), name.substr(skip))) return true;
  return false;
}

[[noreturn]] void refuse(const SourcePlace& place, const std::string& why) {
  fail(ErrorCode::bad_pattern, place, why);
}

bool has_noise(const SensorDescription& s) {
  return s.attitude_noise > 0 || s.gyro_noise > 0 || s.accelerometer_noise > 0 || s.force_noise > 0;
}

/// The smallest value that a quantity of this kind can have.
double least_of(UncertainKind kind) {
  // A push of a negative size would be one in the opposite direction, with another capture bound.
  if (kind == UncertainKind::push_size || kind == UncertainKind::push_time) return 0;
  return info(kind).least;
}

/// The largest value that a quantity of this kind can have: the largest one that a robot's sidecar
/// may state, or infinity.
double most_of(UncertainKind kind) {
  if (kind == UncertainKind::servo_delay) return kMostServoDelay;
  if (kind == UncertainKind::backlash) return kMostServoPlay;
  if (kind == UncertainKind::sensor_latency) return kMostSensorLatency;
  return std::numeric_limits<double>::infinity();
}

/// A value in words with its unit. A factor follows "times", and a value that can be negative has a
/// sign.
std::string amount_words(UncertainKind kind, double value) {
  const auto with = [&](const std::string& unit, double scale = 1) {
    const bool is_signed = std::isinf(info(kind).least) && value > 0;
    return (is_signed ? "+" : "") + text::brief(scale * value, 4) + unit;
  };
  const double degree = 180 / std::numbers::pi;
  switch (kind) {
    case UncertainKind::mass:
    case UncertainKind::inertia:
    case UncertainKind::sole_stiffness:
    case UncertainKind::sole_damping:
    case UncertainKind::servo_kp:
    case UncertainKind::servo_kd:
    case UncertainKind::sensor_noise:
      return "times " + text::brief(value, 4);
    case UncertainKind::friction:
    case UncertainKind::push_link:
      return text::brief(value, 4);
    case UncertainKind::cog:
    case UncertainKind::bumps:
      return with(" m");
    case UncertainKind::slope:
    case UncertainKind::backlash:
    case UncertainKind::encoder_offset:
    case UncertainKind::attitude_bias:
    case UncertainKind::push_direction:
      return with(" deg", degree);
    case UncertainKind::gyro_bias:
      return with(" deg/s", degree);
    case UncertainKind::servo_friction:
      return with(" N m");
    case UncertainKind::servo_delay:
    case UncertainKind::sensor_latency:
    case UncertainKind::push_time:
      return text::brief(value, 4) + " s";
    case UncertainKind::load_bias:
      return with(" N");
    case UncertainKind::payload:
      return with(" kg");
    case UncertainKind::push_size:
      return text::brief(value, 4) + " N s";
  }
  return text::brief(value, 4);
}

/// The name of a value, in which an axis is named as such: "slope about x", "cog along y of trunk".
std::string name_text(const DrawnValue& value) {
  if (value.push >= 0 || !info(value.quantity->kind).axis) return value.name;
  const std::string kind = info(value.quantity->kind).name + " ";
  if (!value.name.starts_with(kind)) return value.name;  // the user has named the quantity
  const bool is_length = value.quantity->kind == UncertainKind::cog;
  return kind + (is_length ? "along " : "about ") + value.name.substr(kind.size());
}

/// The time at which a run that does not fall ends [s].
double run_end(const CommandSeries& series, const SimulateOptions& options) {
  return static_cast<double>(static_cast<long>(series.samples.size()) +
                             std::lround(options.settle / series.dt)) *
         series.dt;
}

/// The link that carries the trunk.
std::string trunk_of(const RobotModel& model) {
  const std::string& trunk = model.description().trunk_link;
  return trunk.empty() ? model.links().front().name : trunk;
}

constexpr const char* kPushParts[] = {"size", "direction", "time", "link"};

}  // namespace

double severity(const CaseResult& r) {
  if (r.outcome == Outcome::fell) return kFallSeverity - r.fell_at;
  return r.cog_error + (r.outcome == Outcome::stands ? 0.0 : kFailedSeverity);
}

UncertainTask::UncertainTask(const RobotModel& model, const CommandSeries& series,
                             const Uncertainty& uncertainty, const SimulateOptions& options)
    : model_(&model),
      series_(&series),
      controller_(model, model.limits(options.profile), series, options.controller),
      uncertainty_(&uncertainty),
      options_(options) {
  options_.sensor_noise = true;
  for (const UncertainQuantity& quantity : uncertainty.quantities) add_quantity(quantity);
  for (size_t i = 0; i < uncertainty.pushes.size(); ++i) {
    const UncertainPush& push = uncertainty.pushes[i];
    const UncertainQuantity* parts[] = {&push.size, &push.direction, &push.time, &push.link};
    for (size_t part = 0; part < std::size(parts); ++part)
      add_value(push.name + ": " + kPushParts[part], *parts[part], {}, static_cast<int>(i));
    for (const std::string& link : push.links) {
      if (link == "cog" || link == "trunk" || model.find_link(link) >= 0) continue;
      std::vector<std::string> names = {"cog", "trunk"};
      for (const Link& each : model.links()) names.push_back(each.name);
      refuse(push.link.place, model.name() + " has no link '" + link +
                                  "'. A push acts on a link, on \"trunk\" or on \"cog\"" +
                                  text::suggestion(link, names));
    }
    if (push.bounds && !series.viip.empty())
      refuse(push.size.place,
             "the pattern has VIIP goals, so it has no planned footholds, and the capture bound is "
             "not known. Give the size in N s");
    if (push.phases && phases_.empty()) {
      for (const PushPhase& phase : default_push_phases(model, series, options_))
        if (!phase.standing) phases_.push_back(phase);
      for (const PushPhase& phase : phases_)
        regions_.push_back(capture_region(model, series, std::lround(phase.at / series.dt)));
    }
  }
  for (const UncertainFactor& factor : uncertainty.factors) {
    const bool used = std::any_of(values_.begin(), values_.end(), [&](const DrawnValue& v) {
      return v.quantity->factor == factor.name;
    });
    if (!used)
      refuse(factor.place, "no quantity uses the factor '" + factor.name +
                               "'. Name the factor in a quantity, or leave the factor out");
  }
  dimension_ = normal_names_.size();
}

void UncertainTask::add_value(const std::string& name, const UncertainQuantity& quantity,
                              std::vector<int> targets, int push) {
  const auto number_of = [&](const std::string& wanted) {
    const auto found = std::find(normal_names_.begin(), normal_names_.end(), wanted);
    if (found != normal_names_.end()) return static_cast<size_t>(found - normal_names_.begin());
    normal_names_.push_back(wanted);
    return normal_names_.size() - 1;
  };
  DrawnValue value{name, &quantity, std::move(targets), push, number_of(name), {}};
  if (!quantity.factor.empty()) value.factor = number_of("factor " + quantity.factor);
  values_.push_back(std::move(value));
}

void UncertainTask::add_quantity(const UncertainQuantity& q) {
  using Target = UncertainKindInfo::Target;
  const Target target = info(q.kind).target;
  if (q.kind == UncertainKind::sensor_noise && !has_noise(model_->description().sensors))
    refuse(q.place, "this quantity has no effect: the sensors of " + model_->name() +
                        " have no noise in the sidecar. State their noise, or remove the quantity");
  if (q.kind == UncertainKind::bumps && !options_.world.fields.empty())
    refuse(
        q.place,
        "the ground of the pattern already has a height field. Remove that field or this quantity");
  if (target == Target::none) return add_value(q.name, q, {}, -1);
  std::vector<int> found;
  std::vector<std::string> names;
  if (target == Target::link) {
    const std::string wanted = q.on == "trunk" ? trunk_of(*model_) : q.on;
    for (size_t i = 0; i < model_->links().size(); ++i) {
      const Link& link = model_->links()[i];
      names.push_back(link.name);
      const bool has_mass = link.inertia.mass > 0 || q.kind == UncertainKind::payload;
      if (has_mass && (wanted.empty() || has_form(wanted, link.name)))
        found.push_back(static_cast<int>(i));
    }
  } else {
    const ActuatorLimits& limits = model_->limits(options_.profile);
    for (int j = 0; j < model_->dof_count(); ++j) {
      const std::string& name = model_->dofs()[static_cast<size_t>(j)].name;
      names.push_back(name);
      if (limits.has_servo[static_cast<size_t>(j)] && (q.on.empty() || has_form(q.on, name)))
        found.push_back(j);
    }
  }
  if (found.empty())
    refuse(q.place, "this quantity has no effect: " + model_->name() +
                        (target == Target::link ? " has no link" : " has no joint") +
                        (q.on.empty() ? "" : " '" + q.on + "'") +
                        (q.kind == UncertainKind::payload ? ""
                         : target == Target::link         ? " with a mass"
                                                          : " with a servo") +
                        text::suggestion(q.on, names));
  if (!q.each) return add_value(q.name, q, found, -1);
  for (const int i : found) {
    const size_t k = static_cast<size_t>(i);
    add_value(q.name + " of " +
                  (target == Target::link ? model_->links()[k].name : model_->dofs()[k].name),
              q, {i}, -1);
  }
}

CaseNumbers UncertainTask::numbers(std::uint64_t seed, long number) const {
  CaseNumbers result;
  result.normal.reserve(dimension_);
  for (const std::string& name : normal_names_)
    result.normal.push_back(normal_number(named_random(seed, number, name)));
  result.noise = named_random(seed, number, "noise").bits();
  return result;
}

std::vector<double> UncertainTask::shares(const CaseNumbers& numbers) const {
  std::vector<double> result;
  result.reserve(values_.size());
  for (const DrawnValue& value : values_) {
    double z = numbers.normal[value.own];
    if (value.factor) {
      const double r = value.quantity->correlation;
      z = r * numbers.normal[*value.factor] + std::sqrt(1 - r * r) * z;
    }
    result.push_back(std::clamp(normal_probability(z), 0x1.0p-54, 1 - 0x1.0p-53));
  }
  return result;
}

std::vector<double> UncertainTask::draw(const CaseNumbers& numbers) const {
  std::vector<double> result = shares(numbers);
  for (size_t i = 0; i < values_.size(); ++i) {
    const DrawnValue& value = values_[i];
    // The phases of a pattern are only known here.
    const bool phase = value.push >= 0 && value.quantity->kind == UncertainKind::push_time &&
                       uncertainty_->pushes[static_cast<size_t>(value.push)].phases;
    result[i] = phase ? std::floor(result[i] * static_cast<double>(phases_.size()))
                      : quantile(value.quantity->distribution, result[i]);
  }
  return result;
}

void UncertainTask::check(const std::vector<double>& drawn, const std::string& which) const {
  const double end = run_end(*series_, options_);
  for (size_t i = 0; i < values_.size(); ++i) {
    const UncertainQuantity& q = *values_[i].quantity;
    const bool named_phase = q.kind == UncertainKind::push_time &&
                             uncertainty_->pushes[static_cast<size_t>(values_[i].push)].phases;
    if (named_phase) continue;
    const bool positive = q.kind == UncertainKind::mass || q.kind == UncertainKind::inertia ||
                          q.kind == UncertainKind::sole_stiffness ||
                          q.kind == UncertainKind::servo_kp;
    const double least = least_of(q.kind), most = most_of(q.kind);
    const auto complain = [&](const std::string& why) {
      refuse(q.place, which + " draws " + text::brief(drawn[i]) + " for the " + values_[i].name +
                          " (" + info(q.kind).meaning + "), but " + why);
    };
    if (!(drawn[i] >= least) || (positive && drawn[i] == least))
      complain(std::string("the value must ") + (positive ? "be above 0" : "not be negative") +
               ". Bound the distribution, for example with \"truncated\"");
    if (drawn[i] > most)
      complain("the largest value allowed is " + text::brief(most) +
               ". Check the unit, and bound the distribution, for example with \"truncated\"");
    if (q.kind == UncertainKind::push_time && drawn[i] >= end)
      complain("the run ends at " + text::brief(end) +
               " s, so the push would have no effect. Give an earlier time [s]");
  }
}

RobotUnit UncertainTask::unit(const std::vector<double>& drawn) const {
  RobotDescription d = model_->description();
  ActuatorLimits actuators = model_->limits(options_.profile);
  std::vector<CarriedMass> loads;
  for (const Side side : {Side::left, Side::right}) {
    // Values that the model derived from its own mass do not change when the mass changes.
    SoleDescription& sole = d.soles.at(side == Side::left ? "left" : "right");
    sole.softness_derived = !sole.states_softness();
    sole.stiffness = model_->sole(side).stiffness;
    sole.damping_time = model_->sole(side).damping_time;
  }
  const auto of_links = [&](const DrawnValue& value, const auto& change) {
    for (const int i : value.targets)
      for (LinkDescription& link : d.links)
        if (link.name == model_->links()[static_cast<size_t>(i)].name) change(link.inertia);
  };
  const auto of_servos = [&](const DrawnValue& value, const auto& change) {
    for (const int j : value.targets) change(actuators.servo[static_cast<size_t>(j)]);
  };
  const auto of_soles = [&](const auto& change) {
    for (auto& [side, sole] : d.soles) change(sole);
  };
  for (size_t i = 0; i < values_.size(); ++i) {
    const DrawnValue& value = values_[i];
    const UncertainQuantity& q = *value.quantity;
    const double v = drawn[i];
    switch (q.kind) {
      case UncertainKind::mass:
        of_links(value, [&](Inertia& inertia) {
          inertia.mass *= v;
          inertia.about_com *= v;
        });
        break;
      case UncertainKind::cog:
        of_links(value, [&](Inertia& inertia) { inertia.com[q.axis] += v; });
        break;
      case UncertainKind::inertia:
        of_links(value, [&](Inertia& inertia) { inertia.about_com *= v; });
        break;
      case UncertainKind::payload:
        for (const int link : value.targets)
          if (v > 0) loads.push_back({link, Vector3d(q.point[0], q.point[1], q.point[2]), v});
        break;
      case UncertainKind::sole_stiffness:
        of_soles([&](SoleDescription& sole) { sole.stiffness *= v; });
        break;
      case UncertainKind::sole_damping:
        of_soles([&](SoleDescription& sole) { sole.damping_time *= v; });
        break;
      case UncertainKind::servo_kp:
        of_servos(value, [&](ServoDescription& servo) { servo.kp *= v; });
        break;
      case UncertainKind::servo_kd:
        of_servos(value, [&](ServoDescription& servo) { servo.kd *= v; });
        break;
      case UncertainKind::servo_friction:
        of_servos(value, [&](ServoDescription& servo) { servo.coulomb += v; });
        break;
      case UncertainKind::servo_delay:
        of_servos(value, [&](ServoDescription& servo) { servo.delay = v; });
        break;
      case UncertainKind::backlash:
        of_servos(value, [&](ServoDescription& servo) { servo.backlash = v; });
        break;
      case UncertainKind::encoder_offset:
        of_servos(value, [&](ServoDescription& servo) { servo.offset += v; });
        break;
      case UncertainKind::sensor_noise:
        d.sensors.attitude_noise *= v;
        d.sensors.gyro_noise *= v;
        d.sensors.accelerometer_noise *= v;
        d.sensors.force_noise *= v;
        break;
      case UncertainKind::sensor_latency:
        d.sensors.set_latency(v);
        break;
      default:
        break;  // values of the ground, biases and pushes are handled in options()
    }
  }
  RobotModel model(std::move(d));
  if (!loads.empty()) model = with_payloads(model, loads);
  return {std::move(model), std::move(actuators)};
}

HeightField UncertainTask::hollows(double depth, std::uint64_t seed) const {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const CommandSample& s : series_->samples)
    for (const Eigen::Isometry3d& foot : s.feet) {
      low = low.cwiseMin(foot.translation().head<2>());
      high = high.cwiseMax(foot.translation().head<2>());
    }
  HeightField field;
  field.spacing = kHollowSpacing;
  field.origin = low.array() - kHollowMargin;
  const Vector2d size = (high - low).array() + 2 * kHollowMargin;
  field.heights.resize(static_cast<Eigen::Index>(size.x() / kHollowSpacing) + 1,
                       static_cast<Eigen::Index>(size.y() / kHollowSpacing) + 1);
  Random random = named_random(seed, 0, "bumps");
  for (double& height : field.heights.reshaped())
    height = options_.world.height - depth * random.uniform();
  return field;
}

Disturbance UncertainTask::push(size_t index, const std::vector<double>& drawn) const {
  const UncertainPush& push = uncertainty_->pushes[index];
  double part[std::size(kPushParts)] = {};
  size_t next = 0;
  for (size_t i = 0; i < values_.size(); ++i)
    if (values_[i].push == static_cast<int>(index)) part[next++] = drawn[i];
  const auto [size, direction, time, link] = part;
  const size_t phase = static_cast<size_t>(time);
  const double at = push.phases ? phases_[phase % phases_.size()].at : time;
  const Vector2d u(elementary::cos(direction), elementary::sin(direction));
  double impulse = size;
  if (push.bounds) {
    const long k = std::clamp(std::lround(at / series_->dt), 0L,
                              static_cast<long>(series_->samples.size()) - 1);
    const double bound = capture_bound(
        push.phases ? regions_[phase % phases_.size()] : capture_region(*model_, *series_, k), u);
    impulse *= std::max(0.0, bound);
  }
  const std::string& on = push.links[static_cast<size_t>(link) % push.links.size()];
  const Push what{.magnitude = impulse,
                  .on = on == "trunk" ? trunk_of(*model_) : on,
                  .direction = {u.x(), u.y(), 0}};
  return {.at = at, .duration = push.duration, .what = what};
}

SimulateOptions UncertainTask::options(const CaseNumbers& numbers,
                                       const std::vector<double>& drawn) const {
  SimulateOptions result = options_;
  result.seed = numbers.noise;
  if (!uncertainty_->pushes.empty()) result.scenario.clear();
  for (size_t i = 0; i < uncertainty_->pushes.size(); ++i)
    result.scenario.push_back(push(i, drawn));
  SensorBias bias;
  bool biased = false;
  for (size_t i = 0; i < values_.size(); ++i) {
    const UncertainQuantity& q = *values_[i].quantity;
    const double v = drawn[i];
    switch (q.kind) {
      case UncertainKind::friction:
        result.world.friction = v;
        break;
      case UncertainKind::slope:
        result.world.slope[q.axis] += v;
        break;
      case UncertainKind::bumps:
        if (v > 0) result.world.fields = {hollows(v, numbers.noise)};
        break;
      case UncertainKind::attitude_bias:
        bias.tilt[q.axis] += v;
        biased = true;
        break;
      case UncertainKind::gyro_bias:
        bias.gyro[q.axis] += v;
        biased = true;
        break;
      case UncertainKind::load_bias:
        bias.load += v;
        biased = true;
        break;
      default:
        break;  // values of the robot are handled in unit()
    }
  }
  if (biased) {
    const double end = series_->duration() + result.settle + 1;
    result.scenario.push_back({.at = 0, .duration = end, .what = bias});
  }
  return result;
}

CaseResult UncertainTask::run(const CaseNumbers& numbers) const {
  const std::vector<double> drawn = draw(numbers);
  const RobotUnit robot = unit(drawn);
  SimulateOptions options = this->options(numbers, drawn);
  options.unit = &robot;
  options.prepared = &controller_;
  Simulator run(*model_, *series_, options);
  run.keep_samples(false);
  while (run.advance(1) && !run.fell()) {
  }
  const SimulationResult result = run.result();
  const LargestErrors& largest = run.largest_errors();
  return {.outcome = result.outcome,
          .fell_at = result.fell_at,
          .cog_error = largest.cog,
          .torque = result.torque.ratio,
          .foot_tilt = largest.foot_tilt};
}

std::string UncertainTask::value_text(size_t i, double drawn) const {
  const DrawnValue& value = values_[i];
  std::string words = amount_words(value.quantity->kind, drawn);
  if (value.push >= 0) {
    const UncertainPush& push = uncertainty_->pushes[static_cast<size_t>(value.push)];
    const size_t number = static_cast<size_t>(std::max(0.0, drawn));
    if (value.quantity == &push.link) words = push.links[number % push.links.size()];
    if (value.quantity == &push.time && push.phases) words = phases_[number % phases_.size()].name;
    if (value.quantity == &push.size && push.bounds) words = text::brief(drawn, 4) + " B";
  }
  return name_text(value) + " " + words;
}

std::vector<std::string> UncertainTask::values_by_kind(const std::vector<double>& drawn) const {
  std::vector<std::string> kinds;
  for (size_t i = 0; i < drawn.size(); ++i) {
    const bool same_group =
        i > 0 && values_[i].push == values_[i - 1].push &&
        (values_[i].push >= 0 || values_[i].quantity->kind == values_[i - 1].quantity->kind);
    if (same_group)
      kinds.back() += ", " + value_text(i, drawn[i]);
    else
      kinds.push_back(value_text(i, drawn[i]));
  }
  return kinds;
}

}  // namespace ayumi
