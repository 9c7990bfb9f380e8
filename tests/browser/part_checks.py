"""What each part of the page is called and does: heads of tables, titles of axes, legends, exported columns, buttons, lists, and the words that depend on the data."""

import statistics

import pages
from number_checks import DEGREES, parsed

REQUIREMENTS = "Requirement|Verdict|Quantile or share|One-sided 90 % bound|Distance to the limit|Against the limit|Runs that break it"
OUTPUTS = "Output|Unit|Runs|Distribution|Nominal|Mean|Std|1 % quantile|Median|99 % quantile"
STATIC = "Hinge|Least, nominal|Least, 1 % quantile|Required|Nominal verdict|Verdict, 1 % quantile"
DIFFERENCES = "ambient − cold, run by run over the 2000 runs with the same random numbers"
TABLES = {  # by kind of page: the heads below each caption
    "plain": {"Requirements, the worst first": REQUIREMENTS, "Outcomes of the runs": "Outcome|Runs|Share|95 % two-sided bounds", "Latch orders": "Order|Runs|Share",
              "Numerical and statistical error of each output": "Output|Unit|Numerical, largest|Numerical, rms|Standard error of the mean",
              "Identifier, source and rationale of each requirement": "Identifier|Requirement|Source|Rationale", "Outputs of mock_wing": OUTPUTS,
              "Quantiles of root peak moment": "Quantile|Value N·m|95 % two-sided bounds", "Statistics of root peak moment": "Statistic|Value",
              "Hinges at the cursor's time": "Hinge|Angle deg|Rate deg/s|Moment N·m|State", "Least static margins": STATIC, "Most likely run of the event": "Dispersion|Value|Unit|Normal coordinate",
              "Scene of mock_wing": "Parameter|Value|Unit|In degrees|Path", "Dispersions of mock_wing": "Dispersion|Law|As written|Draw, 1 % … 99 %|Acts on",
              "Integration settings": "Setting|Value", "Meaning, unit and sign of every name": "Name|Unit|Meaning"},
    "cases": {"Verdict and distance to the limit by case": "Requirement|cold|ambient|hot", "Requirements, the worst first": REQUIREMENTS.replace("Verdict|", "Verdict|Case|"),
              "Outcomes by case, with 95 % two-sided bounds": "Case|Runs|deployed|stalled", "root peak moment by case": "Case|Nominal N·m|Mean|1 % quantile|Median|99 % quantile",
              "Between the cases and inside them: root peak moment": "Case|Mean N·m|Shift of the mean|Std inside|99 % quantile|Shift of the 99 % quantile",
              f"Differences of the means: {DIFFERENCES}": "Output|Unit|Difference|95 % bounds|Relative|Runs", f"Differences of the outcomes: {DIFFERENCES}": "Outcome|Difference|95 % bounds, percentage points",
              "Verdicts and margins side by side": "Requirement|cold|hot", "Changes of the nominal scene by case": "Parameter|Unit|Nominal|cold|ambient|hot", "Scene of cold": "Parameter|Value|Unit|In degrees|In cold|Path"},
    "odd": {"Dispersions of mock_wing": "Dispersion|Law|Unit|As written|Draw, 1 % … 99 %|In degrees|Acts on", "Outcomes of the runs": "Outcome|Runs|Share|90 % two-sided bounds"}}
ORDERS = "root › mid › tip|mid › root › tip|root › tip › mid|mid › tip › root|tip › root › mid|tip › mid › root"
PICTURES = {  # of the page "plain" in degrees, by class: titles of the axes, legend, exported columns, and the tags of the legend's samples
    "histogram": ("root peak moment (N·m)|runs in each bin", ORDERS, "from N·m|to N·m|runs|" + ORDERS, "rect"),
    "distribution": ("root peak moment (N·m)|share of the runs at or below", "runs|confidence band|quantiles with bounds", "folder|value N·m|share at or below|lower|upper", "line rect path"),
    "history": ("time (s)|moment (N·m)", "root|mid|tip", "time s|root N·m|mid N·m|tip N·m", "line"), "stage": ("", "", "time s|root deg|mid deg|tip deg", ""), "strobe": ("", "", "time s|root deg|mid deg|tip deg", ""),
    "still": ("", "", "hinge|angle deg", ""), "strips": ("latch time (s)", "", "hinge|latch times s", ""),
    "envelopes": ("root angle (deg)|root rate (deg/s)|mid angle (deg)|mid rate (deg/s)|tip angle (deg)|tip rate (deg/s)", "1 % – 99 %|5 % – 95 %|25 % – 75 %|median",
                  "time s|" + "|".join(f"{hinge} {what} {level} % {unit}" for hinge in ("root", "mid", "tip") for level in (1, 5, 25, 50, 75, 95, 99) for what, unit in (("angle", "deg"), ("rate", "deg/s"))), "rect rect rect line"),
    "tornado": ("rank correlation", "Spearman|partial (PRCC): other dispersions held", "dispersion|Spearman|lower|upper|partial (PRCC): other dispersions held|lower|upper", "rect"),
    "scatter": ("root.spring|root latch rate (deg/s)", ORDERS, "run|root.spring|root.latch_rate rad/s|latch order", "path"),
    "margin": ("scale of the springs|share of runs that meet it, logarithmic in 1 − share", "D-1: deployed, 99 % at 90 %|S-1: root.peak_moment ≤ 300 N·m, 99 % at 90 %|window",
               "scale|D-1: deployed, 99 % at 90 %|lower|upper|verdict|S-1: root.peak_moment ≤ 300 N·m, 99 % at 90 %|lower|upper|verdict", "line line rect"),
    "static-margins": ("travel from the stowed angle (deg)|static margin", "root|mid|tip", "hinge|travel deg|static margin|static margin, lower quantile|required", "line"),
    "rare": ("threshold|probability of exceeding it", "", "repeat|threshold|probability", ""), "settling": ("runs|mean (N·m)", "mean|95 % two-sided bounds", "runs|mean N·m|lower|upper", "line rect")}
NUMBERS = {"Quantile or share", "Distance to the limit", "Runs", "Share", "Std", "Mean", "Nominal", "Median", "Value", "Difference", "Relative", "95 % bounds", "Required"}  # heads of numbers, at the right like them


class PartChecks:
    """For a Page with MarkChecks and FitPageChecks."""

    def test_every_table_has_its_heads(self):
        for kind, wanted in TABLES.items():
            self.open(pages.made_up(kind))
            found = self.run_script("return [...document.querySelectorAll('table')].map(t => [t.caption.textContent, [...t.tHead.rows[0].cells].map(c => [c.textContent, c.classList.contains('number')]), [...t.tBodies[0].rows].map(r => [...r.cells].map(c => [c.tagName, c.classList.contains('number')]))])")
            heads = {caption: "|".join(text for text, _ in cells) for caption, cells, _ in reversed(found)}
            if kind == "plain":
                self.assertEqual(set(heads), set(wanted))
            for caption, cells in wanted.items():
                texts = [head for one, head, _ in found if one == caption]
                self.assertIn(cells, ["|".join(text for text, _ in head) for head in texts] if caption.startswith("Verdicts") else [heads[caption]], caption)
            for caption, cells, rows in found:
                for text, at_right in cells:
                    self.assertTrue(at_right or text not in NUMBERS or caption.startswith("Integration"), f"{text} of {caption}")
                for row in rows:
                    self.assertEqual([tag for tag, _ in row], ["TH"] + ["TD"] * (len(cells) - 1), caption)
                    self.assertEqual([at_right for _, at_right in row], [at_right for _, at_right in cells], caption)

    def test_the_inputs_stand_from_what_differs_to_what_is_the_same(self):
        self.open(pages.made_up("cases"))
        captions = self.run_script("""W.sets[1].inputs.dispersions[0].law = "uniform"; W.inputs();
            return [...document.querySelectorAll('#inputs table')].map(t => t.caption.textContent)""")
        self.assertEqual(captions, ["Changes of the nominal scene by case", "Dispersions whose law differs", "Scene of cold", "Dispersions of cold", "Integration settings"])

    def test_a_part_that_cannot_be_drawn_says_so_in_its_section_and_the_others_are_drawn(self):
        self.open(pages.made_up("loads"))
        self.run_script("W.sets.forEach(set => set.modes = { wing: set.wing, rest: set.wing.hinges.map(() => 0), modes: [{ frequency: 1, damping_ratio: 0.01, shape: set.wing.hinges.map(() => 1), base: null }] })")
        parts = self.run_script("return [...document.querySelectorAll('main > section')].map(one => one.id)")
        self.assertEqual(len(parts), 9)
        failed = self.run_script("""const section = W.section, angles = document.getElementById('angles');
            return arguments[0].map(id => { let broken = false; W.fill(section(id));
                W.section = asked => { if (asked === id && !broken) { broken = true; throw new Error(`no ${id}`); } return section(asked); };
                angles.dispatchEvent(new Event('change')); W.section = section;
                const found = [...document.querySelectorAll('main > section')].map(one => [one.id, one.textContent.match(/This part could not be drawn: .+\\./)?.[0] ?? null]).filter(one => one[1]);
                W.fill(section(id)); angles.dispatchEvent(new Event('change')); return found; })""", parts)
        self.assertEqual(failed, [[[id, f"This part could not be drawn: no {id}."]] for id in parts])
        self.assertNotIn("could not be drawn", self.page_text())
        self.assertEqual(len(self.driver.get_log("browser")), 9)  # each is told to the console as well

    def test_every_picture_has_its_titles_legend_and_columns(self):
        self.open(pages.made_up("plain"))
        for figure, (titles, legend, columns, samples) in PICTURES.items():
            got = self.run_script("""const figure = document.querySelector(`figure.${arguments[0]}`), texts = s => [...figure.querySelectorAll(s)].map(e => e.textContent).join('|');
                return [texts('.axis-text'), texts('.legend text'), [...figure.querySelectorAll('.legend > g')].map(e => e.firstChild.tagName)]""", figure)
            self.assertEqual(got[:2], [titles, legend], figure)
            tags = samples.split()
            self.assertEqual(got[2], tags if len(tags) == len(got[2]) else tags * len(got[2]), figure)
            self.assertEqual("|".join(self.copied_from(figure, 0)[0]), columns, figure)
        wing, times = self.run_script("return [W.set().wing, W.set().envelopes.latch_times]")
        for nth, key in enumerate(("stowed", "latched")):
            self.assertEqual(self.copied_from("still", nth)[1:], [[one["name"], self.run_script("return String(arguments[0] * 180 / Math.PI)", one[key])] for one in wing["hinges"]])
        self.same_rows("strips", [[hinge["name"], time] for hinge, own in zip(wing["hinges"], times) for time in own])
        bins = [(column, row) for row, column in enumerate(self.copied_from("histogram", 0)[1:])]
        histogram = self.run_script("return W.output().histogram")
        for cells, at in bins:
            self.assertEqual([float(cell) for cell in cells[2:]], [histogram["counts"][at], *(row[at] for row in histogram["by_order"])])
        self.open(pages.made_up("cases"))
        self.run_script("W.choose('split', 'case'); W.choose('output', 'root.latch_rate')")
        pages.settle(self.driver)
        heads, *rows = self.copied_from("histogram", 0)
        self.assertEqual(heads, ["case", "from deg/s", "to deg/s", "runs"])
        wanted = [[one["label"], low * DEGREES, high * DEGREES, count] for one in self.run_script("return W.sets") for output in one["outputs"] if output["name"] == "root.latch_rate"
                  for low, high, count in zip(output["histogram"]["edges"], output["histogram"]["edges"][1:], output["histogram"]["counts"])]
        for row, values in zip(rows, wanted, strict=True):
            self.numbers_of(row, values, "cases")
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.histogram .axis-text')].map(e => e.textContent)"), ["root latch rate (deg/s)", "share of the runs per deg/s"])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.histogram .legend text')].map(e => e.textContent)"), ["cold", "ambient", "hot"])
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.histogram .nominal-text')].map(e => e.textContent)"), ["nominal, cold"])
        self.run_script("W.output(W.sets[1]).missing = 3; W.choose('output', W.chosen.output)")
        pages.settle(self.driver)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('figure.histogram .axis-text')].pop().textContent"), "share of the runs with a value per deg/s")
        self.run_script("""W.choose('split', 'order'); const one = W.output(); Object.assign(W.set().requirements[0], { limit: 2.3243428, upper: true, abs: false });
            Object.assign(one, { unit: 's', nominal: null, std: 1e-6, limits: [0], histogram: { edges: d3.range(11).map(k => 2.32434 + 4e-7 * k), counts: d3.range(10).map(() => 9), by_order: [] } }); W.choose('output', one.name)""")
        pages.settle(self.driver)
        ((at,),), bins = self.places("histogram", "line.limit", "x1"), self.places("histogram", ".bin", "x")
        self.assertAlmostEqual(at, bins[7][0], delta=1)  # of a tiny spread too
        self.assertEqual(self.run_script("return document.querySelector('figure.histogram .limit-text').textContent"), "≤ 2.3243428")

    def test_numbers_as_a_table(self):
        """Below a picture, once unfolded: the exported numbers with six digits."""
        self.open(pages.made_up("plain"))
        for figure in ("rare", "strips", "still"):
            self.driver.execute_script("arguments[0].open = true", self.one(f"figure.{figure} details.numbers"))
            self.wait(lambda: self.all(f"figure.{figure} details.numbers table"))
            heads, rows = self.run_script("""const table = document.querySelector(`figure.${arguments[0]} details.numbers table`);
                return [[...table.tHead.rows[0].cells].map(c => [c.textContent, c.className]), [...table.tBodies[0].rows].map(r => [...r.cells].map(c => c.textContent))]""", figure)
            columns, *values = self.copied_from(figure, 0)
            self.assertEqual(heads, [[text, "" if text == "hinge" else "number"] for text in columns])
            for row, cells in zip(rows, values, strict=True):
                for text, cell in zip(row, cells, strict=True):
                    if cell in ("root", "mid", "tip"):
                        self.assertEqual(text, cell)
                    else:
                        self.check(text, float(cell), near=1e-5, about=figure)
            self.driver.execute_script("const one = arguments[0]; one.open = false; one.open = true", self.one(f"figure.{figure} details.numbers"))
            self.assertEqual(len(self.all(f"figure.{figure} details.numbers table")), 1)

    def click(self, element):
        self.driver.execute_script("arguments[0].click()", element)

    def put(self, selector, value, event="change"):
        self.run_script("const one = document.querySelector(arguments[0]); one.value = arguments[1]; one.dispatchEvent(new Event(arguments[2]))", selector, value, event)

    def test_buttons_and_lists_do_what_they_say(self):
        self.open(pages.made_up("cases"))
        chosen = lambda key: self.run_script("return W.chosen[arguments[0]]", key)
        pressed = lambda label: self.run_script("return [...document.querySelectorAll(`.buttons[aria-label='${arguments[0]}'] button`)].map(one => [one.textContent, one.getAttribute('aria-pressed')])", label)
        for label, key, wanted in (("Colour", "split", [("by latch order", "order"), ("by case, overlaid", "case")]), ("Probability axis", "scale", [("linear", "linear"), ("normal probability paper", "probit")])):
            for text, value in reversed(wanted):
                self.click(next(one for one in self.all(f".buttons[aria-label='{label}'] button") if one.text == text))
                self.assertEqual((chosen(key), pressed(label)), (value, [[each, str(each == text).lower()] for each, _ in wanted]))
        for at, text in enumerate(("Moment", "Angle", "Rate")):
            self.click(next(one for one in self.all(".buttons[aria-label='Show'] button") if one.text == text))
            self.assertEqual(self.run_script("return [W.player.quantity, document.querySelector('figure.history .caption').textContent.split('s of')[0]]"), [("moments", "angles", "rates")[at], text])
        self.put("#case-switch select", "2")
        self.assertEqual((chosen("set"), chosen("motion"), self.run_script("return W.set().label")), (2, 0, "hot"))
        self.assertEqual(self.run_script("return document.getElementById('spoken').textContent"), "hot shown.")
        for value in ("dark", "light", "auto"):
            self.put("#theme", value)
            self.assertEqual(self.run_script("return document.documentElement.getAttribute('data-theme')"), None if value == "auto" else value)
        name = self.run_script("return W.effectOutputs(W.set())[5]")
        self.put("#why .search select", name)
        self.assertEqual(chosen("output"), name)
        self.assertIn(self.run_script("return W.format.nameOf(W.chosen.output)"), self.one("figure.tornado .caption").text)
        self.run_script("const of = W.set().sensitivity; of.effects = [...of.effects.filter(one => one.output !== W.chosen.output), { ...of.effects[0], output: 'deployed' }]; W.why()")
        self.assertEqual(self.one("#why .search select").get_attribute("value"), name)  # though nothing moves it
        self.put("#why .search select", "deployed")  # no output: the other parts keep theirs
        self.assertEqual(chosen("output"), name)
        self.assertIn("deployed", self.one("figure.tornado .caption").text)
        self.run_script("const one = document.querySelectorAll('.choice')[2]; one.focus(); one.click()")
        self.assertEqual((chosen("motion"), self.run_script("return [document.activeElement.className, document.activeElement.getAttribute('aria-pressed'), W.player.time]")), (2, ["choice", "true", 0]))
        self.run_script("navigator.clipboard.writeText = text => { window.heard = text; return Promise.resolve(); }")
        command = self.one(".again .command")
        self.click(command.find_element("tag name", "button"))
        self.assertEqual(self.run_script("return window.heard"), command.find_element("tag name", "code").text)
        self.wait(lambda: "copied." in self.run_script("return document.getElementById('spoken').textContent"))
        self.assertEqual(command.find_element("tag name", "button").text, "Copied")
        self.wait(lambda: command.find_element("tag name", "button").text == "Copy")

    def test_a_chosen_point_is_told_with_its_own_draw_and_value(self):
        """In the words at the foot of the page, each after its own name, in the displayed unit."""
        self.open(pages.made_up("plain"))
        drawn = self.run_script("return [...document.querySelectorAll('figure.scatter')].filter(one => one.querySelector('.point')).length")  # others wait until they are in view
        self.assertGreater(drawn, 1)
        for place, pair in enumerate(self.run_script("return W.set().scatters")[:drawn]):
            points, name = pair["points"], self.run_script("return W.format.nameOf(arguments[0])", pair["output"])
            factor = self.run_script("return W.format.shown(W.format.unitOf(arguments[0])).factor", pair["output"])
            for run in (points["run"][0], points["run"][len(points["run"]) // 2], points["run"][-1]):
                self.run_script("const mark = [...document.querySelectorAll('figure.scatter')[arguments[0]].querySelectorAll('.point')].find(one => one.getAttribute('aria-label').startsWith(`run ${arguments[1]}:`)); mark.dispatchEvent(new MouseEvent('click', { bubbles: true }))", place, run)
                at, text = points["run"].index(run), self.one("#selection p").text
                for told, value in ((pair["draw"], points["x"][at]), (name, points["y"][at] * factor)):
                    self.assertIn(f" · {told} ", text)
                    number, near = parsed(text.split(f" · {told} ")[1])[0]
                    self.assertLessEqual(abs(number - value), near, f"{told} in {text}")

    def test_a_chosen_run_is_shown_and_closed(self):
        self.open(pages.made_up("loads"))
        self.click(self.one("#verdicts .findings button.run"))
        run, at = self.run_script("return [W.chosen.run.run, W.chosen.run.set]")
        first = self.run_script("return W.verdicts.judged().find(row => row.requirement.verdict === 'failed' && row.requirement.beyond)")
        self.assertEqual((run, at), (first["requirement"]["beyond_runs"][0]["run"], first["at"]))
        sets = self.run_script("return W.sets")
        known = next((place for place, one in enumerate(sets[at]["motions"]) if one["run"] == run), None)
        self.assertIn(f"Run {run} of {sets[at]['label']}" + (f" · {sets[at]['motions'][known]['label']}" if known is not None else ""), self.one("#selection").text)
        self.run_script("W.choose('set', arguments[0])", 1 - at)
        motion = sets[at]["motions"][1]
        self.run_script("W.selectRun(arguments[0], arguments[1])", at, motion["run"])
        self.assertEqual(self.one("#selection code").text, motion["replay"])
        self.click(self.all("#selection p button")[0])
        self.assertEqual(self.run_script("return [W.chosen.set, W.chosen.motion]"), [at, next(place for place, one in enumerate(sets[at]["motions"]) if one["run"] == motion["run"])])
        self.run_script("W.selectRun(arguments[0], 999999)", at)
        self.assertIn("Its motion is not on this page", self.one("#selection").text)
        self.assertEqual(self.one("#selection code").text, f"wingspread replay {sets[at]['folder']} --run 999999")
        self.click(self.all("#selection p button")[-1])
        self.assertFalse(self.one("#selection").is_displayed())
        for button in self.all("table.requirements .runs button.run")[:6]:
            number = int(button.get_attribute("textContent"))
            self.click(button)
            self.assertEqual(self.run_script("return W.chosen.run.run"), number)

    def test_the_player_by_its_list_slider_and_keys(self):
        self.open(pages.made_up("plain"))
        self.run_script("const ring = W.set().motions[0]; ring.force_peaks = [{ hinge: 1, value: 123.5, time: 2.25 }, { hinge: 2, value: 77, time: null }]; ring.events = [{ kind: 'missed', hinge: 2, time: 1.5 }]; ring.t.push(12); [ring.angles, ring.rates, ring.moments].flat().forEach(row => row.push(row[row.length - 1])); W.choose('motion', 0)")
        time = lambda: self.run_script("return W.player.time")
        end, stop, interval = self.run_script("const t = W.player.motion.t; return [t[t.length - 1], W.player.stopTime(), W.player.interval()]")
        self.assertLess(interval[1], end)
        events = self.run_script("return [...document.querySelectorAll('[aria-label=\"Go to an event\"] option')].map(one => [one.textContent, Number(one.value)])")
        self.assertIn(["tip passes its latch too fast", 1.5], events)
        self.assertIn(["peak force of mid", 2.25], events)
        self.assertEqual([text for text, _ in events if "peak force" in text], ["peak force of mid"])
        self.assertEqual([row[5] for row in self.table("Hinges at the cursor's time")], ["–", "123.5 at 2.250 s", "77.00"])
        self.run_script("W.player.play(true)")
        self.put("[aria-label='Go to an event']", "2.25")
        self.assertEqual((time(), self.run_script("return W.player.playing")), (2.25, False))
        self.run_script("W.player.play(true)")
        self.put(".scrub", "1.25", "input")
        self.assertEqual((time(), self.run_script("return W.player.playing")), (1.25, False))
        for key, want in (("ArrowRight", 1.25 + stop / 200), ("ArrowLeft", 1.25), ("Home", 1.25), (" ", 1.25)):
            self.run_script("document.querySelector('.scrub').dispatchEvent(new KeyboardEvent('keydown', { key: arguments[0], bubbles: true, cancelable: true }))", key)
            self.assertAlmostEqual(time(), want, places=9, msg=key)  # the slider has keys of its own; the player's are for the rest
            self.assertFalse(self.run_script("return W.player.playing"))
        for playing in (True, False):
            self.run_script("document.querySelector('.scrub').dispatchEvent(new KeyboardEvent('keydown', { key: 'k', bubbles: true }))")
            self.assertEqual(self.run_script("return W.player.playing"), playing)
        self.assertEqual(self.run_script("return [...document.querySelectorAll('[aria-label=Speed] option')].filter(one => one.selected).map(one => one.textContent)"), ["real time"])
        self.put("[aria-label=Speed]", "0.25")
        self.assertEqual(self.run_script("return [W.player.speed, document.querySelector('[aria-label=Speed]').selectedOptions[0].textContent]"), [0.25, "× 0.25"])
        for begun, want in ((1.0, 1.0), (interval[1], 0), (end, 0), ((interval[1] + end) / 2, (interval[1] + end) / 2)):  # at an end it begins anew
            self.run_script("W.player.seek(arguments[0]); W.player.play(true)", begun)
            now = time()
            self.assertTrue(want <= now < want + 0.25, f"{begun}: {now}")
            self.run_script("W.player.play(false)")
        self.run_script("W.player.speed = 10; W.player.seek(arguments[0]); W.player.play(true)", interval[1] - 0.3)
        self.wait(lambda: not self.run_script("return W.player.playing"))
        self.assertEqual(time(), interval[1])  # and it stops at the displayed interval's
        speed = self.driver.execute_async_script("""const done = arguments[0], P = window.wingspread.player; P.speed = 0.25; P.seek(0.5); P.play(true); let first = null;
            const look = now => { if (first === null) first = [now, P.time]; if (now - first[0] < 400) return requestAnimationFrame(look); P.play(false); done((P.time - first[1]) / (now - first[0]) * 1000); }; setTimeout(() => requestAnimationFrame(look), 100)""")
        self.assertAlmostEqual(speed / 0.25, 1, delta=0.3)
        pages.settle(self.driver)
        x = self.scale("history", "x")
        left, width = self.run_script("const box = document.querySelector('figure.history svg').getBoundingClientRect(); return [box.left, box.width / document.querySelector('figure.history svg').viewBox.baseVal.width]")
        for kind, buttons, want, at in (("pointerdown", 1, 4.9, 4.9), ("pointermove", 1, 4.7, 4.7), ("pointermove", 0, 4.8, 4.7)):
            self.run_script("document.querySelector('figure.history .catch').dispatchEvent(new PointerEvent(arguments[0], { clientX: arguments[1], buttons: arguments[2] }))", kind, left + x(want) * width, buttons)
            self.assertAlmostEqual(time(), at, places=2, msg=kind)
        self.assertTrue(parsed(self.one("output.time").text))

    def described(self, figure, nth=0):
        return self.run_script("return document.querySelectorAll(`figure.${arguments[0]} svg desc`)[arguments[1]].textContent", figure, nth)

    def test_descriptions_have_the_numbers_of_their_pictures(self):
        """What is read aloud in place of a picture; angles in the unit that is chosen."""
        self.open(pages.made_up("plain"))
        for unit, factor in (("rad", 1), ("deg", DEGREES)):
            self.run_script("W.choose('angles', arguments[0]); W.choose('output', 'root.latch_rate')", unit)
            pages.settle(self.driver)
            one_set = self.run_script("return W.set()")
            output = next(one for one in one_set["outputs"] if one["name"] == "root.latch_rate")
            spread, _, orders = self.described("histogram").partition("; by latch order: ")
            self.check(spread, output["count"], *(output[key] * factor for key in ("min", "max", "mean")), about=spread)
            by_order = [sum(counts) for counts in output["histogram"]["by_order"] if sum(counts)]
            self.assertEqual([int(parsed(part)[-1][0]) for part in orders.split(", ")][: len(by_order)], by_order)
            quantiles = [one.get("among") or one for one in output["quantiles"]]
            for part, one, given in zip(self.described("distribution").partition("band. ")[2].rstrip(".").split("; "), quantiles, output["quantiles"], strict=True):
                self.check(part.partition(": ")[0], one.get("p", given["p"]), share=True, about=part)
                self.check(part.partition(": ")[2], one["value"] * factor, about=part)
        wing, envelopes, motion = one_set["wing"], one_set["envelopes"], one_set["motions"][0]
        self.check(self.described("strobe"), 9, max(one["time"] for one in motion["latches"]), about="strobe")
        levels = envelopes["levels"]
        shares = [level for at in range(len(levels) // 2) for level in (levels[at], levels[-1 - at])]
        self.assertEqual(sorted(value for value, _ in parsed(self.described("envelopes"))), sorted(round(100 * share, 6) for share in shares))
        for part, hinge, times in zip(self.described("strips").split("; "), wing["hinges"], envelopes["latch_times"], strict=True):
            self.assertTrue(part.startswith(f"{hinge['name']}: "), part)
            self.check(part.partition(": ")[2], statistics.median(times), times[0], times[-1], about=part)
        for nth, pair in enumerate(one_set["scatters"][:2]):
            words = self.described("scatter", nth)
            self.assertIn(f"over the dispersion {pair['draw']}, ", words)
            self.check(words.partition("coefficient ")[2], round(pair["spearman"], 2), len(pair["points"]["run"]), about=words)
        for part, one in zip(self.described("static-margins").split("; "), one_set["static_margins"]["hinges"]):
            self.assertTrue(part.startswith(f"{one['hinge']}: "), part)
            self.check(part.partition("least ")[2], round(one["least"], 2), about=part)
        rare, margin = one_set["rare"], one_set["margin"]
        levels = [one for repeat in rare["levels"] for one in repeat if one["threshold"] is not None and one["probability"] > 0]
        times = DEGREES if (rare.get("beyond") or {"unit": ""})["unit"].startswith("rad") else 1
        for part, one in zip(self.described("rare").split("; "), levels, strict=True):
            self.check(part.partition("above ")[2], one["threshold"] * times, one["probability"], about=part)
        found = parsed(self.described("margin"))
        for want in (value for value in (*margin["window"], margin["recommended"]) if value is not None):
            self.assertTrue(any(abs(value - want) <= half for value, half in found), f"{want} of {found}")
