#!/usr/bin/env python3
"""Puts faults into the program, one at a time, and counts those that no test notices.

mutants.json lists the faults: in FILE the text FROM becomes TO (AT: a longer text, if FROM is not unique). All faults are
compiled into one copy of the program in build/mutants; the environment variable WINGSPREAD_MUTANT switches one on. A
fault meets the tests of its own room, of its folder, and all others, until one fails. A fault that makes the tests five
times slower counts as noticed. Faults whose text no longer occurs in the code are named, left out, and give exit code 1.

    tests/mutants/mutants.py                 all of them: some 20 minutes on two cores, after the build
    tests/mutants/mutants.py --only 17,30    these
    tests/mutants/mutants.py --list          what they are

"equivalent" explains why a fault changes no result; it does not count. "costs" marks a fault that changes only the time.
Results are kept in build/mutants/results.json.
"""
import argparse
import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
COPY = SOURCE / "build/mutants/source"
BUILD = SOURCE / "build/mutants/build"
RESULTS = pathlib.Path(os.environ.get("MUTANTS_RESULTS", SOURCE / "build/mutants/results.json"))
PARTS = ["core", "distributions", "montecarlo", "cli"]  # test_PART
COPIED = ["CMakeLists.txt", "LICENSE", "core", "distributions", "montecarlo", "tests", "studies"]


def fail(message):
    sys.exit(f"mutants.py: {message}")


def once(text, part, where):
    """The offset of the part, which must occur once."""
    count = text.count(part)
    if count != 1:
        fail(f"{where}: the text occurs {count} times: {part}")
    return text.index(part)


def is_stale(mutant):
    """Whether the mutant's text no longer occurs exactly once in its file: the code has changed."""
    path = SOURCE / mutant["file"]
    at = mutant.get("at", mutant["from"])
    return not path.is_file() or path.read_text(encoding="utf-8").count(at) != 1 or at.count(mutant["from"]) != 1


def put_in(text, number, mutant):
    """The file's text with the fault in it."""
    where = f"mutant {number}, {mutant['file']}"
    old, new = mutant["from"], mutant["to"]
    at = mutant.get("at", old)
    begin = once(text, at, where) + once(at, old, where)
    if mutant.get("form") == "statement":
        changed = f"if (wingspread_mutant({number})) {{ {new} }} else {{ {old} }}"
    else:
        changed = f"(wingspread_mutant({number}) ? ({new}) : ({old}))"
    return text[:begin] + changed + text[begin + len(old):]


def write(path, content):
    """Leaves a file that is the same alone, so that it is not compiled again."""
    if path.exists() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)


def behind_guard(text):
    """With the switch's header before all others."""
    include = f'#include "{HERE / "mutant.hpp"}"\n'
    guard = "#pragma once\n"
    return text.replace(guard, guard + include, 1) if guard in text else include + text


def make_copy(mutants):
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard", *COPIED], cwd=SOURCE, check=True,
                            capture_output=True, text=True).stdout.split("\n")
    names = [name for name in listed if (SOURCE / name).is_file()]
    faults = {}
    for number, mutant in enumerate(mutants, 1):
        if not is_stale(mutant):
            faults.setdefault(mutant["file"], []).append((number, mutant))
    for name in names:
        content = (SOURCE / name).read_bytes()
        if name in faults:
            content = behind_guard(all_in(content.decode(), faults[name])).encode()
        write(COPY / name, content)
    for path in COPY.rglob("*_test.cpp"):  # of tests that have moved
        if str(path.relative_to(COPY)) not in names:
            path.unlink()


def all_in(text, edits):
    """The file's text with several faults in it, none of which may lie in another."""
    places = []
    for number, mutant in edits:
        put_in(text, number, mutant)  # is it there, and once?
        at = mutant.get("at", mutant["from"])
        begin = text.index(at) + at.index(mutant["from"])
        places.append((begin, begin + len(mutant["from"]), number, mutant))
    places.sort()
    for before, after in zip(places, places[1:]):
        if after[0] < before[1]:
            fail(f"mutants {before[2]} and {after[2]} overlap")
    for begin, end, number, mutant in reversed(places):
        text = text[:begin] + put_in(mutant["from"], number, {**mutant, "at": mutant["from"]}) + text[end:]
    return text


def build(jobs):
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -w",
               "-DWINGSPREAD_STUDIES=OFF", *os.environ.get("MUTANTS_CMAKE", "").split()]
    subprocess.run(["cmake", "-S", COPY, "-B", BUILD, *options], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", BUILD, "--target", *[f"test_{part}" for part in PARTS], "--", f"-j{jobs}", "-k0"],
                   check=True)


def limits(seconds):
    """What a process may take: memory, and the processor's time, which does not depend on what else the machine does."""
    def apply():
        resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    return apply


def run_tests(part, number, files, seconds):
    """@return whether they pass, the first that fails, and the processor's time that they took"""
    command = [BUILD / f"tests/test_{part}", "-a", "-#"]
    if files:
        command.append(",".join(f"[#{name}]" for name in files))
    environment = {**os.environ, "WINGSPREAD_MUTANT": str(number), "OMP_NUM_THREADS": "2"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder, open(pathlib.Path(folder) / "output", "w+b") as output:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT,
                                   preexec_fn=limits(seconds), start_new_session=True)
        try:
            code = process.wait(timeout=20 * seconds)
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
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return False, "takes too long", took
    return code == 0, failed_test(text), took


def failed_test(output):
    """The name above the first failure: between two lines of dashes, as Catch prints it."""
    lines = output.split("\n")
    for i, line in enumerate(lines):
        if line.startswith("-----") and i + 1 < len(lines) and lines[i + 1]:
            return lines[i + 1].strip()
    return lines[-2].strip() if len(lines) > 1 else ""


def room_tests(file):
    """The test files of the file's room, that of the file's own name first."""
    path = pathlib.Path(file)
    part = path.parts[0]
    folder = SOURCE / "tests" / path.parent
    names = sorted(test.stem for test in folder.glob("*_test.cpp"))
    own = [name for name in names if name.startswith(path.stem)]
    return part, own, [name for name in names if name not in own]


class Clock:
    """How long tests take without a fault: measured once each, and they must pass."""

    def __init__(self):
        self.known = {}

    def limit(self, part, files):
        key = (part, tuple(files))
        if key not in self.known:
            passes, failed, took = run_tests(part, 0, files, 1800)
            if not passes:
                fail(f"test_{part} fails without any fault: {failed}")
            self.known[key] = took
        return max(20, round(5 * self.known[key]))


def stages(file):
    part, own, others = room_tests(file)
    for files in (own, others):
        if files:
            yield part, files
    yield part, []
    for other in PARTS:
        if other != part:
            yield other, []


def meet(number, mutant, clock, far):
    """@param far how far to go: the tests of its room, its folder, or all"""
    for part, files in stages(mutant["file"]):
        if (far == "room" and not files) or (far == "folder" and part != mutant["file"].split("/")[0]):
            break
        passes, failed, _ = run_tests(part, number, files, clock.limit(part, files))
        if not passes:
            return f"{part}: {failed}"
    return None


def report(mutants, results):
    killed = survived = equivalent = 0
    for number, mutant in enumerate(mutants, 1):
        found = results.get(str(number))
        if "equivalent" in mutant:
            equivalent += 1
        elif found is None:
            continue
        elif found["killed_by"]:
            killed += 1
        else:
            survived += 1
            print(f"{number:4} survives  {mutant['file']}: {mutant['from']}  ->  {mutant['to']}")
    counted = killed + survived
    if counted:
        print(f"{killed} of {counted} are seen by a test ({100 * killed / counted:.1f} %); "
              f"{equivalent} more are equivalent")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", help="numbers, with commas, or part of a file's name")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--no-build", action="store_true", help="what is built already")
    parser.add_argument("--build-only", action="store_true")
    parser.add_argument("--new", action="store_true", help="those alone that are not known to be killed")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="of the build")
    parser.add_argument("--far", choices=["room", "folder", "all"], default="all", help="whose tests")
    arguments = parser.parse_args()
    mutants = json.loads((HERE / "mutants.json").read_text())
    results = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}

    def key(mutant):
        return [mutant["file"], mutant.get("at", ""), mutant["from"], mutant["to"]]

    results = {number: found for number, found in results.items()
               if int(number) <= len(mutants) and found["mutant"] == key(mutants[int(number) - 1])}
    chosen = range(1, len(mutants) + 1)
    if arguments.only:
        words = arguments.only.split(",")
        chosen = [n for n in chosen if str(n) in words or
                  (not words[0].isdigit() and any(word in mutants[n - 1]["file"] for word in words))]
    if arguments.list:
        for n in chosen:
            m = mutants[n - 1]
            print(f"{n:4} {m['file']}: {m['from']}  ->  {m['to']}")
        return
    stale = [n for n, mutant in enumerate(mutants, 1) if is_stale(mutant)]
    for n in stale:
        print(f"{n:4} is stale: its text does not occur once in {mutants[n - 1]['file']}: "
              f"{mutants[n - 1].get('at', mutants[n - 1]['from'])}", file=sys.stderr)
    if not arguments.no_build:
        make_copy(mutants)
        build(arguments.jobs)
    if arguments.build_only:
        return
    clock = Clock()
    for number in chosen:
        mutant = mutants[number - 1]
        known = results.get(str(number))
        if number in stale or "equivalent" in mutant or (arguments.new and known and known["killed_by"]):
            continue
        killed_by = meet(number, mutant, clock, arguments.far)
        results[str(number)] = {"mutant": key(mutant), "killed_by": killed_by}
        print(f"{number:4} {mutant['file']}: {killed_by or 'SURVIVES'}", flush=True)
        RESULTS.write_text(json.dumps(results, indent=1))
    report(mutants, results)
    if stale:
        fail(f"{len(stale)} mutants are stale and were left out: mend their texts in mutants.json")


if __name__ == "__main__":
    main()
