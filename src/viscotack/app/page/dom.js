// Elements of the page, and files that leave it.

export const MOST_KEPT = 4;

// h("p", { class: "hint", id }, words, child): a function is a listener, true an attribute without a value.
export function h(tag, attributes = {}, ...children) {
  const found = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") found.addEventListener(name, value);
    else if (value !== false && value !== null && value !== undefined) found.setAttribute(name, value === true ? "" : value);
  }
  found.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return found;
}

export function button(words, click, attributes = {}) {
  return h("button", { type: "button", click, ...attributes }, words);
}

export function copied(label, text) {
  return button("copy", ({ target }) => { navigator.clipboard?.writeText(text()); target.textContent = "copied"; }, { class: "copy", "aria-label": label });
}

export function fold(words, ...children) {
  return h("details", {}, h("summary", {}, words), ...children);
}

export function selection(label, options, value, change, attributes = {}) {
  const of = ([word, words]) => h("option", { value: word, selected: String(word) === String(value) }, String(words));
  return h("select", { "aria-label": label, change: ({ target }) => change(target.value), ...attributes }, options.map(of));
}

// Rows of cells; the first of a row is its heading.
export function table(label, heads, rows) {
  const line = (cells, scope) => h("tr", {}, cells.map((cell, i) => (scope || !i ? h("th", { scope: scope || "row" }, cell) : h("td", {}, cell))));
  return h("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": label }, h("table", {}, h("thead", {}, line(heads, "col")), h("tbody", {}, rows.map((row) => line(row)))));
}

// Fill an element anew where what it shows has changed: a focus and a fold stay where they are.
export function fill(host, key, make) {
  const now = JSON.stringify(key);
  if (host.filled === now) return;
  host.filled = now;
  host.replaceChildren(...make());
}

// A place for files: a browser's field takes those that are dropped on it as well.
export function dropped(words, id, take) {
  const change = ({ target }) => target.files.length && take([...target.files]);
  return h("div", { class: "drop" }, h("label", { for: id }, `Drop ${words} here, or choose`), h("input", { type: "file", multiple: true, id, change }));
}

export function save(name, content) {
  const link = h("a", { href: URL.createObjectURL(content instanceof Blob ? content : new Blob([content])), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

export const escape = (text) => String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");
