// Drawings: the set-up that follows the numbers, and the surface under the indenter as simulated.

import { escape } from "./plot.js";
import { read, said, shown as words } from "./numbers.js";

const WIDE = 360, HIGH = 250;

// The set-up: sizes follow the numbers, each by its logarithm, so that all can be seen.
export function setUp(tables, quick) {
  const shape = ["sphere", "cone", "profile", "punch"].find((word) => word in tables) || Object.keys(tables).find((word) => !["material", "interface", "protocol", "layer"].includes(word)) || "";
  const start = quick?.start, mid = WIDE / 2, ground = 165;
  const apart = String(tables.protocol?.start || "").startsWith("apart");
  const dip = apart ? 0 : 6 + 10 * squash(start ? Math.max(start.depth, 0) : 0, 1e-7, 1e-4);
  const tip = apart ? ground - 14 : ground + dip;
  const reach = 22 + 60 * squash(start?.radius || 0, 1e-6, 2e-3);
  const parts = [];
  // the body, hollow where it is pressed
  if (shape === "punch") {
    const thick = 14 + 46 * squash(si(tables.layer?.thickness), 1e-6, 1e-2);
    parts.push(`<rect x="20" y="${ground}" width="${WIDE - 40}" height="${thick}" fill="var(--body)"/>`);
    parts.push(base(ground + thick));
    parts.push(size(WIDE - 34, ground, ground + thick, `b = ${words(tables.layer?.thickness)}`));
  } else {
    parts.push(`<path d="M20 ${ground}H${mid - reach - 22}Q${mid - reach} ${ground} ${mid - reach * 0.7} ${ground + dip * 0.4}Q${mid} ${ground + dip * 1.7} ${mid + reach * 0.7} ${ground + dip * 0.4}Q${mid + reach} ${ground} ${mid + reach + 22} ${ground}H${WIDE - 20}V${HIGH - 12}H20Z" fill="var(--body)"/>`);
  }
  parts.push(indenter(shape, tables, mid, tip, apart ? ground - 14 : ground, reach));
  // the machine
  const top = 22, neck = shape === "punch" ? tip - 34 : tip - 78;
  const spring = tables.protocol?.stiffness;
  parts.push(spring ? coil(mid, top, neck) : `<path d="M${mid} ${top}V${neck}" stroke="var(--steel)" stroke-width="5"/>`);
  parts.push(`<path d="M${mid - 40} ${top}h80" stroke="var(--ink)" stroke-width="4"/>`);
  if (spring) parts.push(text(mid + 14, (top + neck) / 2 + 4, `K = ${words(spring)}`));
  const speed = tables.protocol?.speed;
  if (speed) parts.push(`<path d="M${mid - 62} ${top + 40}V${top + 6}m-6 8l6 -9l6 9" fill="none" stroke="var(--c0)" stroke-width="3"/>`, text(mid - 70, top + 26, words(speed), "end"));
  const pressed = tables.protocol?.preload_force || tables.protocol?.preload_stress || tables.protocol?.preload_depth || tables.protocol?.preload_radius || tables.protocol?.start;
  if (pressed) parts.push(text(24, 186, apart ? `begins ${words(pressed)}` : `pressed ${words(pressed)}`));
  const material = tables.material || {};
  parts.push(text(24, HIGH - 32, `E0 = ${words(material.rubbery_modulus)}${material.glassy_modulus ? `, fast ${words(material.glassy_modulus)}` : ""}`));
  parts.push(text(24, HIGH - 16, `adhesion ${words(tables.interface?.work_of_adhesion)}, ${tables.interface?.strength ? `strength ${words(tables.interface.strength)}` : `range ${words(tables.interface?.equilibrium_gap)}`}`));
  return `<svg class="plot" viewBox="0 0 ${WIDE} ${HIGH}" role="img" aria-label="${escape(spoken(shape, tables))}">${parts.join("")}</svg>`;
}

function indenter(shape, tables, mid, tip, ground, reach) {
  const look = 'fill="var(--steel)" fill-opacity="0.55" stroke="var(--ink)" stroke-width="1.5"';
  if (shape === "punch") {
    const half = 30 + 80 * squash(si(tables.punch?.half_width), 1e-5, 1e-2);
    return `<rect x="${mid - half}" y="${ground - 34}" width="${2 * half}" height="34" ${look}/>` + text(mid + 14, ground - 42, `2a, a = ${words(tables.punch?.half_width)}`);
  }
  if (shape === "cone") {
    const rise = 20 + 60 * squash(Number(tables.cone?.slope), 0.005, 1);
    return `<path d="M${mid} ${tip}l110 ${-rise}v${rise - 78}h-220v${78 - rise}Z" ${look}/>` + text(mid + 14, tip - 84, `slope ${words(tables.cone?.slope)}`);
  }
  if (shape === "profile") {
    const q = Number(tables.profile?.exponent) || 1;
    const side = Array.from({ length: 21 }, (_, i) => [i / 20, (i / 20) ** q]);
    const right = side.map(([x, z]) => `${mid + 110 * x} ${tip - 60 * z}`), left = side.map(([x, z]) => `${mid - 110 * x} ${tip - 60 * z}`).reverse();
    return `<path d="M${left.join("L")}L${right.join("L")}V${tip - 78}H${mid - 110}Z" ${look}/>` + text(mid + 14, tip - 84, `A r^${words(tables.profile?.exponent)}`);
  }
  const R = Math.max(60 + 80 * squash(si(tables.sphere?.radius), 1e-5, 1e-1), reach);
  const half = Math.min(R, 130), drop = R - Math.sqrt(R * R - half * half);
  const up = Math.min(drop, 70);
  const wide = Math.sqrt(R * R - (R - up) * (R - up));
  return `<path d="M${mid - wide} ${tip - up}A${R} ${R} 0 0 0 ${mid + wide} ${tip - up}V${tip - 78}H${mid - wide}Z" ${look}/>` + text(mid, tip - up / 2, tables.sphere ? `R = ${words(tables.sphere.radius)}` : shape, "middle");
}

function squash(value, low, high) {
  if (!(value > 0)) return 0;
  return Math.min(Math.max(Math.log(value / low) / Math.log(high / low), 0), 1);
}

// A length in words, about: it only sizes a drawing.
function si(value) {
  return read(value, "m")?.number || 0;
}

function text(x, y, what, anchor = "start") {
  return `<text x="${x}" y="${y}" font-size="12.5" text-anchor="${anchor}" fill="var(--ink)" stroke="var(--paper)" stroke-width="3" paint-order="stroke">${escape(what)}</text>`;
}

function base(y) {
  const hatch = Array.from({ length: 20 }, (_, i) => `M${22 + 16 * i} ${y + 12}l10 -12`).join("");
  return `<path d="M20 ${y}h${WIDE - 40}" stroke="var(--ink)" stroke-width="2"/><path d="${hatch}" stroke="var(--ink)"/>`;
}

function size(x, y0, y1, what) {
  return `<path d="M${x} ${y0}V${y1}m-4 0h8M${x - 4} ${y0}h8" stroke="var(--ink)"/>` + text(x - 6, (y0 + y1) / 2 + 4, what, "end");
}

function coil(x, y0, y1) {
  const turns = 7, step = (y1 - y0) / turns;
  const zig = Array.from({ length: turns }, (_, i) => `l${i % 2 ? -18 : 18} ${step}`).join("");
  return `<path d="M${x - (turns % 2 ? 9 : 0)} ${y0}${zig}" fill="none" stroke="var(--steel)" stroke-width="3"/>`;
}

function spoken(shape, tables) {
  return `Set-up: a ${shape} on a soft body of ${words(tables.material?.rubbery_modulus)}, pulled at ${words(tables.protocol?.speed)}`;
}

// The predicted curve, and the band of its pull-off.
export function learned({ depth, force, interval, confidence, words: told }) {
  const place = depth[depth.length - 1], reach = 0.22 * (Math.max(...depth) - Math.min(...depth));
  return [
    { kind: "band", x: [place - reach, place + reach], low: interval.map(() => -interval[1]), high: interval.map(() => -interval[0]), colour: "c1", words: `learned: pull-off, ${Math.round(100 * confidence)} % of cases` },
    { kind: "line", x: depth, y: force, colour: "c1", width: 7, soft: true, words: told },
  ];
}

// The surface at one instant, as simulated: the body below, the indenter above, pressure between.
export function surface(profile, depth, quick) {
  const radius = profile.radius, gap = profile.gap, pressure = profile.pressure;
  const far = Math.max(...radius);
  // the indenter stands at its gap from the surface; of the surface the shape is what is left
  // depth is counted from where undeformed surfaces are at their equilibrium gap
  const flank = profile.flank, lift = quick.axes.length - depth;
  const surfaces = radius.map((_, i) => flank[i] + lift - gap[i]);
  const all = [...surfaces, ...flank.map((z) => z + lift)];
  const low = Math.min(...surfaces, 0), high = Math.max(0.35 * Math.max(...all), Math.max(...surfaces), 1.1 * Math.min(...flank.map((z) => z + lift)), 1e-12);
  const wide = 640, tall = 230, mid = wide / 2;
  const x = (r) => (r / far) * (mid - 12);
  const y = (z) => 196 - ((z - low) / (high - low || 1)) * 150;
  const line = (list, sign) => radius.map((r, i) => `${(mid + sign * x(r)).toFixed(1)} ${y(list[i]).toFixed(1)}`);
  const body = [...line(surfaces, -1).reverse(), ...line(surfaces, 1)];
  const tip = flank.map((z) => z + lift), solid = [...line(tip, -1).reverse(), ...line(tip, 1)];
  const most = Math.max(...pressure.map(Math.abs)) || 1;
  const bars = [];
  for (let i = 1; i < radius.length; i += 1) {
    const p = (pressure[i] + pressure[i - 1]) / 2;
    if (Math.abs(p) < 0.02 * most) continue;
    const strength = (Math.abs(p) / most).toFixed(2), colour = p > 0 ? "var(--c0)" : "var(--c1)";
    for (const sign of [-1, 1]) {
      const a = mid + sign * x(radius[i - 1]), b = mid + sign * x(radius[i]);
      bars.push(`<path d="M${a.toFixed(1)} ${y(surfaces[i - 1]).toFixed(1)}L${b.toFixed(1)} ${y(surfaces[i]).toFixed(1)}" stroke="${colour}" stroke-width="6" opacity="${strength}"/>`);
    }
  }
  return `<svg class="plot" viewBox="0 0 ${wide} ${tall}" role="img" aria-label="Surface under the indenter, heights enlarged">
<rect width="${wide}" height="${tall}" fill="none"/>
<path d="M${solid.join("L")}V-60H${mid - x(far)}Z" fill="var(--steel)" fill-opacity="0.5" stroke="var(--ink)" stroke-width="1.2"/>
<path d="M${body.join("L")}V${tall}H${mid - x(far)}Z" fill="var(--body)" stroke="var(--ink)" stroke-width="1.2"/>${bars.join("")}
<text x="12" y="${tall - 8}" font-size="13" fill="var(--ink)">${said(2 * far, "m", 3)} across, heights enlarged ${Math.max(1, Math.round((150 / (high - low)) / ((mid - 12) / far))).toLocaleString("en")} times; blue pushes, orange pulls</text></svg>`;
}
