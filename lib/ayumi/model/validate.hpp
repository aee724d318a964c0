#pragma once
// Conditions that a robot description has to meet before a RobotModel is built. Each function
// throws Error(bad_model) "file: link or joint: what is wrong, what to do".

#include <string>
#include <vector>

#include "ayumi/model/robot_description.hpp"

namespace ayumi {

/// Largest mass [kg] and length [m] of a robot. Chosen: a larger value is in a wrong unit.
inline constexpr double kLargestMass = 1e6;
inline constexpr double kLargestLength = 1e4;
/// Largest number of links of a robot, and of joints. Chosen: humanoids with hands have about a
/// hundred; the tree of the robot descends a chain of links by recursion, and the time of some
/// steps grows with the square of the number.
inline constexpr size_t kMostLinks = 1000;
/// The message with which a reader refuses a file with more "links" or "joints", before it works on
/// them.
std::string too_many(const std::string& what);
/// Shortest and longest servo period [s]. Chosen: a thousandth of the shortest period and a hundred
/// times the longest period of known servos; another value is in a wrong unit. With the shortest
/// period, a motion of 0.4 s has the largest number of steps that sampling accepts (4e6).
inline constexpr double kShortestServoPeriod = 1e-7, kLongestServoPeriod = 10;

/// Throws Error(bad_model) "urdf file: message".
[[noreturn]] void complain_urdf(const RobotDescription& robot, const std::string& inside,
                                const std::string& message);
/// Throws Error(bad_model) "sidecar file: message".
[[noreturn]] void complain_sidecar(const RobotDescription& robot, const std::string& inside,
                                   const std::string& message);

/// Throws Error(bad_model) "file: message" with the place of a joint's angle in a posture.
[[noreturn]] void complain_posture(const RobotDescription& robot, const std::string& posture,
                                   const std::string& joint, const std::string& message);

/// Checks names, finite numbers, masses, inertia tensors and sizes of shapes of all links.
void validate_links(const RobotDescription& robot);

/// Checks names, ends, axes, limits and mimic targets of all joints.
void validate_joints(const RobotDescription& robot);

/// Checks that there is one root, one parent for each link, and no loop. Returns the index of the
/// root link.
int find_root_link(const RobotDescription& robot);

/// Indices into `robot.joints` of the joints with a coordinate of their own (neither fixed,
/// floating nor mimicking), in `joint_order` when it is given, else in the file's order.
std::vector<int> ordered_dof_joints(const RobotDescription& robot);

/// Checks the names of joints and links in the sidecar, and its numbers.
void validate_sidecar(const RobotDescription& robot, const std::vector<std::string>& dof_names);

}  // namespace ayumi
