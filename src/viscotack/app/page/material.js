// The material: the law of the case over frequency, and a laboratory's file with its fit.

import { button, fold, h, save } from "./dom.js";
import { reader } from "./form.js";
import { picture } from "./operations.js";
import { Plot } from "./plot.js";

export function material(host, store) {
  const left = h("section", { class: "card main" }), file = reader(store.operations["material fit"], "fit", "DMA, relaxation or creep files", tell, ["words", "plot"]);
  host.append(h("div", { class: "view" }, left, h("section", { class: "card side" }, h("h2", {}, "A DMA file"), file.drop,
    h("p", { class: "hint" }, "TA TRIOS, RheoCompass, Eplexor, RepTate, workbooks or plain tables. What a file does not say is asked for."), file.said, file.form.host)));
  const plot = new Plot(left, "Modulus against frequency", { height: 340 }), fitted = h("div");
  left.append(fitted);
  file.form.fields.find(({ name }) => name === "poisson_ratio").input.value = "0.5";
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
    fit = found?.drawn || null;
    plot.card.hidden = !!fit;
    fitted.replaceChildren(...(fit ? [picture(found.files.plot, "The fit with its band and residuals")] : []));
    if (!fit) { shown(); return; }
    const use = button("Use this material in the case", () => { store.change({ material: fit.table }); use.textContent = "it is the material of the case"; }, { id: "use-material" });
    file.said.replaceChildren(h("div", { class: "row" }, ...(fit.table ? [use, button("Save the passport", () => save("passport.toml", fit.passport))] : [])),
      h("pre", { tabindex: 0, role: "region", "aria-label": "Report of the fit" }, found.words), fold("how it was read", found.notes.map((words) => h("p", { class: "hint" }, words))));
  }
}
