#pragma once
// The cache in which Mesa, which draws the pictures, keeps compiled shaders.

namespace ayumi {

/// Switches this cache off, by the environment variable MESA_SHADER_CACHE_DISABLE, if the file
/// system of the user's cache folder is almost full. Mesa maps a file of this cache into memory,
/// and the system ends a process that writes to such a file on a full disk (SIGBUS). If the
/// variable already has a value, the value is kept. Only the first call examines the file system.
///
/// Each OffscreenContext calls this. Because a thread must not change the environment while another
/// one reads it, a program with threads also calls it before it starts the first of them.
void disable_shader_cache_on_full_disk();

}  // namespace ayumi
