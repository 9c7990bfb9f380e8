#!/usr/bin/python3
"""Puts faults into the program, one at a time, and says which of them the tests see.

    tests/mutants/mutants.py                          40 faults of seed 1, from all sources
    tests/mutants/mutants.py --seed 7 --count 60      others
    tests/mutants/mutants.py --part montecarlo/results '.*/statistics/.*cpp' page
    tests/mutants/mutants.py --unseen                 again those that no test saw
    tests/mutants/mutants.py --near --count 400       many at once, each against the tests of its room and the recorded answers
    tests/mutants/mutants.py --from faults.json       a reviewer's own faults in place of drawn ones

The faults are drawn, not listed: an operator exchanged, a sign, a bound, a term, condition or statement dropped, a constant
changed, arguments exchanged. The seed draws files by their length, and in each a place by its function's name and text (places.py
for C++, by libclang; page_places.js for the page's scripts, by acorn); no line number and no text of the code stands here.

A reviewer's file is a list of {"file", "function", "old", "new"}: "old" is an expression (or, with "statement": true, a statement that
declares nothing) that stands once in the file, or once on the line "line".

C++: all faults are compiled into one copy of the program in build/mutants (or MUTANTS_FOLDER); WINGSPREAD_MUTANT switches one on.
Libraries with a fault are compiled at -O1, the others as tests/run does it: a ccache with base_dir may have them. A fault that
does not compile is left out. It meets the tests of its own file, room and wing, then all, until one fails; ctest's tests of the
schema, HDF5, Python and the recipes come last. Five times the tests' processor time counts as seen. "never executed": no test ran
the place. Page: the copy has the fault's text, and meets tests/browser/report_test.py Quick. What is missing is installed first.
"""
import argparse
import collections
import concurrent.futures
import hashlib
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
COPY = pathlib.Path(os.environ.get("MUTANTS_FOLDER", SOURCE / "build/mutants"))
RESULTS = COPY / "results.json"
BUILD = COPY / "build/release"  # laid out as tests/run does it, so that ccache has what has no fault
COPIED = [":(glob)*", "core", "distributions", "montecarlo", "tests", "studies"]  # the first: files that lie at the top
PAGE = "montecarlo/report/page/"
# entry points of other programs, and code for other processors
LEFT_OUT = re.compile(r"(main|mpi_transport|module|hdf5_missing|pack_neon|pack_avx512|runs_fma)\.cpp$")
LAST = "^(answers|schema|hdf5|python: the module|pages|ranks: recipes)"  # ctest's names


def chance(*key):
    """A number in (0, 1), drawn by the key."""
    return (int.from_bytes(hashlib.sha256(repr(key).encode()).digest()[:7], "big") + 0.5) / 2**56


def tracked():
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", *COPIED], cwd=SOURCE, check=True, capture_output=True, text=True)
    return [name for name in listed.stdout.split("\n") if name and (SOURCE / name).is_file()]


def places(name):
    if name.endswith(".js"):
        found = subprocess.run(["node", HERE / "page_places.js", SOURCE / name], env={**os.environ, "NODE_PATH": "/usr/share/nodejs"},
                               check=True, capture_output=True, text=True)
        return json.loads(found.stdout)
    from places import cpp_places
    return cpp_places(SOURCE, SOURCE / name, ["/usr/include/eigen3", BUILD / "montecarlo/stamp"])


def draw(seed, count, parts):
    """The faults: files by their lengths, each file's places by a hash of what they are; none overlaps another."""
    files = [name for name in tracked() if re.match(r"(core|distributions|montecarlo)/.*\.[ch]pp$|" + PAGE + r".*\.js$", name)
             and not LEFT_OUT.search(name) and (not parts or any(re.match(part, "page" if name.endswith(".js") else name) for part in parts))]
    lengths = {name: (SOURCE / name).read_bytes().count(b"\n") for name in files}
    turns = sorted((-math.log(chance(seed, name, k)) / lengths[name], name) for name in files for k in range(count))[:count]
    wanted, drawn = collections.Counter(name for _, name in turns), []
    for name, number in sorted(wanted.items()):
        seen, ranked = collections.Counter(), []
        for place in places(name):
            key = (place["function"], place["old"], place["new"])
            seen[key] += 1
            ranked.append((chance(seed, name, key, seen[key]), place))
        ranges = []
        for _, place in sorted(ranked, key=lambda pair: pair[0]):
            begin, end = min(edit[0] for edit in place["edits"]), max(edit[1] for edit in place["edits"])
            if len(ranges) < number and all(end <= b or e <= begin for b, e in ranges):
                ranges.append((begin, end))
                drawn.append({"file": name, **place})
    return drawn


def read_faults(path):
    """The faults of a reviewer's file, placed as drawn ones are."""
    placed = []
    for fault in json.loads(pathlib.Path(path).read_text("utf-8")):
        content, old = (SOURCE / fault["file"]).read_bytes(), fault["old"].encode()
        begins = [found.start() for found in re.finditer(re.escape(old), content)]
        if "line" in fault:
            begins = [at for at in begins if content.count(b"\n", 0, at) + 1 == fault["line"]]
        if len(begins) != 1:
            sys.exit(f"mutants.py: {path}: {fault['old']!r} stands {len(begins)} times in {fault['file']}: it must stand there once, or once on \"line\"")
        at = begins[0]
        if fault["file"].endswith(".js"):
            at = len(content[:at].decode())  # of texts: characters
            old = fault["old"]
        placed.append({"function": "", **fault, "edits": [(at, at + len(old), fault["new"])]})
    return placed


def write(path, content):
    """Leaves a file that is the same alone, so that it is not compiled again."""
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def switched(content, faults):
    """A C++ file's bytes with all its faults, each behind its switch; @return also the numbers of the faults on each line."""
    edits = sorted(((*edit, number, fault) for number, fault in faults for edit in fault["edits"]), key=lambda edit: edit[0], reverse=True)
    for begin, end, new, number, fault in edits:
        old, new = content[begin:end].decode(), new.replace("\n", " ")
        cast = "wingspread_mutant_condition" if fault.get("condition") else ""
        form = f"(wingspread_mutant({number}) ? {cast}({new}) : {cast}({old}))"
        if fault.get("statement"):
            form = f"if (wingspread_mutant({number})) {{ {new} }} else {{ {old} }}"
        content = content[:begin] + form.encode() + content[end:]
    text, guard = content.decode(), "#pragma once\n"
    include = '#include "tests/mutants/mutant.hpp"\n'
    text = text.replace(guard, guard + include, 1) if guard in text else include + text
    return text.encode(), {at: {int(n) for n in re.findall(r"wingspread_mutant\((\d+)\)", line)} for at, line in enumerate(text.split("\n"), 1)}


def make_copy(faults):
    names, lines = tracked(), {}
    for name in names:
        content = (SOURCE / name).read_bytes()
        own = [(number, fault) for number, fault in faults.items() if fault["file"] == name and not name.endswith(".js")]
        if own:
            content, lines[name] = switched(content, own)
        write(COPY / name, content)
        (COPY / name).chmod((SOURCE / name).stat().st_mode)  # the build runs scripts
    for path in COPY.rglob("*.?pp"):  # of files that have moved
        if str(path.relative_to(COPY)) not in names:
            path.unlink()
    return lines


def targets(faults, which):
    """What ninja builds for the stages of these faults."""
    binaries = {stage[0] for fault in faults.values() for stage in stages(fault["file"], *which)} - {"page"}
    return ["all"] if "ctest" in binaries else [name if name == "wingspread" else f"test_{name}" for name in sorted(binaries)]


def build(faults, jobs, which, tests_from):
    """Compiles the copy; @return the faults that compile."""
    changed = {"wingspread_" + fault["file"].split("/")[0] for fault in faults.values()}
    changed |= {"wingspread_pack_avx2", "wingspread_pack_avx512"} if "wingspread_core" in changed else set()
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DWINGSPREAD_STUDIES=OFF", f"-DWINGSPREAD_CHANGED={';'.join(sorted(changed))}",
               f"-DWINGSPREAD_TESTS_FROM={'' if any(fault['file'].endswith('.hpp') for fault in faults.values()) else tests_from or ''}",
               f"-DCMAKE_PROJECT_TOP_LEVEL_INCLUDES={HERE / 'mutants.cmake'}"]
    if shutil.which("ccache") and "CMAKE_CXX_COMPILER_LAUNCHER" not in os.environ:
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    while True:
        lines = make_copy(faults)
        subprocess.run(["cmake", "-S", COPY, "-B", BUILD, *options], check=True, stdout=subprocess.DEVNULL)
        built = subprocess.run(["ninja", "-C", BUILD, f"-j{jobs}", "-k0", *targets(faults, which)], capture_output=True, text=True)
        if built.returncode == 0:
            return faults
        wrong = set()
        for path, line in re.findall(r"(?m)^(\S+?):(\d+):\d+: (?:error|fatal error|  ?required)", built.stdout):
            path = pathlib.Path(os.path.normpath(BUILD / path))
            if path.is_relative_to(COPY):
                wrong |= lines.get(str(path.relative_to(COPY)), {}).get(int(line), set())
        if not wrong & faults.keys():
            sys.exit("mutants.py: the copy does not compile:\n" + built.stdout[-4000:])
        faults = {number: fault for number, fault in faults.items() if number not in wrong}


def run(command, number, seconds, folder, **environment):
    """@return (whether it passes, its output); `seconds` of processor time, which does not depend on what else the machine does"""
    def limits():
        if "report_test.py" not in str(command):  # Chromium reserves terabytes of addresses
            resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, cwd=folder, stdout=output, stderr=subprocess.STDOUT, preexec_fn=limits, start_new_session=True,
                                   env={**os.environ, "WINGSPREAD_MUTANT": str(number), "OMP_NUM_THREADS": "2", **environment})
        try:
            code = process.wait(timeout=30 * seconds)
        except subprocess.TimeoutExpired:
            code = -signal.SIGXCPU
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)  # and whatever it has started
            except ProcessLookupError:
                pass
            process.wait()
        output.seek(0)
        text = output.read().decode(errors="replace")
    return code == 0, "takes too long" if code in (-signal.SIGXCPU, -signal.SIGKILL) else text


def what_failed(text):
    """The name of the first failing test, or of its file, as Catch, unittest or ctest print it."""
    failed = text.find(" FAILED:")  # Catch2: before it stands the test's name, before that perhaps those of tests that warn
    if failed >= 0:
        text = text[max((found.start() for found in re.finditer(r"(?m)^-{70,}\n.+\n(?:  .*\n)*-{70,}\n", text[:failed])), default=0):]
    for pattern in (r"(?m)^(?:FAIL|ERROR): (.+)", r"(?m)^-{70,}\n(.+)\n", r"(?m)^\s+\d+ - (.+) \(", r"(.+)\s*\Z"):
        found = re.search(pattern, text)
        if found:
            return found[1].strip()
    return "no output"


def stages(name, quick, near=False):
    """Commands that test a file of the product, the closest tests first; if `near`, those of its room, or of its wing, and the recorded answers."""
    if name.endswith(".js"):
        return [["page"]]
    part, folder = name.split("/")[0], pathlib.PurePath(name).parent
    tests = sorted(SOURCE.glob(f"tests/{folder}/*_test.cpp"))
    own = [test.stem for test in tests if test.stem.startswith(pathlib.Path(name).stem)]
    room = [test.stem for test in tests if test.stem not in own]
    wing = [test.stem for test in SOURCE.glob(f"tests/{folder.parent}/**/*_test.cpp") if test not in tests] if len(folder.parts) > 2 else []
    found = [["hdf5"]] if folder.name == "export" else []
    found += [[part, ",".join(f"[#{stem}]" for stem in some)] for some in (own, room, wing) if some]
    if near:
        closest = [some for some in (own, room) if some] or [some for some in (wing,) if some]
        return [*([[part, ",".join(f"[#{stem}]" for stem in some)] for some in closest] or [[part]]), ["wingspread"]]
    others = ["cli", "ctest"] if part == "montecarlo" else ["montecarlo", "cli"]
    return [*found, [part], *[[other] for other in others if not quick or (part == "montecarlo" and other == "cli")]]


def meet_stage(stage, number, fault, seconds, scratch):
    """Runs one stage's tests with one fault switched on (0: none)."""
    if stage == ["page"]:
        for name in tracked_page():
            write(scratch / name, (SOURCE / name).read_bytes())
        if fault:
            text = (SOURCE / fault["file"]).read_text("utf-8")
            for begin, end, new in sorted(fault["edits"], reverse=True):
                text = text[:begin] + new + text[end:]
            write(scratch / fault["file"], text.encode())
        return run(["/usr/bin/python3", scratch / "tests/browser/report_test.py", "-f", "Quick"], number, seconds, scratch)
    if stage == ["wingspread"]:
        return run(["/usr/bin/python3", SOURCE / "tests/answers/answers.py", BUILD / "wingspread", "--jobs", "1"], number, seconds, scratch)
    if stage == ["ctest"]:
        return run(["ctest", "--test-dir", BUILD, "-R", LAST, "--stop-on-failure"], number, seconds, scratch)
    return run([BUILD / f"tests/test_{stage[0]}", "-a", "-#", *stage[1:]], number, seconds, scratch,
               WINGSPREAD_MUTANT_REACHED=str(scratch / "reached"))


def tracked_page():
    return [name for name in tracked() if name.startswith(("tests/browser/", "studies/plots/", PAGE))]


class Clock:
    """The processor's time of each stage without a fault: it must pass. Measured where the first fault comes to it."""

    def __init__(self):
        self.known = {}
        self.locks = collections.defaultdict(threading.Lock)

    def limit(self, stage):
        key = tuple(stage)
        with self.locks[key]:
            return self.known.get(key) or self.measure(key, stage)

    def measure(self, key, stage):
        """Faults that other threads meet meanwhile may lengthen the limit, never shorten it."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        with tempfile.TemporaryDirectory() as scratch:
            passes, text = meet_stage(stage, 0, None, 3600, pathlib.Path(scratch))
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        if not passes:
            sys.exit(f"mutants.py: {' '.join(stage)} fails without any fault: {what_failed(text)}")
        self.known[key] = max(20, round(5 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)))
        return self.known[key]


def meet(number, fault, clock, which):
    """@return which test sees it, or None; and whether any test reached it"""
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        for stage in stages(fault["file"], *which):
            passes, text = meet_stage(stage, number, fault, clock.limit(stage), scratch)
            if not passes:
                return {"seen": f"{stage[0]}: {what_failed(text)}"}
        return {"seen": None, "reached": fault["file"].endswith(".js") or (scratch / "reached").exists()}


def wing_of(name):
    parts = name.split("/")
    return "page" if name.startswith(PAGE) and name.endswith(".js") else "/".join(parts[:2]) if parts[0] == "montecarlo" else parts[0]


def report(faults, results):
    tally = collections.defaultdict(lambda: [0, 0])
    for number, fault in faults.items():
        found = results.get(number)
        if not found:
            continue
        seen = found["seen"] is not None
        for key in (wing_of(fault["file"]), "all"):
            tally[key][0] += seen
            tally[key][1] += 1
        if not seen:
            print(f"\nunseen: {number}, {fault['file']}, {fault['function']}{'' if found['reached'] else ' (never executed)'}")
            print("\n".join(f"  - {line}" for line in fault["old"].split("\n")) + "\n" + "\n".join(f"  + {line}" for line in fault["new"].split("\n")))
    print()
    for key, (seen, of) in sorted(tally.items(), key=lambda row: (row[0] == "all", row[0])):
        print(f"{key:25} {seen:4} of {of:4} seen ({100 * seen / of:.0f} %)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--from", dest="source", metavar="FILE", type=os.path.abspath, help="the faults of this file (JSON); none is drawn")
    parser.add_argument("--part", nargs="+", help="sources: the beginnings of their names, as regular expressions, or page")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--quick", action="store_true", help="core meets core's tests alone, montecarlo not those of ctest")
    parser.add_argument("--near", action="store_true", help="only the tests of the fault's room, or of its wing where the room has none, and the recorded answers")
    parser.add_argument("--tests-from", type=os.path.abspath, help="a finished build, e.g. build/release, whose tests are linked if no header has a fault")
    parser.add_argument("--list", action="store_true", help="draw only")
    parser.add_argument("--unseen", action="store_true", help="of the last call's faults those that no test saw")
    arguments = parser.parse_args()
    subprocess.run([SOURCE / "studies/install", "--mutants"], check=True)
    if arguments.unseen:
        last = json.loads(RESULTS.read_text())
        arguments.seed, arguments.count, arguments.part, arguments.source = (last[key] for key in ("seed", "count", "part", "from"))
    faults = dict(enumerate(read_faults(arguments.source) if arguments.source else draw(arguments.seed, arguments.count, arguments.part), 1))
    if arguments.list:
        for number, fault in faults.items():
            print(f"{number:4} {fault['file']} {fault['function']}: {fault['old']}  ->  {fault['new']}")
        return
    which = (arguments.quick, arguments.near)
    compiled = build(faults, arguments.jobs, which, arguments.tests_from) if any(not fault["file"].endswith(".js") for fault in faults.values()) else faults
    chosen = {number: fault for number, fault in compiled.items() if not arguments.unseen or last["seen"].get(str(number), 0) is None}
    clock, results = Clock(), {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        waiting = {pool.submit(meet, number, fault, clock, which): number for number, fault in chosen.items()}
        for done in concurrent.futures.as_completed(waiting):
            number = waiting[done]
            results[number] = done.result()
            print(f"{number:4} {faults[number]['file']} {faults[number]['function']}: {results[number]['seen'] or 'UNSEEN'}", flush=True)
    seen = {number: found["seen"] for number, found in results.items()}
    COPY.mkdir(parents=True, exist_ok=True)
    RESULTS.write_text(json.dumps({"seed": arguments.seed, "count": arguments.count, "part": arguments.part, "from": arguments.source, "seen": seen}, indent=1))
    report(chosen, results)
    print(f"{arguments.source or f'seed {arguments.seed}'}; {len(faults) - len(compiled)} of {len(faults)} faults do not compile")


if __name__ == "__main__":
    main()
