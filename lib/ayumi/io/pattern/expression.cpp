// Recursive descent:  sum = product {(+|-) product};  product = factor {(*|/) factor};
// factor = -factor | ( sum ) | ${name} | number.
#include "ayumi/io/pattern/expression.hpp"

#include <charconv>
#include <cmath>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

// Nested brackets. Chosen: far more than anybody writes, far less than the stack holds.
constexpr int kMaxDepth = 64;

class Parser {
 public:
  Parser(std::string_view text, const std::map<std::string, double>& parameters,
         const std::string& where, std::set<std::string>* used)
      : text_(text), parameters_(parameters), where_(where), used_(used) {}

  double whole() {
    const double value = sum();
    if (!at_end()) stop("unexpected '" + std::string(text_.substr(at_, 8)) + "'");
    if (!std::isfinite(value)) stop("the result is not a finite number");
    return value;
  }

 private:
  [[noreturn]] void stop(const std::string& reason) const {
    fail(ErrorCode::bad_pattern, where_ + ": expression \"" + std::string(text_) + "\": " + reason);
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
    if (++depth_ > kMaxDepth) stop("nested too deeply");
    double value = 0;
    if (take('-')) {
      value = -factor();
    } else if (take('(')) {
      value = sum();
      if (!take(')')) stop("')' is missing");
    } else if (take('$')) {
      value = parameter();
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

  std::string unknown(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : parameters_) names.push_back(entry.first);
    return "unknown parameter '" + name + "'" + text::suggestion(name, names) +
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
  const std::string& where_;
  std::set<std::string>* used_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

bool is_expression(std::string_view text) { return text.find("${") != std::string_view::npos; }

double evaluate_expression(std::string_view text, const std::map<std::string, double>& parameters,
                           const std::string& where, std::set<std::string>* used) {
  return Parser(text, parameters, where, used).whole();
}

}  // namespace ayumi
