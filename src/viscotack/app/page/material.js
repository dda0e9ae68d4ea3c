// The material: the law of the case over frequency, and a laboratory's file with its fit.

import { Plot, element, save } from "./plot.js";
import { button, card } from "./contact.js";
import { ask } from "./server.js";
import { dropped } from "./files.js";
import { Form } from "./form.js";

const PARTS = { storage: ["storage modulus", "c0"], loss: ["loss modulus", "c1"], relaxation: ["relaxation modulus", "c0"], creep: ["creep compliance", "c0"] };

export class Material {
  constructor(host, store) {
    this.store = store;
    this.host = host;
    this.fit = null;
    const view = element("div", "view");
    host.append(view);
    const left = card(view, "main");
    this.plot = new Plot(left, "Modulus against frequency", { height: 340 });
    this.residuals = new Plot(left, "Residuals of the fit", { height: 190 });
    this.shifts = new Plot(left, "Shifts with temperature", { height: 220 });
    const side = card(view, "side");
    side.append(element("h2", "", "A DMA file"));
    this.drop = dropped("DMA, relaxation or creep files", (files) => this.take(files));
    side.append(this.drop, element("p", "hint", "TA TRIOS, RheoCompass, Eplexor, RepTate, workbooks or plain tables. What a file does not say is asked for."));
    this.said = element("div", "");
    this.said.setAttribute("role", "status");
    side.append(this.said);
    this.form = new Form(side, store.operations.find(({ word }) => word === "material fit"), "fit", { skip: ["files"] });
    this.form.needed.addEventListener("change", () => this.files && this.take(this.files));
    store.addEventListener("material files", ({ detail }) => this.take(detail));
    store.addEventListener("quick", () => this.ask());
    this.draw();
  }

  shown() {
    this.ask();
  }

  async ask() {
    if (this.host.hidden || this.asking || this.store.refused) return;
    const key = JSON.stringify(this.store.tables.material);
    if (key === this.asked) return;
    this.asking = true;
    this.asked = key;
    try {
      this.moduli = await ask("/api/moduli", { tables: this.store.tables });
    } catch (error) {
      this.moduli = null;
    }
    this.asking = false;
    this.draw();
  }

  async take(files) {
    const body = new FormData();
    for (const file of files) body.append("files", file);
    if (!this.form.input("poisson_ratio").value.trim()) this.form.input("poisson_ratio").value = "0.5";
    body.append("outputs", "drawn");
    this.form.fill(body);
    this.files = files;
    this.said.replaceChildren(element("p", "hint", "reading, shifting and fitting …"));
    try {
      this.fit = (await ask("/api/material/fit", body)).beside.drawn;
      this.tell();
    } catch (error) {
      this.fit = null;
      this.said.replaceChildren(this.form.refused(error.message), button("Read it again", () => this.take(this.files)));
    }
    this.draw();
  }

  tell() {
    const use = button("Use this material in the case", () => {
      this.store.take({ ...structuredClone(this.store.tables), material: this.fit.table });
      use.textContent = "it is the material of the case";
    });
    use.id = "use-material";
    const keep = button("Save the passport", () => save("passport.toml", new Blob([this.fit.passport])));
    const row = element("div", "row");
    row.append(use, keep);
    const notes = element("details", "");
    notes.append(element("summary", "", "how it was read"), ...this.fit.notes.map((words) => element("p", "hint", words)));
    const words = element("pre", "", this.fit.words);
    words.tabIndex = 0;
    words.setAttribute("aria-label", "Report of the fit");
    this.said.replaceChildren(row, words, notes);
  }

  draw() {
    const { fit } = this.fit || {};
    this.residuals.card.hidden = this.shifts.card.hidden = !fit;
    const axes = { x: { words: "frequency", unit: "Hz", log: true }, y: { words: "modulus", unit: "Pa", log: true } };
    if (!fit) {
      if (!this.moduli) return;
      const { frequency, storage, loss } = this.moduli;
      this.plot.draw(axes, [
        { kind: "line", x: frequency, y: storage, words: "storage modulus E', of the case", colour: "c0" },
        { kind: "line", x: frequency, y: loss, words: "loss modulus E''", colour: "c1" },
      ]);
      return;
    }
    const x = { words: fit.x, unit: fit.x_unit, log: true };
    const series = [];
    for (const part of fit.parts) {
      const [words, colour] = PARTS[part.name];
      series.push({ kind: "band", x: fit.curve_at, low: part.low, high: part.high, colour, words: `${Math.round(100 * fit.level)} % band` });
      series.push({ kind: "line", x: fit.curve_at, y: part.fitted, colour, words: `${words}, fitted` });
      series.push({ kind: "points", x: fit.at, y: part.measured, colour, words: `${words}, measured` });
    }
    this.plot.draw({ x, y: { words: fit.unit === "Pa" ? "modulus" : "compliance", unit: fit.unit, log: true } }, series);
    this.residuals.draw({ x, y: { words: "measured/fitted − 1", unit: "%" } }, fit.parts.map((part) => ({ kind: "points", x: fit.at, y: part.residual, colour: PARTS[part.name][1], words: PARTS[part.name][0] })));
    const { shifts } = this.fit;
    this.shifts.card.hidden = !shifts;
    if (shifts) this.shifts.draw({ x: { words: "temperature", unit: "°C" }, y: { words: "log10 of the shift", unit: "" } }, [{ kind: "points", x: shifts.temperature, y: shifts.log10_shift, words: "shifts that were used" }]);
  }
}
