#include "ayumi/identify/exchanged_joints.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/identify/lost_rows.hpp"
#include "ayumi/identify/recording_checks.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// An angle follows the command of another joint if its distance from that command is below this
// share of its distance from its own command. Chosen: a servo that follows its own command is far
// nearer to it, and zero offsets of two degrees are a quarter of the motion of a walking joint.
constexpr double kFarBetter = 0.25;

// Time between the compared rows [s]. Chosen: joints of walks move for tenths of a second.
constexpr double kExchangeStep = 0.01;

// Step between the delays of a response that are tried [s]. Chosen: the delay of a servo is then at
// most 4 ms from one of them. In this time, a joint of a walk (2 rad/s) moves by half a degree.
constexpr double kAnswerStep = 0.008;

// Both tables at the same times; columns are joints.
struct Rows {
  MatrixXd command, measured;
};
Rows rows_of(const AngleTable& command, const AngleTable& measured, double shift, double begin,
             double end) {
  const double first = std::max({0.0, begin, -shift}),
               last = std::min({command.duration(), end, measured.duration() - shift});
  const Index count = last > first ? static_cast<Index>((last - first) / kExchangeStep) + 1 : 0;
  const Index dofs = command.theta.cols();
  Rows rows{MatrixXd(count, dofs), MatrixXd(count, dofs)};
  for (Index k = 0; k < count; ++k)
    for (Index j = 0; j < dofs; ++j) {
      const double t = first + kExchangeStep * static_cast<double>(k);
      rows.command(k, j) = angle_at(command, j, t);
      rows.measured(k, j) = angle_at(measured, j, t + shift);
    }
  return rows;
}

double rms(const VectorXd& values) {
  return values.norm() / std::sqrt(std::max(1.0, static_cast<double>(values.size())));
}

VectorXd without_mean(const VectorXd& values) { return values.array() - values.mean(); }

// The distance of an angle from its own command. A wrong zero and a wrong sign do not count,
// because they are other mistakes.
double own_distance(const Rows& rows, Index j) {
  const VectorXd m = without_mean(rows.measured.col(j)), c = without_mean(rows.command.col(j));
  return std::min(rms(m - c), rms(m + c));
}

// The distance of the angle of joint a from the command of joint b. If columns of counts were
// exchanged, they were converted with the counts per degree of the wrong joint.
double other_distance(const RobotModel& model, const Rows& rows, Index a, Index b) {
  const VectorXd m = rows.measured.col(a), c = rows.command.col(b);
  const double own = model.dofs()[static_cast<size_t>(a)].encoder.counts_per_degree,
               other = model.dofs()[static_cast<size_t>(b)].encoder.counts_per_degree;
  const double distance = rms(m - c);
  return own != 0 && other != 0 ? std::min(distance, rms(own / other * m - c)) : distance;
}

}  // namespace

std::vector<std::vector<Index>> exchanged_joints(const RobotModel& model, const AngleTable& command,
                                                 const AngleTable& measured, double soonest,
                                                 double latest, double begin, double end) {
  std::vector<Index> joints;
  for (Index j = 0; j < command.theta.cols(); ++j)
    if (command.has[static_cast<size_t>(j)] && measured.has[static_cast<size_t>(j)])
      joints.push_back(j);
  const Index dofs = command.theta.cols();
  // distance(a, b): of the angle of a from the command of b, at the time that fits best.
  MatrixXd distance = MatrixXd::Constant(dofs, dofs, HUGE_VAL);
  const int steps = std::max(0, static_cast<int>(std::ceil((latest - soonest) / kAnswerStep)));
  for (int i = 0; i <= steps; ++i) {
    const Rows rows = rows_of(command, measured,
                              soonest + (latest - soonest) * i / std::max(1, steps), begin, end);
    if (rows.command.rows() < 2) continue;
    for (const Index a : joints)
      for (const Index b : joints)
        distance(a, b) = std::min(
            distance(a, b), a == b ? own_distance(rows, a) : other_distance(model, rows, a, b));
  }
  const auto follows = [&](Index a, Index b) {
    return a != b && distance(a, a) > least_motion() * kFarBetter &&
           distance(a, b) < kFarBetter * distance(a, a);
  };
  std::vector<std::vector<Index>> groups;
  std::vector<char> named(static_cast<size_t>(dofs), 0);
  const auto add = [&](std::vector<Index> group) {
    for (const Index j : group) named[static_cast<size_t>(j)] = 1;
    groups.push_back(std::move(group));
  };
  for (const Index a : joints)
    for (const Index b : joints)
      if (a < b && !named[static_cast<size_t>(a)] && !named[static_cast<size_t>(b)] &&
          follows(a, b) && follows(b, a))
        add({a, b});
  // More than two joints: go from each joint to the one that it follows best, until the first one
  // is reached again.
  for (const Index a : joints) {
    std::vector<Index> group;
    for (Index now = a; !named[static_cast<size_t>(now)] && group.size() < joints.size();) {
      group.push_back(now);
      const Index next = *std::min_element(joints.begin(), joints.end(), [&](Index x, Index y) {
        return distance(now, x) < distance(now, y);
      });
      if (!follows(now, next)) break;
      if (next == a && group.size() > 2) {
        add(group);
        break;
      }
      now = next;
    }
  }
  return groups;
}

std::string exchange_words(const RobotModel& model, const std::vector<Index>& group) {
  std::vector<std::string> names;
  for (const Index j : group) names.push_back(model.dofs()[static_cast<size_t>(j)].name);
  if (names.size() == 2)
    return names[0] + " and " + names[1] +
           " seem to be exchanged: the measured angle of each of these joints follows the command "
           "of the other joint";
  return text::join(names, ", ") +
         " seem to be exchanged: the measured angle of each joint follows the command of the next "
         "joint in this list, and the measured angle of the last joint follows the command of the "
         "first joint";
}

}  // namespace ayumi
