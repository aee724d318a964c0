#include "ayumi/check/likely_mistakes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "ayumi/author/generate/pattern_builder.hpp"
#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/json_pointer.hpp"
#include "ayumi/base/sentence.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/check/consistency.hpp"
#include "ayumi/check/hypotheses/unit_hypotheses.hpp"
#include "ayumi/check/mistake_search.hpp"
#include "ayumi/check/raised_feet.hpp"
#include "ayumi/motion/pattern_context.hpp"
#include "ayumi/plan/foot_plan.hpp"
#include "ayumi/plan/sample.hpp"

namespace ayumi {

namespace {

using Eigen::Vector3d;

// Longest swing of a walking robot [s]. Chosen: the slowest bundled motion swings for 2 s, and
// seconds written as milliseconds are a thousand times too long.
constexpr double kLongestSwing = 30;
// No motion without a swing lasts longer [s]. Chosen: seconds written as milliseconds are a
// thousand times too long.
constexpr double kLongestStand = 1000;
// A millisecond [s]. Definition.
constexpr double kMillisecond = 1e-3;
// A COG below this share of its height at home is nearer to the ground than folded legs allow.
// Chosen: the deepest squat of HOAP-1 is at 0.6.
constexpr double kLowestCog = 0.3;
// A foot that lands on the wrong side of the other foot by less than this does not cross the legs
// [m]. Chosen: half the width of a small sole, so that a tightrope walk is no mistake.
constexpr double kCrossing = 0.02;
// A foot key this far above the other sole lifts the COG noticeably [m]. Chosen: a sole that clears
// the ground.
constexpr double kLiftedKey = 0.005;
// Number of other keys with a lifted foot that are named. Chosen: a kick has two or three keys in
// the air.
constexpr size_t kNamedLifts = 3;
// A foot lower than this over the ground counts as standing on it [m].
constexpr double kOnGround = 1e-3;
// Angles below this count as zero, and angles this near to a whole number count as whole [deg].
// Definition: the error of rounding to three decimals is smaller.
constexpr double kLeastAngle = 1e-3;
// From this number of angles on, a regularity is not taken for chance. Chosen: two keys of two
// joints.
constexpr size_t kManyAngles = 4;
// A larger friction coefficient of the ground is doubtful. Chosen: rubber on dry concrete has 1.
// With half of this bound, rubber soles would be doubtful; with twice, a friction of 3 would pass
// as real.
constexpr double kRoughest = 2;
// A push that gives the whole robot more speed than this is not a useful test of its balance [m/s].
// Chosen: ten times what walking robots survive. With half or twice this bound, units that are
// wrong by a factor of 1000 are found as well.
constexpr double kFastestPush = 2;
// Time for which a robot does not react to a force [s]. Chosen: about a step; against a force that
// lasts longer, a robot leans.
constexpr double kUnopposed = 0.5;
// How long a simulation holds the last posture [s]. Definition: SimulateOptions.
constexpr double kHeld = 1;
// Number of mistakes of one kind that are named one by one.
constexpr size_t kNamed = 2;

std::string metres(double value) { return text::brief(value, 3) + " m"; }

class Suspicions {
 public:
  Suspicions(const RobotModel& model, const Pattern& pattern) : model_(model), pattern_(pattern) {
    try {
      if (model.has_soles()) feet_.emplace(model, pattern);
    } catch (const Error&) {  // the phases themselves are wrong; their own message says so
    }
  }

  std::vector<Mistake> doubts() {
    const bool swings = std::any_of(pattern_.phases.begin(), pattern_.phases.end(),
                                    [](const Phase& phase) { return phase.swing.has_value(); });
    if (feet_ && swings) missing_swings();
    if (feet_) heights_of_feet();
    small_angles();
    friction();
    pushes();
    late_disturbances();
    return said_;
  }

  std::vector<Mistake> long_times() {
    if (feet_) times();
    return said_;
  }

  std::vector<Mistake> all() {
    angle_units();
    if (feet_) {
      times();
      cog_heights();
      footholds();
      crossings();
      zmp_keys();
      missing_swings();
      heights_of_feet();
      lifted_keys();
    }
    leg_keys();
    return said_;
  }

 private:
  /// The mistakes that a rule finds in one phase or key.
  enum class Finds { one_in_a_place, several_in_a_place };

  /// The first few mistakes of one rule, and the number of the others. The rounds of a block that
  /// repeats share one text. If a rule finds at most one mistake in each phase or key, only the
  /// first round is named, even if the rounds are wrong by different amounts.
  void say(std::vector<Mistake> each, Finds finds = Finds::one_in_a_place) {
    std::vector<Mistake> found;
    for (Mistake& mistake : each)
      if (std::none_of(found.begin(), found.end(), [&](const Mistake& said) {
            return said.place == mistake.place &&
                   (finds == Finds::one_in_a_place || said.words == mistake.words);
          }))
        found.push_back(std::move(mistake));
    const size_t more = found.size() > kNamed ? found.size() - kNamed : 0;
    found.resize(found.size() - more);
    if (more) found.back().words += " (and " + std::to_string(more) + " more of this kind)";
    said_.insert(said_.end(), found.begin(), found.end());
  }

  std::string key_place(size_t i) const { return pointer_of_keyframe(pattern_, i); }
  std::string phase_place(size_t i) const { return pointer_of_phase(pattern_, i); }

  // Finds degrees in a pattern whose unit is rad: no joint that has limits can turn by such an
  // angle.
  void angle_units() {
    if (pattern_.degrees) return;
    std::vector<Mistake> found;
    const auto look = [&](const std::string& place, const std::string& joint, double angle) {
      const int dof = model_.find_dof(joint);
      if (dof < 0 || model_.dofs()[dof].prismatic || !model_.dofs()[dof].limited) return;
      if (std::abs(angle) > 2 * std::numbers::pi)
        found.push_back({place, joint + " is at " + text::brief(angle) +
                                    " rad, which is more than a turn. If the angle is in degrees, "
                                    "write \"units\": {\"angle\": \"deg\"}"});
    };
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const auto& [joint, angle] : pattern_.keyframes[i].joints)
        look(key_place(i), joint, angle);
    for (const auto& [name, joints] : pattern_.postures)
      for (const auto& [joint, angle] : joints)
        look("/postures/" + json_pointer_token(name), joint, angle);
    say(found, Finds::several_in_a_place);
  }

  // Finds radians in a pattern whose unit is deg: there are several angles, none of them is more
  // than a turn in radians, and few of them are whole numbers.
  void small_angles() {
    if (!pattern_.degrees) return;
    size_t count = 0, whole = 0;
    for (const Keyframe& key : pattern_.keyframes)
      for (const auto& entry : key.joints) {
        const double degrees = entry.second * 180 / std::numbers::pi;
        if (std::abs(degrees) < kLeastAngle) continue;
        if (std::abs(degrees) > 2 * std::numbers::pi) return;
        ++count;
        if (std::abs(degrees - std::round(degrees)) < kLeastAngle) ++whole;
      }
    if (count >= kManyAngles && 2 * whole < count)
      said_.push_back(
          {"/units",
           "all joint angles are numbers below 6.28 (2 pi), which is small for degrees. If "
           "the angles are in radians, "
           "write \"units\": {\"angle\": \"rad\"}"});
  }

  void friction() {
    const double mu = pattern_.world.friction;
    if (mu > kRoughest)
      said_.push_back(
          {"/world/friction",
           "the friction of the ground is " + text::brief(mu) +
               ", but rubber on dry concrete has about 1" +
               (mu <= 100 ? ". If this is a percentage, write " + text::brief(mu / 100) : "")});
  }

  void pushes() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < pattern_.scenario.size(); ++i) {
      const Disturbance& d = pattern_.scenario[i];
      const auto* push = std::get_if<Push>(&d.what);
      if (!push || push->kind == PushKind::torque) continue;
      const bool impulse = push->kind == PushKind::impulse;
      const double acts = std::min(d.duration, kUnopposed);
      const double whole = push->magnitude * (impulse ? 1 : acts);
      const double speed = whole / model_.mass();
      if (!(speed > kFastestPush) || !std::isfinite(speed)) continue;
      const std::string unit = impulse ? "N s" : "N";
      std::string words = std::string(impulse ? "the impulse is " : "the force is ") +
                          text::brief(push->magnitude) + " " + unit + ", which gives " +
                          model_.name() + " (" + text::brief(model_.mass(), 3) +
                          " kg) a speed of " + text::brief(speed, 3) + " m/s" +
                          (impulse ? "" : " within " + text::brief(acts) + " s");
      if (1e-3 * speed <= kFastestPush)
        words +=
            ". If this number is in m" + unit + ", write " + text::brief(1e-3 * push->magnitude);
      found.push_back({"/scenario/" + std::to_string(i), words});
    }
    say(found);
  }

  // Disturbances may begin after the end of the motion, because a simulation holds the last posture
  // for a while.
  void late_disturbances() {
    if (!feet_) return;
    std::vector<Mistake> found;
    for (size_t i = 0; i < pattern_.scenario.size(); ++i)
      if (pattern_.scenario[i].at > feet_->duration() + kHeld)
        found.push_back({"/scenario/" + std::to_string(i),
                         "the disturbance begins at " + text::brief(pattern_.scenario[i].at) +
                             " s, but the motion ends at " + text::brief(feet_->duration()) +
                             " s. The simulation ends " + text::brief(kHeld) +
                             " s after the motion, so the disturbance has no effect. Let the "
                             "disturbance begin earlier, or make the motion longer"});
    say(found);
  }

  void times() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < feet_->phases().size(); ++i) {
      const Phase& phase = feet_->phases()[i];
      const double lasts = phase.until - feet_->begin(static_cast<int>(i));
      if (phase.swing && lasts > kLongestSwing)
        found.push_back(
            {phase_place(i),
             std::string("the swing lasts ") + text::brief(lasts) +
                 " s. Times are in seconds. If these times are in ms, divide them by 1000"});
    }
    const std::vector<Phase>& phases = feet_->phases();
    const bool swings = std::any_of(phases.begin(), phases.end(),
                                    [](const Phase& phase) { return phase.swing.has_value(); });
    if (!swings && feet_->duration() > kLongestStand)
      found.push_back(
          {"", "the motion lasts " + text::brief(feet_->duration()) +
                   " s. Times are in seconds. If these times are in ms, divide them by 1000"});
    say(found);
  }

  // The largest possible COG height: the height at home, plus the length by which the bent legs can
  // still be stretched.
  double highest_cog(double home) const { return home + leg_length(model_) - home_reach(model_); }

  void cog_heights() {
    const double home = default_cog_height(model_, {}), most = highest_cog(home);
    std::vector<Mistake> found;
    const auto look = [&](const std::string& place, double height) {
      if (height <= most && height >= kLowestCog * home) return;
      std::string words =
          "the COG height is " + metres(height) + ", but the COG of " + model_.name() + " is " +
          metres(home) + " above the soles in the home posture. " +
          (height > most ? "With straight legs, the COG height is " + metres(most)
                         : "The COG height should be at least " + metres(kLowestCog * home));
      for (const auto& [unit, factor] : {std::pair("mm", 1e-3), std::pair("cm", 1e-2)})
        if (height * factor <= most && height * factor >= kLowestCog * home)
          words += ". Heights are in metres, and " + text::brief(height) + " " + unit + " are " +
                   metres(height * factor);
      found.push_back({place, words});
    };
    if (pattern_.cog_height != 0) look("/defaults/cog_height", pattern_.cog_height);
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      if (const auto& height = pattern_.keyframes[i].cog_height)
        look(key_place(i), *height - feet_->ground(pattern_.keyframes[i].t));
    say(found);
  }

  /// Where a swing lands, in the frame of the other sole.
  Vector3d landing(size_t phase) const {
    const Swing& swing = *feet_->phases()[phase].swing;
    const Eigen::Isometry3d stance = feet_->pose(other(swing.foot), feet_->phases()[phase].until);
    return stance.inverse() * swing.to.position;
  }

  void footholds() {
    const double leg = leg_length(model_);
    std::vector<Mistake> found;
    std::array<bool, 2> far = {};  // whether this foot stands at a foothold that was already named
    for (size_t i = 0; i < feet_->phases().size(); ++i) {
      if (!feet_->phases()[i].swing) continue;
      const Swing& swing = *feet_->phases()[i].swing;
      const double distance = landing(i).norm();
      bool& named = far[static_cast<size_t>(index(swing.foot))];
      named = distance > leg && !far[static_cast<size_t>(index(other(swing.foot)))];
      if (!named) continue;
      found.push_back({phase_place(i),
                       std::string("the ") + name_of(swing.foot) + " foot lands " +
                           metres(distance) + " from the " + name_of(other(swing.foot)) +
                           " foot, but the legs are " + metres(leg) + " long" +
                           (distance > 10 * leg ? ". Check the unit: lengths are in metres" : "")});
    }
    say(found);
  }

  /// Whether the boxes around both soles overlap if the sole of `foot` is at this place in the
  /// frame of the other one.
  bool soles_overlap(Side foot, const Vector3d& place) const {
    const auto box_of = [&](Side side) {
      Eigen::AlignedBox2d box;
      for (const Eigen::Vector2d& corner : model_.sole(side).polygon) box.extend(corner);
      return box;
    };
    const Eigen::AlignedBox2d common =
        box_of(foot).translated(place.head<2>()).intersection(box_of(other(foot)));
    return (common.sizes().array() > 0).all() && std::abs(place.z()) < kLiftedKey;
  }

  void crossings() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < feet_->phases().size(); ++i) {
      if (!feet_->phases()[i].swing) continue;
      const Swing& swing = *feet_->phases()[i].swing;
      const double outwards = (swing.foot == Side::left ? 1 : -1) * landing(i).y();
      if (outwards > -kCrossing) {
        if (soles_overlap(swing.foot, landing(i)))
          found.push_back({phase_place(i), std::string("the ") + name_of(swing.foot) +
                                               " foot lands on the " + name_of(other(swing.foot)) +
                                               " foot. Perhaps left and right were exchanged"});
        continue;
      }
      found.push_back({phase_place(i),
                       std::string("the ") + name_of(swing.foot) + " foot lands " +
                           text::fixed(-1000 * outwards, 0) + " mm to the " +
                           name_of(other(swing.foot)) + " of the " + name_of(other(swing.foot)) +
                           " foot, so the legs cross. Perhaps left and right were exchanged"});
    }
    say(found);
  }

  // Finds single supports in which the keys before and after their middle are under the other foot.
  void zmp_keys() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < feet_->phases().size(); ++i) {
      const Support support = feet_->phases()[i].support;
      if (support != Support::left && support != Support::right) continue;
      const ZmpKey::Place wrong =
          support == Support::left ? ZmpKey::Place::right : ZmpKey::Place::left;
      const double middle = 0.5 * (feet_->begin(static_cast<int>(i)) + feet_->phases()[i].until);
      std::optional<size_t> before, after;
      for (size_t k = 0; k < pattern_.keyframes.size(); ++k) {
        if (!pattern_.keyframes[k].zmp) continue;
        if (pattern_.keyframes[k].t <= middle) before = k;
        if (pattern_.keyframes[k].t >= middle && !after) after = k;
      }
      const auto is_wrong = [&](std::optional<size_t> k) {
        return k && (pattern_.keyframes[*k].zmp->place == wrong ||
                     pattern_.keyframes[*k].zmp->place == ZmpKey::Place::center);
      };
      if (!is_wrong(before) || !is_wrong(after)) continue;
      const bool left = support == Support::left;
      const bool under = pattern_.keyframes[*before].zmp->place == wrong;
      found.push_back(
          {phase_place(i),
           std::string("the robot stands on the ") + (left ? "left" : "right") + " foot, but " +
               key_place(*before) +
               (key_place(*before) == key_place(*after) ? std::string(" puts")
                                                        : " and " + key_place(*after) + " put") +
               " the ZMP " +
               (under ? std::string("under the ") + (left ? "right" : "left") + " foot"
                      : std::string("at \"center\", between both feet"))});
    }
    say(found);
  }

  void missing_swings() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < feet_->phases().size(); ++i) {
      const Phase& phase = feet_->phases()[i];
      if (phase.swing || phase.viip ||
          (phase.support != Support::left && phase.support != Support::right))
        continue;
      const Side idle = phase.support == Support::left ? Side::right : Side::left;
      const double begin = feet_->begin(static_cast<int>(i)), middle = 0.5 * (begin + phase.until);
      const Eigen::Isometry3d now = feet_->pose(idle, middle);
      const double height =
          now.translation().z() - feet_->pose(other(idle), middle).translation().z();
      const double moved =
          (feet_->pose(idle, phase.until).translation() - feet_->pose(idle, begin).translation())
              .norm();
      if (std::abs(height) < kOnGround && moved < kOnGround)
        found.push_back({phase_place(i), std::string("the robot stands on the ") +
                                             name_of(other(idle)) + " foot alone, but the " +
                                             name_of(idle) +
                                             " foot stays on the ground. Perhaps a swing of the " +
                                             name_of(idle) + " foot is missing"});
    }
    say(found);
  }

  void heights_of_feet() {
    std::vector<Mistake> found;
    for (const RaisedFoot& foot : raised_feet(model_, pattern_, *feet_))
      found.push_back({foot.place, foot.words});
    say(found);
  }

  // Without keys, the COG keeps its height above the mean height of both soles, so a lifted foot
  // raises it by half of the lift. This rule names the keys that lift a foot, the highest one
  // first.
  void lifted_keys() {
    const bool has_height = std::any_of(pattern_.keyframes.begin(), pattern_.keyframes.end(),
                                        [](const Keyframe& key) { return key.cog_height; });
    if (has_height) return;
    struct Lifted {
      std::string place;
      Side side = Side::left;
      double lift = 0;
    };
    std::vector<Lifted> lifted;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i) {
      const Keyframe& key = pattern_.keyframes[i];
      for (const Side side : {Side::left, Side::right}) {
        const auto& foot = key.feet[static_cast<size_t>(index(side))];
        if (!foot || supports(feet_->support(key.t), side)) continue;
        const double lift = foot->position.z() - feet_->pose(other(side), key.t).translation().z();
        if (lift > kLiftedKey) lifted.push_back({key_place(i), side, lift});
      }
    }
    if (lifted.empty()) return;
    const auto highest =
        std::max_element(lifted.begin(), lifted.end(),
                         [](const Lifted& a, const Lifted& b) { return a.lift < b.lift; });
    std::vector<std::string> others;
    for (const Lifted& one : lifted)
      if (one.place != highest->place &&
          std::find(others.begin(), others.end(), one.place) == others.end())
        others.push_back(one.place);
    if (others.size() > kNamedLifts) others = {text::counted(others.size(), "other keyframe")};
    say({{highest->place,
          std::string("the ") + name_of(highest->side) + " foot is lifted by " +
              text::fixed(1000 * highest->lift, 0) + " mm" +
              (others.empty() ? ""
                              : " (it is also lifted in " + text::join(others, " and ") + ")") +
              ". The COG rises by half of this height, because without keys the COG keeps its "
              "height above the mean of both soles. Keep the COG down with keys of "
              "\"cog\": {\"height\": ...}, or lower /defaults/cog_height"}});
  }

  void leg_keys() {
    std::vector<Mistake> found;
    for (size_t i = 0; i < pattern_.keyframes.size(); ++i)
      for (const auto& [joint, angle] : pattern_.keyframes[i].joints) {
        const int dof = model_.find_dof(joint);
        const auto in = [&](Side side) {
          const auto& leg = model_.leg(side);
          return std::find(leg.begin(), leg.end(), dof) != leg.end();
        };
        if (dof < 0 || !model_.has_soles() || (!in(Side::left) && !in(Side::right))) continue;
        found.push_back(
            {key_place(i),
             joint + " is a joint of a leg. As soon as one leg joint has a key, all leg joints "
                     "follow only their keys, and Ayumi no longer computes them from the feet and "
                     "the COG. Remove this key, and give keys of the COG, the feet or the torso "
                     "instead"});
        break;
      }
    say(found);
  }

  const RobotModel& model_;
  const Pattern& pattern_;
  std::optional<FootPlan> feet_;
  std::vector<Mistake> said_;
};

}  // namespace

std::vector<Mistake> impossible_values(const RobotModel& model, const Pattern& pattern) {
  if (pattern.table) return {};  // nobody wrote its values by hand
  return Suspicions(model, pattern).all();
}

std::optional<Mistake> times_in_ms(const RobotModel& model, const Pattern& pattern,
                                   const CheckOptions& options) {
  if (pattern.table || pattern.correction) return {};  // a motion with a correction was sampled
  std::vector<Mistake> found = Suspicions(model, pattern).long_times();
  if (found.empty()) return {};
  Mistake mistake = std::move(found.front());
  Pattern meant = pattern;
  hypotheses::scale_times(meant, kMillisecond);
  try {
    const CommandSeries series =
        sample(model, meant, {.dt = model.description().servo_period, .threads = options.threads});
    mistake.explains_all = check_consistency(model, series, options).consistent;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_pattern) throw;
  }
  if (mistake.explains_all)
    mistake.words += ". With all times read as ms, the pattern would be consistent";
  return mistake;
}

std::vector<Mistake> doubtful_values(const RobotModel& model, const Pattern& pattern) {
  if (pattern.table) return {};
  return Suspicions(model, pattern).doubts();
}

std::vector<Mistake> likely_mistakes(const RobotModel& model, const Pattern& pattern,
                                     const CheckOptions& options, const Progress& progress) {
  const Explanations search = find_explanations(model, pattern, options, progress);
  std::vector<Mistake> mistakes;
  const auto add = [&](bool way_out) {
    for (const Explanation& e : search.found)
      if (e.is_way_out == way_out)
        mistakes.push_back({.place = e.place,
                            .words = text::two_sentences(e.written, e.instead),
                            .explains_all = e.enough,
                            .round = e.round});
  };
  add(false);
  const std::vector<Mistake> impossible = impossible_values(model, pattern);
  if (mistakes.empty()) mistakes = impossible;
  // If it is known why a value is impossible, the reason comes first, and then the value that is
  // possible.
  if (!search.found.empty())
    for (const Mistake& why : impossible)
      if (const Explanation& e = search.found.front();
          why.place == e.place && why.words.starts_with(e.written + ","))
        mistakes.front().words = text::two_sentences(why.words, e.instead);
  add(true);
  if (search.complete) return mistakes;
  const std::string stopped =
      "the search stopped after " + std::to_string(search.trials) + " trial changes of the pattern";
  if (mistakes.empty())
    return {{.place = "", .words = "no likely cause was found, and " + stopped, .is_cause = false}};
  mistakes.back().words += ". There may be another cause, because " + stopped;
  return mistakes;
}

std::vector<std::string> cause_texts(const std::vector<Mistake>& mistakes) {
  std::vector<std::string> texts;
  for (const Mistake& mistake : mistakes)
    if (mistake.is_cause) texts.push_back(mistake.text());
  return texts;
}

Error with_mistakes(const Error& error, const Pattern& pattern,
                    const std::vector<Mistake>& mistakes) {
  if (mistakes.empty()) return error;
  const auto cause = std::find_if(mistakes.begin(), mistakes.end(),
                                  [](const Mistake& mistake) { return mistake.is_cause; });
  if (cause == mistakes.end()) {
    const std::string& more = mistakes.front().words;
    return {error.code(), text::two_sentences(error.what(), more), error.place(),
            text::two_sentences(error.words(), more)};
  }
  const bool in_file = !pattern.file.empty() && error.place().file == pattern.file;
  std::string causes;
  int round = 0;
  for (const Mistake& mistake : mistakes) {
    if (!mistake.is_cause) continue;
    if (!causes.empty()) causes += mistake.round > round ? ". In addition, " : ". Or ";
    causes += mistake.text();
    round = mistake.round;
  }
  const std::string words =
      "likely cause: " + causes + ". First error: " + (in_file ? error.words() : error.what());
  SourcePlace place = error.place();
  // The place of the error becomes that of the first cause, because the author should change the
  // pattern there.
  if (in_file && cause->place.starts_with("/")) place.inside = cause->place;
  return {error.code(), (in_file ? pattern.file + ": " : "") + words, place, words};
}

}  // namespace ayumi
