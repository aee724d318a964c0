#pragma once
// Reads from a run's log what pictures and plots need: the sample at any time, the pushes, the
// ground.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// The last time of the log [s]. Throws Error(usage) if the log has no samples.
double duration(const SimulationLog& log);

/// A text such as " (l_knee at 2.90 s)", which follows the share; "" if its place is unknown.
std::string place_in_brackets(const SimulationLog& log, const JointShare& share);

/// The sample at `t`, which is limited to the times of the log. Continuous quantities are
/// interpolated between ticks; contacts and push are those of the tick before.
SimulationSample sample_at(const SimulationLog& log, double t);

/// The floor's frame in the world at `t`: the slope and every motion of the floor, including those
/// of the scenario. Objects on the ground are given in this frame.
Eigen::Isometry3d floor_at(const SimulationLog& log, double t);

/// The frame of the ground plane at `t`: the floor's frame, raised to the plane; z is its normal.
Eigen::Isometry3d ground_at(const SimulationLog& log, double t);

/// Whether the floor's frame changes during the run.
bool floor_moves(const SimulationLog& log);

/// The frame in which marks on the ground are drawn at `t`: the ground plane, or the level above it
/// on which the higher foot in contact stands.
Eigen::Isometry3d marked_ground(const SimulationLog& log, double t, const SimulationSample& sample);

/// A stretch of ticks with an external force.
struct PushRecord {
  double begin = 0, end = 0;  ///< first instant and the instant after the last [s]
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< place of the push at its start, world [m]
  Eigen::Vector3d from_cog = Eigen::Vector3d::Zero();  ///< the same place relative to the COG [m]
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();   ///< time integral of the force [N s]
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();      ///< largest force [N]
};

/// Pushes in the order of time.
std::vector<PushRecord> pushes(const SimulationLog& log);

/// The value of a push for people, such as "1.1 N s" for a short push (up to 0.2 s) or "12 N" for a
/// long one.
std::string push_text(const PushRecord& push);

/// A stretch of ticks in which both feet are planned to be in the air.
struct FlightRecord {
  double begin = 0, end = 0;  ///< first instant and the instant after the last [s]
};

/// Flights in the order of time.
std::vector<FlightRecord> flights(const SimulationLog& log);

/// The instant that is most worth showing [s]: shortly after the first push; if there is none, the
/// fall; if there is none, the middle of the first flight, and otherwise the posture with the
/// largest change of a joint since the start. If no joint moves, it is the middle of the run.
double telling_instant(const SimulationLog& log);

/// `count` instants worth showing [s], in the order of time. They are: beginning and end, pushes,
/// the fall, the apex of each flight, then postures in which joints or the COG turn back or come to
/// rest (those with larger moves first), and instants that fill the longest gaps. In a walk, some
/// of them show the robot on the left foot and some on the right foot. In a run with flights, all
/// instants lie around these. In another run with pushes, they lie around the pushes, from the
/// beginning of the step or kick in which the first push acts. If the robot moves more before or
/// after this part, that time is included.
std::vector<double> telling_instants(const SimulationLog& log, int count);

/// The event at an instant, such as "push 1.1 N s", "apex" or "falls"; empty if there is none.
std::string instant_text(const SimulationLog& log, double t);

/// The time from which the verdict holds [s]: the fall, or the instant from which on a standing
/// robot keeps its posture, its place and its contacts. If the robot does not come to rest, it is
/// the end of the run.
double verdict_instant(const SimulationLog& log);

}  // namespace ayumi
