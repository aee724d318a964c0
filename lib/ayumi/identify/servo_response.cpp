#include "ayumi/identify/servo_response.hpp"

#include <algorithm>
#include <cmath>

namespace ayumi {

using Eigen::Index;

namespace {

// Step of the simulation [s]. Chosen: half of the shortest time constants of small servos (1 ms).
constexpr double kResponseStep = 0.0005;

// Torque at which the teeth of a gear lie firmly on a flank [N m]. Chosen: the friction of a small
// gear; within it the play is crossed linearly.
constexpr double kMeshTorque = 0.05;

}  // namespace

double command_at(const JointRecording& recording, double t) {
  const Index last = recording.command.size() - 1;
  const double at = t / recording.command_dt;
  if (at <= 0) return recording.command[0];
  const auto k = static_cast<Index>(at);
  if (k >= last) return recording.command[last];
  if (recording.held) return recording.command[k];
  const double u = at - static_cast<double>(k);
  return (1 - u) * recording.command[k] + u * recording.command[k + 1];
}

namespace {

// Mean of the command over a step that is not longer than its interval. A held command so changes
// smoothly with the delay.
double mean_command(const JointRecording& recording, double begin, double end) {
  if (!recording.held) return command_at(recording, 0.5 * (begin + end));
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

void servo_response(const JointRecording& recording, const ServoConstants& c,
                    Eigen::VectorXd& theta) {
  const Index rows = recording.measured.size();
  theta.resize(rows);
  const auto play = [&](Index k) {
    return 0.5 * c.backlash * std::clamp(recording.torque[k] / kMeshTorque, -1.0, 1.0);
  };
  if (recording.at_once) {
    double phi = recording.measured.head(std::min<Index>(rows, 5)).mean() - c.offset + play(0);
    for (Index k = 0; k < rows; ++k) {
      const double rotor = recording.inertia[k] - recording.link_inertia[k];
      const double load = recording.torque[k] + rotor * recording.acceleration[k];
      const double target = command_at(recording, recording.dt * static_cast<double>(k) - c.delay) -
                            c.compliance * load;
      phi = std::clamp(phi, target - c.dry, target + c.dry);
      theta[k] = phi + c.offset - play(k);
    }
    return;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(recording.dt / kResponseStep - 1e-9)));
  const double h = recording.dt / steps;
  double phi = recording.measured.head(std::min<Index>(rows, 5)).mean() - c.offset + play(0);
  double rate = recording.start_rate;
  theta[0] = phi + c.offset - play(0);
  for (Index k = 0; k + 1 < rows; ++k) {
    // What loads the joint beside its own inertia, which the simulation moves itself.
    const double load0 =
        recording.torque[k] - recording.link_inertia[k] * recording.acceleration[k];
    const double load1 =
        recording.torque[k + 1] - recording.link_inertia[k + 1] * recording.acceleration[k + 1];
    const double inertia = c.compliance * 0.5 * (recording.inertia[k] + recording.inertia[k + 1]);
    const double keep = 0.5 * h * c.damping + 0.25 * h * h;
    const double whole = inertia + keep, friction = h * c.dry;
    for (int i = 0; i < steps; ++i) {
      const double share = (i + 0.5) / steps;
      const double begin =
          recording.dt * (static_cast<double>(k) + static_cast<double>(i) / steps) - c.delay;
      const double target = mean_command(recording, begin, begin + h);
      const double load = c.compliance * ((1 - share) * load0 + share * load1);
      const double momentum = (inertia - keep) * rate + h * (target - phi - load);
      // Dry friction takes momentum until the joint rests.
      const double taken = std::clamp(momentum, -friction, friction);
      const double next = (momentum - taken) / whole;
      phi += 0.5 * h * (rate + next);
      rate = next;
    }
    theta[k + 1] = phi + c.offset - play(k + 1);
  }
}

}  // namespace ayumi
