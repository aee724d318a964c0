#pragma once
// The robot as an immutable, validated tree of moving bodies. Links joined by fixed joints are one
// body; body 0 is the floating root; a joint with one axis connects every other body to its parent.
// Bodies are sorted parents first. A mimic joint moves its body with the dof of another joint.

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "ayumi/geometry/mesh_hull.hpp"
#include "ayumi/geometry/shape.hpp"
#include "ayumi/model/robot_description.hpp"
#include "ayumi/model/robot_state.hpp"

namespace ayumi {

enum class Side { left = 0, right = 1 };
inline const char* name_of(Side side) { return side == Side::left ? "left" : "right"; }
inline Side other(Side side) { return side == Side::left ? Side::right : Side::left; }

/// A moving body: a link and all links fixed to it. The frame of the body is the frame of the first
/// of these links.
struct Body {
  std::string name;  ///< name of its first link
  int parent = -1;   ///< index of the parent body; -1 for the root
  bool prismatic = false;
  /// Unit vector of the joint's axis; at angle 0, the joint frame is the body frame.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  /// Pose in the parent body at theta = 0.
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  int dof = -1;                  ///< column of theta; -1 for the root
  double ratio = 1, offset = 0;  ///< joint = ratio theta[dof] + offset
  Inertia inertia;               ///< inertia of all links of the body, in the body frame
};

/// One generalised coordinate of theta.
struct Dof {
  std::string name;  ///< name of the joint
  int body = -1;     ///< the body that it moves (the driving body if other joints mimic this one)
  bool prismatic = false;
  bool limited = false;         ///< whether position limits exist (a continuous joint has none)
  double lower = 0, upper = 0;  ///< position limits [rad] or [m]; +-infinity if there are none
  EncoderDescription encoder;   ///< encoder of the joint; its device is 0 if the robot has none
};

/// Motors and servos of one profile for all dofs; limits are infinite where the files give none.
struct ActuatorLimits {
  std::string name;
  Eigen::VectorXd speed;              ///< largest speed by dof [rad/s]
  Eigen::VectorXd peak_torque;        ///< largest torque by dof [N m]
  Eigen::VectorXd continuous_torque;  ///< largest RMS torque by dof over thermal_window [N m]
  double thermal_window = 10.0;       ///< time over which torques are averaged [s]
  std::vector<ServoDescription> servo;
  /// Whether the files give the joint a servo; a servo with kp = 0 is passive.
  std::vector<bool> has_servo;

  /// Whether the files say that the joint has no motor: its servo has kp = 0, and the servo of at
  /// least one other joint has a kp above 0. If no joint has a motor, the files do not state the
  /// motors.
  bool lacks_motor(int dof) const;
};

struct Link {
  std::string name;
  int body = 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< frame of the link in its body
  Inertia inertia;                                         ///< inertia in the link frame
  std::vector<PlacedShape> visuals, collisions;            ///< shapes in the link frame
};

struct Sole {
  int body = 0;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();  ///< frame of the sole in its body
  std::vector<Eigen::Vector2d> polygon;  ///< corners, counter-clockwise, in the sole frame [m]
  /// Centroid of the polygon, in the sole frame [m].
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double stiffness = 0;     ///< stiffness of the sole on the ground [N/m]
  double damping_time = 0;  ///< ratio of contact damping to stiffness [s]
};

class RobotModel {
 public:
  /// Throws Error(bad_model), which names the link or joint and the remedy, for:
  ///   - no root or several roots, a loop, an unknown link, or two links of one name;
  ///   - a moving body without mass, a negative mass, or an inertia that no body can have;
  ///   - numbers that are not finite, an axis of length zero, or limits in the wrong order;
  ///   - an unknown mimic, sole or posture joint, or a posture outside the limits.
  explicit RobotModel(RobotDescription description);

  const RobotDescription& description() const { return description_; }
  const std::string& name() const { return description_.name; }
  double mass() const { return mass_; }  ///< mass of the robot [kg]

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Dof>& dofs() const { return dofs_; }
  const std::vector<Link>& links() const { return links_; }
  /// Hulls of the collision meshes, by link and collision shape; for a shape that is no mesh, the
  /// hull has no points. The hulls are computed at the first call, for all copies of the model.
  const std::vector<std::vector<MeshHull>>& collision_hulls() const;
  int dof_count() const { return static_cast<int>(dofs_.size()); }
  int velocity_count() const { return 6 + dof_count(); }
  std::vector<std::string> dof_names() const;

  /// The index that belongs to the name; -1 if there is none.
  int find_dof(const std::string& joint_name) const;
  int find_link(const std::string& link_name) const;

  bool has_soles() const { return soles_.size() == 2; }
  const Sole& sole(Side side) const;  ///< throws Error(bad_model) if the robot has no soles
  /// The dofs between the root and this foot, from the root outwards.
  const std::vector<int>& leg(Side side) const;
  bool in_leg(Side side, int dof) const;
  /// Whether the dof belongs to a leg; false if the robot has no soles.
  bool is_leg_joint(int dof) const;
  int trunk_body() const { return trunk_body_; }

  /// Actuator limits by profile name; "" is the default profile. Throws Error(bad_model) that names
  /// the known profiles.
  const ActuatorLimits& limits(const std::string& profile = "") const;
  std::vector<std::string> profile_names() const;

  /// theta of a named posture [rad]; joints that the posture does not name are 0. Throws
  /// Error(bad_model).
  Eigen::VectorXd posture(const std::string& posture_name = "home") const;
  bool has_posture(const std::string& posture_name) const;

  Eigen::VectorXd joint_weight() const;  ///< diagonal of W: from the sidecar, or 1

  /// The state at rest with the base at the origin and the joints in `posture_name`.
  RobotState rest_state(const std::string& posture_name = "home") const;

 private:
  RobotDescription description_;
  std::vector<Body> bodies_;
  std::vector<Dof> dofs_;
  std::vector<Link> links_;
  std::vector<Sole> soles_;
  std::vector<std::vector<int>> legs_;
  std::vector<ActuatorLimits> limits_;
  double mass_ = 0;
  int trunk_body_ = 0;

  struct Hulls {
    std::once_flag computed;
    std::vector<std::vector<MeshHull>> of_links;
  };
  std::shared_ptr<Hulls> hulls_ = std::make_shared<Hulls>();
};

}  // namespace ayumi
