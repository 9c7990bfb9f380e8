"""The questions: each has a name and a function that gives commands in a folder of its own.

Wings and campaigns are those of studies/drivers, drawn by seeds; shipped ones; and some written here for what those lack.
"""

import copy
import json
import pathlib
import random

import digest
from strangers import make_scene
from strangers_campaigns import make_campaign
from strangers_lives import give_life

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Campaigns and wings by their seeds; those left out are slow or chaotic.
CAMPAIGNS = [seed for seed in range(1, 25) if seed not in (3, 5, 9, 11)]
TOLD = (2, 4, 10, 21)  # in full; of the others digests alone
WINGS = [seed for seed in range(1, 61) if seed not in (16, 22, 23, 25, 28, 50, 53)]


def shipped(path):
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


def drawn_wing(seed):
    dice = random.Random(f"wing {seed}")
    scene, _ = make_scene(dice, f"wing_{seed}")
    if seed % 3:
        give_life(dice, scene)
    return scene


def drawn_campaign(seed):
    campaign, _ = make_campaign(random.Random(f"campaign {seed}"), seed)
    campaign["sampling"]["runs"] = min(campaign["sampling"]["runs"], 40)
    return campaign


def whole(path):
    """A shipped campaign with its scene inside."""
    campaign = shipped(path)
    if isinstance(campaign["scene"], str):
        campaign["scene"] = shipped(str(pathlib.PurePath(path).parent / campaign["scene"]))
    return campaign


# ---- wings


def wings(session, seeds):
    for seed in seeds:
        session.write("wing.json", drawn_wing(seed))
        session.ask("simulate", "wing.json", "--json", "--t-end", 15)
        session.ask("modes", "wing.json", "--json")


def told_wings(session, seeds):
    """The text of single runs, of checks and of modes."""
    for seed in seeds:
        session.write("wing.json", drawn_wing(seed))
        session.ask("check", "wing.json")
        session.ask("simulate", "wing.json", "--t-end", 15, "--out", "way.csv", "--dt", 0.5)
        session.look("way.csv")
        session.ask("modes", "wing.json")


# ---- campaigns


def a_campaign(session, seed, brief):
    session.brief = brief
    campaign = drawn_campaign(seed)
    session.write("campaign.json", campaign)
    session.ask("check", "campaign.json")
    session.ask("run", "campaign.json", "--out", "results", "--all", "--histograms")
    look_at_results(session, "results")
    session.ask("analyze", "results", "--out", "again", "--quantiles", "0.05,0.3,0.8", "--confidence", 0.8, "--bins", 7)
    session.brief = True
    look_at_results(session, "again")
    session.ask("sample", "campaign.json")
    case = ["--case", campaign["cases"][1]["name"]] if "cases" in campaign else []
    folder = "results" + ("/" + case[1] if case else "")
    session.ask("replay", folder, "--run", 0, "--json")
    session.ask("simulate", "campaign.json", "--json", *case)
    session.ask("sensitivity", folder, "--all")
    session.ask("report", "results")


def look_at_results(session, folder):
    top = session.folder / folder
    for path in sorted(top.rglob("*")):
        if path.suffix in (".json", ".csv") and path.name not in ("timing.json", "campaign.json"):
            session.look(path.relative_to(session.folder))


# ---- folders


SHIPPED = ("bending_wings", "correlated", "prescribed_base", "satellite", "seed", "stall", "two_wing_free", "two_wing_release", "yoke_wing")


def shipped_campaigns(session):
    session.brief = True
    for name in SHIPPED:
        session.write("campaign.json", whole(f"studies/campaigns/{name}.json"))
        session.ask("check", "campaign.json")
        session.ask("run", "campaign.json", "--out", name, "--runs", 12, "--all")
        look_at_results(session, name)


def small_campaign(**changes):
    """The seed wing with releases of one hinge, requirements and cases."""
    campaign = whole("studies/campaigns/seed.json")
    campaign["sampling"] = {"runs": 30, "seed": 5}
    campaign["outputs"] = ["latch_time", "latch_rate", "peak_moment", "peak_force", "overtravel"]
    campaign["requirements"] = [
        {"name": "deploys", "output": "deployed", "probability": 0.8, "confidence": 0.8},
        {"name": "in time", "output": "deployment_time", "max": 8, "probability": 0.8, "confidence": 0.9, "group": "all"},
        {"name": "root holds", "output": "root.peak_moment", "max": 420, "probability": 0.9, "confidence": 0.9, "group": "all"},
        {"name": "tip latches firmly", "output": "tip.latch_rate", "abs": True, "min": "20 deg/s", "probability": 0.6, "confidence": 0.7}]
    return campaign | changes


CASES = [{"name": "ambient"}, {"name": "cold", "scale": {"hinges.*.friction.scale": 6, "hinges.*.spring.scale": 0.8}},
         {"name": "fast", "scale": {"hinges.*.spring.scale": 1.3}}]


def lives_of_folders(session):
    """Shards, previews, extensions, stops, and statistics without rows."""
    session.write("plain.json", small_campaign())
    session.write("cases.json", small_campaign(cases=CASES))
    session.ask("run", "plain.json", "--out", "whole")
    for shard in (1, 2, 3):
        session.ask("run", "plain.json", "--out", f"part{shard}", "--shard", f"{shard}/3")
        session.ask("run", "cases.json", "--out", f"cases{shard}", "--shard", f"{shard}/3")
    session.ask("merge", "part1", "part3", "--out", "merged")
    session.ask("merge", "part1", "part3", "--out", "preview", "--preview", "--table")
    session.ask("merge", "part2", "part1", "part3", "--out", "merged", "--all")
    session.ask("merge", "cases3", "cases1", "cases2", "--out", "merged_cases", "--table")
    session.ask("run", "cases.json", "--out", "one", "--case", "cold", "--table")
    session.ask("run", "plain.json", "--out", "whole", "--resume")
    session.ask("run", "plain.json", "--out", "whole", "--resume", "--runs", 60, "--all")
    session.ask("run", "plain.json", "--out", "whole", "--resume", "--runs", 50)
    session.ask("run", "plain.json", "--out", "until", "--until", "root.peak_moment 30%", "--until", "deployed 50%", "--all")
    session.ask("run", "cases.json", "--out", "rowless", "--no-rows", "--all", "--histograms")
    session.ask("run", "plain.json", "--out", "whole")
    session.write("late.json", [{"name": "later", "output": "deployment_time", "max": 9, "probability": 0.5, "confidence": 0.9},
                                {"name": "tip", "output": "tip.peak_moment", "max": 100, "probability": 0.5, "confidence": 0.9}])
    session.ask("analyze", "whole", "--requirements", "late.json", "--out", "late", "--table")
    session.ask("analyze", "merged_cases", "--requirements", "late.json", "--table")
    session.ask("analyze", "part1")
    session.ask("analyze", "rowless", "--quantiles", "0.2")
    session.brief = True
    for folder in ("whole", "merged", "preview", "merged_cases", "one", "until", "rowless", "late", "part2", "cases2"):
        look_at_results(session, folder)
    for run in (0, 7):
        session.ask("replay", "whole", "--run", run, "--scene", "run.json", "--json")
        session.look("run.json")
    session.ask("replay", "merged_cases", "--case", "cold", "--run", 3)
    session.ask("replay", "whole", "--run", 99)


def rare_events(session):
    campaign = whole("studies/examples/rare_event.json")
    session.write("campaign.json", campaign)
    session.write("cases.json", campaign | {"cases": CASES})
    session.ask("rare", "campaign.json", "--samples", 200, "--repeats", 3)
    session.ask("rare", "campaign.json", "--output", "root.peak_moment", "--above", 197, "--samples", 200, "--repeats", 3, "--out", "rare")
    session.ask("rare", "campaign.json", "--output", "root.peak_moment", "--below", "155 N*m", "--samples", 200, "--repeats", 2)
    session.ask("rare", "campaign.json", "--output", "root.peak_moment", "--above", 170, "--samples", 100, "--repeats", 2)
    session.ask("rare", "cases.json", "--case", "cold", "--output", "root.latch_time", "--above", 5, "--samples", 100, "--repeats", 2, "--json")
    session.look("rare/rare.json")
    discrete = copy.deepcopy(campaign)
    discrete["dispersions"].append({"name": "defect", "distribution": {"type": "discrete", "values": [1, 0.2], "weights": [0.9999, 0.0001]},
                                    "apply": "scale", "to": ["hinges.root.spring.scale"]})
    session.write("discrete.json", discrete)
    session.ask("rare", "discrete.json", "--samples", 200, "--repeats", 3)
    session.ask("run", "campaign.json", "--out", "results", "--runs", 20)
    session.ask("report", "results", "rare")
    session.page("results/report.html")


def margins(session):
    campaign = whole("studies/campaigns/margin.json")
    campaign["sampling"] = {"runs": 24, "seed": 3}
    for requirement in campaign["requirements"]:
        requirement |= {"probability": 0.8, "confidence": 0.8}
    session.write("campaign.json", campaign)
    session.ask("margin", "campaign.json", "--out", "joint")
    each = copy.deepcopy(campaign)
    each["margin"] = each.get("margin", {}) | {"mode": "each", "points": 7}
    session.write("each.json", each)
    session.ask("margin", "each.json", "--out", "each", "--range", 0.7, 1.6)
    session.write("cases.json", each | {"cases": CASES})
    session.ask("margin", "cases.json", "--out", "cases", "--scale", "hinges.root.spring.scale")
    session.ask("run", "campaign.json", "--out", "results", "--runs", 20)
    session.ask("report", "results", "joint", "each")
    session.page("results/report.html")
    session.brief = True
    for folder in ("joint", "each", "cases"):
        look_at_results(session, folder)


def sensitivities(session):
    session.write("campaign.json", small_campaign())
    session.write("cases.json", small_campaign(cases=CASES))
    session.ask("sensitivity", "campaign.json", "--samples", 16, "--out", "sobol", "--all", "--resamples", 50)
    session.ask("sensitivity", "cases.json", "--case", "cold", "--samples", 8, "--out", "cold", "--resamples", 50)
    for shard in (1, 2):
        session.ask("sensitivity", "campaign.json", "--samples", 16, "--out", f"part{shard}", "--resamples", 50, "--shard", f"{shard}/2")
    session.ask("merge", "part1", "part2", "--out", "merged")
    session.ask("run", "cases.json", "--out", "results")
    session.ask("sensitivity", "results/cold", "--all", "--out", "ranks", "--confidence", 0.8)
    session.ask("report", "results", "cold")
    session.page("results/report.html")
    session.brief = True
    for folder in ("sobol", "cold", "merged", "ranks"):
        look_at_results(session, folder)


def pages(session):
    """Reports of cases, of one folder, without rows, and a comparison."""
    session.write("plain.json", small_campaign())
    session.write("cases.json", small_campaign(cases=CASES, report={"title": "A title", "document": "D-1"}))
    session.write("stronger.json", small_campaign(sampling={"runs": 30, "seed": 5}, cases=CASES[:2] + [{"name": "hot", "scale": {"hinges.*.spring.scale": 1.1}}]))
    for name in ("plain", "cases", "stronger"):
        session.ask("run", f"{name}.json", "--out", name)
    session.ask("report", "plain")
    session.page("plain/report.html")
    session.ask("report", "cases")
    session.page("cases/report.html")
    session.ask("report", "cases", "stronger", "--out", "change.html")
    session.page("change.html")
    session.ask("run", "plain.json", "--out", "rowless", "--no-rows")
    session.ask("report", "rowless")
    session.page("rowless/report.html")


def random_pages(session):
    for seed in (2, 8, 10, 20, 21):
        session.write("campaign.json", drawn_campaign(seed))
        session.ask("run", "campaign.json", "--out", f"results{seed}")
        session.ask("report", f"results{seed}")
        session.page(f"results{seed}/report.html")


def fits(session):
    campaign = whole("studies/campaigns/seed.json")
    campaign["dispersions"] = [
        {"name": "spring", "distribution": {"type": "normal", "mean": 1, "std": 0.03}, "apply": "scale", "to": ["hinges.*.spring.scale"]},
        {"name": "friction", "distribution": {"type": "lognormal", "mu_log": 0, "sigma_log": 0.3}, "apply": "scale", "to": ["hinges.*.friction.scale"]}]
    campaign["sampling"] = {"runs": 50, "seed": 3}
    session.write("campaign.json", campaign)
    session.write("scene.json", campaign["scene"])
    session.ask("simulate", "scene.json", "--out", "trace.csv", "--dt", 0.25, "--set", "hinges.*.spring.scale=0.97", "--set", "hinges.*.friction.scale=1.2")
    columns = {"root.angle": {"column": "root.angle", "std": "0.3 deg", "offset_std": "0.2 deg"}, "tip.rate": {"column": "tip.rate", "std": 0.01}}
    tests = {"tests": [{"name": "ground", "trace": {"file": "trace.csv", "time": "t", "time_offset_std": "0.01 s", "columns": columns},
                        "values": [{"output": "root.latch_time", "value": "4.9 s", "std": "0.2 s"}]}],
             "fit": {"parameters": ["spring", "friction"], "starts": 4, "samples": 100}}
    session.write("tests.json", tests)
    session.ask("fit", "campaign.json", "tests.json", "--out", "fit", "--runs", 2500)
    session.ask("report", "fit")
    session.page("fit/report.html")
    session.brief = True
    look_at_results(session, "fit")
    tests["fit"]["parameters"] = ["spring", "nothing"]
    session.write("tests.json", tests)
    session.ask("fit", "campaign.json", "tests.json", "--out", "fit2")


# ---- input


def places(value, at=()):
    """Every place in a JSON document."""
    yield at
    for key, inner in value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ():
        yield from places(inner, (*at, key))


def changed(dice, value):
    """The document with one place changed: a number, a key, a text or a part of it."""
    value = copy.deepcopy(value)
    at = dice.choice([place for place in places(value) if place])
    holder = value
    for key in at[:-1]:
        holder = holder[key]
    old, key = holder[at[-1]], at[-1]
    what = dice.choice(["drop", "number", "type", "name"])
    if what == "drop":
        del holder[key]
    elif what == "name" and isinstance(key, str):
        holder[key + "s"] = holder.pop(key)
    elif what == "number" and isinstance(old, (int, float)):
        holder[key] = dice.choice([-old, 1000 * old, old / 1000, 0, 57.3 * old, 1.3 * old])
    elif isinstance(old, str):
        holder[key] = dice.choice([old + "x", "", 3, "5 parsecs"])
    else:
        holder[key] = dice.choice([None, "text", [], {}, -1, [1, 2], True])
    return value


def bad_input(session, start):
    """What `check` says of files with a mistake."""
    dice = random.Random(f"mistakes {start}")
    sources = [drawn_campaign(seed) for seed in (4, 6, 10, 14, 20, 21)] + [small_campaign(cases=CASES), whole("studies/campaigns/margin.json")]
    session.brief = True
    for _ in range(150):
        session.write("campaign.json", changed(dice, dice.choice(sources)))
        session.ask("check", "campaign.json")


def odd_scenes(session, start):
    """What `check` says of scenes with one odd number."""
    dice = random.Random(f"oddities {start}")
    session.brief = True
    for _ in range(60):
        scene = drawn_wing(dice.choice([1, 2, 4, 7, 8, 9, 11, 13, 14, 19]))
        numbers = [place for place in places(scene) if place and isinstance(value_at(scene, place), (int, float))]
        for place in dice.sample(numbers, 2):
            value_at(scene, place[:-1])[place[-1]] *= dice.choice([-1, 0, 10, 0.1, 57.3, 1e3, 1e-3])
        session.write("wing.json", scene)
        session.ask("check", "wing.json")


def value_at(value, place):
    for key in place:
        value = value[key]
    return value


def starters(session):
    session.brief = True
    for at, words in enumerate(([], ["--panels", 5, "--wings", 2, "--yoke"], ["--panels", 1, "--spring", 0.4, "--friction", 0.3],
                                ["--panels", 0], ["--panel-mass", "9 lb", "--bus-width", 2, "--harness", 0, "--damper", 0])):
        session.ask("new", *words, "--out", f"wing{at}")
        for name in ("campaign.json", "scene.json", "README.md"):
            session.look(f"wing{at}/{name}")
        session.ask("check", f"wing{at}/campaign.json", "--draw", f"wing{at}.svg")
        if (session.folder / f"wing{at}.svg").exists():
            session.lines += digest_of_drawing(session.folder / f"wing{at}.svg")


def digest_of_drawing(path):
    return ["@ " + path.name, *digest.of_page(path.read_text(encoding="utf-8"))]


def words_of_program(session):
    session.ask("--help")
    session.ask("methods")
    session.brief = True
    for name in ("new", "run", "simulate", "replay", "check", "modes", "sample", "analyze", "merge", "size", "sensitivity", "rare", "margin", "fit",
                 "report", "export", "methods", "schema", "version"):
        session.ask(name, "--help")
    session.write("wing.json", shipped("studies/scenes/three_panel.json"))
    session.ask("schema", "scene")
    session.ask("schema", "campaign")
    for method in ("dopri5", "rk4", "bulirsch_stoer", "seulex", "rosenbrock4", "nothing", "dop853", "auto"):
        session.ask("simulate", "wing.json", "--method", method, "--json")
    session.ask("simulate", "wing.json", "--check", "--t-end", 9, "--latch", "smoothed:0.01")


# ---- size


def sizes(session):
    for p in (0.5, 0.9, 0.9973, 0.999999):
        for c in (0.5, 0.9, 0.99):
            session.ask("size", "--probability", p, "--confidence", c)
            session.ask("size", "--probability", p, "--confidence", c, "--order", 3)
            session.ask("size", "--probability", p, "--confidence", c, "--two-sided")
            session.ask("size", "--probability", p, "--confidence", c, "--failures", 2)
            session.ask("size", "--probability", p, "--confidence", c, "--runs", 1234)
    for width in (0.2, 0.01):
        for share in (0.5, 0.02):
            session.ask("size", "--width", width, "--confidence", 0.9, "--proportion", share)
            session.ask("size", "--width", width, "--confidence", 0.9, "--proportion", share, "--json")


def all_questions():
    found = {"shipped": shipped_campaigns, "rare": rare_events, "margin": margins, "sensitivity": sensitivities, "pages": pages,
             "random_pages": random_pages, "folders": lives_of_folders, "fit": fits, "starters": starters, "words": words_of_program,
             "sizes": sizes, "told_wings": lambda session: told_wings(session, WINGS[::8])}
    for part in range(4):
        found[f"wings_{part}"] = lambda session, some=WINGS[part::4]: wings(session, some)
    for part in range(2):
        found[f"mistakes_{part}"] = lambda session, part=part: bad_input(session, part)
        found[f"odd_{part}"] = lambda session, part=part: odd_scenes(session, part)
    for seed in CAMPAIGNS:
        found[f"campaign_{seed}"] = lambda session, seed=seed: a_campaign(session, seed, seed not in TOLD)
    return found
