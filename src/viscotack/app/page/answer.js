// The one answer of the case, large, with its band and where it comes from; it stays in sight.

import { element } from "./plot.js";
import { between, percent, said } from "./numbers.js";

export class Answer {
  constructor(host, store) {
    this.host = host;
    this.store = store;
    this.name = element("p", "hint");
    this.number = element("p", "large", "…");
    this.band = element("p", "band");
    this.from = element("p", "hint from");
    this.refused = document.getElementById("refused");
    host.append(this.name, this.number, this.band, this.from);
    for (const name of ["case", "quick", "verdict", "run"]) store.addEventListener(name, () => this.draw());
  }

  // Numbers of the case before stay, dimmed, until new ones have come.
  draw() {
    const { store, refused } = this, { best } = store;
    this.host.classList.toggle("stale", !best || !!store.refused);
    if (best && best === this.drawn && !store.refused) return;
    this.drawn = best;
    refused.hidden = !store.refused;
    const refusal = store.refused.replace(/^the case(, \[[\w-]+\])?:? /, "");
    if (refused.textContent !== refusal) refused.textContent = refusal;
    if (!best) return;
    const [first] = best;
    const { words } = store.quick.axes[first ? first.name : "pull_off_force"] ?? store.quick.axes.pull_off_stress;
    this.name.textContent = words;
    this.number.textContent = first ? said(first.value, store.quick.axes[first.name].unit) : "no answer";
    this.band.textContent = first ? bandOf(first, store.quick.axes[first.name].unit) : "";
    this.from.textContent = first ? `by the ${first.method}${first.why ? `: ${first.why}` : ""}` : [store.verdict?.refused, store.run.error || store.run.answer?.summary.status].filter(Boolean).join(" ");
    this.from.title = this.from.textContent;
  }
}

export function bandOf({ interval, confidence, error }, unit) {
  if (interval) return `${between(...interval, unit)} in ${percent(confidence)} of cases`;
  return error ? `numerical error ${percent(error)}` : "";
}
