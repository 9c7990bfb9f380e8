// The player: time, speed and the listeners that draw. Pictures may be redrawn at any width while it plays.
(function () {
  "use strict";
  const W = window.wingspread;
  const calm = () => window.matchMedia("(prefers-reduced-motion: reduce)").matches;

  const player = (W.player = { time: 0, playing: false, speed: 1, quantity: "moments", span: "latches", motion: null });
  const listeners = [];

  const lastTime = () => player.motion.t[player.motion.t.length - 1];
  // The displayed interval of time: the whole run, or the latches with a margin on both sides.
  function interval() {
    const { motion } = player,
      whole = d3.extent(motion.t),
      latches = d3.extent(motion.latches || [], (latch) => latch.time);
    if (player.span === "whole" || latches[0] === undefined) return whole;
    const room = Math.max(0.06 * latches[1], 0.25 * (latches[1] - latches[0]));
    return [Math.max(whole[0], latches[0] - room), Math.min(whole[1], latches[1] + 5 * room)];
  }
  // Where play stops: at the end of the displayed interval, or of the run for a time beyond it.
  const stopTime = () => (player.time <= interval()[1] ? interval()[1] : lastTime());

  function seek(time) {
    const end = lastTime();
    player.time = Math.max(player.motion.t[0], Math.min(end, time));
    listeners.forEach((listener) => listener());
  }
  let last = null,
    sinceStep = 0;
  function frame(now) {
    if (!player.playing) return;
    const passed = last === null ? 0 : (now - last) / 1000;
    last = now;
    const end = stopTime();
    if (calm()) {
      // for readers who prefer reduced motion: two stills a second, each a twentieth of the run after the previous one
      sinceStep += passed;
      if (sinceStep > 0.5) {
        sinceStep = 0;
        seek(Math.min(end, player.time + end / 20));
      }
    } else seek(Math.min(end, player.time + passed * player.speed));
    if (player.time >= end) play(false);
    else requestAnimationFrame(frame);
  }
  function play(on) {
    if (on && (player.time >= lastTime() || player.time === interval()[1])) seek(player.motion.t[0]);
    player.playing = on;
    last = null;
    if (on) requestAnimationFrame(frame);
    listeners.forEach((listener) => listener());
  }

  function byKeys(event) {
    const end = stopTime(),
      inside = event.target.matches("input, select, button, summary, .scroll");
    const actions = {
      " ": () => play(!player.playing),
      k: () => play(!player.playing),
      ArrowRight: () => seek(player.time + end / 200),
      ArrowLeft: () => seek(player.time - end / 200),
      Home: () => seek(0),
      End: () => seek(lastTime()),
    };
    if (!actions[event.key] || (inside && event.key !== "k")) return;
    actions[event.key]();
    event.preventDefault();
  }

  // Loads another run: stops, and removes the listeners of the previous run.
  function load(motion) {
    player.playing = false;
    listeners.length = 0;
    player.motion = motion;
    player.time = Math.max(motion.t[0], Math.min(player.time, motion.t[motion.t.length - 1]));
  }
  Object.assign(player, { seek, play, byKeys, load, interval, stopTime, listen: (listener) => listeners.push(listener) });
})();
