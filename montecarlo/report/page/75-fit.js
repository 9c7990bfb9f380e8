// The fit of parameters to deployment tests (`wingspread fit`): what the tests say, measured against fitted, prior against
// posterior, pairs of parameters, the prediction before and after.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;
  const MOST_PAIRED = 4; // parameters in the picture of pairs

  const thinned = (drawn, all, what) => (all > drawn ? ` The picture has ${F.count(drawn)} of ${F.counted(all, what)}.` : "");
  function trace(one, level) {
    const { unit, factor } = F.shown(one.unit),
      scaled = (values) => values.map((value) => (W.isNumber(value) ? value * factor : value)),
      [measured, fitted, lower, upper] = [one.measured, one.fitted, one.lower, one.upper].map(scaled),
      residuals = measured.map((value, at) => (W.isNumber(value) ? value - fitted[at] : null));
    const note = `Root mean square of the residuals: ${F.number(one.rms * factor, 3)} ${unit}.${
      W.isNumber(one.chi_squared)
        ? ` χ² ${F.number(one.chi_squared, 4)} for ${F.count(one.n)} numbers, p ${F.number(one.p_value, 2)}.`
        : ""
    } ${F.number(one.n_effective, 3)} of them are independent.${thinned(one.t.length, one.samples, "sample")}`;
    return W.figure({
      title: `Measured and fitted: ${one.column}, ${one.test}`,
      class: "fit-trace",
      note,
      description: note,
      table: () => ({
        columns: ["t s", `measured ${unit}`, `fitted ${unit}`, `lower ${unit}`, `upper ${unit}`],
        rows: one.t.map((t, at) => [t, measured[at], fitted[at], lower[at], upper[at]]),
      }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          [
            { text: "measured", mark: M.colour(5) },
            { text: "fitted", line: M.colour(0) },
            { text: `${level} band`, fill: M.colour(0), opacity: 0.25 },
          ],
          width,
        );
        const y = M.linear([...measured, ...fitted], [0, 1]),
          box = M.boxFor(y, width, top, 220, 14),
          x = M.linear(one.t, [box.left, box.right], 0);
        M.axes(svg, box, x, y, { yText: `${one.column} (${unit})` });
        const points = (parent, values, scale) =>
          values.forEach(
            (value, at) =>
              W.isNumber(value) &&
              M.put(parent, "circle.sample", {
                cx: x(one.t[at]),
                cy: scale(value),
                r: 1.4,
                style: { fill: M.colour(5) }, // as dark as a small dot needs
              }),
          );
        M.put(svg, "path.curve-band", {
          d: M.band(x, y)(one.t.map((t, at) => [t, lower[at], upper[at]])),
          style: { fill: M.colour(0), "fill-opacity": 0.25 },
        });
        points(svg, measured, y);
        M.trace(svg, M.line(x, y)(one.t.map((t, at) => [t, fitted[at]])), 0);
        const below = { left: box.left, right: box.right, top: box.bottom + 50, bottom: box.bottom + 140 },
          r = M.linear([0, ...residuals], [below.bottom, below.top]);
        M.axes(svg, below, x, r, { xText: "time (s)", yText: `measured − fitted (${unit})`, yTicks: 4 });
        points(svg, residuals, r);
        return below.bottom + 40;
      },
    });
  }

  function priorAndPosterior(parameters, level) {
    const known = (one) => W.isNumber(one.prior.lower); // folders of older versions have no quantiles
    const scaled = parameters.map((one) => ({
      name: one.name,
      at: (value) => (value - one.prior.mean) / one.prior.std,
      one,
    }));
    return W.figure({
      title: "Prior and posterior",
      class: "fit-parameters",
      note: `In standard deviations of the prior from its mean.${parameters.some(known) ? ` Light: ${level} of the prior.` : ""} Dark: ${level} interval after the tests.`,
      description: () =>
        parameters.map((one) => `${one.name}: ${F.number(one.mean, 4)} ± ${F.number(one.std, 2)}`).join("; "),
      table: () => ({
        columns: ["parameter", "prior mean", "prior sd", "prior lower", "prior upper", "mode", "mean", "sd", "lower", "upper", "sd left"],
        rows: parameters.map((one) => [
          one.name,
          one.prior.mean,
          one.prior.std,
          one.prior.lower,
          one.prior.upper,
          one.mode,
          one.mean,
          one.std,
          one.lower,
          one.upper,
          one.std_ratio,
        ]),
      }),
      draw: function (svg, width) {
        const left = M.labelRoom(
            width,
            0.35,
            parameters.map((one) => one.name),
          ),
          box = { left, right: width - 14, top: 16, bottom: 16 + 26 * parameters.length },
          x = M.linear(
            scaled.flatMap(({ at, one }) => [...(known(one) ? [at(one.prior.lower), at(one.prior.upper)] : [0]), at(one.lower), at(one.upper)]),
            [box.left, box.right],
          );
        M.axes(svg, box, x, null, { xText: "deviation from the prior's mean (sd of the prior)" });
        scaled.forEach(function ({ name, at, one }, row) {
          const y = box.top + 26 * row + 13;
          M.rowLabel(svg, name, left, y);
          const bar = (from, to, tall, opacity) =>
            M.put(svg, "rect.interval", {
              x: x(from),
              width: Math.max(2, x(to) - x(from)),
              y: y - tall / 2,
              height: tall,
              style: { fill: M.colour(0), "fill-opacity": opacity },
            });
          if (known(one)) bar(at(one.prior.lower), at(one.prior.upper), 14, 0.18);
          bar(at(one.lower), at(one.upper), 8, 0.9);
        });
        return box.bottom + 40;
      },
    });
  }

  function pairs({ names, rows, samples }) {
    const shown = names.slice(0, MOST_PAIRED),
      columns = shown.map((_, at) => rows.map((row) => row[at]));
    if (shown.length < 2) return null;
    return W.figure({
      title: "Pairs of parameters after the tests",
      class: "fit-pairs",
      note:
        [names.length > shown.length ? `The picture has the first ${shown.length} of ${names.length} parameters; posterior.csv has all.` : "", thinned(rows.length, samples, "sample")].join("").trim() || null,
      description: `Samples of ${shown.join(", ")}, pair by pair.`,
      table: () => ({ columns: names, rows }),
      draw: function (svg, width) {
        const cells = shown.length - 1,
          side = Math.min(190, (width - 70) / cells - 14);
        for (let i = 1; i < shown.length; ++i)
          for (let j = 0; j < i; ++j) {
            const box = {
              left: 60 + j * (side + 14),
              top: 12 + (i - 1) * (side + 40),
              right: 60 + j * (side + 14) + side,
              bottom: 12 + (i - 1) * (side + 40) + side,
            };
            const x = M.linear(columns[j], [box.left, box.right]),
              y = M.linear(columns[i], [box.bottom, box.top]);
            M.axes(svg, box, x, j === 0 ? y : null, {
              xText: M.shorten(shown[j], side),
              yText: j === 0 ? M.shorten(shown[i], box.right) : null,
              xTicks: 3,
              yTicks: 4,
            });
            rows.forEach((row) =>
              M.put(svg, "circle.sample", {
                cx: x(row[j]),
                cy: y(row[i]),
                r: 1.6,
                style: { fill: M.colour(0), "fill-opacity": 0.35 },
              }),
            );
          }
        return 12 + cells * (side + 40) + 6;
      },
    });
  }

  // A predicted output: its median and the quantiles around it, with four digits, or as many as tell them apart. A quantile
  // that too many runs lack is null.
  function range([low, middle, high], unit) {
    const { factor } = F.shown(unit),
      size = (value) => Math.floor(Math.log10(Math.abs(value) || 1)),
      known = [low, middle, high].filter((value) => value !== null),
      [least, most] = [Math.min(...known), Math.max(...known)],
      digits = Math.max(4, most > least ? size(most) - size(most - least) + 3 : 4),
      text = (value) => (value === null ? "none" : F.number(value * factor, digits));
    return `${text(middle)} (${text(low)} … ${text(high)})`;
  }
  const spread = (mean, std) => `${F.sized(mean, std)} ± ${F.sized(std, std)}`;

  function parameterTable(parameters, level) {
    return W.table(
      "Parameters before and after the tests",
      ["Parameter", number("Before: mean ± sd"), number("After"), number(`${level} interval`), number("Share of the sd left")],
      parameters.map(function (one) {
        const { unit, factor } = F.shown(one.unit || ""),
          sized = (value) => F.sized(value * factor, one.std * factor);
        return [
          unit ? `${one.name} (${unit})` : one.name,
          spread(one.prior.mean * factor, one.prior.std * factor),
          spread(one.mean * factor, one.std * factor),
          `${sized(one.lower)} … ${sized(one.upper)}`,
          F.share(one.std_ratio),
        ];
      }),
      { showCaption: true },
    );
  }

  function tables(fit) {
    const varies = ([low, , high]) => low !== high;
    const outputs = Object.entries(fit.prediction).filter(([, one]) => varies(one.before) || varies(one.after));
    return [
      fit.values.length
        ? W.table(
            "Measured values",
            ["Test", "Value", "Unit", number("Measured"), number("Fitted"), number("Difference", "σ"), number("p")],
            fit.values.map((one) => [
              one.test,
              one.name.split(".").length > 2 ? one.name : F.nameOf(one.name), // a parameter of the scene by its path
              F.shown(one.unit).unit,
              ...[one.measured, one.fitted].map((value) => F.number(value * F.shown(one.unit).factor, 5)),
              F.sized(one.sigmas, 1),
              F.number(one.p_value, 2),
            ]),
            { showCaption: true },
          )
        : null,
      fit.candidates.length
        ? W.table(
            "What further tests would tell",
            ["Test", number("Information", "nats"), "Interval that shrinks most"],
            fit.candidates.map(function (one) {
              const [name, ratio] = Object.entries(one.std_ratio).sort((a, b) => a[1] - b[1])[0];
              return [one.name, F.number(one.information, 3), `${name}: to ${F.share(ratio)}`];
            }),
            { showCaption: true },
          )
        : null,
      outputs.length
        ? W.table(
            "Prediction: median (5 % … 95 %)",
            ["Output", "Unit", number("Before the tests"), number("After")],
            [
              ...(fit.deployed ? [["deployed", "", F.share(fit.deployed.before), F.share(fit.deployed.after)]] : []),
              ...outputs.map(([name, one]) => [F.nameOf(name), F.shown(one.unit).unit, range(one.before, one.unit), range(one.after, one.unit)]),
            ],
            { showCaption: true },
          )
        : null,
      outputs.some(([, one]) => [...one.before, ...one.after].includes(null))
        ? h("p.note", "None: the quantile is over all runs, and too many of them lack the output.")
        : null,
    ];
  }

  W.fitParts = function (fit, set) {
    const level = `${F.given(100 * set.confidence)} %`;
    return [
      ...fit.findings.map((text) => h("p", h("b", text))),
      h(
        "div.grid.pairs",
        h(
          "div",
          fit.parameters.length ? priorAndPosterior(fit.parameters, level) : null,
          fit.unseen.map((one) => h("p", one.text)),
          (fit.prior_decides || []).length ? h("p", `The prior decides, not the tests: ${fit.prior_decides.join(", ")}.`) : null,
        ),
        fit.samples ? pairs(fit.samples) : null,
        fit.traces.map((one) => trace(one, level)),
      ),
      fit.parameters.length ? parameterTable(fit.parameters, level) : null,
      ...tables(fit),
    ];
  };
})();
