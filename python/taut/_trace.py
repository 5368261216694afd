# SPDX-License-Identifier: MIT
"""Energies written in Python: a function of one element runs once, on traced values, and becomes kernels."""

from __future__ import annotations

import inspect
import sys
from collections.abc import Callable
from typing import Any, Union, overload

import numpy as np

from . import _arrays
from ._native import native
from .errors import ParameterError, TautError, TraceError

_UNARY = {
    "negative": lambda a: -a,
    "positive": lambda a: a,
    "absolute": abs,
    "fabs": abs,
    "square": lambda a: a * a,
    "reciprocal": lambda a: 1.0 / a,
    **{name: (lambda name: lambda a: getattr(a, name)())(name)
       for name in ("sqrt", "cbrt", "exp", "log", "sin", "cos", "tan", "arctan", "floor")},
}
_BINARY = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: a / b,
    "true_divide": lambda a, b: a / b,
    "power": lambda a, b: a**b,
    "float_power": lambda a, b: a**b,
    "less": lambda a, b: a < b,
    "less_equal": lambda a, b: a <= b,
    "greater": lambda a, b: a > b,
    "greater_equal": lambda a, b: a >= b,
    "equal": lambda a, b: a == b,
    "not_equal": lambda a, b: a != b,
    "logical_and": lambda a, b: a & b,
    "logical_or": lambda a, b: a | b,
    "minimum": lambda a, b: _sym(a).minimum(_sym(b)),
    "maximum": lambda a, b: _sym(a).maximum(_sym(b)),
}


def _sym(value: Any) -> Any:
    return value if isinstance(value, native().Sym) else native().constant(float(value))


def _plain(value: Any) -> Any:
    """A number of numpy as one of Python, so that operators are those of traced values."""
    return value.item() if isinstance(value, np.generic) else value


def _ufunc(self: Any, ufunc: Any, method: str, *inputs: Any, **keywords: Any) -> Any:
    """numpy's functions of traced values, and of arrays that have some."""
    name = ufunc.__name__
    if method != "__call__" or keywords:
        raise TraceError(f"numpy.{name}.{method} has no counterpart for traced values; write it with operators")
    if name == "matmul":
        a, b = (np.asarray(i, dtype=object).view(np.ndarray) for i in inputs)
        return np.asarray(np.matmul(a, b)).view(SymArray) if a.ndim + b.ndim > 2 else np.matmul(a, b)
    table: Any = _UNARY if len(inputs) == 1 else _BINARY
    if name not in table:
        raise TraceError(f"numpy.{name} has no counterpart for traced values")
    function = table[name]
    if not any(isinstance(i, np.ndarray) and i.ndim > 0 for i in inputs):
        return function(*(_plain(i[()] if isinstance(i, np.ndarray) else i) for i in inputs))
    plain = [np.asarray(i, dtype=object).view(np.ndarray) if isinstance(i, np.ndarray) else i for i in inputs]
    return np.asarray(np.frompyfunc(lambda *v: function(*map(_plain, v)), len(inputs), 1)(*plain)).view(SymArray)


class SymArray(np.ndarray):  # type: ignore[type-arg]
    """A matrix or vector of traced values: indices, `T`, operators, `@` and numpy's functions work as on any array."""

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **keywords: Any) -> Any:
        return _ufunc(self, ufunc, method, *inputs, **keywords)

    def _rows(self) -> list[list[Any]]:
        if self.shape not in ((2, 2), (3, 3)):
            raise TraceError(f"an array of the shape {self.shape} is no square matrix of 2 or 3 rows")
        return [list(row) for row in self]

    def norm2(self) -> Any:
        """Sum of the squares of all entries."""
        if self.ndim == 2:
            return getattr(native(), f"norm2_{len(self)}")(self._rows())
        entries = list(self)
        total = entries[0] * entries[0]
        for e in entries[1:]:
            total = total + e * e
        return total

    def det(self) -> Any:
        """Determinant."""
        return getattr(native(), f"determinant_{len(self)}")(self._rows())

    def inverse(self) -> Any:
        """Inverse matrix."""
        return _array(getattr(native(), f"inverse_{len(self)}")(self._rows()))

    def trace(self, *_: Any, **__: Any) -> Any:
        """Sum of the diagonal."""
        rows = self._rows()
        total = rows[0][0]
        for k in range(1, len(rows)):
            total = total + rows[k][k]
        return total


def _array(rows: Any) -> SymArray:
    a = np.empty((len(rows), len(rows[0])), dtype=object)
    for r, row in enumerate(rows):
        for c, entry in enumerate(row):
            a[r, c] = entry
    return a.view(SymArray)


class _Direction:
    """The direction of an element, in its own frame: `S @ direction` is its image."""

    __array_ufunc__ = None

    def __rmatmul__(self, S: Any) -> Any:
        return S[:, 0]


class Element:
    """What an energy sees of one element.

    Attributes
    ----------
    S : (d, d) array of traced values
        From the ideal to the physical element; a rotation where nothing is distorted.
    J : traced value
        Determinant of S: mapped by rest measure.
    measure : traced value
        Rest area or volume, the mean element having about 1.
    direction
        `S @ direction` is the image of the direction that the call was given for this element.
    dim : int
        2 or 3.
    """

    direction = _Direction()

    def __init__(self, recording: Any, dim: int) -> None:
        self._recording = recording
        self.dim = dim
        self.S = _array(recording.S())
        self.J = recording.det()
        self.measure = recording.measure()

    def attribute(self, k: int) -> Any:
        """Number k that the call was given for this element."""
        return self._recording.attribute(k)

    def parameter(self, k: int) -> Any:
        """Number k that the call was given for all elements: another value takes no other kernel."""
        return self._recording.parameter(k)


def where(condition: Any, a: Any, b: Any) -> Any:
    """`a` where a condition of traced values holds, else `b`. Both are computed, one is taken.

    Examples
    --------
    >>> import taut
    >>> @taut.energy
    ... def soft(s):
    ...     return s.S.norm2() + taut.where(s.J < 1, s.J - 1 - np.log(s.J), 0)
    """
    if isinstance(condition, np.ndarray):
        return np.asarray(np.frompyfunc(where, 3, 1)(np.asarray(condition), a, b)).view(SymArray)
    if isinstance(condition, (bool, np.bool_)):
        return a if condition else b
    return native().select(condition, _sym(_plain(a)), _sym(_plain(b)))


class Energy:
    """An energy: a function of one element. Energies are added, multiplied, and multiplied with numbers.

    Parameters
    ----------
    function : callable
        Takes an `Element`, returns a traced value.
    barrier : bool
        Whether the energy tends to infinity as J falls to 0. It is infinite from there on.
    """

    def __init__(self, function: Callable[[Any], Any], *, barrier: bool = True) -> None:
        self.function = function
        self.barrier = barrier
        self._bound: Any = None
        self._faults: dict[int, BaseException] = {}
        for name in ("__name__", "__qualname__", "__module__", "__doc__"):
            if hasattr(function, name):
                setattr(self, name, getattr(function, name))

    def __call__(self, element: Any) -> Any:
        return self.function(element)

    def __repr__(self) -> str:
        return f"taut.Energy({getattr(self.function, '__qualname__', self.function)!r})"

    def __add__(self, other: object) -> Energy:
        if not isinstance(other, Energy):
            return NotImplemented
        return Energy(_Sum(self, other), barrier=self.barrier or other.barrier)

    def __mul__(self, other: object) -> Energy:
        if isinstance(other, Energy):
            return Energy(_Product(self, other), barrier=self.barrier or other.barrier)
        if isinstance(other, (int, float, np.number)):
            factor = _arrays.number("factor", other)
            if not np.isfinite(factor):
                raise ParameterError(f"factor: is {factor}; an energy is multiplied by a finite number", field="factor")
            return Energy(_Scaled(factor, self), barrier=self.barrier)
        return NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, other: float) -> Energy:
        divisor = _arrays.number("divisor", other)
        if divisor == 0:
            raise ParameterError("divisor: is 0; an energy is divided by another number", field="divisor")
        return self * (1.0 / divisor)

    def __reduce__(self) -> Any:
        # One that a module has under its own name, as a decorated function, is found there again.
        qualname = getattr(self, "__qualname__", None)
        if qualname and getattr(sys.modules.get(self.__module__), qualname, None) is self:
            return qualname
        return _restore, (type(self), self.function, self.barrier)

    def native(self, dim: int | None = None) -> Any:
        """The energy as the library has it; dim: the dimension that it is needed in."""
        if self._bound is None:
            self._bound = self._record()
        if dim in self._faults:
            raise self._faults[dim]
        return self._bound

    def _record(self) -> Any:
        made: dict[int, Any] = {2: None, 3: None}
        for dim in made:
            recording = getattr(native(), f"Recording{dim}")()
            try:
                recording.record(lambda r=recording, d=dim: _one(self.function(Element(r, d))))
                made[dim] = recording
            except Exception as e:
                self._faults[dim] = e
        if len(self._faults) == 2:
            raise self._faults[2]
        return native().recorded_energy(made[2], made[3], self.barrier)

    def value(self, S: Any, *, measure: float = 1.0, attributes: Any = (), parameters: Any = ()) -> float:
        """The energy of one element, on the host.

        Examples
        --------
        >>> import taut
        >>> taut.energies.isometric.value([[2, 0], [0, 1]])
        6.25
        """
        matrix = _arrays.array("S", S)
        if matrix.shape not in ((2, 2), (3, 3)):
            raise ParameterError(f"S: has the shape {matrix.shape}, but must be (2, 2) or (3, 3)", field="S")
        dim = len(matrix)
        numbers = _numbers_of(attributes, parameters)
        return float(getattr(native(), f"value_{dim}")(self.native(dim), matrix, measure, *numbers))


def _numbers_of(attributes: Any, parameters: Any) -> list[Any]:
    given = {"attributes": attributes, "parameters": parameters}
    return [_arrays.array(name, value).reshape(-1) for name, value in given.items()]


def _one(made: Any) -> Any:
    """What a function of an element has returned, if it is a number of it."""
    made = made[()] if isinstance(made, np.ndarray) and made.ndim == 0 else made
    if isinstance(made, native().Sym):
        return made
    if isinstance(made, (int, float, np.integer, np.floating)) and not isinstance(made, bool):
        return float(made)
    what = "None" if made is None else f"an array of the shape {made.shape}" if isinstance(made, np.ndarray) \
        else f"a {type(made).__name__}"
    raise TraceError(f"the energy returns {what}; return a value of the element, as s.S.norm2()")


def _restore(kind: Any, function: Any, barrier: bool) -> Any:
    return kind(function, barrier=barrier)


class _Sum:
    def __init__(self, a: Energy, b: Energy) -> None:
        self.a, self.b = a, b

    def __call__(self, s: Any) -> Any:
        return self.a(s) + self.b(s)


class _Product(_Sum):
    def __call__(self, s: Any) -> Any:
        return self.a(s) * self.b(s)


class _Scaled:
    def __init__(self, factor: float, e: Energy) -> None:
        self.factor, self.e = factor, e

    def __call__(self, s: Any) -> Any:
        return self.factor * self.e(s)


class BuiltinEnergy(Energy):
    """An energy of the library."""

    def __init__(self, name: str, number: float = 0.0) -> None:
        self.name, self.number = name, number
        super().__init__(self._trace, barrier=True)
        self.__name__ = self.__qualname__ = name
        self.__doc__ = None

    def __reduce__(self) -> Any:
        return BuiltinEnergy, (self.name, self.number)

    def __repr__(self) -> str:
        return f"taut.energies.{self.name}"

    def _trace(self, element: Any) -> Any:
        return element._recording.trace(self.native())

    def _record(self) -> Any:
        return native().builtin_energy(self.name, self.number)


EnergyLike = Union[str, Energy, Callable[[Any], Any]]

_by_name: dict[str, BuiltinEnergy] = {}


def _require_one_argument(function: Callable[..., Any]) -> None:
    try:
        taken = inspect.signature(function)
    except (TypeError, ValueError):  # of what is compiled
        return
    try:
        taken.bind(None)
    except TypeError:
        raise ParameterError("energy: is a function that cannot be called with one element alone; give one of one argument",
                             field="energy") from None


def as_energy(energy: Any) -> Energy:
    """The energy that a word, a function or an energy stands for."""
    if isinstance(energy, Energy):
        return energy
    if isinstance(energy, str):
        if energy not in _by_name:
            made = BuiltinEnergy(energy, {"shape_power": 2.0, "neo_hookean": 0.3}.get(energy, 0.0))
            made.native()
            _by_name[energy] = made
        return _by_name[energy]
    if callable(energy):
        _require_one_argument(energy)
        return Energy(energy)
    raise ParameterError(f"energy: {energy!r} is none; give a name, a function or a taut.Energy", field="energy")


@overload
def energy(function: Callable[[Any], Any], *, barrier: bool = ...) -> Energy: ...
@overload
def energy(function: None = ..., *, barrier: bool = ...) -> Callable[[Callable[[Any], Any]], Energy]: ...


def energy(function: Callable[[Any], Any] | None = None, *, barrier: bool = True) -> Any:
    """Makes an energy of a function of one element. It runs once, on traced values; kernels do the rest.

    Parameters
    ----------
    function : callable
        Takes an `Element` s with `s.S`, `s.J`, `s.measure`, `s.attribute(k)`, `s.parameter(k)`, `s.direction`.
    barrier : bool
        Whether the energy tends to infinity as J falls to 0.

    Examples
    --------
    >>> import taut
    >>> @taut.energy
    ... def symmetric_dirichlet(s):
    ...     return s.S.norm2() * (1 + 1 / s.J**2)
    >>> symmetric_dirichlet.value([[2, 0], [0, 1]])
    6.25
    >>> taut.check_gradient(symmetric_dirichlet)
    []
    """
    if function is None:
        return lambda f: Energy(f, barrier=barrier)
    return Energy(function, barrier=barrier)


def check_gradient(
    energy: EnergyLike,
    dim: int = 2,
    *,
    attributes: Any = (),
    directions: bool = False,
    parameters: Any = (),
    trials: int = 100,
) -> list[str]:
    """What is wrong with an energy, in sentences; an empty list where nothing is.

    The derivatives that kernels use are held against finite differences at random elements, E(S R) against E(S) for
    rotations R, and a barrier is looked at where J falls to 0.

    Parameters
    ----------
    attributes, parameters : array-like
        Numbers that the energy reads.
    directions : bool
        Whether elements come with directions; an energy may see the frame then.
    """
    if dim not in (2, 3):
        raise ParameterError(f"dim: is {dim}, but must be 2 or 3", field="dim")
    numbers = _numbers_of(attributes, parameters)
    check = getattr(native(), f"check_gradient_{dim}")
    return list(check(as_energy(energy).native(dim), numbers[0], directions, numbers[1], trials))


def prepare(module: Any) -> None:
    """Lets traced values answer numpy's functions."""
    module.Sym.__array_ufunc__ = _ufunc


__all__ = ["Element", "Energy", "EnergyLike", "TautError", "check_gradient", "energy", "where"]
