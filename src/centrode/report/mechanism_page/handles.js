// Handles on the joints: a fixed hinge takes its coordinates along, a moving joint the lengths of its links.
class Handles {
  constructor(stage, model, tell) {
    this.stage = stage;
    this.model = model;
    this.tell = tell;
    this.group = make("g", { class: "handles" }, stage.svg);
    this.all = model.data.handles.filter((one) => one.ways.length).map((one) => this.made(one));
  }

  made(one) {
    const { words } = this.model, name = stageName(this.stage, one.point);
    const label = `${fill(one.fixed ? words.fixed_joint : words.joint, { name })}: ${one.changes.join(", ")}`;
    const sign = make("g", { class: "handle", tabindex: 0, role: "button", "aria-label": label, "data-handle": name }, this.group);
    make("circle", { class: "reach", r: 150 }, sign);
    make("circle", { class: "collar", r: 105 }, sign);
    const hint = make("title", {}, sign);
    hint.textContent = label;
    const handle = { ...one, sign, name };
    sign.addEventListener("pointerdown", (event) => this.grab(event, handle));
    sign.addEventListener("keydown", (event) => this.key(event, handle));
    return handle;
  }

  show(flat, now) {
    for (const { point, sign } of this.all) {
      const place = flat[point], away = place && !this.stage.space.front(now[point]);
      sign.setAttribute("display", place && !away ? "inline" : "none");
      if (place) sign.setAttribute("transform", `translate(${text(place[0])} ${text(place[1])})`);
    }
  }

  // --- gestures --------------------------------------------------------------------------------------------------
  grab(event, handle) {
    if (event.button) return;
    event.preventDefault();
    event.stopPropagation();
    const { stage, model } = this;
    stage.play(false);
    model.keep();
    handle.sign.focus({ preventScroll: true });
    const base = this.base(handle), from = stage.pointer(event), begun = stage.points[handle.point].series.at(base.sample);
    const off = minus(from, stage.space.flat(begun));
    const move = (next) => {
      if (next.pointerId !== event.pointerId) return;
      const to = stage.back(minus(stage.pointer(next), off), handle.point);
      if (to) model.change(this.changes(handle, base, to));
    };
    const end = (last) => {
      if (last.pointerId !== event.pointerId) return;
      stage.svg.removeEventListener("pointermove", move);
      for (const name of ["pointerup", "pointercancel"]) stage.svg.removeEventListener(name, end);
      stage.svg.classList.remove("held");
      stage.settle();
      this.say(handle);
    };
    stage.svg.setPointerCapture(event.pointerId);
    stage.svg.classList.add("held");
    stage.svg.addEventListener("pointermove", move);
    for (const name of ["pointerup", "pointercancel"]) stage.svg.addEventListener(name, end);
  }

  key(event, handle) {
    const ways = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const way = ways[event.key];
    if (!way || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    const { stage, model } = this, step = event.shiftKey ? 0.02 : 0.002;
    stage.play(false);
    if (!event.repeat) model.keep();
    const base = this.base(handle), at = base.places[handle.point];
    if (!at) return;
    const to = stage.moved(at, way, step);
    const before = model.values.slice();
    model.change(this.changes(handle, base, to));
    if (before.every((value, k) => value === model.values[k])) model.undone.pop();
    stage.settle();
    this.say(handle);
  }

  say(handle) {
    const paths = [...new Set(handle.ways.flatMap(pathsOf))].filter((path) => this.model.has(path));
    this.tell(paths.map((path) => this.model.said(path)).join("; "));
  }

  // --- from a place to dimensions ----------------------------------------------------------------------------------
  // What stands still while one joint is moved: copied, as the arrays of a motion are used again.
  base(handle) {
    const { model } = this, sample = within(Math.round(this.stage.place), 0, model.last);
    const places = model.frame.position.map((_one, point) => model.at(point, sample));
    const angles = model.data.program.space === "plane" ? model.frame.angle.map((one) => one[sample]) : [];
    return { sample, places, angles, values: model.values.slice(), point: handle.point };
  }

  old(base, path, otherwise) {
    return this.model.has(path) ? base.values[this.model.places.get(path)] : otherwise;
  }

  changes(handle, base, wished) {
    return this.model.data.program.space === "plane" ? this.inPlane(handle, base, wished) : this.onSphere(handle, base, wished);
  }

  inPlane(handle, base, wished) {
    const found = {}, begun = base.places[handle.point];
    let to = wished;
    const guided = handle.ways.find((way) => way.kind === "guide");
    for (const rail of handle.rails) {
      if (guided || !begun) continue;
      const on = [Math.cos(rail.direction), Math.sin(rail.direction)], way = minus(to, begun);
      to = plus(begun, on, way[0] * on[0] + way[1] * on[1]);
    }
    // a driven link keeps its direction: only its length follows
    for (const way of handle.ways) {
      if (way.kind !== "length" || !way.driven || !begun) continue;
      const other = base.places[way.other], on = minus(begun, other), size = Math.hypot(...on) || 1;
      to = plus(other, on.map((value) => value / size), Math.max(0, ((to[0] - other[0]) * on[0] + (to[1] - other[1]) * on[1]) / size));
    }
    for (const way of handle.ways) {
      if (way.kind === "frame") {
        if (way.x) found[way.x] = to[0];
        if (way.y) found[way.y] = to[1];
      } else if (way.kind === "length" && base.places[way.other]) {
        found[way.path] = way.sign * Math.hypot(...minus(to, base.places[way.other]));
      } else if (way.kind === "guide" && begun) {
        const on = [Math.cos(way.direction), Math.sin(way.direction)], off = minus(to, begun), across = off[1] * on[0] - off[0] * on[1];
        if (way.x && Math.abs(on[1]) > 1e-9) found[way.x] = this.old(base, way.x) - across * on[1];
        if (way.y && Math.abs(on[0]) > 1e-9) found[way.y] = this.old(base, way.y) + across * on[0];
      } else if (way.kind === "local" && begun && Number.isFinite(base.angles[way.link])) {
        const moved = turned(minus(to, begun), -base.angles[way.link]);
        if (way.x) found[way.x] = this.old(base, way.x) + moved[0];
        if (way.y) found[way.y] = this.old(base, way.y) + moved[1];
      } else if (way.kind === "origin" && begun && Number.isFinite(base.angles[way.link])) {
        const moved = turned(minus(to, begun), -base.angles[way.link]);
        for (const [x, y] of way.others) {
          if (x) found[x] = this.old(base, x) - moved[0];
          if (y) found[y] = this.old(base, y) - moved[1];
        }
      }
    }
    return found;
  }

  onSphere(handle, base, wished) {
    const found = {}, to = unit(wished);
    for (const way of handle.ways) {
      if (way.kind === "frame") {
        const turn = Math.atan2(to[1], to[0]), before = way.x ? this.old(base, way.x) : turn;
        if (way.x) found[way.x] = turn + 2 * Math.PI * Math.round((before - turn) / (2 * Math.PI));
        if (way.y) found[way.y] = Math.asin(within(to[2], -1, 1));
      } else if (way.kind === "length" && base.places[way.other]) {
        const other = base.places[way.other];
        found[way.path] = way.sign * Math.atan2(Math.hypot(...cross(other, to)), dot(other, to));
      }
    }
    return found;
  }
}
const stageName = (stage, point) => stage.points[point].name;
const pathsOf = (way) => [way.path, way.x, way.y, ...(way.others ?? []).flat()].filter(Boolean);
