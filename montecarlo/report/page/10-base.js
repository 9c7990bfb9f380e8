// Defines window.wingspread, the page's one global: its data, the reader's choices, and functions that make elements and
// tables.
(function () {
  "use strict";
  const W = (window.wingspread = {});
  W.data = JSON.parse(document.getElementById("data").textContent);
  // Sets of runs come first; results of `margin`, `sensitivity CAMPAIGN`, `rare` and `fit` are sets without runs, behind them.
  const all = W.data.sets || [],
    isStudy = (set) => !set.runs && !(set.statuses || []).length;
  W.studySets = all.filter(isStudy);
  W.onlyStudies = all.length > 0 && W.studySets.length === all.length;
  W.sets = W.onlyStudies ? [W.studySets.find((set) => set.wing) || W.studySets[0]] : all.filter((set) => !isStudy(set));

  // The reader's choices. `choose` calls every listener of the key.
  W.chosen = { set: 0, output: null, split: "order", scale: "linear", angles: "deg", motion: 0, run: null };
  const listeners = {};
  W.on = function (key, listener) {
    (listeners[key] = listeners[key] || []).push(listener);
  };
  W.choose = function (key, value) {
    W.chosen[key] = value;
    (listeners[key] || []).forEach((listener) => listener(value));
  };
  W.set = () => W.sets[W.chosen.set];
  // Says that a part of the page needs the rows, which a folder made with `run --no-rows` lacks.
  W.withoutRows = (set, part, verb = "needs") => `${part} ${verb} the rows of the runs, and ${set.label} was run with --no-rows.`;
  W.outputsOf = (set) => (set && set.outputs) || [];
  W.output = function (set) {
    const outputs = W.outputsOf(set || W.set());
    return outputs.find((output) => output.name === W.chosen.output) || null;
  };

  // Makes an element: W.h("td.number", { title: "moment" }, "1.2"). Classes follow the tag. The attributes may be left out.
  // Attributes and children that are null or false are skipped.
  const present = (value) => value !== null && value !== undefined && value !== false;
  const isAttributes = (value) => value && Object.getPrototypeOf(value) === Object.prototype;
  W.h = function (name, ...rest) {
    const [tag, ...classes] = name.split("."),
      element = document.createElement(tag);
    if (tag === "button") element.type = "button";
    if (classes.length) element.className = classes.join(" ");
    for (const [key, value] of Object.entries(isAttributes(rest[0]) ? rest.shift() : {})) {
      if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
      else if (present(value)) element.setAttribute(key, value === true ? "" : value);
    }
    element.append(...rest.flat(Infinity).filter(present));
    return element;
  };
  W.fill = function (parent, ...children) {
    parent.replaceChildren(...children.flat(Infinity).filter(present));
    return parent;
  };
  W.section = (id) => document.querySelector(`#${id} > .content`);
  W.isNumber = (value) => typeof value === "number" && isFinite(value);
  W.say = function (text) {
    document.getElementById("spoken").textContent = text;
  };

  let made = 0;
  W.newId = (stem) => `${stem}-${++made}`;

  // A table in a box that scrolls. A column is its heading's text, or W.number(heading, unit) for numbers; a cell is text or an
  // element. A row is its cells, or { cells, mark: its class }. The first cell of a row is its header.
  W.number = (text, unit) => ({ text, unit, class: "number" });
  W.table = function (caption, columns, rows, options = {}) {
    columns = columns.map((column) => (typeof column === "string" ? { text: column } : column));
    const cell = (content, at) =>
      at === 0
        ? W.h("th", { scope: "row", class: columns[at].class }, content)
        : W.h("td", { class: columns[at].class, "data-label": options.stacks ? columns[at].text : null }, content);
    const head = columns.map(({ text, unit, class: kind }) =>
      W.h("th", { scope: "col", class: kind }, text, unit ? W.h("span.unit", " " + unit) : null),
    );
    const body = rows.map((row) => W.h("tr", { class: row.mark || null }, (row.cells || row).map(cell)));
    const table = W.h(
      "table",
      { class: options.class },
      W.h("caption", { class: options.showCaption ? null : "unseen" }, caption),
      W.h("thead", W.h("tr", head)),
      W.h("tbody", body),
    );
    const box = W.h("div.scroll", { role: "group", "aria-label": caption }, table);
    widths.observe(box);
    return box;
  };
  // Only a table larger than its box can have the focus: keys then scroll it.
  const widths = new ResizeObserver((entries) =>
    entries.forEach(function ({ target: box }) {
      if (box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1)
        box.setAttribute("tabindex", "0");
      else box.removeAttribute("tabindex");
      if (!box.isConnected) widths.unobserve(box);
    }),
  );

  // Copies text. A page opened from a file may not use navigator.clipboard: it copies from a hidden text area.
  W.copy = function (text, what) {
    const done = () => W.say(`${what} copied.`);
    const older = function () {
      const area = W.h("textarea.unseen", { "aria-hidden": "true" });
      area.value = text;
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
      done();
    };
    if (navigator.clipboard && window.isSecureContext) navigator.clipboard.writeText(text).then(done, older);
    else older();
  };
  // A word of a command as a shell takes it, by the rule of the program's own commands (shell_word in printable.hpp).
  W.shellWord = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`);
  W.command = function (text, what) {
    const onclick = function (event) {
      W.copy(text, what);
      W.flash(event.currentTarget);
    };
    return W.h(
      "div.command",
      W.h("code", text),
      W.h("button.small", { "aria-label": `Copy: ${what}`, onclick }, "Copy"),
    );
  };
  W.flash = function (button) {
    const text = button.textContent;
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = text), 1200);
  };

  // A row of buttons; exactly one is pressed. options: [value, text] of each.
  W.buttons = function (label, options, chosen, onchoose) {
    const press = (value) => (event) => {
      buttons.forEach((button) => button.setAttribute("aria-pressed", String(button === event.currentTarget)));
      onchoose(value);
    };
    const buttons = options.map(([value, text]) =>
      W.h("button", { "aria-pressed": String(value === chosen), onclick: press(value) }, text),
    );
    return W.h(
      "div.buttons",
      { role: "group", "aria-label": label },
      W.h("span.label", { "aria-hidden": "true" }, label),
      buttons,
    );
  };
  // A choice from a list: options [value, text].
  W.select = (attributes, options, chosen) =>
    W.h(
      "select",
      attributes,
      options.map(([value, text]) => W.h("option", { value, selected: value === chosen }, text)),
    );
})();
