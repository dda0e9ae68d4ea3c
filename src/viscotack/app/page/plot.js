// Pictures as SVG: axes, lines, bands, points. Colours are those of the library's pictures.

import { digits, prefixOf, said } from "./numbers.js";

const SVG = "http://www.w3.org/2000/svg";
const MARGIN = { left: 62, right: 14, top: 12, bottom: 44 };
const REACH = 60; // pixels from a point within which it is said
let count = 0;

export class Plot {
  // axes: { x: { words, unit, log }, y: { ... } }; title is what a reader of the screen hears.
  constructor(host, title, { height = 300, aspect = 0 } = {}) {
    this.title = title;
    this.height = height;
    this.aspect = aspect;
    this.series = [];
    this.axes = null;
    this.id = `plot${count += 1}`;
    this.card = element("div", "");
    const head = element("div", "head");
    const name = element("h2", "");
    name.textContent = title;
    const exports = element("div", "exports");
    for (const kind of ["SVG", "PNG", "CSV"]) {
      const button = element("button", "");
      button.type = "button";
      button.textContent = kind;
      button.setAttribute("aria-label", `Save ${title} as ${kind}`);
      button.addEventListener("click", () => this.save(kind));
      exports.append(button);
    }
    head.append(name, exports);
    this.svg = document.createElementNS(SVG, "svg");
    this.svg.setAttribute("class", "plot");
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", title);
    this.legend = element("ul", "legend");
    this.card.append(head, this.svg, this.legend);
    host.append(this.card);
    this.svg.addEventListener("pointermove", (event) => this.read(this.nearest(event)));
    this.svg.addEventListener("pointerleave", () => this.read(null));
    this.seen = new ResizeObserver(() => this.paint());
    this.seen.observe(this.card);
  }

  draw(axes, series, extra = {}) {
    this.axes = axes;
    this.series = series.filter((one) => one && one.x.length);
    this.extra = extra;
    this.paint();
  }

  remark(words) {
    this.svg.setAttribute("aria-label", `${this.title}: ${words}`);
  }

  paint() {
    const width = Math.max(Math.round(this.card.clientWidth), 240);
    if (!this.axes || !this.card.clientWidth) return;
    const height = this.height;
    this.size = { width, height };
    if (!this.series.length) {
      this.over = this.hover = null;
      this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      this.svg.setAttribute("height", height);
      this.svg.innerHTML = `<text x="${width / 2}" y="${height / 2}" text-anchor="middle" font-size="13" fill="var(--quiet)">nothing to draw here yet</text>`;
      this.legend.replaceChildren();
      return;
    }
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("height", height);
    const ranges = this.ranges();
    const inner = { x0: MARGIN.left, x1: width - MARGIN.right, y0: height - MARGIN.bottom, y1: MARGIN.top };
    this.toX = toPixels(ranges.x, inner.x0, inner.x1);
    this.toY = toPixels(ranges.y, inner.y0, inner.y1);
    this.inner = inner;
    this.fromX = fromPixels(ranges.x, inner.x0, inner.x1);
    const parts = [`<defs><clipPath id="${this.id}"><rect x="${inner.x0}" y="${inner.y1}" width="${inner.x1 - inner.x0}" height="${inner.y0 - inner.y1}"/></clipPath></defs>`];
    parts.push(this.frame(ranges, inner));
    parts.push(`<g clip-path="url(#${this.id})">`);
    for (const one of this.series) parts.push(this.shape(one));
    parts.push("</g>");
    parts.push(`<g></g><g></g>`);
    this.svg.innerHTML = parts.join("");
    [this.over, this.hover] = [...this.svg.children].slice(-2);
    this.words();
    if (this.cursor) this.point(...this.cursor);
  }

  ranges() {
    const found = {};
    for (const name of ["x", "y"]) {
      const axis = this.axes[name];
      let low = Infinity, high = -Infinity;
      for (const one of this.series) {
        if (one.beside) continue;
        for (const list of name === "x" ? [one.x] : [one.y, one.low, one.high]) {
          if (!list) continue;
          for (const value of list) {
            if (value === null || !isFinite(value) || (axis.log && value <= 0)) continue;
            if (value < low) low = value;
            if (value > high) high = value;
          }
        }
      }
      if (axis.least !== undefined) low = Math.min(low, axis.least);
      if (axis.most !== undefined) high = Math.max(high, axis.most);
      if (!isFinite(low)) [low, high] = axis.log ? [1, 10] : [0, 1];
      if (axis.log) {
        const room = Math.max((high / low) ** 0.03, 1.1);
        [low, high] = [low / room, high * room];
      } else {
        const room = (high - low || Math.abs(high) || 1) * 0.06;
        low -= room; high += room;
      }
      const { factor, unit } = axis.log ? prefixOf(high / low < 1e6 ? Math.sqrt(low * high) : 1, axis.unit) : prefixOf(Math.max(Math.abs(low), Math.abs(high)) / 1.06, axis.unit);
      found[name] = { low, high, log: !!axis.log, turned: !!axis.turned, factor, unit };
    }
    return found;
  }

  frame(ranges, inner) {
    const parts = [];
    for (const tick of ticksOf(ranges.x, Math.floor((inner.x1 - inner.x0) / 80))) {
      const x = round(this.toX(tick));
      parts.push(`<path d="M${x} ${inner.y1}V${inner.y0}" stroke="var(--grid)"/><path d="M${x} ${inner.y0}v6" stroke="var(--ink)"/>`);
      parts.push(`<text x="${x}" y="${inner.y0 + 19}" text-anchor="middle" font-size="12" fill="var(--ink)">${label(tick, ranges.x)}</text>`);
    }
    for (const tick of ticksOf(ranges.y, Math.max(Math.floor((inner.y0 - inner.y1) / 45), 4))) {
      const y = round(this.toY(tick));
      parts.push(`<path d="M${inner.x0} ${y}H${inner.x1}" stroke="var(--grid)"/><path d="M${inner.x0} ${y}h-6" stroke="var(--ink)"/>`);
      parts.push(`<text x="${inner.x0 - 9}" y="${y + 4}" text-anchor="end" font-size="12" fill="var(--ink)">${label(tick, ranges.y)}</text>`);
    }
    if (!ranges.y.log && ranges.y.low < 0 && ranges.y.high > 0) {
      const y = round(this.toY(0));
      parts.push(`<path d="M${inner.x0} ${y}H${inner.x1}" stroke="var(--c6)"/>`);
    }
    parts.push(`<path d="M${inner.x0} ${inner.y1}V${inner.y0}H${inner.x1}" fill="none" stroke="var(--ink)" stroke-width="1.2"/>`);
    parts.push(`<text x="${(inner.x0 + inner.x1) / 2}" y="${inner.y0 + 38}" text-anchor="middle" font-size="13" fill="var(--ink)">${named(this.axes.x, ranges.x)}</text>`);
    const middle = (inner.y0 + inner.y1) / 2;
    parts.push(`<text transform="translate(13 ${middle}) rotate(-90)" text-anchor="middle" font-size="13" fill="var(--ink)">${named(this.axes.y, ranges.y)}</text>`);
    return parts.join("");
  }

  shape(one) {
    const colour = `var(--${one.colour || "c0"})`, faint = one.faint ? ' opacity="0.35"' : "";
    if (one.kind === "band") {
      const there = one.x.map((x, i) => [x, one.low[i], one.high[i]]).filter((row) => row.every((v) => v !== null));
      const up = there.map(([x, , high]) => `${round(this.toX(x))} ${round(this.toY(high))}`);
      const down = there.map(([x, low]) => `${round(this.toX(x))} ${round(this.toY(low))}`).reverse();
      return up.length ? `<path d="M${up.join("L")}L${down.join("L")}Z" fill="${colour}" opacity="0.28"/>` : "";
    }
    if (one.kind === "points") {
      const size = one.size || (one.x.length > 80 ? 2 : 4);
      return one.x.map((x, i) => (x === null || one.y[i] === null || !isFinite(this.toY(one.y[i])) ? "" : mark(round(this.toX(x)), round(this.toY(one.y[i])), size, colour, one.filled))).join("");
    }
    let path = "", open = false;
    for (let i = 0; i < one.x.length; i += 1) {
      const x = one.x[i], y = one.y[i];
      const there = x !== null && y !== null && isFinite(x) && isFinite(y) && !(this.axes.y.log && y <= 0);
      if (there) path += `${open ? "L" : "M"}${round(this.toX(x))} ${round(this.toY(y))}`;
      open = there;
    }
    const soft = one.soft ? ' opacity="0.45"' : "";
    const dash = one.dash ? ' stroke-dasharray="6 4"' : "";
    return path ? `<path d="${path}" fill="none" stroke="${colour}" stroke-width="${one.width || 2.2}" stroke-linejoin="round"${dash}${faint}${soft}/>` : "";
  }

  // The point of lines and points that is nearest to the pointer: its series and place, null where there is none.
  nearest(event, series = this.series) {
    if (!this.over) return null;
    const box = this.svg.getBoundingClientRect(), scale = this.size.width / box.width;
    const x = (event.clientX - box.left) * scale, y = (event.clientY - box.top) * scale;
    let found = null, least = Infinity;
    for (const one of series) {
      if (one.kind === "band") continue;
      for (let i = 0; i < one.x.length; i += 1) {
        if (one.x[i] === null || one.y[i] === null) continue;
        const far = Math.hypot(this.toX(one.x[i]) - x, this.toY(one.y[i]) - y);
        if (far < least) { least = far; found = { one, i, far }; }
      }
    }
    return found;
  }

  // Say the numbers of a point under the pointer, and what it is a point of.
  read(found) {
    if (!this.hover) return;
    if (!found || found.far > REACH) { this.hover.innerHTML = ""; return; }
    const { one, i } = found, { x, y } = this.axes;
    const px = round(this.toX(one.x[i])), py = round(this.toY(one.y[i]));
    const lines = [`${said(one.y[i], y.unit)} at ${said(one.x[i], x.unit)}`, one.words || ""];
    const [side, anchor] = px > this.size.width / 2 ? [-10, "end"] : [10, "start"], top = py < this.inner.y1 + 40 ? py + 24 : py - 26;
    this.hover.innerHTML = `<circle cx="${px}" cy="${py}" r="4" fill="var(--ink)"/>` + lines.map((words, row) => lettered(px + side, top + 15 * row, words, anchor)).join("");
  }

  // Mark a point, in SI, above everything.
  point(x, y, words = "") {
    this.cursor = [x, y, words];
    if (!this.over || x === null || y === null) return;
    const px = round(this.toX(x)), py = round(this.toY(y));
    const side = px > this.size.width * 0.6 ? -12 : 12;
    this.over.innerHTML = `<circle cx="${px}" cy="${py}" r="7" fill="var(--paper)" stroke="var(--c0)" stroke-width="3"/>`
      + (words ? lettered(px + side, Math.max(py - 12, 16), words, side < 0 ? "end" : "start") : "");
  }

  words() {
    this.legend.replaceChildren(...this.series.filter((one) => one.words).map((one) => {
      const item = element("li", one.kind === "band" ? "band" : one.kind === "points" ? "dot" : one.dash ? "dash" : "");
      const line = element("span", "");
      line.style.borderColor = `var(--${one.colour || "c0"})`;
      if (one.faint) item.style.opacity = 0.75;
      item.append(line, document.createTextNode(one.words));
      return item;
    }));
  }

  text() {
    const style = getComputedStyle(document.documentElement);
    const { width, height } = this.size;
    const inner = this.svg.innerHTML.replaceAll(/var\(--([a-z0-9]+)\)/g, (_, name) => style.getPropertyValue(`--${name}`).trim());
    const rows = [...this.legend.children].map((item, i) => {
      const colour = getComputedStyle(item.firstChild).borderTopColor;
      return `<g transform="translate(${MARGIN.left} ${height + 14 + 18 * i})"><path d="M0 -4h24" stroke="${colour}" stroke-width="3"/><text x="32" font-size="12" fill="${style.getPropertyValue("--ink").trim()}">${escape(item.textContent)}</text></g>`;
    });
    const whole = height + 18 * rows.length + 8;
    return `<svg xmlns="${SVG}" width="${width}" height="${whole}" viewBox="0 0 ${width} ${whole}" font-family="sans-serif"><rect width="100%" height="100%" fill="${style.getPropertyValue("--paper").trim()}"/>${inner}${rows.join("")}</svg>`;
  }

  csv() {
    const heads = [], columns = [];
    const { x, y } = this.axes;
    for (const one of this.series) {
      const name = (one.words || "series").replaceAll(/[",\n]/g, " ");
      const lists = one.kind === "band" ? [["low", one.low], ["high", one.high]] : [[y.words, one.y]];
      heads.push(`"${name}: ${x.words}${x.unit ? ` [${x.unit}]` : ""}"`);
      columns.push(one.x);
      for (const [what, list] of lists) {
        heads.push(`"${name}: ${what}${y.unit ? ` [${y.unit}]` : ""}"`);
        columns.push(list);
      }
    }
    const longest = Math.max(0, ...columns.map((list) => list.length));
    const rows = Array.from({ length: longest }, (_, i) => columns.map((list) => list[i] ?? "").join(","));
    return [heads.join(","), ...rows].join("\n") + "\n";
  }

  async save(kind) {
    const name = this.title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-");
    if (!this.size) return;
    if (kind === "CSV") return save(`${name}.csv`, new Blob([this.csv()], { type: "text/csv" }));
    const text = this.text(), svg = new Blob([text], { type: "image/svg+xml" });
    if (kind === "SVG") return save(`${name}.svg`, svg);
    const picture = new Image(), source = URL.createObjectURL(svg);
    picture.src = source;
    await picture.decode();
    const canvas = document.createElement("canvas");
    canvas.width = 2 * picture.width; canvas.height = 2 * picture.height;
    canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(source);
    canvas.toBlob((blob) => save(`${name}.png`, blob));
  }
}

export function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export function element(name, className, text = "") {
  const found = document.createElement(name);
  if (className) found.className = className;
  if (text) found.textContent = text;
  return found;
}

export function escape(text) {
  return String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}

function lettered(x, y, words, anchor) {
  return `<text x="${x}" y="${y}" text-anchor="${anchor}" font-size="13" font-weight="600" fill="var(--ink)" stroke="var(--paper)" stroke-width="4" paint-order="stroke">${escape(words)}</text>`;
}

function mark(x, y, size, colour, filled) {
  return `<circle cx="${x}" cy="${y}" r="${size}" fill="${filled ? colour : "var(--paper)"}" stroke="${colour}" stroke-width="1.5"/>`;
}

function round(value) {
  return Math.round(value * 10) / 10;
}

function toPixels({ low, high, log, turned }, from, to) {
  if (turned) [from, to] = [to, from];
  if (log) {
    const a = Math.log(low), b = Math.log(high);
    return (value) => from + (to - from) * (Math.log(value) - a) / (b - a);
  }
  return (value) => from + (to - from) * (value - low) / (high - low);
}

function fromPixels({ low, high, log, turned }, from, to) {
  if (turned) [from, to] = [to, from];
  if (log) return (pixel) => low * (high / low) ** ((pixel - from) / (to - from));
  return (pixel) => low + (high - low) * (pixel - from) / (to - from);
}

function ticksOf({ low, high, log, factor }, most) {
  if (log) {
    const first = Math.ceil(Math.log10(low / factor) - 1e-9), last = Math.floor(Math.log10(high / factor) + 1e-9);
    const every = Math.max(1, Math.ceil((last - first + 1) / Math.max(most, 2)));
    const found = [];
    for (let i = first; i <= last; i += every) found.push(10 ** i * factor);
    if (found.length > 1) return found;
  }
  const span = (high - low) / factor / Math.max(most, 2);
  const power = 10 ** Math.floor(Math.log10(span));
  const step = [1, 2, 5, 10].map((x) => x * power).find((x) => x >= span) * factor;
  const found = [];
  for (let i = Math.ceil(low / step); i * step <= high; i += 1) found.push(i * step);
  return found;
}

function label(tick, { factor, log }) {
  const value = tick / factor;
  const power = Math.log10(value);
  if (log && Math.abs(power - Math.round(power)) < 1e-6 && (value >= 1e4 || value < 1e-2)) return `10<tspan dy="-5" font-size="9">${Math.round(power)}</tspan>`;
  return digits(Math.abs(value) < 1e-12 ? 0 : value, 3);
}

// The axis of depth is turned, so that a test goes to the right as it does in time.
function named(axis, { unit }) {
  const words = escape(unit ? `${axis.words} [${unit}]` : axis.words);
  return axis.turned ? `← pressed in \u2003 ${words} \u2003 pulled up →` : words;
}
