// What went in: the scene, the dispersions, what each case changes, how it was integrated; and what every name means.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F } = W;

  // An angle or a rate in degrees as well: the drawing has them so.
  const inDegrees = (value, unit) =>
    W.isNumber(value) && F.angular(unit)
      ? `${F.given(Number((value * F.DEGREES).toPrecision(6)))} ${unit.replace("rad", "deg")}`
      : "";
  const either = (value) =>
    typeof value === "number" ? F.given(value) : value === null || value === undefined ? F.none : String(value);

  function changed() {
    const sets = W.sets.filter(
      (set) =>
        set.inputs && (set.inputs.scene || []).some((one) => one.case_value !== null && one.case_value !== undefined),
    );
    if (!sets.length)
      return W.sets.some((set) => set.case)
        ? h("p", {}, "No case changes the scene; their distributions differ (below).")
        : null;
    const paths = [
      ...new Set(
        sets.flatMap((set) =>
          set.inputs.scene
            .filter((one) => one.case_value !== null && one.case_value !== undefined)
            .map((one) => one.path),
        ),
      ),
    ];
    const find = (set, path) => (set.inputs.scene || []).find((one) => one.path === path);
    const rows = paths.map(function (path) {
      const first = sets.map((set) => find(set, path)).find(Boolean);
      return [
        h("span", {}, first.label),
        F.unit(first.unit),
        either(first.value),
        ...W.sets.map((set) => {
          const one = set.inputs && find(set, path);
          return one && one.case_value !== null && one.case_value !== undefined
            ? h("b", {}, either(one.case_value))
            : "as nominal";
        }),
      ];
    });
    return [
      h("h3", {}, "What the cases change"),
      W.table(
        "What the cases change of the nominal scene",
        [
          { text: "Parameter" },
          { text: "Unit" },
          { text: "Nominal", kind: "number" },
          ...W.sets.map((set) => ({ text: set.label, kind: "number" })),
        ],
        rows,
      ),
    ];
  }
  // Laws that are not the same in every set.
  function laws() {
    if (W.sets.length < 2) return null;
    const names = [...new Set(W.sets.flatMap((set) => (set.inputs.dispersions || []).map((one) => one.draw)))];
    const law = (set, name) => ((set.inputs.dispersions || []).find((one) => one.draw === name) || { law: F.none }).law;
    const differing = names.filter((name) => new Set(W.sets.map((set) => law(set, name))).size > 1);
    return differing.length
      ? W.table(
          "Dispersions whose law differs",
          [{ text: "Dispersion" }, ...W.sets.map((set) => ({ text: set.label }))],
          differing.map((name) => [name, ...W.sets.map((set) => law(set, name))]),
          { showCaption: true },
        )
      : null;
  }

  function scene(set) {
    const rows = (set.inputs.scene || []).map((one) => ({
      mark: one.case_value !== null && one.case_value !== undefined ? "changed" : null,
      cells: [
        one.label,
        either(one.value),
        F.unit(one.unit),
        inDegrees(one.value, one.unit),
        either(one.case_value),
        h("code", {}, one.path),
      ],
    }));
    const anyCase = rows.some((row) => row.mark);
    const columns = [
      { text: "Parameter" },
      { text: "Value", kind: "number" },
      { text: "Unit" },
      { text: "In degrees", kind: "number" },
      { text: `In ${set.label}`, kind: "number" },
      { text: "Path" },
    ];
    const drop = (list) => list.filter((_, at) => anyCase || at !== 4);
    return h(
      "details",
      { open: rows.length <= 80 },
      h("summary", {}, `Scene: ${F.count(rows.length)} parameters`),
      W.table(
        `Scene of ${set.label}`,
        drop(columns),
        rows.map((row) => ({ mark: row.mark, cells: drop(row.cells) })),
        { class: "tall" },
      ),
    );
  }
  function dispersions(set) {
    const rows = (set.inputs.dispersions || []).map((one) => [
      one.draw,
      h(
        "span",
        { class: String(one.law).length < 60 ? "law nowrap" : "law" },
        one.law,
        one.law_before_case ? h("small", { class: "faint" }, ` (nominal: ${one.law_before_case})`) : null,
      ),
      F.unit(one.unit),
      `${either(one.nominal)} ${one.nominal_unit && one.nominal_unit !== one.unit ? F.unit(one.nominal_unit) : ""}`.trim(),
      `${F.number(one.low, 4)} … ${F.number(one.high, 4)}`,
      inDegrees(one.low, one.unit) ? `${inDegrees(one.low, one.unit)} … ${inDegrees(one.high, one.unit)}` : "",
      h(
        "span",
        { class: "paths" },
        one.apply ? `${one.apply}: ` : null,
        (one.paths || []).map((path, at) => [at ? ", " : "", h("code", {}, path)]),
      ),
    ]);
    // columns that are empty in every row are left out
    const kept = (at) => ![2, 5].includes(at) || rows.some((row) => row[at]),
      drop = (list) => list.filter((_, at) => kept(at));
    return h(
      "details",
      { open: rows.length <= 60 },
      h("summary", {}, `Dispersions: ${F.count(rows.length)}`),
      rows.length
        ? W.table(
            `Dispersions of ${set.label}`,
            drop([
              { text: "Dispersion" },
              { text: "Law" },
              { text: "Unit" },
              { text: "Nominal", kind: "number" },
              { text: "1 % … 99 %", kind: "number" },
              { text: "In degrees", kind: "number" },
              { text: "Acts on" },
            ]),
            rows.map(drop),
          )
        : h("p", {}, "Nothing is dispersed."),
    );
  }
  function settings(set) {
    return W.table(
      "How it was integrated",
      [{ text: "Setting" }, { text: "Value" }],
      (set.inputs.settings || []).map((one) => [one.label, either(one.value)]),
      { showCaption: true },
    );
  }

  W.inputs = function () {
    const set = W.set();
    if (!set.inputs || !(set.inputs.scene || []).length)
      return W.fill(
        W.section("inputs"),
        h("p", { class: "nothing" }, "The folder does not hold its campaign's inputs."),
      );
    W.fill(
      W.section("inputs"),
      changed(),
      laws(),
      W.sets.length > 1 ? h("h3", {}, set.label) : null,
      scene(set),
      dispersions(set),
      h("div", { class: "narrow" }, settings(set)),
    );
  };

  const TERMS = [
    ["observed", "the quantile, or the share, of the runs that were made"],
    [
      "guaranteed",
      "its one-sided tolerance limit: what holds for all wings that could be built, with the stated confidence",
    ],
    ["undecided", "so few runs cannot show the requirement, whatever comes of them"],
    ["bounds", "exact (Clopper-Pearson) of shares, of order statistics for quantiles, where draws are independent"],
    ["nominal", "one run with nothing dispersed"],
    ["order of latching", "the hinges' names in the order in which they latched"],
    ["PRCC", "partial rank correlation: the effect of one dispersion with all others held"],
  ];
  W.glossary = function () {
    const known = Object.entries(W.data.glossary || {}).map(([name, one]) => [
      h("code", {}, name),
      F.unit(one.unit) || F.none,
      one.text,
    ]);
    const mentioned = new Set(Object.keys(W.data.glossary || {}));
    const terms = TERMS.filter(([name]) => !mentioned.has(name)).map(([name, text]) => [name, F.none, text]);
    W.fill(
      W.section("glossary"),
      W.table(
        "What the names mean, with units and signs",
        [{ text: "Name" }, { text: "Unit" }, { text: "Meaning" }],
        [...known, ...terms],
        { class: "glossary" },
      ),
    );
  };
})();
