// Numbers of a motion, and the paper that its places are drawn on: the plane, or the sphere seen from far away.
// Places come in the units of the picture's viewBox; on the sphere as unit vectors. One script with the files after it.
const SVG = "http://www.w3.org/2000/svg";
const HINGE = 55, WIDE = 26, REACH = 110; // a hinge's radius, a link's width, how near a pointer has to come
const SECONDS = 6; // one way at speed 1
const ARC = 32; // pieces of a great arc

const make = (name, attributes, parent) => {
  const made = document.createElementNS(SVG, name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (parent) parent.appendChild(made);
  return made;
};
const mix = (a, b, share) => a.map((value, k) => value + share * (b[k] - value));
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((value) => value / (Math.hypot(...a) || 1));
const text = (value) => value.toFixed(1);
const polyline = (places) => places.map((p) => `${text(p[0])} ${text(p[1])}`).join("L");

// Numbers of one thing, row by row; a row of one sample stands for all. Between samples they are mixed.
class Series {
  constructor(numbers, columns) {
    this.numbers = numbers;
    this.columns = columns;
    this.rows = numbers.length / columns;
  }
  row(index) {
    const first = this.rows > 1 ? index * this.columns : 0;
    const found = this.numbers.slice(first, first + this.columns);
    return found.includes(null) ? null : found;
  }
  at(place) {
    const low = Math.floor(place), share = place - low, start = this.row(low);
    if (!share || this.rows === 1 || !start) return start;
    const end = this.row(low + 1);
    return end ? mix(start, end, share) : start;
  }
}

class Flat {
  flat(place) { return place; }
  front() { return true; }
  between(a, b, share) { return mix(a, b, share); }
  line(a, b) { return [a, b]; }
  paths(places) {
    const known = [];
    let pen = false;
    for (const place of places) {
      if (place) known.push(`${pen ? "L" : "M"}${text(place[0])} ${text(place[1])}`);
      pen = Boolean(place);
    }
    return [known.join(""), ""];
  }
}

// The sphere seen from far away: what lies behind it apart from what lies in front.
class Globe {
  constructor(view, centre, radius) {
    this.view = view;
    this.centre = centre;
    this.radius = radius;
  }
  flat(place) {
    const size = this.radius / (Math.hypot(...place) || 1);
    return [this.centre[0] + size * dot(place, this.view[0]), this.centre[1] - size * dot(place, this.view[1])];
  }
  front(place) { return dot(place, this.view[2]) >= 0; }
  between(a, b, share) {
    const one = unit(a), other = unit(b), angle = Math.atan2(Math.hypot(...cross(one, other)), dot(one, other));
    if (angle < 1e-9) return one;
    const [s, t] = [Math.sin((1 - share) * angle), Math.sin(share * angle)];
    return one.map((value, k) => (s * value + t * other[k]) / Math.sin(angle));
  }
  line(a, b) { return Array.from({ length: ARC + 1 }, (_, k) => this.between(a, b, k / ARC)); }
  paths(places) {
    const drawn = ["", ""];
    for (let k = 1; k < places.length; k += 1) {
      const [a, b] = [places[k - 1], places[k]];
      if (!a || !b) continue;
      const behind = this.front(a) || this.front(b) ? 0 : 1;
      const piece = `${polyline([this.flat(a), this.flat(b)])}`;
      const foot = piece.split("L")[0];
      drawn[behind] += drawn[behind].endsWith(foot) ? piece.slice(foot.length) : `M${piece}`;
    }
    return drawn;
  }
  turn(right, up) {
    const [x, y, z] = this.view;
    const tilted = unit(z.map((value, k) => value - (right * x[k] + up * y[k]) / this.radius));
    const level = Math.abs(tilted[2]) < 0.98 ? [0, 0, 1] : y;
    const side = unit(cross(level, tilted));
    this.view = [side, cross(tilted, side), tilted];
  }
}
