// The record: the state as a link, a file, a command line and Python, and everything to take along.

import { button, copied, dropped, h, save } from "./dom.js";
import { moveOf } from "./numbers.js";
import { ask } from "./server.js";

// Tables as a case file; and what simulates it, once it is saved as case.toml.
export const tomlOf = (tables) => Object.entries(tables).map(([name, table]) => [`[${name}]`, ...Object.entries(table).map(([key, value]) => `${key} = ${JSON.stringify(Array.isArray(value) ? value.map(moveOf) : value)}`), ""].join("\n")).join("\n");
export const commandOf = ({ accuracy, until }) => `viscotack simulate case case.toml --accuracy ${accuracy} --until ${until}\nviscotack predict case.toml\n`;
export const pythonOf = ({ accuracy, until }) => `from viscotack import read_case, solve, summary\n\nresult = solve(read_case("case.toml"), accuracy=${accuracy}, until="${until}")\nprint(summary(result))\n`;

export function record(host, store) {
  const refused = h("p", { class: "refused", role: "alert", hidden: true }), texts = [];
  host.append(h("div", { class: "view" },
    h("section", { class: "card" }, text("Link", () => location.origin + store.address), text("File", () => tomlOf(store.tables), "case.toml"), dropped("a case file (TOML)", "record-files", open), refused),
    h("section", { class: "card" }, text("Command line", () => commandOf(store.settings)), h("p", { class: "hint" }, "Save the file as case.toml first, and run the lines in its folder."),
      text("Python", () => pythonOf(store.settings), "case.py"), text("Numbers of the simulation", () => store.run.answer && JSON.stringify(store.run.answer.summary, null, 2), "summary.json"),
      h("p", { class: "hint" }, "All of them give the same digits. Each picture has buttons that save it. The API is described at ", h("a", { href: "/api/docs" }, "/api/docs")))));
  store.on("quick run kept", draw);
  return { shown: draw };

  function text(title, what, file) {
    const shown = h("pre", { tabindex: 0, role: "region", "aria-label": title, id: `record-${title.toLowerCase().replaceAll(" ", "-")}` });
    const keep = file ? button("save", () => save(file, shown.textContent), { class: "copy", "aria-label": `Save: ${title}` }) : null;
    texts.push([shown, what]);
    return [h("div", { class: "head" }, h("h2", {}, title), copied(`Copy: ${title}`, () => shown.textContent), keep), shown];
  }

  async function open([file]) {
    try {
      store.take((await ask("/api/tables", { toml: await file.text() })).tables);
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
