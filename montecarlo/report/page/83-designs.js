// What the comparison of folders compares: the sets, and the inputs that differ between them.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;

  const OWNED = /^(hinges|bodies|synchronisations)\b/; // parameters with an owner's name
  // The value of an input.
  const textOf = (W.inputText = (value) =>
    typeof value === "number" ? F.given(value) : value === null || value === undefined ? F.none : String(value));
  const knots = (table) => table.at.map((x, k) => `${F.given(x)}: ${F.given(table.value[k])}`).join(" · ");

  // The value of a parameter that the list of a scene lacks. The list has neither zeros nor parameters that the wing lacks;
  // where nothing of a hinge, body or loop is listed, the wing lacks it.
  W.unlisted = function (set, path) {
    const [kind, owner] = path.split("."),
      all = (set.inputs || {}).scene || [];
    return !OWNED.test(path) || all.some((one) => one.path.startsWith(`${kind}.${owner}.`)) ? "0 or none" : null;
  };
  // The listed inputs of a set, by a key that names each one once: { list, name, label, unit, value }. `name` is the path of
  // what stands in the scene.
  function listOf(set) {
    const { scene = [], tables = [], dispersions = [], settings = [] } = set.inputs || {};
    const inWords = (path) => path.replace(OWNED, "").replace(/^\./, "").replace(/[._]/g, " ");
    const found = [
      ...scene.map((one) => ({ list: "scene", name: one.path, label: one.label, unit: one.unit, value: one.case_value ?? one.value })),
      ...tables.flatMap(({ path, columns }) =>
        columns.map(({ name, unit, values }) => ({
          ...{ list: "tables", name: `${path}.${name}`, label: `${inWords(path)}: ${name.replace(/_/g, " ")}`, unit },
          value: values.map(F.given).join(" · "),
        })),
      ),
      ...dispersions.flatMap(function ({ draw, law, apply, paths = [], tables: through = [] }) {
        const of = (name, value, more = "") => ({ list: `dispersion ${draw}`, name, label: `dispersion ${draw}${more}`, unit: "", value });
        return [
          of("law", `${law}${apply ? `, ${apply}` : ""}`),
          of("paths", paths.join(", "), " acts on"),
          ...through.map((one) => of(`${one.apply} ${one.paths.join(" ")}`, knots(one), `: ${one.words || one.paths.join(", ")} (${one.apply})`)),
        ];
      }),
      ...settings.map((one) => ({ list: "settings", name: one.label, label: one.label, unit: "", value: one.value })),
    ];
    return new Map(found.map((one) => [`${one.list} ${one.name}`, one]));
  }
  // Equal changes of several bodies or hinges are one row.
  function together(rows) {
    const groups = d3.group(rows, (row) => JSON.stringify([row.kind, ...row.cells.slice(1)]));
    return [...groups.values()].map(function (group) {
      const [label, ...cells] = group[0].cells;
      return [group.length > 1 ? `${group[0].what}: ${group.map((row) => row.owner).join(", ")}` : label, ...cells];
    });
  }
  // The rows of the inputs that differ. A dispersion that one set lacks has one row.
  function differing(first, second) {
    const [a, b] = [first, second].map(listOf),
      both = (one) => [a, b].every((list) => list.has(`${one.list} law`)),
      place = ({ list }) => ["scene", "tables", "dispersion", "settings"].indexOf(list.split(" ")[0]);
    const rows = [...new Set([...a.keys(), ...b.keys()])]
      .map((key) => ({ key, one: a.get(key) || b.get(key), values: [a, b].map((list) => (list.get(key) || {}).value) }))
      .filter(({ one, values: [x, y] }) => textOf(x) !== textOf(y) && (!one.list.startsWith("dispersion ") || one.name === "law" || both(one)))
      .sort((x, y) => place(x.one) - place(y.one))
      .map(function ({ key, one, values: [x, y] }) {
        const change = typeof x === "number" && typeof y === "number" && x !== 0 ? (100 * (y - x)) / Math.abs(x) : null,
          inScene = ["scene", "tables"].includes(one.list),
          text = (value, set) => textOf(one.list === "scene" ? (value ?? W.unlisted(set, one.name)) : value),
          [, owner, ...field] = one.name.split(".");
        return {
          cells: [one.label, F.unit(one.unit), text(x, first), text(y, second), W.isNumber(change) ? `${change > 0 ? "+" : ""}${F.number(change, 3)} %` : ""],
          kind: inScene ? `${one.list} ${field.join(".")}` : key,
          owner,
          what: field.join(" ").replace(/_/g, " "),
        };
      });
    return together(rows);
  }
  // The table of one pair of sets. `others` have the same rows.
  function inputs({ pair: [first, second], rows }, others) {
    const columns = ["Input", "Unit", number(first.label), number(second.label), number("Change")],
      also = others.map(({ pair: [one, other] }) => `${other.label} against ${one.label}`);
    if (rows.length)
      return W.table(`Inputs that differ: ${second.label} against ${first.label}${also.length ? `; the same for ${W.verdicts.listed(also)}` : ""}`, columns, rows, {
        showCaption: true,
        class: "tall",
      });
    return h("p", `No ${first.hash === second.hash ? "input" : "listed input"} of ${second.label} differs from ${first.label}${also.length ? `; nor of ${W.verdicts.listed(also)}` : ""}.${first.hash === second.hash ? "" : " Their campaigns' hashes differ: compare their files campaign.json."}`);
  }

  // The sets of all comparisons of folders, and what differs in each. Pairs with equal differences share a table; several
  // tables are folded.
  W.designs = function (comparisons) {
    const pairs = comparisons.map(({ sets }) => sets.map((at) => W.sets[at])),
      found = pairs.map((pair) => ({ pair, rows: differing(...pair) })),
      groups = [...d3.group(found, ({ pair, rows }) => JSON.stringify([rows, rows.length ? "" : pair[0].hash === pair[1].hash])).values()],
      count = ({ length }) => (length ? F.counted(length, "listed input differs", "listed inputs differ") : "no listed input differs"),
      row = (set) => [
        set.label,
        set.campaign,
        h("code", set.folder),
        F.count(set.runs),
        set.seed,
        h("code.hash", String(set.hash).slice(0, 12)),
      ];
    return [
      W.table("What is compared", ["Set", "Wing", "Folder", number("Runs"), "Seed", "Campaign hash"], [...new Set(pairs.flat())].map(row), {
        showCaption: true,
      }),
      groups.map(([one, ...others]) =>
        groups.length > 1
          ? h("details.later.inputs-that-differ", h("summary", `${one.pair[1].label} against ${one.pair[0].label}: ${count(one.rows)}`), inputs(one, others))
          : inputs(one, others),
      ),
    ];
  };
})();
