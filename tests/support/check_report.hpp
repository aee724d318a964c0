#pragma once
// The report of the check for a pattern, with the options of `ayumi check`.

#include <set>
#include <sstream>
#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/plan/sample.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {

inline ConsistencyReport report_of(const RobotModel& model, const Pattern& pattern) {
  CheckOptions options;
  options.friction = pattern.world.friction;
  options.profile = pattern.profile;
  return check_consistency(model, sample(model, pattern), options);
}

/// The report for HOAP-1.
inline ConsistencyReport report_of(const Pattern& pattern) { return report_of(hoap1(), pattern); }

/// The kinds of the errors.
inline std::set<std::string> error_kinds(const ConsistencyReport& report) {
  std::set<std::string> kinds;
  for (const Finding& f : report.findings)
    if (f.severity == Severity::error) kinds.insert(name_of(f.kind));
  return kinds;
}

/// The findings, one per line, for the message of a test that fails.
inline std::string print(const ConsistencyReport& report) {
  std::ostringstream out;
  for (const Finding& f : report.findings)
    out << name_of(f.severity) << " " << name_of(f.kind) << " " << f.where << " " << f.begin << ".."
        << f.end << " at " << f.at << " worst " << f.worst << " limit " << f.limit << " " << f.unit
        << " <- " << f.follows_from << ": " << f.hint << "\n";
  return out.str();
}

}  // namespace ayumi::test
