// SPDX-License-Identifier: Apache-2.0
// Colours and shapes that tell series apart: for the colour-blind, and on grey paper.

// Okabe and Ito 2008, without yellow, which paper swallows.
const colors = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"];
const dashes = ["none", "7 3", "2 3", "10 3 2 3", "4 2", "12 3", "1 2"];

// Corners about the origin, in units of the mark's size; all of about the same area.
function starOf(corners, outer, inner, turn) {
  return Array.from({ length: 2 * corners }, (_, i) => {
    const angle = turn + Math.PI * i / corners;
    const radius = i % 2 === 0 ? outer : inner;
    return [radius * Math.sin(angle), -radius * Math.cos(angle)];
  });
}
const plus = [[-1.1, -0.4], [-0.4, -0.4], [-0.4, -1.1], [0.4, -1.1], [0.4, -0.4], [1.1, -0.4],
              [1.1, 0.4], [0.4, 0.4], [0.4, 1.1], [-0.4, 1.1], [-0.4, 0.4], [-1.1, 0.4]];
const polygons = [
  null,  // a circle
  [[-0.88, -0.88], [0.88, -0.88], [0.88, 0.88], [-0.88, 0.88]],
  [[0, -1.25], [1.2, 0.85], [-1.2, 0.85]],
  [[0, -1.3], [1.1, 0], [0, 1.3], [-1.1, 0]],
  [[0, 1.25], [1.2, -0.85], [-1.2, -0.85]],
  plus,
  plus.map(([x, y]) => [Math.SQRT1_2 * (x - y), Math.SQRT1_2 * (x + y)]),
  starOf(5, 1.4, 0.62, 0),
];

// As many as have a pair of their own: 7 and 8 have no common divisor.
const differentMarks = colors.length * polygons.length;

function markOf(index) {
  return { color: colors[index % colors.length], polygon: polygons[index % polygons.length] };
}

function markPath(mark, size) {
  if (!mark.polygon) return `M${-size},0a${size},${size} 0 1 0 ${2 * size},0a${size},${size} 0 1 0 ${-2 * size},0z`;
  const corners = mark.polygon.map(([x, y]) => `${(size * x).toFixed(2)},${(size * y).toFixed(2)}`);
  return `M${corners.join("L")}z`;
}

function markNode(mark, hollow = false, size = 4.5) {
  return drawn("path", {
    d: markPath(mark, size), fill: hollow ? "#ffffff" : mark.color,
    stroke: hollow ? mark.color : "#ffffff", "stroke-width": hollow ? 1.6 : 0.7,
  });
}

// A drawing of one line's height, for legends.
function swatch(...nodes) {
  return drawn("svg", { class: "swatch", width: 26, height: 14, viewBox: "-13 -7 26 14", "aria-hidden": "true" },
    ...nodes);
}

function legend(entries) {
  return element("ul", { class: "legend" }, entries.map(([drawing, text]) =>
    element("li", null, drawing, element("span", null, text))));
}

const factorsKey = "render.slice.tree.factors";

// Lists what tells runs apart beside the values of single keys, the best first: {name: of(run)}. A study of
// trees is told apart by their levels, one that changes keys in turn by which keys a run changes.
function derivedKeys({ swept = [], comparisons }) {
  const short = shortKeys(swept);
  const all = [
    ["levels of the tree", 2, ({ keys }) => keys?.[factorsKey]?.length ?? "no tree"],
    ["what was swept", 3, ({ keys }) =>
      swept.filter((key) => !isMissing(keys?.[key])).map((key) => short.get(key)).join(", ") || "nothing"],
  ];
  const runs = comparisons.flatMap((comparison) => comparison.runs);
  return Object.fromEntries(all.filter(([, least, of]) => new Set(runs.map(of)).size >= least)
    .map(([name, , of]) => [name, of]));
}

// A mark for every value of a swept or derived key, the same one in all comparisons. Runs without the
// key have one, too.
class KeyMarks {
  constructor(report, key) {
    const derived = derivedKeys(report)[key];
    this.valueOf = derived ?? ((run) => run.keys?.[key]);
    const values = new Map();
    const counts = new Map();
    for (const comparison of report.comparisons) {
      for (const run of comparison.runs) {
        const value = this.valueOf(run);
        values.set(valueText(value), value);
        counts.set(valueText(value), (counts.get(valueText(value)) ?? 0) + 1);
      }
    }
    this.most = Math.max(0, ...counts.values());  // runs of the most frequent value
    this.key = key;
    this.texts = [...values.keys()].sort((a, b) => {
      const [first, second] = [values.get(a), values.get(b)];
      if (isMissing(first) || isMissing(second)) return isMissing(first) - isMissing(second);
      return compareValues(first, second);
    });
    this.indices = new Map(this.texts.map((text, index) => [text, index]));
  }

  markFor(run) {
    return markOf(this.indices.get(valueText(this.valueOf(run))));
  }

  legendEntries(runs) {
    const used = new Set(runs.map((run) => valueText(this.valueOf(run))));
    return this.texts.filter((text) => used.has(text))
      .map((text) => [swatch(markNode(markOf(this.indices.get(text)))), text]);
  }
}
