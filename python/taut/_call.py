# SPDX-License-Identifier: MIT
"""How calls of the library are made: who watches them, and what becomes of their ends."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, TypeVar, Union

import numpy as np

from ._native import native
from .errors import Cancelled, Interrupted, NoMap, ParameterError

T = TypeVar("T")

#: A function of a `Progress` whose answer of False ends the call with the best result so far; True: a line on standard
#: error, or a bar of tqdm where that is installed.
ProgressLike = Union[Callable[[Any], Any], bool, None]

#: Options that are whole numbers, which may be given as floats that are.
_WHOLE = ("resolution", "max_resolution", "padding", "tiles", "align", "iterations")

#: Arguments by what the library calls them.
_NAMES = {
    "gradient_tolerance": "tolerance",
    "max_iterations": "iterations",
    "data.weights": "weights",
    "data.attributes": "attributes",
    "data.directions": "directions",
    "data.parameters": "parameters",
}

_watching: ContextVar[Any] = ContextVar("taut_control", default=None)


@contextmanager
def watched_by(control: Any) -> Iterator[None]:
    """Calls of this context are watched by `control`, as those of a job."""
    token = _watching.set(control)
    try:
        yield
    finally:
        _watching.reset(token)


def control() -> Any:
    return _watching.get() or native().Control()


class _Line:
    """Progress as a line that is drawn over and over."""

    def __init__(self) -> None:
        self._bar: Any = None
        try:
            from tqdm import tqdm  # type: ignore[import-untyped,unused-ignore]

            self._bar = tqdm(bar_format="{desc}", leave=False, file=sys.stderr)
        except ImportError:
            pass

    def __call__(self, p: Any) -> None:
        value = "" if p.value != p.value else f"  {p.value:.6g}"
        text = f"{p.stage}  {p.iteration}{value}  {p.seconds:.1f} s"
        if self._bar is not None:
            self._bar.set_description_str(text)
        else:
            sys.stderr.write(f"\r{text}\x1b[K")
            sys.stderr.flush()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        else:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()


@contextmanager
def named(names: Mapping[str, str]) -> Iterator[None]:
    """Errors of arguments speak of these as Python has them.

    names : what the library calls them, and what the call does; others have the same name in both
    """
    names = {**_NAMES, **names}
    try:
        yield
    except ParameterError as e:
        begin = f"{e.field}: "
        if not str(e).startswith(begin):
            raise
        name, what = names.get(str(e.field), str(e.field)), str(e)[len(begin) :]
        for old, new in names.items():
            what = what.replace(f"`{old}`", f"`{new}`")
        raise ParameterError(f"{name}: {what}", field=name) from None


@contextmanager
def shown(progress: ProgressLike) -> Iterator[Any]:
    """What the library tells progress to while a call lasts: a function, or None."""
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise ParameterError(f"progress: is {progress!r}, but must be a function, or True for a line", field="progress")
    line = _Line() if progress is True else None
    try:
        yield line or progress or None
    finally:
        if line is not None:
            line.close()


def _checked(options: dict[str, Any]) -> dict[str, Any]:
    """Whole numbers that were given as floats, and limits of time."""
    for name, value in options.items():
        if isinstance(value, np.bool_):
            options[name] = bool(value)
    for name in _WHOLE:
        value = options.get(name)
        if isinstance(value, (float, np.floating)) and float(value).is_integer():
            options[name] = int(value)
    seconds = options.get("time_limit")
    if isinstance(seconds, (int, float)) and not seconds >= 0:
        raise ParameterError(f"time_limit: is {seconds}, but must not be negative", field="time_limit")
    return options


def call(
    function: Callable[..., Any],
    *args: Any,
    progress: ProgressLike,
    make: Callable[[dict[str, Any]], T],
    names: Mapping[str, str] | None = None,
) -> T:
    """Calls the library with `args` and a dict of options as the last of them, which gets `progress`.

    make : turns what the library returns into a result; raises `NoMap` where it is none.
    names : as of `named()`
    """
    options = _checked(args[-1])
    with shown(progress) as options["progress"], named(names or {}):
        told = function(*args, control())
    return conclude(told, make)


def _once(wait: Callable[[], Any]) -> Callable[[], Any]:
    """What is waited for once, also where several threads ask."""
    lock = threading.Lock()
    found: list[Any] = []

    def get() -> Any:
        with lock:
            if not found:
                found.append(wait())
            return found[0]

    return get


def conclude(
    told: tuple[str, dict[str, Any] | None, Callable[[], dict[str, Any] | None] | None],
    make: Callable[[dict[str, Any]], T],
) -> T:
    """The result of a call that ended so, or the exception that it ends with.

    told : how it ended, what it found, and of work that was left alone a function that waits for what it finds
    """
    ended, found, later = told
    if ended == "finished" and found is not None:
        return make(found)

    def best_of(d: dict[str, Any] | None) -> Any:
        try:
            return None if d is None else make(d)
        except NoMap:
            return None

    best, wait = best_of(found), None
    if later is not None:
        what, wait = "; it still ends, and .best waits for its result", _once(lambda: best_of(later()))
    else:
        what = "; .best has the result so far" if best is not None else ", before there was a result"
    if ended == "cancelled":
        raise Cancelled("the call was cancelled" + what, best=best, later=wait)
    raise Interrupted("the call was interrupted" + what, best=best, later=wait)
