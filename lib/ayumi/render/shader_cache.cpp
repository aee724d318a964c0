#include "ayumi/render/shader_cache.hpp"

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <mutex>

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// Room that the cache needs [bytes]. Measured: Mesa 22.3 maps a file of 1.3 MB, and the shaders of
// Ayumi take 0.2 MB. Chosen: ten times as much, because other programs write at the same time.
constexpr std::uintmax_t kLeastRoom = 16'000'000;

// The folder in which Mesa makes its cache; empty if it makes none.
fs::path cache_folder() {
  for (const char* const name : {"MESA_SHADER_CACHE_DIR", "XDG_CACHE_HOME"})
    if (const char* const folder = std::getenv(name); folder && *folder) return folder;
  const char* const home = std::getenv("HOME");
  return home && *home ? fs::path(home) / ".cache" : fs::path();
}

// The variable of Mesa that switches the cache off.
constexpr const char* kSwitch = "MESA_SHADER_CACHE_DISABLE";

void disable_without_room() {
  if (std::getenv(kSwitch)) return;
  std::error_code error;
  fs::path folder = cache_folder();
  if (!folder.empty()) folder = fs::absolute(folder, error);
  while (!folder.empty() && folder != folder.parent_path() && !fs::exists(folder, error))
    folder = folder.parent_path();
  if (folder.empty()) return;
  const fs::space_info room = fs::space(folder, error);
  if (!error && room.available < kLeastRoom) ::setenv(kSwitch, "true", 0);
}

}  // namespace

void disable_shader_cache_on_full_disk() {
  static std::once_flag once;
  std::call_once(once, disable_without_room);
}

}  // namespace ayumi
