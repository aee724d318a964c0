#pragma once
// Fingerprints of files: SHA-256 as 64 lower-case hexadecimal digits.

#include <string>
#include <string_view>

namespace ayumi {

/// SHA-256 of `bytes` (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace ayumi
