# SPDX-License-Identifier: Apache-2.0
"""The report as a page, and what of it is a failure."""
import html

# Both contexts draw a scene with the same settings. EGL's picture may be off by what the scene allows, or by as much again
# as the cpu engine's is.
ALLOWED = 1.0  # render.max_error by default, in 1/255

STYLE = """body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem }
.wide { overflow-x: auto } table { border-collapse: collapse } td, th { padding: .2rem .7rem; text-align: right }
td:first-child, th:first-child { text-align: left } tr { border-bottom: 1px solid #8886 } .bad { color: #d33 }
@media (prefers-color-scheme: dark) { body { background: #131416; color: #ddd } }"""


def too_far(result):
    return "egl" in result and result["egl"]["linf"] > max(ALLOWED, 2 * result["cpu"]["linf"])


def failures(report):
    """A line each."""
    selftest = report["selftest"]
    found = [f"self test: {selftest['error']}"] if "error" in selftest else []
    found += [f"self test: {case['group']}/{case['scene']}/{case['way']}: {case['verdict']}, error {case['error']}, bound "
              f"{case['bound']}" for case in selftest.get("failed", [])]
    for result in report["pictures"]:
        if "error" in result:
            found.append(f"{result['scene']}: {result['error']}")
        elif too_far(result):
            found.append(f"{result['scene']}: by EGL off by {result['egl']['linf']:.3g} / 255, by the cpu engine by "
                         f"{result['cpu']['linf']:.3g} / 255")
    if "error" in report["bench"]:
        found.append(f"bench: {report['bench']['error']}")
    return found


def table(heads, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    return ('<div class="wide"><table>' + line(heads, "th") + "".join(line(row, "td") for row in rows) + "</table></div>")


def picture_row(result):
    if "egl" not in result:
        return [result["scene"], "", "", "", result.get("missing") or result.get("error"), "", ""]
    egl, cpu = result["egl"], result["cpu"]
    return [result["scene"], egl["plan"].get("classification", egl["plan"]["method"]), f"{egl['linf']:.3g}",
            f"{cpu['linf']:.3g}", f"{result['between']:.3g}", f"{egl['ms']:.2f}", f"{cpu['ms']:.2f}"]


def bench_rows(bench):
    for scene in bench.get("scenes", []):
        cpu, egl = scene["ways"]
        yield [scene["scene"], f"{egl['ms']:.2f}", f"{cpu['ms']:.2f}", f"{egl['times_as_fast']['median']:.2f}",
               f"{egl['first_picture_ms']:.0f}", f"{cpu['first_picture_ms']:.0f}"]


def html_of(report):
    machine, selftest = report["machine"], report["selftest"]
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
<h2>Self test</h2>
<p>{selftest.get("passed", 0)} of {selftest.get("cases", 0)} cases keep their bounds.</p>
<h2>Pictures</h2>
<p>Errors are the largest of any channel, in 1/255, against the reference tracer; "apart" is EGL against the cpu engine.
Times are of a frame, in ms.</p>
{table(["scene", "plan", "EGL", "native", "apart", "EGL ms", "native ms"], map(picture_row, report["pictures"]))}
<h2>Frames</h2>
<p>tools/bench: medians in ms, each scene at its own size.</p>
{table(["scene", "EGL", "native", "times as fast", "EGL first", "native first"], bench_rows(report["bench"]))}
</body></html>
"""
