// Draws a scene in conventional signs: elements are made once for a scene and then only moved.
import type { Motion } from "./motion";
import { BLOCK, HEAD, SIGN, SUPPORT, U, circle, digits, drawn, groundLine, hatched, minus, plus, size, slot, turned, turningArc } from "./outlines";
import { Globe, type Paper, type Plane, around, dot, globeAxes } from "./paper";
import type { Block, Place, Scene, SceneGuide, SceneLink, ScenePoint, SceneWheel } from "./protocol";

const SVG = "http://www.w3.org/2000/svg";
export const make = <K extends keyof SVGElementTagNameMap>(name: K, attributes: Record<string, string | number>, parent?: Element): SVGElementTagNameMap[K] => {
  const made = document.createElementNS(SVG, name);
  for (const key in attributes) made.setAttribute(key, String(attributes[key]));
  if (parent) parent.appendChild(made);
  return made;
};
const put = (element: Element, name: string, value: string): void => {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
};
const at = (place: Place, angle?: number): string =>
  `translate(${digits(place[0]!)} ${digits(place[1]!)})${angle === undefined ? "" : ` rotate(${((angle * 180) / Math.PI).toFixed(2)})`}`;

export interface Where {
  place(name: string): Place | null;
  angle(link: string): number;
}
interface PointSign {
  point: ScenePoint;
  group: SVGGElement;
  label: SVGTextElement;
  turn: number | null;
}
interface LinkSign {
  link: SceneLink;
  fill: SVGPathElement;
  line: SVGPathElement;
  far: SVGPathElement;
  grip: SVGPathElement;
}

export class Picture {
  readonly layers: Record<"back" | "behind" | "tracks" | "links" | "grips" | "signs" | "vectors" | "names", SVGGElement>;
  points: PointSign[] = [];
  links: LinkSign[] = [];
  scene: Scene | null = null;
  motion: Motion | null = null;
  paper: Paper;
  private guides: { guide: SceneGuide; line: SVGPathElement; far: SVGPathElement; block: SVGPathElement | null; joint: SVGPathElement; grip: SVGPathElement; ends: Place[] | null }[] = [];
  private wheels: { link: string; centre: string; radius: number; track?: SceneWheel["track"]; rim: SVGPathElement; far: SVGPathElement; way: SVGPathElement; ends: [number, number] | null }[] = [];
  private cams: { body: SVGPathElement; roller: SVGCircleElement; lines: SVGPathElement; hub: SVGCircleElement; of: Motion }[] = [];
  private barrels: { ends: [string, string]; body: SVGPathElement; rod: SVGPathElement }[] = [];
  private drives: { point: string; link: string; forward: boolean; arc: SVGPathElement; head: SVGPathElement; middle: number }[] = [];
  private tracks: { name: string; near: SVGPathElement; far: SVGPathElement }[] = [];
  private arrows: { kind: string; group: SVGGElement; shaft: SVGPathElement; head: SVGPathElement }[] = [];
  private globe: SVGCircleElement;
  shows: Record<string, boolean> = {};
  forces: Extract<Block, { kind: "arrows" }> | null = null;

  constructor(readonly svg: SVGSVGElement, paper: Paper) {
    this.paper = paper;
    const layer = (name: string): SVGGElement => make("g", { class: name }, svg);
    this.globe = make("circle", { class: "globe", display: "none" }, svg);
    this.layers = {
      back: layer("layer-back"), behind: layer("layer-behind"), tracks: layer("layer-tracks"), links: layer("layer-links"),
      grips: layer("layer-grips"), signs: layer("layer-signs"), vectors: layer("layer-vectors"), names: layer("names"),
    };
  }

  colour(link: string): number {
    return this.scene ? Math.max(0, this.scene.links.findIndex((one) => one.name === link)) % 6 : 0;
  }

  // --- elements --------------------------------------------------------------------------------------------------
  build(scene: Scene, focusable: (element: SVGGElement | SVGPathElement, name: string, kind: "point" | "link" | "guide") => void): void {
    this.scene = scene;
    for (const layer of Object.values(this.layers)) layer.replaceChildren();
    const { behind, links, grips, signs, names, tracks } = this.layers;
    this.wheels = (scene.wheels ?? []).map((wheel) => {
      const hue = wheel.link === "frame" ? "" : ` hue-${this.colour(wheel.link)}`;
      return {
        ...wheel,
        way: make("path", { class: "ground" }, this.layers.back),
        far: make("path", { class: `pitch-circle far${hue}` }, behind),
        rim: make("path", { class: wheel.pitch ? `pitch-circle${hue}` : `wheel${hue}` }, behind),
        ends: null,
      };
    });
    this.cams = [];
    this.links = scene.links.map((link, k) => {
      const hue = `hue-${k % 6}`;
      const sign = {
        link,
        fill: make("path", { class: `fill ${hue}` }, links),
        far: make("path", { class: `link far ${hue}` }, links),
        line: make("path", { class: `link ${hue}`, "data-link": link.name }, links),
        grip: make("path", { class: "grip" }, grips),
      };
      focusable(sign.grip, link.name, "link");
      return sign;
    });
    this.guides = scene.guides.map((guide) => {
      const frame = guide.on === "frame", hue = frame ? "" : ` hue-${this.colour(guide.on)}`;
      const sign = {
        guide,
        joint: make("path", { class: `joint${hue}` }, behind),
        far: make("path", { class: "orbit far" }, behind),
        line: make("path", { class: scene.kind === "sphere" ? `orbit${hue}` : frame ? "ground" : guide.link ? `link rail${hue}` : `shape slot${hue}` }, frame ? this.layers.back : behind),
        block: scene.kind === "plane" && (guide.link || frame) ? make("path", { class: `shape block${guide.link ? ` hue-${this.colour(guide.link)}` : ""}`, d: BLOCK }, links) : null,
        grip: make("path", { class: "grip guide" }, grips),
        ends: null,
      };
      focusable(sign.grip, guide.name, "guide");
      return sign;
    });
    this.barrels = (scene.cylinders ?? []).map((ends) => ({ ends, rod: make("path", { class: "rod" }, links), body: make("path", { class: "shape barrel" }, links) }));
    this.tracks = scene.points.filter((point) => point.kind !== "fixed").map((point) => ({
      name: point.name, near: make("path", { class: "track" }, tracks), far: make("path", { class: "track far" }, tracks),
    }));
    this.drives = scene.drives.flatMap((drive) => {
      const link = scene.links.find((one) => one.name === drive.link);
      const pivot = drive.at ?? link?.points.find((name) => scene.points.find((one) => one.name === name)?.kind === "fixed");
      if (!link || !pivot || scene.kind !== "plane") return [];
      return [{ point: pivot, link: link.name, forward: (drive.speed ?? 1) >= 0, middle: -1.57, arc: make("path", { class: "drive" }, signs), head: make("path", { class: "drive-head", d: "M0 0L-70 30L-70 -30Z" }, signs) }];
    });
    this.points = scene.points.map((point) => {
      const group = make("g", { class: `point ${point.kind}`, "data-point": point.name }, signs);
      make("circle", { class: "halo", r: 120 }, group);
      if (point.kind === "fixed" && scene.kind === "plane") make("path", { class: "support", d: SUPPORT }, group);
      make("circle", { class: "ring", r: 100 }, group);
      const dot = point.kind === "coupler";
      if (point.centre) {
        make("circle", { class: "centre", r: 48 }, group);
        make("path", { class: "quarter", d: "M0 0V-48A48 48 0 0 1 48 0ZM0 0V48A48 48 0 0 1 -48 0Z" }, group);
      } else make("circle", { class: dot ? "dot" : "hinge", r: dot ? SIGN / 2 : SIGN }, group);
      if (point.kind === "fixed" && scene.kind === "sphere") make("circle", { class: "dot", r: SIGN / 2 }, group);
      if (point.held) make("path", { class: "held-mark", d: "M-36 -36L36 36M-36 36L36 -36" }, group);
      focusable(group, point.name, "point");
      const label = make("text", {}, names);
      label.textContent = point.name;
      return { point, group, label, turn: null };
    });
    this.arrows = [];
  }

  mark(selected: string[], loose: string[]): void {
    for (const { point, group } of this.points) {
      group.classList.toggle("selected", selected.includes(point.name));
      group.classList.toggle("loose", loose.includes(point.name));
    }
    for (const { link, line, fill } of this.links) {
      line.classList.toggle("selected", selected.includes(link.name));
      fill.classList.toggle("selected", selected.includes(link.name));
    }
    for (const { guide, line } of this.guides) line.classList.toggle("selected", selected.includes(guide.name));
  }

  // --- places ----------------------------------------------------------------------------------------------------
  show(where: Where, sample: number | null): void {
    const { scene, paper } = this;
    if (!scene) return;
    const now = new Map<string, Place | null>(scene.points.map((point) => [point.name, where.place(point.name)]));
    const flat = new Map<string, Place | null>([...now].map(([name, place]) => [name, place && paper.flat(place)]));
    this.showGlobe();
    for (const { point, group } of this.points) {
      const place = flat.get(point.name) ?? null;
      put(group, "display", place ? "inline" : "none");
      if (!place) continue;
      put(group, "transform", at(place));
      group.classList.toggle("away", !paper.front(now.get(point.name)!));
    }
    for (const sign of this.links) this.showLink(sign, now);
    for (const sign of this.guides) this.showGuide(sign, now, flat, where);
    for (const wheel of this.wheels) this.showWheel(wheel, now, flat, where);
    this.showCams(sample);
    for (const { ends, body, rod } of this.barrels) this.showBarrel(flat.get(ends[0]) ?? null, flat.get(ends[1]) ?? null, body, rod);
    for (const drive of this.drives) {
      const place = flat.get(drive.point), way = this.direction(drive.link, drive.point, now);
      put(drive.arc, "display", place ? "inline" : "none");
      put(drive.head, "display", place ? "inline" : "none");
      if (!place) continue;
      const { arc, tip, way: turn, middle } = turningArc(way, drive.forward);
      drive.middle = -middle;
      put(drive.arc, "d", arc);
      put(drive.arc, "transform", at(place));
      put(drive.head, "transform", at(plus(place, tip), turn));
    }
    this.showVectors(flat, sample);
    if (this.shows.names !== false) this.nameAll(flat);
  }

  private showWheel(wheel: (typeof this.wheels)[number], now: Map<string, Place | null>, flat: Map<string, Place | null>, where: Where): void {
    const { rim, far, way, track } = wheel, { paper } = this, place = flat.get(wheel.centre), centre = now.get(wheel.centre);
    for (const one of [rim, far]) put(one, "display", place ? "inline" : "none");
    if (!place || !centre) return;
    if (paper instanceof Globe) {
      const [near, behind] = paper.paths(around(centre, wheel.radius));
      put(rim, "d", near);
      put(far, "d", behind);
      return;
    }
    const scale = (paper as Plane).scale * U;
    put(rim, "d", circle(wheel.radius * scale, true));
    put(rim, "transform", at(place, -this.turn(wheel.link, where)));
    if (!track) return;
    const carried = this.carried(track.on, track.at, now, where), angle = this.turned(track.on, where);
    put(way, "display", carried ? "inline" : "none");
    if (!carried) return;
    if (track.radius !== null) {
      put(way, "d", circle(track.radius * scale));
      put(way, "transform", at(paper.flat(carried)));
    } else {
      const on = turned([Math.cos(track.direction!), Math.sin(track.direction!)], angle), [low, high] = wheel.ends ?? [0, 0];
      const [start, end] = [low - 1.2 * wheel.radius, high + 1.2 * wheel.radius].map((reach) => paper.flat(plus(carried, on, reach))) as [Place, Place];
      // the wheel is on the left of its line, the ground on the right
      put(way, "d", track.on === "frame" ? hatched(start, end, [on[1]!, on[0]!]) : drawn([start, end]));
    }
  }

  // How far a link has turned since the initial position.
  private turned(link: string, where: Where): number {
    return link === "frame" ? 0 : this.turn(link, where) - (this.scene!.links.find((one) => one.name === link)?.angle ?? 0);
  }
  // Where a link has carried a place since the initial position.
  private carried(link: string, place: Place, now: Map<string, Place | null>, where: Where): Place | null {
    if (link === "frame") return place;
    const before = this.origin(link, (name) => this.scene!.points.find((one) => one.name === name)?.at ?? null), after = this.origin(link, (name) => now.get(name) ?? null);
    return before && after && plus(after, turned(minus(place, before), this.turned(link, where)));
  }

  // Cams turn about their axis; what they move follows with the motion.
  private showCams(sample: number | null): void {
    const { motion, paper } = this;
    if (motion && motion.cams.length && this.cams[0]?.of !== motion) {
      for (const one of this.cams) for (const element of [one.body, one.roller, one.lines, one.hub]) element.remove();
      this.cams = motion.cams.map(() => ({
        of: motion,
        body: make("path", { class: "cam-body hue-3" }, this.layers.behind), roller: make("circle", { class: "roller hue-4" }, this.layers.behind), lines: make("path", { class: "cam-line" }, this.layers.behind), hub: make("circle", { class: "hinge", r: SIGN }, this.layers.behind),
      }));
    }
    this.cams.forEach((sign, k) => {
      const cam = motion?.cams[k], shown = cam && sample !== null && sign.of === motion && !(paper instanceof Globe);
      for (const one of [sign.body, sign.roller, sign.lines, sign.hub]) put(one, "display", shown ? "inline" : "none");
      if (!shown) return;
      const turn = motion!.row(`cam_turns_${k}`, sample!)[0] ?? 0;
      const place = (one: Place): Place => paper.flat(plus(cam.centre, turned(minus(one, cam.centre), turn)));
      put(sign.body, "d", `${drawn(cam.outline.map(place), true)}${drawn(cam.mark.map(place))}`);
      const hub = paper.flat(cam.centre);
      put(sign.hub, "cx", digits(hub[0]!));
      put(sign.hub, "cy", digits(hub[1]!));
      const roller = motion!.row(`cam_rollers_${k}`, sample!), spot = roller.length === 2 && roller.every(Number.isFinite) ? paper.flat(roller) : null;
      if (spot && cam.roller) {
        put(sign.roller, "cx", digits(spot[0]!));
        put(sign.roller, "cy", digits(spot[1]!));
        put(sign.roller, "r", digits(cam.roller * (paper as Plane).scale * U));
      } else put(sign.roller, "display", "none");
      const lines = motion!.row(`cam_lines_${k}`, sample!), pieces: string[] = [];
      for (let one = 0; one + 3 < lines.length; one += 4) pieces.push(drawn([lines.slice(one, one + 2), lines.slice(one + 2, one + 4)].map((end) => paper.flat(end))));
      put(sign.lines, "d", pieces.join(""));
    });
  }

  private direction(link: string, from: string, now: Map<string, Place | null>): number {
    const foot = now.get(from), end = this.scene!.links.find((one) => one.name === link)?.points.filter((name) => name !== from).map((name) => now.get(name)).find(Boolean);
    return foot && end ? Math.atan2(end[1]! - foot[1]!, end[0]! - foot[0]!) : 0;
  }

  private showGlobe(): void {
    const { paper, globe } = this;
    put(globe, "display", paper instanceof Globe ? "inline" : "none");
    if (!(paper instanceof Globe)) return;
    put(globe, "cx", digits(paper.centre[0]!));
    put(globe, "cy", digits(paper.centre[1]!));
    put(globe, "r", digits(paper.radius));
  }

  private showLink({ link, fill, line, far, grip }: LinkSign, now: Map<string, Place | null>): void {
    const known = link.points.map((name) => now.get(name)).filter((one): one is Place => Boolean(one));
    const around = known.length > 2 ? [...known, known[0]!] : known, places: Place[] = [];
    for (let k = 1; k < around.length; k += 1) places.push(...this.paper.line(around[k - 1]!, around[k]!).slice(k > 1 ? 1 : 0));
    const [near, behind] = this.paper.paths(places);
    put(line, "d", near);
    put(grip, "d", near);
    put(far, "d", behind);
    put(fill, "d", known.length > 2 && places.every((place) => this.paper.front(place)) ? near : "");
  }

  // The line of a guide in axes of its link: about the link's first point, turned as the link is.
  private lineOf(guide: SceneGuide): { through: Place; direction: number } | null {
    if (guide.direction === null || !guide.through) return null;
    if (guide.on === "frame") return { through: guide.through, direction: guide.direction };
    const link = this.scene!.links.find((one) => one.name === guide.on), angle = link?.angle ?? 0;
    const origin = this.origin(guide.on, (name) => this.scene!.points.find((one) => one.name === name)?.at ?? null);
    return origin && { through: turned(minus(guide.through, origin), -angle), direction: guide.direction - angle };
  }

  // The part of a guide that its point travels: from the motion where there is one, else around where it stands.
  private travel(guide: SceneGuide): [number, number] | null {
    const { motion } = this, own = this.lineOf(guide);
    if (!motion || !own) return null;
    const way = [Math.cos(own.direction), Math.sin(own.direction)];
    let least = Infinity, most = -Infinity;
    for (let k = 0; k < motion.samples; k += 1) {
      const place = motion.place(guide.point, k);
      if (!place) continue;
      let local = place;
      if (guide.on !== "frame") {
        const origin = this.origin(guide.on, (name) => motion.place(name, k)), angle = motion.angle(guide.on, k);
        if (!origin || !Number.isFinite(angle)) continue;
        local = turned(minus(place, origin), -angle);
      }
      const reach = (local[0]! - own.through[0]!) * way[0]! + (local[1]! - own.through[1]!) * way[1]!;
      if (reach < least) least = reach;
      if (reach > most) most = reach;
    }
    return least <= most ? [least, most] : null;
  }
  private origin(link: string, place: (name: string) => Place | null): Place | null {
    const first = this.scene!.links.find((one) => one.name === link)?.points[0];
    return first ? place(first) : null;
  }

  private turn(link: string, where: Where): number {
    const angle = where.angle(link);
    return Number.isFinite(angle) ? angle : this.scene!.links.find((one) => one.name === link)?.angle ?? 0;
  }

  rails(): void {
    for (const wheel of this.wheels) {
      const track = wheel.track;
      if (!track || track.direction === null) continue;
      wheel.ends = this.travel({ name: "", point: wheel.centre, on: track.on, through: track.at, direction: track.direction });
    }
    for (const sign of this.guides) {
      const travel = this.travel(sign.guide), own = this.lineOf(sign.guide);
      sign.ends = travel && own && travel.map((reach) => plus(own.through, [Math.cos(own.direction), Math.sin(own.direction)], reach));
    }
  }

  private showGuide(sign: (typeof this.guides)[number], now: Map<string, Place | null>, flat: Map<string, Place | null>, where: Where): void {
    const { guide, line, far, block, joint, grip } = sign, { paper } = this;
    if (paper instanceof Globe) {
      const pole = guide.circle && this.carriedOnGlobe(guide.on, guide.circle.pole, now);
      const [near, behind] = pole ? paper.paths(around(pole, guide.circle!.radius)) : ["", ""];
      put(line, "d", near);
      put(grip, "d", near);
      put(far, "d", behind);
      return;
    }
    const place = now.get(guide.point) ?? null, frame = guide.on === "frame";
    const origin = frame ? [0, 0] : this.origin(guide.on, (name) => now.get(name) ?? null), angle = frame ? 0 : this.turn(guide.on, where);
    const own = this.lineOf(guide);
    if (!origin || !own) return;
    const way = turned([Math.cos(own.direction), Math.sin(own.direction)], angle);
    const local = sign.ends ?? [own.through, own.through];
    let ends = local.map((end) => plus(origin, turned(end, angle)));
    if (!sign.ends) {
      const middle = place ?? ends[0]!, half = 60 / (paper as Plane).scale;
      ends = [plus(middle, way, -half), plus(middle, way, half)];
    }
    const [start, end] = ends.map((one) => paper.flat(one)) as [Place, Place];
    const on = [way[0]!, -way[1]!];
    const plane = paper as Plane;
    put(grip, "d", drawn([plus(start, on, -120), plus(end, on, 120)]));
    if (frame) put(line, "d", groundLine(start, end, [(plane.wide * U) / 2, (plane.high * U) / 2]));
    else if (guide.link) put(line, "d", drawn([plus(start, on, -3.5 * SIGN), plus(end, on, 3.5 * SIGN)]));
    else put(line, "d", slot(start, end));
    if (!frame) {
      const corners = this.scene!.links.find((one) => one.name === guide.on)!.points.map((name) => flat.get(name)).filter((one): one is Place => Boolean(one));
      const foot = (corner: Place): Place => {
        const along = minus(end, start), share = (minus(corner, start)[0]! * along[0]! + minus(corner, start)[1]! * along[1]!) / (size(along) ** 2 || 1);
        return plus(start, along, Math.min(1, Math.max(0, share)));
      };
      const nearest = corners.length ? corners.reduce((best, one) => (size(minus(one, foot(one))) < size(minus(best, foot(best))) ? one : best)) : null;
      put(joint, "d", nearest ? drawn([nearest, foot(nearest)]) : "");
    }
    if (block) {
      const spot = flat.get(guide.point);
      put(block, "display", spot ? "inline" : "none");
      if (spot) put(block, "transform", at(spot, Math.atan2(on[1]!, on[0]!)));
    }
  }

  // Where a link of the sphere has carried a place since the initial position: by two of its points.
  private carriedOnGlobe(link: string, place: Place, now: Map<string, Place | null>): Place | null {
    if (link === "frame") return place;
    const points = this.scene!.links.find((one) => one.name === link)?.points.slice(0, 2) ?? [];
    const before = points.map((name) => this.scene!.points.find((one) => one.name === name)?.at), after = points.map((name) => now.get(name));
    if (points.length < 2 || !before.every(Boolean) || !after.every(Boolean)) return null;
    const own = globeAxes(before as Place[]), other = globeAxes(after as Place[]);
    const numbers = own.map((axis) => dot(place, axis));
    return [0, 1, 2].map((k) => numbers.reduce((sum, value, axis) => sum + value * other[axis]![k]!, 0));
  }

  private showBarrel(foot: Place | null, end: Place | null, body: SVGPathElement, rod: SVGPathElement): void {
    if (!foot || !end) return;
    const way = minus(end, foot), length = size(way) || 1, on = way.map((value) => value / length), across = [-on[1]! * 1.3 * SIGN, on[0]! * 1.3 * SIGN];
    const mouth = plus(foot, on, 0.6 * length);
    put(body, "d", drawn([plus(foot, across), plus(mouth, across), minus(mouth, across), minus(foot, across)], true));
    put(rod, "d", drawn([mouth, end]));
  }

  showTracks(): void {
    const { motion, paper } = this;
    this.rails();
    const chosen = this.scene?.points.some((point) => point.traced) ?? false;
    const traced = new Set(this.scene?.points.filter((point) => !chosen || point.traced).map((point) => point.name));
    for (const { name, near, far } of this.tracks) {
      const places = motion && traced.has(name) ? motion.track(name) : [];
      const [front, behind] = paper.paths(places);
      near.classList.toggle("chosen", chosen);
      put(near, "d", front);
      put(far, "d", behind);
    }
  }

  // --- vectors ---------------------------------------------------------------------------------------------------
  private arrow(number: number, kind: string): (typeof this.arrows)[number] {
    while (this.arrows.length <= number) {
      const group = make("g", { class: "arrow" }, this.layers.vectors);
      this.arrows.push({ kind: "", group, shaft: make("path", {}, group), head: make("path", { class: "head", d: HEAD }, group) });
    }
    const found = this.arrows[number]!;
    if (found.kind !== kind) {
      found.kind = kind;
      found.group.setAttribute("class", `arrow ${kind}`);
    }
    return found;
  }

  private most(array: string): number {
    const { motion } = this;
    let most = 0;
    if (motion) for (let k = 0; k < motion.samples; k += 1) for (let point = 0; point < motion.points.length; point += 1) {
      const length = Math.hypot(...Array.from({ length: motion.axes }, (_, axis) => motion.value(array, k, point, axis)));
      if (length > most) most = length;
    }
    return most;
  }
  private scales = new WeakMap<Motion, Record<string, number>>();
  private reach(): number {
    const box = this.svg.viewBox.baseVal;
    return 0.2 * Math.min(box.width, box.height);
  }

  private showVectors(flat: Map<string, Place | null>, sample: number | null): void {
    const { motion } = this;
    let used = 0;
    const put1 = (place: Place | null | undefined, way: Place, kind: string): void => {
      const length = size(way);
      if (!place || !(length > 20)) return;
      const one = this.arrow(used, kind);
      used += 1;
      const tip = plus(place, way);
      put(one.group, "display", "inline");
      put(one.shaft, "d", drawn([place, plus(place, way, Math.max(0, 1 - 80 / length))]));
      put(one.head, "transform", at(tip, Math.atan2(way[1]!, way[0]!)));
    };
    if (motion && sample !== null) {
      const near = Math.round(sample);
      for (const array of ["velocities", "accelerations"]) {
        if (!this.shows[array] || !motion.has(array)) continue;
        const known = this.scales.get(motion) ?? {};
        known[array] ??= this.most(array);
        this.scales.set(motion, known);
        const scale = known[array] ? this.reach() / known[array]! : 0;
        for (const { point } of this.points) {
          if (point.kind === "fixed") continue;
          const vector = Array.from({ length: motion.axes }, (_, axis) => motion.value(array, near, motion.point(point.name), axis));
          if (vector.every(Number.isFinite)) put1(flat.get(point.name), this.paper instanceof Globe ? this.paper.towards(vector, scale) : [vector[0]! * scale, -vector[1]! * scale], array === "velocities" ? "velocity" : "acceleration");
        }
      }
      if (this.forces && this.forces.vectors.length) {
        const forces = this.forces, row = forces.vectors[Math.min(forces.vectors.length - 1, Math.round((near * (forces.vectors.length - 1)) / Math.max(1, motion.last)))] ?? [];
        const scale = this.reach() / (Math.max(...forces.vectors.flat().map((one) => Math.hypot(one[0] ?? 0, one[1] ?? 0))) || 1);
        row.forEach((vector, k) => put1(flat.get(forces.at[k]!), [(vector[0] ?? 0) * scale, -(vector[1] ?? 0) * scale], "reaction"));
      }
    }
    for (const load of this.scene?.loads ?? []) {
      if (!load.point || !load.vector || !size(load.vector)) continue;
      const length = 450, way = [(load.vector[0]! * length) / size(load.vector), (-load.vector[1]! * length) / size(load.vector)];
      const place = flat.get(load.point);
      if (place) put1(minus(place, way), plus(way, way, -0.16), "load");
    }
    for (let k = used; k < this.arrows.length; k += 1) put(this.arrows[k]!.group, "display", "none");
  }

  // --- names -----------------------------------------------------------------------------------------------------
  // They stand where the lines of their point leave most room, and stay there while there is room enough.
  private nameAll(flat: Map<string, Place | null>): void {
    const sliders = new Map(this.guides.map(({ guide }) => [guide.point, guide]));
    for (const sign of this.points) {
      const { point, label } = sign, place = flat.get(point.name);
      put(label, "display", place ? "inline" : "none");
      if (!place) continue;
      const lines = this.links.filter(({ link }) => link.points.includes(point.name)).flatMap(({ link }) => link.points)
        .filter((other) => other !== point.name).map((other) => flat.get(other))
        .filter((other): other is Place => Boolean(other) && Math.hypot(other![0]! - place[0]!, other![1]! - place[1]!) > 1)
        .map((other) => Math.atan2(other[1]! - place[1]!, other[0]! - place[0]!));
      if (point.kind === "fixed" && this.scene!.kind === "plane") lines.push(Math.PI / 2, Math.PI / 2 - 0.6, Math.PI / 2 + 0.6);
      const drive = this.drives.find((one) => one.point === point.name);
      if (drive) lines.push(drive.middle - 0.7, drive.middle, drive.middle + 0.7);
      const guide = sliders.get(point.name);
      if (guide && guide.direction !== null) lines.push(-guide.direction, Math.PI - guide.direction);
      const room = (turn: number): number => lines.reduce((least, line) => {
        const apart = Math.abs(turn - line) % (2 * Math.PI);
        return Math.min(least, apart, 2 * Math.PI - apart);
      }, 1.6);
      let best = sign.turn ?? -Math.PI / 3, most = room(best) + 0.35;
      for (let k = 0; k < 16; k += 1) {
        const turn = -Math.PI / 3 + (k * Math.PI) / 8;
        if (room(turn) > most) [best, most] = [turn, room(turn)];
      }
      sign.turn = best;
      const far = guide ? 250 : point.kind === "coupler" && !point.centre ? 150 : 185;
      put(label, "x", digits(place[0]! + far * Math.cos(best)));
      put(label, "y", digits(place[1]! + far * Math.sin(best)));
    }
  }
}
