#include "libraries.hpp"

namespace ayumi::app {

const char* library_versions() { return AYUMI_LIBRARIES; }

}  // namespace ayumi::app
