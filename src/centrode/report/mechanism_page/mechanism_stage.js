// The report's player over a motion that is computed on the page: other dimensions, signs that can be shown and hidden.
const GHOSTS = 12;
const REACHED = 0.18; // the longest vector, of the extent
const FAR = 12; // extents from the middle: centrodes that go on to infinity are drawn as far

class MechanismStage extends Stage {
  constructor(holder, data) {
    super(holder, data);
    this.renew();
  }

  build() {
    const { model } = this.data;
    this.model = model;
    this.on = { loop: true };
    this.refit();
    this.measure();
    this.data.shapes = this.shapesNow();
    super.build();
    this.svg.setAttribute("role", "group");
    this.renewGrounds();
    this.ghosts = make("g", { class: "ghosts" });
    this.svg.insertBefore(this.ghosts, this.paths);
    this.centrodes = make("g", { class: "centrodes" });
    this.svg.insertBefore(this.centrodes, this.paths);
    this.arrows = make("g", { class: "arrows" });
    this.centres = make("g", { class: "centres" });
    this.svg.insertBefore(this.arrows, this.names);
    this.svg.insertBefore(this.centres, this.names);
    this.velocities = this.points.map(() => this.arrow("velocity"));
    this.accelerations = this.points.map(() => this.arrow("acceleration"));
    this.sides = model.data.program.sides.map(([point, body]) => ({ point: model.data.program.points.indexOf(point), body }));
    this.reactions = this.sides.map(() => this.arrow("reaction"));
    this.crosses = this.bodies.map((body) => this.centre(body));
    this.renewVectors();
    this.handles = new Handles(this, model, this.data.tell);
    for (const group of [this.ghosts, this.centrodes, this.centres]) group.setAttribute("display", "none");
    model.watchers.push(() => this.renew());
  }

  arrow(kind) {
    const group = make("g", { class: `arrow ${kind}` }, this.arrows);
    return { group, shaft: make("path", {}, group), head: make("path", { class: "head", d: "M0 0L-95 34L-95 -34Z" }, group) };
  }

  centre(body) {
    const group = make("g", { class: "centre" }, this.centres);
    make("path", { d: "M-60 -60L60 60M-60 60L60 -60", stroke: body.colour }, group);
    // a link that is hinged to the frame turns about its hinge, which has its own name
    if (body.points.some((point) => point < this.model.data.program.fixed)) return group;
    const name = make("text", { x: 90, y: 190 }, group); // joints have theirs above
    name.textContent = body.name;
    return group;
  }

  // --- control -----------------------------------------------------------------------------------------------------
  control() {
    super.control();
    for (const box of this.holder.querySelectorAll("[data-show]")) {
      box.addEventListener("change", () => this.toggle(box.dataset.show, box.checked));
      this.toggle(box.dataset.show, box.checked);
    }
    this.body = this.holder.querySelector('[data-do="body"]');
    const ways = { left: [-1, 0], right: [1, 0], up: [0, 1], down: [0, -1] };
    for (const button of this.holder.querySelectorAll("[data-turn]")) {
      const [right, up] = ways[button.dataset.turn];
      button.addEventListener("click", () => {
        this.space.turn(0.15 * right * this.data.radius, 0.15 * up * this.data.radius);
        this.show();
      });
    }
    if (this.body) this.body.addEventListener("change", () => {
      this.renewCentrodes();
      this.show();
    });
  }

  toggle(name, on) {
    this.on[name] = on;
    const groups = { ghosts: this.ghosts, "instant-centres": this.centres, "rolling-centrodes": this.centrodes, handles: this.handles.group };
    if (groups[name]) this.switch(groups[name], on);
    if (name === "ghosts") this.renewGhosts();
    if (name === "rolling-centrodes") this.renewCentrodes();
    if (name === "velocities" || name === "accelerations" || name === "reactions") this.renewVectors();
    this.show();
  }

  // --- other dimensions --------------------------------------------------------------------------------------------
  // The view holds the whole motion; a motion that is changed keeps it until the hand lets go.
  refit() {
    const { model, data } = this, wide = data.wide;
    if (model.data.program.space === "sphere") {
      const high = Math.min(0.8 * wide, this.tallest), radius = Math.round(0.44 * high);
      data.size = [wide, high];
      data.centre = [wide / 2, high / 2];
      data.radius = radius;
      Object.assign(this.space, { centre: data.centre, radius });
      return;
    }
    const [low, high] = this.extent();
    const sides = minus(high, low), room = 0.12 * Math.max(...sides, TINY);
    const share = within((sides[1] + 2 * room) / (sides[0] + 2 * room), 0.5, 0.85);
    data.size = [wide, Math.round(Math.min(wide * share, this.tallest))];
    this.sheet = new Paper(minus(low, [room, room]), plus(high, [room, room]), data.size);
    this.box = [low, high];
  }

  // What leaves room for the controls on the screen, in units of the picture.
  get tallest() {
    const units = this.data.wide / Math.max(this.holder.clientWidth, 1);
    return Math.max(0.55 * this.data.wide, units * (innerHeight - 330));
  }

  extent() {
    const { model } = this, low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    const take = (axis, least, most) => {
      low[axis] = Math.min(low[axis], least);
      high[axis] = Math.max(high[axis], most);
    };
    const { frame } = model;
    this.points.filter((point) => point.fixed).forEach((point, number) => this.model.at(number, 0).forEach((value, axis) => take(axis, value, value)));
    frame.position.forEach((axes) => axes.forEach((numbers, axis) => {
      for (const value of numbers) if (Number.isFinite(value)) take(axis, value, value);
    }));
    for (const wheel of model.data.drawing.wheels) {
      const radius = model.value(wheel.radiusPath, wheel.radius);
      [0, 1].forEach((axis) => {
        const [least, most] = span([...frame.position[wheel.centre][axis]].filter(Number.isFinite));
        take(axis, least - radius, most + radius);
      });
      if (wheel.track && wheel.on === null) [0, 1].forEach((axis) =>
        take(axis, wheel.track.centre[axis] - wheel.track.radius, wheel.track.centre[axis] + wheel.track.radius));
    }
    for (const cam of model.data.drawing.cams) {
      const { axis, fits } = camNow(model, cam), reach = Math.max(...cam.outline.map((corner) => Math.hypot(...corner)));
      if (fits) axis.forEach((value, k) => take(k, value - reach, value + reach));
    }
    for (const axis of [0, 1]) if (!(low[axis] <= high[axis])) [low[axis], high[axis]] = [-1, 1];
    // a motion that is not reached anywhere leaves its fixed hinges, which are no size
    if (!(Math.max(...minus(high, low)) > 0)) return [minus(low, [1, 1]), plus(high, [1, 1])];
    return [low, high];
  }

  // Once the hand has let go: a motion that has left its paper, or is lost on it, gets another.
  settle() {
    this.model.show();
    if (!this.sheet || !this.model.frame.possible) return;
    const [low, high] = this.extent(), size = Math.max(...minus(high, low));
    const corner = this.sheet.place([low[0], high[1]]), end = this.sheet.place([high[0], low[1]]);
    const outside = corner[0] < 0 || corner[1] < 0 || end[0] > this.data.size[0] || end[1] > this.data.size[1];
    if (outside || size * this.sheet.scale < 0.45 * Math.min(...this.data.size)) this.fit();
  }

  fit() {
    this.refit();
    this.svg.setAttribute("viewBox", `0 0 ${this.data.size[0]} ${this.data.size[1]}`);
    const globe = this.svg.querySelector(".globe");
    if (globe) {
      globe.setAttribute("cx", this.data.centre[0]);
      globe.setAttribute("cy", this.data.centre[1]);
      globe.setAttribute("r", this.data.radius);
    }
    this.renew();
  }

  widen(pixels) {
    const wide = Math.round(within(10 * pixels, 3600, 9000));
    if (Math.abs(wide - this.data.wide) < 40) return;
    this.data.wide = wide;
    this.fit();
  }

  rows(point) {
    const { model } = this, found = [];
    const samples = point < model.data.program.fixed ? 1 : model.frame.samples;
    for (let sample = 0; sample < samples; sample += 1) {
      const at = model.at(point, sample);
      if (!at) found.push(...(this.sheet ? [null, null] : [null, null, null]));
      else if (this.sheet) found.push(...this.sheet.place(at));
      else found.push(...at);
    }
    return found;
  }

  shapesNow() {
    return this.sheet ? shapesOf(this.model, this.sheet) : [];
  }

  measure() {
    const { model } = this;
    this.last = model.last;
    this.place = within(this.place, 0, this.last);
    this.points.forEach((point, number) => { point.series = new Series(this.rows(number), this.data.axes); });
    this.reach = model.piece();
    this.whole = this.reach[0] === 0 && this.reach[1] === this.last && this.closed();
    this.data.loop = this.whole;
  }

  renew() {
    const { model } = this;
    this.measure();
    this.slider.max = String(this.last);
    this.shapesNow().forEach(({ d, at }, k) => {
      this.shapes[k].made.setAttribute("d", d);
      this.shapes[k].series = new Series(at, 3);
    });
    model.data.drawing.rings.forEach((ring, k) => Object.assign(this.rings[k], ringOf(model, ring)));
    this.renewGrounds();
    this.tracked = false;
    this.renewVectors();
    this.renewGhosts();
    this.renewCentrodes();
    this.show();
  }

  renewGrounds() {
    if (!this.sheet) return;
    const { model } = this, guides = model.data.drawing.guides.filter((guide) => guide.on === null);
    this.grounds.replaceChildren();
    for (const guide of guides) {
      const ends = travel(model, this.sheet, guide);
      if (ends) make("path", { class: "ground", d: groundOf(this.sheet, ends) }, this.grounds);
      const sign = this.signs && this.signs[guide.point].querySelector(".slider");
      if (sign) sign.setAttribute("transform", `rotate(${-degrees(model.value(guide.directionPath, guide.direction))})`);
    }
  }

  closed() {
    const { position } = this.model.frame, last = this.last;
    if (last < 2) return false;
    let apart = 0, size = 0;
    for (const axes of position) for (const numbers of axes) {
      apart = Math.max(apart, Math.abs(numbers[last] - numbers[0]));
      size = Math.max(size, Math.abs(numbers[0]));
    }
    return apart <= 1e-6 * Math.max(size, 1e-300);
  }

  // --- what is shown -----------------------------------------------------------------------------------------------
  show() {
    if (!this.handles) return; // while it is built
    super.show();
    const now = this.points.map((point) => point.series.at(this.place));
    const flat = now.map((place) => place && this.space.flat(place));
    this.showVectors(flat, now);
    if (this.on["instant-centres"]) this.showCentres();
    if (this.on["rolling-centrodes"]) this.showCentrodes();
    if (this.on.ghosts && this.data.view) this.renewGhosts();
    this.handles.show(flat, now);
    this.data.moved();
  }

  tell() {
    const { model } = this, sample = within(Math.round(this.place), 0, this.last), status = model.status(sample);
    const word = model.reached(sample) && !status ? "" : ` · ${model.words.statuses[status]}`;
    const said = model.place(sample) + word;
    this.output.textContent = said;
    this.output.classList.toggle("bad", Boolean(word));
    this.slider.value = String(this.place);
    this.slider.setAttribute("aria-valuetext", said);
    this.holder.dataset.place = this.place.toFixed(3);
  }

  renewVectors() {
    const { frame } = this.model, fixed = this.model.data.program.fixed;
    const scale = (courses, first = fixed) => {
      let most = 0;
      courses.forEach((axes, point) => {
        if (point < first) return;
        for (let k = 0; k <= this.last; k += 1) {
          const size = Math.hypot(...axes.map((numbers) => numbers[k]));
          if (size > most) most = size;
        }
      });
      return most ? (REACHED * Math.min(...this.data.size)) / most : 0;
    };
    const moves = (point) => point >= fixed, own = (point) => point;
    this.vectors = [
      { name: "velocities", arrows: this.velocities, courses: frame.velocity, at: own, shown: moves,
        scale: this.on.velocities ? scale(frame.velocity) : 0 },
      { name: "accelerations", arrows: this.accelerations, courses: frame.acceleration, at: own, shown: moves,
        scale: this.on.accelerations ? scale(frame.acceleration) : 0 },
    ];
    if (!this.reactions.length) return;
    const forces = this.on.reactions ? this.model.engine.reactions().joint_force : [];
    this.vectors.push({ name: "reactions", arrows: this.reactions, courses: forces, at: (side) => this.sides[side].point,
      shown: (side) => this.body && this.sides[side].body === this.body.value, scale: scale(forces, 0) });
  }

  mixed(numbers) {
    const low = Math.floor(this.place), share = this.place - low;
    return share && low < this.last ? numbers[low] + share * (numbers[low + 1] - numbers[low]) : numbers[low];
  }

  showVectors(flat, now) {
    for (const { name, arrows, courses, at, shown, scale } of this.vectors) {
      arrows.forEach(({ group, shaft, head }, k) => {
        const point = at(k), found = this.on[name] && flat[point] && shown(k)
          ? courses[k].map((numbers) => this.mixed(numbers)) : [NaN];
        const seen = found.every(Number.isFinite) && scale && this.space.front(now[point]);
        const way = seen ? this.towards(found, scale) : [0, 0], size = Math.hypot(...way);
        group.setAttribute("display", seen && size > 20 ? "inline" : "none");
        if (!seen || size <= 20) return;
        const tip = plus(flat[point], way);
        shaft.setAttribute("d", drawn([flat[point], plus(flat[point], way, Math.max(0, 1 - 80 / size))]));
        head.setAttribute("transform", `translate(${text(tip[0])} ${text(tip[1])}) rotate(${degrees(Math.atan2(way[1], way[0])).toFixed(2)})`);
      });
    }
  }

  // A vector of the motion in the picture.
  towards(vector, scale) {
    if (this.sheet) return [vector[0] * scale, -vector[1] * scale];
    return [dot(vector, this.space.view[0]) * scale, -dot(vector, this.space.view[1]) * scale];
  }

  // Where a link has no velocity against the frame: in SI, on the sphere a unit vector.
  centreOf(body, sample) {
    const { frame } = this.model;
    const moving = body.points.filter((point) => this.model.at(point, sample));
    if (this.sheet) {
      const turn = frame.rate[body.link][sample], point = moving[0];
      if (point === undefined || !(Math.abs(turn) > 1e-9 * greatestOf(frame.rate[body.link]))) return null;
      const [x, y] = this.model.at(point, sample), [vx, vy] = frame.velocity[point].map((numbers) => numbers[sample]);
      return [x - vy / turn, y + vx / turn];
    }
    const axis = frame.rate[body.link].map((numbers) => numbers[sample]), size = Math.hypot(...axis);
    return size > 1e-9 ? axis.map((value) => value / size) : null;
  }

  showCentres() {
    const sample = within(Math.round(this.place), 0, this.last);
    this.bodies.forEach((body, k) => {
      let at = this.model.reached(sample) && body.link !== undefined ? this.centreOf(body, sample) : null;
      if (at && !this.sheet && !this.space.front(at)) at = at.map((value) => -value);
      const flat = at && (this.sheet ? this.sheet.place(at) : this.space.flat(at));
      const seen = flat && flat.every((value, axis) => value > 0 && value < this.data.size[axis]);
      this.crosses[k].setAttribute("display", seen ? "inline" : "none");
      if (seen) this.crosses[k].setAttribute("transform", `translate(${text(flat[0])} ${text(flat[1])})`);
    });
  }

  renewGhosts() {
    if (!this.ghosts || !this.on.ghosts) return;
    this.ghosts.replaceChildren();
    const [low, high] = this.reach;
    for (let k = 0; k < GHOSTS; k += 1) {
      const sample = Math.round(low + ((high - low) * k) / (this.whole ? GHOSTS : GHOSTS - 1));
      for (const body of this.bodies) {
        const known = body.points.map((point) => this.of(point, sample)).filter(Boolean);
        const around = known.length > 2 ? [...known, known[0]] : known, places = [];
        for (let j = 1; j < around.length; j += 1) places.push(...this.space.line(around[j - 1], around[j]).slice(j > 1 ? 1 : 0));
        make("path", { class: "ghost", stroke: body.colour, d: this.space.paths(places)[0] }, this.ghosts);
      }
    }
  }

  // The fixed centrode of one link, and its moving one as the link carries it.
  renewCentrodes() {
    if (!this.centrodes || !this.on["rolling-centrodes"]) return;
    const chosen = this.bodies.find((body) => body.name === this.body?.value) ?? this.bodies[0];
    const axes = this.sheet && new Axes(this.model, this.sheet, chosen.link), reach = FAR * (this.sheet ? Math.max(...minus(this.box[1], this.box[0])) : 1);
    const fixed = [], moving = [];
    let sign = null;
    for (let sample = 0; sample <= this.last; sample += 1) {
      let at = this.model.reached(sample) ? this.centreOf(chosen, sample) : null;
      if (at && this.sheet && Math.hypot(...minus(at, this.box[0])) > reach) at = null;
      if (at && !this.sheet) {
        if (sign && dot(at, sign) < 0) at = at.map((value) => -value);
        sign = at;
      }
      fixed.push(at && (this.sheet ? this.sheet.place(at) : at));
      moving.push(at && this.sheet ? axes.local(at, sample) : null);
    }
    this.rolling = { axes, moving };
    this.centrodes.replaceChildren();
    this.fixedLines = [make("path", { class: "centrode", stroke: GROUND }, this.centrodes), make("path", { class: "centrode far", stroke: GROUND }, this.centrodes)];
    this.fixedCourse = fixed;
    this.movingLine = make("path", { class: "centrode", stroke: chosen.colour }, this.centrodes);
    this.draw(this.fixedLines, fixed);
    this.showCentrodes();
  }

  showCentrodes() {
    if (!this.rolling) return;
    if (!this.sheet) {
      this.draw(this.fixedLines, this.fixedCourse);
      return;
    }
    const { axes, moving } = this.rolling, sample = within(Math.round(this.place), 0, this.last);
    const here = moving.map((local) => {
      const at = local && axes.global(local, sample);
      return at && at.every(Number.isFinite) ? this.sheet.place(at) : null;
    });
    this.movingLine.setAttribute("d", this.space.paths(here)[0]);
  }

  // --- places under the pointer ------------------------------------------------------------------------------------
  back(at, point) {
    if (this.sheet) return this.sheet.back(at);
    const right = (at[0] - this.space.centre[0]) / this.space.radius, up = (this.space.centre[1] - at[1]) / this.space.radius;
    const aside = Math.hypot(right, up), size = aside > 0.999 ? 0.999 / aside : 1;
    const now = this.points[point].series.at(this.place), towards = Math.sqrt(Math.max(0, 1 - (size * aside) ** 2));
    const depth = now && !this.space.front(now) ? -towards : towards;
    return [0, 1, 2].map((k) => size * (right * this.space.view[0][k] + up * this.space.view[1][k]) + depth * this.space.view[2][k]);
  }

  moved(at, way, share) {
    if (this.sheet) return plus(at, way, (share * Math.max(...this.data.size)) / this.sheet.scale);
    return unit(plus(plus(at, this.space.view[0], 5 * share * way[0]), this.space.view[1], 5 * share * way[1]));
  }

  // --- by time -----------------------------------------------------------------------------------------------------
  play(on) {
    if (on && !this.playing && !this.on.loop && this.place >= this.reach[1]) this.place = this.reach[0];
    super.play(on);
  }

  frame(before, time) {
    if (!this.playing) return;
    const way = (this.speed * this.last * Math.min(time - before, 250)) / (1000 * SECONDS), [low, high] = this.reach;
    let place = this.place + (this.whole ? 1 : this.forward) * way;
    if (this.whole && this.on.loop) place = this.wrapped(place);
    else if (place >= high || place <= low) {
      if (this.on.loop) this.forward = place <= low ? 1 : -1;
      else if (place >= high) this.play(false);
      place = within(place, low, high);
    }
    this.place = place;
    this.show();
    if (this.playing) requestAnimationFrame((next) => this.frame(time, next));
  }
}

const ringOf = (model, ring) => {
  const found = [];
  const samples = ring.fixed ? 1 : model.frame.samples;
  for (let sample = 0; sample < samples; sample += 1) {
    const at = ring.point === null ? ring.pole : model.at(ring.point, sample);
    found.push(...(at ?? [null, null, null]));
  }
  return { series: new Series(found, 3), at: found, arc: model.value(ring.arcPath, ring.arc) };
};
