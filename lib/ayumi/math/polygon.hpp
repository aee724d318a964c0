#pragma once
// Convex polygons in the plane: support regions.

#include <Eigen/Core>
#include <vector>

namespace ayumi {

/// A convex polygon, counter-clockwise. It may degenerate to a segment, a point, or nothing.
class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  /// The convex hull of the points, which may have any order and duplicates.
  explicit ConvexPolygon(std::vector<Eigen::Vector2d> points);

  /// Makes this the hull of `points`, whose order changes. The polygon keeps its memory.
  void assign(std::vector<Eigen::Vector2d>& points);

  const std::vector<Eigen::Vector2d>& vertices() const { return vertices_; }
  bool empty() const { return vertices_.empty(); }

  /// Distance of p to the boundary [m], positive inside and negative outside. For an empty polygon
  /// it is -infinity.
  double margin(const Eigen::Vector2d& p) const;

  /// The nearest point of the polygon; p itself if it is inside, or if the polygon is empty.
  Eigen::Vector2d project(const Eigen::Vector2d& p) const;

  /// The polygon of the points that are at least `distance` [m] inside every edge; the centroid
  /// alone if there are no such points. A segment and a point are not changed.
  ConvexPolygon shrunk(double distance) const;

  /// Writes the same polygon into `result`, with two lists as workspace. All keep their memory.
  void shrink_into(double distance, std::vector<Eigen::Vector2d>& kept,
                   std::vector<Eigen::Vector2d>& next, ConvexPolygon& result) const;

  /// The largest n.dot(x) of all points x of the polygon.
  double support(const Eigen::Vector2d& n) const;

  /// The centre of area, or that of the vertices if the area is zero.
  Eigen::Vector2d centroid() const;

 private:
  std::vector<Eigen::Vector2d> vertices_;
};

}  // namespace ayumi
