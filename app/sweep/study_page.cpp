#include "sweep/study_page.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/statistics.hpp"
#include "ayumi/report/html.hpp"
#include "ayumi/report/page.hpp"
#include "ayumi/report/report.hpp"

namespace ayumi::app {

using Json = nlohmann::ordered_json;

namespace {

/// Largest number of values that a table or a map shows one by one; more values are grouped into
/// intervals. Chosen: as many rows as a screen has.
constexpr long kShownValues = 24;
/// Number of intervals of a setting with more values. Chosen: with 100 cases, each interval has
/// about 12.
constexpr int kIntervals = 8;
/// Largest number of maps on one page. Chosen: all pairs of five settings. If there are more pairs,
/// those with the most cells are shown.
constexpr size_t kMostMaps = 10;
/// Largest number of rows in the table of the worst cases and in that of the cases that could not
/// be run. Chosen: more rows are in the database.
constexpr int kShownCases = 50;
/// Size of one replay [bytes]. Chosen: three of them make a page of about 8 MB.
constexpr size_t kReplayBytes = 2'500'000;

constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src data: blob:; frame-src 'self'; base-uri 'none'; "
    "form-action 'none'";

constexpr const char* kStyle =
    "table.sorts th[scope=col]{cursor:pointer;text-decoration:underline dotted}\n"
    "th[aria-sort=ascending]::after{content:\" \\25B2\"}\n"
    "th[aria-sort=descending]::after{content:\" \\25BC\"}\n"
    ".pair{display:flex;flex-wrap:wrap;gap:0 3em}\n.maps{max-width:100%;overflow-x:auto}\n"
    ".maps caption,#rates td{white-space:nowrap}\n.maps th[scope=col]{text-align:center}\n"
    "td.map{text-align:center;min-width:4em}\niframe{width:100%;height:80vh;border:1px solid "
    "#8888}\n";

/// A click (or Enter) on the head of a column sorts the rows by it; a second one reverses the
/// order. A replay is put into its frame when it is opened.
constexpr const char* kScript = R"(
for (const table of document.querySelectorAll("table")) {
  const heads = table.querySelectorAll("th[scope=col]");
  if (heads.length === 0 || table.closest(".maps")) continue;
  table.classList.add("sorts");
  heads.forEach((head, column) => {
    head.tabIndex = 0;
    const sort = () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((each) => each.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const text = (row) => row.cells[column] ? row.cells[column].textContent : "";
      const rows = [...table.rows].filter((row) => !row.querySelector("th[scope=col]"));
      rows.sort((a, b) => {
        const x = parseFloat(text(a)), y = parseFloat(text(b));
        const order = isNaN(x) || isNaN(y) ? text(a).localeCompare(text(b)) : x - y;
        return down ? -order : order;
      });
      rows.forEach((row) => row.parentNode.appendChild(row));
    };
    head.addEventListener("click", sort);
    head.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(); });
  });
}
for (const details of document.querySelectorAll("details.replay"))
  details.addEventListener("toggle", () => {
    const frame = details.querySelector("iframe");
    if (details.open && !frame.srcdoc)
      frame.srcdoc = JSON.parse(details.querySelector("script").textContent);
  });
)";

std::string percent(double share) { return text::fixed(100 * share, 1); }

std::string rate_text(long failures, long runs) {
  if (runs == 0) return "";
  const RateInterval rate = clopper_pearson(failures, runs, kRateConfidence);
  return percent(rate.low) + " to " + percent(rate.high);
}

/// A setting by which cases are grouped, with an SQL expression for the group and the name of each
/// group.
struct Grouping {
  std::string axis, expression;
  std::map<std::string, std::string> names;  ///< names by the cell of the group
  std::vector<std::string> order;
};

double number(const std::string& cell) { return std::atof(cell.c_str()); }

/// The grouping by a setting; empty if the setting has many words, or one value.
Grouping grouping(const ResultsDatabase& results, size_t axis) {
  const SweepHead& head = results.head();
  const std::string name = sql_name(head.axes[axis]);
  Grouping g;
  g.axis = head.axes[axis];
  const auto extent = results
                          .query("SELECT COUNT(DISTINCT " + name + "), MIN(" + name + "), MAX(" +
                                 name + ") FROM cases")
                          .at(0);
  const long distinct = std::atol(extent[0].c_str());
  const bool words = head.axis_types[axis] == "TEXT";
  if (distinct < 1 || (words && distinct > 4 * kShownValues)) return g;
  if (distinct <= kShownValues || words) {
    g.expression = name;
    for (const auto& row : results.query("SELECT DISTINCT " + name + " FROM cases ORDER BY 1")) {
      g.order.push_back(row[0]);
      g.names[row[0]] = row[0].empty() ? "not set"
                        : words        ? row[0]
                                       : text::brief(number(row[0]), 6);
    }
    return g;
  }
  const double low = number(extent[1]), width = (number(extent[2]) - low) / kIntervals;
  g.expression = "MIN(" + std::to_string(kIntervals - 1) + ", CAST((" + name + " - (" +
                 text::exact(low) + ")) / (" + text::exact(width) + ") AS INTEGER))";
  for (int i = 0; i < kIntervals; ++i) {
    g.order.push_back(std::to_string(i));
    g.names[g.order.back()] =
        text::brief(low + i * width, 4) + " to " + text::brief(low + (i + 1) * width, 4);
  }
  return g;
}

bool has_column(const SweepHead& head, const std::string& name) {
  return std::any_of(head.columns.begin(), head.columns.end(),
                     [&](const ResultColumn& c) { return c.name == name; });
}

std::string rates_section(const ResultsDatabase& results, const std::vector<Grouping>& groups) {
  std::string out;
  for (const Grouping& g : groups) {
    if (g.expression.empty()) continue;
    html::Table table{.caption = "By " + g.axis,
                      .head = {g.axis, "runs", "falls", "not settled", "failure rate, %",
                               "95 % interval, %", "could not be run"},
                      .rows = {}};
    std::map<std::string, std::vector<std::string>> rows;
    for (const auto& row : results.query(
             "SELECT " + g.expression +
             " AS g, COUNT(outcome), CAST(TOTAL(outcome = 'fell') AS INTEGER), "
             "CAST(TOTAL(outcome = 'unsettled') AS INTEGER), COUNT(error) FROM cases GROUP BY g"))
      rows[row[0]] = row;
    for (const std::string& group : g.order) {
      if (!rows.contains(group)) continue;
      const auto& row = rows[group];
      const long runs = std::atol(row[1].c_str());
      const long failures = std::atol(row[2].c_str()) + std::atol(row[3].c_str());
      table.rows.push_back({html::escaped(g.names.at(group)), row[1], row[2], row[3],
                            runs ? percent(double(failures) / double(runs)) : "",
                            rate_text(failures, runs), row[4]});
    }
    out += html::table(table);
  }
  if (out.empty()) return "";
  return html::section("rates", "Failure rates",
                       "<p>A run fails when the robot falls or does not settle. The intervals are "
                       "those of Clopper and Pearson.</p>\n" +
                           out);
}

/// A colour from white to red.
std::string colour(double share) {
  const int fade = static_cast<int>(std::lround(255 - 155 * std::clamp(share, 0.0, 1.0)));
  return "background:rgb(255," + std::to_string(fade) + "," + std::to_string(fade) + ");color:#000";
}

std::string map_table(const ResultsDatabase& results, const Grouping& x, const Grouping& y,
                      const std::string& what, const std::string& expression, double scale) {
  std::map<std::pair<std::string, std::string>, std::pair<double, std::string>> cells;
  double low = 0, high = 0;
  for (const auto& row :
       results.query("SELECT " + x.expression + " AS g, " + y.expression + " AS h, AVG(" +
                     expression + "), COUNT(" + expression + ") FROM cases GROUP BY g, h")) {
    if (row[2].empty()) continue;
    const double value = scale * number(row[2]);
    low = cells.empty() ? value : std::min(low, value);
    high = cells.empty() ? value : std::max(high, value);
    cells[{row[0], row[1]}] = {value, row[3]};
  }
  if (cells.empty()) return "";
  std::string out = "<div class=\"wide maps\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                    html::escaped(what + ": " + y.axis + " and " + x.axis) +
                    "\"><table>\n<caption>" + html::escaped(what) + "</caption>\n<tr><th></th>";
  for (const std::string& group : x.order)
    out += "<th scope=\"col\">" + html::escaped(x.names.at(group)) + "</th>";
  out += "</tr>\n";
  for (const std::string& row : y.order) {
    out += "<tr><th scope=\"row\">" + html::escaped(y.names.at(row)) + "</th>";
    for (const std::string& column : x.order) {
      const auto found = cells.find({column, row});
      if (found == cells.end()) {
        out += "<td class=\"map\">–</td>";
        continue;
      }
      const double share = high > low ? (found->second.first - low) / (high - low) : 0;
      out += "<td class=\"map\" style=\"" + colour(share) + "\" title=\"" + found->second.second +
             " cases\">" + text::brief(found->second.first, 3) + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string maps_section(const ResultsDatabase& results, const std::vector<Grouping>& groups) {
  const SweepHead& head = results.head();
  std::vector<const Grouping*> usable;
  for (const Grouping& g : groups)
    if (g.order.size() > 1 && !g.expression.empty()) usable.push_back(&g);
  struct Quantity {
    std::string what, expression;
    double scale;
  };
  std::vector<Quantity> quantities;
  if (results.counts().stands + results.counts().failures() > 0) {
    quantities.push_back({"Failure rate, %", "outcome <> 'stands'", 100});
    quantities.push_back({"Mean of the largest COG error, mm", "max_cog_error_m", 1000});
  }
  if (has_column(head, "consistent"))
    quantities.push_back({"Inconsistent, %", "consistent = 0", 100});
  if (has_column(head, "push_worst_B"))
    quantities.push_back({"Largest push in the worst direction, B", "push_worst_B", 1});
  std::vector<std::pair<const Grouping*, const Grouping*>> pairs;
  for (size_t i = 0; i < usable.size(); ++i)
    for (size_t j = i + 1; j < usable.size(); ++j) pairs.emplace_back(usable[i], usable[j]);
  std::stable_sort(pairs.begin(), pairs.end(), [](const auto& a, const auto& b) {
    return a.first->order.size() * a.second->order.size() >
           b.first->order.size() * b.second->order.size();
  });
  std::string out;
  for (size_t i = 0; i < std::min(pairs.size(), kMostMaps); ++i) {
    const Grouping &down = *pairs[i].first, &across = *pairs[i].second;
    std::string maps;
    for (const Quantity& q : quantities)
      maps += map_table(results, across, down, q.what, q.expression, q.scale);
    if (!maps.empty())
      out += "<h3>" + html::escaped(down.axis) + " (down) and " + html::escaped(across.axis) +
             " (across)</h3>\n<div class=\"pair\">" + maps + "</div>\n";
  }
  if (out.empty()) return "";
  if (pairs.size() > kMostMaps)
    out += "<p class=\"soft\">The maps show the " + std::to_string(kMostMaps) +
           " pairs of settings with the most values. " + std::to_string(pairs.size() - kMostMaps) +
           " more pairs are not drawn.</p>\n";
  return html::section("maps", "Maps of two settings", out);
}

std::string cell_text(const Json& value) {
  if (value.is_string()) return html::escaped(value.get<std::string>());
  if (value.is_number_integer()) return std::to_string(value.get<long>());
  if (value.is_number()) return text::brief(value.get<double>(), 5);
  return "";
}

std::string worst_table(const ResultsDatabase& results, const Json& worst) {
  const SweepHead& head = results.head();
  html::Table table{.caption = "The worst cases", .head = {"case"}, .rows = {}};
  std::vector<std::string> names = head.axes;
  for (const ResultColumn& column : head.columns)
    if (column.name != "severity") names.push_back(column.name);
  table.head.insert(table.head.end(), names.begin(), names.end());
  for (const Json& row : worst) {
    std::vector<std::string> cells = {cell_text(row.at("case"))};
    for (const std::string& name : names)
      cells.push_back(row.contains(name) ? cell_text(row.at(name)) : "");
    table.rows.push_back(cells);
  }
  return table.rows.empty() ? "" : html::table(table);
}

std::string replay_of(const CaseRunner& runner, const Json& row) {
  const long number = row.at("case");
  std::shared_ptr<const Task> task;
  const SimulationLog log = runner.simulate(number, task);
  const std::string title = runner.study().name() + ", case " + std::to_string(number);
  ReportInput input;
  input.title = title;
  const bool open = log.controller && log.controller->kind == ControllerKind::none;
  input.runs = {{open ? "open loop" : "closed loop", &log}};
  const Report report =
      make_report(runner.robot_to_draw(number), input, {.max_bytes = kReplayBytes});
  std::string words = "Case " + std::to_string(number) + ": " + cell_text(row.at("outcome"));
  for (const std::string& axis : runner.study().axes())
    if (row.contains(axis)) words += ", " + html::escaped(axis) + " " + cell_text(row.at(axis));
  return "<details class=\"replay\"><summary>" + words + "</summary><iframe title=\"" +
         html::escaped(title) +
         "\" sandbox=\"allow-scripts\"></iframe><script type=\"application/json\">" +
         html::quoted(report.html) + "</script></details>\n";
}

std::string provenance(const SweepHead& head) {
  html::Table table{.caption = "Inputs", .head = {"input", "name", "SHA-256"}, .rows = {}};
  for (const SweepInput& input : head.inputs)
    table.rows.push_back({input.kind, html::escaped(input.name), input.sha256});
  return html::section("provenance", "Provenance",
                       "<p>Ayumi " + html::escaped(head.version) + ", seed " +
                           html::escaped(head.seed) + ".</p>\n" + html::table(table) +
                           "<details><summary>The study</summary><pre>" +
                           html::escaped(head.study_text) + "</pre></details>\n");
}

}  // namespace

std::string study_page(const ResultsDatabase& results, const std::vector<Expectation>& expectations,
                       const CaseRunner* runner, int replays, const Progress& progress) {
  const SweepHead& head = results.head();
  const SweepCounts counts = results.counts();
  std::vector<Grouping> groups;
  for (size_t i = 0; i < head.axes.size(); ++i)
    if (head.axes[i] != "seed" && head.axes[i] != "draw") groups.push_back(grouping(results, i));
  const long runs = counts.stands + counts.failures();
  std::string verdict = "<p>" + text::counted(counts.done, "case") + " of " +
                        std::to_string(counts.cases) + ": " + std::to_string(counts.stands) +
                        " stand, " + std::to_string(counts.falls) + " fell, " +
                        std::to_string(counts.unsettled) + " did not settle, " +
                        std::to_string(counts.errors) + " could not be run.</p>\n";
  if (runs > 0)
    verdict += "<p>Failure rate " + percent(double(counts.failures()) / double(runs)) + " % (" +
               rate_text(counts.failures(), runs) + " % with 95 % confidence).</p>\n";
  html::Table expected{.caption = "Expectations", .head = {"expected", "met", "found"}, .rows = {}};
  for (const Expectation& e : expectations)
    expected.rows.push_back({html::escaped(e.text),
                             e.met ? "yes"
                                   : "<strong class=\"bad\">no"
                                     "</strong>",
                             html::escaped(e.found)});
  const Json worst = worst_cases(results, kShownCases);
  std::string worst_text = worst_table(results, worst);
  for (int i = 0; runner && i < std::min<int>(replays, static_cast<int>(worst.size())); ++i) {
    report(progress,
           {"writing the page", double(i) / double(replays), "replay " + std::to_string(i + 1)});
    worst_text += replay_of(*runner, worst[static_cast<size_t>(i)]);
  }
  html::Table errors{.caption = "", .head = {"case", "why"}, .rows = {}};
  for (const auto& row : results.query("SELECT \"case\", error FROM cases WHERE error IS NOT NULL "
                                       "LIMIT " +
                                       std::to_string(kShownCases)))
    errors.rows.push_back({row[0], html::escaped(row[1])});
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"" +
         std::string(kPolicy) + "\">\n<link rel=\"icon\" href=\"data:,\">\n<title>" +
         html::escaped(head.name) + "</title>\n<style>\n" + std::string(kPageStyle) + kStyle +
         "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#verdict\">To the verdict</a>\n"
         "<header><h1>" +
         html::escaped(head.name) + "</h1></header>\n<main>\n" +
         html::section("verdict", "Verdict", verdict + html::table(expected)) +
         rates_section(results, groups) + maps_section(results, groups) +
         (worst_text.empty() ? "" : html::section("worst", "Worst cases", worst_text)) +
         (errors.rows.empty()
              ? ""
              : html::section("errors", "Cases that could not be run", html::table(errors))) +
         provenance(head) + "</main>\n<script>" + kScript + "</script>\n</body>\n</html>\n";
}

}  // namespace ayumi::app
