#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""commands_test.py LAMINA PYTHON_MODULE SOURCE PAGE: does what a reader of that page does: all its `sh` blocks in one shell,
then its `python` blocks as one program, in an empty folder that has the data sets. 77: no LAMINA_DATA, or no xvfb where
the page asks for it."""
import os
import pathlib
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
    data = os.environ.get("LAMINA_DATA")
    if not data or ("xvfb-run" in text and not shutil.which("xvfb-run")):
        print("needs LAMINA_DATA, and xvfb where the page uses it")
        return NO_TOOL
    if "ffmpeg" in text and not shutil.which("ffmpeg"):
        print("needs ffmpeg")
        return NO_TOOL
    environment = dict(os.environ, PATH=f"/usr/bin:{lamina.parent}:{os.environ['PATH']}", PYTHONPATH=str(module),
                       PYTHONDONTWRITEBYTECODE="1")
    with tempfile.TemporaryDirectory() as folder:
        for file in pathlib.Path(data).iterdir():
            (pathlib.Path(folder) / file.name).symlink_to(file)
        for program, blocks in ((["bash", "-euxo", "pipefail"], shell), (["/usr/bin/python3", "-"], python)):
            if blocks:
                subprocess.run(program, input="\n".join(blocks), text=True, cwd=folder, env=environment, check=True)
    return 0


sys.exit(main())
