// The first screen: the verdict of every requirement and its distance to the limit, by case, the worst first.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;
  const RANK = { failed: 0, open: 1, passed: 2 };
  const WORDS = { passed: ["pass", "✓"], failed: ["fail", "✕"], open: ["undecided", "?"] };
  const verdictOf = (word) => ({ pass: "passed", fail: "failed", undecided: "open" })[word] || word;

  W.badge = function (verdict, small, suffix = "") {
    const [word, sign] = WORDS[verdictOf(verdict)] || [verdict, "?"];
    return h(
      "span",
      { class: `badge ${suffix && verdictOf(verdict) === "passed" ? "open" : verdictOf(verdict)}`, title: word },
      h("span", { "aria-hidden": "true" }, sign + " "),
      h("span", { class: small && !suffix ? "unseen" : null }, word + suffix),
    );
  };
  // The badge of a set's requirement: "undecided so far" while runs of the set's campaign are missing.
  W.verdictBadge = (verdict, set, small) => W.badge(verdict, small, W.isPart(set) ? " so far" : "");

  // The guaranteed value's distance to the limit, positive where the limit is kept; of too few runs the observed value's.
  function marginOf(one) {
    if (!W.isNumber(one.limit)) return null;
    if (W.isNumber(one.margin)) return one.margin;
    if (!W.isNumber(one.observed_value)) return null;
    return one.upper ? one.limit - one.observed_value : one.observed_value - one.limit;
  }

  // Broken runs divided by the allowed number; if the runs are too few for a pass, by N (1 − p).
  function usedShare({ requirement: one, set }) {
    const allowed = W.isNumber(one.allowed) ? one.allowed : set.runs * (1 - one.probability);
    return one.broken === 0 ? 0 : allowed > 0 ? one.broken / allowed : Infinity;
  }
  // The margin divided by the limit; of a share, divided by 1 − p. Less is worse.
  function relativeMargin({ requirement: one }) {
    const margin = marginOf(one);
    if (margin !== null) return one.limit !== 0 ? margin / Math.abs(one.limit) : margin;
    return ((W.isNumber(one.guaranteed) ? one.guaranteed : one.observed) - one.probability) / (1 - one.probability);
  }
  // Every requirement of every set, the worst first: by verdict, by the share of the allowed failures that is used up, by
  // margin. Requirements and sets with equal numbers keep their order.
  function judged() {
    const all = W.sets.flatMap((set, at) => (set.requirements || []).map((requirement) => ({ set, at, requirement })));
    const falling = (a, b) => (a === b ? 0 : b - a);
    return all.sort(
      (a, b) =>
        W.isPart(a.set) - W.isPart(b.set) || // which has no verdict
        RANK[verdictOf(a.requirement.verdict)] - RANK[verdictOf(b.requirement.verdict)] ||
        falling(usedShare(a), usedShare(b)) ||
        falling(-relativeMargin(a), -relativeMargin(b)),
    );
  }

  // Counts of verdicts: { failed, open, passed }.
  const tally = (verdicts) =>
    Object.fromEntries(Object.keys(RANK).map((verdict) => [verdict, verdicts.filter((one) => one === verdict).length]));
  // "2 fail, 3 pass", without zeros.
  const tallyText = (counts) =>
    [
      counts.failed ? `${counts.failed} ${counts.failed === 1 ? "fails" : "fail"}` : null,
      counts.open ? `${counts.open} undecided` : null,
      counts.passed ? `${counts.passed} ${counts.passed === 1 ? "passes" : "pass"}` : null,
    ]
      .filter(Boolean)
      .join(", ");
  const unmade = () => W.data.unmade || [];
  // "cold: 6 fail; ambient and hot: 2 fail, 4 pass; late: not judged": sets with equal counts share an entry.
  function bySet(rows) {
    const groups = new Map();
    const add = (label, text) => groups.set(text, [...(groups.get(text) || []), label]);
    W.sets.forEach(function (set, at) {
      const own = rows.filter((row) => row.at === at).map((row) => verdictOf(row.requirement.verdict));
      add(set.label, !own.length ? "no requirements" : W.isPart(set) ? "not judged" : tallyText(tally(own)));
    });
    unmade().forEach((one) => add(one.label, "not judged"));
    return [...groups].map(([text, labels]) => `${listed(labels)}: ${text}`).join("; ");
  }
  // The headline where sets lack runs of their campaign, and no other set fails.
  function unfinished(rows) {
    const several = W.sets.length + unmade().length > 1,
      shards = W.sets.filter((set) => set.shard).map((set) => `${several ? `${set.label} is ` : ""}shard ${set.shard}`);
    return h(
      "p.headline.open.incomplete",
      h("span.badge.open", W.incomplete() ? "? incomplete" : "? not judged"),
      ` ${W.incomplete() || listed(shards)}`,
      rows.length
        ? [h("small", " There is no final verdict."), several ? h("small", ` ${bySet(rows)}`) : null]
        : h("small", " This campaign states no requirements. The statistics are of the runs so far."),
    );
  }
  function headline(all) {
    const rows = all.filter((row) => !W.isPart(row.set)), // the others are not judged
      failed = rows.some((row) => verdictOf(row.requirement.verdict) === "failed");
    const states = (one) => // as other cases of its folder do; without any it is not known
      !W.sets.some((set) => set.campaign_folder === one.campaign_folder && !(set.requirements || []).length);
    const unjudged = rows.length < all.length || unmade().some(states);
    if (all.length ? !failed && unjudged : W.incomplete()) return unfinished(all);
    if (!rows.length)
      return h(
        "p.headline",
        "This campaign states no requirements.",
        h("small", " This report has statistics only, no verdicts."),
      );
    // The worst case of a requirement decides.
    const worstOf = new Map();
    for (const row of rows)
      if (!worstOf.has(keyOf(row.requirement))) worstOf.set(keyOf(row.requirement), verdictOf(row.requirement.verdict));
    const total = worstOf.size,
      counts = tally([...worstOf.values()]),
      worst = counts.failed ? "failed" : counts.open ? "open" : "passed",
      several = W.sets.length + unmade().length > 1;
    const failing = W.sets.filter((_, at) =>
      rows.some((row) => row.at === at && verdictOf(row.requirement.verdict) === "failed"),
    );
    const where = !several ? "" : failing.length === 1 ? ` in ${failing[0].label}` : ` in at least one ${W.kindOfSets()}`;
    const each = total === 1 ? "The requirement" : worst === "passed" ? `All ${total} requirements` : `Each of ${total} requirements`;
    const one = (count, many, single) => (count === 1 ? single : many);
    // Few requirements that decide the verdict are named.
    const deciding = [...new Map(rows.map((row) => [keyOf(row.requirement), row.requirement])).values()].filter(
      (requirement) => worstOf.get(keyOf(requirement)) === worst,
    );
    const named = worst !== "passed" && deciding.length < total && deciding.length <= 3 ? `: ${listed(deciding.map(shortOf))}` : "";
    // Enough runs, and a pass but for peaks that t_end cut: more runs decide nothing.
    const cut = deciding.filter((requirement) => requirement.allowed !== null && requirement.cut > 0).length;
    const why = [cut < deciding.length ? "too few runs" : null, cut ? "peaks that t_end cut" : null].filter(Boolean).join(" or ");
    const everywhere = W.sets.every((set) => new Set((set.requirements || []).map(keyOf)).size === total);
    const text = {
      failed:
        counts.failed === total
          ? `${each} fails${where}`
          : `${counts.failed} of ${total} requirements ${one(counts.failed, "fail", "fails")}${where}${named}`,
      open:
        counts.open === total
          ? `${each} is undecided: ${why}`
          : `${counts.open} of ${total} requirements ${one(counts.open, "are", "is")} undecided, for ${why}${named}`,
      passed: `${each} ${one(total, "pass", "passes")}${several ? (everywhere ? ` in every ${W.kindOfSets()}` : ` in every ${W.kindOfSets()} that states ${one(total, "them", "it")}`) : ""}`,
    }[worst];
    return h(
      "p",
      { class: `headline ${worst}` },
      W.badge(worst),
      " ",
      text,
      several && (worst !== "passed" || !everywhere)
        ? h("small", ` ${bySet(all)}`)
        : counts[worst] < total
          ? h("small", ` ${tallyText({ ...counts, [worst]: 0 })}`)
          : null,
    );
  }
  // Requirements of two sets are the same if they limit the same output at the same level.
  const keyOf = (one) => `${one.text} ${W.isNumber(one.limit) ? Number(one.limit.toPrecision(12)) : ""}`; // the text may round the limit
  const shortOf = (one) => one.id || one.name || F.nameOf(one.output);

  const listed = (names) =>
    names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}` : names[0];

  // The requirement in words: "SYS-4 moment: root peak moment ≤ 12 N·m, 99 % at 90 %".
  function wordsOf(one, set) {
    const name = [one.id, one.name].filter(Boolean).join(" ");
    if (!W.isNumber(one.limit) || one.static_margin) return one.id ? `${one.id} ${one.text}` : one.text;
    const output = one.abs ? `|${F.nameOf(one.output)}|` : F.nameOf(one.output);
    return [
      name ? `${name}: ` : "",
      `${output} ${one.upper ? "≤" : "≥"} ${F.written(one.limit, unitOf(one, set))}, `,
      `${F.given(100 * one.probability)} % at ${F.given(100 * one.confidence)} %`,
      one.group ? ` in group ${one.group}` : "",
    ].join("");
  }

  function unitOf(requirement, set) {
    if (typeof requirement.unit === "string") return requirement.unit;
    const output = W.outputsOf(set).find((one) => one.name === requirement.output);
    return output ? output.unit : "";
  }
  // Four significant digits, and two of the margin, so that the value differs visibly from its limit.
  function valueText(value, requirement, set) {
    if (!W.isNumber(value)) return F.none;
    const { factor, unit } = F.shown(unitOf(requirement, set));
    const size = (number) =>
      W.isNumber(number) && number !== 0 ? Math.floor(Math.log10(Math.abs(number * factor))) : 0;
    const decimals = Math.max(
      3 - size(W.isNumber(requirement.guaranteed_value) ? requirement.guaranteed_value : value),
      W.isNumber(requirement.margin) ? 1 - size(requirement.margin) : 0,
    );
    return `${decimals > 7 ? F.number(value * factor, 4) : F.fixed(value * factor, decimals)} ${unit}`.trim();
  }
  // Whether enough runs keep the limit but for peaks that t_end cut.
  const cutDecides = (one) =>
    one.allowed !== null && one.cut > 0 && (verdictOf(one.verdict) === "open" || one.broken - one.cut <= one.allowed || !one.not_deployed);
  const observed = (one, set) =>
    W.isNumber(one.observed_value) ? valueText(one.observed_value, one, set) : F.share(one.observed);
  function guaranteed(one, set) {
    if (one.one_run) return "none: nothing is dispersed";
    if (W.isNumber(one.limit))
      return W.isNumber(one.guaranteed_value)
        ? valueText(one.guaranteed_value, one, set)
        : W.isPart(set)
          ? "not judged"
          : cutDecides(one)
            ? "none: t_end cut peaks"
            : one.not_deployed || one.without_value
              ? "too few runs with a value"
              : "too few runs";
    return W.isNumber(one.guaranteed) ? F.share(one.guaranteed) : W.isPart(set) ? "not judged" : "too few runs";
  }
  function marginText(one, set) {
    const { factor, unit } = F.shown(unitOf(one, set)),
      margin = marginOf(one);
    if (margin !== null)
      return `${margin > 0 ? "+" : ""}${F.number(margin * factor, 3)} ${unit}`.trim() + (W.isNumber(one.margin) ? "" : " (observed)");
    return W.isNumber(one.guaranteed) && !W.isNumber(one.limit) && verdictOf(one.verdict) !== "open"
      ? `${one.guaranteed > one.probability ? "+" : ""}${F.number(100 * (one.guaranteed - one.probability), 3)} %-points`
      : F.none;
  }

  const runButtons = (runs, at) =>
    (runs || [])
      .slice(0, 3)
      .flatMap((run, k, all) => [
        " ",
        h("span.nowrap", h("button.run", { onclick: () => W.selectRun(at, run) }, String(run)), k + 1 < all.length ? "," : null),
      ]);
  // How many runs break a requirement, by cause; beside each cause its worst runs.
  function brokenRuns(one, set, at) {
    const first = (count, runs) => (count > Math.min(3, (runs || []).length) ? " worst:" : count === 1 ? " run" : " runs");
    const line = (text, count, runs) =>
      h(
        "span.cause",
        text,
        (runs || []).length ? h("span.runs", h("span.faint", first(count, runs)), runButtons(runs, at)) : null,
      );
    const limited = W.isNumber(one.limit),
      side = one.upper ? "above" : "below",
      worst = one.worst;
    const causes = [one.not_deployed, limited ? one.beyond : 0, one.without_value, one.cut].filter(Boolean).length;
    const lines = [
      causes === 1 ? null : h("span.cause", one.broken ? F.count(one.broken) : "none"),
      one.not_deployed
        ? line(`${F.count(one.not_deployed)} not deployed`, one.not_deployed, (one.not_deployed_runs || []).map((each) => each.run))
        : null,
      limited && (one.beyond || one.not_deployed)
        ? line(`${F.count(one.beyond)} ${side} the limit`, one.beyond, (one.beyond_runs || []).map((each) => each.run))
        : null,
      one.without_value ? line(`${F.count(one.without_value)} without this event`) : null,
      one.cut ? line(`${F.count(one.cut)} with a peak that t_end cut`) : null,
      limited && worst
        ? h(
            "span.cause",
            `${one.upper ? "largest" : "least"} ${valueText(worst.value, one, set)}`,
            one.beyond ? null : [h("span.faint", " run"), runButtons([worst.run], at)],
          )
        : null,
    ];
    return lines.filter(Boolean).flatMap((each) => [each, " "]); // the blank parts the lines for those who hear them
  }

  // "One-sided 90 % bound", if all requirements ask for the same confidence.
  function boundName(rows) {
    const levels = new Set(rows.map((row) => sure(row.requirement)));
    return levels.size === 1 ? `One-sided ${[...levels][0]} % bound` : "One-sided bound";
  }
  // Heading of the column that judges a requirement: a quantile for a limited output, else a share of the runs.
  function quantityOf(rows) {
    const limited = new Set(rows.map((row) => W.isNumber(row.requirement.limit)));
    return limited.size > 1 ? "Quantile or share" : limited.has(true) ? "Quantile" : "Share";
  }
  function requirementTable(rows) {
    const several = W.sets.length > 1;
    const columns = [
      "Requirement",
      "Verdict",
      several && W.headOfSets(),
      number(quantityOf(rows)),
      number(boundName(rows)),
      number("Distance to the limit"),
      "Against the limit",
      "Runs that break it",
    ].filter(Boolean);
    const body = rows.map(({ requirement: one, set, at }) => ({
      mark: verdictOf(one.verdict),
      cells: [
        h(
          "span",
          wordsOf(one, set),
          h("span.evidence", one.evidence, one.disproved && !/disproved/.test(one.evidence) ? " · disproved" : null),
          isAtMost(one) ? h("span.evidence", `${F.runs(set.runs)} can show no more`) : null,
        ),
        W.verdictBadge(one.verdict, set),
        several && h(set.label.length > 24 ? "span.nowrap.long-name" : "span.nowrap", set.label),
        observed(one, set),
        guaranteed(one, set),
        marginText(one, set),
        W.bullet(one, F.shown(unitOf(one, set))),
        h("span.causes", brokenRuns(one, set, at)),
      ].filter((cell) => cell !== false),
    }));
    return W.table("Requirements, the worst first", columns, body, { class: "requirements", stacks: true });
  }

  // Whether a requirement on a share has as large a bound as its number of runs can show: no run breaks it.
  const isAtMost = (one) => !W.isNumber(one.limit) && verdictOf(one.verdict) === "passed" && one.broken === 0 && W.isNumber(one.guaranteed);
  function thinBecauseOfRuns(rows) {
    const found = [...new Map(rows.filter(({ requirement: one }) => isAtMost(one)).map((row) => [keyOf(row.requirement), row])).values()];
    return found.map(({ requirement: one, set }) =>
      h("p.note", `${shortOf(one)}: no run breaks it. Its distance is small because ${F.runs(set.runs)} can show no more than ${F.share(one.guaranteed)} at ${F.given(100 * one.confidence)} % confidence.`),
    );
  }
  // Why a requirement has no margin to show: peaks that t_end cut where they decide, then wings that did not deploy; else
  // there are too few runs.
  function whyNone(one, set) {
    if (W.isPart(set)) return "not judged";
    if (cutDecides(one)) return `${F.count(one.cut)} ${one.cut === 1 ? "peak" : "peaks"} cut by t_end`;
    if (one.not_deployed) return `${F.count(one.not_deployed)} not deployed`;
    return verdictOf(one.verdict) === "open" && !one.one_run ? "too few runs" : F.none;
  }
  // One cell per requirement and case.
  function matrix(rows) {
    const texts = [...new Set(rows.map((row) => keyOf(row.requirement)))];
    const words = (text) => {
      const row = rows.find((one) => keyOf(one.requirement) === text);
      return wordsOf(row.requirement, row.set);
    };
    const cell = function (text, at) {
      const row = rows.find((one) => one.at === at && keyOf(one.requirement) === text);
      if (!row) return F.none;
      const one = row.requirement,
        margin = marginText(one, row.set),
        known = margin !== F.none && (W.isNumber(one.margin) || !W.isNumber(one.limit) || !one.not_deployed);
      return h("span.cell", W.verdictBadge(one.verdict, row.set, true), " ", known ? margin : whyNone(one, row.set));
    };
    return W.table(
      `Verdict and distance to the limit by ${W.kindOfSets()}`,
      ["Requirement", ...[...W.sets, ...unmade()].map((set) => number(set.label))],
      texts.map((text) => [words(text), ...W.sets.map((set, at) => cell(text, at)), ...unmade().map(() => "no runs")]),
      { class: "matrix", showCaption: true, stacks: true },
    );
  }

  // The joint verdicts of each set's requirements, as in the terminal's table; equal ones of several sets once.
  function together() {
    const found = new Map();
    for (const set of W.sets) {
      const { groups = [], confidence = null } = set.together || {},
        all = set.requirements || [],
        passing = all.filter((one) => verdictOf(one.verdict) === "passed").length;
      const add = function (verdict, text) {
        const key = `${verdict} ${W.isPart(set)} ${text}`;
        found.set(key, { verdict, text, set, labels: [...((found.get(key) || {}).labels || []), set.label] });
      };
      for (const one of groups)
        add(one.verdict, `group ${one.group}: ${one.passed} of ${one.requirements} pass, joint confidence ${F.given(100 * one.confidence)} %`);
      if (passing > 1)
        add("", `joint confidence of all ${all.length} requirements: ${confidence > 0 ? `at least ${F.given(Number((100 * confidence).toPrecision(10)))} %` : "no guarantee"}`);
    }
    return found.size
      ? h(
          "ul.together",
          [...found.values()].map(({ verdict, text, set, labels }) =>
            h("li", W.sets.length > 1 ? `${listed(labels)}${labels.length > 1 ? ", each" : ""}: ` : null, verdict ? [W.verdictBadge(verdict, set, true), " "] : null, text),
          ),
        )
      : null;
  }

  function requirements() {
    const rows = judged();
    if (!rows.length) return [headline(rows), W.staticShortfall()];
    const several = W.sets.length > 1;
    const shown = several
      ? rows.filter((row, at) => rows.findIndex((one) => keyOf(one.requirement) === keyOf(row.requirement)) === at)
      : rows;
    const more =
      rows.length > shown.length
        ? h(
            "details.printed",
            h("summary", `Every requirement in every ${W.kindOfSets()} (${rows.length} verdicts)`),
            requirementTable(rows),
          )
        : null;
    return [
      headline(rows),
      several || unmade().length ? [matrix(rows), thinBecauseOfRuns(rows)] : null,
      W.unjudged(),
      W.staticShortfall(),
      W.findings(rows),
      several ? h("h3", `The worst ${W.kindOfSets()} of each requirement`) : null,
      requirementTable(shown),
      together(),
      h(
        "p.note",
        "“99 % at 90 %”: 99 % of all deployments must keep the limit, and the runs must show it with a confidence of 90 %. So fewer runs may break it than 1 % of them. Pass: the runs show it. Fail: there are enough runs, but too many break it; “disproved”: they show, with the same confidence, that fewer deployments keep the limit. Undecided: too few runs. ● Quantile (or share) of these runs. ┃ Its one-sided bound over all deployments, at the required confidence. Shaded: where the requirement passes; each picture has a scale of its own. Distance to the limit: from the one-sided bound, positive where the requirement passes; of a share in percentage points.",
      ),
      more,
    ];
  }

  // The confidence of one requirement's bound and allowance, %; within a group it exceeds the group's.
  const sure = (one) => F.given(Number((100 * (W.isNumber(one.sure) && one.sure > 0 ? one.sure : one.confidence)).toPrecision(4)));

  W.verdicts = { judged, sure, requirements, verdictOf, unitOf, guaranteed, observed, valueText, marginText, wordsOf, keyOf, shortOf, listed };
})();
