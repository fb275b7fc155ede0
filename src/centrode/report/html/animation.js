// Plays the motions of a page: by time, step by step, and by dragging what the drive moves.
const SAME = 1e-3; // samples: a place that was gone to is that of its event

class Stage extends Picture {
  constructor(holder, ...data) {
    super(holder, ...data);
    this.forward = 1;
    this.playing = false;
    this.speed = 1;
    this.build();
    this.control();
    this.show();
  }

  show() {
    super.show();
    this.tell();
  }

  tell() {
    const here = (this.marks ?? []).filter((one) => Math.abs(one.at - this.place) < SAME).map((one) => one.name);
    const said = [this.data.texts[Math.round(this.place)], ...here].join(" · ");
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
    this.marks = [...this.holder.querySelectorAll(".tick")].map((one) => ({ at: this.last * Number(one.dataset.share), name: one.title }));
    this.marks.sort((one, other) => one.at - other.at);
    this.holder.querySelector(".ticks")?.addEventListener("click", (event) => this.near(event));
    this.slider.addEventListener("keydown", (event) => this.leap(event));
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

  // A click on the strip of events goes to the mark that is nearest.
  near(event) {
    if (!this.marks.length) return;
    const box = event.currentTarget.getBoundingClientRect(), at = (this.last * (event.clientX - box.left)) / box.width;
    this.go(this.marks.reduce((best, one) => (Math.abs(one.at - at) < Math.abs(best.at - at) ? one : best)).at);
  }

  // Page keys on the slider go from event to event.
  leap(event) {
    const on = event.key === "PageUp" ? 1 : event.key === "PageDown" ? -1 : 0;
    if (!on || !this.marks.length) return;
    event.preventDefault();
    const found = on > 0 ? this.marks.find((one) => one.at > this.place + SAME) : this.marks.filter((one) => one.at < this.place - SAME).at(-1);
    if (found) this.go(found.at);
  }

  switch(group, on) {
    group.setAttribute("display", on ? "inline" : "none");
  }

  key(event) {
    if (event.target.matches("input, button, select") && event.key !== "Escape") return;
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
    const icon = make("svg", { viewBox: "0 0 16 16", width: 14, height: 14, "aria-hidden": "true" });
    make("path", { fill: "currentColor", d: this.playing ? "M3 2h4v12H3zM9 2h4v12H9z" : "M3 1l11 7-11 7z" }, icon);
    this.button.replaceChildren(icon);
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
