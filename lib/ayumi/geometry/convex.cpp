// Both algorithms work on D = {p - q : p in a, q in b}, whose farthest point along d is that of a
// along d minus that of b along -d. Separate sets: a sequence of simplices in D approaches the
// point of D nearest to the origin; the nearest part of a simplex is found among its at most 15
// parts. Overlapping sets: the origin is inside D, and the nearest face of a polytope inside D
// moves outwards until it is a face of D. A face with the origin outside (negative distance) counts
// as nearest, so that the first polytope need not contain the origin.
#include "ayumi/geometry/convex.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "ayumi/math/elementary.hpp"

namespace ayumi {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// Below this distance the sets overlap [m]. Chosen: above the rounding of double precision at
/// lengths of 1 m (2e-16 m), below every tolerance of a length.
constexpr double kTouch = 1e-10;
/// Relative error of the squared distance at which the GJK algorithm ends. Chosen: above the
/// rounding of its sums.
constexpr double kGjkTolerance = 1e-12;
/// Largest number of steps of GJK. Chosen: it is only reached if rounding stops the progress.
constexpr int kGjkSteps = 200;

double sign(double x) { return x < 0 ? -1 : 1; }

Vector3d farthest(const ConvexCore& core, const Isometry3d& pose, const Vector3d& direction) {
  const Vector3d d = pose.linear().transpose() * direction;
  if (!core.points.empty())
    return pose *
           *std::max_element(core.points.begin(), core.points.end(),
                             [&](const auto& p, const auto& q) { return p.dot(d) < q.dot(d); });
  Vector3d p(sign(d.x()) * core.half.x(), sign(d.y()) * core.half.y(), sign(d.z()) * core.half.z());
  const double radial = core.disc > 0 ? elementary::hypot(d.x(), d.y()) : 0;
  if (radial > 0) {
    p.x() += core.disc * d.x() / radial;
    p.y() += core.disc * d.y() / radial;
  }
  return pose * p;
}

struct Vertex {
  Vector3d d, on_a, on_b;  // d = on_a - on_b
};

struct Sets {
  const ConvexCore &a, &b;
  const Isometry3d &pose_a, &pose_b;

  Vertex vertex(const Vector3d& direction) const {
    Vertex v;
    v.on_a = farthest(a, pose_a, direction);
    v.on_b = farthest(b, pose_b, -direction);
    v.d = v.on_a - v.on_b;
    return v;
  }
};

/// A list of at most four items that needs no memory allocation.
template <typename T>
class Few {
 public:
  Few() = default;
  Few(std::initializer_list<T> items) {
    for (const T& item : items) push_back(item);
  }
  size_t size() const { return size_; }
  const T& operator[](size_t i) const { return items_[i]; }
  T& operator[](size_t i) { return items_[i]; }
  void push_back(const T& item) { items_[size_++] = item; }
  void shrink(size_t n) { size_ = n; }
  void assign(size_t n, const T& item) {
    for (size_ = 0; size_ < n;) push_back(item);
  }
  const T* begin() const { return items_.data(); }
  const T* end() const { return items_.data() + size_; }

 private:
  std::array<T, 4> items_;
  size_t size_ = 0;
};

struct Simplex {
  Few<Vertex> vertices;
  Few<double> weights;

  Vector3d sum(Vector3d Vertex::*part) const {
    Vector3d s = Vector3d::Zero();
    for (size_t i = 0; i < vertices.size(); ++i) s += weights[i] * (vertices[i].*part);
    return s;
  }
};

// The point nearest to the origin of the plane, line or point through n vertices. Returns false if
// it is not between the vertices.
template <int n>
bool nearest_inside(const Few<Vertex>& v, const std::array<int, 4>& pick, Few<double>& weights) {
  weights.assign(n, 1);
  if constexpr (n > 1) {
    Eigen::Matrix<double, 3, n - 1> E;
    for (int i = 1; i < n; ++i) E.col(i - 1) = v[pick[i]].d - v[pick[0]].d;
    const Eigen::Matrix<double, n - 1, n - 1> G = E.transpose() * E;
    double size = 1;
    for (int i = 0; i < n - 1; ++i) size *= G(i, i);
    if (!(G.determinant() > 1e-14 * size)) return false;
    const Eigen::Matrix<double, n - 1, 1> mu = -G.inverse() * (E.transpose() * v[pick[0]].d);
    weights[0] = 1 - mu.sum();
    for (int i = 1; i < n; ++i) weights[i] = mu[i - 1];
  }
  for (const double w : weights)
    if (w < 0) return false;
  return true;
}

// Reduces `simplex` to the part that is nearest to the origin. With `newest`, only parts that
// contain the last vertex are examined, because the search for the nearest point has examined the
// other parts before.
void reduce(Simplex& simplex, bool newest = false) {
  const auto count = static_cast<int>(simplex.vertices.size());
  std::array<int, 4> best = {};
  Few<double> weights;
  double least = std::numeric_limits<double>::infinity();
  for (int mask = newest ? 1 << (count - 1) : 1; mask < (1 << count); ++mask) {
    std::array<int, 4> pick = {};
    int n = 0;
    for (int i = 0; i < count; ++i)
      if (mask & (1 << i)) pick[n++] = i;
    Few<double> inside;
    const bool is_inside = n == 1   ? nearest_inside<1>(simplex.vertices, pick, inside)
                           : n == 2 ? nearest_inside<2>(simplex.vertices, pick, inside)
                           : n == 3 ? nearest_inside<3>(simplex.vertices, pick, inside)
                                    : nearest_inside<4>(simplex.vertices, pick, inside);
    if (!is_inside) continue;
    Vector3d nearest = Vector3d::Zero();
    for (int i = 0; i < n; ++i) nearest += inside[i] * simplex.vertices[pick[i]].d;
    const double distance = nearest.squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = pick;
    weights = inside;
  }
  // The picked vertices are in ascending order, so that none is overwritten before it is copied.
  for (size_t i = 0; i < weights.size(); ++i) simplex.vertices[i] = simplex.vertices[best[i]];
  simplex.vertices.shrink(weights.size());
  simplex.weights = weights;
}

struct Face {
  std::array<int, 3> v = {};
  Vector3d normal = Vector3d::Zero();  // normal that points outwards
  double distance = std::numeric_limits<double>::infinity();
  bool dead = false;
};

class Polytope {
 public:
  explicit Polytope(const Sets& sets) : sets_(sets) {}

  bool begin() {
    add(Vector3d::UnitX());
    add(-Vector3d::UnitX());
    const Vector3d along = vertices_[1].d - vertices_[0].d;
    if (along.norm() < kTouch) return false;
    const Vector3d across = along.unitOrthogonal();
    add_farther(across, along.cross(across));
    if (vertices_.size() < 3) return false;
    const Vector3d normal = along.cross(vertices_[2].d - vertices_[0].d).normalized();
    add_farther(normal, normal);
    if (vertices_.size() < 4) return false;
    for (const auto& [a, b, c, opposite] :
         {std::array{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}}) {
      Face face = made(a, b, c);
      if (face.normal.dot(vertices_[opposite].d - vertices_[a].d) > 0) face = made(a, c, b);
      faces_.push_back(face);
    }
    return true;
  }

  ConvexPair expand() {
    int nearest = 0;
    for (int step = 0; step < kGjkSteps; ++step) {
      nearest = nearest_face();
      const Face face = faces_[nearest];
      const Vertex w = sets_.vertex(face.normal);
      if (face.normal.dot(w.d) - face.distance < 1e-10) break;
      vertices_.push_back(w);
      if (!replace_visible(static_cast<int>(vertices_.size()) - 1)) break;
    }
    return pair_of(faces_[nearest]);
  }

 private:
  void add(const Vector3d& direction) { vertices_.push_back(sets_.vertex(direction)); }

  // Adds a vertex off the line or plane of the present ones: the farthest one along +-`one` and
  // +-`other`.
  void add_farther(const Vector3d& one, const Vector3d& other) {
    double most = kTouch;
    Vertex best;
    for (const Vector3d& d : {one, Vector3d(-one), other, Vector3d(-other)}) {
      const Vertex v = sets_.vertex(d);
      const double out = d.normalized().dot(v.d - vertices_[0].d);
      if (out <= most) continue;
      most = out;
      best = v;
    }
    if (most > kTouch) vertices_.push_back(best);
  }

  Face made(int a, int b, int c) const {
    Face face;
    face.v = {a, b, c};
    const Vector3d n = (vertices_[b].d - vertices_[a].d).cross(vertices_[c].d - vertices_[a].d);
    // Degenerate face: its distance is infinite, so it is never the nearest.
    if (n.norm() < 1e-18) return face;
    face.normal = n.normalized();
    face.distance = face.normal.dot(vertices_[a].d);
    return face;
  }

  int nearest_face() const {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < static_cast<int>(faces_.size()); ++i) {
      if (faces_[i].dead || faces_[i].distance >= least) continue;
      least = faces_[i].distance;
      best = i;
    }
    return best;
  }

  // Replaces the faces that are visible from the vertex by faces between the vertex and their rim.
  // If rounding makes some faces of one plane visible and others hidden, the rim is not a simple
  // loop, and the number of faces would grow without limit. In this case, only faces that are
  // visible from a larger distance are replaced. Returns false if there is no simple rim.
  bool replace_visible(int top) {
    // Distances of the vertex from the plane of a face beyond which it sees the face [m].
    for (const double seen_from : {1e-13, 1e-11, 1e-9}) {
      const auto rim = rim_of_visible(top, seen_from);
      if (rim.empty() || !is_simple(rim)) continue;
      for (Face& face : faces_) face.dead = face.dead || sees(top, face, seen_from);
      for (const auto& [a, b] : rim) faces_.push_back(made(a, b, top));
      return true;
    }
    return false;
  }

  bool sees(int top, const Face& face, double from) const {
    return face.normal.dot(vertices_[top].d - vertices_[face.v[0]].d) > from;
  }

  // The edges that the visible faces do not share with another visible face.
  std::vector<std::pair<int, int>> rim_of_visible(int top, double from) const {
    std::vector<std::pair<int, int>> rim;
    for (const Face& face : faces_) {
      if (face.dead || !sees(top, face, from)) continue;
      for (int i = 0; i < 3; ++i) {
        const std::pair edge(face.v[i], face.v[(i + 1) % 3]);
        const auto twin = std::find(rim.begin(), rim.end(), std::pair(edge.second, edge.first));
        if (twin != rim.end())
          rim.erase(twin);
        else
          rim.push_back(edge);
      }
    }
    return rim;
  }

  // Each vertex of the rim begins one edge, so there are at most as many edges as vertices.
  bool is_simple(const std::vector<std::pair<int, int>>& rim) const {
    std::vector<char> begins(vertices_.size(), 0);
    for (const auto& edge : rim)
      if (begins[static_cast<size_t>(edge.first)]++) return false;
    return true;
  }

  // A facet of D may consist of several coplanar triangles. The points belong to the triangle that
  // contains the foot of the perpendicular, because otherwise they would not be opposite to each
  // other.
  ConvexPair pair_of(const Face& nearest) const {
    constexpr double kSamePlane = 1e-9;  // tolerance [m]. Chosen: above rounding
    ConvexPair pair;
    pair.distance = -nearest.distance;
    pair.normal = nearest.normal;
    double least = std::numeric_limits<double>::infinity();
    for (const Face& face : faces_) {
      if (face.dead || face.distance > nearest.distance + kSamePlane) continue;
      Simplex simplex;
      for (const int v : face.v) simplex.vertices.push_back(vertices_[v]);
      reduce(simplex);
      const double far = simplex.sum(&Vertex::d).norm();
      if (far >= least) continue;
      least = far;
      pair.on_a = simplex.sum(&Vertex::on_a);
      pair.on_b = simplex.sum(&Vertex::on_b);
    }
    return pair;
  }

  const Sets& sets_;
  std::vector<Vertex> vertices_;
  std::vector<Face> faces_;
};

}  // namespace

ConvexPair convex_pair(const ConvexCore& a, const Isometry3d& pose_a, const ConvexCore& b,
                       const Isometry3d& pose_b) {
  const Sets sets{a, b, pose_a, pose_b};
  Vector3d nearest = pose_a.translation() - pose_b.translation();
  Simplex simplex{{sets.vertex(nearest.norm() > 0 ? Vector3d(-nearest) : Vector3d::UnitX())}, {1}};
  nearest = simplex.vertices[0].d;
  for (int step = 0; step < kGjkSteps && nearest.norm() > kTouch; ++step) {
    const Vertex w = sets.vertex(-nearest);
    const double square = nearest.squaredNorm();
    if (square - nearest.dot(w.d) <= kGjkTolerance * square) break;
    Simplex grown = simplex;
    grown.vertices.push_back(w);
    reduce(grown, true);
    const Vector3d next = grown.sum(&Vertex::d);
    if (!(next.squaredNorm() < square)) break;  // rounding prevents further progress
    simplex = std::move(grown);
    nearest = next;
    if (simplex.vertices.size() == 4) nearest.setZero();  // the origin is inside
  }
  ConvexPair pair;
  pair.distance = nearest.norm();
  if (pair.distance > kTouch) {
    pair.on_a = simplex.sum(&Vertex::on_a);
    pair.on_b = simplex.sum(&Vertex::on_b);
    pair.normal = -nearest / pair.distance;
    return pair;
  }
  Polytope polytope(sets);
  if (polytope.begin()) return polytope.expand();
  pair.on_a = pair.on_b = simplex.sum(&Vertex::on_a);
  const Vector3d apart = pose_b.translation() - pose_a.translation();
  pair.normal = apart.norm() > 0 ? Vector3d(apart.normalized()) : Vector3d(Vector3d::UnitZ());
  return pair;
}

}  // namespace ayumi
