#pragma once
// The fixed texts of the report's page, and the live page for authoring. The build embeds them from
// the folder page/.

#include <string_view>

namespace ayumi {

extern const std::string_view kPageStyle;
/// The script of the replay; empty if the program was built without npm.
extern const std::string_view kReplayScript;
/// The whole live page with its style and script, for a server; empty if the program was built
/// without npm.
extern const std::string_view kAuthorPage;

}  // namespace ayumi
