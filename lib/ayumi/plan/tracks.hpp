#pragma once
// The keyframes and the table of a pattern as tracks over time. Every track starts from the default
// posture at rest: if it has no key at t = 0, it has an implied key there (joints: the default
// posture; ZMP: "center"; COG: over the middle of the feet; torso: level; f_z: the weight).

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

/// The author's tracks. COG, ZMP, f_z and torso are empty without keys.
struct PatternTracks {
  std::vector<Track> joints;                     ///< tracks of the joints, one for each dof [rad]
  bool joint_driven = false;                     ///< the legs follow keys, not the COG
  std::string driver;                            ///< the reason for this in words
  std::array<std::optional<Track>, 3> cog;       ///< COG in the world: x, y, z [m]
  std::optional<std::array<Track, 3>> zmp;       ///< ZMP in the world [m]
  std::optional<Track> fz;                       ///< vertical force [N]
  std::optional<std::array<Track, 3>> torso;     ///< roll, pitch, yaw [rad]
  std::optional<std::array<Track, 3>> base;      ///< position from a table [m]
  std::optional<std::array<Track, 4>> attitude;  ///< w, x, y, z from a table, unnormalised
  bool rest_ends = true;                         ///< if false, a table may start or end in motion
  std::vector<std::pair<double, Eigen::VectorXd>>
      weight;                                 ///< times [s], and the weights W from each time on
  std::map<std::string, std::string> origin;  ///< origins of the given tracks in words
};

/// `solved` marks the leg joints that inverse kinematics can solve. Throws Error(bad_pattern)
/// "file: place: ..." for an unknown joint, posture or weight, a mimic joint, keys that are out of
/// order, after the last phase or not finite, and a joint that has both keys and a table column.
PatternTracks read_tracks(const RobotModel& model, const Pattern& pattern, const FootPlan& feet,
                          const std::vector<bool>& solved);

/// ZMP of a pattern with neither ZMP nor COG keys: the centre of the supporting sole in single
/// support, from centre to centre in double support, and `ends` at the beginning and at the end
/// [m]. Without single support, it moves from one end to the other during the whole motion.
std::array<Track, 3> default_zmp(const FootPlan& feet, const std::array<Eigen::Vector3d, 2>& ends);
/// The same with the middle of the feet at both ends.
std::array<Track, 3> default_zmp(const FootPlan& feet);

/// Makes the COG follow the ZMP along the ground in place of its keys. The ZMP is default_zmp()
/// from the first place of the COG to the last one. If the ZMP has keys or a table, these lead, and
/// the first place of the COG is theirs; after them, the ZMP goes on to the last place of the COG
/// if at least 0.45 s are left.
void lead_by_zmp(const FootPlan& feet, PatternTracks& tracks);

}  // namespace ayumi
