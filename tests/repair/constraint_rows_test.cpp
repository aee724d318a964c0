// Every kind of row of the repair's program, for two robots that walk and jump: its derivatives are
// compared with central differences, and its value with the check of the same motion.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "ayumi/check/consistency.hpp"
#include "ayumi/demand/motion_demand.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/self_collision.hpp"
#include "ayumi/math/rotation.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/differentiate.hpp"
#include "ayumi/repair/correction_problem.hpp"
#include "tests/support/random_robot.hpp"
#include "tests/support/robot_motions.hpp"

using namespace ayumi;
using namespace ayumi::test;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

// Turns an arm until two bodies are only 2.5 to 4.5 mm apart, in all samples.
void bring_near(const RobotModel& model, const CollisionModel& collisions, CommandSeries& series) {
  RobotData data(model);
  for (int i = 0; i < model.dof_count(); ++i) {
    bool arm = true;
    for (const Side side : {Side::left, Side::right})
      for (const int leg : model.leg(side)) arm = arm && leg != i;
    for (double angle = -1.5; arm && angle < 1.5; angle += 0.002) {
      RobotState state = series.samples.front().state;
      state.theta[i] += angle;
      update_positions(model, state, data);
      double least = 1;
      for (const CollisionModel::Pair& pair : collisions.pairs())
        least = std::min(least, collisions.clearance(pair, data, 0.01));
      if (least < 0.0025 || least > 0.0045) continue;
      for (CommandSample& s : series.samples) s.state.theta[i] += angle;
      return;
    }
  }
  ADD_FAILURE() << "no arm comes near";
}

// Adds waves to all joints and to the base, so that soles slip and sink and no residual is zero.
void disturb(const RobotModel& model, CommandSeries& series) {
  Random random(3);
  const VectorXd share = random.vector(model.velocity_count(), 0.004);
  for (size_t k = 0; k < series.samples.size(); ++k) {
    const double s = static_cast<double>(k) / static_cast<double>(series.samples.size() - 1);
    const VectorXd wave = share * std::pow(std::sin(M_PI * s), 4) * std::sin(20 * s);
    RobotState& state = series.samples[k].state;
    state.theta += wave.tail(model.dof_count());
    state.base.position += 0.1 * wave.head<3>();
    state.base.attitude = exp_rotation(Vector3d(wave.segment<3>(3))) * state.base.attitude;
  }
  fill_rates(series.samples, series.dt, true);
}

class ConstraintRows : public testing::TestWithParam<RobotMotion> {
 protected:
  const RobotModel& model = bundled_robot(GetParam().robot);
  const bool jumps = GetParam().motion == "jump";
  const CollisionModel collisions = CollisionModel(model);
  CommandSeries series;

  void take_motion(double dt) {
    Pattern pattern = pattern_of(GetParam());
    // Of two and more swings, the first one is so low that the foot scrapes the ground.
    for (Phase& phase : pattern.phases) {
      if (!phase.swing || jumps) continue;
      phase.swing->lift = 0.0005;
      break;
    }
    series = sample(model, pattern, {.dt = dt});
    bring_near(model, collisions, series);
    disturb(model, series);
  }

  // A specification in which everything has rows.
  CorrectionSpec spec(Trust trust) const {
    CorrectionSpec s;
    s.windows = {{0, series.duration()}};
    s.spacing = jumps ? 0.03 : 0.05;
    s.watched_share = 0;
    s.friction = 0.3;
    s.trust = trust;
    s.locked_feet = {true, false};
    s.collisions = &collisions;
    s.kept_times = {0.4 * series.duration(), 0.5 * series.duration()};
    for (int i = 0; i < static_cast<int>(collisions.pairs().size()); ++i) s.near_pairs.push_back(i);
    return s;
  }
};

struct Tally {
  int rows = 0, kinks = 0;
  double worst = 0;  // worst error of the others
};

// Compares the Jacobian with central differences along a direction, relatively if the derivative is
// above one. If the differences of two widths disagree, there is a kink between them: dry friction
// changes its sign, a foot begins to carry, or nearest points jump to another corner.
void compare(const CorrectionProblem& problem, const VectorXd& x, const VectorXd& direction,
             std::map<std::string, Tally>& tallies) {
  const Nlp nlp = problem.nlp();
  VectorXd values(nlp.jacobian.size()), computed = VectorXd::Zero(problem.constraint_count());
  nlp.jacobian_values(x, values);
  for (int i = 0; i < nlp.jacobian.size(); ++i)
    computed[nlp.jacobian.rows[i]] += values[i] * direction[nlp.jacobian.columns[i]];
  const auto difference = [&](double h) {
    return VectorXd(
        (problem.constraints(x + h * direction) - problem.constraints(x - h * direction)) /
        (2 * h));
  };
  // Nearest points are exact to 1e-10 m, and a short step would magnify this error.
  for (const bool clearance : {false, true}) {
    const double h = clearance ? 1e-4 : 1e-6;
    const VectorXd wide = difference(2 * h), narrow = difference(h);
    const VectorXd slope = (4 * narrow - wide) / 3;
    for (const RowBlock& b : problem.blocks()) {
      if (std::holds_alternative<ClearanceRows>(b.rule) != clearance) continue;
      Tally& tally = tallies[b.kind->name];
      for (int row = b.row; row < b.row + b.rows(); ++row) {
        const double size = std::max(1.0, std::abs(computed[row]));
        const double off = std::abs(slope[row] - computed[row]) / size;
        const bool kink = std::abs(narrow[row] - wide[row]) / size > 1e-6;
        ++tally.rows;
        tally.kinks += kink && off > 1e-6;
        if (!kink) tally.worst = std::max(tally.worst, off);
      }
    }
  }
}

}  // namespace

TEST_P(ConstraintRows, DerivativesAgainstCentralDifferences) {
  take_motion(jumps ? 0.001 : 0.004);
  std::map<std::string, Tally> tallies;
  Random random(11);
  for (const Trust trust : {Trust::cog, Trust::zmp, Trust::posture}) {
    const CorrectionProblem problem(model, series, spec(trust));
    for (const double size : {0.0005, 0.002})
      for (int n = 0; n < 3; ++n)
        compare(problem, random.vector(problem.variable_count(), size),
                random.vector(problem.variable_count(), 1), tallies);
  }
  std::set<std::string> all = {"support",      "normal_force",
                               "friction",     "flight",
                               "zmp",          "torsional_friction",
                               "stance",       "path",
                               "swing",        "scrape",
                               "landing",      "foot_clearance",
                               "position",     "speed",
                               "acceleration", "motor_acceleration",
                               "torque",       "clearance",
                               "cog",          "pose",
                               "dcm"};
  if (jumps) all.erase("scrape");
  if (!jumps) {
    all.erase("flight");
    all.erase("normal_force");  // in a walk, the ground force is never small
  }
  for (const std::string& kind : all) EXPECT_TRUE(tallies.contains(kind)) << kind << " has no rows";
  for (const auto& [kind, tally] : tallies) {
    EXPECT_GE(tally.rows, 12) << kind;
    EXPECT_LT(tally.worst, 1e-6) << kind;
    EXPECT_LE(tally.kinks, 0.005 * tally.rows) << kind << ", " << tally.rows << " rows";
  }
}

// At every sample, with no correction, the values that the program bounds are those that the check
// finds. Both take the same samples, so that the period only changes how long this takes.
TEST_P(ConstraintRows, NumbersAreThoseOfTheCheck) {
  take_motion(jumps ? 0.002 : 0.008);
  std::map<std::string, double> most, of_check;
  const auto raise = [&most](const std::string& name, double value) {
    most[name] = std::max(most.try_emplace(name, value).first->second, value);
  };
  const double weight = model.mass() * kGravity;
  CheckOptions options;
  options.friction = 0.3;
  for (CommandSample& s : series.samples) s.cog += Vector3d(0.001, -0.002, 0.0005);
  const ConsistencyReport report = check_consistency(model, series, options);
  const CheckSummary& summary = report.summary;
  const ContactPlan plan = contact_plan(series);
  std::set<int> near;
  RobotData data(model);
  for (size_t k = 0; k < series.samples.size(); k += 20) {
    update_positions(model, series.samples[k].state, data);
    for (const int i : spec(Trust::cog).near_pairs)
      if (collisions.clearance(collisions.pairs()[static_cast<size_t>(i)], data, 0.1) < 0.006)
        near.insert(i);
  }
  std::vector<Trust> trusts = {Trust::cog, Trust::zmp};
  if (!jumps) trusts.push_back(Trust::posture);  // because of its DCM rows
  for (const Trust trust : trusts) {
    CorrectionSpec all = spec(trust);
    all.near_pairs.assign(near.begin(), near.end());
    all.free_ends = {true, true};
    all.spacing = 50 * series.dt;
    all.points_per_knot = 50;
    const CorrectionProblem problem(model, series, all);
    const VectorXd g = problem.constraints(VectorXd::Zero(problem.variable_count()));
    MotionDynamics motion(model, model.limits(), series, plan);
    std::vector<Vector3d> turning(series.samples.size(), Vector3d::Constant(std::nan("")));
    for (const RowBlock& b : problem.blocks()) {
      const CollocationPoint& point = problem.points()[static_cast<size_t>(b.point)];
      const int k = point.sample;
      const VectorXd rows = g.segment(b.row, b.rows());
      const GroundDemand use = motion.at(k).use;
      const double light = use.normal_force / weight;
      // Rows of landing and foot_clearance have no figure in the check's summary to compare with.
      const std::string_view kind = b.kind->name;
      if (kind == "support") {
        // The row is f_n (distance of the ZMP inside the edges - margin) / (m g), with the
        // program's margin.
        if (!use.has_zmp) continue;
        EXPECT_NEAR(rows.minCoeff() / light + b.most_violation + all.zmp_margin, use.margin, 1e-10)
            << k;
      } else if (kind == "normal_force") {
        EXPECT_NEAR(rows[0], light, 1e-12);
      } else if (kind == "friction") {
        // The tip is rounded by 1e-4.
        const double size = all.limit_share * 0.3 * 0.98 * light - rows[0];
        if (use.has_zmp) raise("friction", std::sqrt(size * size - 1e-8) / (0.3 * light));
      } else if (kind == "torsional_friction") {
        const double yaw = std::abs(rows[1] - rows[0]) / 2;
        const double resists = (rows[0] + rows[1]) / 2 / all.limit_share;
        if (use.margin > 0.002) raise("yaw", yaw / resists);
      } else if (kind == "flight") {
        raise("ballistic", rows.head<3>().norm() * kGravity);
        turning[static_cast<size_t>(k)] = rows.tail<3>() * weight;
      } else if (kind == "zmp") {
        if (use.has_zmp) raise("zmp", (rows / light).norm());
      } else if (kind == "stance") {
        // The rotation error is sin(angle) times the axis.
        const Vector3d e = rows.tail<3>();
        const Eigen::Matrix3d R =
            exp_rotation(Vector3d(e.normalized() * std::asin(e.norm()))).toRotationMatrix();
        const Eigen::Isometry3d& at = point.ground[static_cast<size_t>(b.item)];
        const Vector3d normal = at.linear().col(2);
        double gap = -1, low = 1, slip = 0;
        for (const Vector2d& v : model.sole(static_cast<Side>(b.item)).polygon) {
          const Vector3d arm = at.linear() * Vector3d(v.x(), v.y(), 0);
          const Vector3d off = rows.head<3>() + R * arm - arm;
          gap = std::max(gap, normal.dot(off));
          low = std::min(low, normal.dot(off));
          slip = std::max(slip, (off - normal.dot(off) * normal).norm());
        }
        raise("float", gap);
        raise("penetration", -low);
        if (low <= 0.0003) raise("slip", slip);
      } else if (kind == "path") {
        EXPECT_LT(rows.norm(), 1e-9);
      } else if (kind == "swing") {
        raise("penetration", -rows.minCoeff());
      } else if (kind == "scrape") {
        // Soles that are deeper in the ground are errors of another kind.
        const double lowest = rows.minCoeff();
        EXPECT_LT(lowest, 0.0003) << k;
        if (lowest >= -0.001) raise("scrape", -lowest);
      } else if (kind == "pose") {
        EXPECT_EQ(rows.norm(), 0);
      } else if (kind == "position") {
        const Dof& dof = model.dofs()[static_cast<size_t>(b.item)];
        const double half = 0.5 * (dof.upper - dof.lower) - model.description().soft_limit_margin;
        raise("position", std::abs(rows[0] - 0.5 * (dof.lower + dof.upper)) / half);
      } else if (kind == "speed") {
        raise("speed", std::abs(rows[0]));
      } else if (kind == "acceleration" || kind == "motor_acceleration") {
        raise("acceleration", std::abs(rows[0] / std::get<JointRow>(b.rule).scale));
      } else if (kind == "torque") {
        raise("torque", std::abs(rows[0]));
      } else if (kind == "clearance") {
        raise("overlap", -rows.minCoeff());
      } else if (kind == "cog") {
        raise("cog", rows.norm());
      } else if (kind == "dcm") {
        // The value follows from the momentum of the links; the command is simply shifted aside.
        const CommandSample& s = series.samples[static_cast<size_t>(k)];
        const double omega = std::sqrt(kGravity / (s.cog.z() - s.zmp.z()));
        update_positions(model, s.state, data);
        update_velocities(model, s.state, data);
        const Vector3d off = data.cog - s.cog + (data.dcog - s.dcog) / omega;
        EXPECT_NEAR((off.head<2>() - rows.head<2>()).norm(), 0, 1e-12) << k;
        if (use.has_zmp) raise("zmp", (rows.tail<2>() / light).norm());
      }
    }
    for (size_t k = 2; k + 2 < turning.size(); ++k) {  // the check takes a mean of five samples
      Vector3d sum = Vector3d::Zero();
      int count = 0;
      for (size_t i = k - 2; i <= k + 2; ++i)
        if (turning[i].allFinite()) sum += turning[i], ++count;
      if (count > 0 && turning[k].allFinite()) raise("momentum", sum.norm() / count);
    }
  }
  of_check = {{"friction", summary[FindingKind::friction]},
              {"yaw", summary[FindingKind::yaw_moment]},
              {"zmp", summary[FindingKind::zmp_residual]},
              {"float", summary[FindingKind::foot_float]},
              {"penetration", summary[FindingKind::foot_penetration]},
              {"slip", summary[FindingKind::foot_slip]},
              {"position", summary[FindingKind::joint_position]},
              {"speed", summary[FindingKind::joint_speed]},
              {"acceleration", summary[FindingKind::joint_acceleration]},
              {"torque", summary[FindingKind::joint_torque]},
              {"overlap", -summary[FindingKind::self_collision]},
              {"cog", summary[FindingKind::cog_residual]}};
  for (const Finding& f : report.findings)
    if (f.kind == FindingKind::foot_scrape)
      of_check["scrape"] =
          std::max(of_check.try_emplace("scrape", -f.worst).first->second, -f.worst);
  EXPECT_EQ(of_check.contains("scrape"), most.contains("scrape"));
  EXPECT_EQ(of_check.contains("scrape"), !jumps);
  if (jumps) of_check["ballistic"] = summary[FindingKind::ballistic];
  if (summary[FindingKind::self_collision] <
      0) {  // ends are less deep inside than the distance by which shapes have to be parted
    EXPECT_GT(most["overlap"], 0);
    EXPECT_LE(most["overlap"], of_check["overlap"] + 1e-9);
    of_check.erase("overlap");
  }
  for (const auto& [name, value] : of_check)
    EXPECT_NEAR(most[name], value, 1e-9 * std::max(1.0, std::abs(value))) << name;
  if (!jumps) return;
  // This value is about the commanded COG, and the other about that of the posture, 2.3 mm apart.
  EXPECT_NEAR(most["momentum"], summary[FindingKind::angular_momentum],
              0.0025 * model.mass() * most["ballistic"] + 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Motions, ConstraintRows, robot_motions(), name_of_case);
