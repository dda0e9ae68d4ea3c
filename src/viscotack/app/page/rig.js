// The rig: a tack test beside the forecast of the case, and what it says of the interface.

import { Plot, element } from "./plot.js";
import { button, card } from "./contact.js";
import { pulled, quantity, said } from "./numbers.js";
import { ask } from "./server.js";
import { curveOf } from "./store.js";
import { dropped } from "./files.js";
import { Form } from "./form.js";

export class Rig {
  constructor(host, store) {
    this.store = store;
    this.host = host;
    const view = element("div", "view");
    host.append(view);
    const left = card(view, "main");
    this.plot = new Plot(left, "Measured beside the forecast", { height: 360 });
    this.speeds = new Plot(left, "Measured pull-off against speed", { height: 240 });
    const side = card(view, "side");
    side.append(element("h2", "", "Files of a rig"), dropped("tack tests or force curves", (files) => this.take(files)));
    side.append(element("p", "hint", "CSV and text with units, testXpert, Nanosurf, JPK, Asylum."));
    this.form = new Form(side, store.operations.find(({ word }) => word === "test read"), "rig", { skip: ["files"] });
    this.said = element("div", "");
    this.said.setAttribute("role", "status");
    side.append(this.said);
    const below = card(view, "wide");
    this.table = element("div", "scroll");
    this.table.tabIndex = 0;
    this.table.setAttribute("role", "region");
    this.table.setAttribute("aria-label", "Cycles of the tests");
    below.append(element("h2", "", "Cycles"), this.table);
    below.hidden = true;
    this.below = below;
    for (const name of ["quick", "run"]) store.addEventListener(name, () => this.draw());
    this.draw();
  }

  shown() {
    this.draw();
  }

  body(files) {
    const body = new FormData();
    for (const file of files) body.append("files", file);
    return this.form.fill(body);
  }

  async take(files) {
    this.files = files;
    this.said.replaceChildren(element("p", "hint", "reading …"));
    try {
      const body = this.body(files);
      body.append("outputs", "drawn");
      this.store.rig = (await ask("/api/test/read", body)).beside.drawn;
      this.tell();
    } catch (error) {
      this.store.rig = null;
      this.said.replaceChildren(this.form.refused(error.message), button("Read it again", () => this.take(this.files)));
    }
    this.below.hidden = !this.store.rig;
    this.store.say("quick");
  }

  tell() {
    const { rig } = this.store;
    const slow = button("What the first says of the interface, if it was slow", () => this.identify("/api/identify/slow", {}));
    slow.id = "identify-slow";
    const rates = button("What the series of speeds says of the interface", () => this.identify("/api/identify/rates", { material: this.material() }));
    rates.id = "identify-rates";
    this.answer = element("div", "");
    this.said.replaceChildren(element("p", "", `${rig.curves.length} ${rig.curves.length === 1 ? "cycle" : "cycles"} read, ${rig.refused.length} refused`), ...rig.refused.map(({ file, reason }) => element("p", "refused", `${file}: ${reason}`)), slow, rates, this.answer);
    const table = element("table", "");
    const head = table.createTHead().insertRow();
    for (const words of ["test", "pull-off", "true speed", "preload", "forecast"]) { const cell = element("th", "", words); cell.scope = "col"; head.append(cell); }
    const body = table.createTBody();
    for (const one of rig.curves) {
      const row = body.insertRow();
      for (const words of [`${one.file}, cycle ${one.cycle}`, `${said(one.pull_off_force, "N")} ± ${said(one.pull_off_force_uncertainty, "N", 1)}`, `${said(one.speed, "m/s", 3)} ± ${said(one.speed_uncertainty, "m/s", 1)}`, said(one.preload, "N", 3)]) row.insertCell().textContent = words;
      const take = button("Ask the case for this speed and preload", () => this.set(one));
      row.insertCell().append(take);
    }
    this.table.replaceChildren(table);
  }

  set(one) {
    const tables = structuredClone(this.store.tables), protocol = tables.protocol || {};
    for (const key of Object.keys(protocol)) if (key.startsWith("preload_") || key === "start" || key === "moves") delete protocol[key];
    tables.protocol = { preload_force: quantity(one.preload, "N"), ...protocol, speed: quantity(one.speed, "m/s") };
    this.store.take(tables);
  }

  material() {
    const quote = (value) => (typeof value === "number" ? String(value) : JSON.stringify(value));
    return ["[material]", ...Object.entries(this.store.tables.material).map(([key, value]) => `${key} = ${quote(value)}`)].join("\n");
  }

  async identify(path, more) {
    this.answer.replaceChildren(element("p", "hint", "fitting …"));
    const body = this.body(this.files);
    body.append("radius", this.store.tables.sphere?.radius || "");
    for (const [name, value] of Object.entries(more)) body.append(name, value);
    try {
      const found = await ask(path, body);
      this.answer.replaceChildren(...found.words.map((words) => element("p", "", words)));
      if (found.equilibrium_gap_m) this.answer.append(button("Use this interface in the case", () => this.store.take({ ...structuredClone(this.store.tables), interface: { law: "lennard-jones", work_of_adhesion: quantity(found.work_of_adhesion_J_m2, "J/m^2"), equilibrium_gap: quantity(found.equilibrium_gap_m, "m") } })));
    } catch (error) {
      this.answer.replaceChildren(element("p", "refused", error.message));
    }
  }

  draw() {
    const { quick, run, rig } = this.store;
    if (!quick || this.host.hidden) return;
    const { axes } = quick, series = [], { elastic, surrogate, edge } = quick.curves;
    if (elastic) series.push({ kind: "line", x: elastic.depth, y: elastic.force, colour: "c6", dash: true, words: elastic.words });
    if (edge && edge.applies) series.push({ kind: "line", x: edge.depth, y: edge.force, colour: "c2", words: `theory: ${edge.words}` });
    if (surrogate) series.push({ kind: "line", x: surrogate.depth, y: surrogate.force, colour: "c1", words: surrogate.words });
    if (run.answer && run.version === this.store.version) { const { depth, force } = curveOf(run.answer); series.push({ kind: "line", x: depth, y: force, colour: "c0", words: "simulation of the case" }); }
    const colours = ["c3", "c4", "c5"];
    for (const [i, one] of (rig ? rig.curves : []).slice(0, 9).entries()) series.push({ kind: "points", x: one.depth, y: one.force, colour: colours[i % 3], size: 1.6, words: `${one.file}, ${said(one.speed, "m/s", 2)}` });
    this.plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series);
    this.speeds.card.hidden = !rig;
    if (!rig) return;
    const found = quick.speeds, more = [];
    if (found) more.push({ kind: "band", x: found.speed, low: found.low, high: found.high, colour: "c1", words: "band of 90 % of cases" }, { kind: "line", x: found.speed, y: found.force, colour: "c1", words: found.words });
    more.push({ kind: "points", x: rig.curves.map((one) => one.speed), y: rig.curves.map((one) => one.pull_off_force), colour: "c3", words: "measured" });
    this.speeds.draw({ x: { ...axes.speed, log: true }, y: { ...pulled(quick), least: 0 } }, more);
  }
}
