#include "names.hpp"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/laws/viip.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "ayumi/limits/finding.hpp"
#include "equations.hpp"
#include "pattern_input.hpp"
#include "simulation.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;

/// The robot, and the pattern or the library of postures, that are known from the command line.
struct Named {
  std::optional<RobotModel> robot;
  std::optional<Pattern> pattern;
  std::optional<PostureLibrary> library;
  bool by_word = false;  ///< true: a word names the robot; false: it is the robot that `new` uses
};

template <class Read>
auto tried(const Read& read) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error&) {
    return std::nullopt;
  }
}

Named named_by(const Context& context, const std::vector<std::string>& words) {
  const RobotSearch search = robot_search(context);
  Named named;
  const auto load = [&](const std::string& name) {
    if (!named.robot) named.robot = tried([&] { return load_robot(name, search); });
  };
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--robot" && i + 1 < words.size()) load(words[i + 1]);
    if (words[i].starts_with("--robot=")) load(words[i].substr(8));
  }
  for (const std::string& word : words) {
    const bool file_known = named.pattern || named.library;
    if (word.empty() || word.front() == '-' || (named.robot && file_known)) continue;
    if (!file_known && fs::path(word).extension() == ".json") {
      named.pattern = tried([&] { return read_given_pattern(word, {}); });
      if (!named.pattern) named.library = tried([&] { return read_posture_library(word); });
    }
    if (named.pattern) load(robot_of(*named.pattern));
    if (named.library && !named.library->robot.empty()) load(named.library->robot);
    if (fs::is_regular_file(fs::path(word) / "run.json"))
      if (const auto log = tried([&] { return read_run_log(word, ""); }))
        load(log->provenance.robot);
    if (fs::exists(word) || word.find('/') == std::string::npos) load(word);
  }
  named.by_word = named.robot.has_value();
  if (!named.robot) load("hoap1");
  return named;
}

std::set<std::string> posture_names(const Named& named) {
  std::set<std::string> names;
  if (named.library) {
    for (const auto& entry : named.library->postures) names.insert(entry.first);
    return names;
  }
  if (named.robot)
    for (const auto& entry : named.robot->description().postures) names.insert(entry.first);
  if (named.pattern)
    for (const auto& entry : named.pattern->postures) names.insert(entry.first);
  return names;
}

std::set<std::string> gain_names() {
  std::set<std::string> names = {"k", "d"};
  for (const auto& gain : gains_of(DtadParams())) names.insert(gain.first);
  DtadParams baseline;
  for (const std::string& name : controller_names()) {
    baseline.kind = controller_type(name).kind;
    if (!is_baseline(baseline.kind)) continue;
    for (const auto& gain : gains_of(baseline)) names.insert(gain.first);
  }
  for (const auto& gain : gains_of(ViipParams())) names.insert(gain.first);
  return names;
}

std::set<std::string> names_of(const Context& context, const std::string& kind,
                               const std::vector<std::string>& words) {
  std::set<std::string> names;
  if (kind == "robots")
    for (const RobotEntry& entry : find_robots(robot_search(context))) names.insert(entry.name);
  if (kind == "gains") names = gain_names();
  if (kind == "findings") names = {finding_kind_names().begin(), finding_kind_names().end()};
  if (kind == "controllers") return {controller_names().begin(), controller_names().end()};
  if (kind == "plants") {
    const std::vector<std::string> plants = built_plants();
    return {plants.begin(), plants.end()};
  }
  if (kind == "equations")
    for (const Equation& equation : equations()) names.insert(std::to_string(equation.number));
  if (kind != "joints" && kind != "postures" && kind != "profiles") return names;
  const Named named = named_by(context, words);
  if (kind == "postures") return posture_names(named);
  if (!named.robot) return names;
  const std::vector<std::string> known =
      kind == "joints" ? named.robot->dof_names() : named.robot->profile_names();
  return {known.begin(), known.end()};
}

}  // namespace

void print_names(const Context& context, const std::string& kinds,
                 const std::vector<std::string>& words) {
  std::vector<std::string> each;
  std::istringstream list(kinds);
  for (std::string kind; std::getline(list, kind, ',');) each.push_back(kind);
  // The robot has to be named before anything that belongs to it.
  if (each.size() > 1 && each.front() == "robots") {
    if (named_by(context, words).by_word)
      each.erase(each.begin());
    else
      each.resize(1);
  }
  for (const std::string& kind : each)
    for (const std::string& name : names_of(context, kind, words))
      std::printf("%s\n", text::printable(name).c_str());
}

}  // namespace ayumi::app
