# SPDX-License-Identifier: GPL-3.0-or-later
"""The one exception that ends a run with a message for the user instead of a traceback."""

from __future__ import annotations


class RunError(Exception):
    """Names the cause, and what to do about it, in one sentence on one line."""

    def __init__(self, message: str) -> None:
        super().__init__(" ".join(str(message).split()))
