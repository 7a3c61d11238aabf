from collections.abc import Mapping, Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__version__: str
__all__ = ["__version__", "HamelError", "SingularError", "Function", "Linear", "Session", "asked", "command", "decoded"]

_Array = NDArray[np.float64]
_Numbers = tuple[_Array, _Array, _Array, _Array]
_Given = tuple[ArrayLike, ArrayLike, ArrayLike, ArrayLike]
_Named = tuple[list[str], list[tuple[str, int, int]]]

class HamelError(ValueError):
    """Raised for an error in a description or a request, with its place in the source."""

class SingularError(ArithmeticError):
    """Raised if a function has no value: M is not positive definite, or constraints are dependent."""

@final
class Function:
    """Function of a system, compiled to machine code and called with NumPy arrays."""

    @property
    def name(self) -> str: ...
    @property
    def __name__(self) -> str: ...
    @property
    def arguments(self) -> list[str]:
        """Names of the arguments, in order."""
    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the result for one state."""
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
        """Evaluate the function at one state, or at many along the first axes of the arrays.

        Parameters
        ----------
        *args : array_like
            The `arguments`, by position or by keyword, with the entries of one state along the last axis.
        parameters : array_like, optional
            Parameters (..., parameters), in place of those of the system.
        singular : {"raise", "nan"}
            Whether a state without a value raises SingularError, or gives NaN.

        Returns
        -------
        float or array
            Result of the shape of the first axes followed by `shape`.

        Raises
        ------
        SingularError
            If a state has no value, with the index of the state.
        """

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
    def trim(
        self, state: _Given, steady: bool, free: list[str], fix: list[str], rates: list[tuple[str, float]]
    ) -> dict[str, Any]: ...
    def base_parameters(self) -> dict[str, str]: ...

@final
class Linear:
    def __new__(cls, matrices: list[_Array], step: float | None, names: list[list[str]]) -> Linear: ...
    def discretized(self, h: float) -> tuple[_Array, _Array]: ...
    def poles(self) -> NDArray[np.complex128]: ...
    def zeros(self) -> NDArray[np.complex128]: ...
    def modes(self) -> list[tuple[complex, list[str], bool, bool]]: ...
    def regulator(self, q: _Array, r: _Array) -> tuple[_Array, _Array, NDArray[np.complex128]]: ...

def command(words: list[str]) -> int: ...
def decoded(name: str, bytes: bytes) -> str:
    """Decode the bytes of a file: UTF-8, UTF-16, or the encoding of an XML declaration."""

def asked(words: list[str]) -> None: ...
