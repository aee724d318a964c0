#include "file_stamp.hpp"

#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"

namespace ayumi::app {

FileStamp stamp_of(const std::filesystem::path& file) {
  struct stat about {};
  if (::stat(file.c_str(), &about) != 0) return {};
  return {about.st_mtim.tv_sec, about.st_mtim.tv_nsec, static_cast<long>(about.st_size),
          static_cast<unsigned long>(about.st_ino)};
}

void await_written(const std::filesystem::path& file) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  try {
    std::string text = read_file(file);
    for (auto since = begin; !nlohmann::json::accept(text, true);) {
      std::this_thread::sleep_for(kFileLook);
      std::string now = read_file(file);
      if (now != text) since = Clock::now();
      text = std::move(now);
      if (Clock::now() - since >= kFileWritten || Clock::now() - begin >= kFileBusy) return;
    }
  } catch (const Error&) {  // a missing file is noticed by whoever reads it
  }
}

}  // namespace ayumi::app
