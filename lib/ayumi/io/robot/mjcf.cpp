#include "ayumi/io/robot/mjcf.hpp"

#include "ayumi/base/error.hpp"

#ifdef AYUMI_HAS_MUJOCO

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <mutex>
#include <regex>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/robot/ellipsoid_mesh.hpp"
#include "ayumi/io/robot/mesh.hpp"
#include "ayumi/io/robot/mesh_place.hpp"
#include "ayumi/io/robot/mjcf_text.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/validate.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Model = std::unique_ptr<mjModel, void (*)(mjModel*)>;

// Largest relative difference between the inertia that a body states in full and the one that
// MuJoCo computes from its principal axes, if nothing but these axes causes it. Reason: MuJoCo
// turns the axes until the last rotation has a cosine of 1 - 1e-12, which is 1.4e-6 rad.
constexpr double kPrincipalError = 1e-5;

// The hook for errors of MuJoCo. It must not return, because MuJoCo would then end the program.
// MuJoCo also prints warnings, which another hook prevents.
[[noreturn]] void throw_words(const char* words) {
  fail(ErrorCode::bad_model, std::string("MuJoCo: ") + words);
}
void ignore_words(const char*) {}

class QuietMujoco {
 public:
  QuietMujoco() : lock_(mutex()), error_(mju_user_error), warning_(mju_user_warning) {
    mju_user_error = throw_words;
    mju_user_warning = ignore_words;
  }
  ~QuietMujoco() {
    mju_user_error = error_;
    mju_user_warning = warning_;
  }
  QuietMujoco(const QuietMujoco&) = delete;
  QuietMujoco& operator=(const QuietMujoco&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
  std::lock_guard<std::mutex> lock_;
  void (*error_)(const char*);
  void (*warning_)(const char*);
};

std::string one_line(std::string words) {
  while (!words.empty() && std::isspace(static_cast<unsigned char>(words.back()))) words.pop_back();
  for (char& c : words)
    if (c == '\n' || c == '\r') c = ' ';
  return words;
}

const MjcfSchema& schema_of_mujoco() {
  static const MjcfSchema schema = [] {
    constexpr int size = 1 << 20;  // its text takes about 20 kB
    std::string printed(size, '\0');
    const int length = mj_printSchema("", printed.data(), size, 0, 0);
    printed.resize(static_cast<size_t>(std::clamp(length, 0, size)));
    return mjcf_schema(printed);
  }();
  return schema;
}

// Writes a mesh in MuJoCo's own format: four counts, vertices, faces.
std::string msh_of(const std::vector<Eigen::Vector3f>& vertices,
                   const std::vector<std::array<std::uint32_t, 3>>& faces) {
  const std::array<int, 4> counts = {static_cast<int>(vertices.size()), 0, 0,
                                     static_cast<int>(faces.size())};
  std::string bytes(reinterpret_cast<const char*>(counts.data()), sizeof counts);
  for (const Eigen::Vector3f& v : vertices)
    bytes.append(reinterpret_cast<const char*>(v.data()), 3 * sizeof(float));
  for (const auto& face : faces)
    bytes.append(reinterpret_cast<const char*>(face.data()), 3 * sizeof(std::uint32_t));
  return bytes;
}

// A mesh of a box whose centre and principal axes are those of its frame, in MuJoCo's order. With
// it, MuJoCo leaves a mesh where the model places it.
std::string probe() {
  const Eigen::Vector3f half(0.1f, 0.2f, 0.3f);
  std::vector<Eigen::Vector3f> vertices;
  for (int i = 0; i < 8; ++i)
    vertices.emplace_back((i & 1 ? 1.f : -1.f) * half.x(), (i & 2 ? 1.f : -1.f) * half.y(),
                          (i & 4 ? 1.f : -1.f) * half.z());
  return msh_of(vertices, {{{0, 2, 1}},
                           {{1, 2, 3}},
                           {{4, 5, 6}},
                           {{5, 7, 6}},
                           {{0, 1, 4}},
                           {{1, 5, 4}},
                           {{2, 6, 3}},
                           {{3, 6, 7}},
                           {{0, 4, 2}},
                           {{2, 4, 6}},
                           {{1, 3, 5}},
                           {{3, 7, 5}}});
}

using Files = std::map<std::string, std::string>;

// Throws the complaint of MuJoCo with its place in the file. MuJoCo's message ends with a line
// number of the text that it was given, in one of two forms.
[[noreturn]] void complain(const fs::path& path, const MjcfText& text, std::string words) {
  static const std::regex place("(, |\n)?line (= )?(\\d+)(, column = -?\\d+)?");
  std::smatch match;
  int line = 0;
  if (std::regex_search(words, match, place)) {
    const auto found = text.lines.find(std::atoi(match[3].str().c_str()));
    if (found != text.lines.end()) line = found->second;
    words = match.prefix().str() + match.suffix().str();
  }
  fail(ErrorCode::bad_model, {path.string(), "", line},
       "MuJoCo: " + one_line(words) + "; correct this place");
}

Model compile(const fs::path& path, const MjcfText& text, const Files& files) {
  const std::unique_ptr<mjVFS, void (*)(mjVFS*)> vfs(new mjVFS, [](mjVFS* each) {
    mj_deleteVFS(each);
    delete each;
  });
  mj_defaultVFS(vfs.get());
  for (const auto& [name, bytes] : files) {
    if (mj_makeEmptyFileVFS(vfs.get(), name.c_str(), static_cast<int>(bytes.size())) != 0)
      fail(ErrorCode::bad_model, {path.string()},
           "the model has more mesh files than MuJoCo accepts; merge meshes");
    std::memcpy(vfs->filedata[mj_findFileVFS(vfs.get(), name.c_str())], bytes.data(), bytes.size());
  }
  char words[1000] = "the model could not be read";
  Model model(mj_loadXML("model.xml", vfs.get(), words, sizeof words), mj_deleteModel);
  if (!model) complain(path, text, words);
  return model;
}

Vector3d vector_at(const mjtNum* numbers, int index) {
  return Eigen::Map<const Vector3d>(numbers + 3 * index);
}

Isometry3d pose_at(const mjtNum* position, const mjtNum* quaternion, int index) {
  const mjtNum* q = quaternion + 4 * index;
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = vector_at(position, index);
  pose.linear() = Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  return pose;
}

class MjcfReader {
 public:
  MjcfReader(const fs::path& path, const std::vector<fs::path>& packages)
      : path_(path), places_(path, packages) {}

  RobotDescription read(const std::string& bytes) {
    const QuietMujoco quiet;
    text_ = mjcf_text(bytes, path_, schema_of_mujoco(),
                      [&](const std::string& body, const std::string& file) {
                        return !places_.find(body, file).empty();
                      });
    Files files = {{kMjcfProbe, probe()}};
    for (const auto& [asset, mesh] : text_.fitted_meshes) {
      const MjcfMesh& made = text_.meshes.at(mesh);
      use_true_mesh(asset, made, places_.find("", made.file), files);
    }
    files["model.xml"] = text_.xml;
    compiled_ = compile(path_, text_, files);
    weigh(std::move(files));
    m_ = compiled_.get();
    // The first body is the world.
    for (const auto& [count, what] : {std::pair{m_->nbody - 1, "links"}, {m_->njnt, "joints"}})
      if (static_cast<size_t>(count) > kMostLinks)
        fail(ErrorCode::bad_model, {path_.string()}, too_many(what));
    robot_.name = m_->names[0] ? std::string(m_->names) : path_.stem().string();
    robot_.urdf_file = path_.string();
    robot_.sha256 = sha256(bytes + text_.files);
    const int root = root_body();
    add_body(root, "", Isometry3d::Identity());
    read_equalities();
    read_actuators();
    read_excluded();
    read_inertial_unit();
    validate_links(robot_);
    validate_joints(robot_);
    for (const std::string& note : places_.notes()) robot_.assumptions.push_back(note);
    robot_.missing_meshes = places_.missing();
    for (const std::string& note : text_.notes) robot_.assumptions.push_back(note);
    return std::move(robot_);
  }

 private:
  // Replaces the probe of an asset by the vertices of its file.
  void use_true_mesh(const std::string& name, const MjcfMesh& mesh, const std::string& file,
                     Files& files) {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> faces;
    const Isometry3d to_asset = mesh.reference.inverse();
    for (const MeshPart& part : load_mesh(file, mesh.scale).parts) {
      const auto before = static_cast<std::uint32_t>(vertices.size());
      for (const Eigen::Vector3f& v : part.vertices)
        vertices.push_back((to_asset * v.cast<double>()).cast<float>());
      for (const auto& t : part.triangles)
        faces.push_back({t[0] + before, t[1] + before, t[2] + before});
    }
    const std::string asset = "mesh" + std::to_string(files.size()) + ".msh";
    files[asset] = msh_of(vertices, faces);
    const std::string head = "<mesh name=\"" + name + "\" file=\"";
    if (const size_t at = text_.xml.find(head + kMjcfProbe); at != std::string::npos)
      text_.xml.replace(at + head.size(), std::strlen(kMjcfProbe), asset);
  }

  // Bodies without <inertial> get their masses from the true meshes, in a second model.
  void weigh(Files files) {
    if (text_.weighed_meshes.empty()) return;
    std::vector<std::string> missing;
    for (const std::string& name : text_.weighed_meshes) {
      const auto mesh = text_.meshes.find(name);
      if (mesh == text_.meshes.end()) continue;
      const std::string file = places_.find("whose mass follows from it", mesh->second.file);
      if (file.empty())
        missing.push_back(mesh->second.file);
      else
        use_true_mesh(name, mesh->second, file, files);
    }
    if (!missing.empty())
      fail(ErrorCode::bad_file, {path_.string()},
           "the masses of bodies without <inertial> follow "
           "from meshes that are missing: " +
               text::join(missing, ", ") + "; add the files, or give these bodies an <inertial>");
    files["model.xml"] = text_.xml;
    weighed_ = compile(path_, text_, files);
  }

  std::string name_of(int type, int index, const std::string& other) const {
    const char* name = mj_id2name(m_, type, index);
    return name && *name ? std::string(name) : other + std::to_string(index);
  }
  std::string body_name(int body) const { return name_of(mjOBJ_BODY, body, "body"); }
  std::string joint_name(int joint) const { return name_of(mjOBJ_JOINT, joint, "joint"); }

  // The body of the world that is the robot: the one with the most joints below it.
  int root_body() {
    std::vector<int> joints(static_cast<size_t>(m_->nbody), 0), first(joints);
    for (int i = 1; i < m_->nbody; ++i) {
      first[i] = m_->body_parentid[i] == 0 ? i : first[m_->body_parentid[i]];
      joints[first[i]] += m_->body_jntnum[i];
    }
    const int root =
        static_cast<int>(std::max_element(joints.begin(), joints.end()) - joints.begin());
    if (m_->nbody < 2 || root == 0)
      fail(ErrorCode::bad_model, {path_.string()},
           "the model has no body with a joint; name the file of a robot");
    std::vector<std::string> others;
    for (int i = 1; i < m_->nbody; ++i)
      if (m_->body_parentid[i] == 0 && i != root) others.push_back(body_name(i));
    if (!others.empty())
      robot_.assumptions.push_back("bodies of the world beside the robot " + body_name(root) +
                                   " are left out: " + text::join(others, ", "));
    const int count = m_->body_jntnum[root];
    if (count == 0 || m_->jnt_type[m_->body_jntadr[root]] != mjJNT_FREE)
      robot_.assumptions.push_back("the body " + body_name(root) +
                                   " has no free joint in the model. A robot that stands on its "
                                   "feet moves freely, so Ayumi adds a free joint");
    return root;
  }

  void add_body(int body, const std::string& parent, const Isometry3d& parent_shift) {
    const std::string name = body_name(body);
    const bool floats = parent.empty();  // the root's own joints to the world are its free joint
    const int count = floats ? 0 : m_->body_jntnum[body], first = m_->body_jntadr[body];
    Isometry3d shift = Isometry3d::Identity();  // pose of the body's frame in the frame of its link
    std::string above = parent;
    Isometry3d placement = parent_shift * pose_at(m_->body_pos, m_->body_quat, body);
    Vector3d anchor = Vector3d::Zero();  // place of the next part in the body's frame
    int moving = 0;
    for (int i = first; i < first + count; ++i) {
      if (m_->jnt_type[i] == mjJNT_BALL)
        fail(ErrorCode::bad_model, {path_.string()},
             "joint " + joint_name(i) + ": ball joints are not supported; write three hinges");
      moving += m_->jnt_type[i] == mjJNT_HINGE || m_->jnt_type[i] == mjJNT_SLIDE;
    }
    int left = moving;
    for (int i = first; i < first + count; ++i) {
      const Vector3d at = vector_at(m_->jnt_pos, i), axis = vector_at(m_->jnt_axis, i);
      const double reference = m_->qpos0[m_->jnt_qposadr[i]];
      const bool slides = m_->jnt_type[i] == mjJNT_SLIDE;
      JointDescription joint;
      joint.name = joint_name(i);
      joint.type = slides ? JointType::prismatic
                          : (m_->jnt_limited[i] ? JointType::revolute : JointType::continuous);
      joint.parent = above;
      joint.child = --left == 0 ? name : name + "/" + joint.name;
      joint.origin = placement * Eigen::Translation3d(at - anchor);
      // The frames of the model are those at the reference position of the joint, so the frame is
      // moved back to the position 0.
      if (slides)
        joint.origin = joint.origin * Eigen::Translation3d(-reference * axis);
      else
        joint.origin = joint.origin * elementary::turn_quaternion(-reference, axis);
      joint.axis = axis;
      joint.has_limits = m_->jnt_limited[i] != 0;
      joint.lower = joint.has_limits ? m_->jnt_range[2 * i] : 0;
      joint.upper = joint.has_limits ? m_->jnt_range[2 * i + 1] : 0;
      const int dof = m_->jnt_dofadr[i];
      joint.damping = m_->dof_damping[dof];
      joint.friction = m_->dof_frictionloss[dof];
      if (const auto limit = text_.force_limits.find(joint.name); limit != text_.force_limits.end())
        joint.effort = limit->second;
      if (left > 0) robot_.links.push_back({joint.child, false, {}, {}, {}});
      above = joint.child;
      placement = Isometry3d::Identity();
      anchor = at;
      shift = Eigen::Translation3d(-at);
      robot_.joints.push_back(joint);
      joint_index_[i] = robot_.joints.size() - 1;
    }
    if (moving == 0 && !floats) {
      JointDescription joint;
      joint.name = name + "_fixed";
      joint.parent = parent;
      joint.child = name;
      joint.origin = placement;
      robot_.joints.push_back(joint);
    }
    add_link(body, name, shift);
    shift_[body] = shift;
    for (int child = body + 1; child < m_->nbody; ++child)
      if (m_->body_parentid[child] == body) add_body(child, name, shift);
  }

  void add_link(int body, const std::string& name, const Isometry3d& shift) {
    LinkDescription link;
    link.name = name;
    const mjModel* w = weighed_ ? weighed_.get() : m_;
    link.inertia.mass = w->body_mass[body];
    link.has_inertial = link.inertia.mass > 0;
    if (link.has_inertial) {
      const Isometry3d frame = shift * pose_at(w->body_ipos, w->body_iquat, body);
      link.inertia.com = frame.translation();
      link.inertia.about_com = frame.linear() * vector_at(w->body_inertia, body).asDiagonal() *
                               frame.linear().transpose();
      if (const auto stated = text_.inertias.find(body_name(body));
          stated != text_.inertias.end()) {
        const Eigen::Matrix3d exact = shift.linear() * stated->second * shift.linear().transpose();
        if ((exact - link.inertia.about_com).norm() <= kPrincipalError * exact.norm())
          link.inertia.about_com = exact;
      }
    }
    std::vector<PlacedShape> touching;
    for (int i = m_->body_geomadr[body];
         i >= 0 && i < m_->body_geomadr[body] + m_->body_geomnum[body]; ++i) {
      PlacedShape placed;
      if (!shape_of(i, name, placed)) continue;
      placed.pose = shift * placed.pose;
      const bool touches = m_->geom_contype[i] != 0 || m_->geom_conaffinity[i] != 0;
      (touches ? touching : link.visuals).push_back(std::move(placed));
    }
    link.collisions = touching;
    if (link.visuals.empty()) link.visuals = std::move(touching);
    robot_.links.push_back(std::move(link));
  }

  bool shape_of(int geom, const std::string& link, PlacedShape& placed) {
    const char* name = mj_id2name(m_, mjOBJ_GEOM, geom);
    placed.name = name ? name : "";
    placed.pose = pose_at(m_->geom_pos, m_->geom_quat, geom);
    const int material = m_->geom_matid[geom];
    const float* color = material >= 0 ? m_->mat_rgba + 4 * material : m_->geom_rgba + 4 * geom;
    placed.color = Eigen::Vector4f(color[0], color[1], color[2], color[3]);
    placed.has_color = true;
    const Vector3d size = vector_at(m_->geom_size, geom);
    switch (m_->geom_type[geom]) {
      case mjGEOM_SPHERE:
        placed.shape = Sphere{size.x()};
        return true;
      case mjGEOM_CAPSULE:
        placed.shape = Capsule{size.x(), 2 * size.y()};
        return true;
      case mjGEOM_CYLINDER:
        placed.shape = Cylinder{size.x(), 2 * size.y()};
        return true;
      case mjGEOM_BOX:
        placed.shape = Box{2 * size};
        return true;
      case mjGEOM_ELLIPSOID:
        placed.shape = MeshShape{{}, Vector3d::Ones(), ellipsoid_mesh(size)};
        return true;
      case mjGEOM_MESH:
        return mesh_of(geom, link, placed);
      default:
        return false;  // a plane or a height field belongs to the world
    }
  }

  bool mesh_of(int geom, const std::string& link, PlacedShape& placed) {
    const int id = m_->geom_dataid[geom];
    const auto mesh = text_.meshes.find(name_of(mjOBJ_MESH, id, "mesh"));
    if (mesh != text_.meshes.end()) {
      const std::string file = places_.find(link, mesh->second.file);
      if (file.empty()) return false;
      placed.pose = placed.pose * mesh->second.reference.inverse();
      placed.shape = MeshShape{file, mesh->second.scale, {}};
      return true;
    }
    MeshPart part;  // its vertices are in the model
    const int vertex = m_->mesh_vertadr[id], face = m_->mesh_faceadr[id];
    for (int i = 0; i < m_->mesh_facenum[id]; ++i) {
      const int* corner = m_->mesh_face + 3 * (face + i);
      std::array<Eigen::Vector3f, 3> p;
      for (int k = 0; k < 3; ++k)
        p[k] = Eigen::Map<const Eigen::Vector3f>(m_->mesh_vert + 3 * (vertex + corner[k]));
      const Eigen::Vector3f normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
      const auto before = static_cast<std::uint32_t>(part.vertices.size());
      part.vertices.insert(part.vertices.end(), p.begin(), p.end());
      part.normals.insert(part.normals.end(), 3, normal);
      part.triangles.push_back({before, before + 1, before + 2});
    }
    placed.shape = MeshShape{{}, Vector3d::Ones(), {{part}}};
    return true;
  }

  JointDescription* joint_at(int index) {
    const auto found = joint_index_.find(index);
    return found == joint_index_.end() ? nullptr : &robot_.joints[found->second];
  }

  // A joint equality that is a straight line is a mimic joint.
  void read_equalities() {
    size_t loops = 0, curves = 0;
    for (int i = 0; i < m_->neq; ++i) {
      if (!m_->eq_active[i]) continue;
      if (m_->eq_type[i] != mjEQ_JOINT) {
        ++loops;
        continue;
      }
      JointDescription* joint = joint_at(m_->eq_obj1id[i]);
      JointDescription* driver = m_->eq_obj2id[i] >= 0 ? joint_at(m_->eq_obj2id[i]) : nullptr;
      const mjtNum* poly = m_->eq_data + mjNEQDATA * i;
      if (!joint || (m_->eq_obj2id[i] >= 0 && !driver) || poly[2] != 0 || poly[3] != 0 ||
          poly[4] != 0) {
        ++curves;
        continue;
      }
      const double own = m_->qpos0[m_->jnt_qposadr[m_->eq_obj1id[i]]];
      if (!driver) {  // the joint is held at a value
        const double held = own + poly[0];
        joint->origin = joint->type == JointType::prismatic
                            ? joint->origin * Eigen::Translation3d(held * joint->axis)
                            : joint->origin * elementary::turn_quaternion(held, joint->axis);
        joint->type = JointType::fixed;
        continue;
      }
      joint->mimic = driver->name;
      joint->mimic_multiplier = poly[1];
      joint->mimic_offset = own + poly[0] - poly[1] * m_->qpos0[m_->jnt_qposadr[m_->eq_obj2id[i]]];
    }
    if (loops > 0)
      robot_.assumptions.push_back(text::counted(loops, "equality", "equalities") +
                                   " that close a loop or weld bodies are left out, because Ayumi "
                                   "does not simulate loops of links");
    if (curves > 0)
      robot_.assumptions.push_back(
          text::counted(curves, "joint equality", "joint equalities") +
          " that contain the square or a higher power of a joint's position are left out");
  }

  // Position actuators are servos; every other actuator has the limits of its force. If some joints
  // are driven by actuators, the other joints are passive.
  void read_actuators() {
    std::set<size_t> driven;
    std::vector<std::string> without_force;
    for (int i = 0; i < m_->nu; ++i) {
      const int joint_id = m_->actuator_trnid[2 * i];
      if (m_->actuator_trntype[i] != mjTRN_JOINT && m_->actuator_trntype[i] != mjTRN_JOINTINPARENT)
        continue;
      JointDescription* joint = joint_at(joint_id);
      if (!joint) continue;
      driven.insert(joint_index_.at(joint_id));
      const double gear = m_->actuator_gear[6 * i];
      const double gain = m_->actuator_gainprm[mjNGAIN * i];
      const mjtNum* bias = m_->actuator_biasprm + mjNBIAS * i;
      const int dof = m_->jnt_dofadr[joint_id];
      const bool position =
          m_->actuator_biastype[i] == mjBIAS_AFFINE && gain > 0 && bias[1] == -gain;
      if (m_->actuator_forcelimited[i]) {
        const mjtNum* range = m_->actuator_forcerange + 2 * i;
        joint->effort = std::abs(gear) * std::max(std::abs(range[0]), std::abs(range[1]));
      } else if (!position && m_->actuator_ctrllimited[i] && joint->effort == 0) {
        const mjtNum* range = m_->actuator_ctrlrange + 2 * i;
        joint->effort = std::abs(gear * gain) * std::max(std::abs(range[0]), std::abs(range[1]));
      }
      ServoDescription servo;
      servo.rotor_inertia = m_->dof_armature[dof];
      servo.viscous = joint->damping;
      servo.coulomb = joint->friction;
      if (position) {
        servo.kp = gear * gear * gain;
        servo.kd = 0 - gear * gear * bias[2];  // gives 0 and not -0
        if (const auto gain = text_.velocity_gains.find(joint->name);
            gain != text_.velocity_gains.end())
          servo.kd = gear * gear * gain->second;
        const auto ratio = text_.damping_ratios.find(joint->name);
        if (ratio != text_.damping_ratios.end() && ratio->second > 0)
          servo.kd = 2 * ratio->second * std::sqrt(servo.kp * m_->dof_M0[dof]);
      }
      if (joint->effort > 0 || position)
        robot_.servos[joint->name] = servo;
      else
        without_force.push_back(joint->name);
    }
    if (driven.empty()) return;
    for (const auto& [id, index] : joint_index_) {
      JointDescription& joint = robot_.joints[index];
      if (driven.contains(index) || joint.type == JointType::fixed || !joint.mimic.empty())
        continue;
      joint.effort = 0;  // no motor acts there, whatever limits the force
      ServoDescription servo;
      servo.rotor_inertia = m_->dof_armature[m_->jnt_dofadr[id]];
      servo.viscous = joint.damping;
      servo.coulomb = joint.friction;
      robot_.servos[joint.name] = servo;
    }
    if (!without_force.empty())
      robot_.assumptions.push_back("these actuators have no limit of their force: " +
                                   text::join(without_force, ", "));
  }

  void read_excluded() {
    for (int i = 0; i < m_->nexclude; ++i) {
      const int signature = m_->exclude_signature[i];
      const int a = (signature >> 16) - 1, b = (signature & 0xffff) - 1;
      if (shift_.contains(a) && shift_.contains(b))
        robot_.collision_ignore.emplace_back(body_name(a), body_name(b));
    }
  }

  void read_inertial_unit() {
    const int site =
        text_.imu_site.empty() ? -1 : mj_name2id(m_, mjOBJ_SITE, text_.imu_site.c_str());
    if (site < 0 || !shift_.contains(m_->site_bodyid[site])) return;
    robot_.sensors.imu_link = body_name(m_->site_bodyid[site]);
    robot_.sensors.imu_position = shift_.at(m_->site_bodyid[site]) * vector_at(m_->site_pos, site);
    const Isometry3d pose = pose_at(m_->site_pos, m_->site_quat, site);
    if (!pose.linear().isIdentity(1e-6))
      robot_.assumptions.push_back(
          "the site " + text_.imu_site +
          " is rotated relative to its body. Ayumi ignores this rotation and takes the axes of the "
          "body as the axes of the inertial unit");
  }

  const fs::path& path_;
  MeshPlaces places_;
  MjcfText text_;
  Model compiled_{nullptr, mj_deleteModel}, weighed_{nullptr, mj_deleteModel};
  const mjModel* m_ = nullptr;
  RobotDescription robot_;
  std::map<int, size_t> joint_index_;  // place of each of MuJoCo's joints among those of the robot
  std::map<int, Isometry3d> shift_;    // shifts of the robot's bodies
};

}  // namespace

RobotDescription parse_mjcf(const std::string& bytes, const fs::path& path,
                            const std::vector<fs::path>& packages) {
  return MjcfReader(path, packages).read(bytes);
}

}  // namespace ayumi

#else

namespace ayumi {

RobotDescription parse_mjcf(const std::string&, const std::filesystem::path& path,
                            const std::vector<std::filesystem::path>&) {
  fail(ErrorCode::bad_file, {path.string()},
       "this is an MJCF model, which Ayumi reads through MuJoCo, but "
       "this program was built without MuJoCo. Install MuJoCo (sudo apt-get "
       "install libmujoco-dev) and build Ayumi again, or convert the model to URDF");
}

}  // namespace ayumi

#endif
