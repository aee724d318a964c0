#pragma once
// Names of the files that one command writes.

#include <string>
#include <utility>
#include <vector>

namespace ayumi::app {

/// `files` are options that name files to be written, each with its file, or "" if it was not
/// given. Throws Error(usage) if two of them name the same file, because one would replace the
/// other.
void refuse_same_files(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace ayumi::app
