#include "ayumi/motion/reference_trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

ReferenceRow between(const ReferenceRow& a, const ReferenceRow& b, double u) {
  ReferenceRow row;
  row.theta = (1 - u) * a.theta + u * b.theta;
  row.contact = a.contact;
  row.base.position = (1 - u) * a.base.position + u * b.base.position;
  row.base.attitude = elementary::between(a.base.attitude, b.base.attitude, u);
  row.cog = (1 - u) * a.cog + u * b.cog;
  row.zmp = (1 - u) * a.zmp + u * b.zmp;
  row.fz = (1 - u) * a.fz + u * b.fz;
  return row;
}

}  // namespace

ReferenceTrajectory resampled(const ReferenceTrajectory& table, double dt) {
  // Definition: a time belongs to a row if it is nearer than this to the row, as a fraction of dt.
  constexpr double kOnRow = 1e-6;
  // Largest number of rows. Chosen: the longest pattern, 3600 s, at 1 kHz, as for the samples of a
  // pattern; more would exhaust the memory.
  constexpr double kMostRows = 4e6;
  const double rows = static_cast<double>(table.rows.size()) * table.dt / dt;
  if (!(dt > 0 && rows <= kMostRows && std::isfinite(dt)))
    fail(ErrorCode::usage,
         "a table cannot have rows every " + text::exact(dt) +
             " s. The time between rows must be above 0, and a table may have at most " +
             text::brief(kMostRows) + " rows");
  if (table.rows.empty() || std::abs(dt - table.dt) < kOnRow * table.dt) return table;
  ReferenceTrajectory result = table;
  result.dt = dt;
  result.rows.clear();
  const double last = static_cast<double>(table.rows.size() - 1);
  const auto count = static_cast<size_t>(std::ceil(last * table.dt / dt - kOnRow)) + 1;
  for (size_t k = 0; k < count; ++k) {
    const double at = std::min(static_cast<double>(k) * dt / table.dt, last);
    const double row = std::round(at);
    if (std::abs(at - row) < kOnRow) {
      result.rows.push_back(table.rows[static_cast<size_t>(row)]);
      continue;
    }
    const auto before = static_cast<size_t>(std::floor(at));
    result.rows.push_back(
        between(table.rows[before], table.rows[before + 1], at - static_cast<double>(before)));
  }
  return result;
}

}  // namespace ayumi
