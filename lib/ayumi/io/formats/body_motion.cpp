#include "ayumi/io/formats/body_motion.hpp"

#include <cmath>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/yaml/yaml_tree.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

constexpr int kNewestVersion = 4;

class BodyMotionReader {
 public:
  explicit BodyMotionReader(const MotionInput& source)
      : source_(source), root_(parse_yaml(source.bytes, source.file)) {}

  MotionFile whole() {
    version_ = 1;
    if (const YamlNode* version = root_.find("format_version", "formatVersion"))
      version_ = source_.number(version->text, line_of(*version), "format_version");
    if (version_ < 1 || version_ >= kNewestVersion + 1)
      source_.refuse(
          static_cast<size_t>(root_.line),
          "format version " + text::brief(version_) + " is unknown; Ayumi reads versions 1 to 4");
    motion_.rate = number_of(root_, "frame_rate", "frameRate", 0);
    const YamlNode* components = root_.find("components");
    if (!components || !components->is_list())
      source_.refuse(line_of(root_), "`components` is missing");
    for (const YamlNode& component : components->items) read_component(component);
    if (motion_.values.size() == 0)
      source_.refuse(line_of(root_),
                     "there is no sequence of joint angles (JointDisplacement); add one");
    if (motion_.rate == 0) {
      motion_.rate = 100;  // Definition: Choreonoid assumes this rate if the file states none
      motion_.notes.push_back("frame rate: 100 per second, because the file states none");
    }
    place_zmp();
    if (!left_out_.empty())
      motion_.notes.push_back("sequences left out: " + text::join(left_out_, ", "));
    motion_.notes.push_back(
        "units: radians and metres, as the format defines them" +
        (motion_.base.empty() ? std::string() : "; quaternion order: " + order_));
    return std::move(motion_);
  }

 private:
  static size_t line_of(const YamlNode& node) { return static_cast<size_t>(node.line); }

  // A list of single numbers has no nodes for them.
  static const YamlNode& frame_at(const YamlNode& frames, size_t k) {
    return k < frames.items.size() ? frames.items[k] : frames;
  }

  double number_of(const YamlNode& node, const char* key, const char* other, double otherwise) {
    const YamlNode* found = node.find(key, other);
    return found ? source_.number(found->text, line_of(*found), key) : otherwise;
  }

  static std::string text_of(const YamlNode& node, const char* key, const char* other = "") {
    const YamlNode* found = node.find(key, other);
    return found ? found->text : "";
  }

  static bool is_true(const std::string& text) { return text == "true" || text == "True"; }

  void read_component(const YamlNode& component) {
    const std::string type = text_of(component, "type");
    std::string content = text_of(component, "content", "purpose");
    const YamlNode* frames = component.find("frames");
    if (!frames || !frames->is_list())
      source_.refuse(line_of(component), "the sequence '" + content + "' has no frames");
    const double rate = number_of(component, "frame_rate", "frameRate", 0);
    if (rate != 0) {
      if (motion_.rate != 0 && rate != motion_.rate)
        source_.refuse(line_of(component), "the sequence '" + content + "' has " +
                                               text::brief(rate) +
                                               " frames per second, but another sequence has " +
                                               text::brief(motion_.rate));
      motion_.rate = rate;
    }
    timed_ = is_true(text_of(component, "has_frame_time", "hasFrameTime"));
    // Version 3 has its own words, as the content or as the type.
    const auto is = [&](const char* word) { return content == word || type == word; };
    if (is("JointDisplacement") || is("JointPosition") || is("MultiJointDisplacementSeq"))
      read_joints(component, *frames);
    else if (is("LinkPosition") || is("MultiLinkPositionSeq"))
      read_root(component, *frames);
    else if (is("ZMP") || is("RelativeZMP") || is("ZMPSeq"))
      read_zmp(component, *frames, is("RelativeZMP"));
    else if (content == "COG" && type == "Vector3Seq")
      motion_.cog = vectors_of(*frames);
    else if (content == "VerticalForce")
      for (const std::vector<double>& row : rows_of(*frames, 1)) motion_.fz.push_back(row[0]);
    else
      left_out_.push_back(content.empty() ? type : content);
  }

  // Reads rows of `width` numbers without their times. If `width` is 0, the first row decides it.
  std::vector<std::vector<double>> rows_of(const YamlNode& frames, size_t width) {
    std::vector<std::vector<double>> rows;
    if (frames.items.empty() && !frames.numbers.empty())  // the value is one list of single numbers
      for (const double number : frames.numbers) rows.push_back({number});
    for (const YamlNode& frame : frames.items) {
      const YamlNode* row = &frame;
      if (row->is_list() && row->numbers.empty() && row->items.size() == 1) row = &row->items[0];
      if (!row->is_list() || row->numbers.empty())
        source_.refuse(line_of(frame), "a list of finite numbers is needed");
      rows.push_back(row->numbers);
      if (timed_) rows.back().erase(rows.back().begin());
      const size_t needed = width > 0 ? width : rows.front().size();
      if (rows.back().size() != needed)
        source_.refuse(line_of(frame), "the frame has " +
                                           text::counted(rows.back().size(), "value") + ", but " +
                                           std::to_string(needed) + " are needed");
    }
    if (rows.empty())
      source_.refuse(
          line_of(frames),
          "the sequence has no frame, so there is no motion to read; write the file again");
    if (rows_ == 0) rows_ = rows.size();
    if (rows.size() != rows_)
      source_.refuse(line_of(frames), "the sequence has " + text::counted(rows.size(), "frame") +
                                          ", but another sequence has " + std::to_string(rows_));
    return rows;
  }

  std::vector<Eigen::Vector3d> vectors_of(const YamlNode& frames) {
    std::vector<Eigen::Vector3d> result;
    for (const std::vector<double>& row : rows_of(frames, 3))
      result.emplace_back(row[0], row[1], row[2]);
    return result;
  }

  void read_joints(const YamlNode& component, const YamlNode& frames) {
    const double parts = number_of(component, "num_parts", "numParts", 0);
    const std::vector<std::vector<double>> rows =
        rows_of(frames, parts > 0 ? static_cast<size_t>(parts) : 0);
    const auto width = static_cast<Eigen::Index>(rows.front().size());
    motion_.values.resize(static_cast<Eigen::Index>(rows.size()), width);
    for (size_t k = 0; k < rows.size(); ++k)
      motion_.values.row(static_cast<Eigen::Index>(k)) =
          Eigen::Map<const Eigen::RowVectorXd>(rows[k].data(), width);
    const YamlNode* labels = component.find("part_labels", "partLabels");
    if (labels && labels->items.size() == rows.front().size())
      for (const YamlNode& label : labels->items) motion_.joints.push_back(label.text);
  }

  void read_root(const YamlNode& component, const YamlNode& frames) {
    const std::string form = text_of(component, "SE3Format", "format");
    std::vector<std::vector<double>> rows;
    if (number_of(component, "num_parts", "numParts", 1) == 1) {
      rows = rows_of(frames, 0);
    } else {
      YamlNode roots = frames;
      for (YamlNode& frame : roots.items)
        if (frame.items.size() > 1) frame.items.resize(1);
      rows = rows_of(roots, 0);
      motion_.notes.push_back(
          "the file has positions of several links; Ayumi reads the positions of the first link as "
          "the positions of the root");
    }
    const size_t width = form == "XYZRPY" ? 6 : 7;
    const bool scalar_last = form == "XYZQXQYQZQW";
    order_ = width == 6    ? "none, because the file has roll, pitch and yaw"
             : scalar_last ? "x y z w, as the file says"
                           : "w x y z" + std::string(form.empty() ? " (the format's default)"
                                                                  : ", as the file says");
    for (size_t k = 0; k < rows.size(); ++k) {
      const std::vector<double>& row = rows[k];
      if (row.size() != width)
        source_.refuse(line_of(frame_at(frames, k)),
                       "the position of a link has " + text::counted(row.size(), "value") +
                           ", but " + std::to_string(width) + " are needed");
      BasePose base;
      base.position = {row[0], row[1], row[2]};
      if (width == 6) {
        base.attitude = Eigen::Quaterniond(rpy_to_matrix({row[3], row[4], row[5]}));
      } else {
        base.attitude = scalar_last ? Eigen::Quaterniond(row[6], row[3], row[4], row[5])
                                    : Eigen::Quaterniond(row[3], row[4], row[5], row[6]);
        if (!(std::abs(base.attitude.norm() - 1) < kUnitQuaternion))
          source_.refuse(line_of(frame_at(frames, k)), "the quaternion has length " +
                                                           text::brief(base.attitude.norm()) +
                                                           ", but 1 is needed");
      }
      motion_.base.push_back(base);
    }
  }

  void read_zmp(const YamlNode& component, const YamlNode& frames, bool relative) {
    motion_.zmp = vectors_of(frames);
    zmp_relative_ = relative || is_true(text_of(component, "is_root_relative", "isRootRelative"));
  }

  void place_zmp() {
    if (motion_.zmp.empty()) return;
    if (!zmp_relative_) {
      motion_.notes.push_back("the ZMP is in the world, as the file says");
    } else if (motion_.base.empty()) {
      motion_.zmp.clear();
      motion_.notes.push_back(
          "the ZMP is left out, because it is relative to the root and the file has no root");
    } else {
      for (size_t k = 0; k < motion_.zmp.size(); ++k)
        motion_.zmp[k] = motion_.base[k].position + motion_.base[k].attitude * motion_.zmp[k];
      motion_.notes.push_back("the ZMP is relative to the root, as the file says");
    }
  }

  const MotionInput& source_;
  const YamlNode root_;
  MotionFile motion_;
  double version_ = 1;
  bool timed_ = false, zmp_relative_ = false;
  size_t rows_ = 0;
  std::string order_;
  std::vector<std::string> left_out_;
};

template <typename Values>
std::string flow_list(const Values& values) {
  std::string text = "[ ";
  bool first = true;
  for (const double value : values) {
    text += (first ? "" : ", ") + text::exact(value);
    first = false;
  }
  return text + " ]";
}

std::string head_of(const char* type, const char* content, const std::string& rest) {
  return "  -\n    type: " + std::string(type) + "\n    content: " + content + "\n" + rest;
}

}  // namespace

std::string recognize_body_motion(const MotionInput& source) {
  const std::string head = source.bytes.substr(0, 4000);
  const bool body = head.find("BodyMotion") != std::string::npos;
  return body && (head.find("components") != std::string::npos ||
                  head.find("CompositeSeq") != std::string::npos)
             ? "the file says that its content is a BodyMotion"
             : "";
}

MotionFile read_body_motion(const MotionInput& source) { return BodyMotionReader(source).whole(); }

std::vector<WrittenFile> write_body_motion(const RobotModel&, const MotionFile& motion) {
  const std::string counts = "frame_rate: " + text::exact(motion.rate) + "\n";
  const std::string frames = "num_frames: " + std::to_string(motion.rows()) + "\n";
  const std::string inner = "    " + counts + "    " + frames;
  std::string text = "type: CompositeSeq\ncontent: BodyMotion\nformat_version: 4\n" + counts +
                     frames + "components:\n";
  std::vector<std::string> names;
  for (const std::string& joint : motion.joints) names.push_back("\"" + joint + "\"");
  text += head_of("MultiSE3Seq", "LinkPosition",
                  inner + "    num_parts: 1\n    SE3Format: XYZQWQXQYQZ\n    frames:\n");
  for (const BasePose& base : motion.base) {
    const Eigen::Quaterniond& q = base.attitude;
    text += "      - [ " +
            flow_list(std::vector<double>{base.position.x(), base.position.y(), base.position.z(),
                                          q.w(), q.x(), q.y(), q.z()}) +
            " ]\n";
  }
  text += head_of("MultiValueSeq", "JointDisplacement",
                  inner + "    num_parts: " + std::to_string(motion.joints.size()) +
                      "\n    part_labels: [ " + text::join(names, ", ") + " ]\n    frames:\n");
  for (Eigen::Index k = 0; k < motion.rows(); ++k)
    text += "      - " + flow_list(motion.values.row(k)) + "\n";
  const auto vectors = [&](const char* content, const std::vector<Eigen::Vector3d>& values) {
    if (values.empty()) return;
    text += head_of("Vector3Seq", content, inner + "    frames:\n");
    for (const Eigen::Vector3d& value : values) text += "      - " + flow_list(value) + "\n";
  };
  vectors("ZMP", motion.zmp);
  vectors("COG", motion.cog);
  if (!motion.fz.empty()) {
    text += head_of("MultiValueSeq", "VerticalForce", inner + "    num_parts: 1\n    frames:\n");
    for (const double force : motion.fz) text += "      - [ " + text::exact(force) + " ]\n";
  }
  return {{"", text}};
}

}  // namespace ayumi
