#pragma once
// Small arithmetic over a pattern's parameters: "${stride}*2 + 0.01*sin(pi/6)".

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "ayumi/base/error.hpp"

namespace ayumi {

/// Whether a string is meant as an expression: it names a parameter, "${name}", a function or pi.
bool is_expression(std::string_view text);

/// The value of an expression with + - * /, parentheses, unary minus, numbers, ${names}, pi, sin,
/// cos, sqrt, abs, atan2, min and max; angles are in radians. Adds the names that it contains to
/// `used` if this is given. Throws Error(bad_pattern) "where: reason" for an unknown name, for
/// wrong syntax or for a result that is not finite.
double evaluate_expression(std::string_view text, const std::map<std::string, double>& parameters,
                           const SourcePlace& where, std::set<std::string>* used = nullptr);

}  // namespace ayumi
