"""Balances a pole on a cart: linearisation, optimal feedback, and the nonlinear motion with it.

    python balance.py [FOLDER]

writes balance.svg to the folder.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import hamel

CART_POLE = """
/// A pole on a cart; the angle is measured from the upright.
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
    start th = 0.4;
}
"""


def main(folder: Path) -> None:
    system = hamel.System.from_text(CART_POLE)
    upright = system.linearize({"coord": {"th": 0.0}})
    print("eigenvalues without control:", np.round(upright.eigenvalues, 3))

    # The feedback F = -K (p, th, v, w) that minimises the weighted squares of states and force (LQR).
    gain = upright.lqr([10.0, 10.0, 1.0, 1.0], [1.0]).K

    def law(t: float, x: NDArray[np.float64], xi: NDArray[np.float64]) -> NDArray[np.float64]:
        force: NDArray[np.float64] = -gain @ np.concatenate([x, xi])
        return force

    run = system.simulate(8.0, inputs=law, spacing=0.02)
    end = np.abs(np.concatenate([run.x[-1], run.xi[-1]])).max()
    print(f"after {run.t[-1]:g} s nothing is larger than {end:.1e} ({run.method}, {run.evaluations} evaluations)")
    assert end < 1e-2

    figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
    axes.plot(run.t, run["p"], label="cart (m)")
    axes.plot(run.t, run["th"], label="pole (rad)")
    axes.set_xlabel("t (s)")
    axes.legend()
    figure.savefig(folder / "balance.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
