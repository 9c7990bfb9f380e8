"""Looks for a peak that runs of random realistic wings lose by ending early.

    /usr/bin/python3 studies/drivers/strangers_early_end.py --program build/release/wingspread               # 60 wings, 4 runs each
    /usr/bin/python3 studies/drivers/strangers_early_end.py --program … --wings 20 --runs 3 --seed 9

Draws the wings of strangers.py. Each run of a campaign ends as soon as none of its peaks is proven to rise any more; its wing as a scene
(`replay --scene`) is then followed to 60 s by `simulate`. A peak moment, a peak force or an overtravel that
is larger there by more than 1e-12 of itself is lost. Exits 1 if any is.
"""

import argparse
import json
import pathlib
import random
import subprocess
import sys
import tempfile

import strangers


def made(program, *arguments):
    """The outcome that a command prints as JSON."""
    done = subprocess.run([program, *arguments, "--json"], capture_output=True, text=True, check=False)
    if not done.stdout.startswith("{"):
        sys.exit(f"{' '.join(map(str, arguments))}: exit code {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def loss(early, whole):
    """The largest share by which a peak of the whole run exceeds the early one's."""
    pairs = [(early[kind][hinge]["value"], peak["value"]) for kind in ("peak_moment", "peak_force") for hinge, peak in whole[kind].items()]
    pairs += [(early["overtravel"][hinge], angle) for hinge, angle in whole["overtravel"].items()]
    return max((abs(later) - abs(seen)) / abs(later) for seen, later in pairs if later)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/release/wingspread")
    parser.add_argument("--wings", type=int, default=60)
    parser.add_argument("--runs", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    runs = ended_early = lost = 0
    largest = 0.0
    for index in range(given.wings):
        scene, words = strangers.make_scene(random.Random(f"{given.seed}/{index}"), f"stranger_{index}")
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            (folder / "campaign.json").write_text(json.dumps(strangers.make_campaign(scene, given.runs, given.seed)))
            strangers.run(given.program, folder / "campaign.json", folder / "out")
            for k in range(given.runs):
                text = folder / f"scene_{k}.json"
                early = made(given.program, "replay", folder / "out", "--run", str(k), "--scene", text)
                if early["status"] != "deployed":
                    continue
                excess = loss(early, made(given.program, "simulate", text, "--t-end", "60"))
                runs, ended_early, largest = runs + 1, ended_early + (early["t_end"] < 60), max(largest, excess)
                if excess > 1e-12:
                    lost += 1
                    print(f"wing {index}, run {k}: a peak is larger by {excess:.2g} after {early['t_end']:.4g} s   {words}", flush=True)
    print(f"{runs} deployed runs, {ended_early} ended early, {lost} lost a peak; largest excess {largest:.1e}")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())
