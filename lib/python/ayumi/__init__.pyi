# Written by tests/python/write_stubs.py from the module; do not edit.
from os import PathLike
from pathlib import Path
from typing import Any, Callable, Optional, Union

import numpy
from numpy.typing import NDArray

__version__: str
__all__: list[str]

class Actuators:
    """Limits of the motors of one profile, by joint."""

    @property
    def name(self) -> str:
        """Name of the profile."""

    @property
    def speed(self) -> NDArray[numpy.float64]:
        """Largest speeds [rad/s, m/s], shape (dof,); inf where there is no limit."""

    @property
    def peak_torque(self) -> NDArray[numpy.float64]:
        """Largest torques [N m, N], shape (dof,)."""

    @property
    def continuous_torque(self) -> NDArray[numpy.float64]:
        """Largest torques that the motors bear without a time limit [N m, N], shape (dof,)."""

class Command:
    """The plan of one tick."""

    @property
    def state(self) -> RobotState:
        """Planned base and joints."""

    @property
    def cog(self) -> NDArray[numpy.float64]:
        """COG [m], shape (3,)."""

    @property
    def dcog(self) -> NDArray[numpy.float64]:
        """Velocity of the COG [m/s], shape (3,)."""

    @property
    def zmp(self) -> NDArray[numpy.float64]:
        """ZMP [m], shape (3,)."""

    @property
    def fz(self) -> float:
        """Vertical ground force [N]."""

    @property
    def support(self) -> str:
        """'both', 'left', 'right' or 'none'."""

class Contact:
    """One foot on the ground, in a motion that was imported."""

    @property
    def foot(self) -> str:
        """'left' or 'right'."""

    @property
    def begin(self) -> float:
        """Beginning of the contact [s]."""

    @property
    def end(self) -> float:
        """End of the contact [s]."""

    @property
    def position(self) -> NDArray[numpy.float64]:
        """Place of the sole in the world [m], shape (3,)."""

    @property
    def yaw(self) -> float:
        """Heading of the sole [rad]."""

class Error(Exception):
    """What is wrong with a call, a file, a robot or a pattern. `code` is one of 'usage', 'bad_file', 'bad_model', 'bad_pattern', 'solver' and 'internal'; `place` is the file and the place in this file, '' where there is none. An inconsistent pattern, a fall and a solver that did not converge are results, not errors."""

    code: str

    place: str

class Estimate:
    """What a controller receives from the sensors, in the frame of the plan."""

    @property
    def state(self) -> RobotState:
        """Estimated state of the robot."""

    @property
    def cog(self) -> NDArray[numpy.float64]:
        """COG [m], shape (3,)."""

    @property
    def dcog(self) -> NDArray[numpy.float64]:
        """Velocity of the COG [m/s], shape (3,)."""

    @property
    def zmp(self) -> NDArray[numpy.float64]:
        """ZMP [m], shape (3,); in flight, the last value on the ground."""

    @property
    def fz(self) -> float:
        """Vertical ground force [N]."""

    @property
    def foot_fz(self) -> tuple[Any, ...]:
        """Vertical force on the left and the right foot [N]."""

    @property
    def contact(self) -> bool:
        """Whether the ground carries the robot."""

class Event:
    """Something that happened in a run."""

    @property
    def t(self) -> float:
        """Time [s]."""

    @property
    def kind(self) -> str:
        """'push', 'touchdown', 'fell', ..."""

    @property
    def text(self) -> str:
        """Description in words."""

class Finding:
    """One thing that the check says about a motion."""

    @property
    def kind(self) -> str:
        """Kind: 'support_margin', 'joint_torque', ..."""

    @property
    def severity(self) -> str:
        """'error', 'warning' or 'info'."""

    @property
    def begin(self) -> float:
        """Beginning of the window [s]."""

    @property
    def end(self) -> float:
        """End of the window [s]."""

    @property
    def at(self) -> float:
        """Time of the worst sample [s]."""

    @property
    def worst(self) -> float:
        """Value at this time, in `unit`."""

    @property
    def limit(self) -> float:
        """The limit, in `unit`."""

    @property
    def unit(self) -> str:
        """Unit of `worst` and `limit`."""

    @property
    def where(self) -> str:
        """Joint, foot, axis, support or bodies."""

    @property
    def hint(self) -> str:
        """What to do about the finding."""

class GainStudy:
    """Gains of DTAD and what follows from them."""

    @property
    def omega(self) -> float:
        """Natural frequency of the pendulum [1/s]."""

    @property
    def gains(self) -> dict[str, float]:
        """The gains by their names in patterns and sidecars."""

    @property
    def stable(self) -> bool:
        """Whether the linear loop on one foot is stable."""

    @property
    def poles(self) -> list[complex]:
        """Poles of this loop [1/s], the slowest decay first."""

    @property
    def decay(self) -> float:
        """Decay rate of the slowest mode [1/s]; negative when the mode grows."""

    @property
    def largest_ka(self) -> float:
        """Largest short-term gain with which the loop is stable."""

    @property
    def reaches(self) -> list[Any]:
        """(support, direction, largest error of the DCM that needs no step [m], impulse of this error [N s])."""

class Identification:
    """Servo constants of a robot from a recording."""

    @property
    def joints(self) -> list[IdentifiedJoint]:
        """The joints that the recording has, in the order of the robot."""

    @property
    def seconds(self) -> float:
        """Length of the recording [s]."""

    @property
    def caution(self) -> str:
        """A warning if the recording may be shifted in time; '' otherwise."""

    def sidecar(self, base: str, name: str = 'identified') -> str:
        """The text of a sidecar with these servos. `base` is the name or path of the robot, as the sidecar names it; `name` is added to the name of the robot."""

class IdentifiedJoint:
    """The servo constants of one joint."""

    @property
    def joint(self) -> str:
        """Name of the joint."""

    @property
    def type(self) -> str:
        """Motor type of the joint, named after the first joint of the type."""

    @property
    def moved(self) -> bool:
        """Whether the joint moved. If not, only its mean distance from the command is known."""

    @property
    def delay(self) -> ServoEstimate:
        """Transport delay [s]."""

    @property
    def kp(self) -> ServoEstimate:
        """Stiffness [N m/rad]."""

    @property
    def damping(self) -> ServoEstimate:
        """kd + viscous friction [N m s/rad]."""

    @property
    def viscous(self) -> ServoEstimate:
        """Viscous friction [N m s/rad]."""

    @property
    def coulomb(self) -> ServoEstimate:
        """Dry friction [N m]."""

    @property
    def backlash(self) -> ServoEstimate:
        """Whole play [rad]."""

    @property
    def offset(self) -> ServoEstimate:
        """Mean distance of the unloaded joint from its command [rad]."""

    @property
    def lag(self) -> ServoEstimate:
        """Time by which the angle is behind a slow command [s]: a value with its interval."""

    @property
    def mean_error(self) -> float:
        """Mean error of the angle that remains with these constants [rad]."""

    @property
    def largest_error(self) -> float:
        """Largest error of the angle that remains with these constants [rad]."""

    @property
    def confounded(self) -> list[str]:
        """What cannot be distinguished in this recording, in words."""

class Import:
    """A motion of another program or robot as a pattern."""

    @property
    def pattern(self) -> Pattern:
        """The pattern; ayumi.sample(found.pattern, robot) samples it."""

    @property
    def format(self) -> str:
        """Name of the format of the file."""

    @property
    def reason(self) -> str:
        """Why Ayumi chose this format; '' if the caller named the format."""

    @property
    def rows(self) -> int:
        """Data rows, or key poses, of the file."""

    @property
    def contacts(self) -> list[Contact]:
        """Contacts of the feet, in the order of their beginning; none for a file of key poses."""

    @property
    def notes(self) -> list[str]:
        """What was assumed, left out or changed, one sentence each."""

    def write(self, path: Union[str, PathLike[str]]) -> None:
        """Writes the pattern and its table. For formats whose files can be exported unchanged, it also writes a copy of the file. It writes all of these files, or none."""

class Interrupted(Exception):
    """Long work was stopped because its progress callback returned False."""

class LocalPace:
    """The result of fastest_local_pace()."""

    @property
    def found(self) -> bool:
        """Whether a timing passes the check."""

    @property
    def pattern(self) -> Pattern:
        """The motion with this timing, as a table."""

    @property
    def scale(self) -> float:
        """Duration divided by the duration of the given pattern."""

    @property
    def path_scale(self) -> float:
        """The scale of the fastest uniform pace. The motion has the postures of this pace."""

    @property
    def binding(self) -> list[Any]:
        """(limit, share of the duration for which it binds), the longest first; '' where no limit binds, 'pace' for the largest pace, 'pause' for pauses that are kept."""

    @property
    def rounds(self) -> int:
        """Number of timings that were checked."""

    @property
    def limited_by(self) -> str:
        """In words: why no timing passes the check."""

    @property
    def by_posture(self) -> bool:
        """Whether no timing passes because a posture itself violates a limit."""

class Log:
    """A run with one sample per tick. log['cog'] is an array, log.units('cog') has its units. docs/formats.md describes the quantities."""

    def __len__(self) -> int:
        """Number of samples."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The quantity of this name as a view that cannot be written: one row per sample, shape (n,) for a number, (n, 3) for a vector, (n, 4) for a unit quaternion x y z w, (n, dof) for joints, (n, 4, 4) for a pose."""

    @property
    def names(self) -> list[str]:
        """Names of the quantities, the keys of []."""

    def parts(self, name: str) -> list[str]:
        """Names of the columns of a quantity: 'x', or a joint."""

    def units(self, name: str) -> list[str]:
        """Units of the columns of a quantity; '1' where there is none."""

    @property
    def joints(self) -> list[str]:
        """Names of the joints, the columns of theta."""

    @property
    def dt(self) -> float:
        """Time between two samples [s]."""

    @property
    def t(self) -> NDArray[numpy.float64]:
        """Times of the samples [s], shape (n,), computed as k dt."""

    @property
    def outcome(self) -> str:
        """'stands', 'unsettled' or 'fell'."""

    @property
    def fell_at(self) -> float:
        """Time of the fall [s]; negative when there was none."""

    @property
    def max_tilt(self) -> float:
        """Largest tilt of the trunk [rad]."""

    @property
    def final_cog_error(self) -> float:
        """Horizontal error of the COG relative to the feet at the end [m]."""

    @property
    def zmp_tracking_rms(self) -> float:
        """Root mean square of the distance from the measured ZMP to the reference ZMP [m]."""

    @property
    def max_torque_ratio(self) -> float:
        """Largest torque as a share of its limit."""

    @property
    def max_speed_ratio(self) -> float:
        """Largest joint speed as a share of its limit."""

    @property
    def events(self) -> list[Event]:
        """Events of the run, in the order of time."""

    @property
    def controller(self) -> Optional[str]:
        """Name of the control law."""

    @property
    def plant(self) -> str:
        """'ayumi', 'mujoco' or 'python'."""

    @property
    def hash(self) -> str:
        """SHA-256 of the motion; the same for the same run."""

    def to_dict(self) -> Any:
        """The content of `ayumi simulate --json` as a dict."""

    def write(self, path: Union[str, PathLike[str]]) -> None:
        """Writes the log as one binary file, whole or not at all."""

class Pace:
    """The result of fastest_pace()."""

    @property
    def found(self) -> bool:
        """Whether a scale passes the check."""

    @property
    def scale(self) -> float:
        """Smallest factor on all times that passes."""

    @property
    def bounded(self) -> bool:
        """False if even the fastest scale that was tried passes."""

    @property
    def limited_by(self) -> str:
        """First error at a slightly smaller scale, in words."""

    @property
    def evaluations(self) -> int:
        """Number of scales tried."""

class Pattern:
    """A motion pattern as its author writes it: keyframes, phases, controller and scenario. docs/formats.md describes its file."""

    @property
    def name(self) -> str:
        """Name of the motion."""

    @name.setter
    def name(self, value: str) -> None: ...

    @property
    def robot(self) -> str:
        """Name or path of the robot."""

    @robot.setter
    def robot(self, value: str) -> None: ...

    @property
    def profile(self) -> str:
        """Actuator profile; '' is the default of the robot."""

    @profile.setter
    def profile(self, value: str) -> None: ...

    @property
    def file(self) -> str:
        """File from which the pattern was read; '' if there is none."""

    @property
    def parameters(self) -> dict[str, float]:
        """Declared parameters with their values."""

    @property
    def duration(self) -> float:
        """End of the last phase or key [s]."""

    @property
    def repaired(self) -> bool:
        """Whether the pattern has the correction of a repair."""

    def text(self) -> str:
        """The text of a pattern file, which is JSON."""

    def to_dict(self) -> Any:
        """The keys of the pattern file; parse_pattern(json.dumps(...)) reads them back."""

    def write(self, path: Union[str, PathLike[str]]) -> None:
        """Writes the pattern file, whole or not at all."""

class Plant:
    """Ayumi's own plant. A plant that is written in Python may contain it."""

    def __init__(self, robot: Robot, profile: str = '', world: World = ...) -> None:
        ...

    @property
    def state(self) -> RobotState:
        """The state of the robot."""

    def set_state(self, state: RobotState) -> None:
        """Puts the robot in this state and forgets the contacts."""

    def step(self, targets: NDArray[numpy.float64], input: StepInput, dt: float) -> StepReport:
        """Advances by `dt` [s]. The servo targets [rad, m], shape (dof,), are held during this time. They are angles of the encoders: those of the joints, minus the offsets of the servos."""

class PushCase:
    """The limits of one phase and direction."""

    @property
    def phase(self) -> str:
        """Name of the phase."""

    @property
    def at(self) -> float:
        """Time of the push [s]."""

    @property
    def standing(self) -> bool:
        """Whether the robot stands in the first posture."""

    @property
    def direction(self) -> float:
        """Direction of the push, counted anticlockwise from forward [rad]."""

    @property
    def bound(self) -> float:
        """Capture bound: the largest push that a point mass could absorb [N s]."""

    @property
    def open_loop(self) -> float:
        """Largest push that the robot survives in open loop [N s]."""

    @property
    def limits(self) -> list[float]:
        """Largest push that the robot survives with each controller [N s]."""

    @property
    def capped(self) -> list[bool]:
        """Whether the robot survives the largest push that was tried, by controller."""

class PushStudy:
    """The result of push()."""

    @property
    def cases(self) -> list[PushCase]:
        """Cases in the order of the phases, and in each phase in the order of the directions."""

    @property
    def controllers(self) -> list[str]:
        """The laws, in the order of PushCase.limits."""

    @property
    def summary(self) -> list[str]:
        """For each law, one line for pushes while walking, and one for pushes while standing."""

    def picture(self, scale: float = 1.5) -> bytes:
        """A map of the push limits, seen from above, as the bytes of a PNG file."""

class Repair:
    """What a repair found."""

    @property
    def status(self) -> str:
        """'already_consistent', 'repaired', 'infeasible' or 'not_converged'."""

    @property
    def ok(self) -> bool:
        """Whether the motion of `task` is consistent."""

    @property
    def task(self) -> Task:
        """The task with the correction in its pattern; without a correction if the repair found none."""

    @property
    def max_joint_change(self) -> float:
        """Largest change of a joint [rad]."""

    @property
    def max_cog_change(self) -> float:
        """Largest change of the COG [m]."""

    @property
    def where(self) -> str:
        """The joint whose angle the repair changes most."""

    @property
    def at(self) -> float:
        """The time at which the repair changes this joint most [s]."""

    @property
    def iterations(self) -> int:
        """Iterations of the solver."""

    @property
    def reasons(self) -> list[str]:
        """Why there is no repair, in words."""

    def to_dict(self) -> Any:
        """The content of `ayumi repair --json` as a dict."""

class Robot:
    """A robot: a tree of links with soles, motors and named postures."""

    @property
    def name(self) -> str:
        """Name of the robot."""

    @property
    def mass(self) -> float:
        """Mass [kg]."""

    @property
    def joints(self) -> list[str]:
        """Names of the joints, the order of all joint vectors."""

    @property
    def links(self) -> list[str]:
        """Names of the links."""

    @property
    def lower(self) -> NDArray[Any]:
        """Lower position limits [rad, m], shape (dof,); -inf without a limit."""

    @property
    def upper(self) -> NDArray[Any]:
        """Upper position limits [rad, m], shape (dof,); inf without a limit."""

    @property
    def profiles(self) -> list[str]:
        """Names of the actuator profiles."""

    def actuators(self, profile: str = '') -> Actuators:
        """Limits of the motors of a profile; '' means the default profile."""

    def posture(self, name: str = 'home') -> NDArray[numpy.float64]:
        """Joint angles of a named posture [rad, m], shape (dof,)."""

    def rest_state(self, posture: str = 'home') -> RobotState:
        """The robot at rest in a named posture, its base at the origin."""

    @property
    def servo_period(self) -> float:
        """Time between two targets of the servos [s]."""

    @property
    def assumptions(self) -> list[str]:
        """Values that the files of the robot do not state and that were inferred."""

    def cog(self, state: RobotState) -> NDArray[numpy.float64]:
        """Centre of gravity in the world [m], shape (3,)."""

    def link_pose(self, state: RobotState, link: str) -> NDArray[numpy.float64]:
        """Pose of a link in the world [m], shape (4, 4)."""

    def sole_pose(self, state: RobotState, foot: str) -> NDArray[numpy.float64]:
        """Pose of a sole, 'left' or 'right', in the world [m], shape (4, 4)."""

class RobotState:
    """State of a robot: base pose and velocity in the world, joint angles and rates."""

    def __init__(self, theta: NDArray[numpy.float64], dtheta: Optional[NDArray[numpy.float64]] = None, position: NDArray[numpy.float64] = ..., attitude: NDArray[numpy.float64] = ..., velocity: NDArray[numpy.float64] = ..., angular_velocity: NDArray[numpy.float64] = ...) -> None:
        ...

    @property
    def theta(self) -> NDArray[numpy.float64]:
        """Joint positions, shape (dof,): angles [rad], or displacements of sliding joints [m]."""

    @property
    def dtheta(self) -> NDArray[numpy.float64]:
        """Joint rates [rad/s, m/s], shape (dof,)."""

    @property
    def position(self) -> NDArray[numpy.float64]:
        """Position of the base in the world [m], shape (3,)."""

    @property
    def attitude(self) -> NDArray[numpy.float64]:
        """Attitude of the base in the world, unit quaternion x y z w, shape (4,)."""

    @property
    def velocity(self) -> NDArray[numpy.float64]:
        """Velocity of the base, world axes [m/s], shape (3,)."""

    @property
    def angular_velocity(self) -> NDArray[numpy.float64]:
        """Angular velocity of the base, world axes [rad/s], shape (3,)."""

class SafeTable:
    """A table with ramp and hold, judged for a robot."""

    @property
    def table(self) -> Table:
        """The table with ramp, motion and hold."""

    @property
    def safe(self) -> bool:
        """Whether the robot may receive the table."""

    @property
    def violations(self) -> list[str]:
        """Why the robot may not receive the table, in words."""

    def to_dict(self) -> Any:
        """All figures of the verdict."""

class Series:
    """The command at the servo period of the robot: posture, COG, ZMP, vertical force and sole poses of every sample. series['theta'] is an array, series.units('theta') has its units."""

    def __len__(self) -> int:
        """Number of samples."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The quantity of this name as a view that cannot be written: one row per sample, shape (n,) for a number, (n, 3) for a vector, (n, 4) for a unit quaternion x y z w, (n, dof) for joints, (n, 4, 4) for a pose."""

    @property
    def names(self) -> list[str]:
        """Names of the quantities, the keys of []."""

    def parts(self, name: str) -> list[str]:
        """Names of the columns of a quantity: 'x', or a joint."""

    def units(self, name: str) -> list[str]:
        """Units of the columns of a quantity; '1' where there is none."""

    @property
    def joints(self) -> list[str]:
        """Names of the joints, the columns of theta."""

    @property
    def dt(self) -> float:
        """Time between two samples [s]."""

    @property
    def t(self) -> NDArray[numpy.float64]:
        """Times of the samples [s], shape (n,), computed as k dt."""

    @property
    def origin(self) -> dict[str, str]:
        """Source of each track, in words."""

    @property
    def support(self) -> list[str]:
        """Planned support of every sample: 'both', 'left', 'right' or 'none'."""

class ServoEstimate:
    """A value with its 95 % interval."""

    @property
    def value(self) -> float:
        """The value."""

    @property
    def lower(self) -> float:
        """Lower end of the interval."""

    @property
    def upper(self) -> float:
        """Upper end; inf where there is none."""

    @property
    def known(self) -> bool:
        """Whether the recording determines the value: its uncertainty is at most half of the value."""

class SoleForce:
    """Ground force at one vertex of a sole."""

    def __init__(self, position: NDArray[numpy.float64], force: NDArray[numpy.float64], gap: float = 0.0) -> None:
        ...

    @property
    def position(self) -> NDArray[numpy.float64]:
        """Place of the vertex in the world [m], shape (3,)."""

    @property
    def force(self) -> NDArray[numpy.float64]:
        """Force of the ground on the robot, in world axes [N], shape (3,)."""

    @property
    def gap(self) -> float:
        """Distance to the ground, negative inside [m]."""

class StepInput:
    """What acts on the robot from outside during one step."""

    def __init__(self) -> None:
        ...

    @property
    def wrenches(self) -> list[Wrench]:
        """Forces and couples."""

    @property
    def friction(self) -> Optional[float]:
        """Friction coefficient of the whole ground in place of that of the world; None: that of the world."""

class StepReport:
    """Forces of a step, as means over the duration of the step."""

    def __init__(self, torque: NDArray[numpy.float64], left: list[SoleForce], right: list[SoleForce], body_contact: bool = False) -> None:
        ...

    @property
    def torque(self) -> NDArray[numpy.float64]:
        """Torques of the servos [N m, N], shape (dof,)."""

    @property
    def left(self) -> list[SoleForce]:
        """Forces on the left sole."""

    @property
    def right(self) -> list[SoleForce]:
        """Forces on the right sole."""

    @property
    def body_contact(self) -> bool:
        """Whether a body that is no sole touches the ground."""

class Table:
    """Servo targets row by row, with the quantities that they were computed from."""

    def __len__(self) -> int:
        """Number of samples."""

    def __getitem__(self, name: str) -> NDArray[Any]:
        """The quantity of this name as a view that cannot be written: one row per sample, shape (n,) for a number, (n, 3) for a vector, (n, 4) for a unit quaternion x y z w, (n, dof) for joints, (n, 4, 4) for a pose."""

    @property
    def names(self) -> list[str]:
        """Names of the quantities, the keys of []."""

    def parts(self, name: str) -> list[str]:
        """Names of the columns of a quantity: 'x', or a joint."""

    def units(self, name: str) -> list[str]:
        """Units of the columns of a quantity; '1' where there is none."""

    @property
    def joints(self) -> list[str]:
        """Names of the joints, the columns of theta."""

    @property
    def dt(self) -> float:
        """Time between two samples [s]."""

    @property
    def t(self) -> NDArray[numpy.float64]:
        """Times of the samples [s], shape (n,), computed as k dt."""

    def csv(self) -> str:
        """The text of a CSV file, with a head that states the origin of the table."""

    def json(self) -> str:
        """The table as JSON text."""

    def hoap(self, robot: Robot) -> str:
        """The text of a HOAP sequence: encoder counts of every motor."""

    def write(self, path: Union[str, PathLike[str]]) -> None:
        """Writes the table as CSV, or as JSON if the name ends in .json. The file is written whole or not at all."""

    def resampled(self, dt: float) -> Table:
        """The table at another rate, interpolated linearly between its rows; `dt` in s."""

    @property
    def unfit(self) -> str:
        """Why no robot should receive the table; '' if there is no known reason."""

    @property
    def disturbances(self) -> str:
        """The disturbances of the run that the table is from; '' where there were none."""

class Task:
    """One pattern for one robot, sampled at the servo period of the robot."""

    @property
    def pattern(self) -> Pattern:
        """The pattern."""

    @property
    def robot(self) -> Robot:
        """The robot."""

    @property
    def profile(self) -> str:
        """Name of the actuator profile."""

    @property
    def series(self) -> Series:
        """The command, sample by sample."""

class TuneFigures:
    """The objective of tune() and its parts."""

    @property
    def objective(self) -> float:
        """Dimensionless, smaller is better."""

    @property
    def recovery(self) -> float:
        """Part of the objective from the pushes that the robot survives."""

    @property
    def unpushed(self) -> float:
        """Part of the objective from the run without a push."""

    @property
    def falls(self) -> int:
        """Number of falls."""

    @property
    def pushes(self) -> int:
        """Number of pushes."""

class Tuning:
    """The result of tune()."""

    @property
    def start(self) -> dict[str, float]:
        """Gains at the start, by name."""

    @property
    def gains(self) -> dict[str, float]:
        """The best gains, by name."""

    @property
    def before(self) -> TuneFigures:
        """Figures at the start."""

    @property
    def after(self) -> TuneFigures:
        """Figures of the best gains."""

    @property
    def choices(self) -> int:
        """Number of choices of gains tried."""

    @property
    def refused(self) -> int:
        """Choices that were skipped because their loop is unstable."""

class Verdict:
    """Whether a pattern is physically consistent, and why not."""

    @property
    def consistent(self) -> bool:
        """Whether the motion and the goals satisfy every limit."""

    def __bool__(self) -> bool:
        ...

    @property
    def reason(self) -> str:
        """Why the pattern is inconsistent, in one line; '' when it is consistent."""

    @property
    def findings(self) -> list[Finding]:
        """The findings, errors first."""

    @property
    def summary(self) -> dict[str, float]:
        """The worst value of every kind of finding, in the unit of the kind."""

    @property
    def profile(self) -> str:
        """Actuator profile that the motion was judged by."""

    @property
    def need(self) -> str:
        """What the actuators lack, in words; '' where they suffice."""

    def to_dict(self) -> Any:
        """The content of `ayumi check --json` as a dict."""

class World:
    """The ground under the robot."""

    def __init__(self) -> None:
        ...

    @property
    def friction(self) -> float:
        """Coefficient of Coulomb friction."""

    @friction.setter
    def friction(self, value: float) -> None: ...

class Wrench:
    """A force or a couple from outside during one step."""

    @property
    def body(self) -> int:
        """Index of the body; -1 if the force acts at the COG."""

    @property
    def point(self) -> NDArray[numpy.float64]:
        """Point of application in the world [m], shape (3,)."""

    @property
    def force(self) -> NDArray[numpy.float64]:
        """Force in world axes [N], shape (3,)."""

    @property
    def torque(self) -> NDArray[numpy.float64]:
        """Moment in world axes [N m], shape (3,)."""

def check(task: Task, *, tolerances: dict[str, float] = {}) -> Verdict:
    """The verdict on a pattern. `tolerances`: values by kind of finding, in place of those of the pattern."""

def controllers() -> list[str]:
    """Names of the control laws."""

def data_folder(name: str) -> Path:
    """Folder of the bundled data: 'robots', 'patterns' or 'examples'."""

def fastest_local_pace(task: Task, *, table: str = 'retimed.csv', margin: Optional[float] = None, keep_pauses: bool = False, progress: Optional[Callable[[str, float, str], Any]] = None) -> LocalPace:
    """The fastest timing along the motion: the motion slows down only where a limit binds. `table` is the name of the table in the result. `margin` [m] is a distance from the edge of the support that is enough for the ZMP. With `keep_pauses`, time spans in which nothing moves keep their duration."""

def fastest_pace(task: Task, *, resolution: float = 0.002, progress: Optional[Callable[[str, float, str], Any]] = None) -> Pace:
    """The fastest uniform time scaling of the pattern that passes the check."""

def gains(robot: Robot, *, poles: Optional[list[complex]] = None, absorb: Optional[float] = None, return_time: Optional[float] = None, zmp_filter: Optional[float] = None, forget: Optional[float] = None, set: dict[str, float] = {}, latency: Optional[float] = None) -> GainStudy:
    """Gains of DTAD. They follow from two `poles` of the COG [1/s], the share of a ZMP error that is absorbed at once, the times [s] of the return to the command and of the filter of the ZMP, and the time [s] until a lasting offset of the ZMP is accepted. `set` gives gains by name. `latency` [s] is the latency of the sensors."""

def identify(robot: Robot, command: Union[Union[str, PathLike[str]], tuple[float, NDArray[numpy.float64]]], measured: Union[Union[str, PathLike[str]], tuple[float, NDArray[numpy.float64]]], *, loads: Optional[Union[str, PathLike[str]]] = None, measured_at: str = 'encoder', per_type: bool = False, stand: str = 'auto', rate: float = 0.0, degrees: bool = False, longest_lag: float = 0.0, threads: int = 0, progress: Optional[Callable[[str, float, str], Any]] = None) -> Identification:
    """The servo constants with which the simulated servos come nearest to what was measured. `command` and `measured` are files, or (dt, angles) with the time between two rows [s] and an array of angles [rad, m], shape (n, dof). `command` are angles of the encoders, as the robot received them. `measured_at` is 'encoder' if the encoders of the robot measured the angles, or 'joint' if instruments at the joints measured them; only such instruments show the offsets of the encoders. `loads` is a file of load cells. With `per_type`, all joints of one motor type get the same constants. `stand` is 'feet', 'fixed' (the root is held upright) or 'auto'. `rate` [1/s] and `degrees` apply to files that do not state their rate or their unit. A recording whose angles are later than `longest_lag` [s] is refused; 0 means 30 ms or twice the lag of the slowest servo, whichever is larger."""

def import_motion(path: Union[str, PathLike[str]], robot: Robot, *, format: str = '', rate: float = 0.0, degrees: bool = False, order: bool = False, joints: list[str] = [], motion: str = '', commands: bool = False, measured_at: str = '', smooth: Optional[float] = None, ground: bool = False, ramp: float = 0.0, contact_height: Optional[float] = None, contact_speed: Optional[float] = None, contact_load: Optional[float] = None) -> Import:
    """Reads a motion of another program or robot, as `ayumi import` does. `format` is one of motion_formats(); without it, the format follows from the content. `rate` [1/s] is the number of rows per second, for rows without times. With `degrees`, angles without a unit in the file are in degrees. With `order`, the columns are the joints of the robot, in the order of the robot. `joints` are the names of the joint columns. `motion` is the name or the number of the motion in a file with several motions. With `commands`, the angles are servo targets. `measured_at` is 'encoder' for angles of the encoders, to which the offsets of the robot are added, 'joint' for angles of the joints, or '' if the format decides. `smooth` is the largest change of an angle by smoothing [deg]. With `ground`, the soles that carry the robot are put on the ground. `ramp` is the time between rest and the speed of a recording that begins or ends in motion [s]. A sole carries the robot when it is at most `contact_height` [m] above the lowest one, slower than `contact_speed` [m/s], and the motion of the COG needs at least `contact_load` times the weight as ground force."""

def jump_pattern(robot: Robot, *, height: Optional[float] = None, stoop: Optional[float] = None, cog_height: Optional[float] = None, forward: Optional[float] = None, times: Optional[int] = None) -> Pattern:
    """Stoop, lift-off, flight, touchdown and settling; all lengths in m."""

def load_robot(name: str, path: list[Union[str, PathLike[str]]] = [], meshes: bool = True) -> Robot:
    """The robot of this name, folder, sidecar or URDF. With `meshes`, the meshes are read too; only pictures need them."""

def load_task(pattern: Union[Pattern, Union[str, PathLike[str]]], *, set: dict[str, float] = {}, profile: str = '', robot: str = '', path: list[Union[str, PathLike[str]]] = [], meshes: bool = True, progress: Optional[Callable[[str, float, str], Any]] = None) -> Task:
    """Reads a pattern (a file, or a Pattern) and its robot, and samples the motion. `set` gives values to parameters that a file declares. `robot` is the name or path of a robot that replaces the robot of the pattern. `path` lists folders with robots. With `meshes`, the meshes are read too; only pictures need them."""

def loci(robot: Robot, logs: dict[str, Log], *, title: str = '', scale: float = 1.5) -> bytes:
    """COG, ZMP and vertical force of runs against time as the bytes of a PNG file. `logs`: runs by the label that the legend has."""

def loci_svg(robot: Robot, logs: dict[str, Log], *, title: str = '') -> str:
    """The same plot as loci(), as the text of an SVG file."""

def make_safe(task: Task, table: Table, log: Optional[Log] = None, *, ramp: float = 2.0, hold: float = 0.5, start: str = 'home') -> SafeTable:
    """Adds an approach of `ramp` s from the posture `start` before a table and a hold of `hold` s after it, and judges what the servos would receive. With a log, it also judges the torques of that run."""

def mirrored(robot: Robot, pattern: Pattern) -> Pattern:
    """The pattern with left and right exchanged."""

def motion_formats() -> list[str]:
    """Names of the formats that import_motion() reads."""

def parse_pattern(text: str, path: Union[str, PathLike[str]] = 'pattern.json', set: dict[str, float] = {}) -> Pattern:
    """Reads a pattern from the text of a file. Messages call this file `path`, and files that the text names are looked for beside `path`."""

def picture(robot: Robot, log: Log, *, at: float = 0.0, width: int = 1280, height: int = 720, view: str = 'iso', zoom: float = 1.0, title: str = '') -> bytes:
    """The run at the time `at` [s] as the bytes of a PNG file. `view`: 'front', 'side', 'iso', 'back', 'top', 'ortho-side' or 'ortho-front'; `width` and `height` in pixels."""

def plan(task: Task) -> Log:
    """The planned motion in the form of a log, without a simulation: posture, COG, ZMP, forces on the feet, and the motor torques that the full model needs. Pictures and plots show it like a run; `outcome`, `hash` and `events` have no meaning for such a motion."""

def push(task: Task, *, controllers: list[str] = [], gains: dict[str, float] = {}, times: list[float] = [], directions: int = 8, step: float = 0.06, cap: float = 2.4, replicas: int = 2, duration: float = 0.02, seed: int = 1, threads: int = 0, progress: Optional[Callable[[str, float, str], Any]] = None) -> PushStudy:
    """The largest push that the robot survives, by phase of the gait and direction, in open loop and with each controller (the controller of the pattern when none is named). `times` [s] replace the default phases. `step` is the resolution of the search, and `cap` is the largest push tried, both as multiples of the capture bound. `replicas` is the number of small variations of every push; the robot must survive all of them. `duration` is the duration of a push [s]. `threads` is the number of threads, and 0 means all; the results do not depend on this number."""

def read_log(path: Union[str, PathLike[str]], name: str = '') -> Log:
    """The log of a file or of the folder that `ayumi run` wrote: 'open_loop', 'closed_loop' (the default) or 'undisturbed'."""

def read_pattern(path: Union[str, PathLike[str]], set: dict[str, float] = {}) -> Pattern:
    """Reads a pattern file. `set` gives values to parameters that the pattern declares."""

def read_table(path: Union[str, PathLike[str]]) -> Table:
    """Reads a table that Ayumi wrote, CSV or JSON."""

def repair(task: Task, *, lock_joints: list[str] = [], lock_feet: list[str] = [], lock_windows: list[tuple[float, float]] = [], weights: dict[str, float] = {}, trust: Optional[str] = None, safety: Optional[float] = None, zmp_margin: Optional[float] = None, max_iterations: Optional[int] = None, progress: Optional[Callable[[str, float, str], Any]] = None) -> Repair:
    """The nearest consistent motion, which bears the payloads of the scenario. Locked joints, feet ('left', 'right') and windows (begin, end) [s] do not move. `weights` are factors on the cost of a change of a joint. `trust` is 'posture', 'cog' or 'zmp'. `zmp_margin` [m] is the wanted distance of the ZMP from the edge of the support. An argument that is not given has the value in the pattern."""

def retimed(robot: Robot, pattern: Pattern, scale: float) -> Pattern:
    """The pattern with all times multiplied by `scale`."""

def robot_picture(robot: Robot, *, posture: str = 'home', theta: Optional[NDArray[numpy.float64]] = None, view: str = 'iso', marks: bool = True) -> bytes:
    """The robot on the ground, in a named posture or at the joint angles `theta` [rad, m], shape (dof,), as the bytes of a PNG file. With `marks`, the picture shows the outlines of the soles, the axes of the joints and an arrow in the direction that the robot faces."""

def robots(path: list[Union[str, PathLike[str]]] = []) -> list[str]:
    """Names of the robots in the folders of `path` and of the bundled ones."""

def sample(pattern: Pattern, robot: Robot, *, profile: str = '', progress: Optional[Callable[[str, float, str], Any]] = None) -> Task:
    """Samples a pattern for a robot that was loaded."""

def simulate(task: Task, *, controller: Optional[str] = None, gains: dict[str, float] = {}, scenario: Optional[Union[bool, Union[str, PathLike[str]]]] = None, noise: bool = False, true_state: bool = False, substeps: int = 1, seed: int = 1, plant: Union[str, Callable[..., Any]] = 'ayumi', targets: Optional[Callable[..., Any]] = None, allow_unstable: bool = False, progress: Optional[Callable[[str, float, str], Any]] = None) -> Log:
    """Simulates the closed loop of plant, sensors and controller. `controller` is a name of controllers(), or None for the controller of the pattern. `gains` are values of gains by name. `scenario` is False for no disturbances, or a pattern file whose scenario replaces the scenario of the pattern. With `noise`, the sensors have noise, bias and latency. With `true_state`, the controller gets the true state. `substeps` is the number of steps of the integrator in a tick. `plant` is 'ayumi', 'mujoco', or a function (robot, profile, world) that returns an object with `state`, `set_state(state)` and `step(targets, input, dt)`, as Plant has them. `targets` is a function (t, estimate, plan, targets). It returns the servo targets as angles of the joints [rad, m], shape (dof,), which replace the targets of the controller; with controller='none', the function is the whole controller. A plant or a controller in Python is called in every tick and makes the run several times slower. `progress` is a function (stage, fraction, detail); the run stops if this function returns False."""

def squat_pattern(robot: Robot, *, depth: Optional[float] = None, period: Optional[float] = None, hold: Optional[float] = None, cycles: Optional[int] = None) -> Pattern:
    """The COG moves down by `depth` m and up again; `hold` s at the lowest point."""

def stand_pattern(robot: Robot, duration: float) -> Pattern:
    """Standing in the home posture for `duration` s."""

def strip(robot: Robot, log: Log, *, times: list[float] = [], count: int = 8, columns: int = 4, width: int = 400, height: int = 600, view: str = 'iso', zoom: float = 1.0, title: str = '') -> bytes:
    """Snapshots side by side as the bytes of a PNG file, at `times` [s] or at `count` instants that Ayumi chooses."""

def support_plot(robot: Robot, logs: dict[str, Log], *, title: str = '', scale: float = 1.5) -> bytes:
    """The ground from above, with soles, COG and ZMP, as the bytes of a PNG file."""

def sway_pattern(robot: Robot, *, side: Optional[float] = None, forward: Optional[float] = None, period: Optional[float] = None, cycles: Optional[int] = None) -> Pattern:
    """The COG moves to and fro over both feet by `side` and `forward` m, one cycle in `period` s."""

def table(task: Task, log: Optional[Log] = None, *, content: str = 'lead') -> Table:
    """The table of a run, or of the pattern itself if no log is given. `content`: 'ideal' (the posture), 'lead' (ahead of the posture by the lag of the servos) or 'lead+sag'."""

def tune(task: Task, *, start: dict[str, float] = {}, times: list[float] = [], directions: int = 4, level: float = 0.9, gains: Optional[list[str]] = None, rounds: int = 3, seed: int = 1, threads: int = 0, progress: Optional[Callable[[str, float, str], Any]] = None) -> Tuning:
    """Searches for better gains of DTAD. `start` are the gains to begin with, and `times` are the times of the pushes [s]. `level` is the size of a push as a multiple of the capture bound. `gains` are the names of the gains that are changed."""

def walk_pattern(robot: Robot, *, steps: Optional[int] = None, stride: Optional[float] = None, period: Optional[float] = None, double_support: Optional[float] = None, lift: Optional[float] = None, cog_height: Optional[float] = None, turn: Optional[float] = None, side: Optional[float] = None, rise: Optional[float] = None) -> Pattern:
    """A walk from rest to rest. stride, lift, cog_height, side and rise (of a stair) are in m, and period is in s. double_support is a share of the period. turn is in rad per step; left is positive. Arguments that are not given follow from the size of the robot."""

def write_clip(robot: Robot, log: Log, path: Union[str, PathLike[str]], *, width: int = 1280, height: int = 720, view: str = 'iso', fps: float = 30.0, speed: float = 1.0, title: str = '', threads: int = 1, progress: Optional[Callable[[str, float, str], Any]] = None) -> int:
    """Writes the run as a film (.mp4, .webm, .gif); needs the program ffmpeg. Returns the number of frames."""
