#pragma once
// Gives numbers to keys in the order in which they first occur. The class is a hash table with open
// addressing, because a mesh has up to millions of corners, and a separate allocation for each
// corner would take most of the time of reading the mesh.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ayumi {

/// A key is an array of 32-bit words.
template <size_t Words>
class KeyNumbers {
 public:
  using Key = std::array<std::uint32_t, Words>;

  /// Makes a table for at most this many different keys.
  explicit KeyNumbers(size_t most)
      : shift_(64 - std::bit_width(2 * most + 1)),
        slots_(size_t{1} << std::bit_width(2 * most + 1)) {
    keys_.reserve(most);
  }

  /// Returns the number of the key; a new key gets the next number.
  std::uint32_t number(const Key& key) {
    std::uint64_t sum = 0;
    for (const std::uint32_t word : key) sum = (sum ^ word) * 0x9E3779B97F4A7C15;
    sum = (sum ^ sum >> 29) * 0x9E3779B97F4A7C15;
    for (size_t at = sum >> shift_;; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at] == 0) {
        keys_.push_back(key);
        slots_[at] = static_cast<std::uint32_t>(keys_.size());
        return slots_[at] - 1;
      }
      if (is_same(keys_[slots_[at] - 1], key)) return slots_[at] - 1;
    }
  }

  size_t size() const { return keys_.size(); }

 private:
  /// The operator == of arrays calls memcmp(), which takes longer for a few words.
  static bool is_same(const Key& a, const Key& b) {
    std::uint32_t differing = 0;
    for (size_t i = 0; i < Words; ++i) differing |= a[i] ^ b[i];
    return differing == 0;
  }

  int shift_;
  std::vector<std::uint32_t> slots_;  // number of the key + 1; 0 for a free slot
  std::vector<Key> keys_;
};

}  // namespace ayumi
