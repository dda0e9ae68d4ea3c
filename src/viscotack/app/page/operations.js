// Every operation that the server knows, by its form; its answer as it is printed, drawn and written.

import { button, fold, h, save, selection } from "./dom.js";
import { Form, compute } from "./form.js";

const EXAMPLES = ["design", "window", "array", "rough"];
// What a command line says of pictures, which the page saves by buttons.
const ON_THE_LINE = /,? to an? \.\w+.*$/;

// A view of some operations, or of all; alone, without the case of the page, where they are named.
export const operations = (id, ...words) => (host, store, title) => {
  const known = words.length ? words.map((word) => store.operations[word]) : Object.values(store.operations).filter(({ local }) => !local);
  const place = h("div"), told = h("div", { role: "status" }), [view, asked] = decodeURIComponent(location.hash.slice(1)).split("=");
  let operation = known.find(({ word }) => view === id && word === asked) || known[0];
  const chosen = (word) => { operation = store.operations[word]; show(); history.replaceState(null, "", `#${hash()}`); };
  const choice = selection("Task", known.map(({ word }) => [word, word]), operation.word, chosen, { id });
  const hash = () => (known.length > 1 ? `${id}=${encodeURIComponent(operation.word)}` : id);
  host.append(h("div", { class: "view asked" },
    h("section", { class: "card side" }, known.length > 1 ? [h("label", { for: id }, "Task"), choice] : h("h2", {}, title), place),
    h("section", { class: "card main" }, h("h2", {}, "Answer"), told)));
  show();
  return { hash, alone: words.length > 0 };

  function show() {
    const form = new Form(operation, id), problem = form.fields.find((field) => field.form === "problem");
    const attached = h("input", { type: "file", multiple: true, id: `${id}-attached` });
    // some answers have no curve to write: what is not asked for is not missed
    const outputs = operation.outputs.map(({ name, words: of, kind }) => {
      const box = h("input", { type: "checkbox", id: `${id}-with-${name}`, checked: words.length > 0 && kind === "picture" });
      return { name, box, line: h("label", { class: "hint" }, box, ` ${name}: ${of.replace(ON_THE_LINE, "").replace(/^Draw$/, "Draw it")}`) };
    });
    const [pictures, more] = [true, false].map((is) => outputs.filter(({ box }) => box.checked === is).map(({ line }) => line));
    const example = words.length ? written(form) : () => null;
    const go = () => ask(form, [...form.files, ...attached.files], example(), outputs.filter(({ box }) => box.checked).map(({ name }) => name));
    if (problem) problem.row.after(button("Take the case of this page", () => { problem.input.value = JSON.stringify(store.tables, null, 1); }));
    place.replaceChildren(h("p", { class: "hint" }, operation.summary), form.host, ...pictures,
      h("div", { class: "field" }, h("label", { for: attached.id }, "other files that it names"), attached), ...(more.length ? [fold("more to save", more)] : []), button("Compute", go, { id: `${id}-ask` }));
    told.replaceChildren();
  }

  // What the needed file contains; it may be written here, where there is an example of it. Returns what says it.
  function written(form) {
    const field = form.fields.find((one) => one.form === "file" && one.needed), name = `${operation.word}.toml`;
    if (!field) return () => null;
    const text = h("textarea", { rows: 18, spellcheck: "false", "aria-label": `${field.name}, as text` });
    const take = button("Write it here, from an example", async () => {
      text.value = await (await fetch(`/page/example-${name}`)).text();
      text.setSelectionRange(0, 0);
      field.row.hidden = true;
      take.replaceWith(text);
      text.focus();
    }, { id: `${id}-example` });
    if (EXAMPLES.includes(operation.word)) field.row.after(take);
    return () => (text.value ? { option: field.name, file: new File([text.value], name) } : null);
  }

  async function ask(form, files, example, outputs) {
    const at = operation;
    try {
      const body = { ...form.asked, ...(example ? { [example.option]: example.file.name } : {}) };
      const answer = await compute(told, at.path, body, { files: example ? [...files, example.file] : files, outputs: ["words", ...outputs] });
      if (answer && at === operation) tell(answer);
    } catch (error) {
      told.replaceChildren(form.refused(error.message));
    }
  }

  function tell({ beside: { words: said, notes, files = {} }, ...record }) {
    const text = JSON.stringify(record, null, 2), pictures = [], saves = [button("Save as JSON", () => save("answer.json", text))];
    for (const { name, kind, endings: [ending = ""] } of operation.outputs.filter((one) => one.name in files)) {
      if (kind === "picture") { pictures.push(picture(files[name], `${operation.word}: ${name}`)); continue; }
      const content = kind === "binary" ? new Blob([Uint8Array.from(atob(files[name]), (x) => x.charCodeAt(0))]) : files[name];
      saves.push(button(`Save ${name}`, () => save(`${operation.path.replaceAll("/", "-")}-${name}${ending}`, content)));
    }
    // sentences are wrapped, rows of a table are not
    const lines = (said || text).split("\n").map((line) => h("span", { class: / {2,}\S+.* {2,}\S/.test(line) ? "rows" : null }, `${line}\n`));
    told.replaceChildren(h("div", { class: "row" }, saves), h("pre", { tabindex: 0, role: "region", "aria-label": "Answer in words" }, lines), ...pictures, ...notes.map((note) => h("p", { class: "hint" }, note)));
  }
};

// A figure that the server has drawn, with a button that saves it.
export function picture(svg, title) {
  const src = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" })), name = `${title.toLowerCase().replaceAll(/[^a-z0-9]+/g, "-")}.svg`;
  return h("figure", {}, h("div", { class: "head" }, h("h2", {}, title), h("div", { class: "exports" }, button("SVG", () => save(name, svg), { "aria-label": `Save ${title} as SVG` }))), h("img", { src, alt: title }));
}
