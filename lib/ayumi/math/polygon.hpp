#pragma once
// Convex polygons in the plane: support regions.

#include <Eigen/Core>
#include <vector>

namespace ayumi {

/// A convex polygon, counter-clockwise; may degenerate to a segment, a point, or nothing.
class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  /// Convex hull of the points (any order, duplicates allowed).
  explicit ConvexPolygon(std::vector<Eigen::Vector2d> points);

  /// Becomes the hull of `points`, whose order changes; keeps its memory.
  void assign(std::vector<Eigen::Vector2d>& points);

  const std::vector<Eigen::Vector2d>& vertices() const { return vertices_; }
  bool empty() const { return vertices_.empty(); }

  /// Distance of p to the boundary, positive inside, negative outside [m]. Empty: -infinity.
  double margin(const Eigen::Vector2d& p) const;

  /// The nearest point of the polygon; p itself when inside.
  Eigen::Vector2d project(const Eigen::Vector2d& p) const;

  /// The polygon of the points at least `distance` inside every edge; the centroid alone when there
  /// are none.
  ConvexPolygon shrunk(double distance) const;

  /// The same into `result`, with two lists as workspace; all keep their memory.
  void shrink_into(double distance, std::vector<Eigen::Vector2d>& kept,
                   std::vector<Eigen::Vector2d>& next, ConvexPolygon& result) const;

  /// max over the polygon of n.dot(x).
  double support(const Eigen::Vector2d& n) const;

  /// Centre of area (of the vertices when the area is zero).
  Eigen::Vector2d centroid() const;

 private:
  std::vector<Eigen::Vector2d> vertices_;
};

}  // namespace ayumi
