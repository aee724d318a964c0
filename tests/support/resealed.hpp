#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "ayumi/io/run/seal.hpp"

namespace ayumi::test {

/// The text of results that a test has edited, with a seal that fits.
inline std::string resealed(nlohmann::json results) {
  results.erase(kSealKey);
  return sealed(results.dump(1));
}

}  // namespace ayumi::test
