#pragma once
// Every tuning parameter of the repair, in one place: value, unit, reason, source, and the test
// that would notice if it moved. Sources: "Derived" follows from another figure, "Measured" rests
// on a trial, "Chosen" is a judgement; what happens at half and at twice a value is given where a
// trial showed it. "Test: none" means that no assertion is known to depend on the value; the
// numbers of repaired patterns then change without a test that fails. Tests are named suite.case of
// tests/repair, unless another folder is given.
//
// Times suit a robot of HOAP-1's height (omega = sqrt(g / z) of about 6 1/s, so 0.5 s is 3/omega);
// they do not scale with the robot yet.

#include <cstddef>

namespace ayumi::repair_policy {

// ---- how the correction can move

namespace knots {
/// Distance of the spline's knots [s]. Chosen: corrections of a step (0.7 s) have 14 of them. Half
/// of it is what a program without a solution gets; a slip within 0.12 s needs it (Measured).
/// Half: early, change 0.0359 to 0.00502; twice: knee, missing safety 0 to 0.00195. Test: none.
inline constexpr double kSpacing = 0.05;
/// Knots in the shortest flight, at least. Chosen: the flight's parabola has to be followed. Half:
/// flight, missing safety 0.00462 to 0; twice: 0. Test: JumpRepair.* (that the repair succeeds).
inline constexpr double kInFlight = 8;
/// Knots in the shortest flight when a flight is at fault, at least. Reason: the violation lasts
/// only as long as the flight. Chosen. Half: flight, missing safety 0.00462 to 0; twice: 2.84e-05.
/// Test: JumpRepair.* (that the repair succeeds).
inline constexpr double kInFaultyFlight = 20;
/// Knots in a window in which a foot slips. Reason: a sole in its place asks for a correction equal
/// to the whole slip. Measured: with coarser knots, legs that give way cost 80 times the change on
/// one walk that turns. Half: slip, missing safety 0 to 0.577; twice: 0.0101. Test: none.
inline constexpr double kInSlip = 10;
/// Samples between two knots that are not halved any more. Chosen: finer knots follow the rounding
/// of differences. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kFewestSamples = 8;
/// Times that the spacing is halved, at most. Chosen: a quarter of the spacing has four times the
/// variables. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr int kMostHalvings = 2;
}  // namespace knots

namespace change_weight {
/// tau: time scale below which a correction's acceleration costs more than its value [s]. Chosen:
/// two knots. Half: knee, change 0.0965 to 0.00935; twice: cog, trusted, missing safety 1.59e-08 to
/// 0.103. Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kSmoothTime = 0.1;
/// Cost of moving the base, against joints of weight 1 [1/m^2]. Reason: one radian of a joint moves
/// the robot by about half the length of a leg. Half: sway, change 0.0501 to 0.0345; twice: 0.0659.
/// Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kBasePosition = 1000.0;
/// Cost of turning the base, against joints of weight 1. Chosen: turning the whole trunk is worth
/// more than turning one joint. Half: sway, missing safety 0.296 to 0.339; twice: cog, trusted,
/// change 0.0463 to 0.05. Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kBaseRotation = 4.0;
/// The program's objective is this times half the weighted change. Chosen: a usual repair then
/// costs about 1. Half: sway, missing safety 0.296 to 0.592; twice: cog, trusted, missing safety
/// 1.59e-08 to 0.0108. Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kObjectiveScale = 100.0;
/// A part of the change below this is rounding [s]. Chosen: above the rounding of a sum over the
/// samples. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kRounding = 1e-15;
}  // namespace change_weight

// ---- where rows are placed

namespace collocation {
/// Collocation points for every knot interval. Derived: the acceleration of a cubic spline has its
/// kinks at the knots, so that its extremes lie there or halfway. Test: none.
inline constexpr int kPerKnot = 2;
/// A limit has rows where the motion, or an earlier result, uses more than this share of it; the
/// check of the result looks at the rest. Chosen: at 0 every limit has its rows. Figures change by
/// less than 5 % from half to twice. Test: none (PlacedRows.* set it to 0).
inline constexpr double kWatchedShare = 0.7;
/// The normal force has rows where the motion presses with less than this share of the weight.
/// Chosen. Figures change by less than 5 % from half to twice. Test: none.
inline constexpr double kLightShare = 0.5;
/// Points that an error adds in one window, at most. Chosen: a window of many samples then has one
/// in every few. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr int kMostPerError = 12;
/// A row with less room than this (share of its limit, or rad) is active, and rows of the same
/// limit are put beside it. Chosen. No measured case changes from half to twice (constants.md).
/// Test: none.
inline constexpr double kActive = 1e-3;
/// The same for friction, a share of the friction available. Reason: the cone curves. Half: grip,
/// iterations 95 to 107; twice: less than 5 %. Test: none.
inline constexpr double kActiveFriction = 0.05;
/// Points of that kind from one collocation point to the next. Chosen. Half: knee, iterations 62 to
/// 73; twice: grip, iterations 95 to 108. Test: none.
inline constexpr int kBesideActive = 4;
}  // namespace collocation

// ---- how far inside the check's limits the rounds keep, so that what happens between two
// collocation points passes the check as well

/// Distances from the check's limits.
struct Backoff {
  double joint_position;  ///< inside the soft limits of a joint [rad]
  double limit_share;     ///< of speed, torque, friction and torsional friction that may be used
  double friction_cone;   ///< a further factor on friction
  double zmp;             ///< inside the edges of the support, beyond the check's margin [m]
};
/// The first round. Chosen: a spline between two points 25 ms apart leaves a limit by less than
/// this for most faults; the next round mends the rest. joint_position: no measured case changes
/// from half to twice (constants.md). limit_share, friction_cone, zmp: figures change by less than
/// 5 % from half to twice. Test: Repair.NothingNearbyIsCheaper (zmp: it keeps 2.5 mm);
/// PlacedRows.NumbersAreThoseOfTheCheck (shares).
inline constexpr Backoff kFirstBackoff = {1e-4, 0.998, 0.98, 5e-4};
/// What every further round adds to it. Chosen, as above. joint_position, friction_cone: no
/// measured case changes from half to twice (constants.md). limit_share, zmp: figures change by
/// less than 5 % from half to twice. Test: none.
inline constexpr Backoff kBackoffStep = {5e-4, 0.004, 0, 0.001};
/// What the last program keeps from the check's own limits, a share of the limit. Derived: above
/// the rounding of a table's nine decimals. Test: LeastChange.* (to 2e-5).
inline constexpr double kRounding = 1e-6;

// ---- what the rows keep

namespace zmp {
/// Margin that a repaired ZMP is wanted to have, of the largest circle's radius about the centre of
/// the smaller sole. Reason: a walk played open loop then stands although its servos sag. Chosen:
/// 28 mm of HOAP-1. Half: sway, ZMP margin 28.7 to 13.7 mm; twice: missing safety 0.296 to 0.641.
/// Test: Repair.Hoap1KneesInEveryStep (min_zmp_margin above 20 mm).
inline constexpr double kSafeShare = 0.9;
/// Time around a margin that is too small in which the safe margin is wanted [s]. Reason: a step
/// that begins unsafe is not safe when only its end is. Chosen: 3/omega. No measured case changes
/// from half to twice (constants.md). Test: none.
inline constexpr double kSafeAround = 0.5;
/// Share of its own margin that a motion keeps elsewhere. Chosen. Half: early, ZMP margin 25.2 to
/// 12.6 mm; twice: knee, ZMP margin 21.9 to 28.4 mm. Test: none.
inline constexpr double kOwnShare = 0.8;
/// Least margin inside the support when nothing else is asked for [m]. Derived: the check's
/// default tolerance. Test: none (the setup replaces it).
inline constexpr double kLeastMargin = 0.002;
}  // namespace zmp

/// Least normal force in contact, over the weight. Chosen: five times the contact threshold, so
/// that the ZMP keeps its meaning between two points. No measured case changes from half to twice
/// (constants.md). Test: none.
inline constexpr double kLeastNormalForce = 0.1;

/// Size, over the weight, at which the tangential force in the friction row is rounded, for its
/// slope has no value at 0. Chosen: small against mu. Figures change by less than 5 % from half to
/// twice. Test: PlacedRows.NumbersAreThoseOfTheCheck.
inline constexpr double kFrictionRounding = 1e-4;

namespace stance {
/// Half the band in which a standing sole stays [m]. Measured: two soles in double support that
/// disagree by 0.1 mm move the load from one foot to the other, and a walk repaired more loosely
/// fell open loop. Test: Repair.SlippingFootStandsStill (only below 1 mm).
inline constexpr double kPosition = 2e-4;
/// The same as an angle [rad]. Derived: 0.2 mm at 0.1 m. Test: none.
inline constexpr double kAngle = 2e-3;
/// Share of that band at the knots. Reason: the spline passes there and swings between. Measured
/// with the band. Half: sway, missing safety 0.296 to 0.167; twice: early, change 0.0359 to 0.0231.
/// Test: none.
inline constexpr double kShareAtKnots = 0.1;
/// Share of the check's tolerances (slip, penetration, lift-off) that the band may have. Chosen.
/// Half: early, change 0.0359 to 0.0646; twice: 0.00515. Test: none.
inline constexpr double kToleranceShare = 0.2;
/// Share of the check's tolerance that a corner may rise or sink as the sole turns. Chosen.
/// Half: sway, missing safety 0.296 to 0.186; twice: no change. Test: none.
inline constexpr double kCornerShare = 0.6;
/// Time after landing and before lift-off in which a sole may be off its place as the motion has
/// it [s]. Reason: a foot that lands softly is not quite in its place yet. Chosen. Half: early,
/// change 0.0359 to 0.00589; twice: less than 5 %. Test: none.
inline constexpr double kSoftTime = 0.05;
/// Share of what the check allows that the motion's own deviation may have then. Chosen. Figures
/// change by less than 5 % from half to twice. Test: none.
inline constexpr double kSoftShare = 0.6;
/// Share of the band upwards then. Reason: a swing must not run on between two points. Half: early,
/// change 0.0359 to 0.057; twice: 0.00761. Test: none.
inline constexpr double kSoftUpwards = 0.4;
/// Half the band in which a locked foot stays on its path [m], [rad]. Derived: the documented
/// 0.01 mm. Test: Faults.LockedFootKeepsItsWayAndWeightsSteer.
inline constexpr double kLockedFoot = 1e-5;
/// Half the band of a locked posture in the program [m], [rad]; kept_at() makes it exact. Derived:
/// the tolerance of the constraints. Test:
/// Faults.LockedInstantKeepsItsPoseAndLetsTheMotionThroughItMove.
inline constexpr double kLockedPose = 1e-7;
}  // namespace stance

namespace swing {
/// Time before landing and after lift-off in which a low sole is wanted over its place [s].
/// Measured: servos that sag by a millimetre touch down 50 ms early. Chosen: three times that.
/// Half: early, foot moved by 17.1 to 11.7 mm; twice: change 0.0359 to 0.0387. Test:
/// Landing.EarlyContactComesDownOnItsPlace.
inline constexpr double kNearPlace = 0.15;
/// Offset from its place that a low sole may always have [m]. Chosen: the band of a standing sole.
/// Figures change by less than 5 % from half to twice. Test: Landing.ASoundWalkMeetsItsRows.
inline constexpr double kPlaceSlack = 2e-4;
/// Height that says how far off a sole may be: offset <= kPlaceSlack + height^2 / (this times the
/// COG's height), at least. Chosen. Figures change by less than 5 % from half to twice. Test: none.
inline constexpr double kLeastLandingHeight = 0.12;
/// Factor on the median offset / height^2 of the motion's own swings; the median ignores a faulty
/// swing. Chosen. Half: early, change 0.0359 to 0.0416; twice: foot moved by 17.1 to 12.4 mm. Test:
/// Landing.ASoundWalkMeetsItsRows.
inline constexpr double kOwnLandingFactor = 1.5;
/// A sole below this height is left out of that median [m]. Reason: the quotient of two small
/// numbers says little. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kLowestMeasured = 0.001;
/// Period at which the motion's swings are measured for landings, and for heights [s]. Chosen.
/// kLandingPeriod: figures change by less than 5 % from half to twice. kHeightPeriod: no measured
/// case changes from half to twice (constants.md). Test: none.
inline constexpr double kLandingPeriod = 0.005, kHeightPeriod = 0.01;
/// Height wanted in the middle half of a swing, of the median height of the motion's own swings.
/// Measured: brought back to the ground alone, three of three thrown knees scraped and fell.
/// Test: Landing.AThrownKneePassesOverTheGround.
inline constexpr double kHeightShare = 0.5;
/// A swinging sole higher than this has no rows against the ground [m]. Chosen. Figures change by
/// less than 5 % from half to twice. Test: none.
inline constexpr double kWatchedHeight = 0.004;
}  // namespace swing

namespace dcm {
/// The DCM is held to its plan where the posture has it off by more than this share of the COG's
/// height, times kWatchedShare. Derived: 1 % is 0.06 of the capture bound B, the step of a push
/// study. Test: ThrownKnee.LeavesTheCaptureBoundsAsTheyWerePlanned.
inline constexpr double kOff = 0.014;
/// Time around that in which it is held [s]. Chosen: 3/omega. Figures change by less than 5 % from
/// half to twice. Test: none.
inline constexpr double kAround = 0.5;
/// Half the band of the DCM [m]. Chosen: an eighth of what a push study can tell. Half: planned
/// sway, missing safety 0.485 to 0.637; twice: 0.447. Test:
/// ThrownKnee.LeavesTheCaptureBoundsAsTheyWerePlanned.
inline constexpr double kSlack = 3e-4;
/// Half the band of the ZMP where the DCM is held [m]. Chosen. Half: planned sway, missing safety
/// 0.485 to 0.288; twice: 0.747. Test: ThrownKnee.RepairedWithstandsThePushesOfItsPlan.
inline constexpr double kZmpSlack = 1e-3;
/// Time around an error of the commanded COG or ZMP in which the plan is no goal [s]. Chosen:
/// 2/omega. No measured case changes from half to twice (constants.md). Test:
/// ThrownKnee.FollowsNoPlanThatIsItselfAtFault.
inline constexpr double kWrongPlanAround = 0.3;
}  // namespace dcm

namespace flight {
/// What the motion does by itself in flight stays, up to this share of the check's limit; beyond it
/// nothing of it does. Chosen. Half: flight, missing safety 0.00462 to 0.0067; twice: 0.0143. Test:
/// JumpRepair.* (that the repair succeeds).
inline constexpr double kOwnShare = 0.85;
/// Half the band, of the check's limit, shared among three axes. Chosen. Half: flight, missing
/// safety 0.00462 to 0.0317; twice: flight is infeasible. Test: none.
inline constexpr double kBand = 0.5;
}  // namespace flight

/// One band of distances between bodies, from the nearest to the farthest.
namespace clearance {
/// Nearer than this, a clearance of the given motion is one that is to be mended [m]. Chosen: a
/// quarter of the check's tolerance. No measured case changes from half to twice (constants.md).
/// Test: none.
inline constexpr double kTouch = 0.0005;
/// Distance that bodies keep, unless the motion itself comes nearer [m]. Chosen. Half: collision,
/// change 0.00251 to 0.00152; twice: 0.00542. Test: none.
inline constexpr double kKept = 2.4e-3;
/// Pairs of bodies nearer than this are watched [m]. Chosen: about twice what they keep. Figures
/// change by less than 5 % from half to twice. Test: none.
inline constexpr double kWatchedBodies = 0.005;
/// Shapes of such a pair nearer than this are watched [m]. Reason: when the nearest ones part, the
/// next ones are not far. Chosen: twice as far. No measured case changes from half to twice
/// (constants.md). Test: none.
inline constexpr double kWatchedShapes = 0.010;
/// What a row of edges may be less than the rows of corners beside it [m]: where both say the same,
/// the corners alone hold. Chosen. Figures change by less than 5 % from half to twice. Test: none.
inline constexpr double kEdgeAllowance = 1e-4;
/// An edge is nearer than all corners when it is so by more than this [m]. Chosen: above the
/// accuracy of nearest points. No measured case changes from half to twice (constants.md). Test:
/// ClearanceRows.EdgesAreARowWhereNoCornerIsNearer.
inline constexpr double kSameDistance = 1e-6;
}  // namespace clearance

/// Share of the check's tolerance that a trusted COG or ZMP may be off. Chosen. Half: cog, trusted,
/// change 0.0463 to 0.0643; twice: 0.023. Test: Faults.CogKeyMovedAndTrusted and
/// Faults.ZmpMovedAndTrusted (that the check passes).
inline constexpr double kTrustedShare = 0.25;

// ---- prices, in one unit: of the objective (kObjectiveScale / 2 of the weighted change) for each
// `unit` of violation that the worst row of one limit has within a window of time

namespace prices {
/// Of a soft goal. Measured (support): at a tenth, walks at 0.65 of their time fall open loop; at
/// three times, their repair takes twice the iterations and stands no better. Chosen (the others):
/// a foot off its place weighs more than the ZMP, the DCM lies between. kZmpMargin, kLanding:
/// figures change by less than 5 % from half to twice. kDcm: half: planned sway, missing safety
/// 0.485 to 0.263; twice: less than 5 %.
inline constexpr double kZmpMargin = 0.1, kLanding = 1, kDcm = 0.3;
/// Of a limit in the relaxed program. Reason: above any multiplier seen, so that a limit is
/// violated only where it must be; a repair costs about 1. Half: sway, missing safety 0.296 to
/// 0.148; twice: 0.592. Test: none.
inline constexpr double kLimit = 100;
/// Of feet in contact and of flight in the relaxed program: the last to be violated. Chosen: a
/// hundred times a limit. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kFoot = 100 * kLimit;

/// Windows of time in which the rows of one limit share a slack variable [s]: of soft goals and of
/// limits. Chosen: a knot, and two. kSoftGoalWindow: half: planned sway, missing safety 0.485 to
/// 0.361; twice: 0.361. kLimitWindow: half: sway, missing safety 0.296 to 0.458; twice: 0.181.
/// Test: none.
inline constexpr double kSoftGoalWindow = 0.05, kLimitWindow = 0.1;

/// What is as bad as a millimetre: 1 mm, 0.01 rad, or a hundredth of a limit. Chosen: 0.01 rad
/// moves the end of a limb of 0.1 m by a millimetre. kLength: half: sway, missing safety 0.296 to
/// 0.592; twice: planned sway, missing safety 0.485 to 0.14. kAngle, kShare: no measured case
/// changes from half to twice (constants.md).
inline constexpr double kLength = 1e-3, kAngle = 0.01, kShare = 0.01;

/// Violation, in `unit`s, that counts as none. Derived: the solver's tolerance. Test: none.
inline constexpr double kMet = 1e-6;
}  // namespace prices

// ---- the rounds

namespace rounds {
/// Rounds, at most. Measured: walks at half their time end repaired within them. Test: none.
inline constexpr int kMost = 8;
/// Rounds without a solution, at most. Chosen: wider windows, finer knots, then without soft goals.
/// No measured case changes from half to twice (constants.md). Test: none.
inline constexpr int kMostUnsolved = 3;
/// Free time around a finding [s]; doubled where it is not enough. Reason: the COG forgets a
/// correction as exp(-omega t), to 5 % after 3/omega. Half: early, iterations 31 to 46; twice: less
/// than 5 %. Test: Repair.ZmpComesInsideAndNothingChangesTwice (nothing moves 0.8 s away).
inline constexpr double kFreeAround = 0.5;
/// A result with less violation than this is the start of the next round though it was not solved,
/// and a start with less is a warm start (scaled violation). Chosen. No measured case changes from
/// half to twice (constants.md). Test: none.
inline constexpr double kNearlyMet = 1e-3;
/// The same where the multipliers of the last program are known. Measured: the second program on
/// slippery ground, which starts with 2.6e-3, takes 5 iterations in place of 11. Test: none.
inline constexpr double kNearKnown = 1e-2;
/// Scaled violation of a solved program. Derived: ten times the solver's tolerance. Test: Repair.*
/// (constraint_violation).
inline constexpr double kMet = 1e-6;
/// Iterations of the first program, at most. Reason: finer knots may do better than more of them.
/// Measured: a thrown knee changed nothing in the last 60 of 100. No measured case changes from
/// half to twice (constants.md). Test: none.
inline constexpr int kBeforeFinerKnots = 50;
/// Tolerance of optimality: the least change is looked for at the end. Chosen. Figures change by
/// less than 5 % from half to twice. Test: none.
inline constexpr double kTolerance = 1e-3;
/// Work of all programs of a repair (NlpSolution::work) for each second of the motion, at most.
/// Measured: 1.3e-8 s of processor time for each, so that the programs end within 2 s for each
/// second of motion; checks and what is said of a failure come on top. Test:
/// Repair.EndsWithinItsWork.
inline constexpr double kMostWork = 1.5e8;
/// Shorter motions may take the work of one so long [s]. Reason: the search for the reasons of a
/// failure does not become shorter with the motion. Chosen: 10 s of processor time. Test:
/// CheckRepair.TheParameterThatWouldDoIsNamed.
inline constexpr double kShortestForWork = 5;
/// Share of it that is left for the search for the reasons. Chosen: that search has fewer
/// iterations than two rounds. Test: none.
inline constexpr double kWorkForReasons = 0.15;
/// Iterations of each program, at most, unless options say otherwise. Chosen. No measured case
/// changes from half to twice (constants.md). Test: none.
inline constexpr int kMostIterations = 100;
}  // namespace rounds

namespace tighten {
/// Programs at the check's own limits, at most. Chosen. Half: grip, iterations 95 to 57; twice: no
/// change. Test: none.
inline constexpr int kMostRounds = 4;
/// Tolerance of optimality over what the change costs, and its bounds. Measured: with a fixed one
/// the barrier of a thousand rows outweighed a change of half a thousandth. It holds for
/// complementarity alone (NlpOptions::tolerance). Test: LeastChange.*.
inline constexpr double kTolerance = 1e-7, kLeastTolerance = 1e-9, kMostTolerance = 1e-6;
/// Share of the way back to the passing motion at which the next program starts. Chosen. Figures
/// change by less than 5 % from half to twice. Test: none.
inline constexpr double kStartBack = 0.1;
/// Share of that way that is gone back instead of solving once more: the first and the most, each
/// ten times the last. Chosen: going back a thousandth of the way changes the weighted change by at
/// most a thousandth of the difference between the two motions, because it is convex. It saves a
/// program of ten iterations (friction 0.10 on a walk of 4.3 s). Test: LeastChange.* (what is gone
/// back costs more than least).
inline constexpr double kFirstBack = 1e-6, kMostBack = 1e-3, kBackFactor = 10;
/// ZMP margin without robustness, inside the edge [m]. Derived: kRounding of 1 mm. Test: none.
inline constexpr double kZmpMargin = kRounding * 1e-3;
}  // namespace tighten

// ---- the solver

namespace solver {
/// Barrier that a program starts with, and a warm start's: a larger one would push it away from a
/// motion that violates little. Measured: 20 iterations in place of 36. Test: none.
inline constexpr double kStartBarrier = 1e-3, kWarmBarrier = 1e-5;
/// Barrier of a start with multipliers after a program that was solved to a smaller one. Chosen:
/// above it, what the last program has found out is lost; below it, steps to new rows are short.
/// Test: none.
inline constexpr double kKnownBarrier = 1e-8;
/// Distance from its bounds to which a start is pushed, and a warm start. Measured with the
/// barrier. Test: none.
inline constexpr double kStartPush = 1e-2, kWarmPush = 1e-6;
/// Tolerances of optimality and of the constraints (unscaled). Chosen: a tenth of a micrometre.
/// No measured case changes from half to twice (constants.md). Test: Nlp.NearestPointOfADisc.
inline constexpr double kTolerance = 1e-6, kConstraintTolerance = 1e-7;
/// The barrier falls by this factor, or to this power of itself. Chosen: faster than Ipopt's 0.2
/// and 1.5, because Newton's steps follow. kBarrierFactor: no measured case changes from half to
/// twice (constants.md). kBarrierPower: half: grip, iterations 95 to 155; twice: 155. Test: none.
inline constexpr double kBarrierFactor = 0.05, kBarrierPower = 1.8;
/// Slack variables start with this much more than the start needs, in their units, where no barrier
/// says how much. Chosen. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kSlackStart = 0.01;
/// Slack variables with an upper bound start below this share of it. Reason: the middle is farthest
/// from both bounds. Figures change by less than 5 % from half to twice. Test: none.
inline constexpr double kSlackShare = 0.5;
/// Steps of the differences by which the load of two feet is derived: of the base [m], of the
/// ground wrench [N], [N m]. Derived: the cube root of the rounding. Test:
/// PlacedRows.DerivativesAgainstCentralDifferences.
inline constexpr double kBaseStep = 1e-6, kWrenchStep = 1e-5;
}  // namespace solver

// ---- the initial guess

namespace guess {
/// Violation of soles and clearances beyond which the program starts elsewhere [m], [rad].
/// Measured: a hip thrown up by a radian took 232 iterations from no correction, 20 from a guess.
/// Test: none.
inline constexpr double kFarOff = 0.01;
/// Times before and after an error between which its joints are led straight over [s]. Chosen: from
/// a knot to a step. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kReaches[] = {0.02, 0.06, 0.12, 0.2, 0.3, 0.4, 0.6, 0.8};
}  // namespace guess

// ---- what stands in the way

namespace infeasible {
/// Iterations of the relaxed program, at most. Chosen: what stands in the way shows long before the
/// optimum. No measured case changes from half to twice (constants.md). Test: none.
inline constexpr int kMostIterations = 60;
/// Reasons in words, at most. Chosen. No measured case changes from half to twice (constants.md).
/// Test: none.
inline constexpr size_t kMostReasons = 6;
/// A window that would need more time than this factor is not called too short. Chosen. No measured
/// case changes from half to twice (constants.md). Test: cli
/// Infeasible.AWindowFarTooShortIsStillAMatterOfTime.
inline constexpr double kSlowest = 8;
/// Precision of that factor. Derived: it is written with one decimal. Test: none.
inline constexpr double kFactorStep = 0.01;
/// Samples around a window that are judged with it. Derived: differences reach over two. Test:
/// none.
inline constexpr long kSamplesAround = 2;
/// Severities of different units side by side: what counts as much as a limit exceeded by its
/// whole. Chosen: 1 cm, 10 N, 0.1 of any other unit. No measured case changes from half to twice
/// (constants.md). Test: none.
inline constexpr double kLength = 0.01, kForce = 10, kOther = 0.1;
}  // namespace infeasible

// ---- what is reported and written

namespace report {
/// A joint that moves less has not moved [rad]. Chosen: far below a servo count (8e-5 rad of
/// HOAP-1). No measured case changes from half to twice (constants.md). Test: none.
inline constexpr double kMoved = 1e-6;
/// The time of a change is where it is above this share of its largest value. Chosen. No measured
/// case changes from half to twice (constants.md). Test:
/// MotionChange.NamesJointsTimesAndQuantities.
inline constexpr double kChangeShare = 0.1;
/// Decimals of a control point in a file, as a factor. Derived: kRounding has six. Test: none.
inline constexpr double kWritten = 1e9;
}  // namespace report

}  // namespace ayumi::repair_policy
