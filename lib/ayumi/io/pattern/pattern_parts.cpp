// The parts of a pattern file: phases, keyframes, controller, correction.
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/io/pattern/pattern_scope.hpp"

namespace ayumi {

namespace {

Side read_side(const JsonNode& node) {
  return node.one_of({"left", "right"}) == "left" ? Side::left : Side::right;
}

Support read_support(const JsonNode& node) {
  const std::string name = node.one_of({"both", "left", "right", "none"});
  for (const Support each : {Support::both, Support::left, Support::right})
    if (name == name_of(each)) return each;
  return Support::none;
}

// Largest height to which a foot is lifted [m]. Chosen: more than any legs can reach.
constexpr double kLargestLift = 10;

// Sums of times are rounded to this number of parts of a second, so that they print as they would
// be written [1/s].
constexpr double kTimeSteps = 1e9;

// The time that the key `absolute` states, or that the key `relative` states relative to `before`
// [s].
double read_moment(const JsonNode& node, const char* absolute, const char* relative, double before,
                   PatternScope& scope) {
  if (node.has(absolute) == node.has(relative))
    node.complain("\"" + std::string(absolute) + "\" and \"" + relative + "\" " +
                  (node.has(absolute) ? "are both given; keep one of them"
                                      : "are both missing; give one of these times in seconds"));
  if (node.has(absolute)) return read_time(node.at(absolute), scope);
  const double time = before + read_time(node.at(relative), scope);
  if (time > kLongestPattern)
    node.at(relative).complain(
        "this time is " + text::exact(time) +
        " s after the beginning of the motion, but a pattern lasts at most " +
        text::exact(kLongestPattern) + " s");
  return std::round(kTimeSteps * time) / kTimeSteps;
}

RelativeStep read_step(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "step");
  RelativeStep step;
  if (const auto forward = node.find("forward")) step.forward = read_number(*forward, scope);
  if (const auto side = node.find("side")) step.side = read_number(*side, scope);
  if (const auto up = node.find("up")) step.up = read_number(*up, scope);
  if (const auto turn = node.find("turn")) step.turn = read_angle(*turn, scope);
  return step;
}

Swing read_swing(const JsonNode& node, Support support, PatternScope& scope) {
  only_pattern_keys(node, "swing");
  Swing swing;
  swing.foot = read_side(node.at("foot"));
  if (supports(support, swing.foot))
    node.at("foot").complain(
        "the " + std::string(name_of(swing.foot)) +
        " foot carries the robot in this phase (support " + name_of(support) +
        "), so this foot cannot swing" +
        (support == Support::both
             ? ". Let the other foot alone carry the robot, or leave out the swing"
             : ". The support or the swing names the wrong foot; perhaps left "
               "and right were exchanged"));
  if (node.has("step") == node.has("to"))
    node.complain(node.has("to")
                      ? "\"to\" and \"step\" both say where the foot lands; keep one of these keys"
                      : "the place where the foot lands is missing. Give the foothold as \"to\", "
                        "or a step relative to the other foot as \"step\"");
  if (const auto step = node.find("step"))
    swing.step = read_step(*step, scope);
  else
    swing.to = read_foothold(node.at("to"), scope);
  if (const auto lift = node.find("lift")) {
    swing.lift = read_number(*lift, scope, 0, kLargestNumber);
    if (swing.lift > kLargestLift)
      lift->complain(text::exact(swing.lift) + " is too large; the largest allowed value is " +
                     text::exact(kLargestLift) + " m. Lengths are in metres: " +
                     text::exact(swing.lift) + " mm are " + text::exact(swing.lift / 1000) + " m");
  }
  return swing;
}

ZmpKey read_zmp(const JsonNode& node, PatternScope& scope) {
  ZmpKey key;
  if (node.value().is_array()) {
    const std::vector<double> point = read_numbers(node, scope, 2, 2, "[x, y]");
    key.point = {point[0], point[1]};
    return key;
  }
  if (!node.value().is_string())
    node.complain("expected \"left\", \"right\", \"center\" or [x, y]");
  const std::string place = node.one_of({"left", "right", "center"});
  key.place = place == "left"    ? ZmpKey::Place::left
              : place == "right" ? ZmpKey::Place::right
                                 : ZmpKey::Place::center;
  return key;
}

void read_posture(const JsonNode& node, Keyframe& key, PatternScope& scope) {
  if (const auto posture = node.find("posture")) {
    if (posture->value().is_object()) {
      key.joints = read_joint_angles(*posture, scope);
    } else if (posture->value().is_string()) {
      key.posture = posture->string();
    } else {
      posture->complain("expected the name of a posture or {\"joint\": angle, ...}");
    }
  }
  if (const auto joints = node.find("joints")) {
    for (const auto& [joint, angle] : read_joint_angles(*joints, scope))
      if (!key.joints.emplace(joint, angle).second)
        joints->at(joint).complain("the joint is already set in \"posture\" of this keyframe");
  }
}

void read_cog(const JsonNode& node, Keyframe& key, PatternScope& scope) {
  only_pattern_keys(node, "cog");
  if (node.size() == 0) node.complain("the object is empty; give x, y or height");
  if (const auto x = node.find("x")) key.cog_x = read_number(*x, scope);
  if (const auto y = node.find("y")) key.cog_y = read_number(*y, scope);
  if (const auto height = node.find("height")) key.cog_height = read_number(*height, scope);
}

Eigen::Vector3d read_torso(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "torso");
  if (node.size() == 0) node.complain("the object is empty; give roll, pitch or yaw");
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  const char* const names[] = {"roll", "pitch", "yaw"};
  for (int i = 0; i < 3; ++i)
    if (const auto angle = node.find(names[i])) rpy[i] = read_angle(*angle, scope);
  return rpy;
}

// Reads [x, y, z], "free", or an object of kind `kind`.
LinkTarget read_link_target(const JsonNode& node, const std::string& kind, PatternScope& scope) {
  LinkTarget target;
  if (node.value().is_string()) {
    node.one_of({"free"});
    return target;
  }
  if (node.value().is_array()) {
    target.position = read_vector3(node, scope);
    return target;
  }
  if (!node.value().is_object())
    node.complain("expected [x, y, z], {\"position\": [x, y, z], ...} or \"free\"");
  only_pattern_keys(node, kind);
  target.position = read_vector3(node.at("position"), scope);
  if (const auto frame = node.find("frame"))
    target.frame = frame->one_of({"world", "trunk"}) == "world" ? LinkTarget::Frame::world
                                                                : LinkTarget::Frame::trunk;
  if (const auto direction = node.find("direction")) {
    const Eigen::Vector3d along = read_vector3(*direction, scope);
    if (!(along.norm() > 1e-6))
      direction->complain("the vector has no direction; give a vector whose length is above 0");
    target.direction = along.normalized();
  }
  return target;
}

}  // namespace

Phase read_phase(const JsonNode& node, double before, PatternScope& scope) {
  only_pattern_keys(node, "phase");
  Phase phase;
  phase.pointer = node.pointer();
  phase.until = read_moment(node, "until", "duration", before, scope);
  if (const auto goal = node.find("viip")) {
    phase.viip = read_viip_goal(*goal, scope);
    for (const char* const key : {"swing", "support"})
      if (node.has(key))
        node.at(key).complain(
            "a phase with \"viip\" has neither support nor swing, because VIIP chooses the "
            "footholds; leave this key out");
    return phase;
  }
  phase.support = read_support(node.at("support"));
  if (const auto swing = node.find("swing")) phase.swing = read_swing(*swing, phase.support, scope);
  return phase;
}

Keyframe read_keyframe(const JsonNode& node, double before, PatternScope& scope) {
  only_pattern_keys(node, "keyframe");
  Keyframe key;
  key.place = {node.file(), node.pointer()};
  key.pointer = node.pointer();
  key.t = read_moment(node, "t", "after", before, scope);
  if (const auto interpolation = node.find("interpolation"))
    key.interpolation = read_interpolation(*interpolation);
  read_posture(node, key, scope);
  if (const auto zmp = node.find("zmp")) key.zmp = read_zmp(*zmp, scope);
  if (const auto cog = node.find("cog")) read_cog(*cog, key, scope);
  if (const auto fz = node.find("fz")) key.fz = read_number(*fz, scope, 0, kLargestNumber);
  if (const auto torso = node.find("torso")) key.torso = read_torso(*torso, scope);
  if (const auto feet = node.find("feet")) {
    only_pattern_keys(*feet, "feet");
    for (const Side side : {Side::left, Side::right})
      if (const auto foot = feet->find(name_of(side)))
        key.feet[static_cast<size_t>(side)] = read_foothold(*foot, scope);
  }
  if (const auto hands = node.find("hands")) {
    if (hands->size() == 0)
      hands->complain("the object is empty; give left, right or the name of a link");
    for (const auto& [link, target] : hands->members())
      key.hands[link] = read_link_target(target, "hand", scope);
  }
  if (const auto gaze = node.find("gaze")) key.gaze = read_link_target(*gaze, "gaze", scope);
  if (const auto weights = node.find("weights"))
    for (const auto& [joint, weight] : weights->members()) {
      key.weights[joint] = read_number(weight, scope);
      if (key.weights[joint] <= 0)
        weight.complain("a weight must be above 0, but it is " + text::exact(key.weights[joint]));
    }
  return key;
}

ControllerSpec read_controller(const JsonNode& node, PatternScope& scope) {
  only_pattern_keys(node, "controller");
  ControllerSpec controller;
  controller.type = controller_type(node.at("type").one_of(controller_names()));
  const auto gains = node.find("gains");
  if (!gains) return controller;
  if (gains->has("q") && (gains->has("k") || gains->has("d")))
    gains->complain(
        "q is given together with k or d, but q determines k and d; give only q, or only k and d");
  if (gains->has("k") != gains->has("d"))
    gains->complain("only one of the gains k and d is given; give both of them, or give q");
  for (const auto& [name, value] : gains->members())
    controller.gains.emplace_back(name, read_number(value, scope));
  return controller;
}

CorrectionTrack read_correction(const JsonNode& node) {
  only_pattern_keys(node, "correction");
  PatternScope scope;  // no parameters and no angle unit: SI units, as the columns state them
  CorrectionTrack track;
  track.begin = read_number(node.at("begin"), scope, -kLongestPattern, kLongestPattern);
  track.spacing = read_number(node.at("spacing"), scope);
  if (track.spacing <= 0)
    node.at("spacing").complain("this value must be above 0, but it is " +
                                text::exact(track.spacing));
  static const std::vector<std::string> base = {"base.x[m]",    "base.y[m]",    "base.z[m]",
                                                "base.rx[rad]", "base.ry[rad]", "base.rz[rad]"};
  const std::vector<JsonNode> columns = node.at("columns").items();
  for (size_t i = 0; i < std::max(base.size(), columns.size()); ++i) {
    if (i >= columns.size()) node.at("columns").complain("the column '" + base[i] + "' is missing");
    const std::string name = columns[i].string();
    if (i < base.size()) {
      if (name != base[i]) columns[i].complain("expected '" + base[i] + "', found '" + name + "'");
      continue;
    }
    if (name.size() < 12 || name.rfind("theta.", 0) != 0 || name.substr(name.size() - 5) != "[rad]")
      columns[i].complain("expected 'theta.<joint>[rad]', found '" + name + "'");
    track.joints.push_back(name.substr(6, name.size() - 11));
  }
  const std::vector<JsonNode> rows = node.at("coefficients").items();
  const auto width = static_cast<Eigen::Index>(columns.size());
  track.coefficients.resize(static_cast<Eigen::Index>(rows.size()), width);
  for (size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].items().size() != columns.size())
      rows[r].complain("expected " + std::to_string(columns.size()) + " numbers, found " +
                       std::to_string(rows[r].size()));
    const std::vector<double> values = rows[r].numbers();
    track.coefficients.row(static_cast<Eigen::Index>(r)) =
        Eigen::Map<const Eigen::RowVectorXd>(values.data(), width);
  }
  if (const auto smooth = node.find("smooth"))
    for (const JsonNode& window : smooth->items()) {
      const std::vector<double> values = window.numbers();
      if (values.size() != 3 || !(values[0] < values[1]) || !(values[2] > 0))
        window.complain(
            "expected [begin, end, spacing] in seconds, with begin below end and a "
            "spacing above 0");
      if (!track.smooth.empty() && values[0] < track.smooth.back().end)
        window.complain("this window begins at " + text::exact(values[0]) +
                        " s, but the window before it ends later (at " +
                        text::exact(track.smooth.back().end) +
                        " s); give the windows in order and without overlap");
      track.smooth.push_back({values[0], values[1], values[2]});
    }
  return track;
}

}  // namespace ayumi
