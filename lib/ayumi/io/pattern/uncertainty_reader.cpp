// Reads "uncertainty" of a pattern or study file.
#include <algorithm>
#include <cmath>
#include <set>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/document_format.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"
#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/io/run/sha256.hpp"

namespace ayumi {

namespace {

/// Largest distance of a range from the mean of its normal distribution [standard deviations].
/// Reason: beyond 37, the probability exp(-37^2/2) of the range cannot be distinguished from 0.
constexpr double kFarthestRange = 30;

constexpr const char* kSpreads[] = {"uniform", "normal", "truncated", "choice"};

SourcePlace place_of(const JsonNode& node) { return {node.file(), node.pointer()}; }

/// Turns numbers in the unit of the file into SI.
std::vector<double> numbers(const JsonNode& node, bool angle, PatternScope& scope) {
  node.expect_array();
  std::vector<double> values;
  for (const JsonNode& item : node.items())
    values.push_back(angle ? read_angle(item, scope) : read_number(item, scope));
  return values;
}

void read_weights(const JsonNode& node, size_t count, PatternScope& scope, Distribution& d) {
  const auto weights = node.find("weights");
  if (!weights) return;
  d.weights = numbers(*weights, false, scope);
  if (d.weights.size() != count)
    weights->complain("there are " + std::to_string(count) + " values but " +
                      std::to_string(d.weights.size()) +
                      " weights; give one weight for each value");
  double sum = 0;
  for (const double weight : d.weights) {
    if (weight < 0)
      weights->complain("a weight must not be negative, but one weight is " + text::exact(weight));
    sum += weight;
  }
  if (!(sum > 0)) weights->complain("one of the weights must be above 0");
}

Distribution read_distribution(const JsonNode& node, bool angle, PatternScope& scope) {
  std::vector<std::string> given;
  for (const char* name : kSpreads)
    if (node.has(name)) given.push_back(name);
  if (given.size() != 1)
    node.complain(
        "expected one distribution (\"uniform\", \"normal\", \"truncated\" or \"choice\"), found " +
        (given.empty() ? "none" : text::join(given, " and ")));
  const JsonNode values = node.at(given[0]);
  if (node.has("weights") && given[0] != "choice")
    node.at("weights").complain("only \"choice\" can have weights");
  const std::vector<double> v = numbers(values, angle, scope);
  const auto expect = [&](size_t count, const char* form) {
    if (v.size() != count)
      values.complain(std::string("expected ") + form + ", found an array of length " +
                      std::to_string(v.size()));
  };
  Distribution d;
  if (given[0] == "uniform") {
    expect(2, "[low, high]");
    d = {.kind = Distribution::Kind::uniform, .low = v[0], .high = v[1]};
  } else if (given[0] == "normal") {
    expect(2, "[mean, standard deviation]");
    d = {.kind = Distribution::Kind::normal, .mean = v[0], .deviation = v[1]};
  } else if (given[0] == "truncated") {
    expect(4, "[mean, standard deviation, low, high]");
    d = {.kind = Distribution::Kind::truncated,
         .low = v[2],
         .high = v[3],
         .mean = v[0],
         .deviation = v[1]};
  } else {
    if (v.empty()) values.complain("the choice is empty; give one value or more");
    d = {.kind = Distribution::Kind::choice, .values = v};
    read_weights(node, v.size(), scope, d);
  }
  const bool bounded =
      d.kind == Distribution::Kind::uniform || d.kind == Distribution::Kind::truncated;
  const bool normal =
      d.kind == Distribution::Kind::normal || d.kind == Distribution::Kind::truncated;
  if (bounded && d.high < d.low)
    values.complain("the range is empty: " + text::brief(d.low) + " is above " +
                    text::brief(d.high));
  if (normal && !(d.deviation > 0))
    values.complain("the standard deviation must be above 0, but it is " +
                    text::exact(d.deviation));
  const double away = std::max(d.low - d.mean, d.mean - d.high) / d.deviation;
  if (d.kind == Distribution::Kind::truncated && away > kFarthestRange)
    values.complain("the range is " + text::brief(away) +
                    " standard deviations away from the mean, but at most " +
                    text::brief(kFarthestRange) +
                    " are possible, because farther away the normal distribution has hardly any "
                    "values. Use \"uniform\", or correct the mean or the range");
  return d;
}

std::string read_source(const JsonNode& node) {
  const auto source = node.find("source");
  if (!source || source->string().find_first_not_of(" \t\r\n") == std::string::npos)
    node.complain(
        "the source of these numbers is missing; add \"source\", which names a paper, a data sheet "
        "or a measurement, or begins with \"assumed:\" and states the reason");
  return source->string();
}

void read_factor(const JsonNode& node, const std::vector<UncertainFactor>& factors,
                 PatternScope& scope, UncertainQuantity& q) {
  const auto factor = node.find("factor");
  if (const auto correlation = node.find("correlation")) {
    if (!factor) correlation->complain("a correlation needs a factor; add \"factor\"");
    q.correlation = read_number(*correlation, scope, -1, 1);
  } else if (factor) {
    node.complain("the factor needs a \"correlation\" from -1 to 1");
  }
  if (!factor) return;
  std::vector<std::string> names;
  for (const UncertainFactor& each : factors) names.push_back(each.name);
  q.factor = factor->string();
  if (std::find(names.begin(), names.end(), q.factor) == names.end())
    factor->complain("there is no factor '" + q.factor + "'; declare it in \"factors\"" +
                     text::suggestion(q.factor, names));
}

UncertainQuantity read_quantity(const JsonNode& node, const std::vector<UncertainFactor>& factors,
                                PatternScope& scope) {
  only_pattern_keys(node, "quantity");
  std::vector<std::string> kinds;
  for (const UncertainKindInfo& each : uncertain_kinds()) kinds.push_back(each.name);
  const std::string what = node.at("what").one_of(kinds);
  const UncertainKindInfo& kind =
      *std::find_if(uncertain_kinds().begin(), uncertain_kinds().end(),
                    [&](const UncertainKindInfo& each) { return each.name == what; });
  UncertainQuantity q;
  q.kind = kind.kind;
  q.place = place_of(node);
  const auto on = node.find("on");
  if (on && kind.target == UncertainKindInfo::Target::none)
    on->complain("the quantity '" + what + "' belongs to no link or joint; leave \"on\" out");
  if (on) q.on = on->string();
  const auto axis = node.find("axis");
  if (kind.axis) {
    const bool plane =
        kind.kind == UncertainKind::slope || kind.kind == UncertainKind::attitude_bias;
    const std::string name = node.at("axis").one_of(
        plane ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"});
    q.axis = name[0] - 'x';
  } else if (axis) {
    axis->complain("the quantity '" + what + "' has no axis; leave \"axis\" out");
  }
  if (const auto each = node.find("each")) q.each = each->boolean();
  if (q.each && kind.target == UncertainKindInfo::Target::none)
    node.at("each").complain("the quantity '" + what +
                             "' belongs to no link or joint; leave \"each\" out");
  if (kind.kind == UncertainKind::payload && q.on.empty())
    node.complain("a payload needs a link; add \"on\"");
  if (const auto point = node.find("point")) {
    if (kind.kind != UncertainKind::payload) point->complain("only a payload has a point");
    const Eigen::Vector3d p = read_vector3(*point, scope);
    q.point = {p.x(), p.y(), p.z()};
  }
  q.name = what;
  if (kind.axis) q.name += std::string(" ") + static_cast<char>('x' + q.axis);
  if (!q.on.empty() && !q.each) q.name += " of " + q.on;
  if (const auto name = node.find("name")) q.name = name->string();
  q.distribution = read_distribution(node, kind.angle, scope);
  q.source = read_source(node);
  read_factor(node, factors, scope, q);
  return q;
}

/// A part of a push: a number, or a distribution.
UncertainQuantity read_part(const JsonNode& node, UncertainKind kind,
                            const std::vector<UncertainFactor>& factors, PatternScope& scope) {
  UncertainQuantity q;
  q.kind = kind;
  q.place = place_of(node);
  const bool angle = kind == UncertainKind::push_direction;
  q.distribution.kind = Distribution::Kind::choice;
  if (!node.value().is_object()) {
    q.distribution.values = {angle ? read_angle(node, scope) : read_number(node, scope)};
    return q;
  }
  only_pattern_keys(node, "spread");
  q.distribution = read_distribution(node, angle, scope);
  q.source = read_source(node);
  read_factor(node, factors, scope, q);
  return q;
}

UncertainQuantity one_of_several(UncertainKind kind, const SourcePlace& place, size_t count) {
  UncertainQuantity q;
  q.kind = kind;
  q.place = place;
  q.distribution.kind = Distribution::Kind::choice;
  for (size_t i = 0; i < count; ++i) q.distribution.values.push_back(static_cast<double>(i));
  return q;
}

/// Longest push [s]. Chosen: the limit of `ayumi push --duration`.
constexpr double kLongestPush = 1;

UncertainPush read_push(const JsonNode& node, const std::vector<UncertainFactor>& factors,
                        PatternScope& scope) {
  only_pattern_keys(node, "uncertain_push");
  UncertainPush push;
  push.name = "push";
  if (const auto name = node.find("name")) push.name = name->string();
  push.bounds = node.at("unit").one_of({"B", "N s"}) == "B";
  if (const auto duration = node.find("duration"))
    push.duration = read_number(*duration, scope, 0.001, kLongestPush);
  push.size = read_part(node.at("size"), UncertainKind::push_size, factors, scope);
  push.direction = read_part(node.at("direction"), UncertainKind::push_direction, factors, scope);
  const JsonNode time = node.at("time");
  push.phases = time.value().is_string();
  if (push.phases) {
    time.one_of({"phases"});
    push.time = one_of_several(UncertainKind::push_time, place_of(time), 1);
  } else {
    push.time = read_part(time, UncertainKind::push_time, factors, scope);
  }
  push.link = one_of_several(UncertainKind::push_link, place_of(node), 1);
  if (const auto on = node.find("on")) {
    if (on->value().is_object()) {
      only_pattern_keys(*on, "spread");
      push.links = on->at("choice").strings();
      if (push.links.empty()) on->complain("the choice is empty; give one link or more");
      push.link = one_of_several(UncertainKind::push_link, place_of(*on), push.links.size());
      read_weights(*on, push.links.size(), scope, push.link.distribution);
      push.link.source = read_source(*on);
      read_factor(*on, factors, scope, push.link);
    } else {
      push.links = {on->string()};
    }
  }
  return push;
}

}  // namespace

Uncertainty read_uncertainty(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "uncertainty");
  Uncertainty result;
  std::set<std::string> names;
  const auto refuse_twice = [&](const std::string& name, const JsonNode& at) {
    if (!names.insert(name).second)
      at.complain("the name '" + name + "' appears twice; give one of them another \"name\"");
  };
  if (const auto factors = node.find("factors"))
    for (const JsonNode& each : factors->items()) {
      only_pattern_keys(each, "factor");
      result.factors.push_back({each.at("name").string(), read_source(each), place_of(each)});
      refuse_twice("factor " + result.factors.back().name, each);
    }
  if (const auto quantities = node.find("quantities"))
    for (const JsonNode& each : quantities->items()) {
      result.quantities.push_back(read_quantity(each, result.factors, scope));
      refuse_twice(result.quantities.back().name, each);
    }
  if (const auto pushes = node.find("pushes"))
    for (const JsonNode& each : pushes->items()) {
      result.pushes.push_back(read_push(each, result.factors, scope));
      refuse_twice(result.pushes.back().name, each);
    }
  return result;
}

Study study_of_text(const std::string& text, const std::filesystem::path& path) {
  const Json document = parse_json(text, path.string(), ErrorCode::bad_pattern);
  const JsonNode root = root_of(document, path.string(), ErrorCode::bad_pattern);
  root.expect_object();
  require_format(root, "ayumi.study/1");
  only_pattern_keys(root, "study");
  Study study;
  study.file = path.string();
  study.sha256 = sha256(text);
  if (const auto name = root.find("name")) study.name = name->string();
  PatternScope scope;
  read_units(root, scope);
  if (const auto uncertainty = root.find("uncertainty"))
    study.uncertainty = read_uncertainty(*uncertainty, scope);
  else if (!root.has("sweep"))
    root.complain("the study has neither \"uncertainty\" nor \"sweep\"; add one of them");
  return study;
}

Study read_study(const std::filesystem::path& path) { return study_of_text(read_file(path), path); }

std::filesystem::path default_study(const RobotModel& robot) {
  const std::filesystem::path sidecar = robot.description().sidecar_file;
  if (sidecar.empty()) return {};
  const std::filesystem::path file = sidecar.parent_path() / "uncertainty.json";
  return std::filesystem::exists(file) ? file : std::filesystem::path();
}

}  // namespace ayumi
