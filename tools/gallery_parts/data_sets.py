# SPDX-License-Identifier: Apache-2.0
"""The data sets of the gallery: files, and what lamina makes."""
import pathlib
import re
import subprocess

VOLUMES = {".nrrd", ".mha", ".mhd", ".gz", ".nii", ".vti"}


def names_that(lamina, verb):
    """The names after `verb` in the verb's own help; none if lamina does not know the verb."""
    done = subprocess.run([lamina, verb, "--help"], capture_output=True, text=True)
    listed = re.search(r"NAME[^\n]*?((?:[a-z][a-z-]+, )+[a-z][a-z-]+)", done.stdout.replace("\n", " "))
    return listed.group(1).split(", ") if done.returncode == 0 and listed else []


def files_in(folder):
    """Volumes and meshes; a mesh that is there in several forms is taken once."""
    files = sorted(path for path in folder.rglob("*") if path.suffix in VOLUMES | {".vtu"})
    return [path for path in files if "wild" not in path.parts]


def chosen(lamina, folder, scratch, only):
    """Name and file of each data set; those that are not named are left out, before they are made."""
    found = []
    files = {path.name.split(".")[0]: path for path in files_in(pathlib.Path(folder))} if folder else {}
    makers = {name: verb for verb in ("generate", "example") for name in names_that(lamina, verb)}
    for name in only or [*files, *makers]:
        if name in files:
            found.append((name, files[name]))
        elif name in makers:
            made = scratch / f"{name}.nrrd"
            if makers[name] == "example":  # each has a file name of its own
                folder_of_one = scratch / name
                folder_of_one.mkdir()
                subprocess.run([lamina, "example", name], check=True, capture_output=True, cwd=folder_of_one)
                made, = folder_of_one.iterdir()
            else:
                subprocess.run([lamina, "generate", name, "-o", made], check=True, capture_output=True)
            found.append((name, made))
        elif pathlib.Path(name).exists():
            found.append((pathlib.Path(name).name.split(".")[0], pathlib.Path(name)))
        else:
            raise SystemExit(f"gallery: --only {name}: expected a file or one of {', '.join([*files, *makers])}")
    return found
