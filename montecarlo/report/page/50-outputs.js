// The outputs: a list with small histograms to search and choose from, and the chosen output's pictures and numbers.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;

  // The levels of the quantiles of some outputs, ascending, and an output's quantile at a level.
  const levelsOf = (outputs) =>
    [...new Set(outputs.flatMap((one) => (one.quantiles || []).map((quantile) => quantile.p)))].sort(d3.ascending);
  const quantileAt = (output, p) => ((output.quantiles || []).find((one) => one.p === p) || {}).value;
  const requirementsOn = (set, output) => (output.limits || []).map((at) => set.requirements[at]).filter(Boolean);
  // A value of an output as text, to a tenth of its standard deviation.
  const inGrain = (output) => (value) => F.value(value, output.unit, F.grain(output));
  // The same in a table of many outputs: DIGITS significant digits in every row, more only where they would hide the spread.
  const DIGITS = 4;
  function inDigits(output) {
    const size = (value) => Math.floor(Math.log10(Math.abs(value))),
      largest = Math.max(Math.abs(output.min), Math.abs(output.max)),
      needed = output.std > 0 && largest > 0 ? size(largest) - size(output.std) + 2 : 0,
      { factor } = F.shown(output.unit);
    // Rounding noise beside the output's values prints as 0.
    const clean = (value) => (Math.abs(value) < 1e-9 * largest ? 0 : value);
    return (value) =>
      !output.unit && Number.isInteger(value) ? F.given(value) : F.number(W.isNumber(value) ? clean(value) * factor : value, Math.max(DIGITS, needed));
  }

  function spark(output) {
    const svg = M.small("spark", 84, 18);
    const histogram = output.histogram;
    if (W.isNumber(output.min) && output.min === output.max)
      return W.h("span.faint", output.count === 1 ? "one value" : "constant");
    if (histogram && histogram.counts.length) {
      const { edges, counts } = histogram,
        x = d3.scaleLinear([edges[0], edges[edges.length - 1]], [0, 84]),
        y = d3.scaleLinear([0, d3.max(counts)], [0, 17]);
      M.put(svg, "path", {
        d:
          counts
            .map(
              (count, at) =>
                `M${x(edges[at]).toFixed(1)},18v${(-y(count)).toFixed(1)}H${x(edges[at + 1]).toFixed(1)}V18`,
            )
            .join("") + "Z",
      });
      if (W.isNumber(output.nominal) && output.nominal >= edges[0] && output.nominal <= edges[edges.length - 1])
        M.put(svg, "line", { x1: x(output.nominal), x2: x(output.nominal), y1: 0, y2: 18 });
    }
    return svg.node();
  }

  function worstVerdict(set, output) {
    const verdicts = requirementsOn(set, output).map((one) => W.verdicts.verdictOf(one.verdict));
    return ["failed", "open", "passed"].find((verdict) => verdicts.includes(verdict));
  }

  let filter = "";
  function list() {
    const set = W.set(),
      outputs = W.outputsOf(set);
    const levels = levelsOf(outputs);
    const shownLevels =
      levels.length > 5 ? [levels[0], levels[Math.floor(levels.length / 2)], levels[levels.length - 1]] : levels;
    const columns = [
      "Output",
      "Unit",
      number("Runs"),
      "Distribution",
      number("Nominal"),
      number("Mean"),
      number("Std"),
      ...shownLevels.map((p) => number(F.quantileName(p))),
    ];
    const rows = outputs.map(function (output) {
      const verdict = worstVerdict(set, output),
        value = inDigits(output);
      const button = h(
        "button.pick",
        {
          "data-output": output.name,
          "aria-pressed": String(output.name === W.chosen.output),
          onclick: () => W.choose("output", output.name),
        },
        F.name(output),
      );
      return {
        mark: output.count ? null : "zero",
        cells: [
          h("span", button, verdict ? [" ", W.verdictBadge(verdict, set, true)] : null),
          F.shown(output.unit).unit,
          F.count(output.count),
          output.count ? spark(output) : "in no run",
          value(output.nominal),
          value(output.mean),
          F.number(W.isNumber(output.std) ? output.std * F.shown(output.unit).factor : null, 3),
          ...shownLevels.map((p) => value(quantileAt(output, p))),
        ],
      };
    });
    const table = W.table(`Outputs of ${set.label}`, columns, rows, { class: "outputs" });
    table.addEventListener("keydown", byArrows);
    const found = h("span.faint", { role: "status" });
    const search = h("input", {
      type: "search",
      placeholder: "e.g. root peak",
      value: filter,
      "aria-controls": (table.id = W.newId("outputs")),
      oninput: (event) => {
        filter = event.target.value;
        narrow();
      },
    });
    function narrow() {
      const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
      let count = 0;
      table.querySelectorAll("tbody tr").forEach(function (row, at) {
        const text = `${outputs[at].name} ${F.name(outputs[at])} ${outputs[at].unit}`.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
        count += !row.hidden;
      });
      found.textContent = `${count} of ${outputs.length}`;
    }
    narrow();
    return [h("div.controls", h("label.search", "Search ", search), found), table, stillBase(set)];
  }
  // Whether two wings mirror each other: every parameter of a hinge and of its body is equal but for its sign.
  function mirrorImages(set) {
    const hinges = (set.wing_orders || []).map((wing) => wing.hinges || []);
    if (hinges.length !== 2 || !hinges[0].length || hinges[0].length !== hinges[1].length) return false;
    const bodyOf = (name) => ((set.wing || {}).bodies || []).find((one) => W.set().wing.hinges[one.hinge] && W.set().wing.hinges[one.hinge].name === name),
      pairs = hinges[0].flatMap((name, at) => {
        const [a, b] = [bodyOf(name), bodyOf(hinges[1][at])];
        return [[`hinges.${name}.`, `hinges.${hinges[1][at]}.`], ...(a && b ? [[`bodies.${a.name}.`, `bodies.${b.name}.`]] : [])];
      }),
      scene = ((set.inputs || {}).scene || []).map((one) => [one.path, W.isNumber(one.case_value) ? one.case_value : one.value]);
    const part = (start) => new Map(scene.filter(([path]) => path.startsWith(start)).map(([path, value]) => [path.slice(start.length), value]));
    return pairs.every(function ([one, other]) {
      const [a, b] = [part(one), part(other)];
      return a.size === b.size && [...a].every(([path, value]) => (W.isNumber(value) ? Math.abs(value) === Math.abs(b.get(path)) : value === b.get(path)));
    });
  }
  // Why a base that turns in the runs has a nominal rate of 0, up to rounding.
  function stillBase(set) {
    const still = W.outputsOf(set).filter((one) => ["base.peak_rate", "base.peak_angle"].includes(one.name) && W.isNumber(one.nominal) && one.max > 0 && Math.abs(one.nominal) < 1e-9 * one.max);
    return still.length && mirrorImages(set)
      ? h("p.note", `${still.map((one) => F.name(one)).join(" and ")}: the nominal wings are mirror images, so the nominal base does not turn.`)
      : null;
  }
  function byArrows(event) {
    if (!["ArrowDown", "ArrowUp"].includes(event.key) || !event.target.matches(".pick")) return;
    const picks = [...event.currentTarget.querySelectorAll("tr:not([hidden]) .pick")];
    const next = picks[picks.indexOf(event.target) + (event.key === "ArrowDown" ? 1 : -1)];
    if (next) {
      next.focus();
      next.click();
    }
    event.preventDefault();
  }

  function bounds(one, text) {
    if (W.isNumber(one.lower) && W.isNumber(one.upper)) return `${text(one.lower)} … ${text(one.upper)}`;
    return W.isNumber(one.lower)
      ? `above ${text(one.lower)}`
      : W.isNumber(one.upper)
        ? `below ${text(one.upper)}`
        : "too few runs for bounds";
  }
  function quantiles(output, set) {
    const text = inGrain(output);
    const note = (words) => h("span.wrapped", words);
    const row = (name, one) => [name, text(one.value), one.note ? note(one.note) : bounds(one, text)];
    const rows = (output.quantiles || []).map((one) => row(F.quantileName(one.p).toLowerCase(), one));
    for (const one of output.quantiles || [])
      if (one.among && !W.isNumber(one.value))
        rows.push(row(`${F.quantileName(one.p).toLowerCase()} among runs with a value`, one.among));
    for (const one of output.tolerance_limits || [])
      rows.push([
        `tolerance: ${one.text}`,
        [one.lower, one.upper].filter(W.isNumber).map(text).join(" … ") || F.none,
        one.note ? note(one.note) : "",
      ]);
    return W.table(
      `Quantiles of ${F.name(output)}`, // over all runs
      ["Quantile", number("Value", F.shown(output.unit).unit), number(`${F.given(100 * set.confidence)} % two-sided bounds`)],
      rows,
      { showCaption: true },
    );
  }
  function moments(output) {
    const value = (number) => F.withUnit(number, output.unit, F.grain(output));
    const rows = [
      ["runs with a value", F.count(output.count)],
      ["runs without a value", F.count(output.missing)],
      ["nominal run", W.isNumber(output.nominal) ? value(output.nominal) : "no value"],
      ["mean", value(output.mean)],
      ["standard error of the mean", F.withUnit(output.mean_error, output.unit, output.mean_error)],
      ["standard deviation", F.withUnit(output.std, output.unit, output.std)],
      ["minimum", value(output.min)],
      ["maximum", value(output.max)],
      ["skewness", F.fixed(output.skewness, 2)],
      ["excess kurtosis", F.fixed(output.kurtosis, 2)],
    ];
    return W.table(`Statistics of ${F.name(output)}`, ["Statistic", number("Value")], rows, {
      showCaption: true,
    });
  }
  // The quantiles of an output by case, side by side.
  function byCase(name) {
    const found = W.sets.map((set) => ({ set, output: W.output(set) })).filter((one) => one.output);
    if (found.length < 2) return null;
    const levels = levelsOf(found.map((one) => one.output));
    const unit = found[0].output.unit,
      missing = found.some((one) => one.output.missing),
      grain = d3.min(found, (one) => F.grain(one.output) || Infinity), // the same decimals in every row
      text = (value) => F.value(value, unit, isFinite(grain) ? grain : null);
    return W.table(
      `${name} by ${W.kindOfSets()}`,
      [
        W.headOfSets(),
        number("Nominal", F.shown(unit).unit),
        number("Mean"),
        ...levels.map((p) => number(F.quantileName(p))),
        ...(missing ? [number("Missing")] : []),
      ],
      found.map(({ set, output }) => [
        set.label,
        ...[output.nominal, output.mean, ...levels.map((p) => quantileAt(output, p))].map(text),
        ...(missing ? [F.count(output.missing)] : []),
      ]),
      { showCaption: true },
    );
  }

  function glossaryText(output) {
    const known = W.data.glossary || {},
      quantity = output.hinge ? output.name.slice(output.hinge.length + 1) : "",
      owner = { frequency: "mode_K", peak_bending_moment: "BODY" }[quantity] || "HINGE",
      stem = output.hinge ? `${owner}.${quantity}` : output.name;
    const entry = known[output.name] || known[stem] || known[output.family];
    return entry ? entry.text : null;
  }

  function chosen(host) {
    const set = W.set(),
      output = W.output();
    if (!output)
      return W.fill(
        host,
        h(
          "p",
          W.outputsOf(set).length
            ? `${F.nameOf(W.chosen.output || "")} is not among the outputs of ${set.label}.`
            : "The campaign recorded no outputs.",
        ),
      );
    const text = glossaryText(output);
    const title = h("h3.chosen", F.name(output), " ", h("code", output.name));
    const limits = requirementsOn(set, output).map((one) => h("li", W.verdictBadge(one.verdict, set), " ", W.verdicts.wordsOf(one, set)));
    const head = [title, text ? h("p.note", text) : null, limits.length ? h("ul.plain", limits) : null];
    if (!output.count || !output.histogram)
      return W.fill(host, head, h("p.nothing", `No run of ${set.label} has a value.`), byCase(F.name(output)));
    const split =
      W.sets.length > 1
        ? W.buttons(
            "Colour",
            Object.entries({ order: "by latch order", case: `by ${W.kindOfSets()}, overlaid` }),
            W.chosen.split,
            (value) => W.choose("split", value),
          )
        : null;
    const scale = W.buttons(
      "Probability axis",
      Object.entries({ linear: "linear", probit: "normal probability paper" }),
      W.chosen.scale,
      (value) => W.choose("scale", value),
    );
    W.fill(
      host,
      head,
      h("div.controls", split, scale),
      h("div.pair", W.histogram(set, output), W.distribution(set, output)),
      h("div.columns.three", quantiles(output, set), moments(output), byCase(F.name(output))),
    );
  }

  // The output chosen before, if this set has it; else the output of the worst requirement; else the first peak moment.
  W.defaultOutput = function () {
    const outputs = W.outputsOf(W.set());
    if (outputs.some((output) => output.name === W.chosen.output)) return W.chosen.output;
    const judged = W.verdicts
      .judged()
      .map((row) => row.requirement.output)
      .find((name) => outputs.some((output) => output.name === name));
    const first =
      outputs.find((output) => output.family === "peak_moment" && output.count) ||
      outputs.find((output) => output.count) ||
      outputs[0];
    return judged || (first ? first.name : null);
  };

  const host = h("div.output"),
    listHost = h("div");
  W.outputs = function () {
    if (W.onlyStudies) return;
    W.chosen.output = W.defaultOutput();
    W.fill(listHost, list());
    chosen(host);
    if (!host.isConnected)
      W.fill(
        W.section("outputs"),
        h(
          "p.lead",
          W.sets.every((set) => set.rows === false)
            ? W.withoutRows(W.set(), "A histogram by latch order")
            : "Colours show the latch order.",
          ` Nominal: the run with every dispersion at the median of its law${W.sets.length > 1 ? ` in its ${W.kindOfSets()}` : ""}.`,
          " Choose an output from the list.",
        ),
        listHost,
        host,
      );
  };
  W.on("output", function (name) {
    document
      .querySelectorAll(".pick")
      .forEach((button) => button.setAttribute("aria-pressed", String(button.dataset.output === name)));
    chosen(host);
    W.say(`${F.nameOf(name)} shown.`);
  });
  W.on("split", () => chosen(host));
  W.on("scale", () => chosen(host));
})();
