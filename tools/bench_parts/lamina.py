# SPDX-License-Identifier: Apache-2.0
"""`lamina`, as a program that is run."""
import json
import math
import os
import pathlib
import shlex
import subprocess
import time


class OutOfTime(SystemExit):
    """The deadline came before or while a program ran."""


class Lamina:
    deadline = None  # by time.monotonic(): runs end then; None: never
    variables = {}  # of the environment, beside those that are set

    def __init__(self, program, folder):
        """folder: for pictures and statistics; the caller removes it."""
        self.program = program
        self.folder = pathlib.Path(folder)

    def run(self, *arguments, accepted=(0,)):
        """Returns what is printed; ends the caller at an exit code that is not accepted."""
        command = [str(self.program), *map(str, arguments)]
        left = None if self.deadline is None else max(0, self.deadline - time.monotonic())
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=left,
                                  env={**os.environ, **self.variables})
        except subprocess.TimeoutExpired:
            raise OutOfTime(f"out of time: {shlex.join(command)}")
        except OSError as error:
            raise SystemExit(f"bench: {self.program}: {error.strerror}; build lamina or name it with --lamina")
        if done.returncode not in accepted:
            raise SystemExit(f"bench: {shlex.join(command)}: {done.stderr.strip()}")
        return done.stdout

    def frames(self, scene, arguments, frames):
        """The statistics of a run of one warm-up and this many timed frames, the camera turning."""
        stats = self.folder / "stats.json"
        self.run("render", scene, "-o", self.folder / "timed.exr", "--stats", stats, "--frames", frames, "--quiet",
                 *arguments)
        return json.loads(stats.read_text())

    def picture(self, name, scene, arguments):
        path = self.folder / f"{name}.exr"
        self.run("render", scene, "-o", path, "--quiet", *arguments)
        return path

    def color_error(self, picture, reference):
        """Linf and L2 over R, G and B of linear associated colour, in 1/255."""
        channels = json.loads(self.run("compare", picture, reference, "--json"))["channels"]
        colors = [channels[name] for name in "RGB"]
        return {"linf": max(norms["linf"] for norms in colors),
                "l2": math.sqrt(sum(norms["l2"] ** 2 for norms in colors) / 3)}
