// Every output: a list to search and choose from, with a small histogram each; the chosen one's pictures and numbers beside it.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F } = W;

  // A histogram as small as a word.
  function spark(output) {
    const svg = d3
      .create("svg")
      .attr("class", "spark")
      .attr("viewBox", "0 0 84 18")
      .attr("width", 84)
      .attr("height", 18)
      .attr("aria-hidden", "true");
    const histogram = output.histogram;
    if (W.isNumber(output.min) && output.min === output.max)
      return W.h("span", { class: "faint" }, output.count === 1 ? "one value" : "one value always");
    if (histogram && histogram.counts.length) {
      const { edges, counts } = histogram,
        x = d3.scaleLinear([edges[0], edges[edges.length - 1]], [0, 84]),
        y = d3.scaleLinear([0, d3.max(counts)], [0, 17]);
      svg
        .append("path")
        .attr(
          "d",
          counts
            .map(
              (count, at) =>
                `M${x(edges[at]).toFixed(1)},18v${(-y(count)).toFixed(1)}H${x(edges[at + 1]).toFixed(1)}V18`,
            )
            .join("") + "Z",
        );
      if (W.isNumber(output.nominal) && output.nominal >= edges[0] && output.nominal <= edges[edges.length - 1])
        svg.append("line").attr("x1", x(output.nominal)).attr("x2", x(output.nominal)).attr("y1", 0).attr("y2", 18);
    }
    return svg.node();
  }

  function worstVerdict(set, output) {
    const verdicts = (output.limits || [])
      .map((at) => set.requirements[at])
      .filter(Boolean)
      .map((one) => W.verdicts.verdictOf(one.verdict));
    return ["failed", "open", "passed"].find((verdict) => verdicts.includes(verdict));
  }

  let filter = "";
  function list() {
    const set = W.set(),
      outputs = W.outputsOf(set);
    const levels = [...new Set(outputs.flatMap((output) => (output.quantiles || []).map((one) => one.p)))].sort(
      d3.ascending,
    );
    const shownLevels =
      levels.length > 5 ? [levels[0], levels[Math.floor(levels.length / 2)], levels[levels.length - 1]] : levels;
    const columns = [
      { text: "Output" },
      { text: "Unit" },
      { text: "Runs", kind: "number" },
      { text: "Distribution" },
      { text: "Nominal", kind: "number" },
      { text: "Mean", kind: "number" },
      { text: "Std", kind: "number" },
      ...shownLevels.map((p) => ({ text: p === 0.5 ? "Median" : F.share(p).replace(/\.0 /, " "), kind: "number" })),
    ];
    const rows = outputs.map(function (output) {
      const verdict = worstVerdict(set, output),
        grain = F.grain(output),
        value = (number) => F.value(number, output.unit, grain);
      const button = h(
        "button",
        {
          type: "button",
          class: "pick",
          "data-output": output.name,
          "aria-pressed": String(output.name === W.chosen.output),
          onclick: () => W.choose("output", output.name),
        },
        F.name(output),
      );
      return {
        mark: output.count ? null : "zero",
        cells: [
          h("span", {}, button, verdict ? [" ", W.badge(verdict, true)] : null),
          F.shown(output.unit).unit,
          F.count(output.count),
          output.count ? spark(output) : "in no run",
          value(output.nominal),
          value(output.mean),
          F.value(output.std, output.unit, output.std),
          ...shownLevels.map((p) => value(((output.quantiles || []).find((one) => one.p === p) || {}).value)),
        ],
      };
    });
    const table = W.table(`Outputs of ${set.label}`, columns, rows, { class: "outputs" });
    table.addEventListener("keydown", byArrows);
    const found = h("span", { class: "faint", role: "status" });
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
    return [h("div", { class: "controls" }, h("label", { class: "search" }, "Search ", search), found), table];
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
    const rows = (output.quantiles || []).map((one) => [
      one.p === 0.5 ? "median" : F.share(one.p).replace(/\.0 /, " "),
      F.value(one.value, output.unit, F.grain(output)),
      bounds(one, (value) => F.value(value, output.unit, F.grain(output))),
    ]);
    for (const one of output.tolerance_limits || [])
      rows.push([
        `tolerance: ${one.text}`,
        [one.lower, one.upper]
          .filter(W.isNumber)
          .map((value) => F.value(value, output.unit, F.grain(output)))
          .join(" … ") || F.none,
        "",
      ]);
    return W.table(
      `Quantiles of ${F.name(output)}`,
      [
        { text: "Quantile" },
        { text: "Value", unit: F.shown(output.unit).unit, kind: "number" },
        { text: `${100 * set.confidence} % bounds`, kind: "number" },
      ],
      rows,
      { showCaption: true },
    );
  }
  function moments(output) {
    const value = (number) => F.withUnit(number, output.unit, F.grain(output));
    const rows = [
      ["runs that have it", F.count(output.count)],
      ["runs without", F.count(output.missing)],
      ["nominal run", W.isNumber(output.nominal) ? value(output.nominal) : "did not happen"],
      ["mean", value(output.mean)],
      ["its standard error", F.withUnit(output.mean_error, output.unit, output.mean_error)],
      ["standard deviation", F.withUnit(output.std, output.unit, output.std)],
      ["least", value(output.min)],
      ["largest", value(output.max)],
      ["skewness", F.fixed(output.skewness, 2)],
      ["kurtosis", F.fixed(output.kurtosis, 2)],
    ];
    return W.table(`Moments of ${F.name(output)}`, [{ text: "Statistic" }, { text: "Value", kind: "number" }], rows, {
      showCaption: true,
    });
  }
  // By case: the quantiles of the chosen output, side by side.
  function byCase(name) {
    const found = W.sets.map((set) => ({ set, output: W.output(set) })).filter((one) => one.output);
    if (found.length < 2) return null;
    const levels = [...new Set(found.flatMap((one) => (one.output.quantiles || []).map((q) => q.p)))].sort(
      d3.ascending,
    );
    const unit = found[0].output.unit,
      missing = found.some((one) => one.output.missing);
    return W.table(
      `${name} by case`,
      [
        { text: "Case" },
        { text: "Nominal", unit: F.shown(unit).unit, kind: "number" },
        { text: "Mean", kind: "number" },
        ...levels.map((p) => ({ text: p === 0.5 ? "Median" : F.share(p).replace(/\.0 /, " "), kind: "number" })),
        ...(missing ? [{ text: "Missing", kind: "number" }] : []),
      ],
      found.map(({ set, output }) => [
        set.label,
        F.value(output.nominal, unit, F.grain(output)),
        F.value(output.mean, unit, F.grain(output)),
        ...levels.map((p) =>
          F.value(((output.quantiles || []).find((q) => q.p === p) || {}).value, unit, F.grain(output)),
        ),
        ...(missing ? [F.count(output.missing)] : []),
      ]),
      { showCaption: true },
    );
  }

  function glossaryText(output) {
    const known = W.data.glossary || {},
      stem = output.hinge ? `HINGE.${output.name.slice(output.hinge.length + 1)}` : output.name;
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
          {},
          W.outputsOf(set).length
            ? `${F.nameOf(W.chosen.output || "")} is not among the outputs of ${set.label}.`
            : "The campaign recorded no outputs.",
        ),
      );
    const text = glossaryText(output);
    const title = h("h3", { class: "chosen" }, F.name(output), " ", h("code", {}, output.name));
    const limits = (output.limits || [])
      .map((at) => set.requirements[at])
      .filter(Boolean)
      .map((one) => h("li", {}, W.badge(one.verdict), " ", one.text));
    const head = [
      title,
      text ? h("p", { class: "note" }, text) : null,
      limits.length ? h("ul", { class: "plain" }, limits) : null,
    ];
    if (!output.count || !output.histogram)
      return W.fill(
        host,
        head,
        h("p", { class: "nothing" }, `This did not happen in any run of ${set.label}.`),
        byCase(F.name(output)),
      );
    const split =
      W.sets.length > 1
        ? W.buttons(
            "Colour",
            [
              ["order", "by order of latching"],
              ["case", "by case, overlaid"],
            ],
            W.chosen.split,
            (value) => W.choose("split", value),
          )
        : null;
    const scale = W.buttons(
      "Probability axis",
      [
        ["linear", "linear"],
        ["probit", "normal paper"],
      ],
      W.chosen.scale,
      (value) => W.choose("scale", value),
    );
    W.fill(
      host,
      head,
      h("div", { class: "controls" }, split, scale),
      h("div", { class: "pair" }, W.histogram(set, output), W.distribution(set, output)),
      h("div", { class: "columns three" }, quantiles(output, set), moments(output), byCase(F.name(output))),
    );
  }

  // Of a new set the output chosen before stays, if it has it; else the one whose requirement is worst.
  W.defaultOutput = function () {
    const outputs = W.outputsOf(W.set());
    if (outputs.some((output) => output.name === W.chosen.output)) return W.chosen.output;
    const judged = W.verdicts
      .judged()
      .map((row) => row.requirement.output)
      .find((name) => outputs.some((output) => output.name === name));
    return (
      judged ||
      (
        outputs.find((output) => output.family === "peak_moment" && output.count) ||
        outputs.find((output) => output.count) ||
        outputs[0] ||
        {}
      ).name ||
      null
    );
  };

  const host = h("div", { class: "output" }),
    listHost = h("div", {});
  W.outputs = function () {
    if (W.onlyStudies) return;
    W.chosen.output = W.defaultOutput();
    W.fill(listHost, list());
    chosen(host);
    if (!host.isConnected)
      W.fill(
        W.section("outputs"),
        h(
          "p",
          { class: "lead" },
          "Colours show in which order the hinges latched: separate humps of a distribution are, as a rule, different orders. Choose an output from the list.",
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
