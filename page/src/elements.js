// Makes elements of HTML and SVG.

const svgNamespace = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) {
      element.addEventListener(name.slice(2), value);
    } else if (value !== null && value !== undefined && value !== false) {
      element.setAttribute(name, value === true ? "" : value);
    }
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return element;
}

/** html("p", {class: "note"}, "text", other, null): nulls are left out, attributes "onclick" are listeners. */
export function html(name, attributes = {}, ...children) {
  return fill(document.createElement(name), attributes, children);
}

/** Does what html does, for an element of SVG. */
export function svg(name, attributes = {}, ...children) {
  return fill(document.createElementNS(svgNamespace, name), attributes, children);
}

/** Returns a part of the page with its heading, or null where nothing is in it. */
export function section(title, ...children) {
  const content = children.flat(Infinity).filter(Boolean);
  return content.length === 0 ? null : html("section", {}, html("h2", {}, title), content);
}

/** Returns a table; `rows` are lists of cells, and the columns named in `numeric` are set to the right. */
export function table(header, rows, numeric = []) {
  // On a narrow screen each cell is a line that begins with the title of its column.
  const cell = (kind) => (content, i) =>
    html(kind, { class: numeric.includes(i) ? "number" : null, "data-title": i > 0 && content !== "" ? header[i] : null }, content);
  return html(
    "div",
    { class: "table" },
    html(
      "table",
      {},
      html("thead", {}, html("tr", {}, header.map(cell("th")))),
      html("tbody", {}, rows.map((row) => html("tr", {}, row.map(cell("td"))))),
    ),
  );
}
