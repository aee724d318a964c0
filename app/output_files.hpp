#pragma once
// Names of files that one command writes.

#include <string>
#include <utility>
#include <vector>

namespace ayumi::app {

/// Options that name files to be written, each with its file; "" where it was not given. Throws
/// Error(usage) where two of them name the same file, of which one would replace the other.
void refuse_same_files(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace ayumi::app
