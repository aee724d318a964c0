"""Plot a pushed walk with Matplotlib, beside pictures that Ayumi draws.

    python3 examples/python/plot_a_run.py OUT
"""

# %% The run, with and without the balance controller
import pathlib
import sys

import ayumi

try:
    import matplotlib

    matplotlib.use("Agg")  # draws into files, without a window
    import matplotlib.pyplot as plt
except ImportError:
    print("this example needs matplotlib (Debian's package python3-matplotlib)")
    sys.exit(77)

out = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "out/python_plot")
out.mkdir(parents=True, exist_ok=True)

task = ayumi.load_task(ayumi.data_folder("patterns") / "hoap1_walk.json")
runs = {"open loop": ayumi.simulate(task, controller="none"), "dtad": ayumi.simulate(task)}

# %% COG and ZMP to the side, and the torques of a knee; names and units come from the log
figure, (side, knee) = plt.subplots(2, 1, sharex=True, figsize=(9, 6))
for label, log in runs.items():
    column = log.parts("cog").index("y")
    side.plot(log.t, log["cog"][:, column], label=f"COG, {label}")
    joint = log.joints.index("l_knee")
    knee.plot(log.t, log["torque"][:, joint], label=label)
dtad = runs["dtad"]
side.plot(dtad.t, dtad["zmp"][:, 1], linewidth=0.5, label="ZMP, dtad")
side.set_ylabel(f"y [{dtad.units('cog')[1]}]")
knee.set_ylabel(f"torque of l_knee [{dtad.units('torque')[joint]}]")
knee.set_xlabel("t [s]")
for axes in (side, knee):
    for event in dtad.events:
        if event.kind == "push":
            axes.axvline(event.t, color="grey", linestyle=":")
    axes.legend(loc="upper left", fontsize="small")
figure.savefig(out / "walk.png", dpi=120)

# %% Ayumi's own pictures are PNG bytes
(out / "strip.png").write_bytes(ayumi.strip(task.robot, dtad, count=4, width=320, height=240))
(out / "loci.png").write_bytes(ayumi.loci(task.robot, runs))
print(f"{', '.join(f'{label} {log.outcome}' for label, log in runs.items())}; "
      f"written to {out}: walk.png, strip.png, loci.png")
