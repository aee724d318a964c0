#include "ayumi/check/motor_board.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

constexpr double kBoardDegrees = 180 / EIGEN_PI;  // Definition
// Definition: range of signed numbers of 16 bits.
constexpr double kFewestCounts = -32768, kMostCounts = 32767;
constexpr double kWhole = 1e-6;  // tolerance in counts. Chosen: above rounding errors of deg and
                                 // rad

// Keeps the worst difference of each kind for one joint.
class Watch {
 public:
  Watch(std::string joint, double unit) : joint_(std::move(joint)), unit_(unit) {}
  void note(Clamp::Kind kind, double change, double t) {
    if (std::abs(change) <= kWhole) return;
    for (Clamp& known : found_) {
      if (known.kind != kind) continue;
      ++known.rows;
      if (std::abs(change) * unit_ <= known.change) return;
      known.change = std::abs(change) * unit_;
      known.t = t;
      return;
    }
    found_.push_back({kind, joint_, t, std::abs(change) * unit_, 1});
  }
  const std::vector<Clamp>& found() const { return found_; }

 private:
  std::string joint_;
  double unit_;  // angle of one count [rad]; 1 for a joint without counts
  std::vector<Clamp> found_;
};

}  // namespace

const char* name_of(Clamp::Kind kind) {
  switch (kind) {
    case Clamp::Kind::range:
      return "range";
    case Clamp::Kind::position:
      return "position";
    case Clamp::Kind::speed:
      return "speed";
  }
  return "";
}

BoardTargets board_targets(const RobotModel& model, const ReferenceTrajectory& table,
                           const SafetyOptions& options) {
  const Eigen::MatrixXi rounded = encoder_counts(model, table, options);
  const Eigen::VectorXd zeros = encoder_zeros(model);
  const double ms = table.dt * 1000;
  const bool whole = std::round(ms) >= 1 && std::abs(ms - std::round(ms)) < kWhole;
  const Eigen::Index share = whole ? std::lround(ms) : 1;
  const auto rows = static_cast<Eigen::Index>(table.rows.size());
  BoardTargets result;
  result.dt = whole ? 0.001 : table.dt;
  result.targets.resize(model.dof_count(), (rows - 1) * share + 1);
  for (int j = 0; j < model.dof_count(); ++j) {
    const Dof& dof = model.dofs()[static_cast<size_t>(j)];
    const double counts =
        dof.encoder.device > 0 ? dof.encoder.counts_per_degree * kBoardDegrees : 0;
    const double scale = counts != 0 ? counts : 1;
    double lower = -1e300, upper = 1e300, step = model.limits(options.profile).speed[j] * result.dt;
    if (dof.limited) {
      // The board does not know the zero of this unit, and the limits of its type are in counts.
      const double a = dof.lower * scale, b = dof.upper * scale;
      lower = std::min(a, b);
      upper = std::max(a, b);
    }
    if (counts != 0) {
      lower = std::ceil(lower - kWhole);
      upper = std::floor(upper + kWhole);
      step = options.counts_per_ms * 1000 * result.dt;
    }
    const auto column = std::find(table.joints.begin(), table.joints.end(), dof.name);
    const auto at = static_cast<Eigen::Index>(column - table.joints.begin());
    Watch watch(dof.name, 1 / std::abs(scale));
    double board = 0;
    for (Eigen::Index k = 0; k < result.targets.cols(); ++k) {
      const Eigen::Index row = k / share;
      const double x = (table.rows[static_cast<size_t>(row)].theta[at] - zeros[j]) * scale;
      double asked = x;
      if (counts != 0)
        asked = std::abs(x - std::round(x)) < kWhole ? std::round(x) : rounded(row, j);
      const double t = static_cast<double>(k) * result.dt;
      const double fits = counts != 0 ? std::clamp(asked, kFewestCounts, kMostCounts) : asked;
      const double inside = std::clamp(fits, lower, upper);
      board = k == 0 ? inside : std::clamp(inside, board - step, board + step);
      watch.note(Clamp::Kind::range, asked - fits, t);
      watch.note(Clamp::Kind::position, fits - inside, t);
      watch.note(Clamp::Kind::speed, inside - board, t);
      result.targets(j, k) = board / scale + zeros[j];
    }
    result.clamps.insert(result.clamps.end(), watch.found().begin(), watch.found().end());
  }
  std::stable_sort(result.clamps.begin(), result.clamps.end(),
                   [](const Clamp& a, const Clamp& b) { return a.change > b.change; });
  return result;
}

}  // namespace ayumi
