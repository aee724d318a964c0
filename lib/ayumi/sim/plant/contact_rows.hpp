#pragma once
// The contacts of a step. If all pressing contacts stick, they are springs in the matrix of the
// step; otherwise they are a problem for the ContactSolver, with the Jacobians J of the contact
// points, the factor L of the step's matrix, the right side b and the Delassus matrix A:
//   Y = L^-T J',  A = Y' Y + compliance.
// docs/theory_plant.md, (P2) and (P3).

#include <Eigen/Dense>
#include <vector>

#include "ayumi/dynamics/tree_cholesky.hpp"
#include "ayumi/sim/plant/contact_solver.hpp"
#include "ayumi/sim/plant/contacts.hpp"

namespace ayumi {

class ContactRows {
 public:
  /// Reserves memory for the corners of both soles. `points` is the robot's number of points.
  ContactRows(const RobotModel& model, const TreeCholesky& factor, size_t points);

  /// Computes Jacobians, compliances, gaps and friction of the contacts of a step of `dt` [s].
  /// `before` is the generalised velocity at its start.
  void set(const std::vector<ActiveContact>& contacts, const RobotData& data,
           const TreeCholesky& factor, const Eigen::VectorXd& before, double dt);

  /// Whether every contact that pressed in the last solve was on the ground and inside its cone.
  bool all_stick() const;

  /// Adds these contacts, as they were in the last solve, to the rows of the step's matrix as
  /// springs that push and pull, and to the right side `x`, whose entries have the order of
  /// `factor` (places). The other contacts stay open.
  void add_springs(const RobotData& data, const TreeCholesky& factor, std::vector<double>& matrix,
                   Eigen::VectorXd& x);

  /// Takes over the impulses of the springs. `change` is the solved change of velocity in the order
  /// of `factor`. If a contact does not obey its law, returns false and leaves the impulses as
  /// before.
  bool take_springs(const RobotData& data, const TreeCholesky& factor,
                    const Eigen::VectorXd& change, ContactSolution& solution);

  /// Solves the contacts with the factor L of the step's matrix. `x` contains L^-T times the right
  /// side of the free motion, in the order of `factor`, and receives L^-T J' times the impulses.
  ContactSolution solve(const RobotData& data, const TreeCholesky& factor, Eigen::VectorXd& x);

  /// The impulses of the last solve in contact axes [N s].
  Eigen::Vector3d impulse(size_t contact) const {
    return solver_.impulse().segment<3>(3 * static_cast<Eigen::Index>(contact));
  }
  /// The velocities of the contact points before the step, in contact axes [m/s].
  Eigen::Vector3d rate_before(size_t contact) const {
    return Eigen::Map<const Eigen::Vector3d>(&rates_before_[3 * contact]);
  }
  /// The velocities after the step, as the last set_rates() computed them [m/s].
  Eigen::Vector3d rate(size_t contact) const {
    return Eigen::Map<const Eigen::Vector3d>(&rates_[3 * contact]);
  }
  void set_rates(const RobotData& data, const TreeCholesky& factor,
                 const Eigen::VectorXd& velocity) {
    multiply(data, factor, velocity, rates_);
  }

 private:
  /// Consecutive contacts of one body. If links touch each other, two blocks describe the same
  /// contacts, one for each body. A block is stored transposed: it has one line for each place
  /// (velocity) on the path to the body. A line has three numbers for each contact and is filled up
  /// to a multiple of four.
  struct Block {
    int body = 0;
    int last = 0;                 // last place that moves the body
    double sign = 1;              // -1 for the body that is pushed back
    size_t first = 0, count = 0;  // first contact and number of contacts
    int width = 0;                // number of doubles in a line
    size_t begin = 0;             // beginning of the block in J_ and Y_
  };

  void find_blocks(const std::vector<ActiveContact>& contacts, const TreeCholesky& factor);
  void add_block(size_t first, size_t count, int body, double sign, const TreeCholesky& factor);
  size_t end_of(const Block& block, const TreeCholesky& factor) const {
    return block.begin + static_cast<size_t>((factor.depth(block.last) + 1) * block.width);
  }
  void fill_jacobian(const Block& block, const std::vector<ActiveContact>& contacts,
                     const RobotData& data, const TreeCholesky& factor);
  void fill_problem(const RobotData& data, const TreeCholesky& factor, const Eigen::VectorXd& x);
  void couple(const Block& block, const Block& other, const RobotData& data,
              const TreeCholesky& factor);
  Eigen::Map<const Eigen::VectorXd> times_path(const Block& block, const double* rows,
                                               const Eigen::VectorXd& x, const RobotData& data,
                                               const TreeCholesky& factor);
  void multiply(const RobotData& data, const TreeCholesky& factor, const Eigen::VectorXd& velocity,
                std::vector<double>& rates);

  std::vector<std::vector<int>> chain_bodies_, chain_lines_;  // for each body, its path to the root
  size_t count_ = 0;                                          // number of contacts
  std::vector<Block> blocks_;
  bool linked_ = false;  // whether some contacts are between links of the robot
  std::vector<double> J_, Y_;
  std::vector<double> compliance_;      // compliance of each contact [1/kg]
  std::vector<Eigen::Vector3d> shift_;  // for each contact: J v + gap terms - ground velocity [m/s]
  // Rates at the contacts, three for each; rates_before_ are those at the step's start [m/s].
  std::vector<double> rates_before_, rates_;
  ContactSolver solver_;
  // Workspace.
  std::vector<double> gram_, product_, springs_, pull_, rates_change_;
  Eigen::VectorXd placed_;
};

}  // namespace ayumi
