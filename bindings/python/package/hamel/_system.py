"""Systems, with their functions, runs and linearisations."""

from __future__ import annotations

import json
import operator
import os
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._hamel import Function, HamelError, Session, decoded
from ._linear import Linearization

Array = NDArray[np.float64]
Inputs = Union[
    Mapping[str, Union[str, ArrayLike]],
    Callable[[float, Array, Array], ArrayLike],
    "str | os.PathLike[str]",
    None,
]


# The largest finite number.
_MAX_FLOAT = float(np.finfo(np.float64).max)

EventQuantity = Union[str, Callable[[float, Array, Array], float]]


class RunError(HamelError):
    """Raised if a run ends early; `run` contains the samples up to then."""

    def __init__(self, why: str, run: Run) -> None:
        super().__init__(why)
        self.run = run

    def __reduce__(self) -> Any:
        return (RunError, (str(self), self.run))


class NoFunction(HamelError, AttributeError):
    """Raised for a function that a system cannot have. Being an AttributeError, it makes `hasattr` return False."""


@dataclass(frozen=True)
class State:
    """State of a system, with its inputs and parameters.

    All numbers are in the units of the description: SI units if lengths are in m, masses in kg and times in s.

    Attributes
    ----------
    x : (coordinates,)
        Coordinates.
    xi : (velocities,)
        Velocities, followed by the first-order states.
    u : (inputs,)
        Inputs.
    parameters : (parameters,)
        Parameters.
    """

    x: Array
    xi: Array
    u: Array
    parameters: Array

    def _numbers(self) -> tuple[Array, Array, Array, Array]:
        return (self.x, self.xi, self.u, self.parameters)

    def _copy(self) -> State:
        return State(*(part.copy() for part in self._numbers()))


class Names(Sequence[str]):
    """Names of the entries of an array; `names.slice("w")` is the slice of the entries of `w`."""

    def __init__(self, entries: list[str], groups: list[tuple[str, int, int]]) -> None:
        self._entries = tuple(entries)
        self._groups = {name: slice(first, first + count) for name, first, count in groups}

    def __len__(self) -> int:
        return len(self._entries)

    def __getitem__(self, place: Any) -> Any:
        return self._entries[place]

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __repr__(self) -> str:
        return repr(list(self._entries))

    @property
    def groups(self) -> dict[str, slice]:
        """Names of the description, each with the slice of its entries."""
        return dict(self._groups)

    def slice(self, name: str) -> slice:
        """Return the slice of the entries of a name; raise KeyError if there is no such name."""
        try:
            return self._groups[name]
        except KeyError:
            raise KeyError(f"no `{name}` here: there are {', '.join(self._groups)}") from None


@dataclass(frozen=True)
class Event:
    """Sign change of a quantity along a run.

    Attributes
    ----------
    of : str or callable
        Expression in names of the description, such as ``"foot.p[3] - 0.1"``, or function of (t, x, xi).
    direction : int
        1 for changes from negative to positive only, -1 for the opposite, 0 for both.
    terminal : bool
        Whether the run ends at the event.
    """

    of: EventQuantity
    direction: int = 0
    terminal: bool = False


@dataclass(frozen=True)
class EventOccurrences:
    """Occurrences of an event: times t (k,) in s, and the states x (k, coordinates) and xi (k, velocities) at them."""

    t: Array
    x: Array
    xi: Array

    def __len__(self) -> int:
        return len(self.t)


#: Former name of `EventOccurrences`.
Happened = EventOccurrences


@dataclass(frozen=True)
class Run:
    """Result of a run, with k samples.

    ``run["w"]`` returns a coordinate, a velocity or an output by its name in the description.

    Attributes
    ----------
    t : (k,)
        Times (s).
    x : (k, coordinates)
        Coordinates.
    xi : (k, velocities)
        Velocities, followed by the first-order states.
    energy : (k,)
        T + V (J).
    outputs, invariants : dict
        Arrays by name: (k,) for numbers, (k, n) for vectors, (k, m, n) for matrices.
    method : str
        Integration method.
    steps, evaluations : int
        Numbers of steps and of evaluations of accelerations, forces or rates of momenta.
    """

    t: Array
    x: Array
    xi: Array
    energy: Array
    outputs: dict[str, Array]
    invariants: dict[str, Array]
    method: str
    #: Reason for the choice of the method, if it was not requested.
    reason: str | None
    steps: int
    evaluations: int
    #: Largest relative change of the energy; infinite if all of it was supplied during the run.
    energy_deviation: float
    #: Largest |phi(x)| along the run.
    constraint: float
    #: Reason of an early end.
    failure: str | None
    #: Occurrences of the events, by name.
    events: dict[str, EventOccurrences]
    #: Name of the event that ended the run.
    stopped_by: str | None
    coordinates: Names = field(repr=False)
    velocities: Names = field(repr=False)

    def __getitem__(self, name: str) -> Array:
        """Return a coordinate, a velocity or an output by its name in the description."""
        if name in self.coordinates.groups:
            part = self.x[:, self.coordinates.groups[name]]
        elif name in self.velocities.groups:
            part = self.xi[:, self.velocities.groups[name]]
        elif name in self.outputs:
            return self.outputs[name]
        else:
            there = [*self.coordinates.groups, *self.velocities.groups, *self.outputs]
            raise KeyError(f"no `{name}` in this run: there are {', '.join(there)}")
        return part[:, 0] if part.shape[1] == 1 else part


@dataclass(frozen=True)
class Trim:
    """Equilibrium or steady motion, with n velocities and first-order states."""

    state: State
    #: Accelerations and rates of first-order states at the state, (n,): zero, or the given ones.
    xi_dot: Array
    #: Largest absolute residual of all conditions.
    residual: float
    steps: int
    #: Number of the neighbour of the start from which the search led to the state; 0 if it did from the start itself.
    neighbour: int
    unknowns: int
    conditions: int
    #: Rank of the conditions at the state.
    rank: int
    #: Directions along which solutions form a family: names of entries with their changes.
    undetermined: list[dict[str, float]]
    #: "asymptotic" if all deviations decay, "unstable" if some grow, "neutral" otherwise; None without eigenvalues.
    stability: str | None
    #: Eigenvalues (1/s), the fastest growing first, apart from displacements along which the motion does not change.
    eigenvalues: NDArray[np.complex128]


@dataclass(frozen=True)
class StepSlopes:
    """State after a step, with the derivatives of the step: (η, δξ) after it is A (η, δξ) + B δu.

    η are displacements δx = A(x) η. With d columns of A(x), n velocities and m inputs, x is (coordinates,), xi (n,),
    A (d + n, d + n) and B (d + n, m).
    """

    x: Array
    xi: Array
    A: Array
    B: Array


@dataclass(frozen=True)
class BaseParameters:
    """Base parameters beta: combinations of masses, centres of mass and inertias, with F = Y(x, xi, xi_dot) beta."""

    #: Names, values and definitions by the standard parameters, as `hamel regressor --format json` prints them.
    data: dict[str, Any]
    text: str = field(repr=False)
    latex: str = field(repr=False)
    markdown: str = field(repr=False)

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.markdown


class Tables:
    """Tables of coefficients, as text (`str(tables)`), LaTeX, Markdown or data."""

    def __init__(self, session: Session, of: list[str], all: bool) -> None:
        self._session, self._of, self._all = session, of, all
        self._text = self._written("text")

    def _written(self, form: str) -> str:
        return self._session.tables(self._of, form, self._all)

    def __str__(self) -> str:
        return self._text

    __repr__ = __str__

    def _repr_markdown_(self) -> str:
        return self.markdown

    @property
    def latex(self) -> str:
        """Tables in LaTeX."""
        return self._written("latex")

    @property
    def markdown(self) -> str:
        """Tables in Markdown."""
        return self._written("markdown")

    @property
    def data(self) -> Any:
        """Tables as dictionaries and lists."""
        return json.loads(self._written("json"))


def _plain(value: Any, place: str = "state") -> Any:
    """Convert arrays and tuples to lists, and check that JSON can represent the value."""
    if isinstance(value, Mapping):
        return {str(name): _plain(part, f"{place}.{name}") for name, part in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist(), place)
    if isinstance(value, list | tuple):
        return [_plain(part, place) for part in value]
    if isinstance(value, int | float) and not abs(value) <= _MAX_FLOAT:
        raise HamelError(f"{place}: a finite number is needed, {value} was given")
    if not isinstance(value, str | int | float | None):
        raise HamelError(f"{place}: a number, a list or a dictionary of numbers is needed, {value!r} was given")
    return value


def _array(value: ArrayLike) -> Array:
    if np.iscomplexobj(value):
        raise HamelError("real numbers are needed, complex ones were given")
    return np.ascontiguousarray(value, dtype=np.float64)


def _number(name: str, value: Any) -> float:
    """Convert the argument of this name to a number."""
    if not isinstance(value, str | bytes) and not np.iscomplexobj(value):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise HamelError(f"`{name}` is a number, {value!r} was given")


def _method(name: Any) -> str:
    if not isinstance(name, str):
        raise HamelError(f"`method` is the name of a method, {name!r} was given")
    return name


def _read(path: str | os.PathLike[str]) -> tuple[str, str]:
    """Return the path of a file as a string, and the text of the file."""
    name = os.fspath(path)
    with open(name, "rb") as file:
        return name, decoded(name, file.read())


class System:
    """Mechanical system from a description or a robot, with derived and proved equations of motion.

    Every generated function is an attribute. It takes arrays whose last axis contains the entries of one state::

        system.accel(x, xi, u)            # (n,) for one state, (k, n) for k of them
        system.mass_matrix(x)             # (n, n)
        system.tool_jacobian(x)           # of a frame `tool`

    `system.functions` lists their names; the docstring of each function gives its arguments, result and shapes.
    """

    def __init__(self, session: Session, source: tuple[str, str | None, dict[str, Any]], parameters: Array | None = None):
        self._session = session
        self._source = source
        x, xi, u, defaults = session.start()
        self._parameters = defaults if parameters is None else parameters
        self._start = State(x, xi, u, self._parameters)
        self._functions: dict[str, Function] = {}

    # --- constructors -----------------------------------------------------------------------------------------------

    @classmethod
    def _open(cls, path: str, text: str | None, options: dict[str, Any]) -> System:
        session, said = Session.open(path, text, **options)
        if said:
            warnings.warn(said.rstrip().removeprefix("warning: "), stacklevel=3)
        return cls(session, (path, text, options))

    @classmethod
    def from_file(
        cls, path: str | os.PathLike[str], *, constants: Mapping[str, object] | None = None
    ) -> System:
        """Read a system from a file.

        Parameters
        ----------
        path : str or path
            File of a description or a robot.
        constants : dict, optional
            Values of constants of the description, in place of those in the file.

        Raises
        ------
        HamelError
            If the file cannot be read, or the description has an error.
        """
        given = [(constant, str(value)) for constant, value in (constants or {}).items()]
        try:
            name, text = _read(path)
        except OSError as why:
            raise HamelError(f"cannot read {os.fspath(path)}: {why.strerror}") from why
        return cls._open(name, text, {"constants": given})

    @classmethod
    def from_text(
        cls, text: str, *, name: str = "<text>", constants: Mapping[str, object] | None = None
    ) -> System:
        """Read a system from a text.

        Parameters
        ----------
        text : str
            Description.
        name : str
            Name of the text in messages.
        constants : dict, optional
            Values of constants of the description, in place of those in the text.

        Raises
        ------
        HamelError
            If the description has an error.
        """
        if not isinstance(text, str):
            raise TypeError(f"a description is a string, {text!r} was given")
        given = [(constant, str(value)) for constant, value in (constants or {}).items()]
        return cls._open(name, text, {"constants": given})

    @classmethod
    def from_urdf(
        cls,
        path: str | os.PathLike[str],
        *,
        floating: bool = False,
        lock: Mapping[str, float] | None = None,
        parameters: bool = False,
        mimic: Literal["follow", "free"] = "follow",
        name: str | None = None,
        rounding: float | None = None,
    ) -> System:
        """Read a robot from a URDF file; `hamel import --help` describes the options in detail.

        Parameters
        ----------
        path : str or path
            URDF file.
        floating : bool
            Whether the base moves freely.
        lock : dict, optional
            Joints that do not move, with their angle (rad) or length (m).
        parameters : bool
            Whether masses, centres of mass and inertias are parameters, instead of numbers.
        mimic : {"follow", "free"}
            Whether joints with `<mimic>` follow their leader, or move freely.
        name : str, optional
            Name of the system.
        rounding : float, optional
            Tolerance within which angles become multiples of π/2, and small entries 0, from 0 to 0.1 (rad).

        Raises
        ------
        HamelError
            If the file is not a robot in URDF, or an option does not apply to it.
        """
        options: dict[str, Any] = {
            "floating": floating,
            "locks": [(joint, repr(_number(f"lock[{joint!r}]", value))) for joint, value in (lock or {}).items()],
            "params": parameters,
            # "follow" is the default.
            "mimic": None if mimic == "follow" else mimic,
            "name": name,
            "rounding": rounding,
        }
        file, text = _read(path)
        if not text.lstrip("\ufeff \t\r\n").startswith("<"):
            raise HamelError(f"{file} is not a robot in URDF; `System.from_file` reads descriptions")
        return cls._open(file, text, options)

    def with_parameters(self, **values: ArrayLike) -> System:
        """Return the same system with other values of the named parameters, without deriving it again."""
        start = self.state(param=values)
        system = System(self._session, self._source, start.parameters)
        system._start = start
        return system

    def __reduce__(self) -> Any:
        return (_restored, (self._source, self._parameters, self._start))

    # --- properties -------------------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Name of the system."""
        return self._session.name

    @property
    def text(self) -> str:
        """Text of the description; for a robot, the description generated from it."""
        return self._session.text

    @property
    def coordinates(self) -> Names:
        """Names of the entries of x."""
        return Names(*self._session.coordinates())

    @property
    def velocities(self) -> Names:
        """Names of the entries of xi: velocities, followed by first-order states."""
        return Names(*self._session.velocities())

    @property
    def inputs(self) -> Names:
        """Names of the entries of u."""
        return Names(*self._session.inputs())

    @property
    def parameters(self) -> Names:
        """Names of the entries of `parameter_values`."""
        return Names(*self._session.parameters())

    @property
    def parameter_values(self) -> Array:
        """Values of the parameters (parameters,), in the units of the description."""
        return self._parameters.copy()

    @property
    def outputs(self) -> list[str]:
        """Names of the outputs of the description."""
        return self._session.outputs()

    @property
    def joints(self) -> dict[str, slice]:
        """Joints by their names in the URDF file, each with the slice of its velocities in xi."""
        return {name: slice(first, first + count) for name, first, count in self._session.joints()}

    @property
    def frames(self) -> list[str]:
        """Names of the frames. A frame `tool` has the functions `tool_pose`, `tool_twist`, `tool_jacobian` and more."""
        return self._session.frames()

    @property
    def functions(self) -> list[str]:
        """Names of all functions. Access to one that this system cannot have raises HamelError with the reason."""
        return self._session.functions()

    def function(self, name: str) -> Function:
        """Return a function by its name, compiled on first use. Its docstring gives the shapes of its arrays."""
        found = self._functions.get(name)
        if found is None:
            pickled = (_function, (*self.__reduce__()[1], name))
            found = self._functions[name] = self._session.function(name, self._parameters, pickled)
        return found

    def __getattr__(self, name: str) -> Function:
        if name.startswith("_"):
            raise AttributeError(name)
        if name in self._functions:
            return self._functions[name]
        if name not in self._session.functions():
            raise AttributeError(f"{self._session.name} has no function `{name}`; `functions` lists them")
        try:
            return self.function(name)
        except HamelError as why:
            raise NoFunction(str(why)) from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._session.functions()})

    def __repr__(self) -> str:
        n, nu, m = len(self.velocities), len(self.coordinates), len(self.inputs)
        return f"<System {self.name}: {nu} coordinates, {n} velocities, {m} inputs>"

    # --- states -----------------------------------------------------------------------------------------------------

    def start(self) -> State:
        """Return the initial state, with zero inputs."""
        return self._start._copy()

    def state(self, given: Mapping[str, Mapping[str, Any]] | None = None, /, **parts: Mapping[str, Any]) -> State:
        """Return a state with values given by name, as a mapping such as a file of `--at` contains, or by keywords.

        All other values are those of the start, adjusted where loops or other constraints require it.

        Examples
        --------
        A system, and a robot by its joints::

            system.state(coord={"q": 0.3}, velocity={"q_dot": 1.0}, input={"F": 2.0}, param={"m": 1.5})
            robot.state(configuration={"elbow": 0.3}, velocity={"elbow": 1.0})
            robot.state(json.loads(Path("state.json").read_text()))
        """
        given = {} if given is None else dict(given)
        if twice := sorted(given.keys() & parts.keys()):
            raise HamelError(f"`{twice[0]}` is given twice, by the mapping and as a keyword")
        return State(*self._session.state(self._parameters, json.dumps(_plain({**given, **parts}))))

    def _at(self, at: State | Mapping[str, Any] | None) -> tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]:
        if at is None:
            at = self._start
        elif isinstance(at, Mapping):
            at = self.state(at)
        elif not isinstance(at, State):
            raise HamelError(f"a state is a `hamel.State` or a dictionary of arguments of `System.state`, not {at!r}")
        return at._numbers()

    # --- computations -----------------------------------------------------------------------------------------------

    def evaluate(self, at: State | Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Evaluate all quantities at a state: A, Y, gamma, M, Gamma, forces and energies, as `hamel eval` does.

        With n velocities, M is (n, n), gamma and Gamma are (n, n, n), forces (n,), and energies are numbers (J).
        """
        values: dict[str, Any] = json.loads(self._session.evaluate(self._at(at)))
        return {name: _numeric(value) for name, value in values.items()}

    def tables(self, *of: str, all: bool = False) -> Tables:
        """Return tables by name, such as `gamma`, `M` and `Gamma`; without names, the most important ones."""
        return Tables(self._session, list(of), all)

    def simulate(
        self,
        until: float,
        *,
        at: State | Mapping[str, Any] | None = None,
        method: str = "auto",
        step: float | None = None,
        tol: float | None = None,
        rate: float | None = None,
        every: int | None = None,
        spacing: float | None = None,
        times: ArrayLike | None = None,
        inputs: Inputs = None,
        hold: bool = False,
        events: Mapping[str, Event | EventQuantity] | None = None,
    ) -> Run:
        """Integrate the motion from a state.

        Parameters
        ----------
        until : float
            Length of the run (s).
        at : State or dict, optional
            Initial state, or arguments of `state`; by default the start of the description.
        method : str
            Method, one of those that `hamel simulate --help` lists; "auto" selects one that fits the system.
        step : float, optional
            Length of a step (s).
        tol : float, optional
            Permitted error per step, for methods that choose their steps.
        rate : float, optional
            Rate at which the method "rk4" returns to the constraint (1/s).
        every, spacing, times : int, float or (k,), optional
            Samples after every so many steps, at multiples of a time (s), or at given times (s). Without any of the
            three, a run has a few thousand samples at most.
        inputs : dict, callable or path, optional
            Numbers or expressions in `t`, parameters, coordinates and velocities, as in
            ``{"F": 2.0, "tau": "-k * q"}``; or a function of (t, x, xi) that returns u (inputs,); or a CSV file.
        hold : bool
            Whether the values of a CSV file hold until the next row, instead of being interpolated.
        events : dict, optional
            Events by names of your choice, as in
            ``{"ground": hamel.Event("foot.p[3]", direction=-1, terminal=True)}``, or an expression or a function of
            (t, x, xi) in place of an `Event`. As for SciPy's `solve_ivp`, a function may have attributes `terminal` and
            `direction`. Signs are compared at the ends of steps, so two changes within one step are missed; a zero at
            the start of the run is not an event.

        Returns
        -------
        Run
            Samples, with the times of events to machine precision in `run.events`.

        Raises
        ------
        RunError
            If the run ends early; its attribute `run` contains the samples up to then.
        HamelError
            If an argument is not valid.
        """
        state = self._at(at)
        spaced = {"every": every, "spacing": spacing, "times": times}
        given = [f"`{name}`" for name, value in spaced.items() if value is not None]
        if len(given) > 1:
            raise HamelError(f"`every`, `spacing` and `times` exclude one another, {' and '.join(given)} were given")
        if rate is not None and method != "rk4":
            raise HamelError("`rate` requires the method rk4: the other methods preserve the constraint without it")
        if hold and not isinstance(inputs, str | os.PathLike):
            raise HamelError("`hold` requires a file of inputs: it holds the values of a row until the next row")
        numbers = {"step": step, "tol": tol, "rate": rate, "spacing": spacing}
        options: dict[str, Any] = {
            "until": _number("until", until),
            "method": _method(method),
            **{name: None if value is None else _number(name, value) for name, value in numbers.items()},
            "times": None if times is None else _array(times).ravel().tolist(),
        }
        if every is not None:
            try:
                # Larger numbers do not fit into 64 bits, and no run has so many steps.
                options["every"] = min(operator.index(every), 2**62)
            except TypeError:
                raise HamelError(f"`every` is a number of steps, 1 or greater, {every!r} was given") from None
        if callable(inputs):
            options["law"] = inputs
        elif isinstance(inputs, Mapping):
            fixed, expressions = _array(state[2]).copy(), []
            names = self.inputs
            for name, value in inputs.items():
                if isinstance(value, str):
                    expressions.append(f"{name} = {value}")
                elif name in names.groups or name in names:
                    first = names.index(name) if name in names else names.groups[name].start
                    places = names.groups.get(name, slice(first, first + 1))
                    entries = np.ravel(_array(value))
                    if entries.size != places.stop - places.start:
                        wanted = places.stop - places.start
                        raise HamelError(f"the input `{name}` has {wanted} entries, {entries.size} were given")
                    if not np.isfinite(entries).all():
                        raise HamelError(f"the input `{name}` must be finite, {value!r} was given")
                    fixed[places] = entries
                else:
                    there = f"there are {', '.join(names)}" if names else "it has no inputs"
                    raise HamelError(f"{self.name} has no input `{name}`: {there}")
            state = (state[0], state[1], fixed, state[3])
            options["expressions"] = expressions
        elif not isinstance(inputs, str | os.PathLike | None):
            raise HamelError(f"inputs are a dictionary, a function of (t, x, xi) or a file, not {inputs!r}")
        elif inputs is not None:
            options["file"] = os.fspath(inputs)
            options["hold"] = True if hold else None
        if not isinstance(events, Mapping | None):
            raise HamelError(f"events have names: a dictionary is needed, as in {{'top': 'w[1]'}}, not {events!r}")
        options["events"] = [_event_arguments(name, event) for name, event in (events or {}).items()]
        found = self._session.simulate(state, options)
        found["events"] = {name: EventOccurrences(*parts) for name, parts in found["events"].items()}
        run = Run(**found, coordinates=self.coordinates, velocities=self.velocities)
        if run.failure is not None:
            raise RunError(run.failure, run)
        return run

    def step(
        self,
        x: ArrayLike,
        xi: ArrayLike,
        u: ArrayLike | None = None,
        *,
        h: float,
        method: str = "auto",
    ) -> tuple[Array, Array]:
        """Take a step with constant inputs, from one state or from many along the first axes.

        Parameters
        ----------
        x : (..., coordinates)
            Coordinates.
        xi : (..., velocities)
            Velocities, followed by the first-order states.
        u : (..., inputs), optional
            Inputs; by default zero.
        h : float
            Length of the step (s), which may be negative.
        method : str
            Method, as for `simulate`.

        Returns
        -------
        x, xi : (..., coordinates), (..., velocities)
            State after the step.

        Raises
        ------
        SingularError
            If a step fails, with the index of its state.
        """
        state = self._at(None)
        held = state[2] if u is None else u
        return self._session.step(state, x, xi, held, _number("h", h), _method(method))

    def step_slopes(
        self,
        at: State | Mapping[str, Any] | None = None,
        *,
        h: float,
        method: str = "rkmk4",
    ) -> StepSlopes:
        """Take a step of length h (s) from a state with constant inputs, and differentiate it.

        A and B are derivatives of the step itself, to rounding, not of the exact motion. Their rows and columns are
        those of `linearize(full=True)`.

        Raises
        ------
        SingularError
            If the step fails.
        HamelError
            If the method has no derivatives, such as "rk4".
        """
        state = self._at(at)
        x, xi, slopes = self._session.step_slopes(state, _number("h", h), _method(method))
        rows = slopes.shape[0]
        return StepSlopes(x, xi, slopes[:, :rows], slopes[:, rows:])

    def linearize(self, at: State | Mapping[str, Any] | None = None, *, full: bool = False) -> Linearization:
        """Linearise the motion at a state.

        With constraints, the states of the result are independent displacements and velocities; `full` keeps all.
        """
        return Linearization(**self._session.linearize(self._at(at), full))

    def trim(
        self,
        at: State | Mapping[str, Any] | None = None,
        *,
        steady: bool = False,
        free: Sequence[str] = (),
        fix: Sequence[str] | Mapping[str, float] = (),
        rates: Mapping[str, float] | None = None,
    ) -> Trim:
        """Find an equilibrium near a state, or, if `steady`, a motion with constant velocities.

        Parameters
        ----------
        at : State or dict
            State at which the search starts; by default the start of the description.
        steady : bool
            Whether velocities are unknown and remain constant; otherwise they are zero.
        free : sequence of str
            Inputs, and velocities if not `steady`, that are unknown: names such as ``"f"`` or entries such as ``"f[2]"``.
        fix : sequence of str, or dict
            Equations that have to hold: ``["speed = 30"]`` or ``{"speed": 30.0}``, with expressions in coordinates,
            velocities, inputs, parameters and outputs. An input or a velocity alone on the left is free.
        rates : dict
            Entries of the velocities and first-order states, with rates that they have instead of zero.

        Raises
        ------
        HamelError
            If there is no solution near the start, with the reason, or if a name or an equation is wrong.
        """
        if isinstance(free, str) or isinstance(fix, str):
            raise HamelError("`free` and `fix` are lists: a string was given")
        if isinstance(fix, Mapping):
            fix = [f"{name} = {_number(name, value)!r}" for name, value in fix.items()]
        given = [(name, _number(name, value)) for name, value in (rates or {}).items()]
        found = self._session.trim(self._at(at), bool(steady), list(free), list(fix), given)
        found["state"] = State(*found["state"])
        return Trim(**found)

    def base_parameters(self) -> BaseParameters:
        """Return the base parameters beta (p,), which belong to the p columns of `regressor`."""
        found = self._session.base_parameters()
        return BaseParameters(json.loads(found["json"]), found["text"], found["latex"], found["markdown"])


def _event_arguments(name: str, event: Event | EventQuantity) -> tuple[str, EventQuantity, int, bool]:
    """Convert an event to the arguments of the session: name, quantity, direction and whether it is terminal."""
    if not isinstance(event, Event):
        event = Event(event, getattr(event, "direction", 0), getattr(event, "terminal", False))
    if not isinstance(event.of, str) and not callable(event.of):
        raise HamelError(f"the event `{name}` is an expression or a function of (t, x, xi), not {event.of!r}")
    if not isinstance(name, str):
        raise HamelError(f"the name of an event is a string, not {name!r}")
    if not isinstance(event.direction, int | float | np.number) or np.isnan(event.direction):
        raise HamelError(f"`direction` of the event `{name}` is 1, -1 or 0, not {event.direction!r}")
    if event.terminal not in (False, True):
        raise HamelError(f"`terminal` of the event `{name}` is True or False, not {event.terminal!r}")
    return name, event.of, int(np.sign(event.direction)), bool(event.terminal)


def _numeric(value: Any) -> Any:
    """Convert lists of numbers to arrays, and null to NaN."""
    if isinstance(value, dict):
        return {name: _numeric(part) for name, part in value.items()}
    if isinstance(value, list) and not _has_text(value):
        return np.array(value, dtype=np.float64)
    return value


def _has_text(value: Any) -> bool:
    if isinstance(value, list):
        return any(_has_text(part) for part in value)
    return isinstance(value, str | dict)


def _restored(source: tuple[str, str | None, dict[str, Any]], parameters: Array, start: State) -> System:
    path, text, options = source
    session, _ = Session.open(path, text, **options)
    system = System(session, source, parameters)
    system._start = start
    return system


def _function(source: tuple[str, str | None, dict[str, Any]], parameters: Array, start: State, name: str) -> Function:
    return _restored(source, parameters, start).function(name)
