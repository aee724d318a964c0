#include "tests/support/random_robot.hpp"

#include <string>
#include <utility>

#include "ayumi/math/rotation.hpp"

namespace ayumi::test {
namespace {

Inertia random_inertia(Random& random) {
  Inertia inertia;
  inertia.mass = random.uniform(0.05, 1.0);
  inertia.com = random.vector(0.05);
  // A solid box of random edges in a random attitude, which is always a possible body.
  const Eigen::Vector3d e = random.vector(0.05).cwiseAbs() + Eigen::Vector3d::Constant(0.02);
  const Eigen::Vector3d d =
      inertia.mass / 12.0 *
      Eigen::Vector3d(e.y() * e.y() + e.z() * e.z(), e.x() * e.x() + e.z() * e.z(),
                      e.x() * e.x() + e.y() * e.y());
  const Eigen::Matrix3d R = exp_rotation(random.vector(3)).toRotationMatrix();
  inertia.about_com = R * d.asDiagonal() * R.transpose();
  return inertia;
}

}  // namespace

Eigen::Vector3d Random::vector(double scale) {
  return scale * Eigen::Vector3d(uniform(), uniform(), uniform());
}

Eigen::VectorXd Random::vector(int n, double scale) {
  Eigen::VectorXd v(n);
  for (int i = 0; i < n; ++i) v[i] = scale * uniform();
  return v;
}

RobotDescription random_tree(unsigned seed, int links, bool mimic) {
  Random random(seed);
  RobotDescription d;
  d.name = "random" + std::to_string(seed);
  for (int i = 0; i < links; ++i) {
    LinkDescription link;
    link.name = "link" + std::to_string(i);
    link.has_inertial = true;
    link.inertia = random_inertia(random);
    d.links.push_back(link);
    if (i == 0) continue;
    JointDescription joint;
    joint.name = "joint" + std::to_string(i);
    const int kind = static_cast<int>(random.uniform(0, 10));
    joint.type = kind == 0   ? JointType::fixed
                 : kind <= 2 ? JointType::prismatic
                             : JointType::revolute;
    joint.parent = "link" + std::to_string(static_cast<int>(random.uniform(0, i - 1e-9)));
    joint.child = link.name;
    joint.origin.translation() = random.vector(0.2);
    joint.origin.linear() = exp_rotation(random.vector(2)).toRotationMatrix();
    joint.axis = random.vector().normalized();
    joint.has_limits = true;
    joint.lower = -2;
    joint.upper = 2;
    if (mimic && i == links - 1 && joint.type == JointType::revolute && i > 3) {
      for (const JointDescription& other : d.joints)
        if (other.type == JointType::revolute && other.mimic.empty()) joint.mimic = other.name;
      joint.mimic_multiplier = -0.7;
      joint.mimic_offset = 0.1;
    }
    d.joints.push_back(joint);
  }
  return d;
}

RobotDescription odd_tree(unsigned seed, int links) {
  RobotDescription d = random_tree(seed, links, false);
  Random random(seed + 500);
  std::string driver;
  for (JointDescription& joint : d.joints) {
    if (joint.type == JointType::fixed) continue;
    const int kind = static_cast<int>(random.uniform(0, 6));
    if (kind == 0 && joint.type == JointType::revolute) joint.type = JointType::continuous;
    if (kind <= 2)
      joint.axis = (kind == 0 ? -1 : 1) * Eigen::Vector3d::Unit(static_cast<int>(seed + 1) % 3);
    if (kind == 2) joint.origin.linear().setIdentity();
    if (kind == 5 && !driver.empty()) {
      joint.mimic = driver;
      joint.mimic_multiplier = random.uniform(-1.5, 1.5);
      joint.mimic_offset = random.uniform(-0.3, 0.3);
    }
    if (kind >= 4) driver = joint.name;  // some of these are mimics of mimics
    joint.axis *= random.uniform(0.5, 3);
  }
  for (size_t i = d.joints.size(); i > 1; --i)
    std::swap(d.joints[i - 1],
              d.joints[static_cast<size_t>(random.uniform(0, static_cast<double>(i) - 1e-9))]);
  return d;
}

RobotDescription FreedTree::freed(RobotDescription d) {
  for (JointDescription& joint : d.joints) joint.mimic.clear();
  return d;
}

FreedTree::FreedTree(const RobotModel& tied) : model(freed(tied.description())) {
  G = Eigen::MatrixXd::Zero(model.dof_count(), tied.dof_count());
  offset = Eigen::VectorXd::Zero(model.dof_count());
  for (const Body& body : tied.bodies()) {
    if (body.parent < 0) continue;
    for (const Body& other : model.bodies())
      if (other.name == body.name) {
        G(other.dof, body.dof) = body.ratio;
        offset[other.dof] = body.offset;
      }
  }
}

RobotState FreedTree::state(const RobotState& s) const {
  RobotState result = s;
  result.theta = G * s.theta + offset;
  result.dtheta = G * s.dtheta;
  return result;
}

Eigen::MatrixXd FreedTree::map() const {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(6 + G.rows(), 6 + G.cols());
  T.topLeftCorner<6, 6>().setIdentity();
  T.bottomRightCorner(G.rows(), G.cols()) = G;
  return T;
}

RobotState random_state(const RobotModel& model, Random& random) {
  RobotState s;
  s.base.position = random.vector(1.0);
  s.base.attitude = exp_rotation(random.vector(2.0));
  s.base_velocity = random.vector(1.0);
  s.base_angular_velocity = random.vector(2.0);
  s.theta = random.vector(model.dof_count(), 1.0);
  s.dtheta = random.vector(model.dof_count(), 2.0);
  return s;
}

RobotState integrate(const RobotState& s, const Eigen::VectorXd& v, double h) {
  RobotState r = s;
  r.base.position += h * v.head<3>();
  r.base.attitude = (exp_rotation(h * v.segment<3>(3)) * s.base.attitude).normalized();
  r.theta += h * v.tail(s.theta.size());
  return r;
}

}  // namespace ayumi::test
