#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""commands_test.py LAMINA PYTHON_MODULE SOURCE PAGE: does what a reader of that page does: all its `sh` blocks in one shell,
then its `python` blocks as one program, in an empty folder. Blocks that write a film by ffmpeg are left out where that
program is missing. 77: no xvfb where the page asks for it."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from blocks import fenced  # noqa: E402

NO_TOOL = 77


def main():
    lamina, module, source, page = (pathlib.Path(argument) for argument in sys.argv[1:])
    text = (source / page).read_text()
    shell, python = fenced(text, "sh"), fenced(text, "python")
    assert shell, f"{page}: no block of commands"
    if "xvfb-run" in text and not shutil.which("xvfb-run"):
        print("needs xvfb")
        return NO_TOOL
    if not shutil.which("ffmpeg"):
        shell = [block for block in shell if not re.search(r"\.(mp4|webm|gif)\b", block)]
    environment = dict(os.environ, PATH=f"/usr/bin:{lamina.parent}:{os.environ['PATH']}", PYTHONPATH=str(module),
                       PYTHONDONTWRITEBYTECODE="1")
    environment.pop("LAMINA_DATA", None)  # a reader has only what the page makes
    with tempfile.TemporaryDirectory() as folder:
        for program, blocks in ((["bash", "-euxo", "pipefail"], shell), (["/usr/bin/python3", "-"], python)):
            if blocks:
                subprocess.run(program, input="\n".join(blocks), text=True, cwd=folder, env=environment, check=True)
    return 0


sys.exit(main())
