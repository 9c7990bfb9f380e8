"""Checks the pages (*.md) of the repository: links, commands, and the README's scene and campaign.

    /usr/bin/python3 tests/pages.py ROOT PROGRAM FOLDER      FOLDER is emptied, for the README's files

- every link within the repository leads to a file, and to an existing heading if it names one
- every command line `wingspread COMMAND … --option` of the pages is known to the program's --help
- the README's scene and campaign are accepted without warnings, run, and meet the campaign's requirements

tests/examples.py checks the README's programs.
"""

import functools
import pathlib
import re
import shutil
import subprocess
import sys

NAMES = {'{ "name": "one_panel"': "one_panel.json", '{ "scene": "one_panel.json"': "campaign.json"}


def anchor(heading):
    """Returns the anchor of a heading: lower case, without punctuation, spaces as hyphens."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def broken_links(page, root):
    text = page.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        name, _, place = target.partition("#")
        file = page.parent / name if name else page
        if not file.exists():
            yield f"{page.relative_to(root)}: links to {target}, which does not exist"
        elif place and place not in map(anchor, re.findall(r"(?m)^#+ (.*)$", file.read_text(encoding="utf-8"))):
            yield f"{page.relative_to(root)}: links to {target}: no such heading"


def unknown_options(page, root, program):
    @functools.lru_cache(maxsize=None)
    def help_of(command):
        said = subprocess.run([program, command, "--help"], capture_output=True, text=True, check=False)
        return said.stdout if said.returncode == 0 else None

    for line in re.findall(r"(?m)^    (?:mpirun .*)?wingspread ([a-z].*)$", page.read_text(encoding="utf-8")):
        words = line.split("#")[0].split()
        for command in words[0].split("|"):
            if (known := help_of(command)) is None:
                yield f"{page.relative_to(root)}: {line}: there is no command {command}"
                continue
            for option in (word.strip("[]").split("=")[0] for word in words if word.strip("[").startswith("--")):
                if not re.search(re.escape(option) + r"\b", known):
                    yield f"{page.relative_to(root)}: {line}: {command} has no {option}"


def unmet_readme(root, program, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    found = []
    for block in re.findall(r"(?m)((?:^    .*\n)+)", (root / "README.md").read_text(encoding="utf-8")):
        text = re.sub(r"(?m)^    ", "", block)
        for start, name in NAMES.items():
            if text.startswith(start):
                (folder / name).write_text(text, encoding="utf-8")
                found.append(name)
    if sorted(found) != sorted(NAMES.values()):
        yield f"README.md: has {found}, and not each of {sorted(NAMES.values())} once"
        return
    for words in (["check", "one_panel.json", "--strict"], ["simulate", "one_panel.json"],
                  ["check", "campaign.json", "--strict"], ["run", "campaign.json", "--out", "first", "--runs", "2500"]):
        said = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, check=False)
        if said.returncode != 0:
            yield f"README.md: wingspread {' '.join(words)} ends with {said.returncode}: {said.stderr}"


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    root, program, folder = pathlib.Path(sys.argv[1]).resolve(), str(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(sys.argv[3])
    pages = [page for part in (".", "core", "distributions", "montecarlo", "studies", "tests")
             for page in sorted((root / part).glob("*.md" if part == "." else "**/*.md"))]
    faults = [fault for page in pages for fault in [*broken_links(page, root), *unknown_options(page, root, program)]]
    faults += unmet_readme(root, program, folder)
    print(f"{len(pages)} pages", *faults, sep="\n")
    sys.exit(1 if faults or len(pages) < 30 else 0)


if __name__ == "__main__":
    main()
