#include "ayumi/repair/initial_guess.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <variant>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/random.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/motion/pattern_context.hpp"

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

// Each control point of a cubic spline is computed from the values at three knots; row i of
// `values` is the value at knot i - 1.
MatrixXd through_knots(const MatrixXd& values) {
  const Index rows = values.rows();
  MatrixXd points = MatrixXd::Zero(rows, values.cols());
  for (Index i = 1; i + 1 < rows; ++i)
    points.row(i) = (8 * values.row(i) - values.row(i - 1) - values.row(i + 1)) / 6;
  return points;
}

// The planned places of the soles as a change of the soles of the motion. A supporting sole comes
// to its place; in a swing, the changes before and after it are blended.
class SolePlaces {
 public:
  SolePlaces(const RobotModel& model, const CommandSeries& series)
      : model_(model), series_(series), plan_(contact_plan(series)), data_(model) {}

  std::array<Eigen::Isometry3d, 2> at(int k) {
    std::array<Eigen::Isometry3d, 2> places;
    for (const Side side : {Side::left, Side::right})
      places[static_cast<size_t>(side)] = place(side, k);
    return places;
  }

 private:
  struct Change {
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  };

  Eigen::Isometry3d sole(Side side, int k) {
    update_positions(model_, series_.samples[static_cast<size_t>(k)].state, data_);
    return sole_pose(model_, data_, side);
  }

  Change change_at(Side side, int k, const ContactInterval& contact) {
    const Eigen::Isometry3d now = sole(side, k);
    return {contact.sole.translation() - now.translation(),
            log_rotation(Eigen::Quaterniond(
                Eigen::Matrix3d(contact.sole.linear() * now.linear().transpose())))};
  }

  Eigen::Isometry3d place(Side side, int k) {
    const auto s = static_cast<size_t>(side);
    const std::vector<ContactInterval>& intervals = plan_.intervals[s];
    const auto i = static_cast<size_t>(plan_.index[s][static_cast<size_t>(k)]);
    const ContactInterval& here = intervals[i];
    if (here.contact) return here.sole;
    const Change none;
    const Change before = i > 0 ? change_at(side, here.first, intervals[i - 1]) : none;
    const Change after =
        i + 1 < intervals.size() ? change_at(side, here.last, intervals[i + 1]) : none;
    const double u = static_cast<double>(k - here.first) /
                     static_cast<double>(std::max(1, here.last - here.first));
    Eigen::Isometry3d pose = sole(side, k);
    pose.translation() += (1 - u) * before.shift + u * after.shift;
    pose.linear() =
        exp_rotation((1 - u) * before.turn + u * after.turn).toRotationMatrix() * pose.linear();
    return pose;
  }

  const RobotModel& model_;
  const CommandSeries& series_;
  const ContactPlan plan_;
  RobotData data_;
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
  MatrixXd values = MatrixXd::Zero(rows, model.velocity_count());
  for (const auto& [dof, of_joint] : windows)
    for (const TimeWindow& window : merged(of_joint)) {
      const StraightLine line(series, dof, window);
      for (Index i = 0; i < rows; ++i)
        values(i, 6 + dof) += line.at(static_cast<double>(i - 1) * spacing);
    }
  return through_knots(values);
}

MatrixXd placed_soles_guess(const RobotModel& model, const CommandSeries& series, double spacing,
                            Index rows) {
  MatrixXd values = MatrixXd::Zero(rows, model.velocity_count());
  // The motion may be at fault at its beginning, too, so its first posture is no reference.
  const InverseKinematics ik(model, default_posture(model, {}));
  SolePlaces places(model, series);
  RobotData data(model);
  const int last = static_cast<int>(series.samples.size()) - 1;
  for (Index i = 1; i + 1 < rows; ++i) {
    const int k = std::clamp(
        static_cast<int>(std::lround(static_cast<double>(i - 1) * spacing / series.dt)), 0, last);
    const RobotState& given = series.samples[static_cast<size_t>(k)].state;
    update_positions(model, given, data);
    PostureTarget target;
    target.cog = data.cog;
    target.trunk = data.rotation[static_cast<size_t>(model.trunk_body())];
    target.feet = places.at(k);
    target.nearest = true;
    RobotState state = given;
    ik.solve(target, state, data);
    values.row(i) << (state.base.position - given.base.position).transpose(),
        log_rotation(state.base.attitude * given.base.attitude.conjugate()).transpose(),
        (state.theta - given.theta).transpose();
  }
  return through_knots(values);
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
  const Index rows = track.coefficients.rows();
  const auto take_better = [&](const MatrixXd& coefficients) {
    const VectorXd x = problem.point(coefficients);
    const LeastLinearViolation here = least_linear_violation(problem, x);
    if (here.sum >= least.sum) return;
    least = here;
    best = x;
  };
  for (const double reach : policy::guess::kReaches)
    take_better(straight_line_guess(model, series, findings, reach, track.spacing, rows));
  // Soles that come to their places suddenly need large forces. So all rows count here.
  Nlp from = nlp;
  from.start = best;
  const double worst = violation_at_start(from);
  from.start = problem.point(placed_soles_guess(model, series, track.spacing, rows));
  return violation_at_start(from) < worst ? from.start : best;
}

}  // namespace ayumi
