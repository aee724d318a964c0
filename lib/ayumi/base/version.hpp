#pragma once

namespace ayumi {

/// The version of the library and the command, as "major.minor.patch".
const char* version();

}  // namespace ayumi
