#include "shard.hpp"

#include <cstdio>

#include "ayumi/base/error.hpp"

namespace ayumi::app {

std::string Shard::word() const { return std::to_string(index + 1) + "/" + std::to_string(count); }

Shard read_shard(const std::string& word, const std::string& option) {
  Shard shard;
  if (word.empty()) return shard;
  int read = 0;
  if (std::sscanf(word.c_str(), "%ld/%ld%n", &shard.index, &shard.count, &read) != 2 ||
      static_cast<size_t>(read) != word.size() || shard.count < 1 || shard.index < 1 ||
      shard.index > shard.count)
    fail(ErrorCode::usage, option + " " + word +
                               ": give I/N, for example 1/4. N is the number of all shards, and "
                               "I is the number of one shard, from 1 to N");
  --shard.index;
  return shard;
}

std::string missing_shard(const std::vector<std::string>& shards, long number) {
  if (shards.empty()) return "";
  const long count = read_shard(shards.front()).count;
  return "; shard " + Shard{number % count, count}.word() + " is missing or not finished";
}

}  // namespace ayumi::app
