// The fields of the case, made from the JSON schema of a problem: no noun is known by name.

import { refusalOf } from "./answer.js";
import { button, fill, fold, h, selection } from "./dom.js";
import { moveOf, read, said, shown, sliderOf, written } from "./numbers.js";

export function fields(form, store) {
  const { schema: { else: { properties, oneOf }, $defs: tables }, starts, materials } = store.forms, named = ({ $ref }) => $ref.split("/")[2];
  // the tables that numbers state, not a file; of a law that grows, the one on the usual law at rest
  const offered = (words) => words.filter((word) => !word.includes("-on-") && cardsOf(word).some(({ optional }) => !optional));
  const kinds = { material: offered(properties.material.anyOf.map(named)), interface: offered(properties.interface.anyOf.map(named)), shape: offered(oneOf.map(({ required: [word] }) => word)) };
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

  // What a table states: what it needs, what one of its alternatives needs, and what it may have; `or` may be in place of one.
  function cardsOf(word, table = {}) {
    const { properties, required, oneOf = [] } = tables[word], ways = oneOf.map((way) => way.required), now = ways.find((way) => way.every((key) => key in table)) || ways[0] || [];
    const others = ways.filter((way) => way !== now), or = now.length === 1 ? others.find(([key, more]) => !more && properties[key].unit)?.[0] : null;
    return Object.entries(properties).filter(([key, { unit, units, enum: words }]) => (unit || units || words) && (now.includes(key) || !others.flat().includes(key)))
      .map(([key, card]) => ({ key, ...card, optional: ![...required, ...now].includes(key), or: or && key === now[0] ? { key: or, ...properties[or] } : null }));
  }

  function parts() {
    const shape = kinds.shape.find((word) => word in store.tables) || kinds.shape[0], layer = cardsOf("layer").filter(({ optional }) => !optional);
    return [indenter(shape), store.tables.layer ? group("Layer", rows("layer", layer)) : null, test(testOf(shape)),
      kind("Material", "material", "model", materials), kind("Interface", "interface", "law", []), simulation()].filter(Boolean);
  }

  // The keys of the test of a shape, and the ways in which it begins.
  function testOf(shape) {
    const keys = tables[tables[shape].symmetry === "plane" ? "protocol-of-a-punch" : "protocol"].properties;
    return { keys, ways: Object.keys(starts).filter((key) => key in keys), moves: keys.moves.examples[0] };
  }

  function group(title, ...children) {
    return h("details", { class: "group", open: !closed.has(title), toggle: ({ target }) => closed[target.open ? "delete" : "add"](title) }, h("summary", {}, title), children);
  }

  function indenter(shape) {
    const change = (next) => {
      const { [shape]: before, layer: under, protocol = {}, ...others } = store.tables, same = tables[next].symmetry === tables[shape].symmetry;
      const layer = tables[next].symmetry === "plane" ? { layer: values(cardsOf("layer")) } : {};
      store.take({ ...others, [next]: values(cardsOf(next)), ...layer, protocol: same ? protocol : begun(testOf(next), testOf(next).ways[0], { speed: protocol.speed }) });
    };
    return group("Indenter", selection("Indenter: shape", kinds.shape.map((word) => [word, word]), shape, change, { id: "choice-shape" }), rows(shape, cardsOf(shape, store.tables[shape])));
  }

  function test(of) {
    const { keys, ways, moves } = of, table = store.tables.protocol || {}, now = ways.find((key) => key in table) || ways[0], cards = [now, "speed", "stiffness"].map((key) => ({ key, ...keys[key], optional: key === "stiffness" }));
    const lines = area("protocol", { key: "moves", rows: 2, label: "moves before the pull, one a line", example: moves.slice(0, 2).join("\n") }, String, moveOf);
    const machine = fold("spring of the machine, moves before the pull", rows("protocol", cards.slice(2)), lines, h("p", { class: "hint" }, `A machine can: ${moves.join("; ")}.`));
    machine.open = "stiffness" in table || "moves" in table;
    return group("Test", selection("Test: how it begins", ways.map((key) => [key, starts[key]]), now, (key) => store.change({ protocol: begun(of, key, table) }), { id: "choice-start" }), rows("protocol", cards.slice(0, 2)), machine);
  }

  // A start in place of another; a test that begins apart approaches first.
  function begun({ keys, ways, moves }, start, table) {
    const rest = Object.fromEntries(Object.entries(table).filter(([key]) => !ways.includes(key)));
    return { [start]: keys[start].examples[0], ...(start === "start" ? { moves: moves.slice(0, 2) } : {}), ...rest };
  }

  // A material or an interface: its model or law, and for a material the published ones and a laboratory's file.
  function kind(title, table, key, published) {
    const before = store.tables[table], words = kinds[table], choice = words.find((word) => word === before?.[key]) || words[0];
    const change = (word) => store.change({ [table]: words.includes(word) ? { [key]: word, ...values(cardsOf(word, before), before) } : published.find(({ name }) => word === `published ${name}`).table });
    const choices = [...words.map((word) => [word, word]), ...published.map(({ name, title: called }) => [`published ${name}`, called])];
    const measured = (event) => { document.getElementById("tab-material").click(); store.say("material files", [...event.target.files]); };
    const file = published.length ? h("label", { class: "file" }, "from a DMA, relaxation or creep file …", h("input", { class: "unseen", type: "file", multiple: true, id: "material-file", change: measured })) : null;
    return group(title, selection(`${title}: kind`, choices, choice, change, { id: `choice-${table}` }), h("p", { class: "hint" }, tables[choice].description), file, rows(table, cardsOf(choice, before)));
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
    return Object.fromEntries(cards.filter(({ key, optional }) => key in known || !optional).map((card) => [card.key, known[card.key] ?? (card.examples || card.enum)[0]]));
  }

  function rows(table, cards) {
    return cards.map((card) => {
      if (card.enum) return selection(card.description, card.enum.map((word) => [word, word]), store.tables[table]?.[card.key], (word) => store.set(table, card.key, word), { id: `${table}-${card.key}` });
      if (card.units) return area(table, { ...card, rows: 4, label: `${card.description} [${card.units.join(", ")}], a pair a line` }, (line) => line.split(/[,;\t]/).map((cell, i) => valueOf(cell, card.units[i])), (pair) => pair.join(", "));
      return row(table, card);
    });
  }

  function row(table, card) {
    const id = `${table}-${card.key}`, stated = () => store.tables[table]?.[card.key];
    const input = h("input", { type: "text", id, spellcheck: "false", placeholder: card.optional ? "none" : card.examples[0], change: () => store.set(table, card.key, valueOf(input.value, card.unit)) });
    const ends = [h("span"), h("span")], slider = h("input", { type: "range", "aria-label": `${card.description}, slider`, input: () => slide() });
    const track = h("div", { class: "track" }, ends[0], slider, ends[1]);
    let scale = null, quantity = null, dragging = false, before = null;
    const put = () => {
      const text = shown(stated() ?? "");
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
      store.change({ [table]: { ...rest, [card.or.key]: card.or.examples[0] } });
    };
    const found = h("div", { class: "field" }, h("label", { for: id }, card.description, card.symbol ? [" ", h("i", {}, card.symbol)] : null), input, track,
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
    const { table, words } = refusalOf(store.refused), here = all.filter((field) => !table || field.table === table);
    const quoted = ({ input }) => input.value.split("\n").some((line) => line && words.includes(`'${line}'`));
    const wrong = here.find(({ key }) => words.split(/[ :]/)[0] === key) || here.find(quoted) || (table ? here[0] : null);
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
