#pragma once
// The name of a pattern in titles.

#include <filesystem>
#include <string>

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// The name of the pattern; without one, the name of its file without the extension.
inline std::string shown_name(const Pattern& pattern) {
  return pattern.name.empty() ? std::filesystem::path(pattern.file).stem().string() : pattern.name;
}

}  // namespace ayumi
