// SPDX-License-Identifier: Apache-2.0
// Puts the page together from the document.

const report = JSON.parse(document.getElementById("document").textContent);
report.comparisons ??= [];

function section(id, title, ...content) {
  return element("section", { id }, element("h2", null, title), ...content);
}

function environmentSection() {
  const pairs = Object.entries(report.environment ?? {}).map(([name, value]) => [name, valueText(value)]);
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
  return factList([
    ["runs", `${runs.length}, ${front} of them on the Pareto front` + (failed > 0 ? `, ${failed} failed` : "")],
    ["baseline", baseline?.name],
    [references.length === 1 ? "reference" : "references",
     references.length === 0 ? null : element("div", null, references)],
  ]);
}

// What is drawn of a comparison: {node, update(state)}.
function comparisonView(comparison, index) {
  const table = comparison.runs.length > 0 ? new RunTable(report, comparison) : null;
  const open = (id) => table?.show(id);
  const measured = comparison.runs.some((run) => !run.failed && run.frame_ms);
  const scatter = measured ? new Scatter(comparison, open) : null;
  const plots = (comparison.plots ?? []).map((plot) => plotFigure(report, plot, open));
  const pictures = (comparison.pictures ?? []).map(({ title, caption, image }) =>
    element("figure", { class: "picture" }, picture(image, title, { load: enlarge }), element("figcaption", null,
      element("b", null, title), caption ? ` ${caption}` : null)));
  const node = section(`comparison-${index + 1}`, comparison.scene, comparisonFacts(comparison),
    pictures.length > 0 ? element("div", { class: "pictures" }, pictures) : null,
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
  const scenes = report.comparisons.map(({ scene }, index) =>
    element("a", { href: `#comparison-${index + 1}` }, scene));
  return element("form", { id: "controls", submit: (event) => event.preventDefault() },
    scenes.length > 1 ? element("nav", { "aria-label": "scenes" }, scenes) : null,
    selection("Error", "choose-error", Object.entries(errorLabels), state.error, choose("error")),
    times.length > 1 ? selection("Time", "choose-time", times, state.time, choose("time")) : null,
    report.swept?.length > 0
      ? selection("Marks", "choose-key", report.swept.map((key) => [key, key]), state.key, choose("key")) : null,
    element("label", null, "Filter", element("input", { id: "filter", type: "search", autocomplete: "off",
                                                        placeholder: "words of runs", input: words })));
}

function build() {
  const views = report.comparisons.map(comparisonView);
  const state = { error: "l2", time: "frame_ms", key: firstKey(), words: [] };
  const update = () => {
    const marks = state.key === null ? { key: null } : new KeyMarks(report, state.key);
    for (const view of views) view.update({ ...state, marks });
  };
  const anyRuns = report.comparisons.some(({ runs }) => runs.length > 0);
  document.getElementById("report").append(environmentSection(), ...(anyRuns ? [controls(state, update)] : []),
    ...views.map(({ node }) => node), ...[droppedSection(), failedSection()].filter((part) => part));
  document.body.append(hint);
  update();
}

build();
