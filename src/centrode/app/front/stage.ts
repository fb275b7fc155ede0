// The stage: the drawing, and what hand, keyboard and wheel do on it.
import { batch, effect } from "@preact/signals";
import { SUPERSEDED } from "./connection";
import { U, digits, minus, plus, roundStep, size } from "./outlines";
import { Globe, type Paper, Plane, angles, arc, fromAngles } from "./paper";
import { Picture, make } from "./picture";
import { photo, scalePhoto } from "./photo";
import { type Frame, type Place, type Reading, isFrame } from "./protocol";
import * as state from "./state";
import { ask, digest, drawn, edit, mode, motion, place, playing, resting, scene, selection, tell, topic } from "./state";
import { say, sentence, spelled, withUnit } from "./words";

const DEGREE = Math.PI / 180, DEGREE_STEPS = [1, 2, 5, 10, 15];
const NEAR = 14, NEAR_TOUCH = 24, NEAR_LINE = 9; // pixels
const MOVED = 5; // pixels that make a drag of a click

export interface Target {
  kind: "point" | "link" | "guide";
  name: string;
}
// A place between two points of a link.
interface Spot {
  from: string;
  to: string;
  share: number;
}
interface Line {
  from: Place;
  target: Target | null;
  to: Place;
  end: Target | null;
  guide: boolean;
}

export class Stage {
  readonly svg: SVGSVGElement;
  readonly picture: Picture;
  readonly plane = new Plane();
  readonly globe = new Globe();
  private readonly grid: SVGPathElement;
  private readonly heavy: SVGPathElement;
  private readonly axes: SVGPathElement;
  private readonly image: SVGImageElement;
  private readonly hint: SVGGElement;
  private readonly rubber: SVGRectElement;
  private readonly crosshair: SVGPathElement;
  private pointers = new Map<number, Place>();
  private gesture: { move?: (at: Place, event: PointerEvent) => void; end: (moved: boolean, event: PointerEvent | null) => void; cancel?: () => void } | null = null;
  private begun: Place = [0, 0];
  private moved = false;
  private cursor: Place | null = null; // of the keyboard
  private line: Line | null = null;
  private live: { points: Map<string, Place>; angles: Map<string, number> } | null = null;
  private built: unknown = null;
  private fitted = -1;
  private space = false;
  private fits = true; // until somebody zooms or draws

  constructor(private readonly holder: HTMLElement) {
    this.svg = make("svg", { class: "drawing", tabindex: 0, role: "application", "data-updates": 0 });
    holder.append(this.svg);
    this.image = make("image", { class: "photo", preserveAspectRatio: "none" }, this.svg);
    this.grid = make("path", { class: "grid-lines" }, this.svg);
    this.heavy = make("path", { class: "grid-lines heavy" }, this.svg);
    this.axes = make("path", { class: "grid-lines axes" }, this.svg);
    this.picture = new Picture(this.svg, this.plane);
    this.hint = make("g", { class: "sketch" }, this.svg);
    this.rubber = make("rect", { class: "rubber", display: "none" }, this.svg);
    this.crosshair = make("path", { class: "crosshair", display: "none", d: "M-140 0H-40M40 0H140M0 -140V-40M0 40V140" }, this.svg);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    effect(() => this.rebuild());
    effect(() => {
      const shows = state.shows.value;
      this.picture.layers.tracks.setAttribute("display", shows.paths ? "inline" : "none");
      this.picture.layers.names.setAttribute("display", shows.names ? "inline" : "none");
      this.picture.shows = shows;
      const block = state.arrows.value;
      this.picture.forces = block && block.kind === "arrows" ? block : null;
      drawn.value.place.value;
      this.draw();
    });
    effect(() => {
      photo.value;
      state.shows.value;
      this.ground();
    });
    effect(() => this.picture.mark(selection.value, state.readiness.value?.loose ?? []));
    effect(() => this.svg.setAttribute("aria-label", `${say("stage")}: ${scene.value?.title ?? ""}. ${say(`mode_${mode.value}_hint`)}`));
    effect(() => {
      this.svg.setAttribute("data-mode", mode.value);
      scalePhoto.value = null; // who chooses another mode does not measure any more
    });
  }

  private get paper(): Paper {
    return this.spherical ? this.globe : this.plane;
  }
  get spherical(): boolean {
    return scene.value?.kind === "sphere";
  }

  // --- what is drawn ---------------------------------------------------------------------------------------------
  private rebuild(): void {
    const now = scene.value, moving = drawn.value.motion, fits = state.fits.value;
    this.picture.paper = this.spherical ? this.globe : this.plane;
    this.picture.motion = moving && moving.digest === digest.peek() ? moving : null;
    if (!now) {
      this.built = null;
      return;
    }
    if (this.built !== now) {
      this.built = now;
      const focused = document.activeElement instanceof Element ? document.activeElement.getAttribute("data-name") : null;
      const kind = document.activeElement instanceof Element ? document.activeElement.getAttribute("data-kind") : null;
      this.picture.build(now, (element, name, what) => this.focusable(element, name, what));
      this.picture.mark(selection.peek(), state.readiness.peek()?.loose ?? []);
      if (focused && kind) this.svg.querySelector<SVGGElement>(`[data-kind="${kind}"][data-name="${CSS.escape(focused)}"]`)?.focus({ preventScroll: true });
    }
    if (this.fitted !== fits) {
      // once more when it is known how far it moves
      if (!now.points.length || this.picture.motion || state.still.value) this.fitted = fits;
      this.fit();
    }
    // what a topic has found goes elsewhere than the drives do
    const found = this.picture.motion?.course ? topic.peek() : "";
    if (this.found !== found) {
      this.found = found;
      if (this.fits) this.fit();
    }
    this.picture.showTracks();
    this.draw();
  }
  private found = "";

  private where(): { place: (name: string) => Place | null; angle: (link: string) => number } {
    const { live } = this, at = drawn.peek().place.peek();
    // the initial position of a motion that leaves it out is that of the description
    const initial = mode.peek() !== "move" && this.picture.motion === motion.peek() && !this.picture.motion?.holdsInitial && at === this.picture.motion?.start;
    const moving = initial ? null : this.picture.motion;
    const here = new Map(scene.peek()?.points.map((point) => [point.name, point.at]));
    return {
      place: (name) => live?.points.get(name) ?? (moving && moving.point(name) >= 0 ? moving.place(name, at) : null) ?? here.get(name) ?? null,
      angle: (link) => live?.angles.get(link) ?? (moving ? moving.angle(link, at) : NaN),
    };
  }

  draw(): void {
    this.picture.show(this.where(), this.picture.motion ? drawn.peek().place.peek() : null);
  }

  private resize(): void {
    const wide = Math.max(100, this.holder.clientWidth), high = Math.max(100, this.holder.clientHeight);
    if (wide === this.plane.wide && high === this.plane.high) return;
    const held = this.holdsAll();
    Object.assign(this.plane, { wide, high });
    this.globe.centre = [(wide * U) / 2, (high * U) / 2];
    this.globe.radius = 0.42 * Math.min(wide, high) * U;
    this.svg.setAttribute("viewBox", `0 0 ${wide * U} ${high * U}`);
    if (this.fits || (held && !this.holdsAll())) this.fit();
    else this.view();
  }

  // Whether the view holds everything, wherever it moves: then it goes on doing so in a window of another size.
  private holdsAll(): boolean {
    const { low, high } = this.extent(), { middle, scale, wide } = this.plane, sides = [wide, this.plane.high];
    return !this.spherical && low[0]! <= high[0]! && sides.every((side, axis) => Math.max(high[axis]! - middle[axis]!, middle[axis]! - low[axis]!) * scale <= side / 2);
  }

  private view(): void {
    this.ground();
    this.picture.showTracks();
    this.draw();
  }

  private extent(): { low: number[]; high: number[] } {
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    const take = (at: Place | null): void => at?.slice(0, 2).forEach((value, axis) => {
      if (!Number.isFinite(value)) return;
      low[axis] = Math.min(low[axis]!, value);
      high[axis] = Math.max(high[axis]!, value);
    });
    const moving = this.picture.motion, stride = Math.max(4, Math.ceil((moving?.samples ?? 0) / 400));
    for (const point of scene.peek()?.points ?? []) {
      take(point.at);
      if (moving) for (let k = 0; k < moving.samples; k += stride) take(moving.place(point.name, k));
    }
    for (const wheel of scene.peek()?.wheels ?? []) {
      const places = [scene.peek()!.points.find((one) => one.name === wheel.centre)?.at ?? null];
      if (moving) for (let k = 0; k < moving.samples; k += stride) places.push(moving.place(wheel.centre, k));
      for (const at of places) if (at) for (const side of [-wheel.radius, wheel.radius]) take([at[0]! + side, at[1]! + side]);
    }
    for (const cam of moving?.cams ?? []) {
      const reach = Math.max(...cam.outline.map((place) => size(minus(place, cam.centre))));
      for (const side of [-reach, reach]) take(cam.centre.map((value) => value + side));
    }
    const behind = this.spherical ? null : photo.peek();
    if (behind) for (const share of [0, 1]) take([behind.x + share * behind.wide, behind.y + share * behind.high]);
    return { low, high };
  }

  fit(): void {
    this.fits = true;
    const { low, high } = this.extent();
    if (low[0]! <= high[0]!) this.plane.fit(low, high);
    else {
      const factor = scene.peek()?.display?.length.factor ?? 1;
      this.plane.scale = (0.9 * Math.min(this.plane.wide, this.plane.high)) / ((factor >= 100 ? 500 : 5) / factor);
      this.plane.middle = [0, 0];
    }
    this.ground();
    this.picture.showTracks();
    this.draw();
  }

  zoom(by: number, about: Place = [(this.plane.wide * U) / 2, (this.plane.high * U) / 2]): void {
    this.fits = false;
    if (this.spherical) this.globe.radius = Math.min(60000, Math.max(500, this.globe.radius * by));
    else this.plane.zoom(by, about);
    this.view();
  }

  // Step of the grid [m]: a round number of the units that the description is shown in.
  get step(): number {
    if (this.spherical) return (DEGREE_STEPS.find((one) => one * DEGREE * this.globe.radius >= 12 * U) ?? 15) * DEGREE;
    const factor = scene.peek()?.display?.length.factor ?? 1;
    return roundStep((18 / this.plane.scale) * factor) / factor;
  }

  private ground(): void {
    const { plane } = this, flat = !this.spherical, on = state.shows.peek().grid !== false;
    for (const one of [this.grid, this.heavy, this.axes]) one.setAttribute("display", on ? "inline" : "none");
    if (on && !flat) this.graticule();
    else if (on) {
      const step = this.step, low = plane.back([0, plane.high * U]), high = plane.back([plane.wide * U, 0]);
      const lines = (by: number, skip: number): string => {
        let d = "";
        for (let k = Math.ceil(low[0]! / by); k * by <= high[0]!; k += 1) if (!skip || k % skip) d += `M${digits(plane.flat([k * by, 0])[0]!)} 0V${plane.high * U}`;
        for (let k = Math.ceil(low[1]! / by); k * by <= high[1]!; k += 1) if (!skip || k % skip) d += `M0 ${digits(plane.flat([0, k * by])[1]!)}H${plane.wide * U}`;
        return d;
      };
      this.grid.setAttribute("d", lines(step, 5));
      this.heavy.setAttribute("d", lines(5 * step, 0));
      const origin = plane.flat([0, 0]);
      this.axes.setAttribute("d", `M${digits(origin[0]!)} 0V${plane.high * U}M0 ${digits(origin[1]!)}H${plane.wide * U}`);
    }
    const shown = photo.peek();
    this.image.setAttribute("display", shown && flat ? "inline" : "none");
    if (shown && flat) {
      const corner = plane.flat([shown.x, shown.y + shown.high]), scale = plane.scale * U;
      this.image.setAttribute("href", shown.url);
      this.image.setAttribute("x", digits(corner[0]!));
      this.image.setAttribute("y", digits(corner[1]!));
      this.image.setAttribute("width", digits(shown.wide * scale));
      this.image.setAttribute("height", digits(shown.high * scale));
      this.image.setAttribute("opacity", String(shown.opacity));
    }
  }

  // Meridians and parallels of the side in front, every fifteen degrees; those of the axes are darker.
  private graticule(): void {
    const { globe } = this, turns = Array.from({ length: 73 }, (_, k) => k * 5 * DEGREE);
    const curve = (place: (turn: number) => Place): string => globe.paths(turns.map(place))[0];
    const parallel = (latitude: number): string => curve((turn) => fromAngles([turn, latitude * DEGREE]));
    const meridian = (longitude: number): string => curve((turn) => fromAngles([longitude * DEGREE, turn - Math.PI]));
    const every = (from: number, to: number, draw: (angle: number) => string): string => Array.from({ length: (to - from) / 15 + 1 }, (_, k) => draw(from + 15 * k)).join("");
    this.grid.setAttribute("d", every(-75, 75, parallel) + every(0, 165, meridian));
    this.heavy.setAttribute("d", parallel(0) + meridian(0) + meridian(90));
    this.axes.setAttribute("d", "");
  }

  // --- what lies where -------------------------------------------------------------------------------------------
  private at(event: { clientX: number; clientY: number }): Place {
    const box = this.svg.getBoundingClientRect();
    return [(event.clientX - box.left) * U, (event.clientY - box.top) * U];
  }

  private flatOf(name: string): Place | null {
    const at = this.where().place(name);
    return at && this.picture.paper.flat(at);
  }

  target(at: Place, touch = false, only?: "point"): Target | null {
    const now = scene.peek();
    if (!now) return null;
    let best: Target | null = null, least = U * (touch ? NEAR_TOUCH : NEAR);
    for (const point of now.points) {
      const flat = this.flatOf(point.name), far = flat ? Math.hypot(flat[0]! - at[0]!, flat[1]! - at[1]!) : Infinity;
      if (far < least) [best, least] = [{ kind: "point", name: point.name }, far];
    }
    if (best || only) return best;
    least = U * NEAR_LINE * (touch ? 1.8 : 1);
    const toSegment = (a: Place, b: Place): number => size(minus(at, plus(a, minus(b, a), along(a, minus(b, a), at))));
    for (const link of now.links) {
      for (const [from, to] of this.sidesOf(link.name)) {
        const far = toSegment(this.flatOf(from)!, this.flatOf(to)!);
        if (far < least) [best, least] = [{ kind: "link", name: link.name }, far];
      }
    }
    for (const guide of now.guides) {
      const path = this.svg.querySelector<SVGPathElement>(`[data-kind="guide"][data-name="${CSS.escape(guide.name)}"]`)?.getAttribute("d");
      for (const piece of path?.split("M") ?? []) {
        const numbers = piece.match(/-?[\d.]+/g)?.map(Number) ?? [];
        for (let k = 3; k < numbers.length; k += 2) {
          const far = toSegment(numbers.slice(k - 3, k - 1), numbers.slice(k - 1, k + 1));
          if (far < least) [best, least] = [{ kind: "guide", name: guide.name }, far];
        }
      }
    }
    return best;
  }

  // Where a hand means: a joint nearby, a place on a link, else the grid. What is meant is seen before the drawing goes
  // back to its initial position, its place is that after it.
  private meant(at: Place, event: { altKey: boolean } | null, touch: boolean, not?: Target | null, goBack?: () => void): { place: Place; target: Target | null } {
    const target = this.target(at, touch), taken = target && target.name !== not?.name ? target.kind : null;
    const spot = taken === "link" ? this.spotOn(target!.name, at, event) : null;
    goBack?.();
    if (taken === "point") return { place: this.where().place(target!.name)!, target };
    if (taken === "link") return { place: this.placeOf(spot) ?? this.paper.back(at), target };
    return { place: this.snapped(this.paper.back(at), event, this.step), target: null };
  }

  // The place on a link of the plane that is nearest to a hand, as a share of the way between two of its points: a
  // crossing with another link or the middle where one of them is near, else at a round distance from the first point.
  private spotOn(link: string, at: Place, event: { altKey: boolean } | null): Spot | null {
    if (this.spherical) return null;
    let best: Spot | null = null, least = Infinity;
    for (const [from, to] of this.sidesOf(link)) {
      const [a, b] = [this.flatOf(from)!, this.flatOf(to)!], way = minus(b, a), share = along(a, way, at);
      const far = size(minus(at, plus(a, way, share)));
      if (far < least) [best, least] = [{ from, to, share }, far];
    }
    if (!best || !state.snapping.peek() || event?.altKey) return best;
    const [a, b] = [this.flatOf(best.from)!, this.flatOf(best.to)!], way = minus(b, a), length = size(way);
    const near = (share: number): number => Math.abs(share - best!.share) * length;
    const shares = [0.5, ...this.crossings(link, a, way)].filter((share) => near(share) < NEAR * U).sort((one, other) => near(one) - near(other));
    const real = length / (this.plane.scale * U), round = (Math.round((best.share * real) / this.step) * this.step) / real;
    return { ...best, share: shares[0] ?? (round > 0 && round < 1 ? round : best.share) };
  }
  private placeOf(spot: Spot | null): Place | null {
    const [a, b] = spot ? [this.where().place(spot.from), this.where().place(spot.to)] : [null, null];
    return a && b && plus(a, minus(b, a), spot!.share);
  }
  // Lines between neighbouring points of a link.
  private sidesOf(link: string): [string, string][] {
    const points = scene.peek()!.links.find((one) => one.name === link)?.points.filter((name) => this.flatOf(name)) ?? [];
    const around = points.length > 2 ? [...points, points[0]!] : points;
    return around.slice(1).map((name, k) => [around[k]!, name]);
  }
  // Where other links cross a line, as shares of it.
  private crossings(link: string, a: Place, way: Place): number[] {
    const others = scene.peek()!.links.filter((one) => one.name !== link).flatMap((one) => this.sidesOf(one.name));
    return others.flatMap(([from, to]) => {
      const c = this.flatOf(from)!, other = minus(this.flatOf(to)!, c), off = minus(c, a), turn = cross(way, other);
      const [share, there] = [cross(off, other) / turn, cross(off, way) / turn];
      return share > 0 && share < 1 && there > 0 && there < 1 ? [share] : [];
    });
  }

  // --- pointers --------------------------------------------------------------------------------------------------
  private listen(): void {
    const { svg } = this;
    svg.addEventListener("pointerdown", (event) => this.down(event));
    svg.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"] as const) svg.addEventListener(name, (event) => this.up(event));
    svg.addEventListener("dblclick", (event) => this.double(event));
    svg.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.0015)), this.at(event));
    }, { passive: false });
    svg.addEventListener("keydown", (event) => this.key(event));
    svg.addEventListener("keyup", (event) => {
      if (event.key === " ") this.space = false;
    });
    svg.addEventListener("blur", () => {
      this.crosshair.setAttribute("display", "none");
    });
    svg.addEventListener("contextmenu", (event) => event.preventDefault());
    // a hand that holds something has the keyboard too: Escape lets go, and nothing is undone or deleted under it
    addEventListener("keydown", (event) => {
      if (!this.gesture || (event.target instanceof Element && event.target.closest("input, textarea, .cm-editor"))) return;
      event.preventDefault();
      event.stopPropagation();
      if (event.key !== "Escape") return;
      this.gesture.cancel?.();
      this.gesture = null;
    }, true);
    svg.addEventListener("lostpointercapture", (event) => {
      if (this.pointers.has(event.pointerId)) this.up(event);
    });
  }

  private down(event: PointerEvent): void {
    const at = this.at(event);
    this.pointers.set(event.pointerId, at);
    svgCapture(this.svg, event.pointerId);
    this.cursor = null;
    this.crosshair.setAttribute("display", "none");
    if (this.pointers.size === 2) {
      this.gesture?.cancel?.();
      this.pinch();
      return;
    }
    if (this.pointers.size > 2) return;
    this.begun = at;
    this.moved = false;
    const touch = event.pointerType === "touch", target = this.target(at, touch);
    if (event.target instanceof Element && !event.target.closest("[data-kind]")) this.svg.focus({ preventScroll: true });
    if (event.button === 1 || this.space || event.button === 2) this.gesture = this.panning(at);
    else if (event.button !== 0) this.gesture = null;
    else if (scalePhoto.value) this.gesture = this.measuring(at);
    else if (mode.value === "draw" || mode.value === "guide") this.gesture = this.drawing(at, event, touch);
    else if (mode.value === "edit") this.gesture = this.editing(target, event);
    else this.gesture = this.moving(target, at, event);
  }

  private move(event: PointerEvent): void {
    const at = this.at(event);
    if (!this.pointers.has(event.pointerId)) {
      this.hover(at, event);
      return;
    }
    this.pointers.set(event.pointerId, at);
    if (!this.moved && size(minus(at, this.begun)) < MOVED * U) return;
    this.moved = true;
    this.gesture?.move?.(at, event);
  }

  private up(event: PointerEvent): void {
    if (!this.pointers.delete(event.pointerId)) return;
    const { gesture } = this;
    if (this.pointers.size) return;
    this.gesture = null;
    if (event.type === "pointerup") gesture?.end(this.moved, event);
    else gesture?.cancel?.();
  }

  private hover(at: Place, event: PointerEvent): void {
    if (event.pointerType === "touch") return;
    const target = this.target(at);
    this.svg.setAttribute("data-over", target?.kind ?? "");
    for (const { point, group } of this.picture.points) group.classList.toggle("over", target?.kind === "point" && target.name === point.name);
  }

  private panning(from: Place): NonNullable<Stage["gesture"]> {
    let last = from;
    return {
      move: (at) => {
        this.fits = false;
        if (this.spherical) this.globe.turn(at[0]! - last[0]!, last[1]! - at[1]!);
        else this.plane.pan(minus(at, last));
        last = at;
        this.view();
      },
      end: () => undefined,
    };
  }

  private pinch(): void {
    const both = (): [Place, Place] => [...this.pointers.values()].slice(0, 2) as [Place, Place];
    let [a, b] = both();
    this.moved = true;
    this.gesture = {
      move: () => {
        if (this.pointers.size < 2) return;
        const [c, d] = both(), middle = plus(c, d).map((value) => value / 2), before = plus(a, b).map((value) => value / 2);
        if (!this.spherical) this.plane.pan(minus(middle, before));
        this.zoom(size(minus(c, d)) / (size(minus(a, b)) || 1), middle);
        [a, b] = [c, d];
      },
      end: () => undefined,
    };
  }

  choose(target: Target | null, more: boolean): void {
    if (!target) selection.value = more ? selection.value : [];
    else if (!more) selection.value = [target.name];
    else selection.value = selection.value.includes(target.name) ? selection.value.filter((one) => one !== target.name) : [...selection.value, target.name];
  }

  // Drawing and editing happen where the description has everything: at the initial position.
  private initial(): void {
    this.rest();
    if (this.picture.motion) place.value = motion.value?.start ?? 0;
  }

  // The motion that a topic has found makes way for the description.
  private rest(): void {
    playing.value = false;
    resting.value = true;
  }

  // --- drawing ---------------------------------------------------------------------------------------------------
  private drawing(at: Place, event: PointerEvent, touch: boolean): NonNullable<Stage["gesture"]> {
    const guide = mode.value === "guide", from = this.meant(at, event, touch, null, () => this.initial());
    this.line = { from: from.place, target: from.target, to: from.place, end: null, guide };
    return {
      move: (now, next) => {
        if (!this.line) return;
        const to = this.meant(now, next, touch, this.line.target?.kind === "point" ? this.line.target : null);
        this.line.to = to.place;
        this.line.end = this.endOf(this.line, to.target);
        this.sketch();
      },
      end: (moved, last) => {
        const { line } = this;
        this.line = null;
        this.sketch();
        if (moved && line) void this.finish(line);
        else this.choose(this.target(at, touch), last?.shiftKey ?? false);
      },
      cancel: () => {
        this.line = null;
        this.sketch();
      },
    };
  }

  // What a line ends on: a guide only on a link in which its joint slides.
  private endOf(line: Line, target: Target | null): Target | null {
    if (!line.guide) return target;
    const own = line.target?.kind === "point" ? line.target.name : null;
    const link = target?.kind === "link" ? scene.peek()?.links.find((one) => one.name === target.name) : null;
    return link && own && !this.spherical && !link.points.includes(own) ? target : null;
  }

  private sketch(): void {
    this.hint.replaceChildren();
    const { line } = this;
    if (!line) return;
    const [a, b] = [this.paper.flat(line.from), this.paper.flat(line.to)], display = scene.peek()?.display;
    const way = minus(line.to, line.from), unit = (this.spherical ? display?.angle : display?.length) ?? { unit: "m", factor: 1 };
    for (const d of this.paper.paths(this.paper.line(line.from, line.to))) if (d) make("path", { class: line.guide ? "guide-line" : "new-link", d }, this.hint);
    for (const [spot, target] of [[a, line.target], [b, line.end]] as const) {
      make("circle", { class: target ? "catch" : "end", cx: spot[0]!, cy: spot[1]!, r: target ? 105 : 45 }, this.hint);
    }
    // beside the end that the hand leads, away from the line where there is room for it
    const room = 140 * U, right = b[0]! >= a[0]! ? b[0]! + room < this.plane.wide * U : b[0]! - room < 0;
    const label = make("text", { x: b[0]! + (right ? 130 : -130), y: b[1]! + (b[1]! <= a[1]! ? -90 : 190), "text-anchor": right ? "start" : "end" }, this.hint);
    const angle = (Math.atan2(way[1]!, way[0]!) * 180) / Math.PI, length = this.spherical ? arc(line.from, line.to) : size(way);
    const measured = withUnit(spelled(length * unit.factor, 4), unit.unit);
    label.textContent = this.spherical ? measured : line.guide && !scalePhoto.peek() ? withUnit(spelled(angle, 4), "°") : `${measured} · ${withUnit(spelled(angle, 4), "°")}`;
  }

  // A line that was drawn becomes a link or a guide; a place on a link becomes a point of it first.
  private async finish(line: Line): Promise<void> {
    this.fits = false;
    const way = minus(line.to, line.from);
    if (!(size(way) > 0)) return;
    if (line.guide) {
      const point = line.target?.kind === "point" ? { point: line.target.name } : {};
      const slot = line.end ? this.spotOn(line.end.name, this.paper.flat(line.to), { altKey: true }) : null, [a, b] = slot ? [this.where().place(slot.from)!, this.where().place(slot.to)!] : [];
      const direction = slot ? { on: line.end!.name, direction: minus(b!, a!) } : { direction: way };
      this.select(await edit({ do: "add_guide", at: line.from, ...(this.spherical ? { to: line.to } : direction), ...point }), "guides");
      return;
    }
    if (line.target?.kind === "point" && line.end?.kind === "point" && line.target.name === line.end.name) return;
    const end = (key: string, target: Target | null): Record<string, string> => (target && target.kind !== "guide" ? { [`${key}_${target.kind}`]: target.name } : {});
    this.select(await edit({ do: "add_link", at: line.from, to: line.to, ...end("from", line.target), ...end("to", line.end) }), "links");
  }

  // Selects what an edit has made, so that its state rows are at hand.
  private select(answer: Reading | null, kind: "points" | "links" | "guides"): void {
    const made = answer?.scene?.[kind].map((one) => one.name).filter((name) => answer.named?.includes(name)) ?? [];
    if (made.length) selection.value = made.slice(-1);
  }

  private double(event: MouseEvent): void {
    if (!(mode.value === "draw" || mode.value === "edit")) return;
    const at = this.at(event), target = this.target(at);
    if (target?.kind === "link") void this.addPoint(target.name, this.placeOf(this.spotOn(target.name, at, event)) ?? this.paper.back(at));
  }

  async addPoint(link: string, at: Place): Promise<void> {
    this.select(await edit({ do: "add_point", link, at }), "points");
  }

  // --- dragging what is there ------------------------------------------------------------------------------------
  private editing(target: Target | null, event: PointerEvent): NonNullable<Stage["gesture"]> {
    if (!target || target.kind !== "point") {
      const more = event.shiftKey;
      return {
        move: (at) => this.band(at),
        end: (moved, last) => {
          this.rubber.setAttribute("display", "none");
          if (moved && last) this.inBand(this.at(last), more);
          else this.choose(target, more);
        },
        cancel: () => this.rubber.setAttribute("display", "none"),
      };
    }
    return this.held(target.name, "edit", event);
  }

  private moving(target: Target | null, at: Place, event: PointerEvent): NonNullable<Stage["gesture"]> {
    let name: string | null = target?.kind === "point" ? target.name : null;
    if (target?.kind === "link") {
      const points = scene.value!.links.find((one) => one.name === target.name)!.points;
      const far = (one: string): number => {
        const flat = this.flatOf(one);
        return flat && scene.value!.points.find((point) => point.name === one)?.handles.move ? size(minus(flat, at)) : Infinity;
      };
      name = points.reduce<string | null>((best, one) => (far(one) < (best ? far(best) : Infinity) ? one : best), null);
    }
    if (!name) {
      const pan = this.panning(at);
      return { ...pan, end: (moved, last) => void (moved || this.choose(target, last?.shiftKey ?? false)) };
    }
    return this.held(name, "move", event, target);
  }

  // One request is on its way; of places that come meanwhile the latest is sent when it is back.
  private held(name: string, how: "edit" | "move", event: PointerEvent, chosen: Target | null = { kind: "point", name }): NonNullable<Stage["gesture"]> {
    if (how === "edit") this.initial();
    this.rest();
    const point = scene.value?.points.find((one) => one.name === name), allowed = point?.handles[how] ?? false;
    const touch = event.pointerType === "touch", grip = this.flatOf(name), off = grip ? minus(this.begun, grip) : [0, 0];
    const drag = new Drag(name, how, (frame) => this.follow(frame));
    const onto = (free: Place): string | null => {
      const other = how === "edit" ? this.target(free, touch, "point") : null;
      return other && other.name !== name ? other.name : null;
    };
    const goal = (at: Place, last: { altKey: boolean } | null): Place => {
      const free = minus(at, off);
      if (this.spherical && how === "move") return this.globe.back(free, this.where().place(name));
      if (how === "move") return this.plane.back(free);
      const other = onto(free);
      return other ? this.where().place(other)! : this.meantFree(free, last);
    };
    return {
      move: (at, last) => {
        if (!allowed) {
          this.refuse(name, point?.handles.why);
          return;
        }
        this.svg.classList.add("held");
        drag.to(goal(at, last));
      },
      end: (moved, last) => {
        this.svg.classList.remove("held");
        if (!moved) {
          this.choose(chosen, last?.shiftKey ?? false);
          return;
        }
        if (!(allowed && last)) return;
        const other = onto(minus(this.at(last), off));
        if (other) void this.join(drag, name, other);
        else void this.drop(drag, goal(this.at(last), last));
      },
      cancel: () => {
        this.svg.classList.remove("held");
        drag.stop();
        this.live = null;
        this.draw();
      },
    };
  }

  private refuse(name: string, why: string | null | undefined): void {
    tell(why ? sentence(why) : say("held_point", { name }), true);
  }

  private meantFree(at: Place, event: { altKey: boolean } | null): Place {
    return this.snapped(this.paper.back(at), event, this.step / 2);
  }

  // The nearest place of the grid: on the sphere one of round longitude and latitude.
  private snapped(place: Place, event: { altKey: boolean } | null, step: number): Place {
    if (!state.snapping.peek() || event?.altKey) return place;
    const round = (value: number): number => Number((Math.round(value / step) * step).toPrecision(12));
    return this.spherical ? fromAngles(angles(place).map(round)) : place.map(round);
  }

  follow(frame: Frame): void {
    const names = scene.peek()?.points ?? [], links = scene.peek()?.links ?? [], { points, angles } = frame.arrays;
    if (!points) return;
    const axes = points.shape[1] ?? 2;
    this.live = {
      points: new Map(names.map((one, k) => [one.name, Array.from(points.numbers.subarray(k * axes, (k + 1) * axes))] as [string, Place]).filter(([, at]) => at.every(Number.isFinite) && at.length === axes)),
      angles: new Map(angles ? links.map((one, k) => [one.name, angles.numbers[k]!]) : []),
    };
    const { at, held, values } = frame.header, before = place.peek();
    if (typeof at === "number") this.seek(at);
    if (held) tell(sentence(String(held)), true);
    else if (values && Object.keys(values).length) this.showValues(values);
    if (place.peek() === before) this.draw(); // the player's place draws by itself
    this.svg.setAttribute("data-updates", String(Number(this.svg.getAttribute("data-updates")) + 1));
  }

  private seek(value: number): void {
    const found = motion.value?.sampleOf(value);
    if (found !== null && found !== undefined) place.value = found;
  }

  private showValues(values: Record<string, number>): void {
    const display = scene.peek()?.display, known = scene.peek()?.dimensions ?? [];
    const told = Object.entries(values).slice(0, 4).map(([path, value]) => {
      const one = known.find((dimension) => dimension.path === path), angle = /angle|direction/.test(path);
      const unit = angle ? display?.angle : display?.length;
      return `${one?.name ?? path} = ${withUnit(spelled(value * (unit?.factor ?? 1), 5), unit?.unit)}`;
    });
    tell(told.join("   "));
  }

  private async drop(drag: Drag, to: Place): Promise<void> {
    const answer = await drag.drop(to);
    if (answer === SUPERSEDED || !answer) {
      this.live = null;
    } else if (isFrame(answer)) {
      this.follow(answer);
      this.live = null;
    } else if (answer.error) {
      this.live = null;
      state.refused(answer.error);
    } else {
      batch(() => {
        this.live = null;
        if (drag.how === "move") place.value = motion.value?.start ?? 0; // what was dropped is where the motion begins
        if (answer.text !== undefined) state.accept(answer);
      });
    }
    this.draw();
  }

  // A joint that is dropped on another one becomes one with it.
  private async join(drag: Drag, name: string, other: string): Promise<void> {
    drag.stop();
    const answer = await edit({ do: "join", points: [name, other] });
    this.live = null;
    if (answer) selection.value = [answer.changed?.at(-1) ?? other].filter((one) => scene.value?.points.some((point) => point.name === one));
    this.draw();
  }

  // --- the band that selects -------------------------------------------------------------------------------------
  private band(at: Place): void {
    const low = [Math.min(at[0]!, this.begun[0]!), Math.min(at[1]!, this.begun[1]!)];
    this.rubber.setAttribute("display", "inline");
    this.rubber.setAttribute("x", digits(low[0]!));
    this.rubber.setAttribute("y", digits(low[1]!));
    this.rubber.setAttribute("width", digits(Math.abs(at[0]! - this.begun[0]!)));
    this.rubber.setAttribute("height", digits(Math.abs(at[1]! - this.begun[1]!)));
  }
  private inBand(at: Place, more: boolean): void {
    const inside = (flat: Place | null): boolean => Boolean(flat) && [0, 1].every((k) => (flat![k]! - at[k]!) * (flat![k]! - this.begun[k]!) <= 0);
    const now = scene.value;
    if (!now) return;
    const points = now.points.filter((point) => inside(this.flatOf(point.name))).map((one) => one.name);
    const links = now.links.filter((link) => link.points.every((name) => points.includes(name))).map((one) => one.name);
    const guides = now.guides.filter((guide) => points.includes(guide.point)).map((one) => one.name);
    selection.value = [...new Set([...(more ? selection.value : []), ...links, ...guides, ...points])];
  }

  // A line over the photo whose length is known sets its scale.
  private measuring(from: Place): NonNullable<Stage["gesture"]> {
    const start = this.plane.back(from);
    return {
      move: (at) => {
        this.line = { from: start, to: this.plane.back(at), target: null, end: null, guide: true };
        this.sketch();
      },
      end: (moved) => {
        const { line } = this;
        this.line = null;
        this.sketch();
        if (moved && line) scalePhoto.value?.(line.from, line.to);
      },
      cancel: () => {
        this.line = null;
        this.sketch();
      },
    };
  }

  // --- keyboard --------------------------------------------------------------------------------------------------
  private focusable(element: SVGGElement | SVGPathElement, name: string, kind: Target["kind"]): void {
    element.setAttribute("tabindex", "0");
    element.setAttribute("role", "button");
    element.setAttribute("data-kind", kind);
    element.setAttribute("data-name", name);
    element.setAttribute("aria-label", say(kind === "point" ? `joint_${scene.peek()?.points.find((one) => one.name === name)?.kind ?? "moving"}` : kind, { name }));
    element.addEventListener("keydown", (event) => this.keyOn({ kind, name }, event as KeyboardEvent));
  }

  private static ways: Record<string, Place> = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

  private keyOn(target: Target, event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const way = Stage.ways[event.key];
    if (event.key === " ") this.choose(target, event.shiftKey);
    else if (event.key === "Enter") {
      if ((mode.value === "draw" || mode.value === "guide") && target.kind === "point") this.anchor(target, this.where().place(target.name)!);
      else if (target.kind === "link" && mode.value !== "move") {
        const points = scene.value!.links.find((one) => one.name === target.name)!.points.map((name) => this.where().place(name)).filter((one): one is Place => Boolean(one));
        if (points.length > 1) void this.addPoint(target.name, plus(points[0]!, points[1]!).map((value) => value / 2)); // on the sphere the server takes its direction
      } else this.choose(target, event.shiftKey);
    } else if (way && target.kind === "point" && (mode.value === "edit" || mode.value === "move")) void this.nudge(target.name, way, event.shiftKey);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  private nudging: Promise<unknown> = Promise.resolve();
  private async nudge(name: string, way: Place, far: boolean): Promise<void> {
    const how = mode.value as "edit" | "move", point = scene.value?.points.find((one) => one.name === name);
    if (!point?.handles[how]) {
      this.refuse(name, point?.handles.why);
      return;
    }
    if (how === "edit") this.initial();
    this.rest();
    this.nudging = this.nudging.then(async () => {
      const now = this.where().place(name);
      if (!now) return;
      const step = this.spherical ? 0.02 * (far ? 5 : 1) : this.step * (far ? 5 : 1) * (how === "move" ? 0.5 : 1);
      const flat = this.picture.paper.flat(now), pixels = this.spherical ? step * this.globe.radius : step * this.plane.scale * U;
      const to = this.picture.paper.back(plus(flat, [way[0]! * pixels, -way[1]! * pixels]), now);
      await this.drop(new Drag(name, how, (frame) => this.follow(frame)), to);
    });
    await this.nudging;
  }

  private anchor(target: Target | null, at: Place): void {
    if (!this.line) {
      this.initial();
      if (target?.kind === "point") at = this.where().place(target.name) ?? at;
      this.line = { from: at, target, to: at, end: null, guide: mode.value === "guide" };
      this.cursor = at;
      this.svg.focus({ preventScroll: true });
      this.showCursor();
      tell(say("line_begun"));
    } else {
      const { line } = this;
      line.to = at;
      line.end = this.endOf(line, target);
      this.line = null;
      void this.finish(line);
    }
    this.sketch();
  }

  private showCursor(): void {
    if (!this.cursor) return;
    const flat = this.paper.flat(this.cursor), display = scene.peek()?.display, unit = (this.spherical ? display?.angle : display?.length) ?? { unit: "m", factor: 1 };
    this.crosshair.setAttribute("display", "inline");
    this.crosshair.setAttribute("transform", `translate(${digits(flat[0]!)} ${digits(flat[1]!)})`);
    const target = this.target(flat), name = target ? `, ${target.name}` : "";
    const signs = this.spherical ? "λβ" : "xy", numbers = this.spherical ? angles(this.cursor) : this.cursor;
    tell(`${[0, 1].map((axis) => `${signs[axis]} = ${withUnit(spelled(numbers[axis]! * unit.factor, 5), unit.unit)}`).join(", ")}${name}`);
    if (this.line) {
      this.line.to = target?.kind === "point" ? this.where().place(target.name)! : this.cursor;
      this.line.end = this.endOf(this.line, target);
      this.sketch();
    }
  }

  // A known length over the photo, from one place of the cross to another.
  private measureTo(at: Place): void {
    const { line } = this;
    if (!line) {
      this.line = { from: at, to: at, target: null, end: null, guide: true };
      return;
    }
    this.line = null;
    this.sketch();
    if (size(minus(at, line.from)) > 0) scalePhoto.value?.(line.from, at);
  }

  // The globe turns until a place lies well in front.
  private turnTowards(place: Place): void {
    const flat = this.globe.flat(place), off = minus(flat, this.globe.centre);
    if (this.globe.front(place) && size(off) < 0.85 * this.globe.radius) return;
    this.globe.turn(-0.3 * off[0]!, 0.3 * off[1]!);
    this.view();
  }

  private key(event: KeyboardEvent): void {
    if (event.target !== this.svg || event.metaKey) return;
    const way = Stage.ways[event.key];
    if (way && event.ctrlKey && !this.spherical) {
      this.fits = false; // the view goes on that way
      this.plane.pan([-way[0]! * 60 * U, way[1]! * 60 * U]);
      this.view();
    } else if (event.ctrlKey) return;
    else if (way) {
      if (this.spherical && mode.value === "move") {
        this.globe.turn(-way[0]! * 0.08 * this.globe.radius, -way[1]! * 0.08 * this.globe.radius);
        this.view();
      } else if (this.spherical) {
        const step = this.step * (event.shiftKey ? 5 : 1), at = angles(this.cursor ?? this.globe.view[2]).map((value) => Math.round(value / this.step) * this.step);
        const to = this.cursor ? plus(at, way, step) : at;
        this.cursor = fromAngles([to[0]!, Math.min(Math.PI / 2, Math.max(-Math.PI / 2, to[1]!))]);
        this.turnTowards(this.cursor);
        this.showCursor();
      } else {
        const step = this.step * (event.shiftKey ? 5 : event.altKey ? 0.1 : 1);
        const from = this.cursor ?? this.plane.middle.map((value) => Math.round(value / this.step) * this.step);
        this.cursor = this.cursor ? from.map((value, k) => Number((value + step * way[k]!).toPrecision(12))) : from;
        this.showCursor();
      }
    } else if ((event.key === "Enter" || event.key === " ") && this.cursor) {
      const target = this.target(this.paper.flat(this.cursor));
      if (scalePhoto.value) this.measureTo(this.cursor);
      else if (mode.value === "draw" || mode.value === "guide") this.anchor(target, this.meant(this.paper.flat(this.cursor), { altKey: true }, false).place);
      else this.choose(target, event.shiftKey);
    } else if (event.key === " ") {
      this.space = true;
      return; // the page plays where nobody drags
    } else if (event.key === "Escape") {
      this.line = null;
      scalePhoto.value = null;
      this.sketch();
      if (!this.cursor) selection.value = [];
      this.cursor = null;
      this.crosshair.setAttribute("display", "none");
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

const cross = (a: Place, b: Place): number => a[0]! * b[1]! - a[1]! * b[0]!;
// The share of a way from a place on that is nearest to another place.
const along = (a: Place, way: Place, at: Place): number => {
  const off = minus(at, a);
  return Math.min(1, Math.max(0, (off[0]! * way[0]! + off[1]! * way[1]!) / (way[0]! ** 2 + way[1]! ** 2 || 1)));
};

const svgCapture = (svg: SVGSVGElement, pointer: number): void => {
  try {
    svg.setPointerCapture(pointer);
  } catch {
    // a pointer that a test makes has nothing to be captured
  }
};

class Drag {
  private flying = false;
  private waiting: Place | null = null;
  private over = false;
  private drives: Record<string, number> | null = null; // of several drives: where they stand in this drag

  constructor(private readonly point: string, readonly how: "edit" | "move", private readonly shown: (frame: Frame) => void) {}

  to(goal: Place): void {
    this.waiting = goal;
    if (!this.flying) void this.pump();
  }
  stop(): void {
    this.over = true;
    this.waiting = null;
  }

  private request(to: Place): Record<string, unknown> & { do: string } {
    const now = motion.value;
    return { do: "drag", digest: digest.value, mode: this.how, point: this.point, to, ...(this.how === "move" && now ? { drive: now.driveAt(place.value) } : {}), ...(this.drives ? { drives: this.drives } : {}) };
  }

  private async pump(): Promise<void> {
    this.flying = true;
    while (this.waiting && !this.over) {
      const to = this.waiting;
      this.waiting = null;
      const answer = await ask(this.request(to), "drag");
      if (this.over) break;
      if (isFrame(answer)) {
        this.drives = answer.header.drives ?? null;
        this.shown(answer);
      }
      else if (answer !== SUPERSEDED && answer.error) state.refused(answer.error);
    }
    this.flying = false;
  }

  async drop(to: Place): Promise<any> {
    this.stop();
    return ask({ ...this.request(to), drop: true });
  }
}
