#include "companion_files.hpp"

#include <algorithm>
#include <cstring>

namespace ayumi::mesh_reader {

namespace {

constexpr const char* kFolder = "/mesh/";

// A file in memory that is only read.
class MemoryFile : public Assimp::IOStream {
 public:
  explicit MemoryFile(const std::string& bytes) : bytes_(bytes) {}

  size_t Read(void* into, size_t size, size_t count) override {
    if (size == 0) return 0;
    const size_t items = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(into, bytes_.data() + at_, items * size);
    at_ += items * size;
    return items;
  }
  size_t Write(const void*, size_t, size_t) override { return 0; }
  aiReturn Seek(size_t offset, aiOrigin origin) override {
    const size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    // An offset is unsigned, so that an offset that leads backwards wraps around.
    const size_t place = base + offset;
    if (place > bytes_.size()) return aiReturn_FAILURE;
    at_ = place;
    return aiReturn_SUCCESS;
  }
  size_t Tell() const override { return at_; }
  size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  const std::string& bytes_;
  size_t at_ = 0;
};

}  // namespace

CompanionFiles::CompanionFiles(const std::string& name, const std::string& bytes, AskFile ask)
    : path_(path_of(name)), bytes_(bytes), ask_(std::move(ask)) {}

std::string CompanionFiles::path_of(const std::string& name) { return kFolder + name; }

const std::string* CompanionFiles::find(const std::string& path) const {
  if (path == path_) return &bytes_;
  if (!path.starts_with(kFolder)) return nullptr;
  auto known = companions_.find(path);
  if (known == companions_.end())
    known = companions_.emplace(path, ask_(path.substr(std::strlen(kFolder)))).first;
  return known->second ? &*known->second : nullptr;
}

bool CompanionFiles::Exists(const char* path) const { return find(path) != nullptr; }

Assimp::IOStream* CompanionFiles::Open(const char* path, const char* mode) {
  const std::string* bytes = std::strchr(mode, 'r') ? find(path) : nullptr;
  return bytes ? new MemoryFile(*bytes) : nullptr;
}

void CompanionFiles::Close(Assimp::IOStream* file) { delete file; }

}  // namespace ayumi::mesh_reader
