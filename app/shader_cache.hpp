#pragma once
// The cache in which Mesa, which draws the pictures, keeps compiled shaders.

namespace ayumi::app {

/// Switches this cache off if the file system of the user's cache folder has almost no room. Mesa
/// maps a file of this cache into memory, and the system ends a program that writes to such a file
/// on a full disk (SIGBUS). It must be called before another thread is started.
void spare_full_disk_of_shaders();

}  // namespace ayumi::app
