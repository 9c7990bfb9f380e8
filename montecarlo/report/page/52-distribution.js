// The histogram, stacked by latch order or overlaid by case, and the distribution function with its confidence band.
(function () {
  "use strict";
  const W = window.wingspread;
  const { format: F, marks: M } = W;

  // The limits of the requirements on an output, each once, as { value (SI), upper }; |output| has two: |x| ≤ 3 is
  // x ≤ 3 and x ≥ −3, and |x| ≥ 3 is x ≥ 3 or x ≤ −3.
  function limitsOf(set, output) {
    const found = (output.limits || [])
      .map((at) => set.requirements[at])
      .filter((one) => one && W.isNumber(one.limit))
      .flatMap((one) => {
        const limit = { value: one.limit, upper: one.upper };
        return one.abs ? [limit, { value: -one.limit, upper: !one.upper }] : [limit];
      });
    return [...new Map(found.map((one) => [`${one.value} ${one.upper}`, one])).values()];
  }
  const limitText = (limit, output) => `${limit.upper ? "≤" : "≥"} ${F.limit(limit.value, output)}`;

  W.limits = { of: limitsOf, text: limitText };

  // The data of both pictures: the chosen output in the displayed unit, and the overlaid cases.
  // `reach` has the values that the x axis must contain: the ends of the histogram, and the nominal run and those limits
  // that lie within one range of it. A limit further away would squeeze the picture; `beyond` has these limits.
  function viewOf(set, output) {
    const edges = output.histogram.edges,
      [low, high] = d3.extent(edges),
      span = high - low || Math.abs(high) || 1;
    const isNear = (value) => W.isNumber(value) && value > low - span && value < high + span;
    const limits = limitsOf(set, output),
      { factor, unit } = F.shown(output.unit);
    const cases =
      W.chosen.split === "case" && W.sets.length > 1
        ? W.sets
            .map((one, at) => ({ set: one, at, output: W.output(one) }))
            .filter((one) => one.output && one.output.histogram && one.output.curve)
        : null;
    const near = [low, high, output.nominal, ...limits.map((one) => one.value)].filter(isNear);
    return {
      ...{ set, output, factor, unit, cases, limits },
      reach: near.map((value) => value * factor),
      beyond: limits.filter((one) => !isNear(one.value)),
      axis: F.axis(F.name(output), unit),
    };
  }
  const scaled = (values, view) => values.map((value) => value * view.factor);
  const caseLegend = (cases) =>
    M.lineItems(
      cases,
      (one) => one.set.label,
      (one) => one.at,
    );
  function drawMarks(svg, box, view, x, low) {
    const nominal = view.output.nominal * view.factor;
    const lines = view.limits.map((one) => ({
      x: x(one.value * view.factor),
      text: limitText(one, view.output),
      kind: "limit",
    }));
    if (W.isNumber(view.output.nominal)) lines.unshift({ x: x(nominal), text: view.cases ? `nominal, ${view.set.label}` : "nominal", kind: "nominal" });
    M.uprights(svg, box, lines, low);
  }

  // The runs of each bin by latch order; the last layer holds the runs in which no hinge latched.
  function layersOf(set, histogram) {
    if (set.rows === false) return [{ at: 0, counts: histogram.counts, text: "all runs" }];
    const orders = set.orders || [];
    const known = (histogram.by_order || [])
      .map((counts, at) => ({
        at: M.ofOrder(set, at),
        counts,
        text: orders[at] ? F.order(orders[at].order) : `order ${at + 1}`,
      }))
      .filter((one) => d3.sum(one.counts) > 0);
    const rest = histogram.counts.map((count, bin) => count - d3.sum(known, (one) => one.counts[bin]));
    return d3.sum(rest) > 0 ? [...known, { at: -1, counts: rest, text: "no hinge latched" }] : known;
  }

  W.histogram = function (set, output) {
    const view = viewOf(set, output),
      { cases, factor, unit } = view,
      layers = layersOf(set, output.histogram);
    const bins = ({ edges, counts }, row) =>
      counts.map((count, bin) => row(edges[bin] * factor, edges[bin + 1] * factor, count, bin));
    const value = (number) => F.withUnit(number, output.unit);
    return W.figure({
      title: `Histogram: ${F.name(output)}`,
      printed: 440,
      class: "histogram",
      note:
        view.beyond.map((one) => `The limit ${limitText(one, output)} ${unit} lies outside the picture.`).join(" ") ||
        null,
      description: () =>
        `${F.runs(output.count)} from ${value(output.min)} to ${value(output.max)}, mean ${value(output.mean)}; ` +
        (cases
          ? `overlaid with ${cases.map((one) => one.set.label).join(", ")}.`
          : `${set.rows === false ? "" : "by latch order: "}${layers.map((one) => `${one.text} ${d3.sum(one.counts)}`).join(", ")}.`),
      table: () =>
        cases
          ? {
              columns: [W.kindOfSets(), `from ${unit}`, `to ${unit}`, "runs"],
              rows: cases.flatMap((one) =>
                bins(one.output.histogram, (from, to, count) => [one.set.label, from, to, count]),
              ),
            }
          : {
              columns: [`from ${unit}`, `to ${unit}`, "runs", ...layers.map((one) => one.text)],
              rows: bins(output.histogram, (from, to, count, bin) => [
                from,
                to,
                count,
                ...layers.map((one) => one.counts[bin]),
              ]),
            },
      draw: (svg, width) => (cases ? drawCases(svg, width, view) : drawStack(svg, width, view, layers)),
    });
  };

  function drawStack(svg, width, view, layers) {
    const { output, factor, unit } = view,
      { edges, counts } = output.histogram;
    const top = M.legend(
      svg,
      layers.map((one) => ({ text: one.text, fill: M.colour(one.at), hatch: one.at })),
      width,
    );
    const y = d3.scaleLinear([0, d3.max(counts) * 1.06 || 1], [0, 1]),
      box = M.boxFor(y, width, top, 250);
    const x = M.linear(view.reach, [box.left, box.right]);
    const value = (edge) => F.value(edge, output.unit, F.grain(output));
    M.axes(svg, box, x, y, {
      xText: view.axis,
      yText: "runs in each bin",
      yFormat: (tick) => (Number.isInteger(tick) ? F.count(tick) : ""),
    });
    const base = counts.map(() => 0);
    for (const layer of layers) {
      const group = M.put(svg, "g.layer"),
        boxes = [];
      layer.counts.forEach(function (count, bin) {
        if (count <= 0) return;
        const left = x(edges[bin] * factor),
          right = x(edges[bin + 1] * factor);
        const bar = {
          x: Math.min(left, right) + 0.25,
          y: y(base[bin] + count),
          width: Math.max(0.6, Math.abs(right - left) - 0.5),
          height: y(base[bin]) - y(base[bin] + count),
        };
        M.put(group, "rect.bin", {
          ...bar,
          style: { fill: M.colour(layer.at) },
          title: `${layer.text}: ${F.runs(count)} from ${value(edges[bin])} to ${value(edges[bin + 1])} ${unit}`,
        });
        boxes.push(Object.values(bar));
        base[bin] += count;
      });
      M.hatch(group, layer.at, boxes);
    }
    drawMarks(svg, box, view, x);
    return box.bottom + 40;
  }
  // Densities by case as outlines: the cases' bins differ, so counts do not compare.
  function drawCases(svg, width, view) {
    const top = M.legend(svg, caseLegend(view.cases), width);
    const outlines = view.cases.map(function (one) {
      const { counts } = one.output.histogram,
        edges = scaled(one.output.histogram.edges, view);
      const density = counts.map(
        (count, bin) => count / one.output.count / (Math.abs(edges[bin + 1] - edges[bin]) || 1),
      );
      const tops = density.flatMap((value, bin) => [
        [edges[bin], value],
        [edges[bin + 1], value],
      ]);
      return { ...one, points: [[edges[0], 0], ...tops, [edges[edges.length - 1], 0]] };
    });
    const tall = d3.max(outlines, (one) => d3.max(one.points, (point) => point[1])) || 1,
      y = d3.scaleLinear([0, tall * 1.06], [0, 1]),
      box = M.boxFor(y, width, top, 250);
    const ends = outlines.flatMap((one) => d3.extent(one.points, (point) => point[0])),
      x = M.linear([...view.reach, ...ends], [box.left, box.right]);
    M.axes(svg, box, x, y, { xText: view.axis, yText: `share of the runs ${view.cases.some((one) => one.output.missing) ? "with a value " : ""}per ${view.unit || "unit"}` });
    for (const one of outlines)
      M.put(svg, "path.outline", {
        d: M.line(x, y)(one.points),
        "stroke-dasharray": M.dash(one.at),
        style: { stroke: M.colour(one.at), fill: M.colour(one.at) },
        title: one.set.label,
      });
    drawMarks(svg, box, view, x);
    return box.bottom + 40;
  }

  // The quantile function of the normal distribution: P. J. Acklam's rational approximation (2003), relative error < 1.15e-9.
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
  const paperText = (p) => `${Number((100 * p).toPrecision(p <= 0.5 ? 2 : 7))} %`;

  W.distribution = function (set, output) {
    const view = viewOf(set, output),
      { factor, unit } = view,
      cases = view.cases || [{ set, at: 0, output }];
    const { band } = output.curve,
      // The curve is over the runs with a value, and so are the quantiles on it.
      quantiles = (output.quantiles || []).map((one) => ({ ...one, ...one.among })).filter((one) => W.isNumber(one.value));
    const text = (one) => `${F.level(one.p)}: ${F.withUnit(one.value, output.unit, F.grain(output))}`,
      partly = cases.filter((one) => one.output.missing).map((one) => `${F.count(one.output.count)} of ${F.runs(one.set.runs)}${cases.length > 1 ? ` of ${one.set.label}` : ""}`);
    return W.figure({
      title: `Distribution function: ${F.name(output)}`,
      printed: 440,
      class: "distribution",
      note:
        [
          partly.length ? `Over the runs that have a value, ${W.verdicts.listed(partly)}; quantiles over all runs are in the table.` : null,
          band ? `Band: ${band}.` : null,
        ]
          .filter(Boolean)
          .join(" ") || null,
      description: () =>
        `The share of ${partly.length ? "the runs with a value" : "runs"} at or below each value, with its confidence band. ${quantiles.map(text).join("; ")}.`,
      table: () => ({
        columns: [W.kindOfSets(), `value ${unit}`, "share at or below", "lower", "upper"],
        rows: cases.flatMap(({ set: one, output: { curve } }) =>
          curve.x.map((value, at) => [one.label, value * factor, curve.p[at], curve.lower[at], curve.upper[at]]),
        ),
      }),
      draw: (svg, width) => drawCurves(svg, width, view, cases, quantiles, text),
    });
  };
  function drawCurves(svg, width, view, cases, quantiles, text) {
    const paper = W.chosen.scale === "probit",
      several = cases.length > 1;
    const own = [
      { text: cases[0].output.missing ? "runs with a value" : "runs", line: "var(--ink)" },
      { text: "confidence band", fill: "var(--c0)", opacity: 0.2 },
      ...(quantiles.length ? [{ text: cases[0].output.missing ? "their quantiles with bounds" : "quantiles with bounds", mark: "var(--c5)" }] : []),
    ];
    const top = M.legend(svg, several ? caseLegend(cases) : own, width);
    const smallest = 0.5 / d3.max(cases, (one) => one.output.count),
      clip = (p) => Math.min(1 - smallest, Math.max(smallest, p));
    const box = { left: paper ? 66 : 46, right: width - 12, top: top + 18, bottom: top + 250 };
    const y = d3.scaleLinear(paper ? [probit(smallest), probit(1 - smallest)] : [0, 1], [box.bottom, box.top]);
    const height = (p) => y(paper ? probit(clip(p)) : p);
    const ends = cases.flatMap((one) => scaled(d3.extent(one.output.curve.x), view)),
      x = M.linear([...view.reach, ...ends], [box.left, box.right]);
    const ticks = PAPER.filter((p) => p >= smallest && p <= 1 - smallest);
    M.axes(svg, box, x, y, {
      xText: view.axis,
      yText: cases.some((one) => one.output.missing) ? "share of the runs with a value at or below" : "share of the runs at or below",
      yValues: paper ? ticks.map(probit) : null,
      yFormat: (value, at) => (paper ? paperText(ticks[at]) : `${Math.round(100 * value)} %`),
    });
    for (const one of cases) {
      const curve = one.output.curve,
        values = scaled(curve.x, view),
        colour = several ? M.colour(one.at) : null;
      // The function has steps if its knots are all distinct values. If they stand for many, straight lines join them.
      const form = curve.steps ? d3.curveStepAfter : d3.curveLinear;
      const flat = (level, ends) => (paper ? [] : ends.map((value) => [value, level]));
      M.put(svg, "path.curve-band", {
        d: M.band(x, height).curve(form)(values.map((value, at) => [value, curve.lower[at], curve.upper[at]])),
        style: { fill: colour || M.colour(0) },
      });
      M.put(svg, "path.curve", {
        "stroke-dasharray": several ? M.dash(one.at) : null,
        d: M.line(x, height).curve(form)([
          ...flat(0, [x.domain()[0], values[0]]),
          ...values.map((value, at) => [value, curve.p[at]]),
          ...flat(1, [values[values.length - 1], x.domain()[1]]),
        ]),
        style: { stroke: colour },
      });
    }
    for (const one of several ? [] : quantiles) {
      const y1 = height(one.p),
        at = (value) => x(value * view.factor);
      if (W.isNumber(one.lower) && W.isNumber(one.upper))
        M.put(svg, "line.quantile-bounds", { x1: at(one.lower), x2: at(one.upper), y1, y2: y1 });
      M.put(svg, "circle.quantile", { cx: at(one.value), cy: y1, r: 3.5, title: text(one) });
    }
    drawMarks(svg, box, view, x, true); // at the bottom: the curve is high at the right
    return box.bottom + 40;
  }
})();
