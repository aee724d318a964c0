#include "ayumi/io/pattern/sweep_file.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/sim/simulate.hpp"
#include "ayumi/study/push.hpp"

namespace ayumi {

/// The values of the settings of one part, by the number of the case in this part.
struct SweepStudy::Part {
  enum class Kind { axis, product, list, hypercube };
  Kind kind = Kind::list;
  long size = 0;
  std::string name = {};                  ///< name of an axis
  std::vector<SettingValue> values = {};  ///< values of an axis
  std::vector<Part> parts = {};           ///< parts of a product or list
  std::vector<long> begins = {};          ///< number of the first case of each part of a list
  std::vector<std::string> names = {};    ///< names of a hypercube
  std::vector<std::vector<double>> columns = {};  ///< values of a hypercube, by name and sample

  void set(long number, Settings& settings) const {
    switch (kind) {
      case Kind::axis:
        settings[name] = values[static_cast<size_t>(number)];
        break;
      case Kind::product:
        for (size_t i = parts.size(); i-- > 0; number /= parts[i].size)
          parts[i].set(number % parts[i].size, settings);
        break;
      case Kind::list: {
        const auto after = std::upper_bound(begins.begin(), begins.end(), number);
        const size_t i = static_cast<size_t>(after - begins.begin()) - 1;
        parts[i].set(number - begins[i], settings);
        break;
      }
      case Kind::hypercube:
        for (size_t i = 0; i < names.size(); ++i)
          settings[names[i]] = columns[i][static_cast<size_t>(number)];
        break;
    }
  }
};

/// The parsed file, for worlds and disturbances that depend on the values of a case.
struct SweepStudy::Document {
  Json json;
  std::optional<double> radians_per_unit;
};

namespace {

using Part = SweepStudy::Part;

constexpr const char* kPrefixes[] = {"set.", "gain.", "value."};
/// The settings whose values are words, those whose values are whole numbers, and switches.
const std::vector<std::string> kWords = {"pattern",    "robot", "profile",
                                         "controller", "world", "disturbances"};
const std::vector<std::string> kWholeNumbers = {"seed", "draw", "substeps"};
const std::vector<std::string> kSwitches = {"noise", "true_state"};
const std::vector<std::string> kMeasures = {"verdict", "margins", "energy",
                                            "check",   "repair",  "thresholds"};
/// Largest seed and largest number of a draw. Definition: a double holds whole numbers up to this
/// one exactly.
constexpr double kLargestWhole = 9007199254740992.0;

bool contains(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

void require_setting(const JsonNode& node, const std::string& name) {
  for (const char* prefix : kPrefixes)
    if (name.starts_with(prefix) && name.size() > std::string(prefix).size()) return;
  std::vector<std::string> known = kWords;
  known.insert(known.end(), kWholeNumbers.begin(), kWholeNumbers.end());
  known.insert(known.end(), kSwitches.begin(), kSwitches.end());
  if (contains(known, name)) return;
  node.complain("there is no setting '" + name + "'. The settings are " + text::join(known, ", ") +
                ", set.NAME (a parameter of the pattern), gain.NAME (a gain of the controller) and "
                "value.NAME (a value in worlds and disturbances)" +
                text::suggestion(name, known));
}

double whole(const JsonNode& node, double least, double value) {
  if (value != std::floor(value) || value < least || value > kLargestWhole)
    node.complain("expected a whole number of at least " + text::exact(least) + ", found " +
                  text::exact(value));
  return value;
}

SettingValue read_value(const JsonNode& node, const std::string& name) {
  if (contains(kWords, name)) {
    const std::string word = node.string();
    if (word.empty()) node.complain("the name is empty");
    if (name == "controller") return node.one_of(controller_names());
    return word;
  }
  if (contains(kSwitches, name)) return node.boolean() ? 1.0 : 0.0;
  if (contains(kWholeNumbers, name)) {
    const Bounds bounds =
        name == "substeps" ? SimulateOptions::kSubsteps : Bounds{0, kLargestWhole};
    return whole(node, bounds.least, node.number_within(0, bounds.most));
  }
  return node.number_within(-kLargestNumber, kLargestNumber);
}

long read_count(const JsonNode& node, long least) {
  return static_cast<long>(
      whole(node, static_cast<double>(least),
            node.number_within(static_cast<double>(least), double(SweepStudy::kMostCases))));
}

Part read_axis(const JsonNode& node, const std::string& name) {
  require_setting(node, name);
  Part axis{.kind = Part::Kind::axis, .name = name};
  if (node.value().is_array()) {
    for (const JsonNode& item : node.items()) axis.values.push_back(read_value(item, name));
    if (axis.values.empty()) node.complain("the list is empty; give one value or more");
  } else if (node.value().is_object()) {
    node.only_keys({"from", "to", "count"});
    if (contains(kWords, name) || contains(kSwitches, name))
      node.complain("the setting '" + name + "' has no range; give a list of its values");
    const double from = node.at("from").number_within(-kLargestNumber, kLargestWhole);
    const double to = node.at("to").number_within(-kLargestNumber, kLargestWhole);
    const long count = read_count(node.at("count"), 1);
    if (count == 1 && from != to)
      node.complain("\"count\" is 1, but \"from\" is " + text::exact(from) + " and \"to\" is " +
                    text::exact(to) + "; give a \"count\" of 2 or more");
    for (long i = 0; i < count; ++i) {
      const double share = count == 1 ? 0 : double(i) / double(count - 1);
      double value = i + 1 == count ? to : from + (to - from) * share;
      if (contains(kWholeNumbers, name)) value = whole(node, 0, std::round(value * 1e6) / 1e6);
      axis.values.emplace_back(value);
    }
  } else {
    axis.values.push_back(read_value(node, name));
  }
  axis.size = static_cast<long>(axis.values.size());
  return axis;
}

void names_of(const Part& part, std::set<std::string>& names) {
  if (part.kind == Part::Kind::axis) names.insert(part.name);
  names.insert(part.names.begin(), part.names.end());
  for (const Part& each : part.parts) names_of(each, names);
}

void refuse_too_many(const JsonNode& node, double size) {
  if (size > double(SweepStudy::kMostCases))
    node.complain("the study has " + text::brief(size, 6) +
                  " cases; the largest number allowed is " +
                  std::to_string(SweepStudy::kMostCases));
}

Part product_of(const JsonNode& node, std::vector<Part> parts) {
  Part product{.kind = Part::Kind::product, .size = 1};
  std::set<std::string> names;
  for (const Part& part : parts) {
    std::set<std::string> theirs;
    names_of(part, theirs);
    for (const std::string& name : theirs)
      if (!names.insert(name).second)
        node.complain(
            "the setting '" + name +
            "' is in two factors of the product, but in each case a setting has only one value; "
            "remove the setting from one factor");
    refuse_too_many(node, double(product.size) * double(part.size));
    product.size *= part.size;
  }
  product.parts = std::move(parts);
  return product;
}

/// In each column, each of n equal parts of the range has one sample.
Part read_hypercube(const JsonNode& node) {
  node.only_keys({"samples", "seed", "ranges"});
  Part cube{.kind = Part::Kind::hypercube, .size = read_count(node.at("samples"), 1)};
  std::uint64_t seed = 1;
  if (const auto given = node.find("seed")) seed = given->unsigned_integer();
  const JsonNode ranges = node.at("ranges");
  for (const auto& [name, range] : ranges.members()) {
    require_setting(range, name);
    if (contains(kWords, name) || contains(kSwitches, name))
      range.complain("the setting '" + name + "' has no range");
    const std::vector<double> ends = range.numbers();
    if (ends.size() != 2 || !(ends[0] < ends[1]) || std::abs(ends[0]) > kLargestWhole ||
        std::abs(ends[1]) > kLargestWhole)
      range.complain("expected [low, high] with low below high");
    Random random(Random(seed + cube.names.size()).bits());
    std::vector<long> order(static_cast<size_t>(cube.size));
    std::iota(order.begin(), order.end(), 0L);
    for (size_t i = order.size(); i-- > 1;) std::swap(order[i], order[random.bits() % (i + 1)]);
    std::vector<double> column;
    for (const long place : order) {
      const double value =
          ends[0] + (ends[1] - ends[0]) * (double(place) + random.uniform()) / double(cube.size);
      column.push_back(contains(kWholeNumbers, name) ? std::floor(value) : value);
    }
    cube.names.push_back(name);
    cube.columns.push_back(std::move(column));
  }
  if (cube.names.empty()) ranges.complain("give one range or more");
  return cube;
}

Part read_part(const JsonNode& node) {
  node.expect_object();
  const auto only = [&](const char* key) { node.only_keys({key}); };
  if (node.has("product")) {
    only("product");
    std::vector<Part> parts;
    for (const JsonNode& item : node.at("product").items()) parts.push_back(read_part(item));
    if (parts.empty()) node.complain("the product is empty; give one factor or more");
    return product_of(node, std::move(parts));
  }
  if (node.has("list")) {
    only("list");
    Part list{.kind = Part::Kind::list};
    for (const JsonNode& item : node.at("list").items()) {
      list.parts.push_back(read_part(item));
      list.begins.push_back(list.size);
      refuse_too_many(node, double(list.size) + double(list.parts.back().size));
      list.size += list.parts.back().size;
    }
    if (list.parts.empty()) node.complain("the list is empty; give one case or more");
    return list;
  }
  if (node.has("latin_hypercube")) {
    only("latin_hypercube");
    return read_hypercube(node.at("latin_hypercube"));
  }
  std::vector<Part> parts;
  for (const auto& [name, value] : node.members()) parts.push_back(read_axis(value, name));
  if (parts.empty()) node.complain("there is no setting; give one or more");
  return product_of(node, std::move(parts));
}

void collect(const Part& part, const std::string& setting, std::set<std::string>& words) {
  if (part.kind == Part::Kind::axis && part.name == setting)
    for (const SettingValue& value : part.values) words.insert(setting_text(value));
  for (const Part& each : part.parts) collect(each, setting, words);
}

/// Finds the names of settings that differ between cases. These are the names of every axis with
/// several values. In a list, they are also the names that only some entries have, or that have
/// different values in different entries.
void differing(const Part& part, const Settings& fixed, std::set<std::string>& names) {
  if (part.kind == Part::Kind::axis && part.values.size() > 1) names.insert(part.name);
  if (part.kind == Part::Kind::hypercube) names.insert(part.names.begin(), part.names.end());
  for (const Part& each : part.parts) differing(each, fixed, names);
  if (part.kind != Part::Kind::list) return;
  std::set<std::string> all;
  names_of(part, all);
  for (const std::string& name : all) {
    std::set<std::string> values;
    for (const Part& each : part.parts) {
      Settings first = fixed;
      each.set(0, first);
      values.insert(first.contains(name) ? setting_text(first.at(name)) : std::string());
    }
    if (values.size() > 1) names.insert(name);
  }
}

void find_named(const JsonNode& node, std::map<std::string, SweepStudy::Named>& named) {
  if (node.value().is_array()) {
    for (const JsonNode& item : node.items()) find_named(item, named);
    return;
  }
  if (!node.value().is_object()) return;
  for (const auto& [key, value] : node.members()) {
    if (key == "product" || key == "list") {
      find_named(value, named);
    } else if (key == "latin_hypercube") {
      for (const auto& [name, range] : value.at("ranges").members())
        named.try_emplace(name, SweepStudy::Named{range.numbers().at(0), range.pointer()});
    } else {
      named.try_emplace(key,
                        SweepStudy::Named{read_axis(value, key).values.front(), value.pointer()});
    }
  }
}

/// The scope in which the world and the disturbances of a case are read.
PatternScope scope_of(const Settings& settings, std::optional<double> radians_per_unit) {
  PatternScope scope;
  scope.radians_per_unit = radians_per_unit;
  for (const auto& [name, value] : settings)
    if (name.starts_with("value.")) scope.parameters[name.substr(6)] = std::get<double>(value);
  return scope;
}

/// The object of that name in "worlds" or "disturbances".
JsonNode declared(const JsonNode& sweep, const std::string& list, const std::string& name,
                  const JsonNode& asked) {
  std::vector<std::string> names;
  if (const auto all = sweep.find(list)) {
    all->expect_object();
    for (const auto& [each, node] : all->members()) {
      if (each == name) return node;
      names.push_back(each);
    }
  }
  asked.complain("'" + name + "' is not declared in \"" + list + "\"" +
                 text::suggestion(name, names));
}

}  // namespace

std::string setting_text(const SettingValue& value) {
  if (const auto* const word = std::get_if<std::string>(&value)) return *word;
  return text::exact(std::get<double>(value));
}

double number_of(const Settings& settings, const std::string& name, double otherwise) {
  const auto found = settings.find(name);
  return found == settings.end() ? otherwise : std::get<double>(found->second);
}

std::string word_of(const Settings& settings, const std::string& name) {
  const auto found = settings.find(name);
  return found == settings.end() ? "" : std::get<std::string>(found->second);
}

SweepStudy::SweepStudy(const std::string& text, const std::filesystem::path& path)
    : text_(text), file_(path) {
  uncertainty_ = study_of_text(text, path);
  name_ = uncertainty_.name.empty() ? path.stem().string() : uncertainty_.name;
  auto document = std::make_shared<Document>();
  document->json = parse_json(text, path.string(), ErrorCode::bad_pattern);
  const JsonNode root = root_of(document->json, path.string(), ErrorCode::bad_pattern);
  PatternScope scope;
  read_units(root, scope);
  document->radians_per_unit = scope.radians_per_unit;
  const auto found = root.find("sweep");
  if (!found)
    root.complain(
        "the key \"sweep\" is missing; add \"sweep\", which states the cases to run and the "
        "values to measure");
  const JsonNode& sweep = *found;
  sweep.expect_object();
  sweep.only_keys({"settings", "cases", "worlds", "disturbances", "measure", "thresholds"});
  if (const auto settings = sweep.find("settings")) {
    settings->expect_object();
    for (const auto& [name, value] : settings->members()) {
      require_setting(value, name);
      fixed_[name] = read_value(value, name);
      named_.emplace(name, Named{fixed_[name], value.pointer()});
    }
  }
  const JsonNode cases = sweep.at("cases");
  cases_ = std::make_shared<const Part>(read_part(cases));
  refuse_too_many(cases, double(cases_->size));
  find_named(cases, named_);
  std::set<std::string> names;
  differing(*cases_, fixed_, names);
  axes_.assign(names.begin(), names.end());

  Settings without = fixed_;
  cases_->set(0, without);
  if (!without.contains("pattern"))
    sweep.complain("the cases have no pattern; add \"pattern\" to \"settings\" or \"cases\"");
  for (const char* list : {"worlds", "disturbances"}) {
    const std::string setting = list[0] == 'w' ? "world" : "disturbances";
    std::set<std::string> used;
    for (const std::string& name : words(setting)) {
      used.insert(name);
      if (setting == "disturbances" && name == "none") continue;
      declared(sweep, list, name, sweep);
    }
    if (const auto all = sweep.find(list))
      for (const auto& [name, node] : all->members())
        if (!used.contains(name))
          node.complain("no case uses '" + name + "'; remove '" + name + "', or use it in a case");
  }
  std::string bodies;
  for (const char* list : {"worlds", "disturbances"})
    if (const auto all = sweep.find(list)) bodies += all->value().dump();
  for (const auto& [name, where] : named_)
    if (name.starts_with("value.") && bodies.find("${" + name.substr(6) + "}") == std::string::npos)
      fail(ErrorCode::bad_pattern, {file_.string(), where.pointer},
           "nothing uses the setting '" + name + "'; write \"${" + name.substr(6) +
               "}\" in a world or a disturbance");
  if (const auto measure = sweep.find("measure")) {
    measures_.verdict = false;
    for (const JsonNode& item : measure->items()) {
      const std::string what = item.one_of(kMeasures);
      if (contains(measure_names_, what)) item.complain("'" + what + "' appears twice; keep one");
      measure_names_.push_back(what);
    }
    if (measure_names_.empty()) measure->complain("the list is empty; name what to measure");
    measures_ = {.verdict = contains(measure_names_, "verdict"),
                 .margins = contains(measure_names_, "margins"),
                 .energy = contains(measure_names_, "energy"),
                 .check = contains(measure_names_, "check"),
                 .repair = contains(measure_names_, "repair"),
                 .thresholds = contains(measure_names_, "thresholds")};
  } else {
    measure_names_ = {"verdict"};
  }
  if (const auto given = sweep.find("thresholds")) {
    if (!measures_.thresholds)
      given->complain("thresholds are not measured; add \"thresholds\" to \"measure\"");
    given->only_keys({"times", "directions", "replicas", "step", "cap", "duration"});
    SweepThresholds& t = thresholds_;
    if (const auto node = given->find("times"))
      for (const JsonNode& item : node->items())
        t.times.push_back(item.number_within(0, kLongestPattern));
    const auto count = [&](const char* key, const Bounds& bounds, int& into) {
      if (const auto node = given->find(key))
        into = static_cast<int>(
            whole(*node, bounds.least, node->number_within(bounds.least, bounds.most)));
    };
    const auto number = [&](const char* key, const Bounds& bounds, double& into) {
      if (const auto node = given->find(key)) into = node->number_within(bounds.least, bounds.most);
    };
    count("directions", PushOptions::kDirections, t.directions);
    count("replicas", PushOptions::kReplicas, t.replicas);
    number("step", PushOptions::kStep, t.step);
    number("cap", PushOptions::kCap, t.cap);
    number("duration", PushOptions::kDuration, t.duration);
  }
  document_ = std::move(document);
}

long SweepStudy::size() const { return cases_->size; }

Settings SweepStudy::settings(long number) const {
  Settings settings = fixed_;
  cases_->set(number, settings);
  return settings;
}

std::vector<std::string> SweepStudy::words(const std::string& setting) const {
  std::set<std::string> words;
  if (const auto fixed = fixed_.find(setting); fixed != fixed_.end())
    words.insert(setting_text(fixed->second));
  collect(*cases_, setting, words);
  return {words.begin(), words.end()};
}

std::optional<World> SweepStudy::world(const Settings& settings) const {
  const std::string name = word_of(settings, "world");
  if (name.empty()) return {};
  const JsonNode root = root_of(document_->json, file_.string(), ErrorCode::bad_pattern);
  PatternScope scope = scope_of(settings, document_->radians_per_unit);
  return read_world(root.at("sweep").at("worlds").at(name), scope);
}

std::optional<std::vector<Disturbance>> SweepStudy::disturbances(const Settings& settings) const {
  const std::string name = word_of(settings, "disturbances");
  if (name.empty()) return {};
  std::vector<Disturbance> scenario;
  if (name == "none") return scenario;
  const JsonNode root = root_of(document_->json, file_.string(), ErrorCode::bad_pattern);
  PatternScope scope = scope_of(settings, document_->radians_per_unit);
  for (const JsonNode& item : root.at("sweep").at("disturbances").at(name).items())
    scenario.push_back(read_disturbance(item, scope));
  return scenario;
}

}  // namespace ayumi
