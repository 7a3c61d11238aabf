"""Compares every robot below TARGET/robots by `hamel eval` with Pinocchio, at one random state each."""

import json
import pathlib
import random
import subprocess
import sys

import numpy as np
import pinocchio as pin

BAR = 1e-11
target = pathlib.Path(sys.argv[1])
hamel = target / "release" / "hamel"
folder = next(target.glob("robots/**/example-robot-data/robots"))


def rotation(draw):
    """A random rotation, from a normalised quaternion."""
    q = np.array([draw.gauss(0, 1) for _ in range(4)])
    return pin.Quaternion(*(q / np.linalg.norm(q))).normalized().toRotationMatrix()


def joints(model):
    """The moving joints, in Pinocchio's order."""
    return list(zip(model.names, model.joints))[1:]


def state(model, draw):
    """Returns (q, v) of Pinocchio and the same state by joints; None for joints that are not compared."""
    q, v = pin.neutral(model), np.zeros(model.nv)
    configuration, velocity = {}, {}
    for name, joint in joints(model):
        at, speed = joint.idx_q, joint.idx_v
        if joint.nv == 6:
            turn, place = rotation(draw), [draw.uniform(-1, 1) for _ in range(3)]
            q[at : at + 3] = place
            q[at + 3 : at + 7] = pin.Quaternion(turn).coeffs()
            turn = pin.Quaternion(q[at + 3 : at + 7]).toRotationMatrix()
            twist = [draw.uniform(-1, 1) for _ in range(6)]
            v[speed : speed + 6] = twist
            configuration[name] = {"position": place, "rotation": turn.tolist()}
            velocity[name] = {"linear": twist[:3], "angular": twist[3:]}
        elif joint.nv == 1:
            angle, rate = draw.uniform(-1, 1), draw.uniform(-1, 1)
            q[at : at + joint.nq] = [angle] if joint.nq == 1 else [np.cos(angle), np.sin(angle)]
            v[speed] = rate
            configuration[name], velocity[name] = angle, rate
        else:
            return None
    return q, v, {"configuration": configuration, "velocity": velocity}


def order(model, rows):
    """The index in Pinocchio's v of each row."""
    places, taken = [], {}
    ids = dict(joints(model))
    for row in rows:
        joint = ids[row]
        places.append(joint.idx_v + taken.setdefault(row, 0))
        taken[row] += 1
    return places


def error(a, b):
    return np.max(np.abs(a - b), initial=0.0) / max(np.max(np.abs(b), initial=0.0), 1e-300)


worst = {"M": 0.0, "bias": 0.0, "accel": 0.0}
compared, refused, wrong = 0, [], []
for urdf in sorted(folder.rglob("*.urdf")):
    for floating in (False, True):
        name = f"{urdf.relative_to(folder)}{' --floating' if floating else ''}"
        root = [pin.JointModelFreeFlyer()] if floating else []
        draw = random.Random(name)
        try:
            model = pin.buildModelFromUrdf(str(urdf), *root)
        except Exception as why:
            refused.append(f"{name}: not read by Pinocchio: {why}")
            continue
        found = state(model, draw)
        if found is None or model.nv == 0:
            refused.append(f"{name}: nothing to compare")
            continue
        q, v, given = found
        data = model.createData()
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pin.nonLinearEffects(model, data, q, v)
        tau = np.array([draw.uniform(-1, 1) for _ in range(model.nv)])
        options = ["--rounding", "0", "--mimic", "free"] + (["--floating"] if floating else [])
        command = [str(hamel), "eval", str(urdf), *options, "--at", "-"]

        def run(state):
            return subprocess.run(command, input=json.dumps(state), capture_output=True, text=True)

        first = run(given)
        if first.returncode != 0:
            refused.append(f"{name}: {first.stderr.strip().splitlines()[-1]}")
            continue
        places = order(model, json.loads(first.stdout)["velocities"])
        output = json.loads(run(given | {"force": tau[places].tolist()}).stdout)
        errors = {
            "M": error(np.array(output["M"]), mass[np.ix_(places, places)]),
            "bias": error(np.array(output["bias"]), bias[places]),
        }
        if output["accel"] is not None:
            expected = np.linalg.solve(mass, tau - bias)[places]
            errors["accel"] = error(np.array(output["accel"]), expected) / np.linalg.cond(mass)
        compared += 1
        for key, value in errors.items():
            worst[key] = max(worst[key], value)
        if any(not value < BAR for value in errors.values()):
            wrong.append(f"{name}: {errors}")

print("\n".join(refused))
print(f"{compared} robots compared; worst: " + ", ".join(f"{k} {v:.1e}" for k, v in worst.items()))
print("\n".join(wrong))
sys.exit(1 if wrong else 0)
