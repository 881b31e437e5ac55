# SPDX-License-Identifier: Apache-2.0
"""A made-up report of a study, and what a page of it must show."""
import base64
import random
import struct
import zlib

HOSTILE = '</script><img src=x onerror="window.wasRun = true"><!-- {{page.js}} & "\'\u2028'


def png(shade, size=8):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = (b"\0" + bytes([shade] * size)) * size
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0))
    data += chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    return "data:image/png;base64," + base64.b64encode(data).decode()


def times(median, n=9):
    return {"median": median, "min": 0.875 * median, "max": 1.5 * median, "n": n}


def frame_ms(run):
    return run["frame_ms"]["median"]


def first_ms(run):
    return run["first_ms"]


def front(runs, error, ms=frame_ms):
    """Ids of those that no other run beats or equals in both and beats in one."""
    def point(run):
        return ms(run), run[error]
    return {run["id"] for run in runs
            if not any(all(a <= b for a, b in zip(point(other), point(run))) and point(other) != point(run)
                       for other in runs)}


def comparison(scene, count):
    runs = []
    for i in range(count):
        target = ["fixed8", "float32"][i % 2]
        # 8, 80, 9, 90, ...: another order as text. Times have ties, and go up to three digits.
        keys = {"render.target": target, "render.slice.samples": [8, 80, 9, 90, 100][i % 5],
                "render.slice.tree.factors": [2 ** (1 + i % 4)] * (1 + i % 3)}
        median = round(10 ** random.uniform(-1, 2), 1)
        error = (0.5 if target == "fixed8" else 1e-6) * random.uniform(0.2, 1) / median
        runs.append({
            "id": f"{scene}-{i:02d}", "name": f"{target} run {i}", "keys": keys, "reference": "r1",
            "frame_ms": times(median), "still_ms": times(1 / median), "first_ms": 500 / median, "ratio": median / 8,
            "linf": random.uniform(2, 9) * error, "l1": random.uniform(-1, 1) * error, "l2": error,
            "channels": {c: {"linf": error, "l1": 0, "l2": error} for c in "RGBA"}, "stages": {"order": 0.25},
            "bytes_gpu": 1000 * i, "bytes_host": 24, "bytes": 1000 * (i % 7) + 24, "pareto": False,
            "near_reference": target == "float32", "context": "cpu engine", "image": png(10 + i),
            "difference": png(200)})
    for run in runs:
        run["pareto"] = run["id"] in front(runs, "l2")
    return {"scene": scene, "baseline": runs[3]["id"], "difference_scale": 2.0, "runs": runs,
            "references": [{"id": "r1", "of": "volume", "error_estimate": 1.2e-7, "ms": 812.0, "width": 8, "height": 8,
                            "image": png(90)}],
            "plots": [{"title": "Error over samples", "x": {"label": "samples", "log": True},
                       "y": {"label": "L2", "log": True},
                       "series": [{"name": name, "points": [[8, 0, runs[0]["id"]], [16, 0.25, runs[1]["id"]]]}
                                  for name in ("fixed8", "float32")]}],
            "pictures": [{"title": "PT - slicing", "caption": "signed", "image": png(128), "scale": 1.5, "largest": 3}],
            "set": {"volume.size": [64, 64, 64], "image.note": HOSTILE}}


def made_up_report(count):
    random.seed(7)
    first, second = comparison("ramp", count), comparison(HOSTILE, 6)
    exact = first["runs"][4]
    for error in ("linf", "l1", "l2"):
        exact[error] = 0
    first["runs"][6]["ratio"] = None
    first["runs"][7]["name"] = HOSTILE
    for run in first["runs"]:
        run["pareto"] = run["id"] in front(first["runs"], "l2")
    failed = {"id": "failed", "name": "too large", "keys": {"render.target": "fixed8"},
              "failed": f"needs 4 GiB {HOSTILE}"}
    first["runs"].insert(2, failed)
    return {"title": HOSTILE, "kind": "study", "findings": ["the first", HOSTILE],
            "environment": {"machine": HOSTILE, "processors": 2, "drivers": ["cpu engine", "Mesa"]},
            "base": {"image.width": 128, "render.method": "slice", "render.target": "float16"},
            "swept": ["render.target", "render.slice.samples", "render.slice.tree.factors"],
            "comparisons": [first, second], "dropped": [{"because": HOSTILE, "runs": 12}]}


def measured(entry):
    return [run for run in entry["runs"] if "failed" not in run]
