// The comparison of sets: verdicts side by side, differences of means and outcomes.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;

  // Changes in per cent: linear up to 40 %; beyond, linear about zero and logarithmic farther out (symlog), so that changes of
  // 2 % and of 1000 % are visible together. The limit of 40 % is heuristic; a lower one makes more axes logarithmic.
  function wideScale(values, range) {
    const known = values.filter(W.isNumber),
      far = d3.max(known, Math.abs) || 0;
    if (far < 40) return M.linear(values, range);
    const [low, high] = d3.extent(known),
      x = d3
        .scaleSymlog()
        .constant(2)
        .domain([low < 0 ? 1.3 * low : 0.7 * low, high > 0 ? 1.3 * high : 0.7 * high])
        .range(range);
    x.wide = [-10000, -1000, -100, -10, 0, 10, 100, 1000, 10000].filter(
      (value) => value >= x.domain()[0] && value <= x.domain()[1],
    );
    return x;
  }
  // An output with negative values is compared by its magnitude: mirrored wings turn in opposite senses.
  const nameOf = (one) => (one.magnitude ? `|${F.nameOf(one.output)}|` : F.nameOf(one.output));
  function forest(comparison) {
    const rows = comparison.outputs.filter((one) => W.isNumber(one.difference)),
      [i, j] = comparison.sets;
    const relative = (value, one) =>
      W.isNumber(value) && W.isNumber(one.relative) && one.difference !== 0
        ? (100 * value * one.relative) / one.difference
        : null;
    const drawn = rows
      .filter((one) => W.isNumber(one.relative))
      .sort((a, b) => Math.abs(b.relative) - Math.abs(a.relative))
      .slice(0, 24);
    return !drawn.length
      ? null
      : W.figure({
          title: `Change of the means: ${W.sets[j].label} against ${W.sets[i].label}`,
          class: "forest",
          printed: 860,
          note: `${comparison.paired ? `Paired over the ${F.count(comparison.runs)} runs of both sets with the same random numbers, so scatter between runs cancels. Each difference is over the runs that have the output in both sets.` : `Not paired: ${comparison.why_unpaired}.`}${rows.length > drawn.length ? ` The picture has the ${drawn.length} largest of ${rows.length} changes; the table has all.` : ""}`,
          description: () =>
            drawn
              .slice(0, 12)
              .map((one) => `${nameOf(one)} ${F.number(100 * one.relative, 3)} %`)
              .join("; "),
          table: () => ({
            columns: ["output", "difference", "lower", "upper", "relative", "runs"],
            rows: comparison.outputs.map((one) => [
              one.output,
              one.difference,
              one.lower,
              one.upper,
              one.relative,
              one.runs,
            ]),
          }),
          draw: function (svg, width) {
            const left = M.labelRoom(
                width,
                0.4,
                drawn.map(nameOf),
              ),
              box = { left, right: width - 16, top: 6, bottom: 6 + 20 * drawn.length };
            const values = drawn.flatMap((one) => [
                0,
                100 * one.relative,
                relative(one.lower, one),
                relative(one.upper, one),
              ]),
              x = wideScale(values, [box.left, box.right]);
            M.axes(svg, box, x, null, { xText: `change of the mean (%${x.wide ? ", logarithmic away from 0" : ""})`, xValues: x.wide });
            M.upright(svg, "line.zero-line", x(0), box);
            drawn.forEach(function (one, at) {
              const y = box.top + 20 * (at + 0.5),
                low = relative(one.lower, one),
                high = relative(one.upper, one),
                sure = W.isNumber(one.lower) && one.lower * one.upper > 0;
              M.rowLabel(svg, nameOf(one), left, y);
              if (W.isNumber(low)) M.whisker(svg, x, low, high, y, 4);
              M.put(svg, "circle", { class: sure ? "change sure" : "change", cx: x(100 * one.relative), cy: y, r: 4 });
            });
            return box.bottom + 40;
          },
        });
  }
  function compared(comparison, open) {
    const statuses = (comparison.statuses || []).filter(
      (one) =>
        one.difference !== 0 ||
        W.sets[comparison.sets[0]].statuses.some((each) => each.status === one.status && each.count),
    );
    const sign = (value, text) => (value > 0 ? `+${text}` : text),
      level = `${F.given(Number((100 * comparison.confidence).toPrecision(6)))} % bounds`;
    const rows = comparison.outputs.map(function (one) {
      const unit = F.unitOf(one.output),
        half = W.isNumber(one.lower) ? (one.upper - one.lower) / 2 : null,
        value = (number) => F.value(number, unit, half || Math.abs(one.difference) / 20);
      return [
        nameOf(one),
        F.shown(unit).unit,
        W.isNumber(one.difference) ? sign(one.difference, value(one.difference)) : F.none,
        W.isNumber(one.lower) ? `${value(one.lower)} … ${value(one.upper)}` : "no bounds",
        W.isNumber(one.relative) ? sign(one.relative, `${F.number(100 * one.relative, 3)} %`) : F.none,
        F.count(one.runs),
      ];
    });
    return h(
      "details.later",
      { open },
      h("summary", comparison.text),
      verdicts(comparison),
      h(
        "div.wide-pair",
        forest(comparison),
        h(
          "div.differences",
          W.table(
            `Differences of the means: ${comparison.text}`,
            ["Output", "Unit", number("Difference"), number(level), number("Relative"), number(comparison.paired ? "Runs" : "Runs of each, at least")],
            rows,
            { class: "tall" },
          ),
          statuses.length
            ? W.table(
                `Differences of the outcomes: ${comparison.text}`,
                ["Outcome", number("Difference"), number(`${level}, percentage points`)],
                statuses.map(function (one) {
                  const half = W.isNumber(one.lower) ? (one.upper - one.lower) / 2 : 0,
                    decimals = Math.max(2, F.decimals(100 * (half || Math.abs(one.difference)))),
                    points = (share) => F.fixed(100 * share, decimals);
                  return [
                    one.status.replace("_", " "),
                    `${sign(one.difference, points(one.difference))} points`,
                    W.isNumber(one.lower) ? `${points(one.lower)} … ${points(one.upper)}` : "no bounds",
                  ];
                }),
              )
            : null,
        ),
      ),
    );
  }
  // The verdicts of both sets, requirement by requirement; those that changed first.
  function verdicts(comparison) {
    const [first, second] = comparison.sets.map((at) => W.sets[at]),
      V = W.verdicts;
    const of = (set, one) => (set.requirements || []).find((each) => V.keyOf(each) === V.keyOf(one));
    const keys = [...(first.requirements || []), ...(second.requirements || []).filter((one) => !of(first, one))];
    if (!keys.length) return null;
    const cell = function (set, one) {
      if (!one) return "not required";
      const causes = [
        one.not_deployed ? `${F.count(one.not_deployed)} not deployed` : null,
        W.isNumber(one.limit) && one.beyond ? `${F.count(one.beyond)} ${one.upper ? "above" : "below"} the limit` : null,
      ].filter(Boolean);
      return h(
        "span.double",
        W.verdictBadge(one.verdict, set),
        ` ${V.marginText(one, set)}`,
        h("small", causes.length ? causes.join(", ") : `${F.count(one.broken)} of ${F.runs(one.runs)} break it`),
      );
    };
    const rows = keys.map(function (one) {
      const [a, b] = [of(first, one), of(second, one)],
        changed = !a || !b || (![first, second].some(W.isPart) && a.verdict !== b.verdict);
      return {
        changed,
        mark: changed ? "changed" : null,
        cells: [V.wordsOf(one, a ? first : second), cell(first, a), cell(second, b)],
      };
    });
    return W.table(
      "Verdicts and margins side by side",
      ["Requirement", first.label, second.label],
      rows.sort((a, b) => b.changed - a.changed),
      { showCaption: true, class: "side-by-side" },
    );
  }

  W.comparison = function () {
    const comparisons = W.data.comparisons || [],
      section = document.getElementById("comparison"),
      folders = comparisons.filter((one) => one.folders);
    section.hidden = W.sets.length < 2;
    if (section.hidden) return;
    W.fill(
      W.section("comparison"),
      folders.length ? W.designs(folders) : null,
      comparisons.length
        ? [
            h(
              "p.lead",
              `Differences of the means with confidence intervals. Filled point: the interval excludes zero. |Output|: its magnitudes are compared. “By ${W.kindOfSets()}, overlaid” above compares the distributions.`,
            ),
            comparisons.map((one, at) => compared(one, folders.length ? one.folders : at < 2)),
          ]
        : h("p.nothing", "No set has a partner to compare with."),
      (W.data.unpaired || []).length ? h("p.note", `Without a partner: ${W.data.unpaired.join("; ")}.`) : null,
    );
  };
})();
