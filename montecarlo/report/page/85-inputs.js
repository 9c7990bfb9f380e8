// The inputs: scene, dispersions, changes by case, integration settings; and the glossary.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;

  // An angle or a rate in degrees, as drawings state it.
  const inDegrees = (value, unit) =>
    W.isNumber(value) && F.angular(unit)
      ? `${F.given(Number((value * F.DEGREES).toPrecision(6)))} ${unit.replace("rad", "deg")}`
      : "";
  const isChanged = (parameter) => parameter.case_value !== null && parameter.case_value !== undefined;
  const either = W.inputText;

  function changed() {
    const sets = W.sets.filter((set) => set.inputs && (set.inputs.scene || []).some(isChanged));
    const lawsDiffer = W.sets.some((set) => ((set.inputs || {}).dispersions || []).some((one) => one.law_before_case));
    if (!sets.length)
      return W.sets.some((set) => set.case)
        ? h("p", `No case changes a listed parameter of the scene${lawsDiffer ? "; the cases' distributions differ (below)" : ""}.`)
        : null;
    const paths = [...new Set(sets.flatMap((set) => set.inputs.scene.filter(isChanged).map((one) => one.path)))];
    const find = (set, path) => (set.inputs.scene || []).find((one) => one.path === path);
    // Folders may have different nominal values: then each set shows its own.
    const rows = paths.map(function (path) {
      const found = W.sets.map((set) => set.inputs && find(set, path)),
        first = found.find(Boolean),
        nominal = (one, at) => either(one ? one.value : W.unlisted(W.sets[at], path)),
        nominals = new Set(found.map((one, at) => nominal(one, at).replace(/^0 or none$/, "0")));
      return [
        h("span", first.label),
        F.unit(first.unit),
        nominals.size > 1 ? "by folder" : either(first.value),
        ...found.map((one, at) =>
          one && isChanged(one) ? h("b", either(one.case_value)) : nominals.size > 1 ? nominal(one, at) : "as nominal",
        ),
      ];
    });
    return [
      h("h3", "Changes by case"),
      W.table(
        "Changes of the nominal scene by case",
        ["Parameter", "Unit", number("Nominal"), ...W.sets.map((set) => number(set.label))],
        rows,
      ),
    ];
  }
  // Dispersions whose law differs between sets.
  function laws() {
    if (W.sets.length < 2) return null;
    const names = [...new Set(W.sets.flatMap((set) => (set.inputs.dispersions || []).map((one) => one.draw)))];
    const law = (set, name) => ((set.inputs.dispersions || []).find((one) => one.draw === name) || { law: F.none }).law;
    const differing = names.filter((name) => new Set(W.sets.map((set) => law(set, name))).size > 1);
    return differing.length
      ? W.table(
          "Dispersions whose law differs",
          ["Dispersion", ...W.sets.map((set) => set.label)],
          differing.map((name) => [W.drawInWords(W.set(), name), ...W.sets.map((set) => law(set, name))]),
          { showCaption: true },
        )
      : null;
  }

  // The knots of a draw's table, by set where they differ.
  function knots(tables, sets) {
    const text = (table) => (table ? table.at.map((x, k) => `${F.given(x)}: ${F.given(table.value[k])}`).join(" · ") : F.none),
      groups = [...d3.group(sets, (_, at) => text(tables[at]))];
    return groups.length === 1 ? groups[0][0] : h("span.double", groups.map(([words, own]) => h("small", `${W.verdicts.listed(own.map((set) => set.label))}: ${words}`)));
  }
  // What a draw does through its tables, at its median in each case: "friction of all hinges: × 1.97 in cold, × 1 in ambient".
  // The tables of two folders are the same table if they act on the same parameters in the same way.
  function tables(set) {
    const drawn = (one) => ((one.inputs || {}).dispersions || []).filter((each) => (each.tables || []).length);
    return drawn(set).map(function (one) {
      const sets = W.sets.filter((each) => drawn(each).some((other) => other.draw === one.draw)),
        own = (each) => drawn(each).find((other) => other.draw === one.draw),
        keyOf = (table) => `${table.apply} ${table.paths.join(" ")}`,
        all = [...new Map([one, ...sets.map(own)].flatMap((each) => each.tables.map((table) => [keyOf(table), table]))).values()],
        sign = { scale: "× ", add: "+ ", set: "" };
      return W.table(
        `What ${one.words || one.draw} changes, at its median`,
        [
          "Changes",
          ...sets.map((each) => number(sets.length > 1 ? `${each.label}: ${F.number(own(each).median, 3)}` : `at ${F.number(own(each).median, 3)}`)),
          "Table",
        ],
        all.map(function (table) {
          const found = sets.map((each) => own(each).tables.find((other) => keyOf(other) === keyOf(table)));
          return [
            h("span", { title: table.paths.join(", ") }, table.words, table.unit ? ` (${F.unit(table.unit)})` : null),
            ...found.map((each) => (each ? `${sign[table.apply]}${F.number(each.of_median, 3)}` : F.none)),
            h("span.law", knots(found, sets)),
          ];
        }),
        { showCaption: true, class: "drive-tables" },
      );
    });
  }

  function scene(set) {
    const rows = (set.inputs.scene || []).map((one) => ({
      mark: isChanged(one) ? "changed" : null,
      cells: [
        one.label,
        either(one.value),
        F.unit(one.unit),
        inDegrees(one.value, one.unit),
        either(one.case_value),
        h("code", one.path),
      ],
    }));
    const anyCase = rows.some((row) => row.mark);
    const columns = ["Parameter", number("Value"), "Unit", number("In degrees"), number(`In ${set.label}`), "Path"];
    const drop = (list) => list.filter((_, at) => anyCase || at !== 4);
    return h(
      "details",
      { open: rows.length <= 80 },
      h("summary", `Scene: ${F.count(rows.length)} parameters`),
      W.table(
        `Scene of ${set.label}`,
        drop(columns),
        rows.map((row) => ({ mark: row.mark, cells: drop(row.cells) })),
        { class: "tall" },
      ),
    );
  }
  function sceneTables(set) {
    const rows = (set.inputs.tables || []).flatMap((table) =>
      table.columns.map(function (column, at) {
        const { factor, unit } = F.shown(column.unit),
          values = column.values.map((value) => F.number(value * factor, 5));
        return [at ? "" : h("code", table.path), column.name.replace(/_/g, " "), unit, h("span.law", values.join(" · "))];
      }),
    );
    return rows.length
      ? h(
          "details",
          { open: rows.length <= 30 },
          h("summary", `Tables of the scene: ${F.count(set.inputs.tables.length)}`),
          W.table(`Tables of the scene of ${set.label}, before dispersion`, ["Table", "Column", "Unit", "Values"], rows, { class: "scene-tables" }),
        )
      : null;
  }
  function dispersions(set) {
    const rows = (set.inputs.dispersions || []).map((one) => [
      h("span", one.words && one.words !== one.draw ? [one.words, " ", h("small.faint", one.draw)] : one.draw),
      h(
        "span",
        { class: String(one.law).length < 60 ? "law nowrap" : "law" },
        one.law,
        one.law_before_case ? h("small.faint", ` (nominal: ${one.law_before_case})`) : null,
      ),
      F.unit(one.unit),
      (one.paths || []).length > 1
        ? F.none
        : `${either(one.nominal)} ${one.nominal_unit && one.nominal_unit !== one.unit ? F.unit(one.nominal_unit) : ""}`.trim(),
      `${F.number(one.low, 4)} … ${F.number(one.high, 4)}`,
      inDegrees(one.low, one.unit) ? `${inDegrees(one.low, one.unit)} … ${inDegrees(one.high, one.unit)}` : "",
      h(
        "span.paths",
        one.apply ? `${one.apply}: ` : null,
        (one.paths || []).map((path, at) => [at ? ", " : "", h("code", path)]),
      ),
    ]);
    // omit the unit and degree columns where they are empty
    const kept = (at) => ![2, 5].includes(at) || rows.some((row) => row[at]),
      drop = (list) => list.filter((_, at) => kept(at));
    return h(
      "details",
      { open: rows.length <= 60 },
      h("summary", `Dispersions: ${F.count(rows.length)}`),
      rows.length
        ? W.table(
            `Dispersions of ${set.label}`,
            drop([
              "Dispersion",
              "Law",
              "Unit",
              number("As written"),
              number("Draw, 1 % … 99 %"),
              number("In degrees"),
              "Acts on",
            ]),
            rows.map(drop),
          )
        : h("p", "The campaign has no dispersions."),
    );
  }
  function settings(set) {
    return W.table(
      "Integration settings",
      ["Setting", "Value"],
      (set.inputs.settings || []).map((one) => [one.label, either(one.value)]),
      { showCaption: true },
    );
  }

  W.inputs = function () {
    const set = W.set();
    if (!set.inputs || !(set.inputs.scene || []).length)
      return W.fill(W.section("inputs"), h("p.nothing", "The folder does not contain its campaign's inputs."));
    W.fill(
      W.section("inputs"),
      changed(),
      laws(),
      tables(set),
      W.sets.length > 1 ? h("h3", set.label) : null,
      scene(set),
      sceneTables(set),
      dispersions(set),
      h("div.narrow", settings(set)),
    );
  };

  W.glossary = function () {
    const rows = Object.entries(W.data.glossary || {}).map(([name, { unit, text }]) => [
      h("code", name),
      F.shown(unit).unit || F.none,
      text,
    ]);
    const columns = ["Name", "Unit", "Meaning"];
    W.fill(
      W.section("glossary"),
      W.table("Meaning, unit and sign of every name", columns, rows, { class: "glossary" }),
    );
  };
})();
