"""Forward dynamics of a robot at many states: medians of interleaved runs, after a comparison of the results."""

import ctypes
import statistics
import sys
import time

import numpy as np
import pinocchio as pin

import hamel

STATES = 100_000
REPEATS = 15
# Fewer states for single calls, which are slower.
SINGLE = 5_000


def numbers(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def in_cpp(path, model):
    """Forward dynamics in C++: one variant for each convention."""
    library = ctypes.CDLL(path)
    library.chain.restype = ctypes.c_void_p
    n = model.nv
    axes = np.array(["XYZ".index(joint.shortname()[-1]) for joint in list(model.joints)[1:]], np.int32)
    poses = [np.hstack([at.rotation.T.ravel(), at.translation]) for at in list(model.jointPlacements)[1:]]
    bodies = [
        np.hstack([body.mass, body.lever, body.inertia[[0, 0, 1, 0, 1, 2], [0, 1, 1, 2, 2, 2]]])
        for body in list(model.inertias)[1:]
    ]
    assert list(model.parents)[1:] == list(range(n))
    arm = library.chain(ctypes.c_size_t(n), numbers(axes), numbers(np.array(poses)), numbers(np.array(bodies)))

    def way(world):
        def run(q, v, tau):
            out = np.empty_like(v)
            places = [numbers(array) for array in (q, v, tau, out)]
            library.accelerations(ctypes.c_void_p(arm), ctypes.c_bool(world), ctypes.c_size_t(len(q)), *places)
            return out

        return run

    return way(False), way(True)


def main(urdf, wheel, native):
    robot = hamel.System.from_urdf(urdf, rounding=0.0)
    model = pin.buildModelFromUrdf(urdf)
    data = model.createData()
    n = model.nv
    q, v, tau = np.random.default_rng(1).normal(size=(3, STATES, n))
    of_wheel, for_machine = in_cpp(wheel, model), in_cpp(native, model)

    def one_by_one(call):
        return lambda q, v, tau: np.array([call(*row) for row in zip(q[:SINGLE], v[:SINGLE], tau[:SINGLE])])

    ways = {
        "hamel, arrays": robot.accel,
        "loop in C++, the wheel, LOCAL": of_wheel[0],
        "loop in C++, the wheel, WORLD": of_wheel[1],
        "loop in C++, for this machine, LOCAL": for_machine[0],
        "loop in C++, for this machine, WORLD": for_machine[1],
        "hamel, one by one": one_by_one(robot.accel),
        "pin.aba, one by one": one_by_one(lambda q, v, tau: pin.aba(model, data, q, v, tau).copy()),
    }
    expected = ways["loop in C++, the wheel, LOCAL"](q, v, tau)
    scale = np.abs(expected).max(axis=1, keepdims=True)
    times = {name: [] for name in ways}
    for name, way in ways.items():
        found = way(q, v, tau)
        difference = (np.abs(found - expected[: len(found)]) / scale[: len(found)]).max()
        assert difference < 1e-9, (name, difference)
    for _ in range(REPEATS):
        for name, way in ways.items():
            begin = time.perf_counter()
            found = way(q, v, tau)
            times[name].append((time.perf_counter() - begin) / len(found) * 1e9)
    own = statistics.median(times["hamel, arrays"])
    print(f"Forward dynamics of a UR5, {STATES} states; ns for a state, median of {REPEATS}\n")
    print("| | ns | beside hamel's arrays |\n|---|---|---|")
    for name, all_times in times.items():
        median = statistics.median(all_times)
        print(f"| {name} | {median:.0f} | {median / own:.2f} |")


main(*sys.argv[1:])
