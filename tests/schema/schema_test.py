"""The JSON Schemas against every shipped file, by python3-jsonschema; and what both schema and program refuse.

    /usr/bin/python3 tests/schema/schema_test.py build/release/wingspread

That schema and readers know the same keys, the C++ tests ask of the readers themselves (tests/montecarlo/model/schema).
"""

import copy
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import unittest

import jsonschema

ROOT = pathlib.Path(__file__).parent.parent.parent
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
FILES = {what: sorted((ROOT / "studies" / folder).glob("*.json"))
         for what, folder in (("scene", "scenes"), ("campaign", "campaigns"))}


def schema(what):
    return json.loads(subprocess.run([PROGRAM, "schema", what], check=True, capture_output=True, text=True).stdout)


def places(value, path=()):
    yield path, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, member in items:
        yield from places(member, (*path, key))


def changed(document, path, change):
    document = copy.deepcopy(document)
    at = document
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = change(at[path[-1]])
    return document


class Schemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.validators = {}
        for what in FILES:
            jsonschema.Draft7Validator.check_schema(schema(what))
            cls.validators[what] = jsonschema.Draft7Validator(schema(what))
        cls.held = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.held.name)
        for folder in ("scenes", "campaigns"):  # which name each other
            shutil.copytree(ROOT / "studies" / folder, cls.folder / folder)

    @classmethod
    def tearDownClass(cls):
        cls.held.cleanup()

    def each_file(self):
        for what, files in FILES.items():
            self.assertGreater(len(files), 5)
            for file in files:
                yield what, file, json.loads(file.read_text(encoding="utf-8"))

    def program_takes(self, document, file):
        changed_file = self.folder / file.parent.name / "changed.json"
        changed_file.write_text(json.dumps(document))
        return subprocess.run([PROGRAM, "check", changed_file], capture_output=True, check=False).returncode != 2

    def test_every_shipped_file_is_valid(self):
        for what, file, document in self.each_file():
            self.assertEqual([error.message for error in self.validators[what].iter_errors(document)], [], file)

    def test_a_campaign_as_the_program_writes_it_is_valid(self):
        for name in ("seed", "margin", "two_wing_free", "two_wing_release", "prescribed_base", "yoke_wing"):
            out = self.folder / name
            subprocess.run([PROGRAM, "run", ROOT / f"studies/campaigns/{name}.json", "--out", out, "--runs", "1"],
                           capture_output=True, check=False)
            self.validators["campaign"].validate(json.loads((out / "campaign.json").read_text(encoding="utf-8")))

    def test_an_unknown_key_and_a_wrong_type_are_refused_by_both(self):
        chosen = random.Random(1)
        for what, file, document in self.each_file():
            changes = []  # (where, how): the documents are made of those that are chosen
            for path, value in places(document):
                # of a map any key may be the name of something
                named = path and path[-1] in ("set", "scale", "add", "distributions", "torques", "rates")
                if path and isinstance(value, dict) and not named:
                    changes.append((path, lambda old: {**old, "unheard_of": 1}))
                if path and isinstance(value, (int, float)) and not isinstance(value, bool):
                    changes.append((path, lambda old: {"a": old}))
                    changes.append((path, lambda old: True))
            most = 300 if os.environ.get("WINGSPREAD_NIGHTLY") else 60  # of each file, some 1500 in all
            if len(changes) > most:
                changes = chosen.sample(changes, most)
            refused = [changed(document, *change) for change in changes]
            for broken in refused:
                self.assertFalse(self.validators[what].is_valid(broken), file)
            for broken in chosen.sample(refused, 3):
                self.assertFalse(self.program_takes(broken, file), broken)
            self.assertTrue(self.program_takes(document, file))

    def test_what_an_editor_shows(self):
        spring = self.validators["scene"].schema["properties"]["hinges"]["items"]["properties"]["latch"]
        self.assertEqual(spring["description"], "an object with the latch's stiffness, and its damping or dissipation")
        self.assertIn("N·m/rad", spring["properties"]["stiffness"]["description"])
        laws = self.validators["scene"].schema["properties"]["hinges"]["items"]["properties"]["damper"]["anyOf"]
        self.assertEqual(sorted(word for law in laws for word in law["properties"]["law"]["enum"]),
                         ["eddy_current", "power", "viscous"])


if __name__ == "__main__":
    unittest.main()
