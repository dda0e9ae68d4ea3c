// The page without Python: the exported surrogate, evaluated by ONNX Runtime Web in the browser.

import * as ort from "./ort.wasm.bundle.min.mjs";
import { Answer, bandOf } from "./answer.js";
import { learned, setUp } from "./drawing.js";
import { Fields, plain } from "./fields.js";
import { digits, read, said } from "./numbers.js";
import { Plot, element } from "./plot.js";
import { theme } from "./theme.js";

// Largest contact radius, and radius where the gap is the range of the forces, over the radius of the sphere.
const LARGEST = 0.5;
const SPEEDS = 41, DECADES = 4, REST = 80;
const TITLES = { sphere: "Indenter", protocol: "Test", material: "Material", interface: "Interface" };
const UNITS = { preload: ["h0", "h0"], rate: ["h0/tau0", "speed"] };

class Refused extends Error {}

// SI numbers of the fields, checked as their cards demand; a refusal names table and key, as those of the package do.
export function numbersOf(tables, { fields, plausible }) {
  const found = {};
  for (const [table, cards] of Object.entries(fields)) {
    for (const card of cards) {
      const text = tables[table]?.[card.key] ?? "", number = read(text, card.unit);
      const fail = (words) => { throw new Refused(`[${table}] ${card.key} ${words}, got '${text}'`); };
      if (!number || !number.si || number.word) fail(card.unit === "1" ? "must be a number" : `must be a number with the unit ${card.unit}, such as '${card.example}'`);
      const { number: value } = number;
      if ((card.above !== null && value <= card.above) || (card.least !== null && value < card.least) || (card.most !== null && value > card.most)) fail(`must ${card.range}`);
      const [least, most] = plausible[card.unit] || [0, Infinity];
      if (value && (Math.abs(value) < least || Math.abs(value) > most)) fail(`must lie between ${least} and ${most} ${card.unit}`);
      found[card.key] = value;
    }
  }
  const { radius: R, preload_depth: depth, rubbery_modulus: E0, glassy_modulus: E1, work_of_adhesion: w, equilibrium_gap: h0 } = found;
  if (E1 < E0) throw new Refused("[material] glassy_modulus (short times) must not be below rubbery_modulus (long times); check whether they are interchanged");
  found.contact_modulus = E0 / (1 - found.poisson_ratio ** 2);
  // JKR at a contact radius of half that of the sphere
  if (depth > LARGEST * LARGEST * R - Math.sqrt(2 * Math.PI * LARGEST * R * w / found.contact_modulus)) throw new Refused(`[protocol] preload_depth exceeds small strain: the relaxed contact radius may be up to ${LARGEST} sphere radii`);
  if (Math.sqrt(2 * R * h0) > LARGEST * R) throw new Refused(`[interface] equilibrium_gap is too long for this sphere: it may be up to ${LARGEST ** 2 / 2} radii`);
  return found;
}

// The five groups, in the order of the model, and the units of its outputs in SI.
export function groupsOf({ radius: R, preload_depth, speed, rubbery_modulus: E0, glassy_modulus: E1, exponent, tau0, contact_modulus: E, work_of_adhesion: w, equilibrium_gap: h0 }) {
  const force = 1.5 * Math.PI * R * w;
  return {
    groups: { tabor: Math.cbrt(R * w * w / (E * E * h0 ** 3)), modulus_ratio: E0 / E1, exponent, preload: preload_depth / h0, rate: speed * tau0 / h0 },
    scales: { h0, force, work: force * h0, radius: Math.cbrt(Math.PI * R * R * w / E), speed: h0 / tau0 },
  };
}

// Evaluate rows of groups: the outputs of the model by name, each a row of its own.
async function evaluate(session, rows) {
  const given = Float64Array.from(rows.flatMap((row) => Object.values(row)));
  const found = await session.run({ groups: new ort.Tensor("float64", given, [rows.length, 5]) });
  return rows.map((_, i) => Object.fromEntries(Object.entries(found).map(([name, { data, dims }]) => {
    const wide = dims.length > 1 ? dims[1] : 1;
    return [name, dims.length > 1 ? Array.from(data.slice(i * wide, (i + 1) * wide)) : data[i]];
  })));
}

// What the surrogate answers: numbers in SI with their intervals, or why there is none.
function answered(said_, { groups, scales }, limits, confidence) {
  const out = Object.keys(groups).filter((_, i) => !said_.inside[i]);
  if (out.length) return { numbers: [], why: `Outside the training range: ${out.map((name) => outOf(name, groups[name], limits[name], scales)).join("; ")}.` };
  const { force, work } = scales, many = (values, scale) => values.map((x) => x * scale);
  const [force_doubtful, work_doubtful] = said_.doubtful;
  if (force_doubtful) return { numbers: [], why: "The networks are not certain here: two independent ones disagree, or the interval is wide. viscotack predict simulates such a case." };
  const number = (name, value, interval, scale) => ({ name, value: value * scale, interval: many(interval, scale), confidence, method: "surrogate", why: "every input is in the training range" });
  const numbers = [number("pull_off_force", said_.pull_off_force, said_.force_interval, force)];
  if (work_doubtful) return { numbers, why: "No work and no curve: the networks are not certain of the work here." };
  numbers.push(number("work_to_pull_off", said_.work_to_pull_off, said_.work_interval, work));
  const curve = { words: "learned from 30,000 simulations", depth: many(said_.curve_depth, scales.h0), force: many(said_.curve_force, force), radius: many(said_.curve_contact_radius, scales.radius), interval: numbers[0].interval, confidence, band: said_.curve_band * said_.pull_off_force * force };
  return { numbers, curve, why: "" };
}

function outOf(name, value, [least, most], scales) {
  const [unit, scale] = UNITS[name] || ["", ""], own = scale ? ` (${said(value * scales[scale], scale === "h0" ? "m" : "m/s", 3)})` : "";
  return `${name.replaceAll("_", " ")} is ${digits(value)} ${unit}`.trimEnd() + `${own}, and may be ${digits(least)} to ${digits(most)} ${unit}`.trimEnd();
}

// The case and its answer, as the parts of the page want them.
class Case extends EventTarget {
  constructor(facts, session) {
    super();
    Object.assign(this, { facts, session, tables: {}, version: 0, refused: "", best: null, run: {}, verdict: null, quick: null });
  }

  say(name) {
    this.dispatchEvent(new CustomEvent(name));
  }

  set(table, key, value) {
    const tables = structuredClone(this.tables);
    if (value === null || value === "") delete tables[table][key];
    else tables[table][key] = value;
    this.take(tables);
  }

  take(tables) {
    this.tables = tables;
    this.version += 1;
    this.best = null;
    clearTimeout(this.resting);
    this.say("case");
    this.answer();
  }

  async answer() {
    if (this.asking) return; // the last case is answered when the one before has been
    this.asking = true;
    const { version, facts } = this;
    let asked = null;
    try {
      asked = groupsOf(numbersOf(this.tables, facts));
      this.refused = "";
      this.link();
      const [found] = await evaluate(this.session, [asked.groups]);
      this.found = { ...answered(found, asked, facts.limits, facts.confidence), ...asked, speeds: null };
      this.verdict = { refused: this.found.why };
      this.quick = { axes: facts.axes };
    } catch (error) {
      if (!(error instanceof Refused)) throw error;
      this.refused = error.message;
    } finally {
      this.asking = false;
    }
    if (version !== this.version) { this.answer(); return; }
    this.best = this.refused ? null : this.found.numbers;
    this.say("quick");
    if (!this.refused && this.best.length) this.resting = setTimeout(() => this.sweep(asked), REST);
  }

  // Forces at other speeds, within the range of the surrogate.
  async sweep({ groups, scales }) {
    if (this.asking) return;
    this.asking = true;
    const { version } = this, [low, high] = this.facts.limits.rate;
    const first = Math.log10(Math.max(low * 1.0001, groups.rate * 10 ** -DECADES)), last = Math.log10(Math.min(high / 1.0001, groups.rate * 10 ** DECADES));
    const rates = Array.from({ length: SPEEDS }, (_, i) => 10 ** (first + (last - first) * i / (SPEEDS - 1)));
    const found = await evaluate(this.session, rates.map((rate) => ({ ...groups, rate })));
    this.asking = false;
    if (version !== this.version) { this.answer(); return; }
    const force = (pick) => found.map((one) => (one.doubtful[0] ? null : pick(one) * scales.force));
    this.found.speeds = { speed: rates.map((rate) => rate * scales.speed), force: force((x) => x.pull_off_force), low: force((x) => x.force_interval[0]), high: force((x) => x.force_interval[1]), here: groups.rate * scales.speed };
    this.say("speeds");
  }

  // The query of the address is the case, with the names that `viscotack app` has.
  link() {
    const query = new URLSearchParams();
    for (const [table, keys] of Object.entries(this.tables)) for (const [key, value] of Object.entries(keys)) query.append(`${table}.${key}`, value);
    history.replaceState(null, "", `?${query}${location.hash}`);
  }

  get toml() {
    return Object.entries(this.tables).map(([table, keys]) => `[${table}]\n${Object.entries(keys).map(([key, value]) => `${key} = ${JSON.stringify(value)}\n`).join("")}`).join("\n");
  }
}

class Asked extends Fields {
  make() {
    this.all = [];
    const { fields } = this.store.facts;
    this.form.replaceChildren(...Object.entries(TITLES).map(([table, title]) => {
      const set = this.group(title);
      set.append(...fields[table].map((field) => this.row(table, field)));
      return set;
    }));
  }
}

class View {
  constructor(store) {
    this.store = store;
    this.curve = new Plot(document.getElementById("curve"), "Load against depth", { height: 300 });
    this.speeds = new Plot(document.getElementById("speeds"), "Pull-off against speed", { height: 300 });
    document.getElementById("curve").append(document.querySelector("#curve > .hint"));
    store.addEventListener("case", () => this.dim(true));
    store.addEventListener("quick", () => this.draw());
    store.addEventListener("speeds", () => this.sweep());
  }

  dim(is) {
    for (const id of ["numbers", "curve", "speeds"]) document.getElementById(id).classList.toggle("stale", is);
  }

  draw() {
    const { store } = this, { facts: { axes } } = store;
    document.body.dataset.drawn = store.version;
    if (store.refused) return;
    this.dim(false);
    const { found, best } = store, { curve, scales, groups, why } = found;
    const rows = best.slice(1).map((each) => [axes[each.name].words, said(each.value, axes[each.name].unit), bandOf(each, axes[each.name].unit)]);
    if (curve) {
      const last = curve.depth.length - 1;
      rows.push(["force of the start", said(curve.force[0], "N"), curve.force[0] > 0 ? "pressed" : "in tension"], ["contact radius of the start", said(curve.radius[0], "m"), ""]);
      rows.push(["depth at pull-off", said(curve.depth[last], "m"), ""], ["contact radius at pull-off", said(curve.radius[last], "m"), ""]);
    }
    document.getElementById("numbers").replaceChildren(...rows.map(([words, value, more]) => {
      const box = element("div", ""), number = element("dd", "", value);
      if (more) number.append(element("small", "", more));
      box.append(element("dt", "", words), number);
      return box;
    }));
    const told = Object.entries(groups).map(([name, value]) => `${name.replaceAll("_", " ")} ${digits(value)}`).join(", ");
    document.getElementById("groups").textContent = `${best.length && why ? `${why} ` : ""}Without dimensions: ${told}.`;
    this.curve.draw({ x: { ...axes.depth, turned: true }, y: axes.force }, curve ? learned(curve) : []);
    if (best[0]) this.curve.remark(`pull-off force ${said(best[0].value, "N")}`);
    const start = curve ? { depth: curve.depth[0], radius: curve.radius[0] } : null;
    document.querySelector("#set-up > div").innerHTML = setUp(store.tables, { start });
    document.getElementById("toml").textContent = store.toml;
    if (!best.length) this.sweep();
  }

  sweep() {
    const { facts: { axes }, found, best } = this.store, { speeds } = found;
    const series = speeds ? [
      { kind: "band", x: speeds.speed, low: speeds.low, high: speeds.high, colour: "c1", words: "band of 90 % of cases" },
      { kind: "line", x: speeds.speed, y: speeds.force, colour: "c1", words: "surrogate" },
    ] : [];
    this.speeds.cursor = null;
    this.speeds.draw({ x: { words: "retraction speed", unit: "m/s", log: true }, y: { ...axes.pull_off_force, least: 0 } }, series);
    if (speeds) this.speeds.point(speeds.here, best[0].value, "this case");
  }
}

// The case of the address, else the example: with the tables and keys of the fields and no others.
function stated(facts) {
  const query = new URLSearchParams(location.search), tables = structuredClone(facts.example);
  const known = [...query].filter(([name]) => name.includes("."));
  if (!known.length) return tables;
  for (const [table, cards] of Object.entries(facts.fields)) for (const { key } of cards) {
    const text = query.get(`${table}.${key}`);
    if (text === null) delete tables[table][key];
    else tables[table][key] = plain(text);
  }
  return tables;
}

async function begin() {
  theme();
  ort.env.wasm.numThreads = 1;
  const [facts, session] = await Promise.all([
    fetch("facts.json").then((answer) => answer.json()),
    ort.InferenceSession.create("tack.onnx", { executionProviders: ["wasm"] }),
  ]);
  const store = new Case(facts, session);
  window.viscotack = store;
  new Answer(document.getElementById("best"), store);
  new Asked(document.getElementById("fields"), store);
  new View(store);
  store.take(stated(facts));
}

begin().catch((error) => {
  const words = document.getElementById("refused");
  words.hidden = false;
  words.textContent = `The page could not begin: ${error.message}. It must be served over HTTP, by a browser that has WebAssembly.`;
});
