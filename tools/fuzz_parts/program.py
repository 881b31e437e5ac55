# SPDX-License-Identifier: Apache-2.0
"""`lamina`, run on one scene after another, and what is wrong with every run whatever was asked."""
import json
import math
import os
import resource
import shlex
import signal
import subprocess
import time
from dataclasses import dataclass, field

import numpy

from . import pictures

# Words by which reports of the sanitizers are known.
REPORTS = ("AddressSanitizer", "LeakSanitizer", "ThreadSanitizer", "UndefinedBehaviorSanitizer", "runtime error:")
WAITING = 10  # times as long may a run wait for its processors


@dataclass
class Finding:
    kind: str
    text: str
    times: float = 0  # how many times the bound; 0 if there is none


@dataclass
class Outcome:
    command: str
    exit_code: int
    messages: list
    seconds: float
    picture: numpy.ndarray = None
    stats: dict = field(default_factory=dict)


class Program:
    def __init__(self, lamina, folder, seconds):
        """folder: of the scene; pictures and statistics go there, too."""
        self.lamina, self.folder, self.seconds = lamina, folder, seconds
        self.findings = []
        self.commands = []

    def limit(self, seconds):
        """Limits processor time: other work on the machine does not count."""
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 5))

    def report(self, kind, text, times=0):
        self.findings.append(Finding(kind, text, times))

    def render(self, name, arguments, suffix=".exr", scene="scene.json", least=False, patience=1):
        """None if it ended in an error, said as it should be or not. least: on one processor, with the least
        instructions; patience: how many times the usual seconds it may take."""
        seconds = patience * self.seconds
        picture, stats = self.folder / f"{name}{suffix}", self.folder / f"{name}.json"
        command = ["render", scene, "-o", picture.name, "--stats", stats.name, *arguments]
        command = [str(self.lamina), *command]
        if least:
            command = ["taskset", "-c", str(min(os.sched_getaffinity(0))), "env", "LAMINA_INSTRUCTIONS=SSE4", *command]
        self.commands.append(shlex.join(command))
        start = time.monotonic()
        try:
            done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=WAITING * seconds,
                                  preexec_fn=lambda: self.limit(seconds))
        except subprocess.TimeoutExpired:
            self.report("hang", f"{name}: no end after {WAITING * seconds:g} s")
            return None
        if done.returncode == -signal.SIGXCPU:
            self.report("hang", f"{name}: no end after {seconds:g} s of a processor")
            return None
        messages = done.stderr.decode("utf-8", "replace").splitlines()
        found = Outcome(self.commands[-1], done.returncode, messages, time.monotonic() - start)
        if not self.ended_well(name, found, picture, stats):
            return None
        found.stats = json.loads(stats.read_text())
        found.picture = pictures.read(picture)
        if not numpy.isfinite(found.picture).all():
            self.report("nan", f"{name}: numbers in the picture that are none")
            return None
        # Opacity is 1 - product of numbers 0..1; float32 adds slabs up, by one rounding each.
        alpha = found.picture[..., 3]
        if alpha.min() < -1e-4 or alpha.max() > 1 + 1e-4 or found.picture.min() < -1e-4:
            self.report("range", f"{name}: opacity {alpha.min():.6g} to {alpha.max():.6g}, "
                                 f"least {found.picture.min():.3g}")
        return found

    def chosen_scene(self, name):
        """The scene with what lamina chooses for it; None if it ended in an error."""
        command = [str(self.lamina), "scene", "scene.json", "-o", name]
        self.commands.append(shlex.join(command))
        done = subprocess.run(command, cwd=self.folder, capture_output=True, timeout=WAITING * self.seconds,
                              preexec_fn=lambda: self.limit(self.seconds))
        if done.returncode == 0:
            return json.loads((self.folder / name).read_text())
        lines = done.stderr.decode("utf-8", "replace").splitlines()
        self.refusal = lines[-1] if lines else ""
        if done.returncode != 1 or not self.refusal.startswith("lamina: "):
            self.report("crash", f"scene: exit code {done.returncode}: {self.refusal}")
        return None

    def ended_well(self, name, found, picture, stats):
        """Tells whether there is a picture; reports what is wrong."""
        text = " | ".join(found.messages[:4])[:400]
        if any(report in line for report in REPORTS for line in found.messages):
            self.report("sanitizer", f"{name}: {text}")
        elif found.exit_code == 1:
            written = picture.exists() or stats.exists()
            # The error is the last line; warnings before it have lines of their own.
            if not found.messages or any(not line.startswith("lamina: ") for line in found.messages) or written:
                self.report("message", f"{name}: expected one line, nothing written; found {text or 'nothing'}")
            self.refusal = found.messages[-1] if found.messages else ""
        elif found.exit_code != 0:
            self.report("crash", f"{name}: exit code {found.exit_code}: {text}")
        elif not picture.exists() or not stats.exists():
            self.report("message", f"{name}: exit code 0, and no picture or statistics")
        else:
            return True
        return False
