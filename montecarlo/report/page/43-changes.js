// By which changes of its inputs a failed requirement would pass: an estimate from the runs, only within the values drawn.
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
  // Bounds, with more decimals than the text has where one digit of their distance needs them.
  function range(low, high, text) {
    if (!W.isNumber(low) || !W.isNumber(high)) return F.none;
    const needed = high > low ? F.decimals(10 * (high - low)) : 0;
    const close = [low, high].some((bound) => (text(bound).split(".")[1] || "").length < needed);
    const shown = close ? (bound) => F.fixed(bound, needed) : text;
    return `${shown(low)} – ${shown(high)}`;
  }
  // The bound nearest to no change. A change that is not known has only this one.
  const nearest = (one) => (W.isNumber(one.lower) && (one.change >= (one.scaled ? 1 : 0) || !W.isNumber(one.upper)) ? one.lower : one.upper);
  // A change of an input: a factor, or its mean before and after in its unit.
  function texts(one) {
    const { factor, unit } = F.shown(one.unit),
      at = (shift) => (one.now + shift) * factor;
    return one.scaled
      ? {
          by: `× ${times(one.change)}`,
          need: `×\u00a0${times(one.change)}`,
          bounds: `× ${range(one.lower, one.upper, times)}`,
          least: `× ${times(nearest(one))}`,
          drawn: `× ${range(one.least, one.most, times)}`,
        }
      : {
          by: `${three(at(0))} → ${three(at(one.change))} ${unit}`.trim(),
          need: `${three(at(one.change))} ${unit}`.trim(),
          bounds: range(at(one.lower), at(one.upper), three),
          least: `${three(at(nearest(one)))} ${unit}`.trim(),
          drawn: range(at(one.least), at(one.most), three),
        };
  }
  // The value before and after a factor, from the median drawn where draws replace the nominal value, "0.6 → 0.23 N·m·s/rad", where all inputs have the same one with a unit.
  function nominals(set, one) {
    const inputs = ((set.inputs || {}).dispersions || []).filter((each) => one.draws.includes(each.draw)),
      start = (each) => (each.apply === "set" ? each.median : each.nominal),
      [{ nominal_unit: unit, paths = [] } = {}] = inputs,
      nominal = start(inputs[0] || {});
    const alike = inputs.every((each) => start(each) === nominal && (each.paths || []).length === 1);
    if (!one.known || !one.scaled || !unit || !W.isNumber(nominal) || !alike || paths.length !== 1) return null;
    return h("small.faint", ` ${inputs[0].apply === "set" ? F.number(nominal, 2) : F.given(nominal)} → ${F.number(nominal * one.change, 2)} ${F.unit(unit)}`);
  }
  const had = (one, value) => (one.scaled ? `× ${times(value)}` : three(value * F.shown(one.unit).factor));

  // A study of `margin` in this report answers better, if it judged every requirement of the set, in its case and with the
  // same limit, and runs of another seed did not contradict it. Both texts of a requirement are by the same function.
  function answers({ margin, campaign }, set) {
    if (!margin || campaign !== set.campaign || margin.why_none || margin.not_confirmed || !(margin.window || []).some(W.isNumber)) return false;
    const judged = new Set((margin.requirements || []).map((one) => one.text)),
      ofCase = set.case && set.case !== "nominal" ? ` · ${set.case}` : "";
    return (set.requirements || []).every((one) => judged.has(one.text + ofCase));
  }
  function studied(set) {
    const found = W.studySets.find((one) => answers(one, set));
    if (!found) return null;
    const [low, high] = found.margin.window.map((edge) => (W.isNumber(edge) ? F.number(edge, 4) : null));
    return h(
      "p.needed",
      `All requirements pass with the inputs of ${found.label} scaled ${low && high ? `from ${low} to ${high}` : low ? `by ${low} and more` : `by ${high} and less`}: `,
      h("a", { href: "#why" }, found.margin.of_springs ? "permissible spring strength" : "permissible scale"),
      ".",
    );
  }
  function aim(one, set, limited) {
    if (!limited || !W.isNumber(one.margin)) return limited ? "Of the runs that deploy: " : "";
    const by = W.verdicts.marginText({ ...one, margin: -one.margin }, set).replace("+", "");
    return `To pass, the one-sided bound (${W.verdicts.guaranteed(one, set)}) must ${one.upper ? "fall" : "rise"} by ${by}. `;
  }

  // The parameters that a lever moves, as "R_root" and "spring.scale".
  function movedBy(set, lever) {
    const all = (set.inputs || {}).dispersions || [];
    return lever.draws
      .flatMap((draw) => (all.find((one) => one.draw === draw) || {}).paths || [])
      .map((path) => /^hinges\.(.+?)\.((?:spring|friction|harness|damper|motor|latch)\..+)$/.exec(path))
      .filter(Boolean)
      .map(([, hinge, quantity]) => ({ hinge, quantity }));
  }
  // A latch's damping makes its hinge's moment jump as it engages. Where the jump is most of the peak moment, the change may
  // only mend the latch law.
  function jumpCaution(set, lever) {
    const hinges = movedBy(set, lever)
      .filter(({ quantity }) => quantity === "latch.damping")
      .map(({ hinge }) => (set.latch_jumps || []).find((one) => one.hinge === hinge))
      .filter(Boolean);
    if (!hinges.length) return null;
    const shares = hinges.map((one) => Math.min(1, one.moment / one.peak)),
      [low, high] = d3.extent(shares).map((share) => F.share(share, 0)),
      names = hinges.length > 3 ? F.counted(hinges.length, "hinge") : W.verdicts.listed(hinges.map((one) => one.hinge));
    return `May be an artefact of the latch law: the jump of damping times rate as the latch engages makes ${low === high ? low : `${low} to ${high}`} of the nominal peak moment of ${names}. Measure the damping, or give “dissipation”.`;
  }
  // The effect of a change on static margins and on the deployment. Static margins count dampers only at a stated rate.
  function torqueCaution(set, lever) {
    const grows = lever.scaled ? lever.change > 1 : lever.change > 0,
      kinds = new Set(movedBy(set, lever).map(({ quantity }) => quantity.split(".")[0]));
    const lowest = W.lowestStaticMargin();
    const lower = `${lowest ? `lower the static margins (lowest now: ${lowest})` : "lower the static margins"} and can keep the wing from deploying.`;
    if (kinds.has("spring") && lever.scaled && !grows) return `Weaker springs ${lower}`;
    if (kinds.has("friction") && grows) return `More friction would ${lower}`;
    if (kinds.has("harness") && grows && lever.scaled) return `A stiffer harness would ${lower}`;
    if (kinds.has("motor") && !grows) return `A slower or weaker motor can ${lower.replace(" and can", " and")}`;
    if (kinds.has("damper") && grows) return "A stronger damper slows the deployment. Static margins count it only at a stated rate.";
    return null;
  }
  const cautions = (set, lever) =>
    [jumpCaution(set, lever), torqueCaution(set, lever)].filter(Boolean).map((text) => h("small.caution", text));

  // The changes of a lever's draws that other sets need, which fail the same requirement.
  function elsewhere(one, set, block, lever) {
    return W.sets
      .filter((other) => other !== set && other.campaign === set.campaign)
      .map((other) => ({
        label: other.label,
        block: (other.requirements || [])
          .filter((each) => W.verdicts.keyOf(each) === W.verdicts.keyOf(one))
          .flatMap((each) => each.changes || [])
          .find((each) => each.for === block.for),
      }))
      .filter((other) => other.block)
      .map((other) => ({
        label: other.label,
        change: ((other.block.needs || []).find((need) => String(need.draws) === String(lever.draws)) || {}).change,
      }));
  }
  // "enough for ambient too (needs × 0.43)", "ambient needs × 0.5", "ambient: not estimated".
  function elsewhereText(lever, others) {
    const still = lever.scaled ? 1 : 0,
      size = (change) => (lever.scaled ? Math.abs(Math.log(change)) : Math.abs(change)),
      enough = ({ change }) => lever.known && (change - still) * (lever.change - still) > 0 && size(change) <= size(lever.change),
      needs = ({ change }) => texts({ ...lever, change }).need;
    return others
      .map((other) =>
        !W.isNumber(other.change)
          ? `${other.label}: not estimated`
          : enough(other)
            ? `enough for ${other.label} too (needs ${needs(other)})`
            : `${other.label} needs ${needs(other)}`,
      )
      .join("; ");
  }
  // The runs drawn beyond the changed mean: the evidence that such wings deploy.
  const drawnThere = (lever) =>
    `${F.runs(lever.beyond_runs)}${lever.beyond_undeployed ? `, ${F.count(lever.beyond_undeployed)} not deployed` : lever.beyond_runs ? ", deployed" : ""}`;
  function table(one, set, block, limited) {
    const level = `${F.given(100 * set.confidence)} % two-sided bounds`,
      unknown = block.levers.some((lever) => !lever.known),
      several = elsewhere(one, set, block, block.levers[0]).length > 0;
    const rows = block.levers.map(function (lever) {
      const text = texts(lever);
      return [
        h("span", { title: lever.draws.join(", ") }, lever.words, nominals(set, lever), cautions(set, lever)),
        lever.known ? h("b.nowrap", text.by) : h("span.nowrap", "not known"),
        h("span.nowrap", lever.known ? text.bounds : `beyond ${text.least}`),
        h("span.nowrap", text.drawn),
        drawnThere(lever),
        ...(limited ? [] : [`${had(lever, lever.of_broken)} / ${had(lever, lever.of_others)}`]),
        ...(several ? [elsewhereText(lever, elsewhere(one, set, block, lever))] : []),
      ];
    });
    const heads = [
      "Change of",
      number("By"),
      number(level),
      number("Drawn"),
      "Drawn beyond it",
      ...(limited ? [] : [number("Not deployed / deployed had")]),
      ...(several ? [`Other ${W.kindOfSets()}s that fail`] : []),
    ];
    return [
      W.table(`Estimated: what would make ${one.name || F.nameOf(one.output)} pass`, heads, rows, { class: "needed-table", stacks: true }),
      h(
        "p.note",
        `An estimate from ${F.runs(block.runs)}${W.isNumber(block.explained) && limited ? `: a linear fit, which explains ${explained(block)} of the spread, and a quadratic along each change` : ""}. The stated change is the far bound. There, by this estimate, a new campaign of as many runs passes with ${F.given(Number((50 * (1 + set.confidence)).toPrecision(6)))} % probability. ${block.levers.some((lever) => lever.scaled) ? "× multiplies every value drawn, and so their spread too. " : ""}`,
        unknown ? "Not known: the runs are too few, the change leads beyond the values drawn, or wings drawn there do not deploy. " : null,
        h("a", { href: "#why" }, "More causes"),
        ".",
      ),
    ];
  }
  // The adjusted coefficient of determination is below 0 where the fit is no better than the mean.
  const explained = ({ explained: share }) => (share >= 0.005 || !W.isNumber(share) ? F.share(share, 0) : "nothing");
  // Why there is no estimate.
  function unknown(one, set, block, limited) {
    const all = (set.inputs || {}).dispersions || [],
      draws = all.length;
    if (all.length && all.every((each) => W.isNumber(each.low) && each.low === each.high))
      return "No dispersion varies, so these runs do not show what would change it.";
    if (!limited && one.not_deployed === set.runs) return "No run deploys: these runs do not show what would change it.";
    if (block.runs && limited && block.explained < 0.5)
      return `These runs do not show what would change it: a linear fit explains ${explained(block)} of the spread. Ask wingspread margin.`;
    return block.runs
      ? "No change of a dispersed input within the values drawn is seen to be enough; beyond them it is not known. The inputs of the runs that fail are among the causes. wingspread margin tries other springs."
      : `Too few runs to estimate what would change it: ${F.counted(draws, "dispersion")}, so at least ${F.runs(draws + 11)} with a value.`;
  }
  // The command, unfolded. `margin` judges the requirements; static margins only if the campaign asks for them.
  function confirmation(command, first) {
    const asked = W.sets.some((set) => (set.requirements || []).some((each) => each.static_margin));
    return h(
      "details",
      { open: true },
      h("summary", `Confirm ${first ? "the first change" : "the change"} with new runs: wingspread margin`),
      h(
        "p.note",
        `It judges all ${W.sets.some((set) => /--requirements/.test(set.judged_by)) ? "requirements on this page" : "requirements of the campaign's file"}${asked ? "" : ". Static margins are not among them; it prints them for the springs as they are and for the scale that it recommends"}.`,
      ),
      W.command(command, "command that confirms the change"),
    );
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
      h("p", aim(one, set, limited), block.levers.length > 1 ? "Estimated changes, each alone, not yet run: confirm them first." : "An estimated change, not yet run: confirm it first."),
      command ? confirmation(command, block.levers.length > 1 && block.levers[0].command) : null,
      table(one, set, block, limited),
    );
  };
})();
