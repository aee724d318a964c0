#include "ayumi/render/thin.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "ayumi/base/key_numbers.hpp"

namespace ayumi {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Number of rounds in which edges are removed, the smallest errors first. Chosen: in fewer rounds
// an edge with a large error goes before one beside it with a small error; more rounds take longer.
constexpr int kRounds = 10;
// Cosine of the largest angle by which a triangle may turn. Chosen: 30 degrees. At 45, round parts
// of a heavy robot had spots of light in a picture; at half, round edges of a few pixels stay
// whole.
constexpr double kLeastTurn = 0.866;
// Cosine of the angle between normals that are taken for one smooth surface. Chosen: 10 degrees; a
// corner without such a neighbour keeps its own normal.
constexpr float kSmooth = 0.985f;
// Weight of the planes that keep outlines, as a multiple of the area of a square on the edge.
// Chosen: an outline may move by a third of what a surface may.
constexpr double kOutline = 10;
// Factor that makes a bound in single precision smaller than the same bound in double precision.
// Chosen: its distance from 1 is larger than the rounding (6e-8), and too small to cost a trial.
constexpr double kBelow = 1 - 1e-6;

/// A sum of weighted squared distances from planes, as a function of a point, and the sum of the
/// weights.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, xd = 0, yy = 0, yz = 0, yd = 0, zz = 0, zd = 0, dd = 0, weight = 0;

  void add_plane(const Vector3d& n, double d, double w) {
    xx += w * n.x() * n.x(), xy += w * n.x() * n.y(), xz += w * n.x() * n.z();
    yy += w * n.y() * n.y(), yz += w * n.y() * n.z(), zz += w * n.z() * n.z();
    xd += w * n.x() * d, yd += w * n.y() * d, zd += w * n.z() * d, dd += w * d * d;
    weight += w;
  }
  void add(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, xd += o.xd, yy += o.yy, yz += o.yz, yd += o.yd;
    zz += o.zz, zd += o.zd, dd += o.dd, weight += o.weight;
  }
  double mean_at(const Vector3d& p) const {
    const double x = p.x(), y = p.y(), z = p.z();
    const double sum = x * (xx * x + 2 * (xy * y + xz * z + xd)) +
                       y * (yy * y + 2 * (yz * z + yd)) + z * (zz * z + 2 * zd) + dd;
    return weight > 0 ? sum / weight : 0;
  }
};

constexpr std::uint32_t kNever = 0xffffffff;

/// A triangle by the places of its corners, and by their looks: the vertices whose normals and
/// colours the corners have.
struct Facet {
  std::array<std::uint32_t, 3> place, look;
  /// Bound below which none of its edges can be removed; 0 if it is not known.
  float least = 0;
  /// The value of moves_ when a triangle beside this one was found in the way. The bound is not
  /// valid any more when something beside this triangle has changed since then.
  std::uint32_t blocked = kNever;
  bool gone = false;
};

class Thinning {
 public:
  Thinning(const Triangles& surface, double tolerance) : surface_(surface), tolerance_(tolerance) {
    number_places();
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
      Facet facet;
      for (size_t k = 0; k < 3; ++k) {
        facet.look[k] = surface.indices[i + k];
        facet.place[k] = place_of_[facet.look[k]];
      }
      const auto& p = facet.place;
      if (p[0] != p[1] && p[1] != p[2] && p[2] != p[0]) facets_.push_back(facet);
    }
    measure();
  }

  Triangles result(const Progress& progress, double done) {
    size_t before = 0;
    for (int round = 1; round <= kRounds; ++round) {
      const double share = double(round) / kRounds;
      if (tolerance_ * share <= done) continue;
      report(progress, {"reducing the surface", -1, ""});
      before = facets_.size();
      go_through(tolerance_ * share * tolerance_ * share);
      std::erase_if(facets_, [](const Facet& facet) { return facet.gone; });
    }
    // Further rounds with the last bound remove edges that have become removable.
    for (int more = 0; more < kRounds && facets_.size() < before - before / 50; ++more) {
      report(progress, {"reducing the surface", -1, ""});
      before = facets_.size();
      go_through(tolerance_ * tolerance_);
      std::erase_if(facets_, [](const Facet& facet) { return facet.gone; });
    }
    Triangles out;
    out.vertices.reserve(3 * facets_.size());
    for (const Facet& facet : facets_)
      for (size_t k = 0; k < 3; ++k) {
        RenderVertex vertex = surface_.vertices[facet.look[k]];
        vertex.position = places_[facet.place[k]].cast<float>();
        out.indices.push_back(static_cast<std::uint32_t>(out.vertices.size()));
        out.vertices.push_back(vertex);
      }
    return out;
  }

 private:
  void number_places() {
    KeyNumbers<3> numbers(surface_.vertices.size());
    for (const RenderVertex& vertex : surface_.vertices) {
      KeyNumbers<3>::Key key;
      for (size_t axis = 0; axis < 3; ++axis)  // turns -0 into 0
        key[axis] = std::bit_cast<std::uint32_t>(vertex.position[Eigen::Index(axis)] + 0.0f);
      const std::uint32_t number = numbers.number(key);
      if (number == places_.size()) places_.emplace_back(vertex.position.cast<double>());
      place_of_.push_back(number);
    }
  }

  Vector3d doubled_area(const Facet& facet) const {
    const Vector3d& a = places_[facet.place[0]];
    return (places_[facet.place[1]] - a).cross(places_[facet.place[2]] - a);
  }

  void measure() {
    quadrics_.assign(places_.size(), {});
    changed_.assign(places_.size(), 0);
    for (const Facet& facet : facets_) {
      const Vector3d normal = doubled_area(facet);
      const double size = normal.norm();
      for (size_t k = 0; k < 3 && size > 0; ++k)
        quadrics_[facet.place[k]].add_plane(normal / size,
                                            -normal.dot(places_[facet.place[0]]) / size, size / 6);
    }
    const auto color = [&](std::uint32_t facet) {
      return surface_.vertices[facets_[facet].look[0]].color;
    };
    list_neighbours();
    // The edges from a place to places with a higher number, with a triangle of each.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::uint32_t place = 0; place < places_.size(); ++place) {
      edges.clear();
      for (std::uint32_t n = first_[place]; n < first_[place + 1]; ++n)
        for (const std::uint32_t other : facets_[around_[n]].place)
          if (other > place) edges.emplace_back(other, around_[n]);
      std::sort(edges.begin(), edges.end());
      for (size_t i = 0, end = 0; i < edges.size(); i = end) {
        for (end = i; end < edges.size() && edges[end].first == edges[i].first;) ++end;
        if (end - i == 2 && color(edges[i].second) == color(edges[i + 1].second)) continue;
        for (size_t k = i; k < end; ++k)
          keep_outline(place, edges[k].first, facets_[edges[k].second]);
      }
    }
  }

  /// Adds a plane through the edge that is perpendicular to the triangle.
  void keep_outline(std::uint32_t a, std::uint32_t b, const Facet& facet) {
    const Vector3d along = places_[b] - places_[a];
    const Vector3d normal = along.cross(doubled_area(facet));
    const double size = normal.norm();
    if (!(size > 0)) return;
    for (const std::uint32_t place : {a, b})
      quadrics_[place].add_plane(normal / size, -normal.dot(places_[a]) / size,
                                 kOutline * along.squaredNorm());
  }

  void list_neighbours() {
    first_.assign(places_.size() + 1, 0);
    for (const Facet& facet : facets_)
      for (const std::uint32_t place : facet.place) ++first_[place + 1];
    for (size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    around_.resize(3 * facets_.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (size_t i = 0; i < facets_.size(); ++i)
      for (const std::uint32_t place : facets_[i].place)
        around_[next[place]++] = static_cast<std::uint32_t>(i);
  }

  /// Moves places onto others as long as the mean squared distance stays below `most`.
  void go_through(double most) {
    list_neighbours();
    settled_.assign(places_.size(), false);
    for (Facet& facet : facets_) {
      if (facet.gone || (double(facet.least) > most && is_valid(facet))) continue;
      double least = std::numeric_limits<double>::infinity();
      facet.blocked = kNever;
      for (size_t k = 0; k < 6 && !facet.gone; ++k) {
        const std::uint32_t from = facet.place[k % 3];
        const std::uint32_t to = facet.place[(k % 3 + 1 + k / 3) % 3];
        if (settled_[from] || settled_[to]) {
          least = 0;  // it can move in the next round
          continue;
        }
        // The two means are tested separately, because the mean of both over a large plane nearby
        // would hide a step.
        double mean = quadrics_[from].mean_at(places_[to]);
        if (mean <= most) mean = std::max(mean, quadrics_[to].mean_at(places_[to]));
        if (mean > most)
          least = std::min(least, mean);
        else if (can_move(from, to))
          move(from, to);
        else
          facet.blocked = moves_;
      }
      facet.least = static_cast<float>(kBelow * least);
    }
  }

  /// Whether what blocked the edges of the facet is still there.
  bool is_valid(const Facet& facet) const {
    return facet.blocked == kNever ||
           std::all_of(facet.place.begin(), facet.place.end(),
                       [&](std::uint32_t place) { return changed_[place] <= facet.blocked; });
  }

  bool can_move(std::uint32_t from, std::uint32_t to) const {
    for (std::uint32_t n = first_[from]; n < first_[from + 1]; ++n) {
      const Facet& facet = facets_[around_[n]];
      if (facet.gone || has(facet, to)) continue;
      Facet moved = facet;
      for (std::uint32_t& place : moved.place)
        if (place == from) place = to;
      const Vector3d before = doubled_area(facet), after = doubled_area(moved);
      const double cosine = before.dot(after);  // times the two lengths
      if (cosine <= 0 ||
          cosine * cosine <= kLeastTurn * kLeastTurn * before.squaredNorm() * after.squaredNorm())
        return false;
    }
    return true;
  }

  static bool has(const Facet& facet, std::uint32_t place) {
    return facet.place[0] == place || facet.place[1] == place || facet.place[2] == place;
  }
  static size_t corner_at(const Facet& facet, std::uint32_t place) {
    return facet.place[0] == place ? 0 : facet.place[1] == place ? 1 : 2;
  }

  void move(std::uint32_t from, std::uint32_t to) {
    // Collects the looks of the corners at `to`. In each triangle that vanishes, a look at `from`
    // is joined with a look at `to`.
    joined_.clear();
    looks_.clear();
    for (std::uint32_t n = first_[to]; n < first_[to + 1]; ++n) {
      Facet& facet = facets_[around_[n]];
      if (facet.gone) continue;
      facet.least = 0;
      const std::uint32_t look = facet.look[corner_at(facet, to)];
      looks_.push_back(look);
      if (!has(facet, from)) continue;
      joined_.emplace_back(facet.look[corner_at(facet, from)], look);
      facet.gone = true;
    }
    ++moves_;
    for (std::uint32_t n = first_[from]; n < first_[from + 1]; ++n) {
      Facet& facet = facets_[around_[n]];
      for (const std::uint32_t place : facet.place) changed_[place] = moves_;
      if (facet.gone) continue;
      facet.least = 0;
      const size_t corner = corner_at(facet, from);
      facet.place[corner] = to;
      facet.look[corner] = look_at_end(facet.look[corner]);
    }
    quadrics_[to].add(quadrics_[from]);
    settled_[from] = settled_[to] = true;
  }

  /// The new look of a corner that moves: the look at the new place that is joined with it, or else
  /// the most similar look there, or else its own look.
  std::uint32_t look_at_end(std::uint32_t look) const {
    const RenderVertex& own = surface_.vertices[look];
    for (const auto& [before, after] : joined_)
      if (alike(own, surface_.vertices[before]) && surface_.vertices[after].color == own.color)
        return after;
    std::uint32_t best = look;
    float most = kSmooth;
    for (const std::uint32_t other : looks_) {
      const RenderVertex& vertex = surface_.vertices[other];
      const float cosine = vertex.normal.dot(own.normal);
      if (cosine > most && vertex.color == own.color) {
        most = cosine;
        best = other;
      }
    }
    return best;
  }
  static bool alike(const RenderVertex& a, const RenderVertex& b) {
    return a.normal == b.normal && a.color == b.color;
  }

  const Triangles& surface_;
  double tolerance_;
  std::vector<Vector3d> places_;
  std::vector<std::uint32_t> place_of_;  // place by vertex
  std::vector<Facet> facets_;
  std::vector<Quadric> quadrics_;              // quadric by place
  std::vector<std::uint32_t> first_, around_;  // facets around each place
  std::vector<bool> settled_;                  // places that are settled in this round
  std::uint32_t moves_ = 0;                    // number of moves up to now
  std::vector<std::uint32_t> changed_;         // number of the last move beside each place
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined_;
  std::vector<std::uint32_t> looks_;
};

}  // namespace

Triangles thinned(const Triangles& surface, double tolerance, const Progress& progress,
                  double done) {
  return Thinning(surface, tolerance).result(progress, done);
}

void thin(std::vector<BodySurface>& surface, double tolerance, const Progress& progress,
          double done) {
  for (BodySurface& body : surface)
    for (Triangles* part : {&body.closed, &body.open})
      if (!part->indices.empty()) *part = thinned(*part, tolerance, progress, done);
}

}  // namespace ayumi
