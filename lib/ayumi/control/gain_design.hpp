#pragma once
// Gains from poles, and whether the whole linear loop they close is stable: the robot on its servos
// and soles, filter and accepted offset, delays, control tick. docs/theory_gains.md, "Gain design".

#include <array>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "ayumi/control/laws/dtad.hpp"
#include "ayumi/control/stance_loop.hpp"

namespace ayumi {

struct LoopAnalysis {
  std::vector<std::complex<double>> poles;  ///< continuous equivalents, slowest decay first [1/s]
  bool stable = false;
  double decay = 0;      ///< of the slowest mode; negative when it grows [1/s]
  double frequency = 0;  ///< of that mode [Hz]
};

/// Poles of the loop under the law of dtad.cpp.
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

/// What a designer may ask for, in seconds. A value that is not set leaves the gain unchanged.
struct GainWishes {
  std::optional<std::array<std::complex<double>, 2>> poles;  ///< of the COG under (18)(19) [1/s]
  std::optional<double> absorb;       ///< share of a ZMP error taken up at once, 0 to 1
  std::optional<double> return_time;  ///< of the reference COG back to the command [s]
  std::optional<double> zmp_filter;   ///< time constant of the measured ZMP [s]
  std::optional<double> forget;       ///< of a lasting offset of the ZMP [s]; 0: never
};

/// Gains of a robot with this omega: K, D from the poles; ka = share / (1 - share), since a stiff
/// robot's ZMP is [(x - cmdddx / w2) + ka refZ] / (1 + ka); ks = kd = 1 / (omega T), a double pole
/// at -1 / T. Throws Error(usage) that names the value that is not possible.
DtadParams design_gains(double omega, const GainWishes& wishes, DtadParams params = {});

/// Largest ka with which all loops are stable, other gains as they are; 0 when none is.
double largest_stable_ka(const std::vector<LoopModel>& loops, DtadParams params, double most = 20);

/// Gains with which all loops are stable: ks and kd together, damp, ka and tau_z, with as few and
/// as small changes as possible. Of the gains that are tried, these are the first whose errors
/// decay within kSlowestDecay / omega, otherwise the ones with the fastest decay. Empty if none of
/// them is stable.
std::optional<DtadParams> nearest_stable_gains(const std::vector<LoopModel>& loops,
                                               const DtadParams& params);

/// "ks = 3, kd = 3": the gains in which `params` differs from `other`, of those that
/// nearest_stable_gains() changes, by their names in files.
std::vector<std::pair<std::string, double>> changed_loop_gains(const DtadParams& params,
                                                               const DtadParams& other);

/// Throws Error(usage) with the mode that grows and with stable gains nearby.
void refuse_unstable(const std::vector<LoopModel>& loops, const DtadParams& params);

/// Why a robot should not be run with a controller at this COG height, in the words of
/// refuse_unstable(); empty if the loop is stable, for demonstrations (dtad-literal, as_printed),
/// other controllers and legs without servos.
std::string instability(const RobotModel& model, const ActuatorLimits& actuators,
                        const ControllerSpec& spec, double height, double tick);

}  // namespace ayumi
