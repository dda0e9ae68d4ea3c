// The one answer of the case, large, with its band and where it comes from; it stays in sight.

import { h } from "./dom.js";
import { percent, said, shown } from "./numbers.js";

export function answer(host, store) {
  const lines = ["hint", "large", "band", "hint from"].map((kind) => h("p", { class: kind })), refused = document.getElementById("refused");
  host.append(...lines);
  let drawn = null;
  store.on("case quick verdict run", () => {
    const { best, quick } = store;
    host.classList.toggle("stale", !best || !!store.refused); // numbers of the case before stay, dimmed, until new ones have come
    refused.hidden = !store.refused;
    const { words } = refusalOf(store.refused);
    if (refused.textContent !== words) refused.textContent = words;
    if (!best || best === drawn) return;
    drawn = best;
    const [first] = best, { words: name, unit } = first ? quick.axes[first.name] : quick.axes.pulled, run = store.now("run"), why = [store.verdict?.refused, run?.error || run?.answer?.summary.status].filter(Boolean).join("; ");
    const texts = first ? [name, said(first.value, unit), bandOf(first), `method: ${first.method}${first.why ? `; ${first.why}` : ""}`] : [name, "no answer", "", why];
    lines.forEach((line, i) => { if (line.textContent !== texts[i]) line.textContent = texts[i]; });
    lines[3].title = texts[3];
  });
}

export const bandOf = ({ band, error }) => shown(band || (error ? `numerical error ${percent(error)}` : ""));

// "the problem, [sphere] radius is missing; write for example radius = "5 mm"" -> its table, and words that fit a field.
export function refusalOf(refused) {
  const [, table = "", rest] = /^the problem(?:, \[([\w-]+)\])?:? ?(.*)/s.exec(refused) || [null, "", refused];
  const lines = rest.replaceAll(/\[\[.*?\]\]/g, (pairs) => pairs.replaceAll("], [", "; ").replaceAll(/[[\]"']/g, ""));
  return { table, words: lines.replace(/write for example (?:\w+ = )?"?([^"]*)"?/, "for example $1") };
}
