// Soles against the places where they should stand: slip, depth, height, and how contacts begin and
// end.
#include <algorithm>
#include <cmath>

#include "ayumi/check/check_pass.hpp"
#include "ayumi/dynamics/kinematics.hpp"

namespace ayumi {

namespace {

// By the sample before contact: at the first one in contact the plan already stands still.
void check_landing(CheckPass& pass, Side side, const ContactInterval& contact) {
  const int k = contact.first;
  RobotData data(pass.model);
  const auto place = [&](int sample) {
    update_positions(pass.model, pass.series.samples[sample].state, data);
    return Eigen::Vector3d(sole_pose(pass.model, data, side).translation());
  };
  const double way = contact.sole.linear().col(2).dot(place(k) - place(k - 1));
  const double speed = -way / pass.series.dt;
  raise_to(pass.summary.max_landing_speed, speed);
  const double limit = pass.tolerance(FindingKind::landing_speed);
  if (speed > limit)
    pass.add(FindingKind::landing_speed, static_cast<int>(side), k, speed, limit, speed, 0,
             Severity::warning);
}

// A foot that is said to have landed but goes on coming down to its place, or rises from it before
// it is said to lift off: the swing is longer than the phases say. A slow swing hangs less than a
// sole may float by, so this is told by how it moves.
void check_contact_edge(CheckPass& pass, Side side, const ContactInterval& contact, bool lands) {
  const int k = lands ? contact.first : contact.last;
  const double limit = kRunOnShare * pass.tolerance(FindingKind::foot_float);
  const RunOn run = swing_run_on(pass.model, pass.series, side, contact, lands);
  raise_to(pass.summary.max_foot_float, run.height);
  if (run.height <= limit) return;
  pass.windows.add({FindingKind::foot_float, static_cast<int>(side), k, Severity::error, run.height,
                    limit, run.height, lands ? run.samples : -run.samples},
                   lands ? k : k - run.samples, lands ? k + run.samples : k);
}

// The other way round: a foot that is said to swing and still stands.
void check_lift(CheckPass& pass, Side side, const ContactInterval& contact,
                const ContactInterval& swing) {
  const double limit = pass.tolerance(FindingKind::contact_ends_early);
  const double late =
      pass.series.dt * samples_after_contact(pass.model, pass.series, side, contact, swing);
  if (late > limit)
    pass.add(FindingKind::contact_ends_early, static_cast<int>(side), contact.last, late, limit,
             late);
}

bool in_place(const CheckPass& pass, int foot, int k) {
  const SoleError& e = pass.soles[foot][k];
  return e.gap <= pass.tolerance(FindingKind::foot_float) &&
         e.slip <= pass.tolerance(FindingKind::foot_slip);
}

// A foot in the air does not slip: it floats. But one that leaves its place and comes back to it
// in one contact is displaced, whatever its height meanwhile.
void check_supporting_foot(CheckPass& pass, Side side, const ContactInterval& contact) {
  const int foot = static_cast<int>(side);
  const double high = pass.tolerance(FindingKind::foot_float),
               far = pass.tolerance(FindingKind::foot_slip);
  int first = contact.first, last = contact.last;
  while (first <= last && !in_place(pass, foot, first)) ++first;
  while (last > first && !in_place(pass, foot, last)) --last;
  for (int k = contact.first; k <= contact.last; ++k) {
    const SoleError& e = pass.soles[foot][k];
    raise_to(pass.summary.max_foot_float, e.gap);
    if (k == contact.first && k > 0) check_contact_edge(pass, side, contact, true);
    if (e.gap > high) pass.add(FindingKind::foot_float, foot, k, e.gap, high, e.gap);
    if (e.lowest > high && (k < first || k > last)) continue;
    raise_to(pass.summary.max_foot_slip, e.slip);
    if (e.slip > far) pass.add(FindingKind::foot_slip, foot, k, e.slip, far, e.slip);
  }
}

void check_depth(CheckPass& pass, int foot) {
  const double deep = pass.tolerance(FindingKind::foot_penetration);
  for (int k = 0; k < pass.count(); ++k) {
    const double depth = pass.soles[foot][k].penetration;
    raise_to(pass.summary.max_foot_penetration, depth);
    if (depth > deep) pass.add(FindingKind::foot_penetration, foot, k, depth, deep, depth);
  }
}

}  // namespace

void check_feet(CheckPass& pass) {
  for (Side side : {Side::left, Side::right}) {
    const int foot = static_cast<int>(side);
    check_depth(pass, foot);
    const std::vector<ContactInterval>& intervals = pass.plan.intervals[foot];
    for (size_t i = 0; i < intervals.size(); ++i) {
      const ContactInterval& contact = intervals[i];
      if (!contact.contact) continue;
      if (contact.first > 0) check_landing(pass, side, contact);
      check_supporting_foot(pass, side, contact);
      if (i + 1 == intervals.size()) continue;
      check_contact_edge(pass, side, contact, false);
      check_lift(pass, side, contact, intervals[i + 1]);
    }
  }
}

}  // namespace ayumi
