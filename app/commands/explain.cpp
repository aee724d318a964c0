// An equation of the paper in words and with the numbers of one instant of a run.

#include <charconv>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/run/run_folder.hpp"
#include "commands.hpp"
#include "equations.hpp"
#include "motion_words.hpp"
#include "pattern_input.hpp"
#include "run_robot.hpp"

namespace ayumi::app {

namespace {

using Json = nlohmann::ordered_json;

struct ExplainCommand {
  std::string equation, run, log, robot;
};

const Equation& find_equation(const std::string& word) {
  std::string digits = word;
  std::erase_if(digits, [](char c) { return c == '(' || c == ')'; });
  for (const Equation& e : equations())
    if (std::to_string(e.number) == digits) return e;
  fail(ErrorCode::usage, "explain: there is no equation '" + word +
                             "'. The equations of the paper are 1 to " +
                             std::to_string(equations().back().number));
}

struct Place {
  std::string run;
  double t = 0;
};

Place place_of(const std::string& text) {
  const size_t at = text.rfind('@');
  if (at == std::string::npos)
    fail(ErrorCode::usage, "explain: '" + text + "' has no time. Write RUN@SECONDS");
  Place place{text.substr(0, at)};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + at + 1, end, place.t);
  if (error != std::errc() || rest != end || !std::isfinite(place.t))
    fail(ErrorCode::usage, "explain: '" + text.substr(at + 1) + "' is not a time [s]");
  return place;
}

std::string heading(const Equation& e) {
  return "(" + std::to_string(e.number) + ")  " + e.formula;
}

/// The words in lines of at most 100 letters.
std::string wrapped(const std::string& words) {
  std::string out = "  ";
  size_t column = 2;
  for (size_t i = 0; i < words.size();) {
    const size_t end = std::min(words.find(' ', i), words.size());
    if (column + end - i > 100) {
      out += "\n  ";
      column = 2;
    }
    out += words.substr(i, end - i) + (end < words.size() ? " " : "");
    column += end - i + 1;
    i = end + 1;
  }
  return out + "\n";
}

struct Numbers {
  EquationNumbers of;
  std::string where, controller;
  double t = 0;
  std::map<std::string, std::string> sampled_from;  ///< source of each of the pattern's tracks
};

Numbers numbers_of(const Context& context, const Equation& e, const ExplainCommand& options) {
  const Place place = place_of(options.run);
  const SimulationLog log = read_run_log(place.run, options.log);
  if (log.samples.empty()) fail(ErrorCode::bad_file, place.run + ": the log has no samples");
  const double end = log.dt * static_cast<double>(log.samples.size() - 1);
  if (place.t < 0 || place.t > end + 0.5 * log.dt)
    fail(ErrorCode::usage, "explain: t = " + text::brief(place.t) + " s is outside the run (0 to " +
                               text::fixed(end, 3) + " s)");
  const RobotModel model = robot_of_log(context, options.robot, log, place.run);
  const RunInstant instant{log, model.mass(), static_cast<size_t>(std::lround(place.t / log.dt))};
  Numbers result;
  if (e.numbers) result.of = e.numbers(instant);
  result.where = place.run;
  if (log.controller) result.controller = name_of(*log.controller);
  result.t = log.dt * static_cast<double>(instant.k);
  const std::string origin = read_run_section(place.run, "sampled_from");
  if (!origin.empty()) result.sampled_from = Json::parse(origin);
  return result;
}

void explain(Context& context, const ExplainCommand& options) {
  const Equation& e = find_equation(options.equation);
  std::string out = heading(e) + "\n" + wrapped(e.words);
  Json json = {{"equation", e.number}, {"formula", e.formula}, {"words", e.words}};
  if (!options.run.empty()) {
    const Numbers n = numbers_of(context, e, options);
    out += n.where + ", " + n.controller + ", t = " + text::fixed(n.t, 3) + " s\n";
    if (n.of.lines.empty()) out += "  The log has no numbers for this equation.\n";
    for (const std::string& line : n.of.lines) out += "  " + line + "\n";
    if (!n.sampled_from.empty()) out += origin_words(n.sampled_from);
    Json values = Json::array();
    for (const LoggedValue& v : n.of.values) {
      values.push_back({{"name", v.name}, {"value", v.value}});
      if (v.computed) values.back()["computed"] = *v.computed;
    }
    json.update({{"controller", n.controller},
                 {"t_s", n.t},
                 {"numbers", n.of.lines},
                 {"values", values},
                 {"sampled_from", n.sampled_from}});
  }
  context.print(out);
  context.print_json(json.dump(2));
}

}  // namespace

void add_explain(Command& app, Context& context) {
  Command* command = app.add_subcommand(
      "explain", "explain an equation of the paper in words, and with the numbers of a run");
  command->footer(
      "Examples:\n  ayumi explain 18\n"
      "  ayumi explain 14 out/hoap1_walk@3.05\n"
      "  ayumi explain 14 out/hoap1_walk@3.05 --log open_loop\n"
      "The paper is T. Sugihara and Y. Nakamura, Whole-body Cooperative COG Control through ZMP "
      "Manipulation for Humanoid Robots.");
  auto options = std::make_shared<ExplainCommand>();
  command->add_option("EQ", options->equation, "Number of the equation, 1 to 29.")->required();
  command->add_option("RUN@t", options->run,
                      "Run folder or log file, the sign @, and a time [s], for example out/@2.5.");
  command->add_option("--log", options->log, "Log of the run, for example open_loop.");
  command->add_option("--robot", options->robot,
                      "Robot to use in place of the robot that the run names.");
  command->callback([options, &context] { explain(context, *options); });
}

}  // namespace ayumi::app
