// A requirement's limit, its observed and its guaranteed value as a small picture in a line of a table.
(function () {
  "use strict";
  const W = window.wingspread;
  const { format: F, marks: M } = W;

  // Over an axis in the displayed unit (`shown`). Shares stand on a scale of nines,
  // -log10(1 - share): 99 % at 2.
  const WIDE = 140; // px
  const nines = (share) => Math.min(5, -Math.log10(Math.max(1e-5, 1 - share)));
  W.bullet = function (one, shown) {
    const isValue = W.isNumber(one.limit);
    const values = isValue
      ? { limit: one.limit, observed: one.observed_value, guaranteed: one.guaranteed_value }
      : {
          limit: nines(one.probability),
          observed: nines(one.observed),
          guaranteed: W.isNumber(one.guaranteed) ? nines(one.guaranteed) : null,
        };
    const upper = isValue ? one.upper : false;
    const known = Object.values(values).filter(W.isNumber),
      far = Math.max(...known.map((value) => Math.abs(value - values.limit)), Math.abs(values.limit) * 0.02, 1e-12);
    const x = d3.scaleLinear([values.limit - 1.15 * far, values.limit + 1.15 * far], [2, WIDE - 2]).clamp(true);
    const svg = M.small("bullet", WIDE, 34);
    M.put(svg, "rect.good", {
      x: upper ? 0 : x(values.limit),
      width: upper ? x(values.limit) : WIDE - x(values.limit),
      y: 4,
      height: 10,
    });
    M.put(svg, "line.limit-mark", { x1: x(values.limit), x2: x(values.limit), y1: 0, y2: 18 });
    if (W.isNumber(values.observed) && W.isNumber(values.guaranteed))
      M.put(svg, "line.between", { x1: x(values.observed), x2: x(values.guaranteed), y1: 9, y2: 9 });
    if (W.isNumber(values.observed)) M.put(svg, "circle.observed", { cx: x(values.observed), cy: 9, r: 3.2 });
    if (W.isNumber(values.guaranteed)) M.put(svg, "path.guaranteed", { d: `M${x(values.guaranteed)},3.5 v11` });
    bulletAxis(svg, x, isValue ? shown : null);
    return svg.node();
  };
  // A few numbers that do not overlap, the last with the unit. @param shown the displayed unit; null: a scale of nines
  function bulletAxis(svg, x, shown) {
    const [low, high] = x.domain();
    const scaled = shown && x.copy().domain([low * shown.factor, high * shown.factor]);
    const ticks = shown
      ? scaled.ticks(3).map((value, _, all) => ({ at: scaled(value), text: F.ticks(all)(value) }))
      : [0.5, 0.9, 0.99, 0.999, 0.9999]
          .filter((share) => nines(share) >= low && nines(share) <= high)
          .map((share) => ({ at: x(nines(share)), text: F.tick(100 * share) }));
    const unit = shown ? shown.unit : "%",
      half = (text) => M.textWidth(text, 10) / 2;
    let end = Infinity; // the left end of the number drawn last
    M.put(svg, "path.scale", { d: `M2,20H${WIDE - 2}${ticks.map(({ at }) => `M${at},20v3`).join("")}` });
    ticks.reverse().forEach(function ({ at, text }, place) {
      const words = place === 0 ? `${text} ${unit}`.trim() : text,
        centre = Math.max(half(words), Math.min(WIDE - half(words), at));
      if (centre + half(words) > end) return;
      end = centre - half(words) - 4;
      M.put(svg, "text", { x: centre, y: 32, "text-anchor": "middle", text: words });
    });
  }
})();
