#pragma once
// The seal of the rows of a sweep. It recognizes rows that were edited, and takes no space in them.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace ayumi::app {

/// The sum of the SHA-256 of all rows as numbers modulo 2^256, and of that of the study. So the
/// order of the rows does not matter, and a row is added or removed without reading the others.
class RowSeal {
 public:
  /// The seal of a study without rows.
  explicit RowSeal(const std::string& fingerprint);
  /// The seal that digits() has written; empty if the text is not one.
  static std::optional<RowSeal> of_digits(const std::string& text);

  void add(const std::string& row);
  void remove(const std::string& row);
  /// 64 hexadecimal digits.
  std::string digits() const;
  bool operator==(const RowSeal&) const = default;

 private:
  /// The parts of a number of 256 bits, the most significant one first.
  using Parts = std::array<std::uint32_t, 8>;
  explicit RowSeal(const Parts& parts) : parts_(parts) {}
  static std::optional<Parts> parts_of(const std::string& digits);

  Parts parts_;
};

}  // namespace ayumi::app
