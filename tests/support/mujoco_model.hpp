#pragma once
// The same robot in MuJoCo: its tree built from a RobotModel, or from a URDF by MuJoCo's own
// reader, and states and results carried between the two. Ayumi's generalised velocity has the
// base's angular part in the world, MuJoCo's free joint in the body.

#include <mujoco/mujoco.h>
#include <unistd.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ayumi/base/text.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi::test {

/// A MuJoCo model with its workspace, the joints found by the names of a RobotModel's dofs.
class MujocoRobot {
 public:
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  /// The tree of `robot` (which has no mimic joints), with every number set exactly to Ayumi's.
  static MujocoRobot from_model(const RobotModel& robot) {
    MujocoRobot result(robot, compile(tree_text(robot), ".xml"));
    result.set_exact_numbers(robot);
    return result;
  }

  /// The robot that MuJoCo itself reads from a URDF, with a floating root link and without shapes.
  static MujocoRobot from_urdf(const RobotModel& robot, const std::string& urdf) {
    return MujocoRobot(robot, compile(floating_urdf(robot, urdf), ".urdf"));
  }

  const mjModel* model() const { return model_.get(); }
  mjData* data() const { return data_.get(); }

  /// Copies a state and computes positions, velocities, mass matrix and bias forces.
  void set_state(const RobotState& s) {
    mjData* d = data_.get();
    Eigen::Map<Eigen::Vector3d>(d->qpos) = s.base.position;
    const Eigen::Quaterniond& q = s.base.attitude;
    for (auto [i, value] : {std::pair{3, q.w()}, {4, q.x()}, {5, q.y()}, {6, q.z()}})
      d->qpos[i] = value;
    Eigen::Map<Eigen::Vector3d>(d->qvel) = s.base_velocity;
    Eigen::Map<Eigen::Vector3d>(d->qvel + 3) = q.conjugate() * s.base_angular_velocity;
    for (size_t i = 0; i < columns_.size(); ++i) {
      d->qpos[columns_[i] + 1] = s.theta[static_cast<int>(i)];
      d->qvel[columns_[i]] = s.dtheta[static_cast<int>(i)];
    }
    rotation_ = q.toRotationMatrix();
    mj_forward(model_.get(), d);
  }

  double mass() const {
    double sum = 0;
    for (int i = 1; i < model_->nbody; ++i) sum += model_->body_mass[i];
    return sum;
  }
  Eigen::Vector3d cog() const { return Eigen::Map<Eigen::Vector3d>(data_->subtree_com); }

  Eigen::MatrixXd cog_jacobian() const {
    Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor> J(3, model_->nv);
    mj_jacSubtreeCom(model_.get(), data_.get(), J.data(), 1);
    return J * to_ours();
  }
  /// The linear momentum, and the angular momentum about the COG.
  std::pair<Eigen::Vector3d, Eigen::Vector3d> momentum() const {
    mj_subtreeVel(model_.get(), data_.get());
    return {mass() * Eigen::Map<Eigen::Vector3d>(data_->subtree_linvel + 3),
            Eigen::Map<Eigen::Vector3d>(data_->subtree_angmom + 3)};
  }
  void set_rotors(const Vector& inertia, const Vector& damping) {
    for (size_t i = 0; i < columns_.size(); ++i) {
      model_->dof_armature[columns_[i]] = inertia[static_cast<int>(i)];
      model_->dof_damping[columns_[i]] = damping[static_cast<int>(i)];
    }
  }
  /// The acceleration under a generalised force in the last state that was set, both in Ayumi's
  /// coordinates.
  Vector acceleration(const Vector& force) {
    const Matrix T = to_ours();  // a permutation and a turn: its inverse is its transpose
    Eigen::Map<Vector>(data_->qfrc_applied, model_->nv) = T * force;
    mj_forward(model_.get(), data_.get());
    return T.transpose() * Eigen::Map<Vector>(data_->qacc, model_->nv);
  }
  /// The matrix that turns Ayumi's velocities, accelerations and forces into MuJoCo's in the last
  /// state that was set.
  Matrix to_theirs() const { return to_ours(); }

  /// The bias force qfrc_bias in Ayumi's coordinates.
  Vector bias_force() const {
    return to_ours().transpose() * Eigen::Map<Vector>(data_->qfrc_bias, model_->nv);
  }
  /// The mass matrix qM in Ayumi's coordinates.
  Matrix mass_matrix() const {
    const int n = model_->nv;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> full(n, n);
    mj_fullM(model_.get(), full.data(), data_->qM);
    return to_ours().transpose() * full * to_ours();
  }

 private:
  using Model = std::unique_ptr<mjModel, void (*)(mjModel*)>;
  using Data = std::unique_ptr<mjData, void (*)(mjData*)>;

  MujocoRobot(const RobotModel& robot, Model model)
      : model_(std::move(model)), data_(mj_makeData(model_.get()), mj_deleteData) {
    Eigen::Map<Eigen::Vector3d>(model_->opt.gravity) = Eigen::Vector3d(0, 0, -kGravity);
    for (const Dof& dof : robot.dofs()) {
      const int joint = mj_name2id(model_.get(), mjOBJ_JOINT, dof.name.c_str());
      if (joint < 0) throw std::runtime_error("MuJoCo has no joint " + dof.name);
      columns_.push_back(model_->jnt_dofadr[joint]);
    }
    if (model_->nv != robot.velocity_count())
      throw std::runtime_error("MuJoCo has " + std::to_string(model_->nv) + " dofs");
  }

  /// MuJoCo's generalised velocity = T * Ayumi's.
  Matrix to_ours() const {
    Matrix T = Matrix::Zero(model_->nv, model_->nv);
    T.topLeftCorner<3, 3>().setIdentity();
    T.block<3, 3>(3, 3) = rotation_.transpose();
    for (size_t i = 0; i < columns_.size(); ++i) T(columns_[i], 6 + static_cast<int>(i)) = 1;
    return T;
  }

  static Model compile(const std::string& xml, const std::string& extension) {
    const auto file = std::filesystem::temp_directory_path() /
                      ("ayumi_mujoco_" + std::to_string(::getpid()) + extension);
    std::ofstream(file) << xml;
    char error[1000] = "";
    Model model(mj_loadXML(file.c_str(), nullptr, error, sizeof error), mj_deleteModel);
    std::filesystem::remove(file);
    if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
    return model;
  }

  static std::string body_text(const RobotModel& robot, int index) {
    const Body& body = robot.bodies()[static_cast<size_t>(index)];
    std::string joint = "<freejoint/>";
    if (body.parent >= 0)
      joint = "<joint name='" + robot.dofs()[static_cast<size_t>(body.dof)].name + "' type='" +
              (body.prismatic ? "slide" : "hinge") + "' axis='1 0 0'/>";
    std::string text = "<body name='body" + std::to_string(index) + "'>" + joint +
                       "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>";
    for (size_t i = 0; i < robot.bodies().size(); ++i)
      if (robot.bodies()[i].parent == index) text += body_text(robot, static_cast<int>(i));
    return text + "</body>";
  }

  static std::string tree_text(const RobotModel& robot) {
    return "<mujoco><worldbody>" + body_text(robot, 0) + "</worldbody></mujoco>";
  }

  /// Finds the tree's bodies by number, and overwrites the values that the compiler rounded or
  /// simplified.
  void set_exact_numbers(const RobotModel& robot) {
    mjModel* m = model_.get();
    for (size_t i = 0; i < robot.bodies().size(); ++i) {
      const Body& body = robot.bodies()[i];
      const int id = mj_name2id(m, mjOBJ_BODY, ("body" + std::to_string(i)).c_str());
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia.about_com);
      Eigen::Matrix3d axes = principal.eigenvectors();
      if (axes.determinant() < 0) axes.col(2) *= -1;
      m->body_mass[id] = body.inertia.mass;
      Eigen::Map<Eigen::Vector3d>(m->body_ipos + 3 * id) = body.inertia.com;
      Eigen::Map<Eigen::Vector3d>(m->body_inertia + 3 * id) = principal.eigenvalues();
      set_quaternion(m->body_iquat + 4 * id, Eigen::Quaterniond(axes));
      m->body_sameframe[id] = 0;
      m->body_simple[id] = 0;
      if (body.parent < 0) continue;
      Eigen::Map<Eigen::Vector3d>(m->body_pos + 3 * id) = body.placement.translation();
      set_quaternion(m->body_quat + 4 * id, Eigen::Quaterniond(body.placement.linear()));
      Eigen::Map<Eigen::Vector3d>(m->jnt_axis + 3 * m->body_jntadr[id]) = body.axis;
    }
    for (int i = 0; i < m->nv; ++i) m->dof_simplenum[i] = 0;
    mj_setConst(m, data_.get());
  }

  static void set_quaternion(mjtNum* to, const Eigen::Quaterniond& q) {
    to[0] = q.w(), to[1] = q.x(), to[2] = q.y(), to[3] = q.z();
  }

  /// The URDF without shapes and materials, with its root attached to the world by a floating
  /// joint.
  static std::string floating_urdf(const RobotModel& robot, std::string urdf) {
    for (const std::string element : {"visual", "collision", "transmission", "gazebo"})
      for (size_t begin; (begin = urdf.find("<" + element)) != std::string::npos;) {
        const std::string closing = "</" + element + ">";
        const size_t end = urdf.find(closing, begin);
        if (end == std::string::npos) throw std::runtime_error("URDF: unclosed " + element);
        urdf.erase(begin, end + closing.size() - begin);
      }
    const std::string world =
        "<mujoco><compiler fusestatic='true' balanceinertia='false' boundmass='0' "
        "boundinertia='0'/></mujoco><link name='world'/><joint name='floating_root' "
        "type='floating'><parent link='world'/><child link='" +
        robot.bodies().front().name + "'/></joint>";
    const size_t end = urdf.rfind("</robot>");
    if (end == std::string::npos) throw std::runtime_error("URDF: no </robot>");
    return urdf.insert(end, world);
  }

  Model model_;
  Data data_;
  std::vector<int> columns_;  ///< columns of MuJoCo's qvel, by dof
  Eigen::Matrix3d rotation_ = Eigen::Matrix3d::Identity();
};

}  // namespace ayumi::test
