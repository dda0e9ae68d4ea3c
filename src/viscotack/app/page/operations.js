// Every operation that the server knows, by its form; its answer as it is printed, drawn and written.

import { element, save } from "./plot.js";
import { button, card } from "./contact.js";
import { Form } from "./form.js";
import { ask, cancel, follow } from "./server.js";

export class Operations {
  constructor(host, store, id = "operation", words = null) {
    this.store = store;
    this.id = id;
    const view = element("div", "view asked");
    host.append(view);
    const side = card(view, "side"), label = element("label", "", "What is asked");
    this.select = element("select", "");
    this.select.id = label.htmlFor = id;
    this.known = store.operations.filter(({ word, refused }) => !refused.http && (!words || words.includes(word)));
    this.select.append(...this.known.map(({ word }) => element("option", "", word)));
    this.select.addEventListener("change", () => this.show());
    this.words = element("p", "hint", "");
    this.form = element("div", "");
    side.append(label, this.select, this.words, this.form);
    const main = card(view, "main");
    this.said = element("div", "");
    this.said.setAttribute("role", "status");
    main.append(element("h2", "", "Answer"), this.said);
    this.show();
  }

  show() {
    const operation = this.operation = this.known.find(({ word }) => word === this.select.value);
    this.words.textContent = operation.summary;
    this.form.replaceChildren();
    this.fields = new Form(this.form, operation, this.id);
    const problem = this.fields.fields.find(({ form }) => form === "problem");
    if (problem) this.form.append(button("Take the case of this page", () => { problem.input.value = JSON.stringify(this.store.tables, null, 1); }));
    const attached = element("input", ""), label = element("label", "", "files that an option names"), row = element("div", "field");
    attached.type = "file";
    attached.multiple = true;
    attached.id = label.htmlFor = `${this.id}-attached`;
    row.append(label, attached);
    // some answers have no curve to write: what is not asked for is not missed
    this.outputs = operation.outputs.map(({ name, words, kind }) => {
      const box = element("input", ""), said = element("label", "", `with the ${name}`), line = element("div", "field");
      box.type = "checkbox";
      box.id = said.htmlFor = `${this.id}-with-${name}`;
      box.title = words;
      // a tab of its own shows its picture
      box.checked = this.id !== "operation" && kind === "picture";
      line.append(said, box);
      this.form.append(line);
      return { name, box };
    });
    const go = button("Ask", () => this.ask(attached.files));
    go.id = `${this.id}-ask`;
    this.form.append(row, go);
    this.said.replaceChildren();
  }

  async ask(files) {
    const { operation } = this, body = this.fields.fill(new FormData());
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
      this.said.replaceChildren(element("p", "refused", error.message));
    }
  }

  tell({ beside = {}, ...record }) {
    const { words = "", notes = [], files = {} } = beside, row = element("div", "row"), text = JSON.stringify(record, null, 2);
    row.append(button("Save as JSON", () => save("answer.json", new Blob([text]))));
    const parts = [row, ...notes.map((note) => element("p", "hint", note))];
    for (const { name, kind } of this.operation.outputs) {
      if (!(name in files)) continue;
      if (kind === "picture") {
        const picture = element("img", "");
        picture.src = URL.createObjectURL(new Blob([files[name]], { type: "image/svg+xml" }));
        picture.alt = `${this.operation.word}: ${name}`;
        parts.push(picture);
      } else row.append(button(`Save ${name}`, () => save(name, new Blob([kind === "binary" ? Uint8Array.from(atob(files[name]), (x) => x.charCodeAt(0)) : files[name]]))));
    }
    const lines = element("pre", "", words || text);
    lines.tabIndex = 0;
    lines.setAttribute("aria-label", "Answer in words");
    parts.splice(1, 0, lines);
    this.said.replaceChildren(...parts);
  }
}

// Two contacts of one object: which opens first.
export class PickAndPrint extends Operations {
  constructor(host, store) { super(host, store, "window", ["window"]); }
}

// Many pads on one backing, and stamps that are not round.
export class PadArray extends Operations {
  constructor(host, store) { super(host, store, "array", ["array", "theory rectangle"]); }
}
