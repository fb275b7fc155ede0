// Plays the motions of a page: by time, step by step, and by dragging what the drive moves.
// Places come in the units of the picture's viewBox; on the sphere as unit vectors. Names are only ever set as text.
(() => {
  "use strict";
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

  class Stage {
    constructor(holder) {
      this.holder = holder;
      this.data = JSON.parse(holder.querySelector("script").textContent);
      this.last = this.data.samples - 1;
      this.place = this.data.start;
      this.forward = 1;
      this.playing = false;
      this.speed = 1;
      const { view, centre, radius } = this.data;
      this.space = view ? new Globe(view, centre, radius) : new Flat();
      this.points = this.data.points.map((one) => ({ ...one, series: new Series(one.at, this.data.axes) }));
      this.build();
      this.control();
      this.show();
    }

    of(number, place) {
      return this.points[number].series.at(place);
    }

    // --- what is drawn -------------------------------------------------------------------------------------------
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
      const style = { fill: "none", stroke: body.colour, "stroke-dasharray": body.dashes };
      const lines = [make("path", { class: "link", ...style }, parent), make("path", { class: "link far", ...style }, parent)];
      lines[0].setAttribute("data-link", body.name);
      return { ...body, fill, lines };
    }

    shape(shape, parent) {
      const fill = shape.white ? "#ffffff" : shape.filled ? shape.colour : "none";
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
      this.tell();
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
      const whole = known.length > 2 && places.every((place) => this.space.front(place));
      body.fill.setAttribute("d", whole ? front : "");
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

    tell() {
      const said = this.data.texts[Math.round(this.place)];
      this.output.textContent = said;
      this.slider.value = String(this.place);
      this.slider.setAttribute("aria-valuetext", said);
      this.holder.dataset.place = this.place.toFixed(3);
    }

    // --- by time and by step -------------------------------------------------------------------------------------
    control() {
      const find = (name) => this.holder.querySelector(`[data-do="${name}"]`);
      this.output = this.holder.querySelector("output");
      this.slider = find("seek");
      this.button = find("play");
      this.slider.max = String(this.last);
      this.button.addEventListener("click", () => this.play(!this.playing));
      find("back").addEventListener("click", () => this.step(-1));
      find("on").addEventListener("click", () => this.step(1));
      this.slider.addEventListener("input", () => this.go(Number(this.slider.value)));
      find("speed").addEventListener("input", (event) => { this.speed = 2 ** Number(event.target.value); });
      find("paths").addEventListener("change", (event) => this.switch(this.paths, event.target.checked));
      find("names").addEventListener("change", (event) => this.switch(this.names, event.target.checked));
      this.switch(this.paths, find("paths").checked);
      this.switch(this.names, find("names").checked);
      this.speed = 2 ** Number(find("speed").value);
      this.holder.querySelector(".controls").hidden = false;
      this.holder.addEventListener("keydown", (event) => this.key(event));
      window.addEventListener("beforeprint", () => this.play(false));
    }

    switch(group, on) {
      group.setAttribute("display", on ? "inline" : "none");
    }

    key(event) {
      if (event.target.matches("input, button") && event.key !== "Escape") return;
      const step = event.shiftKey ? 10 : 1;
      const acts = {
        " ": () => this.play(!this.playing), ArrowRight: () => this.step(step), ArrowUp: () => this.step(step),
        ArrowLeft: () => this.step(-step), ArrowDown: () => this.step(-step), Home: () => this.go(0),
        End: () => this.go(this.last), Escape: () => this.play(false),
      };
      if (!acts[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      acts[event.key]();
    }

    wrapped(place) {
      if (!this.data.loop) return Math.min(this.last, Math.max(0, place));
      return this.last ? ((place % this.last) + this.last) % this.last : 0;
    }

    go(place) {
      this.play(false);
      this.place = Math.min(this.last, Math.max(0, place));
      this.show();
    }

    step(by) {
      this.play(false);
      this.place = this.wrapped(Math.round(this.place) + by);
      this.show();
    }

    play(on) {
      if (on === this.playing) return;
      this.playing = on && this.last > 0;
      const word = this.playing ? this.data.words.pause : this.data.words.play;
      this.button.textContent = this.playing ? "\u23F8\uFE0E" : "\u25B6\uFE0E";
      this.button.setAttribute("aria-label", word);
      this.button.title = word;
      if (this.playing) requestAnimationFrame((time) => this.frame(time, time));
    }

    frame(before, time) {
      if (!this.playing) return;
      let place = this.place + (this.forward * this.speed * this.last * Math.min(time - before, 250)) / (1000 * SECONDS);
      if (!this.data.loop && (place >= this.last || place <= 0)) {
        this.forward = place <= 0 ? 1 : -1;
      }
      this.place = this.wrapped(place);
      this.show();
      requestAnimationFrame((next) => this.frame(time, next));
    }

    // --- by dragging ---------------------------------------------------------------------------------------------
    pointer(event) {
      const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
      return [point.x, point.y];
    }

    grab(event, held) {
      event.preventDefault();
      event.stopPropagation();
      this.play(false);
      this.holder.querySelector(".paper").focus({ preventScroll: true });
      this.held = held ?? "view";
      this.from = this.pointer(event);
      this.way = this.way ?? 1;
      this.svg.setPointerCapture(event.pointerId);
      this.svg.classList.add("held");
    }

    release() {
      this.held = null;
      this.svg.classList.remove("held");
    }

    // The place of a link that was taken hold of: between which of its points, and where between them.
    along(body, event) {
      const [x, y] = this.pointer(event);
      const pairs = body.points.map((number, k) => [number, body.points[(k + 1) % body.points.length]]);
      let best = null, nearest = Infinity;
      for (const [one, other] of pairs) {
        const [a, b] = [this.of(one, this.place), this.of(other, this.place)];
        if (!a || !b || one === other) continue;
        for (let k = 0; k <= ARC; k += 1) {
          const at = this.space.flat(this.space.between(a, b, k / ARC)), far = Math.hypot(at[0] - x, at[1] - y);
          if (far < nearest) [best, nearest] = [[one, other, k / ARC], far];
        }
      }
      if (!best) return null;
      return (place) => {
        const [a, b] = [this.of(best[0], place), this.of(best[1], place)];
        return a && b && this.space.between(a, b, best[2]);
      };
    }

    drag(event) {
      if (!this.held) return;
      const to = this.pointer(event);
      if (this.held === "view") {
        this.space.turn(to[0] - this.from[0], this.from[1] - to[1]);
        this.from = to;
      } else {
        this.follow(to);
      }
      this.show();
    }

    // Goes down the distance from the pointer, sample by sample, so that it stays on its branch; rather on than back
    // where both are as near, so that it passes dead points.
    follow(to) {
      const distance = (place) => {
        const at = this.held(this.wrapped(place));
        if (!at) return Infinity;
        const flat = this.space.flat(at);
        return Math.hypot(flat[0] - to[0], flat[1] - to[1]);
      };
      const window = Math.max(2, Math.round(this.last / 24));
      const begin = Math.round(this.place);
      let here = begin;
      for (let round = 0; round < 48; round += 1) {
        let best = here, least = distance(here);
        for (let by = -window; by <= window; by += 1) {
          const place = here + by, apart = Math.abs(by) * (Math.sign(by) === this.way ? 0.2 : 0.6);
          if (!this.data.loop && (place < 0 || place > this.last)) continue;
          const cost = distance(place) + apart;
          if (cost < least) [best, least] = [place, cost];
        }
        if (best === here) break;
        here = best;
      }
      if (here !== begin) this.way = Math.sign(here - begin);
      this.place = this.wrapped(this.between(here, distance));
    }

    // Between the samples, where a parabola through three distances squared is least.
    between(here, distance) {
      const [a, b, c] = [distance(here - 1) ** 2, distance(here) ** 2, distance(here + 1) ** 2];
      const bend = a - 2 * b + c;
      if (!this.data.loop && (here <= 0 || here >= this.last)) return here;
      if (!(bend > 0) || !Number.isFinite(bend)) return here;
      return here + Math.max(-0.5, Math.min(0.5, (a - c) / (2 * bend)));
    }
  }

  for (const holder of document.querySelectorAll(".moving")) new Stage(holder);
})();
