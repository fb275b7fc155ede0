// Curves over an abscissa, drawn at the size that they are seen at, with a cursor: the report's look.
import { digits } from "./outlines";
import { make } from "./picture";
import { fixed, say, tickText, withUnit } from "./words";

const TALLEST = 176, LEFT = 56, RIGHT = 14, UPPER = 20, LOWEST = 22;

export interface ChartLine {
  label: string;
  values: ArrayLike<number>;
  x?: ArrayLike<number>; // its own abscissa
  finer?: { x: ArrayLike<number>; values: ArrayLike<number> }; // its course through the samples
  dashed?: boolean;
  pen?: number; // its colour; its place among the lines where none is given
}
const PENS = 6;
// How each line looks: its own pen, unless two that look alike would have the same; dashed where the pens come round again.
function looksOf(lines: ChartLine[]): string[] {
  const look = (pen: number, dashed?: boolean): string => `line-${pen % PENS}${dashed || pen >= PENS ? " dashed" : ""}`;
  const own = lines.map((line, k) => look(line.pen ?? k, line.dashed));
  return new Set(own).size === lines.length ? own : lines.map((line, k) => look(k, line.dashed));
}
export interface ChartData {
  title: string;
  unit: string;
  x: { values: ArrayLike<number>; label: string; unit: string; ends?: [number, number] | null }; // ends: left and right of a phase portrait
  lines: ChartLine[];
  bands?: { from: number; to: number }[]; // samples that are not reached
  marks?: { at: number; kind: string }[]; // samples of limits and change points
  places?: { at: number; label: string }[]; // values of the abscissa that have a name
  shaded?: { from: number; to: number }[]; // stretches of the abscissa
}

const steps = (least: number, most: number, count: number, turns: boolean): number => {
  const wished = (most - least) / Math.max(1, count);
  if (turns) {
    const step = [5, 10, 15, 30, 45, 60, 90, 180, 360, 720, 1440, 3600].find((one) => one >= wished);
    if (step && wished > 2) return step;
  }
  const power = 10 ** Math.floor(Math.log10(wished || 1));
  return [1, 2, 5, 10].map((one) => one * power).find((one) => one >= wished * 0.999)!;
};
const ticks = (least: number, most: number, step: number): number[] => {
  const found: number[] = [];
  if (!(step > 1e-12 * Math.max(Math.abs(least), Math.abs(most)))) return found;
  for (let k = Math.ceil(least / step - 1e-9); k * step <= most + 1e-9 * step; k += 1) found.push(k * step);
  return found;
};

export class Chart {
  readonly svg: SVGSVGElement;
  readonly legend: HTMLElement;
  private data: ChartData | null = null;
  private wide = 560;
  private greatest = 1;
  private cursor: SVGLineElement | null = null;
  private dots: SVGCircleElement[] = [];
  private outputs: HTMLElement[] = [];
  private at = 0;
  private held = false;
  private rising = true;
  private turnsBack = false;
  private watch: ResizeObserver;

  // `seek` takes the place under the pointer; without it the chart has no cursor.
  constructor(private readonly holder: HTMLElement, private readonly seek: ((place: number) => void) | null) {
    this.svg = make("svg", { role: "img" });
    this.legend = document.createElement("div");
    this.legend.className = "legend";
    const plot = document.createElement("div");
    plot.className = seek ? "plot" : "plot still";
    plot.append(this.svg);
    holder.append(plot, this.legend);
    if (seek) {
      this.svg.addEventListener("pointerdown", (event) => {
        if (event.button) return;
        this.svg.setPointerCapture(event.pointerId);
        this.held = true;
        seek(this.sample(event));
      });
      this.svg.addEventListener("pointermove", (event) => this.held && seek(this.sample(event)));
      for (const name of ["pointerup", "pointercancel"] as const) this.svg.addEventListener(name, () => { this.held = false; });
    }
    this.watch = new ResizeObserver(() => {
      const wide = holder.clientWidth;
      if (!wide || Math.abs(wide - this.wide) < 8) return;
      this.wide = Math.max(260, wide);
      this.draw();
    });
    this.watch.observe(holder);
  }

  end(): void {
    this.watch.disconnect();
  }

  renew(data: ChartData): void {
    this.data = data;
    this.wide = Math.max(260, this.holder.clientWidth || this.wide);
    this.draw();
  }

  // Between samples of an abscissa that rises or falls; of one that turns back, as in a phase portrait, the nearest.
  private sample(event: PointerEvent): number {
    const { data } = this;
    if (!data) return 0;
    const box = this.svg.getBoundingClientRect(), x = ((event.clientX - box.left) * this.wide) / box.width, values = data.x.values;
    if (this.turnsBack) {
      const y = ((event.clientY - box.top) * this.wide) / box.width, first = data.lines[0]!.values;
      let best = 0, nearest = Infinity;
      for (let k = 0; k < values.length; k += 1) {
        const [across, up] = this.place(k), far = Math.hypot(across - x, up(first[k]!) - y);
        if (far < nearest) [best, nearest] = [k, far];
      }
      return best;
    }
    const share = Math.min(1, Math.max(0, (x - LEFT) / (this.wide - LEFT - RIGHT)));
    const [low, high] = this.range();
    const sought = low + share * (high - low), last = values.length - 1;
    let a = 0, b = last;
    while (b - a > 1) {
      const middle = (a + b) >> 1;
      if (values[middle]! <= sought === this.rising) a = middle;
      else b = middle;
    }
    const way = values[b]! - values[a]!;
    return Math.min(last, Math.max(0, a + (way ? (sought - values[a]!) / way : 0)));
  }

  private range(): [number, number] {
    const own = this.data!.lines.flatMap((line) => Array.from(line.x ?? [])).filter(Number.isFinite);
    if (own.length) return [own.reduce((a, b) => Math.min(a, b)), own.reduce((a, b) => Math.max(a, b))];
    const values = this.data!.x.values, first = values[0] ?? 0, last = values[values.length - 1] ?? 1, all = Array.from(values).filter(Number.isFinite);
    this.rising = first <= last;
    this.turnsBack = all.some((value, k) => k > 0 && (this.rising ? value < all[k - 1]! : value > all[k - 1]!));
    const least = all.reduce((a, b) => Math.min(a, b), first), most = all.reduce((a, b) => Math.max(a, b), last), slack = 1e-9 * (most - least);
    if (this.data!.x.ends) return this.data!.x.ends;
    // what goes to and fro, as a drive over its turns
    if (least < Math.min(first, last) - slack || most > Math.max(first, last) + slack) return [least, most];
    return [first, last]; // a drive that turns back has its way from left to right all the same
  }

  private draw(): void {
    const { data, svg, wide } = this;
    if (!data) return;
    svg.replaceChildren();
    const symbol = [data.x.label, data.x.unit].filter((one) => one && one !== "1").join(", "), long = 7 * symbol.length > 0.12 * wide;
    // a long name of the abscissa stands below its numbers
    const TALL = TALLEST + (long ? 15 : 0), LOWER = LOWEST + (long ? 15 : 0), named = long ? 0 : 8 * symbol.length + 22;
    svg.setAttribute("viewBox", `0 0 ${wide} ${TALL}`);
    let least = Infinity, most = -Infinity;
    for (const line of data.lines) for (let k = 0; k < line.values.length; k += 1) {
      const value = line.values[k]!;
      if (!Number.isFinite(value)) continue;
      if (value < least) least = value;
      if (value > most) most = value;
    }
    const seen = least <= most, from = least, to = most;
    if (!seen) [least, most] = [-1, 1];
    const size = Math.max(Math.abs(least), Math.abs(most));
    if (most - least < 1e-6 * size || most === least) [least, most] = [least - (0.1 * size || 1), most + (0.1 * size || 1)];
    const room = 0.06 * (most - least);
    least -= room;
    most += room;
    this.greatest = size;
    const [low, high] = this.range();
    const x = (value: number): number => LEFT + ((wide - LEFT - RIGHT) * (value - low)) / (high - low || 1);
    const y = (value: number): number => TALL - LOWER - ((TALL - LOWER - UPPER) * (value - least)) / (most - least);
    const abscissa = data.x.values;
    for (const band of data.bands ?? []) {
      const a = x(abscissa[band.from]!), b = x(abscissa[band.to]!);
      make("rect", { class: "band", x: Math.min(a, b), y: UPPER, width: Math.abs(b - a), height: TALL - UPPER - LOWER }, svg);
    }
    for (const { from: begin, to: end } of data.shaded ?? []) {
      make("rect", { class: "held", x: Math.min(x(begin), x(end)), y: UPPER, width: Math.max(1, Math.abs(x(end) - x(begin))), height: TALL - UPPER - LOWER }, svg);
    }
    for (const mark of data.marks ?? []) {
      const at = x(between(abscissa, mark.at));
      make("line", { class: `mark ${mark.kind}`, x1: at, x2: at, y1: UPPER, y2: TALL - LOWER }, svg);
    }
    let free = LEFT + 4; // so far to the right the names reach: one that would cover another is told by its line alone
    for (const one of [...(data.places ?? [])].sort((a, b) => x(a.at) - x(b.at))) {
      const at = x(one.at), half = 3.4 * one.label.length, middle = Math.min(Math.max(at, LEFT + 4 + half), wide - half);
      const line = make("line", { class: "mark change", x1: at, x2: at, y1: UPPER, y2: TALL - LOWER }, svg);
      make("title", {}, line).textContent = one.label;
      if (middle - half < free) continue;
      make("text", { class: "axis", x: middle, y: 13, "text-anchor": "middle" }, svg).textContent = one.label;
      free = middle + half + 6;
    }
    const [first, last] = [Math.min(low, high), Math.max(low, high)], vertical = steps(first, last, wide / 80, data.x.unit === "°");
    for (const tick of ticks(first, last, vertical)) {
      make("line", { class: "grid", x1: x(tick), x2: x(tick), y1: UPPER, y2: TALL - LOWER }, svg);
      if (wide - RIGHT - x(tick) < named) continue;
      make("text", { x: x(tick), y: TALL - LOWER + 16, "text-anchor": "middle" }, svg).textContent = tickText(tick, vertical);
    }
    const horizontal = steps(least, most, 5, data.unit === "°" && most - least > 20);
    for (const tick of ticks(least, most, horizontal)) {
      make("line", { class: Math.abs(tick) < 1e-9 * horizontal ? "zero" : "grid", x1: LEFT, x2: wide - RIGHT, y1: y(tick), y2: y(tick) }, svg);
      make("text", { x: LEFT - 6, y: y(tick) + 4, "text-anchor": "end" }, svg).textContent = tickText(tick, horizontal);
    }
    make("rect", { class: "box", x: LEFT, y: UPPER, width: wide - LEFT - RIGHT, height: TALL - LOWER - UPPER }, svg);
    make("text", { class: "axis", x: wide - RIGHT, y: TALL - 6, "text-anchor": "end" }, svg).textContent = symbol;
    make("text", { class: "axis", x: LEFT - 6, y: 12, "text-anchor": "end" }, svg).textContent = data.unit === "1" ? "" : data.unit;
    const looks = looksOf(data.lines);
    data.lines.forEach((line, k) => {
      let d = "", pen = false, before = NaN;
      const drawn = line.finer ?? { x: line.x ?? abscissa, values: line.values };
      for (let sample = 0; sample < drawn.values.length; sample += 1) {
        const value = drawn.values[sample]!, across = drawn.x[sample]!, known = Number.isFinite(value) && Number.isFinite(across);
        if (!line.x && Math.abs(across - before) > 0.5 * Math.abs(high - low)) pen = false; // a turn is over
        before = across;
        if (known) d += `${pen ? "L" : "M"}${digits(x(across))} ${digits(y(value))}`;
        pen = known;
      }
      make("path", { class: `line ${looks[k]}`, d }, svg);
    });
    this.cursor = this.seek ? make("line", { class: "cursor", y1: UPPER, y2: TALL - LOWER }, svg) : null;
    this.dots = this.seek ? data.lines.map((_line, k) => make("circle", { class: `spot ${looks[k]!.split(" ")[0]}`, r: 3.5 }, svg)) : [];
    this.place = (sample) => [x(between(abscissa, sample)), y];
    svg.setAttribute("aria-label", say("curve", { what: data.title, least: this.said(seen ? from : NaN), most: this.said(seen ? to : NaN) }));
    this.outputs = [];
    this.legend.replaceChildren(...data.lines.map((line, k) => {
      const entry = document.createElement("span"), sign = document.createElement("i"), output = document.createElement("span");
      entry.className = "entry";
      sign.className = looks[k]!;
      sign.ariaHidden = "true";
      this.outputs.push(output);
      entry.append(sign, this.seek ? `${line.label} = ` : line.label, output);
      return entry;
    }));
    this.show(this.at);
  }
  private place: (sample: number) => [number, (value: number) => number] = () => [0, () => 0];

  private said(value: number): string {
    return withUnit(fixed(value, this.greatest), this.data!.unit);
  }

  // The cursor at a place between samples.
  show(at: number): void {
    this.at = at;
    const { data, cursor } = this;
    if (!data || !cursor) return;
    const [x, y] = this.place(at);
    cursor.setAttribute("x1", digits(x));
    cursor.setAttribute("x2", digits(x));
    data.lines.forEach((line, k) => {
      const value = line.values[Math.round(at)] ?? NaN, seen = Number.isFinite(value);
      this.dots[k]!.setAttribute("display", seen ? "inline" : "none");
      if (seen) {
        this.dots[k]!.setAttribute("cx", digits(x));
        this.dots[k]!.setAttribute("cy", digits(y(value)));
      }
      const text = this.said(value);
      if (this.outputs[k]!.textContent !== text) this.outputs[k]!.textContent = text;
    });
  }
}

export const between = (values: ArrayLike<number>, at: number): number => {
  const low = Math.max(0, Math.min(values.length - 1, Math.floor(at))), first = values[low]!, next = values[low + 1] ?? first;
  return first + (at - low) * (next - first);
};
