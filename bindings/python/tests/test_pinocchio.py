"""Eight robots at random states, compared with Pinocchio."""

import json

import numpy as np
import pinocchio as pin
import pytest

import hamel

ROBOTS = ["a1", "double_pendulum", "finger_edu", "iris", "so100", "solo12", "ur5", "z1"]
STATES = 20
# Relative to the largest entry; both compute in double precision.
CLOSE = 1e-11


def close(ours, theirs):
    scale = max(1.0, np.abs(theirs).max(initial=0.0))
    assert np.abs(ours - theirs).max(initial=0.0) < CLOSE * scale


class Pair:
    """A robot in both libraries, with the order of its velocities."""

    def __init__(self, name, robots, reference):
        described = json.loads((reference / "robots" / f"{name}.json").read_text())
        urdf = robots / described["urdf"]
        floating = "root_joint" in described["velocity_order"]
        # All digits of angles are kept; by default 1.57079632679 becomes a right angle.
        self.ours = hamel.System.from_urdf(urdf, floating=floating, mimic="free", rounding=0.0)
        root = pin.JointModelFreeFlyer() if floating else None
        self.model = pin.buildModelFromUrdf(str(urdf), root) if root else pin.buildModelFromUrdf(str(urdf))
        self.model.armature[:] = 0.0
        self.data = self.model.createData()
        # Indices of Pinocchio's velocities in xi.
        self.order = np.zeros(self.model.nv, int)
        for joint in range(1, self.model.njoints):
            own = self.ours.joints[self.model.names[joint]]
            first, count = self.model.idx_vs[joint], self.model.nvs[joint]
            self.order[first : first + count] = np.arange(own.start, own.stop)

    def configuration(self, q):
        given = {}
        for joint in range(1, self.model.njoints):
            first, count = self.model.idx_qs[joint], self.model.nqs[joint]
            part = q[first : first + count]
            name = self.model.names[joint]
            if count == 7:
                rotation = pin.Quaternion(part[6], part[3], part[4], part[5]).toRotationMatrix()
                given[name] = {"position": part[:3], "rotation": rotation}
            elif count == 2:
                given[name] = float(np.arctan2(part[1], part[0]))
            else:
                given[name] = float(part[0])
        return given

    def states(self, count):
        random = np.random.default_rng(5)
        pin.seed(5)
        bound = np.full(self.model.nq, 1.0)
        for _ in range(count):
            q = pin.randomConfiguration(self.model, -bound, bound)
            v, a, f = random.normal(size=(3, self.model.nv))
            x = self.ours.state(configuration=self.configuration(q)).x
            xi, xi_dot, force = (np.zeros_like(v) for _ in range(3))
            xi[self.order], xi_dot[self.order], force[self.order] = v, a, f
            yield q, v, a, f, x, xi, xi_dot, force


@pytest.fixture(params=ROBOTS)
def pair(request, robots, reference):
    return Pair(request.param, robots, reference)


def test_dynamics(pair):
    ours, model, data, order = pair.ours, pair.model, pair.data, pair.order
    for q, v, a, f, x, xi, xi_dot, _ in pair.states(STATES):
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        close(ours.mass_matrix(x)[np.ix_(order, order)], mass)
        bias = ours.bias(x, xi) + ours.potential_force(x)
        close(bias[order], pin.nonLinearEffects(model, data, q, v))
        close(ours.inverse_dynamics(x, xi, xi_dot)[order], pin.rnea(model, data, q, v, a))
        close(ours.kinetic_energy(x, xi), pin.computeKineticEnergy(model, data, q, v))


def test_accelerations_of_many_states_at_once(pair):
    ours, order = pair.ours, pair.order
    if not len(ours.inputs):
        pytest.skip("nothing drives it")
    states = list(pair.states(STATES))
    x, xi = (np.array([state[place] for state in states]) for place in (4, 5))
    u = np.random.default_rng(9).normal(size=(STATES, len(ours.inputs)))
    many = ours.accel(x, xi, u)
    force = ours.generalized_force(x, xi, u)
    for state, found, applied in zip(states, many, force, strict=True):
        q, v = state[:2]
        close(found[order], pin.aba(pair.model, pair.data, q, v, applied[order]))


def test_frames(pair):
    ours, model, data, order = pair.ours, pair.model, pair.data, pair.order
    names = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
    known = [name for name in names if name in ours.frames]
    assert known, (names, ours.frames)
    for name in known[:: max(1, len(known) // 3)]:
        frame = model.getFrameId(name, pin.FrameType.BODY)
        for q, v, _, _, x, xi, *_ in pair.states(3):
            pin.framesForwardKinematics(model, data, q)
            pose = ours.function(f"{name}_pose")(x)
            close(pose[:, :3], data.oMf[frame].rotation)
            close(pose[:, 3], data.oMf[frame].translation)
            jacobian = pin.computeFrameJacobian(model, data, q, frame, pin.LOCAL_WORLD_ALIGNED)
            close(ours.function(f"{name}_jacobian")(x)[:, order], jacobian)
