#include <algorithm>
#include <limits>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/number_slips.hpp"
#include "ayumi/base/regular_file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/json/document_format.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"
#include "ayumi/io/robot/robot_source.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Largest number of phases and keyframes of a file, repeated ones included. Chosen: one item every
// 0.1 s of the longest pattern gives less than half of it.
constexpr size_t kMostItems = 100000;
// Largest number of rounds of a block, and largest depth of blocks in each other. Chosen: far more
// than anybody writes.
constexpr double kMostRounds = 10000;
constexpr int kMostBlocks = 8;

void require_parameter_name(const std::string& name, const JsonNode& place) {
  if (name.empty() || name.find_first_of("${}") != std::string::npos)
    place.complain("the name of a parameter must not be empty and must not contain $, { or }");
}

// Reads the numbers of "parameters"; values that are set from outside replace them.
void read_parameters(const JsonNode& root, const std::map<std::string, double>& set,
                     PatternScope& scope) {
  if (const auto parameters = root.find("parameters"))
    for (const auto& [name, value] : parameters->members()) {
      require_parameter_name(name, value);
      PatternScope nothing;
      scope.parameters[name] = read_number(value, nothing);
    }
  std::vector<std::string> names;
  for (const auto& entry : scope.parameters) names.push_back(entry.first);
  for (const auto& [name, value] : set) {
    const SourcePlace place = {root.file(), "parameter '" + name + "'"};
    if (!scope.parameters.contains(name))
      fail(ErrorCode::usage, {root.file()},
           "parameter '" + name + "' is not declared in the pattern" +
               (names.empty() ? "; the pattern declares no parameters"
                              : "; declared: " + text::join(names, ", ")) +
               text::suggestion(name, names));
    if (!(std::abs(value) <= kLargestNumber))
      fail(ErrorCode::usage, place,
           text::exact(value) + " is out of range; numbers must be from -1e6 to 1e6");
    scope.parameters[name] = value;
  }
}

void read_postures(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  const auto postures = root.find("postures");
  if (!postures) return;
  for (const auto& [name, joints] : postures->members())
    if (!pattern.postures.emplace(name, read_joint_angles(joints, scope)).second)
      joints.complain(
          "another included file already has a posture of this name; rename one of the two "
          "postures");
}

struct LibraryFile {
  PostureLibrary library;
  std::string bytes;
};

LibraryFile read_library(const fs::path& path, Pattern& pattern) {
  LibraryFile file;
  file.bytes = read_file(path, kLargestPattern);
  const Json document = parse_json(file.bytes, path.string(), ErrorCode::bad_pattern);
  const JsonNode root = root_of(document, path.string(), ErrorCode::bad_pattern);
  require_format(root, "ayumi.postures/1");
  only_pattern_keys(root, "postures_file");
  PatternScope scope;
  read_units(root, scope);
  root.at("postures").expect_object();
  read_postures(root, scope, pattern);
  for (const auto& posture : root.at("postures").members())
    pattern.posture_files[posture.first] = path.string();
  if (const auto robot = root.find("robot")) file.library.robot = robot->string();
  file.library.degrees = scope.radians_per_unit != 1.0;
  return file;
}

// The file that a value of the pattern names.
fs::path named_file(const JsonNode& name, const fs::path& folder) {
  fs::path path = folder / name.string();
  try {
    const RegularFile file(path, std::numeric_limits<size_t>::max());
  } catch (const Error& error) {
    name.complain(error.what());
  }
  return path;
}

// Reads the posture libraries beside the pattern, and returns their bytes for the fingerprint.
std::string read_includes(const JsonNode& root, const fs::path& folder, Pattern& pattern) {
  const auto include = root.find("include");
  if (!include) return {};
  const std::vector<JsonNode> names =
      include->value().is_array() ? include->items() : std::vector<JsonNode>{*include};
  std::string all;
  for (const JsonNode& name : names) {
    all += read_library(named_file(name, folder), pattern).bytes;
  }
  return all;
}

void read_defaults(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  const auto defaults = root.find("defaults");
  if (!defaults) return;
  only_pattern_keys(*defaults, "defaults");
  if (const auto interpolation = defaults->find("interpolation"))
    pattern.interpolation = read_interpolation(*interpolation);
  if (const auto posture = defaults->find("posture")) pattern.default_posture = posture->string();
  if (const auto height = defaults->find("cog_height")) {
    pattern.cog_height = read_number(*height, scope);
    if (pattern.cog_height <= 0)
      height->complain("this value must be above 0, but it is " + text::exact(pattern.cog_height));
  }
  if (const auto model = defaults->find("cog_model"))
    pattern.full_model = model->one_of({"full", "point_mass"}) == "full";
}

void read_start(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  const auto start = root.find("start");
  if (!start) return;
  only_pattern_keys(*start, "start");
  for (const Side side : {Side::left, Side::right})
    if (const auto foot = start->find(name_of(side)))
      pattern.start_feet[static_cast<size_t>(side)] = read_foothold(*foot, scope);
}

// While a block is read, its count is a parameter.
class Counter {
 public:
  Counter(const JsonNode& block, PatternScope& scope) : scope_(scope) {
    const auto count = block.find("count");
    if (!count) return;
    name_ = count->string();
    require_parameter_name(name_, *count);
    if (scope.parameters.contains(name_))
      count->complain("'" + name_ +
                      "' is already the name of a parameter, or the name of the count of a block "
                      "around this block; choose another name");
  }
  ~Counter() { scope_.parameters.erase(name_); }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;
  void set(int round) const {
    if (!name_.empty()) scope_.parameters[name_] = round;
  }

 private:
  PatternScope& scope_;
  std::string name_;
};

// Calls work(node) for the items of `list`, and for the items of a block that repeats as often as
// the block says.
template <class Work>
void each_item(const JsonNode& list, const std::string& name, PatternScope& scope, int depth,
               const Work& work) {
  for (const JsonNode& node : list.items()) {
    if (!node.value().is_object() || !node.has("repeat")) {
      work(node);
      continue;
    }
    if (depth == kMostBlocks)
      node.complain("at most " + std::to_string(kMostBlocks) + " repeated blocks may be nested");
    only_pattern_keys(node, "repeated_" + name);
    const double times = read_number(node.at("repeat"), scope, 1, kMostRounds);
    if (times != std::floor(times)) node.at("repeat").complain("expected a whole number");
    const JsonNode block = node.at(name);
    block.expect_array();
    if (block.size() == 0) block.complain("the list is empty; there is nothing to repeat");
    const Counter counter(node, scope);
    for (int round = 0; round < static_cast<int>(times); ++round) {
      counter.set(round);
      try {
        each_item(block, name, scope, depth + 1, work);
      } catch (const Error& error) {
        throw_with_more(error,
                        " (round " + std::to_string(round + 1) + " of " + text::exact(times) + ")");
      }
    }
  }
}

[[noreturn]] void complain_of_many(const JsonNode& list) {
  list.complain("with its repeated blocks the list has more than " + std::to_string(kMostItems) +
                " items; give a smaller \"repeat\"");
}

// If a time is later than the next one by this factor, it is probably wrong by a power of ten.
// Chosen: half of ten.
constexpr double kGrossTime = 5;

// The end of a message about times that do not increase, where `t` follows `previous`, and
// `previous` follows `before`. If `previous` with one slip of the keyboard corrected would be in
// order, the message proposes this correction. Otherwise it asks for a later time in place of `t`,
// and proposes one if `t` with one slip corrected would be in order.
std::string meant_time(double before, double previous, const std::string& place_of_previous,
                       double t, const std::string& otherwise) {
  // If a time is only a little too late, its decimal point is not in a wrong place.
  const bool gross = previous > kGrossTime * t;
  for (const double slip : number_slips(previous))
    if (slip > before && slip < t && (gross || slip > previous / kGrossTime))
      return ". Perhaps the time of " + place_of_previous + " should be " + text::brief(slip, 10) +
             " s and not " + text::exact(previous) +
             " s. If so, correct the time there; otherwise give a later time here";
  for (const double slip : number_slips(t))
    if (slip > previous && slip < 2 * previous - before)
      return "; give a later time, perhaps " + text::brief(slip, 10) + " s";
  return "; give a later time" + otherwise;
}

// The end of a message about a time since the beginning that was perhaps meant relative to the
// previous time.
std::string meant_span(const JsonNode& node, const std::string& absolute,
                       const std::string& relative, double value) {
  if (!node.has(absolute) || !(value > 0)) return "";
  return ". If the " + text::exact(value) + " s are counted from the " +
         (relative == "duration" ? "beginning of this phase" : "keyframe before") + ", write \"" +
         relative + "\" in place of \"" + absolute + "\"";
}

void read_phases(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  const JsonNode phases = root.at("phases");
  phases.expect_array();
  if (phases.size() == 0)
    phases.complain(
        "the list is empty; give at least one phase, which says which feet carry the robot");
  each_item(phases, "phases", scope, 0, [&](const JsonNode& node) {
    const double previous = pattern.phases.empty() ? 0 : pattern.phases.back().until;
    pattern.phases.push_back(read_phase(node, previous, scope));
    const double until = pattern.phases.back().until;
    if (!(until > previous))
      node.at(node.has("until") ? "until" : "duration")
          .complain("this phase begins at " + text::exact(previous) + " s and ends at " +
                    text::exact(until) + " s" +
                    (pattern.phases.size() < 2
                         ? "; give a later time"
                         : meant_time(pattern.phases.size() > 2
                                          ? pattern.phases[pattern.phases.size() - 3].until
                                          : 0,
                                      previous, pattern.phases[pattern.phases.size() - 2].pointer,
                                      until, meant_span(node, "until", "duration", until))));
    if (pattern.phases.size() > kMostItems) complain_of_many(phases);
  });
}

void read_keyframes(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  const auto keyframes = root.find("keyframes");
  const bool goals = std::any_of(pattern.phases.begin(), pattern.phases.end(),
                                 [](const Phase& phase) { return phase.viip.has_value(); });
  if (!keyframes && (root.has("table") || goals)) return;
  if (!keyframes)
    root.complain("the key 'keyframes' is missing; give keyframes, or a sampled motion as 'table'");
  keyframes->expect_array();
  if (keyframes->size() == 0) keyframes->complain("the list is empty; give at least one keyframe");
  each_item(*keyframes, "keyframes", scope, 0, [&](const JsonNode& node) {
    const bool first = pattern.keyframes.empty();
    const double previous = first ? 0 : pattern.keyframes.back().t;
    pattern.keyframes.push_back(read_keyframe(node, previous, scope));
    const double t = pattern.keyframes.back().t;
    if (!(t > previous || (first && t == previous)))
      node.at(node.has("t") ? "t" : "after")
          .complain(
              "this keyframe is at " + text::exact(t) + " s, but " +
              (first ? "the motion begins at 0 s"
                     : "the keyframe before it is at " + text::exact(previous) + " s") +
              (first ? "; give a later time"
                     : meant_time(pattern.keyframes.size() > 2
                                      ? pattern.keyframes[pattern.keyframes.size() - 3].t
                                      : 0,
                                  previous, pattern.keyframes[pattern.keyframes.size() - 2].pointer,
                                  t, meant_span(node, "t", "after", t))));
    if (pattern.keyframes.size() > kMostItems) complain_of_many(*keyframes);
  });
}

void read_rest(const JsonNode& root, PatternScope& scope, Pattern& pattern) {
  if (const auto correction = root.find("correction"))
    pattern.correction = read_correction(*correction);
  if (const auto world = root.find("world")) pattern.world = read_world(*world, scope);
  if (const auto controller = root.find("controller"))
    pattern.controller = read_controller(*controller, scope);
  if (const auto scenario = root.find("scenario"))
    for (const JsonNode& node : scenario->items())
      pattern.scenario.push_back(read_disturbance(node, scope));
  if (const auto tolerances = root.find("tolerances"))
    for (const auto& [kind, value] : tolerances->members())
      pattern.tolerances[kind] = read_number(value, scope, 0, kLargestNumber);
  if (const auto wishes = root.find("repair"))
    pattern.repair = read_repair(*wishes, static_cast<int>(pattern.keyframes.size()), scope);
  if (const auto uncertainty = root.find("uncertainty"))
    pattern.uncertainty = read_uncertainty(*uncertainty, scope);
}

}  // namespace

bool names_a_path(const std::string& robot) {
  return robot.find('/') != std::string::npos || robot.ends_with(".json") ||
         has_robot_ending(robot);
}

Pattern read_pattern(const fs::path& path, const std::map<std::string, double>& set_parameters) {
  return pattern_of_text(read_file(path, kLargestPattern), path, set_parameters);
}

Pattern pattern_of_text(const std::string& text, const fs::path& path,
                        const std::map<std::string, double>& set_parameters,
                        const DenseTable* given) {
  std::string bytes = text;
  const Json document = parse_json(bytes, path.string(), ErrorCode::bad_pattern);
  const JsonNode root = root_of(document, path.string(), ErrorCode::bad_pattern);
  root.expect_object();
  require_format(root, "ayumi.pattern/1");
  only_pattern_keys(root, "pattern");

  Pattern pattern;
  if (const auto schema = root.find("$schema")) pattern.schema = schema->string();
  pattern.file = path.string();
  if (const auto name = root.find("name")) pattern.name = name->string();
  pattern.robot = root.at("robot").string();
  if (pattern.robot.empty()) root.at("robot").complain("the name is empty; name a robot");
  if (const auto profile = root.find("profile")) pattern.profile = profile->string();

  PatternScope scope;
  read_units(root, scope);
  pattern.degrees = scope.radians_per_unit != 1.0;
  read_parameters(root, set_parameters, scope);
  bytes += read_includes(root, path.parent_path(), pattern);
  read_postures(root, scope, pattern);
  read_defaults(root, scope, pattern);
  read_start(root, scope, pattern);
  read_phases(root, scope, pattern);
  read_keyframes(root, scope, pattern);
  read_rest(root, scope, pattern);
  pattern.parameters = scope.parameters;
  for (const auto& [name, value] : set_parameters)
    if (!scope.used.contains(name))
      fail(ErrorCode::usage, {path.string()},
           "parameter '" + name + "' is declared, but nothing in the pattern uses it");

  if (const auto table = root.find("table"); table && given) {
    pattern.table = *given;
    pattern.table->file = table->string();
  } else if (table) {
    const fs::path file = named_file(*table, path.parent_path());
    bytes += read_file(file);
    pattern.table = read_dense_table(file);
    pattern.table->file = table->string();
  }
  pattern.sha256 = sha256(bytes);
  return pattern;
}

std::string robot_of(const Pattern& pattern) {
  if (!names_a_path(pattern.robot)) return pattern.robot;
  return (fs::path(pattern.file).parent_path() / pattern.robot).string();
}

PostureLibrary read_posture_library(const fs::path& path) {
  Pattern pattern;
  PostureLibrary library = read_library(path, pattern).library;
  library.postures = std::move(pattern.postures);
  return library;
}

}  // namespace ayumi
