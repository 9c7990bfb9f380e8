// Convergence of the chosen output's statistics with the number of runs, and differences between sets.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;

  // A quantile is judged by the requirements' limits: they are lines if they are within twice the values' range.
  function limitsAt(set, output, key, values) {
    if (key === "mean") return { near: [], far: [] };
    const [low, high] = d3.extent(values.filter(W.isNumber)),
      room = 2 * (high - low) || Math.abs(high),
      { factor } = F.shown(output.unit);
    const limits = W.limits.of(set, output).map((one) => ({ at: one.value * factor, text: W.limits.text(one, output) }));
    const isNear = ({ at }) => at > low - room && at < high + room;
    return { near: limits.filter(isNear), far: limits.filter((one) => !isNear(one)) };
  }
  // From which number of runs on both bounds are known.
  function twoSided(rows) {
    const first = rows.find((row) => row.every(W.isNumber));
    if (!first) return "Too few runs for two-sided bounds.";
    return first === rows[0] ? null : `From ${F.runs(first[0])} on both bounds are known, before that only one.`;
  }
  function settling(set, output, key, text) {
    const one = output.convergence,
      { factor, unit } = F.shown(output.unit);
    const [lower, upper] = key === "mean" ? [one.lower, one.upper] : [one.quantile_lower, one.quantile_upper];
    const rows = one.runs.map((runs, at) =>
      [runs, one[key][at], lower[at], upper[at]].map((value, place) =>
        place && W.isNumber(value) ? value * factor : value,
      ),
    );
    if (!rows.some((row) => W.isNumber(row[1]))) return null;
    const last = rows[rows.length - 1],
      limits = limitsAt(set, output, key, rows.flatMap((row) => row.slice(1)));
    const notes = [
      twoSided(rows),
      ...limits.far.map((one) => `The limit ${one.text} ${unit} lies outside the picture.`),
    ].filter(Boolean);
    return W.figure({
      title: `${text} against runs: ${F.name(output)}`,
      class: "settling",
      printed: 440,
      note: notes.join(" ") || null,
      description: `At ${F.runs(last[0])}: ${F.number(last[1], 5)} ${unit}, bounds ${F.number(last[2], 5)} to ${F.number(last[3], 5)}.`,
      table: () => ({ columns: ["runs", `${text.toLowerCase()} ${unit}`, "lower", "upper"], rows }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          [
            { text: text.toLowerCase(), line: "var(--c0)" },
            rows.some((row) => W.isNumber(row[2]) || W.isNumber(row[3])) && {
              text: `${F.given(100 * set.confidence)} % two-sided bounds`,
              fill: "var(--c0)",
              opacity: 0.2,
            },
            limits.near.length && { text: "limit of a requirement", line: "var(--bad)" },
          ].filter(Boolean),
          width,
        );
        // The first quarter of the points may have very wide bounds, so only the others set the scale.
        const later = rows.slice(Math.floor(rows.length / 4)),
          y = M.linear(
            [...later.flatMap((row) => row.slice(1)), ...rows.map((row) => row[1]), ...limits.near.map((one) => one.at)],
            [0, 1],
            0.06,
          );
        const box = M.boxFor(y, width, top, 220, Math.max(14, M.textWidth(F.count(d3.max(rows, (row) => row[0])), 11.5) / 2 + 3));
        y.clamp(true);
        const span = d3.extent(rows, (row) => row[0]),
          x = d3.scaleLog(span[0] === span[1] ? [span[0] / 2, span[1] * 2] : span, [box.left, box.right]);
        const decades = d3
          .range(0, 10)
          .flatMap((k) => [1, 2, 5].map((m) => m * 10 ** k))
          .filter((value) => value >= x.domain()[0] && value <= x.domain()[1]);
        const kept = decades.length * 44 > width - box.left ? decades.filter((value) => /^1/.test(String(value))) : decades,
          end = x.domain()[1];
        M.axes(svg, box, x, y, {
          xText: "runs",
          yText: F.axis(text.toLowerCase(), unit),
          xValues: [...kept.filter((value) => x(end) - x(value) > 36), end], // the last run has a label always
          xFormat: F.count,
        });
        M.put(svg, "path.curve-band", {
          d: M.band(x, y)(rows.map((row) => [row[0], row[2], row[3]])),
          style: { fill: "var(--c0)" },
        });
        // Each bound has a line too: an area needs both.
        for (const side of [2, 3])
          M.put(svg, "path.bound", { d: M.line(x, y)(rows.map((row) => [row[0], row[side]])), style: { stroke: "var(--c0)" } });
        M.trace(svg, M.line(x, y)(rows.map((row) => row.slice(0, 2))), 0);
        for (const { at, text: words } of limits.near) {
          M.put(svg, "line.limit", { x1: box.left, x2: box.right, y1: y(at), y2: y(at) });
          M.put(svg, "text.limit-text", { x: box.right, y: y(at) - 4, "text-anchor": "end", text: `${words} ${unit}` });
        }
        return box.bottom + 40;
      },
    });
  }
  const host = h("div");
  function convergence() {
    const set = W.set(),
      output = W.output(set);
    if (!output || !output.convergence || (output.convergence.runs || []).length < 2)
      return W.fill(
        host,
        h(
          "p.nothing",
          output
            ? set.rows === false
              ? W.withoutRows(set, "Convergence")
              : `Too few runs of ${set.label} have a value of ${F.name(output)} to show convergence.`
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
        settling(set, output, "mean", "Mean"),
        settling(set, output, "quantile", W.isNumber(p) ? (p === 0.5 ? "Median" : `${F.level(p)} quantile`) : "Quantile"),
      ),
    );
  }
  W.convergence = function () {
    if (W.onlyStudies) return;
    convergence();
    if (!host.isConnected) W.fill(W.section("convergence"), host);
  };
  W.on("output", convergence);
})();
