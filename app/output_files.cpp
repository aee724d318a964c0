#include "output_files.hpp"

#include <filesystem>
#include <map>

#include "ayumi/base/error.hpp"

namespace ayumi::app {

void refuse_same_files(const std::vector<std::pair<std::string, std::string>>& files) {
  std::map<std::filesystem::path, std::string> taken;
  for (const auto& [option, file] : files) {
    if (file.empty()) continue;
    std::error_code error;
    std::filesystem::path place =
        std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    if (error) place = file;
    const auto [first, fresh] = taken.emplace(place, option);
    if (!fresh)
      fail(ErrorCode::usage, first->second + " and " + option + " name the same file, " + file +
                                 ". Give a different file to each option");
  }
}

}  // namespace ayumi::app
