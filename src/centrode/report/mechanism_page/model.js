// The numbers of the page: dimensions that a reader changes, the motion that follows from them, and how both are spelled.
const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const TINY = 1e-12;

const fill = (sentence, holes) => sentence.replace(/\{(\w+)\}/g, (_whole, name) => String(holes[name] ?? ""));
const element = (name, attributes = {}, ...inside) => {
  const made = document.createElement(name);
  for (const key in attributes) {
    if (key in made && key !== "list") made[key] = attributes[key];
    else made.setAttribute(key, attributes[key]);
  }
  made.append(...inside);
  return made;
};
const within = (value, least, most) => Math.min(most, Math.max(least, value));

// Numbers as a report spells them: the decimal mark of the language, a true minus, powers of ten where zeros are many.
class Spelling {
  constructor(mark) {
    this.mark = mark;
  }
  marked(text) {
    const [digits, power] = text.split("e");
    const minus = digits.startsWith("-") && /[1-9]/.test(digits) ? "−" : "";
    const shown = minus + digits.replace("-", "").replace(".", this.mark);
    return power ? `${shown}·10${[...String(Number(power))].map((sign) => RAISED[sign]).join("")}` : shown;
  }
  number(value, digits = 5) {
    if (!Number.isFinite(value)) return "—";
    const size = Math.abs(value);
    if (size && (size < 1e-4 || size >= 1e7)) return this.marked(value.toExponential(digits - 1).replace(/\.?0+e/, "e"));
    const text = value.toPrecision(digits);
    return this.marked((text.includes("e") ? String(Math.round(value)) : text).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, ""));
  }
  // Decimals that give the greatest number of a column its digits.
  decimals(greatest, digits = 5) {
    return greatest ? Math.max(0, digits - 1 - Math.floor(Math.log10(greatest))) : 0;
  }
  fixed(value, greatest, digits = 5) {
    if (!Number.isFinite(value)) return "—";
    if (greatest && (greatest < 1e-4 || greatest >= 1e7)) return this.number(value, digits);
    return this.marked(value.toFixed(Math.min(9, this.decimals(greatest, digits))));
  }
  read(text) {
    const plain = text.trim().replace("−", "-").replace(",", ".");
    return plain === "" ? NaN : Number(plain);
  }
}

// A symbol with its index below the line: v_x(B).
const indexed = (label) => {
  const [, symbol, index, rest] = /^([^_(]+)_([^(]+)(.*)$/.exec(label) ?? [];
  return index ? [symbol, element("sub", {}, index), rest] : [label];
};
const withUnit = (text, label) => (label ? `${text}${label === "°" ? "" : " "}${label}` : text);
const greatestOf = (numbers) => {
  let most = 0;
  for (const value of numbers) if (Math.abs(value) > most) most = Math.abs(value); // NaN is not greater
  return most;
};

class Model {
  constructor(data) {
    this.data = data;
    this.words = data.words;
    this.spelling = new Spelling(data.decimal);
    this.engine = createMechanism(data.program);
    this.parameters = data.program.parameters;
    this.places = new Map(this.parameters.map((one, place) => [one.path, place]));
    this.nominal = this.parameters.map((one) => one.value);
    this.values = this.nominal.slice();
    this.undone = [];
    this.watchers = [];
    this.compute();
  }

  get changed() {
    return this.values.some((value, k) => value !== this.nominal[k]);
  }
  has(path) {
    return Boolean(path) && this.places.has(path);
  }
  value(path, otherwise) {
    return this.has(path) ? this.values[this.places.get(path)] : otherwise;
  }
  unit(one) {
    return this.data.units[one.unit] ?? { factor: 1, label: "" };
  }
  said(path) {
    const one = this.parameters[this.places.get(path)], unit = this.unit(one);
    return `${this.data.names[path] ?? path} = ${withUnit(this.spelling.number(this.value(path) * unit.factor), unit.label)}`;
  }

  // How a value came to be changed stays in one step of what can be undone, until `keep` begins the next.
  keep() {
    const last = this.undone[this.undone.length - 1];
    if (!last || last.some((value, k) => value !== this.values[k])) this.undone.push(this.values.slice());
    if (this.undone.length > 200) this.undone.shift();
  }
  change(changes) {
    let any = false;
    for (const [path, wished] of Object.entries(changes)) {
      const place = this.places.get(path), one = this.parameters[place];
      if (place === undefined || !Number.isFinite(wished)) continue;
      const value = within(wished, one.least, one.most);
      any = any || value !== this.values[place];
      this.values[place] = value;
    }
    if (any) this.renew();
  }
  restore(values) {
    this.values = values.slice();
    this.renew();
  }
  undo() {
    while (this.undone.length) {
      const values = this.undone.pop();
      if (values.some((value, k) => value !== this.values[k])) return this.restore(values);
    }
    return undefined;
  }
  // Numbers at once, pictures once for each picture of the screen.
  renew() {
    this.compute();
    this.waiting = this.waiting ?? requestAnimationFrame(() => this.show());
  }
  show() {
    if (this.waiting === undefined) return;
    cancelAnimationFrame(this.waiting);
    this.waiting = undefined;
    for (const watch of this.watchers) watch();
  }
  compute() {
    this.frame = this.engine.recompute(this.values);
    this.last = this.frame.samples - 1;
    this.start = this.nearest(this.data.program.parameter.initial);
  }

  // --- the motion ------------------------------------------------------------------------------------------------
  get parameter() {
    return this.data.parameter;
  }
  get abscissa() {
    return this.parameter.byTime ? this.frame.time : this.frame.drive;
  }
  nearest(value) {
    const along = this.frame.drive;
    let best = 0;
    for (let k = 1; k < along.length; k += 1) if (Math.abs(along[k] - value) < Math.abs(along[best] - value)) best = k;
    return best;
  }
  place(sample) {
    const { factor, label, symbol } = this.parameter, along = this.abscissa;
    const most = Math.max(greatestOf(along) * factor, TINY);
    return `${symbol} = ${withUnit(this.spelling.fixed(along[sample] * factor, most, 4), label)}`;
  }
  // A value of the drive, as events have it.
  placeOf(value) {
    const { factor, label } = this.data.drive;
    return withUnit(this.spelling.number(value * factor, 5), label);
  }
  status(sample) {
    return this.frame.status[sample];
  }
  // Reached from the initial position; a singular sample is one that is reached.
  reached(sample) {
    return this.data.reached[this.frame.status[sample]];
  }
  // Open because a constraint that repeats others does not fit there: its residual is above the bound.
  fits(sample) {
    return !(this.frame.misfit[sample] > this.frame.residualBound);
  }
  // The samples about the initial position that hang together with it.
  piece() {
    const good = (sample) => this.reached(sample);
    let low = this.start;
    if (!good(low)) {
      low = this.frame.status.findIndex((_one, sample) => good(sample));
      if (low < 0) return [0, 0];
    }
    let high = low;
    while (low > 0 && good(low - 1)) low -= 1;
    while (high < this.last && good(high + 1)) high += 1;
    return [low, high];
  }
  // Places in SI at a sample; null where there is none.
  at(point, sample) {
    const fixed = this.data.drawing.points[point].frame;
    if (fixed) return this.fixedAt(point, fixed);
    const found = this.frame.position[point].map((axis) => axis[sample]);
    return found.every(Number.isFinite) ? found : null;
  }
  // Points of the frame have their places where nothing else has one.
  fixedAt(point, otherwise) {
    const [x, y] = this.data.drawing.points[point].paths.map((path, k) => this.value(path, otherwise[k]));
    if (this.data.program.space === "plane") return [x, y];
    return [Math.cos(y) * Math.cos(x), Math.cos(y) * Math.sin(x), Math.sin(y)];
  }
  course(part) {
    let found = this.frame.quantities[part.quantity] ?? this.engine.reactions()[part.quantity];
    for (const place of part.index) found = found && found[place];
    return found;
  }
  // The numbers of a course as they are now, each with its label; of a vector its magnitude is the last.
  lines({ parts, factor, size }) {
    const found = parts.map((part) => {
      const numbers = this.course(part);
      return { label: part.label, value: (sample) => (numbers && this.reached(sample) ? numbers[sample] * factor : NaN) };
    });
    const whole = (sample) => Math.hypot(...found.map((one) => one.value(sample)));
    return size ? [...found, { label: size, value: whole }] : found;
  }
}
