#pragma once
// A shard is one of several parts of a study, which are run separately and merged later.

#include <string>
#include <vector>

namespace ayumi::app {

/// The cases for which number modulo `count` is `index`.
struct Shard {
  long index = 0, count = 1;
  bool whole() const { return count == 1; }
  bool has(long number) const { return number % count == index; }
  std::string word() const;  ///< the shard in words, such as "2/4"
};

/// Reads "2/4" as the remainder 1 of 4; "" is the whole study. Throws Error(usage) that names
/// `option`.
Shard read_shard(const std::string& word, const std::string& option = "--shard");

/// Names the known shard to which the missing case belongs: "; shard 2/4 is missing or not
/// finished". Empty if there are no shards.
std::string missing_shard(const std::vector<std::string>& shards, long number);

}  // namespace ayumi::app
