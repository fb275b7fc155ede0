// Conventional signs whose size hangs on the dimensions: guides with their ground, slots, blocks, wheels, barrels.
const SIGN = HINGE, GROUND = "var(--earth)", INK = "var(--sign)";
const degrees = (angle) => (angle * 180) / Math.PI;
const turned = ([x, y], angle) => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
const plus = (a, b, share = 1) => a.map((value, k) => value + share * b[k]);
const minus = (a, b) => a.map((value, k) => value - b[k]);
const span = (values) => {
  let least = Infinity, most = -Infinity;
  for (const value of values) {
    if (value < least) least = value;
    if (value > most) most = value;
  }
  return least <= most ? [least, most] : [0, 0];
};

// The paper: from places in SI to the units of the picture, whose y points down.
class Paper {
  constructor(low, high, size) {
    this.size = size;
    this.scale = Math.min(size[0] / (high[0] - low[0]), size[1] / (high[1] - low[1]));
    const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    this.low = [middle[0] - size[0] / (2 * this.scale), middle[1] - size[1] / (2 * this.scale)];
    this.top = middle[1] + size[1] / (2 * this.scale);
  }
  place([x, y]) {
    return [this.scale * (x - this.low[0]), this.scale * (this.top - y)];
  }
  back([x, y]) {
    return [this.low[0] + x / this.scale, this.top - y / this.scale];
  }
}

const drawn = (corners, closed) => (corners.length ? `M${polyline(corners)}${closed ? "Z" : ""}` : "");

// A line of the ground with strokes on the side that `away` points to, in units of the picture.
const hatched = (start, end, away) => {
  const way = minus(end, start), length = Math.hypot(...way) || 1, along = way.map((value) => value / length);
  let d = drawn([start, end]);
  const count = Math.min(400, Math.max(2, Math.round(length / (0.9 * SIGN))));
  for (let k = 1; k <= count; k += 1) {
    const foot = plus(start, way, k / count);
    d += drawn([foot, plus(foot, minus(away, along), 0.9 * SIGN)]);
  }
  return d;
};
const circleOf = (radius, spoke) => {
  const around = Array.from({ length: 73 }, (_, k) => turned([radius, 0], (k * Math.PI) / 36));
  return drawn(around, true) + (spoke ? drawn([[0, 0], [radius, 0]]) : "");
};
const slotOf = (start, end) => {
  const turn = Math.atan2(end[1] - start[1], end[0] - start[0]);
  const cap = (middle, from) => Array.from({ length: 13 }, (_, k) =>
    plus(middle, turned([1.5 * SIGN, 0], turn + from + (k * Math.PI) / 12)));
  return drawn([...cap(end, -Math.PI / 2), ...cap(start, Math.PI / 2)], true);
};
const blockOf = (angle) => drawn([[-2.6, -1.7], [2.6, -1.7], [2.6, 1.7], [-2.6, 1.7]].map((corner) =>
  turned([corner[0] * SIGN, corner[1] * SIGN], angle)), true);

// What is drawn in axes of a link: `of(place)` are the axes' origin in SI and their angle at each sample.
class Axes {
  constructor(model, paper, link) {
    this.model = model;
    this.paper = paper;
    this.link = link;
  }
  origin(sample) {
    if (this.link === null) return [0, 0];
    const { model } = this, own = model.data.drawing.bodies[this.link];
    const angle = this.angle(sample);
    for (const corner of own.locals) {
      const at = model.at(corner.point, sample);
      if (at) return minus(at, turned(localOf(model, corner), angle));
    }
    return null;
  }
  angle(sample) {
    return this.link === null ? 0 : this.model.frame.angle[this.link][sample];
  }
  local(place, sample) {
    const origin = this.origin(sample);
    return origin && place && turned(minus(place, origin), -this.angle(sample));
  }
  global(local, sample) {
    const origin = this.origin(sample);
    return origin && plus(origin, turned(local, this.angle(sample)));
  }
  // x, y and degrees clockwise of axes at a place of the link, one behind the other, as the pictures of reports have them.
  poses(local = [0, 0], more = 0) {
    const found = [];
    const samples = this.link === null ? 1 : this.model.frame.samples;
    for (let sample = 0; sample < samples; sample += 1) {
      const place = this.global(local, sample), angle = this.angle(sample);
      if (place && Number.isFinite(angle)) found.push(...this.paper.place(place), -degrees(angle + more));
      else found.push(null, null, null);
    }
    return found;
  }
}
const localOf = (model, corner) => [
  model.value(corner.length ?? corner.x, corner.at[0]), corner.length ? 0 : model.value(corner.y, corner.at[1]),
];

// A direction in the picture, where y points down.
const flipped = ([x, y]) => [x, -y];
const along = (model, guide) => {
  const angle = model.value(guide.directionPath, guide.direction);
  return [Math.cos(angle), Math.sin(angle)];
};

// The part of a guide that its point travels, in the axes of its link; nothing where the point has no place.
const travel = (model, paper, guide) => {
  const axes = new Axes(model, paper, guide.on), way = along(model, guide), reach = [], aside = [];
  for (let sample = 0; sample < model.frame.samples; sample += 1) {
    const place = axes.local(model.at(guide.point, sample), sample);
    if (!place) continue;
    reach.push(place[0] * way[0] + place[1] * way[1]);
    aside.push(place[1] * way[0] - place[0] * way[1]);
  }
  if (!reach.length) return null;
  const [least, most] = span(reach), off = aside[aside.length >> 1], across = [-way[1], way[0]];
  return [least, most].map((value) => plus([off * across[0], off * across[1]], way, value));
};

// The hatched line under a slider, on the side that points down or away from the middle.
const groundOf = (paper, [from, to]) => {
  const start = paper.place(from), end = paper.place(to), way = minus(end, start);
  const length = Math.hypot(...way) || 1, on = way.map((value) => value / length), across = [-on[1], on[0]];
  const middle = plus(plus(start, end), paper.size, -1).map((value) => value / 2);
  const aside = Math.abs(on[0]) > 0.2 ? across[1] : across[0] * middle[0] + across[1] * middle[1];
  const away = aside >= 0 ? across : across.map((value) => -value);
  return hatched(plus(plus(start, away, 95), on, -220), plus(plus(end, away, 95), on, 220), away);
};

// A cam that drives: where its axis is, what the follower has turned against the description, whether its arm is the cam's.
const camNow = (model, cam) => {
  const by = ({ path, at }) => model.value(path, at) - at, began = by(cam.start);
  if (cam.link === null) {
    const turn = by(cam.direction), way = turned([1, 0], cam.direction.at + turn), { through } = cam;
    const base = through.paths ? through.paths.map((path, k) => model.value(path, through.at[k])) : model.at(through.point, 0);
    return { axis: plus(plus(base, turned(cam.axis, turn)), way, began), turn, lean: turn, fits: true };
  }
  let turn = 0, fits = true;
  if (cam.arm) {
    const [from, to] = cam.arm.ends, before = minus(to.at, from.at), now = minus(localOf(model, to), localOf(model, from));
    turn = Math.atan2(now[1], now[0]) - Math.atan2(before[1], before[0]);
    const { length, most } = cam.arm;
    fits = length === null || Math.abs(Math.hypot(...now) - length) <= most * length;
    return { axis: plus(model.at(cam.point, 0), turned(cam.axis, turn + began)), turn: turn + began, lean: turn, fits, arm: Math.hypot(...now), length };
  }
  return { axis: plus(model.at(cam.point, 0), turned(cam.axis, began)), turn: began, lean: 0, fits };
};

// Profile with its mark, the follower's straight parts, its roller, the cam's axis: all of them rigid.
const camShapes = (model, paper, cam) => {
  const { axis, turn, lean, fits } = camNow(model, cam), { time, samples } = model.frame;
  const picture = (corner) => flipped(corner).map((value) => value * paper.scale);
  const profile = [], follower = [], hub = paper.place(axis);
  for (let sample = 0; sample < samples; sample += 1) {
    profile.push(...hub, -degrees(turn + cam.turned[0] + cam.turned[1] * time[sample]));
    const place = model.at(cam.point, sample), angle = cam.link === null ? 0 : model.frame.angle[cam.link][sample];
    if (place && Number.isFinite(angle)) follower.push(...paper.place(place), -degrees(angle + lean));
    else follower.push(null, null, null);
  }
  const outline = drawn(cam.outline.map(picture), true), behind = true;
  const found = [
    { d: outline, at: profile, colour: GROUND, filled: true, behind },
    { d: drawn(cam.mark.map(picture)), at: profile, colour: INK, behind },
    ...cam.lines.map((line) => ({ d: drawn(line.map(picture)), at: follower, colour: INK, behind })),
  ];
  if (cam.roller) {
    const centre = picture(cam.roller), rim = Array.from({ length: 49 }, (_, k) => plus(centre, turned([cam.radius * paper.scale, 0], (k * Math.PI) / 24)));
    found.push({ d: drawn(rim, true), at: follower, colour: INK, white: true, behind });
  }
  found.push({ d: circleOf(SIGN), at: [...hub, 0], colour: GROUND, white: true, behind });
  return fits ? found : found.map((shape) => ({ ...shape, d: "" }));
};

// Shapes of cams, of guides on moving links, of wheels and of cylinders: each { d, at } in the picture, made anew for other dimensions.
const shapesOf = (model, paper) => {
  const { drawing } = model.data, found = [];
  const colourOf = (link) => (link === null ? GROUND : drawing.bodies[link].colour);
  for (const cam of drawing.cams) found.push(...camShapes(model, paper, cam));
  for (const wheel of drawing.wheels) {
    const axes = new Axes(model, paper, wheel.on), radius = model.value(wheel.radiusPath, wheel.radius);
    if (wheel.track) {
      const around = model.value(wheel.track.radiusPath, wheel.track.radius) * paper.scale;
      found.push({ d: circleOf(around), at: axes.poses(wheel.track.centre), ground: wheel.on === null, colour: colourOf(wheel.on), behind: true });
    } else {
      const line = travel(model, paper, { on: wheel.on, point: wheel.centre, direction: wheel.direction });
      const down = [Math.sin(wheel.direction), -Math.cos(wheel.direction)];
      const on = [Math.cos(wheel.direction), Math.sin(wheel.direction)];
      const ends = (line ?? [[0, 0], [0, 0]]).map((end, k) =>
        plus(plus(end, down, radius), on, (k ? 0.4 : -0.4) * radius).map((value) => value * paper.scale)).map(flipped);
      const side = flipped(down);
      const d = wheel.on === null ? hatched(ends[0], ends[1], side) : drawn(ends);
      found.push({ d, at: axes.poses(), ground: wheel.on === null, colour: colourOf(wheel.on), behind: true });
    }
    const own = new Axes(model, paper, wheel.link), rim = [];
    for (let sample = 0; sample < model.frame.samples; sample += 1) {
      const place = model.at(wheel.centre, sample), angle = own.angle(sample);
      if (place && Number.isFinite(angle)) rim.push(...paper.place(place), -degrees(angle));
      else rim.push(null, null, null);
    }
    found.push({ d: circleOf(radius * paper.scale, true), at: rim, colour: colourOf(wheel.link), filled: true, behind: true });
  }
  for (const guide of drawing.guides) {
    if (guide.on === null) continue;
    const ends = travel(model, paper, guide), axes = new Axes(model, paper, guide.on), way = flipped(along(model, guide));
    const [start, end] = (ends ?? [[0, 0], [0, 0]]).map((one) => flipped(one).map((value) => value * paper.scale));
    const at = axes.poses(), colour = colourOf(guide.on);
    // what joins the line to its link
    const corners = drawing.bodies[guide.on].locals.map((corner) => flipped(localOf(model, corner)).map((value) => value * paper.scale));
    const foot = (place) => plus(start, minus(end, start), within(
      (minus(place, start)[0] * minus(end, start)[0] + minus(place, start)[1] * minus(end, start)[1])
        / (Math.hypot(...minus(end, start)) ** 2 || 1), 0, 1));
    const nearestOf = corners.length ? corners.reduce((best, one) =>
      (Math.hypot(...minus(one, foot(one))) < Math.hypot(...minus(best, foot(best))) ? one : best)) : null;
    found.push({ d: ends && nearestOf ? drawn([nearestOf, foot(nearestOf)]) : "", at, colour, line: true, behind: true });
    if (guide.link === null) {
      found.push({ d: ends ? slotOf(start, end) : "", at, colour, white: true, behind: true });
      continue;
    }
    found.push({ d: ends ? drawn([plus(start, way, -3.5 * SIGN), plus(end, way, 3.5 * SIGN)]) : "", at, colour, line: true, behind: true });
    const block = [];
    for (let sample = 0; sample < model.frame.samples; sample += 1) {
      const place = model.at(guide.point, sample), angle = axes.angle(sample);
      if (place && Number.isFinite(angle)) block.push(...paper.place(place), -degrees(angle));
      else block.push(null, null, null);
    }
    found.push({ d: blockOf(Math.atan2(way[1], way[0])), at: block, colour: colourOf(guide.link), white: true });
  }
  for (const [first, second] of drawing.cylinders) {
    let least = Infinity;
    const poses = [];
    for (let sample = 0; sample < model.frame.samples; sample += 1) {
      const a = model.at(first, sample), b = model.at(second, sample), way = a && b && minus(b, a);
      if (way) {
        least = Math.min(least, Math.hypot(...way));
        poses.push(...paper.place(a), -degrees(Math.atan2(way[1], way[0])));
      } else poses.push(null, null, null);
    }
    const long = Number.isFinite(least) ? 0.8 * least * paper.scale : 0;
    found.push({ d: drawn([[0, -1.3 * SIGN], [long, -1.3 * SIGN], [long, 1.3 * SIGN], [0, 1.3 * SIGN]], true), at: poses, colour: INK, white: true });
  }
  return found;
};
