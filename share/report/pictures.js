// SPDX-License-Identifier: Apache-2.0
// Pictures, their colour bars, and how a picture is enlarged.

// image/difference.cpp's colours from -scale to scale, at equal steps.
const falseColors = ["rgb(5,48,97)", "rgb(33,102,172)", "rgb(67,147,195)", "rgb(146,197,222)", "rgb(209,229,240)",
                     "rgb(255,255,255)", "rgb(253,219,199)", "rgb(244,165,130)", "rgb(214,96,77)", "rgb(178,24,43)",
                     "rgb(103,0,31)"];

// Of a picture whose largest difference is `largest`: what exceeds the scale is shown like its ends.
function colorBar(scale, largest) {
  const text = scale ? numberText(scale) : "0";
  const clipped = !isMissing(largest) && largest > scale;
  const [below, above] = clipped ? ["≤ ", "≥ "] : ["", ""];
  return element("div", { class: "color-bar" },
    element("div", { class: "colors", style: `background: linear-gradient(to right, ${falseColors.join(", ")})` }),
    element("div", { class: "color-ends" }, element("span", null, `${below}${scale ? minus : ""}${text}`),
      element("span", null, "0"), element("span", null, `${above}${scale ? "+" : ""}${text} /255`)),
    clipped ? element("div", { class: "clipped" }, `clipped: up to ${numberText(largest)}/255 here`) : null);
}

// The share of a scale below which false colours look white.
const faintestShare = 0.05;

// ".1": the power of ten above a number.
function powerAbove(value) {
  const exponent = Math.floor(Math.log10(value)) + 1;
  if (exponent >= 0) return String(10 ** exponent);
  return exponent < -6 ? `10${superscript(exponent)}` : `.${"0".repeat(-exponent - 1)}1`;
}

// Returns the text for a difference picture that is white all over; null for others.
function nothingToSee(scale, largest) {
  if (isMissing(scale) || isMissing(largest) || largest >= faintestShare * scale) return null;
  const text = largest === 0 ? "no difference" : `nothing to see: below ${powerAbove(largest)}`;
  return element("span", { class: "nothing" }, text);
}

// Small pictures are shown in whole multiples of their size, so that each of their pixels is a square.
function shownSize(width, height) {
  const times = Math.max(1, Math.floor(256 / width));
  return { width: times * width, height: times * height };
}

// When a picture is loaded that comes without its size.
function setShownSize({ target }) {
  fill(target, shownSize(target.naturalWidth, target.naturalHeight), []);
}

// The one picture that fills the window: as large a multiple of its pixels as fits. A click or the
// Escape key closes it.
const enlarged = element("dialog", { id: "enlarged", "aria-label": "enlarged picture", click: () => enlarged.close() });

function enlarge(image, caption) {
  const room = [window.innerWidth - 48, window.innerHeight - 120];
  const fits = Math.min(room[0] / image.naturalWidth, room[1] / image.naturalHeight);
  const times = fits >= 1 ? Math.floor(fits) : fits;
  enlarged.replaceChildren(
    picture(image.src, image.alt, { width: Math.round(times * image.naturalWidth),
                                    height: Math.round(times * image.naturalHeight) }),
    element("p", null, caption, " ", element("button", { type: "button" }, "close")));
  enlarged.showModal();
}

// A picture with what it shows as its alternative text, and a caption; null if there is none. `inside`:
// what stands in the picture, or null.
function pictureFigure(source, description, caption, size, inside, ...more) {
  const image = picture(source, description, size);
  const button = image && element("button", { type: "button", class: "enlarges", title: "enlarge",
                                              click: () => enlarge(image, description) }, image, inside);
  return image && element("figure", { class: "picture" }, button, element("figcaption", null, caption), ...more);
}
