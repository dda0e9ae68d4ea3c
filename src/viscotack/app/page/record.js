// The record: the state as a link, a file, a command line and Python, and everything to take along.

import { element, save } from "./plot.js";
import { button, card } from "./contact.js";
import { ask } from "./server.js";
import { dropped } from "./files.js";

export class Record {
  constructor(host, store) {
    this.store = store;
    this.host = host;
    const view = element("div", "view");
    host.append(view);
    const left = card(view, "");
    this.link = this.text(left, "Link", () => location.origin + store.address());
    this.toml = this.text(left, "File", () => store.quick?.toml, "case.toml");
    left.append(dropped("a case file (TOML)", ([file]) => this.open(file)));
    this.refused = element("p", "refused");
    this.refused.hidden = true;
    this.refused.setAttribute("role", "alert");
    left.append(this.refused);
    const right = card(view, "");
    this.command = this.text(right, "Command line", () => store.quick?.command);
    right.append(element("p", "hint", "Save the file as case.toml first, and run the lines in its folder."));
    this.python = this.text(right, "Python", () => store.quick?.python, "case.py");
    this.json = this.text(right, "Numbers of the simulation", () => (store.run.answer ? JSON.stringify(store.run.answer.summary, null, 2) : ""), "summary.json");
    right.append(element("p", "hint", "All of them give the same digits. Each picture has buttons for SVG, PNG and CSV. The API is described at "), anchor("/api/docs"));
    for (const name of ["quick", "run"]) store.addEventListener(name, () => this.draw());
  }

  shown() {
    this.draw();
  }

  text(host, title, what, file) {
    const head = element("div", "head"), shown = element("pre", ""), copy = button("copy", () => { navigator.clipboard?.writeText(shown.textContent); copy.textContent = "copied"; });
    copy.setAttribute("aria-label", `Copy: ${title}`);
    head.append(element("h2", "", title), copy);
    if (file) {
      const keep = button("save", () => save(file, new Blob([shown.textContent])));
      keep.setAttribute("aria-label", `Save: ${title}`);
      head.append(keep);
    }
    shown.tabIndex = 0;
    shown.setAttribute("role", "region");
    shown.setAttribute("aria-label", title);
    shown.id = `record-${title.toLowerCase().replaceAll(" ", "-")}`;
    host.append(head, shown);
    return { shown, what };
  }

  async open(file) {
    try {
      const { tables } = await ask("/api/state", { toml: await file.text() });
      this.refused.hidden = true;
      this.store.take(tables);
    } catch (error) {
      this.refused.hidden = false;
      this.refused.textContent = error.message;
    }
  }

  draw() {
    if (this.host.hidden) return;
    for (const { shown, what } of [this.link, this.toml, this.command, this.python, this.json]) {
      const text = what() || "";
      if (shown.textContent !== text) shown.textContent = text;
    }
  }
}

function anchor(where) {
  const link = element("a", "", where);
  link.href = where;
  return link;
}
