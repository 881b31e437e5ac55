# SPDX-License-Identifier: Apache-2.0
"""Random choices that are the same on every machine and with every version of Python and numpy."""
import math
import random

import numpy


def rounded(x, digits=7):
    """So few digits that a last bit of the machine's own mathematics does not reach the scene."""
    return float(f"{x:.{digits - 1}e}")


class Dice:
    """Everything is made from random.Random.random() and numpy's RandomState, which are both promised not to change."""

    def __init__(self, seed):
        self.source = random.Random(seed)
        self.arrays = numpy.random.RandomState(seed % 2**32)

    def share(self):
        return self.source.random()

    def chance(self, probability):
        return self.share() < probability

    def whole(self, least, most):
        return least + int(self.share() * (most + 1 - least))

    def pick(self, *choices):
        return choices[self.whole(0, len(choices) - 1)]

    def weighted(self, **weights):
        left = self.share() * sum(weights.values())
        for name, weight in weights.items():
            left -= weight
            if left < 0:
                return name
        return name

    def between(self, least, most):
        return rounded(least + self.share() * (most - least))

    def log_between(self, least, most):
        return rounded(math.exp(math.log(least) + self.share() * math.log(most / least)))

    def vector(self, least, most):
        return [self.between(least, most) for _ in range(3)]

    def direction(self):
        """A vector of any length between about .1 and 1."""
        while True:
            found = self.vector(-1, 1)
            if 0.01 < sum(x * x for x in found) <= 1:
                return found

    def rotation(self):
        """Columns of a rotation: of a quaternion of small whole numbers, so without roots or sines."""
        while True:
            w, x, y, z = (self.whole(-9, 9) for _ in range(4))
            square = w * w + x * x + y * y + z * z
            if square:
                break
        rows = [[w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z]]
        return numpy.array(rows, float) / square

    def array(self, *shape):
        return self.arrays.random_sample(shape)
