#pragma once
// Gains from poles, and a test whether the whole linear loop that they close is stable: the robot
// on its servos and soles, filter and accepted offset, delays, control tick. docs/theory_gains.md,
// "Gain design".

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/stance_loop.hpp"

namespace ayumi {

struct LoopAnalysis {
  /// Poles of the equivalent continuous loop, the slowest decay first [1/s]. Empty if the numbers
  /// of the loop are too large for a computation (then the decay is -infinity), or if no error
  /// lasts longer than a tick (infinity).
  std::vector<std::complex<double>> poles;
  bool stable = false;   ///< whether no error grows faster than the loop tolerates
  double decay = 0;      ///< decay of the slowest mode; negative if it grows [1/s]
  double frequency = 0;  ///< frequency of that mode [Hz]
};

/// The poles of the loop under the law of dtad.cpp.
LoopAnalysis analyze_loop(const LoopModel& loop, const DtadParams& params);

/// The loop whose slowest mode comes nearest to the growth that the loop tolerates.
struct WeakestLoop {
  size_t index = 0;
  LoopAnalysis analysis;
};
WeakestLoop weakest_loop(const std::vector<LoopModel>& loops, const DtadParams& params);

/// K and D (times omega) of (18)(19) that give the COG the poles p1, p2 in units of omega: both
/// real or a conjugate pair, Re < 0. Throws Error(usage) otherwise.
DtadParams gains_from_poles(std::complex<double> p1, std::complex<double> p2,
                            DtadParams params = {});

/// The wishes of the designer, as quantities with a physical meaning instead of gains. A value that
/// is not set leaves its gain unchanged.
struct GainWishes {
  /// Poles of the COG under (18)(19) [1/s].
  std::optional<std::array<std::complex<double>, 2>> poles;
  std::optional<double> absorb;  ///< share of a ZMP error that is absorbed at once, 0 to 1
  /// Time in which the reference COG returns to the command [s].
  std::optional<double> return_time;
  std::optional<double> zmp_filter;  ///< time constant of the measured ZMP [s]
  /// Time after which a lasting offset of the ZMP is accepted [s]; 0 if this never happens.
  std::optional<double> forget;
};

/// The gains of a robot with this omega. K and D follow from the poles. ka = share / (1 - share),
/// because the ZMP of a stiff robot is [(x - cmdddx / w2) + ka refZ] / (1 + ka). A double pole at
/// -1 / T gives ks = kd = 1 / (omega T). Throws Error(usage) that names the value that is not
/// possible.
DtadParams design_gains(double omega, const GainWishes& wishes, DtadParams params = {});

/// The largest ka, up to `most`, with which all loops are stable while the other gains stay as they
/// are; 0 if there is none.
double largest_stable_ka(const std::vector<LoopModel>& loops, DtadParams params, double most = 20);

/// Gains with which all loops are stable. Only ks and kd (together), damp, ka and tau_z are
/// changed, in as few and as small steps as possible. The result is the first tried choice whose
/// errors decay within kSlowestDecay / omega (gain_design.cpp), or else the choice with the fastest
/// decay. Empty if no choice is stable.
std::optional<DtadParams> nearest_stable_gains(const std::vector<LoopModel>& loops,
                                               const DtadParams& params);

/// The gains in which `params` differs from `other`, by their names in files: "ks = 3, kd = 3".
/// Only gains that nearest_stable_gains() changes are compared.
std::vector<std::pair<std::string, double>> changed_loop_gains(const DtadParams& params,
                                                               const DtadParams& other);

/// If a loop is unstable, throws Error(usage) that names the growing mode and stable gains nearby.
void refuse_unstable(const std::vector<LoopModel>& loops, const DtadParams& params);

/// The reason why a robot should not be run with a controller at this COG height [m] and with this
/// tick [s], in the words of refuse_unstable(). Empty if the loop is stable, and for demonstrations
/// (dtad-literal, as_printed), other controllers and legs without servos.
std::string instability(const RobotModel& model, const ActuatorLimits& actuators,
                        const ControllerSpec& spec, double height, double tick);

}  // namespace ayumi
