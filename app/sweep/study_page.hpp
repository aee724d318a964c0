#pragma once
// One HTML page of a sweep, complete in itself: failure rates with intervals, maps of two settings,
// the worst cases as replays, provenance.

#include "sweep/expectations.hpp"

namespace ayumi::app {

/// `runner` simulates the worst `replays` cases again; null: none. The same results give the same
/// bytes.
std::string study_page(const ResultsDatabase& results, const std::vector<Expectation>& expectations,
                       const CaseRunner* runner, int replays, const Progress& progress);

}  // namespace ayumi::app
