#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""references_test.py PYTHON_MODULE SOURCE: pages that are made from definitions are what these make now."""
import os
import pathlib
import subprocess
import sys
import tempfile

module, source = map(pathlib.Path, sys.argv[1:])
with tempfile.TemporaryDirectory() as folder:
    subprocess.run([source / "tools/reference_pages", "-o", folder], check=True,
                   env=dict(os.environ, PYTHONPATH=str(module), PYTHONDONTWRITEBYTECODE="1"))
    made = sorted(pathlib.Path(folder).iterdir())
    old = [page.name for page in made if page.read_text() != (source / "docs" / page.name).read_text()]
assert len(made) == 2, made
if old:
    sys.exit(f"docs: {', '.join(old)}: differ from their definitions: run tools/reference_pages")
