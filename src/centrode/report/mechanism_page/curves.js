// Curves over the motion, with a cursor that is the player's place: drawn at the size they are seen at.
const TALL = 176, LEFT = 56, RIGHT = 14, UPPER = 20, LOWER = 22, ON_PAPER = 340;

// Round steps of an axis: 1, 2 or 5 times a power of ten, of degrees parts of a turn.
const stepsOf = (least, most, count, turns) => {
  const wished = (most - least) / Math.max(1, count);
  if (turns) {
    const step = [5, 10, 15, 30, 45, 60, 90, 180, 360, 720, 1440, 3600].find((one) => one >= wished);
    if (step && wished > 2) return step;
  }
  const power = 10 ** Math.floor(Math.log10(wished || 1));
  return [1, 2, 5, 10].map((one) => one * power).find((one) => one >= wished * 0.999);
};
const ticksOf = (least, most, step) => {
  const found = [];
  if (!(step > 1e-12 * Math.max(Math.abs(least), Math.abs(most)))) return found; // no two numbers lie so close
  for (let k = Math.ceil(least / step - 1e-9); k * step <= most + 1e-9 * step; k += 1) found.push(k * step);
  return found;
};

// More lines than hues: further ones are dashed.
const HUES = 6;
const hueOf = (k) => `line-${k % HUES}${k >= HUES ? " dashed" : ""}`;

class Curves {
  constructor(holder, stage, model) {
    this.holder = holder;
    this.stage = stage;
    this.model = model;
    this.charts = [];
    this.list = holder.querySelector(".charts");
    this.wide = this.list.clientWidth || 560; // asked once: a browser lays the page out to answer
    this.add = holder.querySelector('[data-do="add-curve"]');
    this.add.addEventListener("click", () => {
      this.append(this.next());
      this.charts[this.charts.length - 1].choice.focus();
    });
    model.watchers.push(() => this.renew());
    new ResizeObserver(() => this.widen()).observe(this.list);
    // on paper two stand beside each other, whatever the screen was
    window.addEventListener("beforeprint", () => this.print(true));
    window.addEventListener("afterprint", () => this.print(false));
  }

  get keys() {
    return this.charts.map((one) => one.choice.value);
  }
  next() {
    const taken = this.keys;
    return (this.model.data.courses.find((one) => !taken.includes(one.key)) ?? this.model.data.courses[0]).key;
  }
  choose(keys) {
    for (const chart of this.charts.slice()) this.remove(chart);
    for (const key of keys) if (this.model.data.courses.some((one) => one.key === key)) this.append(key);
  }
  append(key) {
    if (this.charts.length >= 12) return;
    const chart = new Chart(this, key);
    this.charts.push(chart);
    this.list.append(chart.card);
    chart.renew();
  }
  remove(chart) {
    this.charts = this.charts.filter((one) => one !== chart);
    chart.card.remove();
  }
  renew() {
    for (const chart of this.charts) chart.renew();
  }
  print(on) {
    this.printing = on;
    this.wide = on ? ON_PAPER : this.list.clientWidth;
    this.renew();
  }
  widen() {
    const wide = this.list.clientWidth;
    if (this.printing || !wide || Math.abs(wide - this.wide) < 8) return;
    this.wide = wide;
    this.renew();
  }
  show() {
    for (const chart of this.charts) chart.show();
  }
}

class Chart {
  constructor(curves, key) {
    const { model } = curves, { words } = model;
    this.curves = curves;
    this.model = model;
    this.choice = element("select", { "aria-label": words.quantity });
    let group = null;
    for (const course of model.data.courses) {
      if (!group || group.label !== course.group) {
        group = element("optgroup", { label: course.group });
        this.choice.append(group);
      }
      group.append(element("option", { value: course.key }, course.label));
    }
    this.choice.value = key;
    this.choice.addEventListener("change", () => this.renew());
    const remove = element("button", { type: "button", className: "remove", title: words.remove_curve, "aria-label": words.remove_curve }, "×");
    remove.addEventListener("click", () => {
      curves.remove(this);
      curves.add.focus();
    });
    this.legend = element("div", { className: "legend" });
    this.plot = element("div", { className: "plot" });
    this.card = element("figure", { className: "chart" }, element("div", { className: "head" }, this.choice, remove), this.plot, this.legend);
    this.svg = make("svg", { role: "img" });
    this.plot.append(this.svg);
    const seek = (event) => curves.stage.go(this.sample(event));
    this.svg.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      this.svg.setPointerCapture(event.pointerId);
      this.held = true;
      seek(event);
    });
    this.svg.addEventListener("pointermove", (event) => this.held && seek(event));
    for (const name of ["pointerup", "pointercancel"]) this.svg.addEventListener(name, () => { this.held = false; });
  }

  get course() {
    return this.model.data.courses.find((one) => one.key === this.choice.value);
  }

  sample(event) {
    const box = this.svg.getBoundingClientRect(), x = ((event.clientX - box.left) * this.wide) / box.width;
    const share = within((x - LEFT) / (this.wide - LEFT - RIGHT), 0, 1);
    return share * this.model.last;
  }

  renew() {
    this.wide = Math.max(260, this.curves.wide);
    this.lines = this.model.lines(this.course);
    this.draw();
    this.show();
  }

  draw() {
    const { model, svg, wide } = this, { parameter, words } = model, last = model.last;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${wide} ${TALL}`);
    const values = this.lines.flatMap((line) => Array.from({ length: last + 1 }, (_, k) => line.value(k)));
    const known = values.filter(Number.isFinite);
    let [least, most] = known.length ? span(known) : [-1, 1];
    const size = Math.max(Math.abs(least), Math.abs(most));
    if (most - least < 1e-9 * size || most === least) [least, most] = [least - (0.1 * size || 1), most + (0.1 * size || 1)];
    const room = 0.06 * (most - least);
    least -= room;
    most += room;
    this.greatest = size;
    const along = model.abscissa, first = along[0] * parameter.factor, end = along[last] * parameter.factor;
    const [low, high] = first <= end ? [first, end] : [end, first];
    this.x = (sample) => LEFT + ((wide - LEFT - RIGHT) * sample) / (last || 1);
    const across = (value) => LEFT + (wide - LEFT - RIGHT) * ((value - first) / (end - first || 1));
    const up = (value) => TALL - LOWER - ((TALL - LOWER - UPPER) * (value - least)) / (most - least);
    this.up = up;
    this.bands(svg);
    const symbol = [parameter.symbol, parameter.label].filter(Boolean).join(", "), named = 6.5 * symbol.length + 8;
    const vertical = stepsOf(low, high, wide / 70, parameter.label === "°");
    for (const tick of ticksOf(low, high, vertical)) {
      make("line", { class: "grid", x1: across(tick), x2: across(tick), y1: UPPER, y2: TALL - LOWER }, svg);
      const told = this.tick(tick, vertical);
      if (wide - RIGHT - across(tick) < named + 3.5 * told.length) continue;
      const label = make("text", { x: across(tick), y: TALL - 6, "text-anchor": "middle" }, svg);
      label.textContent = told;
    }
    const horizontal = stepsOf(least, most, 5, this.course.unit === "°" && most - least > 20);
    // without a value there is nothing to read
    for (const tick of known.length ? ticksOf(least, most, horizontal) : []) {
      make("line", { class: Math.abs(tick) < 1e-9 * horizontal ? "zero" : "grid", x1: LEFT, x2: wide - RIGHT, y1: up(tick), y2: up(tick) }, svg);
      const label = make("text", { x: LEFT - 6, y: up(tick) + 4, "text-anchor": "end" }, svg);
      label.textContent = this.tick(tick, horizontal);
    }
    make("rect", { class: "box", x: LEFT, y: UPPER, width: wide - LEFT - RIGHT, height: TALL - LOWER - UPPER }, svg);
    const name = make("text", { class: "axis", x: wide - RIGHT, y: TALL - 6, "text-anchor": "end" }, svg);
    name.textContent = symbol;
    const what = make("text", { class: "axis", x: LEFT - 6, y: 12, "text-anchor": "end" }, svg);
    what.textContent = this.course.unit;
    this.lines.forEach((line, k) => {
      let d = "", pen = false;
      for (let sample = 0; sample <= last; sample += 1) {
        const value = line.value(sample), seen = Number.isFinite(value);
        if (seen) d += `${pen ? "L" : "M"}${text(this.x(sample))} ${text(up(value))}`;
        pen = seen;
      }
      make("path", { class: `line ${hueOf(k)}`, d }, svg);
    });
    this.cursor = make("line", { class: "cursor", y1: UPPER, y2: TALL - LOWER }, svg);
    this.dots = this.lines.map((_line, k) => make("circle", { class: `spot ${hueOf(k)}`, r: 3.5 }, svg));
    const [from, to] = known.length ? span(known) : [NaN, NaN];
    svg.setAttribute("aria-label", fill(words.curve, {
      what: this.course.label, least: this.said(from), most: this.said(to),
    }));
    this.legend.replaceChildren(...this.lines.map((line, k) => {
      line.output = element("span", { className: "value" });
      return element("span", { className: "entry" }, element("i", { className: hueOf(k), ariaHidden: "true" }),
        element("span", {}, ...indexed(line.label), " = "), line.output);
    }));
  }

  said(value) {
    return withUnit(this.model.spelling.fixed(value, this.greatest), this.course.unit);
  }

  tick(value, step) {
    const { spelling } = this.model, most = Math.max(Math.abs(value), step);
    if (most >= 1e6 || step < 1e-4) return spelling.number(Math.abs(value) < 1e-9 * step ? 0 : value, 3);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    return spelling.marked(value.toFixed(decimals));
  }

  // Where the mechanism is not reached, and its limits.
  bands(svg) {
    const { model } = this;
    for (const piece of piecesOf(model)) {
      const { from, to, status } = piece;
      if (model.data.reached[status]) continue;
      make("rect", { class: bandOf(piece), x: this.x(Math.max(0, from - 0.5)), y: UPPER,
        width: this.x(Math.min(model.last, to + 0.5)) - this.x(Math.max(0, from - 0.5)), height: TALL - UPPER - LOWER }, svg);
    }
    for (const event of model.frame.events) {
      const sample = sampleOf(model, event.drive);
      if (sample !== null) make("line", { class: `mark ${markOf(event)}`, x1: this.x(sample), x2: this.x(sample), y1: UPPER, y2: TALL - LOWER }, svg);
    }
  }

  show() {
    if (!this.cursor) return;
    const { place } = this.curves.stage, sample = within(Math.round(place), 0, this.model.last), x = this.x(place);
    this.cursor.setAttribute("x1", x);
    this.cursor.setAttribute("x2", x);
    this.lines.forEach((line, k) => {
      const value = line.value(sample), seen = Number.isFinite(value);
      this.dots[k].setAttribute("display", seen ? "inline" : "none");
      if (seen) {
        this.dots[k].setAttribute("cx", this.x(sample));
        this.dots[k].setAttribute("cy", this.up(value));
      }
      const said = this.said(value);
      if (line.output.textContent !== said) line.output.textContent = said;
    });
  }
}

const markOf = (event) => (event.kind === "limit" ? "limit" : "change");
const bandOf = ({ status, fits }) => `band status-${status}${fits ? "" : " misfit"}`;
// The samples of one status behind one another; those at which a constraint does not fit apart.
const piecesOf = (model) => {
  const { status } = model.frame, found = [];
  for (let sample = 0; sample <= model.last; sample += 1) {
    const now = found[found.length - 1], fits = model.fits(sample);
    if (now && now.status === status[sample] && now.fits === fits) now.to = sample;
    else found.push({ from: sample, to: sample, status: status[sample], fits });
  }
  return found;
};
// Where between the samples a value of the drive lies; null beyond them.
const sampleOf = (model, value) => {
  const along = model.frame.drive, last = model.last;
  for (let k = 0; k < last; k += 1) {
    const [a, b] = [along[k], along[k + 1]];
    if ((a <= value && value <= b) || (b <= value && value <= a)) return k + (b === a ? 0 : (value - a) / (b - a));
  }
  return null;
};
