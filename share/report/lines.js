// SPDX-License-Identifier: Apache-2.0
// The plots that a comparison brings along: points of several series, joined where every x of the
// series is there once.

function isFunction(points) {
  return new Set(points.map(([x]) => x)).size === points.length;
}

// Series that are named by a swept key's values have the marks of these in the scatter plots, too.
function seriesIndices(report, plot) {
  for (const key of report.swept ?? []) {
    const { indices } = new KeyMarks(report, key);
    if (plot.series.every(({ name }) => indices.has(name))) return plot.series.map(({ name }) => indices.get(name));
  }
  return plot.series.map((_, index) => index);
}

function drawSeries(chart, series, index) {
  const mark = markOf(index);
  const points = [...series.points].sort((a, b) => a[0] - b[0] || a[1] - b[1])
    .map(([x, y, run]) => ({ at: chart.place(x, y), valueX: x, valueY: y, run, series }))
    .filter(({ at }) => at);
  if (isFunction(series.points)) {
    const corners = points.map(({ at: [x, y] }) => `${x.toFixed(1)},${y.toFixed(1)}`);
    chart.svg.append(drawn("polyline", { class: "line", points: corners.join(" "), stroke: mark.color,
                                         "stroke-dasharray": dashes[index % dashes.length] }));
  }
  return points.map((point) => {
    const [x, y] = point.at;
    const node = drawn("g", {
      class: "point", role: "img", transform: `translate(${x.toFixed(1)},${y.toFixed(1)})`,
      "aria-label": `${series.name}: ${numberText(point.valueX)}, ${numberText(point.valueY)}`,
    }, markNode(mark, false, 3.6));
    return { ...point, x, y, node };
  });
}

function seriesLegend(plot, indices) {
  return legend(plot.series.map((series, i) => {
    const index = indices[i];
    const line = drawn("path", { class: "line", d: "M-13,0H13", stroke: markOf(index).color,
                                 "stroke-dasharray": dashes[index % dashes.length] });
    return [swatch(isFunction(series.points) ? line : null, markNode(markOf(index), false, 3.6)), series.name];
  }));
}

function drawPlot(plot, indices, width, open) {
  const all = plot.series.flatMap((series) => series.points);
  const chart = new Chart(width, Math.round(Math.max(260, Math.min(360, 0.62 * width))), plot.title,
    { ...plot.x, values: all.map(([x]) => x) }, { ...plot.y, values: all.map(([, y]) => y) });
  const points = plot.series.flatMap((series, i) => drawSeries(chart, series, indices[i]));
  chart.svg.append(...points.map(({ node }) => node));
  makePickable(chart.svg, points, (point) => showHint(point.node, element("b", null, point.series.name),
    element("div", null, `${plot.x.label}: ${numberText(point.valueX)}`),
    element("div", null, `${plot.y.label}: ${numberText(point.valueY)}`)), ({ run }) => run && open(run));
  return chart.svg;
}

function plotFigure(report, plot, open) {
  const indices = seriesIndices(report, plot);
  const { place } = resizing((width) => drawPlot(plot, indices, width, open), 340);
  return element("figure", { class: "plot" }, element("figcaption", null, element("b", null, plot.title)), place,
    seriesLegend(plot, indices));
}
