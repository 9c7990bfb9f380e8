// The first screen: the verdict and margin of every requirement, by case, the worst first.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;
  const RANK = { failed: 0, open: 1, passed: 2 };
  const WORDS = { passed: ["pass", "✓"], failed: ["fail", "✕"], open: ["undecided", "?"] };
  const verdictOf = (word) => ({ pass: "passed", fail: "failed", undecided: "open" })[word] || word;

  W.badge = function (verdict, small) {
    const [word, sign] = WORDS[verdictOf(verdict)] || [verdict, "?"];
    return h(
      "span",
      { class: `badge ${verdictOf(verdict)}`, title: word },
      h("span", { "aria-hidden": "true" }, sign + " "),
      h("span", { class: small ? "unseen" : null }, word),
    );
  };

  // Every requirement of every set, the worst first: by verdict, then by margin relative to the limit. A requirement on a
  // share has no such margin; its share of broken runs beyond the allowed one takes its place.
  function judged() {
    const all = W.sets.flatMap((set, at) => (set.requirements || []).map((requirement) => ({ set, at, requirement })));
    const strain = ({ requirement: one, set }) =>
      W.isNumber(one.margin) && W.isNumber(one.limit) && one.limit !== 0
        ? -one.margin / Math.abs(one.limit)
        : one.broken / Math.max(1, set.runs) - (1 - one.probability);
    return all.sort(
      (a, b) =>
        RANK[verdictOf(a.requirement.verdict)] - RANK[verdictOf(b.requirement.verdict)] || strain(b) - strain(a),
    );
  }

  function headline(rows) {
    if (!rows.length)
      return h(
        "p.headline",
        "This campaign states no requirements.",
        h("small", " This report has statistics only, no verdicts."),
      );
    // The worst case of a requirement decides.
    const worstOf = new Map();
    for (const row of rows)
      if (!worstOf.has(row.requirement.text)) worstOf.set(row.requirement.text, verdictOf(row.requirement.verdict));
    const total = worstOf.size,
      count = (verdict) => [...worstOf.values()].filter((one) => one === verdict).length;
    const [failed, open, passed] = ["failed", "open", "passed"].map(count),
      worst = failed ? "failed" : open ? "open" : "passed";
    const noun = total === 1 ? "requirement" : "requirements",
      several = W.sets.length > 1;
    const failing = [
      ...new Set(rows.filter((row) => verdictOf(row.requirement.verdict) === "failed").map((row) => row.set.label)),
    ];
    const where =
      !several || !failed ? "" : failing.length === W.sets.length ? ", in every case" : `, in ${listed(failing)}`;
    const text = failed
      ? `${failed} of ${total} ${noun} not shown to be met${where}`
      : open
        ? `${open} of ${total} ${noun} undecided: too few runs to show ${open === 1 ? "it" : "them"}`
        : `${total === 1 ? "The requirement is" : `All ${total} requirements are`} shown to be met${several ? " in every case" : ""}`;
    const parts = [
      failed && open ? `${open} undecided` : null,
      passed && worst !== "passed" ? `${passed} passed${several ? " in every case" : ""}` : null,
    ].filter(Boolean);
    return h(
      "p",
      { class: `headline ${worst}` },
      W.badge(worst),
      " ",
      text,
      parts.length ? h("small", ` ${parts.join(", ")}`) : null,
    );
  }
  const listed = (names) =>
    names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}` : names[0];

  function unitOf(requirement, set) {
    const output = W.outputsOf(set).find((one) => one.name === requirement.output);
    return output ? output.unit : "";
  }
  // Four significant digits, and two of the margin, so that the value differs visibly from its limit.
  function valueText(value, requirement, set) {
    if (!W.isNumber(value)) return F.none;
    const size = (number) => (W.isNumber(number) && number !== 0 ? Math.floor(Math.log10(Math.abs(number))) : 0);
    const decimals = Math.max(
      3 - size(W.isNumber(requirement.guaranteed_value) ? requirement.guaranteed_value : value),
      W.isNumber(requirement.margin) ? 1 - size(requirement.margin) : 0,
    );
    return `${decimals > 7 ? F.number(value, 4) : F.fixed(value, decimals)} ${F.unit(unitOf(requirement, set))}`.trim();
  }
  const observed = (one, set) =>
    W.isNumber(one.observed_value) ? valueText(one.observed_value, one, set) : F.share(one.observed);
  function guaranteed(one, set) {
    if (W.isNumber(one.limit))
      return W.isNumber(one.guaranteed_value) ? valueText(one.guaranteed_value, one, set) : "too few runs with a value";
    return W.isNumber(one.guaranteed) ? F.share(one.guaranteed) : "too few runs";
  }
  function marginText(one, set) {
    if (W.isNumber(one.margin) && W.isNumber(one.limit))
      return `${one.margin > 0 ? "+" : ""}${F.number(one.margin, 3)} ${F.unit(unitOf(one, set))}`.trim();
    return W.isNumber(one.guaranteed) && !W.isNumber(one.limit)
      ? `${one.guaranteed > one.probability ? "+" : ""}${F.fixed(100 * (one.guaranteed - one.probability), 2)} points`
      : F.none;
  }

  // Limit, observed and guaranteed value on one line. Shares stand on a scale of nines, -log10(1 - share): 99 % at 2.
  function bullet(one) {
    const nines = (share) => Math.min(5, -Math.log10(Math.max(1e-5, 1 - share)));
    const values = W.isNumber(one.limit)
      ? { limit: one.limit, observed: one.observed_value, guaranteed: one.guaranteed_value }
      : {
          limit: nines(one.probability),
          observed: nines(one.observed),
          guaranteed: W.isNumber(one.guaranteed) ? nines(one.guaranteed) : null,
        };
    const upper = W.isNumber(one.limit) ? one.upper : false;
    const known = Object.values(values).filter(W.isNumber),
      far = Math.max(...known.map((value) => Math.abs(value - values.limit)), Math.abs(values.limit) * 0.02, 1e-12);
    const x = d3.scaleLinear([values.limit - 1.15 * far, values.limit + 1.15 * far], [2, 118]).clamp(true);
    const svg = M.small("bullet", 120, 18);
    M.put(svg, "rect.good", {
      x: upper ? 0 : x(values.limit),
      width: upper ? x(values.limit) : 120 - x(values.limit),
      y: 4,
      height: 10,
    });
    M.put(svg, "line.limit-mark", { x1: x(values.limit), x2: x(values.limit), y1: 0, y2: 18 });
    if (W.isNumber(values.observed) && W.isNumber(values.guaranteed))
      M.put(svg, "line.between", { x1: x(values.observed), x2: x(values.guaranteed), y1: 9, y2: 9 });
    if (W.isNumber(values.observed)) M.put(svg, "circle.observed", { cx: x(values.observed), cy: 9, r: 3.2 });
    if (W.isNumber(values.guaranteed)) M.put(svg, "path.guaranteed", { d: `M${x(values.guaranteed)},3.5 v11` });
    return svg.node();
  }

  function brokenRuns(one, at) {
    if (!one.broken) return "0";
    const runs = (one.broken_runs || [])
      .slice(0, 5)
      .map((run) => h("button.run", { onclick: () => W.selectRun(at, run) }, String(run)));
    return [
      F.count(one.broken),
      runs.length
        ? h(
            "span.runs",
            h("span.faint", one.broken > runs.length ? " worst: " : one.broken === 1 ? " run: " : " runs: "),
            runs.flatMap((run, k) => (k ? [", ", run] : [run])),
          )
        : null,
    ];
  }

  function requirementTable(rows) {
    const several = W.sets.length > 1;
    const columns = [
      "Requirement",
      "Verdict",
      several && "Case",
      number("Observed"),
      number("Guaranteed"),
      number("Margin"),
      "Against the limit",
      "Runs that break it",
    ].filter(Boolean);
    const body = rows.map(({ requirement: one, set, at }) => ({
      mark: verdictOf(one.verdict),
      cells: [
        h(
          "span",
          one.text,
          h("span.evidence", one.evidence, one.disproved && !/disproved/.test(one.evidence) ? " · disproved" : null),
        ),
        W.badge(one.verdict),
        several && h("span.nowrap", set.label),
        observed(one, set),
        guaranteed(one, set),
        marginText(one, set),
        bullet(one),
        h("span", brokenRuns(one, at)),
      ].filter((cell) => cell !== false),
    }));
    return W.table("Requirements, the worst first", columns, body, { class: "requirements", stacks: true });
  }

  // One cell per requirement and case.
  function matrix(rows) {
    const texts = [...new Set(rows.map((row) => row.requirement.text))];
    const cell = function (text, at) {
      const row = rows.find((one) => one.at === at && one.requirement.text === text);
      return row
        ? h("span.cell", W.badge(row.requirement.verdict, true), marginText(row.requirement, row.set))
        : F.none;
    };
    return W.table(
      "Verdict and margin by case",
      ["Requirement", ...W.sets.map((set) => number(set.label))],
      texts.map((text) => [text, ...W.sets.map((set, at) => cell(text, at))]),
      { class: "matrix", showCaption: true },
    );
  }

  function requirements() {
    const rows = judged();
    if (!rows.length) return [headline(rows)];
    const several = W.sets.length > 1;
    const shown = several
      ? rows.filter((row, at) => rows.findIndex((one) => one.requirement.text === row.requirement.text) === at)
      : rows;
    const more =
      rows.length > shown.length
        ? h(
            "details",
            h("summary", `Every requirement in every case (${rows.length} verdicts)`),
            requirementTable(rows),
          )
        : null;
    return [
      headline(rows),
      several ? [matrix(rows), h("h3", "The worst case of each requirement")] : null,
      requirementTable(shown),
      h(
        "p.note",
        "● observed: quantile (or share) of the runs. ┃ guaranteed: one-sided tolerance limit at the stated confidence; the requirement passes when it lies on the shaded side of the limit. Shares stand on a logarithmic scale: 90, 99, 99.9 % are equally far apart.",
      ),
      more,
    ];
  }

  W.verdicts = { judged, requirements, verdictOf, unitOf, guaranteed, observed };
})();
