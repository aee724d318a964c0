#include "ayumi/repair/tighten_to_check_limits.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

namespace {

constexpr double kHair = 1e-6;  // of a limit, for rounding

}  // namespace

CorrectionSpec at_limits(const CorrectionSpec& spec, const CorrectionSpec& asked, double safety) {
  auto tolerance = [&](FindingKind kind) { return spec.tolerance[kind]; };
  const bool safe = spec.safe_margin > spec.zmp_margin;  // was to be had
  CorrectionSpec limits = spec;
  limits.zmp_margin = asked.zmp_margin;
  limits.safe_margin = safe ? asked.safe_margin : asked.zmp_margin;
  // Given up to get on, not because there was no solution with them.
  limits.gentle_swings = spec.gentle_swings || (safe && asked.gentle_swings);
  limits.at_limits = true;
  limits.joint_margin = kHair;
  limits.share = 1 - kHair;
  limits.force_share = tolerance(FindingKind::unilateral);
  if (safety > 0) return limits;
  limits.joint_margin = kHair - tolerance(FindingKind::joint_position);
  limits.force_share = kHair;
  limits.clearance = kHair;
  limits.gentle_swings = false;
  limits.zmp_margin = limits.safe_margin = kHair * 1e-3;
  return limits;
}

void add_instants(const ConsistencyReport& report, double dt, std::vector<double>& instants) {
  constexpr int kMost = 12;  // of one window
  for (const Finding& f : report.findings) {
    if (f.severity != Severity::error) continue;
    const double length = f.end - f.begin;
    const int steps = std::clamp(static_cast<int>(std::lround(length / dt)), 1, kMost);
    for (int i = 0; i <= steps; ++i) instants.push_back(f.begin + length * i / steps);
    instants.push_back(f.at);
  }
}

CorrectionTrack between(const CorrectionTrack& a, const CorrectionTrack& b, double share) {
  CorrectionTrack track = a;
  track.coefficients += share * (b.coefficients - a.coefficients);
  return track;
}

}  // namespace ayumi
