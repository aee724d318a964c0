#pragma once
// Ayumi's own plant: the floating robot with position servos on ground it can stick to and slip on.
// State in, joint targets and disturbances in, next state and contact forces out.

#include <Eigen/Dense>
#include <optional>
#include <vector>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/tree_cholesky.hpp"
#include "ayumi/sim/ground.hpp"
#include "ayumi/sim/plant/contact_points.hpp"
#include "ayumi/sim/plant/contact_solver.hpp"
#include "ayumi/sim/plant/link_contacts.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

class Plant {
 public:
  /// The model must outlive the plant. Throws Error(bad_model) when a joint has no servo,
  /// Error(bad_pattern) for a world that is not made of numbers.
  Plant(const RobotModel& model, const ActuatorLimits& limits, const World& world);

  const RobotState& state() const { return state_; }
  const RobotData& data() const { return data_; }  ///< positions and velocities of state()
  /// Puts the robot there and forgets contacts. Throws Error(usage) naming what is not a number.
  void set_state(const RobotState& state);

  /// Advances by `dt` [s] with the servo targets held. Throws Error(usage) with place and time for
  /// input that is not finite or beyond 1e6; the plant is then as before. The report holds until
  /// the next step.
  const StepReport& step(const Eigen::VectorXd& targets, const StepInput& input, double dt);

 private:
  /// A point that touches, or may within the step.
  struct Active {
    long key = 0;    ///< index of the ContactPoint; beyond them where edges or links meet
    int body = 0;    ///< that is pushed along the normal
    int other = -1;  ///< the body it touches; -1: the ground
    int side = -1, vertex = -1;  ///< of a sole, else -1; vertex -1: between its corners
    double stiffness = 0, damping_time = 0;
    size_t run = 0;  ///< its body's; where links touch, the other body's is the next
    double gap = 0;
    Eigen::Vector3d position;         ///< world [m]
    Eigen::Matrix3d to_contact;       ///< rows: normal, tangents
    Eigen::Vector3d ground_velocity;  ///< world [m/s]
    double friction = 0;
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero();     ///< of the last step: warm start
    Eigen::Vector2d deflection = Eigen::Vector2d::Zero();  ///< of the tangential spring [m]
  };

  /// Consecutive contacts of one body, or of one pair: then there are two, of either body. Rows of
  /// their Jacobian stand side by side, three per contact and filled up to a multiple of four, one
  /// line for each place on the path to the body.
  struct Run {
    int body = 0, last = 0;  ///< and the last place that moves it
    double sign = 1;         ///< -1 of the body that is pushed back
    size_t first = 0, count = 0;
    int width = 0;
    size_t begin = 0;  ///< in J_ and Y_
  };

  /// What the contacts that press leave the whole robot free to do with its joints locked: turn
  /// about a point (freedom 3), about a line (1), or nothing.
  struct Pivot {
    int freedom = 0;
    Eigen::Vector3d point, axis;  ///< world; the axis of length 1
  };

  void load(const std::vector<CarriedMass>& payloads);
  void take_joints(const Eigen::VectorXd& targets, const StepInput& input);
  /// The robot with what it carries.
  const RobotModel& moving() const { return loaded_ ? *loaded_ : *model_; }

  void solve(const StepInput& input, double dt, bool landing = false);
  double time_of_landing(double dt) const;
  void clear_report();
  void finish(double dt, double whole);
  void collect_contacts(double dt);
  void collect_inner(size_t group, double dt);
  void collect_edges(double dt);
  void collect_edges(int body, const CollisionModel::PlacedCollider& shape, const SolidBlock& block,
                     long key, double dt);
  void collect_links(double dt);
  double above_ground(const PointGroup& group) const;
  double fastest_approach() const;
  bool far(double gap, int body, const Active& active, double dt) const;
  void place_frame(const Eigen::Vector3d& normal, Active& active) const;
  void remember_impulses();
  void assemble(const StepInput& input, double dt, bool landing);
  void push(const ExternalWrench& wrench, double dt);
  void fill_mass();
  void find_runs();
  void add_run(size_t first, size_t count, int body, double sign);
  void fill_contact_rows(double dt);
  void fill_jacobian(const Run& run);
  void fill_delassus();
  void couple(const Run& run, const Run& other);
  void solve_velocity(double dt);
  bool limit_torques(double dt);
  void report_contacts(double dt, double whole);
  void report_sole(const Active& active, const Eigen::Vector3d& force);
  Eigen::Map<const Eigen::VectorXd> times_path(const Run& run, const double* rows,
                                               const Eigen::VectorXd& x);
  void add_impulses(Eigen::VectorXd& x);
  void contact_rates(const Eigen::VectorXd& velocity, std::vector<double>& rates);
  void share_among_cells(const Active& active, const Eigen::Vector3d& force);
  void account(double dt);
  void advance(double dt);
  Eigen::Matrix3d locked_inertia() const;
  bool is_pivot(const Active& active) const;
  void find_pivot();
  void turn_half(double dt);
  Eigen::Vector3d turned_forward(const Eigen::Vector3d& v) const {
    return turned_ ? Eigen::Vector3d(half_turn_ * v) : v;
  }
  Eigen::Vector3d turn_about_pivot(const Momentum& given) const;
  void follow_points(double dt);

  const RobotModel* model_;
  std::optional<RobotModel> loaded_;
  std::vector<CarriedMass> carried_;
  ActuatorLimits limits_;
  Ground ground_;
  RobotState state_;
  Momentum momentum_;  // of state_, about the COG: what gravity and the outside have left it
  double time_ = 0;    // since set_state() [s]
  RobotData data_;
  std::vector<ContactPoint> points_;
  std::vector<PointGroup> groups_;
  double widest_ = 0;  ///< distance of a point's far side from its body's origin [m]
  LinkContacts links_;
  double link_friction_ = 0, link_stiffness_ = 0;
  std::vector<char> is_foot_;  ///< by body
  Eigen::VectorXd kp_, kd_, rotor_, viscous_, coulomb_;
  Eigen::VectorXd stop_, stop_damping_;  ///< of joints beyond their range

  // Workspace of step().
  Eigen::VectorXd kp_now_, kd_now_, viscous_now_, coulomb_now_, target_now_;
  std::vector<Active> active_, last_active_;
  Pivot pivot_;          // of the last step
  bool turned_ = false;  // this one is that of the posture half_turn_ on
  Eigen::Matrix3d half_turn_;
  std::vector<Eigen::Vector3d> outline_;
  std::vector<InnerPoint> inner_;
  std::vector<FieldTip> tips_;
  std::vector<double> weights_;
  TreeCholesky factor_;
  std::vector<double> mass_;            // rows of the mass matrix with rotors, of state_
  std::vector<size_t> joint_diagonal_;  // in such rows, by dof
  std::vector<std::vector<int>> chain_bodies_, chain_lines_;  // by body
  std::vector<Run> runs_;
  bool paired_ = false;                // some of them are of links that touch
  std::vector<double> J_, Y_, block_;  // contact Jacobians, L^-T times their transposes, Y'Y of two
  std::vector<double> product_, rates_before_, rates_;
  Eigen::VectorXd impulse_, bias_, still_, velocity_, lower_, placed_, before_, outside_;
  std::vector<double> compliance_;
  std::vector<Eigen::Vector3d> shift_;
  std::vector<char> saturated_, left_law_, sliding_;
  Eigen::VectorXd fixed_, dry_, torque_;
  int iterations_ = 0;
  double residual_ = 0;
  ContactSolver solver_;
  Momentum external_;  // linear and angular (about the COG) momentum from outside in this step
  StepReport report_;
};

}  // namespace ayumi
