#pragma once

namespace ayumi::app {

/// The libraries with which the program was built, and their versions: "Eigen 3.4.0, Ipopt 3.11.9,
/// ...".
const char* library_versions();

}  // namespace ayumi::app
