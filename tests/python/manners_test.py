"""The Python module's manners: Ctrl-C, other threads, type stubs, docstrings. Started as python_test.py is."""

import ast
import inspect
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
import unittest

import numpy as np

import wingspread
from support import CAMPAIGN, SCENE, program
from wingspread import _native


class Manners(unittest.TestCase):
    def assert_ctrl_c_ends(self, file, *lines, within=30):
        """Interrupts a script half a second after it has begun the last of these lines."""
        script = "\n".join(["import sys, numpy, wingspread", *lines[:-1], "print('begun', flush=True)", lines[-1]])
        with subprocess.Popen([sys.executable, "-c", script, file], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            self.assertEqual(process.stdout.readline(), "begun\n")
            time.sleep(0.5)
            began = time.monotonic()
            process.send_signal(signal.SIGINT)
            _, said = process.communicate(timeout=60)
        self.assertLess(time.monotonic() - began, within)
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertTrue(said.rstrip().endswith("KeyboardInterrupt"))

    def test_ctrl_c_ends_a_long_call(self):
        self.assert_ctrl_c_ends(CAMPAIGN, "wingspread.run(sys.argv[1], runs=50_000_000)")
        self.assert_ctrl_c_ends(SCENE, "wingspread.simulate(sys.argv[1], dt=1e-6, t_end=90)")
        self.assert_ctrl_c_ends(  # few rows, which take minutes
            SCENE, "model = wingspread.Model(sys.argv[1], ['hinges.*.spring.scale'], method='runge_kutta4', step=2e-6)",
            "model(numpy.ones((200, 1)), threads=1)")

    def test_ctrl_c_does_not_wait_for_a_slow_deployment(self):
        slow = "model = wingspread.Model(sys.argv[1], ['hinges.*.spring.scale'], method='runge_kutta4', step=2e-6)"
        for rows in (1, 20):  # a row takes more than 12 s
            self.assert_ctrl_c_ends(SCENE, slow, f"model(numpy.ones(({rows}, 1)))", within=6)

    def test_python_ends_while_a_daemon_thread_computes(self):
        for call in ("wingspread.run(sys.argv[2], runs=50_000_000)",
                     "wingspread.evaluate(sys.argv[1], ['hinges.*.spring.scale'], numpy.ones((5_000_000, 1)))",
                     "[model([[1.0]]) for _ in range(10_000_000)]"):
            script = ("import sys, threading, time, numpy, wingspread\n"
                      "model = wingspread.Model(sys.argv[1], ['hinges.*.spring.scale'])\n"
                      f"threading.Thread(target=lambda: {call}, daemon=True).start()\n"
                      "time.sleep(0.5)\n")
            done = subprocess.run([sys.executable, "-c", script, SCENE, CAMPAIGN], capture_output=True, text=True,
                                  timeout=60, check=False)
            self.assertEqual((done.returncode, done.stderr), (0, ""), call)

    def test_no_path_is_refused_and_a_byte_order_mark_is_none(self):
        for odd in ("", "a\0b"):
            for call in (wingspread.run, wingspread.simulate):
                with self.assertRaisesRegex(wingspread.SpecError, "source: found .*, expected the path of a file"):
                    call(odd)
        text = pathlib.Path(SCENE).read_text()
        np.testing.assert_equal(wingspread.simulate("\ufeff" + text), wingspread.simulate(text))
        for call, argument in ((lambda: wingspread.read("a\0b"), "folder"), (lambda: wingspread.read(""), "folder"),
                               (lambda: wingspread.fit(CAMPAIGN, "{}", out="a\0b"), "out")):
            with self.assertRaisesRegex(wingspread.SpecError, f"{argument}: found .*, expected a"):
                call()

    def test_a_mistake_in_text_has_its_line(self):
        with self.assertRaisesRegex(wingspread.SpecError, "line 4"):
            wingspread.simulate('\n\n{ "name": "a",\n "x" 3 }')

    def test_a_function_that_is_called_at_the_end_of_python_may_simulate(self):
        script = ("import atexit, sys\n"
                  "atexit.register(lambda: print(len(wingspread.simulate(sys.argv[1]).trajectory)))\n"
                  "import wingspread\n")
        done = subprocess.run([sys.executable, "-c", script, SCENE], capture_output=True, text=True, timeout=60,
                              check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertGreater(int(done.stdout), 0)

    def test_a_name_with_an_equals_sign_can_be_set(self):
        text = pathlib.Path(SCENE).read_text().replace('"root"', '"ro=ot"')
        changed = wingspread.simulate(text, set={"hinges.ro=ot.spring.scale": 0.9})
        self.assertNotEqual(changed.outcome["latches"], wingspread.simulate(text).outcome["latches"])

    def test_messages_name_paths_that_are_no_utf8(self):
        with tempfile.TemporaryDirectory() as held:
            folder = os.path.join(os.fsencode(held), b"bad\xff")
            os.mkdir(folder)
            missing = os.fsdecode(os.path.join(folder, b"nope.json"))
            for call in (wingspread.run, wingspread.simulate, wingspread.read):
                with self.assertRaisesRegex(wingspread.SpecError, r"bad\\xff") as raised:
                    call(missing)
                self.assertIn("bad\\xff", raised.exception.problems[0][0])

    def test_too_little_memory_is_the_machines_refusal(self):
        script = ("import resource, sys, wingspread\n"
                  "model = wingspread.Model(sys.argv[1], ['hinges.*.spring.scale'], ['deployment_time'])\n"
                  "pages = int(open('/proc/self/statm').read().split()[0])\n"
                  "limit = pages * resource.getpagesize() + (64 << 20)\n"
                  "resource.setrlimit(resource.RLIMIT_AS, (limit, limit))\n"
                  "try:\n"
                  "    wingspread.simulate(sys.argv[1], t_end=1e5, dt=0.01)\n"
                  "except wingspread.MachineError as error:\n"
                  "    print('refused:', error)\n")
        done = subprocess.run([sys.executable, "-c", script, SCENE], capture_output=True, text=True, timeout=120)
        self.assertTrue(done.stdout.startswith("refused: "), done.stdout + done.stderr)

    def test_a_fork_computes_what_its_parent_does(self):
        script = ("import os, sys, numpy, wingspread\n"
                  "model = wingspread.Model(sys.argv[1], ['hinges.*.spring.scale'])\n"
                  "x = numpy.linspace(0.8, 1.2, 40)[:, None]\n"
                  "y = model(x, threads=2)\n"
                  "child = os.fork()\n"
                  "if child == 0: os._exit(0 if numpy.array_equal(model(x, threads=2), y, equal_nan=True) else 1)\n"
                  "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))")
        self.assertEqual(subprocess.run([sys.executable, "-c", script, SCENE], timeout=60, check=False).returncode, 0)

    def test_others_run_while_it_computes(self):
        paths = ["hinges.*.spring.scale"]
        slow = wingspread.Model(SCENE, paths, method="runge_kutta4", step=1e-4)
        for model, rows in ((slow, 4), (wingspread.Model(SCENE, paths), 2000)):  # in this thread, and in one of its own
            # The best of some, for the machine may be busy; a call that held the lock would let none have turns.
            self.assertGreater(max(self.turns_beside(model, rows) for _ in range(20)), 4)

    @staticmethod
    def turns_beside(model, rows):
        thread = threading.Thread(target=model, args=(np.linspace(0.8, 1.2, rows)[:, None],), kwargs={"threads": 1})
        thread.start()
        turns = 0
        while thread.is_alive():
            turns += 1
            time.sleep(0.001)
        return turns

    def test_what_json_cannot_say_has_its_place_in_the_dictionary(self):
        scene = json.loads(pathlib.Path(SCENE).read_text())
        scene["bodies"][0]["mass"] = float("nan")
        scene["bodies"][1]["inertia"] = np.float64("inf")
        scene["hinges"][0]["child_point"] = np.array([-0.5, np.nan])
        with self.assertRaises(wingspread.SpecError) as caught:
            wingspread.simulate(scene)
        self.assertEqual([problem[1:3] for problem in caught.exception.problems],
                         [("/bodies/0/mass", "nan"), ("/bodies/1/inertia", "inf"), ("/hinges/0/child_point/1", "nan")])
        self.assertEqual(str(caught.exception).count("expected a finite number"), 3)
        scene = json.loads(pathlib.Path(SCENE).read_text())
        expected = wingspread.simulate(scene)
        scene["bodies"][0] = types.MappingProxyType(scene["bodies"][0] | {"mass": np.longdouble(scene["bodies"][0]["mass"])})
        np.testing.assert_equal(wingspread.simulate(types.MappingProxyType(scene)), expected)
        with self.assertRaisesRegex(TypeError, "/bodies/1: found set"):
            wingspread.simulate(scene | {"bodies": [scene["bodies"][0], {1}]})

    def test_an_argument_of_another_type_is_refused_by_its_name(self):
        for name, value in (("case", 1), ("case", None), ("method", 5), ("latch", 1e-3), ("check", "yes")):
            with self.assertRaisesRegex(wingspread.SpecError, f"--{name}: found {value!r}, expected"):
                wingspread.simulate(SCENE, **{name: value})
        with self.assertRaisesRegex(wingspread.SpecError, "--case: found 1, expected a text"):
            wingspread.run(CAMPAIGN, runs=1, case=1)
        for paths in (None, 5, [5]):
            with self.assertRaisesRegex(wingspread.SpecError, "--paths: found .*, expected a list of texts"):
                wingspread.Model(SCENE, paths)

    def test_names_may_come_from_any_iterable(self):
        paths, outputs = ["hinges.*.spring.scale"], ["root.peak_moment", "tip.latch_time"]
        expected = wingspread.evaluate(SCENE, paths, [[1.0]], outputs)
        for kind in (tuple, np.array, iter, dict.fromkeys, lambda names: (name for name in names)):
            np.testing.assert_equal(wingspread.evaluate(SCENE, kind(paths), [[1.0]], kind(outputs)), expected)
        table = wingspread.run(CAMPAIGN, runs=3)
        columns = table.outputs[:2]
        np.testing.assert_equal(table.numbers(iter(columns)), table.numbers(columns))

    def test_numbers_that_are_none_are_refused(self):
        model = wingspread.Model(SCENE, ["hinges.*.spring.scale"])
        for odd in (None, "0.9", 1j, 10**400):
            with self.assertRaisesRegex(wingspread.SpecError, "--x: found"):
                model(np.array([[odd], [1.0]], dtype=object))
        np.testing.assert_equal(model(np.array([[1], [0.9]], dtype=object)), model([[1.0], [0.9]]))
        with self.assertRaisesRegex(wingspread.SpecError, "--t-end: found 1000"):
            wingspread.simulate(SCENE, t_end=10**400)

    def test_without_a_case_the_wing_is_that_of_the_program(self):
        campaign = json.loads(pathlib.Path(CAMPAIGN).read_text())
        campaign["scene"] = json.loads(pathlib.Path(SCENE).read_text())
        campaign["cases"] = [{"name": "weak", "scale": {"hinges.*.spring.scale": 0.9}}]
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "c.json")
            file.write_text(json.dumps(campaign))
            outcome = json.loads(program("simulate", file, "--json").stdout)
        self.assertEqual(wingspread.simulate(campaign).outcome, outcome)
        model = wingspread.Model(campaign, ["hinges.*.spring.scale"], ["deployment_time"])
        self.assertEqual(model([[1]])[0, 0], outcome["latches"][-1]["time"])

    def test_the_stubs_say_what_the_module_has(self):
        tree = ast.parse((pathlib.Path(wingspread.__file__).parent / "_native.pyi").read_text(encoding="utf-8"))
        stubs = {node.name: node for node in tree.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
        self.assertEqual(set(stubs), {name for name in dir(_native) if not name.startswith("_")})
        for name, node in stubs.items():
            self.check_stub(getattr(_native, name), node)

    def check_stub(self, thing, node):
        if isinstance(node, ast.FunctionDef):
            names = [argument.arg for argument in node.args.args if argument.arg != "self"]
            if isinstance(thing, property):
                return self.assertEqual(names, [])
            said = thing.__doc__.splitlines()[0]
            told = re.findall(r"[(,] *(?:self: [^,)]*(?:, )?)?([a-z_]+): ", said.split("->")[0])
            return self.assertEqual([name for name in told if name != "self"], names, said)
        if issubclass(thing, Exception):
            return None
        members = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
        public = {name for name in vars(thing) if not name.startswith("_")}
        self.assertEqual({name for name in members if not name.startswith("_")}, public)
        for name, part in members.items():
            if name != "__init__" or thing.__init__.__doc__:
                self.check_stub(inspect.getattr_static(thing, name) if name in public and isinstance(
                    inspect.getattr_static(thing, name), property) else getattr(thing, name), part)
        return None

    def test_everything_public_is_documented_and_typed(self):
        self.assertTrue((pathlib.Path(wingspread.__file__).parent / "py.typed").exists())
        self.assertEqual(f"wingspread {wingspread.__version__}", program("--version").stdout.strip())
        for name in wingspread.__all__:
            thing = getattr(wingspread, name)
            if name not in ("SpecError", "MachineError"):
                self.assertTrue(thing.__doc__, name)
            parts = [thing] if inspect.isfunction(thing) else [
                part for key, part in vars(thing).items() if inspect.isfunction(part) and not key.startswith("_")]
            for part in parts:
                self.assertTrue(part.__doc__, part)
                signature = inspect.signature(part)
                self.assertIsNot(signature.return_annotation, inspect.Signature.empty, part)
                for key, parameter in signature.parameters.items():
                    if key != "self":
                        self.assertIsNot(parameter.annotation, inspect.Parameter.empty, (part, key))


if __name__ == "__main__":
    unittest.main()
