// Convergence of the chosen output's statistics with the number of runs, and differences between sets.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;

  function settling(output, key, text) {
    const one = output.convergence,
      { factor, unit } = F.shown(output.unit);
    const [lower, upper] = key === "mean" ? [one.lower, one.upper] : [one.quantile_lower, one.quantile_upper];
    const rows = one.runs.map((runs, at) =>
      [runs, one[key][at], lower[at], upper[at]].map((value, place) =>
        place && W.isNumber(value) ? value * factor : value,
      ),
    );
    if (!rows.some((row) => W.isNumber(row[1]))) return null;
    const last = rows[rows.length - 1];
    return W.figure({
      title: `${text} against runs: ${F.name(output)}`,
      class: "settling",
      printed: 440,
      note: rows.some((row) => row.every(W.isNumber)) ? null : "Too few runs for two-sided bounds.",
      description: `At ${F.runs(last[0])}: ${F.number(last[1], 5)} ${unit}, bounds ${F.number(last[2], 5)} to ${F.number(last[3], 5)}.`,
      table: () => ({ columns: ["runs", `${text.toLowerCase()} ${unit}`, "lower", "upper"], rows }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          [
            { text: text.toLowerCase(), line: "var(--c0)" },
            { text: "bounds", fill: "var(--c0)", opacity: 0.2 },
          ],
          width,
        );
        // The first quarter of the points may have very wide bounds, so only the others set the scale.
        const later = rows.slice(Math.floor(rows.length / 4)),
          y = M.linear([...later.flatMap((row) => row.slice(1)), ...rows.map((row) => row[1])], [0, 1], 0.06);
        const box = M.boxFor(y, width, top, 220, 14);
        y.clamp(true);
        const span = d3.extent(rows, (row) => row[0]),
          x = d3.scaleLog(span[0] === span[1] ? [span[0] / 2, span[1] * 2] : span, [box.left, box.right]);
        const decades = d3
          .range(0, 10)
          .flatMap((k) => [1, 2, 5].map((m) => m * 10 ** k))
          .filter((value) => value >= x.domain()[0] && value <= x.domain()[1]);
        M.axes(svg, box, x, y, {
          xText: "runs",
          yText: F.axis(text.toLowerCase(), unit),
          xValues:
            decades.length * 44 > width - box.left ? decades.filter((value) => /^1/.test(String(value))) : decades,
          xFormat: F.count,
        });
        M.put(svg, "path.curve-band", {
          d: M.band(x, y)(rows.map((row) => [row[0], row[2], row[3]])),
          style: { fill: "var(--c0)" },
        });
        M.trace(svg, M.line(x, y)(rows.map((row) => row.slice(0, 2))), 0);
        return box.bottom + 40;
      },
    });
  }
  const host = h("div");
  function convergence() {
    const set = W.set(),
      output = W.output(set);
    if (!output || !output.convergence || !(output.convergence.runs || []).length)
      return W.fill(
        host,
        h(
          "p.nothing",
          output
            ? `Too few runs of ${set.label} have a value of ${F.name(output)} to show convergence.`
            : "There is no output to show.",
        ),
      );
    const p = output.convergence.quantile_p;
    W.fill(
      host,
      h(
        "p.lead",
        `${F.name(output)}${W.sets.length > 1 ? `, ${set.label}` : ""}: the estimate after each number of runs.`,
      ),
      h(
        "div.pair",
        settling(output, "mean", "Mean"),
        settling(output, "quantile", W.isNumber(p) ? (p === 0.5 ? "Median" : `${F.level(p)} quantile`) : "Quantile"),
      ),
    );
  }
  W.convergence = function () {
    if (W.onlyStudies) return;
    convergence();
    if (!host.isConnected) W.fill(W.section("convergence"), host);
  };
  W.on("output", convergence);

  // Changes in per cent: linear up to 40 %; beyond, linear about zero and logarithmic farther out (symlog), so that changes of
  // 2 % and of 1000 % are visible together. The limit of 40 % is heuristic; a lower one makes more axes logarithmic.
  function wideScale(values, range) {
    const known = values.filter(W.isNumber),
      far = d3.max(known, Math.abs) || 0;
    if (far < 40) return M.linear(values, range);
    const [low, high] = d3.extent(known),
      x = d3
        .scaleSymlog()
        .constant(2)
        .domain([low < 0 ? 1.3 * low : 0.7 * low, high > 0 ? 1.3 * high : 0.7 * high])
        .range(range);
    x.wide = [-10000, -1000, -100, -10, 0, 10, 100, 1000, 10000].filter(
      (value) => value >= x.domain()[0] && value <= x.domain()[1],
    );
    return x;
  }
  function forest(comparison) {
    const rows = comparison.outputs.filter((one) => W.isNumber(one.difference)),
      [i, j] = comparison.sets;
    const relative = (value, one) =>
      W.isNumber(value) && W.isNumber(one.relative) && one.difference !== 0
        ? (100 * value * one.relative) / one.difference
        : null;
    const drawn = rows
      .filter((one) => W.isNumber(one.relative))
      .sort((a, b) => Math.abs(b.relative) - Math.abs(a.relative))
      .slice(0, 24);
    return !drawn.length
      ? null
      : W.figure({
          title: `Change of the means: ${W.sets[j].label} against ${W.sets[i].label}`,
          class: "forest",
          note: `${comparison.paired ? `Paired over the ${F.count(comparison.runs)} runs of both sets with the same draws, so scatter between runs cancels. An output's difference goes over those of them that have it in both sets.` : "Not paired: the sets have different draws."}${rows.length > drawn.length ? ` The picture has the ${drawn.length} largest of ${rows.length} changes; the table has all.` : ""}`,
          description: () =>
            drawn
              .slice(0, 12)
              .map((one) => `${F.nameOf(one.output)} ${F.number(100 * one.relative, 3)} %`)
              .join("; "),
          table: () => ({
            columns: ["output", "difference", "lower", "upper", "relative", "runs"],
            rows: comparison.outputs.map((one) => [
              one.output,
              one.difference,
              one.lower,
              one.upper,
              one.relative,
              one.runs,
            ]),
          }),
          draw: function (svg, width) {
            const left = M.labelRoom(
                width,
                0.4,
                drawn.map((one) => F.nameOf(one.output)),
              ),
              box = { left, right: width - 16, top: 6, bottom: 6 + 20 * drawn.length };
            const values = drawn.flatMap((one) => [
                0,
                100 * one.relative,
                relative(one.lower, one),
                relative(one.upper, one),
              ]),
              x = wideScale(values, [box.left, box.right]);
            M.axes(svg, box, x, null, { xText: "change of the mean (%)", xValues: x.wide });
            M.upright(svg, "line.zero-line", x(0), box);
            drawn.forEach(function (one, at) {
              const y = box.top + 20 * (at + 0.5),
                low = relative(one.lower, one),
                high = relative(one.upper, one),
                sure = W.isNumber(one.lower) && one.lower * one.upper > 0;
              M.rowLabel(svg, F.nameOf(one.output), left, y);
              if (W.isNumber(low)) M.whisker(svg, x, low, high, y, 4);
              M.put(svg, "circle", { class: sure ? "change sure" : "change", cx: x(100 * one.relative), cy: y, r: 4 });
            });
            return box.bottom + 40;
          },
        });
  }
  const relativeSpread = (one) =>
    W.isNumber(one.lower) && one.difference !== 0
      ? Math.abs((50 * (one.upper - one.lower) * one.relative) / one.difference)
      : Math.abs(one.relative);
  function compared(comparison, open) {
    const statuses = (comparison.statuses || []).filter(
      (one) =>
        one.difference !== 0 ||
        W.sets[comparison.sets[0]].statuses.some((each) => each.status === one.status && each.count),
    );
    const sign = (value, text) => (value > 0 ? `+${text}` : text);
    const rows = comparison.outputs.map(function (one) {
      const unit = F.unitOf(one.output),
        half = W.isNumber(one.lower) ? (one.upper - one.lower) / 2 : null,
        value = (number) => F.value(number, unit, half || Math.abs(one.difference) / 20);
      return [
        F.nameOf(one.output),
        F.shown(unit).unit,
        W.isNumber(one.difference) ? sign(one.difference, value(one.difference)) : F.none,
        W.isNumber(one.lower) ? `${value(one.lower)} … ${value(one.upper)}` : "no bounds",
        W.isNumber(one.relative) ? sign(one.relative, `${F.sized(100 * one.relative, relativeSpread(one))} %`) : F.none,
        F.count(one.runs),
      ];
    });
    return h(
      "details.later",
      { open },
      h("summary", comparison.text),
      h(
        "div.wide-pair",
        forest(comparison),
        h(
          "div",
          W.table(
            `Differences of the means: ${comparison.text}`,
            ["Output", "Unit", number("Difference"), number("Bounds"), number("Relative"), number("Runs")],
            rows,
            { class: "tall" },
          ),
          statuses.length
            ? W.table(
                `Differences of the outcomes: ${comparison.text}`,
                ["Outcome", number("Difference"), number("Bounds, percentage points")],
                statuses.map((one) => [
                  one.status.replace("_", " "),
                  `${sign(one.difference, F.fixed(100 * one.difference, 2))} points`,
                  W.isNumber(one.lower)
                    ? `${F.fixed(100 * one.lower, 2)} … ${F.fixed(100 * one.upper, 2)}`
                    : "no bounds",
                ]),
              )
            : null,
        ),
      ),
    );
  }
  W.comparison = function () {
    const comparisons = W.data.comparisons || [],
      section = document.getElementById("comparison");
    section.hidden = W.sets.length < 2;
    if (section.hidden) return;
    W.fill(
      W.section("comparison"),
      comparisons.length
        ? [
            h(
              "p.lead",
              "Differences with confidence intervals. Filled point: the interval excludes zero. “By case, overlaid” above compares the distributions.",
            ),
            comparisons.map((one, at) => compared(one, at < 2)),
          ]
        : h("p.nothing", "No set has a partner to compare with."),
      (W.data.unpaired || []).length ? h("p.note", `Without a partner: ${W.data.unpaired.join("; ")}.`) : null,
    );
  };
})();
