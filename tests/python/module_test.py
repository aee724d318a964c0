"""The Python module: its values against the program's, its arrays, errors, progress and Ctrl-C, and
plants and controllers that are written in Python."""

import copy
import gc
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import numpy as np

import ayumi

WALK = ayumi.data_folder("patterns") / "hoap1_walk.json"
PROGRAM = os.environ["AYUMI_PROGRAM"]

# A shell starts its background jobs so that they ignore Ctrl-C, and Python does not change this.
signal.signal(signal.SIGINT, signal.default_int_handler)


def walk(**options):
    return ayumi.load_task(WALK, meshes=False, **options)


def short_stand(seconds=0.2):
    robot = ayumi.load_robot("hoap1", meshes=False)
    return ayumi.sample(ayumi.stand_pattern(robot, seconds), robot)


def program(*words):
    """The JSON object that the program prints."""
    done = subprocess.run([PROGRAM, *map(str, words), "--json", "-q"], capture_output=True)
    return json.loads(done.stdout)


class Values(unittest.TestCase):
    """The module is the library of the program: the same input gives the same figures."""

    def test_check_is_that_of_the_program(self):
        said = program("check", WALK)
        found = ayumi.check(walk())
        self.assertEqual(found.to_dict()["verdict"], said["verdict"])
        self.assertEqual(found.to_dict()["summary"], said["summary"])
        self.assertTrue(found)
        self.assertEqual(found.reason, "")

    def test_a_tolerance_changes_the_verdict(self):
        self.assertFalse(ayumi.check(walk(), tolerances={"joint_torque": 0.1}))
        with self.assertRaises(ayumi.Error):
            ayumi.check(walk(), tolerances={"no_such_kind": 1})

    def test_simulation_is_that_of_the_program(self):
        said = program("simulate", WALK)
        log = ayumi.simulate(walk())
        self.assertEqual(log.hash, said["log_hash"])
        self.assertEqual(log.outcome, said["outcome"])
        self.assertEqual(log.max_tilt, said["max_tilt_rad"])

    def test_repair_makes_a_pattern_consistent(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        # The motion is so fast that the knees cannot follow.
        task = ayumi.sample(ayumi.squat_pattern(robot, period=0.64, depth=0.04, cycles=1), robot)
        self.assertIn("joint_speed", ayumi.check(task).reason)
        found = ayumi.repair(task, lock_joints=["l_elbow"])
        self.assertEqual(found.status, "repaired")
        self.assertTrue(ayumi.check(found.task))
        self.assertGreater(found.max_joint_change, 1e-4)
        elbow = robot.joints.index("l_elbow")
        np.testing.assert_array_equal(found.task.series["theta"][:, elbow],
                                      task.series["theta"][:, elbow])
        # The written pattern reads back as the same repaired motion.
        again = ayumi.sample(ayumi.parse_pattern(found.task.pattern.text()), robot)
        np.testing.assert_allclose(again.series["theta"], found.task.series["theta"], atol=1e-12)

    def test_a_repair_has_to_bear_the_payloads(self):
        words = {"format": "ayumi.pattern/1", "robot": "hoap1",
                 "phases": [{"until": 2, "support": "both"}],
                 "keyframes": [{"t": 0, "zmp": "center"}],
                 "scenario": [{"type": "payload", "at": 0.5, "on": "r_forearm", "mass": 60}]}
        robot = ayumi.load_robot("hoap1", meshes=False)
        found = ayumi.repair(ayumi.sample(ayumi.parse_pattern(json.dumps(words)), robot))
        self.assertFalse(found.ok, "the robot alone stands, but not with 60 kg")
        self.assertTrue(any("60 kg" in reason for reason in found.reasons), found.reasons)

    def test_the_fastest_pace_passes_and_is_bounded(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        task = ayumi.sample(ayumi.squat_pattern(robot, cycles=1), robot)
        pace = ayumi.fastest_pace(task)
        self.assertTrue(pace.found and pace.bounded)
        self.assertLess(pace.scale, 1)
        self.assertTrue(ayumi.check(ayumi.sample(
            ayumi.retimed(robot, task.pattern, pace.scale), robot)))

    def test_the_fastest_local_pace_is_quicker_and_passes(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        task = ayumi.sample(ayumi.squat_pattern(robot, cycles=1, hold=1), robot)
        uniform = ayumi.fastest_pace(task)
        local = ayumi.fastest_local_pace(task)
        self.assertTrue(local.found)
        self.assertLess(local.scale, uniform.scale)
        self.assertTrue(ayumi.check(ayumi.sample(local.pattern, robot)))
        self.assertAlmostEqual(sum(share for _, share in local.binding), 1)
        kept = ayumi.fastest_local_pace(task, keep_pauses=True)
        self.assertTrue(kept.found)
        self.assertGreater(kept.scale, local.scale)
        self.assertIn("pause", [limit for limit, _ in kept.binding])

    def test_gains_are_those_of_the_program(self):
        said = program("gains", "hoap1")
        study = ayumi.gains(ayumi.load_robot("hoap1", meshes=False))
        self.assertEqual(study.gains, said["gains"])
        self.assertEqual(study.omega, said["omega_1_s"])
        self.assertEqual([[p.real, p.imag] for p in study.poles], said["poles_1_s"])
        self.assertTrue(study.stable)
        self.assertFalse(ayumi.gains(ayumi.load_robot("hoap1", meshes=False),
                                     set={"ka": 3 * study.largest_ka}).stable)

    def test_push_limits_are_those_of_the_program(self):
        options = ["--times", "3.1", "--directions", "2", "--replicas", "0", "--cap", "0.6"]
        said = program("push", WALK, *options)
        study = ayumi.push(walk(), times=[3.1], directions=2, replicas=0, cap=0.6)
        self.assertEqual([case.limits[0] for case in study.cases],
                         [t["impulse_Ns"] for t in said["thresholds"]
                          if t["controller"] == study.controllers[0]])
        self.assertTrue(study.picture().startswith(b"\x89PNG"))


class Arrays(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.task = walk()
        cls.log = ayumi.simulate(cls.task, scenario=False)

    def test_every_array_has_parts_and_units(self):
        for samples in (self.log, self.task.series, ayumi.table(self.task, self.log)):
            for name in samples.names:
                array = samples[name]
                self.assertEqual(array.shape[0], len(samples), name)
                if array.ndim == 2:
                    self.assertEqual(len(samples.units(name)), array.shape[1], name)
                    self.assertEqual(len(samples.parts(name)), array.shape[1], name)
        self.assertEqual(self.log.units("cog"), ["m", "m", "m"])
        self.assertEqual(self.log.parts("theta"), self.task.robot.joints)
        self.assertEqual(self.log.units("torque")[0], "N m")
        with self.assertRaises(KeyError):
            self.log["no such quantity"]

    def test_arrays_are_views(self):
        log = self.log
        self.assertIs(log["cog"].base, log)
        # A number and a vector are read directly from the samples: both have the same stride.
        self.assertEqual(log["cog"].strides[0], log["fz"].strides[0])
        self.assertEqual(log["theta"].ctypes.data, log["theta"].ctypes.data)
        for name in log.names:
            self.assertFalse(log[name].flags.owndata, name)
            with self.assertRaises(ValueError):
                log[name][0] = 0
        self.assertIs(self.task.robot.lower.base.__class__, ayumi.Robot)
        self.assertFalse(self.task.robot.actuators().speed.flags.owndata)

    def test_an_array_keeps_its_owner(self):
        task = short_stand()
        theta = task.series["theta"]
        cog = task.series["cog"]
        before = theta.copy(), cog.copy()
        robot_limits = task.robot.upper
        upper = robot_limits.copy()
        del task
        gc.collect()
        junk = [short_stand(0.05) for _ in range(3)]
        np.testing.assert_array_equal(theta, before[0])
        np.testing.assert_array_equal(cog, before[1])
        np.testing.assert_array_equal(robot_limits, upper)
        del junk

    def test_values_agree_with_the_exported_columns(self):
        with tempfile.TemporaryDirectory() as folder:
            table = ayumi.table(self.task, self.log)
            path = pathlib.Path(folder) / "table.csv"
            table.write(path)
            again = ayumi.read_table(path)
            for name in table.names:
                np.testing.assert_array_equal(again[name], table[name])
            self.assertEqual(again.csv(), table.csv())
            lines = path.read_text().splitlines()
            head = next(line for line in lines if not line.startswith("#")).split(",")
            column = head.index("cog.z[m]")
            first = lines[lines.index(",".join(head)) + 1].split(",")
            self.assertEqual(float(first[column]), table["cog"][0, 2])

    def test_a_log_is_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "run.bin"
            self.log.write(path)
            again = ayumi.read_log(path)
            self.assertEqual(again.hash, self.log.hash)
            np.testing.assert_array_equal(again["torque"], self.log["torque"])

    def test_series_agrees_with_kinematics(self):
        series, robot = self.task.series, self.task.robot
        for k in (0, len(series) // 3, len(series) - 1):
            state = ayumi.RobotState(series["theta"][k], position=series["base.position"][k],
                                     attitude=series["base.attitude"][k])
            # The tolerance of 1e-6 m is that of the plan's inverse kinematics.
            np.testing.assert_allclose(robot.sole_pose(state, "left"), series["left.sole"][k],
                                       atol=1e-6)
            np.testing.assert_allclose(robot.cog(state), series["cog"][k], atol=1e-6)


class Tables(unittest.TestCase):
    def test_the_table_of_a_fallen_run_says_so(self):
        task = walk()
        fallen = ayumi.simulate(task, controller="none",
                                scenario=self.hard_push())
        self.assertEqual(fallen.outcome, "fell")
        self.assertIn("fell", ayumi.table(task, fallen).unfit)
        self.assertIn("fell", ayumi.table(task, fallen).csv())
        good = ayumi.table(task)
        self.assertEqual(good.unfit, "")
        self.assertIn(task.robot.joints[0], good.csv())

    def hard_push(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        pattern = ayumi.stand_pattern(ayumi.load_robot("hoap1", meshes=False), 1.0).to_dict()
        pattern["scenario"] = [{"type": "impulse", "at": 0.5, "duration": 0.02, "on": "cog",
                                "impulse": 20.0, "direction": [0, 1, 0]}]
        path = pathlib.Path(folder.name) / "push.json"
        path.write_text(json.dumps(pattern))
        return path

    def test_ramp_and_hold(self):
        task = walk()
        safe = ayumi.make_safe(task, ayumi.table(task))
        self.assertTrue(safe.safe, safe.violations)
        self.assertGreater(len(safe.table), len(task.series))
        # The file has encoder counts, one line per row.
        self.assertGreaterEqual(len(safe.table.hoap(task.robot).splitlines()), len(safe.table))
        for times in ({"ramp": 61}, {"ramp": -1}, {"hold": float("nan")}, {"hold": 1e9}):
            with self.assertRaisesRegex(ayumi.Error, "it must be from 0 to 60 s"):
                ayumi.make_safe(task, ayumi.table(task), **times)
        for dt in (0, -1, float("nan"), float("inf"), 1e-9):
            with self.assertRaisesRegex(ayumi.Error, "a table cannot have rows every"):
                ayumi.table(task).resampled(dt)

    def test_a_table_is_of_the_robot_of_its_run(self):
        other = ayumi.load_robot("humanoid30")
        log = ayumi.plan(ayumi.sample(ayumi.squat_pattern(other, cycles=1), other))
        with self.assertRaisesRegex(ayumi.Error, "the run has other joints than robot 'hoap1'"):
            ayumi.table(walk(), log)
        with self.assertRaisesRegex(ayumi.Error, "but the robot 'hoap1' has"):
            ayumi.support_plot(walk().robot, {"other": log})


class Errors(unittest.TestCase):
    def test_code_and_place(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "bad.json"
            text = json.loads(ayumi.read_pattern(WALK).text())
            text["phases"][2]["until"] = "soon"
            path.write_text(json.dumps(text))
            with self.assertRaises(ayumi.Error) as caught:
                ayumi.load_task(path)
        self.assertEqual(caught.exception.code, "bad_pattern")
        self.assertTrue(caught.exception.place.startswith(str(path)), caught.exception.place)
        self.assertIn("/phases/2/until", caught.exception.place)
        self.assertIn(caught.exception.place, str(caught.exception))

    def test_a_file_that_is_not_there(self):
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.read_pattern("/nowhere/walk.json")
        self.assertEqual(caught.exception.code, "bad_file")
        self.assertEqual(caught.exception.place, "/nowhere/walk.json")
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.read_pattern("/no where/walk.json")
        self.assertEqual(caught.exception.place, "/no where/walk.json")
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.load_robot("no_such_robot")
        self.assertEqual(caught.exception.code, "bad_file")

    def test_places_do_not_depend_on_the_words_of_a_message(self):
        with tempfile.TemporaryDirectory() as folder:
            # The name contains ": ".
            path = pathlib.Path(folder) / "new: walk.json"
            path.write_text('{"format": 1}')
            with self.assertRaises(ayumi.Error) as caught:
                ayumi.read_pattern(path)
            self.assertEqual(caught.exception.place, str(path) + ": /format")
            # The legs cannot do the first phase, because the COG is too high.
            text = json.loads(ayumi.read_pattern(WALK).text())
            text["defaults"]["cog_height"] = 0.4
            path.write_text(json.dumps(text))
            with self.assertRaises(ayumi.Error) as caught:
                ayumi.load_task(path)
            self.assertEqual(caught.exception.place, str(path) + ": /defaults/cog_height")
            # The error is in a line of a table.
            table = pathlib.Path(folder) / "motion"
            table.write_text("t,r_knee\n0,0\n0.1,nan\n0.2,0\n")
            with self.assertRaises(ayumi.Error) as caught:
                ayumi.import_motion(table, ayumi.load_robot("hoap1", meshes=False))
            self.assertEqual(caught.exception.place, f"{table}:3")
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.read_pattern("nowhere")  # the name looks like no path
        self.assertEqual(caught.exception.place, "nowhere")

    def test_wrong_calls(self):
        task = short_stand()
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.simulate(task, controller="magic")
        self.assertEqual(caught.exception.code, "usage")
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.push(task, times=[99])
        self.assertEqual(caught.exception.place, "")  # "push: a push at 99 s ..." names no file
        with self.assertRaises(ayumi.Error) as caught:
            ayumi.simulate(task, gains={"ka": 50})
        self.assertIn("allow_unstable", str(caught.exception))
        with self.assertRaises(TypeError):
            ayumi.simulate(task, no_such_option=1)

    def test_numbers_out_of_bounds(self):
        """The library has the bounds of the command line, and names the value and the bound."""
        task, nan, inf = short_stand(), float("nan"), float("inf")
        robot = task.robot
        angles = (0.001, np.zeros((10, len(robot.joints))))
        log = ayumi.plan(task)
        for call, words in (
                (lambda: ayumi.simulate(task, substeps=2**31 - 1), "servo period is 2147483647; "),
                (lambda: ayumi.push(task, cap=inf), "largest push is inf capture bounds; "),
                (lambda: ayumi.push(task, step=1e-300), "resolution of the search is 1e-300 "),
                (lambda: ayumi.tune(task, rounds=10**9), r"number of rounds is 1e\+09; "),
                (lambda: ayumi.tune(task, threads=-1), "number of threads is -1; "),
                (lambda: ayumi.fastest_pace(task, resolution=nan), "resolution of the scale is nan"),
                (lambda: ayumi.fastest_pace(task, resolution=0), "resolution of the scale is 0; "),
                (lambda: ayumi.fastest_local_pace(task, margin=nan), "margin of the ZMP is nan m; "),
                (lambda: ayumi.fastest_local_pace(task, table="a\0b"), "needs a file name"),
                (lambda: ayumi.identify(robot, angles, angles, longest_lag=1e300),
                 r"longest lag of a servo is 1e\+300 s; "),
                (lambda: ayumi.identify(robot, angles, angles, threads=-5), "threads is -5; "),
                (lambda: ayumi.repair(task, max_iterations=-1), "number of iterations is -1; "),
                (lambda: ayumi.repair(task, safety=nan), "weight of safety is nan; "),
                (lambda: ayumi.repair(task, zmp_margin=nan), "margin of the ZMP is nan m; "),
                (lambda: ayumi.strip(robot, log, count=10**9), r"snapshots is 1e\+09; "),
                (lambda: ayumi.strip(robot, log, columns=-1), "number of columns is -1; "),
                (lambda: ayumi.robot_picture(robot, theta=np.full(len(robot.joints), nan)),
                 "every joint needs a finite number"),
                (lambda: ayumi.walk_pattern(robot, cog_height=-1), "or 0 for the usual height"),
                (lambda: ayumi.gains(robot, absorb=1), "a short-term absorption of 1 ")):
            with self.assertRaisesRegex(ayumi.Error, words) as caught:
                call()
            self.assertEqual(caught.exception.code, "usage")
            self.assertNotIn("--", str(caught.exception))

    def test_states_are_finite(self):
        theta = np.zeros(20)
        with self.assertRaisesRegex(ayumi.Error, "position of the state has the value nan at index 1"):
            ayumi.RobotState(theta, position=[0, np.nan, 0])
        with self.assertRaisesRegex(ayumi.Error, "attitude of the state has the length 0; "):
            ayumi.RobotState(theta, attitude=(0, 0, 0, 0))


class LongWork(unittest.TestCase):
    def test_progress_is_heard_and_can_stop(self):
        heard = []
        ayumi.simulate(short_stand(), progress=lambda *event: heard.append(event))
        self.assertTrue(heard)
        stage, fraction, _ = heard[-1]
        self.assertEqual(stage, "simulating with dtad")
        self.assertTrue(0 <= fraction <= 1)
        with self.assertRaises(ayumi.Interrupted):
            ayumi.simulate(short_stand(), progress=lambda *event: False)

    def test_what_a_callback_raises_comes_out(self):
        def fails(*_):
            raise ValueError("from the callback")

        task = short_stand()
        with self.assertRaisesRegex(ValueError, "from the callback"):
            ayumi.simulate(task, progress=fails)
        with self.assertRaisesRegex(ValueError, "from the callback"):
            ayumi.push(task, times=[0.1], directions=2, threads=2, progress=fails)

    def test_ctrl_c_stops_a_simulation(self):
        task = walk()
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        begin = time.monotonic()
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while time.monotonic() < begin + 60:
                ayumi.simulate(task, substeps=20)
        timer.join()

    def test_ctrl_c_stops_snapshots(self):
        task = walk()
        log = ayumi.simulate(task)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        times = [0.05 * i for i in range(100)]
        begin = time.monotonic()
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while time.monotonic() < begin + 60:
                ayumi.strip(task.robot, log, times=times, columns=10, width=800, height=1200)
        self.assertLess(time.monotonic() - begin, 5)  # all of them take longer
        timer.join()

    def test_other_threads_run_during_a_simulation(self):
        task = walk()
        self.assert_other_threads_run(lambda: ayumi.simulate(task, substeps=4))

    def test_other_threads_run_while_files_are_written_and_read(self):
        task = walk()
        log = ayumi.simulate(task)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "log.bin"

            def write_and_read():
                for _ in range(4):
                    log.write(path)
                    ayumi.read_log(path)

            self.assert_other_threads_run(write_and_read)

    def assert_other_threads_run(self, work):
        counted = [0]
        done = threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.001)

        other = threading.Thread(target=count)
        other.start()
        before = counted[0]
        work()
        during = counted[0] - before
        done.set()
        other.join()
        # The work takes more than 0.1 s. If the lock were held, the other thread would stand still.
        self.assertGreater(during, 20)


class OffsetPlant:
    """Ayumi's own plant, with a constant error on the targets of one joint."""

    def __init__(self, robot, profile, world, offset):
        self.inner = ayumi.Plant(robot, profile, world)
        self.offset = offset
        self.steps = 0

    @property
    def state(self):
        return self.inner.state

    def set_state(self, state):
        self.inner.set_state(state)

    def step(self, targets, input, dt):
        self.steps += 1
        changed = targets.copy()
        changed[0] += self.offset
        return self.inner.step(changed, input, dt)


class InTheLoop(unittest.TestCase):
    def setUp(self):
        self.task = short_stand()
        self.caught = warnings.catch_warnings(record=True)
        self.warned = self.caught.__enter__()
        warnings.simplefilter("always")

    def tearDown(self):
        self.caught.__exit__(None, None, None)

    def test_a_plant_in_python_that_is_ayumis_gives_the_same_run(self):
        own = ayumi.simulate(self.task)
        log = ayumi.simulate(self.task, plant=lambda *about: OffsetPlant(*about, 0.0))
        np.testing.assert_array_equal(log["theta"], own["theta"])
        np.testing.assert_array_equal(log["fz"], own["fz"])
        self.assertEqual(log.plant, "python")
        self.assertTrue(any("several times as long" in str(w.message) for w in self.warned))

    def test_a_plant_in_python_moves_the_robot(self):
        own = ayumi.simulate(self.task)
        log = ayumi.simulate(self.task, plant=lambda *about: OffsetPlant(*about, 0.05))
        # The servo of the joint settles near its offset target [rad].
        self.assertGreater(abs(log["theta"][-1, 0] - own["theta"][-1, 0]), 0.03)

    def test_the_robot_of_a_plant_outlives_its_run(self):
        robots = []

        def make(robot, profile, world):
            robots.append(robot)
            return OffsetPlant(robot, profile, world, 0.0)

        ayumi.simulate(short_stand(0.05), plant=make)
        gc.collect()
        self.assertEqual(robots[0].joints, self.task.robot.joints)

    def test_copies_of_a_plant_are_independent(self):
        robot = self.task.robot
        plant = OffsetPlant(robot, "", ayumi.World(), 0.0)
        plant.set_state(robot.rest_state())
        height = plant.state.position[2]
        twin = copy.deepcopy(plant)
        plant.step(np.array(robot.posture()), ayumi.StepInput(), 0.001)
        self.assertEqual((plant.steps, twin.steps), (1, 0))
        self.assertEqual(twin.state.position[2], height)
        self.assertNotEqual(plant.state.position[2], height)

    def test_a_controller_function_sees_estimate_and_plan(self):
        seen = []

        def hold(t, estimate, plan, targets):
            seen.append((t, estimate.fz, plan.support))
            return targets

        own = ayumi.simulate(self.task, controller="none")
        log = ayumi.simulate(self.task, controller="none", targets=hold)
        np.testing.assert_array_equal(log["theta"], own["theta"])
        self.assertEqual(len(seen), len(log))
        self.assertEqual(seen[0][2], "both")
        self.assertGreater(seen[-1][1], 10)  # the robot's weight is on its feet [N]
        self.assertTrue(any(event.kind == "controller" for event in log.events))

    def test_a_controller_function_moves_the_robot(self):
        arm = self.task.robot.joints.index("l_elbow")

        def wave(t, estimate, plan, targets):
            targets = targets.copy()
            targets[arm] -= 0.2
            return targets

        own = ayumi.simulate(self.task)
        log = ayumi.simulate(self.task, targets=wave)
        # The tolerance is 1e-4 rad, because the arm moves the COG, to which the controller responds
        # slightly.
        np.testing.assert_allclose(log["target"][:, arm], own["target"][:, arm] - 0.2, atol=1e-4)
        self.assertLess(log["theta"][-1, arm], own["theta"][-1, arm] - 0.1)

    def test_wrong_sizes_and_errors(self):
        with self.assertRaisesRegex(ayumi.Error, "joints"):
            ayumi.simulate(self.task, targets=lambda *_: np.zeros(3))
        with self.assertRaisesRegex(ayumi.Error, r"targets: .* \(dof,\), but it is <class 'str'>"):
            ayumi.simulate(self.task, targets=lambda *_: "straight")

        class WithoutReport(OffsetPlant):
            def step(self, *_):
                return None

        with self.assertRaisesRegex(ayumi.Error, "must return an ayumi.StepReport"):
            ayumi.simulate(self.task, plant=lambda *about: WithoutReport(*about, 0.0))

        class WithoutTorques(OffsetPlant):
            def step(self, targets, input, dt):
                super().step(targets, input, dt)
                return ayumi.StepReport(np.full(len(targets), np.nan), [], [])

        with self.assertRaisesRegex(ayumi.Error, "reports a torque of nan. Numbers below 1e6 .* "
                                    "the step began 0.000 s after the plant's start"):
            ayumi.simulate(self.task, plant=lambda *about: WithoutTorques(*about, 0.0))

        def fails(*_):
            raise ValueError("from the controller")

        with self.assertRaisesRegex(ValueError, "from the controller"):
            ayumi.simulate(self.task, targets=fails)


class Pictures(unittest.TestCase):
    def test_png_bytes(self):
        task = ayumi.load_task(WALK)
        log = ayumi.simulate(task, scenario=False)
        shot = ayumi.picture(task.robot, log, at=1.0, width=320, height=240)
        self.assertTrue(shot.startswith(b"\x89PNG"))
        self.assertEqual(int.from_bytes(shot[16:20], "big"), 320)
        for at in (-0.1, log.t[-1] + 0.1, float("nan")):
            with self.assertRaisesRegex(ayumi.Error, "the run is from 0 to"):
                ayumi.picture(task.robot, log, at=at)
        for plot in (ayumi.loci(task.robot, {"walk": log}),
                     ayumi.support_plot(task.robot, {"walk": log})):
            self.assertTrue(plot.startswith(b"\x89PNG"))
        self.assertIn("<svg", ayumi.loci_svg(task.robot, {"walk": log}))


    def test_a_picture_needs_no_room_for_shaders(self):
        # Mesa maps a file of its cache of shaders, and the system ended Python (SIGBUS) when this
        # file did not fit on the disk.
        mount = 'mount -t tmpfs -o size=64k none "$0"'
        with tempfile.TemporaryDirectory() as folder:
            def shell(text):
                return subprocess.run(["unshare", "-Urm", "sh", "-c", text, folder, sys.executable],
                                      env={**os.environ, "XDG_CACHE_HOME": folder}, capture_output=True)

            if shell(mount).returncode != 0:
                self.skipTest("a small file system cannot be mounted here")
            drawn = shell(mount + ' && exec "$1" -c "import ayumi; '
                          "print(ayumi.robot_picture(ayumi.load_robot('hoap1'))[1:4])\"")
            self.assertEqual((drawn.returncode, drawn.stdout), (0, b"b'PNG'\n"), drawn.stderr)

    def test_a_plan_is_drawn_without_a_simulation(self):
        robot = ayumi.load_robot("hoap1")
        task = ayumi.sample(ayumi.squat_pattern(robot, cycles=1), robot)
        plan = ayumi.plan(task)
        self.assertEqual(len(plan), len(task.series))
        np.testing.assert_array_equal(plan["theta"], task.series["theta"])
        self.assertGreater(np.abs(plan["torque"]).max(), 0.1)
        self.assertTrue(ayumi.picture(robot, plan, at=0.5, width=320, height=240).startswith(b"\x89PNG"))
        self.assertIn("<svg", ayumi.loci_svg(robot, {"plan": plan}))

    def test_a_robot_in_a_posture(self):
        robot = ayumi.load_robot("hoap1")
        home = ayumi.robot_picture(robot)
        self.assertTrue(home.startswith(b"\x89PNG"))
        self.assertEqual(ayumi.robot_picture(robot, theta=robot.posture()), home)
        self.assertNotEqual(ayumi.robot_picture(robot, marks=False), home)
        self.assertNotEqual(ayumi.robot_picture(robot, theta=np.zeros(len(robot.joints))), home)
        with self.assertRaisesRegex(ayumi.Error, "theta has 3 values, but robot 'hoap1' has 20"):
            ayumi.robot_picture(robot, theta=np.zeros(3))


class Recordings(unittest.TestCase):
    def test_an_imported_motion_is_that_of_the_program(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            subprocess.run([PROGRAM, "export", WALK, "--format", "choreonoid", "--interval", "10",
                            "-o", folder / "walk.seq", "-q"], check=True,
                           stdout=subprocess.DEVNULL)
            said = program("import", folder / "walk.seq", "--robot", "hoap1", "-o", folder / "a.json")
            found = ayumi.import_motion(folder / "walk.seq", robot)
            self.assertEqual(found.format, "choreonoid")
            self.assertIn(found.format, ayumi.motion_formats())
            self.assertEqual(found.reason, said["format_reason"])
            self.assertEqual(found.rows, said["rows"])
            self.assertEqual(found.notes, said["filled"])
            self.assertEqual([(c.foot, c.begin, c.end) for c in found.contacts],
                             [(c["foot"], c["begin_s"], c["end_s"]) for c in said["contacts"]])
            found.write(folder / "b.json")
            self.assertEqual((folder / "b.csv").read_bytes(), (folder / "a.csv").read_bytes())
            task = ayumi.sample(found.pattern, robot)
            again = ayumi.load_task(folder / "a.json", meshes=False)
            np.testing.assert_array_equal(task.series["theta"], again.series["theta"])

    def test_a_file_of_another_robot_is_an_error(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        with tempfile.TemporaryDirectory() as scratch:
            file = pathlib.Path(scratch) / "a.motion"
            file.write_text("#WEBOTS_MOTION,V1.0,A,B\n00:00:000,a,0,0\n00:00:040,b,0,0\n")
            with self.assertRaisesRegex(ayumi.Error, "motion of another robot") as raised:
                ayumi.import_motion(file, robot)
            self.assertEqual(raised.exception.code, "bad_file")
            self.assertEqual(raised.exception.place, str(file))
            nan = float("nan")
            for options, words in (({"rate": nan}, "rate of the rows is nan 1/s; "),
                                   ({"ramp": nan}, "time of the ramp is nan s; "),
                                   ({"ramp": 1e9}, "time of the ramp is 1e.09 s; "),
                                   ({"smooth": -1}, "change by smoothing is -1 deg; "),
                                   ({"contact_height": nan}, "carries the robot is nan m; ")):
                with self.assertRaisesRegex(ayumi.Error, words):
                    ayumi.import_motion(file, robot, **options)

    def test_servos_are_found_in_a_simulated_recording(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        task = ayumi.sample(ayumi.squat_pattern(robot, depth=0.03, cycles=2), robot)
        log = ayumi.simulate(task, controller="none")
        sent, answered = (log.dt, log["target"]), (log.dt, log["theta"])
        seen = set()
        found = ayumi.identify(robot, sent, answered, progress=lambda stage, *_: seen.add(stage))
        self.assertEqual([j.joint for j in found.joints], robot.joints)
        self.assertAlmostEqual(found.seconds, log.t[-1], places=9)
        knee = found.joints[robot.joints.index("l_knee")]
        self.assertTrue(knee.moved)
        self.assertLess(knee.mean_error, 1e-4)
        text = found.sidecar("hoap1", "mine")
        self.assertEqual(json.loads(text)["base"], "hoap1")
        with tempfile.TemporaryDirectory() as scratch:
            file = pathlib.Path(scratch) / "mine.json"
            file.write_text(text)
            self.assertEqual(ayumi.load_robot(str(file), meshes=False).joints, robot.joints)
        # Only angles that were measured at the joints show offsets of the encoders.
        further = (log.dt, log["theta"] + 0.005)
        def offset(at):
            found = ayumi.identify(robot, sent, further, measured_at=at).sidecar("hoap1")
            groups = {group["joints"][0]: group for group in json.loads(found)["servos"]}
            return groups["l_knee"].get("offset")
        self.assertAlmostEqual(offset("joint"), 0.005, places=3)
        self.assertIsNone(offset("encoder"))
        with self.assertRaisesRegex(ayumi.Error, "one of encoder and joint"):
            offset("motor")
        with self.assertRaisesRegex(ayumi.Error, "measured: 3 columns, but robot 'hoap1' has 20"):
            ayumi.identify(robot, sent, (log.dt, np.zeros((5, 3))))
        with self.assertRaisesRegex(ayumi.Error, "one of auto, feet and fixed"):
            ayumi.identify(robot, sent, answered, stand="hands")


class Authoring(unittest.TestCase):
    def test_generated_patterns_are_consistent(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        for pattern in (ayumi.walk_pattern(robot, steps=2), ayumi.stand_pattern(robot, 0.5),
                        ayumi.sway_pattern(robot, cycles=1), ayumi.squat_pattern(robot, cycles=1)):
            verdict = ayumi.check(ayumi.sample(pattern, robot))
            self.assertTrue(verdict, f"{pattern.name}: {verdict.reason}")

    def test_mirrored_twice_is_the_same(self):
        robot = ayumi.load_robot("hoap1", meshes=False)
        pattern = ayumi.walk_pattern(robot, steps=2)
        twice = ayumi.mirrored(robot, ayumi.mirrored(robot, pattern))
        self.assertEqual(twice.text(), pattern.text())

    def test_text_is_read_back(self):
        pattern = ayumi.read_pattern(WALK)
        self.assertEqual(ayumi.parse_pattern(pattern.text()).text(), pattern.text())
        self.assertAlmostEqual(ayumi.retimed(ayumi.load_robot("hoap1", meshes=False), pattern,
                                             2).duration, 2 * pattern.duration)


if __name__ == "__main__":
    unittest.main()
