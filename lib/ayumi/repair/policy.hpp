#pragma once
// Every tuning parameter of the repair, in one place: value, unit, reason, source, and the test
// that would fail if it changed. Sources: a "Derived" value follows from another figure, a
// "Measured" value comes from a trial, and a "Chosen" value is a judgement. If a trial showed the
// effects of half and twice a value, these are stated. In them, "missing safety" is the robustness
// part of the cost (WeightedChange::safety). "Test: none" means that no assertion is known to
// depend on the value; then the numbers of repaired patterns can change while no test fails. Tests
// are named suite.case of tests/repair, unless another folder is given.
//
// Times suit a robot of HOAP-1's height (omega = sqrt(g / z) of about 6 1/s, so 0.5 s is 3/omega);
// they do not scale with the robot yet.

#include <cstddef>

namespace ayumi::repair_policy {

// ---- how the correction can move

namespace knots {
/// Distance of the spline's knots [s]. Chosen: the correction of a step (0.7 s) has 14 knots. After
/// a program without a solution, half of this distance is used; a slip within 0.12 s needs it
/// (Measured). With half of the value, the change of the case "early" changes from 0.0359 to
/// 0.00502; with twice, the missing safety of the case "knee" changes from 0 to 0.00195. Test:
/// none.
inline constexpr double kSpacing = 0.05;
/// Smallest number of knots in the shortest flight. Chosen: the flight's parabola has to be
/// followed. With half of the value, the missing safety of the case "flight" changes from 0.00462
/// to 0; with twice, to 0. Test: JumpRepair.* (that the repair succeeds).
inline constexpr double kInFlight = 8;
/// Smallest number of knots in the shortest flight if a flight is at fault. Reason: the violation
/// lasts only as long as the flight. Chosen. With half of the value, the missing safety of the case
/// "flight" changes from 0.00462 to 0; with twice, to 2.84e-05. Test: JumpRepair.* (that the repair
/// succeeds).
inline constexpr double kInFaultyFlight = 20;
/// Number of knots in a window in which a foot slips. Reason: to keep a sole in its place, the
/// correction must equal the whole slip. Measured: with coarser knots, the legs gave way, and the
/// change of one turning walk was 80 times as large. With half of the value, the missing safety of
/// the case "slip" changes from 0 to 0.577; with twice, to 0.0101. Test: none.
inline constexpr double kInSlip = 10;
/// Number of samples between two knots at which the spacing is no longer halved. Chosen: finer
/// knots follow the rounding of differences. No measured case changes between half and twice the
/// value (constants.md). Test: none.
inline constexpr double kFewestSamples = 8;
/// Largest number of times that the spacing is halved. Chosen: a quarter of the spacing has four
/// times the variables. No measured case changes between half and twice the value (constants.md).
/// Test: none.
inline constexpr int kMostHalvings = 2;
}  // namespace knots

namespace change_weight {
/// tau: time scale below which a correction's acceleration costs more than its value [s]. Chosen:
/// two knots. With half of the value, the change of the case "knee" changes from 0.0965 to 0.00935;
/// with twice, the missing safety of the case "cog, trusted" changes from 1.59e-08 to 0.103. Test:
/// CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kSmoothTime = 0.1;
/// Cost of moving the base, relative to joints of weight 1 [1/m^2]. Reason: one radian of a joint
/// moves the robot by about half the length of a leg. With half of the value, the change of the
/// case "sway" changes from 0.0501 to 0.0345; with twice, to 0.0659. Test:
/// CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kBasePosition = 1000.0;
/// Cost of turning the base, relative to joints of weight 1. Chosen: turning the whole trunk costs
/// more than turning one joint. With half of the value, the missing safety of the case "sway"
/// changes from 0.296 to 0.339; with twice, the change of the case "cog, trusted" changes from
/// 0.0463 to 0.05. Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kBaseRotation = 4.0;
/// The program's objective is this factor times half the weighted change. Chosen: a usual repair
/// then costs about 1. With half of the value, the missing safety of the case "sway" changes from
/// 0.296 to 0.592; with twice, the missing safety of the case "cog, trusted" changes from 1.59e-08
/// to 0.0108. Test: CorrectionProblem.ObjectiveIsTheIntegral.
inline constexpr double kObjectiveScale = 100.0;
/// A part of the change that is smaller than this is rounding [s]. Chosen: above the rounding of a
/// sum over the samples. No measured case changes between half and twice the value (constants.md).
/// Test: none.
inline constexpr double kRounding = 1e-15;
}  // namespace change_weight

// ---- where rows are placed

namespace collocation {
/// Number of collocation points for every knot interval. Derived: the acceleration of a cubic
/// spline has its kinks at the knots, so that its extremes lie there or halfway. Test: none.
inline constexpr int kPerKnot = 2;
/// A limit has rows where the motion, or an earlier result, uses more than this share of it; the
/// check of the result tests the other limits. Chosen: at 0 every limit has its rows. Between half
/// and twice the value, figures change by less than 5 %. Test: none (ConstraintRows.* set it to 0).
inline constexpr double kWatchedShare = 0.7;
/// The normal force has rows where the motion presses with less than this share of the weight.
/// Chosen. Between half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kLightShare = 0.5;
/// Largest number of points that an error adds in one window. Chosen: in a window with many
/// samples, some of the samples are enough. No measured case changes between half and twice the
/// value (constants.md). Test: none.
inline constexpr int kMostPerError = 12;
/// A row is active if its distance from its limit is smaller than this (as a share of the limit, or
/// in rad). Further rows of the same limit are then placed beside it. Chosen. No measured case
/// changes between half and twice the value (constants.md). Test: none.
inline constexpr double kActive = 1e-3;
/// Value of kActive for rows of friction, as a share of the available friction. Reason: the cone
/// curves. With half of the value, the number of iterations of the case "grip" changes from 95 to
/// 107; with twice, figures change by less than 5 %. Test: none.
inline constexpr double kActiveFriction = 0.05;
/// Number of such points from one collocation point to the next. Chosen. With half of the value,
/// the number of iterations of the case "knee" changes from 62 to 73; with twice, the number of
/// iterations of the case "grip" changes from 95 to 108. Test: none.
inline constexpr int kBesideActive = 4;
}  // namespace collocation

// ---- distances from the check's limits in the rounds, so that the motion between two collocation
// points also passes the check

/// Distances from the check's limits.
struct Backoff {
  double joint_position;  ///< distance inside the soft limits of a joint [rad]
  double limit_share;  ///< share of speed, torque, friction and torsional friction that may be used
  double friction_cone;  ///< a further factor on friction
  double zmp;  ///< distance inside the edges of the support, beyond the check's margin [m]
};
/// The distances in the first round. Chosen: between two points 25 ms apart, a spline exceeds a
/// limit by less than this for most faults; the next round corrects the rest. joint_position: no
/// measured case changes between half and twice the value (constants.md). limit_share,
/// friction_cone, zmp: between half and twice the value, figures change by less than 5 %. Test:
/// Repair.NothingNearbyIsCheaper (zmp: it keeps 2.5 mm); ConstraintRows.NumbersAreThoseOfTheCheck
/// (shares).
inline constexpr Backoff kFirstBackoff = {1e-4, 0.998, 0.98, 5e-4};
/// The distances that every further round adds. Chosen, as above. joint_position, friction_cone: no
/// measured case changes between half and twice the value (constants.md). limit_share, zmp: between
/// half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr Backoff kBackoffStep = {5e-4, 0.004, 0, 0.001};
/// Largest speed of a joint that rests at a limit [rad/s]. Chosen: far below the speed of any
/// motion, above the rounding of a table with four decimals and rows 1 ms apart. Test:
/// RestingJoints.*.
inline constexpr double kRestingSpeed = 0.05;
/// Distance that the last program keeps from the check's own limits, as a share of the limit.
/// Derived: above the rounding of a table's nine decimals. Test: LeastChange.* (to 2e-5).
inline constexpr double kRounding = 1e-6;

// ---- bands and margins of the rows

namespace zmp {
/// Wanted margin of a repaired ZMP, as a share of the radius of the largest circle about the centre
/// of the smaller sole. Reason: after a walk in open loop, the robot then stands although its
/// servos sag. Chosen: 28 mm on HOAP-1. With half of the value, the ZMP margin of the case "sway"
/// changes from 28.7 to 13.7 mm; with twice, the missing safety of the case "sway" changes from
/// 0.296 to 0.641. Test: Repair.Hoap1KneesInEveryStep (min_zmp_margin above 20 mm).
inline constexpr double kSafeShare = 0.9;
/// Time around a margin that is too small in which the safe margin is wanted [s]. Reason: a step
/// that begins with an unsafe margin is not made safe by its end alone. Chosen: 3/omega. No
/// measured case changes between half and twice the value (constants.md). Test: none.
inline constexpr double kSafeAround = 0.5;
/// Share of its own margin that a motion keeps elsewhere. Chosen. With half of the value, the ZMP
/// margin of the case "early" changes from 25.2 to 12.6 mm; with twice, the ZMP margin of the case
/// "knee" changes from 21.9 to 28.4 mm. Test: none.
inline constexpr double kOwnShare = 0.8;
/// Smallest margin inside the support if no other one is requested [m]. Derived: the check's
/// default tolerance. Test: none (the setup replaces it).
inline constexpr double kLeastMargin = 0.002;
}  // namespace zmp

/// Smallest normal force in contact, as a share of the weight. Chosen: five times the contact
/// threshold, so that the ZMP keeps its meaning between two points. No measured case changes
/// between half and twice the value (constants.md). Test: none.
inline constexpr double kLeastNormalForce = 0.1;

/// Size, as a share of the weight, at which the tangential force in the friction row is smoothed,
/// because its slope has no value at 0. Chosen: small against mu. Between half and twice the value,
/// figures change by less than 5 %. Test: ConstraintRows.NumbersAreThoseOfTheCheck.
inline constexpr double kFrictionRounding = 1e-4;

namespace stance {
/// Half the band in which a standing sole stays [m]. Measured: if two soles in double support
/// deviate by 0.1 mm from each other, the load moves from one foot to the other, and a walk with a
/// wider band fell in open loop. Test: Repair.SlippingFootStandsStill (only below 1 mm).
inline constexpr double kPosition = 2e-4;
/// Half the band in which a standing sole keeps its attitude [rad]. Derived: 0.2 mm at 0.1 m. Test:
/// none.
inline constexpr double kAngle = 2e-3;
/// Share of these bands at the knots. Reason: the spline is exact at the knots and deviates between
/// them. Measured with the band. With half of the value, the missing safety of the case "sway"
/// changes from 0.296 to 0.167; with twice, the change of the case "early" changes from 0.0359 to
/// 0.0231. Test: none.
inline constexpr double kShareAtKnots = 0.1;
/// Share of the check's tolerances (slip, penetration, lift-off) that the band may use. Chosen.
/// With half of the value, the change of the case "early" changes from 0.0359 to 0.0646; with
/// twice, to 0.00515. Test: none.
inline constexpr double kToleranceShare = 0.2;
/// Share of the check's tolerance by which a corner may rise or sink as the sole turns. Chosen.
/// With half of the value, the missing safety of the case "sway" changes from 0.296 to 0.186; with
/// twice, nothing changes. Test: none.
inline constexpr double kCornerShare = 0.6;
/// Time after landing and before lift-off in which a sole may keep the deviation from its place
/// that the motion has [s]. Reason: a foot that lands softly is not quite in its place yet. Chosen.
/// With half of the value, the change of the case "early" changes from 0.0359 to 0.00589; with
/// twice, figures change by less than 5 %. Test: none.
inline constexpr double kSoftTime = 0.05;
/// Share of the check's tolerance up to which the deviation of kSoftTime is kept. Chosen. Between
/// half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kSoftShare = 0.6;
/// Share of the band of a standing sole that is allowed upwards during kSoftTime. Reason: a swing
/// must not continue between two points. With half of the value, the change of the case "early"
/// changes from 0.0359 to 0.057; with twice, to 0.00761. Test: none.
inline constexpr double kSoftUpwards = 0.4;
/// Largest height of the middle of a sole at the first and the last sample of a contact, as a share
/// of the height up to which a swing may continue. Chosen: the remaining tenth is 6 micrometres,
/// far above the solver's tolerance. Test: FromScratch.JumpsOfATallRobotNeedFewPrograms.
inline constexpr double kEdgeShare = 0.9;
/// Half the band in which a locked foot stays on its path [m], [rad]. Derived: the documented
/// 0.01 mm. Test: Faults.LockedFootKeepsItsWayAndWeightsSteer.
inline constexpr double kLockedFoot = 1e-5;
/// Half the band of a locked posture in the program [m], [rad]; kept_at() makes it exact. Derived:
/// the tolerance of the constraints. Test:
/// Faults.LockedInstantKeepsItsPoseAndLetsTheMotionThroughItMove.
inline constexpr double kLockedPose = 1e-7;
}  // namespace stance

namespace swing {
/// Time before landing and after lift-off in which a low sole should be over its place [s].
/// Measured: with servos that sag by a millimetre, a foot touches down 50 ms early. Chosen: three
/// times that. With half of the value, the movement of the foot of the case "early" changes from
/// 17.1 to 11.7 mm; with twice, the change of the case "early" changes from 0.0359 to 0.0387. Test:
/// Landing.EarlyContactComesDownOnItsPlace.
inline constexpr double kNearPlace = 0.15;
/// Offset from its place that is always allowed for a low sole [m]. Chosen: the band of a standing
/// sole. Between half and twice the value, figures change by less than 5 %. Test:
/// Landing.ASoundWalkMeetsItsRows.
inline constexpr double kPlaceSlack = 2e-4;
/// Largest length, as a multiple of the COG's height, in the bound on the offset of a sole: offset
/// <= kPlaceSlack + height^2 / length. Chosen. Between half and twice the value, figures change by
/// less than 5 %. Test: none.
inline constexpr double kLeastLandingHeight = 0.12;
/// Factor on the median offset / height^2 of the motion's own swings; the median ignores a faulty
/// swing. Chosen. With half of the value, the change of the case "early" changes from 0.0359 to
/// 0.0416; with twice, the movement of the foot of the case "early" changes from 17.1 to 12.4 mm.
/// Test: Landing.ASoundWalkMeetsItsRows.
inline constexpr double kOwnLandingFactor = 1.5;
/// A sole below this height is left out of that median [m]. Reason: the quotient of two small
/// numbers is inaccurate. No measured case changes between half and twice the value (constants.md).
/// Test: none.
inline constexpr double kLowestMeasured = 0.001;
/// Period at which the motion's swings are measured for landings, and for heights [s]. Chosen.
/// kLandingPeriod: between half and twice the value, figures change by less than 5 %.
/// kHeightPeriod: no measured case changes between half and twice the value (constants.md). Test:
/// none.
inline constexpr double kLandingPeriod = 0.005, kHeightPeriod = 0.01;
/// Wanted height in the middle half of a swing, as a share of the median height of the motion's own
/// swings. Measured: when feet were only kept above the ground, the robot scraped the ground and
/// fell in each of three cases with a knee that is thrown up. Test:
/// Landing.AThrownKneePassesOverTheGround.
inline constexpr double kHeightShare = 0.5;
/// A swinging sole higher than this has no rows against the ground [m]. Chosen. Between half and
/// twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kWatchedHeight = 0.004;
}  // namespace swing

namespace dcm {
/// The DCM is held to its plan where the posture displaces it from the plan by more than this share
/// of the COG's height, times kWatchedShare. Derived: 1 % is 0.06 of the capture bound B, the step
/// of a push study. Test: ThrownKnee.LeavesTheCaptureBoundsAsTheyWerePlanned.
inline constexpr double kOff = 0.014;
/// Time around such a posture in which the DCM is held [s]. Chosen: 3/omega. Between half and twice
/// the value, figures change by less than 5 %. Test: none.
inline constexpr double kAround = 0.5;
/// Half the band of the DCM [m]. Chosen: an eighth of the resolution of a push study. With half of
/// the value, the missing safety of the case "planned sway" changes from 0.485 to 0.637; with
/// twice, to 0.447. Test: ThrownKnee.LeavesTheCaptureBoundsAsTheyWerePlanned.
inline constexpr double kSlack = 3e-4;
/// Half the band of the ZMP while the DCM is held [m]. Chosen. With half of the value, the missing
/// safety of the case "planned sway" changes from 0.485 to 0.288; with twice, to 0.747. Test:
/// ThrownKnee.RepairedWithstandsThePushesOfItsPlan.
inline constexpr double kZmpSlack = 1e-3;
/// Time around an error of the commanded COG or ZMP in which the plan is not a goal [s]. Chosen:
/// 2/omega. No measured case changes between half and twice the value (constants.md). Test:
/// ThrownKnee.FollowsNoPlanThatIsItselfAtFault.
inline constexpr double kWrongPlanAround = 0.3;
}  // namespace dcm

namespace flight {
/// The force and the moment that the motion itself needs in flight are each kept up to this share
/// of the check's limit; a larger one is removed completely. Chosen. With half of the value, the
/// missing safety of the case "flight" changes from 0.00462 to 0.0067; with twice, to 0.0143. Test:
/// JumpRepair.* (that the repair succeeds).
inline constexpr double kOwnShare = 0.85;
/// Half the band as a share of the check's limit, divided among three axes. Chosen. With half of
/// the value, the missing safety of the case "flight" changes from 0.00462 to 0.0317; with twice,
/// the case "flight" is infeasible. Test: none.
inline constexpr double kBand = 0.5;
}  // namespace flight

/// One band of distances between bodies, from the nearest to the farthest.
namespace clearance {
/// A clearance of the given motion that is smaller than this is to be corrected [m]. Chosen: a
/// quarter of the check's tolerance. No measured case changes between half and twice the value
/// (constants.md). Test: none.
inline constexpr double kTouch = 0.0005;
/// Distance that bodies keep, unless they are nearer in the motion itself [m]. Chosen. With half of
/// the value, the change of the case "collision" changes from 0.00251 to 0.00152; with twice, to
/// 0.00542. Test: none.
inline constexpr double kKept = 2.4e-3;
/// Pairs of bodies that are nearer than this are watched [m]. Chosen: about twice the distance that
/// they keep. Between half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kWatchedBodies = 0.005;
/// Shapes of such a pair that are nearer than this are watched [m]. Reason: when the nearest shapes
/// move apart, the next shapes are not far away. Chosen: twice as far. No measured case changes
/// between half and twice the value (constants.md). Test: none.
inline constexpr double kWatchedShapes = 0.010;
/// Amount by which a row of edges may be smaller than the rows of corners beside it [m]. If both
/// are equal, only the corners count. Chosen. Between half and twice the value, figures change by
/// less than 5 %. Test: none.
inline constexpr double kEdgeAllowance = 1e-4;
/// An edge counts as nearer than all corners if it is nearer by more than this [m]. Chosen: above
/// the accuracy of nearest points. No measured case changes between half and twice the value
/// (constants.md). Test: ClearanceRows.EdgesAreARowWhereNoCornerIsNearer.
inline constexpr double kSameDistance = 1e-6;
}  // namespace clearance

/// The bound of a joint's rate is reduced where a step of the table would exceed the rate because
/// of a kink. This is the largest reduction, as a share of the speed limit. Chosen: kinks of usual
/// motions give less than 0.01; a jump is repaired by its own rows. Test:
/// FromScratch.JumpsOfATallRobotNeedFewPrograms.
inline constexpr double kMostBeyond = 0.05;

/// Share of the check's tolerance by which a trusted COG or ZMP may deviate. Chosen. With half of
/// the value, the change of the case "cog, trusted" changes from 0.0463 to 0.0643; with twice, to
/// 0.023. Test: Faults.CogKeyMovedAndTrusted and Faults.ZmpMovedAndTrusted (that the check passes).
inline constexpr double kTrustedShare = 0.25;

// ---- prices. Their unit is that of the objective (kObjectiveScale / 2 of the weighted change),
// for each `unit` of violation of the worst row of one limit within a window of time

namespace prices {
/// Price of a soft goal. Measured (support): with a tenth of it, walks that are played in 0.65 of
/// their time fall in open loop after a repair; with three times, their repair takes twice the
/// iterations and the robot does not stand better. Chosen (the others): a displaced foot costs more
/// than the ZMP, and the DCM lies between. kZmpMargin, kLanding: between half and twice the value,
/// figures change by less than 5 %. kDcm: with half of the value, the missing safety of the case
/// "planned sway" changes from 0.485 to 0.263; with twice, figures change by less than 5 %.
inline constexpr double kZmpMargin = 0.1, kLanding = 1, kDcm = 0.3;
/// Price of a limit in the relaxed program. Reason: it is above all observed multipliers, so that a
/// limit is only violated if it must be; a repair costs about 1. With half of the value, the
/// missing safety of the case "sway" changes from 0.296 to 0.148; with twice, to 0.592. Test: none.
inline constexpr double kLimit = 100;
/// Price of feet in contact and of flight in the relaxed program, which are violated last. Chosen:
/// a hundred times a limit. No measured case changes between half and twice the value
/// (constants.md). Test: none.
inline constexpr double kFoot = 100 * kLimit;

/// Windows of time in which the rows of one limit share a slack variable [s], for soft goals and
/// for limits. Chosen: one knot interval, and two. kSoftGoalWindow: with half of the value, the
/// missing safety of the case "planned sway" changes from 0.485 to 0.361; with twice, to 0.361.
/// kLimitWindow: with half of the value, the missing safety of the case "sway" changes from 0.296
/// to 0.458; with twice, to 0.181. Test: none.
inline constexpr double kSoftGoalWindow = 0.05, kLimitWindow = 0.1;

/// Violations that count as equal: 1 mm, 0.01 rad, and a hundredth of a limit. Chosen: 0.01 rad
/// moves the end of a limb of 0.1 m by a millimetre. kLength: with half of the value, the missing
/// safety of the case "sway" changes from 0.296 to 0.592; with twice, the missing safety of the
/// case "planned sway" changes from 0.485 to 0.14. kAngle, kShare: no measured case changes between
/// half and twice the value (constants.md).
inline constexpr double kLength = 1e-3, kAngle = 0.01, kShare = 0.01;

/// Violation, as a multiple of `unit`, that counts as zero. Derived: the solver's tolerance. Test:
/// none.
inline constexpr double kMet = 1e-6;
}  // namespace prices

// ---- the rounds

namespace rounds {
/// Largest number of rounds. Measured: walks that are played in half of their time are repaired
/// within this number. Test: none.
inline constexpr int kMost = 8;
/// Largest number of rounds without a solution. Chosen: first wider windows are tried, then finer
/// knots, then a program without soft goals. No measured case changes between half and twice the
/// value (constants.md). Test: none.
inline constexpr int kMostUnsolved = 3;
/// Free time around a finding [s]; it is doubled if it is not enough. Reason: the effect of a
/// correction on the COG decays as exp(-omega t), to 5 % after 3/omega. With half of the value, the
/// number of iterations of the case "early" changes from 31 to 46; with twice, figures change by
/// less than 5 %. Test: Repair.ZmpComesInsideAndNothingChangesTwice (nothing moves 0.8 s away).
inline constexpr double kFreeAround = 0.5;
/// A result with less violation than this is the start of the next round even if it was not solved,
/// and a start with less violation is a warm start (scaled violation). Chosen. No measured case
/// changes between half and twice the value (constants.md). Test: none.
inline constexpr double kNearlyMet = 1e-3;
/// Value of kNearlyMet if the multipliers of the last program are known. Measured: the second
/// program on slippery ground, which starts with 2.6e-3, takes 5 iterations instead of 11. Test:
/// none.
inline constexpr double kNearKnown = 1e-2;
/// Largest scaled violation with which a program counts as solved. Derived: ten times the solver's
/// tolerance. Test: Repair.* (constraint_violation).
inline constexpr double kMet = 1e-6;
/// Largest number of iterations of the first program. Reason: finer knots may help more than
/// further iterations. Measured: in the repair of a knee that is thrown up, the last 60 of 100
/// iterations changed nothing. No measured case changes between half and twice the value
/// (constants.md). Test: none.
inline constexpr int kBeforeFinerKnots = 50;
/// Tolerance of optimality; the smallest change is only searched for at the end. Chosen. Between
/// half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kTolerance = 1e-3;
/// Largest work of all programs of a repair (NlpSolution::work) for each second of the motion.
/// Measured: a unit of work takes 1.3e-8 s of processor time, so that the programs end within 2 s
/// for each second of motion; checks and the explanation of a failure take additional time. Test:
/// Repair.EndsWithinItsWork.
inline constexpr double kMostWork = 1.5e8;
/// For shorter motions, the work of a motion of this duration is allowed [s]. Reason: the search
/// for the reasons of a failure does not become shorter with the motion. Chosen: 10 s of processor
/// time. Test: CheckRepair.TheParameterThatWouldDoIsNamed.
inline constexpr double kShortestForWork = 5;
/// Share of the work that is reserved for the search for the reasons. Chosen: that search has fewer
/// iterations than two rounds. Test: none.
inline constexpr double kWorkForReasons = 0.15;
/// Largest number of iterations of each program, unless options state another one. Chosen. No
/// measured case changes between half and twice the value (constants.md). Test: none.
inline constexpr int kMostIterations = 100;
}  // namespace rounds

namespace tighten {
/// Largest number of programs at the check's own limits. Chosen. With half of the value, the number
/// of iterations of the case "grip" changes from 95 to 57; with twice, nothing changes. Test: none.
inline constexpr int kMostRounds = 4;
/// Tolerance of optimality as a share of the cost of the change, and its bounds. Measured: with a
/// fixed tolerance, the barrier of a thousand rows outweighed a change of half a thousandth. It
/// only applies to complementarity (NlpOptions::tolerance). Test: LeastChange.*.
inline constexpr double kTolerance = 1e-7, kLeastTolerance = 1e-9, kMostTolerance = 1e-6;
/// Share of the difference to the passing motion by which the start of the next program is moved
/// back to this motion. Chosen. Between half and twice the value, figures change by less than 5 %.
/// Test: none.
inline constexpr double kStartBack = 0.1;
/// The result of the program may fail the check by a little. Before the program is solved once
/// more, steps from it back towards the passing motion are tried. Their lengths are shares of the
/// difference of the two motions: kFirstBack, and kBackFactor times as much each, up to kMostBack.
/// The largest share is tried first. Chosen: the weighted change is convex, so a step of a
/// thousandth of the difference changes it by at most a thousandth of the difference between the
/// weighted changes of the two motions. The step saves a program of ten iterations (friction 0.10
/// on a walk of 4.3 s). Test: LeastChange.* (the motion after the step back costs more than the
/// smallest change).
inline constexpr double kFirstBack = 1e-6, kMostBack = 1e-3, kBackFactor = 10;
/// Value of kMostBack after the second program and later ones. Chosen: a hundredth of the
/// difference between the weighted changes is less than what one more program is worth. Measured:
/// a jump of SR1 needs two programs instead of three. Test: LeastChange.*.
inline constexpr double kMostBackLater = 1e-2;
/// ZMP margin without robustness, inside the edge [m]. Derived: kRounding of 1 mm. Test: none.
inline constexpr double kZmpMargin = kRounding * 1e-3;
}  // namespace tighten

// ---- the solver

namespace solver {
/// Barrier with which a program starts, and barrier of a warm start. A larger barrier would push a
/// warm start away from a motion with a small violation. Measured: 20 iterations instead of 36.
/// Test: none.
inline constexpr double kStartBarrier = 1e-3, kWarmBarrier = 1e-5;
/// Smallest barrier of a start with multipliers, even if the last program ended with a smaller one.
/// Chosen: with a larger one, the result of the last program is lost; with a smaller one, steps to
/// new rows are short. Test: none.
inline constexpr double kKnownBarrier = 1e-8;
/// Distance from the bounds to which a start is pushed, and the distance for a warm start. Measured
/// with the barrier. Test: none.
inline constexpr double kStartPush = 1e-2, kWarmPush = 1e-6;
/// Distance from the bounds and barrier of a warm start, as shares of the largest violation at the
/// start. They are used if they give larger values than kWarmPush and the barrier of the last
/// program.
/// Measured: without them, the fourth program of a jump of SR1, which starts with 0.005, reduced
/// its violation by 2 % in each iteration and took 76 iterations instead of 31. Test: none.
inline constexpr double kPushShare = 0.1, kBarrierShare = 0.01;
/// Tolerances of optimality and of the constraints (unscaled). Chosen: a tenth of a micrometre. No
/// measured case changes between half and twice the value (constants.md). Test:
/// Nlp.NearestPointOfADisc.
inline constexpr double kTolerance = 1e-6, kConstraintTolerance = 1e-7;
/// Number of iterations in turn that change the objective by less than kKinkChange of it, after
/// which a search that keeps all constraints counts as alternating about a kink. Its gradient may
/// be as large as kKinkGradient then. Chosen: Newton's steps converge within fewer iterations, and
/// the smallest change is only searched for at the end. Measured: between two sides of a kink, the
/// objective changes by 1e-5 to 3e-5 of it, with a gradient of 0.02. Test: Nlp.EndsAtAKink.
inline constexpr int kKinkIterations = 8;
inline constexpr double kKinkChange = 1e-4, kKinkGradient = 0.1;
/// Value of kKinkChange for the programs of the least change, and the largest complementarity with
/// which a search that changes nothing ends, as a multiple of its tolerance. Chosen: eight such
/// changes are far below the precision of a repair's cost. Measured: in a jump of SR1, 90 of 100
/// iterations of the last program changed nothing, because its multipliers grew. Test:
/// LeastChange.* (that the change is the least one).
inline constexpr double kStillChange = 1e-7, kStillBarrier = 100;
/// The barrier falls by this factor, or to this power of itself. Chosen: faster than Ipopt's 0.2
/// and 1.5, because Newton's steps follow. kBarrierFactor: no measured case changes between half
/// and twice the value (constants.md). kBarrierPower: with half of the value, the number of
/// iterations of the case "grip" changes from 95 to 155; with twice, to 155. Test: none.
inline constexpr double kBarrierFactor = 0.05, kBarrierPower = 1.8;
/// Slack variables start with a value that is larger by this than the start needs, in their units,
/// if no barrier determines it. Chosen. No measured case changes between half and twice the value
/// (constants.md). Test: none.
inline constexpr double kSlackStart = 0.01;
/// Slack variables with an upper bound start below this share of it. Reason: the middle is farthest
/// from both bounds. Between half and twice the value, figures change by less than 5 %. Test: none.
inline constexpr double kSlackShare = 0.5;
/// Steps of the differences by which the load of two feet is derived: of the base [m], of the
/// ground wrench [N], [N m]. Derived: the cube root of the rounding. Test:
/// ConstraintRows.DerivativesAgainstCentralDifferences.
inline constexpr double kBaseStep = 1e-6, kWrenchStep = 1e-5;
}  // namespace solver

// ---- the initial guess

namespace guess {
/// If soles and clearances are violated by more than this, the program starts from a guess [m],
/// [rad]. Measured: for a hip that is thrown up by a radian, the program took 232 iterations
/// without a guess and 20 with a guess. Test: none.
inline constexpr double kFarOff = 0.01;
/// Times before and after an error between which its joints follow a straight line [s]. Chosen:
/// from less than a knot interval to the time of a step. No measured case changes between half and
/// twice the value (constants.md). Test: none.
inline constexpr double kReaches[] = {0.02, 0.06, 0.12, 0.2, 0.3, 0.4, 0.6, 0.8};
}  // namespace guess

// ---- motions that are made from a plan alone

namespace generation {
/// Heights of the COG that are tried where no key gives one, as shares of the default height.
/// The first one that passes the check is taken, or the one with the smallest violations. Chosen:
/// the steps are a few percent of a leg, so the legs bend little more than needed, and below the
/// last height a walk is a crouch that an author would ask for. Test:
/// FromScratch.LegsThatAreTooShortForThePlanAreHelped.
inline constexpr double kHeights[] = {0.96, 0.92, 0.88, 0.84, 0.8};
/// Times over which the feet take up the COG's speed in a flight, in place of kFlightRamp, in the
/// order in which they are tried [s]. Reason: a large robot flies longer, and a leg that is nearly
/// straight needs time to bend for its landing, because the servo targets lead. Test:
/// FromScratch.AJumpOfATallRobot.
inline constexpr double kFlightRamps[] = {0.055, 0.07, 0.09};
/// Times over which the ZMP of least sway changes smoothly, in the order in which they are tried
/// [s]. Measured: with 0.02 s, Unitree H1 follows the ZMP of steps of 0.38 s; with a shorter time,
/// the COG sways less, but the full model misses the sudden ZMP by several millimetres. Test:
/// FromScratch.ACogOfLeastSwayForLegsWithoutAnkleRoll.
inline constexpr double kSwaySmooth[] = {0.02, 0.01};
/// Time between two values of this ZMP [s]. Chosen: short beside the double support of quick steps
/// (0.07 s). Test: none.
inline constexpr double kZmpStep = 0.01;
/// Distance of this ZMP from the edges of the support, as a share of the largest distance that a
/// point of a sole has from its edges. Chosen: 2 mm on the sole of Unitree H1, which the difference
/// between the full model and its commanded ZMP needs. Test: none.
inline constexpr double kInsideShare = 0.15;
}  // namespace generation

// ---- motions with jumps or noise

namespace rough {
/// Time before and after a jump in which a smooth curve replaces the motion, in intervals of its
/// knots. Chosen: three control points at each end are determined by the motion outside, and as
/// many are left to lead from one side of the jump to the other. Test: RoughMotion.*.
inline constexpr double kAround = 5;
/// The motion is made smooth only if the violations of rates and forces then fall below this share.
/// Chosen: noise and jumps exceed limits by factors, but a smooth curve also changes what is right.
/// Test: RoughMotion.*.
inline constexpr double kGain = 0.5;
}  // namespace rough

// ---- reasons that prevent a repair

namespace infeasible {
/// Largest number of iterations of the relaxed program. Chosen: the reasons are visible long before
/// the optimum. No measured case changes between half and twice the value (constants.md). Test:
/// none.
inline constexpr int kMostIterations = 60;
/// Largest number of reasons in words. Chosen. No measured case changes between half and twice the
/// value (constants.md). Test: none.
inline constexpr size_t kMostReasons = 6;
/// A window that would have to become longer by more than this factor is not called too short.
/// Chosen. No measured case changes between half and twice the value (constants.md). Test: cli
/// Infeasible.AWindowFarTooShortIsStillAMatterOfTime.
inline constexpr double kSlowest = 8;
/// Precision of that factor. Derived: it is written with one decimal. Test: none.
inline constexpr double kFactorStep = 0.01;
/// Number of samples around a window that are judged with it. Derived: differences use two
/// neighbours. Test: none.
inline constexpr long kSamplesAround = 2;
/// Amounts of a violation in m, in N and in other units that count as much as a value of twice its
/// limit. Chosen: 1 cm, 10 N, 0.1 of any other unit. No measured case changes between half and
/// twice the value (constants.md). Test: none.
inline constexpr double kLength = 0.01, kForce = 10, kOther = 0.1;
}  // namespace infeasible

// ---- reported and written results

namespace report {
/// A joint that moves by less than this counts as unmoved [rad]. Chosen: far below a servo count
/// (8e-5 rad on HOAP-1). No measured case changes between half and twice the value (constants.md).
/// Test: none.
inline constexpr double kMoved = 1e-6;
/// The time of a change is the time in which it is above this share of its largest value. Chosen.
/// No measured case changes between half and twice the value (constants.md). Test:
/// MotionChange.NamesJointsTimesAndQuantities.
inline constexpr double kChangeShare = 0.1;
/// Factor of rounding a control point in a file: nine decimals. Derived: this rounding is far below
/// tighten::kRounding (1e-6). Test: none.
inline constexpr double kWritten = 1e9;
}  // namespace report

}  // namespace ayumi::repair_policy
