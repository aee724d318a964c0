#pragma once
// Which law controls the robot, and with which gains. The names "none", "dtad", "viip-landings" and
// so on exist only in files and on the command line; one table in controller_spec.cpp holds them.

#include <string>
#include <utility>
#include <vector>

namespace ayumi {

/// The control laws.
enum class ControllerKind {
  none,  ///< open loop: the servos receive the command; VIIP phases hold their posture
  dtad,  ///< DTAD, section 3 of the paper, with VIIP in phases that carry goals
  viip,  ///< the same laws in the same phases, but the given gains are those of VIIP
  /// The next three are baselines: published control laws with the body, sensors and servos of
  /// DTAD. Only the choice of the ZMP differs. VIIP is used in phases with goals.
  preview,      ///< ZMP preview control (control/preview_control)
  foot_guided,  ///< foot-guided control (control/foot_guided)
  dcm_step,     ///< DCM tracking that chooses the place and the durations of steps
                ///< (control/step_program)
};

/// Whether the law is a baseline: it chooses the ZMP in another way, and everything else is as in
/// DTAD.
bool is_baseline(ControllerKind kind);

/// Variants that show the effect of one part of a law. They are not meant for a robot.
enum class Demonstration {
  none,
  literal,  ///< DTAD in which (14) is integrated as printed, and only the sign of D is corrected
  no_feedback,  ///< VIIP without measurements: feet land at planned times; everything else is open
                ///< loop
  landings_only,  ///< VIIP as in no_feedback, but the landing of a foot is noticed
};

struct ControllerType {
  ControllerKind kind = ControllerKind::dtad;
  Demonstration demonstration = Demonstration::none;

  ControllerType() = default;
  ControllerType(ControllerKind law) : kind(law) {}  // NOLINT: a law is a type
  ControllerType(ControllerKind law, Demonstration variant) : kind(law), demonstration(variant) {}
  bool operator==(const ControllerType&) const = default;
};

/// The name of a type in files and on the command line, such as "none", "dtad" or "dtad-literal".
const std::string& name_of(const ControllerType& type);

/// All names, law by law.
const std::vector<std::string>& controller_names();

/// The type of that name. Throws Error(usage) that lists the known names.
ControllerType controller_type(const std::string& name);

/// A controller with its gains; gains that are not given are the robot's defaults.
struct ControllerSpec {
  ControllerType type;
  std::vector<std::pair<std::string, double>> gains;
};

/// Why a gain of this value is refused, with the limits; empty if it is from 0 to kLargestNumber.
std::string gain_out_of_range(const std::string& name, double value);

}  // namespace ayumi
