#include "check_table.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/in_brackets.hpp"
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

// Column at which the hint below a finding begins.
constexpr size_t kHang = 10;

std::string whole_percent(double ratio) { return text::fixed(100 * ratio, 0) + " %"; }

std::string severity_word(Severity severity) {
  const std::string word = padded(name_of(severity), 8);
  return severity == Severity::error     ? painted(Paint::bad, word)
         : severity == Severity::warning ? painted(Paint::caution, word)
                                         : word;
}

std::string entry(const Finding& f, const std::string& where_and_when) {
  return "  " + severity_word(f.severity) + padded(name_of(f.kind), 19) + where_and_when + ": " +
         amount_text(f) + "\n";
}

std::string hint(const Finding& f) { return std::string(kHang, ' ') + f.hint + "\n"; }

// The entry for several findings, of which `worst` is the worst.
std::string entry_of_many(const ConsistencyReport& report, const std::vector<int>& members,
                          const Finding& worst, const std::string& places, bool name_worst) {
  double begin = worst.begin, end = worst.end;
  for (const int i : members) {
    begin = std::min(begin, report.findings[i].begin);
    end = std::max(end, report.findings[i].end);
  }
  return entry(worst, places + ", " + text::counted(members.size(), "time") + " within " +
                          text::fixed(begin, 3) + "-" + text::fixed(end, 3) + " s, worst " +
                          (name_worst ? place_words(worst.where) + " " : "") + "at " +
                          text::fixed(worst.at, 3) + " s");
}

// Largest number of places that are named. Chosen: if there are more, they are counted.
constexpr size_t kPlacesNamed = 3;

std::string names_of_places(const std::vector<std::string>& places) {
  if (places.size() <= kPlacesNamed) return text::join(places, " and ");
  return places.front() + " and " + std::to_string(places.size() - 1) + " more places";
}

std::string entry_of(const ConsistencyReport& report, const FindingGroup& group) {
  const Finding& worst = report.findings[group.worst];
  if (group.members.size() == 1)
    return entry(worst, place_words(worst.where) + ", " + seconds(worst));
  return entry_of_many(report, group.members, worst, names_of_places(group.places),
                       group.places.size() > 1);
}

std::string consequences(const ConsistencyReport& report, const FindingGroup& group) {
  std::vector<std::string> parts;
  for (const GroupConsequence& c : group.consequences) {
    const Finding& f = report.findings[c.worst];
    parts.push_back(std::string(name_of(c.kind)) + " (" +
                    (c.count > 1 ? text::counted(c.count, "time") + ", worst " : "") +
                    place_words(f.where) + " at " + text::fixed(f.at, 3) + " s: " + amount_text(f) +
                    ")");
  }
  if (parts.empty()) return "";
  return std::string(kHang, ' ') + "consequences: " + text::join(parts, ", ") + "\n";
}

std::string names_of_consequences(const FindingGroup& group) {
  std::vector<std::string> names;
  for (const GroupConsequence& c : group.consequences) names.emplace_back(name_of(c.kind));
  if (names.empty()) return "";
  return std::string(kHang, ' ') + "consequences: " + text::join(names, ", ") + "\n";
}

AnswerPart error_part(const ConsistencyReport& report, const FindingGroup& group) {
  const Finding& worst = report.findings[group.worst];
  const std::string words = entry_of(report, group);
  return {Worth::error,
          {words + hint(worst) + consequences(report, group),
           words + hint(worst) + names_of_consequences(group), words + hint(worst), words},
          kHang};
}

// The entry for all warnings of one kind.
AnswerPart warning_part(const ConsistencyReport& report,
                        const std::vector<const FindingGroup*>& groups) {
  std::string full, brief;
  std::vector<int> members;
  std::vector<std::string> places;
  const Finding* worst = nullptr;
  for (const FindingGroup* group : groups) {
    const Finding& here = report.findings[group->worst];
    full += entry_of(report, *group) + hint(here) + consequences(report, *group);
    brief += entry_of(report, *group);
    members.insert(members.end(), group->members.begin(), group->members.end());
    places.insert(places.end(), group->places.begin(), group->places.end());
    if (!worst || is_further_beyond(here, *worst)) worst = &here;
  }
  std::vector<std::string> forms = {full, brief};
  if (groups.size() > 1)
    forms.push_back(entry_of_many(report, members, *worst, names_of_places(places), true));
  forms.push_back("  " + severity_word(worst->severity) + padded(name_of(worst->kind), 19) +
                  text::counted(members.size(), "time") + "\n");
  return {worst->severity == Severity::warning ? Worth::warning : Worth::info, forms, kHang};
}

AnswerPart all_findings(const ConsistencyReport& report) {
  std::string out;
  for (const Finding& f : report.findings)
    out += entry(f, place_words(f.where) + ", " + seconds(f)) + hint(f);
  return {Worth::error, {out}, kHang};
}

// Where and when a figure is reached.
std::string figure_place(const ConsistencyReport& report, FindingKind kind) {
  const FigurePlace& p = report.summary_at[kind];
  return std::isfinite(p.at) ? in_brackets(place_words(p.where), p.at) : "";
}

}  // namespace

std::string shares_of_limits(const ConsistencyReport& report, const RobotModel& model) {
  std::vector<std::string> shares;
  for (const FindingSpec* spec : summary_figures())
    if (spec->figure.share_name)
      shares.push_back(std::string(spec->figure.share_name) + " " +
                       (has_limit(model, spec->kind) ? whole_percent(report.summary[spec->kind]) +
                                                           figure_place(report, spec->kind)
                                                     : "without limits"));
  return text::join(shares, ", ");
}

std::string painted_verdict(const ConsistencyReport& report) {
  return painted(report.consistent ? Paint::good : Paint::bad, verdict_of(report));
}

std::vector<AnswerPart> finding_parts(const ConsistencyReport& report, const RobotModel& model,
                                      Shown shown_findings) {
  if (shown_findings == Shown::findings) return {all_findings(report)};
  const std::vector<FindingGroup> groups = finding_groups(report, model);
  const size_t shown = std::min(groups.size(), static_cast<size_t>(kMostGroups));
  std::vector<AnswerPart> parts;
  std::vector<std::vector<const FindingGroup*>> warnings;
  for (size_t i = 0; i < shown; ++i) {
    const Finding& f = report.findings[groups[i].worst];
    if (f.severity == Severity::error) {
      parts.push_back(error_part(report, groups[i]));
      continue;
    }
    const auto same = std::find_if(warnings.begin(), warnings.end(), [&](const auto& known) {
      const Finding& first = report.findings[known.front()->worst];
      return first.kind == f.kind && first.severity == f.severity;
    });
    if (same == warnings.end())
      warnings.push_back({&groups[i]});
    else
      same->push_back(&groups[i]);
  }
  for (const auto& kind : warnings) parts.push_back(warning_part(report, kind));
  if (groups.size() > shown)
    parts.push_back({Worth::verdict,
                     {"  " + text::counted(groups.size() - shown, "more group") +
                      " of findings. `ayumi check --all` prints every finding\n"}});
  const bool any = std::any_of(groups.begin(), groups.end(),
                               [](const FindingGroup& g) { return !g.consequences.empty(); });
  if (any)
    parts.push_back(
        {Worth::origin, {"  `ayumi check --tolerances` explains the names of the findings\n", ""}});
  return parts;
}

std::vector<AnswerPart> check_parts(const ConsistencyReport& report, const RobotModel& model,
                                    Shown shown) {
  std::vector<AnswerPart> parts = finding_parts(report, model, shown);
  const auto at = [&](FindingKind kind) { return report.summary[kind]; };
  const auto place = [&](FindingKind kind) { return figure_place(report, kind); };
  const double margin = at(FindingKind::support_margin);
  parts.push_back({Worth::figure,
                   {std::string("  ZMP ") + (margin < 0 ? "up to " : "at least ") +
                    mm_text(std::abs(margin)) + (margin < 0 ? " outside" : " inside") +
                    " the support" + place(FindingKind::support_margin) +
                    ". The full model differs from the command by at most " +
                    mm_text(at(FindingKind::cog_residual)) + " in COG, " +
                    mm_text(at(FindingKind::zmp_residual)) + " in ZMP and " +
                    text::fixed(at(FindingKind::fz_residual), 2) +
                    " N in f_z. The point mass differs by at most " +
                    mm_text(at(FindingKind::point_mass_gap)) + " in ZMP\n"}});
  parts.push_back(
      {Worth::figure, {"  share of the limits: " + shares_of_limits(report, model) + "\n"}});
  std::string feet = "  feet: slip " + mm_text(at(FindingKind::foot_slip)) + ", sink " +
                     mm_text(at(FindingKind::foot_penetration)) + ", gap while standing " +
                     mm_text(at(FindingKind::foot_float)) + "; ";
  const std::vector<std::string> bare = bodies_without_collision_shapes(model);
  const double apart = at(FindingKind::self_collision);
  if (std::isnan(apart))
    feet += "self-collisions are not checked, because the legs have no collision shapes";
  else
    feet += (apart < 0 ? "bodies overlap by " + mm_text(-apart)
                       : "nearest bodies " + mm_text(apart) + " apart") +
            place(FindingKind::self_collision);
  std::vector<std::string> forms = {feet + "\n"};
  if (!std::isnan(apart) && !bare.empty())
    forms = {
        feet + ". Self-collisions of " + text::join(bare, ", ") +
            " are not checked, because these bodies have no collision shapes\n",
        feet + ". " + text::counted(bare.size(), "body", "bodies") + " without collision shapes\n"};
  parts.push_back({Worth::figure, forms});
  return parts;
}

size_t rows_for(const ConsistencyReport& report) {
  return report.consistent ? kRowsWhenGood : kRowsWhenBad;
}

std::string where_more_is(const ConsistencyReport& report) {
  return "  this answer is shortened. `ayumi check --all` prints everything" +
         (report.findings.empty() ? std::string()
                                  : " (" + text::counted(report.findings.size(), "finding") + ")") +
         "\n";
}

std::vector<AnswerPart> remark_parts(const std::string& heading,
                                     const std::vector<std::string>& sentences, Worth worth) {
  if (sentences.empty()) return {};
  std::vector<AnswerPart> parts = {{worth, shortened_line("  " + heading + sentences.front())}};
  if (sentences.size() == 1) return parts;
  std::vector<std::string> others(4);
  for (auto sentence = sentences.begin() + 1; sentence != sentences.end(); ++sentence) {
    const std::vector<std::string> forms = shortened_line("  " + heading + *sentence);
    for (size_t i = 0; i < forms.size(); ++i) others[i] += forms[i];
  }
  others.back() = "  " + heading + std::to_string(sentences.size() - 1) + " more\n";
  parts.push_back({Worth::remark, others});
  return parts;
}

std::vector<AnswerPart> mistake_parts(const std::vector<Mistake>& mistakes, bool consistent) {
  if (consistent)
    return remark_parts(painted(Paint::caution, "worth a look:") + " ", cause_texts(mistakes),
                        Worth::remark);
  // If several causes are named, the author needs all of them, so they have the highest importance.
  std::vector<AnswerPart> parts = remark_parts(painted(Paint::caution, "likely cause:") + " ",
                                               cause_texts(mistakes), Worth::verdict);
  if (!parts.empty()) parts.front().forms.resize(1);
  return parts;
}

std::vector<AnswerPart> search_parts(const std::vector<Mistake>& mistakes) {
  std::vector<std::string> sentences;
  for (const Mistake& mistake : mistakes)
    if (!mistake.is_cause) sentences.push_back(mistake.words);
  return remark_parts("", sentences, Worth::remark);
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
