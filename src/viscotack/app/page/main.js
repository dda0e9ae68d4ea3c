// The page: its views, its case, and what the address says of them.

import { Store } from "./store.js";
import { Fields } from "./fields.js";
import { Answer } from "./answer.js";
import { Contact } from "./contact.js";
import { Material } from "./material.js";
import { Rig } from "./rig.js";
import { Compare } from "./compare.js";
import { Record } from "./record.js";
import { Operations, some } from "./operations.js";
import { ask } from "./server.js";
import { theme } from "./theme.js";
import { element } from "./plot.js";

// A view more is a line more: its class draws into an element, and listens to the store.
const VIEWS = [["contact", "Contact", Contact], ["material", "Material", Material], ["rig", "Rig", Rig], ["compare", "Compare", Compare], ["record", "Record", Record], ["design", "Design", some("design", "design", "uncertainty")], ["window", "Pick and print", some("window", "window")], ["array", "Arrays", some("array", "array", "theory rectangle")], ["rough", "Rough surfaces", some("rough", "rough")], ["report", "Reports", some("report", "report", "forecast", "next-test")], ["operations", "All operations", Operations]];

async function begin() {
  theme();
  const [forms, { operations }] = await Promise.all([ask("/api/forms"), ask("/api/operations")]);
  const store = new Store(forms);
  store.operations = operations;
  window.viscotack = store;
  const views = tabs(store);
  new Answer(document.getElementById("best"), store);
  new Fields(document.getElementById("fields"), store);
  examples(store);
  let frame = 0;
  // what many events ask for is drawn once
  store.addEventListener("quick", () => { cancelAnimationFrame(frame); frame = requestAnimationFrame(() => { document.body.dataset.drawn = store.version; }); });
  store.addEventListener("run", () => { document.body.dataset.run = store.run.state; });
  await restore(store);
  return views;
}

// The case of the address, or else the first example.
async function restore(store) {
  const more = new URLSearchParams(location.search);
  const query = [...more].filter(([name]) => name.includes("."));
  if (more.get("accuracy")) store.settings.accuracy = Number(more.get("accuracy")) || store.settings.accuracy;
  if (["detached", "pull-off"].includes(more.get("until"))) store.settings.until = more.get("until");
  let tables = Object.values(store.forms.examples)[0];
  if (query.length) tables = await stated(new URLSearchParams(query).toString()) || tables;
  store.take(structuredClone(tables));
  for (const kept of more.getAll("keep").slice(0, 4)) {
    const known = await stated(kept);
    if (!known) continue;
    const quick = await ask("/api/quick", { tables: known }).catch(() => null);
    if (quick) store.kept.push({ tables: known, query: kept, quick, columns: null, summary: null });
  }
  store.say("kept");
}

async function stated(query) {
  try {
    return (await ask("/api/state", { query })).tables;
  } catch (error) {
    document.getElementById("status").textContent = error.message;
    return null;
  }
}

function examples(store) {
  const select = document.getElementById("example");
  const first = element("option", "", "choose …");
  first.value = "";
  select.append(first, ...Object.keys(store.forms.examples).map((words) => element("option", "", words)));
  select.addEventListener("change", () => {
    const tables = store.forms.examples[select.value];
    if (tables) store.take(structuredClone(tables));
  });
}

function tabs(store) {
  const list = document.getElementById("tabs"), content = document.getElementById("content");
  const shown = location.hash.slice(1).split("=")[0];
  const all = VIEWS.map(([id, words, View]) => {
    const tab = element("button", "", words), panel = element("div", "");
    tab.type = "button";
    tab.id = `tab-${id}`;
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-controls", `view-${id}`);
    panel.id = `view-${id}`;
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", tab.id);
    panel.hidden = true;
    list.append(tab);
    content.append(panel);
    const one = { id, tab, panel, view: new View(panel, store) };
    tab.addEventListener("click", () => show(one));
    return one;
  });
  const show = (chosen) => {
    for (const one of all) {
      const is = one === chosen;
      one.panel.hidden = !is;
      one.tab.setAttribute("aria-selected", is);
      one.tab.tabIndex = is ? 0 : -1;
    }
    document.body.dataset.view = chosen.id;
    document.body.classList.toggle("alone", !!chosen.view.alone);
    history.replaceState(null, "", location.pathname + location.search + (chosen.id === all[0].id ? "" : `#${chosen.view.hash || chosen.id}`));
    chosen.view.shown?.();
  };
  list.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    const now = all.findIndex(({ tab }) => tab === document.activeElement);
    const next = all[(now + step + all.length) % all.length];
    show(next);
    next.tab.focus();
    event.preventDefault();
  });
  show(all.find(({ id }) => id === shown) || all[0]);
  return all;
}

begin().catch((error) => {
  const words = document.getElementById("refused"); // before there is a case
  words.hidden = false;
  words.textContent = error.message;
});
