// Writes the meshes of robots/hoap1: one OBJ per link with one shared MTL. Usage:
//   ayumi_make_meshes robots/hoap1/meshes
// Every part is a loft: rings of points stacked along an axis, closed by two caps. Measures in
// millimetres in the link's frame (x forward, y left, z up), as at the left side; right-hand links
// are mirror images. Figures: robots/hoap1/README.md.

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"

namespace {

using Eigen::Vector3d;
using Ring = std::vector<Vector3d>;
using Triangle = std::array<Vector3d, 3>;

constexpr double kPi = std::numbers::pi;
constexpr int kCornerSteps = 3;      // segments of a rounded corner
constexpr int kCircleSteps = 20;     // segments of a circle
constexpr double kCreaseAngle = 40;  // sharper edges keep separate normals [deg]

enum class Axis { x, y, z };

// A rounded rectangle across the axis: at `at` along it, centred at (u, v), half sizes a, b. Across
// x lie (y, z), across y (z, x), across z (x, y).
struct Section {
  double at, u, v, a, b, radius;
};

// A ring of a turned part.
struct Turn {
  double at, radius;
};

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

struct Part {
  std::string material;
  std::vector<Triangle> triangles;
};

class LinkMesh {
 public:
  void loft(const std::string& material, Axis axis, const std::vector<Section>& sections) {
    std::vector<Ring> rings;
    for (const Section& section : sections) rings.push_back(ring_of(axis, section));
    add(material, rings);
  }

  // A box with rounded edges along `axis` and bevelled ends.
  void box(const std::string& material, Axis axis, const Vector3d& low, const Vector3d& high,
           double round = 5, double bevel = 2.5) {
    const Vector3d middle = (low + high) / 2, half = (high - low) / 2;
    const int w = static_cast<int>(axis), u = (w + 1) % 3, v = (w + 2) % 3;
    const auto section = [&](double at, double inset) {
      return Section{at, middle[u], middle[v], half[u] - inset, half[v] - inset, round};
    };
    loft(material, axis,
         {section(low[w], bevel), section(low[w] + bevel, 0), section(high[w] - bevel, 0),
          section(high[w], bevel)});
  }

  void turned(const std::string& material, Axis axis, const Vector3d& center,
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

  // A motor housing: a cylinder with bevelled ends from `low` to `high` along the axis.
  void motor(const std::string& material, Axis axis, const Vector3d& center, double radius,
             double low, double high, double bevel = 2.5) {
    turned(material, axis, center,
           {{low, radius - bevel},
            {low + bevel, radius},
            {high - bevel, radius},
            {high, radius - bevel}});
  }

  void mirror() {
    for (Part& part : parts_)
      for (Triangle& triangle : part.triangles) {
        for (Vector3d& corner : triangle) corner.y() = -corner.y();
        std::swap(triangle[1], triangle[2]);
      }
  }

  const std::vector<Part>& parts() const { return parts_; }

 private:
  void add(const std::string& material, const std::vector<Ring>& rings) {
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

  std::vector<Part> parts_;
};

LinkMesh torso() {
  LinkMesh mesh;
  mesh.box("grey", Axis::z, {-44, -64, 46}, {24, 64, 66}, 8);
  mesh.box("dark", Axis::z, {-42, -42, 64}, {20, 42, 92}, 8);
  mesh.loft("silver", Axis::z,
            {{86, -16, 0, 32, 46, 12},
             {93, -16, 0, 36, 53, 14},
             {150, -16, 0, 41, 61, 16},
             {184, -16, 0, 38, 59, 18},
             {196, -16, 0, 28, 46, 18}});
  mesh.loft("blue", Axis::x,
            {{21, 0, 138, 40, 30, 8}, {27, 0, 138, 38, 28, 8}, {29, 0, 138, 35, 25, 8}});
  mesh.box("blue", Axis::z, {-98, -48, 62}, {-56, 48, 180}, 10, 4);
  for (const double side : {1.0, -1.0}) mesh.motor("dark", Axis::y, {2, side * 64, 150}, 20, -7, 7);
  mesh.motor("dark", Axis::z, {-6, 0, 198}, 15, -5, 6);
  mesh.loft("silver", Axis::z,
            {{202, -6, 0, 24, 25, 16},
             {208, -6, 0, 32, 33, 20},
             {226, -6, 0, 33, 34, 21},
             {237, -6, 0, 27, 28, 20},
             {243, -6, 0, 16, 17, 14}});
  mesh.loft("visor", Axis::x,
            {{20, 0, 217, 27, 9, 7}, {28, 0, 217, 25, 8, 7}, {29.5, 0, 217, 23, 6.5, 6}});
  return mesh;
}

LinkMesh hip_yaw() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 30}, 19, -12, 12);
  mesh.motor("silver", Axis::z, {0, 0, 43}, 23, -3, 3, 1.5);
  mesh.box("silver", Axis::z, {-33, -15, 14}, {14, 15, 21}, 5, 2);
  mesh.box("silver", Axis::x, {-33, -15, -15}, {-27, 15, 21}, 5, 2);
  return mesh;
}

LinkMesh hip_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::x, {0, 0, 0}, 16, -26, 28);
  mesh.motor("blue", Axis::x, {0, 0, 0}, 18, 10, 24, 1.5);
  mesh.box("grey", Axis::y, {-14, -22, -15}, {16, 22, 12}, 5);
  return mesh;
}

LinkMesh thigh() {
  LinkMesh mesh;
  for (const double side : {1.0, -1.0})
    mesh.box("silver", Axis::z, {-14, side * 25.5 - 2.5, -40}, {15, side * 25.5 + 2.5, 14}, 2, 5);
  mesh.loft("silver", Axis::z,
            {{-94, 3, 0, 20, 20, 9},
             {-88, 4, 0, 25, 25, 10},
             {-46, 5, 0, 27, 25, 10},
             {-30, 4, 0, 24, 24, 10},
             {-24, 3, 0, 18, 20, 9}});
  mesh.motor("blue", Axis::y, {8, 0, -66}, 20, -28.5, 28.5);
  mesh.motor("dark", Axis::y, {0, 0, -100}, 13, -27, 27);
  return mesh;
}

LinkMesh shank() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 18, -21, 21);
  mesh.loft("silver", Axis::z,
            {{-84, 4, 0, 16, 19, 8},
             {-79, 5, 0, 21, 23, 9},
             {-34, 8, 0, 25, 24, 10},
             {-12, 4, 0, 19, 20, 9},
             {-6, 2, 0, 14, 17, 8}});
  mesh.loft("blue", Axis::x,
            {{24, 0, -46, 17, 22, 7}, {32, 0, -47, 14, 18, 7}, {34, 0, -47, 11, 15, 6}});
  mesh.motor("dark", Axis::y, {-6, 0, -62}, 15, -26, 26);
  return mesh;
}

LinkMesh ankle() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::y, {0, 0, 0}, 14, -25, 25);
  mesh.motor("blue", Axis::y, {0, 0, 0}, 16, -10, 10, 1.5);
  mesh.box("grey", Axis::x, {-15, -15, -12}, {26, 15, 14}, 5);
  return mesh;
}

LinkMesh foot() {
  LinkMesh mesh;
  mesh.loft("dark", Axis::z,
            {{-37, 7, 0, 49, 31.5, 5}, {-33, 7, 0, 49, 31.5, 5}, {-31.5, 7, 0, 47.5, 30, 5}});
  mesh.loft("silver", Axis::z,
            {{-32, 7, 0, 47, 29.5, 8},
             {-25, 6, 0, 45, 28.5, 9},
             {-18, 1, 0, 36, 25, 9},
             {-16, 0, 0, 33, 22, 8}});
  mesh.loft("blue", Axis::z,
            {{-31, 44, 0, 11, 25, 8}, {-24, 42, 0, 9, 22, 8}, {-22, 41, 0, 7, 19, 6}});
  mesh.box("grey", Axis::z, {28, -13, -22}, {34, 13, 12}, 2, 2);
  mesh.box("grey", Axis::z, {-29, -13, -22}, {-23, 13, 12}, 2, 2);
  return mesh;
}

LinkMesh shoulder_pitch() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 20, -19, -4);
  mesh.box("grey", Axis::z, {-14, -18, -24}, {14, -6, 12}, 4);
  mesh.box("blue", Axis::z, {-17, -18, -54}, {17, 14, -20}, 6);
  return mesh;
}

LinkMesh shoulder_roll() {
  LinkMesh mesh;
  mesh.motor("dark", Axis::z, {0, 0, 0}, 14, -19, 17);
  mesh.motor("blue", Axis::z, {0, 0, 0}, 16, -12, 10, 1.5);
  mesh.box("silver", Axis::x, {4, -13, -14}, {40, 13, 13}, 6);
  return mesh;
}

LinkMesh upper_arm() {
  LinkMesh mesh;
  mesh.loft("silver", Axis::x,
            {{29, 0, 0, 13, 13, 8},
             {33, 0, 0, 16, 16, 9},
             {72, 0, 0, 17, 17, 9},
             {95, 0, 0, 15, 16, 9},
             {99, 0, 0, 12, 13, 8}});
  mesh.motor("blue", Axis::y, {80, 0, 0}, 16, -19, 19);
  for (const double side : {1.0, -1.0})
    mesh.box("grey", Axis::x, {86, side * 16.5 - 2, -10}, {126, side * 16.5 + 2, 10}, 2, 4);
  mesh.motor("dark", Axis::y, {115, 0, 0}, 10, -21, 21);
  return mesh;
}

LinkMesh forearm() {
  LinkMesh mesh;
  mesh.motor("silver", Axis::y, {0, 0, 0}, 14, -13.5, 13.5);
  mesh.loft(
      "silver", Axis::x,
      {{6, 0, 0, 11, 12, 7}, {11, 0, 0, 13, 14, 8}, {34, 0, 0, 15, 15, 9}, {45, 0, 0, 13, 13, 9}});
  mesh.motor("dark", Axis::x, {46, 0, 0}, 11, -3, 4, 1.5);
  mesh.loft("blue", Axis::x,
            {{48, 0, 0, 8, 10, 6},
             {53, 0, 0, 11, 14, 9},
             {64, 0, 0, 10, 13, 9},
             {70, 0, 0, 7, 9, 7},
             {72, 0, 0, 4, 5, 4}});
  return mesh;
}

const std::vector<std::pair<std::string, Vector3d>> kMaterials = {{"silver", {0.76, 0.78, 0.81}},
                                                                  {"blue", {0.17, 0.27, 0.55}},
                                                                  {"grey", {0.46, 0.48, 0.52}},
                                                                  {"dark", {0.15, 0.16, 0.19}},
                                                                  {"visor", {0.04, 0.05, 0.08}}};

std::string number(double value) {
  const std::string text = ayumi::text::fixed(value, 5);
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

// The normal at a corner: of the triangles around it that turn away by less than the crease angle.
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

  std::string text() const {
    return "# HOAP-1, made by app/tools/make_hoap1_meshes.cpp\nmtllib hoap1.mtl\n" +
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

std::string materials() {
  std::string text = "# HOAP-1\n";
  for (const auto& [name, color] : kMaterials)
    text += "newmtl " + name + "\n" + line("Kd", color) + line("Ks", {0.2, 0.2, 0.2}) + "Ns 30\n";
  return text;
}

void write(const std::filesystem::path& folder, const std::string& link, const LinkMesh& mesh) {
  ObjWriter writer;
  for (const Part& part : mesh.parts()) writer.add(part);
  ayumi::write_file(folder / (link + ".obj"), writer.text());
  std::printf("%-22s %4d triangles\n", link.c_str(), writer.count());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: ayumi_make_meshes FOLDER\n");
    return 2;
  }
  try {
    const std::filesystem::path folder = argv[1];
    write(folder, "torso", torso());
    const std::vector<std::pair<std::string, LinkMesh>> sided = {
        {"hip_yaw_link", hip_yaw()},
        {"hip_roll_link", hip_roll()},
        {"thigh", thigh()},
        {"shank", shank()},
        {"ankle_link", ankle()},
        {"foot", foot()},
        {"shoulder_pitch_link", shoulder_pitch()},
        {"shoulder_roll_link", shoulder_roll()},
        {"upper_arm", upper_arm()},
        {"forearm", forearm()}};
    for (auto [name, mesh] : sided) {
      write(folder, "l_" + name, mesh);
      mesh.mirror();
      write(folder, "r_" + name, mesh);
    }
    ayumi::write_file(folder / "hoap1.mtl", materials());
  } catch (const ayumi::Error& error) {
    std::fprintf(stderr, "ayumi_make_meshes: %s\n", error.what());
    return 3;
  }
  return 0;
}
