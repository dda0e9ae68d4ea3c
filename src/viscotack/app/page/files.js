// Files that are dropped, or chosen by the keyboard.

import { element } from "./plot.js";

let count = 0;

export function dropped(words, take) {
  const box = element("div", "drop"), label = element("label", "", `Drop ${words} here, or choose them`), input = element("input", "");
  input.type = "file";
  input.multiple = true;
  input.id = `files${count += 1}`;
  label.htmlFor = input.id;
  input.addEventListener("change", () => input.files.length && take([...input.files]));
  box.append(label, document.createElement("br"), input);
  for (const name of ["dragenter", "dragover"]) box.addEventListener(name, (event) => { event.preventDefault(); box.classList.add("over"); });
  for (const name of ["dragleave", "drop"]) box.addEventListener(name, () => box.classList.remove("over"));
  box.addEventListener("drop", (event) => { event.preventDefault(); if (event.dataTransfer.files.length) take([...event.dataTransfer.files]); });
  return box;
}
