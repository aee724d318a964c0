#pragma once
// The message of a call that must fail.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "ayumi/base/error.hpp"

namespace ayumi::test {

/// The message of the Error that `call` throws, which must have this code; "no error" if it throws
/// none.
template <typename Call>
std::string error_message(const Call& call, std::optional<ErrorCode> code = {}) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code.value_or(error.code())) << error.what();
    return error.what();
  }
  return "no error";
}

}  // namespace ayumi::test
