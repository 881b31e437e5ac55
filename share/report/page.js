// SPDX-License-Identifier: Apache-2.0
// Puts the page together from the document.

const report = JSON.parse(document.getElementById("document").textContent);
report.comparisons ??= [];

function section(id, title, ...content) {
  return element("section", { id }, element("h2", null, title), ...content);
}

// The name that links to a comparison have.
function anchorOf({ anchor }, index) {
  return anchor ?? `comparison-${index + 1}`;
}

// Keys and their values, but for those that the sweep sets.
function settingsText(settings) {
  return Object.entries(settings ?? {}).filter(([key]) => !report.swept?.includes(key))
    .map(([key, value]) => `${key} = ${valueText(value)}`).join("; ");
}

// Findings: the answers that the study was made for.
function answersSection({ title, note, tables }) {
  return section("answers", title, element("p", { class: "note" }, note),
    ...tables.flatMap(({ caption, rows }) => [element("h3", null, caption), rowsTable(rows)]));
}

function environmentSection() {
  const pairs = Object.entries(report.environment ?? {}).map(([name, value]) => [name, valueText(value)]);
  pairs.push(["all runs have", settingsText(report.base)]);
  const keys = [...shortKeys(report.swept ?? [])].filter(([key, short]) => key !== short);
  return section("environment", "How it was measured", factList(pairs),
    keys.length === 0 ? null : element("p", { class: "note" },
      `Swept keys, as the tables abbreviate them: ${keys.map(([key, short]) => `${short} = ${key}`).join("; ")}.`));
}

function referenceText({ id, of, width, height, error_estimate: error, ms }) {
  return `${id}: traced ${of}, ${width} × ${height} pixels, own error ${numberText(error)}/255, ${numberText(ms)} ms`;
}

function comparisonFacts(comparison) {
  const { runs } = comparison;
  const failed = runs.filter((run) => run.failed).length;
  const front = runs.filter((run) => run.pareto).length;
  const baseline = runs.find((run) => run.id === comparison.baseline);
  const references = (comparison.references ?? []).map((reference) => element("div", null, referenceText(reference)));
  if (runs.length === 0) return factList([["verdict", comparison.verdict], ["remark", comparison.note]]);
  return factList([
    ["runs", `${runs.length}, ${front} of them on the Pareto front` + (failed > 0 ? `, ${failed} failed` : "")],
    ["its runs have", settingsText(comparison.set)],
    ["baseline", baseline?.name],
    [references.length === 1 ? "reference" : "references",
     references.length === 0 ? null : element("div", null, references)],
  ]);
}

// Pictures side by side, those of a group under its name.
function picturePanels(comparison) {
  const groups = [];
  for (const panel of comparison.pictures ?? []) {
    const group = panel.group ?? "";
    if (groups.at(-1)?.group !== group) groups.push({ group, panels: [] });
    groups.at(-1).panels.push(panel);
  }
  return groups.flatMap(({ group, panels }) => [
    group === "" ? null : element("h3", null, group),
    element("div", { class: "pictures" }, panels.map(({ title, caption, image, scale, largest, width, height }) =>
      pictureFigure(image, [comparison.scene, group, title, caption].filter((part) => part).join(", "),
        [element("b", null, title), caption ? ` ${caption}` : null],
        width ? shownSize(width, height) : { load: setShownSize },
        nothingToSee(scale, largest), isMissing(scale) ? null : colorBar(scale, largest)))),
  ]);
}

// Captions say what the pictures of a table or figure of a paper show.
function pictureCaption({ scene, caption }) {
  return caption ? element("p", { class: "caption" }, element("b", null, `${scene}. `), caption) : null;
}

// Checks quote what a paper says of a table or figure and say whether it holds.
function checksTable(checks) {
  if (!checks?.length) return null;
  return smallTable("words checks", ["the paper says", "verdict", "measured"],
    checks.map(({ says, verdict, measured }) => [says, verdict, measured]));
}

// Claims of lamina stand beside those of the paper.
function ownTable(claims) {
  if (!claims?.length) return null;
  return smallTable("words checks own", ["lamina says", "holds", "measured"],
    claims.map(({ claim, holds, measured }) => [claim, holds ? "yes" : "no", measured]));
}

// Cells of one column: whole numbers have no digits after the point if the whole column has none.
function columnCells(values) {
  const numbers = values.filter((value) => typeof value === "number");
  const text = numbers.every(Number.isInteger) ? wholeText : numberText;
  return values.map((value) => typeof value === "number" ? text(value)
    : Array.isArray(value) ? value.map(valueText).join(", ") : valueText(value));
}

// Rows that are objects of cells, all with the same keys.
function rowsTable(rows) {
  if (!rows?.length) return null;
  const heads = Object.keys(rows[0]);
  const columns = heads.map((head) => columnCells(rows.map((row) => row[head])));
  return element("div", { class: "scrolled", tabindex: "0", role: "region", "aria-label": "numbers" },
    smallTable("numbers", heads, rows.map((row, i) => columns.map((cells) => cells[i]))));
}

// What is drawn of a comparison: {node, update(state)}.
function comparisonView(comparison, index) {
  const table = comparison.runs.length > 0 ? new RunTable(report, comparison) : null;
  const open = (id) => table?.show(id);
  const measured = comparison.runs.some((run) => !run.failed && run.frame_ms);
  const scatter = measured ? new Scatter(comparison, open) : null;
  const plots = (comparison.plots ?? []).map((plot) => plotFigure(report, plot, open));
  const node = section(anchorOf(comparison, index), comparison.scene, comparisonFacts(comparison),
    ...picturePanels(comparison).filter((part) => part), pictureCaption(comparison), checksTable(comparison.checks),
    ownTable(comparison.own), rowsTable(comparison.rows), scatter?.node,
    plots.length > 0 ? element("div", { class: "plots" }, plots) : null,
    table?.node);
  return {
    node,
    update({ error, time, marks, words }) {
      const matches = table ? table.filter(words) : () => true;
      scatter?.update({ error, time, marks, matches });
    },
  };
}

function failedSection() {
  const rows = report.comparisons.flatMap(({ scene, runs }) =>
    runs.filter((run) => run.failed).map((run) => [scene, run.name, run.failed]));
  return rows.length === 0 ? null
    : section("failed", "Failed runs", smallTable("words", ["scene", "run", "message"], rows));
}

function droppedSection() {
  const rows = (report.dropped ?? []).map(({ because, runs }) => [because, wholeText(runs)]);
  return rows.length === 0 ? null
    : section("dropped", "Combinations left out", smallTable("words counts", ["because", "runs"], rows));
}

function selection(label, id, choices, chosen, change) {
  const options = choices.map(([value, text]) => element("option", { value, selected: value === chosen }, text));
  return element("label", null, label,
    element("select", { id, autocomplete: "off", change: (event) => change(event.target.value) }, options));
}

// Marks tell apart what was swept as a whole, then the values of each key.
function markKeys() {
  return [...Object.keys(derivedKeys(report)), ...(report.swept ?? [])];
}

// The first derived key, else the key whose values split the runs best: of those with a shape for
// each value, the one whose most frequent value has the fewest runs.
function firstKey() {
  const [derived] = Object.keys(derivedKeys(report));
  if (derived) return derived;
  const found = markKeys().map((key) => new KeyMarks(report, key));
  const useful = found.filter(({ texts }) => texts.length > 1 && texts.length <= polygons.length);
  return (useful.length > 0 ? useful : found).sort((a, b) => a.most - b.most)[0]?.key ?? null;
}

// Those times of the plots' axis that every measured run has, so that no point is missing.
function timeChoices() {
  const measured = report.comparisons.flatMap(({ runs }) => runs.filter((run) => !run.failed && run.frame_ms));
  if (measured.length === 0) return [];
  return Object.entries(timeAxes).filter(([, { of }]) => measured.every((run) => !isMissing(of(run))))
    .map(([name, { choice }]) => [name, choice]);
}

function contents() {
  const scenes = report.comparisons.map((comparison, index) =>
    element("a", { href: `#${anchorOf(comparison, index)}` }, comparison.scene));
  return scenes.length > 1 ? element("nav", { "aria-label": "scenes" }, scenes) : null;
}

function controls(state, update) {
  const words = (event) => {
    state.words = event.target.value.toLowerCase().split(/\s+/).filter((word) => word !== "");
    update();
  };
  const choose = (name) => (value) => {
    state[name] = value;
    update();
  };
  const times = timeChoices();
  return element("form", { id: "controls", submit: (event) => event.preventDefault() },
    contents(),
    selection("Error", "choose-error", Object.entries(errorLabels), state.error, choose("error")),
    times.length > 1 ? selection("Time", "choose-time", times, state.time, choose("time")) : null,
    markKeys().length > 0
      ? selection("Marks", "choose-key", markKeys().map((key) => [key, key]), state.key, choose("key")) : null,
    element("label", null, "Filter", element("input", { id: "filter", type: "search", autocomplete: "off",
                                                        placeholder: "words of runs", input: words })));
}

function norms() {
  return element("p", { class: "note", id: "norms" }, "Errors are differences from the reference in 1/255 of full " +
    "scale, a step of an 8-bit picture: L∞ is the largest, L1 their mean with its sign (brighter or darker on the " +
    "whole), L2 the root of their mean square (how wrong a typical pixel is).");
}

function build() {
  const views = report.comparisons.map(comparisonView);
  const state = { error: "l2", time: "frame_ms", key: firstKey(), words: [] };
  const update = () => {
    const marks = state.key === null ? { key: null } : new KeyMarks(report, state.key);
    for (const view of views) view.update({ ...state, marks });
  };
  const anyRuns = report.comparisons.some(({ runs }) => runs.length > 0);
  document.getElementById("report").append(...(report.answers ? [answersSection(report.answers)] : []),
    environmentSection(), ...(anyRuns ? [controls(state, update), norms()] : [contents()]).filter((part) => part),
    ...views.map(({ node }) => node), ...[droppedSection(), failedSection()].filter((part) => part));
  document.body.append(hint, enlarged);
  update();
  // The browser looked for the link's target before it was there.
  if (location.hash) document.getElementById(location.hash.slice(1))?.scrollIntoView();
}

build();
