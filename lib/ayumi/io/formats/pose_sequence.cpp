#include "ayumi/io/formats/pose_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/kinematics.hpp"
#include "ayumi/io/yaml/yaml_tree.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A foot that changes by less than this from key to key stands still [m, rad]. Chosen: editors of
// key poses print nine digits, and solvers of postures leave an error of a few micrometres.
constexpr double kSamePlace = 1e-3, kSameTurn = 2e-3;
// Largest number of keys of a file. Chosen: a motion edited by hand has a few hundred. A file of
// 20,000 keys takes half a second and 70 MB.
constexpr size_t kMostKeys = 20'000;

/// One key of the file.
struct PoseKey {
  /// Time of the key and of its transition [s]; 0 for a transition that lasts since the previous
  /// key.
  double time = 0, transition = 0;
  std::vector<int> joints;  ///< ids of the joints
  std::vector<double> angles;
  std::optional<Isometry3d> base;
  std::array<std::optional<Isometry3d>, 2> feet;  ///< poses of the soles by Side
  std::array<bool, 2> touching = {};
  std::optional<Vector3d> zmp;
};

class PoseSequenceReader {
 public:
  PoseSequenceReader(const MotionInput& source, std::vector<std::string>& notes)
      : source_(source), notes_(notes), model_(source.model) {}

  Pattern whole() {
    if (!model_.has_soles())
      fail(ErrorCode::bad_model, model_.name() +
                                     ": the robot has no soles; add the left and the right sole to "
                                     "\"soles\" in its sidecar");
    require_few(words("refer:"));
    const YamlNode root = parse_yaml(source_.bytes, source_.file);
    require_known(root);
    const YamlNode* refs = root.find("refs");
    if (!refs || !refs->is_list()) refuse(root, "`refs`, the list of key poses, is missing");
    require_few(refs->items.size());
    for (const YamlNode& ref : refs->items) read_key(ref);
    if (keys_.size() < 2) refuse(root, "a motion needs two key poses or more");
    map_ids(root);
    Pattern result = pattern();
    say();
    return result;
  }

 private:
  [[noreturn]] void refuse(const YamlNode& node, const std::string& reason,
                           bool names_remedy = false) const {
    source_.refuse(static_cast<size_t>(node.line), reason, names_remedy);
  }

  double number(const YamlNode& node, const char* key) const {
    return source_.number(node.text, static_cast<size_t>(node.line), key);
  }

  std::vector<double> numbers(const YamlNode& node, const char* key, size_t count) const {
    if (!node.is_list() || !node.items.empty())
      refuse(node, std::string(key) + ": a list of finite numbers is needed");
    if (count > 0 && node.numbers.size() != count)
      refuse(node, std::string(key) + ": " + text::counted(count, "number") +
                       (count == 1 ? " is" : " are") + " needed, found " +
                       std::to_string(node.numbers.size()));
    return node.numbers;
  }

  // The number of times that a word stands at the beginning of a line, or after a blank or a brace.
  size_t words(std::string_view word) const {
    const std::string& text = source_.bytes;
    size_t count = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1))
      if (at == 0 || std::string_view(" \t\r\n{,").find(text[at - 1]) != std::string_view::npos)
        ++count;
    return count;
  }

  // Refuses too many keys. This is called before the text is parsed, and again afterwards.
  void require_few(size_t keys) const {
    if (keys > kMostKeys)
      source_.refuse(0, "the file has " + std::to_string(keys) +
                            " key poses, but import reads at most " + std::to_string(kMostKeys) +
                            "; export the motion as body motion (.seq or .yaml) in Choreonoid");
  }

  // The format states its version in a comment above its keys; other files of Choreonoid have a key
  // for it.
  void require_known(const YamlNode& root) const {
    const YamlNode* type = root.find("type");
    if (!type) refuse(root, "`type: PoseSeq` is missing; add it");
    if (type->text != "PoseSeq")
      refuse(*type, "type '" + type->text + "' is unknown; Ayumi reads PoseSeq");
    if (const YamlNode* version = root.find("format_version", "formatVersion"))
      require_version(version->text, static_cast<size_t>(version->line));
    const std::string_view comment = "pose sequence format version ";
    const std::string& text = source_.bytes;
    const size_t first = text.find_first_not_of("\xef\xbb\xbf");
    const size_t at = text.find(comment);
    const size_t end = text.find_first_of("\r\n");
    if (first != std::string::npos && text[first] == '#' && at < end)
      require_version(text.substr(at + comment.size(),
                                  text.find_first_not_of("0123456789.", at + comment.size()) - at -
                                      comment.size()),
                      1);
  }

  void require_version(const std::string& version, size_t line) const {
    if (version != "1" && version != "1.0")
      source_.refuse(line, "format version '" + version + "' is unknown; Ayumi reads version 1.0");
  }

  static bool is_true(const YamlNode* node) {
    return node && (node->text == "true" || node->text == "True");
  }

  void read_key(const YamlNode& ref) {
    const YamlNode *time = ref.find("time"), *pose = ref.find("refer");
    if (!time || !pose || !pose->is_map()) refuse(ref, "a key needs `time` and `refer`");
    const YamlNode* type = pose->find("type");
    if (!type || type->text != "Pose") {
      other_.insert(type ? type->text : "refer");
      return;
    }
    PoseKey key;
    key.time = number(*time, "time");
    if (!(key.time >= 0) || (!keys_.empty() && !(key.time > keys_.back().time)))
      refuse(
          *time,
          "time " + text::brief(key.time) +
              " s is not possible: times must begin at 0 s or later, and increase from key to key");
    if (const YamlNode* most = ref.find("maxTransitionTime", "max_transition_time"))
      key.transition = std::max(number(*most, "maxTransitionTime"), 0.0);
    const YamlNode *ids = pose->find("joints"), *angles = pose->find("q", "displacements");
    if ((ids != nullptr) != (angles != nullptr))
      refuse(*pose,
             std::string("a pose with `") + (ids ? "joints" : "q") + "` needs `" +
                 (ids ? "q" : "joints") + "`; the file may be truncated",
             true);
    if (ids && angles) {
      key.angles = numbers(*angles, "q", 0);
      for (const double id : numbers(*ids, "joints", key.angles.size())) {
        if (!(id >= 0 && id < 1e4) || id != std::floor(id))
          refuse(*ids, "joints: " + text::brief(id) +
                           " is not a joint id (a whole number from 0 to 9999)");
        if (std::find(key.joints.begin(), key.joints.end(), static_cast<int>(id)) !=
            key.joints.end())
          refuse(*ids, "joints: the joint " + text::brief(id) + " is there twice; keep one");
        key.joints.push_back(static_cast<int>(id));
      }
    }
    const YamlNode* links = pose->find("ikLinks", "ik_links");
    if (links)
      for (const YamlNode& link : links->items) read_link(link, key);
    if (const YamlNode* zmp = pose->find("zmp")) {
      const std::vector<double> v = numbers(*zmp, "zmp", 3);
      key.zmp = Vector3d(v[0], v[1], v[2]);
      still_ += is_true(pose->find("isZmpStationaryPoint", "is_zmp_stationary_point"));
    }
    keys_.push_back(std::move(key));
  }

  void read_link(const YamlNode& node, PoseKey& key) {
    const YamlNode *name = node.find("name"), *place = node.find("translation"),
                   *turn = node.find("rotation");
    if (!name || !place || !turn) refuse(node, "a link needs name, translation and rotation");
    Isometry3d pose = Isometry3d::Identity();
    const std::vector<double> p = numbers(*place, "translation", 3);
    const std::vector<double> r = numbers(*turn, "rotation", 9);
    pose.translation() << p[0], p[1], p[2];
    for (int i = 0; i < 9; ++i) pose.linear()(i / 3, i % 3) = r[static_cast<size_t>(i)];
    pose.linear() = Eigen::Quaterniond(pose.linear()).normalized().toRotationMatrix();
    if (is_true(node.find("isBaseLink", "is_base_link"))) {
      key.base = pose;
      return;
    }
    for (const Side side : {Side::left, Side::right}) {
      const Sole& sole = model_.sole(side);
      const auto foot = static_cast<size_t>(side);
      const auto link = std::find_if(model_.links().begin(), model_.links().end(),
                                     [&](const Link& each) { return each.name == name->text; });
      if (link == model_.links().end() || link->body != sole.body) continue;
      key.feet[foot] = pose * link->pose.inverse() * sole.frame;
      key.touching[foot] = is_true(node.find("isTouching", "is_touching"));
      return;
    }
    left_out_.insert(name->text);
  }

  // Assigns the ids to joints of the robot, as --joints says, or by their order if the user asks
  // for it.
  void map_ids(const YamlNode& root) {
    int most = -1;
    for (const PoseKey& key : keys_)
      for (const int id : key.joints) most = std::max(most, id);
    const std::vector<std::string> own = model_.dof_names();
    const std::vector<std::string>& given = source_.options.joints;
    if (given.empty() && !source_.options.by_order && most >= 0)
      refuse(root, "the file names its joints by numbers up to " + std::to_string(most) +
                       "; give --order if these numbers count the " +
                       text::counted(own.size(), "joint") + " of '" + model_.name() + "' from 0 (" +
                       own.front() + ", ..., " + own.back() +
                       "), or name the joints with --joints A,B,...");
    names_ = given.empty() ? own : given;
    if (most >= static_cast<int>(names_.size()))
      refuse(root, "the file has the joint " + std::to_string(most) + ", but there are " +
                       text::counted(names_.size(), "joint") + " (numbered from 0)");
    for (const std::string& name : names_)
      if (find_joint(model_, name) < 0)
        refuse(root, "'" + name + "' is not a joint of '" + model_.name() + "'" +
                         text::suggestion(name, own));
    if (given.empty() && most >= 0)
      notes_.push_back("the numbers are the joints in the order of the robot, as --order says: " +
                       text::join(own, ", "));
  }

  bool places_feet() const {
    for (const size_t foot : {size_t{0}, size_t{1}})
      if (std::none_of(keys_.begin(), keys_.end(),
                       [&](const PoseKey& key) { return key.feet[foot].has_value(); }))
        return false;
    return true;
  }

  // The position of the COG in every key that places the base link. The legs bend so that both feet
  // and the base link have their places. A position is empty if the legs do not reach, or if the
  // key has no base link.
  std::vector<std::optional<Vector3d>> cogs_of_bases(const InverseKinematics& solver) const {
    std::vector<std::optional<Vector3d>> result;
    RobotState state = model_.rest_state();
    state.theta = solver.start();
    RobotData data(model_);
    PostureTarget target;
    for (const size_t foot : {size_t{0}, size_t{1}})
      for (const PoseKey& key : keys_)
        if (key.feet[foot]) {
          target.feet[foot] = *key.feet[foot];
          break;
        }
    for (const PoseKey& key : keys_) {
      result.emplace_back();
      for (const size_t foot : {size_t{0}, size_t{1}})
        if (key.feet[foot]) target.feet[foot] = *key.feet[foot];
      for (size_t i = 0; i < key.joints.size(); ++i) {
        const int dof = find_joint(model_, names_[static_cast<size_t>(key.joints[i])]);
        if (!solver.solves(dof)) state.theta[dof] = key.angles[i];
      }
      if (!key.base) continue;
      state.base = {key.base->translation(), Eigen::Quaterniond(key.base->linear())};
      target.trunk = key.base->linear();
      update_positions(model_, state, data);
      target.cog = data.cog;
      // The COG moves with the base nearly one to one, so a few passes are enough. Chosen: after so
      // many, the error is less than a micrometre.
      constexpr int kPasses = 8;
      bool reached = true;
      for (int pass = 0; reached && pass < kPasses; ++pass) {
        RobotState trial = state;
        reached = solver.solve(target, trial, data).reached;
        if (!reached) break;
        target.cog += key.base->translation() - trial.base.position;
        state.theta = trial.theta;
      }
      if (reached) result.back() = target.cog;
    }
    return result;
  }

  static Foothold foothold(const Isometry3d& pose) {
    return {pose.translation(), matrix_to_rpy(pose.linear())};
  }

  static bool same_place(const Isometry3d& a, const Isometry3d& b) {
    return (a.translation() - b.translation()).norm() < kSamePlace &&
           elementary::angle_between(Eigen::Quaterniond(a.linear()),
                                     Eigen::Quaterniond(b.linear())) < kSameTurn;
  }

  /// The times at which a foot leaves its place and at which it stands at the next one.
  struct Move {
    double from = 0, to = 0;
  };

  // A standing foot keeps its place to the last bit, because it must not move while it supports the
  // robot.
  std::vector<Move> settle(size_t foot) {
    std::vector<Move> moves;
    const PoseKey* before = nullptr;
    for (PoseKey& key : keys_) {
      if (!key.feet[foot]) continue;
      if (key.touching[foot]) {  // the foot is level on the ground
        Isometry3d& pose = *key.feet[foot];
        const double yaw = matrix_to_rpy(pose.linear()).z();
        if (std::abs(pose.translation().z()) < kSamePlace) pose.translation().z() = 0;
        pose.linear() = rpy_to_matrix({0, 0, yaw});
      }
      if (before) {
        const bool stands = before->touching[foot] && key.touching[foot] &&
                            same_place(*before->feet[foot], *key.feet[foot]);
        if (stands)
          key.feet[foot] = before->feet[foot];
        else
          moves.push_back({start_of(key, before->time), key.time});
      }
      before = &key;
    }
    return moves;
  }

  static double start_of(const PoseKey& key, double before) {
    return key.transition > 0 ? std::max(before, key.time - key.transition) : before;
  }

  void add_phases(const std::array<std::vector<Move>, 2>& moves, Pattern& pattern) const {
    const double end = keys_.back().time;
    std::set<double> times = {end};
    for (const std::vector<Move>& foot : moves)
      for (const Move& move : foot) {
        times.insert(move.from);
        times.insert(move.to);
      }
    double begin = 0;
    for (const double until : times) {
      if (!(until > begin)) continue;
      const double middle = 0.5 * (begin + until);
      const auto carries = [&](size_t foot) {
        return std::none_of(moves[foot].begin(), moves[foot].end(), [&](const Move& move) {
          return move.from < middle && middle < move.to;
        });
      };
      const bool left = carries(0), right = carries(1);
      Phase phase;
      phase.until = until;
      phase.support = left && right ? Support::both
                      : left        ? Support::left
                      : right       ? Support::right
                                    : Support::none;
      if (!pattern.phases.empty() && pattern.phases.back().support == phase.support)
        pattern.phases.back().until = until;
      else
        pattern.phases.push_back(phase);
      begin = until;
    }
  }

  Pattern pattern() {
    Pattern result;
    result.degrees = true;
    const bool feet = places_feet();
    std::array<std::vector<Move>, 2> moves;
    const InverseKinematics solver(model_, model_.posture());
    if (feet) {
      moves = {settle(0), settle(1)};
      for (const size_t foot : {size_t{0}, size_t{1}})
        for (const PoseKey& key : keys_)
          if (key.feet[foot] && !result.start_feet[foot])
            result.start_feet[foot] = foothold(*key.feet[foot]);
    }
    add_phases(moves, result);
    add_joints(solver, feet);
    if (feet) add_places(solver, result.phases);
    for (auto& [time, frame] : frames_) {
      frame.t = time;
      result.keyframes.push_back(std::move(frame));
    }
    return result;
  }

  Keyframe& frame_at(double time) { return frames_[time]; }

  // Reads one track. `value_of(key)` is the value of the track in a key, if it has one, and `set`
  // writes a value into a keyframe. If a key limits its transition, the value before it holds until
  // the transition begins.
  template <typename ValueOf, typename Set>
  void add_track(const ValueOf& value_of, const Set& set) {
    decltype(value_of(keys_.front())) before;
    double since = 0;
    for (const PoseKey& key : keys_) {
      const auto value = value_of(key);
      if (!value) continue;
      const double start = start_of(key, since);
      if (before && start > since) set(frame_at(start), *before);
      set(frame_at(key.time), *value);
      before = value;
      since = key.time;
    }
  }

  void add_joints(const InverseKinematics& solver, bool feet) {
    for (size_t id = 0; id < names_.size(); ++id) {
      const int dof = find_joint(model_, names_[id]);
      if (feet && solver.solves(dof)) continue;
      const std::string& name = model_.dofs()[static_cast<size_t>(dof)].name;
      add_track(
          [&](const PoseKey& key) -> std::optional<double> {
            for (size_t i = 0; i < key.joints.size(); ++i)
              if (key.joints[i] == static_cast<int>(id)) return key.angles[i];
            return {};
          },
          [&](Keyframe& frame, double angle) { frame.joints[name] = angle; });
    }
    for (int dof = 0; dof < model_.dof_count(); ++dof) legs_ += feet && solver.solves(dof);
  }

  static bool is_single(const Phase& phase) {
    return phase.support == Support::left || phase.support == Support::right;
  }

  // The ZMP of a file that states it once or never. It is generated as the editor of such files
  // does it: it is under the standing foot, and moves from foot to foot between steps. Before the
  // first and after the last step it is where the file states it. If the file states none, it is
  // between the feet, as far as the next key pose allows.
  void add_zmp_of_feet(const std::vector<Phase>& phases) {
    const auto set = [&](double time, ZmpKey zmp) { frame_at(time).zmp = zmp; };
    const auto first = std::find_if(phases.begin(), phases.end(), is_single);
    const auto last = std::find_if(phases.rbegin(), phases.rend(), is_single);
    const double begin = first == phases.begin() ? 0 : std::prev(first)->until;
    const double end = last->until;
    ZmpKey rest{ZmpKey::Place::center, Eigen::Vector2d::Zero()};
    if (keys_.front().zmp) rest = {ZmpKey::Place::point, keys_.front().zmp->head<2>()};
    double leaves = 0, arrives = keys_.back().time;
    for (const PoseKey& key : keys_) {
      if (key.time < begin) leaves = key.time;
      if (key.time > end && arrives == keys_.back().time) arrives = key.time;
    }
    if (begin > 0) set(0, rest);
    if (leaves > 0) set(leaves, rest);
    double since = 0;
    for (const Phase& phase : phases) {
      if (is_single(phase)) {
        const ZmpKey zmp{
            phase.support == Support::left ? ZmpKey::Place::left : ZmpKey::Place::right,
            Eigen::Vector2d::Zero()};
        set(since, zmp);
        set(phase.until, zmp);
      }
      since = phase.until;
    }
    if (arrives > end) set(arrives, {ZmpKey::Place::center, Eigen::Vector2d::Zero()});
  }

  void add_places(const InverseKinematics& solver, const std::vector<Phase>& phases) {
    for (const size_t foot : {size_t{0}, size_t{1}})
      add_track(
          [&](const PoseKey& key) { return key.feet[foot]; },
          [&](Keyframe& frame, const Isometry3d& pose) { frame.feet[foot] = foothold(pose); });
    add_track([](const PoseKey& key) { return key.base; },
              [](Keyframe& frame, const Isometry3d& pose) {
                frame.torso = matrix_to_rpy(pose.linear());
              });
    zmp_leads_ = zmp_keys() > 1;
    if (zmp_leads_)
      add_track([](const PoseKey& key) { return key.zmp; },
                [](Keyframe& frame, const Vector3d& zmp) {
                  frame.zmp = ZmpKey{ZmpKey::Place::point, zmp.head<2>()};
                });
    zmp_follows_ = !zmp_leads_ && std::any_of(phases.begin(), phases.end(), is_single) &&
                   std::none_of(phases.begin(), phases.end(),
                                [](const Phase& phase) { return phase.support == Support::none; });
    if (zmp_follows_) add_zmp_of_feet(phases);
    const std::vector<std::optional<Vector3d>> cogs = cogs_of_bases(solver);
    for (size_t i = 0; i < keys_.size(); ++i) out_of_reach_ += keys_[i].base && !cogs[i];
    add_track([&](const PoseKey& key) { return cogs[static_cast<size_t>(&key - keys_.data())]; },
              [&](Keyframe& frame, const Vector3d& cog) {
                frame.cog_height = cog.z();
                if (zmp_leads_ || zmp_follows_) return;
                frame.cog_x = cog.x();
                frame.cog_y = cog.y();
              });
  }

  size_t zmp_keys() const {
    return static_cast<size_t>(std::count_if(
        keys_.begin(), keys_.end(), [](const PoseKey& key) { return key.zmp.has_value(); }));
  }

  void say() {
    notes_.push_back("units: seconds, metres and radians, as the format defines them");
    notes_.push_back("the file has " + text::counted(keys_.size(), "key pose") + " and " +
                     text::counted(zmp_keys(), "ZMP key") + " (" + std::to_string(still_) +
                     " of these are marked as stationary). Between two keys, every value "
                     "follows a minimum-jerk curve that is at rest at both keys");
    if (places_feet())
      notes_.push_back(
          "the file states the places of the feet, so Ayumi computes the " +
          text::counted(legs_, "leg joint") + " from the feet, the trunk and the " +
          (zmp_leads_ ? "ZMP"
           : zmp_follows_
               ? "ZMP. The file does not state the ZMP of its steps, so Ayumi puts the ZMP under "
                 "the middle of the standing foot, and the base link sways accordingly"
               : "COG. The COG is computed from the places of the base link") +
          (zmp_keys() == 1 && !zmp_follows_ ? ". The single ZMP key is left out" : ""));
    else
      notes_.push_back(
          "the file does not state the places of both feet, so the leg joints get the angles of "
          "the "
          "file, and both feet are on the ground" +
          std::string(zmp_keys() > 0 ? ". The ZMP of the file is left out" : ""));
    if (out_of_reach_ > 0)
      notes_.push_back(text::counted(out_of_reach_, "place") +
                       (out_of_reach_ == 1 ? " of the base link is" : " of the base link are") +
                       " left out, because the legs do not reach so far");
    if (!left_out_.empty())
      notes_.push_back("the places of these links are left out: " +
                       text::join({left_out_.begin(), left_out_.end()}, ", "));
    if (!other_.empty())
      notes_.push_back("keys of these types are left out: " +
                       text::join({other_.begin(), other_.end()}, ", "));
  }

  const MotionInput& source_;
  std::vector<std::string>& notes_;
  const RobotModel& model_;
  std::vector<PoseKey> keys_;
  std::vector<std::string> names_;     // names by id
  std::map<double, Keyframe> frames_;  // keyframes by time
  std::set<std::string> left_out_, other_;
  int still_ = 0, legs_ = 0, out_of_reach_ = 0;
  bool zmp_leads_ = false, zmp_follows_ = false;
};

}  // namespace

std::string recognize_pose_sequence(const MotionInput& source) {
  const std::string head = source.bytes.substr(0, 4000);
  return head.find("type: PoseSeq") != std::string::npos ? "the file says that its type is PoseSeq"
                                                         : "";
}

Pattern read_pose_sequence(const MotionInput& source, std::vector<std::string>& notes) {
  return PoseSequenceReader(source, notes).whole();
}

}  // namespace ayumi
