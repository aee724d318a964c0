#pragma once
// Largest values of a robot's servos and sensors. They apply to the sidecar and to the values that
// a study draws, and catch a wrong unit.

namespace ayumi {

/// Largest delay of a servo [s]. Chosen: hobby servos have 0.01 to 0.03 s.
inline constexpr double kMostServoDelay = 0.1;
/// Largest backlash or dead band of a servo [rad]. Chosen: hobby servos have 0.01 rad.
inline constexpr double kMostServoPlay = 0.2;
/// Largest latency of a sensor [s]. Chosen: older readings are of no use to a balance law.
inline constexpr double kMostSensorLatency = 1;

}  // namespace ayumi
