// Causes: which dispersions influence an output (tornado), the strongest pairs, and the results of margin, sensitivity, rare.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M } = W;

  // The effects on one output: rank coefficients, Sobol' indices, or correlations without bounds.
  function effectsOf(set, name) {
    const sensitivity = set.sensitivity;
    if (sensitivity && sensitivity.effects) {
      const pair = Object.entries(
        sensitivity.kind === "sobol"
          ? { first: "first order", total: "total" }
          : {
              spearman: "Spearman",
              prcc: sensitivity.held === false ? "PRCC" : "partial (PRCC): other dispersions held",
            },
      );
      return { pair, kind: sensitivity.kind, rows: sensitivity.effects.filter((one) => one.output === name) };
    }
    const table = set.correlations,
      column = table ? table.outputs.indexOf(name) : -1;
    if (column < 0) return { pair: [], rows: [] };
    const key = set.rows === false ? "pearson" : "spearman"; // ranks need the rows
    const rows = table.draws
      .map((draw, at) => ({ draw, [key]: table[key][at][column] }))
      .filter((one) => W.isNumber(one[key]));
    return {
      pair: [[key, key === "pearson" ? "Pearson" : "Spearman"]],
      kind: "correlation",
      rows: rows.sort((a, b) => Math.abs(b[key]) - Math.abs(a[key])).slice(0, 12),
    };
  }

  // The level of the bounds, and how many of the tested dispersions they show by chance.
  function chance(set) {
    const level = set.sensitivity.confidence || set.confidence,
      tested = ((set.inputs || {}).dispersions || []).length,
      words = `Lines are ${F.given(100 * level)} % two-sided bounds`;
    return tested > 1
      ? `${words} of one coefficient: if none of the ${F.count(tested)} dispersions had an effect, about ${F.number((1 - level) * tested, 2)} of them would still exclude 0.`
      : `${words}.`;
  }
  function tornado(set, name) {
    const { pair, kind, rows } = effectsOf(set, name);
    if (!rows.length)
      return h("p.nothing", `No effects on ${F.nameOf(name)}: too few runs have a value, or it does not vary.`);
    const bounded = kind !== "correlation",
      withBounds = (one, key) => [one[key], one[`${key}_lower`], one[`${key}_upper`]];
    return W.figure({
      title: `Influences on ${F.nameOf(name)}${W.caseEffect(set, name) ? `, inside ${set.label}` : ""}`,
      class: "tornado",
      printed: 940,
      note:
        kind === "sobol"
          ? `First order: the dispersion alone. Total: with its interactions.${W.isNumber(set.confidence) ? ` Lines are ${F.given(100 * set.confidence)} % two-sided bounds.` : ""}`
          : `Strongest first.${kind === "rank" ? ` ${chance(set)}` : ""} Bars to the right: the output increases with the dispersion.`,
      description: () =>
        rows
          .map((one) => `${W.wordsOfDraw(set, one.draw)}: ${pair.map(([key, text]) => `${text} ${F.fixed(one[key], 2)}`).join(", ")}`)
          .join("; "),
      table: () => ({
        columns: ["dispersion", ...pair.flatMap(([, text]) => (bounded ? [text, "lower", "upper"] : [text]))],
        rows: rows.map((one) => [one.draw, ...pair.flatMap(([key]) => (bounded ? withBounds(one, key) : [one[key]]))]),
      }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          pair.map(([, text], at) => ({ text, fill: M.colour(at), hatch: at })),
          width,
        );
        const left = M.labelRoom(
            width,
            0.34,
            rows.map((one) => W.wordsOfDraw(set, one.draw)),
          ),
          row = 13 * pair.length + 9;
        const box = { left, right: width - 16, top: top + 4, bottom: top + 4 + row * rows.length };
        const far = Math.max(
          0.1,
          ...rows
            .flatMap((one) => pair.flatMap(([key]) => withBounds(one, key)))
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
        M.axes(svg, box, x, null, { xText: kind === "sobol" ? "share of the variance" : set.rows === false ? "correlation" : "rank correlation" });
        M.upright(svg, "line.zero-line", x(0), box);
        rows.forEach(function (one, at) {
          const upper = box.top + row * at + 4;
          M.rowLabel(svg, W.wordsOfDraw(set, one.draw), left, upper + (row - 9) / 2);
          pair.forEach(function ([key, text], place) {
            const [value, low, high] = withBounds(one, key),
              y = upper + 13 * place;
            if (!W.isNumber(value)) return;
            const bar = { x: Math.min(x(0), x(value)), y: y + 1, width: Math.max(1, Math.abs(x(value) - x(0))), height: 11 };
            M.put(svg, "rect.effect", {
              ...bar,
              style: { fill: M.colour(place) },
              title: `${one.draw}, ${text}: ${F.fixed(value, 3)}${W.isNumber(low) ? ` (${F.fixed(low, 3)} … ${F.fixed(high, 3)})` : ""}`,
            });
            M.hatch(svg, place, [Object.values(bar)]);
            if (W.isNumber(low) && W.isNumber(high)) M.whisker(svg, x, low, high, y + 6.5, 3.5);
          });
        });
        return box.bottom + 40;
      },
    });
  }

  // What an output increases and decreases with most, of the effects that the bounds show, and what those dispersions act on.
  function influences(set, name) {
    const { kind, rows } = effectsOf(set, name);
    if (kind !== "rank") return [];
    const strength = (one) => (Math.abs(one.prcc) > Math.abs(one.spearman) ? one.prcc : one.spearman),
      shown = (one) => one.spearman_lower * one.spearman_upper > 0 || one.prcc_lower * one.prcc_upper > 0;
    const acts = function (draw) {
      const { words, paths = [], apply } = ((set.inputs || {}).dispersions || []).find((one) => one.draw === draw) || {};
      if (!paths.length || (words && apply !== "by a table")) return "";
      return paths.length === 1
        ? [" (acts on ", h("code", paths[0]), ")"]
        : ` (acts on ${F.count(paths.length)} parameters${apply === "by a table" ? " by tables" : ""})`;
    };
    const most = (sign, text) => {
      const one = rows.find((each) => shown(each) && sign * strength(each) > 0);
      return one ? [text, h("b", W.drawInWords(set, one.draw)), acts(one.draw)] : null;
    };
    const parts = [most(1, "increases most with "), most(-1, "decreases most with ")].filter(Boolean);
    return parts.length ? [`${F.nameOf(name)} `, parts.map((part, at) => [at ? " and " : "", part]), "."] : [];
  }
  // The case first, where there are several; then the dispersions inside the chosen one.
  function fillTornado(set, name) {
    const found = influences(set, name),
      between = W.caseEffect(set, name);
    W.fill(
      tornadoHost,
      between ? [h("p.effects", between), W.caseMechanism(set, name) ? h("p.note", W.caseMechanism(set, name)) : null, W.caseTable(set, name)] : null,
      found.length ? h("p.effects", between ? `Inside ${set.label}: ` : null, found) : null,
      tornado(set, name),
    );
  }

  // Dispersions without a visible effect: they may act on the wrong parameter.
  function idle(set) {
    const names = (set.sensitivity && set.sensitivity.idle) || [],
      level = F.given(100 * ((set.sensitivity || {}).confidence || set.confidence));
    return names.length
      ? h(
          "details",
          { open: names.length <= 12 },
          h("summary", `${F.counted(names.length, "dispersion")} without a visible effect on any output`),
          h(
            "p.note",
            names.map((name) => W.wordsOfDraw(set, name)).join(", "),
            `. Here a dispersion counts as visible only if bounds that hold with ${level} % confidence for all outputs together (Bonferroni) exclude 0 of one. The lines above hold for one output each, so a dispersion of this list can have a line beside 0. Rank correlations miss an effect that first increases and then decreases; the Sobol' indices of wingspread sensitivity show it.`,
          ),
        )
      : null;
  }

  // What limits the effects as read from these runs; those of Sobol' indices are among the first page's warnings.
  function limits(set) {
    const { kind, warnings = [] } = set.sensitivity || {};
    return kind === "rank" ? warnings.map((text) => h("p.note.of-effects", h("b", "Warning: "), `${text}.`)) : [];
  }

  const tornadoHost = h("div");
  W.tornado = tornado;
  // The outputs with known effects.
  W.effectOutputs = function (set) {
    const found =
      set.sensitivity && set.sensitivity.effects
        ? set.sensitivity.effects.map((one) => one.output)
        : (set.correlations || { outputs: [] }).outputs;
    return [...new Set(found)];
  };
  W.chooser = (names, chosen, onchoose) =>
    h(
      "label.search",
      "Output ",
      W.select(
        { onchange: (event) => onchoose(event.target.value) },
        names.map((name) => [name, F.nameOf(name)]),
        chosen,
      ),
    );

  const chooserHost = h("div.controls");
  // The chosen output is in the list even if nothing moves it; `deployed`, which is no output, is chosen for this part alone.
  function choose(set) {
    const names = [...new Set([...W.effectOutputs(set), W.chosen.output])].filter(Boolean),
      isOutput = (name) => W.outputsOf(set).some((one) => one.name === name);
    W.fill(
      chooserHost,
      names.length > 1 ? W.chooser(names, W.chosen.output, (name) => (isOutput(name) ? W.choose("output", name) : fillTornado(set, name))) : null,
    );
  }
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
            "details.later",
            h("summary", text),
            h(
              "div.grid.pairs",
              pairs.slice(from, to).map((pair) => W.scatter(set, W.chosen.set, pair)),
            ),
          )
        : null;
    fillTornado(set, W.chosen.output);
    choose(set);
    W.fill(
      W.section("why"),
      chooserHost,
      tornadoHost,
      limits(set),
      idle(set),
      pairs.length
        ? [
            h("h3", "Strongest pairs"),
            h(
              "div.grid.pairs",
              pairs.slice(0, 4).map((pair) => W.scatter(set, W.chosen.set, pair)),
            ),
            more(4, 12, pairs.length === 5 ? "One more pair" : `${pairs.length - 4} more pairs`),
          ]
        : set.rows === false
          ? h("p.nothing", W.withoutRows(set, "Rank correlations, their bounds and pictures of pairs", "need"), " Above are linear correlations (Pearson).")
          : null,
      W.studies([set, ...W.studySets]),
    );
  };
  W.on("output", function (name) {
    if (!tornadoHost.isConnected) return;
    fillTornado(W.set(), name);
    choose(W.set());
  });
})();
