#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""pages_test.py LAMINA SOURCE: the page of commands is that of the program; every option in a command of any page is one
that its verb has; and what Markdown links to is there, headings included."""
import pathlib
import re
import subprocess
import sys
import urllib.parse

sys.dont_write_bytecode = True
from blocks import command_lines  # noqa: E402

LAMINA, SOURCE = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
PAGES = sorted([*SOURCE.glob("*.md"), *SOURCE.glob("docs/**/*.md"), *SOURCE.glob("share/**/*.md")])
FAULTS = []


def said(*arguments):
    return subprocess.run([LAMINA, *arguments], capture_output=True, text=True, check=True).stdout


def check_page_of_commands():
    if said("man", "--markdown") != (SOURCE / "docs/commands.md").read_text():
        FAULTS.append("docs/commands.md: differs from `lamina man --markdown`; write it again")


def check_options():
    helps = {}
    checked = 0
    for page in PAGES:
        if page.name in ("CHANGELOG.md", "journal.md"):
            continue
        for line in command_lines(page.read_text()):
            verb = line.split()[1]
            if verb not in helps:
                helps[verb] = subprocess.run([LAMINA, verb, "--help"], capture_output=True, text=True).stdout
            if not helps[verb]:
                FAULTS.append(f"{page.relative_to(SOURCE)}: no verb {verb}: {line}")
                continue
            for option in re.findall(r"(?<=\s)--?[a-z][a-z-]*", line):
                checked += 1
                if not re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", helps[verb]):
                    FAULTS.append(f"{page.relative_to(SOURCE)}: {verb} has no {option}: {line}")
    assert checked > 100, checked


def anchors(page):
    """As GitHub makes them from headings."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
    found = set()
    for heading in re.findall(r"^#{1,6} (.*)$", text, re.MULTILINE):
        heading = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading).lower()
        found.add(re.sub(r"[^\w\- ]", "", heading).replace(" ", "-"))
    return found


def check_links():
    checked = 0
    for page in PAGES:
        text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.MULTILINE | re.DOTALL)
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`\n]*`", "", text)):
            if re.match(r"[a-z]+:", target):
                continue
            checked += 1
            path, _, anchor = urllib.parse.unquote(target).partition("#")
            file = (page.parent / path).resolve() if path else page
            if not file.exists():
                FAULTS.append(f"{page.relative_to(SOURCE)}: no {target}")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file):
                FAULTS.append(f"{page.relative_to(SOURCE)}: no heading {target}")
    assert checked > 100, checked


def check_release():
    """Version and date are the same wherever a release says them, and its notes stay short."""
    version = re.search(r"^project\(lamina VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
    notes = re.split(r"^## ", (SOURCE / "CHANGELOG.md").read_text(), flags=re.MULTILINE)[1]
    heading = re.match(r"([\d.]+) \((\d{4}-\d\d-\d\d)\)\n", notes)
    store = re.search(r'<release version="([\d.]+)" date="([\d-]+)"',
                      (SOURCE / "packaging/org.lamina.View.metainfo.xml").read_text())
    if not heading or heading[1] != version:
        FAULTS.append(f"CHANGELOG.md: found {notes.splitlines()[0]!r}, expected {version} and its date")
    elif store.groups() != heading.groups():
        FAULTS.append(f"org.lamina.View.metainfo.xml: found {store.groups()}, expected {heading.groups()}")
    if len(notes.splitlines()) > 80:
        FAULTS.append(f"CHANGELOG.md: found {len(notes.splitlines())} lines of {version}, expected at most 80")


check_page_of_commands()
check_options()
check_links()
check_release()
print("\n".join(FAULTS))
sys.exit(bool(FAULTS))
