// SPDX-License-Identifier: Apache-2.0
// Numbers as text, and the order of values.

const missingText = "–";
const minus = "\u2212";
const thinSpace = "\u202f";

function superscript(integer) {
  return String(integer).replace(/./g, (digit) => digit === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);
}

function isMissing(value) {
  return value === null || value === undefined;
}

// 12345.6 with `decimals` of 1: "12 345.6".
function fixedText(value, decimals) {
  const [whole, fraction] = Math.abs(value).toFixed(decimals).split(".");
  const grouped = whole.length < 5 ? whole : whole.replace(/\B(?=(\d{3})+$)/g, thinSpace);
  return (value < 0 ? minus : "") + grouped + (fraction ? "." + fraction : "");
}

// Three significant digits, and every digit before the point.
function numberText(value) {
  if (isMissing(value)) return missingText;
  if (value === 0) return "0";
  const [mantissa, exponent] = Math.abs(value).toExponential(2).split("e");
  if (exponent < -3 || exponent > 8) {
    return `${value < 0 ? minus : ""}${mantissa}·10${superscript(Number(exponent))}`;
  }
  return fixedText(value, Math.max(0, 2 - exponent));
}

function wholeText(value) {
  return isMissing(value) ? missingText : fixedText(value, 0);
}

// Of ticks, which are round: no digits beyond those that they have.
function tickText(value) {
  if (value === 0) return "0";
  const [mantissa, exponent] = Number(Math.abs(value).toPrecision(6)).toExponential().split("e");
  const sign = value < 0 ? minus : "";
  if (exponent < -3 || exponent > 5) {
    return `${sign}${mantissa === "1" ? "" : mantissa + "·"}10${superscript(Number(exponent))}`;
  }
  return fixedText(value, Math.max(0, mantissa.replace(/^\d\.?/, "").length - exponent));
}

// The value of a swept key.
function valueText(value) {
  if (isMissing(value)) return missingText;
  if (Array.isArray(value)) {
    const between = value.every(Number.isInteger) ? "x" : ", ";  // factors of a tree: 32x32
    return value.length === 0 ? "[]" : value.map(valueText).join(between);
  }
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

// Numbers by size, lists entry by entry, all else as text; neither may be missing.
function compareValues(a, b) {
  if (Array.isArray(a) && Array.isArray(b)) {
    for (let i = 0; i < Math.min(a.length, b.length); ++i) {
      const order = compareValues(a[i], b[i]);
      if (order !== 0) return order;
    }
    return a.length - b.length;
  }
  if (typeof a === "number" && typeof b === "number") return a - b;
  if (typeof a === "number" || typeof b === "number") return typeof a === "number" ? -1 : 1;
  const [textA, textB] = [valueText(a), valueText(b)];
  return textA < textB ? -1 : textA > textB ? 1 : 0;
}

// The shortest ends of dotted keys that tell them apart: ["a.x.n", "a.y.n", "b"] -> x.n, y.n, b.
function shortKeys(keys) {
  const endOf = (key, parts) => key.split(".").slice(-parts).join(".");
  return new Map(keys.map((key) => {
    let parts = 1;
    while (parts < key.split(".").length &&
           keys.some((other) => other !== key && endOf(other, parts) === endOf(key, parts))) {
      ++parts;
    }
    return [key, endOf(key, parts)];
  }));
}
