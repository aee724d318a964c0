#include "check_table.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/finding_groups.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/model/diagnose.hpp"
#include "terminal.hpp"

namespace ayumi::app {

namespace {

std::string mm_text(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }

std::string seconds(const Finding& f) {
  if (f.begin == f.end) return "at " + text::fixed(f.at, 3) + " s";
  return text::fixed(f.begin, 3) + "-" + text::fixed(f.end, 3) + " s, worst at " +
         text::fixed(f.at, 3) + " s";
}

std::string whole_percent(double ratio) { return text::fixed(100 * ratio, 0) + " %"; }

std::string severity_word(Severity severity) {
  const std::string word = padded(name_of(severity), 8);
  return severity == Severity::error     ? painted(Paint::bad, word)
         : severity == Severity::warning ? painted(Paint::caution, word)
                                         : word;
}

std::string entry(const Finding& f, const std::string& where_and_when) {
  return "  " + severity_word(f.severity) + padded(name_of(f.kind), 19) + where_and_when + ": " +
         amount_text(f) + "\n" + std::string(10, ' ') + f.hint + "\n";
}

std::string entry_of(const ConsistencyReport& report, const FindingGroup& group) {
  const Finding& worst = report.findings[group.worst];
  std::string out;
  if (group.members.size() == 1) {
    out = entry(worst, worst.where + ", " + seconds(worst));
  } else {
    const Finding& first = report.findings[group.members.front()];
    double end = first.end;
    for (const int i : group.members) end = std::max(end, report.findings[i].end);
    out = entry(worst, text::join(group.places, " and ") + ", " +
                           text::counted(group.members.size(), "time") + " within " +
                           text::fixed(first.begin, 3) + "-" + text::fixed(end, 3) + " s, worst " +
                           (group.places.size() > 1 ? worst.where + " " : "") + "at " +
                           text::fixed(worst.at, 3) + " s");
  }
  std::vector<std::string> parts;
  for (const GroupConsequence& c : group.consequences) {
    const Finding& f = report.findings[c.worst];
    parts.push_back(std::string(name_of(c.kind)) + " (" +
                    (c.count > 1 ? text::counted(c.count, "time") + ", worst " : "") + f.where +
                    " at " + text::fixed(f.at, 3) + " s: " + amount_text(f) + ")");
  }
  if (!parts.empty())
    out += std::string(10, ' ') + "consequences: " + text::join(parts, ", ") + "\n";
  return out;
}

std::string all_findings(const ConsistencyReport& report) {
  std::string out;
  for (const Finding& f : report.findings) out += entry(f, f.where + ", " + seconds(f));
  return out;
}

std::string causes(const ConsistencyReport& report, const RobotModel& model) {
  const std::vector<FindingGroup> groups = finding_groups(report, model);
  std::string out;
  for (size_t i = 0; i < groups.size() && i < kMostGroups; ++i) out += entry_of(report, groups[i]);
  if (groups.size() > kMostGroups)
    out += "  " + text::counted(groups.size() - kMostGroups, "more group") +
           " of findings; `ayumi check --all` prints every finding\n";
  return out;
}

// Where and when a figure is reached.
std::string figure_place(const ConsistencyReport& report, FindingKind kind) {
  const FigurePlace& p = report.summary_at[kind];
  if (!std::isfinite(p.at)) return {};
  return " (" + (p.where.empty() ? "" : p.where + " ") + "at " + text::fixed(p.at, 2) + " s)";
}

}  // namespace

bool has_limit(const ConsistencyReport& report, FindingKind kind) {
  const bool of_motor = kind == FindingKind::joint_speed || kind == FindingKind::joint_torque ||
                        kind == FindingKind::continuous_torque;
  return !of_motor || std::isfinite(report.summary_at[kind].at);
}

std::string shares_of_limits(const ConsistencyReport& report) {
  std::vector<std::string> shares;
  for (const FindingSpec* spec : summary_figures())
    if (spec->figure.share_name)
      shares.push_back(std::string(spec->figure.share_name) + " " +
                       (has_limit(report, spec->kind) ? whole_percent(report.summary[spec->kind]) +
                                                            figure_place(report, spec->kind)
                                                      : "without limits"));
  return text::join(shares, ", ");
}

std::string check_table(const ConsistencyReport& report, const RobotModel& model, Shown shown) {
  std::string out = shown == Shown::findings ? all_findings(report) : causes(report, model);
  const auto at = [&](FindingKind kind) { return report.summary[kind]; };
  const auto place = [&](FindingKind kind) { return figure_place(report, kind); };
  const double margin = at(FindingKind::support_margin);
  out += "  ZMP " + mm_text(std::abs(margin)) + (margin < 0 ? " outside" : " inside") +
         " the support" + place(FindingKind::support_margin) +
         "; the posture differs from the keys by " + mm_text(at(FindingKind::cog_residual)) +
         " in COG, " + mm_text(at(FindingKind::zmp_residual)) + " in ZMP and " +
         text::fixed(at(FindingKind::fz_residual), 2) +
         " N in force; the ZMP of the point-mass model is " +
         mm_text(at(FindingKind::point_mass_gap)) + " from the command\n";
  out += "  share of the limits: " + shares_of_limits(report) + "\n";
  out += "  feet: slip " + mm_text(at(FindingKind::foot_slip)) + ", sink " +
         mm_text(at(FindingKind::foot_penetration)) + ", gap while standing " +
         mm_text(at(FindingKind::foot_float)) + "; ";
  const std::vector<std::string> bare = bodies_without_collision_shapes(model);
  const double apart = at(FindingKind::self_collision);
  if (std::isnan(apart))
    out += "self-collisions are not checked, because the legs have no collision shapes";
  else
    out += (apart < 0 ? "bodies overlap by " + mm_text(-apart)
                      : "nearest bodies " + mm_text(apart) + " apart") +
           place(FindingKind::self_collision);
  if (!std::isnan(apart) && !bare.empty())
    out += "; self-collisions of " + text::join(bare, ", ") +
           " are not checked, because these bodies have no collision shapes";
  out += "\n";
  return out;
}

std::string mistake_words(const std::vector<Mistake>& mistakes, const char* heading) {
  std::string words;
  for (const std::string& cause : cause_texts(mistakes))
    words += "  " + painted(Paint::caution, heading) + " " + cause + "\n";
  return words;
}

std::string search_words(const std::vector<Mistake>& mistakes) {
  std::string words;
  for (const Mistake& mistake : mistakes)
    if (!mistake.is_cause) words += "  " + mistake.words + "\n";
  return words;
}

std::string tolerance_table() {
  std::string out;
  for (const FindingSpec* spec : finding_specs())
    out += padded(name_of(spec->kind), 20) +
           padded(text::brief(spec->tolerance) +
                      (std::string(spec->unit) == "1" ? "" : " " + std::string(spec->unit)),
                  14) +
           spec->meaning + "\n";
  return out;
}

}  // namespace ayumi::app
