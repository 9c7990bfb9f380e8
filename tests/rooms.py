"""Reads every #include of the product and fails on an arrow that runs back.

    /usr/bin/python3 tests/rooms.py          from the repository's root; silent where all is well
    /usr/bin/python3 tests/rooms.py --draw   prints which room uses which

WINGS holds the order of wings and rooms, and no other file does. A file may include files of its own room, of the
rooms above it and of the wings above its own. Rooms on one line know nothing of each other. The compiler cannot check
this, because all targets share one include path. The script also fails on a wing with more than seven rooms, a room
with more than 15 units, a file of more than 400 lines, a file outside every room, and a test whose name begins with "-".
"""

import collections
import pathlib
import re
import sys

WINGS = {
    "distributions": [""],
    "core": ["number", "scene", "outcome", "laws", "mechanics", "dense", "methods", "events", "peaks", "proofs", "run",
             "packs", "deployment"],
    "montecarlo/foundation": ["formats", "platform", "statistics"],
    "montecarlo/model": ["scene_file", "static_margins", "campaign", "input_checks", "schema starter"],
    "montecarlo/engine": ["runs", "mpi accuracy"],
    "montecarlo/results": ["summary", "results_folder", "checkpoint streaming export"],
    "montecarlo/analyses": ["sampler", "run margin sensitivity rare fit"],
    "montecarlo/report": ["data", "kernel", "text page drawing"],
    "montecarlo/interfaces": ["library", "python package terminal", "commands"],
    "montecarlo": ["main mpi_main"],
}
LEVEL, WING = {}, {}
for wing, lines in WINGS.items():
    for names in lines:
        level = len(set(LEVEL.values()))
        for name in names.split(" "):
            room = f"{wing}/{name}".rstrip("/")
            LEVEL[room], WING[room] = level, wing
MOST_LINES = 400  # of a file
MOST_UNITS = 15  # of a room: a header with its source, or either alone
MOST_ROOMS = 7  # of a wing of montecarlo


def room_of(path):
    """The longest known room that the path begins with; a file at a folder's door is a room of its own."""
    parts = pathlib.PurePosixPath(path).with_suffix("").parts
    for length in range(len(parts), 0, -1):
        if (name := "/".join(parts[:length])) in LEVEL:
            return name
    return None


def main():
    files = sorted(str(file) for folder in ("core", "distributions", "montecarlo")
                   for file in pathlib.Path(folder).rglob("*.[ch]pp"))
    faults, units, uses = [], collections.defaultdict(set), collections.defaultdict(set)
    for file in files:
        room = room_of(file)
        if room is None:
            faults.append(f"{file}: stands in no room that tests/rooms.py knows")
            continue
        units[room].add(pathlib.PurePosixPath(file).with_suffix(""))
        lines = pathlib.Path(file).read_text(encoding="utf-8").split("\n")
        if len(lines) - 1 > MOST_LINES:
            faults.append(f"{file}: {len(lines) - 1} lines, at most {MOST_LINES}")
        for number, line in enumerate(lines, 1):
            if not (found := re.match(r'\s*#\s*include\s*"([^"]+)"', line)):
                continue
            other = room_of(found[1])
            if other is None:
                faults.append(f"{file}:{number}: includes {found[1]}, which stands in no room")
            elif other != room:
                uses[room].add(other)
                if LEVEL[other] >= LEVEL[room] or (other == "distributions" and room.startswith("core/")):
                    faults.append(f"{file}:{number}: {room} may not use {other} ({found[1]})")
    for room, held in units.items():
        if len(held) > MOST_UNITS:
            faults.append(f"{room}: {len(held)} units, at most {MOST_UNITS}")
    for name in WINGS:
        folder = pathlib.Path(name)
        rooms = [room for room in folder.iterdir() if room.is_dir()] if folder.is_dir() and "/" in name else []
        if len(rooms) > MOST_ROOMS:
            faults.append(f"{name}: {len(rooms)} rooms, at most {MOST_ROOMS}")
    for file in sorted(pathlib.Path("tests").rglob("*.cpp")):  # Catch2 takes such a name for an option: the test never runs
        for found in re.finditer(r'TEST_CASE\(\s*"(-[^"]*)', file.read_text(encoding="utf-8")):
            faults.append(f'{file}: a test\'s name begins with "-": {found[1]}')
    if "--draw" in sys.argv:
        shown = ""
        for room in sorted(units, key=LEVEL.get):
            if WING[room] != shown:
                shown = WING[room]
                print(f"{shown}/")
            print(f"  {room:36} {len(units[room]):3} units   uses {' '.join(sorted(uses[room], key=LEVEL.get))}")
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
