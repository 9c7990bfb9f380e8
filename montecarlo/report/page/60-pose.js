// The positions of the wing's bodies from its hinge angles, and their drawing to scale.
(function () {
  "use strict";
  const W = window.wingspread;
  const { marks: M } = W;
  const P = (W.pose = {});

  const turned = ([x, y], angle) => [
    x * Math.cos(angle) - y * Math.sin(angle),
    x * Math.sin(angle) + y * Math.cos(angle),
  ];
  const plus = (a, b) => [a[0] + b[0], a[1] + b[1]];

  // The frames of all bodies: a body's joint is a point of its parent and, as `inner`, of the body itself.
  P.frames = function (wing, angles, base) {
    const root = base
        ? { origin: [base.x, base.y], angle: base.angle }
        : { origin: [0, 0], angle: (wing.base && wing.base.angle) || 0 },
      ofHinge = [];
    return wing.bodies.map(function (body) {
      if (body.hinge < 0) return root;
      const parent = ofHinge[wing.hinges[body.hinge].parent] || root,
        angle = parent.angle + angles[body.hinge],
        joint = plus(parent.origin, turned(body.joint_in_parent, parent.angle)),
        [x, y] = turned(body.inner, angle);
      return (ofHinge[body.hinge] = { origin: plus(joint, [-x, -y]), angle, joint });
    });
  };
  P.outlines = (wing, frames) =>
    wing.bodies.map((body, at) =>
      body.outline.map((point) => plus(frames[at].origin, turned(point, frames[at].angle))),
    );

  // The state at a time: angles by the Hermite cubic through both samples' angles and rates; rates, moments and base linear.
  P.at = function (motion, time) {
    const t = motion.t,
      high = Math.min(t.length - 1, Math.max(1, d3.bisectRight(t, time))),
      low = Math.max(0, high - 1);
    const step = t[high] - t[low] || 1,
      u = Math.max(0, Math.min(1, (time - t[low]) / step));
    const straight = (row) =>
      row && W.isNumber(row[low]) && W.isNumber(row[high])
        ? row[low] + u * (row[high] - row[low])
        : row
          ? row[low]
          : null;
    const cubic = function (row, slope) {
      if (!slope || !W.isNumber(slope[low]) || !W.isNumber(slope[high])) return straight(row);
      const a = u * u * (3 - 2 * u),
        b = u * (1 - u) * (1 - u) * step,
        c = u * u * (u - 1) * step;
      return row[low] * (1 - a) + row[high] * a + b * slope[low] + c * slope[high];
    };
    const base = motion.base
      ? { x: straight(motion.base.x), y: straight(motion.base.y), angle: straight(motion.base.angle) }
      : null;
    return {
      angles: motion.angles.map((row, at) => cubic(row, motion.rates && motion.rates[at])),
      rates: (motion.rates || []).map(straight),
      moments: (motion.moments || []).map(straight),
      base,
    };
  };
  // What a hinge has done up to a time: whether its latch holds, and its last event in words.
  P.state = function (wing, motion, at, time) {
    const hinge = wing.hinges[at],
      seconds = (event) => `${W.format.fixed(event.time, 3)} s`;
    const events = [...(motion.latches || []).map((one) => ({ ...one, kind: "latched" })), ...(motion.events || [])]
      .filter((one) => one.hinge === at)
      .sort((a, b) => a.time - b.time);
    const never = events.some((one) => one.kind === "latched") ? "" : ", never latches",
      last = events.filter((one) => one.time <= time).pop();
    if (!last && hinge.held) return { text: events.some((one) => one.kind === "released") ? "held" : "held, never released" };
    if (hinge.latch === false) return { text: last ? `released at ${seconds(last)}` : "has no latch" };
    if (!last) return { text: `open${never}` };
    const words = {
      latched: `latched at ${seconds(last)}`,
      released: `released at ${seconds(last)}${never}`,
      missed: `passed its latch too fast at ${seconds(last)}`,
      let_go: `latch let go at ${seconds(last)}`,
    };
    return { latched: last.kind === "latched", text: words[last.kind] };
  };
  P.stowed = (wing) => wing.hinges.map((hinge) => hinge.stowed);
  P.deployed = (wing) => wing.hinges.map((hinge) => (W.isNumber(hinge.latched) ? hinge.latched : 0));

  // The box around all poses [{ angles, base }], with a margin.
  P.bounds = function (wing, poses) {
    const points = poses.flatMap((pose) => P.outlines(wing, P.frames(wing, pose.angles, pose.base)).flat());
    const [left, right] = d3.extent(points, (point) => point[0]),
      [bottom, top] = d3.extent(points, (point) => point[1]);
    const room = 0.04 * Math.max(right - left, top - bottom, 1e-9);
    return { left: left - room, right: right + room, bottom: bottom - room, top: top + room };
  };
  // Metres to pixels, the same in both directions, into a box of this width and at most this height.
  P.scale = function (bounds, width, tallest, top = 0) {
    const wide = bounds.right - bounds.left,
      tall = bounds.top - bounds.bottom,
      factor = Math.min(width / wide, tallest / tall);
    const shift = (width - wide * factor) / 2;
    return {
      x: (metres) => shift + (metres - bounds.left) * factor,
      y: (metres) => top + (bounds.top - metres) * factor,
      factor,
      height: tall * factor,
    };
  };

  // A pose as a group of polygons and hinges; `open` hinges are rings, latched ones are filled.
  P.draw = function (group, wing, scale, pose, latched) {
    const frames = P.frames(wing, pose.angles, pose.base),
      outlines = P.outlines(wing, frames);
    const path = (points, closed) =>
      "M" +
      points.map((point) => `${scale.x(point[0]).toFixed(2)},${scale.y(point[1]).toFixed(2)}`).join("L") +
      (closed ? "Z" : "");
    const bodies = group.selectAll("path").data(outlines);
    bodies
      .enter()
      .append("path")
      .attr("class", (_, at) => (wing.bodies[at].hinge < 0 ? "base" : "body"))
      .merge(bodies)
      .attr("d", (points, at) => path(points, wing.bodies[at].closed));
    if (!latched) return;
    const joints = frames.filter((frame) => frame.joint),
      rings = group.selectAll("circle").data(joints);
    const places = wing.bodies.filter((body) => body.hinge >= 0).map((body) => body.hinge);
    rings
      .enter()
      .append("circle")
      .attr("r", wing.hinges.length > 12 ? 2.5 : 4)
      .merge(rings)
      .attr("class", (_, at) => (latched(places[at]) ? "hinge latched" : "hinge"))
      .attr("cx", (frame) => scale.x(frame.joint[0]))
      .attr("cy", (frame) => scale.y(frame.joint[1]));
  };

  // A scale bar of a round length, at most 90 px.
  P.bar = function (svg, scale, x, y) {
    const wanted = 90 / scale.factor,
      size = 10 ** Math.floor(Math.log10(wanted)),
      length = [5, 2, 1].map((one) => one * size).find((one) => one <= wanted) || size;
    const group = M.put(svg, "g.bar-of-length", { transform: `translate(${x},${y})` });
    M.put(group, "path", { d: `M0,-4V0H${length * scale.factor}V-4` });
    M.put(group, "text", { x: length * scale.factor + 6, dy: "0.1em", text: `${W.format.given(length)} m` });
  };

  // Nine poses from the start to the last latch in one picture.
  P.stroboscope = function (wing, motion, label) {
    const end = Math.max(0, ...(motion.latches || []).map((latch) => latch.time)) || motion.t[motion.t.length - 1];
    const times = d3.range(0, 9).map((k) => (end * k) / 8);
    return W.figure({
      title: `Stroboscope: ${label}`,
      class: "strobe",
      note: `To scale, every ${W.format.number(end / 8, 3)} s from 0 to ${W.format.number(end, 4)} s (the last latch, or the end of the run); later poses are darker.`,
      description: () =>
        `The wing drawn to scale at ${times.length} instants from stowed to ${W.format.number(end, 3)} s.`,
      table: () => ({
        columns: ["time s", ...wing.hinges.map((hinge) => `${hinge.name} ${W.format.shown("rad").unit}`)],
        rows: times.map((time) => [time, ...P.at(motion, time).angles.map((angle) => angle * W.format.shown("rad").factor)]),
      }),
      draw: function (svg, width) {
        const poses = times.map((time) => P.at(motion, time)),
          scale = P.scale(P.bounds(wing, poses), width, Math.max(170, Math.min(400, 0.4 * width)), 4);
        poses.forEach(function (pose, at) {
          const share = at / (poses.length - 1);
          P.draw(
            M.put(svg, "g.pose", { opacity: 0.18 + 0.82 * share * share }),
            wing,
            scale,
            pose,
            at === poses.length - 1 ? (hinge) => P.state(wing, motion, hinge, end).latched : null,
          );
        });
        P.bar(svg, scale, 6, scale.height + 20);
        return scale.height + 30;
      },
    });
  };
  P.still = function (wing, angles, title, description) {
    return W.figure({
      title,
      class: "still",
      printed: 300,
      description,
      table: () => ({
        columns: ["hinge", `angle ${W.format.shown("rad").unit}`],
        rows: wing.hinges.map((hinge, at) => [hinge.name, angles[at] * W.format.shown("rad").factor]),
      }),
      draw: function (svg, width) {
        const scale = P.scale(P.bounds(wing, [{ angles }]), width, 170, 4),
          group = M.put(svg, "g.pose");
        P.draw(group, wing, scale, { angles }, () => title === "Deployed");
        P.bar(svg, scale, 6, scale.height + 20);
        return scale.height + 30;
      },
    });
  };
})();
