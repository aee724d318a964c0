#pragma once
// Results of certify as JSON and CSV. A stopped study is continued from this file, and shards are
// merged from such files.

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "ayumi/study/certify.hpp"

namespace ayumi::app {

/// The cases of a file by their numbers. A file may have few cases with large numbers.
using FileCases = std::map<size_t, CaseResult>;

/// The known results of the cases 0, 1, ..., count - 1.
KnownResults first_cases(const FileCases& cases, long count);
/// Adds the known results. They replace results of the same cases.
void add_cases(const KnownResults& results, FileCases& cases);

/// The finished cases of a study. `study` describes the task; a study can only be continued with
/// the same task. `shard`: "1/4", or empty.
std::string case_results_text(const nlohmann::ordered_json& study, const std::string& shard,
                              const FileCases& cases);

/// Adds the cases of a file. Adds nothing if the file does not exist and `must_exist` is false.
/// Throws Error(bad_file) if it is not a file of results or belongs to another study, and if a case
/// has another result than the one that is known, or figures that no simulation gives. Returns the
/// shard of the file.
std::string add_case_results(const std::filesystem::path& file, const nlohmann::ordered_json& study,
                             bool must_exist, FileCases& cases);

/// One row for each case: its number, outcome, figures, and all values that were drawn.
std::string case_table(const UncertainTask& task, std::uint64_t seed, const KnownResults& results);

nlohmann::ordered_json certificate_json(const Certificate& certificate,
                                        const CertifyOptions& options);
nlohmann::ordered_json influences_json(const std::vector<ValueInfluence>& influences);
/// The chosen cases with their figures and values.
nlohmann::ordered_json worst_cases_json(const UncertainTask& task, std::uint64_t seed,
                                        const KnownResults& results,
                                        const std::vector<long>& numbers);

}  // namespace ayumi::app
