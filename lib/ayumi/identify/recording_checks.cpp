#include "ayumi/identify/recording_checks.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/identify/exchanged_joints.hpp"
#include "ayumi/identify/lost_rows.hpp"

namespace ayumi {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double kDegree = M_PI / 180;

// Range of a command below which its joint stands still [rad, m]. Chosen: a hundred counts of a
// small servo.
constexpr double kMoves = 0.5 * kDegree;

// Share and time [s] by which a recording may be longer than its command, because recorders are
// stopped by hand, and the time by which it may be shorter [s]. Chosen: the longest delay of a
// servo; a recording that is shorter has lost rows or its end.
constexpr double kLengthShare = 0.02, kLengthTime = 0.25, kShorter = 0.05;

// Mean share of the weight on the standing foot in all single supports, below which the load cells
// do not fit this motion. Chosen: cells that are 0.3 s late, or that belong to the other foot, have
// less.
constexpr double kStandingShare = 0.8;

// Squared correlations with the command. Above the first value, slope and sign have a meaning;
// below the second value, the joint does not follow. Chosen: a straight line then explains at least
// 80 %, or less than half, of the variance.
constexpr double kFollows = 0.8, kUnrelated = 0.5;

// Factor by which a joint may move more or less than its command. Chosen: a soft servo in a quick
// motion moves less.
constexpr double kScale = 1.5;

// Mean distance from the command that no zero offset explains [rad]. Chosen: more than a
// tooth of a servo's horn.
constexpr double kAway = 8 * kDegree;

// Number of counts after which a counter of 16 bits begins again. Definition.
constexpr double kCounterRange = 65536;

// Step of the search for a time shift [s], and the factor by which the distance must become smaller
// before a shift is accepted. Chosen: a wrong shift fits many times worse.
constexpr double kShiftStep = 0.01, kShiftGain = 0.25;

// Time that a recording and its command must share, as a part of the shorter one. Chosen: a short
// end without motion fits anywhere.
constexpr double kLeastOverlap = 0.5;

double range(const AngleTable& table, Index dof) {
  return table.theta.col(dof).maxCoeff() - table.theta.col(dof).minCoeff();
}

// The distance between the joints' movements if `measured` is `shift` behind, as a part of these
// movements. Means are subtracted, since zero offsets do not matter here. It is infinite if the two
// have too little time in common.
double distance(const AngleTable& command, const AngleTable& measured,
                const std::vector<Index>& dofs, double shift, double step) {
  const double begin = std::max(0.0, shift),
               end = std::min(measured.duration(), command.duration() + shift);
  if (end - begin < kLeastOverlap * std::min(measured.duration(), command.duration()))
    return HUGE_VAL;
  double total = 0;
  for (const Index j : dofs) {
    double m = 0, c = 0, mm = 0, cc = 0, mc = 0, n = 0;
    for (double t = begin; t <= end; t += step) {
      const double x = angle_at(measured, j, t), y = angle_at(command, j, t - shift);
      m += x, c += y, mm += x * x, cc += y * y, mc += x * y, ++n;
    }
    const double vm = mm - m * m / n, vc = cc - c * c / n, both = mc - m * c / n;
    total += vm + vc > 0 ? (vm + vc - 2 * both) / (vm + vc) : 1;
  }
  return total;
}

struct Relation {
  double slope = 0, square = 0;  // squared correlation
  double away = 0;               // mean distance
};
Relation relation(const AngleTable& command, const AngleTable& measured, Index dof, double shift,
                  double begin, double end) {
  double x = 0, y = 0, xx = 0, yy = 0, xy = 0, away = 0;
  double n = 0;
  for (Index k = 0; k < measured.theta.rows(); ++k) {
    const double at = measured.dt * static_cast<double>(k) - shift;
    if (at < std::max(0.0, begin) || at > std::min(command.duration(), end)) continue;
    ++n;
    const double c = angle_at(command, dof, at);
    const double m = measured.theta(k, dof);
    x += c, y += m, xx += c * c, yy += m * m, xy += c * m, away += m - c;
  }
  n = std::max(1.0, n);
  const double sxx = xx - x * x / n, syy = yy - y * y / n, sxy = xy - x * y / n;
  Relation r;
  r.slope = sxx > 0 ? sxy / sxx : 0;
  r.square = sxx > 0 && syy > 0 ? sxy * sxy / (sxx * syy) : 0;
  r.away = std::abs(away / n);
  return r;
}

}  // namespace

double least_motion() { return kMoves; }

std::vector<Index> moving_joints(const AngleTable& command, const AngleTable& measured) {
  std::vector<Index> dofs;
  for (Index j = 0; j < command.theta.cols(); ++j)
    if (command.has[static_cast<size_t>(j)] && measured.has[static_cast<size_t>(j)] &&
        range(command, j) > kMoves)
      dofs.push_back(j);
  std::stable_sort(dofs.begin(), dofs.end(),
                   [&](Index a, Index b) { return range(command, a) > range(command, b); });
  return dofs;
}

double time_shift(const RobotModel&, const AngleTable& command, const AngleTable& measured,
                  double reach) {
  std::vector<Index> dofs = moving_joints(command, measured);
  if (dofs.size() > 4) dofs.resize(4);
  if (dofs.empty()) return 0;
  double best = 0, least = distance(command, measured, dofs, 0, kShiftStep);
  const auto search = [&](double from, double to, double step, double sampling) {
    for (double shift = from; shift <= to + 1e-9; shift += step) {
      const double d = distance(command, measured, dofs, shift, sampling);
      if (d < least) least = d, best = shift;
    }
  };
  search(-reach, reach, kShiftStep, kShiftStep);
  const double fine = std::max(command.dt, measured.dt);
  least = distance(command, measured, dofs, best, fine);
  search(best - kShiftStep, best + kShiftStep, std::min(0.001, fine), fine);
  return best;
}

namespace {

// The complaint about the sign or the unit of a joint that follows; empty if there is none.
std::string wrong_sign_or_unit(const Relation& r) {
  if (r.square < kFollows) return "";
  const double factor = std::abs(r.slope);
  if (r.slope < 0) return "moves against its command; change the sign of its encoder";
  const std::string times = "moves " + text::brief(factor, 3) + " times as far as its command; ";
  if (std::abs(factor * kDegree - 1) < 0.2 || std::abs(factor / kDegree - 1) < 0.2)
    return times + "one of the two files is in degrees, so give --unit deg";
  if (factor > kScale || factor < 1 / kScale)
    return times +
           "is this the recording of another robot, or are the counts per degree of this joint "
           "wrong?";
  return "";
}

}  // namespace

std::vector<std::string> motion_complaints(const RobotModel& model, const AngleTable& command,
                                           const AngleTable& measured, double shift, double begin,
                                           double end) {
  std::vector<std::string> complaints;
  std::vector<char> exchanged(static_cast<size_t>(model.dof_count()), 0);
  for (const auto& group : exchanged_joints(model, command, measured, shift, shift, begin, end)) {
    complaints.push_back(exchange_words(model, group));
    for (const Index j : group) exchanged[static_cast<size_t>(j)] = 1;
  }
  for (const Index j : moving_joints(command, measured)) {
    if (exchanged[static_cast<size_t>(j)]) continue;
    const Relation r = relation(command, measured, j, shift, begin, end);
    std::string wrong = wrong_sign_or_unit(r);
    if (range(measured, j) <= 0)
      wrong = "stays at " + text::brief(measured.theta(0, j) / kDegree, 4) +
              " deg while its command moves by " + text::brief(range(command, j) / kDegree, 3) +
              " deg";
    else if (wrong.empty() && r.square < kUnrelated)
      wrong = "does not follow its command (correlation " + text::fixed(std::sqrt(r.square), 2) +
              "); is this the recording of another command or of another robot?";
    else if (wrong.empty() && r.away > kAway &&
             std::abs(r.away - kCounterRange * measured.resolution[j]) < kAway)
      wrong =
          "is " + text::brief(r.away / kDegree, 3) +
          " deg (65536 counts) away from its command, because the 16-bit counter of its encoder "
          "has overflowed; add or subtract 65536 counts in these rows, or record again";
    else if (wrong.empty() && r.away > kAway)
      wrong = "is " + text::brief(r.away / kDegree, 3) +
              " deg away from its command on average; is this the recording of another robot?";
    if (!wrong.empty())
      complaints.push_back(model.dofs()[static_cast<size_t>(j)].name + " " + wrong);
  }
  return complaints;
}

void require_answer(const RobotModel& model, const AngleTable& command, const AngleTable& measured,
                    double longest_lag, const std::string& file) {
  const auto complain = [&](const std::string& what) { fail(ErrorCode::bad_file, {file}, what); };
  std::vector<Index> dofs = moving_joints(command, measured);
  if (dofs.empty())
    complain("the command of this recording moves no joint by " + text::brief(kMoves / kDegree) +
             " deg or more; record a motion");
  const double lasts = measured.duration(), asked = command.duration();
  if (lasts - asked > kLengthShare * asked + kLengthTime || asked - lasts > kShorter)
    complain("the recording lasts " + text::fixed(lasts, 3) + " s, but its command lasts " +
             text::fixed(asked, 3) +
             " s. The recording is incomplete, or has another rate (give --rate), or belongs to "
             "another command");
  if (const auto groups = exchanged_joints(model, command, measured, 0, longest_lag, 0, asked);
      !groups.empty())
    complain(exchange_words(model, groups.front()) +
             "; correct the order of the columns or of the encoders");
  for (const Index j : dofs) {
    const std::string wrong =
        wrong_sign_or_unit(relation(command, measured, j, 0, 0, command.duration()));
    if (!wrong.empty()) complain(model.dofs()[static_cast<size_t>(j)].name + " " + wrong);
  }
  const double reach = std::min(5.0, 0.3 * asked);
  const double shift = time_shift(model, command, measured, reach);
  // Some recorders number their rows in such a way that the recording is one row ahead of its
  // command. Two rows are therefore accepted.
  if (shift > longest_lag || shift < -2 * measured.dt) {
    std::vector<Index> few = dofs;
    if (few.size() > 4) few.resize(4);
    double near = distance(command, measured, few, 0, kShiftStep);
    near = std::min(near, distance(command, measured, few, longest_lag, kShiftStep));
    if (distance(command, measured, few, shift, kShiftStep) < kShiftGain * near)
      complain("the angles are " + text::fixed(1000 * std::abs(shift), 0) + " ms " +
               (shift > 0 ? "behind" : "ahead of") + " their command" +
               (shift > 0 ? ", but a servo is at most " + text::fixed(1000 * longest_lag, 0) +
                                " ms behind its command"
                          : "") +
               ". The recording is shifted in time; let the recording and the command begin at the "
               "same time");
  }
  const double behind = std::clamp(shift, 0.0, longest_lag);
  if (const LostRows lost = lost_rows(command, measured, dofs, behind); lost.found)
    complain(lost_rows_words(lost, measured));
  // If rows are missing where nothing moves, this is only seen at the end.
  const double least = std::abs(measured.dt - command.dt) < 1e-9
                           ? 0.5 * command.dt
                           : 1.5 * std::max(measured.dt, command.dt);
  if (!measured.timed && asked - lasts > least) {
    const long missing = std::max(1L, std::lround((asked - lasts) / measured.dt));
    complain("the recording has " + std::to_string(measured.theta.rows()) + " rows, one every " +
             text::brief(1000 * measured.dt) + " ms, so it lasts " + text::fixed(lasts, 3) +
             " s, but its command lasts " + text::fixed(asked, 3) + " s. So " +
             text::counted(missing, "row") + (missing == 1 ? " is" : " are") +
             " missing, in a pause or at the end, because the moving parts of the recording are "
             "complete. Record again, or give the rows a time column");
  }
  const std::vector<std::string> wrong =
      motion_complaints(model, command, measured, behind, 0, command.duration());
  if (!wrong.empty()) complain(wrong.front());
}

void require_loads(const SensorTable& loads, const AngleTable& measured, double agreement,
                   const std::string& file) {
  if (loads.foot_load.rows() == 0) return;
  if (const std::string wrong = loads_rows_complaint(loads, measured);
      !wrong.empty() && std::abs(loads.dt * static_cast<double>(loads.foot_load.rows() - 1) -
                                 measured.duration()) <= kLengthTime)
    fail(ErrorCode::bad_file, {file}, wrong);
  const double lasts = loads.dt * static_cast<double>(loads.foot_load.rows() - 1);
  if (std::abs(lasts - measured.duration()) > kLengthTime)
    fail(ErrorCode::bad_file, {file},
         "the recording lasts " + text::fixed(lasts, 3) + " s, but the measured angles last " +
             text::fixed(measured.duration(), 3) +
             " s. The file of the load cells is incomplete, or has another rate (give --rate), or "
             "belongs to another recording");
  if (agreement < kStandingShare)
    fail(ErrorCode::bad_file, {file},
         "while one foot stands, its load cells carry only " + text::fixed(100 * agreement, 0) +
             " % of the weight, but at least " + text::fixed(100 * kStandingShare, 0) +
             " % are expected. The readings of the load cells are shifted in time or belong to "
             "another recording, or left and right are exchanged");
}

}  // namespace ayumi
