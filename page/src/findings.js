// What the estimate says about itself, the gravest first, with what to do.

import { html, section } from "./elements.js";
import { sentence } from "./words.js";

const order = ["error", "warning", "notice"];

function item({ severity, text, advice }) {
  return html(
    "li",
    { class: severity },
    html("p", {}, html("strong", {}, `${sentence(severity).replace(".", "")}: `), sentence(text)),
    html("p", {}, html("em", {}, "Mend: "), sentence(advice)),
  );
}

/** Returns the section on findings, and what the reader of the scene had to say. */
export function findingsSection({ findings, notices }) {
  const sorted = [...findings].sort((a, b) => order.indexOf(a.severity) - order.indexOf(b.severity));
  return section(
    "Findings",
    sorted.length === 0
      ? html("p", {}, "None: no check of the program contradicts this estimate.")
      : html("ul", { class: "findings" }, sorted.map(item)),
    notices.length === 0 ? null : [html("h3", {}, "On reading the scene"), notices.map((notice) => html("p", {}, sentence(notice)))],
  );
}
