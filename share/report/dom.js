// SPDX-License-Identifier: Apache-2.0
// Making elements. All files of this folder become one module script of the page, in the order that
// page.html names them: nothing of them is global. Strings of the report enter the page only as text
// and attributes, never as markup.

const svgNamespace = "http://www.w3.org/2000/svg";

// Attributes that are functions listen to the event of that name; null and false leave one out.
function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (typeof value === "function") node.addEventListener(name, value);
    else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(name, value === true ? "" : value);
    }
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return node;
}

function element(tag, attributes, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

function drawn(tag, attributes, ...children) {
  return fill(document.createElementNS(svgNamespace, tag), attributes, children);
}

// Only pictures that are in the document itself; decoded when they come into sight.
function picture(source, description, attributes) {
  if (typeof source !== "string" || !source.startsWith("data:image/")) return null;
  return element("img", { src: source, alt: description, decoding: "async", ...attributes });
}

// A list of terms and what they are; pairs without a value are left out.
function factList(pairs) {
  const given = pairs.filter(([, value]) => value !== null && value !== undefined && value !== "");
  return element("dl", { class: "facts" }, given.map(([term, value]) =>
    element("div", null, element("dt", null, term), element("dd", null, value))));
}
