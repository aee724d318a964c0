#pragma once
// One of several parts of a study, which are run apart and merged.

#include <string>
#include <vector>

namespace ayumi::app {

/// The cases whose number leaves the remainder `index` by `count`.
struct Shard {
  long index = 0, count = 1;
  bool whole() const { return count == 1; }
  bool has(long number) const { return number % count == index; }
  std::string word() const;  ///< "2/4"
};

/// "2/4" as the remainder 1 of 4; "" is the whole study. Throws Error(usage) that names `option`.
Shard read_shard(const std::string& word, const std::string& option = "--shard");

/// Which of the shards that are known has the case that is missing: "; shard 2/4 is missing or not
/// finished". Empty where there are no shards.
std::string missing_shard(const std::vector<std::string>& shards, long number);

}  // namespace ayumi::app
