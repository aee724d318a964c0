#pragma once
// The place, the value and the limit of a finding in words: lengths are in mm, angles and their
// rates in the unit of the pattern's angles.

#include <string>

#include "ayumi/base/sentence.hpp"
#include "ayumi/base/shown_amount.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/limits/finding.hpp"

namespace ayumi {

/// The value and the limit of a finding.
inline std::string amount_text(const Finding& finding) {
  return amount_text(finding.worst, finding.limit, finding.unit, finding.in_degrees);
}

/// The kind and the place, such as "joint_speed of l_knee" or "friction of the left foot".
inline std::string kind_and_place(FindingKind kind, const std::string& where) {
  return name_of(kind) + (where.empty() ? "" : " of " + place_words(where, true));
}

/// The kind, the place and the time, such as "joint_speed of l_knee at 1.860 s".
inline std::string kind_place_and_time(const Finding& finding) {
  return kind_and_place(finding.kind, finding.where) + " at " + text::fixed(finding.at, 3) + " s";
}

/// The kind, the place, the time, the value, the limit and the hint of a finding.
inline std::string finding_with_hint(const Finding& finding) {
  return text::two_sentences(kind_place_and_time(finding) + ": " + amount_text(finding),
                             finding.hint);
}

}  // namespace ayumi
