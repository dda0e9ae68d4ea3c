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

export const percent = (share) => `${digits(100 * share, 2)} %`;
// A number in SI as a file states it: keyboards have a "u" for micro.
export const quantity = (number, unit) => said(number, unit).replace("µ", "u");

const QUANTITY = /^\s*([a-z]+ )?\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*((?![,.\d]).*?)\s*$/i;
// A fit states all digits of a number in SI, more than there is room for: the state keeps them.
export function shown(text) {
  const [, word = "", number = "", unit] = QUANTITY.exec(text) || [];
  return (/\.0$|e-|.{9}/.test(number) ? word + said(Number(number), unit, 6) : String(text ?? "–")).replace(/(\d\s*)u(?=[mNsJP])/g, "$1µ");
}

// A move of a machine in words: a file may state it as a table, { approach = "10 um/s", to_force = "1 mN" }.
export const moveOf = (move) => (move.constructor === Object ? Object.entries(move).flat().join(" ").replaceAll("_", " ") : move);

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

// The slider of a field: from the least to the most that its schema allows, in about a hundred steps; where only
// the sign is known, over four decades around its example in steps of 12 % (20 a decade, the series R20); else to
// twice the number on both sides. A number beyond widens the slider; one that is not allowed has none. `at` turns a
// place into a number, `of` a number into a place.
export function sliderOf(card, { number, si }) {
  const low = card.minimum ?? card.exclusiveMinimum, high = card.maximum, example = (si && Math.abs(read(card.examples[0], card.unit)?.number)) || number;
  const steps = (span) => { const power = 10 ** Math.floor(Math.log10(span / 50)); return Number(([5, 2, 1].find((x) => x * power <= span / 50) * power).toPrecision(1)); };
  if (low !== undefined && high !== undefined) {
    const step = steps(high - low);
    return linear(card.minimum === undefined ? low + step : low, high, step);
  }
  if (number <= low) return null;
  if (low === undefined || low < 0) {
    const reach = 2 * Math.max(example, Math.abs(number)) || 1, step = steps(2 * reach), end = Math.ceil(reach / step) * step;
    return linear(-end, end, step);
  }
  const middle = Math.floor(Math.log10(example)), first = Math.min(middle - 2, Math.floor(Math.log10(number))), last = Math.max(middle + 2, Math.ceil(Math.log10(number)));
  return { min: 20 * first, max: 20 * last, step: 1, ends: [10 ** first, 10 ** last], at: (x) => Number((10 ** (x / 20)).toPrecision(2)), of: (v) => 20 * Math.log10(v) };
}

function linear(first, last, step) {
  const at = (x) => Number(Number(x).toPrecision(6)), ends = [at(first), at(last)];
  return { min: ends[0], max: ends[1], step, ends, at, of: (v) => v };
}
