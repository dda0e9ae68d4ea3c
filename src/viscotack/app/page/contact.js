// The first view: load against depth, what is under the indenter, and what may be trusted.

import { Plot, element, save } from "./plot.js";
import { digits, percent, pulled, pulledBy, said, shown, workOf } from "./numbers.js";
import { bandOf } from "./answer.js";
import { reportOf } from "./report.js";
import { learned, setUp, surface } from "./drawing.js";
import { curveOf } from "./store.js";

const ENERGY = { drive: ["work of the drive", "c6"], interface: ["interface", "c0"], elastic: ["elastic energy", "c1"], spring: ["spring of the machine", "c5"], heat: ["heat in the solid", "c2"], interface_heat: ["heat in the interface", "c4"], jumps: ["lost in jumps", "c3"], transfer: ["lost in mesh moves", "c6"] };
const TOUR = 5000; // milliseconds of one way along the curve

export class Contact {
  constructor(host, store) {
    this.store = store;
    this.host = host;
    const view = element("div", "view");
    host.append(view);

    const numbers = card(view, "wide");
    this.numbers = element("dl", "numbers");
    this.tiers = element("details", "");
    this.tiers.append(element("summary", "", "How do the theories compare"), element("div", ""));
    numbers.append(this.numbers, this.tiers);

    const left = column(view, "main"), right = column(view, "side");
    const main = card(left, "");
    this.plot = new Plot(main, "Load against depth", { height: 340 });
    main.append(element("p", "hint", "Depth of the tip below the undeformed surface: positive pressed in, negative pulled above it. Force is positive when it pushes."), this.controls());

    const under = card(left, "");
    under.append(element("h2", "", "Under the indenter"));
    this.surface = element("div", "");
    under.append(this.surface);
    const fields = element("div", "pair");
    this.pressure = new Plot(fields, "Pressure along the radius", { height: 200 });
    this.gap = new Plot(fields, "Gap along the radius", { height: 200 });
    under.append(fields);

    const side = card(right, ""), judged = card(right, "");
    this.setUp = element("div", "");
    side.append(element("h2", "", "Set-up"), this.setUp);
    this.words = element("ul", "words");
    judged.append(element("h2", "", "What this means"), this.words);

    this.speeds = new Plot(card(view, ""), "Pull-off against speed", { height: 270 });
    this.energy = new Plot(card(view, ""), "Where the work goes", { height: 270 });

    this.at = null;
    this.profile = undefined;
    store.addEventListener("quick", () => this.draw());
    store.addEventListener("run", () => this.draw());
    store.addEventListener("verdict", () => this.draw());
  }

  controls() {
    const box = element("div", "");
    const row = element("div", "row");
    this.play = button("Pause", () => this.toggle());
    this.play.setAttribute("aria-label", "Pause or play the way along the curve");
    this.slider = element("input", "grow");
    this.slider.type = "range";
    this.slider.min = 0; this.slider.max = 1000; this.slider.value = 0;
    this.slider.setAttribute("aria-label", "Point along the simulated curve");
    this.slider.addEventListener("input", () => { this.pause(); this.go(Number(this.slider.value) / 1000); });
    this.start = button("Simulate", () => this.store.simulate());
    this.cancel = button("Cancel", () => this.store.stop("cancelled"));
    this.cancel.id = "cancel";
    this.keep = button("Keep to compare", () => this.store.keep());
    const report = button("Save a report", () => save("report.html", new Blob([reportOf(this.store, this)], { type: "text/html" })));
    report.id = "save-report";
    row.append(this.play, this.slider, this.start, this.cancel, this.keep, report);
    this.progress = element("progress", "");
    this.progress.max = 1;
    this.progress.setAttribute("aria-label", "Progress of the simulation");
    this.said = element("p", "hint");
    this.said.id = "run";
    this.said.setAttribute("role", "status");
    box.append(row, this.progress, this.said);
    this.plot.svg.addEventListener("pointerdown", (event) => this.drag(event));
    return box;
  }

  // Drag along the curve in the picture itself.
  drag(event) {
    if (!this.curve) return;
    this.pause();
    const svg = this.plot.svg, curve = { x: this.curve.depth, y: this.curve.force };
    const move = (at) => this.go(this.plot.nearest(at, [curve]).i / Math.max(curve.x.length - 1, 1));
    move(event);
    const end = () => { svg.removeEventListener("pointermove", move); removeEventListener("pointerup", end); };
    svg.addEventListener("pointermove", move);
    addEventListener("pointerup", end);
  }

  draw() {
    const { quick, run, verdict } = this.store;
    if (!quick) return;
    const now = this.store.version;
    const { axes } = quick;
    const done = run.answer, growing = ["queued", "running"].includes(run.state);
    const stale = run.version !== now;
    const simulated = done ? curveOf(done) : { depth: run.depth, force: run.force };
    const series = [], { elastic, edge, surrogate } = quick.curves;
    if (elastic) series.push({ kind: "line", x: elastic.depth, y: elastic.force, colour: "c6", dash: true, words: elastic.words });
    const { theory } = this.store;
    const crack = theory && theory.version === now ? theory.crack : null;
    if (edge && !crack) series.push({ kind: "line", x: edge.depth, y: edge.force, colour: "c2", dash: !edge.applies, faint: !edge.applies, beside: !edge.applies, words: `theory: ${edge.words}${edge.applies ? "" : " (does not apply here)"}` });
    if (crack) series.push({ kind: "line", x: crack.depth, y: crack.force, colour: "c2", dash: !crack.applies, words: `theory: ${crack.words}` });
    if (surrogate) series.push(...learned(surrogate));
    if (simulated.depth.length) series.push({ kind: "line", x: simulated.depth, y: simulated.force, colour: "c0", faint: stale, beside: stale, width: 2.8, words: stale ? "simulation of the case before" : growing ? "simulation, as it runs" : "simulation" });
    if (this.store.rig) for (const one of this.store.rig.curves.slice(0, 3)) series.push({ kind: "points", x: one.depth, y: one.force, colour: "c3", size: 1.5, words: `measured: ${one.file}` });
    this.plot.cursor = null;
    this.plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series);
    const drawing = setUp(this.store.tables, quick);
    if (drawing !== this.drawing) this.setUp.innerHTML = this.drawing = drawing;
    this.state(run, growing, stale);
    const judged = verdict && verdict.version === now ? verdict : null;
    this.told(quick, done && !stale ? done : null);
    this.compare(quick, judged, done && !stale ? done : null);
    this.speed(quick, theory, done && !stale ? done : null);
    this.mean(quick, judged);
    const curve = done && !stale ? simulated : null;
    if (curve !== this.curve && (!curve || this.answer !== done)) {
      this.curve = curve;
      this.answer = curve ? done : null;
      this.drawEnergy(done, stale);
      if (curve) this.tour();
      else this.pause();
    }
    this.curve = curve;
    this.show();
  }

  state(run, growing, stale) {
    this.progress.hidden = !growing;
    this.progress.value = run.share;
    this.cancel.disabled = !growing;
    this.start.disabled = growing;
    this.keep.disabled = this.store.kept.length >= 4;
    const words = {
      idle: "", queued: "waiting for a free process", running: `simulating, ${Math.round(100 * run.share)} %`,
      refused: `no simulation: ${run.error}`, cancelled: run.error ? "cancelled" : "",
      stopped: run.answer ? run.answer.summary.status : "",
      done: run.answer && !stale ? `${run.answer.summary.status}; simulated in ${digits(run.took / 1000, 2)} s` : "",
    }[run.state];
    if (this.said.textContent !== words) this.said.textContent = words;
    this.said.classList.toggle("refused", run.state === "refused" || run.state === "stopped");
  }

  // What belongs to the answer: the work, and the simulation that judges both.
  told(quick, done) {
    const { best } = this.store, { axes } = quick, pull = pulled(quick), rows = [];
    this.numbers.classList.toggle("stale", !best);
    if (!best) return;
    for (const each of best.slice(1)) rows.push([axes[each.name].words, each.value, axes[each.name].unit, bandOf(each, axes[each.name].unit)]);
    if (done && best[0]?.method !== "simulation") {
      const { summary } = done, error = summary.error_estimate || {}, force = pulledBy(summary), work = workOf(summary);
      const { interval } = best[0] || {};
      const inside = interval && (force >= interval[0] * (1 - (error.force || 0)) && force <= interval[1] * (1 + (error.force || 0)) ? "within the band" : "outside the band");
      rows.push([`${pull.words}, simulated`, force, pull.unit, [error.force ? `numerical error ${percent(error.force)}` : "", inside].filter(Boolean).join(", ")]);
      if (work !== null && work !== undefined) rows.push([`${axes.work_to_pull_off.words}, simulated`, work, axes.work_to_pull_off.unit, error.work ? `numerical error ${percent(error.work)}` : ""]);
    }
    const other = done && (done.summary.other_peak_force_N ?? done.summary.other_peak_stress_Pa);
    if (other !== null && other !== undefined) rows.push(["other peak, simulated", other, pull.unit, ""]);
    const key = JSON.stringify(rows);
    if (key === this.toldBefore) return;
    this.toldBefore = key;
    this.numbers.replaceChildren(...rows.map(([words, value, unit, more]) => {
      const box = element("div", ""), number = element("dd", "", said(value, unit));
      const copy = button("copy", () => { navigator.clipboard?.writeText(`${value} ${unit}`.trim()); copy.textContent = "copied"; });
      copy.className = "copy";
      copy.setAttribute("aria-label", `Copy the ${words}`);
      number.append(copy);
      if (more) number.append(element("small", "", more));
      box.append(element("dt", "", words), number);
      return box;
    }));
    if (best[0]) this.plot.remark(`${pull.words} ${said(best[0].value, pull.unit)}`);
  }

  // Every tier with its estimate: first what applies, then what does not, and why.
  compare(quick, judged, done) {
    this.tiers.classList.toggle("stale", !judged);
    if (!judged) return;
    const { best } = this.store;
    const simulation = done ? { tier: "simulation", value: pulledBy(done.summary), error: done.summary.error_estimate?.force, applies: true, why: done.summary.status } : null;
    const rows = [...judged.tiers.filter(({ tier }) => !simulation || tier !== "simulation"), ...(simulation ? [simulation] : [])];
    const key = JSON.stringify([rows, best?.[0]?.method]);
    if (key === this.comparedBefore) return;
    this.comparedBefore = key;
    const others = element("details", "");
    others.append(element("summary", "", "what does not apply, and why"), this.table(rows.filter(({ applies }) => !applies), quick));
    const known = rows.filter(({ applies }) => applies).map((row) => (row.tier === best?.[0]?.method ? { ...row, tier: `${row.tier} (the answer)` } : row));
    const groups = Object.entries(quick.groups).filter(([, value]) => typeof value === "number").map(([name, value]) => `${name.replaceAll("_", " ")} ${digits(value)}`);
    this.tiers.lastChild.replaceChildren(this.table(known, quick), others, element("p", "hint", `Without dimensions: ${groups.join(", ")}.`));
  }

  table(rows, quick) {
    const table = element("table", ""), head = table.createTHead().insertRow(), body = table.createTBody(), { words, unit } = pulled(quick);
    for (const name of ["tier", words, "nine of ten within", "why"]) { const cell = element("th", "", name); cell.scope = "col"; head.append(cell); }
    for (const { tier, value, error, why } of rows) {
      const row = body.insertRow(), name = element("th", "", tier);
      name.scope = "row";
      row.append(name);
      for (const text of [said(value, unit), error ? `± ${percent(error)}` : "", shown(why)]) row.insertCell().textContent = text;
    }
    const scroll = element("div", "scroll");
    scroll.tabIndex = 0;
    scroll.setAttribute("role", "region");
    scroll.setAttribute("aria-label", rows.length && rows[0].applies ? "Tiers that apply" : "Tiers that do not apply");
    scroll.append(table);
    return scroll;
  }

  speed(quick, theory, done) {
    const found = quick.speeds || (theory && theory.version === this.store.version ? theory.speeds : null);
    const { axes } = quick, series = [];
    if (found) {
      series.push({ kind: "band", x: found.speed, low: found.low, high: found.high, colour: quick.speeds ? "c1" : "c2", words: "band of 90 % of cases" });
      series.push({ kind: "line", x: found.speed, y: found.force, colour: quick.speeds ? "c1" : "c2", words: found.words });
    }
    const pull = done ? pulledBy(done.summary) : null;
    if (pull && found) series.push({ kind: "points", x: [found.here], y: [pull], colour: "c0", size: 6, words: "this case, simulated" });
    if (this.store.rig) series.push({ kind: "points", x: this.store.rig.curves.map((one) => one.speed), y: this.store.rig.curves.map((one) => one.pull_off_force), colour: "c3", words: "measured" });
    this.speeds.cursor = null;
    this.speeds.draw({ x: { ...axes.speed, log: true }, y: { ...pulled(quick), least: 0 } }, series);
    if (!found) { this.speeds.legend.textContent = "no theory, and nothing learned, answers at other speeds; a campaign does"; return; }
    const i = nearest(found.speed, found.here);
    this.speeds.point(found.here, pull ?? found.force[i], "this case");
  }

  drawEnergy(done, stale) {
    const energy = done && !stale ? done.energy : null;
    if (!energy && this.energy.axes && !this.energy.series.length) return;
    if (!energy) { this.energy.draw({ x: { words: "depth", unit: "m" }, y: { words: "energy", unit: "J" } }, []); return; }
    const curve = curveOf(done), moved = this.store.tables.protocol?.moves;
    const along = moved ? curve.time : curve.depth;
    const series = Object.entries(energy.series).map(([name, y]) => ({ kind: "line", x: along, y, words: ENERGY[name][0], colour: ENERGY[name][1], dash: name === "drive" }));
    const x = moved ? { words: "time", unit: "s" } : { words: "depth", unit: "m", turned: true };
    this.energy.draw({ x, y: { words: "energy", unit: energy.unit } }, series);
  }

  mean(quick, judged) {
    const notes = judged?.refused ? [judged.refused] : quick.notes.map((words) => `${words[0].toUpperCase()}${words.slice(1)}.`);
    const lines = [...notes, ...(judged ? judged.words : ["…"])];
    const key = lines.join("\n");
    if (key === this.saidBefore) return;
    this.saidBefore = key;
    this.words.replaceChildren(...lines.map((line) => element("li", "", shown(line))));
    this.words.parentElement.hidden = !lines.length;
  }

  // Go along the simulated curve, from its start to its end and again.
  tour() {
    this.go(0);
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) { this.pause(); return; }
    this.resume();
  }

  resume() {
    this.playing = true;
    this.play.textContent = "Pause";
    let before = performance.now();
    const step = (now) => {
      if (!this.playing) return;
      if (this.host.offsetParent !== null && this.curve) {
        const next = (this.at ?? 0) + (now - before) / TOUR;
        if (now - before > 30) { this.go(next > 1.15 ? 0 : next); before = now; }
      } else before = now;
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  pause() {
    this.playing = false;
    this.play.textContent = "Play";
  }

  toggle() {
    if (this.playing) this.pause();
    else this.resume();
  }

  go(at) {
    this.at = at;
    this.slider.value = 1000 * Math.min(at, 1);
    this.show();
  }

  show() {
    const { answer, curve } = this;
    this.slider.disabled = this.play.disabled = !curve;
    if (!curve || !answer) {
      if (this.profile === null) return; // it is empty already
      this.profile = null;
      this.surface.replaceChildren(element("p", "hint", this.store.run.state === "refused" ? "no simulation, no fields" : "comes with the simulation"));
      this.pressure.draw({ x: { words: "radius", unit: "m" }, y: { words: "pressure", unit: "Pa" } }, []);
      this.gap.draw({ x: { words: "radius", unit: "m" }, y: { words: "gap", unit: "m" } }, []);
      return;
    }
    const last = curve.depth.length - 1;
    const i = Math.min(Math.round(Math.min(this.at ?? 0, 1) * last), last);
    const axes = this.store.quick.axes;
    this.plot.point(curve.depth[i], curve.force[i], `${said(curve.force[i], axes.force.unit, 3)} at ${said(curve.depth[i], "m", 3)}`);
    this.slider.setAttribute("aria-valuetext", `${said(curve.force[i], axes.force.unit, 3)} at depth ${said(curve.depth[i], "m", 3)}`);
    const profiles = answer.profiles;
    if (!profiles) {
      if (this.profile !== "none") this.surface.replaceChildren(element("p", "hint", "a theory answers here, which has no fields"));
      this.profile = "none";
      return;
    }
    let profile = profiles[0];
    for (const one of profiles) if (Math.abs(one.step - i) < Math.abs(profile.step - i)) profile = one;
    if (profile === this.profile && this.drawnFor === answer) return;
    this.profile = profile;
    this.drawnFor = answer;
    const depth = curve.depth[profile.step];
    this.surface.innerHTML = surface(profile, depth, this.store.quick);
    const far = Math.max(...profiles[0].radius);
    this.pressure.draw({ x: { ...axes.along, least: 0, most: far }, y: { words: "pressure", unit: "Pa", ...this.reach(profiles) } }, [{ kind: "line", x: profile.radius, y: profile.pressure, colour: "c0" }]);
    this.gap.draw({ x: { ...axes.along, least: 0, most: far }, y: { words: "gap", unit: "m", least: 0 } }, [{ kind: "line", x: profile.radius, y: profile.gap, colour: "c2" }]);
  }

  reach(profiles) {
    if (this.reached?.of !== profiles) {
      const all = profiles.flatMap((one) => one.pressure);
      this.reached = { of: profiles, least: Math.min(...all), most: Math.max(...all) };
    }
    return { least: this.reached.least, most: this.reached.most };
  }
}

function nearest(list, value) {
  let best = 0;
  list.forEach((x, i) => { if (Math.abs(Math.log(x / value)) < Math.abs(Math.log(list[best] / value))) best = i; });
  return best;
}

export function card(view, kind) {
  const box = element("section", `card ${kind}`.trim());
  view.append(box);
  return box;
}

function column(view, kind) {
  const box = element("div", `column ${kind}`);
  view.append(box);
  return box;
}

export function button(words, action) {
  const found = element("button", "", words);
  found.type = "button";
  found.addEventListener("click", action);
  return found;
}
