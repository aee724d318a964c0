#pragma once
// The contacts of one step: which points of the robot touch the ground, a block or another link of
// the robot, or may do so before the step ends, and the frame, gap and friction of each.
// docs/theory_plant.md.

#include <vector>

#include "ayumi/sim/ground.hpp"
#include "ayumi/sim/plant/contact_points.hpp"
#include "ayumi/sim/plant/link_contacts.hpp"

namespace ayumi {

/// A point that touches, or that may touch before the step ends.
struct ActiveContact {
  /// Number of the point, the same in each step: the index of the ContactPoint, or a larger number
  /// for edges, nodes of the height field and links.
  long key = 0;
  int body = 0;    ///< body that is pushed along the normal
  int other = -1;  ///< body that is touched; -1 for the ground
  int side = -1;   ///< Side of the sole; -1 for a body that is not a sole
  /// Corner of the sole; -1 if the contact is between its corners, or not on a sole.
  int vertex = -1;
  double stiffness = 0;             ///< stiffness of the contact [N/m]
  double damping_time = 0;          ///< ratio of damping to stiffness [s]
  double gap = 0;                   ///< gap along the normal, negative inside [m]
  Eigen::Vector3d position;         ///< position in the world [m]
  Eigen::Matrix3d to_contact;       ///< rows: normal, first and second tangent, in world axes
  Eigen::Vector3d ground_velocity;  ///< velocity of the ground in the world [m/s]
  double friction = 0;              ///< coefficient of friction
  Eigen::Vector3d impulse =
      Eigen::Vector3d::Zero();  ///< impulse of the last step in contact axes [N s]
  Eigen::Vector2d deflection =
      Eigen::Vector2d::Zero();  ///< deflection of the tangential spring [m]
};

class ContactSet {
 public:
  ContactSet(const RobotModel& model, const World& world);

  Ground& ground() { return ground_; }
  const Ground& ground() const { return ground_; }

  size_t point_count() const { return points_.size(); }  ///< number of points of the robot

  /// The contacts of the present step, in the order of their keys. Contacts of one body, or of one
  /// pair of bodies, are consecutive.
  std::vector<ActiveContact>& active() { return active_; }
  const std::vector<ActiveContact>& active() const { return active_; }

  /// Removes impulses, deflections and distances, because the robot was moved elsewhere.
  void reset();

  /// Finds the contacts of a step of `dt` [s] from the positions and velocities in `data`. A
  /// contact that was active in the last step keeps its impulse and deflection.
  void collect(const RobotData& data, double dt);

  /// Restores the contacts from before the last collect().
  void undo_collect() { active_.swap(previous_); }

  /// Removes the contacts that are still above the ground and have not pressed so far.
  void remove_arriving();

  /// The point of the robot that touches; null if it is an edge, a node of the height field or a
  /// link.
  const ContactPoint* point_of(const ActiveContact& contact) const {
    return contact.key < static_cast<long>(points_.size())
               ? &points_[static_cast<size_t>(contact.key)]
               : nullptr;
  }

  /// Whether the robot can turn about this contact. This is so for a point of the robot, or of the
  /// ground under a sole, that stays in its place while the robot turns. A sphere and a rim roll
  /// instead.
  bool is_pivot(const ActiveContact& contact) const;

 private:
  void collect_points(const PointGroup& group, const RobotData& data, double dt);
  void collect_under_sole(const PointGroup& group, const RobotData& data, double dt);
  void collect_edges(const RobotData& data, double dt);
  void collect_edges(int body, const CollisionModel::PlacedCollider& shape, const SolidBlock& block,
                     long key, const RobotData& data, double dt);
  void collect_links(const RobotData& data, double dt);
  void keep_impulses();
  double height_above_all(const PointGroup& group, const RobotData& data) const;
  double fastest_approach(const RobotData& data) const;

  Ground ground_;
  std::vector<ContactPoint> points_;
  std::vector<PointGroup> groups_;
  // Largest distance of the far side of a point's sphere from its body's origin [m].
  double widest_ = 0;
  LinkContacts links_;
  // Friction and stiffness of contacts between links, and of links with edges.
  double link_friction_ = 0, link_stiffness_ = 0;
  std::vector<char> is_foot_;  // whether a body is a foot
  std::vector<ActiveContact> active_, previous_;
  // Workspace of collect().
  Eigen::Matrix3d level_;  // contact axes on the plane
  std::vector<Eigen::Vector3d> outline_;
  std::vector<InnerPoint> inner_;
  std::vector<FieldTip> tips_;
};

}  // namespace ayumi
