// Results of `sensitivity CAMPAIGN` and `rare`, static margins of the campaign, and all studies side by side.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;

  // The document of each standard; the data have the formula with the campaign's factors.
  const STANDARDS = {
    ECSS: "ECSS-E-ST-33-01C (6 March 2009)",
    NASA: "NASA-STD-5017B (6 December 2022)",
    "NASA, one spring out": "NASA-STD-5017B (6 December 2022)",
    GEVS: "GEVS, GSFC-STD-7000A (22 April 2013)",
    AIAA: "AIAA S-114-2005",
  };
  const SYMBOLS = {
    ECSS: "I and S: inertia and springs that resist; HM, FR, HY, HA, HD: motor losses, friction, hysteresis, harness, adhesion; TD, TL: torques to deliver",
  };
  const standard = ({ kind, formula }) =>
    STANDARDS[kind] && formula
      ? `${STANDARDS[kind]}, with the factors of this campaign: static margin = ${formula}; T: available torque; ${SYMBOLS[kind] || "fixed: springs and inertia that resist; variable: friction, harness, hysteresis and the like"}. `
      : "";
  const listed = (names) => (names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}` : names[0]);
  // The hinges of every case with the lower of their nominal margin and its quantile over draws.
  const statics = () =>
    W.sets.flatMap((set) =>
      ((set.static_margins || {}).hinges || [])
        .map((one) => ({ set, one, required: one.required || 0, value: d3.min([one.least, one.lower].filter(W.isNumber)) }))
        .filter((row) => W.isNumber(row.value)),
    );
  const lowestOf = (rows) => rows[d3.minIndex(rows, (row) => row.value - row.required)];
  const whichOf = ({ set: { static_margins: all }, one }) =>
    W.isNumber(one.lower) && !(one.least < one.lower) && W.isNumber(all.lower_p)
      ? all.lower_p * all.draws < 1
        ? `least of ${F.count(all.draws)} draws`
        : `${F.level(all.lower_p)} quantile over ${F.count(all.draws)} draws`
      : "nominal";
  // For the first screen: where static margins are below what the standard asks. Null if they are nowhere.
  W.staticShortfall = function () {
    const short = statics().filter((row) => row.value < row.required);
    if (!short.length) return null;
    const lowest = lowestOf(short),
      several = W.sets.length > 1,
      hinges = [...new Set(short.map(({ one }) => one.hinge))],
      casesOf = (rows) => listed([...new Set(rows.map(({ set }) => set.label))]),
      nominal = short.filter(({ one, required }) => one.least < required),
      asked = W.sets.some((set) => (set.requirements || []).some((one) => one.static_margin)),
      coupled = hinges.filter((name) => name.includes("+")).length,
      what = !coupled
        ? ["hinge"]
        : coupled === hinges.length
          ? ["group of coupled hinges", "groups of coupled hinges"]
          : ["hinge or group", "hinges and groups of coupled hinges"],
      { kind } = lowest.set.static_margins;
    return h(
      "p.lead.static-shortfall",
      h("b", "Static margins"),
      ` of torque (${STANDARDS[kind] ? STANDARDS[kind].replace(/ \(.*/, "") : kind}) of ${F.counted(hinges.length, ...what)} are below the required ${listed([...new Set(short.map((row) => F.given(row.required)))])}`,
      several ? ` in ${casesOf(short)}${hinges.length > 1 ? " (each in at least one of them)" : ""}` : null,
      nominal.length
        ? `; ${several ? `in ${casesOf(nominal)} ` : ""}also those of the nominal wing (every dispersion at its median)`
        : "; those of the nominal wing (every dispersion at its median) are not",
      `. Lowest: ${F.fixed(lowest.value, 2)}${several ? ` in ${lowest.set.label}` : ""} (${whichOf(lowest)}). `,
      asked ? null : "They are no requirement of this campaign, so no verdict counts them. ",
      h("a", { href: "#static-margins" }, "Static margins by hinge"),
      ".",
    );
  };
  // "−0.61 in cold", the lowest static margin of all cases against what is required; null without static margins.
  W.lowestStaticMargin = function () {
    const lowest = lowestOf(statics());
    return lowest ? `${F.fixed(lowest.value, 2)}${W.sets.length > 1 ? ` in ${lowest.set.label}` : ""}` : null;
  };
  // The lowest static margin of each case, the case with the lowest first.
  function lowestByCase(set) {
    const cases = W.sets.map((each) => lowestOf(statics().filter((row) => row.set === each))).filter(Boolean);
    if (cases.length < 2 || !W.sets.includes(set)) return null;
    const sorted = d3.sort(cases, (row) => row.value - row.required);
    return h(
      "p",
      `Lowest in ${sorted[0].set.label}: ${F.fixed(sorted[0].value, 2)}; then ${sorted.slice(1).map((row) => `${row.set.label} ${F.fixed(row.value, 2)}`).join(", ")}. The picture and the table show ${set.label}.`,
    );
  }

  function staticMargins({ hinges, kind, formula, draws, lower_p: share }, set) {
    const { factor, unit } = F.shown("rad");
    // Mirrored hinges turn in opposite senses: their travels, from 0, coincide.
    const travel = (one) => one.angle.map((angle) => Math.abs(angle - one.angle[0]) * factor);
    // Too few draws for a quantile: the least of them.
    const quantile = W.isNumber(share) && share * draws < 1 ? "least" : `${F.level(share)} quantile`;
    const enough = (margin, { required }) => (W.isNumber(margin) ? W.badge(margin >= required ? "passed" : "failed") : F.none);
    const part = hinges.slice(0, 14),
      dispersed = !W.isNumber(share) ? "Least, dispersed" : quantile === "least" ? "Least of all draws" : `Least, ${quantile}`,
      least = hinges.map((one) => [
        one.hinge,
        F.fixed(one.least, 2),
        F.fixed(one.lower, 2),
        F.fixed(one.required, 2),
        enough(one.least, one),
        ...(W.isNumber(share) ? [enough(one.lower, one)] : []),
      ]);
    return [
      lowestByCase(set),
      W.figure({
        title: `Static margin of torque along the travel${kind ? ` (${kind})` : ""}`,
        class: "static-margins",
        printed: 860,
        note: `Thick: nominal wing, every dispersion at the median of its law${W.sets.length > 1 ? ` in ${set.label}` : ""}.${W.isNumber(share) ? ` Thin: the ${quantile} over ${F.counted(draws, "draw")}.` : ""} ${hinges.every((one) => one.required === 0) ? "0 is enough." : "The table has what is required."}${hinges.length > part.length ? ` The picture has the first ${part.length} of ${hinges.length} hinges; the table has all.` : ""}`,
        description: () =>
          hinges
            .slice(0, 20)
            .map((one) => `${one.hinge}: least ${F.fixed(one.least, 2)}`)
            .join("; "),
        table: () => ({
          columns: ["hinge", `travel ${unit}`, "static margin", "static margin, lower quantile", "required"],
          rows: hinges.flatMap((one) =>
            travel(one).map((angle, at) => [
              one.hinge,
              angle,
              one.margin[at],
              (one.margin_lower || [])[at],
              one.required,
            ]),
          ),
        }),
        draw: function (svg, width) {
          const top = M.legend(
            svg,
            M.lineItems(part, (one) => one.hinge),
            width,
          );
          const y = M.linear(
              [0, ...part.flatMap((one) => [...one.margin, ...(one.margin_lower || []), one.required])],
              [0, 1],
            ),
            box = M.boxFor(y, width, top, 250, 14);
          const x = M.linear(
            part.flatMap(travel),
            [box.left, box.right],
          );
          M.axes(svg, box, x, y, { xText: `travel from the stowed angle (${unit})`, yText: "static margin" });
          for (const required of new Set(part.map((one) => one.required).filter(W.isNumber)))
            M.put(svg, "line.limit", { x1: box.left, x2: box.right, y1: y(required), y2: y(required) });
          part.forEach((one, at) =>
            [
              ["path.trace", one.margin],
              ["path.trace.thin", one.margin_lower || []],
            ].forEach(([style, values]) =>
              M.trace(svg, M.line(x, y)(travel(one).map((angle, k) => [angle, values[k]])), at, style),
            ),
          );
          return box.bottom + 40;
        },
      }),
      W.table(
        "Least static margins",
        ["Hinge", number("Least, nominal"), number(dispersed), number("Required"), "Nominal verdict", ...(W.isNumber(share) ? [`Verdict, ${quantile}`] : [])],
        least,
      ),
      h(
        "p.note",
        standard({ kind, formula }),
        `${kind === "NASA, one spring out" ? "It takes a spring away" : "It multiplies the resisting torques by factors"} and counts no kinetic energy, so a wing with a static margin below 0 can still deploy.`,
      ),
    ];
  }

  function rareEvent(rare) {
    const beyond = rare.beyond,
      { factor, unit } = F.shown(beyond ? beyond.unit : ""),
      event = beyond ? `${beyond.abs ? `|${F.nameOf(beyond.output)}|` : F.nameOf(beyond.output)} ${beyond.above ? ">" : "<"} ${F.written(beyond.limit, beyond.unit)}` : rare.text,
      bounds = W.isNumber(rare.confidence) ? `${F.given(100 * rare.confidence)} % bounds` : "bounds",
      // Of "not deployed" the levels are those of the limit state: below 0 the wing is not deployed. An earlier version wrote
      // the other events without `beyond`.
      reserve = !beyond && rare.text === "not deployed",
      below = reserve || (beyond ? !beyond.above : / < /.test(rare.text)),
      level = reserve ? "reserve" : "threshold";
    // Of each repeat the levels that can be drawn.
    const repeats = (rare.levels || [])
        .map((levels, at) => levels.filter((one) => W.isNumber(one.threshold) && one.probability > 0).map((one) => ({ repeat: at + 1, threshold: one.threshold * factor, probability: one.probability })))
        .filter((levels) => levels.length),
      drawn = repeats.flat(),
      several = (rare.levels || []).length > 1,
      likeliest = rare.likeliest && rare.likeliest.draws,
      valueOf = (one) => [F.number(one.value * F.shown(one.unit || "").factor, 4), F.shown(one.unit || "").unit],
      strata = rare.strata || [];
    // The mean stands at the threshold that every repeat has reached. With strata the estimate is a sum over them, and the
    // repeats are those of the first alone.
    const end = drawn.length ? repeats[0][repeats[0].length - 1].threshold : null,
      mean = several && repeats.length === rare.levels.length && rare.reached && !strata.length && repeats.every((levels) => levels[levels.length - 1].threshold === end);
    const figure =
      d3.max(repeats, (levels) => levels.length) > 1
        ? W.figure({
            title: "Rare event: probability of each level",
            class: "rare",
            note: [
              reserve ? "Below 0 the wing is not deployed." : "",
              several
              ? `Each thin line is one of ${F.counted(rare.levels.length, "repeat")}${strata.length ? " of the draws with no rare value" : ""}.${mean ? " The large point is the estimate, their mean." : ""}`
              : "",
            ]
              .filter(Boolean)
              .join(" "),
            description: () =>
              repeats
                .map((levels) => (several ? `repeat ${levels[0].repeat}: ` : "") + levels.map((one) => `${below ? "below" : "above"} ${F.number(one.threshold, 4)}: ${F.number(one.probability, 2)}`).join("; "))
                .join("; "),
            table: () => ({
              columns: ["repeat", unit ? `${level} ${unit}` : level, "probability"],
              rows: drawn.map((one) => [one.repeat, one.threshold, one.probability]),
            }),
            draw: function (svg, width) {
              const box = { left: 62, right: width - 14, top: 22, bottom: 240 },
                x = M.linear(
                  drawn.map((one) => one.threshold),
                  [box.left, box.right],
                );
              const y = d3.scaleLog([d3.min(drawn, (one) => one.probability) / 2, 1], [box.bottom, box.top]),
                decades = d3.range(0, Math.ceil(-Math.log10(y.domain()[0]))).map((k) => 10 ** -k);
              M.axes(svg, box, x, y, {
                xText: reserve ? "reserve, as a share of the nominal wing's" : unit ? `threshold (${unit})` : "threshold",
                yText: `probability of ${below ? "falling below" : "exceeding"} it`,
                yValues: decades,
                yFormat: (value) => `10${F.superscript(Math.round(Math.log10(value)))}`,
              });
              for (const levels of repeats) M.trace(svg, M.line(x, y)(levels.map((one) => [one.threshold, one.probability])), 0, several ? "path.trace.thin" : "path.trace");
              drawn.forEach((one) => M.put(svg, "circle.quantile", { cx: x(one.threshold), cy: y(one.probability), r: several ? 2 : 3.5 }));
              if (mean) M.put(svg, "circle.quantile.estimate", { cx: x(end), cy: y(rare.probability), r: 4.5 });
              return box.bottom + 40;
            },
          })
        : null;
    const bias = rare.reached && rare.bias > 0 ? ` Bias: such estimates are too large by about ${F.fixed(100 * rare.bias, 1)} % on average.` : "",
      reached =
        rare.reached === false && strata.length === 0 && rare.probability > 0
          ? " The event was not reached: this is the estimated probability of the last level, which contains the event. Estimated upper bound, not guaranteed."
          : rare.estimated
            ? " The upper bound is an estimate, not guaranteed."
            : "";
    return [
      h(
        "p",
        h("b", `${event}${rare.case ? `, case ${rare.case}` : ""}: ${F.number(rare.probability, 3)}`),
        ` (${bounds} ${F.number(rare.lower, 3)} … ${F.number(rare.upper, 3)}).${bias}${reached}`,
      ),
      ...(rare.warnings || []).map((text) => h("p", h("b", "Warning: "), text + ".")),
      strata.length
        ? W.table(
            "Draws with rare values of discrete dispersions, simulated by themselves",
            ["Draws", number("P(draws)"), number("P(event)"), number("Product")],
            strata.map((one) => [
              one.text,
              F.number(one.probability, 3),
              (one.reached ? "" : "≤ ") + F.number(one.event, 3),
              (one.reached ? "" : "≤ ") + F.number(one.probability * one.event, 3),
            ]),
            { showCaption: true },
          )
        : null,
      figure,
      likeliest && likeliest.length
        ? [
            W.table(
              "Most likely run of the event",
              ["Dispersion", number("Value"), "Unit", number("Normal coordinate")],
              likeliest
                .slice()
                .sort((a, b) => Math.abs(b.z) - Math.abs(a.z))
                .map((one) => [one.name, ...valueOf(one), `${one.z > 0 ? "+" : ""}${F.fixed(one.z, 2)}`]),
              { showCaption: true },
            ),
            h(
              "p.note",
              "Normal coordinate: 0 at the law's median, and (value − mean)/std for a normal law. Of a correlated dispersion it is the part that those before it, by name, do not explain.",
            ),
          ]
        : null,
    ];
  }

  // Sobol' indices of a set without runs, one output at a time.
  function indices(set) {
    const names = W.effectOutputs(set),
      host = h("div"),
      show = (name) => W.fill(host, W.tornado(set, name));
    const first = names.includes(W.chosen.output) ? W.chosen.output : names[0];
    show(first);
    return [names.length > 1 ? h("div.controls", W.chooser(names, first, show)) : null, host];
  }
  W.studies = function (sets) {
    const parts = [],
      found = new Set(),
      several = sets.length > 1;
    const add = (kind, title, set, ...content) => {
      const own = W.studySets.includes(set),
        heading = `${title}${several && own ? ` · ${set.label}` : ""}${own && set.case && !set.rare ? `, case ${set.case}` : ""}`;
      found.add(kind);
      parts.push(h("div", { id: kind === "static" ? "static-margins" : null }, h("h3", heading), content));
    };
    for (const set of sets) {
      if (W.studySets.includes(set) && W.effectOutputs(set).length) add("sobol", "Sensitivity", set, indices(set));
      if (set.margin && (set.margin.scales || []).length) add("margin", W.permissible(set.margin), set, W.marginWindow(set.margin, set));
      if (!found.has("static") && set.static_margins && (set.static_margins.hinges || []).length)
        add("static", "Static margins", set, staticMargins(set.static_margins, set));
      if (set.rare) add("rare", "Rare events", set, rareEvent(set.rare));
      if (set.fit) {
        add("fit", "Fit to tests", set, W.fitParts(set.fit, set));
        parts[parts.length - 1].classList.add("across");
      }
    }
    const names = {
      margin: "the permissible spring strength (wingspread margin)",
      static: "static margins (motorization in the campaign)",
      rare: "rare events (wingspread rare)",
      fit: "a fit to deployment tests (wingspread fit)",
    };
    const missing = Object.keys(names)
      .filter((kind) => !found.has(kind))
      .map((kind) => names[kind]);
    return [
      h("div.grid.pairs.studies", parts),
      missing.length ? h("p.note", `Not in this report: ${missing.join(", ")}.`) : null,
    ];
  };
})();
