// The unknown is the generalised velocity V = [v_WB; w_WB; dtheta] of a posture. The rows are the
// planned twists of both soles (12), the planned COG velocity (3) and zero angular momentum about
// the COG (3); the joints outside the legs have their keyed rates. The rate of the trunk in V is
// integrated over the flight by Heun's rule. With the momentum about the base origin L_B = M_wb V
// and p = m v_G,
//   L_G = L_B - (p_G - p_B) x p.
#include "ayumi/plan/flight.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/linear_solve.hpp"
#include "ayumi/math/quintic.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/motion/pattern_context.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

/// Step of the integration [s]. Chosen: a flight of 0.16 s has 80 steps of Heun's rule. With half
/// of the value, the moment in flight of the case "jump" changes from 0.0353 to 0.00614 N m; with
/// twice, the case "jump" is inconsistent.
constexpr double kStep = 0.002;
/// Half width of central differences in time [s]. Chosen: a quarter of a tick, so that rounding and
/// the curvature of the planned motion are both small. Between half and twice the value, figures
/// change by less than 5 %.
constexpr double kDifference = 2.5e-4;
/// Duration of a trunk swing that no height key bounds [s]. Chosen: about the duration of the push
/// and of the landing of a jump. No measured case changes between half and twice the value
/// (constants.md).
constexpr double kBlend = 0.25;

Vector3d rotation_rate(const Matrix3d& before, const Matrix3d& after, double time) {
  return log_rotation(Eigen::Quaterniond(Matrix3d(after * before.transpose()))) / time;
}

class FlightTurn {
 public:
  FlightTurn(const SampleJob& job, const CogAt& cog) : job_(job), cog_(cog), data_(job.model) {
    sample_.state = job.model.rest_state();
    sample_.state.theta = job.ik.start();
  }

  struct Node {
    double t = 0;
    Vector3d turn = Vector3d::Zero(), rate = Vector3d::Zero(), acceleration = Vector3d::Zero();
  };

  /// Rate of the turn with zero angular momentum at t, if the trunk is turned by `turn`.
  Vector3d rate(double t, const Vector3d& turn) {
    put_plan(job_, t, sample_);
    const Matrix3d trunk =
        exp_rotation(turn).toRotationMatrix() * trunk_attitude(job_, t, sample_.feet);
    const auto cog = cog_(t);
    const Vector3d place(cog[0].value, cog[1].value, cog[2].value);
    sample_.state.base.position += place - sample_.cog;
    sample_.cog = place;
    solve_posture(job_, t, trunk, sample_, data_);
    update_positions(job_.model, sample_.state, data_);
    const Vector3d velocity(cog[0].rate, cog[1].rate, cog[2].rate);
    const Vector3d omega = trunk_rate(t, velocity);
    const auto attitude = [&](double at) { return trunk_attitude(job_, at, job_.feet.poses(at)); };
    const Vector3d planned =
        rotation_rate(attitude(t - kDifference), attitude(t + kDifference), 2 * kDifference);
    const Vector3d relative = omega - exp_rotation(turn) * planned;
    return relative - 0.5 * turn.cross(relative) + turn.cross(turn.cross(relative)) / 12;
  }

  std::vector<Node> integrate(double begin, double end, const Vector3d& turn) {
    const int steps = std::max(4, static_cast<int>(std::ceil((end - begin) / kStep)));
    const double h = (end - begin) / steps;
    std::vector<Node> nodes(1);
    nodes[0] = {begin, turn, rate(begin, turn)};
    for (int k = 1; k <= steps; ++k) {
      const Node& last = nodes.back();
      const double t = begin + h * k;
      const Vector3d ahead = last.turn + h * last.rate;
      const Vector3d next = last.turn + 0.5 * h * (last.rate + rate(t, ahead));
      nodes.push_back({t, next, rate(t, next)});
    }
    accelerate(nodes, h);
    return nodes;
  }

 private:
  // Computes accelerations as differences of the rates. Then the turn is computed again as the
  // integral of the cubic through both, so that the quintics between the nodes have exactly these
  // rates and accelerations.
  static void accelerate(std::vector<Node>& nodes, double h) {
    const size_t last = nodes.size() - 1;
    for (size_t k = 1; k < last; ++k)
      nodes[k].acceleration = (nodes[k + 1].rate - nodes[k - 1].rate) / (2 * h);
    nodes[0].acceleration = (-3 * nodes[0].rate + 4 * nodes[1].rate - nodes[2].rate) / (2 * h);
    nodes[last].acceleration =
        (3 * nodes[last].rate - 4 * nodes[last - 1].rate + nodes[last - 2].rate) / (2 * h);
    for (size_t k = 0; k < last; ++k)
      nodes[k + 1].turn = nodes[k].turn + h / 2 * (nodes[k].rate + nodes[k + 1].rate) +
                          h * h / 12 * (nodes[k].acceleration - nodes[k + 1].acceleration);
  }

  // Rates of the joints that follow hands in the frame of the trunk. Empty if there are none.
  VectorXd rates_of_targets(double t) const {
    if (!job_.links.leads(t - kDifference) || !job_.links.leads(t + kDifference)) return {};
    RobotData data(job_.model);
    const auto angles = [&](double at) {
      RobotState state = sample_.state;
      job_.links.solve(at, keyed_joints(job_, at), state, data);
      return state.theta;
    };
    return (angles(t + kDifference) - angles(t - kDifference)) / (2 * kDifference);
  }

  Vector3d trunk_rate(double t, const Vector3d& velocity) {
    const RobotModel& model = job_.model;
    int others = 0;
    for (int dof = 0; dof < model.dof_count(); ++dof) others += job_.ik.solves(dof) ? 0 : 1;
    const VectorXd led_rates = rates_of_targets(t);
    MatrixXd A = MatrixXd::Zero(18 + others, model.velocity_count());
    VectorXd b = VectorXd::Zero(18 + others);
    int row = 0;
    for (const Side side : {Side::left, Side::right}) {
      const auto before = job_.feet.pose(side, t - kDifference);
      const auto after = job_.feet.pose(side, t + kDifference);
      const Vector3d at = sole_pose(model, data_, side).translation();
      A.middleRows<6>(row) = body_jacobian(model, data_, model.sole(side).body, at);
      b.segment<3>(row) = (after.translation() - before.translation()) / (2 * kDifference);
      b.segment<3>(row + 3) = rotation_rate(before.linear(), after.linear(), 2 * kDifference);
      row += 6;
    }
    MatrixXd M;
    mass_matrix(model, data_, M);
    A.middleRows<3>(row) = M.topRows<3>() / model.mass();
    b.segment<3>(row) = velocity;
    A.middleRows<3>(row + 3) = M.middleRows<3>(3) - skew(data_.cog_offset) * M.topRows<3>();
    row += 6;
    for (int dof = 0; dof < model.dof_count(); ++dof) {
      if (job_.ik.solves(dof)) continue;
      A(row, 6 + dof) = 1;
      b[row++] = led_rates.size() > 0 && job_.links.leads(dof, t)
                     ? led_rates[dof]
                     : job_.tracks.joints[dof].at(t).rate;
    }
    const VectorXd V = solve_least_squares(A, b);
    const int trunk = model.trunk_body();
    return body_jacobian(model, data_, trunk, data_.base_position + data_.position[trunk])
               .bottomRows<3>() *
           V;
  }

  const SampleJob& job_;
  const CogAt& cog_;
  RobotData data_;
  CommandSample sample_;
};

// Time from the last COG height key before t, or to the first one after it.
double segment_at(const Pattern& pattern, double t, bool before) {
  double length = kBlend;
  for (const Keyframe& key : pattern.keyframes) {
    const double distance = before ? t - key.t : key.t - t;
    if (key.cog_height && distance > 1e-6) length = std::min(length, distance);
  }
  return length;
}

// The turn of one flight. It begins level, with the necessary rate. The swings before and after the
// flight begin and end at rest or at another flight.
struct Flight {
  double begin = 0, end = 0, swing_up = 0, swing_down = 0;
  std::vector<FlightTurn::Node> nodes;
};

void add_flight(const Flight& flight, double rest_from, double rest_until,
                std::array<std::vector<QuinticEnd>, 3>& points) {
  for (int i = 0; i < 3; ++i) {
    if (rest_from < flight.begin) points[i].push_back({rest_from, 0, 0, 0});
    for (const FlightTurn::Node& node : flight.nodes)
      points[i].push_back({node.t, node.turn[i], node.rate[i], node.acceleration[i]});
    if (rest_until > flight.end) points[i].push_back({rest_until, 0, 0, 0});
  }
}

}  // namespace

TrunkTurn plan_trunk_turn(const SampleJob& job, const CogAt& cog) {
  TrunkTurn result;
  const auto& phases = job.feet.phases();
  if (job.tracks.torso || !job.tracks.cog[2]) return result;
  FlightTurn solver(job, cog);
  std::vector<Flight> flights;
  for (size_t i = 0; i < phases.size(); ++i) {
    if (phases[i].support != Support::none) continue;
    if (job.links.leads_in_world(job.feet.begin(static_cast<int>(i)), phases[i].until))
      fail(ErrorCode::bad_pattern, place_of_phase(job.pattern, i),
           "in a flight, the hands and the gaze have to follow the trunk. Give \"frame\": "
           "\"trunk\" to their keys before, during and after the flight");
    Flight flight;
    flight.begin = job.feet.begin(static_cast<int>(i));
    flight.end = phases[i].until;
    flight.swing_up = segment_at(job.pattern, flight.begin, true);
    flight.swing_down = segment_at(job.pattern, flight.end, false);
    if (!flights.empty() && flight.begin - flight.swing_up < flights.back().end + 1e-6)
      flight.swing_up /= 2;
    flight.nodes = solver.integrate(flight.begin, flight.end, Vector3d::Zero());
    flights.push_back(std::move(flight));
  }
  if (flights.empty()) return result;
  std::array<std::vector<QuinticEnd>, 3> points;
  for (size_t i = 0; i < flights.size(); ++i) {
    double from = flights[i].begin - flights[i].swing_up;
    double until = flights[i].end + flights[i].swing_down;
    // Joins swings that touch each other.
    if (i > 0 && from < flights[i - 1].end + flights[i - 1].swing_down + 1e-6)
      from = flights[i].begin;
    if (i + 1 < flights.size() && until > flights[i + 1].begin - flights[i + 1].swing_up - 1e-6)
      until = flights[i].end;
    add_flight(flights[i], from, until, points);
  }
  for (int i = 0; i < 3; ++i) result[i] = Track(quintic_keys(points[i]));
  return result;
}

}  // namespace ayumi
