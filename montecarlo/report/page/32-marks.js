// What pictures are made of: axes, legends, hatched colours, dashes, lines with names.
(function () {
  "use strict";
  const W = window.wingspread;
  const M = (W.marks = {});

  // Colours that the colour-blind tell apart (Okabe and Ito's), each with a hatching and a dash of its own besides.
  M.colour = (at) => (at < 0 ? "var(--none)" : `var(--c${at % 7})`);
  M.dash = (at) => ["", "7 3", "2 3", "9 3 2 3", "12 4", "4 4", "1 2"][((at % 7) + 7) % 7];
  const HATCH = [null, "M0,6 L6,0", "M0,3 H6", "M3,0 V6", "M0,0 L6,6", "M0,6 L6,0 M0,0 L6,6", "M1,1 h1 M4,4 h1"];

  // Fills of a picture by number: a pattern each, so that they differ in black and white as well.
  M.hatches = function (svg, count) {
    const stem = W.newId("hatch"),
      definitions = svg.append("defs");
    for (let at = -1; at < count; ++at) {
      const pattern = definitions
        .append("pattern")
        .attr("id", `${stem}_${at}`)
        .attr("width", 6)
        .attr("height", 6)
        .attr("patternUnits", "userSpaceOnUse");
      pattern.append("rect").attr("width", 6).attr("height", 6).style("fill", M.colour(at));
      if (at > 0 && HATCH[at % 7])
        pattern
          .append("path")
          .attr("d", HATCH[at % 7])
          .attr("class", "hatch");
    }
    return (at) => `url(#${stem}_${at})`;
  };

  const ruler = document.createElement("canvas").getContext("2d");
  M.textWidth = function (text, size = 12) {
    ruler.font = `${size}px ${getComputedStyle(document.body).fontFamily}`;
    return 1.05 * ruler.measureText(text).width; // tabular figures are a little wider
  };

  // A legend above the picture, in as many lines as it takes: items { text, fill | line, dash, mark }. Returns its height.
  M.legend = function (svg, items, width, left = 0) {
    const group = svg.append("g").attr("class", "legend");
    let x = left,
      y = 11;
    for (const item of items) {
      const needed = 22 + M.textWidth(item.text) + 16;
      if (x > left && x + needed > width + 12) {
        x = left;
        y += 18;
      }
      const one = group.append("g").attr("transform", `translate(${x},${y})`);
      if (item.fill)
        one
          .append("rect")
          .attr("x", 0)
          .attr("y", -5)
          .attr("width", 16)
          .attr("height", 10)
          .style("fill", item.fill)
          .style("fill-opacity", item.opacity || null);
      else if (item.mark)
        one
          .append("path")
          .attr("transform", "translate(8,0)")
          .attr(
            "d",
            d3
              .symbol()
              .size(50)
              .type(item.shape || d3.symbolCircle)(),
          )
          .style("fill", item.mark);
      else
        one
          .append("line")
          .attr("x2", 16)
          .style("stroke", item.line)
          .attr("stroke-width", item.heavy || 2)
          .attr("stroke-dasharray", item.dash || null);
      one
        .append("text")
        .attr("x", 21)
        .attr("dy", "0.34em")
        .text(M.shorten(item.text, width - 24));
      x += needed;
    }
    return items.length ? y + 14 : 0;
  };
  M.shorten = function (text, width, size = 12) {
    if (M.textWidth(text, size) <= width) return text;
    let kept = text;
    while (kept.length > 1 && M.textWidth(kept + "…", size) > width) kept = kept.slice(0, -1);
    return kept + "…";
  };

  // The colour's number of a set's order of latching: "no latch" has none, "others" the last.
  M.ofOrder = function (set, at) {
    const name = ((set.orders || [])[at] || { order: "no latch" }).order;
    return name === "no latch" ? -1 : name === "others" ? 6 : at;
  };

  // A shape for each number, besides its colour.
  const SHAPES = [
    d3.symbolCircle,
    d3.symbolTriangle,
    d3.symbolSquare,
    d3.symbolDiamond,
    d3.symbolCross,
    d3.symbolStar,
    d3.symbolWye,
  ];
  M.shape = (at) => SHAPES[((at % 7) + 7) % 7];

  // Axes of a box { left, right, top, bottom }: x below, y at the left, light lines across.
  M.axes = function (svg, box, x, y, options = {}) {
    const wide = box.right - box.left,
      tall = box.bottom - box.top;
    if (x) {
      const axis = d3
        .axisBottom(x)
        .tickSizeOuter(0)
        .tickSizeInner(5)
        .ticks(options.xTicks || Math.max(2, Math.min(10, wide / 80)));
      if (options.xValues) axis.tickValues(options.xValues);
      W.format.ticks(axis);
      if (options.xFormat) axis.tickFormat(options.xFormat);
      svg.append("g").attr("class", "axis x").attr("transform", `translate(0,${box.bottom})`).call(axis);
      if (options.xText)
        svg
          .append("text")
          .attr("class", "axis-text")
          .attr("x", box.right)
          .attr("y", box.bottom + 33)
          .attr("text-anchor", "end")
          .text(options.xText);
    }
    if (y) {
      const axis = d3
        .axisLeft(y)
        .tickSizeOuter(0)
        .tickSizeInner(-wide)
        .tickPadding(6)
        .ticks(options.yTicks || Math.max(2, Math.min(8, tall / 40)));
      if (options.yValues) axis.tickValues(options.yValues);
      W.format.ticks(axis);
      if (options.yFormat) axis.tickFormat(options.yFormat);
      svg.append("g").attr("class", "axis y").attr("transform", `translate(${box.left},0)`).call(axis);
      if (options.yText)
        svg
          .append("text")
          .attr("class", "axis-text")
          .attr("x", options.yTextAt === undefined ? 0 : options.yTextAt)
          .attr("y", box.top - 8)
          .text(options.yText);
    }
  };
  // Room that the y axis's numbers take.
  M.leftFor = function (y, format, count) {
    const texts = (y.ticks ? y.ticks(count || 6) : y.domain()).map(format || W.format.tick);
    return Math.ceil(Math.max(18, ...texts.map((text) => M.textWidth(text, 11.5)))) + 12;
  };

  // Upright lines with their names at the top, kept apart from each other: [{ x, text, kind, side }].
  M.uprights = function (svg, box, lines) {
    const group = svg.append("g").attr("class", "uprights"),
      taken = [];
    for (const line of lines) {
      if (line.x < box.left - 0.5 || line.x > box.right + 0.5) continue;
      const wide = M.textWidth(line.text, 12) + 12,
        rightwards = line.x + wide < box.right;
      const from = rightwards ? line.x : line.x - wide;
      let row = 0;
      while (taken.some((one) => one.row === row && from < one.to && from + wide > one.from)) ++row;
      taken.push({ row, from, to: from + wide });
      group
        .append("line")
        .attr("class", line.kind)
        .attr("x1", line.x)
        .attr("x2", line.x)
        .attr("y1", box.top)
        .attr("y2", box.bottom);
      group
        .append("text")
        .attr("class", line.kind + "-text")
        .attr("x", line.x + (rightwards ? 4 : -4))
        .attr("y", lines.low ? box.bottom - 8 - 13 * row : box.top + 10 + 13 * row)
        .attr("text-anchor", rightwards ? "start" : "end")
        .text(line.text);
    }
  };

  // A scale that shows a little more than its values.
  M.linear = function (values, range, share = 0.03) {
    const [low, high] = d3.extent(values.filter(W.isNumber));
    if (low === undefined) return d3.scaleLinear([0, 1], range);
    const room = (high - low) * share || Math.abs(high) * 0.05 || 1;
    return d3.scaleLinear([low - room, high + room], range);
  };
  M.line = (x, y) =>
    d3
      .line()
      .defined((point) => point.every(W.isNumber))
      .x((point) => x(point[0]))
      .y((point) => y(point[1]));
  M.band = (x, y) =>
    d3
      .area()
      .defined((point) => point.every(W.isNumber))
      .x((point) => x(point[0]))
      .y0((point) => y(point[1]))
      .y1((point) => y(point[2]));
})();
