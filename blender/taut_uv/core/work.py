# SPDX-License-Identifier: MIT
"""Results of commands, and commands that run while the user goes on."""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .messages import Problem
from .surface import Surface


@dataclass
class Result:
    """What a command has made.

    Attributes
    ----------
    uv : (c, 2) float64
        Coordinates of all corners, numbers of single precision; those of no changed island are as they were.
    changed : (c,) bool
        Corners of islands that have new coordinates.
    seam : (e,) bool or None
        New marks of seams; None: as they were.
    selected : (f,) bool or None
        Faces to be selected.
    problems : list of Problem
        What could not be done; all else was.
    notes : list of str
    complete : bool
        False: it was stopped, or the time was over. What is there is valid.
    numbers : dict
        Of the result, such as counts.
    """

    uv: np.ndarray
    changed: np.ndarray
    seam: np.ndarray | None = None
    selected: np.ndarray | None = None
    problems: list[Problem] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    complete: bool = True
    numbers: dict[str, Any] = field(default_factory=dict)

    @staticmethod
    def of(s: Surface) -> "Result":
        return Result(s.uv.copy(), np.zeros(s.corners, bool))


def untold(note: str) -> None:
    """What a command tells where nobody asks."""


class Clock:
    """What is left of a time limit in seconds; 0 or less: there is none."""

    def __init__(self, limit: float = 0) -> None:
        self._end = time.monotonic() + limit if limit > 0 else None

    @property
    def left(self) -> float | None:
        """Seconds for a call of the library; None: no limit."""
        return None if self._end is None else max(self._end - time.monotonic(), 1e-3)

    @property
    def over(self) -> bool:
        return self._end is not None and time.monotonic() >= self._end


class Task:
    """A command on a thread of its own: what a panel or a modal operator watches.

    >>> task = Task(taut, unwrap, surface, time_limit=5)   # doctest: +SKIP
    >>> while not task.done: draw(task.line)               # doctest: +SKIP
    """

    def __init__(self, taut: Any, command: Any, surface: Surface, **options: Any) -> None:
        self.note = ""
        self._job = taut.start(command, taut, surface, tell=self._tell, **options)
        self._began = time.monotonic()
        self.stopped = False

    def _tell(self, note: str) -> None:
        self.note = note

    @property
    def done(self) -> bool:
        return self._job.done

    @property
    def seconds(self) -> float:
        return time.monotonic() - self._began

    @property
    def line(self) -> str:
        """Where it stands, in a line."""
        p = self._job.progress
        value = "" if p.value != p.value else f", energy {p.value:.4g}"
        return f"{self.note + ': ' if self.note else ''}{p.stage or 'begins'}{value}, {self.seconds:.1f} s"

    @property
    def usable(self) -> bool:
        """Whether the call of now would leave a result if it were stopped."""
        return bool(self._job.progress.usable)

    def stop(self) -> None:
        """Ends it soon; `result` then has what is done."""
        self.stopped = True
        self._job.cancel()

    def result(self, timeout: float | None = None) -> Result:
        """What the command returns, or raises."""
        return self._job.result(timeout)
