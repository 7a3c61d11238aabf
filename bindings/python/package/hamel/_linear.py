"""Linear systems near a state: steps, modes, zeros, regulators, and the hand-over to python-control and SciPy."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._hamel import HamelError, Linear

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


class Mode(NamedTuple):
    """Eigenvalue of A with the states that move in it; of a conjugate pair, the one above the real axis."""

    value: complex
    states: list[str]
    #: Whether the inputs reach it.
    reachable: bool
    #: Whether the outputs show it.
    observable: bool


class Regulator(NamedTuple):
    """Regulator u = -K x: gain K (m, n), cost matrix X (n, n), and the poles of the closed loop (n,)."""

    K: Array
    X: Array
    poles: ComplexArray


@dataclass(frozen=True)
class Linearization:
    """Linear model d/dt (h, δξ) = A (h, δξ) + B δu, δy = C (h, δξ) + D δu of the motion near a state.

    h are displacements along the columns of A(x), δξ changes of the velocities. With n `states`, m `inputs` and p
    `outputs`, A is (n, n), B (n, m), C (p, n), D (p, m), and `eigenvalues` (n,).

    It unpacks into A, B, C, D, and in steps also their length, as python-control and SciPy take them:
    `control.ss(*linear, **linear.names)`, `scipy.signal.StateSpace(*linear)`.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: list[str]
    inputs: list[str]
    outputs: list[str]
    #: Eigenvalues of A (1/s), the fastest growing first.
    eigenvalues: ComplexArray
    #: Accelerations at the state. If they are not zero, the matrices hold for this instant only.
    xi_dot: Array
    #: Length of a step (s), if A and B give the next state instead of its rate.
    step: float | None = None

    def __iter__(self) -> Iterator[Any]:
        """Iterate over A, B, C, D, and the length of a step if there is one."""
        yield from (self.A, self.B, self.C, self.D)
        if self.step is not None:
            yield self.step

    @property
    def names(self) -> dict[str, list[str]]:
        """Names of states, inputs and outputs, as keywords of `control.ss`."""
        return {"states": self.states, "inputs": self.inputs, "outputs": self.outputs}

    @classmethod
    def from_ss(cls, system: Any) -> Linearization:
        """Convert a `StateSpace` of python-control, with its names."""
        a, b, c, d = (np.array(getattr(system, name), dtype=float, ndmin=2) for name in "ABCD")
        # In python-control, `True` is a step of unknown length, taken as 1 s.
        step = None if not system.dt else float(system.dt)
        states, inputs, outputs = (list(getattr(system, f"{kind}_labels")) for kind in ("state", "input", "output"))
        poles = Linear([a, b, c, d], step, [states, inputs, outputs]).poles()
        return cls(a, b, c, d, states, inputs, outputs, poles, np.zeros(0), step)

    def _linear(self) -> Linear:
        matrices = [np.ascontiguousarray(part, dtype=float) for part in (self.A, self.B, self.C, self.D)]
        return Linear(matrices, self.step, [self.states, self.inputs, self.outputs])

    def discrete(self, h: float) -> Linearization:
        """Return the system in steps of h (s), exact for inputs that are held between them.

        [A_d B_d; 0 I] = exp([A B; 0 0] h). For derivatives of the steps of an integrator, see `System.step_slopes`.
        """
        h = float(h)
        if self.step is not None:
            raise HamelError("the system is in steps already")
        if not 0 < h < math.inf:
            raise HamelError("h has to be greater than zero, and finite")
        a, b = self._linear().discretized(h)
        found = replace(self, A=a, B=b, step=h)
        return replace(found, eigenvalues=found._linear().poles())

    def poles(self) -> ComplexArray:
        """Return the eigenvalues of A (n,)."""
        return self.eigenvalues.copy()

    def zeros(self) -> ComplexArray:
        """Return the invariant zeros: transmission zeros, and modes that are not reached or not shown."""
        return self._linear().zeros()

    def modes(self) -> list[Mode]:
        """Return the modes, the fastest growing first, conjugate pairs once."""
        return [Mode(*mode) for mode in self._linear().modes()]

    def lqr(self, Q: ArrayLike, R: ArrayLike) -> Regulator:
        """Return the regulator u = -K x with the least integral of xᵀ Q x + uᵀ R u, or sum over the steps.

        Q is (n, n) and R (m, m), or their diagonals.

        Raises
        ------
        HamelError
            If modes that do not decay are not reached by the inputs, or modes that neither decay nor grow have no
            weight, with the names of their states; if weights are negative.
        """
        q, r = (np.array(weight, dtype=float, ndmin=1) for weight in (Q, R))
        square = [np.diag(weight) if weight.ndim == 1 else weight for weight in (q, r)]
        return Regulator(*self._linear().regulator(*square))
