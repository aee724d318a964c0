#include "ayumi/io/robot/mesh_cache.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/private_file.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/robot/mesh_reader_place.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/run/sha256_stream.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

// First bytes of an entry. The number counts the versions of the layout: the hash of the rest, and
// then the rest: the number of companions, for each its name and hash, and the answer. A text is
// its size (8 bytes) and its bytes.
constexpr std::string_view kEntryMark = "ayumi mesh answer 1\n";
constexpr size_t kHashDigits = 64;
// Number of bytes that are kept before the space of all entries is counted again. Chosen: the
// folder may exceed its bound by this.
constexpr std::uintmax_t kLookAfter = std::uintmax_t{16} << 20;

void append(std::string& bytes, std::uint64_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

void append(std::string& bytes, std::string_view text) {
  append(bytes, text.size());
  bytes += text;
}

// Takes numbers and texts from the front of an entry. After `good` is false, all are empty.
struct EntryReader {
  std::string_view left;
  bool good = true;

  std::string_view bytes(std::uint64_t count) {
    good = good && count <= left.size();
    if (!good) return {};
    const std::string_view taken = left.substr(0, count);
    left.remove_prefix(count);
    return taken;
  }
  std::uint64_t number() {
    const std::string_view taken = bytes(sizeof(std::uint64_t));
    std::uint64_t value = 0;
    if (good) std::memcpy(&value, taken.data(), sizeof value);
    return value;
  }
  std::string_view text() { return bytes(number()); }
};

}  // namespace

std::optional<fs::path> MeshCache::usual_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  fs::path folder;
  if (cache && *cache)
    folder = cache;
  else if (home && *home)
    folder = fs::path(home) / ".cache";
  if (!folder.is_absolute()) return std::nullopt;
  return folder / "ayumi" / "meshes";
}

std::string MeshCache::key_of(const MeshRequestHead& request, const std::string& file_name,
                              std::string_view bytes, const fs::path& reader) {
  // Another reader or library, or one that was installed again, may give another answer.
  std::string about;
  append(about, std::string_view(version()));
  for (const fs::path& program : {reader, assimp_library()}) {
    std::error_code missing;
    append(about, std::string_view(program.string()));
    append(about, fs::file_size(program, missing));
    append(about, static_cast<std::uint64_t>(
                      fs::last_write_time(program, missing).time_since_epoch().count()));
  }
  append(about, std::string_view(file_name));
  about.append(reinterpret_cast<const char*>(&request), sizeof request);
  Sha256Stream hash;
  hash.add(about);
  hash.add(bytes);
  return hash.digits();
}

std::optional<std::string> MeshCache::find(const std::string& key,
                                           const CompanionBytes& companion) const {
  if (!folder_) return std::nullopt;
  std::string entry;
  try {
    entry = read_file(*folder_ / key, kLargestAnswer + (size_t{1} << 20));
  } catch (const Error&) {
    return std::nullopt;
  }
  EntryReader reader{entry};
  if (reader.bytes(kEntryMark.size()) != kEntryMark) return std::nullopt;
  const std::string_view hash = reader.bytes(kHashDigits);
  if (!reader.good || hash != sha256(reader.left)) return std::nullopt;
  const std::uint64_t companions = reader.number();
  if (companions > kMostMeshCompanions) return std::nullopt;
  for (std::uint64_t i = 0; i < companions; ++i) {
    const std::string name(reader.text());
    const std::string_view then = reader.text();
    if (!reader.good) return std::nullopt;
    const std::optional<std::string> now = companion(name);
    if ((now ? sha256(*now) : "") != then) return std::nullopt;
  }
  const std::string_view answer = reader.text();
  if (!reader.good || !reader.left.empty()) return std::nullopt;
  return std::string(answer);
}

void MeshCache::keep(const std::string& key, const std::vector<AskedCompanion>& companions,
                     const std::string& answer) const {
  if (!folder_ || answer.size() > kLargestAnswer) return;
  std::string rest;
  append(rest, companions.size());
  for (const AskedCompanion& companion : companions) {
    append(rest, std::string_view(companion.name));
    append(rest, std::string_view(companion.sha256));
  }
  append(rest, std::string_view(answer));
  std::error_code failed;
  for (const fs::path& folder : {folder_->parent_path(), *folder_})
    if (fs::create_directories(folder, failed))
      fs::permissions(folder, fs::perms::owner_all, failed);
  if (failed) return;
  const std::string entry = std::string(kEntryMark) + sha256(rest) + rest;
  if (!write_private_file(*folder_ / key, entry)) return;
  // Looks at the folder at first and after each kLookAfter bytes, because it may have many entries.
  static std::atomic<std::uintmax_t> added = 0;
  const std::uintmax_t before = added.fetch_add(rest.size());
  if (before == 0 || before / kLookAfter != (before + rest.size()) / kLookAfter) remove_oldest();
}

void MeshCache::remove_oldest() const {
  struct Entry {
    fs::file_time_type time;
    fs::path path;
    std::uintmax_t size = 0;
  };
  std::vector<Entry> entries;
  std::uintmax_t all = 0;
  std::error_code ended;
  for (fs::directory_iterator it(*folder_, ended), end; !ended && it != end; it.increment(ended)) {
    std::error_code gone;  // another process may have deleted the file
    if (!fs::is_regular_file(it->symlink_status(gone))) continue;
    const Entry entry{it->last_write_time(gone), it->path(), it->file_size(gone)};
    if (gone) continue;
    all += entry.size;
    entries.push_back(entry);
  }
  if (all <= kMostBytes) return;
  std::sort(entries.begin(), entries.end(),
            [](const Entry& a, const Entry& b) { return a.time < b.time; });
  for (const Entry& entry : entries) {
    if (all <= kMostBytes) return;
    std::error_code gone;
    fs::remove(entry.path, gone);
    all -= entry.size;
  }
}

}  // namespace ayumi
