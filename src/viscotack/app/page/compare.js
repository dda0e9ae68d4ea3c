// Up to four cases beside each other.

import { MOST_KEPT, button, h, table } from "./dom.js";
import { pulled, pulledBy, said, shown as words, workOf } from "./numbers.js";
import { Plot } from "./plot.js";

export function compare(host, store) {
  const box = h("section", { class: "card wide" }), differing = h("div"), keep = button("Keep the present case", () => store.keep(), { id: "keep-here" });
  host.append(h("div", { class: "view" }, box, h("section", { class: "card wide" }, h("h2", {}, "What differs"), differing)));
  const plot = new Plot(box, "Cases beside each other", { height: 380 });
  box.append(h("div", { class: "row" }, keep, h("p", { class: "hint" }, "Up to four. They are in the link of the page.")));
  store.on("kept", draw);
  return { shown: draw };

  function draw() {
    const { kept } = store;
    keep.disabled = kept.length >= MOST_KEPT;
    if (host.hidden) return;
    const axes = kept[0]?.quick.axes || { depth: { words: "depth", unit: "m" }, force: { words: "force", unit: "N" } };
    const series = kept.map(({ columns, quick: { curves } }, i) => ({ drawn: columns || curves.surrogate || curves.elastic, colour: `c${i}`, dash: !columns, words: `case ${i + 1}${columns ? ", simulated" : ""}` }));
    plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series.filter(({ drawn }) => drawn).map(({ drawn, ...more }) => ({ kind: "line", x: drawn.depth, y: drawn.force, ...more })));
    const heads = kept.map(({ tables }, i) => h("span", {}, `case ${i + 1} `, button("open", () => store.take(tables), { "aria-label": `Open case ${i + 1}` }), button("remove", () => store.keepAll(kept.toSpliced(i, 1)), { "aria-label": `Remove case ${i + 1}` })));
    differing.replaceChildren(kept.length ? table("Numbers of the cases", ["number", ...heads], rows(kept)) : h("p", { class: "hint" }, "No case is kept yet."));
  }

  function rows(kept) {
    const names = new Set(kept.flatMap(({ tables }) => Object.entries(tables).flatMap(([name, table]) => Object.keys(table).map((key) => `${name}.${key}`))));
    const stated = [...names].map((name) => [name.replace(".", ": ").replaceAll("_", " "), ...kept.map(({ tables }) => {
      const [table, key] = name.split("."), value = tables[table]?.[key];
      return Array.isArray(value) ? value.join("; ") : words(value);
    })]);
    const number = (of, name, unit) => kept.map(({ summary, quick }) => said(summary ? of(summary) : quick.numbers.find((one) => one.name === name(quick))?.value, unit(quick)));
    return [
      ...stated.filter(([, ...values]) => kept.length === 1 || new Set(values).size > 1),
      ["pull-off", ...number(pulledBy, (quick) => pulled(quick).name, (quick) => pulled(quick).unit)],
      ["work to pull-off", ...number(workOf, () => "work_to_pull_off", (quick) => quick.axes.work_to_pull_off.unit)],
    ];
  }
}
