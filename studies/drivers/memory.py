"""Measures the memory of each command against the number of runs.

    /usr/bin/python3 studies/drivers/memory.py            some fifteen minutes; results/memory takes 10 GB while it lasts,
                                                  and temporary files 5 GB
    /usr/bin/python3 studies/drivers/memory.py --quick    seconds; fails if memory grows too fast

Whole programs on two threads, by their peak resident memory (ru_maxrss, resident pages of mapped files included):

    run       the seed wing without friction to its last latch
    resume    the same, with the last twentieth of the rows cut off
    merge     ten shards of such runs
    replay    one of these runs
    analyze   rows with all columns of the seed campaign: the rows of a shorter run repeated under new numbers
    judge     the same with a hundred requirements on four outputs
    export    such rows to HDF5
    margin    the wing of `run` at three scales, stopped before it deploys; static margins at 21 angles of each hinge
              for each draw

Prints the figures and writes them to memory.csv in the folder.
"""

import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys

import own_folder

CAMPAIGN = pathlib.Path("studies/campaigns/seed.json")
CHEAP_SCENE = pathlib.Path("studies/scenes/three_panel.json")
CHEAP_DISPERSIONS = ("root_spring", "mid_spring", "tip_spring", "mass", "inertia")
MOST_BYTES_A_RUN = 200  # at 10⁷ runs just below 2 GiB
MOST_BYTES_A_DRAW = 1200  # of margin: up to 256 MiB it holds the margins at all places of the travel
MIB = 1024  # ru_maxrss is in KiB


# The peak of a child counts from before its exec, so it is at least the peak of the process that starts it. This small Python
# (10 MiB) starts the program, and prints its exit code, its wall time and its peak.
STARTER = """
import os, sys, time
start = time.monotonic()
process = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ,
                         file_actions=[(os.POSIX_SPAWN_OPEN, fd, os.devnull, os.O_WRONLY, 0) for fd in (1, 2)])
_, status, usage = os.wait4(process, 0)
print(os.waitstatus_to_exitcode(status), time.monotonic() - start, usage.ru_maxrss)
"""


def measure(command, *arguments):
    """Runs the program. Returns its wall time, s, and its peak memory, MiB."""
    done = subprocess.run([sys.executable, "-I", "-S", "-c", STARTER, command, *map(str, arguments)], env=os.environ | {"OMP_NUM_THREADS": "2"},
                          stdout=subprocess.PIPE, check=True)
    code, seconds, peak = done.stdout.decode().split()
    if code not in ("0", "1"):  # 1: a requirement is not met
        sys.exit(f"{command} {arguments}: exit code {code}")
    return float(seconds), int(peak) / MIB


def write_cheap_campaign(folder):
    """Writes a campaign of cheap runs, so that there can be many."""
    campaign = json.loads(CAMPAIGN.read_text())
    campaign["scene"] = json.loads(CHEAP_SCENE.read_text())
    campaign["dispersions"] = [each for each in campaign["dispersions"] if each["name"] in CHEAP_DISPERSIONS]
    campaign["outputs"] = ["latch_time", "latch_rate"]
    file = folder / "campaign.json"
    file.write_text(json.dumps(campaign))
    return file


def measure_run(program, folder, runs):
    return measure(program, "run", write_cheap_campaign(folder), "--runs", runs, "--out", folder / "run")


def measure_resume(program, folder, runs):
    measure_run(program, folder, runs)
    rows = folder / "run" / "runs.csv"
    os.truncate(rows, rows.stat().st_size * 19 // 20)
    return measure(program, "run", folder / "campaign.json", "--runs", runs, "--out", folder / "run", "--resume")


def measure_merge(program, folder, runs):
    file = write_cheap_campaign(folder)
    shards = [folder / f"shard{i}" for i in range(1, 11)]
    for i, shard in enumerate(shards, 1):
        measure(program, "run", file, "--runs", runs, "--shard", f"{i}/10", "--out", shard)
    measured = measure(program, "merge", *shards, "--out", folder / "run")
    for shard in shards:
        shutil.rmtree(shard)
    return measured


def measure_replay(program, folder, runs):
    measure_run(program, folder, runs)
    return measure(program, "replay", folder / "run", "--run", runs - 2)


def repeat_rows(source, folder, runs):
    """Writes a results folder of `runs` rows: the rows of `source` repeated under new numbers."""
    folder.mkdir()
    campaign = json.loads((source / "campaign.json").read_text())
    del campaign["wingspread"]  # no stamp, because the repeated rows are not those of the campaign's draws
    campaign["sampling"]["runs"] = runs
    (folder / "campaign.json").write_text(json.dumps(campaign))
    header, *rows = (source / "runs.csv").read_text().splitlines(keepends=True)
    rows = [row.partition(",")[2] for row in rows]
    with open(folder / "runs.csv", "w") as out:
        out.write(header)
        for first in range(0, runs, len(rows)):
            out.writelines(f"{first + i},{row}" for i, row in enumerate(rows[:runs - first]))


def measure_analyze(program, folder, runs, *options):
    source = folder / "source"
    if not source.exists():
        measure(program, "run", CAMPAIGN, "--runs", min(runs, 20000), "--out", source)
    repeated = folder / "repeated"
    repeat_rows(source, repeated, runs)
    return measure(program, "analyze", repeated, *options)


def measure_export(program, folder, runs):
    measure_analyze(program, folder, runs)
    return measure(program, "export", folder / "repeated", "--out", folder / "repeated" / "runs.h5")


def measure_judge(program, folder, runs):
    """Judges a hundred requirements, broken by one run in ten down to none."""
    requirements = [{"output": output, "max": low + (high - low) * k / 24, "probability": 0.9, "confidence": 0.9}
                    for output, low, high in (("root.peak_moment", 256, 300), ("root.latch_time", 5.12, 6),
                                              ("tip.peak_moment", 310, 600), ("mid.latch_rate", 0.9, 3))
                    for k in range(25)]
    file = folder / "requirements.json"
    file.write_text(json.dumps(requirements))
    return measure_analyze(program, folder, runs, "--requirements", file)


def measure_margin(program, folder, runs):
    file = write_cheap_campaign(folder)
    campaign = json.loads(file.read_text())
    campaign["requirements"] = [{"output": "deployed", "probability": 0.9, "confidence": 0.9}]
    campaign["integration"] = campaign.get("integration", {}) | {"t_end": 0.01}  # static margins take no run
    campaign["margin"] = {"scale": ["hinges.*.spring.torque_stowed"], "range": [0.99, 1.01], "points": 2}
    file.write_text(json.dumps(campaign))
    measured = measure(program, "margin", file, "--runs", runs, "--out", folder / "margin")
    (folder / "margin" / "margin.csv").rename(folder / "margin" / "runs.csv")  # the table shows the size of runs.csv
    return measured


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few runs; exit code 1 if memory grows too fast")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("results/memory"))
    parser.add_argument("--program", default="build/release/wingspread")
    options = parser.parse_args()
    own_folder.begin(options.out)
    run_sizes, analyze_sizes, margin_sizes = (
        ((40_000, 120_000), (40_000, 200_000), (40_000, 100_000)) if options.quick else
        ((1_000_000, 4_000_000), (1_000_000, 10_000_000), (300_000, 1_000_000)))
    table, growths = [("command", "runs", "runs.csv [MB]", "time [s]", "memory [MiB]")], []
    print("command        runs  runs.csv, MB    time, s  memory, MiB")
    for name, measured, part, sizes in (("run", measure_run, "run", run_sizes),
                                        ("resume", measure_resume, "run", run_sizes),
                                        ("merge", measure_merge, "run", run_sizes),
                                        ("replay", measure_replay, "run", run_sizes),
                                        ("analyze", measure_analyze, "repeated", analyze_sizes),
                                        ("judge", measure_judge, "repeated", analyze_sizes),
                                        ("export", measure_export, "repeated", analyze_sizes),
                                        ("margin", measure_margin, "margin", margin_sizes)):
        held = []
        for runs in sizes:
            seconds, memory = measured(options.program, options.out, runs)
            size = (options.out / part / "runs.csv").stat().st_size / 1e6
            shutil.rmtree(options.out / part)
            held.append(memory)
            table.append((name, runs, size, seconds, memory))
            print(f"{name:8}{runs:>11,}{size:>14,.0f}{seconds:>11.1f}{memory:>13.0f}", flush=True)
        growth = (held[1] - held[0]) * 2**20 / (sizes[1] - sizes[0])
        print(f"{name:8}{growth:.0f} bytes more a run")
        growths.append(growth / (MOST_BYTES_A_DRAW if name == "margin" else MOST_BYTES_A_RUN))
    with open(options.out / "memory.csv", "w", newline="") as file:
        csv.writer(file).writerows(table)
    shutil.rmtree(options.out / "source")
    sys.exit(options.quick and max(growths) > 1)


if __name__ == "__main__":
    main()
