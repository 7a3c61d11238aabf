from collections.abc import Mapping, Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__ = ["__version__", "HamelError", "SingularError", "Function", "Session", "asked", "command", "decoded"]

_Array = NDArray[np.float64]
_Numbers = tuple[_Array, _Array, _Array, _Array]
_Given = tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]
_Named = tuple[list[str], list[tuple[str, int, int]]]

class HamelError(ValueError):
    """What is wrong with a description or with what was asked of it, with its place in the source."""

class SingularError(ArithmeticError):
    """A function has no value: M is not positive definite there, or constraints depend on one another."""

@final
class Function:
    """A function of a system: machine code that is called with NumPy arrays."""

    @property
    def name(self) -> str: ...
    @property
    def __name__(self) -> str: ...
    @property
    def arguments(self) -> list[str]:
        """The names of its arguments, in order."""
    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of the result for one state."""
    def __reduce__(self) -> tuple[Any, ...]: ...
    def __call__(
        self,
        *args: ArrayLike,
        parameters: ArrayLike | None = None,
        singular: Literal["raise", "nan"] = "raise",
        x: ArrayLike = ...,
        xi: ArrayLike = ...,
        xi_dot: ArrayLike = ...,
        p: ArrayLike = ...,
        u: ArrayLike = ...,
    ) -> Any:
        """The result for one state, or for all states that arrays have along their first axes."""

@final
class Session:
    @staticmethod
    def open(
        path: str,
        text: str | None = None,
        *,
        constants: Sequence[tuple[str, str]] = ...,
        floating: bool = False,
        locks: Sequence[tuple[str, str]] = ...,
        params: bool = False,
        mimic: str | None = None,
        name: str | None = None,
        rounding: float | None = None,
    ) -> tuple[Session, str]: ...
    @property
    def name(self) -> str: ...
    @property
    def text(self) -> str: ...
    def coordinates(self) -> _Named: ...
    def velocities(self) -> _Named: ...
    def inputs(self) -> _Named: ...
    def parameters(self) -> _Named: ...
    def outputs(self) -> list[str]: ...
    def joints(self) -> list[tuple[str, int, int]]: ...
    def frames(self) -> list[str]: ...
    def functions(self) -> list[str]: ...
    def start(self) -> _Numbers: ...
    def state(self, params: _Array, json: str) -> _Numbers: ...
    def function(self, name: str, params: _Array, pickled: tuple[Any, ...]) -> Function: ...
    def tables(self, of: list[str], format: str, all: bool) -> str: ...
    def evaluate(self, state: _Given) -> str: ...
    def simulate(self, state: _Given, options: Mapping[str, Any]) -> dict[str, Any]: ...
    def step(
        self, state: _Given, x: ArrayLike, xi: ArrayLike, u: ArrayLike, h: float, method: str
    ) -> tuple[_Array, _Array]: ...
    def step_slopes(self, state: _Given, h: float, method: str) -> tuple[_Array, _Array, _Array]: ...
    def linearize(self, state: _Given, full: bool) -> dict[str, Any]: ...
    def base_parameters(self) -> dict[str, str]: ...

def command(words: list[str]) -> int: ...
def decoded(name: str, bytes: bytes) -> str:
    """The text that the bytes of a file are: UTF-8, UTF-16, or what an XML declaration says."""

def asked(words: list[str]) -> None: ...
