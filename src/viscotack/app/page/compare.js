// Up to four cases beside each other.

import { Plot, element } from "./plot.js";
import { button, card } from "./contact.js";
import { pulled, pulledBy, said, shown, workOf } from "./numbers.js";

const COLOURS = ["c0", "c1", "c2", "c3"];

export class Compare {
  constructor(host, store) {
    this.store = store;
    this.host = host;
    const view = element("div", "view");
    host.append(view);
    const box = card(view, "wide");
    this.plot = new Plot(box, "Cases beside each other", { height: 380 });
    const keep = button("Keep the present case", () => store.keep());
    keep.id = "keep-here";
    this.keep = keep;
    const row = element("div", "row");
    row.append(keep, element("p", "hint", "Up to four. They are in the link of the page."));
    box.append(row);
    this.table = element("div", "scroll");
    this.table.tabIndex = 0;
    this.table.setAttribute("role", "region");
    this.table.setAttribute("aria-label", "Numbers of the cases");
    card(view, "wide").append(element("h2", "", "What differs"), this.table);
    store.addEventListener("kept", () => this.draw());
    this.draw();
  }

  shown() {
    this.draw();
  }

  draw() {
    const { kept } = this.store;
    this.keep.disabled = kept.length >= 4;
    if (this.host.hidden) return;
    const series = kept.flatMap((one, i) => {
      const learned = one.quick.curves.surrogate || one.quick.curves.elastic;
      const drawn = one.columns || learned;
      return drawn ? [{ kind: "line", x: drawn.depth, y: drawn.force, colour: COLOURS[i], dash: !one.columns, words: `case ${i + 1}${one.columns ? ", simulated" : ""}` }] : [];
    });
    const axes = kept.length ? kept[0].quick.axes : { depth: { words: "depth", unit: "m" }, force: { words: "force", unit: "N" } };
    this.plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series);
    if (!kept.length) { this.table.replaceChildren(element("p", "hint", "No case is kept yet.")); return; }
    const table = element("table", ""), head = table.createTHead().insertRow();
    const corner = element("th", "", "number");
    corner.scope = "col";
    head.append(corner);
    kept.forEach((one, i) => {
      const cell = element("th", "", `case ${i + 1} `);
      cell.scope = "col";
      const back = button("open", () => this.store.take(structuredClone(one.tables)));
      back.setAttribute("aria-label", `Open case ${i + 1}`);
      const gone = button("remove", () => this.store.forget(i));
      gone.setAttribute("aria-label", `Remove case ${i + 1}`);
      cell.append(back, gone);
      head.append(cell);
    });
    const body = table.createTBody();
    for (const [words, values] of this.rows(kept)) {
      const row = body.insertRow(), first = element("th", "", words);
      first.scope = "row";
      row.append(first);
      for (const value of values) row.insertCell().textContent = value;
    }
    this.table.replaceChildren(table);
  }

  rows(kept) {
    const names = [...new Set(kept.flatMap(({ tables }) => Object.entries(tables).flatMap(([table, values]) => Object.keys(values).map((key) => `${table}.${key}`))))];
    const rows = names.map((name) => [name.replace(".", ": ").replaceAll("_", " "), kept.map(({ tables }) => {
      const [table, key] = name.split(".");
      const value = tables[table]?.[key];
      return value === undefined ? "–" : Array.isArray(value) ? value.join("; ") : shown(value);
    })]).filter(([, values]) => kept.length === 1 || new Set(values).size > 1);
    const pull = (one) => {
      const { unit } = pulled(one.quick);
      const known = one.summary ? pulledBy(one.summary) : one.quick.numbers.find(({ name }) => ["pull_off_force", "pull_off_stress"].includes(name))?.value;
      return said(known, unit);
    };
    rows.push(["pull-off", kept.map(pull)]);
    rows.push(["work to pull-off", kept.map((one) => {
      const known = one.summary ? workOf(one.summary) : one.quick.numbers.find(({ name }) => name === "work_to_pull_off")?.value;
      return said(known, one.quick.axes.work_to_pull_off.unit);
    })]);
    return rows;
  }
}
