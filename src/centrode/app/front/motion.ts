// A motion as the server sends it, and its numbers between the samples.
import { type DrivingCam, type EventSign, type Frame, isFrame, type MotionBlock, type Panel, type Place } from "./protocol";

export interface MotionEvent {
  drive: number;
  kind: string;
  text: string;
}

// An event of a motion that a topic has found, or a stretch in which something holds, by samples of the motion.
export interface EventMark {
  at: number;
  label: string;
  sign: EventSign;
}
export interface Course {
  title: string;
  loops: boolean;
  marks: EventMark[];
  held: { from: number; to: number; label: string }[];
}
const FINER = 8, SEEN = 1e-3; // places in place of a sample where a chord is so far beside the track, of its extent
const SLOWEST = 20, FASTEST = 2; // seconds that a motion in time takes in the player, else its own

export class Motion {
  readonly points: string[];
  readonly links: string[];
  readonly samples: number;
  readonly axes: number;
  readonly drive: Float32Array;
  readonly status: Float32Array;
  readonly events: MotionEvent[];
  readonly limits: string[];
  readonly course: Course | null; // of a motion that a topic has found
  private readonly pointIndex: Map<string, number>;
  private readonly linkIndex: Map<string, number>;

  constructor(private readonly frame: Frame, readonly digest: string, block: MotionBlock | null = null) {
    const { header, arrays } = frame;
    this.points = header.points;
    this.links = header.links;
    const places = arrays.points!;
    this.samples = places.shape[0]!;
    this.axes = places.shape[2] ?? 2;
    this.drive = arrays.drive!.numbers;
    this.status = arrays.status?.numbers ?? new Float32Array(this.samples);
    this.events = header.events ?? [];
    this.limits = header.limits ?? [];
    this.pointIndex = new Map(this.points.map((name, k) => [name, k]));
    this.linkIndex = new Map(this.links.map((name, k) => [name, k]));
    this.course = block && {
      title: block.title ?? "",
      loops: block.loops,
      marks: block.marks.map((mark) => ({ ...mark, at: this.placeAt(mark.at) })),
      held: block.held.map((one) => ({ ...one, from: this.placeAt(one.from), to: this.placeAt(one.to) })),
    };
  }

  // Seconds that one way takes in the player at its usual speed: a motion in time its own, if one can wait for it.
  get seconds(): number {
    const own = Math.abs(this.drive[this.last]! - this.drive[0]!);
    if (!this.course) return 6;
    return this.course.loops ? Math.min(Math.max(own, 1.2), 4) : Math.min(Math.max(own, FASTEST), SLOWEST);
  }
  // Whether the player begins again where it ends.
  get whole(): boolean {
    return this.course ? this.course.loops : this.closed;
  }

  // Where between the samples an instant lies; they need not stand at even distances.
  placeAt(time: number): number {
    const sought = Math.fround(time);
    let low = 0, high = this.last;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.drive[middle]! < sought) low = middle + 1;
      else high = middle;
    }
    const before = this.drive[low - 1], after = this.drive[low]!;
    if (before === undefined || after <= sought) return low;
    return low - (after - sought) / (after - before);
  }
  // The place on a slider, from 0 to `last`: that of a course goes through time, any other one from sample to sample.
  slideOf(at: number): number {
    const way = this.drive[this.last]! - this.drive[0]!;
    return this.course && way ? (this.last * (this.driveAt(at) - this.drive[0]!)) / way : at;
  }
  placeOf(slide: number): number {
    const way = this.drive[this.last]! - this.drive[0]!;
    return this.course && way ? this.placeAt(this.drive[0]! + (way * slide) / this.last) : slide;
  }

  get last(): number {
    return this.samples - 1;
  }
  get factor(): number {
    return this.frame.header.factor ?? 1;
  }
  get unit(): string {
    return this.frame.header.unit ?? "";
  }
  get symbol(): string {
    return this.frame.header.symbol || ({ angle: "φ", length: "s", time: "t" } as Record<string, string>)[this.frame.header.kind] || "";
  }
  // The place of the initial position; a motion that leaves it out begins at its first sample.
  get start(): number {
    return this.frame.header.start ?? 0;
  }
  get holdsInitial(): boolean {
    return typeof this.frame.header.start === "number";
  }
  get cams(): DrivingCam[] {
    return this.frame.header.cams ?? [];
  }
  // The numbers of one sample of an array, between samples those of both in proportion.
  row(array: string, at: number): number[] {
    const found = this.frame.arrays[array];
    if (!found) return [];
    const wide = found.numbers.length / this.samples, low = Math.min(this.last, Math.max(0, Math.floor(at))), next = Math.min(this.last, low + 1), share = at - low;
    return Array.from({ length: wide }, (_, k) => found.numbers[low * wide + k]! + share * (found.numbers[next * wide + k]! - found.numbers[low * wide + k]!));
  }
  has(array: string): boolean {
    return array in this.frame.arrays;
  }
  reached(sample: number): boolean {
    const code = String(this.status[sample]);
    return this.frame.header.reached ? this.frame.header.reached[code] !== false : true;
  }
  word(sample: number): string {
    return this.status[sample] ? this.frame.header.status_words?.[String(this.status[sample])] ?? "" : "";
  }
  point(name: string): number {
    return this.pointIndex.get(name) ?? -1;
  }
  link(name: string): number {
    return this.linkIndex.get(name) ?? -1;
  }

  // One number of an array of points or links at a sample.
  value(array: string, sample: number, thing: number, axis = 0): number {
    const found = this.frame.arrays[array];
    if (!found || thing < 0) return NaN;
    const [, things = 1, axes = 1] = found.shape;
    return found.numbers[(sample * things + thing) * axes + axis] ?? NaN;
  }

  place(name: string, at: number): Place | null {
    const thing = this.point(name), low = Math.floor(at), share = at - low, found: number[] = [];
    for (let axis = 0; axis < this.axes; axis += 1) {
      const first = this.value("points", low, thing, axis);
      const next = share && low < this.last ? this.value("points", low + 1, thing, axis) : first;
      found.push(Number.isFinite(next) ? first + share * (next - first) : first);
    }
    return found.every(Number.isFinite) ? found : null;
  }

  // Where a point goes: its samples, and of a motion in time places between them where a chord would be seen. A fast
  // oscillation has a dozen samples in a period. No cubic leads over an event, at which speeds jump.
  track(name: string): (Place | null)[] {
    const found = Array.from({ length: this.samples }, (_, k) => this.place(name, k)), thing = this.point(name);
    if (!this.course || this.course.loops || !this.has("velocities")) return found;
    const own = (axis: number): number[] => found.flatMap((one) => (one ? [one[axis]!] : []));
    const extent = Math.max(...Array.from({ length: this.axes }, (_, axis) => own(axis).reduce((most, one) => Math.max(most, one), -Infinity) - own(axis).reduce((least, one) => Math.min(least, one), Infinity)));
    const jumps = new Set(this.course.marks.flatMap(({ at }) => [Math.ceil(at) - 1, Math.floor(at)]));
    return found.flatMap((from, k) => {
      const to = found[k + 1], step = this.drive[k + 1]! - this.drive[k]!;
      if (!from || !to || jumps.has(k)) return [from];
      const slopes = [k, k + 1].map((sample) => from.map((_one, axis) => step * this.value("velocities", sample, thing, axis)));
      const bend = Math.hypot(...from.map((_one, axis) => slopes[1]![axis]! - slopes[0]![axis]!)) / 8;
      if (!(bend > SEEN * extent)) return [from];
      return Array.from({ length: FINER }, (_, part) => {
        const t = part / FINER, u = 1 - t;
        return from.map((_one, axis) => u * u * ((1 + 2 * t) * from[axis]! + t * slopes[0]![axis]!) + t * t * ((1 + 2 * u) * to[axis]! - u * slopes[1]![axis]!));
      });
    });
  }

  angle(name: string, at: number): number {
    const thing = this.link(name), low = Math.floor(at), share = at - low;
    const first = this.value("angles", low, thing), next = low < this.last ? this.value("angles", low + 1, thing) : first;
    return Number.isFinite(next) ? first + share * (next - first) : first;
  }

  driveAt(at: number): number {
    const low = Math.floor(at), share = at - low, first = this.drive[low] ?? NaN, next = this.drive[low + 1] ?? first;
    return first + share * (next - first);
  }

  // Where between the samples a value of the drive lies; of an angle also turns apart from it.
  sampleOf(value: number): number | null {
    const turn = 2 * Math.PI;
    const low = Math.min(this.drive[0]!, this.drive[this.last]!), high = Math.max(this.drive[0]!, this.drive[this.last]!);
    let sought = value;
    if (this.frame.header.kind === "angle" && (value < low || value > high)) sought = value - turn * Math.floor((value - low) / turn);
    for (let k = 0; k < this.last; k += 1) {
      const a = this.drive[k]!, b = this.drive[k + 1]!;
      if ((a <= sought && sought <= b) || (b <= sought && sought <= a)) return k + (b === a ? 0 : (sought - a) / (b - a));
    }
    return null;
  }

  // Whether the last picture is the first.
  get closed(): boolean {
    if (this.last < 2) return false;
    let apart = 0, size = 0;
    for (let k = 0; k < this.points.length; k += 1) for (let axis = 0; axis < this.axes; axis += 1) {
      const first = this.value("points", 0, k, axis);
      const last = this.value("points", this.last, k, axis);
      if (!Number.isFinite(first) || !Number.isFinite(last)) return false;
      apart = Math.max(apart, Math.abs(first - last));
      size = Math.max(size, Math.abs(first));
    }
    return apart <= 1e-4 * size;
  }

  // The reached samples around one.
  piece(sample: number): [number, number] {
    if (!this.reached(sample)) return [0, this.last];
    let low = sample, high = sample;
    while (low > 0 && this.reached(low - 1)) low -= 1;
    while (high < this.last && this.reached(high + 1)) high += 1;
    return [low, high];
  }
}

export const motionOf = (answer: unknown, digest: string): Motion | null => (isFrame(answer) && answer.arrays.points ? new Motion(answer, digest) : null);

// The motions of a panel by their numbers.
export function coursesOf(panel: Panel, digest: string): Motion[] {
  const { frame } = panel;
  if (!frame) return [];
  const blocks = panel.blocks.filter((block) => block.kind === "motion");
  return (frame.header.motions as Record<string, unknown>[]).map((header, number) => {
    const begin = `${number} `, own = Object.entries(frame.arrays).filter(([name]) => name.startsWith(begin));
    return new Motion({ id: frame.id, header, arrays: Object.fromEntries(own.map(([name, array]) => [name.slice(begin.length), array])) }, digest, blocks[number]);
  });
}
