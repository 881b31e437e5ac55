// SPDX-License-Identifier: Apache-2.0
// Error against time of the runs of one comparison.

const errorLabels = { l2: "L2", linf: "L∞" };

// Times that the horizontal axis can show.
const timeAxes = {
  frame_ms: { choice: "a frame", title: "Error against frame time", time: "a frame's median time",
              label: "frame time, median (ms)", of: (run) => run.frame_ms?.median },
  first_ms: { choice: "first picture", title: "Error against time to the first picture",
              time: "the time of facts, choice, set-up and first frame", label: "first picture (ms)",
              of: (run) => run.first_ms },
};

// Not beaten or equalled in both by another one, and beaten in one: as `pareto` of the document, for
// the times and errors that it does not hold a front of.
function frontOf(runs, error, time) {
  if (error === "l2" && time === "frame_ms") return runs.filter((run) => run.pareto);
  const ms = timeAxes[time].of;
  const beats = (a, b) => ms(a) <= ms(b) && a[error] <= b[error] && (ms(a) < ms(b) || a[error] < b[error]);
  return runs.filter((run) => !runs.some((other) => beats(other, run)));
}

// From each run of the front straight on, then down to the next one.
function stepLine(front, box) {
  if (front.length === 0) return "";
  const steps = front.slice(1).map(({ x, y }) => `H${x.toFixed(1)}V${y.toFixed(1)}`);
  return `M${front[0].x.toFixed(1)},${box.top}V${front[0].y.toFixed(1)}${steps.join("")}H${box.right}`;
}

// Every ten pixels of that line.
function pointsAlongSteps(front, box) {
  if (front.length === 0) return [];
  const between = (from, to) => Array.from({ length: Math.ceil(Math.abs(to - from) / 10) },
    (_, i) => Math.min(from, to) + (i + 0.5) * 10);
  return front.flatMap((point, i) => [
    ...between(i === 0 ? box.top : front[i - 1].y, point.y).map((y) => [point.x, y]),
    ...between(point.x, front[i + 1]?.x ?? box.right).map((x) => [x, point.y]),
  ]);
}

class Scatter {
  // open(id) shows the run in the table.
  constructor(comparison, open) {
    this.runs = comparison.runs.filter((run) => !run.failed && run.frame_ms);
    this.baseline = this.runs.find((run) => run.id === comparison.baseline);
    this.open = open;
    this.legendPlace = element("div");
    const { place, redraw } = resizing((width) => this.draw(width), 680);
    this.place = place;
    this.redraw = redraw;
    this.caption = element("figcaption");
    this.node = element("figure", { class: "scatter" }, this.caption, place, this.legendPlace);
  }

  // state: {error, time, marks, matches(run)} as page.js keeps it.
  update(state) {
    this.state = state;
    const label = errorLabels[state.error];
    const { title, time } = timeAxes[state.time];
    this.caption.replaceChildren(element("b", null, `${title}. `),
      `${label} error over ${time}; towards the lower left is better. Named: the Pareto front in ` +
      `${label} and time.`);
    this.legendPlace.replaceChildren(this.legend());
    this.redraw();
  }

  legend() {
    const { marks } = this.state;
    const grey = { color: "#555555", polygon: null };
    const entries = marks.key === null ? [] : marks.legendEntries(this.runs);
    entries.push([swatch(drawn("path", { class: "front", d: "M-12,-4H0V4H12" })), "Pareto front"]);
    if (this.runs.some((run) => run.near_reference)) {
      entries.push([swatch(markNode(grey, true)), "hollow: error below ten times the reference's own"]);
    }
    if (this.baseline) {
      entries.push([swatch(drawn("circle", { class: "baseline-ring", r: 6.5 })), `baseline: ${this.baseline.name}`]);
    }
    const values = marks.texts?.length ?? 0;
    const title = marks.key === null ? null : element("p", { class: "legend-title" }, values <= differentMarks
      ? marks.key : `${marks.key} (${values} values: marks repeat after ${differentMarks})`);
    return element("div", null, title, legend(entries));
  }

  draw(width) {
    const { error, time } = this.state;
    const axis = timeAxes[time];
    const height = Math.round(Math.max(320, Math.min(480, 0.5 * width)));
    const times = this.runs.map(axis.of);
    const chart = new Chart(width, height, `${errorLabels[error]} error over ${axis.time}`,
      { label: axis.label, log: true, values: times },
      { label: `${errorLabels[error]} error (1/255)`, log: true, values: this.runs.map((run) => run[error]) },
      [0.12, 0.06], [0.14, 0.06]);  // room for names below the front
    const points = this.runs.map((run) => {
      const at = chart.place(axis.of(run), run[error]);
      return at && { run, x: at[0], y: at[1] };
    }).filter((point) => point);
    const onFront = new Set(frontOf(this.runs, error, time));
    const front = points.filter((point) => onFront.has(point.run)).sort((a, b) => a.x - b.x || b.y - a.y);
    chart.svg.append(drawn("path", { class: "front", d: stepLine(front, chart.box) }));
    // Of points that lie on each other, the front's are on top.
    for (const point of [...points].sort((a, b) => onFront.has(a.run) - onFront.has(b.run))) {
      point.node = this.pointNode(point);
      chart.svg.append(point.node);
    }
    this.drawNames(chart, front, points);
    makePickable(chart.svg, points, (point) => showHint(point.node, ...this.hintFor(point.run)),
      (point) => this.open(point.run.id));
    return chart.svg;
  }

  pointNode({ run, x, y }) {
    const { error, time, marks, matches } = this.state;
    const mark = marks.key === null ? markOf(0) : marks.markFor(run);
    const ring = run === this.baseline ? drawn("circle", { class: "baseline-ring", r: 8 }) : null;
    const figures = `${numberText(timeAxes[time].of(run))} ms, ${errorLabels[error]} ${numberText(run[error])}`;
    return drawn("g", {
      class: matches(run) ? "point" : "point faint", "data-run": run.id, role: "img",
      transform: `translate(${x.toFixed(1)},${y.toFixed(1)})`,
      "aria-label": `${run.name}: ${figures}`,
    }, markNode(mark, run.near_reference), ring);
  }

  drawNames(chart, front, points) {
    const wanted = front.map(({ run, x, y }) => ({ run, x, y, text: shortened(run.name, 44) }));
    const obstacles = [...points.map(({ x, y }) => [x, y]), ...pointsAlongSteps(front, chart.box)];
    placeLabels(wanted, obstacles, chart.box).forEach((place, i) => {
      const { run, x, y, text } = wanted[i];
      const faint = this.state.matches(run) ? "" : " faint";
      if (place.led) {
        chart.svg.append(drawn("path", { class: `leader${faint}`, d: `M${x},${y}L${place.endX},${place.endY}` }));
      }
      chart.text(place.left, place.bottom - 3.5, `pareto-name${faint}`, text, { "data-run": run.id });
    });
  }

  hintFor(run) {
    const errors = `L∞ ${numberText(run.linf)}, L2 ${numberText(run.l2)}`;
    const times = run.ratio ? `${numberText(run.frame_ms.median)} ms (${numberText(run.ratio)} × baseline)`
      : `${numberText(run.frame_ms.median)} ms`;
    return [
      element("b", null, run.name), element("div", null, times),
      ...(isMissing(run.first_ms) ? [] : [element("div", null, `first picture: ${numberText(run.first_ms)} ms`)]),
      element("div", null, errors),
      ...Object.entries(run.keys ?? {}).map(([key, value]) => element("div", null, `${key}: ${valueText(value)}`)),
      element("div", { class: "pair" }, picture(run.image, `picture of ${run.name}`),
        picture(run.difference, `difference of ${run.name} from the reference`)),
    ];
  }
}

function shortened(text, most) {
  return text.length <= most ? text : `${text.slice(0, most - 1)}…`;
}
