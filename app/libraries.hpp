#pragma once

namespace ayumi::app {

/// The libraries that the program was built with, and their versions: "Eigen 3.4.0, Ipopt 3.11.9,
/// ...".
const char* library_versions();

}  // namespace ayumi::app
