#include "ayumi/io/formats/animation.hpp"

#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"

namespace ayumi {

namespace {

// Turns the axes x forward, y left, z up into z forward, x left, y up.
Eigen::Matrix3d y_up() {
  Eigen::Matrix3d turn;
  turn << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return turn;
}

std::string centimetres(const Eigen::Vector3d& metres) {
  const Eigen::Vector3d v = 100 * (y_up() * metres);
  return text::brief(v.x(), 8) + " " + text::brief(v.y(), 8) + " " + text::brief(v.z(), 8);
}

// The three angles of R = Rz Rx Ry in degrees, as text.
std::string channels(const Eigen::Matrix3d& rotation) {
  const Eigen::Matrix3d r = y_up() * rotation * y_up().transpose();
  const double x = elementary::asin(std::clamp(r(2, 1), -1.0, 1.0));
  const double z = elementary::atan2(-r(0, 1), r(1, 1)), y = elementary::atan2(-r(2, 0), r(2, 2));
  constexpr double degree = 180 / EIGEN_PI;
  return text::brief(z * degree, 8) + " " + text::brief(x * degree, 8) + " " +
         text::brief(y * degree, 8);
}

std::vector<size_t> children_of(const RobotModel& model, size_t body) {
  std::vector<size_t> children;
  for (size_t i = 1; i < model.bodies().size(); ++i)
    if (model.bodies()[i].parent == static_cast<int>(body)) children.push_back(i);
  return children;
}

void add_joint(const RobotModel& model, size_t body, const std::string& indent,
               std::vector<size_t>& order, std::string& text) {
  order.push_back(body);
  const Body& made = model.bodies()[body];
  text += indent + (body == 0 ? "ROOT " : "JOINT ") + made.name + "\n" + indent + "{\n";
  const std::string inner = indent + "  ";
  text += inner + "OFFSET " +
          centimetres(body == 0 ? Eigen::Vector3d(0, 0, 0)
                                : Eigen::Vector3d(made.placement.translation())) +
          "\n";
  text += inner + (body == 0 ? "CHANNELS 6 Xposition Yposition Zposition " : "CHANNELS 3 ") +
          "Zrotation Xrotation Yrotation\n";
  const std::vector<size_t> children = children_of(model, body);
  for (const size_t child : children) add_joint(model, child, inner, order, text);
  if (children.empty())
    text += inner + "End Site\n" + inner + "{\n" + inner + "  OFFSET " +
            centimetres(made.inertia.com) + "\n" + inner + "}\n";
  text += indent + "}\n";
}

}  // namespace

std::vector<WrittenFile> write_bvh(const RobotModel& model, const MotionFile& motion) {
  std::vector<size_t> order;
  std::string text = "HIERARCHY\n";
  add_joint(model, 0, "", order, text);
  text += "MOTION\nFrames: " + std::to_string(motion.rows()) +
          "\nFrame Time: " + text::brief(1 / motion.rate, 9) + "\n";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const BasePose& base = motion.base[static_cast<size_t>(k)];
    text += centimetres(base.position) + " " + channels(base.attitude.toRotationMatrix());
    for (size_t i = 1; i < order.size(); ++i) {
      const Body& body = model.bodies()[order[i]];
      Eigen::Matrix3d turn = body.placement.linear();
      if (!body.prismatic)
        turn = turn * elementary::turn_matrix(body.ratio * motion.values(k, body.dof) + body.offset,
                                              body.axis);
      text += " " + channels(turn);
    }
    text += "\n";
  }
  return {{"", text}};
}

std::vector<WrittenFile> write_mujoco_keys(const RobotModel&, const MotionFile& motion) {
  std::string text = "<mujoco>\n  <!-- qpos: root x y z, quaternion w x y z, then " +
                     text::join(motion.joints, ", ") + " -->\n  <keyframe>\n";
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const BasePose& base = motion.base[static_cast<size_t>(k)];
    const Eigen::Quaterniond& q = base.attitude;
    text += "    <key name=\"k" + std::to_string(k) + "\" time=\"" +
            text::exact(motion.times[static_cast<size_t>(k)]) + "\" qpos=\"";
    for (const double value :
         {base.position.x(), base.position.y(), base.position.z(), q.w(), q.x(), q.y()})
      text += text::exact(value) + " ";
    text += text::exact(q.z());
    for (const double value : motion.values.row(k)) text += " " + text::exact(value);
    text += "\"/>\n";
  }
  return {{"", text + "  </keyframe>\n</mujoco>\n"}};
}

}  // namespace ayumi
