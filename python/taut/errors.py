# SPDX-License-Identifier: MIT
"""What the calls of taut raise.

All derive from `TautError`, but `Interrupted`, which is a `KeyboardInterrupt`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from . import _drivers


class TautError(RuntimeError):
    """Base of what taut raises.

    Attributes
    ----------
    ids : list of int
        Vertices or elements that the message is about, counted from 0; empty where it names none.
    field : str or None
        The argument that is wrong.
    fault : str or None
        A word for programs, as "closed_surface".
    notes : list of str
        What was found or decided on the way, in sentences.
    """

    def __init__(
        self,
        message: str = "",
        *,
        ids: Iterable[int] = (),
        field: str | None = None,
        fault: str | None = None,
        notes: Iterable[str] = (),
        **more: Any,
    ) -> None:
        super().__init__(message)
        self.ids = [int(i) for i in ids]
        self.field = field
        self.fault = fault
        self.notes = list(notes)
        for name, value in more.items():
            setattr(self, name, value)


class ParameterError(TautError, ValueError):
    """An argument outside of its domain; `field` names it."""

    def __init__(self, message: str = "", **more: Any) -> None:
        # The library calls arguments parameters; here they are called by their names alone.
        super().__init__(message.removeprefix("parameter "), **more)


class MeshError(TautError, ValueError):
    """A mesh that cannot be used; `fault` says why, `ids` where."""


class ConstraintError(TautError, ValueError):
    """Pins and springs that cannot hold, or that say the same twice; `ids` are their vertices."""


class TraceError(TautError, TypeError):
    """An energy in Python that does what cannot be recorded."""


class FileError(TautError, OSError):
    """A file that cannot be read, understood or written; `path` names it."""

    path: str = ""


class DeviceError(TautError):
    """The device that was asked for is not there, or one failed; `remedy` says what to do."""

    remedy: str = ""

    def __init__(self, message: str = "", **more: Any) -> None:
        if not self.remedy and "no OpenCL platform is installed" in message:
            self.remedy = _drivers.remedy()
            message = f"there is no OpenCL device; {self.remedy}\n{message}"
        super().__init__(message, **more)


class NoMap(TautError):
    """There is no valid map.

    Attributes
    ----------
    reason : str
        Why.
    best : Map or None
        The map with the fewest defects, where there is one. It is not certified, unless `fault` is "not_finite": the
        energy has no value there.
    """

    def __init__(self, message: str = "", *, best: Any = None, **more: Any) -> None:
        super().__init__(message, **more)
        self.reason = message
        self.best = best


class Infeasible(NoMap):
    """No map exists that obeys the pins; `proof` says why, `ids` are what it names."""

    def __init__(self, message: str = "", **more: Any) -> None:
        super().__init__(message, **more)
        self.proof = message


class _WithBest(BaseException):
    """An end before the end of the work: what there is by then, or what the work still comes to."""

    _best: Any = None
    _later: Callable[[], Any] | None = None

    @property
    def best(self) -> Any:
        """The best valid result by then, or None. Where the work had not ended within 0.4 s, it is waited for."""
        later = self._later
        if later is not None:
            self._best = later()
            self._later = None
        return self._best

    def __reduce__(self) -> Any:
        return type(self), self.args, {**self.__dict__, "_later": None}


class Cancelled(_WithBest, TautError):
    """A job that was cancelled; `best` is the best valid result by then, or None."""

    def __init__(self, message: str = "", *, best: Any = None, later: Callable[[], Any] | None = None, **more: Any) -> None:
        super().__init__(message, _best=best, _later=later, **more)


class Interrupted(_WithBest, KeyboardInterrupt):
    """Ctrl-C during a call; `best` is the best valid result by then, or None."""

    def __init__(self, message: str = "", *, best: Any = None, later: Callable[[], Any] | None = None) -> None:
        super().__init__(message)
        self._best, self._later = best, later
