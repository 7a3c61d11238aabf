"""MuJoCo on a free body and on a top in a ball joint; prints JSON for the report.

    python lab/peers/mujoco_peer.py tests/reference

MuJoCo's Euler, implicit and RK4 in double precision, compared with the reference solutions in the folder. Times are
medians over repeated whole runs, each a single call of mj_step for all of its steps, so that Python's overhead does
not count.
"""

import json
import statistics
import sys
import time

import mujoco
import numpy as np

# Case, length of the run, and whether the body has a fixed point.
CASES = [
    ("heavy-top-benchmark-150", 1.0, True),
    # Without Kovalevskaya's top, one of whose moments of inertia about the centre of mass is zero, which MuJoCo
    # refuses.
    ("lagrange-fast-top", 5.0, True),
    ("free-dzhanibekov-1e-3", 100.0, False),
]
# Evaluations per step, and order; that of RK4 on rotations was 2 in older versions, and is measured as 4 here.
INTEGRATORS = [("Euler", 1, 1), ("implicit", 1, 1), ("RK4", 4, None)]
STEPS = [200 * 2**k for k in range(8)]
REPEATS = 5


def numbers(value):
    return np.array(value, dtype=float)


def quaternion(matrix):
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, matrix.flatten())
    return quat


def build(reference, joint, integrator):
    """The model, with its inertia about the centre of mass."""
    parameters = reference["parameters"]
    inertia = numbers(parameters["J"])
    mass = float(parameters.get("m", 1.0))
    centre = numbers(parameters.get("s", [0, 0, 0]))
    gravity = numbers(parameters.get("g", [0, 0, 0]))
    about = inertia - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre)) if joint else inertia
    full = [about[0, 0], about[1, 1], about[2, 2], about[0, 1], about[0, 2], about[1, 2]]
    text = lambda values: " ".join(repr(float(value)) for value in values)
    kind = '<joint type="ball" damping="0"/>' if joint else "<freejoint/>"
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco>
        <compiler balanceinertia="false" boundmass="0" boundinertia="0"/>
        <option integrator="{integrator}" gravity="{text(gravity)}"><flag contact="disable"/></option>
        <worldbody><body>{kind}
        <inertial pos="{text(centre)}" mass="{mass!r}" fullinertia="{text(full)}"/>
        </body></worldbody></mujoco>"""
    )


def start(model, data, reference, joint):
    mujoco.mj_resetData(model, data)
    rotation = numbers(reference["initial"]["R"]).reshape(3, 3)
    omega = numbers(reference["initial"]["omega"])
    # Both joints have the angular velocity in body axes.
    data.qpos[-4:] = quaternion(rotation)
    data.qvel[-3:] = omega


def main(folder):
    # Warnings are in the data, and must not be mixed with the output.
    mujoco.set_mju_user_warning(lambda message: None)
    cases = []
    for name, until, joint in CASES:
        with open(f"{folder}/{name}.json") as file:
            reference = json.load(file)
        sample = next(s for s in reference["samples"] if float(s["t"]) == until)
        end = numbers(sample["R"]).flatten()
        methods = []
        for integrator, evaluations, order in INTEGRATORS:
            model = build(reference, joint, integrator)
            data = mujoco.MjData(model)
            runs = []
            for steps in STEPS:
                model.opt.timestep = until / steps
                times = []
                for _ in range(REPEATS):
                    start(model, data, reference, joint)
                    begin = time.perf_counter()
                    mujoco.mj_step(model, data, nstep=steps)
                    times.append(time.perf_counter() - begin)
                rotation = np.zeros(9)
                mujoco.mju_quat2Mat(rotation, data.qpos[-4:])
                error = float(np.linalg.norm(rotation - end))
                run = {
                    "steps": steps,
                    "evaluations": evaluations * steps,
                    "seconds": float(f"{statistics.median(times):.2e}"),
                }
                if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number > 0:
                    run["failure"] = "unstable, MuJoCo starts anew"
                elif np.isfinite(error):
                    run["error"] = float(f"{error:.2e}")
                else:
                    run["failure"] = "not finite"
                runs.append(run)
            methods.append({"method": f"MuJoCo {integrator}", "kind": "peer", "order": order, "runs": runs})
        cases.append({"case": name, "methods": methods})
    print(json.dumps({"version": mujoco.__version__, "cases": cases}))


if __name__ == "__main__":
    main(sys.argv[1])
