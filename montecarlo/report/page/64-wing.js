// The wing's section: motion, stowed and deployed drawings, envelopes of angles and rates, latch times as strips.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M, pose: P } = W;
  const EACH = 6; // hinges per picture, so that a printed page has room for 12 panels

  // Pairs of levels around the median, the outermost (lightest) first.
  function bands(levels) {
    const middle = levels.findIndex((level) => Math.abs(level - 0.5) < 1e-9),
      pairs = [];
    for (let at = 0; at < levels.length / 2 && levels.length - 1 - at > at; ++at)
      pairs.push([at, levels.length - 1 - at]);
    return { middle, pairs };
  }
  // An angle or a rate in the displayed unit.
  const shown = (value) => (W.isNumber(value) ? value * F.shown("rad").factor : null);
  const percent = (level) => `${Number((100 * level).toPrecision(4))} %`;

  function panel(svg, box, envelopes, rows, title, unit, range) {
    const { middle, pairs } = bands(envelopes.levels),
      { factor } = F.shown("rad"),
      x = d3.scaleLinear(d3.extent(envelopes.t), [box.left, box.right]);
    const y = range.copy().range([box.bottom, box.top]);
    M.axes(svg, box, x, y, {
      yText: `${title} (${unit})`,
      yTextAt: box.left - 34,
      yTicks: 4,
      xTicks: Math.max(2, Math.min(6, (box.right - box.left) / 60)),
      xFormat: (value, at, all) => `${F.tick(value)}${at === all.length - 1 ? " s" : ""}`,
    });
    pairs.forEach(([low, high], depth) =>
      M.put(svg, "path", {
        class: `envelope depth-${depth}`,
        d: M.band(x, y)(envelopes.t.map((time, at) => [time, rows[low][at] * factor, rows[high][at] * factor])),
      }),
    );
    if (middle >= 0)
      M.put(svg, "path.median", {
        d: M.line(x, y)(envelopes.t.map((time, at) => [time, rows[middle][at] * factor])),
      });
  }

  function envelopeFigure(set, hinges, part, parts) {
    const { envelopes, wing } = set,
      { pairs } = bands(envelopes.levels);
    const range = (rows) => M.linear(rows.flat().map(shown), [0, 1]);
    return W.figure({
      title: `Envelopes of angles and rates${parts > 1 ? `, ${wing.hinges[hinges[0]].name} to ${wing.hinges[hinges[hinges.length - 1]].name}` : ""}`,
      class: "envelopes",
      printed: 940,
      note: `Quantiles at each instant over ${F.count(envelopes.runs)} runs spread evenly through the campaign. No single run follows the edge of a band.`,
      description: `Bands of the angle and rate of each hinge against time: ${pairs.map(([low, high]) => `${percent(envelopes.levels[low])} to ${percent(envelopes.levels[high])}`).join(", ")}, and the median.`,
      table: () => ({
        columns: [
          "time s",
          ...hinges.flatMap((hinge) =>
            envelopes.levels.flatMap((level) => [
              `${wing.hinges[hinge].name} angle ${percent(level)} ${F.shown("rad").unit}`,
              `${wing.hinges[hinge].name} rate ${percent(level)} ${F.shown("rad/s").unit}`,
            ]),
          ),
        ],
        rows: envelopes.t.map((time, at) => [
          time,
          ...hinges.flatMap((hinge) =>
            envelopes.levels.flatMap((_, level) =>
              [envelopes.angles, envelopes.rates].map((rows) => shown(rows[hinge][level][at])),
            ),
          ),
        ]),
      }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          [
            ...pairs.map(([low, high], depth) => ({
              text: `${percent(envelopes.levels[low])} – ${percent(envelopes.levels[high])}`,
              fill: `var(--band-${depth})`,
            })),
            { text: "median", line: "var(--c0)" },
          ],
          width,
        );
        const columns = width >= 900 ? 4 : 2,
          across = Math.min(columns, 2 * hinges.length),
          cell = width / across,
          tall = width < 500 ? 130 : 150;
        hinges.forEach(function (hinge, at) {
          ["angle", "rate"].forEach(function (text, second) {
            const place = 2 * at + second,
              left = (place % across) * cell,
              upper = top + Math.floor(place / across) * (tall + 24);
            panel(
              svg,
              { left: left + 42, right: left + cell - 10, top: upper + 20, bottom: upper + tall },
              envelopes,
              envelopes[`${text}s`][hinge],
              `${wing.hinges[hinge].name} ${text}`,
              F.shown(second ? "rad/s" : "rad").unit,
              range(envelopes[`${text}s`][hinge]),
            );
          });
        });
        return top + Math.ceil((2 * hinges.length) / across) * (tall + 24) + 14;
      },
    });
  }
  function strips(set) {
    const { envelopes, wing } = set,
      row = wing.hinges.length > 12 ? 15 : 30,
      thinned = envelopes.latch_times.some((times, at) => times.length < envelopes.latched[at]);
    return W.figure({
      title: "Latch times of the sampled runs",
      class: "strips",
      note: `${thinned ? "Strokes for a part of the runs, the first and the last to latch among them" : "One stroke per run"} (${F.count(envelopes.runs)} runs); the longer mark is the median. At the right: runs in which the hinge latched.`,
      description: () =>
        wing.hinges
          .map((hinge, at) => {
            const times = envelopes.latch_times[at] || [];
            return times.length
              ? `${hinge.name}: median ${F.number(d3.median(times), 4)} s, ${F.number(times[0], 4)} to ${F.number(times[times.length - 1], 4)} s`
              : `${hinge.name} latched in none`;
          })
          .slice(0, 20)
          .join("; "),
      table: () => ({
        columns: ["hinge", "latch times s"],
        rows: wing.hinges.flatMap((hinge, at) => (envelopes.latch_times[at] || []).map((time) => [hinge.name, time])),
      }),
      draw: function (svg, width) {
        const all = envelopes.latch_times.flat(),
          left = M.labelRoom(
            width,
            0.3,
            wing.hinges.map((hinge) => hinge.name),
          );
        const box = { left, right: width - 76, top: 6, bottom: 6 + row * wing.hinges.length },
          x = M.linear(all, [box.left, box.right]);
        if (all.length) M.axes(svg, box, x, null, { xText: "latch time (s)" });
        wing.hinges.forEach(function (hinge, at) {
          const times = envelopes.latch_times[at] || [],
            middle = box.top + row * (at + 0.5);
          M.rowLabel(svg, hinge.name, left, middle);
          M.put(svg, "path.strip", {
            d: times.map((time) => `M${x(time).toFixed(1)},${middle - row * 0.3}v${row * 0.6}`).join(""),
          });
          if (times.length)
            M.upright(svg, "line.strip-median", x(d3.median(times)), {
              top: middle - row * 0.45,
              bottom: middle + row * 0.45,
            });
          M.put(svg, "text.faint-text", {
            x: width - 70,
            y: middle,
            dy: "0.35em",
            text: times.length ? `${envelopes.latched[at]} of ${envelopes.runs}` : "in none",
          });
        });
        return box.bottom + (all.length ? 40 : 6);
      },
    });
  }

  function envelopeParts(set) {
    if (!set.envelopes)
      return [h("h3", "Envelopes"), h("p.nothing", "No run is long enough for envelopes of angles and rates.")];
    const groups = d3
      .range(0, set.wing.hinges.length, EACH)
      .map((from) => d3.range(from, Math.min(set.wing.hinges.length, from + EACH)));
    const name = (at) => set.wing.hinges[at].name;
    return [
      h("h3", "Envelopes over the campaign"),
      groups.map((group, at) =>
        at === 0
          ? envelopeFigure(set, group, at, groups.length)
          : h(
              "details.later",
              h(
                "summary",
                `Envelopes of ${name(group[0])}${group.length > 1 ? ` to ${name(group[group.length - 1])}` : ""}`,
              ),
              envelopeFigure(set, group, at, groups.length),
            ),
      ),
      W.sequence(set) || strips(set),
    ];
  }

  const motionHost = h("div");
  function wingParts() {
    const set = W.set(),
      host = W.section("wing");
    if (!set.wing || !(set.wing.bodies || []).length)
      return W.fill(host, h("p.nothing", "The folder contains no scene to draw."));
    const drawn = (set.motions || []).length ? set.motions[0] : null;
    if (drawn) W.fill(motionHost, W.motion(set));
    else if (W.onlyStudies) W.fill(motionHost);
    else W.fill(motionHost, h("p.nothing", "No run of this set can be replayed, so none is shown in motion."));
    const anyRun = W.onlyStudies || !drawn ? null : W.anyRun(set);
    W.fill(
      host,
      motionHost,
      anyRun,
      h(
        "div.stills",
        P.still(set.wing, P.stowed(set.wing), "Stowed", "The wing stowed, drawn to scale."),
        P.still(set.wing, P.deployed(set.wing), "Deployed", "The wing deployed, drawn to scale."),
      ),
      W.onlyStudies ? null : envelopeParts(set),
    );
  }
  W.wing = wingParts;
  W.on("motion", function () {
    const focused = document.activeElement && document.activeElement.classList.contains("choice");
    W.player.time = 0;
    W.fill(motionHost, W.motion(W.set()));
    if (focused) motionHost.querySelector('.choice[aria-pressed="true"]').focus();
  });
})();
