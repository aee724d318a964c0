#include "ayumi/io/formats/npz_motion.hpp"

#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/formats/npz_archive.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

using Arrays = std::map<std::string, NpyArray>;

bool is_archive(const MotionInput& source) { return source.bytes.starts_with("PK\x03\x04"); }

// An archive holds the names of its files as plain text, so they can be found without unpacking it.
bool has_array(const MotionInput& source, const std::string& name) {
  return source.bytes.find(name + ".npy") != std::string::npos;
}

[[noreturn]] void refuse_names(const MotionInput& source, size_t names, size_t columns) {
  source.refuse(0, "the file has " + text::counted(names, "joint name") + ", but " +
                       text::counted(columns, "joint column") + "; give one name for each column");
}

class ArrayReader {
 public:
  explicit ArrayReader(const MotionInput& source)
      : source_(source), arrays_(read_npz(source.bytes, source.file)) {}

  const NpyArray* find(const std::string& name) const {
    const auto found = arrays_.find(name);
    if (found == arrays_.end()) return nullptr;
    if (!found->second.refused.empty()) source_.refuse(0, name + ": " + found->second.refused);
    return &found->second;
  }

  const NpyArray& at(const std::string& name) const {
    const NpyArray* array = find(name);
    if (!array) source_.refuse(0, "the array '" + name + "' is missing");
    return *array;
  }

  // The array with this name. It must be rows x width (any width if `width` is 0), or rows x bodies
  // x width.
  const NpyArray& rows(const std::string& name, size_t dimensions, size_t width,
                       size_t rows) const {
    const NpyArray& array = at(name);
    if (array.shape.size() != dimensions || (width > 0 && array.shape.back() != width) ||
        (rows > 0 && array.shape[0] != rows))
      source_.refuse(0, name + " has the shape (" + shape(array) + "), but " +
                            (rows > 0 ? std::to_string(rows) : "rows") +
                            (dimensions > 2 ? " x bodies" : "") + " x " +
                            (width > 0 ? std::to_string(width) : "joints") + " is needed");
    if (array.numbers.empty())
      source_.refuse(0, name + (array.words.empty() ? " is empty; save the motion again"
                                                    : " holds text; save it as numbers of the type "
                                                      "float64"));
    for (size_t i = 0; i < array.numbers.size(); ++i)
      if (!std::isfinite(array.numbers[i]))
        source_.refuse(0, name + ": row " +
                              std::to_string(i * array.shape[0] / array.numbers.size() + 1) +
                              " has a value that is not a finite number");
    return array;
  }

  double rate() const {
    for (const char* name : {"fps", "frame_rate", "framerate", "mocap_frame_rate"})
      if (const NpyArray* fps = find(name)) {
        if (fps->numbers.size() != 1 || !(fps->numbers[0] > 0))
          source_.refuse(0, std::string(name) + " is not a number of rows per second");
        return fps->numbers[0];
      }
    return 0;
  }

 private:
  static std::string shape(const NpyArray& array) {
    std::vector<std::string> sizes;
    for (const size_t size : array.shape) sizes.push_back(std::to_string(size));
    return text::join(sizes, ", ");
  }

  const MotionInput& source_;
  const Arrays arrays_;
};

Eigen::MatrixXd matrix_of(const NpyArray& array) {
  return Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
      array.numbers.data(), static_cast<Eigen::Index>(array.shape[0]),
      static_cast<Eigen::Index>(array.shape[1]));
}

// The pose of the first body in each row. Its quaternion is w x y z or x y z w.
std::vector<BasePose> roots_of(const MotionInput& source, const NpyArray& position,
                               const NpyArray& turn, bool scalar_first) {
  std::vector<BasePose> roots;
  const size_t rows = position.shape[0];
  for (size_t k = 0; k < rows; ++k) {
    const double* p = &position.numbers[k * position.numbers.size() / rows];
    const double* q = &turn.numbers[k * turn.numbers.size() / rows];
    BasePose base;
    base.position = {p[0], p[1], p[2]};
    base.attitude = scalar_first ? Eigen::Quaterniond(q[0], q[1], q[2], q[3])
                                 : Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
    if (!(std::abs(base.attitude.norm() - 1) < kUnitQuaternion))
      source.refuse(0, "row " + std::to_string(k + 1) + ": the quaternion of the root has length " +
                           text::brief(base.attitude.norm()) + ", but 1 is needed");
    roots.push_back(base);
  }
  return roots;
}

void append(std::vector<double>& list, const Eigen::Vector3d& v) {
  list.insert(list.end(), {v.x(), v.y(), v.z()});
}

// The rates as differences over two rows, or over one row at the ends.
template <typename Difference>
auto rate_at(size_t k, size_t rows, double rate, const Difference& difference) {
  const size_t a = k > 0 ? k - 1 : 0, b = std::min(k + 1, rows - 1);
  return (difference(a, b) * (rate / static_cast<double>(std::max<size_t>(b - a, 1)))).eval();
}

}  // namespace

std::string recognize_tracking_npz(const MotionInput& source) {
  if (!is_archive(source)) return "";
  if (has_array(source, "joint_pos") && has_array(source, "body_pos_w"))
    return "the file is a NumPy archive with joint_pos and body_pos_w";
  if (has_array(source, "dof_positions") && has_array(source, "body_positions"))
    return "the file is a NumPy archive with dof_positions and body_positions";
  return "";
}

MotionFile read_tracking_npz(const MotionInput& source) {
  const ArrayReader arrays(source);
  const bool isaac = arrays.find("joint_pos") != nullptr;
  const NpyArray& joints = arrays.rows(isaac ? "joint_pos" : "dof_positions", 2, 0, 0);
  MotionFile motion;
  motion.values = matrix_of(joints);
  motion.rate = arrays.rate();
  const size_t rows = joints.shape[0];
  motion.base = roots_of(source, arrays.rows(isaac ? "body_pos_w" : "body_positions", 3, 3, rows),
                         arrays.rows(isaac ? "body_quat_w" : "body_rotations", 3, 4, rows), true);
  if (const NpyArray* names = arrays.find(isaac ? "joint_names" : "dof_names"))
    motion.joints = names->words;
  if (!motion.joints.empty() && motion.joints.size() != joints.shape[1])
    refuse_names(source, motion.joints.size(), joints.shape[1]);
  motion.notes = {
      "units: metres and radians; quaternion order: w x y z, as the format defines it. Ayumi takes "
      "the first body as the root"};
  if (motion.joints.empty())
    motion.notes.push_back(
        "the file does not name its joints. Isaac Lab orders joints breadth first, and this may "
        "differ from the order of the robot");
  return motion;
}

namespace {

/// Makes an archive without the first `beside` and the last `beside` rows.
std::string tracking_npz(const RobotModel& model, const MotionFile& motion, size_t beside) {
  const auto rows = static_cast<size_t>(motion.rows()), bodies = model.bodies().size();
  const size_t kept = rows - 2 * beside;
  std::vector<std::vector<Eigen::Vector3d>> position(rows);
  std::vector<std::vector<Eigen::Quaterniond>> turn(rows);
  RobotData data(model);
  for (size_t k = 0; k < rows; ++k) {
    RobotState state = model.rest_state();
    state.theta = motion.values.row(static_cast<Eigen::Index>(k)).transpose();
    state.base = motion.base[k];
    update_positions(model, state, data);
    for (size_t b = 0; b < bodies; ++b) {
      position[k].push_back(motion.base[k].position + data.position[b]);
      turn[k].emplace_back(data.rotation[b]);
    }
    position[k][0] = motion.base[k].position;  // exactly the bits of the root
    turn[k][0] = motion.base[k].attitude;
  }
  std::vector<double> joint, speed, place, quaternion, linear, angular;
  for (size_t k = beside; k < rows - beside; ++k) {
    const auto values = motion.values.row(static_cast<Eigen::Index>(k));
    joint.insert(joint.end(), values.begin(), values.end());
    const Eigen::VectorXd rate = rate_at(k, rows, motion.rate, [&](size_t a, size_t b) {
      return Eigen::VectorXd((motion.values.row(static_cast<Eigen::Index>(b)) -
                              motion.values.row(static_cast<Eigen::Index>(a)))
                                 .transpose());
    });
    speed.insert(speed.end(), rate.begin(), rate.end());
    for (size_t i = 0; i < bodies; ++i) {
      append(place, position[k][i]);
      const Eigen::Quaterniond& q = turn[k][i];
      quaternion.insert(quaternion.end(), {q.w(), q.x(), q.y(), q.z()});
      append(linear, rate_at(k, rows, motion.rate, [&](size_t a, size_t b) {
               return Eigen::Vector3d(position[b][i] - position[a][i]);
             }));
      append(angular, rate_at(k, rows, motion.rate, [&](size_t a, size_t b) {
               return log_rotation(turn[b][i] * turn[a][i].conjugate());
             }));
    }
  }
  std::vector<std::string> names;
  for (const Body& body : model.bodies()) names.push_back(body.name);
  const size_t joints = motion.joints.size();
  return zip_of({{"fps.npy", npy_numbers({motion.rate}, {1})},
                 {"joint_pos.npy", npy_numbers(joint, {kept, joints})},
                 {"joint_vel.npy", npy_numbers(speed, {kept, joints})},
                 {"body_pos_w.npy", npy_numbers(place, {kept, bodies, 3})},
                 {"body_quat_w.npy", npy_numbers(quaternion, {kept, bodies, 4})},
                 {"body_lin_vel_w.npy", npy_numbers(linear, {kept, bodies, 3})},
                 {"body_ang_vel_w.npy", npy_numbers(angular, {kept, bodies, 3})},
                 {"joint_names.npy", npy_words(motion.joints, {joints})},
                 {"body_names.npy", npy_words(names, {bodies})}});
}

}  // namespace

std::vector<WrittenFile> write_tracking_npz(const RobotModel& model, const MotionFile& motion) {
  return {{"", tracking_npz(model, motion, 0)}};
}

std::string tracking_npz_within(const RobotModel& model, const MotionFile& motion) {
  return tracking_npz(model, motion, 1);
}

std::string recognize_gmr_npz(const MotionInput& source) {
  return is_archive(source) && has_array(source, "root_pos") && has_array(source, "dof_pos")
             ? "the file is a NumPy archive with root_pos and dof_pos"
             : "";
}

MotionFile read_gmr_npz(const MotionInput& source) {
  const ArrayReader arrays(source);
  const NpyArray& joints = arrays.rows("dof_pos", 2, 0, 0);
  MotionFile motion;
  motion.values = matrix_of(joints);
  motion.rate = arrays.rate();
  motion.base = roots_of(source, arrays.rows("root_pos", 2, 3, joints.shape[0]),
                         arrays.rows("root_rot", 2, 4, joints.shape[0]), false);
  for (const char* key : {"joint_names", "dof_names"})
    if (const NpyArray* names = arrays.find(key)) motion.joints = names->words;
  if (!motion.joints.empty() && motion.joints.size() != joints.shape[1])
    refuse_names(source, motion.joints.size(), joints.shape[1]);
  motion.notes = {"units: metres and radians; quaternion order: x y z w, as GMR writes it"};
  return motion;
}

std::vector<WrittenFile> write_gmr_npz(const RobotModel&, const MotionFile& motion) {
  const auto rows = static_cast<size_t>(motion.rows()), joints = motion.joints.size();
  std::vector<double> place, turn, joint;
  for (size_t k = 0; k < rows; ++k) {
    append(place, motion.base[k].position);
    const Eigen::Quaterniond& q = motion.base[k].attitude;
    turn.insert(turn.end(), {q.x(), q.y(), q.z(), q.w()});
    const auto values = motion.values.row(static_cast<Eigen::Index>(k));
    joint.insert(joint.end(), values.begin(), values.end());
  }
  return {{"", zip_of({{"fps.npy", npy_numbers({motion.rate}, {})},
                       {"root_pos.npy", npy_numbers(place, {rows, 3})},
                       {"root_rot.npy", npy_numbers(turn, {rows, 4})},
                       {"dof_pos.npy", npy_numbers(joint, {rows, joints})},
                       {"joint_names.npy", npy_words(motion.joints, {joints})}})}};
}

}  // namespace ayumi
