#include "ayumi/base/unfinished_files.hpp"

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace ayumi {

namespace {

// Number of paths at one time. Chosen: a command writes one folder and a few files at a time.
constexpr int kSlots = 64;
// Depth of folders in a folder. Chosen: a run has one folder of pictures.
constexpr int kDeepest = 8;
// Number of tries to empty a folder. Chosen: threads that still work may write a few more files.
constexpr int kTries = 10;

enum class Use { free, changing, removed_at_end };

// Fixed memory, because a signal handler must not allocate any.
struct Slot {
  std::atomic<Use> use = Use::free;
  std::atomic<long> age = 0;
  UnfinishedPath::Kind kind = UnfinishedPath::Kind::file;
  int made = 0;
  std::array<char, PATH_MAX> path = {};
};
std::array<Slot, kSlots> slots;
std::atomic<long> latest = 0;

// An entry of a folder as Linux gives it.
struct Entry {
  std::uint64_t inode;
  std::int64_t next;
  unsigned short size;
  unsigned char type;
  char name[1];
};

void remove_at(int folder, const char* name, int depth);

// Removes what is in the folder. (readdir() allocates memory.)
void empty(int folder, int depth) {
  alignas(Entry) char entries[4096];
  for (;;) {
    const long got = ::syscall(SYS_getdents64, folder, entries, sizeof entries);
    if (got <= 0) return;
    for (long at = 0; at < got;) {
      const auto* const entry = reinterpret_cast<const Entry*>(entries + at);
      const char* const name = entries + at + offsetof(Entry, name);
      if (std::strcmp(name, ".") != 0 && std::strcmp(name, "..") != 0)
        remove_at(folder, name, depth + 1);
      at += entry->size;
    }
  }
}

void remove_at(int folder, const char* name, int depth) {
  if (::unlinkat(folder, name, 0) == 0 || (errno != EISDIR && errno != EPERM)) return;
  for (int i = 0; i < kTries && depth <= kDeepest; ++i) {
    const int inside = ::openat(folder, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (inside < 0) return;
    empty(inside, depth);
    ::close(inside);
    if (::unlinkat(folder, name, AT_REMOVEDIR) == 0) return;
  }
}

void remove(const Slot& slot) {
  if (slot.kind == UnfinishedPath::Kind::folder)
    remove_at(AT_FDCWD, slot.path.data(), 0);
  else
    ::unlink(slot.path.data());
  std::array<char, PATH_MAX> around = slot.path;
  for (int i = 0; i < slot.made; ++i) {
    char* const end = std::strrchr(around.data(), '/');
    if (!end) return;
    *end = '\0';
    if (::rmdir(around.data()) != 0) return;  // only an empty folder
  }
}

}  // namespace

UnfinishedPath::UnfinishedPath(const std::filesystem::path& path, Kind kind, int made) {
  const std::string& text = path.native();
  if (text.empty() || text.size() >= PATH_MAX) return;
  for (int i = 0; i < kSlots; ++i) {
    Slot& slot = slots[static_cast<size_t>(i)];
    Use expected = Use::free;
    if (!slot.use.compare_exchange_strong(expected, Use::changing)) continue;
    std::memcpy(slot.path.data(), text.c_str(), text.size() + 1);
    slot.kind = kind;
    slot.made = made;
    slot.age = ++latest;
    slot.use = Use::removed_at_end;
    slot_ = i;
    return;
  }
}

void UnfinishedPath::release() {
  if (slot_ < 0) return;
  Use expected = Use::removed_at_end;
  if (!slots[static_cast<size_t>(slot_)].use.compare_exchange_strong(expected, Use::free))
    for (;;) ::pause();
  slot_ = -1;
}

void remove_unfinished() {
  for (;;) {
    Slot* last = nullptr;
    for (Slot& slot : slots)
      if (slot.use == Use::removed_at_end && (!last || slot.age > last->age)) last = &slot;
    if (!last) return;
    Use expected = Use::removed_at_end;
    if (last->use.compare_exchange_strong(expected, Use::changing)) remove(*last);
  }
}

}  // namespace ayumi
