// The picture of a cam: how it has turned, and its follower in the axes of the frame.
import { SIGN, SUPPORT, U, circle, digits, drawn, hatched } from "./outlines";
import { make } from "./picture";
import type { CamScene, Place } from "./protocol";

const MARGIN = 40; // pixels: supports, hatching
const GAP = 0.12, WALLS = 0.4, ABOVE = 0.15; // of a stem's guide, as parts of the cam's greatest radius

type Box = { low: Place; high: Place };
const known = (row: (number | null)[] | undefined): Place | null => (row?.length && row.every((one) => one !== null) ? (row as Place) : null);
const corners = (row: Place): Place[] => Array.from({ length: row.length / 2 }, (_, k) => row.slice(2 * k, 2 * k + 2));

// The room of the cam however it turns, and of its follower over the whole turn [m].
function room(cam: CamScene, far: number): Box {
  const { follower } = cam, reach = cam.roller ?? 0, around = far + (cam.carrier ? reach : 0), places: Place[] = [[-around, -around], [around, around]];
  for (const row of follower?.places ?? []) {
    const at = known(row);
    if (at) places.push([at[0]! - reach, at[1]! - reach], [at[0]! + reach, at[1]! + reach]);
  }
  for (const row of follower?.faces ?? []) places.push(...corners(known(row) ?? []));
  if (follower?.pivot) places.push(follower.pivot);
  else if (follower) places.push([0, heights(cam).most + stem(cam, far)]);
  const axis = (pick: typeof Math.min, k: number): number => pick(...places.map((one) => one[k]!));
  return { low: [axis(Math.min, 0), axis(Math.min, 1)], high: [axis(Math.max, 0), axis(Math.max, 1)] };
}
// Of the places of a translating follower.
const heights = (cam: CamScene): { least: number; most: number } => {
  const all = (cam.follower?.places ?? []).flatMap((row) => row[1] ?? []);
  return { least: Math.min(...all), most: Math.max(...all) };
};
const wall = (cam: CamScene, far: number): number => heights(cam).most + (cam.roller ?? 0) + GAP * far; // where the guide begins
// So long that the stem stands out of its guide at the lowest place too.
const stem = (cam: CamScene, far: number): number => wall(cam, far) - heights(cam).least + (WALLS + ABOVE) * far;

// `at` counts samples of the turn.
export function camPicture(cam: CamScene, at: number, wide: number, high: number, label: string): SVGSVGElement {
  const svg = make("svg", { viewBox: `0 0 ${wide * U} ${high * U}`, class: "drawing cam", role: "img", "aria-label": label });
  const radii = (curve: Place[]): number[] => curve.map(([x, y]) => Math.hypot(x ?? 0, y ?? 0));
  const far = Math.max(1e-9, ...radii(cam.profile), ...radii(cam.pitch ?? [])), box = room(cam, far);
  const inner = (side: number): number => Math.max(1, side - 2 * MARGIN), scale = U * Math.min(inner(wide) / (box.high[0]! - box.low[0]!), inner(high) / (box.high[1]! - box.low[1]!));
  const flat = (place: Place): Place => [0, 1].map((k) => (U * (k ? high : wide)) / 2 + (k ? -1 : 1) * scale * (place[k]! - (box.low[k]! + box.high[k]!) / 2));
  const angles = cam.displacement?.angle ?? [0], low = Math.max(0, Math.min(angles.length - 1, Math.floor(at))), share = at - low, first = angles[low] ?? 0;
  const turn = (cam.carrier ? 0 : (cam.follower?.sense ?? 1)) * (first + share * ((angles[low + 1] ?? first) - first));

  const hub = flat([0, 0]), turned = make("g", { transform: `translate(${digits(hub[0]!)} ${digits(hub[1]!)}) rotate(${((-turn * 180) / Math.PI).toFixed(2)})` }, svg);
  const path = (curve: Place[]): string => curve.map(([x, y], k) => `${k ? "L" : "M"}${digits(x! * scale)} ${digits(-y! * scale)}`).join("");
  if (cam.profile.length) make("path", { class: "cam-body hue-0", d: `${path(cam.profile)}Z` }, turned);
  if (cam.pitch?.length) make("path", { class: "pitch", d: `${path(cam.pitch)}${cam.open ? "" : "Z"}` }, turned);
  if (cam.base) {
    make("circle", { class: "base", r: digits(cam.base * scale) }, turned);
    make("path", { class: "spoke", d: `M0 0L0 ${digits(-0.5 * cam.base * scale)}` }, turned);
  }
  const support = (place: Place): void => {
    const to = `translate(${digits(place[0]!)} ${digits(place[1]!)})`;
    make("path", { class: "support", d: SUPPORT, transform: to }, svg);
    make("circle", { class: "hinge", r: SIGN, transform: to }, svg);
  };
  if (cam.follower) {
    support(hub);
    showFollower(svg, cam, at, far, scale, flat, support);
    return svg;
  }
  make("circle", { class: "hinge", r: SIGN, cx: digits(hub[0]!), cy: digits(hub[1]!) }, svg);
  const spot = cam.carrier && cam.pitch?.[Math.round(at)];
  if (spot) {
    const foot = flat(spot), to = `translate(${digits(foot[0]!)} ${digits(foot[1]!)})`;
    make("path", { class: "carrier", d: drawn([hub, foot]) }, svg);
    if (cam.roller) make("path", { class: "roller hue-1", d: circle(cam.roller * scale), transform: to }, svg);
    else make("circle", { class: "hinge", r: SIGN, transform: to }, svg);
  }
  return svg;
}

// A stem or an arm with roller, edge or flat face; the guide or the pivot on the frame.
function showFollower(svg: SVGSVGElement, cam: CamScene, at: number, far: number, scale: number, flat: (place: Place) => Place, support: (place: Place) => void): void {
  const follower = cam.follower!, sample = Math.round(at), pivot = follower.pivot && flat(follower.pivot);
  const place = known(follower.places?.[sample]), foot = place && flat(place), faces = corners(known(follower.faces?.[sample]) ?? []).map(flat);
  const line = (ends: Place[]): void => void make("path", { class: "follower", d: drawn(ends) }, svg);
  for (let k = 0; k + 1 < faces.length; k += 2) line(faces.slice(k, k + 2));
  if (foot && pivot) line([pivot, foot]);
  if (foot && !pivot) {
    const from = wall(cam, far);
    line([foot, flat([place![0]!, place![1]! + stem(cam, far)])]);
    for (const side of [-1, 1]) {
      const x = foot[0]! + 2 * side * SIGN, ends = [from, from + WALLS * far].map((y) => [x, flat([0, y])[1]!]);
      make("path", { class: "ground", d: hatched(ends[0]!, ends[1]!, [side, 0]) }, svg);
    }
  }
  if (foot && cam.roller) make("path", { class: "roller hue-1", d: circle(cam.roller * scale), transform: `translate(${digits(foot[0]!)} ${digits(foot[1]!)})` }, svg);
  if (foot && follower.contact === "knife") make("path", { class: "edge", d: edge(pivot ? Math.atan2(pivot[1]! - foot[1]!, pivot[0]! - foot[0]!) : -Math.PI / 2), transform: `translate(${digits(foot[0]!)} ${digits(foot[1]!)})` }, svg);
  if (pivot) support(pivot);
}
const edge = (towards: number): string => {
  const corner = (along: number, aside: number): Place => [along * Math.cos(towards) - aside * Math.sin(towards), along * Math.sin(towards) + aside * Math.cos(towards)].map((one) => one * SIGN);
  return drawn([[0, 0], corner(2.4, 0.7), corner(2.4, -0.7)], true);
};
