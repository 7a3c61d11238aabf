"""Equations of motion of mechanical systems, as functions over NumPy arrays.

    import hamel

    top = hamel.System.from_file("heavy_top.eom")
    xi_dot = top.accel(x, xi)                  # one state, or many along the first axes
    run = top.simulate(until=10.0)             # run.t, run.x, run.xi, run.outputs
    linear = top.linearize()                   # linear.A, linear.B, linear.eigenvalues

Functions are compiled to machine code on first use, without a compiler. x contains the coordinates, xi the
velocities followed by the first-order states, u the inputs. `System.coordinates`, `System.velocities` and
`System.inputs` list the names of their entries.
"""

from ._hamel import Function, HamelError, SingularError, __version__
from ._linear import Linearization, Mode, Regulator
from ._system import (
    BaseParameters,
    Event,
    EventOccurrences,
    Happened,
    Names,
    Run,
    RunError,
    State,
    StepSlopes,
    System,
    Tables,
    Trim,
)
from ._sweep import sweep

__all__ = [
    "BaseParameters",
    "Event",
    "EventOccurrences",
    "Function",
    "HamelError",
    "Happened",
    "Linearization",
    "Mode",
    "Names",
    "Regulator",
    "Run",
    "RunError",
    "SingularError",
    "State",
    "StepSlopes",
    "System",
    "Tables",
    "Trim",
    "__version__",
    "sweep",
]
