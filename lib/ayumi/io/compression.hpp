#pragma once
// Compression and checksums of files.

#include <cstdint>
#include <string>
#include <string_view>

namespace ayumi {

/// One zstd frame with a checksum. The same bytes give the same frame with one version of zstd.
std::string zstd_frame(std::string_view bytes);

/// The CRC-32 of zlib, zip archives and MCAP.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace ayumi
