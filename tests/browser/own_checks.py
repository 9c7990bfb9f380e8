"""Pages of the program's own results: their parts, their numbers against the rows, and the kernel's runs against the program's."""

import bisect
import collections
import json
import subprocess

import pages
from number_checks import parsed


class OwnChecks:
    CAMPAIGNS = {"seed": 300, "stall": 300, "yoke_wing": 40, "satellite": 40}
    CHANGE = ("--set", "hinges.*.latch.stiffness=400")

    def test_all_of_it_is_drawn(self):
        for campaign, runs in self.CAMPAIGNS.items():
            with self.subTest(campaign=campaign):
                path = pages.real(campaign, runs)
                self.assertLess(path.stat().st_size, 5_000_000)
                self.open(path)
                self.assertNotRegex(self.page_text(), r"NaN|undefined|Infinity|could not be drawn")
                for part in ("histogram", "distribution", "stage", "history", "strobe", "envelopes", "strips", "tornado", "scatter", "settling"):
                    self.assertTrue(self.all(f"figure.{part} svg"), part)
                drawn, filled = self.run_script("""const h = W.output().histogram, left = h.counts.map((n, b) => n - h.by_order.reduce((sum, row) => sum + row[b], 0));
                    return [document.querySelectorAll('.histogram .bin').length, [...h.by_order, left].flat().filter(n => n > 0).length]""")
                self.assertEqual(drawn, filled)
                self.assertEqual(len(self.all("figure.forest svg")) > 0, campaign in ("yoke_wing", "satellite"))
                self.assertEqual(self.run_script("return W.set().runs"), runs)
                self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), 1280)

    def test_runs_that_stall_are_counted_and_shown_in_motion(self):
        self.open(pages.real("stall", 300))
        count = self.run_script("return W.set().statuses.find(one => one.status === 'stalled').count")
        self.assertGreater(count, 0)
        self.assertRegex(self.one("#verdicts").text, rf"stalled\s+{count}\b")
        choice = [one for one in self.all(".choice") if "stalled" in one.text][0]
        choice.click()
        self.run_script("W.player.seek(1e9)")
        self.assertIn("never latches", self.one(".readout").text)

    def test_numbers_of_a_satellite_s_cold_case(self):
        """Its verdicts say how many wings did not deploy and how many are beyond a limit, as its rows do."""
        folder = pages.made("satellite", 40) / "cold"
        self.open(pages.reported("cold", folder))
        self.verdict_numbers("cold")
        self.motion_numbers()
        rows = pages.rows_of(folder)
        down = [row for row in rows if row["status"] != "deployed"]
        self.assertTrue(down)
        for one in self.run_script("return W.set().requirements"):
            self.assertEqual(one["not_deployed"], len(down))
            values = [float(row[one["output"]]) for row in rows if row["status"] == "deployed" and row.get(one["output"])]
            values = [abs(value) if one["abs"] else value for value in values]
            self.assertEqual(one["beyond"], sum(value > one["limit"] for value in values) if one["limit"] is not None else 0)
            if values:
                self.assertAlmostEqual(one["worst"]["value"], max(values), delta=1e-6 * max(values))
        fewest = min(down, key=lambda row: (row["latch_order"].count(">") + bool(row["latch_order"]), int(row["run"])))
        self.assertEqual(self.run_script("return W.set().requirements[0].not_deployed_runs[0].run"), int(fewest["run"]))
        text = self.one("#verdicts").text
        self.assertIn("SYS-1", text)
        self.assertIn("power from both wings", text)
        self.assertIn("500 deg/s", text)
        for wing in ("left", "right"):  # a wing's orders, against the rows
            orders = collections.Counter(" › ".join(name.removeprefix(f"{wing}_") for name in row["latch_order"].split(">") if name.startswith(wing)) for row in rows)
            for cells in self.table(f"Wing {wing}"):
                if cells[0] in orders:
                    self.check(cells[1], orders[cells[0]], about=cells[0])

    def test_numbers_of_a_comparison(self):
        self.open(pages.compared("satellite", 40, *self.CHANGE))
        self.difference_numbers()
        data = self.run_script("return W.data")
        first = data["comparisons"][0]
        self.assertTrue(first["folders"])
        self.assertEqual([data["sets"][at]["case"] for at in first["sets"]], ["cold", "cold"])
        folders = [pages.made("satellite", 40), pages.made("satellite", 40, "satellite_changed", *self.CHANGE)]
        self.assertEqual(list(dict.fromkeys(one["made_by"] for one in data["sets"])), [f"wingspread run {folder}/campaign.json --seed 5 --runs 40 --out again{nth}" for nth, folder in zip(("", "2"), folders)])
        pairs = [[data["sets"][at]["label"] for at in reversed(one["sets"])] for one in data["comparisons"] if one["folders"]]
        rows = self.table(f"Inputs that differ: {' against '.join(pairs[0])}; the same for {' and '.join(' against '.join(pair) for pair in pairs[1:])}")
        self.assertEqual(len(rows), 1, rows)  # eight hinges changed alike
        self.assertIn("latch stiffness: left_root, left_inner", rows[0][0])
        self.check(rows[0][2], 260, about="stiffness")
        self.check(rows[0][3], 400, about="stiffness")
        beside = self.run_script("""return [...document.querySelectorAll('.side-by-side')].map(table => [...table.tBodies[0].rows].map(row => [...row.cells].map(cell => cell.textContent)))""")
        verdicts = {"passed": "pass", "failed": "fail", "open": "undecided"}
        for table, comparison in zip(beside, data["comparisons"], strict=True):
            for row in table:
                for cell, at in zip(row[1:], comparison["sets"], strict=True):
                    one = next(one for one in data["sets"][at]["requirements"] if one["id"] == row[0].split(":")[0].split(" ")[0])
                    self.assertIn(verdicts[one["verdict"]], cell)

    def wings_that_stay_held(self):
        """The page of a campaign whose runs go to their rest, for the angles there; in some a hinge is never released."""
        campaigns = pages.ROOT / "studies/campaigns"
        document = json.loads((campaigns / "seed.json").read_text())
        scene = json.loads((campaigns / document["scene"]).read_text())
        scene["hinges"][2]["release"] = {"time": 1, "fails": 0}
        document |= {"scene": scene, "outputs": ["latch_time", "final_angle", "hold_moment"]}
        document.pop("requirements", None)
        document["dispersions"].append({"name": "hang_up", "distribution": {"type": "discrete", "values": [0, 1], "weights": [2, 1]},
                                        "apply": "set", "to": [f"hinges.{scene['hinges'][2]['name']}.release.fails"]})
        path = pages.SCRATCH / "ends.json"
        path.write_text(json.dumps(document))
        return pages.reported("ends", pages.made_of(path, 12, "ends"))

    def test_any_run_in_the_page_is_the_program_s(self):
        """The kernel in the page gives the rows of runs.csv within 1e-9."""
        for campaign, count in (("seed", 12), ("yoke_wing", 3), ("satellite", 3), ("stall", 12), ("two_wing_release", 8), ("ends", 12)):
            self.open(self.wings_that_stay_held() if campaign == "ends" else pages.real(campaign, self.CAMPAIGNS.get(campaign, 12)))
            if not self.run_script("return document.getElementById('kernel')"):
                self.skipTest("the program was built without the kernel")
            one_set = self.run_script("return W.set()")
            rows = pages.rows_of(one_set["folder"])
            runs = [int(row["run"]) for row in rows if row["status"] != "deployed"][:2] + list(range(count))
            made = self.driver.execute_async_script("""const [runs, done] = arguments, W = window.wingspread, set = W.set();
                W.kernel.of(set).then(kernel => done(runs.map(run => { kernel.draw(run); const made = kernel.run([]);
                    return [made.status, made.latches.map(one => set.wing.hinges[one.hinge].name).join('>'), kernel.draws(), set.outputs.map(output => W.kernel.outputOf(set, output, made)), made.reason]; })), error => done(String(error)))""", runs)
            self.assertIsInstance(made, list, made)
            for run, (status, order, draws, outputs, reason) in zip(runs, made):
                row = rows[run]
                about = f"run {run} of {campaign}"
                self.assertEqual((status, order), (row["status"], row["latch_order"]), about)
                self.assertEqual(reason[:24], row["reason"][:24], about)  # numbers in it may differ in their last digit
                for name, draw in zip(one_set["kernel"]["draws"], draws, strict=True):
                    self.assertAlmostEqual(draw, float(row[name]), delta=1e-13 * abs(draw), msg=f"{name} of {about}")
                for output, value in zip(one_set["outputs"], outputs, strict=True):
                    recorded = float(row[output["name"]]) if row[output["name"]] else None
                    if recorded is None:
                        self.assertIsNone(value, f"{output['name']} of {about}")
                    else:
                        self.assertAlmostEqual(value, recorded, delta=1e-9 * max(1, abs(recorded)), msg=f"{output['name']} of {about}")
            if campaign == "stall":  # with friction that holds every hinge from t = 0 on
                status, times = self.driver.execute_async_script("""const done = arguments[0], W = window.wingspread, set = W.set();
                    W.kernel.of(set).then(kernel => { kernel.median(); const made = kernel.run(set.kernel.hinges.map(hinge => [hinge.friction, 1000])); done([made.status, made.t]); }, error => done([String(error), []]))""")
                self.assertEqual((status, times[0]), ("stalled", 0))
                self.assertGreater(times[-1], 0)

    def test_the_motion_of_any_run_is_the_program_s(self):
        """Every sample of the kernel in the page lies between nearby rows of the trajectory that `replay` writes."""
        for campaign, run in (("seed", 3), ("satellite", 1)):
            self.open(pages.real(campaign, self.CAMPAIGNS[campaign]))
            if not self.run_script("return document.getElementById('kernel')"):
                self.skipTest("the program was built without the kernel")
            motion = self.driver.execute_async_script("""const [run, done] = arguments, W = window.wingspread, set = W.set();
                W.kernel.of(set).then(kernel => { kernel.draw(run); done({ ...kernel.run([]), folder: set.folder, names: set.wing.hinges.map(hinge => hinge.name) }); }, error => done(String(error)))""", run)
            self.assertIsInstance(motion, dict, motion)
            file = pages.SCRATCH / f"{campaign}_{run}.csv"
            subprocess.run([pages.PROGRAM, "replay", motion["folder"], "--run", str(run), "--out", file, "--dt", "0.002"], check=True, capture_output=True)
            rows = [{name: float(value) for name, value in row.items() if value} for row in pages.table_of(file)]
            times = [row["t"] for row in rows]
            self.assertEqual(motion["t"], sorted(motion["t"]))
            self.assertGreater(len(motion["t"]), 50)
            self.assertEqual(motion["t"][0], 0)
            self.assertGreaterEqual(motion["t"][-1], motion["t_end"])  # it shows the last latch's ringing
            for hinge, name in enumerate(motion["names"]):
                for part in ("angle", "rate", "moment"):
                    column = [row[f"{name}.{part}"] for row in rows]
                    simplified = 0.02 * max(map(abs, column))  # motion.hpp leaves out samples that a picture does not need
                    values = motion[f"{part}s"][hinge]
                    self.assertEqual(len(values), len(motion["t"]))
                    for t, value in zip(motion["t"], values):
                        if t > times[-1]:  # where the campaign's run ended
                            break
                        if any(abs(t - latch["time"]) < 0.01 for latch in motion["latches"]):
                            continue  # the moment jumps
                        at = bisect.bisect_left(times, t - 1e-9)
                        near = column[max(0, at - 2) : at + 3]
                        self.assertTrue(min(near) - simplified <= value <= max(near) + simplified, f"{name}.{part} of run {run} of {campaign} at {t} s: {value} among {near}")

    def test_typed_runs_and_sliders_deploy_the_wing_anew(self):
        self.open(pages.real("seed", 300))
        if not self.run_script("return document.getElementById('kernel')"):
            self.skipTest("the program was built without the kernel")
        field = self.one(".any-run input[type=number]")
        self.driver.execute_script("arguments[0].value = 7", field)
        self.one(".show-run").click()
        caption = "Outputs of this run beside the campaign's"
        shown = lambda: self.run_script("return [...document.querySelectorAll('.any-run caption')].some(one => one.textContent === arguments[0])", caption)
        self.wait(shown)
        rows = pages.rows_of(self.run_script("return W.set().folder"))
        last = lambda: next(row for row in self.table(caption) if row[0] == "deployment time")
        self.assertLessEqual(abs(parsed(last()[2])[0][0] - float(rows[7]["deployment_time"])), 2 * parsed(last()[2])[0][1])
        self.assertIn("run 7", self.one('.choice[aria-pressed="true"]').text)
        self.driver.execute_script("const one = document.querySelector('.factor'); one.value = 0.5; one.dispatchEvent(new Event('input'))")
        self.wait(lambda: len(last()) == 7)
        before, after = (parsed(cell)[0][0] for cell in last()[2:4])
        self.assertLess(after, before)  # stronger springs deploy sooner
        self.assertIn("changed", self.one('.choice[aria-pressed="true"]').text)

    def test_the_command_beside_a_point_replays_that_run(self):
        self.open(pages.real("seed", 300))
        mark = self.all("figure.scatter .point")[7]
        self.driver.execute_script("arguments[0].dispatchEvent(new MouseEvent('click', { bubbles: true }))", mark)
        words = self.one("#selection code").text.split()
        self.assertEqual(words[:2], ["wingspread", "replay"])
        replayed = subprocess.run([pages.PROGRAM, *words[1:], "--json"], capture_output=True, text=True)
        self.assertEqual(replayed.returncode, 0, replayed.stderr)
        self.assertIn(f'"run": {words[words.index("--run") + 1]}', replayed.stdout)
