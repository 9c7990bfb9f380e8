// Why: which dispersions move an output (tornado), with the strongest pairs and what other studies found.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M } = W;

  // Effects of one output, whatever they are: rank coefficients, Sobol' indices, or plain correlations without bounds.
  function effectsOf(set, name) {
    const sensitivity = set.sensitivity;
    if (sensitivity && sensitivity.effects) {
      const pair =
        sensitivity.kind === "sobol"
          ? [
              ["first", "first order"],
              ["total", "total"],
            ]
          : [
              ["spearman", "Spearman"],
              ["prcc", sensitivity.held === false ? "PRCC" : "PRCC, others held"],
            ];
      return { pair, kind: sensitivity.kind, rows: sensitivity.effects.filter((one) => one.output === name) };
    }
    const table = set.correlations,
      column = table ? table.outputs.indexOf(name) : -1;
    if (column < 0) return { pair: [], rows: [] };
    const rows = table.draws
      .map((draw, at) => ({ draw, spearman: table.spearman[at][column] }))
      .filter((one) => W.isNumber(one.spearman));
    return {
      pair: [["spearman", "Spearman"]],
      kind: "correlation",
      rows: rows.sort((a, b) => Math.abs(b.spearman) - Math.abs(a.spearman)).slice(0, 12),
    };
  }

  function tornado(set, name) {
    const { pair, kind, rows } = effectsOf(set, name);
    if (!rows.length)
      return h(
        "p",
        { class: "nothing" },
        `No dispersion's effect on ${F.nameOf(name)} is known: too few runs have it, or it does not vary.`,
      );
    const measure = kind === "sobol" ? "share of the variance" : "rank correlation";
    return W.figure({
      title: `What moves ${F.nameOf(name)}`,
      class: "tornado",
      printed: 860,
      note:
        kind === "sobol"
          ? "First order: alone. Total: with what it does together with others. Lines are confidence bounds."
          : `Strongest first.${kind === "rank" ? " Lines are confidence bounds." : ""} To the right: the output rises with the dispersion.`,
      description: () =>
        rows
          .map((one) => `${one.draw}: ${pair.map(([key, text]) => `${text} ${F.fixed(one[key], 2)}`).join(", ")}`)
          .join("; "),
      table: () => ({
        columns: [
          "dispersion",
          ...pair.flatMap(([key, text]) => (`${key}_lower` in rows[0] ? [text, "lower", "upper"] : [text])),
        ],
        rows: rows.map((one) => [
          one.draw,
          ...pair.flatMap(([key]) =>
            `${key}_lower` in rows[0] ? [one[key], one[`${key}_lower`], one[`${key}_upper`]] : [one[key]],
          ),
        ]),
      }),
      draw: function (svg, width) {
        const fill = M.hatches(svg, 2),
          top = M.legend(
            svg,
            pair.map(([, text], at) => ({ text, fill: fill(at) })),
            width,
          );
        const left = Math.min(width * 0.34, Math.max(...rows.map((one) => M.textWidth(one.draw))) + 12),
          row = 15 * pair.length + 10;
        const box = { left, right: width - 16, top: top + 4, bottom: top + 4 + row * rows.length };
        const far = Math.max(
          0.1,
          ...rows
            .flatMap((one) => pair.flatMap(([key]) => [one[key], one[`${key}_lower`], one[`${key}_upper`]]))
            .filter(W.isNumber)
            .map(Math.abs),
        );
        const x = d3.scaleLinear(
          [
            kind === "sobol"
              ? Math.min(0, d3.min(rows, (one) => d3.min(pair, ([key]) => one[`${key}_lower`])) || 0)
              : -Math.min(1, far * 1.05),
            Math.min(kind === "sobol" ? far * 1.05 : 1, far * 1.05),
          ],
          [box.left, box.right],
        );
        M.axes(svg, box, x, null, { xText: measure });
        svg
          .append("line")
          .attr("class", "zero-line")
          .attr("x1", x(0))
          .attr("x2", x(0))
          .attr("y1", box.top)
          .attr("y2", box.bottom);
        rows.forEach(function (one, at) {
          const upper = box.top + row * at + 5;
          svg
            .append("text")
            .attr("x", left - 8)
            .attr("y", upper + (row - 10) / 2)
            .attr("dy", "0.35em")
            .attr("text-anchor", "end")
            .text(M.shorten(one.draw, left - 8))
            .append("title")
            .text(one.draw);
          pair.forEach(function ([key, text], place) {
            const value = one[key],
              low = one[`${key}_lower`],
              high = one[`${key}_upper`],
              y = upper + 15 * place;
            if (!W.isNumber(value)) return;
            svg
              .append("rect")
              .attr("class", "effect")
              .attr("x", Math.min(x(0), x(value)))
              .attr("width", Math.max(1, Math.abs(x(value) - x(0))))
              .attr("y", y + 1)
              .attr("height", 12)
              .style("fill", fill(place))
              .append("title")
              .text(
                `${one.draw}, ${text}: ${F.fixed(value, 3)}${W.isNumber(low) ? ` (${F.fixed(low, 3)} … ${F.fixed(high, 3)})` : ""}`,
              );
            if (W.isNumber(low) && W.isNumber(high))
              svg
                .append("path")
                .attr("class", "whisker")
                .attr("d", `M${x(low)},${y + 7}H${x(high)}M${x(low)},${y + 3.5}v7M${x(high)},${y + 3.5}v7`);
          });
        });
        return box.bottom + 40;
      },
    });
  }

  // Dispersions that seem to move nothing may be applied to the wrong parameter.
  function idle(set) {
    const names = (set.sensitivity && set.sensitivity.idle) || [];
    return names.length
      ? h(
          "details",
          { open: names.length <= 12 },
          h(
            "summary",
            {},
            `${names.length} ${names.length === 1 ? "dispersion is" : "dispersions are"} not seen to move any output`,
          ),
          h(
            "p",
            { class: "note" },
            names.join(", "),
            ". One that makes an output rise and fall would not be seen: Sobol' indices show it.",
          ),
        )
      : null;
  }

  const tornadoHost = h("div", {});
  W.tornado = tornado;
  // The outputs whose effects are known, to choose from here as well.
  W.effectOutputs = function (set) {
    const found =
      set.sensitivity && set.sensitivity.effects
        ? set.sensitivity.effects.map((one) => one.output)
        : (set.correlations || { outputs: [] }).outputs;
    return [...new Set(found)];
  };
  W.chooser = (names, chosen, onchoose) =>
    h(
      "label",
      { class: "search" },
      "Output ",
      h(
        "select",
        { onchange: (event) => onchoose(event.target.value) },
        names.map((name) => h("option", { value: name, selected: name === chosen }, F.nameOf(name))),
      ),
    );

  const chooserHost = h("div", { class: "controls" });
  const choose = (set) =>
    W.fill(
      chooserHost,
      W.effectOutputs(set).length > 1
        ? W.chooser(W.effectOutputs(set), W.chosen.output, (name) => W.choose("output", name))
        : null,
    );
  W.why = function () {
    if (W.onlyStudies) {
      W.fill(W.section("why"), W.studies(W.studySets));
      return;
    }
    const set = W.set(),
      pairs = set.scatters || [];
    const more = (from, to, text) =>
      pairs.length > from
        ? h(
            "details",
            { class: "later" },
            h("summary", {}, text),
            h(
              "div",
              { class: "grid pairs" },
              pairs.slice(from, to).map((pair) => W.scatter(set, W.chosen.set, pair)),
            ),
          )
        : null;
    W.fill(tornadoHost, tornado(set, W.chosen.output));
    choose(set);
    W.fill(
      W.section("why"),
      chooserHost,
      tornadoHost,
      idle(set),
      pairs.length
        ? [
            h("h3", {}, "Strongest pairs"),
            h(
              "div",
              { class: "grid pairs" },
              pairs.slice(0, 4).map((pair) => W.scatter(set, W.chosen.set, pair)),
            ),
            more(4, 12, pairs.length === 5 ? "One more pair" : `${pairs.length - 4} more pairs`),
          ]
        : null,
      W.studies([set, ...W.studySets]),
    );
  };
  W.on("output", function (name) {
    if (!tornadoHost.isConnected) return;
    W.fill(tornadoHost, tornado(W.set(), name));
    choose(W.set());
  });
})();
