// The page of gears: two sliders move a pair of wheels within its blocking contour. Whatever is shown the server computes.
import { refusal, token } from "./token";
import { typeset } from "./typeset";

type Point = [number, number];
interface Curve { name: string; label: string; blocks: boolean; lines: Point[][] }
interface Contour { first: Point; second: Point; inside: string[]; curves: Curve[] }
interface Pair {
  facts: [string, string][]; problems: string[]; works: boolean; teeth: { wheel: number; line: Point[] }[];
  circles: Point[][]; action: Point[]; pitch: number; text: string;
}
type Answer = Record<string, any> & { id: number; error?: { message: string; repair: string } };

const kept = (): string | null => {
  try {
    return localStorage.getItem("centrode.language");
  } catch {
    return null; // a forbidden store
  }
};
const wished = new URLSearchParams(location.search).get("language") ?? kept() ?? navigator.language.slice(0, 2);
const language = ["en", "ru", "uk"].includes(wished) ? wished : "en";
document.documentElement.lang = language;

// One request in flight; of those that wait the last of each kind is sent.
class Line {
  private socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(token)}`);
  private waiting = new Map<string, { request: object; resolve: (answer: Answer) => void }>();
  private flying: ((answer: Answer) => void) | null = null;
  private number = 0;
  constructor(lost: () => void) {
    this.socket.onopen = () => this.next();
    this.socket.onclose = lost;
    this.socket.onmessage = (event) => {
      const answer = JSON.parse(event.data as string) as Answer, take = this.flying;
      if (answer.id !== this.number) return;
      this.flying = null;
      take?.(answer);
      this.next();
    };
  }
  ask(want: string, pair?: object): Promise<Answer> {
    return new Promise((resolve) => {
      this.waiting.set(want, { request: { do: "gears", language, want, pair }, resolve });
      this.next();
    });
  }
  private next(): void {
    if (this.flying || this.socket.readyState !== WebSocket.OPEN) return;
    const first = this.waiting.entries().next().value;
    if (!first) return;
    this.waiting.delete(first[0]);
    this.flying = first[1].resolve;
    this.socket.send(JSON.stringify({ ...first[1].request, id: ++this.number }));
  }
}

const make = <K extends keyof HTMLElementTagNameMap>(name: K, properties: Partial<HTMLElementTagNameMap[K]> = {}, ...children: (Node | string)[]): HTMLElementTagNameMap[K] => {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
};
const draw = (name: string, attributes: Record<string, string | number>): SVGElement => {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  return element;
};
// Looks of a curve: its colour by what it bounds, dashed for the wheel, heavy where a pair beyond it cannot work.
const looks = (one: Curve): string => `curve ${one.name.replace(/_[12]$/, "").replace(".", "-")}${one.name.endsWith("_2") ? " second" : ""}${one.blocks ? " blocks" : ""}`;
const sample = (one: Curve): SVGElement => {
  const drawn = draw("svg", { class: "sample", viewBox: "0 0 34 10", "aria-hidden": "true" });
  drawn.append(draw("path", { class: looks(one), d: "M1 5H33" }));
  return drawn;
};
const path = (line: Point[]): string => line.map(([x, y], k) => `${k ? "L" : "M"}${x} ${-y}`).join("");

async function begin(): Promise<void> {
  const root = document.getElementById("gears")!;
  if (refusal && !token) {
    root.textContent = refusal;
    return;
  }
  const problems = make("p", { id: "problems" });
  problems.setAttribute("role", "status");
  let lost = refusal; // a page that is loaded again has kept its token, which a new server does not take
  const line = new Line(() => {
    problems.textContent = lost;
    problems.className = "";
    if (!problems.isConnected) root.append(problems);
  });
  const words = (await line.ask("words")).words as Record<string, string>;
  lost = words.lost!;
  document.title = words.title!;
  const number = (id: string, value: number, least: number, step: number) => make("input", { id, type: "number", value: String(value), min: String(least), step: String(step) });
  const slider = (id: string, value: number) => make("input", { id, type: "range", min: "-1", max: "1.6", step: "0.01", value: String(value) });
  const module = number("module", 3, 0.1, 0.1), pinion = number("pinion", 12, 4, 1), wheel = number("wheel", 24, 4, 1);
  const internal = make("input", { id: "internal", type: "checkbox" });
  const first = slider("first", 0.6), second = slider("second", 0.36);
  const shown = [make("output"), make("output")];
  const facts = make("table", { id: "facts" }), text = make("pre", { id: "text" });
  const contour = draw("svg", { id: "contour", role: "img", "aria-label": words.contour! }), mesh = draw("svg", { id: "mesh", role: "img", "aria-label": words.mesh! });
  const legend = make("ul", { id: "legend" });
  const place = draw("circle", { class: "place", id: "place", r: 0.03 });
  root.append(
    make("section", {}, make("h1", { textContent: words.title! }),
      make("label", {}, words.module!, module), make("label", {}, words.pinion!, pinion), make("label", {}, words.wheel!, wheel), make("label", {}, words.internal!, internal),
      make("label", { className: "slider" }, words.first!, shown[0]!, first), make("label", { className: "slider" }, words.second!, shown[1]!, second),
      problems, facts, make("h2", { textContent: words.text! }), text),
    make("section", {}, make("h2", { textContent: words.contour! }), contour, legend),
    make("section", {}, make("h2", { textContent: words.mesh! }), mesh));

  const pair = () => ({
    module: `${module.value} mm`, teeth: [Number(pinion.value), Number(wheel.value)], internal: internal.checked,
    shifts: [Number(first.value), Number(second.value)],
  });
  const refuse = (answer: Answer): boolean => {
    if (!answer.error) return false;
    problems.className = "";
    problems.textContent = [answer.error.message, answer.error.repair].filter(Boolean).join("; ");
    return true;
  };
  const drawContour = (got: Contour): void => {
    const [low, high] = got.first, [below, above] = got.second, rows = got.inside.length;
    contour.setAttribute("viewBox", `${low} ${-above} ${high - low} ${above - below}`);
    const wide = (high - low) / (rows - 1), tall = (above - below) / (rows - 1);
    const cells = got.inside.flatMap((row, up) => [...row.matchAll(/1+/g)].map((run) => `M${low + (run.index - 0.5) * wide} ${-(below + (up - 0.5) * tall)}h${run[0].length * wide}v${-tall}h${-run[0].length * wide}z`));
    contour.replaceChildren(draw("path", { class: "inside", d: cells.join("") }),
      draw("path", { class: "axis", d: `M${low} 0H${high}M0 ${-below}V${-above}` }),
      ...got.curves.map((one) => { const drawn = draw("path", { class: looks(one), d: one.lines.map(path).join("") }); const title = draw("title", {}); title.textContent = one.label; drawn.append(title); return drawn; }), place);
    const size = (high - low) / 28, words: SVGElement[] = [];
    const write = (x: number, y: number, text: string, anchor: string): void => {
      const written = draw("text", { x, y: -y, "font-size": size, "text-anchor": anchor });
      written.textContent = text;
      words.push(written);
    };
    const number = (value: number): string => typeset(value.toLocaleString(language, { maximumFractionDigits: 1 }));
    const inner = (from: number, to: number): number[] => Array.from({ length: Math.floor(2 * (to - from)) }, (_, k) => Math.ceil(2 * from) / 2 + k / 2).filter((value) => value > from + 2 * size && value < to - 2 * size);
    for (const value of inner(low, high)) if (value) write(value, below + 0.3 * size, number(value), "middle");
    for (const value of inner(below, above)) write(low + 0.3 * size, value - 0.35 * size, number(value), "start");
    write(high - 0.3 * size, below + 0.3 * size, "x₁", "end");
    write(low + 0.3 * size, above - size, "x₂", "start");
    contour.append(...words);
    legend.replaceChildren(...got.curves.map((one) => make("li", {}, sample(one), one.label)));
    for (const [input, [from, to]] of [[first, got.first], [second, got.second]] as const) {
      input.min = from.toFixed(2);
      input.max = to.toFixed(2);
    }
  };
  const drawPair = (got: Pair): void => {
    const half = 2.6 * Math.PI * Number(module.value);
    mesh.setAttribute("viewBox", `${-half} ${-got.pitch - half} ${2 * half} ${2 * half}`);
    mesh.replaceChildren(...got.circles.map((one) => draw("path", { class: "circle", d: path(one) })),
      ...got.teeth.map((one) => draw("path", { class: one.wheel ? "tooth wheel" : "tooth", d: path(one.line) })), draw("path", { class: "action", d: path(got.action) }));
    facts.replaceChildren(...got.facts.map(([label, value]) => make("tr", {}, make("td", { textContent: label }), make("td", { textContent: typeset(value) }))));
    problems.className = got.works ? "works" : "";
    problems.textContent = got.problems.join(" ");
    text.textContent = got.text;
  };
  const move = async (): Promise<void> => {
    [first, second].forEach((input, k) => { shown[k]!.textContent = typeset(Number(input.value).toLocaleString(language, { minimumFractionDigits: 2 })); });
    place.setAttribute("cx", first.value);
    place.setAttribute("cy", String(-Number(second.value)));
    const got = await line.ask("pair", pair());
    if (!refuse(got)) drawPair(got as unknown as Pair);
  };
  const change = async (): Promise<void> => {
    const got = await line.ask("contour", pair());
    if (refuse(got)) return;
    drawContour(got as unknown as Contour);
    await move();
  };
  for (const input of [first, second]) input.addEventListener("input", () => void move());
  for (const input of [module, pinion, wheel, internal]) input.addEventListener("change", () => void change());
  await change();
}

void begin();
