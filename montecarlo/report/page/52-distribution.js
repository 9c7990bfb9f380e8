// The histogram, stacked by order of latching or overlaid by case, and the distribution function with its confidence band.
(function () {
  "use strict";
  const W = window.wingspread;
  const { format: F, marks: M } = W;

  // What both pictures mark: requirements' limits, and the nominal run.
  function marksOf(set, output, x, factor) {
    const lines = [];
    if (W.isNumber(output.nominal)) lines.push({ x: x(output.nominal * factor), text: "nominal", kind: "nominal" });
    const limits = new Set();
    for (const at of output.limits || []) {
      const one = set.requirements[at];
      if (!one || !W.isNumber(one.limit)) continue;
      for (const [limit, upper] of one.abs
        ? [
            [one.limit, true],
            [-one.limit, false],
          ]
        : [[one.limit, one.upper]])
        limits.add(`${limit} ${upper ? "≤" : "≥"}`);
    }
    for (const one of limits) {
      const [limit, sign] = one.split(" "),
        shown = Number((limit * factor).toPrecision(6));
      lines.push({ x: x(shown), text: `${sign} ${F.given(shown)}`, kind: "limit" });
    }
    return lines;
  }
  // Limits and the nominal are shown where they are near; a limit far away must not squeeze the picture.
  function reach(set, output, factor, edges) {
    const low = edges[0],
      high = edges[edges.length - 1],
      span = high - low || Math.abs(high) || 1;
    const marks = [
      output.nominal,
      ...(output.limits || []).map((at) => (set.requirements[at] || {}).limit),
      ...(output.limits || []).map((at) => (set.requirements[at] || {}).abs && -set.requirements[at].limit),
    ].filter(W.isNumber);
    return [low, high, ...marks.filter((value) => value > low - span && value < high + span)].map(
      (value) => value * factor,
    );
  }
  const overlaid = () =>
    W.chosen.split === "case" && W.sets.length > 1
      ? W.sets
          .map((set, at) => ({ set, at, output: W.output(set) }))
          .filter((one) => one.output && one.output.histogram && one.output.curve)
      : null;
  // What limits lie outside of the picture, in words.
  function beyond(set, output, factor, unit, edges) {
    const shown = d3.extent(reach(set, output, factor, edges));
    const far = (output.limits || [])
      .map((at) => set.requirements[at])
      .filter(
        (one) => one && W.isNumber(one.limit) && (one.limit * factor < shown[0] || one.limit * factor > shown[1]),
      );
    return far
      .map(
        (one) =>
          `The limit ${one.upper ? "≤" : "≥"} ${F.given(Number((one.limit * factor).toPrecision(6)))} ${unit} lies outside of the picture.`,
      )
      .join(" ");
  }

  W.histogram = function (set, output) {
    const { factor, unit } = F.shown(output.unit),
      cases = overlaid();
    const histogram = output.histogram,
      orders = set.orders || [];
    const known = (histogram.by_order || [])
      .map((counts, at) => ({
        at: M.ofOrder(set, at),
        counts,
        text: orders[at] ? F.order(orders[at].order) : `order ${at + 1}`,
      }))
      .filter((one) => d3.sum(one.counts) > 0);
    const rest = histogram.counts.map((count, bin) => count - d3.sum(known, (one) => one.counts[bin]));
    const layers = d3.sum(rest) > 0 ? [...known, { at: -1, counts: rest, text: "no hinge latched" }] : known;
    const table = () =>
      cases
        ? {
            columns: ["case", `from ${unit}`, `to ${unit}`, "runs"],
            rows: cases.flatMap(({ set: one, output: each }) =>
              each.histogram.counts.map((count, bin) => [
                one.label,
                each.histogram.edges[bin] * factor,
                each.histogram.edges[bin + 1] * factor,
                count,
              ]),
            ),
          }
        : {
            columns: [`from ${unit}`, `to ${unit}`, "runs", ...layers.map((one) => one.text)],
            rows: histogram.counts.map((count, bin) => [
              histogram.edges[bin] * factor,
              histogram.edges[bin + 1] * factor,
              count,
              ...layers.map((one) => one.counts[bin]),
            ]),
          };
    return W.figure({
      title: `Histogram: ${F.name(output)}`,
      table,
      printed: 440,
      class: "histogram",
      note: beyond(set, output, factor, unit, histogram.edges) || null,
      description: () =>
        `${F.runs(output.count)} from ${F.withUnit(output.min, output.unit)} to ${F.withUnit(output.max, output.unit)}, mean ${F.withUnit(output.mean, output.unit)}` +
        (cases
          ? `; overlaid with ${cases.map((one) => one.set.label).join(", ")}.`
          : `; by order of latching: ${layers.map((one) => `${one.text} ${d3.sum(one.counts)}`).join(", ")}.`),
      draw: (svg, width) =>
        cases
          ? drawCases(svg, width, cases, set, output, factor, unit)
          : drawStack(svg, width, layers, set, output, factor, unit),
    });
  };

  function boxOf(top, width, y, height = 250, format) {
    return { left: M.leftFor(y, format), right: width - 12, top: top + 18, bottom: top + height };
  }
  function drawStack(svg, width, layers, set, output, factor, unit) {
    const { edges, counts } = output.histogram,
      fill = M.hatches(svg, 7);
    const top = M.legend(
      svg,
      layers.map((one) => ({ text: one.text, fill: fill(one.at) })),
      width,
    );
    const y = d3.scaleLinear([0, d3.max(counts) * 1.06 || 1], [0, 1]),
      box = boxOf(top, width, y);
    y.range([box.bottom, box.top]);
    const x = M.linear(reach(set, output, factor, edges), [box.left, box.right]);
    M.axes(svg, box, x, y, {
      xText: `${F.name(output)}${unit ? ` (${unit})` : ""}`,
      yText: "runs in each bin",
      yFormat: (value) => (Number.isInteger(value) ? F.count(value) : ""),
    });
    const base = counts.map(() => 0);
    for (const layer of layers) {
      const group = svg.append("g").attr("class", "layer");
      layer.counts.forEach(function (count, bin) {
        if (count > 0) {
          const left = x(edges[bin] * factor),
            right = x(edges[bin + 1] * factor);
          group
            .append("rect")
            .attr("class", "bin")
            .attr("x", Math.min(left, right) + 0.25)
            .attr("width", Math.max(0.6, Math.abs(right - left) - 0.5))
            .attr("y", y(base[bin] + count))
            .attr("height", y(base[bin]) - y(base[bin] + count))
            .style("fill", fill(layer.at))
            .append("title")
            .text(
              `${layer.text}: ${F.runs(count)} from ${F.value(edges[bin], output.unit, F.grain(output))} to ${F.value(edges[bin + 1], output.unit, F.grain(output))} ${unit}`,
            );
          base[bin] += count;
        }
      });
    }
    M.uprights(svg, box, marksOf(set, output, x, factor));
    return box.bottom + 40;
  }
  // Shares in each case per unit of the axis, as outlines: their bins differ.
  function drawCases(svg, width, cases, set, output, factor, unit) {
    const top = M.legend(
      svg,
      cases.map((one) => ({ text: one.set.label, line: M.colour(one.at), dash: M.dash(one.at) })),
      width,
    );
    const density = (one) =>
      one.output.histogram.counts.map(
        (count, bin) =>
          count /
          one.output.count /
          (Math.abs(one.output.histogram.edges[bin + 1] - one.output.histogram.edges[bin]) * factor || 1),
      );
    const tall = d3.max(cases, (one) => d3.max(density(one))) || 1,
      y = d3.scaleLinear([0, tall * 1.06], [0, 1]);
    const box = boxOf(top, width, y);
    y.range([box.bottom, box.top]);
    const x = M.linear(
      [
        ...reach(set, output, factor, output.histogram.edges),
        ...cases.flatMap((one) => d3.extent(one.output.histogram.edges).map((value) => value * factor)),
      ],
      [box.left, box.right],
    );
    M.axes(svg, box, x, y, {
      xText: `${F.name(output)}${unit ? ` (${unit})` : ""}`,
      yText: `share of the runs per ${unit || "unit"}`,
    });
    for (const one of cases) {
      const { edges } = one.output.histogram,
        values = density(one);
      const points = [
        [edges[0], 0],
        ...values.flatMap((value, bin) => [
          [edges[bin], value],
          [edges[bin + 1], value],
        ]),
        [edges[edges.length - 1], 0],
      ];
      svg
        .append("path")
        .attr("class", "outline")
        .attr(
          "d",
          d3
            .line()
            .x((point) => x(point[0] * factor))
            .y((point) => y(point[1]))(points),
        )
        .style("stroke", M.colour(one.at))
        .style("fill", M.colour(one.at))
        .attr("stroke-dasharray", M.dash(one.at))
        .append("title")
        .text(one.set.label);
    }
    M.uprights(svg, box, marksOf(set, output, x, factor));
    return box.bottom + 40;
  }

  // The normal distribution's quantile function: Acklam's approximation, good to 1e-9, which a picture does not see.
  function probit(p) {
    const a = [
      -39.69683028665376, 220.9460984245205, -275.9285104469687, 138.357751867269, -30.66479806614716,
      2.506628277459239,
    ];
    const b = [-54.47609879822406, 161.5858368580409, -155.6989798598866, 66.80131188771972, -13.28068155288572];
    const c = [
      -0.007784894002430293, -0.3223964580411365, -2.400758277161838, -2.549732539343734, 4.374664141464968,
      2.938163982698783,
    ];
    const d = [0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416];
    const over = (row, t) => row.reduce((sum, one) => sum * t + one, 0);
    if (p < 0.02425) {
      const q = Math.sqrt(-2 * Math.log(p));
      return over(c, q) / (over(d, q) * q + 1);
    }
    if (p > 1 - 0.02425) return -probit(1 - p);
    const q = p - 0.5,
      r = q * q;
    return (over(a, r) * q) / (over(b, r) * r + 1);
  }
  const PAPER = [1e-6, 1e-5, 1e-4, 0.001, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 0.999, 1 - 1e-4, 1 - 1e-5, 1 - 1e-6];

  W.distribution = function (set, output) {
    const { factor, unit } = F.shown(output.unit),
      cases = overlaid() || [{ set, at: 0, output }];
    const band = output.curve.band;
    return W.figure({
      title: `Distribution function: ${F.name(output)}`,
      printed: 440,
      class: "distribution",
      note: band ? `Band: ${band}.` : null,
      description: () =>
        `The share of runs at or below each value, with its confidence band. ${(output.quantiles || []).map((one) => `${F.share(one.p)}: ${F.withUnit(one.value, output.unit, F.grain(output))}`).join("; ")}.`,
      table: () => ({
        columns: ["case", `value ${unit}`, "share at or below", "lower", "upper"],
        rows: cases.flatMap(({ set: one, output: each }) =>
          each.curve.x.map((value, at) => [
            one.label,
            value * factor,
            each.curve.p[at],
            each.curve.lower[at],
            each.curve.upper[at],
          ]),
        ),
      }),
      draw: (svg, width) => drawCurves(svg, width, cases, set, output, factor, unit),
    });
  };
  function drawCurves(svg, width, cases, set, output, factor, unit) {
    const paper = W.chosen.scale === "probit",
      several = cases.length > 1;
    const top = M.legend(
      svg,
      several
        ? cases.map((one) => ({ text: one.set.label, line: M.colour(one.at), dash: M.dash(one.at) }))
        : [
            { text: "runs", line: "var(--ink)" },
            { text: "confidence band", fill: "var(--c0)", opacity: 0.2 },
            ...((output.quantiles || []).length ? [{ text: "quantiles with bounds", mark: "var(--c5)" }] : []),
          ],
      width,
    );
    const smallest = 0.5 / d3.max(cases, (one) => one.output.count),
      clip = (p) => Math.min(1 - smallest, Math.max(smallest, p));
    const box = { left: paper ? 66 : 46, right: width - 12, top: top + 18, bottom: top + 250 };
    const y = d3.scaleLinear(paper ? [probit(smallest), probit(1 - smallest)] : [0, 1], [box.bottom, box.top]);
    const height = (p) => y(paper ? probit(clip(p)) : p);
    const x = M.linear(
      [
        ...reach(set, output, factor, output.histogram.edges),
        ...cases.flatMap((one) => d3.extent(one.output.curve.x).map((value) => value * factor)),
      ],
      [box.left, box.right],
    );
    M.axes(
      svg,
      box,
      x,
      y,
      paper
        ? {
            xText: `${F.name(output)}${unit ? ` (${unit})` : ""}`,
            yText: "share of the runs at or below",
            yValues: PAPER.filter((p) => p >= smallest && p <= 1 - smallest).map(probit),
            yFormat: (value) => `${tidy(PAPER.find((p) => Math.abs(probit(p) - value) < 1e-9))}`,
          }
        : {
            xText: `${F.name(output)}${unit ? ` (${unit})` : ""}`,
            yText: "share of the runs at or below",
            yFormat: (value) => `${Math.round(100 * value)} %`,
          },
    );
    for (const one of cases) {
      const curve = one.output.curve,
        colour = several ? M.colour(one.at) : null;
      // Of every run a step; of knots that stand for many runs a line from each to the next.
      const form = one.output.count > curve.x.length ? d3.curveLinear : d3.curveStepAfter;
      const rows = curve.x.map((value, at) => [value * factor, curve.lower[at], curve.upper[at]]);
      svg
        .append("path")
        .attr("class", "curve-band")
        .style("fill", colour || M.colour(0))
        .attr(
          "d",
          d3
            .area()
            .defined((row) => row.every(W.isNumber))
            .curve(form)
            .x((row) => x(row[0]))
            .y0((row) => height(row[1]))
            .y1((row) => height(row[2]))(rows),
        );
      svg
        .append("path")
        .attr("class", "curve")
        .style("stroke", colour)
        .attr("stroke-dasharray", several ? M.dash(one.at) : null)
        .attr(
          "d",
          d3
            .line()
            .curve(form)
            .x((row) => x(row[0]))
            .y((row) => height(row[1]))([
            ...(paper ? [] : [x.domain()[0], curve.x[0] * factor].map((value) => [value, 0])),
            ...curve.x.map((value, at) => [value * factor, curve.p[at]]),
            ...(paper ? [] : [curve.x[curve.x.length - 1] * factor, x.domain()[1]].map((value) => [value, 1])),
          ]),
        );
    }
    if (!several) quantileMarks(svg, output, x, height, factor);
    M.uprights(svg, box, Object.assign(marksOf(set, output, x, factor), { low: true })); // where the curve is not
    return box.bottom + 40;
  }
  const tidy = (p) =>
    p <= 0.5
      ? `${Number((100 * p).toPrecision(2))} %`
      : `${Number((100 - Number((100 * (1 - p)).toPrecision(2))).toFixed(4))} %`;
  function quantileMarks(svg, output, x, height, factor) {
    for (const one of output.quantiles || []) {
      if (!W.isNumber(one.value)) continue;
      if (W.isNumber(one.lower) && W.isNumber(one.upper))
        svg
          .append("line")
          .attr("class", "quantile-bounds")
          .attr("x1", x(one.lower * factor))
          .attr("x2", x(one.upper * factor))
          .attr("y1", height(one.p))
          .attr("y2", height(one.p));
      svg
        .append("circle")
        .attr("class", "quantile")
        .attr("cx", x(one.value * factor))
        .attr("cy", height(one.p))
        .attr("r", 3.5)
        .append("title")
        .text(`${F.share(one.p)}: ${F.withUnit(one.value, output.unit, F.grain(output))}`);
    }
  }
})();
