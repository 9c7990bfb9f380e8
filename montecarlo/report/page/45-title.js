// Above the verdicts: the title, the document's identity, and how many runs of which cases there are.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h, format: F } = W;

  // The document's number, revision, date, author and organisation, as the user gave them.
  function identity(words) {
    const kinds = [
      ["document", "Document"],
      ["revision", "Revision"],
      ["date", "Date"],
      ["author", "Author"],
      ["organisation", "Organisation"],
    ].filter(([key]) => words[key]);
    return kinds.length
      ? h("dl.identity", kinds.map(([key, name]) => h("div", h("dt", name), h("dd", words[key]))))
      : null;
  }
  // The name of a case's whole folder: its label without the case.
  function wholeName(set) {
    const end = [" · ", "/"].map((mark) => mark + set.case).find((text) => set.label.endsWith(text));
    return end ? set.label.slice(0, -end.length) : set.label;
  }
  // "3 cases: cold, ambient, hot", "2 folders (A, B) of 3 cases (cold, ambient, hot)", "2 folders: A (1 of 2 cases: cold), B".
  function extent() {
    const folders = new Map(); // the sets and unmade cases of each
    for (const set of [...W.sets, ...(W.data.unmade || [])]) {
      const folder = set.case ? set.campaign_folder : set;
      folders.set(folder, [...(folders.get(folder) || []), set]);
    }
    const all = [...folders.values()],
      made = (sets) => sets.filter((set) => W.sets.includes(set)).map((set) => set.case),
      cases = (sets) =>
        `${made(sets).length < sets.length ? `${made(sets).length} of ` : ""}${F.counted(sets.length, "case")}${made(sets).length ? `: ${made(sets).join(", ")}` : ""}`,
      first = made(all[0]);
    if (all.length === 1) return cases(all[0]);
    if (first[0] && all.every((sets) => sets.length === first.length && made(sets).join() === first.join()))
      return `${all.length} folders (${all.map(([set]) => wholeName(set)).join(", ")}) of ${F.counted(first.length, "case")} (${first.join(", ")})`;
    return `${all.length} folders: ${all.map((sets) => (sets.length > 1 ? `${wholeName(sets[0])} (${cases(sets)})` : sets[0].label)).join(", ")}`;
  }
  // The confidence of a set's bounds, "95 %", and those of all sets: folders may have been analysed at different ones.
  W.confidenceOf = (set) => `${F.given(100 * set.confidence)} %`;
  W.confidences = () => [...new Set(W.sets.map(W.confidenceOf))];
  // What tells the sets apart: the case, the folder, or either.
  W.kindOfSets = function () {
    const cases = new Set(W.sets.map((set) => set.case || ""));
    if (cases.has("")) return cases.size > 1 ? "set" : "folder";
    return cases.size > 1 || W.sets.length === 1 ? "case" : "folder";
  };
  W.headOfSets = () => ({ case: "Case", folder: "Folder", set: "Set" })[W.kindOfSets()];
  // "requirements at 90 % confidence, two-sided bounds at 95 %": both, where they differ.
  function confidences() {
    const levels = W.confidences(),
      own = W.verdicts.listed(levels),
      asked = [...new Set(W.sets.flatMap((each) => (each.requirements || []).map((one) => `${F.given(100 * one.confidence)} %`)))];
    if (!asked.length || (asked.length === 1 && asked[0] === own)) return `bounds at ${own}`;
    if (levels.length > 1) return `requirements at ${W.verdicts.listed(asked)} confidence, two-sided bounds at ${own}, by ${W.kindOfSets()}`;
    return `requirements at ${W.verdicts.listed(asked)} confidence, two-sided bounds at ${own}`;
  }
  // Whether planned runs of a set are missing; and all that are missing in words, as the program wrote them: "62 of 500
  // runs of case cold, none of hot"; null where every planned run is there.
  W.isPartial = (set) => Boolean(set.partial) || (set.runs < set.planned && !set.stopped);
  W.incomplete = () => W.data.incomplete || null;
  // Whether a set has a part of its campaign's runs only, which is not judged.
  W.isPart = (set) => W.isPartial(set) || Boolean(set.shard);
  // After a count of runs: more may come.
  W.soFar = (set) => (W.isPartial(set) ? " so far" : "");
  W.subtitle = function () {
    const set = W.set(),
      one = (read) => [...new Set(W.sets.map(read))];
    const facts = [
      W.incomplete() ? h("b", `incomplete: ${W.incomplete()}`) : null,
      W.sets.length > 1 || (W.data.unmade || []).length ? extent() : null,
      W.onlyStudies
        ? null
        : one((each) => each.runs).length === 1
          ? `${F.runs(set.runs)}${W.sets.length > 1 ? " each" : ""}`
          : `${F.count(d3.min(W.sets, (each) => each.runs))} to ${F.runs(d3.max(W.sets, (each) => each.runs))}`,
      set.foreign ? "rows from another tool" : null,
      W.onlyStudies ? null : confidences(), // each study has its own, beside its bounds
      set.shard ? `shard ${set.shard}` : null,
      set.stopped ? `stopped early: its goals were met (${F.count(set.planned)} runs planned)` : null,
      set.looks > 1 ? `bounds hold over ${set.looks} interim analyses` : null,
    ];
    const words = W.data.document || {};
    W.fill(
      document.getElementById("subtitle"),
      words.title ? h("p.wing-name", `Wing: ${W.data.title}`) : null,
      identity(words),
      set.description ? h("p.description", set.description) : null,
      h(
        "p.facts",
        facts.filter(Boolean).map((fact) => h("span", fact)),
      ),
    );
    const wings = [...new Set((W.onlyStudies ? W.studySets : W.sets).map((each) => each.campaign))].filter(Boolean),
      title = words.title || (wings.length > 1 ? wings.join(" and ") : W.data.title);
    document.getElementById("title").textContent = title;
    document.title = words.title || `${title} · wingspread report`;
    document.getElementById("colophon").textContent =
      `Made by ${W.data.command} (wingspread ${W.data.version}). This page contains its data and uses no network.`;
  };
})();
