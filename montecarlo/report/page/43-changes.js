// By which changes of its inputs a failed requirement would pass: a first-order estimate from the runs.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, number, format: F } = W;

  // A dispersion in plain words with its name as tooltip; the name itself where the data have no words.
  W.wordsOfDraw = function (set, draw) {
    const all = (set.inputs || {}).dispersions || [],
      { words } = all.find((one) => one.draw === draw) || {};
    if (!words) return draw;
    return all.filter((one) => one.words === words).length > 1 ? `${words} (${draw})` : words;
  };
  W.drawInWords = (set, draw) => h("span", { title: draw }, W.wordsOfDraw(set, draw));

  const three = (value) => F.number(value, 3);
  const times = (value) => (Math.abs(value) < 0.1 ? F.number(value, 2) : F.fixed(value, 2)); // a first-order factor
  const range = (low, high, text) => (W.isNumber(low) && W.isNumber(high) ? `${text(low)} – ${text(high)}` : F.none);
  // A change of an input: a factor, or its mean before and after in its unit.
  function texts(one) {
    const { factor, unit } = F.shown(one.unit),
      at = (shift) => (one.now + shift) * factor;
    return one.scaled
      ? {
          by: `× ${times(one.change)}`,
          bounds: `× ${range(one.lower, one.upper, times)}`,
          drawn: `× ${range(one.least, one.most, times)}`,
        }
      : {
          by: `${three(at(0))} → ${three(at(one.change))} ${unit}`.trim(),
          bounds: range(at(one.lower), at(one.upper), three),
          drawn: range(at(one.least), at(one.most), three),
        };
  }
  // The nominal value before and after a factor, "0.6 → 0.23 N·m·s/rad", where all inputs have the same one with a unit.
  function nominals(set, one) {
    const inputs = ((set.inputs || {}).dispersions || []).filter((each) => one.draws.includes(each.draw)),
      [{ nominal, nominal_unit: unit, paths = [] } = {}] = inputs;
    const alike = inputs.every((each) => each.nominal === nominal && (each.paths || []).length === 1);
    if (!one.scaled || !unit || !W.isNumber(nominal) || !alike || paths.length !== 1) return null;
    return h("small.faint", ` ${F.given(nominal)} → ${F.number(nominal * one.change, 2)} ${F.unit(unit)}`);
  }
  const had = (one, value) => (one.scaled ? `× ${times(value)}` : three(value * F.shown(one.unit).factor));

  // A study of `margin` in this report answers better.
  function studied(set) {
    const found = W.studySets.find((one) => one.margin && one.campaign === set.campaign && (one.margin.window || []).some(W.isNumber));
    if (!found) return null;
    const [low, high] = found.margin.window;
    return h(
      "p.needed",
      `All requirements pass with the inputs of ${found.label} scaled ${W.isNumber(low) ? `from ${F.number(low, 4)}` : "below"} ${W.isNumber(high) ? `to ${F.number(high, 4)}` : "upwards"}: `,
      h("a", { href: "#why" }, "margin window"),
      ".",
    );
  }
  function aim(one, set, limited) {
    if (!limited || !W.isNumber(one.margin)) return limited ? "Of the runs that deploy: " : "";
    const by = W.verdicts.marginText({ ...one, margin: -one.margin }, set).replace("+", "");
    return `To pass, the confidence bound (${W.verdicts.guaranteed(one, set)}) must ${one.upper ? "fall" : "rise"} by ${by}. `;
  }
  function table(one, set, block, limited) {
    const level = `${F.given(100 * set.confidence)} % bounds`,
      beyond = block.levers.some((lever) => lever.beyond);
    const rows = block.levers.map(function (lever) {
      const text = texts(lever);
      return [
        h("span", { title: lever.draws.join(", ") }, lever.words, nominals(set, lever)),
        h("b.nowrap", text.by),
        h("span.nowrap", text.bounds),
        h("span.nowrap", text.drawn, lever.beyond ? h("span.beyond", { title: "beyond the values drawn" }, " †") : null),
        ...(limited ? [] : [`${had(lever, lever.of_broken)} / ${had(lever, lever.of_others)}`]),
      ];
    });
    const heads = ["Change of", number("By"), number(level), number("Drawn"), ...(limited ? [] : [number("Not deployed / deployed had")])];
    return [
      W.table(`What would make ${one.name || F.nameOf(one.output)} pass`, heads, rows, { class: "needed-table", stacks: true }),
      h(
        "p.note",
        `By a linear fit of ${F.runs(block.runs)}${W.isNumber(block.explained) && limited ? `, which explains ${F.share(block.explained, 0)} of the spread` : ""}. ${block.levers.some((lever) => lever.scaled) ? "× multiplies the present value. " : ""}`,
        beyond ? "† Beyond the values drawn: ask margin. " : null,
        h("a", { href: "#why" }, "More causes"),
        ".",
      ),
    ];
  }
  // Why there is no estimate.
  function unknown(one, set, block, limited) {
    const draws = ((set.inputs || {}).dispersions || []).length;
    if (!limited && one.not_deployed === set.runs) return "No run deploys: these runs do not show what would change it.";
    if (block.runs && limited && block.explained < 0.25)
      return `These runs do not show what would change it: a linear fit explains ${F.share(block.explained, 0)} of the spread. Ask margin.`;
    return block.runs
      ? "No dispersed input alone is seen to do it within a factor of 5."
      : `Too few runs to estimate what would change it: ${F.counted(draws, "dispersion")}, so at least ${F.runs(draws + 11)} with a value.`;
  }
  W.needed = function (one, set, kind) {
    const block = (one.changes || []).find((each) => each.for === kind);
    if (!block) return null;
    const study = studied(set),
      limited = kind === "limit";
    if (study) return study;
    if (!block.levers.length) return h("p.needed", unknown(one, set, block, limited));
    const { command } = block.levers.find((lever) => lever.command) || {};
    return h(
      "div.needed",
      h("p", aim(one, set, limited), block.levers.length > 1 ? "Any one of these changes would do, by a first estimate:" : "This change would do, by a first estimate:"),
      table(one, set, block, limited),
      command ? [h("p", `To confirm ${block.levers.length > 1 && block.levers[0].command ? "the first " : ""}with new runs, against all requirements:`), W.command(command, "command that confirms the change")] : null,
    );
  };
})();
