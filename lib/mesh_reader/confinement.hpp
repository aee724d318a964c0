#pragma once
// Restricts this process so much that a mesh that takes it over gains nothing.

#include <cstdint>

namespace ayumi::mesh_reader {

/// For the rest of its life, the process writes no file and no core dump, and ends with the thread
/// of Ayumi that started it. If libseccomp was there at build time and the kernel allows it, the
/// process can also open no file, start no process and reach no network: it may only use the
/// connection, memory and clocks.
void confine();

/// From now on, the process may have `bytes` more memory than at confine(), and use the processor
/// for `seconds`. This has no effect on memory under the sanitizers, which reserve terabytes of
/// addresses.
void limit(std::uint64_t bytes, std::uint64_t seconds);

/// Allows `bytes` more than limit() has allowed.
void allow_more_memory(std::uint64_t bytes);

}  // namespace ayumi::mesh_reader
