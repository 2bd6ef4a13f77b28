# SPDX-License-Identifier: GPL-3.0-or-later
"""`import core` from the checkout, and where the shared meshes, results and the independent judge are."""

import sys
from pathlib import Path

CHECKOUT = Path(__file__).resolve().parents[2]
SHARED = CHECKOUT.parent / "shared"
sys.path.insert(0, str(CHECKOUT / "addon"))
