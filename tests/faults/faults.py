"""Makes every call fail that a small campaign asks of the system, one at a time, and looks at what is left.

    /usr/bin/python3 tests/faults/faults.py --program build/release/wingspread --library build/release/tests/libfaults.so
                                            [--out DIR] [--only NAME]

Each scenario is a command in a folder. It is done once without faults, for its exit code, its files and the calls
that it makes (faults.c counts those below its folder); then again for every call and every way in which that call
can fail. What a fault may lead to:

    a signal, a short write or no   nothing: the same exit code and the same files
    further thread
    a refusal of the machine        exit code 4, each line of standard error an error, the place named in one; nothing
                                    where it is of no account: a folder or the lock that cannot be looked at
    the process is killed there     what was complete of the rows is still there

After each of them, what was there before is still there, no `.part` is left (but by a process that was killed: there
the next one clears it away), the rows are the first ones of the whole, and the command that goes on ends with the
files of the run without faults, byte for byte. The last line says how many faults there were.

Each scenario takes one fault in four, spread over calls and kinds; all of them where WINGSPREAD_NIGHTLY is set.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import shutil
import subprocess
import sys

HARMLESS = ("EINTR", "SHORT", "EAGAIN")
KINDS = [  # how a call fails, and whether those after it do too: a full disk stays full
    ("write", "ENOSPC", True), ("write", "EIO", False), ("write", "EINTR", False), ("write", "SHORT", False),
    ("open", "EACCES", False), ("open", "EMFILE", False), ("mkdir", "EACCES", False), ("read", "EIO", False),
    ("read", "EINTR", False), ("read", "SHORT", False), ("fsync", "EIO", False), ("fsync", "EINTR", False),
    ("close", "EIO", False), ("rename", "ENOSPC", False), ("truncate", "EIO", False), ("flock", "EIO", False),
    ("allocate", "ENOSPC", True), ("mmap", "ENOMEM", False), ("thread", "EAGAIN", True), ("thread", "EAGAIN", False),
    ("write", "KILL", False), ("fsync", "KILL", False), ("rename", "KILL", False), ("truncate", "KILL", False),
    ("unlink", "KILL", False)]
SCENE = {
    "name": "two", "base": {"motion": "fixed"},
    "bodies": [{"name": name, "mass": 10, "inertia": 0.5} for name in ("inner", "outer")],
    "hinges": [
        {"name": "root", "parent": "base", "child": "inner", "parent_point": [0, 0], "child_point": [-0.5, 0],
         "angle": {"stowed": 1.57, "latched": 0}, "spring": {"torque_stowed": 2, "torque_latched": 1.4},
         "latch": {"stiffness": 1e4, "damping": 100}},
        {"name": "tip", "parent": "inner", "child": "outer", "parent_point": [0.5, 0], "child_point": [-0.5, 0],
         "angle": {"stowed": -3, "latched": 0}, "spring": {"torque_stowed": 1.5, "torque_latched": 0.5},
         "latch": {"stiffness": 1e4, "damping": 100}}]}
CAMPAIGN = {
    "scene": SCENE,
    "dispersions": [
        {"name": "spring", "distribution": {"type": "normal", "mean": 1, "std": 0.05}, "apply": "scale",
         "to": ["hinges.root.spring.torque_stowed"]},
        {"name": "mass", "distribution": {"type": "uniform", "lower": 9, "upper": 11}, "apply": "set",
         "each": "bodies.*.mass"}],
    "sampling": {"runs": 24, "seed": 7}, "integration": {"rtol": 1e-4, "atol": 1e-6, "t_end": 20},
    "outputs": ["latch_time"],
    "requirements": [{"output": "root.latch_time", limit: at, "probability": 0.5, "confidence": 0.5}
                     for limit, at in (("max", 4.6), ("min", 4.2))],  # the springs' window has two edges
    "margin": {"scale": ["hinges.*.spring.torque_stowed"], "range": [0.9, 1.1], "points": 2, "tolerance": 0.2}}


class Scenario:
    """A command, in a folder that `given` has filled; {} in its words stands for the folder."""

    def __init__(self, name, command, given=(), again=None, calls=None):
        self.name, self.command, self.given, self.again = name, command, given, again or command
        self.kinds = [kind for kind in KINDS if calls is None or kind[0] in calls]
        self.ignored = ("timing.json", ".lock")


RUN = ["run", "{}/campaign.json", "--out", "{}/r", "--threads", "1"]
HALVES = [RUN[:3] + [f"{{}}/{part}", "--threads", "1", "--shard", f"{i}/2"] for i, part in ((1, "a"), (2, "b"))]
SOBOL = ["sensitivity", "{}/campaign.json", "--samples", "4", "--resamples", "20", "--threads", "1", "--out", "{}/s"]
MARGIN = ["margin", "{}/campaign.json", "--out", "{}/m", "--threads", "1"]
RARE = ["rare", "{}/campaign.json", "--out", "{}/p", "--threads", "1", "--samples", "100", "--repeats", "1",
        "--output", "root.latch_time", "--above", "4.6"]
SCENARIOS = [
    Scenario("run", RUN, again=RUN + ["--resume"]),
    Scenario("resume", RUN + ["--resume"], given=[RUN, "cut {}/r/runs.csv"]),
    Scenario("margin", MARGIN, again=MARGIN + ["--resume"]),
    Scenario("margin resumed", MARGIN + ["--resume"], given=["kill"]),
    Scenario("rare", RARE, again=RARE + ["--resume"]),
    Scenario("merge", ["merge", "{}/a", "{}/b", "--out", "{}/r"], given=HALVES),
    Scenario("analyze", ["analyze", "{}/r"], given=[RUN]),
    Scenario("analyze elsewhere", ["analyze", "{}/r", "--out", "{}/t"], given=[RUN]),
    Scenario("sensitivity", ["sensitivity", "{}/r"], given=[RUN]),
    Scenario("sensitivity elsewhere", ["sensitivity", "{}/r", "--out", "{}/t"], given=[RUN]),
    Scenario("sobol", SOBOL, again=SOBOL + ["--resume"]),
    Scenario("replay", ["replay", "{}/r", "--run", "3", "--out", "{}/trajectory.csv"], given=[RUN]),
    Scenario("sample", ["sample", "{}/campaign.json", "--out", "{}/draws.csv"]),
    Scenario("spilling", ["analyze", "{}/long"], given=[RUN, "lengthen"], calls=("open", "allocate", "mmap")),
    Scenario("simulate", ["simulate", "{}/campaign.json", "--out", "{}/trajectory.csv"]),
    *(Scenario(f"{command[0]} on threads", ["3" if word == "1" else word for word in command], calls=("thread",))
      for command in (RUN, MARGIN)),
]
Ended = collections.namedtuple("Ended", "code out error")


def cut(file):
    """Leaves half of the rows, and of the next one a part: as a crash does."""
    lines = pathlib.Path(file).read_bytes().splitlines(keepends=True)
    pathlib.Path(file).write_bytes(b"".join(lines[:len(lines) // 2]) + lines[len(lines) // 2][:9])


def lengthen(folder):
    """The rows again and again, so many that columns of them go to temporary files."""
    header, *rows = (folder / "r" / "runs.csv").read_text().splitlines(keepends=True)
    campaign = json.loads((folder / "r" / "campaign.json").read_text())
    del campaign["wingspread"]  # nobody's stamp: its runs are not its draws'
    campaign["sampling"]["runs"] = 33_000
    (folder / "long").mkdir()
    (folder / "long" / "campaign.json").write_text(json.dumps(campaign))
    rows = [row.partition(",")[2] for row in rows]
    (folder / "long" / "runs.csv").write_text(
        header + "".join(f"{run},{rows[run % len(rows)]}" for run in range(33_000)))


def contents(folder, ignored=()):
    """The bytes of every file, by its place in the folder."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*"))
            if file.is_file() and file.name not in ignored}


class Bench:
    """Where one scenario is done, again and again."""

    def __init__(self, options, scenario):
        self.program, self.library, self.scenario = options.program, options.library, scenario
        self.folder = options.out / scenario.name
        shutil.rmtree(self.folder, ignore_errors=True)
        self.here, self.template, self.log = self.folder / "here", self.folder / "template", self.folder / "log"
        self.template.mkdir(parents=True)
        (self.template / "campaign.json").write_text(json.dumps(CAMPAIGN))
        self.here.mkdir()
        self.renew()
        for command in scenario.given:
            if command == "lengthen":
                lengthen(self.here)
            elif command == "kill":
                self.kill()
            elif isinstance(command, str):
                cut(command.split()[1].format(self.here))
            elif (ended := self.do(command)).code != 0:
                sys.exit(f"{scenario.name}: {command}: {ended}")
        self.template = self.folder / "given"
        shutil.copytree(self.here, self.template)
        self.before = contents(self.template, scenario.ignored)

    def kill(self):
        """Kills the command when it has its last look, and cuts off the end of the log."""
        self.do(self.scenario.command, CALLS="rename", ERROR="KILL", AT=2)
        log = self.here / "m" / "looks.log"
        log.write_bytes(log.read_bytes()[:-1000])
        (log.parent / ".margin.csv.part").unlink()

    def renew(self):
        shutil.rmtree(self.here)
        shutil.copytree(self.template, self.here)

    def do(self, command, **faults):
        words = [word.format(self.here) for word in command]
        environment = dict(os.environ, OMP_NUM_THREADS="1", TMPDIR=str(self.here), **{f"FAULTS_{key}": str(faults[key]) for key in faults})
        if faults:
            environment |= {"LD_PRELOAD": str(self.library), "FAULTS_PATH": str(self.here)}
        done = subprocess.run([self.program, *words], env=environment, capture_output=True, text=True, timeout=60)
        return Ended(done.returncode, done.stdout, done.stderr)

    def whole(self):
        """Without a fault: what it ends with, its files, and how many calls of each kind it makes."""
        self.renew()
        self.log.unlink(missing_ok=True)
        ended = self.do(self.scenario.command, LOG=self.log)
        if ended.code != 0:
            sys.exit(f"{self.scenario.name}: {ended}")
        calls = [line.split(maxsplit=2) for line in self.log.read_text().splitlines()]
        return ended, contents(self.here, self.scenario.ignored), calls

    def look_at(self, ended, error, call, reference):
        """What is wrong after a fault; an empty list if nothing is."""
        whole, files, _ = reference
        path = pathlib.Path(call[1])
        no_more_of_use = call[0] == "close" and path.name == "looks.log"  # the study's files are there
        may_pass = path.is_dir() or path.name.startswith(".lock") or no_more_of_use  # no row, no number hangs on it
        faults = []
        left = contents(self.here, self.scenario.ignored)
        if error in HARMLESS or (ended.code == whole.code and may_pass):
            if (ended.code, left) != (whole.code, files):
                faults.append(f"code {ended.code}, files {sorted(left)} as if it had failed: {ended.error}")
        elif error == "KILL":
            if ended.code != -9:
                faults.append(f"it was not killed but ended with {ended.code}")
        else:
            faults += self.look_at_refusal(ended)
        parts = [name for name in left if name.endswith(".part")]
        if parts and error != "KILL":
            faults.append(f"left {parts}")
        return faults + self.look_at_rows(left, files)

    def look_at_refusal(self, ended):
        lines = ended.error.splitlines()
        faults = [] if ended.code == 4 else [f"exit code {ended.code}, not 4: {ended.error}"]
        if not lines or not all(line.startswith(("error: ", "interrupted: ", "warning: ")) for line in lines):
            faults.append(f"says {lines}")
        if not any(str(self.here) in line for line in lines):
            faults.append(f"names no place: {lines}")
        return faults

    def look_at_rows(self, left, files):
        """Rows there were before are there still, and what there is of them are the first ones."""
        faults = [f"{name} is changed" for name in self.before
                  if name not in files and left.get(name) != self.before[name] and not name.endswith("looks.log")]
        for name, log in self.before.items():  # goes on, and goes with the study's last file
            if name.endswith("looks.log") and not left.get(name, log).startswith(log[:-1000]):
                faults.append(f"{name}: its looks are not the first ones of the whole")
        for name, bytes_left in left.items():
            if name.endswith("runs.csv") and name in files:
                complete = bytes_left[:bytes_left.rfind(b"\n") + 1]
                before = self.before.get(name, b"")
                if not files[name].startswith(complete) or len(complete) < before.rfind(b"\n") + 1:
                    faults.append(f"{name}: its rows are not the first ones of the whole")
        return faults

    def look_at_going_on(self, reference):
        if contents(self.here, self.scenario.ignored) == reference[1]:
            return []  # all is there
        ended = self.do(self.scenario.again)
        left = contents(self.here, self.scenario.ignored)
        if (ended.code, left) == (reference[0].code, reference[1]):
            return []
        other = sorted(name for name in left.keys() | reference[1].keys() if left.get(name) != reference[1].get(name))
        return [f"going on: code {ended.code}, other {other}: {ended.error}"]

    def test(self):
        reference = self.whole()
        faults, count = [], 0
        stride = 1 if "WINGSPREAD_NIGHTLY" in os.environ else 4
        for offset, (kind, error, lasting) in enumerate(self.scenario.kinds):
            calls = [(call[1], call[2]) for call in reference[2] if call[1] == kind]
            for at in range(1 + offset % min(stride, max(1, len(calls))), len(calls) + 1, stride):
                self.renew()
                ended = self.do(self.scenario.command, CALLS=kind, ERROR=error, AT=at, LAST=0 if lasting else at)
                found = self.look_at(ended, error, calls[at - 1], reference) + self.look_at_going_on(reference)
                place = pathlib.Path(calls[at - 1][1]).relative_to(self.here)
                faults += [f"{self.scenario.name}: {error} at {kind} {at} ({place}): {fault}" for fault in found]
                count += 1
        return count, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--library", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("results/faults"))
    parser.add_argument("--only", help="this scenario alone")
    options = parser.parse_args()
    options.out, options.program = options.out.resolve(), options.program.resolve()
    options.library = options.library.resolve()
    scenarios = [each for each in SCENARIOS if options.only in (None, each.name)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda each: Bench(options, each).test(), scenarios))
    for scenario, (count, faults) in zip(scenarios, results):
        print(f"{scenario.name:12}{count:5} faults, {len(faults)} with something wrong")
    problems = [fault for _, faults in results for fault in faults]
    print("\n".join(problems))
    print(f"{sum(count for count, _ in results)} faults in {len(scenarios)} commands, {len(problems)} problems")
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
