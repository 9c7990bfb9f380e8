// The rest of the first screen: outcomes with bounds, latch orders, warnings, numerical error, commands to reproduce the runs.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;

  function statusBar(set) {
    const total = d3.sum(set.statuses, (one) => one.count) || 1;
    return h(
      "div.stack",
      { "aria-hidden": "true" },
      set.statuses
        .filter((one) => one.count)
        .map((one) => h("span", { class: one.status, style: `flex-grow:${Math.max(one.count, 0.006 * total)}` })),
    );
  }
  // The bounds of an outcome's share, or why there are none.
  W.boundsOf = (one) => (one.note ? h("span.wrapped", one.note) : F.shareBounds(one.lower, one.upper));
  const nameOf = (status) => status.replace("_", " ");
  const key = (name, style) => h("i", { class: `key ${name}`.trim(), style, "aria-hidden": "true" });

  function outcomes() {
    const levels = W.confidences(),
      confidence = `${levels.length === 1 ? `${levels[0]} ` : ""}two-sided bounds`;
    if (W.sets.length === 1) {
      const set = W.set();
      const rows = set.statuses.map((one) => ({
        mark: one.count ? null : "zero",
        cells: [
          h("span", key(one.status), nameOf(one.status)),
          F.count(one.count),
          F.share(one.rate),
          W.boundsOf(one),
        ],
      }));
      return [
        h("h3", "Outcomes"),
        statusBar(set),
        W.table("Outcomes of the runs", ["Outcome", number("Runs"), number("Share"), number(confidence)], rows),
        reasons(set),
        stalledAt(set),
      ];
    }
    const statuses = [...new Set(W.sets.flatMap((set) => set.statuses.map((one) => one.status)))].filter(
      (status) =>
        W.sets.some((set) => set.statuses.some((one) => one.status === status && one.count)) || status === "deployed",
    );
    const cell = function (set, status) {
      const one = set.statuses.find((each) => each.status === status);
      return one
        ? h(
            "span.double",
            `${F.count(one.count)} · ${F.share(one.rate)}`,
            h("small", W.boundsOf(one), levels.length > 1 ? ` (${W.confidenceOf(set)})` : ""),
          )
        : F.none;
    };
    return [
      h("h3", "Outcomes"),
      W.table(
        `Outcomes by ${W.kindOfSets()}, with ${confidence}`,
        [W.headOfSets(), number("Runs"), ...statuses.map((status) => number(nameOf(status)))],
        W.sets.map((set) => [set.label, F.count(set.runs), ...statuses.map((status) => cell(set, status))]),
      ),
      h(
        "p.note",
        `Under each share its ${confidence} (exact for independent draws). Outcomes not listed occurred in no run.`,
      ),
      W.sets.map((set) => [reasons(set, set.label), stalledAt(set, set.label)]),
    ];
  }
  // A reason without the clauses whose numbers differ from run to run: "lacks … J".
  // "energy: no hinge can reach its latch" names its proof first.
  const common = (reason) =>
    reason
      .split(", ")
      .filter((clause, at) => !at || !clause.includes("…"))
      .join(", ")
      .replace(/^energy: (.*)$/, "$1: too little energy")
      .replace(/^every hinge sticks, and .*$/, "every hinge sticks, under loads that no longer change");
  function reasons(set, label) {
    if (!(set.reasons || []).length) return null;
    return h(
      "details",
      { open: set.reasons.length <= 4 },
      h("summary", `Why runs did not deploy${label ? `: ${label}` : ""}`),
      h(
        "ul.plain",
        set.reasons.map((one) =>
          h("li", h("b", F.count(one.count)), ` ${nameOf(one.status)}: ${one.reason ? common(one.reason) : "no reason given"}`),
        ),
      ),
    );
  }

  // Where hinges stopped in the stalled runs in which they did not latch.
  function stalledAt(set, label) {
    if (!(set.stalled_at || []).length) return null;
    const { unit } = F.shown("rad"),
      angle = (value) => F.value(value, "rad");
    return W.table(
      `Where stalled hinges stopped${label ? `: ${label}` : ""}: angle from the latched one, ${unit}`,
      ["Hinge", number("Runs"), number("Median"), number("Least"), number("Largest")],
      set.stalled_at.map((one) => [
        one.hinge,
        F.count(one.count),
        ...[one.median, one.least, one.largest].map(angle),
      ]),
    );
  }

  // Without rows, orders beyond the first 100,000 are not told apart.
  const moreThan = (set) => (set.more_order_kinds ? "more than " : "");
  function others(set) {
    const kinds = set.order_kinds - set.orders.filter((one) => !["others", "no latch"].includes(one.order)).length;
    return `${moreThan(set)}${kinds === 1 ? "one other order" : `${kinds} other orders`}`;
  }
  // A short time in the unit that suits it: "1.3 s", "31 ms", "31 µs".
  function duration(seconds) {
    const [factor, unit] = seconds >= 0.1 ? [1, "s"] : seconds >= 1e-4 ? [1e3, "ms"] : [1e6, "µs"];
    return `${F.number(seconds * factor, 2)} ${unit}`;
  }
  // Below an order, the time between its latches: "gaps 0.82 ms · 0.15 s (median), at least 31 µs · 2 ms". Nothing without rows.
  function gapsOf({ gaps = [] }) {
    if (!gaps.length) return null;
    const list = (key) => gaps.map((gap) => duration(gap[key])).join(" · ");
    return h("small.gaps", { title: gaps.map((gap) => `${gap.before} to ${gap.after}`).join(" · ") }, `gaps ${list("median")} (median), at least ${list("least")}`);
  }
  function orders() {
    const set = W.set();
    if (!(set.orders || []).some((one) => one.order !== "no latch"))
      return [h("h3", "Latch orders"), h("p", "No hinge latched in any run.")];
    const counted = set.orders.some((one) => one.order === "no latch"),
      without = counted ? 0 : set.without_latch || 0;
    const total = d3.sum(set.orders, (one) => one.count) + without,
      colour = (at) => W.marks.colour(W.marks.ofOrder(set, at));
    const rows = set.orders.map((one, at) => [
      h("span", key("", `background:${colour(at)}`), F.isOthers(one.order) ? others(set) : F.order(one.order), gapsOf(one)),
      F.count(one.count),
      F.share(one.count / total),
    ]);
    if (without)
      rows.push([
        h("span", key("", "background:var(--none)"), "no hinge latched"),
        F.count(without),
        F.share(without / total),
      ]);
    const title = h("h3", W.sets.length > 1 ? `Latch orders · ${set.label}` : "Latch orders"),
      table = W.table("Latch orders", ["Order", number("Runs"), number("Share")], rows, { class: "long-names" });
    if (!(set.wing_orders || []).length) return [title, table];
    return [
      title,
      set.wing_orders.map((wing) => ordersOfWing(wing, total)),
      h("details", h("summary", `All wings together: ${moreThan(set)}${F.counted(set.order_kinds, "order")}`), table),
    ];
  }
  // The orders of one wing's hinges among themselves.
  function ordersOfWing(wing, total) {
    const short = (order) =>
      order
        .split(">")
        .map((hinge) => (hinge.startsWith(wing.wing) ? hinge.slice(wing.wing.length).replace(/^[_\-. ]+/, "") || hinge : hinge))
        .join(" › ");
    const listed = d3.sum(wing.orders, (one) => one.count),
      left = total - listed - wing.without_latch;
    const counts = (count) => [F.count(count), F.share(count / total)];
    const rows = wing.orders.map((one) => [h("span", short(one.order), gapsOf(one)), ...counts(one.count)]);
    const others = F.counted(wing.order_kinds - wing.orders.length, "other order");
    if (left > 0) rows.push([W.set().more_order_kinds ? "other orders, or not told apart" : others, ...counts(left)]);
    if (wing.without_latch) rows.push(["no hinge latched", ...counts(wing.without_latch)]);
    return W.table(`Wing ${wing.wing}`, ["Order", number("Runs"), number("Share")], rows, {
      class: "long-names",
      showCaption: true,
    });
  }

  function warnings() {
    // The selected case first: of warnings that differ in numbers, its numbers are shown.
    const sets = [...new Set([...W.sets, ...W.studySets])],
      all = [W.set(), ...sets.filter((set) => set !== W.set())].flatMap((set) => (set.warnings || []).map((text) => ({ set, text })));
    // Warnings that differ in numbers only are one.
    const kind = (text) => text.replace(/\d[\d.]*(e[-+]?\d+)?/g, "#");
    const texts = [...new Map(all.map((one) => [kind(one.text), one.text]).reverse()).values()].reverse();
    const partial = W.sets
      .filter(W.isPartial)
      .map((set) => `${set.label} holds ${F.count(set.runs)} of ${F.count(set.planned)} planned runs.`)
      .concat((W.data.unmade || []).map((one) => `${one.label} holds none of ${F.count(one.planned)} planned runs.`));
    const items = [
      ...partial.map((text) => h("li", text)),
      ...texts.map(function (text) {
        const same = all.filter((one) => one.text === text).map((one) => one.set.label),
          other = all.filter((one) => one.text !== text && kind(one.text) === kind(text)).map((one) => one.set.label),
          where = sets.map((set) => set.label).filter((label) => same.includes(label) || other.includes(label));
        return h(
          "li",
          text,
          sets.length > 1
            ? h("span.faint", ` (${W.sets.length > 1 && where.length === W.sets.length && W.sets.every((set) => where.includes(set.label)) ? `every ${W.kindOfSets()}` : where.join(", ")}${other.length ? `; numbers of ${same.join(", ")}` : ""})`)
            : null,
        );
      }),
    ];
    return h(
      "div",
      { class: items.length ? "warnings" : "warnings none" },
      h("h3", "Warnings"),
      items.length ? h("ul", items.slice(0, 6)) : h("p", "None."),
      items.length > 6 ? h("details", h("summary", `${items.length - 6} more`), h("ul", items.slice(6))) : null,
    );
  }

  // The integration's error beside the statistical error that the number of runs leaves.
  function accuracy() {
    const set = W.set(),
      one = set.accuracy;
    const title = h("h3", "Numerical against statistical error");
    const rows = ((one && one.outputs) || []).filter((row) => W.isNumber(row.largest));
    if (!rows.length)
      return [
        title,
        h("p", one && !one.runs && one.unreached ? `Unknown: ${F.runs(one.unreached)} could not be repeated at a tighter tolerance.` : "No runs were repeated at a tighter tolerance."),
      ];
    const share = (row) =>
      W.isNumber(row.standard_error) && row.standard_error > 0 ? row.largest / row.standard_error : null;
    const ordered = rows.slice().sort((a, b) => (share(b) || 0) - (share(a) || 0)),
      worst = share(ordered[0]);
    const times =
      worst === null || worst === 0
        ? null
        : worst < 1
          ? `${F.number(Number((1 / worst).toPrecision(2)), 2)} times smaller than`
          : `${F.number(worst, 2)} times`;
    const table = W.table(
      "Numerical and statistical error of each output",
      ["Output", "Unit", number("Numerical, largest"), number("Numerical, rms"), number("Standard error of the mean")],
      ordered.map((row) => {
        const output = W.outputsOf(set).find((each) => each.name === row.output),
          { factor, unit } = F.shown(output && output.unit),
          text = (value) => F.number(W.isNumber(value) ? value * factor : null, 2);
        return [
          F.nameOf(row.output),
          unit,
          text(row.largest),
          text(row.rms),
          text(row.standard_error),
        ];
      }),
    );
    return [
      title,
      h(
        "p",
        `${F.runs(one.runs)} repeated with ${one.reference_method} at rtol ${F.number(one.reference_rtol, 2)} (the campaign: ${one.method}, ${F.number(one.rtol, 2)}). `,
        times
          ? h(
              "b",
              `At worst (${F.nameOf(ordered[0].output)}) the integration error is ${times} the standard error of the mean.`,
            )
          : "They agree to the last digit, or the statistical error is unknown.",
        one.order_in_doubt
          ? ` In ${F.runs(one.order_in_doubt)} the outcome or the latch order is in doubt${one.in_doubt ? `: ${one.in_doubt.join(", ")}` : ""}.`
          : ` In none of them the outcome or the latch order is in doubt.`,
        one.beyond_largest
          ? ` As only ${F.runs(one.runs)} ${one.runs === 1 ? "was" : "were"} repeated, up to ${F.share(one.beyond_largest.share_at_most)} of all runs may have a larger error than the largest of these (${F.given(100 * set.confidence)} % confidence); more repeated runs lower this share.`
          : null,
        one.moved && one.moved.runs
          ? ` In ${F.runs(one.moved.runs)} an output moves by more than 1 %: at most ${F.share(one.moved.share_at_most)} of all.`
          : null,
        one.unreached ? ` ${F.runs(one.unreached)} could not be repeated.` : null,
      ),
      h("details", h("summary", "Every output"), table),
    ];
  }

  const designOf = (set) => `${set.design.replace(/_/g, " ")} design${set.replicates > 1 ? `, ${set.replicates} replicates` : ""}`;
  function again() {
    const made = [...new Map(W.sets.filter((set) => set.made_by).map((set) => [set.made_by, set])).values()],
      analysed = [...new Map(W.sets.filter((set) => set.judged_by).map((set) => [set.judged_by, set])).values()];
    return h(
      "div.again",
      h("h3", "Reproduce"),
      made.map((set) => W.command(set.made_by, `command of ${set.label}`)),
      analysed.map((set) => W.command(set.judged_by, `command that analyses ${set.label}`)),
      W.command(W.data.command, "command of this report"),
      h(
        "p.note",
        W.sets.filter((set) => set.made_by).map((set, at) => [
          at ? "; " : "",
          W.sets.length > 1 ? `${set.label}: ` : "",
          `wingspread ${set.version}, seed ${set.seed}, campaign hash `,
          h("code.hash", set.hash),
        ]),
        W.set().design ? `; ${designOf(W.set())}` : null,
        made.length ? ". The same seed gives the same bytes on any number of threads." : null,
      ),
    );
  }

  // Where requirements have an identifier, a source or a rationale, a table traces them.
  function traced() {
    const all = [...new Map(W.sets.flatMap((set) => (set.requirements || []).map((one) => [W.verdicts.keyOf(one), { one, set }]))).values()],
      known = all.filter(({ one }) => one.id || one.source || one.rationale);
    return known.length
      ? [
          h("h3", "Where the requirements come from"),
          W.table(
            "Identifier, source and rationale of each requirement",
            ["Identifier", "Requirement", "Source", "Rationale"],
            all.map(({ one, set }) => [
              one.id || F.none,
              W.verdicts.wordsOf({ ...one, id: "" }, set),
              one.source || F.none,
              one.rationale || F.none,
            ]),
            { class: "traced" },
          ),
        ]
      : null;
  }

  W.outcomes = function () {
    W.subtitle();
    if (W.onlyStudies) {
      const labels = W.studySets.map((set) => `${set.label}${set.made_by ? ` (${set.made_by})` : ""}`);
      W.fill(
        W.section("verdicts"),
        h("p.headline", "Results of margin, sensitivity, rare or fit, without runs of a campaign."),
        h(
          "p",
          `${labels.join(", ")}: see “Causes”. Add a results folder of wingspread run to this report for verdicts and distributions.`,
        ),
        warnings(),
        again(),
      );
      return;
    }
    W.fill(
      W.section("verdicts"),
      h(
        "div.first",
        h("div.judgement", W.verdicts.requirements()),
        W.withoutRowsNote(),
        h("div.columns", h("div", outcomes()), h("div", orders()), h("div", warnings(), accuracy())),
        traced(),
        W.assumptions(),
        again(),
      ),
    );
  };
})();
