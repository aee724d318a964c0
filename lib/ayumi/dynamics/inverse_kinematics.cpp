// The unknowns are the base position p and the leg joints q_s. With e_s the error twist of sole s,
// A_s its Jacobian for its leg, E = [1; 0] its Jacobian for p, and C_s the COG Jacobian for q_s
// (for p it is 1):
//   E dp + A_s dq_s = e_s,   dp + sum C_s dq_s = e_c
// gives (1 - sum C_s A_s^-1 E) dp = e_c - sum C_s A_s^-1 e_s, then dq_s = A_s^-1 (e_s - E dp).
#include "ayumi/dynamics/inverse_kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/cog_jacobian.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

// Residual at which Newton stops [m, rad]. Chosen: above the rounding of a leg's kinematics, and
// small enough for accelerations, which are differences at 1 kHz.
constexpr double kNewtonTolerance = 1e-13;

// Length of a step after which Newton stops without another computation of the residual [m, rad].
// Derived: a step of s leaves at most (6 s)^2 / 2 times the length of a leg in metres, which is
// below kNewtonTolerance for legs up to 50 m.
constexpr double kLastNewtonStep = 1e-8;

// Residual that is accepted if rounding keeps it above kNewtonTolerance [m, rad]. Chosen: far below
// the tolerances of the check.
constexpr double kAcceptedResidual = 1e-10;

// Largest number of Newton steps. Chosen: a few suffice near a solution; damped steps follow if
// Newton fails.
constexpr int kMostNewtonSteps = 25;

// Largest step of a joint in one iteration [rad]. Chosen: small enough that Newton stays on its
// side of a straight knee.
constexpr double kLargestJointStep = 0.3;

// Weight of the COG against the feet in the damped solve. Chosen: large, so that the feet miss a
// target that is out of reach and the COG does not.
constexpr double kCogWeight = 100;

// Weights of the trunk's attitude against the feet where legs lack joints. The first is for the
// roll of legs without coupled joints, which carries the COG to the side; the second is for
// everything else. Chosen: a roll of 0.1 rad then moves the soles by less than 0.01 mm. Feet that
// miss their places hold pitch and yaw so weakly that a smaller weight lets them wander.
constexpr double kRollWeight = 1e-3, kTrunkWeight = 3e-2;

// Weight of a sole in the middle of its swing, relative to a sole that carries, where legs lack
// joints. Chosen: the sole that carries then takes a hundredth of the distance by which the two
// together miss their places.
constexpr double kSwingingWeight = 0.1;

// Step of a joint at which the search ends although a residual remains [rad]. Chosen: angles are
// then as continuous in time as rates at 1 kHz need.
constexpr double kLastStep = 1e-10;

// Smallest share of an axis that makes it lie across the trunk. Chosen: the axis is within 45
// degrees.
constexpr double kAcross = 0.7;

// Smallest cosine of the angle between the axes of hip, knee and ankle. Chosen: 15 degrees; this
// excludes inclined yaw axes, such as NAO's (45 degrees).
constexpr double kParallel = 0.966;

// Range that a knee needs on its human side [rad]. Chosen: half of kStartBend; a knee with a
// smaller range stays nearly straight, and its robot is built to bend the other way.
constexpr double kStartBend = 0.3, kKneeRoom = 0.15;

// Bend of a knee that a walk with bent legs needs [rad]. Chosen: 50 degrees for standing and 20 for
// the foot that is lifted. With half of the value, Open Duck Mini stands with its hips at their
// limits and cannot lift a foot; with twice, only limits that are placeholders leave so much room.
constexpr double kCrouchBend = 1.2;

// Number of joints of a leg that are computed. With six, every pose of the sole has one solution
// nearby. Definition: a pose has six coordinates.
constexpr size_t kPoseJoints = 6;

// A choice of six joints is accepted if its determinant is at least this share of the largest.
// Chosen: two joints about the same axis give equal determinants, so both choices pass.
constexpr double kFreeShare = 0.5;

// Sine of the knee's angle up to which a leg counts as straight. Chosen: 1 degree.
constexpr double kStraightSine = 0.02;

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// The joints of both legs that move each leg by a separate body; a waist moves both by one body.
std::vector<int> coupled_joints(const RobotModel& model) {
  const auto bodies = [&](Side side) {
    std::vector<int> chain;
    for (int i = model.sole(side).body; i > 0; i = model.bodies()[i].parent) chain.push_back(i);
    return chain;
  };
  const std::vector<int> left = bodies(Side::left), right = bodies(Side::right);
  std::vector<int> coupled;
  for (const int dof : model.leg(Side::left)) {
    if (!contains(model.leg(Side::right), dof) || contains(coupled, dof)) continue;
    if (std::any_of(left.begin(), left.end(), [&](int body) {
          return model.bodies()[body].dof == dof && !contains(right, body);
        }))
      coupled.push_back(dof);
  }
  return coupled;
}

// The rotation of the leg, in the direction in which `dof` turns about the axis `across`, per
// radian of `dof`: the sum for all bodies that the joint moves.
double turn_of(const RobotModel& model, const RobotData& data, Side side, int dof,
               const Vector3d& across) {
  double turn = 0;
  for (int i = model.sole(side).body; i > 0; i = model.bodies()[i].parent) {
    const Body& body = model.bodies()[i];
    if (body.dof == dof) turn += std::copysign(body.ratio, body.ratio * data.axis[i].dot(across));
  }
  return turn;
}

// The largest group of these joints whose axes are parallel, if it has at least three joints;
// otherwise all joints.
std::vector<int> parallel_joints(const RobotModel& model, const RobotData& data,
                                 const std::vector<int>& joints) {
  std::vector<int> largest;
  const auto axis = [&](int dof) { return Vector3d(data.axis[model.dofs()[dof].body]); };
  for (const int first : joints) {
    std::vector<int> group;
    for (const int dof : joints)
      if (std::abs(axis(dof).dot(axis(first))) > kParallel) group.push_back(dof);
    if (group.size() > largest.size()) largest = group;
  }
  return largest.size() < 3 ? joints : largest;
}

// Gauss' elimination with row pivots on [A, B], in place, for a square A: B becomes A^-1 B. Returns
// the determinant of A; if it is 0, B has no meaning.
template <class Rows>
double eliminate(Rows& rows) {
  constexpr int n = Rows::RowsAtCompileTime, all = Rows::ColsAtCompileTime;
  double determinant = 1;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(rows(i, k)) > std::abs(rows(pivot, k))) pivot = i;
    if (pivot != k) {
      rows.row(k).swap(rows.row(pivot));
      determinant = -determinant;
    }
    determinant *= rows(k, k);
    if (determinant == 0) return 0;
    const double inverse = 1 / rows(k, k);
    for (int i = k + 1; i < n; ++i) rows.row(i) -= rows(i, k) * inverse * rows.row(k);
  }
  for (int k = n - 1; k >= 0; --k) {
    auto solved = rows.row(k).template tail<all - n>();
    for (int i = k + 1; i < n; ++i) solved -= rows(k, i) * rows.row(i).template tail<all - n>();
    solved *= 1 / rows(k, k);
  }
  return determinant;
}

// A leg of more than six joints reaches a pose in infinitely many ways, and a solver that starts
// from the previous sample drifts from one to another. So six joints are solved, and the others
// keep the angles of postures and keys. Of all choices of six joints that move the sole freely, the
// one with the joints nearest to the trunk is taken. `J` is the Jacobian of the whole leg.
std::vector<int> six_joints(const std::vector<int>& leg, const MatrixXd& J) {
  std::vector<bool> chosen(leg.size(), false);
  std::fill_n(chosen.begin(), kPoseJoints, true);
  std::vector<std::pair<double, std::vector<int>>> choices;  // in the order of the joints
  do {
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> rows;
    std::vector<int> joints;
    for (size_t i = 0; i < leg.size(); ++i) {
      if (!chosen[i]) continue;
      rows.col(static_cast<Eigen::Index>(joints.size())) = J.col(static_cast<Eigen::Index>(i));
      joints.push_back(leg[i]);
    }
    choices.emplace_back(std::abs(eliminate(rows)), joints);
  } while (std::prev_permutation(chosen.begin(), chosen.end()));
  double most = 0;
  for (const auto& [determinant, joints] : choices) most = std::max(most, determinant);
  return std::find_if(choices.begin(), choices.end(),
                      [&](const auto& each) { return each.first >= kFreeShare * most; })
      ->second;
}

// Solves A x = b for a symmetric A. On entry, the rows of `rows` are [A, b], of which only the part
// on and above the diagonal of A is read; they are destroyed. If a pivot is not positive, A is
// singular up to rounding, and the unknown of this row is set to 0.
void eliminate_symmetric(RowMajorXd& rows, VectorXd& x) {
  const Eigen::Index n = rows.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double* const pivot = rows.data() + k * (n + 1);
    if (!(pivot[k] > 0)) continue;
    const double inverse = 1 / pivot[k];
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double factor = pivot[i] * inverse;
      if (factor == 0) continue;
      double* const row = rows.data() + i * (n + 1);
      for (Eigen::Index j = i; j <= n; ++j) row[j] -= factor * pivot[j];
    }
  }
  x.resize(n);
  for (Eigen::Index k = n - 1; k >= 0; --k) {
    const double* const row = rows.data() + k * (n + 1);
    double right = row[n];
    for (Eigen::Index j = k + 1; j < n; ++j) right -= row[j] * x[j];
    x[k] = row[k] > 0 ? right / row[k] : 0;
  }
}

}  // namespace

InverseKinematics::InverseKinematics(const RobotModel& model, const VectorXd& reference)
    : model_(&model), solved_(model.dof_count(), false), start_(reference) {
  for (const Side side : kSides) {
    auto& leg = legs_[static_cast<int>(side)];
    for (const int dof : model.leg(side))
      if (!contains(model.leg(other(side)), dof)) leg.push_back(dof);
    if (leg.empty())
      fail(ErrorCode::bad_model,
           model.name() + ": no joint moves the " + name_of(side) +
               " sole relative to the other one, so the legs cannot be solved");
  }
  RobotData data(model);
  if (std::max(legs_[0].size(), legs_[1].size()) > kPoseJoints) {
    find_knees(data);
    RobotState home = model.rest_state();
    update_positions(model, home, data);
    for (const Side side : kSides) {  // straight legs cannot move the sole freely
      const int s = static_cast<int>(side);
      if (!(std::abs(knee_bend(data, side)) < kStraightSine)) continue;
      if (knees_[s] >= 0)
        home.theta[knees_[s]] += forward_[s] * kStartBend;
      else  // no joint is known to bend the leg, so all are turned
        for (const int dof : legs_[s]) home.theta[dof] += kStartBend;
    }
    update_positions(model, home, data);
    for (const Side side : kSides)
      if (auto& leg = legs_[static_cast<int>(side)]; leg.size() > kPoseJoints) {
        MatrixXd J = MatrixXd::Zero(6, static_cast<Eigen::Index>(leg.size()));
        add_sole_columns(data, side, sole_chain(side, leg), J);
        leg = six_joints(leg, J);
      }
  }
  for (const auto& leg : legs_)
    for (const int dof : leg) solved_[dof] = true;
  lacking_ = std::min(legs_[0].size(), legs_[1].size()) < 6;
  if (lacking_) {
    coupled_ = coupled_joints(model);
    for (const int dof : coupled_) solved_[dof] = true;
  }
  if (!lacking_)
    for (const Side side : kSides) find_leg_bodies(side);
  damped_joints_ = legs_[0];
  damped_joints_.insert(damped_joints_.end(), legs_[1].begin(), legs_[1].end());
  damped_joints_.insert(damped_joints_.end(), coupled_.begin(), coupled_.end());
  for (const Side side : kSides)
    sole_chains_[static_cast<int>(side)] = sole_chain(side, damped_joints_);
  find_knees(data);
  bend_straight_legs(data);
  bend_ = bend(data);
}

// The bodies between the sole and the root that one of the joints moves.
std::vector<InverseKinematics::LegBody> InverseKinematics::sole_chain(
    Side side, const std::vector<int>& joints) const {
  std::vector<LegBody> chain;
  for (int i = model_->sole(side).body; i > 0; i = model_->bodies()[i].parent) {
    const auto found = std::find(joints.begin(), joints.end(), model_->bodies()[i].dof);
    if (found != joints.end()) chain.push_back({i, static_cast<int>(found - joints.begin()), true});
  }
  return chain;
}

void InverseKinematics::find_leg_bodies(Side side) {
  const std::vector<Body>& bodies = model_->bodies();
  const std::vector<int>& leg = legs_[static_cast<int>(side)];
  std::vector<int> column(bodies.size(), -1);
  std::vector<bool> moved(bodies.size(), false), carries(bodies.size(), false);
  for (int i = model_->sole(side).body; i > 0; i = bodies[i].parent) carries[i] = true;
  for (size_t i = 1; i < bodies.size(); ++i) {
    const auto found = std::find(leg.begin(), leg.end(), bodies[i].dof);
    if (found != leg.end()) column[i] = static_cast<int>(found - leg.begin());
    moved[i] = column[i] >= 0 || moved[bodies[i].parent];
  }
  for (size_t i = bodies.size() - 1; i > 0; --i)
    if (moved[i])
      leg_bodies_[static_cast<int>(side)].push_back(
          {static_cast<int>(i), column[i], static_cast<bool>(carries[i])});
  // A column of A is at most c = ratio sqrt(1 + r^2) long, where r is the distance from its joint
  // to the sole, and changes by at most c per radian of each joint. So the determinant changes by
  // at most 6 * 6 c^6 per radian of all joints, by Hadamard's inequality. The last 3 % are for the
  // squares of the step.
  double reach = model_->sole(side).frame.translation().norm(), ratio = 1;
  for (int i = model_->sole(side).body; i > 0; i = bodies[i].parent) {
    if (!moved[i]) continue;
    reach += bodies[i].placement.translation().norm();
    ratio = std::max(ratio, std::abs(bodies[i].ratio));
    if (bodies[i].prismatic) ratio = INFINITY;
  }
  largest_bend_rate_ =
      std::max(largest_bend_rate_, 37 * elementary::power<3>(ratio * ratio * (1 + reach * reach)));
}

// The knee is the middle one of the first three joints of a leg whose axes are parallel and lie
// across the trunk.
void InverseKinematics::find_knees(RobotData& data) {
  RobotState state = model_->rest_state();
  state.theta = start_;
  update_positions(*model_, state, data);
  const Vector3d across = data.rotation[model_->trunk_body()].col(1);
  for (int s = 0; s < 2; ++s) {
    std::vector<int> found;
    knees_[s] = -1;
    for (const int dof : legs_[s]) {
      const int body = model_->dofs()[dof].body;
      if (!model_->dofs()[dof].prismatic && std::abs(data.axis[body].dot(across)) > kAcross)
        found.push_back(dof);
    }
    found = parallel_joints(*model_, data, found);
    if (found.size() < 3) continue;
    knees_[s] = found[1];
    knee_hips_[s] = model_->dofs()[found[0]].body;
    knee_feet_[s] = model_->dofs()[found[2]].body;
    const Body& shank = model_->bodies()[model_->dofs()[found[1]].body];
    // If a shank turns about the axis that points to the left, its lower end goes back and the knee
    // comes forward.
    forward_[s] =
        std::copysign(1.0, shank.ratio * data.axis[model_->dofs()[found[1]].body].dot(across));
  }
}

// Sine of the angle between thigh and shank, positive if the knee is in front of the line from hip
// to ankle. It is 0 for a leg without a knee.
double InverseKinematics::knee_bend(const RobotData& data, Side side) const {
  const int s = static_cast<int>(side);
  if (knees_[s] < 0) return 0;
  const int knee = model_->dofs()[knees_[s]].body;
  const Vector3d thigh = data.position[knee] - data.position[knee_hips_[s]];
  const Vector3d shank = data.position[knee_feet_[s]] - data.position[knee];
  const double size = thigh.norm() * shank.norm();
  const Vector3d left = forward_[s] * model_->bodies()[knee].ratio * data.axis[knee];
  return size > 0 ? thigh.cross(shank).dot(left) / size : 0;
}

void InverseKinematics::bend_straight_legs(RobotData& data) {
  RobotState state = model_->rest_state();
  state.theta = start_;
  update_positions(*model_, state, data);
  for (const Side side : kSides) {
    const int s = static_cast<int>(side);
    const int knee = knees_[s] >= 0 ? knees_[s] : lacking_ ? -1 : legs_[s][3];
    if (knee < 0) continue;
    const Dof& dof = model_->dofs()[knee];
    const double length =
        (sole_pose(*model_, data, side).translation() - data.pose(dof.body).translation()).norm();
    const bool straight = !lacking_ ? std::abs(bend(data)[s]) < 1e-2 * length * length * length
                                    : std::abs(knee_bend(data, side)) < kStraightSine;
    if (!straight) continue;
    double way = knees_[s] >= 0 ? forward_[s] : 1.0;
    const Vector3d across = data.rotation[model_->trunk_body()].col(1);
    const auto room_of = [&](int joint, double w) {
      const Dof& moved = model_->dofs()[joint];
      return w > 0 ? moved.upper - start_[joint] : start_[joint] - moved.lower;
    };
    // The hip and the ankle each turn back by half the bend of the knee. A knee of coupled joints
    // bends by the sum of their angles.
    const double bend_ratio =
        knees_[s] >= 0 ? std::abs(turn_of(*model_, data, side, knee, across)) : 1;
    const auto room = [&](double w) {
      double least = bend_ratio * room_of(knee, w);
      if (knees_[s] < 0) return least;
      const double turn = forward_[s] * w;  // rotation of the shank about the axis to the left
      for (const int body : {knee_hips_[s], knee_feet_[s]}) {
        const int joint = model_->bodies()[body].dof;
        const double own = turn_of(*model_, data, side, joint, across);
        least = std::min(least, 2 * std::abs(own) * room_of(joint, own > 0 ? -turn : turn));
      }
      return least;
    };
    if (room_of(knee, way) < kKneeRoom ? room_of(knee, -way) > room_of(knee, way)
                                       : room(way) < kCrouchBend && room(-way) >= kCrouchBend)
      way = -way;
    start_[knee] += way * kStartBend;
    if (knees_[s] < 0) continue;
    // The sole stays level, so that Newton starts near a solution with this bend.
    const double turn = forward_[s] * way * kStartBend * bend_ratio / 2;
    for (const int body : {knee_hips_[s], knee_feet_[s]}) {
      const int joint = model_->bodies()[body].dof;
      const Dof& moved = model_->dofs()[joint];
      double& angle = start_[joint];
      angle = std::clamp(angle - turn / turn_of(*model_, data, side, joint, across), moved.lower,
                         moved.upper);
    }
  }
  state.theta = start_;
  update_positions(*model_, state, data);
}

double InverseKinematics::Residual::largest() const {
  return std::max(
      {foot[0].cwiseAbs().maxCoeff(), foot[1].cwiseAbs().maxCoeff(), cog.cwiseAbs().maxCoeff()});
}

InverseKinematics::Residual InverseKinematics::residual(const PostureTarget& target,
                                                        const RobotState& state,
                                                        RobotData& data) const {
  update_positions(*model_, state, data);
  return residual(target, data);
}

InverseKinematics::Residual InverseKinematics::residual(const PostureTarget& target,
                                                        const RobotData& data) const {
  Residual e;
  for (const Side side : kSides) {
    const int s = static_cast<int>(side);
    const Eigen::Isometry3d sole = sole_pose(*model_, data, side);
    e.foot[s].head<3>() = target.feet[s].translation() - sole.translation();
    e.foot[s].tail<3>() =
        log_rotation(Eigen::Quaterniond(target.feet[s].linear() * sole.linear().transpose()));
  }
  e.cog = target.cog - data.cog;
  if (lacking_)
    e.trunk = log_rotation(
        Eigen::Quaterniond(target.trunk * data.rotation[model_->trunk_body()].transpose()));
  return e;
}

// Adds the columns of the joints of `chain` to the Jacobian of the sole's twist.
template <class Jacobian>
void InverseKinematics::add_sole_columns(const RobotData& data, Side side,
                                         const std::vector<LegBody>& chain, Jacobian&& J) const {
  const Sole& sole = model_->sole(side);
  const Vector3d p = data.position[sole.body] + data.rotation[sole.body] * sole.frame.translation();
  for (const LegBody& moved : chain) {
    if (!moved.carries || moved.column < 0) continue;
    const Body& body = model_->bodies()[moved.body];
    const Vector3d a = body.ratio * data.axis[moved.body];
    if (body.prismatic) {
      J.col(moved.column).template head<3>() += a;
    } else {
      J.col(moved.column).template head<3>() += a.cross(p - data.position[moved.body]);
      J.col(moved.column).template tail<3>() += a;
    }
  }
}

// The Jacobian for a leg of six joints, written into the first columns of `rows`.
void InverseKinematics::square_jacobian(const RobotData& data, Side side, SixRows& rows) const {
  auto J = rows.leftCols<6>();
  J.setZero();
  add_sole_columns(data, side, leg_bodies_[static_cast<int>(side)], J);
}

// The COG Jacobian of the six joints of a leg with the base at rest: (6)(7) for the links that the
// leg moves.
Eigen::Matrix<double, 3, 6> InverseKinematics::leg_cog_jacobian(RobotData& data, Side side) const {
  const std::vector<LegBody>& leg = leg_bodies_[static_cast<int>(side)];
  for (const LegBody& moved : leg)
    data.composite[moved.body].moment =
        model_->bodies()[moved.body].inertia.mass * data.com[moved.body];
  const double per_mass = 1 / model_->mass();
  Eigen::Matrix<double, 3, 6> J = Eigen::Matrix<double, 3, 6>::Zero();
  for (const LegBody& moved : leg) {
    const Body& body = model_->bodies()[moved.body];
    const double mass = data.subtree_mass[moved.body];
    const Vector3d& moment = data.composite[moved.body].moment;
    data.composite[body.parent].moment += moment;
    if (moved.column < 0) continue;
    const Vector3d a = body.ratio * per_mass * data.axis[moved.body];
    if (body.prismatic)
      J.col(moved.column) += mass * a;
    else
      J.col(moved.column) += a.cross(moment - mass * data.position[moved.body]);
  }
  return J;
}

std::array<double, 2> InverseKinematics::bend(const RobotData& data) const {
  if (lacking_) return {knee_bend(data, Side::left), knee_bend(data, Side::right)};
  std::array<double, 2> determinant;
  for (const Side side : kSides) {
    SixRows rows = SixRows::Zero();
    square_jacobian(data, side, rows);
    determinant[static_cast<int>(side)] = eliminate(rows);
  }
  return determinant;
}

void InverseKinematics::set_attitude(const PostureTarget& target, RobotState& state,
                                     RobotData& data) const {
  const int trunk = model_->trunk_body();
  if (trunk == 0) {
    state.base.attitude = Eigen::Quaterniond(target.trunk).normalized();
    return;
  }
  update_positions(*model_, state, data);
  const Eigen::Matrix3d trunk_in_root = data.rotation[0].transpose() * data.rotation[trunk];
  state.base.attitude = Eigen::Quaterniond(target.trunk * trunk_in_root.transpose()).normalized();
}

// Fills the error of the solution and the bend of its legs. Returns whether the target is reached.
bool InverseKinematics::newton(const PostureTarget& target, RobotState& state, RobotData& data,
                               double& error, std::array<double, 2>& legs_bend) const {
  double before = INFINITY, longest = INFINITY;
  for (int iteration = 0;; ++iteration) {
    if (longest <= kLastNewtonStep) {
      error = 0;
      break;
    }
    const Residual e = residual(target, state, data);
    error = e.largest();
    // Even a guess within the tolerance takes one step. Otherwise the errors of guesses that are
    // extrapolated from guesses would grow from sample to sample.
    if (iteration > 0 && error <= kNewtonTolerance) break;
    if (iteration > 3 && error > 0.5 * before) {
      if (error <= kAcceptedResidual) break;
      return false;
    }
    if (iteration == kMostNewtonSteps) return false;
    before = iteration > 1 ? error : INFINITY;
    SixRows solved[2];  // A^-1 [E, e] of each leg
    Eigen::Matrix3d S = Eigen::Matrix3d::Identity();
    Vector3d right = e.cog;
    for (int s = 0; s < 2; ++s) {
      square_jacobian(data, kSides[s], solved[s]);
      solved[s].middleCols<3>(6) << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
      solved[s].col(9) = e.foot[s];
      legs_bend[s] = eliminate(solved[s]);
      if (legs_bend[s] == 0) return false;
      const Eigen::Matrix<double, 3, 6> C = leg_cog_jacobian(data, kSides[s]);
      S.noalias() -= C.lazyProduct(solved[s].middleCols<3>(6));
      right.noalias() -= C.lazyProduct(solved[s].col(9));
    }
    const Vector3d dp = S.inverse() * right;
    Eigen::Matrix<double, 6, 1> dq[2];
    longest = 0;
    for (int s = 0; s < 2; ++s) {
      dq[s] = solved[s].col(9) - solved[s].middleCols<3>(6).lazyProduct(dp);
      longest = std::max(longest, dq[s].cwiseAbs().maxCoeff());
    }
    if (!std::isfinite(longest) || !dp.allFinite()) return false;
    const double scale = std::min(1.0, kLargestJointStep / std::max(longest, 1e-300));
    state.base.position += scale * dp;
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < 6; ++i) state.theta[legs_[s][i]] += scale * dq[s][i];
  }
  // The determinants of the posture before the last step are used if this step cannot have changed
  // their signs.
  const double change = largest_bend_rate_ * longest;
  if (!(std::min(std::abs(legs_bend[0]), std::abs(legs_bend[1])) > change)) {
    update_positions(*model_, state, data);
    legs_bend = bend(data);
  }
  return true;
}

// Levenberg-Marquardt on all residuals, with a weight on the COG, inside the position limits: a
// joint at its limit stays there while the step would take it beyond. Where legs lack joints, the
// attitude of the base is solved too, with a small weight on the trunk's attitude, and a sole that
// swings has a smaller weight than one that carries.
void InverseKinematics::damped(const PostureTarget& target, RobotState& state,
                               RobotData& data) const {
  const std::vector<int>& joints = damped_joints_;
  const auto n = static_cast<Eigen::Index>(joints.size());
  const Eigen::Index base = lacking_ ? 6 : 3, rows = lacking_ ? 18 : 15;
  const double roll = coupled_.empty() ? kRollWeight : kTrunkWeight;
  const Eigen::Matrix3d trunk =
      Vector3d(roll, kTrunkWeight, kTrunkWeight).asDiagonal() * target.trunk.transpose();
  const auto limit = [&](VectorXd& theta) {
    for (const int dof : joints)
      theta[dof] = std::clamp(theta[dof], model_->dofs()[dof].lower, model_->dofs()[dof].upper);
  };
  limit(state.theta);
  const auto weight = [&](int s) {
    return lacking_ ? kSwingingWeight + (1 - kSwingingWeight) * target.hold[s] : 1.0;
  };
  const std::array<double, 2> firm = {weight(0), weight(1)};
  VectorXd r(rows), after(rows);
  const auto stack = [&](const Residual& e, VectorXd& all) {
    all.head<15>() << firm[0] * e.foot[0], firm[1] * e.foot[1], kCogWeight * e.cog;
    if (lacking_) all.tail<3>() = trunk * e.trunk;
  };
  Residual e = residual(target, state, data);
  // A trunk far from its target attitude is no good initial guess: it gets this attitude.
  if (lacking_ && e.trunk.norm() > kLargestJointStep) {
    set_attitude(target, state, data);
    e = residual(target, state, data);
  }
  stack(e, r);
  double lambda = 1e-6, before = 0;  // the longest step of a joint in the iteration before
  const Eigen::Index unknowns = base + n;
  RowMajorXd J(rows, unknowns + 1);      // the last column is the residual
  RowMajorXd H(unknowns, unknowns + 1);  // the normal equations, with their right side
  MatrixXd C;
  VectorXd d;
  RobotState trial = state;
  for (int iteration = 0; iteration < 200 && r.cwiseAbs().maxCoeff() > kNewtonTolerance;
       ++iteration) {
    J.setZero();
    J.col(unknowns) = r;
    for (int s = 0; s < 2; ++s) {
      auto of_foot = J.block(6 * s, base, 6, n);
      add_sole_columns(data, kSides[s], sole_chains_[s], of_foot);
      if (firm[s] != 1) of_foot *= firm[s];
      J.block<3, 3>(6 * s, 0) = firm[s] * Eigen::Matrix3d::Identity();
    }
    J.block<3, 3>(12, 0) = kCogWeight * Eigen::Matrix3d::Identity();
    held_base_cog_jacobian(*model_, data, C);
    for (Eigen::Index i = 0; i < n; ++i)
      J.block<3, 1>(12, base + i) = kCogWeight * C.col(joints[i]);
    if (lacking_) {
      for (int s = 0; s < 2; ++s) {
        const Vector3d sole = sole_pose(*model_, data, kSides[s]).translation();
        J.block<3, 3>(6 * s, 3) = -firm[s] * skew(sole - data.base_position);
        J.block<3, 3>(6 * s + 3, 3) = firm[s] * Eigen::Matrix3d::Identity();
      }
      J.block<3, 3>(12, 3) = -kCogWeight * skew(data.cog - data.base_position);
      // Here d log(A exp(-d)) = -(1 + [e]/2 + [e]^2/12 + ...) d at e = log A.
      const Eigen::Matrix3d turn = skew(e.trunk);
      J.block<3, 3>(15, 3) = trunk * (Eigen::Matrix3d::Identity() + turn / 2 + turn * turn / 12);
    }
    // The part of J' [J, r] on and above the diagonal. The rows of a foot are 0 in the columns of
    // the other leg.
    H.setZero();
    for (Eigen::Index k = 0; k < rows; ++k) {
      const double* const row = J.data() + k * (unknowns + 1);
      for (Eigen::Index i = 0; i < unknowns; ++i) {
        const double factor = row[i];
        if (factor == 0) continue;
        double* const sum = H.data() + i * (unknowns + 1);
        for (Eigen::Index j = i; j <= unknowns; ++j) sum[j] += factor * row[j];
      }
    }
    // A joint at its limit stays there.
    for (Eigen::Index i = base; i < unknowns; ++i) {
      const int joint = joints[i - base];
      const Dof& dof = model_->dofs()[joint];
      const double theta = state.theta[joint], down = H(i, unknowns);
      if ((theta >= dof.upper && down > 0) || (theta <= dof.lower && down < 0)) {
        H.col(i).setZero();
        H.row(i).setZero();
      }
    }
    H.diagonal().array() += lambda * (lacking_ ? kRollWeight * kRollWeight : 1.0);
    eliminate_symmetric(H, d);
    const double longest = d.tail(base + n - 3).cwiseAbs().maxCoeff();
    if (longest > kLargestJointStep) d *= kLargestJointStep / longest;
    trial = state;
    trial.base.position += d.head<3>();
    if (lacking_)
      trial.base.attitude =
          Eigen::Quaterniond(exp_rotation(d.segment<3>(3)) * state.base.attitude.toRotationMatrix())
              .normalized();
    for (Eigen::Index i = 0; i < n; ++i) trial.theta[joints[i]] += d[base + i];
    limit(trial.theta);
    const Residual next = residual(target, trial, data);
    stack(next, after);
    const double gain = r.squaredNorm() - after.squaredNorm();
    // If soles cannot reach their places, a residual remains and the steps vanish. Each step is
    // shorter than the one before by about the same factor, so the length of the next one is
    // predicted.
    const bool ends = lacking_ && std::min(longest, longest / before * longest) < kLastStep;
    before = gain > 0 ? longest : 0;  // only a step that helped predicts the next one
    if (gain > 0) {
      state = trial;
      e = next;
      lambda = std::max(1e-14, 0.2 * lambda);
      const bool settled = gain < 1e-14 * r.squaredNorm();
      r = after;
      if (ends || settled) break;
    } else if (ends) {
      residual(target, state, data);
      break;
    } else {
      lambda *= 8;
      residual(target, state, data);
      if (lambda > 1e6) break;
    }
  }
}

PostureSolution InverseKinematics::solve(const PostureTarget& target, RobotState& state,
                                         RobotData& data) const {
  PostureSolution solution;
  const auto tolerance = [&](double hold) {
    return lacking_ ? lacking_tolerance(hold) : kAcceptedResidual;
  };
  if (!lacking_) set_attitude(target, state, data);
  std::array<double, 2> now;
  if (!lacking_) solution.reached = newton(target, state, data, solution.error, now);
  if (target.nearest && solution.reached)
    for (int s = 0; s < 2; ++s) solution.reached = solution.reached && now[s] * bend_[s] > 0;
  if (!solution.reached) {
    if (!lacking_) {
      for (int dof = 0; dof < model_->dof_count(); ++dof)
        if (solved_[dof]) state.theta[dof] = start_[dof];
      state.base.position = target.cog - (data.cog - data.base_position);
    }
    damped(target, state, data);
    const Residual e = residual(target, data);
    solution.error = e.largest();
    solution.lean = e.trunk.norm();
    solution.reached = e.cog.cwiseAbs().maxCoeff() <= tolerance(1);
    // For each sole: its error in units of the allowed error, and its turn [rad]. The allowed error
    // is the same number of metres and of radians.
    std::array<double, 2> share, turned;
    for (int s = 0; s < 2; ++s) {
      const double allowed = tolerance(target.hold[s]);
      solution.reached = solution.reached && e.foot[s].cwiseAbs().maxCoeff() <= allowed;
      solution.miss[s] = e.foot[s].head<3>().norm();
      share[s] = solution.miss[s] / allowed;
      turned[s] = e.foot[s].tail<3>().norm();
    }
    // In this case the soles are at their places, so their turns are compared.
    if (!solution.reached && std::max(share[0], share[1]) <= 1)
      for (int s = 0; s < 2; ++s) share[s] = turned[s] / tolerance(target.hold[s]);
    solution.foot = share[0] >= share[1] ? Side::left : Side::right;
    const auto foot = static_cast<size_t>(solution.foot);
    solution.missing = solution.miss[foot];
    if (!solution.reached) solution.turned = turned[foot];
    for (const int dof : legs_[foot]) {
      const Dof& joint = model_->dofs()[dof];
      if (state.theta[dof] <= joint.lower || state.theta[dof] >= joint.upper)
        solution.at_limit = dof;
    }
    now = bend(data);
  }
  if (solution.reached)
    for (int s = 0; s < 2; ++s)
      if (now[s] * bend_[s] < 0 || (!lacking_ && now[s] * bend_[s] == 0)) {
        solution.knee_flipped = true;
        solution.foot = kSides[s];
      }
  return solution;
}

}  // namespace ayumi
