#pragma once
// Long work on the pattern that is being authored: repair, simulation, pushes and export. The
// results have the form in which the page shows them.

#include <map>
#include <optional>
#include <string>

#include "author/author_motion.hpp"
#include "commands.hpp"

namespace ayumi::app {

struct AuthorResult {
  OrderedJson shown;                          ///< member "result" of the page's state
  std::map<std::string, std::string> series;  ///< tables of "repair", "open_loop" and "closed_loop"
  OrderedJson strips = OrderedJson::object();  ///< strips of the same motions: { lanes, dt }
};

/// Kinds of jobs, in the order of the page's buttons.
const std::vector<std::string>& author_job_kinds();

/// Does the job. `text` is that of the motion. Throws an Error that says what cannot be done, and
/// Interrupted if `progress` stops the job.
AuthorResult author_job(const std::string& kind, const OrderedJson& options, const Context& context,
                        const AuthorMotion& motion, const std::string& text,
                        const AuthorSetting& setting, const Progress& progress);

}  // namespace ayumi::app
