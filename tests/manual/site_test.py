#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""site_test.py SOURCE: builds the manual without a warning, finds every link of its pages, and looks at each page in headless
Chromium at the width of a phone and of a desk, light and dark. 77: Sphinx or Chromium is not there."""
import html.parser
import pathlib
import shutil
import subprocess
import sys
import tempfile
import urllib.parse

SOURCE = pathlib.Path(sys.argv[1])
sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "support"))
NO_TOOL = 77
PHONE, DESK = 360, 1280


class Links(html.parser.HTMLParser):
    """Collects the links of a page, what it loads, and the places in it."""

    def __init__(self, page):
        super().__init__()
        self.links, self.loaded, self.places = [], [], set()
        self.feed(page.read_text())

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.places.update(filter(None, (attributes.get("id"), attributes.get("name"))))
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        elif tag in ("img", "script", "link", "source", "iframe"):
            self.loaded.append(attributes.get("src") or attributes.get("href") or "#")


def faults_of_links(site):
    pages = {page: Links(page) for page in sorted(site.rglob("*.html"))}
    for page, found in pages.items():
        for target in found.loaded:
            if ":" in target.split("/")[0] or target.startswith("//"):
                yield f"{page.name}: loads {target}"
        for target in found.links + found.loaded:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme:
                continue
            file = (page.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else page
            if not file.exists():
                yield f"{page.name}: no {target}"
            elif parts.fragment and file in pages and parts.fragment not in pages[file].places:
                yield f"{page.name}: no place {target}"


# Blocks wider than the window must scroll inside of themselves.
LOOK = """
const wide = document.scrollingElement.scrollWidth - document.documentElement.clientWidth;
const missing = [...document.images].filter(image => !image.naturalWidth).map(image => image.src);
const channels = getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g).slice(0, 3).map(Number);
return [wide, missing, channels.reduce((a, b) => a + b) / 3];
"""


def faults_of_looks(site, browser):
    for width in (PHONE, DESK):
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                {"width": width, "height": 800, "deviceScaleFactor": 1, "mobile": width == PHONE})
        for scheme, is_right in (("light", lambda mean: mean > 200), ("dark", lambda mean: mean < 60)):
            browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                    {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            for page in sorted(site.rglob("*.html")):
                browser.get(page.as_uri())
                wide, missing, brightness = browser.execute_script(LOOK)
                where = f"{page.relative_to(site)}, {width} px, {scheme}"
                if wide > 0:
                    yield f"{where}: {wide} px wider than the window"
                if missing:
                    yield f"{where}: not shown: {missing}"
                if not is_right(brightness):
                    yield f"{where}: background {brightness}"
                yield from (f"{where}: {entry['message']}" for entry in browser.get_log("browser"))


def main():
    try:
        import furo, myst_parser, sphinx  # noqa: F401, E401
        import headless_chromium
    except ImportError as error:
        print(error)
        return NO_TOOL
    if not shutil.which("chromium"):
        return NO_TOOL
    with tempfile.TemporaryDirectory(prefix="lamina-manual-", ignore_cleanup_errors=True) as folder:
        site = pathlib.Path(folder) / "site"
        subprocess.run([SOURCE / "tools/manual", "-o", site], check=True)
        faults = list(faults_of_links(site))
        browser = headless_chromium.started_in(folder)
        try:
            faults += faults_of_looks(site, browser)
        finally:
            browser.quit()
        assert len(list(site.rglob("*.html"))) > 25
    print("\n".join(faults))
    return bool(faults)


sys.exit(main())
