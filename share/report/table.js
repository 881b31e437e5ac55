// SPDX-License-Identifier: Apache-2.0
// The table of a comparison's runs: sorted by any column, filtered by words, rows that open.

const mostPrintedRows = 60;  // longer tables print their Pareto runs alone

// {id, group, head, title, value(run), text(value), numeric}; value is what a column is sorted by.
function columnsOf(swept, runs) {
  const short = shortKeys(swept);
  const number = (id, group, head, title, value, text = numberText) =>
    ({ id, group, head, title, value, text, numeric: true });
  const spread = (run) => run.frame_ms && run.frame_ms.max - run.frame_ms.min;
  const frame = "frame time (ms)";
  const error = "error (1/255)";
  return [
    { id: "name", group: "", head: "run", title: "the run's name", value: (run) => run.name, text: valueText },
    ...swept.map((key) => ({ id: `key.${key}`, group: "", head: short.get(key), title: key, text: valueText,
                             value: (run) => run.keys?.[key] })),
    number("frame_ms.median", frame, "median", "median of the frames with a moving camera",
      (run) => run.frame_ms?.median),
    number("frame_ms.min", frame, "min", "fastest of these frames", (run) => run.frame_ms?.min),
    number("frame_ms.spread", frame, "spread", "slowest less fastest of these frames", spread),
    number("ratio", frame, "ratio", "time to the baseline's", (run) => run.ratio),
    number("still_ms.median", frame, "still", "median of the frames with a still camera",
      (run) => run.still_ms?.median),
    ...(runs.every((run) => isMissing(run.first_ms)) ? [] : [
      number("first_ms", "first picture", "ms", "facts, choice, set-up and first frame", (run) => run.first_ms)]),
    number("linf", error, "L∞", "largest error of a pixel", (run) => run.linf),
    number("l1", error, "L1", "mean error, with its sign", (run) => run.l1),
    number("l2", error, "L2", "root of the mean square error", (run) => run.l2),
    number("bytes", "", "bytes", "memory of GPU and host together", (run) => run.bytes, wholeText),
    { id: "pareto", group: "", head: "Pareto", title: "on the Pareto front of frame time and L2 error",
      value: (run) => (run.pareto ? 0 : 1), text: (value) => (value === 0 ? "yes" : "") },
  ];
}

function wordsOf(run) {
  const keys = Object.entries(run.keys ?? {}).flatMap(([key, value]) => [key, valueText(value)]);
  return [run.id, run.name, run.context ?? "", run.failed ?? "", ...keys].join(" ").toLowerCase();
}

class RunTable {
  constructor(report, comparison) {
    this.comparison = comparison;
    this.columns = columnsOf(report.swept ?? [], comparison.runs);
    this.rows = comparison.runs.map((run, index) => this.makeRow(run, index));
    this.byId = new Map(this.rows.map((row) => [row.run.id, row]));
    this.heads = this.columns.map((column) => this.makeHead(column));
    this.body = element("tbody", { click: (event) => this.clicked(event) });
    this.count = element("p", { class: "count", role: "status" });
    this.placeRows();
    const groups = [];
    for (const { group } of this.columns) {
      if (groups.length > 0 && groups.at(-1).group === group) ++groups.at(-1).span;
      else groups.push({ group, span: 1 });
    }
    const long = comparison.runs.length > mostPrintedRows;
    const table = element("table", { class: long ? "runs long" : "runs" },
      element("thead", null,
        element("tr", { class: "groups" }, groups.map(({ group, span }) => group === ""
          ? element("td", { colspan: span })
          : element("th", { colspan: span, scope: "colgroup" }, group))),
        element("tr", null, this.heads)),
      this.body);
    this.node = element("div", { class: "run-table" }, this.count,
      element("div", { class: "scrolled", tabindex: "0", role: "region", "aria-label": "runs" }, table),
      this.notes(long));
  }

  notes(long) {
    const { runs } = this.comparison;
    return element("div", { class: "note" },
      runs.some((run) => run.near_reference)
        ? element("p", null, "† error below ten times the reference's own: it may be the reference's.") : null,
      long ? element("p", { class: "print-only" }, `The ${runs.length} runs are too many for paper: here are the ` +
        "baseline and the Pareto front. All of them are in the files beside this page.") : null);
  }

  makeHead(column) {
    const button = element("button", { type: "button", title: column.title, "data-column": column.id,
                                       click: () => this.sort(column) }, column.head);
    return element("th", { scope: "col", class: column.numeric ? "number" : null, "aria-sort": "none" }, button);
  }

  makeRow(run, index) {
    const failed = Boolean(run.failed);
    const baseline = run.id === this.comparison.baseline;
    const cells = [];
    for (const column of this.columns) {
      if (column.id === "name") cells.push(this.nameCell(run, baseline));
      else if (!failed || column.id.startsWith("key.")) {
        cells.push(element("td", { class: column.numeric ? "number" : null }, column.text(column.value(run))));
      }
    }
    if (failed) {
      const rest = this.columns.length - cells.length;
      cells.push(element("td", { class: "message", colspan: rest }, `failed: ${run.failed}`));
    }
    const kinds = [["run", true], ["failed", failed], ["pareto", run.pareto], ["baseline", baseline]];
    const names = kinds.filter(([, is]) => is).map(([name]) => name).join(" ");
    return { run, index, failed, words: wordsOf(run), details: null,
             node: element("tr", { class: names, "data-run": run.id }, cells) };
  }

  nameCell(run, baseline) {
    // The name is beside it.
    const thumbnail = picture(run.image, "", { class: "thumbnail", loading: "lazy", width: 32, height: 32 });
    const name = [run.name, baseline ? " (baseline)" : null, run.near_reference ? " †" : null];
    const content = run.failed ? element("span", { class: "opens" }, name)
      : element("button", { type: "button", class: "opens", "aria-expanded": "false" },
        thumbnail, element("span", null, name));
    return element("th", { scope: "row" }, content);
  }

  clicked(event) {
    const button = event.target.closest("button.opens");
    if (button) this.toggle(this.byId.get(button.closest("tr").dataset.run));
  }

  toggle(row) {
    const button = row.node.querySelector("button.opens");
    if (!button) return;
    const opening = row.details === null;
    button.setAttribute("aria-expanded", String(opening));
    if (opening) {
      row.details = element("tr", { class: row.run.pareto ? "detail pareto" : "detail" },
        element("td", { colspan: this.columns.length }, runDetails(row.run, this.comparison)));
      row.node.after(row.details);
    } else {
      row.details.remove();
      row.details = null;
    }
  }

  // Opens the run's row and brings it into sight.
  show(id) {
    const row = this.byId.get(id);
    if (!row) return;
    if (row.details === null) this.toggle(row);
    row.node.scrollIntoView({ block: "center" });
    row.node.querySelector("button.opens")?.focus({ preventScroll: true });
  }

  // First ascending, then descending. Failed runs stay last, before them those without a value;
  // equal ones stay as the document has them.
  sort(column) {
    const head = this.heads[this.columns.indexOf(column)];
    const direction = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    for (const other of this.heads) other.setAttribute("aria-sort", "none");
    head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
    const values = new Map(this.rows.map((row) => [row, column.value(row.run)]));
    this.rows.sort((a, b) => {
      if (a.failed !== b.failed) return a.failed - b.failed;
      const [x, y] = [values.get(a), values.get(b)];
      if (isMissing(x) || isMissing(y)) return isMissing(x) - isMissing(y) || a.index - b.index;
      return direction * compareValues(x, y) || a.index - b.index;
    });
    this.placeRows();
  }

  placeRows() {
    this.body.replaceChildren(...this.rows.flatMap((row) => row.details ? [row.node, row.details] : [row.node]));
  }

  // Hides what does not have all words; returns whether a run matches.
  filter(words) {
    const matches = ({ words: all }) => words.every((word) => all.includes(word));
    let shown = 0;
    for (const row of this.rows) {
      const hidden = !matches(row);
      row.node.hidden = hidden;
      if (row.details) row.details.hidden = hidden;
      if (!hidden) ++shown;
    }
    this.count.textContent = words.length === 0 ? "" : `${shown} of ${this.rows.length} runs match.`;
    return (run) => matches(this.byId.get(run.id));
  }
}
