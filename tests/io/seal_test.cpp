#include "ayumi/io/run/seal.hpp"

#include <gtest/gtest.h>

#include "ayumi/io/run/sha256.hpp"

namespace ayumi {
namespace {

TEST(Seal, IsTheHashOfTheTextBeforeIt) {
  const std::string text = "{\n \"a\": 1";
  EXPECT_EQ(sealed(text + "\n}\n"),
            text + ",\n  \"contents_sha256\": \"" + sha256(text) + "\"\n}\n");
}

// Each byte counts, also those of the seal and those behind it.
TEST(Seal, AnyOtherByteIsRecognized) {
  const std::string good = sealed("{\n \"outcome\": \"fell\"\n}");
  EXPECT_EQ(wrong_seal(good), "");
  for (size_t i = 0; i < good.size(); ++i) {
    std::string other = good;
    other[i] = other[i] == ' ' ? '\t' : ' ';
    EXPECT_FALSE(is_sealed(other)) << i;
    EXPECT_NE(wrong_seal(other), "") << i;
    EXPECT_FALSE(is_sealed(good.substr(0, i))) << i;
  }
  EXPECT_FALSE(is_sealed(good + "\n"));
  EXPECT_NE(wrong_seal("{\n}").find("older version of Ayumi"), std::string::npos);
}

}  // namespace
}  // namespace ayumi
