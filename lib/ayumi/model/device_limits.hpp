#pragma once
// Largest values of a robot's servos and sensors, in its sidecar and where a study draws them. They
// catch a wrong unit.

namespace ayumi {

/// Delay of a servo [s]. Chosen: hobby servos have 0.01 to 0.03 s.
inline constexpr double kMostServoDelay = 0.1;
/// Backlash or dead band of a servo [rad]. Chosen: hobby servos have 0.01 rad.
inline constexpr double kMostServoPlay = 0.2;
/// Latency of a sensor [s]. Chosen: older readings are of no use to a balance law.
inline constexpr double kMostSensorLatency = 1;

}  // namespace ayumi
