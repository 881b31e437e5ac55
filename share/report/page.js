// SPDX-License-Identifier: Apache-2.0
// Puts the page together from the document.

const report = JSON.parse(document.getElementById("document").textContent);
report.comparisons ??= [];

function section(id, title, ...content) {
  return element("section", { id }, element("h2", null, title), ...content);
}

// Keys and their values, but for those that the sweep sets.
function settingsText(settings) {
  return Object.entries(settings ?? {}).filter(([key]) => !report.swept?.includes(key))
    .map(([key, value]) => `${key} = ${valueText(value)}`).join("; ");
}

function environmentSection() {
  const pairs = Object.entries(report.environment ?? {}).map(([name, value]) => [name, valueText(value)]);
  pairs.push(["all runs have", settingsText(report.base)]);
  const keys = [...shortKeys(report.swept ?? [])].filter(([key, short]) => key !== short);
  return section("environment", "Environment", factList(pairs),
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
  if (runs.length === 0) return factList([["in short", comparison.note]]);
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
    element("div", { class: "pictures" }, panels.map(({ title, caption, image, scale, largest }) =>
      pictureFigure(image, [comparison.scene, group, title, caption].filter((part) => part).join(", "),
        [element("b", null, title), caption ? ` ${caption}` : null], { load: setShownSize },
        isMissing(scale) ? null : colorBar(scale, largest)))),
  ]);
}

// What a paper says of a table or figure, and whether it holds.
function checksTable(checks) {
  if (!checks?.length) return null;
  return smallTable("words checks", ["the paper says", "holds", "measured"],
    checks.map(({ says, holds, measured }) => [says, holds ? "yes" : "no", measured]));
}

// Rows that are objects of cells, all with the same keys.
function rowsTable(rows) {
  if (!rows?.length) return null;
  const heads = Object.keys(rows[0]);
  const cell = (value) => typeof value === "number" ? numberText(value) : valueText(value);
  return element("div", { class: "scrolled", tabindex: "0", role: "region", "aria-label": "numbers" },
    smallTable("numbers", heads, rows.map((row) => heads.map((head) => cell(row[head])))));
}

// What is drawn of a comparison: {node, update(state)}.
function comparisonView(comparison, index) {
  const table = comparison.runs.length > 0 ? new RunTable(report, comparison) : null;
  const open = (id) => table?.show(id);
  const measured = comparison.runs.some((run) => !run.failed && run.frame_ms);
  const scatter = measured ? new Scatter(comparison, open) : null;
  const plots = (comparison.plots ?? []).map((plot) => plotFigure(report, plot, open));
  const node = section(`comparison-${index + 1}`, comparison.scene, comparisonFacts(comparison),
    ...picturePanels(comparison).filter((part) => part), checksTable(comparison.checks), rowsTable(comparison.rows),
    scatter?.node,
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

// The key whose values marks tell apart best: the one with the fewest values, two at least.
function firstKey() {
  const counted = (report.swept ?? []).map((key) => ({ key, count: new KeyMarks(report, key).texts.length }));
  const useful = counted.filter(({ count }) => count > 1);
  return (useful.length > 0 ? useful : counted).sort((a, b) => a.count - b.count)[0]?.key ?? null;
}

// Those times of the plots' axis that every measured run has, so that no point is missing.
function timeChoices() {
  const measured = report.comparisons.flatMap(({ runs }) => runs.filter((run) => !run.failed && run.frame_ms));
  if (measured.length === 0) return [];
  return Object.entries(timeAxes).filter(([, { of }]) => measured.every((run) => !isMissing(of(run))))
    .map(([name, { choice }]) => [name, choice]);
}

function contents() {
  const scenes = report.comparisons.map(({ scene }, index) =>
    element("a", { href: `#comparison-${index + 1}` }, scene));
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
    report.swept?.length > 0
      ? selection("Marks", "choose-key", report.swept.map((key) => [key, key]), state.key, choose("key")) : null,
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
  document.getElementById("report").append(environmentSection(),
    ...(anyRuns ? [controls(state, update), norms()] : [contents()]).filter((part) => part),
    ...views.map(({ node }) => node), ...[droppedSection(), failedSection()].filter((part) => part));
  document.body.append(hint, enlarged);
  update();
}

build();
