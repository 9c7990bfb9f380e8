"""What a package has beside the program: completions that complete in their shells, pages that man reads without a
complaint, and Debian packages that unpack to a program that runs on its own.

    /usr/bin/python3 tests/package/package_test.py build/release
"""

import gzip
import os
import pathlib
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).parent.parent.parent
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
PROGRAM = BUILD / "wingspread"
COMPLETIONS = ROOT / "montecarlo/interfaces/package"
WITH_PROGRAM = {**os.environ, "PATH": f"{BUILD}:{os.environ['PATH']}"}


def output_of(*words, **options):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True, **options).stdout


def commands():
    """Those that --help lists."""
    return re.findall(r"(?m)^  ([a-z]+) ", output_of(PROGRAM, "--help").split("Subcommands:\n")[1].split("\n\n")[0])


class InFolder(unittest.TestCase):
    def setUp(self):
        self.held = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.held.name)

    def tearDown(self):
        self.held.cleanup()


class Completions(InFolder):
    """The same questions to each shell."""

    def setUp(self):
        super().setUp()
        (self.folder / "my wing.json").write_text("{}")
        (self.folder / "here").mkdir()

    def bash(self, line):
        words = line.split(" ")
        script = (f"source {COMPLETIONS}/wingspread.bash; COMP_WORDS=({' '.join(words) or ''}"
                  f"{' ' + chr(39) * 2 if words[-1] == '' else ''}); COMP_CWORD={len(words) - 1}; _wingspread; "
                  "for word in \"${COMPREPLY[@]}\"; do echo \"$word\"; done")
        return output_of("bash", "--norc", "-c", script, cwd=self.folder, env=WITH_PROGRAM).splitlines()

    def fish(self, line):
        script = f"source {COMPLETIONS}/wingspread.fish; complete -C '{line}'"
        home = {**WITH_PROGRAM, "HOME": str(self.folder), "XDG_CONFIG_HOME": str(self.folder / "here")}
        said = output_of("fish", "--no-config", "-c", script, cwd=self.folder, env=home)
        return [candidate.split("\t")[0].rstrip("/") for candidate in said.splitlines()]

    def zsh(self, line):
        """What the line becomes when the tabulator key is pressed, in a terminal."""
        shutil.copy(COMPLETIONS / "wingspread.zsh", self.folder / "here/_wingspread")
        child, terminal = pty.fork()
        if child == 0:
            os.chdir(self.folder)
            os.execvpe("zsh", ["zsh", "-f", "-i"], {**WITH_PROGRAM, "TERM": "dumb", "PS1": "", "COLUMNS": "200"})
        said = ""

        def until(mark, seconds=60):
            """Reads until the pattern is there. @return whether it is"""
            nonlocal said
            end = time.monotonic() + seconds
            while not re.search(mark, said) and time.monotonic() < end:
                if select.select([terminal], [], [], 0.1)[0]:
                    said += os.read(terminal, 65536).decode(errors="replace")
            return re.search(mark, said)

        os.write(terminal, b"unsetopt zle; PS1=; fpath=($PWD/here $fpath); autoload -U compinit; compinit -D -u; "
                           b"setopt zle; unsetopt beep; bindkey '^I' complete-word; LISTMAX=1000; echo rea''dy\n")
        until("ready\r\n")
        # what is completed is printed by the shell itself, not read off its drawing
        os.write(terminal, b"show() { print -r -- \"<$BUFFER>\" }; zle -N show; bindkey '^X' show\n")
        for _ in range(60):  # until the line editor answers a key: what is typed before may be lost
            os.write(terminal, b"\x18")
            if until("<>\r\n", 1):
                break
        os.write(terminal, line.encode() + b"\t\x18")
        found = until(r"<(wingspread [^>]*)>\r\n")
        os.write(terminal, b"\x03exit\n")
        os.close(terminal)
        os.waitpid(child, 0)
        return found[1].rstrip() if found else said

    def test_bash(self):
        self.assertEqual(self.bash("wingspread s"), ["simulate", "sample", "size", "sensitivity", "schema"])
        self.assertEqual(self.bash("wingspread schema "), ["scene", "campaign"])
        self.assertEqual(self.bash("wingspread run --re"), ["--resume"])
        self.assertEqual(self.bash("wingspread simulate --latch "), ["event"])
        self.assertEqual(self.bash("wingspread run --runs "), [])
        self.assertIn("here", self.bash("wingspread run x.json --out he"))
        self.assertEqual(set(self.bash("wingspread ")), {*commands(), "-h", "--help", "--version"})
        self.assertEqual(self.bash("wingspread report "), ["here", "my wing.json"])
        for command in commands():
            with self.subTest(command):
                _, *positionals = output_of(PROGRAM, command, "--help").split("Positionals:\n")
                if positionals and "|" not in positionals[0].splitlines()[0]:
                    self.assertEqual(self.bash(f"wingspread {command} "), ["here", "my wing.json"])

    def test_fish(self):
        if not shutil.which("fish"):
            self.skipTest("no fish")
        self.assertEqual(sorted(self.fish("wingspread s")), ["sample", "schema", "sensitivity", "simulate", "size"])
        self.assertEqual(self.fish("wingspread run --re"), ["--resume"])
        self.assertEqual(self.fish("wingspread simulate --latch "), ["event"])
        self.assertEqual(self.fish("wingspread run --out he"), ["here"])
        self.assertEqual(self.fish("wingspread fit my"), ["my wing.json"])
        self.assertEqual(set(self.fish("wingspread ")), set(commands()))

    def test_zsh(self):
        if not shutil.which("zsh"):
            self.skipTest("no zsh")
        self.assertEqual(self.zsh("wingspread sim"), "wingspread simulate")
        self.assertEqual(self.zsh("wingspread run --res"), "wingspread run --resume")
        self.assertEqual(self.zsh("wingspread simulate --latch e"), "wingspread simulate --latch event")
        self.assertEqual(self.zsh("wingspread run --out he"), "wingspread run --out here/")
        self.assertEqual(self.zsh("wingspread fit he"), "wingspread fit here/")

    def test_every_option_of_help_is_offered(self):
        for command in commands():
            options = re.findall(r"(?m)^  (?:-h,)?(--[a-z-]+)", output_of(PROGRAM, command, "--help"))
            self.assertGreater(len(options), 0)
            self.assertEqual([each for each in self.bash(f"wingspread {command} -") if each != "-h"], options)
            if shutil.which("fish"):
                self.assertEqual(sorted(self.fish(f"wingspread {command} --")), sorted(options))


@unittest.skipUnless(shutil.which("help2man"), "no help2man")
class Pages(InFolder):
    def test_man_reads_every_page_without_a_complaint(self):
        pages = sorted((BUILD / "package/man").iterdir())
        self.assertEqual([page.name for page in pages],
                         sorted(["wingspread.1.gz"] + [f"wingspread-{command}.1.gz" for command in commands()]))
        for page in pages:
            done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], capture_output=True, text=True,
                                  check=True, env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"})
            self.assertEqual(done.stderr, "")
            self.assertIn("wingspread", done.stdout)
            said = re.sub("\\s+|.\x08", "", done.stdout)
            self.assertGreater(len(said), 100)

    def test_json_is_shown_line_by_line_as_help_shows_it(self):
        seen = 0
        for command in commands():
            shown = subprocess.run(["man", "-E", "UTF-8", "-l", BUILD / f"package/man/wingspread-{command}.1.gz"], capture_output=True, text=True, check=True,
                                   env={**os.environ, "MANWIDTH": "100", "LC_ALL": "C.UTF-8"}).stdout
            page = {line.strip() for line in re.sub(".\x08", "", shown).splitlines()}
            for line in output_of(PROGRAM, command, "--help").splitlines():
                if re.match(r' +({|"[a-z_]+": )', line):
                    self.assertIn(line.strip(), page, command)
                    seen += 1
        self.assertGreater(seen, 5)

    def test_paragraphs_and_examples_of_help_are_whole_in_the_page(self):
        for command in commands():
            page = subprocess.run(["man", "-E", "UTF-8", "--nj", "--nh", "-l", BUILD / f"package/man/wingspread-{command}.1.gz"],
                                  capture_output=True, text=True, check=True,
                                  env={**os.environ, "MANWIDTH": "160", "LC_ALL": "C.UTF-8"}).stdout
            page = re.sub(".\x08", "", page)
            lines = {line.strip().removeprefix("$ ") for line in page.splitlines()}
            paragraphs = [" ".join(each.split()) for each in page.split("\n\n")]
            help_text = output_of(PROGRAM, command, "--help")
            for line in re.findall(r"(?m)^  wingspread .*", help_text):
                self.assertIn(line.strip(), lines, command)
            for paragraph in help_text.split("\n\n")[1:]:
                said = paragraph.splitlines()
                if not any(line.startswith(" ") or line.endswith(":") for line in said):
                    self.assertTrue(any(" ".join(said) in each for each in paragraphs), f"{command}: {said}")

    def test_a_path_may_have_blanks(self):
        program = self.folder / "a build" / "wingspread"
        program.parent.mkdir()
        program.symlink_to(PROGRAM)
        output_of("cmake", f"-DPROGRAM={program}", f"-DOUT={program.parent}/package", "-DGZIP=gzip", "-DHELP2MAN=help2man",
                  f"-DCHANGELOG={ROOT}/CHANGELOG.md", "-DVERSION=1", "-DMAINTAINER=me", "-P", COMPLETIONS / "make.cmake")
        made = program.parent / "package/man"
        self.assertEqual({page.name for page in made.iterdir()}, {page.name for page in (BUILD / "package/man").iterdir()})

    def test_a_page_says_what_help_says(self):
        for command in commands():
            with gzip.open(BUILD / f"package/man/wingspread-{command}.1.gz", "rt", encoding="utf-8") as file:
                page = re.sub(r"\\f\(CW|\\f.|\\,|\\/", "", file.read().replace("\\-", "-").replace("\\&", ""))
            shown = output_of(PROGRAM, command, "--help")
            self.assertIn(f"wingspread-{command} - {shown.splitlines()[0]}", page)
            for option in re.findall(r"(?m)^  (?:-h,)?(--[a-z-]+)", shown):
                self.assertIn(option, page)
            for line in shown.split("Example:\n")[1].strip().splitlines():
                self.assertIn(line.strip(), page)


@unittest.skipUnless(pathlib.Path("/usr/lib/python3/dist-packages").exists(), "no Debian")
class Installed(InFolder):
    @unittest.skipUnless((BUILD / "python/wingspread").exists(), "the module is not built")
    def test_the_module_is_found_where_python_searches_below_the_prefix(self):
        python = re.search(r"(?m)^_?Python_EXECUTABLE:\w+=(.+)$", (BUILD / "CMakeCache.txt").read_text()).group(1)
        for prefix in ("usr", "usr/local"):
            below = self.folder / prefix.replace("/", "_")
            output_of("cmake", "--install", BUILD, "--component", "python", "--prefix", below / prefix)
            said = output_of(python, "-c", f"import site, sys; sys.path[:0] = site.getsitepackages(['{below}/usr']); import wingspread; print(wingspread.__file__)")
            self.assertTrue(said.startswith(f"{below}/{prefix}/lib/python3."), said)
        packaged = self.folder / "packaged"  # into /usr, as a package has it
        output_of("cmake", "--install", BUILD, "--component", "python", "--prefix", "/usr", env={**os.environ, "DESTDIR": str(packaged)})
        self.assertTrue((packaged / "usr/lib/python3/dist-packages/wingspread/__init__.py").exists())


@unittest.skipUnless(shutil.which("dpkg-deb") and shutil.which("dpkg-shlibdeps"), "no Debian")
class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.held = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.held.name)
        output_of("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "made",
                  "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        cls.packages = {path.name.split("_")[0]: path for path in (cls.folder / "made").glob("*.deb")}

    @classmethod
    def tearDownClass(cls):
        cls.held.cleanup()

    def field(self, package, name):
        return output_of("dpkg-deb", "--field", self.packages[package], name).strip()

    def test_the_program_needs_little_and_runs_where_it_is_unpacked(self):
        needed = {word.split()[0] for word in self.field("wingspread", "Depends").split(",")}
        self.assertEqual(needed, {"libc6", "libfmt9", "libgcc-s1", "libgomp1", "libstdc++6"})
        root = self.folder / "root"
        output_of("dpkg-deb", "--extract", self.packages["wingspread"], root)
        examples = root / "usr/share/wingspread/examples"
        bare = {"PATH": "", "HOME": str(self.folder)}
        checked = 0
        for file in sorted(examples.rglob("*.json")):
            if file.with_suffix(".csv").exists() or "work_precision" not in file.name:
                output_of(root / "usr/bin/wingspread", "check", file, env=bare)
                checked += 1
        self.assertGreater(checked, 10)
        output_of(root / "usr/bin/wingspread", "new", "--example", "yoke", "--out", self.folder / "yoke", env=bare)
        output_of(root / "usr/bin/wingspread", "check", self.folder / "yoke/campaign.json", "--strict", env=bare)
        done = subprocess.run([root / "usr/bin/wingspread", "run", examples / "campaigns/seed.json", "--out",
                               self.folder / "out", "--runs", "40"], env=bare, capture_output=True, check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        output_of(root / "usr/bin/wingspread", "report", self.folder / "out", env=bare)

    def test_a_package_for_one_kind_of_processor_is_named_for_it(self):
        arch = re.search(r"(?m)^WINGSPREAD_ARCH:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text()).group(1)
        revision = "1~" + re.sub(r"[^A-Za-z0-9]", ".", arch) if arch else "1"
        self.assertEqual(self.field("wingspread", "Version").split("-")[-1], revision)
        subprocess.run(["dpkg", "--compare-versions", revision, "le", "1"], check=True)

    def test_it_has_what_debian_expects(self):
        names = {line.split()[-1] for line in output_of("dpkg-deb", "--contents",
                                                        self.packages["wingspread"]).splitlines()}
        pages = ("share/man/man1/wingspread.1.gz", "share/man/man1/wingspread-run.1.gz")
        for name in (*(pages if shutil.which("help2man") else ()), "bin/wingspread",
                     "share/bash-completion/completions/wingspread", "share/zsh/vendor-completions/_wingspread",
                     "share/fish/vendor_completions.d/wingspread.fish", "share/doc/wingspread/copyright",
                     "share/wingspread/scene.schema.json", "share/wingspread/campaign.schema.json",
                     "share/doc/wingspread/changelog.gz", "share/doc/wingspread/changelog.Debian.gz", "share/wingspread/examples/scenes/three_panel.json",
                     "share/wingspread/examples/campaigns/seed.json"):
            self.assertIn("./usr/" + name, names)
        rights = output_of("dpkg-deb", "--fsys-tarfile", self.packages["wingspread"], encoding="latin-1")
        for holder in ("The wingspread authors", "Mike Bostock", "Niels Lohmann"):
            self.assertIn(holder, rights)
        if shutil.which("lintian"):
            for name in ("wingspread", "python3-wingspread"):  # it reads long in the library
                package = self.packages.get(name, self.packages["wingspread"])
                # whoever makes the package puts his address there: -DWINGSPREAD_MAINTAINER, and it closes no bug of
                # Debian's; HDF5 is linked with its zlib, and its texts are misspelt; cpack leaves compilers' names in
                # the file; the module calls nothing that -D_FORTIFY_SOURCE knows
                rightly = ["bogus-mail-host", "bogus-mail-host-in-debian-changelog", "initial-upload-closes-no-bugs",
                           "embedded-library", "spelling-error-in-binary", "binary-has-unneeded-section",
                           "hardening-no-fortify-functions"]
                done = subprocess.run(["lintian", "--allow-root", "--display-info", "--fail-on", "error,warning,info",
                                       "--suppress-tags", ",".join(rightly), package],
                                      capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_the_copyright_names_every_part_of_the_list(self):
        parts = ["node-d3", "nlohmann-json3-dev", "libcli11-dev", "libeigen3-dev", "librandom123-dev"]
        if "WINGSPREAD_HDF5_LINKS:INTERNAL=1" in (BUILD / "CMakeCache.txt").read_text():
            parts += ["libhdf5-dev", "zlib1g-dev", "libaec-dev"]
        if (BUILD / "montecarlo/kernel.base64").exists():
            parts += ["wasi-libc", "libc++-14-dev-wasm32", "libc++abi-14-dev-wasm32", "libclang-rt-14-dev-wasm32"]
        for name, package in self.packages.items():
            text = output_of("dpkg-deb", "--fsys-tarfile", package, encoding="latin-1")
            for part in [*parts, *(["pybind11-dev"] if name.startswith("python3") else [])]:
                self.assertIn(f"/usr/share/doc/{part}/copyright\n", text, name)

    def test_each_package_has_a_synopsis_of_its_own(self):
        described = [self.field(package, "Description").splitlines() for package in self.packages]
        self.assertEqual(len({synopsis for synopsis, *_ in described}), len(self.packages))
        for synopsis, *lines in described:
            self.assertLess(len(synopsis), 80)
            self.assertGreater(len(lines), 1)
            for line in lines:
                self.assertRegex(line, "^ [^ ]")

    def test_the_library_is_found_through_a_link_to_its_folder(self):
        root = self.folder / "linked"
        output_of("dpkg-deb", "--extract", self.packages["libwingspread-dev"], root)
        (root / "lib").symlink_to("usr/lib")
        output_of("cmake", "-S", ROOT / "tests/consumer", "-B", self.folder / "consumer", "-G", "Ninja",
                  f"-DCMAKE_PREFIX_PATH={root}")
        found = re.search(r"(?m)^wingspread_DIR:\w+=(.*)$", (self.folder / "consumer/CMakeCache.txt").read_text()).group(1)
        self.assertTrue(found.startswith(f"{root}/lib/"), found)

    def test_the_others_are_the_library_and_the_module(self):
        library = output_of("dpkg-deb", "--contents", self.packages["libwingspread-dev"])
        self.assertIn("./usr/include/wingspread/wingspread.hpp", library)
        self.assertIn("libwingspread.a", library)
        self.assertIn("libfmt-dev (>= 9), libfmt-dev (<< 10~)", self.field("libwingspread-dev", "Depends"))
        if "python3-wingspread" not in self.packages:
            self.skipTest("the module is not built")
        output_of("dpkg-deb", "--extract", self.packages["python3-wingspread"], self.folder / "python")
        said = output_of("/usr/bin/python3", "-c", "import wingspread; print(wingspread.__version__, wingspread.__file__)",
                         env={"PYTHONPATH": str(self.folder / "python/usr/lib/python3/dist-packages")})
        self.assertTrue(said.split()[1].startswith(str(self.folder)))


if __name__ == "__main__":
    unittest.main()
