// Drawings: the set-up that follows the numbers, and the surface under the indenter as simulated.

import { escape } from "./dom.js";
import { read, said, shown as words } from "./numbers.js";

const WIDE = 360, HIGH = 250, MIDDLE = WIDE / 2, GROUND = 165;
// A length in words, about, and where it stands between two: they only size a drawing.
const si = (value) => read(value, "m")?.number || 0;
const squash = (value, low, high) => (value > 0 ? Math.min(Math.max(Math.log(value / low) / Math.log(high / low), 0), 1) : 0);
const text = (x, y, what, anchor = "start") => `<text x="${x}" y="${y}" font-size="12.5" text-anchor="${anchor}" fill="var(--ink)" stroke="var(--paper)" stroke-width="3" paint-order="stroke">${escape(what)}</text>`;

// The set-up: sizes follow the numbers, each by its logarithm, so that all can be seen.
export function setUp(tables) {
  const { protocol = {}, material = {}, interface: law = {}, layer, punch } = tables;
  const apart = String(protocol.start || "").startsWith("apart"), parts = [];
  const dip = apart ? 0 : 11, reach = 52;
  const tip = apart || punch ? GROUND - (apart ? 14 : 0) : GROUND + dip;
  if (punch) {
    const base = GROUND + 14 + 46 * squash(si(layer?.thickness), 1e-6, 1e-2), hatch = Array.from({ length: 20 }, (_, i) => `M${22 + 16 * i} ${base + 12}l10 -12`);
    parts.push(`<rect x="20" y="${GROUND}" width="${WIDE - 40}" height="${base - GROUND}" fill="var(--body)"/><path d="M20 ${base}h${WIDE - 40}" stroke="var(--ink)" stroke-width="2"/><path d="${hatch.join("")}" stroke="var(--ink)"/>`);
    parts.push(`<path d="M${WIDE - 34} ${GROUND}V${base}m-4 0h8M${WIDE - 38} ${GROUND}h8" stroke="var(--ink)"/>`, text(WIDE - 40, (GROUND + base) / 2 + 4, `b = ${words(layer?.thickness)}`, "end"));
  } else { // hollow where it is pressed
    parts.push(`<path d="M20 ${GROUND}H${MIDDLE - reach - 22}Q${MIDDLE - reach} ${GROUND} ${MIDDLE - reach * 0.7} ${GROUND + dip * 0.4}Q${MIDDLE} ${GROUND + dip * 1.7} ${MIDDLE + reach * 0.7} ${GROUND + dip * 0.4}Q${MIDDLE + reach} ${GROUND} ${MIDDLE + reach + 22} ${GROUND}H${WIDE - 20}V${HIGH - 12}H20Z" fill="var(--body)"/>`);
  }
  const { half, rise, tall, called } = indenter(tables, reach), top = 22, neck = tip - tall;
  const side = Array.from({ length: 31 }, (_, i) => [half * i / 30, tip - rise(half * i / 30)]);
  const outline = [...side.map(([x, y]) => [MIDDLE - x, y]).reverse(), ...side.map(([x, y]) => [MIDDLE + x, y])];
  parts.push(`<path d="M${outline.join("L")}V${neck}H${MIDDLE - half}Z" fill="var(--steel)" fill-opacity="0.55" stroke="var(--ink)" stroke-width="1.5"/>`, text(MIDDLE + 14, neck - 6, called));
  // the machine
  const turns = 7, turn = (neck - top) / turns, coil = Array.from({ length: turns }, (_, i) => `l${i % 2 ? -18 : 18} ${turn}`).join("");
  parts.push(protocol.stiffness ? `<path d="M${MIDDLE - 9} ${top}${coil}" fill="none" stroke="var(--steel)" stroke-width="3"/>${text(MIDDLE + 14, top + 22, `K = ${words(protocol.stiffness)}`)}` : `<path d="M${MIDDLE} ${top}V${neck}" stroke="var(--steel)" stroke-width="5"/>`);
  parts.push(`<path d="M${MIDDLE - 40} ${top}h80" stroke="var(--ink)" stroke-width="4"/>`);
  if (protocol.speed) parts.push(`<path d="M${MIDDLE - 62} ${top + 40}V${top + 6}m-6 8l6 -9l6 9" fill="none" stroke="var(--c0)" stroke-width="3"/>`, text(MIDDLE - 70, top + 26, words(protocol.speed), "end"));
  const pressed = Object.entries(protocol).find(([key]) => key.startsWith("preload_") || key === "start");
  if (pressed) parts.push(text(24, 186, `${apart ? "begins" : "pressed"} ${words(pressed[1])}`));
  parts.push(text(24, HIGH - 32, `E0 = ${words(material.rubbery_modulus)}${material.glassy_modulus ? `, fast ${words(material.glassy_modulus)}` : ""}`));
  parts.push(text(24, HIGH - 16, `adhesion ${words(law.work_of_adhesion)}, ${law.strength ? `strength ${words(law.strength)}` : `range ${words(law.equilibrium_gap)}`}`));
  return `<svg class="plot" viewBox="0 0 ${WIDE} ${HIGH}" role="img" aria-label="${escape(`Set-up: a soft body of ${words(material.rubbery_modulus)}, pulled at ${words(protocol.speed)}; the indenter: ${called}`)}">${parts.join("")}</svg>`;
}

// Half its width, its height above the tip by the distance from the axis, how tall it is drawn, and its name.
function indenter({ punch, cone, profile, sphere, ...others }, reach) {
  if (punch) return { half: 30 + 80 * squash(si(punch.half_width), 1e-5, 1e-2), rise: () => 0, tall: 34, called: `2a, a = ${words(punch.half_width)}` };
  const slope = (cone || profile)?.slope, exponent = Number(profile?.exponent) || 1, high = slope ? 20 + 60 * squash(Number(slope), 0.005, 1) : 60;
  if (cone || profile) return { half: 110, rise: (x) => high * (x / 110) ** exponent, tall: 78, called: slope ? `slope ${words(slope)}` : `A r^${words(profile.exponent)}` };
  const R = Math.max(60 + 80 * squash(si(sphere?.radius), 1e-5, 1e-1), reach);
  const half = Math.min(R, 130, Math.sqrt(R * R - Math.max(R - 70, 0) ** 2));
  const name = Object.keys(others).find((word) => !["material", "interface", "protocol", "layer"].includes(word)) || "";
  return { half, rise: (x) => R - Math.sqrt(R * R - x * x), tall: 78, called: sphere ? `R = ${words(sphere.radius)}` : name };
}

// The surface at one instant, as simulated: the body below, the indenter above, pressure between. Depth is counted from
// where undeformed surfaces are at their equilibrium gap, which is `length`.
export function surface({ radius, gap, pressure, flank }, depth, length) {
  const wide = 640, tall = 230, mid = wide / 2, far = radius.at(-1);
  const tip = flank.map((z) => z + length - depth), body = tip.map((z, i) => z - gap[i]);
  const low = Math.min(...body, 0), high = Math.max(0.35 * Math.max(...body, ...tip), ...body, 1.1 * Math.min(...tip), 1e-12);
  const x = (r) => (r / far) * (mid - 12), y = (z) => (196 - (150 * (z - low)) / (high - low)).toFixed(1);
  const mirrored = (list) => [-1, 1].map((sign) => { const half = list.map((z, i) => `${(mid + sign * x(radius[i])).toFixed(1)} ${y(z)}`); return (sign < 0 ? half.reverse() : half).join("L"); }).join("L");
  const most = Math.max(...pressure.map(Math.abs)) || 1;
  const bars = pressure.slice(1).flatMap((p, i) => {
    const mean = (p + pressure[i]) / 2, strength = Math.abs(mean) / most, place = (sign, j) => `${(mid + sign * x(radius[j])).toFixed(1)} ${y(body[j])}`;
    return strength < 0.02 ? [] : [-1, 1].map((sign) => `<path d="M${place(sign, i)}L${place(sign, i + 1)}" stroke="var(--c${mean > 0 ? 0 : 1})" stroke-width="6" opacity="${strength.toFixed(2)}"/>`);
  });
  const enlarged = Math.max(1, Math.round(150 / (high - low) / ((mid - 12) / far))).toLocaleString("en");
  return `<svg class="plot" viewBox="0 0 ${wide} ${tall}" role="img" aria-label="Surface under the indenter, heights enlarged">
<path d="M${mirrored(tip)}V-60H${mid - x(far)}Z" fill="var(--steel)" fill-opacity="0.5" stroke="var(--ink)" stroke-width="1.2"/>
<path d="M${mirrored(body)}V${tall}H${mid - x(far)}Z" fill="var(--body)" stroke="var(--ink)" stroke-width="1.2"/>${bars.join("")}
<text x="20" y="${tall - 8}" font-size="13" fill="var(--ink)">${said(2 * far, "m", 3)} across, heights enlarged ${enlarged} times; blue pushes, orange pulls</text></svg>`;
}
