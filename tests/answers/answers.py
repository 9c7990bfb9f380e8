#!/usr/bin/python3
"""Asks the program many questions and compares its answers with those recorded in tests/answers/recorded.

    /usr/bin/python3 tests/answers/answers.py PROGRAM                  compares; exits 1 where an answer differs
    /usr/bin/python3 tests/answers/answers.py PROGRAM --record         writes the answers: look at `git diff` and say why they changed
    /usr/bin/python3 tests/answers/answers.py PROGRAM --only wings     the questions whose name begins so

A recorded answer says that something changed, not that it is right: that is for the other tests, which compare with oracles. It sees
what nobody thought of: a notice that no longer appears, a case whose bounds move, a column that is gone.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "studies/drivers")]
sys.dont_write_bytecode = True
import digest
import questions

RECORDED = HERE / "recorded"
# Times, speeds, effort and versions: another machine has others.
CHANGING = [(re.compile(pattern), new) for pattern, new in (
    (r"wingspread \d+\.\d+\.\d+\S*", "wingspread VERSION"),
    (r"(?ms)^cost\b[^:]*:.*?(?=^\S|\Z)", "cost: EFFORT\n"),
    (r"\d[\d.,]* (evaluations|steps)", r"N \1"),
    (r"(?m)^ *\S* *\d+ runs? in [\d.]+ m?s.*$", "EFFORT"))]


class Session:
    """A folder, the commands given in it, and what they answered."""

    def __init__(self, program, folder):
        self.program, self.folder, self.lines, self.brief = program, folder, [], False

    def write(self, name, content):
        (self.folder / name).write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
        return name

    def ask(self, *words):
        """The command, what it prints, and its exit code unless 0; if brief, a digest of what it prints."""
        done = subprocess.run([self.program, *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False, timeout=120,
                              env={**os.environ, "OMP_NUM_THREADS": "1", "COLUMNS": "120"})
        out = clean(done.stdout)
        if done.stdout.startswith("{"):
            out = digest.of_whole_json(done.stdout)
        elif self.brief and out:
            out = [digest.of_text("\n".join(out))]
        lines = ["$ wingspread " + " ".join(map(str, words)), *out, *(f"! {line}" for line in clean(done.stderr))]
        self.lines += [line.replace(str(HERE.parents[1]), "ROOT") for line in lines]
        if done.returncode:
            self.lines.append(f"exit code {done.returncode}")
        return done

    def look(self, *names):
        """Digests of files."""
        for name in names:
            path = self.folder / name
            if not path.exists():
                self.lines.append(f"@ {name}: none")
            elif path.suffix == ".json":
                text = path.read_text(encoding="utf-8")
                self.lines += [f"@ {name}: {digest.of_whole_json(text)[0]}"] if self.brief else [f"@ {name}", *digest.of_json(text)]
            elif path.suffix == ".csv":
                self.lines.append(f"@ {name}: {digest.of_csv(path.read_text(encoding='utf-8'))[0]}")
            else:
                self.lines.append(f"@ {name}: {digest.of_text(path.read_text(encoding='utf-8'))}")

    def page(self, name):
        """The data of a report page: its scripts' work is for tests/browser."""
        if not (self.folder / name).exists():
            self.lines.append(f"@ {name}: none")
            return
        text = (self.folder / name).read_text(encoding="utf-8")
        data = re.search(r'<script type="application/json"[^>]*>(.*?)</script>', text, re.DOTALL)[1]
        self.lines += [f"@ {name}, its data", *digest.of_json(data.replace("<\\/", "</"))]


def clean(text):
    for pattern, new in CHANGING:
        text = pattern.sub(new, text)
    return [line.rstrip() for line in text.replace(str(HERE.parents[1]), "ROOT").splitlines() if line.strip()]


def answer(program, name, ask, keep):
    with tempfile.TemporaryDirectory() as folder:
        session = Session(program, pathlib.Path(folder))
        ask(session)
        if keep:
            shutil.copytree(folder, keep / name, dirs_exist_ok=True)
        return "\n".join(session.lines).replace(folder, "FOLDER") + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=os.path.abspath)
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=pathlib.Path, help="leave each question's folder here")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    given = parser.parse_args()
    asked = {name: ask for name, ask in questions.all_questions().items() if name.startswith(given.only)}
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        answers = {name: pool.submit(answer, given.program, name, ask, given.keep) for name, ask in asked.items()}
        for name, waiting in answers.items():
            path, found = RECORDED / f"{name}.txt", waiting.result()
            if given.record:
                RECORDED.mkdir(exist_ok=True)
                path.write_text(found, encoding="utf-8")
                continue
            different = digest.differences(path.read_text(encoding="utf-8"), found) if path.exists() else ["not recorded"]
            if different:
                failed += 1
                print(f"{name}: " + "\n".join(different))
    print(f"{len(asked)} questions, {failed} answers differ from the recorded ones" if not given.record else f"{len(asked)} answers recorded")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
