// Any run of the campaign, and the wing with other springs, friction, dampers and latches: computed in the page by the
// program's own kernel, which is WebAssembly. A page without the kernel has no such part.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;
  const element = document.getElementById("kernel");
  const STATUSES = ["deployed", "stalled", "timed_out", "invalid", "failed"]; // core's enumeration, in its order
  const PARTS = ["spring", "friction", "damper", "latch"];

  let module = null;
  async function compiled() {
    const bytes = Uint8Array.from(atob(element.textContent.trim()), (letter) => letter.charCodeAt(0)),
      stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return WebAssembly.compile(await new Response(stream).arrayBuffer());
  }
  // The system calls that the C library names; the kernel makes none of them.
  function imports(of) {
    const all = {};
    for (const one of WebAssembly.Module.imports(of))
      (all[one.module] = all[one.module] || {})[one.name] = () => {
        if (one.name === "proc_exit") throw new Error("the kernel ended");
        return 0;
      };
    return all;
  }

  // The kernel with a set's campaign: { draws, draw(run), median(), run(changes) }.
  async function kernelOf(set) {
    module = module || compiled();
    const { exports: wasm } = await WebAssembly.instantiate(await module, imports(await module));
    if (wasm._initialize) wasm._initialize();
    const doubles = (place, count) => new Float64Array(wasm.memory.buffer, place, count);
    const fill = (values) => doubles(wasm.input(values.length), values.length).set(values);
    fill(Float64Array.from(set.kernel.numbers, Number));
    wasm.open();
    const draws = () => doubles(wasm.draws(), wasm.draw_count());
    return {
      draws: () => [...draws()],
      draw: (run) => wasm.draw(run),
      median: () => wasm.median(),
      // changes: [[place, factor], …]
      run: function (changes) {
        fill(Float64Array.from(changes.flat()));
        wasm.run(changes.length);
        const reason = new Uint8Array(wasm.memory.buffer, wasm.reason(), wasm.reason_count());
        return outcome(
          set.wing.hinges.length,
          doubles(wasm.result(), wasm.result_count()),
          doubles(wasm.samples(), wasm.sample_count()),
          new TextDecoder().decode(reason.slice()),
        );
      },
    };
  }

  // Reads what kernel.cpp writes.
  function outcome(hinges, result, samples, reason) {
    let next = 4;
    const latches = d3.range(result[3]).map(function () {
      const latch = { hinge: result[next], time: result[next + 1], rates: [...result.slice(next + 2, next + 2 + hinges)] };
      next += 2 + hinges;
      return latch;
    });
    const each = d3.range(hinges).map(function (hinge) {
      const [peak_moment, time, peak_force, overtravel, hold_moment, final_angle, motor_energy] = result.slice(
        next + 7 * hinge,
        next + 7 * hinge + 7,
      );
      return { hinge, peak_moment, time, peak_force, overtravel, hold_moment, final_angle, motor_energy };
    });
    next += 7 * hinges;
    const base = { peak_angle: result[next], peak_rate: result[next + 1] };
    next += 2;
    const events = ["released", "missed", "let_go"].flatMap(function (kind) {
      const from = next + 1,
        count = result[next];
      next = from + 2 * count;
      return d3.range(count).map((at) => ({ kind, hinge: result[from + 2 * at], time: result[from + 2 * at + 1] }));
    });
    const width = 1 + 3 * hinges + 3,
      rows = d3.range(samples.length / width).map((row) => samples.slice(row * width, (row + 1) * width)),
      column = (place) => rows.map((row) => row[place]),
      columns = (first) => d3.range(hinges).map((hinge) => column(first + hinge));
    return {
      status: STATUSES[result[0]],
      reason,
      t_end: result[1],
      final: { peak_moment: Boolean(result[2] & 1), peak_force: Boolean(result[2] & 2) },
      latches,
      each,
      base,
      events,
      t: column(0),
      angles: columns(1),
      rates: columns(1 + hinges),
      moments: columns(1 + 2 * hinges),
      moved: { x: column(width - 3), y: column(width - 2), angle: column(width - 1) },
    };
  }

  // An output of an outcome, by the name of its column; null if it did not happen.
  function outputOf(set, output, made) {
    const at = (name) => set.wing.hinges.findIndex((hinge) => hinge.name === name),
      own = (list, hinge) => list.filter((one) => one.hinge === hinge),
      captures = (hinge) => own(made.latches, hinge),
      ended = !["invalid", "failed"].includes(made.status);
    // The engagement that holds at the end of the run.
    const latch = (hinge) =>
      own(made.events, hinge).filter((one) => one.kind === "let_go").length < captures(hinge).length
        ? captures(hinge).pop()
        : null;
    const value = function () {
      if (output.name === "deployment_time")
        return made.status === "deployed" ? d3.max(made.latches, (one) => one.time) : NaN;
      if (output.name.startsWith("base.")) return made.base[output.name.slice(5)];
      const held = latch(at(output.hinge));
      if (output.family === "latch_time") return held ? held.time : NaN;
      if (output.family === "latch_rate") return held ? held.rates[held.hinge] : NaN;
      if (output.family === "captures") return ended ? captures(at(output.hinge)).length : NaN;
      if (output.family === "held") return ended ? Number(Boolean(held)) : NaN;
      const other = output.name.indexOf(".rate_at.");
      if (other > 0) {
        const then = latch(at(output.name.slice(other + 9)));
        return then ? then.rates[at(output.name.slice(0, other))] : NaN;
      }
      const hinge = made.each[at(output.hinge)];
      return hinge ? hinge[output.family] : NaN;
    };
    const found = value();
    return W.isNumber(found) ? found : null;
  }

  function motionOf(set, made, label, why, run, changed) {
    const moving = set.wing.base && set.wing.base.kind !== "fixed";
    return {
      computed: true,
      label,
      why,
      run,
      status: made.status,
      reason: made.reason,
      replay: run === null || changed ? null : `wingspread replay ${W.shellWord(set.folder)} --run ${run}`,
      t: made.t,
      angles: made.angles,
      rates: made.rates,
      moments: made.moments,
      base: moving ? made.moved : null,
      latches: made.latches,
      events: made.events,
      peaks: made.each
        .filter((one) => W.isNumber(one.peak_moment))
        .map((one) => ({ hinge: one.hinge, value: one.peak_moment, time: one.time })),
      force_peaks: made.each
        .filter((one) => W.isNumber(one.peak_force))
        .map((one) => ({ hinge: one.hinge, value: one.peak_force, time: null })),
    };
  }

  // The place and factor of each number that the sliders change.
  function changesOf(set, factors, which) {
    return set.kernel.hinges.flatMap((hinge, at) =>
      which !== "all" && at !== Number(which)
        ? []
        : PARTS.filter((part) => factors[part] !== 1 && W.isNumber(hinge[part])).map((part) => [hinge[part], factors[part]]),
    );
  }

  // Whether a run keeps a limit. A run that does not deploy breaks every requirement. A peak that
  // t_end cut may still rise: above a max, or to a min, which it keeps once it has reached it.
  function verdictOf(one, output, made, value) {
    const size = one.abs ? Math.abs(value) : value;
    if (made.status !== "deployed" || value === null) return "failed";
    const beyond = one.upper ? size > one.limit : size < one.limit,
      cut = made.final[output.family] === false;
    return cut && beyond !== Boolean(one.upper) ? "open" : beyond ? "failed" : "passed";
  }
  // Notes on what the badges cannot judge.
  function judgement(set, made) {
    const all = set.requirements || [],
      notHere = all.filter((one) => one.static_margin || /^mode_\d|\.peak_bending_moment$/.test(one.output));
    return [
      all.length && made.status !== "deployed" ? " It did not deploy, so it breaks every requirement." : "",
      notHere.length ? ` Not computed here: ${W.verdicts.listed(notHere.map((one) => W.verdicts.shortOf(one)))}.` : "",
    ].join("");
  }
  function table(set, made, plain, label) {
    // The kernel's result has no bending moments and no frequencies.
    const known = (output) =>
      /^(deployment_time$|base\.)/.test(output.name) || set.wing.hinges.some((hinge) => hinge.name === output.hinge);
    const shown = set.outputs
      .filter(known)
      .filter((output) => outputOf(set, output, made) !== null || output.count);
    const changed = made !== plain,
      text = (value, output) => (value === null ? "did not happen" : F.value(value, output.unit, F.grain(output)));
    const quantile = (output, first) => {
      const list = output.quantiles || [];
      return list.length ? list[first ? 0 : list.length - 1].value : null;
    };
    const limits = (output, value) =>
      (output.limits || [])
        .map((at) => set.requirements[at])
        .filter((one) => W.isNumber(one.limit))
        .map((one) => [W.badge(verdictOf(one, output, made, value), true), ` ${one.abs ? "|·| " : ""}${one.upper ? "≤" : "≥"} ${F.written(one.limit, output.unit)} `]);
    const levels = (shown.map((output) => output.quantiles || []).find((list) => list.length) || []).map((one) => one.p);
    const columns = [
      "Output",
      "Unit",
      number(label),
      changed && number("with changes"),
      number("Mean of the campaign"),
      number(levels.length ? `${F.level(levels[0])} … ${F.level(levels[levels.length - 1])} of the runs` : "Quantiles"),
      "Limit",
    ];
    const rows = shown.map((output) => [
      F.name(output),
      F.shown(output.unit).unit,
      text(outputOf(set, output, plain), output),
      changed && text(outputOf(set, output, made), output),
      F.value(output.mean, output.unit, F.grain(output)),
      `${F.value(quantile(output, true), output.unit, F.grain(output))} … ${F.value(quantile(output, false), output.unit, F.grain(output))}`,
      h("span", limits(output, outputOf(set, output, made))),
    ]);
    const kept = (list) => list.filter((one) => one !== false);
    return W.table("Outputs of this run beside the campaign's", kept(columns), rows.map(kept), { class: "tall" });
  }
  const drawsTable = (set, draws) =>
    h(
      "details",
      h("summary", `Draws of this run: ${F.count(draws.length)}`),
      W.table(
        "Draws of this run",
        ["Dispersion", number("Value"), number("1 % … 99 %")],
        draws.map(function (value, at) {
          const name = set.kernel.draws[at],
            law = ((set.inputs || {}).dispersions || []).find((one) => one.draw === name);
          return [name, F.number(value, 7), law ? `${F.number(law.low, 4)} … ${F.number(law.high, 4)}` : F.none];
        }),
        { class: "tall" },
      ),
    );

  W.anyRun = function (set) {
    if (!element || !set.kernel || !window.DecompressionStream) return null;
    const factors = Object.fromEntries(PARTS.map((part) => [part, 1]));
    let which = "all",
      run = null,
      unchanged = null, // the outcome without changes
      kernel = null;
    const host = h("div", { "aria-live": "polite" }),
      last = set.shard ? Number.MAX_SAFE_INTEGER : Math.max(set.planned, set.runs) - 1, // a shard's runs begin anywhere
      field = h("input", { type: "number", min: 0, max: last, step: 1, value: 0, "aria-label": "Number of the run" });
    async function show(wanted) {
      run = wanted;
      try {
        kernel = kernel || (await (set.kernelInPage = set.kernelInPage || kernelOf(set)));
        if (run === null) kernel.median();
        else kernel.draw(run);
        if (!unchanged || unchanged.run !== run) unchanged = { run, made: kernel.run([]) };
        const changes = changesOf(set, factors, which),
          plain = unchanged.made,
          made = changes.length ? kernel.run(changes) : plain,
          label = run === null ? "nominal wing" : `run ${run}`;
        const why = changes.length
          ? PARTS.filter((part) => factors[part] !== 1)
              .map((part) => `${part} × ${F.fixed(factors[part], 2)}`)
              .join(", ") + (which === "all" ? ", all hinges" : `, ${set.wing.hinges[which].name}`)
          : "computed in this page";
        W.fill(
          host,
          h("p", h("b", `${label[0].toUpperCase()}${label.slice(1)}`), `: ${made.status.replace("_", " ")}`, made.reason ? `, ${made.reason}` : "", ` · ${why}.`, judgement(set, made)),
          table(set, made, plain, label),
          drawsTable(set, kernel.draws()),
        );
        if (!made.t.length) return; // an invalid wing has no motion: the one before stays
        const others = set.motions.filter((one) => !one.computed);
        set.motions = [...others, motionOf(set, made, changes.length ? `${label}, changed` : label, why, run, changes.length > 0)];
        W.choose("motion", set.motions.length - 1);
      } catch (error) {
        console.error(error);
        W.fill(host, h("p.nothing", `The run could not be computed: ${error.message}.`));
      }
    }
    let waiting = false;
    const later = function () {
      if (waiting) return;
      waiting = true;
      requestAnimationFrame(() => ((waiting = false), show(run)));
    };
    const slider = function (part) {
      const text = h("output", "× 1.00"),
        input = h("input.factor", {
          type: "range",
          min: -1,
          max: 1,
          step: 0.02,
          value: 0,
          "aria-label": `Factor of ${part}`,
          "aria-valuetext": "1.00 times",
          oninput: function () {
            factors[part] = Number((2 ** Number(input.value)).toPrecision(4));
            text.textContent = `× ${F.fixed(factors[part], 2)}`;
            input.setAttribute("aria-valuetext", `${F.fixed(factors[part], 2)} times`);
            later();
          },
        });
      return set.kernel.hinges.some((hinge) => W.isNumber(hinge[part])) ? h("label.slider", h("span", part), input, text) : null;
    };
    const sliders = h("div.sliders", PARTS.map(slider));
    const showTyped = function () {
      const wanted = field.value === "" ? NaN : Number(field.value);
      if (Number.isSafeInteger(wanted) && wanted >= 0 && wanted <= last) return show(wanted);
      W.fill(host, h("p.nothing", `The campaign has the runs 0 to ${F.count(last)}.`));
    };
    const hinge = W.select(
      {
        "aria-label": "Hinge to change",
        onchange: (event) => {
          which = event.target.value;
          later();
        },
      },
      [["all", "all hinges"], ...set.wing.hinges.map((one, at) => [at, one.name])],
      "all",
    );
    const reset = () => {
      for (const input of sliders.querySelectorAll("input")) {
        input.value = 0;
        input.dispatchEvent(new Event("input"));
      }
    };
    return h(
      "div.any-run",
      h("h3", "Any run, any wing"),
      h(
        "p.note",
        "Computed in this page by the program's kernel. The sliders multiply spring torque, friction, damper torque and latch stiffness after the draws have acted.",
      ),
      h(
        "form.controls",
        {
          onsubmit: (event) => {
            event.preventDefault();
            showTyped();
          },
        },
        h("label", h("span", "Run "), field),
        h("button.show-run", { onclick: showTyped }, "Show this run"),
        h("button.show-nominal", { onclick: () => show(null) }, "Nominal wing"),
        h("label", h("span", "Change "), hinge),
        h("button", { onclick: reset }, "Reset factors"),
      ),
      sliders,
      host,
    );
  };
  W.kernel = { of: kernelOf, outputOf };
})();
