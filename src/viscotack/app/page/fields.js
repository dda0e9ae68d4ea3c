// The fields of the case, made from what the server says can be asked: no noun is known by name.

import { element } from "./plot.js";
import { read, said, shown, sliderOf, written } from "./numbers.js";

let count = 0;

export class Fields {
  constructor(form, store) {
    this.form = form;
    this.store = store;
    this.shown = "";
    // on a phone the indenter and the test, and all that is drawn of them, come first
    this.closed = new Set(matchMedia("(max-width: 46rem)").matches ? ["Material", "Interface", "Simulation"] : []);
    form.addEventListener("submit", (event) => event.preventDefault());
    store.addEventListener("case", () => this.show());
    store.addEventListener("quick", () => this.mark());
  }

  // Make the form anew where other fields are asked for; else only put in the numbers.
  show() {
    const wanted = JSON.stringify(Object.entries(this.store.tables).map(([name, table]) => [name, table.model, table.law, table.base, Object.keys(table)]));
    if (wanted !== this.shown) {
      this.shown = wanted;
      this.make();
    }
    for (const field of this.all) field.put();
  }

  make() {
    const { forms, tables } = this.store;
    this.all = [];
    const focused = document.activeElement?.id;
    const shape = forms.shape.find(({ word }) => word in tables) || forms.shape[0];
    const parts = [this.shapes(shape)];
    if (shape.symmetry === "plane") parts.push(this.layer());
    parts.push(
      this.protocol(forms.protocol[shape.symmetry]),
      this.chosen("Material", "material", "model", forms.material),
      this.chosen("Interface", "interface", "law", forms.interface),
      this.running(),
    );
    this.form.replaceChildren(...parts);
    if (focused) document.getElementById(focused)?.focus();
  }

  chosen(title, table, key, choices) {
    const set = this.group(title), now = this.store.tables[table]?.[key];
    const choice = choices.find(({ word }) => word === now) || choices[0];
    const published = table === "material" ? this.store.forms.materials : [];
    const select = selection(`${title}: kind`, [
      ...choices.map(({ word }) => [word, word]),
      ...published.map(({ name, title: words }) => [`published ${name}`, words]),
    ], choice.word);
    select.id = `choice-${table}`;
    select.addEventListener("change", () => {
      const known = published.find(({ name }) => select.value === `published ${name}`);
      if (known) return this.replace(table, known.table);
      const next = choices.find(({ word }) => word === select.value);
      this.replace(table, { [key]: next.word, ...this.values(next.fields, this.store.tables[table]) });
    });
    set.append(select, hint(choice.words));
    if (table === "material") set.append(this.measured());
    for (const field of choice.fields) set.append(this.row(table, field));
    return set;
  }

  // A laboratory's file in place of numbers: it is read in the view of the material.
  measured() {
    const label = element("label", "file", "from a DMA, relaxation or creep file …"), input = element("input", "unseen");
    input.type = "file";
    input.multiple = true;
    input.id = "material-file";
    input.addEventListener("change", () => {
      document.getElementById("tab-material").click();
      this.store.say("material files", [...input.files]);
    });
    label.append(input);
    return label;
  }

  shapes(shape) {
    const set = this.group("Indenter"), { forms } = this.store;
    const select = selection("Indenter: shape", forms.shape.map(({ word }) => [word, word]), shape.word);
    select.id = "choice-shape";
    select.addEventListener("change", () => {
      const next = forms.shape.find(({ word }) => word === select.value);
      const tables = structuredClone(this.store.tables);
      delete tables[shape.word];
      delete tables.layer;
      const { protocol, ...others } = tables;
      const made = { ...others, [next.word]: this.values(next.fields, {}) };
      if (next.symmetry === "plane") made.layer = { ...this.values(forms.layer.fields, {}), base: forms.layer.bases[0].word };
      made.protocol = next.symmetry === shape.symmetry ? protocol : this.start(forms.protocol[next.symmetry].starts[0], protocol);
      this.store.take(made);
    });
    set.append(select);
    for (const field of shape.fields) set.append(this.row(shape.word, field));
    return set;
  }

  layer() {
    const set = this.group("Layer"), { layer } = this.store.forms;
    const select = selection("Layer: base", layer.bases.map(({ word }) => [word, word]), this.store.tables.layer?.base);
    select.id = "choice-layer";
    select.addEventListener("change", () => this.store.set("layer", "base", select.value));
    set.append(select);
    for (const field of layer.fields) set.append(this.row("layer", field));
    return set;
  }

  protocol(asked) {
    const set = this.group("Test"), table = this.store.tables.protocol || {};
    const now = asked.starts.find(({ key }) => key in table) || asked.starts[0];
    const select = selection("Test: how it begins", asked.starts.map(({ key, title }) => [key, title]), now.key);
    select.id = "choice-start";
    select.addEventListener("change", () => {
      const next = asked.starts.find(({ key }) => key === select.value);
      this.replace("protocol", this.start(next, table));
    });
    const machine = element("details", "hint");
    machine.open = "stiffness" in table || "moves" in table;
    machine.append(element("summary", "", "spring of the machine, moves before the pull"), this.row("protocol", asked.stiffness), this.moves(asked.moves));
    set.append(select, this.row("protocol", now), this.row("protocol", asked.speed), machine);
    return set;
  }

  // A start in place of another; a test that begins apart approaches first.
  start(next, table) {
    const rest = Object.fromEntries(Object.entries(table).filter(([key]) => !key.startsWith("preload_") && key !== "start"));
    const first = next.prefix && !rest.moves ? { moves: ["approach 20 um/s to force 0.5 mN", "dwell 1 s"] } : {};
    return { [next.key]: `${next.prefix || ""}${next.example}`, ...first, ...rest };
  }

  moves(examples) {
    const row = element("div", "field"), id = `field${count += 1}`;
    const label = element("label", "", "moves before the pull, one a line");
    label.htmlFor = id;
    const area = element("textarea", "");
    area.id = id;
    area.rows = 2;
    area.placeholder = examples.slice(0, 2).join("\n");
    area.addEventListener("change", () => {
      const moves = area.value.split("\n").map((line) => line.trim()).filter(Boolean);
      this.store.set("protocol", "moves", moves.length ? moves : null);
    });
    row.append(label, area);
    const more = element("details", "hint"), what = element("summary", "", "what a machine can do");
    more.append(what, document.createTextNode(examples.join("; ")));
    row.append(more);
    more.style.gridColumn = "1 / -1";
    this.all.push({ key: "moves", table: "protocol", row, put: () => { if (document.activeElement !== area) area.value = (this.store.tables.protocol?.moves || []).join("\n"); } });
    return row;
  }

  running() {
    const set = this.group("Simulation"), { store } = this;
    const accuracy = selection("Accuracy of the force", [[0.02, "2 %"], [0.01, "1 %"], [0.005, "0.5 %"], [0.002, "0.2 %"], [0.0005, "0.05 %"]], store.settings.accuracy);
    accuracy.id = "choice-accuracy";
    accuracy.addEventListener("change", () => store.configure("accuracy", Number(accuracy.value)));
    const until = selection("How far to pull", [["detached", "until apart"], ["pull-off", "past the pull-off"]], store.settings.until);
    until.id = "choice-until";
    until.addEventListener("change", () => store.configure("until", until.value));
    const auto = element("label", "hint"), box = element("input", "");
    box.type = "checkbox";
    box.checked = store.auto;
    box.addEventListener("change", () => { store.auto = box.checked; });
    auto.append(box, document.createTextNode(" simulate when the numbers rest"));
    const row = element("div", "row");
    row.append(accuracy, until);
    set.append(row, auto);
    return set;
  }

  replace(table, values) {
    this.store.take({ ...structuredClone(this.store.tables), [table]: structuredClone(values) });
  }

  // Values of fields: those that are known already, else their examples.
  values(fields, known = {}) {
    const found = {};
    for (const field of fields) {
      if (field.key in known) found[field.key] = known[field.key];
      else if (field.or && field.or.key in known) found[field.or.key] = known[field.or.key];
      else if (!field.optional) found[field.key] = field.kind === "pairs" ? JSON.parse(field.example) : field.example;
    }
    return found;
  }

  row(table, card) {
    if (card.kind === "pairs") return this.pairs(table, card);
    const known = this.store.tables[table] || {};
    if (card.or && card.or.key in known) card = { ...card.or, or: card };
    const row = element("div", "field"), id = `${table}-${card.key}`;
    const label = element("label", "", card.words);
    label.htmlFor = id;
    if (card.symbol) label.append(" ", element("i", "", card.symbol));
    if (card.range) label.title = `must ${card.range}`;
    const input = element("input", "");
    input.type = "text";
    input.id = id;
    input.spellcheck = false;
    input.placeholder = card.optional ? "none" : card.example;
    const slider = element("input", ""), track = element("div", "track"), ends = [element("span", ""), element("span", "")];
    slider.type = "range";
    slider.setAttribute("aria-label", `${card.words}, slider`);
    track.append(ends[0], slider, ends[1]);
    let scale = null, quantity = null, dragging = false, before = null;
    const put = () => {
      const text = shown(this.store.tables[table]?.[card.key] ?? "");
      if (text === before && text === input.value) return; // a slider that moves leaves the other fields alone
      before = text;
      if (document.activeElement !== input) input.value = text;
      slider.setAttribute("aria-valuetext", text);
      if (dragging) return;
      quantity = read(text, card.unit);
      scale = quantity && sliderOf(card, quantity);
      track.hidden = !scale;
      if (!scale) return;
      slider.min = scale.min; slider.max = scale.max; slider.step = scale.step;
      slider.value = scale.of(quantity.number);
      ends.forEach((end, i) => { end.textContent = said(scale.ends[i], quantity.unit, 2); });
    };
    input.addEventListener("change", () => this.store.set(table, card.key, input.value.trim() === "" ? null : input.value.trim()));
    slider.addEventListener("input", (event) => {
      dragging = true;
      this.store.set(table, card.key, written({ ...quantity, number: scale.at(Number(slider.value)) }), { began: event.timeStamp });
      dragging = false;
    });
    row.append(label, input, track);
    if (card.or) row.append(this.other(table, card));
    this.all.push({ key: card.key, table, row, put });
    return row;
  }

  // The same said by another number, a range by a strength.
  other(table, card) {
    const button = element("button", "hint", `state the ${card.or.key.replaceAll("_", " ")} instead`);
    button.type = "button";
    button.style.gridColumn = "1 / -1";
    button.addEventListener("click", () => {
      const tables = structuredClone(this.store.tables);
      delete tables[table][card.key];
      tables[table][card.or.key] = card.or.example;
      this.store.take(tables);
    });
    return button;
  }

  pairs(table, card) {
    const row = element("div", "field"), id = `${table}-${card.key}`;
    const label = element("label", "", `${card.words} [${card.units.join(", ")}], a pair a line`);
    label.htmlFor = id;
    const area = element("textarea", "");
    area.id = id;
    area.rows = 4;
    area.addEventListener("change", () => {
      const pairs = area.value.split("\n").map((line) => line.split(/[,;\t]/).map((x) => x.trim())).filter((pair) => pair.join(""));
      this.store.set(table, card.key, pairs);
    });
    row.append(label, area);
    this.all.push({ key: card.key, table, row, put: () => {
      if (document.activeElement !== area) area.value = (this.store.tables[table]?.[card.key] || []).map((pair) => pair.join(", ")).join("\n");
    } });
    return row;
  }

  // Say a refusal at the field that it names, "the case, [sphere] radius must be positive, got -5 mm"; where it names
  // only a table, at the field whose words it quotes.
  mark() {
    const words = this.store.refused, [, table, rest] = /\[([\w-]+)\] (.*)/.exec(words) || [];
    const here = this.all.filter((field) => field.table === table);
    const wrong = here.find(({ key }) => rest.split(/[ :]/)[0] === key) || here.find(({ row }) => [...row.querySelectorAll("input, textarea")].some(({ value }) => value.split("\n").some((line) => line && rest.includes(`'${line}'`)))) || here[0];
    for (const { row } of this.all) {
      const is = row === wrong?.row, field = row.querySelector("input[type=text], textarea");
      row.classList.toggle("wrong", is);
      field.setAttribute("aria-invalid", is);
      let problem = row.querySelector(".problem");
      if (!is) { problem?.remove(); field.removeAttribute("aria-describedby"); continue; }
      if (!problem) row.append(problem = element("p", "problem refused"));
      problem.id = `${field.id}-problem`;
      problem.textContent = rest;
      field.setAttribute("aria-describedby", problem.id);
      for (let up = row.closest("details"); up; up = up.parentElement.closest("details")) up.open = true;
    }
  }

  group(title) {
    const set = element("details", "group");
    set.open = !this.closed.has(title);
    set.addEventListener("toggle", () => this.closed[set.open ? "delete" : "add"](title));
    set.append(element("summary", "", title));
    return set;
  }
}

function hint(words) {
  return element("p", "hint", words);
}

export function selection(label, options, value) {
  const select = element("select", "");
  select.setAttribute("aria-label", label);
  for (const [word, words] of options) {
    const option = element("option", "", String(words));
    option.value = word;
    option.selected = String(word) === String(value);
    select.append(option);
  }
  return select;
}
