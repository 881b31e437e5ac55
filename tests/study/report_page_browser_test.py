#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The report page in a real browser, headless Chromium: report_page_browser_test.py WRITE_REPORT_PAGE.

Exits with 77 (skipped) where Chromium is not installed. The page is that of a made-up report; what it must show is
worked out here, from the same report.
"""
import shutil
import sys
import unittest

if not shutil.which("chromium"):
    print("skipped: Chromium is not installed (tools/install installs it)")
    sys.exit(77)

from selenium.webdriver.common.keys import Keys

sys.dont_write_bytecode = True
from made_up_report import HOSTILE, first_ms, front, made_up_report, measured, png  # noqa: E402
from page_in_browser import PageInBrowser  # noqa: E402

NUMERIC = {  # column: its value of a run
    "key.render.slice.samples": lambda run: run["keys"]["render.slice.samples"],
    "frame_ms.median": lambda run: run["frame_ms"]["median"],
    "frame_ms.min": lambda run: run["frame_ms"]["min"],
    "frame_ms.spread": lambda run: run["frame_ms"]["max"] - run["frame_ms"]["min"],
    "ratio": lambda run: run["ratio"],
    "still_ms.median": lambda run: run["still_ms"]["median"],
    "first_ms": lambda run: run["first_ms"],
    "linf": lambda run: run["linf"],
    "l1": lambda run: run["l1"],
    "l2": lambda run: run["l2"],
    "bytes": lambda run: run["bytes"],
}


class ReportPage(PageInBrowser):
    def test_loads_without_a_message_or_a_request(self):
        self.browser.execute_script("window.scrollTo(0, document.body.scrollHeight)")
        self.assertEqual(self.messages(), [])
        urls = self.requests()
        self.assertEqual([url for url in urls if not url.startswith("data:")], [self.page])

    def test_the_browser_refuses_what_the_policy_forbids(self):
        for attempt in ("const image = new Image(); image.onerror = () => arguments[0](); "
                        "image.src = 'http://127.0.0.1:9/'",
                        "fetch('http://127.0.0.1:9/').catch(() => arguments[0]())"):
            self.browser.execute_async_script(attempt)
            self.assertIn("Content Security Policy", " ".join(self.messages()), attempt)

    def test_strings_are_text_whatever_they_hold(self):
        self.assertIsNone(self.browser.execute_script("return window.wasRun ?? null"))
        self.assertEqual(self.all("img[src=x]"), [])
        self.assertEqual(self.all("h1")[0].get_attribute("textContent"), HOSTILE)
        self.assertEqual(self.browser.title.split()[0], HOSTILE.split()[0])
        self.assertEqual(self.all("h2", self.section(1))[0].get_attribute("textContent"), HOSTILE)
        for selector in ('tr[data-run="ramp-07"] th', "#failed td:last-child", "#dropped th[scope=row]",
                         "#environment dd"):
            self.assertIn(HOSTILE, self.all(selector)[0].get_attribute("textContent"))

    def test_title_findings_and_a_note_need_no_script(self):
        self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        try:
            self.browser.get(self.page)
            self.assertEqual([item.text for item in self.all("#findings li")][0], "the first")
            self.assertEqual(len(self.all("#findings li")), 2)
            self.assertIn("beside this page", self.all("noscript")[0].text)
            self.assertTrue(self.all("h1")[0].is_displayed())
        finally:
            self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

    def test_the_scatter_names_the_pareto_front(self):
        for index, entry in enumerate(self.report["comparisons"]):
            runs = measured(entry)
            wanted = {run["id"]: run["name"] for run in runs if run["pareto"]}
            self.assertEqual(len(self.all(".scatter .point", self.section(index))), len(runs))
            shown = self.names(self.section(index))
            self.assertEqual(set(shown), set(wanted))
            for run, name in shown.items():
                self.assertTrue(wanted[run] == name or wanted[run].startswith(name[:-1]) and name.endswith("…"))

    def test_the_scatter_names_the_front_of_the_chosen_error(self):
        self.all("#choose-error option[value=linf]")[0].click()
        for index, entry in enumerate(self.report["comparisons"]):
            self.assertEqual(set(self.names(self.section(index))), front(measured(entry), "linf"))

    def test_the_time_of_the_first_picture_can_be_chosen(self):
        self.assertIn("frame time", self.all(".scatter .axis-text", self.section(0))[0].text)
        self.all("#choose-time option[value=first_ms]")[0].click()
        for error in ("l2", "linf"):
            self.all(f"#choose-error option[value={error}]")[0].click()
            for index, entry in enumerate(self.report["comparisons"]):
                section = self.section(index)
                self.assertIn("first picture", self.all(".scatter .axis-text", section)[0].text)
                self.assertEqual(set(self.names(section)), front(measured(entry), error, first_ms))
                runs = [run for run, _ in sorted(self.collect(
                    section, ".scatter .point",
                    "[node.dataset.run, Number(node.getAttribute('transform').match(/[0-9.]+/)[0])]"),
                    key=lambda pair: pair[1])]
                times = [next(first_ms(run) for run in entry["runs"] if run["id"] == found) for found in runs]
                for earlier, later in zip(times, times[1:]):
                    self.assertLessEqual(earlier, later * 1.01)  # positions are rounded to a tenth of a pixel
        # The rows' marks stay those of frame times.
        section = self.section(0)
        self.assertEqual(set(self.collect(section, "tr.run.pareto", "node.dataset.run")),
                         {run["id"] for run in measured(self.report["comparisons"][0]) if run["pareto"]})

    def test_without_times_of_first_pictures_there_is_no_choice(self):
        report = made_up_report(12)
        del measured(report["comparisons"][0])[0]["first_ms"]
        for run in measured(report["comparisons"][1]):
            run["first_ms"] = None
        self.open(self.write_page("old", report))
        self.assertEqual(self.messages(), [])
        self.assertEqual(self.all("#choose-time"), [])
        for index, heads in enumerate((1, 0)):
            self.assertEqual(len(self.all("button[data-column=first_ms]", self.section(index))), heads)
            self.assertEqual(set(self.names(self.section(index))), {
                run["id"] for run in measured(report["comparisons"][index]) if run["pareto"]})

    def test_names_do_not_overlap(self):
        # Names get 14 pixels of height, a pixel more than the font's; a pixel of overlap is rounding.
        def overlap(a, b, at, size):
            return min(a[at] + a[size], b[at] + b[size]) - max(a[at], b[at]) > 1
        self.open(self.write_page("named", made_up_report(80)))
        boxes = [label.rect for label in self.all(".scatter text.pareto-name", self.section(0))]
        self.assertGreater(len(boxes), 4)
        for i, a in enumerate(boxes):
            for b in boxes[:i]:
                self.assertFalse(overlap(a, b, "x", "width") and overlap(a, b, "y", "height"), (a, b))

    def test_points_lie_by_time_and_error_and_zero_lies_lowest(self):
        runs = measured(self.report["comparisons"][0])
        centres = {}
        for run, place in self.collect(self.section(0), ".scatter .point",
                                       "[node.dataset.run, node.getAttribute('transform')]"):
            x, y = place[len("translate("):-1].split(",")
            centres[run] = (float(x), float(y))
        for a in runs:
            for b in runs:
                # Positions are rounded to a tenth of a pixel.
                if a["frame_ms"]["median"] < b["frame_ms"]["median"]:
                    self.assertLessEqual(centres[a["id"]][0], centres[b["id"]][0] + 0.1)
                if a["l2"] < b["l2"]:
                    self.assertGreaterEqual(centres[a["id"]][1], centres[b["id"]][1] - 0.1)
        lowest = max(centres, key=lambda run: centres[run][1])
        self.assertEqual(lowest, next(run["id"] for run in runs if run["l2"] == 0))
        self.assertIn("0", self.collect(self.section(0), ".scatter .tick-text", "node.textContent"))

    def test_marks_follow_the_chosen_key(self):
        def marks():  # of each run: shape, colour and whether it is hollow, with its colour around it
            found = self.collect(self.section(0), ".scatter .point > path", "[node.parentNode.dataset.run, "
                                 "...['d', 'fill', 'stroke'].map((name) => node.getAttribute(name))]")
            return {run: (shape, stroke if fill == "#ffffff" else fill, fill == "#ffffff")
                    for run, shape, fill, stroke in found}
        runs = measured(self.report["comparisons"][0])
        for key in self.report["swept"]:
            self.all(f'#choose-key option[value="{key}"]')[0].click()
            shown = {run: mark[:2] for run, mark in marks().items()}
            for a in runs:
                for b in runs:
                    self.assertEqual(shown[a["id"]] == shown[b["id"]], a["keys"][key] == b["keys"][key], key)
        hollow = {run for run, mark in marks().items() if mark[2]}
        self.assertEqual(hollow, {run["id"] for run in runs if run["near_reference"]})

    def test_marks_tell_what_was_swept(self):
        def legend():
            return self.collect(self.section(0), ".scatter .legend li", "node.textContent")
        # Trees are told apart by their levels.
        self.assertEqual(self.all("#choose-key")[0].get_attribute("value"), "levels of the tree")
        self.assertEqual(legend()[:3], ["1", "2", "3"])
        # Keys that are changed in turn are told apart by which key it is.
        report = made_up_report(12)
        for i, run in enumerate(measured(report["comparisons"][0])):
            key = ["render.target", "render.slice.samples", "render.slice.tree.factors"][i % 3]
            run["keys"] = {key: "x"} if i > 0 else {}
        report["comparisons"] = report["comparisons"][:1]
        report["swept"][2] = "image.width"
        for run in measured(report["comparisons"][0]):
            if run["keys"].pop("render.slice.tree.factors", None):
                run["keys"]["image.width"] = 8
        self.open(self.write_page("in-turn", report))
        self.assertEqual(self.messages(), [])
        self.assertEqual(self.all("#choose-key")[0].get_attribute("value"), "what was swept")
        self.assertEqual(legend()[:4], ["nothing", "samples", "target", "width"])
        # In a grid all keys are: the one that splits the runs best.
        for i, run in enumerate(measured(report["comparisons"][0])):
            run["keys"] = {"render.target": "fixed8" if i < 9 else "float32", "render.slice.samples": i % 4}
        for run in report["comparisons"][0]["runs"]:
            if "failed" in run:
                run["keys"] = {"render.target": "fixed8", "render.slice.samples": 0}
        report["swept"] = ["render.target", "render.slice.samples"]
        self.open(self.write_page("grid", report))
        self.assertEqual(self.all("#choose-key")[0].get_attribute("value"), "render.slice.samples")

    def test_the_answer_comes_first(self):
        report = made_up_report(12)
        report["answers"] = {"title": "Which to take", "note": HOSTILE, "tables": [
            {"caption": "best", "rows": [{"take": "8x128", "its nodes": 9, "L2": 0.25},
                                         {"take": "1024", "its nodes": 1, "L2": 2}]},
            {"caption": "rest", "rows": [{"take": HOSTILE, "L2": None}]}]}
        self.open(self.write_page("answers", report))
        self.assertEqual(self.messages(), [])
        heads = self.browser.execute_script("return [...document.querySelectorAll('h2')].map((h) => h.textContent)")
        self.assertEqual(heads[:3], ["Findings", "Which to take", "How it was measured"])
        answers = self.all("#answers")[0]
        self.assertEqual(self.collect(answers, "h3", "node.textContent"), ["best", "rest"])
        rows = self.collect(answers, ".numbers tbody tr", "[...node.children].map((cell) => cell.textContent)")
        self.assertEqual(rows, [["8x128", "9", "0.250"], ["1024", "1", "2.00"], [HOSTILE, "–"]])

    def test_empty_differences_say_so(self):
        report = made_up_report(12)
        runs = measured(report["comparisons"][0])
        picture = report["comparisons"][0]["pictures"][0]
        report["comparisons"][0]["pictures"] = [
            {**picture, "scale": 2, "largest": largest} for largest in (0.0999, 0.1, 0.02, 0, 0.001)]
        runs[1]["linf"], runs[2]["linf"] = 0.03, 0.1  # the scale is 2
        self.open(self.write_page("empty", report))
        section = self.section(0)
        figures = self.all(":scope > .pictures figure", section)
        said = [[node.text for node in self.all(".nothing", figure)] for figure in figures]
        # A twentieth of the scale, .1, can be seen; the next power of ten is said.
        self.assertEqual(said, [["nothing to see: below .1"], [], ["nothing to see: below .1"], ["no difference"],
                                ["nothing to see: below .01"]])
        for run, empty in ((runs[1], True), (runs[2], False)):
            self.click(self.all(f'tr[data-run="{run["id"]}"] button', section)[0])
            found = self.all(f'tr[data-run="{run["id"]}"] + tr .nothing', section)
            self.assertEqual([node.text for node in found], ["nothing to see: below .1"] if empty else [])

    def test_every_numeric_column_sorts(self):
        for index, entry in enumerate(self.report["comparisons"]):
            section = self.section(index)
            heads = self.collect(section, "th.number button", "node.dataset.column")
            self.assertEqual(set(heads) | {"key.render.slice.samples"}, set(NUMERIC))
            for column, value in NUMERIC.items():
                button = self.all(f'button[data-column="{column}"]', section)[0]
                present = [run for run in measured(entry) if value(run) is not None]
                last = [run["id"] for run in measured(entry) if value(run) is None]
                last += [run["id"] for run in entry["runs"] if "failed" in run]
                for down in (False, True):
                    self.click(button)
                    wanted = [run["id"] for run in sorted(present, key=value, reverse=down)] + last
                    self.assertEqual(self.order(section), wanted, f"{column} down={down}")
                    sorted_by = self.collect(section, "thead [aria-sort]:not([aria-sort=none]) > button",
                                             "[node.dataset.column, node.parentNode.getAttribute('aria-sort')]")
                    self.assertEqual(sorted_by, [[column, "descending" if down else "ascending"]])

    def test_other_columns_sort_by_keyboard(self):
        section = self.section(0)
        runs = measured(self.report["comparisons"][0])
        for column, value in (("key.render.slice.tree.factors", lambda run: run["keys"]["render.slice.tree.factors"]),
                              ("key.render.target", lambda run: run["keys"]["render.target"]),
                              ("pareto", lambda run: not run["pareto"])):
            self.all(f'button[data-column="{column}"]', section)[0].send_keys(Keys.ENTER)
            wanted = [run["id"] for run in sorted(runs, key=value)]
            self.assertEqual(self.order(section), wanted + ["failed"], column)

    def test_the_filter_wants_all_words(self):
        box = self.all("#filter")[0]
        for words in ("float32", "FIXED8 90", "run 1", "4 gib", "nothing-of-that"):
            box.clear()
            box.send_keys(words)
            for index, entry in enumerate(self.report["comparisons"]):
                def text(run):
                    keys = " ".join(f"{key} {', '.join(map(str, value)) if isinstance(value, list) else value}"
                                    for key, value in run["keys"].items())
                    others = [run["id"], run["name"], run.get("context", ""), run.get("failed", "")]
                    return " ".join([*others, keys]).lower()
                wanted = [run for run in entry["runs"] if all(word in text(run) for word in words.lower().split())]
                self.assertEqual(self.order(self.section(index)), [run["id"] for run in wanted], words)
                clear = self.collect(self.section(index), ".scatter .point:not(.faint)", "node.dataset.run")
                self.assertEqual(set(clear), {run["id"] for run in wanted if "failed" not in run})

    def test_rows_open_and_close(self):
        section = self.section(0)
        run = measured(self.report["comparisons"][0])[1]
        button = self.all(f'tr[data-run="{run["id"]}"] button', section)[0]
        button.send_keys(Keys.ENTER)
        pictures = self.all(".detail .picture img", section)
        reference = self.report["comparisons"][0]["references"][0]
        self.assertEqual([image.get_attribute("src") for image in pictures],
                         [run["image"], reference["image"], run["difference"]])
        for image in pictures:
            self.browser.execute_async_script("arguments[0].decode().then(arguments[1])", image)
            self.assertEqual(self.browser.execute_script("return arguments[0].naturalWidth", image), 8)
            self.assertEqual(image.size, {"width": 256, "height": 256})
        self.assertEqual(len(self.all(".detail .color-bar", section)), 1)
        self.assertIn("first picture", self.all(".detail .figures", section)[0].text)
        self.assertEqual(button.get_attribute("aria-expanded"), "true")
        # The opened part stays below its row when the table is sorted.
        self.click(self.all('button[data-column="l2"]', section)[0])
        below = self.browser.execute_script("return arguments[0].closest('tr').nextSibling.className", button)
        self.assertIn("detail", below)
        button.send_keys(Keys.ENTER)
        self.assertEqual(self.all(".detail", section), [])

    def test_keys_of_all_runs_are_shown(self):
        shown = self.all("#environment")[0].text
        self.assertIn("image.width = 128; render.method = slice", shown)
        self.assertNotIn("float16", shown)  # which the sweep replaces
        own = self.all(".facts", self.section(1))[0].get_attribute("textContent")
        self.assertIn("volume.size = 64x64x64", own)
        self.assertIn(HOSTILE, own)
        self.assertIsNone(self.browser.execute_script("return window.wasRun ?? null"))

    def test_norms_are_explained_in_a_line(self):
        norms = self.all("#norms")[0].text
        for norm in ("L∞", "L1", "L2", "1/255"):
            self.assertIn(norm, norms)

    def test_clipped_color_bars_say_so(self):
        report = made_up_report(12)
        runs = measured(report["comparisons"][0])
        runs[1]["linf"], runs[2]["linf"] = 5, 2  # the scale is 2
        self.open(self.write_page("clipped", report))
        section = self.section(0)
        for run, clipped in ((runs[1], True), (runs[2], False)):
            self.click(self.all(f'tr[data-run="{run["id"]}"] button', section)[0])
            bar = self.all(f'tr[data-run="{run["id"]}"] + tr .color-bar', section)[0].text
            self.assertEqual("clipped: up to 5.00/255" in bar, clipped, bar)
            self.assertEqual("≥ +2.00" in bar and "≤ −2.00" in bar, clipped, bar)
            self.assertIn("+2.00 /255", bar)
        picture = self.all(":scope > .pictures .color-bar", section)[0].text
        self.assertIn("≥ +1.50", picture)
        self.assertIn("up to 3.00/255", picture)

    def test_pictures_enlarge(self):
        section = self.section(0)
        dialog = self.all("#enlarged")[0]
        self.assertFalse(dialog.is_displayed())
        button = self.all(":scope > .pictures button.enlarges", section)[0]
        self.browser.execute_async_script(
            "arguments[0].querySelector('img').decode().then(arguments[1])", button)
        button.send_keys(Keys.ENTER)
        self.assertTrue(dialog.is_displayed())
        image = self.all("img", dialog)[0]
        self.assertEqual(image.get_attribute("src"), self.report["comparisons"][0]["pictures"][0]["image"])
        self.assertIn("PT - slicing", dialog.text)
        # A whole multiple of its 8 pixels that fits the window, and larger than before.
        self.assertEqual(image.size["width"] % 8, 0)
        self.assertEqual(image.size["width"], image.size["height"])
        self.assertGreater(image.size["width"], 256)
        inner = self.browser.execute_script("return [window.innerWidth, window.innerHeight]")
        box = dialog.rect
        self.assertLessEqual(box["width"], inner[0])
        self.assertLessEqual(box["height"], inner[1])
        self.browser.switch_to.active_element.send_keys(Keys.ESCAPE)
        self.assertFalse(dialog.is_displayed())
        self.click(button)
        self.click(self.all("img", dialog)[0])
        self.assertFalse(dialog.is_displayed())

    def test_pictures_have_alternative_text(self):
        section = self.section(0)
        run = measured(self.report["comparisons"][0])[0]
        self.click(self.all(f'tr[data-run="{run["id"]}"] button', section)[0])
        described = self.collect(section, "img:not(.thumbnail)", "node.alt")
        self.assertEqual(len(described), 4)  # of the comparison, and three of the run
        for text in described:
            self.assertIn("ramp", text)
        self.assertEqual(len(set(described)), 4)
        self.assertEqual([text for text in described if run["name"] in text], described[1:2] + described[3:])

    def test_dark_mode_is_legible_and_paper_stays_white(self):
        def luminance(color):  # WCAG 2.1, "relative luminance"
            channels = [int(part) / 255 for part in color[color.index("(") + 1:-1].split(",")[:3]]
            linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
            return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

        def contrast(a, b):
            high, low = sorted((luminance(a), luminance(b)), reverse=True)
            return (high + 0.05) / (low + 0.05)

        def style(selector, name):
            return self.browser.execute_script(
                "return getComputedStyle(document.querySelector(arguments[0]))[arguments[1]]", selector, name)

        dark = [{"name": "prefers-color-scheme", "value": "dark"}]
        try:
            for features, shade in (([], 255), (dark, 27)):
                self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "screen", "features": features})
                paper = style("body", "backgroundColor")
                self.assertEqual(paper, f"rgb({shade}, {shade}, {shade})")
                # Level AA: 4.5 for text, 3 for graphics.
                for selector in ("h1", "figcaption", ".note", ".facts dt", "nav a", ".runs td", "select"):
                    self.assertGreaterEqual(contrast(style(selector, "color"), paper), 4.5, selector)
                for selector in (".chart text", ".chart .tick-text"):
                    self.assertGreaterEqual(contrast(style(selector, "fill"), paper), 4.5, selector)
                for selector in (".front", ".baseline-ring", ".frame"):
                    self.assertGreaterEqual(contrast(style(selector, "stroke"), paper), 3, selector)
                for selector in ("#controls", "#hint", "#enlarged", ".runs tbody th"):
                    self.assertEqual(style(selector, "backgroundColor"), paper, selector)
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print", "features": dark})
            self.assertEqual(style("body", "backgroundColor"), "rgb(255, 255, 255)")
            self.assertEqual(style("h1", "color"), "rgb(0, 0, 0)")
        finally:
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "", "features": []})

    def test_a_reproduction_has_labelled_panels(self):
        panels = [{"group": group, "title": title, "caption": "", "image": png(40 * i)}
                  for i, (group, title) in enumerate((("", "software"), ("", HOSTILE), ("inset", "software")))]
        panels[2].update(scale=1, largest=2)
        report = {"title": "A paper", "kind": "reproduction", "findings": ["figure1: Agrees."], "environment": {},
                  "comparisons": [
                      {"scene": "figure1", "note": "Agrees.", "runs": [], "pictures": panels, "rows": [],
                       "anchor": "figure1", "caption": "A leaf.",
                       "checks": [{"says": HOSTILE, "verdict": "agrees", "measured": "3"},
                                  {"says": "b", "verdict": "cannot be tested here", "measured": "4"}],
                       "own": [{"claim": "c", "holds": False, "measured": "5"}]},
                      {"scene": "table1", "anchor": "table1", "note": "Disagrees.", "runs": [], "pictures": [],
                       "checks": [], "own": [],
                       "rows": [{"tree": "32x32", "linf": 0.25, "n": None}, {"tree": [2, 4], "linf": 3, "n": 7}]}]}
        page = self.write_page("paper", report)
        self.open(page)
        self.assertEqual(self.messages(), [])
        figure, table = self.all("#figure1")[0], self.all("#table1")[0]
        labels = self.collect(figure, ".picture figcaption b", "node.textContent")
        self.assertEqual(labels, ["software", HOSTILE, "software"])
        self.assertEqual(self.collect(figure, "h3", "node.textContent"), ["inset"])
        self.assertEqual(self.collect(figure, ".caption", "node.textContent"), ["figure1. A leaf."])
        self.assertEqual(self.all(".caption", table), [])
        self.assertEqual(self.collect(figure, "img", "node.alt"),
                         ["figure1, software", f"figure1, {HOSTILE}", "figure1, inset, software"])
        self.assertEqual(len(self.all(".clipped", figure)), 1)
        checks = self.collect(figure, ".checks tbody tr", "[...node.children].map((cell) => cell.textContent)")
        self.assertEqual(checks, [[HOSTILE, "agrees", "3"], ["b", "cannot be tested here", "4"], ["c", "no", "5"]])
        heads = self.collect(figure, ".checks thead th:first-child", "node.textContent")
        self.assertEqual(heads, ["the paper says", "lamina says"])
        # Whole numbers alone make a column of whole numbers, and a list is no product.
        rows = self.collect(table, ".numbers tr", "[...node.children].map((cell) => cell.textContent)")
        self.assertEqual(rows, [["tree", "linf", "n"], ["32x32", "0.250", "–"], ["2, 4", "3.00", "7"]])
        self.assertEqual(self.collect(self.all("nav")[0], "a", "node.textContent"), ["figure1", "table1"])
        self.assertEqual(self.all("#controls") + self.all(".runs"), [])

    def test_links_jump_to_their_item(self):
        def top(node):
            return self.browser.execute_script("return arguments[0].getBoundingClientRect().top", node)
        panels = [{"group": "", "title": "t", "caption": "", "image": png(90), "width": 8, "height": 8}] * 20
        report = {"title": "A paper", "kind": "reproduction", "summary": "Of 9 items, 9 agree.", "environment": {},
                  "findings": [{"anchor": f"figure{i}", "text": "Agrees."} for i in range(9)],
                  "comparisons": [{"scene": f"figure{i}", "anchor": f"figure{i}", "runs": [], "pictures": panels,
                                   "checks": [], "rows": []} for i in range(9)]}
        page = self.write_page("links", report)
        self.open(page)
        self.assertEqual(self.all("#summary")[0].text, "Of 9 items, 9 agree.")
        height = self.browser.execute_script("return window.innerHeight")
        for links in ("#findings a", "nav a"):
            self.browser.execute_script("window.scrollTo(0, 0)")
            self.assertGreater(top(self.all("#figure7")[0]), height)
            self.all(links)[7].click()
            self.assertTrue(0 <= top(self.all("#figure7 h2")[0]) < height / 2, links)
        # A link from elsewhere, whose target the script makes.
        self.open("about:blank")
        self.open(page + "#figure7")
        self.assertTrue(0 <= top(self.all("#figure7 h2")[0]) < height / 2)

    def test_points_tell_of_their_run_by_keyboard(self):
        section = self.section(0)
        runs = sorted(measured(self.report["comparisons"][0]), key=lambda run: run["frame_ms"]["median"])
        self.assertLess(runs[0]["frame_ms"]["median"], runs[1]["frame_ms"]["median"])
        first = self.all('.scatter .point[tabindex="0"]', section)
        self.assertEqual([point.get_attribute("data-run") for point in first], [runs[0]["id"]])
        self.browser.execute_script("arguments[0].focus()", first[0])
        self.assertIn(runs[0]["name"], self.all("#hint")[0].text)
        first[0].send_keys(Keys.ARROW_RIGHT)
        self.assertIn(runs[1]["name"], self.all("#hint")[0].text)
        self.browser.switch_to.active_element.send_keys(Keys.ENTER)
        opened = self.all(f'tr[data-run="{runs[1]["id"]}"] + tr.detail', section)
        self.assertEqual(len(opened), 1)

    def test_long_tables_print_baseline_and_front(self):
        report = made_up_report(80)
        self.open(self.write_page("long", report))
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        try:
            for index, entry in enumerate(report["comparisons"]):
                section = self.section(index)
                long = len(entry["runs"]) > 60
                shown = self.collect(section, "tr.run", "node.offsetHeight > 0 ? node.dataset.run : null")
                wanted = {run["id"] for run in entry["runs"]
                          if not long or run.get("pareto") or run["id"] == entry["baseline"]}
                self.assertEqual(set(shown) - {None}, wanted)
                notes = [note.is_displayed() for note in self.all(".print-only", section)]
                self.assertEqual(notes, [True] if long else [])
            self.assertFalse(self.all("#controls")[0].is_displayed())
        finally:
            self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})


if __name__ == "__main__":
    PageInBrowser.write_report_page = sys.argv.pop(1)
    unittest.main(verbosity=2)
