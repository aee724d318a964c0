#pragma once
// What this process may do: so little that a mesh that takes it over gains nothing.

#include <cstdint>

namespace ayumi::mesh_reader {

/// For the rest of its life, the process writes no file and no core dump, and ends with the thread
/// of Ayumi that started it. Where libseccomp was there at build time and the kernel allows it, it
/// can also open no file, start no process and reach no network: it may use the connection, memory
/// and clocks.
void confine();

/// From now on the process may have `bytes` more memory than at confine(), and take `seconds` of
/// the processor. Without effect on memory under the sanitizers, which reserve terabytes of
/// addresses.
void limit(std::uint64_t bytes, std::uint64_t seconds);

/// As many bytes more than limit() has allowed.
void allow_more_memory(std::uint64_t bytes);

}  // namespace ayumi::mesh_reader
