// Recursive descent:
//   sum = product {(+|-) product}
//   product = factor {(*|/) factor}
//   factor = -factor | ( sum ) | ${name} | number | pi | function ( sum {, sum} )
#include "ayumi/io/pattern/expression.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

// Largest depth of nested brackets. Chosen: far more than anybody writes, far less than the stack
// holds.
constexpr int kMaxDepth = 64;

struct Function {
  size_t arguments;
  double (*value)(double, double);
};

// Angles are in radians, whatever the unit of the file.
const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> all = {
      {"sin", {1, [](double x, double) { return elementary::sin(x); }}},
      {"cos", {1, [](double x, double) { return elementary::cos(x); }}},
      {"sqrt", {1, [](double x, double) { return std::sqrt(x); }}},
      {"abs", {1, [](double x, double) { return std::abs(x); }}},
      {"atan2", {2, [](double y, double x) { return elementary::atan2(y, x); }}},
      {"min", {2, [](double a, double b) { return std::min(a, b); }}},
      {"max", {2, [](double a, double b) { return std::max(a, b); }}},
  };
  return all;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

// The word of letters and digits that begins at `at`.
std::string_view word_at(std::string_view text, size_t at) {
  size_t end = at;
  while (end < text.size() && (is_letter(text[end]) || (text[end] >= '0' && text[end] <= '9')))
    ++end;
  return text.substr(at, end - at);
}

class Parser {
 public:
  Parser(std::string_view text, const std::map<std::string, double>& parameters,
         const SourcePlace& where, std::set<std::string>* used)
      : text_(text), parameters_(parameters), where_(where), used_(used) {}

  double whole() {
    const double value = sum();
    if (!at_end()) stop("unexpected '" + std::string(text_.substr(at_, 8)) + "'");
    if (!std::isfinite(value)) stop("the result is not a finite number");
    return value;
  }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_pattern, where_, "expression \"" + text::quotable(text_) + "\": " + reason);
  }

  bool at_end() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ == text_.size();
  }

  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  double sum() {
    double value = product();
    while (true) {
      if (take('+')) {
        value += product();
      } else if (take('-')) {
        value -= product();
      } else {
        return value;
      }
    }
  }

  double product() {
    double value = factor();
    while (true) {
      if (take('*')) {
        value *= factor();
      } else if (take('/')) {
        const double divisor = factor();
        if (divisor == 0) stop("division by zero");
        value /= divisor;
      } else {
        return value;
      }
    }
  }

  double factor() {
    if (++depth_ > kMaxDepth)
      stop("parentheses and signs are nested more than " + std::to_string(kMaxDepth) +
           " levels deep; simplify the expression");
    double value = 0;
    if (take('-')) {
      value = -factor();
    } else if (take('(')) {
      value = sum();
      if (!take(')')) stop("')' is missing");
    } else if (take('$')) {
      value = parameter();
    } else if (!at_end() && is_letter(text_[at_])) {
      value = named();
    } else {
      value = number();
    }
    --depth_;
    return value;
  }

  double parameter() {
    const size_t end = text_.find('}', at_);
    if (at_ >= text_.size() || text_[at_] != '{')
      stop("the { after $ is missing; write a parameter as ${name}");
    if (end == std::string_view::npos)
      stop("the closing } is missing; write a parameter as ${name}");
    const std::string name(text_.substr(at_ + 1, end - at_ - 1));
    at_ = end + 1;
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) stop(unknown(name));
    if (used_) used_->insert(name);
    return found->second;
  }

  double named() {
    const std::string name(word_at(text_, at_));
    at_ += name.size();
    if (name == "pi") return std::numbers::pi;
    const auto found = functions().find(name);
    if (found == functions().end()) stop(unknown_function(name));
    const Function& function = found->second;
    if (!take('(')) stop("'(' is missing after " + name);
    const std::string takes =
        name + (function.arguments == 1 ? " takes one number"
                                        : " takes two numbers, as in \"" + name + "(1, 2)\"");
    std::array<double, 2> value = {};
    for (size_t i = 0; i < function.arguments; ++i) {
      if (i > 0 && !take(',')) stop(takes);
      value[i] = sum();
    }
    if (take(',')) stop(takes);
    if (!take(')')) stop("')' is missing");
    return function.value(value[0], value[1]);
  }

  static std::string unknown_function(const std::string& name) {
    std::vector<std::string> names = {"pi"};
    for (const auto& entry : functions()) names.push_back(entry.first);
    return "unknown name '" + text::quotable(name) + "'; write a parameter as ${" +
           text::quotable(name) + "}; the known names are " + text::join(names, ", ") +
           text::suggestion(name, names);
  }

  std::string unknown(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : parameters_) names.push_back(entry.first);
    return "unknown parameter '" + text::quotable(name) + "'" + text::suggestion(name, names) +
           (names.empty() ? " (the pattern declares no \"parameters\")"
                          : " (declared: " + text::join(names, ", ") + ")");
  }

  double number() {
    if (at_end()) stop("the expression ends where a number is expected");
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    const bool digit = (text_[at_] >= '0' && text_[at_] <= '9') || text_[at_] == '.';
    if (error != std::errc() || !digit)
      stop("expected a number or ${name} at '" + std::string(text_.substr(at_, 8)) + "'");
    at_ = static_cast<size_t>(end - text_.data());
    return value;
  }

  std::string_view text_;
  const std::map<std::string, double>& parameters_;
  const SourcePlace& where_;
  std::set<std::string>* used_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

bool is_expression(std::string_view text) {
  if (text.find("${") != std::string_view::npos) return true;
  for (size_t at = 0; at < text.size(); ++at) {
    const std::string word(word_at(text, at));
    if (word == "pi") return true;
    if (word.empty()) continue;
    at += word.size();
    if (at < text.size() && text[at] == '(' && functions().contains(word)) return true;
  }
  return false;
}

double evaluate_expression(std::string_view text, const std::map<std::string, double>& parameters,
                           const SourcePlace& where, std::set<std::string>* used) {
  return Parser(text, parameters, where, used).whole();
}

}  // namespace ayumi
