# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium for tests of pages."""
import os
import shutil

from selenium import webdriver
from selenium.webdriver.chrome.service import Service


def options_for(profile):
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for argument in ("--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
                     "--disable-background-networking", "--disable-component-update", "--window-size=1280,1000",
                     f"--user-data-dir={profile}"):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")  # which root cannot have
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return options


def started_in(folder):
    """A browser whose profile lies in the folder. The caller calls quit()."""
    # Its crash reporter writes there whatever the profile.
    service = Service(shutil.which("chromedriver") or "chromedriver", env={**os.environ, "XDG_CONFIG_HOME": folder})
    return webdriver.Chrome(service=service, options=options_for(os.path.join(folder, "profile")))
