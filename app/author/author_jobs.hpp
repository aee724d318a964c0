#pragma once
// Long work on the pattern that is being authored: repair, simulation, pushes, export, and what
// came out of it as the page shows it.

#include <map>
#include <optional>
#include <string>

#include "author/author_motion.hpp"
#include "commands.hpp"

namespace ayumi::app {

struct AuthorResult {
  OrderedJson shown;                           ///< member "result" of the page's state
  std::map<std::string, std::string> series;   ///< tables of "repair", "open_loop", "closed_loop"
  OrderedJson strips = OrderedJson::object();  ///< of the same motions: { lanes, dt }
};

/// Kinds of jobs, in the order of the page's buttons.
const std::vector<std::string>& author_job_kinds();

/// Does the job. `text` is that of the motion. Throws Error with what cannot be done, Interrupted
/// when `progress` stops it.
AuthorResult author_job(const std::string& kind, const OrderedJson& options, const Context& context,
                        const AuthorMotion& motion, const std::string& text,
                        const AuthorSetting& setting, const Progress& progress);

}  // namespace ayumi::app
