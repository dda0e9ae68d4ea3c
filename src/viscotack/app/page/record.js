// The record: the state as a link, a file, a command line and Python, and everything to take along.

import { button, copied, dropped, h, save } from "./dom.js";
import { ask } from "./server.js";

export function record(host, store) {
  const refused = h("p", { class: "refused", role: "alert", hidden: true }), texts = [];
  host.append(h("div", { class: "view" },
    h("section", { class: "card" }, text("Link", () => location.origin + store.address), text("File", () => store.quick?.toml, "case.toml"), dropped("a case file (TOML)", "record-files", open), refused),
    h("section", { class: "card" }, text("Command line", () => store.quick?.command), h("p", { class: "hint" }, "Save the file as case.toml first, and run the lines in its folder."),
      text("Python", () => store.quick?.python, "case.py"), text("Numbers of the simulation", () => store.run.answer && JSON.stringify(store.run.answer.summary, null, 2), "summary.json"),
      h("p", { class: "hint" }, "All of them give the same digits. Each picture has buttons for SVG, PNG and CSV. The API is described at ", h("a", { href: "/api/docs" }, "/api/docs")))));
  store.on("quick run kept", draw);
  return { shown: draw };

  function text(title, what, file) {
    const shown = h("pre", { tabindex: 0, role: "region", "aria-label": title, id: `record-${title.toLowerCase().replaceAll(" ", "-")}` });
    const keep = file ? button("save", () => save(file, shown.textContent), { "aria-label": `Save: ${title}` }) : null;
    texts.push([shown, what]);
    return [h("div", { class: "head" }, h("h2", {}, title), copied(`Copy: ${title}`, () => shown.textContent), keep), shown];
  }

  async function open([file]) {
    try {
      store.take((await ask("/api/state", { toml: await file.text() })).tables);
      refused.hidden = true;
    } catch (error) {
      refused.hidden = false;
      refused.textContent = error.message;
    }
  }

  function draw() {
    if (!host.hidden) for (const [shown, what] of texts) if (shown.textContent !== (what() || "")) shown.textContent = what() || "";
  }
}
