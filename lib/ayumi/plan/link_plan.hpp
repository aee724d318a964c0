#pragma once
// The motion of hands, other links and the gaze of a pattern, and of the joints that follow their
// targets. Where a link has no target, the keys of its joints place it; between a key without a
// target and a key with a target, it moves from one place to the other. Of all postures of the limb
// that put the link at its place, the joints take the posture nearest to their own keys. So their
// motion begins and ends at these keys.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/dynamics/robot_data.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/motion/pattern.hpp"

namespace ayumi {

/// Thrown if a target is out of reach before the time of its key while the trunk moves. At this
/// point it is not known whether the limb reaches the target at the time of the key.
class MissedOnTheWay : public Error {
 public:
  MissedOnTheWay(const std::string& what, const SourcePlace& place, double key_time)
      : Error(ErrorCode::bad_pattern, text_of(place) + ": " + what, place, words_at(place, what)),
        key_time_(key_time) {}
  double key_time() const { return key_time_; }  ///< time of the key [s]

 private:
  double key_time_;
};

class LinkPlan {
 public:
  /// `solved` marks the joints of the legs. Throws Error(bad_pattern) "file: place: ..." for an
  /// unknown link, for a link of a leg, for a link that has no joint between itself and the trunk,
  /// and for a robot without the hand or the head that a key names.
  LinkPlan(const RobotModel& model, const Pattern& pattern, const std::vector<bool>& solved);

  bool empty() const { return groups_.empty(); }
  /// Whether a target moves the joint at t.
  bool leads(int dof, double t) const;
  /// Whether a target moves any joint at t.
  bool leads(double t) const;
  /// Whether a target in the world moves a joint from `begin` to `end`.
  bool leads_in_world(double begin, double end) const;

  /// Moves the joints that follow targets at t. `keyed` are the angles of the joints' own keys. The
  /// base and all other joints do not move. Returns the largest change of a joint [rad, m]. Throws
  /// Error(bad_pattern), which states the missing distance, for a target that is out of reach.
  /// Throws MissedOnTheWay if it is only known that a place on the way to the key is out of reach.
  double solve(double t, const Eigen::VectorXd& keyed, RobotState& state, RobotData& data) const;

  /// From now on, solve() does not throw MissedOnTheWay before `t`; the limb comes as near as it
  /// can.
  void forgive_before(double t) { forgiven_before_ = t; }

  /// What moves joints: "hands", "gaze" or both. Empty if nothing does.
  std::string origin() const;

 private:
  /// A quantity of the keys as a sum of weighted parts. One part is given in the world, and one in
  /// the frame of the trunk. The rest of the weight belongs to keys that do not give the quantity.
  struct Blend {
    std::array<Track, 3> world, trunk;
    Track in_world{0.0}, in_trunk{0.0};
  };
  struct Anchor {
    double t = 0;
    /// Target of the link; if null, the joints' keys move the link.
    const LinkTarget* target = nullptr;
    Interpolation interpolation = Interpolation::minimum_jerk;
    size_t keyframe = 0;
  };
  struct Target {
    std::string name;  ///< name in messages
    std::string key;   ///< place in a keyframe, such as "hands/left"
    bool gaze = false;
    int body = -1;
    Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< end of the link, in the body frame [m]
    Eigen::Vector3d axis =
        Eigen::Vector3d::Zero();  ///< direction of the link, body frame, unit vector
    double length = 0;            ///< length of the limb [m]
    std::vector<int> dofs;
    /// The bodies on the way from the root to the target that joints of the group move, root first,
    /// each with the index of its joint in Group::dofs.
    std::vector<std::pair<int, Eigen::Index>> chain;
    std::vector<Anchor> anchors;
    Blend place, direction;
  };
  /// Targets that have a common joint.
  struct Group {
    std::vector<Target> targets;
    std::vector<int> dofs;
    std::vector<int> path;  ///< bodies that these dofs move and that carry a target, root first
    std::vector<std::pair<double, double>>
        windows;  ///< intervals in which targets move the joints [s]
    bool at(double t) const;
  };
  /// The place and direction that the targets ask for at a time.
  struct Aim {
    const Target* target = nullptr;
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    double place_weight = 0, direction_weight = 0;
  };

  void add_target(const std::string& name, bool gaze, const std::vector<bool>& solved);
  void fill_tracks(Target& target) const;
  void put_in_group(Target target);
  // Only moves the bodies of the group's path. The rest of `data` must already belong to the state.
  std::vector<Aim> aims_at(const Group& group, double t, const Eigen::VectorXd& keyed,
                           const RobotState& state, RobotData& data, bool directions) const;
  // Only moves the bodies of the group's path. The rest of `data` must already belong to the state.
  double minimize(const Group& group, const std::vector<Aim>& aims, const Eigen::VectorXd& keyed,
                  RobotState& state, RobotData& data) const;
  bool reached(const std::vector<Aim>& aims, const RobotData& data) const;
  void complain(const Group& group, double t, const std::vector<Aim>& aims,
                const Eigen::VectorXd& keyed, RobotState& state, RobotData& data) const;
  double bound(int dof, double keyed, bool upper) const;

  const RobotModel* model_;
  const Pattern* pattern_;
  std::vector<Group> groups_;
  double forgiven_before_ = 0;  ///< before this time, a limb comes as near as it can [s]
};

}  // namespace ayumi
