# SPDX-License-Identifier: Apache-2.0
"""Error against run time of many settings."""
from __future__ import annotations

import csv
import json
import pathlib
import tempfile
from typing import Any, Iterator, Mapping

import numpy as np

from . import _lamina
from ._conversion import shown
from ._errors import Error
from ._plain import plain
from ._scene import Scene, scene_of
from ._session import Progress
from ._volume import Path


class Study(Mapping[str, np.ndarray]):
    """The results of a study: columns by name, with one entry a run, as ``results.csv`` has them.

    ``scene``, every swept key, ``frame_ms_median`` (also ``_min``, ``_max``, ``still_ms_...``, ``first_ms``), ``linf``,
    ``l1``, ``l2`` (in 1/255, also of each channel), ``bytes``, ``pareto``, ``failed``, ...: float64 (NaN if a run has
    none), bool or text. ``findings``, ``failures``, ``messages``: for people. ``folder``: where the report is, None if
    none was named.
    """

    def __init__(self, columns: Mapping[str, np.ndarray], said: tuple[list[str], list[str], list[str]],
                 folder: pathlib.Path | None) -> None:
        self._columns = dict(columns)
        self.findings, self.failures, self.messages = said
        self.folder = folder

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(self["run"])

    def __getitem__(self, name: str) -> np.ndarray:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<lamina.Study {self.runs} runs, {len(self)} columns>"


def study(study: Mapping[str, Any] | Path, folder: Path | None = None, *, resume: bool = False,
          progress: Progress | None = None) -> Study:
    """Draws scenes with many settings and measures their errors and times.

    ``study``: a study file's keys (``scenes``, ``base``, ``sweep``, ``drop``, ``baseline``, ``reference``, ``rounds``,
    ``frames``), or the path of such a file. A scene may be a path, a ``Scene``, a dictionary with a scene's keys, or
    ``{"scene": one of these, "name": ..., "set": {...}}``. It needs its transfer function and camera written out, as
    ``Picture.scene`` has them: runs share them. ``folder``: gets report, results and pictures; empty or new, or with
    ``resume`` one that holds a part of this study.

    >>> picture = lamina.render({"version": 1, "volume": {"generate": "gaussians", "size": [16, 16, 16]}}, size=(32, 24))
    >>> found = lamina.study({"scenes": [picture.scene], "base": {"render.slice.classification": "post"},
    ...                       "sweep": {"render.slice.samples": [8, 64]}, "rounds": 1, "frames": 1})
    >>> found["render.slice.samples"], bool(found["l2"][0] > found["l2"][1])
    (array([ 8., 64.]), True)
    """
    if isinstance(study, Mapping):
        document, beside = plain({"version": 1, **{key: value for key, value in study.items() if key != "scenes"}}), ""
        scenes = list(study.get("scenes", []))
    else:
        path = pathlib.Path(study)
        try:
            document, beside = json.loads(path.read_text(encoding="utf-8")), str(path.absolute().parent)
        except (OSError, ValueError) as error:
            raise Error(f"{path}: cannot read: {error}") from None
        scenes = document.get("scenes", []) if isinstance(document, dict) else []
    with tempfile.TemporaryDirectory(prefix="lamina-study-") as temporary:
        place = pathlib.Path(folder if folder is not None else temporary)
        inputs = place / "inputs"
        inputs.mkdir(parents=True, exist_ok=True)
        document["scenes"] = [_entry(scene, number, inputs, beside) for number, scene in enumerate(scenes)]
        (inputs / "study.json").write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
        _, *said = _lamina.run_study(inputs / "study.json", place, resume, progress)
        columns = _columns(place / "results.csv")
    findings, failures, messages = said
    return Study(columns, (findings, failures, messages), None if folder is None else place)


def _entry(scene: Any, number: int, inputs: pathlib.Path, beside: str) -> dict[str, Any]:
    """Returns a scene as a study file names it; scenes in memory become files."""
    keys = scene if isinstance(scene, Mapping) and "scene" in scene else {"scene": scene}
    entry, own = {key: plain(value) for key, value in keys.items() if key != "scene"}, keys["scene"]
    if isinstance(own, Mapping):
        file = inputs / f"scene-{number}.json"
        scene_of(own).save(file)
        entry.setdefault("name", f"scene {number}")
    elif isinstance(own, str) or hasattr(own, "__fspath__"):
        file = pathlib.Path(beside, own).absolute()
    else:
        raise TypeError(f"scenes.{number}: found {shown(own)}, expected a Scene, a dictionary or a path")
    return {"scene": str(file), **entry}


def _columns(file: pathlib.Path) -> dict[str, np.ndarray]:
    with open(file, newline="", encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    return {name: _column([row[name] for row in rows]) for name in rows[0]} if rows else {}


def _column(texts: list[str]) -> np.ndarray:
    if set(texts) <= {"true", "false"}:
        return np.array([text == "true" for text in texts])
    try:
        numbers = [float(text) if text else float("nan") for text in texts]
    except ValueError:
        return np.array(texts, dtype=object)
    if not any(texts):
        return np.array(texts, dtype=object)
    return np.array(numbers)
