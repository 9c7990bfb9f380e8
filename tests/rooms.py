"""Reads every #include of the product and fails on an arrow that runs back.

    /usr/bin/python3 tests/rooms.py          from the repository's root; silent where all is well
    /usr/bin/python3 tests/rooms.py --draw   prints which room uses which

The order of the rooms stands here and nowhere else: a file may include what stands in its own room or
in one above it. Rooms on one line know nothing of each other. The compiler cannot see this, for all targets share
one include path. It also fails on a room that is too full, a file that is too long, and a folder without a place.
"""

import collections
import pathlib
import re
import sys

ORDER = """
distributions
core/number
core/scene
core/outcome
core/laws
core/mechanics
core/dense
core/methods
core/events
core/peaks
core/proofs
core/run
core/packs
core/deployment
montecarlo/formats
montecarlo/machine
montecarlo/statistics
montecarlo/scene_file
montecarlo/motorization
montecarlo/campaign
montecarlo/notices
montecarlo/runs
montecarlo/accuracy
montecarlo/summary
montecarlo/folder
montecarlo/log
montecarlo/sensitivity montecarlo/rare montecarlo/margin montecarlo/export montecarlo/rowless
montecarlo/ranks
montecarlo/page_data
montecarlo/report
montecarlo/terminal
montecarlo/library montecarlo/package montecarlo/schema
montecarlo/commands montecarlo/python
montecarlo/main montecarlo/mpi_main
"""
LEVEL = {room: level for level, line in enumerate(ORDER.split("\n")) for room in line.split()}
MOST_LINES = 400  # of a file
MOST_UNITS = 15  # of a room: a header with its source, or either alone


def room_of(path):
    """The longest name in ORDER that the path begins with; a file at a folder's door is a room of its own."""
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
    if "--draw" in sys.argv:
        for room in sorted(units, key=LEVEL.get):
            print(f"{room:26} {len(units[room]):3} units   uses {' '.join(sorted(uses[room], key=LEVEL.get))}")
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
