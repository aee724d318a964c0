#include "file_stamp.hpp"

#include <sys/stat.h>

namespace ayumi::app {

FileStamp stamp_of(const std::filesystem::path& file) {
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0) return {};
  return {about.st_mtim.tv_sec, about.st_mtim.tv_nsec, static_cast<long>(about.st_size),
          static_cast<unsigned long>(about.st_ino)};
}

}  // namespace ayumi::app
