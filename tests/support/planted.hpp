#pragma once
// Two motions of HOAP-1 as tables in which faults are planted, and the errors that the check finds
// there.

#include <set>
#include <sstream>

#include "ayumi/author/generate/generate.hpp"
#include "tests/support/check_report.hpp"
#include "tests/support/degree.hpp"
#include "tests/support/faults.hpp"
#include "tests/support/hoap1.hpp"

namespace ayumi::test {

namespace planted {

using Kinds = std::set<std::string>;

inline Pattern table_of(Pattern pattern, const std::string& profile = "") {
  pattern.robot = "hoap1";
  pattern.profile = profile;
  return baked(hoap1(), pattern);
}

inline const Pattern& walk() {
  static const Pattern pattern = table_of(walk_pattern(hoap1(), {.steps = 3, .period = 0.8}));
  return pattern;
}

inline const Pattern& hops() {
  static const Pattern pattern = [] {
    JumpParameters jump = jump_defaults(hoap1());
    jump.times = 2;
    return table_of(jump_pattern(hoap1(), jump), "hoap1-strong");
  }();
  return pattern;
}

inline double begin_of(const Pattern& pattern, size_t phase) {
  return phase > 0 ? pattern.phases[phase - 1].until : 0;
}

inline double middle_of(const Pattern& pattern, size_t phase) {
  return 0.001 * std::round(500 * (begin_of(pattern, phase) + pattern.phases[phase].until));
}

struct Errors {
  Kinds kinds;
  std::vector<Finding> all;
  std::string printed;
};

inline Errors errors_of(const Pattern& pattern) {
  Errors errors;
  std::ostringstream printed;
  for (const Finding& f : report_of(hoap1(), pattern).findings) {
    printed << name_of(f.severity) << " " << name_of(f.kind) << " " << f.where << " at " << f.at
            << " worst " << f.worst << " <- " << f.follows_from << "\n";
    if (f.severity != Severity::error) continue;
    errors.kinds.insert(name_of(f.kind));
    errors.all.push_back(f);
  }
  errors.printed = printed.str();
  return errors;
}

}  // namespace planted
}  // namespace ayumi::test
