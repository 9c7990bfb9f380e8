// The wing in motion: one of the runs worth showing, drawn to scale, with its moments beside it and a cursor on the time.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M, pose: P } = W;
  const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];
  const player = W.player,
    QUANTITIES = {
      moments: ["Moment", "N·m", 1],
      angles: ["Angle", "deg", F.DEGREES],
      rates: ["Rate", "deg/s", F.DEGREES],
    };

  // The moving picture.
  function stage(wing, motion) {
    let scale, group;
    const thinned = motion.t
      .filter((_, at) => at % Math.max(1, Math.floor(motion.t.length / 60)) === 0)
      .map((time) => P.at(motion, time));
    const bounds = P.bounds(wing, [
      ...thinned,
      { angles: P.stowed(wing) },
      { angles: P.deployed(wing), base: thinned[thinned.length - 1].base },
    ]);
    const latched = (hinge) =>
      (motion.latches || []).some((latch) => latch.hinge === hinge && latch.time <= player.time);
    const element = W.figure({
      title: `In motion: ${motion.label}`,
      class: "stage",
      description: `The wing to scale, moving: ${motion.label}. ${motion.why || ""}`,
      table: () => ({
        columns: ["time s", ...wing.hinges.map((hinge) => `${hinge.name} deg`)],
        rows: motion.t.map((time, at) => [time, ...motion.angles.map((row) => row[at] * F.DEGREES)]),
      }),
      draw: function (svg, width) {
        scale = P.scale(bounds, width, Math.max(220, Math.min(430, width * 0.62)), 4);
        P.draw(svg.append("g").attr("class", "ghost"), wing, scale, { angles: P.stowed(wing) });
        P.draw(svg.append("g").attr("class", "ghost"), wing, scale, { angles: P.deployed(wing) });
        group = svg.append("g").attr("class", "pose");
        P.bar(svg, scale, 6, scale.height + 20);
        svg
          .append("text")
          .attr("class", "clock")
          .attr("x", width - 4)
          .attr("y", scale.height + 22)
          .attr("text-anchor", "end");
        move();
        return scale.height + 32;
      },
    });
    function move() {
      if (!group) return;
      P.draw(group, wing, scale, P.at(motion, player.time), latched);
      d3.select(group.node().parentNode)
        .select(".clock")
        .text(`t = ${F.fixed(player.time, 3)} s`);
    }
    player.listen(move);
    return element;
  }

  // Beside it: a quantity of every hinge against time. Of many hinges those with the largest peaks have colours.
  function history(wing, motion) {
    let x, box, cursor;
    const clip = W.newId("clip");
    const [text, unit, factor] = QUANTITIES[player.quantity],
      rows = motion[player.quantity] || [];
    const size = rows.map((row) => d3.max(row, (value) => Math.abs(value)) || 0),
      ranked = d3.range(rows.length).sort((a, b) => size[b] - size[a]);
    const named = rows.length <= 7 ? d3.range(rows.length) : ranked.slice(0, 6).sort(d3.ascending),
      colour = (at) => (named.includes(at) ? M.colour(named.indexOf(at)) : "var(--none)");
    const element = W.figure({
      title: `${text}s of the hinges: ${motion.label}`,
      class: "history",
      description: () =>
        `${text} against time. ${(motion.peaks || [])
          .map(
            (peak) =>
              `${wing.hinges[peak.hinge].name}: peak ${F.number(peak.value, 4)} N·m at ${F.number(peak.time, 4)} s`,
          )
          .slice(0, 12)
          .join("; ")}.`,
      table: () => ({
        columns: ["time s", ...wing.hinges.map((hinge) => `${hinge.name} ${unit}`)],
        rows: motion.t.map((time, at) => [time, ...rows.map((row) => (W.isNumber(row[at]) ? row[at] * factor : null))]),
      }),
      draw: function (svg, width) {
        const items = named.map((at, place) => ({
          text: wing.hinges[at].name,
          line: M.colour(place),
          dash: M.dash(place),
        }));
        const top = M.legend(
          svg,
          rows.length > named.length
            ? [...items, { text: `${rows.length - named.length} others`, line: "var(--none)" }]
            : items,
          width,
        );
        const y = M.linear(
          [
            0,
            ...rows
              .flat()
              .filter(W.isNumber)
              .map((value) => value * factor),
          ],
          [0, 1],
        );
        box = {
          left: M.leftFor(y),
          right: width - 10,
          top: top + 18,
          bottom: top + Math.max(210, Math.min(330, width * 0.5)),
        };
        y.range([box.bottom, box.top]);
        x = d3.scaleLinear(spanOf(motion), [box.left, box.right]);
        M.axes(svg, box, x, y, { xText: "time (s)", yText: `${text.toLowerCase()} (${unit})` });
        for (const latch of motion.latches || [])
          svg
            .append("line")
            .attr("class", "latch-line")
            .style("stroke", colour(latch.hinge))
            .attr("x1", x(latch.time))
            .attr("x2", x(latch.time))
            .attr("y1", box.top)
            .attr("y2", box.bottom);
        d3.range(rows.length)
          .sort((a, b) => named.includes(a) - named.includes(b))
          .forEach((at) =>
            svg
              .append("path")
              .attr("class", "trace")
              .attr(
                "d",
                M.line(x, y)(motion.t.map((time, k) => [time, W.isNumber(rows[at][k]) ? rows[at][k] * factor : null])),
              )
              .style("stroke", colour(at))
              .attr("stroke-dasharray", named.includes(at) ? M.dash(named.indexOf(at)) : null)
              .append("title")
              .text(wing.hinges[at].name),
          );
        svg
          .append("clipPath")
          .attr("id", clip)
          .append("rect")
          .attr("x", box.left)
          .attr("y", box.top - 4)
          .attr("width", box.right - box.left)
          .attr("height", box.bottom - box.top + 8);
        svg.selectAll(".trace, .latch-line").attr("clip-path", `url(#${clip})`);
        cursor = svg
          .append("line")
          .attr("clip-path", `url(#${clip})`)
          .attr("class", "cursor")
          .attr("y1", box.top - 4)
          .attr("y2", box.bottom + 4);
        const toTime = (event) =>
          player.seek(
            x.invert(
              ((event.clientX - svg.node().getBoundingClientRect().left) * width) /
                svg.node().getBoundingClientRect().width,
            ),
          );
        svg
          .append("rect")
          .attr("class", "catch")
          .attr("x", box.left)
          .attr("y", box.top)
          .attr("width", box.right - box.left)
          .attr("height", box.bottom - box.top)
          .on("pointerdown", () => toTime(d3.event))
          .on("pointermove", () => d3.event.buttons && toTime(d3.event));
        move();
        return box.bottom + 40;
      },
    });
    function move() {
      if (cursor) cursor.attr("x1", x(player.time)).attr("x2", x(player.time));
    }
    player.listen(move);
    return element;
  }

  // The whole run, or the time in which the hinges latch.
  function spanOf(motion) {
    const whole = d3.extent(motion.t),
      latches = d3.extent(motion.latches || [], (latch) => latch.time);
    if (player.span === "whole" || latches[0] === undefined) return whole;
    const room = Math.max(0.03 * whole[1], 0.25 * (latches[1] - latches[0]));
    return [Math.max(whole[0], latches[0] - room), Math.min(whole[1], latches[1] + 3 * room)];
  }

  // Numbers at the cursor.
  function readout(wing, motion) {
    const cells = wing.hinges.map(() => d3.range(4).map(() => document.createTextNode("")));
    const table = W.table(
      "Hinges at the cursor's time",
      [
        { text: "Hinge" },
        { text: "Angle", unit: "deg", kind: "number" },
        { text: "Rate", unit: "deg/s", kind: "number" },
        { text: "Moment", unit: "N·m", kind: "number" },
        { text: "State" },
      ],
      wing.hinges.map((hinge, at) => [hinge.name, ...cells[at]]),
      { class: "readout" },
    );
    function move() {
      const now = P.at(motion, player.time);
      cells.forEach(function (row, at) {
        const latch = (motion.latches || []).find((one) => one.hinge === at);
        const texts = [
          F.fixed(now.angles[at] * F.DEGREES, 2),
          F.fixed(now.rates[at] * F.DEGREES, 2),
          F.fixed(now.moments[at], 2),
          latch
            ? latch.time <= player.time
              ? `latched at ${F.fixed(latch.time, 3)} s`
              : "open"
            : wing.hinges[at].latch === false
              ? "has no latch"
              : "open, never latches",
        ];
        texts.forEach((text, place) => {
          if (row[place].data !== text) row[place].data = text;
        });
      });
    }
    player.listen(move);
    move();
    return table;
  }

  function controls(motion) {
    const end = motion.t[motion.t.length - 1],
      step = end / 200;
    const button = h("button", { type: "button", class: "play", onclick: () => player.play(!player.playing) }, "Play");
    const scrub = h("input", {
      type: "range",
      class: "scrub",
      min: motion.t[0],
      max: end,
      step: "any",
      value: player.time,
      "aria-label": "Time",
      oninput: (event) => {
        player.play(false);
        player.seek(Number(event.target.value));
      },
      onkeydown: (event) => {
        if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
          player.seek(player.time + (event.key === "ArrowRight" ? step : -step));
          event.preventDefault();
        }
      },
    });
    const speed = h(
      "select",
      { "aria-label": "Speed", onchange: (event) => (player.speed = Number(event.target.value)) },
      SPEEDS.map((value) =>
        h("option", { value, selected: value === player.speed }, value === 1 ? "real time" : `× ${value}`),
      ),
    );
    const clock = h("output", { class: "time" });
    const move = function () {
      if (button.textContent !== (player.playing ? "Pause" : "Play"))
        button.textContent = player.playing ? "Pause" : "Play";
      scrub.value = player.time;
      scrub.setAttribute("aria-valuetext", `${F.fixed(player.time, 2)} seconds`);
      clock.textContent = `${F.fixed(player.time, 3)} of ${F.fixed(end, 2)} s`;
    };
    player.listen(move);
    move();
    const jumps = h(
      "label",
      {},
      h("span", {}, "Go to "),
      h(
        "select",
        {
          "aria-label": "Go to an event",
          onchange: (event) => {
            player.play(false);
            player.seek(Number(event.target.value));
          },
        },
        h("option", { value: 0 }, "start"),
        (motion.latches || [])
          .slice()
          .sort((a, b) => a.time - b.time)
          .map((latch) => h("option", { value: latch.time }, `${W.set().wing.hinges[latch.hinge].name} latches`)),
        (motion.peaks || [])
          .filter((peak) => W.isNumber(peak.time))
          .map((peak) => h("option", { value: peak.time }, `peak moment of ${W.set().wing.hinges[peak.hinge].name}`)),
        h("option", { value: end }, "end"),
      ),
    );
    return h(
      "div",
      { class: "player-controls" },
      button,
      scrub,
      clock,
      h("label", {}, h("span", {}, "Speed "), speed),
      jumps,
    );
  }
  function choices(set) {
    return h(
      "div",
      { class: "choices", role: "group", "aria-label": "Run to show" },
      set.motions.map((motion, at) =>
        h(
          "button",
          {
            type: "button",
            class: "choice",
            "aria-pressed": String(at === W.chosen.motion),
            onclick: () => W.choose("motion", at),
          },
          h("b", {}, motion.label),
          h(
            "small",
            {},
            motion.run === null || motion.run === undefined ? "nothing dispersed" : `run ${motion.run}`,
            motion.status && motion.status !== "deployed" ? ` · ${motion.status.replace("_", " ")}` : "",
          ),
        ),
      ),
    );
  }

  W.motion = function (set) {
    const wing = set.wing,
      motion = set.motions[Math.min(W.chosen.motion, set.motions.length - 1)];
    player.load(motion);
    const beside = h("div", {});
    const show = () =>
      W.fill(
        beside,
        h(
          "div",
          { class: "controls" },
          W.buttons(
            "Show",
            Object.entries(QUANTITIES).map(([key, [text]]) => [key, text]),
            player.quantity,
            (value) => {
              player.quantity = value;
              show();
            },
          ),
          (motion.latches || []).length
            ? W.buttons(
                "Time",
                [
                  ["whole", "whole run"],
                  ["latches", "while latching"],
                ],
                player.span,
                (value) => {
                  player.span = value;
                  show();
                },
              )
            : null,
        ),
        history(wing, motion),
      );
    show();
    const element = h(
      "div",
      {
        class: "player",
        role: "group",
        "aria-label": "Wing in motion. Space plays and pauses, the arrow keys step, Home and End go to the ends",
        tabindex: "0",
        onkeydown: player.byKeys,
      },
      h("div", { class: "pair" }, h("div", {}, stage(wing, motion), controls(motion), readout(wing, motion)), beside),
    );
    const strobe = P.stroboscope(wing, motion, motion.label);
    return [
      choices(set),
      h(
        "p",
        { class: "why-shown" },
        h("b", {}, motion.label),
        motion.why ? `: ${motion.why}` : "",
        motion.reason ? ` · ${motion.reason}` : "",
      ),
      motion.replay ? W.command(motion.replay, "command of this run") : null,
      element,
      strobe,
    ];
  };
})();
