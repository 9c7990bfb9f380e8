// The modes' section: frequencies, damping ratios, and the shapes of the deployed wing, which swing on request.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F, marks: M, pose: P } = W;
  const SHARE = 0.07; // of the wing's span: the furthest that a point is drawn off rest. Heuristic; shapes are linear
  const LARGEST = 0.4; // rad: the largest angle drawn
  const SECONDS = 2; // a period on the page, whatever the frequency

  // The pose at a phase: angles, and a free base's motion, off rest by an amplitude.
  function poseOf(modes, mode, amplitude) {
    const angles = modes.rest.map((angle, at) => angle + amplitude * mode.shape[at]);
    const base = mode.base && {
      x: amplitude * mode.base.x,
      y: amplitude * mode.base.y,
      angle: ((modes.wing.base && modes.wing.base.angle) || 0) + amplitude * mode.base.angle,
    };
    return { angles, base: base || undefined };
  }
  // How far the furthest point of an outline is off rest at an amplitude, m.
  function reach(modes, mode, amplitude) {
    const points = (size) => {
      const pose = poseOf(modes, mode, size);
      return P.outlines(modes.wing, P.frames(modes.wing, pose.angles, pose.base)).flat();
    };
    const rest = points(0),
      off = points(amplitude);
    return d3.max(rest, (point, at) => Math.hypot(off[at][0] - point[0], off[at][1] - point[1]));
  }
  // The amplitude at which the furthest point goes SHARE of the span off rest.
  function amplitudeOf(modes, mode) {
    const small = 1e-4,
      span = modes.wing.scale || 1;
    return Math.min(LARGEST, (SHARE * span) / Math.max(reach(modes, mode, small) / small, 1e-9));
  }

  const name = (mode, at) =>
    `Mode ${at + 1}: ${F.number(mode.frequency, 4)} Hz, damping ratio ${F.number(mode.damping_ratio, 3)}`;
  const shown = (radians) => radians * F.shown("rad").factor;

  // The wing at rest (pale) and at both ends of the swing. `phase` is null for these; while it swings a number.
  function figureOf(modes, mode, at, player) {
    const amplitude = amplitudeOf(modes, mode),
      ends = [-1, 1].map((side) => poseOf(modes, mode, side * amplitude)),
      rest = poseOf(modes, mode, 0);
    return W.figure({
      title: name(mode, at),
      class: "mode",
      printed: 300,
      note: `Enlarged: the wing's furthest point is drawn ${F.number(reach(modes, mode, amplitude), 2)} m off rest, the hinge that turns most ${F.number(shown(amplitude * (d3.max(mode.shape, Math.abs) || 0)), 2)} ${F.shown("rad").unit}.`,
      description: `The deployed wing to scale at both ends of its swing in mode ${at + 1}, enlarged; pale: at rest.`,
      table: () => ({
        columns: ["hinge", `rest ${F.shown("rad").unit}`, "shape"],
        rows: modes.wing.hinges.map((hinge, k) => [hinge.name, shown(modes.rest[k]), mode.shape[k]]),
      }),
      draw: function (svg, width) {
        const scale = P.scale(P.bounds(modes.wing, [rest, ...ends]), width, 170, 4);
        P.draw(M.put(svg, "g.pose", { opacity: 0.25 }), modes.wing, scale, rest);
        const groups = ends.map((pose) => {
          const group = M.put(svg, "g.pose", { opacity: 0.85 });
          P.draw(group, modes.wing, scale, pose);
          return group;
        });
        player.add(at, function (phase) {
          groups[0].attr("visibility", phase === null ? null : "hidden");
          P.draw(groups[1], modes.wing, scale, phase === null ? ends[1] : poseOf(modes, mode, amplitude * Math.sin(phase)));
        });
        P.bar(svg, scale, 6, scale.height + 20);
        return scale.height + 30;
      },
    });
  }

  // Moves all pictures at once while it plays.
  function makePlayer() {
    const drawings = new Map();
    let playing = false;
    const show = (phase) => drawings.forEach((draw) => draw(phase));
    function frame(now) {
      if (!playing || !button.isConnected) return;
      show((2 * Math.PI * (now / 1000)) / SECONDS);
      requestAnimationFrame(frame);
    }
    const button = h(
      "button",
      {
        "aria-pressed": "false",
        onclick: function () {
          playing = !playing;
          button.setAttribute("aria-pressed", String(playing));
          button.textContent = playing ? "Stop" : "Swing";
          if (playing) requestAnimationFrame(frame);
          else show(null);
        },
      },
      "Swing",
    );
    return { button, add: (at, draw) => drawings.set(at, draw) };
  }

  W.modes = function () {
    const set = W.set(),
      modes = set && set.modes,
      section = document.getElementById("modes");
    section.hidden = !modes || !modes.modes.length;
    if (section.hidden) return;
    const player = makePlayer();
    W.fill(
      W.section("modes"),
      h(
        "p",
        `Small vibrations of the deployed nominal wing${W.sets.length > 1 ? ` of ${set.label}` : ""} with all latches engaged, without Coulomb friction, backlash and air. `,
        `The pictures move once in ${SECONDS} seconds, whatever the mode's frequency. A mode has a shape and no size of its own.`,
      ),
      (modes.notes || []).map((note) => h("p.note", `${note}.`)),
      h("p.controls", player.button),
      h(
        "div.stills",
        modes.modes.map((mode, at) => figureOf(modes, mode, at, player)),
      ),
    );
  };
})();
