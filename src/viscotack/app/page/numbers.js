// Numbers with units, written as viscotack.units writes them: every text of a quantity is made here.

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];
const PREFIXED = ["N", "N/m", "Pa", "J", "J/m^2", "J/m2", "J/m", "J/mol", "m/N", "N/s", "Hz", "s", "m", "m/s"];
const NOT_ABOVE_ONE = ["s", "m", "m/s"];

// The prefix in which a number of this size is at least 1.
export function prefixOf(largest, unit) {
  const size = Math.abs(largest);
  if (!PREFIXED.includes(unit) || !(size >= 1e-15 && size < 1e12)) return { factor: 1, unit: unit === "1" ? "" : unit || "" };
  const known = PREFIXES.filter(([factor]) => factor <= 1 || !NOT_ABOVE_ONE.includes(unit));
  const [factor, word] = known.find(([f]) => size >= f) || known[known.length - 1];
  return { factor, unit: word + unit };
}

export function digits(value, count = 4) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  const rounded = Number(value.toPrecision(count)), size = Math.abs(rounded);
  if (size >= 10 ** Math.max(count, 4) || (size < 1e-4 && size > 0)) return rounded.toExponential().replace(/e([+-])(\d)$/, "e$10$2");
  return String(rounded);
}

// A number in SI with a prefix: "4.668 mN".
export function said(value, unit, count = 4) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  const { factor, unit: word } = prefixOf(Number(value.toPrecision(count)), unit);
  return `${digits(value / factor, count)} ${word}`.trim();
}

// An interval with one prefix, and at least two digits of its width.
export function between(low, high, unit) {
  const width = high - low, size = Math.max(Math.abs(low), Math.abs(high));
  const count = width > 0 && width < size ? Math.max(3, Math.min(2 + Math.ceil(Math.log10(size / width)), 8)) : 3;
  if (low !== 0 && 1000 * Math.abs(low) < Math.abs(high)) return `${said(low, unit, count)} to ${said(high, unit, count)}`;
  const { factor, unit: word } = prefixOf(Number(size.toPrecision(count)), unit);
  const [first, last] = [low, high].map((x) => digits(x / factor, count));
  return `${first}${first === last ? "" : ` to ${last}`} ${word}`.trim();
}

export function percent(share) {
  return `${digits(100 * share, 2)} %`;
}

// The axis of what a case is pulled off by: the force of a sphere or the stress of a punch.
export function pulled({ axes }) {
  const name = "pull_off_force" in axes ? "pull_off_force" : "pull_off_stress";
  return { name, ...axes[name] };
}

// What was simulated of it, from the summary of a simulation.
export function pulledBy(summary) {
  return summary.pull_off_force_N ?? summary.pull_off_stress_Pa;
}

export function workOf(summary) {
  return summary.work_to_pull_off_J ?? summary.work_to_pull_off_J_per_m2;
}

// What a user typed, as it is shown: keyboards have a "u" for micro.
export function shown(text) {
  return String(text ?? "–").replace(/(\d\s*)u(?=[mNsJP])/g, "$1µ");
}

const QUANTITY = /^\s*([a-z]+ )?\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*((?![,.\d]).*?)\s*$/i;

// "apart 20 um" -> its word and number, in SI where its unit is the given one with a prefix, else in
// the unit it has; null where it is no number.
export function read(text, unit) {
  const found = QUANTITY.exec(String(text));
  if (!found) return null;
  const plain = (word) => word.replace("^", "").replace(/^u/, "µ");
  const prefix = PREFIXES.find(([, word]) => word + plain(unit) === plain(found[3]));
  const number = Number(found[2]);
  if (unit === "1" && !found[3]) return { word: found[1] || "", number, unit, si: true };
  return prefix ? { word: found[1] || "", number: Number((number * prefix[0]).toPrecision(12)), unit, si: true } : { word: found[1] || "", number, unit: found[3], si: false };
}

export function written({ word, number, unit, si }) {
  if (!word && (!unit || unit === "1")) return Number(number.toPrecision(4));
  return word + (si ? quantity(number, unit) : `${Number(number.toPrecision(4))} ${unit}`.trim());
}

// A number in SI as a file states it.
export function quantity(number, unit) {
  return said(number, unit).replace("µ", "u");
}

// The slider of a field: from the least to the most that its card allows, in about a hundred steps; where only
// the sign is known, over four decades around its example in steps of 12 % (20 a decade, the series R20); else to
// twice the number on both sides. A number beyond widens the slider; one that is not allowed has none. `at` turns a place into a number, `of` a
// number into a place.
export function sliderOf(card, quantity) {
  const low = card.least ?? card.above, high = card.most;
  const example = quantity.si ? Math.abs(read(card.example, card.unit)?.number) || quantity.number : quantity.number;
  if (low !== null && high !== null) {
    const step = roundStep(high - low);
    return linear(card.least === null ? low + step : low, high, step);
  }
  if (low !== null && quantity.number <= low) return null;
  if (low !== null && low >= 0) {
    const middle = Math.floor(Math.log10(example));
    const first = Math.min(middle - 2, Math.floor(Math.log10(quantity.number)));
    const last = Math.max(middle + 2, Math.ceil(Math.log10(quantity.number)));
    return { min: 20 * first, max: 20 * last, step: 1, ends: [10 ** first, 10 ** last], at: (x) => Number((10 ** (x / 20)).toPrecision(2)), of: (v) => 20 * Math.log10(v) };
  }
  const reach = 2 * Math.max(example, Math.abs(quantity.number)) || 1, step = roundStep(2 * reach);
  return linear(-Math.ceil(reach / step) * step, Math.ceil(reach / step) * step, step);
}

function linear(first, last, step) {
  const at = (x) => Number((Number(x)).toPrecision(6));
  return { min: at(first), max: at(last), step, ends: [at(first), at(last)], at, of: (v) => v };
}

function roundStep(span) {
  const power = 10 ** Math.floor(Math.log10(span / 50));
  return Number(([5, 2, 1].find((x) => x * power <= span / 50) * power).toPrecision(1));
}
