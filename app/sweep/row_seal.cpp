#include "sweep/row_seal.hpp"

#include <charconv>

#include "ayumi/io/run/sha256.hpp"

namespace ayumi::app {

namespace {

constexpr size_t kDigits = 8;  // hexadecimal digits of a part of 32 bits
constexpr int kBits = 32;      // bits of a part

}  // namespace

RowSeal::RowSeal(const std::string& fingerprint) : parts_(*parts_of(sha256(fingerprint))) {}

std::optional<RowSeal> RowSeal::of_digits(const std::string& text) {
  const auto parts = parts_of(text);
  if (!parts) return {};
  return RowSeal(*parts);
}

std::optional<RowSeal::Parts> RowSeal::parts_of(const std::string& digits) {
  Parts parts;
  if (digits.size() != kDigits * parts.size()) return {};
  for (size_t i = 0; i < parts.size(); ++i) {
    const char* const begin = digits.data() + i * kDigits;
    const auto read = std::from_chars(begin, begin + kDigits, parts[i], 16);
    if (read.ec != std::errc() || read.ptr != begin + kDigits) return {};
  }
  return parts;
}

void RowSeal::add(const std::string& row) {
  const Parts more = *parts_of(sha256(row));
  std::uint64_t sum = 0;
  for (size_t i = parts_.size(); i-- > 0;) {
    sum = (sum >> kBits) + parts_[i] + more[i];
    parts_[i] = static_cast<std::uint32_t>(sum);
  }
}

void RowSeal::remove(const std::string& row) {
  const Parts less = *parts_of(sha256(row));
  std::uint64_t borrow = 0;
  for (size_t i = parts_.size(); i-- > 0;) {
    const std::uint64_t taken = less[i] + borrow;
    borrow = parts_[i] < taken ? 1 : 0;
    parts_[i] = static_cast<std::uint32_t>(parts_[i] - taken);
  }
}

std::string RowSeal::digits() const {
  std::string text;
  for (const std::uint32_t part : parts_)
    for (int shift = kBits - 4; shift >= 0; shift -= 4)
      text += "0123456789abcdef"[part >> shift & 15];
  return text;
}

}  // namespace ayumi::app
