# SPDX-License-Identifier: GPL-3.0-or-later
"""Conway's notation, read by the tests in their own way: what a signature asks of a surface."""

import re
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Features:
    cones: tuple  # orders of the interior cones
    mirrors: tuple  # for each boundary the orders of its corners
    handles: int
    crosscaps: int

    @property
    def euler(self):
        """Conway's cost formula, exactly."""
        corners = [n for mirror in self.mirrors for n in mirror]
        cost = sum(Fraction(n - 1, n) for n in self.cones) + sum(Fraction(n - 1, 2 * n) for n in corners)
        return 2 - cost - len(self.mirrors) - self.crosscaps - 2 * self.handles

    @property
    def orders(self):
        return [*self.cones, *(n for mirror in self.mirrors for n in mirror)]

    @property
    def geometry(self):
        return "spherical" if self.euler > 0 else "hyperbolic" if self.euler < 0 else "euclidean"

    @property
    def topology(self):
        """(handles, cross-caps, boundaries): handles count as two cross-caps where there is one."""
        if self.crosscaps:
            return 0, self.crosscaps + 2 * self.handles, len(self.mirrors)
        return self.handles, 0, len(self.mirrors)


def features(signature):
    cones, mirrors, handles, crosscaps = [], [], 0, 0
    for big, small, sign in re.findall(r"\((\d+)\)|(\d)|([*xo])", signature):
        if sign == "*":
            mirrors.append([])
        elif sign:
            handles, crosscaps = handles + (sign == "o"), crosscaps + (sign == "x")
        else:
            (mirrors[-1] if mirrors else cones).append(int(big or small))
    return Features(tuple(cones), tuple(map(tuple, mirrors)), handles, crosscaps)
