// How the statistics of the chosen output settled as runs were added, and how sets differ from each other.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M } = W;

  function settling(output, key, text) {
    const one = output.convergence,
      { factor, unit } = F.shown(output.unit);
    const lower = key === "mean" ? one.lower : one.quantile_lower,
      upper = key === "mean" ? one.upper : one.quantile_upper;
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
      note: rows.some((row) => row.every(W.isNumber)) ? null : "So few runs have no bounds on both sides.",
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
        // The first few runs' bounds may be very wide: the picture is scaled to what follows them.
        const later = rows.slice(Math.floor(rows.length / 4)),
          y = M.linear([...later.flatMap((row) => row.slice(1)), ...rows.map((row) => row[1])], [0, 1], 0.06);
        const box = { left: M.leftFor(y), right: width - 14, top: top + 18, bottom: top + 220 };
        y.range([box.bottom, box.top]).clamp(true);
        const span = d3.extent(rows, (row) => row[0]),
          x = d3.scaleLog(span[0] === span[1] ? [span[0] / 2, span[1] * 2] : span, [box.left, box.right]);
        const decades = d3
          .range(0, 10)
          .flatMap((k) => [1, 2, 5].map((m) => m * 10 ** k))
          .filter((value) => value >= x.domain()[0] && value <= x.domain()[1]);
        M.axes(svg, box, x, y, {
          xText: "runs",
          yText: `${text.toLowerCase()}${unit ? ` (${unit})` : ""}`,
          xValues:
            decades.length * 44 > width - box.left ? decades.filter((value) => /^1/.test(String(value))) : decades,
          xFormat: F.count,
        });
        svg
          .append("path")
          .attr("class", "curve-band")
          .style("fill", "var(--c0)")
          .attr("d", M.band(x, y)(rows.map((row) => [row[0], row[2], row[3]])));
        svg
          .append("path")
          .attr("class", "trace")
          .style("stroke", "var(--c0)")
          .attr("d", M.line(x, y)(rows.map((row) => row.slice(0, 2))));
        return box.bottom + 40;
      },
    });
  }
  const host = h("div", {});
  function convergence() {
    const set = W.set(),
      output = W.output(set);
    if (!output || !output.convergence || !(output.convergence.runs || []).length)
      return W.fill(
        host,
        h(
          "p",
          { class: "nothing" },
          output
            ? `Too few runs of ${set.label} have ${F.name(output)} to show how it settled.`
            : "There is no output to show.",
        ),
      );
    const p = output.convergence.quantile_p;
    W.fill(
      host,
      h(
        "p",
        { class: "lead" },
        `${F.name(output)}${W.sets.length > 1 ? `, ${set.label}` : ""}: what one would have said after fewer runs.`,
      ),
      h(
        "div",
        { class: "pair" },
        settling(output, "mean", "Mean"),
        settling(
          output,
          "quantile",
          W.isNumber(p) ? (p === 0.5 ? "Median" : `${F.share(p).replace(/\.0 /, " ")} quantile`) : "Quantile",
        ),
      ),
    );
  }
  W.convergence = function () {
    if (W.onlyStudies) return;
    convergence();
    if (!host.isConnected) W.fill(W.section("convergence"), host);
  };
  W.on("output", convergence);

  // Differences with intervals: one line for each output, relative to the first set's value where that is told.
  // Changes of a few per cent beside such of a thousand: linear about zero and logarithmic farther out.
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
    const figure = !drawn.length
      ? null
      : W.figure({
          title: `Change of the means: ${W.sets[j].label} against ${W.sets[i].label}`,
          class: "forest",
          note: `${comparison.paired ? "Paired: the draws are the same, so that only the change itself is uncertain." : "Not paired: the draws differ."}${rows.length > drawn.length ? ` The ${drawn.length} largest of ${rows.length} changes; all stand in the table.` : ""}`,
          description: () =>
            drawn
              .slice(0, 12)
              .map((one) => `${F.nameOf(one.output)} ${F.number(100 * one.relative, 3)} %`)
              .join("; "),
          table: () => ({
            columns: ["output", "difference", "lower", "upper", "relative"],
            rows: comparison.outputs.map((one) => [one.output, one.difference, one.lower, one.upper, one.relative]),
          }),
          draw: function (svg, width) {
            const left = Math.min(width * 0.4, Math.max(...drawn.map((one) => M.textWidth(F.nameOf(one.output)))) + 12),
              box = { left, right: width - 16, top: 6, bottom: 6 + 20 * drawn.length };
            const values = drawn.flatMap((one) => [
                0,
                100 * one.relative,
                relative(one.lower, one),
                relative(one.upper, one),
              ]),
              x = wideScale(values, [box.left, box.right]);
            M.axes(svg, box, x, null, { xText: "change of the mean (%)", xValues: x.wide });
            svg
              .append("line")
              .attr("class", "zero-line")
              .attr("x1", x(0))
              .attr("x2", x(0))
              .attr("y1", box.top)
              .attr("y2", box.bottom);
            drawn.forEach(function (one, at) {
              const y = box.top + 20 * (at + 0.5),
                low = relative(one.lower, one),
                high = relative(one.upper, one),
                sure = W.isNumber(one.lower) && one.lower * one.upper > 0;
              svg
                .append("text")
                .attr("x", left - 8)
                .attr("y", y)
                .attr("dy", "0.35em")
                .attr("text-anchor", "end")
                .text(M.shorten(F.nameOf(one.output), left - 8));
              if (W.isNumber(low))
                svg
                  .append("path")
                  .attr("class", "whisker")
                  .attr("d", `M${x(low)},${y}H${x(high)}M${x(low)},${y - 4}v8M${x(high)},${y - 4}v8`);
              svg
                .append("circle")
                .attr("class", sure ? "change sure" : "change")
                .attr("cx", x(100 * one.relative))
                .attr("cy", y)
                .attr("r", 4);
            });
            return box.bottom + 40;
          },
        });
    return figure;
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
    const unit = (name) => (W.sets.flatMap(W.outputsOf).find((one) => one.name === name) || {}).unit || "";
    const sign = (value, text) => (value > 0 ? `+${text}` : text);
    const rows = comparison.outputs.map((one) => [
      F.nameOf(one.output),
      F.shown(unit(one.output)).unit,
      W.isNumber(one.difference)
        ? sign(
            one.difference,
            F.value(
              one.difference,
              unit(one.output),
              W.isNumber(one.lower) ? (one.upper - one.lower) / 2 : Math.abs(one.difference) / 20,
            ),
          )
        : F.none,
      W.isNumber(one.lower)
        ? `${F.value(one.lower, unit(one.output), (one.upper - one.lower) / 2)} … ${F.value(one.upper, unit(one.output), (one.upper - one.lower) / 2)}`
        : "no bounds",
      W.isNumber(one.relative) ? sign(one.relative, `${F.sized(100 * one.relative, relativeSpread(one))} %`) : F.none,
    ]);
    return h(
      "details",
      { class: "later", open },
      h("summary", {}, comparison.text),
      h(
        "div",
        { class: "wide-pair" },
        forest(comparison),
        h(
          "div",
          {},
          W.table(
            `Differences of the means: ${comparison.text}`,
            [
              { text: "Output" },
              { text: "Unit" },
              { text: "Difference", kind: "number" },
              { text: "Bounds", kind: "number" },
              { text: "Relative", kind: "number" },
            ],
            rows,
            { class: "tall" },
          ),
          statuses.length
            ? W.table(
                `Differences of the outcomes: ${comparison.text}`,
                [
                  { text: "Outcome" },
                  { text: "Difference", kind: "number" },
                  { text: "Bounds, percentage points", kind: "number" },
                ],
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
              "p",
              { class: "lead" },
              "Differences with their confidence intervals; a filled point: the interval leaves out zero. “By case, overlaid” above lays the distributions over each other.",
            ),
            comparisons.map((one, at) => compared(one, at < 2)),
          ]
        : h("p", { class: "nothing" }, "These folders have no output in common."),
    );
  };
})();
