"""The recipes of studies/cluster as far as any machine can tell: GNU parallel's and Snakemake's make the folder of one process,
SLURM's get stand-ins for its commands. `studies/cluster/try` runs all of them, on a SLURM of its own.

    /usr/bin/python3 tests/ranks/recipes_test.py     from the repository's root
"""

import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(os.environ.get("WINGSPREAD_PROGRAM", "build/release/wingspread")).resolve()
RECIPES = pathlib.Path("studies/cluster").resolve()
MPIRUN = subprocess.run(["mpirun", "--version"], check=False, capture_output=True, text=True).stdout if shutil.which("mpirun") else ""
UNMET = {"requirements": [{"output": "root.peak_moment", "max": 100, "probability": 0.9, "confidence": 0.5}]}
# What the program exits with, and how each campaign differs from a good one.
CAMPAIGNS = [
    (0, {}),
    (1, UNMET | {"cases": [{"name": "nominal"}, {"name": "heavy", "distributions": {"mass": {"type": "constant", "value": 1.1}}}]}),
    (3, {"integration": {"max_steps": 430}}),  # some runs need more
]
# Stand-ins: the program notes its arguments and, if LONG is set, waits for TERM as a long run does.
STAND_INS = {
    "wingspread": """printf '%s\\n' "$@" >"$SAID"
        [ -n "$LONG" ] || exit 0
        trap 'exit 130' TERM
        echo >"$SAID.begun"
        while :; do sleep 0.01; done""",
    "mpirun": 'while [ $# -gt 0 ] && [ "$1" != wingspread ]; do shift; done; exec "$@"',
    "squeue": 'echo "$STATE"',
    "scontrol": 'echo "$@" >>"$SAID.scontrol"',
}


class Recipes(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="wingspread recipes "))
        self.addCleanup(shutil.rmtree, self.folder)

    def one_process(self, code, more):
        """Writes a campaign of 90 runs and its results by one process. @return the campaign's file"""
        campaign = json.loads(pathlib.Path("studies/campaigns/seed.json").read_text(encoding="utf-8"))
        campaign["scene"] = str(pathlib.Path("studies/scenes/three_panel_flight.json").resolve())
        campaign["sampling"]["runs"] = 90
        campaign["statistics"]["accuracy_runs"] = 0
        for key, value in more.items():
            campaign[key] = campaign.get(key, {}) | value if isinstance(value, dict) else value
        file = self.folder / f"campaign {code}.json"
        file.write_text(json.dumps(campaign), encoding="utf-8")
        run = subprocess.run([PROGRAM, "run", file, "--out", self.folder / f"one {code}"], check=False, capture_output=True)
        self.assertEqual(run.returncode, code, run.stderr)
        return file

    def assert_same(self, code, whole):
        one = self.folder / f"one {code}"
        files = {file.relative_to(one) for file in one.rglob("*") if file.is_file() and file.name != "timing.json"}
        self.assertGreater(len(files), 4)
        for name in files:
            self.assertEqual((whole / name).read_bytes(), (one / name).read_bytes(), name)

    def start(self, recipe, *options, **environment):
        """Starts a recipe of SLURM, with the stand-ins."""
        for name, text in STAND_INS.items():
            (self.folder / name).write_text(f"#!/usr/bin/env bash\n{text}\n", encoding="utf-8")
            (self.folder / name).chmod(0o755)
        said = self.folder / "said"
        variables = {"PATH": f"{self.folder}:{os.environ['PATH']}", "SAID": said, "LONG": "", "STATE": "RUNNING", "SLURM_JOB_ID": "7",
                     "SLURM_NTASKS": "8", "SLURM_CPUS_PER_TASK": "4", "SLURM_ARRAY_TASK_ID": "2",
                     "WINGSPREAD": "wingspread", "WINGSPREAD_MPI": "wingspread"} | environment
        said.unlink(missing_ok=True)
        others = {name: value for name, value in os.environ.items() if not name.startswith("WINGSPREAD_")}
        job = subprocess.Popen(["bash", RECIPES / recipe, "a campaign.json", "its results", *options],
                               env=others | variables, start_new_session=True)
        self.addCleanup(self.kill_all, job)
        return said, job

    @staticmethod
    def kill_all(job):
        """Kills a job and whatever it has started, if any of it is left."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(job.pid, signal.SIGKILL)
        job.wait()

    def words(self, recipe, *options, **environment):
        """@return the program's arguments"""
        said, job = self.start(recipe, *options, **environment)
        self.assertEqual(job.wait(timeout=30), 0)
        return said.read_text(encoding="utf-8").splitlines()

    def test_bash_reads_them(self):
        scripts = [file for file in RECIPES.iterdir() if file.read_bytes().startswith(b"#!/usr/bin/env bash")]
        self.assertGreaterEqual(len(scripts), 6)
        for script in scripts:
            read = subprocess.run(["bash", "-n", script], capture_output=True, text=True, check=False)
            self.assertEqual((read.returncode, read.stderr), (0, ""), script)

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_shards_by_parallel(self):
        for code, more in CAMPAIGNS:
            with self.subTest(code=code):
                file, results = self.one_process(code, more), self.folder / f"by {code}"
                for _ in range(2):  # the second time all is there
                    run = subprocess.run([RECIPES / "with_parallel", file, results, "4", "--jobs", "2"], check=False,
                                         capture_output=True, env=os.environ | {"WINGSPREAD": str(PROGRAM)})
                    self.assertEqual(run.returncode, code, run.stderr)
                    self.assert_same(code, results / "whole")

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_parallel_stops_at_bad_input(self):
        file = self.folder / "bad.json"
        file.write_text("{}", encoding="utf-8")
        run = subprocess.run([RECIPES / "with_parallel", file, self.folder / "by", "4"], check=False, capture_output=True,
                             env=os.environ | {"WINGSPREAD": str(PROGRAM)})
        self.assertEqual(run.returncode, 2, run.stderr)

    @unittest.skipUnless(shutil.which("snakemake"), "Snakemake is not installed")
    def test_shards_by_snakemake(self):
        for code, more in CAMPAIGNS[1:]:  # Snakemake takes seconds to begin
            with self.subTest(code=code):
                file, results = self.one_process(code, more), self.folder / f"by {code}"
                run = subprocess.run(["snakemake", "--snakefile", RECIPES / "Snakefile", "--directory", self.folder, "--cores", "2",
                                      "--config", f"campaign={file}", f"results={results}", "shards=2", f"program={PROGRAM}"],
                                     check=False, capture_output=True, text=True)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assert_same(code, results / "whole")
                self.assertTrue((results / "report.html").stat().st_size)

    def test_a_job_told_to_end_is_queued_again_and_a_cancelled_one_is_not(self):
        for recipe in ("requeue.sbatch", "mpi.sbatch"):
            for state, calls in (("RUNNING", "requeue 7\n"), ("COMPLETING", "")):
                with self.subTest(recipe=recipe, state=state):
                    said, job = self.start(recipe, LONG="yes", STATE=state)
                    begun, called = said.with_suffix(".begun"), said.with_suffix(".scontrol")
                    while not begun.exists():
                        self.assertIsNone(job.poll())
                        time.sleep(0.01)
                    begun.unlink()
                    called.write_text("", encoding="utf-8")
                    if state == "RUNNING":
                        job.send_signal(signal.SIGTERM)
                        self.assertEqual(job.wait(timeout=30), 130)
                    else:  # SLURM tells every process
                        os.killpg(job.pid, signal.SIGTERM)
                        job.wait(timeout=30)
                    self.assertEqual(called.read_text(encoding="utf-8"), calls)

    def test_mpirun_ends_before_the_time_limit(self):
        recipe = (RECIPES / "mpi.sbatch").read_text(encoding="utf-8")
        told, wait = (int(re.search(text, recipe)[1]) for text in (r"B:TERM@(\d+)", r"sigkill_timeout\D+(\d+)"))
        self.assertLess(2 * wait, 30)  # mpirun waits twice; SLURM's KillWait is 30 s
        self.assertLess(2 * wait, told)

    def test_options_reach_the_program(self):
        for recipe in ("requeue.sbatch", "mpi.sbatch", "array.sbatch"):
            words = self.words(recipe, "--until", "deployed 1%", SLURM_ARRAY_TASK_COUNT="8")
            self.assertEqual((words[:2], words[-2:]), (["run", "a campaign.json"], ["--until", "deployed 1%"]), recipe)
        for recipe in ("requeue.sbatch", "mpi.sbatch"):
            self.assertEqual(self.words(recipe, WINGSPREAD_COMMAND="margin")[0], "margin", recipe)

    def test_one_task_of_an_array_again(self):
        self.assertIn("2/8", self.words("array.sbatch", SLURM_ARRAY_TASK_COUNT="8"))
        self.assertIn("2/8", self.words("array.sbatch", SLURM_ARRAY_TASK_COUNT="1", WINGSPREAD_SHARDS="8"))

    @unittest.skipUnless("Open MPI) 4" in MPIRUN, "OpenMPI 4 is not installed")
    def test_ranks_fit_where_slurm_counts_hardware_threads(self):
        def part(kind, index, cpus, inner=""):
            sets = "".join(f' {name}="{value:#x}"' for sort, value in (("cpuset", cpus), ("nodeset", 1))
                           for name in (sort, f"complete_{sort}", f"allowed_{sort}"))
            return f'<object type="{kind}" os_index="{index}"{sets} local_memory="1000000000">{inner}</object>'

        cores = "".join(part("Core", i, 3 << 2 * i, part("PU", 2 * i, 1 << 2 * i) + part("PU", 2 * i + 1, 2 << 2 * i))
                        for i in range(16))
        topology = self.folder / "topology.xml"
        topology.write_text('<topology version="2.0">' + part("Machine", 0, 0xffffffff, part("NUMANode", 0, 0xffffffff) + cores)
                            + "</topology>", encoding="utf-8")
        host = subprocess.run(["hostname", "-s"], check=True, capture_output=True, text=True).stdout.strip()
        run = subprocess.run(
            ["bash", RECIPES / "mpi.sbatch", "campaign.json", "results"], check=False, capture_output=True, text=True, timeout=60,
            env=os.environ | {"SLURM_JOBID": "7", "SLURM_NODELIST": host, "SLURM_TASKS_PER_NODE": "8", "SLURM_NTASKS": "8",
                              "SLURM_CPUS_PER_TASK": "4", "SLURM_JOB_CPUS_PER_NODE": "32", "WINGSPREAD_MPI": "true",
                              "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                              "OMPI_MCA_hwloc_base_topo_file": str(topology), "OMPI_MCA_rmaps_base_display_map": "1",
                              "OMPI_MCA_orte_do_not_launch": "1"})
        self.assertIn("Num procs: 8", run.stdout + run.stderr)


if __name__ == "__main__":
    unittest.main()
