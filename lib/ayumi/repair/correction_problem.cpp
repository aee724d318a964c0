// Gram matrices of uniform cubic B-splines with knots h apart, by distance of the control points:
//   integral B_i B_j     = h / 5040 (2416, 1191, 120, 1)
//   integral B_i'' B_j'' = 1 / h^3 (8/3, -3/2, 0, 1/6).
#include "ayumi/repair/correction_problem.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/repair/weighted_change.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double kValueGram[] = {2416.0 / 5040, 1191.0 / 5040, 120.0 / 5040, 1.0 / 5040};
constexpr double kCurvatureGram[] = {8.0 / 3, -1.5, 0, 1.0 / 6};

Curvature restricted(const Curvature& all, const std::vector<int>& columns) {
  Curvature some = all;
  some.value = all.value(columns, columns);
  some.acceleration = all.acceleration(columns, columns);
  for (int k = 0; k < 3; ++k)
    if (all.force_by[k].size() > 0) some.force_by[k] = all.force_by[k](Eigen::all, columns);
  return some;
}

// Over the pairs of control points that act at an instant.
void spread(const SplineWeights& w, const Curvature& curvature, std::vector<MatrixXd>& pairs) {
  const MatrixXd &V = curvature.value, &G = curvature.acceleration;
  const MatrixXd Gt = G.transpose(), S = G + Gt;
  const bool cone = !curvature.cone.isZero(0);
  std::array<MatrixXd, 4> force;
  for (int i = 0; i < 4 && cone; ++i)
    force[i] = w.value[i] * curvature.force_by[0] + w.rate[i] * curvature.force_by[1] +
               w.acceleration[i] * curvature.force_by[2];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j <= i; ++j) {
      MatrixXd& pair = pairs[static_cast<size_t>(4 * (w.first + i) + i - j)];
      if (pair.size() == 0) pair = MatrixXd::Zero(V.rows(), V.cols());
      pair += w.value[i] * w.value[j] * V + w.acceleration[i] * w.value[j] * G +
              w.value[i] * w.acceleration[j] * Gt + w.rate[i] * w.rate[j] * S;
      if (cone) pair.noalias() += force[i].transpose() * (curvature.cone * force[j]);
    }
}

MatrixXd coefficients(const Eigen::MatrixXi& index, const VectorXd& x) {
  return index.unaryExpr([&x](int variable) { return variable < 0 ? 0.0 : x[variable]; });
}

}  // namespace

CorrectionProblem::CorrectionProblem(const RobotModel& model, const CommandSeries& series,
                                     const CorrectionSpec& spec)
    : model_(model), series_(series), spec_(spec), plan_(contact_plan(series)) {
  zero_.begin = 0;
  const int intervals =
      std::max(1, static_cast<int>(std::ceil(series.duration() / spec.spacing - 1e-9)));
  zero_.spacing = std::max(series.duration(), series.dt) / intervals;
  zero_.joints = model.dof_names();
  zero_.coefficients = MatrixXd::Zero(intervals + 3, model.velocity_count());
  place_variables();
  place_instants();
  place_constraints();
  place_jacobian();
  place_objective();
  place_curvature();
}

bool CorrectionProblem::inside_a_window(double begin, double end) const {
  return std::any_of(spec_.windows.begin(), spec_.windows.end(),
                     [&](const auto& w) { return begin >= w.first && end <= w.second; });
}

bool CorrectionProblem::locked_within(double begin, double end) const {
  constexpr double kRounding = 1e-9;  // [s]
  return std::any_of(spec_.locked_windows.begin(), spec_.locked_windows.end(), [&](const auto& w) {
    return begin < w.second + kRounding && end > w.first - kRounding;
  });
}

void CorrectionProblem::place_variables() {
  const int rows = static_cast<int>(zero_.coefficients.rows());
  const int columns = static_cast<int>(zero_.coefficients.cols());
  index_.setConstant(rows, columns, -1);
  for (int i = 3; i < rows - 3; ++i) {
    const double begin = (i - 3) * zero_.spacing, end = (i + 1) * zero_.spacing;
    if (!inside_a_window(begin, end) || locked_within(begin, end)) continue;
    for (int j = 0; j < columns; ++j) {
      if (j >= 6 && !spec_.locked.empty() && spec_.locked[j - 6]) continue;
      index_(i, j) = variable_count_++;
    }
  }
  place_end(0, 0);
  place_end(rows - 3, series_.duration());
}

// What is wrong at an end has to be moved there too: one variable for the three control points of
// that end, so that the motion still begins or ends as fast as it did.
void CorrectionProblem::place_end(int first, double time) {
  const double reach = (time == 0 ? 1 : -1) * zero_.spacing;  // of the three control points
  if (!inside_a_window(time, time) || !spec_.free_ends[first == 0 ? 0 : 1]) return;
  for (const double kept : spec_.kept_instants)
    if (std::abs(kept - time) <= zero_.spacing) return;
  if (locked_within(std::min(time, time + 3 * reach), std::max(time, time + 3 * reach))) return;
  for (int j = 0; j < model_.velocity_count(); ++j)
    if (j < 6 || spec_.locked.empty() || !spec_.locked[j - 6])
      index_.block<3, 1>(first, j).setConstant(variable_count_++);
}

bool CorrectionProblem::free_at(const SplineWeights& weights) const {
  for (int i = 0; i < 4; ++i)
    if (weights.value[i] > 0 && index_.row(weights.first + i).maxCoeff() >= 0) return true;
  return false;
}

// At the knots and between them, for there the acceleration of a cubic spline has its kinks, and at
// both ends of every contact interval, where what must hold changes.
void CorrectionProblem::place_instants() {
  std::set<int> samples, knots;
  const int count = static_cast<int>(series_.samples.size());
  const int places = spec_.instants_per_knot * static_cast<int>(zero_.coefficients.rows() - 3);
  for (int i = 0; i <= places; ++i) {
    const double t = i * zero_.spacing / spec_.instants_per_knot;
    const int sample = std::min(count - 1, static_cast<int>(std::lround(t / series_.dt)));
    samples.insert(sample);
    if (i % spec_.instants_per_knot == 0) knots.insert(sample);
  }
  for (const auto* times : {&spec_.extra, &spec_.kept_instants})
    for (const double t : *times)
      samples.insert(std::clamp(static_cast<int>(std::lround(t / series_.dt)), 0, count - 1));
  for (const auto& intervals : plan_.intervals)
    for (const ContactInterval& interval : intervals) {
      samples.insert(interval.first);
      samples.insert(interval.last);
    }
  // Beside the edges of a flight, where forces are told again.
  for (int k = 1; k < count; ++k) {
    if (at_flight_edge(series_, k) == at_flight_edge(series_, k - 1)) continue;
    samples.insert(k - 1);
    samples.insert(k);
  }
  for (const PressedLimit& limit : spec_.pressed)
    if (!samples.contains(limit.sample)) only_[limit.sample].emplace(limit.group, limit.item);
  for (const auto& [sample, rows] : only_) samples.insert(sample);
  for (const int k : samples) add_instant(k, knots.contains(k));
}

void CorrectionProblem::add_instant(int k, bool at_knot) {
  CollocationPoint instant;
  instant.sample = k;
  instant.weights = correction_weights(zero_, k * series_.dt);
  instant.at_knot = at_knot;
  instant.known = !at_flight_edge(series_, k);
  if (!free_at(instant.weights)) return;
  for (Side side : {Side::left, Side::right}) {
    const int s = static_cast<int>(side);
    const int i = plan_.index[s][k];
    instant.contact[s] = plan_.intervals[s][i].contact;
    const int last = static_cast<int>(plan_.intervals[s].size()) - 1;
    const ContactInterval& before = plan_.intervals[s][std::max(0, i - 1)];
    const ContactInterval& after = plan_.intervals[s][std::min(last, i + 1)];
    const bool lower = before.sole.translation().z() < after.sole.translation().z();
    instant.ground[s] = instant.contact[s] ? plan_.intervals[s][i].sole
                        : lower            ? before.sole
                                           : after.sole;
    const ContactInterval& swing = plan_.intervals[s][i];
    instant.place[s] = k - swing.first < swing.last - k ? before.sole : after.sole;
  }
  instant.plane = support_plane(model_, plan_.support(k), instant.ground);
  RobotData data(model_);
  const CommandSample& sample = series_.samples[k];
  update_positions(model_, sample.state, data);
  instant.path = {sole_pose(model_, data, Side::left), sole_pose(model_, data, Side::right)};
  instant.cog = sample.cog;
  instant.collisions = spec_.collisions;
  if (instant.plane.empty()) instant.plane.frame.translation() = series_.samples[k].cog;
  instants_.push_back(std::move(instant));
}

// What decides whether a limit is near: the motion, and wherever it has come to. Were it only the
// last result, a limit that its rows have mended would lose them and be broken again.
std::vector<const CommandSample*> CorrectionProblem::watched(int instant) const {
  const int k = instants_[instant].sample;
  std::vector<const CommandSample*> samples = {&series_.samples[k]};
  for (const CommandSeries* seen : spec_.seen) samples.push_back(&seen->samples[k]);
  return samples;
}

void CorrectionProblem::place_jacobian() {
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const ConstraintBlock& block = blocks_[b];
    const int first = instants_[block.instant].weights.first;
    for (int i = 0; i < 4; ++i)
      for (int column : columns_[b]) {
        const int variable = index_(first + i, column);
        if (variable < 0) continue;
        for (int row = 0; row < block.rows; ++row) jacobian_.add(block.row + row, variable);
      }
  }
}

void CorrectionProblem::place_objective() {
  const VectorXd weight = change_weights(model_, series_, spec_.weights);
  const double h = zero_.spacing, smooth = std::pow(kSmoothTime, 4);
  std::vector<double> values;
  for (int point = 0; point < index_.rows(); ++point)
    for (int column = 0; column < index_.cols(); ++column)
      for (int d = 0; d < 4 && point - d >= 0; ++d) {
        const int one = index_(point, column), other = index_(point - d, column);
        if (one < 0 || other < 0) continue;
        // Two control points that share a variable meet on the diagonal, where both orders count.
        const double share = d > 0 && one == other ? 2 : 1;
        hessian_.add(std::max(one, other), std::min(one, other));
        values.push_back(share * kObjectiveScale * weight[column] *
                         (h * kValueGram[d] + smooth / (h * h * h) * kCurvatureGram[d]));
      }
  hessian_values_ = Eigen::Map<VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  objective_nonzeros_ = hessian_.size();
}

// Nonzeros of all pairs of variables of base and legs up to three control points apart: by the
// later point, by their distance, by columns. Arms add little on the ground. In flight they do not,
// and there the whole curvature asked for more iterations than none.
void CorrectionProblem::place_curvature() {
  if (!model_.has_soles() ||
      std::any_of(instants_.begin(), instants_.end(),
                  [](const CollocationPoint& at) { return at.plane.empty(); }))
    return;
  std::set<int> columns_of_legs = {0, 1, 2, 3, 4, 5};
  for (const Side side : {Side::left, Side::right})
    for (const int dof : model_.leg(side)) columns_of_legs.insert(6 + dof);
  curved_.assign(columns_of_legs.begin(), columns_of_legs.end());
  const int columns = static_cast<int>(curved_.size());
  for (int point = 0; point < index_.rows(); ++point)
    for (int d = 0; d < 4; ++d) {
      pairs_.push_back(hessian_.size());
      for (int a = 0; a < columns && d <= point; ++a)
        for (int b = 0; b < (d == 0 ? a + 1 : columns); ++b) {
          const int one = index_(point, curved_[a]), other = index_(point - d, curved_[b]);
          if (one >= 0 && other >= 0) hessian_.add(std::max(one, other), std::min(one, other));
        }
    }
}

void CorrectionProblem::add_curvature(const VectorXd& x, const VectorXd& multipliers,
                                      VectorXd& values) const {
  if (curved_.empty()) return;
  const MatrixXd c = coefficients(index_, x);
  RobotData data(model_);
  TreeDynamics dynamics(model_);
  std::vector<MatrixXd> pairs(pairs_.size());
  size_t first = 0;
  for (size_t at = 0; at < instants_.size(); ++at) {
    size_t end = first;
    while (end < blocks_.size() && blocks_[end].instant == static_cast<int>(at)) ++end;
    const std::span<const ConstraintBlock> blocks(&blocks_[0] + first, end - first);
    first = end;
    const CollocationPoint& instant = instants_[at];
    const PointState state =
        point_state(model_, series_.samples[instant.sample], instant, c, &dynamics, data);
    const Curvature curvature = curvature_of(model_, blocks, multipliers, instant, state, dynamics);
    if (!is_flat(curvature)) spread(instant.weights, restricted(curvature, curved_), pairs);
  }
  add_pairs(pairs, values);
}

void CorrectionProblem::add_pairs(const std::vector<MatrixXd>& pairs, VectorXd& values) const {
  const int columns = static_cast<int>(curved_.size());
  for (int point = 0; point < index_.rows(); ++point)
    for (int d = 0; d < 4; ++d) {
      const auto pair = static_cast<size_t>(4 * point + d);
      if (pairs[pair].size() == 0) continue;
      int next = pairs_[pair];
      for (int a = 0; a < columns; ++a)
        for (int b = 0; b < (d == 0 ? a + 1 : columns); ++b) {
          const int one = index_(point, curved_[a]), other = index_(point - d, curved_[b]);
          if (one < 0 || other < 0) continue;
          values[next++] += (d > 0 && one == other ? 2 : 1) * pairs[pair](a, b);
        }
    }
}

VectorXd CorrectionProblem::constraints(const VectorXd& x) const {
  return constraints(series_, coefficients(index_, x));
}

VectorXd CorrectionProblem::constraints_of(const CommandSeries& motion) const {
  return constraints(motion, zero_.coefficients);
}

VectorXd CorrectionProblem::constraints(const CommandSeries& motion, const MatrixXd& c) const {
  VectorXd g(constraint_count());
  RobotData data(model_);
  PointState state;
  int at = -1;
  for (const ConstraintBlock& block : blocks_) {
    const CollocationPoint& instant = instants_[block.instant];
    if (block.instant != at)
      state = point_state(model_, motion.samples[instant.sample], instant, c, nullptr, data);
    at = block.instant;
    g.segment(block.row, block.rows) = block_values(model_, block, instant, state);
  }
  return g;
}

void CorrectionProblem::jacobian_values(const VectorXd& x, VectorXd& values) const {
  const MatrixXd c = coefficients(index_, x);
  RobotData data(model_);
  TreeDynamics dynamics(model_);
  PointState state;
  int at = -1;
  Eigen::Index next = 0;
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const ConstraintBlock& block = blocks_[b];
    const CollocationPoint& instant = instants_[block.instant];
    if (block.instant != at)
      state = point_state(model_, series_.samples[instant.sample], instant, c, &dynamics, data);
    at = block.instant;
    const auto by = block_derivatives(model_, block, instant, state);
    const SplineWeights& w = instant.weights;
    const Eigen::Vector4d* weights[] = {&w.value, &w.rate, &w.acceleration};
    for (int i = 0; i < 4; ++i)
      for (int column : columns_[b]) {
        if (index_(w.first + i, column) < 0) continue;
        for (int row = 0; row < block.rows; ++row) {
          double sum = 0;
          for (int k = 0; k < 3; ++k)
            if (by[k].size() > 0) sum += (*weights[k])[i] * by[k](row, column);
          values[next++] = sum;
        }
      }
  }
}

Nlp CorrectionProblem::nlp() const {
  Nlp nlp;
  nlp.start = spec_.start.rows() == zero_.coefficients.rows() ? point(spec_.start)
                                                              : VectorXd::Zero(variable_count());
  nlp.lower = VectorXd::Constant(variable_count(), -kNoBound);
  nlp.upper = VectorXd::Constant(variable_count(), kNoBound);
  nlp.constraint_lower = lower_;
  nlp.constraint_upper = upper_;
  nlp.jacobian = jacobian_;
  nlp.hessian = hessian_;
  auto gradient = [this](const VectorXd& x, VectorXd& g) {
    g.setZero();
    for (int i = 0; i < objective_nonzeros_; ++i) {
      const int a = hessian_.rows[i], b = hessian_.columns[i];
      g[a] += hessian_values_[i] * x[b];
      if (a != b) g[b] += hessian_values_[i] * x[a];
    }
  };
  nlp.gradient = gradient;
  nlp.objective = [gradient](const VectorXd& x) {
    VectorXd g(x.size());
    gradient(x, g);
    return 0.5 * g.dot(x);
  };
  nlp.constraints = [this](const VectorXd& x, VectorXd& g) { g = constraints(x); };
  nlp.jacobian_values = [this](const VectorXd& x, VectorXd& values) { jacobian_values(x, values); };
  nlp.hessian_values = [this](const VectorXd& x, double scale, const VectorXd& multipliers,
                              VectorXd& values) {
    values.setZero();
    values.head(objective_nonzeros_) = scale * hessian_values_;
    add_curvature(x, multipliers, values);
  };
  return nlp;
}

VectorXd CorrectionProblem::point(const MatrixXd& coefficients) const {
  VectorXd x = VectorXd::Zero(variable_count());
  for (Eigen::Index i = 0; i < index_.rows(); ++i)
    for (Eigen::Index j = 0; j < index_.cols(); ++j)
      if (index_(i, j) >= 0) x[index_(i, j)] = coefficients(i, j);
  return x;
}

CorrectionTrack CorrectionProblem::track(const VectorXd& x) const {
  CorrectionTrack track = zero_;
  track.coefficients = coefficients(index_, x);
  return track;
}

}  // namespace ayumi
