"""Maps the amplitudes and frequencies of a vibrating pivot for which a pendulum stands upright.

    python kapitza.py [FOLDER] [--points 120]

runs the pendulum from near the upright for every amplitude and frequency of a grid, on all cores, and writes
kapitza.png with the boundary of the linear theory (Floquet), which is integrated separately.
"""

import argparse
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import polars as pl
from numpy.typing import NDArray

import hamel

KAPITZA = """
/// Kapitza's pendulum: its pivot moves up and down by a cos(Omega t); q from the upright.
system Kapitza {
    param l = 1, g = 9.81, a = 0.1, Omega = 60;
    time t;
    coord q;
    velocity w;
    rate q = w;
    particle mass 1 at [l * sin(q), 0, a * cos(Omega * t) + l * cos(q)];
    gravity [0, 0, -g];
    start q = 0.001;
}
"""
UNTIL, LENGTH, GRAVITY = 20.0, 1.0, 9.81
AMPLITUDES, FREQUENCIES = (0.01, 0.6), (5.0, 80.0)


def trace(a: NDArray[np.float64], omega: NDArray[np.float64]) -> NDArray[np.float64]:
    """Trace of the monodromy matrix of q'' = (g - a Omega^2 cos(Omega t)) q / l, which is stable if |trace| < 2."""
    steps = 400
    h = 2 * np.pi / omega / steps
    state = np.stack([np.ones_like(a), np.zeros_like(a), np.zeros_like(a), np.ones_like(a)])

    def rates(y: NDArray[np.float64], t: NDArray[np.float64]) -> NDArray[np.float64]:
        stiffness = (GRAVITY - a * omega**2 * np.cos(omega * t)) / LENGTH
        return np.stack([y[1], stiffness * y[0], y[3], stiffness * y[2]])

    for step in range(steps):
        t = step * h
        k1 = rates(state, t)
        k2 = rates(state + h / 2 * k1, t + h / 2)
        k3 = rates(state + h / 2 * k2, t + h / 2)
        k4 = rates(state + h * k3, t + h)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    sum_of_both: NDArray[np.float64] = state[0] + state[3]
    return sum_of_both


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("folder", nargs="?", type=Path, default=Path("."))
    parser.add_argument("--points", type=int, default=120)
    options = parser.parse_args()
    n = options.points
    with tempfile.TemporaryDirectory() as scratch:
        description = Path(scratch) / "kapitza.eom"
        description.write_text(KAPITZA)
        runs = Path(scratch) / "runs"
        grids = [f"grid({low}, {high}, {n})" for low, high in (AMPLITUDES, FREQUENCIES)]
        hamel.sweep(
            description,
            vary=f"a = {grids[0]}; Omega = {grids[1]}",
            keep="max(abs(q))",
            until=UNTIL,
            method="rkmk4",
            step=2e-3,
            out=runs,
        )
        table = pl.read_parquet(runs / "*.parquet").sort("Omega", "a")
    a, omega = (table[name].to_numpy().reshape(n, n) for name in ("a", "Omega"))
    stands = table["max(abs(q))"].to_numpy().reshape(n, n) < 0.1
    theory = np.abs(trace(a, omega))
    agree = (stands == (theory < 2)).mean()
    print(f"{n * n} runs: {stands.mean():.1%} stand, {agree:.2%} as the linear theory says")
    assert agree > 0.98

    figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
    axes.pcolormesh(a / LENGTH, omega, stands, cmap="Blues", vmin=0, vmax=1.6)
    axes.contour(a / LENGTH, omega, theory, levels=[2], colors="black", linewidths=1)
    line = np.linspace(*AMPLITUDES, 200)
    averaged = np.sqrt(2 * GRAVITY * LENGTH) / line
    axes.plot(line, averaged, "--", color="tab:red", label=r"Kapitza: $a\Omega = \sqrt{2 g l}$")
    axes.set(xlabel="amplitude a / l", ylabel="frequency $\\Omega$ (rad/s)", ylim=FREQUENCIES)
    axes.legend(loc="upper right")
    figure.savefig(options.folder / "kapitza.png", dpi=120)


if __name__ == "__main__":
    main()
