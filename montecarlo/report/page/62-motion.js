// The wing in motion: a chosen run to scale, its moments over time beside it, and a cursor at the player's time.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M, pose: P } = W;
  const MOST_NAMED = 14; // seven colours, two dashes each
  const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];
  const HAPPENS = { released: "is released", missed: "passes its latch too fast", let_go: "is let go by its latch" };
  const player = W.player,
    QUANTITIES = { moments: ["Moment", "N m"], angles: ["Angle", "rad"], rates: ["Rate", "rad/s"] };
  const angle = () => F.shown("rad"),
    rate = () => F.shown("rad/s");

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
    const latched = (hinge) => P.state(wing, motion, hinge, player.time).latched;
    const element = W.figure({
      title: `In motion: ${motion.label}`,
      class: "stage",
      printed: 440,
      description: `The wing to scale, moving: ${motion.label}. ${motion.why || ""}`,
      table: () => ({
        columns: ["time s", ...wing.hinges.map((hinge) => `${hinge.name} ${angle().unit}`)],
        rows: motion.t.map((time, at) => [time, ...motion.angles.map((row) => row[at] * angle().factor)]),
      }),
      draw: function (svg, width) {
        scale = P.scale(bounds, width, Math.max(220, Math.min(430, width * 0.62)), 4);
        P.draw(M.put(svg, "g.ghost"), wing, scale, { angles: P.stowed(wing) });
        P.draw(M.put(svg, "g.ghost"), wing, scale, { angles: P.deployed(wing) });
        group = M.put(svg, "g.pose");
        P.bar(svg, scale, 6, scale.height + 20);
        M.put(svg, "text.clock", { x: width - 4, y: scale.height + 22, "text-anchor": "end" });
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

  // A quantity of every hinge over time. Up to MOST_NAMED hinges have a colour and dash each; if there are more, only those
  // with the largest peaks have one.
  function history(wing, motion) {
    let x, box, cursor;
    const clip = W.newId("clip");
    const [text, quantity] = QUANTITIES[player.quantity],
      { unit, factor } = F.shown(quantity),
      rows = motion[player.quantity] || [];
    const size = rows.map((row) => d3.max(row, (value) => Math.abs(value)) || 0),
      ranked = d3.range(rows.length).sort((a, b) => size[b] - size[a]);
    const named = ranked.slice(0, rows.length <= MOST_NAMED ? rows.length : MOST_NAMED - 1).sort(d3.ascending),
      colour = (at) => (named.includes(at) ? M.colour(named.indexOf(at)) : "var(--none)");
    const element = W.figure({
      title: `${text}s of the hinges: ${motion.label}`,
      class: "history",
      printed: 440,
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
        const items = M.lineItems(named, (at) => wing.hinges[at].name);
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
        x = d3.scaleLinear(player.interval(), [box.left, box.right]);
        M.axes(svg, box, x, y, { xText: "time (s)", yText: `${text.toLowerCase()} (${unit})` });
        for (const latch of motion.latches || [])
          M.upright(svg, "line.latch-line", x(latch.time), box).style("stroke", colour(latch.hinge));
        d3.range(rows.length)
          .sort((a, b) => named.includes(a) - named.includes(b))
          .forEach((at) =>
            M.put(svg, "path.trace", {
              d: M.line(x, y)(motion.t.map((time, k) => [time, W.isNumber(rows[at][k]) ? rows[at][k] * factor : null])),
              "stroke-dasharray": named.includes(at) ? M.dash(named.indexOf(at)) : null,
              style: { stroke: colour(at) },
              title: wing.hinges[at].name,
            }),
          );
        M.over(M.put(svg, "clipPath", { id: clip }), "rect", box, 4);
        svg.selectAll(".trace, .latch-line").attr("clip-path", `url(#${clip})`);
        cursor = M.put(svg, "line.cursor", { "clip-path": `url(#${clip})`, y1: box.top - 4, y2: box.bottom + 4 });
        const toTime = (event) =>
          player.seek(
            x.invert(
              ((event.clientX - svg.node().getBoundingClientRect().left) * width) /
                svg.node().getBoundingClientRect().width,
            ),
          );
        M.put(svg, "rect.catch", { x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top })
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

  // The hinges' state at the cursor.
  function readout(wing, motion) {
    const forces = motion.force_peaks || [],
      peakForce = function (hinge) {
        const { value, time } = forces.find((one) => one.hinge === hinge) || {};
        return W.isNumber(value) ? `${F.number(value, 4)}${W.isNumber(time) ? ` at ${F.fixed(time, 3)} s` : ""}` : F.none;
      };
    const cells = wing.hinges.map(() => d3.range(4).map(() => document.createTextNode("")));
    const table = W.table(
      "Hinges at the cursor's time",
      [
        "Hinge",
        number("Angle", angle().unit),
        number("Rate", rate().unit),
        number("Moment", "N·m"),
        "State",
        ...(forces.length ? [number("Peak force of the run", "N")] : []),
      ],
      wing.hinges.map((hinge, at) => [hinge.name, ...cells[at], ...(forces.length ? [peakForce(at)] : [])]),
      { class: "readout" },
    );
    function move() {
      const now = P.at(motion, player.time);
      cells.forEach(function (row, at) {
        const texts = [
          F.fixed(now.angles[at] * angle().factor, angle().factor === 1 ? 4 : 2),
          F.fixed(now.rates[at] * rate().factor, rate().factor === 1 ? 4 : 2),
          F.fixed(now.moments[at], 2),
          P.state(wing, motion, at, player.time).text,
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
      name = (event) => W.set().wing.hinges[event.hinge].name;
    const button = h("button.play", { onclick: () => player.play(!player.playing) }, "Play");
    const scrub = h("input.scrub", {
      type: "range",
      min: motion.t[0],
      max: player.stopTime(),
      step: "any",
      value: player.time,
      "aria-label": "Time",
      oninput: (event) => {
        const wanted = Number(event.target.value); // before the player, which sets it
        player.play(false);
        player.seek(wanted);
      },
      onkeydown: (event) => {
        if (event.key === "ArrowRight" || event.key === "ArrowLeft") {
          player.seek(player.time + (event.key === "ArrowRight" ? 1 : -1) * (player.stopTime() / 200));
          event.preventDefault();
        }
      },
    });
    const speed = W.select(
      { "aria-label": "Speed", onchange: (event) => (player.speed = Number(event.target.value)) },
      SPEEDS.map((value) => [value, value === 1 ? "real time" : `× ${value}`]),
      player.speed,
    );
    const clock = h("output.time");
    const move = function () {
      if (button.textContent !== (player.playing ? "Pause" : "Play"))
        button.textContent = player.playing ? "Pause" : "Play";
      const stop = player.stopTime();
      scrub.max = stop;
      scrub.value = player.time;
      scrub.setAttribute("aria-valuetext", `${F.fixed(player.time, 2)} seconds`);
      clock.textContent = `${F.fixed(player.time, 3)} of ${F.fixed(stop, 2)} s`;
    };
    player.listen(move);
    move();
    const jumps = h(
      "label",
      h("span", "Go to "),
      W.select(
        {
          "aria-label": "Go to an event",
          onchange: (event) => {
            player.play(false);
            player.seek(Number(event.target.value));
          },
        },
        [
          [0, "start"],
          ...[...(motion.latches || []), ...(motion.events || [])]
            .sort((a, b) => a.time - b.time)
            .map((one) => [one.time, `${name(one)} ${HAPPENS[one.kind] || "latches"}`]),
          ...(motion.peaks || [])
            .filter((peak) => W.isNumber(peak.time))
            .map((peak) => [peak.time, `peak moment of ${name(peak)}`]),
          ...(motion.force_peaks || [])
            .filter((peak) => W.isNumber(peak.time))
            .map((peak) => [peak.time, `peak force of ${name(peak)}`]),
          [end, "end"],
        ],
      ),
    );
    return h("div.player-controls", button, scrub, clock, h("label", h("span", "Speed "), speed), jumps);
  }
  function choices(set) {
    return h(
      "div.choices",
      { role: "group", "aria-label": "Run to show" },
      set.motions.map((motion, at) =>
        h(
          "button.choice",
          { "aria-pressed": String(at === W.chosen.motion), onclick: () => W.choose("motion", at) },
          h("b", motion.label),
          h(
            "small",
            motion.run === null || motion.run === undefined ? "dispersions at medians" : `run ${motion.run}`,
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
    const beside = h("div");
    const choose = (key) => (value) => {
      player[key] = value;
      show();
      player.seek(player.time); // the slider's end follows the displayed interval
    };
    const show = () =>
      W.fill(
        beside,
        h(
          "div.controls",
          W.buttons(
            "Show",
            Object.entries(QUANTITIES).map(([key, [text]]) => [key, text]),
            player.quantity,
            choose("quantity"),
          ),
          (motion.latches || []).length
            ? W.buttons(
                "Time",
                Object.entries({ latches: "while latching", whole: "whole run" }),
                player.span,
                choose("span"),
              )
            : null,
        ),
        history(wing, motion),
      );
    show();
    const element = h(
      "div.player",
      {
        role: "group",
        "aria-label": "Wing in motion. Space plays and pauses, the arrow keys step, Home and End go to the ends",
        tabindex: "0",
        onkeydown: player.byKeys,
      },
      h("div.pair", h("div", stage(wing, motion), controls(motion), readout(wing, motion)), beside),
    );
    const strobe = P.stroboscope(wing, motion, motion.label);
    return [
      choices(set),
      h(
        "p.why-shown",
        h("b", motion.label),
        motion.why ? `: ${motion.why}` : "",
        motion.reason ? ` · ${motion.reason}` : "",
      ),
      motion.replay ? W.command(motion.replay, "command of this run") : null,
      element,
      strobe,
    ];
  };
})();
