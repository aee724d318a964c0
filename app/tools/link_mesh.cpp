#include "link_mesh.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::tools {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kCornerSteps = 3;      // number of segments of a rounded corner
constexpr int kCircleSteps = 20;     // number of segments of a circle
constexpr double kCreaseAngle = 40;  // sharper edges keep separate normals [deg]

Vector3d placed(Axis axis, double u, double v, double w) {
  if (axis == Axis::x) return {w, u, v};
  if (axis == Axis::y) return {v, w, u};
  return {u, v, w};
}

Ring ring_of(Axis axis, const Section& s) {
  const double r = std::min({s.radius, s.a, s.b});
  Ring ring;
  for (int corner = 0; corner < 4; ++corner) {
    const double sign_u = corner == 0 || corner == 3 ? 1 : -1, sign_v = corner < 2 ? 1 : -1;
    for (int i = 0; i <= kCornerSteps; ++i) {
      const double angle = (corner + double(i) / kCornerSteps) * kPi / 2;
      ring.push_back(placed(axis, s.u + sign_u * (s.a - r) + r * std::cos(angle),
                            s.v + sign_v * (s.b - r) + r * std::sin(angle), s.at));
    }
  }
  return ring;
}

}  // namespace

void LinkMesh::loft(const std::string& material, Axis axis, const std::vector<Section>& sections) {
  std::vector<Ring> rings;
  for (const Section& section : sections) rings.push_back(ring_of(axis, section));
  add(material, rings);
}

void LinkMesh::box(const std::string& material, Axis axis, const Vector3d& low,
                   const Vector3d& high, double round, double bevel) {
  const Vector3d middle = (low + high) / 2, half = (high - low) / 2;
  const int w = static_cast<int>(axis), u = (w + 1) % 3, v = (w + 2) % 3;
  const auto section = [&](double at, double inset) {
    return Section{at, middle[u], middle[v], half[u] - inset, half[v] - inset, round};
  };
  loft(material, axis,
       {section(low[w], bevel), section(low[w] + bevel, 0), section(high[w] - bevel, 0),
        section(high[w], bevel)});
}

void LinkMesh::turned(const std::string& material, Axis axis, const Vector3d& center,
                      const std::vector<Turn>& turns) {
  std::vector<Ring> rings(turns.size());
  const int w = static_cast<int>(axis), u = (w + 1) % 3, v = (w + 2) % 3;
  for (size_t k = 0; k < turns.size(); ++k)
    for (int i = 0; i < kCircleSteps; ++i) {
      const double angle = 2 * kPi * i / kCircleSteps;
      rings[k].push_back(placed(axis, center[u] + turns[k].radius * std::cos(angle),
                                center[v] + turns[k].radius * std::sin(angle),
                                center[w] + turns[k].at));
    }
  add(material, rings);
}

void LinkMesh::motor(const std::string& material, Axis axis, const Vector3d& center, double radius,
                     double low, double high, double bevel) {
  turned(material, axis, center,
         {{low, radius - bevel},
          {low + bevel, radius},
          {high - bevel, radius},
          {high, radius - bevel}});
}

void LinkMesh::mirror() {
  for (Part& part : parts_)
    for (Triangle& triangle : part.triangles) {
      for (Vector3d& corner : triangle) corner.y() = -corner.y();
      std::swap(triangle[1], triangle[2]);
    }
}

void LinkMesh::add(const std::string& material, const std::vector<Ring>& rings) {
  Part part{material, {}};
  const size_t n = rings[0].size();
  for (size_t k = 0; k + 1 < rings.size(); ++k)
    for (size_t i = 0; i < n; ++i) {
      const size_t j = (i + 1) % n;
      part.triangles.push_back({rings[k][i], rings[k][j], rings[k + 1][j]});
      part.triangles.push_back({rings[k][i], rings[k + 1][j], rings[k + 1][i]});
    }
  for (size_t i = 1; i + 1 < n; ++i) {
    part.triangles.push_back({rings.front()[0], rings.front()[i + 1], rings.front()[i]});
    part.triangles.push_back({rings.back()[0], rings.back()[i], rings.back()[i + 1]});
  }
  parts_.push_back(std::move(part));
}

namespace {

std::string number(double value) {
  const std::string text = text::fixed(value, 5);
  return text == "-0.00000" ? "0.00000" : text;
}

std::string line(const char* tag, const Vector3d& v) {
  return std::string(tag) + " " + number(v.x()) + " " + number(v.y()) + " " + number(v.z()) + "\n";
}

using Key = std::array<long, 3>;

Key key_of(const Vector3d& v) {
  return {std::lround(1e6 * v.x()), std::lround(1e6 * v.y()), std::lround(1e6 * v.z())};
}

Vector3d area_of(const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]) / 2; }

// The normal at a corner: the sum over the triangles around it whose normals differ by less than
// the crease angle.
Vector3d smooth_normal(const Vector3d& face, const std::vector<Vector3d>& around) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& area : around)
    if (area.normalized().dot(face.normalized()) > std::cos(kCreaseAngle * kPi / 180)) sum += area;
  return sum.normalized();
}

class ObjWriter {
 public:
  void add(const Part& part) {
    std::map<Key, std::vector<Vector3d>> around;
    for (const Triangle& triangle : part.triangles)
      for (const Vector3d& corner : triangle) around[key_of(corner)].push_back(area_of(triangle));
    faces_ += "usemtl " + part.material + "\n";
    for (const Triangle& triangle : part.triangles) {
      if (area_of(triangle).norm() < 1e-9) continue;
      faces_ += "f";
      for (const Vector3d& corner : triangle) {
        const Vector3d normal = smooth_normal(area_of(triangle), around[key_of(corner)]);
        faces_ += " " + std::to_string(index(line("v", corner / 1000), vertices_)) + "//" +
                  std::to_string(index(line("vn", normal), normals_));
      }
      faces_ += "\n";
      ++count_;
    }
  }

  std::string text(const RobotMeshes& robot) const {
    return "# " + robot.title + ", made by " + robot.source + "\nmtllib " + robot.name + ".mtl\n" +
           vertices_.text + normals_.text + faces_;
  }
  int count() const { return count_; }

 private:
  struct List {
    std::map<std::string, int> places;
    std::string text;
  };

  static int index(const std::string& line, List& list) {
    const auto [found, fresh] = list.places.emplace(line, static_cast<int>(list.places.size()) + 1);
    if (fresh) list.text += line;
    return found->second;
  }

  List vertices_, normals_;
  std::string faces_;
  int count_ = 0;
};

std::string materials(const RobotMeshes& robot) {
  std::string text = "# " + robot.title + "\n";
  for (const auto& [name, color] : robot.materials)
    text += "newmtl " + name + "\n" + line("Kd", color) + line("Ks", {0.2, 0.2, 0.2}) + "Ns 30\n";
  return text;
}

void write(const std::filesystem::path& folder, const RobotMeshes& robot, const std::string& link,
           const LinkMesh& mesh) {
  ObjWriter writer;
  for (const Part& part : mesh.parts()) writer.add(part);
  write_file(folder / (link + ".obj"), writer.text(robot));
  std::printf("%-22s %4d triangles\n", link.c_str(), writer.count());
}

}  // namespace

int write_meshes(int argc, char** argv, const RobotMeshes& robot) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    for (const NamedMesh& each : robot.middle) write(folder, robot, each.link, each.mesh);
    for (const NamedMesh& each : robot.sided) {
      LinkMesh mesh = each.mesh;
      write(folder, robot, std::string("l_").append(each.link), mesh);
      mesh.mirror();
      write(folder, robot, std::string("r_").append(each.link), mesh);
    }
    write_file(folder / (robot.name + ".mtl"), materials(robot));
  } catch (const Error& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 3;
  }
  return 0;
}

}  // namespace ayumi::tools
