#include "ayumi/repair/initial_guess.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>
#include <vector>

#include "ayumi/math/random.hpp"
#include "ayumi/math/windows.hpp"

namespace ayumi {

namespace policy = repair_policy;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// The dofs that move only one of the two bodies.
std::vector<int> joints_between(const RobotModel& model, int a, int b) {
  std::vector<int> count(static_cast<size_t>(model.dof_count()), 0), result;
  for (const int body : {a, b})
    for (int i = body; i > 0; i = model.bodies()[static_cast<size_t>(i)].parent)
      ++count[static_cast<size_t>(model.bodies()[static_cast<size_t>(i)].dof)];
  for (int i = 0; i < model.dof_count(); ++i)
    if (count[static_cast<size_t>(i)] == 1) result.push_back(i);
  return result;
}

std::vector<int> joints_at_fault(const RobotModel& model, const Finding& f) {
  if (dof_of(f) >= 0 && spec_of(f.kind).limit_class == LimitClass::posture) return {dof_of(f)};
  const BodyPairPlace* bodies = std::get_if<BodyPairPlace>(&f.place);
  return bodies ? joints_between(model, bodies->a, bodies->b) : std::vector<int>();
}

// The difference between a cubic, which leads a joint from one end of a window to the other, and
// the motion.
class StraightLine {
 public:
  StraightLine(const CommandSeries& series, int dof, const TimeWindow& window)
      : series_(series), dof_(dof) {
    const double last = series.duration();
    begin_ = std::lround(std::clamp(window.first, 0.0, last) / series.dt);
    end_ = std::lround(std::clamp(window.second, 0.0, last) / series.dt);
  }

  double at(double t) const {
    const long k = std::lround(t / series_.dt);
    if (k <= begin_ || k >= end_) return 0;
    const double length = static_cast<double>(end_ - begin_) * series_.dt;
    const double s = static_cast<double>(k - begin_) / static_cast<double>(end_ - begin_);
    const double q = s * s * (3 - 2 * s);
    const double over = (1 - q) * angle(begin_) + q * angle(end_) +
                        length * s * (1 - s) * ((1 - s) * speed(begin_) - s * speed(end_));
    return over - angle(k);
  }

 private:
  const RobotState& state(long k) const { return series_.samples[static_cast<size_t>(k)].state; }
  double angle(long k) const { return state(k).theta[dof_]; }
  double speed(long k) const { return state(k).dtheta[dof_]; }

  const CommandSeries& series_;
  int dof_;
  long begin_ = 0, end_ = 0;
};

// The violation of the rows of soles and clearances, which are the least linear rows.
struct LeastLinearViolation {
  double sum = 0, worst = 0;
};

bool is_counted(const RowBlock& block) {
  return !block.kind->soft_goal && (std::holds_alternative<SoleRows>(block.rule) ||
                                    std::holds_alternative<ClearanceRows>(block.rule));
}

LeastLinearViolation least_linear_violation(const CorrectionProblem& problem, const VectorXd& x) {
  const VectorXd g = problem.constraints(x);
  LeastLinearViolation result;
  for (const RowBlock& block : problem.blocks()) {
    if (!is_counted(block)) continue;
    for (int i = block.row; i < block.row + block.rows(); ++i) {
      const double off = std::max({0.0, problem.lower()[i] - g[i], g[i] - problem.upper()[i]});
      result.sum += off;
      result.worst = std::max(result.worst, off);
    }
  }
  return result;
}

}  // namespace

MatrixXd with_halved_knots(const MatrixXd& c) {
  MatrixXd fine(2 * c.rows() - 3, c.cols());
  for (Index i = 0; i < fine.rows(); ++i) {
    const Index j = i / 2;
    if (i % 2 == 0)
      fine.row(i) = 0.5 * (c.row(j) + c.row(j + 1));
    else
      fine.row(i) = 0.125 * (c.row(j) + 6 * c.row(j + 1) + c.row(j + 2));
  }
  return fine;
}

MatrixXd straight_line_guess(const RobotModel& model, const CommandSeries& series,
                             const std::vector<Finding>& findings, double reach, double spacing,
                             Index rows) {
  std::map<int, std::vector<TimeWindow>> windows;
  for (const Finding& f : findings) {
    if (f.severity != Severity::error) continue;
    for (const int dof : joints_at_fault(model, f))
      windows[dof].emplace_back(f.begin - reach, f.end + reach);
  }
  MatrixXd result = MatrixXd::Zero(rows, model.velocity_count());
  for (const auto& [dof, of_joint] : windows)
    for (const TimeWindow& window : merged(of_joint)) {
      const StraightLine line(series, dof, window);
      // Each control point is computed from the values at three knots.
      for (Index i = 0; i < rows; ++i) {
        const double t = static_cast<double>(i - 1) * spacing;
        result(i, 6 + dof) += (8 * line.at(t) - line.at(t - spacing) - line.at(t + spacing)) / 6;
      }
    }
  return result;
}

VectorXd random_start(const CorrectionProblem& problem, const RandomStart& how) {
  // Metres of the base for each radian of a joint. Chosen: a leg of 0.2 m that turns by 0.1 rad
  // moves the base by 0.02 m.
  constexpr double kBaseShare = 0.1;
  Random random(how.seed);
  MatrixXd c = problem.track(VectorXd::Zero(problem.variable_count())).coefficients;
  for (Index i = 0; i < c.rows(); ++i)
    for (Index j = 0; j < c.cols(); ++j)
      c(i, j) = (j < 3 ? kBaseShare : 1) * how.size * (2 * random.uniform() - 1);
  return problem.point(c);
}

VectorXd initial_guess(const CorrectionProblem& problem, const Nlp& nlp, const RobotModel& model,
                       const CommandSeries& series, const std::vector<Finding>& findings) {
  const CorrectionTrack track = problem.track(nlp.start);
  VectorXd best = nlp.start;
  LeastLinearViolation least = least_linear_violation(problem, best);
  if (least.worst < policy::guess::kFarOff) return best;
  for (const double reach : policy::guess::kReaches) {
    const VectorXd x = problem.point(straight_line_guess(model, series, findings, reach,
                                                         track.spacing, track.coefficients.rows()));
    const LeastLinearViolation here = least_linear_violation(problem, x);
    if (here.sum >= least.sum) continue;
    least = here;
    best = x;
  }
  return best;
}

}  // namespace ayumi
