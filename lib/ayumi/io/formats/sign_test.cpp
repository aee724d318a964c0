#include "ayumi/io/formats/sign_test.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/limits/table_safety.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/encoder_angles.hpp"

namespace ayumi {

namespace {

// Size of the motion. Chosen: a person sees it clearly, and no part of the robot touches another
// one. Half of it is hard to see at a wrist; with twice, the feet of a robot touch each other.
constexpr double kAngle = 5 * EIGEN_PI / 180;  // angle by which a joint is moved [rad]
constexpr double kSlide = 0.01;                // distance by which a sliding joint is moved [m]
// Times of one test [s]. Chosen: 2.5 degrees per second on average, slow enough to be stopped.
constexpr double kRest = 0.5, kMove = 2, kHold = 1;

TargetRange range_of(const RobotModel& model, int j) {
  const Dof& dof = model.dofs()[static_cast<size_t>(j)];
  return target_range(dof, encoder_zeros(model)[j],
                      dof.prismatic ? 0 : model.description().soft_limit_margin);
}

double wanted_change(const RobotModel& model, int j, double from) {
  const double size = model.dofs()[static_cast<size_t>(j)].prismatic ? kSlide : kAngle;
  const TargetRange range = range_of(model, j);
  const double up = range.upper - from, down = from - range.lower;
  if (up >= size) return size;
  if (down >= size) return -size;
  return up >= down ? std::max(up, 0.0) : -std::max(down, 0.0);
}

/// The first two bodies that overlap with these joint angles, in words; empty if none do.
std::string overlapping(const RobotModel& model, const CollisionModel& collisions,
                        const Eigen::VectorXd& theta) {
  RobotState state = model.rest_state();
  state.theta = theta;
  RobotData data(model);
  update_positions(model, state, data);
  const auto name = [&](int body) { return model.bodies()[static_cast<size_t>(body)].name; };
  for (const CollisionModel::Pair& pair : collisions.pairs())
    if (collisions.clearance(pair, data, 0) < 0) return name(pair.a) + " and " + name(pair.b);
  return "";
}

/// The angle to which a joint moves in its test. If parts of the robot would overlap there, the
/// joint moves in the other direction.
double free_end(const RobotModel& model, const CollisionModel& collisions,
                const Eigen::VectorXd& start, int j) {
  const Dof& dof = model.dofs()[static_cast<size_t>(j)];
  const double wanted = wanted_change(model, j, start[j]);
  const TargetRange range = range_of(model, j);
  std::string overlap;
  for (const double change : {wanted, -wanted}) {
    Eigen::VectorXd moved = start;
    moved[j] += change;
    if (change == -wanted && (moved[j] < range.lower || moved[j] > range.upper)) break;
    const std::string found = overlapping(model, collisions, moved);
    if (found.empty()) return moved[j];
    if (overlap.empty()) overlap = found;
  }
  fail(ErrorCode::bad_model, "sign test of " + dof.name + ": " + overlap +
                                 " overlap while this joint moves. Name another start posture with "
                                 "--posture");
}

double share_at(double t) {
  if (t < kRest + kMove) return minimum_jerk((t - kRest) / kMove).value;
  return 1 - minimum_jerk((t - kRest - kMove - kHold) / kMove).value;
}

}  // namespace

Eigen::VectorXd sign_test_start(const RobotModel& model) {
  Eigen::VectorXd start = encoder_zeros(model);  // here, the encoders read 0
  for (int j = 0; j < model.dof_count(); ++j) {
    const auto [lower, upper] = range_of(model, j);
    start[j] = lower > upper ? 0.5 * (lower + upper) : std::clamp(start[j], lower, upper);
  }
  const std::string overlap = overlapping(model, CollisionModel(model), start);
  if (!overlap.empty())
    fail(ErrorCode::bad_model, "robot '" + model.name() + "': " + overlap +
                                   " overlap if every joint is at 0, or at its limit nearest to 0. "
                                   "Name another start posture with --posture");
  return start;
}

std::vector<SignTest> sign_tests(const RobotModel& model, const Eigen::VectorXd& start, double dt) {
  std::vector<SignTest> tests;
  const CollisionModel collisions(model);
  const std::string overlap = overlapping(model, collisions, start);
  if (!overlap.empty())
    fail(ErrorCode::bad_model, "robot '" + model.name() + "': " + overlap +
                                   " overlap in the start posture. Name another start posture with "
                                   "--posture");
  const auto rows = static_cast<size_t>(std::lround((2 * kRest + 2 * kMove + kHold) / dt)) + 1;
  for (int j = 0; j < model.dof_count(); ++j) {
    const auto at = static_cast<size_t>(j);
    // Passive joints have no test.
    if (model.limits().has_servo[at] && model.limits().servo[at].kp <= 0) continue;
    SignTest test;
    test.dof = j;
    test.from = start[j];
    test.to = free_end(model, collisions, start, j);
    test.table.dt = dt;
    test.table.joints = model.dof_names();
    for (size_t k = 0; k < rows; ++k) {
      ReferenceRow row;
      row.theta = start;
      row.theta[j] += share_at(static_cast<double>(k) * dt) * (test.to - test.from);
      row.contact = {false, false};
      test.table.rows.push_back(std::move(row));
    }
    tests.push_back(std::move(test));
  }
  if (tests.empty())
    fail(ErrorCode::bad_model, "robot '" + model.name() + "': no joint has a motor");
  std::stable_sort(tests.begin(), tests.end(), [&](const SignTest& a, const SignTest& b) {
    return model.dofs()[static_cast<size_t>(a.dof)].encoder.device <
           model.dofs()[static_cast<size_t>(b.dof)].encoder.device;
  });
  for (size_t i = 0; i < tests.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    tests[i].name = (number.size() < 2 ? "0" : "") + number + "_" +
                    model.dofs()[static_cast<size_t>(tests[i].dof)].name;
  }
  return tests;
}

}  // namespace ayumi
