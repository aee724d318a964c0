"""Author a motion, check it, repair it, simulate it, and write the table for the robot.

    python3 examples/python/author_and_check.py OUT
"""

# %% A squat that is too fast for the robot
import pathlib
import sys

import ayumi

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/python_squat")
out.mkdir(parents=True, exist_ok=True)

robot = ayumi.load_robot("hoap1")
pattern = ayumi.squat_pattern(robot, depth=0.04, period=0.7, cycles=1)
task = ayumi.sample(pattern, robot)
print(f"{robot.name}: {robot.mass:.2f} kg, {len(robot.joints)} joints, "
      f"a motion of {pattern.duration:.2f} s in {len(task.series)} samples")

# %% Is it physically consistent?
verdict = ayumi.check(task)
print("consistent" if verdict else verdict.reason)
for finding in verdict.findings:
    if finding.severity == "error":
        print(f"  {finding.kind} at {finding.at:.3f} s, {finding.where}: "
              f"{finding.worst:.3g} {finding.unit}, limit {finding.limit:.3g} {finding.unit}")

# %% The nearest consistent motion
repaired = ayumi.repair(task)
print(f"{repaired.status}: {repaired.where} moves most, "
      f"by {1e3 * repaired.max_joint_change:.1f} mrad at {repaired.at:.2f} s")
if not repaired.ok:
    sys.exit("; ".join(repaired.reasons))
repaired.task.pattern.write(out / "squat.json")

# %% Does the robot stay upright?
log = ayumi.simulate(repaired.task)
print(f"the robot {log.outcome}; largest tilt of the trunk {log.max_tilt:.4f} rad")

# %% The table for the robot
safe = ayumi.make_safe(repaired.task, ayumi.table(repaired.task, log), log)
if not safe.safe or safe.table.unfit:
    sys.exit("; ".join([safe.table.unfit, *safe.violations]))
safe.table.write(out / "squat.csv")
(out / "squat.hoap.csv").write_text(safe.table.hoap(robot))
print(f"written to {out}: squat.json, squat.csv, squat.hoap.csv")
