// The fields of the case, made from what the server says can be asked: no noun is known by name.

import { refusalOf } from "./answer.js";
import { button, fill, fold, h, selection } from "./dom.js";
import { read, said, shown, sliderOf, written } from "./numbers.js";

const ROOM = 12; // characters of a field

export function fields(form, store) {
  const { forms } = store;
  // on a phone the indenter and the test, and all that is drawn of them, come first
  const closed = new Set(matchMedia("(max-width: 46rem)").matches ? ["Material", "Interface", "Simulation"] : []);
  let all = []; // of the form: table, key, row, input, and put, which shows the value of the case
  form.addEventListener("submit", (event) => event.preventDefault());
  store.on("case", () => {
    const focused = document.activeElement?.id;
    // the form is made anew where other fields are asked for; else only the numbers are put in
    fill(form, Object.entries(store.tables).map(([name, table]) => [name, table.model, table.law, table.base, Object.keys(table)]), () => { all = []; return parts(); });
    if (focused && document.activeElement?.id !== focused) document.getElementById(focused)?.focus();
    for (const field of all) field.put();
  });
  store.on("quick", mark);

  function parts() {
    const { tables } = store, shape = forms.shape.find(({ word }) => word in tables) || forms.shape[0];
    return [indenter(shape), shape.symmetry === "plane" ? layer() : null, test(forms.protocol[shape.symmetry]),
      kind("Material", "material", "model", forms.materials), kind("Interface", "interface", "law", []), simulation()].filter(Boolean);
  }

  function group(title, ...children) {
    return h("details", { class: "group", open: !closed.has(title), toggle: ({ target }) => closed[target.open ? "delete" : "add"](title) }, h("summary", {}, title), children);
  }

  function indenter(shape) {
    const change = (word) => {
      const next = forms.shape.find((one) => one.word === word), { [shape.word]: before, layer: under, protocol, ...others } = store.tables;
      const same = next.symmetry === shape.symmetry, plane = next.symmetry === "plane";
      store.take({
        ...others, [word]: values(next.fields), ...(plane ? { layer: { ...values(forms.layer.fields), base: forms.layer.bases[0].word } } : {}),
        protocol: same ? protocol : begun(forms.protocol[next.symmetry].starts[0], protocol),
      });
    };
    return group("Indenter", selection("Indenter: shape", forms.shape.map(({ word }) => [word, word]), shape.word, change, { id: "choice-shape" }), rows(shape.word, shape.fields));
  }

  function layer() {
    const change = (base) => store.set("layer", "base", base);
    return group("Layer", selection("Layer: base", forms.layer.bases.map(({ word }) => [word, word]), store.tables.layer?.base, change, { id: "choice-layer" }), rows("layer", forms.layer.fields));
  }

  function test({ starts, speed, stiffness, moves }) {
    const table = store.tables.protocol || {}, now = starts.find(({ key }) => key in table) || starts[0];
    const change = (key) => store.change({ protocol: begun(starts.find((one) => one.key === key), table) });
    const lines = area("protocol", { key: "moves", rows: 2, label: "moves before the pull, one a line", example: moves.slice(0, 2).join("\n") }, String, String);
    const machine = fold("spring of the machine, moves before the pull", rows("protocol", [stiffness]), lines, h("p", { class: "hint" }, `A machine can: ${moves.join("; ")}.`));
    machine.open = "stiffness" in table || "moves" in table;
    return group("Test", selection("Test: how it begins", starts.map(({ key, title }) => [key, title]), now.key, change, { id: "choice-start" }), rows("protocol", [now, speed]), machine);
  }

  // A start in place of another; a test that begins apart approaches first.
  function begun(next, table = {}) {
    const rest = Object.fromEntries(Object.entries(table).filter(([key]) => !key.startsWith("preload_") && key !== "start"));
    return { [next.key]: `${next.prefix || ""}${next.example}`, ...(next.prefix ? { moves: ["approach 20 um/s to force 0.5 mN", "dwell 1 s"] } : {}), ...rest };
  }

  // A material or an interface: its model or law, and for a material the published ones and a laboratory's file.
  function kind(title, table, key, published) {
    const known = store.tables[table], choice = forms[table].find(({ word }) => word === known?.[key]) || forms[table][0];
    const change = (word) => {
      const next = forms[table].find((one) => one.word === word);
      store.change({ [table]: next ? { [key]: word, ...values(next.fields, known) } : published.find(({ name }) => word === `published ${name}`).table });
    };
    const choices = [...forms[table].map(({ word }) => [word, word]), ...published.map(({ name, title: words }) => [`published ${name}`, words])];
    const measured = (event) => { document.getElementById("tab-material").click(); store.say("material files", [...event.target.files]); };
    const file = published.length ? h("label", { class: "file" }, "from a DMA, relaxation or creep file …", h("input", { class: "unseen", type: "file", multiple: true, id: "material-file", change: measured })) : null;
    return group(title, selection(`${title}: kind`, choices, choice.word, change, { id: `choice-${table}` }), h("p", { class: "hint" }, choice.words), file, rows(table, choice.fields));
  }

  function simulation() {
    const accuracies = [[0.02, "2 %"], [0.01, "1 %"], [0.005, "0.5 %"], [0.002, "0.2 %"], [0.0005, "0.05 %"]], ways = [["detached", "until apart"], ["pull-off", "past the pull-off"]];
    const box = h("input", { type: "checkbox", checked: store.auto, change: () => { store.auto = box.checked; } });
    return group("Simulation", h("div", { class: "row" },
      selection("Accuracy of the force", accuracies, store.settings.accuracy, (chosen) => store.configure({ accuracy: Number(chosen) }), { id: "choice-accuracy" }),
      selection("How far to pull", ways, store.settings.until, (chosen) => store.configure({ until: chosen }), { id: "choice-until" })),
    h("label", { class: "hint" }, box, " simulate when the numbers rest"));
  }

  // Values of fields: those that are known already, else their examples.
  function values(cards, known = {}) {
    const found = {};
    for (const { key, or, optional, kind: of, example } of cards) {
      const there = [key, or?.key].find((name) => name in known);
      if (there) found[there] = known[there];
      else if (!optional) found[key] = of === "pairs" ? JSON.parse(example) : example;
    }
    return found;
  }

  function rows(table, cards) {
    return cards.map((card) => {
      if (card.kind === "pairs") return area(table, { ...card, rows: 4, label: `${card.words} [${card.units.join(", ")}], a pair a line` }, (line) => line.split(/[,;\t]/).map((cell, i) => valueOf(cell, card.units[i])), (pair) => pair.join(", "));
      // the same may be said by another number, a range by a strength
      return card.or && card.or.key in (store.tables[table] || {}) ? row(table, { ...card.or, or: card }) : row(table, card);
    });
  }

  function row(table, card) {
    const id = `${table}-${card.key}`, stated = () => store.tables[table]?.[card.key];
    const input = h("input", { type: "text", id, spellcheck: "false", placeholder: card.optional ? "none" : card.example, change: () => store.set(table, card.key, valueOf(input.value, card.unit)) });
    const ends = [h("span"), h("span")], slider = h("input", { type: "range", "aria-label": `${card.words}, slider`, input: () => slide() });
    const track = h("div", { class: "track" }, ends[0], slider, ends[1]);
    let scale = null, quantity = null, dragging = false, before = null;
    const put = () => {
      // a fit states all digits, more than the field has room for: the state keeps them
      const all = shown(stated() ?? ""), long = all.length > ROOM ? read(all, card.unit) : null;
      const text = long?.si ? long.word + said(long.number, long.unit, 6) : all;
      if (text === before && text === input.value) return; // a slider that moves leaves the other fields alone
      before = text;
      if (document.activeElement !== input) input.value = text;
      slider.setAttribute("aria-valuetext", text);
      if (dragging) return;
      quantity = read(text, card.unit);
      scale = quantity && sliderOf(card, quantity);
      track.hidden = !scale;
      if (!scale) return;
      Object.assign(slider, { min: scale.min, max: scale.max, step: scale.step, value: scale.of(quantity.number) });
      ends.forEach((end, i) => { end.textContent = said(scale.ends[i], quantity.unit, 2); });
    };
    const slide = () => {
      dragging = true;
      store.set(table, card.key, written({ ...quantity, number: scale.at(Number(slider.value)) }));
      dragging = false;
    };
    const other = () => {
      const { [card.key]: gone, ...rest } = store.tables[table];
      store.change({ [table]: { ...rest, [card.or.key]: card.or.example } });
    };
    const found = h("div", { class: "field" }, h("label", { for: id, title: card.range ? `must ${card.range}` : null }, card.words, card.symbol ? [" ", h("i", {}, card.symbol)] : null), input, track,
      card.or ? button(`state the ${card.or.key.replaceAll("_", " ")} instead`, other, { class: "hint whole" }) : null);
    all.push({ table, key: card.key, row: found, input, put });
    return found;
  }

  // A list, an entry a line.
  function area(table, { key, label, rows: high, example = "" }, taken, told) {
    const id = `${table}-${key}`, change = () => {
      const entries = input.value.split("\n").map((line) => line.trim()).filter(Boolean).map(taken);
      store.set(table, key, entries.length ? entries : null);
    };
    const input = h("textarea", { id, rows: high, placeholder: example, change }), found = h("div", { class: "field" }, h("label", { for: id }, label), input);
    all.push({ table, key, row: found, input, put: () => { if (document.activeElement !== input) input.value = (store.tables[table]?.[key] || []).map(told).join("\n"); } });
    return found;
  }

  // Say a refusal at the field that it names; where it names only a table, at the field whose words it quotes.
  function mark() {
    const { table, words } = refusalOf(store.refused), here = table ? all.filter((field) => field.table === table) : [];
    const quoted = ({ input }) => input.value.split("\n").some((line) => line && words.includes(`'${line}'`));
    const wrong = here.find(({ key }) => words.split(/[ :]/)[0] === key) || here.find(quoted) || here[0];
    for (const field of all) {
      const is = field === wrong, { row: place, input } = field;
      place.classList.toggle("wrong", is);
      input.setAttribute("aria-invalid", is);
      place.querySelector(".problem")?.remove();
      input.removeAttribute("aria-describedby");
      if (!is) continue;
      place.append(h("p", { class: "problem refused", id: `${input.id}-problem` }, words));
      input.setAttribute("aria-describedby", `${input.id}-problem`);
      for (let up = place.closest("details"); up; up = up.parentElement.closest("details")) up.open = true;
    }
  }
}

// What was typed, as a case states it: a pure number is a number, all else has its unit; null where the field is empty.
function valueOf(typed, unit) {
  const text = typed.trim();
  return text && unit === "1" && isFinite(text) ? Number(text) : text || null;
}
