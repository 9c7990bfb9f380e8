// The page's one global: its data, what the reader has chosen, and how elements are made.
(function () {
  "use strict";
  const W = (window.wingspread = {});
  W.data = JSON.parse(document.getElementById("data").textContent);
  // Sets of runs; and, behind them, what `margin`, `sensitivity` and `rare` left, which have no runs.
  const all = W.data.sets || [],
    isStudy = (set) => !set.runs && !(set.statuses || []).length;
  W.studySets = all.filter(isStudy);
  W.onlyStudies = all.length > 0 && W.studySets.length === all.length;
  W.sets = W.onlyStudies ? W.studySets.slice(0, 1) : all.filter((set) => !isStudy(set));

  // What the reader has chosen. `choose` tells all who asked to know; nothing is kept when the page is closed.
  W.chosen = { set: 0, output: null, split: "order", scale: "linear", angles: "rad", motion: 0, run: null };
  const listeners = {};
  W.on = function (key, listener) {
    (listeners[key] = listeners[key] || []).push(listener);
  };
  W.choose = function (key, value) {
    W.chosen[key] = value;
    (listeners[key] || []).forEach((listener) => listener(value));
  };
  W.set = () => W.sets[W.chosen.set];
  W.outputsOf = (set) => (set && set.outputs) || [];
  W.output = function (set) {
    const outputs = W.outputsOf(set || W.set());
    return outputs.find((output) => output.name === W.chosen.output) || null;
  };

  // An element: W.h("td", { class: "number" }, "1.2"). Attributes that are null or false are left out.
  W.h = function (tag, attributes, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {})) {
      if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
      else if (value !== null && value !== undefined && value !== false)
        element.setAttribute(name, value === true ? "" : value);
    }
    element.append(...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false));
    return element;
  };
  W.fill = function (parent, ...children) {
    parent.replaceChildren(
      ...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false),
    );
    return parent;
  };
  W.section = (id) => document.querySelector(`#${id} > .content`);
  W.isNumber = (value) => typeof value === "number" && isFinite(value);
  W.say = function (text) {
    document.getElementById("spoken").textContent = text;
  };

  let made = 0;
  W.newId = (stem) => `${stem}-${++made}`;

  // A table. A column: { text, unit, kind: "text" | "number", key: the row's header }. Cells: text, a number's text or an element.
  W.table = function (caption, columns, rows, options = {}) {
    const cell = (column, content, first) =>
      W.h(
        first && column.header !== false ? "th" : "td",
        {
          scope: first && column.header !== false ? "row" : null,
          class: column.kind === "number" ? "number" : null,
          "data-label": options.stacks && !first ? column.text : null,
        },
        content,
      );
    const head = columns.map((column) =>
      W.h(
        "th",
        { scope: "col", class: column.kind === "number" ? "number" : null },
        column.text,
        column.unit ? W.h("span", { class: "unit" }, " " + column.unit) : null,
      ),
    );
    const body = rows.map((row) =>
      W.h(
        "tr",
        { class: row.mark || null },
        (row.cells || row).map((content, at) => cell(columns[at], content, at === 0)),
      ),
    );
    const table = W.h(
      "table",
      { class: options.class },
      W.h("caption", { class: options.showCaption ? null : "unseen" }, caption),
      W.h("thead", {}, W.h("tr", {}, head)),
      W.h("tbody", {}, body),
    );
    const box = W.h("div", { class: "scroll", role: "group", "aria-label": caption }, table);
    widths.observe(box);
    return box;
  };
  // A table that is larger than its box can be scrolled by keys; another is no stop on the way through the page.
  const widths = new ResizeObserver((entries) =>
    entries.forEach(function ({ target: box }) {
      if (box.scrollWidth > box.clientWidth + 1 || box.scrollHeight > box.clientHeight + 1)
        box.setAttribute("tabindex", "0");
      else box.removeAttribute("tabindex");
      if (!box.isConnected) widths.unobserve(box);
    }),
  );

  // The clipboard, also where a page opened from a file may not use the newer way.
  W.copy = function (text, what) {
    const done = () => W.say(`${what} copied.`);
    const older = function () {
      const area = W.h("textarea", { class: "unseen", "aria-hidden": "true" });
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
  W.command = function (text, what) {
    const button = W.h(
      "button",
      {
        type: "button",
        class: "small",
        "aria-label": `Copy: ${what}`,
        onclick: () => {
          W.copy(text, what);
          flash(button);
        },
      },
      "Copy",
    );
    return W.h("div", { class: "command" }, W.h("code", {}, text), button);
  };
  function flash(button) {
    const text = button.textContent;
    button.textContent = "Copied";
    setTimeout(() => (button.textContent = text), 1200);
  }
  W.flash = flash;

  // A row of buttons of which one is pressed.
  W.buttons = function (label, options, chosen, onchoose) {
    const buttons = options.map(([value, text]) =>
      W.h(
        "button",
        {
          type: "button",
          "aria-pressed": String(value === chosen),
          onclick: (event) => {
            buttons.forEach((button) => button.setAttribute("aria-pressed", String(button === event.currentTarget)));
            onchoose(value);
          },
        },
        text,
      ),
    );
    return W.h(
      "div",
      { class: "buttons", role: "group", "aria-label": label },
      W.h("span", { class: "label", "aria-hidden": "true" }, label),
      buttons,
    );
  };
})();
