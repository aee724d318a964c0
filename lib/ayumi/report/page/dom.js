// Functions that make and find elements of the page.

export const byId = (id) => document.getElementById(id);

/// Makes an element: element("button", { type: "button", onclick: f, "aria-label": "..." }, "text",
/// child).
export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (name === "value") made.value = value;
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined));
  return made;
}

export function shape(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

/// The same as toFixed, but without a minus before zero.
export const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0(\.0+)?)$/, "$1");

export const seconds = (t) => t.toFixed(3).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "") + " s";

/// Replaces the children of `parent`. The element with the focus gets it again if it still exists
/// (by data-id); otherwise the element at its place or before it gets the focus.
export function refill(parent, children) {
  const id = parent.contains(document.activeElement) ? document.activeElement.dataset.id : undefined;
  const place = [...parent.querySelectorAll("[data-id]")].indexOf(document.activeElement);
  parent.replaceChildren(...children);
  if (id === undefined) return;
  const there = [...parent.querySelectorAll("[data-id]")];
  const same = there.find((one) => one.dataset.id === id) ?? there[Math.min(place, there.length - 1)];
  same?.focus({ preventScroll: true });
}
