// The first view: load against depth, what is under the indenter, and what may be trusted.

import { bandOf } from "./answer.js";
import { MOST_KEPT, button, copied, fill, fold, h, save, table } from "./dom.js";
import { setUp, surface } from "./drawing.js";
import { digits, percent, said, shown } from "./numbers.js";
import { Plot } from "./plot.js";
import { reportOf } from "./report.js";

const ENERGY = { drive: ["work of the drive", "c6"], interface: ["interface", "c0"], elastic: ["elastic energy", "c1"], spring: ["spring of the machine", "c5"], heat: ["heat in the solid", "c2"], interface_heat: ["heat in the interface", "c4"], jumps: ["lost in jumps", "c3"], transfer: ["lost in mesh moves", "c6"] };
const TOUR = 5000, FRAME = 40; // milliseconds of one way along the curve, and of a picture

export function contact(host, store) {
  const numbers = h("dl", { class: "numbers" }), tiers = h("div"), compared = fold("How do the theories compare", tiers);
  const words = h("ul", { class: "words" }), judged = h("section", { class: "card" }, h("h2", {}, "What this means"), words);
  const main = h("section", { class: "card" }), under = h("div"), fields = h("div", { class: "pair" }), drawing = h("div");
  const bySpeed = h("section", { class: "card" }), byEnergy = h("section", { class: "card" });
  host.append(h("div", { class: "view" },
    h("section", { class: "card wide" }, numbers, compared),
    h("div", { class: "column main" }, main, h("section", { class: "card" }, h("h2", {}, "Under the indenter"), under, fields)),
    h("div", { class: "column side" }, h("section", { class: "card" }, h("h2", {}, "Set-up"), drawing), judged),
    bySpeed, byEnergy));

  // The way along the simulated curve: played, by the slider, or dragged in the picture.
  let curve = null, answer = null, at = 0, playing = false;
  const go = (place) => { at = place; slider.value = 1000 * Math.min(place, 1); show(); };
  const pause = (stopped = true) => { playing = !stopped; play.textContent = stopped ? "Play" : "Pause"; };
  setInterval(() => { if (playing && curve && host.offsetParent) go(at > 1.15 ? 0 : at + FRAME / TOUR); }, FRAME);
  const play = button("Pause", () => pause(playing), { "aria-label": "Pause or play the way along the curve" });
  const slider = h("input", { class: "grow", type: "range", min: 0, max: 1000, value: 0, "aria-label": "Point along the simulated curve", input: () => { pause(); go(slider.value / 1000); } });
  const plot = new Plot(main, "Load against depth", { height: 340, drag: (i) => { if (curve && i !== undefined) { pause(); go(i / Math.max(curve.depth.length - 1, 1)); } } });
  const pressure = new Plot(fields, "Pressure along the radius", { height: 200 }), gap = new Plot(fields, "Gap along the radius", { height: 200 });
  const speeds = new Plot(bySpeed, "Pull-off against speed", { height: 270 }), energy = new Plot(byEnergy, "Where the work goes", { height: 270 });

  const start = button("Simulate", () => store.simulate()), cancel = button("Cancel", () => { store.stop("cancelled"); store.judge(); }, { id: "cancel" });
  const keep = button("Keep to compare", () => store.keep());
  const report = button("Save a report", () => save("report.html", new Blob([reportOf(store, { numbers, tiers, words, plots: [plot, speeds, energy] })], { type: "text/html" })), { id: "save-report" });
  const progress = h("progress", { max: 1, "aria-label": "Progress of the simulation" }), status = h("p", { class: "hint", id: "run", role: "status" });
  main.append(h("p", { class: "hint" }, "Depth of the tip below the undeformed surface: positive pressed in, negative pulled above it. Force is positive when it pushes."),
    h("div", { class: "row" }, play, slider, start, cancel, keep, report), progress, status);
  store.on("quick run verdict", draw);

  function draw() {
    const { quick, run, tables } = store;
    if (!quick) return;
    const done = store.simulated;
    state(run, ["queued", "running"].includes(run.state), run.version !== store.version);
    drawCurves(plot, store);
    fill(drawing, tables, () => { const host = h("div"); host.innerHTML = setUp(tables); return [host]; });
    tell(quick, done);
    compare(quick, done);
    speed(quick, done);
    const verdict = store.now("verdict");
    fill(words, [quick.notes, verdict?.words], () => [...quick.notes, ...(verdict ? verdict.words : ["…"])].map((line) => h("li", {}, shown(line))));
    judged.hidden = store.refused || !words.children.length;
    if (done !== answer) {
      answer = done;
      curve = done && done.curve;
      work(done);
      at = slider.value = 0;
      pause(!done || matchMedia("(prefers-reduced-motion: reduce)").matches);
    }
    show();
  }

  function state(run, growing, stale) {
    progress.hidden = !growing;
    progress.value = run.share;
    cancel.disabled = !growing;
    start.disabled = growing;
    keep.disabled = store.kept.length >= MOST_KEPT;
    const ended = run.answer?.summary.status;
    const text = {
      idle: "", queued: "waiting for a free process", running: `simulating, ${Math.round(100 * run.share)} %`, refused: `no simulation: ${run.error}`,
      cancelled: run.error, stopped: ended, done: stale ? "" : `${ended}; simulated in ${digits(run.took / 1000, 2)} s`,
    }[run.state];
    if (status.textContent !== text) status.textContent = text;
    status.classList.toggle("refused", ["refused", "stopped"].includes(run.state));
  }

  // What belongs to the answer: the work, and the simulation that judges both.
  function tell(quick, done) {
    const { best } = store, { axes } = quick, { pulled } = axes, rows = [];
    numbers.classList.toggle("stale", !best);
    if (!best) return;
    for (const each of best.slice(1)) rows.push([axes[each.name].words, each.value, axes[each.name].unit, bandOf(each)]);
    if (done && best[0]?.method !== "simulation") {
      const { pull, error } = done, [low, high] = best[0]?.interval || [], room = error.force || 0;
      const inside = best[0]?.interval && (pull >= low * (1 - room) && pull <= high * (1 + room) ? "within the band" : "outside the band");
      rows.push([`${pulled.words}, simulated`, pull, pulled.unit, [bandOf({ error: error.force }), inside].filter(Boolean).join(", ")]);
      if (done.work !== null) rows.push([`${axes.work_to_pull_off.words}, simulated`, done.work, axes.work_to_pull_off.unit, bandOf({ error: error.work })]);
    }
    const other = done?.summary.other_peak_force_N ?? done?.summary.other_peak_stress_Pa ?? null;
    if (other !== null) rows.push(["other peak, simulated", other, pulled.unit, ""]);
    fill(numbers, rows, () => rows.map(([name, value, unit, more]) => {
      const number = h("dd", {}, said(value, unit), copied(`Copy the ${name}`, () => `${value} ${unit}`.trim()), more ? h("small", {}, more) : null);
      return h("div", {}, h("dt", {}, name), number);
    }));
  }

  // Every tier with its estimate: first what applies, then what does not, and why.
  function compare(quick, done) {
    const verdict = store.now("verdict"), { words, unit } = quick.axes.pulled;
    compared.classList.toggle("stale", !verdict);
    if (!verdict) return;
    const rows = verdict.tiers.filter(({ tier }) => !done || tier !== "simulation");
    if (done) rows.push({ tier: "simulation", value: done.pull, error: done.error.force, applies: true, why: done.summary.status });
    const groups = Object.entries(quick.groups).filter(([, value]) => typeof value === "number").map(([name, value]) => `${name.replaceAll("_", " ")} ${digits(value)}`);
    const listed = (label, applies) => table(label, ["tier", words, "nine of ten within", "why"], rows.filter((row) => row.applies === applies).map(({ tier, value, error, why }) => [tier === store.best?.[0]?.method ? `${tier} (the answer)` : tier, said(value, unit), error ? `± ${percent(error)}` : "", shown(why)]));
    fill(tiers, [rows, store.best?.[0]?.method], () => [listed("Tiers that apply", true), fold("what does not apply, and why", listed("Tiers that do not apply", false)), h("p", { class: "hint" }, `Without dimensions: ${groups.join(", ")}.`)]);
  }

  function speed(quick, done) {
    const found = store.theory?.speeds, known = store.now("theory"), pull = known && done?.pull, { rig } = store, { axes } = store.theory || quick;
    bySpeed.classList.toggle("stale", !known);
    const series = found ? ofSpeeds(found) : [];
    if (pull && found) series.push({ kind: "points", x: [found.here], y: [pull], colour: "c0", size: 6, words: "this case, simulated" });
    if (rig) series.push(measured(rig));
    speeds.draw({ x: { ...axes.speed, log: true }, y: { ...axes.pulled, least: 0 } }, series, known && !found ? "no theory or surrogate answers at other speeds" : undefined);
    if (!found) return;
    const away = found.speed.map((x) => Math.abs(Math.log(x / found.here)));
    speeds.point(found.here, pull ?? found.force[away.indexOf(Math.min(...away))], "this case");
  }

  function work(done) {
    const moved = store.tables.protocol?.moves, along = done?.curve[moved ? "time" : "depth"];
    const series = Object.entries(done?.energy?.series || {}).map(([name, y]) => ({ kind: "line", x: along, y, words: ENERGY[name][0], colour: ENERGY[name][1], dash: name === "drive" }));
    energy.draw({ x: moved ? { words: "time", unit: "s" } : { words: "depth", unit: "m", turned: true }, y: { words: "energy", unit: done?.energy?.unit || "J" } }, series);
  }

  // What is known at one point of the simulated curve.
  function show() {
    slider.disabled = play.disabled = !curve;
    const i = curve && Math.round(Math.min(at, 1) * (curve.depth.length - 1)), { axes } = store.quick;
    if (curve) {
      const [force, depth] = [said(curve.force[i], axes.force.unit, 3), said(curve.depth[i], "m", 3)];
      plot.point(curve.depth[i], curve.force[i], `${force} at ${depth}`);
      slider.setAttribute("aria-valuetext", `${force} at depth ${depth}`);
    }
    const profiles = answer?.profiles || [], profile = profiles.reduce((best, one) => (best && Math.abs(best.step - i) <= Math.abs(one.step - i) ? best : one), null);
    fill(under, [answer?.summary.run_id, profile?.step, store.run.state === "refused"], () => {
      const reached = profiles.flatMap((one) => one.pressure), far = { least: 0, most: Math.max(0, ...(profiles[0]?.radius || [])) };
      const lines = (y, colour) => (profile ? [{ kind: "line", x: profile.radius, y, colour }] : []);
      pressure.draw({ x: { ...axes.along, ...far }, y: { words: "pressure", unit: "Pa", least: Math.min(...reached), most: Math.max(...reached) } }, lines(profile?.pressure, "c0"));
      gap.draw({ x: { ...axes.along, ...far }, y: { words: "gap", unit: "m", least: 0 } }, lines(profile?.gap, "c2"));
      if (!profile) return [h("p", { class: "hint" }, answer ? "a theory answers here, which has no fields" : store.run.state === "refused" ? "no simulation, no fields" : "comes with the simulation")];
      const host = h("div");
      host.innerHTML = surface(profile, curve.depth[profile.step], axes.length);
      return [host];
    });
  }
}

// Load against depth: by theories, learned, simulated and measured.
export function drawCurves(plot, store) {
  const { quick: { axes, curves: { elastic, edge, surrogate } }, run, rig } = store, stale = run.version !== store.version, growing = ["queued", "running"].includes(run.state);
  const series = [], line = (one, more) => series.push({ kind: "line", x: one.depth, y: one.force, words: one.words, ...more });
  const crack = store.now("theory")?.crack;
  if (elastic) line(elastic, { colour: "c6", dash: true });
  if (crack) line(crack, { colour: "c2", words: `theory: ${crack.words}` });
  else if (edge) line(edge, { colour: "c2", dash: !edge.applies, faint: !edge.applies, beside: !edge.applies, words: `theory: ${edge.words}${edge.applies ? "" : " (does not apply here)"}` });
  if (surrogate) {
    // the interval was measured at the pull-off, and is drawn there
    const { depth, interval, confidence } = surrogate, place = depth.at(-1), reach = 0.22 * (Math.max(...depth) - Math.min(...depth));
    series.push({ kind: "band", x: [place - reach, place + reach], low: [-interval[1], -interval[1]], high: [-interval[0], -interval[0]], colour: "c1", words: `learned: pull-off, ${Math.round(100 * confidence)} % of cases` });
    line(surrogate, { colour: "c1", width: 7, opacity: 0.45 });
  }
  line(run.answer?.curve || run, { colour: "c0", faint: stale, beside: stale, tracked: !stale, width: 2.8, words: stale ? "simulation of the case before" : growing ? "simulation, as it runs" : "simulation of the case" });
  (rig?.curves || []).slice(0, 9).forEach((one, i) => series.push({ kind: "points", x: one.depth, y: one.force, colour: ["c3", "c4", "c5", "ink"][i % 4], size: 1.6, words: `${one.file}, ${said(one.speed_m_s, "m/s", 2)}` }));
  plot.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, series);
}

// The pull-off at other speeds with its band, and what was measured there.
export const ofSpeeds = ({ speed: x, low, high, force: y, words }, colour = words === "surrogate" ? "c1" : "c2") => [{ kind: "band", x, low, high, colour, words: "band of 90 % of cases" }, { kind: "line", x, y, colour, words }];
export const measured = ({ curves }) => ({ kind: "points", x: curves.map((one) => one.speed_m_s), y: curves.map((one) => one.pull_off_force_N), colour: "c3", words: "measured" });
