// The description of the API for people, made from what it says of itself.

import { element } from "./plot.js";
import { ask } from "./server.js";

function named(schema) {
  if (!schema) return "";
  if (schema.$ref) return schema.$ref.split("/").pop();
  if (schema.anyOf) return schema.anyOf.map(named).filter((word) => word !== "null").join(" or ");
  if (schema.type === "array") return `list of ${named(schema.items)}`;
  return schema.enum ? schema.enum.join(" | ") : schema.const || schema.type || "anything";
}

function fields(schema, all) {
  const known = schema?.$ref ? all[schema.$ref.split("/").pop()] : schema;
  return Object.entries(known?.properties || {}).map(([name, one]) => [name, named(one), one.default === undefined ? (known.required || []).includes(name) ? "needed" : "" : JSON.stringify(one.default), one.description || ""]);
}

function table(rows) {
  const found = element("table", ""), head = found.createTHead().insertRow();
  for (const words of ["name", "kind", "when left out", "meaning"]) { const cell = element("th", "", words); cell.scope = "col"; head.append(cell); }
  const body = found.createTBody();
  for (const row of rows) { const line = body.insertRow(); for (const words of row) line.insertCell().textContent = words; }
  return found;
}

const host = document.getElementById("content");
const { paths, components } = await ask("/openapi.json");
for (const [path, methods] of Object.entries(paths)) {
  for (const [method, one] of Object.entries(methods)) {
    const box = element("section", "card wide"), content = Object.values(one.requestBody?.content || {})[0];
    box.append(element("h2", "", `${method.toUpperCase()} ${path}`), element("p", "", one.description || one.summary || ""));
    const rows = (one.parameters || []).map(({ name, schema, required, description }) => [name, named(schema), required ? "needed" : JSON.stringify(schema.default ?? ""), description || schema.description || ""]);
    rows.push(...fields(content?.schema, components.schemas));
    const scroll = element("div", "scroll");
    if (rows.length) scroll.append(table(rows));
    const codes = element("p", "hint", Object.entries(one.responses).map(([code, { description }]) => `${code}: ${description}`).join(" · "));
    box.append(scroll, codes);
    host.append(box);
  }
}
