#include "ayumi/base/error.hpp"

namespace ayumi {

void fail(ErrorCode code, const std::string& message) { throw Error(code, message); }

}  // namespace ayumi
