# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the zip that is the last argument."""

import os
import sys

sys.path.insert(0, os.path.dirname(__file__))
from harness import install  # noqa: E402

install(sys.argv[-1])
