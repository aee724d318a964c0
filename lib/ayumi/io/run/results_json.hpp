#pragma once
// Verdicts as JSON text, with the keys of docs/cli.md: what --json prints and run.json keeps. Each
// is one JSON object; nothing in it depends on the run (no wall time, no paths).

#include <string>

#include "ayumi/check/consistency.hpp"
#include "ayumi/io/run/written_log.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/repair/repair.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// An object with the keys verdict, profile, findings[], summary{}.
std::string check_json(const ConsistencyReport& report);

/// An object with the keys joints[], cog{}, foot{}, zmp{}, fz{}.
std::string motion_change_json(const MotionChange& change);

/// An object of the form {"total", "change", "safety", "parts": [{"what", "weight", "change"}]}.
std::string weighted_change_json(const WeightedChange& change);

/// An object with the keys status, moved{}, iterations, constraint_violation, reasons[], check{}.
std::string repair_json(const RepairResult& result);

/// An object with the keys controller, outcome, fell_at_s, max_tilt_rad, ..., steps, events[],
/// log_hash.
std::string simulation_json(const SimulationLog& log);
std::string simulation_json(const WrittenLog& log);

/// An object with the keys safe, ramp_s, hold_s, max_step_ratio, worst_joint, worst_at_s, ...,
/// violations[].
std::string safety_json(const SafetyReport& report);

}  // namespace ayumi
