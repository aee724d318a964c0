#include "ayumi/check/written_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/model/gravity.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"

namespace ayumi {

namespace {

// Two numbers whose difference is smaller than this count as equal, in any unit. Chosen: the
// conversion of degrees and the rounding of limits cause smaller differences.
constexpr double kSame = 1e-6;
// The sign of a value below this share of its unit is not tried, because the value is nearly 0.
// Chosen: 5 mm for a leg of 0.25 m, 1 deg.
constexpr double kLeastSigned = 0.02;

using In = std::function<double&(Pattern&)>;

struct TrackNumber {
  double t = 0;
  std::string place;
  In in;
};

/// The numbers of one track in order of time.
struct NumberTrack {
  std::string words;
  Quantity quantity = Quantity::length;
  double start = 0;                 ///< value of the track before the first of them
  std::optional<double> rest = {};  ///< value of the track after the last of them, if it is known
  bool across = false;
  std::vector<TrackNumber> numbers = {};
};

class Reader {
 public:
  Reader(const RobotModel& model, const Pattern& pattern)
      : model_(model), pattern_(pattern), copy_(pattern) {
    try {
      if (model.has_soles()) feet_.emplace(model, pattern);
    } catch (const Error&) {  // the phases are wrong; their own message names the reason
    }
  }

  std::vector<WrittenValue> all() {
    ground();
    if (feet_) {
      start();
      swings();
      keyed_feet();
      both_feet();
      cog_and_zmp();
    }
    trunk_and_force();
    joints();
    postures();
    return std::move(found_);
  }

 private:
  void alone(const std::string& place, const std::string& words, Quantity quantity, double neutral,
             const In& in, bool across = false) {
    WrittenValue value{.place = place, .words = words, .quantity = quantity, .across = across};
    value.end = std::numeric_limits<double>::infinity();
    value.numbers = {{in, in(copy_), neutral}};
    found_.push_back(std::move(value));
  }

  double value(const TrackNumber& number) { return number.in(copy_); }

  // Adds the numbers `members` of a track as one value.
  void add(const NumberTrack& track, const std::vector<size_t>& members) {
    WrittenValue made{.place = track.numbers[members.front()].place,
                      .words = track.words,
                      .quantity = track.quantity,
                      .across = track.across};
    const auto is_member = [&](size_t i) {
      return std::find(members.begin(), members.end(), i) != members.end();
    };
    const size_t first = members.front(), last = members.back();
    made.begin = first > 0 ? track.numbers[first - 1].t : 0;
    made.end = last + 1 < track.numbers.size() ? track.numbers[last + 1].t
                                               : std::numeric_limits<double>::infinity();
    for (const size_t i : members) {
      size_t before = i, after = i;
      while (before > 0 && is_member(before)) --before;
      while (after + 1 < track.numbers.size() && is_member(after)) ++after;
      const bool has_before = !is_member(before), has_after = !is_member(after);
      // From t = 0 to the first number of a track, the track has its start value.
      const double from = has_before ? value(track.numbers[before]) : track.start;
      const double since = has_before ? track.numbers[before].t : 0;
      const double t = track.numbers[i].t;
      double neutral = from;
      if (has_after) {
        const double to = value(track.numbers[after]);
        neutral =
            t > since ? from + (t - since) / (track.numbers[after].t - since) * (to - from) : to;
      } else if (track.rest) {
        neutral = *track.rest;
      }
      made.numbers.push_back(
          {track.numbers[i].in, value(track.numbers[i]), neutral, track.numbers[i].place});
    }
    found_.push_back(std::move(made));
  }

  // Adds each run of equal numbers as a value and, if equal numbers also occur elsewhere, all of
  // them together as a value. A first run that holds the starting value of the track is not a value
  // of the author: it only states when the next value begins. For the same reason, the set of all
  // numbers that are equal to the starting value is left out.
  void add(const NumberTrack& track) {
    const auto is_start = [&](double held) { return std::abs(held - track.start) < kSame; };
    std::map<double, std::vector<size_t>> equal;
    for (size_t i = 0; i < track.numbers.size();) {
      std::vector<size_t> run;
      const double held = value(track.numbers[i]);
      for (; i < track.numbers.size() && value(track.numbers[i]) == held; ++i) run.push_back(i);
      if (run.front() > 0 || !is_start(held)) add(track, run);
      auto& all = equal[held];
      all.insert(all.end(), run.begin(), run.end());
    }
    for (const auto& [held, members] : equal) {
      const bool is_run = members.back() - members.front() + 1 == members.size();
      if (!is_run && (members.front() > 0 || !is_start(held))) add(track, members);
    }
  }

  void ground() {
    alone("/world/friction", "the friction of the ground", Quantity::ratio, World{}.friction,
          [](Pattern& p) -> double& { return p.world.friction; });
    if (feet_ && pattern_.cog_height != 0) {
      Pattern without = pattern_;
      without.cog_height = 0;
      alone("/defaults/cog_height", "the COG height", Quantity::length,
            default_cog_height(model_, without),
            [](Pattern& p) -> double& { return p.cog_height; });
    }
  }

  static std::string coordinate(const std::string& of, int axis) {
    static constexpr const char* names[] = {"x", "y", "z"};
    return of + "'s " + names[axis];
  }
  static std::string foot_words(Side side) { return std::string("the ") + name_of(side) + " foot"; }

  void start() {
    Pattern without = pattern_;
    without.start_feet = {};
    const auto usual = start_feet(model_, without);
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<size_t>(index(side));
      if (!pattern_.start_feet[s]) continue;
      for (int axis = 0; axis < 3; ++axis)
        alone(
            std::string("/start/") + name_of(side), coordinate(foot_words(side), axis),
            Quantity::length, usual[s].translation()[axis],
            [s, axis](Pattern& p) -> double& { return p.start_feet[s]->position[axis]; },
            axis == 1);
    }
  }

  void swings() {
    for (const Side side : {Side::left, Side::right}) {
      const Eigen::Isometry3d from = feet_->pose(side, 0);
      const double yaw = elementary::atan2(from.linear()(1, 0), from.linear()(0, 0));
      for (int axis = 0; axis < 4; ++axis) {
        const bool turn = axis == 3;
        NumberTrack to{
            .words = turn ? foot_words(side) + "'s yaw" : coordinate(foot_words(side), axis),
            .quantity = turn ? Quantity::angle : Quantity::length,
            .start = turn ? yaw : from.translation()[axis],
            .across = axis == 1};
        static constexpr const char* steps[] = {"forward", "side", "up", "turn"};
        NumberTrack step{.words = std::string("\"") + steps[axis] + "\" of the " + name_of(side) +
                                  " foot's step",
                         .quantity = to.quantity,
                         .across = axis == 1};
        for (size_t i = 0; i < pattern_.phases.size(); ++i) {
          const auto& swing = pattern_.phases[i].swing;
          if (!swing || swing->foot != side) continue;
          const double t = pattern_.phases[i].until;
          const std::string place = pointer_of_phase(pattern_, i);
          if (swing->step)
            step.numbers.push_back(
                {t, place, [i, axis](Pattern& p) -> double& {
                   RelativeStep& s = *p.phases[i].swing->step;
                   return axis == 0 ? s.forward : axis == 1 ? s.side : axis == 2 ? s.up : s.turn;
                 }});
          else
            to.numbers.push_back({t, place, [i, axis](Pattern& p) -> double& {
                                    Foothold& f = p.phases[i].swing->to;
                                    return axis == 3 ? f.rpy.z() : f.position[axis];
                                  }});
        }
        add(to);
        add(step);
      }
    }
    std::vector<double> lifts;
    for (const Phase& phase : pattern_.phases)
      if (phase.swing) lifts.push_back(phase.swing->lift);
    if (lifts.empty()) return;
    NumberTrack lift{.words = "the lift of the swing", .start = Swing{}.lift};
    for (size_t i = 0; i < pattern_.phases.size(); ++i)
      if (pattern_.phases[i].swing)
        lift.numbers.push_back({pattern_.phases[i].until, pointer_of_phase(pattern_, i),
                                [i](Pattern& p) -> double& { return p.phases[i].swing->lift; }});
    add(lift);
  }

  void keyed_feet() {
    for (const Side side : {Side::left, Side::right}) {
      const auto s = static_cast<size_t>(index(side));
      const Eigen::Vector3d from = feet_->pose(side, 0).translation();
      for (int axis = 0; axis < 4; ++axis) {
        const bool turn = axis == 3;
        NumberTrack track{
            .words = turn ? foot_words(side) + "'s yaw" : coordinate(foot_words(side), axis),
            .quantity = turn ? Quantity::angle : Quantity::length,
            .start = turn ? 0 : from[axis],
            .across = axis == 1};
        if (axis == 2) track.rest = from[axis];  // the foot comes back to the ground
        each_key([&](size_t i, const Keyframe& key) {
          if (key.feet[s])
            track.numbers.push_back({key.t, key_place(i), [i, s, axis](Pattern& p) -> double& {
                                       Foothold& f = *p.keyframes[i].feet[s];
                                       return axis == 3 ? f.rpy.z() : f.position[axis];
                                     }});
        });
        add(track);
      }
    }
  }

  // Both feet of a jump usually move alike, and an author copies the number of one foot to the
  // other. Adds each number that both feet have in the same keyframe as one value.
  void both_feet() {
    for (const int axis : {0, 2}) {
      NumberTrack track{.words = coordinate("the feet", axis),
                        .start = feet_->pose(Side::left, 0).translation()[axis]};
      std::vector<In> of_right;
      each_key([&](size_t i, const Keyframe& key) {
        if (!key.feet[0] || !key.feet[1] ||
            std::abs(key.feet[0]->position[axis] - key.feet[1]->position[axis]) > kSame)
          return;
        const auto in = [i, axis](size_t s) {
          return [i, axis, s](Pattern& p) -> double& {
            return p.keyframes[i].feet[s]->position[axis];
          };
        };
        track.numbers.push_back({key.t, key_place(i), in(0)});
        of_right.push_back(in(1));
      });
      const size_t before = found_.size();
      add(track);
      // The right foot has the same number in the same place.
      for (size_t v = before; v < found_.size(); ++v) {
        std::vector<WrittenNumber>& numbers = found_[v].numbers;
        const size_t n = numbers.size();
        for (size_t i = 0; i < n; ++i)
          for (size_t k = 0; k < track.numbers.size(); ++k)
            if (&track.numbers[k].in(copy_) == &numbers[i].in(copy_)) {
              WrittenNumber right = numbers[i];
              right.in = of_right[k];
              numbers.push_back(std::move(right));
              break;
            }
      }
    }
  }

  void cog_and_zmp() {
    const Eigen::Vector3d middle = feet_->support_center(0);
    NumberTrack x{.words = "the COG's x", .start = middle.x()},
        y{.words = "the COG's y", .start = middle.y(), .across = true},
        height{.words = "the COG height", .start = default_cog_height(model_, pattern_)},
        zmp_x{.words = "the ZMP's x", .start = middle.x()},
        zmp_y{.words = "the ZMP's y", .start = middle.y(), .across = true};
    each_key([&](size_t i, const Keyframe& key) {
      const std::string place = key_place(i);
      if (key.cog_x)
        x.numbers.push_back(
            {key.t, place, [i](Pattern& p) -> double& { return *p.keyframes[i].cog_x; }});
      if (key.cog_y)
        y.numbers.push_back(
            {key.t, place, [i](Pattern& p) -> double& { return *p.keyframes[i].cog_y; }});
      if (key.cog_height)
        height.numbers.push_back(
            {key.t, place, [i](Pattern& p) -> double& { return *p.keyframes[i].cog_height; }});
      if (key.zmp && key.zmp->place == ZmpKey::Place::point) {
        zmp_x.numbers.push_back(
            {key.t, place, [i](Pattern& p) -> double& { return p.keyframes[i].zmp->point.x(); }});
        zmp_y.numbers.push_back(
            {key.t, place, [i](Pattern& p) -> double& { return p.keyframes[i].zmp->point.y(); }});
      }
    });
    for (const NumberTrack& track : {x, y, height, zmp_x, zmp_y}) add(track);
  }

  void trunk_and_force() {
    static constexpr const char* names[] = {"the roll of the trunk", "the pitch of the trunk",
                                            "the yaw of the trunk"};
    for (int axis = 0; axis < 3; ++axis) {
      NumberTrack track{.words = names[axis], .quantity = Quantity::angle};
      each_key([&](size_t i, const Keyframe& key) {
        if (key.torso)
          track.numbers.push_back({key.t, key_place(i), [i, axis](Pattern& p) -> double& {
                                     return (*p.keyframes[i].torso)[axis];
                                   }});
      });
      add(track);
    }
    NumberTrack force{
        .words = "f_z", .quantity = Quantity::force, .start = model_.mass() * kGravity};
    each_key([&](size_t i, const Keyframe& key) {
      if (key.fz)
        force.numbers.push_back(
            {key.t, key_place(i), [i](Pattern& p) -> double& { return *p.keyframes[i].fz; }});
    });
    add(force);
  }

  Quantity quantity_of(int dof) const {
    return model_.dofs()[static_cast<size_t>(dof)].prismatic ? Quantity::length : Quantity::angle;
  }

  void joints() {
    Eigen::VectorXd usual = model_.rest_state().theta;
    try {
      usual = default_posture(model_, pattern_);
    } catch (const Error&) {  // the posture is unknown; its own message names the reason
    }
    std::map<std::string, NumberTrack> tracks;
    each_key([&](size_t i, const Keyframe& key) {
      for (const auto& entry : key.joints) {
        const std::string& joint = entry.first;
        const int dof = model_.find_dof(joint);
        if (dof < 0) continue;
        NumberTrack& track = tracks[joint];
        track.words = joint;
        track.quantity = quantity_of(dof);
        track.start = usual[dof];
        track.numbers.push_back({key.t, key_place(i), [i, joint](Pattern& p) -> double& {
                                   return p.keyframes[i].joints.at(joint);
                                 }});
      }
    });
    for (const auto& entry : tracks) add(entry.second);
  }

  void postures() {
    const Eigen::VectorXd home = model_.rest_state().theta;
    for (const auto& [name, joints] : pattern_.postures)
      for (const auto& entry : joints)
        if (const int dof = model_.find_dof(entry.first); dof >= 0)
          alone("/postures/" + json_pointer_token(name), entry.first, quantity_of(dof), home[dof],
                [name = name, joint = entry.first](Pattern& p) -> double& {
                  return p.postures.at(name).at(joint);
                });
  }

  template <class Visit>
  void each_key(const Visit& visit) const {
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) visit(i, pattern_.keyframes[i]);
  }
  std::string key_place(size_t i) const { return pointer_of_keyframe(pattern_, i); }

  const RobotModel& model_;
  const Pattern& pattern_;
  Pattern copy_;  // read through the accessors of numbers
  std::optional<FootPlan> feet_;
  std::vector<WrittenValue> found_;
};

}  // namespace

double WrittenValue::unit(const RobotModel& model) const {
  if (quantity == Quantity::length && model.has_soles()) return leg_length(model);
  return quantity == Quantity::force ? model.mass() * kGravity : 1.0;
}

double WrittenValue::suspicion(const RobotModel& model) const {
  double most = 0;
  for (const WrittenNumber& number : numbers)
    most = std::max(most, std::abs(number.value - number.neutral));
  return most / unit(model);
}

bool WrittenValue::has_sign(const RobotModel& model) const {
  return (quantity == Quantity::length || quantity == Quantity::angle) &&
         std::abs(numbers.front().value) > kLeastSigned * unit(model);
}

std::string WrittenValue::text(const Pattern& pattern, double value) const {
  switch (quantity) {
    case Quantity::length:
      return text::brief(value) + " m";
    case Quantity::angle:
      return pattern.degrees ? text::brief(value * 180 / std::numbers::pi) + " deg"
                             : text::brief(value) + " rad";
    case Quantity::force:
      return text::brief(value) + " N";
    case Quantity::ratio:
      break;
  }
  return text::brief(value);
}

std::string WrittenValue::elsewhere() const {
  // Number of places that are listed. Chosen: more would hide the value.
  constexpr size_t kListed = 3;
  std::vector<std::string> others;
  for (const WrittenNumber& number : numbers) {
    const bool known = std::find(others.begin(), others.end(), number.place) != others.end() ||
                       number.place.empty() || number.place == place;
    if (!known) others.push_back(number.place);
  }
  if (others.empty()) return "";
  if (others.size() > kListed)
    return " here and in the " + std::to_string(others.size()) +
           " other places that have this value";
  return " here and in " + text::join(others, ", ");
}

double WrittenValue::written_share(const Pattern& pattern, double share) const {
  const double unit = quantity == Quantity::angle && pattern.degrees ? std::numbers::pi / 180 : 1;
  const WrittenNumber& number = numbers.front();
  const double way = number.value - number.neutral;
  const std::string written = text::brief((number.neutral + share * way) / unit);
  double rounded = 0;
  std::from_chars(written.data(), written.data() + written.size(), rounded);
  return way == 0 ? share : (unit * rounded - number.neutral) / way;
}

void WrittenValue::scale(Pattern& pattern, double factor) const {
  for (const WrittenNumber& number : numbers) number.in(pattern) = factor * number.value;
}

void WrittenValue::pull(Pattern& pattern, double share) const {
  const WrittenNumber& first = numbers.front();
  const double all = first.neutral + share * (first.value - first.neutral);
  for (const WrittenNumber& number : numbers) number.in(pattern) = all;
}

void WrittenValue::leave_out(Pattern& pattern) const {
  for (const WrittenNumber& number : numbers) number.in(pattern) = number.neutral;
}

std::vector<WrittenValue> written_values(const RobotModel& model, const Pattern& pattern) {
  return Reader(model, pattern).all();
}

}  // namespace ayumi
