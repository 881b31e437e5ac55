// SPDX-License-Identifier: Apache-2.0
// Where values lie along an axis, and its ticks.

const zeroBand = 30;  // pixels at the low end of a logarithmic axis, where zeros lie

function linearTicks(low, high, wholeOnly, wanted) {
  const power = 10 ** Math.floor(Math.log10((high - low) / wanted));
  let step = [1, 2, 5, 10].map((f) => f * power).find((s) => (high - low) / s <= wanted);
  if (wholeOnly) step = Math.max(1, step);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) ticks.push(i * step);
  return ticks;
}

function powersWithin(base, low, high, wanted) {
  const first = Math.ceil(Math.log(low) / Math.log(base) - 1e-9);
  const last = Math.floor(Math.log(high) / Math.log(base) + 1e-9);
  const stride = Math.max(1, Math.ceil((last - first + 1) / wanted));
  const ticks = [];
  for (let e = first; e <= last; e += stride) ticks.push(base ** e);
  return ticks;
}

function digitsWithin(digits, low, high) {
  return powersWithin(10, low / 10, high, Infinity)
    .flatMap((power) => digits.map((digit) => digit * power))
    .filter((tick) => tick >= low && tick <= high);
}

// As few digits as give four ticks; a range that is too narrow for all of them gets steps.
function logTicks(low, high, wanted) {
  const powers = powersWithin(10, low, high, wanted);
  if (powers.length >= 4) return powers;
  for (const digits of [[1, 3], [1, 2, 5], [1, 2, 3, 4, 5, 6, 7, 8, 9]]) {
    const ticks = digitsWithin(digits, low, high);
    if (ticks.length >= 4) return ticks;
  }
  return linearTicks(low, high, false, wanted);
}

function isPowerOfTwo(value) {
  return value > 0 && Number.isInteger(Math.log2(value));
}

// An axis of `length` pixels that shows all of `values`. at(value): pixels from its low end, or null
// for what a logarithmic axis cannot show. pads: shares of its length that stay free at both ends.
class Axis {
  constructor({ label, log }, values, length, wanted, pads = [0.05, 0.05]) {
    const shown = values.filter((value) => Number.isFinite(value) && (!log || value > 0));
    this.label = label;
    this.log = Boolean(log);
    this.length = length;
    this.hasZero = this.log && values.includes(0);
    this.start = this.hasZero ? zeroBand : 0;
    let [low, high] = [Math.min(...shown), Math.max(...shown)];
    if (shown.length === 0) [low, high] = log ? [0.1, 1] : [0, 1];
    if (low === high) {
      const room = Math.abs(low) / 2 || 1;
      [low, high] = log ? [low / 2, high * 2] : [low - room, high + room];
    }
    this.setRange(low, high, pads);
    this.setTicks(shown, wanted);
  }

  setRange(low, high, [before, after]) {
    const [from, to] = [this.measure(low), this.measure(high)];
    const span = (to - from) / (1 - before - after);
    this.from = from - before * span;
    this.to = to + after * span;
  }

  setTicks(shown, wanted) {
    const [low, high] = this.log ? [Math.exp(this.from), Math.exp(this.to)] : [this.from, this.to];
    const binary = this.log && new Set(shown).size > 2 && shown.every(isPowerOfTwo);
    if (!this.log) this.ticks = linearTicks(low, high, shown.every(Number.isInteger), wanted);
    else this.ticks = binary ? powersWithin(2, low, high, wanted) : logTicks(low, high, wanted);
    const minor = this.log && !binary && high / low < 1e5;
    this.minorTicks = minor ? digitsWithin([1, 2, 3, 4, 5, 6, 7, 8, 9], low, high) : [];
  }

  measure(value) {
    return this.log ? Math.log(value) : value;
  }

  at(value) {
    if (!Number.isFinite(value) || (this.log && value < 0)) return null;
    if (this.log && value === 0) return zeroBand / 2 - 2;
    return this.start + (this.length - this.start) * (this.measure(value) - this.from) / (this.to - this.from);
  }
}
