// SPDX-License-Identifier: Apache-2.0
// What a row of the table opens: pictures and figures of one run.

function smallTable(className, heads, rows) {
  return element("table", { class: `small ${className}` },
    element("thead", null, element("tr", null, heads.map((head) => element("th", { scope: "col" }, head)))),
    element("tbody", null, rows.map(([first, ...rest]) => element("tr", null,
      element("th", { scope: "row" }, first), rest.map((cell) => element("td", null, cell))))));
}

function channelTable(run) {
  if (!run.channels) return null;
  const rows = Object.entries(run.channels).map(([name, norms]) =>
    [name, numberText(norms.linf), numberText(norms.l1), numberText(norms.l2)]);
  return smallTable("channels", ["error (1/255)", "L∞", "L1", "L2"],
    [...rows, ["all", numberText(run.linf), numberText(run.l1), numberText(run.l2)]]);
}

function timeTable(run) {
  const rows = [["moving camera", run.frame_ms], ["still camera", run.still_ms]].filter(([, times]) => times)
    .map(([name, times]) => [name, numberText(times.median), numberText(times.min), numberText(times.max),
                             wholeText(times.n)]);
  return smallTable("times", ["frame time (ms)", "median", "min", "max", "frames"], rows);
}

function stageTable(run) {
  const rows = Object.entries(run.stages ?? {}).map(([name, ms]) => [name, numberText(ms)]);
  return rows.length === 0 ? null : smallTable("stages", ["stage", "ms"], rows);
}

function runDetails(run, comparison) {
  const reference = (comparison.references ?? []).find(({ id }) => id === run.reference);
  const size = reference ? shownSize(reference.width, reference.height) : { load: setShownSize };
  const own = reference ? ` of the ${reference.of}; own error ${numberText(reference.error_estimate)}/255` : "";
  return element("div", { class: "details" },
    element("div", { class: "pictures" },
      pictureFigure(run.image, `${comparison.scene}, drawn by the run ${run.name}`, "this run", size, null),
      reference && pictureFigure(reference.image, `${comparison.scene}, traced from the ${reference.of}`,
        `reference ${reference.id}${own}`, size, null),
      pictureFigure(run.difference, `${comparison.scene}: the run ${run.name} less the reference, in false colour`,
        "this run − reference; of each pixel the channel that differs most", size,
        nothingToSee(comparison.difference_scale, run.linf), colorBar(comparison.difference_scale, run.linf))),
    element("div", { class: "figures" }, channelTable(run), timeTable(run), stageTable(run),
      factList([["run", run.id], ["context", run.context],
                ["first picture", isMissing(run.first_ms) ? null
                  : `${numberText(run.first_ms)} ms: facts, choice, set-up and first frame`],
                ["memory of the GPU", isMissing(run.bytes_gpu) ? null : `${wholeText(run.bytes_gpu)} bytes`],
                ["memory of the host", isMissing(run.bytes_host) ? null : `${wholeText(run.bytes_host)} bytes`],
                ["near the reference", run.near_reference ? "error below ten times the reference's own" : null]])));
}
