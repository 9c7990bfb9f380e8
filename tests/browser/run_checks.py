"""Any run in the page, with a kernel made up here: what the page asks of it, what it reads from its numbers, and what it shows of them."""

import base64
import gzip
import json
import random
import re

import assemble
import mock
import pages
from number_checks import parsed

HINGES = ["root", "mid", "tip"]
PLACES = [{"spring": 4, "friction": 5, "damper": 6, "latch": 7}, {"spring": 14, "friction": 15, "damper": None, "latch": 17}, {"spring": 24, "friction": 25, "damper": None, "latch": None}]
DRAWS = {"root.spring": (0.9, 0.92, 1.08), "tip.spring": (1.0625, 0.92, 1.08), "heat": (21.5, None, None)}  # value, and 1 % … 99 % of the law
NUMBERS = [1.5, "Infinity", -2]

# The kernel's functions over a memory of its own; `said` has what the page asks, `made[run]` is what it gives: "run" or "run with changes".
FAKE = """const [made, done] = arguments, buffer = new ArrayBuffer(1 << 22), said = window.said = [];
    const put = (at, values) => (new Float64Array(buffer, at, values.length).set(values), at), read = (at, count) => [...new Float64Array(buffer, at, count)];
    let run = null, filled = 0, now = null;
    const exports = { memory: { buffer }, _initialize: () => said.push("initialize"), input: count => (filled = count, 8), open: () => said.push(["open", ...read(8, filled)]),
        draws: () => put(4096, made.draws), draw_count: () => made.draws.length, draw: at => { if (at === 266) throw new Error("no such run"); run = at; said.push(["draw", at]); }, median: () => { run = "nominal"; said.push("median"); },
        run: count => { const changes = read(8, 2 * count); said.push(["run", ...changes]); now = made[count ? `${run} changed` : run] ?? made.other; },
        result: () => put(8192, now.result), result_count: () => now.result.length, samples: () => put(1 << 20, now.samples), sample_count: () => now.samples.length,
        reason: () => (new Uint8Array(buffer, 65536, 99).set(new TextEncoder().encode(now.reason)), 65536), reason_count: () => now.reason.length };
    WebAssembly.compile = async bytes => { said.push(new TextDecoder().decode(bytes)); return {}; };
    WebAssembly.Module.imports = () => [{ module: "wasi", name: "fd_write" }, { module: "wasi", name: "proc_exit" }];
    WebAssembly.instantiate = async (of, imports) => { said.push(imports.wasi.fd_write()); try { imports.wasi.proc_exit(); } catch (error) { said.push(error.message); } return { exports }; };
    done();"""


def outcome(seed, status, reason, latches, events, final=3, samples=5):
    """An outcome, and the numbers as kernel.cpp writes them: latches (hinge, time), events (kind, hinge, time)."""
    rng = random.Random(seed)
    number = lambda: round(rng.uniform(0.5, 9), 3)
    one = {"status": status, "reason": reason, "t_end": 12.25, "latches": [{"hinge": h, "time": t, "rates": [-number() for _ in HINGES]} for h, t in latches],
           "each": [dict(zip(("peak_moment", "time", "peak_force", "overtravel", "hold_moment", "final_angle", "motor_energy"), [number() for _ in range(7)])) for _ in HINGES],
           "final": final, "base": {"peak_angle": number(), "peak_rate": number()}, "events": events, "rows": [[0.25 * k, *(number() for _ in range(9)), *(number() for _ in range(3))] for k in range(samples)]}
    result = [["deployed", "stalled", "timed_out", "invalid", "failed"].index(status), one["t_end"], final, len(latches)]
    for latch in one["latches"]:
        result += [latch["hinge"], latch["time"], *latch["rates"]]
    for each in one["each"]:
        result += each.values()
    result += one["base"].values()
    for kind in ("released", "missed", "let_go"):
        own = [(h, t) for which, h, t in events if which == kind]
        result += [len(own), *(value for pair in own for value in pair)]
    return one, {"result": result, "samples": [value for row in one["rows"] for value in row], "reason": reason}


RUNS = {"7": outcome(7, "timed_out", "still moving", [(0, 3.5), (1, 4.5), (0, 6.5)], [("released", 2, 1.5), ("missed", 1, 4.25), ("let_go", 0, 5.5)]),
        "7 changed": outcome(8, "deployed", "", [(2, 2.5), (0, 3.25), (1, 4.5)], [("let_go", 2, 3)]),
        "nominal": outcome(9, "deployed", "", [(2, 2.5), (0, 3.25), (1, 4.5)], []), "8": outcome(12, "deployed", "", [(2, 2.5), (0, 3.25), (1, 4.5)], [], 2), "9": outcome(13, "deployed", "", [(2, 2.5), (0, 3.25), (1, 4.5)], [], 1),
        "nominal changed": outcome(10, "deployed", "", [(2, 2.5)], []), "other": outcome(11, "invalid", "no value", [(2, 2.5)], []), "10": outcome(14, "invalid", "without mass", [], [], 3, 0)}


def value_of(one, name):
    """An output of an outcome by its column's name (None: it did not happen)."""
    holds = lambda hinge: (latches := [each for each in one["latches"] if each["hinge"] == hinge]) and latches[len(latches) - 1] if \
        sum(kind == "let_go" and at == hinge for kind, at, _ in one["events"]) < sum(each["hinge"] == hinge for each in one["latches"]) else None
    ended = one["status"] not in ("invalid", "failed")
    if name == "deployment_time":
        return max(each["time"] for each in one["latches"]) if one["status"] == "deployed" else None
    if name.startswith("base."):
        return one["base"][name[5:]]
    owner, _, quantity = name.partition(".")
    hinge = HINGES.index(owner)
    held = holds(hinge)
    if quantity.startswith("rate_at."):
        then = holds(HINGES.index(quantity[8:]))
        return then["rates"][hinge] if then else None
    if quantity in ("captures", "held"):
        return (sum(each["hinge"] == hinge for each in one["latches"]) if quantity == "captures" else int(bool(held))) if ended else None
    if quantity in ("latch_time", "latch_rate"):
        return (held["time"] if quantity == "latch_time" else held["rates"][hinge]) if held else None
    return one["each"][hinge][quantity]


class RunChecks:
    """For a Page with Numbers."""

    def opened(self):
        path = pages.SCRATCH / "kernel.html"
        if not path.exists():
            block = mock.block([mock.make_set("mock_wing", 1, count=300)])
            one = block["sets"][0]
            one["outputs"].append({**one["outputs"][0], "name": "panel_1.peak_bending_moment", "hinge": "panel_1", "family": "peak_bending_moment"})  # not in the kernel
            next(each for each in one["outputs"] if each["name"] == "tip.latch_rate")["count"] = 0
            one["kernel"] = {"numbers": NUMBERS, "draws": list(DRAWS), "hinges": PLACES}
            packed = base64.b64encode(gzip.compress(b"the kernel", mtime=0)).decode()
            path.write_text(assemble.page(json.dumps(block)).replace('<script type="application/json"', f'<script type="application/octet-stream" id="kernel">\n{packed}\n</script><script type="application/json"', 1), "utf-8")
        self.open(path)
        self.driver.execute_async_script(FAKE, {**{run: numbers for run, (_, numbers) in RUNS.items()}, "draws": [value for value, *_ in DRAWS.values()]})

    def asked(self, button, caption="Outputs of this run beside the campaign's"):
        """What the page asks of the kernel after a click; and the heads and rows of the outputs' table."""
        self.run_script("window.said.length = 0; [...document.querySelectorAll('.any-run tbody')].forEach(one => one.remove())")
        self.driver.execute_script("arguments[0].click()", self.one(button))
        return self.shown(caption)

    def shown(self, caption="Outputs of this run beside the campaign's"):
        self.wait(lambda: self.run_script("return document.querySelectorAll('.any-run tbody').length") == 2)
        heads = self.run_script("return [...[...document.querySelectorAll('.any-run table')].find(one => one.caption.textContent === arguments[0]).tHead.rows[0].cells].map(one => one.textContent)", caption)
        return self.run_script("return window.said"), heads, self.table(caption)

    def test_outputs_of_a_kernels_outcome(self):
        """By every name of a column, of runs that end in every way."""
        self.opened()
        names = ["deployment_time", "base.peak_angle", "base.peak_rate"] + [f"{hinge}.{quantity}" for hinge in HINGES for quantity in (
            "latch_time", "latch_rate", "captures", "held", "peak_moment", "peak_force", "overtravel", "hold_moment", "final_angle", "motor_energy", *(f"rate_at.{other}" for other in HINGES))]
        outputs = [{"name": name, "hinge": None if name.split(".")[0] not in HINGES else name.split(".")[0], "family": name.split(".")[-1] if ".rate_at." not in name else "rate_at"} for name in names]
        for run, (one, _) in RUNS.items():
            if "changed" in run:
                continue
            made, got = self.driver.execute_async_script("""const [run, outputs, done] = arguments, W = window.wingspread;
                W.kernel.of(W.set()).then(kernel => { run === "nominal" ? kernel.median() : kernel.draw(run); const made = kernel.run([]); done([made, outputs.map(output => W.kernel.outputOf(W.set(), output, made))]); })""",
                                                         int(run) if run.isdigit() else 1 if run == "other" else run, outputs)
            for name, value in zip(names, got, strict=True):
                self.assertEqual(value, value_of(one, name), f"{name} of {run}")
            self.assertEqual([made[key] for key in ("status", "reason", "t_end", "latches", "base", "t")], [one[key] for key in ("status", "reason", "t_end", "latches", "base")] + [[row[0] for row in one["rows"]]])
            self.assertEqual(sorted((each["kind"], each["hinge"], each["time"]) for each in made["events"]), sorted(one["events"]))
            for first, key in ((1, "angles"), (4, "rates"), (7, "moments")):
                self.assertEqual(made[key], [[row[first + hinge] for row in one["rows"]] for hinge in range(3)], key)
            self.assertEqual(made["moved"], {key: [row[at] for row in one["rows"]] for at, key in ((10, "x"), (11, "y"), (12, "angle"))})

    def outputs_table(self, heads, rows, label, plain, changed):
        """Values without and with changes beside the campaign's, by output; limits by the values with changes."""
        one_set = self.run_script("return W.set()")
        listed = [each for each in one_set["outputs"][:-1] if each["count"] or value_of(changed or plain, each["name"]) is not None]
        self.assertEqual(heads, ["Output", "Unit", label, *(["with changes"] if changed else []), "Mean of the campaign", "1 % … 99 % of the runs", "Limit"])
        self.assertEqual([row[0] for row in rows], [one["name"].replace(".", " ").replace("_", " ") for one in listed])
        for row, output in zip(rows, listed, strict=True):
            factor, name = self.factor(output, "deg"), output["name"]
            self.assertEqual(row[1], output["unit"].replace("rad", "deg").replace(" ", "·"), name)
            values = [value_of(one, name) for one in (plain, changed) if one]
            for cell, value in zip(row[2:], values):
                self.assertEqual(cell == "did not happen", value is None, name)
                self.check(cell, None if value is None else value * factor, about=name)
            self.check(row[2 + len(values)], output["mean"] * factor, about=name)
            self.check(row[3 + len(values)], output["quantiles"][0]["value"] * factor, output["quantiles"][-1]["value"] * factor, about=name)
            limits = [one_set["requirements"][at] for at in output["limits"]]
            made = changed or plain
            kept = [made["status"] == "deployed" and values[-1] is not None and (1 if one["upper"] else -1) * ((abs(values[-1]) if one.get("abs") else values[-1]) - one["limit"]) <= 0 for one in limits]
            final = {"peak_moment": made["final"] & 1, "peak_force": made["final"] & 2}.get(output["family"], 1)
            self.assertEqual(re.findall("pass|fail|undecided", row[-1]), [("pass" if final else "undecided") if each else "fail" for each in kept], f"{name}: {row[-1]}")
            self.assertEqual([sign for sign in row[-1] if sign in "≤≥"], ["≤" if one["upper"] else "≥" for one in limits], name)

    def test_any_run_and_any_factor_are_asked_of_the_kernel(self):
        self.opened()
        motions = self.run_script("return W.set().motions.length")
        field = self.one(".any-run input[type=number]")
        for typed in ("7.9", "-1", "", "300"):
            self.driver.execute_script("arguments[0].value = arguments[1]", field, typed)
            self.driver.execute_script("window.said.length = 0; arguments[0].click()", self.one(".show-run"))
            self.assertEqual(self.one(".any-run [aria-live]").text, "The campaign has the runs 0 to 299.", typed)
            self.assertEqual(self.run_script("return window.said"), [])
        self.driver.execute_script("arguments[0].value = '7'", field)
        said, heads, rows = self.asked(".show-run")
        self.assertEqual(said, ["the kernel", 0, "the kernel ended", "initialize", ["open", 1.5, None, -2], ["draw", 7], ["run"]])
        self.outputs_table(heads, rows, "run 7", RUNS["7"][0], None)
        told = lambda: self.run_script("return document.querySelector('.any-run [aria-live] p').textContent")
        self.assertEqual(told(), "Run 7: timed out, still moving · computed in this page. It did not deploy, so it breaks every requirement.")
        wanted = [[name, value, low, high] for name, (value, low, high) in DRAWS.items()]
        for row, (name, value, low, high) in zip(self.table("Draws of this run"), wanted, strict=True):
            self.assertEqual(row[0], name)
            self.check(row[1], value, about=name)
            self.check(row[2], low, high, about=name)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('.any-run details')].map(one => [one.querySelector('summary').textContent, [...one.querySelectorAll('th[scope=col]')].map(head => head.textContent)])"),
                         [["Draws of this run: 3", ["Dispersion", "Value", "1 % … 99 %"]]])
        self.motion("7", "run 7", "computed in this page", 7, f"wingspread replay {self.run_script('return W.set().folder')} --run 7")
        sliders = {one.get_attribute("aria-label"): one for one in self.all(".any-run .factor")}
        self.assertEqual(list(sliders), [f"Factor of {part}" for part in ("spring", "friction", "damper", "latch")])
        slide = lambda part, value: self.driver.execute_script("window.said.length = 0; document.querySelectorAll('.any-run tbody').forEach(one => one.remove()); arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))",
                                                               sliders[f"Factor of {part}"], value)
        words = lambda part: self.run_script("return [arguments[0].parentNode.querySelector('output').textContent, arguments[0].getAttribute('aria-valuetext')]", sliders[f"Factor of {part}"])
        self.assertEqual(words("spring"), ["× 1.00", "1.00 times"])
        slide("spring", 0.5)
        said, heads, rows = self.shown()
        self.assertEqual(said, [["draw", 7], ["run", 4, 1.414, 14, 1.414, 24, 1.414]])
        self.assertEqual(words("spring"), ["× 1.41", "1.41 times"])
        self.outputs_table(heads, rows, "run 7", RUNS["7"][0], RUNS["7 changed"][0])
        self.assertEqual(told(), "Run 7: deployed · spring × 1.41, all hinges.")
        self.motion("7 changed", "run 7, changed", "spring × 1.41, all hinges", 7, None)
        slide("damper", -1)
        self.assertEqual(self.shown()[0], [["draw", 7], ["run", 4, 1.414, 6, 0.5, 14, 1.414, 24, 1.414]])
        choose = "window.said.length = 0; document.querySelectorAll('.any-run tbody').forEach(one => one.remove()); const one = document.querySelector('.any-run select'); one.value = arguments[0]; one.dispatchEvent(new Event('change'))"
        self.assertEqual(self.run_script("return [...document.querySelectorAll('.any-run select option')].map(one => [one.value, one.textContent, one.selected])"),
                         [["all", "all hinges", True], *([str(at), name, False] for at, name in enumerate(HINGES))])
        self.driver.execute_script(choose, "1")
        self.assertEqual(self.shown()[0], [["draw", 7], ["run", 14, 1.414]])
        self.assertEqual(told(), "Run 7: deployed · spring × 1.41, damper × 0.50, mid.")
        self.driver.execute_script(choose, "0")
        self.assertEqual(self.shown()[0], [["draw", 7], ["run", 4, 1.414, 6, 0.5]])
        said, heads, rows = self.asked(".show-nominal")
        self.assertEqual(said, ["median", ["run"], ["run", 4, 1.414, 6, 0.5]])
        self.outputs_table(heads, rows, "nominal wing", RUNS["nominal"][0], RUNS["nominal changed"][0])
        self.assertTrue(told().startswith("Nominal wing: deployed · "))
        said, _, _ = self.asked(".any-run button:last-of-type")  # Reset
        self.assertEqual(said, ["median"])
        self.motion("nominal", "nominal wing", "computed in this page", None, None)
        self.assertEqual([words(part)[0] for part in ("spring", "damper")], ["× 1.00", "× 1.00"])
        self.assertEqual(self.run_script("return W.set().motions.length"), motions + 1)  # the one before made room
        self.driver.execute_script("arguments[0].value = '10'", field)
        self.asked(".show-run")
        self.assertIn("Run 10: invalid, without mass", told())
        self.run_script("W.wing()")  # an invalid wing has no motion to show: that of the run before stays
        self.assertEqual(self.run_script("return [W.set().motions.length, W.set().motions.every(one => one.t.length)]"), [motions + 1, True])

    def test_a_peak_that_the_end_cuts_shows_no_limit(self):
        """Of moments or of forces; a requirement that the page cannot compute is named."""
        self.opened()
        self.run_script("W.set().requirements.forEach(one => { if (one.output.endsWith('peak_moment')) Object.assign(one, { limit: 1000, abs: true }); })")
        self.run_script("W.set().requirements.push({ ...W.set().requirements[0], id: '', name: 'F-1', output: 'mode_1.frequency' })")
        for run in ("8", "9"):
            self.driver.execute_script("arguments[0].value = arguments[1]", self.one(".any-run input[type=number]"), run)
            _, heads, rows = self.asked(".show-run")
            self.outputs_table(heads, rows, f"run {run}", RUNS[run][0], None)
            cell = next(row[-1] for row in rows if row[0] == "root peak moment")
            self.assertIn("undecided" if run == "8" else "pass", cell)
            self.assertIn("|·| ≤ 1000", cell)
        self.assertTrue(self.one(".any-run [aria-live] p").text.endswith("Not computed here: F-1."))

    def test_a_run_that_the_kernel_cannot_make_says_so(self):
        self.opened()
        self.driver.execute_script("arguments[0].value = 266", self.one(".any-run input[type=number]"))
        self.driver.execute_script("arguments[0].click()", self.one(".show-run"))
        self.wait(lambda: self.one(".any-run [aria-live]").text)
        self.assertEqual(self.one(".any-run [aria-live] p.nothing").text, "The run could not be computed: no such run.")
        self.assertIn("no such run", " ".join(line["message"] for line in self.driver.get_log("browser")))  # and is written to the console

    def motion(self, run, label, why, number, replay):
        """The outcome is the page's last motion, and is shown."""
        one = RUNS[run][0]
        got, chosen, count = self.run_script("return [W.set().motions[W.set().motions.length - 1], W.chosen.motion, W.set().motions.length]")
        self.assertEqual(chosen, count - 1)
        self.assertEqual([got[key] for key in ("computed", "label", "why", "run", "status", "reason", "replay", "base")], [True, label, why, number, one["status"], one["reason"], replay, None])
        for first, key in ((1, "angles"), (4, "rates"), (7, "moments")):
            self.assertEqual(got[key], [[row[first + hinge] for row in one["rows"]] for hinge in range(3)], key)
        self.assertEqual([(each["hinge"], each["value"], each["time"]) for each in got["peaks"]], [(at, each["peak_moment"], each["time"]) for at, each in enumerate(one["each"])])
        self.assertEqual([(each["hinge"], each["value"], each["time"]) for each in got["force_peaks"]], [(at, each["peak_force"], None) for at, each in enumerate(one["each"])])
        self.assertIn(label, self.one('.choice[aria-pressed="true"]').text)
        for row, each in zip(self.table("Hinges at the cursor's time"), one["each"], strict=True):
            self.assertAlmostEqual(parsed(row[5])[0][0], each["peak_force"], places=3)
