#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""references_test.py PYTHON_MODULE SOURCE: files that are made from definitions are what these make now."""
import os
import pathlib
import subprocess
import sys
import tempfile

module, source = map(pathlib.Path, sys.argv[1:])
OF_KEYS = ["python/lamina/keywords.py", "tests/fuzz/scene.dict"]
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([source / "tools/key_files", "-o", folder], check=True)
    old_files = [name for name in OF_KEYS if pathlib.Path(folder, name).read_text() != (source / name).read_text()]
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([source / "tools/reference_pages", "-o", folder], check=True,
                   env=dict(os.environ, PYTHONPATH=str(module), PYTHONDONTWRITEBYTECODE="1"))
    made = sorted(pathlib.Path(folder).iterdir())
    old = [page.name for page in made if page.read_text() != (source / "docs" / page.name).read_text()]
assert len(made) == 2, made
if old or old_files:
    sys.exit(f"{', '.join([*old, *old_files])}: differ from their definitions: run tools/generated")
