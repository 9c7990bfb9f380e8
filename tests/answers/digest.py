"""Short forms of what the program writes, in which a change of any value shows.

Of many numbers two weighted sums stand, of many texts a checksum: numbers differ a little from one processor to another, so their
bytes cannot be summed. `differences` compares two such forms, words exactly and numbers to a tolerance.
"""

import csv
import html.parser
import io
import json
import math
import re
import zlib

NUMBER = re.compile(r"(?<![A-Za-z_0-9.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
RELATIVE, ABSOLUTE = 2e-6, 1e-9  # an adaptive method's steps, and so its errors of some 1e-8, depend on the processor's instructions
# Of effort and the machine: not compared.
EFFORT = re.compile(r"hash|kernel|evaluations|steps|rejected|seconds|threads|lanes|isa|method_(share|switches)|processor|version|program|rhs|wall|bytes")


def of_numbers(numbers):
    """Sums that no exchange, sign or shift leaves as they are; all terms are positive, so that none cancels another."""
    finite = [value for value in numbers if math.isfinite(value)]
    size = sum(abs(value) for value in finite)
    weighed = sum(abs(value) * (1 + (at * 0.6180339887) % 1) * (1 if value >= 0 else 0.5) for at, value in enumerate(finite)
                  if abs(value) > ABSOLUTE)
    odd = f", {len(numbers) - len(finite)} not finite" if len(finite) < len(numbers) else ""
    return f"{len(numbers)} numbers {size:.9g} {weighed:.9g}{odd}"


def of_texts(texts):
    """The texts themselves, once each, if they are few and short."""
    some = list(dict.fromkeys(texts))
    if len(some) <= 4 and all(len(text) < 120 for text in some):
        return f"{len(texts)} texts " + " | ".join(some)
    return f"{len(texts)} texts x{zlib.crc32(NUMBER.sub('#', chr(0).join(texts)).encode()):08x}"


def of_text(text):
    """One line of words and numbers."""
    lines = [" ".join(line.split()) for line in text.splitlines()]
    return f"{of_texts(lines)}, {of_numbers([float(number) for number in NUMBER.findall(text)])}"


def of_values(values):
    numbers = [float(value) for value in values if isinstance(value, (int, float)) and not isinstance(value, bool)]
    others = [value if isinstance(value, str) else json.dumps(value) for value in values
              if not isinstance(value, (int, float)) or isinstance(value, bool)]
    return ", ".join(part for part in (numbers and of_numbers(numbers), others and of_texts(others)) if part)


def leaves(value, at=""):
    if isinstance(value, dict):
        for key, inner in value.items():
            if not EFFORT.search(key):
                yield from leaves(inner, f"{at}.{key}" if at else key)
        if not value:
            yield at, "{}"
    elif isinstance(value, list):
        for inner in value:
            yield from leaves(inner, at + "[]")
        if not value:
            yield at, "[]"
    else:
        yield at, value


def of_json(text):
    """A line for each key, of its values at all places in their order."""
    found = {}
    for place, value in leaves(json.loads(text)):
        found.setdefault(place.removesuffix("[]").rpartition(".")[2], []).append(value)
    return [f"{key}: {of_values(values)}" for key, values in found.items()]


def of_whole_json(text):
    """One line."""
    all_leaves = list(leaves(json.loads(text)))
    return [f"{of_values([value for _, value in all_leaves])}, keys {of_texts([place for place, _ in all_leaves])}"]


def of_csv(text):
    """One line."""
    lines = text.splitlines()
    table = list(csv.reader(io.StringIO("\n".join(line for line in lines if not line.startswith("#")))))
    columns = [column for column in zip(*table) if not EFFORT.search(column[0])]
    comments = of_texts([line for line in lines if line.startswith("#")]) + ", " if lines and lines[0].startswith("#") else ""
    return [f"{comments}{len(table) - 1} rows, {of_values([value(cell) for column in columns for cell in column])}"]


def value(cell):
    try:
        return float(cell)
    except ValueError:
        return cell


class Page(html.parser.HTMLParser):
    """What a drawing says and draws, a line for each heading."""

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.parts, self.hidden, self.in_heading = [["", [], []]], 0, False

    def handle_starttag(self, tag, attributes):
        self.hidden += tag in ("script", "style")
        if re.fullmatch(r"h\d", tag):
            self.parts.append(["", [], []])
            self.in_heading = True
        for name, text in attributes:
            if name in ("d", "x", "y", "x1", "x2", "y1", "y2", "cx", "cy", "r", "width", "height", "points", "transform") and text:
                self.parts[-1][2] += [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", text)]

    def handle_endtag(self, tag):
        self.hidden -= tag in ("script", "style")
        self.in_heading = self.in_heading and not re.fullmatch(r"h\d", tag)

    def handle_data(self, data):
        if self.in_heading:
            self.parts[-1][0] += data
        elif not self.hidden and data.strip():
            self.parts[-1][1].append(data)


def of_page(text):
    page = Page()
    page.feed(text)
    return [f"{' '.join(heading.split())}: {of_text(chr(10).join(texts))}; drawn {of_numbers(numbers)}" for heading, texts, numbers in page.parts]


def differences(recorded, found):
    """Lines that differ: words exactly, numbers to RELATIVE or to one unit of the last printed digit."""
    old, new = recorded.splitlines(), found.splitlines()
    words = [[NUMBER.sub("#", " ".join(line.split())) for line in lines] for lines in (old, new)]
    if words[0] != words[1]:
        at = next((i for i, (a, b) in enumerate(zip(*words)) if a != b), min(len(old), len(new)))
        return [f"line {at + 1}", *(f"- {line}" for line in old[at:at + 3]), *(f"+ {line}" for line in new[at:at + 3])]
    for at, (a, b) in enumerate(zip(old, new), 1):
        if not all(near(x, y) for x, y in zip(NUMBER.findall(a), NUMBER.findall(b), strict=True)):
            return [f"line {at}", f"- {a}", f"+ {b}"]
    return []


def near(one, other):
    a, b = float(one), float(other)
    digits = min(last_digit(one), last_digit(other))
    return abs(a - b) <= max(ABSOLUTE, RELATIVE * max(abs(a), abs(b)), digits)


def last_digit(text):
    """One unit of a decimal number's last place; 0 for an integer, which is exact."""
    mantissa, _, power = text.partition("e")
    places = len(mantissa.partition(".")[2])
    return 1.01 * 10.0 ** (int(power or 0) - places) if 0 < places < 12 else 0
