#include "ayumi/io/pattern/expression.hpp"

#include <gtest/gtest.h>

#include "ayumi/base/error.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

double value(const std::string& text) {
  return evaluate_expression(text, {{"a", 3}, {"step length", 0.5}}, {"f", "/x"});
}

std::string value_error(const std::string& text) {
  return test::error_message([&] { value(text); });
}

TEST(Expression, FollowsTheUsualRules) {
  EXPECT_EQ(value("${a}"), 3);
  EXPECT_EQ(value("-${a}*2 + 1"), -5);
  EXPECT_EQ(value("2 - 3 - ${a}"), -4);
  EXPECT_EQ(value("12/${a}/2"), 2);
  EXPECT_EQ(value("2*(${a} + 1e-1)"), 6.2);
  EXPECT_EQ(value("--${a}"), 3);
  EXPECT_EQ(value(" .5 * ${step length} "), 0.25);
}

TEST(Expression, NamesWhatItUsed) {
  std::set<std::string> used;
  evaluate_expression("${a} + ${a}", {{"a", 1}, {"b", 2}}, {}, &used);
  EXPECT_EQ(used, std::set<std::string>{"a"});
}

TEST(Expression, SaysWhatIsWrong) {
  EXPECT_NE(value_error("${b}").find("f: /x: expression \"${b}\": unknown parameter 'b'"),
            std::string::npos);
  EXPECT_NE(value_error("${a} *").find("ends where a number is expected"), std::string::npos);
  EXPECT_NE(value_error("${a} 2").find("unexpected '2'"), std::string::npos);
  EXPECT_NE(value_error("(${a}").find("')' is missing"), std::string::npos);
  EXPECT_NE(value_error("${a}/0").find("division by zero"), std::string::npos);
  EXPECT_NE(value_error("${a}*inf").find("unknown name 'inf'"), std::string::npos);
  EXPECT_NE(value_error("${a}*1e300*1e300").find("not a finite number"), std::string::npos);
  EXPECT_NE(value_error("$a").find("write a parameter as ${name}"), std::string::npos);
  EXPECT_NE(value_error(std::string(100000, '(')).find("nested more than 64 levels"),
            std::string::npos);
  EXPECT_NE(value_error(std::string(100000, '-')).find("nested more than 64 levels"),
            std::string::npos);
  for (const std::string& text : {std::string(5000, 'x'), "${" + std::string(5000, 'x') + "}"})
    EXPECT_LT(value_error(text).size(), 600u) << "a long text is not repeated";
}

}  // namespace
}  // namespace ayumi
