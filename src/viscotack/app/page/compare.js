// Up to four cases beside each other.

import { MOST_KEPT, button, h, table } from "./dom.js";
import { moveOf, said, shown as words } from "./numbers.js";
import { Plot } from "./plot.js";

export function compare(host, store) {
  const box = h("section", { class: "card wide" }), differing = h("div"), keep = button("Keep the present case", () => store.keep(), { id: "keep-here" });
  host.append(h("div", { class: "view" }, box, h("section", { class: "card wide" }, h("h2", {}, "What differs"), differing)));
  const plot = new Plot(box, "Cases beside each other", { height: 380 });
  box.append(h("div", { class: "row" }, keep, h("p", { class: "hint" }, "Up to four, in the link of the page. A stress is not drawn beside forces.")));
  store.on("kept", draw);
  return { shown: draw };

  function draw() {
    const { kept } = store;
    keep.disabled = kept.length >= MOST_KEPT;
    if (host.hidden) return;
    const axes = kept[0]?.quick.axes || { depth: { words: "depth", unit: "m" }, force: { words: "force", unit: "N" } };
    const series = kept.map(({ answer, quick: { axes: { force }, curves } }, i) => ({ drawn: force.unit === axes.force.unit && (answer?.curve || curves.surrogate || curves.elastic), colour: `c${i}`, dash: !answer, words: `case ${i + 1}${answer ? ", simulated" : ""}` }));
    plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series.filter(({ drawn }) => drawn).map(({ drawn, ...more }) => ({ kind: "line", x: drawn.depth, y: drawn.force, ...more })));
    const heads = kept.map(({ tables }, i) => h("span", {}, `case ${i + 1} `, button("open", () => store.take(tables), { "aria-label": `Open case ${i + 1}` }), button("remove", () => store.keepAll(kept.toSpliced(i, 1)), { "aria-label": `Remove case ${i + 1}` })));
    differing.replaceChildren(kept.length ? table("Numbers of the cases", ["number", ...heads], rows(kept)) : h("p", { class: "hint" }, "No case is kept yet."));
  }

  function rows(kept) {
    const names = new Set(kept.flatMap(({ tables }) => Object.entries(tables).flatMap(([name, table]) => Object.keys(table).map((key) => `${name}.${key}`))));
    const stated = [...names].map((name) => [name.replace(".", ": ").replaceAll("_", " "), ...kept.map(({ tables }) => {
      const [table, key] = name.split("."), value = tables[table]?.[key];
      return Array.isArray(value) ? value.map(moveOf).join("; ") : words(value);
    })]);
    const number = (key, axis) => kept.map(({ answer, quick }) => said(answer ? answer[key] : quick.numbers.find(({ name }) => name === axis(quick).name)?.value, axis(quick).unit));
    return [
      ...stated.filter(([, ...values]) => kept.length === 1 || new Set(values).size > 1),
      ["pull-off", ...number("pull", ({ axes }) => axes.pulled)],
      ["work to pull-off", ...number("work", ({ axes }) => ({ ...axes.work_to_pull_off, name: "work_to_pull_off" }))],
    ];
  }
}
