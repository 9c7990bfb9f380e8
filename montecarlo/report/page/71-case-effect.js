// The case as a cause: how much of an output's differences the cases make, against the spread inside each case.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;

  // The cases of the set's campaign that have values of an output: { set, output }.
  function casesOf(set, name) {
    return !set.case
      ? []
      : W.sets
          .filter((one) => one.case && one.campaign_folder === set.campaign_folder)
          .map((one) => ({ set: one, output: W.outputsOf(one).find((each) => each.name === name) }))
          .filter(({ output }) => output && output.count > 1 && W.isNumber(output.std));
  }
  // The parts of the variance over all cases together, each with the same weight: between their means, and inside them
  // (the law of total variance).
  function parts(cases) {
    const mean = d3.mean(cases, ({ output }) => output.mean),
      between = d3.mean(cases, ({ output }) => (output.mean - mean) ** 2),
      inside = d3.mean(cases, ({ output }) => output.std ** 2);
    return { between, inside, share: between + inside > 0 ? between / (between + inside) : 0 };
  }
  // The dispersions whose laws a case changes, then other inputs.
  function changes(set) {
    const { dispersions = [], scene = [] } = set.inputs || {};
    return [
      ...dispersions.filter((one) => one.law_before_case).map((one) => W.wordsOfDraw(set, one.draw)),
      ...scene.filter((one) => one.case_value !== null && one.case_value !== undefined).map((one) => one.label),
    ];
  }
  function changed(cases) {
    const all = [...new Set(cases.flatMap(({ set }) => changes(set)))],
      more = all.length - 3;
    return all.length ? ` (${all.slice(0, 3).join(", ")}${more > 0 ? ` and ${F.counted(more, "more input")}` : ""})` : "";
  }

  // One sentence: from which case to which the mean moves, and what share of the variance that is. Null for one case.
  W.caseEffect = function (set, name) {
    const cases = casesOf(set, name);
    if (cases.length < 2) return null;
    const { inside, share } = parts(cases),
      [low, high] = d3.extent(cases, ({ output }) => output.mean),
      at = (mean) => cases.find(({ output }) => output.mean === mean).set.label,
      { unit } = cases[0].output,
      text = (value) => F.withUnit(value, unit, Math.sqrt(inside) / 10);
    return low === high
      ? `The case${changed(cases)} does not move the mean of ${F.nameOf(name)}.`
      : `The case${changed(cases)} moves the mean of ${F.nameOf(name)} from ${text(low)} in ${at(low)} to ${text(high)} in ${at(high)}. Of the variance over all cases, each with the same weight, ${F.share(share)} lies between the cases; other cases give another share. The standard deviation inside a case, pooled over the cases, is ${text(Math.sqrt(inside))}.`;
  };

  const SIGN = { scale: "×\u00a0", add: "+\u00a0" };
  const LEAST = Math.log(1.02); // smaller factors move no mean visibly (heuristic)
  // Inputs that differ between the cases: { words, by: the draw, at: ["× 2 in cold"] where it is not neutral, size: the largest ratio }.
  function differing(sets) {
    const found = [];
    const add = function (words, by, apply, values, nominal, unit = "") {
      if (new Set(values.map((value) => F.number(value, 3))).size < 2) return;
      if (apply === "scale" && !(d3.max(values, (value) => Math.abs(Math.log(value))) > LEAST)) return;
      const still = apply === "scale" ? 1 : apply === "add" ? 0 : nominal,
        text = (value) => (typeof value === "number" ? F.number(value, 3) : String(value));
      found.push({
        words,
        by,
        at: sets
          .map((set, at) => [set.label, values[at]])
          .filter(([, value]) => F.number(value, 3) !== F.number(still, 3))
          .map(([label, value]) => `${SIGN[apply] || ""}${text(value)}${unit ? ` ${F.unit(unit)}` : ""} in ${label}`),
        size: apply === "scale" ? d3.max(values, (value) => Math.abs(Math.log(value))) : 0,
      });
    };
    const drawsOf = (set) => (set.inputs || {}).dispersions || [];
    for (const one of drawsOf(sets[0])) {
      const same = sets.map((set) => drawsOf(set).find((each) => each.draw === one.draw));
      if (same.some((each) => !each)) continue;
      (one.tables || []).forEach((table, at) => add(table.words, W.wordsOfDraw(sets[0], one.draw), table.apply, same.map((each) => ((each.tables || [])[at] || {}).of_median), null, table.apply === "scale" ? "" : table.unit));
      if (!(one.tables || []).length) add(W.wordsOfDraw(sets[0], one.draw), null, one.apply, same.map((each) => each.median), one.median, one.apply === "scale" ? "" : one.unit);
    }
    // The list of a scene has no zeros.
    const sceneOf = (set) => (set.inputs || {}).scene || [];
    for (const path of new Set(sets.flatMap((set) => sceneOf(set).map((one) => one.path)))) {
      const own = sets.map((set) => sceneOf(set).find((each) => each.path === path)),
        one = own.find(Boolean),
        values = own.map((each) => (each ? (W.isNumber(each.case_value) ? each.case_value : each.value) : 0));
      if (values.every(W.isNumber)) add(one.label, null, "set", values, one.value, one.unit);
    }
    return d3.sort(found, (one) => -one.size);
  }
  // The mechanism in one line: "Through temperature: friction of all hinges × 2.00 in cold, × 0.905 in hot; …". Empty for one
  // case.
  W.caseMechanism = function (set, name) {
    const cases = casesOf(set, name).map((one) => one.set),
      all = cases.length < 2 ? [] : differing(cases),
      draws = [...new Set(all.map((one) => one.by))],
      more = all.length - 4;
    return all.length
      ? `${draws.length === 1 && draws[0] ? `Through ${draws[0]}` : "The cases change"}: ${all.slice(0, 4).map((one) => `${one.words} ${one.at.join(", ")}`).join("; ")}${more > 0 ? `; and ${F.counted(more, "more input")}` : ""}.`
      : "";
  };

  // The means in short: "Mean by case: cold 8.1, ambient 51, hot 63 N." Empty for one case.
  W.caseMeans = function (set, name) {
    const cases = casesOf(set, name);
    if (cases.length < 2) return "";
    const { unit } = cases[0].output,
      { factor, unit: shown } = F.shown(unit);
    return `Mean by case: ${cases.map(({ set: one, output }) => `${one.label} ${F.number(output.mean * factor, 3)}`).join(", ")} ${shown}. `;
  };

  // The same in numbers, case by case.
  W.caseTable = function (set, name) {
    const cases = casesOf(set, name);
    if (cases.length < 2) return null;
    const { inside } = parts(cases),
      first = cases[0].output,
      unit = F.shown(first.unit).unit,
      text = (value) => F.value(value, first.unit, Math.sqrt(inside) / 10),
      p = d3.max(first.quantiles || [], (one) => one.p),
      quantileOf = (output) => ((output.quantiles || []).find((one) => one.p === p) || {}).value,
      moved = (value) => `${value > 0 ? "+" : ""}${text(value)}`,
      difference = (a, b) => (W.isNumber(a) && W.isNumber(b) ? moved(a - b) : F.none);
    return W.table(
      `Between the cases and inside them: ${F.nameOf(name)}`,
      [
        "Case",
        number("Mean", unit),
        number("Shift of the mean"),
        number("Std inside"),
        ...(W.isNumber(p) ? [number(F.quantileName(p)), number(`Shift of the ${F.quantileName(p)}`)] : []),
      ],
      cases.map(({ set: one, output }, at) => [
        one.label,
        text(output.mean),
        at ? difference(output.mean, first.mean) : F.none,
        text(output.std),
        ...(W.isNumber(p)
          ? [text(quantileOf(output)), at ? difference(quantileOf(output), quantileOf(first)) : F.none]
          : []),
      ]),
      { class: "narrow-table", showCaption: true },
    );
  };
})();
