// The page: its views, its case, and what the address says of them.

import { answer } from "./answer.js";
import { compare } from "./compare.js";
import { contact } from "./contact.js";
import { MOST_KEPT, h } from "./dom.js";
import { fields } from "./fields.js";
import { material } from "./material.js";
import { operations } from "./operations.js";
import { record } from "./record.js";
import { rig } from "./rig.js";
import { ask } from "./server.js";
import { Store } from "./store.js";

// A view more is a line more: its function draws into an element, and listens to the store.
const VIEWS = [
  ["contact", "Contact", contact], ["material", "Material", material], ["rig", "Rig", rig], ["compare", "Compare", compare], ["record", "Record", record],
  ["design", "Design", operations("design", "design", "uncertainty")], ["window", "Pick and print", operations("window", "window")],
  ["array", "Arrays", operations("array", "array")], ["rough", "Rough surfaces", operations("rough", "rough")],
  ["report", "Reports", operations("report", "report", "forecast", "next-test")], ["operations", "All operations", operations("operations")],
];
const at = (id) => document.getElementById(id);

async function begin() {
  theme();
  const [forms, known] = await Promise.all([ask("/api/forms"), ask("/api/operations")]);
  const store = window.viscotack = new Store(forms, known.operations);
  tabs(store);
  answer(at("best"), store);
  fields(at("fields"), store);
  at("example").append(h("option", { value: "" }, "choose …"), ...Object.keys(forms.examples).map((words) => h("option", { value: words }, words)));
  at("example").addEventListener("change", ({ target }) => target.value && store.take(forms.examples[target.value]));
  store.on("run", () => { document.body.dataset.run = store.run.state; });
  await restore(store);
}

// Light or dark, as the system has it or as was chosen before.
function theme() {
  const root = document.documentElement, system = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  let kept = {};
  try { kept = localStorage; } catch { /* a browser that keeps nothing */ }
  root.dataset.theme = kept.theme || system;
  at("theme").addEventListener("click", () => { kept.theme = root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark"; });
}

// The state of the address, or else the first example.
async function restore(store) {
  let state = {};
  try {
    state = JSON.parse(new URLSearchParams(location.search).get("state")) || {};
    for (const each of [state.case || {}, ...(state.kept || [])]) if (![each, ...Object.values(each)].every((table) => table instanceof Object)) throw new TypeError();
  } catch {
    state = {};
    at("status").textContent = "the link is not whole; the first example is shown";
  }
  const { case: tables, kept = [], ...settings } = state;
  for (const name of ["accuracy", "until"]) if (settings[name]) store.settings[name] = settings[name];
  store.take(tables || Object.values(store.forms.examples)[0]);
  for (const one of kept.slice(0, MOST_KEPT)) {
    const quick = await ask("/api/quick", { problem: one }).catch(() => null);
    store.keep(one, quick, null);
  }
}

function tabs(store) {
  const shown = location.hash.slice(1).split("=")[0];
  const all = VIEWS.map(([id, words, make]) => {
    const panel = h("div", { id: `view-${id}`, role: "tabpanel", "aria-labelledby": `tab-${id}`, hidden: true });
    const one = { id, panel, tab: h("button", { type: "button", id: `tab-${id}`, role: "tab", "aria-controls": panel.id, click: () => show(one) }, words) };
    at("tabs").append(one.tab);
    at("content").append(panel);
    one.view = make(panel, store, words) || {};
    return one;
  });
  const show = (chosen) => {
    for (const { tab, panel } of all) {
      const is = panel === chosen.panel;
      panel.hidden = !is;
      tab.setAttribute("aria-selected", is);
      tab.tabIndex = is ? 0 : -1;
    }
    document.body.dataset.view = chosen.id;
    document.body.classList.toggle("alone", !!chosen.view.alone);
    history.replaceState(null, "", location.pathname + location.search + (chosen === all[0] ? "" : `#${chosen.view.hash?.() || chosen.id}`));
    chosen.view.shown?.();
  };
  at("tabs").addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const next = all[(all.findIndex(({ tab }) => tab === document.activeElement) + step + all.length) % all.length];
    show(next);
    next.tab.focus();
    event.preventDefault();
  });
  show(all.find(({ id }) => id === shown) || all[0]);
}

begin().catch((error) => { // before there is a case
  at("refused").hidden = false;
  at("refused").textContent = error.message;
});
