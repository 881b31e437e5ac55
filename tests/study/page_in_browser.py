# SPDX-License-Identifier: Apache-2.0
"""A report page in headless Chromium, for tests."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

from selenium.webdriver.common.by import By

from made_up_report import made_up_report

sys.path.append(os.path.join(os.path.dirname(__file__), os.pardir, "support"))
import headless_chromium  # noqa: E402


class PageInBrowser(unittest.TestCase):
    """A page of a made-up report, opened anew for each test. The program that writes pages is set by the tests."""
    write_report_page = None

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="lamina-report-", ignore_cleanup_errors=True)
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.report = made_up_report(12)
        cls.page = cls.write_page("report", cls.report)
        cls.browser = headless_chromium.started_in(folder.name)
        cls.addClassCleanup(cls.browser.quit)

    @classmethod
    def write_page(cls, name, report):
        source, page = (os.path.join(cls.folder, name + suffix) for suffix in (".json", ".html"))
        with open(source, "w", encoding="utf-8") as file:
            json.dump(report, file)
        subprocess.run([cls.write_report_page, source, page], check=True)
        return "file://" + page

    def setUp(self):
        self.open(self.page)

    def open(self, page):
        for kind in ("browser", "performance"):
            self.browser.get_log(kind)
        self.browser.get(page)
        # Observers of sizes run with the next frame, and charts are drawn by them.
        self.browser.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(done));")

    def all(self, selector, within=None):
        return (within or self.browser).find_elements(By.CSS_SELECTOR, selector)

    def section(self, index):
        return self.all(f"#comparison-{index + 1}")[0]

    def collect(self, section, selector, value):
        """value, an expression of JavaScript in `node`, of all that the selector finds."""
        return self.browser.execute_script(
            f"return [...arguments[0].querySelectorAll(arguments[1])].map((node) => {value})", section, selector)

    def order(self, section):
        """Returns it of the rows that show."""
        return self.collect(section, "tr.run:not([hidden])", "node.dataset.run")

    def messages(self):
        return [entry["message"] for entry in self.browser.get_log("browser")]

    def requests(self):
        events = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]

    def names(self, section):
        return dict(self.collect(section, ".scatter text.pareto-name", "[node.dataset.run, node.textContent]"))

    def click(self, node):
        self.browser.execute_script("arguments[0].click()", node)
