// A picture: drawn to the width of its place, with title and description, its numbers as a table, and buttons that save it.
(function () {
  "use strict";
  const W = window.wingspread;
  const h = W.h;
  const figures = new Set();
  const PRINTED = 660; // px, width of an A4 page between its margins

  // options: title, description (text or function), note, draw(svg, width) → height, table() → { columns, rows }, printed (px), wide
  W.figure = function (options) {
    const titleId = W.newId("figure"),
      descriptionId = W.newId("description");
    const host = h("div.picture");
    const details = options.table ? h("details.numbers", h("summary", "Numbers as a table")) : null;
    if (details)
      details.addEventListener("toggle", () => {
        if (details.open && !details.querySelector("table")) details.append(asTable(options));
      });
    const svgButton = tool("SVG", `Save as SVG: ${options.title}`, () => saveSvg(host, options.title));
    const pngButton = tool("PNG", `Save as PNG: ${options.title}`, () => savePng(host, options.title));
    const dataButton = options.table
      ? tool("Copy data", `Copy data: ${options.title}`, (event) => {
          W.copy(asText(options), "Data");
          W.flash(event.currentTarget);
        })
      : null;
    const element = h(
      "figure",
      { class: options.class || null },
      h(
        "figcaption",
        h("span.caption", { id: titleId }, options.title),
        h("span.tools", { role: "group", "aria-label": `Save: ${options.title}` }, svgButton, pngButton, dataButton),
      ),
      host,
      options.note ? h("p.note", options.note) : null,
      details,
    );
    const figure = { element, host, options, titleId, descriptionId, width: 0 };
    figure.update = (width) => draw(figure, width);
    figures.add(figure);
    observer.observe(host);
    element.redraw = () => figure.update(host.clientWidth || figure.width || PRINTED);
    return element;
  };

  function tool(text, label, onclick) {
    return h("button.small", { "aria-label": label, title: label, onclick }, text);
  }

  // On wide screens the page's letters are larger (style.css: 14.3 px at 1280 px). Pictures are drawn for a narrower width
  // and shown enlarged, so that their letters grow by the same factor.
  const growth = () =>
    printing ? 1 : Math.max(1, parseFloat(getComputedStyle(document.documentElement).fontSize) / 14.3);

  function draw(figure, shown) {
    const { host, options } = figure,
      width = Math.round(shown / growth());
    figure.width = shown;
    const svg = d3
      .create("svg")
      .attr("xmlns", "http://www.w3.org/2000/svg")
      .attr("role", options.interactive ? "group" : "img")
      .attr("aria-labelledby", `${figure.titleId}-t`)
      .attr("aria-describedby", figure.descriptionId)
      .attr("class", "chart");
    W.marks.put(svg, "title", { id: `${figure.titleId}-t`, text: options.title });
    W.marks.put(svg, "desc", {
      id: figure.descriptionId,
      text: typeof options.description === "function" ? options.description() : options.description || options.title,
    });
    const height = options.draw(svg, width);
    svg
      .attr("viewBox", `0 0 ${width} ${Math.ceil(height)}`)
      .attr("width", width)
      .attr("height", Math.ceil(height));
    const focused = host.contains(document.activeElement);
    host.replaceChildren(svg.node());
    if (options.drawn) options.drawn(svg, focused);
  }

  const observer = new ResizeObserver(function (entries) {
    for (const entry of entries) {
      const figure = [...figures].find((one) => one.host === entry.target);
      const width = Math.floor(entry.contentRect.width);
      if (figure && width > 0 && width !== figure.width && !printing) figure.update(width);
    }
    for (const figure of figures)
      if (!figure.element.isConnected) {
        observer.unobserve(figure.host);
        figures.delete(figure);
      }
  });
  let printing = false;
  window.addEventListener("beforeprint", function () {
    printing = true;
    for (const figure of figures)
      if (figure.element.isConnected && !figure.element.closest("details:not([open])"))
        figure.update(figure.options.printed || PRINTED);
  });
  window.addEventListener("afterprint", function () {
    printing = false;
    for (const figure of figures)
      if (figure.element.isConnected && figure.host.clientWidth) figure.update(figure.host.clientWidth);
  });
  W.redraw = () =>
    figures.forEach((figure) => {
      if (figure.element.isConnected && figure.width) figure.update(figure.width);
    });

  function asTable(options) {
    const { columns, rows } = options.table();
    const format = (value) =>
      typeof value === "number"
        ? W.format.number(value, 6)
        : value === null || value === undefined
          ? W.format.none
          : String(value);
    const heads = columns.map((text, at) => (rows.some((row) => typeof row[at] === "number") ? W.number(text) : text));
    return W.table(
      options.title,
      heads,
      rows.map((row) => row.map(format)),
    );
  }
  function asText(options) {
    const { columns, rows } = options.table();
    return (
      [columns, ...rows]
        .map((row) => row.map((value) => (value === null || value === undefined ? "" : value)).join("\t"))
        .join("\n") + "\n"
    );
  }

  // The picture as a separate file: on white, in the light theme, with the computed styles written into it.
  const KEPT = (
    "fill fill-opacity stroke stroke-width stroke-opacity stroke-dasharray stroke-linejoin stroke-linecap opacity " +
    "font-family font-size font-weight font-style text-anchor dominant-baseline paint-order visibility display"
  ).split(" ");
  function standalone(host) {
    const root = document.documentElement,
      theme = root.getAttribute("data-theme");
    root.setAttribute("data-theme", "light");
    const original = host.querySelector("svg"),
      copy = original.cloneNode(true);
    const from = [original, ...original.querySelectorAll("*")],
      to = [copy, ...copy.querySelectorAll("*")];
    from.forEach(function (element, at) {
      const computed = getComputedStyle(element);
      to[at].setAttribute("style", KEPT.map((name) => `${name}:${computed.getPropertyValue(name)}`).join(";"));
      to[at].removeAttribute("class");
    });
    if (theme) root.setAttribute("data-theme", theme);
    else root.removeAttribute("data-theme");
    const paper = document.createElementNS("http://www.w3.org/2000/svg", "rect");
    const [, , width, height] = original.getAttribute("viewBox").split(" ").map(Number); // with a margin, to be pasted as it is
    const set = (element, attributes) =>
      Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    const size = { width: width + 28, height: height + 24 };
    set(paper, { x: -14, y: -12, ...size, fill: "#fff" });
    set(copy, { viewBox: `-14 -12 ${width + 28} ${height + 24}`, ...size });
    copy.insertBefore(paper, copy.children[2] || null);
    return new XMLSerializer().serializeToString(copy);
  }
  const fileName = (title, ending) =>
    `${title
      .toLowerCase()
      .replace(/[^a-z0-9]+/g, "_")
      .replace(/^_|_$/g, "")}.${ending}`;
  function save(blob, name) {
    const link = h("a", { href: URL.createObjectURL(blob), download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
    W.say(`${name} saved.`);
  }
  function saveSvg(host, title) {
    save(new Blob([standalone(host)], { type: "image/svg+xml" }), fileName(title, "svg"));
  }
  function savePng(host, title) {
    const image = new Image(),
      factor = 3;
    image.onload = function () {
      const canvas = h("canvas", { width: image.width * factor, height: image.height * factor });
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => save(blob, fileName(title, "png")));
    };
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(standalone(host));
  }
  W.standalone = standalone;
})();
