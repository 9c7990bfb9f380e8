// Parts of pictures: axes, legends, hatched colours, dashes, marks with labels.
(function () {
  "use strict";
  const W = window.wingspread;
  const M = (W.marks = {});

  // Appends an element and returns its selection: M.put(svg, "line.limit", { x1: 0, x2: 9, style: {}, text: "", title: "" }).
  M.put = function (parent, name, { style = {}, text, title, ...attributes } = {}) {
    const [tag, ...classes] = name.split("."),
      element = parent.append(tag);
    if (classes.length) element.attr("class", classes.join(" "));
    Object.entries(attributes).forEach(([key, value]) => element.attr(key, value));
    Object.entries(style).forEach(([key, value]) => element.style(key, value));
    if (text !== undefined) element.text(text);
    if (title !== undefined) element.append("title").text(title);
    return element;
  };
  M.upright = (parent, name, x, box) => M.put(parent, name, { x1: x, x2: x, y1: box.top, y2: box.bottom });
  // A label at the left of a row, shortened to the available width.
  M.rowLabel = (svg, text, left, y) =>
    M.put(svg, "text", {
      x: left - 8,
      y,
      dy: "0.35em",
      "text-anchor": "end",
      text: M.shorten(text, left - 8),
      title: text,
    });
  // The width for the labels of rows is at most this share of the picture's width.
  M.labelRoom = (width, share, texts) =>
    Math.min(width * share, Math.max(...texts.map((text) => M.textWidth(text))) + 12);
  // A confidence interval: a horizontal line between two short ticks.
  M.whisker = (svg, x, low, high, y, tick) =>
    M.put(svg, "path.whisker", {
      d: `M${x(low)},${y}H${x(high)}M${x(low)},${y - tick}v${2 * tick}M${x(high)},${y - tick}v${2 * tick}`,
    });
  // The box of a picture `tall` pixels high under its legend; sets the range of its y scale.
  M.boxFor = function (y, width, top, tall, right = 12) {
    const box = { left: M.leftFor(y), right: width - right, top: top + 18, bottom: top + tall };
    y.range([box.bottom, box.top]);
    return box;
  };

  // Okabe and Ito's colours, which colour-blind readers can tell apart. Each colour has a hatching and a dash of its own.
  M.colour = (at) => (at < 0 ? "var(--none)" : `var(--c${at % 7})`);
  // Beyond seven the colours come again, each with another dash.
  M.dash = (at) => ["", "7 3", "2 3", "9 3 2 3", "12 4", "4 4", "1 2"][(((at + Math.floor(at / 7)) % 7) + 7) % 7];
  // Hatchings by colour number: [a, b, c] are the lines ax + by = c, and every 6 px another; the last is dotted.
  const HATCH = [[], [[1, 1, 0]], [[0, 1, 3]], [[1, 0, 3]], [[1, -1, 0]], [[1, 1, 0], [1, -1, 0]], [[0, 1, 1], [0, 1, 4]]];
  const EVERY = 6,
    DOTS = 6;
  const firstFrom = (low, phase) => low + ((((phase - low) % EVERY) + EVERY) % EVERY);
  const px = (number) => Number(number.toFixed(2));

  // The lines of a hatching within a box [left, top, width, height], as a path's text.
  function linesIn([left, top, width, height], [a, b, c], dotted) {
    const right = left + width,
      bottom = top + height,
      along = [a * left, a * right].flatMap((one) => [one + b * top, one + b * bottom]),
      [low, high] = d3.extent(along);
    let text = "";
    for (let at = firstFrom(low, c); at < high; at += EVERY) {
      const dot = firstFrom(left, c);
      if (b === 0) text += `M${px(at)},${px(top)}V${px(bottom)}`;
      else if (a === 0) {
        if (!dotted || dot < right) text += `M${px(dotted ? dot : left)},${px(at)}H${px(right)}`;
      } else {
        const [from, to] = d3.extent([at - b * top, at - b * bottom]),
          ends = [Math.max(left, from), Math.min(right, to)].map((x) => `${px(x)},${px(b * (at - x))}`);
        text += `M${ends[0]}L${ends[1]}`;
      }
    }
    return text;
  }

  // Hatches boxes [left, top, width, height] of a colour, so that colours differ in black and white as well. One path of
  // lines, not an SVG pattern: Chromium prints each pattern as an image, of 160 kB and a twentieth of a second per bar.
  M.hatch = function (svg, at, boxes) {
    const lines = at < 0 ? [] : HATCH[at % 7],
      dotted = at % 7 === DOTS;
    if (lines.length && boxes.length)
      M.put(svg, "path.hatch", {
        d: boxes.flatMap((box) => lines.map((one) => linesIn(box, one, dotted))).join(""),
        "stroke-dasharray": dotted ? "1 5" : null,
        "pointer-events": "none",
      });
  };

  // A picture within a line of a table.
  M.small = (name, width, height) =>
    d3
      .create("svg")
      .attr("class", name)
      .attr("viewBox", `0 0 ${width} ${height}`)
      .attr("width", width)
      .attr("height", height)
      .attr("aria-hidden", "true");

  const ruler = document.createElement("canvas").getContext("2d");
  M.textWidth = function (text, size = 12) {
    ruler.font = `${size}px ${getComputedStyle(document.body).fontFamily}`;
    return 1.05 * ruler.measureText(text).width; // tabular figures are a little wider
  };

  // Draws a legend above the picture, in as many lines as necessary: items { text, fill, hatch | line, dash, mark }. Returns its height.
  M.legend = function (svg, items, width, left = 0) {
    const group = M.put(svg, "g.legend");
    let x = left,
      y = 11;
    for (const item of items) {
      const needed = 22 + M.textWidth(item.text) + 16;
      if (x > left && x + needed > width + 12) {
        x = left;
        y += 18;
      }
      const one = M.put(group, "g", { transform: `translate(${x},${y})` });
      if (item.fill) {
        M.put(one, "rect", {
          x: 0,
          y: -5,
          width: 16,
          height: 10,
          style: { fill: item.fill, "fill-opacity": item.opacity || null },
        });
        if (item.hatch) M.hatch(one, item.hatch, [[0, -5, 16, 10]]);
      } else if (item.mark)
        M.put(one, "path", {
          transform: "translate(8,0)",
          d: d3
            .symbol()
            .size(50)
            .type(item.shape || d3.symbolCircle)(),
          style: { fill: item.mark },
        });
      else
        M.put(one, "line", {
          x2: 16,
          "stroke-width": item.heavy || 2,
          "stroke-dasharray": item.dash || null,
          style: { stroke: item.line },
        });
      M.put(one, "text", { x: 21, dy: "0.34em", text: M.shorten(item.text, width - 24) });
      x += needed;
    }
    return items.length ? y + 14 : 0;
  };
  M.shorten = function (text, width, size = 12) {
    if (M.textWidth(text, size) <= width) return text;
    const kept = [...text]; // characters: half of a pair of surrogates is none
    while (kept.length > 1 && M.textWidth(kept.join("") + "…", size) > width) kept.pop();
    return kept.join("") + "…";
  };

  // The colour number of a latch order of the set: -1 (grey) for "no latch", the last for "others".
  M.ofOrder = function (set, at) {
    const name = ((set.orders || [])[at] || { order: "no latch" }).order;
    return name === "no latch" ? -1 : W.format.isOthers(name) ? 6 : at;
  };

  const SHAPES = "Circle Triangle Square Diamond Cross Star Wye".split(" ").map((name) => d3[`symbol${name}`]);
  M.shape = (at) => SHAPES[((at % 7) + 7) % 7];

  const ticksOf = (scale, count) => (scale.ticks ? scale.ticks(count) : scale.domain());
  // Axes of a box { left, right, top, bottom }: x below, y at the left, light lines across.
  M.axes = function (svg, box, x, y, options = {}) {
    const wide = box.right - box.left,
      tall = box.bottom - box.top;
    if (x) {
      const count = options.xTicks || Math.max(2, Math.min(10, wide / 80)),
        axis = d3.axisBottom(x).tickSizeOuter(0).tickSizeInner(5).ticks(count);
      if (options.xValues) axis.tickValues(options.xValues);
      axis.tickFormat(options.xFormat || W.format.ticks(options.xValues || ticksOf(x, count)));
      M.put(svg, "g.axis.x", { transform: `translate(0,${box.bottom})` }).call(axis);
      if (options.xText)
        M.put(svg, "text.axis-text", { x: box.right, y: box.bottom + 33, "text-anchor": "end", text: M.shorten(options.xText, box.right) });
    }
    if (y) {
      const count = options.yTicks || Math.max(2, Math.min(8, tall / 40)),
        axis = d3.axisLeft(y).tickSizeOuter(0).tickSizeInner(-wide).tickPadding(6).ticks(count);
      if (options.yValues) axis.tickValues(options.yValues);
      axis.tickFormat(options.yFormat || W.format.ticks(options.yValues || ticksOf(y, count)));
      M.put(svg, "g.axis.y", { transform: `translate(${box.left},0)` }).call(axis);
      if (options.yText) {
        const at = options.yTextAt === undefined ? 0 : options.yTextAt;
        M.put(svg, "text.axis-text", { x: at, y: box.top - 8, text: M.shorten(options.yText, box.right + 8 - at) });
      }
    }
  };
  // The width of the y axis's numbers, px.
  M.leftFor = function (y, format, count) {
    const ticks = ticksOf(y, count || 6),
      texts = ticks.map(format || W.format.ticks(ticks));
    return Math.ceil(Math.max(18, ...texts.map((text) => M.textWidth(text, 11.5)))) + 12;
  };

  // Upright lines with labels that do not overlap: [{ x, text, kind }]; labels at the bottom where `low` is set.
  M.uprights = function (svg, box, lines, low) {
    const group = M.put(svg, "g.uprights"),
      taken = [];
    for (const line of lines) {
      if (line.x < box.left - 0.5 || line.x > box.right + 0.5) continue;
      const wide = M.textWidth(line.text, 12) + 12,
        crosses = lines.some((one) => one.x > line.x && one.x < line.x + wide), // a label lies on no other line
        rightwards = line.x + wide < box.right && !(crosses && line.x - wide > box.left);
      const from = rightwards ? line.x : line.x - wide;
      let row = 0;
      while (taken.some((one) => one.row === row && from < one.to && from + wide > one.from)) ++row;
      taken.push({ row, from, to: from + wide });
      M.upright(group, `line.${line.kind}`, line.x, box);
      M.put(group, "text", {
        class: line.kind + "-text",
        x: line.x + (rightwards ? 4 : -4),
        y: low ? box.bottom - 8 - 13 * row : box.top + 10 + 13 * row,
        "text-anchor": rightwards ? "start" : "end",
        text: line.text,
      });
    }
  };

  // A linear scale over the values with a margin at both ends (a share of their spread).
  M.linear = function (values, range, share = 0.03) {
    const [low, high] = d3.extent(values.filter(W.isNumber));
    if (low === undefined) return d3.scaleLinear([0, 1], range);
    const room = (high - low) * share || Math.abs(high) * 0.05 || 1;
    return d3.scaleLinear([low - room, high + room], range);
  };
  // Legend items of lines that differ in colour and dash.
  M.lineItems = (items, text, at = (_, place) => place) =>
    items.map((one, place) => ({ text: text(one), line: M.colour(at(one, place)), dash: M.dash(at(one, place)) }));
  M.trace = (svg, d, at, name = "path.trace") =>
    M.put(svg, name, { d, style: { stroke: M.colour(at) }, "stroke-dasharray": M.dash(at) || null });
  // A rectangle over a box, taller by `more` pixels at both ends.
  M.over = (parent, name, box, more = 0) =>
    M.put(parent, name, {
      x: box.left,
      y: box.top - more,
      width: Math.max(0, box.right - box.left),
      height: box.bottom - box.top + 2 * more,
    });
  const defined = (curve, x) => curve.defined((point) => point.every(W.isNumber)).x((point) => x(point[0]));
  M.line = (x, y) => defined(d3.line(), x).y((point) => y(point[1]));
  M.band = (x, y) =>
    defined(d3.area(), x)
      .y0((point) => y(point[1]))
      .y1((point) => y(point[2]));
})();
