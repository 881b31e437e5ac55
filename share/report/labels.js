// SPDX-License-Identifier: Apache-2.0
// Names beside points, without overlap where there is room.

const labelHeight = 14;
const labelFont = '11px "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif';
const measuring = document.createElement("canvas").getContext("2d");

function labelWidth(text) {
  measuring.font = labelFont;
  return measuring.measureText(text).width;
}

function overlapOf(a, b) {
  const width = Math.min(a.right, b.right) - Math.max(a.left, b.left);
  const height = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
  return width > 0 && height > 0 ? width * height : 0;
}

function boxHolds(box, x, y) {
  return x > box.left && x < box.right && y > box.top && y < box.bottom;
}

function distanceTo(box, { x, y }) {
  return Math.hypot(Math.max(box.left - x, 0, x - box.right), Math.max(box.top - y, 0, y - box.bottom));
}

// Below and to the left of a Pareto front there is nothing, so these directions come first.
const directions = [[-1, 1], [-1, 0], [1, -1], [1, 0], [0, 1], [0, -1], [-1, -1], [1, 1],
                    [-2, 1], [-1, 2], [2, -1], [1, -2]];
const distances = [7, 12, 20, 30, 44, 62, 84, 110, 140, 175];

// Where the text could stand: its box, and the end of the line that leads to it.
function candidatesFor(point, width) {
  return distances.flatMap((distance, far) => directions.map(([dx, dy], later) => {
    const length = Math.hypot(dx, dy);
    const x = point.x + distance * dx / length;
    const y = point.y + distance * dy / length;
    const left = dx < 0 ? x - width : dx > 0 ? x : x - width / 2;
    const top = y - labelHeight / 2 + (dx === 0 ? labelHeight / 2 * dy : 0);
    return { left, right: left + width, top, bottom: top + labelHeight, endX: x, endY: y,
             led: far > 0, price: 4 * far + later / 4 };
  }));
}

function pointsAlong(point, candidate) {
  const steps = candidate.led ? Math.max(4, Math.ceil(distances.at(-1) / 12)) : 0;
  return Array.from({ length: steps }, (_, i) => {
    const share = (i + 1) / (steps + 1);
    return [point.x + share * (candidate.endX - point.x), point.y + share * (candidate.endY - point.y)];
  });
}

// points: {x, y, text}; obstacles: [x, y] that names had better not cover. Returns a place for each:
// {left, top, right, bottom, endX, endY, led}.
function placeLabels(points, obstacles, box) {
  const placed = [];
  const leaders = [];
  for (const point of points) {
    let best = null;
    for (const candidate of candidatesFor(point, labelWidth(point.text))) {
      if (candidate.left < box.left + 2 || candidate.right > box.right ||
          candidate.top < box.top || candidate.bottom > box.bottom) {
        continue;
      }
      let price = candidate.price;
      for (const other of placed) price += 5 * overlapOf(candidate, other);
      for (const [x, y] of leaders) if (boxHolds(candidate, x, y)) price += 40;
      // A name that is nearer to another named point would be read as that one's.
      const own = distanceTo(candidate, point);
      for (const other of points) if (other !== point && distanceTo(candidate, other) <= own) price += 15;
      if (best && price >= best.price) continue;
      const way = pointsAlong(point, candidate);
      for (const [x, y] of way) for (const other of placed) if (boxHolds(other, x, y)) price += 40;
      for (const [x, y] of obstacles) {
        if (boxHolds(candidate, x, y)) price += 6;
        if (way.some(([wayX, wayY]) => Math.abs(wayX - x) + Math.abs(wayY - y) < 5)) price += 3;
      }
      if (!best || price < best.price) best = { ...candidate, price, way };
    }
    best ??= { ...candidatesFor(point, labelWidth(point.text))[0], way: [] };
    placed.push(best);
    leaders.push(...best.way);
  }
  return placed;
}
