#include "ayumi/sim/plant/contact_rows.hpp"

#include <gtest/gtest.h>

#include "ayumi/dynamics/inverse_dynamics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/math/rotation.hpp"
#include "tests/support/random_robot.hpp"

namespace ayumi {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRowStep = 1e-3;  // time step [s]

/// A step of a random robot with contacts at random places of some of its bodies.
struct ContactStep {
  ContactStep(unsigned seed, int contacts_per_body)
      : random(seed),
        model(test::random_tree(seed, 9)),
        data(model),
        factor(model),
        rows(model, factor, 1),
        before(random.vector(model.velocity_count(), 0.1)),
        right(random.vector(model.velocity_count(), 1e-3)) {
    update_velocities(model, test::random_state(model, random), data);
    mass_matrix(model, data, mass);
    for (int body = 0; body < static_cast<int>(model.bodies().size()); body += 3)
      for (int i = 0; i < contacts_per_body; ++i) add_contact(body);
  }

  void add_contact(int body) {
    ActiveContact contact;
    contact.key = static_cast<long>(contacts.size());
    contact.body = body;
    contact.stiffness = random.uniform(1e4, 1e5);
    contact.damping_time = random.uniform(0, 0.01);
    contact.gap = random.uniform(-2e-3, -1e-3);
    contact.position = data.base_position + data.position[static_cast<size_t>(body)] +
                       Vector3d(random.vector(0.1));
    contact.to_contact = exp_rotation(random.vector(3)).toRotationMatrix();
    contact.ground_velocity = random.vector(0.01);
    contact.friction = 0.8;
    contact.impulse = {1, 0, 0};
    contact.deflection = Eigen::Vector2d(random.uniform(), random.uniform()) * 1e-4;
    contacts.push_back(contact);
  }

  VectorXd in_places(const VectorXd& v) const {
    VectorXd placed(v.size());
    for (int k = 0; k < v.size(); ++k) placed[k] = v[factor.column_at(k)];
    return placed;
  }

  /// The change of velocity that follows from the contact problem.
  VectorXd by_rows(ContactSolution& solution) {
    rows.set(contacts, data, factor, before, kRowStep);
    EXPECT_TRUE(factor.factor(mass));
    VectorXd x = in_places(right);
    factor.solve_upper(x);
    solution = rows.solve(data, factor, x);
    factor.solve_lower(x);
    return x;
  }

  /// The change of velocity with the contacts as springs.
  VectorXd by_springs() {
    rows.set(contacts, data, factor, before, kRowStep);
    EXPECT_TRUE(factor.factor(mass));  // gives the rows their size and their padding
    std::vector<double>& system = factor.rows();
    for (int k = 0; k < mass.rows(); ++k)
      for (int i = k; i >= 0; i = factor.parent(i))
        system[static_cast<size_t>(factor.row_begin(k) + factor.depth(i))] =
            mass(factor.column_at(i), factor.column_at(k));
    VectorXd x = in_places(right);
    rows.add_springs(data, factor, system, x);
    EXPECT_TRUE(factor.factor_rows());
    factor.solve_upper(x);
    factor.solve_lower(x);
    return x;
  }

  /// Uses the impulses of the last solve as those of the last step.
  void keep_impulses() {
    for (size_t i = 0; i < contacts.size(); ++i) contacts[i].impulse = rows.impulse(i);
  }

  test::Random random;
  RobotModel model;
  RobotData data;
  TreeCholesky factor;
  ContactRows rows;
  VectorXd before, right;
  MatrixXd mass;
  std::vector<ActiveContact> contacts;
};

// If all pressing contacts stick in the solution of the contact problem, the solution with springs
// is the same. Otherwise the function with springs reports that its result is not valid.
TEST(ContactRows, SpringsSolveTheContactProblemWhereAllStick) {
  int agreed = 0, refused = 0, open = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    ContactStep step(seed, 1 + static_cast<int>(seed % 3));
    for (ActiveContact& contact : step.contacts) {
      if (seed % 4 == 0) contact.friction = 0.05;
      if (seed % 5 == 0 && contact.key % 2 == 1) contact.gap = 5e-3;  // this contact stays open
    }
    ContactSolution solution;
    const VectorXd expected = step.by_rows(solution);
    ASSERT_LE(solution.residual, kContactTolerance) << seed;
    step.keep_impulses();
    std::vector<Vector3d> impulses;
    for (const ActiveContact& contact : step.contacts) impulses.push_back(contact.impulse);
    if (!step.rows.all_stick()) {
      // Springs are used for contacts that slide: the same call has to refuse its result.
      step.by_springs();
      VectorXd change = step.by_springs();
      ContactSolution of_springs;
      EXPECT_FALSE(step.rows.take_springs(step.data, step.factor, change, of_springs)) << seed;
      for (size_t i = 0; i < impulses.size(); ++i)
        EXPECT_EQ((step.rows.impulse(i) - impulses[i]).norm(), 0) << seed;
      ++refused;
      continue;
    }
    const VectorXd change = step.by_springs();
    ContactSolution of_springs;
    ASSERT_TRUE(step.rows.take_springs(step.data, step.factor, change, of_springs)) << seed;
    EXPECT_LE(of_springs.residual, kContactTolerance);
    // The tolerance is the rounding of the stiffest springs, 1e5 N/m in 1 ms, on the smallest
    // masses of 0.05 kg.
    EXPECT_LT((change - expected).cwiseAbs().maxCoeff(), 1e-9) << seed;
    for (size_t i = 0; i < impulses.size(); ++i) {
      EXPECT_LT((step.rows.impulse(i) - impulses[i]).norm(), 1e-9) << seed;
      open += impulses[i].isZero(0);
    }
    ++agreed;
  }
  EXPECT_GT(agreed, 10);
  EXPECT_GT(refused, 10);
  EXPECT_GT(open, 10);
}

// A contact that pressed and is now pulled is not taken for a spring, and one that was open and is
// now driven into the ground is not taken for open.
TEST(ContactRows, SpringsRefuseWhatTheyHaveNotExpected) {
  ContactStep step(7, 2);
  ContactSolution solution;
  for (ActiveContact& contact : step.contacts) contact.gap = 5e-3;
  step.contacts[0].gap = -1e-3;
  step.contacts[0].friction = 1e3;
  for (ActiveContact& contact : step.contacts) contact.impulse.setZero();
  step.rows.set(step.contacts, step.data, step.factor, step.before, kRowStep);
  ASSERT_TRUE(step.rows.all_stick());
  const VectorXd free = step.by_springs();
  // The contact penetrates.
  EXPECT_FALSE(step.rows.take_springs(step.data, step.factor, free, solution));
  step.contacts[0].impulse = {1, 0, 0};
  step.contacts[0].gap = 0.1;
  const VectorXd pulled = step.by_springs();
  EXPECT_FALSE(step.rows.take_springs(step.data, step.factor, pulled, solution));
}

}  // namespace
}  // namespace ayumi
