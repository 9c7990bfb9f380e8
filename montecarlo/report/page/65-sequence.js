// The sequence of releases and captures as a time line: when holds let go, when latches engage, when they miss or let go.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F, marks: M } = W;
  // The events of a hinge: key of the data, words, colour.
  const KINDS = [
    ["released", "hold lets go", "var(--c1)"],
    ["missed", "passes too fast for its latch", "var(--c3)"],
    ["latched", "latch engages", "var(--c2)"],
    ["let_go", "latch lets go", "var(--c5)"],
  ];
  const LANE = 17; // px
  const MEDIAN = 3; // place among the quantiles: 0, 5, 25, 50, 75, 95, 100 %
  const of = (set) => (set.envelopes || {}).sequence || null;
  // Folders may have the same hinges in another order.
  const placeOf = (set, name) => set.wing.hinges.findIndex((hinge) => hinge.name === name);
  const at = (set, name) => of(set)[placeOf(set, name)];
  const seconds = (time, digits = 4) => `${F.number(time, digits)} s`;

  // The nominal release in words: "0.2 s after left_mid latches".
  function releaseOf(set, hinge) {
    const { wing } = set,
      { release } = of(set)[hinge],
      path = `hinges.${wing.hinges[hinge].name}.release.time`,
      drawn = ((set.inputs || {}).dispersions || []).find((one) => one.apply === "set" && (one.paths || []).includes(path));
    const other = release.after >= 0 ? wing.hinges[release.after].name : "",
      { factor, unit } = F.shown("rad");
    if (release.fails) return "never";
    const event = {
      time: drawn ? `at ${drawn.draw}` : `at ${F.given(release.time)} s`,
      latched: `${other} latches`,
      released: `the hold of ${other} lets go`,
      passed: `${other} has turned by ${F.given(Number((release.angle * factor).toPrecision(6)))} ${unit}`,
    }[release.event];
    if (release.event === "time") return release.delay ? `${event}, and ${F.given(release.delay)} s` : event;
    return release.delay ? `${F.given(release.delay)} s after ${event}` : `when ${event}`;
  }

  // The lanes of each hinge, hinges by the median time of their first event: [{ hinge, kinds: [[key, words, colour, event]] }].
  function lanesOf(set) {
    const rows = of(set).map((one, hinge) => ({
      hinge,
      name: set.wing.hinges[hinge].name,
      kinds: KINDS.map((kind) => [...kind, one[kind[0]]]).filter(
        ([key, , , event]) => event.count || (key === "released" && one.release),
      ),
    }));
    const first = (row) => d3.min(row.kinds, ([, , , event]) => event.times[MEDIAN]) ?? Infinity;
    return rows.filter((row) => row.kinds.length).sort((a, b) => first(a) - first(b));
  }

  function timeLine(set) {
    const rows = lanesOf(set),
      runs = set.envelopes.runs,
      used = KINDS.filter(([key]) => rows.some((row) => row.kinds.some((kind) => kind[0] === key)));
    const words = ([, text, , event]) =>
      event.count
        ? `${text} at ${seconds(event.times[MEDIAN])} (${seconds(event.times[0])} to ${seconds(event.times[6])}) in ${F.count(event.runs)} of ${F.runs(runs)}`
        : `${text} in none of ${F.runs(runs)}`;
    return W.figure({
      title: `Releases and captures${W.sets.length > 1 ? `: ${set.label}` : ""}`,
      class: "sequence",
      printed: 860,
      note: `Over ${F.runs(runs)} spread evenly through the campaign. Upright mark: median; dark: 25 % to 75 %; pale: 5 % to 95 %; line: first to last. At the right: runs in which it happens.`,
      description: () => rows.map((row) => `${row.name}: ${row.kinds.map(words).join(", ")}`).join("; "),
      table: () => ({
        columns: [
          "hinge",
          "event",
          "runs",
          "events",
          "first s",
          "5 % s",
          "25 % s",
          "median s",
          "75 % s",
          "95 % s",
          "last s",
        ],
        rows: rows.flatMap((row) =>
          row.kinds.map(([, text, , event]) => [
            row.name,
            text,
            event.runs,
            event.count,
            ...d3.range(7).map((at) => event.times[at] ?? null),
          ]),
        ),
      }),
      draw: function (svg, width) {
        const top = M.legend(
          svg,
          used.map(([, text, colour]) => ({ text, fill: colour })),
          width,
        );
        const lanes = d3.sum(rows, (row) => row.kinds.length),
          gap = 8,
          left = M.labelRoom(
            width,
            0.3,
            rows.map((row) => row.name),
          );
        const box = { left, right: width - 84, top: top + 6, bottom: top + 6 + lanes * LANE + rows.length * gap },
          x = M.linear(
            [0, ...rows.flatMap((row) => row.kinds.flatMap(([, , , event]) => event.times))],
            [box.left, box.right],
          );
        M.axes(svg, box, x, null, { xText: "time (s)" });
        let y = box.top;
        for (const row of rows) {
          M.rowLabel(svg, row.name, left, y + (row.kinds.length * LANE) / 2);
          for (const [key, text, colour, event] of row.kinds) {
            const middle = y + LANE / 2,
              bar = function (from, to, opacity) {
                const [left, right] = [from, to].map((at) => x(event.times[at])),
                  wide = Math.max(6, right - left); // wider than the median's mark
                M.put(svg, "rect.span", {
                  x: (left + right - wide) / 2,
                  width: wide,
                  y: middle - 5,
                  height: 10,
                  style: { fill: colour, "fill-opacity": opacity },
                  title: `${row.name} ${words([key, text, colour, event])}`,
                });
              };
            if (event.count) {
              M.put(svg, "line.reach", {
                x1: x(event.times[0]),
                x2: x(event.times[6]),
                y1: middle,
                y2: middle,
                style: { stroke: colour },
              });
              bar(1, 5, 0.35);
              bar(2, 4, 0.8);
              M.upright(svg, "line.middle", x(event.times[MEDIAN]), { top: middle - 7, bottom: middle + 7 });
            }
            M.put(svg, "text.faint-text", {
              x: width - 78,
              y: middle,
              dy: "0.35em",
              text: event.count ? `${F.count(event.runs)} of ${F.count(runs)}` : "in none",
            });
            y += LANE;
          }
          y += gap;
        }
        return box.bottom + 40;
      },
    });
  }

  // The hold of a hinge in words, by set where the sets differ.
  function holds(sets, name) {
    const groups = [...d3.group(sets, (one) => (at(one, name).release ? releaseOf(one, placeOf(one, name)) : "no hold"))];
    return groups.map(([words, own]) => h("small", groups.length > 1 ? `${W.verdicts.listed(own.map((one) => one.label))}: ${words}` : words));
  }
  // Median and range of each event, the sets with the same hinges side by side.
  function table(set) {
    const namesOf = (one) => one.wing.hinges.map((hinge) => hinge.name),
      sets = W.sets.filter((one) => of(one) && String(namesOf(one).sort()) === String(namesOf(set).sort())),
      names = [...new Set([set, ...sets].flatMap((one) => lanesOf(one).map((row) => row.name)))];
    const happened = (name, key) => sets.some((one) => at(one, name)[key].count || (key === "released" && at(one, name).release));
    const rows = names.flatMap((name) =>
      KINDS.filter(([key]) => happened(name, key)).map(
        ([key, text]) => [
          name,
          key === "released" ? h("span.double", text, holds(sets, name)) : text,
          ...sets.flatMap(function (one) {
            const event = at(one, name)[key],
              runs = one.envelopes.runs,
              often = `${F.count(event.runs)} of ${F.runs(runs)}${event.count > event.runs ? `, ${F.count(event.count)} times` : ""}`;
            const spread = event.count ? (event.times[6] - event.times[0]) / 10 : 0,
              time = (at) => (spread ? F.sized(event.times[at], spread) : F.given(event.times[at]));
            const [median, range] = event.count
              ? [time(MEDIAN), spread ? `${time(0)} … ${time(6)}` : "always"]
              : [F.none, F.none];
            return sets.length > 1
              ? h("span.double", event.count ? `${median} (${range})` : F.none, h("small", often))
              : [median, range, often];
          }),
        ],
      ),
    );
    const columns =
      sets.length > 1
        ? sets.map((one) => number(one.label, "s"))
        : [number("Median", "s"), number("First … last", "s"), number("Runs")];
    return W.table("Median time of each event, first and last", ["Hinge", "Event", ...columns], rows, {
      class: "sequence-table",
      showCaption: true,
    });
  }

  // Null for a wing without holds whose latches cannot miss: its sequence is in the latch times.
  W.sequence = function (set) {
    if (!of(set) || !lanesOf(set).length) return null;
    return [h("h3", "Sequence of releases and captures"), timeLine(set), table(set)];
  };
})();
