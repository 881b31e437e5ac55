# SPDX-License-Identifier: Apache-2.0
"""The report as a page, and what of it is a failure."""
import html

# Both contexts draw a scene with the same settings. EGL's picture may be off by what the scene allows, or by as much again
# as the cpu engine's is.
ALLOWED = 1.0  # render.max_error by default, in 1/255

STYLE = """body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
.wide { overflow-x: auto } table { border-collapse: collapse } td, th { padding: .2rem .7rem; text-align: right }
td:first-child, th:first-child, td:nth-child(n+9) { text-align: left } td:nth-child(n+9) { min-width: 18rem }
td:nth-child(-n+3) { white-space: nowrap } tr { border-bottom: 1px solid #8886 } .bad { color: #d33 }
@media (prefers-color-scheme: dark) { body { background: #131416; color: #ddd } }"""


def too_far(result):
    return "egl" in result and result["egl"]["linf"] > max(ALLOWED, 2 * result["cpu"]["linf"])


def failures(report):
    """A line each."""
    selftest, probe = report["selftest"], report["probe"]
    found = [] if "cases" in selftest else [f"self test: {selftest.get('error') or selftest['missing']}"]
    found += [f"self test: {case['group']}/{case['scene']}/{case['way']}: {case['verdict']}, error {case['error']}, bound "
              f"{case['bound']}" for case in selftest.get("failed", [])]
    found += [f"probe: {probe['error']}"] if "error" in probe else []
    found += [f"probe: {' '.join(map(str, way_name(way)))}: not the values of the fragment shader"
              for way in probe.get("ways", []) if not way["same_values"]]
    for result in report["pictures"]:
        if too_far(result):
            found.append(f"{result['scene']}: by EGL off by {result['egl']['linf']:.3g} / 255, by the cpu engine by "
                         f"{result['cpu']['linf']:.3g} / 255")
    found += [f"{way['scene']}, {way['way']}: off from the first way by {way['apart']:.3g} / 255"
              for way in report["ways"] if way.get("apart", 0) > ALLOWED]
    found += [f"{result['scene']}: {result['error']}"
              for result in [*report["pictures"], *report["frames"], *report["ways"]] if "error" in result]
    return found


def table(heads, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    return ('<div class="wide"><table>' + line(heads, "th") + "".join(line(row, "td") for row in rows) + "</table></div>")


def picture_row(result):
    if "egl" not in result:
        return [result["scene"], "", "", "", result.get("missing") or result.get("error")]
    egl, cpu = result["egl"], result["cpu"]
    return [result["scene"], egl["plan"].get("classification", egl["plan"]["method"]), f"{egl['linf']:.3g}",
            f"{cpu['linf']:.3g}", f"{result['between']:.3g}"]


def way_name(way):
    return [way["kernel"], way["shader"], way["group"] or "", way["order"]]


def way_row(way):
    opengl = "" if way["opengl_ms"] is None else f"{way['opengl_ms']:.3f}"
    return [*way_name(way), opengl, f"{way['wall_ms']:.3f}", f"{way['times_as_fast']:.2f}"]


def frame_way_row(way):
    if "frame_ms" not in way:
        return [way["scene"], way["way"], "", way.get("missing") or way.get("error")]
    return [way["scene"], way["way"], f"{way['frame_ms']['median']:.2f}", f"{way['apart']:.3g}"]


def stage_text(frames):
    return ", ".join(f"{name} {ms:.2f}" for name, ms in frames["stages_ms"].items())


def frame_row(result):
    if "cpu" not in result:
        return [result["scene"], result["size"], result.get("missing") or result.get("error"), *[""] * 7]
    egl, cpu = result["egl"], result["cpu"]
    times = [each["frame_ms"]["median"] for each in (egl, cpu)]
    return [result["scene"], result["size"], egl["drawn_by"], *(f"{ms:.2f}" for ms in times),
            f"{times[1] / times[0]:.2f}", f"{egl['first_picture_ms']:.0f}", f"{cpu['first_picture_ms']:.0f}",
            stage_text(egl), stage_text(cpu)]


def html_of(report):
    machine, selftest, probe = report["machine"], report["selftest"], report["probe"]
    bad = failures(report)
    verdict = "Every bound is kept." if not bad else "<ul class=bad>" + "".join(
        f"<li>{html.escape(line)}</li>" for line in bad) + "</ul>"
    about = [["draws", report["renderer"]], ["driver", machine["driver"]],
             ["processor", f"{machine['processor']}, {machine['processors']} cores"], ["system", machine["system"]],
             ["date", machine["date"]], *[["", line] for line in machine["lamina"][:3]]]
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<title>lamina: GPU check</title><style>{STYLE}</style></head><body>
<h1>GPU check</h1>
{verdict}
{table(["", ""], [row for row in about if row[1]])}
<h2>Probe</h2>
<p>One kernel as a fragment and as a compute shader, {probe.get("width")} x {probe.get("height")} pixels: cubics of cells in
registers (arithmetic), or the eight corners of the cells along rays as texels of a 3D texture, gathers from a 2D texture, or
words of a buffer. Medians in ms; "times as fast" as the kernel's fragment shader, by OpenGL's clock.</p>
{table(["kernel", "shader", "workgroup", "order", "OpenGL's clock", "wall clock", "times as fast"],
       map(way_row, probe.get("ways", [])))}
<h2>Self test</h2>
<p>{selftest.get("passed", 0)} of {selftest.get("cases", 0)} cases keep their bounds.</p>
<h2>Pictures</h2>
<p>Errors are the largest of any channel, in 1/255, against the reference tracer; "apart" is EGL against the cpu
engine.</p>
{table(["scene", "plan", "EGL", "cpu", "apart"], map(picture_row, report["pictures"]))}
<h2>Ways</h2>
<p>Medians in ms of frames by EGL, 800 x 600 pixels (with --quick 96 x 72): cells as texels or as words of a buffer,
workgroups of so many rays, each of which draws a tile or takes tiles from a queue; compute shaders or fragments. "Apart" is the
picture against the scene's first way, in 1/255.</p>
{table(["scene", "way", "EGL", "apart"], map(frame_way_row, report["ways"]))}
<h2>Frames</h2>
<p>Medians in ms, the camera turning by 3 degrees a frame, of 20 frames by EGL after 1 s of warm-up, and of 5 by the cpu
engine on all cores (with --quick of 2 each); "first" is the first picture from reading on. Stages are of another run.
OpenGL's are when the GPU worked; a stage may be a part of another.</p>
{table(["scene", "pixels", "drawn by", "EGL", "cpu", "times as fast", "EGL first", "cpu first", "stages by EGL",
        "stages by cpu"], map(frame_row, report["frames"]))}
<p>Seconds of the parts: {html.escape(", ".join(f"{part} {took}" for part, took in report["seconds"].items()))}.</p>
</body></html>
"""
