# SPDX-License-Identifier: Apache-2.0
"""The processor, as Linux describes it."""
import pathlib
import platform


def fields():
    """Fields of the first processor in /proc/cpuinfo, by name; empty if there is none."""
    found = {}
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    for line in lines:
        name, _, value = line.partition(":")
        found.setdefault(name.strip(), value.strip())
    return found


def name():
    return fields().get("model name") or platform.processor()
