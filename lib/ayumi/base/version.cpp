#include "ayumi/base/version.hpp"

namespace ayumi {

const char* version() { return AYUMI_VERSION; }

}  // namespace ayumi
