#include "gaits/gait_grid.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::app {

namespace {

/// Largest number of values of an axis. Chosen: more than a person can read in a map. Half or twice
/// this number only changes which mistyped lists are refused.
constexpr long kMostValues = 1000;
/// Smallest distance of two values of an axis [m/s, deg/s, s]. Chosen: the names of cells differ,
/// and no walk shows a smaller difference. Half or twice this distance changes nothing.
constexpr double kLeastDistance = 1e-6;

std::vector<std::string> split_at(const std::string& words, char separator) {
  std::vector<std::string> parts = {""};
  for (const char c : words) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

double axis_value(const std::string& word, const std::string& option) {
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, value);
  if (word.empty() || read.ptr != end || read.ec != std::errc() || !std::isfinite(value))
    fail(ErrorCode::usage, option + ": '" + word +
                               "' is not a number. Give values as 0,0.05,0.1 or as "
                               "FROM:TO:COUNT, for example 0:0.1:3");
  return value + 0.0;
}

}  // namespace

std::vector<double> axis_values(const std::string& words, const std::string& option) {
  std::vector<double> values;
  const std::vector<std::string> range = split_at(words, ':');
  if (range.size() == 3) {
    const double from = axis_value(range[0], option), to = axis_value(range[1], option);
    const double count = axis_value(range[2], option);
    if (!(count >= 1 && count <= kMostValues && count == std::floor(count)))
      fail(ErrorCode::usage, option + ": the count must be a whole number from 1 to " +
                                 std::to_string(kMostValues) + ", but it is " + range[2]);
    if (count == 1 && from != to)
      fail(ErrorCode::usage, option + ": one value cannot span the range from " + range[0] +
                                 " to " + range[1] + ". Give a count of 2 or more");
    for (double i = 0; i < count; ++i) {
      const double value = count == 1 ? from : from + (to - from) * i / (count - 1);
      // The value as a person would write it: 0.1 instead of 0.1 + 1e-17.
      values.push_back(axis_value(text::brief(1e-9 * std::round(1e9 * value), 9), option));
    }
  } else if (range.size() == 1) {
    for (const std::string& word : split_at(words, ',')) values.push_back(axis_value(word, option));
  } else {
    fail(ErrorCode::usage, option + ": '" + words +
                               "' is not a list of values. Give the values as 0,0.05,0.1 or as "
                               "FROM:TO:COUNT, for example 0:0.1:3");
  }
  for (size_t i = 1; i < values.size(); ++i)
    if (!(values[i] > values[i - 1] + kLeastDistance))
      fail(ErrorCode::usage, option + ": the values must ascend by more than " +
                                 text::brief(kLeastDistance) + ", but " + text::exact(values[i]) +
                                 " comes after " + text::exact(values[i - 1]));
  if (values.size() > kMostValues)
    fail(ErrorCode::usage, option + ": " + std::to_string(values.size()) +
                               " values are too many. Give at most " + std::to_string(kMostValues));
  return values;
}

GaitCell GaitGrid::cell(size_t index) const {
  const size_t s = index % sideways.size(), f = index / sideways.size() % forward.size();
  const size_t rest = index / (sideways.size() * forward.size());
  const size_t t = rest % turn.size(), p = rest / turn.size();
  // In most grids these numbers are whole, so that the names have no decimal points.
  const auto thousandths = [](double value) { return text::brief(1e3 * value, 9); };
  return {.name = "f" + thousandths(forward[f]) + "_s" + thousandths(sideways[s]) + "_t" +
                  text::brief(turn[t], 9) + "_p" + thousandths(period[p]),
          .forward = forward[f],
          .sideways = sideways[s],
          .turn = turn[t] * std::numbers::pi / 180,
          .period = period[p]};
}

std::vector<GaitCell> GaitGrid::cells() const {
  std::vector<GaitCell> all;
  for (size_t i = 0; i < size(); ++i) all.push_back(cell(i));
  return all;
}

std::vector<GaitCell> GaitGrid::corners() const {
  const auto ends = [](const std::vector<double>& axis) {
    return axis.size() == 1 ? axis : std::vector{axis.front(), axis.back()};
  };
  return GaitGrid{ends(forward), ends(sideways), ends(turn), ends(period)}.cells();
}

std::vector<std::pair<size_t, size_t>> GaitGrid::neighbours() const {
  // The number of values of each axis, and the distance of two neighbours in the list of cells.
  const std::array<std::pair<size_t, size_t>, 4> axes = {
      {{sideways.size(), 1},
       {forward.size(), sideways.size()},
       {turn.size(), sideways.size() * forward.size()},
       {period.size(), sideways.size() * forward.size() * turn.size()}}};
  std::vector<std::pair<size_t, size_t>> pairs;
  for (size_t i = 0; i < size(); ++i)
    for (const auto& [count, stride] : axes)
      if (i / stride % count + 1 < count) {
        pairs.emplace_back(i, i + stride);
        pairs.emplace_back(i + stride, i);
      }
  return pairs;
}

}  // namespace ayumi::app
