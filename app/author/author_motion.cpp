#include "author/author_motion.hpp"

#include <algorithm>
#include <cmath>
#include <future>

#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/finding_groups.hpp"
#include "ayumi/check/stability_series.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/dynamics/reach.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/limits/amount_text.hpp"
#include "ayumi/math/polygon.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/model/outline.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/report/replay.hpp"
#include "ayumi/sim/run_caution.hpp"
#include "ayumi/task/plan_log.hpp"

namespace ayumi::app {

namespace {

using Eigen::Vector3d;

// A quantity that uses more than this share of its limit no longer has the colour of good values.
// Chosen: below it, a motion has room for what a controller adds.
constexpr double kNearLimit = 0.7;
// The same bound for a margin, as a share of its largest possible value (the ZMP in the middle of
// one sole), and for the force on the ground, as a share of the weight. Chosen as above.
constexpr double kNearEdge = 0.3, kNearLiftOff = 0.15;

OrderedJson list(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string words_of(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

OrderedJson finding_json(const RobotModel& model, const Finding& f) {
  OrderedJson json = {
      {"kind", name_of(f.kind)},
      {"severity", name_of(f.severity)},
      {"where", place_words(f.where)},
      {"begin", f.begin},
      {"end", f.end},
      {"at", f.at},
      {"message", words_of(name_of(f.kind)) + ", " + place_words(f.where) + ": " + amount_text(f)},
      // The page has a button instead of the command.
      {"hint", f.hint == f.remedy || f.remedy.empty() ? f.hint : f.remedy + ", or choose Repair"},
      {"bodies", OrderedJson::array()},
      {"side", nullptr},
      {"joint", nullptr},
      {"pointer", nullptr}};
  if (const auto* joint = std::get_if<JointPlace>(&f.place))
    json["joint"] = model.dofs()[static_cast<size_t>(joint->dof)].name;
  if (const auto* foot = std::get_if<FootPlace>(&f.place)) json["side"] = name_of(foot->side);
  if (const auto* support = std::get_if<SupportPlace>(&f.place))
    if (support->support == Support::left || support->support == Support::right)
      json["side"] = name_of(support->support);
  if (const auto* pair = std::get_if<BodyPairPlace>(&f.place)) json["bodies"] = {pair->a, pair->b};
  return json;
}

// The findings as `check` prints them: one entry for each cause, with the findings that follow from
// it.
OrderedJson groups_json(const RobotModel& model, const ConsistencyReport& report) {
  OrderedJson groups = OrderedJson::array();
  for (const FindingGroup& group : finding_groups(report, model)) {
    OrderedJson consequences = OrderedJson::array();
    for (const GroupConsequence& c : group.consequences) {
      const Finding& f = report.findings[static_cast<size_t>(c.worst)];
      consequences.push_back(words_of(name_of(c.kind)) + ", " + place_words(f.where) + ": " +
                             amount_text(f));
    }
    groups.push_back({{"worst", group.worst},
                      {"members", group.members},
                      {"places", text::join(group.places, " and ")},
                      {"consequences", consequences}});
  }
  return groups;
}

std::string pointer_to(const std::string& list, size_t i) {
  return "/" + list + "/" + std::to_string(i);
}

// Whether this value is read several times, in the rounds of a block.
bool is_repeated(const std::string& pointer) { return outermost(pointer) != pointer; }

// A pattern and its document as written.
struct Written {
  const Pattern& pattern;
  const OrderedJson& document;
};

const OrderedJson& written_at(const Written& text, const std::string& pointer) {
  return text.document.at(OrderedJson::json_pointer(pointer));
}

// The place of the time of a keyframe in the text, and the time to which the written value is
// relative.
OrderedJson time_json(const Written& text, size_t i) {
  const auto& frames = text.pattern.keyframes;
  const std::string pointer = pointer_of_keyframe(text.pattern, i);
  const OrderedJson& written = written_at(text, pointer);
  const bool relative = written.contains("after");
  const std::string key = relative ? "after" : "t";
  return {{"time", frames[i].t},
          {"time_value", written.at(key)},
          {"time_pointer", pointer + "/" + key},
          {"time_base", relative && i > 0 ? frames[i - 1].t : 0},
          {"repeated", is_repeated(pointer)}};
}

OrderedJson phases_json(const Written& text) {
  OrderedJson phases = OrderedJson::array();
  double from = 0;
  for (size_t i = 0; i < text.pattern.phases.size(); ++i) {
    const Phase& phase = text.pattern.phases[i];
    const std::string pointer = pointer_of_phase(text.pattern, i);
    const OrderedJson& written = written_at(text, pointer);
    const bool relative = written.contains("duration");
    const std::string key = relative ? "duration" : "until";
    phases.push_back(
        {{"from", from},
         {"until", phase.until},
         {"support", phase.viip ? OrderedJson(nullptr) : OrderedJson(name_of(phase.support))},
         {"pointer", pointer},
         {"until_pointer", pointer + "/" + key},
         {"until_value", written.at(key)},
         {"until_base", relative ? from : 0},
         {"repeated", is_repeated(pointer)},
         {"swing",
          written.contains("swing") ? OrderedJson(written["swing"]) : OrderedJson(nullptr)}});
    from = phase.until;
  }
  return phases;
}

// The keys by track. The tracks have the order in which they first appear, first those of the body,
// then those of the joints.
class Tracks {
 public:
  void add(const std::string& name, const std::string& kind, const OrderedJson& key) {
    const auto found = std::find_if(tracks_.begin(), tracks_.end(),
                                    [&](const OrderedJson& t) { return t["name"] == name; });
    if (found != tracks_.end()) {
      (*found)["keys"].push_back(key);
      return;
    }
    OrderedJson track = {{"name", name}, {"kind", kind}};
    if (kind == "joint") track["joint"] = name.substr(6);
    track["keys"] = OrderedJson::array({key});
    tracks_.push_back(track);
  }
  OrderedJson sorted() {
    const auto rank = [](const OrderedJson& track) {
      static const std::vector<std::string> kinds = {"posture", "zmp",  "cog",  "fz",   "trunk",
                                                     "foot",    "hand", "gaze", "joint"};
      return std::find(kinds.begin(), kinds.end(), track["kind"].get<std::string>());
    };
    std::stable_sort(tracks_.begin(), tracks_.end(),
                     [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    return tracks_;
  }

 private:
  OrderedJson tracks_ = OrderedJson::array();
};

OrderedJson tracks_json(const Written& text) {
  Tracks tracks;
  for (size_t i = 0; i < text.pattern.keyframes.size(); ++i) {
    const std::string pointer = pointer_of_keyframe(text.pattern, i);
    const OrderedJson& written = written_at(text, pointer);
    const OrderedJson time = time_json(text, i);
    const auto add = [&](const std::string& name, const std::string& kind,
                         const std::string& inside, const OrderedJson& value) {
      OrderedJson key_json = time;
      key_json["pointer"] = pointer + inside;
      key_json["value"] = value;
      tracks.add(name, kind, key_json);
    };
    for (const auto& [key, value] : written.items()) {
      if (key == "zmp" || key == "cog" || key == "fz") add(key, key, "/" + key, value);
      if (key == "torso") add(key, "trunk", "/torso", value);
      if (key == "posture" && value.is_string()) add(key, key, "/posture", value);
      if (key == "joints" || (key == "posture" && value.is_object()))
        for (const auto& [joint, angle] : value.items())
          add("joint " + joint, "joint", "/" + key + "/" + json_pointer_token(joint), angle);
      if (key == "feet")
        for (const auto& [side, foot] : value.items())
          add(side + " foot", "foot", "/feet/" + json_pointer_token(side), foot);
      if (key == "hands")
        for (const auto& [link, target] : value.items())
          add(link == "left" || link == "right" ? link + " hand" : "link " + link, "hand",
              "/hands/" + json_pointer_token(link), target);
      if (key == "gaze") add(key, key, "/gaze", value);
    }
  }
  return tracks.sorted();
}

OrderedJson keyframes_json(const Written& text) {
  OrderedJson frames = OrderedJson::array();
  for (size_t i = 0; i < text.pattern.keyframes.size(); ++i) {
    const std::string pointer = pointer_of_keyframe(text.pattern, i);
    const OrderedJson& written = written_at(text, pointer);
    frames.push_back(time_json(text, i));
    frames.back()["pointer"] = pointer;
    frames.back()["more"] = written.contains("weights") || written.contains("interpolation");
  }
  return frames;
}

OrderedJson disturbances_json(const Written& text) {
  OrderedJson all = OrderedJson::array();
  for (size_t i = 0; i < text.pattern.scenario.size(); ++i) {
    const Disturbance& d = text.pattern.scenario[i];
    const auto& written = text.document["scenario"][i];
    const std::string pointer = pointer_to("scenario", i);
    OrderedJson one = {
        {"type", name_of(d)},
        {"from", d.at},
        {"until", d.at + d.duration},
        {"duration", d.duration},
        {"pointer", pointer},
        {"at_pointer", pointer + "/at"},
        {"at_value", written.contains("at") ? OrderedJson(written["at"]) : OrderedJson(nullptr)},
        {"text", ayumi::words_of({d})},
        {"value", written}};
    if (const auto* push = std::get_if<Push>(&d.what)) {
      one["size"] = push->magnitude;
      one["unit"] = push->kind == PushKind::impulse ? "N s"
                    : push->kind == PushKind::force ? "N"
                                                    : "N m";
      one["link"] = push->on;
      if (push->frame == PushFrame::world) one["direction"] = list(push->direction);
    }
    all.push_back(one);
  }
  return all;
}

OrderedJson joints_json(const RobotModel& model) {
  OrderedJson joints = OrderedJson::array();
  for (const Dof& dof : model.dofs()) {
    // The slider in the page needs two ends: a joint without limits gets one turn, or a metre each
    // way if it slides.
    const double free = dof.prismatic ? 1.0 : M_PI;
    joints.push_back({{"name", dof.name},
                      {"leg", model.is_leg_joint(static_cast<int>(joints.size()))},
                      {"low", std::isfinite(dof.lower) ? dof.lower : -free},
                      {"high", std::isfinite(dof.upper) ? dof.upper : free},
                      {"prismatic", dof.prismatic}});
  }
  return joints;
}

OrderedJson handles_json(const RobotModel& model) {
  OrderedJson handles = OrderedJson::array();
  for (const AuthorHandle& handle : handles_of(model)) {
    OrderedJson one = {{"name", handle.name}, {"label", handle.label}};
    if (handle.body >= 0) {
      one["body"] = handle.body;
      one["point"] = list(handle.point);
    }
    if (!handle.link.empty()) one["link"] = handle.link;
    if (handle.kind == AuthorHandle::Kind::foot) one["foot"] = name_of(handle.side);
    if (handle.kind == AuthorHandle::Kind::gaze) one["gaze"] = true;
    handles.push_back(one);
  }
  return handles;
}

OrderedJson targets_json(const AuthorMotion& motion) {
  OrderedJson targets = OrderedJson::array();
  for (const AuthorTarget& target : targets_of(motion))
    targets.push_back({{"pointer", target.pointer},
                       {"label", target.label},
                       {"handle", target.handle},
                       {"time", target.time},
                       {"until", target.until},
                       {"place", list(target.place)}});
  return targets;
}

struct Lane {
  const char *name, *unit, *sense;
  double limit, warn;
  int digits;
};

OrderedJson lane_json(const Lane& lane, const std::vector<double>& values, double scale,
                      const RobotModel& model, const std::vector<int>& dofs = {}) {
  OrderedJson scaled = OrderedJson::array(), worst = nullptr;
  for (const double value : values)  // four digits are enough for a picture
    scaled.push_back(std::isnan(value) ? OrderedJson(nullptr)
                                       : OrderedJson(std::round(1e4 * scale * value) / 1e4));
  if (!dofs.empty()) worst = OrderedJson::array();
  for (const int dof : dofs)
    worst.push_back(dof < 0 ? OrderedJson(nullptr)
                            : OrderedJson(model.dofs()[static_cast<size_t>(dof)].name));
  return {{"name", lane.name},   {"unit", lane.unit}, {"sense", lane.sense},
          {"limit", lane.limit}, {"warn", lane.warn}, {"digits", lane.digits},
          {"worst", worst},      {"values", scaled}};
}

OrderedJson strip_json(const Task& task, const StabilitySeries& s) {
  const RobotModel& model = task.robot;
  const Tolerances allowed = tolerances(check_options(task), model, task.series);
  const Sole& sole = model.sole(Side::left);
  const double middle = 1e3 * ConvexPolygon(sole.polygon).margin(sole.center);
  const double weight = model.mass() * kGravity;
  const auto share = [&](const char* name, FindingKind kind) {
    const double most = 100 * allowed[kind];
    return Lane{name, "%", "high", most, kNearLimit * most, 0};
  };
  return {
      lane_json({"ZMP margin", "mm", "low", 0, kNearEdge * middle, 1}, s.zmp_margin, 1e3, model),
      lane_json({"DCM margin", "mm", "low", 0, kNearEdge * middle, 1}, s.dcm_margin, 1e3, model),
      lane_json({"Ground force f_z", "N", "low", 0, kNearLiftOff * weight, 1}, s.normal_force, 1,
                model),
      lane_json(share("Friction used", FindingKind::friction), s.friction, 100, model),
      lane_json(share("Joint speed", FindingKind::joint_speed), s.speed, 100, model, s.speed_dof),
      lane_json(share("Joint torque", FindingKind::joint_torque), s.torque, 100, model,
                s.torque_dof)};
}

std::vector<std::string> links_of(const RobotModel& model) {
  std::vector<std::string> names;
  for (const Link& link : model.links()) names.push_back(link.name);
  return names;
}

std::vector<std::string> postures_of(const AuthorMotion& motion) {
  std::vector<std::string> names;
  for (const auto& [name, joints] : motion.task.robot.description().postures) names.push_back(name);
  for (const auto& [name, joints] : motion.task.pattern.postures)
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  return names;
}

// What the page shows of the motion, except for its verdict.
OrderedJson parts_without_verdict(const AuthorMotion& motion, const ShownRobot& robot) {
  const Task& task = motion.task;
  OrderedJson profiles = OrderedJson::array();
  for (const ActuatorProfile& profile : task.robot.description().profiles)
    profiles.push_back(profile.name);
  OrderedJson own = OrderedJson::array();
  if (motion.document.contains("postures"))
    for (const auto& [name, joints] : motion.document["postures"].items()) own.push_back(name);
  OrderedJson parts = author_structure(task.pattern, motion.document);
  parts.update(OrderedJson{{"robot", task.robot.name()},
                           {"profile", task.profile},
                           {"profiles", profiles},
                           {"duration", task.series.duration()},
                           {"dt", task.series.dt},
                           {"angle_unit", task.pattern.degrees ? "deg" : "rad"},
                           {"joints", joints_json(task.robot)},
                           {"links", links_of(task.robot)},
                           {"handles", handles_json(task.robot)},
                           {"targets", targets_json(motion)},
                           {"postures", postures_of(motion)},
                           {"own_postures", own},
                           {"replay", OrderedJson::parse(live_config(task.robot, robot.surface,
                                                                     motion.plan, kPageRate))}});
  return parts;
}

void add_verdict(AuthorMotion& motion, const StabilitySeries& stability) {
  const RobotModel& robot = motion.task.robot;
  OrderedJson findings = OrderedJson::array();
  for (const Finding& f : motion.judgement.report.findings)
    findings.push_back(finding_json(robot, f));
  motion.parts.update(OrderedJson{{"consistent", motion.judgement.good()},
                                  {"reason", motion.judgement.reason()},
                                  {"findings", findings},
                                  {"groups", groups_json(robot, motion.judgement.report)},
                                  {"strips", {{"plan", author_strip(motion.task, stability)}}}});
}

}  // namespace

OrderedJson author_structure(const Pattern& pattern, const OrderedJson& document) {
  const Written text{pattern, document};
  return {{"phases", phases_json(text)},
          {"keyframes", keyframes_json(text)},
          {"tracks", tracks_json(text)},
          {"disturbances", disturbances_json(text)}};
}

OrderedJson author_strip(const Task& task, const StabilitySeries& stability) {
  return {{"lanes", strip_json(task, stability)}, {"dt", stability.dt}};
}

std::string outermost(const std::string& pointer) {
  return pointer.substr(0, pointer.find('/', pointer.find('/', 1) + 1));
}

std::string without_file(const Error& error, const std::filesystem::path& file) {
  return error.place().file == file.string() ? error.words() : error.what();
}

std::shared_ptr<const AuthorMotion> author_motion(const std::string& text, const ShownRobot& robot,
                                                  const AuthorSetting& setting,
                                                  const Progress& progress) {
  auto motion = std::make_shared<AuthorMotion>(
      AuthorMotion{load_task(pattern_of_text(text, setting.file, setting.set), robot.named,
                             setting.profile, progress),
                   {},
                   {},
                   {},
                   {},
                   {}});
  const Task& task = motion->task;
  StabilityNotes stability(task.robot, task.series, check_options(task));
  // Meanwhile, this thread prepares what the page shows.
  auto judged = std::async(std::launch::async, [&] {
    return judge(task, check_options(task), [&](const JudgedSample& sample, const RobotData& data) {
      stability.note(sample, data);
    });
  });
  motion->document = OrderedJson::parse(text, nullptr, true, true);
  const int stride = std::max(1, static_cast<int>(std::lround(1 / kPageRate / task.series.dt)));
  motion->plan =
      plan_log(task.robot, task.robot.limits(task.profile), task.series, task.series, stride);
  motion->plan.world = task.pattern.world;
  motion->series = live_series(motion->plan, kPageRate);
  motion->parts = parts_without_verdict(*motion, robot);
  motion->judgement = judged.get();
  add_verdict(*motion, stability.series());
  return motion;
}

namespace {

// The box around all shapes of a body, in its frame.
Eigen::AlignedBox3d box_of(const RobotModel& model, int body) {
  Eigen::AlignedBox3d box;
  for (const Link& link : model.links()) {
    if (link.body != body) continue;
    for (const PlacedShape& placed : link.visuals.empty() ? link.collisions : link.visuals)
      for (const Vector3d& point : outline(placed.shape))
        box.extend(Vector3d(link.pose * placed.pose * point));
  }
  return box;
}

// A limb whose end is this near to the middle plane at rest is not an arm [m]. Chosen: the ends of
// necks are nearer.
constexpr double kMiddle = 0.02;

// Distance of the gaze's handle from the head, in heights of the head above the feet. Chosen: the
// handle is in the picture, far enough for a hand to steer it, and ahead of a head that leans.
constexpr double kGazeAhead = 0.4;

}  // namespace

std::vector<AuthorHandle> handles_of(const RobotModel& robot) {
  using Kind = AuthorHandle::Kind;
  std::vector<AuthorHandle> handles;
  std::vector<int> feet;
  if (robot.has_soles())
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = robot.sole(side);
      handles.push_back({Kind::foot, std::string(name_of(side)) + "_foot",
                         std::string(name_of(side)) + " foot", sole.body, sole.frame.translation(),
                         side});
      feet.push_back(sole.body);
    }
  RobotData data(robot);
  update_positions(robot, robot.rest_state(), data);
  std::vector<AuthorHandle> limbs;
  std::array<int, 2> on_side = {0, 0};  // numbers of arms, by Side
  for (const int b : limb_ends(robot)) {
    // A limb with three joints can bring a point to a place; a neck has fewer.
    if (std::count(feet.begin(), feet.end(), b) || limb_dofs(robot, b).size() < 3) continue;
    const std::string& name = robot.bodies()[static_cast<size_t>(b)].name;
    limbs.push_back({Kind::limb, name, words_of(name), b, limb_point(robot, b), Side::left});
    const double y = data.position[static_cast<size_t>(b)].y();
    limbs.back().side = y > 0 ? Side::left : Side::right;
    limbs.back().link = b == hand_body(robot, Side::left)    ? "left"
                        : b == hand_body(robot, Side::right) ? "right"
                                                             : name;
    if (std::abs(y) > kMiddle) ++on_side[static_cast<size_t>(limbs.back().side)];
  }
  if (on_side[0] == 1 && on_side[1] == 1)
    for (AuthorHandle& limb : limbs) {
      if (std::abs(data.position[static_cast<size_t>(limb.body)].y()) <= kMiddle) continue;
      limb.name = std::string(name_of(limb.side)) + "_hand";
      limb.label = std::string(name_of(limb.side)) + " hand";
    }
  handles.insert(handles.end(), limbs.begin(), limbs.end());
  if (const int head = head_body(robot); head >= 0) {
    const Vector3d& from = robot.bodies()[static_cast<size_t>(head)].inertia.com;
    double lowest = data.position[static_cast<size_t>(head)].z();
    for (const Vector3d& position : data.position) lowest = std::min(lowest, position.z());
    const double ahead = kGazeAhead * (data.position[static_cast<size_t>(head)].z() - lowest);
    handles.push_back(
        {Kind::gaze, "gaze", "gaze", head, from + ahead * gaze_axis(robot, head), Side::left});
  }
  const int trunk = robot.trunk_body();
  const Eigen::AlignedBox3d box = box_of(robot, trunk);
  Vector3d top = box.isEmpty() ? Vector3d(0, 0, 0.1) : Vector3d(box.center());
  if (!box.isEmpty()) top.z() = box.max().z();
  handles.push_back({Kind::trunk, "trunk", "trunk", trunk, top, Side::left});
  handles.push_back({Kind::cog, "cog", "COG", -1, Vector3d::Zero(), Side::left});
  return handles;
}

std::vector<AuthorTarget> targets_of(const AuthorMotion& motion) {
  const RobotModel& robot = motion.task.robot;
  const CommandSeries& series = motion.task.series;
  const std::vector<Keyframe>& frames = motion.task.pattern.keyframes;
  const std::vector<AuthorHandle> handles = handles_of(robot);
  std::vector<AuthorTarget> targets;
  RobotData data(robot);
  const auto add = [&](size_t i, const std::string& link, const LinkTarget& wanted) {
    if (!wanted.position) return;
    AuthorTarget target;
    target.time = frames[i].t;
    target.until = series.duration();
    const bool gaze = link.empty();
    const auto named = [&](const Keyframe& key) {
      return gaze ? key.gaze.has_value() : key.hands.contains(link);
    };
    for (size_t k = frames.size(); --k > i;)
      if (named(frames[k])) target.until = frames[k].t;
    target.pointer = pointer_of_keyframe(motion.task.pattern, i) +
                     (gaze ? "/gaze" : "/hands/" + json_pointer_token(link));
    const bool hand = link == "left" || link == "right";
    target.label = gaze ? "gaze" : hand ? link + " hand" : "link " + link;
    for (const AuthorHandle& handle : handles)
      if (gaze ? handle.kind == AuthorHandle::Kind::gaze : handle.link == link)
        target.handle = handle.name;
    target.place = *wanted.position;
    target.axes.setIdentity();
    if (wanted.frame == LinkTarget::Frame::trunk) {
      const auto last = static_cast<double>(series.samples.size() - 1);
      const auto k =
          static_cast<size_t>(std::clamp(std::round(target.time / series.dt), 0.0, last));
      update_positions(robot, series.samples[k].state, data);
      const Eigen::Isometry3d trunk = data.pose(robot.trunk_body());
      target.place = trunk * target.place;
      target.axes = trunk.linear();
    }
    targets.push_back(target);
  };
  for (size_t i = 0; i < frames.size(); ++i) {
    for (const auto& [link, wanted] : frames[i].hands) add(i, link, wanted);
    if (frames[i].gaze) add(i, "", *frames[i].gaze);
  }
  return targets;
}

}  // namespace ayumi::app
