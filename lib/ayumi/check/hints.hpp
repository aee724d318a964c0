#pragma once
// Findings in words: where, and what to do about it, with numbers.

#include "ayumi/check/finding_windows.hpp"
#include "ayumi/dynamics/self_collision.hpp"

namespace ayumi {

Place place_of(const std::vector<CollisionModel::Pair>& pairs, const Violation& violation);

/// The place in words: joint, foot, axis, support or pair of bodies.
std::string where_text(const RobotModel& model, const Place& place);

/// What to do, one sentence in two parts: by hand, and the advice to use `repair` (may be empty).
struct Advice {
  Advice(std::string remedy, std::string or_repair = "")
      : remedy(std::move(remedy)), or_repair(std::move(or_repair)) {}
  Advice(const char* remedy) : remedy(remedy) {}
  std::string remedy, or_repair;
};
/// `friction` is the coefficient the check used.
Advice advice_for(const RobotModel& model, const FindingWindow& window, double dt, double friction);

}  // namespace ayumi
