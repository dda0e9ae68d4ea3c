// Pictures as SVG: axes, lines, bands, points. Colours are those of the library's pictures.

import { button, escape, h, save } from "./dom.js";
import { digits, prefixOf, said } from "./numbers.js";

const LEFT = 62, RIGHT = 14, TOP = 12, BOTTOM = 44;
const REACH = 60; // pixels from a point within which it is said

export class Plot {
  // drag: is given the place of a point of the series "tracked" that a pointer chooses.
  constructor(host, title, { height = 300, drag = null } = {}) {
    Object.assign(this, { title, height, series: [], axes: null, cursor: null });
    this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    for (const [name, value] of Object.entries({ class: "plot", role: "img", "aria-label": title })) this.svg.setAttribute(name, value);
    this.legend = h("ul", { class: "legend" });
    const kinds = ["SVG", "PNG", "CSV"].map((kind) => button(kind, () => this.save(kind), { "aria-label": `Save ${title} as ${kind}` }));
    this.card = h("div", {}, h("div", { class: "head" }, h("h2", {}, title), h("div", { class: "exports" }, kinds)), this.svg, this.legend);
    host.append(this.card);
    const point = (event) => {
      if (drag && event.buttons) drag(this.nearest(event, this.series.filter(({ tracked }) => tracked))?.i);
      else this.read(this.nearest(event, this.series));
    };
    for (const name of ["pointermove", "pointerdown"]) this.svg.addEventListener(name, point);
    this.svg.addEventListener("pointerleave", () => this.read(null));
    new ResizeObserver(() => this.paint()).observe(this.card);
  }

  // axes: { x: { words, unit, log, turned, least, most }, y }; a series: { kind, x, y, colour, words } and how it looks;
  // one `beside` does not widen the axes; `empty` says why there is none.
  draw(axes, series, empty = "nothing to draw here yet") {
    Object.assign(this, { axes, empty });
    this.series = series.filter(({ x }) => x.length);
    this.cursor = null;
    this.paint();
  }

  paint() {
    if (!this.axes || !this.card.clientWidth) return;
    const { height, axes, series, svg, empty } = this, width = this.width = Math.max(Math.round(this.card.clientWidth), 240);
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("height", height);
    this.legend.replaceChildren(...series.filter(({ words }) => words).map(({ kind, dash, faint, colour, words }) => h("li", { class: kind === "line" && dash ? "dash" : kind, style: faint ? "opacity: .75" : null }, h("span", { style: `border-color: var(--${colour})` }), words)));
    if (!series.length) {
      svg.innerHTML = `<text x="${width / 2}" y="${height / 2}" text-anchor="middle" font-size="13" fill="var(--quiet)">${empty}</text>`;
      return;
    }
    const drawn = series.filter(({ beside }) => !beside), right = width - RIGHT, foot = height - BOTTOM;
    const x = this.x = scaleOf(axes.x, drawn.map((one) => one.x), LEFT, right, 80);
    const y = this.y = scaleOf(axes.y, drawn.flatMap((one) => [one.y, one.low, one.high]), foot, TOP, 45);
    const upright = x.ticks.map(([at, words]) => `<path d="M${at} ${TOP}V${foot}" stroke="var(--grid)"/><path d="M${at} ${foot}v6" stroke="var(--ink)"/><text x="${at}" y="${foot + 19}" text-anchor="middle" font-size="12" fill="var(--ink)">${words}</text>`);
    const level = y.ticks.map(([at, words, zero]) => `<path d="M${LEFT} ${at}H${right}" stroke="var(--${zero ? "c6" : "grid"})"/><path d="M${LEFT} ${at}h-6" stroke="var(--ink)"/><text x="${LEFT - 9}" y="${at + 4}" text-anchor="end" font-size="12" fill="var(--ink)">${words}</text>`);
    const name = ({ words, unit }, way, place) => `<text ${place} text-anchor="middle" font-size="13" fill="var(--ink)">${escape(way(unit ? `${words} [${unit}]` : words))}</text>`;
    // the axis of depth is turned, so that a test goes to the right as it does in time
    const turned = (words) => (axes.x.turned ? `← pressed in \u2003 ${words} \u2003 pulled up →` : words);
    svg.innerHTML = `${upright.join("")}${level.join("")}<path d="M${LEFT} ${TOP}V${foot}H${right}" fill="none" stroke="var(--ink)" stroke-width="1.2"/>`
      + name({ ...axes.x, unit: x.unit }, turned, `x="${(LEFT + right) / 2}" y="${foot + 38}"`) + name({ ...axes.y, unit: y.unit }, String, `transform="translate(13 ${(foot + TOP) / 2}) rotate(-90)"`)
      + `<svg x="0" y="${TOP}" width="${right}" height="${foot - TOP}" viewBox="0 ${TOP} ${right} ${foot - TOP}">${series.map((one) => this.shape(one)).join("")}</svg><g></g><g></g>`;
    [this.over, this.hover] = [...svg.children].slice(-2);
    if (this.cursor) this.point(...this.cursor);
  }

  shape({ kind, x, y, low, high, colour, opacity = 1, faint, width = 2.2, dash, size }) {
    const at = (list) => x.map((value, i) => [this.x.at(value), this.y.at(list[i])]), seen = faint ? 0.35 : opacity;
    const joined = (points) => points.map((point) => point.map(round).join(" ")).join("L");
    if (kind === "band") {
      const [up, down] = [at(high), at(low)].map((points) => points.filter((point) => point.every(isFinite)));
      return up.length ? `<path d="M${joined(up)}L${joined(down.reverse())}Z" fill="var(--${colour})" opacity="0.28"/>` : "";
    }
    const there = at(y);
    if (kind === "points") {
      const radius = size || (x.length > 80 ? 2 : 4);
      return there.filter((point) => point.every(isFinite)).map(([px, py]) => `<circle cx="${round(px)}" cy="${round(py)}" r="${radius}" fill="var(--paper)" stroke="var(--${colour})" stroke-width="1.5"/>`).join("");
    }
    // a gap in the numbers is a gap in the line
    const pieces = there.reduce((all, point) => { if (point.every(isFinite)) all[all.length - 1].push(point); else all.push([]); return all; }, [[]]);
    const path = pieces.filter(({ length }) => length).map((points) => `M${joined(points)}`).join("");
    return `<path d="${path}" fill="none" stroke="var(--${colour})" stroke-width="${width}" stroke-linejoin="round" opacity="${seen}"${dash ? ' stroke-dasharray="6 4"' : ""}/>`;
  }

  // The point of lines and points that is nearest to the pointer: its series and place.
  nearest(event, series) {
    if (!this.series.length || !this.width) return null;
    const box = this.svg.getBoundingClientRect(), scale = this.width / box.width;
    const px = (event.clientX - box.left) * scale, py = (event.clientY - box.top) * scale;
    let found = null;
    for (const one of series) {
      if (one.kind === "band") continue;
      one.x.forEach((x, i) => {
        const far = Math.hypot(this.x.at(x) - px, this.y.at(one.y[i]) - py);
        if (far < (found?.far ?? Infinity)) found = { one, i, far };
      });
    }
    return found;
  }

  // Say the numbers of a point under the pointer, and what it is a point of.
  read(found) {
    if (!this.series.length || !this.hover) return;
    if (!found || found.far > REACH) { this.hover.innerHTML = ""; return; }
    const { one, i } = found, { x, y } = this.axes, px = this.x.at(one.x[i]), py = this.y.at(one.y[i]);
    const lines = [`${said(one.y[i], y.unit)} at ${said(one.x[i], x.unit)}`, one.words || ""], top = py < TOP + 40 ? py + 24 : py - 26;
    this.hover.innerHTML = `<circle cx="${px}" cy="${py}" r="4" fill="var(--ink)"/>${lines.map((words, row) => this.lettered(px, top + 15 * row, words)).join("")}`;
  }

  // Mark a point, in SI, above everything.
  point(x, y, words) {
    this.cursor = [x, y, words];
    if (!this.series.length || !this.over || x === null || y === null) return;
    const px = this.x.at(x), py = this.y.at(y);
    this.over.innerHTML = `<circle cx="${px}" cy="${py}" r="7" fill="var(--paper)" stroke="var(--c0)" stroke-width="3"/>${this.lettered(px, Math.max(py - 12, 16), words)}`;
  }

  lettered(x, y, words) {
    const left = x > this.width / 2;
    return `<text x="${x + (left ? -12 : 12)}" y="${y}" text-anchor="${left ? "end" : "start"}" font-size="13" font-weight="600" fill="var(--ink)" stroke="var(--paper)" stroke-width="4" paint-order="stroke">${escape(words)}</text>`;
  }

  // The picture by itself, with its legend and with colours in place of their names.
  text() {
    const style = getComputedStyle(document.documentElement), { height } = this, said = this.series.filter(({ words }) => words);
    const width = Math.max(this.width, ...said.map(({ words }) => LEFT + 40 + 7 * words.length)); // of a phone, for all words
    const rows = said.map(({ colour, words }, i) => `<g transform="translate(${LEFT} ${height + 14 + 18 * i})"><path d="M0 -4h24" stroke="var(--${colour})" stroke-width="3"/><text x="32" font-size="12" fill="var(--ink)">${escape(words)}</text></g>`);
    const whole = height + 18 * rows.length + 8;
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${whole}" viewBox="0 0 ${width} ${whole}" font-family="sans-serif"><rect width="100%" height="100%" fill="var(--paper)"/>${this.svg.innerHTML}${rows.join("")}</svg>`
      .replaceAll(/var\((--[a-z0-9]+)\)/g, (_, name) => style.getPropertyValue(name).trim());
  }

  csv() {
    const { x, y } = this.axes, headed = ({ words = "series" }, name, unit) => `"${words.replaceAll(/[",\n]/g, " ")}: ${name}${unit ? ` [${unit}]` : ""}"`;
    const columns = this.series.flatMap((one) => [
      [headed(one, x.words, x.unit), ...one.x],
      ...(one.kind === "band" ? ["low", "high"] : ["y"]).map((key) => [headed(one, key === "y" ? y.words : key, y.unit), ...one[key]]),
    ]);
    const longest = Math.max(0, ...columns.map(({ length }) => length));
    return `${Array.from({ length: longest }, (_, i) => columns.map((column) => column[i] ?? "").join(",")).join("\n")}\n`;
  }

  async save(kind) {
    if (!this.width) return;
    const name = `${this.title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-")}.${kind.toLowerCase()}`;
    if (kind === "CSV") { save(name, this.csv()); return; }
    const svg = new Blob([this.text()], { type: "image/svg+xml" });
    if (kind === "SVG") { save(name, svg); return; }
    const picture = new Image();
    picture.src = URL.createObjectURL(svg);
    await picture.decode();
    const canvas = h("canvas", { width: 2 * picture.width, height: 2 * picture.height });
    canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(picture.src);
    canvas.toBlob((blob) => save(name, blob));
  }
}

const round = (value) => Math.round(value * 10) / 10;

// An axis: the pixel `at` a value, its unit with a prefix, and ticks of pixel, words, and whether they stand at zero.
function scaleOf({ log, turned, unit, least = Infinity, most = -Infinity }, lists, from, to, room) {
  let low = least, high = most;
  for (const list of lists) for (const value of list || []) if (value !== null && isFinite(value) && !(log && value <= 0)) { low = Math.min(low, value); high = Math.max(high, value); }
  if (!isFinite(low)) [low, high] = log ? [1, 10] : [0, 1];
  const prefix = log ? prefixOf(high / low < 1e6 ? Math.sqrt(low * high) : 1, unit) : prefixOf(Math.max(Math.abs(low), Math.abs(high)), unit);
  const margin = log ? Math.max((high / low) ** 0.03, 1.1) : (high - low || Math.abs(high) || 1) * 0.06;
  [low, high] = log ? [low / margin, high * margin] : [low - margin, high + margin];
  const [first, last] = turned ? [to, from] : [from, to], by = log ? Math.log : Number;
  const at = (value) => (value === null || (log && value <= 0) ? NaN : first + (last - first) * (by(value) - by(low)) / (by(high) - by(low)));
  const count = Math.max(Math.floor(Math.abs(to - from) / room), 4), { factor } = prefix;
  const ticks = ticksOf(low / factor, high / factor, count, log).map((tick) => [round(at(tick * factor)), label(tick, log), !log && tick === 0]);
  return { at, ticks, unit: prefix.unit };
}

function ticksOf(low, high, most, log) {
  if (log) {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), every = Math.max(1, Math.ceil((last - first + 1) / most));
    if (last - first >= every) return Array.from({ length: Math.floor((last - first) / every) + 1 }, (_, i) => 10 ** (first + i * every));
  }
  const span = (high - low) / most, power = 10 ** Math.floor(Math.log10(span));
  const step = [1, 2, 5, 10].find((x) => x * power >= span) * power, first = Math.ceil(low / step);
  return Array.from({ length: Math.floor(high / step) - first + 1 }, (_, i) => (first + i) * step).filter((tick) => !log || tick > 0);
}

function label(tick, log) {
  const power = Math.log10(tick), whole = Math.round(power);
  if (log && Math.abs(power - whole) < 1e-6 && (whole > 3 || whole < -2)) return `10<tspan dy="-5" font-size="9">${whole}</tspan>`;
  return digits(Math.abs(tick) < 1e-12 ? 0 : tick, 3);
}
