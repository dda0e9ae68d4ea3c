// The material: the law of the case over frequency, and a laboratory's file with its fit.

import { button, fold, h, save } from "./dom.js";
import { reader } from "./form.js";
import { Plot } from "./plot.js";

const PARTS = { storage: ["storage modulus", "c0"], loss: ["loss modulus", "c1"], relaxation: ["relaxation modulus", "c0"], creep: ["creep compliance", "c0"] };

export function material(host, store) {
  const left = h("section", { class: "card main" }), file = reader(store.operations["material fit"], "fit", "DMA, relaxation or creep files", tell);
  host.append(h("div", { class: "view" }, left, h("section", { class: "card side" }, h("h2", {}, "A DMA file"), file.drop,
    h("p", { class: "hint" }, "TA TRIOS, RheoCompass, Eplexor, RepTate, workbooks or plain tables. What a file does not say is asked for."), file.said, file.form.host)));
  const plot = new Plot(left, "Modulus against frequency", { height: 340 }), residuals = new Plot(left, "Residuals of the fit", { height: 190 }), shifts = new Plot(left, "Shifts with temperature", { height: 220 });
  file.form.fields.find(({ name }) => name === "poisson_ratio").input.value = "0.5";
  residuals.card.hidden = shifts.card.hidden = true;
  let fit = null;
  store.addEventListener("material files", ({ detail }) => file.take(detail));
  store.on("quick", shown);
  return { shown };

  function shown() {
    if (host.hidden || fit || !store.quick) return;
    const { frequency, storage, loss } = store.quick.moduli, line = (y, words, colour) => ({ kind: "line", x: frequency, y, words, colour });
    plot.draw({ x: { words: "frequency", unit: "Hz", log: true }, y: { words: "modulus", unit: "Pa", log: true } }, [line(storage, "storage modulus E', of the case", "c0"), line(loss, "loss modulus E''", "c1")]);
  }

  function tell(found) {
    fit = found?.fit || null;
    residuals.card.hidden = !fit;
    shifts.card.hidden = !found?.shifts;
    if (!fit) { shown(); return; }
    const use = button("Use this material in the case", () => { store.change({ material: found.table }); use.textContent = "it is the material of the case"; }, { id: "use-material" });
    file.said.replaceChildren(h("div", { class: "row" }, use, button("Save the passport", () => save("passport.toml", found.passport))),
      h("pre", { tabindex: 0, role: "region", "aria-label": "Report of the fit" }, found.words), fold("how it was read", found.notes.map((words) => h("p", { class: "hint" }, words))));
    const x = { words: fit.x, unit: fit.x_unit, log: true };
    plot.draw({ x, y: { words: fit.unit === "Pa" ? "modulus" : "compliance", unit: fit.unit, log: true } }, fit.parts.flatMap(({ name, low, high, fitted, measured }) => {
      const [words, colour] = PARTS[name];
      return [
        { kind: "band", x: fit.curve_at, low, high, colour, words: `${Math.round(100 * fit.level)} % band` },
        { kind: "line", x: fit.curve_at, y: fitted, colour, words: `${words}, fitted` },
        { kind: "points", x: fit.at, y: measured, colour, words: `${words}, measured` },
      ];
    }));
    residuals.draw({ x, y: { words: "measured/fitted − 1", unit: "%" } }, fit.parts.map(({ name, residual }) => ({ kind: "points", x: fit.at, y: residual, colour: PARTS[name][1], words: PARTS[name][0] })));
    if (found.shifts) shifts.draw({ x: { words: "temperature", unit: "°C" }, y: { words: "log10 of the shift", unit: "" } }, [{ kind: "points", x: found.shifts.temperature, y: found.shifts.log10_shift, colour: "c0", words: "shifts that were used" }]);
  }
}
