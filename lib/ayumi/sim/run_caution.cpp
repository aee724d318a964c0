#include "ayumi/sim/run_caution.hpp"

#include "ayumi/base/text.hpp"

namespace ayumi {

std::string unfit_words(const SimulationLog& log) {
  switch (log.result.outcome) {
    case Outcome::stands:
      return "";
    case Outcome::unsettled:
      return "the robot did not settle";
    case Outcome::fell:
      break;
  }
  std::string words = "the robot fell at " + text::fixed(log.result.fell_at, 2) + " s";
  for (const SimulationEvent& event : log.events)
    if (event.kind == EventKind::fell) words += " (" + event.text + ")";
  return words;
}

TableCaution caution_of(const SimulationLog& log) {
  return {words_of(log.scenario), unfit_words(log)};
}

}  // namespace ayumi
