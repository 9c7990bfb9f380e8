// Below the verdicts: for each failed requirement where and by how much, what moves the output, and what would make it pass.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F } = W;
  const isFailed = (one) => W.verdicts.verdictOf(one.verdict) === "failed";

  // One sentence where wings that did not deploy are the only failures of a set.
  function cause(rows) {
    const sentences = W.sets.map(function (set, at) {
      const failed = rows.filter((row) => row.at === at && isFailed(row.requirement));
      const only = failed.every(({ requirement: one }) => one.not_deployed > 0 && one.not_deployed === one.broken);
      if (failed.length < 2 || !only) return null;
      const count = failed[0].requirement.not_deployed;
      return `${W.sets.length > 1 ? `${set.label}: ` : ""}${F.count(count)} of ${F.runs(set.runs)}${W.soFar(set)} did not deploy, and a run that does not deploy breaks every requirement. No deployed run is beyond a limit.`;
    });
    return sentences.filter(Boolean).map((text) => h("p.lead", text));
  }
  // For each set in which too many runs did not deploy: how many, and by which changes it would pass.
  function deployments(rows) {
    const items = W.sets.map(function (set, at) {
      const failed = rows.filter(
        (row) => row.at === at && (row.requirement.changes || []).some((block) => block.for === "deployment"),
      );
      if (!failed.length) return null;
      const { requirement: one } = failed.find((row) => row.requirement.kind === "status") || failed[0];
      return h(
        "li",
        h("b", W.verdicts.shortOf(one)),
        `: ${W.sets.length > 1 ? `in ${set.label} ` : ""}${F.count(one.not_deployed)} of ${F.runs(set.runs)}${W.soFar(set)} (${F.share(one.not_deployed / Math.max(1, set.runs))}) did not deploy${mayBreak(one, set)}. `,
        W.needed(one, set, "deployment"),
      );
    });
    return items.some(Boolean) ? h("ul.findings.stalls", items.filter(Boolean)) : null;
  }
  // ", where at most 5 may (1 % of the runs is 10; to be 90 % sure, only 5 may)".
  function mayBreak(one, set) {
    if (!W.isNumber(one.allowed)) return "";
    const share = 1 - one.probability,
      plain = share * set.runs;
    const why =
      one.allowed < Math.floor(plain + 1e-9)
        ? ` (${F.given(100 * share)} % of the runs is ${F.given(Number(plain.toPrecision(3)))}; to be ${W.verdicts.sure(one)} % sure, ${one.allowed ? `only ${F.count(one.allowed)}` : "none"} may)`
        : "";
    return `, where ${one.allowed ? `at most ${F.count(one.allowed)}` : "none"} may${why}`;
  }
  // The other sets in which the requirement of a row fails, each with its distance to the limit.
  const alsoIn = (rows, { requirement, at }) =>
    rows
      .filter((row) => row.at !== at && W.verdicts.keyOf(row.requirement) === W.verdicts.keyOf(requirement) && isFailed(row.requirement))
      .map(function (row) {
        const distance = W.verdicts.marginText(row.requirement, row.set);
        return distance === F.none ? row.set.label : `${row.set.label} (${distance} to the limit)`;
      });
  // "Their 99 % quantile is 107.3 N, its one-sided 90 % bound 115.4 N."
  function quantileText(one, set) {
    if (!W.isNumber(one.observed_value)) return null;
    const level = F.given(100 * (one.upper ? one.probability : 1 - one.probability)),
      bound = W.isNumber(one.guaranteed_value) ? `, its one-sided ${W.verdicts.sure(one)} % bound ${W.verdicts.guaranteed(one, set)}` : "";
    return `The ${level} % quantile is ${W.verdicts.valueText(one.observed_value, one, set)}${bound}. `;
  }
  function finding({ requirement: one, set, at }, also) {
    const several = W.sets.length > 1,
      side = one.upper ? "above" : "below",
      limit = F.written(one.limit, W.verdicts.unitOf(one, set)),
      name = F.nameOf(one.output).replace("of every hinge", "of the lowest hinge"); // a run breaks it by one hinge
    const runs = (one.beyond_runs || []).map((each) => each.run),
      value = `${one.beyond === 1 ? "has" : "have"} ${one.abs ? `|${name}|` : name} ${side} ${limit}`,
      alone = one.broken === one.beyond,
      decides = !W.isNumber(one.allowed) || one.beyond > one.allowed;
    const rest = [
      one.not_deployed && `${F.count(one.not_deployed)} did not deploy`,
      one.without_value && `${F.count(one.without_value)} ${one.without_value === 1 ? "has" : "have"} no value`,
      one.cut && `${F.count(one.cut)} ${one.cut === 1 ? "has" : "have"} a peak that t_end cut`,
      `${F.count(one.beyond)} ${value}`,
    ].filter(Boolean);
    return h(
      "li",
      h("b", W.verdicts.shortOf(one)),
      `: ${several ? `in ${set.label} ` : ""}${F.count(one.broken)} of ${F.runs(set.runs)}${W.soFar(set)} (${F.share(one.broken / Math.max(1, set.runs))}) ${alone ? value : one.broken === 1 ? "breaks it" : "break it"}${mayBreak(one, set)}${alone ? "" : `: ${W.verdicts.listed(rest)}`}. `,
      decides ? null : `Without the others, those ${side} the limit would be few enough. `,
      quantileText(one, set),
      also.length ? `Also fails in ${W.verdicts.listed(also)}. ` : null,
      runs.length ? [`The worst run is `, h("button.run", { onclick: () => W.selectRun(at, runs[0]) }, String(runs[0])), ". "] : null,
      W.caseMeans(set, one.output),
      W.caseMechanism(set, one.output) ? h("p.mechanism", W.caseMechanism(set, one.output)) : null,
      decides ? W.needed(one, set, "limit") : null,
    );
  }
  // For each requirement that values beyond its limit break: where, how many runs, by how much, and what moves the output.
  function limits(rows) {
    const seen = new Set();
    const items = rows
      .filter(({ requirement: one }) => isFailed(one) && W.isNumber(one.limit) && one.beyond)
      .filter(({ requirement: one }) => !seen.has(W.verdicts.keyOf(one)) && seen.add(W.verdicts.keyOf(one)))
      .map((row) => finding(row, alsoIn(rows, row)));
    if (!items.length) return null;
    const more = items.splice(4).length;
    return [h("ul.findings", items), more ? h("p.note", `${F.counted(more, "more requirement")} below.`) : null];
  }
  W.findings = (rows) => [cause(rows), deployments(rows), limits(rows)];

  const size = (output) => Math.max(Math.abs(output.min), Math.abs(output.max));
  // "left.root.peak_force" of "right.root.peak_force", if the scene has two wings with as many hinges; else null.
  function mirrored(set, name) {
    const wings = (set.wing_orders || []).map((wing) => wing.hinges || []);
    if (wings.length !== 2 || wings[0].length !== wings[1].length) return null;
    const dot = name.lastIndexOf("."),
      hinge = name.slice(0, dot);
    for (const [own, other] of [wings, [wings[1], wings[0]]])
      if (own.includes(hinge)) return other[own.indexOf(hinge)] + name.slice(dot);
    return null;
  }
  W.mirrored = mirrored;
  // A load whose mirror image has a limit and which reaches nearly as much: HEURISTIC, from 90 % of it on.
  const NEARLY = 0.9;
  const siblings = (set) =>
    W.outputsOf(set)
      .filter((one) => (one.limits || []).length && (one.unit || "").startsWith("N"))
      .map((one) => ({ judged: one, own: W.outputsOf(set).find((each) => each.name === mirrored(set, one.name)) }))
      .filter(({ judged, own }) => own && own.count && !(own.limits || []).length && size(own) >= NEARLY * size(judged))
      .map(({ judged, own }) => ({ output: own.name, largest: size(own), judged: judged.name, judged_largest: size(judged), mirror: true }));
  // One line of the loads that no requirement limits: of each kind the one that is larger than all that are judged in any
  // set, and those whose mirror image is judged.
  W.unjudged = function () {
    const kindOf = (name) => name.split(".").pop(),
      judgedOf = (kind) => d3.max(W.sets, (set) => d3.max(W.outputsOf(set).filter((one) => kindOf(one.name) === kind && (one.limits || []).length), size));
    const all = W.sets.flatMap((set) => [
      ...(set.unjudged || []).filter((one) => !(one.largest <= judgedOf(kindOf(one.output)))),
      ...siblings(set),
    ].map((one) => ({ ...one, set, kind: kindOf(one.output) })));
    const larger = (a, b) => (b.largest > a.largest ? b : a);
    // of each kind one load; a mirror image beside it if it is another output
    const worst = [...d3.rollup(all, (each) => each.reduce(larger), (one) => `${one.kind} ${one.mirror ? one.output : ""}`).values()];
    const shown = worst.filter((one) => one.mirror || !worst.some((other) => other.mirror && other.output === one.output)).slice(0, 4);
    if (!shown.length) return null;
    const value = (name, number) => `${F.number(number, 3)} ${F.unit(F.unitOf(name))}`;
    return h(
      "p.unjudged",
      h("b", "Without a requirement: "),
      shown
        .map(
          (one) =>
            `${F.nameOf(one.output)} reaches ${value(one.output, one.largest)}${W.soFar(one.set)}${W.sets.length > 1 ? ` in ${one.set.label}` : ""}; ` +
            `${one.mirror ? `its mirror image ${F.nameOf(one.judged)}, which has one,` : `the largest of its kind with one, ${F.nameOf(one.judged)},`} reaches ${value(one.judged, one.judged_largest)}.`,
        )
        .join(" "),
    );
  };
})();
