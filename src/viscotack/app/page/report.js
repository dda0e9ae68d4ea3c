// A case as one file to print or to send: the answer, its evidence, pictures, and how to compute it again.

import { escape } from "./dom.js";
import { commandOf, pythonOf, tomlOf } from "./record.js";

const STYLE = "body { font: 16px/1.45 system-ui, sans-serif; max-width: 46rem; margin: 2rem auto; padding: 0 1rem } table { border-collapse: collapse } th, td { text-align: left; padding: .2rem .6rem; border-bottom: 1px solid #ccc; vertical-align: top } pre { white-space: pre-wrap; overflow-wrap: anywhere; background: #f4f5f6; padding: .6rem } svg { max-width: 100%; height: auto } .large { font-size: 2.2rem; font-weight: 700; margin: 0 }";

export function reportOf(store, { numbers, tiers, words, plots }) {
  const best = [...document.querySelectorAll("#best > p:not(#refused)")].map((line) => `<p class="${line.className}">${escape(line.textContent)}</p>`);
  const rows = [...numbers.children].map((one) => `<tr><th>${escape(one.querySelector("dt").textContent)}</th><td>${escape(one.querySelector("dd").firstChild.textContent)}</td><td>${escape(one.querySelector("small")?.textContent || "")}</td></tr>`);
  const root = document.documentElement.dataset, { theme } = root;
  root.theme = "light"; // it is printed
  const pictures = plots.filter(({ series, width }) => width && series.length).map((each) => `<h2>${escape(each.title)}</h2>${each.text()}`);
  root.theme = theme;
  const code = [["The case", tomlOf(store.tables)], ["Command line", commandOf(store.settings)], ["Python", pythonOf(store.settings)], ["Link", location.origin + store.address]];
  return `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>viscotack: report of a case</title><style>${STYLE}</style></head><body>
<h1>Report of a case</h1>${best.join("")}<table>${rows.join("")}</table>
<h2>What this means</h2>${words.outerHTML}
<h2>How do the theories compare</h2>${tiers.innerHTML}
${pictures.join("")}
${code.map(([title, text]) => `<h2>${title}</h2><pre>${escape(text)}</pre>`).join("")}
<p>Computed by viscotack ${escape(store.forms.version)}.</p></body></html>`;
}
