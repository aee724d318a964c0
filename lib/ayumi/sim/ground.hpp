#pragma once
// The ground during one step: the shapes of the world with the floor's pose and the bumps of that
// step. Points and normals are in the ground's frame (z along the normal of the slope) unless a
// comment names another frame. docs/theory_plant.md, "Ground".

#include <Eigen/Dense>
#include <vector>

#include "ayumi/geometry/distance.hpp"
#include "ayumi/sim/step.hpp"

namespace ayumi {

/// The ground at a point.
struct GroundTouch {
  double gap = 0;  ///< gap along the normal; negative if the point is inside the ground [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double rise = 0;  ///< rate of the ground's height at this point [m/s]
};

/// A place where the ground touches a sole between the sole's corners: a corner or an edge of a
/// block, or a node of the height field.
struct InnerPoint {
  long id = 0;              ///< number of the place, the same in the next step
  Eigen::Vector3d on_sole;  ///< point in the plane of the sole [m]
  double gap = 0;           ///< gap along the normal; negative if the place is inside the sole [m]
  double rise = 0;          ///< rate of the ground's height [m/s]
};

/// A block as a solid, for shapes that lie on its edges.
struct SolidBlock {
  Collider collider;
  Eigen::Isometry3d pose;  ///< pose in the ground's frame
  double rise = 0;         ///< rate of its height [m/s]
};

/// A node of the height field that is higher than its neighbours.
struct FieldTip {
  long id = 0;  ///< number of the node, the same in the next step
  SolidBlock solid;
};

class Ground {
 public:
  explicit Ground(const World& world);

  /// Takes over floor, friction and bumps of the coming step.
  void set(const StepInput& input);

  /// Whether the ground is only a plane, so that soles only touch it with their corners.
  bool plain() const { return blocks_.empty() && field_.heights.size() == 0; }
  const std::vector<SolidBlock>& solids() const { return solids_; }  ///< all blocks
  double top() const { return top_; }  ///< height of the highest point [m]
  const Eigen::Isometry3d& pose() const { return floor_.pose; }
  /// The normal in the world.
  Eigen::Vector3d normal() const { return floor_.pose.linear().col(2); }
  /// In the world [rad/s].
  const Eigen::Vector3d& angular_velocity() const { return floor_.angular_velocity; }
  bool at_rest() const { return floor_.velocity.isZero(0) && floor_.angular_velocity.isZero(0); }
  /// The velocity of the floor at the point p, in the world [m, m/s].
  Eigen::Vector3d velocity(const Eigen::Vector3d& p) const {
    return floor_.velocity + floor_.angular_velocity.cross(p - floor_.pose.translation());
  }

  /// The gap, the normal and the rise of the ground at the point p.
  GroundTouch touch(const Eigen::Vector3d& p) const;
  /// The coefficient of friction at the point p.
  double friction(const Eigen::Vector3d& p) const;

  /// Appends the corners, edges and nodes under the convex sole with these corners (anticlockwise
  /// seen from above) that are less than `reach` [m] below the sole.
  void inner_points(const std::vector<Eigen::Vector3d>& sole, double reach,
                    std::vector<InnerPoint>& points) const;

  /// Fills `tips` with the nodes of the height field within `radius` of `center` that are higher
  /// than their neighbours, as small spheres. A shape can lie on these nodes without touching with
  /// one of its corners; the rest of the field is flat or hollow, and there corners of the shape
  /// touch first.
  void tips(const Eigen::Vector3d& center, double radius, std::vector<FieldTip>& tips) const;

 private:
  struct Block {
    std::array<Eigen::Vector2d, 8> corner;
    int count = 4;
    Eigen::Vector2d center;
    double radius = 0, height = 0, rise = 0;
  };
  SolidBlock solid(const GroundBlock& block, double rise) const;
  static Block prepared(const GroundBlock& block, double rise);
  double field_height(const Eigen::Vector2d& p, Eigen::Vector2d& gradient) const;
  bool on_field(const Eigen::Vector2d& p) const;
  bool stands_out(Eigen::Index i, Eigen::Index j) const;
  template <typename Visit>
  void visit_nodes(const Eigen::Vector2d& center, double radius, const Visit& visit) const;

  World world_;
  HeightField field_;
  FloorPose still_, floor_;
  std::vector<Block> blocks_;       // blocks of the world, then the bumps
  std::vector<SolidBlock> solids_;  // in the same order
  size_t fixed_ = 0;                // number of blocks of the world
  std::optional<double> friction_;
  double top_ = 0, fixed_top_ = 0;
};

}  // namespace ayumi
