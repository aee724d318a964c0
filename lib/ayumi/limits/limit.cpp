#include "ayumi/limits/limit.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/largest_number.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/limit_table.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

#define AYUMI_DECLARE(kind, limit) const Limit& limit##_limit();
AYUMI_FINDING_KINDS(AYUMI_DECLARE)
#undef AYUMI_DECLARE

const std::vector<const Limit*>& limits() {
  static const std::vector<const Limit*> table = [] {
    std::vector<const Limit*> once;
    const auto add = [&](const Limit& limit) {
      if (std::find(once.begin(), once.end(), &limit) == once.end()) once.push_back(&limit);
    };
#define AYUMI_ADD(kind, limit) add(limit##_limit());
    AYUMI_FINDING_KINDS(AYUMI_ADD)
#undef AYUMI_ADD
    return once;
  }();
  return table;
}

const std::vector<const FindingSpec*>& finding_specs() {
  static const std::vector<const FindingSpec*> table = [] {
    std::vector<const FindingSpec*> by_kind(kFindingKindCount, nullptr);
    for (const Limit* limit : limits())
      for (const FindingSpec& spec : limit->findings)
        by_kind[static_cast<size_t>(spec.kind)] = &spec;
    require(std::count(by_kind.begin(), by_kind.end(), nullptr) == 0,
            "a kind of finding is not defined by any limit");
    return by_kind;
  }();
  return table;
}

const FindingSpec& spec_of(FindingKind kind) { return *finding_specs()[static_cast<size_t>(kind)]; }

namespace {

/// The kinds that have a line in this order (not 0), sorted by line.
template <typename Line>
std::vector<const FindingSpec*> by_line(const Line& line) {
  std::vector<const FindingSpec*> found;
  for (const FindingSpec* spec : finding_specs())
    if (line(*spec) > 0) found.push_back(spec);
  std::stable_sort(found.begin(), found.end(),
                   [&](const FindingSpec* a, const FindingSpec* b) { return line(*a) < line(*b); });
  return found;
}

}  // namespace

const std::vector<const FindingSpec*>& summary_figures() {
  static const auto figures = by_line([](const FindingSpec& spec) { return spec.figure.line; });
  return figures;
}

const std::vector<const FindingSpec*>& actuator_findings() {
  static const auto findings = by_line([](const FindingSpec& spec) { return spec.actuator.line; });
  return findings;
}

bool is_of_posture(const Finding& finding) {
  return finding.kind == FindingKind::cog_residual ||
         spec_of(finding.kind).limit_class == LimitClass::posture;
}

Tolerances tolerances(const CheckOptions& options) {
  Tolerances result;
  for (const FindingSpec* spec : finding_specs()) result[spec->kind] = spec->tolerance;
  for (const auto& [name, value] : options.tolerances) {
    const std::optional<FindingKind> kind = finding_kind(name);
    if (!kind)
      fail(ErrorCode::usage, "there is no kind of finding '" + name +
                                 "'; `ayumi check --tolerances` lists the kinds" +
                                 text::suggestion(name, finding_kind_names()));
    if (!(std::abs(value) <= kLargestNumber))
      fail(ErrorCode::usage, "tolerance '" + name + "': " + text::exact(value) +
                                 " is out of range. Its size must be at most " +
                                 text::brief(kLargestNumber));
    result[*kind] = value;
  }
  return result;
}

Tolerances tolerances(const CheckOptions& options, const RobotModel& model,
                      const CommandSeries& series) {
  Tolerances result = tolerances(options);
  for (const FindingSpec* spec : finding_specs())
    if (spec->least_tolerance && !series.samples.empty() &&
        !options.tolerances.contains(name_of(spec->kind)))
      result[spec->kind] = std::max(result[spec->kind], spec->least_tolerance(model, series));
  return result;
}

}  // namespace ayumi
