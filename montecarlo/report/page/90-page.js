// Draws the page, and draws it again after a switch.
(function () {
  "use strict";
  const W = window.wingspread;
  const { h } = W;
  const PARTS = [W.outcomes, W.outputs, W.wing, W.modes, W.why, W.convergence, W.comparison, W.inputs, W.glossary];
  const IDS = ["verdicts", "outputs", "wing", "modes", "why", "convergence", "comparison", "inputs", "glossary"];

  // An error in one part shows a message there; the other parts are still drawn.
  function draw() {
    PARTS.forEach(function (part, at) {
      try {
        part();
      } catch (error) {
        console.error(error);
        W.fill(W.section(IDS[at]), h("p.nothing", `This part could not be drawn: ${error.message}.`));
      }
    });
  }

  function theme() {
    const select = document.getElementById("theme");
    select.addEventListener("change", function () {
      if (select.value === "auto") document.documentElement.removeAttribute("data-theme");
      else document.documentElement.setAttribute("data-theme", select.value);
    });
  }
  function angles() {
    const select = document.getElementById("angles");
    select.value = W.chosen.angles;
    select.addEventListener("change", function () {
      W.choose("angles", select.value);
      draw();
    });
  }
  function cases() {
    const label = document.getElementById("case-switch"),
      select = label.querySelector("select");
    label.hidden = W.sets.length < 2;
    label.querySelector("span").textContent = W.headOfSets();
    W.fill(
      select,
      W.sets.map((set, at) => h("option", { value: at }, set.label)),
    );
    select.addEventListener("change", () => W.choose("set", Number(select.value)));
    W.on("set", function (at) {
      select.value = at;
      W.chosen.motion = 0;
      W.player.time = 0;
      draw();
      W.say(`${W.set().label} shown.`);
    });
    // The page opens on the case with the worst requirement.
    const worst = W.verdicts.judged()[0];
    if (worst) W.chosen.set = worst.at;
    select.value = W.chosen.set;
  }

  // Hides sections without content, and their links in the bar.
  function sections() {
    if (W.onlyStudies)
      ["outputs", "convergence", "inputs", ...(W.set().wing ? [] : ["wing"])].forEach((id) => (document.getElementById(id).hidden = true));
    document
      .querySelectorAll(".sections a")
      .forEach((link) => (link.parentNode.hidden = document.querySelector(link.getAttribute("href")).hidden));
  }

  // Marks the link of the visible section.
  function reading() {
    const links = [...document.querySelectorAll(".sections a")];
    const observer = new IntersectionObserver(
      (entries) =>
        entries.forEach(function (entry) {
          if (entry.isIntersecting)
            links.forEach((link) =>
              link.getAttribute("href") === `#${entry.target.id}`
                ? link.setAttribute("aria-current", "true")
                : link.removeAttribute("aria-current"),
            );
        }),
      { rootMargin: "-20% 0px -70% 0px" },
    );
    document.querySelectorAll("main > section").forEach((section) => observer.observe(section));
  }

  if (!W.sets.length) {
    W.fill(W.section("verdicts"), h("p.nothing", "This report contains no results."));
    return;
  }
  // The printed contents: the sections and their parts, and the document's number at the foot of each page.
  // Chromium cannot tell the number of a page to its contents (it lacks target-counter): studies/plots/print_report.py
  // prints twice, and the second time gives them in the page's address, "#pages=verdicts:1,outputs:3".
  function pageNumbers() {
    try {
      const given = /^#pages=(.*)$/.exec(decodeURIComponent(location.hash));
      return new Map(given ? given[1].split(",").map((entry) => entry.split(":")) : []);
    } catch {
      return new Map(); // the address has a % that begins no code, and so no numbers of pages
    }
  }
  function contents() {
    const numbers = pageNumbers();
    const sections = [...document.querySelectorAll("main > section:not([hidden])")];
    const parts = (section) =>
      [...section.querySelectorAll("h3")].filter((one) => !one.closest("details:not([open])")).map((one) => one.firstChild.textContent);
    W.fill(
      document.getElementById("contents"),
      h("h2", "Contents"),
      h(
        "ol",
        sections.map((section) =>
          h(
            "li",
            numbers.has(section.id) ? h("span.page", numbers.get(section.id)) : null,
            h("a", { href: `#${section.id}` }, section.querySelector("h2").textContent),
            h("span.faint", parts(section).length ? `: ${[...new Set(parts(section))].join(" · ")}` : ""),
          ),
        ),
      ),
    );
  }
  function foot() {
    const words = W.data.document || {},
      text = [words.organisation, words.document, words.revision && `revision ${words.revision}`, words.date].filter(Boolean).join(" · ");
    if (!text) return;
    const string = text.replace(/["\\<\u0000-\u001f]/g, (letter) => `\\${letter.charCodeAt(0).toString(16)} `);
    document.head.append(h("style", `@page { @bottom-left { content: "${string}"; } }`));
  }

  // Print all inputs, folded ones too.
  const opened = [];
  window.addEventListener("beforeprint", function () {
    document.querySelectorAll("#inputs details:not([open])").forEach((one) => {
      one.open = true;
      opened.push(one);
    });
    contents();
  });
  window.addEventListener("afterprint", () => opened.splice(0).forEach((one) => (one.open = false)));

  // "largest tip.peak_moment" in words, as the output is named everywhere else.
  // Of several sets, the worst run of one names its set: another case may have a worse one.
  const inWords = (set, text) =>
    text &&
    text.replace(/^worst: /, W.sets.length > 1 ? `worst in ${set.label}: ` : "worst: ").replace(/^(largest|least|worst(?: in .+)?:) (\S+)/, (all, most, name) =>
      W.outputsOf(set).some((output) => output.name === name) ? `${most} ${W.format.nameOf(name)}` : all,
    );
  for (const set of W.sets)
    for (const motion of set.motions || [])
      Object.assign(motion, { label: inWords(set, motion.label), why: inWords(set, motion.why) });

  theme();
  angles();
  cases();
  draw();
  sections();
  contents();
  foot();
  reading();
})();
