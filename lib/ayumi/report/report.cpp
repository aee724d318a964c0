#include "ayumi/report/report.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/plot/com_zmp_plot.hpp"
#include "ayumi/plot/com_zmp_plot_parts.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/render/simplify.hpp"
#include "ayumi/render/snapshots.hpp"
#include "ayumi/report/html.hpp"
#include "ayumi/report/page.hpp"
#include "ayumi/report/replay.hpp"
#include "ayumi/report/sections.hpp"

// A page that is too large is made again with a coarser replay: the number of triangles is halved
// until it reaches its lower limit, and then the rate; then the page is made without the snapshots,
// and at last without the replay.

namespace ayumi {
namespace {

// Limits that keep the page within its size: the largest number of keys of the replay, the smallest
// number of triangles to which the robot is reduced, and the lowest rate of keys [Hz], between
// which the replay interpolates.
constexpr double kMostKeys = 4000;
constexpr size_t kFewestTriangles = 4000;
constexpr double kLeastRate = 10;

/// The browser may only use what is in the page.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src data: blob:; base-uri 'none'; form-action 'none'";

std::vector<LociRun> loci_runs(const ReportInput& input) {
  std::vector<LociRun> runs;
  for (const ReportRun& run : input.runs)
    if (!run.recorded) runs.push_back({html::name_of(run), run.log});
  return runs;
}

/// The drawing as an element of the page.
std::string inline_svg(const Drawing& drawing) {
  const std::string svg = to_svg(drawing);
  return svg.substr(svg.find("<svg"));
}

// Widths for which curves are laid out [pixel]: half of a window of 1280 pixels, and a telephone of
// 360 pixels without its margins. Letters keep their size of 11 pixels in both.
constexpr double kWideCurves = 600, kNarrowCurves = 326;

/// Plots over time and from above, for one width.
std::string curves(const RobotModel& model, const ReportInput& input, double width,
                   const std::string& kind) {
  const std::vector<LociRun> runs = loci_runs(input);
  LociOptions options;
  options.title = input.title;
  options.model = &model;
  options.width = width;
  const Drawing time = draw_loci(runs, options);
  const Interval range = plot::time_range(&model, runs, options);
  double top = time.height;  // top of the panels, where the cursor begins
  for (const auto& item : time.items)
    if (const auto* path = std::get_if<DrawnPath>(&item); path && path->closed)
      for (const Eigen::Vector2d& point : path->points) top = std::min(top, point.y());
  return "<div class=\"" + kind + "\">\n<figure data-time-axis=\"" + text::exact(plot::kLeft) +
         " " + text::exact(time.width - plot::kRight) + " " + text::exact(range.low) + " " +
         text::exact(range.high) + " " + text::exact(top) + "\">\n" + inline_svg(time) +
         "<figcaption>The joints that move most, the COG, the ZMP and the ground force against "
         "time. "
         "Drag in the plot to change the time of the replay.</figcaption></figure>\n<figure>\n" +
         inline_svg(draw_support(model, runs, options)) +
         "<figcaption>The ground from above. Each foothold has its number, the foot and the time "
         "of "
         "the landing.</figcaption></figure>\n</div>\n";
}

std::string loci_section(const RobotModel& model, const ReportInput& input) {
  return html::section("loci", "Curves",
                       curves(model, input, kWideCurves, "wide-curves") +
                           curves(model, input, kNarrowCurves, "narrow-curves"));
}

std::string picture(const PngPicture& picture, const std::string& words) {
  return "<img width=\"" + std::to_string(picture.width) + "\" height=\"" +
         std::to_string(picture.height) + "\" alt=\"" + escaped(words) +
         "\" src=\"data:image/png;base64," + html::base64(picture.bytes) + "\">";
}

std::string poster(const RobotModel& model, std::shared_ptr<const RobotLook> look,
                   const ReportInput& input) {
  const SimulationLog& log = *input.runs.back().log;
  ClipOptions options;
  options.look = std::move(look);
  options.picture.width = 1024;
  options.picture.height = 576;
  options.title = input.title;
  const double t = telling_instant(log);
  const Image frame = ClipRenderer(model, log, options).frame(t);
  return picture({frame.width, frame.height, encode_png(frame)},
                 "The robot " + model.name() + " at " + text::fixed(t, 2) + " s of the " +
                     html::name_of(input.runs.back()));
}

std::string snapshots_section(const PngPicture& strip, const ReportInput& input) {
  return html::section(
      "snapshots", "Snapshots",
      "<figure class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Snapshots\">" +
          picture(strip, "Eight snapshots of the " + html::name_of(input.runs.back()) +
                             ": the pushes, the extreme postures, and postures between them") +
          "</figure>\n");
}

std::string check_box(const std::string& mark, const std::string& label) {
  return "<label><input type=\"checkbox\" id=\"mark-" + mark + "\" checked> " + label +
         "</label>\n";
}

std::string options(const std::vector<std::pair<std::string, std::string>>& entries) {
  std::string out;
  for (const auto& [value, label] : entries)
    out += "<option value=\"" + escaped(value) + "\">" + escaped(label) + "</option>";
  return out;
}

std::string controls(const ReplayData& data, double rate) {
  std::vector<std::pair<std::string, std::string>> ghosts = {{"", "none"}};
  for (const std::string& name : data.ghosts) ghosts.emplace_back(name, name);
  return "<div id=\"controls\" hidden>\n<div><button type=\"button\" id=\"play\">Play</button>\n"
         "<label for=\"scrub\">Time</label> <input type=\"range\" id=\"scrub\" min=\"0\" max=\"" +
         text::exact(data.duration) + "\" step=\"" + text::exact(1 / rate) + "\" value=\"" +
         text::exact(data.start) +
         "\">\n<label>Speed <select id=\"speed\"><option value=\"1\">1</option>"
         "<option value=\"0.5\">1/2</option><option value=\"0.2\">1/5</option>"
         "<option value=\"0.05\">1/20</option></select></label>\n"
         "<label>View <select id=\"view\">" +
         options({{"iso", "iso"},
                  {"front", "front"},
                  {"side", "side"},
                  {"back", "back"},
                  {"top", "top"}}) +
         "</select></label>\n<label>Ghost <select id=\"ghost\">" + options(ghosts) +
         "</select></label></div>\n<fieldset><legend>Marks</legend>\n" + check_box("cog", "COG") +
         check_box("zmp", "ZMP") + check_box("ref-zmp", "reference ZMP") +
         check_box("support", "support polygon") + check_box("forces", "foot forces") +
         check_box("push", "push") +
         "</fieldset>\n<div id=\"readout\"></div>\n<div id=\"push-now\" "
         "class=\"bad\"></div>\n</div>\n";
}

std::string data_element(const std::string& id, const std::string& type,
                         const std::string& contents) {
  return "<script type=\"" + type + "\" id=\"" + id + "\">" + contents + "</script>\n";
}

/// The parts of the page that do not depend on the plan of the replay.
struct Pieces {
  std::string poster, loci, snapshots;
};

struct Plan {
  ReplayPlan replay;
  bool with_replay = true, with_snapshots = true;
};

std::string page(const RobotModel& model, const RobotLook& look, const ReportInput& input,
                 const Pieces& pieces, const Plan& plan, const std::vector<std::string>& caps) {
  std::string head =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  head += std::string(kPolicy) + "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
          escaped(input.title) + "</title>\n<style>\n" + std::string(kPageStyle) +
          "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#verdict\">To the verdict</a>\n"
          "<header><h1>" +
          escaped(input.title) + "</h1>\n<p class=\"soft\">" + escaped(model.name()) + ", " +
          text::fixed(model.mass(), 2) + " kg, " + std::to_string(model.dof_count()) + " joints; " +
          text::fixed(duration(*input.runs.back().log), 2) + " s</p></header>\n<main>\n";
  std::string scene =
      "<figure class=\"scene\"><div id=\"stage\">" + pieces.poster + "</div></figure>\n";
  std::string script;
  if (plan.with_replay) {
    const ReplayData data = make_replay(model, look, input, plan.replay);
    scene += controls(data, plan.replay.rate) +
             "<p id=\"replay-state\" class=\"soft\" role=\"status\"></p>\n"
             "<noscript><p class=\"soft\">If JavaScript is on, this picture becomes a "
             "replay.</p></noscript>\n";
    script = data_element("replay-config", "application/json", data.config) +
             data_element("replay-series", "text/plain", html::base64(data.series)) +
             data_element("replay-scenery", "text/plain", html::base64(data.scenery)) +
             data_element("replay-model", "text/plain", html::base64(data.model)) + "<script>\n" +
             std::string(kReplayScript) + "</script>\n";
  }
  // The scene stays visible beside the curves, or above them if the window is narrow.
  return head + html::verdict_section(input) + "<div id=\"watch\">\n" +
         html::section("replay", plan.with_replay ? "Replay" : "Picture", scene) + pieces.loci +
         "</div>\n" + html::findings_section(model, input) + html::thresholds_section(input) +
         html::comparison_section(input) + (plan.with_snapshots ? pieces.snapshots : "") +
         html::events_section(input) + html::provenance_section(model, input, caps) + "</main>\n" +
         script + "</body>\n</html>\n";
}

/// Reduces the plan. Returns false if nothing is left to reduce.
bool reduce(Plan& plan, size_t& triangles) {
  if (plan.with_replay && triangles > kFewestTriangles) {
    triangles = std::max(kFewestTriangles, triangles / 2);
    plan.replay.triangles = triangles;
  } else if (plan.with_replay && plan.replay.rate > kLeastRate) {
    plan.replay.rate = std::max(kLeastRate, plan.replay.rate / 2);
  } else if (plan.with_snapshots) {
    plan.with_snapshots = false;
  } else if (plan.with_replay) {
    plan.with_replay = false;
  } else {
    return false;
  }
  return true;
}

std::string size_words(const ReportOptions& options) {
  return text::brief(1e-6 * double(options.max_bytes)) + " MB";
}

std::vector<std::string> caps_of(const Plan& plan, const ReportOptions& options,
                                 const RobotLook& look, const std::string& no_replay) {
  std::vector<std::string> caps;
  if (!no_replay.empty()) caps.push_back(no_replay);
  const size_t triangles = triangle_count(look.surface);
  if (look.moved > 0) caps.push_back(words_of(look, triangles, look.moved));
  if (plan.with_replay && triangles > plan.replay.triangles)
    caps.push_back("the replay shows at most " + std::to_string(plan.replay.triangles) +
                   " of the robot's " + std::to_string(triangles) + " triangles");
  if (plan.with_replay)
    caps.push_back("the replay has " + text::brief(plan.replay.rate) +
                   " postures per second and interpolates between them");
  const std::string size = size_words(options);
  if (!plan.with_replay && no_replay.empty())
    caps.push_back("there is no replay, because with a replay the page would be larger than " +
                   size);
  if (!plan.with_snapshots)
    caps.push_back("there are no snapshots, because with snapshots the page would be larger than " +
                   size);
  return caps;
}

}  // namespace

bool has_replay() { return !kReplayScript.empty(); }

Report make_report(const RobotModel& model, const ReportInput& as_logged,
                   const ReportOptions& options, const Progress& progress) {
  if (as_logged.runs.empty()) fail(ErrorCode::usage, "a report needs a simulated run");
  std::vector<SimulationLog> logs;
  logs.reserve(as_logged.runs.size());
  ReportInput input = as_logged;
  for (ReportRun& run : input.runs) {
    require_level_ground(*run.log, options.frame);
    logs.push_back(in_frame(model, *run.log, options.frame));
    run.log = &logs.back();
  }
  const double last = duration(*input.runs.back().log);
  Plan plan;
  plan.with_replay = options.replay && has_replay();
  const std::string no_replay =
      plan.with_replay ? ""
      : !options.replay
          ? "there is no replay, because the report was made with --no-replay"
          : "there is no replay, because the program was built without npm and three.js";
  plan.replay.rate = std::min(options.rate, kMostKeys / std::max(1e-9, last));
  plan.replay.triangles = options.max_triangles;
  report(progress, {"writing the report", 0.0, "loci"});
  Pieces pieces;
  pieces.loci = loci_section(model, input);
  report(progress, {"writing the report", 0.2, "pictures"});
  const std::shared_ptr<const RobotLook> look = options.look ? options.look : robot_look(model);
  pieces.poster = poster(model, look, input);
  ClipOptions clip;
  clip.look = look;
  clip.title = input.title;
  pieces.snapshots = snapshots_section(
      options.snapshots ? *options.snapshots
                        : snapshots_of_run(model, *input.runs.back().log, std::move(clip)),
      input);
  report(progress, {"writing the report", 0.7, "page"});
  size_t allowed = std::min(options.max_triangles, triangle_count(look->surface));
  for (;;) {
    std::vector<std::string> caps = caps_of(plan, options, *look, no_replay);
    Report made = {page(model, *look, input, pieces, plan, caps), caps};
    if (made.html.size() <= options.max_bytes) return made;
    if (!reduce(plan, allowed)) {
      caps.push_back("the page is larger than " + size_words(options) +
                     ", although only verdict, tables, curves and one picture are left");
      return {page(model, *look, input, pieces, plan, caps), caps};
    }
    report(progress, {"writing the report", 0.8, "smaller page"});
  }
}

}  // namespace ayumi
