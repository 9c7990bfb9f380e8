"""Makes the pictures of README.md and of montecarlo/report/README.md with the program, as a reader sees them at 1280 px.

    /usr/bin/python3 studies/plots/plot_readme.py [FOLDER] [--program PROGRAM]      by default studies/figures

Writes new_wing.svg (the wing of `wingspread new`), report_first_screen.png and report_wing.png (the report of the
example "yoke"). Needs build/release/wingspread with the kernel in its page, and the packages of `studies/install --tests`.
"""

import argparse
import base64
import io
import pathlib
import subprocess
import sys
import tempfile

from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/browser"))
import pages  # noqa: E402 (the headless browser of the page's tests)

COLOURS = 256  # a palette takes a third of the room; 99 of 100 pixels move by at most 11 of 255, the ground by none


def part(driver, path, selector, until):
    """From the top of one element to the bottom of another."""
    left, top, bottom = driver.execute_script("""const box = s => document.querySelector(s).getBoundingClientRect();
        return [0, Math.max(0, box(arguments[0]).top + scrollY - 14), box(arguments[1]).bottom + scrollY + 8]""", selector, until)
    clip = {"x": left, "y": top, "width": 1280, "height": bottom - top, "scale": 1}
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "clip": clip, "captureBeyondViewport": True})
    picture = Image.open(io.BytesIO(base64.b64decode(shot["data"]))).convert("RGB")
    picture.quantize(COLOURS, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE).save(path, optimize=True)


def take(page, folder):
    driver = pages.browser()
    driver.set_script_timeout(60)
    pages.resize(driver, 1280, 1400)
    pages.media(driver, prefers_color_scheme="light")
    driver.get(page.resolve().as_uri())
    pages.settle(driver)
    part(driver, folder / "report_first_screen.png", ".bar", ".again")
    driver.execute_script("""const W = window.wingspread, judged = W.verdicts.judged()[0], worst = W.set().motions.findIndex(m => judged && m.label.includes(W.format.nameOf(judged.requirement.output)));
        W.player.span = "latches"; W.choose("motion", worst < 0 ? 0 : worst);
        const first = Math.min(...W.player.motion.latches.map(latch => latch.time)); W.player.seek(0.985 * first)""")
    pages.settle(driver)
    part(driver, folder / "report_wing.png", "#wing", "#wing .strobe")
    driver.quit()


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("folder", type=pathlib.Path, nargs="?", default=ROOT / "studies/figures")
    words.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/wingspread")
    given = words.parse_args()
    program, folder = given.program.resolve(), given.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)

    with tempfile.TemporaryDirectory() as scratch:
        def wingspread(*arguments, may_end_with=(0,)):
            done = subprocess.run([program, *arguments], cwd=scratch, capture_output=True, text=True, check=False)
            if done.returncode not in may_end_with:
                sys.exit(f"wingspread {' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr}")

        wingspread("new", "--panels", "4", "--yoke")
        wingspread("check", "my_wing/campaign.json", "--draw", folder / "new_wing.svg")
        wingspread("new", "--example", "yoke", "--out", "yoke")
        wingspread("run", "yoke/campaign.json", "--out", "results/yoke", may_end_with=(0, 1))  # 1: a requirement fails
        wingspread("report", "results/yoke")
        take(pathlib.Path(scratch) / "results/yoke/report.html", folder)
    for name in ("new_wing.svg", "report_first_screen.png", "report_wing.png"):
        print(f"{folder / name}: {(folder / name).stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
