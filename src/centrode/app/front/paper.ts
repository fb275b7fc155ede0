// From places of a mechanism to places of the picture, in tenths of a pixel: the plane, or the sphere seen from far away.
import { U, digits, polyline } from "./outlines";
import type { Place } from "./protocol";

export interface Paper {
  flat(place: Place): Place;
  back(at: Place, near?: Place | null): Place;
  front(place: Place): boolean;
  line(a: Place, b: Place): Place[];
  paths(places: (Place | null)[]): [string, string];
}

export class Plane implements Paper {
  scale = 100; // pixels of a metre
  middle: Place = [0, 0];
  wide = 800;
  high = 600;

  flat(place: Place): Place {
    return [U * (this.wide / 2 + this.scale * (place[0]! - this.middle[0]!)), U * (this.high / 2 - this.scale * (place[1]! - this.middle[1]!))];
  }
  back(at: Place): Place {
    return [this.middle[0]! + (at[0]! / U - this.wide / 2) / this.scale, this.middle[1]! - (at[1]! / U - this.high / 2) / this.scale];
  }
  front(): boolean {
    return true;
  }
  line(a: Place, b: Place): Place[] {
    return [a, b];
  }
  paths(places: (Place | null)[]): [string, string] {
    let d = "", pen = false;
    for (const place of places) {
      if (place) {
        const at = this.flat(place);
        d += `${pen ? "L" : "M"}${digits(at[0]!)} ${digits(at[1]!)}`;
      }
      pen = Boolean(place);
    }
    return [d, ""];
  }
  zoom(by: number, about: Place): void {
    const held = this.back(about);
    this.scale = Math.min(1e7, Math.max(1e-4, this.scale * by));
    const now = this.back(about);
    this.middle = [this.middle[0]! + held[0]! - now[0]!, this.middle[1]! + held[1]! - now[1]!];
  }
  pan(by: Place): void {
    this.middle = [this.middle[0]! - by[0]! / U / this.scale, this.middle[1]! + by[1]! / U / this.scale];
  }
  fit(low: Place, high: Place): void {
    const sides = [high[0]! - low[0]!, high[1]! - low[1]!], greatest = Math.max(...sides);
    if (!(greatest > 0)) {
      this.middle = [low[0]!, low[1]!];
      return;
    }
    const room = 64; // pixels: names, supports
    this.scale = Math.max(1e-4, Math.min((this.wide - 2 * room) / Math.max(sides[0]!, 0.05 * greatest), (this.high - 2 * room) / Math.max(sides[1]!, 0.05 * greatest)));
    this.middle = [(low[0]! + high[0]!) / 2, (low[1]! + high[1]!) / 2];
  }
}

export const dot = (a: Place, b: Place): number => a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
const cross = (a: Place, b: Place): Place => [a[1]! * b[2]! - a[2]! * b[1]!, a[2]! * b[0]! - a[0]! * b[2]!, a[0]! * b[1]! - a[1]! * b[0]!];
const unit = (a: Place): Place => a.map((value) => value / (Math.hypot(...a) || 1));
export const angles = ([x = 0, y = 0, z = 0]: Place): Place => [Math.atan2(y, x), Math.atan2(z, Math.hypot(x, y))];
export const fromAngles = ([longitude = 0, latitude = 0]: Place): Place => [Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)];
export const arc = (a: Place, b: Place): number => Math.atan2(Math.hypot(...cross(a, b)), dot(a, b));
// Right-handed axes of two places: the first, across towards the second, and their pole.
export function globeAxes([first = [], second = []]: Place[]): [Place, Place, Place] {
  const pole = unit(cross(first, second));
  return [unit(first), cross(pole, unit(first)), pole];
}
// A circle about a pole, as a closed line.
export function around(pole: Place, radius: number): Place[] {
  const across = unit(cross(pole, Math.abs(pole[2]!) < 0.9 ? [0, 0, 1] : [1, 0, 0])), third = cross(pole, across);
  return Array.from({ length: 4 * ARC + 1 }, (_, k) => {
    const turn = (k * Math.PI) / (2 * ARC);
    return pole.map((value, i) => Math.cos(radius) * value + Math.sin(radius) * (Math.cos(turn) * across[i]! + Math.sin(turn) * third[i]!));
  });
}
const ARC = 32; // pieces of a great arc

export class Globe implements Paper {
  view: [Place, Place, Place];
  centre: Place = [4000, 3000];
  radius = 2500;

  constructor() {
    const towards = unit([1.6, -1.1, 0.9]), side = unit(cross([0, 0, 1], towards));
    this.view = [side, cross(towards, side), towards];
  }
  flat(place: Place): Place {
    const share = this.radius / (Math.hypot(...place) || 1);
    return [this.centre[0]! + share * dot(place, this.view[0]), this.centre[1]! - share * dot(place, this.view[1])];
  }
  back(at: Place, near?: Place | null): Place {
    const right = (at[0]! - this.centre[0]!) / this.radius, up = (this.centre[1]! - at[1]!) / this.radius;
    const aside = Math.hypot(right, up), share = aside > 0.999 ? 0.999 / aside : 1;
    const towards = Math.sqrt(Math.max(0, 1 - (share * aside) ** 2)), depth = near && !this.front(near) ? -towards : towards;
    return [0, 1, 2].map((k) => share * (right * this.view[0][k]! + up * this.view[1][k]!) + depth * this.view[2][k]!);
  }
  front(place: Place): boolean {
    return dot(place, this.view[2]) >= 0;
  }
  line(a: Place, b: Place): Place[] {
    const one = unit(a), other = unit(b), angle = Math.atan2(Math.hypot(...cross(one, other)), dot(one, other));
    if (angle < 1e-9) return [one, other];
    return Array.from({ length: ARC + 1 }, (_, k) => {
      const s = Math.sin((1 - k / ARC) * angle), t = Math.sin((k / ARC) * angle);
      return one.map((value, i) => (s * value + t * other[i]!) / Math.sin(angle));
    });
  }
  paths(places: (Place | null)[]): [string, string] {
    const made: [string, string] = ["", ""];
    for (let k = 1; k < places.length; k += 1) {
      const a = places[k - 1], b = places[k];
      if (!a || !b) continue;
      const behind = this.front(a) || this.front(b) ? 0 : 1;
      const piece = polyline([this.flat(a), this.flat(b)]), foot = piece.split("L")[0]!;
      made[behind] += made[behind].endsWith(foot) ? piece.slice(foot.length) : `M${piece}`;
    }
    return made;
  }
  turn(right: number, up: number): void {
    const [x, y, z] = this.view;
    const tilted = unit(z.map((value, k) => value - (right * x[k]! + up * y[k]!) / this.radius));
    const level = Math.abs(tilted[2]!) < 0.98 ? [0, 0, 1] : y, side = unit(cross(level, tilted));
    this.view = [side, cross(tilted, side), tilted];
  }
  towards(vector: Place, scale: number): Place {
    return [dot(vector, this.view[0]) * scale, -dot(vector, this.view[1]) * scale];
  }
}
