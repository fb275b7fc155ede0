// What is drawn of a motion, in an SVG of its own; names are only ever set as text.
class Picture {
  constructor(holder, data = JSON.parse(holder.querySelector("script").textContent)) {
    this.holder = holder;
    this.data = data;
    this.last = this.data.samples - 1;
    this.place = this.data.start;
    const { view, centre, radius } = this.data;
    this.space = view ? new Globe(view, centre, radius) : new Flat();
    this.points = this.data.points.map((one) => ({ ...one, series: new Series(one.at, this.data.axes) }));
  }

  of(number, place) {
    return this.points[number].series.at(place);
  }

  build() {
    const [wide, high] = this.data.size;
    const svg = make("svg", { viewBox: `0 0 ${wide} ${high}`, role: "img", "aria-label": this.data.label });
    this.svg = svg;
    if (this.data.view) {
      const [x, y] = this.data.centre;
      make("circle", { class: "globe", cx: x, cy: y, r: this.data.radius }, svg);
    }
    this.grounds = make("g", {}, svg);
    this.data.grounds.forEach((d) => make("path", { class: "ground", d }, this.grounds));
    const behind = make("g", {}, svg);
    this.paths = make("g", { class: "paths" }, svg);
    this.tracks = this.data.tracks.map((number) => ({
      number, lines: [make("path", { class: "track" }, this.paths), make("path", { class: "track far" }, this.paths)],
    }));
    const links = make("g", {}, svg);
    this.bodies = this.data.bodies.map((body) => this.body(body, links));
    const above = make("g", {}, svg);
    this.shapes = this.data.shapes.map((shape) => this.shape(shape, shape.behind ? behind : above));
    this.rings = this.data.rings.map((ring) => ({
      ...ring, series: new Series(ring.at, 3),
      lines: [make("path", { class: "ring", stroke: ring.colour }, behind),
        make("path", { class: "ring far", stroke: ring.colour }, behind)],
    }));
    const grips = make("g", {}, svg);
    this.bodies.forEach((body) => {
      body.grip = make("path", { class: "grip" }, grips);
      body.grip.addEventListener("pointerdown", (event) => this.grab(event, this.along(body, event)));
    });
    this.signs = this.points.map((point, number) => this.sign(point, number, svg));
    this.names = make("g", { class: "names" }, svg);
    this.labels = this.points.map((point) => {
      const label = make("text", {}, this.names);
      label.textContent = point.name;
      return label;
    });
    svg.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"]) svg.addEventListener(end, () => this.release());
    if (this.data.view) {
      svg.addEventListener("pointerdown", (event) => {
        if (!this.held) this.grab(event, null);
      });
    }
    const paper = this.holder.querySelector(".paper");
    paper.replaceChildren(svg);
  }

  body(body, parent) {
    const fill = make("path", { class: "fill", fill: body.colour }, parent);
    const style = { fill: "none", stroke: body.colour };
    const lines = [make("path", { class: "link", ...style }, parent), make("path", { class: "link far", ...style }, parent)];
    lines[0].setAttribute("data-link", body.name);
    const badge = body.marker ? make("path", { d: body.marker, fill: body.colour }, parent) : null;
    return { ...body, fill, lines, badge };
  }

  shape(shape, parent) {
    const fill = shape.white ? "var(--stage)" : shape.filled ? shape.colour : "none";
    const made = make("path", { class: shape.ground ? "ground" : shape.line ? "link" : "shape", d: shape.d, stroke: shape.colour, fill,
      "fill-opacity": shape.white ? 1 : 0.16 }, parent);
    return { made, series: new Series(shape.at, 3) };
  }

  sign(point, number, parent) {
    const group = make("g", { "data-point": point.name, class: point.fixed ? "point" : "point grip" }, parent);
    if (point.fixed && !this.data.view && !point.dot) make("path", { class: "support", d: this.data.support }, group);
    if (point.slider !== null) {
      make("rect", { class: "slider", x: -150, y: -95, width: 300, height: 190,
        transform: `rotate(${point.slider})` }, group);
    }
    if (!point.fixed) make("circle", { class: "halo", r: REACH }, group);
    make("circle", { class: point.dot ? "dot" : "hinge", r: point.dot ? HINGE / 2 : HINGE }, group);
    if (point.fixed && this.data.view && !point.dot) make("circle", { class: "dot", r: HINGE / 2 }, group);
    if (!point.fixed) {
      group.addEventListener("pointerdown", (event) => this.grab(event, (place) => this.of(number, place)));
    }
    return group;
  }

  show() {
    const now = this.points.map((point) => point.series.at(this.place));
    const flat = now.map((place) => place && this.space.flat(place));
    flat.forEach((place, number) => {
      const away = !place || !this.space.front(now[number]);
      this.signs[number].setAttribute("display", place ? "inline" : "none");
      this.signs[number].classList.toggle("away", Boolean(away));
      if (place) this.signs[number].setAttribute("transform", `translate(${text(place[0])} ${text(place[1])})`);
    });
    for (const body of this.bodies) this.showBody(body, now);
    for (const { made, series } of this.shapes) {
      const pose = series.at(this.place);
      made.setAttribute("display", pose ? "inline" : "none");
      if (pose) made.setAttribute("transform", `translate(${text(pose[0])} ${text(pose[1])}) rotate(${pose[2].toFixed(3)})`);
    }
    for (const ring of this.rings) this.draw(ring.lines, this.circle(ring.series.at(this.place), ring.arc));
    if (!this.tracked || this.data.view) this.showTracks();
    this.nameAll(flat);
  }

  showBody(body, now) {
    const known = body.points.map((number) => now[number]).filter(Boolean);
    const around = known.length > 2 ? [...known, known[0]] : known;
    const places = [];
    for (let k = 1; k < around.length; k += 1) {
      places.push(...this.space.line(around[k - 1], around[k]).slice(k > 1 ? 1 : 0));
    }
    const front = this.draw(body.lines, places);
    body.grip.setAttribute("d", front);
    if (body.badge) this.showBadge(body.badge, known);
    const whole = known.length > 2 && places.every((place) => this.space.front(place));
    body.fill.setAttribute("d", whole ? front : "");
  }

  showBadge(badge, known) {
    badge.setAttribute("display", known.length > 1 ? "inline" : "none");
    if (known.length < 2) return;
    const [x, y] = this.space.flat(this.space.between(known[0], known[1], 0.5));
    badge.setAttribute("transform", `translate(${text(x)} ${text(y)})`);
  }

  draw(lines, places) {
    const drawn = this.space.paths(places);
    lines.forEach((line, k) => line.setAttribute("d", drawn[k]));
    return drawn[0];
  }

  circle(pole, arc) {
    if (!pole) return [];
    const axis = unit(pole);
    const least = axis.map(Math.abs).indexOf(Math.min(...axis.map(Math.abs)));
    const across = unit(cross(axis, [0, 1, 2].map((k) => (k === least ? 1 : 0))));
    const other = cross(axis, across);
    return Array.from({ length: 4 * ARC + 1 }, (_, k) => {
      const turn = (2 * Math.PI * k) / (4 * ARC);
      return axis.map((value, i) => Math.cos(arc) * value
        + Math.sin(arc) * (Math.cos(turn) * across[i] + Math.sin(turn) * other[i]));
    });
  }

  showTracks() {
    for (const { number, lines } of this.tracks) {
      const places = Array.from({ length: this.last + 1 }, (_, k) => this.of(number, k));
      this.draw(lines, places);
    }
    this.tracked = true;
  }

  // Names stand where the lines of their point leave most room, and stay there while there is room enough.
  nameAll(flat) {
    flat.forEach((place, number) => {
      const label = this.labels[number], point = this.points[number];
      label.setAttribute("display", place ? "inline" : "none");
      if (!place) return;
      const lines = this.bodies.filter((body) => body.points.includes(number)).flatMap((body) => body.points)
        .filter((other) => other !== number && flat[other] && Math.hypot(flat[other][0] - place[0], flat[other][1] - place[1]) > 1)
        .map((other) => Math.atan2(flat[other][1] - place[1], flat[other][0] - place[0]));
      if (point.fixed && !point.dot && !this.data.view) lines.push(Math.PI / 2, Math.PI / 2 - 0.6, Math.PI / 2 + 0.6);
      if (point.slider !== null) lines.push((point.slider * Math.PI) / 180, (point.slider * Math.PI) / 180 + Math.PI);
      const room = (turn) => lines.reduce((least, line) => {
        const apart = Math.abs(turn - line) % (2 * Math.PI);
        return Math.min(least, apart, 2 * Math.PI - apart);
      }, 1.6);
      let best = label.turn ?? -Math.PI / 3, most = room(best) + 0.35;
      for (let k = 0; k < 16; k += 1) {
        const turn = -Math.PI / 3 + (k * Math.PI) / 8;
        if (room(turn) > most) [best, most] = [turn, room(turn)];
      }
      label.turn = best;
      const far = point.slider !== null ? 250 : 185;
      label.setAttribute("x", text(place[0] + far * Math.cos(best)));
      label.setAttribute("y", text(place[1] + far * Math.sin(best)));
    });
  }
}
