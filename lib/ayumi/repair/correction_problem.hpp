#pragma once
// The least correction of a motion as a nonlinear program. Unknowns: the free control points of a
// uniform cubic B-spline over base position, base rotation vector and joints (CorrectionTrack);
// the first and last three stay zero, so the motion starts and ends as it did, or move as one where
// the posture there is itself at fault. Objective:
//   1/2 sum_columns w integral (d^2 + tau^4 d''^2) dt,
// quadratic, by the Gram matrices of the splines. Constraints: correction_constraints.hpp at chosen
// samples. Hessian: that of the objective, and on the ground the curvature of the constraints
// (curvature.hpp).

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/limits/limit.hpp"
#include "ayumi/math/windows.hpp"
#include "ayumi/repair/correction_constraints.hpp"
#include "ayumi/repair/curvature.hpp"
#include "ayumi/repair/nlp/nlp.hpp"
#include "ayumi/repair/repair.hpp"

namespace ayumi {

inline constexpr double kObjectiveScale = 100.0;  ///< of 1/2 of the weighted change

/// One kind of row between the instants where all are placed.
struct PressedLimit {
  int sample = 0;
  ConstraintGroup group = ConstraintGroup::friction;
  int item = 0;  ///< as of its block
};

/// What may move and what must hold.
struct CorrectionSpec {
  double spacing = 0.05;                                  ///< of the knots [s]
  int instants_per_knot = 2;                              ///< of the constraints
  std::vector<std::pair<double, double>> windows;         ///< where control points are free [s]
  std::array<bool, 2> free_ends = {};                     ///< the first, the last posture may move
  std::vector<bool> locked;                               ///< by dof; empty: none
  std::vector<std::pair<double, double>> locked_windows;  ///< where nothing may move [s]
  std::vector<double> kept_instants;                      ///< at which no pose may change [s]
  std::array<bool, 2> locked_feet = {};                   ///< by Side: keep their way
  Eigen::VectorXd weights;  ///< factors on those of the joints [dof]; empty: 1
  Trust trust = Trust::posture;
  const CollisionModel* collisions = nullptr;  ///< null: clearances are not watched
  std::vector<int> near_pairs;                 ///< of bodies that are watched
  std::string profile;
  Tolerances tolerance = tolerances({});  ///< of the check
  double friction = 0.8;
  double zmp_margin = 0.002;   ///< least distance of the ZMP inside the support [m]
  double safe_margin = 0;      ///< the same where the motion's own is less than the least [m]
  double joint_margin = 1e-4;  ///< inside the position limits [rad]
  double share = 0.998;        ///< of speed limits and friction that may be used
  double xi_spare = 3e-4;      ///< that xi is wanted off the planned one at most [m]
  double zmp_spare = 1e-3;     ///< likewise the ZMP, where xi is [m]
  std::vector<TimeWindow> wrong_plan;  ///< where planned COG or ZMP are themselves at fault [s]
  bool gentle_swings = true;    ///< a low sole is wanted level and over its place, others not low
  double force_share = 0.1;     ///< least normal force in contact over the weight
  double sole_position = 2e-4;  ///< band a supporting sole stays in [m]
  double sole_angle = 2e-3;     ///< [rad]
  double sole_at_knots = 0.1;   ///< share of that band at the knots
  double clearance = 2.4e-3;    ///< between bodies that the motion does not bring nearer [m]
  /// A limit is constrained where the motion, or one of `seen`, uses more than this share of it;
  /// the rest is looked at by the check of the result.
  double watched_share = 0.7;
  /// Every limit is where the check has it.
  bool at_limits = false;
  std::vector<double> extra;               ///< more instants, where an earlier result failed [s]
  std::vector<PressedLimit> pressed;       ///< rows of their own, where no instant is
  std::vector<const CommandSeries*> seen;  ///< earlier results, the last one last
  Eigen::MatrixXd start;                   ///< control points of a start; empty: zero
};

class CorrectionProblem {
 public:
  CorrectionProblem(const RobotModel& model, const CommandSeries& series,
                    const CorrectionSpec& spec);

  int variable_count() const { return variable_count_; }
  int constraint_count() const { return static_cast<int>(lower_.size()); }
  const std::vector<ConstraintBlock>& blocks() const { return blocks_; }
  const std::vector<CollocationPoint>& instants() const { return instants_; }
  const Eigen::VectorXd& lower() const { return lower_; }  ///< of the constraints
  const Eigen::VectorXd& upper() const { return upper_; }
  /// What the ZMP is wanted further inside than it has to be at least, by instant [m].
  double safety(int instant) const { return margin_[instant] - spec_.zmp_margin; }

  Eigen::VectorXd constraints(const Eigen::VectorXd& x) const;
  /// Beside the instants whose limits are pressed against: what one row tells, not feet, the ZMP
  /// or clearances.
  std::vector<PressedLimit> beside_pressed(const Eigen::VectorXd& x) const;
  /// Of another motion over the same plan, sampled alike.
  Eigen::VectorXd constraints_of(const CommandSeries& motion) const;

  /// The program; it refers to this object, which must outlive it.
  Nlp nlp() const;

  /// The correction a point of the program stands for, and the point for control points.
  CorrectionTrack track(const Eigen::VectorXd& x) const;
  Eigen::VectorXd point(const Eigen::MatrixXd& coefficients) const;

 private:
  Eigen::VectorXd constraints(const CommandSeries& motion, const Eigen::MatrixXd& c) const;
  void place_variables();
  void place_end(int first, double time);
  void place_instants();
  void add_instant(int sample, bool at_knot);
  bool wanted(const ConstraintBlock& block) const;
  void place_constraints();
  void place_margins();
  void place_ground_blocks(int instant);
  void place_friction(int instant);
  void place_flight_block(int instant);
  Vector6d own_wrench(int sample) const;
  void place_kept_pose(int instant);
  void place_foot_blocks(int instant);
  void soften_landing(int instant, Side side);
  double own_landing_factor() const;
  double landing_factor(Side side, const ContactInterval& swing, const Eigen::Isometry3d& place,
                        bool lands) const;
  double own_foot_clearance() const;
  void measure_swings();
  void place_landing(int instant, Side side);
  void place_swing(int instant, Side side);
  double sole_angle(Side side) const;
  void place_joint_blocks(int instant);
  void place_torque_blocks(int instant);
  void place_clearance_blocks(int instant);
  void place_clearance_block(int instant, const ShapePair& shapes, double own);
  void place_command_blocks(int instant);
  void measure_capture();
  void place_capture_block(int instant);
  Eigen::Matrix<double, 2, 6> planned_zmp_rows(int instant) const;
  double tolerance(FindingKind kind) const { return spec_.tolerance[kind]; }
  std::vector<const CommandSample*> watched(int instant) const;
  void place_jacobian();
  void place_objective();
  void add_block(ConstraintBlock block, double lower, double upper);
  bool free_at(const SplineWeights& weights) const;
  bool inside_a_window(double begin, double end) const;
  bool locked_within(double begin, double end) const;
  void jacobian_values(const Eigen::VectorXd& x, Eigen::VectorXd& values) const;
  void place_curvature();
  void add_curvature(const Eigen::VectorXd& x, const Eigen::VectorXd& multipliers,
                     Eigen::VectorXd& values) const;
  void add_pairs(const std::vector<Eigen::MatrixXd>& pairs, Eigen::VectorXd& values) const;

  const RobotModel& model_;
  const CommandSeries& series_;
  CorrectionSpec spec_;
  ContactPlan plan_;
  CorrectionTrack zero_;   ///< the track with zero coefficients
  Eigen::MatrixXi index_;  ///< variable of control point and column, or -1
  int variable_count_ = 0;
  std::map<int, std::set<std::pair<ConstraintGroup, int>>> only_;  ///< of samples with few rows
  std::vector<CollocationPoint> instants_;
  double landing_factor_ = 0;              ///< of landing rows [1/m]
  double foot_clearance_ = 0;              ///< wanted in the middle half of a swing [m]
  std::vector<bool> keeps_xi_;             ///< xi is wanted near the planned one, by instant
  std::vector<double> margin_;             ///< wanted of the ZMP, by instant [m]
  std::vector<ConstraintBlock> blocks_;    ///< in order of their instants
  std::vector<std::vector<int>> columns_;  ///< by block
  Eigen::VectorXd lower_, upper_;
  SparsePattern jacobian_, hessian_;
  Eigen::VectorXd hessian_values_;
  int objective_nonzeros_ = 0;  ///< come first
  std::vector<int> curved_;     ///< columns with curvature
  std::vector<int> pairs_;      ///< first nonzero of four for every control point
};

}  // namespace ayumi
