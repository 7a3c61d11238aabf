"""Linear systems against python-control and SciPy: steps, zeros, modes, regulators, names."""

import subprocess
import sys
from pathlib import Path

import control
import numpy as np
import pytest
import scipy.linalg as sl

import hamel

ROOT = Path(__file__).parents[3]

CART_POLE = """
system CartPole {
    param mc = 1, mp = 0.1, l = 0.5, g = 9.81;
    coord p, th;
    velocity v, w;
    rate p = v;
    rate th = w;
    particle mass mc at [p, 0, 0];
    particle mass mp at [p + l * sin(th), 0, l * cos(th)];
    gravity [0, 0, -g];
    input F;
    generalized force v = F;
    output place = p, tip = p + l * sin(th);
}
"""


def chain(n):
    """n masses on springs and dampers between two walls, pushed at the first."""
    springs = " ".join(f"spring stiffness {10 + k} on q[{k + 1}]{f' - q[{k}]' if k else ''};" for k in range(n))
    masses = " ".join(f"particle mass {1 + 0.1 * k} at [q[{k + 1}], {k}, 0];" for k in range(n))
    return (
        f"system Chain {{ coord q: R{n}; velocity v: vec{n}; rate q = v; input F; {masses} {springs} "
        f"generalized force v = [F - 0.1 * v[1]{', 0' * (n - 1)}]; output last = q[{n}]; }}"
    )


def systems():
    """Linearisations of mechanisms at rest."""
    yield hamel.System.from_text(CART_POLE).linearize()
    furuta = hamel.System.from_file(ROOT / "examples/gallery/furuta.eom")
    yield furuta.linearize({"coord": {"swing": np.pi}, "velocity": {"arm_dot": 0.0}})
    drone = hamel.System.from_file(ROOT / "tests/models/drone.eom")
    yield drone.linearize()


def random_system(rng, kind, stepped):
    """A random system of a kind, with the number of its unreachable states."""
    n, m, p = (int(rng.integers(1, most)) for most in (13, 4, 4))
    off, t = 0, np.ones(n)
    A, B, C = rng.standard_normal((n, n)), rng.standard_normal((n, m)), rng.standard_normal((p, n))
    D = rng.standard_normal((p, m)) * rng.integers(2)
    if kind == "scaled":
        t = 10.0 ** rng.uniform(-6, 6, n)
        A, B, C = A * t[:, None] / t, B * t[:, None], C / t
    elif kind == "unreachable":
        off = n // 2
        k = n - off
        A[k:, :k] = B[k:] = 0
        A[k:, k:] -= np.eye(off) * (1 + np.abs(np.linalg.eigvals(A[k:, k:]).real).max(initial=0))
        if stepped:
            A /= 1.1 * max(1, np.abs(np.linalg.eigvals(A[k:, k:])).max(initial=0))
        turn = np.linalg.qr(rng.standard_normal((n, n)))[0]
        A, B, C = turn @ A @ turn.T, turn @ B, C @ turn.T
    elif kind == "integrators":
        A, B = np.eye(n, k=1) + np.eye(n) * stepped, np.eye(n, 1, k=1 - n)
        D = np.zeros((p, 1))
    elif kind == "springs":
        h = (n + 1) // 2
        n, t = 2 * h, np.ones(2 * h)
        A = np.block([[np.zeros((h, h)), np.eye(h)], [10 * rng.standard_normal((h, h)), np.zeros((h, h))]])
        A, B = (A, A[:, :1] * 0) if not stepped else (np.eye(n) + 0.05 * A, A[:, :1] * 0)
        B[h:, 0], C, D = rng.standard_normal(h), np.eye(1, n), np.zeros((1, 1))
    system = control.ss(A, B, C, D, 0.1) if stepped else control.ss(A, B, C, D)
    return system, t, off


KINDS = ["plain", "scaled", "unreachable", "integrators", "springs"]


def reference(A, B, Q, R, stepped):
    """X of SciPy, refined by Newton's method with SciPy's equations of Lyapunov and Stein; None if SciPy fails."""
    try:
        X = (sl.solve_discrete_are if stepped else sl.solve_continuous_are)(A, B, Q, R)
        for _ in range(4):
            K = gain(A, B, X, R, stepped)
            closed = A - B @ K
            if stepped:
                residual = Q + K.T @ R @ K + closed.T @ X @ closed - X
                X = X + sl.solve_discrete_lyapunov(closed.T, (residual + residual.T) / 2)
            else:
                residual = Q + K.T @ R @ K + closed.T @ X + X @ closed
                X = X + sl.solve_continuous_lyapunov(closed.T, -(residual + residual.T) / 2)
        return X
    except (np.linalg.LinAlgError, ValueError):
        return None


def gain(A, B, X, R, stepped):
    return np.linalg.solve(R + B.T @ X @ B, B.T @ X @ A) if stepped else np.linalg.solve(R, B.T @ X)


def residual(A, B, Q, R, X, stepped):
    """The residual of Riccati's equation, relative to its terms."""
    K = gain(A, B, X, R, stepped)
    terms = [A.T @ X @ A, -X, Q, -A.T @ X @ B @ K] if stepped else [A.T @ X, X @ A, Q, -X @ B @ K]
    return np.linalg.norm(sum(terms)) / sum(np.linalg.norm(term) for term in terms)


@pytest.mark.parametrize("kind", KINDS)
def test_regulators_of_random_systems(kind):
    rng = np.random.default_rng(KINDS.index(kind))
    compared = 0
    for number in range(100):
        stepped = bool(number % 2)
        system, t, _ = random_system(rng, kind, stepped)
        n, m = system.B.shape
        L, N = rng.standard_normal((n, n)), rng.standard_normal((m, m))
        Q, R = (L @ L.T if number % 3 else np.diag(10.0 ** rng.uniform(-2, 2, n))) / np.outer(t, t), N @ N.T + np.eye(m)
        K, X, poles = hamel.Linearization.from_ss(system).lqr(Q, R)
        # In states of similar size, in which SciPy is accurate.
        A, B, Q, X, K = system.A / t[:, None] * t, system.B / t[:, None], Q * np.outer(t, t), X * np.outer(t, t), K * t
        expected = reference(A, B, Q, R, stepped)
        # Where an unstable mode is hardly reached, rounding leaves more, of SciPy's refined solution as well.
        left = 1e-8 if expected is None else 10 * residual(A, B, Q, R, expected, stepped)
        assert residual(A, B, Q, R, X, stepped) < max(1e-12, left), (kind, number)
        assert np.allclose(X, X.T, rtol=0, atol=1e-12 * np.abs(X).max())
        assert np.linalg.norm(K - gain(A, B, X, R, stepped)) < 1e-9 * np.linalg.norm(K)
        assert (np.abs(poles).max() < 1) if stepped else (poles.real.max() < 0)
        # A solution with a residual of rounding is off by that times the condition of Lyapunov's equation.
        if expected is None or np.linalg.cond(expected) > 1e7 or residual(A, B, Q, R, expected, stepped) > 1e-14:
            continue
        assert np.linalg.norm(X - expected) < 1e-9 * np.linalg.norm(expected), (kind, number)
        compared += 1
    assert compared > 60, compared


@pytest.mark.parametrize("kind", KINDS)
def test_modes_and_zeros_of_random_systems(kind):
    rng = np.random.default_rng(10 + KINDS.index(kind))
    for number in range(60):
        system, t, off = random_system(rng, kind, False)
        linear = hamel.Linearization.from_ss(system)
        modes = linear.modes()
        count = sum(1 + (mode.value.imag > 0) for mode in modes if not mode.reachable)
        assert count == off, (kind, number)
        pairs = [value for mode in modes for value in {mode.value, mode.value.conjugate()}]
        assert len(pairs) == len(linear.A) or kind == "integrators"
        # At a zero the pencil loses rank.
        A, B, C, D = system.A / t[:, None] * t, system.B / t[:, None], system.C * t, system.D
        pencil = np.block([[A, B], [C, D]])
        shift = sl.block_diag(np.eye(len(A)), np.zeros(D.shape))
        usual = np.linalg.matrix_rank(pencil - (0.31 + 0.47j) * shift, tol=1e-9)
        for zero in linear.zeros():
            sizes = np.linalg.svd(pencil - zero * shift, compute_uv=False)
            assert sizes[usual - 1] < 1e-7 * sizes[0] * (1 + abs(zero)), (kind, number, zero)
        if usual == len(pencil) == len(pencil.T):
            alpha, beta = sl.eigvals(pencil, shift, homogeneous_eigvals=True)
            finite = np.abs(beta) > 1e-8 * np.abs(alpha)
            assert len(linear.zeros()) == np.count_nonzero(finite), (kind, number)


@pytest.mark.parametrize("kind", KINDS)
def test_steps_of_random_systems(kind):
    rng = np.random.default_rng(20 + KINDS.index(kind))
    for number in range(60):
        system, t, _ = random_system(rng, kind, False)
        h = 10.0 ** rng.uniform(-4, 0)
        found = hamel.Linearization.from_ss(system).discrete(h)
        m = system.B.shape[1]
        whole = np.block([[system.A / t[:, None] * t, system.B / t[:, None]], [np.zeros((m, len(t) + m))]])
        expected = sl.expm(whole * h)
        scale = np.linalg.norm(expected)
        assert np.linalg.norm(found.A / t[:, None] * t - expected[: -m, : -m]) < 1e-12 * scale, (kind, number)
        assert np.linalg.norm(found.B / t[:, None] - expected[: -m, -m:]) < 1e-12 * scale, (kind, number)
        assert np.array_equal(found.C, system.C) and np.array_equal(found.D, system.D)


def test_mechanisms_agree_with_python_control():
    for linear in [*systems(), hamel.System.from_text(chain(6)).linearize()]:
        system = control.ss(*linear, **linear.names)
        n, m = linear.B.shape
        K, X, poles = control.lqr(system, np.eye(n), np.eye(m))
        found = linear.lqr(np.ones(n), np.ones(m))
        assert np.allclose(found.X, X, rtol=0, atol=1e-9 * np.abs(X).max())
        assert np.allclose(found.K, K, rtol=0, atol=1e-9 * np.abs(K).max())
        assert np.allclose(np.sort_complex(found.poles), np.sort_complex(poles), rtol=0, atol=1e-5 * np.abs(poles).max())
        discrete = linear.discrete(0.02)
        sampled = control.c2d(system, 0.02)
        assert np.allclose(discrete.A, sampled.A, rtol=0, atol=1e-12 * np.abs(sampled.A).max())
        assert np.allclose(discrete.B, sampled.B, rtol=0, atol=1e-12 * np.abs(sampled.B).max())
        K, X, _ = control.dlqr(control.ss(*discrete), np.eye(n), np.eye(m))
        found = discrete.lqr(np.eye(n), np.eye(m))
        assert np.allclose(found.X, X, rtol=0, atol=1e-9 * np.abs(X).max())
        assert np.allclose(found.K, K, rtol=0, atol=1e-9 * np.abs(K).max())


def test_systems_of_python_control_come_back():
    linear = hamel.System.from_text(CART_POLE).linearize()
    for one in (linear, linear.discrete(0.05)):
        system = control.ss(*one, **one.names)
        back = hamel.Linearization.from_ss(system)
        for name in "ABCD":
            assert np.array_equal(getattr(back, name), getattr(one, name))
        assert back.names == one.names and back.step == one.step
        assert np.array_equal(back.eigenvalues, one.eigenvalues)
    # Two zeros ±√(g/l) from the force to the cart's place.
    zeros = hamel.Linearization.from_ss(system := control.ss(*linear, **linear.names)[0, 0]).zeros()
    assert np.allclose(np.sort(zeros.real), [-np.sqrt(9.81 / 0.5), np.sqrt(9.81 / 0.5)], rtol=1e-12)
    assert system.nstates == 4


@pytest.mark.parametrize("step", [[], ["--step", "0.1"]])
def test_written_programs_make_the_system(step, tmp_path):
    description = tmp_path / "cart.eom"
    description.write_text(CART_POLE)
    for text in (CART_POLE, CART_POLE.replace("output place = p, tip = p + l * sin(th);", "")):
        description.write_text(text)
        words = ["linearize", str(description), "--format", "python", *step]
        program = subprocess.run([sys.executable, "-m", "hamel", *words], capture_output=True, text=True, check=True)
        scope = {}
        exec(program.stdout, scope)
        linear = hamel.System.from_text(text).linearize()
        expected = linear.discrete(0.1) if step else linear
        system = scope["sys"]
        assert np.array_equal(system.A, expected.A) and np.array_equal(system.B, expected.B)
        assert system.state_labels == linear.states and system.input_labels == linear.inputs
        assert system.output_labels == (linear.outputs or linear.states)
        assert np.array_equal(system.C, linear.C if linear.outputs else np.eye(4))
        assert system.dt == (0.1 if step else 0)


def test_what_cannot_be_done_is_said():
    linear = hamel.System.from_text(CART_POLE).linearize()
    with pytest.raises(hamel.HamelError, match="greater than zero"):
        linear.discrete(0)
    with pytest.raises(hamel.HamelError, match="in steps already"):
        linear.discrete(0.1).discrete(0.1)
    with pytest.raises(hamel.HamelError, match="grows beyond all numbers"):
        linear.discrete(1e9)
    with pytest.raises(hamel.HamelError, match="Q has to be symmetric, with 4 rows"):
        linear.lqr(np.eye(3), [1])
    with pytest.raises(hamel.HamelError, match="Q has to be symmetric"):
        linear.lqr(np.triu(np.ones((4, 4))), [1])
    with pytest.raises(hamel.HamelError, match="positive weight"):
        linear.lqr(np.eye(4), [0])
    with pytest.raises(hamel.HamelError, match="must not be negative"):
        linear.lqr([1, 1, -1, 1], [1])
    with pytest.raises(hamel.HamelError, match="not finite"):
        linear.lqr([1, 1, np.nan, 1], [1])
    with pytest.raises(hamel.HamelError, match=r"have no weight.*0 of h\(v\)"):
        linear.lqr([0, 1, 1, 1], [1])
    alone = control.ss([[0, 1, 0], [0, 0, 0], [0, 0, 0.5]], [[0], [1], [0]], np.eye(3), np.zeros((3, 1)))
    with pytest.raises(hamel.HamelError, match=r"do not reach them: 0.5 of x\[2\]"):
        hamel.Linearization.from_ss(alone).lqr(np.eye(3), [1])
