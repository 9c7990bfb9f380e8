"""Prints a report to PDF with the numbers of its pages in the table of contents.

    /usr/bin/python3 studies/plots/print_report.py results/seed/report.html report.pdf

Chromium cannot do this by itself: it lacks CSS's target-counter (none in version 156). The script prints twice. The first
PDF has the page of each section among its named destinations; the second time these numbers stand in the contents. A
third print shows that they moved nothing. It needs chromium and Debian's poppler-utils.
"""

import pathlib
import re
import shutil
import subprocess
import sys


def destinations(text):
    """{section: page} of what `pdfinfo -dests` prints."""
    return {name: int(page) for page, name in re.findall(r'(?m)^\s*(\d+) \[.*\] "(.+)"$', text)}


def address(page, numbers):
    """The page's address, with the numbers for its contents."""
    return page.resolve().as_uri() + ("#pages=" + ",".join(f"{name}:{number}" for name, number in numbers.items()) if numbers else "")


def printed(page, numbers, pdf):
    """Prints the page with these numbers; returns the numbers that the PDF has."""
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-pdf-header-footer", "--virtual-time-budget=20000",
                    "--generate-pdf-document-outline", f"--print-to-pdf={pdf}", address(page, numbers)], check=True, capture_output=True)
    return destinations(subprocess.run(["pdfinfo", "-dests", pdf], check=True, capture_output=True, text=True).stdout)


def main(page, pdf):
    for program in ("chromium", "pdfinfo"):
        if not shutil.which(program):
            raise SystemExit(f"print_report: found no {program}, expected Debian's chromium and poppler-utils")
    numbers = printed(page, {}, pdf)
    for _ in range(3):
        again = printed(page, numbers, pdf)
        if again == numbers:
            return
        numbers = again
    raise SystemExit(f"print_report: the page numbers of {pdf} are not final: they move their sections")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit("expected: print_report.py REPORT.html FILE.pdf")
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
