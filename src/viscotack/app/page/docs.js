// The operations of the API for people, made from what it says of them.

import { h, table } from "./dom.js";
import { ask } from "./server.js";

const { operations } = await ask("/api/operations");
document.getElementById("content").append(...operations.filter(({ local }) => !local).map(({ path, help, options, outputs }) => {
  const rows = options.map(({ name, form, unit, choices, many, needed, default: usual, words }) => [name, `${many ? "list of " : ""}${choices.join(" | ") || form} ${unit === "1" ? "" : unit}`, needed ? "needed" : String(usual ?? ""), words]);
  return h("section", { class: "card wide" }, h("h2", {}, `POST /api/${path}`), h("pre", { tabindex: 0 }, help), table(`Options of ${path}`, ["name", "kind", "when left out", "meaning"], rows),
    outputs.length ? h("p", { class: "hint" }, outputs.map(({ name, words }) => `outputs=${name}: ${words}`).join(" ")) : null);
}));
