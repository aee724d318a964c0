#pragma once
// One HTML page of a sweep that needs no other files: failure rates with intervals, maps of two
// settings, the worst cases as replays, and the provenance.

#include "sweep/expectations.hpp"

namespace ayumi::app {

/// `runner` simulates the worst `replays` cases again; if it is null, there are no replays. The
/// same results give the same bytes.
std::string study_page(const ResultsDatabase& results, const std::vector<Expectation>& expectations,
                       const CaseRunner* runner, int replays, const Progress& progress);

}  // namespace ayumi::app
