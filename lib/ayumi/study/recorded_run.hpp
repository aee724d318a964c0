#pragma once
// A run without disturbances in which the robot stands, and the set of states around it from which
// another run of the same plan stands too. docs/theory_pushes.md, "Early verdicts of pushes", has
// the proof and its assumption.

#include <vector>

#include "ayumi/sim/simulator.hpp"

namespace ayumi {

class RecordedRun {
 public:
  explicit RecordedRun(const World& world);

  /// Appends the state after the last tick that was done. The ticks must grow.
  void record(const Simulator& run);

  /// Distance of the state of `run` after its last tick from the recorded state. It is 1 at the
  /// edge of the set, and infinite if this tick was not recorded.
  double deviation(const Simulator& run) const;

  /// The part of deviation() for the DCM and the tilts alone, which decide whether the robot
  /// stands. A landing that comes a moment earlier or later moves the ZMP far during this moment.
  double drift(const Simulator& run) const;

  /// Whether that state is in the set, or in a smaller set if `share` is below 1. It is false if
  /// too little time is left for the robot to come to rest.
  bool contains(const Simulator& run, double share = 1) const;

  /// The turn of the reference of `run` relative to the recorded reference [rad]. The law reduces
  /// it to 0.
  double reference_turn(const Simulator& run) const;

  /// The bounds of the set for the deviation of the DCM, in units of z, and for the tilts of the
  /// base against the reference and of the stance foot [rad].
  static double dcm_bound();
  static double tilt_bound();

 private:
  /// A state in the plan frame, and therefore without the place and the heading in the world.
  struct State {
    double time = 0;             // time [s]
    double height = 0;           // height of the planned COG over the planned ZMP [m]
    Eigen::Vector2d dcm, zmp;    // estimated DCM and ZMP [m]
    Eigen::Vector2d tilt;        // tilt of the base against the reference [rad]
    Eigen::Vector3d foot_tilt;   // tilt of the stance foot against the plan [rad]
    Eigen::VectorXd deflection;  // deflection of the joints from the reference [rad, m]
    Eigen::Quaterniond reference_attitude;
    Eigen::VectorXd reference_theta;  // reference of the joints [rad, m]
    Eigen::Vector3d position;         // place of the base in the world [m]
    Eigen::Quaterniond attitude;      // attitude of the base in the world
  };
  static State state_of(const Simulator& run);
  static void take_dcm(const Simulator& run, State& state);
  static double dcm_drift(const State& here, const State& there);
  static double drift(const State& here, const State& there);
  const State* state_at(long tick) const;

  std::vector<State> states_;
  std::vector<long> ticks_;  // ticks of the states
  bool same_everywhere_;     // whether the ground is the same in every direction
};

}  // namespace ayumi
