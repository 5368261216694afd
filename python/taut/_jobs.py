# SPDX-License-Identifier: MIT
"""Calls on threads of their own."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from . import _arrays
from ._call import watched_by
from ._native import native
from .errors import ParameterError

T = TypeVar("T")


class Job(Generic[T]):
    """A call that runs on a thread of its own, with a queue of its own.

    Attributes
    ----------
    done : bool
    progress : Progress
        Where it stands.
    """

    def __init__(self, function: Callable[..., T], args: tuple[Any, ...], keywords: dict[str, Any]) -> None:
        self._control = native().Control()
        self._result: T | None = None
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, args=(function, args, keywords), daemon=True)
        self._thread.start()

    def _run(self, function: Callable[..., T], args: tuple[Any, ...], keywords: dict[str, Any]) -> None:
        try:
            with watched_by(self._control):
                self._result = function(*args, **keywords)
        except BaseException as e:
            self._error = e

    @property
    def done(self) -> bool:
        return not self._thread.is_alive()

    @property
    def progress(self) -> Any:
        return self._control.progress

    def cancel(self) -> None:
        """Ends the call. `result` then raises `Cancelled`, with the best valid result so far."""
        self._control.cancel()

    def result(self, timeout: float | None = None) -> T:
        """The result, or what the call raised. Raises `TimeoutError` where there is none after so many seconds."""
        self._thread.join(None if timeout is None else _arrays.number("timeout", timeout))
        if self._thread.is_alive():
            raise TimeoutError("the job is still at work")
        if self._error is not None:
            raise self._error
        return self._result  # type: ignore[return-value]

    def __repr__(self) -> str:
        return f"<taut.Job, {'done' if self.done else 'at work: ' + str(self.progress)}>"


def start(function: Callable[..., T], *args: Any, **keywords: Any) -> Job[T]:
    """Start a call on a thread of its own.

    Examples
    --------
    >>> import numpy as np, taut
    >>> V = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0.5], [0, 1, 0]])
    >>> job = taut.start(taut.unwrap, V, [[0, 1, 2], [0, 2, 3]])
    >>> job.result(timeout=60).certified
    True
    """
    if not callable(function):
        raise ParameterError(f"function: is {function!r}, but must be one, as taut.unwrap", field="function")
    return Job(function, args, keywords)
