#include "check_table.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/limits/amount_text.hpp"

namespace ayumi::app {

namespace {

std::string padded(std::string text, size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string mm(double metres) { return text::fixed(1000 * metres, 1) + " mm"; }

std::string seconds(const Finding& f) {
  if (f.begin == f.end) return "at " + text::fixed(f.at, 3) + " s";
  return text::fixed(f.begin, 3) + "-" + text::fixed(f.end, 3) + " s, worst at " +
         text::fixed(f.at, 3) + " s";
}

std::string percent(double ratio) { return text::fixed(100 * ratio, 0) + " %"; }

}  // namespace

std::string check_table(const ConsistencyReport& report) {
  std::string out;
  for (const Finding& f : report.findings)
    out += "  " + padded(name_of(f.severity), 8) + padded(name_of(f.kind), 19) + f.where + ", " +
           seconds(f) + ": " + amount_text(f) + "\n" + std::string(10, ' ') + f.hint + "\n";
  const auto at = [&](FindingKind kind) { return report.summary[kind]; };
  const double margin = at(FindingKind::support_margin);
  out += "  ZMP " + mm(std::abs(margin)) + (margin < 0 ? " outside" : " inside") +
         " the support; the posture differs from the keys by " + mm(at(FindingKind::cog_residual)) +
         " in COG, " + mm(at(FindingKind::zmp_residual)) + " in ZMP and " +
         text::fixed(at(FindingKind::fz_residual), 2) +
         " N in force; the ZMP of the point-mass model is " + mm(at(FindingKind::point_mass_gap)) +
         " from the command\n";
  std::vector<std::string> shares;
  for (const FindingSpec* spec : summary_figures())
    if (spec->figure.share_name)
      shares.push_back(std::string(spec->figure.share_name) + " " + percent(at(spec->kind)));
  out += "  share of the limits: " + text::join(shares, ", ") + "\n";
  out += "  feet: slip " + mm(at(FindingKind::foot_slip)) + ", sink " +
         mm(at(FindingKind::foot_penetration)) + ", gap while standing " +
         mm(at(FindingKind::foot_float)) + "; nearest bodies " +
         mm(at(FindingKind::self_collision)) + " apart\n";
  return out;
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
