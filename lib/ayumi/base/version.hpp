#pragma once

namespace ayumi {

/// Version of the library and the command, "major.minor.patch".
const char* version();

}  // namespace ayumi
