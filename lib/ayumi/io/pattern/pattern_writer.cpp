#include <nlohmann/json.hpp>

#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"
#include "ayumi/io/pattern/scenario_text.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  explicit Writer(const Pattern& pattern) : pattern_(pattern) {}

  std::string whole() const {
    Members top;
    if (!pattern_.schema.empty()) top.add("$schema", quoted(pattern_.schema));
    top.add("format", quoted("ayumi.pattern/1"));
    if (!pattern_.name.empty()) top.add("name", quoted(pattern_.name));
    top.add("robot", quoted(pattern_.robot));
    if (!pattern_.profile.empty()) top.add("profile", quoted(pattern_.profile));
    top.add("units", Members().add("angle", quoted(pattern_.degrees ? "deg" : "rad")).object());
    add_postures(top);
    add_defaults(top);
    add_start(top);
    add_list(top, "phases", pattern_.phases, [this](const Phase& each) { return phase(each); });
    add_list(top, "keyframes", pattern_.keyframes,
             [this](const Keyframe& each) { return keyframe(each); });
    if (pattern_.table) top.add("table", quoted(pattern_.table->file));
    top.add("world", world_text(pattern_.world, pattern_.degrees));
    add_controller(top);
    add_list(top, "scenario", pattern_.scenario,
             [this](const Disturbance& each) { return disturbance_text(each, pattern_.degrees); });
    add_tolerances(top);
    add_repair(top);
    if (!pattern_.uncertainty.empty())
      top.add("uncertainty", uncertainty_text(pattern_.uncertainty, pattern_.degrees));
    if (pattern_.correction) top.add("correction", correction_text(*pattern_.correction));
    return top.lines('{', '}', "") + "\n";
  }

 private:
  template <typename Item, typename Text>
  static void add_list(Members& top, const char* key, const std::vector<Item>& items,
                       const Text& text_of) {
    if (items.empty()) return;
    Members list;
    for (const Item& each : items) list.item(text_of(each));
    top.add(key, list.lines('[', ']', "  "));
  }

  std::string angle(double radians) const { return angle_text(radians, pattern_.degrees); }

  std::string joint_angles(const std::map<std::string, double>& joints) const {
    Members members;
    for (const auto& [joint, value] : joints) members.add(joint, angle(value));
    return members.object();
  }

  std::string foothold(const Foothold& foot) const {
    const Eigen::Vector3d& p = foot.position;
    if (foot.rpy.x() != 0 || foot.rpy.y() != 0) {
      Members rpy;
      for (const double each : foot.rpy) rpy.item(angle(each));
      return Members().add("position", vector_text(p)).add("rpy", rpy.array()).object();
    }
    Members list;
    list.item(number(p.x())).item(number(p.y()));
    if (p.z() != 0 || foot.rpy.z() != 0) list.item(number(p.z()));
    if (foot.rpy.z() != 0) list.item(angle(foot.rpy.z()));
    return list.array();
  }

  void add_postures(Members& top) const {
    if (pattern_.postures.empty()) return;
    Members postures;
    for (const auto& [name, joints] : pattern_.postures) postures.add(name, joint_angles(joints));
    top.add("postures", postures.lines('{', '}', "  "));
  }

  void add_defaults(Members& top) const {
    Members defaults;
    defaults.add("interpolation", quoted(name_of(pattern_.interpolation)));
    defaults.add("posture", quoted(pattern_.default_posture));
    if (pattern_.cog_height != 0) defaults.add("cog_height", number(pattern_.cog_height));
    if (!pattern_.full_model) defaults.add("cog_model", quoted("point_mass"));
    top.add("defaults", defaults.object());
  }

  std::string feet(const std::array<std::optional<Foothold>, 2>& poses) const {
    Members members;
    for (const Side side : {Side::left, Side::right})
      if (const auto& pose = poses[static_cast<size_t>(side)])
        members.add(name_of(side), foothold(*pose));
    return members.empty() ? "" : members.object();
  }

  void add_start(Members& top) const {
    const std::string start = feet(pattern_.start_feet);
    if (!start.empty()) top.add("start", start);
  }

  std::string goal(const CogGoal& goal) const {
    return Members().add("cog", vector_text(goal.displacement)).object();
  }
  std::string goal(const CogVelocityGoal& goal) const {
    return Members().add("cog_velocity", vector_text(goal.velocity)).object();
  }
  std::string goal(const StepGoal& goal) const {
    Members members;
    const bool in_place = goal.velocity.isZero(0) && goal.turn == 0;
    if (in_place) members.add("step", quoted("in_place"));
    if (goal.steps > 0) members.add("steps", std::to_string(goal.steps));
    if (!in_place)
      members.add(
          "velocity",
          Members().item(number(goal.velocity.x())).item(number(goal.velocity.y())).array());
    if (goal.turn != 0) members.add("turn", angle(goal.turn));
    return members.object();
  }
  std::string goal(const JumpGoal& goal) const {
    Members jump;
    jump.add("height", number(goal.height)).add("stoop", number(goal.stoop));
    if (goal.forward != 0) jump.add("forward", number(goal.forward));
    if (goal.times != 1) jump.add("times", std::to_string(goal.times));
    if (goal.release == JumpGoal::Release::spring) jump.add("release", quoted("spring"));
    return Members().add("jump", jump.object()).object();
  }

  std::string step(const RelativeStep& step) const {
    Members members;
    if (step.forward != 0) members.add("forward", number(step.forward));
    if (step.side != 0) members.add("side", number(step.side));
    if (step.up != 0) members.add("up", number(step.up));
    if (step.turn != 0) members.add("turn", angle(step.turn));
    return members.empty() ? "{}" : members.object();
  }

  std::string phase(const Phase& each) const {
    Members members;
    members.add("until", number(each.until));
    if (each.viip)
      return members.add("viip", std::visit([&](const auto& g) { return goal(g); }, *each.viip))
          .object();
    members.add("support", quoted(name_of(each.support)));
    if (each.swing) {
      Members swing;
      swing.add("foot", quoted(name_of(each.swing->foot)));
      if (each.swing->step)
        swing.add("step", step(*each.swing->step));
      else
        swing.add("to", foothold(each.swing->to));
      members.add("swing", swing.add("lift", number(each.swing->lift)).object());
    }
    return members.object();
  }

  static std::string zmp(const ZmpKey& key) {
    switch (key.place) {
      case ZmpKey::Place::left:
        return quoted("left");
      case ZmpKey::Place::right:
        return quoted("right");
      case ZmpKey::Place::center:
        return quoted("center");
      case ZmpKey::Place::point:
        break;
    }
    return Members().item(number(key.point.x())).item(number(key.point.y())).array();
  }

  static std::string target(const LinkTarget& target) {
    if (!target.position) return quoted("free");
    const bool in_trunk = target.frame == LinkTarget::Frame::trunk;
    if (!target.direction && !in_trunk) return vector_text(*target.position);
    Members members;
    members.add("position", vector_text(*target.position));
    if (target.direction) members.add("direction", vector_text(*target.direction));
    if (in_trunk) members.add("frame", quoted("trunk"));
    return members.object();
  }

  std::string keyframe(const Keyframe& key) const {
    Members members;
    members.add("t", number(key.t));
    if (key.interpolation) members.add("interpolation", quoted(name_of(*key.interpolation)));
    if (key.posture) members.add("posture", quoted(*key.posture));
    if (!key.joints.empty())
      members.add(key.posture ? "joints" : "posture", joint_angles(key.joints));
    if (key.zmp) members.add("zmp", zmp(*key.zmp));
    Members cog;
    if (key.cog_x) cog.add("x", number(*key.cog_x));
    if (key.cog_y) cog.add("y", number(*key.cog_y));
    if (key.cog_height) cog.add("height", number(*key.cog_height));
    if (!cog.empty()) members.add("cog", cog.object());
    if (key.fz) members.add("fz", number(*key.fz));
    if (key.torso)
      members.add("torso", Members()
                               .add("roll", angle(key.torso->x()))
                               .add("pitch", angle(key.torso->y()))
                               .add("yaw", angle(key.torso->z()))
                               .object());
    const std::string poses = feet(key.feet);
    if (!poses.empty()) members.add("feet", poses);
    Members hands;
    for (const auto& [link, goal] : key.hands) hands.add(link, target(goal));
    if (!hands.empty()) members.add("hands", hands.object());
    if (key.gaze) members.add("gaze", target(*key.gaze));
    Members weights;
    for (const auto& [joint, weight] : key.weights) weights.add(joint, number(weight));
    if (!weights.empty()) members.add("weights", weights.object());
    return members.object();
  }

  void add_controller(Members& top) const {
    Members members;
    members.add("type", quoted(name_of(pattern_.controller.type)));
    Members gains;
    for (const auto& [name, value] : pattern_.controller.gains) gains.add(name, number(value));
    if (!gains.empty()) members.add("gains", gains.object());
    top.add("controller", members.object());
  }

  void add_tolerances(Members& top) const {
    Members members;
    for (const auto& [kind, value] : pattern_.tolerances) members.add(kind, number(value));
    if (!members.empty()) top.add("tolerances", members.object());
  }

  void add_repair(Members& top) const {
    const RepairPreferences& wishes = pattern_.repair;
    if (wishes.empty()) return;
    Members lock, joints, feet, keys, windows, weights, members;
    for (const std::string& joint : wishes.joints) joints.item(quoted(joint));
    for (const Side side : {Side::left, Side::right})
      if (wishes.feet[static_cast<size_t>(side)]) feet.item(quoted(name_of(side)));
    for (const int key : wishes.keyframes) keys.item(std::to_string(key));
    for (const auto& [begin, end] : wishes.windows)
      windows.item(Members().item(number(begin)).item(number(end)).array());
    for (const auto& [joint, weight] : wishes.weights) weights.add(joint, number(weight));
    if (!joints.empty()) lock.add("joints", joints.array());
    if (!feet.empty()) lock.add("feet", feet.array());
    if (!keys.empty()) lock.add("keyframes", keys.array());
    if (!windows.empty()) lock.add("windows", windows.array());
    if (!lock.empty()) members.add("lock", lock.object());
    if (!weights.empty()) members.add("weights", weights.object());
    if (wishes.trust) members.add("trust", quoted(name_of(*wishes.trust)));
    if (wishes.margin) members.add("margin", number(*wishes.margin));
    if (wishes.safety) members.add("safety", number(*wishes.safety));
    top.add("repair", members.object());
  }

  const Pattern& pattern_;
};

}  // namespace

std::string rebased(const std::string& name, const fs::path& from, const fs::path& to) {
  if (fs::path(name).is_absolute() || from.lexically_normal() == to.lexically_normal()) return name;
  std::error_code ignored;
  const fs::path relative = fs::relative(from / name, to.empty() ? fs::path(".") : to, ignored);
  return relative.empty() ? fs::absolute(from / name).string() : relative.string();
}

Pattern moved_to_folder(const Pattern& pattern, const fs::path& to) {
  Pattern moved = pattern;
  if (pattern.file.empty()) return moved;
  const fs::path from = fs::path(pattern.file).parent_path();
  if (moved.table) moved.table->file = rebased(moved.table->file, from, to);
  if (names_a_path(moved.robot)) {
    moved.robot = rebased(moved.robot, from, to);
    // The robot is a folder beside the pattern, or the pattern's own folder. Its name alone would
    // mean a bundled robot.
    if (!names_a_path(moved.robot)) moved.robot = "./" + moved.robot;
  }
  if (!moved.schema.empty() && moved.schema.find("://") == std::string::npos)
    moved.schema = rebased(moved.schema, from, to);
  return moved;
}

std::string correction_text(const CorrectionTrack& track) {
  Members columns;
  for (const char* const name :
       {"base.x[m]", "base.y[m]", "base.z[m]", "base.rx[rad]", "base.ry[rad]", "base.rz[rad]"})
    columns.item(quoted(name));
  for (const std::string& joint : track.joints) columns.item(quoted("theta." + joint + "[rad]"));
  Members rows;
  for (Eigen::Index r = 0; r < track.coefficients.rows(); ++r) {
    Members row;
    for (Eigen::Index c = 0; c < track.coefficients.cols(); ++c)
      row.item(number(track.coefficients(r, c)));
    rows.item(row.array());
  }
  Members members;
  members.add("begin", number(track.begin)).add("spacing", number(track.spacing));
  members.add("columns", columns.array());
  members.add("coefficients", track.coefficients.rows() == 0 ? "[]" : rows.lines('[', ']', "    "));
  Members smooth;
  for (const SmoothWindow& window : track.smooth)
    smooth.item(Members()
                    .item(number(window.begin))
                    .item(number(window.end))
                    .item(number(window.spacing))
                    .array());
  if (!track.smooth.empty()) members.add("smooth", smooth.array());
  return members.lines('{', '}', "  ");
}

std::string pattern_text(const Pattern& pattern, const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& line : comments) text += line.empty() ? "//\n" : "// " + line + "\n";
  if (!pattern.parameters.empty()) {
    std::vector<std::string> values;
    for (const auto& [name, value] : pattern.parameters)
      values.push_back(name + " = " + number(value));
    text += "// Written with the parameters " + text::join(values, ", ") + ".\n";
  }
  return text + Writer(pattern).whole();
}

void write_pattern(const fs::path& path, const Pattern& pattern,
                   const std::vector<std::string>& comments) {
  write_file(path, pattern_text(moved_to_folder(pattern, path.parent_path()), comments));
}

}  // namespace ayumi
