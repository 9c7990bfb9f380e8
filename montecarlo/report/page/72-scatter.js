// The strongest pairs as scatter and density, and the chosen run at the foot of the page.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M } = W;

  function scatter(set, setAt, pair) {
    const output = W.outputsOf(set).find((one) => one.name === pair.output) || { name: pair.output, unit: "" },
      points = pair.points;
    const order = d3.range(points.run.length).sort((a, b) => points.x[a] - points.x[b]);
    let marks = null,
      at = -1;
    const chosen = () => (W.chosen.run && W.chosen.run.set === setAt ? W.chosen.run.run : null);
    const select = (k) => W.selectRun(setAt, points.run[k], { [pair.draw]: points.x[k], [pair.output]: points.y[k] });
    function mark() {
      if (marks)
        marks
          .classed("chosen", (k) => points.run[k] === chosen())
          .attr("aria-selected", (k) => String(points.run[k] === chosen()));
    }
    const element = W.figure({
      title: `${F.nameOf(pair.output)} against ${W.wordsOfDraw(set, pair.draw)}`,
      class: "scatter",
      interactive: true,
      printed: 440,
      note: `Spearman ${F.fixed(pair.spearman, 2)}. Shading: density of all runs; points: extreme runs and every n-th run. Click a point to select its run.`,
      description: () =>
        `Scatter of ${F.nameOf(pair.output)} over the dispersion ${pair.draw}, Spearman's coefficient ${F.fixed(pair.spearman, 2)}, ${points.run.length} runs as points.`,
      table: () => ({
        columns: ["run", pair.draw, `${pair.output} ${F.unit(output.unit)}`, "latch order"],
        rows: order.map((k) => [
          String(points.run[k]),
          points.x[k],
          points.y[k],
          ((set.orders || [])[points.order[k]] || { order: "" }).order,
        ]),
      }),
      draw: function (svg, width) {
        const { factor, unit } = F.shown(output.unit),
          used = [...new Set(points.order)].sort(d3.ascending);
        const top = M.legend(
          svg,
          used.length > 1
            ? used.map((one) => ({
                text: set.orders[one] ? F.order(set.orders[one].order) : "no hinge latched",
                mark: M.colour(M.ofOrder(set, one)),
                shape: M.shape(M.ofOrder(set, one)),
              }))
            : [],
          width,
        );
        const y = M.linear(
            [...pair.y_edges, ...points.y].map((value) => value * factor),
            [0, 1],
          ),
          box = M.boxFor(y, width, top, 270);
        const x = M.linear([...pair.x_edges, ...points.x], [box.left, box.right]);
        M.axes(svg, box, x, y, { xText: W.wordsOfDraw(set, pair.draw), yText: F.axis(F.name(output), unit) });
        cells(svg, pair, x, (value) => y(value * factor));
        const shapes = d3.symbol().size(34);
        const list = M.put(svg, "g.points", {
          role: "listbox",
          tabindex: 0,
          "aria-label": `Runs by ${pair.draw}. Arrow keys move between runs, Enter selects one`,
        });
        const stem = W.newId("run");
        marks = list
          .selectAll("path")
          .data(order)
          .enter()
          .append("path")
          .attr("role", "option")
          .attr("id", (k) => `${stem}-${k}`)
          .attr("class", "point")
          .attr("aria-selected", "false")
          .attr("d", (k) => shapes.type(M.shape(M.ofOrder(set, points.order[k])))())
          .attr("transform", (k) => `translate(${x(points.x[k])},${y(points.y[k] * factor)})`)
          .style("fill", (k) => M.colour(M.ofOrder(set, points.order[k])))
          .attr(
            "aria-label",
            (k) =>
              `run ${points.run[k]}: ${pair.draw} ${F.number(points.x[k], 4)}, ${F.name(output)} ${F.withUnit(points.y[k], output.unit)}`,
          )
          .on("click", select);
        marks.append("title").text((k) => `run ${points.run[k]}`);
        list.on("keydown", () => byKeys(d3.event, list, stem));
        mark();
        return box.bottom + 40;
      },
    });
    function byKeys(event, list, stem) {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (step) at = Math.max(0, Math.min(order.length - 1, at + step));
      else if ((event.key === "Enter" || event.key === " ") && at >= 0) select(order[at]);
      else return;
      list.attr("aria-activedescendant", `${stem}-${order[at]}`);
      marks.classed("current", (k) => k === order[at]);
      event.preventDefault();
    }
    W.on("run", () => element.isConnected && mark());
    return element;
  }
  function cells(svg, pair, x, y) {
    const most = d3.max(pair.density) || 1,
      across = pair.x_edges.length - 1,
      group = M.put(svg, "g.density");
    pair.density.forEach(function (count, at) {
      const column = at % across,
        row = Math.floor(at / across);
      if (count > 0)
        M.put(group, "rect", {
          x: x(pair.x_edges[column]),
          width: Math.max(0.5, x(pair.x_edges[column + 1]) - x(pair.x_edges[column]) + 0.4),
          y: Math.min(y(pair.y_edges[row]), y(pair.y_edges[row + 1])),
          height: Math.abs(y(pair.y_edges[row]) - y(pair.y_edges[row + 1])) + 0.4,
          "fill-opacity": 0.08 + 0.5 * Math.sqrt(count / most),
        });
    });
  }

  // Selects a run and shows its values, its replay command and its motion.
  W.selectRun = function (setAt, run, values) {
    W.choose("run", { set: setAt, run, values: values || {} });
  };
  W.on("run", function (choice) {
    const host = document.getElementById("selection");
    host.hidden = !choice;
    if (!choice) return;
    const set = W.sets[choice.set],
      motion = (set.motions || []).findIndex((one) => one.run === choice.run),
      known = motion >= 0 ? set.motions[motion] : null;
    const command = known ? known.replay : `wingspread replay ${W.shellWord(set.folder)} --run ${choice.run}`;
    const values = Object.entries(choice.values).map(([name, value]) => {
      const output = W.outputsOf(set).find((one) => one.name === name);
      return h(
        "span",
        `${output ? F.name(output) : name} `,
        h("b", output ? F.withUnit(value, output.unit) : F.number(value, 4)),
      );
    });
    W.fill(
      host,
      h(
        "p",
        h("b", `Run ${choice.run}`),
        W.sets.length > 1 ? ` of ${set.label}` : "",
        known ? ` · ${known.label}` : "",
        values.map((value) => [" · ", value]),
      ),
      W.command(command, `command of run ${choice.run}`),
      h(
        "p",
        known
          ? h(
              "button",
              {
                onclick: () => {
                  if (W.chosen.set !== choice.set) W.choose("set", choice.set);
                  W.choose("motion", motion);
                  document.getElementById("wing").scrollIntoView();
                },
              },
              "Show its motion",
            )
          : h("span.faint", "Its motion is not on this page; the command replays the run."),
        " ",
        h("button", { onclick: () => W.choose("run", null) }, "Close"),
      ),
    );
    W.say(`Run ${choice.run} chosen. ${command}`);
  });

  W.scatter = scatter;
})();
