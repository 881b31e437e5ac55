# SPDX-License-Identifier: Apache-2.0
"""One file for a machine on which nothing of lamina is."""
import io
import os
import pathlib
import sys
import tarfile

from bench_parts import scenes

RUN = """#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# ./run [-o DIR] [--quick]: checks this machine's GPU (tools/gpu_check --help).
here=$(cd "$(dirname "$0")" && pwd)
export LAMINA_DATA="$here/data/sets"
command -v python3 >/dev/null || { echo "gpu_check: no python3 on this machine, which the check needs (3.8 or later)" >&2; exit 1; }
exec python3 "$here/tools/gpu_check" run --lamina "$here/lamina/bin/lamina" "$@"
"""
NAME = "lamina-gpu-check"


def newest_portable(root):
    found = sorted((root / "out" / "packages").glob("lamina-*.tar.gz"), key=os.path.getmtime)
    if not found:
        raise SystemExit(f"gpu_check: no lamina-*.tar.gz in {root / 'out' / 'packages'}: run tools/packages first")
    return found[-1]


def add_portable(archive, portable):
    """The program under `lamina`, whatever its version."""
    with tarfile.open(portable) as tree:
        for member in tree.getmembers():
            source = tree.extractfile(member) if member.isfile() else None
            member.name = "/".join([NAME, "lamina", *pathlib.PurePosixPath(member.name).parts[1:]])
            archive.addfile(member, source)


def write(root, portable, output):
    portable = portable or newest_portable(root)
    output.parent.mkdir(parents=True, exist_ok=True)
    with tarfile.open(output, "w:gz") as archive:
        add_portable(archive, portable)
        for name in ("tools/gpu_check", "data/scenes"):
            archive.add(root / name, f"{NAME}/{name}")
        for folder in ("gpu_check_parts", "bench_parts"):
            for file in sorted((root / "tools" / folder).glob("*.py")):
                archive.add(file, f"{NAME}/tools/{folder}/{file.name}")
        for name in sorted(scenes.STANDARD):
            scene = scenes.find(name)
            if scene.missing():
                print(f"gpu_check: {name} stays out: {scene.missing()}", file=sys.stderr)
            elif scene.data_file() and f"{NAME}/data/sets/{scene.data_file().name}" not in archive.getnames():
                archive.add(scene.data_file(), f"{NAME}/data/sets/{scene.data_file().name}")
        runner = tarfile.TarInfo(f"{NAME}/run")
        runner.mode, runner.size = 0o755, len(RUN)
        archive.addfile(runner, io.BytesIO(RUN.encode()))
