// The form of an operation, drawn from its declaration: a new option is in it by itself.

import { element } from "./plot.js";

const ROWS = { problem: 8, rows: 4 };

export class Form {
  constructor(host, operation, id, { skip = [] } = {}) {
    this.fields = [];
    const more = element("details", ""), needed = this.needed = element("div", "");
    more.append(element("summary", "", "more options"));
    for (const one of operation.options) {
      if (skip.includes(one.name) || one.form === "folder") continue;
      const row = element("div", "field"), label = element("label", "", one.name.replaceAll("_", " ")), input = control(one);
      input.id = label.htmlFor = `${id}-${one.name}`;
      input.title = one.words;
      row.append(label, input);
      (one.needed ? needed : more).append(row);
      this.fields.push({ ...one, input });
    }
    host.append(needed);
    if (more.children.length > 1) host.append(more);
  }

  // A field, for whoever drew the form and fills it: with files that are dropped, the case of the page.
  input(name) {
    return this.fields.find((field) => field.name === name)?.input;
  }

  // The words of a refusal; the options that it names become fields in sight, the first of them with the focus.
  refused(words) {
    const spoken = (name) => name.replaceAll("_", " ");
    // a name of one word may be a word of the sentence as well, and is one where it stands in a list of what to give
    const named = this.fields.filter(({ name }) => new RegExp(name.includes("_") ? `\\b${name}\\b` : `(give |needs |, | or | and )${name}(?= "|,| or |$)`).test(words));
    for (const { input } of named) this.needed.append(input.parentElement);
    named[0]?.input.focus();
    return element("p", "refused", named.reduce((text, { name }) => text.replaceAll(name, spoken(name)), words));
  }

  // Only what was filled in is sent: what was left out has its default where it is declared.
  fill(body) {
    for (const { name, form, many, input } of this.fields) {
      if (form === "file") for (const file of input.files) body.append(name, file);
      else if (form === "switch") { if (input.checked !== input.defaultChecked) body.append(name, String(input.checked)); }
      else if (many) for (const line of input.value.split("\n")) { if (line.trim()) body.append(name, line.trim()); }
      else if (input.value.trim()) body.append(name, input.value.trim());
    }
    return body;
  }
}

function control(one) {
  if (one.form === "choice" && !one.many) {
    const select = element("select", ""), usual = element("option", "", one.default === null || one.default === "" ? "" : `${one.default} (usual)`);
    usual.value = "";
    select.append(usual, ...one.choices.map((word) => element("option", "", word)));
    return select;
  }
  if (one.many && one.form !== "file" || ROWS[one.form]) {
    const area = element("textarea", "");
    area.rows = ROWS[one.form] || 2;
    area.placeholder = one.many ? `${one.example || one.choices.join(", ")}, one a line` : one.form === "rows" ? '[{"protocol.speed": 1e-5}]' : "";
    return area;
  }
  const input = element("input", "");
  if (one.form === "file") { input.type = "file"; input.multiple = one.many; }
  else if (one.form === "switch") { input.type = "checkbox"; input.checked = input.defaultChecked = one.default === true; }
  else input.placeholder = one.example || (one.default === null ? one.unit === "1" ? "" : one.unit : String(one.default));
  return input;
}
