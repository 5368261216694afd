# SPDX-License-Identifier: MIT
"""The compiled module, imported by the first call that needs it, so that `import taut` works without a driver."""

from __future__ import annotations

import atexit
import threading
from typing import Any

from . import _drivers
from .errors import DeviceError

_lock = threading.Lock()
_module: Any = None


def native() -> Any:
    """The module `_taut`. Raises `DeviceError` where it does not load for want of an OpenCL loader."""
    global _module
    if _module is None:
        with _lock:
            if _module is None:
                _drivers.announce()
                try:
                    from . import _taut
                except ImportError as e:
                    if "OpenCL" not in str(e):
                        raise
                    raise DeviceError(str(e)) from None
                atexit.register(_close)
                from . import _trace

                _trace.prepare(_taut)
                _module = _taut
    return _module


def _close() -> None:
    """Before the interpreter ends: drivers must not go while work or queues are left."""
    if _module is not None:
        _module.join_left_work()
        _module.drop_queues()
