"""Equations of motion from descriptions, as functions over NumPy arrays.

    import hamel

    top = hamel.System.from_file("heavy_top.eom")
    xi_dot = top.accel(x, xi)                  # one state, or many along the first axes
    run = top.simulate(until=10.0)             # run.t, run.x, run.xi, run.outputs
    linear = top.linearize()                   # linear.A, linear.B, linear.eigenvalues

Functions become machine code when they are first asked for, no compiler is needed. x are the coordinates, xi the
velocities (and behind them the states of first order), u the inputs; `System.coordinates` and the like say which entry is
which.
"""

from ._hamel import Function, HamelError, SingularError, __version__
from ._system import BaseParameters, Event, Happened, Linearization, Names, Run, RunError, State, StepSlopes, System, Tables
from ._sweep import sweep

__all__ = [
    "BaseParameters",
    "Event",
    "Function",
    "HamelError",
    "Happened",
    "Linearization",
    "Names",
    "Run",
    "RunError",
    "SingularError",
    "State",
    "StepSlopes",
    "System",
    "Tables",
    "__version__",
    "sweep",
]
