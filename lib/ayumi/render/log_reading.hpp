#pragma once
// A run's log as pictures and plots need it: the sample at any time, the pushes, the ground.

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "ayumi/sim/simulation_log.hpp"

namespace ayumi {

/// Last time of the log [s]. Throws Error(usage) when the log has no samples.
double duration(const SimulationLog& log);

/// " (l_knee at 2.90 s)", behind the share; "" where its place is unknown.
std::string place_in_brackets(const SimulationLog& log, const JointShare& share);

/// The sample at `t` (held within the log), continuous quantities interpolated between ticks;
/// contacts and push as of the tick before.
SimulationSample sample_at(const SimulationLog& log, double t);

/// The floor's frame in the world at `t`: the slope and every motion of the floor, those of the
/// scenario included. Objects on the ground are given in this frame.
Eigen::Isometry3d floor_at(const SimulationLog& log, double t);

/// Frame of the ground plane at `t`: the floor's, raised to the plane; z is its normal.
Eigen::Isometry3d ground_at(const SimulationLog& log, double t);

/// Whether the floor's frame changes during the run.
bool floor_moves(const SimulationLog& log);

/// Where marks on the ground are drawn at `t`: the ground plane, or the level above it that the
/// higher foot in contact stands on.
Eigen::Isometry3d marked_ground(const SimulationLog& log, double t, const SimulationSample& sample);

/// A stretch of ticks with an external force.
struct PushRecord {
  double begin = 0, end = 0;                           ///< [s]; end excluded
  Eigen::Vector3d point = Eigen::Vector3d::Zero();     ///< at its start, world [m]
  Eigen::Vector3d from_cog = Eigen::Vector3d::Zero();  ///< the same from the COG [m]
  Eigen::Vector3d impulse = Eigen::Vector3d::Zero();   ///< time integral of the force [N s]
  Eigen::Vector3d peak = Eigen::Vector3d::Zero();      ///< largest force [N]
};

/// Pushes in the order of time.
std::vector<PushRecord> pushes(const SimulationLog& log);

/// Its value for people: "1.1 N s" for a short push (up to 0.2 s), "12 N" for a long one.
std::string push_text(const PushRecord& push);

/// A stretch of ticks in which both feet are planned to be in the air.
struct FlightRecord {
  double begin = 0, end = 0;  ///< [s]; end excluded
};

/// Flights in the order of time.
std::vector<FlightRecord> flights(const SimulationLog& log);

/// The instant worth showing first: shortly after the first push, without one the fall, then the
/// middle of the first flight, else the posture with the largest change of a joint since the start;
/// if no joint moves, the middle of the run [s].
double telling_instant(const SimulationLog& log);

/// `count` instants worth showing [s], in the order of time: begin and end, pushes, the fall, the
/// apex of each flight, then postures in which joints or the COG turn back or come to rest, the
/// larger their move the sooner, and what fills the longest gaps; of a walk on both feet. They lie
/// around pushes, with the step or kick in which the first one falls, or around flights, unless the
/// robot moves more elsewhere.
std::vector<double> telling_instants(const SimulationLog& log, int count);

/// What happens at an instant: "push 1.1 N s", "apex", "falls"; empty for nothing special.
std::string instant_text(const SimulationLog& log, double t);

/// Time from which the verdict holds [s]: the fall, or the instant from which on a robot that
/// stands keeps its posture, its place and its contacts. Its end where it does not come to rest.
double verdict_instant(const SimulationLog& log);

}  // namespace ayumi
