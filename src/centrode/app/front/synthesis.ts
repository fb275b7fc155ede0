// The page of syntheses: a path or poses drawn here, a function or strokes written, mechanisms for it that the server finds, one of them
// for the workbench. What is sought is a new linkage, or other dimensions of the mechanism that is open in the workbench.
import { pack } from "./share";
import { typeset } from "./typeset";

type Point = [number, number];
type Target = [number, number, number];
interface Found { facts: [string, string][]; curve: Point[]; met: Point[]; points: Record<string, Point>; fixed: string[]; links: string[][]; text: string; whole: boolean }
interface Offer { title: string; points: string[]; links: string[]; outputs: string[]; crank: string | null; drive: string; numbers: { path: string; name: string; least: number; greatest: number; chosen: boolean }[]; sheet: Found }
type Answer = Record<string, any> & { id: number; error?: { message: string; repair: string } };

const given = JSON.parse(document.querySelector<HTMLMetaElement>('meta[name="workbench"]')!.content || "{}") as { token?: string; refused?: string };
const TOKEN = "centrode.token", LANGUAGE = "centrode.language"; // the workbench keeps them by these names too
const chosen = (): string | null => { try { return localStorage.getItem(LANGUAGE); } catch { return null; } };
const wished = new URLSearchParams(location.search).get("language") ?? chosen() ?? navigator.language.slice(0, 2);
const language = ["en", "ru", "uk"].includes(wished) ? wished : "en";
document.documentElement.lang = language;
const token = given.token ?? sessionStorage.getItem(TOKEN) ?? "";
if (given.token) {
  sessionStorage.setItem(TOKEN, given.token);
  history.replaceState(null, "", location.pathname);
}

// Requests by their numbers: the search is in flight while others ask how far it is.
class Line {
  private socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(token)}`);
  private flying = new Map<number, (answer: Answer) => void>();
  private number = 0;
  private open: Promise<void>;
  constructor(lost: () => void) {
    this.open = new Promise((resolve) => { this.socket.onopen = () => resolve(); });
    this.socket.onclose = lost;
    this.socket.onmessage = (event) => {
      const answer = JSON.parse(event.data as string) as Answer, take = this.flying.get(answer.id);
      this.flying.delete(answer.id);
      take?.(answer);
    };
  }
  async ask(request: object): Promise<Answer> {
    await this.open;
    const id = ++this.number;
    return new Promise((resolve) => {
      this.flying.set(id, resolve);
      this.socket.send(JSON.stringify({ language, ...request, id }));
    });
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
const path = (line: Point[], closed = false): string => line.map(([x, y], k) => `${k ? "L" : "M"}${x} ${-y}`).join("") + (closed ? "z" : "");
const far = (a: Point, b: Point): number => Math.hypot(a[0] - b[0], a[1] - b[1]);

const TURN = 15; // degrees
interface Sheet { x: number; y: number; wide: number; tall: number; step: number } // millimetres: its middle, its sides, a step of the cross
const PAPER: Sheet = { x: 0, y: 0, wide: 240, tall: 160, step: 5 };
const STEPS = 48; // of the cross, from side to side

// A sheet on which a mechanism stands with room around it.
function sheetOf(one: Found): Sheet {
  const places = Object.values(one.points), xs = places.map(([x]) => x), ys = places.map(([, y]) => y);
  const left = Math.min(...xs), right = Math.max(...xs), below = Math.min(...ys), above = Math.max(...ys);
  const wide = 1.6 * Math.max(right - left, 1.5 * (above - below), 1), fine = wide / STEPS, ten = 10 ** Math.floor(Math.log10(fine));
  return { x: (left + right) / 2, y: (below + above) / 2, wide, tall: wide / 1.5, step: ([1, 2, 5].find((one) => one * ten >= fine) ?? 10) * ten };
}

// The text that the workbench has in this window, or had last: with what is kept beside it.
const STORE = "centrode.workbench";
function keptBench(): { text: string; before?: unknown[] } | null {
  for (const store of ["sessionStorage", "localStorage"] as const) {
    try {
      const state = JSON.parse(window[store].getItem(STORE) ?? "null");
      if (state && typeof state.text === "string") return state;
    } catch {
      // a forbidden store, or another one's
    }
  }
  return null;
}
// The workbench begins with another text, and Undo brings back the one before; false where nothing can be kept.
function putIntoBench(text: string): boolean {
  const state = keptBench();
  if (!state) return false;
  try {
    sessionStorage.setItem(STORE, JSON.stringify({ ...state, text, before: [...(Array.isArray(state.before) ? state.before : []), state.text] }));
    return true;
  } catch {
    return false;
  }
}
const CLOSED_POINTS = 20, OPEN_POINTS = 15; // of a line that is dragged
const BETWEEN = 250; // ms between two questions how far the search is

// A dragged line as points at equal distances along it.
function spread(line: Point[], closed: boolean): Point[] {
  const round = closed ? [...line, line[0]!] : line;
  const along = [0];
  for (let k = 1; k < round.length; k += 1) along.push(along[k - 1]! + far(round[k - 1]!, round[k]!));
  const whole = along[along.length - 1]!, count = closed ? CLOSED_POINTS : OPEN_POINTS, spots: Point[] = [];
  let at = 1;
  for (let k = 0; k < count; k += 1) {
    const wanted = (whole * k) / (closed ? count : count - 1);
    while (at < along.length - 1 && along[at]! < wanted) at += 1;
    const part = (wanted - along[at - 1]!) / (along[at]! - along[at - 1]! || 1), a = round[at - 1]!, b = round[at]!;
    spots.push([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])]);
  }
  return spots;
}

// The linkage in its first position with what its point traces.
function pictured(one: Found): SVGElement[] {
  const bars = one.links.map((names) => names.map((name) => one.points[name]!)).filter((line) => line.length > 1);
  return [
    draw("path", { class: "links", d: bars.map((line) => path(line, line.length > 2)).join("") }),
    ...(one.curve.length ? [draw("path", { class: "traced", d: path(one.curve) })] : []),
  ];
}
function box(points: Point[], margin: number): [number, number, number, number] {
  const xs = points.map(([x]) => x), ys = points.map(([, y]) => -y);
  const [left, top] = [Math.min(...xs), Math.min(...ys)], [wide, tall] = [Math.max(...xs) - left, Math.max(...ys) - top], edge = margin * Math.max(wide, tall, 1);
  return [left - edge, top - edge, wide + 2 * edge, tall + 2 * edge];
}

async function begin(): Promise<void> {
  const root = document.getElementById("synthesis")!;
  if (given.refused) {
    root.textContent = given.refused;
    return;
  }
  const said = make("p", { id: "said" });
  said.setAttribute("role", "status");
  let lost = "";
  const line = new Line(() => { said.textContent = lost; });
  const words = (await line.ask({ do: "synthesis", want: "words" })).words as Record<string, string>;
  lost = words.lost!;
  document.title = `${words.title} – centrode`;

  const open = keptBench()?.text.trim() ? keptBench()!.text : null;
  const asked = open === null ? null : await line.ask({ do: "synthesis", want: "mechanism", text: open });
  const offer = asked && !asked.error ? (asked as unknown as Offer) : null;
  const of = make("select", { id: "of_mechanism" }, make("option", { value: "new", textContent: words.new_mechanism! }));
  if (offer) of.append(make("option", { value: "open", textContent: words.open_mechanism!.replace("{title}", offer.title || words.untitled!) }));
  const isOpen = (): boolean => of.value === "open";
  const names = (id: string, given: string[]) => make("select", { id }, ...given.map((one) => make("option", { value: one, textContent: one })));
  const point = names("point", offer?.points ?? []), link = names("link", offer?.links ?? []), output = names("output", offer?.outputs ?? []);
  const bounds = make("fieldset", { id: "bounds" }, make("legend", { textContent: words.bounds! }));
  const ranges = (offer?.numbers ?? []).map((one) => {
    const box = make("input", { type: "checkbox", checked: one.chosen }), id = `free ${one.path}`;
    const end = (value: number, word: string) => {
      const field = make("input", { type: "number", step: "any", value: String(value) });
      field.setAttribute("aria-label", words[word]!.replace("{name}", one.name));
      return field;
    };
    box.id = id;
    const least = end(one.least, "least"), greatest = end(one.greatest, "greatest_bound"), row = make("div", { className: "range" });
    const enable = (): void => { least.disabled = greatest.disabled = !box.checked; };
    box.addEventListener("change", enable);
    enable();
    row.append(box, make("label", { htmlFor: id, textContent: one.name }), least, greatest);
    bounds.append(row);
    return { path: one.path, box, least, greatest };
  });
  const kind = make("select", { id: "kind" }, ...["path", "motion", "function", "strokes"].map((one) => make("option", { value: one, textContent: words[one]! })));
  const check = (id: string, checked: boolean) => make("input", { id, type: "checkbox", checked });
  const closed = check("closed", true), crank = check("crank", true), order = check("order", true);
  const number = (id: string, value: string, properties: Partial<HTMLInputElement> = {}) => make("input", { id, type: "number", step: "any", value, ...properties });
  const choice = (id: string, names: string[], word: (name: string) => string) => make("select", { id }, ...names.map((one) => make("option", { value: one, textContent: words[word(one)]! })));
  const labelled = (field: HTMLElement, word: string, kinds: string, whose = "") => {
    const row = make("label", {}, words[word]!, field);
    row.dataset.kinds = kinds; // of requests that have this field
    row.dataset.whose = whose; // of a new mechanism, or of the open one
    return row;
  };
  const formula = make("input", { id: "formula", type: "text", value: "log(x)/log(10)", spellcheck: false });
  const from = number("x_from", "1"), to = number("x_to", "2"), turns = number("swing_crank", "60"), swings = number("swing_rocker", "90");
  const topology = choice("topology", ["crank-rocker", "slider-crank-offset", "shaper", "whitworth-quick-return", "six-bar-press"], (one) => one);
  const stroke = number("stroke", "100", { min: "0" }), swing = number("swing", "40", { min: "0" }), slow = number("time_ratio", "1.25", { min: "1" });
  const trade = choice("trade_off", ["none", "size", "transmission"], (one) => `trade_off_${one}`);
  const transmission = make("input", { id: "transmission", type: "number", min: "0", max: "89", step: "1" });
  const ratio = make("input", { id: "length_ratio", type: "number", min: "1", step: "0.5", value: "6" });
  const size = make("input", { id: "size", type: "number", min: "0", step: "10", value: "500" });
  const rows = make("textarea", { id: "targets", spellcheck: false }), rowsName = make("span");
  const hint = make("p", { className: "hint", id: "hint" });
  const clear = make("button", { type: "button", id: "clear", textContent: words.clear! });
  const search = make("button", { type: "button", id: "search", className: "first", textContent: words.search! });
  const stop = make("button", { type: "button", id: "stop", textContent: words.stop!, hidden: true });
  const share = make("progress", { id: "share", max: 1, value: 0, hidden: true });
  share.setAttribute("aria-label", words.searching!);
  const canvas = draw("svg", { id: "canvas", tabindex: 0, role: "application", "aria-label": words.drawing!, "aria-describedby": "hint" }) as SVGSVGElement;
  const list = make("ul", { id: "answers" });
  const insert = make("button", { type: "button", id: "insert", className: "first", textContent: words.insert!, disabled: true });
  const checkRow = (box: HTMLInputElement, word: string) => make("label", { className: "check" }, box, word);
  const closedRow = checkRow(closed, words.closed!), crankRow = checkRow(crank, words.crank!), orderRow = checkRow(order, words.order!);
  closedRow.dataset.kinds = "path";
  crankRow.dataset.kinds = orderRow.dataset.kinds = "path motion";
  const rowsRow = make("label", { className: "rows" }, rowsName, rows);
  rowsRow.dataset.kinds = "path motion function";
  const ofRow = make("label", { hidden: !offer }, words.of_mechanism!, of);
  bounds.dataset.kinds = "path motion function strokes";
  bounds.dataset.whose = "open";
  root.append(
    make("section", {}, make("h1", { textContent: words.title! }), make("p", { textContent: words.lead! }),
      ofRow, make("label", {}, words.wanted!, kind),
      labelled(point, "point", "path motion", "open"), labelled(link, "link", "motion", "open"), labelled(output, "output", "function strokes", "open"),
      labelled(topology, "topology", "strokes", "new"), labelled(stroke, "wanted_stroke", "strokes"), labelled(swing, "wanted_swing", "strokes"), labelled(slow, "wanted_time_ratio", "strokes"),
      labelled(formula, "formula", "function", "new"), labelled(from, "x_from", "function", "new"), labelled(to, "x_to", "function", "new"),
      labelled(turns, "swing_crank", "function", "new"), labelled(swings, "swing_rocker", "function", "new"),
      closedRow, crankRow, orderRow,
      labelled(transmission, "transmission", "path motion function strokes"), labelled(ratio, "length_ratio", "path motion function"), labelled(size, "most_size", "path motion"),
      labelled(trade, "trade_off", "path", "new"), rowsRow, bounds,
      make("div", { className: "acts" }, search, stop, clear), share, said,
      make("a", { href: "/", textContent: words.workbench!, id: "workbench" })),
    make("section", {}, make("h2", { textContent: words.drawing! }), canvas, hint),
    make("section", {}, make("h2", { textContent: words.answers! }), list, make("div", { className: "acts" }, insert)));

  let targets: Target[] = [], found: Found[] = [], shown = -1, dragged: Point[] | null = null;
  let cross: Target = [0, 0, 0], sheet = PAPER;
  const poses = (): boolean => kind.value === "motion", draws = (): boolean => poses() || kind.value === "path";
  const round = (value: number): number => Math.round(value * 100) / 100;

  const paint = (): void => {
    const { x: midX, y: midY, wide, tall, step } = sheet;
    const one = found[shown] ?? (isOpen() ? offer!.sheet : undefined), base: Point[] = [[midX - wide / 2, midY - tall / 2], [midX + wide / 2, midY + tall / 2]];
    const view = one ? box([...(draws() || isOpen() ? base : []), ...one.curve, ...Object.values(one.points)], 0.03) : box(base, 0);
    canvas.setAttribute("viewBox", view.join(" "));
    const unit = Math.max(view[2] / PAPER.wide, view[3] / PAPER.tall);
    const lines = [], [[left, below], [right, above]] = base as [Point, Point];
    if (draws()) for (let x = Math.ceil(left / (4 * step)) * 4 * step; x <= right; x += 4 * step) lines.push(`M${x} ${-above}V${-below}`);
    if (draws()) for (let y = Math.ceil(below / (4 * step)) * 4 * step; y <= above; y += 4 * step) lines.push(`M${left} ${-y}H${right}`);
    const spots = targets.map(([x, y]) => [x, y] as Point);
    const parts: SVGElement[] = [draw("path", { class: "grid", d: lines.join("") })];
    if (one) parts.push(...pictured(one));
    if (dragged) parts.push(draw("path", { class: "wanted", d: path(dragged) }));
    if (kind.value === "path" && spots.length > 1) parts.push(draw("path", { class: "wanted", d: path(spots, closed.checked) }));
    for (const [x, y, turn] of draws() ? targets : []) {
      const along: Point = [Math.cos((turn * Math.PI) / 180) * 12 * unit, Math.sin((turn * Math.PI) / 180) * 12 * unit];
      if (poses()) parts.push(draw("path", { class: "pose", d: path([[x, y], [x + along[0], y + along[1]]]) }));
      parts.push(draw("circle", { class: "target", cx: x, cy: -y, r: 1.6 * unit }));
    }
    if (one) {
      for (const [name, [x, y]] of Object.entries(one.points)) parts.push(draw("circle", { class: one.fixed.includes(name) ? "fixed" : "hinge", cx: x, cy: -y, r: 1.7 * unit }));
    }
    if (draws() && document.activeElement === canvas) {
      const [x, y, turn] = cross, size = 4 * unit;
      parts.push(draw("path", { class: "cross", d: `M${x - size} ${-y}h${2 * size}M${x} ${-y - size}v${2 * size}` }));
      if (poses()) parts.push(draw("path", { class: "cross", d: path([[x, y], [x + 12 * unit * Math.cos((turn * Math.PI) / 180), y + 12 * unit * Math.sin((turn * Math.PI) / 180)]]) }));
    }
    canvas.replaceChildren(...parts);
  };
  const write = (): void => { rows.value = targets.map((one) => one.slice(0, poses() ? 3 : 2).map(round).join("  ")).join("\n"); };
  const forget = (): void => {
    found = [];
    shown = -1;
    list.replaceChildren();
    insert.disabled = true;
  };
  const put = (next: Target[]): void => {
    targets = next;
    forget();
    write();
    paint();
  };
  const read = (): void => {
    targets = rows.value.split("\n").map((row) => row.trim().split(/[\s;]+/).map((one) => Number(one.replace(",", "."))))
      .filter((row) => row.length >= 2 && row.every(Number.isFinite)).map(([x, y, turn]) => [x!, y!, turn ?? 0]);
    forget();
    paint();
  };
  // A rocker has a swing, every other output of strokes a way of its slider.
  const choose = (): void => {
    if (kind.value !== "strokes") return;
    const rocks = isOpen() ? output.value.startsWith("angle") : topology.value === "crank-rocker";
    swing.parentElement!.hidden = !rocks;
    stroke.parentElement!.hidden = rocks;
  };
  const change = (): void => {
    hint.textContent = (isOpen() && words[`hint_${kind.value}_own`]) || words[`hint_${kind.value}`]!;
    rowsName.textContent = words[kind.value === "path" ? "targets" : isOpen() && kind.value === "function" ? "targets_own" : `targets_${kind.value}`] ?? "";
    for (const row of root.querySelectorAll<HTMLElement>("[data-kinds]")) {
      row.hidden = !row.dataset.kinds!.split(" ").includes(kind.value) || Boolean(row.dataset.whose && row.dataset.whose !== of.value);
    }
    // the least error alone leads to linkages that hardly transmit anything, or have links without end
    if (!transmission.dataset.own) transmission.value = !isOpen() && kind.value === "function" ? "30" : "";
    crankRow.hidden ||= isOpen() && !offer!.crank;
    choose();
    clear.hidden = !draws();
    put([]);
  };

  // the hand
  const spot = (event: PointerEvent): Point => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(canvas.getScreenCTM()!.inverse());
    return [round(at.x), round(-at.y)];
  };
  canvas.addEventListener("pointerdown", (event) => {
    if (!draws()) return;
    canvas.setPointerCapture(event.pointerId);
    dragged = [spot(event)];
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!dragged) return;
    dragged.push(spot(event));
    paint();
  });
  const drop = (): void => {
    if (!dragged) return;
    const drawn = dragged, first = drawn[0]!, last = drawn[drawn.length - 1]!;
    dragged = null;
    const reach = Math.max(...drawn.map((one) => far(one, first)));
    cross = [last[0], last[1], cross[2]];
    if (poses()) {
      const turn = far(first, last) > 0.6 * sheet.step ? round((Math.atan2(last[1] - first[1], last[0] - first[0]) * 180) / Math.PI) : 0;
      put([...targets, [first[0], first[1], turn]]);
    } else if (reach < 0.6 * sheet.step) {
      put([...targets, [first[0], first[1], 0]]);
    } else {
      closed.checked = far(first, last) < 0.25 * reach;
      put(spread(drawn, closed.checked).map(([x, y]) => [round(x), round(y), 0]));
    }
  };
  canvas.addEventListener("pointerup", drop);
  canvas.addEventListener("pointercancel", () => { dragged = null; paint(); });
  canvas.addEventListener("focus", paint);
  canvas.addEventListener("blur", paint);
  canvas.addEventListener("keydown", (event) => {
    if (!draws()) return;
    const step = event.shiftKey ? 4 * sheet.step : sheet.step, [x, y, turn] = cross;
    const moved: Record<string, Target> = {
      ArrowLeft: [x - step, y, turn], ArrowRight: [x + step, y, turn], ArrowUp: [x, y + step, turn], ArrowDown: [x, y - step, turn],
      ",": [x, y, turn + TURN], ".": [x, y, turn - TURN],
    };
    if (moved[event.key]) cross = moved[event.key]!;
    else if (event.key === "Enter" || event.key === " ") put([...targets, [...cross]]);
    else if (event.key === "Backspace") put(targets.slice(0, -1));
    else return;
    event.preventDefault();
    paint();
  });

  const show = (number: number): void => {
    shown = number;
    [...list.querySelectorAll("button")].forEach((one, k) => one.setAttribute("aria-pressed", String(k === number)));
    insert.disabled = number < 0;
    if (isOpen() && found[number] && !found[number]!.whole) said.textContent = words.replaced!;
    paint();
  };
  const cards = (): void => {
    list.replaceChildren(...found.map((one, k) => {
      const small = draw("svg", { viewBox: box([...one.curve, ...Object.values(one.points)], 0.06).join(" "), "aria-hidden": "true" });
      small.append(...pictured(one));
      const facts = one.facts.map(([name, value]) => make("span", {}, `${words[name]}: `, make("b", { textContent: typeset(value) })));
      const card = make("button", { type: "button", className: "card" });
      card.append(small, make("span", {}, make("b", { textContent: words.answer!.replace("{number}", String(k + 1)) }), ...facts));
      card.addEventListener("click", () => show(k));
      return make("li", {}, card);
    }));
  };

  // What the fields ask for, as a table [synthesis].
  const degrees = (field: HTMLInputElement): string => `${field.value} deg`;
  const ofOpen = (): Record<string, unknown> => {
    const constraints: Record<string, unknown> = {}, turns = output.value.startsWith("angle");
    if (Number(transmission.value) > 0) constraints.transmission = degrees(transmission);
    if (kind.value !== "strokes" && Number(ratio.value) > 0) constraints.length_ratio = Number(ratio.value);
    const free = Object.fromEntries(ranges.filter((one) => one.box.checked).map((one) => [one.path, [`${one.least.value} mm`, `${one.greatest.value} mm`]]));
    if (kind.value === "strokes") {
      const own = turns ? { swing: degrees(swing) } : { stroke: `${stroke.value} mm` };
      return { kind: "strokes", of: output.value, ...own, ...(Number(slow.value) > 0 ? { time_ratio: Number(slow.value) } : {}), free, constraints };
    }
    if (kind.value === "function") {
      return { kind: "function", of: output.value, targets: targets.map(([at, other]) => [`${at} ${offer!.drive}`, `${other} ${turns ? "deg" : "mm"}`]), free, constraints };
    }
    constraints.order = order.checked;
    if (crank.checked && offer!.crank) constraints.crank = offer!.crank;
    if (Number(size.value) > 0) constraints.size = [`${size.value} mm`, `${size.value} mm`];
    const places = targets.map(([x, y, turn]) => [`${x} mm`, `${y} mm`, ...(poses() ? [`${turn} deg`] : [])]);
    if (poses()) return { kind: "motion", point: point.value, link: link.value, targets: places, free, constraints };
    return { kind: "path", point: point.value, targets: places, closed: closed.checked, free, constraints };
  };
  const request = (): Record<string, unknown> => {
    if (isOpen()) return ofOpen();
    const angle = Number(transmission.value) > 0 ? { transmission: degrees(transmission) } : {};
    if (kind.value === "strokes") {
      const own = topology.value === "crank-rocker" ? { swing: degrees(swing) } : { stroke: `${stroke.value} mm` };
      return { kind: "strokes", topology: topology.value, ...own, time_ratio: Number(slow.value), ...angle };
    }
    if (kind.value === "function") {
      const table = targets.length ? { targets: targets.map(([turn, other]) => [`${turn} deg`, `${other} deg`]) }
        : { formula: formula.value, x: [Number(from.value), Number(to.value)], swings: [degrees(turns), degrees(swings)] };
      return { kind: "function", ...table, constraints: { ...angle, ...(Number(ratio.value) > 0 ? { length_ratio: Number(ratio.value) } : {}) } };
    }
    const constraints: Record<string, unknown> = { order: order.checked, ...angle };
    if (crank.checked) constraints.crank = "OA";
    if (Number(ratio.value) > 0) constraints.length_ratio = Number(ratio.value);
    if (Number(size.value) > 0) constraints.size = [`${size.value} mm`, `${size.value} mm`];
    const places = targets.map(([x, y, turn]) => [`${x} mm`, `${y} mm`, ...(poses() ? [`${turn} deg`] : [])]);
    if (poses()) return { kind: "motion", targets: places, constraints };
    return { kind: "path", targets: places, constraints, closed: closed.checked, ...(trade.value === "none" ? {} : { trade_off: trade.value }) };
  };

  let ticket = "", wantsEnd = false;
  const follow = async (mine: string): Promise<void> => {
    while (ticket === mine) {
      const state = await line.ask({ do: "synthesis", want: wantsEnd ? "stop" : "progress", ticket: mine });
      if (typeof state.share === "number") share.value = Math.max(share.value, state.share);
      await new Promise((resolve) => setTimeout(resolve, BETWEEN));
    }
  };
  search.addEventListener("click", async () => {
    if (ticket) return;
    const mine = [...crypto.getRandomValues(new Uint8Array(16))].map((one) => one.toString(16).padStart(2, "0")).join("");
    ticket = mine;
    wantsEnd = false;
    forget();
    paint();
    said.textContent = "";
    share.value = 0;
    search.disabled = true;
    share.hidden = stop.hidden = false;
    stop.disabled = false;
    void follow(mine);
    const got = await line.ask({ do: "synthesise", ticket: mine, wanted: request(), ...(isOpen() ? { text: open } : {}) });
    ticket = "";
    search.disabled = false;
    share.hidden = stop.hidden = true;
    if (got.error) {
      said.textContent = [got.error.message, got.error.repair].filter(Boolean).join("; ");
      return;
    }
    found = got.answers as Found[];
    if (!got.complete) said.textContent = words.stopped!;
    cards();
    show(found.length ? 0 : -1);
  });
  stop.addEventListener("click", () => { wantsEnd = true; stop.disabled = true; });
  insert.addEventListener("click", async () => {
    const one = found[shown];
    if (!one) return;
    if (isOpen() && putIntoBench(one.text)) location.href = "/";
    else location.href = `/#m=${await pack(one.text)}`;
  });
  clear.addEventListener("click", () => put([]));
  rows.addEventListener("input", read);
  closed.addEventListener("change", () => { forget(); paint(); });
  for (const field of [formula, from, to, turns, swings, stroke, swing, slow]) field.addEventListener("input", () => { forget(); paint(); });
  transmission.addEventListener("input", () => { transmission.dataset.own = "yes"; });
  topology.addEventListener("change", () => { choose(); forget(); paint(); });
  trade.addEventListener("change", () => { forget(); paint(); });
  kind.addEventListener("change", change);
  of.addEventListener("change", () => {
    sheet = isOpen() ? sheetOf(offer!.sheet) : PAPER;
    cross = [Math.round(sheet.x / sheet.step) * sheet.step, Math.round(sheet.y / sheet.step) * sheet.step, 0];
    // what bounds a new linkage on the sheet says nothing of one that has its size
    ratio.value = isOpen() ? "" : "6";
    size.value = isOpen() ? "" : "500";
    slow.value = isOpen() ? "" : "1.25";
    crank.checked = !isOpen();
    change();
  });
  output.addEventListener("change", () => { choose(); forget(); paint(); });
  for (const field of [point, link]) field.addEventListener("change", () => { forget(); paint(); });
  bounds.addEventListener("input", () => { forget(); paint(); });
  change();
}

void begin();
