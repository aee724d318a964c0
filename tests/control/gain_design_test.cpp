// The poles of the loop agree with closed forms and with stepping the loop in time.
#include "ayumi/control/gain_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

#include "ayumi/base/error.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/model/gravity.hpp"
#include "tests/support/error_message.hpp"

namespace ayumi {
namespace {

using Complex = std::complex<double>;

struct Ankle {
  double mass = 6.5, height = 0.22, stiffness = 150, damping = 3, tick = 1e-3, delay = 0.003;
};

/// The loop of a point mass on an ankle: x'' = w^2 (x + s (target - x - T x')). Rates are taken at
/// the end of a tick.
LoopModel loop_of(const Ankle& a) {
  LoopModel loop{.height = a.height, .tick = a.tick, .delay = a.delay};
  const double w2 = kGravity / a.height, s = a.stiffness / (a.mass * kGravity * a.height);
  const double T = a.damping / a.stiffness;
  Eigen::Matrix2d motion, input;
  motion << 0, 1, w2 * (1 - s), -w2 * s * T;
  input << 0, 0, w2 * s, w2 * s * T;
  loop.body = (Eigen::Matrix2d::Identity() - a.tick * motion).inverse();
  loop.reference = loop.body * (a.tick * input);
  loop.cog = Eigen::RowVector2d(1, 0);
  loop.dcog = Eigen::RowVector2d(0, 1);
  loop.zmp = Eigen::RowVector2d(s, s * T);
  loop.zmp_reference << -s, -s * T;
  return loop;
}

void expect_pole(const LoopAnalysis& analysis, Complex pole, double tolerance) {
  double nearest = 1e300;
  for (const Complex& p : analysis.poles) nearest = std::min(nearest, std::abs(p - pole));
  EXPECT_LT(nearest, tolerance * std::abs(pole)) << pole;
}

// Without the short-term loop, body and reference are independent: two quadratics in s.
TEST(GainDesign, PolesOfTheSeparateParts) {
  DtadParams p;
  p.zmp_gain = 0;
  p.pull_rate = 1.5;
  p.pull_damping = 2;
  p.offset_time = 0;
  p.rocking_damping = 0;
  const Ankle loop{.tick = 1e-7, .delay = 0};
  const LoopAnalysis analysis = analyze_loop(loop_of(loop), p);
  const double w = std::sqrt(kGravity / loop.height);
  const double s = loop.stiffness / (loop.mass * kGravity * loop.height);
  const double b = w * w * s * loop.damping / loop.stiffness, c = w * w * (s - 1);
  for (double sign : {-1.0, 1.0}) {
    expect_pole(analysis, -b / 2 + sign * std::sqrt(Complex(b * b / 4 - c)), 2e-6);
    expect_pole(analysis, w * (-2.0 + sign * std::sqrt(Complex(4 - 1.5 * 1.5))), 1e-3);
  }
  EXPECT_TRUE(analysis.stable);
}

/// The growth rate of the loop stepped in time, written once more without matrices [1/s].
double stepped_growth(const Ankle& loop, const DtadParams& p, double seconds) {
  const double w = std::sqrt(kGravity / loop.height), dt = loop.tick;
  const double s = loop.stiffness / (loop.mass * kGravity * loop.height);
  const double T = loop.damping / loop.stiffness;
  double x = 1e-3, v = 0, xr = 0, vr = 0, zf = 0, zd = 0, target = 0;
  struct Reading {
    double x, v, z;
  };
  std::deque<Reading> late;
  std::vector<double> size;
  const int ticks = static_cast<int>(std::lround(seconds / dt));
  for (int k = 0; k < ticks; ++k) {
    late.push_back({x, v, -s * (target - x - T * v)});
    if (late.size() > 1 + static_cast<size_t>(std::lround(loop.delay / dt))) late.pop_front();
    const Reading m = late.front();
    zf += (1 - std::exp(-dt * w / p.zmp_filter)) * (m.z - zf);
    const double gap = zf - (1 + p.pole_ratio) * (m.x + m.v / w) - zd;
    zd += dt * w / p.offset_time * gap;
    vr += dt * (p.zmp_gain * w * w * gap + p.rocking_damping * w * (m.v - vr) -
                p.pull_rate * p.pull_rate * w * w * xr - 2 * p.pull_damping * w * vr);
    xr += dt * vr;
    target = xr + T * vr;
    for (int i = 0; i < 400; ++i) {
      v += dt / 400 * w * w * (x + s * (target - x - T * v));
      x += dt / 400 * v;
    }
    size.push_back(std::abs(x) + std::abs(v) / w);
  }
  // The largest value of the last tenth is compared with the largest of the tenth in the middle.
  const auto largest = [&](double from) {
    const auto begin = size.begin() + static_cast<long>(from * ticks);
    return *std::max_element(begin, begin + ticks / 10);
  };
  return std::log(largest(0.9) / largest(0.5)) / (0.4 * seconds);
}

TEST(GainDesign, SlowestModeIsThatOfTheSteppedLoop) {
  DtadParams p;
  const Ankle soft;
  EXPECT_NEAR(stepped_growth(soft, p, 8), -analyze_loop(loop_of(soft), p).decay, 0.05);
  p.zmp_gain = 40;
  p.zmp_filter = 0.4;
  const Ankle late{.delay = 0.015};
  const LoopAnalysis unstable = analyze_loop(loop_of(late), p);
  EXPECT_FALSE(unstable.stable);
  EXPECT_NEAR(stepped_growth(late, p, 3), -unstable.decay, 0.05 - 0.03 * unstable.decay);
}

TEST(GainDesign, PolesGiveKAndD) {
  const DtadParams p = gains_from_poles({-1, 0}, {-0.25, 0});
  EXPECT_DOUBLE_EQ(*p.k, 1.25);  // this is 1 + q
  EXPECT_DOUBLE_EQ(*p.d, 1.25);
  const DtadParams pair = gains_from_poles({-1, 0.5}, {-1, -0.5});
  EXPECT_DOUBLE_EQ(*pair.k, 2.25);
  EXPECT_DOUBLE_EQ(*pair.d, 2);
  EXPECT_THROW(gains_from_poles({-1, 0}, {0.1, 0}), Error);
  EXPECT_THROW(gains_from_poles({-1, 0.5}, {-1, 0.5}), Error);
}

TEST(GainDesign, Hoap1DefaultsAreStableAndTooMuchIsRefused) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const std::vector<LoopModel> loops = stance_loops(model, model.limits(), 0.22, 0.001);
  ASSERT_EQ(loops.size(), 4u);
  DtadParams p = dtad_params(model, {ControllerKind::dtad, {}});
  EXPECT_NO_THROW(refuse_unstable(loops, p));
  p.zmp_filter = 2;
  p.zmp_gain = 50;
  try {
    refuse_unstable(loops, p);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the loop is unstable with"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("ka below"), std::string::npos) << error.what();
  }
}

// If no ka alone helps, other gains do, or the refusal asks for stiffer servos.
TEST(GainDesign, SoftServosGetGainsThatAreStable) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  const DtadParams defaults;
  const auto loops_with = [&](double stiffness) {
    ActuatorLimits actuators = model.limits();
    for (ServoDescription& servo : actuators.servo) {
      servo.kp *= stiffness;
      servo.kd *= stiffness;
    }
    return stance_loops(model, actuators, 0.22, 0.001);
  };
  const std::vector<LoopModel> stiff = loops_with(1);
  ASSERT_TRUE(weakest_loop(stiff, defaults).analysis.stable);
  const auto unchanged = nearest_stable_gains(stiff, defaults);
  ASSERT_TRUE(unchanged);
  EXPECT_TRUE(changed_loop_gains(*unchanged, defaults).empty());
  int mended = 0;
  for (double stiffness = 0.8; stiffness > 0.01; stiffness *= 0.8) {
    const std::vector<LoopModel> loops = loops_with(stiffness);
    if (weakest_loop(loops, defaults).analysis.stable) continue;
    if (largest_stable_ka(loops, defaults, 1) > 1e-6) continue;
    const auto gains = nearest_stable_gains(loops, defaults);
    const std::string refusal = test::error_message([&] { refuse_unstable(loops, defaults); });
    if (gains) {
      ++mended;
      EXPECT_TRUE(weakest_loop(loops, *gains).analysis.stable) << stiffness;
      EXPECT_NE(refusal.find(changed_loop_gains(*gains, defaults).front().first + " = "),
                std::string::npos)
          << refusal;
    } else {
      EXPECT_NE(refusal.find("Use stiffer servos"), std::string::npos) << refusal;
    }
  }
  EXPECT_GT(mended, 0);
}

// Every gain that is out of range is refused with its value.
TEST(GainDesign, GainsOutOfRangeAreRefused) {
  const RobotModel model = load_robot(AYUMI_SOURCE_DIR "/robots/hoap1");
  using Gains = std::vector<std::pair<std::string, double>>;
  const std::tuple<ControllerKind, Gains, std::string> cases[] = {
      {ControllerKind::dtad, {{"q", -1}}, "gain q is -1; a gain must be from 0 to 1e+06"},
      {ControllerKind::dtad, {{"q", NAN}}, "gain q is nan; a gain must be from 0 to"},
      {ControllerKind::dtad, {{"q", 1e160}}, "gain q is 1e+160; a gain must be from 0 to"},
      {ControllerKind::dtad, {{"qq", 1}}, "dtad has no gain 'qq'; did you mean 'q'?"},
      {ControllerKind::dtad, {{"sag", 1}}, " (known: k, d, "},
      {ControllerKind::preview, {{"k", 1}}, "preview has no gain 'k'"},
      {ControllerKind::dtad, {{"q", 0}}, "q is 0; it must be above 0, because K = 1 + q"},
      {ControllerKind::dtad, {{"k", 2}}, "k and d must be given together"},
      {ControllerKind::dtad, {{"k", 2}, {"d", 1}, {"q", 1}}, "Give either q, or k and d"},
      {ControllerKind::dtad, {{"k", 1}, {"d", 1}}, "k = 1, d = 1 never bring the COG back"},
      {ControllerKind::dtad, {{"tau_z", 0}}, "tau_z is 0; it must be above 0"},
      {ControllerKind::dtad, {{"as_printed", 2}}, "as_printed is 2; it must be 0 or 1"},
      {ControllerKind::preview, {{"effort", 2}}, "effort is 2; it must be from 1e-9 to 1"},
      {ControllerKind::preview, {{"horizon", 51}}, "horizon is 51; it must be above 0 and at most"},
      {ControllerKind::foot_guided, {{"soonest", 0}}, "soonest is 0; it must be positive"},
      {ControllerKind::dcm_step, {{"place", 0}}, "place is 0; it must be positive"},
      {ControllerKind::dcm_step, {{"slowest", 2}}, "slowest is 2; it must be from 0.1 to 1"}};
  for (const auto& [kind, gains, part] : cases) {
    ControllerSpec spec;
    spec.type.kind = kind;
    spec.gains = gains;
    const std::string message =
        test::error_message([&] { dtad_params(model, spec); }, ErrorCode::usage);
    EXPECT_NE(message.find(part), std::string::npos) << message << " / " << part;
  }
}

// If no gains fulfil what is asked for, the refusal names the value and the reason.
TEST(GainDesign, RefusesWishesThatNoGainsFulfil) {
  const auto refused = [](const GainWishes& wishes) {
    return test::error_message([&] { design_gains(6, wishes, {}); }, ErrorCode::usage);
  };
  const auto with = [](Complex a, Complex b) {
    GainWishes wishes;
    wishes.poles = {a, b};
    return wishes;
  };
  EXPECT_EQ(refused(with({-1, 2}, {-1, 3})), "poles: give two real poles or a conjugate pair");
  EXPECT_EQ(refused(with(-1, 2)),
            "a pole with the real part 2 is not possible: the real part must be below 0, because "
            "otherwise the COG never comes back");
  EXPECT_EQ(refused(with(3, -1)).substr(0, 29), "a pole with the real part 3 i");
  EXPECT_EQ(test::error_message([] { gains_from_poles(-1, 0, {}); }, ErrorCode::usage),
            "poles: the real part 0 is not below 0, so the COG would never come back");
  GainWishes wishes;
  wishes.absorb = 1;
  EXPECT_EQ(refused(wishes),
            "a short-term absorption of 1 is not possible: the absorption must be at least 0 and "
            "below 1");
  wishes.absorb = 0;
  EXPECT_EQ(design_gains(6, wishes, {}).zmp_gain, 0);
  wishes = {};
  wishes.return_time = 0;
  EXPECT_EQ(refused(wishes), "a return time of 0 is not possible: the time must be above 0 s");
  wishes.return_time = 1e-300;
  EXPECT_EQ(refused(wishes),
            "the wishes need a gain that is not possible: gain ks is 1.667e+299; a gain must be "
            "from 0 to 1e+06");
  // Only the gains of wishes are judged: by the printed sign, D is negative.
  DtadParams printed;
  printed.as_printed = 1;
  EXPECT_EQ(design_gains(6, {}, printed).as_printed, 1);
  wishes = {};
  wishes.zmp_filter = -1;
  EXPECT_EQ(refused(wishes), "a ZMP filter time of -1 is not possible: the time must be above 0 s");
  wishes = {};
  wishes.forget = -0.5;
  EXPECT_EQ(refused(wishes),
            "a forgetting time of -0.5 is not possible: the time must be at least 0 s");
  wishes.forget = 0;
  EXPECT_EQ(design_gains(6, wishes, {}).offset_time, 0);
}

}  // namespace
}  // namespace ayumi
