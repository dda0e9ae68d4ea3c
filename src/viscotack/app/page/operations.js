// Every operation that the server knows, by its form; its answer as it is printed, drawn and written.

import { element, save } from "./plot.js";
import { button, card } from "./contact.js";
import { Form } from "./form.js";
import { ask, cancel, follow } from "./server.js";

const EXAMPLES = ["design", "window", "array", "rough"];
// What a command line says of files, which the page saves by buttons.
const ON_THE_LINE = /(; - is standard output|,? to an? \.\w+.*)\.?$/;

export class Operations {
  constructor(host, store, id = "operation", words = null) {
    this.alone = !!words; // the case of the page is not asked for
    this.store = store;
    this.id = id;
    this.view = words ? id : "operations";
    const box = element("div", "view asked");
    host.append(box);
    const side = card(box, "side"), label = element("label", "", "Task");
    this.select = element("select", "");
    this.select.id = label.htmlFor = id;
    const there = store.operations.filter(({ refused }) => !refused.http);
    this.known = words ? words.map((name) => there.find(({ word }) => word === name)) : there;
    this.select.append(...this.known.map(({ word }) => element("option", "", word)));
    const [view, word] = decodeURIComponent(location.hash.slice(1)).split("=");
    if (view === this.view && this.known.some((one) => one.word === word)) this.select.value = word;
    this.select.addEventListener("change", () => { this.show(); history.replaceState(null, "", `#${this.hash}`); });
    this.words = element("p", "hint", "");
    this.form = element("div", "");
    if (this.known.length > 1) side.append(label, this.select);
    else side.append(element("h2", "", this.known[0].word));
    side.append(this.words, this.form);
    const main = card(box, "main");
    this.said = element("div", "");
    this.said.setAttribute("role", "status");
    main.append(element("h2", "", "Answer"), this.said);
    this.show();
  }

  // The view and its operation, in the address.
  get hash() {
    return this.known.length > 1 ? `${this.view}=${encodeURIComponent(this.select.value)}` : this.view;
  }

  show() {
    const operation = this.operation = this.known.find(({ word }) => word === this.select.value);
    this.words.textContent = operation.summary;
    this.form.replaceChildren();
    this.fields = new Form(this.form, operation, this.id);
    const problem = this.fields.fields.find(({ form }) => form === "problem");
    if (problem) this.form.append(button("Take the case of this page", () => { problem.input.value = JSON.stringify(this.store.tables, null, 1); }));
    if (this.alone) this.example(operation);
    const attached = element("input", ""), label = element("label", "", "other files that it names"), row = element("div", "field");
    attached.type = "file";
    attached.multiple = true;
    attached.id = label.htmlFor = `${this.id}-attached`;
    row.append(label, attached);
    // some answers have no curve to write: what is not asked for is not missed
    const wanted = element("details", "");
    wanted.append(element("summary", "", "more to save"));
    this.outputs = operation.outputs.map(({ name, words, kind }) => {
      const box = element("input", ""), line = element("label", "hint");
      box.type = "checkbox";
      box.id = `${this.id}-with-${name}`;
      // a tab of its own shows its picture
      box.checked = this.alone && kind === "picture";
      line.append(box, ` ${name}: ${words.replace(ON_THE_LINE, "")}`);
      line.style.display = "block";
      (box.checked ? this.form : wanted).append(line);
      return { name, box };
    });
    const go = button("Compute", () => this.ask(attached.files));
    go.id = `${this.id}-ask`;
    this.form.append(row, ...(wanted.children.length > 1 ? [wanted] : []), go);
    this.said.replaceChildren();
  }

  // What the needed file contains; it may be written here, where there is an example of it.
  example({ word, options }) {
    this.text = null;
    const file = this.file = options.find(({ form, needed }) => form === "file" && needed);
    if (!file) return;
    const place = element("div", ""), row = this.fields.input(file.name).parentElement;
    row.after(place);
    place.append(element("p", "hint", file.words));
    if (!EXAMPLES.includes(word)) return;
    const take = button("Write it here, from an example", async () => {
      const text = element("textarea", ""), found = await fetch(`/page/example-${word}.toml`);
      text.rows = 18;
      text.spellcheck = false;
      text.setAttribute("aria-label", `${file.name}, as text`);
      text.value = await found.text();
      take.replaceWith(text);
      row.hidden = true;
      text.focus();
      text.setSelectionRange(0, 0);
      text.scrollTop = 0;
      this.text = text;
    });
    take.id = `${this.id}-example`;
    place.append(take);
  }

  async ask(files) {
    const { operation } = this, body = this.fields.fill(new FormData());
    if (this.text) body.append(this.file.name, new File([this.text.value], `${operation.word}.toml`));
    for (const file of files) body.append("attached", file);
    body.append("outputs", "words");
    for (const { name, box } of this.outputs) if (box.checked) body.append("outputs", name);
    const bar = element("progress", ""), going = element("div", "row");
    bar.setAttribute("aria-label", "How far it is");
    going.append(bar);
    this.said.replaceChildren(going);
    try {
      const job = await ask(`/api/jobs/${operation.path}`, body);
      going.append(button("Cancel", () => { cancel(job); this.said.replaceChildren(element("p", "hint", "cancelled")); }));
      const answer = await follow(job, ({ share }) => { if (share) bar.value = share; });
      if (answer) this.tell(answer);
    } catch (error) {
      this.said.replaceChildren(this.fields.refused(error.message));
    }
  }

  tell({ beside = {}, ...record }) {
    const { words = "", notes = [], files = {} } = beside, row = element("div", "row"), text = JSON.stringify(record, null, 2);
    row.append(button("Save as JSON", () => save("answer.json", new Blob([text]))));
    const parts = [row, ...notes.map((note) => element("p", "hint", note))];
    for (const { name, kind, words: of } of this.operation.outputs) {
      if (!(name in files)) continue;
      if (kind === "picture") {
        const picture = element("img", "");
        picture.src = URL.createObjectURL(new Blob([files[name]], { type: "image/svg+xml" }));
        picture.alt = `${this.operation.word}: ${name}`;
        parts.push(picture);
      } else row.append(button(`Save ${name}`, () => save(`${this.operation.path.replaceAll("/", "-")}-${name}${/FILE(\.\w+)/.exec(of)?.[1] || (name === "csv" ? ".csv" : "")}`, new Blob([kind === "binary" ? Uint8Array.from(atob(files[name]), (x) => x.charCodeAt(0)) : files[name]]))));
    }
    parts.splice(1, 0, ...inBlocks(words || text));
    this.said.replaceChildren(...parts);
  }
}

// Lines as they are printed: sentences are wrapped, rows of a table are not.
function inBlocks(words) {
  const blocks = [], isRow = (line) => / {2,}\S+.* {2,}\S/.test(line);
  for (const line of words.split("\n")) {
    const row = isRow(line), last = blocks[blocks.length - 1];
    if (last?.row === row) last.lines.push(line);
    else blocks.push({ row, lines: [line] });
  }
  return blocks.map(({ row, lines }) => {
    const block = element("pre", row ? "rows" : "", lines.join("\n"));
    block.tabIndex = 0;
    block.setAttribute("aria-label", row ? "Answer, rows" : "Answer in words");
    return block;
  });
}

// A view of some operations alone.
export const some = (id, ...words) => class extends Operations {
  constructor(host, store) { super(host, store, id, words); }
};
