// SPDX-License-Identifier: Apache-2.0
// The frame of a plot, and what is shown of the point under the pointer.

const chartMargins = { left: 62, right: 14, top: 10, bottom: 44 };

// Axes and grid in an <svg> of its own. `place` turns (x, y) into pixels, or null.
class Chart {
  constructor(width, height, description, x, y, xPads, yPads) {
    const { left, right, top, bottom } = chartMargins;
    this.box = { left, top, right: width - right, bottom: height - bottom };
    this.x = new Axis(x, x.values, this.box.right - left, Math.max(4, Math.floor(width / 90)), xPads);
    this.y = new Axis(y, y.values, this.box.bottom - top, Math.max(4, Math.floor(height / 50)), yPads);
    this.svg = drawn("svg", { class: "chart", viewBox: `0 0 ${width} ${height}`, width, height,
                              role: "group", "aria-label": description });
    this.drawHorizontalAxis();
    this.drawVerticalAxis();
    const { left: l, top: t, right: r, bottom: b } = this.box;
    this.svg.append(drawn("path", { class: "frame", d: `M${l},${t}V${b}H${r}` }));
  }

  place(x, y) {
    const [across, up] = [this.x.at(x), this.y.at(y)];
    return across === null || up === null ? null : [this.box.left + across, this.box.bottom - up];
  }

  text(x, y, className, string, attributes) {
    this.svg.append(drawn("text", { x, y, class: className, ...attributes }, string));
  }

  drawHorizontalAxis() {
    const { left, top, right, bottom } = this.box;
    const line = (x, from, to, className) =>
      this.svg.append(drawn("path", { class: className, d: `M${x},${from}V${to}` }));
    for (const tick of this.x.minorTicks) line(left + this.x.at(tick), bottom, bottom + 3, "tick");
    for (const tick of this.x.ticks) {
      const x = left + this.x.at(tick);
      line(x, top, bottom, "grid");
      line(x, bottom, bottom + 5, "tick");
      this.text(x, bottom + 18, "tick-text middle", tickText(tick));
    }
    if (this.x.hasZero) {
      line(left + zeroBand, top, bottom, "zero-edge");
      this.text(left + this.x.at(0), bottom + 18, "tick-text middle", "0");
    }
    this.text((left + right) / 2, bottom + 38, "axis-text middle", this.x.label);
  }

  drawVerticalAxis() {
    const { left, top, right, bottom } = this.box;
    const line = (y, from, to, className) =>
      this.svg.append(drawn("path", { class: className, d: `M${from},${y}H${to}` }));
    for (const tick of this.y.minorTicks) line(bottom - this.y.at(tick), left - 3, left, "tick");
    for (const tick of this.y.ticks) {
      const y = bottom - this.y.at(tick);
      line(y, left, right, "grid");
      line(y, left - 5, left, "tick");
      this.text(left - 8, y + 4, "tick-text end", tickText(tick));
    }
    if (this.y.hasZero) {
      line(bottom - zeroBand, left, right, "zero-edge");
      this.text(left - 8, bottom - this.y.at(0) + 4, "tick-text end", "0");
    }
    const middle = (top + bottom) / 2;
    this.text(0, 0, "axis-text middle", this.y.label, { transform: `translate(13,${middle}) rotate(-90)` });
  }
}

// A box beside the point under the pointer or the focus: one for the page.
const hint = element("div", { id: "hint", role: "status", hidden: true });

function showHint(target, ...content) {
  hint.replaceChildren(...content);
  hint.hidden = false;
  const at = target.getBoundingClientRect();
  const [width, height] = [hint.offsetWidth, hint.offsetHeight];
  const right = at.right + 10 + width < document.documentElement.clientWidth;
  hint.style.left = `${window.scrollX + Math.max(4, right ? at.right + 10 : at.left - 10 - width)}px`;
  hint.style.top = `${window.scrollY + Math.max(4, Math.min(at.top, window.innerHeight - height - 4))}px`;
}

function hideHint() {
  hint.hidden = true;
}

// Lets pointer, focus and arrow keys pick the nearest of `points` ({x, y, node}, pixels of `svg`).
// The points are one stop of the Tab key. show(point) fills the hint; open(point), if any, follows a
// click or Enter.
function makePickable(svg, points, show, open) {
  if (points.length === 0) return;
  const inOrder = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  for (const point of points) point.node.setAttribute("tabindex", "-1");
  inOrder[0].node.setAttribute("tabindex", "0");
  const pointOf = (node) => points.find((point) => point.node === node.closest("[tabindex]"));
  const nearest = (event) => {
    const bounds = svg.getBoundingClientRect();
    const [x, y] = [event.clientX - bounds.left, event.clientY - bounds.top];
    const distance = (point) => Math.hypot(point.x - x, point.y - y);
    const best = points.reduce((a, b) => distance(b) < distance(a) ? b : a);
    return distance(best) < 14 ? best : null;
  };
  let picked = null;
  const pick = (point) => {
    if (point === picked) return;
    picked?.node.classList.remove("picked");
    picked = point;
    picked?.node.classList.add("picked");
    if (picked) show(picked);
    else hideHint();
  };
  svg.addEventListener("pointermove", (event) => pick(nearest(event)));
  svg.addEventListener("pointerleave", () => pick(null));
  svg.addEventListener("focusin", (event) => pick(pointOf(event.target) ?? null));
  svg.addEventListener("focusout", () => pick(null));
  svg.addEventListener("click", (event) => {
    const point = nearest(event);
    if (point) open?.(point);
  });
  svg.addEventListener("keydown", (event) => {
    const point = pointOf(event.target);
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    if (!point || (step === undefined && event.key !== "Enter")) return;
    event.preventDefault();
    if (event.key === "Enter") open?.(point);
    else inOrder[inOrder.indexOf(point) + step]?.node.focus();
  });
}

const chartPlaces = [];  // of the whole page: {redraw, printedWidth}
let printing = false;

window.addEventListener("beforeprint", () => {
  printing = true;
  for (const { redraw, printedWidth } of chartPlaces) redraw(printedWidth);
});
window.addEventListener("afterprint", () => {
  printing = false;
  for (const { redraw } of chartPlaces) redraw();
});

// A place for a chart that is drawn again when its width changes, and for print.
function resizing(draw, printedWidth) {
  const place = element("div", { class: "chart-place" });
  let seenWidth = 0;
  const redraw = (width = place.clientWidth) => {
    if (width > 0) place.replaceChildren(draw(width));
  };
  new ResizeObserver(() => {
    // Drawing changes its height alone.
    if (printing || place.clientWidth === seenWidth) return;
    seenWidth = place.clientWidth;
    redraw();
  }).observe(place);
  chartPlaces.push({ redraw, printedWidth });
  return { place, redraw };
}
