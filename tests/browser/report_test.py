"""The report page in a real browser: what is drawn against the data, what moves, what keys and clicks do, how it prints.

    /usr/bin/python3 tests/browser/report_test.py            all
    /usr/bin/python3 tests/browser/report_test.py Quick Own  what ctest runs

WINGSPREAD_PROGRAM=build/release/wingspread has its own pages looked at as well. axe-core comes from npm, into
WINGSPREAD_AXE or a folder of the build; where there is no npm that question is left out, and says so.
"""

import base64
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
try:
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    import pages
    from cause_checks import CauseChecks
    from change_checks import ChangeChecks
    from data_checks import DataChecks
    from drawing_checks import DrawingChecks
    from finding_checks import FindingChecks
    from fit_checks import FitChecks, made_fit
    from fit_page_checks import FitPageChecks
    from judgement_checks import JudgementChecks
    from mark_checks import MarkChecks
    from number_checks import NumberChecks, Numbers
    from own_checks import OwnChecks
    from part_checks import PartChecks
    from pose_checks import PoseChecks
    from rowless_checks import RowlessChecks, rowless
    from run_checks import RunChecks
    from sequence_checks import SequenceChecks
    from sequence_page_checks import SequencePageChecks
    from shape_checks import ShapeChecks
    from study_page_checks import StudyPageChecks
    from word_checks import WordChecks
except ImportError as missing:
    raise SystemExit(f"left out: {missing}")

KINDS = ("plain", "cases", "stalls", "loads", "all_failed", "single", "studies", "beside", "forty")


class Page(unittest.TestCase):
    """One browser for all tests of a class; every test ends with an empty console."""

    last_print = None  # of the made-up page "cases"

    @classmethod
    def setUpClass(cls):
        cls.driver = pages.browser()
        cls.driver.set_script_timeout(300)  # a loaded machine takes long; what hangs is still seen

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    def open(self, path, width=1280):
        pages.resize(self.driver, width)
        self.driver.get(path.as_uri())
        pages.settle(self.driver)

    def tearDown(self):
        lines = [line["message"] for line in self.driver.get_log("browser") if line["level"] in ("SEVERE", "WARNING")]
        self.assertEqual(lines, [])
        pages.media(self.driver)

    def run_script(self, script, *arguments):
        return self.driver.execute_script("const W = window.wingspread; " + script, *arguments)

    def wait(self, happened, seconds=60):
        end = time.monotonic() + seconds
        while not happened():
            self.assertLess(time.monotonic(), end, "it did not happen")

    def page_text(self, selector="main"):
        """All words of a large part of the page, as they are laid out: WebDriver's `text` asks for the style of every element."""
        return self.driver.execute_script("return document.querySelector(arguments[0]).innerText", selector)

    def printed(self):
        """The page as PDF. The last one is kept: printing takes seconds."""
        answer = self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True, "preferCSSPageSize": True})
        Page.last_print = base64.b64decode(answer["data"])
        return Page.last_print

    def all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)


class Quick(CauseChecks, StudyPageChecks, JudgementChecks, ShapeChecks, WordChecks, PartChecks, FitPageChecks, RunChecks, SequencePageChecks, PoseChecks, MarkChecks, ChangeChecks, FindingChecks, DrawingChecks, NumberChecks, Page):
    def test_histogram_has_a_mark_for_every_filled_bin_of_every_order(self):
        self.open(pages.made_up("plain"))
        for name in ("root.peak_moment", "tip.latch_time"):
            self.run_script("W.choose('output', arguments[0])", name)
            pages.settle(self.driver)
            drawn, filled, tall, sizes = self.run_script("""
                const h = W.output().histogram, bins = [...document.querySelectorAll('.histogram .bin')];
                const left = h.counts.map((n, b) => n - h.by_order.reduce((sum, row) => sum + row[b], 0));
                return [bins.length, [...h.by_order, left].flat().filter(n => n > 0).length,
                        bins.reduce((sum, bin) => sum + Number(bin.getAttribute('height')), 0), h.counts.reduce((a, b) => a + b)]""")
            self.assertEqual(drawn, filled)
            self.assertGreater(tall, 0)
            self.assertGreater(sizes, 0)

    def test_every_part_is_drawn(self):
        self.open(pages.made_up("cases"))
        for part in ("histogram", "distribution", "stage", "history", "still", "strobe", "envelopes", "strips", "tornado", "scatter", "margin", "static-margins",
                     "rare", "settling", "forest"):
            figures = self.all(f"figure.{part} svg")
            self.assertTrue(figures, part)
            marks = self.run_script("return document.querySelectorAll(arguments[0]).length", f"figure.{part} svg :is(path, rect, circle, line)")
            self.assertGreater(marks, 3, part)
        named = self.run_script("""return [...document.querySelectorAll('.picture svg')].every(svg => svg.querySelector('title').textContent && svg.querySelector('desc').textContent
                                   && !/NaN|undefined|Infinity/.test(svg.outerHTML))""")
        self.assertTrue(named)

    def test_scatter_has_its_points_and_a_click_chooses_the_run(self):
        self.open(pages.made_up("plain"))
        points = self.run_script("return W.set().scatters[0].points.run")
        marks = self.all("figure.scatter")[0].find_elements(By.CSS_SELECTOR, ".point")
        self.assertEqual(len(marks), len(points))
        self.driver.execute_script("arguments[0].dispatchEvent(new MouseEvent('click', { bubbles: true }))", marks[3])
        chosen = self.run_script("return W.chosen.run.run")
        self.assertIn(chosen, points)
        self.assertIn(f"wingspread replay results/mock --run {chosen}", self.one("#selection").text)
        self.assertTrue(self.one("#selection").is_displayed())

    def test_the_animation_moves_and_pauses(self):
        self.open(pages.made_up("plain"))
        self.run_script("W.player.seek(0)")
        pose = "return document.querySelector('.stage .pose').innerHTML"
        before = self.driver.execute_script(pose)
        self.one(".play").click()
        self.wait(lambda: self.driver.execute_script(pose) != before)
        self.assertEqual(self.one(".play").text, "Pause")
        self.one(".play").click()
        still, cursor = self.run_script("return [W.player.time, document.querySelector('.history .cursor').getAttribute('x1')]")
        self.driver.execute_async_script("setTimeout(arguments[0], 200)")
        self.assertEqual(self.run_script("return W.player.time"), still)
        self.run_script("W.player.seek(W.player.time + 1)")
        self.assertNotEqual(self.run_script("return document.querySelector('.history .cursor').getAttribute('x1')"), cursor)

    def test_the_wing_ends_up_deployed_to_scale(self):
        self.open(pages.made_up("plain"))
        wide = self.run_script("""const wing = W.set().wing, frames = W.pose.frames(wing, W.pose.deployed(wing)), points = W.pose.outlines(wing, frames).flat();
                                  return Math.max(...points.map(p => p[0])) - Math.min(...points.map(p => p[0]))""")
        self.assertAlmostEqual(wide, 0.5 + 3 * 1.01, places=6)  # the base and three panels, end to end

    def test_keys_play_step_and_go_through_lists(self):
        self.open(pages.made_up("plain"))
        player = self.one(".player")
        self.run_script("W.player.seek(1); arguments[0].focus()", player)
        player.send_keys(Keys.ARROW_RIGHT)
        self.assertGreater(self.run_script("return W.player.time"), 1)
        player.send_keys(Keys.SPACE)
        self.assertTrue(self.run_script("return W.player.playing"))
        player.send_keys(Keys.SPACE)
        self.assertFalse(self.run_script("return W.player.playing"))
        player.send_keys(Keys.HOME)
        self.assertEqual(self.run_script("return W.player.time"), 0)
        pick = self.all(".pick")[0]
        pick.send_keys(Keys.ENTER)
        first = self.run_script("return W.chosen.output")
        pick.send_keys(Keys.ARROW_DOWN)
        self.assertEqual(self.run_script("return [W.set().outputs[0].name, W.set().outputs[1].name]"), [first, self.run_script("return W.chosen.output")])
        points = self.one("figure.scatter .points")
        self.driver.execute_script("arguments[0].focus()", points)
        points.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_RIGHT, Keys.ENTER)
        self.assertIsNotNone(self.run_script("return W.chosen.run"))

    def test_a_list_of_points_tells_those_who_hear_it_which_is_current_and_which_chosen(self):
        self.open(pages.made_up("plain"))
        points = self.one("figure.scatter [role=listbox]")
        of_all = lambda name: self.run_script("return [...arguments[0].children].map(one => one.getAttribute(arguments[1]))", points, name)
        current = lambda: self.run_script("return [...arguments[0].children].findIndex(one => one.id === arguments[0].getAttribute('aria-activedescendant'))", points)
        runs = [int(label.split(":")[0].removeprefix("run ")) for label in of_all("aria-label")]
        self.assertEqual(set(of_all("role")), {"option"})
        self.assertEqual(len(set(of_all("id"))), len(runs))
        self.assertEqual(sorted(runs), sorted(self.run_script("return W.set().scatters[0].points.run")))
        self.driver.execute_script("arguments[0].focus()", points)
        for keys, at in (((Keys.ARROW_RIGHT, Keys.ARROW_RIGHT), 1), ((Keys.ARROW_UP,), 2), ((Keys.ARROW_LEFT,), 1)):
            points.send_keys(*keys)
            self.assertEqual(current(), at)
        points.send_keys(Keys.ENTER)
        self.assertEqual(self.run_script("return W.chosen.run.run"), runs[1])
        self.assertEqual([at for at, selected in enumerate(of_all("aria-selected")) if selected == "true"], [1])
        self.assertEqual(set(of_all("aria-selected")), {"true", "false"})

    def test_search_narrows_the_list(self):
        self.open(pages.made_up("plain"))
        self.one('input[type="search"]').send_keys("tip peak")
        shown = [row.text for row in self.all(".outputs tbody tr") if row.is_displayed()]
        self.assertEqual(len(shown), 1)
        self.assertIn("tip peak moment", shown[0])

    def test_cases_switch_and_overlay(self):
        self.open(pages.made_up("cases"))
        self.run_script("W.choose('set', 1)")
        pages.settle(self.driver)
        self.assertEqual(self.one("#case-switch select").get_attribute("value"), "1")
        self.assertEqual(self.one(".outputs caption").get_attribute("textContent"), "Outputs of ambient")
        self.assertIn("results/mock/ambient", self.run_script("W.choose('motion', 1); return document.querySelector('#wing .command').textContent"))
        self.run_script("W.choose('split', 'case')")
        pages.settle(self.driver)
        self.assertEqual(len(self.all(".histogram .outline")), 3)
        tall = self.run_script("return [...document.querySelectorAll('.histogram .outline')].map(path => path.getBBox().height)")
        self.assertGreater(min(tall), 60)  # outlines stand up
        self.assertEqual(len(self.all(".distribution .curve")), 3)
        dashes = {one.get_attribute("stroke-dasharray") for one in self.all(".distribution .curve")}
        self.assertEqual(len(dashes), 3)  # not by colour alone

    def test_degrees_on_request(self):
        self.open(pages.made_up("plain"))
        self.run_script("W.choose('output', 'root.latch_rate'); const s = document.getElementById('angles'); s.value = 'deg'; s.dispatchEvent(new Event('change'))")
        pages.settle(self.driver)
        self.assertIn("deg/s", self.one(".output").text)

    def test_pictures_can_be_taken_along(self):
        self.open(pages.made_up("plain"))
        pages.media(self.driver, prefers_color_scheme="dark")
        text = self.run_script("return W.standalone(document.querySelector('.histogram .picture'))")
        self.assertTrue(text.startswith("<svg"))
        self.assertNotIn("var(--", self.run_script("return [...new DOMParser().parseFromString(arguments[0], 'image/svg+xml').querySelectorAll('rect')].map(r => r.getAttribute('style') || '').join()", text))
        size = self.driver.execute_async_script("""const done = arguments[1], image = new Image(); image.onload = () => done([image.width, image.height]); image.onerror = () => done(null);
                                                   image.src = 'data:image/svg+xml;charset=utf-8,' + encodeURIComponent(arguments[0])""", text)
        self.assertGreater(size[0], 200)
        for what in ("SVG", "PNG", "Copy data"):
            self.assertEqual(len(self.all("figure")), self.run_script("return [...document.querySelectorAll('.tools button')].filter(b => b.textContent === arguments[0]).length", what), what)

    def test_buttons_save_files_and_copy_numbers(self):
        self.open(pages.made_up("plain"))
        folder = pages.SCRATCH / "saved"
        self.driver.execute_cdp_cmd("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})
        for button in self.all("figure.histogram .tools button"):
            self.driver.execute_script("arguments[0].click()", button)
        svg, png = (folder / f"histogram_root_peak_moment.{ending}" for ending in ("svg", "png"))
        self.wait(lambda: svg.exists() and png.exists() and png.stat().st_size > 0)
        self.assertTrue(svg.read_text("utf-8").startswith("<svg"))
        self.assertEqual(png.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.wait(lambda: self.run_script("return document.getElementById('spoken').textContent") != "")
        heard = self.driver.execute_async_script("""const done = arguments[0];
            const written = []; navigator.clipboard.writeText = text => { written.push(text); return Promise.resolve(); };
            document.querySelectorAll('figure.histogram .tools button')[2].click(); setTimeout(() => done(written[0]), 50)""")
        lines = heard.strip().split("\n")
        self.assertEqual(len(lines), 1 + self.run_script("return W.output().histogram.counts.length"))
        self.assertEqual(sum(float(line.split("\t")[2]) for line in lines[1:]), self.run_script("return W.output().count"))

    def test_edge_cases_are_told_in_words(self):
        for kind, words in (("all_failed", ("has a value", "No hinge latched in any run")), ("single", ("1 run", "too few runs for bounds"))):
            self.open(pages.made_up(kind))
            text = self.page_text()
            for word in words:
                self.assertIn(word, text)
            self.assertNotRegex(text, r"NaN|undefined|null|Infinity|could not be drawn")

    def test_studies_without_runs_and_beside_them(self):
        for kind in ("studies", "beside"):
            self.open(pages.made_up(kind))
            for part in ("margin", "static-margins", "rare", "tornado", "still"):
                self.assertTrue(self.all(f"figure.{part} svg"), part)
            self.assertNotIn("could not be drawn", self.page_text())
        self.assertFalse(self.one("#comparison").is_displayed())  # a study is no set to compare

    def test_no_width_overflows(self):
        for width in (360, 1280, 2560):
            self.open(pages.made_up("cases"), width)
            self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), width)

    def test_no_picture_is_cut_in_print(self):
        self.open(pages.made_up("cases"))
        before = self.run_script("return document.querySelectorAll('.picture svg').length")
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": "print"})
        self.driver.execute_script("dispatchEvent(new Event('beforeprint'))")
        pages.resize(self.driver, 695)  # px of A4 between its margins
        tall, inside, cut = self.run_script("""const figures = [...document.querySelectorAll('figure')].filter(f => f.getClientRects().length);
            return [Math.max(...figures.map(f => f.getBoundingClientRect().height)), figures.every(f => getComputedStyle(f).breakInside === 'avoid'),
                    figures.filter(f => f.getBoundingClientRect().right > 697).length]""")
        self.driver.execute_script("dispatchEvent(new Event('afterprint'))")
        self.assertLess(tall, 1000)  # 267 mm of an A4 page at 96 px an inch
        self.assertTrue(inside)
        self.assertEqual(cut, 0)
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": ""})
        self.assertTrue(37_500 < len(self.printed()) < 4_000_000)  # fills as SVG patterns took 20 MB: each is printed as an image
        self.assertGreaterEqual(self.run_script("return document.querySelectorAll('.picture svg').length"), before)

    def test_stills_in_place_of_motion_where_that_is_wanted(self):
        self.open(pages.made_up("plain"))
        pages.media(self.driver, prefers_reduced_motion="reduce")
        self.run_script("W.player.seek(0)")
        self.one(".play").click()
        self.wait(lambda: self.run_script("return W.player.time") > 0)
        steps = self.run_script("const t = W.player.motion.t; return 20 * W.player.time / t[t.length - 1]")
        self.assertAlmostEqual(steps, round(steps), places=6)  # jumps of a twentieth, two a second
        self.assertLess(steps, 8)
        self.one(".play").click()


class Own(DataChecks, OwnChecks, SequenceChecks, FitChecks, RowlessChecks, Numbers, Page):
    """The program's own pages: of the seed campaign, of a wing of which some stall, of three cases, of a satellite."""

    @classmethod
    def setUpClass(cls):
        if not pages.PROGRAM:
            raise unittest.SkipTest("WINGSPREAD_PROGRAM is not set")
        super().setUpClass()


class Everywhere(Page):
    """Every made-up page at every width, light and dark; and the program's own."""

    def paths(self):
        found = [(kind, pages.made_up(kind)) for kind in KINDS]
        if pages.PROGRAM:
            found += [(f"real {name}", pages.real(name, runs)) for name, runs in Own.CAMPAIGNS.items()]
            found += [("real fit", pages.reported("fit", made_fit())), ("real without rows", rowless())]
        return found

    def test_widths_and_themes(self):
        for kind, path in self.paths():
            for width in (360, 1280, 2560):
                for theme in ("light", "dark"):
                    with self.subTest(page=kind, width=width, theme=theme):
                        pages.media(self.driver, prefers_color_scheme=theme)
                        self.open(path, width)
                        self.assertLessEqual(self.driver.execute_script("return document.documentElement.scrollWidth"), width)
                        self.assertNotRegex(self.page_text(), r"NaN|undefined|Infinity|could not be drawn")
                        self.assertGreater(len(self.all(".picture svg")), 3)

    def test_every_output_and_every_motion_draws(self):
        for kind, path in self.paths():
            with self.subTest(page=kind):
                self.open(path)
                wrong = self.run_script("""const wrong = [];
                    W.sets.forEach((set, at) => { W.choose('set', at);
                      set.outputs.slice(0, 40).forEach(o => { W.choose('output', o.name); if (/NaN|undefined/.test(document.querySelector('main').innerHTML)) wrong.push(o.name); });
                      set.motions.forEach((m, k) => { W.choose('motion', k); W.player.seek(1e9); if (/NaN/.test(document.querySelector('#wing').innerHTML)) wrong.push(m.label); }); });
                    return wrong""")
                self.assertEqual(wrong, [])

    def test_axe_finds_no_serious_fault(self):
        script = axe()
        if not script:
            self.skipTest("axe-core cannot be had: no npm, or no network")
        for kind, path in self.paths():
            for theme in ("light", "dark"):
                with self.subTest(page=kind, theme=theme):
                    pages.media(self.driver, prefers_color_scheme=theme)
                    self.open(path)
                    self.driver.execute_script(script)
                    faults = self.driver.execute_async_script("""const done = arguments[0];
                        axe.run(document, { resultTypes: ['violations'] }).then(r => done(r.violations.map(v => [v.impact, v.id, v.nodes.length, v.nodes[0].html.slice(0, 160), v.nodes[0].failureSummary])))""")
                    self.assertEqual([fault for fault in faults if fault[0] in ("serious", "critical")], [])


def axe():
    """axe-core's text, installed from npm where it is not there yet."""
    folder = pathlib.Path(os.environ.get("WINGSPREAD_AXE", pages.ROOT / "build" / "axe"))
    file = folder / "node_modules" / "axe-core" / "axe.min.js"
    if not file.exists() and shutil.which("npm"):
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["npm", "install", "--no-save", "--no-audit", "--no-fund", "--prefix", folder, "axe-core"], capture_output=True, timeout=120)
    return file.read_text("utf-8") if file.exists() else None


if __name__ == "__main__":
    if not (pages.CHROMIUM and pages.DRIVER):
        raise SystemExit("left out: chromium and chromium-driver are not installed")
    unittest.main(verbosity=2)
