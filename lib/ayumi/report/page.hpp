#pragma once
// The texts of the report's page besides its contents, and the live page for authoring, built in
// from page/.

#include <string_view>

namespace ayumi {

extern const std::string_view kPageStyle;
/// Empty where the program was built without npm.
extern const std::string_view kReplayScript;
/// The whole page with its style and script, for a server; empty where the program was built
/// without npm.
extern const std::string_view kAuthorPage;

}  // namespace ayumi
