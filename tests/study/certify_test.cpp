#include "ayumi/study/certify.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/study/runs.hpp"
#include "ayumi/study/subset_simulation.hpp"
#include "tests/support/error_message.hpp"
#include "tests/support/hoap1_walk.hpp"

namespace ayumi::test {
namespace {

Uncertainty uncertainty(const std::string& members) {
  return study_of_text(
             R"({"format": "ayumi.study/1", "units": {"angle": "deg"}, "uncertainty": {)" +
                 members + "}}",
             "study.json")
      .uncertainty;
}

/// HOAP-1 stands for a short time.
struct StandingTask {
  Uncertainty unknown;
  CommandSeries series = short_stand();
  UncertainTask task;
  explicit StandingTask(const std::string& members)
      : unknown(uncertainty(members)), task(hoap1(), series, unknown, options()) {}
  static CommandSeries short_stand() {
    CommandSeries series = standing_series(hoap1_walk());
    series.samples.resize(801);
    return series;
  }
  static SimulateOptions options() {
    SimulateOptions options;
    options.controller = {ControllerKind::dtad, {}};
    options.settle = 0.6;
    return options;
  }
};

const std::string kPushed = R"("pushes": [{"unit": "B", "size": {"uniform": [0.3, 1.3],
  "source": "assumed: test"}, "direction": {"uniform": [0, 360], "source": "assumed: test"},
  "time": 0.1}])";

std::vector<double> values_of(const UncertainTask& task, long number) {
  return task.draw(task.numbers(1, number));
}

TEST(UncertainTask, EveryQuantityChangesWhatItNames) {
  const auto unit_of = [](const std::string& quantity, double expected) {
    const StandingTask t(R"("quantities": [)" + quantity + "]");
    const std::vector<double> drawn = values_of(t.task, 0);
    EXPECT_NEAR(drawn[0], expected, 1e-12) << quantity;
    return t.task.unit(drawn);
  };
  const RobotModel& nominal = hoap1();
  const int foot = nominal.find_link("l_foot"), knee = nominal.find_dof("l_knee");
  const auto link = [&](const RobotUnit& unit) { return unit.model.links()[foot].inertia; };
  const auto servo = [&](const RobotUnit& unit) { return unit.actuators.servo[knee]; };
  const auto fixed = [](const std::string& what, const std::string& value,
                        const std::string& more = "") {
    return R"({"what": ")" + what + R"(", "choice": [)" + value + R"(], "source": "test")" + more +
           "}";
  };
  const std::string on_foot = R"(, "on": "l_foot")", on_knee = R"(, "on": "l_*nee")";
  const Inertia before = nominal.links()[foot].inertia;
  const RobotUnit heavy = unit_of(fixed("mass", "1.1", on_foot), 1.1);
  EXPECT_NEAR(link(heavy).mass, 1.1 * before.mass, 1e-12);
  EXPECT_NEAR(heavy.model.mass(), nominal.mass() + 0.1 * before.mass, 1e-12);
  EXPECT_NEAR(link(heavy).about_com(0, 0), 1.1 * before.about_com(0, 0), 1e-12);
  EXPECT_EQ(heavy.model.sole(Side::left).stiffness, nominal.sole(Side::left).stiffness);
  // MuJoCo uses the softness of soles only if a file states it, so this must not become a
  // statement.
  EXPECT_FALSE(heavy.model.description().soles.at("left").states_softness());
  const RobotUnit moved = unit_of(fixed("cog", "0.004", on_foot + R"(, "axis": "y")"), 0.004);
  EXPECT_NEAR(link(moved).com.y(), before.com.y() + 0.004, 1e-12);
  const RobotUnit slow = unit_of(fixed("inertia", "1.2", on_foot), 1.2);
  EXPECT_NEAR(link(slow).about_com(1, 1), 1.2 * before.about_com(1, 1), 1e-12);
  EXPECT_EQ(link(slow).mass, before.mass);
  const RobotUnit loaded =
      unit_of(fixed("payload", "0.2", on_foot + R"(, "point": [0, 0, 0.1])"), 0.2);
  EXPECT_NEAR(loaded.model.mass(), nominal.mass() + 0.2, 1e-12);
  const RobotUnit soft = unit_of(fixed("sole_stiffness", "0.5"), 0.5);
  EXPECT_NEAR(soft.model.sole(Side::right).stiffness, 0.5 * nominal.sole(Side::right).stiffness,
              1e-6);
  const RobotUnit damped = unit_of(fixed("sole_damping", "2"), 2);
  EXPECT_NEAR(damped.model.sole(Side::right).damping_time,
              2 * nominal.sole(Side::right).damping_time, 1e-12);
  const double kp = nominal.limits().servo[knee].kp, kd = nominal.limits().servo[knee].kd;
  EXPECT_NEAR(servo(unit_of(fixed("servo_kp", "0.7", on_knee), 0.7)).kp, 0.7 * kp, 1e-9);
  EXPECT_NEAR(servo(unit_of(fixed("servo_kd", "0.7", on_knee), 0.7)).kd, 0.7 * kd, 1e-9);
  EXPECT_EQ(servo(unit_of(fixed("servo_friction", "0.1", on_knee), 0.1)).coulomb, 0.1);
  EXPECT_EQ(servo(unit_of(fixed("servo_delay", "0.004", on_knee), 0.004)).delay, 0.004);
  EXPECT_EQ(servo(unit_of(fixed("servo_delay", "0.004", R"(, "on": "r_knee")"), 0.004)).delay, 0);
  const double degree = M_PI / 180;
  EXPECT_NEAR(servo(unit_of(fixed("backlash", "0.2", on_knee), 0.2 * degree)).backlash,
              0.2 * degree, 1e-12);
  EXPECT_NEAR(servo(unit_of(fixed("encoder_offset", "-0.3", on_knee), -0.3 * degree)).offset,
              -0.3 * degree, 1e-12);
  const SensorDescription& sensors = nominal.description().sensors;
  const RobotUnit noisy = unit_of(fixed("sensor_noise", "3"), 3);
  EXPECT_NEAR(noisy.model.description().sensors.gyro_noise, 3 * sensors.gyro_noise, 1e-12);
  EXPECT_NEAR(noisy.model.description().sensors.force_noise, 3 * sensors.force_noise, 1e-12);
  const RobotUnit late = unit_of(fixed("sensor_latency", "0.005"), 0.005);
  EXPECT_EQ(late.model.description().sensors.latency, 0.005);

  const StandingTask world(R"("quantities": [)" + fixed("friction", "0.3") + "," +
                           fixed("slope", "1", R"(, "axis": "y")") + "," + fixed("bumps", "0.001") +
                           "," + fixed("attitude_bias", "0.5", R"(, "axis": "x")") + "," +
                           fixed("gyro_bias", "1", R"(, "axis": "z")") + "," +
                           fixed("load_bias", "0.2") + "]");
  const CaseNumbers numbers = world.task.numbers(1, 0);
  const SimulateOptions options = world.task.options(numbers, world.task.draw(numbers));
  EXPECT_EQ(options.world.friction, 0.3);
  EXPECT_NEAR(options.world.slope.y(), degree, 1e-12);
  ASSERT_EQ(options.world.fields.size(), 1u);
  EXPECT_GE(options.world.fields[0].heights.minCoeff(), -0.001);
  EXPECT_LT(options.world.fields[0].heights.minCoeff(), -0.0009);
  EXPECT_LE(options.world.fields[0].heights.maxCoeff(), 0);
  ASSERT_EQ(options.scenario.size(), 1u);
  const SensorBias& bias = std::get<SensorBias>(options.scenario[0].what);
  EXPECT_NEAR(bias.tilt.x(), 0.5 * degree, 1e-12);
  EXPECT_NEAR(bias.gyro.z(), degree, 1e-12);
  EXPECT_EQ(bias.load, 0.2);
}

TEST(UncertainTask, ValuesBelongToNamesAndNotToTheirOrder) {
  const std::string mass = R"({"what": "mass", "uniform": [0.9, 1.1], "source": "test"})";
  const std::string friction = R"({"what": "friction", "uniform": [0.4, 1], "source": "test"})";
  const StandingTask one(R"("quantities": [)" + mass + "]");
  const StandingTask two(R"("quantities": [)" + friction + "," + mass + "]");
  for (long number = 0; number < 20; ++number)
    EXPECT_EQ(values_of(one.task, number)[0], values_of(two.task, number)[1]);
  EXPECT_NE(values_of(one.task, 3)[0], values_of(one.task, 4)[0]);
}

// Shares of draws agree with the distribution, and a factor gives the correlation.
TEST(UncertainTask, DrawsFollowTheirDistributions) {
  const StandingTask t(R"("factors": [{"name": "battery", "source": "test"}], "quantities": [
    {"what": "friction", "uniform": [0.4, 1], "source": "test"},
    {"what": "servo_kp", "normal": [1, 0.1], "factor": "battery", "correlation": 0.8, "source": "t"},
    {"what": "servo_kd", "truncated": [1, 0.1, 0.95, 1.2], "factor": "battery", "correlation": -0.5,
     "source": "t"},
    {"what": "sensor_noise", "choice": [1, 2, 3], "weights": [1, 2, 1], "source": "test"}])");
  constexpr int kDraws = 4000;
  std::array<double, 4> mean = {}, square = {};
  double product = 0;
  int twos = 0;
  for (long i = 0; i < kDraws; ++i) {
    const std::vector<double> v = values_of(t.task, i);
    for (size_t k = 0; k < 4; ++k) {
      mean[k] += v[k] / kDraws;
      square[k] += v[k] * v[k] / kDraws;
    }
    EXPECT_TRUE(v[0] >= 0.4 && v[0] <= 1 && v[2] >= 0.95 && v[2] <= 1.2);
    const CaseNumbers numbers = t.task.numbers(1, i);
    const std::vector<double> shares = t.task.shares(numbers);
    product += normal_quantile(shares[1]) * normal_quantile(shares[2]) / kDraws;
    twos += v[3] == 2;
  }
  // The tolerance is four standard deviations of a mean of 4000 draws, which is sd / 63.
  EXPECT_NEAR(mean[0], 0.7, 4 * 0.1733 / 63);
  EXPECT_NEAR(mean[1], 1, 4 * 0.1 / 63);
  EXPECT_NEAR(std::sqrt(square[1] - mean[1] * mean[1]), 0.1, 0.005);
  EXPECT_NEAR(twos, 0.5 * kDraws, 4 * std::sqrt(0.25 * kDraws));
  EXPECT_NEAR(product, -0.4, 4 * 1.08 / 63);
}

TEST(UncertainTask, RefusesWhatNothingUsesAndWhatNoRobotCanHave) {
  const auto message = [](const std::string& members) {
    return error_message([&] { StandingTask t(members); }, ErrorCode::bad_pattern);
  };
  EXPECT_EQ(message(R"("quantities": [{"what": "mass", "on": "l_fot", "uniform": [1, 1],
                       "source": "t"}])"),
            "study.json: /uncertainty/quantities/0: this quantity has no effect: hoap1 has no link "
            "'l_fot' with a mass; did you mean 'l_foot'?");
  EXPECT_EQ(message(R"("factors": [{"name": "heat", "source": "t"}])"),
            "study.json: /uncertainty/factors/0: no quantity uses the factor 'heat'. Name the "
            "factor in a quantity, or leave the factor out");
  const StandingTask negative(
      R"("quantities": [{"what": "mass", "normal": [0, 1], "source": "t"}])");
  CertifyOptions options;
  options.most = 299;
  const std::string text = error_message([&] { run_cases(negative.task, options); });
  EXPECT_NE(text.find("for the mass (factor on mass and inertia), but the value must be above 0"),
            std::string::npos)
      << text;
}

// In an earlier version, a factor, a length and a force were numbers without a unit.
TEST(UncertainTask, WritesEveryValueWithItsUnit) {
  const StandingTask t(R"("quantities": [
      {"what": "mass", "on": "l_foot", "choice": [1.1], "source": "t"},
      {"what": "cog", "on": "l_foot", "axis": "y", "choice": [0.004], "source": "t"},
      {"what": "friction", "choice": [0.7], "source": "t"},
      {"what": "load_bias", "choice": [-0.25], "source": "t"},
      {"what": "sensor_latency", "choice": [0.003], "source": "t"}])");
  const std::vector<std::string> kinds = t.task.values_by_kind(values_of(t.task, 0));
  const std::vector<std::string> ends = {" times 1.1", "cog along y of l_foot +0.004 m",
                                         "friction 0.7", " -0.25 N", " 0.003 s"};
  ASSERT_EQ(kinds.size(), ends.size());
  for (size_t i = 0; i < ends.size(); ++i) EXPECT_TRUE(kinds[i].ends_with(ends[i])) << kinds[i];
}

// The text of the event joins the kinds by "; ", which a name may contain as well.
TEST(UncertainTask, GroupsValuesByKind) {
  const StandingTask t(R"("quantities": [
      {"what": "mass", "on": "l_foot", "choice": [1.1], "source": "t"},
      {"what": "mass", "on": "r_foot", "choice": [1.2], "source": "t"},
      {"what": "friction", "choice": [0.7], "source": "t"}],
      "pushes": [{"unit": "N s", "direction": 0, "duration": 0.02, "size": 1, "time": 0.1,
                  "on": {"choice": ["l_foot"], "source": "t"}}])");
  const std::vector<std::string> kinds = t.task.values_by_kind(values_of(t.task, 0));
  ASSERT_EQ(kinds.size(), 3u);
  EXPECT_NE(kinds[0].find(" 1.1, "), std::string::npos) << kinds[0];
  EXPECT_EQ(kinds[1], "friction 0.7");
  EXPECT_NE(kinds[2].find("l_foot"), std::string::npos) << kinds[2];
}

TEST(UncertainTask, RefusesPushesThatHaveNoEffectAndValuesInAWrongUnit) {
  const auto of_push = [](const std::string& part) {
    return R"("pushes": [{"unit": "N s", "direction": 0, "duration": 0.02, )" + part + "}]";
  };
  EXPECT_EQ(error_message([&] {
              StandingTask t(of_push(R"("size": 1, "time": 0.1, "on":
      {"choice": ["cog", "trunk", "l_fot"], "source": "t"})"));
            }),
            "study.json: /uncertainty/pushes/0/on: hoap1 has no link 'l_fot'. A push acts on a "
            "link, on \"trunk\" or on \"cog\"; did you mean 'l_foot'?");
  const auto message = [](const std::string& members) {
    const StandingTask t(members);
    return error_message([&] { t.task.check(values_of(t.task, 0), "case 0"); });
  };
  const auto expect = [&](const std::string& members, const std::string& part) {
    EXPECT_NE(message(members).find(part), std::string::npos) << message(members);
  };
  expect(of_push(R"("size": 1, "time": 1.5)"), "the run ends at 1.401 s");
  expect(of_push(R"("size": 1, "time": -0.5)"), "case 0 draws -0.5 for the push: time");
  expect(of_push(R"("size": -1, "time": 0.1)"), "the value must not be negative");
  EXPECT_EQ(message(of_push(R"("size": 1, "time": 1.3, "on": "trunk")")), "no error");
  const auto of_kind = [](const std::string& what) {
    return R"("quantities": [{"what": ")" + what + R"(", "choice": [4], "source": "t"}])";
  };
  expect(of_kind("servo_delay"), "the largest value allowed is 0.1. Check the unit");
  expect(of_kind("sensor_latency"), "the largest value allowed is 1. Check the unit");
}

// The law knows the zeros of the robot's file, and not those by which an uncertain unit differs
// from them. So a unit that is equal to a file with offsets stands as a robot without offsets does,
// and the other units of this file stand as those of a file without offsets.
TEST(UncertainTask, AUnitDiffersFromTheZerosOfItsFile) {
  const double count = M_PI / 180 / 209;  // whole counts, so that both robots round alike
  RobotDescription description = hoap1().description();
  description.servos.at("l_knee").offset = 84 * count;
  description.servos.at("r_ankle_roll").offset = -63 * count;
  const RobotModel file(description);
  const CommandSeries series = StandingTask::short_stand();
  std::vector<double> errors;
  for (const std::string value : {"0", "0.5"}) {
    const Uncertainty unknown =
        uncertainty(R"("quantities": [{"what": "encoder_offset", "choice": [)" + value +
                    R"(], "on": "l_knee", "source": "test"}])");
    std::vector<CaseResult> results;
    for (const RobotModel* model : {&hoap1(), &file}) {
      const UncertainTask task(*model, series, unknown, StandingTask::options());
      const std::vector<double> drawn = values_of(task, 0);
      EXPECT_NEAR(task.unit(drawn).actuators.servo[model->find_dof("l_knee")].offset,
                  model->limits().servo[model->find_dof("l_knee")].offset + drawn[0], 1e-12);
      results.push_back(task.run(task.numbers(1, 0)));
      EXPECT_EQ(results.back().outcome, Outcome::stands) << value;
    }
    EXPECT_NEAR(results[0].cog_error, results[1].cog_error, 1e-6) << value;
    EXPECT_NEAR(results[0].torque, results[1].torque, 1e-4) << value;
    errors.push_back(results[1].cog_error);
  }
  EXPECT_GT(errors[1], errors[0] + 1e-4);
}

TEST(UncertainTask, ARobotEqualToItsModelRunsAsWithoutUncertainty) {
  const StandingTask same(R"("quantities": [{"what": "mass", "choice": [1], "source": "t"}])");
  const CaseNumbers numbers = same.task.numbers(1, 0);
  const CaseResult result = same.task.run(numbers);
  SimulateOptions options = StandingTask::options();
  options.sensor_noise = true;
  options.seed = numbers.noise;
  const SimulationLog log = simulate(hoap1(), same.series, options);
  EXPECT_EQ(result.outcome, Outcome::stands);
  EXPECT_EQ(result.torque, log.result.torque.ratio);
  double worst = 0;
  for (const SimulationSample& s : log.samples)
    worst = std::max(worst, (s.cog - s.command_cog).head<2>().norm());
  // The soles have slipped and turned by less than this [m].
  EXPECT_NEAR(result.cog_error, worst, 5e-4);
  EXPECT_LT(result.foot_tilt, 0.02);
}

struct PushedStudy {
  StandingTask stand{kPushed};
  CertifyOptions options;
  PushedStudy() {
    options.failure = 0.1;
    options.confidence = 0.9;
    options.most = 60;
    options.all = true;
  }
  /// The results of all cases of the study. They depend on nothing else, so they are computed once.
  static const KnownResults& results() {
    static const KnownResults all = [] {
      const PushedStudy study;
      return run_cases(study.stand.task, study.options);
    }();
    return all;
  }
};

TEST(Certify, ResultsDoNotDependOnThreadsAndShards) {
  PushedStudy study;
  study.options.threads = 1;
  const KnownResults one = run_cases(study.stand.task, study.options);
  study.options.threads = 3;
  EXPECT_EQ(run_cases(study.stand.task, study.options), one);
  KnownResults merged;
  for (long shard = 0; shard < 3; ++shard) {
    CertifyOptions part = study.options;
    part.shards = 3;
    part.shard = shard;
    merged = run_cases(study.stand.task, part, merged);
    EXPECT_EQ(merged[1].has_value(), shard > 0);
  }
  EXPECT_EQ(merged, one);
  const Certificate whole = certificate(study.options, one);
  EXPECT_FALSE(whole.outcome.certified);
  EXPECT_GT(whole.outcome.failures, 0);
  // Without `all`, the cases after the stop are not kept, and the verdict is the same.
  study.options.all = false;
  const KnownResults stopped = run_cases(study.stand.task, study.options);
  const Certificate early = certificate(study.options, stopped);
  EXPECT_EQ(early.outcome.runs, whole.outcome.runs);
  EXPECT_EQ(early.upper, whole.upper);
  EXPECT_FALSE(stopped[static_cast<size_t>(early.outcome.runs)]);
}

TEST(Certify, TheSizeOfThePushMattersMost) {
  PushedStudy study;
  const KnownResults& results = PushedStudy::results();
  const std::vector<ValueInfluence> found = influences(study.stand.task, study.options, results);
  ASSERT_EQ(found.size(), 2u) << "time and link are always the same";
  EXPECT_EQ(found[0].name, "push: size");
  EXPECT_GT(found[0].correlation, 0.5);
  EXPECT_EQ(found[0].runs[0] + found[0].runs[1], 60);
  EXPECT_EQ(found[0].failures[0], 0);
  EXPECT_GT(found[0].failures[1], 3);
  const std::vector<long> worst = worst_cases(results, 10);
  ASSERT_EQ(worst.size(), 10u);
  for (size_t i = 1; i < worst.size(); ++i)
    EXPECT_GE(severity(*results[static_cast<size_t>(worst[i - 1])]),
              severity(*results[static_cast<size_t>(worst[i])]));
  EXPECT_TRUE(results[static_cast<size_t>(worst[0])]->failed());
}

TEST(Certify, LawsAreComparedInTheSameCases) {
  PushedStudy study;
  const KnownResults& dtad = PushedStudy::results();
  SimulateOptions open = StandingTask::options();
  open.controller = {ControllerKind::none, {}};
  const UncertainTask open_task(hoap1(), study.stand.series, study.stand.unknown, open);
  const KnownResults none = run_cases(open_task, study.options);
  const PairedComparison c = compare(dtad, none, 0.95);
  EXPECT_EQ(c.pairs, 60);
  EXPECT_LT(c.only_first, c.only_second);
  EXPECT_EQ(c.p_value, mcnemar(c.only_first, c.only_second));
  EXPECT_LT(c.difference.low, c.difference.high);
  EXPECT_LT(c.difference.low, 0);
}

// For rare failures of the simulated robot, the probability is the same as by brute force.
TEST(Certify, SubsetSimulationAgreesWithBruteForce) {
  const StandingTask stand(R"("pushes": [{"unit": "B", "size": {"uniform": [0.2, 1.1],
    "source": "assumed: test"}, "direction": {"uniform": [0, 360], "source": "assumed: test"},
    "time": 0.1}])");
  CertifyOptions options;
  options.most = 300;
  options.all = true;
  const KnownResults brute = run_cases(stand.task, options);
  const long failures =
      std::count_if(brute.begin(), brute.end(), [](const auto& r) { return r->failed(); });
  const RateInterval interval = clopper_pearson(failures, options.most, 0.99);
  SubsetOptions subset;
  subset.runs = 150;
  const SubsetResult r = subset_simulation(
      stand.task.dimension(),
      [&](const CaseNumbers& numbers) { return severity(stand.task.run(numbers)); },
      kFailedSeverity, 0.99, subset);
  EXPECT_TRUE(r.reached);
  EXPECT_LT(std::max(interval.low, r.interval.low), std::min(interval.high, r.interval.high))
      << failures << " of 300, subset " << r.probability;
}

}  // namespace
}  // namespace ayumi::test
