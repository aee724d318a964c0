// Data feed each other in one direction: a joint's angle makes poses, poses and time make rates,
// rates make forces, and command tracks are compared with all of them. A finding is a consequence
// where a finding upstream, at the same place in the motion, is enough to bring it about:
//   foot      one foot out of its place shows as slip, depth and height: the largest is the cause
//   posture   an angle beyond its limit, a collision, a foot out of place or a jump between two
//             samples  ->  forces and residuals, as long as the posture is off the command; an
//             angle also  ->  its rates, the feet on its leg and bodies that just touch by it; but
//             not a ZMP outside the support that the command itself asks for
//   edges     a posture that is wrong from one sample to the next and back  ->  the speeds of both
//   flight    a COG that does not fall freely  ->  the moment of the same force, f_z, COG residual,
//             how deep the feet come meanwhile
//   phase     a foot that is said to land too early  ->  forces at the other end of that phase,
//             where the other foot is let go too early
//   haste     joints too fast or too weak  ->  forces and residuals that the same path, played
//             slower, does not have
//   support   a ZMP outside the sole  ->  leg torques, which no sole could bear
//   ground    too little friction  ->  too little resistance to turning
//   command   a COG that is not the posture's  ->  ZMP and f_z off theirs, and its own free fall; a
//             ZMP outside the support, where the commanded one or the motion's is inside  ->  their
//             distance
#include "ayumi/check/causes.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/check/slower_pace.hpp"
#include "ayumi/check/spans.hpp"
#include "ayumi/check/what_if.hpp"
#include "ayumi/demand/ground_demand.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

constexpr double kTwist = 2;     // what holds a turn is reckoned low by no more than this
constexpr double kReturn = 0.1;  // of a displacement, as good as back in its place
constexpr int kEdge = 5;         // around lift-off and landing, a jump of the path shows
constexpr int kStencil = 3;      // samples that one jump spoils by differences

bool is_foot(FindingKind k) {
  return k == FindingKind::foot_slip || k == FindingKind::foot_penetration ||
         k == FindingKind::foot_float;
}

// What the motion asks of ground and motors: all of it comes from accelerations.
bool is_need(const Violation& v) {
  switch (v.kind) {
    case FindingKind::friction:
    case FindingKind::unilateral:
    case FindingKind::yaw_moment:
    case FindingKind::ballistic:
    case FindingKind::angular_momentum:
    case FindingKind::joint_torque:
    case FindingKind::continuous_torque:
      return true;
    default:
      return v.kind == FindingKind::support_margin &&
             v.item == 0;  // of the motion, not the command
  }
}

bool is_flight(FindingKind k) {
  return k == FindingKind::ballistic || k == FindingKind::angular_momentum;
}

bool is_rate(FindingKind k) {
  return k == FindingKind::joint_speed || k == FindingKind::servo_step;
}

bool is_residual(FindingKind k) {
  return k == FindingKind::cog_residual || k == FindingKind::zmp_residual ||
         k == FindingKind::fz_residual;
}

class Causes {
 public:
  Causes(CheckPass& pass, std::vector<FindingWindow>& windows)
      : pass_(pass), windows_(windows), pace_(pass) {}

  void run() {
    one_foot();
    posture(FindingKind::joint_position);
    leaps();
    edges(FindingKind::foot_slip);
    edges(FindingKind::foot_float);
    edges(FindingKind::foot_penetration);
    held_joints();
    posture(FindingKind::foot_float);
    posture(FindingKind::foot_slip);
    moved_command_in_flight();
    flight();
    for (const FindingKind kind :
         {FindingKind::foot_penetration, FindingKind::self_collision, FindingKind::servo_step})
      posture(kind);
    moved_phase();
    haste();
    support();
    ground();
    command();
    for (FindingWindow& w : windows_)
      if (w.cause >= 0) w.worst.severity = Severity::warning;
  }

 private:
  int count() const { return static_cast<int>(windows_.size()); }
  const Violation& of(int i) const { return windows_[i].worst; }
  bool open(int i) const {
    return windows_[i].cause < 0 && windows_[i].worst.severity == Severity::error;
  }
  int slack() const { return slack_samples(pass_); }

  // Every other error j that touches the span and of which follows(j) holds comes from cause i.
  template <typename Follows>
  void blame(int i, const Span& where, const Follows& follows) {
    for (int j = 0; j < count(); ++j)
      if (j != i && open(j) && where.touches(windows_[j]) && follows(j)) windows_[j].cause = i;
  }

  // All lengths: the foot is most off along the way that is largest.
  void one_foot() {
    const auto larger = [&](int i, int j) {
      return std::abs(of(i).value) != std::abs(of(j).value)
                 ? std::abs(of(i).value) > std::abs(of(j).value)
                 : i < j;
    };
    for (int i = 0; i < count(); ++i) {
      if (!is_foot(of(i).kind) || !open(i)) continue;
      for (int j = 0; j < count() && open(i); ++j)
        if (j != i && is_foot(of(j).kind) && of(j).item == of(i).item && open(j) &&
            around(windows_[i], slack()).touches(windows_[j]) && larger(j, i))
          windows_[i].cause = j;
    }
  }

  bool in_leg_of(int foot, int dof) const {
    return in_leg(pass_.model, static_cast<Side>(foot), dof);
  }

  bool in_a_leg(int dof) const { return in_leg_of(0, dof) || in_leg_of(1, dof); }

  Span episode(int i) const {
    Span s = deviation_around(pass_, windows_[i]);
    if (is_foot(of(i).kind)) {
      const Span off = displacement_around(pass_, windows_[i]);
      s = {std::min(s.first, off.first), std::max(s.last, off.last)};
    }
    return around(s, slack());
  }

  // While an angle is wrong: its stroke, and as long as it moves the COG off the command.
  Span wrong_angle(int i) const {
    const Span s = deviation_around(pass_, windows_[i]), stroke = stroke_around(pass_, windows_[i]);
    return {std::min(s.first, stroke.first), std::max(s.last, stroke.last)};
  }

  Span episode_of_joint(int i) const { return around(wrong_angle(i), slack()); }

  bool is_jump(int j, int sample) const {
    const FindingWindow& w = windows_[j];
    return is_rate(w.worst.kind) && w.last - w.first <= 2 * kStencil &&
           around(w, kStencil).contains(sample);
  }

  bool jumps(const Violation& v) const {
    const auto begin = pass_.rough.begin();
    return std::any_of(begin + std::max(0, v.sample - kStencil),
                       begin + std::min(pass_.count(), v.sample + kStencil + 1),
                       [](char rough) { return rough; });
  }

  // A sole that is out of its place all at once, and back in it all at once or at the end of its
  // contact: the leg jumps with it, each joint as its geometry asks.
  bool stands_before_and_after(const FindingWindow& w) const {
    const int foot = w.worst.item;
    const ContactInterval& contact = pass_.plan.at(static_cast<Side>(foot), w.worst.sample);
    const double small = kReturn * displacement(pass_, foot, w.worst.sample);
    const auto stands = [&](int k) {
      return k < contact.first || k > contact.last || displacement(pass_, foot, k) <= small;
    };
    return contact.contact && stands(w.first - kStencil) && stands(w.last + kStencil);
  }

  // A foot that is off its place on the ground makes no flight unfree, but differences over a jump
  // into it reach a few samples back.
  bool near_displacement(int i, int sample) const {
    const Span off = displacement_around(pass_, windows_[i]);
    return off.first <= sample + kStencil && sample - kStencil <= off.last;
  }

  // Something of that leg overlaps by less than its foot is displaced, and only as long.
  bool touches_by_foot(int i, int j) const {
    const Violation& foot = of(i);
    const int hip = pass_.model.leg(static_cast<Side>(foot.item)).front();
    return -of(j).value <= displacement(pass_, foot.item, foot.sample) &&
           hangs_on(pass_, of(j), hip) &&
           displacement_around(pass_, windows_[i]).contains(windows_[j]);
  }

  void posture(FindingKind kind) {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != kind || !open(i)) continue;
      const bool limit = kind == FindingKind::joint_position;
      const bool joint = limit || kind == FindingKind::servo_step;
      const bool places_feet = joint && in_a_leg(of(i).item);
      blame(i, limit ? episode_of_joint(i) : episode(i), [&](int j) {
        const Violation& v = of(j);
        if (is_asked_for(pass_, v)) return false;
        if (is_foot(kind) && is_flight(v.kind)) return near_displacement(i, v.sample);
        if (is_foot(kind) && v.kind == FindingKind::cog_residual) return moves_cog(pass_, of(i), v);
        if (is_need(v) || is_residual(v.kind)) return true;
        if (places_feet && (is_foot(v.kind) || v.kind == FindingKind::contact_ends_early))
          return true;
        if (limit && v.kind == FindingKind::self_collision)
          return touches_by_limits(pass_, v) ||
                 (hangs_on(pass_, v, of(i).item) && wrong_angle(i).contains(windows_[j]));
        if (is_foot(kind) && v.kind == FindingKind::self_collision) return touches_by_foot(i, j);
        if (!joint || !is_rate(v.kind) || v.item != of(i).item) return false;
        return !limit || !jumps(v) || comes_back(pass_, v.item, around(wrong_angle(i), kStencil));
      });
    }
  }

  // Bodies meet while a joint that sets their distance is in a wrong place, held between two jumps
  // there and back.
  void held_joints() {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != FindingKind::self_collision || !open(i)) continue;
      for (int dof = 0; dof < pass_.model.dof_count(); ++dof) {
        if (!sets_distance(pass_, of(i), dof)) continue;
        const Span held = held_around(windows_[i], dof);
        if (!comes_back(pass_, dof, held)) continue;
        blame(i, held, [&](int j) {
          return of(j).item == dof && (is_jump(j, held.first) || is_jump(j, held.last));
        });
      }
    }
  }

  // From the last jump of the joint before this window to the first one after it.
  Span held_around(const FindingWindow& w, int dof) const {
    Span held = {0, pass_.count() - 1};
    for (const FindingWindow& jump : windows_) {
      const Violation& v = jump.worst;
      if (v.item != dof || !is_rate(v.kind)) continue;
      if (jump.first <= w.first + kStencil) held.first = std::max(held.first, jump.first);
      if (jump.last >= w.last + 1 - kStencil) held.last = std::min(held.last, jump.last);
    }
    return held;
  }

  // A foot in a wrong place, held between two jumps of the same joint, there and back.
  void edges(FindingKind kind) {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != kind || !open(i)) continue;
      const int there = windows_[i].first, back = windows_[i].last + 1;
      const bool foot = stands_before_and_after(windows_[i]);
      const Span edges = {there - kStencil, back + kStencil};
      blame(i, edges, [&](int j) {
        if (!is_jump(j, there) && !is_jump(j, back)) return false;
        return comes_back(pass_, of(j).item, edges) || (foot && in_leg_of(of(i).item, of(j).item));
      });
    }
  }

  // The supporting foot lands too early and the other one is let go just as much too early, or its
  // own swing or flight began too early: one phase has moved. A foot that is let go too early at
  // its other end follows from it, and what is asked of the samples where a foot that still stands
  // is not counted.
  void moved_phase() {
    const auto phases = [&](int i) { return around(moved_phases(pass_, of(i)), kStencil); };
    for (int i = 0; i < count(); ++i)
      if (of(i).kind == FindingKind::foot_float && open(i))
        blame(i, phases(i), [&](int j) { return of(j).kind == FindingKind::contact_ends_early; });
    for (int i = 0; i < count(); ++i) {
      const bool phase =
          of(i).kind == FindingKind::foot_float || of(i).kind == FindingKind::contact_ends_early;
      if (!phase || !open(i)) continue;
      blame(i, phases(i), [&](int j) {
        const bool asks = is_need(of(j)) || of(j).kind == FindingKind::support_margin;
        return asks && uncounted_foot_stands(pass_, of(j).sample);
      });
    }
  }

  // No sole can give the moment of a ZMP outside it: the leg torques found for it are no fact.
  void support() {
    for (int i = 0; i < count(); ++i)
      if (of(i).kind == FindingKind::support_margin && of(i).item == 0 && open(i))
        blame(i, around(windows_[i], kStencil), [&](int j) {
          return of(j).kind == FindingKind::joint_torque && in_a_leg(of(j).item);
        });
  }

  bool flies(int k) const {
    return k >= 0 && k < pass_.count() && pass_.series.samples[k].support == Support::none;
  }

  // The posture falls freely and only the commanded COG does not: where it is off the posture's
  // beyond the flight too, a COG key is wrong rather than the flight.
  void moved_command_in_flight() {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != FindingKind::cog_residual || !open(i)) continue;
      const Span off = deviation_around(pass_, windows_[i]);
      if (flies(off.first + kStencil) && flies(off.last - kStencil)) continue;
      blame(i, off, [&](int j) {
        return of(j).kind == FindingKind::ballistic && of(j).item == kCommandFalls;
      });
    }
  }

  // Soles that are off their place only where the flight leaps out of the ground or into it.
  void leaps() {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != FindingKind::ballistic || of(i).item != kMotionLeaps || !open(i)) continue;
      const Span beside = around(windows_[i], kEdge);
      blame(i, beside, [&](int j) { return is_foot(of(j).kind) && beside.contains(windows_[j]); });
    }
  }

  // Of what makes a flight unfree one finding is told: a force before a moment.
  void flight() {
    for (const FindingKind kind : {FindingKind::ballistic, FindingKind::angular_momentum}) {
      for (const int i : by_excess(kind)) {
        if (!open(i)) continue;
        Span whole = around(windows_[i]);
        while (flies(whole.first - 1)) --whole.first;
        while (flies(whole.last + 1)) ++whole.last;
        blame(i, whole, [&](int j) {
          if (of(j).kind == FindingKind::joint_torque) return holds_in_free_flight(pass_, of(j));
          return is_flight(of(j).kind) || of(j).kind == FindingKind::foot_penetration;
        });
        if (kind == FindingKind::ballistic) beside_flight(i, whole);
      }
    }
  }

  void beside_flight(int i, const Span& whole) {
    for (const int edge : {whole.first, whole.last}) {
      const Span beside = {edge - kEdge, edge + kEdge};
      blame(i, beside, [&](int j) {
        return beside.contains(windows_[j]) && (is_need(of(j)) || is_residual(of(j).kind));
      });
    }
    const Span near = around(whole, kEdge), here = around(windows_[i], kStencil);
    blame(i, near, [&](int j) {
      if (of(j).kind != FindingKind::fz_residual && of(j).kind != FindingKind::cog_residual)
        return false;
      return near.contains(windows_[j]) || here.touches(windows_[j]);
    });
  }

  std::vector<int> by_excess(FindingKind kind) const {
    std::vector<int> result;
    for (int i = 0; i < count(); ++i)
      if (of(i).kind == kind && open(i)) result.push_back(i);
    std::stable_sort(result.begin(), result.end(),
                     [&](int a, int b) { return of(a).excess > of(b).excess; });
    return result;
  }

  // The worst joint of every motion between two rests speaks for it.
  void haste() {
    for (const FindingKind kind : {FindingKind::joint_speed, FindingKind::joint_torque}) {
      std::vector<Span> told;
      for (const int i : by_excess(kind)) {
        if (std::any_of(told.begin(), told.end(),
                        [&](const Span& s) { return s.touches(windows_[i]); }))
          continue;
        told.push_back(motion_around(pass_, of(i).sample));
        blame(i, told.back(), [&](int j) {
          const Violation& v = of(j);
          const bool follows = (is_need(v) && v.kind != FindingKind::joint_torque) ||
                               v.kind == FindingKind::zmp_residual ||
                               v.kind == FindingKind::fz_residual ||
                               v.kind == FindingKind::servo_step;
          return follows && pace_.mends(of(i), of(j));
        });
      }
    }
  }

  // The coefficient that the worst place needs would also keep the foot from turning: the lever of
  // what resists a turn is a lower bound.
  void ground() {
    for (const int i : by_excess(FindingKind::friction)) {
      const double more = of(i).value / of(i).limit;
      blame(i, {0, pass_.count()}, [&](int j) {
        return of(j).kind == FindingKind::yaw_moment && of(j).value <= kTwist * more * of(j).limit;
      });
    }
  }

  void command() {
    for (const int i : by_excess(FindingKind::cog_residual))
      blame(i, episode(i), [&](int j) {
        return of(j).kind == FindingKind::zmp_residual || of(j).kind == FindingKind::fz_residual;
      });
    for (const int i : by_excess(FindingKind::support_margin))
      blame(i, around(windows_[i]), [&](int j) { return of(j).kind == FindingKind::zmp_residual; });
  }

  CheckPass& pass_;
  std::vector<FindingWindow>& windows_;
  SlowerPace pace_;
};

}  // namespace

void explain(CheckPass& pass, std::vector<FindingWindow>& windows) { Causes(pass, windows).run(); }

}  // namespace ayumi
