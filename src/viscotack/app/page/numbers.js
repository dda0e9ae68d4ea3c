// Numbers with units: read, written with a prefix, and moved by a slider.

const PREFIXES = [[1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"], [1e-12, "p"]];

// The prefix in which numbers up to this one are easily read.
export function prefixOf(largest, unit) {
  if (!unit || unit === "1" || unit === "Hz" || unit === "°C" || unit === "%") return { factor: 1, unit: unit === "1" ? "" : unit };
  // 0.9999 um/s is about one, and is said as one
  const size = Math.abs(largest) * 1.0005;
  const [factor, word] = PREFIXES.find(([f]) => size >= f) || PREFIXES[PREFIXES.length - 1];
  return { factor, unit: word + unit };
}

export function digits(value, count = 4) {
  if (value === null || value === undefined || !isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(count - 1).replace("e+", "e");
  return String(Number(value.toPrecision(count)));
}

// A number in SI with a prefix: "4.668 mN".
export function said(value, unit, count = 4) {
  if (value === null || value === undefined) return "–";
  const { factor, unit: word } = prefixOf(value, unit);
  return `${digits(value / factor, count)} ${word}`.trim();
}

// The axis of what a case is pulled off by: the force of a sphere or the stress of a punch.
export function pulled({ axes }) {
  return axes.pull_off_force ?? axes.pull_off_stress;
}

const QUANTITY = /^\s*([a-z]+ )?\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*(.*?)\s*$/i;

// "apart 20 um" -> its word, number and unit; null where it is none.
export function read(text) {
  const found = QUANTITY.exec(String(text));
  return found && { word: found[1] || "", number: Number(found[2]), unit: found[3] };
}

export function written({ word, number, unit }) {
  const text = `${word}${Number(number.toPrecision(4))}${unit ? " " + unit : ""}`;
  return word || unit ? text : Number(number.toPrecision(4));
}

// What a slider from 0 to 1000 does to a number: through its range where there is one, else by
// factors of up to 100 around the number that it began with, or to twice of it on both sides.
export function scaleOf(card, base) {
  const low = card.least ?? card.above, high = card.most;
  if (low !== null && low !== undefined && high !== null && high !== undefined) {
    const least = card.least === null ? low + (high - low) / 1000 : low;
    return { at: (x) => least + (high - least) * x / 1000, of: (v) => 1000 * (v - least) / (high - least) };
  }
  if (low === 0 && base > 0) {
    return { at: (x) => base * 10 ** (x / 250 - 2), of: (v) => 250 * (Math.log10(v / base) + 2) };
  }
  const reach = 2 * Math.abs(base) || 1;
  return { at: (x) => -reach + 2 * reach * x / 1000, of: (v) => 1000 * (v + reach) / (2 * reach) };
}
