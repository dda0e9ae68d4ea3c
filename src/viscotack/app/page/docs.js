// The description of the API for people, made from what it says of itself.

import { h, table } from "./dom.js";
import { ask } from "./server.js";

function named(schema) {
  if (schema.$ref) return schema.$ref.split("/").pop();
  if (schema.anyOf) return schema.anyOf.map(named).filter((word) => word !== "null").join(" or ");
  if (schema.type === "array") return `list of ${named(schema.items)}`;
  return schema.enum ? schema.enum.join(" | ") : schema.const || schema.type || "anything";
}

const { paths, components } = await ask("/openapi.json");
const fields = (schema) => {
  const { properties = {}, required = [] } = components.schemas[schema?.$ref?.split("/").pop()] || schema || {};
  return Object.entries(properties).map(([name, one]) => ({ name, schema: one, required: required.includes(name), description: one.description }));
};
document.getElementById("content").append(...Object.entries(paths).flatMap(([path, methods]) => Object.entries(methods).map(([method, one]) => {
  const asked = [...(one.parameters || []), ...fields(Object.values(one.requestBody?.content || {})[0]?.schema)];
  const rows = asked.map(({ name, schema, required, description }) => [name, named(schema), required ? "needed" : JSON.stringify(schema.default ?? ""), description || schema.description || ""]);
  return h("section", { class: "card wide" }, h("h2", {}, `${method.toUpperCase()} ${path}`), h("p", {}, one.description || one.summary || ""),
    rows.length ? table(`Options of ${path}`, ["name", "kind", "when left out", "meaning"], rows) : null,
    h("p", { class: "hint" }, Object.entries(one.responses).map(([code, { description }]) => `${code}: ${description}`).join(" · ")));
})));
