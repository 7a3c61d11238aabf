"""Systems, their functions, runs and linearisations."""

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

Array = NDArray[np.float64]
Inputs = Union[
    Mapping[str, Union[str, ArrayLike]],
    Callable[[float, Array, Array], ArrayLike],
    "str | os.PathLike[str]",
    None,
]


# The largest number.
LARGEST = float(np.finfo(np.float64).max)

Watched = Union[str, Callable[[float, Array, Array], float]]


class RunError(HamelError):
    """A run that ended early; `run` has what there was before."""

    def __init__(self, why: str, run: Run) -> None:
        super().__init__(why)
        self.run = run

    def __reduce__(self) -> Any:
        return (RunError, (str(self), self.run))


class NoFunction(HamelError, AttributeError):
    """A function that a system cannot have, asked for as an attribute: for `hasattr` and `getattr` there is none."""


@dataclass(frozen=True)
class State:
    """Coordinates x, velocities xi with the states of first order behind them, inputs u and parameters.

    Arrays of one axis, as long as `coordinates`, `velocities`, `inputs` and `parameters` of the system, in the units of the
    description: all of hamel computes with numbers as they are given, in SI where lengths are in m, masses in kg, times in s.
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
    """Names of the entries of an array; `names.slice("w")` are the places of a group of them."""

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
        """Each name of the description, with the places of its entries."""
        return dict(self._groups)

    def slice(self, name: str) -> slice:
        """The places of the entries of a name."""
        try:
            return self._groups[name]
        except KeyError:
            raise KeyError(f"no `{name}` here: there are {', '.join(self._groups)}") from None


@dataclass(frozen=True)
class Event:
    """Where a number that is watched along a run changes its sign.

    `of` is an expression of the description's names, such as ``"foot.p[3] - 0.1"``, or a function of (t, x, xi). `direction`
    is 1 where only changes from negative to positive count, -1 for the others, 0 for both. A run ends at the first event that
    is `terminal`.
    """

    of: Watched
    direction: int = 0
    terminal: bool = False


@dataclass(frozen=True)
class Happened:
    """The times at which an event happened, with the states there: a row for each time."""

    t: Array
    x: Array
    xi: Array

    def __len__(self) -> int:
        return len(self.t)


@dataclass(frozen=True)
class Run:
    """A run: arrays with a row for each of k samples.

    `t` (k,) are the times (s), `x` (k, coordinates) and `xi` (k, velocities) the states, `energy` (k,) is T + V (J); `outputs`
    and `invariants` have arrays (k,) of numbers, (k, n) of vectors and (k, m, n) of matrices, by their names. `steps` and
    `evaluations` count steps and evaluations of forces.
    """

    t: Array
    x: Array
    xi: Array
    energy: Array
    outputs: dict[str, Array]
    invariants: dict[str, Array]
    method: str
    #: Why the method was taken, where none was asked for.
    reason: str | None
    steps: int
    evaluations: int
    #: The largest change of the energy, relative; infinite where the run has got all of it from outside.
    energy_deviation: float
    #: The largest |phi(x)| on the way.
    constraint: float
    #: Why the run ended early.
    failure: str | None
    #: What became of the events, by their names.
    events: dict[str, Happened]
    #: The event at which the run ended.
    stopped_by: str | None
    coordinates: Names = field(repr=False)
    velocities: Names = field(repr=False)

    def __getitem__(self, name: str) -> Array:
        """Coordinates, velocities or an output by the name in the description."""
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
class Linearization:
    """d/dt (h, δξ) = A (h, δξ) + B δu and δy = C (h, δξ) + D δu: displacements h along the columns of A(x), changes δξ.

    A is (n, n), B (n, m), C (p, n), D (p, m) for the n names of `states`, m of `inputs` and p of `outputs`; `eigenvalues` (n,)
    in 1/s.
    """

    A: Array
    B: Array
    C: Array
    D: Array
    states: list[str]
    inputs: list[str]
    outputs: list[str]
    #: Of A, the fastest growing first.
    eigenvalues: NDArray[np.complex128]
    #: The accelerations at the state: where they are not zero, the matrices hold for that instant alone.
    xi_dot: Array


@dataclass(frozen=True)
class StepSlopes:
    """The state x, xi after a step, and (η, δξ)' = A (η, δξ) + B δu of displacements δx = A(x) η before and after it.

    With n velocities, of which displacements have as many as the description has columns of A(x): x (coordinates,), xi (n,),
    A square with a row for each displacement and each velocity, and B as high, with a column for each input.
    """

    x: Array
    xi: Array
    A: Array
    B: Array


@dataclass(frozen=True)
class BaseParameters:
    """What of all masses, centres of mass and inertias forces depend on: F = Y(x, xi, xi_dot) beta."""

    #: The standard parameter that each of them is named by, and what belongs to it.
    data: dict[str, Any]
    text: str = field(repr=False)
    latex: str = field(repr=False)
    markdown: str = field(repr=False)

    def __str__(self) -> str:
        return self.text

    def _repr_markdown_(self) -> str:
        return self.markdown


class Tables:
    """Tables of coefficients: `str(tables)`, `tables.latex`, `tables.markdown` and `tables.data`."""

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
        """For papers."""
        return self._written("latex")

    @property
    def markdown(self) -> str:
        """For documents and notebooks."""
        return self._written("markdown")

    @property
    def data(self) -> Any:
        """For programs."""
        return json.loads(self._written("json"))


def _plain(value: Any, place: str = "state") -> Any:
    """What JSON can say."""
    if isinstance(value, Mapping):
        return {str(name): _plain(part, f"{place}.{name}") for name, part in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist(), place)
    if isinstance(value, list | tuple):
        return [_plain(part, place) for part in value]
    if isinstance(value, int | float) and not abs(value) <= LARGEST:
        raise HamelError(f"{place}: a finite number is needed, {value} was given")
    if not isinstance(value, str | int | float | None):
        raise HamelError(f"{place}: a number, a list or names with numbers are needed, {value!r} was given")
    return value


def _array(value: ArrayLike) -> Array:
    if np.iscomplexobj(value):
        raise HamelError("real numbers are needed, complex ones were given")
    return np.ascontiguousarray(value, dtype=np.float64)


def _number(name: str, value: Any) -> float:
    """A number that was given by this name."""
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
    """The path of a file as a text, and the text in the file."""
    name = os.fspath(path)
    with open(name, "rb") as file:
        return name, decoded(name, file.read())


class System:
    """A mechanical system: a description or a robot, derived and proved.

    Every generated function is an attribute, and is called with arrays whose last axis has the entries::

        system.accel(x, xi, u)            # (n,) for one state, (k, n) for k of them
        system.mass_matrix(x)             # (n, n)
        system.tool_jacobian(x)           # of a frame `tool`

    `system.functions` lists them, with what they take and return in their docstrings.
    """

    def __init__(self, session: Session, source: tuple[str, str | None, dict[str, Any]], parameters: Array | None = None):
        self._session = session
        self._source = source
        x, xi, u, defaults = session.start()
        self._parameters = defaults if parameters is None else parameters
        self._start = State(x, xi, u, self._parameters)
        self._functions: dict[str, Function] = {}

    # --- from where -------------------------------------------------------------------------------------------------

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
        """The system that a file describes; `constants` are other values of its constants, such as the length of a chain."""
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
        """The system that a text describes; messages call it `name`."""
        if not isinstance(text, str):
            raise TypeError(f"a description is a text, {text!r} was given")
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
        """A robot in URDF.

        `floating` gives it a base that moves freely, `lock` are joints that do not move with their angle or length,
        `parameters` makes masses, centres of mass and inertias parameters; see `hamel import --help`.
        """
        options: dict[str, Any] = {
            "floating": floating,
            "locks": [(joint, repr(_number(f"lock[{joint!r}]", value))) for joint, value in (lock or {}).items()],
            "params": parameters,
            # What it is without a word.
            "mimic": None if mimic == "follow" else mimic,
            "name": name,
            "rounding": rounding,
        }
        file, text = _read(path)
        if not text.lstrip("\ufeff \t\r\n").startswith("<"):
            raise HamelError(f"{file} is no robot in URDF; `System.from_file` reads descriptions")
        return cls._open(file, text, options)

    def with_parameters(self, **values: ArrayLike) -> System:
        """The same system with other values of parameters, by their names."""
        start = self.state(param=values)
        system = System(self._session, self._source, start.parameters)
        system._start = start
        return system

    def __reduce__(self) -> Any:
        return (_restored, (self._source, self._parameters, self._start))

    # --- what there is ----------------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The name of the system."""
        return self._session.name

    @property
    def text(self) -> str:
        """The text of the description; of a robot, the one that it was made into."""
        return self._session.text

    @property
    def coordinates(self) -> Names:
        """The names of the entries of x, in the order of arrays."""
        return Names(*self._session.coordinates())

    @property
    def velocities(self) -> Names:
        """The names of the entries of xi, and of the states of first order behind them, in the order of arrays."""
        return Names(*self._session.velocities())

    @property
    def inputs(self) -> Names:
        """The names of the entries of u, in the order of arrays."""
        return Names(*self._session.inputs())

    @property
    def parameters(self) -> Names:
        """The names of the entries of the parameters, whose values are `parameter_values`."""
        return Names(*self._session.parameters())

    @property
    def parameter_values(self) -> Array:
        """The values of the parameters, (parameters,), in the units of the description."""
        return self._parameters.copy()

    @property
    def outputs(self) -> list[str]:
        """The outputs of the description."""
        return self._session.outputs()

    @property
    def joints(self) -> dict[str, slice]:
        """The joints, by the names that they have in a robot's file, with the places of their velocities in xi."""
        return {name: slice(first, first + count) for name, first, count in self._session.joints()}

    @property
    def frames(self) -> list[str]:
        """The frames of the description: `tool` has the functions `tool_pose`, `tool_twist`, `tool_jacobian` and others."""
        return self._session.frames()

    @property
    def functions(self) -> list[str]:
        """The names of all functions; one that this system cannot have, such as `regressor`, says why when it is asked for."""
        return self._session.functions()

    def function(self, name: str) -> Function:
        """A function by its name; it is compiled when it is first asked for. Its docstring has the shapes of its arrays."""
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
        """The start of the description, with zero inputs."""
        return self._start._copy()

    def state(self, **parts: Mapping[str, Any]) -> State:
        """A state by names: `system.state(coord={"q": 0.3}, velocity={"q_dot": 1.0}, input={"F": 2.0})`.

        A robot's is given by its joints: `robot.state(configuration={"elbow": 0.3}, velocity={"elbow": 1.0})`. What is not
        given is as at the start, and follows what is given where loops or other constraints ask for it.
        """
        return State(*self._session.state(self._parameters, json.dumps(_plain(parts))))

    def _at(self, at: State | Mapping[str, Any] | None) -> tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]:
        if at is None:
            at = self._start
        elif isinstance(at, Mapping):
            at = self.state(**at)
        elif not isinstance(at, State):
            raise HamelError(f"a state is a `hamel.State`, or a dictionary of what `System.state` takes, not {at!r}")
        return at._numbers()

    # --- what is asked ----------------------------------------------------------------------------------------------

    def evaluate(self, at: State | Mapping[str, Any] | None = None) -> dict[str, Any]:
        """Numbers of everything at a state, as `hamel eval` prints them: A, Y, gamma, M, Gamma, forces, energies.

        With n velocities, M is (n, n), gamma and Gamma are (n, n, n), forces (n,), and energies are numbers (J).
        """
        values: dict[str, Any] = json.loads(self._session.evaluate(self._at(at)))
        return {name: _numeric(value) for name, value in values.items()}

    def tables(self, *of: str, all: bool = False) -> Tables:
        """Tables by their names, such as `gamma`, `M` and `Gamma`; those that matter where none is named."""
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
        events: Mapping[str, Event | Watched] | None = None,
    ) -> Run:
        """A run from a state, by default the start.

        Parameters
        ----------
        until : length of the run (s).
        method : one of `hamel simulate --help`; `"auto"` takes what fits the system.
        step : length of a step (s); `tol`: the permitted error per step, where steps are chosen by it.
        rate : the rate at which the method `rk4` leads back to the constraint (1/s).
        every : a sample after so many steps; `spacing`: at multiples of this time (s); `times`: at these times (s), (k,). One of
            the three, or none for some thousand samples at most.
        inputs : `{"F": 2.0, "tau": "-k * q"}` with numbers, or expressions of `t`, parameters, coordinates and velocities; or
            a function of (t, x, xi) that returns u, (inputs,); or a file of CSV, whose values `hold` until the next row.
        events : `{"ground": hamel.Event("foot.p[3]", direction=-1, terminal=True)}`, by names of your choice: where an
            expression or a function of (t, x, xi) changes its sign. An expression or a function alone will do, too; `terminal`
            and `direction` of a function are read as SciPy's `solve_ivp` reads them. `run.events["ground"].t` are the times,
            found to rounding, and `run.stopped_by` is the name of the event that has ended the run. Signs are compared at the
            ends of steps, so that two changes within one step are not seen; a zero at the start of the run is no event.

        Raises RunError where a run ends early, with what there was until then.
        """
        state = self._at(at)
        spaced = {"every": every, "spacing": spacing, "times": times}
        given = [f"`{name}`" for name, value in spaced.items() if value is not None]
        if len(given) > 1:
            raise HamelError(f"samples are taken in one way, {' and '.join(given)} were given")
        if rate is not None and method != "rk4":
            raise HamelError("`rate` goes with the method rk4 alone: the other methods keep the constraint by themselves")
        if hold and not isinstance(inputs, str | os.PathLike):
            raise HamelError("`hold` goes with a file of inputs, whose values it holds until the next row")
        numbers = {"step": step, "tol": tol, "rate": rate, "spacing": spacing}
        options: dict[str, Any] = {
            "until": _number("until", until),
            "method": _method(method),
            **{name: None if value is None else _number(name, value) for name, value in numbers.items()},
            "times": None if times is None else _array(times).ravel().tolist(),
        }
        if every is not None:
            try:
                # More steps than can be counted are as good as all of them.
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
                        raise HamelError(f"the input `{name}` is finite, {value!r} was given")
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
        options["events"] = [_watched(name, event) for name, event in (events or {}).items()]
        found = self._session.simulate(state, options)
        found["events"] = {name: Happened(*parts) for name, parts in found["events"].items()}
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
        """x and xi after a step of length h (s) with constant inputs, of one state or of many along the first axes.

        x is (…, coordinates), xi (…, velocities), u (…, inputs), and the results are as x and xi. h may be negative. Raises
        SingularError where a state has no step, with the index of the state.
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
        """A step of length h (s) from a state with constant inputs, and its slopes [A B]: rows and columns as in `linearize`.

        They are those of the step itself, to rounding, not of the motion; with `full` displacements where constraints act.
        """
        state = self._at(at)
        x, xi, slopes = self._session.step_slopes(state, _number("h", h), _method(method))
        rows = slopes.shape[0]
        return StepSlopes(x, xi, slopes[:, :rows], slopes[:, rows:])

    def linearize(self, at: State | Mapping[str, Any] | None = None, *, full: bool = False) -> Linearization:
        """The motion near a state. Constraints leave some displacements and velocities; `full` has all of them."""
        return Linearization(**self._session.linearize(self._at(at), full))

    def base_parameters(self) -> BaseParameters:
        """The base parameters beta (p,), those that the p columns of `regressor` belong to."""
        found = self._session.base_parameters()
        return BaseParameters(json.loads(found["json"]), found["text"], found["latex"], found["markdown"])


def _watched(name: str, event: Event | Watched) -> tuple[str, Watched, int, bool]:
    """An event as the session takes it."""
    if not isinstance(event, Event):
        event = Event(event, getattr(event, "direction", 0), getattr(event, "terminal", False))
    if not isinstance(event.of, str) and not callable(event.of):
        raise HamelError(f"the event `{name}` is an expression or a function of (t, x, xi), not {event.of!r}")
    if not isinstance(name, str):
        raise HamelError(f"the name of an event is a text, not {name!r}")
    if not isinstance(event.direction, int | float | np.number) or np.isnan(event.direction):
        raise HamelError(f"`direction` of the event `{name}` is 1, -1 or 0, not {event.direction!r}")
    if event.terminal not in (False, True):
        raise HamelError(f"`terminal` of the event `{name}` is True or False: a run ends at the first event, not after some of them")
    return name, event.of, int(np.sign(event.direction)), bool(event.terminal)


def _numeric(value: Any) -> Any:
    """Lists of numbers as arrays, without a value as NaN."""
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
