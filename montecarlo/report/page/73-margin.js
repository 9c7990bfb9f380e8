// The permissible scale of springs or other values (`wingspread margin`).
(function () {
  "use strict";
  const W = window.wingspread;
  const { format: F, marks: M } = W;

  W.permissible = (margin) => (margin.of_springs ? "Permissible spring strength" : "Permissible scale");
  // What limits the window and its recommended scale, a sentence each, as the program prints it.
  function qualifications(margin) {
    const { joint_confidence: joint, widest_gap: gap, other_windows: others = [], given_up: given, passed_over: passed } = margin,
      count = (margin.requirements || []).length,
      apart = gap ? 100 * (gap[1] / gap[0] - 1) : 0,
      present = margin.of_springs ? "present springs" : "present values",
      nearer = given ? given.requirements.map((one) => `${one.requirement}${one.case === "nominal" ? "" : ` in ${one.case}`}`) : [],
      lower = given ? given.static_margins.map((one) => `${one.drive} (${one.margin}: ${F.fixed(one.at_scale, 2)}, now ${F.fixed(one.at_1, 2)})`) : [];
    return [
      others.length ? `Narrower windows: ${others.map(([from, to]) => `from ${F.number(from, 4)} to ${F.number(to, 4)}`).join(", ")}.` : null,
      !W.isNumber(joint)
        ? null
        : joint > 0
          ? `Joint confidence of ${F.counted(count, "requirement")}, over all cases and both edges: at least ${F.given(Number((100 * joint).toPrecision(10)))} %.`
          : `Joint confidence of ${F.counted(count, "requirement")}: no guarantee.`,
      gap
        ? `Nothing was run between neighbouring scales of the window, up to ${F.number(apart, apart < 10 ? 2 : 3)} % apart (${F.number(gap[0], 4)} and ${F.number(gap[1], 4)}): what fails only there is not seen.`
        : null,
      passed && W.isNumber(margin.recommended) ? `Scale ${F.number(passed.scale, 4)} breaks fewer runs, but a static margin is too low there: ${passed.drive} (${passed.margin}: ${F.fixed(passed.at_scale, 2)}, now ${F.fixed(passed.at_1, 2)}).` : null,
      nearer.length ? `Nearer to their limits than with the ${present}, or broken by more runs: ${nearer.join("; ")}.` : null,
      lower.length ? `Lower static margins than with the ${present}: ${lower.join(", ")}.` : null,
    ];
  }
  W.marginWindow = function (margin, set) {
    const [low, high] = margin.window || [null, null],
      { scales, requirements } = margin,
      bounded = W.isNumber(low) || W.isNumber(high);
    const ends = `${W.isNumber(low) ? `from ${F.number(low, 4)}` : "open below"} ${W.isNumber(high) ? `to ${F.number(high, 4)}` : "and open above"}`;
    const [from, to] = margin.as_good || [];
    const others =
      to > from ? ` (no scale seen has fewer runs that break a requirement, and those from ${F.number(from, 4)} to ${F.number(to, 4)} have as few)` : "";
    const advice = W.isNumber(margin.recommended) ? `; recommended: ${F.number(margin.recommended, 4)}${others}` : "";
    const words = [
      bounded
        ? `The window is ${ends}${advice}.${margin.why_none ? ` No recommendation: ${margin.why_none}.` : ""}${margin.not_confirmed ? ` Runs of another seed do not confirm the recommendation: ${margin.not_confirmed}.` : ""}`
        : margin.why_none ? `${margin.why_none[0].toUpperCase()}${margin.why_none.slice(1)}.` : "No scale meets all requirements.",
      ...qualifications(margin),
      W.isNumber(set.confidence) ? `Bands are two-sided ${F.given(100 * set.confidence)} % bounds of each share.` : null,
    ]
      .filter(Boolean)
      .join(" ");
    return W.figure({
      title: `${W.permissible(margin)} (wingspread margin)`,
      class: "margin",
      note: words,
      description: `Share of runs that meet each requirement against the scale${margin.of_springs ? " of the springs" : ""}. ${words}`,
      table: () => ({
        columns: ["scale", ...requirements.flatMap((one) => [one.text, "lower", "upper", "verdict"])],
        rows: scales.map((scale, at) => [
          scale,
          ...requirements.flatMap((one) => [one.passed[at], one.lower[at], one.upper[at], one.verdict[at]]),
        ]),
      }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          [...M.lineItems(requirements, (one) => one.text), ...(bounded ? [{ text: "window", fill: "var(--good)", opacity: 0.25 }] : [])],
          width,
        );
        const box = { left: 48, right: width - 14, top: top + 18, bottom: top + 270 },
          x = M.linear([...scales, low, high], [box.left, box.right]);
        // A scale of nines, -log10(1 - share), because requirements usually lie between 90 and 100 %.
        const nines = d3.scaleLinear([0, 3.6], [box.bottom, box.top]),
          y = (share) => nines(Math.min(3.6, -Math.log10(Math.max(1e-9, 1 - share))));
        const SHARES = [0, 0.5, 0.9, 0.99, 0.999, 1],
          axis = nines.copy();
        if (bounded) {
          const from = W.isNumber(low) ? x(low) : box.left,
            to = W.isNumber(high) ? x(high) : box.right;
          M.put(svg, "rect.window", {
            x: from,
            width: Math.max(0, to - from),
            y: box.top,
            height: box.bottom - box.top,
          });
        }
        M.axes(svg, box, x, axis, {
          xText: margin.of_springs ? "scale of the springs" : `scale of ${margin.paths.length === 1 ? margin.paths[0] : "the values"}`,
          yText: "share of runs that meet it, logarithmic in 1 − share",
          yValues: SHARES.map((share) => nines.invert(y(share))),
          yFormat: (_, at) => `${Number((100 * SHARES[at]).toPrecision(4))} %`,
        });
        requirements.forEach(function (one, at) {
          M.put(svg, "path.curve-band", {
            d: M.band(x, y)(scales.map((scale, k) => [scale, one.lower[k], one.upper[k]])),
            style: { fill: M.colour(at), "fill-opacity": 0.09 },
          });
          M.trace(svg, M.line(x, y)(scales.map((scale, k) => [scale, one.passed[k]])), at);
          scales.forEach(
            (scale, k) =>
              W.isNumber(one.passed[k]) &&
              M.put(svg, "circle.looked", {
                cx: x(scale),
                cy: y(one.passed[k]),
                r: 3,
                style: {
                  stroke: M.colour(at),
                  fill: W.verdicts.verdictOf(one.verdict[k]) === "passed" ? M.colour(at) : "var(--paper)",
                },
                title: `${one.text}: ${one.verdict[k]} at ${F.number(scale, 4)}`,
              }),
          );
        });
        const recommended = {
          x: x(margin.recommended),
          text: `recommended ${F.number(margin.recommended, 4)}`,
          kind: "chosen-line",
        };
        const lines = [{ x: x(1), text: "present", kind: "nominal" }];
        M.uprights(svg, box, W.isNumber(margin.recommended) ? [...lines, recommended] : lines, true);
        return box.bottom + 40;
      },
    });
  };
})();
