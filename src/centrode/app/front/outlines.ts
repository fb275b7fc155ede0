// Conventional signs in units of a tenth of a pixel, with the sizes of the report's pictures.
import type { Place } from "./protocol";

export const U = 10; // units of a pixel
export const SIGN = 55; // a hinge's radius
export const COLOURS = 6;

export const digits = (value: number): string => value.toFixed(1);
export const plus = (a: Place, b: Place, share = 1): Place => a.map((value, k) => value + share * b[k]!);
export const minus = (a: Place, b: Place): Place => a.map((value, k) => value - b[k]!);
export const size = (a: Place): number => Math.hypot(...a);
export const turned = ([x = 0, y = 0]: Place, angle: number): Place => [x * Math.cos(angle) - y * Math.sin(angle), x * Math.sin(angle) + y * Math.cos(angle)];
export const polyline = (places: Place[]): string => places.map((p) => `${digits(p[0]!)} ${digits(p[1]!)}`).join("L");
export const drawn = (corners: Place[], closed = false): string => (corners.length ? `M${polyline(corners)}${closed ? "Z" : ""}` : "");

// A line of the ground with strokes on the side that `away` points to.
export function hatched(start: Place, end: Place, away: Place): string {
  const way = minus(end, start), length = size(way) || 1, along = way.map((value) => value / length);
  let d = drawn([start, end]);
  const count = Math.min(400, Math.max(2, Math.round(length / (0.9 * SIGN))));
  for (let k = 1; k <= count; k += 1) {
    const foot = plus(start, way, k / count);
    d += drawn([foot, plus(foot, minus(away, along), 0.9 * SIGN)]);
  }
  return d;
}
export const circle = (radius: number, spoke = false): string =>
  `M${digits(radius)} 0A${digits(radius)} ${digits(radius)} 0 1 0 ${digits(-radius)} 0A${digits(radius)} ${digits(radius)} 0 1 0 ${digits(radius)} 0Z${spoke ? `M0 0L${digits(radius)} 0` : ""}`;

export const SUPPORT = `${drawn([[0, 0], [-2 * SIGN, 3.2 * SIGN], [2 * SIGN, 3.2 * SIGN]], true)}${hatched([-2.8 * SIGN, 3.2 * SIGN], [2.8 * SIGN, 3.2 * SIGN], [0, 1])}`;
export const BLOCK = drawn([[-2.6, -1.7], [2.6, -1.7], [2.6, 1.7], [-2.6, 1.7]].map((corner) => corner.map((value) => value * SIGN)), true);
export const HEAD = "M0 0L-95 34L-95 -34Z";

export function slot(start: Place, end: Place): string {
  const turn = Math.atan2(end[1]! - start[1]!, end[0]! - start[0]!);
  const cap = (middle: Place, from: number): Place[] => Array.from({ length: 13 }, (_, k) => plus(middle, turned([1.5 * SIGN, 0], turn + from + (k * Math.PI) / 12)));
  return drawn([...cap(end, -Math.PI / 2), ...cap(start, Math.PI / 2)], true);
}

// The arc of a drive around its hinge, above the ground rather than in it; y points down.
export function turningArc(angle: number, forward: boolean): { arc: string; tip: Place; way: number; middle: number } {
  const middles = [angle + 1.75, angle - 1.75], middle = Math.sin(middles[0]!) >= Math.sin(middles[1]!) ? middles[0]! : middles[1]!;
  const turns = Array.from({ length: 15 }, (_, k) => middle + (forward ? 1 : -1) * (-0.75 + (1.5 * k) / 14));
  const places = turns.map((turn) => [4.2 * SIGN * Math.cos(turn), -4.2 * SIGN * Math.sin(turn)]);
  const tip = places[14]!, before = places[12]!;
  return { arc: drawn(places.slice(0, 14)), tip, way: Math.atan2(tip[1]! - before[1]!, tip[0]! - before[0]!), middle };
}

// The hatched line under a slider, on the side that points down or away from the middle.
export function groundLine(start: Place, end: Place, middle: Place): string {
  const way = minus(end, start), length = size(way) || 1, on = way.map((value) => value / length), across = [-on[1]!, on[0]!];
  const off = minus(plus(start, end).map((value) => value / 2), middle);
  const aside = Math.abs(on[0]!) > 0.2 ? across[1]! : across[0]! * off[0]! + across[1]! * off[1]!;
  const away = aside >= 0 ? across : across.map((value) => -value);
  return hatched(plus(plus(start, away, 95), on, -220), plus(plus(end, away, 95), on, 220), away);
}
// 1, 2 or 5 times a power of ten.
export function roundStep(wished: number): number {
  const power = 10 ** Math.floor(Math.log10(wished || 1));
  return [1, 2, 5, 10].map((one) => one * power).find((one) => one >= wished * 0.999)!;
}
