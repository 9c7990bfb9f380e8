"""The page from its template and a block of data, put together as `wingspread report` does it: see DATA.md's end."""

import pathlib

PAGE = pathlib.Path(__file__).resolve().parents[2] / "montecarlo" / "report" / "page"
D3 = pathlib.Path("/usr/share/nodejs/d3/dist/d3.min.js")


def page(data):
    styles = "".join(path.read_text("utf-8") for path in sorted(PAGE.glob("*.css")))
    scripts = [D3.read_text("utf-8")] + [path.read_text("utf-8") for path in sorted(PAGE.glob("*.js"))]
    parts = {
        "<!-- style -->": f"<style>\n{styles}</style>",
        "<!-- data -->": '<script type="application/json" id="data">' + data.replace("<", "\\u003c") + "</script>",
        "<!-- scripts -->": "\n".join(f"<script>\n{script}</script>" for script in scripts),
    }
    text = (PAGE / "index.html").read_text("utf-8")
    for marker, part in parts.items():
        text = text.replace(marker, part, 1)
    return text
