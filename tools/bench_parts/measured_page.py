# SPDX-License-Identifier: Apache-2.0
"""Tables between markers of a Markdown page, and the machine that they were measured on."""
import datetime
import os
import platform
import re
import subprocess
import textwrap

from bench_parts import processor
from bench_parts.scenes import ROOT

BLOCK = re.compile(r"(<!-- table: ([a-z-]+) -->\n).*?(<!-- end -->)", re.DOTALL)


def names(text):
    return [match.group(2) for match in BLOCK.finditer(text)]


def replace(text, blocks):
    """The text with these blocks by name in it; other blocks stay."""
    def new(match):
        block = blocks.get(match.group(2))
        return match.group(0) if block is None else f"{match.group(1)}\n{block.strip()}\n\n{match.group(3)}"
    return BLOCK.sub(new, text)


def commit():
    """Returns the commit of the source, and whether what is built from it was changed since."""
    def git(*arguments):
        return subprocess.run(["git", "-C", str(ROOT), *arguments], capture_output=True, text=True).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "src", "tools/lamina", "CMakeLists.txt")
    return (git("rev-parse", "--short", "HEAD") or "unknown") + (" with changes" if changed else "")


def machine(engine):
    """engine: `context` of a run's statistics, which names the instruction set."""
    fields, memory = processor.fields(), os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return {"machine": platform.machine() + (", virtual" if "hypervisor" in fields.get("flags", "") else ""),
            "cpu": f"{processor.name()} (family {fields.get('cpu family', '?')}, "
                   f"model {fields.get('model', '?')})",
            "cores": len(os.sched_getaffinity(0)), "memory_gib": round(memory / 2**30), "engine": engine,
            "system": platform.freedesktop_os_release().get("PRETTY_NAME", platform.system()),
            "date": datetime.date.today().isoformat(), "commit": commit()}


WIDTH = 118  # of a line of text
QUICK_RUN = ("**These figures are no measurement.** They are from a quick trial of the script, with one round of\n"
             "pictures of 200 x 150 pixels, and only show the shape of the tables.\n\n")


def machine_line(about, round_count, spread):
    """spread: the median and the ninth decile of the deviation of a round's ratio from the median of the rounds."""
    instructions = about["engine"].partition(":")[2].split(",")[0].strip()
    instructions = {"AVX3": "AVX-512"}.get(instructions, instructions)
    rounds = f"**Rounds:** {round_count}."
    if round_count > 1:
        rounds += (f" From round to round half of the ratios changed by less than {100 * spread[0]:.0f} %, and nine of "
                   f"ten by less than {100 * spread[1]:.0f} %.")
    line = (f"**Machine:** {about['cores']} cores of a{' virtual' if 'virtual' in about['machine'] else ''} machine, "
            f"{about['cpu']}, {instructions}, {about['memory_gib']} GiB of memory, no GPU used, {about['system']}. "
            f"**Date:** {about['date']}. **Commit:** {about['commit']}. **OpenGL:** {about['opengl']}. {rounds}")
    return textwrap.fill(line, WIDTH, break_on_hyphens=False)
