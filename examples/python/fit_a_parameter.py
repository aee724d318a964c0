"""Find what a robot carries: the mass on its left forearm, from the torques of its ankles.

    python3 examples/python/fit_a_parameter.py

A recording is made with a mass that the fit does not know, and with noise. SciPy then changes the
mass of the simulated robot until its torques are those of the recording.
"""

# %% What is known: the robot stands
import json
import sys

import numpy as np

import ayumi

try:
    from scipy.optimize import minimize_scalar
except ImportError:
    print("this example needs scipy (Debian's package python3-scipy)")
    sys.exit(77)

robot = ayumi.load_robot("hoap1", meshes=False)
stand = ayumi.stand_pattern(robot, 0.1).to_dict()
forearm = "l_forearm"
ankles = [robot.joints.index(name) for name in ("l_ankle_pitch", "r_ankle_pitch",
                                                 "l_ankle_roll", "r_ankle_roll")]


def ankle_torques(mass):
    """Torques of the ankles [N m] of the robot that has stood with `mass` [kg] for half a second."""
    carried = {"type": "payload", "at": 0, "duration": 10, "on": forearm, "mass": mass}
    pattern = ayumi.parse_pattern(json.dumps({**stand, "scenario": [carried] if mass > 0 else []}))
    log = ayumi.simulate(ayumi.sample(pattern, robot))
    return log["torque"][500:, ankles]


# %% The recording
TRUE_MASS = 0.25  # [kg]
noise = np.random.default_rng(1).normal(0, 0.01, ankle_torques(TRUE_MASS).shape)  # [N m]
recorded = ankle_torques(TRUE_MASS) + noise


# %% The fit
def difference(mass):
    """Mean square of what is left of the torques [(N m)^2]."""
    return np.mean((ankle_torques(mass) - recorded) ** 2)


found = minimize_scalar(difference, bounds=(0.0, 0.6), method="bounded",
                        options={"xatol": 1e-3, "maxiter": 15})
print(f"the robot carries {found.x:.3f} kg on {forearm} ({TRUE_MASS} kg are true), "
      f"after {found.nfev} simulations; what is left is {np.sqrt(found.fun):.4f} N m")
if abs(found.x - TRUE_MASS) > 0.01:
    sys.exit("the mass was not found")
