# SPDX-License-Identifier: Apache-2.0
"""The standard set: shipped scenes, those with real data if LAMINA_DATA has these."""
import json
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class BenchScene:
    def __init__(self, name, path, arguments=()):
        """arguments: for `lamina render`, in front of those of a way."""
        self.name, self.path, self.arguments = name, path, list(arguments)
        try:
            self.json = json.loads(path.read_text())
        except (OSError, ValueError) as error:
            raise SystemExit(f"bench: {path}: {error}")

    def data_file(self):
        """The file of the volume or the mesh; None if the volume is generated."""
        source = self.json.get("mesh") if isinstance(self.json.get("mesh"), str) else self.json.get("volume")
        return self.path.parent / os.path.expandvars(source) if isinstance(source, str) else None

    def missing(self):
        """Why it cannot be drawn, or None."""
        file = self.data_file()
        if file is None or file.is_file():
            return None
        if "${LAMINA_DATA}" in str(file):
            return "LAMINA_DATA is not set: expected a folder with the data sets"
        return f"{file}: no such file (LAMINA_DATA={os.environ.get('LAMINA_DATA', '')})"


KUHN = ["--method", "project", "--set", "mesh.kuhn=true"]  # tets without TetGen
STANDARD = {name: (name, []) for name in ("gaussians", "mixing", "bonsai", "engine", "aneurism", "heptane", "hydrogen",
                                          "headsq", "neghip", "bluntfin", "combustor", "torso")}
STANDARD["gaussians-mesh"] = ("gaussians", ["--set", "volume.size=[32,32,32]", *KUHN])
STANDARD["neghip-mesh"] = ("neghip", KUHN)
AGAINST_VTK = ["bonsai", "engine", "aneurism", "bluntfin", "combustor"]


def kuhn(samples):
    """Six tets a cell of a volume with this many samples along each axis; 119 make nearly ten millions."""
    scene = find("gaussians-mesh")
    scene.arguments[:2] = ["--set", f"volume.size=[{samples},{samples},{samples}]", "--set", "mesh.max_tets=10000000"]
    scene.name = f"Kuhn's split of {samples}^3 samples"
    return scene


def find(name):
    """A scene of the set by its name, or a scene file."""
    if name in STANDARD:
        file, arguments = STANDARD[name]
        return BenchScene(name, ROOT / "data" / "scenes" / f"{file}.json", arguments)
    path = pathlib.Path(name)
    if path.suffix != ".json":
        raise SystemExit(f"bench: scene {name}: expected a .json file or one of {', '.join(STANDARD)}")
    return BenchScene(path.stem, path)
