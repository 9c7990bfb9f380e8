// What the page and the model leave out, for a reader of the verdicts.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h } = W;

  // A paragraph on the parts and the precision of a page without rows; null if all sets have rows.
  W.withoutRowsNote = function () {
    const sets = W.sets.filter((set) => set.rows === false);
    return sets.length
      ? h(
          "p.lead",
          `${sets.map((set) => set.label).join(", ")}: run with --no-rows. Counts, verdicts, means, extremes and bounds are exact or on the safe side; a quantile may be a bin of the statistics off (summary.json says how far). `,
          "Convergence, rank correlations, pictures of pairs, histograms by latch order, the numerical error and the median run need the rows: they are not in this page.",
        )
      : null;
  };

  // The section on the assumptions of the model.
  W.assumptions = function () {
    const scene = ((W.set().inputs || {}).scene || []).map((one) => one.path),
      named = (pattern) => [...new Set(scene.map((path) => (pattern.exec(path) || [])[1]).filter(Boolean))],
      bent = named(/^bodies\.(.+)\.flexible\./),
      elastic = named(/^hinges\.(.+)\.joint\./),
      stopped = named(/^hinges\.(.+)\.(?:far_)?stop\./);
    const list = (names) => (names.length > 4 ? `${names.slice(0, 3).join(", ")} and ${names.length - 3} more` : names.join(", "));
    return [
      h("h3", "Assumptions of the model"),
      h(
        "p.lead.assumptions",
        "All hinge axes are parallel, so the wing moves in one plane. ",
        bent.length ? `Bodies are rigid, but for ${list(bent)}, which bend in that plane. ` : "Bodies are rigid. ",
        elastic.length ? `Elastic joints: ${list(elastic)}. ` : null,
        stopped.length
          ? `Nothing touches but the stops of ${stopped.length === 1 ? stopped[0] : `${stopped.length} hinges`}: panels can pass through each other. `
          : "No hinge has a stop and nothing touches: panels can pass through each other. ",
        "Cables, loops and harness have no mass. The confidence bounds hold for this model and for the dispersions under ",
        h("a", { href: "#inputs" }, "Inputs"),
        "; they do not cover what the model leaves out.",
      ),
    ];
  };
})();
