"""The README's pictures of a report: its first screen and its wing, as a reader with a light theme sees them at 1280 px.

    /usr/bin/python3 tests/browser/pictures.py REPORT.html FOLDER      FOLDER/report_first_screen.png, FOLDER/report_wing.png
"""

import base64
import pathlib
import sys

import pages


def part(driver, path, selector, until):
    """From the top of one element to the bottom of another."""
    left, top, bottom = driver.execute_script("""const box = s => document.querySelector(s).getBoundingClientRect();
        return [0, Math.max(0, box(arguments[0]).top + scrollY - 14), box(arguments[1]).bottom + scrollY + 8]""", selector, until)
    clip = {"x": left, "y": top, "width": 1280, "height": bottom - top, "scale": 1}
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "clip": clip, "captureBeyondViewport": True})
    path.write_bytes(base64.b64decode(shot["data"]))


def main(page, folder):
    driver = pages.browser()
    driver.set_script_timeout(60)
    pages.resize(driver, 1280, 1400)
    pages.media(driver, prefers_color_scheme="light")
    driver.get(pathlib.Path(page).resolve().as_uri())
    pages.settle(driver)
    part(driver, folder / "report_first_screen.png", ".bar", ".again")
    driver.execute_script("""const W = window.wingspread, judged = W.verdicts.judged()[0], worst = W.set().motions.findIndex(m => judged && m.label.includes(W.format.nameOf(judged.requirement.output)));
        W.player.span = "latches"; W.choose("motion", worst < 0 ? 0 : worst);
        const first = Math.min(...W.player.motion.latches.map(latch => latch.time)); W.player.seek(0.985 * first)""")
    pages.settle(driver)
    part(driver, folder / "report_wing.png", "#wing", "#wing .strobe")
    driver.quit()


if __name__ == "__main__":
    main(sys.argv[1], pathlib.Path(sys.argv[2]))
