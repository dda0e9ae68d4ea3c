// The form of an operation, drawn from its declaration: a new option is in it by itself.

import { button, dropped, fold, h } from "./dom.js";
import { cancel, follow, start } from "./server.js";

export class Form {
  constructor(operation, id, skip = []) {
    this.fields = operation.options.filter(({ name }) => !skip.includes(name)).map((one) => {
      const input = control(one, `${id}-${one.name}`);
      return { ...one, input, row: h("div", { class: "field" }, h("label", { for: input.id }, one.name.replaceAll("_", " ")), input, h("p", { class: "hint whole" }, one.words)) };
    });
    const [needed, others] = [true, false].map((is) => this.fields.filter((one) => (one.needed || one.form === "problem") === is).map(({ row }) => row));
    this.needed = h("div", {}, needed);
    this.host = h("div", {}, this.needed, others.length ? fold("more options", others) : null);
  }

  // The words of a refusal. Options that it names, in backquotes, as flags, with underscores or first of all, become fields
  // in sight; the first empty one has the focus.
  refused(words) {
    const spelt = (name) => [`\`${name}\``, `--${name.replaceAll("_", "-")}`, ...(name.includes("_") ? [name] : [])];
    const named = this.fields.filter(({ name }) => spelt(name).some((spelling) => words.includes(spelling)) || RegExp(`^${name}[ :]`).test(words));
    for (const { row } of named) if (!this.needed.contains(row)) this.needed.append(row);
    named.find(({ input }) => !input.value)?.input.focus();
    let said = words.replace(/; for example: viscotack .*$/s, "");
    for (const { name } of named) for (const spelling of spelt(name)) said = said.replaceAll(spelling, name.replaceAll("_", " "));
    return h("p", { class: "refused" }, said);
  }

  // Only what was filled in is asked: what was left out has its default where it is declared.
  get asked() {
    const body = {};
    for (const { name, form, many, input } of this.fields) {
      const text = input.value.trim();
      if (form === "switch") { if (input.checked !== input.defaultChecked) body[name] = input.checked; } else if (!text) continue;
      else if (input.files) body[name] = [...input.files].map((file) => file.name);
      else if (many) body[name] = text.split("\n").map((line) => line.trim()).filter(Boolean);
      else body[name] = form === "problem" && text.startsWith("{") ? tablesOf(text) : text;
      if (input.files && !many) [body[name]] = body[name];
    }
    return body;
  }

  get files() {
    return this.fields.flatMap(({ input }) => [...(input.files || [])]);
  }
}

const tablesOf = (text) => { try { return JSON.parse(text); } catch (error) { throw new Error(`problem is not JSON: ${error.message}`); } };

// Compute, with a bar and a way to cancel it meanwhile; null where it was cancelled.
export async function compute(host, path, body, options) {
  const bar = h("progress", { "aria-label": "How far it is" }), going = h("div", { class: "row" }, bar);
  host.replaceChildren(going);
  const job = await start(path, body, options);
  going.append(button("Cancel", () => { cancel(job); host.replaceChildren(h("p", { class: "hint" }, "cancelled")); }));
  return follow(job, ({ share }) => { if (share) bar.value = share; });
}

// A laboratory's files, read by an operation when they are dropped: what they do not say becomes fields. The answer is
// given to `told`, null where there is none.
export function reader(operation, id, words, told, outputs = []) {
  const form = new Form(operation, id, ["files"]), said = h("div", { role: "status" }), found = { form, said, take, ask, drop: dropped(words, `${id}-files`, take) };
  let files = [];
  form.needed.addEventListener("change", () => files.length && take(files));
  return found;

  async function take(taken) {
    files = taken;
    let answer = null;
    try {
      answer = (await ask(said, operation.path, {}, ["drawn", ...outputs]))?.beside;
    } catch (error) {
      said.replaceChildren(form.refused(error.message), button("Read it again", () => take(files)));
    }
    told(answer);
  }

  // Any operation on these files, read in the same way.
  function ask(host, path, more, outputs = []) {
    return compute(host, path, { ...form.asked, ...more, files: files.map(({ name }) => name) }, { files: [...files, ...form.files], outputs });
  }
}

function control({ form, many, choices, example, unit, default: usual }, id) {
  if (form === "choice" && !many) return h("select", { id }, h("option", { value: "" }, usual === null || usual === "" ? "" : `${usual} (usual)`), choices.map((word) => h("option", { value: word }, word)));
  if (form === "file" || form === "rows") return h("input", { id, type: "file", multiple: many });
  if (form === "switch") return h("input", { id, type: "checkbox", checked: usual === true });
  if (many || form === "problem") return h("textarea", { id, rows: many ? 2 : 8, placeholder: many ? [example || choices.join(", "), "one a line"].filter(Boolean).join(", ") : "" });
  return h("input", { id, placeholder: example || `${usual ?? ""} ${unit === "1" ? "" : unit}`.trim() });
}
