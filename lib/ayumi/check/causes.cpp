// Data feed each other in one direction: a joint's angle makes poses, poses and time make rates,
// rates make forces, and command tracks are compared with all of them. A finding is a consequence
// where a finding upstream, at the same place in the motion, is enough to bring it about:
//   foot      one foot out of its place shows as slip, depth and height: the largest is the cause
//   posture   an angle beyond its limit, a collision, a foot out of place or a jump between two
//             samples  ->  forces and residuals, as long as the posture is off the command; an
//             angle also  ->  its rates and the feet on its leg; but not a ZMP outside the support
//             that the command itself asks for
//   phase     a foot that is said to land too early  ->  forces at the other end of that phase,
//             where the other foot is let go too early
//   flight    a COG that does not fall freely  ->  the moment of the same force, f_z, COG residual
//   haste     joints too fast or too weak  ->  forces and residuals that the same path, played
//             slower, does not have
//   support   a ZMP outside the sole  ->  leg torques, which no sole could bear
//   ground    too little friction  ->  too little resistance to turning
//   command   a posture off the commanded COG  ->  ZMP and f_z off theirs
#include "ayumi/check/causes.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/version.hpp"
#include "ayumi/check/residuals.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

using Eigen::Vector3d;

namespace {

constexpr double kTrace = 1e-4;   // COG deviation that still belongs to a fault [m]
constexpr double kSlack = 0.050;  // the ZMP answers before the COG is off by kTrace [s]
constexpr double kReach = 0.5;    // an outer force acts within this part of the height
constexpr double kStill = 0.01;   // joints slower than this rest [rad/s]
constexpr double kSlowest = 0.3;  // pace down to which haste is looked for
constexpr double kPaceStep = 0.05;
constexpr int kStencil = 3;         // samples that one jump spoils by differences
constexpr int kThermalLooks = 100;  // of the RMS torque at another pace

struct Span {
  int first = 0, last = 0;
  bool touches(const FindingWindow& w) const { return w.first <= last && w.last >= first; }
};

bool is_foot(Kind k) {
  return k == Kind::foot_slip || k == Kind::foot_penetration || k == Kind::foot_float;
}

// What the motion asks of ground and motors: all of it comes from accelerations.
bool is_need(const Violation& v) {
  switch (v.kind) {
    case Kind::friction:
    case Kind::unilateral:
    case Kind::yaw_moment:
    case Kind::ballistic:
    case Kind::angular_momentum:
    case Kind::joint_torque:
    case Kind::continuous_torque:
      return true;
    default:
      return v.kind == Kind::support_margin && v.item == 0;  // of the motion, not the command
  }
}

bool is_residual(Kind k) {
  return k == Kind::cog_residual || k == Kind::zmp_residual || k == Kind::fz_residual;
}

class Causes {
 public:
  Causes(CheckPass& pass, std::vector<FindingWindow>& windows) : pass_(pass), windows_(windows) {}

  void run() {
    one_foot();
    for (const Kind kind : {Kind::joint_position, Kind::foot_float, Kind::foot_slip,
                            Kind::foot_penetration, Kind::self_collision, Kind::servo_step})
      posture(kind);
    moved_phase();
    flight();
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
  Span span(int i, int slack = 0) const {
    return {windows_[i].first - slack, windows_[i].last + slack};
  }
  int slack() const { return static_cast<int>(std::lround(kSlack / pass_.series.dt)); }

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
            span(i, slack()).touches(windows_[j]) && larger(j, i))
          windows_[i].cause = j;
    }
  }

  // The window of a fault, and around it as far as the posture's COG is off the command.
  Span episode(int i) const {
    const int gap = std::max(1, static_cast<int>(std::lround(kWindowGap / pass_.series.dt)));
    const auto grow = [&](int from, int step) {
      int edge = from;
      for (int k = from; k >= 0 && k < pass_.count() && std::abs(k - edge) <= gap; k += step)
        if (pass_.cog_deviation[k] > kTrace) edge = k;
      return edge;
    };
    return {grow(windows_[i].first, -1) - slack(), grow(windows_[i].last, 1) + slack()};
  }

  bool in_a_leg(int dof) const {
    for (const Side side : {Side::left, Side::right}) {
      const std::vector<int>& leg = pass_.model.leg(side);
      if (std::find(leg.begin(), leg.end(), dof) != leg.end()) return true;
    }
    return false;
  }

  // A ZMP outside the support because the command wants it there: no posture is to blame.
  bool is_asked_for(const Violation& v) {
    if (v.kind != Kind::support_margin) return false;
    const Vector3d zmp = pass_.dynamics.at(v.sample, 1).use.zmp_world;
    const Vector3d& command = pass_.series.samples[v.sample].zmp;
    const SupportPlane& plane = pass_.dynamics.plane();
    const Vector3d inside = plane.frame.inverse() * command;
    return (zmp - command).norm() <= pass_.tolerance(Kind::zmp_residual) &&
           plane.polygon.margin(inside.head<2>()) < -kRounding;
  }

  void posture(Kind kind) {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != kind || !open(i)) continue;
      const bool joint = kind == Kind::joint_position || kind == Kind::servo_step;
      const bool places_feet = joint && in_a_leg(of(i).item);
      blame(i, episode(i), [&](int j) {
        const Violation& v = of(j);
        if (is_asked_for(v)) return false;
        if (is_need(v) || is_residual(v.kind)) return true;
        if (places_feet && is_foot(v.kind)) return true;
        const bool rate = v.kind == Kind::joint_speed || v.kind == Kind::servo_step;
        return joint && rate && v.item == of(i).item;
      });
    }
  }

  // The supporting foot lands too early and the other one is let go just as much too early, or the
  // other way round: one phase has moved. The forces of the samples where a foot that still stands
  // is not counted follow from it.
  void moved_phase() {
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != Kind::foot_float || !open(i)) continue;
      const Support here = pass_.series.samples[of(i).sample].support;
      Span phase = span(i);
      const auto same = [&](int k) { return pass_.series.samples[k].support == here; };
      while (phase.first > 0 && same(phase.first - 1)) --phase.first;
      while (phase.last + 1 < pass_.count() && same(phase.last + 1)) ++phase.last;
      blame(i, {phase.first - 1, phase.last + 1},
            [&](int j) { return is_need(of(j)) && another_foot_stands(of(j).sample); });
    }
  }

  bool another_foot_stands(int k) const {
    RobotData data(pass_.model);
    update_positions(pass_.model, pass_.series.samples[k].state, data);
    for (const Side side : {Side::left, Side::right}) {
      const int s = static_cast<int>(side), interval = pass_.plan.index[s][k];
      if (pass_.plan.at(side, k).contact) continue;
      for (const int next : {interval - 1, interval + 1}) {
        if (next < 0 || next >= static_cast<int>(pass_.plan.intervals[s].size())) continue;
        const SoleError e = sole_error(pass_.model.sole(side), sole_pose(pass_.model, data, side),
                                       pass_.plan.intervals[s][next].sole);
        if (e.gap <= pass_.tolerance(Kind::foot_float) &&
            e.slip <= pass_.tolerance(Kind::foot_slip))
          return true;
      }
    }
    return false;
  }

  // No sole can give the moment of a ZMP outside it: the leg torques found for it are no fact.
  void support() {
    for (int i = 0; i < count(); ++i)
      if (of(i).kind == Kind::support_margin && of(i).item == 0 && open(i))
        blame(i, span(i, kStencil),
              [&](int j) { return of(j).kind == Kind::joint_torque && in_a_leg(of(j).item); });
  }

  // A force in flight, wherever it acts on the robot, turns it too.
  void flight() {
    const double arm = kReach * pass_.series.samples.front().cog.z();
    for (int i = 0; i < count(); ++i) {
      if (of(i).kind != Kind::ballistic || !open(i)) continue;
      const double moment = of(i).value * pass_.model.mass() * arm;
      blame(i, span(i, kStencil), [&](int j) {
        const Violation& v = of(j);
        if (v.kind == Kind::angular_momentum) return v.value <= moment;
        return v.kind == Kind::ballistic || v.kind == Kind::fz_residual ||
               v.kind == Kind::cog_residual;
      });
    }
  }

  // Samples between two rests.
  Span motion_around(int k) const {
    const auto moves = [&](int i) {
      return pass_.series.samples[i].state.dtheta.cwiseAbs().maxCoeff() > kStill;
    };
    Span s{k, k};
    while (s.first > 0 && moves(s.first - 1)) --s.first;
    while (s.last + 1 < pass_.count() && moves(s.last + 1)) ++s.last;
    return s;
  }

  bool speed_holds(const Violation& v, double pace) const {
    return std::abs(v.value) * pace <= std::abs(v.limit);
  }

  bool torque_holds(const Violation& v, double pace) {
    return std::abs(pass_.dynamics.at(v.sample, pace).torque[v.item]) <= std::abs(v.limit);
  }

  bool rms_holds(int j, double pace) {
    const Violation& v = of(j);
    const int whole = static_cast<int>(std::lround(pass_.limits.thermal_window / pass_.series.dt));
    const int length = std::clamp(whole, 1, v.sample + 1);
    double sum = 0;
    for (int n = 0; n < kThermalLooks; ++n) {
      const int k = v.sample - static_cast<int>(static_cast<long>(n) * length / kThermalLooks);
      const double torque = std::min(std::abs(pass_.dynamics.at(k, pace).torque[v.item]),
                                     pass_.limits.peak_torque[v.item]);
      sum += torque * torque;
    }
    return std::sqrt(sum / kThermalLooks) <= v.limit;
  }

  // Whether the worst sample of a finding is sound when the path is played at this pace.
  bool holds(int j, double pace) {
    const Violation& v = of(j);
    if (v.kind == Kind::joint_speed) return speed_holds(v, pace);
    if (v.kind == Kind::joint_torque) return torque_holds(v, pace);
    if (v.kind == Kind::continuous_torque) return rms_holds(j, pace);
    const SampleDynamics& now = pass_.dynamics.at(v.sample, pace);
    const CommandSample& s = pass_.series.samples[v.sample];
    const double limit = std::abs(v.limit);
    switch (v.kind) {
      case Kind::zmp_residual:
        return now.use.has_zmp && (now.use.zmp_world - s.zmp).norm() <= limit;
      case Kind::fz_residual:
        return std::abs(now.wrench[2] - s.fz) <= limit;
      case Kind::support_margin:
        return now.use.has_zmp && now.use.margin >= -kRounding;
      case Kind::unilateral:
        return now.use.normal_force >= 0;
      case Kind::friction:
        return now.use.tangential_force <= limit * pass_.friction * now.use.normal_force;
      case Kind::yaw_moment:
        return std::abs(now.use.yaw_moment) <=
               limit * pass_.friction * now.use.normal_force *
                   yaw_lever(pass_.dynamics.plane().polygon, now.use.zmp);
      case Kind::ballistic:
        return (now.ddcog + Vector3d(0, 0, kGravity)).norm() <= limit;
      case Kind::angular_momentum:
        return now.moment.norm() <= limit;
      default:
        return false;
    }
  }

  bool rough_near(int sample) const {
    for (int k = std::max(0, sample - kStencil);
         k <= std::min(pass_.count() - 1, sample + kStencil); ++k)
      if (pass_.rough[k]) return true;
    return false;
  }

  // One pace at which the motors follow and this finding is gone as well. Where the motion is
  // broken by differences over a jump, no pace mends it: then it is haste's doing.
  bool mended_by_time(int cause, int j) {
    if (rough_near(of(j).sample)) return true;
    for (double pace = 1 - kPaceStep; pace > kSlowest; pace -= kPaceStep)
      if (holds(cause, pace) && holds(j, pace)) return true;
    return false;
  }

  // Errors of one kind, the worst first.
  std::vector<int> by_excess(Kind kind) const {
    std::vector<int> result;
    for (int i = 0; i < count(); ++i)
      if (of(i).kind == kind && open(i)) result.push_back(i);
    std::stable_sort(result.begin(), result.end(),
                     [&](int a, int b) { return of(a).excess > of(b).excess; });
    return result;
  }

  // The worst joint of every motion between two rests speaks for it.
  void haste() {
    for (const Kind kind : {Kind::joint_speed, Kind::joint_torque}) {
      std::vector<Span> told;
      for (const int i : by_excess(kind)) {
        if (std::any_of(told.begin(), told.end(),
                        [&](const Span& s) { return s.touches(windows_[i]); }))
          continue;
        told.push_back(motion_around(of(i).sample));
        blame(i, told.back(), [&](int j) {
          const Violation& v = of(j);
          const bool follows = (is_need(v) && v.kind != Kind::joint_torque) ||
                               v.kind == Kind::zmp_residual || v.kind == Kind::fz_residual;
          return follows && mended_by_time(i, j);
        });
      }
    }
  }

  // The coefficient that the worst place needs would also keep the foot from turning.
  void ground() {
    for (const int i : by_excess(Kind::friction)) {
      const double more = of(i).value / of(i).limit;
      blame(i, {0, pass_.count()}, [&](int j) {
        return of(j).kind == Kind::yaw_moment && of(j).value <= more * of(j).limit;
      });
    }
  }

  void command() {
    for (const int i : by_excess(Kind::cog_residual))
      blame(i, episode(i), [&](int j) {
        return of(j).kind == Kind::zmp_residual || of(j).kind == Kind::fz_residual;
      });
  }

  CheckPass& pass_;
  std::vector<FindingWindow>& windows_;
};

}  // namespace

void explain(CheckPass& pass, std::vector<FindingWindow>& windows) { Causes(pass, windows).run(); }

}  // namespace ayumi
