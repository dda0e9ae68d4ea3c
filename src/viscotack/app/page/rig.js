// The rig: a tack test beside the forecast of the case, and what it says of the interface.

import { drawCurves, measured, ofSpeeds } from "./contact.js";
import { button, h, table } from "./dom.js";
import { reader } from "./form.js";
import { quantity, said } from "./numbers.js";
import { Plot } from "./plot.js";
import { tomlOf } from "./record.js";

export function rig(host, store) {
  const left = h("section", { class: "card main" }), cycles = h("div"), below = h("section", { class: "card wide", hidden: true }, h("h2", {}, "Cycles"), cycles);
  const file = reader(store.operations["test read"], "rig", "tack tests or force curves", tell);
  host.append(h("div", { class: "view" }, left, h("section", { class: "card side" }, h("h2", {}, "Files of a rig"), file.drop,
    h("p", { class: "hint" }, "CSV and text with units, testXpert, Nanosurf, JPK, Asylum."), file.form.host, file.said), below));
  const plot = new Plot(left, "Measured beside the forecast", { height: 360 }), speeds = new Plot(left, "Measured pull-off against speed", { height: 240 });
  store.on("quick run verdict", draw);
  return { shown: draw };

  function tell(read) {
    const found = store.rig = read?.drawn;
    below.hidden = !found;
    store.say("quick");
    if (!found) return;
    const { curves, refused } = found, answer = h("div");
    const slow = button("What the first says of the interface, if it was slow", () => identify("identify/slow", {}, answer), { id: "identify-slow" });
    const rates = button("What the series of speeds says of the interface", () => identify("identify/rates", { material: tomlOf({ material: store.tables.material }) }, answer), { id: "identify-rates" });
    file.said.replaceChildren(h("p", {}, `${curves.length} ${curves.length === 1 ? "cycle" : "cycles"} read, ${refused.length} refused`), ...refused.map((one) => h("p", { class: "refused" }, `${one.file}: ${one.reason}`)), h("div", { class: "row" }, slow, rates), answer);
    cycles.replaceChildren(table("Cycles of the tests", ["test", "pull-off", "true speed", "preload", "forecast"], curves.map((one) => [
      `${one.file}, cycle ${one.cycle}`, `${said(one.pull_off_force_N, "N")} ± ${said(one.pull_off_force_N_uncertainty, "N", 1)}`, `${said(one.speed_m_s, "m/s", 3)} ± ${said(one.speed_m_s_uncertainty, "m/s", 1)}`,
      said(one.preload_N, "N", 3), button("Ask the case for this speed and preload", () => set(one)),
    ])));
  }

  function set({ preload_N: preload, speed_m_s: speed }) {
    const others = Object.entries(store.tables.protocol || {}).filter(([key]) => !key.startsWith("preload_") && key !== "start" && key !== "moves");
    store.change({ protocol: { preload_force: quantity(preload, "N"), ...Object.fromEntries(others), speed: quantity(speed, "m/s") } });
  }

  async function identify(path, more, answer) {
    try {
      const found = await file.ask(answer, path, { radius: store.tables.sphere?.radius, ...more });
      if (!found) return;
      answer.replaceChildren(...found.words.map((words) => h("p", {}, words)));
      if (found.equilibrium_gap_m) answer.append(button("Use this interface in the case", () => store.change({ interface: { law: "lennard-jones", work_of_adhesion: quantity(found.work_of_adhesion_J_m2, "J/m^2"), equilibrium_gap: quantity(found.equilibrium_gap_m, "m") } })));
    } catch (error) {
      answer.replaceChildren(h("p", { class: "refused" }, error.message));
    }
  }

  function draw() {
    const { quick, rig: found } = store;
    if (!quick || host.hidden) return;
    drawCurves(plot, store);
    speeds.card.hidden = !found;
    if (found) speeds.draw({ x: { ...quick.axes.speed, log: true }, y: { ...quick.axes.pulled, least: 0 } }, [...(store.now("theory")?.speeds ? ofSpeeds(store.theory.speeds) : []), measured(found)]);
  }
}
