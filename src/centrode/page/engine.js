/* The motion of one mechanism whose numbers change: what the program prints of it is walked over its samples, and
 * limits and change points are looked for on its mesh of events, with the rules of `kinematics.events` and
 * `kinematics.samples`.
 *
 * const mechanism = createMechanism(data);      data: what the program says of the mechanism, see `page.program`
 * const frame = mechanism.recompute(values);    values: numbers [SI] in the order of mechanism.parameters
 *
 * A frame has, at every sample: drive (rad, m or s), time, status (index into data.statuses), residual, and as misfit the
 * residual of samples that are open because it is above its bound; position,
 * velocity, acceleration [point][axis]; angle, angularVelocity, angularAcceleration [link] (on the sphere rotation
 * vectors [link][axis], and the angles of data.joints in jointAngle); all of them and what else there is by name in
 * `quantities`. Beside these: events [{kind, drive, group}], reach [low, high], signsChange, possible, residualBound.
 * mechanism.reactions() gives those of data.reactions by name in the last frame; they are computed when they are asked for.
 * mechanism.centre(link) gives the instant centre of a link in the last frame: {fixed: [x, y], moving: [x, y]}.
 * Arrays belong to the mechanism and are written anew by the next call; what is absent is NaN.
 */
const createMechanism = (() => {
"use strict";
/* the functions of one mechanism */
"printed";

const TURN = 2 * Math.PI;
const [OK, OPEN, CUT_OFF, SINGULAR] = [0, 1, 2, 3];
/* a radicand below this share of its greatest value is compared with its rounding error, so many times over */
const SUSPECT = 1e-8, SAFETY = 16;
/* how much more than their bounds numbers may stray */
const ROOM = 1 + 1e-6;
/* cells of a cover: in steps of the mesh those of the first frame, and the widest; the narrowest in units of the widest,
 * and where no cell is wider than a step; below which doubt two of them become one */
const WIDE = 12, WIDEST = 32, NARROWEST = 1 / 512, NARROW = 1 / 16, EASY = 0.05;
/* greatest change of an angle from one sample to the next at which its turns are counted there */
const MOST_TURN = 0.8;
/* half width about a change point in which a group is not judged, in units of the path */
const WINDOW = 0.04;
/* beside a change point, in units of the path: how near closed forms lose digits, how far places for a polynomial lie */
const BESIDE = 0.02, CIRCLE = 6 * WINDOW, AROUND = 20;
const AT_THE_START = 1e-9;
/* the search in cells: half width that is one place, parts of a cell, ways towards a place, and its limits */
const FINEST = 1e-10, COARSE = 1e-6, PARTS = 4, HALVINGS = 26, MANY = 1000, MOST = 10000;
const [NONE, KNOWN, UNKNOWN, ENDING] = [0, 1, 2, 3];
const LOW = 0.25, DOUBTFUL = 1e-8, SLACK = 8, STEPS = 100;

const bits = new Float64Array(1), words = new Uint32Array(bits.buffer);

/* distance of a number from the next greater one */
function spacing(x) {
  bits[0] = Math.abs(x);
  if (!(bits[0] < Infinity)) return NaN;
  const here = bits[0];
  words[0] += 1;
  if (words[0] === 0) words[1] += 1;
  return bits[0] - here;
}

const sign = (x) => (x > 0 ? 1 : x < 0 ? -1 : x === 0 ? 0 : NaN);

/* whole numbers as NumPy rounds halves: to even */
function roundHalfToEven(x) {
  const down = Math.floor(x), rest = x - down;
  if (rest !== 0.5) return rest < 0.5 ? down : down + 1;
  return down % 2 === 0 ? down : down + 1;
}

/* zero of a function [value, slope] between two places of opposite signs: Newton's steps, bisection outside */
function root(at, low, high) {
  const first = sign(at(low)[0]);
  let x = 0.5 * (low + high);
  for (let k = 0; k < STEPS; k++) {
    const [value, slope] = at(x);
    if (sign(value) === first) low = x; else high = x;
    const step = x - value / slope;
    const following = step > low && step < high ? step : 0.5 * (low + high);
    const bit = 2 * spacing(x);
    if (value === 0 || Math.abs(step - x) <= bit || high - low <= bit) return x;
    x = following;
  }
  return x;
}

function createMechanism(data) {
  const n = data.samples, parameters = data.parameters;
  const v = new Float64Array(Math.max(1, data.variables));
  const { initial, forward, scale: unit } = data.parameter;
  const signs = new Map(Object.entries(data.signs).map(([group, each]) => [Number(group), each]));
  const guards = data.guards.map(([kind, group], k) => ({ kind, group, k, ofRadicand: kind === "radicand" }));
  const byTime = data.mesh.nodes !== undefined;
  /* laws of time whose second derivative is not known over a cell, but looked at: no cell is wider than one of the mesh */
  const looked = byTime && !data.mesh.bounded;

  /* the mesh of events */
  const mesh = byTime ? Float64Array.from(data.mesh.nodes) : new Float64Array(data.mesh.count);
  const { first, off, step } = data.mesh;
  if (!byTime) for (let k = 0; k < mesh.length; k++) mesh[k] = initial + (first + k + off) * step;
  const halves = new Float64Array(mesh.length);
  for (let k = 0; k < mesh.length; k++) {
    const before = k > 0 ? mesh[k] - mesh[k - 1] : 0, after = k + 1 < mesh.length ? mesh[k + 1] - mesh[k] : 0;
    halves[k] = byTime ? 0.5 * Math.max(before, after) : 0.5 * step;
  }
  function nearestNode(x) {
    if (!byTime) return Math.min(mesh.length - 1, Math.max(0, Math.round((x - initial) / step - off - first)));
    let low = 0, high = mesh.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (0.5 * (mesh[middle] + mesh[middle + 1]) < x) low = middle + 1; else high = middle;
    }
    return low;
  }
  /* number of nodes below a place */
  function nodesBelow(x) {
    let k = nearestNode(x);
    while (k < mesh.length && mesh[k] < x) k++;
    while (k > 0 && mesh[k - 1] >= x) k--;
    return k;
  }

  /* variables of the samples */
  const given = {};
  for (const [name, row] of Object.entries(data.places)) {
    given[name] = Array.isArray(row) ? Float64Array.from(row) : new Float64Array(n).fill(row);
  }
  const drive = given.parameter;
  const nearSamples = Int32Array.from(drive, nearestNode);
  const startSample = drive.reduce((best, x, k) => (Math.abs(x - initial) < Math.abs(drive[best] - initial) ? k : best), 0);
  const margins = Float64Array.from(drive, (x) => 4 * spacing(x));

  /* ---- functions at places: rows that stay are filled once, those that move with the numbers at each call ---- */

  let crossings = new Map();   // group -> change points at which its sign flips
  let events = [];
  const unwound = new Map();   // what gears depend on -> its angle with its turns at the nodes
  for (const [key] of data.counted) unwound.set(key, new Float64Array(mesh.length));

  function signAt(group, x) {
    let side = signs.get(group);
    const places = crossings.get(group);
    if (places !== undefined && data.smooth) {
      const low = Math.min(x, initial), high = Math.max(x, initial);
      for (const at of places) if (low < at && at < high) side = -side;
    }
    return side;
  }

  function wordAndOwner(name) {
    const blank = name.indexOf(" "), word = name.slice(0, blank), of = name.slice(blank + 1);
    return [word, word === "sign" ? Number(of) : of];
  }

  function preparePlaces(f, rows, count) {
    const stride = f.stride ?? count, p = new Float64Array((f.fixed.length + f.parts + f.moving.length) * stride);
    f.fixed.forEach((name, k) => p.set(rows[name], k * stride));
    const parts = p.subarray(f.fixed.length * stride), o = new Float64Array(f.count * stride);
    f.before(v, p, count, parts);
    const start = (f.fixed.length + f.parts) * stride;
    const moving = f.moving.map((name, k) => {
      const [word, of] = wordAndOwner(name);
      return { word, of, row: p.subarray(start + k * stride, start + k * stride + count) };
    });
    return { f, p, parts, count, moving, at: rows.parameter, o, row: (k) => o.subarray(k * stride, k * stride + count) };
  }

  /* numbers of a row that moves with the numbers of the mechanism; `nodes` of the mesh next to places, where they are known */
  function fillRow(word, of, row, at, nodes) {
    if (word === "sign") {
      if (crossings.has(of) && data.smooth) for (let i = 0; i < row.length; i++) row[i] = signAt(of, at[i]);
      else row.fill(signs.get(of));
    } else if (word === "near") {
      const angle = unwound.get(of);
      for (let i = 0; i < row.length; i++) row[i] = angle[nodes === undefined ? nearestNode(at[i]) : nodes[i]];
    }
  }

  function fillMoving(places, nodes) {
    for (const { word, of, row } of places.moving) fillRow(word, of, row, places.at, nodes);
  }

  function run(places, nodes, last) {
    fillMoving(places, nodes);
    places.f.run(v, places.p, places.count, places.o, last);
    return places.o;
  }

  /* Guards over any cells, up to the last one that is looked at: numbers (outputs, cells) in one row, which belongs to
   * its purpose and is written anew by the next call. */
  const rooms = new Map();
  const movingOfCells = printed.cells.moving.map(wordAndOwner);
  function cellsAt(purpose, { at, half, size }, last) {
    const f = printed.cells, before = f.fixed.length, rowsOfPlaces = before + f.parts + f.moving.length;
    let room = rooms.get(purpose);
    if (room === undefined || room.size < size) {
      const most = 2 * size;
      room = { size: most, p: new Float64Array(rowsOfPlaces * most), o: new Float64Array(f.count * most) };
      rooms.set(purpose, room);
    }
    const { p, o } = room;
    for (let k = 0; k < before; k++) {
      const row = f.fixed[k] === "half" ? half : at;
      for (let i = 0; i < size; i++) p[k * size + i] = row[i];
    }
    f.before(v, p, size, f.parts ? p.subarray(before * size) : p);
    for (let k = 0; k < movingOfCells.length; k++) {
      const [word, of] = movingOfCells[k], start = (before + f.parts + k) * size;
      fillRow(word, of, p.subarray(start, start + size), at);
    }
    f.run(v, p, size, o, last);
    return o;
  }

  /* cells that grow in number: where they are and how wide; of a cover also how wide they may become, and their doubt */
  function cellList() {
    const cells = { size: 0 }, numbers = ["at", "half", "widest", "doubt"];
    for (const name of numbers) cells[name] = new Float64Array(256);
    cells.add = (at, half, widest = Infinity, doubt = NaN) => {
      const { size } = cells;
      if (size === cells.at.length) {
        for (const name of numbers) {
          const longer = new Float64Array(2 * size);
          longer.set(cells[name]);
          cells[name] = longer;
        }
      }
      cells.at[size] = at;
      cells.half[size] = half;
      cells.widest[size] = widest;
      cells.doubt[size] = doubt;
      cells.size++;
    };
    cells.addParts = (at, half, parts, widest) => {
      for (let q = 0; q < parts; q++) cells.add(at + half * ((2 * q + 1) / parts - 1), half / parts, widest);
    };
    return cells;
  }

  const single = {};
  for (const name of ["curves", "bounds"]) {
    single[name] = preparePlaces(printed[name], { parameter: new Float64Array(1) }, 1);
  }
  /* the same at one place, without new arrays; curves give value, slope and second derivative of each guard */
  function evaluateAt(name, x, last) {
    const places = single[name], f = places.f;
    places.at[0] = x;
    if (f.fixed.length) places.p[0] = x;
    f.before(v, places.p, 1, places.parts);
    return run(places, undefined, last);
  }

  const atSamples = preparePlaces(printed.motion, given, n);
  const atNodes = { rotors: null, counted: null };
  function onMesh(name) {
    if (atNodes[name] === null) atNodes[name] = preparePlaces(printed[name], { parameter: mesh }, mesh.length);
    return run(atNodes[name], allNodes);
  }
  const allNodes = Int32Array.from(mesh, (_x, k) => k);
  const startNode = nearestNode(initial);

  const cellsOnMesh = (() => {
    let places = null;
    return () => (places ??= preparePlaces(printed.cells, { parameter: mesh, half: halves }, mesh.length));
  })();

  /* ---- the search for events ---- */

  const largest = new Map();

  /* the range in which something happens to the samples, and that of the whole mesh */
  let leastDrive = initial, mostDrive = initial;
  for (const x of drive) { leastDrive = Math.min(leastDrive, x); mostDrive = Math.max(mostDrive, x); }
  const ofMotion = rangeOf(leastDrive - BESIDE * unit, mostDrive + BESIDE * unit);
  const everything = rangeOf(mesh[0], mesh[mesh.length - 1]);

  function rangeOf(low, high) {
    return { low, high, first: Math.max(0, nodesBelow(low) - 1), last: Math.min(mesh.length - 1, nodesBelow(high)), cover: null };
  }

  /* Cells that cover a range, narrow enough to show that nothing happens in them. Numbers change little from one frame
   * to the next, so one begins with the cells of the last: those that decide nothing are halved, two neighbours that
   * decide easily become one. */
  function createCover({ low, high, first, last }) {
    let cells = cellList(), following = cellList();
    const judged = cellList(), narrowest = looked ? NARROW : NARROWEST;
    if (looked) for (let j = first; j <= last; j++) cells.add(mesh[j], halves[j], halves[j]);
    else {
      const node = byTime ? (mesh[last] - mesh[first]) / (last - first) : step;
      cells.addParts(0.5 * (low + high), 0.5 * (high - low), Math.ceil((high - low) / (WIDE * node)), 0.5 * WIDEST * node);
    }

    /* judge those that are not yet; those that decide nothing leave halves behind them, as long as they are wide */
    function refine() {
      judged.size = following.size = 0;
      const { size, at, half, widest, doubt } = cells;
      for (let i = 0; i < size; i++) if (doubt[i] !== doubt[i]) judged.add(at[i], half[i]);
      if (!judged.size) return false;
      const o = cellsAt("cover", judged);
      for (let i = 0, q = 0; i < size; i++) {
        const doubtNow = doubt[i] !== doubt[i] ? doubtOfCell(o, judged.size, q++, half[i]) : doubt[i];
        if (doubtNow < 1 || half[i] <= narrowest * widest[i]) following.add(at[i], half[i], widest[i], doubtNow);
        else following.addParts(at[i], half[i], 2, widest[i]);
      }
      [cells, following] = [following, cells];
      return true;
    }

    /* the same cells for the next frame, fewer where they decide easily */
    function join() {
      following.size = 0;
      const { size, at, half, widest, doubt } = cells;
      for (let i = 0; i < size; i++) {
        const wide = i + 1 < size ? half[i] + half[i + 1] : Infinity;
        const both = doubt[i] < EASY && doubt[i + 1] < EASY && wide <= Math.min(widest[i], widest[i + 1]);
        if (!both || Math.abs(at[i + 1] - at[i] - wide) > FINEST * wide) { following.add(at[i], half[i], widest[i]); continue; }
        following.add(at[i] + half[i + 1], wide, Math.min(widest[i], widest[i + 1]));
        i++;
      }
      [cells, following] = [following, cells];
    }

    /* nodes about the cells in which something may happen; null where nothing does */
    return () => {
      while (refine());
      const nodes = [];
      for (let i = 0, next = 0; i < cells.size; i++) {
        if (cells.doubt[i] < 1) continue;
        const end = Math.min(mesh.length - 1, nearestNode(cells.at[i] + cells.half[i]) + 2);
        for (next = Math.max(next, nearestNode(cells.at[i] - cells.half[i]) - 2); next <= end; next++) nodes.push(next);
      }
      join();
      return nodes.length ? Int32Array.from(nodes) : null;
    };
  }

  /* below 1 where no guard passes or touches zero in a cell; the greatest such number of a guard counts */
  function doubtOfCell(o, count, i, half) {
    let most = 0;
    for (let k = 0; k < guards.length; k++) {
      const value = o[3 * k * count + i], slope = o[(3 * k + 1) * count + i], bend = o[(3 * k + 2) * count + i];
      const size = Math.abs(value), doubt = (ROOM * (Math.abs(slope) + 0.5 * bend * half) * half) / size;
      const { group, ofRadicand } = guards[k];
      if (ofRadicand && size > largest.get(group)) largest.set(group, size);
      if (!(doubt < 1)) return Infinity;
      if (doubt > most) most = doubt;
      /* where a group is open all over a cell, those behind it have no value there */
      if (ofRadicand && value < 0) break;
    }
    return most;
  }

  /* nodes of a range at which something may happen; null where nothing does */
  function nodesToSearch(range) {
    for (const { group, ofRadicand } of guards) if (ofRadicand) largest.set(group, 0);
    if (!guards.length) return null;
    if (data.counted.length) return allNodes.subarray(range.first, range.last + 1);
    range.cover ??= createCover(range);
    return range.cover();
  }

  const around = cellList();
  /* all guards at some nodes of the mesh: a row each of value, slope and bend */
  function guardsAt(nodes) {
    if (nodes.length === mesh.length) return run(cellsOnMesh(), allNodes);
    around.size = 0;
    for (let j = 0; j < nodes.length; j++) around.add(mesh[nodes[j]], halves[nodes[j]]);
    return cellsAt("nodes", around);
  }

  function guardCurve(k) {
    return (x) => { const o = evaluateAt("curves", x, k); return [o[3 * k], o[3 * k + 1], o[3 * k + 2]]; };
  }
  function guardBound(k, x) {
    const o = evaluateAt("bounds", x, k);
    return [o[2 * k], o[2 * k + 1]];
  }

  const parted = [cellList(), cellList()];

  /* places where a guard passes zero, and where it touches zero */
  function zerosOf(guard, nodes, o) {
    const count = nodes.length, { k, group } = guard;
    const value = o.subarray(3 * k * count, (3 * k + 1) * count);
    const slope = o.subarray((3 * k + 1) * count, (3 * k + 2) * count);
    const bend = o.subarray((3 * k + 2) * count, (3 * k + 3) * count);
    const none = { roots: [], touches: [] }, curve = guardCurve(k);
    const known = new Uint8Array(count);
    let allClear = true, greatest = guard.ofRadicand ? largest.get(group) : 0;
    for (let j = 0; j < count; j++) {
      const half = halves[nodes[j]];
      const clear = (Math.abs(slope[j]) + 0.5 * half * bend[j]) * half < Math.abs(value[j]);
      known[j] = clear || Math.abs(slope[j]) > bend[j] * half ? 1 : 0;
      allClear = allClear && clear;
      if (Math.abs(value[j]) < Infinity) greatest = Math.max(greatest, Math.abs(value[j]));
    }
    if (guard.ofRadicand) largest.set(group, greatest);
    if (allClear) return none;
    const at = new Map(nodes.length === mesh.length ? [] : Array.from(nodes, (node, j) => [node, j]));
    const indexOf = (node) => (nodes.length === mesh.length ? node : at.get(node));
    /* where groups before this one stop: nothing passes limits, and nodes beside stops foretell nothing */
    const stops = events
      .filter((e) => e.group < group && (e.kind === "limit" || !data.smooth) && mesh[0] <= e.drive && e.drive <= mesh[mesh.length - 1])
      .map((e) => ({ at: e.drive, node: nearestNode(e.drive), wall: e.kind === "limit" }));
    const rough = new Uint8Array(count);
    let anyRough = false;
    for (let j = 0; j < count; j++) rough[j] = Number.isFinite(value[j]) && !known[j] ? 1 : 0;
    for (const stop of stops) {
      const j = indexOf(stop.node);
      if (j !== undefined && !known[j]) rough[j] = 1;
    }
    const brackets = [], abut = (j) => nodes[j + 1] === nodes[j] + 1;
    for (let j = 0; j < count; j++) {
      anyRough = anyRough || rough[j] === 1;
      if (j + 1 < count && abut(j) && value[j] * value[j + 1] < 0 && !rough[j] && !rough[j + 1]) {
        if (Number.isFinite(value[j]) && Number.isFinite(value[j + 1])) brackets.push([mesh[nodes[j]], mesh[nodes[j + 1]]]);
      }
    }
    const solved = () => brackets.map(([low, high]) => root(curve, low, high));
    if (!anyRough) return { roots: solved(), touches: [] };
    const finest = FINEST * unit;

    /* the least size of a guard between two places, zero where that is rounding */
    const touching = (low, high, side) => {
      const x = root((y) => { const [, falls, turns] = curve(y); return [falls, turns]; }, low, high);
      const [least, bound] = guardBound(k, x), near = Math.abs(least) <= SAFETY * bound;
      return { at: x, node: nearestNode(x), least: near ? 0 : least, touches: near && (side > 0 || !signs.has(group)) };
    };
    const blind = new Set(stops.map((stop) => nodesBelow(stop.at) - 1));
    const minima = [];
    for (let j = 0; j + 1 < count; j++) {
      const side = sign(value[j]);
      if (!abut(j) || !(rough[j] || rough[j + 1]) || blind.has(nodes[j]) || side !== sign(value[j + 1])) continue;
      const left = side * value[j], right = side * value[j + 1], falls = side * slope[j], rises = side * slope[j + 1];
      if (!(falls < 0 && rises >= 0)) continue;
      const way = mesh[nodes[j + 1]] - mesh[nodes[j]], meeting = (right - left - rises * way) / (falls - rises);
      if (left + falls * meeting <= LOW * Math.min(left, right)) minima.push(touching(mesh[nodes[j]], mesh[nodes[j + 1]], side));
    }

    /* rough cells in parts that are known: shorter and shorter towards places where something happens */
    const pieces = [];
    const inside = new Map();
    for (const place of [...stops, ...minima]) {
      const j = indexOf(place.node);
      if (j !== undefined && rough[j] && Number.isFinite(place.at)) inside.set(j, [...(inside.get(j) ?? []), place.at]);
    }
    let [cells, finer] = parted;
    cells.size = 0;
    for (let j = 0; j < count; j++) {
      if (!rough[j]) continue;
      const centre = mesh[nodes[j]], half = halves[nodes[j]], places = inside.get(j);
      if (places === undefined) { cells.addParts(centre, half, PARTS); continue; }
      places.sort((a, b) => a - b);
      places.forEach((place, q) => {
        const low = q > 0 ? 0.5 * (places[q - 1] + place) : centre - half;
        const high = q + 1 < places.length ? 0.5 * (place + places[q + 1]) : centre + half;
        /* from the left to the right: shorter and shorter, then longer and longer */
        for (let h = -HALVINGS; h <= HALVINGS + 1; h++) {
          const way = (h > 0 ? high - place : low - place) * 2 ** -(h > 0 ? HALVINGS + 1 - h : HALVINGS + h), wide = 0.25 * Math.abs(way);
          if (wide > 0) cells.add(place + 0.75 * way, wide);
        }
      });
    }
    while (cells.size) {
      const { size, at, half } = cells, numbers = cellsAt("parts", cells, k), judged = new Uint8Array(size);
      let unknown = 0;
      for (let q = 0; q < size; q++) {
        const x = numbers[3 * k * size + q], falls = numbers[(3 * k + 1) * size + q], bent = numbers[(3 * k + 2) * size + q];
        if (!Number.isFinite(x)) continue;
        const sure = (Math.abs(falls) + 0.5 * half[q] * bent) * half[q] < Math.abs(x) || Math.abs(falls) > bent * half[q];
        judged[q] = sure ? KNOWN : Number.isFinite(falls) ? UNKNOWN : ENDING;
        if (!sure) unknown++;
      }
      const least = unit * (unknown <= MANY ? FINEST : unknown <= MOST ? COARSE : Infinity);
      finer.size = 0;
      for (let q = 0; q < size; q++) {
        if (judged[q] === NONE) continue;
        if (judged[q] !== UNKNOWN || half[q] <= least) {
          pieces.push({ centre: at[q], half: half[q], value: numbers[3 * k * size + q], known: judged[q] === KNOWN, node: -1 });
        } else finer.addParts(at[q], half[q], PARTS);
      }
      [cells, finer] = [finer, cells];
    }
    /* a sign within the rounding error of the formulas is none */
    let most = greatest;
    for (const piece of pieces) most = Math.max(most, Math.abs(piece.value));
    for (const piece of pieces) {
      if (piece.known && Math.abs(piece.value) > DOUBTFUL * most) continue;
      const [, bound] = guardBound(k, piece.centre);
      if (!(Math.abs(piece.value) > SAFETY * bound)) piece.value = 0;
    }
    for (let j = 0; j < count; j++) {
      const beside = (j > 0 && abut(j - 1) && rough[j - 1]) || (j + 1 < count && abut(j) && rough[j + 1]);
      if (beside && !rough[j] && Number.isFinite(value[j])) {
        pieces.push({ centre: mesh[nodes[j]], half: halves[nodes[j]], value: value[j], known: true, node: nodes[j] });
      }
    }
    for (const place of minima) {
      if (Number.isFinite(place.least)) pieces.push({ centre: place.at, half: finest, value: place.least, known: false, node: -1 });
    }
    for (const stop of stops) {
      if (stop.wall) pieces.push({ centre: stop.at, half: finest, value: Infinity, known: false, node: -1 });
    }
    pieces.sort((a, b) => a.centre - b.centre);

    /* pairs of neighbours with a sign, between which only cells without one lie, and nothing that parts them */
    const others = [];
    let before = -1, whole = true;
    for (let q = 0; q < pieces.length; q++) {
      const piece = pieces[q];
      if (q > 0) {
        const apart = piece.centre - pieces[q - 1].centre - piece.half - pieces[q - 1].half;
        if (apart > SLACK * finest || piece.value === Infinity || pieces[q - 1].value === Infinity) whole = false;
      }
      if (!Number.isFinite(piece.value) || piece.value === 0) continue;
      if (before >= 0 && whole) {
        const one = pieces[before], side = sign(one.value), next = q === before + 1;
        if (side !== sign(piece.value)) {
          if (!(next && one.node >= 0 && piece.node >= 0)) brackets.push([one.centre, piece.centre]);
        } else if (!next || !(one.known && piece.known)) {
          const foretold = minima.some((place) => place.at > one.centre && place.at < piece.centre);
          if (!foretold && side * curve(one.centre)[1] < 0 && side * curve(piece.centre)[1] >= 0) {
            others.push(touching(one.centre, piece.centre, side));
          }
        }
      }
      before = q;
      whole = true;
    }
    return { roots: solved(), touches: [...minima, ...others].filter((place) => place.touches).map((place) => place.at) };
  }

  /* angles that gears and wheels depend on, counted along the mesh outwards from the initial position */
  function countAngles() {
    data.counted.forEach(([key, start], c) => {
      const o = onMesh("counted"), raw = o.slice(c * mesh.length, (c + 1) * mesh.length), angle = unwound.get(key);
      fillGaps(raw);
      angle[startNode] = raw[startNode] + TURN * roundHalfToEven((start - raw[startNode]) / TURN);
      for (let j = startNode + 1; j < mesh.length; j++) angle[j] = raw[j] + TURN * roundHalfToEven((angle[j - 1] - raw[j]) / TURN);
      for (let j = startNode - 1; j >= 0; j--) angle[j] = raw[j] + TURN * roundHalfToEven((angle[j + 1] - raw[j]) / TURN);
    });
  }

  /* gaps filled by the last known value on the way from the start; both rows of directions together */
  function fillGaps(row, other = row) {
    const size = row.length;
    let known = 0, whole = true;
    for (let j = 0; j < size; j++) if (!(Number.isFinite(row[j]) && Number.isFinite(other[j]))) { whole = false; break; }
    if (whole) return;
    while (known < size && !(Number.isFinite(row[known]) && Number.isFinite(other[known]))) known++;
    const [first, beside] = known < size ? [row[known], other[known]] : [0, 0];
    for (const from of [1, -1]) {
      let last = first, lastBeside = beside;
      for (let j = startNode; j >= 0 && j < size; j += from) {
        if (Number.isFinite(row[j]) && Number.isFinite(other[j])) { last = row[j]; lastBeside = other[j]; continue; }
        row[j] = last;
        other[j] = lastBeside;
      }
    }
  }

  /* Beyond the motion only the polynomials beside change points are of interest, which end where something happens. */
  let changesBefore = false;
  function findEvents() {
    search(changesBefore ? everything : ofMotion);
    const changes = data.smooth && events.some((event) => event.kind === "change point");
    if (changes && !changesBefore) search(everything);
    changesBefore = changes;
  }

  function search(range) {
    crossings = new Map();
    events = [];
    if (data.counted.length) countAngles();
    const nodes = nodesToSearch(range);
    if (nodes === null) return;
    let o = guardsAt(nodes), stale = false;
    for (const guard of guards) {
      /* a change point of a group changes the sign on which the groups behind it stand */
      if (stale) { if (data.counted.length) countAngles(); o = guardsAt(nodes); stale = false; }
      const { roots, touches } = zerosOf(guard, nodes, o), { group } = guard;
      for (const at of roots) events.push({ kind: "limit", group, drive: at, closesAbove: guardCurve(guard.k)(at)[1] > 0 });
      for (const at of touches) {
        if (!guard.ofRadicand) { events.push({ kind: "limit", group, drive: at, closesAbove: guardCurve(guard.k)(at)[1] > 0 }); continue; }
        events.push({ kind: "change point", group, drive: at });
        const margin = AT_THE_START * unit, behind = Math.abs(at - initial) <= margin ? initial - forward * margin : at;
        crossings.set(group, [...(crossings.get(group) ?? []), behind]);
        stale = data.smooth;
      }
    }
    events.sort((a, b) => a.drive - b.drive);
  }

  /* the nearest limits on both sides of the initial position */
  function findReach(reach) {
    reach[0] = -Infinity;
    reach[1] = Infinity;
    for (const event of events) {
      if (event.kind !== "limit") continue;
      const atStart = Math.abs(event.drive - initial) <= AT_THE_START * unit;
      const below = atStart ? event.closesAbove : event.drive <= initial;
      if (below) reach[0] = Math.max(reach[0], event.drive); else reach[1] = Math.min(reach[1], event.drive);
    }
  }

  /* ---- the samples ---- */

  const rows = data.rows.map((_row, k) => atSamples.row(k));
  const residual = atSamples.row(rows.length);
  const radicands = data.radicands.map((group, k) => {
    return { group, row: atSamples.row(rows.length + 1 + k), guard: guards.findIndex((g) => g.ofRadicand && g.group === group) };
  });
  const signRows = new Map(atSamples.moving.filter((each) => each.word === "sign").map((each) => [each.of, each.row]));
  const turnRows = new Map(atSamples.moving.filter((each) => each.word === "turns").map((each) => [each.of, each.row]));
  /* what loads depend on in reactions, and not in the motion, is counted as well */
  for (const name of printed.reactions?.moving ?? []) {
    const of = name.slice("turns ".length);
    if (name.startsWith("turns ") && !turnRows.has(of)) turnRows.set(of, new Float64Array(n));
  }
  const status = new Uint8Array(n), misfit = new Float64Array(n);

  const nested = (places) => (Array.isArray(places) ? places.map(nested) : rows[places]);
  const quantities = Object.fromEntries(data.quantities.map((each) => [each.name, nested(each.rows)]));
  const only = (name) => quantities[name] ?? null;
  const reach = [-Infinity, Infinity];
  const frame = {
    samples: n, drive, time: given.time,
    position: only("position"), velocity: only("velocity"), acceleration: only("acceleration"),
    velocityByDrive: only("velocity_coefficient"), accelerationByDrive: only("acceleration_coefficient"),
    angle: only("angle") ?? only("joint_angle"), jointAngle: only("joint_angle"),
    rate: only("angular_velocity"), angularAcceleration: only("angular_acceleration"),
    rateByDrive: only("angular_velocity_coefficient"), angularAccelerationByDrive: only("angular_acceleration_coefficient"),
    quantities, status, residual, misfit, residualBound: data.residual_bound, reach,
    events: [], possible: true, signsChange: false, outputs: {},
  };

  function isPossible(values) {
    return values.length === parameters.length
      && parameters.every((each, k) => Number.isFinite(values[k]) && (!each.positive || values[k] > 0));
  }

  /* whether a sample lies so near a change point of a group that its radicand says nothing */
  function besideChange(group, x) {
    const places = crossings.get(group);
    return data.smooth && places !== undefined && places.some((at) => Math.abs(x - at) < WINDOW * unit);
  }

  /* statuses by the radicands; whether a root of rounding has to be taken as zero */
  function judgeRadicands() {
    let again = false;
    for (const { group, row, guard } of radicands) {
      const little = SUSPECT * (largest.get(group) ?? 0), signRow = signRows.get(group);
      for (let i = 0; i < n; i++) {
        const value = row[i];
        if (value > little || value !== value) continue;
        const mended = besideChange(group, drive[i]);
        if (Math.abs(value) <= little && guard >= 0) {
          const [, bound] = guardBound(guard, drive[i]);
          if (Math.abs(value) <= SAFETY * bound) {
            if (signRow !== undefined && signRow[i] !== 0) { signRow[i] = 0; again = true; }
            if (!mended && status[i] !== OPEN) status[i] = SINGULAR;
            continue;
          }
        }
        if (value < 0 && !mended) status[i] = OPEN;
      }
    }
    return again;
  }

  /* Beside a change point closed forms lose their digits, though the motion runs on smoothly: there it is the polynomial
   * through places on both sides. */
  const nodesAround = Float64Array.from({ length: AROUND }, (_x, q) => Math.cos((Math.PI * (2 * q + 1)) / (2 * AROUND)));
  const weights = Float64Array.from(nodesAround, (_x, q) => (q % 2 ? -1 : 1) * Math.sin((Math.PI * (2 * q + 1)) / (2 * AROUND)));

  function mend() {
    for (const change of events) {
      if (change.kind !== "change point" || !data.smooth) continue;
      const others = events.map((e) => Math.abs(e.drive - change.drive)).filter((apart) => apart > BESIDE * unit);
      const reach = Math.min(CIRCLE * unit, 0.5 * Math.min(...others));
      if (reach < 2 * BESIDE * unit) continue;
      for (let i = 0; i < n; i++) {
        if (Math.abs(drive[i] - change.drive) < BESIDE * unit && status[i] === OK) mendSample(i, change.drive, reach);
      }
    }
  }

  function mendSample(i, centre, reach) {
    const around = Object.fromEntries(Object.entries(given).map(([name, row]) => [name, new Float64Array(AROUND).fill(row[i])]));
    around.parameter = nodesAround.map((x) => centre + reach * x);
    const places = preparePlaces(printed.motion, around, AROUND), turning = new Set(data.angles.map(([, place]) => place));
    run(places);
    const x = (drive[i] - centre) / reach;
    const smooth = rows.map((_row, k) => {
      const around = places.row(k);
      let above = 0, below = 0;
      for (let q = 0; q < AROUND; q++) {
        let value = around[q];
        /* angles without turns may jump between two of the places */
        if (turning.has(k)) value -= TURN * Math.round((value - around[0]) / TURN);
        const share = weights[q] / (x - nodesAround[q]);
        above += share * value;
        below += share;
      }
      const value = above / below;
      return turning.has(k) ? value - TURN * Math.round(value / TURN) : value;
    });
    if (!smooth.every(Number.isFinite)) return;
    smooth.forEach((value, k) => { rows[k][i] = value; });
    /* what the formulas say in a place without digits is no residual of the motion: that of the places around is */
    residual[i] = places.row(rows.length).reduce((a, b) => Math.max(a, b));
  }

  /* `computed`: whether the rows of the samples are those of these numbers already */
  function judgeSamples(computed) {
    status.fill(OK);
    if (!computed) atSamples.f.run(v, atSamples.p, n, atSamples.o);
    /* without a sign the root is zero exactly: statuses of groups behind are judged with it */
    for (let k = 0; k <= radicands.length && judgeRadicands(); k++) {
      atSamples.f.run(v, atSamples.p, n, atSamples.o);
      status.fill(OK);
      if (k === radicands.length) judgeRadicands();
    }
    mend();
    const bound = data.residual_bound;
    let closes = true;
    for (let i = 0; i < n; i++) closes = closes && residual[i] <= bound;
    if (events.length || !closes) {
      for (const row of rows) for (let i = 0; i < n; i++) if (!Number.isFinite(row[i]) && status[i] === OK) status[i] = SINGULAR;
    }
    if (reach[0] > -Infinity || reach[1] < Infinity) {
      for (let i = 0; i < n; i++) {
        if (status[i] !== OPEN && (drive[i] < reach[0] - margins[i] || drive[i] > reach[1] + margins[i])) status[i] = CUT_OFF;
      }
    }
    for (const i of data.impossible) status[i] = OPEN;
    if (closes) return;
    for (let i = 0; i < n; i++) {
      if (status[i] === OPEN || !(residual[i] > bound)) continue;
      status[i] = OPEN;
      misfit[i] = residual[i];
    }
  }

  /* absence is NaN: nothing stands in open samples, and no derivatives in singular ones */
  const open = new Int32Array(n), partly = new Int32Array(n);
  function settle() {
    let ofOpen = 0, ofPartly = 0;
    for (let i = 0; i < n; i++) if (status[i] === OPEN) open[ofOpen++] = i; else if (status[i] !== OK) partly[ofPartly++] = i;
    for (let q = 0; q < ofOpen; q++) residual[open[q]] = NaN;
    if (ofOpen || ofPartly) for (let k = 0; k < rows.length; k++) {
      const row = rows[k], [derivative, ofFrame] = data.rows[k];
      for (let q = 0; q < ofOpen; q++) row[open[q]] = NaN;
      if (ofFrame) continue;
      for (let q = 0; q < ofPartly; q++) {
        const i = partly[q];
        if (!Number.isFinite(row[i]) || (derivative && status[i] === SINGULAR)) row[i] = NaN;
      }
    }
  }

  /* angles with their turns: from sample to sample where these lie close, else along the mesh */
  let turnsChanged = false;   // by the last call, of what rows are computed from
  function unwind() {
    turnsChanged = false;
    const whole = Math.abs(drive[startSample] - initial) <= 0.05 * unit && status.every((each) => each === OK);
    for (const [link, place, start] of data.angles) {
      const row = rows[place], turns = turnRows.get(link), raw = turns === undefined ? row : row.slice();
      if (!(whole && unwindBySamples(row, start))) unwindByMesh(link, row, start);
      if (turns === undefined) continue;
      for (let i = 0; i < n; i++) {
        const whole = row[i] === row[i] ? Math.round((row[i] - raw[i]) / TURN) : 0;
        if (whole !== turns[i]) { turns[i] = whole; turnsChanged = true; }
      }
    }
  }

  function unwindBySamples(row, start) {
    let jumps = false;
    for (let i = 1; i < n; i++) {
      const change = row[i] - row[i - 1];
      if (Math.abs(change) < MOST_TURN) continue;
      if (!(Math.abs(change - TURN * Math.round(change / TURN)) < MOST_TURN)) return false;
      jumps = true;
    }
    const first = row[startSample], shift = TURN * roundHalfToEven((start - first) / TURN), moves = shift !== 0;
    if (!jumps && !moves) return true;
    for (const from of [1, -1]) {
      let before = first, turns = 0;
      for (let i = startSample + from; i >= 0 && i < n; i += from) {
        const raw = row[i], change = raw - before;
        if (change > Math.PI) turns -= 1; else if (change < -Math.PI) turns += 1;
        before = raw;
        if (turns !== 0 || moves) row[i] = raw + (shift + TURN * turns);
      }
    }
    if (moves) row[startSample] = first + shift;
    return true;
  }

  let rotorsOnMesh = null;   // of these numbers, once they are needed
  const turnsOnMesh = new Int32Array(mesh.length);
  function unwindByMesh(link, row, start) {
    const which = data.angles.findIndex(([name]) => name === link), size = mesh.length, turns = turnsOnMesh;
    rotorsOnMesh ??= onMesh("rotors");
    const cosine = rotorsOnMesh.subarray(2 * which * size, (2 * which + 1) * size);
    const sine = rotorsOnMesh.subarray((2 * which + 1) * size, (2 * which + 2) * size);
    fillGaps(cosine, sine);
    /* rotors of hinges are longer or shorter than 1 */
    if (data.space === "sphere") for (let j = 0; j < size; j++) {
      const length = Math.sqrt(cosine[j] * cosine[j] + sine[j] * sine[j]);
      if (length > 0) { cosine[j] /= length; sine[j] /= length; }
    }
    for (let j = 1; j < size; j++) turns[j] = turns[j - 1] + turnChange(cosine[j - 1], sine[j - 1], cosine[j], sine[j]);
    const shift = roundHalfToEven((start - Math.atan2(sine[startNode], cosine[startNode])) / TURN) - turns[startNode];
    for (let i = 0; i < n; i++) {
      const node = nearSamples[i], angle = row[i];
      const whole = turns[node] + shift + turnChange(cosine[node], sine[node], Math.cos(angle), angle);
      if (whole !== 0) row[i] = angle + TURN * whole;
    }
  }

  /* change of the number of turns from one direction to the next: 1 past half a turn, -1 back */
  function turnChange(cosine, sine, nextCosine, nextSine) {
    const below = (x) => (x < 0 || Object.is(x, -0) ? 1 : 0);
    return cosine + nextCosine < 0 ? below(nextSine) - below(sine) : 0;
  }

  function recompute(values) {
    frame.possible = isPossible(values);
    frame.signsChange = false;
    frame.events = events = [];
    misfit.fill(NaN);
    forcesKnown = false;
    reach[0] = -Infinity;
    reach[1] = Infinity;
    if (!frame.possible) {
      for (const row of rows) row.fill(NaN);
      residual.fill(NaN);
      status.fill(OPEN);
      return frame;
    }
    printed.numbers(values, v);
    rotorsOnMesh = null;
    findEvents();
    findReach(reach);
    fillMoving(atSamples, nearSamples);
    if (data.turns_matter) {
      /* residuals of what gears turn and some loads depend on the turns of angles, so these come first */
      status.fill(OK);
      atSamples.f.run(v, atSamples.p, n, atSamples.o);
      const bare = data.angles.map(([, place]) => rows[place].slice());
      unwind();
      data.angles.forEach(([, place], k) => rows[place].set(bare[k]));
    }
    judgeSamples(data.turns_matter && !turnsChanged);
    settle();
    unwind();
    const low = leastDrive - 1e-9 * unit, high = mostDrive + 1e-9 * unit;
    frame.events = events.filter((event) => low <= event.drive && event.drive <= high);
    frame.signsChange = data.smooth && frame.events.some((event) => event.kind === "change point");
    return frame;
  }

  /* ---- reactions: most frames are never asked for theirs ---- */

  let forces = null, forcesKnown = false;
  const reactionNames = {};

  function reactions() {
    if (printed.reactions === undefined || forcesKnown) return reactionNames;
    if (forces === null) {
      forces = preparePlaces(printed.reactions, given, n);
      const named = (places) => (Array.isArray(places) ? places.map(named) : forces.row(places));
      for (const each of data.reactions) reactionNames[each.name] = named(each.rows);
    }
    forcesKnown = true;
    if (frame.possible) computeReactions(); else forces.o.fill(NaN);
    return reactionNames;
  }

  function computeReactions() {
    const { f, p, o, moving } = forces, numbers = f.count - 1, stride = o.length / f.count;
    fillMoving(forces, nearSamples);
    for (const { word, of, row } of moving) {
      const known = word === "sign" ? signRows.get(of) : word === "turns" ? turnRows.get(of) : undefined;
      if (known !== undefined) row.set(known);
    }
    f.run(v, p, n, o);
    for (let i = 0; i < n; i++) {
      /* where the motion is mended by places around, forces are not: they may pass all bounds there */
      const reached = (status[i] === OK || status[i] === CUT_OFF) && !besideAnyChange(drive[i]);
      if (reached && o[numbers * stride + i] < data.largest_gain) continue;
      for (let k = 0; k < numbers; k++) o[k * stride + i] = NaN;
    }
  }

  function besideAnyChange(x) {
    return data.smooth && events.some((e) => e.kind === "change point" && Math.abs(x - e.drive) < BESIDE * unit);
  }

  /* Instant centre of a link of the plane at every sample of the last frame: where it is (the fixed centrode), and where
   * in the link, from its first point along its axes (the moving centrode); NaN where the link does not turn. */
  const held = new Map();
  function centre(link) {
    if (data.space !== "plane") return null;
    if (!held.has(link)) held.set(link, { fixed: [new Float64Array(n), new Float64Array(n)], moving: [new Float64Array(n), new Float64Array(n)] });
    const { fixed, moving } = held.get(link);
    const point = data.points.indexOf(data.link_points[data.links[link]][0]);
    const [x, y] = frame.position[point], [u, w] = (frame.velocityByDrive ?? frame.velocity)[point];
    const turn = (frame.rateByDrive ?? frame.rate)[link], angle = frame.angle[link];
    for (let i = 0; i < n; i++) {
      const there = turn[i] !== 0 && status[i] !== OPEN;
      const dx = there ? -w[i] / turn[i] : NaN, dy = there ? u[i] / turn[i] : NaN;
      const c = Math.cos(angle[i]), s = Math.sin(angle[i]);
      fixed[0][i] = x[i] + dx;
      fixed[1][i] = y[i] + dy;
      moving[0][i] = c * dx + s * dy;
      moving[1][i] = c * dy - s * dx;
    }
    return { fixed, moving };
  }

  return { data, parameters, recompute, reactions, centre, names: { points: data.points, links: data.links, joints: data.joints, guides: data.guides } };
}

return createMechanism;
})();
