// Light or dark, as the system has it or as was chosen before.

export function theme() {
  const root = document.documentElement;
  const set = (name) => { root.dataset.theme = name; dispatchEvent(new Event("resize")); };
  let known = null;
  try { known = localStorage.getItem("theme"); } catch { /* a browser that keeps nothing */ }
  set(known || (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
  document.getElementById("theme").addEventListener("click", () => {
    set(root.dataset.theme === "dark" ? "light" : "dark");
    try { localStorage.setItem("theme", root.dataset.theme); } catch { /* the same */ }
  });
}
