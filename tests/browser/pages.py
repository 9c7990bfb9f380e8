"""A headless Chromium with the pages that the tests look at: made-up ones, and the program's own where there is a program."""

import base64
import csv
import json
import os
import pathlib
import shutil
import subprocess
import tempfile

from selenium import webdriver
from selenium.webdriver.chrome.service import Service

import assemble
import mock

CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("WINGSPREAD_PROGRAM")  # where it is set, its own pages are looked at too
_scratch = tempfile.TemporaryDirectory(prefix="wingspread_pages_")
SCRATCH = pathlib.Path(_scratch.name)


def browser():
    options = webdriver.ChromeOptions()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size=1280,1000",
                     "--disable-extensions", "--no-first-run", "--disable-component-update", "--disable-background-networking", "--disable-sync"):
        options.add_argument(argument)
    options.binary_location = CHROMIUM
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(options=options, service=Service(DRIVER))


def made_up(kind):
    """The path of a page of this kind of mock.py; made once."""
    path = SCRATCH / f"{kind}.html"
    if not path.exists():
        path.write_text(assemble.page(json.dumps(mock.KINDS[kind](), allow_nan=False, ensure_ascii=False)), encoding="utf-8")
    return path


def made_of(path, runs, name, *options):
    """The results folder of so many runs of a campaign; made once."""
    folder = SCRATCH / name
    if not folder.exists():
        ran = subprocess.run([PROGRAM, "run", path, "--runs", str(runs), "--out", folder, *options], capture_output=True, text=True)
        assert ran.returncode in (0, 1), ran.stderr  # 1: a requirement is not shown to be met
    return folder


def made(campaign, runs, name=None, *options):
    """The same of a campaign of studies/campaigns."""
    return made_of(ROOT / f"studies/campaigns/{campaign}.json", runs, name or campaign, *options)


def reported(name, *folders):
    """The path of the program's own page of results folders."""
    path = SCRATCH / f"real_{name}.html"
    if not path.exists():
        subprocess.run([PROGRAM, "report", *folders, "--out", path], check=True, capture_output=True)
    return path


def real(campaign, runs):
    return reported(campaign, made(campaign, runs))


def compared(campaign, runs, *options):
    """The page of a campaign beside the same with these options."""
    return reported(f"{campaign}_compared", made(campaign, runs), made(campaign, runs, f"{campaign}_changed", *options))


def table_of(path):
    """The rows of a CSV file, each a dict by column."""
    with open(path) as file:
        return list(csv.DictReader(file))


def rows_of(folder):
    """The rows of a results folder's runs.csv."""
    return table_of(pathlib.Path(folder) / "runs.csv")


def resize(driver, width, height=1000):
    if getattr(driver, "shown_size", None) == (width, height):
        return
    driver.shown_size = width, height
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})


def media(driver, **features):
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": name.replace("_", "-"), "value": value} for name, value in features.items()]})


def picture(driver, path):
    """The whole page as a PNG file."""
    width, height = driver.execute_script("return [innerWidth, Math.min(16000, document.documentElement.scrollHeight)]")
    resize(driver, width, height)
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})
    pathlib.Path(path).write_bytes(base64.b64decode(shot["data"]))
    resize(driver, width)


def settle(driver):
    """Until sizes have been seen and every visible picture is drawn: two frames at least. A picture of a closed part is never drawn."""
    driver.execute_async_script("""const done = arguments[0], end = performance.now() + 1000, shown = { visibilityProperty: true, contentVisibilityAuto: true };
        const missing = one => one.clientWidth && one.checkVisibility(shown) && !one.querySelector('svg');
        const look = () => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() =>
            performance.now() < end && [...document.querySelectorAll('.picture')].some(missing) ? look() : done())));
        look()""")
