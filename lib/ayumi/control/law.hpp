#pragma once
// Inputs and outputs of every control law. A law (control/laws) has three functions: plan() returns
// the command of the coming tick, update() takes the estimate of one tick and fills a
// ControlOutput, and handover() returns the state from which the next law continues.

#include <string>
#include <vector>

#include "ayumi/control/command_plan.hpp"
#include "ayumi/motion/law_terms.hpp"

namespace ayumi {

/// The quantities that a law requires of the body: the reference of (14)-(21) and (24).
struct CogReference {
  Eigen::Vector3d zmp = Eigen::Vector3d::Zero();    ///< ref p_Z in the plan frame [m]
  double fz = 0;                                    ///< ref f_z [N]
  Eigen::Vector3d ddcog = Eigen::Vector3d::Zero();  ///< ref acceleration [m/s^2]
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();   ///< integral of this acceleration [m/s]
};

struct ControlOutput {
  Eigen::VectorXd target;  ///< servo targets [rad]
  RobotState reference;    ///< reference posture in the plan frame
  CogReference cog_reference;
  Eigen::Vector3d cog = Eigen::Vector3d::Zero();  ///< COG of the reference posture [m]
  LawTerms terms;
  TaskResiduals residuals;
  Eigen::VectorXd weight;          ///< W of (22) and (28) by dof; empty if nothing was resolved
  std::vector<std::string> notes;  ///< what was reduced in this tick: saturated joints, held limits
};

/// The state that one law passes on to the next.
struct Handover {
  RobotState reference;                            ///< reference posture in the plan frame
  Eigen::Vector3d dcog = Eigen::Vector3d::Zero();  ///< COG velocity of the reference [m/s]
  Eigen::VectorXd target;                          ///< last servo targets [rad]
  CommandSample plan;   ///< plan of the coming tick, with feet and support
  CommandPlan command;  ///< the pattern in the place to which the last law has moved it
};

}  // namespace ayumi
