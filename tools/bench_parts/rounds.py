# SPDX-License-Identifier: Apache-2.0
"""Times of several ways to do one thing, side by side on a machine with other load."""
import statistics


def interleaved(ways, rounds):
    """Milliseconds of each way and round. A round is one call of every way, one after the other, so that all meet the
    same other load. ways: functions by name, each gives the median time of its frames."""
    times = {name: [] for name in ways}
    for _ in range(rounds):
        for name, measure in ways.items():
            times[name].append(measure())
    return times


def ratio(slower, faster):
    """Returns median and range over the rounds of how many times as fast the second way is as the first."""
    ratios = sorted(a / b for a, b in zip(slower, faster))
    return {"median": statistics.median(ratios), "min": ratios[0], "max": ratios[-1]}


def ratio_text(found):
    return f"{found['median']:6.2f} times as fast ({found['min']:.2f} .. {found['max']:.2f})"
