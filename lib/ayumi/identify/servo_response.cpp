#include "ayumi/identify/servo_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace ayumi {

using Eigen::Index;

namespace {

// Step of the simulation [s]. Chosen: half of the shortest time constants of small servos (1 ms).
constexpr double kResponseStep = 0.0005;

// Torque at which the teeth of a gear lie firmly on a flank [N m]. Chosen: the friction of a small
// gear. With a smaller torque, the play is crossed linearly.
constexpr double kMeshTorque = 0.05;

}  // namespace

double command_at(const JointRecording& recording, double t) {
  const Index last = recording.command.size() - 1;
  const double at = t / recording.command_dt;
  if (at <= 0) return recording.command[0];
  const auto k = static_cast<Index>(at);
  if (k >= last) return recording.command[last];
  if (recording.law != CommandLaw::linear) return recording.command[k];
  const double u = at - static_cast<double>(k);
  return (1 - u) * recording.command[k] + u * recording.command[k + 1];
}

namespace {

// The mean of the command over a step that is not longer than its interval. In this way, even a
// command that is held changes smoothly with the delay.
double mean_command(const JointRecording& recording, double begin, double end) {
  if (recording.law == CommandLaw::linear) return command_at(recording, 0.5 * (begin + end));
  const double edge = std::floor(end / recording.command_dt) * recording.command_dt;
  const double share = std::clamp((end - edge) / (end - begin), 0.0, 1.0);
  const double half = 0.5 * recording.command_dt;
  return share * command_at(recording, edge + half) +
         (1 - share) * command_at(recording, edge - half);
}

}  // namespace

double sag(const ServoConstants& constants, double tau) {
  return -constants.compliance * tau -
         0.5 * constants.backlash * std::clamp(tau / kMeshTorque, -1.0, 1.0);
}

namespace {

struct Stretch {
  Index begin = 0, end = 0;  // first and last row
};

// The rows to simulate. They begin before a compared row, by the time that a joint needs to settle.
std::vector<Stretch> stretches(const JointRecording& recording) {
  const auto wait = static_cast<Index>(std::ceil(kSettle / recording.dt));
  std::vector<Stretch> found;
  for (const Index row : recording.compared) {
    if (found.empty() || row - found.back().end > 2 * wait)
      found.push_back({std::max<Index>(0, row - wait), row});
    found.back().end = row;
  }
  return found;
}

// Number of servos of one joint that are simulated side by side. Each step of a servo waits for the
// step before it, so that a processor computes the steps of several servos in the time of one.
// Chosen: this number keeps the processor busy.
constexpr Index kLanes = 4;

/// Fills the columns `first` to `first` + lanes - 1 of `theta`.
template <size_t lanes>
void respond(const JointRecording& recording, const ServoConstants* c, Eigen::MatrixXd& theta,
             Index first_column) {
  using Lanes = std::array<double, lanes>;
  const auto play = [&](size_t l, Index k) {
    return 0.5 * c[l].backlash * std::clamp(recording.torque[k] / kMeshTorque, -1.0, 1.0);
  };
  const auto set = [&](size_t l, Index k, double phi) {
    theta(k, first_column + static_cast<Index>(l)) = phi + c[l].offset - play(l, k);
  };
  const bool stepped = recording.law == CommandLaw::stepped;
  const int steps =
      stepped ? 1 : std::max(1, static_cast<int>(std::ceil(recording.dt / kResponseStep - 1e-9)));
  // The share of a step at which the equations hold: the middle for the implicit midpoint rule, the
  // end for implicit Euler.
  const double place = stepped ? 1 : 0.5;
  const double h = recording.dt / steps;
  for (const Stretch& stretch : stretches(recording)) {
    const Index first = stretch.begin, few = std::min<Index>(5, recording.measured.size() - first);
    Lanes phi, rate, target;
    for (size_t l = 0; l < lanes; ++l)
      phi[l] = recording.measured.segment(first, few).mean() - c[l].offset + play(l, first);
    if (recording.at_once) {
      for (Index k = first; k <= stretch.end; ++k) {
        const double rotor = recording.inertia[k] - recording.link_inertia[k];
        const double load = recording.torque[k] + rotor * recording.acceleration[k];
        for (size_t l = 0; l < lanes; ++l) {
          const double wanted =
              command_at(recording, recording.dt * static_cast<double>(k) - c[l].delay) -
              c[l].compliance * load;
          phi[l] = std::clamp(phi[l], wanted - c[l].dry, wanted + c[l].dry);
          set(l, k, phi[l]);
        }
      }
      continue;
    }
    for (size_t l = 0; l < lanes; ++l) {
      rate[l] = recording.rate[first];
      set(l, first, phi[l]);
    }
    for (Index k = first; k < stretch.end; ++k) {
      // The load of the joint without its own inertia, which the simulation itself moves.
      const double load0 =
          recording.torque[k] - recording.link_inertia[k] * recording.acceleration[k];
      const double load1 =
          recording.torque[k + 1] - recording.link_inertia[k + 1] * recording.acceleration[k + 1];
      Lanes whole, kept;
      for (size_t l = 0; l < lanes; ++l) {
        const double inertia =
            c[l].compliance * 0.5 * (recording.inertia[k] + recording.inertia[k + 1]);
        const double drag = h * c[l].damping, spring = place * h * h;
        whole[l] = inertia + place * (drag + spring);
        kept[l] = inertia - (1 - place) * (drag + spring);
      }
      for (int i = 0; i < steps; ++i) {
        const double share = (i + place) / steps;
        const double load = (1 - share) * load0 + share * load1;
        const double row = static_cast<double>(k) + static_cast<double>(i) / steps;
        for (size_t l = 0; l < lanes; ++l) {
          const double begin = recording.dt * row - c[l].delay;
          target[l] = l > 0 && c[l].delay == c[l - 1].delay
                          ? target[l - 1]
                          : mean_command(recording, begin, begin + h);
        }
        for (size_t l = 0; l < lanes; ++l) {
          const double momentum =
              kept[l] * rate[l] + h * (target[l] - phi[l] - c[l].compliance * load);
          // Dry friction takes momentum from the joint until it rests.
          const double friction = h * c[l].dry, taken = std::clamp(momentum, -friction, friction);
          const double next = (momentum - taken) / whole[l];
          phi[l] += h * ((1 - place) * rate[l] + place * next);
          rate[l] = next;
        }
      }
      for (size_t l = 0; l < lanes; ++l) set(l, k + 1, phi[l]);
    }
  }
}

}  // namespace

void servo_responses(const JointRecording& recording, const std::vector<ServoConstants>& constants,
                     Eigen::MatrixXd& theta) {
  const auto count = static_cast<Index>(constants.size());
  theta.resize(recording.measured.size(), count);
  theta.colwise() = recording.measured;
  Index at = 0;
  for (; at + kLanes <= count; at += kLanes)
    respond<kLanes>(recording, &constants[static_cast<size_t>(at)], theta, at);
  const ServoConstants* const rest = constants.data() + at;
  if (count - at == 3) respond<3>(recording, rest, theta, at);
  if (count - at == 2) respond<2>(recording, rest, theta, at);
  if (count - at == 1) respond<1>(recording, rest, theta, at);
}

}  // namespace ayumi
