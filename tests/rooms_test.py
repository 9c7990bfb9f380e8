"""Makes small trees with one fault each, and expects rooms.py to name it.

    /usr/bin/python3 tests/rooms_test.py tests/rooms.py FOLDER      FOLDER is made anew
"""

import pathlib
import shutil
import subprocess
import sys

SOUND = {"core/scene/scene.hpp": "", "core/run/run.hpp": '#include "core/scene/scene.hpp"\n',
         "distributions/law.hpp": "", "montecarlo/engine/runs/run.cpp": '#include "distributions/law.hpp"\n'}
FAULTS = {
    "an arrow that runs back": ({"core/scene/scene.hpp": '#include "core/run/run.hpp"\n'},
                                "core/scene/scene.hpp:1: core/scene may not use core/run"),
    "core that uses distributions": ({"core/run/run.hpp": '#include "distributions/law.hpp"\n'},
                                     "core/run may not use distributions"),
    "rooms on one line": ({"montecarlo/analyses/rare/a.hpp": "",
                           "montecarlo/analyses/margin/b.hpp": ' #  include "montecarlo/analyses/rare/a.hpp"\n'},
                          "montecarlo/analyses/margin may not use montecarlo/analyses/rare"),
    "a wing that uses a lower one": ({"montecarlo/results/summary/a.hpp": "",
                                      "montecarlo/engine/runs/b.hpp": '#include "montecarlo/results/summary/a.hpp"\n'},
                                     "montecarlo/engine/runs may not use montecarlo/results/summary"),
    "a full wing": ({f"montecarlo/engine/runs_{k}/README.md": "" for k in range(7)},
                    "montecarlo/engine: 8 rooms, at most 7"),
    "a file without a room": ({"core/attic/a.hpp": ""}, "core/attic/a.hpp: stands in no room"),
    "an include without a room": ({"core/run/run.hpp": '#include "core/attic/a.hpp"\n'}, "which stands in no room"),
    "a long file": ({"core/run/run.hpp": "//\n" * 401}, "core/run/run.hpp: 401 lines, at most 400"),
    "a test whose name is an option": ({"tests/core/run_test.cpp": 'TEST_CASE("--out is refused") {}\n'}, 'begins with "-": --out'),
    "a full room": ({f"core/run/unit_{k}.hpp": "" for k in range(15)}, "core/run: 16 units, at most 15"),
}


def check(script, folder, files):
    shutil.rmtree(folder, ignore_errors=True)
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return subprocess.run([sys.executable, script], cwd=folder, capture_output=True, text=True, check=False)


def main():
    script, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    failures = 0
    sound = check(script, folder, SOUND)
    if sound.returncode != 0 or sound.stderr:
        print(f"a sound tree: exit {sound.returncode}, {sound.stderr}")
        failures += 1
    for name, (files, expected) in FAULTS.items():
        found = check(script, folder, SOUND | files)
        if found.returncode != 1 or found.stderr.count("\n") != 1 or expected not in found.stderr:
            print(f"{name}: exit {found.returncode}, expected '{expected}', found: {found.stderr}")
            failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
