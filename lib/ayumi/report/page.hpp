#pragma once
// The texts that make up a report's page besides its contents, built in from page/.

#include <string_view>

namespace ayumi {

extern const std::string_view kPageStyle;
/// Empty where the program was built without npm.
extern const std::string_view kReplayScript;

}  // namespace ayumi
